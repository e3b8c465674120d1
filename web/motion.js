// The motion on a canvas, its buttons, and the particles as something to drag.
import {lastTime, scene, tracks, truthTrack} from './runs.js';
import {colorOf, css, dashes, methodOf, nameOf, on, settings, tell} from './state.js';

const canvas = document.getElementById('motion');
const context = canvas.getContext('2d');
const slider = document.getElementById('time');
const clock = document.getElementById('clock');
const playButton = document.getElementById('play');
const SLIDER_STEPS = 10000;
const DOTS = 400;  // longer chains are drawn as lines

export const play = {time: 0, on: false, speed: 1, selected: -1, pictures: 0, firstPicture: null};
let arrows = [];     // of the step that is explained: {x, y, dx, dy, color, label}
let wrong = null;    // frames of a student: {positions: (time) => Float64Array or null, particle}
let view = {x: 0, y: 0, scale: 40, fitted: false, own: false};  // own: chosen by the user
let dirty = true;
const touches = new Map();
let drag = null;

export const redraw = () => { dirty = true; };
export function showArrows(list) { arrows = list; redraw(); }
export function showFrames(frames) { wrong = frames; redraw(); }

export function seek(time) {
  play.time = Math.max(0, Math.min(lastTime(), Number.isFinite(time) ? time : 0));
  redraw();
  tell('time', play.time);
}

export function setPlaying(playing) {
  if (playing && play.time >= lastTime() - 1e-9) seek(0);
  play.on = playing;
  playButton.textContent = playing ? '❚❚' : '▶';
  playButton.title = playing ? 'Pause (space)' : 'Play (space)';
}

/** The size of the first run's step, or of its frame. */
const stepOf = (run) => (methodOf(run.method)?.fixed ? Number(run.time_step) : Number(settings.interval));

/** The box around the true motion, or around the scene as long as there is none: left, right, bottom, top. */
function reach() {
  const size = scene.x.length;
  const list = truthTrack()?.truths ?? [];
  const stride = Math.max(1, Math.ceil(list.length * size / 20000));
  const box = [Infinity, -Infinity, Infinity, -Infinity];
  const include = (x, y) => {
    box[0] = Math.min(box[0], x);
    box[1] = Math.max(box[1], x);
    box[2] = Math.min(box[2], y);
    box[3] = Math.max(box[3], y);
  };
  for (let i = 0; i < size; ++i) include(scene.x[i], scene.y[i]);
  for (let n = 0; n < list.length; n += stride) {
    for (let i = 0; i < size; ++i) include(list[n][i], list[n][size + i]);
  }
  return box;
}

function fit() {
  if (scene.x.length === 0) return;
  const [left, right, bottom, top] = reach();
  const cells = cellsOf(settings.runs.length);
  const margin = 60 * devicePixelRatio;
  const scaleOf = (pixels, length) => Math.max(50, pixels - margin) / Math.max(length, 1e-9);
  view = {
    x: (left + right) / 2, y: (bottom + top) / 2, fitted: true, own: false,
    scale: Math.min(scaleOf(canvas.width / cells[0], right - left), scaleOf(canvas.height / cells[1], top - bottom)),
  };
}

const cellsOf = (count) =>
  (settings.layout === 'side' && count > 1 ? [2, Math.ceil(count / 2)] : [1, 1]);

function cellAt(index) {
  const [columns, rows] = cellsOf(settings.runs.length);
  const width = canvas.width / columns;
  const height = canvas.height / rows;
  const cell = columns === 1 ? 0 : index;
  return {left: (cell % columns) * width, top: Math.floor(cell / columns) * height, width, height};
}

const toScreen = (cell, x, y) => [
  cell.left + cell.width / 2 + (x - view.x) * view.scale,
  cell.top + cell.height / 2 - (y - view.y) * view.scale,
];

// The multiples of a unit between two numbers, at most 1,000: far from the origin, adding a unit may not
// change a number.
export function gridLines(low, high, unit) {
  const first = Math.ceil(low / unit);
  const count = Math.min(1000, Math.ceil(high / unit) - first);
  return count > 0 ? Array.from({length: count}, (_, k) => (first + k) * unit) : [];
}

