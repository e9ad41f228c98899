// Scratches in patterns, laid on a mesh: from a seed both ways along a direction, across edges, until their length is used up, the surface
// ends or an edge bends by more than 60 degrees. As crates/scene/src/scratches does; other random numbers, so other scratches.
import { Scratches, profilesOf } from './scratches.js';

const TURN_BACK_COS = 0.5;
const STEPS_MAX = 100000;
// A chord turns by half a degree, or is as long as two coherence widths.
const CHORD_RAD = Math.PI / 360;
const CHORD_M = 40e-6;

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (a, b, t) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
const unit = (a) => {
  const length = Math.sqrt(dot(a, a));
  return length > 1e-12 ? a.map((x) => x / length) : null;
};
const across = (v, n) => unit(along(v, n, -dot(v, n)));

/** Random numbers of a stream of their own for each scratch, so that more scratches leave those there are. */
function randomStream(seed, index) {
  let state = (Math.imul(seed, 0x9e3779b1) ^ Math.imul(index + 1, 0x85ebca6b)) >>> 0;
  const next = () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
  const normal = () => Math.sqrt(-2 * Math.log(1 - next())) * Math.cos(2 * Math.PI * next());
  return { next, normal };
}

/** Triangles with normals, areas and what lies beyond each edge. Vertices at one place are one. */
function facets({ positions, index }) {
  const places = new Map();
  const vertices = [];
  const vertexOf = (i) => {
    const point = [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
    const key = point.map((x) => Math.fround(x) + 0).join();
    if (!places.has(key)) {
      places.set(key, vertices.length);
      vertices.push(point);
    }
    return places.get(key);
  };
  const count = index ? index.length : positions.length / 3;
  const list = [];
  for (let i = 0; i + 2 < count; i += 3) {
    const corners = [0, 1, 2].map((k) => vertexOf(index ? index[i + k] : i + k));
    const points = corners.map((corner) => vertices[corner]);
    const twice = cross(sub(points[1], points[0]), sub(points[2], points[0]));
    const normal = unit(twice);
    if (normal) list.push({ corners, points, normal, area: 0.5 * Math.sqrt(dot(twice, twice)), beyond: [-1, -1, -1] });
  }
  const edges = new Map();
  list.forEach((facet, f) => {
    for (let e = 0; e < 3; e += 1) {
      const [a, b] = [facet.corners[e], facet.corners[(e + 1) % 3]];
      const key = a < b ? a * 2 ** 26 + b : b * 2 ** 26 + a;
      if (!edges.has(key)) edges.set(key, []);
      edges.get(key).push([f, e]);
    }
  });
  for (const sides of edges.values()) {
    if (sides.length !== 2) continue;
    const [[f, e], [g, h]] = sides;
    list[f].beyond[e] = g;
    list[g].beyond[h] = f;
  }
  return list;
}

/** Where a way from a point of a facet leaves it: the length and the edge. `entry`: the edge that it came by. */
function exitOf(facet, point, direction, entry) {
  let [best, edge] = [Infinity, -1];
  for (let e = 0; e < 3; e += 1) {
    if (e === entry) continue;
    const a = facet.points[e];
    const inwards = cross(facet.normal, sub(facet.points[(e + 1) % 3], a));
    const speed = dot(inwards, direction);
    if (speed >= 0) continue;
    const way = Math.max(dot(inwards, sub(a, point)) / speed, 0);
    if (way < best) [best, edge] = [way, e];
  }
  return { way: best, edge };
}

/** The direction of a pattern at a point; null where it has none. */
function fieldOf(pattern, axis, center, direction) {
  const radial = (point, n) => {
    const out = sub(point, center);
    return across(along(out, axis, -dot(out, axis)), n);
  };
  switch (pattern) {
    case 'random': return null;
    case 'parallel': return (point, n) => across(direction, n);
    case 'circular': return (point, n) => {
      const out = radial(point, n);
      return out && cross(n, out);
    };
    case 'radial': return radial;
    default: throw new Error(`pattern: found ${JSON.stringify(pattern)}; must be "random", "parallel", "circular" or "radial"`);
  }
}

const isSize = (size) => typeof size === 'number' || (typeof size === 'object' && Number.isFinite(size?.mean));

/**
 * Lays scratches on a mesh: `{ positions, index }`, arrays of numbers, index null for a soup of triangles; in the object's own frame.
 * Sizes are `{ mean, spread }` as in docs/scene.md, or a number.
 */
export function layScratches(mesh, {
  pattern = 'random', count, seed = 1, lengthM = { mean: 0.02, spread: 0.5 }, widthUm = { mean: 1.5, spread: 0.3 },
  depthNm = { mean: 200, spread: 0.2 }, profile = 'rectangle', curvaturePerM = { mean: 0, spread: 0 }, jitterDeg = 0, axis = [0, 0, 1], centerM = [0, 0, 0],
  direction = [1, 0, 0], metresPerUnit = 1,
} = {}) {
  if (!Number.isInteger(count) || count < 0) throw new Error(`count: found ${count}; must be a whole number, 0 or more`);
  for (const [name, size] of Object.entries({ lengthM, widthUm, depthNm, curvaturePerM })) {
    if (!isSize(size)) throw new Error(`${name}: found ${JSON.stringify(size)}; must be a number or { mean, spread }`);
  }
  const unitAxis = unit(axis);
  if (!unitAxis || !unit(direction)) throw new Error('axis and direction: found zero; must have a length');
  const list = facets(mesh);
  if (list.length === 0) throw new Error('mesh: found no triangle with an area');
  const center = centerM.map((x) => x / metresPerUnit);
  const field = fieldOf(pattern, unitAxis, center, direction);
  const sums = new Float64Array(list.length);
  let area = 0;
  list.forEach((facet, f) => {
    area += facet.area;
    sums[f] = area;
  });
  const facetAt = (share) => {
    let [low, high] = [0, list.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (sums[middle] < share * area) low = middle + 1;
      else high = middle;
    }
    return low;
  };
  const out = { starts: [], ends: [], widthsUm: [], depthsNm: [], scratch: [], normals: [] };

  for (let index = 0; index < count; index += 1) {
    const random = randomStream(seed, index);
    const drawn = ({ mean, spread = 0 }) => mean * Math.exp(spread * random.normal() - 0.5 * spread * spread);
    const size = (given) => (typeof given === 'number' ? given : drawn(given));
    const seedFacet = facetAt(random.next());
    const facet = list[seedFacet];
    const [r, t] = [Math.sqrt(random.next()), random.next()];
    const [a, b, c] = facet.points;
    const point = along(along(along([0, 0, 0], a, 1 - r), b, r * (1 - t)), c, r * t);
    const angle = 2 * Math.PI * random.next();
    const jitter = (random.normal() * jitterDeg * Math.PI) / 180;
    const length = size(lengthM) / metresPerUnit;
    const width = Math.min(Math.max(size(widthUm), 0.05), 100);
    const depth = Math.min(Math.max(size(depthNm), 0), 2000);
    const bend = typeof curvaturePerM === 'number' ? curvaturePerM : curvaturePerM.mean + (curvaturePerM.spread ?? 0) * random.normal();
    const curvature = field ? 0 : bend * metresPerUnit;
    const x = unit(sub(b, a));
    const free = along(x.map((v) => v * Math.cos(angle)), cross(facet.normal, x), Math.sin(angle));

    /** Pieces from the seed on, ahead or behind. */
    const walk = (sign) => {
      const pieces = [];
      let [f, at, heading, entry, left] = [seedFacet, point, null, -1, length / 2];
      for (let step = 0; step < STEPS_MAX && left > 1e-9; step += 1) {
        const here = list[f];
        const turned = (v, radians) => along(v.map((w) => w * Math.cos(radians)), cross(here.normal, v), Math.sin(radians));
        let aim = heading ? across(heading, here.normal) : free.map((v) => sign * v);
        if (field) {
          const there = field(at, here.normal);
          if (!there) break;
          aim = turned(there, jitter).map((v) => sign * v);
          if (heading && dot(aim, heading) < TURN_BACK_COS) break;
        }
        if (!aim) break;
        let reach = left;
        const bendHere = field && pattern === 'circular'
          ? 1 / Math.max(Math.sqrt(dot(sub(at, center), sub(at, center))), 1e-6) : Math.abs(curvature);
        if (bendHere > 0) reach = Math.min(reach, Math.max(CHORD_RAD / bendHere, Math.min(CHORD_M / metresPerUnit, (10 * CHORD_RAD) / bendHere)));
        const exit = exitOf(here, at, aim, entry);
        const leaves = exit.way <= reach && exit.edge >= 0;
        if (leaves) reach = exit.way;
        // The chord of an arc: half of its turn before it, half after.
        const end = along(at, aim, reach);
        if (reach > 1e-9) pieces.push([at, end, here.normal]);
        left -= reach;
        at = end;
        heading = curvature ? turned(aim, sign * curvature * reach) : aim;
        entry = -1;
        if (!leaves) continue;
        const beyond = here.beyond[exit.edge];
        if (beyond < 0 || dot(here.normal, list[beyond].normal) < TURN_BACK_COS) break;
        // Unfolded about the edge: what runs along it stays, what runs across goes on in the other plane.
        const [p, q] = [here.points[exit.edge], here.points[(exit.edge + 1) % 3]];
        const edge = unit(sub(q, p));
        const inEdge = dot(heading, edge);
        const rest = Math.sqrt(Math.max(1 - inEdge * inEdge, 0));
        const next = list[beyond];
        entry = next.beyond.indexOf(f);
        heading = along(edge.map((v) => v * inEdge), cross(edge, next.normal), rest);
        const towards = sub(next.points[(entry + 2) % 3], at);
        if (dot(heading, towards) < inEdge * dot(edge, towards)) heading = along(edge.map((v) => v * inEdge), cross(next.normal, edge), rest);
        f = beyond;
      }
      return pieces;
    };
    const behind = walk(-1).reverse().map(([start, end, n]) => [end, start, n]);
    for (const [start, end, n] of [...behind, ...walk(1)]) {
      out.starts.push(...start);
      out.ends.push(...end);
      out.normals.push(...n);
      out.widthsUm.push(width);
      out.depthsNm.push(depth);
      out.scratch.push(index);
    }
  }
  return new Scratches({
    starts: Float64Array.from(out.starts), ends: Float64Array.from(out.ends), widthsUm: Float64Array.from(out.widthsUm),
    depthsNm: Float64Array.from(out.depthsNm), scratch: Uint32Array.from(out.scratch), normals: Float64Array.from(out.normals),
    profiles: profilesOf(profile, out.scratch.length),
  });
}
