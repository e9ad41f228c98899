import type { BufferGeometry, DataTexture, MeshPhysicalMaterialParameters } from 'three';
import { MeshPhysicalNodeMaterial } from 'three/webgpu';
import { Grating, Layer, LayingOptions, Metal, Scratches, Tables } from './index.js';

export { Grating, Scratches, layGratings, loadGrating, loadTables, readScratches } from './index.js';

/** Lays scratches on a geometry, as Hairline does: a seed means the same scratches. */
export function scratchesOn(geometry: BufferGeometry, layers: Layer | Layer[], options?: LayingOptions): Scratches;

/**
 * Makes the tree of scratches in a worker, before the material of the same `coherenceUm` and `metresPerUnit` that is made of them: of hundreds of thousands of
 * pieces seconds, in which a page would stand still.
 */
export function prepareScratches(scratches: Scratches, options?: { coherenceUm?: number; metresPerUnit?: number }): Promise<void>;

/**
 * Makes Hairline's own maps of an equirectangular texture, in a worker, before it is `scene.environment` or a material's `envMap`: base, scratches and gratings
 * then mirror it as `hairline render` has it. Without it three.js's maps count.
 */
export function prepareEnvironment(map: DataTexture): Promise<void>;

export interface ScratchedNodeMaterialParameters extends MeshPhysicalMaterialParameters {
  tables: Tables;
  /** A measured metal; null: `color` and `metalness`. */
  metal?: Metal | null;
  /** In the mesh's own frame. */
  scratches?: Scratches | null;
  /** In the mesh's own frame. */
  gratings?: Grating[];
  coherenceUm?: number;
  /** How long a unit of the mesh's own frame is in the world. */
  metresPerUnit?: number;
  /** Of lights that have no `userData.radius`. */
  lightRadius?: number;
}
/** A physical material with scratches that split light into colours. */
export class ScratchedNodeMaterial extends MeshPhysicalNodeMaterial {
  constructor(parameters: ScratchedNodeMaterialParameters);
  readonly isScratchedNodeMaterial: true;
  readonly scratches: Scratches | null;
  readonly metal: Metal | null;
}
