//! Scratches and gratings of a mesh.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use bevy::log::warn;
use bevy::math::{Mat4, Vec4};
use bevy::mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::BevyError;
use hairline_gpu::scratch_tree;
use hairline_index::ScratchIndex;
use hairline_optics::metal::Metal;
use hairline_optics::section::GrooveShape;
use hairline_optics::table::{ENGINE_COLUMNS, ENGINE_ROWS, ROWS};
use hairline_scene::{
    Arrays, Base, Description, GrooveShapes, Loader, MeshArrays, Scene, SceneBuilder, ScratchTables,
};

/// Name of the mesh where a scene has a file.
const NAME: &str = "mesh";
/// Rest of the scene; no picture is rendered of it, so nothing lights it.
const REST: &str = "
studio = { hidden = true }
camera = { position_m = [0.0, 0.0, 1.0], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }
material = [{ name = 'material', kind = 'mirror' }]
object = [{ name = 'mesh', mesh = 'mesh', material = 'material' }]
";
/// Fields of grooves, in the order of the constants of groove_field.wgsl.
const KINDS: [&str; 4] = ["along", "circular", "radial", "spun"];
/// Stands for everywhere.
const FAR_M: f64 = 1e9;

/// The scratches and gratings of one mesh, in its own frame, with the tree that shaders find them by.
#[derive(Clone, Debug)]
pub struct Scratches {
    pub(crate) tree: Vec<[u32; 4]>,
    /// Shapes of the grooves, each with a layer of the spectra.
    pub(crate) shapes: Vec<GrooveShape>,
    pub(crate) gratings: Vec<Grating>,
}

impl Scratches {
    /// Lays layers on a mesh whose unit is the metre. Each layer has the keys of a table `[[scratches]]` of a scene file (docs/scene.md),
    /// but `object`: `"pattern = 'random'\ncount = 1500"`, or `"pattern = 'file'\nfile = 'scratches.csv'"` for a list of your own.
    ///
    /// # Errors
    /// What is wrong with a layer, by its key, or that the mesh is not one of triangles with positions.
    pub fn on_mesh(mesh: &Mesh, layers: &[&str]) -> Result<Self, BevyError> {
        let scene = scene("scratches", layers, arrays_of(mesh)?)?;
        Ok(Self::of_scene(&scene, 0))
    }

    /// Adds rows of grooves, as of turned metal or a compact disc. Each has the keys of a table `[[grating]]` of a scene file, but `object`:
    /// `"pattern = 'circular'\npitch_um = 1.6\nwidth_um = 0.5\ndepth_nm = 110.0"`. Their spectra are those of the metal. Fine rows take seconds.
    ///
    /// # Errors
    /// What is wrong with a row, by its key.
    pub fn with_gratings(
        mut self,
        metal: Option<Metal>,
        gratings: &[&str],
    ) -> Result<Self, BevyError> {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let any = MeshArrays::new(corners.into(), vec![[0, 1, 2]], None, None)?;
        let mut scene = scene("grating", gratings, any)?;
        if let Some(metal) = metal {
            scene.materials[0].base = Base::Metal(metal);
        }
        self.gratings.extend(gratings_of(&scene, 0));
        Ok(self)
    }

    /// Those of one of a scene's objects, in world space: for a mesh that is not moved. Gratings by texture coordinates, in spots and with masks
    /// are left out, which a warning tells.
    pub fn of_scene(scene: &Scene, object: usize) -> Self {
        Self {
            tree: scratch_tree::texels(&ScratchIndex::build(scene), object),
            shapes: GrooveShapes::new(scene).shapes().collect(),
            gratings: gratings_of(scene, object),
        }
    }
}

/// Rows of grooves with the table of what they send.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grating {
    /// As `grooves()` of scratched.wgsl reads them, but the layer of the table.
    pub numbers: Mat4,
    pub texels: Arc<Vec<[u32; 4]>>,
}

/// Grooves along a direction or about an axis, lengths in metres.
pub(crate) struct Field<'a> {
    pub kind: &'a str,
    pub axis: [f64; 3],
    pub center: [f64; 3],
    pub radii_m: [f64; 2],
    pub curvature_per_m: f64,
    pub coverage: f64,
    pub angle_std_rad: f64,
    pub coherence_um: f64,
}

