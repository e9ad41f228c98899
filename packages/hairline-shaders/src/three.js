// ScratchedNodeMaterial for three.js, WebGPURenderer: metal or lacquer with scratches that split light into colours. PointLight, SpotLight,
// DirectionalLight, SunLight and RectAreaLight light it in closed form, with three's own shadows; environments by three's own maps.
//
// The world is in metres. Lights without a size get one: `light.userData.radius` in metres (of a light in the sky `userData.angle` in
// radians), or the material's `lightRadius`.
import {
  DataArrayTexture, DataTexture, FloatType, InstancedInterleavedBuffer, InterleavedBufferAttribute, MeshStandardNodeMaterial,
  PhysicalLightingModel, RGBAFormat, RGBAIntegerFormat, UnsignedIntType, Vector3,
} from 'three/webgpu';
import {
  Break, If, Loop, buffer, cameraProjectionMatrix, cameraWorldMatrix, dFdx, dFdy, diffuseColor, diffuseContribution, float, instanceIndex,
  instancedBufferAttribute, lightViewPosition, mat3, mat4, materialEnvIntensity, materialRoughness, metalness, mix, modelViewMatrix, normalView,
  normalViewGeometry, pmremTexture, positionGeometry, positionView, texture, uint, uniform, varying, vec2, vec3, vec4, viewportSize, viewportUV,
} from 'three/tsl';
import { Scratches, preparedPieces, readScratches } from './scratches.js';
import { layScratches } from './pattern.js';
import { narrowRectangle } from './section.js';
import { scratchTree } from './tree.js';
import { scratchTable, tableSize } from './table.js';
import { curveOf } from './tables.js';
import { metalColor } from './spectrum.js';
import {
  bandCell, bandOf, baseBody, baseByQuad, baseBySphere, baseReflected, fresnelOf, maskOf, scratchesByQuad, scratchesBySphere, viewFromSurface,
} from './three_functions.js';
import { isFar } from './three_lights.js';

export { loadTables } from './tables.js';
export { Scratches, readScratches };

/** The sun's, as a light's `userData.angle`. */
const SUN_RAD = 0.00465;
/** The greatest number of half floats. */
const GREATEST_HALF = 65504;
/** How far a light in the sky stands off. */
const FAR_M = 1000;
/** More scratches of one pixel do not mirror the environment. */
const SCRATCHES_MAX = 4096;

/** Lays scratches in a pattern on a BufferGeometry, see layScratches(). */
export function scratchesOn(geometry, options) {
  const { position } = geometry.attributes;
  const positions = new Float64Array(3 * position.count);
  for (let i = 0; i < position.count; i += 1) positions.set([position.getX(i), position.getY(i), position.getZ(i)], 3 * i);
  return layScratches({ positions, index: geometry.index?.array ?? null }, options);
}

/** From the object's frame to the view's, without the move: of a mesh, or of each instance. */
function viewFromObject(object) {
  if (!object.isInstancedMesh) return mat3(modelViewMatrix);
  const { instanceMatrix } = object;
  const count = Math.max(instanceMatrix.count, 1);
  let matrix;
  if (count <= 1000) {
    matrix = buffer(instanceMatrix.array, 'mat4', count).element(instanceIndex);
  } else {
    const columns = new InstancedInterleavedBuffer(instanceMatrix.array, 16, 1);
    matrix = mat4(...[0, 4, 8, 12].map((offset) => instancedBufferAttribute(new InterleavedBufferAttribute(columns, 4, offset))));
  }
  const whole = modelViewMatrix.mul(matrix).toVar();
  return mat3(...[0, 1, 2].map((i) => varying(whole.element(i).xyz)));
}

class ScratchedLightingModel extends PhysicalLightingModel {
  constructor(material, environment) {
    super();
    this.material = material;
    this.environment = environment;
  }

