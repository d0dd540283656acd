// The program as WebAssembly beside the installed one: compare.cjs PROGRAM BUILD PACKAGES SCRATCH FRAMES. Closes with "N passed, N failed".
'use strict';
const {spawnSync} = require('node:child_process');
const {createRequire} = require('node:module');
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const zlib = require('node:zlib');

const [program, build, packages, scratch] = process.argv.slice(2, 6).map((name) => path.resolve(name));
const nFrames = Number(process.argv[6]);
const {makeEngine} = require(path.join(build, 'engine.js'));
const commandLine = path.join(build, 'npm', 'thread.js');
const OBJECTIVES = ['length', 'tortuosity', 'symmetry'];
const LONG = '120'; // s; every plan here is proved in a small part of them, as what the time ends is not always the same
const place = (name) => path.join(scratch, name);
const seconds = (from) => (performance.now() - from) / 1000;

// ---- frameworks: files of data/, and words for `thread make` ----

const FRAMES = [
  'dome --size 4', 'dome7.json', 'geodesic --size 2', 'conmech/four-frame.json', 'tube --size 8 --rings 5', 'jax_fdm/barrel.obj',
  'dome --size 5', 'honeycomb --size 2', 'sphere --size 1', 'dome7-lines.json', 'dome --size 6', 'geodesic --size 3',
  'dome --size 8', 'dome --size 9', 'tube --size 12 --rings 7', 'honeycomb --size 3', 'conmech/tower_3D.json',
  'jax_fdm/monkey_saddle.json', 'dome7-snake.json', 'dome7-stairs.json',
];

function native(...words) {
  const env = {...process.env, XDG_CACHE_HOME: place('cache')}; // of simulated joints: none are there yet
  const run = spawnSync(program, words, {cwd: scratch, env, encoding: 'utf8', maxBuffer: 1 << 28});
  return {exit: run.status, stdout: run.stdout, stderr: run.stderr};
}

function frameOf(words, i) {
  if (!words.includes('--')) {
    const name = `frame${i}${path.extname(words)}`;
    fs.copyFileSync(path.join('data', words), place(name));
    return name;
  }
  assert.equal(native('make', ...words.split(' '), '-o', `frame${i}.json`).exit, 0);
  return `frame${i}.json`;
}

// ---- what is compared ----

// All of a plan but the line that names the program.
const withoutGenerator = (text) => text.replace(/^ *"generator": .*$/m, '');

function cases() {
  return FRAMES.slice(0, nFrames).flatMap((words, i) => {
    const frame = frameOf(words, i);
    return OBJECTIVES.map((objective) => ({
      words, frame, objective,
      plan: ['plan', frame, '--objective', objective, '--time-limit', LONG, '-q', '-o', 'plan.json'],
      evaluate: ['eval', 'plan.json', '--json'],
    }));
  });
}

// The plan and its evaluation, by any engine that has run().
async function both(run, one) {
  const data = new Uint8Array(fs.readFileSync(place(one.frame)));
  const planned = await run(one.plan, {[one.frame]: data});
  assert.equal(planned.exit, 0, planned.stderr);
  const text = Buffer.from(planned.files['plan.json']).toString();
  const evaluated = await run(one.evaluate, {'plan.json': text});
  assert.equal(evaluated.exit, 0, evaluated.stderr);
  return {plan: text, evaluation: evaluated.stdout};
}

function wanted(one) {
  if (one.wanted) return one.wanted;
  const planned = native(...one.plan);
  assert.equal(planned.exit, 0, planned.stderr);
  const evaluated = native(...one.evaluate);
  assert.equal(evaluated.exit, 0, evaluated.stderr);
  one.wanted = {plan: fs.readFileSync(place('plan.json'), 'utf8'), evaluation: evaluated.stdout};
  return one.wanted;
}

// Equal, but for the last digits of numbers: the installed program takes glibc's exp, which has other digits on processors with a
// fused multiply-add (one value in 2,000), and friction is an exp of every turn.
function assertNear(made, want, where) {
  if (typeof want === 'number' && typeof made === 'number') {
    assert.ok(Math.abs(made - want) <= 1e-12 * Math.abs(want), `${where}: ${made}, not ${want}`);
  } else if (want && made && typeof want === 'object' && typeof made === 'object') {
    assert.deepEqual(Object.keys(made), Object.keys(want), where);
    for (const key of Object.keys(want)) assertNear(made[key], want[key], `${where}.${key}`);
  } else {
    assert.equal(made, want, where);
  }
}

async function compare(run, one) {
  const made = await both(run, one);
  fs.writeFileSync(place('web.json'), made.plan);
  const checked = native('check', 'web.json');
  assert.equal(checked.exit, 0, checked.stdout + checked.stderr);
  assert.equal(withoutGenerator(made.plan), withoutGenerator(wanted(one).plan), 'plan.json');
  assertNear(JSON.parse(made.evaluation), JSON.parse(wanted(one).evaluation), 'eval');
}

