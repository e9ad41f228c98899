# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts layers of scratches and gratings between properties of Blender and tables of scene files."""

import math

from . import images, rows, strokes, vertex_groups
from .picture_files import png


def material_name(material):
    """Name of a material in models. Linked materials get the name of their library, as names repeat between libraries."""
    if material is None:
        return "none"
    return f"{material.name} ({material.library.name})" if material.library else material.name


def metal_of(material):
    """The measured metal of a material; None where it keeps its base colour."""
    return material.hairline.metal if material is not None and material.hairline.metal != "NONE" else None


def stroke_sources(item):
    """Curves and grease pencils that layers of this object use."""
    surfaces = [item.hairline, *(slot.material.hairline for slot in item.material_slots if slot.material)]
    return {layer.strokes.original for surface in surfaces for layer in surface.scratches if layer.strokes is not None}


class Worn:
    """Layers and gratings of an evaluated object: its own, then those of its materials."""

    def __init__(self, item, surface, slots, depsgraph, folder, notes):
        evaluated = item.evaluated_get(depsgraph)
        self._evaluated, self._surface, self._depsgraph = evaluated, surface, depsgraph
        self._folder, self._notes = folder, notes
        mesh = evaluated.data
        active = getattr(getattr(mesh, "uv_layers", None), "active", None)
        active = next((layer.name for layer in getattr(mesh, "uv_layers", ()) if layer.active_render), active and active.name)
        others = [name for name in surface.uvs if name != active]
        self.uv_maps = [name for name in (active, *others) if name in surface.uvs]
        self._owners = [(evaluated.hairline, None)]
        known = []
        for material in slots:
            if material is not None and material not in known:
                known.append(material)
                self._owners.append((material.hairline, material_name(material)))
        self._is_alone = len(known) <= 1
        self._files = {}

    def __bool__(self):
        return any(len(owner.scratches) or len(owner.gratings) for owner, _ in self._owners)

    def scratches(self, object_name):
        """The tables of `[[scratches]]` of an object of the scene file."""
        tables = []
        for owner, material in self._owners:
            for layer in owner.scratches:
                table = self._layer(layer)
                if table is not None:
                    tables.append({"object": object_name, **table, **({"material": material} if material else {})})
        return tables

    def gratings(self, object_name):
        """The tables of `[[grating]]`."""
        tables = []
        for owner, material in self._owners:
            for grating in owner.gratings:
                if material and not self._is_alone:
                    what = f'the grating "{grating.name}" of its material "{material}" covers all of it'
                    self._notes.add(f'object "{self._evaluated.name}"', what, "a vertex group keeps it to a part")
                tables.append({"object": object_name, **self._grating(grating)})
        return tables

    def _layer(self, layer):
        table = {"name": layer.name, "pattern": layer.pattern}
        for flag in ("hidden", "solo"):
            if getattr(layer, flag):
                table[flag] = True
        if layer.profile != "rectangle":
            table["profile"] = layer.profile
        unused = "density_per_m2" if layer.amount == "COUNT" else "count"
        for row in rows.rows_of("scratches", layer.pattern):
            if row.key != unused:
                row.write(layer, table)
        where = self._where(layer)
        if where:
            table["where"] = where
        if layer.pattern == "drawn":
            drawn = strokes.points_m(layer.strokes, self._evaluated, self._depsgraph) if layer.strokes else []
            if not drawn:
                found = "has no strokes" if layer.strokes is None else f'"{layer.strokes.name}" has no points'
                self._tell(f'its drawn layer "{layer.name}" {found}', "nothing is laid: choose a curve or a grease pencil")
                return None
            table["strokes"] = [{"points_m": points} for points in drawn]
            for stroke in table["strokes"]:
                for row in rows.STROKES:
                    row.write(layer, stroke)
        return table

    def _where(self, layer):
        where = {}
        if layer.edges > 0:
            for row in rows.PLACE[:2]:
                row.write(layer, where_of := {})
                where |= where_of["where"]
        for key, image in (("mask", layer.mask), ("density", layer.density_map)):
            if image is not None and (name := self._picture(image)):
                where[key] = name
        if layer.vertex_group and (name := self._weights(layer.vertex_group)):
            if "density" in where:
                self._tell(f'the layer "{layer.name}" has a density image and a vertex group', "the vertex group is taken")
            where["density"] = name
            return where
        if layer.is_tiled and ("mask" in where or "density" in where):
            rows.PLACE[2].write(layer, where_of := {})
            where |= where_of["where"]
        return where

    def _grating(self, grating):
        table = {"name": grating.name, "pattern": grating.pattern}
        if grating.hidden:
            table["hidden"] = True
        for row in rows.rows_of("grating", grating.pattern):
            row.write(grating, table)
        # The pitch limits both; Blender has no such limit.
        for key in ("width_um", "jitter_um"):
            table[key] = min(table[key], table["pitch_um"])
        if grating.pattern == "uv":
            table["along"] = grating.along
        if grating.has_ring:
            for row in rows.RING:
                row.write(grating, table)
        mask = self._weights(grating.vertex_group) if grating.vertex_group else None
        if mask and grating.mask is not None:
            self._tell(f'the grating "{grating.name}" has a mask and a vertex group', "the vertex group is taken")
        if mask is None and grating.mask is not None:
            mask = self._picture(grating.mask)
        if mask:
            table["mask"] = mask
        return table

    def _picture(self, image):
        """Writes an image and returns its file; None if it is missing."""
        if images.is_missing(image):
            self._tell(f'the file of the image "{image.name}" is missing ({image.filepath})', "the layer lies everywhere")
            return None
        if image.name_full not in self._files:
            data = images.file_bytes(image) or png(images.pixels(image))
            ending = ".jpg" if data[:2] == b"\xff\xd8" else ".png"
            self._files[image.name_full] = self._folder.add(f"{image.name}{ending}", [data])
        return self._files[image.name_full]

    def _weights(self, name):
        """Writes the weights of a vertex group as a picture in the active UV map, and returns its file."""
        key = ("vertex group", name)
        if key in self._files:
            return self._files[key]
        group = self._evaluated.vertex_groups.get(name)
        if group is None or not self.uv_maps:
            what = f'it has no vertex group "{name}"' if group is None else f'its vertex group "{name}" needs a UV map, and it has none'
            self._tell(what, "the layer lies everywhere")
            self._files[key] = None
            return None
        picture = vertex_groups.picture(self._evaluated, group, self._surface, self.uv_maps[0])
        self._files[key] = self._folder.add(f"{self._evaluated.name} {name}.png", [png(picture)])
        return self._files[key]

    def _tell(self, what, instead):
        self._notes.add(f'object "{self._evaluated.name}"', what, instead)


