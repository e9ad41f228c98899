// A plug-in for GLTFLoader of three.js: files with HAIRLINE_scratches (docs/HAIRLINE_scratches.md of the project Hairline) get scratched
// materials and lights with a surface. Without it such files load as ever, without scratches.
import {
  Box3, DataTexture, LinearFilter, LinearMipmapLinearFilter, Matrix3, Matrix4, Mesh, RectAreaLight, RepeatWrapping, RGBAFormat, Vector2, Vector3,
} from 'three/webgpu';
import { COHERENCE_UM } from './data.js';
import { beside } from './beside.js';
import { Grating } from './gratings.js';
import { ScratchedNodeMaterial, prepareScratches } from './three.js';
import { Scratches, profilesOf } from './scratches.js';
import { metals } from './metals.js';

const NAME = 'HAIRLINE_scratches';
const AREA = 'EXT_lights_area';
const VERSION = 1;
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
    /** Textures of pictures on gratings, by their keys and numbers. */
    this.groovePictures = new Map();
    const told = new Set();
    this.warn = (what) => {
      if (!told.has(what)) warn(`${NAME}: ${what}`);
      told.add(what);
    };
  }

  /** Before three.js reads a file that ends early, and says so in words of its own. */
  async beforeRoot() {
    if (this.parser.json.extensions?.[NAME]) await this.refuseWhatIsCutOff();
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
          await this.dress(node, object, extension).catch(({ message }) => {
            this.warn(`${message}: "${extension.object?.[object]?.name}" is shown plain`);
          });
        }
      }
    }
  }

  /** A file that ends early has no part of its scratches, or wrong ones. */
  async refuseWhatIsCutOff() {
    for (const [i, { uri, byteLength }] of (this.parser.json.buffers ?? []).entries()) {
      // What is packed stands for its bytes: EXT_meshopt_compression.
      if (uri === undefined && i > 0) continue;
      const buffer = await this.parser.getDependency('buffer', i);
      if (buffer.byteLength < byteLength) {
        throw new Error(`${NAME}: found ${buffer.byteLength} bytes in buffer ${i}; must be ${byteLength}: the file is cut off`);
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
    const object = extension.object?.[number];
    if (!object) throw new Error(`object: found ${number}; must be the number of one of the file's`);
    const found = [];
    node.traverse((mesh) => {
      if (mesh.isMesh) found.push(mesh);
    });
    const meshes = found.flatMap((mesh) => (mesh.isInstancedMesh ? apart(mesh) : mesh));
    const all = await this.scratches(node, object, meshes, extension);
    const described = (extension.material ?? []).find(({ name }) => name === object.material);
    const gratings = [];
    for (const grating of (extension.grating ?? []).filter((it) => it.object === object.name && !it.hidden)) {
      const isDrawn = grating.pattern !== 'swirl' && grating.tile_m === undefined;
      if (isDrawn) gratings.push(await this.grating(grating, `grating[${extension.grating.indexOf(grating)}]`, extension, described));
      else this.warn(`not drawn: grating ${grating.name ? `"${grating.name}" ` : ''}of pattern ${grating.pattern} on "${object.name}"`);
    }
    if (all === null && gratings.length === 0) return;
    const fromObject = node.matrixWorld;
    for (const mesh of meshes) {
      if (!isAtRest(mesh)) {
        this.warn(`scratches on skins and morphs that are not in their pose of rest are not drawn: those on "${object.name}"`);
        continue;
      }
      const scale = scaleOf(mesh);
      if (scale === null) {
        this.warn(`scratches on parts that are scaled unevenly are not drawn: those on "${object.name}"`);
        continue;
      }
      const toMesh = new Matrix4().copy(mesh.matrixWorld).invert().multiply(fromObject);
      const own = all && within(all.transformed(toMesh.elements), mesh.geometry);
      const rows = gratings.map((grating) => new Grating({
        ...grating, axis: grating.axis && new Vector3(...grating.axis).transformDirection(toMesh).toArray(),
        center: new Vector3(...grating.center).applyMatrix4(toMesh).toArray(), mask: laidOn(grating.mask, mesh), directions: laidOn(grating.directions, mesh),
      }));
      if (own !== null || rows.length > 0) mesh.material = await this.material(mesh, described, own, rows, scale);
    }
  }

  /** The scratches of an object in its frame, as they lie in the file, or laid by what the file says; null where there are none. */
  async scratches(node, object, meshes, extension) {
    const layers = (extension.scratches ?? []).filter((layer) => layer.object === object.name);
    const isSolo = layers.some(({ solo }) => solo);
    const shown = layers.filter((layer) => !layer.hidden && (layer.solo || !isSolo));
    if (shown.length === 0) return null;
    const lists = shown.every(({ laid }) => laid)
      ? await Promise.all(shown.map((layer) => this.laid(layer, `${wayOf(layer, extension)}.laid`)))
      : await this.lay(layers, shown, node, meshes, extension);
    return lists.length > 0 ? lists.reduce((a, b) => a.joined(b)) : null;
  }

  /** The scratches of a layer as Hairline laid them. */
  async laid({ laid, profile = 'rectangle' }, way) {
    const keys = ['start_m', 'end_m', 'normal', 'width_um', 'depth_nm', 'scratch'];
    const [starts, ends, normals, widthsUm, depthsNm, numbers] = await Promise.all(keys.map((key) => this.numbers(laid, key, way)));
    return new Scratches({ starts, ends, normals, widthsUm, depthsNm, scratch: numbers, profiles: profilesOf(profile, numbers.length) });
  }

  /** A grating with its table and its pictures, in the frame of its object. */
  async grating(row, way, extension, described) {
    const { laid, mask: _, directions: __, ...bare } = row;
    const [mask, directions] = await Promise.all(['mask', 'directions'].map((key) => this.groovePicture(row, key, way, extension)));
    if (!laid) {
      try {
        const [made] = await beside('gratings', { rows: bare, options: { metal: metalOf(described), coherenceUm: described?.coherence_um } });
        return { ...made, mask, directions };
      } catch ({ message }) {
        throw new Error(message.replace(/^grating\[0\]/, way));
      }
    }
    return {
      kind: laid.kind, axis: laid.axis, center: laid.center, radiiM: laid.radii_m, curvaturePerM: laid.curvature_per_m, coverage: laid.coverage,
      angleStdRad: laid.angle_std_rad, coherenceUm: laid.coherence_um, texels: await this.numbers(laid, 'texels', `${way}.laid`), mask, directions,
    };
  }

  /** The picture that a key of a grating names, as a texture; null without one. */
  async groovePicture(row, key, way, extension) {
    if (row[key] === undefined) return null;
    const name = `${key} ${row[key]}`;
    if (!this.groovePictures.has(name)) {
      const { width, rgba } = await this.picture(fileOf(row, key, way, extension).bufferView);
      this.groovePictures.set(name, grooveTexture(width, key === 'mask' ? greyOf(rgba) : rgba));
    }
    return this.groovePictures.get(name);
  }

  /** Lays layers by Hairline's own code, those on each part of the object by themselves. */
  async lay(layers, shown, node, meshes, extension) {
    const metresPerUnit = scaleOf(node);
    if (metresPerUnit === null) {
      this.warn(`scratches on parts that are scaled unevenly are not drawn: those on "${node.name}"`);
      return [];
    }
    const files = {};
    const described = await Promise.all(layers.map((layer, i) => this.described(layer, i, extension, files)));
    const partOf = ({ material, node: below }) => JSON.stringify([material, below]);
    return Promise.all([...new Set(shown.map(partOf))].map(async (part) => {
      const [material, below] = JSON.parse(part);
      const own = meshes.filter((mesh) => (material === null || mesh.material.name === material) && (below === null || isBelow(mesh, node, below)));
      // All of them, as a layer's seed counts with those before it.
      const rows = described.map((row, i) => ({ ...row, solo: false, hidden: row.hidden || !shown.includes(layers[i]) || partOf(layers[i]) !== part }));
      try {
        return new Scratches(await beside('lay', { mesh: together(own, node), layers: rows, options: { metresPerUnit, files } }));
      } catch ({ message }) {
        // By the layer's number in the file.
        throw new Error(message.replace(/^scratches\[(\d+)\]/, (_, i) => wayOf(layers[i], extension)));
      }
    }));
  }

  /** A layer without the part that it lies on; what it names is added to `files`. */
  async described(given, number, extension, files) {
    const { laid, material, node, ...layer } = given;
    if (layer.pattern === 'svg') {
      const { bufferView } = fileOf(layer, 'file', wayOf(given, extension), extension);
      layer.file = `drawing ${number}.svg`;
      files[layer.file] = { svg: new Uint8Array(await this.parser.getDependency('bufferView', bufferView)) };
    }
    if (layer.pattern === 'file') {
      const list = layer.file;
      layer.file = `list ${number}`;
      const [starts, ends, widthsUm, depthsNm] = await Promise.all(['start_m', 'end_m', 'width_um', 'depth_nm'].map((key) => this.numbers(list, key, `${wayOf(given, extension)}.file`)));
      const exact = list.ends_f64 === undefined ? null : new Float64Array(await this.parser.getDependency('bufferView', list.ends_f64));
      const endsM = exact ?? Float64Array.from({ length: 2 * starts.length }, (_, i) => {
        const [scratch, k] = [Math.floor(i / 6), i % 6];
        return k < 3 ? starts[3 * scratch + k] : ends[3 * scratch + k - 3];
      });
      const scratches = list.scratches_u32 === undefined ? undefined : new Uint32Array(await this.parser.getDependency('bufferView', list.scratches_u32));
      files[layer.file] = { endsM, widthsUm, depthsNm, scratches };
    }
    for (const key of ['mask', 'density'].filter((it) => layer.where?.[it] !== undefined)) {
      const file = fileOf(layer.where, key, `${wayOf(given, extension)}.where`, extension);
      const name = `picture ${layer.where[key]}`;
      files[name] = await this.picture(file.bufferView);
      layer.where = { ...layer.where, [key]: name };
    }
    return layer;
  }

  /** The numbers of the accessor that a key names. */
  async numbers(list, key, way) {
    if (!this.parser.json.accessors?.[list[key]]) throw new Error(`${way}.${key}: found ${list[key]}; must be the number of an accessor`);
    return (await this.parser.getDependency('accessor', list[key])).array;
  }

  /** Texels of a picture in the file, as they are coded. */
  async picture(view) {
    const bytes = await this.parser.getDependency('bufferView', view);
    const bitmap = await createImageBitmap(new Blob([bytes]), { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
    const { width, height } = bitmap;
    const context = new OffscreenCanvas(width, height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    return { width, rgba: context.getImageData(0, 0, width, height).data };
  }

  /** The scratched twin of a mesh's material. `described` is the scene's own, where the object has one. */
  async material({ material: from, geometry }, described, scratches, gratings, metresPerUnit) {
    const { tables, parameters } = this;
    for (const key of ['sheen', 'iridescence']) {
      if (from[key] > 0) this.warn(`drawn under environments, not under lights: ${key}`);
    }
    if (described?.cover) this.warn(`not drawn: the plate over the material "${described.name}"`);
    const metal = metalOf(described);
    const taken = {};
    for (const key of KEYS) {
      const isOfMetal = metal !== null && (key === 'color' || key === 'metalness');
      if (from[key] !== undefined && from[key] !== null && !isOfMetal) taken[key] = from[key];
    }
    // Without tangents three.js has the bitangent where v rises, glTF where it falls.
    if (taken.anisotropyRotation && !geometry.attributes.tangent) taken.anisotropyRotation *= -1;
    const given = { tables, metal, scratches, gratings, metresPerUnit, coherenceUm: described?.coherence_um ?? COHERENCE_UM, ...taken, ...parameters };
    if (scratches) await prepareScratches(scratches, given);
    return new ScratchedNodeMaterial(given);
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

/** The metal of the scene's own material, by its name; null where it has none. */
const metalOf = (described) => (metals.includes(described?.metal) ? described.metal : null);

/** The way to a layer in the file. */
const wayOf = (layer, extension) => `scratches[${extension.scratches.indexOf(layer)}]`;

/** The file that a key of a table names. */
function fileOf(table, key, way, { files }) {
  const file = files?.[table[key]];
  if (!file) throw new Error(`${way}.${key}: found ${table[key]}; must be the number of one of \`files\``);
  return file;
}

/** Values of a mask as red: of each texel the mean of its colours, times its alpha. */
function greyOf(rgba) {
  const grey = new Uint8Array(rgba.length);
  for (let i = 0; i < rgba.length; i += 4) grey[i] = Math.round(((rgba[i] + rgba[i + 1] + rgba[i + 2]) * rgba[i + 3]) / 765);
  return grey;
}

/** A picture on a surface, which is there again beyond its border. */
function grooveTexture(width, rgba) {
  const made = new DataTexture(new Uint8Array(rgba), width, rgba.length / (4 * width), RGBAFormat);
  return Object.assign(made, {
    wrapS: RepeatWrapping, wrapT: RepeatWrapping, magFilter: LinearFilter, minFilter: LinearMipmapLinearFilter, generateMipmaps: true, needsUpdate: true,
  });
}

/** The scale of a node in the world; null where it is not one number. */
function scaleOf({ matrixWorld }) {
  const { x, y, z } = new Vector3().setFromMatrixScale(matrixWorld);
  return Math.max(Math.abs(x / y - 1), Math.abs(x / z - 1)) > 0.01 ? null : x;
}

/** Whether a node of that name lies on the way from a mesh up to the object's node. */
function isBelow(mesh, node, name) {
  for (let at = mesh; at; at = at === node ? null : at.parent) {
    if ((at.userData.name ?? at.name) === name) return true;
  }
  return false;
}

/** Maps of a material, in the order in which their texture coordinates stand for those of its mesh. */
const MAPS = [
  'normalMap', 'clearcoatNormalMap', 'map', 'metalnessMap', 'emissiveMap', 'aoMap', 'clearcoatMap', 'clearcoatRoughnessMap', 'anisotropyMap', 'specularIntensityMap',
  'specularColorMap',
];

/** How pictures lie on a mesh: `{ channel, matrix }`, as its material's first map by KHR_texture_transform, where three.js itself turns before it scales. */
function mappingOf({ material }) {
  const map = MAPS.map((key) => material[key]).find(Boolean);
  const matrix = new Matrix3();
  if (!map) return { channel: 0, matrix };
  const { channel, offset: { x, y }, repeat: scale, rotation } = map;
  const [cosine, sine] = [Math.cos(rotation), Math.sin(rotation)];
  return { channel, matrix: matrix.set(cosine * scale.x, sine * scale.y, x, -sine * scale.x, cosine * scale.y, y, 0, 0, 1) };
}

/** Texture coordinates of a mesh, one after the other. */
function coordinates(mesh) {
  const { channel, matrix } = mappingOf(mesh);
  const { attributes } = mesh.geometry;
  const uvs = attributes[channel > 0 ? `uv${channel}` : 'uv'];
  const at = new Vector2();
  const placed = (_, i) => (uvs ? at.fromBufferAttribute(uvs, i).applyMatrix3(matrix).toArray() : [0, 0]);
  return Array.from({ length: attributes.position.count }, placed).flat();
}

/** A picture on a mesh. */
function laidOn(picture, mesh) {
  const { channel, matrix } = mappingOf(mesh);
  if (!picture || (channel === 0 && matrix.equals(new Matrix3()))) return picture;
  return Object.assign(picture.clone(), { channel, matrix, matrixAutoUpdate: false, needsUpdate: true });
}

/** The triangles of meshes in the frame of their object, in the order of the file. */
function together(meshes, node) {
  const toObject = new Matrix4().copy(node.matrixWorld).invert();
  const lists = { positions: [], normals: [], uvs: [], index: [] };
  for (const mesh of meshes) {
    const first = lists.positions.length / 3;
    const { attributes, index } = mesh.geometry;
    const matrix = toObject.clone().multiply(mesh.matrixWorld);
    const normalMatrix = new Matrix3().getNormalMatrix(matrix);
    const at = new Vector3();
    for (let i = 0; i < attributes.position.count; i += 1) {
      lists.positions.push(...mesh.getVertexPosition(i, at).applyMatrix4(matrix).toArray());
      if (attributes.normal) lists.normals.push(...at.fromBufferAttribute(attributes.normal, i).applyMatrix3(normalMatrix).normalize().toArray());
    }
    lists.uvs.push(...coordinates(mesh));
    const corners = index?.array ?? Uint32Array.from({ length: attributes.position.count }, (_, i) => i);
    for (const corner of corners) lists.index.push(first + corner);
  }
  // A part without normals is flat; so are all then.
  return { ...lists, normals: lists.normals.length === lists.positions.length ? lists.normals : null };
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
  if (kept.length === scratches.count) return scratches;
  const pick = (array, width) => Float32Array.from(kept.flatMap((i) => Array.from(array.subarray(width * i, width * (i + 1)))));
  const { starts, ends, normals, widthsUm, depthsNm, scratch, profiles } = scratches;
  return new Scratches({
    starts: pick(starts, 3), ends: pick(ends, 3), normals: normals && pick(normals, 3), widthsUm: pick(widthsUm, 1), depthsNm: pick(depthsNm, 1),
    scratch: Uint32Array.from(kept, (i) => scratch[i]), profiles: profiles && kept.map((i) => profiles[i]),
  });
}
