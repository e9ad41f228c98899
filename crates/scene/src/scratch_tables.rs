//! Tables of scratches and gratings in a scene's materials, which every renderer reads alike.

use crate::fine_gratings::{cover, efficiencies, fine_grooves};
use crate::grating::Grating;
use crate::groove_shapes::GrooveShapes;
use crate::kept_tables::KeptTables;
use crate::material_optics::{MaterialOptics, Numbered, Reflector};
use crate::scene::{Material, Scene};
use hairline_optics::cover::Cover;
use hairline_optics::fresnel::FresnelCurve;
use hairline_optics::grating::{Grating as Row, RigorousGrating};
use hairline_optics::groove_spectrum::GrooveSpectrum;
use hairline_optics::metal::{Metal, MetalIndex};
use hairline_optics::rigorous::{Efficiencies, FineGrooves, Medium};
use hairline_optics::section::GrooveShape;
use hairline_optics::spectrum::Observer;
use hairline_optics::table::ScratchTable;
use std::cell::OnceCell;
use std::sync::{Arc, OnceLock};

/// The scratch tables that a scene needs, one for each reflectance spectrum and shape of grooves.
pub struct ScratchTables {
    /// Distinct tables.
    pub tables: Vec<Arc<ScratchTable>>,
    /// The metals, each with tables for all shapes; none for white.
    pub metals: Vec<Option<MetalIndex>>,
    /// Shapes of the scratches.
    pub shapes: GrooveShapes,
    /// Distinct curves of reflectance over the angle.
    pub curves: Vec<FresnelCurve>,
    /// Reflector of each curve.
    pub reflectors: Vec<Reflector>,
    /// One for each material of the scene.
    pub materials: Vec<MaterialOptics>,
    /// Spectrum of each table of a grating. Tables of materials come before them.
    pub grating_spectra: Vec<GratingSpectrum>,
    /// Efficiencies of each of those that are rigorous.
    efficiencies: Vec<Option<Arc<Efficiencies>>>,
    /// The scene's materials.
    of: Vec<Material>,
    /// What the channels are.
    observer: Observer,
}

/// Everything that the table of a grating depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct GratingSpectrum {
    /// The grooves.
    pub row: Row,
    /// The metal that they are in; none for white's reflectance.
    pub metal: Option<MetalIndex>,
    /// Standard deviation of the coherence window on the surface.
    pub coherence_um: f64,
    /// Grooves of its rigorous efficiencies; none where they are scalar.
    pub fine: Option<FineGrooves>,
    /// A plate over the grooves.
    pub cover: Option<Cover>,
}

impl GratingSpectrum {
    /// The grooves with their efficiencies.
    fn rigorous<'a>(
        &'a self,
        efficiencies: &'a Efficiencies,
        observer: &'a Observer,
    ) -> Option<RigorousGrating<'a>> {
        let medium = &self.fine.as_ref()?.medium;
        Some(RigorousGrating {
            row: self.row,
            efficiencies,
            observer,
            medium,
            is_colored: matches!(medium, Medium::Metal(_)) && self.metal.is_none(),
            cover: self.cover,
        })
    }
}

