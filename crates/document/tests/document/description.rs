//! Scene files: saved scenes load again, the documented example works, defaults are those of the documentation.

use std::path::Path;

use crate::common::{asset, scene_with, temporary_dir};
use hairline_document::description;
use hairline_document::description::*;
use hairline_image::ToneMap;
use hairline_optics::metal::Metal;
use hairline_optics::section::Section;
use hairline_scene::{Anisotropy, Base, Coat, Specular};

const EXAMPLE: &str = include_str!("../example.toml");

fn parsed(text: &str) -> Description {
    Description::from_toml(text, Path::new("test.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn the_example_of_the_documentation_works() {
    let description = parsed(EXAMPLE);
    assert_eq!(description.camera.fov_y_deg, 28.0);
    let dir = temporary_dir();
    let scene = match asset("studio.hdr") {
        Some(map) => {
            std::fs::copy(map, dir.path().join("studio.hdr")).unwrap();
            std::fs::write(dir.path().join("example.toml"), EXAMPLE).unwrap();
            hairline_document::load(dir.path().join("example.toml"))
        }
        None => {
            let without = Description {
                environment: None,
                ..description
            };
            hairline_document::build(&without, dir.path())
        }
    }
    .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.render.size_px, [1280, 720]);
    assert_eq!(scene.render.tone_map, ToneMap::Neutral);
    assert_eq!(scene.materials[0].base, Base::Metal(Metal::Iron.into()));
    assert_eq!(scene.lights.len(), 2);
    assert_eq!(scene.lights[0].radiance, [40.0, 0.96 * 40.0, 0.9 * 40.0]);
    assert_eq!(scene.objects[0].scratches.len(), 10_000);
    assert!(
        scene.camera.up.z == 1.0 && (scene.camera.fov_y_rad - 28f64.to_radians()).abs() < 1e-15
    );
}

/// A scene that was written on Windows is read elsewhere.
#[test]
fn backslashes_part_folders() {
    for (written, path) in [
        (r"maps\new\sky.hdr", "maps/new/sky.hdr"),
        (r"..\sky.hdr", "../sky.hdr"),
        (r"C:\maps\sky.hdr", "C:/maps/sky.hdr"),
        (r"\\server\maps\sky.hdr", r"\\server\maps\sky.hdr"),
    ] {
        let text = EXAMPLE.replace("\"studio.hdr\"", &format!("'{written}'"));
        let read = parsed(&text);
        let map = read.environment.unwrap().map;
        assert_eq!(map, Map::File(path.into()));
    }
}

#[test]
fn the_example_loads_again_after_it_was_saved() {
    let description = parsed(EXAMPLE);
    assert_eq!(parsed(&description.to_toml().unwrap()), description);
}

/// Every variant of everything, with numbers that are hard to write down.
fn everything() -> Description {
    let around = PatternAxis {
        axis: [0.0, -1.0, 1e-3],
        center_m: [0.1 + 0.2, -0.0, 1e-17],
        jitter_deg: 89.9,
    };
    let drawn = |mean, spread| Distribution { mean, spread };
    let patterns = [
        Pattern::Random {
            curvature_per_m: drawn(-1.0 / 3.0, 4.0),
        },
        Pattern::Parallel {
            direction: [1.0, 2.0, 3.0],
            jitter_deg: 0.0,
        },
        Pattern::Circular(around),
        Pattern::Radial(PatternAxis::default()),
        Pattern::Spun {
            around,
            curvature_per_m: drawn(0.0, 0.0),
        },
        Pattern::Swirl {
            curvature_per_m: drawn(1e4, 1e-300),
        },
    ];
    let amounts = [
        Amount::Count(0),
        Amount::Count(i64::MAX as u64),
        Amount::DensityPerM2(1e22),
    ];
    let mut scratches: Vec<_> = patterns
        .into_iter()
        .zip(amounts.into_iter().cycle())
        .map(|(pattern, amount)| {
            Scratches::new(
                "an \"odd\" name\n[äöü] = #",
                Layer::Laid(Laid {
                    pattern,
                    amount,
                    seed: 12_345_678_901_234,
                    length_m: drawn(f64::MIN_POSITIVE, 0.5),
                    width_um: drawn(1.5, 0.0),
                    depth_nm: drawn(200.0, 1e-9),
                }),
            )
        })
        .collect();
    scratches.push(Scratches::new(
        "",
        Layer::Listed(Listed {
            file: "dir with spaces/it's.csv".into(),
        }),
    ));
    scratches.push(Scratches {
        name: Some("drawn, \"by hand\"\n".to_owned()),
        profile: Section::Listed([1.0, 1.0 / 3.0, -0.5].into()),
        hidden: true,
        solo: true,
        strokes: vec![
            Stroke {
                points_m: vec![[1.0 / 3.0, -0.0, 1e-17], [0.0; 3]],
                radius_m: 0.004,
                brush: Brush::Paint {
                    density_per_m: 2e4,
                    width: 1.0,
                    depth: 0.7,
                },
            },
            Stroke {
                points_m: vec![[0.0; 3]],
                radius_m: 1e-5,
                brush: Brush::Erase,
            },
        ],
        ..Scratches::new("o", Layer::Brushed(Brushed::default()))
    });
    let kinds = Metal::ALL
        .iter()
        .map(|metal| MaterialKind::Metal(MetalColor::Measured(*metal)))
        .chain([
            MaterialKind::Metal(MetalColor::Color([0.25, 0.5, 1.0])),
            MaterialKind::Dielectric {
                ior: 1.33,
                base_color: [0.1; 3],
            },
            MaterialKind::MetallicRoughness {
                base_color: [0.2; 3],
                metallic: 0.7,
                specular: Specular {
                    weight: 0.5,
                    color: [1.0, 0.5, 0.25],
                },
            },
            MaterialKind::Mirror,
        ]);
    let surfaces = [
        Surface::Shape(Shape::Plane {
            size_m: [1.0, 1.0 / 7.0],
        }),
        Surface::Shape(Shape::Disk { radius_m: 5.0 }),
        Surface::Shape(Shape::Sphere { radius_m: 1e-5 }),
        Surface::Shape(Shape::Lathe {
            profile_m: vec![[0.0, 1.0], [2.0, -3.0], [4.5, 0.0]],
            segments: 3,
            smooth: false,
        }),
        Surface::Mesh("../models/a.glb".into()),
    ];
    Description {
        camera: Camera {
            of_file: None,
            position_m: [1.0, 2.0, 3.0],
            target_m: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_y_deg: 45.5,
            exposure_ev: -2.5,
            sensor_width_mm: Some(24.0),
            aperture_mm: Some(1.5),
            focus_distance_m: Some(0.25),
            shift: Some([0.1, -0.2]),
            world_up: Some(Up::Z),
        },
        render: Render {
            size_px: [1, 16_384],
            filter_std_px: 0.7,
            tone_map: ToneMap::Agx,
            transparent: true,
            behind: Some("sky.png".into()),
            png_bits: 16,
        },
        environment: Some(Environment {
            map: Map::File("a.exr".into()),
            rotation_deg: -720.5,
            intensity: 0.0,
            visible: false,
        }),
        studio: Studio {
            hidden: true,
            intensity: 0.5,
            rotation_deg: 12.0,
        },
        ground: Some(Ground {
            color: [0.4; 3],
            height_m: Some(-0.5),
            shadows_only: true,
            ..Ground::default()
        }),
        materials: kinds
            .enumerate()
            .map(|(i, kind)| Material {
                name: format!("material {i}"),
                kind,
                roughness: 0.3,
                coherence_um: 20.0,
                coat: (i % 2 == 1).then_some(Coat {
                    weight: 0.5,
                    roughness: 0.1,
                }),
                anisotropy: (i % 3 == 1).then_some(Anisotropy {
                    strength: 0.6,
                    direction_deg: 30.0,
                }),
                cover: (i == 0).then_some(Cover {
                    ior: 1.49,
                    thickness_mm: 0.1 + 0.2,
                    color: [0.9, 0.8, 0.7],
                }),
            })
            .collect(),
        objects: surfaces
            .into_iter()
            .enumerate()
            .map(|(i, surface)| Object {
                name: format!("object {i}"),
                up: match surface {
                    Surface::Mesh(_) => Up::Z,
                    Surface::Shape(_) => Up::Y,
                },
                fit_m: matches!(surface, Surface::Mesh(_)).then_some(0.2),
                time_s: matches!(surface, Surface::Mesh(_)).then_some(1.5),
                animation: matches!(surface, Surface::Mesh(_)).then(|| "walk".to_owned()),
                overrides: match surface {
                    Surface::Mesh(_) => overrides(),
                    Surface::Shape(_) => Vec::new(),
                },
                material: match surface {
                    Surface::Mesh(_) => None,
                    Surface::Shape(_) => (i % 2 == 0).then(|| "material 0".to_owned()),
                },
                surface,
                translation_m: [0.0, 1.0, 2.0],
                rotation_deg: [10.0, 20.0, 30.0],
                scale: if i == 1 { [2.0; 3] } else { [1.0, -2.0, 3.0] },
                hidden: i == 2,
            })
            .collect(),
        scratches,
        gratings: vec![
            Grating::new(
                "object 0",
                GroovePattern::Parallel {
                    direction: [0.0, 1.0, 0.0],
                    jitter_deg: 0.5,
                },
                0.74,
            ),
            Grating {
                name: Some("track".into()),
                hidden: true,
                width_um: 0.5,
                depth_nm: Distribution {
                    mean: 110.0,
                    spread: 0.25,
                },
                jitter_um: 0.125,
                seed: 9,
                coverage: 0.75,
                radius_m: Some([0.0, 0.5]),
                ..Grating::new(
                    "object 1",
                    GroovePattern::Circular(PatternAxis::default()),
                    1.6,
                )
            },
        ],
        lights: vec![
            Light {
                name: None,
                hidden: false,
                visible: true,
                kind: LightKind::Sphere {
                    center_m: [0.0; 3],
                    radius_m: 0.5,
                },
                radiance: 0.0,
                exposure_ev: 0.0,
                temperature_k: None,
                color: [1.0; 3],
                cone: Some(Cone {
                    cone_deg: 30.0,
                    cone_softness: 0.5,
                    target_m: Some([1.0, 2.0, 3.0]),
                }),
                barn_doors_deg: None,
                picture: None,
            },
            Light {
                name: None,
                hidden: false,
                visible: false,
                kind: LightKind::Polygon {
                    vertices_m: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
                    two_sided: true,
                },
                radiance: 1e30,
                exposure_ev: -2.5,
                temperature_k: Some(3200.0),
                color: [0.1, 0.2, 0.3],
                cone: None,
                barn_doors_deg: None,
                picture: None,
            },
            Light::new(LightKind::Disk {
                center_m: [0.0, 0.0, 1.0],
                target_m: [0.5, 0.0, 0.0],
                radius_m: 0.25,
                two_sided: true,
            }),
            Light::new(LightKind::Tube {
                ends_m: [[0.0, 0.0, 1.0], [0.0, 0.5, 1.0]],
                radius_m: 0.125,
            }),
            Light::new(LightKind::Sun {
                direction: [0.5, 0.0, -2.0],
                angle_deg: 1.5,
                irradiance: 0.25,
            }),
            Light::new(LightKind::Rectangle {
                center_m: [0.0, 0.0, 1.0],
                target_m: [0.5, 0.0, 0.0],
                width_m: 0.25,
                height_m: 3.0,
                rotation_deg: -30.0,
                two_sided: false,
            }),
        ],
        looks: Vec::new(),
        lights_of: None,
        notes: Vec::new(),
    }
}

/// The same with looks: one of all that a look keeps, and one of a name alone.
fn everything_with_looks() -> Description {
    let mut it = everything();
    let all = Look {
        exposure_ev: Some(0.5),
        studio: Some(Studio::default()),
        ..Look::from_description("all".to_owned(), &it)
    };
    let none = Look {
        name: "none \"quoted\"".to_owned(),
        camera: None,
        exposure_ev: None,
        environment: None,
        studio: None,
        lights: Vec::new(),
    };
    it.looks = vec![all, none];
    it
}

#[test]
fn whatever_is_saved_loads_again_to_the_same() {
    let everything = everything_with_looks();
    let text = everything.to_toml().unwrap();
    assert_eq!(parsed(&text), everything, "{text}");
    let mut least = everything;
    least.environment = None;
    least.render = Render::default();
    least.materials.clear();
    least.objects.clear();
    least.scratches.clear();
    least.gratings.clear();
    least.lights.clear();
    least.looks.clear();
    assert_eq!(parsed(&least.to_toml().unwrap()), least);
}

mod round_trip {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = [f64; 3]> {
        [number(), number(), number()]
    }

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![any::<f64>(), -10.0..10.0f64, Just(0.1 + 0.2)]
            .prop_filter("TOML writes NaN without its sign and payload", |x| {
                !x.is_nan()
            })
    }

    proptest! {
        /// Any numbers and names, in range or not: form is checked when reading, ranges when building.
        #[test]
        fn any_numbers_and_names_survive(
            [position, target, up, axis, center] in [vector(), vector(), vector(), vector(), vector()],
            [mean, spread, radiance] in [number(), number(), number()],
            name in ".*",
            vertices in prop::collection::vec(vector(), 0..5),
            seed in 0..i64::MAX as u64,
        ) {
            let mut it = everything();
            it.camera.position_m = position;
            it.camera.target_m = target;
            it.camera.up = up;
            it.objects[0].name = name.clone();
            it.objects[0].scale = center;
            it.materials[0].name = name.clone();
            it.scratches[2] = Scratches::new(name, Layer::Laid(Laid {
                    pattern: Pattern::Spun {
                        around: PatternAxis { axis, center_m: center, jitter_deg: spread },
                        curvature_per_m: Distribution { mean, spread },
                    },
                    amount: Amount::DensityPerM2(mean),
                    seed,
                    length_m: Distribution { mean, spread },
                    width_um: Distribution { mean: spread, spread: 0.0 },
                    depth_nm: Distribution { mean, spread },
                }));
            it.lights[1].radiance = radiance;
            it.lights[1].kind = LightKind::Polygon { vertices_m: vertices, two_sided: false };
            prop_assert_eq!(parsed(&it.to_toml().unwrap()), it);
        }
    }
}

