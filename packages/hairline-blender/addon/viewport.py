# SPDX-License-Identifier: GPL-3.0-or-later
"""The viewport's rendered view: a thread renders, Blender's own thread draws the newest picture and never waits.

Only Blender's thread reads the scene and draws. The thread gets tables and files, and renders without the GIL.
"""

import tempfile
import threading
from types import SimpleNamespace

import hairline

from . import camera, notes, rendering
from .folder import Folder
from .scene_export import export

# Parts of a scene that may change, besides the camera.
_PARTS = ("environment", "studio", "materials", "objects", "scratches", "gratings", "lights", "settings")
# Steps of refinement: divisor of the size, and samples; None: the setting.
_STEPS = ((8, 1), (3, 1), (1, 1), (1, None))


class Painter:
    """Renders the newest request on a thread, coarse first. A newer request stops the current one."""

    def __init__(self, on_picture):
        self._on_picture = on_picture
        self._wish = threading.Condition()
        self._wanted = self._scene = self._table = None
        self._number = 0
        self._is_closed = False
        self._thread = threading.Thread(target=self._work, name="Hairline viewport", daemon=True)
        self._thread.start()

    def paint(self, scene, table, camera_table, size_px, settings, is_transparent):
        """Requests a picture. `scene` and `table` are None if only the view has changed."""
        with self._wish:
            self._number += 1
            if scene is None and self._wanted is not None:
                # The waiting request has a scene that the thread has not taken over yet.
                scene, table = self._wanted[1:3]
            self._wanted = (self._number, scene, table, camera_table, size_px, settings, is_transparent)
            self._wish.notify()

    def close(self):
        with self._wish:
            self._is_closed, self._wanted = True, None
            self._number += 1
            self._wish.notify()

    def wait(self, timeout_s):
        """Waits for the thread to end; False after the timeout."""
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _work(self):
        while True:
            with self._wish:
                while self._wanted is None and not self._is_closed:
                    self._wish.wait()
                if self._is_closed:
                    return
                wanted, self._wanted = self._wanted, None
            try:
                self._paint(*wanted)
            except rendering.Stopped:
                pass
            except notes.Refused as refusal:
                self._on_picture(None, str(refusal), wanted[4])
            except Exception as error:  # noqa: BLE001: the thread lives on, whatever it was.
                self._on_picture(None, f"a mistake of its own: {type(error).__name__}: {error}", wanted[4])

    def _paint(self, number, scene, table, camera_table, size_px, settings, is_transparent):
        if scene is not None:
            self._take_over(scene, table)
        self._scene.camera = hairline.Camera(**camera_table)

        def is_stopped():
            return self._number != number

        for coarse, samples in _STEPS:
            step_px = [max(n // coarse, 1) for n in size_px]
            chosen = SimpleNamespace(**{**vars(settings), "samples": samples or settings.samples})
            if coarse > 1:
                # Coarse pictures are for motion: shadows would slow them down.
                chosen.shadows = False
            picture = rendering.render(self._scene, self._table, chosen, is_transparent, lambda *_: None, is_stopped, lambda _: None, step_px)
            if is_stopped():
                return
            self._on_picture(picture, None, size_px)

    def _take_over(self, scene, table):
        """Copies changes into the one scene of the thread, which reuses unchanged parts."""
        self._table = table
        if self._scene is None:
            self._scene = scene
        for name in _PARTS:
            setattr(self._scene, name, getattr(scene, name))


class Viewport:
    """State of one viewport: exports on Blender's thread, renders on the Painter's."""

    def __init__(self, engine):
        self._engine = engine
        self._painter = Painter(self._take)
        self._folder = tempfile.TemporaryDirectory(prefix="hairline-")
        self._files = []
        # The last request: whether there was a scene, and the view.
        self._has_scene, self._seen = False, None
        # Newest result of the thread: pixels and their size, or a message.
        self._newest = self._texture = None
        self._lock = threading.Lock()

    def close(self):
        self._engine = None
        self._painter.close()
        # The thread may still read files; it stops within 0.1 s.
        if self._painter.wait(1.0):
            self._folder.cleanup()

    def update(self, context, depsgraph):
        """Exports the scene after a change."""
        found = notes.Notes()
        files = Folder(self._folder.name, is_kept=False, by_content=True)
        try:
            view = camera.of_viewport(context.region, context.region_data)
            exported = export(depsgraph.scene, depsgraph, files, view, found)
            scene = rendering.scene_of(exported, files)
        except notes.Refused as refusal:
            self._engine.update_stats("Hairline", str(refusal))
            return
        finally:
            notes.keep(depsgraph.scene, found)
        # The thread may still read files of the previous scenes.
        self._files = [*self._files[-2:], files.written]
        files.forget_all_but(self._files)
        self._seen = None
        self._has_scene = True
        self._look(depsgraph, view, scene, exported.table)

    def draw(self, context, depsgraph):
        """Draws the newest picture, and requests another if the view has moved."""
        if not self._has_scene:
            return
        try:
            self._look(depsgraph, camera.of_viewport(context.region, context.region_data))
        except notes.Refused as refusal:
            self._engine.update_stats("Hairline", str(refusal))
            return
        self._show(context, depsgraph.scene)

    def _look(self, depsgraph, view, scene=None, table=None):
        seen = (view.table(), tuple(view.size_px))
        if seen == self._seen:
            return
        self._seen = seen
        own = depsgraph.scene.hairline
        settings = SimpleNamespace(backend=own.backend, samples=own.viewport_samples, shadows=own.shadows, bounces=own.bounces)
        self._painter.paint(scene, table, *seen, settings, depsgraph.scene.render.film_transparent)

    def _take(self, picture, message, size_px):
        """Takes a result; runs on the thread."""
        pixels = rendering.pixels(picture, "Combined", picture.size) if picture else None
        with self._lock:
            self._newest = (pixels, picture.size if picture else None, message)
        engine = self._engine
        if engine is not None:
            engine.tag_redraw()

    def _show(self, context, scene):
        import gpu
        from gpu_extras.presets import draw_texture_2d

        with self._lock:
            newest, self._newest = self._newest, None
        if newest:
            pixels, size, message = newest
            self._engine.update_stats("Hairline", message or "")
            if pixels is not None:
                buffer = gpu.types.Buffer("FLOAT", pixels.size, pixels.ravel())
                self._texture = gpu.types.GPUTexture(size, format="RGBA16F", data=buffer)
        if self._texture is None:
            return
        gpu.state.blend_set("ALPHA_PREMULT")
        self._engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (0, 0), context.region.width, context.region.height)
        self._engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
