// The functions of WGSL that the material for three.js calls, around the modules of the package.
import { wgsl, wgslFn } from 'three/tsl';
import { hairlineWgsl } from './wgsl.js';

// First arguments of all functions below: those of pixel_frame().
const PLACE = `position: vec3f, view_from_object: mat3x3f, position_view: vec3f, normal_view: vec3f, pixel: vec3f, ray_view: vec2f,
  move_x: vec3f, move_y: vec3f, turn_x: vec3f, turn_y: vec3f`;
const HERE = `pixel_frame(position, view_from_object, position_view, normal_view, pixel, ray_view, move_x, move_y, turn_x, turn_y)`;
const SCRATCHES = `${PLACE}, tree: texture_2d<u32>, tables: texture_2d_array<u32>`;
// The base: reflectance at normal incidence and roughness; curve, reflectance at grazing incidence, variance of a normal map's slopes; colour of the
// body and share of metal.
const BASE = `${PLACE}, surface: vec4f, more: vec3f, mixed: vec4f, shapes: texture_2d<f32>, albedo: texture_2d<f32>, curves: texture_2d<f32>`;
// A grating: its numbers, and how its direction changes from pixel to pixel.
const FIELD = `field: mat4x4f, bend_x: vec3f, bend_y: vec3f`;
const GRATED = `${PLACE}, rows: texture_2d_array<u32>, ${FIELD}, covered: f32`;
const GROOVES = `grated_point(here.view, hairline_grooves(field, bend_x, bend_y), covered)`;
// An environment's levels, and the way from the view's frame to that of its map.
const AROUND = `levels: texture_2d<f32>, map_from_view: mat3x3f`;
const MAP = `levels, map_from_view * transpose(here.surface_from_view)`;
const OUTLINE = `vertices: texture_2d<u32>, outline: vec4f, around: vec4f, view_from_light: mat4x4f`;

const library = wgsl(`${hairlineWgsl}
fn hairline_fresnel_rgb(surface: vec4f, more: vec3f) -> FresnelRgb {
  return FresnelRgb(surface.xyz, more.y, u32(more.x));
}
fn hairline_base(
  here: PixelFrame, surface: vec4f, more: vec3f, mixed: vec4f, shapes: texture_2d<f32>, albedo: texture_2d<f32>, curves: texture_2d<f32>,
) -> LitBase {
  let fresnel = hairline_fresnel_rgb(surface, more);
  let base = lit_base(normalize(here.view.to_viewer_m), surface.w, fresnel, pixel_slopes(here, more.z), shapes, albedo, curves);
  return lit_base_mixed(base, mixed.w, mixed.xyz);
}
fn hairline_brushed(
  here: PixelFrame, surface: vec4f, more: vec3f, mixed: vec4f, shapes: texture_2d<f32>, albedo: texture_2d<f32>, curves: texture_2d<f32>, facets: vec4f,
) -> BrushedBase {
  let along = (here.surface_from_view * facets.xyz).xy;
  let length_sq = dot(along, along);
  let unit = select(vec2f(1.0, 0.0), along * inverseSqrt(max(length_sq, 1e-30)), length_sq > 1e-12);
  let fresnel = hairline_fresnel_rgb(surface, more);
  let wo = normalize(here.view.to_viewer_m);
  var base = brushed_base(wo, surface.w, unit, facets.w, fresnel, pixel_slopes(here, more.z), shapes, albedo, curves);
  base.lit = lit_base_mixed(base.lit, mixed.w, mixed.xyz);
  return base;
}
fn hairline_grooves(${FIELD}) -> Grooves {
  let rows = GrooveField(field[0].xyz, u32(field[0].w), field[2].xy, field[1].w, field[2].z, field[2].w);
  return Grooves(rows, field[1].xyz, field[3].x, 0u, field[3].y > 0.0, field[3].w, mat2x3f(bend_x, bend_y));
}
// The light, the point and the axes of the surface in the light's frame.
struct HairlineOutline { light: OutlineLight, point_m: vec3f, surface: mat3x3f }
fn hairline_outline(here: PixelFrame, outline: vec4f, view_from_light: mat4x4f) -> HairlineOutline {
  let light_from_view = transpose(mat3x3f(view_from_light[0].xyz, view_from_light[1].xyz, view_from_light[2].xyz));
  let light = OutlineLight(0u, u32(outline.x), vec3f(0.0, 0.0, -1.0), outline.z > 0.0, outline.y > 0.0);
  let point_m = light_from_view * (here.position_view - view_from_light[3].xyz);
  return HairlineOutline(light, point_m, light_from_view * transpose(here.surface_from_view));
}
`);

