//! Loads a scene for the command line: the file, the flags' changes to it, and the progress of reading.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::anyhow;
use glam::Vec3;
use hairline_console::{BUILT_IN, refuse_other_files, tell};
use hairline_document::description::{Description, Object};
use hairline_document::estimate::Estimate;
use hairline_document::inputs::{Input, is_same_file};
use hairline_document::wear::{Wear, set_wear};
use hairline_document::{Loader, SceneBuilder, Stage, reading, subject};
use hairline_image::{Backdrop, Finish, ToneMap};
use hairline_memory::budget_bytes;
use hairline_scene::Scene;

use crate::highlight::{self, Highlight};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use hairline_render::failure::Failure;
use hairline_render::motion::set_time;

/// Values of flags that replace those of the scene file.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides<'a> {
    /// Width and height.
    pub size_px: Option<[u32; 2]>,
    /// Exposure in stops.
    pub exposure_ev: Option<f64>,
    /// Added to the seed of each layer of scratches.
    pub scratch_seed: u64,
    /// The time of the models' animations.
    pub time_s: Option<f64>,
    /// A camera of a model's file.
    pub camera: Option<&'a str>,
    /// The curve to the display.
    pub tone_map: Option<ToneMap>,
    /// Place for a light's mirror image.
    pub highlight: Option<&'a Highlight>,
    /// Whether the scene's lights are replaced by lights that show its scratches.
    pub is_lit_for_scratches: bool,
    /// Wear of the objects that the scene is about.
    pub wear: Option<Wear>,
    /// Whether pictures have an alpha.
    pub transparent: bool,
    /// Whether the ground is seen by its shadows alone.
    pub shadows_only: bool,
    /// A picture behind the objects.
    pub behind: Option<&'a Path>,
    /// Bits of each channel of a PNG.
    pub png_bits: Option<u32>,
    /// Ends the reading with an error; none where nobody listens.
    pub interrupt: Option<&'a Interrupt>,
}

/// A scene with its description and its files.
pub struct Loaded {
    /// The scene itself.
    pub scene: Scene,
    /// Description that was built: the file's, with the flags' changes in it.
    pub description: Description,
    /// Folder from which paths in the scene start.
    pub folder: PathBuf,
    /// What its PNGs have besides the colours.
    pub finish: Finish,
    /// Text and name of the file, for errors.
    text: String,
    name: PathBuf,
    /// Builder of the scene, which keeps its parts.
    builder: SceneBuilder,
}

impl Loaded {
    /// Makes the scene that another description is of. Only what is other than before is made again.
    ///
    /// # Errors
    /// [`Failure::Input`] where a model cannot be read any more.
    pub fn show(&mut self, description: &Description) -> Result<(), Failure> {
        self.scene = self.built(description)?;
        Ok(())
    }

    /// The scene with a look of its own.
    ///
    /// # Errors
    /// [`Failure::Input`] where what the look names cannot be read.
    pub fn with_look(&mut self, index: usize) -> Result<Scene, Failure> {
        let mut seen = self.description.clone();
        let look = self.description.looks[index].clone();
        look.apply(&mut seen);
        let built = self.built(&seen);
        let wrong = |error| look.own_error(index, error);
        Ok(built.map_err(|error| wrong(error).in_scene_file(&self.text, &self.name))?)
    }

    fn built(&mut self, description: &Description) -> Result<Scene, hairline_document::Error> {
        (self.builder).build(&Loader::default(), description, &self.folder)
    }
}

/// Gives wear to the objects that a scene is about.
fn give_wear(description: &mut Description, scene: &Scene, wear: Wear) {
    let bounds_m = |object: &Object| {
        let same = scene.objects.iter().find(|built| built.name == object.name);
        let (low, high) = same.map_or((Vec3::ZERO, Vec3::ZERO), |built| built.mesh.bounds_m());
        (low.as_dvec3(), high.as_dvec3())
    };
    let boxes_m: Vec<_> = description.objects.iter().map(bounds_m).collect();
    for object in subject::objects(description, &boxes_m) {
        let (low_m, high_m) = boxes_m[object];
        let name = description.objects[object].name.clone();
        set_wear(description, &name, low_m.distance(high_m), wear);
    }
}