def fill(group, kind, table):
    """Sets the properties of a layer or a grating from a table of a scene file. Returns a line for each key without a property."""
    left_out = []
    known = {"object", "name", "pattern", "hidden", "solo", "material"}
    table = dict(table)
    if isinstance(table.get("profile"), str) and hasattr(group, "profile"):
        # Depths of a file's own have no property.
        group.profile = table["profile"]
        known.add("profile")
    for key in ("name", "pattern", "hidden", "solo", "along"):
        if table.get(key) is not None and hasattr(group, key):
            try:
                setattr(group, key, table[key])
            except TypeError:
                return [f"the pattern {table[key]!r} is not imported"]
            known.add(key)
    all_rows = rows.GRATING + rows.RING if kind == "grating" else rows.SCRATCHES + rows.PLACE
    for row in all_rows:
        value = row.read(table)
        if value is not None:
            setattr(group, row.attribute, int(value) if row.attribute in ("count", "seed") else value)
            known.add(row.key)
    if kind == "grating":
        group.has_ring = table.get("radius_m") is not None
    else:
        group.amount = "DENSITY" if table.get("density_per_m2") is not None else "COUNT"
        where = set(table.get("where") or ()) - {"edges", "edge_width_m", "tile_m"}
        left_out += [f"`where.{key}` is not imported" for key in sorted(where)]
    return left_out + [f"`{key}` is not imported" for key in sorted(set(table) - known)]


def diagonal_m(item):
    """Diagonal of an object's box with its scale."""
    return math.dist((0, 0, 0), item.dimensions)
