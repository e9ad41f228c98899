//! Mistakes in scene files: each ends in one line that names the place, the mistake, and the right form.

use crate::common::{object, scene_with, temporary_dir};
use hairline_document::Loader;

/// Lines 1 to 9 are the camera and the material, line 11 is the first of `rest`.
fn message(rest: &str) -> String {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("empty.csv"), "").unwrap();
    let blank = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'/>";
    std::fs::write(dir.path().join("blank.svg"), blank).unwrap();
    let letters =
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><text y='5'>a</text></svg>";
    std::fs::write(dir.path().join("letters.svg"), letters).unwrap();
    hairline_document::from_toml(&scene_with(rest), "plate.toml", dir.path())
        .map(|_| "it loads".to_owned())
        .unwrap_or_else(|error| error.to_string())
}

fn check(cases: &[(&str, &str)]) {
    for (rest, expected) in cases {
        assert_eq!(message(rest), *expected, "\n{rest}");
    }
}

fn disk() -> String {
    object("{ disk = { radius_m = 0.08 } }")
}

/// A scene with a layer of scratches, whose table's lines are 15 (`[[scratches]]`), 16 (`object`) and on.
fn scratches(rest: &str) -> String {
    message(&format!("{}[[scratches]]\nobject = \"it\"\n{rest}", disk()))
}

/// A scene with a light, whose table's lines are 15 (`[[light]]`) and on.
fn light(rest: &str) -> String {
    message(&format!("{}[[light]]\n{rest}", disk()))
}

#[test]
fn profiles_that_are_none() {
    for (profile, expected) in [
        (
            "\"w\"",
            ": found the text \"w\"; must be one of `rectangle`, `v`, `round`, `shoulders`, or an array of depths",
        ),
        (
            "[1]",
            ": found 1 depths from the middle to the rim; must be from 2 to 64",
        ),
        ("[1, 2]", "[1]: found 2; must be from -1 to 1"),
        (
            "[0, 0]",
            ": found no depth but 0; must have one that is not, such as `[1, 0.5, 0]`",
        ),
    ] {
        let found = scratches(&format!(
            "pattern = \"random\"\ncount = 1\nprofile = {profile}\n"
        ));
        assert_eq!(
            found,
            format!("plate.toml:19: scratches[0].profile{expected}")
        );
    }
}

/// Paths as Windows has them, in the quotes that TOML reads escapes in.
#[test]
fn paths_with_backslashes() {
    check(&[
        (
            "[[object]]\nname = \"it\"\nmesh = \"models\\new.glb\"",
            "plate.toml:13: object[0].mesh: found \"models\\new.glb\", in which `\\n` stands for a control character; write \
             \"models/new.glb\", or 'models\\new.glb' in single quotes, which TOML leaves as it is",
        ),
        (
            "[environment]\nfile = \"C:\\textures\\bright.hdr\"",
            "plate.toml:12: environment.file: found \"C:\\textures\\bright.hdr\", in which `\\t` stands for a control character; write \
             \"C:/textures/bright.hdr\", or 'C:\\textures\\bright.hdr' in single quotes, which TOML leaves as it is",
        ),
    ]);
    for path in [r"models\pan.glb", r"C:\Users\me\pan.glb", r"..\usb\pan.glb"] {
        let unknown = message(&format!("[[object]]\nname = \"it\"\nmesh = \"{path}\""));
        assert!(unknown.starts_with("plate.toml:13: "), "{unknown}");
        assert!(unknown.contains("write paths with slashes"), "{unknown}");
    }
}

#[test]
fn unknown_keys() {
    check(&[
        (
            "[[object]]\nname = \"it\"\nshap = {}",
            "plate.toml:13: object[0].shap: unknown key; did you mean `shape`?",
        ),
        (
            "[[object]]\nname = \"it\"\nshape = { disk = { diameter = 1 } }",
            "plate.toml:13: object[0].shape.disk.diameter: unknown key; the keys here are `radius_m`",
        ),
        (
            "[rendering]\nsize_px = [1, 2]",
            "plate.toml:11: rendering: unknown key; did you mean `render`?",
        ),
        (
            "[render]\ntone_mapping = \"agx\"",
            "plate.toml:12: render.tone_mapping: unknown key; did you mean `tone_map`?",
        ),
        (
            "[[material]]\nname = \"a\"\ntype = \"metal\"\nmetal = \"gold\"",
            "plate.toml:13: material[1].type: unknown key; did you mean `kind`?",
        ),
    ]);
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 1\naxis = [0, 0, 1]"),
        "plate.toml:19: scratches[0].axis: pattern `random` has no such key; it belongs to `circular`, `radial` and `spun`"
    );
    assert_eq!(
        light("kind = \"sphere\"\ntwo_sided = true"),
        "plate.toml:17: light[0].two_sided: kind `sphere` has no such key; it belongs to `disk`, `rectangle` and `polygon`"
    );
}

