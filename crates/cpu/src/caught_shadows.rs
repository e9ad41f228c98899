//! Shadows on a ground that is not seen itself: the share of each pixel's light there that objects hide.
//!
//! The ground is rendered alone, white and dull, twice: with the objects' shadows, and without. The objects themselves are black there, so the
//! ratio of the two is of the ground's part of a pixel, at edges too.

use std::sync::Arc;

use hairline_image::{Image, filter_traced};
use hairline_index::TriangleIndex;
use hairline_scene::{Base, Material, Scene, Transport};

use crate::alpha;
use crate::closed_form::{Prepared, RenderOptions};

/// The alpha of a picture before nothing, row by row: what [`alpha`] says of its objects, and with `shadows` what the shadows on the scene's
/// [catcher](Scene::shadow_catcher) hide of it. The picture has `done` of `samples` samples; without shadows once `cancelled` says so.
pub fn picture_alpha(
    scene: &Scene,
    triangles: &TriangleIndex,
    [done, samples]: [u32; 2],
    shadows: bool,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Vec<f32> {
    let mut alpha = alpha(scene, triangles, done, samples);
    let caught = shadows.then(|| caught_shadows(scene, samples, cancelled));
    let caught = caught.flatten().unwrap_or_default();
    let pixels = alpha.iter_mut().zip(caught);
    pixels.for_each(|(alpha, shadow)| *alpha += shadow);
    alpha
}

/// The alpha of a black that darkens each pixel as the shadows on the scene's [catcher](Scene::shadow_catcher) do, row by row: its share of the
/// pixel, times the share of its light that objects hide. None without a catcher, and once `cancelled` says so. `samples` rays go to each light.
fn caught_shadows(
    scene: &Scene,
    samples: u32,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<f32>> {
    let ground = with_ground_alone(scene)?;
    let prepared = Prepared::new(&ground);
    let [shaded, lit] = [true, false].map(|shadows| {
        let transport = Transport {
            shadows,
            bounces: 0,
        };
        ground_of(&prepared, transport, samples, cancelled)
    });
    let (shaded, lit) = (shaded?, lit?);
    let all = alpha(&ground, prepared.triangles(), samples, samples);
    let objects = alpha(scene, &TriangleIndex::build(scene), samples, samples);
    let luminance = |[r, g, b]: [f32; 3]| r + g + b;
    let hidden = |i: usize| {
        let lit = luminance(lit.base[i]);
        let share = (all[i] - objects[i]).max(0.0);
        match lit > 0.0 {
            true => share * (1.0 - luminance(shaded.base[i]) / lit).clamp(0.0, 1.0),
            false => 0.0,
        }
    };
    Some((0..all.len()).map(hidden).collect())
}

/// The picture of the ground; none once `cancelled` says so.
fn ground_of(
    prepared: &Prepared,
    transport: Transport,
    samples: u32,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Image> {
    let scene = prepared.scene();
    let rows = 0..scene.render.size_px[1];
    let mut options = RenderOptions {
        samples,
        shadows: transport.shadows,
        ..RenderOptions::default()
    };
    let render = |options: &RenderOptions| {
        let rendered = prepared.render_unless(cancelled, options, rows.clone(), &|_| {})?;
        Some(rendered.0)
    };
    let Some(mut batches) = transport.batches(&scene.camera, samples) else {
        return render(&options);
    };
    options.samples = batches.samples();
    while let Some(batch) = batches.next() {
        options.batch = Some(batch);
        batches.add(render(&options)?);
    }
    let mut image = batches.into_image()?;
    filter_traced(&mut image);
    Some(image)
}

/// The scene with its catcher as a white ground, before nothing, and with objects that are black and hide light.
fn with_ground_alone(scene: &Scene) -> Option<Scene> {
    let ground = scene.shadow_catcher.clone()?;
    let mut alone = scene.before_nothing();
    alone.shadow_catcher = None;
    let own = ground.mesh.triangle_materials.first().copied();
    for (i, material) in alone.materials.iter_mut().enumerate() {
        *material = match own == Some(i as u32) {
            true => white(material),
            false => black(material),
        };
    }
    for object in &mut alone.objects {
        (object.scratches, object.segments) = (Arc::default(), Arc::default());
        object.gratings.clear();
    }
    // Shapes of lamps are the last objects.
    let place = alone.objects.iter().take_while(|it| !it.is_lamp).count();
    alone.objects.insert(place, ground);
    Some(alone)
}

fn white(material: &Material) -> Material {
    Material {
        base: Base::Dielectric {
            ior: 1.0,
            base_color: [1.0; 3],
        },
        roughness: 1.0,
        ..material.clone()
    }
}

/// A material that reflects and sends nothing, cut out as it was.
fn black(material: &Material) -> Material {
    Material {
        base: Base::MetallicRoughness {
            base_color: [0.0; 3],
            metallic: 0.0,
        },
        emission: [0.0; 3],
        is_unlit: true,
        ..material.clone()
    }
}
