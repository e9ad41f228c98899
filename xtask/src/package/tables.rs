//! The package's numbers: sizes and names as JavaScript, and tables of gratings.

use std::path::Path;

use anyhow::Context;
use hairline_document::LISTED_RANGES;
use hairline_engine::scratch_tree;
use hairline_optics::metal::Metal;
use hairline_optics::table::{ENGINE_COLUMNS, ENGINE_GRATING_ROWS, ROWS, last_depth_nm};
use hairline_scene::{DEFAULT_COHERENCE_UM, ScratchTables};
use serde_json::json;

use super::files::write;

/// Names of metals in the order of their curves, sizes of textures, the usual coherence window, and ranges of the sizes of grooves.
pub(super) fn data() -> String {
    let sizes = LISTED_RANGES.map(|(name, (least, most))| json!([name, least, most]));
    let row_nm = last_depth_nm(ROWS) / (ROWS - 1) as f64;
    format!(
        "// Made by `cargo xtask package`.\n\
         export const COLUMNS = {ENGINE_COLUMNS};\nexport const ROW_NM = {row_nm};\n\
         export const GRATING_ROWS = {ENGINE_GRATING_ROWS};\nexport const FINE_ROWS = {ROWS};\nexport const TREE_WIDTH = {};\n\
         export const COHERENCE_UM = {DEFAULT_COHERENCE_UM};\n\
         export const METALS = {};\nexport const SIZES = {};\n",
        scratch_tree::WIDTH,
        json!(Metal::NAMES),
        json!(sizes)
    )
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
        let scene = hairline_document::from_toml(&text, name, ".")?;
        let tables = ScratchTables::new(&scene);
        let grating = &scene.objects[0].gratings[0];
        let table = tables.grating_table(grating, 0);
        let table = table.context("a grating without a table")?;
        let texels = tables.tables[table].for_engines(grating.row.depth_nm);
        let bytes: Vec<u8> = (texels.iter().flatten())
            .flat_map(|word| word.to_le_bytes())
            .collect();
        write(&folder.join(format!("{name}.bin")), &bytes)?;
    }
    Ok(())
}
