// The page: a framework, questions in plain words, a search, a plan.

const $ = (id) => document.getElementById(id);
const sources = [$('worker').textContent, $('wasm').textContent];
const engine = new EngineClient(...sources), adviser = new EngineClient(...sources); // advice does not wait for a search
const QUESTIONS = ['pull', 'cords', 'ends', 'aim', 'joint', 'seconds'];
const LATER_QUESTIONS = ['width', 'bed', 'names', 'key', 'start', 'most', 'raised']; // about its pieces
const text = (bytes) => new TextDecoder().decode(bytes);

let frame = null; // thread-frame, as JSON
let name = ''; // of the file, without its ending
let plan = ''; // text of plan.json
let best = ''; // the same, while the search runs
let said = ''; // what the program said of the plan when it was made
let kit = {}; // files of its pieces, once they are made
let rise = {}; // files of how they rose
let past = []; // states before, for Undo
const sketch = new Sketch($('sketch'), (node) => changeFeet(toggled(node)));

// ---- words ----

function complain(line) {
  $('trouble').hidden = !line;
  $('trouble').textContent = line;
}

// The line that the command line would print, without the name of the program.
const lastLine = (stderr) => stderr.trim().split('\n').filter((line) => !/^thread: note:/.test(line)).pop()?.replace(/^thread: /, '') || '';

const notesOf = (stderr) => stderr.split('\n').filter((line) => /^thread: note:/.test(line)).map((line) => line.replace(/^thread: note: /, ''));

// ---- state: undo, reload, link ----

const answers = () => Object.fromEntries([...QUESTIONS, ...LATER_QUESTIONS].map((id) => [id, $(id).value]));

// Numbers of cords that are not in the list, which advice and links may bring, are added to it.
function setAnswers(given) {
  for (const id of LATER_QUESTIONS) if (given[id] !== undefined) $(id).value = given[id];
  for (const id of QUESTIONS) {
    const value = given[id], known = [...$(id).options].some((option) => option.value === value);
    if (value === undefined) continue;
    if (!known && id === 'cords' && /^[1-9]\d{0,2}$/.test(value)) $(id).add(new Option(value));
    else if (!known) continue;
    $(id).value = value;
  }
}

const state = () => ({frame, name, plan, said, answers: answers()});
let settled = null; // the state that Undo comes back to

function remember() {
  if (settled) past.push(settled);
  past = past.slice(-50);
  settled = state();
  $('undo').disabled = past.length === 0;
  keep('now', settled);
}

function restore(before) {
  ({frame, name, plan, said} = before);
  setAnswers(before.answers);
  settled = state();
  showFrame();
  showResult();
  keep('now', settled);
}

function undo() {
  const before = past.pop();
  $('undo').disabled = past.length === 0;
  if (before) restore(before);
}

const hashOf = () => new URLSearchParams(answers()).toString();

async function copyLink() {
  const link = `${location.href.split('#')[0]}#${hashOf()}`;
  const copied = await navigator.clipboard?.writeText(link).then(() => true, () => false);
  if (!copied) window.prompt('Copy this link:', link);
  $('link').textContent = copied ? 'The link is copied' : 'Copy a link to these answers';
}

// A link's answers hold once: what is changed afterwards survives a reload.
function takeLink() {
  if (!location.hash) return;
  setAnswers(Object.fromEntries(new URLSearchParams(location.hash.slice(1))));
  history.replaceState(null, '', location.href.split('#')[0]);
}

// ---- 1: the framework ----

async function openFile(file) {
  const bytes = new Uint8Array(await file.arrayBuffer()), ending = /\.[^.]*$/.exec(file.name)?.[0].toLowerCase() || '';
  const title = file.name.replace(/\.[^.]*$/, '') || 'framework';
  if (ending !== '.3dm') return readBytes(bytes, title, `given${ending}`, file.name);
  const frame = await readRhino(bytes, file.name);
  if (frame) await readBytes(new TextEncoder().encode(frame.text), title, 'given.json', file.name, frame.notes);
}

