// The functions of WGSL that the material for three.js calls, around the modules of the package.
import { wgsl, wgslFn } from 'three/tsl';
import { hairlineWgsl } from './wgsl.js';

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

export const maskOf = wgslFn(`fn hairline_mask(${SCRATCHES}) -> vec4f {
  let here = ${HERE};
  let sums = scratched_sums(tables, tree, scratched_point(here.view, tree, 0u));
  let masked = mask_resolve(scratched_with(sums, vec3f(1.0)), scratch_tree_depth_coherence(tree));
  return vec4f(masked.taken, masked.scratches.x);
}`, [library]);

export const scratchesBySphere = wgslFn(`fn hairline_scratches_sphere(${SCRATCHES}, light: vec4f) -> vec3f {
  let here = ${HERE};
  let center = here.surface_from_view * (light.xyz - here.position_view);
  return scratched_sphere(tables, tree, scratched_point(here.view, tree, 0u), center, light.w);
}`, [library]);

export const scratchesByQuad = wgslFn(`fn hairline_scratches_quad(${SCRATCHES}, middle: vec3f, half_width: vec3f, half_height: vec3f) -> vec3f {
  let here = ${HERE};
  let turn = here.surface_from_view;
  let light = quad_light(turn * (middle - here.position_view), turn * half_width, turn * half_height, false);
  return scratched_quad(tables, tree, scratched_point(here.view, tree, 0u), light);
}`, [library]);

export const viewFromSurface = wgslFn(`fn hairline_view_from_surface(${PLACE}) -> mat3x3f {
  return transpose(${HERE}.surface_from_view);
}`, [library]);

// The next of the scratches that a point sees, from one that is all zeros on: tangent, share and width; the way to the viewer and depth; where
// to go on; how many it stands for, and 0 after the last one.
export const bandOf = wgslFn(`fn hairline_band(${SCRATCHES}, walked: mat4x4f) -> mat4x4f {
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
export const bandCell = wgslFn(`fn hairline_band_cell(band: mat4x4f, tables: texture_2d_array<u32>, j: u32) -> mat4x4f {
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

export const baseBySphere = wgslFn(`fn hairline_base_sphere(${BASE}, light: vec4f) -> vec4f {
  let here = ${HERE};
  let base = hairline_base(here, surface, curve, shapes, albedo, curves);
  let lit = lit_base_sphere(base, curves, here.surface_from_view * (light.xyz - here.position_view), light.w);
  return vec4f(lit.specular, lit.form_factor);
}`, [library]);

export const baseByQuad = wgslFn(`fn hairline_base_quad(${BASE}, middle: vec3f, half_width: vec3f, half_height: vec3f) -> vec4f {
  let here = ${HERE};
  let turn = here.surface_from_view;
  let base = hairline_base(here, surface, curve, shapes, albedo, curves);
  let lit = lit_base_quad(base, curves, quad_light(turn * (middle - here.position_view), turn * half_width, turn * half_height, false));
  return vec4f(lit.specular, lit.form_factor);
}`, [library]);

export const baseReflected = wgslFn(`fn hairline_base_reflected(${BASE}, specular: vec3f) -> vec3f {
  return lit_base_reflected(hairline_base(${HERE}, surface, curve, shapes, albedo, curves), specular);
}`, [library]);

export const baseBody = wgslFn(`fn hairline_base_body(${BASE}) -> vec3f {
  return lit_base_body(hairline_base(${HERE}, surface, curve, shapes, albedo, curves));
}`, [library]);

export const fresnelOf = wgslFn(`fn hairline_fresnel(${BASE}) -> vec3f {
  let here = ${HERE};
  return fresnel_eval(curves, FresnelRgb(surface.xyz, u32(curve)), normalize(here.view.to_viewer_m).z);
}`, [library]);
