// Runs the settings: one worker and one track per run.
import {Cancelled, Library, setOwnMethods} from './library.js';
import {MOST_RUNS, described, methodOf, on, optionsOf, settings, tell} from './state.js';

const COLUMNS = ['time', 'frame', 'error', 'kinetic', 'gravity', 'spring', 'dissipated', 'relativeResidual'];
const MOST_BYTES = 3e8;  // of all runs
const MOST_STEPS = 2e5;  // times particles, of a run of which each step is kept
const LONG_CHAIN = 300;  // particles, from here on fewer pictures between the frames
const VERY_LONG_CHAIN = 2000;

/** What a run has computed so far: samples in the order of time. */
export class Track {
  times = [];
  states = [];  // 4 N numbers each: x, y, vx, vy
  truths = [];  // 2 N numbers each, as far as the true motion is known
  columns = Object.fromEntries(COLUMNS.map((name) => [name, []]));
  end = null;      // what the run says about itself
  failure = '';    // why there is no run
  progress = '';

  add({rows, states, truths}) {
    const count = rows.length / COLUMNS.length;
    const size = states.length / count;
    for (let i = 0; i < count; ++i) {
      COLUMNS.forEach((name, j) => this.columns[name].push(rows[i * COLUMNS.length + j]));
      this.times.push(rows[i * COLUMNS.length]);
      this.states.push(states.subarray(i * size, (i + 1) * size));
      if ((i + 1) * size / 2 <= truths.length && this.truths.length === this.times.length - 1) {
        this.truths.push(truths.subarray(i * size / 2, (i + 1) * size / 2));
      }
    }
  }

  get lastTime() {
    return this.times.at(-1) ?? 0;
  }

  /** The last sample that is not after a time. */
  indexAt(time) {
    let low = 0;
    let high = this.times.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time * (1 + 1e-12) + 1e-12) low = middle;
      else high = middle;
    }
    return low;
  }

  /** Positions at a time, interpolated between samples; null if there are none. */
  positionsAt(time, list = this.states) {
    if (list.length === 0) return null;
    const index = Math.min(this.indexAt(time), list.length - 1);
    const here = list[index];
    if (list === this.truths && time > this.times[list.length - 1] + 1e-9) return null;
    const next = list[index + 1];
    const span = this.times[index + 1] - this.times[index];
    if (!next || !(time > this.times[index])) return here;
    const share = Math.min(1, (time - this.times[index]) / span);
    const size = list === this.truths ? here.length : here.length / 2;
    const mixed = new Float64Array(size);
    for (let i = 0; i < size; ++i) mixed[i] = here[i] + share * (next[i] - here[i]);
    return mixed;
  }

  get diverged() {
    return this.end?.status === 3;
  }
}

export const tools = new Library();  // for short questions
export const scene = {x: [], y: [], m: [], vx: [], vy: [], failure: '', file: null};  // file: that was read
export const tracks = [];
const workers = Array.from({length: MOST_RUNS}, () => new Library());
let timer = 0;  // of a restart

/** Replaces the methods of the user; the library is loaded anew. */
export async function useOwnMethods(methods) {
  setOwnMethods(methods);
  for (const library of [...workers, tools]) library.cancel();
  const {methods: rows} = await tools.call('describe');
  described.methods = rows.map((row) => ({...row, own: methods.some((own) => own.name === row.name)}));
}

/** The true motion: of all runs the one that knows it longest. */
export function truthTrack() {
  return tracks.reduce((best, track) =>
    (track.truths.length && track.times[track.truths.length - 1] >
     (best?.times[best.truths.length - 1] ?? -1) ? track : best), null);
}

export const lastTime = () => Math.max(0, ...tracks.map((track) => track.lastTime));
export const running = () => workers.some((worker) => worker.busy);

function intervalOf(options) {
  const size = scene.x.length;
  if (size > VERY_LONG_CHAIN) return 0;
  const step = methodOf(options.method)?.fixed ? Number(options.time_step) : 0;
  if (step > 0 && options.frames * options.steps_per_frame * size <= MOST_STEPS) return step;
  return Math.max(step, size > LONG_CHAIN ? 1 / 30 : 1 / 120);
}

async function compute(run, index) {
  const track = new Track();
  tracks[index] = track;
  track.progress = 'starts';
  const options = optionsOf(run);
  const began = performance.now();
  const report = ({samples, frame, ends}) => {
    if (tracks[index] !== track) return;
    if (samples) track.add(samples);
    const done = frame ?? Math.max(...track.columns.frame.slice(-200));
    const seconds = Math.round((performance.now() - began) / 1000);
    track.progress = ends ? 'looks for a stable step' : `frame ${Math.max(0, done) + 1} of ${options.frames}, ${seconds} s`;
    tell(track.times.length > 0 ? 'samples' : 'progress', index);
  };
  if (workers[index].busy) workers[index].cancel();
  try {
    const small = scene.x.length <= VERY_LONG_CHAIN;
    const answer = workers[index].call('run', {
      settings: options, file: settings.file, interval: intervalOf(options), energies: small,
      texts: false, room: MOST_BYTES / settings.runs.length,
    }, report);
    tell('progress', index);
    track.end = await answer;
    if (track.end.full) {
      track.failure = `stopped at t = ${track.lastTime.toPrecision(4)} s: the page keeps at most ` +
        `${MOST_BYTES / 1e6} MB of motion; Exercise3 has no such limit`;
    }
  } catch (error) {
    if (tracks[index] !== track) return;
    track.failure = error instanceof Cancelled ? 'cancelled' : error.message;
  }
  track.progress = '';
  tell('run', index);
}

export function cancelRuns() {
  for (const worker of workers) if (worker.busy) worker.cancel();
}

/** Reads the particle file and computes all runs. */
export async function restart() {
  clearTimeout(timer);  // what was to restart soon starts now
  const {file} = settings;
  let read = null;
  let failure = '';
  try {
    read = {...await tools.call('scene', {file, interval: settings.interval}), file};
  } catch (error) {
    if (error instanceof Cancelled) return;
    failure = error.message;
  }
  if (file !== settings.file) return;  // changed meanwhile
  cancelRuns();
  Object.assign(scene, read ?? {}, {failure});
  tracks.length = 0;
  tell('scene');
  if (failure) return;
  await Promise.all(settings.runs.map(compute));
  tell('done');
}

/** Restarts soon; many changes at once restart only once. */
export function restartSoon() {
  clearTimeout(timer);
  timer = setTimeout(restart, 250);
}
on('settings', restartSoon);
