# SPDX-License-Identifier: GPL-3.0-or-later
"""The viewport's thread, without a window: what it is given and what it hands over. Drawing needs a window, and is not tested here."""

import time
from types import SimpleNamespace

import addon_under_test as addon
import bpy
import numpy as np
import stage
from mathutils import Matrix

SIZE_PX = (160, 96)


class Engine:
    """Stands for Blender's engine."""

    def __init__(self):
        self.redraws, self.lines = 0, []

    def tag_redraw(self):
        self.redraws += 1

    def update_stats(self, _, line):
        self.lines.append(line)


def context(view_matrix, lens_tan=0.36, shift=(0.0, 0.0)):
    """What a viewport sees: half its height is `lens_tan` at unit depth."""
    width, height = SIZE_PX
    window = Matrix.Identity(4)
    window[1][1], window[0][0] = 1 / lens_tan, height / width / lens_tan
    window[0][2], window[1][2] = shift
    region = SimpleNamespace(width=width, height=height)
    return SimpleNamespace(region=region, region_data=SimpleNamespace(is_perspective=True, window_matrix=window, view_matrix=view_matrix))


def newest(shown, timeout_s=20, full=True):
    """The last picture that the thread hands over while the view stands still."""
    end, last = time.monotonic() + timeout_s, None
    while time.monotonic() < end:
        with shown._lock:
            found, shown._newest = shown._newest, None
        if found:
            last = found
            if not full or found[1] == SIZE_PX:
                return found
        time.sleep(0.02)
    return last


def simple():
    scene = stage.empty(SIZE_PX)
    stage.plane(made_of=stage.material("floor"))
    stage.ball(made_of=stage.material("ball", metallic=1.0, roughness=0.3))
    stage.light("POINT", 300)
    return scene, stage.camera()


def viewport():
    engine = Engine()
    return engine, addon.viewport.Viewport(engine)


def test_a_viewport_through_the_camera_is_the_picture_of_f12():
    scene, camera = simple()
    scene.hairline.viewport_samples = scene.hairline.samples
    wanted = stage.picture("HAIRLINE")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    # A lens of 50 mm before 36 mm of sensor, which is as wide as the picture.
    tan = 18 / 50 * SIZE_PX[1] / SIZE_PX[0]
    engine, shown = viewport()
    try:
        shown.update(context(camera.matrix_world.inverted(), tan), depsgraph)
        newest(shown)
        pixels, size, message = newest(shown)
        assert message is None and size == SIZE_PX and engine.redraws >= 3
        # The last step has shadows and all samples.
        found = pixels.reshape(SIZE_PX[1], SIZE_PX[0], 4)[::-1]
        assert stage.apart(found[..., :3], wanted[..., :3])[1] < 0.02
    finally:
        shown.close()


def test_the_first_picture_of_a_moved_view_comes_while_nothing_waits():
    _, camera = simple()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    _, shown = viewport()
    try:
        view = camera.matrix_world.inverted()
        shown.update(context(view), depsgraph)
        newest(shown)
        waits, firsts = [], []
        for i in range(10):
            moved = view @ Matrix.Translation((0.02 * i, 0, 0))
            start = time.monotonic()
            shown._look(depsgraph, addon.camera.of_viewport(context(moved).region, context(moved).region_data))
            waits.append(time.monotonic() - start)
            newest(shown, full=False)
            firsts.append(time.monotonic() - start)
        print(f"the window waits {1e3 * max(waits):.1f} ms at most; the first picture comes after {1e3 * np.median(firsts):.0f} ms")
        assert max(waits) < 0.05 and np.median(firsts) < 0.5
    finally:
        shown.close()


def test_changes_come_through_and_the_thread_ends():
    scene, camera = simple()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    engine, shown = viewport()
    view = context(camera.matrix_world.inverted())
    shown.update(view, depsgraph)
    before = newest(shown)[0]
    bpy.data.objects["lamp"].data.energy *= 2
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown.update(view, depsgraph)
    after = newest(shown)[0]
    assert abs(after[:, :3].mean() / before[:, :3].mean() - 2) < 0.05
    # What is wrong is told, and does not end it.
    bpy.data.objects["ball"].location.x = 1e5
    shown.update(view, bpy.context.evaluated_depsgraph_get())
    assert 'object "ball": found a coordinate' in engine.lines[-1]
    shown.close()
    assert shown._painter.wait(5)
