// ScratchedNodeMaterial for three.js, WebGPURenderer: metal or lacquer with scratches that split light into colours. PointLight, SpotLight,
// DirectionalLight and RectAreaLight light it in closed form, with three's own shadows; environments by three's own maps.
//
// The world is in metres. Lights without a size get one: `light.userData.radius` in metres (of a DirectionalLight `userData.angle` in
// radians), or the material's `lightRadius`.
import {
  DataArrayTexture, DataTexture, FloatType, InstancedInterleavedBuffer, InterleavedBufferAttribute, MeshStandardNodeMaterial,
  PhysicalLightingModel, RGBAFormat, RGBAIntegerFormat, UnsignedIntType, Vector3,
} from 'three/webgpu';
import {
  Break, If, Loop, buffer, cameraProjectionMatrix, cameraWorldMatrix, dFdx, dFdy, diffuseColor, diffuseContribution, float, instanceIndex,
  instancedBufferAttribute, lightViewPosition, mat3, mat4, materialEnvIntensity, materialRoughness, metalness, mix, modelViewMatrix, normalView,
  normalViewGeometry, pmremTexture, positionGeometry, positionView, texture, uint, uniform, varying, vec2, vec3, viewportSize, viewportUV, vec4, wgsl, wgslFn,
} from 'three/tsl';
import { hairlineWgsl } from './wgsl.js';
import { Scratches, preparedPieces, readScratches } from './scratches.js';
import { layScratches } from './pattern.js';
import { scratchTree } from './tree.js';
import { scratchTable, tableSize } from './table.js';
import { curveOf } from './tables.js';
import { metalColor } from './spectrum.js';

export { loadTables } from './tables.js';
export { Scratches, readScratches };

/** The sun's, as a light's `userData.angle`. */
const SUN_RAD = 0.00465;
/** How far a DirectionalLight stands off. */
const FAR_M = 1000;
/** More scratches of one pixel do not mirror the environment. */
const SCRATCHES_MAX = 4096;

/** Lays scratches in a pattern on a BufferGeometry, see layScratches(). */
export function scratchesOn(geometry, options) {
  const { position } = geometry.attributes;
  const positions = new Float64Array(3 * position.count);
  for (let i = 0; i < position.count; i += 1) positions.set([position.getX(i), position.getY(i), position.getZ(i)], 3 * i);
  return layScratches({ positions, index: geometry.index?.array ?? null }, options);
}

// What all functions below take first: where the point is and how it is looked at. `pixel`: how the ray changes over a pixel to the right
// and down at depth 1; 1 for a parallel view. `ray_view`: the ray through the middle of the pixel, at depth 1.
// `moves` and `turns`: how position and smooth normal of the view's frame change from one pixel of a quad to the next.
const PLACE = `position: vec3f, view_from_object: mat3x3f, position_view: vec3f, normal_view: vec3f, pixel: vec3f, ray_view: vec2f,
  move_x: vec3f, move_y: vec3f, turn_x: vec3f, turn_y: vec3f`;
const HERE = `hairline_frame(position, view_from_object, position_view, normal_view, pixel, ray_view, move_x, move_y, turn_x, turn_y)`;
const SCRATCHES = `${PLACE}, tree: texture_2d<u32>, tables: texture_2d_array<u32>`;
const BASE = `${PLACE}, surface: vec4f, curve: f32, shapes: texture_2d<f32>, albedo: texture_2d<f32>, curves: texture_2d<f32>`;

