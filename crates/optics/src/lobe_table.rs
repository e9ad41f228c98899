//! The fitted tables behind the area-light lobes, committed under `data/` and made again by `cargo lab fit-lobes`.
//!
//! All tables share one grid: roughness in equal steps along the rows, the square root of the viewer's cosine in equal
//! steps along the columns. The square root resolves grazing views, where everything changes within cos ~ alpha.
//! Each node holds four f32 (an rgba32float texel); the last channel is spare.

use std::sync::LazyLock;

use crate::ggx::{ggx_alpha, ggx_quadrature, unit_clamp};

/// Nodes along each axis.
pub const LOBE_TABLE_SIZE: usize = 32;

/// Nodes of a [`crate::fresnel::FresnelCurve`].
pub const FRESNEL_NODES: usize = 128;

/// Look-ups of an environment for a lobe: [`crate::environment_lobe`].
pub const ENVIRONMENT_TAPS: usize = 6;

/// The smallest viewer cosine that lobes are made for. A viewer at or below the horizon (it happens with interpolated
/// normals) gets the lobe of this one.
pub const LOBE_MIN_COS: f64 = 1e-3;

/// A table over (roughness, viewer's cosine), four channels a node.
#[derive(Clone, Debug)]
pub struct LobeTable {
    texels: Vec<[f32; 4]>,
}

impl LobeTable {
    /// A table from its nodes, row by row (a row has one roughness).
    ///
    /// # Panics
    /// If the count is not [`LOBE_TABLE_SIZE`] squared.
    pub fn new(texels: Vec<[f32; 4]>) -> Self {
        assert_eq!(texels.len(), LOBE_TABLE_SIZE * LOBE_TABLE_SIZE);
        Self { texels }
    }

    /// A table from the bytes of [`Self::to_bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Self {
        let (texels, _) = bytes.as_chunks::<16>();
        let channel = |texel: &[u8; 16], i: usize| {
            f32::from_le_bytes([
                texel[4 * i],
                texel[4 * i + 1],
                texel[4 * i + 2],
                texel[4 * i + 3],
            ])
        };
        Self::new(
            texels
                .iter()
                .map(|t| std::array::from_fn(|i| channel(t, i)))
                .collect(),
        )
    }

    /// The file's bytes: little-endian f32, row by row.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.texels
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes())
            .collect()
    }

    /// The nodes, row by row, as texels of a [`LOBE_TABLE_SIZE`]-square rgba32float texture.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// Bilinear look-up; both arguments are clamped to [0, 1].
    pub fn lookup(&self, roughness: f64, cos_o: f64) -> [f64; 4] {
        let last = (LOBE_TABLE_SIZE - 1) as f64;
        let x = unit_clamp(cos_o).sqrt() * last;
        let y = unit_clamp(roughness) * last;
        // Neither coordinate is negative, so truncation rounds down.
        let [x0, y0] = [x, y].map(|at| (at as usize).min(LOBE_TABLE_SIZE - 2));
        let (fx, fy) = (x - x0 as f64, y - y0 as f64);
        let node = |dx: usize, dy: usize| self.texels[(y0 + dy) * LOBE_TABLE_SIZE + x0 + dx];
        let (n00, n10, n01, n11) = (node(0, 0), node(1, 0), node(0, 1), node(1, 1));
        std::array::from_fn(|c| {
            let low = f64::from(n00[c]) + fx * f64::from(n10[c] - n00[c]);
            let high = f64::from(n01[c]) + fx * f64::from(n11[c] - n01[c]);
            low + fy * (high - low)
        })
    }
}

/// (roughness, viewer's cosine) of a node.
pub fn lobe_table_node(row: usize, column: usize) -> (f64, f64) {
    let last = (LOBE_TABLE_SIZE - 1) as f64;
    let s = column as f64 / last;
    (row as f64 / last, s * s)
}

/// Directional albedo E0 of GGX, see [`crate::ggx::ggx_albedo`].
pub fn albedo_table() -> &'static LobeTable {
    static TABLE: LazyLock<LobeTable> =
        LazyLock::new(|| LobeTable::from_bytes(include_bytes!("../data/lobe_albedo.bin")));
    &TABLE
}

/// Shape of the linearly transformed cosine: (width_x, width_y, lean), see [`crate::ltc::LtcShape`].
pub fn ltc_table() -> &'static LobeTable {
    static TABLE: LazyLock<LobeTable> =
        LazyLock::new(|| LobeTable::from_bytes(include_bytes!("../data/lobe_ltc.bin")));
    &TABLE
}

