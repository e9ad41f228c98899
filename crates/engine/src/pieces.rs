//! Scratches of one mesh as straight pieces, and the texture that shaders find them by.

use std::sync::Arc;

use glam::Vec3;
use hairline_optics::section::Section;
use hairline_scene::{GrooveShapes, MOST_SHAPES, Mesh, Object, Profile, Scratch, Segment};

use crate::error::Error;
use crate::one_object::scene_of;
use crate::scratch_tree::{ScratchTexels, WIDTH};

/// Longer pieces are cut: the box of a long slanting one is mostly empty.
const LONGEST_M: f32 = 4e-3;
/// Rows of a texture that every GPU has.
const ROWS_MAX: usize = 8192;

/// Straight pieces in the frame of a mesh, in its own unit; those of a scratch follow one another. All lists have one entry a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pieces {
    /// Where they begin.
    pub starts: Vec<[f32; 3]>,
    /// Where they end.
    pub ends: Vec<[f32; 3]>,
    /// The surface's normals; zero where it is not known, so that a piece shows on both sides of a sheet.
    pub normals: Vec<[f32; 3]>,
    /// Width of the groove.
    pub widths_um: Vec<f32>,
    /// Depth of its deepest place.
    pub depths_nm: Vec<f32>,
    /// Number of the scratch.
    pub scratch: Vec<u32>,
    /// Cross section of the groove.
    pub sections: Vec<Section>,
    /// Index of the layer.
    pub layers: Vec<u32>,
}

impl Pieces {
    /// The pieces of an object in world space, for a mesh whose unit is `metres_per_unit` long.
    pub fn of_object(object: &Object, metres_per_unit: f64) -> Self {
        let in_mesh = |at: Vec3| (at.as_dvec3() / metres_per_unit).as_vec3().to_array();
        let mut pieces = Self::default();
        for (number, scratch) in (0..).zip(object.scratches.iter()) {
            let Profile {
                width_um,
                depth_nm,
                section,
            } = &scratch.profile;
            let own = scratch.segments.start as usize..scratch.segments.end as usize;
            for piece in &object.segments[own] {
                pieces.starts.push(in_mesh(piece.start_m));
                pieces.ends.push(in_mesh(piece.end_m));
                pieces.normals.push(piece.normal.to_array());
                pieces.widths_um.push(*width_um);
                pieces.depths_nm.push(*depth_nm);
                pieces.scratch.push(number);
                pieces.sections.push(section.clone());
                pieces.layers.push(scratch.layer);
            }
        }
        pieces
    }

    /// Makes the textures, for a mesh whose unit is `metres_per_unit` long. `coherence_um` is the width of the material's coherence window.
    ///
    /// # Errors
    /// Lists of different lengths, numbers out of range, by the key of the list; grooves of more than [`MOST_SHAPES`] shapes, more pieces than a
    /// texture holds.
    pub fn texels(&self, coherence_um: f64, metres_per_unit: f64) -> Result<ScratchTexels, Error> {
        self.check()?;
        let scene = scene_of(self.object(metres_per_unit as f32), coherence_um);
        let shapes = GrooveShapes::new(&scene);
        if shapes.count() > MOST_SHAPES {
            let found = format!(
                "found grooves of {} shapes: profiles, each as narrow ones and in up to five classes of wide ones",
                shapes.count()
            );
            let right = format!(
                "must be at most {MOST_SHAPES}: fewer profiles, or widths below 0.4 of the coherence window"
            );
            return Err(Error::new("scratches", found, right));
        }
        let texels = ScratchTexels::of_scene(&scene, 0, metres_per_unit as f32);
        let rows = texels.tree.len() / WIDTH;
        if rows > ROWS_MAX {
            let found = format!(
                "found {} pieces, which need {rows} rows of a texture",
                self.starts.len()
            );
            let right = format!("must be at most {ROWS_MAX} rows");
            return Err(Error::new("scratches", found, right));
        }
        Ok(texels)
    }

