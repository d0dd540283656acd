// The plans that tests/schema/test.cjs holds against the schema: makePlans(PROGRAM, SCRATCH) gives
// [{name, plan}]. Together they have every member that a plan may have.
'use strict';
const {spawnSync} = require('node:child_process');
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');

const ROOT = path.resolve(__dirname, '../..');
const ZIGZAGS = `v 0 0 0
v 10 0 0
v 10 10 0
v 20 10 0
v 20 20 0
v 0 90 0
v 10 90 0
v 10 99 0
v 20 99 0
l 1 2 3 4 5
l 6 7 8 9
`;

// Frameworks by name: words for `thread make`, or a file.
const FRAMES = {
  dome3: 'dome --size 3', dome4: 'dome --size 4', dome5: 'dome --size 5', sphere: 'sphere --size 2',
  zigzags: 'zigzags.obj', arms: path.join(ROOT, 'tests/second/arms.csv'),
};

// A framework and options: a plan each.
const PLANS = [
  ['dome3', '--cords 1'],
  ['dome3', ''],
  ['dome3', '--cords 1 --ends A1,B1 --cover 2 --capacity 4 --crossings price'],
  ['dome3', '--ends A1:2,B1:2 --cords 2 --tune confirm=always --preset pla-braid'],
  ['dome3', '--cords 3 --ends any --order hand --from middle --wobble 1'],
  ['dome3', '--distinct 2 --cords 3 --balance --ends any'],
  ['dome3', '--cords auto --max-length 120 --time-limit 3'],
  ['dome3', '--joint tube --cords 1..3 --ends any --max-length 200 --time-limit 3'],
  ['dome3', '--objective tortuosity --gap 5 --tune nodes=5 --tune engine=lp --length-slack 10%'],
  ['dome3', '--objective tortuosity --joint tube'],
  ['dome3', '--objective tortuosity --tour fleury --length-slack 0'],
  ['dome3', '--objective symmetry --ends feet --feet lowest'],
  ['dome3', '--objective symmetry --cords 2 --geometric 0.01'],
  ['dome4', '--cords 5 --balance'],
  ['dome4', '--cords 6 --ends feet --feet lowest'],
  ['dome4', '--crossings forbid --objective tortuosity --turn-cost sine'],
  ['dome4', '--max-pull 4x'],
  ['dome5', '--joint tube --objective tortuosity --length-slack 0 --time-limit 5'],
  ['sphere', '--objective tortuosity --tune nodes=2'],
  ['zigzags', '--ends any --max-pull 1.2x'],
  ['arms', '--distinct 2 --cords 3 --balance --ends any'],
];

// A plan and options of `thread eval`: what is found of the plan is kept in it.
const SNAKE = path.join(ROOT, 'data/dome7-snake.json');
const STRUCTURE = ['--method', 'structure'];
const EVALUATIONS = [
  ['feet.json', '--law', 'mitre', '--pull', 'start', '--preset', 'wood-paracord',
    '--cord-diameter', '2'],
  ['feet.json', '--method', 'joint'],
  ['feet.json', ...STRUCTURE, '--load', 'B2=1', '--tilt', '5'],
  ['feet.json', ...STRUCTURE, '--schedule', 'all: pull both 20'],
  ['two.json', '--schedule', 'A: pull both 60; A: release end 2; B: none', '--wobble', '1',
    '--mu-power', '0.5', '--mu-tension', '2', '--stiffness', '1000', '--bead-strength', '10'],
  [SNAKE, '--hand', '50'],
  [SNAKE, ...STRUCTURE, '--schedule', 'all: pull both 0.1; all: knot both', '--stiffness', '1000',
    '--cord-strength', '2', '--load', 'D4=5', '--load-pulls', '5'],
];

function makePlans(program, scratch) {
  const env = {...process.env, XDG_CACHE_HOME: path.join(scratch, 'cache')};
  const plans = [];
  const run = (...words) => {
    const {status, stderr} = spawnSync(program, words, {cwd: scratch, env, encoding: 'utf8'});
    assert.ok(status === 0 || status === 5, `thread ${words.join(' ')}: ${status}: ${stderr}`);
  };
  const keep = (file) => {
    const text = fs.readFileSync(path.resolve(scratch, file), 'utf8');
    plans.push({name: path.basename(file), plan: JSON.parse(text)});
  };

  fs.writeFileSync(path.join(scratch, 'zigzags.obj'), ZIGZAGS);
  const frames = Object.fromEntries(Object.entries(FRAMES).map(([name, words]) => {
    if (!words.includes('--')) return [name, words];
    run('make', ...words.split(' '), '-o', `${name}.json`);
    return [name, `${name}.json`];
  }));

  PLANS.forEach(([frame, options], i) => {
    run('plan', frames[frame], '-q', '-o', `plan${i}.json`, ...options.split(' ').filter(Boolean));
    keep(`plan${i}.json`);
  });

  run('plan', frames.dome3, '--ends', 'feet', '--feet', 'lowest', '-q', '-o', 'feet.json');
  run('plan', frames.dome3, '--ends', 'any', '--cords', '2', '-q', '-o', 'two.json');
  EVALUATIONS.forEach(([plan, ...options], i) => {
    run('eval', plan, ...options, '-q', '-o', `eval${i}.json`);
    keep(`eval${i}.json`);
  });

  // Plans of older versions, by other hands, and such as take seconds to find.
  for (const folder of ['tests/fuzz/corpus/plan', 'tests/schema/plans']) {
    const seeds = path.join(ROOT, folder);
    fs.readdirSync(seeds).forEach((name) => keep(path.join(seeds, name)));
  }
  ['snake', 'stairs', 'lines'].forEach((name) => keep(path.join(ROOT, `data/dome7-${name}.json`)));

  // What thread reads and does not write, or hardly ever.
  const noted = structuredClone(plans[0].plan);
  noted.options.physics.note = 'from the bench';
  const open = structuredClone(plans[0].plan);
  open.proof.length.slack = 'open';
  const filmed = structuredClone(plans.find(({plan}) => plan.evaluation?.structure).plan);
  filmed.evaluation.structure.stills = [{pull: 1}];
  plans.push({name: 'note', plan: noted}, {name: 'slack', plan: open}, {name: 'stills', plan: filmed});
  return plans;
}

module.exports = {makePlans};
