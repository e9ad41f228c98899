//! `hairline info SCENE`: the contents of a scene.

use std::fmt::{self, Write};
use std::path::{Path, PathBuf};

use glam::DVec3;
use hairline_console::print;
use hairline_document::description::{self, Description, LightKind};
use hairline_document::estimate::{Estimate, scratches_bytes, textures_bytes};
use hairline_document::text::shown;
use hairline_memory::{available_bytes, in_words};
use hairline_scene::{Light, LightShape, Scene};
use serde::Serialize;

use crate::scene_file::{self, Loaded, Overrides};
use hairline_render::failure::Failure;

/// Summary of a scene, in the units of its file.
#[derive(Serialize)]
struct Contents {
    size_px: [u32; 2],
    objects: Vec<Object>,
    layers: Vec<Layer>,
    gratings: Vec<Grating>,
    lights: Vec<Lamp>,
    environment: Option<Environment>,
    /// Their names.
    looks: Vec<String>,
    textures: usize,
    /// Contents of models that the picture does not have.
    left_out: Vec<LeftOut>,
    memory: Memory,
}

#[derive(Serialize)]
struct Object {
    name: String,
    least_m: [f64; 3],
    most_m: [f64; 3],
    triangles: usize,
    scratches: usize,
    segments: usize,
}

#[derive(Serialize)]
struct Layer {
    name: Option<String>,
    object: String,
    pattern: String,
    scratches: usize,
    segments: usize,
    hidden: bool,
}

#[derive(Serialize)]
struct Grating {
    name: Option<String>,
    object: String,
    pattern: &'static str,
    pitch_um: f64,
    hidden: bool,
}

#[derive(Serialize)]
struct Lamp {
    name: Option<String>,
    kind: &'static str,
    #[serde(flatten)]
    strength: Strength,
    hidden: bool,
}

/// Position and brightness of a lamp.
#[derive(Serialize)]
#[serde(untagged)]
enum Strength {
    Near {
        center_m: [f64; 3],
        radiance: [f64; 3],
    },
    Sun {
        /// The way that its light goes.
        direction: [f64; 3],
        angle_deg: f64,
        irradiance: [f64; 3],
    },
}

impl Strength {
    fn from_light(light: &description::Light) -> Self {
        match light.kind {
            LightKind::Sun {
                direction,
                angle_deg,
                irradiance,
            } => Self::Sun {
                direction: DVec3::from(direction).normalize_or_zero().into(),
                angle_deg,
                irradiance: light.color.map(|channel| channel * irradiance),
            },
            _ => Self::Near {
                center_m: hairline_document::place_light::center(light).into(),
                radiance: light.color.map(|channel| channel * light.radiance),
            },
        }
    }
}

impl fmt::Display for Strength {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let rgb = |rgb: &[f64; 3]| rgb.map(|it| format!("{it:.3}")).join(", ");
        match self {
            Self::Near { center_m, radiance } => {
                write!(f, "at {}, radiance {}", point(*center_m), rgb(radiance))
            }
            Self::Sun {
                direction,
                angle_deg,
                irradiance,
            } => write!(
                f,
                "shining towards {}, {angle_deg} degrees wide, irradiance {}",
                rgb(direction),
                rgb(irradiance)
            ),
        }
    }
}

#[derive(Serialize)]
struct Environment {
    size_px: [u32; 2],
    /// Lamps that were found in the map; they shine as lights do.
    lamps: Vec<Sun>,
}

#[derive(Serialize)]
struct Sun {
    /// Unit, in the world.
    direction: [f64; 3],
    /// Above the horizon.
    elevation_deg: f64,
    radius_deg: f64,
    radiance: [f64; 3],
}

#[derive(Serialize)]
struct LeftOut {
    file: String,
    what: String,
    count: usize,
    meaning: String,
    /// Whether the picture would be another one with it.
    matters: bool,
}

#[derive(Serialize)]
struct Memory {
    /// Memory for scene and picture, scratches included.
    estimate_bytes: f64,
    available_bytes: Option<u64>,
}

/// Loads the scene and prints its contents.
pub fn run(path: &Path, json: bool) -> Result<(), Failure> {
    let loaded = scene_file::load(Some(path), &Overrides::default(), &[])?;
    let contents = contents(&loaded);
    if json {
        let json = serde_json::to_string_pretty(&contents);
        let json = json.map_err(|error| Failure::Work(error.into()))?;
        return print(&format!("{json}\n"));
    }
    let mut text = String::new();
    write(&contents, &mut text).map_err(|error| Failure::Work(error.into()))?;
    print(&text)
}

