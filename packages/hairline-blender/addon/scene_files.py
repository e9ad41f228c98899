# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators for scene files: exports the scene with its models, imports layers onto objects by name."""

import os

import bpy
import hairline
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import camera, layers, notes, rendering
from .folder import Folder
from .scene_export import export


class HAIRLINE_OT_export(bpy.types.Operator, ExportHelper):
    """Write the scene with its models as a scene file of Hairline, for `hairline view` and `hairline render`"""

    bl_idname, bl_label = "hairline.export", "Export Hairline"
    filename_ext = ".toml"
    filter_glob: StringProperty(default="*.toml", options={"HIDDEN"})

    def execute(self, context):
        found = notes.Notes()
        scene = context.scene
        folder, name = os.path.split(os.path.abspath(self.filepath))
        try:
            depsgraph = context.evaluated_depsgraph_get()
            # The prefix keeps files of several scenes in one folder apart.
            files = Folder(folder, is_kept=True, prefix=f"{os.path.splitext(name)[0]} ")
            exported = export(scene, depsgraph, files, camera.of_scene(scene, depsgraph, found), found)
            exported.table["camera"]["exposure_ev"] = scene.view_settings.exposure
            rendering.scene_of(exported, files).save(self.filepath)
        except (notes.Refused, OSError) as error:
            self.report({"ERROR"}, f"Hairline: {error}")
            return {"CANCELLED"}
        for line in found:
            self.report({"WARNING"}, f"Hairline: {line}")
        self.report({"INFO"}, f"Hairline: {name} with {exported.triangle_count:,} triangles")
        return {"FINISHED"}


class HAIRLINE_OT_import(bpy.types.Operator, ImportHelper):
    """Lay the scratches and gratings of a scene file on the objects of the same names"""

    bl_idname, bl_label, bl_options = "hairline.import_layers", "Import layers of Hairline", {"REGISTER", "UNDO"}
    filename_ext = ".toml"
    filter_glob: StringProperty(default="*.toml", options={"HIDDEN"})

    def execute(self, context):
        try:
            scene = hairline.load(self.filepath)
        except (hairline.Error, OSError) as error:
            self.report({"ERROR"}, f"Hairline: {error}")
            return {"CANCELLED"}
        count, fresh = 0, set()
        for kind, name in (("scratches", "scratches"), ("grating", "gratings")):
            for one in getattr(scene, name):
                count += self._lay(context, kind, one.to_dict(), fresh)
        self.report({"INFO"}, f"Hairline: {count} layers and gratings imported")
        return {"FINISHED"}

    def _lay(self, context, kind, table, fresh):
        """Imports one layer or grating. The first one of an owner clears its list."""
        item = context.scene.objects.get(table["object"])
        owner = item
        if item is not None and table.get("material"):
            owner = next((slot.material for slot in item.material_slots if layers.material_name(slot.material) == table["material"]), None)
        if owner is None:
            what = f'material "{table["material"]}"' if item is not None else f'object "{table["object"]}"'
            self.report({"WARNING"}, f"Hairline: found no {what}; {kind} of it are not imported")
            return 0
        if table.get("pattern") in ("file", "drawn"):
            self.report({"WARNING"}, f'Hairline: object "{item.name}": {kind} of the pattern "{table["pattern"]}" are not imported')
            return 0
        items = getattr(owner.hairline, "gratings" if kind == "grating" else "scratches")
        if (owner, kind) not in fresh:
            items.clear()
            fresh.add((owner, kind))
        owner.update_tag()
        for line in layers.fill(items.add(), kind, table):
            self.report({"WARNING"}, f'Hairline: object "{item.name}", {kind} "{table.get("name", "")}": {line}')
        return 1


def _export_entry(menu, _context):
    menu.layout.operator(HAIRLINE_OT_export.bl_idname, text="Hairline scene (.toml)")


def _import_entry(menu, _context):
    menu.layout.operator(HAIRLINE_OT_import.bl_idname, text="Layers of a Hairline scene (.toml)")


def register():
    bpy.utils.register_class(HAIRLINE_OT_export)
    bpy.utils.register_class(HAIRLINE_OT_import)
    bpy.types.TOPBAR_MT_file_export.append(_export_entry)
    bpy.types.TOPBAR_MT_file_import.append(_import_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_import_entry)
    bpy.types.TOPBAR_MT_file_export.remove(_export_entry)
    bpy.utils.unregister_class(HAIRLINE_OT_import)
    bpy.utils.unregister_class(HAIRLINE_OT_export)
