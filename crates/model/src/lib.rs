//! Turns a glTF file into triangles, materials and textures, and tells what of it is left out. OBJ and STL files are made into glTF first. Nothing here knows of scratches: `hairline-document` lays
//! them on what a file gives.

#![warn(unreachable_pub)]

pub mod flaw;
pub mod gltf_file;
mod jpeg_end;
mod ktx2;
pub mod material;
pub mod mesh;
pub mod mesh_file;
mod other_formats;
pub mod packed;
pub mod reading;
pub mod surface;
pub mod text;
pub mod texture;
pub mod texture_lookup;
