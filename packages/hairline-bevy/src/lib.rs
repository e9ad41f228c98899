//! Hair-thin scratches on metal and lacquer for Bevy's standard material: they split the light of Bevy's lamps into colours, in closed form.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use hairline_bevy::{Metal, ScratchedMaterial, ScratchedPlugin, ScratchedTextures, Scratches, metal_color};
//!
//! fn setup(
//!     mut commands: Commands,
//!     mut meshes: ResMut<Assets<Mesh>>,
//!     mut materials: ResMut<Assets<ScratchedMaterial>>,
//!     mut textures: ScratchedTextures,
//! ) -> Result {
//!     let plate = Mesh::from(Circle::new(0.08));
//!     let scratches = Scratches::on_mesh(&plate, &["pattern = 'random'\ncount = 1500\nlength_m = 0.03"])?;
//!     let steel = StandardMaterial {
//!         base_color: metal_color(Metal::StainlessSteel),
//!         metallic: 1.0,
//!         perceptual_roughness: 0.08,
//!         ..default()
//!     };
//!     let extension = textures.scratched(Some(Metal::StainlessSteel), &scratches);
//!     let material = materials.add(ScratchedMaterial { base: steel, extension });
//!     commands.spawn((Mesh3d(meshes.add(plate)), MeshMaterial3d(material)));
//!     Ok(())
//! }
//!
//! App::new().add_plugins((DefaultPlugins, ScratchedPlugin)).add_systems(Startup, setup).run();
//! ```

mod scratches;
mod textures;

use bevy::asset::uuid_handle;
use bevy::pbr::{ExtendedMaterial, MaterialExtension};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, ShaderType};
use bevy::shader::{Shader, ShaderRef};
use hairline_gpu::shaders::{FOR_ENGINES, compose};

pub use hairline_optics::metal::Metal;
pub use scratches::Scratches;
pub use textures::{ScratchedTextures, metal_color};

/// The module `hairline`, of all shader modules for engines.
const MODULES: Handle<Shader> = uuid_handle!("0f6f9a3c-3e0b-4f0e-9d53-5c1b8b6d1f20");
const FRAGMENT: Handle<Shader> = uuid_handle!("5d2c1f0e-9b7a-4c1d-8e64-2f7a0c9b3e11");

/// Bevy's standard material with scratches.
pub type ScratchedMaterial = ExtendedMaterial<StandardMaterial, Scratched>;

/// Adds [`ScratchedMaterial`].
pub struct ScratchedPlugin;

impl Plugin for ScratchedPlugin {
    fn build(&self, app: &mut App) {
        let modules = format!("#define_import_path hairline\n{}", compose(FOR_ENGINES));
        let mut shaders = app.world_mut().resource_mut::<Assets<Shader>>();
        let fragment = include_str!("scratched.wgsl");
        for (handle, text, path) in [
            (&MODULES, modules, "hairline.wgsl"),
            (&FRAGMENT, fragment.into(), "hairline/scratched.wgsl"),
        ] {
            let inserted = shaders.insert(handle, Shader::from_wgsl(text, path));
            inserted.expect("both have identities of their own");
        }
        app.init_resource::<textures::Shared>()
            .add_plugins(MaterialPlugin::<ScratchedMaterial>::default())
            .add_systems(PostUpdate, warn_of_scales);
    }
}

/// Material with the bindings for scratches besides the standard material's. [`ScratchedTextures::scratched`] makes one.
///
/// It uses the standard material's base colour, metallic, perceptual roughness, reflectance, normal map, emission, occlusion and alpha.
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
pub struct Scratched {
    #[texture(100, sample_type = "u_int", visibility(fragment))]
    tree: Handle<Image>,
    #[texture(
        101,
        sample_type = "u_int",
        dimension = "2d_array",
        visibility(fragment)
    )]
    tables: Handle<Image>,
    #[texture(102, sample_type = "float", filterable = false, visibility(fragment))]
    shapes: Handle<Image>,
    #[texture(103, sample_type = "float", filterable = false, visibility(fragment))]
    albedo: Handle<Image>,
    #[texture(104, sample_type = "float", filterable = false, visibility(fragment))]
    curves: Handle<Image>,
    #[uniform(105, visibility(fragment))]
    settings: Settings,
}

impl Scratched {
    /// Metres: of point and spot lights whose radius is 0. Scratches need lights that have a size.
    pub const LIGHT_RADIUS_M: f32 = 0.005;

    /// Sets another radius for lights without one, in metres.
    pub fn with_light_radius_m(mut self, light_radius_m: f32) -> Self {
        self.settings.light_radius_m = light_radius_m;
        self
    }
}

/// Twin: `Settings` in scratched.wgsl.
#[derive(Clone, Copy, Debug, ShaderType)]
struct Settings {
    curve: u32,
    light_radius_m: f32,
}

impl MaterialExtension for Scratched {
    fn fragment_shader() -> ShaderRef {
        FRAGMENT.into()
    }
}

/// Scratches are as wide as they are in metres: a mesh that is scaled would have them in the wrong places.
#[allow(clippy::type_complexity)]
fn warn_of_scales(
    moved: Query<
        (Entity, &GlobalTransform),
        (
            With<MeshMaterial3d<ScratchedMaterial>>,
            Changed<GlobalTransform>,
        ),
    >,
) {
    for (entity, transform) in &moved {
        let scale = transform.scale();
        if (scale.abs() - 1.0).abs().max_element() > 0.01 {
            warn!(
                "scratched mesh {entity}: found the scale {scale}; must be 1: scale the mesh itself, before scratches are laid on it"
            );
        }
    }
}
