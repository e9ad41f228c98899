# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts shaders to glTF materials: metallic-roughness with the extensions that Hairline reads."""

import numpy as np

from . import images
from .picture_files import png
from .sockets import Texture, as_number, as_rgb


class Materials:
    """Writes shaders into a glTF file. `uv_maps` are those of its mesh, the active one first."""

    def __init__(self, glb, uv_maps, mesh_name, notes):
        self._glb, self._uv_maps, self._mesh_name, self._notes = glb, uv_maps, mesh_name, notes
        self._name = ""

    def add(self, name, shader, metal=None):
        """Adds a material and returns its index. `metal`: a measured metal that replaces the base colour."""
        self._name = name
        material = {"name": name, "pbrMetallicRoughness": {}, "extensions": {}}
        if metal:
            material["pbrMetallicRoughness"] = {"metallicFactor": 1.0}
        else:
            self._color(shader, material)
        self._roughness(shader, material, is_metal=bool(metal))
        self._specular(shader, material)
        self._coat(shader, material)
        self._emission(shader, material)
        if shader.normal:
            # Normal maps are data: no colour space applies.
            texture = self._texture(shader.normal, lambda: png(images.pixels(shader.normal.image)[..., :3]))
            material["normalTexture"] = {**texture, "scale": shader.normal_strength}
        return self._glb.add("materials", {key: value for key, value in material.items() if value})

    def _color(self, shader, material):
        color, alpha = shader.base_color, shader.alpha
        pbr = material["pbrMetallicRoughness"]
        factor = [1.0] * 3 if isinstance(color, Texture) else list(np.clip(as_rgb(color), 0, 1))
        opacity = 1.0 if isinstance(alpha, Texture) else min(max(as_number(alpha), 0.0), 1.0)
        pbr["baseColorFactor"] = [*map(float, factor), opacity]
        if isinstance(alpha, Texture) or opacity < 1:
            material["alphaMode"] = "BLEND"
        texture = color if isinstance(color, Texture) else alpha if isinstance(alpha, Texture) else None
        if texture is None:
            return

        def composed():
            values = np.ones((texture.image.size[1], texture.image.size[0], 4))
            if color is texture:
                values[..., :3] = images.srgb_of_linear(_channels(texture, 3))
            if isinstance(alpha, Texture):
                values[..., 3] = images.resized(_channels(alpha, 1), *values.shape[:2])
            return png(values)

        is_own_alpha = isinstance(alpha, Texture) and alpha.image == texture.image and alpha.channel == "Alpha"
        is_plain = color is texture and texture.channel == "Color" and images.is_srgb(texture.image) and (opacity == 1 or is_own_alpha)
        is_plain = is_plain and (is_own_alpha or not isinstance(alpha, Texture))
        if isinstance(alpha, Texture) and alpha.lie != texture.lie:
            self._tell("its alpha image has another mapping than its colour image", "the mapping of the colour is used")
        pbr["baseColorTexture"] = self._texture(texture, composed, is_plain)

    def _roughness(self, shader, material, is_metal):
        roughness, metallic = shader.roughness, 1.0 if is_metal else shader.metallic
        pbr = material["pbrMetallicRoughness"]
        values = {"roughnessFactor": roughness, "metallicFactor": metallic}
        for key, value in values.items():
            pbr[key] = 1.0 if isinstance(value, Texture) else min(max(as_number(value), 0.0), 1.0)
        if shader.anisotropic > 0:
            self._anisotropy(shader, material)
        texture = next((value for value in values.values() if isinstance(value, Texture)), None)
        if texture is None:
            return
        other = metallic if texture is roughness else None
        if isinstance(other, Texture) and other.lie != texture.lie:
            self._tell("its metallic image has another mapping than its roughness image", "the mapping of the roughness is used")

        def composed():
            height, width = texture.image.size[1], texture.image.size[0]
            packed = np.ones((height, width, 3))
            for channel, value in ((1, roughness), (2, metallic)):
                if isinstance(value, Texture):
                    packed[..., channel] = images.resized(_channels(value, 1), height, width)
            return png(packed)

        same = isinstance(other, Texture) and other.image == texture.image
        is_plain = same and (texture.channel, other.channel) == ("Green", "Blue") and images.is_data(texture.image)
        pbr["metallicRoughnessTexture"] = self._texture(texture, composed, is_plain)

    def _anisotropy(self, shader, material):
        """Blender stretches a facet by 1 / aspect along the tangent and shrinks it by aspect across; glTF only stretches it."""
        pbr = material["pbrMetallicRoughness"]
        aspect = (1 - 0.9 * min(shader.anisotropic, 1.0)) ** 0.5
        roughness = pbr["roughnessFactor"]
        if isinstance(shader.roughness, Texture):
            self._tell("its anisotropy is not combined with the image of its roughness", "the anisotropy is that of roughness 1")
        along, across = min(roughness**2 / aspect, 1.0), roughness**2 * aspect
        pbr["roughnessFactor"] = across**0.5
        strength = max((along - across) / max(1 - across, 1e-6), 0.0) ** 0.5
        material["extensions"]["KHR_materials_anisotropy"] = {
            "anisotropyStrength": min(strength, 1.0),
            "anisotropyRotation": shader.rotation_rad,
        }

    def _specular(self, shader, material):
        if shader.specular != 1.0 or shader.specular_tint != (1.0, 1.0, 1.0):
            material["extensions"]["KHR_materials_specular"] = {
                "specularFactor": shader.specular,
                "specularColorFactor": [min(max(x, 0.0), 1.0) for x in shader.specular_tint],
            }
        material["extensions"]["KHR_materials_ior"] = {"ior": shader.ior}

    def _coat(self, shader, material):
        if shader.coat == 0.0:
            return
        coat = {}
        for key, value, channel in (
            ("clearcoat", shader.coat, 0),
            ("clearcoatRoughness", shader.coat_roughness, 1),
        ):
            coat[f"{key}Factor"] = 1.0 if isinstance(value, Texture) else min(max(as_number(value), 0.0), 1.0)
            if isinstance(value, Texture):
                coat[f"{key}Texture"] = self._texture(value, lambda value=value, at=channel: _packed(value, at))
        material["extensions"]["KHR_materials_clearcoat"] = coat

    def _emission(self, shader, material):
        strength = max(shader.emission_strength, 0.0)
        if strength == 0:
            return
        emission = shader.emission
        if isinstance(emission, Texture):
            material["emissiveFactor"] = [1.0] * 3
            composed = lambda: png(images.srgb_of_linear(_channels(emission, 3)))
            is_plain = emission.channel == "Color" and images.is_srgb(emission.image)
            material["emissiveTexture"] = self._texture(emission, composed, is_plain)
        else:
            color = [max(x, 0.0) for x in as_rgb(emission)]
            strength *= max(color)
            if strength == 0:
                return
            material["emissiveFactor"] = [x / max(color) for x in color]
        material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        self._tell("its emission lights no other objects", "its glow is visible; add a light to light the others")

    def _texture(self, texture, composed, is_plain=False):
        """A material's reference to a texture: the image's own file if `is_plain`, else the PNG of `composed`."""
        data = (images.file_bytes(texture.image) if is_plain else None) or composed()
        used = {"index": self._glb.texture(data, texture.repeats), "texCoord": self._uv_set(texture.lie.uv_map)}
        transform = texture.lie.transform()
        if transform:
            used["extensions"] = {"KHR_texture_transform": transform}
        return used

    def _uv_set(self, name):
        if not self._uv_maps:
            self._notes.add(
                f'object "{self._mesh_name}"', "it has no UV map for the images of its material", "the corner pixel of each image covers it"
            )
            return 0
        if name and name not in self._uv_maps:
            self._notes.add(f'object "{self._mesh_name}"', f'it has no UV map "{name}"', "the active one is taken")
        return self._uv_maps.index(name) if name in self._uv_maps else 0

    def _tell(self, what, instead):
        self._notes.add(f'material "{self._name}"', what, instead)


def _channels(texture, count):
    """Linear pixels of a socket's channel, with three numbers or one."""
    values = images.linear(texture.image)
    at = {"Red": 0, "Green": 1, "Blue": 2, "Alpha": 3}.get(texture.channel)
    if at is not None:
        single = values[..., at]
        return np.repeat(single[..., None], 3, axis=2) if count == 3 else single
    return values[..., :3] if count == 3 else values[..., :3] @ np.array([0.2126, 0.7152, 0.0722], np.float32)


def _packed(texture, channel):
    single = _channels(texture, 1)
    packed = np.ones((*single.shape, 3))
    packed[..., channel] = single
    return png(packed)
