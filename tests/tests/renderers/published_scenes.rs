//! The method of 2018 and mixtures of its parts with the default's: the GPU against the CPU. Each part replaces its counterpart
//! alone, on either side.

use conformance::two_renderers::compare;
use conformance::{Sequence, middle};
use hairline_gpu::{Renderer, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer, Picture};
use hairline_optics::mask::Mask;
use hairline_optics::method::{
    Band, Chords, Gather, LightAt, Lookup, Method, PixelFilter, Spectrum, SphereBase,
};
use hairline_optics::published::sine_integral::SineIntegral;
use hairline_reference::closed_form::{self, Prepared};
use hairline_scene::{Environment, Scene};

const OURS: Method = Method {
    spectrum: Spectrum::Table,
    chords: Chords::Roots,
    band: Band::Lines,
    footprint: PixelFilter::Gaussian,
    mask: Mask::Energy,
    sphere_base: SphereBase::Cosines,
    lookup: Lookup::Tiles,
    gather: Gather::Exact,
    light_at: LightAt::Pixels,
};
const THEIRS: Method = Method::PUBLISHED;

/// A difference between methods that two renderers of one method, 0.12 % apart at most, could not be taken for.
const SEEN: f64 = 7e-3;

/// Both renderers with a scene at hand.
struct Both<'a> {
    name: &'a str,
    scene: &'a Scene,
    prepared: Prepared<'a>,
    renderer: Renderer,
}

impl<'a> Both<'a> {
    /// None where there is no driver.
    fn new(name: &'a str, scene: &'a Scene) -> Option<Self> {
        let gpu = headless::test_gpu()?;
        Some(Self {
            name,
            scene,
            prepared: Prepared::new(scene),
            renderer: gpu.block_on(Renderer::new(gpu)).unwrap(),
        })
    }

    fn gpu(&mut self, method: &Method) -> Image {
        let Self {
            scene,
            prepared,
            renderer,
            ..
        } = self;
        let gpu = renderer.gpu().clone();
        let picture = async {
            let (index, tables) = (prepared.scratches(), prepared.tables());
            let uploaded = renderer.upload(scene, index, tables, method).await?;
            renderer
                .render(scene, &uploaded, &Default::default(), &|_| {})
                .await
        };
        let image: Result<Image, hairline_gpu::Error> = gpu.block_on(picture);
        image.unwrap_or_else(|error| panic!("{method:?}: {error}"))
    }

    fn cpu(&self, method: &Method) -> Image {
        let options = closed_form::RenderOptions {
            samples: 1,
            method: *method,
        };
        self.prepared.render(&options, &|_| {})
    }

