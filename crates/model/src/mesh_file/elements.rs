//! The properties that elements of a glTF file may have: the specification's (section 5), and those of the extensions that are read.

use std::iter::Peekable;
use std::str::Lines;
use std::sync::LazyLock;

/// Properties of the file's elements. A line is an element, or a list of elements: its property, its name in messages where that is
/// another, and the names of its values. Lines further in are its parts.
const FILE: &str = "\
file = the file: extensionsUsed extensionsRequired scene
  accessors: bufferView byteOffset componentType normalized count type max min
    sparse: count
      indices = indices of sparse: bufferView byteOffset componentType
      values = values of sparse: bufferView byteOffset
  animations:
    channels: sampler
      target = target of channels: node path
    samplers = samplers of animations: input interpolation output
  asset: copyright generator version minVersion
  buffers: uri byteLength
  bufferViews: buffer byteOffset byteLength byteStride target
  cameras: type
    orthographic: xmag ymag zfar znear
    perspective: aspectRatio yfov zfar znear
  images: uri mimeType bufferView
  materials: emissiveFactor alphaMode alphaCutoff doubleSided
    pbrMetallicRoughness: baseColorFactor metallicFactor roughnessFactor
      baseColorTexture = a material's texture: index texCoord
      metallicRoughnessTexture = a material's texture: index texCoord
    normalTexture: index texCoord scale
    occlusionTexture: index texCoord strength
    emissiveTexture = a material's texture: index texCoord
  meshes: weights
    primitives: attributes indices material mode targets
  nodes: camera children skin matrix mesh rotation scale translation weights
  samplers: magFilter minFilter wrapS wrapT
  scenes: nodes
  skins: inverseBindMatrices skeleton joints
  textures: sampler source
";

/// Properties of the extensions that are read.
const EXTENSIONS: &str = "\
EXT_mesh_gpu_instancing: attributes
EXT_meshopt_compression = meshopt_compression: buffer byteOffset byteLength byteStride count mode filter fallback
EXT_texture_webp: source
KHR_draco_mesh_compression: bufferView attributes
KHR_lights_punctual: light
  lights: color intensity type range
    spot: innerConeAngle outerConeAngle
KHR_materials_anisotropy: anisotropyStrength anisotropyRotation
  anisotropyTexture = a material's texture: index texCoord
KHR_materials_clearcoat: clearcoatFactor clearcoatRoughnessFactor
  clearcoatTexture = a material's texture: index texCoord
  clearcoatRoughnessTexture = a material's texture: index texCoord
  clearcoatNormalTexture = normalTexture: index texCoord scale
KHR_materials_emissive_strength: emissiveStrength
KHR_materials_ior: ior
KHR_materials_pbrSpecularGlossiness: diffuseFactor specularFactor glossinessFactor
  diffuseTexture = a material's texture: index texCoord
  specularGlossinessTexture = a material's texture: index texCoord
KHR_materials_specular: specularFactor specularColorFactor
  specularTexture = a material's texture: index texCoord
  specularColorTexture = a material's texture: index texCoord
KHR_meshopt_compression = meshopt_compression: buffer byteOffset byteLength byteStride count mode filter fallback
KHR_node_visibility: visible
KHR_texture_basisu: source
KHR_texture_transform: offset rotation scale texCoord
";

pub(super) static FILE_ELEMENTS: LazyLock<Vec<Element>> =
    LazyLock::new(|| elements(&mut FILE.lines().peekable(), 0));
pub(super) static EXTENSION_ELEMENTS: LazyLock<Vec<Element>> =
    LazyLock::new(|| elements(&mut EXTENSIONS.lines().peekable(), 0));

/// An element: an object of the file.
pub(super) struct Element {
    /// The property that it is the value of.
    pub property: &'static str,
    /// Name of the element in messages.
    pub name: &'static str,
    /// Names of the properties of the element that are values.
    pub values: Vec<&'static str>,
    /// The properties that are elements, or lists of elements.
    pub parts: Vec<Element>,
}

/// The elements of the lines that begin with so many spaces.
fn elements(lines: &mut Peekable<Lines<'static>>, spaces: usize) -> Vec<Element> {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let mut found = Vec::new();
    while let Some(line) = lines.next_if(|line| depth(line) == spaces) {
        let (element, values) = line.trim().split_once(':').unwrap_or((line, ""));
        let (property, name) = element.split_once(" = ").unwrap_or((element, element));
        found.push(Element {
            property,
            name,
            values: values.split_whitespace().collect(),
            parts: elements(lines, spaces + 2),
        });
    }
    found
}

/// Whether the properties of an extension are listed.
pub(super) fn is_extension(name: &str) -> bool {
    EXTENSION_ELEMENTS.iter().any(|it| it.property == name)
}
