//! `hairline bench` on pictures of a few pixels: that all is measured and written, not the results.

use std::fs;
use std::path::Path;

use crate::common::{hairline, stderr_of, stdout_of};
use hairline_gpu::headless::test_gpu;
use serde_json::Value;

fn json(folder: &Path, name: &str) -> Value {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn positive(outcome: &Value) -> bool {
    let wall = &outcome["timing"]["wall_ms"];
    let quartile = |i: usize| wall["quartiles"][i].as_f64().unwrap_or(0.0);
    let median = wall["median"].as_f64().unwrap_or(0.0);
    0.0 < quartile(0) && quartile(0) <= median && median <= quartile(1)
}

#[test]
fn the_table_has_all_cells_and_says_on_what_it_was_measured() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = "bench --quick --backend cpu --size 40x24 --scratches 300 --repetitions 1 --part table \
                     --json figures.json -o report.md";
    let assert = hairline(folder.path(), arguments).success();
    let shown = stdout_of(&assert);
    for part in ["Intersection only", "Sphere", "Triangle", "GTX 970M"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }

    let figures = json(folder.path(), "figures.json");
    let cells = figures["table"].as_array().unwrap();
    // Three rows, three zooms, five methods.
    assert_eq!(cells.len(), 3 * 3 * 5);
    for cell in cells {
        assert!(positive(cell), "{cell}");
        let lit = cell["row"] != "intersection";
        assert_eq!(cell["error"]["relative_rms"].is_f64(), lit, "{cell}");
        // The talk's figures stand beside its own columns alone.
        let is_of_the_talk = !["ours", "filtered-exact"]
            .map(Value::from)
            .contains(&cell["way"]);
        assert_eq!(cell["talk_ms"].is_f64(), is_of_the_talk);
    }
    // The published method errs more than ours in every row.
    let rms = |row: &str, method: &str| -> f64 {
        let cells = cells
            .iter()
            .filter(|c| c["row"] == row && c["way"] == method);
        let errors = cells.map(|cell| cell["error"]["relative_rms"].as_f64().unwrap());
        errors.fold(0.0, f64::max)
    };
    for row in ["sphere", "triangle"] {
        assert!(rms(row, "filtered") > rms(row, "ours"));
    }
    let report = fs::read_to_string(folder.path().join("report.md")).unwrap();
    assert_eq!(report, shown);
    let cpu = figures["machine"]["cpu"].as_str().unwrap();
    assert!(report.contains(cpu), "{report}");
}

#[test]
fn curves_are_measured_on_the_adapter_that_the_report_names() {
    let Some(gpu) = test_gpu() else { return };
    let folder = tempfile::tempdir().unwrap();
    let arguments = "bench --quick --backend gpu --size 16x8 --scratches 300 --repetitions 1 --part pixels \
                     --json figures.json -o report.md";
    hairline(folder.path(), arguments).success();
    let figures = json(folder.path(), "figures.json");
    let points = figures["curves"][0]["points"].as_array().unwrap();
    assert!(points.len() >= 4);
    assert!(points.iter().all(positive), "{points:?}");
    let report = fs::read_to_string(folder.path().join("report.md")).unwrap();
    assert!(report.contains(&gpu.adapter.name), "{report}");
}

#[test]
fn the_benchs_scene_can_be_written_and_measured_as_any_other() {
    let folder = tempfile::tempdir().unwrap();
    hairline(
        folder.path(),
        "bench --write-scene worn.toml --scratches 300",
    )
    .success();
    let scene = fs::read_to_string(folder.path().join("worn.toml")).unwrap();
    assert!(scene.contains("size_px = [1280, 720]"), "{scene}");
    let arguments =
        "bench worn.toml --quick --backend cpu --size 24x16 --repetitions 1 --json figures.json";
    hairline(folder.path(), arguments).success();
    let figures = json(folder.path(), "figures.json");
    assert_eq!(figures["scene"], "worn.toml");
    assert!(figures["table"].as_array().unwrap().iter().all(positive));
}

#[test]
fn wrong_flags_are_2_and_nothing_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (
            "bench --part everything",
            "table, scratches, zoom, lights, pixels",
        ),
        ("bench --repetitions 0", "from 1 to 1000"),
        ("bench scene.toml --part lights", "--part table alone"),
        ("bench missing.toml --backend cpu", "missing.toml"),
        ("bench scene.toml --scratches 9", "a SCENE says itself"),
        (
            "bench --write-scene a.toml --json b.json",
            "cannot be used with",
        ),
    ] {
        let assert = hairline(folder.path(), arguments).code(2);
        let text = stderr_of(&assert);
        assert!(text.contains(message), "{arguments}: {text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    // A place that cannot be written to is found out before the work.
    hairline(folder.path(), "bench --json no/such/figures.json").code(1);
}
