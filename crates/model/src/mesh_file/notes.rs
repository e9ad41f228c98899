//! Notes on a file for its author.

use glam::DVec3;

/// `middle_m` is that of a file that was put at the origin.
pub(super) fn moved(middle_m: DVec3) -> String {
    format!(
        "it stands {:.3e} m from its own origin, where no scene reaches; its middle is taken for the origin",
        middle_m.length()
    )
}

/// A set of texture coordinates, and the number of primitives that lack it.
pub(super) fn missing_set((set, count): (u32, usize)) -> String {
    let have = if count == 1 {
        "primitive has"
    } else {
        "primitives have"
    };
    format!(
        "{count} {have} no TEXCOORD_{set}, by which images of their materials lie; all of them show the place (0, 0) of these"
    )
}

/// The number of triangles that were turned.
pub(super) fn turned(count: usize) -> String {
    let are = if count == 1 {
        "triangle is"
    } else {
        "triangles are"
    };
    format!(
        "{count} {are} wound against the normals of their vertices; the normals say which side is outside"
    )
}
