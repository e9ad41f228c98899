//! The command line.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use hairline_console::{Backend, EXIT_CODES, Switch, View};
use hairline_document::DEFAULT_SAMPLES;
use hairline_document::description::{Camera, Object};
use hairline_document::export::BAKE_PX;
use hairline_document::navigate;
use hairline_document::wear::Wear;
use hairline_image::{FPS_MAX, Layer, ToneMap};

use crate::compare::limits::{self, Limit};
use crate::highlight;
use crate::method_flags::{Mask, MethodFlags};
use crate::size_limit::SIDE_MAX_PX;

/// Renders the coloured, hair-thin scratches of worn surfaces. Without a command: opens the viewer on the built-in scene.
#[derive(Debug, Parser)]
#[command(version, after_help = EXIT_CODES)]
pub struct Cli {
    /// Command.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// A subcommand.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Edit a scene in a window: scratches, lights and materials, live.
    View(View),
    /// Render a scene to a picture.
    Render(Box<Render>),
    /// Compare a picture with a reference: figures, and a report to look at.
    Compare(Compare),
    /// Render a scene by Monte Carlo, slowly, with its variance: the reference to which the closed forms of `render` must converge.
    Reference(Reference),
    /// Measure how long the default method and the published one take, and how far they are from the truth.
    Bench(Bench),
    /// Show the version, the graphics adapters and their properties, and the backends available; or the contents of a scene.
    Info(Info),
    /// Write the laid scratches of an object as a list (CSV), for other programs: three.js, game engines, Blender; with --own-frame for
    /// `pattern = "file"` of scenes.
    Scratches(Scratches),
    /// Write a scene as one glTF file (.glb) that other programs open, with its scratches by the extension HAIRLINE_scratches. Hairline opens it as
    /// the same scene. Or write its model as one file that phones show (.usdz).
    Export(Export),
    /// Print a shell's completions of this command line.
    Completions(Completions),
    /// Print the manual page (roff), of all commands or of one: `hairline man render | man -l -`.
    Man(Man),
}

/// `hairline man`
#[derive(Args, Debug)]
pub struct Man {
    /// Command that the page is to be about alone.
    pub command: Option<String>,
}

/// `hairline info`
#[derive(Args, Debug)]
pub struct Info {
    /// A scene file (TOML) or a model (.glb, .gltf, .obj, .stl); - reads a scene from stdin. Without it: what there is on this machine.
    pub scene: Option<PathBuf>,
    /// Print the scene as JSON.
    #[arg(long, requires = "scene")]
    pub json: bool,
}

/// `hairline scratches`
#[derive(Args, Debug)]
pub struct Scratches {
    /// The scene file (TOML), or a model (.glb, .gltf, .obj, .stl); - reads a scene from stdin.
    pub scene: PathBuf,
    /// The list: a straight piece a row, in world space, metres; then the number of its scratch and the surface's normal.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// The object, by its name. Without it: the only one that has scratches.
    #[arg(long, value_name = "NAME")]
    pub object: Option<String>,
    /// Only this layer of scratches, counted from 0.
    #[arg(long, value_name = "N")]
    pub layer: Option<u32>,
    /// In the object's own frame, in place of world space: `pattern = "file"` lays such a list on the object again.
    #[arg(long)]
    pub own_frame: bool,
}

