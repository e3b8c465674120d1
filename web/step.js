// One step of a method, written out with the numbers of one particle.
import {play, select} from './motion.js';
import {fillRuns, stateOf} from './stability.js';
import {scene, tools, tracks} from './runs.js';
import {methodOf, on, oneAtATime, optionsOf, settings} from './state.js';

/* global katex */
const choice = document.getElementById('step-run');
const particle = document.getElementById('step-particle');
const output = document.getElementById('step-text');

export function formula(tex) {
  const box = document.createElement('div');
  box.className = 'formula';
  katex.render(tex, box, {output: 'mathml', displayMode: false, throwOnError: false});
  return box;
}

export function paragraph(text, tag = 'p') {
  const element = document.createElement(tag);
  element.textContent = text;
  return element;
}

function number(value, digits = 5) {
  if (!Number.isFinite(value)) return '\\text{not finite}';
  const [mantissa, exponent] = value.toPrecision(digits).split('e');
  return exponent ? `${mantissa}\\cdot 10^{${Number(exponent)}}` : mantissa;
}
const vector = (values) => `(${values.map((value) => number(value)).join(',\\;')})`;

/** x, y, vx, vy of one particle. */
const pick = (flat, i) => [0, 1, 2, 3].map((column) => flat[column * flat.length / 4 + i]);

/** A coefficient as the fraction it is near to. */
export function fraction(value) {
  for (const bottom of [1, 2, 3, 4, 6, 8, 9, 12, 16, 27, 32]) {
    const top = Math.round(value * bottom);
    if (Math.abs(top / bottom - value) > 1e-14) continue;
    if (bottom === 1) return String(top);
    return `${top < 0 ? '-' : ''}\\tfrac{${Math.abs(top)}}{${bottom}}`;
  }
  return number(value, 6);
}

function sum(weights, open) {
  const terms = Array.from(weights).map((weight, j) => [weight, `k_{${j + 1}}`]).filter(([weight]) => weight !== 0);
  if (terms.length === 0) return 'z';
  const inner = terms.map(([weight, k], n) => {
    const text = weight === 1 ? k : weight === -1 ? `-${k}` : `${fraction(weight)}\\,${k}`;
    return n > 0 && !text.startsWith('-') ? `+${text}` : text;
  }).join('');
  return `z + ${open}${terms.length > 1 ? `\\left(${inner}\\right)` : inner}`;
}

/** The states of a particle and its neighbours at a stage: what its slope follows from. */
function neighbours(flat, i) {
  const table = document.createElement('table');
  const near = [i - 1, i, i + 1].filter((j) => j >= 0 && j < flat.length / 4);
  table.innerHTML = `<tr><th>i</th>${near.map((j) => `<th>${j + 1}</th>`).join('')}</tr>`;
  ['x', 'y', 'v_x', 'v_y'].forEach((name, column) => {
    const row = table.insertRow();
    row.innerHTML = `<th>${name}</th>`;
    for (const j of near) row.insertCell().textContent = pick(flat, j)[column].toPrecision(7);
  });
  return table;
}

/** The law of motion with its constants. */
function lawText(i) {
  const {stiffness, damping, rest_length: length, gravity} = settings;
  return [
    paragraph('A slope k = F(z) is the velocity of the particle and its acceleration a. With the spring from particle i to i + 1,'),
    formula('d = p_{i+1} - p_i,\\quad w = v_{i+1} - v_i'),
    formula('f_i = \\left(k_s\\,(|d| - L_0) + k_d\\,\\tfrac{d \\cdot w}{|d|}\\right)\\tfrac{d}{|d|}'),
    formula(i === 0 ? 'a_1 = 0' : 'a_i = \\tfrac{1}{m_i}(f_i - f_{i-1}) - (0, g),\\quad f_N = 0'),
    paragraph(`k_s = ${stiffness} N/m, k_d = ${damping} N s/m, L_0 = ${length} m, g = ${gravity} m/s², mass ${scene.m[i]} kg`),
  ];
}