  start(builder) {
    const { material } = this;
    const nodes = material.hairlineNodes;
    const side = normalViewGeometry.dot(normalView).sign();
    const perspective = vec2(cameraProjectionMatrix.element(0).x, cameraProjectionMatrix.element(1).y).toVar();
    const middle = cameraProjectionMatrix.element(2).xy;
    const place = {
      position: positionGeometry,
      view_from_object: viewFromObject(builder.object).toVar(),
      position_view: positionView,
      normal_view: normalView,
      pixel: vec3(vec2(2).div(viewportSize.mul(perspective)), cameraProjectionMatrix.element(3).w).toVar(),
      ray_view: viewportUV.mul(vec2(2, -2)).add(vec2(-1, 1)).add(middle).div(perspective).toVar(),
      move_x: dFdx(positionView).toVar(),
      move_y: dFdy(positionView).toVar(),
      turn_x: dFdx(normalViewGeometry).mul(side).toVar(),
      turn_y: dFdy(normalViewGeometry).mul(side).toVar(),
    };
    const roughness = material.roughnessNode ? float(material.roughnessNode) : materialRoughness;
    this.base = {
      ...place, surface: vec4(mix(vec3(0.04), diffuseColor.rgb, metalness), roughness).toVar(), curve: nodes.curve,
      shapes: nodes.shapes, albedo: nodes.albedo, curves: nodes.curves,
    };
    this.scratches = material.scratches ? { ...place, tree: nodes.tree, tables: nodes.table } : null;
    this.specular = vec3(0).toVar();
    this.diffuse = vec3(0).toVar();
    this.scratchLight = vec3(0).toVar();

    super.start(builder);

    const { reflectedLight } = builder.context;
    const reflected = baseReflected({ ...this.base, specular: this.specular });
    reflectedLight.directDiffuse.addAssign(this.diffuse.mul(diffuseContribution).mul(baseBody(this.base)));
    if (!this.scratches) {
      reflectedLight.directSpecular.addAssign(reflected);
      return;
    }
    const mask = maskOf(this.scratches).toVar();
    const left = mask.xyz.oneMinus().toVar();
    if (this.environment) this.scratchLight.addAssign(this.scratchesByEnvironment());
    const coloured = this.scratchLight.mul(mask.w).mul(fresnelOf(this.base));
    // Channels that lie outside of the gamut stay below zero where the picture is a float one, and are cut by the display.
    reflectedLight.directSpecular.addAssign(reflected.mul(left).add(coloured));
    reflectedLight.indirectSpecular.mulAssign(left);
  }

  direct({ lightDirection, lightColor, lightNode }) {
    const { light } = lightNode;
    const { lightRadius } = this.material;
    let center;
    let radius;
    let distanceSquared;
    if (isFar(light)) {
      center = positionView.add(lightDirection.mul(FAR_M));
      radius = uniform(0).onRenderUpdate(() => FAR_M * Math.sin(light.userData.angle ?? SUN_RAD));
      distanceSquared = float(FAR_M * FAR_M);
    } else {
      center = lightViewPosition(light);
      radius = uniform(0).onRenderUpdate(() => light.userData.radius ?? lightRadius);
      const way = center.sub(positionView);
      // three.js holds its fall-off at that of 0.1 m.
      distanceSquared = way.dot(way).max(0.01);
    }
    const radiance = lightColor.mul(distanceSquared).div(radius.mul(radius).mul(Math.PI)).toVar();
    this.light(radiance, { light: vec4(center, radius).toVar() }, baseBySphere, scratchesBySphere);
  }

  directRectArea({ lightColor, lightPosition, halfWidth, halfHeight }) {
    // The light shines to its own -z.
    const quad = { middle: lightPosition.toVar(), half_width: halfHeight.toVar(), half_height: halfWidth.toVar() };
    this.light(lightColor.toVar(), quad, baseByQuad, scratchesByQuad);
  }

  light(radiance, shape, base, scratches) {
    const lit = base({ ...this.base, ...shape }).toVar();
    this.specular.addAssign(radiance.mul(lit.xyz));
    this.diffuse.addAssign(radiance.mul(lit.w));
    if (this.scratches) this.scratchLight.addAssign(radiance.mul(scratches({ ...this.scratches, ...shape })));
  }

  scratchesByEnvironment() {
    const { tree: _, tables, ...place } = this.scratches;
    const sum = vec3(0).toVar();
    const axes = viewFromSurface(place).toVar();
    const band = mat4(vec4(0), vec4(0), vec4(0), vec4(0)).toVar();
    Loop({ start: uint(0), end: uint(SCRATCHES_MAX), type: 'uint', condition: '<', name: 'scratch' }, () => {
      band.assign(bandOf({ ...this.scratches, walked: band }));
      If(band.element(3).y.equal(0), () => Break());
      If(band.element(0).z.greaterThan(0), () => {
        Loop({ start: uint(0), end: uint(10), type: 'uint', condition: '<', name: 'cell' }, ({ cell }) => {
          const found = bandCell({ band, tables, j: cell }).toVar();
          const direction = axes.mul(found.element(0).xyz).transformDirection(cameraWorldMatrix);
          const radiance = pmremTexture(this.environment, direction, found.element(0).w).mul(materialEnvIntensity);
          sum.addAssign(radiance.mul(found.element(1).xyz));
        });
      });
    });
    return sum;
  }
}

function floatTexture({ data, width, height }) {
  const made = new DataTexture(data, width, height, RGBAFormat, FloatType);
  made.needsUpdate = true;
  return made;
}

const shared = new WeakMap();

/** The textures of a set of tables, made once. */
function texturesOf(tables) {
  if (!shared.has(tables)) {
    shared.set(tables, { shapes: floatTexture(tables.shapes), albedo: floatTexture(tables.albedo), curves: floatTexture(tables.curves), metals: new Map() });
  }
  return shared.get(tables);
}

