# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: F12, animations, the command line, and the viewport's rendered view."""

import tempfile
from types import SimpleNamespace

import bpy
import numpy as np

from . import camera, notes, rendering, viewport
from .folder import Folder
from .scene_export import export

# The first picture has a sixteenth of the pixels.
_COARSE = 4
_LEAST_COARSE_PX = 64


class HairlineEngine(bpy.types.RenderEngine):
    bl_idname = "HAIRLINE"
    bl_label = "Hairline"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if renderlayer.use_pass_z:
            self.register_pass(scene, renderlayer, "Depth", 1, "Z", "VALUE")
        if renderlayer.use_pass_normal:
            self.register_pass(scene, renderlayer, "Normal", 3, "XYZ", "VECTOR")
        for name, (channels, letters, kind, _) in rendering.AOVS.items():
            self.register_pass(scene, renderlayer, name, channels, letters, kind)

    def render(self, depsgraph):
        found = notes.Notes()
        try:
            self._render(depsgraph, found)
        except notes.Refused as refusal:
            self.report({"ERROR"}, f"Hairline: {refusal}")
        except rendering.Stopped:
            pass
        except Exception as error:  # noqa: BLE001: Blender goes on, whatever it was.
            self.report({"ERROR"}, f"Hairline: a mistake of its own: {type(error).__name__}: {error}")
            raise
        finally:
            for line in found:
                self.report({"WARNING"}, f"Hairline: {line}")
            notes.keep(depsgraph.scene, found)

    def _render(self, depsgraph, found):
        scene = depsgraph.scene
        view = _wanted(camera.of_scene(scene, depsgraph, found), scene.render)
        with tempfile.TemporaryDirectory(prefix="hairline-") as path:
            folder = Folder(path, is_kept=False)
            self.update_stats("Hairline", "reading the scene")
            exported = export(scene, depsgraph, folder, view, found)
            self._told_of(exported)
            self._paint(scene, exported, folder, view.size_px)

    def _told_of(self, exported):
        self.report({"INFO"}, f"Hairline: {exported.triangle_count:,} triangles")

    def _paint(self, scene, exported, folder, size_px):
        made = rendering.scene_of(exported, folder)
        settings = scene.hairline
        # With a border the result is the border alone; Blender puts it into the whole picture.
        result = self.begin_result(0, 0, *size_px)

        def show(picture, is_last):
            for one in result.layers[0].passes:
                if one.name in rendering.AOVS or one.name in ("Combined", "Depth", "Normal"):
                    one.rect = rendering.pixels(picture, one.name, size_px)
            if not is_last:
                self.update_result(result)

        def progress(what, share):
            self.update_stats("Hairline", f"{what} {100 * share:.0f} %")
            self.update_progress(share)

        def picture(samples, size):
            chosen = SimpleNamespace(backend=settings.backend, samples=samples, shadows=settings.shadows, bounces=settings.bounces)
            tell = lambda line: self.report({"INFO"}, f"Hairline: {line}")
            return rendering.render(made, exported.table, chosen, scene.render.film_transparent, progress, self.test_break, tell, size)

        is_whole = False
        try:
            if min(size_px) >= _COARSE * _LEAST_COARSE_PX and not bpy.app.background:
                show(picture(1, [n // _COARSE for n in size_px]), False)
            show(picture(settings.samples, None), True)
            is_whole = True
        finally:
            self.end_result(result, cancel=not is_whole, do_merge_results=is_whole)

    # The viewport. Blender keeps one engine for each.

    def view_update(self, context, depsgraph):
        self._viewport().update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        self._viewport().draw(context, depsgraph)

    def _viewport(self):
        shown = _viewports.get(id(self))
        if shown is None:
            shown = _viewports[id(self)] = viewport.Viewport(self)
        return shown

    def __del__(self):
        # Blender's part of the engine may be gone, and all attributes with it.
        shown = _viewports.pop(id(self), None)
        if shown is not None:
            shown.close()


# Open viewports by their engine. Their threads end with it, or when the add-on is switched off.
_viewports = {}


def _wanted(view, render):
    """The view of the render border: all of it without one."""
    if not render.use_border:
        return view
    width, height = view.size_px
    left, right = (_border_px(share, width) for share in (render.border_min_x, render.border_max_x))
    low, high = (_border_px(share, height) for share in (render.border_min_y, render.border_max_y))
    return view.part(left, low, right - left, high - low)


def _border_px(share, size_px):
    """Cut off in single precision, as Blender does: another size would not be its result's."""
    return int(np.float32(share) * np.float32(size_px))


# Panels of other engines whose settings Hairline reads.
_PANELS = (
    "RENDER_PT_format",
    "RENDER_PT_output",
    "DATA_PT_lens",
    "DATA_PT_camera",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "DATA_PT_light",
    "DATA_PT_EEVEE_light",
    "DATA_PT_area",
    "DATA_PT_spot",
    "WORLD_PT_context_world",
    "EEVEE_WORLD_PT_surface",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "VIEWLAYER_PT_layer_passes",
    "RENDER_PT_color_management",
)


def _panels():
    """The engine sets of the panels to show: those of every engine, and `_PANELS`."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and ("BLENDER_RENDER" in engines or panel.__name__ in _PANELS):
            yield engines


def register():
    bpy.utils.register_class(HairlineEngine)
    for engines in _panels():
        engines.add(HairlineEngine.bl_idname)


def unregister():
    for engines in _panels():
        engines.discard(HairlineEngine.bl_idname)
    for shown in _viewports.values():
        shown.close()
    _viewports.clear()
    bpy.utils.unregister_class(HairlineEngine)
