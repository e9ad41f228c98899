//! Scenes drawn by Bevy without a window, against the CPU renderer without shadows. Needs a graphics adapter; a software driver will do.

use std::f32::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::gltf::GltfLoaderSettings;
use bevy::light::RectLight;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use hairline_bevy::{ScratchedMaterial, ScratchedPlugin, ScratchedTextures, Scratches};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::export::Export;
use hairline_document::{Description, Loader};
use hairline_image::{Image as Film, Layer};
use hairline_optics::metal::MetalIndex;
use hairline_scene::{Base, LightShape, Scene};

/// The most that a picture may be off, as rms over that of the picture.
const LIMIT: f64 = 0.005;
/// Least effect of scratches that is compared, as a share of the picture without them.
const SHARE_MIN: f32 = 0.05;
/// Files, pipelines and textures are there by then.
const LONGEST: Duration = Duration::from_secs(100);
/// Between frames without a picture files are read.
const PAUSE: Duration = Duration::from_millis(5);

/// The last picture that came back.
#[derive(Resource, Default)]
struct Seen(Vec<[f32; 3]>);

#[test]
fn bevy_draws_what_hairline_renders() {
    for name in ["plate", "dome"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
        let mut scene =
            hairline_document::load(path.join(format!("{name}.toml"))).expect("a scene");
        let worn = compare(name, "with scratches", &scene, false);
        compare(name, "turned, under spots", &scene, true);
        scene.objects[0].scratches = Default::default();
        scene.objects[0].segments = Default::default();
        let bare = compare(name, "without scratches", &scene, false);
        compare_change(name, &worn, &bare);
    }
}

/// Scenes of the package for three.js, under lights that Bevy has: as files, with maps, a brushed base under a coat, gratings, V grooves narrow and wide.
/// Beside them, of some, what must be seen when it is wrong, in the scene or in the file.
const FILES: [(&str, &[[&str; 2]]); 4] = [
    (
        "lacquer",
        &[
            ["direction_deg = 30.0", "direction_deg = -30.0"],
            ["clearcoat = 0.7", "clearcoat = 0.0"],
        ],
    ),
    ("disc", &[["[1.0, 0.3, 0.0]", "[1.0, -0.3, 0.0]"]]),
    (
        "sheet",
        &[
            ["\"baseColorTexture\"", "\"baseColorTextur_\""],
            [
                "\"metallicRoughnessTexture\"",
                "\"metallicRoughnessTextur_\"",
            ],
            ["\"normalTexture\"", "\"normalTextur_\""],
        ],
    ),
    ("grooves", &[]),
];

#[test]
fn a_file_shows_what_hairline_renders() {
    for (name, wrong) in FILES {
        let text = std::fs::read_to_string(scenes().join(format!("{name}.toml"))).expect("a scene");
        let described = described(&text);
        let mut scene = hairline_document::build(&described, scenes()).expect("a scene");
        let worn = compare_pictures(name, "a file", &scene, draw_file(&scene, &glb(&described)));
        let as_it_lies = draw_file(&scene, &exported(&described, true));
        compare_pictures(name, "a file as it lies", &scene, as_it_lies);
        // Of a file without any scratch Bevy draws the standard material.
        let mut bare = self::described(&with_one_scratch(&text));
        bare.gratings.clear();
        scene = hairline_document::build(&bare, scenes()).expect("a scene");
        let bare = compare_pictures(name, "one scratch", &scene, draw_file(&scene, &glb(&bare)));
        compare_change(name, &worn, &bare);
        for [right, wrong] in wrong {
            let file = match text.contains(right) {
                true => glb(&self::described(&text.replace(right, wrong))),
                false => replaced(glb(&described), right, wrong),
            };
            let off = error(&draw_file(&scene, &file), &worn.hairline, &worn.inner);
            println!("{name}, {wrong}: {:.1} % off", 100.0 * off);
            assert!(off > 2.0 * LIMIT, "{name}: {wrong} is not seen");
        }
    }
}

