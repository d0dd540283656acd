// The viewer: connects the plan, the picture and the controls of the page.
import {findPass, findPiece, forceText, instruction, passesThrough, plural, progress, readPlan} from './plan.js';
import {Stage} from './stage.js';
import {recall, remember} from './store.js';

const $ = (id) => document.getElementById(id);
const plan = readPlan($('plan').textContent);
const hidden = new Set();
const still = window.matchMedia('(prefers-reduced-motion: reduce)');
let stage = null, done = 0, timer = 0, tension = false, picked = -1;

// ---- colours ----

const copyOf = (c) => plan.cords[c].of !== c;
const currentCord = () => (done ? plan.steps[done - 1].cord : plan.order[0]);

const pageColour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// Of the passes of a cord, repeated from the start when there are more: copies are pale, but not the one in hand.
function coloursOf(c) {
  const cord = plan.cords[c];
  if (tension) return cord.taut || [pageColour('foot')];
  if (plan.run) return plan.palette.flatMap((colour) => Array(plan.run).fill(colour));
  return [copyOf(c) && c !== currentCord() ? cord.pale : cord.colour];
}

function colourOf(step) {
  const colours = coloursOf(step.cord);
  return colours[step.k % colours.length];
}

// Black or white, whichever is easier to read on a colour.
function inkOn(hex) {
  const [r, g, b] = [1, 3, 5].map((i) => (parseInt(hex.slice(i, i + 2), 16) / 255) ** 2.2);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18 ? '#000000' : '#ffffff';
}

// ---- words ----

function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

function chip(step) {
  const span = document.createElement('span'), cord = plan.cords[step.cord], colour = colourOf(step);
  span.className = 'chip';
  span.style.background = colour;
  span.style.color = inkOn(colour);
  span.textContent = plan.cords.length > 1 ? `Cord ${cord.id}, pass ${step.k + 1}` : `Pass ${step.k + 1}`;
  return span;
}

function capital(text) {
  return text[0].toUpperCase() + text.slice(1);
}

function tensionWords(step) {
  const cord = plan.cords[step.cord];
  return plan.scale && cord.tension ? `; tension ${forceText(cord.tension[step.k])}` : '';
}

function showWords() {
  const now = $('now'), last = plan.steps.length;
  setText($('count'), `${done} / ${last}`);
  if (plan.moves) {
    setText(now, (plan.moves.words?.[done] ?? plan.moves.title).replace(/(\d) (N|mm|s)\b/g, '$1\u00a0$2')); // numbers keep their units
    setText($('then'), capital(plan.moves.note));
    return;
  }
  if (done) {
    const step = plan.steps[done - 1], cord = plan.cords[step.cord];
    const copy = step.i === 0 && copyOf(step.cord) ? ` (the same as cord ${plan.cords[cord.of].id}${cord.how})` : '';
    now.replaceChildren(chip(step), ` ${capital(instruction(plan, step))}${copy}`);
  } else {
    now.textContent = `Nothing is threaded yet: ${plural(last, 'pass')} to go.`;
  }
  const next = done < last ? `Next: ${instruction(plan, plan.steps[done])}.` : 'All cords are threaded.';
  const state = done ? `${capital(progress(plan, plan.steps[done - 1]))}${tensionWords(plan.steps[done - 1])}. ` : '';
  setText($('then'), state + next);
}

// ---- names in the picture ----

const tags = new Map();

// node < 0: none. taken: places of the tags before, which it keeps clear of.
function tag(name, node, text, taken) {
  let span = tags.get(name);
  if (!span) {
    span = document.createElement('span');
    span.className = name;
    tags.set(name, span);
    $('tags').append(span);
  }
  span.hidden = node < 0;
  if (node < 0) return;
  setText(span, text);
  const at = stage.project(stage.nodes[node]), box = $('tags'), [wide, high] = [span.offsetWidth, span.offsetHeight];
  const x = Math.min(Math.max(at.x + 10, 2), box.clientWidth - wide - 2);
  const meets = (y) => taken.some((other) => Math.abs(other.y - y) < high && x < other.x + other.wide && other.x < x + wide);
  const tries = [-1.2, 0.2, -2.4, 1.4].map((part) => Math.min(Math.max(at.y + part * high, 2), box.clientHeight - high - 2));
  const y = tries.find((one) => !meets(one)) ?? tries[0];
  taken.push({x, y, wide});
  span.hidden = at.depth > 1 || at.x < 0 || at.y < 0 || at.x > box.clientWidth || at.y > box.clientHeight;
  span.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
}

