// Surface points as they lie in memory between passes.
// Needs: layout, surface_point, fresnel, contents.

fn pixel_point_pack(point: SurfacePoint, object: u32, depth_m: f32, place: u32) -> PixelPoint {
    return PixelPoint(
        point.position_m,
        object + 1u,
        point.normal,
        depth_m,
        point.axis_x,
        point.coherence_um,
        vec4f(point.footprint_x_um, point.footprint_y_um),
        vec4f(point.turn_x, point.turn_y),
        point.wo.z,
        point.distance_m,
        point.table | (place << 16u),
        point.leaves,
    );
}

// The curve and what of the environment's light arrives, in 16 bits each. Where reflectances at grazing incidence are not all 1: 11 bits, 10 bits, and 11
// bits of that. Curves are rows of a texture, which has too few for more.
fn pixel_curve_pack(point: SurfacePoint) -> u32 {
    if !HAS_SPECULAR {
        return point.curve | (u32(round(65535.0 * point.open)) << 16u);
    }
    let bits = vec2u(round(vec2f(1023.0, 2047.0) * vec2f(point.open, point.f90)));
    return point.curve | (bits.x << 11u) | (bits.y << 21u);
}

fn pixel_open(paint: PixelPaint) -> f32 {
    if !HAS_SPECULAR {
        return f32(paint.curve_bits >> 16u) / 65535.0;
    }
    return f32((paint.curve_bits >> 11u) & 0x3ffu) / 1023.0;
}

fn pixel_fresnel(paint: PixelPaint) -> FresnelRgb {
    if !HAS_SPECULAR {
        return FresnelRgb(pixel_f0(paint), 1.0, paint.curve_bits & 0xffffu);
    }
    return FresnelRgb(pixel_f0(paint), f32(paint.curve_bits >> 21u) / 2047.0, paint.curve_bits & 0x7ffu);
}

// Roughness, spread of slopes, the longer alpha and the turn of its axis over half a turn: 16 bits each of the former two, and no more; with
// anisotropy 12 bits of each, the last 16 of which are in y.
fn pixel_lobe_pack(point: SurfacePoint) -> vec2u {
    if !HAS_ANISOTROPY {
        return vec2u(pack2x16unorm(vec2f(point.roughness, point.slope_std)), 0u);
    }
    var turn = 0.0;
    if point.long_alpha > 0.0 {
        turn = atan2(point.long_axis.y, point.long_axis.x) / 3.14159265;
    }
    let all = clamp(vec4f(point.roughness, point.slope_std, point.long_alpha, turn - floor(turn)), vec4f(0.0), vec4f(1.0));
    let bits = vec4u(round(4095.0 * all));
    return vec2u(bits.x | (bits.y << 12u) | ((bits.z & 0xffu) << 24u), (bits.z >> 8u) | (bits.w << 4u));
}

fn pixel_lobe(paint: PixelPaint) -> vec4f {
    if !HAS_ANISOTROPY {
        return vec4f(unpack2x16unorm(paint.lobe), 0.0, 0.0);
    }
    let spare = paint.diffuse.y >> 16u;
    let bits = vec4u(paint.lobe & 0xfffu, (paint.lobe >> 12u) & 0xfffu, (paint.lobe >> 24u) | ((spare & 0xfu) << 8u), spare >> 4u);
    return vec4f(bits) / 4095.0;
}

// Three floats, none below zero. With normals of coats their signs and the last bits of their digits make room: 20 bits each, then the upper 4
// bits of the coat's spread of slopes, whose lower 8 stand beside the coat, then the normal of what is under it.
fn pixel_emission_pack(point: SurfacePoint) -> vec3u {
    // A zero may have a sign.
    let floats = bitcast<vec3u>(abs(point.emission));
    if !HAS_COAT_NORMALS {
        return floats;
    }
    // Rounded.
    let bits = min((floats + 0x400u) >> vec3u(11u), vec3u(0xfefffu));
    return vec3u(bits.x | (bits.y << 20u), (bits.y >> 12u) | (bits.z << 8u) | ((pixel_coat_slope_bits(point) >> 8u) << 28u), point.under_coat);
}

fn pixel_emission(paint: PixelPaint) -> vec3f {
    if !HAS_COAT_NORMALS {
        return bitcast<vec3f>(paint.emission);
    }
    let bits = vec3u(paint.emission.x, (paint.emission.x >> 20u) | (paint.emission.y << 12u), paint.emission.y >> 8u);
    return bitcast<vec3f>((bits & vec3u(0xfffffu)) << vec3u(11u));
}

fn pixel_coat_slope_bits(point: SurfacePoint) -> u32 {
    return u32(round(4095.0 * clamp(point.coat_slope_std, 0.0, 1.0)));
}

