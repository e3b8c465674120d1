// The table of runs, and sentences on what happened.
import {cancelRuns, running, scene, tracks} from './runs.js';
import {paragraph} from './step.js';
import {MOST_RUNS, colorOf, described, keyOf, methodOf, nameOf, newRun, on, settings, tell} from './state.js';

const body = document.querySelector('#runs tbody');
const list = document.getElementById('sentences');
const cancel = document.getElementById('cancel');
const addRun = document.getElementById('add-run');
export const short = (value, digits = 2) =>
  (Number.isFinite(value) ? String(Number(Number(value).toPrecision(digits))) : 'not known');

const cell = (row, content) => {
  const element = row.insertCell();
  element.append(content);
  return element;
};

function swatch(index) {
  const line = document.createElement('span');
  line.className = 'swatch';
  line.style.borderTop = `3px ${['solid', 'dashed', 'dotted', 'dashed'][index]} ${colorOf(index)}`;
  return line;
}

function choiceOf(run) {
  const select = document.createElement('select');
  select.setAttribute('aria-label', 'method');
  select.append(...described.methods.map(({name}) => new Option(name)));
  if (!methodOf(run.method)) select.append(new Option(run.method));
  select.value = run.method;
  select.addEventListener('change', () => { run.method = select.value; changed(); });
  return select;
}

function sizeOf(run) {
  const input = document.createElement('input');
  const key = keyOf(run.method);
  input.value = run[key];
  input.inputMode = 'decimal';
  input.setAttribute('aria-label', key === 'time_step' ? 'step size in s' : 'tolerance in m');
  input.addEventListener('change', () => { run[key] = input.value.trim(); changed(); });
  const label = document.createElement('span');
  const half = document.createElement('button');
  half.textContent = key === 'time_step' ? '½' : '⅒';
  half.title = key === 'time_step' ? 'Halve the step' : 'A tenth of the tolerance';
  half.addEventListener('click', () => {
    run[key] = String(Number((Number(run[key]) / (key === 'time_step' ? 2 : 10)).toPrecision(12)));
    changed();
  });
  label.append(input, key === 'time_step' ? ' s ' : ' m ', half);
  return label;
}

function changed() {
  showRuns();
  tell('settings');
}

/** Builds the rows anew; `showResults` fills them. */
export function showRuns() {
  body.replaceChildren();
  settings.runs.forEach((run, index) => {
    const row = body.insertRow();
    cell(row, swatch(index));
    cell(row, choiceOf(run));
    cell(row, sizeOf(run));
    for (let i = 3; i < 7; ++i) row.insertCell().title = document.querySelectorAll('#runs th')[i].textContent;
    const remove = document.createElement('button');
    remove.textContent = '×';
    remove.title = `Remove ${nameOf(run)}`;
    remove.disabled = settings.runs.length === 1;
    remove.addEventListener('click', () => { settings.runs.splice(index, 1); changed(); });
    cell(row, remove);
  });
  addRun.disabled = settings.runs.length >= MOST_RUNS;
  tell('runs');
  showResults();
}

const errorText = (end) => (end.largest > 0 && end.resolved ? `${short(end.largest)} m` :
  end.bound >= 0 ? `below ${short(end.bound)} m` : 'not checked');

export function showResults() {
  [...body.rows].forEach((row, index) => {
    const track = tracks[index];
    const texts = ['', '', '', ''];
    if (track?.end && !track.failure) {
      const {end} = track;
      texts[0] = end.kind;
      texts[1] = errorText(end);
      texts[2] = track.columns.relativeResidual.some(Number.isFinite) ? short(end.energyError) : 'not checked';
      texts[3] = end.evaluations.toLocaleString('en');
      row.cells[3].title = [end.text, end.measurements, end.report, ...end.messages].join('\n');
    } else if (track) {
      texts[0] = track.failure || track.progress;
    }
    texts.forEach((text, i) => { row.cells[3 + i].textContent = text; });
    row.cells[3].className = track?.failure || track?.end?.bad ? 'problem' : '';
  });
  cancel.hidden = !running();
  list.replaceChildren(...sentences().map((text) => paragraph(text, 'li')));
}

