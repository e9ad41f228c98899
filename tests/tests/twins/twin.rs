//! Feeds the same rows to a WGSL snippet and to an f64 function and compares the results.

pub use conformance::Sequence;
use hairline_gpu::call::{Call, Table};
use hairline_gpu::device::Gpu;
use hairline_gpu::headless;
use hairline_gpu::shaders::Module;

/// The largest difference that a comparison allows: `absolute + relative * |expected|`.
#[derive(Clone, Copy)]
pub struct Tolerance {
    pub absolute: f64,
    pub relative: f64,
}

/// A twin: a snippet that reads `x` and writes `y`, and the function that it should equal.
pub struct Twin<'a, const N: usize, const M: usize> {
    pub name: &'a str,
    pub modules: &'a [&'a Module],
    pub snippet: &'a str,
    pub tables: &'a [Table<'a>],
    pub expected: &'a dyn Fn([f64; N]) -> [f64; M],
    pub tolerance: Tolerance,
}

impl<const N: usize, const M: usize> Twin<'_, N, M> {
    /// Rows whose results differ by more than the tolerance, or are not finite, as text. None without a GPU.
    pub fn failures(&self, rows: &[[f32; N]]) -> Option<Vec<String>> {
        let gpu: &Gpu = headless::test_gpu()?;
        let call = Call {
            modules: self.modules,
            snippet: self.snippet,
            tables: self.tables,
        };
        let results: Vec<[f32; M]> = gpu.block_on(call.run(gpu, rows)).unwrap();
        assert_eq!(results.len(), rows.len());
        let failures = rows.iter().zip(&results).filter_map(|(row, result)| {
            let expected = (self.expected)(row.map(f64::from));
            let agrees = |(value, expected): (&f32, &f64)| {
                value.is_finite()
                    && (*value as f64 - expected).abs()
                        <= self.tolerance.absolute + self.tolerance.relative * expected.abs()
            };
            let all = result.iter().zip(&expected).all(agrees);
            (!all).then(|| format!("{row:?}: shader {result:?}, optics {expected:?}"))
        });
        Some(failures.collect())
    }

    /// Fails if more than `allowed` rows differ. Rows are allowed to differ where a function jumps and rounding decides on
    /// which side of the jump a row falls; the test says why.
    pub fn check(&self, rows: &[[f32; N]], allowed: usize) {
        let Some(failures) = self.failures(rows) else {
            return;
        };
        assert!(
            failures.len() <= allowed,
            "{}: {} of {} rows differ, for example\n{}",
            self.name,
            failures.len(),
            rows.len(),
            failures[..failures.len().min(5)].join("\n")
        );
    }
}

/// The harness must be able to fail: one wrong row among right ones is found, and only that one.
#[test]
fn one_wrong_row_is_found() {
    let twin = Twin {
        name: "square root with one wrong row",
        modules: &[],
        snippet: "y[0] = sqrt(x[0]);",
        tables: &[],
        expected: &|[x]: [f64; 1]| [if x == 4.0 { 2.01 } else { x.sqrt() }],
        tolerance: Tolerance {
            absolute: 1e-6,
            relative: 1e-6,
        },
    };
    if let Some(failures) = twin.failures(&[[1.0], [4.0], [9.0]]) {
        assert_eq!(failures.len(), 1);
        assert!(failures[0].starts_with("[4.0]"), "{failures:?}");
    }
}