fn pixel_coat_slope_std(paint: PixelPaint) -> f32 {
    if !HAS_COAT_NORMALS {
        return 0.0;
    }
    return f32((paint.coat >> 24u) | ((paint.emission.y >> 28u) << 8u)) / 4095.0;
}

// The last 4 bits of the digits of each make room for 12 bits of the metal's share.
fn pixel_f0_pack(point: SurfacePoint) -> vec3u {
    let metallic = u32(round(4095.0 * clamp(point.metallic, 0.0, 1.0)));
    return (bitcast<vec3u>(point.f0) & vec3u(~15u)) | ((vec3u(metallic) >> vec3u(0u, 4u, 8u)) & vec3u(15u));
}

fn pixel_f0(paint: PixelPaint) -> vec3f {
    return bitcast<vec3f>(paint.f0_bits & vec3u(~15u));
}

fn pixel_metallic(paint: PixelPaint) -> f32 {
    let bits = paint.f0_bits & vec3u(15u);
    return f32(bits.x | (bits.y << 4u) | (bits.z << 8u)) / 4095.0;
}

fn pixel_paint_pack(point: SurfacePoint, triangle: u32) -> PixelPaint {
    let lobe = pixel_lobe_pack(point);
    let diffuse = vec2u(pack2x16unorm(point.diffuse.xy), pack2x16unorm(vec2f(point.diffuse.z, 0.0)) | (lobe.y << 16u));
    var coat = point.coat;
    if HAS_COAT_NORMALS {
        coat |= pixel_coat_slope_bits(point) << 24u;
    }
    return PixelPaint(pixel_f0_pack(point), lobe.x, diffuse, coat, triangle, pixel_emission_pack(point), pixel_curve_pack(point));
}

fn pixel_table(pixel: PixelPoint) -> u32 {
    return pixel.table_and_place & 0xffffu;
}

fn pixel_place(pixel: PixelPoint) -> u32 {
    return (pixel.table_and_place >> 16u) & 63u;
}

// Bit of table_and_place: samples of a pixel that see the same surface share scratches; one of them has these for all.
const PIXEL_SHARES: u32 = 0x08000000u;

// Number of parts along each axis of the filter whose mean the base is: in 3 bits; 0 without any. Samples that rays see have none.
fn pixel_parts_bits(along: u32) -> u32 {
    return along << 28u;
}

fn pixel_parts_along(pixel: PixelPoint) -> u32 {
    return extractBits(pixel.table_and_place, 28u, 3u);
}

// The sample that has them lies so many places behind this one.
fn pixel_shared(offset: i32) -> u32 {
    return PIXEL_SHARES | ((bitcast<u32>(offset) & 31u) << 22u);
}

fn pixel_shares(pixel: PixelPoint) -> bool {
    return (pixel.table_and_place & PIXEL_SHARES) != 0u;
}

// Samples of a pixel that share scratches lie so near to one another.
const SHARED_REACH: u32 = 15u;

// The sample that has the scratches of the sample `at`: itself or another one of its pixel.
fn pixel_scratched(pixel: PixelPoint, at: u32) -> u32 {
    return bitcast<u32>(bitcast<i32>(at) + extractBits(bitcast<i32>(pixel.table_and_place), 22u, 5u));
}

// A sample as its scratches are seen: for all through the pixel's whole filter, which is so many times as wide as that of a sample.
fn pixel_as_scratched(pixel: PixelPoint, wider: f32) -> PixelPoint {
    var wide = pixel;
    if pixel_shares(pixel) {
        wide.footprint_um *= wider;
        wide.turns *= wider;
    }
    return wide;
}

fn pixel_wo(cos_o: f32) -> vec3f {
    return vec3f(sqrt(max(1.0 - cos_o * cos_o, 0.0)), 0.0, cos_o);
}

fn surface_point_from(pixel: PixelPoint, paint: PixelPaint) -> SurfacePoint {
    let lobe = pixel_lobe(paint);
    let turn = 3.14159265 * lobe.w;
    let fresnel = pixel_fresnel(paint);
    return SurfacePoint(
        pixel.position_m,
        pixel.axis_x,
        cross(pixel.normal, pixel.axis_x),
        pixel.normal,
        pixel_wo(pixel.cos_o),
        pixel.distance_m,
        pixel.footprint_um.xy,
        pixel.footprint_um.zw,
        pixel.turns.xy,
        pixel.turns.zw,
        pixel.leaves,
        fresnel.at_normal,
        fresnel.at_grazing,
        fresnel.curve,
        vec3f(unpack2x16unorm(paint.diffuse.x), unpack2x16unorm(paint.diffuse.y).x),
        pixel_metallic(paint),
        lobe.x,
        lobe.y,
        pixel_emission(paint),
        pixel.coherence_um,
        pixel_table(pixel),
        pixel_open(paint),
        paint.coat,
        pixel_coat_slope_std(paint),
        paint.emission.z,
        lobe.z,
        vec2f(cos(turn), sin(turn)),
    );
}
