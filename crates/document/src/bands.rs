//! Scenes seen in bands of the spectrum. What is given in Rec.709 has a spectrum only where it is grey: a lamp then has that of white, a surface
//! reflects all wavelengths alike. A lamp by its temperature is a black body.

use crate::error::Error;
use hairline_model::texture::Texture;
use hairline_optics::spectrum::{
    Observer, WAVELENGTH_MAX_NM, WAVELENGTH_MIN_NM, black_body_rgb, black_body_seen_by,
};
use hairline_scene::{Base, Light, Scene};

/// Narrowest band that is drawn: spectra are tabulated every 5 nm.
const NARROWEST_NM: f64 = 1.0;
/// Largest difference of the channels of a grey, over the greatest of them.
const GREY: f64 = 1e-3;

/// The scene as it is seen in bands of the spectrum, each from one wavelength to a longer one: three at a time are the channels of its pictures, the
/// last ones several times where none are left. A channel is the mean over its band of what white light of radiance 1 would be there.
///
/// # Errors
/// A band that is no part of 380 to 780 nm, and all that has a colour without a spectrum.
pub fn in_bands(scene: &Scene, bands_nm: &[[f64; 2]]) -> Result<Vec<Scene>, Error> {
    for &[from, to] in bands_nm {
        let is_within = WAVELENGTH_MIN_NM <= from && to <= WAVELENGTH_MAX_NM;
        // Also true for NaN.
        if !(is_within && to - from >= NARROWEST_NM) {
            let found = format!("found the band from {from} to {to} nm");
            let right = format!(
                "must be {NARROWEST_NM} nm wide or wider, within {WAVELENGTH_MIN_NM} to {WAVELENGTH_MAX_NM} nm"
            );
            return Err(Error::new("bands", found, right));
        }
    }
    check_spectra(scene)?;
    let seen = |bands: &[[f64; 2]]| {
        let observer = Observer::of_bands([0, 1, 2].map(|c| bands[c.min(bands.len() - 1)]));
        let mut seen = scene.clone();
        for light in &mut seen.lights {
            if let Some(temperature_k) = light.temperature_k {
                let [_, of_white, _] = white_balanced(light);
                let body = black_body_seen_by(&observer, temperature_k);
                light.radiance = body.map(|c| c * of_white);
            }
        }
        Scene { observer, ..seen }
    };
    Ok(bands_nm.chunks(3).map(seen).collect())
}

fn check_spectra(scene: &Scene) -> Result<(), Error> {
    let colour = |what: &str, rgb: [f64; 3]| match is_grey(rgb) {
        true => Ok(()),
        false => Err(without_spectrum(format!("{what} {rgb:?}"))),
    };
    for (i, light) in scene.lights.iter().enumerate() {
        colour(&format!("the radiance of light {i}"), white_balanced(light))?;
    }
    for material in &scene.materials {
        let name = &material.name;
        let base = match material.base {
            Base::Mirror | Base::Metal(_) => [1.0; 3],
            Base::Covered { cover, .. } => cover.color,
            Base::ColoredMetal { base_color }
            | Base::Dielectric { base_color, .. }
            | Base::MetallicRoughness { base_color, .. } => base_color,
        };
        colour(&format!("the colour of material {name:?}"), base)?;
        colour(
            &format!("the emission of material {name:?}"),
            material.emission,
        )?;
        colour(
            &format!("the specular colour of material {name:?}"),
            material.specular.color,
        )?;
    }
    for object in &scene.objects {
        let mut colors = object.mesh.colors.iter();
        if let Some(color) = colors.find(|it| !is_grey([it[0], it[1], it[2]].map(f64::from))) {
            let at = format!("{color:?} at a corner of object {:?}", object.name);
            return Err(without_spectrum(at));
        }
    }
    if scene.textures.iter().any(is_coloured) {
        return Err(without_spectrum("a texture".to_owned()));
    }
    let mut map = scene.environment.iter().flat_map(|it| &it.background().rgb);
    if map.any(|rgb| !is_grey(rgb.map(f64::from))) {
        return Err(without_spectrum("the environment's map".to_owned()));
    }
    Ok(())
}

/// Radiance of a light over its black body's, where it has one.
fn white_balanced(light: &Light) -> [f64; 3] {
    let body = light.temperature_k.map_or([1.0; 3], black_body_rgb);
    let green = light.radiance[1] / body[1];
    // A channel of which the body has nothing tells nothing.
    [0, 1, 2].map(|c| match body[c] > 0.0 {
        true => light.radiance[c] / body[c],
        false => green,
    })
}

fn without_spectrum(what: String) -> Error {
    let right =
        "must be grey for bands of the spectrum, or a measured metal: a colour has no spectrum";
    Error::new("bands", format!("found {what}"), right)
}

fn is_grey(rgb: [f64; 3]) -> bool {
    let [least, most] = [f64::min, f64::max].map(|of| rgb.into_iter().reduce(of).unwrap_or(0.0));
    most - least <= GREY * most.abs()
}

fn is_coloured(texture: &Texture) -> bool {
    let mut texels = texture.levels.iter().take(1).flatten();
    texture.srgb && texels.any(|[r, g, b, _]| r != g || g != b)
}
