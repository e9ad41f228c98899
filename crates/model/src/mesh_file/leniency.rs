//! Repairs of files that the specification allows and the crate `gltf` does not, or that lack what nothing here needs: they are
//! read.

use std::num::FpCategory;

use gltf::json::deserialize::from_value;
use gltf::json::image::MimeType;
use gltf::json::validation::Checked::Valid;
use gltf::json::{Index, Root, Value, mesh::Semantic};

/// The extension by which texture coordinates may be whole numbers.
const QUANTIZATION: &str = "KHR_mesh_quantization";
/// Whole numbers beyond this have no place for their last digit in double precision.
const WHOLE_BELOW: f64 = 9_007_199_254_740_992.0;

/// The byte order mark that some editors put before a text; readers of JSON may pass it over (RFC 8259, section 8.1).
pub(crate) fn drop_order_mark(text: &mut Vec<u8>) {
    const MARK: &[u8] = b"\xef\xbb\xbf";
    if text.starts_with(MARK) {
        text.drain(..MARK.len());
    }
}

/// Exporters that pad the text of a binary file by zeros, as its bytes are padded, and not by spaces (glTF 2.0, section 4.4.3.2).
pub(super) fn drop_padding(text: &mut Vec<u8>) {
    let zeros = text.iter().rev().take_while(|byte| **byte == 0).count();
    text.truncate(text.len() - zeros);
}

/// Repairs the text: versions that are numbers, scenes without nodes, and whole numbers written with a point (glTF 2.0, section
/// 2.7).
pub(super) fn loosen_text(value: &mut Value) {
    for name in ["version", "minVersion"] {
        let version = value.get_mut("asset").and_then(|it| it.get_mut(name));
        if let Some(version) = version.filter(|it| it.is_number()) {
            let text = match version.as_f64() {
                Some(number) => format!("{number:?}"),
                None => version.to_string(),
            };
            *version = Value::String(text);
        }
    }
    let scenes = value.get_mut("scenes").and_then(Value::as_array_mut);
    for scene in scenes.into_iter().flatten() {
        if let Some(members) = scene.as_object_mut()
            && !members.contains_key("nodes")
        {
            members.insert("nodes".to_owned(), Value::Array(Vec::new()));
        }
    }
    make_whole(value);
}

fn make_whole(value: &mut Value) {
    match value {
        Value::Array(elements) => elements.iter_mut().for_each(make_whole),
        Value::Object(members) => members.iter_mut().for_each(|it| make_whole(it.1)),
        Value::Number(number) if number.is_f64() => {
            let whole = number
                .as_f64()
                .filter(|x| x.fract().classify() == FpCategory::Zero && x.abs() < WHOLE_BELOW);
            if let Some(whole) = whole {
                *value = Value::from(whole as i64);
            }
        }
        _ => {}
    }
}

/// Repairs the parsed file: accessors without bytes, which are zero (section 3.6.2), positions whose bounds nobody wrote, and images whose
/// kind nobody wrote, which their first bytes tell.
pub(super) fn loosen(root: &mut Root) {
    for image in root.images.iter_mut().filter(|it| it.buffer_view.is_some()) {
        let unsaid = || MimeType("application/octet-stream".to_owned());
        image.mime_type.get_or_insert_with(unsaid);
    }
    let without_bytes = |accessor: &gltf::json::Accessor| {
        accessor.buffer_view.is_none() && accessor.sparse.is_none()
    };
    if root.accessors.iter().any(without_bytes)
        && let Some(nothing) = nothing(root)
    {
        for accessor in root.accessors.iter_mut().filter(|it| without_bytes(it)) {
            accessor.sparse = Some(nothing.clone());
        }
    }
    normalize(root);
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let positions = primitives.filter_map(|it| it.attributes.get(&Valid(Semantic::Positions)));
    let positions: Vec<usize> = positions.map(Index::value).collect();
    for at in positions {
        let Some(accessor) = root.accessors.get_mut(at) else {
            continue;
        };
        for bound in [&mut accessor.min, &mut accessor.max] {
            let values = bound.as_ref().and_then(Value::as_array);
            let is_right =
                values.is_some_and(|it| it.len() == 3 && it.iter().all(Value::is_number));
            if !is_right {
                *bound = Some(Value::from(vec![0; 3]));
            }
        }
    }
}

/// Marks attributes whose integers can be nothing but shares (section 3.7.2.1), where the exporter did not.
fn normalize(root: &mut Root) {
    let may_be_whole = root.extensions_used.iter().any(|it| it == QUANTIZATION);
    let is_share = |semantic: &Semantic| match semantic {
        Semantic::Colors(_) | Semantic::Weights(_) => true,
        Semantic::TexCoords(_) => !may_be_whole,
        _ => false,
    };
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let attributes = primitives.flat_map(|primitive| &primitive.attributes);
    let shares = attributes.filter(|it| matches!(it.0, Valid(semantic) if is_share(semantic)));
    let shares: Vec<usize> = shares.map(|it| it.1.value()).collect();
    for at in shares {
        if let Some(accessor) = root.accessors.get_mut(at) {
            accessor.normalized = true;
        }
    }
}

/// Makes a sparse accessor without elements, in a view of a buffer of no bytes.
fn nothing(root: &mut Root) -> Option<gltf::json::accessor::sparse::Sparse> {
    let made = |text: String| gltf::json::deserialize::from_str::<Value>(&text).ok();
    let buffer = made(r#"{"byteLength":0,"uri":"data:application/octet-stream;base64,"}"#.into());
    root.buffers.push(from_value(buffer?).ok()?);
    let buffer = root.buffers.len() - 1;
    let view = made(format!(r#"{{"buffer":{buffer},"byteLength":0}}"#));
    root.buffer_views.push(from_value(view?).ok()?);
    let view = root.buffer_views.len() - 1;
    let sparse = made(format!(
        r#"{{"count":0,"indices":{{"bufferView":{view},"componentType":5121}},"values":{{"bufferView":{view}}}}}"#
    ));
    from_value(sparse?).ok()
}
