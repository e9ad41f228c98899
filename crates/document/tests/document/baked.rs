//! Scratches drawn into the maps of a model.

use std::path::Path;

use hairline_document::export::Export;
use hairline_document::{Description, Error, Loader, from_toml};
use hairline_scene::Scene;

use crate::common::{object, scene_with, temporary_dir};

const PLANE_M: f64 = 0.01;
const ROUGHNESS: f64 = 0.1;

/// A model of a square plate with its scratches in maps of so many texels a side, opened again.
fn baked(text: &str, dir: &Path, size_px: u32) -> Result<Scene, Error> {
    let description = Description::from_toml(text, "s.toml".as_ref())?;
    let export = Export {
        bake_px: Some(size_px),
        ..Export::default()
    };
    let exported = Loader::default().export(&description, dir, export)?;
    std::fs::write(dir.join("baked.glb"), exported.bytes).unwrap();
    let object = "[[object]]\nname = \"it\"\nmesh = \"baked.glb\"\n";
    from_toml(&scene_with(object), "baked.toml", dir)
}

/// A square plate with scratches of one width and depth.
fn plate(scratches: &str) -> String {
    let plate = object(&format!(
        "{{ plane = {{ size_m = [{PLANE_M}, {PLANE_M}] }} }}"
    ));
    let scratches = format!("[[scratches]]\nobject = \"it\"\n{scratches}\n");
    let text = scene_with(&(plate + &scratches));
    text.replace(
        "metal = \"steel\"",
        &format!("metal = \"steel\"\nroughness = {ROUGHNESS}"),
    )
}

/// Mean over the maps of the square of the slopes that the normal map has, and of alpha squared beyond the plate's own.
fn mean_squares(scene: &Scene) -> [f64; 2] {
    let material = &scene.materials[scene.objects[0].mesh.triangle_materials[0] as usize];
    let texels = |number: usize| scene.textures[number].levels[0].iter();
    let (normals, _) = material.normal_texture.unwrap();
    let count = texels(normals).len() as f64;
    let slope2 = texels(normals).map(|[x, y, z, _]| {
        let [x, y, z] = [x, y, z].map(|code| f64::from(*code) - 128.0);
        (x * x + y * y) / (z * z)
    });
    let rough = texels(material.metallic_roughness_texture.unwrap());
    let alpha2 = rough.map(|texel| (material.roughness * f64::from(texel[1]) / 255.0).powi(4));
    let widened = alpha2.map(|it| it - ROUGHNESS.powi(4));
    [slope2.sum::<f64>() / count, widened.sum::<f64>() / count]
}

/// The maps hold the slopes of all scratches: the mean square of a V's is (2 d / W)^2, a parabola's 4/3 of it, each on the area that they cover. Narrow
/// scratches are finer than a texel; the wide ones cover four.
#[test]
fn maps_hold_the_mean_square_slope_of_the_scratches() {
    let dir = temporary_dir();
    for (profile, factor, width_um, finer) in [
        ("v", 1.0, 5.0, true),
        ("round", 4.0 / 3.0, 5.0, true),
        ("rectangle", 1.0, 5.0, true),
        ("v", 1.0, 80.0, false),
        ("round", 4.0 / 3.0, 80.0, false),
    ] {
        let depth_nm = f64::min(100.0 * width_um, 2000.0);
        let text = plate(&format!(
            "pattern = \"random\"\ncount = 100\nlength_m = 0.003\nprofile = \"{profile}\"\nwidth_um = {width_um:?}\ndepth_nm = {depth_nm:?}"
        ));
        let laid = from_toml(&text, "s.toml", dir.path()).unwrap();
        let object = &laid.objects[0];
        let covered = object
            .scratches
            .iter()
            .map(|scratch| f64::from(object.covered_um_m(scratch)));
        let share = 1e-6 * covered.sum::<f64>() / PLANE_M.powi(2);
        let slope = 2e-3 * depth_nm / width_um;
        let expected = factor * slope * slope * share;
        let size_px = if finer { 128 } else { 512 };
        let [drawn, widened] = mean_squares(&baked(&text, dir.path(), size_px).unwrap());
        let error = (drawn + widened) / expected - 1.0;
        assert!(
            error.abs() < 0.03,
            "{profile}, {width_um} um: {drawn} + {widened}, {expected}"
        );
        assert_eq!(drawn < widened, finer, "{profile}, {width_um} um");
    }
}

/// Of one wide groove along x the normals lean to its middle, from both sides.
#[test]
fn walls_of_a_wide_scratch_lean_to_its_middle() {
    let dir = temporary_dir();
    let text = plate(
        "pattern = \"curve\"\npoints_m = [[-0.004, 0.001, 0], [0.004, 0.001, 0]]\nprofile = \"v\"\nwidth_um = 90.0\ndepth_nm = 2000.0",
    );
    let scene = baked(&text, dir.path(), 512).unwrap();
    let material = &scene.materials[scene.objects[0].mesh.triangle_materials[0] as usize];
    let (normals, _) = material.normal_texture.unwrap();
    let rows = scene.textures[normals].levels[0].chunks(512);
    let greens: Vec<i32> = rows.map(|row| i32::from(row[256][1]) - 128).collect();
    // Its middle is 4 of 10 mm below the upper edge. A slope of 2 d / W = 0.044 is 5.6 codes.
    assert!([-5, -6].contains(&greens[203]), "{:?}", &greens[200..210]);
    assert!([5, 6].contains(&greens[206]), "{:?}", &greens[200..210]);
    let far = greens[..202].iter().chain(&greens[208..]);
    assert!(far.copied().all(|it| it == 0));
    let mut reds = scene.textures[normals].levels[0].iter().map(|it| it[0]);
    assert!(reds.all(|it| it == 128));
}

#[test]
fn scratches_in_a_coat_are_in_its_maps() {
    let dir = temporary_dir();
    let text = plate("pattern = \"random\"\ncount = 100")
        .replace("roughness =", "clearcoat = 0.7\nroughness =");
    let scene = baked(&text, dir.path(), 64).unwrap();
    let material = &scene.materials[scene.objects[0].mesh.triangle_materials[0] as usize];
    assert!(material.normal_texture.is_none() && (material.roughness - ROUGHNESS).abs() < 1e-6);
    let coat = material.coat.unwrap();
    assert!((coat.weight - 0.7).abs() < 1e-6 && coat.roughness > 0.0);
    assert!(material.coat_normal_texture.is_some() && material.coat_textures[1].is_some());
}

#[test]
fn coordinates_that_overlap_are_named() {
    let dir = temporary_dir();
    let cube = object("{ box = { size_m = [0.02, 0.02, 0.02] } }");
    let text =
        scene_with(&(cube + "[[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 50\n"));
    let told = baked(&text, dir.path(), 64).unwrap_err().to_string();
    assert!(
        told.contains("object \"it\" has texture coordinates of which 83 % lie on one another"),
        "{told}"
    );
    // What has no scratches needs none.
    let plain = text.replace("count = 50", "count = 0");
    assert!(baked(&plain, dir.path(), 64).is_ok());
}
