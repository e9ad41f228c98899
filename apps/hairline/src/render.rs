//! `hairline render`: a scene file to a picture, or to a sequence of them.

mod goals;
mod looks;
mod motion;
mod sequence;
mod steadiness;

use std::io::IsTerminal;
use std::path::Path;

use anyhow::anyhow;
use hairline_console::{Switch, tell};
use hairline_document::inputs::is_same_file;
use hairline_image::exr_file::Notes;
use hairline_image::shown::{LITTLE, Shown};
use hairline_image::{Animation, Display, Finish, Format, Image, Output};
use hairline_published::Method;
use hairline_scene::{Scene, Transport};

use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::{Progress, Terminal};
use crate::scene_file::{self, Overrides};
use crate::{cli, method_flags};
use goals::Goals;
use hairline_render::backend::{self, Painter, Rendered, Task};
use hairline_render::bands;
use hairline_render::failure::Failure;
use hairline_render::labels;
use motion::Motion;

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let method = arguments.method.method()?;
    let mut task = Task {
        mask: method.mask,
        method: plugged(&method),
        backend: arguments.backend.into(),
        samples: arguments.samples,
        transport: transport(arguments.shadows, arguments.bounces, &method)?,
        is_filtered: arguments.filter == Switch::On,
        is_transparent: false,
    };
    if arguments.shadows_only && !task.transport.shadows {
        return Err(Failure::Input(anyhow!(
            "--shadows-only: nothing is left without shadows; leave --shadows off and --method published out"
        )));
    }
    let motion = Motion::of(&arguments.sequence, arguments.time)?;
    // Before the work: nobody should wait for a picture that then has no place to go.
    let target = match &motion {
        None if arguments.looks => Target::Looks,
        None => Target::One(single(arguments)?),
        Some(motion) => Target::Many(motion, Goals::check(arguments, motion.frames)?),
    };
    if let (Target::One(output), Some(_)) = (&target, &arguments.bands)
        && output.format() != Format::Exr
    {
        let path = output.path().display();
        return Err(Failure::Input(anyhow!("{path}: --bands needs an .exr")));
    }
    let labels = labels_goal(arguments, &target)?;
    let overrides = Overrides {
        size_px: arguments.size,
        exposure_ev: arguments.exposure,
        scratch_seed: arguments.scene_flags.seed,
        tone_map: arguments.tone_map,
        time_s: arguments.time.map(|[from, _]| from),
        camera: arguments.scene_flags.camera.as_deref(),
        highlight: arguments.highlight.as_ref(),
        is_lit_for_scratches: arguments.scene_flags.show_scratches,
        wear: arguments.scene_flags.wear,
        transparent: arguments.transparent,
        shadows_only: arguments.shadows_only,
        behind: arguments.behind.as_deref(),
        png_bits: arguments.png_bits,
        interrupt: None,
    };
    let mut outputs = target.paths();
    outputs.extend(labels.as_ref().map(Output::path));
    let mut loaded = scene_file::load(arguments.scene.as_deref(), &overrides, &outputs)?;
    if let Some(motion) = &motion {
        motion.check(&loaded.description.camera)?;
    }
    let display = Display {
        exposure_ev: loaded.scene.camera.exposure_ev,
        tone_map: loaded.scene.render.tone_map,
    };
    task.is_transparent = loaded.description.cuts_out() && arguments.bands.is_none();
    let finish = loaded.finish.clone();
    let left_out = match &arguments.bands {
        None => target.left_out(&finish),
        Some(_) => Vec::new(),
    };
    for note in left_out {
        tell(format_args!("note: {note}"));
    }
    let notes = notes(&task, &method);
    let write = |output: &Output, image: &Image, display: &Display, notes: &Notes| {
        let output = output.clone().finished(&finish);
        output.write_image_with_notes(image, display, notes)
    };
    let write_shown = |output: &Output, image: &Image, display: &Display| -> Result<(), Failure> {
        Ok(write(output, image, display, &notes)?)
    };
    let terminal = Terminal::default();
    match target {
        Target::Looks => looks::run(&mut loaded, arguments, (task, &terminal), &write_shown),
        Target::One(output) => {
            let scene = &loaded.scene;
            if let Some(cli::Bands(bands_nm)) = &arguments.bands {
                return write_bands(scene, bands_nm, task, &output);
            }
            // Before the trees are built, which takes seconds.
            let interrupt = match task.transport.shadows {
                true => Interrupt::listen().map_err(cannot_listen)?,
                false => Interrupt::default(),
            };
            let mut painter = Painter::open(scene, task, &terminal)?;
            let progress = Progress::start("rendering");
            let is_stopped = || interrupt.is_asked();
            let rendered = painter.render(scene, &is_stopped, &|share| progress.set(share))?;
            drop(progress);
            let Rendered {
                image,
                samples,
                wanted,
            } = rendered;
            if let Some(nothing) = nothing_seen(&image) {
                tell(format_args!("note: {nothing}"));
            }
            if arguments.scene_flags.show_scratches
                && let Some(shown) = Shown::of(&image, &display).filter(|it| it.noticed < LITTLE)
            {
                tell(format_args!("note: {}", shown.little()));
            }
            if image
                .alpha
                .as_ref()
                .is_some_and(|alpha| alpha.iter().all(|share| *share == 1.0))
            {
                let ground = loaded.description.ground.as_ref();
                let why = match ground.is_some_and(|it| !it.hidden && !it.shadows_only) {
                    true => {
                        "the ground is behind all of it; --shadows-only leaves its shadows, `hidden = true` in [ground] nothing"
                    }
                    false => "objects fill the picture; `hidden = true` takes one of them out",
                };
                tell(format_args!("note: no pixel is transparent: {why}"));
            }
            if let Some(labels) = labels
                && samples == wanted
            {
                write_labels(scene, labels.path(), &is_stopped)?;
            }
            if samples == wanted {
                write_shown(&output, &image, &display)?;
                tell_on_terminal(&output);
                return Ok(());
            }
            let so_far = format!("{samples} of {wanted}");
            let mut notes = notes.clone();
            notes.insert("samples".to_owned(), so_far.clone());
            write(&output, &image, &display, &notes)?;
            let name = output.path().display();
            tell(format_args!("interrupted: {name} has {so_far} samples"));
            Ok(())
        }
        Target::Many(motion, goals) => {
            let stability = arguments.sequence.stability;
            let write = |output: &Output, image: &Image| write_shown(output, image, &display);
            sequence::run(
                &mut loaded,
                motion,
                &goals,
                stability,
                (task, &terminal),
                &write,
            )
        }
    }
}

