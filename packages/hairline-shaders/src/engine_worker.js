// Computes beside the page: for beside.js, which gives it Hairline's own code where the page has it.
import init from '../engine/engine.js';
import { computed } from './computed.js';
import { loadedWith } from './tables.js';

/** All that can be handed over rather than copied. */
const buffersOf = (made) => [...new Set(Object.values(made).filter(ArrayBuffer.isView).map(({ buffer }) => buffer))];

let ready = null;

onmessage = async ({ data: { number, what, given, module } }) => {
  try {
    ready ??= init({ module_or_path: module ?? new URL('../engine/engine_bg.wasm', import.meta.url) }).then(() => loadedWith(module));
    await ready;
    const made = computed[what](given);
    postMessage({ number, made }, buffersOf(made));
  } catch (error) {
    postMessage({ number, error: String(error?.message ?? error) });
  }
};
