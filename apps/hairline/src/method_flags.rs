//! The flags that choose a method, as a whole or part by part, and the way back from a method to its flags.

use anyhow::anyhow;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use hairline_optics::mask;
use hairline_optics::method::{
    self, Chords, Gather, LightAt, Lookup, Method, PixelFilter, SphereBase,
};
use hairline_optics::published::sine_integral::SineIntegral;
use hairline_optics::published::spectrum::PUBLISHED_WAVELENGTHS;

use crate::failure::Failure;

/// By which method scratches are computed. The finer flags replace one part each of what --method says.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Method")]
pub struct MethodFlags {
    /// The whole method. The flags below replace one part of it each.
    #[arg(long, value_enum, default_value_t = Whole::Default)]
    pub method: Whole,
    /// How the visible is integrated.
    #[arg(long, value_enum)]
    pub spectrum: Option<Spectrum>,
    /// How many wavelengths, for si-fast and si-exact. [default: 8]
    #[arg(long, value_name = "N", value_parser = wavelengths())]
    pub wavelengths: Option<usize>,
    /// How a light's chords on a scratch's band are found.
    #[arg(long, value_enum)]
    pub chords: Option<ChordsFlag>,
    /// What of the band is evaluated.
    #[arg(long, value_enum)]
    pub band: Option<Band>,
    /// How a pixel averages a scratch.
    #[arg(long, value_enum)]
    pub footprint: Option<Footprint>,
    /// What scratches take from the base.
    #[arg(long, value_enum)]
    pub mask: Option<Mask>,
    /// How the base reflects spheres.
    #[arg(long, value_enum)]
    pub sphere_base: Option<SphereBaseFlag>,
    /// How the scratches under a pixel are found.
    #[arg(long, value_enum)]
    pub index: Option<Index>,
    /// Whether many scratches under a pixel may be taken together. [default: what the scene says]
    #[arg(long, value_enum)]
    pub gather: Option<GatherFlag>,
    /// At which places a single scratch's light is worked out. [default: fastest]
    #[arg(long, value_enum)]
    pub light_at: Option<LightAtFlag>,
}

/// `--method`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Whole {
    /// Hairline's own.
    #[default]
    Default,
    /// That of Velinov, Werner and Hullin (2018).
    Published,
}

/// `--spectrum`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Spectrum {
    /// Beforehand, into a table.
    Table,
    /// At a few wavelengths, by an approximated sine integral.
    SiFast,
    /// At a few wavelengths, by the exact sine integral.
    SiExact,
}

/// `--chords`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ChordsFlag {
    /// A signed sum over roots, each alone.
    Roots,
    /// Clip, project, intersect, cull and sort, as published.
    Steps,
}

/// `--band`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Band {
    /// One to five lines, with a width for each channel, and oblique depths.
    Lines,
    /// The middle line, and depths along the normal.
    Line,
}

/// `--footprint`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Footprint {
    /// The exact mean over a Gaussian.
    Gaussian,
    /// The published blend of two limits.
    Published,
    /// None: the point in the pixel's middle.
    Off,
}

/// `--mask`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Mask {
    /// What they scatter, in colour, scratches weakening one another.
    Energy,
    /// The same without the weakening.
    Linear,
    /// The colourless density of Velinov et al. (2018).
    Density,
}

/// `--sphere-base`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SphereBaseFlag {
    /// Linearly transformed cosines.
    Ltc,
    /// The spherical pivot transform of 2017.
    Sptd,
}

/// `--index`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Index {
    /// The hierarchy, walked once for a tile of pixels.
    Tiles,
    /// The hierarchy, walked by each pixel.
    Bvh,
    /// A list for each triangle. Needs --footprint off.
    Triangles,
}

/// `--gather`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GatherFlag {
    /// Each for itself: the time grows with their number.
    Exact,
    /// Where a pixel covers many, what they add up to, from grids that are fine against it.
    Clusters,
    /// The same, and where no grid is fine enough hundreds of scratches are added up one by one. Quicker than clusters on the CPU,
    /// slower on a software driver.
    Tally,
}

