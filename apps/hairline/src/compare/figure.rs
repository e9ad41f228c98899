//! Figures in words.

/// A figure with three or four digits that mean something.
pub fn figure(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        return if value.is_nan() { "NaN" } else { "infinite" }.to_owned();
    }
    if size == 0.0 {
        return "0".to_owned();
    }
    match size {
        1e5.. | ..1e-3 => format!("{value:.2e}"),
        _ => {
            let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
            format!("{value:.decimals$}")
        }
    }
}