#[test]
fn defaults_are_those_of_the_documentation() {
    let text = r#"
        [camera]
        position_m = [0, 0, 1]
        target_m = [0, 0, 0]
        [environment]
        file = "a.hdr"
        [[material]]
        name = "m"
        kind = "dielectric"
        [[object]]
        name = "o"
        shape = { lathe = { profile_m = [[0, 0], [1, 0]] } }
        material = "m"
        [[scratches]]
        object = "o"
        pattern = "spun"
        count = 1
        [[light]]
        kind = "polygon"
        vertices_m = []
    "#;
    let it = parsed(text);
    assert_eq!(it.render, Render::default());
    assert_eq!(
        (it.render.size_px, it.render.filter_std_px),
        ([1280, 720], 0.5)
    );
    assert_eq!(
        (it.camera.up, it.camera.fov_y_deg, it.camera.exposure_ev),
        ([0.0, 1.0, 0.0], 30.0, 0.0)
    );
    let environment = it.environment.unwrap();
    assert_eq!(
        (
            environment.rotation_deg,
            environment.intensity,
            environment.visible
        ),
        (0.0, 1.0, true)
    );
    assert_eq!(
        (it.materials[0].roughness, it.materials[0].coherence_um),
        (0.1, 20.0)
    );
    let kind = MaterialKind::Dielectric {
        ior: 1.5,
        base_color: [0.5; 3],
    };
    assert_eq!(it.materials[0].kind, kind);
    let object = &it.objects[0];
    assert_eq!(
        (object.translation_m, object.rotation_deg, object.scale),
        ([0.0; 3], [0.0; 3], [1.0; 3])
    );
    assert!(matches!(
        object.surface,
        Surface::Shape(Shape::Lathe {
            segments: 256,
            smooth: true,
            ..
        })
    ));
    let drawn = |mean, spread| Distribution { mean, spread };
    let laid = Laid {
        pattern: Pattern::Spun {
            around: PatternAxis {
                axis: [0.0, 0.0, 1.0],
                center_m: [0.0; 3],
                jitter_deg: 0.0,
            },
            curvature_per_m: drawn(20.0, 0.0),
        },
        amount: Amount::Count(1),
        seed: 1,
        length_m: drawn(0.02, 0.5),
        width_um: drawn(1.5, 0.3),
        depth_nm: drawn(200.0, 0.2),
    };
    assert_eq!(it.scratches[0].layer, description::Layer::Laid(laid));
    assert_eq!((it.lights[0].radiance, it.lights[0].color), (1.0, [1.0; 3]));
}