/// `--light-at`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LightAtFlag {
    /// Along scratches on the CPU, for each pixel on graphics adapters.
    Fastest,
    /// For each pixel that it lies under.
    Pixels,
    /// Along it, as densely as its light changes, and interpolated for the pixels: on the CPU several times as fast where scratches
    /// are dense.
    Scratches,
}

impl MethodFlags {
    /// The method that the flags ask for.
    ///
    /// # Errors
    /// Where they contradict one another.
    pub fn method(&self) -> Result<Method, Failure> {
        let mut method = match self.method {
            Whole::Default => Method::fastest(),
            Whole::Published => Method::PUBLISHED,
        };
        if let Some(spectrum) = self.spectrum {
            let count = match method.spectrum {
                method::Spectrum::Wavelengths { count, .. } => count,
                method::Spectrum::Table => PUBLISHED_WAVELENGTHS,
            };
            method.spectrum = match spectrum {
                Spectrum::Table => method::Spectrum::Table,
                Spectrum::SiFast => with_si(count, SineIntegral::Fast),
                Spectrum::SiExact => with_si(count, SineIntegral::Exact),
            };
        }
        if let Some(asked) = self.wavelengths {
            match &mut method.spectrum {
                method::Spectrum::Wavelengths { count, .. } => *count = asked,
                method::Spectrum::Table => {
                    return Err(Failure::Input(anyhow!(
                        "--wavelengths {asked} is for --spectrum si-fast or si-exact: the table holds the whole spectrum"
                    )));
                }
            }
        }
        replace(&mut method.chords, self.chords.map(Into::into));
        replace(&mut method.band, self.band.map(Into::into));
        replace(&mut method.footprint, self.footprint.map(Into::into));
        replace(&mut method.mask, self.mask.map(Into::into));
        replace(&mut method.sphere_base, self.sphere_base.map(Into::into));
        replace(&mut method.lookup, self.index.map(Into::into));
        replace(&mut method.gather, self.gather.map(Into::into));
        replace(&mut method.light_at, self.light_at.map(Into::into));
        if method.gather.has_grids() && !method.is_default_path() {
            return Err(Failure::Input(anyhow!(
                "--gather clusters and tally are of the default method: only --mask, --index and --footprint gaussian or off go with it"
            )));
        }
        let has_tiles = method.lookup == Lookup::Tiles && method.is_default_path();
        if self.light_at == Some(LightAtFlag::Scratches) && !has_tiles {
            return Err(Failure::Input(anyhow!(
                "--light-at scratches is of the default method with --index tiles: only --mask, --gather and --footprint gaussian or \
                 off go with it"
            )));
        }
        if method.lookup == Lookup::Triangles && method.footprint != PixelFilter::Off {
            return Err(Failure::Input(anyhow!(
                "--index triangles needs --footprint off: a triangle's list reaches as far as the coherence window, and a \
                 pixel's footprint may reach further"
            )));
        }
        Ok(method)
    }

    /// What takes the place of a scene's own wish: what the flag says, and every scratch for itself where `method`, which these
    /// flags asked for, knows nothing else.
    pub fn gather_override(&self, method: &Method) -> Option<Gather> {
        match self.gather {
            Some(gather) => Some(gather.into()),
            None => (!method.is_default_path()).then_some(Gather::Exact),
        }
    }

    /// The fewest flags that ask for `method`.
    fn of(method: &Method) -> Self {
        let beside = [
            (Whole::Default, Method::fastest()),
            (Whole::Published, Method::PUBLISHED),
        ]
        .map(|(whole, base)| Self::differing(method, whole, &base));
        let [default, published] = beside;
        if published.given().len() < default.given().len() {
            published
        } else {
            default
        }
    }

    fn differing(method: &Method, whole: Whole, base: &Method) -> Self {
        let count_of = |spectrum| match spectrum {
            method::Spectrum::Wavelengths { count, .. } => count,
            method::Spectrum::Table => PUBLISHED_WAVELENGTHS,
        };
        let count = count_of(method.spectrum);
        Self {
            method: whole,
            spectrum: (spectrum_flag(method.spectrum) != spectrum_flag(base.spectrum))
                .then_some(spectrum_flag(method.spectrum)),
            wavelengths: (count != count_of(base.spectrum)).then_some(count),
            chords: (method.chords != base.chords).then_some(method.chords.into()),
            band: (method.band != base.band).then_some(method.band.into()),
            footprint: (method.footprint != base.footprint).then_some(method.footprint.into()),
            mask: (method.mask != base.mask).then_some(method.mask.into()),
            sphere_base: (method.sphere_base != base.sphere_base)
                .then_some(method.sphere_base.into()),
            index: (method.lookup != base.lookup).then_some(method.lookup.into()),
            gather: (method.gather != base.gather).then_some(method.gather.into()),
            light_at: (method.light_at != base.light_at).then_some(method.light_at.into()),
        }
    }

