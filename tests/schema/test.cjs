// docs/plan.schema.json beside what it describes: test.cjs PACKAGES PROGRAM SCRATCH. The plans of
// the program are valid and have every member; the tables of docs/plan-format.md name the same
// members; and of forged plans the schema says what `thread check` says, wherever the fault is one
// of form. Closes with "N passed, N failed".
'use strict';
const {spawnSync} = require('node:child_process');
const {createRequire} = require('node:module');
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const {makePlans} = require('./plans.cjs');

const [packages, program, scratch] = process.argv.slice(2, 5).map((name) => path.resolve(name));
const Ajv = createRequire(path.join(packages, 'package.json'))('ajv/dist/2020');
const DOCS = path.resolve(__dirname, '../../docs');
const schema = JSON.parse(fs.readFileSync(path.join(DOCS, 'plan.schema.json'), 'utf8'));
const isValid = new Ajv({strict: true, strictTypes: false, strictRequired: false}).compile(schema);
const isObject = (value) => typeof value === 'object' && value !== null && !Array.isArray(value);
const plans = makePlans(program, scratch);

// ---- which members plans have, and the schema knows ----

const definitionOf = (ref) => schema.$defs[ref.replace('#/$defs/', '')];

// Calls visit(definition, name) for every property that the schema defines.
function eachProperty(visit) {
  for (const [definition, rule] of [['plan', schema], ...Object.entries(schema.$defs)])
    Object.keys(rule.properties ?? {}).forEach((name) => visit(definition, name));
}

// Notes in seen the properties that a value has, as "definition.name", and in unknown the members
// that no property describes. Of several definitions those are meant whose members the value has.
function noteMembers(value, rule, definition, seen, unknown) {
  const known = new Set();
  const isMeant = ({$ref}) =>
    $ref && isObject(value) && definitionOf($ref).required.every((key) => key in value);

  const follow = (part, name) => {
    if (part.$ref) follow(definitionOf(part.$ref), part.$ref.replace('#/$defs/', ''));
    (part.oneOf ?? []).filter(isMeant).forEach((choice) => follow(choice, name));
    if (Array.isArray(value) && isObject(part.items))
      value.forEach((item) => noteMembers(item, part.items, name, seen, unknown));
    if (!isObject(value)) return;
    for (const [key, inner] of Object.entries(part.properties ?? {})) {
      if (!(key in value)) continue;
      known.add(key);
      seen.add(`${name}.${key}`);
      noteMembers(value[key], inner, name, seen, unknown);
    }
  };

  follow(rule, definition);
  if (!isObject(value)) return;
  for (const key of Object.keys(value)) if (!known.has(key)) unknown.add(`${definition}.${key}`);
}

// ---- the tables of plan-format.md ----

// By the headings of a table and what its first column is called: the definitions that it is of.
const TABLES = {
  'Top level, member': ['plan'], 'framework, member': ['framework'], 'options, member': ['options'],
  'options, turning, member': ['turningOptions'], 'options, symmetry, member': ['symmetryOptions'],
  'options, physics, member': ['physics'], 'cords, member': ['cord'],
  'symmetry, member': ['symmetry'], 'metrics, member': ['metrics'],
  'evaluation, member': ['evaluation'], 'evaluation, member of a cord': ['evaluatedCord'],
  'evaluation, member of a step': ['step'], 'evaluation, member of `structure`': ['structure'],
  'evaluation, member of an answer': ['answer'],
  'proof, length, member': ['lengthProof', 'certificate'],
  'proof, length, member of a cut': ['cut'], 'proof, cords, member': ['cordsProof'],
  'proof, pull, member': ['pullOfOne', 'pullOfParts'], 'proof, turning, member': ['turningProof'],
  'proof, turning, member of `proof`': ['tree'],
  'proof, turning, member of multipliers': ['multipliers'],
  'proof, turning, member of `walks`': ['walks', 'lengthWalks', 'turningWalks', 'pulledWalks'],
};