const library = wgsl(`${hairlineWgsl}
struct HairlineFrame {
  view: SurfaceView,
  position_view: vec3f,
  surface_from_view: mat3x3f,
}
// z along the normal, the viewer in the x-z plane; any x where they look along the normal.
fn hairline_axes(n: vec3f, direction: vec3f) -> mat3x3f {
  let aside = direction - n * dot(n, direction);
  let any = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(n.x) > 0.7);
  let x = normalize(select(any - n * dot(n, any), aside, dot(aside, aside) > 1e-10));
  return transpose(mat3x3f(x, cross(n, x), n));
}
fn hairline_frame(${PLACE}) -> HairlineFrame {
  let is_parallel = pixel.z > 0.5;
  let direction = normalize(select(-position_view, vec3f(0.0, 0.0, 1.0), is_parallel));
  var n = normal_view;
  let cosine = dot(n, direction);
  if cosine < 0.01 {
    let aside = n - direction * cosine;
    n = direction * 0.01 + aside * (0.99995 * inverseSqrt(max(dot(aside, aside), 1e-12)));
  }
  let depth = select(max(-position_view.z, 1e-9), 1.0, is_parallel);
  let ray = select(vec3f(ray_view, -1.0), vec3f(0.0, 0.0, -1.0), is_parallel);
  // Rasterisers put corners on a tree of 1/256 of a pixel, some of 1/16: what they interpolate is that far from the middle of the pixel.
  let axes = hairline_axes(n, direction);
  let right = axes * footprint_axis(ray, depth, n, vec3f(pixel.x, 0.0, 0.0));
  let down = axes * footprint_axis(ray, depth, n, vec3f(0.0, -pixel.y, 0.0));
  let off = axes * (ray * (dot(position_view, n) / dot(ray, n)) - position_view);
  let is_near = dot(off, off) < dot(right, right) + dot(down, down);
  let shift = select(vec3f(0.0), off, is_near && !is_parallel);
  // How the surface bends, from the quad: it changes less over a pixel than what a pixel covers does.
  let moves = mat2x2f((axes * move_x).xy, (axes * move_y).xy);
  let turns = mat2x3f(axes * turn_x, axes * turn_y);
  let exact = position_view + transpose(axes) * shift;
  let turned = normalize(n + transpose(axes) * hairline_turn(moves, turns, shift.xy));
  let surface_from_view = hairline_axes(turned, normalize(select(-exact, vec3f(0.0, 0.0, 1.0), is_parallel)));
  let surface_from_object = surface_from_view * view_from_object;
  // Of a turn with one scale, the inverse is the transpose over the square of the scale.
  let scale = dot(view_from_object[0], view_from_object[0]);
  let view = SurfaceView(
    position + transpose(axes * view_from_object) * shift / max(scale, 1e-20),
    surface_from_object,
    surface_from_view * select(-exact, vec3f(0.0, 0.0, 1e3), is_parallel),
    right,
    down,
    hairline_turn(moves, turns, right.xy),
    hairline_turn(moves, turns, down.xy),
  );
  return HairlineFrame(view, exact, surface_from_view);
}
fn hairline_turn(moves: mat2x2f, turns: mat2x3f, way: vec2f) -> vec3f {
  let area = determinant(moves);
  let safe = select(area, 1e-30, abs(area) < 1e-30);
  let shares = vec2f(way.x * moves[1].y - way.y * moves[1].x, moves[0].x * way.y - moves[0].y * way.x) / safe;
  return turns * clamp(shares, vec2f(-4.0), vec2f(4.0));
}
fn hairline_base(here: HairlineFrame, surface: vec4f, curve: f32, shapes: texture_2d<f32>, albedo: texture_2d<f32>, curves: texture_2d<f32>) -> LitBase {
  let spread = slope_spread(SCRATCHED_FILTER_STD * here.view.turn_x.xy, SCRATCHED_FILTER_STD * here.view.turn_y.xy);
  return lit_base(normalize(here.view.to_viewer_m), surface.w, FresnelRgb(surface.xyz, u32(curve)), spread, shapes, albedo, curves);
}
`);

const maskOf = wgslFn(`fn hairline_mask(${SCRATCHES}) -> vec4f {
  let here = ${HERE};
  let sums = scratched_sums(tables, tree, scratched_point(here.view, tree, 0u));
  let masked = mask_resolve(scratched_with(sums, vec3f(1.0)), scratch_tree_depth_coherence(tree));
  return vec4f(masked.taken, masked.scratches.x);
}`, [library]);