    /// Checks that all lists are as long, and that numbers are in range.
    ///
    /// # Errors
    /// The first that is not, by the key of its list.
    pub fn check(&self) -> Result<(), Error> {
        let count = self.starts.len();
        let lengths = [
            ("ends", self.ends.len()),
            ("normals", self.normals.len()),
            ("widths_um", self.widths_um.len()),
            ("depths_nm", self.depths_nm.len()),
            ("scratch", self.scratch.len()),
            ("sections", self.sections.len()),
            ("layers", self.layers.len()),
        ];
        if let Some((key, length)) = lengths.iter().find(|(_, length)| *length != count) {
            let found = format!("found {length} for {count} pieces");
            return Err(Error::new(key, found, "must be one for each"));
        }
        for (key, rows) in [
            ("starts", &self.starts),
            ("ends", &self.ends),
            ("normals", &self.normals),
        ] {
            if let Some(x) = rows.iter().flatten().find(|x| !x.is_finite()) {
                return Err(Error::new(key, format!("found {x}"), "must be finite"));
            }
        }
        for (key, (least, most), sizes) in [
            ("width_um", Profile::WIDTHS_UM, &self.widths_um),
            ("depth_nm", Profile::DEPTHS_NM, &self.depths_nm),
        ] {
            // Written so that NaN is out of range.
            if let Some(x) = sizes
                .iter()
                .find(|x| !(least..=most).contains(&f64::from(**x)))
            {
                let right = format!("must be from {least} to {most}");
                return Err(Error::new(key, format!("found {x}"), right));
            }
        }
        Ok(())
    }