/// `hairline export`
#[derive(Args, Debug)]
pub struct Export {
    /// The scene file (TOML), or a model (.glb, .gltf, .obj, .stl), which gets the wear and the lamps that `render` shows it with; - reads a scene from stdin.
    pub scene: PathBuf,
    /// The file: .glb; or .usdz, for phones: what the scene is about, with its materials, without lights and scratches.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Whether the scratches are in it as they lie too, 44 bytes for each straight piece, for programs that lay none by themselves. Hairline and its
    /// packages for three.js and Bevy lay them.
    #[arg(long, value_enum, default_value_t = Switch::Off)]
    pub laid: Switch,
    /// Write the model alone, with its scratches drawn into normal maps and roughness maps of so many texels a side, for programs that know no
    /// scratches. Its texture coordinates must not overlap.
    #[arg(long, value_name = "SIZE_PX", allow_negative_numbers = true, value_parser = whole::<u32>(BAKE_PX))]
    pub bake: Option<u32>,
    /// The time of the models' animations, seconds, at which the scratches lie, in place of the scene's.
    #[arg(long, value_name = "SECONDS", value_parser = parse_time)]
    pub time: Option<f64>,
    /// Which scratches, view and lamps of the scene.
    #[command(flatten)]
    pub scene_flags: SceneFlags,
}

/// Which scratches, view and lamps of a scene: flags of several commands.
#[derive(Args, Debug)]
pub struct SceneFlags {
    /// Other scratches of the same kinds: added to the seed of each layer.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// See by this camera of a model's file: its name, or its number from 0.
    #[arg(long, value_name = "CAMERA")]
    pub camera: Option<String>,
    /// Light the scene for its scratches, in the place of its lights and its environment: up to three small hard lamps whose highlights lie where
    /// most of the surface shows the colours around them, two dim strips and a dark room. A model without lights of its own is lit so anyway.
    #[arg(long)]
    pub show_scratches: bool,
    /// Wear of the objects that the scene is about, in the place of the wear that they have: other scratches stay.
    #[arg(long, value_name = "WEAR", value_parser = wears(), ignore_case = true)]
    pub wear: Option<Wear>,
}

/// `hairline completions`
#[derive(Args, Debug)]
pub struct Completions {
    /// The shell.
    pub shell: clap_complete::Shell,
}

