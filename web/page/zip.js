// A zip archive (PKWARE APPNOTE 6.3, names in UTF-8): files are deflated where that makes them smaller, else stored.

const CRC_TABLE = Uint32Array.from({length: 256}, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) crc = CRC_TABLE[(crc ^ byte) & 255] ^ (crc >>> 8);
  return ~crc >>> 0;
}

// Little-endian numbers: [value, bytes] ..
function record(...fields) {
  const bytes = [];
  for (const [value, n] of fields) for (let k = 0; k < n; k++) bytes.push(Math.floor(value / 256 ** k) & 255);
  return Uint8Array.from(bytes);
}

const deflates = new WeakMap(); // of bytes the promise of the same, deflated: files stand in several archives

function deflated(bytes) {
  if (!deflates.has(bytes)) deflates.set(bytes, new Response(new Blob([bytes]).stream().pipeThrough(new CompressionStream('deflate-raw'))).arrayBuffer());
  return deflates.get(bytes);
}

// files: {name: Uint8Array}. A promise of a Blob. The date is the first that zip knows: the same files give the same bytes.
async function zip(files) {
  const parts = [], index = [];
  let at = 0, indexSize = 0;
  for (const [name, bytes] of Object.entries(files)) {
    const title = new TextEncoder().encode(name), small = await deflated(bytes), isSmaller = small.byteLength < bytes.length;
    const data = isSmaller ? new Uint8Array(small) : bytes, sizes = [[data.length, 4], [bytes.length, 4]];
    const common = [[20, 2], [0x800, 2], [isSmaller ? 8 : 0, 2], [0, 2], [0x21, 2], [crc32(bytes), 4], ...sizes, [title.length, 2], [0, 2]];
    const head = record([0x04034b50, 4], ...common);
    const entry = record([0x02014b50, 4], [20, 2], ...common, [0, 2], [0, 2], [0, 2], [0, 4], [at, 4]);
    parts.push(head, title, data);
    index.push(entry, title);
    at += head.length + title.length + data.length;
    indexSize += entry.length + title.length;
  }
  const n = Object.keys(files).length;
  return new Blob([...parts, ...index, record([0x06054b50, 4], [0, 2], [0, 2], [n, 2], [n, 2], [indexSize, 4], [at, 4], [0, 2])], {type: 'application/zip'});
}
