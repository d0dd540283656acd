// The page: a framework, questions in plain words, a search, a plan.

const $ = (id) => document.getElementById(id);
const sources = [$('worker').textContent, WebAssembly.compileStreaming(inflated($('wasm').textContent, 'application/wasm'))];
const engine = new EngineClient(...sources), adviser = new EngineClient(...sources); // advice does not wait for a search
const QUESTIONS = ['pull', 'cords', 'ends', 'aim', 'joint', 'seconds'];
const READING_QUESTIONS = ['units', 'wide', 'up', 'weld', 'split', 'flat', 'pick', 'layers']; // about the file
const LATER_QUESTIONS = ['thick', 'width', 'bed', 'names', 'key', 'start', 'most', 'raised']; // about its cord and pieces
const text = (bytes) => new TextDecoder().decode(bytes);

let frame = null; // thread-frame, as JSON
let source = null; // {bytes, path, shownName, width, units}: the file that the framework was read from, and how wide it is as it is read; null: of a plan
let name = ''; // of the file, without its ending
let plan = ''; // text of plan.json
let best = ''; // the same, while the search runs
let made = null; // of that plan: the command
let said = ''; // what the program said of the plan when it was made
let kit = {}; // files of its pieces, once they are made
let rise = {}, risenOn = ''; // files of how they rose, and the paper of their booklet
let past = []; // states before, for Undo
let working = false; // a search is for what is shown
const sketch = new Sketch($('sketch'), (node) => working || changeFeet(toggled(node)));

// ---- words ----

// A line of the program in the words of the page, which has no commands and no options: "--up y" is the question "Which way is
// up?", "--width 4" is "width 4", and what only says which command to type is left out.
const inWords = (line) => line.replace(/ \((?:see )?`?(?:thread|plan|eval) [^)]*\)|[;:,] [^;:,`(]*`thread [^`]*`[^;]*|[;:,.] thread [a-z]+ [^;]*/g, '')
  .replace(/--(units|scale|up|weld|split|flat|pick|layers)\b(?! or )(?: (?:mm|cm|m|in|ft|[xyz]|all|NAME or N|N|[\d.]+(?:e[+-]?\d+)?)\b)?/g, (_, option) => questionOf(option))
  .replace(/(^|[^\w-])--([a-z][a-z-]*)/g, (_, before, option) => before + option.replaceAll('-', ' '));

const labelOf = (id) => document.querySelector(`label[for=${id}]`).textContent;
const questionOf = (option) => `“${labelOf(option === 'scale' ? 'wide' : option)}”`;

function complain(line) {
  $('trouble').hidden = !line;
  $('trouble').textContent = line;
}

// What appeared gets the focus, and so the eye.
function goTo(id) {
  $(id).focus({preventScroll: true});
  $(id).scrollIntoView({block: 'start'});
}

// The line that the command line would print, without the name of the program, and the notes before it.
const lastLine = (stderr) => inWords(stderr.trim().split('\n').filter((line) => !/^thread: note:/.test(line)).pop()?.replace(/^thread: /, '') || '');

// [what is noted, questions that it leaves open] ..; what option to give is left out: the question has a button.
function notesOf(stderr, shown = (words) => words) {
  const lines = stderr.split('\n').filter((line) => /^thread: note:/.test(line)).map((line) => shown(line.replace(/^thread: note: /, '')));
  return lines.map((line) => [inWords(line.replace(/(?:; if [^;:]*)?(?:[;:] | \()--(?:units|scale|up|weld|split|flat|pick|layers)\b.*$/, '')
    .replace('z is taken to point up, and only a line of nodes is lowest', 'it may lie on its side: only one line of pieces is at the bottom')
    .replace('the file names no unit, ', 'the file names no unit: its numbers are taken as millimetres, ')),
  [...line.matchAll(/--(units|scale|up|weld|split|flat|pick|layers)\b/g)].map(([, option]) => (option === 'scale' ? 'wide' : option))]);
}

function openQuestion(id) {
  $('reading').open ||= $('reading').contains($(id));
  $(id).focus({preventScroll: true});
  $(id).scrollIntoView({block: 'center'});
}

// ---- state: undo, reload, link ----

const answers = () => Object.fromEntries([...QUESTIONS, ...READING_QUESTIONS, ...LATER_QUESTIONS].map((id) => [id, $(id).value]));

// Numbers of cords that are not in the list, which advice and links may bring, are added to it in their place.
function offerCords(number) {
  const options = [...$('cords').options], next = options.find(({value}) => Number(value) >= Number(number));
  if (next?.value !== number) $('cords').add(new Option(number), next ?? null);
}

function setAnswers(given) {
  for (const id of LATER_QUESTIONS) if (given[id] !== undefined) $(id).value = given[id];
  setReading(given);
  for (const id of QUESTIONS) {
    const value = given[id], known = [...$(id).options].some((option) => option.value === value);
    if (value === undefined) continue;
    if (id === 'cords' && /^[1-9]\d{0,2}$/.test(value)) offerCords(value);
    else if (!known) continue;
    $(id).value = value;
  }
}

const state = () => ({frame, source, name, plan, made, said, answers: answers()});
let settled = null; // the state that Undo comes back to

function remember() {
  if (settled) past.push(settled);
  past = past.slice(-50);
  settled = state();
  $('undo').disabled = past.length === 0;
  keep('now', settled);
}

function restore(before) {
  ({frame, source = null, name, plan, made = null, said} = before);
  $('dropped').hidden = true;
  setAnswers(before.answers);
  settled = state();
  showFrame([]);
  showResult();
  keep('now', settled);
}

function undo() {
  const before = past.pop();
  $('undo').disabled = past.length === 0;
  if (before) restore(before);
}

const hashOf = () => new URLSearchParams(Object.entries(answers()).filter(([, value]) => value)).toString();

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

// ---- how the file is read ----

function setReading(given) {
  for (const id of READING_QUESTIONS) {
    if (given[id] === undefined) continue;
    if (id === 'units' && given[id] && ![...$(id).options].some((option) => option.value === given[id])) $(id).add(new Option(given[id], given[id]));
    $(id).value = given[id];
  }
}

const UNITS = {mm: 'millimetres', cm: 'centimetres', m: 'metres', in: 'inches', ft: 'feet'};
const EXAMPLE = 'example.json'; // the path of one
const spanOf = (shown, k) => shown.nodes.reduce((most, p) => Math.max(most, p[k]), -Infinity) - shown.nodes.reduce((least, p) => Math.min(least, p[k]), Infinity);
const widthOf = (shown) => Math.max(spanOf(shown, 0), spanOf(shown, 1));

// The questions how wide it is and shall be, in numbers of this framework.
function askWidth() {
  if (!source) return;
  const chosen = $('units').value, wide = Number(source.width.toPrecision(4)), units = frame.units || 'mm';
  const options = Object.entries(UNITS).map(([unit, words]) => new Option(`${wide} ${words}`, unit));
  $('units').replaceChildren(new Option(`${source.path === EXAMPLE ? 'as it is' : 'as the file is read'}: ${wide} ${source.units}`, ''), ...options);
  setReading({units: chosen});
  $('wide').placeholder = `${wide}`;
  $('wide-unit').textContent = units;
  const [x, y, z] = [0, 1, 2].map((k) => Number(spanOf(frame, k).toPrecision(3)));
  $('wide-said').textContent = `${$('wide').value ? 'It is now' : 'It is'} ${x} x ${y} ${units}, and ${z} ${units} high, from middle to middle of the outer pieces.`;
}

const DENSITY = 1.24; // g/cm3 of PLA, as the program has it

const massWords = (grams) => (grams < 1000 ? `${Number(grams.toPrecision(2))} g` : `${Number((grams / 1000).toPrecision(2)).toLocaleString('en')} kg`);
const materialWords = (cm3) => `${volumeWords(cm3)}, ${massWords(DENSITY * cm3)} of plastic (PLA, solid)`;

// How far the ends of the largest piece are from each other, in mm: a piece reaches to the middles of its edges. NaN: of no unit.
function largestPiece() {
  const ends = frame.nodes.map(() => []);
  for (const [a, b] of frame.edges) for (const node of [a, b]) ends[node].push(frame.nodes[a].map((x, k) => (x + frame.nodes[b][k]) / 2));
  const across = ends.flatMap((all, node) => all.flatMap((p) => [...all, frame.nodes[node]].map((q) => Math.hypot(...p.map((x, k) => x - q[k])))));
  return across.reduce((most, far) => Math.max(most, far), 0) * 1000 * (METRES[frame.units || 'mm'] ?? NaN);
}

// What is to be printed at this width, where it is asked. kit: what the program estimates of a plan; null: not known.
function showNeeds(kit) {
  const words = kit || !source ? [] : ['What there is to print at this width appears here.'];
  if (kit?.volume_cm3) {
    const largest = largestPiece() + kit.width_mm, bed = Number(/\d+/.exec($('bed').value) || Infinity);
    words.push(`To print at this width: ${plural(kit.pieces, 'piece')}, the largest about ${sizeOf(largest)} long; ${materialWords(kit.volume_cm3)}.`);
    if (largest < 10) words.push('Too small to print: more width helps.');
    if (largest > bed && !kit.refused) words.push(`Too long for a printer's bed of ${bed} mm, unless they lie from corner to corner: less width helps.`);
  }
  if (kit?.refused) words.push(`They cannot be printed so: ${inWords(kit.refused)}.`);
  $('needs').textContent = words.join(' ');
}

