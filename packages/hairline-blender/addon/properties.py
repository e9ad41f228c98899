# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties in the .blend: layers of scratches and gratings of objects and materials, and render settings."""

import bpy
import hairline
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, IntProperty, PointerProperty, StringProperty
from hairline import optics

from . import rows

# Options of properties that change the picture.
_CHANGES = {"override": {"LIBRARY_OVERRIDABLE"}, "update": rows.tag}


def _is_stroke_source(_, candidate):
    return candidate.type in {"CURVE", "GPENCIL", "GREASEPENCIL"}


def _title(key):
    return key.replace("_", " ").capitalize() if len(key) > 2 else key.upper()


def _choice(items, name, default=None):
    items = [(key, _title(key), text) for key, text in items.items()]
    return EnumProperty(items=items, name=name, default=default or items[0][0], **_CHANGES)


_COMMON = {
    "name": StringProperty(name="Name", default="scratches", **_CHANGES),
    "hidden": BoolProperty(name="Hidden", description="As if it were not there", **_CHANGES),
    "mask": PointerProperty(
        name="Mask",
        type=bpy.types.Image,
        update=rows.tag,
        description="Scratches lie where it is lighter than half of white; of a grating its values are factors on the coverage",
    ),
    "vertex_group": StringProperty(
        name="Vertex group", description="The weights of this group of the object say where it lies, and how thickly", **_CHANGES
    ),
}


def _group(name, kind, all_rows, doc, **others):
    """A PropertyGroup of rows and other properties."""
    annotations = {row.attribute: row.definition(rows.default_of(kind, row)) for row in all_rows}
    return type(name, (bpy.types.PropertyGroup,), {"__annotations__": {**annotations, **_COMMON, **others}, "__doc__": doc})


HairlineLayer = _group(
    "HairlineLayer",
    "scratches",
    rows.SCRATCHES + rows.PLACE + rows.STROKES,
    "A layer of scratches.",
    pattern=_choice(rows.PATTERNS, "Pattern"),
    profile=_choice(rows.PROFILES, "Profile"),
    amount=EnumProperty(
        name="How many",
        items=[
            ("COUNT", "In all", "A number of scratches, whatever the size of the object"),
            ("DENSITY", "Per area", "A number on each square metre"),
        ],
        **_CHANGES,
    ),
    solo=BoolProperty(name="Solo", description="If a layer is solo, only solo layers are seen", **_CHANGES),
    density_map=PointerProperty(
        name="Density", type=bpy.types.Image, update=rows.tag, description="A scratch is laid with the probability that the image has at its middle"
    ),
    is_tiled=BoolProperty(name="Tiled", description="Images are laid on from three sides and repeat, not by the UV map", **_CHANGES),
    strokes=PointerProperty(
        name="Strokes",
        type=bpy.types.Object,
        update=rows.tag,
        poll=_is_stroke_source,
        description="A curve or a grease pencil on the surface: scratches run along it",
    ),
)

HairlineGrating = _group(
    "HairlineGrating",
    "grating",
    rows.GRATING + rows.RING,
    "Grooves side by side, finer than a pixel.",
    pattern=_choice(rows.GRATING_PATTERNS, "Pattern"),
    has_ring=BoolProperty(name="Within radii", description="Grooves inside of a circle, outside of one, or in a ring", **_CHANGES),
    along=EnumProperty(name="Along", items=[("u", "U", "Along u"), ("v", "V", "Along v")], **_CHANGES),
)


def _list(kind):
    return CollectionProperty(type=kind, override={"LIBRARY_OVERRIDABLE", "USE_INSERTION"})


class HairlineSurface(bpy.types.PropertyGroup):
    """Scratches and gratings of an object or a material."""

    scratches: _list(HairlineLayer)
    scratches_index: IntProperty()
    gratings: _list(HairlineGrating)
    gratings_index: IntProperty()
    metal: EnumProperty(
        name="Measured metal",
        description="The measured refractive index of a metal in the place of the base colour",
        items=[("NONE", "None", "The base colour of the material")]
        + [(metal, _title(metal), f"Measured n and k of {metal}") for metal in optics.metals()],
        **_CHANGES,
    )


class HairlineSettings(bpy.types.PropertyGroup):
    """Render settings."""

    samples: IntProperty(
        name="Samples",
        description="Of each pixel that has an edge, a crease, a shadow or a blur in it",
        default=hairline.Scene.render.__kwdefaults__["samples"],
        min=1,
        max=1024,
    )
    shadows: BoolProperty(name="Shadows", description="Objects hide lights and the environment from one another", default=True)
    bounces: IntProperty(name="Bounces", description="Other objects that light may go by, with shadows", default=1, min=0, max=64, soft_max=4)
    backend: EnumProperty(
        name="Device",
        items=[
            ("auto", "Automatic", "A GPU if there is one, else the CPU"),
            ("gpu", "GPU", "A GPU, or none"),
            ("cpu", "CPU", "The CPU, in double precision"),
        ],
    )
    viewport_samples: IntProperty(name="Viewport samples", description="As Samples, of the viewport while it stands still", default=8, min=1, max=256)


_CLASSES = (HairlineLayer, HairlineGrating, HairlineSurface, HairlineSettings)


def register():
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    for owner in (bpy.types.Object, bpy.types.Material):
        owner.hairline = PointerProperty(type=HairlineSurface, override=_CHANGES["override"])
    bpy.types.Scene.hairline = PointerProperty(type=HairlineSettings, override=_CHANGES["override"])


def unregister():
    for owner in (bpy.types.Object, bpy.types.Material, bpy.types.Scene):
        del owner.hairline
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
