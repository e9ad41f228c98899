# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels: of the render, of materials and of objects. Rows come from the table in `rows.py`."""

import bpy

from . import notes, rows

_ENGINE = "HAIRLINE"


class _Panel:
    bl_space_type, bl_region_type = "PROPERTIES", "WINDOW"
    COMPAT_ENGINES = {_ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine == _ENGINE and cls.owner_of(context) is not None


class HAIRLINE_PT_render(_Panel, bpy.types.Panel):
    bl_label, bl_context = "Hairline", "render"

    @staticmethod
    def owner_of(context):
        return context.scene

    def draw(self, context):
        settings = context.scene.hairline
        column = self.layout.column()
        column.use_property_split = True
        for name in ("backend", "samples", "viewport_samples", "shadows"):
            column.prop(settings, name)
        row = column.row()
        row.active = settings.shadows
        row.prop(settings, "bounces")
        column.prop(context.scene.render, "film_transparent", text="Transparent film")
        self._told(context.scene)

    def _told(self, scene):
        lines = notes.last(scene)
        if not lines:
            return
        box = self.layout.box()
        box.label(text="Not carried over in the last picture:", icon="INFO")
        for line in lines:
            column = box.column(align=True)
            column.scale_y = 0.8
            for part in _folded(line):
                column.label(text=part)


def _folded(line, width=60):
    """Splits a line: labels of Blender do not wrap."""
    parts = [""]
    for word in line.split():
        if len(parts[-1]) + len(word) > width:
            parts.append("   ")
        parts[-1] += (" " if parts[-1].strip() else "") + word
    return parts


class HAIRLINE_UL_items(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_name):
        layout.prop(item, "name", text="", emboss=False, icon="STROKE" if hasattr(item, "amount") else "OUTLINER_OB_LIGHTPROBE")
        layout.prop(item, "hidden", text="", emboss=False, icon="HIDE_ON" if item.hidden else "HIDE_OFF")


class _Surface(_Panel):
    """Scratches or gratings of an object or a material."""

    def draw(self, context):
        owner = self.owner_of(context)
        surface, name = owner.hairline, "object" if isinstance(owner, bpy.types.Object) else "material"
        layout = self.layout
        if self.kind == "scratches":
            layout.operator_menu_enum("hairline.wear", "wear", text="Wear", icon="BRUSH_DATA").owner = name
        list_name = "scratches" if self.kind == "scratches" else "gratings"
        row = layout.row()
        row.template_list("HAIRLINE_UL_items", f"{name} {list_name}", surface, list_name, surface, f"{list_name}_index", rows=3)
        side = row.column(align=True)
        add = "hairline.add_layer" if self.kind == "scratches" else "hairline.add_grating"
        side.operator_menu_enum(add, "preset", text="", icon="ADD").owner = name
        for operator, icon, settings in (
            ("hairline.remove", "REMOVE", {}),
            ("hairline.move", "TRIA_UP", {"step": -1}),
            ("hairline.move", "TRIA_DOWN", {"step": 1}),
        ):
            button = side.operator(operator, text="", icon=icon)
            for key, value in {"owner": name, "kind": self.kind, **settings}.items():
                setattr(button, key, value)
        items = getattr(surface, list_name)
        index = getattr(surface, f"{list_name}_index")
        if index < len(items):
            column = layout.column()
            column.use_property_split = True
            self.draw_rows(column, items[index], owner)

    def draw_common(self, column, item, owner):
        column.prop(item, "mask")
        if isinstance(owner, bpy.types.Object):
            column.prop_search(item, "vertex_group", owner, "vertex_groups")
        else:
            column.prop(item, "vertex_group", icon="GROUP_VERTEX")


class _Scratches(_Surface):
    bl_label = "Scratches"
    kind = "scratches"

    def draw_rows(self, column, layer, owner):
        column.prop(layer, "solo")
        column.prop(layer, "pattern")
        column.prop(layer, "profile")
        if layer.pattern == "drawn":
            column.prop(layer, "strokes")
            for row in rows.STROKES:
                column.prop(layer, row.attribute)
        else:
            column.prop(layer, "amount")
        unused = "density_per_m2" if layer.amount == "COUNT" else "count"
        for row in rows.rows_of("scratches", layer.pattern):
            if row.key != unused:
                column.prop(layer, row.attribute)
        column.separator()
        self.draw_common(column, layer, owner)
        column.prop(layer, "density_map")
        if layer.mask or layer.density_map:
            column.prop(layer, "is_tiled")
            if layer.is_tiled:
                column.prop(layer, "tile_m")
        column.prop(layer, "edges")
        if layer.edges > 0:
            column.prop(layer, "edge_width_m")


class _Gratings(_Surface):
    bl_label = "Gratings"
    bl_options = {"DEFAULT_CLOSED"}
    kind = "grating"

    def draw_rows(self, column, grating, owner):
        column.prop(grating, "pattern")
        if grating.pattern == "uv":
            column.prop(grating, "along")
        for row in rows.rows_of("grating", grating.pattern):
            column.prop(grating, row.attribute)
        column.prop(grating, "has_ring")
        if grating.has_ring:
            for row in rows.RING:
                column.prop(grating, row.attribute)
        column.separator()
        self.draw_common(column, grating, owner)


class _OfObject:
    bl_context = "object"

    @staticmethod
    def owner_of(context):
        return context.object if context.object and context.object.type in {"MESH", "CURVE", "SURFACE", "FONT", "META"} else None


class _OfMaterial:
    bl_context = "material"

    @staticmethod
    def owner_of(context):
        return context.material


class HAIRLINE_PT_material(_OfMaterial, _Panel, bpy.types.Panel):
    bl_label = "Hairline"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.material.hairline, "metal")


class HAIRLINE_PT_material_scratches(_OfMaterial, _Scratches, bpy.types.Panel):
    pass


class HAIRLINE_PT_material_gratings(_OfMaterial, _Gratings, bpy.types.Panel):
    pass


class HAIRLINE_PT_object_scratches(_OfObject, _Scratches, bpy.types.Panel):
    pass


class HAIRLINE_PT_object_gratings(_OfObject, _Gratings, bpy.types.Panel):
    pass


_CLASSES = (
    HAIRLINE_UL_items,
    HAIRLINE_PT_render,
    HAIRLINE_PT_material,
    HAIRLINE_PT_material_scratches,
    HAIRLINE_PT_material_gratings,
    HAIRLINE_PT_object_scratches,
    HAIRLINE_PT_object_gratings,
)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)


def unregister():
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