    /// An object with these scratches, in metres. Its mesh stands for the surface's material alone.
    fn object(&self, metres_per_unit: f32) -> Object {
        let (mut scratches, mut segments) = (Vec::new(), Vec::new());
        let mut first = 0;
        for own in self.scratch.chunk_by(|a, b| a == b) {
            let own = first..first + own.len();
            first = own.end;
            let from = segments.len() as u32;
            for i in own.clone() {
                let [start, end] =
                    [self.starts[i], self.ends[i]].map(|at| metres_per_unit * Vec3::from(at));
                let parts = (start.distance(end) / LONGEST_M).ceil().max(1.0);
                let at = |part: f32| {
                    if part == parts {
                        end
                    } else {
                        start.lerp(end, part / parts)
                    }
                };
                segments.extend((0..parts as u32).map(|part| Segment {
                    start_m: at(part as f32),
                    end_m: at(part as f32 + 1.0),
                    normal: self.normals[i].into(),
                    triangle: 0,
                }));
            }
            scratches.push(Scratch {
                profile: Profile {
                    width_um: self.widths_um[own.start],
                    depth_nm: self.depths_nm[own.start],
                    section: self.sections[own.start].clone(),
                },
                layer: self.layers[own.start],
                closed: own.len() > 2 && self.starts[own.start] == self.ends[own.end - 1],
                segments: from..segments.len() as u32,
            });
        }
        Object {
            name: String::new(),
            mesh: Arc::new(Mesh {
                triangle_materials: vec![0],
                ..Mesh::default()
            }),
            scratches: Arc::new(scratches),
            segments: Arc::new(segments),
            parts: Arc::default(),
            gratings: Vec::new(),
            is_lamp: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch_table;
    use hairline_document::description::Scratches;
    use hairline_document::{Arrays, Description, Loader, MeshArrays, SceneBuilder, lay_on_mesh};
    use hairline_optics::metal::Metal;
    use hairline_optics::table::{ROWS, last_depth_nm};
    use std::path::Path;

    const LAYERS: &str = "
        [[scratches]]
        object = 'it'
        pattern = 'circular'
        count = 40
        seed = 3
        center_m = [0.02, 0.0, 0.0]
        length_m = 0.01
        [[scratches]]
        object = 'it'
        hidden = true
        pattern = 'random'
        count = 5
        seed = 3
        [[scratches]]
        object = 'it'
        pattern = 'random'
        count = 60
        seed = 3
        width_um = 30.0
        profile = 'v'
        where = { radius_m = [0.01, 0.04] }
    ";

    /// Two triangles that meet in an edge.
    fn mesh() -> MeshArrays {
        let corners = [
            [0.0, 0.0, 0.0],
            [0.05, 0.0, 0.0],
            [0.05, 0.04, 0.01],
            [0.0, 0.04, 0.01],
        ];
        MeshArrays::new(corners.into(), vec![[0, 1, 2], [0, 2, 3]], None, None).unwrap()
    }

    fn layers(text: &str) -> Vec<Scratches> {
        Scratches::from_toml(text, Path::new("layers")).unwrap()
    }

    fn laid(metres_per_unit: f64) -> Pieces {
        let object = lay_on_mesh(
            &mesh(),
            &layers(LAYERS),
            &Arrays::default(),
            metres_per_unit,
        );
        Pieces::of_object(&object.unwrap(), metres_per_unit)
    }

    #[test]
    fn a_seed_means_the_scratches_of_a_scene() {
        let text = format!(
            "camera = {{ position_m = [0, 0, 1], target_m = [0, 0, 0], up = [0, 1, 0] }}
            material = [{{ name = 'mirror', kind = 'mirror' }}]
            object = [{{ name = 'it', mesh = 'mesh', material = 'mirror', scale = 0.5, translation_m = [0.1, 0.0, 0.0] }}]
            {LAYERS}"
        );
        let mut arrays = Arrays::default();
        arrays.insert_mesh("mesh", Arc::new(mesh()));
        let loader = Loader {
            arrays: &arrays,
            ..Loader::default()
        };
        let description = Description::from_toml(&text, Path::new("scene")).unwrap();
        let scene = SceneBuilder::new()
            .build(&loader, &description, Path::new("."))
            .unwrap();
        let object = &scene.objects[0];
        let pieces = laid(0.5);
        assert_eq!(pieces.starts.len(), object.segments.len());
        assert_eq!(
            pieces.scratch.last().copied(),
            Some(object.scratches.len() as u32 - 1)
        );
        let moved = |at: &[f32; 3]| 0.5 * Vec3::from(*at) + Vec3::new(0.1, 0.0, 0.0);
        for (i, piece) in object.segments.iter().enumerate() {
            assert!(
                moved(&pieces.starts[i]).distance(piece.start_m) < 1e-7,
                "piece {i}"
            );
            assert!(
                moved(&pieces.ends[i]).distance(piece.end_m) < 1e-7,
                "piece {i}"
            );
        }
        let scratches = pieces
            .scratch
            .chunk_by(|a, b| a == b)
            .scan(0, |first, own| {
                let at = *first;
                *first += own.len();
                Some(at)
            });
        for (at, scratch) in scratches.zip(object.scratches.iter()) {
            let sizes = (
                pieces.widths_um[at],
                pieces.depths_nm[at],
                pieces.layers[at],
            );
            let profile = &scratch.profile;
            assert_eq!(sizes, (profile.width_um, profile.depth_nm, scratch.layer));
        }
        // V grooves of 30 µm are wide under a window of 20 µm, and so are a shape of their own.
        let texels = pieces.texels(20.0, 0.5).unwrap();
        assert_eq!(texels.shapes.len(), 2);
        // A table with its rows is the beginning of one with all.
        let tables = [texels.table_rows, ROWS].map(|rows| {
            texels
                .shapes
                .iter()
                .map(move |shape| scratch_table(Some(Metal::Gold), shape, rows))
                .collect::<Vec<_>>()
        });
        for (short, whole) in tables[0].iter().zip(&tables[1]) {
            assert!(short.len() < whole.len() / 4);
            assert_eq!(short[..], whole[..short.len()]);
        }
        let deepest_nm = pieces
            .depths_nm
            .iter()
            .fold(0.0, |most: f32, nm| most.max(*nm));
        assert!(last_depth_nm(texels.table_rows) > deepest_nm.into());
    }

    #[test]
    fn a_tree_has_all_pieces_with_long_ones_cut() {
        let long = Pieces {
            starts: vec![[0.0; 3]],
            ends: vec![[0.03, 0.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]],
            widths_um: vec![2.0],
            depths_nm: vec![100.0],
            scratch: vec![0],
            sections: vec![Section::Rectangle],
            layers: vec![0],
        };
        let made = long.texels(20.0, 1.0).unwrap();
        let [nodes, pieces] = [made.tree[0][0], made.tree[0][1]].map(|n| n as usize);
        let x = |texel: usize| f32::from_bits(made.tree[texel][0]);
        let spans = (0..pieces).map(|i| (x(1 + 2 * nodes + 2 * i), x(2 + 2 * nodes + 2 * i)));
        let lengths: Vec<f32> = spans.map(|(start, end)| end - start).collect();
        assert!(pieces > 4 && lengths.iter().all(|length| (0.0..=4.1e-3).contains(length)));
        // Each free end moves inwards by 0.564 of the window: docs/model.md, section 6.
        let whole = 0.03 - 2.0 * 0.564_19 * 20e-6;
        assert!((lengths.iter().sum::<f32>() - whole).abs() < 1e-8);
    }

    #[test]
    fn what_is_wrong_is_told_by_its_key() {
        let laid = laid(1.0);
        let told = |change: fn(&mut Pieces)| {
            let mut pieces = laid.clone();
            change(&mut pieces);
            pieces.texels(20.0, 1.0).unwrap_err().to_string()
        };
        assert!(told(|it| it.ends.truncate(1)).starts_with("ends: found 1 for "));
        assert!(told(|it| it.starts[3][1] = f32::NAN).starts_with("starts: found NaN"));
        assert!(told(|it| it.widths_um[0] = 400.0).starts_with("width_um: found 400"));
    }
}
