// Light that a scratch sends to the viewer by the method of 2018: eight wavelengths, the talk's steps, the middle line of the band,
// depths along the normal. Twin: src/cpu/lights.rs.
// Needs: scene, lights, picture_light, segments, band_environment, published_tables, published_spectrum, published_sphere, published_polygon.

// Wavelengths of published_wavelengths. Twin: src/spectrum.rs.
const PUBLISHED_WAVELENGTHS: u32 = 8u;
// Columns of published_wavelengths that hold triangles of lights, beyond the wavelengths. Twin: src/gpu.rs.
const LIGHT_TRIANGLE_COLUMNS: u32 = 64u;

// A segment as seen from the point, in the scratch's frame: micrometres.
struct PublishedView {
    tangent: vec2f,
    start: vec3f,
    end: vec3f,
    wo: vec3f,
    axis_x: vec2f,              // one standard deviation of the pixel's filter to the right
    axis_y: vec2f,              // and down
    width_um: f32,
    depth_nm: f32,
}

fn published_view(point: SurfacePoint, segment: Segment) -> PublishedView {
    let start = surface_from_world(point, segment.start_m - point.position_m) * 1e6;
    let end = surface_from_world(point, segment.end_m - point.position_m) * 1e6;
    let along = end.xy - start.xy;
    let tangent = along * inverseSqrt(max(dot(along, along), 1e-30));
    return PublishedView(
        tangent,
        band_from_surface(tangent, start),
        band_from_surface(tangent, end),
        band_from_surface(tangent, point.wo),
        band_from_surface(tangent, vec3f(point.footprint_x_um, 0.0)).xy,
        band_from_surface(tangent, vec3f(point.footprint_y_um, 0.0)).xy,
        segment.profile.width_um,
        segment.profile.depth_nm,
    );
}

fn published_offset_um(view: PublishedView) -> f32 {
    return 0.5 * (view.start.y + view.end.y);
}

// Vertices of triangle `i` of a polygon, which has two less than vertices; some may be empty.
fn published_triangle(light: Light, i: u32) -> vec3u {
    // The outline of a tube is convex.
    if light.vertex_count == 3u || light_is_tube(light) {
        return vec3u(0u, i + 1u, i + 2u);
    }
    let place = light.first_vertex + i;
    let at = vec2u(PUBLISHED_WAVELENGTHS + place % LIGHT_TRIANGLE_COLUMNS, place / LIGHT_TRIANGLE_COLUMNS);
    return vec3u(textureLoad(published_wavelengths, at, 0).xyz);
}

fn published_wavelength(table: u32, i: u32) -> PublishedWavelength {
    let texel = textureLoad(published_wavelengths, vec2u(i, table), 0);
    return PublishedWavelength(texel.xyz, texel.w);
}

// The radiance of a light towards a point; a picture counts by its mean.
fn published_light_radiance(light: Light, to_m: vec3f) -> vec3f {
    var radiance = light_radiance(light, to_m);
    if HAS_PICTURES && (light.extras & LIGHT_PICTURE) != 0u {
        radiance *= picture_mean(light_picture(light));
    }
    return radiance;
}

// A scratch's light over segments of a line, per unit of its share under a light of radiance 1.
fn published_response(table: u32, segments: BandSegments, width_um: f32, depth_nm: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < PUBLISHED_WAVELENGTHS; i += 2u) {
        sum += published_radiance(published_wavelength(table, i), segments, width_um, depth_nm, PUBLISHED_FAST_SI);
        sum += published_radiance(published_wavelength(table, i + 1u), segments, width_um, depth_nm, PUBLISHED_FAST_SI);
    }
    return sum;
}

// The mean of |D|^2 in each channel.
fn published_total(table: u32, depth_nm: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < PUBLISHED_WAVELENGTHS; i += 1u) {
        let wavelength = published_wavelength(table, i);
        let step = 2.0 * sin(6.28318531e-3 * depth_nm / wavelength.wavelength_um);
        sum += wavelength.weight * (step * step);
    }
    return sum;
}

// Radiance of a scratch by one sphere, per unit of its share and of the light's radiance.
fn published_sphere(point: SurfacePoint, view: PublishedView, light: Light) -> vec3f {
    let cap = cap_turned(view.tangent, light_cap(point, light));
    return published_response(point.table, sphere_segments(view.wo, cap), view.width_um, view.depth_nm);
}

// Radiance of a scratch by one polygon, triangle by triangle, per unit of its share and of the light's radiance.
fn published_polygon(point: SurfacePoint, view: PublishedView, light: Light) -> vec3f {
    let outline = surface_outline(point, light);
    if outline.facing == 0.0 {
        return vec3f(0.0);
    }
    var sum = vec3f(0.0);
    for (var t = 0u; t + 2u < light.vertex_count; t += 1u) {
        let vertices = published_triangle(light, t);
        let clipped = clip_triangle(array<vec3f, 3>(
            outline_corner_m(lights, outline, vertices.x),
            outline_corner_m(lights, outline, vertices.y),
            outline_corner_m(lights, outline, vertices.z),
        ));
        let a = band_from_surface(view.tangent, clipped.corners[0]);
        for (var i = 2u; i < clipped.count; i += 1u) {
            let b = band_from_surface(view.tangent, select(clipped.corners[1], clipped.corners[2], i == 3u));
            let c = band_from_surface(view.tangent, select(clipped.corners[2], clipped.corners[3], i == 3u));
            let segments = triangle_segments(view.wo, a, b, c);
            if segments.count > 0u {
                sum += published_response(point.table, segments, view.width_um, view.depth_nm);
            }
        }
    }
    return sum;
}

// The environment along the band's middle line, cell by cell; the talk has none.
fn published_environment(point: SurfacePoint, view: PublishedView) -> vec3f {
    let line = band_line_at(view.wo, 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ENVIRONMENT_CELLS; i += 1u) {
        let cell = environment_cell(i, line, view.width_um);
        if cell.q_high > cell.q_low {
            var segments: BandSegments;
            push_segment(&segments, cell.q_low, cell.q_high);
            let direction = world_from_surface(point, surface_from_band(view.tangent, cell.direction));
            sum += published_response(point.table, segments, view.width_um, view.depth_nm)
                * scene_prefiltered(direction, environment_cell_roughness(cell));
        }
    }
    return sum;
}
