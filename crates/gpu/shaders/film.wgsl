// What the shading pass reads of the visibility pass, and the film that it adds to. Both hold the rows frame.rows alone.

@group(3) @binding(0) var visibility: texture_2d<u32>;
@group(3) @binding(1) var<storage, read_write> film: Film;
// One element where no dispatch leaves a walk.
@group(3) @binding(4) var<storage, read_write> film_walks: array<FilmWalk>;

// The pixel of an invocation: 8 x 8 of them in a workgroup.
fn film_pixel(workgroup: vec2u, workgroups: vec2u, local: vec2u) -> vec2u {
    let i = workgroup.y * workgroups.x + workgroup.x;
    let strided = walk_strided(i, workgroups.x * workgroups.y);
    let tile = vec2u(strided % workgroups.x, strided / workgroups.x);
    return tile * 8u + local + vec2u(0u, frame.rows.x);
}

// Where a pixel lies in the film.
fn film_index(pixel: vec2u) -> u32 {
    return (pixel.y - frame.rows.x) * frame.size_px.x + pixel.x;
}

// The triangle that a pixel sees + 1, or 0, and the object.
fn film_visible(pixel: vec2u) -> vec2u {
    return textureLoad(visibility, vec2u(pixel.x, pixel.y - frame.rows.x), 0).xy;
}

// Adds a sample to its pixel and ends its walk.
fn film_add(pixel: vec2u, value: FilmPixel) {
    let at = film_index(pixel);
    var sum = value;
    // The first sample finds nothing. A loop that goes round once or not at all: of a condition software drivers execute both sides.
    for (var i = 0u; i < min(frame.sample, 1u); i += 1u) {
        let before = film.pixels[at];
        sum.base += before.base;
        sum.depth_m += before.depth_m;
        sum.scratches += before.scratches;
        sum.coverage += before.coverage;
        sum.density += before.density;
        sum.normal += before.normal;
    }
    sum.samples = frame.sample + 1u;
    sum.walk_at = 0u;
    film.pixels[at] = sum;
    film_check_loops();
}

// The same of a sample that sees no object.
fn film_add_background(pixel: vec2u, base: vec3f) {
    let at = film_index(pixel);
    film.pixels[at].base += base;
    film.pixels[at].samples = frame.sample + 1u;
    film.pixels[at].walk_at = 0u;
    film_check_loops();
}

// A software driver silently ends all loops of an invocation after a number of rounds, that of its neighbours counted in.
// A loop that must go round twice tells.
fn film_check_loops() {
    var rounds = 0u;
    for (var i = 0u; i < frame.rows.y + 2u; i += 1u) {
        rounds += 1u;
        if rounds == 2u {
            break;
        }
    }
    if rounds != 2u {
        atomicAdd(&film.gave_up, 1u);
    }
}

// The walk that an earlier dispatch left, or a new one from `first`.
fn film_resume(pixel: vec2u, first: u32) -> ScratchWalk {
    let at = film_index(pixel);
    let walk_at = film.pixels[at].walk_at;
    if walk_at == 0u {
        return ScratchWalk(first, ScratchSums(0.0, 0.0, vec3f(0.0), vec3f(0.0)));
    }
    let kept = film_walks[at];
    let go_on = select(walk_at - 1u, first, walk_at - 1u == WALK_FRESH);
    return ScratchWalk(go_on, ScratchSums(kept.share, kept.share_by_line, kept.radiance, kept.energy));
}

// Leaves a walk for the next dispatch.
fn film_keep(pixel: vec2u, walk: ScratchWalk) {
    let at = film_index(pixel);
    film.pixels[at].walk_at = walk.at + 1u;
    film_walks[at].share = walk.sums.share;
    film_walks[at].share_by_line = walk.sums.share_by_line;
    film_walks[at].radiance = walk.sums.radiance;
    film_walks[at].energy = walk.sums.energy;
    atomicAdd(&film.unfinished, 1u);
    film_check_loops();
}

// How many of a pixel's grids earlier dispatches have gone through, or WALK_BUNDLES_DONE.
fn film_bundled(pixel: vec2u) -> u32 {
    let walk_at = film.pixels[film_index(pixel)].walk_at;
    let at = walk_at - 1u;
    let begun = select(WALK_BUNDLES_DONE, at & ~WALK_BUNDLED, at < WALK_LISTED && at >= WALK_BUNDLED);
    return select(begun, 0u, walk_at == 0u);
}

// Whether single scratches of a pixel are still to be looked at, none having been.
fn film_wants_singles(pixel: vec2u) -> bool {
    let walk_at = film.pixels[film_index(pixel)].walk_at;
    return walk_at == 0u || walk_at - 1u == WALK_FRESH;
}

// Leaves the sums over grids, with those of earlier dispatches, for the walk over single scratches or for the next dispatch.
fn film_keep_bundles(pixel: vec2u, continues: bool, is_done: bool, next: u32, sums: ScratchSums) {
    let at = film_index(pixel);
    var kept = FilmWalk(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    if continues {
        kept = film_walks[at];
    }
    film.pixels[at].walk_at = next + 1u;
    film_walks[at].share = kept.share + sums.share;
    film_walks[at].share_by_line = kept.share_by_line + sums.share_by_line;
    film_walks[at].radiance = kept.radiance + sums.radiance;
    film_walks[at].energy = kept.energy + sums.energy;
    if !is_done {
        atomicAdd(&film.unfinished, 1u);
    }
    film_check_loops();
}