/// `hairline render`
#[derive(Args, Debug)]
pub struct Render {
    /// The scene file (TOML), or a model (.glb, .gltf, .obj, .stl), which is shown in a lit scene; - reads a scene from stdin. Without it: the
    /// built-in scene.
    pub scene: Option<PathBuf>,
    /// The picture: .png (tone-mapped, sRGB) or .exr (linear, 32-bit float, layers); - writes a .png to stdout. Without it: the scene's
    /// name with .png, or hairline.png, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Renderer.
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub backend: Backend,
    /// Width and height in pixels, in place of the scene's.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Samples for each pixel that has an edge or a crease in it; elsewhere one is enough. With shadows also the rays to each light from every
    /// pixel: they add up, and Ctrl-C ends with the picture of those that are done. More than 4 are rounded up to multiples of 4.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_SAMPLES, allow_negative_numbers = true, value_parser = whole::<u32>(1..=1024))]
    pub samples: u32,
    /// Whether objects hide lights and the environment from one another: as many rays to each light as there are samples.
    /// [default: on; the published method has none]
    #[arg(long, value_enum)]
    pub shadows: Option<Switch>,
    /// Objects that light may go by on its way besides the one that is seen, with shadows. [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(0..=64))]
    pub bounces: Option<u32>,
    /// Whether the light that rays found, shadows and other objects' light, is filtered over each surface: less grain. Scratches, textures and
    /// highlights stay as sharp as they are, and more samples leave less to filter.
    #[arg(long, value_enum, default_value_t = Switch::On)]
    pub filter: Switch,
    /// Render before a transparent background: the picture's alpha is the share of each pixel that surfaces cover. The environment lights them and
    /// is not seen. Of the ground that a model by itself gets, the shadows are left.
    #[arg(long)]
    pub transparent: bool,
    /// Leave the ground out but for the shadows on it, as a black whose alpha is the share of its light that objects hide. A scene without a ground
    /// gets one.
    #[arg(long)]
    pub shadows_only: bool,
    /// Put a picture behind the objects (.png, .jpg, .webp), in the place of the environment; in a .png alone.
    #[arg(long, value_name = "PICTURE")]
    pub behind: Option<PathBuf>,
    /// Bits of each channel of a .png, in place of the scene's. [default: 8]
    #[arg(long, value_name = "BITS", value_parser = png_bits())]
    pub png_bits: Option<u32>,
    /// Render bands of the spectrum in place of colours, a channel each: from A to B nm by equal steps. Writes an .exr. What has a colour and no spectrum
    /// is refused: lamps must be grey or have a temperature, surfaces be grey or measured metals.
    #[arg(long, value_name = "A:B:STEP", value_parser = parse_bands, conflicts_with_all = ["frames", "labels", "watch", "transparent", "shadows_only", "behind"])]
    pub bands: Option<Bands>,
    /// Write which scratches each pixel shows too, to an .exr by the convention of Cryptomatte.
    #[arg(long, value_name = "FILE")]
    pub labels: Option<PathBuf>,
    /// Exposure in stops, in place of the scene's: radiances are multiplied by 2^EV before the tone map of a .png.
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_exposure)]
    pub exposure: Option<f64>,
    /// The curve from radiance to a .png, in place of the scene's.
    #[arg(long, value_name = "CURVE", value_parser = tone_maps())]
    pub tone_map: Option<ToneMap>,
    /// The time of the models' animations, seconds, in place of the scene's. With --frames also A:B: from A in the first frame to
    /// B in the last one, by equal steps.
    #[arg(long, value_name = "A[:B]", allow_negative_numbers = true, value_parser = parse_times)]
    pub time: Option<[f64; 2]>,
    /// Put the highlight here: move a light so that its mirror image lies at this pixel of the picture, counted from the upper left
    /// corner. The first light that is not hidden, or the one of this name.
    #[arg(long, value_name = "X,Y[,LIGHT]", value_parser = highlight::parse, conflicts_with = "show_scratches")]
    pub highlight: Option<highlight::Highlight>,
    /// Which scratches, view and lamps of the scene.
    #[command(flatten)]
    pub scene_flags: SceneFlags,
    /// Render again whenever the scene or one of its files changes, until Ctrl-C.
    #[arg(long, conflicts_with_all = ["frames", "turntable", "zoom", "animation", "stability"])]
    pub watch: bool,
    /// Render all `[[look]]`s of the scene, each to NAME-LOOK.png for -o NAME.png (or .exr).
    #[arg(long, conflicts_with_all = ["frames", "turntable", "zoom", "animation", "stability", "bands", "labels"])]
    pub looks: bool,
    /// Many pictures in place of one.
    #[command(flatten)]
    pub sequence: SequenceFlags,
    /// Method by which scratches are rendered.
    #[command(flatten)]
    pub method: MethodFlags,
}

/// What a turntable turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Turns {
    /// The camera, about its target
    #[default]
    Camera,
    /// The objects, before the camera and under the lights
    Object,
    /// Lights, studio and environment, about objects and camera that stand still
    Lights,
}

impl From<Turns> for navigate::Turns {
    fn from(turns: Turns) -> Self {
        match turns {
            Turns::Camera => Self::Camera,
            Turns::Object => Self::Object,
            Turns::Lights => Self::Lights,
        }
    }
}

