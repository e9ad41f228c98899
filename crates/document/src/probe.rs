//! Whether a file can be used, before a scene names it: all errors that loading would give, in less time.

use glam::{DMat4, DVec3, Vec3};
use hairline_image::FilePath;
use hairline_memory::budget_bytes;
use hairline_model::mesh_file::{self, FileContents, Placing};
use hairline_scene::{Base, Material, Mesh, Texture};

use crate::description::Description;
use crate::error::Error;
use crate::reading;

/// Contents of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSummary {
    /// Triangles that span an area, of all nodes of the file's scene.
    pub triangles: usize,
    /// Middle of a model that stands too far from its own origin for single precision, in the file's frame: coordinates count from there.
    pub moved_from: Option<DVec3>,
    /// The least and the greatest coordinates, in the file's own frame.
    pub bounds_m: (Vec3, Vec3),
    /// Points of its surface that stand farthest out, see [`Mesh::extreme_points_m`](hairline_scene::Mesh::extreme_points_m).
    pub extreme_points_m: Vec<Vec3>,
    /// Names of the materials that the triangles use.
    pub materials: Vec<String>,
    /// The share of the triangles that are of metal.
    pub metal_share: f64,
}

impl MeshSummary {
    /// The largest extent along an axis of the file.
    pub fn extent_m(&self) -> f64 {
        let (least, most) = self.bounds_m;
        f64::from((most - least).max_element())
    }

    /// A size that suits a scene of `scene_extent_m` (see [`scene_extent_m`]) where the file's own does not: `fit_m` for the object.
    /// `None` where the model is neither much larger than the scene nor much smaller.
    pub fn fit_m(&self, scene_extent_m: f64) -> Option<f64> {
        // A model of a tenth of the scene is a coin beside a pan; one of twice the scene hides it.
        let fits = 0.1 * scene_extent_m..=2.0 * scene_extent_m;
        (!fits.contains(&self.extent_m()) && scene_extent_m > 0.0).then_some(scene_extent_m)
    }
}

/// Size of the visible scene: the distance of its camera times twice the tangent of half its field of view, cut to a half.
pub fn scene_extent_m(description: &Description) -> f64 {
    let camera = &description.camera;
    let [position, target] = [camera.position_m, camera.target_m].map(glam::DVec3::from);
    position.distance(target) * (0.5 * camera.fov_y_deg.to_radians()).tan()
}

/// Box in the place of objects in a scene without any: a square on the level of the origin, below the camera's target, as wide as
/// half of the picture is high.
pub fn empty_bounds_m(description: &Description) -> (glam::DVec3, glam::DVec3) {
    let camera = &description.camera;
    let up = camera.world_up();
    let target_m = glam::DVec3::from(camera.target_m);
    let middle_m = target_m - target_m.dot(up) * up;
    let half_m = 0.5 * scene_extent_m(description) * (glam::DVec3::ONE - up.abs());
    (middle_m - half_m, middle_m + half_m)
}

/// Contents of an environment file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnvironmentSummary {
    /// Width and height as in the file.
    pub size_px: [u32; 2],
}

/// Reads a model's file as an object would, buffers and images included.
///
/// # Errors
/// What is wrong with the file.
pub fn mesh(path: impl Into<FilePath>) -> Result<MeshSummary, Error> {
    Ok(read_mesh(&path.into())?.summary)
}

/// A mesh file that was read.
pub(crate) struct ProbedMesh {
    /// Mesh in the file's frame.
    pub mesh: Mesh,
    /// Materials of its triangles.
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub summary: MeshSummary,
}

/// Reads the file for [`mesh`], and returns its contents.
pub(crate) fn read_mesh(path: &FilePath) -> Result<ProbedMesh, Error> {
    let (mut materials, mut textures) = (Vec::new(), Vec::new());
    let mut moved_from = None;
    let stock = FileContents {
        moved_from: &mut moved_from,
        notes: &mut Vec::new(),
        parts: &mut Vec::new(),
        materials: &mut materials,
        textures: &mut textures,
        files: &mut Vec::new(),
        with_mips: false,
        free_bytes: budget_bytes() as f64,
    };
    let mesh = mesh_file::read(path, None, &DMat4::IDENTITY, &Placing::NONE, stock)
        .map_err(|flaw| Error::new("", flaw.found, flaw.right).with_position(path, None))?;
    if mesh.triangles.is_empty() {
        let right = "must have triangles that span an area";
        return Err(Error::new("", "it has no surface", right).with_position(path, None));
    }
    let is_metal: Vec<bool> = materials.iter().map(|it| is_metal(it, &textures)).collect();
    let metals = mesh
        .triangle_materials
        .iter()
        .filter(|i| is_metal[**i as usize]);
    let summary = MeshSummary {
        metal_share: metals.count() as f64 / mesh.triangles.len() as f64,
        moved_from,
        triangles: mesh.triangles.len(),
        bounds_m: mesh.bounds_m(),
        extreme_points_m: mesh.extreme_points_m(),
        materials: materials.iter().map(|m| m.name.clone()).collect(),
    };
    Ok(ProbedMesh {
        mesh,
        materials,
        textures,
        summary,
    })
}

/// Whether a material of a file is a metal for the most part.
fn is_metal(material: &Material, textures: &[Texture]) -> bool {
    let Base::MetallicRoughness { metallic, .. } = material.base else {
        return false;
    };
    let Some(texture) = material.metallic_roughness_texture else {
        return metallic >= 0.5;
    };
    // Blue.
    let some = textures[texture].some_texels();
    let (sum, count) = some.fold((0.0, 0.0), |(sum, count), texel| {
        (sum + f64::from(texel[2]) / 255.0, count + 1.0)
    });
    metallic * sum >= 0.5 * count
}

/// Reads an .hdr or .exr file as an environment would, down to its last pixel.
///
/// # Errors
/// What is wrong with the file.
pub fn environment(path: impl Into<FilePath>) -> Result<EnvironmentSummary, Error> {
    let path = path.into();
    let map = hairline_sky::read(&path).map_err(|error| {
        // The message names the path already.
        let message = error.to_string();
        let found = message.strip_prefix(&format!("{}: ", path.display()));
        let right = "must be an equirectangular .hdr or .exr";
        Error::new("", found.unwrap_or(&message), right).with_position(&path, None)
    })?;
    Ok(EnvironmentSummary {
        size_px: map.size_px,
    })
}

/// Reads a scene file: its form, its ranges, and the names that its tables call one another by. What its files hold is left
/// to [`mesh()`] and [`environment()`].
///
/// # Errors
/// What is wrong with the scene, with its line.
pub fn scene(path: impl Into<FilePath>) -> Result<Description, Error> {
    let path = path.into();
    let text = reading::scene_text(&path)?;
    let description = Description::from_toml(&text, &path)?;
    description
        .check()
        .and_then(|()| description.check_references())
        .map_err(|error| error.in_scene_file(&text, &path))?;
    Ok(description)
}
