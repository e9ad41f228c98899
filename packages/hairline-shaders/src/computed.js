// What takes long on the processor, by names, for the page and for the worker beside it: data in, data out.
import { Maps } from '../engine/engine.js';
import { layGratings } from './gratings.js';
import { layScratches, scratchTree } from './scratches.js';

/** A sun of three numbers of its radiance, then a sphere's middle and radius. */
function sun([r, g, b, x, y, z, radius]) {
  return { radiance: [r, g, b], center: [x, y, z], radius };
}

/** The maps of an environment. */
function maps({ rgb, width }) {
  const made = new Maps(rgb, width);
  const suns = Array.from({ length: made.sunCount() }, (_, i) => sun(made.sun(i)));
  return { levels: made.levels(), width: made.width(), texelRadiance: made.texelRadiance(), suns };
}

export const computed = {
  maps,
  lay: ({ mesh, layers, options }) => layScratches(mesh, layers, options),
  tree: ({ scratches, options }) => scratchTree(scratches, options),
  gratings: ({ rows, options }) => layGratings(rows, options),
};
