/* thread in a page, in a worker or under node: the whole program, one call for one command.
 *
 *   const engine = await makeEngine(source);
 *   const { exit, stdout, stderr, files } = await engine.run(
 *     ['plan', 'dome.obj', '--cords', '4', '--progress', '-o', 'plan.json'],   the command line, without `thread`
 *     { 'dome.obj': bytes });                                                   what lies in the folder it works in
 *
 * source: {factory, wasm}. factory is what thread-engine.js defines (global `ThreadEngine`, or require('./thread-engine.js'));
 * wasm is thread-engine.wasm: its bytes (ArrayBuffer or Uint8Array) or a WebAssembly.Module, which can be posted to a worker and
 * saves compiling there. Under node both may be left out: the files beside this one are taken.
 *
 * run(args, files, options) -> Promise of
 *   exit     the exit code of the command line: 0 done, 2 usage, 3 bad input, 4 infeasible, 5 not proved (plan written), 70 fault
 *   stdout, stderr   strings
 *   files    {name: Uint8Array} of all files that the command made or changed; folders stand in the name: 'dome/plan.json'
 * files: {name: Uint8Array | string}, left as they are. options, all of them optional:
 *   onStdout(line), onStderr(line)   each line as it is written, without its end. With --progress in args those of stderr that
 *                          begin with { are JSON (docs/outputs.md)
 *   onPlan(text)           the best plan so far, a whole plan.json that claims no proof: at most five times a second. Who keeps
 *                          the last one may end the worker at any time, and loses nothing
 *   isStopped() -> bool    asked some twenty times a second while a search with --time-limit runs: true stops it as Ctrl-C does,
 *                          with the best plan and its bound written and exit code 5
 *   stdin    Uint8Array | string | function that gives it, what `-` reads
 *   umask    of the files' modes, default 0o022
 *   takeStdout(bytes), takeStderr(bytes)   (node) take what is written in place of the strings
 *   mount(FS)              (node) prepares other folders, and returns the one to work in; the result has no files then
 *
 * A command computes without a pause: in a page, run it in a worker. Each run has an instance of its own, whose memory (at most
 * 2 GB) is free when the promise has settled; only the compiled module stays. Runs may follow each other or overlap. A run that
 * dies gives exit 70, with one line on stderr; makeEngine fails only if the wasm is none. Nothing is fetched from anywhere. */
(function (root) {
  'use strict';

  const FOLDER = '/work';
  const FAULT = 70;

  const bytesOf = (data) => (typeof data === 'string' ? new TextEncoder().encode(data) : data);

  /* Under node what was not given lies beside this file. */
  function beside(source) {
    const complete = { ...source };
    if (typeof require === 'function' && typeof module === 'object') {
      if (!complete.factory) complete.factory = require('./thread-engine.js');
      if (!complete.wasm) complete.wasm = require('fs').readFileSync(require('path').join(__dirname, 'thread-engine.wasm'));
    }
    if (!complete.factory || !complete.wasm) throw new Error('makeEngine: thread-engine.js and thread-engine.wasm are needed');
    return complete;
  }

  /* Bytes that the program writes one by one, as whole lines and as one text; or, if somebody takes them, handed on as bytes. */
  function sink(onLine, take) {
    let bytes = new Uint8Array(1 << 16);
    let length = 0;
    let begun = 0; // of the line that is being written
    const text = (from, to) => new TextDecoder().decode(bytes.subarray(from, to));
    const handOn = () => {
      take(bytes.slice(0, length));
      length = 0;
    };
    return {
      put(code) {
        if (code === null) return;
        if (length === bytes.length) {
          const longer = new Uint8Array(2 * length);
          longer.set(bytes);
          bytes = longer;
        }
        const byte = code & 255;
        bytes[length++] = byte;
        if (take) {
          if (byte === 10 || length === bytes.length) handOn();
        } else if (onLine && byte === 10) {
          onLine(text(begun, length - 1));
          begun = length;
        }
      },
      end() {
        if (take && length > 0) handOn();
        if (onLine && begun < length) onLine(text(begun, length));
        return text(0, length);
      },
    };
  }

  function byteSource(data) {
    let bytes;
    let at = 0;
    return () => {
      if (!bytes) bytes = bytesOf((typeof data === 'function' ? data() : data) || '');
      return at < bytes.length ? bytes[at++] : null;
    };
  }

  function writeTree(FS, files) {
    for (const [name, data] of Object.entries(files)) {
      const path = `${FOLDER}/${name}`;
      FS.mkdirTree(path.slice(0, path.lastIndexOf('/')));
      FS.writeFile(path, bytesOf(data));
    }
  }

  function sameBytes(a, b) {
    return a.length === b.length && a.every((byte, i) => byte === b[i]);
  }

  /* All files below the folder but those that came in and are as they were. */
  function readTree(FS, given) {
    const found = {};
    const visit = (folder, prefix) => {
      for (const name of FS.readdir(folder)) {
        if (name === '.' || name === '..') continue;
        const path = `${folder}/${name}`;
        if (FS.isDir(FS.stat(path).mode)) {
          visit(path, `${prefix}${name}/`);
          continue;
        }
        const bytes = FS.readFile(path);
        const before = given[prefix + name];
        if (before === undefined || !sameBytes(bytes, bytesOf(before))) found[prefix + name] = bytes;
      }
    };
    visit(FOLDER, '');
    return found;
  }

  /* Why a run died, as the command line would say it. */
  function faultLine(error) {
    const text = String((error && error.message) || error);
    const full = /memory|OOM|allocation/i.test(text);
    return full ? 'thread: out of memory' : `thread: a fault of this program: ${text.split('\n')[0]}`;
  }

  async function makeEngine(source) {
    const { factory, wasm } = beside(source);
    const compiled = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);

    async function instance(options, out, err) {
      let failed;
      const died = new Promise((_, reject) => (failed = reject));
      const made = factory({
        noInitialRun: true,
        threadUmask: options.umask === undefined ? 0o022 : options.umask,
        threadPlan: options.onPlan,
        threadStopped: options.isStopped,
        instantiateWasm(imports, done) {
          WebAssembly.instantiate(compiled, imports).then((it) => done(it, compiled), failed);
          return {};
        },
        preRun: [(own) => own.FS.init(byteSource(options.stdin), out.put, err.put)],
        print() {},
        printErr() {},
        onAbort() {},
        quit(code, why) {
          throw why;
        },
      });
      return Promise.race([made, died]);
    }

    async function run(args, files = {}, options = {}) {
      const out = sink(options.onStdout, options.takeStdout);
      const err = sink(options.onStderr, options.takeStderr);
      const say = (line) => [...bytesOf(`${line}\n`)].forEach(err.put);
      let exit = FAULT;
      let written = {};
      try {
        const own = await instance(options, out, err);
        const { FS } = own;
        FS.mkdirTree(FOLDER);
        if (!options.mount) writeTree(FS, files);
        FS.chdir(options.mount ? options.mount(FS) : FOLDER);
        try {
          exit = own.callMain([...args]);
        } catch (error) {
          if (!error || error.name !== 'ExitStatus') throw error;
          exit = error.status;
        } finally {
          if (!options.mount) written = readTree(FS, files);
        }
      } catch (error) {
        exit = FAULT;
        say(faultLine(error));
      }
      return { exit, stdout: out.end(), stderr: err.end(), files: written };
    }

    return { run, module: compiled };
  }

  if (typeof module === 'object' && module.exports) module.exports = { makeEngine };
  root.makeEngine = makeEngine;
})(typeof globalThis === 'object' ? globalThis : this);
