// The plan as the page holds it (diagram/export/viewer.c writes it), unrolled into steps: one per pass, unique paths before their
// copies.

// 32-bit FNV-1a over integers: tells one plan of a framework from another.
function hash(numbers) {
  let h = 0x811c9dc5;
  for (const n of numbers) {
    for (let shift = 0; shift < 32; shift += 8) h = Math.imul(h ^ ((n >>> shift) & 255), 0x01000193) >>> 0;
  }
  return h.toString(16).padStart(8, '0');
}

// Cords in the order of threading: a unique path, then its copies, then the next path.
function orderOf(cords) {
  const copies = cords.map(() => []);
  cords.forEach((cord, c) => cord.of !== c && copies[cord.of].push(c));
  return cords.flatMap((cord, c) => (cord.of === c ? [c, ...copies[c]] : []));
}

// Passes of a cord as they are threaded: from its fold to its end, then, with the left needle, from there back to its start.
function orderOfPasses({half, fold}) {
  const right = half.map((h, k) => ({k, half: h, left: false})), left = right.splice(0, fold).reverse();
  return [...right, ...left.map(({k, half: h}) => ({k, half: h ^ 1, left: true}))];
}

// What moves is played: its steps are the frames after the first. No cord is threaded meanwhile.
function readMotion(plan) {
  const {frames, words} = plan.moves;
  plan.order = plan.cords = [];
  plan.most = 1;
  plan.steps = (frames ?? words).slice(1).map((_, i) => ({frame: i + 1}));
  if (!frames) return readRise(plan);
  plan.key = `thread-viewer:${plan.frame}:moves:${hash(frames[frames.length - 1].map((x) => Math.round(1e4 * x)))}`;
  return plan;
}

// Base64 as bytes.
export const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;

// Pieces that move with their cords, as kit/write_viewer.c writes them.
function readRise(plan) {
  const {moves} = plan, n = plan.pieces.length, whole = new Uint16Array(bytesOf(moves.poses), 0, 7 * n * moves.words.length);
  // x, y, z in mm and the quaternion x, y, z, w of a piece in a frame
  moves.pose = (frame, piece) => Array.from(whole.subarray(7 * (frame * n + piece), 7 * (frame * n + piece + 1)),
    (x, k) => (k < 3 ? moves.low[k] + moves.step * x : x / 32767 - 1));
  moves.tension = new Uint8Array(bytesOf(moves.tensions));
  plan.scale = moves.scale;
  return plan;
}

export function readPlan(text) {
  const plan = JSON.parse(text);
  plan.moves ??= plan.kit?.moves;
  if (plan.moves) return readMotion(plan);
  const held = new Int32Array(plan.edges.length);
  const steps = [];
  plan.inside = plan.solid || Boolean(plan.kit); // cords run inside pieces, which one sees through
  plan.order = orderOf(plan.cords);
  plan.tail = (h) => plan.edges[h >> 1][h & 1];
  plan.head = (h) => plan.edges[h >> 1][1 - (h & 1)];
  for (const c of plan.order) {
    const cord = plan.cords[c];
    const needle = {used: 0, whole: 0}, lengthOf = (half) => plan.lengths[half >> 1];
    cord.first = steps.length;
    orderOfPasses(cord).forEach(({k, half, left}, i) => {
      const edge = half >> 1, begins = i === 0 || i === cord.half.length - cord.fold;
      if (begins) {
        const part = left ? cord.half.slice(0, cord.fold) : cord.half.slice(cord.fold);
        Object.assign(needle, {used: 0, whole: part.reduce((sum, h) => sum + lengthOf(h), 0)});
      }
      needle.used += lengthOf(half);
      steps.push({cord: c, i, k, half, left, begins, edge, piece: plan.solid ? plan.head(half) : edge, visit: ++held[edge], ...needle});
    });
  }
  plan.steps = steps;
  plan.most = held.reduce((a, b) => Math.max(a, b), 1);
  plan.key = `thread-viewer:${plan.frame}:${hash(plan.cords.flatMap((cord) => [cord.half.length, ...cord.half]))}`;
  return plan;
}

export const plural = (n, word) => `${n} ${word}${n === 1 ? '' : word.endsWith('s') ? 'es' : 's'}`;

// "1234 mm", with about four digits.
export function lengthText(value, units) {
  const digits = value >= 1000 ? 0 : value >= 100 ? 1 : value >= 10 ? 2 : 3;
  return `${value.toFixed(digits)} ${units}`;
}

export function forceText(newton) {
  return `${newton >= 1e6 ? newton.toExponential(2) : newton >= 100 ? newton.toFixed(0) : newton.toPrecision(3)} N`;
}

// The piece in which a cord starts, where pieces are solid: it is held before the first pass; else -1.
export const startOf = (plan, step) => (plan.solid && step.i === 0 ? plan.tail(step.half) : -1);

// What to do in a step, for its pass: "pick up X-10 (B5): in from A5, out to C5"; before the first one what the start needs.
export function instruction(plan, step) {
  const {does, fold} = plan.cords[step.cord];
  const needle = fold && step.begins ? `${step.left ? 'left' : 'right'} needle, from the fold: ` : '';
  if (!plan.solid) return needle + does[step.i];
  return needle + (step.i ? does[step.i + 1] : `${does[0]}; ${does[1]}`);
}

// How far along, after a step.
export function progress(plan, step) {
  const cord = plan.cords[step.cord], left = step.whole - step.used;
  const end = step.k === (step.left ? 0 : cord.half.length - 1);
  const length = `${cord.fold ? 'of its half of the cord' : 'cord'} used ${lengthText(step.used, plan.units)}`;
  if (end) return `${length}; the needle comes out at ${plan.places[plan.head(step.half)]}`;
  return `${length}, left ${lengthText(Math.max(left, 0), plan.units)}`;
}

// Steps done after the pass called "17" (of all) or "B17" (of a cord); NaN if there is none.
export function findPass(plan, text) {
  const parts = /^\s*([A-Za-z]*)\s*([0-9]+)\s*$/.exec(text);
  if (!parts) return NaN;
  const number = Number(parts[2]), several = plan.cords.length > 1;
  if (!parts[1] && (several || number === 0)) return number <= plan.steps.length ? number : NaN;
  const cord = several || parts[1] ? plan.cords.findIndex((one) => one.id.toUpperCase() === parts[1].toUpperCase()) : 0;
  return plan.steps.findIndex((step) => step.cord === cord && step.k + 1 === number) + 1 || NaN;
}

// Piece by its name ("B5", "A1-A2") or a tube by its two places, "A1 B1"; -1 if there is none.
export function findPiece(plan, text) {
  const word = text.trim().toUpperCase(), named = plan.pieces.findIndex((name) => name.toUpperCase() === word);
  if (named >= 0 || plan.solid) return named;
  const ends = word.split(/[\s,;–-]+/).filter(Boolean);
  if (ends.length !== 2) return -1;
  const [a, b] = ends.map((end) => plan.labels.findIndex((label) => label.toUpperCase() === end));
  return plan.edges.findIndex((edge) => a >= 0 && b >= 0 && edge.includes(a) && edge.includes(b));
}

// Steps done after the needle has come to a piece, each time.
export function passesThrough(plan, piece) {
  return plan.steps.flatMap((step, i) => (step.piece === piece || startOf(plan, step) === piece ? [i + 1] : []));
}