const sizeOf = (mm) => (mm < 1000 ? `${Math.round(mm)} mm` : `${(mm / 1000).toFixed(1)} m`);

const kitOf = async (client, given) => {
  const {stdout} = await client.run(['info', 'plan.json', '--json'], {'plan.json': given});
  return stdout.startsWith('{') ? JSON.parse(stdout).kit : null;
};

// Options of the program that say how the file is to be read. width: of the framework as it is read by the other answers.
function readingArgs({width}, wide = answers().wide) {
  const {units, up, weld, split, flat, pick, layers} = answers(), args = [];
  const scale = Number(wide) > 0 && width > 0 ? Number(wide) / width : 1;
  if (units) args.push('--units', units);
  if (scale !== 1) args.push('--scale', String(scale));
  if (up) args.push('--up', up);
  if (weld) args.push('--weld', String(Number(weld) * width * scale));
  if (split) args.push('--split');
  if (flat) args.push('--flat', flat);
  if (pick.trim()) args.push('--pick', pick.trim());
  if (layers) args.push('--layers', layers);
  return args;
}

const convert = (given, args) => engine.run(['convert', given.path, ...args, '-T', 'json', '-o', 'frame.json'], {[given.path]: given.bytes});

let reading = Promise.resolve(); // until the file is read by the answers that are shown

// One reading after the other: an answer's change comes with the tap that leaves its field, and what is tapped waits for it.
const next = (change) => (reading = reading.then(() => released).then(() => new Promise((wake) => setTimeout(wake))).then(change));
const readAgain = () => next(readOnceMore);

// While a button of the mouse is down: until it is up. What moved meanwhile would not be clicked; a finger's tap is one event.
let released = Promise.resolve();
document.addEventListener('pointerdown', () => {
  released = new Promise((up) => ['pointerup', 'pointercancel'].forEach((kind) => document.addEventListener(kind, up, {once: true})));
}, true);

// The same file once more, by other answers; feet that were chosen stay where the pieces are the same.
async function readOnceMore() {
  if (!source) return;
  complain('');
  const before = frame, given = source, plain = await convert(given, readingArgs(given, '')), isBuilt = Number(answers().wide) > 0;
  if (plain.files['frame.json']) source = {...given, width: widthOf(JSON.parse(text(plain.files['frame.json'])))};
  const {exit, stderr, files} = isBuilt ? await convert(given, readingArgs(source)) : plain;
  if (exit !== 0 || !files['frame.json']) {
    source = given;
    complain(lastLine(stderr).replaceAll(given.path, given.shownName));
    setReading(settled?.answers || {});
    return;
  }
  putPlanAside();
  frame = JSON.parse(text(files['frame.json']));
  if (frame.nodes.length === before.nodes.length && before.feet) frame.feet = before.feet;
  remember();
  showFrame(notesOf(stderr, (words) => words.replaceAll(given.path, given.shownName)));
  showResult();
}

// What is there without a plan for it: the plan comes back by a button, or by Undo.
function putPlanAside() {
  $('dropped').hidden = !plan;
  plan = said = '';
  made = null;
}