/** The tables of a metal: a layer for each shape of grooves. */
function tableTexture(tables, metal, shapes) {
  const { metals } = texturesOf(tables);
  const key = JSON.stringify([metal, shapes]);
  if (!metals.has(key)) {
    const layers = shapes.map((shape) => scratchTable(metal, shape));
    const texels = new Uint32Array(layers.length * layers[0].length);
    layers.forEach((layer, i) => texels.set(layer, i * layer.length));
    const made = new DataArrayTexture(texels, tableSize.columns, tableSize.rows, layers.length);
    made.format = RGBAIntegerFormat;
    made.type = UnsignedIntType;
    made.needsUpdate = true;
    metals.set(key, made);
  }
  return metals.get(key);
}

function treeTexture(prepared, metresPerUnit) {
  const { texels, width, height } = scratchTree(prepared, { metresPerUnit });
  const made = new DataTexture(texels, width, height, RGBAIntegerFormat, UnsignedIntType);
  made.needsUpdate = true;
  return made;
}

/**
 * MeshStandardNodeMaterial with scratches. Besides its own parameters: `tables` of loadTables(); `metal` by name, or null for `color` and
 * `metalness`; `scratches` in the object's own frame, or null; `coherenceUm`; `metresPerUnit`, how long a unit of the object's frame is;
 * `lightRadius` of lights that have none.
 */
export class ScratchedNodeMaterial extends MeshStandardNodeMaterial {
  static get type() {
    return 'ScratchedNodeMaterial';
  }

  constructor({ tables, metal = null, scratches = null, coherenceUm = 20, metresPerUnit = 1, lightRadius = 0.005, ...parameters } = {}) {
    super();
    if (!tables) throw new Error('tables: found none; must be what loadTables() returned');
    if (scratches !== null && !(scratches instanceof Scratches)) {
      throw new Error('scratches: found something else; must be what readScratches() or scratchesOn() returned, or null');
    }
    this.isScratchedNodeMaterial = true;
    Object.assign(this, { tables, metal, coherenceUm, metresPerUnit, lightRadius });
    const { shapes, albedo, curves } = texturesOf(tables);
    this.scratches = scratches;
    const prepared = scratches && preparedPieces(scratches, { coherenceUm, metresPerUnit });
    const tree = prepared && texture(treeTexture(prepared, metresPerUnit));
    const table = tableTexture(tables, metal, prepared?.shapes ?? [narrowRectangle]);
    Object.defineProperty(this, 'hairlineNodes', {
      value: {
        shapes: texture(shapes), albedo: texture(albedo), curves: texture(curves), table: texture(table), tree,
        curve: uniform(curveOf(metal)),
      },
    });
    if (metal !== null) {
      this.color.setRGB(...metalColor(metal));
      this.metalness = 1;
    }
    this.setValues(parameters);
  }

  setupLightingModel(builder) {
    if (!builder.renderer.backend.isWebGPUBackend) {
      throw new Error('ScratchedNodeMaterial: found the backend for WebGL; must be that for WebGPU, which this browser lacks or `forceWebGL` turns off');
    }
    this.checkScale(builder.object);
    const environment = this.setupEnvironment(builder);
    return new ScratchedLightingModel(this, environment && environmentTexture(environment.envNode, this));
  }

  /** Mirror images of lamps exceed half floats, of which a canvas is: as infinities they would be tone mapped to black. */
  setupOutput(builder, output) {
    return super.setupOutput(builder, vec4(output.rgb.min(GREATEST_HALF), output.a));
  }

  /** Scratches of another scale than they were made for end in the wrong places. */
  checkScale({ matrixWorld, name }) {
    const scale = new Vector3().setFromMatrixScale(matrixWorld);
    const isRight = scale.toArray().every((s) => Math.abs(s / this.metresPerUnit - 1) < 0.01);
    if (this.scratches && !isRight) {
      console.warn(`ScratchedNodeMaterial: found the scale ${scale.toArray().join(', ')} of mesh "${name}"; must be metresPerUnit, ${this.metresPerUnit}`);
    }
  }

  customProgramCacheKey() {
    // Each material has its own textures.
    return `${super.customProgramCacheKey()}-${this.id}`;
  }

  clone() {
    const { tables, metal, scratches, coherenceUm, metresPerUnit, lightRadius } = this;
    return new ScratchedNodeMaterial({ tables, metal, scratches, coherenceUm, metresPerUnit, lightRadius }).copy(this);
  }

  dispose() {
    this.hairlineNodes.tree?.value.dispose();
    super.dispose();
  }
}

/** The texture of an environment; a node that gives colours by itself is not looked up by scratches. */
function environmentTexture(node, material) {
  if (node?.isMaterialReferenceNode) return material.envMap;
  return node?.isTextureNode ? node.value : null;
}
