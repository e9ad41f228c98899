//! A key of the scene file: all that is known of it. A field of a description is its one entry; reader, range checks, writer, an editor's controls,
//! Python's classes and the tables of docs/scene.md are made of it.

use std::ops::RangeInclusive;

pub use hairline_model::mesh::LARGEST_M;

/// Smaller things than this, metres, are lost between the coordinates of single precision, and below the model's scale.
pub const SMALLEST_M: f64 = 1e-5;

/// A key of the scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Name in the file.
    pub name: &'static str,
    /// Form of the value.
    pub form: Form,
    /// Unit of the value, as people write it; empty without one.
    pub unit: &'static str,
    /// Value where a file leaves it out.
    pub initial: Initial,
    /// Whether a file that is written leaves out the value of a file that leaves it out.
    pub is_omitted: bool,
    /// Values that the scene takes, each number by itself.
    pub bounds: Bounds,
    /// Words for the bounds where they say less than is true.
    range_words: Option<&'static str>,
    /// Meaning, in whole sentences, with Markdown.
    pub meaning: &'static str,
    /// Control for its number, or its numbers alike; of two numbers that differ, for the first.
    pub control: Option<Control>,
    /// Control for the second of two numbers that differ: a spread beside a mean, an outer radius.
    pub second: Option<Control>,
}

/// Form of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A number.
    Number,
    /// A whole number, not negative.
    Whole,
    /// So many numbers.
    Numbers(usize),
    /// So many whole numbers.
    Wholes(usize),
    /// One number for all, or so many.
    OneOrNumbers(usize),
    /// Points of so many numbers.
    Points(usize),
    /// Three numbers: linear Rec.709.
    Color,
    /// A number, or a mean with a spread.
    Sizes,
    /// `true` or `false`.
    Flag,
    /// Free text.
    Text,
    /// The path of a file, relative to the scene file.
    File,
    /// One of these texts.
    Name(&'static [&'static str]),
    /// One of these texts, or a list of numbers.
    NameOrNumbers(&'static [&'static str]),
    /// A table.
    Table,
    /// A list of tables.
    Tables,
}

/// Value of a key that a file leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Initial {
    /// There is none: a file needs the key.
    Required,
    /// No value, or one that depends on others: in words.
    Words(&'static str),
    /// A number.
    Number(f64),
    /// Several numbers.
    Numbers(&'static [f64]),
    /// A mean and a spread.
    Sizes(f64, f64),
    /// `true` or `false`.
    Flag(bool),
    /// A text.
    Text(&'static str),
}

/// Values that a number may have. All are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bounds {
    /// Any.
    Any,
    /// 0 or more.
    AtLeast0,
    /// From the first to the second.
    Within(f64, f64),
    /// Above 0, up to this.
    Above0(f64),
    /// The size of a thing, metres: from [`SMALLEST_M`] to [`LARGEST_M`].
    Size,
    /// A factor that may be negative, whose size lies between these.
    Factor(f64, f64),
    /// The components of a direction of any length but 0.
    Direction,
}

impl Bounds {
    /// The ends of what may be typed. Where the scene has none they are far beyond any use, so that a slip of the hand is refused.
    pub fn ends(self) -> RangeInclusive<f64> {
        match self {
            // Some thousand turns.
            Self::Any | Self::Direction => -1e6..=1e6,
            // Times all exposures of a scene it is still a number of single precision.
            Self::AtLeast0 => 0.0..=1e15,
            Self::Within(least, most) => least..=most,
            Self::Above0(most) => f64::MIN_POSITIVE..=most,
            Self::Size => SMALLEST_M..=LARGEST_M,
            Self::Factor(_, most) => -most..=most,
        }
    }

    /// The nearest number that may be typed.
    pub fn clamp(self, number: f64) -> f64 {
        let (least, most) = self.ends().into_inner();
        number.clamp(least, most)
    }
}

/// Control of a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Label.
    pub label: &'static str,
    /// Its slider.
    pub slider: Slider,
    /// Values that may be typed.
    pub bounds: Bounds,
    /// Unit, as that of a key.
    pub unit: &'static str,
    /// Effect on the look.
    pub tooltip: &'static str,
}

/// A slider: good looks lie within its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Whether equal ways of the slider are equal factors.
    pub is_logarithmic: bool,
    /// Power of the diagonal of the object, or the scene, that both ends are multiplied by.
    pub power_of_size: i32,
}

/// A slider of equal steps.
pub(crate) const fn linear(from: f64, to: f64) -> Slider {
    Slider {
        from,
        to,
        is_logarithmic: false,
        power_of_size: 0,
    }
}

/// A slider of equal factors.
pub(crate) const fn log(from: f64, to: f64) -> Slider {
    Slider {
        is_logarithmic: true,
        ..linear(from, to)
    }
}

impl Slider {
    /// Ends in diagonals of the object.
    pub(crate) const fn sized(self) -> Self {
        self.sized_by(1)
    }

    pub(crate) const fn sized_by(self, power_of_size: i32) -> Self {
        Self {
            power_of_size,
            ..self
        }
    }
}

/// Each part of a key, in the order in which keys are written.
impl Key {
    pub(crate) const fn new(name: &'static str, form: Form) -> Self {
        Self {
            name,
            form,
            unit: "",
            initial: Initial::Required,
            is_omitted: false,
            bounds: Bounds::Any,
            range_words: None,
            meaning: "",
            control: None,
            second: None,
        }
    }

