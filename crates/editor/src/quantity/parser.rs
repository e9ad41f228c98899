//! `sum := product (("+" | "-") product)*`, `product := factor (("*" | "/") (factor | unit) | unit)*`,
//! `factor := ("+" | "-") factor | number | "pi" | "(" sum ")"`. A unit counts like a factor, so that `1/4 mm` is a quarter of
//! a millimetre.

use super::dimension::Dimension;

/// A number with its dimension, in metres, degrees, steps, pixels and kelvins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Amount {
    pub value: f64,
    pub dimension: Dimension,
}

/// Deeper brackets than this are no number that a person types.
const DEEPEST: usize = 32;

pub(super) fn amount(typed: &str) -> Result<Amount, String> {
    let tokens = tokens(typed)?;
    let mut parser = Parser {
        tokens: &tokens,
        at: 0,
        depth: 0,
    };
    if tokens.is_empty() {
        return Err("is no number".to_owned());
    }
    let amount = parser.sum()?;
    match parser.tokens.get(parser.at) {
        None => Ok(amount),
        Some(token) => Err(format!("has {} where none belongs", token.name())),
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(f64),
    Unit(Amount, String),
    Sign(char),
}

impl Token {
    fn name(&self) -> String {
        match self {
            Self::Number(value) => format!("the number {value}"),
            Self::Unit(_, word) => format!("the unit {word}"),
            Self::Sign(sign) => format!("a \"{sign}\""),
        }
    }
}

struct Parser<'t> {
    tokens: &'t [Token],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn take(&mut self, signs: &[char]) -> Option<char> {
        match self.tokens.get(self.at) {
            Some(Token::Sign(sign)) if signs.contains(sign) => {
                self.at += 1;
                Some(*sign)
            }
            _ => None,
        }
    }

    fn take_unit(&mut self) -> Option<Amount> {
        match self.tokens.get(self.at) {
            Some(Token::Unit(unit, _)) => {
                self.at += 1;
                Some(*unit)
            }
            _ => None,
        }
    }

    fn sum(&mut self) -> Result<Amount, String> {
        let mut sum = self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            let next = self.product()?;
            if next.dimension != sum.dimension {
                return Err(format!(
                    "adds {} and {}: give each part of a sum its unit",
                    sum.dimension.name(),
                    next.dimension.name()
                ));
            }
            sum.value += if sign == '+' { next.value } else { -next.value };
        }
        Ok(sum)
    }

    fn product(&mut self) -> Result<Amount, String> {
        let mut product = self.factor()?;
        loop {
            let (next, sign) = if let Some(unit) = self.take_unit() {
                (unit, 1)
            } else if let Some(sign) = self.take(&['*', '/']) {
                let next = match self.take_unit() {
                    Some(unit) => unit,
                    None => self.factor()?,
                };
                (next, if sign == '*' { 1 } else { -1 })
            } else {
                return Ok(product);
            };
            if sign == -1 && next.value == 0.0 {
                return Err("divides by zero".to_owned());
            }
            product.value = match sign {
                1 => product.value * next.value,
                _ => product.value / next.value,
            };
            product.dimension = product.dimension.times(next.dimension, sign);
        }
    }

    fn factor(&mut self) -> Result<Amount, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err("is nested too deeply".to_owned());
        }
        let factor = self.factor_within();
        self.depth -= 1;
        factor
    }

    fn factor_within(&mut self) -> Result<Amount, String> {
        if let Some(sign) = self.take(&['+', '-']) {
            let factor = self.factor()?;
            return Ok(Amount {
                value: if sign == '-' {
                    -factor.value
                } else {
                    factor.value
                },
                ..factor
            });
        }
        if self.take(&['(']).is_some() {
            let sum = self.sum()?;
            return match self.take(&[')']) {
                Some(_) => Ok(sum),
                None => Err("lacks a \")\"".to_owned()),
            };
        }
        match self.tokens.get(self.at) {
            Some(Token::Number(value)) => {
                self.at += 1;
                Ok(Amount {
                    value: *value,
                    dimension: Dimension::NONE,
                })
            }
            Some(token) => Err(format!("has {} where a number belongs", token.name())),
            None => Err("ends where a number belongs".to_owned()),
        }
    }
}

fn tokens(typed: &str) -> Result<Vec<Token>, String> {
    let mut tokens = Vec::new();
    let mut rest = typed.trim();
    while let Some(first) = rest.chars().next() {
        let taken = match first {
            c if c.is_whitespace() => c.len_utf8(),
            '0'..='9' | '.' | ',' => {
                let (value, length) = number(rest)?;
                tokens.push(Token::Number(value));
                length
            }
            '+' | '-' | '−' | '–' | '*' | '×' | '·' | '/' | '÷' | '(' | ')' => {
                tokens.push(Token::Sign(match first {
                    '−' | '–' => '-',
                    '×' | '·' => '*',
                    '÷' => '/',
                    other => other,
                }));
                first.len_utf8()
            }
            _ => {
                let length = rest
                    .find(|c: char| !is_of_word(c))
                    .unwrap_or(rest.len())
                    .max(first.len_utf8());
                let word = &rest[..length];
                let (n, more) = power(&rest[length..])?;
                tokens.push(match word {
                    "pi" | "π" => Token::Number(std::f64::consts::PI),
                    _ => Token::Unit(unit(word, n)?, word.to_owned()),
                });
                length + more
            }
        };
        rest = &rest[taken..];
    }
    Ok(tokens)
}

