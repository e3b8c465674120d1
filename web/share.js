// Everything needed to repeat the runs elsewhere: commands, a link, files.
import JSZip from '/usr/share/nodejs/jszip/lib/index.js';
import {runWithFiles} from './library.js';
import {save} from './scene.js';
import {fillRuns} from './stability.js';
import {defaultOf, get, nameOf, on, optionsOf, presets, settings, toAddress} from './state.js';

const note = get('share-note');
const choice = get('share-run');
const MOST_CHARACTERS = 2e8;  // of all frames

/** A word for a POSIX shell. */
const quoted = (text) => (/^[\w./:=@%+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function given(run) {
  return Object.entries(optionsOf(run)).filter(([key, value]) => key !== 'method' && value !== defaultOf(key));
}

const filePath = () => (presets[settings.file.name] === settings.file.text ? `data/${settings.file.name}` : 'particle.txt');

export function commandsOf(run) {
  const options = given(run);
  const exercise = ['Exercise3', quoted(run.method), '--particles', quoted(filePath()),
    ...options.map(([key, value]) => `--${key.replaceAll('_', '-')} ${quoted(value)}`), '--output frames'];
  const launch = ['roslaunch spring_pendulum pendulum.launch', quoted(`method:=${run.method}`),
    `particles:=$PWD/${filePath()}`, quoted(`params:={${options.map(([key, value]) => `${key}: ${value}`).join(', ')}}`)];
  return [exercise.join(' '), launch.join(' ')];
}

export async function copy(text, done) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {  // pages from disk may not use the clipboard everywhere
    const area = document.createElement('textarea');
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
  }
  note.textContent = done;
}

function show() {
  if (settings.tab !== 'share') return;
  const box = get('commands');
  box.replaceChildren();
  if (filePath() === 'particle.txt') {
    box.append(Object.assign(document.createElement('p'), {textContent: 'First save the particle file as particle.txt.'}));
  }
  for (const run of settings.runs) {
    box.append(Object.assign(document.createElement('h3'), {textContent: nameOf(run)}));
    if (run.method === settings.own?.name) {
      box.append(Object.assign(document.createElement('p'), {
        textContent: 'A method of your own: docs/methods.md of the package shows how to register this tableau in C++.'}));
    }
    for (const command of commandsOf(run)) {
      const line = Object.assign(document.createElement('pre'), {textContent: command});
      const button = Object.assign(document.createElement('button'), {textContent: 'Copy', title: command});
      button.addEventListener('click', () => copy(command, 'The command is on the clipboard.'));
      box.append(line, button);
    }
  }
}

function filesOf(run) {
  const options = optionsOf(run);
  const size = settings.file.text.split('\n').length * 40 * Number(options.frames);
  if (size > MOST_CHARACTERS) {
    throw new Error(`the frames would take ${(size / 1e6).toFixed(0)} MB: use Exercise3 with the command above`);
  }
  return runWithFiles(options, settings.file, ({frame}) => { if (frame) note.textContent = `frame ${frame}`; });
}

const nameOfFrame = (index) => `frame_${String(index).padStart(4, '0')}.txt`;

const savers = {
  async zip(run) {
    const {frames} = await filesOf(run);
    const zip = new JSZip();
    frames.forEach((text, index) => zip.file(nameOfFrame(index), text));
    save('frames.zip', await zip.generateAsync({type: 'blob', compression: 'DEFLATE'}));
    return `frames.zip has ${frames.length} frames.`;
  },
  async csv(run) {
    const {frames} = await filesOf(run);
    const rows = frames.flatMap((text, frame) => text.trimEnd().split('\n').map(
      (line, i) => `${frame},${i + 1},${line.replace(' ', ',')}`));
    save('frames.csv', `frame,particle,x [m],y [m]\n${rows.join('\n')}\n`, 'text/csv');
    return `frames.csv has ${rows.length} rows.`;
  },
  async energy(run) {
    const {energy} = await filesOf(run);
    save('energy.csv', energy, 'text/csv');
    return 'energy.csv is the file that Exercise3 --energy writes.';
  },
  async particles() {
    save('particle.txt', settings.file.text);
    return 'particle.txt is saved.';
  },
};

export function start() {
  for (const [name, saver] of Object.entries(savers)) {
    get(`save-${name}`).addEventListener('click', async () => {
      try {
        note.textContent = 'computing …';
        note.textContent = await saver(settings.runs[Number(choice.value)]);
      } catch (error) {
        note.textContent = error.message;
      }
    });
  }
  get('link').addEventListener('click', () => {
    const long = !toAddress().includes('scene=') && !toAddress().includes('particles=');
    copy(`${location.href.replace(/#.*/, '')}${toAddress()}`, long ?
      'The link is on the clipboard, without the particle file, which is too long for a link.' :
      'The link is on the clipboard.');
  });
  on('runs', () => { fillRuns(choice); show(); });
  for (const event of ['settings', 'tab', 'scene']) on(event, show);
}
