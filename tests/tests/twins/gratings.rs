//! Rows of grooves: their directions under a pixel, the width of their band, and their light from all around.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::call::{Table, Texels};
use hairline_gpu::shaders;
use hairline_optics::band::{BandFrame, BandLine, BandMotion, band_moves, band_stds};
use hairline_optics::band_environment::row_cells;
use hairline_optics::grating::{
    GRATING_DEPTH_NM, GRATING_WIDTH_UM, Grating as Row, IncidenceRow, RigorousGrating,
};
use hairline_optics::metal::Metal;
use hairline_optics::rigorous::{Efficiencies, FineGrooves, Medium};
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::spectrum::Observer;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};
use hairline_scene::{Bearing, Grating, GrooveField, GrooveGround, Mesh};
use std::sync::LazyLock;

const ROW: Row = Row {
    pitch_um: 1.6,
    width_um: 0.6,
    depth_nm: 110.0,
    depth_spread: 0.1,
    jitter_um: 0.05,
};

static TABLE: LazyLock<ScratchTable> = LazyLock::new(|| ROW.table(20.0, |_| 1.0));

static NO_MESH: LazyLock<Mesh> = LazyLock::new(Mesh::default);

/// A ground for fields that do not use texture coordinates.
static NOWHERE: LazyLock<GrooveGround> = LazyLock::new(|| GrooveGround {
    textures: &[],
    mesh: &NO_MESH,
    triangle: 0,
});

fn v(x: &[f64]) -> DVec3 {
    DVec3::new(x[0], x[1], x[2])
}

/// Distance of neighbouring spots.
const SPACING_M: f64 = 0.01;

/// The kinds as gratings.wgsl counts them; then spots, in rows across the normal.
fn field(kind: f64, axis: DVec3, normal: DVec3) -> GrooveField {
    let center_m = DVec3::ZERO;
    let around = |bearing| GrooveField::Around {
        axis,
        center_m,
        bearing,
    };
    match kind {
        0.0 => GrooveField::Along {
            direction: axis,
            center_m,
        },
        1.0 => around(Bearing::Circular),
        2.0 => around(Bearing::Radial),
        3.0 => around(Bearing::Spun {
            curvature_per_m: 1.0,
        }),
        _ => GrooveField::Spots {
            axis,
            center_m,
            along_row: axis.cross(normal).normalize(),
            spacing_m: SPACING_M,
        },
    }
}

