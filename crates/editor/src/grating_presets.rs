//! Gratings to start from: things that everybody knows.

use hairline_document::description::{Distribution, Grating, GroovePattern, PatternAxis};

hairline_image::listed! {
    /// A grating with all its numbers.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum GratingPreset {
        /// The track of a compact disc.
        CompactDisc = "Compact disc",
            "A row around the z axis every 1.6 µm: fans of pure rainbows that turn with the light, two or three on each side.";
        /// Grating of a DVD.
        Dvd = "DVD", "A row every 0.74 µm: one wide rainbow, far away from the highlight.";
        /// The lands between the grooves of a record, as its stamper leaves them.
        Vinyl = "Vinyl", "Rough grooves every 40 µm around the z axis: faint colours close to a soft bright fan. For dark plastic.";
        /// Embossed foil.
        Foil = "Holographic foil", "Straight rows every 1.2 µm along x: a lamp breaks into colours across them. Wrapping paper, seals.";
        /// Drawn over by a fine brush.
        BrushedAluminium = "Brushed aluminium",
            "Fine uneven rows along x: lamps are drawn out into streaks with a hint of colour. Hi-fi fronts, laptops.";
        /// Turned on a lathe.
        TurnedSteel = "Turned steel", "The feed of a lathe, 30 µm, around the z axis: narrow colours beside the highlight, in a fan.";
        /// Spots from a spinning peg: plates of watches, dashboards.
        EngineTurned = "Engine turning",
            "Spots of circles in rows, each over those before it: scales in which every lamp draws a line. Plates of watches, dashboards.";
    }
    /// Name in a menu.
    fn name;
    /// Description of its look, for a tooltip.
    fn tooltip;
}

impl GratingPreset {
    /// The grating on an object.
    pub fn grating(self, object: impl Into<String>) -> Grating {
        let circular = |jitter_deg| {
            GroovePattern::Circular(PatternAxis {
                jitter_deg,
                ..PatternAxis::default()
            })
        };
        let along_x = |jitter_deg| GroovePattern::Parallel {
            direction: [1.0, 0.0, 0.0],
            jitter_deg,
        };
        let spots = |jitter_deg, spacing_m| GroovePattern::Swirl {
            around: PatternAxis {
                jitter_deg,
                ..PatternAxis::default()
            },
            spacing_m,
        };
        // Pattern; pitch, width and jitter in um; mean and spread of the depth in nm.
        let (pattern, [pitch_um, width_um, jitter_um], [mean, spread]) = match self {
            Self::CompactDisc => (circular(0.0), [1.6, 0.6, 0.03], [110.0, 0.05]),
            Self::Dvd => (circular(0.0), [0.74, 0.32, 0.015], [105.0, 0.05]),
            Self::Vinyl => (circular(0.3), [40.0, 16.0, 2.0], [400.0, 0.5]),
            Self::Foil => (along_x(0.5), [1.2, 0.6, 0.03], [140.0, 0.05]),
            Self::BrushedAluminium => (along_x(1.5), [6.0, 2.4, 1.5], [160.0, 0.5]),
            Self::TurnedSteel => (circular(0.2), [30.0, 12.0, 1.0], [140.0, 0.2]),
            Self::EngineTurned => (spots(0.5, 0.004), [8.0, 3.2, 1.5], [160.0, 0.4]),
        };
        Grating {
            name: Some(self.name().to_lowercase()),
            width_um,
            depth_nm: Distribution { mean, spread },
            jitter_um,
            ..Grating::new(object, pattern, pitch_um)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_document::Description;

    #[test]
    fn presets_are_scenes_and_come_back_from_their_files() {
        let text = "camera = { position_m = [0, -0.2, 0.2], target_m = [0, 0, 0], up = [0, 0, 1] }\n\
            material = [{ name = \"m\", kind = \"mirror\" }]\n\
            object = [{ name = \"o\", material = \"m\", shape = { disk = { radius_m = 0.06 } } }]\n";
        let mut description = Description::from_toml(text, "test".as_ref()).unwrap();
        description.gratings = GratingPreset::ALL
            .map(|preset| preset.grating("o"))
            .to_vec();
        description
            .check()
            .and(description.check_references())
            .unwrap();
        let saved = description.to_toml().unwrap();
        let loaded = Description::from_toml(&saved, "test".as_ref()).unwrap();
        assert_eq!(loaded.gratings, description.gratings);
    }
}
