// What a groove sends across itself, over depth and angle. Twin: crates/optics/src/groove_spectrum.rs, with twice the rows.
import { depthShare, widthInWindows } from './section.js';

/** Depth over wavelength of the last row: 2 um in 380 nm. */
const ROW_MAX = 2000 / 380;
const ROWS = 513;
const STEP = 0.05;
const COLUMNS = 1281;
const END = STEP * (COLUMNS - 1);
/** Samples of half a section. */
const SAMPLES = 128;

const sinc = (x) => (Math.abs(x) < 1e-4 ? 1 - (x * x) / 6 : Math.sin(x) / x);
const placeOf = (sample) => (sample + 0.5) / (2 * SAMPLES);
const turnOf = (column) => 2 * Math.PI * STEP * column;
const lineOf = (at) => Float64Array.from({ length: COLUMNS + 1 }, (_, i) => at(i));

/** 1 - exp(-i 4 pi d s / lambda) at the samples of half a section: real and imaginary parts. */
function phaseSteps(profile, depth) {
  const [real, imaginary] = [new Float64Array(SAMPLES), new Float64Array(SAMPLES)];
  for (let j = 0; j < SAMPLES; j += 1) {
    const half = 2 * Math.PI * depth * depthShare(profile, 2 * placeOf(j));
    real[j] = 2 * Math.sin(half) ** 2;
    imaginary[j] = 2 * Math.sin(half) * Math.cos(half);
  }
  return [real, imaginary];
}

/** The autocorrelation of the whole section, at lags of one sample. */
function autocorrelation(parts) {
  const alike = new Float64Array(2 * SAMPLES);
  for (const part of parts) {
    const whole = [...part.slice().reverse(), ...part];
    for (let first = 0; first < whole.length; first += 1) {
      for (let lag = 0; first + lag < whole.length; lag += 1) alike[lag] += (whole[first] * whole[first + lag]) / (2 * SAMPLES);
    }
  }
  return alike;
}

/** The sum of factors times lines. */
function product(factors, lines) {
  const sums = new Float64Array(COLUMNS + 1);
  lines.forEach((line, j) => {
    const factor = factors[j];
    for (let i = 0; i <= COLUMNS; i += 1) sums[i] += factor * line[i];
  });
  return sums;
}

/** What makes density and limit of the phase steps of a narrow groove. */
function narrowKernel() {
  const each = 1 / SAMPLES;
  const lines = Array.from({ length: SAMPLES }, (_, j) => lineOf((i) => each * sinc(0.25 * turnOf(i) * each) * Math.cos(turnOf(i) * placeOf(j))));
  return (parts) => {
    const [a, b] = parts.map((part) => product(part, lines));
    const energy = parts.reduce((sum, part) => part.reduce((all, x) => all + x * x, sum), 0);
    return { density: a.map((x, i) => x * x + b[i] * b[i]), limit: 0.5 * each * energy };
  };
}

/** The same for a groove that is `windows` standard deviations of the window wide. */
function wideKernel(windows) {
  const each = 1 / (2 * SAMPLES);
  const weight = (lag, narrowing) => (lag === 0 ? 1 : 2) * each * Math.exp(-((windows * each * lag) ** 2) * narrowing);
  const lags = Array.from({ length: 2 * SAMPLES }, (_, lag) => lag);
  const lines = lags.map((lag) => {
    const [own, cross, mirror] = [0.25, 1 / 3, 0.5].map((narrowing) => weight(lag, narrowing));
    return lineOf((i) => {
      const turn = turnOf(i);
      const x2 = (turn / windows) ** 2;
      const beside = x2 < 40
        ? Math.SQRT2 * Math.exp(-x2) * mirror - (4 / Math.sqrt(3)) * Math.exp((-x2 * 2) / 3) * cross * Math.cos((turn * lag * each * 2) / 3)
        : 0;
      return sinc(0.5 * turn * each) ** 2 * own * Math.cos(turn * lag * each) + beside;
    });
  });
  const limits = lags.map((lag) => 0.5 * ((lag === 0 ? 1 : 0) - (windows / Math.sqrt(2 * Math.PI)) * weight(lag, 0.5)));
  return (parts) => {
    const alike = autocorrelation(parts);
    return { density: product(alike, lines).map((x) => Math.max(x, 0)), limit: limits.reduce((sum, x, lag) => sum + x * alike[lag], 0) };
  };
}

/** The grid of a shape: a function of depth over wavelength, which gives one of ascending places u over wavelength: [density, integral]. */
export function grooveSpectrum(shape) {
  const windows = widthInWindows(shape);
  const kernel = windows > 0 ? wideKernel(windows) : narrowKernel();
  const densities = new Float64Array(ROWS * COLUMNS);
  const integrals = new Float64Array(ROWS * COLUMNS);
  const limits = new Float64Array(ROWS);
  for (let row = 0; row < ROWS; row += 1) {
    const { density, limit } = kernel(phaseSteps(shape.profile, (row * ROW_MAX) / (ROWS - 1)));
    limits[row] = limit;
    let integral = 0;
    for (let i = 0; i < COLUMNS; i += 1) {
      densities[row * COLUMNS + i] = density[i];
      integrals[row * COLUMNS + i] = integral;
      const [before, after] = [density[Math.abs(i - 1)], density[Math.min(i + 2, COLUMNS)]];
      integral += (STEP / 24) * (13 * (density[i] + density[i + 1]) - before - after);
    }
  }
  const [d, q] = [new Float64Array(COLUMNS), new Float64Array(COLUMNS)];
  return (depth) => {
    const y = (Math.min(Math.max(depth, 0), ROW_MAX) * (ROWS - 1)) / ROW_MAX;
    const row = Math.min(Math.floor(y), ROWS - 2);
    const share = y - row;
    const between = (of, at, next) => of[at] + share * (of[next] - of[at]);
    for (let i = 0, at = row * COLUMNS; i < COLUMNS; i += 1, at += 1) {
      d[i] = between(densities, at, at + COLUMNS);
      q[i] = between(integrals, at, at + COLUMNS);
    }
    const limit = between(limits, row, row + 1);
    const tail = (limit - q[COLUMNS - 1]) * END;
    /** Puts density and integral at a place into `out`. */
    const at = (u, out) => {
      if (u >= END) {
        out[0] = tail / u / u;
        out[1] = limit - tail / u;
        return;
      }
      const x = u / STEP;
      const i = Math.min(Math.floor(x), COLUMNS - 2);
      const t = x - i;
      const rise = (q[i + 1] - q[i]) / STEP;
      const second = 3 * rise - 2 * d[i] - d[i + 1];
      const third = d[i] + d[i + 1] - 2 * rise;
      out[0] = d[i] + t * (2 * second + 3 * t * third);
      out[1] = q[i] + STEP * t * (d[i] + t * (second + t * third));
    };
    return { at, tail };
  };
}
