// A plug-in for GLTFLoader of three.js: files with HAIRLINE_scratches (docs/HAIRLINE_scratches.md of the project Hairline) get scratched
// materials and lights with a surface. Without it such files load as ever, without scratches.
import { Box3, Matrix4, Mesh, RectAreaLight, Vector3 } from 'three/webgpu';
import { Grating } from './gratings.js';
import { ScratchedNodeMaterial, scratchesOn } from './three.js';
import { Scratches, profilesOf } from './scratches.js';
import { metals } from './spectrum.js';

const NAME = 'HAIRLINE_scratches';
const AREA = 'EXT_lights_area';
const VERSION = 1;
const PATTERNS = ['random', 'parallel', 'circular', 'radial'];
/** Scratches of a part lie at most so far out of its box, over the box's size: they were rounded. */
const MARGIN = 1e-4;

/** Vertices of a skin that are looked at. */
const POSES = 100;

/** For `loader.register()`. `tables` of loadTables(); `warn` is told once of each thing that is not drawn. */
export function hairlineScratches({ tables, warn = console.warn, ...parameters } = {}) {
  if (!tables) throw new Error('tables: found none; must be what loadTables() returned');
  return (parser) => new HairlineScratches(parser, { tables, warn, parameters });
}

class HairlineScratches {
  constructor(parser, { tables, warn, parameters }) {
    this.name = NAME;
    this.parser = parser;
    this.tables = tables;
    this.parameters = parameters;
    const told = new Set();
    this.warn = (what) => {
      if (!told.has(what)) warn(`${NAME}: ${what}`);
      told.add(what);
    };
  }

  async afterRoot(gltf) {
    const { json } = this.parser;
    const extension = json.extensions?.[NAME];
    if (!extension) return;
    if (extension.version !== VERSION) {
      this.warn(`found version ${extension.version}; must be ${VERSION}: the model is shown plain`);
      return;
    }
    for (const scene of gltf.scenes) {
      scene.updateMatrixWorld(true);
      const nodes = [];
      scene.traverse((node) => {
        const number = this.parser.associations.get(node)?.nodes;
        if (number !== undefined) nodes.push([node, json.nodes[number]]);
      });
      for (const [node, { extensions }] of nodes) {
        const own = extensions?.[NAME];
        const described = extension.light?.[own?.light];
        const area = extensions?.[AREA]?.light;
        if (area !== undefined) this.addLight(node, json.extensions[AREA].lights[area], described);
        else if (own?.intensity !== undefined && described) this.addPlaced(node, own, described);
        const object = extensions?.[NAME]?.object;
        // A primitive is associated with its node too.
        if (object !== undefined && node.parent?.userData.hairlineObject === undefined) {
          node.userData.hairlineObject = object;
          await this.dress(node, object, extension);
        }
      }
    }
  }

  /** RectAreaLight shines along its own -z, as the extension has it. `described` is the scene's own table, where the light has one. */
  addLight(node, { type, color, intensity, size = 1, rect }, described = {}) {
    const light = areaLight(color, intensity, type === 'disk' ? size : size * (rect?.aspect ?? 1), size);
    if (type === 'disk') light.userData.shape = 'disk';
    this.cone(light, described);
    for (const key of ['picture', 'barn_doors_deg']) {
      if (described[key] !== undefined) this.warn(`not drawn: ${key} of the light "${node.name}"`);
    }
    node.add(light);
  }

  /** A polygon or a tube, whose table gives its place. */
  addPlaced(node, { color, intensity }, described) {
    const places = (described.kind === 'tube' ? described.ends_m : described.vertices_m).map((place) => new Vector3(...place));
    const middle = new Box3().setFromPoints(places).getCenter(new Vector3());
    const x = places[1].clone().sub(places[0]).normalize();
    // Of the polygon's area and both of its sides; of a tube any axis across it.
    const z = new Vector3();
    places.forEach((place, i) => z.sub(place.clone().sub(middle).cross(places[(i + 1) % places.length].clone().sub(middle))));
    if (described.kind === 'tube') z.copy(Math.abs(x.x) > 0.7 ? new Vector3(0, 1, 0) : new Vector3(1, 0, 0)).cross(x);
    z.normalize();
    const y = z.clone().cross(x);
    const light = areaLight(color, intensity, places[0].distanceTo(places[1]), 0);
    light.position.copy(middle);
    light.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
    light.userData.shape = described.kind;
    light.userData.twoSided = described.two_sided === true;
    if (described.kind === 'tube') {
      light.userData.radius = described.radius_m;
      if (described.cone_deg !== undefined) this.warn(`not drawn: the cone of the tube "${node.name}"`);
    } else {
      light.userData.corners = places.map((place) => [place.sub(middle).dot(x), place.dot(y)]);
      this.cone(light, described);
    }
    node.add(light);
  }

  /** The cone into which a flat light shines. */
  cone({ userData }, { cone_deg: degrees, cone_softness: softness = 0.1 }) {
    if (degrees !== undefined) Object.assign(userData, { angle: (degrees * Math.PI) / 360, penumbra: softness });
  }

