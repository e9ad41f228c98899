// The method of 2018, kept to be compared with: a scratch's light, wavelength by wavelength. Twin:
// src/spectrum.rs. `fast` chooses the approximated sine integral.
// Needs: published_segments, published_sine_integral.

// A part of the visible: its weight in the three channels, and the wavelength that stands for it.
struct PublishedWavelength {
    weight: vec3f,
    wavelength_um: f32,
}

// The integral of sinc^2(k W q'/2) over q' from 0 to q. One sine and one cosine, of half the angle, serve both terms.
fn published_chord_integral(q: f32, width_um: f32, wavelength_um: f32, fast: bool) -> f32 {
    let k_w = 6.28318531 * width_um / wavelength_um;
    let x = min(k_w * abs(q), SINE_INTEGRAL_X_MAX);
    // Below this the two terms cancel.
    if x < 1e-2 {
        return q * (1.0 - x * x / 36.0);
    }
    let s = sin(0.5 * x);
    let c = cos(0.5 * x);
    var si: f32;
    if fast {
        si = sine_integral_fast_of(x, 2.0 * s * c, 1.0 - 2.0 * s * s);
    } else {
        si = sine_integral_of(x, 2.0 * s * c, 1.0 - 2.0 * s * s);
    }
    return sign(q) * (2.0 * si - 4.0 * s * s / x) / k_w;
}

fn published_chord(ends: vec2f, width_um: f32, wavelength_um: f32, fast: bool) -> f32 {
    return published_chord_integral(ends.y, width_um, wavelength_um, fast)
        - published_chord_integral(ends.x, width_um, wavelength_um, fast);
}

// Contribution of one wavelength to the channels per unit of the scratch's share, under a light of radiance 1, Fresnel
// left out.
fn published_radiance(
    wavelength: PublishedWavelength,
    segments: BandSegments,
    width_um: f32,
    depth_nm: f32,
    fast: bool,
) -> vec3f {
    let lambda_um = wavelength.wavelength_um;
    // No loop: software drivers end long ones, and this is the innermost.
    var chords = 0.0;
    if segments.count > 0u {
        chords += published_chord(segments.ends[0], width_um, lambda_um, fast);
    }
    if segments.count > 1u {
        chords += published_chord(segments.ends[1], width_um, lambda_um, fast);
    }
    if segments.count > 2u {
        chords += published_chord(segments.ends[2], width_um, lambda_um, fast);
    }
    // |D|^2 is the square of this.
    let step = 2.0 * sin(6.28318531e-3 * depth_nm / lambda_um);
    return wavelength.weight * (step * step * width_um / lambda_um * chords);
}