let rhino = null; // thread-3dm.js, once it is wanted

// It lies beside the page: rhino3dm with its reader.
function loadRhino() {
  return new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = 'thread-3dm.js';
    script.addEventListener('load', resolve);
    script.addEventListener('error', () => reject(new Error('3dm files want thread-3dm.js in the folder of this page; or save it as DXF or OBJ')));
    document.head.append(script);
  });
}

// A 3dm file as frame JSON, with notes; undefined with the trouble said.
async function readRhino(bytes, shownName) {
  complain('');
  busy(`Reading ${shownName} ..`);
  try {
    await (rhino ??= loadRhino());
    return await frameOf3dm(bytes);
  } catch (error) {
    if (!globalThis.frameOf3dm) rhino = null; // the file may be put there
    complain(`${shownName}: ${error.message}`);
    return undefined;
  } finally {
    busy('');
  }
}

async function readBytes(bytes, title, path, shownName, more = []) {
  complain('');
  busy(`Reading ${shownName} ..`);
  const isPlan = /^\s*\{\s*"format"\s*:\s*"thread-plan"/.test(text(bytes.subarray(0, 200)));
  const {exit, stderr, files} = await engine.run(['convert', path, '-T', 'json', '-o', 'frame.json'], {[path]: bytes});
  busy('');
  if (exit !== 0 || !files['frame.json']) {
    complain(lastLine(stderr).replaceAll(path, shownName));
    return;
  }
  frame = JSON.parse(text(files['frame.json']));
  name = title;
  plan = said = '';
  if (!frame.feet?.length) $('ends').value = 'any';
  if (isPlan) plan = text(bytes);
  remember();
  showFrame([...more, ...notesOf(stderr)].map((note) => note.replaceAll(path, shownName)));
  await showResult();
}

async function example(words) {
  const [shape, size] = words.split(' ');
  const {files, exit, stderr} = await engine.run(['make', shape, '--size', size, '-o', 'frame.json']);
  if (exit) complain(lastLine(stderr));
  else await readBytes(files['frame.json'], `${shape}${size}`, 'given.json', shape);
}

// Also for those who hear the page: at once, or of what comes often now and then.
let heard = 0;
function hear(words, often = false) {
  if (often && Date.now() - heard < 5000) return;
  heard = Date.now();
  $('heard').textContent = words;
}

const plural = (n, word) => `${n} ${word}${n === 1 ? '' : 's'}`;

function showFrame(notes = []) {
  $('shown').hidden = $('question-part').hidden = !frame;
  if (!frame) return;
  const said = [`${name}: ${plural(frame.nodes.length, 'piece')} that meet at ${plural(frame.edges.length, 'interface')}`, ...notes];
  $('counts').textContent = `${said.join('. ')}.`;
  hear($('counts').textContent);
  $('feet').value = (frame.feet || []).map(nameOf).join(', ');
  sketch.show(frame);
  advise();
}

const nameOf = (node) => (frame.names ? String(frame.names[node]) : String(node));

function toggled(node) {
  const feet = new Set(frame.feet || []);
  if (!feet.delete(node)) feet.add(node);
  return [...feet].sort((a, b) => a - b);
}

function changeFeet(feet) {
  frame = {...frame, feet};
  plan = said = '';
  if (!feet.length && $('ends').value === 'feet') $('ends').value = 'any';
  remember();
  showFrame();
  showResult();
}

function typedFeet() {
  const wanted = $('feet').value.split(/[,;]\s*/).map((word) => word.trim()).filter(Boolean);
  const found = wanted.map((word) => frame.nodes.findIndex((_, node) => nameOf(node).toLowerCase() === word.toLowerCase()));
  const lost = wanted.filter((_, i) => found[i] < 0);
  complain(lost.length ? `There is no piece ${lost.join(', ')}; the first is ${nameOf(0)}.` : '');
  if (!lost.length) changeFeet([...new Set(found)].sort((a, b) => a - b));
}

async function lowestFeet() {
  const {exit, stderr, files} = await engine.run(['convert', 'frame.json', '--feet', 'lowest', '-o', 'out.json'], {'frame.json': frameText()});
  if (exit) complain(lastLine(stderr));
  else changeFeet(JSON.parse(text(files['out.json'])).feet || []);
}

const frameText = () => JSON.stringify(frame);
const frameFile = () => `${name.replace(/[^\w.-]+/g, '-').replace(/^[-.]+/, '') || 'frame'}.json`; // named in pictures and commands

// ---- 2: the questions ----

let asked = 0;

// The row that the program recommends as a button, and the picture.
async function advise() {
  const mine = ++asked, figure = $('advice');
  figure.replaceChildren(caption('Looking how many cords a hand can pull ..'));
  adviser.stop();
  const args = ['advise', frameFile(), '--hand', $('pull').value || '10', '--json', '-T', 'svg', '-o', 'advice.svg'];
  const {exit, stdout, stderr, files} = await adviser.run(args, {[frameFile()]: frameText()});
  if (mine !== asked || exit === -1) return;
  if (stdout) figure.prepend(takeButton(JSON.parse(stdout))); // without a recommended row, too
  const picture = files['advice.svg'];
  if (!picture) {
    figure.lastChild.replaceWith(caption(lastLine(stderr) || 'No advice for this framework.'));
    return;
  }
  const image = new Image();
  image.alt = 'Pull and length of cord against the number of cords';
  image.src = URL.createObjectURL(new Blob([picture], {type: 'image/svg+xml'}));
  figure.lastChild.replaceWith(image);
}

const ENDS = {feet: 'to the feet', any: 'ending anywhere', closed: 'in loops'};

function takeButton({rows, recommended}) {
  const row = rows[recommended], button = document.createElement('button');
  button.type = 'button';
  button.textContent = row ? `Take ${plural(row.cords, 'cord')} ${ENDS[row.ends]}, ${row.pull.toPrecision(2)} N to pull` : 'No number of cords is easy enough';
  button.disabled = !row;
  button.addEventListener('click', () => {
    setAnswers({cords: String(row.cords), ends: row.ends, aim: 'tortuosity', pull: ''});
    remember();
    $('go').focus();
  });
  return button;
}

function caption(words) {
  const node = document.createElement('figcaption');
  node.textContent = words;
  return node;
}

// The command line that the answers stand for.
function wanted() {
  const {pull, cords, ends, aim, joint, seconds} = answers(), args = ['plan', frameFile(), '--objective', aim, '--ends', ends, '--joint', joint];
  if (pull) args.push('--max-pull', pull);
  if (cords) args.push('--cords', cords);
  return [...args, '--time-limit', seconds, '--progress', '-o', 'plan.json'];
}

// ---- the search ----

// stop: what the button says that ends the work; none without it.
function busy(words, stop = '', title = 'At work') {
  for (const id of ['frame-part', 'question-part', 'result-part', 'kit-part', 'rise-part']) $(id).inert = Boolean(words); // a search is for what is shown
  $('work-part').hidden = !words;
  $('work-title').textContent = title;
  $('work').textContent = words;
  if (words) hear(words);
  $('bar').removeAttribute('value');
  $('stop').hidden = !stop;
  $('stop').textContent = stop;
  $('go').disabled = Boolean(words);
}

const degrees = (rad) => `${((rad * 180) / Math.PI).toFixed(0)} degrees`;

// What a line of progress says, in words: of the plan, or of what is proved.
function progressWords(line) {
  if (!line.startsWith('{')) return {};
  const {what, best: value, bound, gap, length, cords, done} = JSON.parse(line);
  if (what === 'plan') return {plan: `Found: ${plural(cords, 'cord')}, ${length.toPrecision(4)} ${frame.units || ''}.`};
  if (done !== undefined) return {done, what};
  if (!(bound > 0)) return {};
  const better = gap >= 0.005 ? `Nothing can be more than ${gap.toPrecision(2)} % better` : 'Nothing is better';
  if (what !== 'turning') return {proved: `${better}.`};
  return {proved: `It turns by ${degrees(value)}, and none can by less than ${degrees(bound)}: ${better.toLowerCase()}.`};
}

async function search(event) {
  event.preventDefault();
  complain('');
  busy('Searching ..', 'Stop and keep the best', 'Searching');
  best = '';
  const told = {};
  let heardPlan;
  const onLine = (line) => {
    Object.assign(told, progressWords(line));
    $('work').textContent = ['Searching ..', told.plan, told.proved].filter(Boolean).join(' ');
    hear($('work').textContent, told.plan === heardPlan);
    heardPlan = told.plan;
    if (told.done > 0) $('bar').value = told.done;
  };
  const onPlan = (found) => {
    best = found;
    keep('search', {...state(), plan: best, said: ''}); // closing the page loses nothing that was found
  };
  const {exit, stdout, stderr, files} = await engine.run(wanted(), {[frameFile()]: frameText()}, {onLine, onPlan});
  busy('');
  keep('search', null);
  const found = files['plan.json'] ? text(files['plan.json']) : best;
  if (!found) {
    complain(exit === -1 ? 'Stopped before anything was found.' : lastLine(stderr));
    return;
  }
  plan = found;
  said = stdout.replace(/^plan +plan\.json\n/m, '').trim();
  remember();
  await showResult();
  if (exit === -1) $('verdict').textContent += ` The search was stopped. ${told.proved || 'Nothing was proved by then'}`.replace(/\.?$/, '.');
  else if (exit !== 0) $('verdict').textContent += ` Of the search: ${lastLine(stderr)}.`;
  hear($('verdict').textContent);
}

// ---- 3: the result ----

async function draw(type, file) {
  const {exit, stderr, files} = await engine.run(['draw', 'plan.json', '-T', type, '--page', $('paper').value, '-o', file], {'plan.json': plan});
  if (exit || !files[file]) complain(lastLine(stderr));
  return files[file];
}

async function showResult() {
  $('result-part').hidden = $('kit-part').hidden = $('rise-part').hidden = !plan;
  $('viewer').srcdoc = '';
  $('files').replaceChildren();
  showKit({});
  showRise({});
  if (!plan) return;
  const shown = plan, check = await engine.run(['check', 'plan.json'], {'plan.json': plan});
  if (shown !== plan) return;
  $('summary').textContent = said || check.stdout.replace(/^plan\.json: /, '').trim() || lastLine(check.stderr);
  $('verdict').textContent = check.exit === 0 ? 'Every claim of this plan was verified on this device.' : lastLine(check.stderr);
  const viewer = await draw('html', 'viewer.html');
  if (viewer && shown === plan) $('viewer').srcdoc = text(viewer);
  listFiles($('files'), FILES.map(([type, file]) => [file, () => contentOf(type, file)]));
  $('result-title').scrollIntoView({block: 'start'});
}

const FILES = [['plan', 'plan.json'], ['svg', 'overview.svg'], ['steps', 'steps.txt'], ['sheets.html', 'sheets.html'], ['html', 'viewer.html'],
  ['cords.csv', 'cords.csv'], ['beads.csv', 'beads.csv'], ['steps.csv', 'steps.csv'], ['channels.csv', 'channels.csv'], ['obj', 'cords.obj'],
  ['gltf', 'cords.gltf'], ['dxf', 'cords.dxf']];

const contentOf = async (type, file) => (type === 'plan' ? new TextEncoder().encode(plan) : draw(type, file));

function save(blob, title) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = title;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// named: [[name, what gives its bytes] ..]
function listFiles(list, named) {
  list.replaceChildren(...named.map(([file, content]) => {
    const item = document.createElement('li'), link = document.createElement('a');
    link.href = '#';
    link.textContent = file;
    link.addEventListener('click', async (event) => {
      event.preventDefault();
      const bytes = await content();
      if (bytes) save(new Blob([bytes]), file);
    });
    item.append(link);
    return item;
  }));
}

async function saveAll() {
  const files = {};
  busy('Drawing everything ..');
  for (const [type, file] of FILES) {
    const bytes = await contentOf(type, file);
    if (bytes) files[file] = bytes;
  }
  busy('');
  save(zip({...files, ...kit, ...rise}), `${name || 'plan'}.zip`);
}

async function openBooklet() {
  const page = window.open('', '_blank');
  const bytes = await draw('sheets.html', 'sheets.html');
  if (!bytes) return page?.close();
  const url = URL.createObjectURL(new Blob([bytes], {type: 'text/html'}));
  if (page) page.location = url;
  else save(new Blob([bytes], {type: 'text/html'}), 'sheets.html');
}

// ---- 4: the pieces ----

// A line of the program in the words of the page, which has no options: "--width 4" is "width 4".
const inWords = (line) => line.replace(/ \(plan --scale\)| \(see `[^`]*`\)/g, '').replace(/--([a-z-]+)/g, (_, option) => option.replaceAll('-', ' '));

const capital = (words) => words[0].toUpperCase() + words.slice(1);
const sentences = (lines) => lines.map((line) => `${capital(line)}.`).join(' ');

// Hears of a part of the work that is done: the bar, and words, those of the program if none are given, with a percentage.
const showDone = (words) => (line) => {
  const {done, what} = progressWords(line);
  if (!(done > 0)) return;
  $('bar').value = done;
  $('work').textContent = `${words ?? capital(what)} .. ${Math.floor(100 * done)} %`;
  hear($('work').textContent, true);
};

// What the command line writes of a kit: {'kit/kit.3mf': bytes ..}, and what it says.
function showKit(files, lines = []) {
  const figure = $('kit-picture'), picture = files['kit/kit.png'], parts = Object.entries(files).filter(([file]) => /\.stl$/.test(file));
  kit = files;
  $('kit-said').textContent = sentences(lines);
  figure.replaceChildren(caption('The pieces appear here. Many of them take minutes.'));
  listFiles($('kit-files'), [...Object.keys(files).filter((file) => !/\.stl$/.test(file)).map((file) => [file.replace('kit/', ''), () => files[file]]),
    ...(parts.length ? [['stl.zip', () => zip(Object.fromEntries(parts.map(([file, bytes]) => [file.replace('kit/', ''), bytes])))]] : [])]);
  if (!picture) return;
  const image = new Image();
  image.alt = 'The pieces in their places, translucent, with the cords in them';
  image.src = URL.createObjectURL(new Blob([picture], {type: 'image/png'}));
  figure.replaceChildren(image);
}

async function makeKit(event) {
  event.preventDefault();
  complain('');
  busy('Making the pieces ..', 'Stop', 'Making the pieces');
  const {width, bed, names, key} = answers(), args = ['kit', 'plan.json', '--bed', bed.replaceAll(' ', '').replace('×', 'x'), '--names', names, '--key', key];
  if (width) args.push('--width', width);
  const {exit, stderr, files} = await engine.run([...args, '--stl', '--progress', '-o', 'kit'], {'plan.json': plan}, {onLine: showDone('Making the pieces')});
  busy('');
  if (exit !== 0) {
    showKit({});
    complain(exit === -1 ? 'Stopped: no pieces were made.' : inWords(lastLine(stderr)));
    return;
  }
  const lines = stderr.trim().split('\n').filter((line) => /^thread: (?!written to )/.test(line));
  showKit(files, lines.map((line) => inWords(line.replace(/^thread: /, ''))));
  $('viewer').srcdoc = text(files['kit/kit.html']); // the same steps, with these pieces
  hear($('kit-said').textContent);
  $('kit-title').scrollIntoView({block: 'start'});
}

// ---- 5: how they rise ----

const RISE_FILES = ['rise.html', 'rise.png', 'rise.svg', 'booklet.html', 'rise.json'];

// What the command line writes of a rise: {'rise.html': bytes ..}, and what it says.
function showRise(files, lines = []) {
  rise = files;
  $('rise-said').textContent = sentences(lines);
  listFiles($('rise-files'), RISE_FILES.filter((file) => files[file]).map((file) => [file, () => files[file]]));
  if (!files['rise.html']) {
    $('rise-picture').replaceChildren(caption('The pieces rise here, pulled by their cords in simulation. Many of them take minutes.'));
    return;
  }
  const player = document.createElement('iframe');
  player.title = 'The pieces as they rise';
  player.srcdoc = text(files['rise.html']);
  $('rise-picture').replaceChildren(player);
}

// The pieces are as wide as those to print.
async function makeRise(event) {
  event.preventDefault();
  complain('');
  busy('Pulling the cords ..', 'Stop', 'Pulling the cords');
  const {start, most, raised, width} = answers(), args = ['rise', 'plan.json', '--start', start];
  if (most) args.push('--pull', most);
  if (raised.trim()) args.push('--raise', raised.trim());
  if (width) args.push('--width', width);
  const outputs = ['--play', 'rise.html', '--film', 'rise.png', '--plot', 'rise.svg', '--booklet', 'booklet.html', '--page', $('paper').value, '-o', 'rise.json'];
  const {exit, stdout, stderr, files} = await engine.run([...args, ...outputs, '--progress'], {'plan.json': plan}, {onLine: showDone()});
  busy('');
  if (exit !== 0) {
    showRise({});
    complain(exit === -1 ? 'Stopped: nothing was seen.' : inWords(lastLine(stderr)));
    return;
  }
  showRise(files, stdout.trim().split('\n'));
  hear($('rise-said').textContent);
  $('rise-title').scrollIntoView({block: 'start'});
}

// ---- events ----

function listenForFiles() {
  const drop = $('drop');
  $('file').addEventListener('change', () => $('file').files[0] && openFile($('file').files[0]).then(() => ($('file').value = '')));
  for (const kind of ['dragover', 'drop', 'dragleave'])
    document.addEventListener(kind, (event) => {
      event.preventDefault();
      drop.classList.toggle('over', kind === 'dragover');
      if (kind === 'drop' && event.dataTransfer.files[0] && !$('frame-part').inert) openFile(event.dataTransfer.files[0]);
    });
  $('example').addEventListener('change', () => $('example').value && example($('example').value).then(() => ($('example').value = '')));
}

async function begin() {
  listenForFiles();
  $('questions').addEventListener('submit', search);
  $('questions').addEventListener('change', (event) => {
    remember();
    if (event.target.id === 'pull') advise();
  });
  for (const [form, make] of [['kit-questions', makeKit], ['rise-questions', makeRise]]) {
    $(form).addEventListener('submit', make);
    $(form).addEventListener('change', remember);
  }
  $('stop').addEventListener('click', () => engine.stop());
  $('undo').addEventListener('click', undo);
  $('link').addEventListener('click', copyLink);
  $('feet').addEventListener('change', typedFeet);
  $('lowest').addEventListener('click', lowestFeet);
  $('booklet').addEventListener('click', openBooklet);
  $('all').addEventListener('click', saveAll);
  document.addEventListener('keydown', (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === 'z' && event.target.tagName !== 'INPUT' && !$('frame-part').inert) undo();
  });
  const {now: before, search: cut} = await kept();
  if (before?.frame) restore(before);
  if (cut?.frame) { // a search that the page's end cut short: Undo goes back to the plan before
    if (before?.frame) past.push(before);
    restore(cut);
    $('undo').disabled = past.length === 0;
    keep('search', null);
  }
  takeLink();
  document.documentElement.dataset.ready = '';
}

begin();
