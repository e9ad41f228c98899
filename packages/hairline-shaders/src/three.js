// ScratchedNodeMaterial for three.js, WebGPURenderer: metal or lacquer with scratches that split light into colours. PointLight, SpotLight,
// DirectionalLight, SunLight and RectAreaLight light it in closed form, with three's own shadows; environments by
// Hairline's maps where prepareEnvironment() has made them, else by three's own.
//
// The world is in metres. Lights without a size get one: `light.userData.radius` in metres (of a light in the sky `userData.angle` in
// radians), or the material's `lightRadius`. A RectAreaLight may be a disk, a polygon or a tube: `userData.shape`.
import {
  DataArrayTexture, DataTexture, FloatType, LightingNode, Matrix4, MeshPhysicalNodeMaterial, RGBAFormat, RGBAIntegerFormat, UnsignedIntType, Vector3,
} from 'three/webgpu';
import { texture, uniform, vec4 } from 'three/tsl';
import { Scratches, layScratches, readScratches, scratchTree } from './scratches.js';
import { noScratches, scratchTables } from './table.js';
import { COHERENCE_UM } from './data.js';
import { beside } from './beside.js';
import { curveOf, dielectricCurve, metalColor } from './metals.js';
import { Grating, isByUv } from './gratings.js';
import { mapsOf, preparedCount } from './environment.js';
import { ScratchedLightingModel, isBent } from './three_lighting.js';

export { loadTables } from './tables.js';
export { prepareEnvironment } from './environment.js';
export { Grating, layGratings, loadGrating } from './gratings.js';
export { Scratches, readScratches };

/** The greatest number of half floats. */
const GREATEST_HALF = 65504;

/** An attribute as numbers, one after the other; null without one. */
function numbersOf(attribute) {
  if (!attribute) return null;
  const { count, itemSize } = attribute;
  return Float64Array.from({ length: count * itemSize }, (_, i) => attribute.getComponent(Math.floor(i / itemSize), i % itemSize));
}