#[test]
fn wrong_units() {
    check(&[
        (
            "[[object]]\nname = \"it\"\nshape = { disk = { radius_mm = 80 } }",
            "plate.toml:13: object[0].shape.disk.radius_mm: unknown key; did you mean `radius_m = 0.08`?",
        ),
        (
            "[[object]]\nname = \"it\"\nrotation_rad = [0, 0, 1]",
            "plate.toml:13: object[0].rotation_rad: unknown key; did you mean `rotation_deg`?",
        ),
    ]);
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 1\nwidth_nm = 1500.0"),
        "plate.toml:19: scratches[0].width_nm: unknown key; did you mean `width_um = 1.5`?"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ndensity_per_cm2 = 12"),
        "plate.toml:18: scratches[0].density_per_cm2: unknown key; did you mean `density_per_m2 = 120000.0`?"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 1\nlength = { mean = 2 }"),
        "plate.toml:19: scratches[0].length: unknown key; did you mean `length_m`?"
    );
}

#[test]
fn wrong_types() {
    check(&[
        (
            "[[object]]\nname = \"it\"\nshape = { disk = { radius_m = \"8 cm\" } }",
            "plate.toml:13: object[0].shape.disk.radius_m: found the text \"8 cm\"; must be a number (metres)",
        ),
        (
            "[[object]]\nname = 7",
            "plate.toml:12: object[0].name: found the whole number 7; must be a text in quotes",
        ),
        (
            "[[object]]\nname = \"it\"\nmesh = \"a.glb\"\ntranslation_m = [0.0,\n  1.0]",
            "plate.toml:14: object[0].translation_m: found an array of 2; must be an array of 3 numbers",
        ),
        (
            "[[object]]\nname = \"it\"\nmesh = \"a.glb\"\ntranslation_m = [0.0,\n  true, 1.0]",
            "plate.toml:15: object[0].translation_m[1]: found `true`; must be a number (metres)",
        ),
        (
            "[light]\nkind = \"sphere\"",
            "plate.toml:11: light: found a table; must be written `[[light]]`, since there may be several",
        ),
        (
            "[render]\nsize_px = [1280.5, 720]",
            "plate.toml:12: render.size_px[0]: found the number 1280.5; must be a whole number from 0 to 2^63 - 1",
        ),
        (
            "[render]\ntone_map = \"filmic\"",
            "plate.toml:12: render.tone_map: found the text \"filmic\"; must be one of `neutral`, `agx`, `aces` and `none`",
        ),
        (
            "[[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"aluminum\"",
            "plate.toml:14: material[1].metal: found the text \"aluminum\"; did you mean `aluminium`?",
        ),
        (
            "[[material]]\nname = \"m\"\nkind = \"metalic-rougness\"",
            "plate.toml:13: material[1].kind: found the text \"metalic-rougness\"; did you mean `metallic-roughness`?",
        ),
        (
            "[[material]]\nname = \"m\"\nkind = \"metal\"",
            "plate.toml:11: material[1]: found neither `metal` nor `base_color` nor `n_k`; must have exactly one of them",
        ),
        (
            "[[object]]\nname = \"it\"\nshape = { }\nmaterial = \"steel\"",
            "plate.toml:13: object[0].shape: found 0 shapes; must be one, such as `{ disk = { radius_m = 0.1 } }`",
        ),
    ]);
    assert_eq!(
        scratches("pattern = \"random\"\ncount = -5"),
        "plate.toml:18: scratches[0].count: found the whole number -5; must be a whole number from 0 to 2^63 - 1"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 5\ndensity_per_m2 = 5"),
        "plate.toml:15: scratches[0]: found both `count` and `density_per_m2`; must have exactly one of them"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 5\nlength_m = \"long\""),
        "plate.toml:19: scratches[0].length_m: found the text \"long\"; must be a number, or `{ mean = .., spread = .. }`"
    );
    assert_eq!(
        scratches("count = 5"),
        "plate.toml:15: scratches[0]: `pattern` is missing; must be one of `random`, `parallel`, `circular`, `radial`, `spun`, `swirl`, `drawn`, `file`, `curve`, `text` and `svg`"
    );
}

