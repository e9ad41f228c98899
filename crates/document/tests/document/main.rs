//! Tests of loading files to scenes.
//! They are one program, since each that is linked takes seconds.

#[path = "../common/mod.rs"]
mod common;

mod bad_input;
mod baked;
mod builder;
mod description;
mod draco;
mod engraved;
mod gltf;
mod gltf_scene;
mod left_out;
mod lights;
mod listed;
mod looks;
mod meshopt;
mod other_formats;
mod places;
mod poses;
mod probe;
mod scene_looks;
mod schema;
mod scratch_studio;
mod scratches;
mod strokes;
mod studio;
mod subject;
mod usdz;
mod wild_meshes;
