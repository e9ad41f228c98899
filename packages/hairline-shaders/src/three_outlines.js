// What shaders are given of lights with an outline: disks, polygons, tubes.
import { DataTexture, Matrix4, RGBAIntegerFormat, UnsignedIntType, Vector4 } from 'three/webgpu';
import { cameraViewMatrix, texture, uniform } from 'three/tsl';
import { around, outlineOf } from './three_lights.js';

/** Corners of the outline of a tube, TUBE_CORNERS of tube.wgsl. */
const TUBE_CORNERS = 22;

/** A texture of corners, or of the ends of a tube. */
function vertexTexture(vertices) {
  const made = new DataTexture(new Uint32Array(Float32Array.from(vertices.flat()).buffer), vertices.length, 1, RGBAIntegerFormat, UnsignedIntType);
  made.needsUpdate = true;
  return made;
}

const known = new WeakMap();

/** Nodes of a light, the same for all materials. They follow the light. */
export function outlineNodes(light) {
  if (!known.has(light)) {
    const vertices = outlineOf(light);
    let made = JSON.stringify(vertices);
    const place = new Matrix4();
    const nodes = {
      vertices: texture(vertexTexture(vertices)),
      // Number of vertices; whether it is a tube; whether its other side shines too.
      outline: uniform(new Vector4()),
      around: uniform(new Vector4(...around(vertices))),
      view_from_light: cameraViewMatrix.mul(uniform(place).onRenderUpdate(() => place.extractRotation(light.matrixWorld).copyPosition(light.matrixWorld))),
    };
    nodes.outline.onRenderUpdate(() => {
      const now = outlineOf(light);
      const text = JSON.stringify(now);
      if (text !== made) {
        made = text;
        nodes.vertices.value.dispose();
        nodes.vertices.value = vertexTexture(now);
        nodes.around.value.set(...around(now));
      }
      const isTube = light.userData.shape === 'tube';
      return nodes.outline.value.set(isTube ? TUBE_CORNERS : now.length, Number(isTube), Number(Boolean(light.userData.twoSided)), 0);
    });
    known.set(light, nodes);
  }
  return known.get(light);
}
