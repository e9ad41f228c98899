// Pass: finds the samples of a pixel on an edge that see the same surface: one of them has the scratches for all. One invocation a pixel, in
// later steps. Scratches are most of the work, and a pixel without an edge has them once, too. Twin: cpu/src/share_scratches.rs.
// Needs: film, pixel_point.

@group(3) @binding(0) var<storage, read_write> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read> group_starts: array<u32>;
@group(3) @binding(3) var<storage, read_write> film: Film;

// The least cosine between normals that are those of one surface.
const ALIKE_COS: f32 = 0.9994;

fn material_of(at: u32) -> u32 {
    return vertices[3u * paints[at].triangle].material & ~VERTEX_BITANGENT_FLIPPED;
}

fn is_like(a: u32, b: u32) -> bool {
    return points[a].object == points[b].object && material_of(a) == material_of(b) && dot(points[a].normal, points[b].normal) > ALIKE_COS;
}

@compute @workgroup_size(8, 8)
fn share_scratches(@builtin(global_invocation_id) id: vec3u) {
    let pixel = id.xy + vec2u(0u, frame.rows.x);
    if frame.group_count == 0u || pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    let edge = film.pixels[film_index(pixel)].edge;
    if edge == 0u {
        return;
    }
    let first = GROUP * group_starts[pixel_tile(pixel).x] + (edge - 1u) * frame.samples;
    // A bit for each sample that has its scratches.
    var done = 0u;
    for (var place = 0u; place < frame.samples; place += 1u) {
        let leader = (frame.sample_order[place / 8u] >> (4u * (place % 8u))) & 15u;
        if (done & (1u << leader)) != 0u || points[first + leader].object == 0u {
            continue;
        }
        var alike = 1u << leader;
        for (var i = 0u; i < frame.samples; i += 1u) {
            if (done & (1u << i)) == 0u && is_like(first + leader, first + i) {
                alike |= 1u << i;
            }
        }
        done |= alike;
        if countOneBits(alike) > 1u {
            for (var i = 0u; i < frame.samples; i += 1u) {
                if (alike & (1u << i)) != 0u {
                    points[first + i].table_and_place |= pixel_shared(i32(leader) - i32(i));
                }
            }
        }
    }
}
