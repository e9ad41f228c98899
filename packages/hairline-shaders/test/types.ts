// Programs of users, as TypeScript sees them: `cargo xtask package --test` checks their types.
import * as THREE from 'three/webgpu';
import { layScratches, makeScratchTables, scratchTree, type Grating, type Layer } from 'hairline-shaders';
import { cd } from 'hairline-shaders/cd';
import { hairlineScratches } from 'hairline-shaders/gltf';
import { ScratchedNodeMaterial, layGratings, loadGrating, loadTables, prepareEnvironment, prepareScratches, readScratches, scratchesOn } from 'hairline-shaders/three';

export async function material(sky: THREE.DataTexture, mask: THREE.Texture): Promise<ScratchedNodeMaterial> {
  const tables = await loadTables();
  await prepareEnvironment(sky);
  const layers: Layer[] = [{ pattern: 'random', count: 300, depth_nm: { mean: 160, spread: 0.1 }, where: { mask: 'mask' } }, { pattern: 'circular', count: 3 }];
  const files = { mask: { width: 1, rgba: new Uint8Array(4) } };
  const scratches = scratchesOn(new THREE.PlaneGeometry(), layers, { files });
  await prepareScratches(scratches);
  const foil: Grating[] = layGratings([{ pattern: 'uv', along: 'v', pitch_um: 8, mask: 'mask' }], { metal: 'gold', pictures: { mask } });
  const gratings = [...foil, await loadGrating(cd, { kind: 'along-u', mask })];
  return new ScratchedNodeMaterial({ tables, metal: 'gold', roughness: 0.1, clearcoat: 1, scratches, gratings });
}

export function textures(device: GPUDevice): GPUTexture {
  const triangles = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0] };
  const scratches = layScratches(triangles, { pattern: 'random', count: 3 }).joined(readScratches('', 'list.csv', { profile: 'v' }));
  const tree = scratchTree(scratches, { coherenceUm: 30 });
  // @ts-expect-error: tables are of a tree.
  makeScratchTables(device, 'steel');
  // @ts-expect-error: no metal.
  makeScratchTables(device, 'tin', tree);
  return makeScratchTables(device, ['steel', null], tree);
}

export const plugIn = async () => hairlineScratches({ tables: await loadTables(), warn: (what: string) => what, lightRadius: 0.01 });