const scratchesBySphere = wgslFn(`fn hairline_scratches_sphere(${SCRATCHES}, light: vec4f) -> vec3f {
  let here = ${HERE};
  let center = here.surface_from_view * (light.xyz - here.position_view);
  return scratched_sphere(tables, tree, scratched_point(here.view, tree, 0u), center, light.w);
}`, [library]);

const scratchesByQuad = wgslFn(`fn hairline_scratches_quad(${SCRATCHES}, middle: vec3f, half_width: vec3f, half_height: vec3f) -> vec3f {
  let here = ${HERE};
  let turn = here.surface_from_view;
  let light = quad_light(turn * (middle - here.position_view), turn * half_width, turn * half_height, false);
  return scratched_quad(tables, tree, scratched_point(here.view, tree, 0u), light);
}`, [library]);

const viewFromSurface = wgslFn(`fn hairline_view_from_surface(${PLACE}) -> mat3x3f {
  return transpose(${HERE}.surface_from_view);
}`, [library]);

// The next of the scratches that a point sees, from one that is all zeros on: tangent, share and width; the way to the viewer and depth; where
// to go on; how many it stands for, and 0 after the last one.
const bandOf = wgslFn(`fn hairline_band(${SCRATCHES}, walked: mat4x4f) -> mat4x4f {
  let here = ${HERE};
  let point = scratched_point(here.view, tree, 0u);
  var walk = scratched_walk(tree, point);
  walk.node = u32(walked[2].x);
  walk.piece = u32(walked[2].y);
  walk.end = u32(walked[2].z);
  walk.step = max(u32(walked[2].w), 1u);
  walk.weight = max(walked[3].x, 1.0);
  let piece = scratch_walk_next(tree, &walk);
  var band = mat4x4f();
  if piece != SCRATCH_TREE_END {
    let seen = scratched_seen(tree, point, walk, piece);
    band[0] = vec4f(seen.tangent, max(seen.share.segment, 0.0), seen.profile.width_um);
    band[1] = vec4f(point.lit.wo, seen.profile.depth_nm);
    band[3].y = 1.0;
  }
  band[2] = vec4f(f32(walk.node), f32(walk.piece), f32(walk.end), f32(walk.step));
  band[3].x = walk.weight;
  return band;
}`, [library]);

// One cell of its band: a direction of the surface's frame and the roughness of a look-up; what comes of it.
const bandCell = wgslFn(`fn hairline_band_cell(band: mat4x4f, tables: texture_2d_array<u32>, j: u32) -> mat4x4f {
  let wo = band[1].xyz;
  let width_um = band[0].w;
  let cell = environment_cell(j, band_line_at(band_from_surface(band[0].xy, wo), 0.0), width_um);
  let depth_nm = oblique_depth_nm(band[1].w, cell.direction.z, wo.z);
  let low = scratch_table(tables, 0u, width_um * cell.q_low, depth_nm);
  let response = band[0].z * (scratch_table(tables, 0u, width_um * max(cell.q_high, cell.q_low), depth_nm) - low);
  return mat4x4f(
    vec4f(surface_from_band(band[0].xy, cell.direction), environment_cell_roughness(cell)),
    vec4f(response, 0.0),
    vec4f(0.0),
    vec4f(0.0),
  );
}`, [library]);

const baseBySphere = wgslFn(`fn hairline_base_sphere(${BASE}, light: vec4f) -> vec4f {
  let here = ${HERE};
  let base = hairline_base(here, surface, curve, shapes, albedo, curves);
  let lit = lit_base_sphere(base, curves, here.surface_from_view * (light.xyz - here.position_view), light.w);
  return vec4f(lit.specular, lit.form_factor);
}`, [library]);

const baseByQuad = wgslFn(`fn hairline_base_quad(${BASE}, middle: vec3f, half_width: vec3f, half_height: vec3f) -> vec4f {
  let here = ${HERE};
  let turn = here.surface_from_view;
  let base = hairline_base(here, surface, curve, shapes, albedo, curves);
  let lit = lit_base_quad(base, curves, quad_light(turn * (middle - here.position_view), turn * half_width, turn * half_height, false));
  return vec4f(lit.specular, lit.form_factor);
}`, [library]);