fn is_of_word(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '°' | '"' | '%' | '″')
}

/// A number at the start of a text, and its length. Spaces in groups of three digits are part of it.
fn number(text: &str) -> Result<(f64, usize), String> {
    let mut plain = String::new();
    let mut marks = Vec::new();
    let mut chars = text.char_indices().peekable();
    let mut end = 0;
    while let Some(&(at, c)) = chars.peek() {
        match c {
            '0'..='9' => plain.push(c),
            '.' | ',' => {
                marks.push((c, plain.len()));
                plain.push('.');
            }
            '_' | '\'' | '\u{a0}' | '\u{202f}' | '\u{2009}' | ' ' if is_group(&text[at..]) => {}
            'e' | 'E' if is_exponent(&text[at..]) => {
                plain.push(c);
                chars.next();
                if let Some(&(_, sign @ ('+' | '-'))) = chars.peek() {
                    plain.push(sign);
                    chars.next();
                }
                while let Some(&(_, digit @ '0'..='9')) = chars.peek() {
                    plain.push(digit);
                    chars.next();
                }
                end = chars.peek().map_or(text.len(), |(at, _)| *at);
                break;
            }
            _ => break,
        }
        chars.next();
        end = at + c.len_utf8();
    }
    let shown = &text[..end];
    match marks[..] {
        // A thousand for some, one for others.
        [(',', at)]
            if plain.len() == at + 4 && (1..=3).contains(&at) && !plain.starts_with('0') =>
        {
            let decimal = plain.parse::<f64>().unwrap_or_default();
            Err(format!(
                "may mean {} or {decimal:?}: write one of them",
                plain.replace('.', "")
            ))
        }
        [] | [_] => match plain.parse::<f64>() {
            Ok(value) => Ok((value, end)),
            Err(_) => Err(format!("has \"{shown}\", which is no number")),
        },
        _ => Err(format!(
            "has \"{shown}\", which is no number: write one decimal point and nothing between thousands"
        )),
    }
}

/// Whether a gap before exactly three digits begins here.
fn is_group(text: &str) -> bool {
    let mut chars = text.chars().skip(1);
    let digits = chars.by_ref().take_while(char::is_ascii_digit).count();
    digits == 3
}

fn is_exponent(text: &str) -> bool {
    let rest = text[1..].trim_start_matches(['+', '-']);
    rest.starts_with(|c: char| c.is_ascii_digit()) && text.len() - rest.len() <= 2
}

/// The power behind a unit and its length: `²`, `^2`, `2` or nothing.
fn power(text: &str) -> Result<(i8, usize), String> {
    for (mark, n) in [("²", 2), ("^2", 2), ("2", 2), ("^1", 1)] {
        if text.starts_with(mark) {
            return Ok((n, mark.len()));
        }
    }
    match text.starts_with(['^', '³', '3']) {
        true => Err("has a power that no number here has".to_owned()),
        false => Ok((1, 0)),
    }
}

fn unit(word: &str, n: i8) -> Result<Amount, String> {
    let none = Dimension::NONE;
    let length = Dimension { length: 1, ..none };
    let (value, dimension) = match word.to_lowercase().as_str() {
        "nm" => (1e-9, length),
        // The micro sign, and the Greek letter.
        "um" | "\u{b5}m" | "\u{3bc}m" | "micron" | "microns" => (1e-6, length),
        "mm" => (1e-3, length),
        "cm" => (1e-2, length),
        "m" => (1.0, length),
        "km" => (1e3, length),
        "in" | "inch" | "inches" | "\"" | "″" => (0.0254, length),
        "ft" => (0.3048, length),
        "°" | "deg" | "degree" | "degrees" => (1.0, Dimension { angle: 1, ..none }),
        "rad" => (1_f64.to_degrees(), Dimension { angle: 1, ..none }),
        "ev" => (
            1.0,
            Dimension {
                exposure: 1,
                ..none
            },
        ),
        "px" => (1.0, Dimension { pixel: 1, ..none }),
        "k" => (
            1.0,
            Dimension {
                temperature: 1,
                ..none
            },
        ),
        "%" => (0.01, none),
        _ => {
            return Err(format!(
                "has \"{}\", which is no unit known here (nm, um, mm, cm, m, in, deg, rad, EV, px, K, %)",
                word.chars().take(20).collect::<String>()
            ));
        }
    };
    Ok(Amount {
        value: value.powi(n.into()),
        dimension: dimension.power(n),
    })
}
