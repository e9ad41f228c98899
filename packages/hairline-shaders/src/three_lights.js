// Lights of three.js as scratches see them: spheres at a place, disks in the sky, rectangles, and shapes with an outline.
/** Corners of the polygon that stands for a disk, as in Hairline. */
const DISK_CORNERS = 24;
const SHAPES = ['rectangle', 'disk', 'polygon', 'tube'];

/** Whether a light comes from one direction for all of the scene. Of other kinds only those at a place are known. */
export function isFar(light) {
  if (light.isDirectionalLight || light.isSunLight) return true;
  if (light.isPointLight || light.isSpotLight) return false;
  throw new Error(
    `ScratchedNodeMaterial: found the light "${light.name}" of type ${light.type}; must be a PointLight, SpotLight, DirectionalLight, SunLight or RectAreaLight`,
  );
}

/** Whether a RectAreaLight is no rectangle: `userData.shape`. */
export function hasOutline({ name, userData: { shape = 'rectangle' } }) {
  if (!SHAPES.includes(shape)) throw new Error(`userData.shape of the light "${name}": found ${JSON.stringify(shape)}; must be one of ${SHAPES.join(', ')}`);
  return shape !== 'rectangle';
}

/** The ends of a tube with its radius, or the corners of a polygon, counter-clockwise as seen from -z, where it shines to; in the light's frame. */
export function outlineOf({ name, width, height, userData: { shape = 'rectangle', corners, radius } }) {
  const wrong = (key, found, right) => new Error(`userData.${key} of the light "${name}": found ${JSON.stringify(found)}; must be ${right}`);
  if (shape === 'tube') {
    if (!(radius > 0)) throw wrong('radius', radius, 'the radius of the tube in metres');
    return [-0.5, 0.5].map((side) => [side * width, 0, 0, radius]);
  }
  if (shape === 'disk') {
    // Of the disk's area.
    const step = (2 * Math.PI) / DISK_CORNERS;
    const half = 0.5 * Math.sqrt(step / Math.sin(step));
    return Array.from({ length: DISK_CORNERS }, (_, i) => [half * width * Math.cos(-i * step), half * height * Math.sin(-i * step), 0, 0]);
  }
  const flat = shape === 'polygon' ? corners : [[-0.5, -0.5], [-0.5, 0.5], [0.5, 0.5], [0.5, -0.5]].map(([x, y]) => [x * width, y * height]);
  if (!Array.isArray(flat) || flat.length < 3 || flat.flat().some((x) => !Number.isFinite(x))) {
    throw wrong('corners', corners, 'three or more pairs of numbers, the corners in the plane of the light');
  }
  const twiceArea = flat.reduce((sum, [x, y], i) => sum + x * flat[(i + 1) % flat.length][1] - y * flat[(i + 1) % flat.length][0], 0);
  return (twiceArea > 0 ? [...flat].reverse() : flat).map(([x, y]) => [x, y, 0, 0]);
}

/** A sphere that holds the outline: middle and radius. */
export function around(vertices) {
  const middle = [0, 1, 2].map((k) => {
    const all = vertices.map((vertex) => vertex[k]);
    return 0.5 * (Math.min(...all) + Math.max(...all));
  });
  return [...middle, Math.max(...vertices.map(([x, y, z, radius]) => Math.hypot(x - middle[0], y - middle[1], z - middle[2]) + radius))];
}