const baseReflected = wgslFn(`fn hairline_base_reflected(${BASE}, specular: vec3f) -> vec3f {
  return lit_base_reflected(hairline_base(${HERE}, surface, curve, shapes, albedo, curves), specular);
}`, [library]);

const baseBody = wgslFn(`fn hairline_base_body(${BASE}) -> vec3f {
  return lit_base_body(hairline_base(${HERE}, surface, curve, shapes, albedo, curves));
}`, [library]);

const fresnelOf = wgslFn(`fn hairline_fresnel(${BASE}) -> vec3f {
  let here = ${HERE};
  return fresnel_eval(curves, FresnelRgb(surface.xyz, u32(curve)), normalize(here.view.to_viewer_m).z);
}`, [library]);

/** From the object's frame to the view's, without the move: of a mesh, or of each instance. */
function viewFromObject(object) {
  if (!object.isInstancedMesh) return mat3(modelViewMatrix);
  const { instanceMatrix } = object;
  const count = Math.max(instanceMatrix.count, 1);
  let matrix;
  if (count <= 1000) {
    matrix = buffer(instanceMatrix.array, 'mat4', count).element(instanceIndex);
  } else {
    const columns = new InstancedInterleavedBuffer(instanceMatrix.array, 16, 1);
    matrix = mat4(...[0, 4, 8, 12].map((offset) => instancedBufferAttribute(new InterleavedBufferAttribute(columns, 4, offset))));
  }
  const whole = modelViewMatrix.mul(matrix).toVar();
  return mat3(...[0, 1, 2].map((i) => varying(whole.element(i).xyz)));
}

class ScratchedLightingModel extends PhysicalLightingModel {
  constructor(material, environment) {
    super();
    this.material = material;
    this.environment = environment;
  }

  start(builder) {
    const { material } = this;
    const nodes = material.hairlineNodes;
    const side = normalViewGeometry.dot(normalView).sign();
    const perspective = vec2(cameraProjectionMatrix.element(0).x, cameraProjectionMatrix.element(1).y).toVar();
    const middle = cameraProjectionMatrix.element(2).xy;
    const place = {
      position: positionGeometry,
      view_from_object: viewFromObject(builder.object).toVar(),
      position_view: positionView,
      normal_view: normalView,
      pixel: vec3(vec2(2).div(viewportSize.mul(perspective)), cameraProjectionMatrix.element(3).w).toVar(),
      ray_view: viewportUV.mul(vec2(2, -2)).add(vec2(-1, 1)).add(middle).div(perspective).toVar(),
      move_x: dFdx(positionView).toVar(),
      move_y: dFdy(positionView).toVar(),
      turn_x: dFdx(normalViewGeometry).mul(side).toVar(),
      turn_y: dFdy(normalViewGeometry).mul(side).toVar(),
    };
    const roughness = material.roughnessNode ? float(material.roughnessNode) : materialRoughness;
    this.base = {
      ...place, surface: vec4(mix(vec3(0.04), diffuseColor.rgb, metalness), roughness).toVar(), curve: nodes.curve,
      shapes: nodes.shapes, albedo: nodes.albedo, curves: nodes.curves,
    };
    this.scratches = material.scratches ? { ...place, tree: nodes.tree, tables: nodes.table } : null;
    this.specular = vec3(0).toVar();
    this.diffuse = vec3(0).toVar();
    this.scratchLight = vec3(0).toVar();

    super.start(builder);

    const { reflectedLight } = builder.context;
    const reflected = baseReflected({ ...this.base, specular: this.specular });
    reflectedLight.directDiffuse.addAssign(this.diffuse.mul(diffuseContribution).mul(baseBody(this.base)));
    if (!this.scratches) {
      reflectedLight.directSpecular.addAssign(reflected);
      return;
    }
    const mask = maskOf(this.scratches).toVar();
    const left = mask.xyz.oneMinus().toVar();
    if (this.environment) this.scratchLight.addAssign(this.scratchesByEnvironment());
    const coloured = this.scratchLight.mul(mask.w).mul(fresnelOf(this.base));
    // Channels that lie outside of the gamut stay below zero where the picture is a float one, and are cut by the display.
    reflectedLight.directSpecular.addAssign(reflected.mul(left).add(coloured));
    reflectedLight.indirectSpecular.mulAssign(left);
  }

