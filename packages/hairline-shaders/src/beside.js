// A worker beside the page, which stands still for nothing that takes long on the processor. It ends when it has no more to do, and with it its memory.
import { computed } from './computed.js';
import { engineModule, needsTables } from './tables.js';

let worker = null;
let asked = 0;
const waiting = new Map();

function settle(number, settled) {
  const { resolve, reject } = waiting.get(number);
  waiting.delete(number);
  if (settled.error === undefined) resolve(settled.made);
  else reject(new Error(settled.error));
  if (waiting.size > 0 || !worker) return;
  worker.terminate();
  worker = null;
}

/** A page that may not start it, as by its rules of content or from another origin, computes by itself. */
function computeHere() {
  worker?.terminate();
  worker = null;
  for (const [number, { what, given }] of [...waiting]) {
    try {
      needsTables(what);
      settle(number, { made: computed[what](given) });
    } catch (error) {
      settle(number, { error: error.message });
    }
  }
}

/** What a function of computed.js makes of what it is given, copies of it. */
export function beside(what, given) {
  return new Promise((resolve, reject) => {
    asked += 1;
    waiting.set(asked, { what, given, resolve, reject });
    try {
      if (!worker) {
        worker = new Worker(new URL('./engine_worker.js', import.meta.url), { type: 'module' });
        worker.onmessage = ({ data }) => settle(data.number, data);
        worker.onerror = computeHere;
      }
      worker.postMessage({ number: asked, what, given, module: engineModule() });
    } catch {
      computeHere();
    }
  });
}
