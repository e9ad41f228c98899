// The cross section of a groove, and its class under a coherence window. Twin: crates/optics/src/section.rs.
import { erf } from './erf.js';

/** Names of cross sections. */
const PROFILES = ['rectangle', 'v', 'round', 'shoulders'];
const BETWEEN_SHOULDERS = 0.6;
const SHOULDER_HEIGHT = 0.5;

/** Largest width of a class of wide grooves, and the one that stands for it, over the window's standard deviation. */
const NARROW = 0.4;
const CLASSES = [[0.7, 0.53], [1.2, 0.92], [2, 1.55], [3.4, 2.6], [Infinity, 5]];

/** Grooves that need no other: their table is the first one of every metal. */
export const narrowRectangle = Object.freeze({ profile: 'rectangle', widthClass: 0 });

/** Throws where there is no such cross section. */
export function checkProfile(profile) {
  const isList = Array.isArray(profile) && profile.length >= 2 && profile.length <= 64
    && profile.every((depth) => Math.abs(depth) <= 1) && profile.some((depth) => depth !== 0);
  if (!isList && !PROFILES.includes(profile)) {
    throw new Error(`profile: found ${JSON.stringify(profile)}; must be one of ${PROFILES.join(', ')}, or 2 to 64 depths of -1 to 1, not all 0`);
  }
}

/** Whether two shapes are the same. */
export function isSameShape(a, b) {
  return a.widthClass === b.widthClass && String(a.profile) === String(b.profile);
}

/** Depth over the deepest one, at x half widths from the middle. */
export function depthShare(profile, at) {
  const x = Math.abs(at);
  if (x >= 1) return 0;
  switch (profile) {
    case 'rectangle': return 1;
    case 'v': return 1 - x;
    case 'round': return 1 - x * x;
    case 'shoulders': {
      if (x < BETWEEN_SHOULDERS) return 1 - (x / BETWEEN_SHOULDERS) ** 2;
      const t = (x - BETWEEN_SHOULDERS) / (1 - BETWEEN_SHOULDERS);
      return -4 * SHOULDER_HEIGHT * t * (1 - t);
    }
    default: {
      const place = x * (profile.length - 1);
      const i = Math.min(Math.floor(place), profile.length - 2);
      return profile[i] + (place - i) * (profile[i + 1] - profile[i]);
    }
  }
}

/** Depths of strips that stand for the section, all as wide, over the deepest. */
export function stripDepths(profile, count) {
  if (profile === 'rectangle') return [1];
  return Array.from({ length: count }, (_, i) => depthShare(profile, (2 * i + 1) / count - 1));
}

/** Class of a width over the window's standard deviation: 0 for narrow grooves. */
export function widthClassOf(windows) {
  return windows > NARROW ? 1 + CLASSES.findIndex(([most]) => windows <= most) : 0;
}

/** Width over the window's standard deviation that stands for the class; 0 for a narrow groove. */
export function widthInWindows({ widthClass }) {
  return widthClass === 0 ? 0 : CLASSES[widthClass - 1][1];
}

/** Number of parts that a groove counts as. */
export function partCount({ profile, widthClass }) {
  if (widthClass === 0) return 1;
  return widthClass === CLASSES.length && profile !== 'rectangle' ? 4 : 2;
}

/** Width of the groove over that of the share of a part. */
export function widthsOfPart(shape) {
  const windows = widthInWindows(shape);
  if (windows === 0) return 1;
  const taken = windows * (1 - erf(windows / Math.SQRT2)) + Math.sqrt(2 / Math.PI) * (1 - Math.exp(-0.5 * windows * windows));
  return (partCount(shape) * windows) / taken;
}

/** The parts of a wide groove: how far each lies from its middle, and the width of the share of each. */
export function partsOf(shape, widthUm, coherenceUm) {
  const isFloor = shape.profile === 'rectangle';
  const count = partCount(shape);
  const litUm = isFloor ? Math.min(widthUm, CLASSES[CLASSES.length - 1][1] * coherenceUm) : widthUm;
  return {
    offsetsUm: Array.from({ length: count }, (_, i) => (isFloor ? i - 0.5 : (i + 0.5) / count - 0.5) * widthUm),
    widthUm: litUm / widthsOfPart(shape),
  };
}