  direct({ lightDirection, lightColor, lightNode }) {
    const { light } = lightNode;
    const { lightRadius } = this.material;
    let center;
    let radius;
    let distanceSquared;
    if (light.isDirectionalLight) {
      center = positionView.add(lightDirection.mul(FAR_M));
      radius = uniform(0).onRenderUpdate(() => FAR_M * Math.sin(light.userData.angle ?? SUN_RAD));
      distanceSquared = float(FAR_M * FAR_M);
    } else {
      center = lightViewPosition(light);
      radius = uniform(0).onRenderUpdate(() => light.userData.radius ?? lightRadius);
      const way = center.sub(positionView);
      // three.js holds its fall-off at that of 0.1 m.
      distanceSquared = way.dot(way).max(0.01);
    }
    const radiance = lightColor.mul(distanceSquared).div(radius.mul(radius).mul(Math.PI)).toVar();
    this.light(radiance, { light: vec4(center, radius).toVar() }, baseBySphere, scratchesBySphere);
  }

  directRectArea({ lightColor, lightPosition, halfWidth, halfHeight }) {
    // It shines to its own -z.
    const quad = { middle: lightPosition.toVar(), half_width: halfHeight.toVar(), half_height: halfWidth.toVar() };
    this.light(lightColor.toVar(), quad, baseByQuad, scratchesByQuad);
  }

  light(radiance, shape, base, scratches) {
    const lit = base({ ...this.base, ...shape }).toVar();
    this.specular.addAssign(radiance.mul(lit.xyz));
    this.diffuse.addAssign(radiance.mul(lit.w));
    if (this.scratches) this.scratchLight.addAssign(radiance.mul(scratches({ ...this.scratches, ...shape })));
  }

  scratchesByEnvironment() {
    const { tree: _, tables, ...place } = this.scratches;
    const sum = vec3(0).toVar();
    const axes = viewFromSurface(place).toVar();
    const band = mat4(vec4(0), vec4(0), vec4(0), vec4(0)).toVar();
    Loop({ start: uint(0), end: uint(SCRATCHES_MAX), type: 'uint', condition: '<', name: 'scratch' }, () => {
      band.assign(bandOf({ ...this.scratches, walked: band }));
      If(band.element(3).y.equal(0), () => Break());
      If(band.element(0).z.greaterThan(0), () => {
        Loop({ start: uint(0), end: uint(10), type: 'uint', condition: '<', name: 'cell' }, ({ cell }) => {
          const found = bandCell({ band, tables, j: cell }).toVar();
          const direction = axes.mul(found.element(0).xyz).transformDirection(cameraWorldMatrix);
          const radiance = pmremTexture(this.environment, direction, found.element(0).w).mul(materialEnvIntensity);
          sum.addAssign(radiance.mul(found.element(1).xyz));
        });
      });
    });
    return sum;
  }
}

function floatTexture({ data, width, height }) {
  const made = new DataTexture(data, width, height, RGBAFormat, FloatType);
  made.needsUpdate = true;
  return made;
}

const shared = new WeakMap();

/** The textures of a set of tables, made once. */
function texturesOf(tables) {
  if (!shared.has(tables)) {
    shared.set(tables, { shapes: floatTexture(tables.shapes), albedo: floatTexture(tables.albedo), curves: floatTexture(tables.curves), metals: new Map() });
  }
  return shared.get(tables);
}

