//! Variants of the shaders: a method and a scene's contents.

use hairline_optics::mask::Mask;
use hairline_scene::{Bearing, Grating, GrooveField, Material, Object, Scene, ScratchTables};

use crate::lights::{self, Kinds, LightKind};
use crate::method::Method;
use crate::shaders::Module;

/// Method and contents for which a pipeline is specialised.
#[derive(Clone, Debug)]
pub(crate) struct ShadeVariant {
    pub method: Method,
    /// Contents of the scene: code for what it lacks is left out, so that it costs nothing.
    pub has: Contents,
}

/// Parts of the shaders that a scene needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Contents {
    pub scratches: bool,
    /// Gratings; methods of others leave them out.
    pub gratings: bool,
    /// Gratings whose grooves could be seen one by one.
    pub single_grooves: bool,
    /// Gratings with tables by incidence, and with tables by depth.
    pub fine_gratings: bool,
    pub coarse_gratings: bool,
    /// Single grooves that come nearer to one another along their way.
    pub branching_grooves: bool,
    /// Gratings with pictures, or along texture coordinates.
    pub groove_maps: bool,
    /// Gratings whose grooves lie about spots.
    pub groove_spots: bool,
    /// Kinds of lights.
    pub lights: Kinds,
    /// Lights with barn doors.
    pub doors: bool,
    pub textures: bool,
    /// Surfaces with normal maps.
    pub bumps: bool,
    pub colors: bool,
    pub cutouts: bool,
    /// Materials that are not metal through and through.
    pub bodies: bool,
    /// Materials whose facets lean further one way than across it.
    pub anisotropy: bool,
    /// Dielectrics with other reflections than their refractive index says.
    pub specular: bool,
    /// The curve of coats, if there are any.
    pub coats: Option<u32>,
    /// Coats whose normals differ from those of the surface under them.
    pub coat_normals: bool,
}

impl Contents {
    pub(crate) fn new(scene: &Scene, tables: &ScratchTables, method: &Method) -> Self {
        let gratings = method.other.is_none();
        let single_grooves =
            gratings && scene.objects.iter().any(|o| shows_single_grooves(scene, o));
        let any = |is: fn(&Grating) -> bool| {
            let mut all = scene.objects.iter().flat_map(|o| &o.gratings);
            all.any(is)
        };
        let has_fine = |is_fine| {
            let mut spectra = tables.grating_spectra.iter();
            spectra.any(|of| of.fine.is_some() == is_fine)
        };
        Self {
            scratches: scene.objects.iter().any(|o| !o.segments.is_empty()),
            gratings: gratings && scene.objects.iter().any(|o| !o.gratings.is_empty()),
            single_grooves,
            fine_gratings: gratings && has_fine(true),
            coarse_gratings: gratings && has_fine(false),
            branching_grooves: single_grooves && any(branches),
            groove_maps: gratings && any(has_maps),
            groove_spots: gratings && any(has_spots),
            lights: Kinds::from_scene(scene),
            doors: scene
                .lights
                .iter()
                .any(|light| lights::doors(light).is_some()),
            textures: !scene.textures.is_empty(),
            bumps: (scene.materials.iter())
                .any(|it| it.normal_texture.is_some() || it.coat_normal_texture.is_some()),
            colors: scene.objects.iter().any(|o| !o.mesh.colors.is_empty()),
            cutouts: scene.materials.iter().any(|it| it.cutout.is_some()),
            bodies: (scene.materials.iter().zip(&tables.materials)).any(|(material, optics)| {
                optics.metallic < 1.0 || material.metallic_roughness_texture.is_some()
            }),
            anisotropy: scene.materials.iter().any(|it| it.anisotropy.is_some()),
            specular: scene.materials.iter().any(Material::has_specular),
            coats: tables.materials.iter().find_map(|optics| optics.coat_curve),
            coat_normals: scene.materials.iter().any(Material::has_coat_normals),
        }
    }
}

fn shows_single_grooves(scene: &Scene, object: &Object) -> bool {
    object.gratings.iter().any(|grating| {
        let materials = object.mesh.materials();
        let mut coherences_um = materials.iter().map(|at| scene.materials[*at].coherence_um);
        coherences_um.any(|coherence_um| grating.shows_single_grooves(coherence_um))
    })
}

/// Whether its grooves come nearer to one another along their way.
fn branches(grating: &Grating) -> bool {
    match grating.field {
        GrooveField::Along { .. } | GrooveField::Spots { .. } => false,
        GrooveField::Around { bearing, .. } => bearing != Bearing::Circular,
        GrooveField::ByUv { .. } => true,
    }
}

fn has_maps(grating: &Grating) -> bool {
    grating.mask.is_some() || matches!(grating.field, GrooveField::ByUv { .. })
}