function tableauText(method, step, i) {
  return [...step.slopes.flatMap((slope, stage) => [
    formula(`k_{${stage + 1}} = F(${stage === 0 ? 'z' : sum(method.a[stage].slice(0, stage), 'h')})`),
    neighbours(step.stages[stage], i), formula(`k_{${stage + 1}} = ${vector(pick(slope, i))}`),
  ]), formula(`z_{\\text{new}} = ${sum(method.b, 'h')}`)];
}

const atStart = 'a_{1} = a(p,\\; v)';
const formulas = {
  'Semi-Implicit-Euler': [atStart, 'v_{\\text{new}} = v + h\\,a_{1}', 'p_{\\text{new}} = p + h\\,v_{\\text{new}}'],
  'Velocity-Verlet': [atStart, 'p_{\\text{new}} = p + h\\,(v + \\tfrac{h}{2}\\,a_{1})', 'a_{2} = a(p_{\\text{new}},\\; v + h\\,a_{1})',
                      'v_{\\text{new}} = v + \\tfrac{h}{2}\\,(a_{1} + a_{2})'],
  'Backward-Euler': ['a_{2} = a(p_{\\text{new}},\\; v_{\\text{new}})', 'v_{\\text{new}} = v + h\\,a_{2}',
                     'p_{\\text{new}} = p + h\\,v_{\\text{new}}'],
};

function otherText(method, step, i) {
  const parts = [neighbours(step.stages[0], i)];
  for (const text of formulas[method.name] ?? [atStart]) {
    parts.push(formula(text));
    const stage = Number(/^a_\{(\d)/.exec(text)?.[1]);  // the acceleration of a stage
    if (stage > 1) parts.push(neighbours(step.stages[stage - 1], i));
    if (stage) parts.push(formula(`a_{${stage}} = ${vector(pick(step.slopes[stage - 1], i).slice(2))}`));
  }
  if (formulas[method.name]) return parts;
  return [...parts, paragraph(`${method.name} (${method.use}) chooses its steps itself. Its steps have no stages to show; this ` +
    'is the acceleration at the state, and the state after the time between frames:')];
}

let shown = null;  // the step on the page: stages, slopes, end
export const explained = () => shown && {
  stages: shown.stages.map((stage) => [...stage]), slopes: shown.slopes.map((slope) => [...slope]), end: [...shown.end],
};
const update = oneAtATime(show, (error) => output.replaceChildren(paragraph(error.message)));

async function show() {
  if (settings.tab !== 'step' || play.on) return;
  const index = Number(choice.value);
  const run = settings.runs[index];
  const method = run && methodOf(run.method);
  const h = method && Number(method.fixed ? run.time_step : settings.interval);
  // After the button step, the step that was just done.
  const from = play.stepped && index === 0 ? play.time - h : play.time;
  const state = stateOf(index, from);
  if (!method || !state || scene.x.length > 5000) {
    output.replaceChildren(paragraph(scene.x.length > 5000 ? 'This chain is too long to be explained.' : 'There is no run yet.'));
    return;
  }
  const size = scene.x.length;
  const i = Math.min(Math.max(Math.round(Number(particle.value)) || 1, 1), size) - 1;
  shown = await tools.call('step', {
    settings: optionsOf(run), masses: Array.from(scene.m), state: Array.from(state), h,
  });
  const text = method.a ? tableauText(method, shown, i) : otherText(method, shown, i);
  output.replaceChildren(
    paragraph(`${method.name}, from t = ${Number(tracks[index].times[tracks[index].indexAt(from)].toPrecision(6))} s with h = ${h} s, for ` +
      `particle i = ${i + 1}; p = (x, y) in m, v = (v_x, v_y) in m/s, z = (p, v).`), ...lawText(i), ...text,
    formula(`z_{\\text{new}} = ${vector(pick(shown.end, i))}`));
}

export function start() {
  choice.addEventListener('change', update);
  particle.addEventListener('change', () => select(Math.min(scene.x.length, Math.max(1, Number(particle.value) || 1)) - 1));
  on('selected', (i) => { if (i >= 0) particle.value = i + 1; update(); });
  on('runs', () => fillRuns(choice));
  for (const event of ['time', 'run', 'tab']) on(event, update);
  for (const id of ['play', 'step', 'frame']) document.getElementById(id).addEventListener('click', () => setTimeout(update, 50));
}
