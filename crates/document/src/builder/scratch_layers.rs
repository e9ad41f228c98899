//! The scratches of a scene: those that a build lays, and those that it has from the last one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Work;
use super::kept::{KeptLayer, KeptSurface};
use super::parts::{OnPart, PartGround};
use crate::description::references::find;
use crate::description::{self, Layer, LayerPlaces, standings};
use crate::error::Error;
use crate::grey_map::GreyMap;
use crate::scratches;
use crate::stamp::Stamp;
use hairline_scene::Scene;

/// A `[[scratches]]` table and where it goes.
struct ScratchLayer<'a> {
    table: &'a description::Scratches,
    object: usize,
    /// Number of earlier layers on the same object with the same seed.
    number: u64,
    is_shown: bool,
    /// Versions of the files that the layer is read from.
    files: Vec<Stamp>,
    /// The surface that it is laid on. For a layer that is not to be laid it is set only if it was
    /// made before.
    ground: Option<Arc<PartGround>>,
    /// Scratches that the last build or this one laid.
    laid: Option<Arc<KeptLayer>>,
}

impl<'a> Work<'a> {
    pub(super) fn scratches(
        &mut self,
        surfaces: &[Arc<KeptSurface>],
        scene: &mut Scene,
    ) -> Result<(), Error> {
        let mut layers = self.layers(surfaces)?;
        let is_due = |layer: &ScratchLayer| layer.is_shown && layer.laid.is_none();
        let used = layers.iter().filter(|layer| layer.is_shown);
        let used = used.filter_map(|layer| layer.laid.as_deref());
        let used_bytes = used.map(|kept| kept.laid.bytes()).sum::<f64>() + self.estimate.bytes();
        for (i, layer) in layers
            .iter_mut()
            .enumerate()
            .filter(|(_, layer)| is_due(layer))
        {
            let key = format!("scratches[{i}]");
            let ground = surfaces[layer.object].ground(&OnPart::from_layer(layer.table), &key)?;
            layer.ground = Some(ground);
        }
        let mut tables = Vec::new();
        for (i, layer) in layers.iter().enumerate() {
            let Some(ground) = layer.ground.as_ref().filter(|_| is_due(layer)) else {
                continue;
            };
            let key = format!("scratches[{i}]");
            tables.push(scratches::Table {
                layer: &layer.table.layer,
                section: &layer.table.profile,
                strokes: &layer.table.strokes,
                number: layer.number,
                ground: &ground.ground,
                means: self.means(
                    &layer.table.place,
                    &surfaces[layer.object],
                    &key,
                    used_bytes,
                )?,
                key,
            });
        }
        let laid = scratches::lay(self.loader, &tables, self.base_dir, used_bytes)?;
        drop(tables);
        let due = layers.iter_mut().filter(|layer| is_due(layer));
        for (layer, laid) in due.zip(laid) {
            let Some(ground) = &layer.ground else {
                continue;
            };
            layer.laid = Some(Arc::new(KeptLayer {
                layer: layer.table.layer.clone(),
                profile: layer.table.profile.clone(),
                strokes: layer.table.strokes.clone(),
                place: layer.table.place.clone(),
                number: layer.number,
                ground: ground.ground.clone(),
                files: layer.files.clone(),
                laid: ground.on_the_whole(laid),
            }));
        }
        self.put_onto_objects(layers, scene)
    }

    /// Gives the objects of a scene the scratches of their layers.
    fn put_onto_objects(
        &mut self,
        layers: Vec<ScratchLayer>,
        scene: &mut Scene,
    ) -> Result<(), Error> {
        let shown = layers.iter().enumerate().filter(|(_, it)| it.is_shown);
        for (i, layer) in shown {
            if let Some(note) = layer.laid.as_ref().and_then(|kept| kept.laid.note.as_ref()) {
                scene.notes.push(format!("scratches[{i}]: {note}"));
            }
        }
        for (i, object) in scene.objects.iter_mut().enumerate() {
            let shown = (0..).zip(&layers).filter_map(|(place, layer)| {
                let is_here = layer.is_shown && layer.object == i;
                let laid = layer.laid.as_ref().filter(|_| is_here)?;
                Some((place, laid.clone()))
            });
            let together = self.old.together(shown.collect())?;
            object.scratches = together.scratches.clone();
            object.segments = together.segments.clone();
            self.new.objects.push(together);
        }
        let laid = layers.into_iter().filter_map(|layer| layer.laid);
        self.new.layers = laid.collect();
        Ok(())
    }

