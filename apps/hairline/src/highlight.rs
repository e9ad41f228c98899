//! `--highlight`: a light moved to where its mirror image lies at a pixel.

use anyhow::anyhow;
use glam::{DVec2, DVec3};
use hairline_document::description::Description;
use hairline_document::place_light::place_highlight;
use hairline_document::text::shown;
use hairline_index::TriangleIndex;
use hairline_scene::Scene;

use crate::size_limit::SIDE_MAX_PX;
use hairline_render::failure::Failure;

/// Pixel where a highlight should lie, and the light for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Highlight {
    /// The pixel, from the upper left corner.
    pub pixel: [f64; 2],
    /// The name of the light; none: the first.
    pub light: Option<String>,
}

/// Parses `X,Y` or `X,Y,LIGHT`.
pub fn parse(text: &str) -> Result<Highlight, String> {
    let mut parts = text.splitn(3, ',');
    let mut pixel = || {
        let number = parts.next()?.trim().parse::<f64>().ok();
        number.filter(|it| (0.0..=f64::from(SIDE_MAX_PX)).contains(it))
    };
    match (pixel(), pixel()) {
        (Some(x), Some(y)) => Ok(Highlight {
            pixel: [x, y],
            light: parts.next().map(str::to_owned),
        }),
        _ => Err(
            "write a pixel X,Y, as in 640,360, and the name of a light behind it if need be"
                .to_owned(),
        ),
    }
}

/// Moves the light in the description; `scene` is the built scene.
pub fn place(
    wanted: &Highlight,
    description: &mut Description,
    scene: &Scene,
) -> Result<(), Failure> {
    let refuse = |why: String| Err(Failure::Input(anyhow!("--highlight: {why}")));
    let [x, y] = wanted.pixel;
    let [width, height] = scene.render.size_px;
    if x >= f64::from(width) || y >= f64::from(height) {
        return refuse(format!(
            "the pixel {x},{y} lies outside of the picture of {width}x{height}"
        ));
    }
    let mut lights = description.lights.iter_mut().filter(|light| !light.hidden);
    let light = match &wanted.light {
        None => lights.next(),
        Some(name) => lights.find(|light| light.name.as_ref() == Some(name)),
    };
    let Some(light) = light else {
        return refuse(match &wanted.light {
            None => "the scene has no `[[light]]` that could be moved".to_owned(),
            Some(name) => format!(
                "the scene has no light called \"{}\" that is not hidden",
                shown(name)
            ),
        });
    };
    let frame = scene.camera.frame(scene.render.size_px);
    let ray = frame.camera_ray(DVec2::new(x, y) + 0.5).normalize();
    let Some(hit) = TriangleIndex::build(scene).intersect(frame.position_m, ray) else {
        return refuse(format!("there is no surface at the pixel {x},{y}"));
    };
    let mesh = &scene.objects[hit.object as usize].mesh;
    let corners = mesh.triangles[hit.triangle as usize];
    let [b, c] = hit.barycentric;
    let shares = [1.0 - b - c, b, c];
    let normal: DVec3 = corners
        .iter()
        .zip(shares)
        .map(|(corner, share)| share * mesh.normals[*corner as usize].as_dvec3())
        .sum();
    let point_m = frame.position_m + ray * hit.distance_m;
    place_highlight(light, frame.position_m, point_m, normal);
    Ok(())
}