#[test]
fn long_work_reports_its_progress() {
    let text = scene_with(
        "[[object]]\nname = \"it\"\nshape = { disk = { radius_m = 0.1 } }\nmaterial = \"steel\"\n[[scratches]]\nobject = \"it\"\npattern = \"random\"\ncount = 100000\n",
    );
    let seen = std::cell::RefCell::new(Vec::new());
    let loader = hairline_document::Loader {
        progress: &|progress| seen.borrow_mut().push(progress),
        ..Default::default()
    };
    loader.from_toml(&text, "test.toml", "").unwrap();
    let seen = seen.into_inner();
    let scratches: Vec<_> = seen
        .iter()
        .filter(|p| p.stage == hairline_document::Stage::Scratches)
        .collect();
    assert!(scratches.len() > 2);
    assert!(scratches.windows(2).all(|pair| pair[0].done < pair[1].done));
    assert!(scratches.iter().all(|p| p.total == 100_000));
    assert_eq!(scratches.last().unwrap().done, 100_000);
}

#[test]
fn keys_of_render_say_what_is_right() {
    let message = |line: &str| {
        let text = scene_with(&format!("[render]\n{line}\n"));
        let read = Description::from_toml(&text, Path::new("a.toml"));
        read.unwrap_err().to_string()
    };
    let bits = message("png_bits = \"16\"");
    assert!(bits.ends_with("must be 8 or 16"), "{bits}");
    let keys = message("quality = 3");
    assert!(
        keys.contains("png_bits") && !keys.contains("gather"),
        "{keys}"
    );
}

