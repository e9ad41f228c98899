# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts the evaluated scene to the table of a scene file with glTF models beside it.

F12 and the export use the same table, so `hairline render` of the exported file makes the same picture.
"""

import itertools

import numpy as np
from mathutils import Vector

from . import layers, lights, world
from .frames import placing
from .glb import Glb
from .materials import Materials
from .meshes import triangles
from .notes import Refused
from .shaders import shader

_SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
_OTHERS = {
    "CURVES": "hair curves",
    "POINTCLOUD": "a point cloud",
    "VOLUME": "a volume",
    "GPENCIL": "a grease pencil",
    "GREASEPENCIL": "a grease pencil",
}


class Exported:
    """The scene's table, with the keys of scene files."""

    def __init__(self, table, triangle_count):
        self.table, self.triangle_count = table, triangle_count


def export(scene, depsgraph, folder, view, notes):
    """Converts the scene as seen by `view`, and writes its files to `folder`."""
    _tell_scene(scene, notes)
    objects = _Objects(folder, notes)
    made_lights, others, stroke_sources = [], {}, set()
    for instance in depsgraph.object_instances:
        item = instance.object
        if not instance.show_self:
            continue
        if item.type in _SURFACES:
            objects.add(instance)
            stroke_sources |= layers.stroke_sources(item)
        elif item.type == "LIGHT":
            made = lights.table(item, instance.matrix_world.copy(), notes)
            if made:
                made_lights.append(made)
        elif item.type in _OTHERS:
            others[item.original] = _OTHERS[item.type]
    for item, what in others.items():
        if item not in stroke_sources:
            notes.add(f'object "{item.name}"', f"{what} is not carried over", "it is not seen")
    table = {"camera": view.table(), "render": {"size_px": list(view.size_px)}}
    made_objects = objects.write(depsgraph)
    if not made_objects:
        notes.add(f'scene "{scene.name}"', "no object with a surface is shown to renders", "the world is seen alone")
        # A scene file has one object at least.
        made_objects = [{"name": "nothing", "shape": {"sphere": {"radius_m": 1.0}}, "material": "nothing", "hidden": True}]
        table["material"] = [{"name": "nothing", "kind": "mirror"}]
    table["object"] = made_objects
    for key, values in (("light", made_lights), ("scratches", objects.scratches), ("grating", objects.gratings)):
        if values:
            table[key] = values
    environment = world.table(scene.world, folder, not scene.render.film_transparent, notes)
    if environment:
        table["environment"] = environment
    if "light" not in table and "environment" not in table:
        # A scene file without lights would get a studio; Blender's scene is dark.
        table["studio"] = {"hidden": True}
    return Exported(table, objects.triangle_count)


def _tell_scene(scene, notes):
    subject = f'scene "{scene.name}"'
    if abs(scene.unit_settings.scale_length - 1) > 1e-6:
        notes.add(subject, f"its unit scale {scene.unit_settings.scale_length:.3g} is not carried over", "a unit is a metre")
    if scene.render.use_motion_blur:
        notes.add(subject, "motion blur is not carried over", "each frame is sharp")
    if scene.render.use_multiview:
        notes.add(subject, "several views are not carried over", "there is one picture")


# The range of coordinates in scene files.
_FARTHEST_M = 1000.0


def _refuse_far(surface, matrix, name):
    ends_m = surface.positions_m.min(axis=0), surface.positions_m.max(axis=0)
    corners = [matrix @ Vector(corner) for corner in itertools.product(*zip(*ends_m))]
    farthest_m = max(abs(x) for corner in corners for x in corner)
    if farthest_m > _FARTHEST_M:
        raise Refused(
            f'object "{name}": found a coordinate of {farthest_m:.5g} m; coordinates go to {_FARTHEST_M:.0f} m: move it nearer to the origin, or hide it'
        )


