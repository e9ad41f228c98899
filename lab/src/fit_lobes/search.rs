//! Directions on a grid, and the search for the least of a function.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Sample points along each axis, for GGX and again for the lobe.
pub(super) const SAMPLES: usize = 32;

/// Points of the half square: everything is symmetric in the plane of incidence.
pub(super) fn grid() -> impl Iterator<Item = DVec2> {
    let n = SAMPLES as f64;
    (0..SAMPLES * SAMPLES).map(move |i| {
        DVec2::new(
            0.5 * ((i % SAMPLES) as f64 + 0.5) / n,
            ((i / SAMPLES) as f64 + 0.5) / n,
        )
    })
}

pub(super) fn cosine_direction(u: DVec2) -> DVec3 {
    let (r, phi) = (u.y.sqrt(), 2.0 * PI * u.x);
    DVec3::new(r * phi.cos(), r * phi.sin(), (1.0 - u.y).sqrt())
}

pub(super) fn uniform_direction(u: DVec2) -> DVec3 {
    let z = 1.0 - 2.0 * u.y;
    let (r, phi) = ((1.0 - z * z).sqrt(), 2.0 * PI * u.x);
    DVec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// Minimises `f` from `start` with a simplex of the given `steps`.
pub(super) fn nelder_mead<const N: usize>(
    f: &impl Fn(&[f64; N]) -> f64,
    start: [f64; N],
    steps: [f64; N],
) -> ([f64; N], f64) {
    let mut simplex = vec![(start, f(&start))];
    for i in 0..N {
        let mut x = start;
        x[i] += steps[i];
        simplex.push((x, f(&x)));
    }
    for _ in 0..400 {
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (worst, worst_f) = simplex[N];
        let (best, best_f) = simplex[0];
        let size = (0..N)
            .map(|i| (worst[i] - best[i]).abs())
            .fold(0.0, f64::max);
        if size < 1e-7 {
            break;
        }
        let centroid: [f64; N] =
            std::array::from_fn(|i| simplex[..N].iter().map(|(x, _)| x[i]).sum::<f64>() / N as f64);
        let along = |t: f64| -> ([f64; N], f64) {
            let x = std::array::from_fn(|i| centroid[i] + t * (worst[i] - centroid[i]));
            (x, f(&x))
        };
        let reflected = along(-1.0);
        if reflected.1 < best_f {
            let expanded = along(-2.0);
            simplex[N] = if expanded.1 < reflected.1 {
                expanded
            } else {
                reflected
            };
        } else if reflected.1 < simplex[N - 1].1 {
            simplex[N] = reflected;
        } else {
            let contracted = along(if reflected.1 < worst_f { -0.5 } else { 0.5 });
            if contracted.1 < worst_f.min(reflected.1) {
                simplex[N] = contracted;
            } else {
                for vertex in &mut simplex[1..] {
                    let x = std::array::from_fn(|i| best[i] + 0.5 * (vertex.0[i] - best[i]));
                    *vertex = (x, f(&x));
                }
            }
        }
    }
    simplex
        .into_iter()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .expect("a simplex has vertices")
}
