// Spectra: the CIE observer under daylight, and metals by their measured index. Twin: crates/optics/src/{spectrum,metal,fresnel,mask}.rs.
import { OBSERVER, METALS } from './data.js';

const REC709_FROM_XYZ = [
  [3.240969941904521, -1.537383177570093, -0.498610760293003],
  [-0.96924363628088, 1.875967501507721, 0.041555057407176],
  [0.055630079696993, -0.203976958888977, 1.056971514242879],
];

/** Wavelengths from 380 to 780 nm, with weights in linear Rec.709 that sum to 1 in each channel. */
export const samples = OBSERVER.map(([nm, x, y, z, d65]) => ({
  nm,
  weight: REC709_FROM_XYZ.map((m) => d65 * (m[0] * x + m[1] * y + m[2] * z)),
}));
for (let c = 0; c < 3; c += 1) {
  const sum = samples.reduce((total, sample) => total + sample.weight[c], 0);
  for (const sample of samples) sample.weight[c] /= sum;
}

/** The metals that were measured. */
export const metals = Object.keys(METALS);

/** Throws where there is no such metal. */
export function checkMetal(metal) {
  if (metal !== null && !Object.hasOwn(METALS, metal)) {
    throw new Error(`metal: found ${JSON.stringify(metal)}; must be one of ${metals.join(', ')}, or null for a metal given by its colour`);
  }
}

/** Reflectance at normal incidence; of a metal given by its colour 1. */
export function reflectance(metal, nm) {
  if (metal === null) return 1;
  const rows = METALS[metal];
  const position = Math.min(Math.max((nm - 380) / 10, 0), rows.length - 1);
  const i = Math.min(Math.floor(position), rows.length - 2);
  const [n, k] = [0, 1].map((c) => rows[i][c] + (position - i) * (rows[i + 1][c] - rows[i][c]));
  return ((n - 1) ** 2 + k * k) / ((n + 1) ** 2 + k * k);
}

/** The colour of a metal at normal incidence, linear Rec.709. */
export function metalColor(metal) {
  checkMetal(metal);
  return [0, 1, 2].map((c) => samples.reduce((sum, s) => sum + s.weight[c] * reflectance(metal, s.nm), 0));
}

/** |D|^2 of a groove: equation (3) of docs/model.md. */
export function phaseStepEnergy(depthNm, nm) {
  return 4 * Math.sin((2 * Math.PI * depthNm) / nm) ** 2;
}

/** How alike the depths of scratches are, given as [depth in nm, weight]: equation (8). 1 for none. */
export function depthCoherence(depths) {
  let ofMean = 0;
  let mean = 0;
  for (let j = 0; j < samples.length; j += 4) {
    const { nm, weight } = samples[j];
    let [re, im, energy, total] = [0, 0, 0, 0];
    for (const [depth, share] of depths) {
      const phase = (4 * Math.PI * depth) / nm;
      re += share * (1 - Math.cos(phase));
      im += share * Math.sin(phase);
      energy += share * phaseStepEnergy(depth, nm);
      total += share;
    }
    const sensitivity = Math.max(weight[1], 0);
    if (total > 0) {
      ofMean += (sensitivity * (re * re + im * im)) / (total * total);
      mean += (sensitivity * energy) / total;
    }
  }
  return mean > 0 ? Math.min(Math.max(ofMean / mean, 0.05), 1) : 1;
}
