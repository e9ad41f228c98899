//! What a scene is about, for programs that know no scratches: triangles and their materials.

mod bake;
mod glb;
mod model;
mod parts;
mod pictures;
mod usd;
mod zip;

pub(crate) use model::PlainModel;