#[test]
fn missing_keys_and_broken_grammar() {
    check(&[(
        "[environment]\nintensity = 1.0",
        "plate.toml:11: environment: found neither `file` nor `builtin`; must have exactly one of them",
    )]);
    let of = |text: &str| {
        hairline_document::from_toml(text, "a.toml", "")
            .unwrap_err()
            .to_string()
    };
    assert_eq!(of(""), "a.toml: `camera` is missing; the scene needs it");
    assert_eq!(
        of("[camera]\nposition_m = [0, 0,\n"),
        "a.toml:2: unclosed array, expected `]`; must be valid TOML (https://toml.io)"
    );
    assert_eq!(
        of("[camera]\nposition_m = [0, 0, 1]\nposition_m = [0, 0, 1]\n"),
        "a.toml:3: duplicate key; must be valid TOML (https://toml.io)"
    );
    for value in ["-0,15", "{ mean = 0,15, spread = 0.1 }"] {
        let said = of(&format!("[camera]\nexposure_ev = {value}\n"));
        assert!(said.starts_with("a.toml:2: "), "{said}");
        assert!(
            said.ends_with("; numbers have a decimal point, not a comma"),
            "{said}"
        );
    }
}

#[test]
fn sizes_that_are_negative_or_not_finite() {
    for (value, found) in [
        ("-0.1", "found -0.1; must be from 1e-5 to 1000"),
        ("0", "found 0; must be from 1e-5 to 1000"),
        ("nan", "found NaN; must be finite"),
        ("inf", "found inf; must be finite"),
        ("-inf", "found -inf; must be finite"),
        ("1e300", "found 1e300; must be from 1e-5 to 1000"),
    ] {
        let shape = format!("{{ sphere = {{ radius_m = {value} }} }}");
        let expected = format!("plate.toml:13: object[0].shape.sphere.radius_m: {found}");
        assert_eq!(message(&object(&shape)), expected);
    }
    check(&[
        (
            &object("{ plane = { size_m = [1.0, -1.0] } }"),
            "plate.toml:13: object[0].shape.plane.size_m[1]: found -1; must be from 1e-5 to 1000",
        ),
        (
            &object("{ lathe = { profile_m = [[0.0, 0.0], [-0.1, 0.0]] } }"),
            "plate.toml:13: object[0].shape.lathe.profile_m[1][0]: found -0.1; must be from 0 to 1000",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"mirror\"\nclearcoat = 1.5",
            "plate.toml:14: material[1].clearcoat: found 1.5; must be from 0 to 1",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"metal\"\nmetal = \"gold\"\ncover = { ior = 0.9 }",
            "plate.toml:15: material[1].cover.ior: found 0.9; must be from 1 to 4",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"metal\"\nbase_color = [1, 1, 1]\ncover = {}",
            "plate.toml:15: material[1].cover: found a plate over a metal that a colour stands for; belongs to `metal` or `n_k`, whose refractive index is known",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"metal\"\nmetal = \"gold\"\nclearcoat = 1\ncover = {}",
            "plate.toml:16: material[1].cover: found a `clearcoat` beside it; leave one of them out",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"mirror\"\nclearcoat_roughness = 0.1",
            "plate.toml:14: material[1].clearcoat_roughness: found no `clearcoat` beside it; add one, such as `clearcoat = 1`",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"metallic-roughness\"\nspecular = 1.5",
            "plate.toml:14: material[1].specular: found 1.5; must be from 0 to 1",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"metallic-roughness\"\nspecular_color = [1.0, -0.5, 1.0]",
            "plate.toml:14: material[1].specular_color[1]: found -0.5; must be from 0 to 1",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"mirror\"\nanisotropy = -0.1",
            "plate.toml:14: material[1].anisotropy: found -0.1; must be from 0 to 1",
        ),
        (
            "[[material]]\nname = \"a\"\nkind = \"mirror\"\nanisotropy_direction_deg = 30.0",
            "plate.toml:14: material[1].anisotropy_direction_deg: found no `anisotropy` beside it; add one, such as `anisotropy = 0.6`",
        ),
        (
            &object("{ box = { size_m = [1.0, 0.2, 0.5], rounding_m = 0.2 } }"),
            "plate.toml:13: object[0].shape.box.rounding_m: found 0.2; must be at most half of the shortest edge: 0.1",
        ),
        (
            &object("{ cylinder = { radius_m = 0.1, height_m = 0, rounding_m = -1 } }"),
            "plate.toml:13: object[0].shape.cylinder.height_m: found 0; must be from 1e-5 to 1000",
        ),
        (
            &object("{ cylinder = { radius_m = 0.1, height_m = 0.3, rounding_m = 0.12 } }"),
            "plate.toml:13: object[0].shape.cylinder.rounding_m: found 0.12; must be at most the radius and half of the height: 0.1",
        ),
        (
            &object("{ torus = { radius_m = 0.1, tube_radius_m = 0.1 } }"),
            "plate.toml:13: object[0].shape.torus.tube_radius_m: found 0.1; must be below `radius_m`, 0.1",
        ),
        (
            &object("{ dome = { radius_m = 0.1, height_m = 0.2 } }"),
            "plate.toml:13: object[0].shape.dome.height_m: found 0.2; must be at most `radius_m`: 0.1",
        ),
        (
            &object("{ sweep = { size_m = [1.0, 0.5], height_m = 1.0, rounding_m = 0.6 } }"),
            "plate.toml:13: object[0].shape.sweep.rounding_m: found 0.6; must be at most `height_m` and the extent along y: 0.5",
        ),
        (
            &format!("{}scale = 0", disk()),
            "plate.toml:15: object[0].scale: found 0; must be from 1e-6 to 1e6, or as much below 0",
        ),
        (
            &format!("{}rotation_deg = [0, nan, 0]", disk()),
            "plate.toml:15: object[0].rotation_deg[1]: found NaN; must be finite",
        ),
        (
            "[render]\nsize_px = [0, 720]",
            "plate.toml:12: render.size_px[0]: found 0; must be from 1 to 16384",
        ),
        (
            "[[material]]\nname = \"m\"\nkind = \"mirror\"\nroughness = 1.5",
            "plate.toml:14: material[1].roughness: found 1.5; must be from 0 to 1",
        ),
    ]);
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, 0, 0]\nradius_m = -1"),
        "plate.toml:18: light[0].radius_m: found -1; must be from 1e-5 to 1000"
    );
    assert_eq!(
        light("kind = \"disk\"\ncenter_m = [0, 0, 1]\ntarget_m = [0, 0, 1]\nradius_m = 1"),
        "plate.toml:18: light[0].target_m: found the light's own middle; must be another point, which the light is to face"
    );
    assert_eq!(
        light("kind = \"rectangle\"\ncenter_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nwidth_m = 1"),
        "plate.toml:15: light[0]: `height_m` is missing; `light[0]` needs it"
    );
    assert_eq!(
        light(
            "kind = \"rectangle\"\ncenter_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nwidth_m = 1\nheight_m = 0"
        ),
        "plate.toml:20: light[0].height_m: found 0; must be from 1e-5 to 1000"
    );
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 1\ncone_deg = 40"),
        "plate.toml:15: light[0]: `target_m` is missing; `light[0]` needs it to know where its cone points"
    );
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 1\ntarget_m = [0, 0, 0]"),
        "plate.toml:19: light[0].target_m: found no cone that it belongs to; give the light a `cone_deg`, or leave it out"
    );
    assert_eq!(
        light(
            "kind = \"disk\"\ncenter_m = [0, 0, 1]\nradius_m = 1\ntarget_m = [0, 0, 0]\ncone_deg = 0"
        ),
        "plate.toml:20: light[0].cone_deg: found 0; must be from 0.1 to 360"
    );
    assert_eq!(
        light(
            "kind = \"disk\"\ncenter_m = [0, 0, 1]\nradius_m = 1\ntarget_m = [0, 0, 0]\ntwo_sided = true\ncone_deg = 30"
        ),
        "plate.toml:21: light[0].cone_deg: found a cone of a light whose two sides shine; leave out `two_sided`, or the cone"
    );
    assert_eq!(
        light(
            "kind = \"disk\"\ncenter_m = [0, 0, 1]\nradius_m = 1\ntarget_m = [0, 0, 0]\nbarn_doors_deg = [30, 30, 95, 30]"
        ),
        "plate.toml:20: light[0].barn_doors_deg[2]: found 95; must be from 0 to 90"
    );
    assert_eq!(
        light(
            "kind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 1\nbarn_doors_deg = [30, 30, 30, 30]"
        ),
        "plate.toml:19: light[0].barn_doors_deg: found barn doors of a sphere light; must be those of a disk or a rectangle that shines to one side"
    );
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 1\npicture = \"box.png\""),
        "plate.toml:19: light[0].picture: found a picture on a sphere light; must be on a rectangle"
    );
    let with_picture = |file: &str| {
        light(&format!(
            "kind = \"rectangle\"\ncenter_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nwidth_m = 1\nheight_m = 1\npicture = \"{file}\""
        ))
    };
    for file in ["missing.png", "missing.hdr"] {
        let message = with_picture(file);
        assert!(
            message.starts_with("plate.toml:21: light[0].picture: ")
                && message.contains(file)
                && message.ends_with(
                    "; must be a .png, .jpg, .webp, .hdr or .exr, relative to the scene file"
                ),
            "{message}"
        );
    }
    let sun = |keys: &str| light(&format!("kind = \"sun\"\n{keys}"));
    assert_eq!(
        sun("angle_deg = 2"),
        "plate.toml:15: light[0]: `direction` is missing; `light[0]` needs it"
    );
    assert_eq!(
        sun("direction = [0, 0, 0]"),
        "plate.toml:17: light[0].direction: found no direction: all three numbers are 0; must point somewhere"
    );
    assert_eq!(
        sun("direction = [0, 0, -1]\nangle_deg = 0"),
        "plate.toml:18: light[0].angle_deg: found 0; must be from 0.01 to 90"
    );
    assert_eq!(
        sun("direction = [0, 0, -1]\nirradiance = -1"),
        "plate.toml:18: light[0].irradiance: found -1; must be 0 or greater"
    );
    for (key, owners) in [
        ("radius_m = 1", "`sphere`, `disk` and `tube`"),
        ("center_m = [0, 0, 1]", "`sphere`, `disk` and `rectangle`"),
        (
            "radiance = 1",
            "`sphere`, `disk`, `rectangle`, `polygon` and `tube`",
        ),
        (
            "visible = true",
            "`sphere`, `disk`, `rectangle`, `polygon` and `tube`",
        ),
        (
            "cone_deg = 30",
            "`sphere`, `disk`, `rectangle`, `polygon` and `tube`",
        ),
    ] {
        let name = key.split(' ').next().unwrap();
        assert_eq!(
            sun(&format!("direction = [0, 0, -1]\n{key}")),
            format!(
                "plate.toml:18: light[0].{name}: kind `sun` has no such key; it belongs to {owners}"
            )
        );
    }
    assert_eq!(
        sun("direction = [0, 0, -1]\nbarn_doors_deg = [30, 30, 30, 30]"),
        "plate.toml:18: light[0].barn_doors_deg: found barn doors of a sun; must be those of a disk or a rectangle that shines to one side"
    );
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, 0, 1]\nradius_m = 1\nirradiance = 1"),
        "plate.toml:19: light[0].irradiance: kind `sphere` has no such key; it belongs to `sun`"
    );
    assert_eq!(
        light("kind = \"tube\"\nends_m = [[0, 0, 1], [0, 0, 1]]\nradius_m = 1"),
        "plate.toml:17: light[0].ends_m: found two equal ends; must be two places; a round lamp is a `sphere`"
    );
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, inf, 0]\nradius_m = 1"),
        "plate.toml:17: light[0].center_m[1]: found inf; must be finite"
    );
    assert_eq!(
        light("kind = \"sphere\"\ncenter_m = [0, 0, 0]\nradius_m = 1\nradiance = -2.5"),
        "plate.toml:19: light[0].radiance: found -2.5; must be 0 or greater"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 5\nwidth_um = { mean = nan, spread = 0.1 }"),
        "plate.toml:19: scratches[0].width_um.mean: found NaN; must be finite"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 5\nwidth_um = -2"),
        "plate.toml:19: scratches[0].width_um: found -2; must be greater than 0 and at most 100"
    );
    assert_eq!(
        scratches("pattern = \"random\"\ncount = 5\ndepth_nm = { mean = 200, spread = -0.1 }"),
        "plate.toml:19: scratches[0].depth_nm.spread: found -0.1; must be from 0 to 3"
    );
    assert_eq!(
        scratches("pattern = \"circular\"\ncount = 5\naxis = [0, 0, 0]"),
        "plate.toml:19: scratches[0].axis: found no direction: all three numbers are 0; must point somewhere"
    );
}

