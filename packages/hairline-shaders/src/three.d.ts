import type { BufferGeometry, MeshPhysicalMaterialParameters } from 'three';
import { MeshPhysicalNodeMaterial } from 'three/webgpu';
import { Grating, Metal, PatternOptions, Scratches, Tables } from './index.js';

export { Grating, Scratches, loadGrating, loadTables, readScratches } from './index.js';

/** Lays scratches in a pattern on a geometry. */
export function scratchesOn(geometry: BufferGeometry, options: PatternOptions): Scratches;

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
