// Hairline's own maps of an environment for three.js: base, scratches and gratings then mirror it as `hairline render` has it.
import { DataTexture, DataUtils, FloatType, HalfFloatType, NearestFilter, NearestMipmapNearestFilter, RGBAFormat } from 'three/webgpu';
import { cameraWorldMatrix, mat3, materialEnvIntensity, materialEnvRotation, positionView, texture, vec3, vec4 } from 'three/tsl';
import { beside } from './beside.js';

const known = new WeakMap();
let count = 0;

/** The maps that prepareEnvironment() made of a texture, or null. */
export const mapsOf = (map) => known.get(map) ?? null;

/** How many environments have maps: materials that were compiled for fewer are out of date. */
export const preparedCount = () => count;

/** Numbers of an equirectangular texture, three a pixel, rows from the top. */
function rowsFromTop({ image, format, type, flipY, isDataTexture }) {
  if (!isDataTexture || format !== RGBAFormat || (type !== FloatType && type !== HalfFloatType)) {
    throw new Error('environment: found a texture of another kind; must be an equirectangular DataTexture of RGBA in floats or half floats, as HDRLoader and EXRLoader return it');
  }
  const { data, width, height } = image;
  const rgb = new Float32Array(3 * width * height);
  const number = type === FloatType ? (value) => value : DataUtils.fromHalfFloat;
  for (let row = 0; row < height; row += 1) {
    // Unturned textures begin with their lowest row.
    const from = flipY ? row : height - 1 - row;
    for (let x = 0; x < width; x += 1) {
      for (let c = 0; c < 3; c += 1) rgb[3 * (row * width + x) + c] = number(data[4 * (from * width + x) + c]);
    }
  }
  return { rgb, width };
}

function levelsTexture(texels, width) {
  const mipmaps = [];
  for (let at = 0, side = width; at < texels.length; at += 4 * side * side, side /= 2) {
    mipmaps.push({ data: texels.subarray(at, at + 4 * side * side), width: side, height: side });
  }
  const made = new DataTexture(mipmaps[0].data, width, width, RGBAFormat, HalfFloatType);
  Object.assign(made, { mipmaps, magFilter: NearestFilter, minFilter: NearestMipmapNearestFilter, needsUpdate: true });
  return made;
}

/**
 * Makes Hairline's maps of an equirectangular texture that is or becomes `scene.environment` or a material's `envMap`, in a worker: some seconds. Materials
 * that were drawn before need `needsUpdate`.
 */
export async function prepareEnvironment(map) {
  if (known.has(map)) return;
  const { levels, width, ...rest } = await beside('maps', rowsFromTop(map));
  known.set(map, { ...rest, levels: levelsTexture(levels, width) });
  count += 1;
}

/** From three.js's maps to Hairline's, whose middle column is at -z where three.js has it at x. */
const mapFromThree = mat3(vec3(0, 0, -1), vec3(0, 1, 0), vec3(1, 0, 0));

/** What shaders are given of prepared maps: arguments for look-ups, a factor on these, and the suns that were parted from the map. */
export class EnvironmentNodes {
  constructor({ levels, texelRadiance, suns }) {
    const map_from_view = mapFromThree.mul(mat3(materialEnvRotation)).mul(mat3(cameraWorldMatrix)).toVar();
    this.maps = { levels: texture(levels), map_from_view };
    this.factor = materialEnvIntensity.mul(texelRadiance);
    this.viewFromMap = map_from_view.transpose().toVar();
    this.suns = suns.map((sun) => this.sun(sun));
  }

  /** Radiance, a shape, and the name of the functions that take it. The map is as far from every point. */
  sun({ radiance, center, radius }) {
    const lit = vec3(...radiance).mul(materialEnvIntensity);
    return [lit, { light: vec4(this.viewFromMap.mul(vec3(...center)).add(positionView), radius).toVar() }, 'bySphere'];
  }
}
