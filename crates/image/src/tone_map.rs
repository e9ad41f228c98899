//! Tone curves, from linear radiance to the display. Twin: `crates/gpu/shaders/physics/tone_map.wgsl`.
//!
//! * Khronos Group, "Khronos PBR Neutral Tone Mapper", specification, 2024.
//! * Troy Sobotka, "AgX", 2022 (its parametric curve), with the Rec.709 matrices published by Benjamin Wrensch,
//!   "Minimal AgX Implementation", 2023.
//! * ACES 1.0, RRT and ODT for sRGB in the fit by Stephen Hill, 2016 (BakingLab).
//! * Martin Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018 (the dither mask).

crate::listed! {
    /// The curve from linear radiance to the display.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum ToneMap {
        /// Khronos PBR Neutral: colours below 0.76 as they are, highlights rolled off and desaturated.
        #[default]
        Neutral = "neutral";
        /// AgX with its default look: a wide range, highlights that fade to white.
        Agx = "agx";
        /// The ACES filmic curve in Stephen Hill's fit: strong contrast.
        Aces = "aces";
        /// No curve: clamped to the display's range.
        None = "none";
    }
    /// The name in scene files.
    fn name;
}

impl ToneMap {
    /// Number of the curve in shaders.
    pub fn shader_index(self) -> u32 {
        self as u32
    }
}

/// Settings that make a picture on a display of linear radiance.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Display {
    /// Radiances are multiplied by 2^exposure_ev first.
    pub exposure_ev: f64,
    /// Then this curve.
    pub tone_map: ToneMap,
}

impl Display {
    /// Linear Rec.709 radiance to sRGB-encoded values in [0, 1].
    pub fn apply(&self, radiance: [f32; 3]) -> [f32; 3] {
        let gain = self.exposure_ev.exp2() as f32;
        tone_map(self.tone_map, radiance.map(|c| c * gain)).map(srgb_from_linear)
    }

    /// Whether the eye notices one radiance in the place of another: they differ by 5 of 255 or more in a channel.
    pub fn is_noticed(&self, one: [f32; 3], other: [f32; 3]) -> bool {
        let (one, other) = (self.apply(one), self.apply(other));
        (0..3).any(|c| 255.0 * (one[c] - other[c]).abs() >= NOTICED)
    }
}

/// See [`Display::is_noticed`].
const NOTICED: f32 = 5.0;

/// The largest radiance that the curves see: they are all flat by far, and its square is still finite.
const TONE_RADIANCE_MAX: f32 = 1e9;

/// Exposed linear Rec.709 radiance to linear Rec.709 on a display, each component in [0, 1]. Total: NaN counts as 0,
/// infinity as a very bright light.
pub fn tone_map(curve: ToneMap, rgb: [f32; 3]) -> [f32; 3] {
    let inside = tone_into_gamut(rgb.map(tone_sanitize));
    let mapped = match curve {
        ToneMap::Neutral => tone_neutral(inside),
        ToneMap::Agx => tone_agx(inside),
        ToneMap::Aces => tone_aces(inside),
        ToneMap::None => inside,
    };
    mapped.map(|c| c.clamp(0.0, 1.0))
}

/// Replaces NaN, and bounds values that are too large.
pub fn tone_sanitize(c: f32) -> f32 {
    if c.is_nan() {
        0.0
    } else {
        c.clamp(-TONE_RADIANCE_MAX, TONE_RADIANCE_MAX)
    }
}

/// Rec.709 luminance.
pub fn tone_luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// Colours purer than the display's primaries have negative components, as spectral colours do. They are mixed with
/// the grey of their own luminance until no component is negative: luminance and hue (in this linear space) stay, where
/// clipping would brighten the colour and turn its hue towards a primary. Black if the luminance itself is not positive.
pub fn tone_into_gamut(rgb: [f32; 3]) -> [f32; 3] {
    let lowest = rgb[0].min(rgb[1]).min(rgb[2]);
    if lowest >= 0.0 {
        return rgb;
    }
    let luminance = tone_luminance(rgb);
    if luminance <= 0.0 {
        return [0.0; 3];
    }
    let keep = luminance / (luminance - lowest);
    // The lowest becomes exactly zero.
    rgb.map(|c| keep * (c - lowest))
}