fn has_spots(grating: &Grating) -> bool {
    matches!(grating.field, GrooveField::Spots { .. })
}

/// A constant that a pipeline sets.
pub(crate) type Constant = (&'static str, f64);

/// Origin of the rays that see the samples of a pass. Twin: at_hits.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RayOrigin {
    ByCamera,
    /// Rays from other samples.
    ByRays,
}

impl RayOrigin {
    /// Constant for passes whose shader needs it.
    pub(crate) fn constant(self) -> Constant {
        ("AT_HITS", f64::from(u8::from(self == Self::ByRays)))
    }
}

/// Lobe by which light leaves a sample. Twin: layout.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Base,
    Scratches,
    Gratings,
}

impl Way {
    pub(crate) const ALL: [Self; 3] = [Self::Base, Self::Scratches, Self::Gratings];
}

/// Returns the values of the overrides of a shader, for a scene with everything and for one with nothing, by each of some named
/// methods: each set has a name. For compilers other than the device's own.
pub fn pipeline_variants(
    module: &Module,
    methods: &[(&str, Method)],
) -> Vec<(String, Vec<(&'static str, f64)>)> {
    let everything = Contents {
        scratches: true,
        gratings: true,
        single_grooves: true,
        fine_gratings: true,
        coarse_gratings: true,
        branching_grooves: true,
        groove_maps: true,
        groove_spots: true,
        lights: Kinds::ALL,
        doors: true,
        textures: true,
        bumps: true,
        colors: true,
        cutouts: true,
        bodies: true,
        anisotropy: true,
        specular: true,
        coats: Some(0),
        coat_normals: true,
    };
    let mut variants: Vec<(String, Vec<Constant>)> = Vec::new();
    for (name, method) in methods {
        for (scene, has) in [("everything", everything), ("nothing", Contents::default())] {
            let method = method.clone();
            let constants = ShadeVariant { method, has }.constants(module);
            let kinds = match module.overrides.contains(&"SCRATCH_LIGHTS") {
                true => 0..LightKind::ALL.len() + 1,
                false => 0..1,
            };
            for kind in kinds.clone() {
                let mut constants = constants.clone();
                let mut name = format!("{name}, {scene}");
                if kinds.len() > 1 {
                    constants.push(("SCRATCH_LIGHTS", kind as f64));
                    name += &format!(", lights of kind {kind}");
                }
                if variants.iter().any(|(_, known)| *known == constants) {
                    continue;
                }
                let switches = ["PICKS", "BY_ENERGY", "AT_HITS", "OF_GRATINGS", "COUNTED"];
                let has = |switch: &&str| module.overrides.contains(switch);
                for switch in switches.into_iter().filter(has) {
                    let mut constants = constants.clone();
                    constants.push((switch, 1.0));
                    variants.push((format!("{name}, {switch}"), constants));
                }
                variants.push((name, constants));
            }
        }
    }
    variants
}

impl ShadeVariant {
    /// The constants that a shader declares, by the names of contents.wgsl, method.wgsl and another method; others would be refused.
    pub(crate) fn constants(&self, module: &Module) -> Vec<Constant> {
        let Self { method, has } = self;
        let mask = match method.mask {
            Mask::Energy => 0,
            Mask::Linear => 1,
            Mask::Density => 2,
        };
        let mut constants = vec![
            ("HAS_SCRATCHES", has.scratches.into()),
            ("HAS_GRATINGS", has.gratings.into()),
            ("HAS_SINGLE_GROOVES", has.single_grooves.into()),
            ("HAS_FINE_GRATINGS", has.fine_gratings.into()),
            ("HAS_COARSE_GRATINGS", has.coarse_gratings.into()),
            ("HAS_BRANCHING_GROOVES", has.branching_grooves.into()),
            ("HAS_GROOVE_MAPS", has.groove_maps.into()),
            ("HAS_GROOVE_SPOTS", has.groove_spots.into()),
            ("HAS_DOORS", has.doors.into()),
            ("HAS_TEXTURES", has.textures.into()),
            ("HAS_BUMPS", has.bumps.into()),
            ("HAS_COLORS", has.colors.into()),
            ("HAS_CUTOUTS", has.cutouts.into()),
            ("HAS_BODIES", has.bodies.into()),
            ("HAS_ANISOTROPY", has.anisotropy.into()),
            ("HAS_SPECULAR", has.specular.into()),
            ("HAS_COATS", has.coats.is_some().into()),
            ("HAS_COAT_NORMALS", has.coat_normals.into()),
            ("COAT_CURVE", has.coats.unwrap_or(0).into()),
            ("METHOD_MASK", mask.into()),
        ];
        constants.extend(has.lights.constants());
        constants.extend(method.other.iter().flat_map(|other| other.constants()));
        constants.retain(|(name, _)| module.overrides.contains(name));
        constants
    }
}
