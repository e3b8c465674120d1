// Runs in a Web Worker, after emscripten's code (lab.js): carries out one call of the page at a time.
'use strict';

const printed = [];  // what Exercise3 would print to standard error
const SAMPLE = 50;   // bytes in the page for each number about a sample
let lab;

async function start({module, own}) {
  lab = await loadLibrary({
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
    print() {},
    printErr(line) { printed.push(line); },
  });
  lab.FS.mkdir('/scene');
  lab.FS.chdir('/scene');
  for (const {name, a, b} of own) lab.addMethod(name, a, b);
}

/** Writes the particle file of a call, under its own name so that messages name it. */
function withFile(settings, file) {
  const name = file.name.replace(/[/\0]/g, '_') || 'particle.txt';
  lab.FS.writeFile(name, file.text);
  return {...settings, particles: name, threads: settings.threads ?? 1};
}

/** Reads all frame files and removes them. */
function takeFrames(folder) {
  const names = lab.FS.readdir(folder).filter((name) => /^frame_\d+\.txt$/.test(name));
  names.sort((a, b) => a.length - b.length || (a < b ? -1 : 1));
  return names.map((name) => {
    const text = lab.FS.readFile(`${folder}/${name}`, {encoding: 'utf8'});
    lab.FS.unlink(`${folder}/${name}`);
    return text;
  });
}

const calls = {
  describe: () => ({methods: lab.methods(), options: lab.options()}),
  growth: ({method, points}) => lab.growthAt(method, points),
  eigenvalues: ({settings, masses, state}) => lab.eigenvalues(settings, masses, state),
  step: ({settings, masses, state, h}) => lab.explainStep(settings, masses, state, h),
  orders: ({a, b}) => lab.orderConditions(a, b),
  scene: ({file, interval}) => lab.readScene(withFile({method: 'Auto', frame_interval: interval}, file)),
  /** @param given whether the frames must be those of the method in `settings` */
  check({settings, file, given, frames}, report) {
    let said = performance.now();
    const stop = () => {
      if (performance.now() > said + 200) {
        said = performance.now();
        report({});
      }
      return false;
    };
    const {threads: _, ...options} = withFile(settings, file);
    return lab.checkFrames(options, given, frames.map(({index}) => index), frames.map(({name}) => name),
                           frames.map(({text}) => text), stop);
  },
  stableStep: ({settings, file}) => lab.stableStep(withFile(settings, file)),
  /** What a run without files says about itself. */
  measure({settings, file}) {
    const options = {...withFile(settings, file), reference: 'always', no_frames: true};
    const run = new lab.LabRun(options, 0, false, () => {});
    try {
      while (run.advance(1000, 1e7) !== null) { /* on */ }
      return run.finish();
    } finally {
      run.delete();
    }
  },
  /**
   * A whole run. Samples go to the page as they come.
   * @param texts whether to return the frame files and the energy file, too
   * @param room bytes of samples that the page keeps at most
   */
  run({settings, file, interval, energies, texts, room}, report) {
    const output = {output: '/frames', no_frames: !texts, energy: texts ? '/energy.csv' : ''};
    let said = performance.now();
    const tick = (frame) => {
      if (performance.now() < said + 100) return;
      said = performance.now();
      report({frame});
    };
    const options = {...withFile(settings, file), ...output};
    if (settings.no_frames === true || settings.no_frames === 'true') options.no_frames = true;
    const run = new lab.LabRun(options, interval, energies, tick);
    try {
      let samples;
      let full = false;
      while (!full && (samples = run.advance(50, 3e7)) !== null) {
        room -= 8 * (samples.states.length + samples.truths.length) + SAMPLE * samples.rows.length;
        report({samples});
        full = room <= 0;
      }
      report({ends: true});  // advice after a divergence takes up to minutes
      const end = {...run.finish(), full, messages: printed.slice()};
      if (!texts) return end;
      const frames = options.no_frames ? [] : takeFrames('/frames');
      return {...end, frames, energy: lab.FS.readFile('/energy.csv', {encoding: 'utf8'})};
    } finally {
      run.delete();
    }
  },
};

function failureOf(error, address = error?.excPtr ?? error) {  // newer Emscriptens wrap the address
  if (typeof address === 'number') return lab.failureAt(address);
  return {message: `the library stopped: ${error?.message ?? error}`, status: 1};
}

let started;
onmessage = async ({data: {id, name, args}}) => {
  try {
    if (name === 'start') {
      started = start(args);
      return;
    }
    await started;
    printed.length = 0;
    const report = (progress) => postMessage({id, progress});
    postMessage({id, result: calls[name](args, report)});
  } catch (error) {
    postMessage({id, failure: failureOf(error)});
  }
};