impl Grating {
    /// None of a kind that is not known, or of a table of another size than the package's.
    pub(crate) fn new(field: &Field, texels: Arc<Vec<[u32; 4]>>) -> Option<Self> {
        let kind = KINDS.iter().position(|kind| *kind == field.kind)?;
        let is_fine = texels.len() == ROWS * ENGINE_COLUMNS;
        if !is_fine && texels.len() != ENGINE_ROWS * ENGINE_COLUMNS {
            return None;
        }
        let four = |[x, y, z]: [f64; 3], w: f64| Vec4::from([x, y, z, w].map(|it| it as f32));
        let [inner_m, outer_m] = field.radii_m;
        let numbers = Mat4::from_cols(
            four(field.axis, kind as f64),
            four(field.center, field.curvature_per_m),
            four(
                [inner_m, outer_m.min(FAR_M), field.coverage],
                field.angle_std_rad,
            ),
            four([field.coherence_um, f64::from(is_fine), 0.0], 0.0),
        );
        Some(Self { numbers, texels })
    }

    /// Rows of the table.
    pub(crate) fn rows(&self) -> usize {
        self.texels.len() / ENGINE_COLUMNS
    }
}

/// A scene of one mesh with tables of a name.
fn scene(table: &str, rows: &[&str], arrays: MeshArrays) -> Result<Scene, BevyError> {
    let mut text = String::from(REST);
    for row in rows {
        write!(text, "[[{table}]]\nobject = 'mesh'\n{row}\n")?;
    }
    let description = Description::from_toml(&text, Path::new("layers of scratches"))?;
    let mut named = Arrays::default();
    named.insert_mesh(NAME, Arc::new(arrays));
    let loader = Loader {
        arrays: &named,
        ..Loader::default()
    };
    Ok(SceneBuilder::new().build(&loader, &description, Path::new("."))?)
}

fn gratings_of(scene: &Scene, object: usize) -> Vec<Grating> {
    let object = &scene.objects[object];
    if object.gratings.is_empty() {
        return Vec::new();
    }
    let material = object.mesh.triangle_materials[0] as usize;
    let tables = ScratchTables::new(scene);
    let gratings = object.gratings.iter().filter_map(|grating| {
        let (Some(plain), None) = (grating.field.plain(), grating.mask) else {
            warn!("not drawn: a grating by texture coordinates, in spots or with a mask");
            return None;
        };
        let table = &tables.tables[tables.grating_table(grating, material)?];
        let rows = match table.by_incidence {
            true => ROWS,
            false => ENGINE_ROWS,
        };
        let field = Field {
            kind: plain.kind,
            axis: plain.axis.normalize_or_zero().to_array(),
            center: plain.center_m.to_array(),
            radii_m: grating.radii_m,
            curvature_per_m: plain.curvature_per_m,
            coverage: grating.coverage,
            angle_std_rad: grating.angle_std_rad,
            coherence_um: scene.materials[material].coherence_um,
        };
        Grating::new(&field, Arc::new(table.resampled(ENGINE_COLUMNS, rows)))
    });
    gratings.collect()
}

fn arrays_of(mesh: &Mesh) -> Result<MeshArrays, BevyError> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        let found = mesh.primitive_topology();
        return Err(format!("mesh: found {found:?}; must be a list of triangles").into());
    }
    let three = |attribute| match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(rows)) => Some(
            rows.iter()
                .map(|row| row.map(f64::from))
                .collect::<Vec<_>>(),
        ),
        _ => None,
    };
    let positions = three(Mesh::ATTRIBUTE_POSITION)
        .ok_or("mesh: found no positions; must have three f32 for each vertex")?;
    let indices: Vec<u32> = match mesh.indices() {
        Some(Indices::U16(indices)) => indices.iter().map(|i| u32::from(*i)).collect(),
        Some(Indices::U32(indices)) => indices.clone(),
        None => (0..positions.len() as u32).collect(),
    };
    let (triangles, _) = indices.as_chunks::<3>();
    let normals = three(Mesh::ATTRIBUTE_NORMAL);
    Ok(MeshArrays::new(
        positions,
        triangles.to_vec(),
        normals,
        None,
    )?)
}