    /// As they are written.
    fn given(&self) -> Vec<String> {
        let mut flags = Vec::new();
        if self.method != Whole::Default {
            flags.push(written("method", self.method));
        }
        flags.extend(self.spectrum.map(|v| written("spectrum", v)));
        flags.extend(self.wavelengths.map(|n| format!("--wavelengths {n}")));
        flags.extend(self.chords.map(|v| written("chords", v)));
        flags.extend(self.band.map(|v| written("band", v)));
        flags.extend(self.footprint.map(|v| written("footprint", v)));
        flags.extend(self.mask.map(|v| written("mask", v)));
        flags.extend(self.sphere_base.map(|v| written("sphere-base", v)));
        flags.extend(self.index.map(|v| written("index", v)));
        flags.extend(self.gather.map(|v| written("gather", v)));
        flags.extend(self.light_at.map(|v| written("light-at", v)));
        flags
    }
}

/// The fewest flags that ask for a method; nothing for the default.
pub fn flags_of(method: &Method) -> String {
    MethodFlags::of(method).given().join(" ")
}

fn written(flag: &str, value: impl ValueEnum) -> String {
    let value = value.to_possible_value();
    let name = value.as_ref().map_or("", |v| v.get_name());
    format!("--{flag} {name}")
}

fn with_si(count: usize, si: SineIntegral) -> method::Spectrum {
    method::Spectrum::Wavelengths { count, si }
}

fn spectrum_flag(spectrum: method::Spectrum) -> Spectrum {
    match spectrum {
        method::Spectrum::Table => Spectrum::Table,
        method::Spectrum::Wavelengths { si, .. } => match si {
            SineIntegral::Fast => Spectrum::SiFast,
            SineIntegral::Exact => Spectrum::SiExact,
        },
    }
}

fn replace<T>(part: &mut T, by: Option<T>) {
    if let Some(by) = by {
        *part = by;
    }
}

fn wavelengths() -> impl TypedValueParser<Value = usize> {
    PossibleValuesParser::new(["3", "8", "16"]).try_map(|text| text.parse::<usize>())
}

/// A flag's values and the method's, both ways.
macro_rules! same {
    ($flag:ty, $part:ty, $($from:ident => $to:ident),+) => {
        impl From<$flag> for $part {
            fn from(flag: $flag) -> Self {
                match flag { $(<$flag>::$from => Self::$to),+ }
            }
        }
        impl From<$part> for $flag {
            fn from(part: $part) -> Self {
                match part { $(<$part>::$to => Self::$from),+ }
            }
        }
    };
}

