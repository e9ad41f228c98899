// Lights of three.js as scratches see them: spheres at a place, or disks in the sky.

/** Whether a light comes from one direction for all of the scene. Of other kinds only those at a place are known. */
export function isFar(light) {
  if (light.isDirectionalLight || light.isSunLight) return true;
  if (light.isPointLight || light.isSpotLight) return false;
  throw new Error(
    `ScratchedNodeMaterial: found the light "${light.name}" of type ${light.type}; must be a PointLight, SpotLight, DirectionalLight, SunLight or RectAreaLight`,
  );
}
