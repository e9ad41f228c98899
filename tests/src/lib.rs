//! Scenes in code and comparisons that the conformance tests share.

pub mod random;
pub mod two_renderers;
pub mod unbiased;

use glam::{DVec3, Vec2, Vec3, Vec4};
use hairline_scene::{
    Base, Camera, Environment, Lens, Light, Material, Mesh, Object, Profile, RenderSettings, Scene,
    Scratch, Segment,
};
use std::path::Path;
use std::sync::Arc;

/// The middle of the picture of one of the repository's scenes, in the pixels that it has where it is `of_px` wide.
///
/// # Panics
/// Where the scene cannot be loaded.
pub fn middle(name: &str, of_px: u32, size_px: [u32; 2]) -> Scene {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let path = root.join("scenes").join(name);
    let scene = hairline_document::load(&path).unwrap_or_else(|error| panic!("{error}"));
    middle_of(scene, of_px, size_px)
}

/// The middle of a scene's picture that would be `of_px` wide.
pub fn middle_of(mut scene: Scene, of_px: u32, size_px: [u32; 2]) -> Scene {
    let [width, height] = scene.render.size_px.map(f64::from);
    let share = f64::from(size_px[1]) * width / (f64::from(of_px) * height);
    scene.camera.fov_y_rad = 2.0 * (share * (0.5 * scene.camera.fov_y_rad).tan()).atan();
    scene.render.size_px = size_px;
    scene
}

/// A square in the x-y plane seen from above, its normal along +z, with nothing on it and no light.
pub fn square(base: Base, half_side_m: f32, size_px: u32) -> Scene {
    let corner = |x: f32, y: f32| Vec3::new(x * half_side_m, y * half_side_m, 0.0);
    let mesh = Mesh {
        positions_m: vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ],
        normals: vec![Vec3::Z; 4],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4],
        uvs: vec![Vec2::ZERO; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_materials: vec![0; 2],
        ..Mesh::default()
    };
    Scene {
        camera: Camera {
            position_m: DVec3::new(0.0, -0.4, 1.0) * half_side_m as f64 * 2.0,
            target_m: DVec3::ZERO,
            up: DVec3::Y,
            fov_y_rad: 0.6,
            shift_tan: Default::default(),
            exposure_ev: 0.0,
            lens: Lens::default(),
        },
        render: RenderSettings {
            size_px: [size_px; 2],
            filter_std_px: 0.5,
            tone_map: Default::default(),
        },
        notes: Vec::new(),
        tables: Arc::default(),
        environment: None,
        textures: Arc::default(),
        observer: Default::default(),
        materials: vec![Material::plain("base".into(), base, 0.05)],
        shadow_catcher: None,
        objects: vec![Object {
            name: "square".into(),
            mesh: Arc::new(mesh),
            scratches: Arc::default(),
            segments: Arc::default(),
            parts: Arc::default(),
            gratings: Vec::new(),
            is_lamp: false,
        }],
        lights: Vec::new(),
    }
}

/// Light of radiance one from everywhere.
pub fn furnace() -> Option<Environment> {
    Some(hairline_sky::uniform([1.0; 3]))
}

/// A sphere that the square's camera sees mirrored near the middle.
pub fn sphere_light(half_side_m: f32, radius: f64) -> Light {
    let s = half_side_m as f64 * 2.0;
    Light::sphere(DVec3::new(0.1, 0.5, 1.0) * s, radius * s, [10.0; 3])
}

/// Lays a straight scratch on the first object, cut into equal pieces. Which triangle it lies on does not matter here.
pub fn lay(
    scene: &mut Scene,
    start_m: Vec3,
    end_m: Vec3,
    width_um: f32,
    depth_nm: f32,
    pieces: u32,
) {
    let object = &mut scene.objects[0];
    let first = object.segments.len() as u32;
    let at = |i: u32| start_m.lerp(end_m, i as f32 / pieces as f32);
    Arc::make_mut(&mut object.segments).extend((0..pieces).map(|i| Segment {
        start_m: at(i),
        end_m: at(i + 1),
        normal: Vec3::Z,
        triangle: 0,
    }));
    Arc::make_mut(&mut object.scratches).push(Scratch {
        profile: Profile {
            width_um,
            depth_nm,
            ..Profile::default()
        },
        layer: 0,
        closed: false,
        segments: first..first + pieces,
    });
}

/// A deterministic sequence of numbers in [0, 1).
pub struct Sequence(pub u64);

impl Sequence {
    /// The next number.
    #[expect(
        clippy::should_implement_trait,
        reason = "it never ends: an iterator's items would be unwrapped everywhere"
    )]
    pub fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    /// The next number, scaled to [a, b).
    pub fn uniform(&mut self, a: f32, b: f32) -> f32 {
        a + (b - a) * self.next()
    }

    /// A unit vector with z at least `lowest_z`; one in eight lies along an axis or on the horizon.
    pub fn direction(&mut self, lowest_z: f32) -> [f32; 3] {
        let awkward = [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, 0.8, 0.0],
        ];
        if self.next() < 0.125 {
            return awkward[(self.next() * 4.0) as usize];
        }
        let z = self.uniform(lowest_z, 1.0);
        let (sin, cos) = self.uniform(0.0, std::f32::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    }
}

/// Lays `count` straight scratches at random over the square.
pub fn lay_random(scene: &mut Scene, half_side_m: f32, count: u32, length_m: f32, seed: u64) {
    let mut random = Sequence(seed);
    for _ in 0..count {
        let middle =
            Vec3::new(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0) * half_side_m;
        let (sin, cos) = random.uniform(0.0, std::f32::consts::PI).sin_cos();
        let half = 0.5 * length_m * Vec3::new(cos, sin, 0.0);
        let (width_um, depth_nm) = (random.uniform(1.0, 4.0), random.uniform(40.0, 400.0));
        lay(scene, middle - half, middle + half, width_um, depth_nm, 1);
    }
}