async function readBytes(bytes, title, path, shownName, more = []) {
  complain('');
  busy(`Reading ${shownName} ..`);
  const isPlan = /^\s*\{\s*"format"\s*:\s*"thread-plan"/.test(text(bytes.subarray(0, 200)));
  const given = {bytes, path, shownName}, {exit, stderr, files} = await convert(given, []);
  busy('');
  if (exit !== 0 || !files['frame.json']) {
    complain(lastLine(stderr).replaceAll(path, shownName));
    return;
  }
  putPlanAside();
  frame = JSON.parse(text(files['frame.json']));
  name = title;
  source = isPlan ? null : {...given, width: widthOf(frame), units: frame.units || 'mm'};
  setReading(Object.fromEntries(READING_QUESTIONS.map((id) => [id, ''])));
  $('width').value = $('raised').value = ''; // arms and a piece of the shape before
  if (!frame.feet?.length && $('ends').value === 'feet') $('ends').value = '';
  if (isPlan) plan = text(bytes);
  remember();
  showFrame([...more.map((note) => [note, []]), ...notesOf(stderr, (words) => words.replaceAll(path, shownName))]);
  if (!isPlan) goTo('frame-title');
  await showResult();
}

async function example(words) {
  const [shape, size] = words.split(' ');
  const {files, exit, stderr} = await engine.run(['make', shape, '--size', size, '-o', 'frame.json']);
  if (exit) complain(lastLine(stderr));
  else await readBytes(files['frame.json'], `${shape}${size}`, EXAMPLE, shape);
}

// Also for those who hear the page: at once, or of what comes often now and then.
let heard = 0;
function hear(words, often = false) {
  if (often && Date.now() - heard < 5000) return;
  heard = Date.now();
  $('heard').textContent = words;
}

const plural = (n, word) => `${n} ${word}${n === 1 ? '' : 's'}`;

let noted = []; // of the file, as it was read last

// notes: [words, questions] ..; none given: those of before
function showFrame(notes = noted) {
  noted = notes;
  $('shown').hidden = $('question-part').hidden = !frame;
  document.querySelector('main').classList.toggle('open', Boolean(frame));
  if (!frame) return;
  const size = `${Number(widthOf(frame).toPrecision(3))} ${frame.units || 'mm'} wide`;
  const said = [`${name}: ${plural(frame.nodes.length, 'piece')} that meet at ${plural(frame.edges.length, 'interface')}, ${size}`];
  const doubts = notes.filter(([, questions]) => questions.length);
  said.push(...notes.filter((note) => !doubts.includes(note)).map(([words]) => capital(words)));
  $('counts').textContent = `${said.join('. ')}.`;
  $('doubts').replaceChildren(...doubts.map(([words, questions]) => {
    const item = document.createElement('li');
    item.append(...mendable(sentences([words]), questions.map((id) => [labelOf(id), () => openQuestion(id)])));
    return item;
  }));
  $('example').value = [...$('example').options].find(({value}) => source?.path === EXAMPLE && value.replace(' ', '') === name)?.value ?? '';
  $('take-example').disabled = !$('example').value;
  hear([$('counts').textContent, ...doubts.map(([words]) => sentences([words]))].join(' '));
  $('feet').value = (frame.feet || []).map(nameOf).join(', ');
  warn('feet-said', fallsOver() ? `A thing on ${frame.feet.length < 3 ? ['one foot', 'two feet'][frame.feet.length - 1] : 'feet in one line'} falls over, unless it is held: three or more, not all in a line, hold it.` : '');
  $('reading').hidden = $('size').hidden = !source;
  askWidth();
  sketch.show(frame);
  advise();
}

const nameOf = (node) => (frame.names ? String(frame.names[node]) : String(node));

// Are there feet, and all of them in a line as seen from above?
function fallsOver() {
  const [[x, y] = [], ...others] = (frame.feet || []).map((node) => frame.nodes[node]), by = others.map(([u, v]) => [u - x, v - y]);
  const [east, north] = by.reduce((best, at) => (Math.hypot(...at) > Math.hypot(...best) ? at : best), [0, 0]);
  return x !== undefined && by.every(([u, v]) => Math.abs(u * north - v * east) <= 0.01 * (east * east + north * north));
}

function toggled(node) {
  const feet = new Set(frame.feet || []);
  if (!feet.delete(node)) feet.add(node);
  return [...feet].sort((a, b) => a - b);
}

async function changeFeet(feet) {
  await reading;
  frame = {...frame, feet};
  putPlanAside();
  if (!feet.length && $('ends').value === 'feet') $('ends').value = '';
  remember();
  showFrame();
  showResult();
}

const cordArgs = () => (Number($('thick').value) > 0 ? ['--cord-diameter', $('thick').value] : []);

// A plan is for one cord: channels and turns follow from its thickness.
function changeCord() {
  putPlanAside();
  remember();
  showFrame();
  showResult();
}

// Names between commas, semicolons or blanks; a name that has blanks itself needs commas.
function typedFeet() {
  const numbered = new Map(frame.nodes.map((_, node) => [nameOf(node).toLowerCase(), node]));
  const words = $('feet').value.split(/[,;]/).map((word) => word.trim()).filter(Boolean);
  const wanted = words.flatMap((word) => (numbered.has(word.toLowerCase()) ? [word] : word.split(/\s+/)));
  const lost = wanted.filter((word) => !numbered.has(word.toLowerCase()));
  complain(lost.length ? `There is no piece ${lost.join(', ')}; the first is ${nameOf(0)}.` : '');
  if (!lost.length) changeFeet([...new Set(wanted.map((word) => numbered.get(word.toLowerCase())))].sort((a, b) => a - b));
}

// Feet by a word of the program's: 'lowest' or 'rim'.
async function feetWhere(word) {
  await reading;
  const {exit, stderr, files} = await engine.run(['convert', 'frame.json', '--feet', word, '-o', 'out.json'], {'frame.json': frameText()});
  if (exit) complain(lastLine(stderr));
  else changeFeet(JSON.parse(text(files['out.json'])).feet || []);
}

const frameText = () => JSON.stringify(frame);
const frameFile = () => `${name.replace(/[^\w.-]+/g, '-').replace(/^[-.]+/, '') || 'frame'}.json`; // named in pictures and commands

// ---- 2: the questions ----

let asked = 0;
let advised = []; // rows, in the order of the table
let recommended = null; // one of them
let advisedPlan = ''; // its plan, text of plan.json
let takeAdvised = () => {}; // is told when it is there

const ENDS = {feet: 'at the feet', any: 'anywhere', closed: 'in loops'};
const newtons = (force, digits = 2) => `${force < 100 ? Number(force.toPrecision(digits)) : Math.round(force)} N`;

// A length in the framework's units, in m where it is known how many there are.
const METRES = {mm: 0.001, cm: 0.01, m: 1, in: 0.0254, ft: 0.3048};
const lengthWords = (length) => {
  const metres = length * (METRES[frame.units || 'mm'] ?? NaN);
  if (metres < 0.1) return `${Number((1000 * metres).toPrecision(2))} mm`;
  return Number.isNaN(metres) ? `${length.toPrecision(3)} ${frame.units}` : `${metres.toFixed(metres < 10 ? 2 : 1)} m`;
};

const hand = () => ({'': '10', any: '10'})[$('pull').value] ?? $('pull').value;

// The rows as they are found, and the plan of the recommended one, which the page takes unless another answer is given.
async function advise() {
  const mine = ++asked, found = new Map(), times = new Map(); // rows by key, and how often each was told: first cheap, then searched for
  advised = [];
  recommended = null;
  advisedPlan = '';
  showNeeds(null);
  showAdvice('Looking how many cords a hand can pull ..');
  adviser.stop();
  const onLine = (line) => {
    if (mine !== asked || !line.startsWith('{')) return;
    const row = JSON.parse(line), isKnown = recommended && keyOf(row) === keyOf(recommended);
    if (row.what === 'recommended') recommended = row;
    else if (row.what !== 'row' || isKnown) return;
    found.set(keyOf(row), row);
    times.set(keyOf(row), (times.get(keyOf(row)) || 0) + 1);
    advised = [...found.values()];
    showAdvice(`Still looking, ${[...times.values()].filter((n) => n > 1).length} of ${found.size} rows are done ..`);
  };
  const onPlan = (found) => {
    if (mine !== asked || hand() !== '10') return;
    advisedPlan = found;
    takeAdvised();
  };
  const command = ['advise', frameFile(), '--hand', hand(), ...cordArgs(), '-T', 'plan', '-o', 'plan.json', '--json', '--progress'];
  const {exit, stdout, stderr} = await adviser.run(command, {[frameFile()]: frameText()}, {onLine, onPlan});
  if (mine !== asked || exit === -1) return;
  if (!stdout) return showAdvice(lastLine(stderr) || 'No advice for this framework.');
  const {rows, recommended: best, command: typed, mu_high: rough} = JSON.parse(stdout);
  advised = rows;
  recommended = rows[best] || null;
  showAdvice(recommended ? `Done. ${whyTaken(rough)}` : 'Done. No number of cords is easy enough for this hand.');
  $('advice-more').hidden = !typed;
  $('advice-command').textContent = typed || '';
  const needed = advisedPlan && (await kitOf(adviser, advisedPlan));
  if (mine === asked && needed) showNeeds(needed);
}

// Which row to take and why: what a hand manages, then fewer cords, then less cord. rough: friction of a rougher cord.
function whyTaken(rough) {
  const {cords, ends, pull, length, pull_high: high} = recommended, force = Number(hand());
  const [fewer] = advised.filter((row) => row.ends === ends && row.cords < cords).sort((a, b) => b.cords - a.cords);
  const cordWords = (than) => (Math.abs(length / than - 1) < 0.001 ? 'for as much cord' : `for ${Number((100 * Math.abs(length / than - 1)).toPrecision(2))} % ${length > than ? 'more' : 'less'} cord`);
  const words = [`Take ${plural(cords, 'cord')} ${ENDS[ends]}: ${newtons(pull)} a cord${fewer ? ` instead of ${newtons(fewer.pull)} with ${fewer.cords}, ${cordWords(fewer.length)}` : ''}.`];
  const isManaged = fewer?.pull_high <= force;
  if (isManaged) words.push(`A matter of taste: a hand manages ${plural(fewer.cords, 'cord')}, too.`);
  else if (high <= force) words.push(`A hand manages ${newtons(force)}. Should your cord be rougher (friction ${rough}), this takes ${newtons(high, 3)}${fewer ? `; ${plural(fewer.cords, 'cord')} would take ${newtons(fewer.pull_high, 3)}, too much` : ''}.`);
  const other = advised.find((row) => row.ends !== ends && row.ends !== 'closed' && row.pull_high <= force && row.cords <= cords && row.length < 0.99 * length);
  if (other && !isManaged) words.push(`A matter of taste: ${plural(other.cords, 'cord')} ${ENDS[other.ends]}, ${newtons(other.pull)} each, would have ${lengthWords(other.length)} in the pieces, not ${lengthWords(length)}.`);
  return words.join(' ');
}

const keyOf = ({cords, ends}) => `${cords} ${ends}`;
const ORDER = ['feet', 'any', 'closed'];

function showAdvice(words) {
  $('advice-said').textContent = words;
  $('advice-table').hidden = !advised.length;
  $('advice-more').hidden = true;
  const rows = [...advised].sort((a, b) => (b === recommended) - (a === recommended) || ORDER.indexOf(a.ends) - ORDER.indexOf(b.ends) || a.cords - b.cords);
  $('advice-table').tBodies[0].replaceChildren(...rows.map(adviceRow));
  showPromise();
}

function adviceRow(row) {
  const line = document.createElement('tr'), button = document.createElement('button');
  line.className = row === recommended ? 'best' : '';
  line.append(...cells([row.cords, ENDS[row.ends], newtons(row.pull), lengthWords(row.length), lengthWords(row.longest)], true));
  button.type = 'button';
  button.textContent = 'Take';
  button.setAttribute('aria-label', `Take ${plural(row.cords, 'cord')} ${ENDS[row.ends]}, ${newtons(row.pull)} to pull${row === recommended ? ', recommended' : ''}`);
  button.addEventListener('click', () => takeRow(row));
  line.insertCell().append(button);
  return line;
}

// Cells of a row of a table; the first is the row's head.
function cells(words, head) {
  return words.map((word, i) => {
    const cell = document.createElement(head && i === 0 ? 'th' : 'td');
    if (head && i === 0) cell.scope = 'row';
    cell.append(word);
    return cell;
  });
}

const PLAIN = {pull: '', cords: '', ends: '', aim: '', joint: 'solid', seconds: ''};

// What is recommended for the usual hand is what the plain answers make.
function takeRow(row) {
  setAnswers(row === recommended && hand() === '10' ? PLAIN : {cords: String(row.cords), ends: row.ends, aim: ''});
  remember();
  showPromise();
  $('go').focus();
}

function isPlain() {
  const given = answers();
  return ['pull', 'cords', 'ends', 'aim', 'joint'].every((id) => given[id] === PLAIN[id]);
}

function showPromise() {
  if (recommended) offerCords(String(recommended.cords));
  $('promise').textContent = isPlain() && recommended ? `Makes what is recommended: ${plural(recommended.cords, 'cord')} with ends ${ENDS[recommended.ends]}, ${newtons(recommended.pull)} to pull.` : '';
}

function caption(words) {
  const node = document.createElement('figcaption');
  node.textContent = words;
  return node;
}

// The command line that the answers stand for. Plain answers are no options: as few cords as a hand can pull.
function wanted() {
  const {pull, cords, ends, aim, joint, seconds} = answers(), args = ['plan', frameFile(), ...cordArgs()];
  if (!isPlain()) {
    args.push('--ends', ends || (frame.feet?.length ? 'feet' : 'any'), '--joint', joint);
    if (cords) args.push('--cords', cords);
    if (aim) args.push('--objective', aim);
    else if (cords && joint === 'solid' && ends !== 'closed') args.push('--objective', 'tortuosity', '--minimize', 'pull');
    if (pull !== 'any' && (pull || (!cords && joint === 'solid' && aim !== 'symmetry' && ends !== 'closed'))) args.push('--max-pull', pull || '10');
  }
  return [...args, ...(seconds ? ['--time-limit', seconds] : []), '--progress', '-o', 'plan.json'];
}

// ---- the search ----

let ticking = 0;

// stop: what the button says that ends the work; none without it. seconds: its limit, 0: none. Over the picture for what is seen there.
function busy(words, stop = '', title = 'At work', seconds = 0, inPicture = true) {
  working = Boolean(words);
  for (const node of [$('begin'), ...$('shown').children, ...document.querySelectorAll('main > section:not(#frame-part, #work-part)')])
    if (node.id !== 'stage') node.inert = working;
  const visible = inPicture && !$('shown').hidden, before = $('work-part').hidden;
  $('work-part').hidden = !words;
  $('work-part').classList.toggle('fixed', !visible);
  if ($('shown').hidden !== !$('work-part').closest('#shown')) (visible ? $('stage') : document.querySelector('main')).append($('work-part'));
  $('work-title').textContent = title;
  $('work').textContent = words;
  if (words) hear(words);
  $('bar').removeAttribute('value');
  $('clock').textContent = '';
  $('stop').hidden = !stop;
  $('stop').textContent = stop;
  $('go').disabled = working;
  clearInterval(ticking);
  if (!working) return;
  if (before && stop) $('stop').focus({preventScroll: true});
  if (visible && stop) $('stage').scrollIntoView({block: 'nearest'});
  const begun = performance.now();
  ticking = setInterval(() => {
    const passed = (performance.now() - begun) / 1000;
    $('clock').textContent = seconds ? `${Math.floor(passed)} of ${seconds} s` : `${Math.floor(passed)} s`;
    if (seconds) $('bar').value = Math.min(1, passed / seconds);
  }, 250);
}

const degrees = (rad) => `${((rad * 180) / Math.PI).toFixed(0)} degrees`;

// What a line of progress says, in words: of the plan, or of what is proved.
function progressWords(line) {
  if (!line.startsWith('{')) return {};
  const {what, best: value, bound, gap, length, cords, done} = JSON.parse(line);
  if (what === 'plan') return {plan: `Found: ${plural(cords, 'cord')}, ${lengthWords(length)} in the pieces.`};
  if (done !== undefined) return {done, what};
  if (!(bound > 0)) return {};
  const better = gap >= 0.005 ? `Nothing can be more than ${gap.toPrecision(2)} % better` : 'Nothing is better';
  if (what !== 'turning') return {proved: `${better}.`};
  return {proved: `It turns by ${degrees(value)}, and none can by less than ${degrees(bound)}: ${better.toLowerCase()}.`};
}

// What the command makes; for plain answers advice makes the same plan, byte for byte: whichever is there first.
async function searchOrAdvice(command, hears) {
  const files = {[frameFile()]: frameText()}, isAsked = isPlain() && !answers().seconds;
  const fromAdvice = () => ({exit: 0, stderr: '', files: {'plan.json': new TextEncoder().encode(advisedPlan)}});
  if (isAsked && advisedPlan) return fromAdvice();
  const search = engine.run(command, files, hears);
  if (!isAsked) return search;
  const advice = new Promise((resolve) => {
    takeAdvised = () => resolve(fromAdvice());
  });
  const first = await Promise.race([search, advice]);
  takeAdvised = () => {};
  if (first !== (await Promise.race([search, null]))) engine.stop(); // it is not wanted any more
  return first;
}

async function search(event) {
  event?.preventDefault();
  await reading;
  complain('');
  const seconds = Number(answers().seconds), command = wanted();
  busy('Searching ..', 'Stop and keep the best', 'Searching', seconds);
  best = '';
  const told = {};
  let heardPlan;
  const onLine = (line) => {
    Object.assign(told, progressWords(line));
    $('work').textContent = ['Searching ..', told.plan, told.proved].filter(Boolean).join(' ');
    hear($('work').textContent, told.plan === heardPlan);
    heardPlan = told.plan;
    if (told.done > 0 && !seconds) $('bar').value = told.done;
  };
  const onPlan = (found) => {
    best = found;
    sketch.showCords(cordsOf(found));
    keep('search', {...state(), plan: best, said: ''}); // closing the page loses nothing that was found
  };
  const {exit, stderr, files} = await searchOrAdvice(command, {onLine, onPlan});
  busy('');
  keep('search', null);
  const found = files['plan.json'] ? text(files['plan.json']) : best;
  if (!found) {
    complain(exit === -1 ? 'Stopped before anything was found.' : lastLine(stderr));
    sketch.showCords(plan ? cordsOf(plan) : []);
    return;
  }
  plan = found;
  said = '';
  made = {command: ['thread', ...command.filter((word) => word !== '--progress')].join(' ')};
  $('dropped').hidden = true;
  remember();
  await showResult();
  if (exit === -1) $('verdict').textContent += ` The search was stopped. ${told.proved || 'Nothing was proved by then'}`.replace(/\.?$/, '.');
  else if (exit !== 0) $('verdict').textContent += ` Of the search: ${lastLine(stderr)}.`;
  hear(`${$('headline').textContent} ${$('verdict').textContent}`);
}

// ---- 3: the result ----

// The booklet shows how the pieces rise once that was seen.
async function draw(type, file, tell = complain) {
  const risen = type === 'sheets.html' && $('paper').value === risenOn && rise[RISEN];
  if (risen) return risen;
  const {exit, stderr, files} = await engine.run(['draw', 'plan.json', '-T', type, '--page', $('paper').value, '-o', file], {'plan.json': plan});
  if (exit || !files[file]) tell(lastLine(stderr));
  return files[file];
}

const cordsOf = (words) => JSON.parse(words).cords.map(({nodes}) => nodes);

// A table as it is written: of each row {name of the column: word}.
function rowsOf(csv) {
  const [head, ...rows] = csv.trim().split('\n').map((line) => [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)].map(([, quoted, plain]) => (quoted !== undefined ? quoted.replaceAll('""', '"') : plain)));
  return rows.map((row) => Object.fromEntries(head.map((column, i) => [column, row[i]])));
}

