import { defineConfig } from 'vite';

export default defineConfig({
  base: './',
  // Its worker and its WebAssembly lie beside its scripts, which `vite dev` would move; it shares three.js with the program.
  optimizeDeps: { exclude: ['hairline-shaders'], include: ['three/webgpu', 'three/tsl'] },
});