#[test]
fn cameras_that_see_nothing() {
    let of = |keys: &str| {
        let text = format!("[camera]\n{keys}\n{}", disk());
        hairline_document::from_toml(&text, "a.toml", "")
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        of("position_m = [1, 2, 3]\ntarget_m = [1, 2, 3]"),
        "a.toml:3: camera.target_m: found the camera's own position; must be another point, for the camera to look at"
    );
    assert_eq!(
        of("position_m = [0, 0, 3]\ntarget_m = [0, 0, 0]\nup = [0, 0, 1]"),
        "a.toml:4: camera.up: found the direction of view; must be another direction"
    );
    assert_eq!(
        of("position_m = [0, 0, 3]\ntarget_m = [0, 0, 0]\nfov_y_deg = 180"),
        "a.toml:4: camera.fov_y_deg: found 180; must be from 0.001 to 179"
    );
    assert_eq!(
        of("position_m = [0, 0, 3]\ntarget_m = [0, 0, 0]\nsensor_width_mm = 2000"),
        "a.toml:4: camera.sensor_width_mm: found 2000; must be from 0.1 to 1000"
    );
}

#[test]
fn lights_that_are_no_polygons() {
    let polygon = |vertices: &str| light(&format!("kind = \"polygon\"\nvertices_m = {vertices}"));
    let cases = [
        (
            "[[0, 0, 1], [1, 0, 1]]",
            "found 2 vertices; must be at least three",
        ),
        (
            "[[0, 0, 1], [1, 0, 1], [1, 1, 1.5], [0, 1, 1]]",
            "found a polygon that is not planar: vertex 0 (counted from 0) is 2.18e-1 m off its plane; all vertices must lie in one plane; split it into triangles",
        ),
        (
            "[[0, 0, 1], [1, 1, 1], [1, 0, 1], [0, 1, 1]]",
            "found a polygon that crosses itself: the edges after vertices 0 and 2 (counted from 0) meet; its edges must meet at vertices only; reorder the vertices",
        ),
        (
            "[[0, 0, 1], [1, 0, 1], [2, 0, 1]]",
            "found a polygon without area; its vertices must span an area",
        ),
        (
            "[[0, 0, 1], [1, 0, 1], [1, 0, 1], [0, 1, 1]]",
            "found two equal vertices, number 1 and the next (counted from 0); leave one out",
        ),
    ];
    for (vertices, expected) in cases {
        assert_eq!(
            polygon(vertices),
            format!("plate.toml:17: light[0].vertices_m: {expected}")
        );
    }
    assert_eq!(
        polygon("[[0, 0, 1], [1, 0], [0, 1, 1]]"),
        "plate.toml:17: light[0].vertices_m[1]: found an array of 2; must be an array of 3 numbers"
    );
}