const range = (values, words) => {
  const [least, most] = [Math.min(...values), Math.max(...values)].map(words);
  return least === most ? most : `${least} to ${most}`;
};

const volumeWords = (cm3) => (cm3 < 1e3 ? `${Number(cm3.toPrecision(2))} cm³` : cm3 < 1e6 ? `${Number((cm3 / 1e3).toPrecision(2))} litres` : `${Number((cm3 / 1e6).toPrecision(2)).toLocaleString('en')} m³`);

let seats = NaN; // N, the pull that seats the cords; NaN: not known

// What a hand must do, the last of what is needed. seen: the film's run, once there is one.
function handWords(seen) {
  const seating = seats > 0 ? `a hand that pulls ${newtons(seats)} at each end to seat the cords` : 'a hand that pulls';
  if (!seen) return `${seating}; what raises the pieces, the film in part 4 shows`;
  if (!seen.came_up) return `${seating}; in the film this did not raise the pieces`;
  return seen.pull_up > seats ? `a hand that pulls ${newtons(seen.pull_up)} at each end: so much raised the pieces in the film, ${newtons(seats)} seat the cords` : `${seating}; ${newtons(seen.pull_up)} raised the pieces in the film`;
}

// The headline, the cords, what is needed and what to do.
function showCords(rows, {cords: pulls, physics}, kit, first) {
  const lengths = rows.map((row) => Number(row.length)), cuts = rows.map((row) => Number(row.cut)), known = pulls.filter((pull) => pull?.known);
  const most = Math.max(...known.map((pull) => pull.force));
  $('headline').textContent = `${plural(rows.length, 'cord')}, ${rows.length > 1 ? 'each ' : ''}${range(lengths, lengthWords)} threaded, cut ${range(cuts, lengthWords)}${known.length ? `; pull ${newtons(most)} at both ends` : ''}`;
  $('cord-table').tBodies[0].replaceChildren(...rows.map((row, i) => {
    const line = document.createElement('tr'), swatch = document.createElement('span'), pull = pulls[i];
    swatch.className = 'swatch';
    swatch.style.background = CORD_COLOURS[i % CORD_COLOURS.length];
    const ends = pull?.known ? [pull.tension[0], pull.tension.at(-1)] : []; // N, as the columns From and To
    const force = ends.length && pull.force - pull.other_force < 0.05 * pull.force ? newtons(pull.force) : ends.map((end) => newtons(end, 3)).join(' and ');
    line.append(...cells([row.cord, lengthWords(Number(row.cut)), lengthWords(Number(row.length)), row.start, row.end, force], true));
    line.cells[0].prepend(swatch);
    return line;
  }));
  const film = document.createElement('button');
  film.type = 'button';
  film.textContent = 'Go to the film';
  film.addEventListener('click', () => goTo('rise-title'));
  seats = known.length ? most : NaN;
  const thick = physics ? `, ${Number((physics.cord_diameter).toPrecision(2))} mm thick` : '', total = lengthWords(cuts.reduce((sum, cut) => sum + cut, 0));
  const needs = [`${total} of cord${thick}: ${plural(rows.length, 'cord')} of ${range(cuts, lengthWords)}, ends to hold and knots in it`,
    kit ? `${plural(kit.pieces, 'piece')} from a 3D printer, the largest about ${sizeOf(largestPiece() + (kit.width_mm || 0))} long${kit.volume_cm3 ? `: ${materialWords(kit.volume_cm3)}` : ''}` : 'the pieces',
    handWords()];
  const steps = ['Watch it rise in part 4 before anything is printed. The pull above seats the cords; the film shows whether they raise the pieces. ',
    `Print ${kit ? plural(kit.pieces, 'piece') : 'the pieces'}: part 5 below makes the files.${kit?.refused ? ' But so large they fit on no usual printer: ask for less width in part 1, or for a larger bed in part 5.' : ''}`, 'Print the booklet, or open the steps below on a telephone.', 'Cut the cords.',
    first ? `Begin: ${first}.` : ''].filter(Boolean);
  for (const [list, lines] of [['needed', needs], ['to-do', steps]]) $(list).replaceChildren(...lines.map((words) => {
    const item = document.createElement('li');
    item.textContent = words;
    return item;
  }));
  $('to-do').firstChild.append(film);
}