// Names of all pieces if they are wanted, the nearest first, as many as there is room for.
function placeNames(taken) {
  const box = $('labels'), free = [...box.children];
  const all = $('names').checked ? plan.pieces.map((name, p) => ({name, ...stage.project(stage.place[p].middle)})) : [];
  for (const {name, x, y, depth} of all.sort((a, b) => a.depth - b.depth)) {
    const wide = 8 * name.length + 2, left = x - wide / 2, top = y - 7;
    if (depth > 1 || left < 0 || top < 0 || left + wide > box.clientWidth || top + 14 > box.clientHeight) continue;
    if (taken.some((other) => Math.abs(other.y - top) < 16 && left < other.x + other.wide && other.x < left + wide)) continue;
    taken.push({x: left, y: top, wide});
    const span = free.shift() ?? box.appendChild(document.createElement('span'));
    setText(span, name);
    span.style.transform = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
  }
  for (const span of free) span.remove();
}

function placeTags() {
  if (plan.moves) {
    const names = [];
    if (picked >= 0) tag('now', picked, plan.places[picked], names);
    placeNames(names);
    return;
  }
  const step = plan.steps[done - 1], ahead = plan.steps[done];
  const here = step ? plan.head(step.half) : plan.tail(ahead.half);
  const start = ahead && ahead.begins && step ? plan.tail(ahead.half) : -1;
  const to = ahead ? plan.head(ahead.half) : -1;
  const taken = [];
  tag('now', here, plan.places[here], taken);
  tag('start', start === here ? -1 : start, start < 0 ? '' : `start ${plan.labels[start]}`, taken);
  tag('to', to, to < 0 ? '' : `next ${plan.labels[to]}`, taken);
  placeNames(taken);
}

// ---- steps ----

function showPicture() {
  if (plan.moves) {
    stage.showFrame(done);
    document.documentElement.dataset.step = done;
    return;
  }
  const at = stage.show(done, coloursOf, hidden, done ? colourOf(plan.steps[done - 1]) : '#000000');
  const {dataset} = document.documentElement;
  [dataset.step, dataset.piece, dataset.next] = [done, at.now, at.next];
  $('canvas').setAttribute('aria-label', `The framework in space, ${done} of ${plural(plan.steps.length, 'pass')} threaded`);
}

function refresh() {
  const cord = currentCord();
  if (stage) showPicture();
  for (const item of $('cords').children) {
    const c = Number(item.dataset.cord);
    item.toggleAttribute('aria-current', c === cord);
    if (c === cord) inSight(item);
    item.querySelector('.swatch').style.background = swatch(c);
  }
}

function goTo(step) {
  done = Math.min(Math.max(Math.round(step) || 0, 0), plan.steps.length);
  const slider = $('slider');
  slider.value = String(done);
  showWords();
  slider.setAttribute('aria-valuetext', `${done} of ${plural(plan.steps.length, plan.moves ? 'step' : 'pass')}`);
  if (plan.key) remember(plan.key, done);
  refresh();
  if (stage && !plan.moves && $('follow').checked) stage.face(plan.steps[Math.max(done - 1, 0)].piece, still.matches);
  if (done === plan.steps.length) pause();
}

function pause() {
  clearInterval(timer);
  timer = 0;
  $('play').textContent = '▶ play';
  $('play').setAttribute('aria-label', 'Play');
  $('words').setAttribute('aria-live', 'polite');
}