#[test]
fn grooves_under_pixels() {
    let mut random = Sequence(3);
    let rows: Vec<[f32; 16]> = (0..8000)
        .map(|i| {
            let mut row = [0.0; 16];
            row[0] = (i % 5) as f32;
            let normal = random.direction(-1.0);
            row[1..4].copy_from_slice(&random.direction(-1.0));
            row[4..7].copy_from_slice(&normal);
            // Distances from the axis of a hundredth of a millimetre to a metre; pixels up to a tenth as
            // wide.
            let reach_m = 10f32.powf(random.uniform(-5.0, 0.0));
            row[7..10].copy_from_slice(&random.direction(-1.0).map(|x| x * reach_m));
            for at in [10, 13] {
                let step = DVec3::from(random.direction(-1.0).map(f64::from));
                let normal = DVec3::from(normal.map(f64::from));
                let across = step - normal * normal.dot(step);
                let size = f64::from(reach_m) * 10f64.powf(f64::from(random.uniform(-4.0, -1.0)));
                row[at..at + 3].copy_from_slice(&(across * size).as_vec3().to_array());
            }
            row
        })
        // Next to where a field ends, rounding decides.
        .filter(|row| {
            let [axis, normal, arm] = [1, 4, 7].map(|at| v(&row.map(f64::from)[at..]));
            axis.cross(normal).length() > 0.05
                && (axis.cross(arm)).cross(normal).length() > 0.05 * arm.length()
        })
        .collect();
    Twin {
        name: "groove_place",
        modules: &[&shaders::GRATINGS],
        snippet: "let is_spots = x[0] > 3.0;
            let along_row = normalize(cross(vec3f(x[1], x[2], x[3]), vec3f(x[4], x[5], x[6])));
            let grating = Grating(vec3f(x[1], x[2], x[3]), select(u32(x[0]), GROOVES_CIRCULAR, is_spots), vec3f(0.0), 1.0, vec2f(1e-3, 0.1), 0.7, 0.0, 0u, 0u, 0u, 1.6, 0.6, 0.0, 1.0, 0u, vec4f(0.0), vec4f(0.0), vec4f(0.0), vec2u(0u), vec2u(0u), along_row, select(0.0, 0.01, is_spots));
            let normal = vec3f(x[4], x[5], x[6]);
            let place = groove_place(grating, groove_course_straight(grating), vec3f(x[7], x[8], x[9]), normal, vec3f(x[10], x[11], x[12]), vec3f(x[13], x[14], x[15]));
            let is_seen = f32(place.share > 1e-3);
            y[0] = is_seen * place.tangent.x; y[1] = is_seen * place.tangent.y; y[2] = is_seen * place.tangent.z;
            y[3] = is_seen * place.turns_rad.x; y[4] = is_seen * place.turns_rad.y; y[5] = is_seen * place.share;
            y[6] = is_seen * place.mixed;
            let is_mixed = is_seen * f32(place.mixed > 0.0);
            let way = groove_way(grating, place, normal, 2u);
            y[7] = is_mixed * way.tangent.x; y[8] = is_mixed * way.tangent.y; y[9] = is_mixed * way.tangent.z;
            y[10] = is_mixed * way.share; y[11] = is_mixed * way.angle_std_rad;
            let across = groove_across(grating, place, normal, 100.0 * vec3f(x[10], x[11], x[12]));
            y[12] = is_mixed * across.tangent.x; y[13] = is_mixed * across.tangent.y; y[14] = is_mixed * across.tangent.z;
            y[15] = is_mixed * across.share; y[16] = is_mixed * across.angle_std_rad;",
        tables: &[],
        expected: &|x: [f64; 16]| {
            let grating = Grating {
                row: ROW,
                field: field(x[0], v(&x[1..]), v(&x[4..])),
                angle_std_rad: 0.0,
                coverage: 0.7,
                radii_m: [1e-3, 0.1],
                mask: None,
                seed: 1,
                is_rigorous: true,
            };
            let axes_m = [v(&x[10..]), v(&x[13..])];
            let seen = grating.seen_from_pixel(&NOWHERE, v(&x[7..]), v(&x[4..]), axes_m);
            let seen = seen.filter(|it| it.share > 1e-3);
            seen.map_or([0.0; 17], |place| {
                let [right, down] = place.turns_rad;
                let mut row = [place.tangent.x, place.tangent.y, place.tangent.z, right, down, place.share].to_vec();
                row.push(place.mixed);
                let way = grating.all_ways(place, v(&x[4..])).nth(2);
                let across = grating.across(place, v(&x[4..]), v(&x[10..]) * 100.0);
                for seen in [way, across] {
                    let [x, y, z] = seen.map_or([0.0; 3], |it| it.tangent.to_array());
                    let [share, std_rad] = seen.map_or([0.0; 2], |it| [it.share, it.angle_std_rad]);
                    row.extend([x, y, z, share, std_rad]);
                }
                row.try_into().expect("as many as above")
            })
        },
        tolerance: Tolerance {
            absolute: 2e-5,
            relative: 1e-3,
        },
    }
    // Rounding of the place counts where grooves end within a pixel.
    .check(&rows, rows.len() / 500);
}

