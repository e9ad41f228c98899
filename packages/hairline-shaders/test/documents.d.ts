// What readers have before the blocks of code in documents begin. `cargo xtask package --test` checks the blocks.
declare const THREE: typeof import('three/webgpu');
declare const scene: import('three/webgpu').Scene;
declare const geometry: import('three/webgpu').BufferGeometry;
declare const mesh: import('three/webgpu').Mesh;
declare const light: import('three/webgpu').Light;
declare const loader: import('three/addons/loaders/GLTFLoader.js').GLTFLoader;
declare const tables: import('hairline-shaders').Tables;
declare const GPUTextureUsage: { COPY_DST: number; TEXTURE_BINDING: number };
// The page of the viewer, which is compiled for browsers alone.
interface Window { hairlinePage: { gallery(): void; pick(endings: string): void; save(name: string, bytes: Uint8Array): void } }
declare module '*/hairline.js' {
  export default function start(): Promise<void>;
  export function open(canvas: HTMLCanvasElement, backend: string, lost: (why: string) => void): Promise<any>;
}