/// `gather` was a key of earlier versions: files that have it load, and say that it has no effect.
#[test]
fn a_key_without_effect_is_noted() {
    let text = "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\n\
                [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
                [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.08 } }\n";
    let without = hairline_document::from_toml(text, "old.toml", "").unwrap();
    assert!(without.notes.is_empty());
    let text = format!("{text}[render]\nsize_px = [64, 32]\ngather = \"clusters\"\n");
    let scene = hairline_document::from_toml(&text, "old.toml", "").unwrap();
    assert_eq!(
        scene.notes,
        [
            "old.toml:14: render.gather: this key has no effect any more; every scratch counts for itself"
        ]
    );
    // The saved file has no such key.
    let description = Description::from_toml(&text, Path::new("old.toml")).unwrap();
    assert!(!description.to_toml().unwrap().contains("gather"));
}

#[test]
fn a_roughness_that_makes_no_difference_is_noted() {
    let scene = |roughness: f64| {
        let text = scene_with(&format!(
            "[[material]]\nname = \"smooth\"\nkind = \"metal\"\nmetal = \"silver\"\nroughness = {roughness}\n"
        ));
        let description = Description::from_toml(&text, Path::new("a.toml")).unwrap();
        description.notes.join("\n")
    };
    assert_eq!(scene(0.05), "");
    let note = scene(0.03);
    assert!(note.starts_with("a.toml:"), "{note}");
    assert!(
        note.contains(".roughness: 0.03 looks as 0.045 does, which is the smoothest"),
        "{note}"
    );
}

