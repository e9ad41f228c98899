# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: F12, animations, the command line, and the viewport's rendered view."""

import tempfile
from types import SimpleNamespace

import bpy

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
        view, corner = _wanted(camera.of_scene(scene, depsgraph, found), scene.render)
        with tempfile.TemporaryDirectory(prefix="hairline-") as path:
            folder = Folder(path, is_kept=False)
            self.update_stats("Hairline", "reading the scene")
            exported = export(scene, depsgraph, folder, view, found)
            self._told_of(exported)
            self._paint(scene, exported, folder, view.size_px, corner)

    def _told_of(self, exported):
        self.report({"INFO"}, f"Hairline: {exported.triangle_count:,} triangles")

    def _paint(self, scene, exported, folder, size_px, corner):
        made = rendering.scene_of(exported, folder)
        settings = scene.hairline
        result = self.begin_result(*corner, *size_px)

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

    # The viewport. Blender keeps one engine for each, with its attributes.

    def view_update(self, context, depsgraph):
        self._viewport().update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        self._viewport().draw(context, depsgraph)

    def _viewport(self):
        shown = getattr(self, "shown", None)
        if shown is None:
            shown = self.shown = viewport.Viewport(self)
            _viewports.add(shown)
        return shown

    def __del__(self):
        shown = getattr(self, "shown", None)
        if shown is not None:
            shown.close()
            _viewports.discard(shown)


# Open viewports. Their threads end when the add-on is switched off.
_viewports = set()


def _wanted(view, render):
    """The view of the render border, and its corner in the result."""
    if not render.use_border:
        return view, (0, 0)
    width, height = view.size_px
    left, right = round(render.border_min_x * width), round(render.border_max_x * width)
    low, high = round(render.border_min_y * height), round(render.border_max_y * height)
    part = view.part(left, low, max(right - left, 1), max(high - low, 1))
    return part, (0, 0) if render.use_crop_to_border else (left, low)


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
    for shown in list(_viewports):
        shown.close()
    _viewports.clear()
    bpy.utils.unregister_class(HairlineEngine)
