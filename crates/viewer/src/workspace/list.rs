//! The list of a layer's scratches as a file.

use std::path::Path;

use hairline_document::write_scratches;
use hairline_editor::Selection;
use hairline_image::output::write_atomically;

use super::Workspace;

impl Workspace {
    /// Writes the scratches of the selected layer, in the frame of their object. Returns their number, or why there is no file.
    pub fn save_list(&self, path: &Path) -> Result<usize, String> {
        let Selection::Layer(layer) = self.selection() else {
            return Err("select a layer of scratches first".to_owned());
        };
        let built = self
            .renderer
            .built()
            .filter(|it| !it.is_sketch() && !self.renderer.is_building());
        let built = built.ok_or("the scratches are being laid; try again in a moment")?;
        let number = self.selection().object(&built.description);
        let number = number.ok_or("the layer lies on no object")?;
        let object = &built.scene.objects[number];
        let scratches = &object.scratches[object.of_layer(layer as u32)];
        if scratches.is_empty() {
            return Err("the layer has no scratches, or is hidden".to_owned());
        }
        let own_from_world = built.description.objects[number]
            .world_from_object()
            .inverse();
        let mut bytes = Vec::new();
        let path = self.document.base_dir().with_path(path);
        write_scratches(object, scratches, &own_from_world, &mut bytes)
            .and_then(|()| write_atomically(path, &bytes).map_err(std::io::Error::other))
            .map_err(|error| error.to_string())?;
        Ok(scratches.len())
    }
}