// "cord A: start, pick up L-1 (G7): out to G6", out of the steps in words.
function firstStep(words) {
  const cord = /^Cord (\S+?),/m.exec(words), row = /^\[ \] +S +(.*)$/m.exec(words);
  return cord && row ? `cord ${cord[1]}, ${row[1]}` : '';
}

const LARGE = 30; // pages of a booklet: its first part is offered alone
const FEW_PASSES = 400; // whose booklet is drawn at once

async function showResult() {
  $('result-part').hidden = $('kit-part').hidden = $('rise-part').hidden = !plan;
  $('viewer').srcdoc = '';
  $('files').replaceChildren();
  $('first-step').replaceChildren(caption('The first step appears here.'));
  $('booklet-said').textContent = '';
  showKit({});
  showRise({});
  sketch.showCords(plan ? cordsOf(plan) : []);
  if (!plan) return;
  const shown = plan, given = {'plan.json': plan}, check = await engine.run(['check', 'plan.json'], given);
  if (shown !== plan) return;
  $('verdict').textContent = check.exit === 0 ? 'Every claim of this plan was verified on this device. Whether the pull raises the pieces, the film in part 4 shows.' : lastLine(check.stderr);
  $('summary').textContent = said || check.stdout.replace(/^plan\.json: /, '').trim() || lastLine(check.stderr);
  $('command').textContent = made?.command || '';
  const {stdout: cords} = await engine.run(['draw', 'plan.json', '-T', 'cords.csv', '-o', '-'], given);
  const evaluated = await engine.run(['eval', 'plan.json', '--json'], given);
  const estimated = await kitOf(engine, plan);
  const {stdout: steps} = await engine.run(['draw', 'plan.json', '-T', 'steps', '-o', '-'], given);
  if (shown !== plan) return;
  const evaluation = evaluated.stdout.startsWith('{') ? JSON.parse(evaluated.stdout).evaluation : {cords: []};
  planArms = estimated?.width_mm;
  showNeeds(estimated);
  showArms();
  showCords(rowsOf(cords), evaluation, estimated, firstStep(steps));
  goTo('result-title');
  const viewer = await draw('html', 'viewer.html');
  if (viewer && shown === plan) $('viewer').srcdoc = text(viewer);
  watchWalls();
  listFiles($('files'), FILES.map(([type, file, what]) => [file, () => contentOf(type, file), what]));
  if (cordsOf(plan).flat().length <= FEW_PASSES) showFirstPages(await draw('sheets.html', 'sheets.html'), shown);
}

