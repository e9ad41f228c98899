import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import type { Tables } from './index.js';
import type { ScratchedNodeMaterialParameters } from './three.js';

export interface HairlineScratchesOptions extends Partial<ScratchedNodeMaterialParameters> {
  tables: Tables;
  /** Told once of each thing in the file that is not drawn, by its name; console.warn by default. */
  warn?: (message: string) => void;
}
/** A plug-in for GLTFLoader: `loader.register(hairlineScratches({ tables }))`. */
export function hairlineScratches(options: HairlineScratchesOptions): (parser: GLTFParser) => GLTFLoaderPlugin;
