// The method of 2018, kept to be compared with: a spherical light on the band's middle line. Twin:
// src/sphere.rs, which explains the steps. All vectors are in the scratch's frame.
// Needs: band, published_segments.

fn sphere_segments(wo: vec3f, cap: Cap) -> BandSegments {
    var segments: BandSegments;
    let axis = cap.axis;
    let x = -wo.x;
    let r2 = 1.0 - x * x;

    // 1 Check: below the horizon?
    if r2 <= 0.0 || (cap.cos_radius > 0.0 && axis.z <= -cap.sin_radius) {
        return segments;
    }

    // 2 Project: the rim is an ellipse.
    let extent2 = axis.y * axis.y + axis.z * axis.z;
    let from_centre = x - axis.x * cap.cos_radius;

    // 3 Horizon: the line ends there.
    let r = sqrt(r2);

    // 4 Intersect the ellipse; points of the rim count where they are above the horizon.
    let s2 = extent2 * cap.sin_radius * cap.sin_radius - from_centre * from_centre;
    var up_a = false;
    var up_b = false;
    var y_a = 0.0;
    var y_b = 0.0;
    if s2 > 0.0 {
        let extent2_safe = max(extent2, 1e-24);
        let s = sqrt(s2) / extent2_safe;
        let middle = cap.cos_radius - axis.x * from_centre / extent2_safe;
        y_a = clamp(axis.y * middle - axis.z * s, -r, r);
        y_b = clamp(axis.y * middle + axis.z * s, -r, r);
        up_a = axis.z * middle + axis.y * s >= 0.0;
        up_b = axis.z * middle - axis.y * s >= 0.0;
    }

    // 5 Assemble.
    if up_a && up_b {
        if axis.z >= 0.0 {
            push_segment(&segments, wo.y + y_a, wo.y + y_b);
        } else {
            push_segment(&segments, wo.y - r, wo.y + y_b);
            push_segment(&segments, wo.y + y_a, wo.y + r);
        }
    } else if up_a || up_b {
        let y = select(y_b, y_a, up_a);
        if axis.y > 0.0 {
            push_segment(&segments, wo.y + y, wo.y + r);
        } else {
            push_segment(&segments, wo.y - r, wo.y + y);
        }
    } else if axis.x * x > cap.cos_radius {
        push_segment(&segments, wo.y - r, wo.y + r);
    }
    return segments;
}
