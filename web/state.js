// What the user has set. Everything here goes into the address, so that a link restores the page.

export const MOST_RUNS = 4;
export const MOST_STAGES = 16;  // of a method of the user
export const get = (id) => document.getElementById(id);
export const presets = Object.assign(Object.create(null), JSON.parse(get('scenes').textContent));
export const constants = ['stiffness', 'damping', 'rest_length', 'gravity'];
export const LONGEST_ADDRESS = 8000;  // characters of a particle file

export const described = {methods: [], options: []};  // filled by the library at the start
export const methodOf = (name) => described.methods.find((method) => method.name === name);
/** What sets the accuracy of a run. */
export const keyOf = (method) => (methodOf(method)?.fixed ?? true ? 'time_step' : 'tolerance');
export const defaultOf = (key) => described.options.find((option) => option.key === key).value;

/** The settings. Numbers stay the text that was typed: the library reads and judges them. */
export const settings = {};

export function setDefaults() {
  Object.assign(settings, {
    file: {name: 'horizontal_11.txt', text: presets['horizontal_11.txt']},
    frames: defaultOf('frames'),
    interval: defaultOf('frame_interval'),
    reference: defaultOf('reference'),
    runs: [newRun('Runge-Kutta-4'), newRun('Euler')],
    own: [],
    tab: 'plots',
  });
  for (const key of constants) settings[key] = defaultOf(key);
}

export function newRun(method) {
  return {method, time_step: defaultOf('time_step'), tolerance: defaultOf('tolerance')};
}

/** The options of Exercise3 for one run, without the particle file. */
export function optionsOf(run) {
  const options = {method: run.method, reference: settings.reference};
  for (const key of constants) options[key] = settings[key];
  if (keyOf(run.method) === 'tolerance') {
    const {frames, interval: frame_interval} = settings;
    return {...options, tolerance: run.tolerance, frame_interval, frames};
  }
  const interval = Number(settings.interval);
  const step = Number(run.time_step);
  const steps = Math.max(1, Math.round(interval / step));
  const duration = interval * (Number(settings.frames) - 1);
  const frames = Math.floor(duration / (steps * step) + 1e-9) + 1;
  const counted = Number.isSafeInteger(steps) && Number.isSafeInteger(frames) &&
                  /^\+?\d+$/.test(settings.frames);
  return {
    ...options,
    time_step: run.time_step,
    steps_per_frame: counted ? String(steps) : defaultOf('steps_per_frame'),
    frames: counted ? String(frames) : settings.frames,
  };
}

const colors = {
  light: ['#0059b3', '#c24e00', '#00795c', '#93307b'],
  dark: ['#5cb3ff', '#ffa14d', '#2fd0a5', '#ef8fd4'],
};  // after Okabe and Ito, told apart by the colour-blind; lines differ in dashes, too
export const dashes = [[], [7, 4], [2, 3], [10, 3, 2, 3]];
export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
export const theme = () => document.documentElement.dataset.theme;
export const colorOf = (index) => colors[theme()][index % MOST_RUNS];
export const nameOf = (run) =>
    `${run.method} ${run[keyOf(run.method)]} ${keyOf(run.method) === 'time_step' ? 's' : 'm'}`;

export function toAddress() {
  const words = new URLSearchParams();
  const {file} = settings;
  if (presets[file.name] === file.text) words.set('scene', file.name);
  else {
    words.set('name', file.name);
    words.set('particles', file.text.slice(0, LONGEST_ADDRESS + 1));  // one too many: it was cut
  }
  for (const key of [...constants, 'frames', 'interval', 'reference', 'tab']) {
    words.set(key, settings[key]);
  }
  for (const run of settings.runs) {
    words.append('run', `${run.method} ${run[keyOf(run.method)]}`);
  }
  if (settings.own.length > 0) words.set('own', JSON.stringify(settings.own));
  return `#${words}`;
}

/** Whether a link holds a tableau of bounded size; its numbers are judged later. */
function isTableau(own) {
  const isRow = (row) => Array.isArray(row) && row.length <= MOST_STAGES &&
                         row.every((entry) => typeof entry === 'string' && entry.length <= 40);
  return typeof own?.name === 'string' && own.name.length <= 40 && isRow(own.b) &&
         Array.isArray(own.a) && own.a.length <= MOST_STAGES && own.a.every(isRow);
}

/** Reads an address; what it does not name keeps its value. */
export function fromAddress(hash) {
  const words = new URLSearchParams(hash.replace(/^#/, ''));
  const scene = words.get('scene');
  if (presets[scene]) settings.file = {name: scene, text: presets[scene]};
  if (words.has('particles')) {
    const text = words.get('particles');
    const fits = text.length <= LONGEST_ADDRESS;
    settings.file = {name: words.get('name') || 'particle.txt',
                     text: fits ? text : `A link holds at most ${LONGEST_ADDRESS} characters of particles.\n`};
  }
  for (const key of [...constants, 'frames', 'interval', 'reference']) {
    if (words.has(key)) settings[key] = words.get(key);
  }
  if (get(`panel-${words.get('tab')}`)) settings.tab = words.get('tab');
  try {
    settings.own = [JSON.parse(words.get('own') ?? '[]')].flat().filter(isTableau).slice(0, MOST_RUNS);
  } catch { /* an address cut short: the method is left out */ }
  const runs = words.getAll('run').slice(0, MOST_RUNS).map((text) => {
    const [method, value] = text.split(' ');
    return {...newRun(method), [keyOf(method)]: value ?? ''};
  });
  if (runs.length > 0) settings.runs = runs;
}

// Modules tell each other what has changed.
const listeners = new Map();
export function on(event, listener) {
  listeners.set(event, [...(listeners.get(event) ?? []), listener]);
}
export function tell(event, detail) {
  for (const listener of listeners.get(event) ?? []) listener(detail);
}

/**
 * Returns a function that calls `show`, one call after the other. Calls that come meanwhile become one.
 * @param fail is called with an error of `show`
 */
export function oneAtATime(show, fail) {
  let busy = false;
  let again = false;
  return async function update() {
    again = busy;
    if (busy) return;
    busy = true;
    try {
      await show();
    } catch (error) {
      fail(error);
    }
    busy = false;
    if (again) update();
  };
}