#[test]
fn single_grooves() {
    let mut random = Sequence(9);
    let rows: Vec<[f32; 16]> = (0..8000)
        .map(|i| {
            let mut row = [0.0; 16];
            row[0] = (i % 5) as f32;
            let normal = random.direction(-1.0);
            row[1..4].copy_from_slice(&random.direction(-1.0));
            row[4..7].copy_from_slice(&normal);
            // Up to a tenth of a metre from the axis.
            let reach_m = random.uniform(1e-3, 0.1);
            row[7..10].copy_from_slice(&random.direction(-1.0).map(|x| x * reach_m));
            row[10] = random.uniform(8.0, 50.0);
            row[11] = row[10] * random.uniform(0.02, 0.6);
            row[12] = random.uniform(0.0, 0.3);
            // Pixel and window.
            row[13] = row[10] * random.uniform(0.0, 1.0);
            row[14] = row[10] * random.uniform(0.2, 1.2);
            row[15] = random.uniform(0.0, 1e4).floor();
            row
        })
        // Next to where a field ends, and between two cuts, rounding decides.
        .filter(|row| {
            let x = row.map(f64::from);
            let field = spun(field(x[0], v(&x[1..]), v(&x[4..])));
            let tangent = field.tangent(&NOWHERE, v(&x[7..]), v(&x[4..]));
            tangent.is_some_and(|tangent| {
                let at = |turn: f64| {
                    let turned = (tangent.cross(v(&x[4..])) + turn * v(&x[4..])).normalize();
                    let normal = turned.cross(tangent);
                    single(&x)
                        .grooves_at(&NOWHERE, v(&x[7..]), normal, tangent)
                        .map(|at| at.number)
                };
                let is_told = (1.0 < x[0] && x[0] < 4.0) || at(1e-5) == at(-1e-5);
                is_told && v(&x[1..]).cross(v(&x[4..])).length() > 0.05
            })
        })
        .collect();
    assert!(rows.len() > 6000, "{}", rows.len());
    Twin {
        name: "groove_density",
        modules: &[&shaders::SINGLE_GROOVES],
        snippet: "let is_spots = x[0] > 3.0;
            let along_row = normalize(cross(vec3f(x[1], x[2], x[3]), vec3f(x[4], x[5], x[6])));
            let grating = Grating(vec3f(x[1], x[2], x[3]), select(u32(x[0]), GROOVES_CIRCULAR, is_spots), vec3f(0.0), select(0.0, 15.0, x[0] == 3.0), vec2f(0.0), 1.0, 0.0, 0u, 0u, u32(x[15]), x[10], x[11], x[12], 100.0, 0u, vec4f(0.0), vec4f(0.0), vec4f(0.0), vec2u(0u), vec2u(0u), along_row, select(0.0, 0.01, is_spots));
            let normal = vec3f(x[4], x[5], x[6]);
            let course = groove_course_straight(grating);
            let arm_m = groove_arm(grating, vec3f(x[7], x[8], x[9]));
            let tangent = groove_tangent(groove_field(grating), course.here, arm_m, normal);
            y[0] = groove_density(grating, course, arm_m, normal, tangent, cross(normal, tangent) * x[13] * 1e-6, vec3f(0.0), x[14]);",
        tables: &[],
        expected: &|x: [f64; 16]| {
            let grating = single(&x);
            let (point_m, normal) = (v(&x[7..]), v(&x[4..]));
            let tangent = grating.field.tangent(&NOWHERE, point_m, normal).unwrap();
            let axes_m = [normal.cross(tangent) * x[13] * 1e-6, DVec3::ZERO];
            [grating.groove_density(&NOWHERE, point_m, normal, tangent, axes_m, x[14])]
        },
        // Places are rounded to a hundredth of a micrometre.
        tolerance: Tolerance {
            absolute: 5e-3,
            relative: 5e-3,
        },
    }
    // The terms that turn grooves cancel where the surface stands so that grooves neither converge nor
    // diverge.
    .check(&rows, rows.len() / 2000);
}

/// A grating so shallow that its grooves may be as dense as they are.
fn single(x: &[f64; 16]) -> Grating {
    Grating {
        row: Row {
            pitch_um: x[10],
            width_um: x[11],
            depth_nm: 1.0,
            depth_spread: 0.0,
            jitter_um: x[12] * x[10],
        },
        field: spun(field(x[0], v(&x[1..]), v(&x[4..]))),
        angle_std_rad: 0.0,
        coverage: 1.0,
        radii_m: [0.0, f64::INFINITY],
        mask: None,
        seed: x[15] as u32,
        is_rigorous: true,
    }
}

