//! The field of view of a lens before a film.

/// Height of a film that is `sensor_mm` wide and has the shape of the picture.
pub(super) fn film_height_mm(sensor_mm: f64, [width, height]: [u32; 2]) -> f64 {
    sensor_mm * f64::from(height) / f64::from(width.max(1))
}

/// Vertical field of view of a lens before such a film.
pub(super) fn seen_deg(focal_length_mm: f64, sensor_mm: f64, size_px: [u32; 2]) -> f64 {
    let height_mm = film_height_mm(sensor_mm, size_px);
    2.0 * (0.5 * height_mm / focal_length_mm).atan().to_degrees()
}