// The booklet as [what stands before its pages, its pages].
function pagesOf(bytes) {
  const [head, ...pages] = text(bytes).split(/(?=<section class="page")/);
  return [head, pages];
}

// Its first page, and the first with a step, as pictures.
function showFirstPages(bytes, shown) {
  if (!bytes || shown !== plan) return;
  const [, pages] = pagesOf(bytes), at = 1 + pages.findIndex((page) => /: pass(?:es)? 1\b/.test(page));
  $('booklet-said').textContent = `The booklet has ${plural(pages.length, 'page')}.`;
  $('first-step').replaceChildren(...[[1, 'The first page of the booklet'], [at, 'The first step']].filter(([page]) => pages[page - 1]).map(([page, words]) => {
    const image = new Image(), svg = /<svg[^]*<\/svg>/.exec(pages[page - 1])[0];
    image.alt = `${words}, page ${page}`;
    image.src = URL.createObjectURL(new Blob([svg], {type: 'image/svg+xml'}));
    return image;
  }), caption(`The first page of the booklet${at ? `, and the first step, on page ${at}` : ''}.`));
}

// Its type, its name, what it is for.
const FILES = [['plan', 'plan.json', 'the plan; choose it as your file in part 1 to go on with it'], ['sheets.html', 'booklet.html', 'the booklet to print: every step with its picture, and how they rise, once that was seen'],
  ['mat.html', 'mat.html', 'the mat to print: outlines of all pieces, true to size, to lay them on'], ['svg', 'overview.svg', 'a picture of all cords'],
  ['steps', 'steps.txt', 'the steps in words'], ['html', 'viewer.html', 'the steps in space'], ['cords.csv', 'cords.csv', 'what to cut'],
  ['beads.csv', 'beads.csv', 'which pieces'], ['steps.csv', 'steps.csv', 'the steps as a table'], ['channels.csv', 'channels.csv', 'the ways through pieces'],
  ['obj', 'cords.obj', 'the cords for CAD'], ['gltf', 'cords.gltf', 'the cords in colours'], ['dxf', 'cords.dxf', 'the cords for CAD, a layer each']];
const KIT_FILES = {'kit.3mf': "all pieces on plates: open it in your printer's program", 'README.txt': 'how many of what to print, and how', 'kit.csv': 'what each piece measures', 'kit.png': 'a picture of the pieces, cords in them',
  'kit.html': 'the steps in space, with these pieces', 'stl.zip': 'each kind of piece as an STL file'};
const RISEN = 'risen.html'; // the booklet with how the pieces rise, as the program writes it beside a film
const RISE_FILES = {'rise.html': 'how they rise, to play', 'rise.png': 'the same as a moving picture', 'rise.svg': 'pull and closed faces as a chart', 'rise.json': 'the same in numbers'};
const purpose = (file) => FILES.find(([, name]) => name === file)?.[2] || KIT_FILES[file.replace('kit/', '').replace(/-\d+(?=\.3mf$)/, '')] || RISE_FILES[file] || 'a kind of piece';

// A line on each of some files, and on those that could not be made.
const readme = (files, failed) => [`${name}: what thread made of it`, '', ...[...Object.keys(files).map((file) => [file, purpose(file)]), ...failed]
  .map(([file, words]) => `${file.padEnd(24)} ${words}`), ''].join('\n');

const contentOf = async (type, file, tell) => (type === 'plan' ? new TextEncoder().encode(plan) : draw(type, file, tell));

function save(blob, title) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = title;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// named: [[name, what gives its bytes, what it is for] ..]
function listFiles(list, named) {
  list.replaceChildren(...named.map(([file, content, what]) => {
    const item = document.createElement('li'), link = document.createElement('a');
    link.href = '#';
    link.textContent = file;
    link.addEventListener('click', async (event) => {
      event.preventDefault();
      const bytes = await content();
      if (bytes) save(new Blob([bytes]), file);
    });
    item.append(link);
    if (what) {
      const words = document.createElement('span');
      words.textContent = what;
      item.append(words);
    }
    return item;
  }));
}

const sizeWords = (bytes) => (bytes < 1e6 ? `${Math.ceil(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`);
const NEEDED = /^(plan\.json|booklet\.html|cords\.csv|steps\.txt|kit\/(?:README\.txt|kit\.csv|.*\.3mf))$/; // by who makes it

// Draws all that there is, then offers it with its size: all, or what is needed to make it.
async function offerZip() {
  const files = {}, failed = [], shown = plan;
  busy('Drawing everything ..', '', 'Drawing', 0, false);
  for (const [type, file] of FILES) {
    const bytes = await contentOf(type, file, (why) => failed.push([file, `not made: ${why}`]));
    if (bytes) files[file] = bytes;
  }
  Object.assign(files, kit, rise);
  delete files[RISEN]; // is the booklet
  const needed = Object.fromEntries(Object.entries(files).filter(([file]) => NEEDED.test(file)));
  const choices = await Promise.all([['Save all', files, failed], ['Save booklet, cords and pieces alone', needed, []]].map(async ([title, some, lost]) => {
    const packed = await zip({'README.txt': new TextEncoder().encode(readme(some, lost)), ...some});
    return [`${title}: ${sizeWords(packed.size)}`, () => save(packed, `${name || 'plan'}.zip`)];
  }));
  busy('');
  if (shown !== plan) return;
  warn('zip-said', `Packed: ${plural(Object.keys(files).length, 'file')}; pieces and film are among them once they are made. What shall be saved?`, choices);
  $('zip-said').querySelector('button').focus();
}

// A large one is made while its number of pages is shown, and its first part can be had alone.
async function openBooklet() {
  const page = window.open('', '_blank'), given = {'plan.json': plan};
  busy('Drawing the booklet ..', 'Stop', 'Drawing the booklet', 0, false);
  const onLine = (line) => {
    const pages = /: (\d+ pages)/.exec(line)?.[1];
    if (pages) $('work').textContent = `Drawing the booklet: ${pages} ..`;
  };
  const risen = $('paper').value === risenOn && rise[RISEN]; // the same, and how it comes up
  const {exit, stderr, files} = risen ? {exit: 0, stderr: '', files: {'sheets.html': risen}}
    : await engine.run(['draw', 'plan.json', '-T', 'sheets.html', '--page', $('paper').value, '-o', 'sheets.html'], given, {onLine});
  busy('');
  const bytes = files['sheets.html'];
  if (exit !== 0 || !bytes) {
    complain(exit === -1 ? 'Stopped: no booklet was drawn.' : lastLine(stderr));
    return page?.close();
  }
  const [head, pages] = pagesOf(bytes), show = (shown) => {
    const blob = new Blob([head, ...shown, '</body></html>'], {type: 'text/html'});
    if (page && !page.closed) page.location = URL.createObjectURL(blob);
    else save(blob, 'booklet.html');
  };
  if (pages.length <= LARGE) return show(pages);
  const first = firstPart(pages), words = $('booklet-said');
  const choices = [[`Open the first ${first} pages`, first], [`Open all ${pages.length} pages`, pages.length]].map(([title, n]) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = title;
    button.addEventListener('click', () => {
      const opened = window.open(URL.createObjectURL(new Blob([head, ...pages.slice(0, n), '</body></html>'], {type: 'text/html'})), '_blank');
      if (!opened) save(new Blob([head, ...pages.slice(0, n), '</body></html>'], {type: 'text/html'}), 'booklet.html');
    });
    return button;
  });
  page?.close();
  words.replaceChildren(`The booklet has ${pages.length} pages. `, ...choices);
  choices[0].focus();
}

async function openMat() {
  complain('');
  const page = window.open('', '_blank'), bytes = await draw('mat.html', 'mat.html');
  if (!bytes) return page?.close();
  const blob = new Blob([bytes], {type: 'text/html'});
  if (page) page.location = URL.createObjectURL(blob);
  else save(blob, 'mat.html');
}

