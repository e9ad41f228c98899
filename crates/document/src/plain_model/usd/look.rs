//! Materials as UsdPreviewSurface.

use std::collections::BTreeMap;
use std::fmt::{Display, Write as _};

use hairline_scene::{AlphaRule, Base, Material, Scene, Wrap};

use crate::plain_model::pictures::png;

/// Names of the two sets of texture coordinates.
pub(super) const UV_SETS: [&str; 2] = ["st", "st1"];

/// The way to a material, by its number in the scene.
pub(super) fn path(number: usize) -> String {
    format!("/Root/Looks/look_{number}")
}

/// The name of a texture's file in the package.
pub(super) fn picture_name(number: usize) -> String {
    format!("textures/{number}.png")
}

/// A name as a text of USD.
pub(super) fn quoted(name: &str) -> String {
    let name = name.replace(char::is_control, " ");
    format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The text of a material, by its number in the scene. `pictures` get the textures that it names.
pub(super) fn text(
    scene: &Scene,
    number: usize,
    pictures: &mut BTreeMap<usize, Vec<u8>>,
) -> String {
    let material = &scene.materials[number];
    let mut look = Look {
        scene,
        path: path(number),
        inputs: String::new(),
        shaders: String::new(),
        pictures,
    };
    look.surface(material);
    look.layers(material);
    let (path, inputs, shaders) = (&look.path, &look.inputs, &look.shaders);
    let name = quoted(&material.name);
    format!(
        "        def Material \"look_{number}\" (
            displayName = {name}
        )
        {{
            token outputs:surface.connect = <{path}/surface.outputs:surface>

            def Shader \"surface\"
            {{
                uniform token info:id = \"UsdPreviewSurface\"
{inputs}                token outputs:surface
            }}
{shaders}        }}
"
    )
}

/// A material while it is written. Writing to its texts cannot fail.
struct Look<'a> {
    scene: &'a Scene,
    path: String,
    /// Lines of its surface.
    inputs: String,
    /// Shaders that read its textures.
    shaders: String,
    pictures: &'a mut BTreeMap<usize, Vec<u8>>,
}

/// What a texture's values are multiplied with, and what is added to them.
struct Range {
    scale: [f64; 4],
    bias: [f64; 4],
}

impl Range {
    fn scaled(scale: [f64; 4]) -> Self {
        Self {
            scale,
            bias: [0.0; 4],
        }
    }
}

