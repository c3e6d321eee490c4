// The engine as seen by the page: a worker that answers requests, keeps files, and can be stopped.

export class Engine {
  #program = null;
  #worker = null;
  #held = new Map();
  #waiting = new Map();
  #next = 1;
  #fault = "";
  #told = () => {};

  // The program and the worker script; a single-file page contains both.
  async #load() {
    const own = document.getElementById("program");
    if (!own) {
      const [program, worker] = await Promise.all(["bowden.wasm", "worker.js"].map(part));
      return { program: await WebAssembly.compile(await program.arrayBuffer()), worker: await worker.text() };
    }
    const packed = Uint8Array.from(atob(own.textContent.trim()), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const program = await WebAssembly.compile(await new Response(stream).arrayBuffer());
    return { program, worker: document.getElementById("worker").textContent };
  }

  // Starts loading; the first request waits for it. Nothing else is loaded afterwards.
  prepare() {
    this.#program ??= this.#load();
    return this.#program;
  }

  async #start() {
    const { program, worker } = await this.prepare();
    if (this.#worker) return;
    const url = URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
    this.#worker = new Worker(url);
    URL.revokeObjectURL(url);
    this.#worker.onmessage = ({ data }) => this.#heard(data);
    this.#worker.onerror = (event) => this.#stopped(event.message || "the worker has stopped");
    this.#worker.postMessage({ program });
  }

  #heard(data) {
    if (data.what !== undefined) return this.#told(data.what, data.share);
    if (data.fault !== undefined) {
      this.#fault = data.fault;
      return;
    }
    if (data.stopped !== undefined) return this.#stopped(data.stopped);
    const waiting = this.#waiting.get(data.id);
    this.#waiting.delete(data.id);
    if (!waiting) return;
    if (data.answer.refused !== undefined) waiting.reject(new Refusal(data.answer.refused));
    else waiting.resolve(data.answer);
  }

  #stopped(why) {
    const message = `bowden stopped because of an internal error: ${this.#fault || why}`;
    this.#end(new Refusal(message));
  }

  #end(error) {
    this.#worker?.terminate();
    this.#worker = null;
    this.#held.clear();
    this.#fault = "";
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const { reject } of waiting) reject(error);
  }

  // Stops the running request; the next request starts a new worker.
  cancel() {
    this.#end(new Cancelled());
  }

  // Sends a request; the worker first receives the files that it does not have yet.
  async ask(request, { files = [], bytes, told } = {}) {
    await this.#start();
    for (const file of files) {
      if (this.#held.get(file.name) === file) continue;
      this.#held.set(file.name, file);
      const add = file.isExample ? { ask: "example" } : { ask: "add", name: file.name };
      await this.#post(add, file.bytes);
    }
    if (told) this.#told = told;
    return this.#post(request, bytes);
  }

  #post(request, bytes) {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ id, request, bytes });
    });
  }
}

async function part(name) {
  const answer = await fetch(name);
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer;
}

// An error of the program, as its one-line message.
export class Refusal extends Error {}
export class Cancelled extends Error {}
