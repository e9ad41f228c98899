//! Part of a description that is seen: the rest may change without a new scene.

use hairline_document::Description;
use hairline_document::description::{Grating, Light, Material, Object, Scratches};

/// Whether two descriptions make the same scene: they differ only in the view, the exposure and the display, of which the
/// painter is told; in names; and in materials that no object has. The camera's up is left to the builder: it turns the
/// environment.
pub(crate) fn makes_same_scene(a: &Description, b: &Description) -> bool {
    let Description {
        camera,
        render: _,
        environment,
        studio,
        ground,
        // Compared where objects have them.
        materials: _,
        objects,
        scratches,
        gratings,
        lights,
        looks: _,
        lights_of: _,
        notes: _,
    } = a;
    camera.up == b.camera.up
        && *environment == b.environment
        && *studio == b.studio
        // The studio turns with the camera, and the ground of an empty scene lies before it.
        && (studio.hidden && !objects.is_empty() || *camera == b.camera)
        && *ground == b.ground
        && alike(objects, &b.objects, |x, y| is_same_object((a, x), (b, y)))
        && alike(scratches, &b.scratches, |x, y| {
            is_same_layer((a, x), (b, y))
        })
        && alike(gratings, &b.gratings, |x, y| {
            is_same_grating((a, x), (b, y))
        })
        && alike(lights, &b.lights, is_same_light)
}

fn alike<T>(a: &[T], b: &[T], is_same: impl Fn(&T, &T) -> bool) -> bool {
    a.len() == b.len() && std::iter::zip(a, b).all(|(x, y)| is_same(x, y))
}

fn is_same_object((a, x): (&Description, &Object), (b, y): (&Description, &Object)) -> bool {
    let Object {
        name: _,
        surface,
        material: material_name,
        translation_m,
        rotation_deg,
        scale,
        up,
        fit_m,
        time_s,
        animation,
        overrides,
        hidden,
    } = x;
    let is_same_material = match (material(a, x), material(b, y)) {
        (Some(x), Some(y)) => is_same_but_for_name(x, y),
        // A mesh with the materials of its file; or a name without a material, which the builder tells of.
        (None, None) => *material_name == y.material,
        _ => false,
    };
    is_same_material
        && *surface == y.surface
        && *translation_m == y.translation_m
        && *rotation_deg == y.rotation_deg
        && *scale == y.scale
        && *up == y.up
        && *fit_m == y.fit_m
        && *time_s == y.time_s
        && *animation == y.animation
        && *overrides == y.overrides
        && *hidden == y.hidden
}

fn material<'d>(description: &'d Description, object: &Object) -> Option<&'d Material> {
    let name = object.material.as_ref()?;
    description.materials.iter().find(|m| m.name == *name)
}

fn is_same_but_for_name(x: &Material, y: &Material) -> bool {
    let named_as_y = Material {
        name: y.name.clone(),
        ..x.clone()
    };
    named_as_y == *y
}

fn is_same_layer((a, x): (&Description, &Scratches), (b, y): (&Description, &Scratches)) -> bool {
    let Scratches {
        object: _,
        material,
        node,
        place: places,
        name: _,
        hidden,
        solo,
        profile,
        layer,
        strokes,
    } = x;
    place(a, &x.object) == place(b, &y.object)
        && *hidden == y.hidden
        && *solo == y.solo
        && (material, node) == (&y.material, &y.node)
        && *places == y.place
        && *profile == y.profile
        && *layer == y.layer
        && *strokes == y.strokes
}

fn is_same_grating((a, x): (&Description, &Grating), (b, y): (&Description, &Grating)) -> bool {
    let named_as_y = Grating {
        object: y.object.clone(),
        name: y.name.clone(),
        ..x.clone()
    };
    place(a, &x.object) == place(b, &y.object) && named_as_y == *y
}

/// Index of the object of this name.
fn place(description: &Description, object: &str) -> Option<usize> {
    let mut objects = description.objects.iter();
    objects.position(|it| it.name == object)
}

fn is_same_light(x: &Light, y: &Light) -> bool {
    let named_as_y = Light {
        name: y.name.clone(),
        ..x.clone()
    };
    named_as_y == *y
}