function drawGrid(cell) {
  const wanted = 80 * devicePixelRatio / view.scale;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const unit = power * [1, 2, 5, 10].find((factor) => factor * power >= wanted);
  context.strokeStyle = css('--grid');
  context.fillStyle = css('--faint');
  context.lineWidth = 1;
  context.beginPath();
  const half = [cell.width / view.scale / 2, cell.height / view.scale / 2];
  for (const x of gridLines(view.x - half[0], view.x + half[0], unit)) {
    const [px] = toScreen(cell, x, 0);
    context.moveTo(px, cell.top);
    context.lineTo(px, cell.top + cell.height);
  }
  for (const y of gridLines(view.y - half[1], view.y + half[1], unit)) {
    const [, py] = toScreen(cell, 0, y);
    context.moveTo(cell.left, py);
    context.lineTo(cell.left + cell.width, py);
  }
  context.stroke();
  context.fillText(`grid: ${Number(unit.toPrecision(1))} m`, cell.left + 8, cell.top + cell.height - 8);
}

function drawChain(cell, positions, style) {
  const size = scene.x.length;
  context.strokeStyle = style.color;
  context.fillStyle = style.color;
  context.lineWidth = style.width * devicePixelRatio;
  context.setLineDash(style.dash.map((length) => length * devicePixelRatio));
  context.lineJoin = 'round';
  context.beginPath();
  for (let i = 0; i < size; ++i) {
    const [x, y] = toScreen(cell, positions[i], positions[size + i]);
    const px = Math.max(-1e5, Math.min(1e5, x));
    const py = Math.max(-1e5, Math.min(1e5, y));
    if (i === 0) context.moveTo(px, py);
    else context.lineTo(px, py);
  }
  context.stroke();
  context.setLineDash([]);
  if (!style.dots || size > DOTS) return;
  for (let i = 0; i < size; ++i) {
    const [x, y] = toScreen(cell, positions[i], positions[size + i]);
    context.beginPath();
    if (i === 0) context.rect(x - style.dots, y - style.dots, 2 * style.dots, 2 * style.dots);
    else context.arc(x, y, Math.max(2, style.dots * Math.min(2.5, Math.cbrt(scene.m[i] || 1))), 0, 7);
    context.fill();
    if (i !== play.selected) continue;
    context.lineWidth = 2 * devicePixelRatio;
    context.strokeStyle = css('--text');
    context.beginPath();
    context.arc(x, y, 2.2 * style.dots, 0, 7);
    context.stroke();
  }
}

function drawArrows(cell) {
  for (const {x, y, dx, dy, color, label} of arrows) {
    const [px, py] = toScreen(cell, x, y);
    const length = Math.hypot(dx, dy);
    if (!(length > 0)) continue;
    const pixels = Math.min(90, 25 + 8 * length) * devicePixelRatio;
    const ex = px + (dx / length) * pixels;
    const ey = py - (dy / length) * pixels;
    const angle = Math.atan2(ey - py, ex - px);
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = 2 * devicePixelRatio;
    context.beginPath();
    context.moveTo(px, py);
    context.lineTo(ex, ey);
    for (const side of [-0.4, 0.4]) {
      context.moveTo(ex, ey);
      context.lineTo(ex - 9 * devicePixelRatio * Math.cos(angle + side),
                     ey - 9 * devicePixelRatio * Math.sin(angle + side));
    }
    context.stroke();
    context.fillText(label, ex + 4, ey - 4);
  }
}

function drawRun(index) {
  const cell = cellAt(index);
  const track = tracks[index];
  const run = settings.runs[index];
  if (!track || !run) return;
  const positions = track.positionsAt(play.time);
  if (!positions) return;
  const broken = track.diverged && play.time >= track.lastTime - 1e-9;
  const alone = settings.runs.length === 1;
  let color = colorOf(index);
  if (alone && track.end?.bad) color = css('--doubt');
  if (alone && broken) color = css('--diverged');
  drawChain(cell, positions, {
    color, width: 2.2, dash: broken && !alone ? [3, 6] : dashes[index], dots: 3.4 * devicePixelRatio,
  });
  const line = settings.layout === 'side' && !alone ? 0 : index;
  context.fillStyle = color;
  context.fillText(nameOf(run) + (broken ? `: diverged at ${track.lastTime.toPrecision(4)} s` : ''),
                   cell.left + 10, cell.top + 20 * devicePixelRatio * (line + 1));
}

