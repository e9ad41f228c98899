//! Scenes of one body that a seed makes, and how far their closed form is from the reference.

use hairline_image::{Layer, Layers};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// Pixels of a block, each way.
const BLOCK: u32 = 3;
/// Neighbours further apart than this share of their depth lie on both sides of an outline.
const OUTLINE_DEPTH: f32 = 0.03;
/// A layer darker than this share of the beauty is not judged.
const LEAST_SHARE: f64 = 0.03;

/// A sequence of numbers in [0, 1): splitmix64.
struct Draw(u64);

impl Draw {
    fn one(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.one()
    }

    /// Evenly in the logarithm.
    fn scale(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.one())
    }

    fn choose<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.one() * choices.len() as f64) as usize]
    }
}

/// The scene file of a seed, so many pixels wide and high.
pub fn scene_file(seed: u64, size_px: [u32; 2]) -> String {
    let mut draw = Draw(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let [x, y, z] = direction(&mut draw, 0.45, 1.25, -PI, 0.0).map(|v| v * 0.28);
    let mut file = format!(
        "[camera]\nposition_m = [{x:.4}, {y:.4}, {z:.4}]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 26.0\n\
         [render]\nsize_px = {size_px:?}\n"
    );
    let may_have_gratings = material(&mut draw, &mut file);
    body(&mut draw, &mut file);
    for _ in 0..draw.choose(&[1, 1, 2]) {
        light(&mut draw, &mut file);
    }
    let marks = draw.one();
    if marks < 0.25 {
        scratches(&mut draw, &mut file);
    } else if marks < 0.4 && may_have_gratings {
        grating(&mut draw, &mut file);
    }
    file
}

/// A unit vector by ranges of the angle from z and of that about it.
fn direction(draw: &mut Draw, least: f64, most: f64, from: f64, to: f64) -> [f64; 3] {
    let (sin, cos) = draw.uniform(least, most).sin_cos();
    let (about_sin, about_cos) = draw.uniform(from, to).sin_cos();
    [sin * about_cos, sin * about_sin, cos]
}

/// Returns whether the material may have gratings.
fn material(draw: &mut Draw, file: &mut String) -> bool {
    let roughness = draw.scale(0.03, 0.6);
    let metal = draw.choose(&["steel", "aluminium", "copper", "gold", "silver", "chromium"]);
    let color = [(); 3].map(|()| (draw.uniform(0.05, 0.9) * 100.0).round() / 100.0);
    let kind = draw.choose(&[
        "metal",
        "brushed",
        "dielectric",
        "mixed",
        "coated",
        "covered",
    ]);
    let keys = match kind {
        "metal" => format!("kind = \"metal\"\nmetal = \"{metal}\""),
        "brushed" => format!(
            "kind = \"metal\"\nmetal = \"{metal}\"\nanisotropy = {:.2}\nanisotropy_direction_deg = {:.0}",
            draw.uniform(0.2, 0.9),
            draw.uniform(0.0, 180.0)
        ),
        "dielectric" => format!(
            "kind = \"dielectric\"\nbase_color = {color:?}\nior = {:.2}",
            draw.uniform(1.3, 1.8)
        ),
        "mixed" => format!(
            "kind = \"metallic-roughness\"\nbase_color = {color:?}\nmetallic = {:.2}",
            draw.one()
        ),
        "coated" => format!(
            "kind = \"metal\"\nbase_color = {color:?}\nclearcoat = 1.0\nclearcoat_roughness = {:.3}",
            draw.scale(0.02, 0.3)
        ),
        _ => format!(
            "kind = \"metal\"\nmetal = \"{metal}\"\ncover = {{ ior = {:.2} }}",
            draw.uniform(1.4, 1.7)
        ),
    };
    let _ = writeln!(
        file,
        "[[material]]\nname = \"m\"\n{keys}\nroughness = {roughness:.4}"
    );
    matches!(kind, "metal" | "covered" | "coated")
}

fn body(draw: &mut Draw, file: &mut String) {
    let shape = draw.choose(&[
        "disk = { radius_m = 0.05 }",
        "plane = { size_m = [0.1, 0.1] }",
        "cylinder = { radius_m = 0.03, height_m = 0.06, rounding_m = 0.004 }",
        "sphere = { radius_m = 0.045 }",
        "torus = { radius_m = 0.035, tube_radius_m = 0.012 }",
        "dome = { radius_m = 0.05, height_m = 0.015 }",
        "box = { size_m = [0.07, 0.05, 0.04], rounding_m = 0.006 }",
    ]);
    let _ = writeln!(
        file,
        "[[object]]\nname = \"o\"\nshape = {{ {shape} }}\nmaterial = \"m\"\nrotation_deg = [{:.1}, {:.1}, {:.1}]",
        draw.uniform(-25.0, 25.0),
        draw.uniform(-25.0, 25.0),
        draw.uniform(0.0, 360.0)
    );
}

fn light(draw: &mut Draw, file: &mut String) {
    let kind = draw.choose(&[
        "sphere",
        "disk",
        "rectangle",
        "strip",
        "polygon",
        "tube",
        "sun",
    ]);
    // More often where its mirror image is.
    let about = if draw.one() < 0.6 {
        [0.3, 2.8]
    } else {
        [-PI, PI]
    };
    let [x, y, z] = direction(draw, 0.1, 1.2, about[0], about[1]);
    if kind == "sun" {
        let [x, y, z] = [x, y, z].map(|v| -v);
        let angle = draw.scale(0.4, 20.0);
        let _ = writeln!(
            file,
            "[[light]]\nkind = \"sun\"\ndirection = [{x:.3}, {y:.3}, {z:.3}]\nirradiance = 3.0\nangle_deg = {angle:.2}"
        );
        return;
    }
    let distance = draw.scale(0.15, 0.9);
    let center = [x, y, z].map(|v| v * distance);
    let [x, y, z] = center;
    let size = draw.scale(0.01, 0.5) * distance;
    let turn = draw.uniform(0.0, TAU);
    let ((turn_sin, turn_cos), turn_deg) = (turn.sin_cos(), turn.to_degrees());
    let thin = size * draw.scale(0.01, 0.2);
    let at = format!("center_m = [{x:.4}, {y:.4}, {z:.4}]\ntarget_m = [0.0, 0.0, 0.0]");
    let keys = match kind {
        "sphere" => {
            let radius = (0.5 * size).min(0.3 * distance);
            format!(
                "kind = \"sphere\"\ncenter_m = [{x:.4}, {y:.4}, {z:.4}]\nradius_m = {radius:.5}"
            )
        }
        "disk" => format!("kind = \"disk\"\n{at}\nradius_m = {:.5}", 0.5 * size),
        "rectangle" => format!(
            "kind = \"rectangle\"\n{at}\nrotation_deg = {turn_deg:.0}\nwidth_m = {size:.5}\nheight_m = {:.5}",
            size * draw.scale(0.2, 1.0)
        ),
        "strip" => format!(
            "kind = \"rectangle\"\n{at}\nrotation_deg = {turn_deg:.0}\nwidth_m = {:.5}\nheight_m = {thin:.5}",
            2.0 * size
        ),
        // A quadrangle or a strip that is turned about the way to it.
        "polygon" => {
            let away = |v: [f64; 3]| v.map(|v| v / distance);
            let [ax, ay, az] = away(center);
            let side = (ax * ax + ay * ay).sqrt().max(1e-9);
            let (u, v) = (
                [-ay / side, ax / side, 0.0],
                [-ax * az / side, -ay * az / side, side],
            );
            let half = [0.5 * size, 0.5 * if draw.one() < 0.5 { thin } else { size }];
            let corner = |[a, b]: [f64; 2]| {
                let (a, b) = (a * half[0], b * half[1]);
                let (a, b) = (turn_cos * a - turn_sin * b, turn_sin * a + turn_cos * b);
                let at: [f64; 3] = std::array::from_fn(|k| center[k] + a * u[k] + b * v[k]);
                format!("[{:.8}, {:.8}, {:.8}]", at[0], at[1], at[2])
            };
            let skew = draw.uniform(-0.4, 0.4);
            let corners = [
                [-1.0, -1.0],
                [1.0, -1.0],
                [1.0 + skew, 1.0],
                [-1.0, 1.0 - skew],
            ]
            .map(corner);
            format!(
                "kind = \"polygon\"\ntwo_sided = true\nvertices_m = [{}]",
                corners.join(", ")
            )
        }
        _ => {
            let end = [turn_cos, turn_sin, draw.uniform(-0.5, 0.5)].map(|v| 0.5 * size * v);
            let at = |sign: f64| {
                let at: [f64; 3] = std::array::from_fn(|k| center[k] + sign * end[k]);
                format!("[{:.4}, {:.4}, {:.4}]", at[0], at[1], at[2])
            };
            format!(
                "kind = \"tube\"\nends_m = [{}, {}]\nradius_m = {thin:.5}",
                at(-1.0),
                at(1.0)
            )
        }
    };
    let _ = writeln!(file, "[[light]]\n{keys}\nradiance = 50.0");
}

fn scratches(draw: &mut Draw, file: &mut String) {
    let _ = writeln!(
        file,
        "[[scratches]]\nobject = \"o\"\npattern = \"{}\"\ncount = {:.0}\nlength_m = {{ mean = 0.01, spread = 0.4 }}\n\
         width_um = {{ mean = {:.2}, spread = 0.2 }}\ndepth_nm = {{ mean = {:.0}, spread = 0.15 }}",
        draw.choose(&["random", "parallel", "circular", "radial"]),
        draw.scale(2e3, 3e4),
        draw.scale(1.0, 6.0),
        draw.uniform(100.0, 300.0)
    );
}

fn grating(draw: &mut Draw, file: &mut String) {
    let pitch = draw.scale(1.2, 20.0);
    let _ = writeln!(
        file,
        "[[grating]]\nobject = \"o\"\npattern = \"{}\"\npitch_um = {pitch:.2}\nwidth_um = {:.3}\ndepth_nm = {:.0}\ntheory = \"scalar\"",
        draw.choose(&["parallel", "circular", "radial"]),
        pitch * draw.uniform(0.3, 0.6),
        draw.uniform(50.0, 200.0)
    );
}

/// How far a layer is from the reference's, away from outlines.
#[derive(Clone, Copy, Debug)]
pub struct LayerDifference {
    /// The layer.
    pub layer: Layer,
    /// Share of the beauty's light that the layer has.
    pub share: f64,
    /// Mean over the reference's, and its standard error.
    pub mean: [f64; 2],
    /// Rms over blocks beyond noise, over the reference's own rms; and that of the noise.
    pub rms: [f64; 2],
}

impl LayerDifference {
    /// How far it is off: 1 where the mean is off by 5 % or the rms by 10 %, beyond two standard errors.
    pub fn severity(&self) -> f64 {
        let mean = ((self.mean[0] - 1.0).abs() - 2.0 * self.mean[1]).max(0.0) / 0.05;
        let rms = (self.rms[0] - self.rms[1]).max(0.0) / 0.1;
        mean.max(rms)
    }
}

/// Judges the layers that have light, by blocks of pixels away from outlines.
///
/// # Panics
/// Where the pictures differ in size, or the reference has no depth or noise.
pub fn judge(found: &Layers, right: &Layers) -> Vec<LayerDifference> {
    assert_eq!(found.size_px, right.size_px);
    let [width, height] = right.size_px;
    let depth = right.get(Layer::Depth).expect("depth");
    let at = |x: u32, y: u32| (y * width + x) as usize;
    // A block with a ring of pixels about it.
    let is_clear = |x: u32, y: u32| {
        let rows = (y - 1)..=(y + BLOCK);
        let mut places = rows.flat_map(|y| ((x - 1)..=(x + BLOCK)).map(move |x| (x, y)));
        places.all(|(x, y)| {
            let here = depth.values[at(x, y)][0];
            let to = |u, v| (depth.values[at(u, v)][0] - here).abs() <= OUTLINE_DEPTH * here;
            here > 0.0 && to(x - u32::from(x > 0), y) && to(x, y - u32::from(y > 0))
        })
    };
    let blocks: Vec<Vec<usize>> = (1..(height - 1) / BLOCK)
        .flat_map(|y| (1..(width - 1) / BLOCK).map(move |x| [x * BLOCK, y * BLOCK]))
        .filter(|[x, y]| is_clear(*x, *y))
        .map(|[x, y]| {
            (0..BLOCK * BLOCK)
                .map(|i| at(x + i % BLOCK, y + i / BLOCK))
                .collect()
        })
        .collect();
    let sum = |layer: Layer| {
        let values = right.estimate(layer).expect("the layer is there").values;
        let of = |i: &usize| values[*i].iter().map(|v| f64::from(*v)).sum::<f64>();
        blocks.iter().flatten().map(of).sum::<f64>()
    };
    let all = sum(Layer::Base) + sum(Layer::Scratches);
    [Layer::Base, Layer::Scratches]
        .into_iter()
        .filter_map(|layer| {
            let (a, b) = (found.estimate(layer)?, right.estimate(layer)?);
            let variance = b.variance.expect("a reference has noise");
            let (mut sums, mut sum_variance) = ([0.0; 2], 0.0);
            let (mut off, mut noise, mut noise2, mut square) = (0.0, 0.0, 0.0, 0.0);
            for block in &blocks {
                let mut spread = 0.0;
                for c in 0..3 {
                    let of = |values: &[[f32; 3]]| {
                        let values = block.iter().map(|i| f64::from(values[*i][c]));
                        values.sum::<f64>() / f64::from(BLOCK * BLOCK)
                    };
                    let (a, b) = (of(a.values), of(b.values));
                    let v = of(variance) / f64::from(BLOCK * BLOCK);
                    sums = [sums[0] + a, sums[1] + b];
                    off += (a - b) * (a - b);
                    noise += v;
                    square += b * b;
                    spread += v.sqrt();
                    noise2 += 2.0 * v * v + 4.0 * v * (a - b) * (a - b);
                }
                sum_variance += spread * spread;
            }
            let share = sum(layer) / all;
            (share > LEAST_SHARE && square > 0.0).then(|| LayerDifference {
                layer,
                share,
                mean: [sums[0] / sums[1], sum_variance.sqrt() / sums[1]],
                rms: [
                    ((off - noise).max(0.0) / square).sqrt(),
                    (2.0 * noise2.sqrt() / square).sqrt(),
                ],
            })
        })
        .collect()
}
