// The motion on a canvas, its buttons, and the particles as something to drag.
import {bounded, gridLines, gridUnit} from './grid.js';
import {lastTime, scene, tracks, truthTrack} from './runs.js';
import {colorOf, css, dashes, methodOf, nameOf, on, settings, tell} from './state.js';

const canvas = document.getElementById('motion');
const context = canvas.getContext('2d');
const slider = document.getElementById('time');
const clock = document.getElementById('clock');
const playButton = document.getElementById('play');
const SLIDER_STEPS = 10000;
const DOTS = 400;  // longer chains are drawn as lines

export const play = {time: 0, on: false, stepped: false, speed: 1, selected: -1};
let wrong = null;    // frames of a student: {positions: (time) => Float64Array or null, particle}
let view = {x: 0, y: 0, scale: 40, fitted: false, own: false};  // own: chosen by the user
let dirty = true;
const touches = new Map();
let drag = null;

export const redraw = () => { dirty = true; };
export const showFrames = (frames) => { wrong = frames; redraw(); };

/** @param stepped whether the time is the end of a step of the first run */
export function seek(time, stepped = false) {
  play.time = Math.max(0, Math.min(lastTime(), Number.isFinite(time) ? time : 0));
  play.stepped = stepped;
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
  const margin = 60 * devicePixelRatio;
  const scaleOf = (pixels, length) => Math.max(50, pixels - margin) / Math.max(length, 1e-9);
  view = {
    x: (left + right) / 2, y: (bottom + top) / 2, fitted: true, own: false,
    scale: Math.min(scaleOf(canvas.width, right - left), scaleOf(canvas.height, top - bottom)),
  };
}

const toScreen = (x, y) => [
  canvas.width / 2 + (x - view.x) * view.scale, canvas.height / 2 - (y - view.y) * view.scale,
];

function drawGrid() {
  const unit = gridUnit(80 * devicePixelRatio / view.scale);
  context.strokeStyle = css('--grid');
  context.fillStyle = css('--faint');
  context.lineWidth = 1;
  context.beginPath();
  const half = [canvas.width / view.scale / 2, canvas.height / view.scale / 2];
  for (const x of gridLines(view.x - half[0], view.x + half[0], unit)) {
    const [px] = toScreen(x, 0);
    context.moveTo(px, 0);
    context.lineTo(px, canvas.height);
  }
  for (const y of gridLines(view.y - half[1], view.y + half[1], unit)) {
    const [, py] = toScreen(0, y);
    context.moveTo(0, py);
    context.lineTo(canvas.width, py);
  }
  context.stroke();
  context.fillText(`grid: ${Number(unit.toPrecision(1))} m`, 8, canvas.height - 8);
}

function drawChain(positions, style) {
  const size = scene.x.length;
  context.strokeStyle = style.color;
  context.fillStyle = style.color;
  context.lineWidth = style.width * devicePixelRatio;
  context.setLineDash(style.dash.map((length) => length * devicePixelRatio));
  context.lineJoin = 'round';
  context.beginPath();
  for (let i = 0; i < size; ++i) {
    const [x, y] = toScreen(positions[i], positions[size + i]);
    const px = Math.max(-1e5, Math.min(1e5, x));
    const py = Math.max(-1e5, Math.min(1e5, y));
    context.lineTo(px, py);
  }
  context.stroke();
  context.setLineDash([]);
  if (!style.dots || size > DOTS) return;
  for (let i = 0; i < size; ++i) {
    const [x, y] = toScreen(positions[i], positions[size + i]);
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

function drawRun(index) {
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
  drawChain(positions, {
    color, width: 2.2, dash: broken && !alone ? [3, 6] : dashes[index], dots: 3.4 * devicePixelRatio,
  });
  context.fillStyle = color;
  context.fillText(nameOf(run) + (broken ? `: diverged at ${track.end.time.toPrecision(4)} s` : ''),
                   10, 20 * devicePixelRatio * (index + 1));
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
  drawGrid();
  const right = drag?.scene ?? truth?.positionsAt(play.time, truth.truths);
  if (right) drawChain(right, {color: css('--truth'), width: 8, dash: [], dots: 0});
  for (let j = settings.runs.length - 1; j >= 0; --j) drawRun(j);
  if (tracks.length === 0) {
    drawChain([...scene.x, ...scene.y], {color: css('--text'), width: 2, dash: [], dots: 4 * devicePixelRatio});
  }
  const given = wrong?.positions(play.time);
  if (given) drawChain(given, {color: css('--diverged'), width: 2, dash: [4, 4], dots: 4});
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
function place(event) {
  const box = canvas.getBoundingClientRect();
  const px = (event.clientX - box.left) * devicePixelRatio;
  const py = (event.clientY - box.top) * devicePixelRatio;
  return {
    px, py, x: view.x + (px - canvas.width / 2) / view.scale, y: view.y - (py - canvas.height / 2) / view.scale,
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
  return toScreen(shown[particle], shown[scene.x.length + particle]).map((value) => value / devicePixelRatio);
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
  view.scale = bounded(view.scale * Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) / Math.max(1, distance));
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
  view.scale = bounded(view.scale * Math.exp(-0.001 * event.deltaY));
  redraw();
}, {passive: false});
canvas.addEventListener('dblclick', () => { fit(); redraw(); });

const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
canvas.addEventListener('keydown', (event) => {
  const size = scene.x.length;
  const [dx, dy] = moves[event.key] ?? [];
  const i = play.selected;
  if (dx !== undefined && i >= 0) tell('moved', {particle: i, x: scene.x[i] + 0.05 * dx, y: scene.y[i] + 0.05 * dy});
  else if (event.key === '[') select((play.selected - 1 + size) % size);
  else if (event.key === ']') select((play.selected + 1) % size);
  else if (event.key === 'Delete' && play.selected >= 0) tell('remove');
  else if (event.key === 'Insert') tell('add');
  else if (event.key === '+' || event.key === '-') view.scale = bounded(view.scale * (event.key === '+' ? 1.25 : 0.8));
  else return;
  event.preventDefault();
  redraw();
});

export const actions = {
  play: () => setPlaying(!play.on),
  step: () => { setPlaying(false); seek(play.time + stepOf(settings.runs[0]), true); },
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