fn contents(loaded: &Loaded) -> Contents {
    let Loaded {
        scene, description, ..
    } = loaded;
    let gratings = description.gratings.iter().map(|grating| Grating {
        name: grating.name.clone(),
        object: grating.object.clone(),
        pattern: grating.pattern.name(),
        pitch_um: grating.pitch_um,
        hidden: grating.hidden,
    });
    let lights = description.lights.iter().map(|light| Lamp {
        name: light.name.clone(),
        kind: light.kind.name(),
        strength: Strength::from_light(light),
        hidden: light.hidden,
    });
    let up = description.camera.world_up();
    let environment = scene.environment.as_ref().map(|environment| Environment {
        size_px: environment.background().size_px,
        lamps: environment
            .suns()
            .iter()
            .filter_map(|sun| self::sun(sun, up))
            .collect(),
    });
    let segments: usize = scene
        .objects
        .iter()
        .map(|object| object.segments.len())
        .sum();
    let scratches: usize = scene
        .objects
        .iter()
        .map(|object| object.scratches.len())
        .sum();
    let laid = scratches_bytes(scratches, segments);
    Contents {
        size_px: scene.render.size_px,
        objects: objects(scene),
        layers: layers(scene, description),
        gratings: gratings.collect(),
        lights: lights.collect(),
        environment,
        looks: (description.looks.iter())
            .map(|it| it.name.clone())
            .collect(),
        textures: scene.textures.len(),
        left_out: left_out(loaded),
        memory: Memory {
            estimate_bytes: Estimate::from_description(description, &loaded.folder).bytes()
                + laid
                + textures_bytes(scene),
            available_bytes: available_bytes(),
        },
    }
}

fn objects(scene: &Scene) -> Vec<Object> {
    // A hidden object has no triangles.
    let shown = scene.objects.iter();
    let shown = shown.filter(|object| !object.mesh.triangles.is_empty());
    let objects = shown.map(|object| {
        let (least, most) = object.mesh.bounds_m();
        Object {
            name: object.name.clone(),
            least_m: least.as_dvec3().into(),
            most_m: most.as_dvec3().into(),
            triangles: object.mesh.triangles.len(),
            scratches: object.scratches.len(),
            segments: object.segments.len(),
        }
    });
    objects.collect()
}

fn layers(scene: &Scene, description: &Description) -> Vec<Layer> {
    let layers = (0..).zip(&description.scratches).map(|(i, table)| {
        let object = scene
            .objects
            .iter()
            .find(|object| object.name == table.object);
        let all = object.map_or(&[][..], |object| &object.scratches);
        let own = all.iter().filter(|scratch| scratch.layer == i);
        let (scratches, segments) = own.fold((0, 0), |(scratches, segments), scratch| {
            (scratches + 1, segments + scratch.segments.len())
        });
        Layer {
            name: table.name.clone(),
            object: table.object.clone(),
            pattern: table.layer.pattern_name().to_owned(),
            scratches,
            segments,
            hidden: table.hidden,
        }
    });
    layers.collect()
}

fn left_out(loaded: &Loaded) -> Vec<LeftOut> {
    let models = loaded.description.left_out(&loaded.folder).into_iter();
    let of_model = |(file, left_out): (PathBuf, Vec<hairline_document::LeftOut>)| {
        let file = file.to_string_lossy().into_owned();
        left_out.into_iter().map(move |content| LeftOut {
            file: file.clone(),
            what: content.what,
            count: content.count,
            meaning: content.meaning,
            matters: content.matters,
        })
    };
    models.flat_map(of_model).collect()
}

/// A lamp of an environment: a sphere so far away that it stands in one direction. The environment's top is `up`, unit.
fn sun(sun: &Light, up: DVec3) -> Option<Sun> {
    let LightShape::Sphere { center_m, radius_m } = &sun.shape else {
        return None;
    };
    let direction = center_m.normalize();
    Some(Sun {
        direction: direction.into(),
        elevation_deg: direction.dot(up).asin().to_degrees(),
        radius_deg: (radius_m / center_m.length()).asin().to_degrees(),
        radiance: sun.radiance,
    })
}

