// The viewer in headless Chromium, against plan.json read here on its own. test.cjs PACKAGES PROGRAM SCRATCH: the folder with
// playwright-core, the program, an empty folder. Closes with "N passed, N failed".
'use strict';
const {execFileSync} = require('node:child_process');
const {createRequire} = require('node:module');
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const {pathToFileURL} = require('node:url');

const [packages, program, scratch] = process.argv.slice(2).map((name) => path.resolve(name));
const {chromium} = createRequire(path.join(packages, 'package.json'))('playwright-core');
const LIME = [196, 238, 0]; // the piece in hand
const WIDE = {width: 900, height: 700}, PHONE = {width: 360, height: 740};
let browser, reader;

// ---- plans ----

const thread = (...words) => execFileSync(program, words, {encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
const file = (name) => path.join(scratch, name);

function make(name, frame, ...options) {
  thread('plan', frame, ...(options.length ? options : ['--cords', '1']), '-o', file(`${name}.json`));
  return draw(name);
}

function draw(name) {
  thread('draw', file(`${name}.json`), '-T', 'html', '-o', file(`${name}.html`));
  const plan = JSON.parse(fs.readFileSync(file(`${name}.json`), 'utf8'));
  plan.rows = thread('draw', file(`${name}.json`), '-T', 'steps.csv', '-o', '-').trim().split('\n').map((row) => row.split(','));
  return {name, url: pathToFileURL(file(`${name}.html`)).href, plan};
}

// The same cords through tubes along the edges, whatever ties them.
function asTubes(name) {
  const plan = JSON.parse(fs.readFileSync(file(`${name}.json`), 'utf8'));
  plan.options.joint = 'tube';
  fs.writeFileSync(file(`${name}-tubes.json`), JSON.stringify(plan));
  return draw(`${name}-tubes`);
}

// Passes in the order of threading, which steps.csv has (tests/unit/test_tables.c holds that against the plan).
function passesOf(plan) {
  const [names, ...rows] = plan.rows, at = (row, name) => row[names.indexOf(name)], solid = plan.options.joint !== 'tube';
  return rows.filter((row) => at(row, 'step') !== '0').map((row) => {
    const to = Number(at(row, 'to_node')), edge = Number(at(row, 'edge'));
    return {c: plan.cords.findIndex((cord) => cord.id === at(row, 'cord')), k: Number(at(row, 'step')) - 1, edge, to, piece: solid ? to : edge};
  });
}

// Of the edges at a node the longest, as a part of the framework's size.
function longestArm({framework: {nodes, edges}}, node) {
  const apart = (a, b) => Math.hypot(...nodes[a].map((x, i) => x - nodes[b][i]));
  const size = Math.hypot(...[0, 1, 2].map((i) => Math.max(...nodes.map((p) => p[i])) - Math.min(...nodes.map((p) => p[i]))));
  return Math.max(...edges.filter((edge) => edge.includes(node)).map(([a, b]) => apart(a, b))) / size;
}

// Names of the pieces, by their number.
function namesOf(drawn) {
  const rows = thread('draw', file(`${drawn.name}.json`), '-T', 'beads.csv', '-o', '-').trim().split('\n').slice(1);
  return rows.map((row) => row.split(',')[0]);
}

// ---- pages ----

// A page with the viewer, and what it asked for and complained about.
async function open(drawn, {viewport = WIDE, context = null, before = null, ...more} = {}) {
  const own = context || (await browser.newContext({viewport, colorScheme: 'light', reducedMotion: 'reduce', ...more}));
  const page = await own.newPage(), requests = [], complaints = [];
  page.on('request', (request) => requests.push(request.url()));
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  if (before) await page.addInitScript(before);
  await page.goto(drawn.url);
  await page.waitForSelector('html[data-step]');
  return {page, requests, complaints, close: () => own.close()};
}

const state = (page) => page.evaluate(() => {
  const {step, piece, next, theme} = document.documentElement.dataset;
  return {step: Number(step), piece: Number(piece), next: Number(next), theme};
});
const text = (page, selector) => page.locator(selector).innerText();
const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

async function setSlider(page, value) {
  await page.locator('#slider').evaluate((slider, v) => {
    slider.value = String(v);
    slider.dispatchEvent(new Event('input', {bubbles: true}));
  }, value);
}

// Every step in turn, without waiting for the picture: what is lit and what is said.
const walk = (page) => page.evaluate(() => {
  const slider = document.getElementById('slider'), {dataset} = document.documentElement, seen = [];
  for (let i = 1; i <= Number(slider.max); i++) {
    slider.value = String(i);
    slider.dispatchEvent(new Event('input'));
    const [step, piece, next] = [dataset.step, dataset.piece, dataset.next].map(Number);
    seen.push({step, piece, next, words: document.getElementById('now').textContent});
  }
  return seen;
});

// Number of pixels near a colour in a part of the page's picture, and of different colours.
async function look(page, colour, box = null) {
  await drawn(page);
  const canvas = await page.locator('#canvas').boundingBox();
  const shot = await page.screenshot({clip: box || canvas, style: '#tags, .corner { visibility: hidden }'});
  return reader.evaluate(async ({png, colour}) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height), pen = canvas.getContext('2d');
    pen.drawImage(image, 0, 0);
    const {data} = pen.getImageData(0, 0, image.width, image.height), seen = new Set();
    let near = 0;
    for (let i = 0; i < data.length; i += 4) {
      seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      const shade = Math.max(...[0, 1, 2].map((c) => Math.abs(data[i + c] - colour[c])));
      near += shade <= 3;
    }
    return {near, colours: seen.size, lime: limeIn(data)};
    // lit from one side and half transparent, lime keeps its hue: much green, some red, less blue
    function limeIn(d) {
      let n = 0;
      for (let i = 0; i < d.length; i += 4) {
        const [red, green, blue] = [d[i], d[i + 1], d[i + 2]];
        n += green > 90 && blue < 0.62 * green && red > 0.6 * green && red < 0.95 * green;
      }
      return n;
    }
  }, {png: shot.toString('base64'), colour});
}

