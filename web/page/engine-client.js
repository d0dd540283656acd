// Commands for the worker. Ending the worker ends its command; the next command begins another worker.

// What was compressed, as a response that can be read while it is inflated.
function inflated(base64, type) {
  const bytes = Uint8Array.from(atob(base64.trim()), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')), {headers: {'Content-Type': type}});
}

class EngineClient {
  // compiled: a promise of the program, which several clients share.
  constructor(workerText, compiled) {
    this.source = URL.createObjectURL(new Blob([workerText], {type: 'text/javascript'}));
    this.compiled = compiled;
    this.waiting = new Map();
    this.count = 0;
    this.stops = 0;
  }

  async start() {
    const module = await this.compiled, worker = new Worker(this.source);
    worker.onmessage = ({data}) => this.take(data);
    worker.onerror = (event) => this.fail(event.message || 'the program could not be started in this browser');
    worker.postMessage({module});
    this.worker = worker;
  }

  take({id, line, plan, result}) {
    const job = this.waiting.get(id);
    if (!job) return;
    if (line !== undefined) job.onLine?.(line);
    if (plan !== undefined) job.onPlan?.(plan);
    if (!result) return;
    this.waiting.delete(id);
    job.resolve(result);
  }

  fail(why) {
    for (const job of this.waiting.values()) job.resolve({exit: 70, stdout: '', stderr: `thread: ${why}`, files: {}});
    this.waiting.clear();
    this.worker = null;
  }

  // {exit, stdout, stderr, files}; exit -1: stopped.
  async run(args, files = {}, {onLine, onPlan} = {}) {
    const {stops} = this, nothing = (exit, stderr) => ({exit, stdout: '', stderr, files: {}});
    try {
      if (!this.worker) await (this.starting ??= this.start().finally(() => (this.starting = null)));
    } catch (error) {
      return nothing(70, `thread: this browser cannot run the program (${error.message}); a newer one can`);
    }
    if (stops !== this.stops) return nothing(-1, '');
    const id = ++this.count;
    return new Promise((resolve) => {
      this.waiting.set(id, {resolve, onLine, onPlan});
      this.worker.postMessage({id, args, files});
    });
  }

  stop() {
    this.stops++;
    this.worker?.terminate();
    this.worker = null;
    for (const job of this.waiting.values()) job.resolve({exit: -1, stdout: '', stderr: '', files: {}});
    this.waiting.clear();
  }
}