#[test]
fn a_lens_is_one_state_with_the_field_of_view() {
    const SIZE_PX: [u32; 2] = [1200, 800];
    let text = "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nfocal_length_mm = 50\nf_stop = 4\n[render]\nsize_px = [1200, 800]\n";
    let mut camera = Description::from_toml(text, Path::new("a.toml"))
        .unwrap()
        .camera;
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    assert!(near(camera.focal_length_mm(SIZE_PX), 50.0));
    assert!(near(camera.f_stop(SIZE_PX).unwrap(), 4.0));
    // A zoom lens keeps its f-stop.
    camera.set_focal_length_mm(100.0, SIZE_PX);
    assert!(near(camera.fov_y_deg, 2.0 * 0.12_f64.atan().to_degrees()));
    assert!(near(camera.aperture_mm.unwrap(), 25.0));
    // Another film sees more or less through the same lens.
    camera.set_sensor_width_mm(18.0, SIZE_PX);
    assert!(near(camera.fov_y_deg, 2.0 * 0.06_f64.atan().to_degrees()));
    assert!(near(camera.focal_length_mm(SIZE_PX), 100.0));
    assert!(near(camera.f_stop(SIZE_PX).unwrap(), 4.0));
    camera.set_f_stop(8.0, SIZE_PX);
    assert!(near(camera.aperture_mm.unwrap(), 12.5));
    // The whole of the ranges stays a camera.
    for focal_length_mm in [0.1, 1e4] {
        camera.set_focal_length_mm(focal_length_mm, SIZE_PX);
        camera.set_f_stop(0.1, SIZE_PX);
        assert!(
            hairline_document::description::Camera::FOV_Y_DEG
                .bounds
                .ends()
                .contains(&camera.fov_y_deg)
        );
        assert!(
            hairline_document::description::Camera::APERTURE_MM
                .bounds
                .ends()
                .contains(&camera.aperture_mm.unwrap())
        );
    }
}

