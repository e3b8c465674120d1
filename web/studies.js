// Error against step size and work against error, measured for this scene with the chosen methods.
import {Cancelled, Library} from './library.js';
import {makeChart, setLines} from './plots.js';
import {short} from './report.js';
import {paragraph} from './step.js';
import {MOST_RUNS, colorOf, on, described, get, methodOf, optionsOf, newRun, settings, theme} from './state.js';

const FRAME = 0.5;       // s; about the largest step
const HALVINGS = 9;
const TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
const CHOSEN = ['Euler', 'Runge-Kutta-2', 'Runge-Kutta-4', 'Auto'];  // at the start
const ENOUGH = 1e-10;    // m, errors below are those of rounding
const styles = ['circle', 'triangle', 'rect', 'star', 'cross', 'rectRot', 'crossRot'];
let library = null;
let order, cost;
let rows = [];   // {method, points: [{setting, error, evaluations}], limit}
let changed = false;  // the scene, since the measurement began
/** The colour of the run with the method of a row, or one that no run has. */
const tint = (i) => {
  const names = [...settings.runs.map(({method}) => method), ...rows.map(({method}) => method.name)];
  const place = names.indexOf(rows[i].method.name);
  return place < MOST_RUNS ? colorOf(place) : `hsl(${(place * 137.5 + 300) % 360} 75% ${theme() === 'dark' ? 68 : 36}%)`;
};

function jobsOf(duration) {
  const intervals = Math.max(1, Math.round(duration / FRAME));
  const interval = duration / intervals, frames = intervals + 1;
  const boxes = [...document.querySelectorAll('#study-methods input')];
  return boxes.filter((box) => box.checked).map(({value}) => methodOf(value)).filter(Boolean).map((method) => ({
    method,
    settings: (method.fixed ?
      Array.from({length: HALVINGS + 1}, (_, n) => ({time_step: String(interval / 2 ** n), steps_per_frame: String(2 ** n)})) :
      TOLERANCES.map((tolerance) => ({tolerance: String(tolerance), frame_interval: String(interval)})))
        .map((sizes) => ({...optionsOf(newRun(method.name)), ...sizes, frames: String(frames)})),
  }));
}

async function measure() {
  const duration = Number(get('study-time').value);
  if (!(duration > 0 && duration <= 1000)) {
    get('study-note').textContent = 'The time must be a number above 0 and at most 1000 s.';
    return;
  }
  const jobs = jobsOf(duration);
  const total = jobs.reduce((sum, job) => sum + job.settings.length, 0);
  const progress = get('study-progress');
  Object.assign(progress, {max: total, value: 0, hidden: false});
  get('study').disabled = true;
  get('study-cancel').hidden = false;
  rows = [];
  changed = false;
  const {file} = settings;
  library = new Library();
  try {
    for (const {method, settings: list} of jobs) await measureMethod(method, list, file, duration, progress);
    const unmeasured = rows.reduce((sum, row) => sum + row.unmeasured, 0);
    get('study-note').textContent = (changed ? 'Measured before the last change.' : 'Done.') + (unmeasured === 0 ? '' :
      ` Runs whose true motion is known for a part of the time only are left out: ${unmeasured}.`);
  } catch (error) {
    get('study-note').textContent = error instanceof Cancelled ? 'Cancelled.' : error.message;
  }
  library.cancel();
  progress.hidden = get('study-cancel').hidden = true;
  get('study').disabled = false;
}