// Every name in backticks.
const namesIn = (text) =>
  [...text.matchAll(/`([^`]+)`/g)].flatMap((match) => match[1].match(/[a-z_]+/g) ?? []);

// The tables of members: {table: names in the first column}, and all names in any of their cells.
function readTables() {
  const rows = {}, named = new Set();
  const text = fs.readFileSync(path.join(DOCS, 'plan-format.md'), 'utf8');
  let heading = [], table; // undefined: outside of tables; null: in one that is not about members
  for (const line of text.split('\n')) {
    const [, marks, words] = line.match(/^(##+) (.*)/) ?? [];
    if (marks) heading = [...heading.slice(0, marks.length - 2), words];
    const first = line.startsWith('|') ? line.split('|')[1].trim() : undefined;
    if (first === undefined) {
      table = undefined;
    } else if (table === undefined) {
      table = first.startsWith('member') ? [...heading, first].join(', ') : null;
    } else if (table) {
      (rows[table] ??= []).push(...namesIn(first));
      namesIn(line).forEach((name) => named.add(name));
    }
  }
  return {rows, named};
}

// ---- forged plans ----

let forgedCount = 0;

// Which of the plans `thread check` accepts, in their order, by one process.
function accepted(forged) {
  const files = forged.map((plan) => {
    const file = path.join(scratch, `forged-${forgedCount++}.json`);
    fs.writeFileSync(file, JSON.stringify(plan));
    return file;
  });
  const words = ['check', '--time-limit', '0', ...files];
  const {stdout, stderr} = spawnSync(program, words, {encoding: 'utf8', maxBuffer: 1 << 28});
  const holding = new Set([...stdout.matchAll(/^(\S+): holds/gm)].map((match) => match[1]));
  for (const file of files)
    assert.ok(holding.has(file) || stderr.includes(`thread: ${file}: `), `${file}: no verdict`);
  return files.map((file) => holding.has(file));
}

// A copy of a plan with another value at a place; undefined: with none.
function forge(plan, place, value) {
  const copy = structuredClone(plan);
  const inner = place.slice(0, -1).reduce((outer, key) => outer[key], copy);
  if (value !== undefined) inner[place.at(-1)] = value;
  else delete inner[place.at(-1)];
  return copy;
}

// Calls visit(place, value) for every member, and for the first entry of every list.
function eachPlace(value, visit, place = []) {
  const keys = Array.isArray(value) ? Object.keys(value).slice(0, 1).map(Number) : [];
  if (isObject(value)) keys.push(...Object.keys(value));
  for (const key of keys) {
    visit([...place, key], value[key]);
    eachPlace(value[key], visit, [...place, key]);
  }
}

const pattern = (place) => place.map((key) => (key === 0 ? '[]' : `.${key}`)).join('');

// Values of every other type.
const typeOf = (value) => (value === null ? 'null' : Array.isArray(value) ? 'list' : typeof value);
const otherTypes = (value) =>
  [null, true, 1.5, 'x', [], {}].filter((other) => typeOf(other) !== typeOf(value));

// Plans of which a copy, written by this program, holds, come first: of others integers beyond 2^53
// have lost digits.
const small = plans.map(({plan}) => plan).filter((plan) => JSON.stringify(plan).length < 30000);
const holds = accepted(small);
const bases = [...small.filter((_, i) => holds[i]), ...small.filter((_, i) => !holds[i])];

// The first plan that has a member, and the first place where it has that.
const places = new Map();
for (const plan of bases)
  eachPlace(plan, (place, value) => {
    if (!places.has(pattern(place))) places.set(pattern(place), {plan, place, value});
  });

// Forges the members that are chosen: one plan for each value that changes(value) gives.
function forgeAll(isChosen, changes) {
  const chosen = [...places].filter(([, at]) => isChosen(at));
  return chosen.flatMap(([what, {plan, place, value}]) =>
    changes(value).map((other) => ({
      what: `${what}: ${JSON.stringify(other)}`,
      plan: forge(plan, place, other),
    })));
}

// Optional members that these plans cannot do without, for what they mean.
const LEFT_OUT = [
  // It is another framework.
  '.framework.lengths', '.framework.covers', '.framework.capacities', '.framework.feet',
  // Something else was asked for than is proved or counted.
  '.symmetry.retraced',
  // Less is proved than is claimed.
  '.proof.length.certificate[].place_prices', '.proof.length.certificate[].cuts[].parent',
  '.proof.length.walks', '.proof.length.walks.memory',
  '.proof.length.proof.multipliers[].junctions', '.proof.cords.sets', '.proof.cords.walks',
  '.proof.pull.walks', '.proof.pull.walks.memory', '.proof.turning.proof.multipliers[].junctions',
  '.proof.turning.proof.multipliers[].ranks', '.proof.turning.proof.tree[].orbit',
  '.proof.turning.proof.symmetries',
  // The default is not what was evaluated.
  '.evaluation.physics.cord_diameter', '.evaluation.physics.bore',
  '.evaluation.physics.bead_diameter', '.evaluation.physics.wobble', '.evaluation.physics.mu_power',
  '.evaluation.physics.mu_tension', '.evaluation.structure.model', '.evaluation.structure.loads',
  '.evaluation.cords[].tension_most',
];

// Words that a reader has to look up.
const OTHER_WORDS = ['.options.turning.length_slack: null', '.options.symmetry.group: "x"'];

// Forged by hand: a member that some plan has, and what it becomes; or the member, the name of
// another one beside it, and what that becomes.
const REFUSED = [
  ['.format', 'thread'], ['.version', 0], ['.version', 3], ['.version', 1.5],
  ['.framework.units', 'parrot'], ['.framework.hash', 'XYZ'], ['.framework.nodes', []],
  ['.framework.nodes[]', [0, 0]], ['.framework.nodes[][]', 1e100], ['.framework.edges', []],
  ['.framework.edges[]', [0]], ['.framework.edges[][]', -1], ['.framework.lengths[]', 0],
  ['.framework.covers[]', 101], ['.framework.capacities[]', 101],
  ['.framework.names', ['A', 'A', 'A', 'A']], ['.options.objective', 'fun'],
  ['.options.joint', 'glue'], ['.options.cover', 0], ['.options.cover', 101],
  ['.options.capacity', 0], ['.options.distinct', 1], ['.options.cords', 0],
  ['.options.cords', 1001], ['.options.cords.least', 0], ['.options.max_length', 0],
  ['.options.max_pull', 0.9], ['.options.ends', 'nowhere'], ['.options.end_counts[]', [0, 2001]],
  ['.options.end_counts', undefined], ['.options.end_nodes', undefined], ['.options.order', 'none'],
  ['.options.needles', 3], ['.options.engine', 'glpk'], ['.options.gap', 101],
  ['.options.crossings', 'many'], ['.options.time_limit', -1], ['.options.turning.cost', 'cosine'],
  ['.options.turning.minimize', 'length'], ['.options.turning.tour', 'euler'],
  ['.options.turning.nodes', 0], ['.options.symmetry.group', ''],
  ['.options.symmetry.group', 'a name that is too long'],
  ['.options.symmetry.prefer', ['steps', 'paths', 'turning']],
  ['.options.symmetry.prefer', ['steps', 'steps', 'paths', 'turning']],
  ['.options.physics.preset', 'gold'], ['.options.physics.mu', 2.1],
  ['.options.physics.mu_high', 3.1], ['.options.physics.seating', 0],
  ['.options.physics.density', 26], ['.cords', []], ['.cords[].id', 'a'], ['.cords[].edges', []],
  ['.cords[].component', 0.5], ['.symmetry.order', 0], ['.symmetry.order', 1025],
  ['.symmetry.images', []], ['.symmetry.unique_paths', 0], ['.metrics.passes', 2147483648],
  ['.metrics.distinct', undefined], ['.metrics.crossings', undefined],
  ['.evaluation.method', 'guess'], ['.evaluation.law', 'gravity'],
  ['.evaluation.seed', 9007199254740994], ['.evaluation.time_step', 0],
  ['.evaluation.iterations', 0], ['.evaluation.schedule', []], ['.evaluation.schedule[].do', 'cut'],
  ['.evaluation.schedule[].pass', 0.5], ['.evaluation.cords[].pull', 'neither'],
  ['.evaluation.cords[].known', false], ['.evaluation.cords[].colours[]', 'red'],
  ['.evaluation.structure.model', 3], ['.evaluation.structure.tilt', 1.5707963267948966],
  ['.evaluation.structure.answers', []], ['.evaluation.structure.answers[].asked', 'why'],
  ['.proof.length.status', 'perhaps'],
  ['.proof.length.slack', 'closed'], ['.proof.length.certificate[].scale', 0],
  ['.proof.length.certificate[].denominator', 0],
  ['.proof.length.certificate[].denominator', 1099511627777], ['.proof.cords.sets', false],
  ['.proof.cords.fewest.lower_bound', 0], ['.proof.cords.walks.unit', 0],
  ['.proof.pull.excluded', 1001], ['.proof.pull.cut', 55267482437723],
  ['.proof.pull.walks.bits', 45], ['.proof.pull.parts', []], ['.proof.turning.most_passes', 0],
  ['.proof.turning.proof.tree', []], ['.proof.turning.proof.tree[].low', 0],
  ['.proof.turning.proof.tree[].b', -2], ['.framework', 'symmetry', {}],
  ['.options.turning', 'confirm', 'never'], ['.options.end_nodes', 'end_counts', [[0, 2]]],
  ['.evaluation.structure', 'law', 'mitre'], ['.evaluation.schedule[].pass', 'slip', 1],
  ['.evaluation.structure.answers[].asked', 'resists', 1],
  ['.proof.length.proof', 'certificate', []], ['.proof.pull.parts', 'excluded', 1],
];
const ACCEPTED = [
  ['.generator', undefined], ['.generator', 'wish', 1], ['.framework.hash', 'wish', 1],
  ['.cords[].id', 'wish', 1], ['.framework.units', 'inch'], ['.framework.names', undefined],
  ['.options.order', undefined], ['.options.gap', undefined],
  ['.options.physics.mu', 'note', 'from the bench'], ['.options.physics.wobble', undefined],
  ['.proof.length.method', 7], ['.proof.length.method', undefined],
  ['.proof.turning.pairing_bound', undefined], ['.evaluation', undefined],
];
// Well formed, but not true.
const UNTRUE = [
  ['.framework.hash', '0000000000000000'], ['.framework.edges[]', [0, 0]],
  ['.framework.nodes[][]', 12345], ['.options.distinct', 100], ['.options.cords.least', 1000],
  ['.cords[].id', 'Z'], ['.cords[].component', 9], ['.cords[].nodes[]', 9999],
  ['.symmetry.order', 7], ['.symmetry.cords[].of', 99], ['.metrics.length', 1],
  ['.metrics.passes', 0], ['.evaluation.largest', 1e9],
  ['.evaluation.structure.answers[].mechanism', [1, 0, 0, 0, 0, 0, 0]],
  ['.proof.length.lower_bound', 1e9], ['.proof.length.certificate[].cuts[].nodes[]', 9999],
  ['.proof.turning.proof.tree[].multipliers', 99],
];

// Asserts what the schema and `thread check` say of each row.
function judgeByHand(rows, expected) {
  const forged = rows.map(([what, ...change]) => {
    const {plan, place} = places.get(what);
    const changed = change.length > 1 ? [...place.slice(0, -1), change[0]] : place;
    return forge(plan, changed, change.at(-1));
  });
  const said = accepted(forged);
  const isOther = (i) => isValid(forged[i]) !== expected.schema || said[i] !== expected.thread;
  assert.equal(rows.filter((_, i) => isOther(i)).map((row) => JSON.stringify(row)).join('\n'), '');
  return `${rows.length} forged plans`;
}

// Asserts that the schema and `thread check` say the same of forged plans, but that `thread check`
// alone may refuse those that mayMean(what) names.
function compareForged(forged, mayMean) {
  const said = accepted(forged.map(({plan}) => plan));
  const differences = forged.flatMap(({plan, what}, i) => {
    if (isValid(plan) === said[i]) return [];
    if (said[i]) return [`${what}: refused by the schema alone: ${isValid.errors[0].message}`];
    return mayMean(what) ? [] : [`${what}: accepted by the schema alone`];
  });
  assert.equal(differences.join('\n'), '');
  return `${forged.length} forged plans, ${said.filter(Boolean).length} of them accepted`;
}

const tests = {
  'the plans are valid': () => {
    for (const {name, plan} of plans)
      assert.ok(isValid(plan), `${name}: ${JSON.stringify(isValid.errors)}`);
    return `${plans.length} plans`;
  },

  'every member of the schema is in a plan, and every member of a plan in the schema': () => {
    const seen = new Set(), unknown = new Set(), missing = [];
    for (const {plan} of plans) noteMembers(plan, schema, 'plan', seen, unknown);
    eachProperty((definition, name) => {
      if (!seen.has(`${definition}.${name}`)) missing.push(`${definition}.${name}`);
    });
    assert.deepEqual({unknown: [...unknown], missing}, {unknown: [], missing: []});
    return `${seen.size} members`;
  },

  "the tables of plan-format.md have the schema's members": () => {
    const {rows, named} = readTables(), tabled = new Set(Object.values(TABLES).flat());
    assert.deepEqual(Object.keys(rows).sort(), Object.keys(TABLES).sort());
    for (const [table, definitions] of Object.entries(TABLES)) {
      const rules = definitions.map((name) => (name === 'plan' ? schema : schema.$defs[name]));
      const members = new Set(rules.flatMap((rule) => Object.keys(rule.properties)));
      assert.deepEqual([...new Set(rows[table])].sort(), [...members].sort(), table);
    }
    eachProperty((definition, name) =>
      assert.ok(tabled.has(definition) || named.has(name), `${definition}.${name} is in no table`));
  },

  'members of another type': () => {
    const forged = forgeAll(() => true, otherTypes);
    return compareForged(forged, (what) => OTHER_WORDS.includes(what));
  },

  'members that are left out': () => {
    const forged = forgeAll(({place}) => place.at(-1) !== 0, () => [undefined]);
    return compareForged(forged, (what) => LEFT_OUT.includes(what.split(':')[0]));
  },

  'members that nobody knows': () => {
    const forged = forgeAll(({value}) => isObject(value), (value) => [{...value, wish: 1}]);
    return compareForged(forged, () => false);
  },

  'numbers below 0 are refused by the schema only if thread check refuses them': () => {
    const forged = forgeAll(({value}) => typeof value === 'number', (x) => [-1 - Math.abs(x)]);
    return compareForged(forged, () => true);
  },

  'faults of form are refused by both': () => judgeByHand(REFUSED, {schema: false, thread: false}),
  'what is no fault is accepted by both': () => judgeByHand(ACCEPTED, {schema: true, thread: true}),
  'what is well formed and not true is refused by thread check alone': () =>
    judgeByHand(UNTRUE, {schema: true, thread: false}),
  'units in capital letters are read, and are not in the schema': () =>
    judgeByHand([['.framework.units', 'MM']], {schema: false, thread: true}),
};

let passed = 0, failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    const note = test();
    if (note) console.log(`${name}: ${note}`);
    passed++;
  } catch (error) {
    failed++;
    console.log(`not so: ${name}\n    ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
