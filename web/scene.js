// The scene: presets, the particle file, dragged particles, constants.
import {Library} from './library.js';
import {play, redraw, select} from './motion.js';
import {scene} from './runs.js';
import {constants, described, on, presets, settings, tell} from './state.js';

const MOST_TEXT = 5e6;     // characters of a particle file that the text area shows
const COLUMNS = ['x', 'y', 'm', 'vx', 'vy'];
const LARGEST_FILE = 2e7;  // bytes; a file of 100,000 particles has some 5 MB
const area = document.getElementById('particles');
const choice = document.getElementById('scene');
const problem = document.getElementById('problem');

export const say = (text) => { problem.textContent = text; };

export function save(name, content, type = 'text/plain') {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export function setFile(name, text) {
  settings.file = {name, text};
  tell('file');
  tell('settings');
}

/** Takes a file that was dropped or opened. */
export async function openFile(file) {
  if (file.size > LARGEST_FILE) {
    say(`${file.name}: ${(file.size / 1e6).toFixed(0)} MB is too much for this page, ` +
        `which reads particle files of at most ${LARGEST_FILE / 1e6} MB`);
    return;
  }
  const reader = new Library();  // of its own, so that a broken file leaves the scene as it is
  try {
    const text = await file.text().catch(() => { throw new Error(`${file.name}: is a folder or cannot be read`); });
    await reader.call('scene', {file: {name: file.name, text}, interval: settings.interval});
    area.blur();  // else the text there stays, and the next key puts it back
    setFile(file.name, text);
  } catch (error) {
    say(error.message);
  } finally {
    reader.cancel();
  }
}

function write() {
  const {x, y, m, vx, vy} = scene;
  const moves = [...vx, ...vy].some((value) => value !== 0);
  const lines = Array.from(x, (_, i) => `${x[i]} ${y[i]} ${m[i]}${moves ? ` ${vx[i]} ${vy[i]}` : ''}`);
  setFile(presets[settings.file.name] ? 'particle.txt' : settings.file.name, `${lines.join('\n')}\n`);
  scene.file = settings.file;
}

function replace(change) {
  if (scene.file !== settings.file) return;  // what is typed cannot be read, or has not been read yet
  for (const key of COLUMNS) scene[key] = Array.from(scene[key]);
  change(scene);
  write();
}

function add() {
  const last = scene.x.length - 1;
  if (last < 0) return;
  const length = Number(settings.rest_length) || 1;
  replace(({x, y, m, vx, vy}) => {
    x.push(x[last] + length);
    y.push(y[last]);
    m.push(m[last] > 0 ? m[last] : 1);
    vx.push(0);
    vy.push(0);
    select(last + 1);
  });
}

function remove() {
  const i = play.selected >= 0 ? play.selected : scene.x.length - 1;
  if (i < 1) {
    say('the first particle stays: the chain hangs on it');
    return;
  }
  replace((columns) => { for (const key of COLUMNS) columns[key].splice(i, 1); });
}

function showFile() {
  const {name, text} = settings.file;
  if (area !== document.activeElement) {
    area.value = text.length > MOST_TEXT ? `# ${name}: too long to be shown\n` : text;
    area.readOnly = text.length > MOST_TEXT;
  }
  choice.value = presets[name] === text ? name : '';
}

function fieldFor(key, title, unit) {
  const label = document.createElement('label');
  const option = described.options.find((row) => row.key === key);
  label.textContent = `${title}${unit ? `, ${unit}` : ''}`;
  const input = document.createElement('input');
  input.id = `set-${key}`;
  input.inputMode = 'decimal';
  input.title = option.meaning;
  input.addEventListener('change', () => {
    settings[key === 'frame_interval' ? 'interval' : key] = input.value.trim();
    tell('settings');
  });
  label.append(input);
  return label;
}

export function showConstants() {
  for (const key of [...constants, 'frames']) document.getElementById(`set-${key}`).value = settings[key];
  document.getElementById('set-frame_interval').value = settings.interval;
}

export function start() {
  const titles = {
    stiffness: 'stiffness k_s', damping: 'damping k_d', rest_length: 'rest length L_0', gravity: 'gravity g',
    frames: 'frames', frame_interval: 'time between frames',
  };
  const fields = document.getElementById('constants');
  for (const [key, title] of Object.entries(titles)) {
    fields.append(fieldFor(key, title, described.options.find((row) => row.key === key).unit));
  }
  choice.append(new Option('own scene', ''), ...Object.keys(presets).map((name) => new Option(name)));
  choice.addEventListener('change', () => {
    if (choice.value) setFile(choice.value, presets[choice.value]);
    tell('fit');
  });
  area.addEventListener('input', () => {
    settings.file = {name: presets[settings.file.name] ? 'particle.txt' : settings.file.name, text: area.value};
    choice.value = '';
    tell('settings');
  });
  area.addEventListener('blur', showFile);
  document.getElementById('add').addEventListener('click', add);
  document.getElementById('remove').addEventListener('click', remove);
  document.getElementById('export').addEventListener('click', () => save('particle.txt', settings.file.text));
  document.getElementById('open').addEventListener('change', ({target}) => {
    if (target.files[0]) openFile(target.files[0]);
    target.value = '';
  });
  on('moved', ({particle, x, y}) => replace((all) => { all.x[particle] = x; all.y[particle] = y; }));
  on('add', add);
  on('remove', remove);
  on('file', showFile);
  on('scene', () => {
    say(scene.failure);
    redraw();
  });
  showFile();
  showConstants();
}