  /** Gives the meshes of an object materials with its scratches. */
  async dress(node, number, extension) {
    const object = extension.object[number];
    const layers = (extension.scratches ?? []).filter((layer) => layer.object === object.name && !layer.hidden);
    const meshes = [];
    node.traverse((mesh) => {
      if (mesh.isMesh) meshes.push(mesh);
    });
    const lists = [];
    for (const layer of layers) {
      if (layer.laid) lists.push(await this.laid(layer.laid, layer.profile));
      else this.lay(layer, node, meshes, extension, lists);
    }
    const all = lists.length > 0 ? lists.reduce((a, b) => a.joined(b)) : null;
    const gratings = [];
    for (const grating of (extension.grating ?? []).filter((it) => it.object === object.name && !it.hidden)) {
      if (grating.laid) gratings.push(await this.grating(grating.laid));
      else this.warn(`not drawn: grating ${grating.name ? `"${grating.name}" ` : ''}of pattern ${grating.pattern} on "${object.name}"`);
    }
    if (all === null && gratings.length === 0) return;
    const fromObject = node.matrixWorld;
    const described = (extension.material ?? []).find(({ name }) => name === object.material);
    for (const mesh of meshes.flatMap((each) => (each.isInstancedMesh ? apart(each) : each))) {
      if (!isAtRest(mesh)) {
        this.warn(`scratches on skins and morphs that are not in their pose of rest are not drawn: those on "${object.name}"`);
        continue;
      }
      const scale = new Vector3().setFromMatrixScale(mesh.matrixWorld);
      if (Math.max(Math.abs(scale.x / scale.y - 1), Math.abs(scale.x / scale.z - 1)) > 0.01) {
        this.warn(`scratches on parts that are scaled unevenly are not drawn: those on "${object.name}"`);
        continue;
      }
      const toMesh = new Matrix4().copy(mesh.matrixWorld).invert().multiply(fromObject);
      const own = all && within(all.transformed(toMesh.elements), mesh.geometry);
      const rows = gratings.map((grating) => new Grating({
        ...grating, axis: new Vector3(...grating.axis).transformDirection(toMesh).toArray(),
        center: new Vector3(...grating.center).applyMatrix4(toMesh).toArray(),
      }));
      if (own !== null || rows.length > 0) mesh.material = this.material(mesh, described, own, rows, scale.x);
    }
  }

  /** The scratches of a layer as Hairline laid them. */
  async laid({ start_m, end_m, normal, width_um, depth_nm, scratch }, profile = 'rectangle') {
    const read = async (accessor) => (await this.parser.getDependency('accessor', accessor)).array;
    const [starts, ends, normals, widths, depths, numbers] = await Promise.all([start_m, end_m, normal, width_um, depth_nm, scratch].map(read));
    const floats = (array) => Float64Array.from(array);
    return new Scratches({
      starts: floats(starts), ends: floats(ends), normals: floats(normals), widthsUm: floats(widths), depthsNm: floats(depths),
      scratch: Uint32Array.from(numbers), profiles: profilesOf(profile, numbers.length),
    });
  }

  /** A grating with its table, in the frame of its object. */
  async grating(laid) {
    const { array } = await this.parser.getDependency('accessor', laid.texels);
    return {
      kind: laid.kind, axis: laid.axis, center: laid.center, radiiM: laid.radii_m, curvaturePerM: laid.curvature_per_m, coverage: laid.coverage,
      angleStdRad: laid.angle_std_rad, coherenceUm: laid.coherence_um, texels: array,
    };
  }

  /** Lays a layer that the file only describes: other scratches of the same kind. */
  lay(layer, node, meshes, extension, lists) {
    const name = nameOf(layer, extension);
    const beyond = ['where', 'strokes', 'material', 'node', 'density_per_m2'].filter((key) => layer[key] !== undefined);
    if (!PATTERNS.includes(layer.pattern)) beyond.unshift(`pattern ${layer.pattern}`);
    if (meshes.length !== 1 || meshes[0] !== node) beyond.push('a model of several parts');
    if (beyond.length > 0) {
      this.warn(`not drawn: ${name} (${beyond.join(', ')}); a file written with --laid on has it`);
      return;
    }
    lists.push(scratchesOn(meshes[0].geometry, {
      pattern: layer.pattern, count: layer.count, seed: Number(layer.seed ?? 1) % 2 ** 32, lengthM: layer.length_m, widthUm: layer.width_um,
      depthNm: layer.depth_nm, curvaturePerM: layer.curvature_per_m, jitterDeg: layer.jitter_deg, axis: layer.axis, centerM: layer.center_m,
      direction: layer.direction, profile: layer.profile, metresPerUnit: new Vector3().setFromMatrixScale(node.matrixWorld).x,
    }));
  }

