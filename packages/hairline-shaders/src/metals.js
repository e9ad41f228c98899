// Metals whose refractive index was measured.
import { curveOf as curve, metalColor as colour } from '../engine/engine.js';
import { METALS } from './data.js';

export const metals = METALS;

/** Reflectance at normal incidence, linear Rec.709. */
export function metalColor(metal) {
  return Array.from(colour(metal));
}

/** The curve of a metal, for FresnelRgb; null: Schlick's, for colours. */
export function curveOf(metal) {
  return curve(metal ?? undefined);
}

/** The curve of a dielectric of a refractive index, for FresnelRgb. */
export { dielectricCurve } from '../engine/engine.js';