/// Cuts the objects out by the flags. The ground that a model by itself has got is not to fill the picture: its shadows stay.
fn cut_out(description: &mut Description, overrides: &Overrides<'_>, is_model: bool) {
    let cuts_out = overrides.transparent || overrides.behind.is_some();
    let own = (description.ground.as_mut()).filter(|ground| is_model && !ground.hidden);
    if let Some(ground) = own {
        ground.shadows_only |= cuts_out;
    }
    let render = &mut description.render;
    render.transparent |= overrides.transparent;
    render.png_bits = overrides.png_bits.unwrap_or(render.png_bits);
    if let Some(behind) = overrides.behind {
        // Not relative to the scene.
        let path = std::path::absolute(behind);
        render.behind = Some(path.unwrap_or_else(|_| behind.to_owned()));
    }
    if overrides.shadows_only {
        let ground = description.ground.get_or_insert_default();
        (ground.shadows_only, ground.hidden) = (true, false);
    }
}

/// Reads a scene file, or the built-in scene where there is none. `outputs` are the files that will be written: none of them may be
/// one that the scene is made from.
pub fn load(
    path: Option<&Path>,
    overrides: &Overrides<'_>,
    outputs: &[&Path],
) -> Result<Loaded, Failure> {
    let mut source = Source::read(path)?;
    let is_model = source.model.is_some();
    let mut description = source.description()?;
    cut_out(&mut description, overrides, is_model);
    refuse_inputs(outputs, path, &description.inputs(&source.folder))?;
    change(&mut description, overrides, &source)?;

    // The scene is checked for its own memory where it is built.
    let mut picture = Estimate::default();
    picture.add_picture(description.render.size_px);
    picture.check(budget_bytes() as f64)?;
    let progress = Progress::start("reading the scene");
    let loader = Loader {
        progress: &|at| {
            progress.restart(match at.stage {
                Stage::Meshes => "reading meshes",
                Stage::Environment => "reading the map",
                Stage::Scratches => "laying scratches",
            });
            progress.set(at.done as f64 / at.total.max(1) as f64);
        },
        cancelled: &|| overrides.interrupt.is_some_and(Interrupt::is_asked),
        ..Loader::default()
    };
    let wrong = |error| source.wrong(error);
    let mut builder = SceneBuilder::new();
    let built = builder.build(&loader, &description, &source.folder);
    let mut scene = built.map_err(wrong)?;
    let backdrop = backdrop(&description, overrides, &source)?;
    let finish = Finish {
        is_deep: description.render.png_bits == 16,
        behind: backdrop.map(Arc::new),
    };
    if let Some(wear) = overrides.wear {
        give_wear(&mut description, &scene, wear);
        scene = (builder.build(&loader, &description, &source.folder)).map_err(wrong)?;
    }
    if light(&mut description, &scene, overrides)? {
        // Only the lights are built again.
        let built = builder.build(&loader, &description, &source.folder);
        scene = built.map_err(wrong)?;
    }
    drop(progress);
    tell_notes(&scene);
    Ok(Loaded {
        scene,
        description,
        folder: source.folder,
        finish,
        text: source.text,
        name: source.name,
        builder,
    })
}

/// Changes a description by what can be told without its scene.
fn change(
    description: &mut Description,
    overrides: &Overrides<'_>,
    source: &Source,
) -> Result<(), Failure> {
    if let Some(size_px) = overrides.size_px {
        description.render.size_px = size_px;
    }
    if let Some(exposure_ev) = overrides.exposure_ev {
        description.camera.exposure_ev = exposure_ev;
    }
    if let Some(tone_map) = overrides.tone_map {
        description.render.tone_map = tone_map;
    }
    if let Some(time_s) = overrides.time_s {
        set_time(description, time_s);
    }
    let of_file = description.camera.of_file.clone();
    if let Some(camera) = overrides.camera.or(of_file.as_deref()) {
        let taken = description.see_by(camera, &source.folder);
        taken.map_err(|error| source.wrong(error))?;
    }
    for scratches in &mut description.scratches {
        if let Some(seed) = scratches.layer.seed_mut() {
            *seed = seed.wrapping_add(overrides.scratch_seed);
        }
    }
    Ok(())
}

