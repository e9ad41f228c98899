//! The package's numbers: tables for textures, spectra as JavaScript, and a tree for the test of its twin.

use std::fmt::Write;
use std::path::Path;

use anyhow::{Context, ensure};
use hairline_gpu::engine_tables::{self, IOR};
use hairline_gpu::scratch_tree;
use hairline_index::ScratchIndex;
use hairline_optics::metal::Metal;
use hairline_optics::section::{GrooveShape, Section};
use hairline_optics::table::{ENGINE_COLUMNS, ROWS, ScratchTable};
use hairline_scene::{Scene, ScratchTables};
use serde_json::{Value, json};

use super::files::write;
use super::modules::TABLE_SIZE;

/// Names of scene files, in the order of `Metal::ALL`.
const METALS: [&str; 10] = [
    "iron",
    "steel",
    "aluminium",
    "copper",
    "gold",
    "silver",
    "brass",
    "chromium",
    "titanium",
    "nickel",
];
/// Textures of four f32 a texel, one after the other: shapes, albedo and curves of `engine_tables`.
pub(super) fn tables() -> Vec<u8> {
    [
        engine_tables::shapes(),
        engine_tables::albedo(),
        engine_tables::curves(),
    ]
    .iter()
    .flat_map(|table| &table.texels)
    .flatten()
    .flat_map(|value| value.to_le_bytes())
    .collect()
}

/// Rows of numbers of a CSV file.
fn rows(path: &Path) -> anyhow::Result<Vec<Vec<f64>>> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{} cannot be read", path.display()))?;
    text.lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| line.split(',').map(|cell| Ok(cell.parse()?)).collect())
        .collect()
}

/// The observer and the metals' n and k, with the size of the tables.
pub(super) fn data(root: &Path) -> anyhow::Result<String> {
    let folder = root.join("crates/optics/data");
    let observer = rows(&folder.join("cie.csv"))?;
    let metals = rows(&folder.join("metals.csv"))?;
    let width = 1 + 2 * METALS.len();
    ensure!(
        metals.iter().all(|row| row.len() == width),
        "metals.csv must have {width} columns"
    );
    let [columns, table_rows] = TABLE_SIZE;
    let mut out = format!(
        "// Made by `cargo xtask package` from crates/optics/data, which names the sources.\n\
         export const COLUMNS = {columns};\nexport const ROWS = {table_rows};\nexport const IOR = {IOR};\n\
         export const OBSERVER = {};\nexport const METALS = {{\n",
        serde_json::to_string(&observer)?
    );
    for (i, name) in METALS.iter().enumerate() {
        let pairs: Vec<_> = metals
            .iter()
            .map(|row| [row[1 + 2 * i], row[2 + 2 * i]])
            .collect();
        // Quoted, as a name may be no identifier of JavaScript.
        writeln!(out, "  {name:?}: {},", serde_json::to_string(&pairs)?)?;
    }
    out.push_str("};\n");
    Ok(out)
}

/// Fine gratings in aluminium that the package has tables of.
const GRATINGS: [(&str, &str); 2] = [
    (
        "cd",
        "pitch_um = 1.6, width_um = 0.6, depth_nm = { mean = 110.0, spread = 0.05 }, jitter_um = 0.03",
    ),
    (
        "dvd",
        "pitch_um = 0.74, width_um = 0.32, depth_nm = { mean = 105.0, spread = 0.05 }, jitter_um = 0.015",
    ),
];

/// Writes the tables of gratings, a file each.
pub(super) fn write_gratings(folder: &Path) -> anyhow::Result<()> {
    for (name, row) in GRATINGS {
        let text = format!(
            "
            camera = {{ position_m = [0.0, 0.0, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }}
            material = [{{ name = \"m\", kind = \"metal\", metal = \"aluminium\" }}]
            object = [{{ name = \"o\", material = \"m\", shape = {{ plane = {{ size_m = [0.1, 0.1] }} }} }}]
            grating = [{{ object = \"o\", pattern = \"circular\", {row} }}]
        "
        );
        let scene = Scene::from_toml(&text, name, ".")?;
        let tables = ScratchTables::new(&scene);
        let table = tables.grating_table(&scene.objects[0].gratings[0], 0);
        let table = table.context("a grating without a table")?;
        let texels = tables.tables[table].resampled(ENGINE_COLUMNS, ROWS);
        let bytes: Vec<u8> = (texels.iter().flatten())
            .flat_map(|word| word.to_le_bytes())
            .collect();
        write(&folder.join(format!("{name}.bin")), &bytes)?;
    }
    Ok(())
}

/// Random scratches on a ball, as Rust packs their tree.
pub(super) fn write_tree_twin(output: &Path) -> anyhow::Result<()> {
    let text = "
        camera = { position_m = [0.0, -0.3, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0] }
        material = [{ name = \"m\", kind = \"mirror\" }]
        object = [{ name = \"o\", material = \"m\", shape = { sphere = { radius_m = 0.02 } } }]
        scratches = [{ object = \"o\", pattern = \"random\", count = 60, seed = 1, length_m = 0.02 }]
    ";
    let scene = Scene::from_toml(text, "tree twin", ".")?;
    let texels = scratch_tree::texels(&ScratchIndex::build(&scene), 0);
    let bytes: Vec<u8> = texels
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    write(&output.join("test/tree_texels.bin"), &bytes)
}

/// What Rust finds in the tables of some shapes of grooves in gold: each a shape and rows of a chord from u on, a depth, and three channels.
pub(super) fn write_shapes_twin(output: &Path) -> anyhow::Result<()> {
    let listed = [1.0, 0.7, 0.0, -0.3, 0.0];
    let shapes = [
        (Section::V, json!("v"), 0),
        (Section::Round, json!("round"), 2),
        (Section::Shoulders, json!("shoulders"), 5),
        (Section::Rectangle, json!("rectangle"), 4),
        (Section::Listed(listed.into()), json!(listed), 1),
    ];
    let twin = |(section, profile, width_class): (Section, Value, u8)| {
        let shape = GrooveShape {
            section,
            width_class,
        };
        let table = ScratchTable::of_shape(&shape, |nm| Metal::Gold.reflectance(1.0, nm));
        let rows = (0..200).map(|i| {
            let u = 8.0 * (0.618_033_988_749_895 * f64::from(i)).fract();
            let depth = 1000.0 * (0.414_213_562_373_095 * f64::from(i)).fract();
            let row = table.at_depth(depth);
            let (low, high) = (row.at(u), row.at(u + 0.5));
            json!([
                u,
                depth,
                std::array::from_fn::<_, 3, _>(|c| high[c] - low[c])
            ])
        });
        json!({ "profile": profile, "widthClass": width_class, "chords": rows.collect::<Vec<_>>() })
    };
    let shapes: Vec<_> = shapes.into_iter().map(twin).collect();
    write(
        &output.join("test/shapes.json"),
        &serde_json::to_vec(&shapes)?,
    )
}
