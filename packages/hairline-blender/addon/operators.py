# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of the panels: add, remove and move layers and gratings, set the wear."""

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty
from hairline import editing

from . import layers, rows

KINDS = {"scratches": "scratches", "grating": "gratings"}


def _owner(context, name):
    """The object or the material whose lists are shown."""
    item = context.object
    if item is None:
        return None
    return item if name == "object" else item.active_material


def _presets(kind):
    """Enumeration items of the presets of a kind."""
    return [(preset.name, preset.name, preset.tooltip) for preset in editing.presets(kind)]


class _OnSurface:
    """Buttons of the lists of an object or a material."""

    owner: EnumProperty(items=[("object", "Object", ""), ("material", "Material", "")], options={"HIDDEN"})
    kind: EnumProperty(items=[("scratches", "Scratches", ""), ("grating", "Gratings", "")], options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return context.object is not None

    def surface(self, context):
        owner = _owner(context, self.owner)
        return owner.hairline if owner else None

    def items(self, context):
        """The owner's properties, the list, and the name of its index."""
        surface = self.surface(context)
        name = KINDS[self.kind]
        return surface, getattr(surface, name), f"{name}_index"


class _AddPreset(_OnSurface):
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        surface, items, index = self.items(context)
        size_m = layers.diagonal_m(context.object) or 1.0
        for made in editing.from_preset(self.kind, self.preset, "object", size_m):
            layers.fill(items.add(), self.kind, made.to_dict())
        if self.kind == "scratches":
            # Layers of different seeds are independent.
            items[-1].seed = len(items)
        setattr(surface, index, len(items) - 1)
        rows.tag(surface)
        return {"FINISHED"}


class HAIRLINE_OT_add_layer(_AddPreset, bpy.types.Operator):
    """Add a layer of scratches, sized by the object"""

    bl_idname, bl_label = "hairline.add_layer", "Add scratches"
    kind: StringProperty(default="scratches", options={"HIDDEN"})
    preset: EnumProperty(name="Preset", items=_presets("scratches"))


class HAIRLINE_OT_add_grating(_AddPreset, bpy.types.Operator):
    """Add a grating: grooves side by side, finer than a pixel"""

    bl_idname, bl_label = "hairline.add_grating", "Add grating"
    kind: StringProperty(default="grating", options={"HIDDEN"})
    preset: EnumProperty(name="Preset", items=_presets("grating"))


class HAIRLINE_OT_remove(_OnSurface, bpy.types.Operator):
    """Remove it from the list"""

    bl_idname, bl_label, bl_options = "hairline.remove", "Remove", {"REGISTER", "UNDO"}

    def execute(self, context):
        surface, items, index = self.items(context)
        at = getattr(surface, index)
        if at < len(items):
            items.remove(at)
            setattr(surface, index, max(at - 1, 0))
            rows.tag(surface)
        return {"FINISHED"}


class HAIRLINE_OT_move(_OnSurface, bpy.types.Operator):
    """Move it in the list"""

    bl_idname, bl_label, bl_options = "hairline.move", "Move", {"REGISTER", "UNDO"}
    step: IntProperty(options={"HIDDEN"})

    def execute(self, context):
        surface, items, index = self.items(context)
        at = getattr(surface, index)
        to = at + self.step
        if 0 <= to < len(items) and at < len(items):
            items.move(at, to)
            setattr(surface, index, to)
            rows.tag(surface)
        return {"FINISHED"}


class HAIRLINE_OT_wear(_OnSurface, bpy.types.Operator):
    """Give it a wear: its layers of wear are replaced, all others stay"""

    bl_idname, bl_label, bl_options = "hairline.wear", "Wear", {"REGISTER", "UNDO"}
    kind: StringProperty(default="scratches", options={"HIDDEN"})
    wear: EnumProperty(name="Wear", items=_presets("wear"))

    def execute(self, context):
        surface, items, index = self.items(context)
        for at in reversed(range(len(items))):
            if items[at].name.startswith(_WEAR):
                items.remove(at)
        size_m = layers.diagonal_m(context.object) or 1.0
        for made in editing.from_preset("wear", self.wear, "object", size_m):
            layers.fill(items.add(), "scratches", made.to_dict())
        setattr(surface, index, max(len(items) - 1, 0))
        rows.tag(surface)
        return {"FINISHED"}


# Prefix of the names of wear layers in the package.
_WEAR = "wear: "

_CLASSES = (HAIRLINE_OT_add_layer, HAIRLINE_OT_add_grating, HAIRLINE_OT_remove, HAIRLINE_OT_move, HAIRLINE_OT_wear)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)


def unregister():
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