/// Names the picture to whoever sees no command but this one: scripts know it.
fn tell_on_terminal(output: &Output) {
    if std::io::stderr().is_terminal() && !output.is_stdout() {
        tell(format_args!("wrote {}", output.path().display()));
    }
}

fn write_bands(
    scene: &Scene,
    bands_nm: &[[f64; 2]],
    task: Task,
    output: &Output,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let progress = Progress::start("rendering bands");
    let is_stopped = || interrupt.is_asked();
    let set = |share| progress.set(share);
    let picture = bands::render(
        scene,
        bands_nm,
        task,
        &Terminal::default(),
        &is_stopped,
        &set,
    )?;
    drop(progress);
    Ok(picture.write(output.path())?)
}

/// Where labels go, if they are asked for.
fn labels_goal(arguments: &cli::Render, target: &Target<'_>) -> Result<Option<Output>, Failure> {
    let Some(path) = &arguments.labels else {
        return Ok(None);
    };
    let refused = |what: &str| Failure::Input(anyhow!("--labels {}: {what}", path.display()));
    if matches!(target, Target::Many(..)) {
        return Err(refused(
            "labels are of a single picture; leave --frames out",
        ));
    }
    let output = Output::check(path)?;
    let place = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let is_taken = |other: &&Path| place(other) == place(path) || is_same_file(other, path);
    if target.paths().iter().any(is_taken) {
        return Err(refused("-o names the same file; give the labels another"));
    }
    match output.format() {
        Format::Exr => Ok(Some(output)),
        Format::Png => Err(refused("labels need an .exr")),
    }
}

