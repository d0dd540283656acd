// thread.html in headless Chromium, walked by what a person sees: labels and buttons. page.cjs PACKAGES PROGRAM PAGE SCRATCH: the
// folder with playwright-core, the installed program, thread.html, an empty folder, where pictures stay to be looked at. ONLY=words in
// the environment runs the tests with these words in their name. Closes with "N passed, N failed".
'use strict';
const {execFileSync, spawnSync} = require('node:child_process');
const {createRequire} = require('node:module');
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const {pathToFileURL} = require('node:url');
const {gunzipSync} = require('node:zlib');

const [packages, program, html, scratch] = process.argv.slice(2).map((name) => path.resolve(name));
const {chromium} = createRequire(path.join(packages, 'package.json'))('playwright-core');
const DATA = path.join(__dirname, '../../data');
const file = (name) => path.join(scratch, name);
const thread = (...words) => execFileSync(program, words, {encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
let browser;

async function open({viewport = {width: 1100, height: 900}, hash = '', context = null, ...more} = {}) {
  const own = context || (await browser.newContext({viewport, acceptDownloads: true, ...more}));
  const page = await own.newPage(), strangers = [], complaints = [];
  page.on('request', (request) => /^(https?|wss?):/.test(request.url()) && strangers.push(request.url()));
  page.on('pageerror', (error) => complaints.push(error.message));
  await page.goto(pathToFileURL(html).href + hash);
  await page.waitForSelector('html[data-ready]');
  const close = async () => {
    assert.deepEqual([strangers, complaints], [[], []], 'nothing leaves the page, nothing fails in it');
    await own.close();
  };
  return {page, own, close};
}

// A part of the page by its heading, without the number.
const part = (page, heading) => page.getByRole('region', {name: new RegExp(`${heading}$`)});
const result = (page) => part(page, 'Your plan').innerText();
const drawn = (page, timeout = 60000) => page.getByRole('list', {name: 'Files, one by one'}).getByRole('listitem').first().waitFor({timeout});

async function until(holds, what) {
  for (let tries = 0; tries < 600; tries++) {
    if (await holds()) return;
    await new Promise((wake) => setTimeout(wake, 100));
  }
  assert.fail(`never: ${what}`);
}

// What a screen reader says of its own: the words of every status and alert as they come.
async function listen(page) {
  await page.evaluate(() => {
    globalThis.heardWords = [];
    for (const node of document.querySelectorAll('[role=status], [role=alert]'))
      new MutationObserver(() => node.textContent && heardWords.push(node.textContent)).observe(node, {childList: true, characterData: true, subtree: true});
  });
  return () => page.evaluate(() => heardWords.join('\n'));
}

// How wide what is drawn on a canvas is, as a part of its width.
const inked = (picture) => picture.evaluate((canvas) => {
  const {width, height} = canvas, {data} = canvas.getContext('2d').getImageData(0, 0, width, height);
  const columns = [...Array(width).keys()].filter((x) => [...Array(height).keys()].some((y) => data[4 * (y * width + x) + 3] > 0));
  return (columns.at(-1) - columns[0] + 1) / width;
});

// Two fingers in the middle of a picture go apart until they are so many times as far.
async function pinch(own, page, picture, times) {
  await picture.scrollIntoViewIfNeeded();
  const box = await picture.boundingBox(), x = box.x + box.width / 2, y = box.y + box.height / 2, from = 0.1 * box.width;
  const session = await own.newCDPSession(page);
  const fingers = (far) => [{x: x - far, y, id: 0}, {x: x + far, y, id: 1}];
  await session.send('Input.dispatchTouchEvent', {type: 'touchStart', touchPoints: fingers(from)});
  for (let step = 1; step <= 8; step++)
    await session.send('Input.dispatchTouchEvent', {type: 'touchMove', touchPoints: fingers(from * (1 + ((times - 1) * step) / 8))});
  await session.send('Input.dispatchTouchEvent', {type: 'touchEnd', touchPoints: []});
}

// Tab until what has the focus is called so.
async function tabTo(page, name) {
  for (let tries = 0; tries < 200; tries++) {
    const called = await page.evaluate(() => {
      const at = document.activeElement;
      return at.getAttribute('aria-label') || (at.labels?.length ? at.labels[0].innerText : at.innerText) || '';
    });
    if (called.trim() === name) return;
    await page.keyboard.press('Tab');
  }
  assert.fail(`no Tab comes to ${name}`);
}

const choose = (page, name) => page.getByLabel('Choose a file').setInputFiles(name);
const shown = (page) => part(page, 'Your framework').getByText(/ pieces? that meet at \d+ interfaces?/).innerText();
const trouble = (page) => page.getByRole('alert').innerText();

async function takeExample(page, words) {
  await page.getByLabel('or take an example').selectOption(words);
  await page.getByRole('button', {name: 'Take it'}).click();
  await page.waitForSelector('#shown:not([hidden])', {timeout: 60000});
}

async function made(page) {
  await page.getByRole('button', {name: 'Thread it'}).click();
  await drawn(page, 120000);
}

async function download(page, name) {
  const [got] = await Promise.all([page.waitForEvent('download'), page.getByText(name, {exact: true}).click()]);
  await got.saveAs(file(name));
  return file(name);
}

const tests = {
  async 'from an OBJ to a printed booklet: feet, advice, plan, pages, a zip'() {
    thread('make', 'dome', '--size', '5', '-o', file('dome.obj'));
    const {page, own, close} = await open();
    await choose(page, file('dome.obj'));
    assert.match(await shown(page), /25 pieces that meet at 40 interfaces, [\d.]+ mm wide/);
    for (const [button, n] of [['the whole rim', 16], ['the lowest ones', 4]]) {
      await page.getByRole('button', {name: button}).click();
      await until(async () => (await page.getByLabel('Feet, where cord may come out').inputValue()).split(',').length === n, `${n} feet`);
    }
    await page.getByRole('button', {name: /^Take \d+ cords?.*recommended/}).click({timeout: 60000});
    await page.getByText(/^To print at this width: 25 pieces, the largest about \d+ mm long; \d+ cm³, \d+ g of plastic/).waitFor({timeout: 120000});
    await page.screenshot({path: file('questions.png'), fullPage: true});
    await made(page);
    assert.match(await result(page), /Every claim of this plan was verified/);
    await part(page, 'Your plan').getByText(/^The booklet has /).waitFor({timeout: 60000});
    assert.match(await result(page), /\d cords?, [^]*m; pull [\d.]+ N at both ends[^]*[\d.]+ m of cord, [\d.]+ mm thick: \d cords of[^]*25 pieces from a 3D printer, the largest about \d+ mm long: \d+ cm³, \d+ g of plastic[^]*Print 25 pieces[^]*The booklet has \d+ pages/);
    await part(page, 'Your plan').screenshot({path: file('result.png')});
    const plan = await download(page, 'plan.json');
    assert.match(thread('check', plan), /: holds: /, 'the installed program agrees');
    const [booklet] = await Promise.all([own.waitForEvent('page'), page.getByRole('button', {name: 'Open the booklet to print'}).click()]);
    await booklet.locator('.page').first().waitFor();
    const [, at] = /the first step, on page (\d+)\.$/m.exec(await result(page));
    assert.match(await booklet.locator('.page').nth(at - 1).innerText(), /: passes 1-/);
    await booklet.pdf({path: file('booklet.pdf'), preferCSSPageSize: true, printBackground: true});
    thread('draw', plan, '-T', 'pdf', '-o', file('sheets.pdf'));
    const words = ['booklet.pdf', 'sheets.pdf'].map((name) => execFileSync('pdftotext', ['-layout', file(name), '-'], {encoding: 'utf8'}).split(/\s+/).sort());
    assert.deepEqual(words[0], words[1]);
    await booklet.close();
    await page.getByRole('button', {name: 'Pack a zip, then save it'}).click();
    const sizes = {};
    for (const [title, name] of [[/^Save booklet, cords and pieces alone: [\d.]+ [kM]B$/, 'needed.zip'], [/^Save all: [\d.]+ [kM]B$/, 'all.zip']]) {
      const button = page.getByRole('button', {name: title});
      await button.waitFor({timeout: 60000});
      const [zip] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), button.click()]), [, n, unit] = /([\d.]+) (.)B$/.exec(await button.innerText());
      await zip.saveAs(file(name));
      sizes[name] = fs.statSync(file(name)).size;
      assert.ok(Math.abs(Number(n) * (unit === 'M' ? 1e6 : 1e3) - sizes[name]) <= (unit === 'M' ? 5e4 : 1e3), `${n} ${unit}B of ${sizes[name]} bytes`);
    }
    assert.ok(sizes['needed.zip'] < sizes['all.zip']);
    assert.ok(sizes['all.zip'] < 0.6 * Number(execFileSync('python3', ['-c', 'import sys, zipfile; print(sum(i.file_size for i in zipfile.ZipFile(sys.argv[1]).infolist()))', file('all.zip')])), 'deflated');
    const listed = execFileSync('python3', ['-c', 'import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); assert z.testzip() is None; print(*z.namelist())', file('all.zip')], {encoding: 'utf8'});
    assert.match(listed, /^README\.txt plan\.json booklet\.html mat\.html overview\.svg steps\.txt /);
    const readme = execFileSync('python3', ['-c', 'import sys, zipfile; sys.stdout.write(zipfile.ZipFile(sys.argv[1]).read("README.txt").decode())', file('all.zip')], {encoding: 'utf8'});
    assert.deepEqual(readme.match(/^\S+(?= {2,}\S)/gm), listed.trim().split(' ').slice(1), 'a line for each');
    for (const words of await page.getByRole('list', {name: 'Files, one by one'}).getByRole('listitem').allInnerTexts())
      assert.ok(readme.replace(/\s/g, '').includes(words.replace(/\s/g, '')), `${words} is not in it`);
    const [mat] = await Promise.all([own.waitForEvent('page'), page.getByRole('button', {name: 'Open the mat'}).click()]);
    await mat.getByText('is 100 mm').first().waitFor();
    await mat.close();
    await close();
  },

  async 'a plan is dropped in again, survives a reload, and Undo goes back'() {
    thread('plan', path.join(DATA, 'dome7.json'), '--cords', '2', '--ends', 'feet', '-o', file('two.json'));
    const {page, close} = await open();
    await choose(page, file('two.json'));
    await drawn(page, 120000);
    assert.match(await result(page), /2 cords/);
    await page.reload();
    await drawn(page, 120000);
    assert.match(await shown(page), /^two: 49 pieces/);
    await page.getByLabel('How many cords?').selectOption('4');
    await page.getByRole('button', {name: 'Undo'}).click();
    assert.equal(await page.getByLabel('How many cords?').inputValue(), '');
    await close();
  },

  async 'its pieces to print: the same files as by the command, what does not fit, what is stopped'() {
    thread('make', 'dome', '--size', '3', '-o', file('three.json'));
    thread('plan', file('three.json'), '--cords', '1', '-q', '-o', file('three-plan.json'));
    const {page, close} = await open({viewport: {width: 1280, height: 800}}), heard = await listen(page);
    await choose(page, file('three-plan.json'));
    await drawn(page);
    const pieces = part(page, 'Its pieces, to print'), listed = pieces.getByRole('list', {name: 'Files to print, one by one'});
    const make = () => pieces.getByRole('button', {name: 'Make the pieces to print'}).click();

    // What the command says, in words that the page has.
    await page.getByLabel('What is engraved?').selectOption('none');
    await page.getByLabel('How wide are the arms, in mm?').fill('2');
    await make();
    await page.getByRole('alert').filter({hasText: 'needs arms'}).waitFor();
    assert.match(await trouble(page), /^A1-A2: 1 channel of [\d.]+ mm with walls of [\d.]+ mm needs arms [\d.]+ mm wide, not 2: width [\d.]+ or more$/);
    await page.getByLabel('How wide are the arms, in mm?').fill('');
    await page.getByLabel("How large is the printer's bed, in mm?").fill('20 x 20');
    await make();
    await page.getByRole('alert').filter({hasText: 'more than the bed'}).waitFor({timeout: 120000});
    assert.match(await trouble(page), /^piece B2 .* takes at least \d+ x \d+ mm however it is laid, more than the bed of 20 x 20 mm less 5 mm around: bed \d+x\d+ would do, or a smaller framework/);
    await page.getByLabel("How large is the printer's bed, in mm?").fill('mine');
    await make();
    await page.getByRole('alert').filter({hasText: 'bed mine'}).waitFor();
    assert.equal(await trouble(page), 'bed mine: expected width x depth in mm, 20 to 10000, as 220x220');

    // With answers to all questions, by keyboard: byte for byte what the command makes of the same plan.
    for (const [question, keys] of [['How wide are the arms, in mm?', '9'], ["How large is the printer's bed, in mm?", '180 x 180'], ['Shall faces centre each other?', 'by c']]) {
      await tabTo(page, question);
      await page.keyboard.type(keys);
    }
    await tabTo(page, 'Make the pieces to print');
    await page.keyboard.press('Enter');
    await listed.getByRole('listitem').first().waitFor({timeout: 120000});
    const own = file('kit');
    const said = spawnSync(program, ['kit', file('three-plan.json'), '--width', '9', '--bed', '180x180', '--names', 'none', '--key', 'cone', '--stl', '-o', own], {encoding: 'utf8'}).stderr;
    assert.deepEqual((await listed.getByRole('link').allInnerTexts()).sort(), ['README.txt', 'kit.3mf', 'kit.csv', 'kit.html', 'kit.png', 'stl.zip']);
    assert.ok((await pieces.innerText()).includes(said.split('\n')[0].replace('thread: ', '')), 'what the command says');
    for (const name of ['README.txt', 'kit.3mf', 'kit.csv', 'kit.html', 'kit.png'])
      assert.ok(fs.readFileSync(await download(page, name)).equals(fs.readFileSync(path.join(own, name))), `${name} differs`);
    const parts = execFileSync('python3', ['-c', 'import os, sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); print(all(z.read(n) == open(os.path.join(sys.argv[2], n), "rb").read() for n in z.namelist()), *sorted(z.namelist()))',
      await download(page, 'stl.zip'), own], {encoding: 'utf8'});
    assert.equal(parts.trim(), ['True', ...fs.readdirSync(own).filter((name) => name.endsWith('.stl')).sort()].join(' '));
    const picture = pieces.getByRole('img', {name: /^The pieces in their places/});
    await until(() => picture.evaluate((image) => image.complete && image.naturalWidth > 500), 'a picture of the pieces');
    await page.screenshot({path: file('kit-1280x800.png')});
    await page.setViewportSize({width: 390, height: 844});
    await pieces.screenshot({path: file('kit-390x844.png')});
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, 'wider than a telephone');
    assert.match(await heard(), /Making the pieces[^]*9 pieces, /);
    await until(() => page.frameLocator('#viewer').locator('canvas').count(), 'the viewer with the pieces');

    // Stopped on the way: what was made before is gone, too.
    await page.getByLabel('How wide are the arms, in mm?').fill('4');
    await make();
    await part(page, 'Making the pieces').getByText(/ \d+ %$/).waitFor({timeout: 60000});
    await page.getByRole('button', {name: 'Stop', exact: true}).click();
    await page.getByRole('alert').filter({hasText: 'Stopped: no pieces were made.'}).waitFor();
    assert.equal(await listed.getByRole('listitem').count(), 0);
    await close();
  },

  async 'walls that are too thin to print: said before they are made, with arms or a size that mend it'() {
    thread('make', 'geodesic', '--size', '2', '-o', file('geo.json'));
    fs.writeFileSync(file('small.obj'), 'v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 2 1\nl 1 2 3 4 1\nl 1 5 3\nl 2 5 4\n');
    thread('plan', file('geo.json'), '-q', '-o', file('geo-plan.json'));
    const {page, close} = await open(), pieces = part(page, 'Its pieces, to print'), arms = page.getByLabel('How wide are the arms, in mm?');
    await choose(page, file('geo-plan.json'));
    await drawn(page);
    await pieces.getByText(/^The thinnest wall is 0\.\d+ mm, too thin to print/).waitFor({timeout: 120000});
    await page.getByRole('button', {name: 'Go to the film'}).click();
    await until(() => page.evaluate(() => document.activeElement.id === 'rise-title'), 'what comes first');
    assert.ok(await page.evaluate(() => $('rise-part').getBoundingClientRect().top < $('kit-part').getBoundingClientRect().top), 'the film before the pieces');
    const listed = pieces.getByRole('list', {name: 'Files to print, one by one'}), wider = pieces.getByRole('button', {name: /^Make the arms [\d.]+ mm wide$/});
    await part(page, 'Watch it rise').getByRole('button', {name: /^Let arms [\d.]+ mm wide rise$/}).waitFor({timeout: 120000});
    await wider.click({timeout: 120000});
    await listed.getByRole('listitem').first().waitFor({timeout: 120000}); // made at once
    await until(() => pieces.locator('#thin').isHidden(), 'thick enough');
    const said = await arms.inputValue();
    await arms.fill(String(Number(said) + 1));
    await page.keyboard.press('Tab');
    await until(async () => (await listed.getByRole('listitem').count()) === 0, 'files of other arms are gone');
    await arms.fill(said);
    const {thinnest_mm: wall} = JSON.parse(thread('kit', file('geo-plan.json'), '--names', 'none', '--no-picture', '--json', '-q', '--width', await arms.inputValue(), '-o', file('geo-kit')));
    assert.ok(wall >= 0.8, `${wall} mm`);
    await choose(page, file('small.obj'));
    await part(page, 'Your framework').getByText(/^small: /).waitFor();
    await made(page);
    await pieces.getByRole('button', {name: /^Build the whole [\d.]+ mm wide, not 4 mm$/}).click({timeout: 120000});
    await until(() => page.evaluate(() => widthOf(frame) > 8), 'a larger whole');
    await made(page);
    await close();
  },

  async 'how it rises: the same course as by the command, played; what jams, what does not rise, what is stopped'() {
    fs.writeFileSync(file('ring.obj'), 'v 0 0 0\nv 40 0 0\nv 20 35 0\nl 1 2 3 1\n');
    fs.writeFileSync(file('arch.obj'), 'v 0 0 0\nv 40 0 50\nv 80 0 0\nl 1 2 3\n');
    thread('make', 'dome', '--size', '3', '-o', file('dome3.obj'));
    for (const name of ['ring', 'arch', 'dome3']) thread('plan', file(`${name}.obj`), '--ends', 'any', '--units', 'mm', '-q', '-o', file(`${name}.json`));
    const {page, close} = await open({viewport: {width: 1280, height: 800}}), heard = await listen(page);
    const film = part(page, 'Watch it rise'), listed = film.getByRole('list', {name: 'Files of the rise, one by one'});
    const watch = () => film.getByRole('button', {name: 'Watch it rise'}).click();
    const pull = page.getByLabel('How hard does a hand pull each end, in newtons, at most?'), lifted = page.getByLabel('Which piece does another hand lift to its height?');
    await choose(page, file('ring.json'));
    await drawn(page);

    // What the command says, in words that the page has; by keyboard: the files that the command writes.
    await lifted.fill('Z9');
    await watch();
    await page.getByRole('alert').filter({hasText: 'no such piece'}).waitFor({timeout: 120000});
    assert.equal(await trouble(page), 'Z9: the plan has no such piece');
    await lifted.fill('');
    await tabTo(page, 'How hard does a hand pull each end, in newtons, at most?');
    await page.keyboard.type('1');
    await tabTo(page, 'Watch it rise');
    await page.keyboard.press('Enter');
    await listed.getByRole('listitem').first().waitFor({timeout: 120000});
    const own = (name) => path.join(file('rise'), name);
    fs.mkdirSync(file('rise'));
    fs.copyFileSync(file('ring.json'), own('plan.json')); // the plot names the plan
    const written = ['--play', 'rise.html', '--film', 'rise.png', '--plot', 'rise.svg', '--booklet', 'booklet.html', '-o', 'rise.json'];
    const said = execFileSync(program, ['rise', 'plan.json', '--pull', '1', ...written], {cwd: file('rise'), encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
    assert.deepEqual((await listed.getByRole('link').allInnerTexts()).sort(), ['rise.html', 'rise.json', 'rise.png', 'rise.svg']);
    // Contacts make much of the last digit of a sine: the same shape at last, two steps of the pull (15 % each) earlier or later at most.
    const plain = (text) => text.replace(/\d+(\.\d+)?/g, '#');
    assert.doesNotMatch(await film.innerText(), /closed form|limit analysis|one a pass|node| Or /);
    assert.match(plain(await film.innerText()), new RegExp(plain(said.split('\n')[1]), 'i'), 'what the command says');
    const [here, there] = [await download(page, 'rise.json'), own('rise.json')].map((name) => JSON.parse(fs.readFileSync(name, 'utf8')).runs[0]);
    assert.equal(here.came_up, there.came_up);
    assert.ok(Math.abs(Math.log(here.pull_up / there.pull_up)) < 2.1 * Math.log(1.15), `pulled with ${here.pull_up} and ${there.pull_up}`);
    assert.ok(Math.abs(here.frames.length - there.frames.length) <= 2, `${here.frames.length} and ${there.frames.length} frames`);
    assert.equal(here.most_closed, there.most_closed);
    assert.ok(Math.abs(here.off - there.off) < 0.05, `off by ${here.off} and ${there.off}`);
    here.frames.at(-1).forEach((x, k) => assert.ok(Math.abs(x - there.frames.at(-1)[k]) < 1, `at last: ${x} and ${there.frames.at(-1)[k]}`));
    for (const name of ['rise.html', 'rise.png', 'rise.svg']) {
      const [mine, its] = [await download(page, name), own(name)].map((file) => fs.statSync(file).size);
      assert.ok(Math.abs(mine / its - 1) < 0.2, `${name} has ${mine} and ${its} bytes`);
    }
    const stills = (name) => fs.readFileSync(name, 'utf8').split('How it comes up')[1].split('Knots')[0]; // steps before may be drawn in another order
    const [drawnHere, drawnThere] = [await download(page, 'booklet.html'), own('booklet.html')].map((name) => stills(name).length);
    assert.ok(drawnHere > 1000 && Math.abs(drawnHere / drawnThere - 1) < 0.2, `stills of ${drawnHere} and ${drawnThere} bytes`);
    assert.match(await heard(), /Pulling the cords[^]*[Cc]omes up at /);
    const [risen] = await Promise.all([page.context().waitForEvent('page'), page.getByRole('button', {name: 'Open the booklet to print'}).click()]);
    await risen.getByText('How it comes up').first().waitFor();
    await risen.close();

    assert.match(await result(page), /a hand that pulls [^]*raised the pieces in the film/);

    // Other arms for the pieces: the film says which it shows, and offers theirs.
    assert.match(await film.innerText(), /Arms [\d.]+ mm wide, as for the pieces in part 5\.[^]*With arms [\d.]+ mm wide\./);
    await page.getByLabel('How wide are the arms, in mm?').fill('9');
    await page.getByLabel('How wide are the arms, in mm?').press('Tab');
    await film.getByText(/^The film shows arms [\d.]+ mm wide, those of the pieces in part 5 are 9 mm wide\.$/).waitFor();
    await film.getByRole('button', {name: 'Watch it with arms 9 mm wide'}).click();
    await film.getByText(/^With arms 9 mm wide\. /).waitFor({timeout: 120000});
    assert.equal(await film.getByRole('button', {name: 'Watch it with arms'}).count(), 0);

    // The player: it plays, and stops at the end; wide enough on a telephone.
    const player = page.frameLocator('iframe[title="The pieces as they rise"]');
    await until(async () => Number(await player.locator('#slider').inputValue()) > 0, 'it plays by itself');
    await page.screenshot({path: file('rise-1280x800.png')});
    await page.setViewportSize({width: 390, height: 844});
    await film.screenshot({path: file('rise-390x844.png')});
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, 'wider than a telephone');

    // An arch falls over; with a hand at its middle it comes up. Stopped on the way nothing is left.
    await choose(page, file('arch.json'));
    await part(page, 'Your framework').getByText(/^arch: /).waitFor();
    await drawn(page);
    assert.equal(await listed.getByRole('listitem').count(), 0);
    await pull.fill('2');
    await watch();
    await film.getByText(/Does not come up[^]*The widest gap stays between/).waitFor({timeout: 120000});
    await film.getByText(/^It does not come up like this/).waitFor();
    await film.getByRole('button', {name: 'Lift 2, the highest piece, by hand'}).click();
    await film.getByText(/Comes up at /).waitFor({timeout: 120000});
    assert.equal(await lifted.inputValue(), '2');
    assert.equal(await film.getByRole('button', {name: 'Try with'}).count(), 0);
    const tries = ['try more cords, each of which turns less (thread plan --cords 8)', 'or  lighter pieces (thread convert --scale)', 'or  more pull than that (--pull 150)'];
    const helps = await page.evaluate((lines) => helpsRise(lines).map(([title]) => title), tries);
    assert.equal(helps[0], 'Try with 8 cords', 'what the program says comes first');
    assert.deepEqual(helps.filter((words) => /newtons/.test(words)), ['Pull with up to 100 newtons'], 'not more than two hands can');
    await choose(page, file('dome3.json'));
    await part(page, 'Your framework').getByText(/^dome3: /).waitFor();
    await drawn(page);
    await page.getByLabel('How do the pieces begin?').selectOption('heap');
    await pull.fill('');
    await lifted.fill('');
    await watch();
    await part(page, 'Pulling the cords').getByText(/ faces closed(, now pulled to see whether they stay closed)? \.\. \d+ %$/).waitFor({timeout: 60000});
    assert.equal(await page.locator('#kit-part').evaluate((pieces) => getComputedStyle(pieces).opacity), '0.4', 'what waits looks so');
    await page.getByRole('button', {name: 'Stop', exact: true}).click();
    await page.getByRole('alert').filter({hasText: 'Stopped: nothing was seen.'}).waitFor();
    await film.getByText(/^Here comes a film: /).waitFor();
    assert.equal(await listed.getByRole('listitem').count(), 0);
    await close();
  },

  async 'bad files get the line of the command line'() {
    const bad = {
      'bad.obj': 'v 0 0 0\nv 1 0\nl 1 2\n', 'cut.json': '{"nodes": [[0, 0, 0], [1, 0', 'empty.csv': '', 'picture.svg': '<svg xmlns="http://www.w3.org/2000/svg"/>',
      'part.step': 'ISO-10303-21;\nHEADER;\n', 'short.stl': 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n',
    };
    const {page, close} = await open();
    for (const [name, words] of Object.entries(bad)) {
      fs.writeFileSync(file(name), words);
      const said = spawnSync(program, ['convert', file(name), '-T', 'json', '-o', file('none.json')], {encoding: 'utf8'}).stderr;
      const line = said.trim().replace(/^thread: /, '').replaceAll(file(name), name);
      await choose(page, file(name));
      await page.getByRole('alert').filter({hasText: line}).waitFor();
      assert.equal(await trouble(page), line);
    }
    await close();
  },

  async 'files of other programs show as many pieces as on the command line'() {
    const formats = path.join(__dirname, '../formats');
    const names = ['blender-dome.obj', 'blender-dome.ply', 'blender-dome.stl', 'blender-both.glb', 'blender-both.gltf', 'ezdxf-rings-r2010.dxf', 'networkx.graphml',
      'networkx-node-link.json', '../fuzz/corpus/vef/cube.vef'].map((name) => path.join(formats, name));
    names.push(file('dome.csv'));
    thread('convert', path.join(DATA, 'dome7.json'), '-q', '-o', file('dome.csv'));
    const {page, close} = await open();
    for (const [i, name] of names.entries()) {
      const {nodes, edges} = JSON.parse(thread('info', name, '--json', '-q')), own = file(`read-${i}${path.extname(name)}`);
      fs.copyFileSync(name, own);
      await choose(page, own);
      await part(page, 'Your framework').getByText(new RegExp(`^read-${i}: `)).waitFor();
      const counts = / (\d+) pieces? that meet at (\d+) interfaces?/.exec(await shown(page)).slice(1).map(Number);
      assert.equal(await page.locator('#width').inputValue(), '', 'arms of the shape before');
      await page.locator('#width').evaluate((arms) => { arms.value = '3'; });
      assert.deepEqual([path.basename(name), ...counts], [path.basename(name), nodes, edges]);
    }
    await close();
  },

  async 'a 3dm file: lines, polylines, meshes, arcs; its units; what is none'() {
    const makeRhino = require(path.join(path.dirname(html), 'thread-3dm.js'));
    const rhino = await makeRhino({wasmBinary: gunzipSync(Buffer.from(globalThis.RHINO3DM_WASM, 'base64'))}), {File3dm} = rhino;
    const doc = new File3dm(), objects = doc.objects(), chain = new rhino.Polyline(3), mesh = new rhino.Mesh();
    objects.addLine([0, 0, 0], [1, 0, 0]);
    for (const p of [[0, 0, 0], [0, 1, 0], [1, 1, 0]]) chain.add(...p);
    objects.add(new rhino.PolylineCurve(chain), null);
    for (const p of [[1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]) mesh.vertices().add(...p);
    mesh.faces().addQuadFace(0, 1, 2, 3);
    objects.add(mesh, null);
    objects.add(rhino.NurbsCurve.create(false, 2, [[0, 1, 0], [1, 3, 0], [2, 1, 0]]), null);
    doc.settings().modelUnitSystem = rhino.UnitSystem.Meters;
    fs.writeFileSync(file('model.3dm'), doc.toByteArray());
    const {page, close} = await open();
    await choose(page, file('model.3dm'));
    assert.match(await shown(page), /^model: 6 pieces that meet at 8 interfaces/);
    const [units, arc] = await page.evaluate(() => [frame.units, Math.max(...frame.lengths)]);
    assert.equal(units, 'm');
    const exact = Math.sqrt(5) + Math.asinh(2) / 2; // of the parabola y = 1 + 2 x - x^2 from 0 to 2
    assert.ok(Math.abs(arc / exact - 1) < 1e-5, `${arc} is not ${exact}`);
    fs.writeFileSync(file('none.3dm'), '3D Geometry File Format        4 and no more');
    await choose(page, file('none.3dm'));
    await page.getByRole('alert').waitFor();
    assert.match(await trouble(page), /^none\.3dm: not a 3dm file that rhino3dm can read/);
    await close();
  },

  async 'a file is dropped on the page, pieces are clicked to be feet and not to be'() {
    thread('make', 'dome', '--size', '5', '-o', file('dome5.json'));
    const {page, close} = await open();
    const given = await page.evaluateHandle((words) => {
      const data = new DataTransfer();
      data.items.add(new File([words], 'dropped.json'));
      return data;
    }, fs.readFileSync(file('dome5.json'), 'utf8'));
    await page.dispatchEvent('body', 'drop', {dataTransfer: given});
    assert.match(await shown(page), /^dropped: 25 pieces that meet at 40 interfaces/);
    const feet = page.getByLabel('Feet, where cord may come out'), picture = page.getByRole('img', {name: /^The framework/});
    assert.equal(await feet.inputValue(), 'A1, A5, E1, E5');
    for (const [piece, then] of [['C1', 'A1, A5, C1, E1, E5'], ['A1', 'A5, C1, E1, E5']]) {
      const [x, y] = await page.evaluate((wanted) => sketch.place(frame.nodes[frame.names.indexOf(wanted)]), piece);
      await picture.click({position: {x, y}});
      assert.equal((await feet.inputValue()).split(', ').sort().join(', '), then);
    }
    await page.getByRole('button', {name: 'Undo'}).click();
    assert.match(await feet.inputValue(), /A1/);
    for (const [names, words] of [['A1', 'one foot'], ['A1 A5', 'two feet'], ['A1 B2 E5', 'feet in one line'], ['A1 A5 C1', '']]) {
      await feet.fill(names);
      await page.keyboard.press('Tab');
      await until(async () => (await page.locator('#feet-said').textContent()).startsWith(words && `A thing on ${words} falls over`), words);
    }
    assert.ok(await page.locator('#feet-said').isHidden());
    await close();
  },

  async 'two tabs do not write over each other'() {
    const first = await open();
    await choose(first.page, path.join(DATA, 'dome7.json'));
    assert.match(await shown(first.page), /^dome7: 49 pieces/);
    const second = await open({context: first.own});
    assert.match(await shown(second.page), /^dome7: 49 pieces/, 'a new tab begins with what was last kept');
    await choose(second.page, path.join(DATA, 'jax_fdm/barrel.obj'));
    await part(second.page, 'Your framework').getByText(/^barrel: 441 pieces/).waitFor();
    await first.page.reload();
    await first.page.waitForSelector('html[data-ready]');
    assert.match(await shown(first.page), /^dome7: 49 pieces/);
    await second.page.reload();
    await second.page.waitForSelector('html[data-ready]');
    assert.match(await shown(second.page), /^barrel: 441 pieces/);
    await first.close();
  },

  async 'a search that is stopped keeps its best plan, and so does a page that is closed, with the plan before it'() {
    const {page, own, close} = await open();
    thread('make', 'sphere', '--size', '8', '-o', file('long.obj')); // searched for longer than this test takes
    await choose(page, file('long.obj'));
    await shown(page);
    await page.getByLabel('Where may they end?').selectOption('any');
    await page.getByLabel('How many cords?').selectOption('3');
    await page.getByLabel('How long may it search?').selectOption('5');
    await made(page);
    assert.match(await result(page), /3 cords/);
    await page.getByLabel('How many cords?').selectOption('1');
    await page.getByLabel('What matters most?').selectOption('tortuosity');
    await page.getByLabel('How long may it search?').selectOption('600');
    await page.getByRole('button', {name: 'Thread it'}).click();
    await part(page, 'Searching').getByText(/Found: 1 cord/).waitFor({timeout: 60000});
    assert.notEqual(await page.locator('#begin').getAttribute('inert'), null, 'what is searched for is not changed meanwhile');
    const other = await own.newPage(); // as if the first were closed
    await other.goto(pathToFileURL(html).href);
    await drawn(other, 120000);
    assert.match(await result(other), /verified/);
    assert.match(await result(other), /1 cord, /);
    await other.getByRole('button', {name: 'Undo'}).click();
    await part(other, 'Your plan').getByText(/3 cords/).first().waitFor();
    await other.close();
    await part(page, 'Searching').getByText(/none can by less than \d+ degrees/).waitFor({timeout: 60000});
    await page.getByRole('button', {name: 'Stop and keep the best'}).click();
    await drawn(page, 120000);
    assert.match(await result(page), /verified .*The search was stopped\. It turns by \d+ degrees, and none can by less than \d+/);
    await close();
  },

  async 'by keyboard alone, from an OBJ to a booklet on Letter paper; what a screen reader hears'() {
    thread('make', 'dome', '--size', '5', '-o', file('keys.obj'));
    const {page, own, close} = await open(), heard = await listen(page);
    const chosen = page.waitForEvent('filechooser'); // which the browser is told some time before the key
    await tabTo(page, 'Choose a file');
    await page.bringToFront();
    await page.keyboard.press('Space');
    await (await chosen).setFiles(file('keys.obj'));
    await shown(page);
    await tabTo(page, 'the lowest ones');
    await page.keyboard.press('Enter');
    await until(async () => (await page.getByLabel('Feet, where cord may come out').inputValue()) !== '', 'feet');
    await tabTo(page, 'How many cords?');
    await page.keyboard.press('2');
    await tabTo(page, 'Thread it');
    await page.keyboard.press('Enter');
    await drawn(page, 120000);
    assert.match(await result(page), /2 cords|A +\d+[^]*B +\d+/);
    await tabTo(page, 'on');
    await page.keyboard.press('L');
    assert.equal(await page.getByLabel('on', {exact: true}).inputValue(), 'letter');
    await tabTo(page, 'Open the booklet to print');
    const [booklet] = await Promise.all([own.waitForEvent('page'), page.keyboard.press('Enter')]);
    await booklet.locator('.page').first().waitFor();
    await booklet.pdf({path: file('letter.pdf'), preferCSSPageSize: true, printBackground: true});
    assert.match(execFileSync('pdfinfo', [file('letter.pdf')], {encoding: 'utf8'}), /Page size: +612 x 792/);
    await booklet.close();
    const words = await heard();
    for (const part of [/25 pieces that meet at 40 interfaces/, /Searching/, /2 cords, each [\d.]+ m threaded, cut [\d.]+ m; pull/, /Every claim of this plan was verified/]) assert.match(words, part);
    fs.writeFileSync(file('broken.obj'), 'v 0 0\n');
    await choose(page, file('broken.obj'));
    await page.getByRole('alert').waitFor();
    assert.match(await heard(), /broken\.obj:1: /);
    await close();
  },

  async 'everything that can be used has a name to be read out'() {
    const {page, close} = await open();
    await choose(page, path.join(DATA, 'dome7.json'));
    await made(page);
    const {nodes} = await (await page.context().newCDPSession(page)).send('Accessibility.getFullAXTree');
    const used = nodes.filter(({ignored, role}) => !ignored && ['button', 'link', 'textbox', 'spinbutton', 'combobox', 'image', 'img', 'Iframe', 'progressbar'].includes(role?.value));
    assert.ok(used.length > 20, `${used.length} controls`);
    assert.deepEqual(used.filter(({name}) => !name?.value).map(({role}) => role.value), []);
    await close();
  },

  async 'unasked it makes what the command makes unasked: as few cords as a hand can pull'() {
    thread('make', 'dome', '--size', '5', '-o', file('unasked.json'));
    thread('plan', file('unasked.json'), '-q', '-o', file('unasked-plan.json'));
    const {page, close} = await open();
    await page.evaluate(() => {
      globalThis.saidOfRows = [];
      new MutationObserver(() => saidOfRows.push($('advice-said').textContent)).observe($('advice-said'), {childList: true});
    });
    await choose(page, file('unasked.json'));
    await page.getByText(/^Makes what is recommended: \d cords? with ends at the feet, [\d.]+ N to pull\.$/).waitFor({timeout: 60000});
    await page.getByText(/^Done\. Take \d+ cords at the feet: [\d.]+ N a cord instead of [\d.]+ N with \d+, for [^.]*cord\. A hand manages 10 N\. Should your cord be rougher \(friction 0\.3\), this takes [\d.]+ N; \d+ cords? would take [\d.]+ N, too much\./).waitFor({timeout: 60000});
    const counted = (await page.evaluate(() => saidOfRows)).map((words) => /^Still looking, (\d+) of (\d+) rows/.exec(words)).filter(Boolean).map(([, done]) => Number(done));
    assert.ok(counted.length > 5 && counted.every((done, i) => i === 0 || done >= counted[i - 1]) && counted.at(-1) > 1, `${counted}`);
    const offered = await page.locator('#cords option').allTextContents();
    assert.deepEqual(offered.slice(1), offered.slice(1).sort((a, b) => a - b));
    assert.ok(offered.includes(await page.evaluate(() => String(recommended.cords))));
    await made(page);
    const cords = (name) => JSON.parse(fs.readFileSync(name, 'utf8')).cords;
    assert.deepEqual(cords(await download(page, 'plan.json')), cords(file('unasked-plan.json')));
    await close();
  },

  async 'how a file is read is asked in words, and kept when feet change'() {
    fs.writeFileSync(file('wide.obj'), 'v 0 0 0\nv 8 0 0\nv 8 4 0\nv 0 4 0\nv 4 2 3\nl 1 2 3 4 1\nl 1 5 3\nl 2 5 4\n');
    const {page, close} = await open();
    await choose(page, file('wide.obj'));
    assert.match(await shown(page), /^wide: 5 pieces/);
    await page.getByText('Is it as it was meant?').click();
    await page.getByLabel('How wide is the whole?').selectOption('8 metres');
    await until(() => page.evaluate(() => frame.units === 'm'), 'metres');
    await page.getByLabel('Feet, where cord may come out').fill('1 2 3');
    await page.keyboard.press('Tab');
    await until(() => page.evaluate(() => String(frame.feet) === '0,1,2'), 'three feet, with blanks between them');
    await page.getByLabel('How wide shall it be?').fill('2');
    await page.keyboard.press('Tab');
    await until(() => page.evaluate(() => Math.abs(Math.max(...frame.nodes.map(([x]) => x)) - 2) < 1e-9), 'a quarter as wide');
    assert.match(await page.locator('#units option').first().innerText(), /^as the file is read: 8 mm$/);
    await page.getByText('It is now 2 x 1 m, and 0.75 m high, from middle to middle of the outer pieces.').waitFor();
    assert.equal(await page.locator('#example option:checked').textContent(), 'own file');
    await page.getByLabel('Which way is up?').selectOption('y');
    await until(() => page.evaluate(() => frame.nodes.some(([, , z]) => z > 0.9)), 'the other way up');
    assert.ok(await page.evaluate(() => Math.abs(widthOf(frame) - 2) < 1e-9), 'as wide as was asked');
    assert.deepEqual(await page.evaluate(() => [frame.units, frame.feet]), ['m', [0, 1, 2]]);
    await page.getByLabel('Which part of the file?').fill('7');
    await page.keyboard.press('Tab');
    await page.getByRole('alert').waitFor();
    assert.doesNotMatch(await trouble(page), /--/);

    // What the file leaves open has a button that comes to the question; an example is no file.
    fs.writeFileSync(file('lies.obj'), 'v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 1 0.5\nl 1 2 3 4 1\nl 1 5 3\nl 2 5 4\n');
    await choose(page, file('lies.obj'));
    await page.getByText('It may lie on its side: only one line of pieces is at the bottom.', {exact: true}).waitFor();
    await page.getByText('The file names no unit: its numbers are taken as millimetres, and most of its edges are shorter than 2 mm.', {exact: true}).waitFor();
    for (const [question, id] of [['Which way is up?', 'up'], ['How wide is the whole?', 'units'], ['How wide shall it be?', 'wide']]) {
      await page.getByRole('button', {name: question}).click();
      assert.equal(await page.evaluate(() => document.activeElement.id), id);
    }
    await takeExample(page, 'straight row');
    await until(async () => /^as it is: /.test(await page.locator('#units option').first().textContent()), 'not as a file');
    await page.getByLabel('How wide shall it be?').fill('300');
    await page.keyboard.press('Enter');
    await page.getByText(/^It is now 300 x /).waitFor();
    assert.equal(await page.locator('#example option:checked').textContent(), 'straight row');
    await close();
  },

  async 'what is tapped after another width is done, with that width'() {
    const {page, close} = await open({viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true});
    await takeExample(page, 'dome, 7 x 7 pieces');
    const wide = page.getByLabel('How wide shall it be?'), feet = page.getByLabel('Feet, where cord may come out'), counts = page.locator('#counts');
    await page.getByLabel('Feet, where cord may come out').fill('');
    await page.keyboard.press('Tab');
    await until(async () => (await feet.inputValue()) === '', 'no feet');
    await wide.fill('150');
    await page.getByRole('button', {name: 'the lowest ones'}).tap();
    await until(async () => (await feet.inputValue()) === 'A1, A7, G1, G7', 'the lowest ones as feet');
    assert.match(await counts.innerText(), /150 mm wide/);
    await wide.fill('200');
    await page.getByRole('button', {name: 'Thread it'}).tap();
    await drawn(page, 120000);
    assert.match(await counts.innerText(), /200 mm wide/);
    assert.equal(await page.getByText('The plan was for what was there before.').isVisible(), false);
    await page.getByLabel('How thick is your cord, in mm?').fill('2');
    await page.getByRole('button', {name: 'Thread it'}).tap();
    await drawn(page, 120000);
    assert.match(await result(page), /m of cord, 2 mm thick/);
    assert.equal(await page.evaluate(() => JSON.parse(plan).options.physics.cord_diameter), 2);
    await close();
  },

  async 'a click that drops a plan says so, and it can be brought back'() {
    thread('make', 'dome', '--size', '3', '-o', file('drop.json'));
    const {page, close} = await open();
    await choose(page, file('drop.json'));
    await made(page);
    await page.getByLabel('Feet, where cord may come out').fill('A1 C3');
    await page.keyboard.press('Tab');
    await page.getByRole('button', {name: 'Bring it back'}).click();
    await drawn(page);
    assert.equal((await page.getByLabel('Feet, where cord may come out').inputValue()).split(', ').length, 4);
    assert.doesNotMatch(await page.evaluate(() => document.body.innerText), /--[a-z]/, 'no option of the command line');
    await close();
  },

  async 'a large booklet: how many pages, its first part'() {
    thread('make', 'dome', '--size', '16', '-o', file('large.json'));
    thread('plan', file('large.json'), '--cords', '1', '-q', '-o', file('large-plan.json'));
    const {page, own, close} = await open();
    await choose(page, file('large-plan.json'));
    await drawn(page, 120000);
    await page.getByRole('button', {name: 'Open the booklet to print'}).click();
    const first = page.getByRole('button', {name: /^Open the first \d+ pages$/});
    await first.waitFor({timeout: 120000});
    const pages = Number(/\d+/.exec(await first.innerText())[0]);
    const [booklet] = await Promise.all([own.waitForEvent('page'), first.click()]);
    await booklet.locator('.page').first().waitFor();
    await until(async () => (await booklet.locator('.page').count()) === pages, `${pages} pages`); // they come one after another
    await close();
  },

  async 'a finger turns and scrolls, and picks feet by a long press or where that is ticked'() {
    const {page, own, close} = await open({viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true});
    await takeExample(page, 'dome, 7 x 7 pieces');
    const picture = page.getByRole('img', {name: /^The framework/}), feet = page.getByLabel('Feet, where cord may come out');
    await picture.scrollIntoViewIfNeeded();
    const box = await picture.boundingBox(), [x, y] = await page.evaluate(() => sketch.place(frame.nodes[frame.names.indexOf('D1')]));
    const session = await own.newCDPSession(page), at = [{x: box.x + x, y: box.y + y, id: 0}];
    const press = async (ms) => {
      await session.send('Input.dispatchTouchEvent', {type: 'touchStart', touchPoints: at});
      await page.waitForTimeout(ms);
      await session.send('Input.dispatchTouchEvent', {type: 'touchEnd', touchPoints: []});
    };
    await press(0);
    assert.doesNotMatch(await feet.inputValue(), /D1/);
    await press(1500);
    await until(async () => /D1/.test(await feet.inputValue()), 'a long press picks');
    await page.getByLabel('a tap picks feet').check();
    await picture.scrollIntoViewIfNeeded();
    const now = await picture.boundingBox();
    at[0] = {x: now.x + x, y: now.y + y, id: 0};
    await press(0);
    await until(async () => !/D1/.test(await feet.inputValue()), 'a tap picks');
    await close();
  },

  async 'nothing serious for those who do not see it as it is drawn, in light and dark'() {
    const source = fs.readFileSync(createRequire(path.join(packages, 'package.json')).resolve('axe-core/axe.min.js'), 'utf8');
    for (const colorScheme of ['light', 'dark']) {
      const {page, close} = await open({colorScheme});
      const look = async (stage) => {
        await page.evaluate(source);
        const found = await page.evaluate(() => axe.run(document, {iframes: false, rules: {'target-size': {enabled: true}}}));
        const serious = found.violations.filter(({impact}) => ['serious', 'critical'].includes(impact));
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 1100, `${stage}: wider than the window`);
        assert.deepEqual(serious.map(({id, nodes}) => [stage, colorScheme, id, nodes[0].html.slice(0, 200), nodes[0].failureSummary]), []);
      };
      await look('start');
      await takeExample(page, 'dome, 7 x 7 pieces');
      await page.getByRole('button', {name: /recommended$/}).waitFor({timeout: 120000});
      await look('questions');
      await made(page);
      await look('result');
      await close();
    }
  },

  async 'what the program says names no command and no option of its own'() {
    const root = path.join(__dirname, '../..'), folders = ['cli', 'graph', 'lib', 'planner', 'lp', 'symmetry', 'tortuosity', 'eval', 'kit', 'diagram'];
    const sources = folders.flatMap((folder) => fs.readdirSync(path.join(root, folder), {recursive: true}).filter((name) => name.endsWith('.c')).map((name) => path.join(root, folder, name)));
    // Strings that follow each other are one.
    const strings = sources.flatMap((name) => fs.readFileSync(name, 'utf8').match(/"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*/g) || []).map((words) => words.replace(/"\s*"/g, '').slice(1, -1));
    // But for what is said of commands that there are not.
    const lines = strings.filter((words) => /--[a-z]|thread [a-z]+ -/.test(words) && !/`thread (%s|--help)/.test(words));
    assert.ok(lines.length > 200, `${lines.length} of ${strings.length}`);
    const {page, close} = await open();
    const left = (await page.evaluate((all) => all.map(inWords), lines)).filter((words) => /(^|[^\w-])--[a-z]|`thread /.test(words));
    assert.deepEqual(left, []);
    const said = [['p.json: not a thread plan; make one with `thread plan`', 'p.json: not a thread plan'],
      ['x: no such quantity; `thread eval --help` lists them (here with _ for -)', 'x: no such quantity'],
      ['10 nodes nearly one: --weld 0.1 merges 4', '10 nodes nearly one: “Which ends are one piece?” merges 4'], ['only with ends `counts`', 'only with ends `counts`'],
      ['piece A1 needs a width of 4 mm, not 2: --width 4 or more', 'piece A1 needs a width of 4 mm, not 2: width 4 or more'],
      ['--bed mine: expected width x depth, as 220x220 (see `thread kit --help`)', 'bed mine: expected width x depth, as 220x220'],
      ['if y points up in this file: --up y', 'if y points up in this file: “Which way is up?”']];
    for (const [line, words] of said) assert.equal(await page.evaluate((given) => inWords(given), line), words);
    await close();
  },

  async 'everything to be touched is 44 pixels high and wide, all words can be read, at both sizes, in light and dark'() {
    // Of each visible control its size, of each visible text its contrast with what is behind it (WCAG 2.2: 1.4.3, 1.4.11, 2.5.5).
    const measure = () => {
      const canvas = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
      const rgba = (colour) => {
        canvas.clearRect(0, 0, 1, 1);
        canvas.fillStyle = colour;
        canvas.fillRect(0, 0, 1, 1);
        return canvas.getImageData(0, 0, 1, 1).data;
      };
      const light = ([r, g, b]) => [r, g, b].map((x) => x / 255).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)).reduce((sum, x, i) => sum + x * [0.2126, 0.7152, 0.0722][i], 0);
      const contrast = (a, b) => {
        const [low, high] = [light(a), light(b)].sort((x, y) => x - y);
        return (high + 0.05) / (low + 0.05);
      };
      const behind = (node) => {
        for (let at = node; at; at = at.parentElement) {
          const colour = rgba(getComputedStyle(at).backgroundColor);
          if (colour[3] === 255) return colour;
        }
        return rgba('#fff');
      };
      const seen = (node) => node.checkVisibility({opacityProperty: true, visibilityProperty: true}) && node.getBoundingClientRect().width > 1;
      const named = (node) => `${node.tagName.toLowerCase()}#${node.id} ${node.textContent.trim().slice(0, 30)}`, found = [];
      for (const node of document.querySelectorAll('button, input, select, a, summary, label.button, label:has(input)')) {
        if (!seen(node)) continue;
        const {width, height} = (node.type === 'checkbox' ? node.closest('label') : node).getBoundingClientRect();
        if (width < 44 || height < 44) found.push(`${named(node)}: ${width.toFixed(1)} x ${height.toFixed(1)} pixels`);
        if (node.disabled || !node.matches('input, select')) continue;
        const edge = contrast(rgba(getComputedStyle(node).borderTopColor), behind(node.parentElement));
        if (edge < 3) found.push(`${named(node)}: its edge has a contrast of ${edge.toFixed(2)}`);
      }
      const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
      for (let words = texts.nextNode(); words; words = texts.nextNode()) {
        const node = words.parentElement;
        if (!words.data.trim() || !seen(node) || node.closest('[disabled], script, style, noscript, iframe')) continue;
        const style = getComputedStyle(node), size = parseFloat(style.fontSize), isLarge = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
        const got = contrast(rgba(style.color), behind(node));
        if (got < (isLarge ? 3 : 4.5)) found.push(`${named(node)}: a contrast of ${got.toFixed(2)}`);
      }
      return found;
    };
    for (const [width, height] of [[1280, 800], [390, 844]])
      for (const colorScheme of ['light', 'dark']) {
        const {page, close} = await open({viewport: {width, height}, colorScheme, ...(width < 400 ? {hasTouch: true, isMobile: true} : {})});
        const look = async (stage) => {
          assert.deepEqual(await page.evaluate(measure), [], `${stage}, ${width} x ${height}, ${colorScheme}`);
          await page.screenshot({path: file(`look-${stage}-${width}-${colorScheme}.png`), fullPage: true});
        };
        await look('start');
        await takeExample(page, 'dome, 7 x 7 pieces');
        await page.getByText('Is it as it was meant?').click();
        await page.getByRole('button', {name: /recommended$/}).waitFor({timeout: 120000});
        await look('questions');
        await made(page);
        await page.getByText('About', {exact: true}).click();
        await look('result');
        await close();
      }
  },

  async 'memory is given back between runs'() {
    const {page, close} = await open();
    const renderers = () => fs.readdirSync('/proc').filter((id) => /^\d+$/.test(id)).reduce((sum, id) => {
      try {
        const words = fs.readFileSync(`/proc/${id}/cmdline`, 'utf8');
        return words.includes('--type=renderer') ? sum + Number(/VmRSS:\s+(\d+)/.exec(fs.readFileSync(`/proc/${id}/status`, 'utf8'))[1]) / 1024 : sum;
      } catch {
        return sum; // it has ended
      }
    }, 0);
    const used = [];
    await takeExample(page, 'dome 12');
    await shown(page);
    for (let run = 0; run < 5; run++) {
      await made(page);
      await (await page.context().newCDPSession(page)).send('HeapProfiler.collectGarbage');
      used.push(Math.round(renderers()));
    }
    console.log(`      MB after each of five runs: ${used.join(', ')}`);
    assert.ok(used[4] < 1.5 * used[1] + 50, used.join(', '));
    await close();
  },

  async 'a link brings the answers; a telephone in the dark; two fingers enlarge the framework; feet by keyboard'() {
    const {page, own, close} = await open({viewport: {width: 360, height: 740}, hasTouch: true, isMobile: true, colorScheme: 'dark', hash: '#cords=5&ends=any&pull=50'});
    await takeExample(page, 'tube');
    assert.match(await shown(page), /interfaces/);
    assert.equal(await page.getByLabel('How many cords?').inputValue(), '5');
    assert.equal(await page.getByLabel('How hard can you pull?').inputValue(), '50');
    const feet = await page.getByLabel('Feet, where cord may come out').inputValue();
    await page.screenshot({path: file('telephone.png'), fullPage: true});
    const picture = page.getByRole('img', {name: /^The framework/}), before = await inked(picture);
    await pinch(own, page, picture, 2);
    const after = await inked(picture);
    assert.ok(after > 1.3 * before, `${before} of the width, then ${after}`);
    assert.equal(await page.getByLabel('Feet, where cord may come out').inputValue(), feet, 'two fingers choose no foot');
    await page.getByLabel('Feet, where cord may come out').fill('A1, zz');
    await page.keyboard.press('Tab');
    await page.getByRole('alert').waitFor();
    assert.match(await trouble(page), /no piece zz/);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `${wide} pixels are wider than the telephone`);
    await close();
  },
};

async function main() {
  let passed = 0, failed = 0;
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  for (const [name, test] of Object.entries(tests).filter(([title]) => title.includes(process.env.ONLY || ''))) {
    const begun = Date.now();
    try {
      await test();
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
