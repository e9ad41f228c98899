# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts curves and grease pencils to the points of strokes."""

from .frames import tidy


def points_m(source, item, depsgraph):
    """The strokes of a curve or a grease pencil, each a list of points in the frame of `item`."""
    evaluated = source.evaluated_get(depsgraph)
    to_item = item.matrix_world.inverted_safe() @ evaluated.matrix_world
    lines = _of_curve(evaluated) if source.type == "CURVE" else _of_pencil(evaluated)
    return [[tidy(list(to_item @ point)) for point in line] for line in lines if len(line)]


def _of_curve(evaluated):
    """Joins the edges of the evaluated curve to lines."""
    mesh = evaluated.to_mesh()
    try:
        if mesh is None:
            return []
        points = [vertex.co.copy() for vertex in mesh.vertices]
        edges = [tuple(edge.vertices) for edge in mesh.edges]
    finally:
        evaluated.to_mesh_clear()
    lines, line = [], []
    for start, end in edges:
        if line and line[-1] == start:
            line.append(end)
        else:
            line = [start, end]
            lines.append(line)
    return [[points[index] for index in line] for line in lines]


def _of_pencil(evaluated):
    lines = []
    for layer in evaluated.data.layers:
        frame = layer.current_frame() if hasattr(layer, "current_frame") else layer.active_frame
        if layer.hide or frame is None:
            continue
        for stroke in frame.drawing.strokes:
            lines.append([point.position.copy() for point in stroke.points])
    return lines