/// Places and replaces lights; whether any changed.
fn light(
    description: &mut Description,
    scene: &Scene,
    overrides: &Overrides<'_>,
) -> Result<bool, Failure> {
    if let Some(wanted) = overrides.highlight {
        highlight::place(wanted, description, scene)?;
    }
    if overrides.is_lit_for_scratches {
        description.light_for_scratches(scene);
    }
    Ok(overrides.highlight.is_some() || overrides.is_lit_for_scratches)
}

/// The picture that lies behind a transparent one.
fn backdrop(
    description: &Description,
    overrides: &Overrides<'_>,
    source: &Source,
) -> Result<Option<Backdrop>, Failure> {
    let backdrop = description.backdrop(&source.folder);
    backdrop.map_err(|error| match overrides.behind {
        Some(behind) => Failure::Input(anyhow!(
            "--behind {}: {}; must be a .png, .jpg or .webp, relative to the current folder",
            behind.display(),
            error.found()
        )),
        None => source.wrong(error).into(),
    })
}

fn tell_notes(scene: &Scene) {
    for note in &scene.notes {
        tell(format_args!("note: {note}"));
    }
    if let Some(environment) = &scene.environment
        && environment.repaired_texels() > 0
    {
        tell(format_args!(
            "warning: {} texels of the environment map held a negative or non-finite value, or one above 6.9e10; they count \
             as black, as 65504 if infinite, or as 6.9e10",
            environment.repaired_texels()
        ));
    }
}

/// Refuses to write over a file that is to be read.
pub fn refuse_inputs(
    outputs: &[&Path],
    scene: Option<&Path>,
    inputs: &[Input],
) -> Result<(), Failure> {
    let scene = scene.map(|path| ("the scene file", path));
    let inputs = inputs
        .iter()
        .map(|input| (input.what.as_str(), input.path.as_path()));
    for (what, input) in scene.into_iter().chain(inputs) {
        if let Some(output) = outputs.iter().find(|output| is_same_file(output, input)) {
            let (output, input) = (output.display(), input.display());
            return Err(Failure::Input(anyhow!(
                "{output}: it is {what} ({input}), which would be overwritten; give the output another name"
            )));
        }
    }
    Ok(())
}

/// The scene's name with another ending, in the current folder: where a picture goes that no flag has named.
pub fn picture_path(scene: Option<&Path>, ending: &str) -> PathBuf {
    let stem = scene.filter(|path| *path != Path::new("-"));
    let stem = stem.and_then(Path::file_stem);
    // Not with_extension: a name may hold dots of its own.
    let mut name = stem.unwrap_or("hairline".as_ref()).to_owned();
    name.push(ending);
    name.into()
}

/// A scene's text and the folder to which its paths are relative.
struct Source {
    text: String,
    name: PathBuf,
    folder: PathBuf,
    /// The scene around a model.
    model: Option<Description>,
}

impl Source {
    /// An error in the scene, with its place in the file.
    fn wrong(&self, error: hairline_document::Error) -> hairline_document::Error {
        error.in_scene_file(&self.text, &self.name)
    }

    fn read(scene: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = scene else {
            return Ok(Self {
                text: BUILT_IN.to_owned(),
                name: "built-in scene".into(),
                folder: PathBuf::new(),
                model: None,
            });
        };
        if path == Path::new("-") {
            let name = PathBuf::from("stdin");
            let text = reading::scene_text_of(std::io::stdin().lock());
            return Ok(Self {
                text: text.map_err(|error| error.with_position(&name, None))?,
                name,
                folder: PathBuf::new(),
                model: None,
            });
        }
        refuse_other_files(path)?;
        let model = Description::is_model(path).then(|| Description::for_model(path));
        let model = model.transpose()?;
        Ok(Self {
            // Text whose lines errors count; a model has none.
            text: match model {
                Some(_) => String::new(),
                None => reading::scene_text(path)?,
            },
            name: path.to_owned(),
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            model,
        })
    }

    fn description(&mut self) -> Result<Description, Failure> {
        match self.model.take() {
            Some(model) => Ok(model),
            None => Ok(Description::from_toml(&self.text, &self.name)?),
        }
    }
}