const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

// Where the middle of a solid piece of the plan is on the page.
async function middleOf(page, plan, node) {
  const at = plan.framework.nodes[node], canvas = await page.locator('#canvas').boundingBox();
  const p = await page.evaluate(async (point) => { // once the camera has come to rest
    const {project, nodes} = window.threadViewer, where = () => project(nodes[0].clone().set(...point));
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    let before = null, now = where();
    while (!before || now.x !== before.x || now.y !== before.y) {
      before = now;
      for (let i = 0; i < 3; i++) await frame();
      now = where();
    }
    return now;
  }, at);
  return {x: canvas.x + p.x, y: canvas.y + p.y};
}

// ---- tests ----

const tests = {
  async 'loads from a file without a request or a complaint'({dome}) {
    const {page, requests, complaints, close} = await open(dome);
    await setSlider(page, 20);
    await page.keyboard.press('End');
    await drawn(page);
    assert.deepEqual(requests.filter((url) => !url.startsWith('data:')), [dome.url]);
    assert.deepEqual(complaints, []);
    const blank = await look(page, [0, 0, 0]);
    assert.ok(blank.colours > 100, `${blank.colours} colours`);
    await close();
  },

  async 'a motion is played through the positions that info found'() {
    const frame = path.join(__dirname, '../../data/conmech/tower_3D.json'), url = file('motion.html');
    const {followed} = JSON.parse(thread('info', frame, '--play', url, '--json')).motions;
    const {page, complaints, close} = await open({url: pathToFileURL(url).href});
    for (const step of [0, 20, followed.frames.length - 1]) {
      await setSlider(page, step);
      assert.equal(await text(page, '#count'), `${step} / ${followed.frames.length - 1}`);
      const nodes = await page.evaluate(() => window.threadViewer.nodes.map((p) => p.toArray()));
      nodes.flat().forEach((x, i) => assert.ok(Math.abs(x - followed.frames[step].flat()[i]) < 1e-5));
    }
    await page.keyboard.press('Home');
    await page.locator('#play').click();
    await page.waitForFunction(() => Number(document.documentElement.dataset.step) > 3);
    assert.deepEqual(complaints, []);
    await close();
  },

  async 'rising pieces are where the simulation had them'() {
    const plan = file('small.json'), url = file('rise.html'), record = file('rise.json');
    thread('make', 'dome', '--size', '3', '-o', file('d3.json'));
    thread('plan', file('d3.json'), '--cords', '1', '-o', plan);
    thread('rise', plan, '--pull', '3', '-o', record, '--play', url);
    const {moments, frames} = JSON.parse(fs.readFileSync(record, 'utf8')).runs[0], last = frames.length - 1;
    const opened = await open({url: pathToFileURL(url).href}), {page} = opened;
    const unit = JSON.parse(await page.locator('#plan').textContent()).kit.mm; // mm in a unit of the framework
    for (const step of [0, last >> 1, last]) {
      await setSlider(page, step);
      const [time, pull, , closed] = moments[step], words = (await text(page, '#now')).replaceAll('\u00a0', ' ');
      assert.ok(words.startsWith(`${time.toFixed(2)} s, pull ${pull.toFixed(2)} N, ${closed} of `), words);
      const nodes = await page.evaluate(() => window.threadViewer.nodes.map((p) => p.toArray()));
      nodes.forEach((p, v) => p.forEach((x, k) => assert.ok(Math.abs(x * unit - frames[step][7 * v + k]) < 2e-3, `frame ${step}, piece ${v}`)));
    }
    assert.ok((await text(page, '#scale')).includes(' N'));

    // a click finds the solid itself there: the meshes moved, and not only their middles
    for (const step of [0, last]) {
      await setSlider(page, step);
      await drawn(page);
      const at = await page.evaluate(() => window.threadViewer.project(window.threadViewer.nodes[0]));
      await page.locator('#canvas').click({position: {x: at.x, y: at.y}});
      assert.equal((await state(page)).piece, 0);
      assert.equal(await text(page, '#tags .now'), JSON.parse(await page.locator('#plan').textContent()).places[0]);
    }
    assert.deepEqual(opened.complaints, []);
    await opened.close();

    // it plays by itself, unless less motion is wanted; on a telephone the scale is in sight
    const playing = await open({url: pathToFileURL(url).href}, {viewport: PHONE, reducedMotion: 'no-preference'});
    await playing.page.waitForFunction((n) => Number(document.documentElement.dataset.step) > n, 3);
    await playing.page.keyboard.press(' ');
    assert.equal(await playing.page.locator('#play').getAttribute('aria-label'), 'Play');
    const {step} = await state(playing.page);
    await playing.page.keyboard.press('ArrowRight');
    assert.equal((await state(playing.page)).step, step + 1);
    const [slider, count] = await Promise.all(['#slider', '#count'].map((name) => playing.page.locator(name).boundingBox()));
    assert.ok(count.x >= slider.x + slider.width && Math.abs(count.y + count.height / 2 - slider.y - slider.height / 2) < slider.height / 2, 'the count beside the slider');
    const scale = await playing.page.locator('#scale').boundingBox();
    assert.ok(scale.y >= 0 && scale.y + scale.height < PHONE.height / 2);
    assert.deepEqual(playing.complaints, []);
    await playing.close();
  },

  async 'slider, words and piece follow the plan'({dome}) {
    const {page, close} = await open(dome), passes = passesOf(dome.plan), names = namesOf(dome);
    assert.equal(Number(await page.locator('#slider').getAttribute('max')), passes.length);
    const seen = await walk(page);
    assert.equal(seen.length, passes.length);
    for (const [i, {step, piece, next, words}] of seen.entries()) {
      const pass = passes[i], cord = dome.plan.cords[pass.c].id;
      assert.deepEqual([step, piece, next], [i + 1, pass.piece, i + 1 < passes.length ? passes[i + 1].piece : -1]);
      assert.ok(words.includes(names[pass.piece]), words);
      assert.ok(words.startsWith(dome.plan.cords.length > 1 ? `Cord ${cord}, pass ${pass.k + 1}` : `Pass ${pass.k + 1}`), words);
    }
    await setSlider(page, 0);
    assert.deepEqual((({step, piece, next}) => [step, piece, next])(await state(page)), [0, -1, passes[0].piece]);
    await close();
  },

  async 'the lit piece is where the plan has it'({dome}) {
    const {page, close} = await open(dome), passes = passesOf(dome.plan);
    await page.locator('#follow').check();
    for (const step of [1, Math.floor(passes.length / 3), Math.floor(passes.length / 2), passes.length]) {
      await setSlider(page, step);
      const at = await middleOf(page, dome.plan, passes[step - 1].piece);
      const canvas = await page.locator('#canvas').boundingBox();
      const lit = (await look(page, LIME, {x: at.x - 50, y: at.y - 50, width: 100, height: 100})).lime;
      const all = (await look(page, LIME, canvas)).lime;
      assert.ok(lit > 60, `step ${step}: ${lit} pixels are lit`);
      assert.ok(all < 6 * lit, `step ${step}: ${all} pixels are lit, ${lit} of them near the piece`);
    }
    await close();
  },

  async 'keys'({dome}) {
    const {page, close} = await open(dome), last = passesOf(dome.plan).length;
    const at = async (key, step) => {
      await page.keyboard.press(key);
      assert.equal((await state(page)).step, step, key);
    };
    await at('ArrowRight', 1);
    await at('ArrowRight', 2);
    await at('ArrowLeft', 1);
    await at('PageDown', 11);
    await at('PageUp', 1);
    await at('End', last);
    await at('ArrowRight', last);
    await at('Home', 0);
    await page.locator('#slider').focus();
    await at('ArrowRight', 1);
    await page.locator('#pass').focus();
    await at('ArrowRight', 1);
    await at('Home', 1);
    await page.locator('#canvas').focus();
    const before = await middleOf(page, dome.plan, 0);
    await at('d', 1);
    const after = await middleOf(page, dome.plan, 0);
    assert.ok(Math.hypot(after.x - before.x, after.y - before.y) > 3, 'D turns the view');
    await page.locator('#speed').selectOption('20');
    await page.locator('#canvas').focus();
    await page.keyboard.press(' ');
    await page.waitForFunction(() => Number(document.documentElement.dataset.step) > 4);
    await page.keyboard.press(' ');
    const paused = (await state(page)).step;
    await page.waitForTimeout(200);
    assert.equal((await state(page)).step, paused);
    assert.ok(paused < last);
    await close();
  },

  async 'names of all pieces, the nearest where there is room'({dome}) {
    const {page, close} = await open(dome), names = namesOf(dome);
    const shown = () => page.evaluate(() => [...document.querySelectorAll('#labels span')].map((span) => {
      const {left, right, top, bottom} = span.getBoundingClientRect();
      return {text: span.textContent, left, right, top, bottom};
    }));
    assert.deepEqual(await shown(), []);
    await page.keyboard.press('n');
    const labels = await shown();
    assert.ok(labels.length > names.length / 2, `${labels.length} of ${names.length}`);
    assert.equal(new Set(labels.map(({text}) => text)).size, labels.length);
    for (const one of labels) assert.ok(names.includes(one.text), one.text);
    const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    labels.forEach((a, i) => labels.slice(0, i).forEach((b) => assert.ok(!meet(a, b), `${a.text} meets ${b.text}`)));
    await page.keyboard.press('n');
    assert.deepEqual(await shown(), []);
    await close();
  },

  async 'everything can be reached with the Tab key and has a name'({dome}) {
    const {page, close} = await open(dome), reached = new Set();
    for (let i = 0; i < 40; i++) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => document.activeElement.id));
    }
    for (const id of ['canvas', 'theme', 'reset', 'pass', 'piece', 'follow', 'back', 'play', 'on', 'speed', 'slider'])
      assert.ok(reached.has(id), id);
    const nameless = await page.locator('button, input, select, canvas').evaluateAll((all) => {
      const named = (node) => node.getAttribute('aria-label') || (node.labels && node.labels.length) || node.innerText?.trim();
      return all.filter((node) => !named(node)).map((node) => node.outerHTML);
    });
    assert.deepEqual(nameless, []);
    await close();
  },

  async 'a cord that is off is not drawn'({tubes}) {
    const {page, close} = await open(tubes), colour = rgb('#0072B2');
    await page.keyboard.press('End');
    const on = (await look(page, colour)).near;
    await page.getByLabel('Show cord A').uncheck();
    const off = (await look(page, colour)).near;
    await page.getByLabel('Show cord A').check();
    const again = (await look(page, colour)).near;
    assert.ok(on > 50, `${on} pixels`);
    assert.equal(off, 0);
    assert.equal(again, on);
    await close();
  },

  async 'the caption has the colour of the cord'({several}) {
    const {page, close} = await open(several), passes = passesOf(several.plan);
    for (const pass of [1, passes.length]) {
      await setSlider(page, pass);
      const chip = await page.locator('#now .chip').evaluate((node) => getComputedStyle(node).backgroundColor);
      const colour = chip.match(/\d+/g).map(Number);
      await page.locator('#follow').check();
      assert.ok((await look(page, colour)).near > 30, `pass ${pass}: ${chip} is not in the picture`);
    }
    await close();
  },

  async 'cords have a dark rim'({tubes}) {
    const {page, close} = await open(tubes), colour = [0x2a, 0x2a, 0x2e];
    await page.locator('#follow').check();
    assert.equal((await look(page, colour)).near, 0, 'nothing is threaded');
    await page.locator('#on').click();
    await drawn(page);
    for (let i = 0; i < 8; i++) await page.keyboard.press('+');
    assert.ok((await look(page, colour)).near > 30, 'no rim');
    await page.locator('#cords input').first().uncheck();
    assert.equal((await look(page, colour)).near, 0, 'a cord that is off has a rim');
    await close();
  },

  async 'the step is remembered, for each plan'({dome, several}) {
    const context = await browser.newContext({viewport: WIDE}), first = await open(dome, {context});
    await setSlider(first.page, 17);
    await first.page.reload();
    await first.page.waitForSelector('html[data-step]');
    assert.equal((await state(first.page)).step, 17);
    const second = await open(several, {context});
    assert.equal((await state(second.page)).step, 0);
    await context.close();
  },

  async 'no storage, no trouble'({dome}) {
    const before = () => Object.defineProperty(window, 'localStorage', {get() { throw new Error('denied'); }});
    const {page, complaints, close} = await open(dome, {before});
    await setSlider(page, 5);
    await page.locator('#theme').click();
    assert.equal((await state(page)).step, 5);
    assert.deepEqual(complaints, []);
    await close();
  },

  async 'without WebGL the words still work'({dome}) {
    const before = () => { HTMLCanvasElement.prototype.getContext = () => null; };
    const own = await browser.newContext({viewport: WIDE}), page = await own.newPage();
    await page.addInitScript(before);
    await page.goto(dome.url);
    await page.locator('#trouble').waitFor();
    await setSlider(page, 3);
    assert.ok((await text(page, '#now')).includes(namesOf(dome)[passesOf(dome.plan)[2].piece]));
    const swatch = await page.locator('.swatch').first().evaluate((node) => getComputedStyle(node).backgroundImage);
    assert.ok(swatch.includes('rgb(0, 114, 178)'), swatch);
    await own.close();
  },

  async 'a telephone'({several}) {
    const {page, close} = await open(several, {viewport: PHONE, hasTouch: true, isMobile: true});
    await page.locator('#on').tap();
    assert.equal((await state(page)).step, 1);
    const size = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    assert.ok(size[0] <= size[1], `${size[0]} of ${size[1]} pixels`);
    const small = await page.locator('button, select').evaluateAll((all) =>
      all.filter((node) => node.offsetHeight < 40 || node.offsetWidth < 40).map((node) => node.id));
    assert.deepEqual(small, []);
    const canvas = await page.locator('#canvas').boundingBox(), bar = await page.locator('#bar').boundingBox();
    assert.ok(canvas.height > 250);
    assert.ok(canvas.y + canvas.height <= bar.y + 1 && bar.y + bar.height <= PHONE.height + 1, 'all on one screen');
    await page.setViewportSize({width: PHONE.height, height: PHONE.width});
    await drawn(page);
    const turned = await page.locator('#canvas').boundingBox(), beside = await page.locator('#bar').boundingBox();
    assert.ok(turned.height >= PHONE.width - 1 && turned.x + turned.width <= beside.x + 1, 'side by side');
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    const on = await page.locator('#on').boundingBox();
    assert.ok(on.y + on.height <= PHONE.width, 'the buttons are on the screen');
    await close();
  },

  async 'dark and light'({dome}) {
    const {page, close} = await open(dome, {colorScheme: 'dark'});
    assert.equal((await state(page)).theme, 'dark');
    const dark = await look(page, [32, 34, 38]);
    await page.locator('#theme').click();
    const light = await look(page, [255, 255, 255]);
    assert.ok(dark.near > 1e5 && light.near > 1e5, `${dark.near} dark, ${light.near} light pixels`);
    await page.reload();
    await page.waitForSelector('html[data-step]');
    assert.equal((await state(page)).theme, 'light');
    await close();
  },

  async 'jumps'({several}) {
    const {page, close} = await open(several), passes = passesOf(several.plan), names = namesOf(several);
    const jump = async (field, words) => {
      await page.locator(field).fill(words);
      await page.locator('#jump button').click();
      return (await state(page)).step;
    };
    assert.equal(await jump('#pass', '7'), 7);
    const first = passes.findIndex((pass) => several.plan.cords[pass.c].id === 'B');
    assert.equal(await jump('#pass', 'b3'), first + 3);
    assert.equal(await jump('#pass', 'B9999'), first + 3);
    assert.ok((await text(page, '#found')).includes('no pass B9999'));
    const through = passes.flatMap((pass, i) => (pass.piece === 24 ? [i + 1] : []));
    assert.equal(await jump('#piece', names[24].toLowerCase()), through.find((step) => step > first + 3) ?? through[0]);
    assert.equal((await state(page)).piece, 24);
    const stay = (await state(page)).step;
    assert.equal(await jump('#piece', 'no such piece'), stay);
    assert.ok((await text(page, '#found')).includes('no piece'));
    await close();
  },

  async 'a click says which piece it is'({dome}) {
    const {page, close} = await open(dome);
    await page.locator('#follow').check();
    await page.keyboard.press('End');
    const {piece} = await state(page), at = await middleOf(page, dome.plan, piece);
    await page.mouse.click(at.x, at.y);
    assert.ok((await text(page, '#found')).startsWith(`${namesOf(dome)[piece]}, kind `));
    await close();
  },

  async 'copies come after their path and say whose they are'({symmetric}) {
    const {page, close} = await open(symmetric), {plan} = symmetric, passes = passesOf(plan);
    assert.ok(plan.symmetry.unique_paths < plan.cords.length);
    assert.ok((await text(page, '#title')).includes(`${plan.symmetry.unique_paths} path`));
    const seen = await walk(page);
    assert.equal(seen.length, passes.length);
    for (const [i, {piece, words}] of seen.entries()) {
      const {of} = plan.symmetry.cords[passes[i].c];
      assert.equal(piece, passes[i].piece);
      if (i === 0 || passes[i].c !== passes[i - 1].c) assert.equal(words.includes(`the same as cord ${plan.cords[of].id},`), of !== passes[i].c, words);
    }
    await close();
  },

  async 'words are those of the steps'({dome}) {
    const {page, close} = await open(dome);
    const steps = thread('draw', file(`${dome.name}.json`), '-T', 'steps', '-o', '-').replace(/\n {4,}(?=\S)/g, ' ');
    const rows = [...steps.matchAll(/^\[ \] +[0-9]+ +(.*?)(?: the needle comes out at .*)?$/gm)].map(([, row]) => row.toLowerCase());
    const seen = (await walk(page)).map(({words}) => words.replace(/^.*?pass \d+ /i, '').replace(/^(left|right) needle, from the fold: /i, '').replace(/^start.*?; /i, '').toLowerCase());
    assert.ok(seen.length > 10);
    assert.deepEqual(seen, rows);
    await close();
  },

  async 'pieces, not edges, are counted'({dome, tubes}) {
    for (const [drawn, count] of [[dome, '49 pieces'], [tubes, '84 tubes']]) {
      const {page, close} = await open(drawn);
      assert.ok((await text(page, '#title')).includes(count));
      await close();
    }
  },

  async 'a telephone that follows the needle shows the piece in hand'({space}) {
    const {page, close} = await open(space, {viewport: PHONE, hasTouch: true, isMobile: true}), passes = passesOf(space.plan), names = namesOf(space);
    await page.locator('#follow').evaluate((box) => box.click());
    for (let i = 1; i < passes.length; i += Math.floor(passes.length / 9)) {
      await setSlider(page, i);
      const {lime} = await look(page, LIME), at = await middleOf(page, space.plan, passes[i - 1].piece);
      const canvas = await page.locator('#canvas').boundingBox();
      if (longestArm(space.plan, passes[i - 1].piece) < 0.02) { // so small a piece lies behind the needle: its name says where
        assert.ok((await text(page, '#tags')).includes(names[passes[i - 1].piece]), `step ${i}: no name`);
      } else assert.ok(lime > 500, `step ${i}: ${lime} pixels`);
      assert.ok(Math.abs(at.x - canvas.x - canvas.width / 2) < 0.4 * canvas.width, `step ${i}: at ${at.x}`);
    }
    await close();
  },

  async 'tension has its colours and a scale'({evaluated}) {
    const {page, close} = await open(evaluated), {plan} = evaluated, passes = passesOf(plan);
    await page.getByLabel('tension', {exact: true}).check();
    for (const i of [1, Math.floor(passes.length / 2), passes.length]) {
      const {c, k} = passes[i - 1];
      await setSlider(page, i);
      const chip = await page.locator('#now .chip').evaluate((node) => getComputedStyle(node).backgroundColor);
      assert.deepEqual(chip.match(/\d+/g).map(Number), rgb(plan.evaluation.cords[c].colours[k]));
    }
    const ticks = await page.locator('#scale .tick').allInnerTexts(), values = ticks.map((tick) => parseFloat(tick));
    assert.ok(ticks.length >= 2 && ticks.every((tick) => tick.endsWith(' N')), ticks.join());
    assert.ok(values.every((v, i) => i === 0 || v > values[i - 1]), ticks.join());
    await close();
  },

  async 'ticks of the scale keep clear of each other'({evaluated, steep}) {
    for (const one of [evaluated, steep]) {
      const {page, close} = await open(one);
      await page.getByLabel('tension', {exact: true}).check();
      const shown = page.locator('#scale .tick:visible');
      const boxes = await shown.evaluateAll((all) => all.map((node) => node.getBoundingClientRect().toJSON()));
      assert.ok(boxes.length >= 2, `${boxes.length} ticks`);
      assert.ok(boxes.every(({left}, i) => i === 0 || left > boxes[i - 1].right));
      await close();
    }
  },

  async 'names are text'({hostile}) {
    const {page, complaints, close} = await open(hostile);
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.evaluate(() => window.hacked), undefined);
    assert.deepEqual(complaints, []);
    assert.ok((await text(page, '#words')).includes('</script><script>window.hacked=1'));
    await close();
  },

  async 'a large framework is small and quick'({large}) {
    assert.ok(fs.statSync(file('large.html')).size < 3e6);
    const {page, close} = await open(large), passes = passesOf(large.plan);
    const took = await page.evaluate(() => {
      const begun = performance.now();
      for (let i = 0; i < 20; i++) document.getElementById('on').click();
      return (performance.now() - begun) / 20;
    });
    assert.ok(took < 100, `${took.toFixed(1)} ms for a step`);
    assert.equal((await state(page)).piece, passes[19].piece);
    await close();
  },

  async 'step sheets for browsers print as the PDF does: as many pages of as much paper, the same words'({several, space}) {
    for (const [{name}, paper] of [[several, 'a4'], [space, 'letter']]) {
      for (const type of ['pdf', 'sheets.html'])
        thread('draw', file(`${name}.json`), '-T', type, '--page', paper, '-o', file(`${name}-sheets.${type.slice(-4).replace('.', '')}`));
      const page = await browser.newPage();
      await page.goto(pathToFileURL(file(`${name}-sheets.html`)).href);
      await page.pdf({path: file(`${name}-printed.pdf`), preferCSSPageSize: true, printBackground: true});
      const ids = await page.evaluate(() => [...document.querySelectorAll('[id]')].map((node) => node.id));
      assert.equal(new Set(ids).size, ids.length, 'a name stands for one thing');
      await page.close();
      const [made, printed] = [`${name}-sheets.pdf`, `${name}-printed.pdf`].map((one) => {
        const words = execFileSync('pdftotext', ['-layout', file(one), '-'], {encoding: 'utf8'});
        const [, wide, high] = /Page size:\s*([\d.]+) x ([\d.]+)/.exec(execFileSync('pdfinfo', [file(one)], {encoding: 'utf8'}));
        return {pages: words.split('\f').map((one) => one.split(/\s+/).sort()), size: [Number(wide), Number(high)]};
      });
      assert.deepEqual(printed.pages, made.pages);
      for (const side of [0, 1]) assert.ok(Math.abs(printed.size[side] - made.size[side]) < 1, `${printed.size} and ${made.size}`);
    }
  },
};