export const maskOf = wgslFn(`fn hairline_mask(${SCRATCHES}) -> vec4f {
  let here = ${HERE};
  let sums = scratched_sums(tables, tree, scratched_point(here.view, tree, 0u));
  let masked = mask_resolve(scratched_with(sums, vec3f(1.0)), scratch_tree_depth_coherence(tree));
  return vec4f(masked.taken, masked.scratches.x);
}`, [library]);

/** What is sent of a light by scratches or by a grating. */
function sentFunctions(name, parameters, module, given) {
  return {
    bySphere: wgslFn(`fn hairline_${name}_sphere(${parameters}, light: vec4f) -> vec3f {
  let here = ${HERE};
  let center = here.surface_from_view * (light.xyz - here.position_view);
  return ${module}_sphere(${given}, center, light.w);
}`, [library]),
    byQuad: wgslFn(`fn hairline_${name}_quad(${parameters}, middle: vec3f, half_width: vec3f, half_height: vec3f) -> vec3f {
  let here = ${HERE};
  let turn = here.surface_from_view;
  return ${module}_quad(${given}, quad_light(turn * (middle - here.position_view), turn * half_width, turn * half_height, false));
}`, [library]),
    byOutline: wgslFn(`fn hairline_${name}_outline(${parameters}, ${OUTLINE}) -> vec3f {
  let here = ${HERE};
  let seen = hairline_outline(here, outline, view_from_light);
  return ${module}_outline(${given}, vertices, seen.light, around, seen.point_m, seen.surface);
}`, [library]),
    byEnvironment: wgslFn(`fn hairline_${name}_environment(${parameters}, ${AROUND}) -> vec3f {
  let here = ${HERE};
  return ${module}_environment(${given}, ${MAP});
}`, [library]),
  };
}

export const scratchesSend = sentFunctions('scratches', SCRATCHES, 'scratched', 'tables, tree, scratched_point(here.view, tree, 0u)');

export const gratingSends = sentFunctions('grating', GRATED, 'grated', `rows, ${GROOVES}`);

/** The share of a pixel that a grating would cover. */
export const gratingShare = wgslFn(`fn hairline_grating_share(${PLACE}, ${FIELD}) -> f32 {
  return grooves_seen(${HERE}.view, hairline_grooves(field, bend_x, bend_y)).share;
}`, [library]);

/** What it takes of the base. */
export const gratingTaken = wgslFn(`fn hairline_grating_taken(${GRATED}) -> vec3f {
  let here = ${HERE};
  return grated_taken(rows, ${GROOVES});
}`, [library]);

/** One cell of its band, as bandCell. */
export const gratingCell = wgslFn(`fn hairline_grating_cell(${GRATED}, j: u32) -> mat4x4f {
  let here = ${HERE};
  let cell = grated_cell(rows, ${GROOVES}, j);
  return mat4x4f(vec4f(cell.direction, cell.roughness), vec4f(cell.response, 0.0), vec4f(0.0), vec4f(0.0));
}`, [library]);

/** From where attributes are interpolated to the middle of the pixel, and from there by a pixel to the right and down, in steps of dFdx and dFdy. */
export const pixelWays = wgslFn(`fn hairline_pixel_ways(${PLACE}) -> mat3x3f {
  let ways = pixel_ways(${HERE}, position_view, move_x, move_y);
  return mat3x3f(vec3f(ways[0], 0.0), vec3f(ways[1], 0.0), vec3f(ways[2], 0.0));
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
    band[3].z = f32(seen.profile.shape);
  }
  band[2] = vec4f(f32(walk.node), f32(walk.piece), f32(walk.end), f32(walk.step));
  band[3].x = walk.weight;
  return band;
}`, [library]);