    /// All but the name, the form and the meaning of another key.
    pub(crate) const fn like(self, other: &Self) -> Self {
        Self {
            name: self.name,
            form: self.form,
            meaning: self.meaning,
            ..*other
        }
    }

    pub(crate) const fn form(self, form: Form) -> Self {
        Self { form, ..self }
    }

    /// Three numbers as a colour.
    pub(crate) const fn color(self) -> Self {
        self.form(Form::Color).unit("linear RGB")
    }

    pub(crate) const fn omitted(self) -> Self {
        Self {
            is_omitted: true,
            ..self
        }
    }

    pub(crate) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    pub(crate) const fn is(self, initial: Initial) -> Self {
        Self { initial, ..self }
    }

    pub(crate) const fn number(self, number: f64) -> Self {
        self.is(Initial::Number(number))
    }

    pub(crate) const fn sizes(self, mean: f64, spread: f64) -> Self {
        self.is(Initial::Sizes(mean, spread))
    }

    pub(crate) const fn flag(self, flag: bool) -> Self {
        self.is(Initial::Flag(flag))
    }

    pub(crate) const fn text(self, text: &'static str) -> Self {
        self.is(Initial::Text(text))
    }

    pub(crate) const fn none(self) -> Self {
        self.is(Initial::Words("none"))
    }

    pub(crate) const fn words(self, words: &'static str) -> Self {
        self.is(Initial::Words(words))
    }

    pub(crate) const fn bounds(self, bounds: Bounds) -> Self {
        Self { bounds, ..self }
    }

    pub(crate) const fn in_range(self, least: f64, most: f64) -> Self {
        self.bounds(Bounds::Within(least, most))
    }

    pub(crate) const fn at_least_0(self) -> Self {
        self.bounds(Bounds::AtLeast0)
    }

    pub(crate) const fn above_0(self, most: f64) -> Self {
        self.bounds(Bounds::Above0(most))
    }

    pub(crate) const fn size(self) -> Self {
        self.bounds(Bounds::Size)
    }

    pub(crate) const fn factor(self, least: f64, most: f64) -> Self {
        self.bounds(Bounds::Factor(least, most))
    }

    pub(crate) const fn direction(self) -> Self {
        self.bounds(Bounds::Direction)
    }

    pub(crate) const fn range_words(self, words: &'static str) -> Self {
        Self {
            range_words: Some(words),
            ..self
        }
    }

    pub(crate) const fn means(self, meaning: &'static str) -> Self {
        Self { meaning, ..self }
    }

    pub(crate) const fn control(
        self,
        label: &'static str,
        slider: Slider,
        tooltip: &'static str,
    ) -> Self {
        Self {
            control: Some(Control {
                label,
                slider,
                bounds: self.bounds,
                unit: self.unit,
                tooltip,
            }),
            ..self
        }
    }

    /// A control without a slider.
    pub(crate) const fn labelled(self, label: &'static str, tooltip: &'static str) -> Self {
        self.control(label, linear(0.0, 1.0), tooltip)
    }

    pub(crate) const fn second(
        self,
        label: &'static str,
        slider: Slider,
        bounds: Bounds,
        unit: &'static str,
        tooltip: &'static str,
    ) -> Self {
        Self {
            second: Some(Control {
                label,
                slider,
                bounds,
                unit,
                tooltip,
            }),
            ..self
        }
    }

    /// Whether its controls have sliders: those of numbers.
    pub fn has_sliders(&self) -> bool {
        self.control.is_some() && !matches!(self.form, Form::Flag | Form::Text)
    }

    /// The value of a file that leaves it out, in words with Markdown.
    pub fn initial_words(&self) -> String {
        match self.initial {
            Initial::Required => "–".to_owned(),
            Initial::Words(words) => words.to_owned(),
            Initial::Number(number) => format!("{number}"),
            Initial::Numbers(numbers) => format!("`{numbers:?}`").replace(".0", ""),
            Initial::Sizes(mean, spread) => format!("mean {mean}, spread {spread}"),
            Initial::Flag(flag) => format!("`{flag}`"),
            Initial::Text(text) => format!("`\"{text}\"`"),
        }
    }

    /// The values that it takes, in words with Markdown.
    pub fn range(&self) -> String {
        if let Some(words) = self.range_words {
            return words.to_owned();
        }
        let each = match self.form {
            Form::Flag => return "`true`, `false`".to_owned(),
            Form::Name(names) | Form::NameOrNumbers(names) => {
                let names: Vec<_> = names.iter().map(|name| format!("`\"{name}\"`")).collect();
                return names.join(", ");
            }
            Form::Numbers(_) | Form::Wholes(_) | Form::Color => " each",
            _ => "",
        };
        match self.bounds {
            Bounds::Any => "any".to_owned(),
            Bounds::AtLeast0 => format!("0 or more{each}"),
            Bounds::Within(least, most) if least == -most => format!("±{most}{each}"),
            Bounds::Within(least, most) => format!("{least} to {most}{each}"),
            Bounds::Above0(most) => format!("above 0, up to {most}"),
            Bounds::Size => format!("{SMALLEST_M:e} to {LARGEST_M}{each}"),
            Bounds::Factor(least, most) => format!("{least:e} to {most:e}, or as much below 0"),
            Bounds::Direction => "not zero".to_owned(),
        }
    }
}