/// A sequence of pictures on a way of the camera.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Sequences")]
pub struct SequenceFlags {
    /// Number of pictures, NAME-0001.png and on for -o NAME.png (or .exr), on the path that --turntable and --zoom give, or through the times of
    /// --time A:B. For -o NAME.apng or NAME.mp4 one animation.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1..=100_000))]
    pub frames: Option<u32>,
    /// Turn the camera about its target, around its `up`, by so many degrees in all, counter-clockwise seen from above.
    /// The step after the last frame completes them: a full turn of 360 shows no view twice.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = parse_turn)]
    pub turntable: Option<f64>,
    /// What --turntable turns. `object`: lights and environment go round with the camera, so that objects turn before it and the light on a floor
    /// stands still. `lights`: they go round objects and camera that stand still. Each frame is a scene of its own then.
    #[arg(
        long,
        value_name = "WHAT",
        default_value = "camera",
        requires = "turntable"
    )]
    pub turns: Turns,
    /// Divide the camera's distance to its target by A in the first frame, by B in the last one, by equal factors in
    /// between. 1 is the scene's own view; 1:8 comes within an eighth of the distance, where the target is 8 times as large.
    #[arg(long, value_name = "A:B", value_parser = parse_zoom)]
    pub zoom: Option<[f64; 2]>,
    /// Write one animated PNG (.apng or .png), or MPEG-4 (.mp4) by ffmpeg on PATH, in place of numbered pictures; with -o NAME.png both.
    #[arg(long, value_name = "FILE")]
    pub animation: Option<PathBuf>,
    /// Frames of the animation in a second. [default: 30]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u16>(1..=FPS_MAX))]
    pub fps: Option<u16>,
    /// Render the frames with 64 samples in every pixel as well, and print how steady both sequences are: mean FLIP between
    /// each frame and the one before it, moved to where its surfaces are now. Takes 64 times as long.
    #[arg(long)]
    pub stability: bool,
}

/// `hairline compare`
#[derive(Args, Debug)]
#[command(after_help = COMPARE_EXIT_CODES)]
pub struct Compare {
    /// The picture: .exr or .png.
    pub a: PathBuf,
    /// The reference: .exr or .png.
    pub b: PathBuf,
    /// A report to look at: one .html file that needs no other, with the pictures, error maps and all figures.
    #[arg(short, long, value_name = "REPORT")]
    pub output: Option<PathBuf>,
    /// Print the figures as JSON. null stands for an infinite one.
    #[arg(long)]
    pub json: bool,
    /// Compare this layer only. May be given several times.
    #[arg(long = "layer", value_name = "NAME", value_parser = layers())]
    pub layers: Vec<Layer>,
    /// Exposure in stops at which FLIP, PSNR and the report see an .exr: radiances are multiplied by 2^EV.
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_exposure)]
    pub exposure: f64,
    /// The curve by which FLIP, PSNR and the report see an .exr. A .png is taken as it is.
    #[arg(long, value_name = "CURVE", default_value = ToneMap::default().name(), value_parser = tone_maps())]
    pub tone_map: ToneMap,
    /// Fail, with exit code 1, if this figure is larger: `flip=0.05`, or of another layer than the beauty
    /// `scratches.relative-rms=0.01`. The figures: rms, relative-rms, relmse, max, flip, flip95, rms-beyond-noise,
    /// relative-rms-beyond-noise, z2. May be given several times. Values that are NaN or infinite fail too.
    #[arg(long, value_name = "METRIC=VALUE", value_parser = limits::parse_above)]
    pub fail_above: Vec<Limit>,
    /// Fail, with exit code 1, if this figure, the larger the better, is smaller: `psnr=40`.
    #[arg(long, value_name = "METRIC=VALUE", value_parser = limits::parse_below)]
    pub fail_below: Vec<Limit>,
}

const COMPARE_EXIT_CODES: &str = "Exit codes: 0 done; 1 a figure is beyond its limit, or the work failed; \
                                  2 the command line is wrong or the pictures cannot be compared.";

