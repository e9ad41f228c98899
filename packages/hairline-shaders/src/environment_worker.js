// Makes the maps of an environment, some seconds of work, beside the page: for environment.js.
import init, { Maps } from '../engine/engine.js';

/** A lamp of three numbers of its radiance, then a sphere's middle and radius, or the corners of a polygon. */
function lamp(numbers) {
  const [r, g, b, ...shape] = numbers;
  const radiance = [r, g, b];
  if (shape.length === 4) return { radiance, center: shape.slice(0, 3), radius: shape[3] };
  return { radiance, corners: Array.from({ length: shape.length / 3 }, (_, i) => shape.slice(3 * i, 3 * i + 3)) };
}

onmessage = async ({ data: { rgb, width } }) => {
  try {
    await init({ module_or_path: new URL('../engine/engine_bg.wasm', import.meta.url) });
    const maps = new Maps(rgb, width);
    const lamps = (count, get) => Array.from({ length: count }, (_, i) => lamp(get(i)));
    const windows = lamps(maps.windowCount(), (i) => maps.window(i));
    const levels = maps.levels();
    const besideWindows = windows.length > 0 ? maps.levelsBesideWindows() : null;
    const suns = lamps(maps.sunCount(), (i) => maps.sun(i));
    const made = { levels, besideWindows, width: maps.width(), texelRadiance: maps.texelRadiance(), suns, windows };
    postMessage(made, [levels, besideWindows].filter((texels) => texels !== null).map(({ buffer }) => buffer));
  } catch (error) {
    postMessage({ error: String(error?.message ?? error) });
  }
};
