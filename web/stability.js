// The stability region of a method, and the eigenvalues of the scene times the step in it.
import {play} from './motion.js';
import {makeChart, setLines} from './plots.js';
import {short} from './report.js';
import {scene, tools, tracks} from './runs.js';
import {colorOf, css, methodOf, nameOf, on, oneAtATime, optionsOf, settings, theme} from './state.js';

const MOST_PARTICLES = 40;  // the eigenvalues of a longer chain take too long
const GRID = [320, 120];
const GROWING = 1e-12;  // ln |R| above rounding

/** Paints the region below the points: ln |R| at most 0. */
const painter = {
  id: 'region',
  beforeDatasetsDraw(chart) {
    if (!chart.region) return;
    const {x, y} = chart.scales;
    const {left, right, top, picture} = chart.region;
    const [px, py] = [x.getPixelForValue(left), y.getPixelForValue(top)];
    chart.ctx.save();
    chart.ctx.imageSmoothingEnabled = true;
    chart.ctx.drawImage(picture, px, py, x.getPixelForValue(right) - px, y.getPixelForValue(-top) - py);
    chart.ctx.restore();
  },
};

function pictureOf(growth) {
  const picture = document.createElement('canvas');
  [picture.width, picture.height] = [GRID[0], 2 * GRID[1] - 1];
  const context = picture.getContext('2d');
  const image = context.createImageData(picture.width, picture.height);
  const color = theme() === 'dark' ? [92, 179, 255] : [0, 89, 179];
  for (let row = 0; row < picture.height; ++row) {
    const from = Math.abs(row - (GRID[1] - 1)) * GRID[0];
    for (let i = 0; i < GRID[0]; ++i) {
      image.data.set([...color, growth[from + i] <= GROWING ? 90 : 0], 4 * (row * GRID[0] + i));
    }
  }
  context.putImageData(image, 0, 0);
  return picture;
}

export function makeRegionChart(id) {
  return makeChart(id, {
    title: 'Stability region (shaded) and hλ', x: 'real part of hλ', y: 'imaginary part of hλ',
    extra: [painter],
  });
}

/** ln |R| at points of the complex plane. */
const growthAt = (method, points) =>
  tools.call('growth', {method: method.name ?? method, points: points.flatMap(({x, y}) => [x, y])});

/**
 * Draws the region of a method and points hλ; both axes have the same scale.
 * @param method a row of the method table, or a tableau {a, b}
 * @param near whether to show the points alone
 */
export async function drawRegion(chart, method, points, color, near = false) {
  const least = near ? 1e-3 : 2.6;
  const bounded = (limit, most) => (near ? least :
    Math.max(least, Math.min(Number.isFinite(limit) ? limit : method.b?.length ?? 6, most)));
  let left = Math.min(-1.25 * bounded(method.realLimit, 40), ...points.map(({x}) => Math.max(1.1 * x, -60)));
  const up = 1.3 * Math.max(bounded(method.imaginaryLimit, 40), bounded(method.realLimit, 8), ...points.map(({y}) => Math.min(0.8 * y, 50)));
  chart.resize();  // it may just have appeared
  const {width, height} = chart.chartArea ?? {width: 1, height: 1};
  const unit = Math.max(-1.25 * left / width, 2 * up / height);  // per pixel
  left -= (unit * width + 1.25 * left) / 2;  // what is too wide, on both sides
  const [right, top] = [left + unit * width, unit * height / 2];
  const grid = Array.from({length: GRID[0] * GRID[1]}, (_, n) => ({
    x: left + (right - left) * (n % GRID[0]) / (GRID[0] - 1), y: top * Math.floor(n / GRID[0]) / (GRID[1] - 1),
  }));
  chart.region = {left, right, top, picture: pictureOf(await growthAt(method, grid))};
  Object.assign(chart.options.scales.x, {min: left, max: right});
  Object.assign(chart.options.scales.y, {min: -top, max: top});
  setLines(chart, [{data: points, showLine: false, pointRadius: 4, pointStyle: 'circle', borderColor: color,
                    backgroundColor: 'transparent', borderWidth: 1.5, label: 'hλ', unlabelled: true}]);
}

const choice = document.getElementById('stability-run');
const note = document.getElementById('stability-note');
const text = document.getElementById('stability-text');
const near = document.getElementById('stability-near');
let chart;

/** Fills a list of the runs, and keeps the chosen one. */
export function fillRuns(select) {
  const chosen = Math.min(Math.max(select.selectedIndex, 0), settings.runs.length - 1);
  select.replaceChildren(...settings.runs.map((run, i) => new Option(nameOf(run), i)));
  select.selectedIndex = chosen;
}

/** The state of a run at the time of the page, N×4 by columns. */
export function stateOf(index, time = play.time) {
  const track = tracks[index];
  return track?.states[track.indexAt(time)];
}

const update = oneAtATime(show, (error) => { text.textContent = error.message; });

async function show() {
  if (settings.tab !== 'stability') return;
  const index = Number(choice.value);
  const run = settings.runs[index];
  const method = run && methodOf(run.method);
  const state = stateOf(index);
  if (!method || !state) return;
  const step = method.fixed ? Number(run.time_step) : Number(settings.interval);
  const small = scene.x.length <= MOST_PARTICLES;
  const parts = small && state.every(Number.isFinite) ? await tools.call('eigenvalues', {
    settings: optionsOf(run), masses: Array.from(scene.m), state: Array.from(state),
  }) : [];
  const points = [];
  for (let i = 0; i < parts.length; i += 2) points.push({x: step * parts[i], y: step * parts[i + 1]});
  await drawRegion(chart, method, points, colorOf(index), near.checked);
  note.textContent = method.fixed ? `h = ${run.time_step} s, t = ${play.time.toFixed(2)} s` :
    `h = ${short(step, 3)} s, the time between frames; this method chooses shorter steps itself`;
  text.textContent = describe(method, points, points.length > 0 ? await growthAt(method, points) : [], small);
}

function describe(method, points, growth, small) {
  if (!small) return `Eigenvalues are drawn for at most ${MOST_PARTICLES} particles.`;
  if (points.length === 0) return 'A chain of one particle has no motion.';
  const far = points.reduce((a, b) => (Math.hypot(a.x, a.y) > Math.hypot(b.x, b.y) ? a : b));
  const growing = points.filter(({x}) => x > 1e-6).length;
  const isKnown = ({y}) => !method.symplectic || y !== 0;
  const known = points.filter(isKnown).length;
  const outside = points.filter((point, i) => isKnown(point) && point.x <= 1e-6 && growth[i] > 1e-9).length;
  const unknown = known < points.length ? `; it does not tell whether the ${points.length - known} points on the real axis grow` : '';
  const kind = method.symplectic ? ` The region of a symplectic method is that of an oscillator${unknown}.` :
    Number.isFinite(method.realLimit) ? '' : ' This method is stable wherever the motion itself decays.';
  return `${outside} of ${known} points are outside. The farthest point hλ is at ${short(far.x, 3)} ${far.y < 0 ? '−' : '+'} ` +
    `${short(Math.abs(far.y), 3)} i; half the step halves its distance from 0. Points inside the region decay or keep ` +
    'their size, points outside grow with every step.' +
    (growing ? ` ${growing} points lie right of the axis: there the motion itself, not the method, spreads apart.` : '') +
    kind;
}

export function start() {
  chart = makeRegionChart('plot-stability');
  for (const element of [choice, near]) element.addEventListener('change', update);
  on('runs', () => fillRuns(choice));
  for (const event of ['time', 'run', 'tab', 'theme']) on(event, update);
}