#[test]
fn a_file_is_shown_plain_without_the_plug_in_and_of_another_version() {
    let text = std::fs::read_to_string(scenes().join("lacquer.toml")).expect("a scene");
    let file = glb(&described(&text));
    let of_tomorrow = replaced(file.clone(), "\"version\":1}", "\"version\":2}");
    assert_ne!(file, of_tomorrow);
    for (file, has_plug_in) in [(&file, false), (&of_tomorrow, true), (&file, true)] {
        let mut app = app(has_plug_in);
        spawn_file(app.world_mut(), file);
        let is_plain = !has_plug_in || *file == of_tomorrow;
        let started = Instant::now();
        while started.elapsed() < LONGEST {
            std::thread::sleep(PAUSE);
            app.update();
            let world = app.world_mut();
            let mut all = world.query::<(
                Has<MeshMaterial3d<StandardMaterial>>,
                Has<MeshMaterial3d<ScratchedMaterial>>,
                &Mesh3d,
            )>();
            let found: Vec<bool> = all
                .iter(world)
                .map(|(plain, worn, _)| {
                    assert_ne!(plain, worn);
                    plain
                })
                .collect();
            if !found.is_empty() {
                assert_eq!(found, [is_plain]);
                break;
            }
        }
        let mut meshes = app.world_mut().query::<&Mesh3d>();
        assert_eq!(meshes.iter(app.world()).count(), 1, "the model is there");
    }
}

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../hairline-shaders/test")
}

fn with_one_scratch(text: &str) -> String {
    let one = |line: &str| match line.starts_with("count = ") {
        true => "count = 1\n".to_owned(),
        false => format!("{line}\n"),
    };
    text.lines().map(one).collect()
}

/// A scene with lights that Bevy has, and no environment.
fn described(text: &str) -> Description {
    let of = |text: &str| Description::from_toml(text, Path::new("a scene")).expect("a scene");
    let mut described = of(text);
    described.environment = None;
    if !text.contains("kind = \"sphere\"") {
        let other = std::fs::read_to_string(scenes().join("lacquer.toml")).expect("a scene");
        described.lights = of(&other).lights;
        // Under the sphere alone scratches are most of what is seen beside its reflection.
        described.lights.truncate(1);
    }
    described
}

fn glb(described: &Description) -> Vec<u8> {
    exported(described, false)
}

fn exported(described: &Description, laid: bool) -> Vec<u8> {
    let exported = Loader::default().export(
        described,
        &scenes(),
        Export {
            laid,
            ..Export::default()
        },
    );
    exported.expect("a file").bytes
}

/// A file with other text of the same length.
fn replaced(mut file: Vec<u8>, from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let found = file
        .windows(from.len())
        .position(|it| it == from.as_bytes());
    let at = found.unwrap_or_else(|| panic!("no {from} in the file"));
    file[at..at + to.len()].copy_from_slice(to.as_bytes());
    file
}

/// Compares what scratches change. Bevy's pictures are of half floats: where scratches change little, the difference is their rounding.
fn compare_change(name: &str, worn: &Pair, bare: &Pair) {
    let change = |[worn, bare]: [&Vec<[f32; 3]>; 2]| -> Vec<[f32; 3]> {
        let minus = |(a, b): (&[f32; 3], &[f32; 3])| std::array::from_fn(|c| a[c] - b[c]);
        worn.iter().zip(bare).map(minus).collect()
    };
    let own = change([&worn.bevy, &bare.bevy]);
    let wanted = change([&worn.hairline, &bare.hairline]);
    let sum = |rgb: &[f32; 3]| rgb.iter().map(|x| x.abs()).sum::<f32>();
    let is_plain = |i: &usize| sum(&wanted[*i]) > SHARE_MIN * sum(&bare.hairline[*i]);
    let plain: Vec<usize> = worn.inner.iter().copied().filter(is_plain).collect();
    let off = error(&own, &wanted, &plain);
    println!(
        "{name}: what scratches change, {} pixels: {:.3} % off",
        plain.len(),
        100.0 * off
    );
    assert!(off < LIMIT, "{name}: what scratches change");
}

struct Pair {
    bevy: Vec<[f32; 3]>,
    hairline: Vec<[f32; 3]>,
    inner: Vec<usize>,
}

fn compare(name: &str, what: &str, scene: &Scene, is_turned: bool) -> Pair {
    compare_pictures(name, what, scene, draw(scene, is_turned))
}

fn compare_pictures(name: &str, what: &str, scene: &Scene, bevy: Vec<[f32; 3]>) -> Pair {
    let prepared = Prepared::new(scene).as_laid();
    let film = prepared.render(&RenderOptions::default(), &|_| {});
    let hairline = film.layer(Layer::Beauty);
    let inner = inner_pixels(&film);
    let off = error(&bevy, &hairline, &inner);
    println!("{name}, {what}: {:.3} % off", 100.0 * off);
    assert!(off < LIMIT, "{name}, {what}: {:.3} % off", 100.0 * off);
    Pair {
        bevy,
        hairline,
        inner,
    }
}

