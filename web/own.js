// A Butcher tableau of one's own: order conditions, stability region, and a run with it.
import {Cancelled} from './library.js';
import {drawRegion, makeRegionChart} from './stability.js';
import {formula, fraction} from './step.js';
import {tools, useOwnMethods} from './runs.js';
import {MOST_RUNS, MOST_STAGES, get, newRun, on, settings, tell} from './state.js';

const kept = {
  'Heun': {a: [[], ['1']], b: ['1/2', '1/2']},
  'Ralston': {a: [[], ['2/3']], b: ['1/4', '3/4']},
  'Kutta-3': {a: [[], ['1/2'], ['-1', '2']], b: ['1/6', '2/3', '1/6']},
  '3/8 rule': {a: [[], ['1/3'], ['-1/3', '1'], ['1', '-1', '1']], b: ['1/8', '3/8', '3/8', '1/8']},
  'wrong Runge-Kutta-4': {a: [[], ['1/2'], ['0', '1/2'], ['0', '0', '1']], b: ['1/4', '1/4', '1/4', '1/4']},
};
const table = get('tableau');
const note = get('own-note');
let chart;
let tableau = null;  // texts: {a, b}

/** A number or a fraction such as -1/3; NaN if it is neither. */
export function valueOf(text) {
  const parts = String(text).trim().split('/');
  if (parts.length > 2 || parts.some((part) => part.trim() === '')) return NaN;
  return parts.length === 1 ? Number(parts[0]) : Number(parts[0]) / Number(parts[1]);
}

const numbersOf = ({a, b}) => ({
  a: b.map((_, i) => b.map((__, j) => (j < i ? valueOf(a[i]?.[j] ?? '0') : 0))), b: b.map(valueOf),
});

function input(text, label, change) {
  const field = document.createElement('input');
  field.value = text;
  field.setAttribute('aria-label', label);
  field.addEventListener('input', () => { change(field.value); judge(); });
  return field;
}

function show() {
  table.replaceChildren();
  const {a, b} = tableau;
  b.forEach((_, i) => {
    const row = table.insertRow();
    row.insertCell().id = `node-${i}`;
    b.forEach((__, j) => {
      const cell = row.insertCell();
      if (j < i) cell.append(input(a[i][j] ?? '0', `a ${i + 1} ${j + 1}`, (text) => { a[i][j] = text; }));
    });
  });
  const row = table.insertRow();
  row.insertCell();
  b.forEach((text, i) => row.insertCell().append(input(text, `b ${i + 1}`, (value) => { b[i] = value; })));
  get('own-stages').value = b.length;
  judge();
}

function resize(stages) {
  const count = Math.min(MOST_STAGES, Math.max(1, Math.round(Number(stages)) || 1));
  const {a, b} = tableau;
  tableau.b = Array.from({length: count}, (_, i) => b[i] ?? '0');
  tableau.a = Array.from({length: count}, (_, i) => Array.from({length: i}, (__, j) => a[i]?.[j] ?? '0'));
  show();
}

/** The left side of an order condition, from its rooted tree. */
function leftSide(tree) {
  let used = 0;
  const weight = (branches, index) => {
    const leaves = branches.filter((branch) => branch.length === 0).length;
    const power = leaves === 0 ? '' : `c_${index}${leaves > 1 ? `^${leaves}` : ''}`;
    return power + branches.filter((branch) => branch.length > 0).map((branch) => {
      const inner = 'ijklm'[++used];
      return `\\textstyle\\sum_${inner} a_{${index}${inner}} ${weight(branch, inner)}`;
    }).join('');
  };
  return `\\textstyle\\sum_i b_i ${weight(tree, 'i')}`;
}

const holds = ({left, density}) => Math.abs(left - 1 / density) < 1e-12;

/** The order: all conditions up to it hold. At most 5, as far as they are checked. */
function orderOf(conditions) {
  const failed = conditions.filter((condition) => !holds(condition)).map(({order}) => order);
  return Math.min(6, ...failed) - 1;
}