/// Look-up `i` of an environment: (slope from the mirror direction over alpha, alpha over that of the surface, share, share of the lobe times
/// a dielectric's weight), see [`crate::environment_lobe`].
pub fn environment_table(i: usize) -> &'static LobeTable {
    static TABLES: LazyLock<[LobeTable; ENVIRONMENT_TAPS]> = LazyLock::new(|| {
        let bytes = include_bytes!("../data/lobe_environment.bin");
        let (tables, _) = bytes.as_chunks::<{ 16 * LOBE_TABLE_SIZE * LOBE_TABLE_SIZE }>();
        std::array::from_fn(|i| LobeTable::from_bytes(&tables[i]))
    });
    &TABLES[i]
}

/// The mean slope of the look-ups of an environment by their shares, over alpha, in the first channel.
pub(crate) fn environment_middle_table() -> &'static LobeTable {
    static TABLE: LazyLock<LobeTable> = LazyLock::new(|| {
        let middle = |node: usize| {
            let taps = (0..ENVIRONMENT_TAPS).map(|i| environment_table(i).texels()[node]);
            let (sum, shares) = taps.fold((0.0, 0.0), |(sum, shares), [slope, _, share, _]| {
                (sum + slope * share, shares + share)
            });
            [sum / shares, 0.0, 0.0, 0.0]
        };
        LobeTable::new((0..LOBE_TABLE_SIZE * LOBE_TABLE_SIZE).map(middle).collect())
    });
    &TABLE
}

/// Texels of all tables of lobes in one texture that is [`LOBE_TABLE_SIZE`] wide: from the top [`ltc_table`], each [`environment_table`] and
/// `environment_middle_table`.
pub fn shape_texels() -> &'static [[f32; 4]] {
    static TEXELS: LazyLock<Vec<[f32; 4]>> = LazyLock::new(|| {
        let looked_up = (0..ENVIRONMENT_TAPS).map(environment_table);
        std::iter::once(ltc_table())
            .chain(looked_up)
            .chain([environment_middle_table()])
            .flat_map(|table| table.texels())
            .copied()
            .collect()
    });
    &TEXELS
}

/// Directional albedo E0 by table.
pub fn albedo_lookup(roughness: f64, cos_o: f64) -> f64 {
    albedo_table().lookup(roughness, cos_o)[0]
}

/// Points along each axis of the quadrature behind [`mean_over_lobes`].
const MEAN_STEPS: usize = 32;

/// Share of the lobe at each node of a [`crate::fresnel::FresnelCurve`], for each node of the grid.
static SHARES: LazyLock<Vec<[f32; FRESNEL_NODES]>> = LazyLock::new(|| {
    let last = (FRESNEL_NODES - 1) as f64;
    let node = |i: usize| {
        let (roughness, cos_o) = lobe_table_node(i / LOBE_TABLE_SIZE, i % LOBE_TABLE_SIZE);
        let mut shares = [0.0_f64; FRESNEL_NODES];
        let visit = |cos_h: f64, weight: f64| {
            let at = unit_clamp(cos_h).sqrt() * last;
            let i = (at as usize).min(FRESNEL_NODES - 2);
            let high = at - i as f64;
            shares[i] += weight * (1.0 - high);
            shares[i + 1] += weight * high;
        };
        ggx_quadrature(
            cos_o.max(LOBE_MIN_COS),
            ggx_alpha(roughness),
            MEAN_STEPS,
            visit,
        );
        let sum: f64 = shares.iter().sum();
        shares.map(|share| (share / sum) as f32)
    };
    (0..LOBE_TABLE_SIZE * LOBE_TABLE_SIZE).map(node).collect()
});

/// The integrals of GGX times functions that are linear between the nodes of a [`crate::fresnel::FresnelCurve`].
pub(crate) fn mean_over_lobes(nodes: &[[f32; 4]]) -> LobeTable {
    let albedo = albedo_table().texels();
    let means = SHARES.iter().zip(albedo).map(|(shares, [e0, ..])| {
        let mut mean = [0.0; 4];
        for (share, value) in shares.iter().zip(nodes) {
            for k in 0..4 {
                mean[k] += share * value[k];
            }
        }
        mean.map(|m| m * e0)
    });
    LobeTable::new(means.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fresnel::fresnel_node_cos;

    #[test]
    fn shares_lie_where_cosines_are() {
        // The light of a mirror is all at the viewer's own angle.
        for column in [4, 12, 31] {
            let (_, cos_o) = lobe_table_node(0, column);
            let mean: f64 = (0..FRESNEL_NODES)
                .map(|i| f64::from(SHARES[column][i]) * fresnel_node_cos(i))
                .sum();
            assert!((mean - cos_o).abs() < 2e-3, "{mean} {cos_o}");
        }
    }
}