  /** The scratched twin of a mesh's material. `described` is the scene's own, where the object has one. */
  material({ material: from, geometry }, described, scratches, gratings, metresPerUnit) {
    const { tables, parameters } = this;
    for (const key of ['sheen', 'iridescence']) {
      if (from[key] > 0) this.warn(`drawn under environments, not under lights: ${key}`);
    }
    if (described?.cover) this.warn(`not drawn: the plate over the material "${described.name}"`);
    const metal = metals.includes(described?.metal) ? described.metal : null;
    const taken = {};
    for (const key of KEYS) {
      const isOfMetal = metal !== null && (key === 'color' || key === 'metalness');
      if (from[key] !== undefined && from[key] !== null && !isOfMetal) taken[key] = from[key];
    }
    // Without tangents three.js has the bitangent where v rises, glTF where it falls.
    if (taken.anisotropyRotation && !geometry.attributes.tangent) taken.anisotropyRotation *= -1;
    return new ScratchedNodeMaterial({
      tables, metal, scratches, gratings, metresPerUnit, coherenceUm: described?.coherence_um ?? 20, ...taken, ...parameters,
    });
  }
}

/** Each instance has scratches of its own: meshes stand for them, below the node, which may move. */
function apart(instanced) {
  const meshes = Array.from({ length: instanced.count }, (_, i) => {
    const mesh = new Mesh(instanced.geometry, instanced.material);
    mesh.name = `${instanced.name} ${i}`;
    instanced.getMatrixAt(i, mesh.matrix);
    mesh.matrix.decompose(mesh.position, mesh.quaternion, mesh.scale);
    return mesh;
  });
  instanced.count = 0;
  instanced.add(...meshes);
  instanced.updateMatrixWorld(true);
  return meshes;
}

/** Whether the vertices of a skin or a morph are where its geometry has them; the file has scratches where they are. */
function isAtRest(mesh) {
  const { position } = mesh.geometry.attributes;
  mesh.geometry.computeBoundingSphere();
  const [rest, now] = [new Vector3(), new Vector3()];
  const step = Math.ceil(position.count / POSES);
  for (let i = 0; i < position.count; i += step) {
    rest.fromBufferAttribute(position, i);
    if (mesh.getVertexPosition(i, now).distanceTo(rest) > MARGIN * mesh.geometry.boundingSphere.radius) return false;
  }
  return true;
}

/** What a MeshPhysicalMaterial of GLTFLoader sets. */
const KEYS = [
  'name', 'color', 'map', 'roughness', 'roughnessMap', 'metalness', 'metalnessMap', 'normalMap', 'normalScale', 'emissive', 'emissiveMap',
  'emissiveIntensity', 'aoMap', 'aoMapIntensity', 'side', 'transparent', 'opacity', 'alphaTest', 'depthWrite', 'vertexColors', 'flatShading',
  'envMapIntensity', 'ior', 'specularIntensity', 'specularIntensityMap', 'specularColor', 'specularColorMap', 'transmission', 'transmissionMap',
  'thickness', 'thicknessMap', 'attenuationColor', 'attenuationDistance', 'dispersion', 'sheen', 'sheenColor', 'sheenColorMap', 'sheenRoughness',
  'sheenRoughnessMap', 'clearcoat', 'clearcoatMap', 'clearcoatRoughness', 'clearcoatRoughnessMap', 'clearcoatNormalMap', 'clearcoatNormalScale',
  'anisotropy', 'anisotropyRotation', 'anisotropyMap', 'iridescence', 'iridescenceMap', 'iridescenceIOR', 'iridescenceThicknessRange', 'iridescenceThicknessMap',
];

function areaLight(color = [1, 1, 1], intensity = 1000, width, height) {
  const light = new RectAreaLight(0xffffff, intensity, width, height);
  light.color.setRGB(...color);
  return light;
}

function nameOf(layer, extension) {
  return layer.name ? `layer "${layer.name}"` : `layer ${extension.scratches.indexOf(layer)}`;
}

/** The pieces that come near to a geometry; null where there are none. */
function within(scratches, geometry) {
  geometry.computeBoundingBox();
  const box = new Box3().copy(geometry.boundingBox);
  box.expandByScalar(MARGIN * box.getSize(new Vector3()).length());
  const [a, b] = [new Vector3(), new Vector3()];
  const kept = [];
  for (let i = 0; i < scratches.count; i += 1) {
    a.fromArray(scratches.starts, 3 * i);
    b.fromArray(scratches.ends, 3 * i);
    if (box.containsPoint(a.add(b).multiplyScalar(0.5))) kept.push(i);
  }
  if (kept.length === 0) return null;
  const pick = (array, width) => Float64Array.from(kept.flatMap((i) => Array.from(array.subarray(width * i, width * (i + 1)))));
  const { starts, ends, normals, widthsUm, depthsNm, scratch, profiles } = scratches;
  return new Scratches({
    starts: pick(starts, 3), ends: pick(ends, 3), normals: normals && pick(normals, 3), widthsUm: pick(widthsUm, 1), depthsNm: pick(depthsNm, 1),
    scratch: Uint32Array.from(kept, (i) => scratch[i]), profiles: profiles && kept.map((i) => profiles[i]),
  });
}