#[test]
fn references_to_nothing() {
    check(&[
        (
            "[[object]]\nname = \"it\"\nshape = { disk = { radius_m = 1 } }\nmaterial = \"stele\"",
            "plate.toml:14: object[0].material: found no material called \"stele\"; did you mean \"steel\"?",
        ),
        (
            "[[object]]\nname = \"it\"\nshape = { disk = { radius_m = 1 } }",
            "plate.toml:11: object[0]: `material` is missing; a shape needs one; only a mesh brings its own",
        ),
        (
            "",
            "plate.toml: object: found no object; must have at least one `[[object]]`, or a `[ground]`",
        ),
        (
            &format!("{}{}", disk(), disk()),
            "plate.toml:16: object[1].name: found a second object called \"it\"; names must differ",
        ),
    ]);
    let text = format!(
        "{}[[scratches]]\nobject = \"plate\"\npattern = \"random\"\ncount = 5",
        disk()
    );
    assert_eq!(
        message(&text),
        "plate.toml:16: scratches[0].object: found no object called \"plate\"; must be the name of a `[[object]]`"
    );
}

#[test]
fn files_that_are_not_there() {
    let dir = temporary_dir();
    let path = dir.path().join("gone.toml");
    let message_of_load = hairline_document::load(&path).unwrap_err().to_string();
    assert!(message_of_load.starts_with(&format!("{}: cannot be read (", path.display())));
    assert!(message_of_load.ends_with("; give the path of a scene file (TOML)"));
    let mesh = message("[[object]]\nname = \"it\"\nmesh = \"gone.glb\"");
    assert!(
        mesh.starts_with("plate.toml:13: object[0].mesh: \"gone.glb\": it cannot be read ("),
        "{mesh}"
    );
    assert!(mesh.ends_with(
        "; give the path of a .gltf, .glb, .obj or .stl file, relative to the scene file"
    ));
    let csv = scratches("pattern = \"file\"\nfile = \"gone.csv\"");
    assert!(
        csv.starts_with("plate.toml:18: scratches[0].file: \""),
        "{csv}"
    );
    assert!(
        csv.ends_with("; must be a CSV file, relative to the scene file"),
        "{csv}"
    );
    let map = message(&format!("{}[environment]\nfile = \"gone.hdr\"", disk()));
    assert!(
        map.starts_with("plate.toml:16: environment.file: "),
        "{map}"
    );
}

