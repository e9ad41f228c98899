// Pictures on gratings and texture coordinates that they follow: a grating as one pixel has it.
import { BufferAttribute, Vector2, Vector3 } from 'three/webgpu';
import { attribute, cross, dFdx, dFdy, mat4, normalGeometry, positionGeometry, texture, textureSize, uv, vec2, vec3, vec4 } from 'three/tsl';
import { isByUv } from './gratings.js';
import { pixelWays } from './three_functions.js';

/** A value of the geometry, so many steps of dFdx and dFdy off. */
function valueOf(value) {
  const here = value.toVar();
  const [x, y] = [dFdx(here).toVar(), dFdy(here).toVar()];
  return { x, y, at: (off) => here.add(x.mul(off.x)).add(y.mul(off.y)) };
}

/** Look-ups of the mean of a picture over a pixel: at the level of the pixel's area, as picture_share() of crates/scene/src/grating/ground.rs has it. */
function meansOf(picture) {
  const node = texture(picture);
  const { x, y, at } = valueOf(node.getTransformedUV(uv(picture.channel)));
  const size = vec2(textureSize(node));
  const area = x.x.mul(y.y).sub(x.y.mul(y.x)).abs().mul(size.x.mul(size.y));
  const level = area.max(1).log2().mul(0.5).toVar();
  return (off) => texture(picture, at(off), level);
}

/**
 * Adds tangents to a geometry as an attribute, as Hairline makes them for models without: of each vertex the mean of its triangles' derivatives of the position
 * by u. In pictures that are not flipped v falls along the bitangent. Returns the attribute's name.
 */
function addTangents(geometry, channel, isFlipped) {
  const name = `grooveTangent${channel}${isFlipped ? 'Flipped' : ''}`;
  const { position, normal } = geometry.attributes;
  const uvs = geometry.attributes[channel > 0 ? `uv${channel}` : 'uv'];
  if (geometry.hasAttribute(name) || !uvs) return name;
  const tangents = new Float32Array(4 * position.count);
  const corners = geometry.index?.array ?? Uint32Array.from({ length: position.count }, (_, i) => i);
  const [e1, e2, n, along] = [0, 1, 2, 3].map(() => new Vector3());
  const [a, b, c] = [0, 1, 2].map(() => ({ place: new Vector3(), at: new Vector2() }));
  for (let i = 0; i + 2 < corners.length; i += 3) {
    [a, b, c].forEach(({ place, at }, k) => {
      place.fromBufferAttribute(position, corners[i + k]);
      at.fromBufferAttribute(uvs, corners[i + k]);
    });
    e1.subVectors(b.place, a.place);
    e2.subVectors(c.place, a.place);
    const [d1, d2] = [b, c].map(({ at }) => at.sub(a.at));
    const area = d1.cross(d2);
    along.copy(e1).multiplyScalar(d2.y).addScaledVector(e2, -d1.y).divideScalar(area);
    if (![along.x, along.y, along.z].every(Number.isFinite)) continue;
    const across = e1.cross(e2);
    for (const corner of corners.subarray(i, i + 3)) {
      along.toArray().forEach((x, k) => { tangents[4 * corner + k] += x; });
      const around = normal ? across.dot(n.fromBufferAttribute(normal, corner)) : across.length();
      tangents[4 * corner + 3] += Math.sign(area) * around;
    }
  }
  for (let i = 0; i < position.count; i += 1) {
    along.fromArray(tangents, 4 * i);
    if (normal) along.projectOnPlane(n.fromBufferAttribute(normal, i));
    along.normalize().toArray(tangents, 4 * i);
    tangents[4 * i + 3] = tangents[4 * i + 3] > 0 === isFlipped ? 1 : -1;
  }
  geometry.setAttribute(name, new BufferAttribute(tangents, 4));
  return name;
}

/** Look-ups of tangent and bitangent of the geometry, in its own frame. */
function axesOf(geometry, { channel = 0, flipY: isFlipped = false } = {}) {
  const given = attribute(geometry.hasAttribute('tangent') ? 'tangent' : addTangents(geometry, channel, isFlipped), 'vec4');
  const tangent = valueOf(given.xyz);
  // Without normals each triangle is flat.
  const normal = valueOf(geometry.hasAttribute('normal') ? normalGeometry : cross(dFdx(positionGeometry), dFdy(positionGeometry)));
  return (off) => {
    const n = normal.at(off).normalize().toVar();
    const along = tangent.at(off).toVar();
    const t = along.sub(n.mul(n.dot(along))).toVar();
    return [t, cross(n, t).mul(given.w)];
  };
}

/** Look-ups of the direction of grooves by texture coordinates, in the frame of the geometry. */
function directionsOf({ kind, directions }, geometry) {
  const axes = axesOf(geometry, directions ?? undefined);
  const means = directions && meansOf(directions);
  return (off) => {
    const [tangent, bitangent] = axes(off);
    const way = directions ? means(off).xy.mul(2).sub(1).toVar() : vec2(1, 0);
    return kind === 'along-v' ? bitangent.mul(way.x).sub(tangent.mul(way.y)) : tangent.mul(way.x).add(bitangent.mul(way.y));
  };
}

/** The filter of a pixel is half a pixel wide: to either side of the middle grooves have turned over half of that. */
const HALF_STEP = 0.25;

/** Parameters `field`, `bend_x` and `bend_y` of a grating whose numbers are `field`. `place`: the first parameters of all functions. */
export function groovesAt(grating, field, place, geometry) {
  const { mask } = grating;
  const isFollowing = isByUv(grating);
  const bends = [vec3(0), vec3(0)];
  if (!mask && !isFollowing) return { field, bend_x: bends[0], bend_y: bends[1] };
  const columns = [0, 1, 2, 3].map((i) => field.element(i));
  const ways = pixelWays(place).toVar();
  const [middle, ...pixels] = [0, 1, 2].map((i) => ways.element(i).xy);
  if (isFollowing) {
    const direction = directionsOf(grating, geometry);
    columns[0] = vec4(direction(middle), columns[0].w);
    pixels.forEach((pixel, i) => {
      const step = pixel.mul(HALF_STEP).toVar();
      bends[i] = direction(middle.add(step)).sub(direction(middle.sub(step))).div(2 * HALF_STEP).toVar();
    });
  }
  if (mask) columns[2] = columns[2].mul(vec4(1, 1, meansOf(mask)(middle).r, 1));
  return { field: mat4(...columns).toVar(), bend_x: bends[0], bend_y: bends[1] };
}
