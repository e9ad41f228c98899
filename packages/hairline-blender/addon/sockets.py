# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads shader sockets: constants, and images with their UV map and mapping."""

from dataclasses import dataclass

import math

from . import images


@dataclass(frozen=True)
class Lie:
    """UV map and mapping of an image."""

    uv_map: str
    """The name of the UV map; empty for the active one."""
    offset: tuple = (0.0, 0.0)
    rotation_rad: float = 0.0
    scale: tuple = (1.0, 1.0)

    def transform(self):
        """KHR_texture_transform, whose v axis points down; None for the identity."""
        if (self.offset, self.rotation_rad, self.scale) == ((0.0, 0.0), 0.0, (1.0, 1.0)):
            return None
        sine, cosine = math.sin(self.rotation_rad), math.cos(self.rotation_rad)
        (x, y), (sx, sy) = self.offset, self.scale
        return {"offset": [x - sy * sine, 1 - y - sy * cosine], "rotation": self.rotation_rad, "scale": [sx, sy]}


@dataclass(frozen=True)
class Texture:
    """An image with its mapping, and the channel that the socket uses."""

    image: object
    lie: Lie
    channel: str = "Color"
    """"Color", "Alpha", "Red", "Green" or "Blue"."""
    repeats: bool = True


class Reader:
    """Reads sockets of one owner's nodes. Unsupported links become notes."""

    def __init__(self, subject, notes):
        self.subject, self._notes = subject, notes

    def tell(self, what, instead):
        self._notes.add(self.subject, what, instead)

    def constant(self, node, name, default=None):
        """Unlinked value of a socket."""
        socket = node.inputs.get(name)
        if socket is None:
            return default
        value = socket.default_value
        return tuple(value) if hasattr(value, "__len__") else float(value)

    def number(self, node, name, default=0.0):
        """Unlinked value of a number; a link becomes a note."""
        if self.source(node, name):
            self._told(node, name, self.source(node, name)[0])
        return self.constant(node, name, default)

    def source(self, node, name):
        """Node and socket linked to an input, past reroutes; None if unlinked or muted."""
        socket = node.inputs.get(name)
        while socket is not None and socket.is_linked and not socket.links[0].is_muted:
            link = socket.links[0]
            if link.from_node.bl_idname != "NodeReroute":
                return link.from_node, link.from_socket
            socket = link.from_node.inputs[0]
        return None

    def value(self, node, name, default=None):
        """A constant or a Texture. Other links become notes, and the socket's unlinked value is used."""
        source = self.source(node, name)
        if source is None:
            return self.constant(node, name, default)
        other, socket = source
        constant = _constant_of(other)
        if constant is not None:
            return constant
        texture = self._texture(other, socket)
        if texture is None:
            self._told(node, name, other)
            return self.constant(node, name, default)
        return texture

    def _told(self, node, name, other):
        self.tell(f'"{name}" by the node "{other.name}" ({other.bl_label}) is not carried over', "the socket's own value is taken")

    def _texture(self, node, socket):
        channel = socket.name
        if node.bl_idname == "ShaderNodeSeparateColor":
            if node.mode != "RGB" or not (source := self.source(node, "Color")):
                return None
            node = source[0]
        if node.bl_idname != "ShaderNodeTexImage" or channel not in ("Color", "Alpha", "Red", "Green", "Blue"):
            return None
        image = node.image
        if image is None:
            self.tell(f'the image node "{node.name}" has no image', "black is taken, as Blender does")
            return (0.0, 0.0, 0.0, 1.0)
        if images.is_missing(image):
            self.tell(f'the file of the image "{image.name}" is missing ({image.filepath})', "magenta is taken, as Blender does")
            return (1.0, 0.0, 1.0, 1.0)
        if node.projection != "FLAT":
            self.tell(f'the image "{image.name}" has the projection {node.projection}', "it lies by the UV map")
        if node.extension not in ("REPEAT", "EXTEND"):
            self.tell(f'the image "{image.name}" has the extension {node.extension}', "it repeats")
        if not images.is_understood(image):
            space = image.colorspace_settings.name
            self.tell(f'the image "{image.name}" has the colour space {space}', "it is taken for linear Rec.709")
        return Texture(image, self._lie(node), channel, node.extension != "EXTEND")

    def _lie(self, node):
        source = self.source(node, "Vector")
        if source is None:
            return Lie("")
        other, socket = source
        if other.bl_idname == "ShaderNodeMapping":
            return self._mapped(other)
        return Lie(self._uv_map(other, socket))

    def _mapped(self, node):
        if node.vector_type not in ("POINT", "TEXTURE") or any(node.inputs[i].is_linked for i in (1, 2, 3) if len(node.inputs) > i):
            self.tell(f'the node "{node.name}" maps as {node.vector_type} or by other nodes', "the image lies as the UV map does")
            return Lie("")
        location, rotation, scale = (self.constant(node, name) for name in ("Location", "Rotation", "Scale"))
        if abs(rotation[0]) + abs(rotation[1]) > 1e-6 or node.vector_type == "TEXTURE":
            self.tell(f'the node "{node.name}" turns out of the image or maps as TEXTURE', "the image lies as the UV map does")
            return Lie("")
        source = self.source(node, "Vector")
        uv_map = self._uv_map(*source) if source else ""
        return Lie(uv_map, tuple(location[:2]), rotation[2], tuple(scale[:2]))

    def _uv_map(self, node, socket):
        if node.bl_idname == "ShaderNodeUVMap":
            return node.uv_map
        if node.bl_idname == "ShaderNodeTexCoord" and socket.name == "UV":
            return ""
        self.tell(f'an image lies by the node "{node.name}" ({socket.name})', "it lies by the active UV map")
        return ""


def _constant_of(node):
    """The value of a node that has no input."""
    if node.bl_idname == "ShaderNodeValue":
        return float(node.outputs[0].default_value)
    if node.bl_idname == "ShaderNodeRGB":
        return tuple(node.outputs[0].default_value)
    return None


def as_rgb(value):
    """Three numbers of a constant."""
    return (value,) * 3 if isinstance(value, float) else tuple(value[:3])


def as_number(value):
    """One number of a constant: the luminance of a colour, as in Blender."""
    return value if isinstance(value, float) else 0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2]
