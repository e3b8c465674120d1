// Checks the frames of a student's program, and draws them over the right motion.
import {Cancelled, Library} from './library.js';
import {seek, showFrames} from './motion.js';
import {paragraph} from './step.js';
import {scene} from './runs.js';
import {get, methodOf, on, optionsOf, settings} from './state.js';

const note = get('check-note');
const MOST_BYTES = 1e8;
const NAME = /^frame_(\d+)\.txt$/;
let library = null;
let report = [];

function say(...lines) {
  note.replaceChildren(...lines.map((line) => paragraph(line)));
}

async function readFiles(files) {
  const named = files.filter((file) => file.webkitRelativePath.split('/').length < 3)  // of the folder itself
    .map((file) => ({file, found: NAME.exec(file.name)})).filter(({found}) => found);
  const bytes = named.reduce((sum, {file}) => sum + file.size, 0);
  if (bytes > MOST_BYTES) throw new Error(`${(bytes / 1e6).toFixed(0)} MB of frames are too much for this page: use check_frames`);
  return Promise.all(named.map(async ({file, found: [name, index]}) => ({name, index: Number(index), text: await file.text()})));
}

/** Numbers of a frame in the order of drawing: all x, then all y. */
function positionsOf({text}) {
  const rows = text.trim().split('\n').map((line) => line.trim().split(/[\s,;]+/).map(Number));
  return Float64Array.from([...rows.map(([x]) => x), ...rows.map(([, y]) => y)]);
}

function drawOver(frames, interval) {
  const byIndex = new Map(frames.map((frame) => [frame.index, frame]));
  showFrames({
    positions(time) {
      const frame = byIndex.get(Math.floor(time / interval + 1e-6));
      const positions = frame && positionsOf(frame);
      return positions?.length === 2 * scene.x.length ? positions : null;
    },
  });
}

/** Checks the files of a folder. */
export async function take(files) {
  showFrames(null);
  report = [];
  library?.cancel();
  library = new Library();
  try {
    say('Reading …');
    const frames = await readFiles(files);
    if (frames.length === 0) {
      say('No frames here: the files must be named frame_0000.txt, frame_0001.txt and so on.');
      return;
    }
    await check(frames);
  } catch (error) {
    if (!(error instanceof Cancelled)) say(error.message);
  } finally {
    get('check-cancel').hidden = true;
  }
}

async function check(frames) {
  const run = settings.runs[0];
  const {reference: _, ...options} = optionsOf(run);
  const began = performance.now();
  get('check-cancel').hidden = false;
  say(`Comparing ${frames.length} frames …`);
  const result = await library.call('check', {
    settings: options, file: settings.file, given: get('check-method').checked, frames,
  }, () => say(`Searching for the mistake, ${Math.round((performance.now() - began) / 1000)} s …`));
  report = result.report;
  say(...report);
  const method = methodOf(run.method);
  const interval = method?.fixed ? Number(options.steps_per_frame) * Number(options.time_step) : Number(options.frame_interval);
  drawOver(frames, interval);
  if (result.time === undefined) return;
  note.append(paragraph('The frames are drawn dashed over the motion.'));
  seek(result.time);
}

export function start() {
  get('check-folder').addEventListener('change', ({target}) => { take([...target.files]); target.value = ''; });
  get('check-cancel').addEventListener('click', () => { library?.cancel(); say('Cancelled.'); });
  on('tab', (tab) => { if (tab !== 'check') showFrames(null); });
  on('scene', () => {
    showFrames(null);
    library?.cancel();
    if (!get('check-cancel').hidden) say('Cancelled: the scene or a method has changed.');
    else if (report.length > 0) say(...report, 'Checked before the last change.');
  });
}
