// Metals whose refractive index was measured.
import { metalColor as colour } from '../engine/engine.js';
import { METALS } from './data.js';

export const metals = METALS;

/** Throws where there is no such metal; null stands for one given by its colour. */
export function checkMetal(metal) {
  if (metal !== null && !metals.includes(metal)) {
    throw new Error(`metal: found ${JSON.stringify(metal)}; must be one of ${metals.join(', ')}, or null for a metal given by its colour`);
  }
}

/** Reflectance at normal incidence, linear Rec.709. */
export function metalColor(metal) {
  checkMetal(metal);
  return Array.from(colour(metal));
}