#[test]
fn maps_in_the_box() {
    let environment = |rest: &str| message(&format!("{}[environment]\n{rest}", disk()));
    assert_eq!(environment("builtin = \"window\""), "it loads");
    assert_eq!(
        environment("builtin = \"studo\""),
        "plate.toml:16: environment.builtin: found the text \"studo\"; did you mean `studio`?"
    );
    assert_eq!(
        environment("builtin = \"sunset\""),
        "plate.toml:16: environment.builtin: found the text \"sunset\"; must be one of `studio`, `window` and `overcast`"
    );
    assert_eq!(
        environment("builtin = \"studio\"\nfile = \"a.hdr\""),
        "plate.toml:15: environment: found both `file` and `builtin`; must have exactly one of them"
    );
    assert_eq!(
        environment("intensity = 2"),
        "plate.toml:15: environment: found neither `file` nor `builtin`; must have exactly one of them"
    );
    assert_eq!(
        environment("built_in = \"studio\""),
        "plate.toml:16: environment.built_in: unknown key; did you mean `builtin`?"
    );
}

#[test]
fn more_scratches_than_memory() {
    // Ten million work, or are refused before they are laid; here the budget decides.
    let text = scene_with(&format!(
        "{}[[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 10_000_000\nlength_m = 0.001",
        disk()
    ));
    let loader = Loader {
        memory_budget_bytes: 1 << 30,
        ..Default::default()
    };
    let started = std::time::Instant::now();
    let message = loader
        .from_toml(&text, "plate.toml", "")
        .unwrap_err()
        .to_string();
    assert!(
        started.elapsed().as_secs_f64() < 3.0,
        "it is refused before it is laid"
    );
    assert!(
        message.starts_with(
            "plate.toml:18: scratches[0].count: found 10000000 scratches, which would take about 2."
        ),
        "{message}"
    );
    assert!(message.contains(" GiB of memory in 1.1e7 segments; there are 1023.8 MiB for them; ask for at most about 4."), "{message}");
    // All layers count together, and a budget for nothing else is not reached by a few.
    let few = text.replace("10_000_000", "1000");
    assert!(loader.from_toml(&few, "plate.toml", "").is_ok());
    let unbounded = text.replace("count = 10_000_000", "density_per_m2 = 1e300");
    let message = loader
        .from_toml(&unbounded, "plate.toml", "")
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("plate.toml:18: scratches[0].density_per_m2: found "),
        "{message}"
    );
}

