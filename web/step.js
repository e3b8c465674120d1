// One step of a method, written out with the numbers of one particle.
import {play, select, showArrows} from './motion.js';
import {fillRuns, stateOf} from './stability.js';
import {scene, tools, tracks} from './runs.js';
import {colorOf, methodOf, on, oneAtATime, optionsOf, settings} from './state.js';

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

function tableauText(method, step, i) {
  const parts = [paragraph('Every slope k is F at a state: the velocity of the particle, and its acceleration.')];
  step.slopes.forEach((slope, stage) => {
    parts.push(formula(`k_{${stage + 1}} = F(${stage === 0 ? 'z' : sum(method.a[stage].slice(0, stage), 'h')})
      = F${vector(pick(step.stages[stage], i))} = ${vector(pick(slope, i))}`));
  });
  parts.push(formula(`z_{\\text{new}} = ${sum(method.b, 'h')} = ${vector(pick(step.end, i))}`));
  return parts;
}

const symplectic = {
  'Semi-Implicit-Euler': ['v_{\\text{new}} = v + h\\,a(p, v)', 'p_{\\text{new}} = p + h\\,v_{\\text{new}}'],
  'Velocity-Verlet': ['v_{1/2} = v + \\tfrac h2\\,a(p, v)', 'p_{\\text{new}} = p + h\\,v_{1/2}',
                      'v_{\\text{new}} = v_{1/2} + \\tfrac h2\\,a(p_{\\text{new}})'],
};

function otherText(method, step, i) {
  const [x, y, ax, ay] = pick(step.slopes[0], i);
  const parts = [formula(`v = ${vector([x, y])},\\quad a(p, v) = ${vector([ax, ay])}`)];
  if (symplectic[method.name]) parts.push(...symplectic[method.name].map(formula));
  else {
    parts.push(paragraph(`${method.name} (${method.use}) chooses its steps itself. Its steps have no stages to show; this is ` +
      'the slope at the state, and the state after the time between frames:'));
  }
  parts.push(formula(`z_{\\text{new}} = ${vector(pick(step.end, i))}`));
  return parts;
}

function arrowsOf(step, method, i) {
  return step.slopes.slice(0, 6).map((slope, stage) => {
    const [x, y] = pick(step.stages[stage], i);
    const [dx, dy] = pick(slope, i);
    return {x, y, dx, dy, color: colorOf(stage), label: `k${stage + 1}`};
  });
}

const update = oneAtATime(show, (error) => output.replaceChildren(paragraph(error.message)));

async function show() {
  if (settings.tab !== 'step') {
    showArrows([]);
    return;
  }
  if (play.on) return;
  const index = Number(choice.value);
  const run = settings.runs[index];
  const method = run && methodOf(run.method);
  const state = stateOf(index);
  if (!method || !state || scene.x.length > 5000) {
    output.replaceChildren(paragraph(scene.x.length > 5000 ? 'This chain is too long to be explained.' : 'There is no run yet.'));
    return;
  }
  const size = scene.x.length;
  const i = Math.min(Math.max(Math.round(Number(particle.value)) || 1, 1), size) - 1;
  const options = optionsOf(run);
  const h = method.fixed ? run.time_step : settings.interval;
  const track = tracks[index];
  const step = await tools.call('step', {
    settings: options, masses: Array.from(scene.m), state: Array.from(state), h: Number(h),
  });
  const explained = method.a ? tableauText(method, step, i) : otherText(method, step, i);
  output.replaceChildren(
    paragraph(`${method.name}, from t = ${track.times[track.indexAt(play.time)].toPrecision(6)} s with h = ` +
      `${h} s. All numbers of particle ${i + 1} in the order x, y (m), v_x, v_y (m/s); slopes per second.`),
    formula(`z = ${vector(pick(state, i))}`), ...explained);
  showArrows(arrowsOf(step, method, i));
}

export function start() {
  choice.addEventListener('change', update);
  particle.addEventListener('change', () => select(Math.min(scene.x.length, Math.max(1, Number(particle.value) || 1)) - 1));
  on('selected', (i) => { if (i >= 0) particle.value = i + 1; update(); });
  on('runs', () => fillRuns(choice));
  for (const event of ['time', 'run', 'tab']) on(event, update);
  for (const id of ['play', 'step', 'frame']) document.getElementById(id).addEventListener('click', () => setTimeout(update, 50));
}