same!(ChordsFlag, Chords, Roots => Roots, Steps => Steps);
same!(Band, method::Band, Lines => Lines, Line => MiddleLine);
same!(Footprint, PixelFilter, Gaussian => Gaussian, Published => Published, Off => Off);
same!(Mask, mask::Mask, Energy => Energy, Linear => Linear, Density => Density);
same!(SphereBaseFlag, SphereBase, Ltc => Cosines, Sptd => Pivot);
same!(Index, Lookup, Tiles => Tiles, Bvh => Bvh, Triangles => Triangles);
same!(LightAtFlag, LightAt, Fastest => Fastest, Pixels => Pixels, Scratches => Scratches);
same!(GatherFlag, Gather, Exact => Exact, Clusters => Clusters, Tally => Tally);

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        flags: MethodFlags,
    }

    fn parsed(flags: &str) -> Result<Method, String> {
        let words = std::iter::once("hairline").chain(flags.split_whitespace());
        let command = Command::try_parse_from(words).map_err(|error| error.to_string())?;
        command
            .flags
            .method()
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn no_flag_is_the_default_and_published_is_published() {
        assert_eq!(parsed(""), Ok(Method::fastest()));
        assert_eq!(parsed("--method published"), Ok(Method::PUBLISHED));
        assert_eq!(flags_of(&Method::fastest()), "");
        assert_eq!(flags_of(&Method::PUBLISHED), "--method published");
    }

    #[test]
    fn a_part_is_replaced_and_the_others_stay() {
        let exact = Method {
            spectrum: with_si(16, SineIntegral::Exact),
            ..Method::fastest()
        };
        assert_eq!(parsed("--spectrum si-exact --wavelengths 16"), Ok(exact));
        let point = Method {
            footprint: PixelFilter::Off,
            lookup: Lookup::Triangles,
            ..Method::PUBLISHED
        };
        let flags = "--method published --footprint off --index triangles";
        assert_eq!(parsed(flags), Ok(point));
        assert_eq!(flags_of(&point), flags);
    }

    #[test]
    fn contradictions_are_refused_with_what_would_be_right() {
        for (flags, right) in [
            ("--wavelengths 8", "si-fast or si-exact"),
            (
                "--method published --spectrum table --wavelengths 3",
                "si-fast",
            ),
            ("--index triangles", "--footprint off"),
            ("--method published --index triangles", "--footprint off"),
            ("--wavelengths 5 --spectrum si-fast", "3, 8, 16"),
            ("--gather clusters --method published", "default method"),
            ("--gather clusters --footprint published", "gaussian or off"),
            ("--gather few", "exact, clusters, tally"),
            ("--light-at scratches --index bvh", "--index tiles"),
            ("--light-at scratches --band line", "default method"),
        ] {
            let message = parsed(flags).unwrap_err();
            assert!(message.contains(right), "{flags}: {message}");
        }
    }

    /// Every mixture of parts is said in flags that ask for it again.
    #[test]
    fn flags_lead_there_and_back() {
        let mut count = 0;
        for spectrum in [
            method::Spectrum::Table,
            with_si(3, SineIntegral::Fast),
            with_si(8, SineIntegral::Fast),
            with_si(16, SineIntegral::Exact),
        ] {
            for chords in [Chords::Roots, Chords::Steps] {
                for band in [method::Band::Lines, method::Band::MiddleLine] {
                    for footprint in [
                        PixelFilter::Gaussian,
                        PixelFilter::Published,
                        PixelFilter::Off,
                    ] {
                        for mask in [mask::Mask::Energy, mask::Mask::Linear, mask::Mask::Density] {
                            for sphere_base in [SphereBase::Cosines, SphereBase::Pivot] {
                                for lookup in [Lookup::Tiles, Lookup::Bvh, Lookup::Triangles] {
                                    let gathers = [Gather::Exact, Gather::Clusters, Gather::Tally];
                                    let places =
                                        [LightAt::Pixels, LightAt::Scratches, LightAt::Fastest];
                                    for (gather, light_at) in
                                        gathers.into_iter().flat_map(|g| places.map(|at| (g, at)))
                                    {
                                        let method = Method {
                                            spectrum,
                                            chords,
                                            band,
                                            footprint,
                                            mask,
                                            sphere_base,
                                            lookup,
                                            gather,
                                            light_at,
                                        };
                                        let back = parsed(&flags_of(&method));
                                        let has_list = footprint == PixelFilter::Off;
                                        if lookup == Lookup::Triangles && !has_list
                                            || gather.has_grids() && !method.is_default_path()
                                            || light_at == LightAt::Scratches
                                                && !(lookup == Lookup::Tiles
                                                    && method.is_default_path())
                                        {
                                            assert!(back.is_err());
                                        } else {
                                            assert_eq!(back, Ok(method));
                                            count += 1;
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        // Light at pixels goes with all.
        let exact = 4 * 2 * 2 * 3 * 2 * (3 + 2 + 2);
        // The default path alone, with three masks.
        let clusters = 2 * 3 * (3 + 2);
        // The fastest with all of them, and along scratches with what goes by tiles.
        let along = 2 * 3 * 3;
        assert_eq!(count, 2 * (exact + clusters) + along);
    }
}