function play() {
  clearInterval(timer);
  if (done === plan.steps.length) goTo(0);
  timer = setInterval(() => goTo(done + 1), 1000 / Number($('speed').value));
  $('play').textContent = '❚❚ pause';
  $('play').setAttribute('aria-label', 'Pause');
  $('words').setAttribute('aria-live', 'off');
}

function stepTo(step) {
  pause();
  goTo(step);
}

// ---- the panel ----

// Scrolls the list only, never the page.
function inSight(item) {
  const list = item.parentElement, top = item.offsetTop - list.offsetTop;
  list.scrollTop = Math.min(Math.max(list.scrollTop, top + item.offsetHeight - list.clientHeight), top);
}

function swatch(c) {
  const colours = coloursOf(c);
  const shown = tension || !plan.run ? colours : plan.palette.slice(0, Math.ceil(plan.steps.length / plan.run));
  const width = 100 / shown.length;
  return `linear-gradient(90deg, ${shown.map((colour, i) => `${colour} ${i * width}% ${(i + 1) * width}%`).join(', ')})`;
}

function cordItem(c) {
  const cord = plan.cords[c], item = document.createElement('li'), label = document.createElement('label');
  const box = document.createElement('input'), bar = document.createElement('span'), text = document.createElement('span');
  const name = document.createElement('strong'), more = document.createElement('small');
  Object.assign(box, {type: 'checkbox', checked: true, ariaLabel: `Show cord ${cord.id}`});
  box.addEventListener('change', () => {
    if (box.checked) hidden.delete(c);
    else hidden.add(c);
    refresh();
  });
  bar.className = 'swatch';
  name.textContent = `Cord ${cord.id}`;
  const kind = copyOf(c) ? `the same as ${plan.cords[cord.of].id}${cord.how}` : '';
  const copies = plan.cords.filter((other) => other.of === c).length - 1;
  const times = copies ? `${plural(copies, 'more cord')} like it` : 'once';
  const path = !copyOf(c) && plan.paths < plan.cords.length ? `path ${cord.path + 1}, ${times}` : '';
  const words = [`${plural(cord.half.length, 'pass')}, ${cord.length}`, path || kind, cord.pull];
  more.textContent = words.filter(Boolean).join('; ');
  text.append(name, more);
  label.append(box, bar, text);
  item.append(label);
  item.dataset.cord = String(c);
  return item;
}

function showScale() {
  const {scale} = plan, box = $('scale'), part = (value) => (scale.low > 0 ? Math.log(value / scale.low) / span : value / scale.high);
  const ramp = document.createElement('div'), note = document.createElement('small');
  const span = Math.log(scale.high / scale.low);
  ramp.className = 'ramp';
  ramp.style.background = `linear-gradient(90deg, ${scale.ramp.join(', ')})`;
  box.append(ramp);
  for (const [value, text] of scale.ticks) {
    const tick = document.createElement('span');
    tick.className = 'tick';
    tick.textContent = text;
    tick.style.left = `${span > 0 ? 100 * part(value) : 0}%`;
    box.append(tick);
  }
  note.textContent = plan.moves ? 'tension' : `Tension of every pass: ${scale.method}.`;
  box.append(note);
}

// Ticks that would run into the one before are left out; that can be told once they are shown.
function thinTicks() {
  let end = -Infinity;
  for (const tick of document.querySelectorAll('#scale .tick')) {
    tick.hidden = false;
    const {left, right} = tick.getBoundingClientRect();
    tick.hidden = left < end + 4;
    if (!tick.hidden) end = right;
  }
}

// The scale lies in the picture, where a telephone shows it, too; speeds are those of the simulation, as it was timed.
function fillRisePanel() {
  const {seconds, colours} = plan.moves;
  $('seen').textContent = 'Simulated: pieces as they are made, cords from mouth to mouth in the colours of their tension.';
  for (const option of $('speed').options) option.value = String(Number(option.value) / seconds);
  $('speed').value = String(0.5 / seconds); // most are up within three seconds
  setText($('per'), '×');
  $('speed').ariaLabel = 'Speed, as a part of the real one';
  if (!plan.scale) return;
  plan.scale.ramp = colours.slice(0, -1);
  showScale();
  $('scale').hidden = false;
  $('stage').append($('scale'));
  thinTicks();
}