// ---- numbers: every kind of double, read and written again ----

function numbers() {
  let seed = 1n;
  const word = () => (seed = (seed * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn);
  const view = new DataView(new ArrayBuffer(8));
  const lines = [];
  const some = () => {
    for (;;) {
      view.setBigUint64(0, word());
      const x = view.getFloat64(0);
      if (Math.abs(x) < 1e12 && Math.abs(x) > 1e-12) return x;
      const tame = Number(word() >> 11n) / 2 ** 53;
      return word() & 1n << 40n ? tame * 1e4 : 2 ** Number((word() >> 40n) % 60n - 30n); // powers of two are the hard ones
    }
  };
  for (let i = 0; i < 400; i++) lines.push(`v ${some()} ${some()} ${some()}`);
  for (let i = 1; i < 400; i++) lines.push(`l ${i} ${i + 1}`);
  return lines.join('\n') + '\n';
}

async function numbersTest(run) {
  const text = numbers();
  fs.writeFileSync(place('numbers.obj'), text);
  for (const out of ['out.json', 'out.csv']) {
    assert.equal(native('convert', 'numbers.obj', '--units', 'mm', '-o', out).exit, 0);
    const made = await run(['convert', 'numbers.obj', '--units', 'mm', '-o', out], {'numbers.obj': text});
    assert.equal(made.exit, 0, made.stderr);
    assert.equal(Buffer.from(made.files[out]).toString(), fs.readFileSync(place(out), 'utf8'), out);
  }
}

// ---- the command line under node ----

function npm(words, more = {}) {
  const run = spawnSync('sh', ['-c', 'umask 027; exec node "$@"', 'sh', commandLine, ...words], {cwd: scratch, encoding: 'utf8', ...more});
  return {exit: run.status, stdout: run.stdout, stderr: run.stderr};
}

const commandLineTests = {
  'processor time is measured, which searches with a time limit go by': () => {
    const words = ['plan', 'frame1.json', '--objective', 'tortuosity', '--tune', 'nodes=3', '-v', '-o', 'clock.json'], begun = Date.now(), {stderr} = npm(words);
    const told = [...stderr.matchAll(/([0-9.]+) CPU s/g)].map((match) => Number(match[1])), gone = (Date.now() - begun) / 1000;
    assert.ok(told.length > 1 && told[0] < told.at(-1) && told.at(-1) <= gone, `${told.join(', ')} in ${gone} s`);
  },
  'files are written with the rights that the umask gives': () => {
    assert.equal(npm(['plan', 'frame1.json', '-q', '-o', 'mode.json', '--draw', 'drawn']).exit, 0);
    assert.equal(fs.statSync(place('mode.json')).mode & 0o777, 0o640);
    assert.equal(fs.statSync(place('drawn/overview.svg')).mode & 0o777, 0o640);
    assert.equal(fs.statSync(place('drawn')).mode & 0o777, 0o750);
    assert.equal(native('check', 'mode.json').exit, 0);
  },
  'a file that is there keeps its rights': () => {
    fs.writeFileSync(place('kept.json'), '', {mode: 0o600});
    assert.equal(npm(['plan', 'frame1.json', '-q', '-o', place('kept.json')]).exit, 0);
    assert.equal(fs.statSync(place('kept.json')).mode & 0o777, 0o600);
  },
  'pipes: - is stdin and stdout': () => {
    const plan = npm(['plan', '-', '-q', '-o', '-'], {input: fs.readFileSync(place('frame1.json'))});
    assert.equal(plan.exit, 0, plan.stderr);
    assert.equal(npm(['check', '-'], {input: plan.stdout}).exit, 0);
  },
  'bad input: the same line, the same exit code': () => {
    fs.writeFileSync(place('bad.obj'), 'v 0 0 0\nv 1 x 0\nl 1 2\n');
    for (const words of [['info', 'bad.obj'], ['plan', 'nosuch.json'], ['plan'], ['plan', '--cords', 'x', 'frame1.json'], ['check', 'frame1.json']]) {
      const {exit, stderr} = native(...words);
      const made = npm(words);
      assert.deepEqual([made.exit, made.stderr], [exit, stderr], words.join(' '));
    }
  },
  'a PDF is refused in one line': () => {
    npm(['plan', 'frame1.json', '-q', '-o', 'pdf.json']);
    const {exit, stderr} = npm(['draw', 'pdf.json', '-T', 'pdf', '-o', 'x.pdf']);
    assert.equal(exit, 70);
    assert.match(stderr, /^thread: .*no PDF.*$/m);
  },
};

// ---- the package, as npm installs it ----

const packageTests = {
  'packed, installed into an empty folder, run by its names and from a program': () => {
    const home = place('installed'), quiet = ['--no-audit', '--no-fund', '--offline', '--silent'];
    const sh = (command, ...words) => {
      const run = spawnSync(command, words, {cwd: home, encoding: 'utf8'});
      assert.equal(run.status, 0, `${command} ${words.join(' ')}: ${run.stderr}`);
      return run.stdout.trim();
    };
    fs.mkdirSync(home, {recursive: true});
    const file = sh('npm', 'pack', path.join(build, 'npm'), '--silent').split('\n').at(-1);
    fs.writeFileSync(path.join(home, 'package.json'), '{"name": "empty", "version": "1.0.0"}');
    sh('npm', 'install', `./${file}`, ...quiet);
    for (const name of ['thread-plan', 'thread']) assert.equal(sh('npx', '--offline', name, '--version').replace('32 bits', '64 bits'), native('--version').stdout.trim()); // of nauty's words
    sh('npx', '--offline', 'thread-plan', 'make', 'dome', '-o', 'dome.json');
    sh('npx', '--offline', 'thread-plan', 'plan', 'dome.json', '--cords', '1', '-q', '-o', 'plan.json');
    fs.writeFileSync(path.join(home, 'program.js'), `require('thread-plan').makeEngine()
      .then((engine) => engine.run(['check', 'plan.json'], {'plan.json': require('fs').readFileSync('plan.json')}))
      .then(({exit}) => process.exit(exit));`);
    sh('node', 'program.js');
    assert.ok(fs.existsSync(path.join(home, 'node_modules/thread-plan/engine.d.ts')));
  },
};

// ---- a search that is watched and stopped ----

const watched = ['plan', 'sphere.json', '--objective', 'tortuosity', '--time-limit', '60', '--progress', '-q', '-o', 'plan.json'];

async function stopTest(run) {
  assert.equal(native('make', 'sphere', '--size', '6', '-o', 'sphere.json').exit, 0);
  const lines = [];
  let best;
  const made = await run(watched, {'sphere.json': fs.readFileSync(place('sphere.json'), 'utf8')}, {
    onStderr: (line) => line.startsWith('{') && lines.push(JSON.parse(line)),
    onPlan: (text) => (best = text),
    isStopped: () => best !== undefined,
  });
  assert.equal(made.exit, 5, made.stderr);
  assert.ok(lines.some((line) => line.what === 'plan' && line.length > 0));
  for (const text of [best, Buffer.from(made.files['plan.json'])]) {
    fs.writeFileSync(place('stopped.json'), text);
    assert.equal(native('check', 'stopped.json').exit, 0);
  }
}

async function memoryTest(run) {
  const frame = fs.readFileSync(place('frame1.json'), 'utf8');
  const held = [];
  for (let i = 0; i < 40; i++) {
    const made = await run(['plan', 'frame1.json', '-q', '-o', 'plan.json'], {'frame1.json': frame});
    assert.equal(made.exit, 0);
    if (global.gc) global.gc();
    held.push(process.memoryUsage().arrayBuffers);
  }
  assert.ok(Math.min(...held.slice(-10)) < 10 * (64 << 20), 'each of 40 runs has 64 MB of its own, which are not kept');
}

// ---- Chromium ----

// A page from the disk whose worker has the engine, as thread.html has it; returns run().
async function openPage(browser) {
  const wasm = fs.readFileSync(path.join(build, 'thread-engine.wasm')).toString('base64');
  const code = ['thread-engine.js', 'engine.js'].map((name) => fs.readFileSync(path.join(build, name), 'utf8')).join('\n');
  const worker = `${code}
    let engine;
    onmessage = async ({data: [id, args, files, wasm]}) => {
      engine = engine || (await makeEngine({factory: ThreadEngine, wasm}));
      postMessage([id, await engine.run(args, files)]);
    };`;
  const html = `<!doctype html><meta charset="utf-8"><title>engine</title>
    <script type="text/plain" id="worker">${worker.replace(/<\//g, '<\\/')}</script>
    <script>
      const bytes = Uint8Array.from(atob('${wasm}'), (c) => c.charCodeAt(0));
      const worker = new Worker(URL.createObjectURL(new Blob([document.getElementById('worker').textContent], {type: 'text/javascript'})));
      const waiting = new Map();
      let n = 0;
      worker.onmessage = ({data: [id, result]}) => waiting.get(id)(result);
      worker.onerror = (event) => (document.title = event.message);
      window.run = (args, files) => new Promise((resolve) => {
        waiting.set(n, resolve);
        worker.postMessage([n++, args, files, bytes]);
      });
    </script>`;
  fs.writeFileSync(place('page.html'), html);
  const page = await browser.newPage();
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  await page.goto(require('node:url').pathToFileURL(place('page.html')).href);
  const run = async (args, files) => {
    const texts = Object.fromEntries(Object.entries(files).map(([name, data]) => [name, Buffer.from(data).toString()]));
    const made = await page.evaluate(async ([words, given]) => {
      const done = await window.run(words, given);
      const decode = (data) => new TextDecoder().decode(data);
      return {...done, files: Object.fromEntries(Object.entries(done.files).map(([name, data]) => [name, decode(data)]))};
    }, [args, texts]);
    return made;
  };
  return {run, asked};
}

// ---- sizes and times ----

function sizesTest() {
  const js = fs.readFileSync(path.join(build, 'thread-engine.js')), wasm = fs.readFileSync(path.join(build, 'thread-engine.wasm'));
  const packed = zlib.gzipSync(js, {level: 9}).length + zlib.gzipSync(wasm, {level: 9}).length;
  console.log(`size    engine ${((js.length + wasm.length) / 1e6).toFixed(2)} MB, ${(packed / 1e6).toFixed(2)} MB compressed`);
  assert.ok(js.length + wasm.length < 5e6 && packed < 1.6e6);
  const html = fs.readFileSync(path.join(build, 'thread.html')), small = zlib.gzipSync(html, {level: 9}).length;
  console.log(`size    thread.html ${(html.length / 1e6).toFixed(2)} MB, ${(small / 1e6).toFixed(2)} MB compressed`);
  assert.ok(html.length < 5e6 && small < 1.6e6);
}

async function time(run, name, words, files) {
  const before = performance.now();
  assert.ok([0, 5].includes((await run(words, files)).exit));
  const web = seconds(before), from = performance.now();
  native(...words);
  console.log(`time    ${name}: native ${seconds(from).toFixed(2)} s, wasm ${web.toFixed(2)} s, ratio ${(web / seconds(from)).toFixed(1)}`);
}

async function timesTest(run) {
  const frame = (name) => ({[name]: fs.readFileSync(place(name), 'utf8')});
  native('make', 'dome', '--size', '32', '-o', 'shell.json');
  native('plan', 'frame1.json', '-q', '-o', 'plan.json');
  await time(run, 'dome 7 x 7, plan', ['plan', 'frame1.json', '-q', '-o', 'plan.json'], frame('frame1.json'));
  await time(run, 'dome 7 x 7, check', ['check', 'plan.json'], frame('plan.json'));
  await time(run, 'dome 7 x 7, drawn', ['draw', 'plan.json', '-T', 'html', '-o', 'viewer.html'], frame('plan.json'));
  await time(run, 'shell of 1,984 edges, plan', ['plan', 'shell.json', '-q', '-o', 'shell-plan.json'], frame('shell.json'));
  native('make', 'sphere', '--size', '3', '-o', 'sphere.json');
  const search = ['plan', 'sphere.json', '--objective', 'tortuosity', '--tune', 'nodes=31', '--time-limit', '0', '-j', '1', '-q', '-o', 'sphere-plan.json'];
  await time(run, 'sphere, a search of 31 nodes for little turning', search, frame('sphere.json'));
  await time(run, 'dome 7 x 7, joints', ['eval', 'plan.json', '--method', 'joint', '--processes', '1', '-q'], frame('plan.json'));
}

// ---- all of it ----

let passed = 0, failed = 0;
async function test(name, body) {
  try {
    await body();
    passed++;
  } catch (error) {
    failed++;
    console.log(`FAIL  ${name}: ${String(error.message).slice(0, 1000)}`);
  }
}

async function main() {
  const engine = await makeEngine();
  const all = cases();
  fs.copyFileSync('data/dome7.json', place('frame1.json'));
  for (const one of all) await test(`node: ${one.words}, ${one.objective}`, () => compare(engine.run, one));
  await test('numbers', () => numbersTest(engine.run));
  await test('a search is watched and stopped', () => stopTest(engine.run));
  await test('memory is given back', () => memoryTest(engine.run));
  for (const [name, body] of Object.entries(commandLineTests)) await test(name, body);
  for (const [name, body] of Object.entries(packageTests)) await test(name, body);
  await test('sizes', sizesTest);
  await test('times', () => timesTest(engine.run));
  const {chromium} = createRequire(path.join(packages, 'package.json'))('playwright-core');
  const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium', args: ['--no-sandbox']});
  const page = await openPage(browser);
  for (const one of all) await test(`Chromium: ${one.words}, ${one.objective}`, () => compare(page.run, one));
  await test('Chromium: nothing is fetched', () => assert.ok(page.asked.every((url) => /^(file|blob|data):/.test(url)), String(page.asked)));
  await browser.close();
  console.log(`${passed} passed, ${failed} failed`);
  process.exitCode = failed > 0 ? 1 : 0;
}

main();
