//! Memory of a scene, by the costs of [`hairline_memory`], estimated before the scene is built. Scratches, whose number depends on
//! the built surfaces, are counted where they are laid.

use hairline_image::FilePath;
use hairline_memory::{costs, in_words};
use hairline_model::mesh_file;
use hairline_model::texture::texture_bytes;

use crate::description::{Description, Map, Object, Shape, Surface};
use crate::error::Error;
use crate::gltf_scene::packed_files::with_packed;

/// An item of the scene that takes memory.
#[derive(Clone, Debug, PartialEq)]
pub struct MemoryItem {
    /// Path of its key in the scene file.
    pub key: String,
    /// Name with its number: `32768 triangles`.
    pub what: String,
    /// Memory of the item.
    pub bytes: f64,
    /// Advice for taking less.
    remedy: &'static str,
}

/// Memory of a scene without its scratches.
#[derive(Clone, Debug, Default)]
pub struct Estimate {
    parts: Vec<MemoryItem>,
}

impl Estimate {
    /// Estimates a whole scene and its picture, without its scratches. Of files only the heads are read; what cannot be read counts
    /// nothing.
    pub fn from_description(description: &Description, base_dir: impl Into<FilePath>) -> Self {
        let base_dir = &with_packed(base_dir);
        let mut estimate = Self::default();
        estimate.add_lights(description);
        for i in 0..description.objects.len() {
            estimate.add_object(description, i, base_dir);
        }
        estimate.add_environment(description, base_dir);
        estimate.add_picture(description.render.size_px);
        estimate
    }

    /// Parts of the estimate, in the order of the scene.
    pub fn parts(&self) -> &[MemoryItem] {
        &self.parts
    }

    /// Sum of all parts.
    pub fn bytes(&self) -> f64 {
        self.parts.iter().map(|part| part.bytes).sum()
    }

    pub(crate) fn add_lights(&mut self, description: &Description) {
        let lights = description.lights.len();
        let vertices: usize = description
            .lights
            .iter()
            .map(|light| light.kind.corners_m().len())
            .sum();
        if lights > 0 {
            let light = costs::LIGHT + rayon::current_num_threads() as f64 * costs::LIGHT_SEEN;
            self.parts.push(MemoryItem {
                key: "light".to_owned(),
                what: counted(lights as f64, "light"),
                bytes: lights as f64 * light + vertices as f64 * costs::LIGHT_VERTEX,
                remedy: "take fewer lights",
            });
        }
    }

    pub(crate) fn add_object(&mut self, description: &Description, i: usize, base_dir: &FilePath) {
        let object = &description.objects[i];
        let is_ground = description
            .scratches
            .iter()
            .any(|s| s.object == object.name);
        let ObjectCounts {
            triangles,
            vertices,
            file_bytes,
        } = ObjectCounts::read(object, base_dir);
        let (key, remedy) = match &object.surface {
            Surface::Mesh(_) => ("mesh", "take a model of fewer triangles"),
            Surface::Shape(Shape::Lathe { .. }) => {
                ("shape.lathe", "take fewer points or fewer `segments`")
            }
            Surface::Shape(_) => ("shape", "take fewer objects"),
        };
        let ground = if is_ground {
            costs::GROUND_TRIANGLE
        } else {
            0.0
        };
        self.parts.push(MemoryItem {
            key: format!("object[{i}].{key}"),
            what: counted(triangles, "triangle"),
            bytes: costs::OBJECT
                + triangles * (costs::TRIANGLE + ground)
                + vertices * costs::VERTEX
                + file_bytes,
            remedy,
        });
    }

    pub(crate) fn add_environment(&mut self, description: &Description, base_dir: &FilePath) {
        let Some(described) = &description.environment else {
            return;
        };
        // Errors in the map are reported when it is read.
        let (key, size_px) = match &described.map {
            Map::File(file) => ("file", hairline_sky::size_px(&base_dir.join(file))),
            Map::BuiltIn(_) => ("builtin", Ok(hairline_sky::BUILT_IN_SIZE_PX)),
        };
        let Ok([width, height]) = size_px else {
            return;
        };
        self.parts.push(MemoryItem {
            key: format!("environment.{key}"),
            what: format!("a map of {width} x {height} pixels"),
            bytes: costs::MAP + f64::from(width) * f64::from(height) * costs::MAP_PIXEL,
            remedy: "take a smaller map",
        });
    }

    /// The picture that is to be rendered, which may have another size than the scene file says.
    pub fn add_picture(&mut self, [width, height]: [u32; 2]) {
        self.parts.push(MemoryItem {
            key: "render.size_px".to_owned(),
            what: format!("a picture of {width} x {height} pixels"),
            bytes: f64::from(width) * f64::from(height) * costs::PICTURE_PIXEL,
            remedy: "take a smaller picture",
        });
    }