#[test]
fn a_lens_gives_the_field_of_view() {
    let scene = |lens: &str| {
        let text = format!(
            "[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\n{lens}\n[render]\nsize_px = [1200, 800]\n"
        );
        Description::from_toml(&text, Path::new("a.toml"))
    };
    let fov_y_deg = |lens: &str| {
        scene(lens)
            .unwrap_or_else(|e| panic!("{e}"))
            .camera
            .fov_y_deg
    };
    // 36 mm by 24 mm: 2 atan(12 / 50), and as lenses say it.
    assert!((fov_y_deg("focal_length_mm = 50") - 26.991_466).abs() < 1e-6);
    let half = fov_y_deg("focal_length_mm = 50\nsensor_width_mm = 18");
    assert!((half - 2.0 * 0.12_f64.atan().to_degrees()).abs() < 1e-9);
    // Both, where they agree.
    assert_eq!(fov_y_deg("focal_length_mm = 50\nfov_y_deg = 27"), 27.0);
    let aperture_mm = |lens: &str| scene(lens).unwrap().camera.aperture_mm;
    assert_eq!(aperture_mm("focal_length_mm = 50\nf_stop = 4"), Some(12.5));
    assert_eq!(aperture_mm("aperture_mm = 3"), Some(3.0));
    for (lens, message) in [
        (
            "f_stop = 4",
            "a.toml:4: camera.f_stop: found no `focal_length_mm` that it belongs to; give the camera one, or `aperture_mm` in place of the f-stop",
        ),
        (
            "focal_length_mm = 50\nf_stop = 4\naperture_mm = 10",
            "a.toml:6: camera.aperture_mm: found 10; 50 mm at f/4 have an opening of 12.500 mm; leave out one of them",
        ),
        (
            "focus_distance_m = 0.3",
            "a.toml:4: camera.focus_distance_m: found no opening that it belongs to; give the camera an `aperture_mm` or an `f_stop`, or leave it out: all is in focus then",
        ),
        (
            "focal_length_mm = 50\nfov_y_deg = 40",
            "a.toml:5: camera.fov_y_deg: found 40; 50 mm before a sensor 36 mm wide see 26.99 degrees of 1200 x 800 pixels; leave out one of them",
        ),
        (
            "focal_length_mm = 0",
            "a.toml:4: camera.focal_length_mm: found 0; must be from 0.1 to 10000",
        ),
        (
            "focal_length_mm = \"50mm\"",
            "a.toml:4: camera.focal_length_mm: found the text \"50mm\"; must be a number (millimetres)",
        ),
    ] {
        assert_eq!(scene(lens).unwrap_err().to_string(), message);
    }
}

fn overrides() -> Vec<Override> {
    vec![
        Override {
            roughness: Some(0.25),
            metal: Some(Metal::Gold),
            ..Override::new("case")
        },
        Override {
            metallic: Some(0.5),
            base_color: Some([0.5, 0.25, 1.0]),
            ..Override::new("strap")
        },
    ]
}
