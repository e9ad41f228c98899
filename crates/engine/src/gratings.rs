//! Gratings of one mesh: where their grooves run, and the texture of what they send.

use std::sync::Arc;

use hairline_optics::metal::Metal;
use hairline_optics::table::{ENGINE_COLUMNS, ENGINE_GRATING_ROWS, ROWS, last_depth_nm};
use hairline_scene::{Base, Object, Scene, ScratchTables};

use crate::one_object::scene_of;

/// Fields of grooves, in the order of the constants of groove_field.wgsl.
const KINDS: [&str; 4] = ["along", "circular", "radial", "spun"];
/// Stands for everywhere.
const FAR_M: f64 = 1e9;

/// Rows of grooves with the table of what they send.
#[derive(Clone, Debug, PartialEq)]
pub struct GratingTexels {
    /// Numbers of `Grooves` of grated_surface.wgsl, column by column; the layer of the table has the place of the third in the last.
    pub numbers: [f32; 16],
    /// A texture of `rgba32uint`, [`ENGINE_COLUMNS`] wide.
    pub texels: Arc<Vec<[u32; 4]>>,
}

/// Where grooves run which way, lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct GratingField<'a> {
    /// `"along"`, `"circular"`, `"radial"` or `"spun"`; `"along-u"` or `"along-v"`, by texture coordinates.
    pub kind: &'a str,
    /// A unit vector.
    pub axis: [f64; 3],
    /// A point of the axis, or that from which the radii are measured.
    pub center_m: [f64; 3],
    /// Least and greatest distance from it; both are finite.
    pub radii_m: [f64; 2],
    /// Curvature of spun grooves.
    pub curvature_per_m: f64,
    /// The share of the surface that they cover.
    pub coverage: f64,
    /// Standard deviation of a groove's angle to the field.
    pub angle_std_rad: f64,
    /// Width of the material's coherence window.
    pub coherence_um: f64,
}

/// A grating of an object, with the table of what it sends.
#[derive(Clone, Debug, PartialEq)]
pub struct LaidGrating {
    /// Where its grooves run.
    pub field: GratingField<'static>,
    /// Whether a picture is a factor on their coverage.
    pub has_mask: bool,
    /// A texture of `rgba32uint`, [`ENGINE_COLUMNS`] wide.
    pub texels: Arc<Vec<[u32; 4]>>,
}

impl GratingTexels {
    /// None where the kind is not one of shaders, as along texture coordinates, or the table has another size.
    pub fn new(field: &GratingField, texels: Arc<Vec<[u32; 4]>>) -> Option<Self> {
        let kind = KINDS.iter().position(|kind| *kind == field.kind)?;
        let rows = texels.len() / ENGINE_COLUMNS;
        let is_fine = rows == ROWS;
        let is_right = is_fine || (2..=ENGINE_GRATING_ROWS).contains(&rows);
        if !is_right || rows * ENGINE_COLUMNS != texels.len() {
            return None;
        }
        let [x, y, z] = field.axis;
        let [at_x, at_y, at_z] = field.center_m;
        let [inner_m, outer_m] = field.radii_m;
        let numbers = [
            [x, y, z, kind as f64],
            [at_x, at_y, at_z, field.curvature_per_m],
            [inner_m, outer_m, field.coverage, field.angle_std_rad],
            [
                field.coherence_um,
                f64::from(is_fine),
                0.0,
                last_depth_nm(rows),
            ],
        ];
        Some(Self {
            numbers: std::array::from_fn(|i| numbers[i / 4][i % 4] as f32),
            texels,
        })
    }

    /// Rows of the table.
    pub fn rows(&self) -> usize {
        self.texels.len() / ENGINE_COLUMNS
    }
}

impl LaidGrating {
    /// The gratings of an object by itself, in a metal, or in a colour of metal. `coherence_um` is the width of the material's coherence window. Fine rows
    /// take seconds. None in the place of those in spots.
    pub fn of_object(object: Object, metal: Option<Metal>, coherence_um: f64) -> Vec<Option<Self>> {
        let mut scene = scene_of(object, coherence_um);
        if let Some(metal) = metal {
            scene.materials[0].base = Base::Metal(metal.into());
        }
        Self::of_scene(&scene, 0)
    }

    /// The gratings of one of a scene's objects, in world space. None in the place of those in spots.
    pub fn of_scene(scene: &Scene, object: usize) -> Vec<Option<Self>> {
        let object = &scene.objects[object];
        if object.gratings.is_empty() {
            return Vec::new();
        }
        let material = object.mesh.triangle_materials[0] as usize;
        let tables = ScratchTables::new(scene);
        let gratings = object.gratings.iter().map(|grating| {
            let plain = grating.field.plain()?;
            let table = &tables.tables[tables.grating_table(grating, material)?];
            let field = GratingField {
                kind: plain.kind,
                axis: plain.axis.normalize_or_zero().to_array(),
                center_m: plain.center_m.to_array(),
                radii_m: grating.radii_m.map(|radius_m| radius_m.min(FAR_M)),
                curvature_per_m: plain.curvature_per_m,
                coverage: grating.coverage,
                angle_std_rad: grating.angle_std_rad,
                coherence_um: scene.materials[material].coherence_um,
            };
            Some(Self {
                field,
                has_mask: grating.mask.is_some(),
                texels: Arc::new(table.for_engines(grating.row.depth_nm)),
            })
        });
        gratings.collect()
    }

    /// The grating as shaders take it that look up no pictures; none where it has a mask or follows texture coordinates.
    pub fn without_pictures(self) -> Option<GratingTexels> {
        match self.has_mask {
            true => None,
            false => GratingTexels::new(&self.field, self.texels),
        }
    }
}
