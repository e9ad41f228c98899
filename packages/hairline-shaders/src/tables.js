// What all materials share: Hairline's own code, and the tables of the base: shapes and albedo of rough lobes, and how reflectance goes with the angle.
import init, { BaseTable } from '../engine/engine.js';

/** Three textures, rgba32float: `{ data, width, height }` each. */
export class Tables {
  constructor() {
    for (const name of ['shapes', 'albedo', 'curves']) {
      const table = BaseTable[name]();
      const [data, width] = [table.data(), table.width()];
      this[name] = { data, width, height: data.length / (4 * width) };
      table.free();
    }
  }
}

let isLoaded = false;
let loaded = null;

/** Tells that Hairline's own code is there, and its module, by which a worker starts. */
export function loadedWith(module) {
  isLoaded = true;
  loaded = module;
}

/** The module, or null before it is there. */
export const engineModule = () => loaded;

/** For what needs Hairline's own code: throws before it is there. */
export function needsTables(name) {
  if (!isLoaded) throw new Error(`${name}: found no tables; must come after \`await loadTables()\``);
}

/** Loads Hairline's own code, engine_bg.wasm, from beside the package's folder `src` or from an address, and makes the tables. The rest of the package needs it first. */
export async function loadTables(url = new URL('../engine/engine_bg.wasm', import.meta.url)) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  const module = await WebAssembly.compile(await response.arrayBuffer());
  await init({ module_or_path: module });
  loadedWith(module);
  return new Tables();
}
