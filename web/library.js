// Calls the C++ library, which runs in a Web Worker.

export class Cancelled extends Error {}

/** What Exercise3 would print, with its exit status. */
export class LibraryError extends Error {
  constructor({message, status}) {
    super(message);
    this.status = status;
  }
}

const element = (id) => document.getElementById(id).textContent;
let code;    // promise of the compiled library and the address of the worker's script
let own = [];  // methods of the user, registered in every worker

function load() {
  const binary = Uint8Array.from(atob(element('library-wasm')), (c) => c.charCodeAt(0));
  const script = new Blob([element('library-js'), '\n', element('library-worker')],
                          {type: 'text/javascript'});
  return WebAssembly.compile(binary).then((module) => ({module, url: URL.createObjectURL(script)}));
}

/** Registers these methods in all workers that start from now on. */
export function setOwnMethods(methods) {
  own = methods;
}

/** One worker. Calls are carried out one after the other; `cancel` ends all of them. */
export class Library {
  #worker = null;
  #pending = new Map();
  #last = 0;

  async #start() {
    code ??= load();
    const {module, url} = await code;
    if (this.#worker) return;
    this.#worker = new Worker(url);
    this.#worker.onmessage = ({data}) => this.#receive(data);
    this.#worker.onerror = (event) => {
      event.preventDefault();
      this.#end(new LibraryError({message: `the library stopped: ${event.message}`, status: 1}));
    };
    this.#worker.postMessage({name: 'start', args: {module, own}});
  }

  #receive({id, progress, result, failure}) {
    const call = this.#pending.get(id);
    if (!call) return;
    if (progress) {
      call.report?.(progress);
      return;
    }
    this.#pending.delete(id);
    if (failure) call.reject(new LibraryError(failure));
    else call.resolve(result);
  }

  #end(error) {
    this.#worker?.terminate();
    this.#worker = null;
    const calls = [...this.#pending.values()];
    this.#pending.clear();
    for (const call of calls) call.reject(error);
  }

  /** Whether a call is under way. */
  get busy() {
    return this.#pending.size > 0;
  }

  async call(name, args = {}, report = null) {
    const id = ++this.#last;
    const promise = new Promise((resolve, reject) => {
      this.#pending.set(id, {resolve, reject, report});
    });
    promise.catch(() => {});
    await this.#start();
    if (this.#pending.has(id)) this.#worker.postMessage({id, name, args});
    return promise;
  }

  cancel() {
    this.#end(new Cancelled('cancelled'));
  }
}

/** One run with all its files, in a worker of its own. */
export async function runWithFiles(settings, file, report = null) {
  const library = new Library();
  try {
    return await library.call('run', {settings, file, interval: 0, energies: true, texts: true, room: 1e9}, report);
  } finally {
    library.cancel();
  }
}
