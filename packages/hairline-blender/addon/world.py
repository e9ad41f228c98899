# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as an environment: a plain colour, or an equirectangular image."""

import math

import numpy as np

from . import images
from .frames import tidy
from .notes import Refused
from .picture_files import exr
from .sockets import Reader, Texture, as_number, as_rgb

# The centre of an equirectangular map is at +X in Blender, at +Y in Hairline.
_TURN_DEG = -90.0


def table(world, folder, is_seen, notes):
    """The table `[environment]` of a world; None if it is black. Writes files to `folder`."""
    if world is None:
        return None
    subject = f'world "{world.name}"'
    found = _background(world, subject, notes)
    if found is None:
        return None
    value, strength, turn_rad = found
    if strength <= 0:
        return None
    if isinstance(value, Texture):
        made = {"file": _map_file(value.image, folder, subject)}
    else:
        color = [max(x, 0.0) for x in as_rgb(value)]
        if max(color) == 0:
            return None
        made = {"file": folder.add(f"world {world.name}.exr", [exr(np.full((1, 2, 3), color, np.float32))])}
    visible = is_seen and getattr(world.cycles_visibility, "camera", True)
    made |= {"intensity": tidy(float(strength)), "rotation_deg": tidy(_TURN_DEG - math.degrees(turn_rad)), "visible": visible}
    return made


def _background(world, subject, notes):
    """Colour or Texture, strength, and the rotation of its mapping about Z."""
    reader = Reader(subject, notes)
    if not world.use_nodes or world.node_tree is None:
        return tuple(world.color), 1.0, 0.0
    output = world.node_tree.get_output_node("CYCLES")
    source = reader.source(output, "Surface") if output else None
    if output and reader.source(output, "Volume"):
        reader.tell("its volume is not carried over", "there is none")
    if source is None:
        return None
    node = source[0]
    if node.bl_idname != "ShaderNodeBackground":
        reader.tell(f'its shader "{node.name}" ({node.bl_label}) is not carried over; a Background is', "it is black")
        return None
    strength = reader.value(node, "Strength", 1.0)
    if isinstance(strength, Texture):
        reader.tell("an image of its strength is not carried over", "the socket's own value is taken")
        strength = reader.constant(node, "Strength")
    strength = as_number(strength)
    color = reader.source(node, "Color")
    if color is None or color[0].bl_idname != "ShaderNodeTexEnvironment":
        return reader.value(node, "Color"), strength, 0.0
    image_node = color[0]
    image = image_node.image
    if images.is_missing(image):
        name, path = (image.name, image.filepath) if image else (image_node.name, "none chosen")
        reader.tell(f'the file of its image "{name}" is missing ({path})', "magenta is taken, as Blender does")
        return (1.0, 0.0, 1.0), strength, 0.0
    if image_node.projection != "EQUIRECTANGULAR":
        reader.tell(f'its image "{image.name}" has the projection {image_node.projection}', "it is taken for equirectangular")
    if not images.is_understood(image):
        space = image.colorspace_settings.name
        reader.tell(f'its image "{image.name}" has the colour space {space}', "it is taken for linear Rec.709")
    return Texture(image, None), strength, _turn_rad(reader, image_node)


def _turn_rad(reader, node):
    source = reader.source(node, "Vector")
    if source is None:
        return 0.0
    other, _ = source
    if other.bl_idname == "ShaderNodeTexCoord":
        return 0.0
    if other.bl_idname != "ShaderNodeMapping":
        reader.tell(f'its image lies by the node "{other.name}" ({other.bl_label})', "it stands upright, not turned")
        return 0.0
    location, rotation, scale = (reader.constant(other, name) for name in ("Location", "Rotation", "Scale"))
    is_more = any(abs(x) > 1e-6 for x in (*location, *rotation[:2])) or any(abs(x - 1) > 1e-6 for x in scale)
    if is_more or any(other.inputs[name].is_linked for name in ("Location", "Rotation", "Scale")):
        reader.tell(f'the node "{other.name}" does more than turn about Z', "its turn about Z is taken alone")
    return -rotation[2] if other.vector_type == "TEXTURE" else rotation[2]


def _map_file(image, folder, subject):
    width, height = image.size
    if width != 2 * height:
        raise Refused(f'{subject}: found the image "{image.name}" of {width} x {height} pixels; an environment is twice as wide as high')
    path = images.path_of(image)
    if path and path.lower().endswith((".hdr", ".exr")):
        return folder.add_file(path)
    return folder.add(f"{image.name}.exr", [exr(images.linear(image)[..., :3].astype(np.float32))])
