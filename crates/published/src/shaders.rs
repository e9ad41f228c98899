//! The shader modules of the method, which stand on those of [`hairline_gpu::shaders`].

use hairline_gpu::shaders::{
    BAND, BAND_ENVIRONMENT, BASE, FILM, GAUSSIAN, LIGHTS, LTC, MASK, METHOD, Module, PICTURE_LIGHT,
    PIXEL_POINT, ROWS, SCENE, SEGMENTS,
};

macro_rules! modules {
    ($($(#[$doc:meta])* $constant:ident = $name:literal needs [$($need:ident),*];)*) => {
        $(
            $(#[$doc])*
            pub static $constant: Module = Module {
                name: concat!("published/", $name),
                source: include_str!(concat!("../shaders/", $name, ".wgsl")),
                needs: &[$(&$need),*],
            };
        )*
        /// Every module, the pass too.
        pub static ALL: &[&Module] = &[$(&$constant),*];
    };
}

modules! {
    /// The GGX lobe over a sphere, by a pivot transform.
    SPTD = "sptd" needs [LTC];
    /// Segments of the band's middle line.
    PUBLISHED_SEGMENTS = "published_segments" needs [];
    /// The sine integral, exact and approximated.
    PUBLISHED_SINE_INTEGRAL = "published_sine_integral" needs [];
    /// A scratch's light by wavelength.
    PUBLISHED_SPECTRUM = "published_spectrum" needs [PUBLISHED_SEGMENTS, PUBLISHED_SINE_INTEGRAL];
    /// Spherical lights.
    PUBLISHED_SPHERE = "published_sphere" needs [BAND, PUBLISHED_SEGMENTS];
    /// Triangular lights.
    PUBLISHED_POLYGON = "published_polygon" needs [PUBLISHED_SEGMENTS];
    /// The pixel's footprint.
    PUBLISHED_FOOTPRINT = "published_footprint" needs [GAUSSIAN];
    /// The switches and the tables.
    PUBLISHED_TABLES = "published_tables" needs [];
    /// The scratches of each triangle.
    TRIANGLE_LISTS = "triangle_lists" needs [ROWS, PUBLISHED_TABLES];
    /// A scratch under lights and environment.
    PUBLISHED_LIGHTS = "published_lights" needs [
        SCENE, LIGHTS, PICTURE_LIGHT, SEGMENTS, BAND_ENVIRONMENT, PUBLISHED_TABLES, PUBLISHED_SPECTRUM, PUBLISHED_SPHERE,
        PUBLISHED_POLYGON
    ];
    /// The scratches under a pixel.
    PUBLISHED_GATHER = "published_gather" needs [PUBLISHED_LIGHTS, PUBLISHED_FOOTPRINT, TRIANGLE_LISTS, METHOD, MASK];
    /// The base.
    PUBLISHED_BASE = "published_base" needs [BASE, SPTD, PUBLISHED_LIGHTS];
    /// Pass: base and scratches.
    SHADE_PUBLISHED = "shade_published" needs [PUBLISHED_GATHER, PUBLISHED_BASE, FILM, PIXEL_POINT];
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_gpu::shaders::compose;

    #[test]
    fn each_module_is_valid_with_what_it_needs() {
        for module in ALL {
            let text = compose(&[module]);
            let parsed = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| {
                panic!("{}:\n{}", module.name, error.emit_to_string(&text))
            });
            let capabilities = naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32;
            naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities)
                .validate(&parsed)
                .unwrap_or_else(|error| {
                    panic!("{}:\n{}", module.name, error.emit_to_string(&text))
                });
        }
    }
}