// ---- running ----

function plans() {
  const data = path.join(__dirname, '../../data'), evil = '</script><script>window.hacked=1</script>\u2028';
  fs.writeFileSync(file('hostile-frame.json'), JSON.stringify({
    nodes: [[0, 0, 0], [1, 0.2, 0], [1.7, 1, 0.5], [0, 1, 1.1]],
    edges: [[0, 1], [1, 2], [2, 3], [3, 0]],
    names: [0, 1, 2, 3].map((i) => evil + i),
  }));
  thread('make', 'dome', '--size', '6', '-o', file('d6.json'));
  const dome = make('dome', path.join(data, 'dome7.json'), '--objective', 'length');
  thread('eval', file('dome.json'), '-o', file('evaluated.json'));
  const large = make('large', path.join(data, 'jax_fdm/liew_dome.json'), '--objective', 'length');
  thread('eval', file('large.json'), '-o', file('steep.json')); // one cord through 1,800 beads: many powers of ten
  return {
    dome,
    large,
    steep: draw('steep'),
    several: make('several', path.join(data, 'dome7.json'), '--objective', 'length', '--cords', '3', '--ends', 'any'),
    symmetric: make('symmetric', file('d6.json'), '--objective', 'symmetry'),
    evaluated: draw('evaluated'),
    tubes: asTubes('several'),
    space: make('space', path.join(data, 'assembly-instances/voronoi_S1_03-14-2019_w_layer.json'), '--cords', '1'),
    hostile: make('hostile', file('hostile-frame.json'), '--objective', 'length', '--ends', 'closed'),
  };
}

async function main() {
  let passed = 0, failed = 0;
  const all = plans();
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  reader = await browser.newPage();
  for (const [name, test] of Object.entries(tests)) {
    const begun = Date.now();
    try {
      await test(all);
      passed++;
      console.log(`ok    ${name} (${Date.now() - begun} ms)`);
    } catch (error) {
      failed++;
      console.log(`FAIL  ${name}\n${String(error.stack).replace(/^/gm, '      ')}`);
    }
  }
  await browser.close();
  console.log(`${passed} passed, ${failed} failed`);
  process.exitCode = failed ? 1 : 0;
}

main().catch((error) => {
  console.log(`${error.stack}\n0 passed, 1 failed`);
  process.exit(1);
});