/// The scene by Bevy. Turned: all of it in the world, and under spots, which gives the same picture.
fn draw(scene: &Scene, is_turned: bool) -> Vec<[f32; 3]> {
    let mut app = app(true);
    let turn = match is_turned {
        true => Transform::from_rotation(Quat::from_rotation_z(0.5))
            .with_translation(Vec3::new(0.01, 0.02, 0.0)),
        false => Transform::IDENTITY,
    };
    let object = &scene.objects[0];
    let positions: Vec<Vec3> = object
        .mesh
        .positions_m
        .iter()
        .map(|v| Vec3::from_array(v.to_array()))
        .collect();
    let normals: Vec<Vec3> = object
        .mesh
        .normals
        .iter()
        .map(|v| Vec3::from_array(v.to_array()))
        .collect();
    let indices: Vec<u32> = object.mesh.triangles.iter().flatten().copied().collect();
    // A mesh in its own frame, as its scratches are.
    let mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_indices(Indices::U32(indices));
    let mut base = StandardMaterial {
        perceptual_roughness: scene.materials[0].roughness as f32,
        ..default()
    };
    let metal = match scene.materials[0].base {
        Base::Metal(MetalIndex::Measured(metal)) => Some(metal),
        Base::MetallicRoughness {
            base_color: [r, g, b],
            metallic,
        } => {
            base.base_color = Color::linear_rgb(r as f32, g as f32, b as f32);
            base.metallic = metallic as f32;
            None
        }
        _ => panic!("the test knows metals and metallic-roughness"),
    };
    let world = app.world_mut();
    let textures = world.resource::<ScratchedTextures>();
    let material = textures.material(metal, base, &Scratches::of_scene(scene, 0));
    let material = world
        .resource_mut::<Assets<ScratchedMaterial>>()
        .add(material);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), turn));
    // Everything else is turned with the mesh.
    spawn_lights(world, scene, turn, is_turned);
    let target = spawn_camera(world, scene, turn, 1.0);
    picture(app, target)
}

/// A file by Bevy; the camera is the scene's.
fn draw_file(scene: &Scene, file: &[u8]) -> Vec<[f32; 3]> {
    let mut app = app(true);
    let world = app.world_mut();
    spawn_file(world, file);
    // Files have y up, in lumens.
    let turn = Transform::from_rotation(Quat::from_rotation_x(-FRAC_PI_2));
    let target = spawn_camera(world, scene, turn, 683.0);
    picture(app, target)
}

fn spawn_file(world: &mut World, file: &[u8]) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    // Tests run side by side.
    let name = format!("{:?}.glb", std::thread::current().id());
    std::fs::write(folder.join(&name), file).expect("a file is written");
    let without_cameras = |settings: &mut GltfLoaderSettings| settings.load_cameras = false;
    let server = world.resource::<AssetServer>();
    let loaded = server.load_builder().with_settings(without_cameras);
    let root = WorldAssetRoot(loaded.load(format!("{name}#Scene0")));
    world.spawn(root);
}

fn app(has_plug_in: bool) -> App {
    let mut app = App::new();
    let windowless = WindowPlugin {
        primary_window: None,
        exit_condition: ExitCondition::DontExit,
        ..default()
    };
    let files = AssetPlugin {
        file_path: env!("CARGO_TARGET_TMPDIR").to_owned(),
        ..default()
    };
    let renderer = RenderPlugin {
        synchronous_pipeline_compilation: true,
        ..default()
    };
    let plugins = DefaultPlugins
        .set(windowless)
        .set(renderer)
        .set(files)
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>()
        .disable::<bevy::log::LogPlugin>();
    app.add_plugins(plugins)
        .init_resource::<Seen>()
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight {
            brightness: 0.0,
            ..default()
        });
    if has_plug_in {
        app.add_plugins(ScratchedPlugin);
    }
    while app.plugins_state() == bevy::app::PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    app
}

/// The picture, when nothing changes any more.
fn picture(mut app: App, target: Handle<Image>) -> Vec<[f32; 3]> {
    app.world_mut().spawn(Readback::texture(target)).observe(
        |event: On<ReadbackComplete>, mut seen: ResMut<Seen>| {
            let (pixels, _) = event.data.as_chunks::<16>();
            let channel = |pixel: &[u8; 16], c: usize| {
                f32::from_le_bytes(std::array::from_fn(|i| pixel[4 * c + i]))
            };
            seen.0 = pixels
                .iter()
                .map(|pixel| std::array::from_fn(|c| channel(pixel, c)))
                .collect();
        },
    );
    // The first pictures lack what is still on its way.
    let mut last = Vec::new();
    let started = Instant::now();
    while started.elapsed() < LONGEST {
        std::thread::sleep(PAUSE);
        app.update();
        let seen = &app.world().resource::<Seen>().0;
        let is_lit = seen.iter().flatten().any(|channel| *channel > 0.0);
        if is_lit && *seen == last {
            return last;
        }
        last.clone_from(seen);
    }
    panic!("no picture in {LONGEST:?}");
}

