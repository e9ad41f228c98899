// Pictures on gratings and texture coordinates that they follow: a grating as one pixel has it.
import {
  cross, dFdx, dFdy, mat4, normalGeometry, positionGeometry, tangentGeometry, texture, textureSize, uv, vec2, vec3, vec4,
} from 'three/tsl';
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

/** Look-ups of tangent and bitangent of the geometry, in its own frame. */
function ownAxes() {
  const [tangent, normal] = [tangentGeometry.xyz, normalGeometry].map(valueOf);
  return (off) => {
    const n = normal.at(off).normalize().toVar();
    const given = tangent.at(off).toVar();
    const t = given.sub(n.mul(n.dot(given))).toVar();
    return [t, cross(n, t).mul(tangentGeometry.w)];
  };
}

/** The same of each triangle, for a geometry without tangents. In pictures that are not flipped v falls along the bitangent. */
function triangleAxes(channel, isFlipped) {
  const [place, at] = [positionGeometry, uv(channel)].map(valueOf);
  const side = at.x.x.mul(at.y.y).sub(at.x.y.mul(at.y.x)).sign();
  const unit = (v) => v.mul(v.dot(v).max(1e-30).inverseSqrt()).toVar();
  const tangent = unit(place.x.mul(at.y.y).sub(place.y.mul(at.x.y)).mul(side));
  const axes = [tangent, cross(unit(cross(place.x, place.y)), tangent).mul(side.mul(isFlipped ? 1 : -1))];
  return () => axes;
}

/** Look-ups of the direction of grooves by texture coordinates, in the frame of the geometry. */
function directionsOf({ kind, directions }, geometry) {
  const hasAxes = ['tangent', 'normal'].every((name) => geometry.hasAttribute(name));
  const axes = hasAxes ? ownAxes() : triangleAxes(directions?.channel ?? 0, directions?.flipY);
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