/// Arcs that bend over the reach of the rows.
fn spun(field: GrooveField) -> GrooveField {
    match field {
        GrooveField::Around {
            axis,
            center_m,
            bearing: Bearing::Spun { .. },
        } => GrooveField::Around {
            axis,
            center_m,
            bearing: Bearing::Spun {
                curvature_per_m: 15.0,
            },
        },
        field => field,
    }
}

#[test]
fn bands_of_rows() {
    let mut random = Sequence(5);
    let rows: Vec<[f32; 13]> = (0..4000)
        .map(|_| {
            let mut row = [0.0; 13];
            row[..3].copy_from_slice(&random.direction(0.0));
            row[3..6].copy_from_slice(&random.direction(0.0));
            for value in &mut row[6..10] {
                *value = random.uniform(-300.0, 300.0);
            }
            row[10] = random.uniform(-0.05, 0.05);
            row[11] = random.uniform(-0.05, 0.05);
            row[12] = random.uniform(0.0, 0.1);
            row
        })
        .collect();
    Twin {
        name: "scratch_band of a row",
        modules: &[&shaders::GRATING],
        snippet: "let point = LitPoint(vec3f(x[0], x[1], x[2]), 0.3, vec2f(x[6], x[7]), vec2f(x[8], x[9]), vec2f(0.01, 0.0), vec2f(0.0, 0.02), 20.0, 0u);
            let seen = row_seen(vec2f(0.6, 0.8), 0.5, vec2f(x[10], x[11]), x[12], false);
            let band = scratch_band(point, seen, vec3f(x[3], x[4], x[5]), 0.4);
            y[0] = band.shift; y[1] = band.stds.x; y[2] = band.stds.y; y[3] = band.stds.z; y[4] = band.stds.w;",
        tables: &[],
        // (45) of docs/model.md.
        expected: &|x: [f64; 13]| {
            let (wo, wi) = (v(&x[0..]), v(&x[3..]));
            let tangent = DVec2::new(0.6, 0.8);
            let xi_n = tangent.perp_dot((wo + wi).truncate());
            let steps = [(DVec2::new(0.01, 0.0), 6, 10), (DVec2::new(0.0, 0.02), 8, 11)];
            let moves = steps.map(|(turn, at, turns)| {
                let axis_m = 1e-6 * DVec3::new(x[at], x[at + 1], 0.0);
                let by_pixel = band_moves(turn, axis_m, wo, 1.0 / 0.3, wi, 1.0 / 0.4);
                by_pixel.dot(tangent) + x[turns] * xi_n
            });
            let variance = moves[0].powi(2) + moves[1].powi(2) + (x[12] * xi_n).powi(2);
            let band = BandMotion { shift: 0.0, variance }.band(band_stds(20.0));
            let [r, g, b] = band.stds.channels;
            [band.shift, r, g, b, band.stds.mean]
        },
        tolerance: Tolerance {
            absolute: 1e-5,
            relative: 1e-4,
        },
    }
    .check(&rows, 0);
}

