// Pass: from the triangle that a pixel sees to its surface point. One invocation a pixel of the strip and of the rows beside it. In later
// steps, one sample of pixels with edges. Twin: cpu/src/surface.rs.
// Needs: pixel_parts, film, pixel_point, coverage.

@group(3) @binding(0) var visibility: texture_2d<u32>;
@group(3) @binding(1) var<storage, read_write> points: array<PixelPoint>;
@group(3) @binding(2) var<storage, read_write> paints: array<PixelPaint>;
@group(3) @binding(3) var<storage, read> group_starts: array<u32>;
@group(3) @binding(4) var<storage, read_write> film: Film;

@compute @workgroup_size(8, 8)
fn surface(@builtin(global_invocation_id) id: vec3u) {
    if frame.group_count == 0u || id.x >= frame.size_px.x || id.y >= frame.rows.y - frame.rows.x + 2u * frame.halo_rows {
        return;
    }
    // The first rows are those above the strip, which may lie outside the picture.
    let row = i32(id.y + frame.rows.x) - i32(frame.halo_rows);
    var at = id.y * frame.size_px.x + id.x;
    var place = 0u;
    let in_strip = id.y >= frame.halo_rows && u32(max(row, 0)) < frame.rows.y;
    if in_strip {
        place = pixel_tile(vec2u(id.x, u32(row))).y;
    }
    if frame.step > 0u {
        var edge = 0u;
        if in_strip {
            let pixel = vec2u(id.x, u32(row));
            edge = film.pixels[film_index(pixel)].edge;
            at = GROUP * group_starts[pixel_tile(pixel).x] + (max(edge, 1u) - 1u) * frame.samples + frame.sample;
        }
        if edge == 0u {
            return;
        }
    }
    let seen = textureLoad(visibility, id.xy, 0).xy;
    let ray = film_ray_at(vec2f(f32(id.x), f32(row)) + 0.5 + frame.jitter_px);
    if seen.x == 0u {
        var nothing: PixelPoint;
        nothing.normal = normalize(ray);
        points[at] = nothing;
        return;
    }
    var depth_m: f32;
    let point = hit_surface_point(seen.x - 1u, ray, &depth_m);
    points[at] = pixel_point_pack(point, seen.y, depth_m, place);
    if HAS_CUTOUTS && material_at(vertices[3u * (seen.x - 1u)].material & ~VERTEX_BITANGENT_FLIPPED).threshold == ALPHA_IS_SHARE {
        points[at].table_and_place |= PIXEL_PARTIAL;
    }
    if HAS_BUMPS {
        points[at].table_and_place |= pixel_parts_bits(parts_along(point));
    }
    paints[at] = pixel_paint_pack(point, seen.x - 1u);
}