impl ScratchTables {
    /// Tables and coefficients for all materials of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self::unless(scene, &|| false).expect("nothing cancels it")
    }

    /// As [`Self::new`]; none where `cancelled` says so, which is asked from any thread.
    pub fn unless(scene: &Scene, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let shapes = GrooveShapes::new(scene);
        let Numbered {
            materials,
            metals,
            reflectors,
        } = Numbered::new(scene, shapes.shapes().len());
        let mut of_shapes = Vec::new();
        for shape in shapes.shapes() {
            if cancelled() {
                return None;
            }
            of_shapes.push(shaped_tables(scene, &metals, &shape));
        }
        let of_metal = |i: usize| of_shapes.iter().map(move |tables| Arc::clone(&tables[i]));
        let mut all = Self {
            tables: (0..metals.len()).flat_map(of_metal).collect(),
            grating_spectra: Vec::new(),
            efficiencies: Vec::new(),
            of: scene.materials.clone(),
            observer: scene.observer.clone(),
            metals,
            shapes,
            curves: reflectors
                .iter()
                .map(|r| r.curve(&scene.observer))
                .collect(),
            reflectors,
            materials,
        };
        all.grating_spectra = all.spectra(scene);
        for of in &all.grating_spectra {
            let efficiencies = match &of.fine {
                Some(fine) => {
                    let make = || efficiencies(fine, cancelled);
                    Some(scene.tables.efficiencies.value(fine.clone(), make)?)
                }
                None => None,
            };
            let observer = &scene.observer;
            let rigorous = (efficiencies.as_ref()).and_then(|it| of.rigorous(it, observer));
            let table = match rigorous {
                Some(rigorous) => rigorous.table(of.coherence_um),
                None => (of.row).table_seen_by(observer, of.coherence_um, |nm| {
                    reflectance(of.metal.as_ref(), nm)
                }),
            };
            all.tables.push(Arc::new(table));
            all.efficiencies.push(efficiencies);
        }
        Some(all)
    }

    /// The same with [smooth](ScratchTable::smooth) tables of scratches. Those of gratings stay.
    #[must_use]
    pub fn smooth(mut self) -> Self {
        let shapes: Vec<_> = self.shapes.shapes().collect();
        let scratches = self.grating_tables_at();
        for (at, table) in self.tables[..scratches].iter_mut().enumerate() {
            let metal = self.metals[at / shapes.len()].as_ref();
            let of_metal = |nm| reflectance(metal, nm);
            *table = Arc::new(ScratchTable::smooth(&shapes[at % shapes.len()], of_metal));
        }
        self
    }

    /// Whether these are the tables of a scene.
    pub fn are_of(&self, scene: &Scene) -> bool {
        self.of == scene.materials
            && self.observer == scene.observer
            && self.shapes == GrooveShapes::new(scene)
            && self.grating_spectra == self.spectra(scene)
    }

    /// Spectra of all gratings of a scene that has these materials, each once.
    fn spectra(&self, scene: &Scene) -> Vec<GratingSpectrum> {
        let mut spectra = Vec::new();
        for object in scene.objects.iter().filter(|o| !o.gratings.is_empty()) {
            for material in object.mesh.materials() {
                for grating in &object.gratings {
                    let spectrum = self.spectrum(grating, material);
                    if !spectra.contains(&spectrum) {
                        spectra.push(spectrum);
                    }
                }
            }
        }
        spectra
    }

    fn spectrum(&self, grating: &Grating, material: usize) -> GratingSpectrum {
        let material_of = &self.of[material];
        let (cover, fine) = (cover(material_of), fine_grooves(grating, material_of));
        GratingSpectrum {
            row: match (cover, &fine) {
                (Some(cover), None) => grating.row.in_cover(&cover),
                _ => grating.row,
            },
            metal: self.metals[self.materials[material].table as usize / self.shape_count()]
                .clone(),
            coherence_um: self.of[material].coherence_um,
            fine,
            cover,
        }
    }

    /// Index in [`Self::tables`] of the table of a grating on a material. The grating must lie on that material in the
    /// scene.
    pub fn grating_table(&self, grating: &Grating, material: usize) -> Option<usize> {
        let spectrum = self.spectrum(grating, material);
        let at = self.grating_spectra.iter().position(|of| *of == spectrum)?;
        Some(self.grating_tables_at() + at)
    }

    /// Number of tables of each metal.
    fn shape_count(&self) -> usize {
        self.shapes.shapes().len()
    }

    /// Index of the first table of a grating.
    fn grating_tables_at(&self) -> usize {
        self.metals.len() * self.shape_count()
    }

    /// The grooves of a table of one, those of a scalar one as they are in a cover.
    pub fn row(&self, table: usize) -> Row {
        self.grating_spectra[table - self.grating_tables_at()].row
    }

    /// The grating of a table of one, with its efficiencies; none where they are scalar.
    pub fn rigorous(&self, table: usize) -> Option<RigorousGrating<'_>> {
        let at = table - self.grating_tables_at();
        self.grating_spectra[at].rigorous(self.efficiencies[at].as_ref()?, &self.observer)
    }
}

/// The table of scratches in a metal, or in a material without a spectrum. Those of measured metals are constants, made when first asked for.
fn scratch_table(kept: &KeptTables, metal: Option<&MetalIndex>) -> Arc<ScratchTable> {
    static MADE: [OnceLock<Arc<ScratchTable>>; Metal::ALL.len() + 1] =
        [const { OnceLock::new() }; Metal::ALL.len() + 1];
    let make = || ScratchTable::new(|nm| reflectance(metal, nm));
    let at = match metal {
        Some(MetalIndex::Own(_)) => return kept_table(kept, metal, &GrooveShape::default(), make),
        Some(MetalIndex::Measured(measured)) => {
            Metal::ALL.iter().position(|it| it == measured).unwrap_or(0)
        }
        None => Metal::ALL.len(),
    };
    // Not within `get_or_init`: a thread that waits for the parts of a table may take up another scene, which would wait for the table for ever.
    if let Some(made) = MADE[at].get() {
        return Arc::clone(made);
    }
    let made = Arc::new(make());
    Arc::clone(MADE[at].get_or_init(|| made))
}

/// The tables of grooves of a shape in metals. What the shape sends is computed once for all of them.
fn shaped_tables(
    scene: &Scene,
    metals: &[Option<MetalIndex>],
    shape: &GrooveShape,
) -> Vec<Arc<ScratchTable>> {
    let (observer, kept) = (&scene.observer, &*scene.tables);
    let grid = OnceCell::new();
    let made = |metal: Option<&MetalIndex>| {
        let is_rectangle = *shape == GrooveShape::default();
        let grid = (!is_rectangle).then(|| grid.get_or_init(|| GrooveSpectrum::new(shape)));
        ScratchTable::seen_by(observer, grid, |nm| reflectance(metal, nm))
    };
    let table = |metal: &Option<MetalIndex>| {
        let metal = metal.as_ref();
        if observer.is_of_bands() {
            return Arc::new(made(metal));
        }
        match *shape == GrooveShape::default() {
            true => scratch_table(kept, metal),
            false => kept_table(kept, metal, shape, || made(metal)),
        }
    };
    metals.iter().map(table).collect()
}

/// One of the last tables of shapes, and of metals that scenes bring.
fn kept_table(
    kept: &KeptTables,
    metal: Option<&MetalIndex>,
    shape: &GrooveShape,
    make: impl FnOnce() -> ScratchTable,
) -> Arc<ScratchTable> {
    let key = (metal.cloned(), shape.clone());
    let table = kept.scratches.value(key, || Some(make()));
    table.expect("it is made or kept")
}

/// Reflectance at normal incidence.
fn reflectance(metal: Option<&MetalIndex>, wavelength_nm: f64) -> f64 {
    metal.map_or(1.0, |m| m.reflectance(1.0, wavelength_nm))
}