/// `hairline reference`
#[derive(Args, Debug)]
#[command(after_help = REFERENCE_HELP)]
pub struct Reference {
    /// The scene file (TOML), or a model (.glb, .gltf, .obj, .stl), which is shown in a lit scene; - reads a scene from stdin.
    pub scene: PathBuf,
    /// The picture: .exr (linear, layers, variance; can be gone on with) or .png (tone-mapped, sRGB). Without it: the scene's
    /// name with -reference.exr, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Model of the waves at a scratch.
    #[arg(long, value_enum, default_value_t = Model::Separable)]
    pub model: Model,
    /// Samples for each pixel, rounded up to whole batches. Without it 1024, or with --time as many as fit.
    #[arg(long, visible_alias = "samples", value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1..=16_777_216))]
    pub spp: Option<u32>,
    /// Stop sampling after this time: seconds, or with units as in 5m or 1h30m.
    #[arg(long, value_name = "DURATION", value_parser = parse_duration)]
    pub time: Option<Duration>,
    /// Go on from the picture if it is there and has the same scene and flags.
    #[arg(long)]
    pub resume: bool,
    /// Surfaces that light may meet on its way besides the one that is seen. 0: direct light, as the closed forms.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<u32>(0..=64))]
    pub bounces: u32,
    /// Whether objects hide lights from one another.
    #[arg(long, value_enum, default_value_t = Switch::Off)]
    pub shadows: Switch,
    /// Energy that the base loses to scratches, for the separable model. [default: energy]
    #[arg(long, value_enum)]
    pub mask: Option<Mask>,
    /// Width and height in pixels, in place of the scene's.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Other scratches of the same kinds, as for `render`: added to the seed of each layer.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// Other samples of the same picture: its noise, and nothing else.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true
    )]
    pub sample_seed: u64,
    /// Exposure in stops, in place of the scene's: radiances are multiplied by 2^EV before the tone map of a .png.
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_exposure)]
    pub exposure: Option<f64>,
}

const REFERENCE_HELP: &str =
    "Ctrl-C stops and saves what there is, which is no failure; a second Ctrl-C gives up at once.";

/// `hairline bench`
#[derive(Args, Debug)]
pub struct Bench {
    /// A scene file (TOML) to measure at its own size. Without it: the bench's own scene, through all parts.
    pub scene: Option<PathBuf>,
    /// Write the figures as JSON.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the printed Markdown tables to a file.
    #[arg(short, long, value_name = "REPORT.md")]
    pub output: Option<PathBuf>,
    /// Renderer. auto: a graphics adapter, be it a software driver, if there is one.
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub backend: Backend,
    /// Width and height in pixels, in place of the scene's. [default: 1280x720, the talk's]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Scratches of the bench's own scene. [default: 10000, the talk's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1..=1_000_000))]
    pub scratches: Option<u32>,
    /// A quarter of the pixels, few repetitions, short references, fewer places along each curve: a first impression in a minute or so.
    #[arg(long)]
    pub quick: bool,
    /// Measure this part only. May be given several times.
    #[arg(long, value_enum, value_name = "PART")]
    pub part: Vec<BenchPart>,
    /// Repetitions of each cell, in place of as many as fit the time.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1..=1000))]
    pub repetitions: Option<u32>,
    /// Write the bench's scene to a file and measure nothing.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "json", "output", "part"])]
    pub write_scene: Option<PathBuf>,
}

/// A part of `hairline bench`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BenchPart {
    /// The talk's table: intersection only, sphere, triangle; three zooms; with anti-aliasing and without.
    Table,
    /// Curve from a thousand scratches to a million.
    Scratches,
    /// A million scratches from a tenth of the zoom to eight times it.
    Zoom,
    /// Curve from one light to 64.
    Lights,
    /// Curve from half the size to twice it.
    Pixels,
}

/// Model of the waves at a scratch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Model {
    /// The model of the closed forms: each scratch on its own, its dependence on angles separated.
    Separable,
    /// All phases: interference between scratches and with the base, exact ends, oblique paths.
    Full,
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| {
        text.parse::<u32>()
            .ok()
            .filter(|n| (1..=SIDE_MAX_PX).contains(n))
    };
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| {
            format!("write WIDTHxHEIGHT, as in 1280x720, with sides from 1 to {SIDE_MAX_PX}")
        })
}

/// Parser for a whole number within a range. The type is that of the flag: clap compares them where the program runs, and a literal alone would be an `i32`.
fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| {
            let (least, most) = (range.start(), range.end());
            format!("must be a whole number from {least} to {most}")
        })
    }
}