#[test]
fn light_from_all_around() {
    let mut random = Sequence(6);
    let mut rows: Vec<[f32; 4]> = vec![[0.0, 0.0, 1.0, 0.0], [0.0, 0.99995, 0.01, 1.0]];
    rows.extend((0..2000).map(|_| {
        let [x, y, z] = random.direction(0.01);
        [x, y, z, random.uniform(0.0, 6.3)]
    }));
    let tables = [Table {
        size: [COLUMNS as u32, ROWS as u32],
        layers: Some(1),
        texels: Texels::Integers(&TABLE.texels),
    }];
    Twin {
        name: "row_all_around",
        modules: &[&shaders::GRATING],
        snippet: "let wo = vec3f(x[0], x[1], x[2]);
            let point = LitPoint(wo, 0.3, vec2f(0.0), vec2f(0.0), vec2f(0.0), vec2f(0.0), 20.0, 0u);
            let seen = row_seen(vec2f(cos(x[3]), sin(x[3])), 1.0, vec2f(0.0), 0.0, false);
            let sum = row_all_around(table_0, point, seen);
            y[0] = sum.x; y[1] = sum.y; y[2] = sum.z;",
        tables: &tables,
        expected: &|[x, y, z, angle]| {
            let frame = BandFrame {
                tangent: DVec2::from_angle(angle),
            };
            let wo = DVec3::new(x, y, z);
            let mut sum = DVec3::ZERO;
            for cell in row_cells(BandLine::new(frame.band_from_surface(wo), 0.0)) {
                let depth_nm = oblique_depth_nm(GRATING_DEPTH_NM, cell.direction.z, z);
                let row = TABLE.at_depth(depth_nm);
                let at = |q: f64| DVec3::from(row.at(GRATING_WIDTH_UM * q));
                sum += at(cell.q_high) - at(cell.q_low);
            }
            sum.to_array()
        },
        // The built-in cosine may be off by 5e-4, so may the depth of each cell.
        tolerance: Tolerance {
            absolute: 1e-3,
            relative: 1e-3,
        },
    }
    .check(&rows, 0);
}

/// Rigorous light of a viewer's direction: value, slope, and what is missing in the mirror's direction.
#[test]
fn fine_gratings_by_incidence() {
    let medium = Medium::Metal(Metal::Aluminium.into());
    let row = Row {
        pitch_um: 0.5,
        width_um: 0.2,
        ..ROW
    };
    let grooves = FineGrooves {
        pitch_um: row.pitch_um,
        width_um: row.width_um,
        depth_nm: row.depth_nm,
        above: 1.0,
        medium: medium.clone(),
    };
    let efficiencies = Efficiencies::new(&grooves, &|| false).unwrap();
    let rigorous = RigorousGrating {
        row,
        efficiencies: &efficiencies,
        observer: Observer::eye(),
        medium: &medium,
        is_colored: false,
        cover: None,
    };
    let table = rigorous.table(20.0);
    let mut random = Sequence(8);
    // Straight from above, along and across the grooves to the horizon, and anywhere.
    let mut rows: Vec<[f32; 4]> = vec![
        [0.0, 0.0, 1.0, 0.5],
        [1.0, 0.0, 0.0, 0.5],
        [0.0, 1.0, 0.0, -0.5],
    ];
    rows.extend((0..4000).map(|_| {
        let [x, y, z] = random.direction(0.0);
        [x, y, z, random.uniform(-2.2, 2.2)]
    }));
    let tables = [Table {
        size: [COLUMNS as u32, ROWS as u32],
        layers: Some(1),
        texels: Texels::Integers(&table.texels),
    }];
    let at = |x: f64, y: f64, q: f64| {
        let row = IncidenceRow::new(&table, [y, x]);
        let [t, taken] = [row.at(GRATING_WIDTH_UM * q), row.taken()];
        [t[0], t[1], t[2], taken[0], taken[1], taken[2]]
    };
    // The directions matter.
    assert!((at(0.0, 0.4, 0.9)[1] - at(0.0, -0.4, 0.9)[1]).abs() > 0.01);
    Twin {
        name: "incidence_table",
        modules: &[&shaders::GRATING],
        snippet: "let point = LitPoint(vec3f(x[0], x[1], x[2]), 0.3, vec2f(0.0), vec2f(0.0), vec2f(0.0), vec2f(0.0), 20.0, 0u);
            let seen = row_seen(vec2f(1.0, 0.0), 1.0, vec2f(0.0), 0.0, true);
            let t = scratch_below(table_0, point, seen, x[3], 0.0);
            let taken = row_taken(table_0, point, seen);
            y[0] = t.x; y[1] = t.y; y[2] = t.z; y[3] = taken.x; y[4] = taken.y; y[5] = taken.z;",
        tables: &tables,
        expected: &|[x, y, _, q]| at(x, y, q),
        // The built-in arc sine is off by up to 5e-4.
        tolerance: Tolerance {
            absolute: 2e-3,
            relative: 2e-3,
        },
    }
    .check(&rows, 0);
}
