// Files of models: fetched, told apart from what servers send in their place, and unpacked.
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { LoaderUtils } from 'three/webgpu';

/** Of a header of .glb: where the length of the file stands, and all of it. */
const [LENGTH_AT, HEADER] = [8, 12];

/** The bytes of a model; what else an address may have is an error in words for readers of the page. */
export async function fetchModel(src, signal) {
  let response;
  try {
    response = await fetch(src, { signal });
  } catch (error) {
    throw signal.aborted ? error : new Error(`${src} cannot be fetched`);
  }
  if (!response.ok) throw new Error(`${src} cannot be fetched: ${response.status} ${response.statusText}`.trim());
  const bytes = await response.arrayBuffer();
  const begin = new TextDecoder().decode(bytes.slice(0, 64)).replace(/^\ufeff/, '').trimStart();
  if (begin.startsWith('glTF') && bytes.byteLength >= HEADER) {
    const wanted = new DataView(bytes).getUint32(LENGTH_AT, true);
    if (bytes.byteLength < wanted) throw new Error(`${src} is cut off: found ${bytes.byteLength} bytes; must be ${wanted}`);
  } else if (!begin.startsWith('{')) {
    throw new Error(`${src} is no model: found ${begin.startsWith('<') ? 'a page of HTML' : 'another kind of file'}; must be a .glb or .gltf`);
  }
  return bytes;
}

/** Decoders of all elements of a page: each has workers of its own. */
let shared = null;

/** What unpacks meshes and pictures; files of `decoders` are fetched for models that need them. */
function decodersFrom(decoders, renderer) {
  if (!shared) {
    const draco = new DRACOLoader().setDecoderPath(decoders);
    shared = { draco, ktx2: new KTX2Loader().setTranscoderPath(decoders).detectSupport(renderer) };
  }
  return shared;
}

/** Reads the bytes of a model, whose other files lie beside `src`. */
export function readModel(bytes, { src, decoders, renderer, plugIn }) {
  const { draco, ktx2 } = decodersFrom(decoders, renderer);
  const loader = new GLTFLoader().setDRACOLoader(draco).setKTX2Loader(ktx2).setMeshoptDecoder(MeshoptDecoder).register(plugIn);
  return loader.parseAsync(bytes, LoaderUtils.extractUrlBase(src));
}