function tableTexture(tables, metal) {
  const { metals } = texturesOf(tables);
  if (!metals.has(metal)) {
    const made = new DataArrayTexture(scratchTable(metal), tableSize.columns, tableSize.rows, 1);
    made.format = RGBAIntegerFormat;
    made.type = UnsignedIntType;
    made.needsUpdate = true;
    metals.set(metal, made);
  }
  return metals.get(metal);
}

function treeTexture(scratches, { coherenceUm, metresPerUnit }) {
  const { texels, width, height } = scratchTree(preparedPieces(scratches, { coherenceUm, metresPerUnit }), { metresPerUnit });
  const made = new DataTexture(texels, width, height, RGBAIntegerFormat, UnsignedIntType);
  made.needsUpdate = true;
  return made;
}

/**
 * MeshStandardNodeMaterial with scratches. Besides its own parameters: `tables` of loadTables(); `metal` by name, or null for `color` and
 * `metalness`; `scratches` in the object's own frame, or null; `coherenceUm`; `metresPerUnit`, how long a unit of the object's frame is;
 * `lightRadius` of lights that have none.
 */
export class ScratchedNodeMaterial extends MeshStandardNodeMaterial {
  static get type() {
    return 'ScratchedNodeMaterial';
  }

  constructor({ tables, metal = null, scratches = null, coherenceUm = 20, metresPerUnit = 1, lightRadius = 0.005, ...parameters } = {}) {
    super();
    if (!tables) throw new Error('tables: found none; must be what loadTables() returned');
    if (scratches !== null && !(scratches instanceof Scratches)) {
      throw new Error('scratches: found something else; must be what readScratches() or scratchesOn() returned, or null');
    }
    this.isScratchedNodeMaterial = true;
    Object.assign(this, { tables, metal, coherenceUm, metresPerUnit, lightRadius });
    const { shapes, albedo, curves } = texturesOf(tables);
    this.scratches = scratches;
    const tree = scratches && texture(treeTexture(scratches, this));
    Object.defineProperty(this, 'hairlineNodes', {
      value: {
        shapes: texture(shapes), albedo: texture(albedo), curves: texture(curves), table: texture(tableTexture(tables, metal)), tree,
        curve: uniform(curveOf(metal)),
      },
    });
    if (metal !== null) {
      this.color.setRGB(...metalColor(metal));
      this.metalness = 1;
    }
    this.setValues(parameters);
  }

  setupLightingModel(builder) {
    if (!builder.renderer.backend.isWebGPUBackend) {
      throw new Error('ScratchedNodeMaterial: found the backend for WebGL; must be that for WebGPU, which this browser lacks or `forceWebGL` turns off');
    }
    this.checkScale(builder.object);
    const environment = this.setupEnvironment(builder);
    return new ScratchedLightingModel(this, environment && environmentTexture(environment.envNode, this));
  }

  /** Scratches of another scale than they were made for end in the wrong places. */
  checkScale({ matrixWorld, name }) {
    const scale = new Vector3().setFromMatrixScale(matrixWorld);
    const isRight = scale.toArray().every((s) => Math.abs(s / this.metresPerUnit - 1) < 0.01);
    if (this.scratches && !isRight) {
      console.warn(`ScratchedNodeMaterial: found the scale ${scale.toArray().join(', ')} of mesh "${name}"; must be metresPerUnit, ${this.metresPerUnit}`);
    }
  }

  customProgramCacheKey() {
    // Its textures are its own.
    return `${super.customProgramCacheKey()}-${this.id}`;
  }

  clone() {
    const { tables, metal, scratches, coherenceUm, metresPerUnit, lightRadius } = this;
    return new ScratchedNodeMaterial({ tables, metal, scratches, coherenceUm, metresPerUnit, lightRadius }).copy(this);
  }

  dispose() {
    this.hairlineNodes.tree?.value.dispose();
    super.dispose();
  }
}

/** The texture of an environment; a node that gives colours by itself is not looked up by scratches. */
function environmentTexture(node, material) {
  if (node?.isMaterialReferenceNode) return material.envMap;
  return node?.isTextureNode ? node.value : null;
}