async function measureMethod(method, list, file, duration, progress) {
  const row = {method, points: [], limit: NaN, unmeasured: 0};
  rows.push(row);
  for (const options of list) {
    const setting = method.fixed ? options.time_step : options.tolerance;
    get('study-note').textContent = `${method.name} ${setting}`;
    try {
      const end = await library.call('measure', {settings: options, file});
      const isShort = end.status !== 3 && end.measuredUntil < duration - 1e-6;
      if (isShort) ++row.unmeasured;
      const error = end.resolved && !isShort ? end.largest : NaN;
      if (end.status !== 3 && error > ENOUGH) {
        row.points.push({setting: Number(setting), error, evaluations: end.evaluations});
      }
    } catch (error) {  // a tolerance below the rounding errors, for example
      if (error instanceof Cancelled) throw error;
      if (row.points.length === 0 && options === list[0]) row.failure = error.message;
    }
    ++progress.value;
    show();
  }
  if (!method.fixed) return;
  row.limit = await library.call('stableStep', {settings: list[5], file});
  show();
}

/** Slope of log error over log step through the smallest steps that are not near rounding. */
export function slopeOf(points) {
  const used = points.filter(({error}) => error > 100 * ENOUGH).slice(-3);
  if (used.length < 2) return NaN;
  const [first, last] = [used[0], used.at(-1)];
  return Math.log(first.error / last.error) / Math.log(first.setting / last.setting);
}

function show() {
  const style = (i) => ({
    borderColor: tint(i), backgroundColor: tint(i), pointStyle: styles[i % styles.length], pointRadius: 4,
  });
  const named = rows.map((row, i) => ({...row, i}));
  const fixed = named.filter(({method}) => method.fixed);
  setLines(order, [
    ...fixed.map(({method, points, i}) => ({
      label: method.name, ...style(i), data: points.map(({setting, error}) => ({x: setting, y: error})),
    })),
    ...fixed.filter(({limit, points}) => Number.isFinite(limit) && limit > 0 && points.length > 0).map(
      ({method, limit, points, i}) => ({
        label: `limit of ${method.name}`, unlabelled: true, borderColor: tint(i), borderDash: [2, 3], borderWidth: 1.5,
        data: [{x: limit, y: points.at(-1).error}, {x: limit, y: points[0].error}],
      })),
  ]);
  setLines(cost, named.map(({method, points, i}) => ({
    label: method.name, ...style(i), borderDash: method.fixed ? [] : [6, 3],
    data: points.map(({error, evaluations}) => ({x: error, y: evaluations})),
  })));
  showOrders(fixed);
}

function showOrders(fixed) {
  const table = get('orders');
  table.innerHTML = '<tr><th>method</th><th>order</th><th>measured</th><th>largest stable step</th></tr>';
  for (const {method, points, limit, failure} of fixed) {
    const row = table.insertRow();
    const texts = [method.name, method.order, failure ?? short(slopeOf(points), 3),
                   Number.isFinite(limit) ? `${short(limit, 3)} s` : limit === Infinity ? 'any' : ''];
    for (const text of texts) row.insertCell().textContent = text;
  }
}

export const results = () => rows.map(({method, points, limit}) =>
  ({method: method.name, points, limit, slope: slopeOf(points), order: methodOf(method.name)?.order}));

export function start() {
  order = makeChart('plot-order', {
    title: 'Largest position error against step size (dotted: stability limits)', x: 'step size in s', y: 'm',
    xType: 'logarithmic', yType: 'logarithmic',
  });
  cost = makeChart('plot-cost', {
    title: 'Work against error (dashed: error-controlled)', x: 'largest position error in m',
    y: 'evaluations of the forces', xType: 'logarithmic', yType: 'logarithmic',
  });
  const list = () => get('study-methods').replaceChildren(...described.methods.map(({name}) => {
    const label = paragraph(` ${name} `, 'label');
    label.prepend(Object.assign(document.createElement('input'),
                                {type: 'checkbox', value: name, checked: CHOSEN.includes(name)}));
    return label;
  }));
  list();
  on('own', list);
  get('study').addEventListener('click', measure);
  get('study-cancel').addEventListener('click', () => library?.cancel());
  for (const event of ['theme', 'runs']) on(event, show);
  on('scene', () => {
    changed = true;
    if (rows.length > 0 && !get('study').disabled) get('study-note').textContent = 'Measured before the last change.';
  });
}