fn spawn_lights(world: &mut World, scene: &Scene, turn: Transform, as_spots: bool) {
    for light in &scene.lights {
        let [r, g, b] = light.radiance.map(|channel| channel as f32);
        let most = r.max(g).max(b);
        let color = Color::linear_rgb(r / most, g / most, b / most);
        match &light.shape {
            LightShape::Sphere { center_m, radius_m } => {
                let radius = *radius_m as f32;
                let place =
                    turn * Transform::from_translation(center_m.as_vec3().to_array().into());
                // Lumens of a sphere of that radiance, as Bevy counts them.
                let intensity = most * 4.0 * (std::f32::consts::PI * radius).powi(2);
                if as_spots {
                    // Wide enough to hold the scene.
                    let at = place.looking_at(turn.translation, Vec3::Y);
                    world.spawn((
                        SpotLight {
                            color,
                            intensity,
                            radius,
                            inner_angle: 0.9,
                            outer_angle: 1.2,
                            ..default()
                        },
                        at,
                    ));
                } else {
                    world.spawn((
                        PointLight {
                            color,
                            intensity,
                            radius,
                            ..default()
                        },
                        place,
                    ));
                }
            }
            LightShape::Polygon { vertices_m, .. } => {
                let corner = |i: usize| Vec3::from_array(vertices_m[i].as_vec3().to_array());
                let (across, up) = (corner(1) - corner(0), corner(2) - corner(1));
                let (width, height) = (across.length(), up.length());
                // Corners run counter-clockwise as seen from where it shines to, which is its own -z.
                let (x, y) = (up / height, across / width);
                let rotation = Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y)));
                let place = Transform::from_translation(0.5 * (corner(0) + corner(2)))
                    .with_rotation(rotation);
                let intensity = most * std::f32::consts::PI * width * height;
                world.spawn((
                    RectLight {
                        color,
                        intensity,
                        width: height,
                        height: width,
                        ..default()
                    },
                    turn * place,
                ));
            }
            LightShape::Tube { .. } => panic!("Bevy has no tubes"),
        }
    }
}

/// A camera whose picture is linear radiance.
fn spawn_camera(world: &mut World, scene: &Scene, turn: Transform, white: f32) -> Handle<Image> {
    let [width, height] = scene.render.size_px;
    let mut picture = Image::new_target_texture(width, height, TextureFormat::Rgba32Float, None);
    picture.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let target = world.resource_mut::<Assets<Image>>().add(picture);
    let camera = &scene.camera;
    let [eye, middle, up] = [camera.position_m, camera.target_m, camera.up]
        .map(|v| Vec3::from_array(v.as_vec3().to_array()));
    world.spawn((
        Camera3d::default(),
        Hdr,
        RenderTarget::from(target.clone()),
        Projection::Perspective(PerspectiveProjection {
            fov: camera.fov_y_rad as f32,
            near: 0.001,
            far: 10.0,
            ..default()
        }),
        Tonemapping::None,
        Msaa::Off,
        // Exposure by which a luminance of `white` is 1 in the picture.
        Exposure {
            ev100: (white / 1.2).log2(),
        },
        turn * Transform::from_translation(eye).looking_at(middle, up),
    ));
    target
}

/// Pixels around which all is covered: rims are smoothed by samples in one picture and not in the other.
fn inner_pixels(film: &Film) -> Vec<usize> {
    let [width, height] = film.size_px.map(|n| n as usize);
    let is_inner = |i: &usize| {
        let (x, y) = (i % width, i / width);
        (-2..=2_isize).all(|dy| {
            (-2..=2_isize).all(|dx| {
                let [x, y] = [(x, dx, width), (y, dy, height)]
                    .map(|(at, step, size)| at.saturating_add_signed(step).min(size - 1));
                film.depth_m[y * width + x] > 0.0
            })
        })
    };
    (0..width * height).filter(is_inner).collect()
}

/// The rms of the difference over that of the second.
fn error(a: &[[f32; 3]], b: &[[f32; 3]], pixels: &[usize]) -> f64 {
    let (mut off, mut all) = (0.0, 0.0);
    for &i in pixels {
        for (x, y) in a[i].iter().zip(&b[i]) {
            off += f64::from(x - y).powi(2);
            all += f64::from(*y).powi(2);
        }
    }
    (off / all).sqrt()
}
