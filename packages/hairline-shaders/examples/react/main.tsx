// A scratched steel plate under a small lamp, by react-three-fiber.
import { Suspense, use, useMemo } from 'react';
import { createRoot } from 'react-dom/client';
import { Canvas, extend, type GLProps } from '@react-three/fiber';
import * as THREE from 'three/webgpu';
import { ScratchedNodeMaterial, loadTables, scratchesOn } from 'hairline-shaders/three';

extend(THREE as never);

const renderer: GLProps = async (given) => {
  const made = new THREE.WebGPURenderer(given as never);
  await made.init();
  return made;
};

const loading = loadTables();

function Plate() {
  const tables = use(loading);
  const [plate, steel] = useMemo(() => {
    const geometry = new THREE.CircleGeometry(0.08, 96);
    const scratches = scratchesOn(geometry, { pattern: 'random', count: 6000, width_um: 4, depth_nm: { mean: 160, spread: 0.1 }, length_m: 0.05 });
    return [geometry, new ScratchedNodeMaterial({ tables, metal: 'steel', roughness: 0.08, scratches })];
  }, [tables]);
  return <mesh geometry={plate} material={steel} />;
}

createRoot(document.getElementById('root')!).render(
  <Canvas gl={renderer} flat camera={{ position: [0, -0.2, 0.25], fov: 30, near: 0.01, far: 10 }}>
    <pointLight position={[0.05, 0.2, 0.25]} intensity={0.08} userData={{ radius: 0.004 }} />
    <Suspense>
      <Plate />
    </Suspense>
  </Canvas>,
);