/// Khronos PBR Neutral. Takes the 4 % that a dielectric's surface reflects off the base colour, so that base colours
/// show as they were chosen, then compresses peaks above 0.8 - 0.04.
pub fn tone_neutral(rgb: [f32; 3]) -> [f32; 3] {
    const F90: f32 = 0.04;
    const COMPRESSION_START: f32 = 0.8 - F90;
    const DESATURATION: f32 = 0.15;
    let lowest = rgb[0].min(rgb[1]).min(rgb[2]);
    let offset = if lowest < 2.0 * F90 {
        lowest - lowest * lowest / (4.0 * F90)
    } else {
        F90
    };
    let color = rgb.map(|c| c - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < COMPRESSION_START {
        return color;
    }
    let headroom = 1.0 - COMPRESSION_START;
    let new_peak = 1.0 - headroom * headroom / (peak + headroom - COMPRESSION_START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    color.map(|c| {
        let compressed = c * (new_peak / peak);
        compressed + (new_peak - compressed) * white
    })
}

/// AgX, default look: inset of the primaries, logarithm, sigmoid, and the inset undone.
pub(crate) fn tone_agx(rgb: [f32; 3]) -> [f32; 3] {
    // Ten stops below middle grey (0.18) and six and a half above.
    const STOPS_MIN: f32 = -12.473_931;
    const STOPS_MAX: f32 = 4.026_069;
    let inset = tone_transform(&AGX_INSET, rgb);
    let encoded = inset.map(|c| {
        let stops = c.max(1e-10).log2().clamp(STOPS_MIN, STOPS_MAX);
        tone_agx_curve((stops - STOPS_MIN) / (STOPS_MAX - STOPS_MIN))
    });
    // The sigmoid's result is meant for a display of gamma 2.2.
    tone_transform(&AGX_OUTSET, encoded.map(|c| c.max(0.0).powf(2.2)))
}

/// AgX's sigmoid from [0, 1] to [0, 1]: slope 2 through middle grey at (10 / 16.5, 0.5), a toe of power 3 and a shoulder
/// of power 3.25, each a scaled t / (1 + t^p)^(1/p) whose scale makes it end at 0 or 1.
pub fn tone_agx_curve(x: f32) -> f32 {
    const PIVOT: [f32; 2] = [10.0 / 16.5, 0.5];
    const SLOPE: f32 = 2.0;
    if x < PIVOT[0] {
        PIVOT[1] - tone_agx_branch(PIVOT[0] - x, PIVOT[0], PIVOT[1], SLOPE, 3.0)
    } else {
        PIVOT[1] + tone_agx_branch(x - PIVOT[0], 1.0 - PIVOT[0], 1.0 - PIVOT[1], SLOPE, 3.25)
    }
}

/// One side of the sigmoid, from the pivot outwards: 0 at `x` = 0 with the slope given, `height` at `x` = `width`.
pub(crate) fn tone_agx_branch(x: f32, width: f32, height: f32, slope: f32, power: f32) -> f32 {
    // s t / (1 + t^p)^(1/p) = height at t = slope width / s, solved for the scale s.
    let t_end = ((slope * width / height).powf(power) - 1.0).powf(1.0 / power);
    let scale = slope * width / t_end;
    let t = slope * x / scale;
    scale * t / (1.0 + t.powf(power)).powf(1.0 / power)
}

/// Rows; into AgX's inset primaries.
const AGX_INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_655, 0.078_433_6, 0.879_143],
];

/// Rows; the inverse of [`AGX_INSET`].
const AGX_OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_75],
    [-0.052_896_85, 1.151_903_1, -0.098_961_18],
    [-0.052_971_635, -0.098_043_45, 1.151_073_7],
];

/// ACES in Hill's fit.
pub(crate) fn tone_aces(rgb: [f32; 3]) -> [f32; 3] {
    let fitted = tone_transform(&ACES_FROM_REC709, rgb).map(|c| {
        let c = c.max(0.0);
        (c * (c + 0.024_578_6) - 0.000_090_537) / (c * (0.983_729 * c + 0.432_951) + 0.238_081)
    });
    tone_transform(&REC709_FROM_ACES, fitted)
}

/// Rows; Rec.709 to AP1 with the RRT's saturation.
const ACES_FROM_REC709: [[f32; 3]; 3] = [
    [0.597_19, 0.354_58, 0.048_23],
    [0.076_00, 0.908_34, 0.015_66],
    [0.028_40, 0.133_83, 0.837_77],
];

/// Rows; the ODT's saturation and AP1 to Rec.709.
const REC709_FROM_ACES: [[f32; 3]; 3] = [
    [1.604_75, -0.531_08, -0.073_67],
    [-0.102_08, 1.108_13, -0.006_05],
    [-0.003_27, -0.072_76, 1.076_02],
];

fn tone_transform(rows: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The sRGB transfer function (IEC 61966-2-1) of a value in [0, 1].
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// The inverse of [`srgb_from_linear`].
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// Ordered dither in (-0.5, 0.5): an R2 sequence over the pixels, the same for every picture. Dark gradients (a plate
/// that fades into its surroundings) band visibly in 8 bits without it; a colour that has an exact code keeps it.
pub fn dither_offset(x: u32, y: u32) -> f32 {
    // 2^32 / g and 2^32 / g^2 with the plastic number g = 1.32471795..., the root of g^3 = g + 1.
    let n = x
        .wrapping_mul(3_242_174_889)
        .wrapping_add(y.wrapping_mul(2_447_445_414));
    // 23 bits, so that the largest value stays below 1 in f32.
    ((n >> 9) as f32 + 0.5) / 8_388_608.0 - 0.5
}

/// The 8-bit code of an encoded value in [0, 1].
pub fn display_code(encoded: f32, dither: f32) -> u8 {
    // A hair less than half a step either way: an exact code stays what it is.
    (encoded * 255.0 + 0.996 * dither).round().clamp(0.0, 255.0) as u8
}