    /// Refuses an estimate that does not fit.
    ///
    /// # Errors
    /// The largest part, and what all parts take.
    pub fn check(&self, free_bytes: f64) -> Result<(), Error> {
        let bytes = self.bytes();
        let largest = self.parts.iter().max_by(|a, b| a.bytes.total_cmp(&b.bytes));
        let Some(largest) = largest.filter(|_| bytes > free_bytes) else {
            return Ok(());
        };
        let right = format!(
            "{} are free for it; {}",
            in_words(free_bytes),
            largest.remedy
        );
        // Many small things are nobody's fault alone.
        if largest.bytes < bytes / 2.0 {
            let found = format!(
                "found {} parts, which would take about {} of memory together",
                self.parts.len(),
                in_words(bytes)
            );
            return Err(Error::new(table_of(&largest.key), found, right));
        }
        let found = format!(
            "found {}, which would take about {} of memory",
            largest.what,
            in_words(largest.bytes)
        );
        Err(Error::new(&largest.key, found, right))
    }
}

/// Memory that laid scratches take.
pub fn scratches_bytes(scratches: usize, segments: usize) -> f64 {
    crate::scratches::bytes(scratches, segments)
}

/// Memory that the textures of a scene take.
pub fn textures_bytes(scene: &hairline_scene::Scene) -> f64 {
    scene
        .textures
        .iter()
        .map(|texture| texture_bytes(texture.size_px))
        .sum()
}

fn counted(number: f64, what: &str) -> String {
    match number == 1.0 {
        true => format!("1 {what}"),
        false => format!("{number} {what}s"),
    }
}

/// `object` of `object[3].shape`.
fn table_of(key: &str) -> &str {
    key.split(['[', '.']).next().unwrap_or(key)
}

/// Numbers of an object before it is made.
#[derive(Clone, Copy, Debug, Default)]
struct ObjectCounts {
    triangles: f64,
    vertices: f64,
    /// Memory for files that are held while the object is read.
    file_bytes: f64,
}

impl ObjectCounts {
    fn read(object: &Object, base_dir: &FilePath) -> Self {
        match &object.surface {
            Surface::Shape(shape) => {
                let [triangles, vertices] = crate::shape::size(shape);
                Self {
                    triangles,
                    vertices,
                    file_bytes: 0.0,
                }
            }
            Surface::Mesh(file) => {
                let counts = mesh_file::counts(&base_dir.join(file)).unwrap_or_default();
                Self {
                    triangles: counts.triangles,
                    vertices: counts.vertices,
                    file_bytes: counts.bytes,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn described(objects: &str) -> Description {
        let text = format!(
            "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\n[render]\nsize_px = [8, 8]\n{objects}"
        );
        Description::from_toml(&text, Path::new("a.toml")).unwrap()
    }

    fn lathe(points: usize, segments: u32) -> String {
        let points: Vec<_> = (0..points)
            .map(|i| format!("[0.1, {}]", i as f64 * 1e-4))
            .collect();
        format!(
            "[[object]]\nname = \"a\"\nmaterial = \"m\"\nshape.lathe = {{ profile_m = [{}], segments = {segments} }}\n",
            points.join(",")
        )
    }

    #[test]
    fn what_is_large_is_named() {
        // 60 kB of text, 22 million triangles.
        let estimate = Estimate::from_description(&described(&lathe(2700, 4096)), Path::new(""));
        let error = estimate.check(4e9).unwrap_err();
        assert_eq!(error.key(), "object[0].shape.lathe");
        assert!(error.found().contains("22110208 triangles"), "{error}");
        assert!(error.found().contains("11.33 GiB"), "{error}");
        assert!(error.right().contains("3.73 GiB are free"), "{error}");
        estimate.check(2e10).unwrap();
    }

    #[test]
    fn what_is_much_is_named_together() {
        let disks =
            "[[object]]\nname = \"a\"\nmaterial = \"m\"\nshape.disk.radius_m = 1\n".repeat(100);
        let estimate = Estimate::from_description(&described(&disks), Path::new(""));
        let error = estimate.check(1e6).unwrap_err();
        assert_eq!(error.key(), "object");
        assert!(error.found().contains("101 parts"), "{error}");
    }

    #[test]
    fn a_scene_of_few_triangles_is_small() {
        let estimate = Estimate::from_description(&described(&lathe(10, 64)), Path::new(""));
        assert!(estimate.bytes() < 2e6, "{}", estimate.bytes());
    }
}