/** Lays one layer or several on a BufferGeometry, see layScratches(). */
export function scratchesOn(geometry, layers, options) {
  const [positions, normals, uvs] = ['position', 'normal', 'uv'].map((name) => numbersOf(geometry.attributes[name]));
  return layScratches({ positions, normals, uvs, index: geometry.index?.array ?? null }, layers, options);
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

function layersTexture({ texels, columns, rows, layers }) {
  const made = new DataArrayTexture(texels, columns, rows, layers);
  made.format = RGBAIntegerFormat;
  made.type = UnsignedIntType;
  made.needsUpdate = true;
  return made;
}

/** The tables of a metal: a layer for each shape of grooves. */
function tableTexture(tables, metal, scratches) {
  const { metals } = texturesOf(tables);
  const key = JSON.stringify([metal, scratches]);
  if (!metals.has(key)) metals.set(key, layersTexture(scratchTables(metal, scratches)));
  return metals.get(key);
}

const rowsOf = new WeakMap();

/** The table of a grating, made once. */
function rowsTexture(grating) {
  const { texels } = grating;
  if (!rowsOf.has(texels)) rowsOf.set(texels, layersTexture(grating));
  return rowsOf.get(texels);
}

function treeTexture({ texels, width, height }) {
  const made = new DataTexture(texels, width, height, RGBAIntegerFormat, UnsignedIntType);
  made.needsUpdate = true;
  return made;
}

const treesOf = new WeakMap();

/** Trees of scratches, by what they were made for. */
function treesOfScratches(scratches) {
  if (!treesOf.has(scratches)) treesOf.set(scratches, new Map());
  return treesOf.get(scratches);
}

/** The tree of scratches, made once. */
function treeOf(scratches, options) {
  const [trees, key] = [treesOfScratches(scratches), JSON.stringify(options)];
  if (!trees.has(key)) trees.set(key, scratchTree(scratches, options));
  return trees.get(key);
}

/**
 * Makes the tree of scratches in a worker, before the material of the same `coherenceUm` and `metresPerUnit` that is made of them: of hundreds of thousands of
 * pieces seconds, in which a page would stand still.
 */
export async function prepareScratches(scratches, { coherenceUm = COHERENCE_UM, metresPerUnit = 1 } = {}) {
  const options = { coherenceUm, metresPerUnit };
  const [trees, key] = [treesOfScratches(scratches), JSON.stringify(options)];
  if (!trees.has(key)) trees.set(key, await beside('tree', { scratches: { ...scratches }, options }));
}

/**
 * MeshPhysicalNodeMaterial with scratches. Besides its own parameters: `tables` of loadTables(); `metal` by name, or null for `color` and
 * `metalness`; `scratches` in the object's own frame, or null; `gratings`, an array; `coherenceUm`; `metresPerUnit`, how long a unit of the object's frame is;
 * `lightRadius` of lights that have none.
 */
export class ScratchedNodeMaterial extends MeshPhysicalNodeMaterial {
  static get type() {
    return 'ScratchedNodeMaterial';
  }

  constructor({ tables, metal = null, scratches = null, gratings = [], coherenceUm = COHERENCE_UM, metresPerUnit = 1, lightRadius = 0.005, ...parameters } = {}) {
    super();
    if (!tables) throw new Error('tables: found none; must be what loadTables() returned');
    if (scratches !== null && !(scratches instanceof Scratches)) {
      throw new Error('scratches: found something else; must be what readScratches() or scratchesOn() returned, or null');
    }
    if (!Array.isArray(gratings) || gratings.some((grating) => !(grating instanceof Grating))) {
      throw new Error('gratings: found something else; must be an array of Gratings');
    }
    this.isScratchedNodeMaterial = true;
    Object.assign(this, { tables, coherenceUm, metresPerUnit, lightRadius });
    // No part of the key of programs, as what can be enumerated is.
    Object.defineProperty(this, 'metal', { value: metal });
    const tree = scratches && treeOf(scratches, { coherenceUm, metresPerUnit });
    const { shapes: grooves, tableRows } = tree ?? noScratches;
    Object.assign(this, { scratches, gratings, tableOf: { shapes: grooves, tableRows } });
    if (metal !== null) {
      this.color.setRGB(...metalColor(metal));
      this.metalness = 1;
    }
    this.setValues(parameters);
    Object.defineProperty(this, 'hairline', { value: { tree: tree && treeTexture(tree), curve: curveOf(metal) } });
  }

  /** Nodes whose values are those of the material that is drawn: programs are shared by all materials of a kind. */
  nodes() {
    const { shapes, albedo, curves } = texturesOf(this.tables);
    const { tree } = this.hairline;
    const field = (grating) => new Matrix4().fromArray(grating.numbers);
    const checked = new WeakSet();
    return {
      shapes: texture(shapes), albedo: texture(albedo), curves: texture(curves),
      table: texture(this.table()).onObjectUpdate(({ material }) => material.table()),
      tree: tree && texture(tree).onObjectUpdate(({ material }) => material.hairline.tree),
      curve: uniform(this.curve()).onObjectUpdate(({ material, object }) => {
        if (!checked.has(object)) material.check(object);
        checked.add(object);
        return material.curve();
      }),
      metresPerUnit: uniform(this.metresPerUnit).onObjectUpdate(({ material }) => material.metresPerUnit),
      gratings: this.gratings.map((grating, i) => ({
        rows: texture(rowsTexture(grating)).onObjectUpdate(({ material }) => rowsTexture(material.gratings[i])),
        field: uniform(field(grating)).onObjectUpdate(({ material }) => field(material.gratings[i])),
      })),
    };
  }

  /** The curve of its reflectance: a metal's, or a dielectric's by its index, which a metal in part shares. */
  curve() {
    const { metal, metalness, metalnessMap, metalnessNode, hairline, ior } = this;
    const isMetal = metal !== null || (metalness >= 1 && !metalnessMap && !metalnessNode);
    return isMetal ? hairline.curve : dielectricCurve(ior);
  }

  /** The spectra of the scratches: a coat, in which they lie, has no colour of its own. */
  table() {
    const { hairline } = this;
    const metal = this.useClearcoat ? null : this.metal;
    if (hairline.tableMetal !== metal) Object.assign(hairline, { tableMetal: metal, table: tableTexture(this.tables, metal, this.tableOf) });
    return hairline.table;
  }

  setupLightingModel(builder) {
    if (!builder.renderer.backend.isWebGPUBackend) {
      console.warn('ScratchedNodeMaterial: found the backend for WebGL; must be that for WebGPU, which this browser lacks or `forceWebGL` turns off: drawn without scratches');
      return super.setupLightingModel(builder);
    }
    const environment = this.environmentOf(builder);
    return new ScratchedLightingModel(this, environment, environment && mapsOf(environment));
  }

  /** The texture of the environment, if there is one. */
  environmentOf(builder) {
    const node = super.setupEnvironment(builder);
    return node && environmentTexture(node.envNode, this);
  }

  setupEnvironment(builder) {
    // By its own maps the lighting model looks an environment up itself: a node that adds nothing stands for it.
    const isOwn = builder.renderer.backend.isWebGPUBackend && mapsOf(this.environmentOf(builder));
    return isOwn ? new LightingNode() : super.setupEnvironment(builder);
  }

  /** Mirror images of lamps exceed half floats, of which a canvas is: as infinities they would be tone mapped to black. */
  setupOutput(builder, output) {
    return super.setupOutput(builder, vec4(output.rgb.min(GREATEST_HALF), output.a));
  }

  /** Tells of what will be drawn wrong. */
  check(object) {
    this.checkScale(object);
    this.checkUvs(object);
  }

  /** Scratches of another scale than they were made for end in the wrong places. */
  checkScale(object) {
    if (isBent(object) || (!this.scratches && this.gratings.length === 0)) return;
    const scale = new Vector3().setFromMatrixScale(object.matrixWorld).toArray();
    if (scale.some((s) => Math.abs(s / this.metresPerUnit - 1) >= 0.01)) {
      console.warn(`ScratchedNodeMaterial: found the scale ${scale.join(', ')} of mesh "${object.name}"; must be metresPerUnit, ${this.metresPerUnit}`);
    }
  }

  /** Without texture coordinates a picture has one value, and grooves have no direction. */
  checkUvs(object) {
    for (const { kind, mask, directions } of this.gratings) {
      const channels = [...[mask, directions].flatMap((it) => it?.channel ?? []), ...(isByUv({ kind }) ? [0] : [])];
      const name = channels.map((channel) => (channel ? `uv${channel}` : 'uv')).find((it) => !object.geometry.hasAttribute(it));
      if (name) console.warn(`ScratchedNodeMaterial: found no attribute ${name} of mesh "${object.name}"; must be there for a grating with a picture or of kind along-u or along-v`);
    }
  }

  customProgramCacheKey() {
    // Pictures on grooves and environments of its own are in the program of a material.
    const isAlone = this.envMap || this.gratings.some(({ mask, directions }) => mask || directions);
    const kinds = this.gratings.map((grating) => (isByUv(grating) ? grating.kind : 'by place'));
    return `${super.customProgramCacheKey()}-${isAlone ? this.id : kinds}-${preparedCount()}`;
  }

  clone() {
    const { tables, metal, scratches, gratings, coherenceUm, metresPerUnit, lightRadius } = this;
    return new ScratchedNodeMaterial({ tables, metal, scratches, gratings, coherenceUm, metresPerUnit, lightRadius }).copy(this);
  }

  dispose() {
    this.hairline.tree?.dispose();
    super.dispose();
  }
}

/** The texture of an environment; a node that gives colours by itself is not looked up by scratches. */
function environmentTexture(node, material) {
  if (node?.isMaterialReferenceNode) return material.envMap;
  return node?.isTextureNode ? node.value : null;
}
