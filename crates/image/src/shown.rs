//! How much of its scratches a picture shows, and which brightness of lamps shows most of them.

use crate::{Display, Image};

/// Share of the scratched pixels in which scratches must be noticed; below it other light is offered.
pub const FAINT: f32 = 0.08;
/// The same under light that was made for scratches; below it its limits are told.
pub const LITTLE: f32 = 0.25;

/// Share of the scratched pixels that lamps may make white.
const MOST_WHITE: f32 = 0.05;
/// All components of a pixel that looks white, on a display from 0 to 1.
const WHITE: f32 = 245.0 / 255.0;
/// Stops that are tried.
const LAMP_STOPS: std::ops::RangeInclusive<i32> = -10..=2;
/// What other lamps must show over that of those that are there.
const BETTER: f32 = 1.25;

/// One pixel of so many is looked at.
const LOOKED_AT: usize = 7;

/// Shares of the scratched pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// Those in which scratches are noticed.
    pub noticed: f32,
    /// Those that are white, and show nothing.
    pub white: f32,
}

impl Shown {
    /// None where no pixel has scratches.
    pub fn new(image: &Image, display: &Display) -> Option<Self> {
        let (mut scratched, mut noticed, mut white) = (0, 0, 0);
        for i in (0..image.pixel_count()).step_by(LOOKED_AT) {
            if image.density[i] == [0.0; 3] {
                continue;
            }
            scratched += 1;
            let (base, scratches) = (image.base[i], image.scratches[i]);
            let with = std::array::from_fn(|c| base[c] + scratches[c]);
            noticed += u32::from(display.is_noticed(base, with));
            white += u32::from(display.apply(with).iter().all(|c| *c >= WHITE));
        }
        let share = |pixels: u32| pixels as f32 / scratched as f32;
        (scratched > 0).then(|| Self {
            noticed: share(noticed),
            white: share(white),
        })
    }

    /// Sentence about light for scratches that shows [`LITTLE`] of them.
    pub fn little(&self) -> String {
        format!(
            "light for the scratches shows {:.0} % of them from here: elsewhere the surface sends more light itself, as brushed metal and paint do. \
             A smoother surface, wider or deeper scratches or a nearer view show more.",
            100.0 * self.noticed
        )
    }
}

/// The stops by which all light would have to change to show most of the scratches, and what they show then. More light is no better where
/// it makes as much white as it shows, nor any that makes much white.
pub fn best_lamps(image: &Image, display: &Display) -> Option<(i32, Shown)> {
    let tried = LAMP_STOPS.filter_map(|stops| {
        let exposure_ev = display.exposure_ev + f64::from(stops);
        let display = Display {
            exposure_ev,
            ..*display
        };
        Some((stops, Shown::new(image, &display)?))
    });
    let worth = |(stops, shown): &(i32, Shown)| match shown.white > MOST_WHITE {
        true => -shown.white,
        // As they are, where others are hardly better.
        false if *stops == 0 => BETTER * (shown.noticed - shown.white),
        false => shown.noticed - shown.white,
    };
    tried.max_by(|a, b| worth(a).total_cmp(&worth(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scratches on all of a base.
    fn picture(base: f32, scratches: f32) -> Image {
        let mut image = Image::new([50, 10]);
        image.density.fill([0.1; 3]);
        image.base.fill([base; 3]);
        image.scratches.fill([scratches; 3]);
        image
    }

    const NOTHING: Shown = Shown {
        noticed: 0.0,
        white: 1.0,
    };
    const ALL: Shown = Shown {
        noticed: 1.0,
        white: 0.0,
    };

    /// A base as bright as that of brushed metal under a lamp hides its scratches in white: dimmer lamps show them.
    #[test]
    fn dimmer_lamps_show_scratches_that_drown_in_white() {
        let display = Display::default();
        let drowned = picture(40.0, 30.0);
        assert_eq!(Shown::new(&drowned, &display), Some(NOTHING));
        let (stops, shown) = best_lamps(&drowned, &display).unwrap();
        assert!(stops < -3 && shown == ALL, "{stops} {shown:?}");
        // Where they show already, lamps stay as they are.
        let bright = picture(0.02, 0.2);
        assert_eq!(best_lamps(&bright, &display), Some((0, ALL)));
    }

    /// On brushed metal brighter lamps show ever more of the dim scratches, while discs and bars of white grow.
    #[test]
    fn lamps_do_not_become_brighter_where_that_makes_much_white() {
        let mut image = picture(0.001, 0.0);
        let display = Display::default();
        for (i, scratches) in image.scratches.iter_mut().enumerate() {
            // A tenth is bright; half of the rest shows with two stops more.
            *scratches = [[0.02, 0.0035][usize::from(i % 2 == 0)]; 3];
            if i % 10 == 3 {
                *scratches = [0.7; 3];
            }
        }
        let at = |stops: i32| {
            let exposure_ev = f64::from(stops);
            Shown::new(
                &image,
                &Display {
                    exposure_ev,
                    ..display
                },
            )
            .unwrap()
        };
        assert!(
            at(2).noticed > BETTER * at(0).noticed,
            "{:?} {:?}",
            at(0),
            at(2)
        );
        assert!(
            at(0).white == 0.0 && at(2).white > MOST_WHITE,
            "{:?}",
            at(2)
        );
        let (stops, shown) = best_lamps(&image, &display).unwrap();
        assert!(shown.white <= MOST_WHITE && stops < 2, "{stops} {shown:?}");
    }
}
