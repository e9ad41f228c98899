# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in Blender's radiometry: watts of points, spots and areas become radiance; the strength of suns is irradiance."""

import math

from mathutils import Vector

from .frames import tidy, unit_axes

# Scratches need lamps of a finite size.
LEAST_RADIUS_M = 1e-3
LEAST_SUN_DEG = 0.01
_CORNERS_OF_ELLIPSE = 64


def table(light_object, matrix, notes):
    """The table `[[light]]` of a light; None if it emits nothing."""
    light = light_object.data
    subject = f'light "{light_object.name}"'
    color, strength = _color_and_strength(light, subject, notes)
    if strength <= 0 or max(color) <= 0:
        return None
    if hasattr(light, "cycles") and getattr(light.cycles, "is_portal", False):
        notes.add(subject, "portals are not carried over", "it emits nothing")
        return None
    if not light.use_shadow:
        notes.add(subject, "its shadows are switched off", "it casts shadows")
    if light_object.light_linking.receiver_collection or light_object.light_linking.blocker_collection:
        notes.add(subject, "light linking is not carried over", "it lights all")
    made = _KINDS[light.type](light, matrix, strength, subject, notes)
    # Not visible: neither Cycles nor EEVEE shows the camera a lamp's shape.
    return {"name": light_object.name, "color": tidy(color), **made}


def _color_and_strength(light, subject, notes):
    color, strength = list(light.color), light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    if getattr(light, "use_temperature", False):
        color = [a * b for a, b in zip(color, light.temperature_color)]
    if light.use_nodes and light.node_tree:
        color, strength = _by_nodes(light, color, strength, subject, notes)
    if any(x < 0 for x in color) or strength < 0:
        notes.add(subject, "its power or colour is negative", "it emits nothing")
        strength = 0.0
    return [max(x, 0.0) for x in color], strength


def _by_nodes(light, color, strength, subject, notes):
    output = light.node_tree.get_output_node("CYCLES")
    links = output.inputs["Surface"].links if output else ()
    node = links[0].from_node if links else None
    if node is None or node.bl_idname != "ShaderNodeEmission":
        notes.add(subject, "its nodes are not carried over", "it is as without nodes")
        return color, strength
    if any(node.inputs[name].is_linked for name in ("Color", "Strength")):
        notes.add(subject, "what leads into its Emission node is not carried over", "the node's own values are taken")
    own = node.inputs["Color"].default_value
    return [a * b for a, b in zip(color, own)], strength * node.inputs["Strength"].default_value


def _radius_m(light):
    return max(light.shadow_soft_size, LEAST_RADIUS_M)


def _sphere(light, matrix, strength):
    # The power over 4 pi² r²: the area of a sphere, and pi for its cosine.
    radius_m = _radius_m(light)
    area_m2 = 4 * math.pi * radius_m**2 if light.normalize else 1.0
    return {
        "kind": "sphere",
        "center_m": tidy(list(matrix.translation)),
        "radius_m": tidy(radius_m),
        "radiance": tidy(strength / (math.pi * area_m2)),
    }


def _point(light, matrix, strength, subject, notes):
    return _sphere(light, matrix, strength)


def _spot(light, matrix, strength, subject, notes):
    position, _, _, back = unit_axes(matrix)
    if light.use_square:
        notes.add(subject, "its square cone is not carried over", "the cone is round")
    rim = math.cos(0.5 * light.spot_size)
    # Between rim and core Blender's smoothstep loses 1/2 of the light, the square of glTF 2/3. Over 3/4 of the width glTF loses as much.
    core = rim + 0.75 * light.spot_blend * (1 - rim)
    softness = 1 - math.acos(min(core, 1.0)) / (0.5 * light.spot_size)
    return {
        **_sphere(light, matrix, strength),
        "target_m": tidy(list(position - back)),
        "cone_deg": tidy(math.degrees(light.spot_size)),
        "cone_softness": tidy(min(max(softness, 0.0), 1.0)),
    }


def _sun(light, matrix, strength, subject, notes):
    _, _, _, back = unit_axes(matrix)
    angle_deg = min(max(math.degrees(light.angle), LEAST_SUN_DEG), 90.0)
    return {"kind": "sun", "direction": [float(-x) for x in back], "angle_deg": tidy(angle_deg), "irradiance": tidy(strength)}


def _area(light, matrix, strength, subject, notes):
    if light.spread < math.pi - 1e-3:
        notes.add(subject, f"its spread of {math.degrees(light.spread):.0f}° is not carried over", "it is 180°")
    width, height = light.size, light.size if light.shape in ("SQUARE", "DISK") else light.size_y
    if light.shape in ("SQUARE", "RECTANGLE"):
        corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)]
    else:
        n = _CORNERS_OF_ELLIPSE
        # The polygon has the area of the ellipse.
        radius = 0.5 * math.sqrt(2 * math.pi / (n * math.sin(2 * math.pi / n)))
        angles = [-2 * math.pi * i / n for i in range(n)]
        corners = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    corners = [(x * width, y * height) for x, y in corners]
    vertices_m = [matrix @ Vector((x, y, 0)) for x, y in corners]
    if matrix.determinant() < 0:
        vertices_m.reverse()
    area_m2 = _area_m2(vertices_m) if light.normalize else 1.0
    return {
        "kind": "polygon",
        "vertices_m": [[float(x) for x in vertex] for vertex in vertices_m],
        "radiance": tidy(strength / (math.pi * max(area_m2, 1e-10))),
    }


def _area_m2(vertices_m):
    first = vertices_m[0]
    sides = [vertex - first for vertex in vertices_m[1:]]
    whole = sum((a.cross(b) for a, b in zip(sides, sides[1:])), Vector())
    return 0.5 * whole.length


_KINDS = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}