let judged = 0;
async function judge() {
  if (!tableau || settings.tab !== 'own') return;
  const turn = ++judged;
  const {a, b} = numbersOf(tableau);
  const bad = [...a.flat(), ...b].some((value) => !Number.isFinite(value));
  note.textContent = bad ? 'Each entry must be a number or a fraction such as 1/3.' : '';
  get('own-run').disabled = bad;
  if (bad) return;
  a.forEach((row, i) => {
    get(`node-${i}`).replaceChildren(formula(fraction(row.reduce((sum, value) => sum + value, 0))));
  });
  try {
    const conditions = await tools.call('orders', {a, b});
    if (turn !== judged) return;
    showConditions(conditions);
    await drawRegion(chart, {a, b}, [], '#000');
  } catch (error) {
    note.textContent = error.message;
  }
}

function showConditions(conditions) {
  const order = orderOf(conditions);
  const shown = conditions.filter((condition) => condition.order <= Math.min(5, Math.max(order + 1, 2)));
  const body = document.createElement('tbody');
  const title = body.insertRow();
  title.innerHTML = '<th>order</th><th>condition</th><th>value</th><th></th>';
  for (const condition of shown) {
    const row = body.insertRow();
    row.insertCell().textContent = condition.order;
    row.insertCell().append(formula(`${leftSide(condition.tree)} = \\tfrac{1}{${condition.density}}`));
    row.insertCell().textContent = String(Number(condition.left.toPrecision(6)));
    const ok = row.insertCell();
    ok.textContent = holds(condition) ? '✓ holds' : '✗ fails';
    ok.className = holds(condition) ? 'ok' : 'not-ok';
  }
  get('conditions').replaceChildren(body);
  get('own-run').disabled = order === 0;
  note.textContent = order === 0 ? 'The weights b do not add up to 1: the method does not even follow a constant velocity.' :
    `This method has order ${order}${order === 5 ? ' or more' : ''}.`;
}

const numbered = (methods) => methods.map(({name, ...texts}) => ({name, ...numbersOf(texts)}));

/** Registers methods, or those of before if the library refuses one. Returns whether it took them. */
export async function register(methods, before = []) {
  try {
    await useOwnMethods(numbered(methods));
    settings.own = methods;
    return true;
  } catch (error) {
    if (error instanceof Cancelled) return false;  // other methods have replaced these
    await useOwnMethods(numbered(before));
    settings.own = before;
    note.textContent = error.message;
    tell('settings');  // the runs were cancelled
    return false;
  }
}

async function run() {
  const name = get('own-name').value.trim().replace(/\s+/g, '-') || 'Own';
  const isInTable = settings.runs.some((run) => run.method === name);
  const runs = isInTable ? settings.runs : settings.runs.slice(0, MOST_RUNS - 1);
  const others = settings.own.filter((method) => method.name !== name);
  const unused = others.findIndex((method) => !runs.some((run) => run.method === method.name));
  if (others.length >= MOST_RUNS) others.splice(unused, 1);
  if (!await register([...others, {name, ...structuredClone(tableau)}], settings.own)) return;
  note.textContent = `${name} is in the table of runs.`;
  settings.runs = isInTable ? runs : [...runs, newRun(name)];
  tell('own');
  tell('settings');
}

export function start() {
  chart = makeRegionChart('plot-own');
  const preset = get('own-preset');
  preset.append(...Object.keys(kept).map((name) => new Option(name)));
  const choose = () => {
    tableau = structuredClone(kept[preset.value]);
    get('own-name').value = preset.value.replace(/[ /]/g, '-');
    show();
  };
  preset.addEventListener('change', choose);
  get('own-stages').addEventListener('change', ({target}) => resize(target.value));
  get('own-run').addEventListener('click', run);
  on('tab', (tab) => {
    if (tab !== 'own') return;
    if (tableau) judge();
    else if (settings.own.length > 0) {
      const {name, ...texts} = settings.own.at(-1);
      tableau = structuredClone(texts);
      get('own-name').value = name;
      resize(tableau.b.length);  // a link may leave out rows of a
    } else choose();
  });
  on('theme', judge);
}