fn write(contents: &Contents, out: &mut String) -> fmt::Result {
    let [width, height] = contents.size_px;
    writeln!(out, "picture: {width} x {height} pixels")?;
    write_objects(&contents.objects, out)?;
    writeln!(out, "layers of scratches: {}", contents.layers.len())?;
    lines(out, &contents.layers, |layer| {
        format!(
            "{}{} on \"{}\": {} scratches in {} segments{}",
            layer.pattern,
            named(&layer.name),
            shown(&layer.object),
            layer.scratches,
            layer.segments,
            hidden(layer.hidden)
        )
    })?;
    if !contents.gratings.is_empty() {
        writeln!(out, "gratings: {}", contents.gratings.len())?;
    }
    lines(out, &contents.gratings, |grating| {
        format!(
            "{}{} on \"{}\": a groove every {} um{}",
            grating.pattern,
            named(&grating.name),
            shown(&grating.object),
            grating.pitch_um,
            hidden(grating.hidden)
        )
    })?;
    writeln!(out, "lights: {}", contents.lights.len())?;
    lines(out, &contents.lights, |lamp| {
        let (name, end) = (named(&lamp.name), hidden(lamp.hidden));
        format!("{}{name} {}{end}", lamp.kind, lamp.strength)
    })?;
    write_environment(contents.environment.as_ref(), out)?;
    if !contents.looks.is_empty() {
        writeln!(out, "looks: {}", contents.looks.len())?;
    }
    lines(out, &contents.looks, |name| format!("\"{}\"", shown(name)))?;
    writeln!(out, "textures: {}", contents.textures)?;
    write_left_out(&contents.left_out, out)?;
    let free = contents.memory.available_bytes;
    let free = free.map_or("unknown".to_owned(), |bytes| in_words(bytes as f64));
    let needed = in_words(contents.memory.estimate_bytes);
    writeln!(out, "memory: about {needed} to render it; {free} available")
}

fn write_objects(objects: &[Object], out: &mut String) -> fmt::Result {
    writeln!(out, "objects: {}", objects.len())?;
    for object in objects {
        let size = [0, 1, 2].map(|axis| object.most_m[axis] - object.least_m[axis]);
        writeln!(
            out,
            "  \"{}\": {}, from {} to {}; {} triangles, {} scratches in {} segments",
            shown(&object.name),
            size.map(length).join(" x "),
            point(object.least_m),
            point(object.most_m),
            object.triangles,
            object.scratches,
            object.segments
        )?;
    }
    Ok(())
}

fn write_environment(environment: Option<&Environment>, out: &mut String) -> fmt::Result {
    let Some(environment) = environment else {
        return writeln!(out, "environment: none");
    };
    let [width, height] = environment.size_px;
    let lamps = environment.lamps.len();
    writeln!(
        out,
        "environment: {width} x {height} pixels; lamps found in it: {lamps}"
    )?;
    for sun in &environment.lamps {
        writeln!(
            out,
            "  towards {}, {:.1} degrees above the horizon, radius {:.2} degrees, radiance {}",
            sun.direction.map(|it| format!("{it:.3}")).join(", "),
            sun.elevation_deg,
            sun.radius_deg,
            sun.radiance.map(|it| format!("{it:.1}")).join(", ")
        )?;
    }
    Ok(())
}

fn write_left_out(left_out: &[LeftOut], out: &mut String) -> fmt::Result {
    writeln!(out, "left out of models: {}", left_out.len())?;
    for it in left_out {
        writeln!(
            out,
            "  {}: {} ({}); {}{}",
            shown(&it.file),
            it.what,
            it.count,
            it.meaning,
            if it.matters {
                ""
            } else {
                "; the picture is the same"
            }
        )?;
    }
    Ok(())
}

/// Largest number of lines of layers and lights; JSON has all.
const MOST_LINES: usize = 200;

/// Writes a line for each of the first things.
fn lines<T>(out: &mut String, things: &[T], line: impl Fn(&T) -> String) -> fmt::Result {
    for (i, thing) in things.iter().enumerate() {
        writeln!(out, "  {}", line(thing))?;
        if i == MOST_LINES {
            return writeln!(out, "  ..");
        }
    }
    Ok(())
}

fn hidden(is_hidden: bool) -> &'static str {
    if is_hidden { ", hidden" } else { "" }
}

fn named(name: &Option<String>) -> String {
    name.as_ref()
        .map_or_else(String::new, |name| format!(" \"{}\"", shown(name)))
}

fn point(point_m: [f64; 3]) -> String {
    format!("({}) m", point_m.map(|it| format!("{it:.4}")).join(", "))
}

/// Formats a length in the unit that reads best.
fn length(length_m: f64) -> String {
    match length_m {
        1.0.. => format!("{length_m:.3} m"),
        0.001.. => format!("{:.1} mm", length_m * 1e3),
        _ => format!("{:.1} um", length_m * 1e6),
    }
}