function draw() {
  const width = Math.round(canvas.clientWidth * devicePixelRatio);
  const height = Math.round(canvas.clientHeight * devicePixelRatio);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    view.fitted = false;
  }
  if (!view.fitted) fit();
  context.clearRect(0, 0, width, height);
  context.font = `${13 * devicePixelRatio}px system-ui, sans-serif`;
  const truth = truthTrack();
  const cells = settings.layout === 'side' && settings.runs.length > 1 ? settings.runs.length : 1;
  for (let i = 0; i < cells; ++i) {
    const cell = cellAt(i);
    context.save();
    context.beginPath();
    context.rect(cell.left, cell.top, cell.width, cell.height);
    context.clip();
    drawGrid(cell);
    const right = drag?.scene ?? truth?.positionsAt(play.time, truth.truths);
    if (right) drawChain(cell, right, {color: css('--truth'), width: 8, dash: [], dots: 0});
    if (cells > 1) {
      drawRun(i);
    } else {
      for (let j = settings.runs.length - 1; j >= 0; --j) drawRun(j);
      if (tracks.length === 0 && scene.x.length > 0) drawStart(cell);
    }
    const given = wrong?.positions(play.time);
    if (given) drawChain(cell, given, {color: css('--diverged'), width: 2, dash: [4, 4], dots: 4});
    if (i === 0) drawArrows(cell);
    context.restore();
  }
  if (cells > 1) drawBorders();
  if (scene.x.length > 0) play.firstPicture ??= performance.now();
}

function drawStart(cell) {
  drawChain(cell, Float64Array.from([...scene.x, ...scene.y]),
            {color: css('--text'), width: 2, dash: [], dots: 4 * devicePixelRatio});
}

function drawBorders() {
  context.strokeStyle = css('--grid');
  context.lineWidth = 2;
  for (let i = 0; i < settings.runs.length; ++i) {
    const cell = cellAt(i);
    context.strokeRect(cell.left, cell.top, cell.width, cell.height);
  }
}

let before = performance.now();
function tick(now) {
  const seconds = Math.min(0.1, (now - before) / 1000);
  before = now;
  if (play.on) {
    const end = lastTime();
    seek(play.time + seconds * play.speed);
    if (play.time >= end && tracks.every((track) => track.end || track.failure)) setPlaying(false);
  }
  if (dirty) {
    dirty = false;
    ++play.pictures;
    draw();
    const end = lastTime();
    if (document.activeElement !== slider || !touchingSlider) {
      slider.value = end > 0 ? SLIDER_STEPS * play.time / end : 0;
    }
    slider.setAttribute('aria-valuetext', `${play.time.toFixed(2)} seconds`);
    clock.textContent = `${play.time.toFixed(2)} s of ${end.toFixed(1)} s`;
  }
  requestAnimationFrame(tick);
}
let touchingSlider = false;

// Dragging: at the start of the motion a particle, else the view.
function cellUnder(px, py) {
  const [columns, rows] = cellsOf(settings.runs.length);
  return cellAt(Math.floor(px / (canvas.width / columns)) +
                columns * Math.floor(py / (canvas.height / rows)));
}

function place(event) {
  const box = canvas.getBoundingClientRect();
  const px = (event.clientX - box.left) * devicePixelRatio;
  const py = (event.clientY - box.top) * devicePixelRatio;
  const cell = cellUnder(px, py);
  return {
    px, py, cell, x: view.x + (px - cell.left - cell.width / 2) / view.scale,
    y: view.y - (py - cell.top - cell.height / 2) / view.scale,
  };
}

function particleAt({x, y}) {
  let best = -1;
  let nearest = 18 * devicePixelRatio / view.scale;
  const shown = tracks[0]?.positionsAt(play.time);
  const size = scene.x.length;
  for (let i = 0; i < size; ++i) {
    const distance = Math.hypot(x - (shown ? shown[i] : scene.x[i]),
                                y - (shown ? shown[size + i] : scene.y[i]));
    if (distance < nearest) [best, nearest] = [i, distance];
  }
  return best;
}

/** Where a particle is drawn, in CSS pixels from the corner of the canvas. */
export function onScreen(particle) {
  const shown = tracks[0]?.positionsAt(play.time) ?? [...scene.x, ...scene.y];
  return toScreen(cellAt(0), shown[particle], shown[scene.x.length + particle]).map((value) => value / devicePixelRatio);
}

export function select(particle) {
  play.selected = particle;
  redraw();
  tell('selected', particle);
}

