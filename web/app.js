// Starts the page, and gives scripts window.pendulumLab.
import {LibraryError, runWithFiles} from './library.js';
import * as check from './check.js';
import * as motion from './motion.js';
import * as own from './own.js';
import * as plots from './plots.js';
import * as report from './report.js';
import {restart, restartSoon, scene, tools, tracks, truthTrack} from './runs.js';
import * as editor from './scene.js';
import * as share from './share.js';
import * as stability from './stability.js';
import {constants, described, fromAddress, newRun, on, presets, setDefaults, settings, tell, toAddress}
  from './state.js';
import * as step from './step.js';
import * as studies from './studies.js';

const panels = [...document.querySelectorAll('[role="tabpanel"]')];
const tabs = document.getElementById('tabs');

function showTab(name) {
  settings.tab = name;
  for (const panel of panels) panel.hidden = panel.id !== `panel-${name}`;
  for (const button of tabs.children) {
    const chosen = button.dataset.tab === name;
    button.setAttribute('aria-selected', chosen);
    button.tabIndex = chosen ? 0 : -1;
  }
  tell('tab', name);
  keepAddress();
}

function makeTabs() {
  for (const panel of panels) {
    const button = document.createElement('button');
    button.textContent = panel.dataset.title;
    button.dataset.tab = panel.id.replace('panel-', '');
    button.setAttribute('role', 'tab');
    button.setAttribute('aria-controls', panel.id);
    button.addEventListener('click', () => showTab(button.dataset.tab));
    tabs.append(button);
  }
  tabs.addEventListener('keydown', ({key}) => {
    const turn = {ArrowRight: 1, ArrowLeft: -1}[key];
    if (!turn) return;
    const all = [...tabs.children];
    const next = all[(all.findIndex((b) => b.dataset.tab === settings.tab) + turn + all.length) % all.length];
    showTab(next.dataset.tab);
    next.focus();
  });
}

let address = 0;
function keepAddress() {
  clearTimeout(address);
  address = setTimeout(() => history.replaceState(null, '', toAddress()), 300);
}

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  tell('theme');
}

function takeDrops() {
  const stop = (event) => {
    event.preventDefault();
    document.body.classList.toggle('over', event.type === 'dragover');
  };
  for (const type of ['dragover', 'dragleave']) document.addEventListener(type, stop);
  document.addEventListener('drop', (event) => {
    stop(event);
    const files = [...event.dataTransfer.files];
    if (files.length > 1) {
      showTab('check');
      check.take(files);
    } else if (files[0]) {
      editor.openFile(files[0]);
    }
  });
}

function fileOf(particles) {
  if (particles === undefined) return settings.file;
  const name = String(particles).replace(/^.*data\//, '');
  if (presets[name]) return {name, text: presets[name]};
  return {name: 'particle.txt', text: String(particles)};
}

function showAll() {
  editor.showConstants();
  report.showRuns();
  showTab(settings.tab);
  tell('file');
}

/** For scripts; docs/lab.md describes it. */
window.pendulumLab = {
  async run({particles, ...options} = {}) {
    try {
      const {frames, energy, output, status, messages, kind, text, time, particle, ...end} =
        await runWithFiles(options, fileOf(particles));
      const {largest, largestTime, bound, measuredUntil, energyError, evaluations} = end;
      return {status, messages, output, frames, energy, verdict: {kind, text, time, particle}, evaluations,
              errors: {position: largest, time: largestTime, bound, measuredUntil, energy: energyError}};
    } catch (error) {
      if (!(error instanceof LibraryError)) throw error;
      return {status: error.status, messages: [error.message], output: '', frames: [], energy: '',
              verdict: null, evaluations: 0, errors: null};
    }
  },
  /** Changes settings of the page and resolves when all runs have ended. */
  async set({particles, runs, ...changes} = {}) {
    if (particles !== undefined) settings.file = fileOf(particles);
    for (const key of [...constants, 'frames', 'interval', 'reference', 'tab']) {
      if (changes[key] !== undefined) settings[key] = String(changes[key]);
    }
    if (runs) {
      settings.runs = runs.slice(0, 4).map((run) => {
        const made = {...newRun(run.method), ...run};
        return {...made, time_step: String(made.time_step), tolerance: String(made.tolerance)};
      });
    }
    showAll();
    clearTimeout(address);
    await restart();
    keepAddress();
  },
  state: () => ({
    time: motion.play.time, playing: motion.play.on, scene: {x: [...scene.x], y: [...scene.y], m: [...scene.m]},
    problem: document.getElementById('problem').textContent, settings: structuredClone(settings),
    sentences: report.sentences(),
    runs: tracks.map((track) => ({
      until: track.lastTime, samples: track.times.length, failure: track.failure, progress: track.progress,
      end: track.end, positions: Array.from(track.positionsAt(motion.play.time) ?? []).slice(0, 2 * scene.x.length),
    })),
    truth: Array.from(truthTrack()?.positionsAt(motion.play.time, truthTrack().truths) ?? []),
    plots: plots.values(), step: step.explained(),
  }),
  studies: studies.results,
  onScreen: motion.onScreen,
  methods: () => described.methods.map(({name}) => name),
  seek: motion.seek,
  play: motion.setPlaying,
};

async function start() {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  setTheme(dark.matches);
  dark.addEventListener('change', () => setTheme(dark.matches));
  makeTabs();
  takeDrops();
  Object.assign(described, await tools.call('describe'));
  setDefaults();
  fromAddress(location.hash);
  for (const part of [motion, editor, report, plots, studies, stability, step, own, share, check]) part.start();
  on('settings', keepAddress);
  await own.register(settings.own);
  showAll();
  window.addEventListener('hashchange', async () => {
    fromAddress(location.hash);
    await own.register(settings.own);
    showAll();
    restartSoon();
  });
  await restart();
  document.body.dataset.ready = 'true';
}

start().catch((error) => editor.say(`The page could not start: ${error.message}`));