#[test]
fn strokes() {
    let stroke = |pattern: &str, stroke: &str| {
        scratches(&format!(
            "pattern = {pattern}\nstrokes = [\n  {{ {stroke} }},\n]"
        ))
    };
    let drawn = |rest: &str| stroke("\"drawn\"", rest);
    for (found, expected) in [
        (
            drawn("points_m = [[0, 0, 0]], radius_m = 0.01"),
            "plate.toml:19: scratches[0].strokes[0]: found neither `density_per_m` nor `erase = true`; must have exactly one of them",
        ),
        (
            drawn("points_m = [[0, 0, 0]], radius_m = 0.01, erase = true, width = 2"),
            "plate.toml:19: scratches[0].strokes[0].width: an erasing stroke has no such key; leave it out, or leave out `erase = true`",
        ),
        (
            drawn("points_m = [[0, 0, 0]], radius_mm = 4, density_per_m = 1"),
            "plate.toml:19: scratches[0].strokes[0].radius_mm: unknown key; did you mean `radius_m = 0.004`?",
        ),
        (
            drawn("points_m = [], radius_m = 0.01, density_per_m = 1"),
            "plate.toml:19: scratches[0].strokes[0].points_m: found 0 points; must be from 1 to 65536",
        ),
        (
            drawn("points_m = [[0, 0, 0], [0, nan, 0]], radius_m = 0.01, erase = true"),
            "plate.toml:19: scratches[0].strokes[0].points_m[1][1]: found NaN; must be finite",
        ),
        (
            drawn("points_m = [[0, 0, 0]], radius_m = 0, erase = true"),
            "plate.toml:19: scratches[0].strokes[0].radius_m: found 0; must be from 1e-5 to 1000",
        ),
        (
            drawn("points_m = [[0, 0, 0]], radius_m = 0.01, density_per_m = 1, depth = 0"),
            "plate.toml:19: scratches[0].strokes[0].depth: found 0; must be from 0.01 to 100",
        ),
        (
            stroke(
                "\"random\"\ncount = 1",
                "points_m = [[0, 0, 0]], radius_m = 0.01, density_per_m = 1",
            ),
            "plate.toml:20: scratches[0].strokes[0]: found a stroke that lays scratches in a layer of another pattern than `drawn`; must be `erase = true` here; draw in a layer of its own",
        ),
        (
            scratches("pattern = \"drawn\"\ncount = 5"),
            "plate.toml:18: scratches[0].count: pattern `drawn` has no such key; it belongs to `random`, `parallel`, `circular`, `radial`, `spun` and `swirl`",
        ),
        (
            scratches("pattern = \"drawn\"\njitter_deg = 91"),
            "plate.toml:18: scratches[0].jitter_deg: found 91; must be from 0 to 90",
        ),
        (
            scratches("pattern = \"drawn\"\nhidden = 1"),
            "plate.toml:18: scratches[0].hidden: found the whole number 1; must be `true` or `false`",
        ),
        (
            drawn("points_m = [[0, 0, 0]], radius_m = 0.01, density_per_m = 1e12"),
            "",
        ),
    ] {
        match expected {
            // More than fits into memory.
            "" => assert!(
                found.starts_with("plate.toml:18: scratches[0].strokes: found 20000000000 scratches, which would take about "),
                "{found}"
            ),
            _ => assert_eq!(found, expected),
        }
    }
    // A hidden light is no light, but its numbers are checked.
    assert!(
        light("kind = \"sphere\"\nhidden = true\ncenter_m = [0, 0, 1]\nradius_m = -1")
            .contains("radius_m")
    );
}