canvas.addEventListener('pointerdown', (event) => {
  canvas.setPointerCapture(event.pointerId);
  touches.set(event.pointerId, event);
  const at = place(event);
  const particle = particleAt(at);
  if (particle >= 0) select(particle);
  drag = {at, view: {...view}, particle: play.time === 0 && !play.on ? particle : -1, scene: null};
});
canvas.addEventListener('pointermove', (event) => {
  if (!touches.has(event.pointerId)) return;
  if (touches.size === 2) {
    pinch(event);
    return;
  }
  touches.set(event.pointerId, event);
  if (!drag) return;
  const at = place(event);
  if (drag.particle >= 0) {
    drag.scene = Float64Array.from([...scene.x, ...scene.y]);
    drag.scene[drag.particle] = at.x;
    drag.scene[scene.x.length + drag.particle] = at.y;
  } else {
    view.own = true;
    view.x = drag.view.x - (at.px - drag.at.px) / view.scale;
    view.y = drag.view.y + (at.py - drag.at.py) / view.scale;
  }
  redraw();
});
function pinch(event) {
  const [first, second] = [...touches.values()];
  const distance = Math.hypot(first.clientX - second.clientX, first.clientY - second.clientY);
  touches.set(event.pointerId, event);
  const [a, b] = [...touches.values()];
  view.scale *= Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) / Math.max(1, distance);
  view.own = true;
  drag = null;
  redraw();
}
function release(event) {
  touches.delete(event.pointerId);
  const moved = drag;
  drag = null;
  if (moved?.scene && event.type === 'pointerup') {
    const i = moved.particle;
    tell('moved', {particle: i, x: moved.scene[i], y: moved.scene[scene.x.length + i]});
  }
  redraw();
}
canvas.addEventListener('pointerup', release);
canvas.addEventListener('pointercancel', release);
canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  view.own = true;
  view.scale = Math.min(1e12, Math.max(1e-12, view.scale * Math.exp(-0.001 * event.deltaY)));
  redraw();
}, {passive: false});
canvas.addEventListener('dblclick', () => { fit(); redraw(); });

function moveSelected(dx, dy) {
  const i = play.selected;
  if (i >= 0) tell('moved', {particle: i, x: scene.x[i] + dx, y: scene.y[i] + dy});
}
const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
canvas.addEventListener('keydown', (event) => {
  const size = scene.x.length;
  const move = moves[event.key];
  if (move && play.selected >= 0) moveSelected(0.05 * move[0], 0.05 * move[1]);
  else if (event.key === '[') select((play.selected - 1 + size) % size);
  else if (event.key === ']') select((play.selected + 1) % size);
  else if (event.key === 'Delete' && play.selected >= 0) tell('remove');
  else if (event.key === 'Insert') tell('add');
  else if (event.key === '+' || event.key === '-') view.scale *= event.key === '+' ? 1.25 : 0.8;
  else return;
  event.preventDefault();
  redraw();
});

export const actions = {
  play: () => setPlaying(!play.on),
  step: () => { setPlaying(false); seek(play.time + stepOf(settings.runs[0])); },
  frame: () => { setPlaying(false); seek(play.time + Number(settings.interval)); },
  back: () => { setPlaying(false); seek(play.time - Number(settings.interval)); },
  reset: () => { setPlaying(false); seek(0); },
};
for (const [name, action] of Object.entries(actions)) {
  document.getElementById(name).addEventListener('click', action);
}
const keys = {' ': 'play', '.': 'step', n: 'frame', b: 'back', r: 'reset'};
document.addEventListener('keydown', (event) => {
  const typing = /^(INPUT|TEXTAREA|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName);
  if (typing || event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
  event.preventDefault();
  actions[keys[event.key]]();
});
document.getElementById('speed').addEventListener('change', ({target}) => {
  play.speed = Number(target.value);
});
slider.max = SLIDER_STEPS;
slider.addEventListener('pointerdown', () => { touchingSlider = true; });
for (const end of ['pointerup', 'pointercancel']) {
  slider.addEventListener(end, () => { touchingSlider = false; });
}
slider.addEventListener('input', () => {
  setPlaying(false);
  seek(lastTime() * slider.value / SLIDER_STEPS);
});
for (const event of ['samples', 'run', 'theme']) on(event, redraw);
on('scene', () => {
  if (play.selected >= scene.x.length) play.selected = -1;
  if (play.time > 0 && !play.on) seek(0);
  redraw();
});
on('fit', () => { view.fitted = false; redraw(); });
on('done', () => { view.fitted = view.own; redraw(); });

export function start() {
  new ResizeObserver(redraw).observe(canvas);
  requestAnimationFrame(tick);
}