// One cell of its band: a direction of the surface's frame and the roughness of a look-up; what comes of it.
export const bandCell = wgslFn(`fn hairline_band_cell(band: mat4x4f, tables: texture_2d_array<u32>, j: u32) -> mat4x4f {
  let cell = scratched_cell(tables, 0u, band[1].xyz, band[0].xy, Profile(band[0].w, band[1].w, u32(band[3].z)), j);
  return mat4x4f(vec4f(cell.direction, cell.roughness), vec4f(band[0].z * cell.response, 0.0), vec4f(0.0), vec4f(0.0));
}`, [library]);

/** Functions of a base: of a name, with a WGSL expression of it, the module's name, and of the base its round one and its texture for environments. */
function baseFunctions(name, parameters, made, module, [lit, lookups]) {
  const given = `let here = ${HERE};\n  let base = ${made};`;
  return {
    bySphere: wgslFn(`fn hairline_${name}_sphere(${parameters}, light: vec4f) -> vec4f {
  ${given}
  let lit = ${module}_sphere(base, curves, here.surface_from_view * (light.xyz - here.position_view), light.w);
  return vec4f(lit.specular, lit.form_factor);
}`, [library]),
    byOutline: wgslFn(`fn hairline_${name}_outline(${parameters}, ${OUTLINE}) -> vec4f {
  ${given}
  let seen = hairline_outline(here, outline, view_from_light);
  let view = outline_view(vertices, seen.light, seen.point_m, seen.surface, vec2f(1.0, 0.0));
  let per_m = light_per_distance(around.xyz - seen.point_m, around.w);
  let lit = ${module}_outline(base, curves, vertices, view, per_m);
  return vec4f(lit.specular, lit.form_factor);
}`, [library]),
    byEnvironment: wgslFn(`fn hairline_${name}_environment(${parameters}, ${AROUND}) -> vec3f {
  ${given}
  return ${module}_environment(base, ${lookups}, ${MAP});
}`, [library]),
    reflected: wgslFn(`fn hairline_${name}_reflected(${parameters}, specular: vec3f) -> vec3f {
  ${given}
  return lit_base_reflected(${lit}, specular);
}`, [library]),
    body: wgslFn(`fn hairline_${name}_body(${parameters}) -> vec3f {
  ${given}
  return lit_base_body(${lit});
}`, [library]),
  };
}

export const roundBase = {
  ...baseFunctions('base', BASE, 'hairline_base(here, surface, more, mixed, shapes, albedo, curves)', 'lit_base', ['base', 'shapes']),
  byQuad: wgslFn(`fn hairline_base_quad(${BASE}, middle: vec3f, half_width: vec3f, half_height: vec3f) -> vec4f {
  let here = ${HERE};
  let turn = here.surface_from_view;
  let base = hairline_base(here, surface, more, mixed, shapes, albedo, curves);
  let lit = lit_base_quad(base, curves, quad_light(turn * (middle - here.position_view), turn * half_width, turn * half_height, false));
  return vec4f(lit.specular, lit.form_factor);
}`, [library]),
};

// `facets`: the direction of the view's frame across the brushing; the anisotropy.
export const brushedBase = baseFunctions(
  'brushed', `${BASE}, facets: vec4f`, 'hairline_brushed(here, surface, more, mixed, shapes, albedo, curves, facets)', 'brushed_base', ['base.lit', 'curves'],
);

/** What falls on the body of an environment. */
export const environmentOnBody = wgslFn(`fn hairline_environment_on_body(${PLACE}, ${AROUND}) -> vec3f {
  let here = ${HERE};
  return environment_mean_by_cosine(levels, map_from_view * transpose(here.surface_from_view)[2]);
}`, [library]);

export const fresnelOf = wgslFn(`fn hairline_fresnel(${BASE}) -> vec3f {
  let here = ${HERE};
  return fresnel_eval(curves, hairline_fresnel_rgb(surface, more), normalize(here.view.to_viewer_m).z);
}`, [library]);
