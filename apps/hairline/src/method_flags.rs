//! The flags that choose a method, and the way back from a method to its flags.

use anyhow::anyhow;
use clap::{Args, ValueEnum};
use hairline_console::Switch;
use hairline_optics::mask;
use hairline_published::sine_integral::SineIntegral;
use hairline_published::{Method, PublishedMethod, Structure};

use hairline_work::failure::Failure;

/// Flags of the method by which scratches are computed.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Method")]
pub struct MethodFlags {
    /// The whole method.
    #[arg(long, value_enum, default_value_t = MethodName::Default)]
    pub method: MethodName,
    /// Energy that the base loses to scratches. [default: energy; density for the published method]
    #[arg(long, value_enum)]
    pub mask: Option<Mask>,
    /// Structure by which the published method finds the scratches under a pixel. [default: bvh]
    #[arg(long, value_enum)]
    pub index: Option<Index>,
    /// Whether the published method averages over a pixel. [default: on]
    #[arg(long, value_enum)]
    pub anti_aliasing: Option<Switch>,
    /// The published method's sine integral. [default: fast]
    #[arg(long, value_enum)]
    pub si: Option<Si>,
}

/// `--method`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Hairline's own.
    #[default]
    Default,
    /// Method of Velinov, Werner and Hullin (2018).
    Published,
}

/// `--mask`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Mask {
    /// Scattered energy, in colour, scratches weakening one another.
    Energy,
    /// Scattered energy without the weakening.
    Linear,
    /// The colourless density of Velinov et al. (2018).
    Density,
}

/// `--index`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Index {
    /// The bounding volume hierarchy, traversed for each pixel.
    Bvh,
    /// A list for each triangle. Needs --anti-aliasing off.
    Triangles,
}

/// `--si`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Si {
    /// Approximated, as published.
    Fast,
    /// Exact.
    Exact,
}

impl MethodFlags {
    /// Method by the flags.
    ///
    /// # Errors
    /// Where they contradict one another.
    pub fn method(&self) -> Result<Method, Failure> {
        let mut method = match self.method {
            MethodName::Default => Method::default(),
            MethodName::Published => Method::PUBLISHED,
        };
        if let Some(mask) = self.mask {
            method.mask = mask.into();
        }
        let Some(published) = &mut method.published else {
            return match self.switches().first() {
                None => Ok(method),
                Some(flag) => Err(Failure::Input(anyhow!(
                    "{flag} is a switch of the published method: add --method published"
                ))),
            };
        };
        if let Some(index) = self.index {
            published.structure = index.into();
        }
        if let Some(switch) = self.anti_aliasing {
            published.anti_aliasing = switch == Switch::On;
        }
        if let Some(si) = self.si {
            published.si = si.into();
        }
        if published.structure == Structure::TriangleLists && published.anti_aliasing {
            return Err(Failure::Input(anyhow!(
                "--index triangles needs --anti-aliasing off: a triangle's list reaches as far as the coherence window, and a \
                 pixel's footprint may reach further"
            )));
        }
        Ok(method)
    }

    /// Shortest set of flags for `method`.
    fn from_method(method: &Method) -> Self {
        let (whole, base) = match method.published {
            None => (MethodName::Default, Method::default()),
            Some(_) => (MethodName::Published, Method::PUBLISHED),
        };
        let published = method.published.unwrap_or_default();
        let usual = PublishedMethod::default();
        let switch = match published.anti_aliasing {
            true => Switch::On,
            false => Switch::Off,
        };
        Self {
            method: whole,
            mask: (method.mask != base.mask).then_some(method.mask.into()),
            index: (published.structure != usual.structure).then_some(published.structure.into()),
            anti_aliasing: (published.anti_aliasing != usual.anti_aliasing).then_some(switch),
            si: (published.si != usual.si).then_some(published.si.into()),
        }
    }

    /// Flags of the published method alone, as they are written.
    fn switches(&self) -> Vec<String> {
        let mut flags = Vec::new();
        flags.extend(self.index.map(|v| written("index", v)));
        flags.extend(self.anti_aliasing.map(|v| written("anti-aliasing", v)));
        flags.extend(self.si.map(|v| written("si", v)));
        flags
    }

    /// All flags, as they are written.
    fn given(&self) -> Vec<String> {
        let mut flags = Vec::new();
        if self.method != MethodName::Default {
            flags.push(written("method", self.method));
        }
        flags.extend(self.mask.map(|v| written("mask", v)));
        flags.extend(self.switches());
        flags
    }
}

/// Text of the shortest set of flags for a method; empty for the default.
pub fn flags_of(method: &Method) -> String {
    MethodFlags::from_method(method).given().join(" ")
}

fn written(flag: &str, value: impl ValueEnum) -> String {
    let value = value.to_possible_value();
    let name = value.as_ref().map_or("", |v| v.get_name());
    format!("--{flag} {name}")
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

same!(Mask, mask::Mask, Energy => Energy, Linear => Linear, Density => Density);
same!(Index, Structure, Bvh => Bvh, Triangles => TriangleLists);
same!(Si, SineIntegral, Fast => Fast, Exact => Exact);

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
        assert_eq!(parsed(""), Ok(Method::default()));
        assert_eq!(parsed("--method published"), Ok(Method::PUBLISHED));
        assert_eq!(flags_of(&Method::default()), "");
        assert_eq!(flags_of(&Method::PUBLISHED), "--method published");
    }

    #[test]
    fn contradictions_are_refused_with_what_would_be_right() {
        for (flags, right) in [
            ("--si exact", "add --method published"),
            ("--index bvh", "add --method published"),
            ("--anti-aliasing off", "add --method published"),
            ("--method default --si fast", "--si fast is a switch"),
            (
                "--method published --index triangles",
                "--anti-aliasing off",
            ),
            ("--method published --index tiles", "bvh, triangles"),
            ("--mask none", "energy, linear, density"),
        ] {
            let message = parsed(flags).unwrap_err();
            assert!(message.contains(right), "{flags}: {message}");
        }
    }

    /// Every method has flags that lead to it again.
    #[test]
    fn flags_lead_there_and_back() {
        let structures = [Structure::Bvh, Structure::TriangleLists];
        let sis = [SineIntegral::Fast, SineIntegral::Exact];
        let mut published = vec![None];
        for (structure, si) in structures.into_iter().flat_map(|s| sis.map(|si| (s, si))) {
            for anti_aliasing in [true, false] {
                published.push(Some(PublishedMethod {
                    structure,
                    anti_aliasing,
                    si,
                }));
            }
        }
        for published in published {
            for mask in [mask::Mask::Energy, mask::Mask::Linear, mask::Mask::Density] {
                let method = Method { published, mask };
                let back = parsed(&flags_of(&method));
                let is_refused = published
                    .is_some_and(|it| it.anti_aliasing && it.structure == Structure::TriangleLists);
                match is_refused {
                    true => assert!(back.is_err()),
                    false => assert_eq!(back, Ok(method)),
                }
            }
        }
    }
}
