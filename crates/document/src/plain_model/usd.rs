//! A model as text of Universal Scene Description: meshes with UsdPreviewSurface, after Pixar's *UsdPreviewSurface Specification*. Own code: the
//! crate `openusd` needs a newer compiler than the workspace.

mod look;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::{Vec2, Vec3};
use hairline_scene::{Mesh, Object};

use super::model::PlainModel;
use super::parts::{Part, parts};
use super::zip;
use crate::error::Error;
use crate::gltf_scene::Exported;

impl PlainModel {
    /// The package for phones.
    pub(crate) fn to_usdz(&self) -> Result<Exported, Error> {
        let bytes = zip::packed(&files(self)).map_err(|why| {
            let right = "must have smaller models or pictures";
            Error::new("", why, right)
        })?;
        Ok(Exported {
            bytes,
            notes: self.notes(),
        })
    }
}

/// The files of a package by their names. The stage is the first, as readers ask.
fn files(model: &PlainModel) -> Vec<(String, Vec<u8>)> {
    let mut stage = Stage {
        model,
        meshes: String::new(),
        count: 0,
        looks: BTreeMap::new(),
        pictures: BTreeMap::new(),
    };
    model.objects().for_each(|object| stage.object(object));
    let mut files = vec![("scene.usda".to_owned(), stage.text().into_bytes())];
    let pictures = stage.pictures.into_iter();
    files.extend(pictures.map(|(i, png)| (look::picture_name(i), png)));
    files
}

/// A stage while it is written. Writing to its texts cannot fail.
struct Stage<'a> {
    model: &'a PlainModel,
    meshes: String,
    /// Number of meshes.
    count: usize,
    /// Texts of materials by their numbers in the scene.
    looks: BTreeMap<usize, String>,
    /// PNG files by the numbers of their textures.
    pictures: BTreeMap<usize, Vec<u8>>,
}

impl Stage<'_> {
    /// Adds a mesh for each material of an object.
    fn object(&mut self, object: &Object) {
        for part in parts(&object.mesh) {
            let (number, material) = (self.count, part.material);
            self.count += 1;
            let name = look::quoted(&object.name);
            let _ = write!(
                self.meshes,
                "
    def Mesh \"mesh_{number}\" (
        displayName = {name}
        prepend apiSchemas = [\"MaterialBindingAPI\"]
    )
    {{
"
            );
            self.mesh(&object.mesh, &part);
            let _ = writeln!(
                self.meshes,
                "        rel material:binding = <{}>\n    }}",
                look::path(material)
            );
            let pictures = &mut self.pictures;
            let scene = &self.model.scene;
            let look = self.looks.entry(material);
            look.or_insert_with(|| look::text(scene, material, pictures));
        }
    }

    fn mesh(&mut self, mesh: &Mesh, part: &Part) {
        let vertices = || part.vertices.iter().copied();
        let places = vertices().map(|v| self.model.turned(mesh.positions_m[v]));
        let normals = vertices().map(|v| self.model.turned(mesh.normals[v]));
        let (low, high) = places.clone().fold(
            (Vec3::INFINITY, Vec3::NEG_INFINITY),
            |(low, high), place| (low.min(place), high.max(place)),
        );
        let by_vertex = "(interpolation = \"vertex\")";
        let rows = [
            ("uniform bool doubleSided", "1".to_owned()),
            ("uniform token subdivisionScheme", "\"none\"".to_owned()),
            ("float3[] extent", triples([low, high].into_iter())),
            (
                "int[] faceVertexCounts",
                listed(part.corners.chunks(3).map(|_| 3)),
            ),
            ("int[] faceVertexIndices", listed(part.corners.iter())),
            ("point3f[] points", triples(places)),
            (
                "normal3f[] normals",
                format!("{} {by_vertex}", triples(normals)),
            ),
        ];
        for (name, value) in rows {
            let _ = writeln!(self.meshes, "        {name} = {value}");
        }
        for (name, uvs) in look::UV_SETS.into_iter().zip([&mesh.uvs, &mesh.other_uvs]) {
            if uvs.len() != mesh.positions_m.len() {
                continue;
            }
            // Those of USD begin at the lower left corner.
            let place = |uv: Vec2| format!("({}, {})", uv.x, 1.0 - uv.y);
            let places = listed(vertices().map(|v| place(uvs[v])));
            let _ = writeln!(
                self.meshes,
                "        texCoord2f[] primvars:{name} = {places} {by_vertex}"
            );
        }
    }

    /// The whole text.
    fn text(&self) -> String {
        let looks: String = self.looks.values().map(String::as_str).collect();
        let meshes = &self.meshes;
        format!(
            "#usda 1.0
(
    defaultPrim = \"Root\"
    metersPerUnit = 1
    upAxis = \"Y\"
)

def Xform \"Root\" (
    kind = \"component\"
)
{{
    def Scope \"Looks\"
    {{
{looks}    }}
{meshes}}}
"
        )
    }
}

fn triples(of: impl Iterator<Item = Vec3>) -> String {
    listed(of.map(|it| format!("({}, {}, {})", it.x, it.y, it.z)))
}

fn listed(values: impl Iterator<Item = impl ToString>) -> String {
    let values: Vec<String> = values.map(|it| it.to_string()).collect();
    format!("[{}]", values.join(", "))
}