fn tone_maps() -> impl TypedValueParser<Value = ToneMap> {
    by_name(ToneMap::ALL, ToneMap::name)
}

fn png_bits() -> impl TypedValueParser<Value = u32> {
    PossibleValuesParser::new(["8", "16"]).map(|bits| if bits == "16" { 16 } else { 8 })
}

fn wears() -> impl TypedValueParser<Value = Wear> {
    by_name(Wear::ALL, Wear::name)
}

fn layers() -> impl TypedValueParser<Value = Layer> {
    by_name(Layer::ALL, Layer::name)
}

/// Parser for one of `all`, by its name.
fn by_name<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |given| {
        all.into_iter()
            .find(|one| name(*one).eq_ignore_ascii_case(&given))
            .ok_or("unknown name")
    })
}

/// Range of a zoom's factors. The nearest place for a camera in a scene is known when the scene is read.
const ZOOMS: RangeInclusive<f64> = 1e-3..=1e5;

fn parse_zoom(text: &str) -> Result<[f64; 2], String> {
    let factor = |text: &str| text.parse::<f64>().ok().filter(|f| ZOOMS.contains(f));
    text.split_once(':')
        .and_then(|(from, to)| Some([factor(from)?, factor(to)?]))
        .ok_or_else(|| {
            let (least, most) = (ZOOMS.start(), ZOOMS.end());
            format!("write two factors from {least} to {most}, FROM:TO, as in 1:8")
        })
}

fn parse_turn(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|degrees| degrees.abs() <= 36000.0)
        .ok_or_else(|| "write a number of degrees from -36000 to 36000, as in 360".to_owned())
}

fn parse_exposure(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|ev| Camera::EXPOSURE_EV.bounds.ends().contains(ev))
        .ok_or_else(|| {
            let (least, most) = Camera::EXPOSURE_EV.bounds.ends().into_inner();
            format!("write a number of stops from {least} to {most}, as in -1.5")
        })
}

fn parse_time(text: &str) -> Result<f64, String> {
    let time = text.parse::<f64>().ok();
    time.filter(|time| Object::TIME_S.bounds.ends().contains(time))
        .ok_or_else(|| "write seconds from 0 to 1e6, as in 1.5".to_owned())
}

/// One time stands for both ends.
fn parse_times(text: &str) -> Result<[f64; 2], String> {
    let (from, to) = text.split_once(':').unwrap_or((text, text));
    let ends = parse_time(from).ok().zip(parse_time(to).ok());
    ends.map(|(from, to)| [from, to]).ok_or_else(|| {
        "write seconds from 0 to 1e6, as in 1.5, or with --frames two of them, FROM:TO, as in 0:2"
            .to_owned()
    })
}

/// Bands of the spectrum, each from one wavelength to a longer one.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands(pub Vec<[f64; 2]>);

fn parse_bands(text: &str) -> Result<Bands, String> {
    let numbers: Option<Vec<f64>> = text.split(':').map(|part| part.parse().ok()).collect();
    let Some([from, to, step]) = numbers.as_deref() else {
        return Err("write three numbers, as in 400:700:10".to_owned());
    };
    let count = ((to - from) / step).round();
    // Also false for NaN.
    let is_whole = (count * step - (to - from)).abs() < 1e-6;
    if !(step >= &1.0 && (1.0..=400.0).contains(&count) && is_whole) {
        return Err("write from where to where by which step, nm: the step is 1 or more, and fits a whole number of times".to_owned());
    }
    let at = |i: usize| from + step * i as f64;
    Ok(Bands(
        (0..count as usize).map(|i| [at(i), at(i + 1)]).collect(),
    ))
}

fn parse_duration(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<u64>().ok().map(Duration::from_secs);
    seconds
        .or_else(|| humantime::parse_duration(text).ok())
        .filter(|time| !time.is_zero())
        .ok_or_else(|| "write a time above 0, as in 90 (seconds), 5m or 1h30m".to_owned())
}