    /// Pairs all tables with the scratches that the last build has laid for them.
    fn layers(&self, surfaces: &[Arc<KeptSurface>]) -> Result<Vec<ScratchLayer<'a>>, Error> {
        let tables = &self.description.scratches;
        let mut layers: Vec<ScratchLayer> = Vec::new();
        for (i, (table, standing)) in tables.iter().zip(standings(tables)).enumerate() {
            let names = self.description.objects.iter().map(|o| o.name.as_str());
            let key = format!("scratches[{i}].object");
            let object = find(&table.object, names, &key, "object")?;
            let number = standing.number;
            let is_hidden = self.description.objects[object].hidden || surfaces[object].is_gone();
            let is_shown = standing.is_shown && !is_hidden;
            let ground = surfaces[object].ground_if_made(&OnPart::from_layer(table));
            // Before they are read.
            let files = self.stamps(table);
            let laid = ground
                .as_ref()
                .and_then(|ground| self.old.layer(table, number, &ground.ground, &files));
            layers.push(ScratchLayer {
                files,
                ground,
                table,
                object,
                number,
                is_shown,
                laid,
            });
        }
        Ok(layers)
    }

    /// Stamps of the files that a layer is read from.
    fn stamps(&self, table: &description::Scratches) -> Vec<Stamp> {
        let list = match &table.layer {
            Layer::Listed(listed) => Some(&listed.file),
            Layer::Engraved(engraved) => engraved.line.file(),
            Layer::Laid(_) | Layer::Brushed(_) => None,
        };
        let files = list.into_iter().chain(table.place.files());
        files
            .map(|file| Stamp::read(&self.base_dir.join(file)))
            .collect()
    }

    /// Reads the files that the `where` of a layer names; `key` is the path to it in the scene
    /// file.
    fn means(
        &mut self,
        place: &'a LayerPlaces,
        surface: &KeptSurface,
        key: &str,
        used_bytes: f64,
    ) -> Result<scratches::PlaceInputs<'a>, Error> {
        let mut picture = |name: &str, file: &Option<PathBuf>| {
            let key_path = format!("{key}.where.{name}");
            let read = file
                .as_ref()
                .map(|file| self.grey_map(&key_path, file, used_bytes));
            read.transpose()
        };
        let mask = picture("mask", &place.mask)?;
        let density = picture("density", &place.density)?;
        let whole = (place.edges > 0.0).then(|| surface.ground(&OnPart::default(), key));
        Ok(scratches::PlaceInputs {
            described: place,
            mask,
            density,
            whole: whole.transpose()?.map(|whole| whole.ground.clone()),
        })
    }

    /// A picture of a layer's places. `key` is its path.
    fn grey_map(&mut self, key: &str, file: &Path, used_bytes: f64) -> Result<Arc<GreyMap>, Error> {
        let path = self.base_dir.join(file);
        let stamp = Stamp::read(&path);
        let known = self
            .new
            .grey_map(&stamp)
            .or_else(|| self.old.grey_map(&stamp));
        let map = match known {
            Some(map) => map,
            None => {
                let free_bytes = self.loader.memory_budget_bytes as f64 - used_bytes;
                let read = GreyMap::read(&path, free_bytes);
                Arc::new(read.map_err(|found| {
                    let right = "must be a .png, .jpg or .webp, relative to the scene file";
                    Error::new(key, found, right)
                })?)
            }
        };
        self.new.grey_maps.push((stamp, map.clone()));
        Ok(map)
    }
}