// What moves has no cords to thread: the panel only says what moves, and play begins at a speed at which it is seen to move.
function fillMotionPanel() {
  $('title').textContent = document.title = plan.moves.title;
  $('slider').max = String(plan.steps.length);
  $('speed').value = '20';
  for (const part of ['jump', 'key', 'cords', 'follow']) ($(part).closest('section, label') ?? $(part)).hidden = true;
  ['one step back, on', 'ten steps', 'the first frame, the last'].forEach((words, i) => setText(document.querySelectorAll('dl dd')[i], words));
  if (plan.moves.poses) fillRisePanel();
  for (const [button, words] of [['back', 'One step back'], ['on', 'One step on'], ['slider', 'Step of the motion']]) $(button).ariaLabel = words;
}

function fillPanel() {
  if (plan.moves) {
    fillMotionPanel();
    return;
  }
  const {cords, steps, pieces, paths} = plan;
  const learn = paths < cords.length ? `, ${plural(paths, 'path')} to learn` : '';
  const title = `${plural(cords.length, 'cord')}${learn}, ${plural(pieces.length, plan.solid ? 'piece' : 'tube')}, ${plural(steps.length, 'pass')}`;
  $('title').textContent = title;
  document.title = `Threading: ${title}`;
  $('seen').textContent = plan.solid
    ? 'Arms are called by the piece that they face.'
    : 'Tubes are called by the places at their ends.';
  document.documentElement.classList.toggle('solid', plan.solid);
  $('cords').append(...plan.order.map(cordItem));
  $('slider').max = String(steps.length);
  $('show').hidden = !plan.scale;
  if (plan.scale) showScale();
}

function describe(piece) {
  const through = passesThrough(plan, piece);
  const name = ({cord, k}) => (plan.cords.length > 1 ? plan.cords[cord].id : '') + (k + 1);
  const names = through.map((i) => name(plan.steps[i - 1]));
  const passes = through.length ? `pass ${names.join(', ')}` : 'no pass';
  $('found').textContent = `${plan.pieces[piece]}, kind ${plan.kinds[piece]}: ${passes}.`;
  return through;
}

// ---- events ----

function jump(event) {
  event.preventDefault();
  const pass = $('pass').value, name = $('piece').value;
  if (pass.trim()) {
    const step = findPass(plan, pass);
    $('found').textContent = Number.isNaN(step) ? `There is no pass ${pass.trim()}.` : '';
    if (!Number.isNaN(step)) stepTo(step);
  } else if (name.trim()) {
    const piece = findPiece(plan, name);
    if (piece < 0) {
      $('found').textContent = `There is no ${plan.solid ? 'piece' : 'tube'} ${name.trim()}.`;
      return;
    }
    const through = describe(piece);
    if (through.length) stepTo(through.find((step) => step > done) ?? through[0]);
  }
}

const isDark = () => document.documentElement.dataset.theme === 'dark';

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  if (!stage) return;
  const names = ['paper', 'bare', 'held', 'now', 'next', 'foot', 'rim'];
  stage.setTheme(Object.fromEntries(names.map((name) => [name, pageColour(name)])));
  refresh();
}

function switchTheme() {
  setTheme(!isDark());
  remember('thread-viewer:theme', isDark() ? 'dark' : 'light');
}

