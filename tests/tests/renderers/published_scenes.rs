//! The method of 2018 with each of its options: the GPU against the CPU.

use conformance::two_renderers::compare;
use conformance::{Sequence, middle};
use hairline_cpu::closed_form::{self, Prepared};
use hairline_fixtures::SceneFile;
use hairline_gpu::{Renderer, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer, Picture};
use hairline_optics::mask::Mask;
use hairline_published::sine_integral::SineIntegral;
use hairline_published::{Method, PublishedMethod, Structure};
use hairline_scene::Scene;

/// A difference between methods that two renderers of one method, 0.12 % apart at most, could not be taken for.
const SEEN: f64 = 7e-3;

/// The method without anti-aliasing.
const POINT: PublishedMethod = PublishedMethod {
    structure: Structure::Bvh,
    anti_aliasing: false,
    si: SineIntegral::Fast,
};

/// Both renderers with a scene at hand.
struct RendererPair<'a> {
    name: &'a str,
    scene: &'a Scene,
    prepared: Prepared<'a>,
    renderer: Renderer,
}

impl<'a> RendererPair<'a> {
    /// Prepares both renderers; none where there is no driver.
    fn new(name: &'a str, scene: &'a Scene) -> Option<Self> {
        let gpu = headless::test_gpu()?;
        Some(Self {
            name,
            scene,
            prepared: Prepared::new(scene),
            renderer: gpu.block_on(Renderer::new(gpu)).unwrap(),
        })
    }

    /// The GPU's picture. Fails where it differs from the CPU's by more than 0.5 % in any layer.
    fn check(&mut self, switches: PublishedMethod, mask: Mask) -> Image {
        let Self {
            name,
            scene,
            prepared,
            renderer,
        } = self;
        let method = Method {
            published: Some(switches),
            mask,
        };
        let gpu = renderer.gpu().clone();
        let picture = gpu.block_on(async {
            let (index, tables) = (prepared.laid(), prepared.tables());
            let method = method.on_gpu();
            let uploaded = renderer.upload(scene, index, tables, &method).await?;
            let options = Default::default();
            renderer.render(scene, &uploaded, &options, &|_| {}).await
        });
        let picture = picture.unwrap_or_else(|error: hairline_gpu::Error| panic!("{error}"));
        let options = closed_form::RenderOptions {
            samples: 1,
            mask,
            method: method.on_cpu(),
            ..Default::default()
        };
        let cpu = prepared.render(&options, &|_| {});
        let what = format!("{name}, {switches:?}, {mask:?}");
        compare(&what, scene, &picture, &cpu).unwrap_or_else(|error| panic!("{error}"));
        picture
    }
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

/// A plate, whose pixels are far wider than the coherence window, and a closeup, whose pixels are finer, where footprints alone differ.
#[test]
#[ignore = "long: cargo long"]
fn each_switch() {
    let usual = PublishedMethod::default();
    for name in ["plate", "closeup"] {
        let scene = middle(&format!("{name}.toml"), 256, [32; 2]);
        let Some(mut both) = RendererPair::new(name, &scene) else {
            return;
        };
        let published = both.check(usual, Mask::Density);
        let point = both.check(POINT, Mask::Density);
        assert!(difference(&point, &published) > SEEN);
        if name == "closeup" {
            continue;
        }
        let exact = PublishedMethod {
            si: SineIntegral::Exact,
            ..usual
        };
        assert!(difference(&both.check(exact, Mask::Density), &published) > 1e-4);
        for mask in [Mask::Energy, Mask::Linear] {
            assert!(difference(&both.check(usual, mask), &published) > SEEN);
        }
    }
}

/// A disk of some thousand triangles, as a model has; the lists of two large ones are too long for a software driver.
fn fine_disk() -> Scene {
    let radii: Vec<[f64; 2]> = (0..=32).map(|i| [0.001 * f64::from(i), 0.0]).collect();
    SceneFile::seen_from([0.0, -0.05, 0.1])
        .fov_y_deg(20.0)
        .size_px([48, 48])
        .metal("steel", "iron")
        .with_lines("roughness = 0.1")
        .object(
            "disk",
            "steel",
            &format!("lathe = {{ segments = 64, profile_m = {radii:?} }}"),
        )
        .random("disk", 1000)
        .with_lines("length_m = 0.02\nwidth_um = 3.0\ndepth_nm = 220.0")
        .sphere([0.0, 0.2, 0.4], 0.04, 40.0)
        .scene()
}

#[test]
fn lists_of_triangles() {
    let scene = fine_disk();
    let Some(mut both) = RendererPair::new("disk", &scene) else {
        return;
    };
    let by_hierarchy = both.check(POINT, Mask::Density);
    let lists = PublishedMethod {
        structure: Structure::TriangleLists,
        ..POINT
    };
    // The same scratches in another order of summation (2e-5).
    assert!(difference(&both.check(lists, Mask::Density), &by_hierarchy) < 1e-4);
}

/// A star, which is cut into triangles, beside nine other lights.
#[test]
fn a_star_in_triangles() {
    let scene = middle("lights.toml", 256, [48; 2]);
    let Some(mut both) = RendererPair::new("lights", &scene) else {
        return;
    };
    both.check(PublishedMethod::default(), Mask::Density);
}

/// The talk has no environment; here it is integrated cell by cell.
#[test]
fn under_a_map() {
    let mut random = Sequence(7);
    let mut map = Picture::new([128, 64]);
    for texel in &mut map.rgb {
        *texel = [0.2, 0.6, 1.0].map(|c| c + random.next());
    }
    let mut scene = middle("closeup.toml", 256, [32; 2]);
    scene.environment = Some(hairline_sky::from_map(map, 0.4, 1.0, true));
    let Some(mut both) = RendererPair::new("closeup under a map", &scene) else {
        return;
    };
    both.check(PublishedMethod::default(), Mask::Density);
}

/// Its tables are all that a change of the method writes.
#[test]
fn a_change_of_method_writes_its_tables_alone() {
    let scene = middle("plate.toml", 256, [32; 2]);
    let Some(mut both) = RendererPair::new("plate", &scene) else {
        return;
    };
    let (prepared, renderer) = (&both.prepared, &mut both.renderer);
    let (index, tables) = (prepared.scratches(), prepared.tables());
    let gpu = renderer.gpu().clone();
    let written = gpu.block_on(async {
        let own = Method::default().on_gpu();
        let mut uploaded = renderer.upload(&scene, index, tables, &own).await?;
        let published = Method::PUBLISHED.on_gpu();
        let update = renderer.update(&mut uploaded, &scene, index, tables, &published);
        update.await?;
        Ok::<_, hairline_gpu::Error>(uploaded.written().to_vec())
    });
    let names: Vec<_> = written.unwrap().iter().map(|it| it.what).collect();
    let tables = [
        "wavelengths",
        "triangle lists",
        "scratch tree",
        "sphere lobe table",
    ];
    assert_eq!(names, tables);
}