#[test]
fn curves_that_are_none() {
    for (rest, expected) in [
        (
            "points_m = [[0, 0, 0]]",
            "18: scratches[0].points_m: found 1 points; must be from 2 to 4096",
        ),
        (
            "points_m = [[0, 0, 0], [0.01, 0, 0]]\nclosed = true",
            "18: scratches[0].points_m: found 2 points; must be from 3 to 4096",
        ),
        (
            "points_m = [[0, 0, 0], [0.01, 1001, 0]]",
            "18: scratches[0].points_m[1][1]: found 1001; must be from -1000 to 1000",
        ),
        (
            "points_m = [[0, 0, 0], [1, 0, 0]]",
            "18: scratches[0].points_m[1]: found a point 92.0 cm off the object; must be at most 22.6 cm off, in metres of the object's own frame",
        ),
        (
            "count = 3",
            "18: scratches[0].count: pattern `curve` has no such key; it belongs to `random`, `parallel`, `circular`, `radial`, `spun` and `swirl`",
        ),
    ] {
        let found = scratches(&format!("pattern = \"curve\"\n{rest}\n"));
        assert_eq!(found, format!("plate.toml:{expected}"));
    }
}

#[test]
fn letters_and_drawings_that_are_none() {
    for (rest, expected) in [
        (
            "pattern = \"text\"\ntext = \" \"\nheight_m = 0.01",
            "18: scratches[0].text: found \" \"; must be 1 to 200, not blank",
        ),
        (
            "pattern = \"text\"\ntext = \"\u{4e00}\"\nheight_m = 0.01",
            "18: scratches[0].text: found \"\u{4e00}\"; must be characters of the font, Ubuntu Light, in one line",
        ),
        (
            "pattern = \"text\"\ntext = \"a\"\nheight_m = 0.01\ndirection = [0, 0, 1]",
            "20: scratches[0].direction: found [0.0, 0.0, 1.0], which stands upright on the surface; must lead along it",
        ),
        (
            "pattern = \"text\"\ntext = \"a\"\nheight_m = 0.01\ncenter_m = [0, 1, 0]",
            "20: scratches[0].center_m: found a point 92.0 cm off the object; must be at most 22.6 cm off, in metres of the object's own frame",
        ),
    ] {
        let found = scratches(&format!("{rest}\n"));
        assert_eq!(found, format!("plate.toml:{expected}"));
    }
    let found = scratches("pattern = \"svg\"\nfile = \"empty.csv\"\nfit_m = 0.01\n");
    assert!(found.contains("empty.csv:1: found no drawing ("), "{found}");
    for (file, why) in [
        ("none.svg", "cannot be read"),
        (
            "letters.svg",
            "has 1 text and no outlines; turn it into paths",
        ),
        ("blank.svg", "has no outlines"),
    ] {
        let rest = format!("pattern = \"svg\"\nfile = \"{file}\"\nfit_m = 0.01\n");
        let found = scratches(&rest);
        assert!(
            found.starts_with("plate.toml:18: scratches[0].file: \""),
            "{found}"
        );
        assert!(found.contains(why), "{found}");
        assert!(found.ends_with(
            "must be an SVG file with shapes, relative to the scene file; letters as paths"
        ));
    }
}