const keys = {
  ArrowLeft: () => stepTo(done - 1),
  ArrowRight: () => stepTo(done + 1),
  PageUp: () => stepTo(done - 10),
  PageDown: () => stepTo(done + 10),
  Home: () => stepTo(0),
  End: () => stepTo(plan.steps.length),
  ' ': () => (timer ? pause() : play()),
  '+': () => stage?.zoom(0.85),
  '=': () => stage?.zoom(0.85),
  '-': () => stage?.zoom(1 / 0.85),
  a: () => stage?.turn(-0.12, 0),
  d: () => stage?.turn(0.12, 0),
  w: () => stage?.turn(0, 0.12),
  s: () => stage?.turn(0, -0.12),
  A: () => stage?.move(-1, 0),
  D: () => stage?.move(1, 0),
  W: () => stage?.move(0, 1),
  S: () => stage?.move(0, -1),
  r: () => stage?.reset(),
  f: () => $('follow').click(),
  n: () => $('names').click(),
  t: switchTheme,
};

// Text fields, choices and buttons keep the keys that they use themselves.
function taken(target, key) {
  const {tagName, type} = target;
  if (tagName === 'SELECT' || (tagName === 'INPUT' && type === 'text') || type === 'radio') return true;
  return key === ' ' && (tagName === 'BUTTON' || tagName === 'SUMMARY' || type === 'checkbox');
}

function onKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || taken(event.target, event.key)) return;
  const act = keys[event.key];
  if (!act) return;
  event.preventDefault();
  act();
}

// A click that is no drag says which piece it is.
function listenForPicks(canvas) {
  let down = null;
  canvas.addEventListener('pointerdown', (event) => (down = [event.offsetX, event.offsetY]));
  canvas.addEventListener('pointerup', (event) => {
    if (!down || Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 5) return;
    const piece = stage.pick(event.offsetX, event.offsetY);
    if (plan.moves?.poses) {
      picked = document.documentElement.dataset.piece = piece;
      placeTags();
    }
    if (piece < 0 || plan.moves) return;
    describe(piece);
    $('pass').value = '';
    $('piece').value = plan.pieces[piece];
  });
}

// On a telephone picture and controls share the screen; the picture does not jump when words need a line less.
function shareScreen() {
  let most = 0, width = 0;
  new ResizeObserver(() => {
    const bar = $('bar');
    if (bar.offsetWidth !== width) [width, most] = [bar.offsetWidth, 0];
    most = Math.max(most, bar.offsetHeight);
    document.documentElement.style.setProperty('--bar', `${most}px`);
  }).observe($('bar'));
}

function listen() {
  $('slider').addEventListener('input', () => stepTo(Number($('slider').value)));
  $('back').addEventListener('click', () => stepTo(done - 1));
  $('on').addEventListener('click', () => stepTo(done + 1));
  $('play').addEventListener('click', () => (timer ? pause() : play()));
  $('speed').addEventListener('change', () => timer && play());
  $('follow').addEventListener('change', () => goTo(done));
  $('names').addEventListener('change', () => stage && placeTags());
  $('reset').addEventListener('click', () => stage?.reset());
  $('theme').addEventListener('click', switchTheme);
  $('jump').addEventListener('submit', jump);
  $('pass').addEventListener('input', () => ($('piece').value = ''));
  $('piece').addEventListener('input', () => ($('pass').value = ''));
  for (const choice of document.querySelectorAll('input[name="show"]')) {
    choice.addEventListener('change', () => {
      tension = choice.value === 'tension';
      $('scale').hidden = !tension;
      if (tension) thinTicks();
      showWords();
      refresh();
    });
  }
  document.addEventListener('keydown', onKey);
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  dark.addEventListener('change', () => recall('thread-viewer:theme') || setTheme(dark.matches));
  const chosen = recall('thread-viewer:theme');
  setTheme(chosen ? chosen === 'dark' : dark.matches);
}

fillPanel();
shareScreen();
try {
  stage = new Stage(plan, $('canvas'), placeTags);
  listenForPicks($('canvas'));
} catch (error) {
  $('trouble').textContent = `This browser cannot show the picture (${error.message}). The steps in words below still work.`;
  $('trouble').hidden = false;
}
listen();
goTo(plan.key ? Number(recall(plan.key)) : 0);
if (!plan.key && !still.matches) play();
// for tests and the curious: where a point of the framework is in the picture
window.threadViewer = {project: (node) => stage.project(node), nodes: stage?.nodes};
