//! Hair-thin scratches on metal and lacquer for Bevy's standard material: they split the light of Bevy's lamps into colours, in closed form.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use hairline_bevy::{Metal, ScratchedMaterial, ScratchedPlugin, ScratchedTextures, Scratches};
//!
//! fn setup(
//!     mut commands: Commands,
//!     mut meshes: ResMut<Assets<Mesh>>,
//!     mut materials: ResMut<Assets<ScratchedMaterial>>,
//!     textures: Res<ScratchedTextures>,
//! ) -> Result {
//!     let plate = Mesh::from(Circle::new(0.08));
//!     let scratches = Scratches::on_mesh(&plate, &["pattern = 'random'\ncount = 1500\nlength_m = 0.03"])?;
//!     let base = StandardMaterial { perceptual_roughness: 0.08, ..default() };
//!     let steel = textures.material(Some(Metal::StainlessSteel), base, &scratches);
//!     commands.spawn((Mesh3d(meshes.add(plate)), MeshMaterial3d(materials.add(steel))));
//!     Ok(())
//! }
//!
//! App::new().add_plugins((DefaultPlugins, ScratchedPlugin)).add_systems(Startup, setup).run();
//! ```
//!
//! Files of `hairline export` bring their scratches along: Bevy's own loader opens them, `asset_server.load("worn.glb#Scene0")`.

mod scratches;
mod textures;
mod unlaid_layers;
mod worn_files;
mod worn_object;

use bevy::asset::uuid_handle;
use bevy::gltf::extensions::GltfExtensionHandlers;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{
    ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline,
};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::shader::{Shader, ShaderRef};
use hairline_gpu::shaders::{FOR_ENGINES, for_engines, with_needs};

pub use hairline_optics::metal::Metal;
pub use scratches::Scratches;
pub use textures::ScratchedTextures;

/// The module `hairline`, of all shader modules for engines.
const MODULES: Handle<Shader> = uuid_handle!("0f6f9a3c-3e0b-4f0e-9d53-5c1b8b6d1f20");
const FRAGMENT: Handle<Shader> = uuid_handle!("5d2c1f0e-9b7a-4c1d-8e64-2f7a0c9b3e11");

/// Bevy's standard material with scratches.
pub type ScratchedMaterial = ExtendedMaterial<StandardMaterial, Scratched>;

/// Gratings of one material.
pub(crate) const MOST_GRATINGS: usize = 4;

/// Adds [`ScratchedMaterial`], and opens files with HAIRLINE_scratches by Bevy's glTF loader. Comes after `DefaultPlugins`.
pub struct ScratchedPlugin;

impl Plugin for ScratchedPlugin {
    fn build(&self, app: &mut App) {
        let mut modules = String::from("#define_import_path hairline\n");
        for module in with_needs(FOR_ENGINES) {
            modules += &for_engines(module);
            modules.push('\n');
        }
        let mut shaders = app.world_mut().resource_mut::<Assets<Shader>>();
        let fragment = include_str!("scratched.wgsl");
        for (handle, text, path) in [
            (&MODULES, modules, "hairline.wgsl"),
            (&FRAGMENT, fragment.into(), "hairline/scratched.wgsl"),
        ] {
            let inserted = shaders.insert(handle, Shader::from_wgsl(text, path));
            inserted.expect("both have identities of their own");
        }
        let textures = ScratchedTextures::from_world(app.world_mut());
        if let Some(handlers) = app.world().get_resource::<GltfExtensionHandlers>() {
            let handler = Box::new(worn_files::WornFiles::new(textures.clone()));
            #[cfg(not(target_family = "wasm"))]
            handlers.0.write_blocking().push(handler);
            #[cfg(target_family = "wasm")]
            bevy::tasks::block_on(async { handlers.0.write().await.push(handler) });
        }
        app.insert_resource(textures)
            .add_plugins(MaterialPlugin::<ScratchedMaterial>::default())
            .add_systems(PostUpdate, warn_of_scales);
    }
}

/// The part of a [`ScratchedMaterial`] beside the standard material. [`ScratchedTextures::material`] makes one.
///
/// Of the standard material it uses base colour, metallic, perceptual roughness, reflectance, clear coat, anisotropy, emission, occlusion, alpha, with
/// their textures, and normal maps.
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
#[bind_group_data(ScratchedKey)]
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
    metres_from_mesh: Mat4,
    gratings: [Mat4; MOST_GRATINGS],
    grating_count: u32,
    curve: u32,
    coat_curve: u32,
    light_radius_m: f32,
}

/// Properties that shaders are compiled for.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ScratchedKey {
    is_grated: bool,
}

impl From<&Scratched> for ScratchedKey {
    fn from(scratched: &Scratched) -> Self {
        Self {
            is_grated: scratched.settings.grating_count > 0,
        }
    }
}

impl MaterialExtension for Scratched {
    fn fragment_shader() -> ShaderRef {
        FRAGMENT.into()
    }

    fn specialize(
        _pipeline: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        if let Some(fragment) = descriptor.fragment.as_mut()
            && key.bind_group_data.is_grated
        {
            fragment.shader_defs.push("GRATED".into());
        }
        Ok(())
    }
}

/// Scratches are as wide as they are in metres: a mesh of another scale than they were laid for would have them in the wrong places.
fn warn_of_scales(
    materials: Res<Assets<ScratchedMaterial>>,
    moved: Query<
        (Entity, &GlobalTransform, &MeshMaterial3d<ScratchedMaterial>),
        Changed<GlobalTransform>,
    >,
) {
    for (entity, transform, material) in &moved {
        let Some(material) = materials.get(material) else {
            continue;
        };
        let laid = material.extension.settings.metres_from_mesh;
        let wanted = laid.x_axis.length();
        let scale = transform.scale();
        if (scale.abs() / wanted - 1.0).abs().max_element() > 0.01 {
            warn!(
                "scratched mesh {entity}: found the scale {scale}; must be {wanted}: scale the mesh itself, before scratches are laid on it"
            );
        }
    }
}