    /// Fails where the two differ by more than 0.5 % in any layer.
    fn check(&mut self, what: &str, method: &Method) -> Image {
        let (gpu, cpu) = (self.gpu(method), self.cpu(method));
        let name = format!("{}, {what}", self.name);
        compare(&name, self.scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
        gpu
    }
}

fn wavelengths(count: usize, si: SineIntegral) -> Spectrum {
    Spectrum::Wavelengths { count, si }
}

/// The largest relative rms difference of a layer.
fn difference(a: &Image, b: &Image) -> f64 {
    let largest = [Layer::Base, Layer::Scratches, Layer::Density]
        .map(|layer| layer_difference(a, b, layer, None).relative_rms())
        .into_iter()
        .fold(0.0, f64::max);
    println!("differ by {largest:.2e}");
    largest
}

/// Pixels far wider than the coherence window.
#[test]
fn their_parts_among_ours() {
    let scene = middle("plate.toml", 256, [64; 2]);
    let Some(mut both) = Both::new("plate", &scene) else {
        return;
    };
    let ours = both.cpu(&OURS);
    let steps = both.check(
        "steps among ours",
        &Method {
            chords: Chords::Steps,
            ..OURS
        },
    );
    // Both ways to find chords are exact, so these are the same picture.
    assert!(difference(&steps, &ours) < 1e-3);
    for (what, method) in [
        (
            "wavelengths among ours",
            Method {
                spectrum: THEIRS.spectrum,
                ..OURS
            },
        ),
        (
            "middle line among ours",
            Method {
                band: Band::MiddleLine,
                ..OURS
            },
        ),
        (
            "blend among ours",
            Method {
                footprint: PixelFilter::Published,
                ..OURS
            },
        ),
        (
            "pivot among ours",
            Method {
                sphere_base: SphereBase::Pivot,
                ..OURS
            },
        ),
    ] {
        let picture = both.check(what, &method);
        // A part that the shader overlooked would be seen: eight wavelengths, the least, differ from the table by 0.9 %.
        assert!(difference(&picture, &ours) > SEEN, "{what}");
    }
}

#[test]
fn our_parts_among_theirs() {
    let scene = middle("plate.toml", 256, [64; 2]);
    let Some(mut both) = Both::new("plate", &scene) else {
        return;
    };
    let theirs = both.check("theirs", &THEIRS);
    let roots = both.check(
        "roots among theirs",
        &Method {
            chords: Chords::Roots,
            ..THEIRS
        },
    );
    assert!(difference(&roots, &theirs) < 1e-3);
    for (what, method) in [
        (
            "table among theirs",
            Method {
                spectrum: Spectrum::Table,
                ..THEIRS
            },
        ),
        (
            "lines among theirs",
            Method {
                band: Band::Lines,
                ..THEIRS
            },
        ),
        (
            "Gaussian among theirs",
            Method {
                footprint: PixelFilter::Gaussian,
                ..THEIRS
            },
        ),
        (
            "energy among theirs",
            Method {
                mask: Mask::Energy,
                ..THEIRS
            },
        ),
        (
            "cosines among theirs",
            Method {
                sphere_base: SphereBase::Cosines,
                ..THEIRS
            },
        ),
    ] {
        let picture = both.check(what, &method);
        assert!(difference(&picture, &theirs) > SEEN, "{what}");
    }
}

/// Pixels finer than the coherence window; what else there is to choose.
#[test]
fn wavelengths_masks_and_lists() {
    let scene = middle("closeup.toml", 256, [64; 2]);
    let Some(mut both) = Both::new("closeup", &scene) else {
        return;
    };
    for (what, method) in [
        (
            "3 wavelengths",
            Method {
                spectrum: wavelengths(3, SineIntegral::Exact),
                ..THEIRS
            },
        ),
        (
            "16 wavelengths",
            Method {
                spectrum: wavelengths(16, SineIntegral::Exact),
                ..THEIRS
            },
        ),
        (
            "linear mask",
            Method {
                mask: Mask::Linear,
                ..THEIRS
            },
        ),
    ] {
        both.check(what, &method);
    }
    let off = Method {
        footprint: PixelFilter::Off,
        ..THEIRS
    };
    let walked = both.check("no footprint", &off);
    let listed = both.check(
        "no footprint, lists",
        &Method {
            lookup: Lookup::Triangles,
            ..off
        },
    );
    // The same scratches in another order of summation (2e-5).
    assert!(difference(&listed, &walked) < 1e-4);
    assert!(difference(&walked, &both.gpu(&THEIRS)) > SEEN);
}

/// A star, which is cut into triangles, beside nine other lights.
#[test]
fn a_star_in_triangles() {
    let scene = middle("lights.toml", 256, [48; 2]);
    let Some(mut both) = Both::new("lights", &scene) else {
        return;
    };
    both.check("theirs", &THEIRS);
    both.check(
        "steps among ours",
        &Method {
            chords: Chords::Steps,
            ..OURS
        },
    );
}

/// The talk has no environment; here it is integrated cell by cell, with either spectrum and either depth.
#[test]
fn under_a_map() {
    let mut random = Sequence(7);
    let mut map = Picture::new([128, 64]);
    for texel in &mut map.rgb {
        *texel = [0.2, 0.6, 1.0].map(|c| c + random.next());
    }
    let mut scene = middle("closeup.toml", 256, [32; 2]);
    scene.environment = Some(Environment::from_map(map, 0.4, 1.0, true));
    let Some(mut both) = Both::new("closeup under a map", &scene) else {
        return;
    };
    both.check("theirs", &THEIRS);
    both.check(
        "wavelengths among ours",
        &Method {
            spectrum: THEIRS.spectrum,
            ..OURS
        },
    );
}
