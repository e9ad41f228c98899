//! Scenes drawn by Bevy without a window, against the CPU renderer without shadows. Needs a graphics adapter; a software driver will do.

use std::path::Path;

use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::ecs::system::RunSystemOnce;
use bevy::light::RectLight;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use hairline_bevy::{
    Metal, ScratchedMaterial, ScratchedPlugin, ScratchedTextures, Scratches, metal_color,
};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_image::{Image as Film, Layer};
use hairline_scene::{Base, LightShape, Scene};

/// The most that a picture may be off, as rms over that of the picture.
const LIMIT: f64 = 0.005;
/// Least effect of scratches that is compared, as a share of the picture without them.
const SHARE_MIN: f32 = 0.05;
/// Pipelines and textures are there after a few frames.
const FRAMES_MAX: usize = 200;

/// The last picture that came back.
#[derive(Resource, Default)]
struct Seen(Vec<[f32; 3]>);

#[test]
fn bevy_draws_what_hairline_renders() {
    for name in ["plate", "dome"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
        let mut scene = Scene::load(path.join(format!("{name}.toml"))).expect("a scene");
        let worn = compare(name, "with scratches", &scene, false);
        compare(name, "turned, under spots", &scene, true);
        scene.objects[0].scratches = Default::default();
        scene.objects[0].segments = Default::default();
        let bare = compare(name, "without scratches", &scene, false);
        let change = |[worn, bare]: [&Vec<[f32; 3]>; 2]| -> Vec<[f32; 3]> {
            let minus = |(a, b): (&[f32; 3], &[f32; 3])| std::array::from_fn(|c| a[c] - b[c]);
            worn.iter().zip(bare).map(minus).collect()
        };
        let own = change([&worn.bevy, &bare.bevy]);
        let wanted = change([&worn.hairline, &bare.hairline]);
        // Bevy's picture is of half floats: where scratches change little, the difference is their rounding.
        let sum = |rgb: &[f32; 3]| rgb.iter().map(|x| x.abs()).sum::<f32>();
        let is_plain = |i: &usize| sum(&wanted[*i]) > SHARE_MIN * sum(&bare.hairline[*i]);
        let plain: Vec<usize> = worn.inner.iter().copied().filter(is_plain).collect();
        assert!(plain.len() > 100, "{name}: {} pixels", plain.len());
        let off = error(&own, &wanted, &plain);
        println!(
            "{name}: what scratches change, {} pixels: {:.3} % off",
            plain.len(),
            100.0 * off
        );
        assert!(off < LIMIT, "{name}: what scratches change");
    }
}

struct Pair {
    bevy: Vec<[f32; 3]>,
    hairline: Vec<[f32; 3]>,
    inner: Vec<usize>,
}

fn compare(name: &str, what: &str, scene: &Scene, is_turned: bool) -> Pair {
    let film = Prepared::new(scene).render(&RenderOptions::default(), &|_| {});
    let (bevy, hairline) = (draw(scene, is_turned), film.layer(Layer::Beauty));
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
    let mut app = App::new();
    let windowless = WindowPlugin {
        primary_window: None,
        exit_condition: ExitCondition::DontExit,
        ..default()
    };
    let renderer = RenderPlugin {
        synchronous_pipeline_compilation: true,
        ..default()
    };
    let plugins = DefaultPlugins
        .set(windowless)
        .set(renderer)
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>()
        .disable::<bevy::log::LogPlugin>();
    app.add_plugins((plugins, ScratchedPlugin))
        .init_resource::<Seen>()
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight {
            brightness: 0.0,
            ..default()
        });
    while app.plugins_state() == bevy::app::PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();

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
    let (base, metal) = match scene.materials[0].base {
        Base::Metal(metal) => (metal_color(metal), Some(metal)),
        Base::MetallicRoughness {
            base_color: [r, g, b],
            ..
        } => (
            Color::linear_rgb(r as f32, g as f32, b as f32),
            None::<Metal>,
        ),
        _ => panic!("the test knows metals and metallic-roughness"),
    };
    let metallic = match scene.materials[0].base {
        Base::MetallicRoughness { metallic, .. } => metallic as f32,
        _ => 1.0,
    };
    let base = StandardMaterial {
        base_color: base,
        metallic,
        perceptual_roughness: scene.materials[0].roughness as f32,
        ..default()
    };
    let scratches = Scratches::of_scene(scene, 0);
    let world = app.world_mut();
    let extension = world
        .run_system_once_with(
            |In((metal, scratches)): In<(Option<Metal>, Scratches)>,
             mut textures: ScratchedTextures| { textures.scratched(metal, &scratches) },
            (metal, scratches),
        )
        .expect("the plugin is there");
    let material = world
        .resource_mut::<Assets<ScratchedMaterial>>()
        .add(ScratchedMaterial { base, extension });
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), turn));
    // Everything else is turned with the mesh.
    spawn_lights(world, scene, turn, is_turned);
    let target = spawn_camera(world, scene, turn);
    world.spawn(Readback::texture(target)).observe(
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
    for _ in 0..FRAMES_MAX {
        app.update();
        let seen = &app.world().resource::<Seen>().0;
        let is_lit = seen.iter().flatten().any(|channel| *channel > 0.0);
        if is_lit && *seen == last {
            return last;
        }
        last.clone_from(seen);
    }
    panic!("no picture in {FRAMES_MAX} frames");
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
fn spawn_camera(world: &mut World, scene: &Scene, turn: Transform) -> Handle<Image> {
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
        // Exposure by which a luminance of 1 is 1 in the picture.
        Exposure {
            ev100: -1.2_f32.log2(),
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
