//! Inputs that once failed. They run first, every time.

use super::case::Case;
use super::originals::scene_with;

/// Inputs of earlier findings.
pub fn all() -> Vec<Case> {
    let plate = "[[object]]\nname = \"plate\"\nshape.disk.radius_m = 0.08\nmaterial = \"steel\"\n";
    let list = format!(
        "{plate}[[scratches]]\nobject = \"plate\"\npattern = \"file\"\nfile = \"list.csv\"\n"
    );
    let header = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n";
    let model = "[[object]]\nname = \"it\"\nmesh = \"a.gltf\"\n".to_owned();
    let points: Vec<_> = (0..2700)
        .map(|i| format!("[0.05, {}]", f64::from(i) * 1e-5))
        .collect();
    let lathe = |points: &str, segments: u32| {
        format!(
            "[[object]]\nname = \"it\"\nshape.lathe = {{ profile_m = [{points}], segments = {segments} }}\nmaterial = \"steel\"\n"
        )
    };
    let lights =
        "[[light]]\nkind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 0.01\n".repeat(60_000);
    let chain: Vec<_> = (0..2000)
        .map(|i| format!("{{\"children\": [{}]}}", i + 1))
        .collect();
    let mut cases = vec![
        // 106 s: one point 45 m off.
        scene(
            "stroke-far-off",
            &(lathe("[0.05, 0.0], [0.06, 0.01]", 4096)
                + "[[scratches]]\nobject = \"it\"\npattern = \"drawn\"\nstrokes = [{ points_m = [[0.05, 0, 0], [0, 45, 0]], radius_m = 0.006, density_per_m = 12000.0 }]\n"),
        ),
        // 10 GB, and 13 GB for a million of these lights.
        scene("large-lathe", &lathe(&points.join(", "), 4096)),
        scene("many-lights", &format!("{plate}{lights}")),
        scene(
            "escape-in-name",
            &format!(
                "{plate}[[object]]\nname = \"a\\u001b[2J\"\nmaterial = \"\\u001b]0;x\\u0007\"\nshape.disk.radius_m = 1\n"
            ),
        ),
    ];
    // 4.6 s, of which all but 0.2 in the triangle tree: boxes that coincide merged a pair a round.
    let disks: String = (0..500)
        .map(|i| format!("[[object]]\nname = \"disk {i}\"\nshape.disk.radius_m = 0.08\nmaterial = \"steel\"\n"))
        .collect();
    cases.push(scene("coincident-disks", &disks));
    // 6 s, of which all but one in the tree of scratches, growing with the square of their number.
    let same = "-0.04,0.01,0,0.05,0.02,0,4.2,130\n".repeat(40_000);
    let cells = [
        ("coincident-scratches", format!("{header}{same}")),
        ("long-cell", format!("{header}{}\n", "9".repeat(5_000_000))),
        (
            "long-cells",
            format!("{header}{},0,0,0,0,0,1,1\n", "x".repeat(5_000_000)),
        ),
        (
            "escape-in-cell",
            format!("{header}\u{1b}[31m,0,0,0,0,0,1,1\n"),
        ),
        ("far-off-in-list", format!("{header}0,0,1e300,0,0,0,1,1\n")),
    ];
    cases.extend(cells.map(|(name, csv)| case_with_file(name, &list, "list.csv", csv)));
    let texts = [
        ("gltf-1.0", r#"{"asset": {"version": "1.0"}, "meshes": {"a": {}}}"#.to_owned()),
        ("gltf-chain", format!(
            r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{}, {{}}]}}"#,
            chain.join(", ")
        )),
        ("gltf-pointer", r#"{"asset": {"version": "2.0"}, "animations": [{"channels": [{"sampler": 0, "target": {"path": "pointer"}}], "samplers": []}]}"#.to_owned()),
        ("gltf-huge-accessor", r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [{"componentType": 5126, "count": 260000000, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}]}"#.to_owned()),
    ];
    cases.extend(texts.map(|(name, text)| case_with_file(name, &model, "a.gltf", text)));
    cases
}

fn scene(name: &str, more: &str) -> Case {
    Case {
        name: format!("found-{name}"),
        files: vec![("scene.toml".to_owned(), scene_with(more).into_bytes())],
    }
}

fn case_with_file(name: &str, more: &str, file: &str, contents: String) -> Case {
    let mut case = scene(name, more);
    case.files.push((file.to_owned(), contents.into_bytes()));
    case
}
