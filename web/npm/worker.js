/* Runs one command for thread.js on the files of this computer. */
'use strict';
const fs = require('fs');
const { parentPort, workerData } = require('worker_threads');
const { makeEngine } = require('./engine.js');

/* Writes all of it: a pipe that is full takes a part, or none for now. */
function writeAll(file, data) {
  for (let at = 0; at < data.length; ) {
    try {
      at += fs.writeSync(file, data, at);
    } catch (error) {
      if (error.code === 'EPIPE') return false;
      if (error.code !== 'EAGAIN') throw error;
      Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 5);
    }
  }
  return true;
}

/* Every folder of the root appears under its own name, so that all paths mean what they mean outside. */
function mountComputer(FS) {
  const { NODEFS } = FS.filesystems;
  for (const entry of fs.readdirSync('/')) {
    if (entry === 'proc' || entry === 'sys') continue;
    try {
      if (!fs.statSync(`/${entry}`).isDirectory()) continue;
    } catch (error) {
      continue; // a link that leads nowhere
    }
    if (entry === 'dev') continue; // the program's own: /dev/stdout is what it writes to
    if (!FS.analyzePath(`/${entry}`).exists) FS.mkdir(`/${entry}`);
    FS.mount(NODEFS, { root: `/${entry}` }, `/${entry}`);
  }
  return workerData.folder;
}

async function main() {
  const { args, umask, stop } = workerData;
  const engine = await makeEngine();
  const { exit } = await engine.run(
    args,
    {},
    {
      umask,
      mount: mountComputer,
      stdin: () => fs.readFileSync(0),
      isStopped: () => Atomics.load(stop, 0) > 0,
      takeStdout: (bytes) => writeAll(1, bytes),
      takeStderr: (bytes) => writeAll(2, bytes),
    },
  );
  parentPort.postMessage(exit);
}

main();