/** What happened, why as far as that is measured, what the library says about it, and what to try next. */
export function sentences() {
  const ended = settings.runs.map((run, i) => ({run, track: tracks[i], method: methodOf(run.method)}))
      .filter(({track, method}) => track?.end && !track.failure && method);
  if (ended.length === 0 || scene.failure) return [];
  const diverged = ended.filter(({track}) => track.diverged);
  const others = ended.filter(({track}) => !track.diverged);
  const what = [
    ...diverged.map(({run, track}) => `${nameOf(run)} diverges at t = ${short(track.end.time, 3)} s`),
    ...others.map(({run, track: {end}}) => (end.bad || end.kind === 'sensitive' || !(end.bound >= 0) ?
      `${nameOf(run)} ends with the verdict "${end.kind}"` :
      `${nameOf(run)} stays within ${short(end.bound)} m of the true motion` +
        (end.kind === 'ok' ? '' : ` until t = ${short(end.measuredUntil, 3)} s; later it was not measured`))),
  ].join('; ');
  const said = ended.flatMap(({run, track: {end}}) => end.messages.map((text) => `${nameOf(run)}: ${text}.`));
  const hopeful = others.filter(({track: {end}}) => ![end.kind, ...end.messages].some((text) => /sensitive/.test(text)));
  const next = hopeful.find(({track}) => track.end.bad) ?? hopeful[0];
  return [`${what}.`, why(ended, diverged), ...said, next ? remedy(next) : ''].filter(Boolean);
}

function why(ended, diverged) {
  const grown = ended.filter(({track}) => track.end.kind === 'gained energy');
  const blamed = diverged[0] ?? grown[0];
  if (blamed?.method.fixed && Number.isFinite(blamed.method.imaginaryLimit)) {
    return `Where an hλ of the chain lies outside the stability region of ${blamed.method.name}, ` +
      (blamed.method.imaginaryLimit === 0 ? 'which leaves out all undamped swings, ' : '') +
      'that motion grows with every step: energy enters the chain that no force has put there.';
  }
  const fixed = ended.filter(({method, track}) => method.fixed && track.end.largest > 0 && track.end.resolved);
  if (blamed || fixed.length < 2) return '';
  fixed.sort((a, b) => a.track.end.largest - b.track.end.largest);
  const best = fixed[0], worst = fixed.at(-1);
  return `The largest error of ${nameOf(worst.run)} is ${short(worst.track.end.largest / best.track.end.largest)} ` +
    `times that of ${nameOf(best.run)}.`;
}

function remedy({run, method, track: {end}}) {
  if (!method.fixed) return `Try a tolerance ten times smaller, and compare the evaluations of ${method.name}.`;
  if (end.bound >= 0 && !end.resolved) return `The error of ${nameOf(run)} is below what the reference run resolves: a smaller step shows nothing.`;
  return `Once the step is small enough, half of it divides the error of ${method.name} (order ${method.order}) by about ` +
    `${2 ** method.order} and doubles its work: try ${short(Number(run.time_step) / 2, 6)} s.`;
}

export function start() {
  addRun.addEventListener('click', () => {
    settings.runs.push(newRun(described.methods.find(
      ({name}) => !settings.runs.some((run) => run.method === name))?.name ?? 'Auto'));
    changed();
  });
  cancel.addEventListener('click', cancelRuns);
  for (const event of ['run', 'progress', 'scene', 'done']) on(event, showResults);
  let waiting = 0;
  on('samples', () => {
    waiting ||= setTimeout(() => { waiting = 0; showResults(); }, 150);
  });
  for (const event of ['theme', 'own']) on(event, showRuns);
}
