// What repeats the runs elsewhere: commands and a link.
import {scene} from './runs.js';
import {LONGEST_ADDRESS, defaultOf, get, nameOf, on, optionsOf, presets, settings, toAddress} from './state.js';
import {paragraph} from './step.js';

const note = get('share-note');

/** A word for a POSIX shell. */
const quoted = (text) => (/^[\w./:=@%+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function given(run) {
  return Object.entries(optionsOf(run)).filter(([key, value]) => key !== 'method' && value !== defaultOf(key));
}

const filePath = () => (presets[settings.file.name] === settings.file.text ? `data/${settings.file.name}` : 'particle.txt');

/** Python evaluates the fractions of a tableau. */
function pythonOf({name, a, b}, options) {
  const row = (texts) => `[${texts.join(', ')}]`;
  const rows = b.map((_, i) => row(Array.from({length: i}, (__, j) => a[i]?.[j] ?? '0')));
  const words = options.map(([key, value]) => `, ${key}=${/^[-+.\de]+$/i.test(value) ? value : JSON.stringify(value)}`);
  return `import spring_pendulum as sp\nsp.register_method(${JSON.stringify(name)}, a=${row(rows)}, b=${row(b)})\n` +
    `print(sp.simulate(${JSON.stringify(filePath())}, method=${JSON.stringify(name)}${words.join('')}))`;
}

export function commandsOf(run) {
  const options = given(run);
  const own = settings.own.find(({name}) => name === run.method);
  if (own) return [pythonOf(own, options)];
  const exercise = ['Exercise3', quoted(run.method), '--particles', quoted(filePath()),
    ...options.map(([key, value]) => `--${key.replaceAll('_', '-')} ${quoted(value)}`), '--output frames'];
  const launch = ['roslaunch spring_pendulum pendulum.launch', quoted(`method:=${run.method}`),
    `"particles:=$PWD/${filePath()}"`, quoted(`params:={${options.map(([key, value]) => `${key}: ${value}`).join(', ')}}`)];
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
  if (scene.failure) return box.append(paragraph(`No commands: ${scene.failure}`));
  if (filePath() === 'particle.txt') box.append(paragraph('First save the particle file as particle.txt.'));
  for (const run of settings.runs) {
    box.append(paragraph(nameOf(run), 'h3'));
    for (const command of commandsOf(run)) {
      const line = paragraph(command, 'pre');
      const button = Object.assign(document.createElement('button'), {textContent: 'Copy', title: command});
      button.addEventListener('click', () => copy(command, 'The command is on the clipboard.'));
      box.append(line, button);
    }
  }
}

export function start() {
  get('link').addEventListener('click', () => {
    const long = toAddress().includes('particles=') && settings.file.text.length > LONGEST_ADDRESS;
    copy(`${location.href.replace(/#.*/, '')}${toAddress()}`, long ?
      'The link is on the clipboard, without the particle file, which is too long for a link.' :
      'The link is on the clipboard.');
  });
  for (const event of ['runs', 'settings', 'tab', 'scene']) on(event, show);
}
