# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the shader nodes of materials: the Principled BSDF, and Diffuse, Glossy and Emission."""

from dataclasses import dataclass

from .sockets import Reader, Texture, as_rgb


@dataclass
class Shader:
    """Parameters of a surface. Values of type `object` are constants or Textures."""

    base_color: object = (0.8, 0.8, 0.8)
    metallic: object = 0.0
    roughness: object = 0.5
    alpha: object = 1.0
    ior: float = 1.5
    specular: float = 1.0
    """Factor on dielectric reflection at all angles."""
    specular_tint: tuple = (1.0, 1.0, 1.0)
    anisotropic: float = 0.0
    rotation_rad: float = 0.0
    coat: object = 0.0
    coat_roughness: object = 0.0
    emission: object = (0.0, 0.0, 0.0)
    emission_strength: float = 0.0
    normal: object = None
    """Texture of the normal map, or None."""
    normal_strength: float = 1.0


# Unsupported parts of the Principled BSDF, by the socket of their weight.
_NOT_CARRIED = {
    "Subsurface Weight": "subsurface scattering",
    "Transmission Weight": "transmission",
    "Sheen Weight": "sheen",
    "Thin Film Thickness": "thin film",
    "Diffuse Roughness": "diffuse roughness",
}


def shader(material, notes):
    """Reads a material; None gives Blender's default grey."""
    if material is None:
        return Shader(specular=0.0)
    reader = Reader(f'material "{material.name}"', notes)
    if not material.use_nodes or material.node_tree is None:
        metallic, roughness = float(material.metallic), float(material.roughness)
        return Shader(tuple(material.diffuse_color[:3]), metallic, roughness)
    output = material.node_tree.get_output_node("CYCLES")
    source = reader.source(output, "Surface") if output else None
    if output:
        for name in ("Volume", "Displacement"):
            if reader.source(output, name):
                reader.tell(f"its {name.lower()} is not carried over", "the surface has none")
    if source is None:
        reader.tell("no shader reaches its output", "black is taken")
        return Shader(base_color=(0.0, 0.0, 0.0), specular=0.0)
    node = source[0]
    read = _READ.get(node.bl_idname)
    if read is None:
        known = "Principled, Diffuse, Glossy and Emission BSDFs are"
        reader.tell(f'its shader "{node.name}" ({node.bl_label}) is not carried over; {known}', "its viewport colour is taken")
        return Shader(tuple(material.diffuse_color[:3]))
    return read(reader, node)


def _principled(reader, node):
    for name, what in _NOT_CARRIED.items():
        if reader.source(node, name) or (reader.constant(node, name) or 0.0) > 0.0:
            reader.tell(f"{what} is not carried over", "the surface has none")
    coat = reader.value(node, "Coat Weight", 0.0)
    if coat != 0.0:
        if abs(reader.number(node, "Coat IOR", 1.5) - 1.5) > 1e-3:
            reader.tell("the refractive index of its coat is not carried over", "it is 1.5")
        if reader.source(node, "Coat Tint") or as_rgb(reader.constant(node, "Coat Tint", 1.0)) != (1.0, 1.0, 1.0):
            reader.tell("the tint of its coat is not carried over", "the coat is clear")
        if reader.source(node, "Coat Normal"):
            reader.tell("the normals of its coat are not carried over", "the coat is smooth")
    anisotropic = reader.number(node, "Anisotropic")
    normal, strength = _normal(reader, node)
    tint = reader.value(node, "Specular Tint", (1.0, 1.0, 1.0))
    if isinstance(tint, Texture):
        reader.tell("an image of the specular tint is not carried over", "it is white")
        tint = (1.0, 1.0, 1.0)
    return Shader(
        base_color=reader.value(node, "Base Color"),
        metallic=reader.value(node, "Metallic"),
        roughness=reader.value(node, "Roughness"),
        alpha=reader.value(node, "Alpha", 1.0),
        ior=_index(reader, node),
        specular_tint=as_rgb(tint),
        anisotropic=anisotropic,
        rotation_rad=6.283185307179586 * reader.number(node, "Anisotropic Rotation") if anisotropic else 0.0,
        coat=coat,
        coat_roughness=reader.value(node, "Coat Roughness", 0.0),
        emission=reader.value(node, "Emission Color", (0.0, 0.0, 0.0)),
        emission_strength=reader.number(node, "Emission Strength"),
        normal=normal,
        normal_strength=strength,
    )


def _index(reader, node):
    """Refractive index after "Specular IOR Level", which scales the reflectance at normal incidence, as in Cycles."""
    ior = reader.number(node, "IOR", 1.5)
    level = reader.number(node, "Specular IOR Level", 0.5)
    if ior < 1.0:
        reader.tell(f"its refractive index {ior:.3g} is below 1", "its reciprocal is taken")
        ior = 1.0 / max(ior, 0.01)
    reflectance = min(((ior - 1) / (ior + 1)) ** 2 * 2 * level, 0.99)
    return (1 + reflectance**0.5) / (1 - reflectance**0.5)


def _normal(reader, node):
    source = reader.source(node, "Normal")
    if source is None:
        return None, 1.0
    other = source[0]
    if other.bl_idname != "ShaderNodeNormalMap" or other.space != "TANGENT":
        reader.tell(f'"Normal" by the node "{other.name}" ({other.bl_label}) is not carried over', "the mesh's normals are taken")
        return None, 1.0
    texture = reader.value(other, "Color")
    strength = reader.number(other, "Strength", 1.0)
    return (texture, strength) if isinstance(texture, Texture) and strength > 0 else (None, 1.0)


def _diffuse(reader, node):
    normal, strength = _normal(reader, node)
    if reader.source(node, "Roughness") or reader.constant(node, "Roughness") > 0:
        reader.tell("diffuse roughness is not carried over", "the surface has none")
    return Shader(reader.value(node, "Color"), specular=0.0, normal=normal, normal_strength=strength)


def _glossy(reader, node):
    normal, strength = _normal(reader, node)
    roughness = reader.value(node, "Roughness")
    if reader.source(node, "Anisotropy") or reader.constant(node, "Anisotropy", 0.0):
        reader.tell("the anisotropy of a Glossy BSDF is not carried over", "a Principled BSDF's is")
    return Shader(reader.value(node, "Color"), 1.0, roughness, normal=normal, normal_strength=strength)


def _emission(reader, node):
    color = reader.value(node, "Color")
    return Shader((0.0, 0.0, 0.0), specular=0.0, emission=color, emission_strength=reader.number(node, "Strength"))


_READ = {
    "ShaderNodeBsdfPrincipled": _principled,
    "ShaderNodeBsdfDiffuse": _diffuse,
    "ShaderNodeBsdfAnisotropic": _glossy,
    "ShaderNodeBsdfGlossy": _glossy,
    "ShaderNodeEmission": _emission,
}