fn write_labels(
    scene: &Scene,
    path: &Path,
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Result<(), Failure> {
    let progress = Progress::start("labelling");
    let labels = labels::labels(scene, is_stopped);
    drop(progress);
    match labels {
        Some(labels) => labels.write(path, scene)?,
        None => tell(format_args!("interrupted: no labels")),
    }
    Ok(())
}

/// Why a picture shows nothing, where it does.
fn nothing_seen(image: &Image) -> Option<&'static str> {
    if image.depth_m.iter().all(|depth_m| *depth_m == 0.0) {
        return Some(
            "no object is in the picture: `position_m` and `target_m` of the camera decide where it looks",
        );
    }
    let is_black = |rgb: &[f32; 3]| rgb.iter().all(|c| *c <= 0.0);
    (image.base.iter().all(is_black) && image.scratches.iter().all(is_black)).then_some(
        "the picture is black: no light comes to what the camera sees; it may stand inside of an object",
    )
}

/// Destination of pictures.
enum Target<'a> {
    One(Output),
    /// A picture of each look, whose names the scene has.
    Looks,
    Many(&'a Motion, Goals),
}

impl Target<'_> {
    fn paths(&self) -> Vec<&Path> {
        match self {
            Self::One(output) => vec![output.path()],
            Self::Looks => Vec::new(),
            Self::Many(_, goals) => {
                let pictures = goals.pictures.iter().map(Output::path);
                pictures.chain(goals.animation.as_deref()).collect()
            }
        }
    }
}

impl Target<'_> {
    /// Notes on what the files do not have of what their pictures would.
    fn left_out(&self, finish: &Finish) -> Vec<String> {
        let (pictures, animation) = match self {
            Self::One(output) => (std::slice::from_ref(output), None),
            Self::Looks => (&[][..], None),
            Self::Many(_, goals) => (&goals.pictures[..], goals.animation.as_deref()),
        };
        let mut notes = Vec::new();
        if let Some(path) = animation.filter(|_| finish.is_deep) {
            let path = path.display();
            notes.push(format!("{path}: animations have 8 bits a channel, not 16"));
        }
        let mut linear = pictures.iter();
        let linear = linear.find(|it| it.format() == Format::Exr);
        if let Some(output) = linear.filter(|_| finish.behind.is_some()) {
            let path = output.path().display();
            notes.push(format!(
                "{path}: an .exr has alpha in place of the picture behind; end the name in .png for it"
            ));
        }
        notes
    }
}

fn single(arguments: &cli::Render) -> Result<Output, Failure> {
    let path = arguments
        .output
        .clone()
        .unwrap_or_else(|| scene_file::picture_path(arguments.scene.as_deref(), ".png"));
    if path == Path::new("-") {
        return Ok(Output::stdout());
    }
    if Animation::is_asked_by(&path) {
        let path = path.display();
        return Err(Failure::Input(anyhow!(
            "{path}: an animation needs --frames N, with --turntable DEG, --zoom A:B or --time A:B"
        )));
    }
    Ok(Output::check(&path)?)
}

/// Transport of light by the flags, else the default.
pub fn transport(
    shadows: Option<Switch>,
    bounces: Option<u32>,
    method: &Method,
) -> Result<Transport, Failure> {
    if method.published.is_none() {
        return hairline_console::transport(shadows, bounces);
    }
    if shadows == Some(Switch::On) {
        return Err(Failure::Input(anyhow!(
            "--shadows on: the published method has no shadows; leave out --method published"
        )));
    }
    hairline_console::transport(Some(Switch::Off), bounces)
}

/// The method for both renderers, unless it is Hairline's own.
fn plugged(method: &Method) -> Option<backend::Method> {
    Some(backend::Method {
        on_cpu: method.on_cpu()?,
        on_gpu: method.on_gpu().other?,
    })
}

/// Notes on the settings of a picture that are not the default.
fn notes(task: &Task, method: &Method) -> Notes {
    let mut notes = task.notes();
    if *method != Method::default() {
        notes.insert("method".to_owned(), method_flags::flags_of(method));
    }
    notes
}