impl Look<'_> {
    /// What the surface is made of.
    fn surface(&mut self, material: &Material) {
        let ([r, g, b], metallic) = material.base.color_and_metallic();
        let alpha = material.cutout.map_or(1.0, |it| it.alpha);
        match material.base_color_texture {
            Some(texture) => {
                self.texture("color", texture, Range::scaled([r, g, b, alpha]));
                self.connect("color3f", "diffuseColor", "color", "rgb");
            }
            None => self.input("color3f", "diffuseColor", triple([r, g, b])),
        }
        let roughness = material.base_roughness();
        match material.metallic_roughness_texture {
            Some(texture) => {
                self.texture(
                    "rough",
                    texture,
                    Range::scaled([1.0, roughness, metallic, 1.0]),
                );
                self.connect("float", "roughness", "rough", "g");
                self.connect("float", "metallic", "rough", "b");
            }
            None => {
                self.input("float", "roughness", roughness);
                self.input("float", "metallic", metallic);
            }
        }
        if let Some((texture, _)) = material.normal_texture {
            // Readers take these for normals of 8 bits, whatever their scale is.
            let range = Range {
                scale: [2.0, 2.0, 2.0, 1.0],
                bias: [-1.0, -1.0, -1.0, 0.0],
            };
            self.texture("bumps", texture, range);
            self.connect("normal3f", "normal", "bumps", "rgb");
        }
        if let Base::Dielectric { ior, .. } = material.base {
            self.input("float", "ior", ior);
        }
        if let Some(cutout) = &material.cutout {
            match material.base_color_texture {
                Some(_) => self.connect("float", "opacity", "color", "a"),
                None => self.input("float", "opacity", alpha),
            }
            if let AlphaRule::AtLeast(least) = cutout.rule {
                self.input("float", "opacityThreshold", least);
            }
        }
    }

    /// What lies over the surface, and what light it sends and gets.
    fn layers(&mut self, material: &Material) {
        if let Some(coat) = &material.coat {
            let [weight, roughness] = material.coat_textures;
            self.factor("clearcoat", coat.weight, weight, "r");
            self.factor("clearcoatRoughness", coat.roughness, roughness, "g");
        }
        let [r, g, b] = material.emission;
        match material.emission_texture {
            Some(texture) => {
                self.texture("glow", texture, Range::scaled([r, g, b, 1.0]));
                self.connect("color3f", "emissiveColor", "glow", "rgb");
            }
            None if [r, g, b] != [0.0; 3] => {
                self.input("color3f", "emissiveColor", triple([r, g, b]));
            }
            None => {}
        }
        if let Some((texture, strength)) = material.occlusion_texture {
            let range = Range {
                scale: [strength; 4],
                bias: [1.0 - strength; 4],
            };
            self.texture("occlusion", texture, range);
            self.connect("float", "occlusion", "occlusion", "r");
        }
    }

    /// A number, or a factor on a channel of a texture.
    fn factor(&mut self, name: &str, factor: f64, texture: Option<usize>, channel: &str) {
        match texture {
            Some(texture) => {
                self.texture(name, texture, Range::scaled([factor; 4]));
                self.connect("float", name, name, channel);
            }
            None => self.input("float", name, factor),
        }
    }

    fn input(&mut self, kind: &str, name: &str, value: impl Display) {
        let _ = writeln!(
            self.inputs,
            "                {kind} inputs:{name} = {value}"
        );
    }

    fn connect(&mut self, kind: &str, name: &str, shader: &str, output: &str) {
        let _ = writeln!(
            self.inputs,
            "                {kind} inputs:{name}.connect = <{}/{shader}.outputs:{output}>",
            self.path
        );
    }

    /// Adds the shaders that read a texture and its coordinates.
    fn texture(&mut self, name: &str, number: usize, range: Range) {
        let texture = &self.scene.textures[number];
        let are_normals = name == "bumps";
        let picture = self.pictures.entry(number);
        picture.or_insert_with(|| png(texture, are_normals));
        let file = picture_name(number);
        let set = UV_SETS[usize::from(texture.sampling.by_other_uvs)];
        let space = match texture.srgb {
            true => "sRGB",
            false => "raw",
        };
        let [s, t] = texture.sampling.wrap.map(|wrap| match wrap {
            Wrap::Repeat => "repeat",
            Wrap::Mirror => "mirror",
            Wrap::Clamp => "clamp",
        });
        let quadruple = |[r, g, b, a]: [f64; 4]| format!("({r}, {g}, {b}, {a})");
        let (scale, bias) = (quadruple(range.scale), quadruple(range.bias));
        let path = &self.path;
        let _ = writeln!(
            self.shaders,
            "
            def Shader \"{name}_place\"
            {{
                uniform token info:id = \"UsdPrimvarReader_float2\"
                string inputs:varname = \"{set}\"
                float2 outputs:result
            }}

            def Shader \"{name}\"
            {{
                uniform token info:id = \"UsdUVTexture\"
                asset inputs:file = @{file}@
                float2 inputs:st.connect = <{path}/{name}_place.outputs:result>
                token inputs:sourceColorSpace = \"{space}\"
                token inputs:wrapS = \"{s}\"
                token inputs:wrapT = \"{t}\"
                float4 inputs:scale = {scale}
                float4 inputs:bias = {bias}
                float outputs:r
                float outputs:g
                float outputs:b
                float outputs:a
                float3 outputs:rgb
            }}"
        );
    }
}

fn triple([r, g, b]: [f64; 3]) -> String {
    format!("({r}, {g}, {b})")
}
