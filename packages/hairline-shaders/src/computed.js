// What takes long on the processor, by names, for the page and for the worker beside it: data in, data out.
import { Maps } from '../engine/engine.js';
import { layGratings } from './gratings.js';
import { layScratches, scratchTree } from './scratches.js';

/** A lamp of three numbers of its radiance, then a sphere's middle and radius, or the corners of a polygon. */
function lamp(numbers) {
  const [r, g, b, ...shape] = numbers;
  const radiance = [r, g, b];
  if (shape.length === 4) return { radiance, center: shape.slice(0, 3), radius: shape[3] };
  return { radiance, corners: Array.from({ length: shape.length / 3 }, (_, i) => shape.slice(3 * i, 3 * i + 3)) };
}

/** The maps of an environment. */
function maps({ rgb, width }) {
  const made = new Maps(rgb, width);
  const lamps = (count, get) => Array.from({ length: count }, (_, i) => lamp(get(i)));
  const windows = lamps(made.windowCount(), (i) => made.window(i));
  const levels = made.levels();
  const besideWindows = windows.length > 0 ? made.levelsBesideWindows() : null;
  const suns = lamps(made.sunCount(), (i) => made.sun(i));
  return { levels, besideWindows, width: made.width(), texelRadiance: made.texelRadiance(), suns, windows };
}

export const computed = {
  maps,
  lay: ({ mesh, layers, options }) => layScratches(mesh, layers, options),
  tree: ({ scratches, options }) => scratchTree(scratches, options),
  gratings: ({ rows, options }) => layGratings(rows, options),
};