// How many pages come before the second section; without sections LARGE of them.
function firstPart(pages) {
  const second = pages.findIndex((page) => />Section 2\b/.test(page));
  return second > 0 ? second : LARGE;
}

// What went wrong or will, and buttons that mend it: [words, what to do] ..
function mendable(words, mends) {
  const line = document.createElement('span');
  line.textContent = words;
  return [line, ...mends.map(([title, mend]) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = title;
    button.addEventListener('click', mend);
    return button;
  })];
}

function warn(id, words, mends = []) {
  $(id).hidden = !words;
  $(id).replaceChildren(...mendable(words, mends));
}

// ---- 4: how they rise ----

// What the command line writes of a rise: {'rise.html': bytes ..}, and what it says.
function showRise(files, lines = []) {
  rise = files;
  warn('zip-said', '');
  $('rise-said').textContent = sentences(lines);
  warn('rise-help', '');
  showArms();
  listFiles($('rise-files'), Object.keys(RISE_FILES).filter((file) => files[file]).map((file) => [file, () => files[file], purpose(file)]));
  if (!files['rise.html']) {
    $('rise-picture').replaceChildren(caption('Here comes a film: the pieces lie loose, their cords are pulled, and they come up or stay down. Play it, stop it, turn it. With ten pieces it takes seconds, with fifty it takes minutes.'));
    return;
  }
  const player = document.createElement('iframe');
  player.title = 'The pieces as they rise';
  player.srcdoc = text(files['rise.html']);
  $('rise-picture').replaceChildren(player);
}

let planArms; // mm, of the pieces unless another width is asked for
let printedArms = 0; // mm, which walls take to be printed well; 0: those there are do, or it is not known
let risenArms; // those of the film that is shown
const armsNow = () => Number($('width').value) || planArms;
const armsWords = (mm) => (mm ? `${Number(mm.toPrecision(3))} mm wide` : 'as the plan has them');

// With which arms it rises, where that is asked; where the film shows others than the pieces have, the way to the same.
function showArms() {
  $('width').placeholder = planArms ? `${Number(planArms.toPrecision(3))}, as the plan has it` : 'as the plan has it';
  $('rise-arms').textContent = `Arms ${armsWords(armsNow())}, as for the pieces in part 5.`;
  const differs = rise['rise.html'] && risenArms !== armsNow();
  if (printedArms) return warn('rise-other', `Arms ${armsWords(armsNow())} are too thin to print well.`, [[`Let arms ${armsWords(printedArms)} rise`, () => answerRise('width', printedArms)]]);
  warn('rise-other', differs ? `The film shows arms ${armsWords(risenArms)}, those of the pieces in part 5 are ${armsWords(armsNow())}.` : '',
    differs ? [[`Watch it with arms ${armsWords(armsNow())}`, () => $('rise-questions').requestSubmit()]] : []);
}

// The pieces are as wide as those to print.
async function makeRise(event) {
  event.preventDefault();
  await reading;
  if (!plan) return; // another width put it aside, and says so
  complain('');
  busy('Pulling the cords ..', 'Stop', 'Pulling the cords', 0, false);
  const {start, most, raised, width} = answers(), args = ['rise', 'plan.json', '--start', start];
  if (most) args.push('--pull', most);
  if (raised.trim()) args.push('--raise', raised.trim());
  if (width) args.push('--width', width);
  const outputs = ['--play', 'rise.html', '--film', 'rise.png', '--plot', 'rise.svg', '--booklet', RISEN, '--page', $('paper').value, '-o', 'rise.json'];
  const {exit, stdout, stderr, files} = await engine.run([...args, ...outputs, '--progress'], {'plan.json': plan}, {onLine: showDone()});
  busy('');
  if (exit !== 0) {
    showRise({});
    complain(exit === -1 ? 'Stopped: nothing was seen.' : lastLine(stderr));
    return;
  }
  risenOn = $('paper').value;
  risenArms = Number(width) || planArms;
  const lines = stdout.trim().split('\n');
  const {runs: [seen]} = JSON.parse(text(files['rise.json'])), pulled = seen.moments.at(-1)[1];
  const after = seen.came_up && pulled > 1.05 * seen.pull_up ? [`the film goes on to ${newtons(pulled, 3)}: the pull grows until all faces have stayed closed for a while`] : [];
  showRise(files, [`with arms ${armsWords(risenArms)}`, ...lines.filter((line) => !/^(try|or) /.test(line)).map(riseWords), ...after]);
  $('needed').lastElementChild.textContent = handWords(seen);
  if (!seen.came_up) warn('rise-help', 'It does not come up like this. What may help, the likeliest first:', helpsRise(lines));
  hear(`${$('rise-said').textContent} ${$('rise-help').textContent}`);
  goTo('rise-title');
}

// A line of the program on a rise without the words of its methods.
const riseWords = (line) => inWords(line.replace(/ \((closed form|limit analysis)\)/g, '').replace(', one a pass, highest node at', ', the highest piece at').replace('in every pass once', 'all along the cords once'));

// What changes the rise, by the option that the program names, and how a button calls it.
const HELPS = {
  width: [(mm) => `Make the arms ${mm} mm wide`, (mm) => answerRise('width', mm)],
  raise: [(piece) => `Lift ${piece}, the highest piece, by hand`, (piece) => answerRise('raised', piece)],
  cords: [(n) => `Try with ${n} cords`, (n) => threadAgain(n)],
  pull: [(force) => `Pull with up to ${force} newtons`, (force) => answerRise('most', force)],
  start: [(start) => (start === 'heap' ? 'Drop them in a heap' : 'See whether it stands, once it is closed'), (start) => answerRise('start', start)],
};

// What the program says to try, "try words (--width 9)", then what the page knows; not what is so already.
function helpsRise(lines) {
  const {raised, start, most, width} = answers(), is = {raise: raised.trim(), start, pull: most, width};
  const top = frame.nodes.reduce((best, [, , z], node) => (z > frame.nodes[best][2] ? node : best), 0);
  const said = lines.map((line) => TRY.exec(line)).filter((found) => found && !(found[1] === 'pull' && found[2] > TWO_HANDS)).map(([, option, value]) => [option, value]);
  const own = [['cords', String(2 * cordsOf(plan).length)], ['raise', nameOf(top)], ['pull', String(TWO_HANDS)], ['start', 'shape']];
  const helps = new Map([...own, ...said].filter(([option, value]) => HELPS[option] && is[option] !== value));
  return [...new Set([...said, ...own].map(([option]) => option))].filter((option) => helps.has(option))
    .map((option) => [HELPS[option][0](helps.get(option)), () => HELPS[option][1](helps.get(option))]);
}

const TWO_HANDS = 100; // N
const TRY = /^(?:try|or) .*\((?:thread [a-z]+ )?--([a-z]+) ([^ )]+)\)$/;

function answerRise(id, value) {
  if (id === 'width') setArms(value);
  else $(id).value = value;
  remember();
  $('rise-questions').requestSubmit();
}

async function threadAgain(cords) {
  setAnswers({cords});
  await search();
  if (cordsOf(plan).length === Number(cords)) $('rise-questions').requestSubmit();
}

// ---- 5: the pieces ----

const PRINTS = 0.8; // mm, a wall of two lines of the usual nozzle
const FEW_PIECES = 120; // whose walls are measured before they are asked for
let measured = 0;

// The thinnest wall by arms of such a width in mm, '': the plan's.
async function wallsOf(given, width) {
  const {exit, stdout, stderr} = await adviser.run(['kit', 'plan.json', '--names', 'none', '--no-picture', '--json', ...(width ? ['--width', String(width)] : [])], {'plan.json': given});
  return exit === 0 ? JSON.parse(stdout) : {refused: exit > 0 ? lastLine(stderr) : ''};
}

const thinWords = ({refused, thinnest_mm: wall}) => refused ? `These pieces cannot be made. ${capital(refused)}.` : `The thinnest wall is ${Number(wall.toPrecision(2))} mm, too thin to print well, which takes ${PRINTS} mm.`;

