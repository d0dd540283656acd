#!/usr/bin/env node
/* The command line under node. The program computes in a worker, so that Ctrl-C is heard here: the first asks it to stop with the
 * best plan so far, the second ends it. */
'use strict';
const path = require('path');
const { Worker } = require('worker_threads');

const INTERRUPTED = 130;
const stop = new Int32Array(new SharedArrayBuffer(4));
const worker = new Worker(path.join(__dirname, 'worker.js'), {
  workerData: { args: process.argv.slice(2), folder: process.cwd(), umask: process.umask(), stop },
});

function interrupt() {
  if (Atomics.add(stop, 0, 1) > 0) process.exit(INTERRUPTED);
}
process.on('SIGINT', interrupt);
process.on('SIGTERM', interrupt);
worker.on('message', (exit) => (process.exitCode = exit));
worker.on('error', (error) => {
  process.stderr.write(`thread: a fault of this program: ${error.message}\n`);
  process.exitCode = 70;
});