class _Objects:
    """Collects the surfaces of a scene: one model per mesh; one object per instance if it has scratches or gratings, else one for all instances."""

    def __init__(self, folder, notes):
        self._folder, self._notes = folder, notes
        # By object and mesh: the original object, triangles, materials, and the matrices of all instances.
        self._surfaces = {}
        self.scratches, self.gratings = [], []
        self.triangle_count = 0
        self._names = set()

    def add(self, instance):
        item = instance.object
        key = (item.original.as_pointer(), item.data.as_pointer() if item.data else 0)
        surface = self._surfaces.get(key)
        if surface is None:
            self._tell(item)
            made = triangles(item, self._notes)
            slots = [slot.material for slot in item.material_slots] or [None]
            surface = self._surfaces[key] = (item.original, made, slots, [])
        if surface[1] is not None:
            matrix = instance.matrix_world.copy()
            _refuse_far(surface[1], matrix, item.name)
            surface[3].append(matrix)

    def _tell(self, item):
        subject = f'object "{item.name}"'
        hidden = [name for name in ("camera", "diffuse", "glossy", "shadow") if not getattr(item, f"visible_{name}", True)]
        if hidden:
            self._notes.add(subject, f"it is hidden from {', '.join(hidden)} rays", "all rays see it")
        for flag, what in (("is_holdout", "a holdout"), ("is_shadow_catcher", "a shadow catcher")):
            if getattr(item, flag, False):
                self._notes.add(subject, f"it is {what}", "it is as any other")

    def write(self, depsgraph):
        """Writes the models. Returns the tables of objects, and fills `scratches` and `gratings`."""
        tables = []
        for item, made, slots, places in self._surfaces.values():
            if made is None or not len(made.corners):
                continue
            self.triangle_count += len(made.corners) * len(places)
            worn = layers.Worn(item, made, slots, depsgraph, self._folder, self._notes)
            placings = [placing(matrix) for matrix in places]
            if worn and None in placings:
                subject = f'object "{item.name}"'
                self._notes.add(subject, "its parents shear it", "its scratches and gratings lie by the axes of the world")
            loose = [matrix for matrix, placed in zip(places, placings) if not worn or placed is None]
            names = []
            if loose:
                # Matrices of glTF nodes may shear.
                tables.append({"name": self._name(item.name), **self._model(item, made, slots, worn, loose)})
                names.append(tables[-1]["name"])
            model = None
            for placed in placings if worn else ():
                if placed is not None:
                    model = model or self._model(item, made, slots, worn, None)
                    tables.append({"name": self._name(item.name), **model, **placed})
                    names.append(tables[-1]["name"])
            for name in names:
                self.scratches += worn.scratches(name)
                self.gratings += worn.gratings(name)
        return tables

    def _name(self, wanted):
        """A unique name."""
        name, number = wanted, 1
        while name in self._names:
            number += 1
            name = f"{wanted} ({number})"
        self._names.add(name)
        return name

    def _model(self, item, made, slots, worn, places):
        """Writes the model, with a node per matrix of `places`. Returns the keys `mesh`, `up` and `overrides`."""
        glb = Glb()
        active = worn.uv_maps
        materials = Materials(glb, active, item.name, self._notes)
        overrides = []
        mesh = {"name": item.name, "primitives": []}
        attributes = {
            "POSITION": glb.array(made.positions_m, with_bounds=True),
            "NORMAL": glb.array(made.normals),
        }
        for number, name in enumerate(active):
            attributes[f"TEXCOORD_{number}"] = glb.array(made.uvs[name])
        names = set()
        last = len(slots) - 1
        of_triangle = np.clip(made.slots, 0, last)
        for slot, material in enumerate(slots):
            chosen = made.corners if last == 0 else made.corners[of_triangle == slot]
            if not len(chosen):
                continue
            name = layers.material_name(material)
            if name in names:
                name = f"{name} (slot {slot + 1})"
            names.add(name)
            metal = layers.metal_of(material)
            number = materials.add(name, shader(material, self._notes), metal)
            if metal:
                overrides.append({"material": name, "metal": metal})
            mesh["primitives"].append({"attributes": attributes, "indices": glb.array(chosen.ravel()), "material": number})
        glb.add("meshes", mesh)
        for matrix in places or [None]:
            node = {"mesh": 0, "name": item.name}
            if matrix is not None:
                node["matrix"] = [float(x) for column in matrix.transposed() for x in column]
            glb.json["scenes"][0]["nodes"].append(glb.add("nodes", node))
        table = {"mesh": self._folder.add(f"{item.name}.glb", glb.parts()), "up": "z"}
        if overrides:
            table["overrides"] = overrides
        return table
