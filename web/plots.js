// Plots with Chart.js: a legend, colours of the theme, the value under the mouse, a cursor that follows the time.
import {play} from './motion.js';
import {short} from './report.js';
import {lastTime, tracks} from './runs.js';
import {colorOf, css, dashes, nameOf, on, settings} from './state.js';

/* global Chart */
const MOST_POINTS = 800;
const charts = [];

function axis(title, type) {
  return {
    type, title: {display: true, text: title, color: css('--text')},
    ticks: {color: css('--faint'), maxTicksLimit: 8, includeBounds: type === 'logarithmic',
            callback: (value) => (type !== 'logarithmic' ? String(Number(value.toPrecision(3))) :
              Math.abs(Math.log10(value) % 1) > 1e-9 ? '' : value < 1e-2 ? value.toExponential(0) : String(value))},
    grid: {color: css('--grid')},
  };
}

/** Makes a chart whose points are {x, y}. */
export function makeChart(id, {title, x, y, xType = 'linear', yType = 'linear', extra = []}) {
  const chart = new Chart(document.getElementById(id), {
    type: 'scatter',
    data: {datasets: []},
    options: {
      animation: false, responsive: true, maintainAspectRatio: false, normalized: true, parsing: false,
      showLine: true, elements: {point: {radius: 0}, line: {borderWidth: 2}},
      scales: {x: axis(x, xType), y: axis(y, yType)},
      interaction: {mode: 'nearest', intersect: false},
      plugins: {
        title: {display: true, text: title, color: css('--text')},
        tooltip: {callbacks: {label: ({dataset, raw}) => `${dataset.label}: ${short(raw.x, 4)}, ${short(raw.y, 4)}`}},
        legend: {position: 'bottom', labels: {
          boxWidth: 24, boxHeight: 0, color: css('--text'), filter: ({datasetIndex}, {datasets}) => !datasets[datasetIndex].unlabelled}},
      },
    },
    plugins: extra,
  });
  chart.canvas.setAttribute('aria-label', title);
  charts.push({chart, x, y, xType, yType});
  return chart;
}

export function setLines(chart, lines) {
  chart.data.datasets = lines;
  chart.update('none');
}

/** A line of one run. */
export const lineOf = (index, data, label = nameOf(settings.runs[index])) => ({
  data, label, borderColor: colorOf(index), backgroundColor: colorOf(index), borderDash: dashes[index],
  showLine: true,
});

function thinned(track, column, keep = () => true) {
  const {frame} = track.columns;
  const all = [];
  for (let i = 0; i < frame.length; ++i) if (frame[i] >= 0) all.push(i);
  const stride = Math.max(1, Math.ceil(all.length / MOST_POINTS));
  return all.filter((_, n) => n % stride === 0 || n === all.length - 1)
      .map((i) => ({x: track.times[i], y: column(track.columns, i)})).filter(({y}) => keep(y));
}

const totals = ({kinetic, gravity, spring}, i) => kinetic[i] + gravity[i] + spring[i];
let error, balance, energy;

export function start() {
  error = makeChart('plot-error', {title: 'Position error', x: 't in s', y: 'm', yType: 'logarithmic'});
  balance = makeChart('plot-balance',
    {title: 'Energy error (share of the energy scale)', x: 't in s', y: '1', yType: 'logarithmic'});
  energy = makeChart('plot-energy', {title: 'Energy', x: 't in s', y: 'J'});
  for (const chart of [error, balance, energy]) addCursor(chart);
  document.getElementById('energy').addEventListener('change', update);
  for (const event of ['run', 'scene', 'theme', 'tab']) on(event, update);
  on('samples', updateSoon);
  on('time', moveCursors);
}

let waiting = 0;
function updateSoon() {
  waiting ||= setTimeout(update, 200);
}

export function update() {
  clearTimeout(waiting);
  waiting = 0;
  if (settings.tab !== 'plots' || !error) return;
  const kind = document.getElementById('energy').value;
  const lines = (column, keep) => tracks.map((track, i) => (settings.runs[i] ?
    lineOf(i, thinned(track, column, keep)) : null)).filter(Boolean);
  const positive = (y) => y > 0 && y < Infinity;
  setLines(error, lines((c, i) => c.error[i], positive));
  setLines(balance, lines((c, i) => Math.abs(c.relativeResidual[i]), positive));
  setLines(energy, lines((c, i) => (kind === 'total' ? totals(c, i) : c[kind][i]), Number.isFinite));
  moveCursors();
}

function addCursor(chart) {
  const cursor = document.createElement('div');
  cursor.className = 'cursor';
  chart.canvas.parentElement.append(cursor);
  chart.cursor = cursor;
}

function moveCursors() {
  if (settings.tab !== 'plots') return;
  for (const {chart} of charts) {
    if (!chart.cursor || !chart.chartArea) continue;
    const {top, height} = chart.chartArea;
    const x = chart.scales.x.getPixelForValue(Math.min(play.time, lastTime()));
    chart.cursor.style.cssText = `top:${top}px;height:${height}px;transform:translateX(${x}px)`;
  }
}

on('theme', () => {
  for (const {chart, x, y, xType, yType} of charts) {
    const {scales, plugins} = chart.options;
    scales.x = {...scales.x, ...axis(x, xType)};
    scales.y = {...scales.y, ...axis(y, yType)};
    plugins.title.color = plugins.legend.labels.color = css('--text');
    chart.update('none');
  }
});

/** The plotted points of the three plots over time. */
export const values = () => Object.fromEntries(Object.entries({error, balance, energy}).map(
  ([name, chart]) => [name, chart ? chart.data.datasets.map(({label, data}) => ({label, data})) : []]));