// Measures the walls, and tries what makes them thick enough to be printed: wider arms, or where these have no room a larger whole.
async function watchWalls(most = FEW_PIECES) {
  const mine = ++measured, given = plan, {width: asked} = answers();
  printedArms = 0;
  showArms();
  warn('thin', '');
  if (!given || frame.nodes.length > most) return;
  const first = await wallsOf(given, asked);
  if (mine !== measured || !(first.refused || first.thinnest_mm < PRINTS)) return;
  const words = thinWords(first);
  warn('thin', words);
  hear(words);
  for (let wide = 1.1 * first.width_mm; wide < 2.1 * first.width_mm; wide *= 1.15) {
    const arms = Number(wide.toPrecision(2)), tried = await wallsOf(given, arms);
    if (mine !== measured) return;
    if (tried.thinnest_mm < PRINTS) continue;
    printedArms = arms;
    showArms();
    return warn('thin', words, [[`Make the arms ${arms} mm wide`, () => makeArms(arms)]]);
  }
  const size = widthOf(frame), larger = Number((size * (first.refused ? 4 : (1.05 * PRINTS) / first.thinnest_mm)).toPrecision(2)), units = frame.units || 'mm';
  if (source && !(first.refused && asked)) warn('thin', first.refused ? words : `${words} Wider arms have no room: the whole is too small.`, [[`Build the whole ${larger} ${units} wide, not ${Number(size.toPrecision(3))} ${units}`, () => setWhole(larger)]]);
}

// Pieces of other arms than are asked for are shown and saved no longer.
function setArms(width) {
  $('width').value = String(width);
  remember();
  showKit({});
  showArms();
  watchWalls();
}

function makeArms(width) {
  setArms(width);
  $('kit-questions').requestSubmit();
}

function setWhole(width) {
  $('wide').value = String(width);
  $('width').value = '';
  readAgain();
  goTo('question-title');
}

const capital = (words) => words[0].toUpperCase() + words.slice(1);
const sentences = (lines) => lines.map((line) => `${capital(line)}.`).join(' ');

// Hears of a part of the work that is done: the bar, and words, those of the program if none are given, with a percentage.
const showDone = (words) => (line) => {
  const {done, what} = progressWords(line);
  if (!(done > 0)) return;
  $('bar').value = done;
  const goesOn = /^(\d+) of \1 faces closed$/.test(what) ? ', now pulled to see whether they stay closed' : '';
  $('work').textContent = `${words ?? capital(what) + goesOn} .. ${Math.floor(100 * done)} %`;
  hear($('work').textContent, true);
};

// What the command line writes of a kit: {'kit/kit.3mf': bytes ..}, and what it says.
function showKit(files, lines = []) {
  const figure = $('kit-picture'), picture = files['kit/kit.png'], parts = Object.entries(files).filter(([file]) => /\.stl$/.test(file));
  kit = files;
  warn('zip-said', ''); // of other files
  $('kit-said').textContent = sentences(lines);
  figure.replaceChildren(caption('Here comes a picture of the pieces with the cords in them, and below it the files for your printer. With ten pieces it takes seconds, with fifty it takes a minute or two.'));
  listFiles($('kit-files'), [...Object.keys(files).filter((file) => !/\.stl$/.test(file)).map((file) => [file.replace('kit/', ''), () => files[file], purpose(file)]),
    ...(parts.length ? [['stl.zip', () => zip(Object.fromEntries(parts.map(([file, bytes]) => [file.replace('kit/', ''), bytes]))), purpose('stl.zip')]] : [])]);
  if (!picture) return;
  const image = new Image();
  image.alt = 'The pieces in their places, translucent, with the cords in them';
  image.src = URL.createObjectURL(new Blob([picture], {type: 'image/png'}));
  figure.replaceChildren(image);
}

async function makeKit(event) {
  event.preventDefault();
  await reading;
  if (!plan) return;
  complain('');
  showKit({});
  busy('Making the pieces ..', 'Stop', 'Making the pieces', 0, false);
  const {width, bed, names, key} = answers(), args = ['kit', 'plan.json', '--bed', bed.replaceAll(' ', '').replace('×', 'x'), '--names', names, '--key', key];
  if (width) args.push('--width', width);
  const {exit, stdout, stderr, files} = await engine.run([...args, '--stl', '--progress', '--json', '-o', 'kit'], {'plan.json': plan}, {onLine: showDone('Making the pieces')});
  busy('');
  if (exit !== 0) {
    complain(exit === -1 ? 'Stopped: no pieces were made.' : lastLine(stderr));
    return;
  }
  const lines = stderr.trim().split('\n').filter((line) => /^thread: (?!written to )/.test(line));
  showKit(files, lines.map((line) => inWords(line.replace(/^thread: /, ''))));
  $('viewer').srcdoc = text(files['kit/kit.html']); // the same steps, with these pieces
  const report = JSON.parse(stdout);
  if (report.thinnest_mm < PRINTS && $('thin').hidden) warn('thin', thinWords(report), [['Find arms that are wide enough', () => watchWalls(Infinity)]]);
  hear($('kit-said').textContent);
  goTo('kit-title');
}

// ---- events ----

function listenForFiles() {
  const drop = $('drop');
  $('file').addEventListener('change', () => $('file').files[0] && openFile($('file').files[0]).then(() => ($('file').value = '')));
  for (const kind of ['dragover', 'drop', 'dragleave'])
    document.addEventListener(kind, (event) => {
      event.preventDefault();
      drop.classList.toggle('over', kind === 'dragover');
      if (kind === 'drop' && event.dataTransfer.files[0] && !working) openFile(event.dataTransfer.files[0]);
    });
  $('example').addEventListener('change', () => ($('take-example').disabled = false));
  $('examples').addEventListener('submit', (event) => {
    event.preventDefault();
    example($('example').value);
  });
}

// Advice on a small dome while the first screen is read: a browser compiles what runs often once more, better, and the first advice
// that is asked for takes half as long. Whatever is asked for ends it.
async function warmUp() {
  const {files} = await adviser.run(['make', 'dome', '--size', '4', '-o', 'frame.json']);
  if (!frame) await adviser.run(['advise', 'frame.json', '--json'], files);
}

async function begin() {
  listenForFiles();
  $('questions').addEventListener('submit', search);
  $('questions').addEventListener('change', (event) => {
    remember();
    showPromise();
    if (event.target.id === 'pull') advise();
  });
  $('reading-questions').addEventListener('change', readAgain);
  $('wide').addEventListener('change', readAgain);
  $('thick').addEventListener('change', () => next(changeCord));
  $('reading-questions').addEventListener('submit', (event) => event.preventDefault());
  $('picking').addEventListener('change', () => (sketch.picksByTap = $('picking').checked));
  $('back').addEventListener('click', () => {
    do undo();
    while (!plan && past.length);
  });
  for (const [form, make] of [['kit-questions', makeKit], ['rise-questions', makeRise]]) {
    $(form).addEventListener('submit', make);
    $(form).addEventListener('change', remember);
  }
  $('kit-questions').addEventListener('input', () => showKit({})); // not at its end, when a finger is on the button, which would move
  $('width').addEventListener('change', () => {
    showArms();
    watchWalls();
  });
  $('stop').addEventListener('click', () => engine.stop());
  $('undo').addEventListener('click', undo);
  $('link').addEventListener('click', copyLink);
  $('feet').addEventListener('change', typedFeet);
  $('lowest').addEventListener('click', () => feetWhere('lowest'));
  $('rim').addEventListener('click', () => feetWhere('rim'));
  $('booklet').addEventListener('click', openBooklet);
  $('mat').addEventListener('click', openMat);
  $('all').addEventListener('click', offerZip);
  document.addEventListener('keydown', (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === 'z' && event.target.tagName !== 'INPUT' && !working) undo();
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
  if (!frame) warmUp();
  document.documentElement.dataset.ready = '';
}

begin();
