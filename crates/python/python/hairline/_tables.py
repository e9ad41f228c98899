"""The tables of a scene: the camera, lights, objects and so on, with the keys that scene files have.

A value is checked when it is set, by the code that reads scene files. ``None`` takes a key away.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, MutableSequence
from functools import lru_cache
from inspect import Parameter, Signature
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Optional, Sequence, TypeVar, Union, overload

from . import _hairline as core
from ._arrays import ArrayLike, floats, indices, per_scratch
from ._errors import SceneError, argument_error

if TYPE_CHECKING:
    from typing_extensions import Self, dataclass_transform
else:

    def dataclass_transform(**_: Any) -> Any:
        return lambda of: of


Vector = Union[Sequence[float], ArrayLike]
"""Three numbers. What is read back is a tuple."""
Sizes = Union[float, Mapping[str, float]]
"""A number, or ``{"mean": .., "spread": ..}``."""
Path = Union[str, "os.PathLike[str]"]

# Keys around a table while it is checked alone.
_FRAME: dict[str, Any] = {
    "camera": {"position_m": [0.0, 0.0, 1.0], "target_m": [0.0, 0.0, 0.0]},
    "object": [{"name": "object", "mesh": "object.glb"}],
}


def _default() -> Any:
    """Stands for a default, which the compiled part knows."""


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


@lru_cache(maxsize=1)
def _notes() -> dict[str, dict[str, str]]:
    """What is written below each key, of each class."""
    import ast

    notes: dict[str, dict[str, str]] = {}
    try:
        body = ast.parse(FilePath(__file__).read_text(encoding="utf-8")).body
    except OSError:  # pragma: no cover
        return notes
    for kind in body:
        if isinstance(kind, ast.ClassDef):
            for key, note in zip(kind.body, kind.body[1:]):
                if (
                    isinstance(key, ast.AnnAssign)
                    and isinstance(note, ast.Expr)
                    and isinstance(note.value, ast.Constant)
                ):
                    notes.setdefault(kind.name, {})[ast.unparse(key.target)] = str(note.value.value)
    return notes


class _Documented(type):
    """Tells the keys of a table where ``help`` and notebooks ask for its documentation."""

    @property
    def __doc__(cls) -> str:  # type: ignore[override]
        notes = [(key, note) for kind in cls.__mro__ for key, note in _notes().get(kind.__name__, {}).items()]
        lines = [str(cls.__dict__.get("__doc__") or "")]
        lines += [f"{key}\n    {note}" for key, note in notes]
        return "\n\n".join(lines)


@dataclass_transform(kw_only_default=True)
class Table(metaclass=_Documented):
    """A table of a scene. Its attributes are its keys."""

    _section: ClassVar[str]
    _is_one_of_many: ClassVar[bool] = True
    _fixed: ClassVar[dict[str, Any]] = {}
    # Defaults of keys that are left out because they go without saying.
    _absent: ClassVar[dict[str, Any]] = {}
    # Value of a table that is left out of a scene because it is empty.
    _nothing: ClassVar[dict[str, Any]] = {}
    _keys: ClassVar[frozenset[str]] = frozenset()
    __signature__: ClassVar[Signature] = Signature()

    def __init_subclass__(cls) -> None:
        own = [key for key in cls.__dict__.get("__annotations__", {}) if not key.startswith("_")]
        named = [Parameter(key, Parameter.KEYWORD_ONLY, default=None if key in cls.__dict__ else Parameter.empty) for key in own]
        cls.__signature__ = Signature([*named, *cls.__signature__.parameters.values()])
        for key in set(own) & set(cls.__dict__):
            delattr(cls, key)
        cls._keys = cls._keys | set(own)

    def __init__(self, *unnamed: Any, **keys: Any) -> None:
        name = type(self).__name__
        if unnamed:
            raise TypeError(f"{name} takes its keys by their names, as in {name}({next(iter(self.__signature__.parameters))}=...)")
        object.__setattr__(self, "_table", {})
        Table.update(self, **keys)

    @classmethod
    def _of(cls, table: Mapping[str, Any]) -> Self:
        """Of a table that was checked."""
        made = cls.__new__(cls)
        object.__setattr__(made, "_table", dict(table))
        return made

    def _put(self, table: dict[str, Any]) -> None:
        object.__setattr__(self, "_table", self._checked(table))

    def _checked(self, table: dict[str, Any]) -> dict[str, Any]:
        section = self._section
        try:
            whole = core.check({**_FRAME, section: [table] if self._is_one_of_many else table}, alone=True)
        except SceneError as error:
            # There is only one, and nobody has counted it.
            right = str(error).replace(f"{section}[0]", section)
            key = error.key.replace(f"{section}[0]", section)
            raise SceneError(right, key=key, found=error.found, right=error.right) from None
        checked: dict[str, Any] = whole[section][0] if self._is_one_of_many else whole.get(section, self._nothing)
        return checked

    def update(self, **keys: Any) -> None:
        """Sets several keys at once: those that only fit together."""
        for key, right in self._fixed.items():
            if keys.get(key, right) != right:
                raise argument_error(f"{self._section}.{key}", f"found {keys[key]!r}", f"a {type(self).__name__} has {right!r} always")
        self._put({**self._table, **keys, **self._fixed})

    def to_dict(self) -> dict[str, Any]:
        """A copy as a dict of plain values."""
        return dict(self._table)

    def __getattr__(self, key: str) -> Any:
        if key in self._keys:
            table: dict[str, Any] = self._table
            return _frozen(table[key]) if key in table else self._absent.get(key)
        raise AttributeError(f"{type(self).__name__} has no attribute {key!r}")

    def __setattr__(self, key: str, value: Any) -> None:
        self.update(**{key: value})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._section == other._section and self._table == other._table

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        keys = ", ".join(f"{key}={_frozen(value)!r}" for key, value in self._table.items())
        return f"{type(self).__name__}({keys})"

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self._keys]

    # Without these `__getattr__` would be asked for them before there is a table.
    def __getstate__(self) -> dict[str, Any]:
        return self._table  # type: ignore[no-any-return]

    def __setstate__(self, table: dict[str, Any]) -> None:
        object.__setattr__(self, "_table", table)


class Camera(Table):
    """``[camera]``: a pinhole, or a thin lens."""

    _section = "camera"
    _is_one_of_many = False

    position_m: Vector
    """The pinhole, metres, 3 numbers."""
    target_m: Vector
    """The point in the centre of the picture, metres, 3 numbers."""
    up: Vector = _default()
    """The direction that is up in the picture, 3 numbers. Default: +y."""
    fov_y_deg: Optional[float] = _default()
    """Vertical field of view, degrees. Default: 30. None where ``focal_length_mm`` tells it."""
    focal_length_mm: Optional[float] = _default()
    """The field of view by a lens, millimetres. Set it, and ``fov_y_deg`` goes; and the other way round."""
    sensor_width_mm: Optional[float] = _default()
    """How wide the picture is on the sensor, millimetres: what focal lengths and f-stops count by. Default: 36."""
    exposure_ev: float = _default()
    """Stops: radiances are multiplied by 2^exposure_ev before the tone curve. Default: 0."""
    aperture_mm: Optional[float] = _default()
    """Diameter of the lens's opening, millimetres. Default: a pinhole, everything is in focus."""
    f_stop: Optional[float] = _default()
    """``focal_length_mm`` over the opening. Set it, and ``aperture_mm`` goes; and the other way round."""
    focus_distance_m: Optional[float] = _default()
    """With an opening: the distance of what is in focus along the view, metres. Default: that of the target."""
    shift: Optional[Vector] = _default()
    """How far the picture is moved across what the lens shows, to the right and up, in heights of the picture, 2 numbers. Default: 0."""
    world_up: Optional[str] = _default()
    """The axis of the world that points up, ``"y"`` or ``"z"``, for cameras that are rolled or look down. Default: the one nearest to ``up``."""
    of_file: Optional[str] = _default()
    """A camera of a model's file in the place of this one: its name, its node's, or its number. Default: none."""

    def update(self, **keys: Any) -> None:
        if keys.get("fov_y_deg") is not None:
            keys = {"focal_length_mm": None, **keys}
        elif keys.get("focal_length_mm") is not None:
            keys = {"fov_y_deg": None, **keys}
        if keys.get("aperture_mm") is not None:
            keys = {"f_stop": None, **keys}
        elif keys.get("f_stop") is not None:
            keys = {"aperture_mm": None, **keys}
        super().update(**keys)

    def _checked(self, table: dict[str, Any]) -> dict[str, Any]:
        checked = super()._checked(table)
        words_of_photographers = ("focal_length_mm", "sensor_width_mm", "f_stop")
        lens = {key: table[key] for key in words_of_photographers if table.get(key) is not None}
        if "f_stop" in lens:
            # The sensor agrees with the aperture, if that is given.
            del checked["aperture_mm"]
        if "focal_length_mm" in lens:
            if table.get("fov_y_deg") is not None:
                found = f"found {table['fov_y_deg']} beside focal_length_mm"
                raise argument_error("camera.fov_y_deg", found, "leave out one of them")
            # The field of view depends on the shape of the picture, which a scene knows.
            del checked["fov_y_deg"]
            checked.update((key, float(value)) for key, value in lens.items())
        return checked


class Settings(Table):
    """``[render]``: how the picture is sampled and shown."""

    _section = "render"
    _is_one_of_many = False

    size_px: Sequence[int] = _default()
    """Width and height, pixels. Default: 1280 x 720."""
    filter_std_px: float = _default()
    """Standard deviation of the pixel's Gaussian filter, pixels. Default: 0.5."""
    tone_map: str = _default()
    """``"neutral"`` (default), ``"agx"``, ``"aces"`` or ``"none"``."""


class Environment(Table):
    """``[environment]``: light from all around. Either ``file`` or ``builtin``."""

    _section = "environment"
    _is_one_of_many = False

    file: Optional[Path] = _default()
    """An equirectangular .hdr or .exr, relative to the scene file."""
    builtin: Optional[str] = _default()
    """``"studio"``, ``"window"`` or ``"overcast"``."""
    rotation_deg: float = _default()
    """Turns it about the world's up axis, degrees. Default: 0."""
    intensity: float = _default()
    """Factor on its radiance. Default: 1."""
    visible: bool = _default()
    """Whether the camera sees it behind the objects. Default: True."""


class Studio(Table):
    """``[studio]``: soft boxes, a lamp and a dim room around the objects. A scene without lights and environment has one, on a
    :class:`Ground`; ``Studio(hidden=True)`` leaves it in the dark."""

    _section = "studio"
    _is_one_of_many = False
    _absent = {"hidden": False, "intensity": 1.0, "rotation_deg": 0.0}
    _nothing = {"hidden": True}

    hidden: bool = _default()
    """Lights nothing. Default: False."""
    intensity: float = _default()
    """Factor on its radiances. Default: 1."""
    rotation_deg: float = _default()
    """Turns it about the world's up axis, degrees. Default: 0."""


class Ground(Table):
    """``[ground]``: a wide floor under all objects."""

    _section = "ground"
    _is_one_of_many = False
    _absent = {"hidden": False, "color": (0.1, 0.1, 0.105), "roughness": 0.55}

    hidden: bool = _default()
    """As if it were not there. Default: False."""
    color: Vector = _default()
    """Albedo, linear Rec.709, 3 numbers from 0 to 1. Default: a dark grey."""
    roughness: float = _default()
    """As that of a material. Default: 0.55."""
    height_m: Optional[float] = _default()
    """Where it lies along the world's up axis, metres. Default: under the lowest point of all objects."""


class Material(Table):
    """``[[material]]``"""

    _section = "material"

    name: str
    """What objects call it by."""
    kind: str
    """``"metal"`` (with ``metal`` or ``base_color``), ``"dielectric"``, ``"metallic-roughness"`` or ``"mirror"``."""
    metal: Optional[str] = _default()
    """A metal whose n and k were measured: see :func:`hairline.optics.metals`."""
    base_color: Optional[Vector] = _default()
    """Linear Rec.709, 3 numbers from 0 to 1."""
    ior: Optional[float] = _default()
    """Refractive index of a dielectric, from 1 to 4. Default: 1.5."""
    metallic: Optional[float] = _default()
    """From 0, dielectric, to 1, metal. Default: 1."""
    specular: Optional[float] = _default()
    """Of ``"metallic-roughness"``, as far as it is no metal: how much of its reflections it keeps, from 0 to 1. Default: 1."""
    specular_color: Optional[Vector] = _default()
    """The colour of these straight on, linear Rec.709, 3 numbers from 0 to 1. Default: white."""
    roughness: float = _default()
    """Perceptual, as in glTF, from 0 to 1. Default: 0.1."""
    clearcoat: Optional[float] = _default()
    """The share of the surface that a clear layer covers, in which scratches lie, from 0 to 1. Default: none."""
    clearcoat_roughness: Optional[float] = _default()
    """With ``clearcoat``: as ``roughness``, of the layer. Default: 0."""
    anisotropy: Optional[float] = _default()
    """How far highlights are drawn out one way, as on brushed metal, from 0 to 1. Default: none."""
    anisotropy_direction_deg: Optional[float] = _default()
    """With ``anisotropy``: which way, counter-clockwise from where u of the texture coordinates rises. Default: 0."""
    coherence_um: float = _default()
    """Standard deviation of the coherence window, micrometres. Default: 20."""


class Object(Table):
    """``[[object]]``: a ``shape`` or a ``mesh``. See :meth:`from_arrays` for meshes from numpy."""

    _section = "object"
    _absent = {"up": "y", "overrides": (), "hidden": False}

    name: str
    """What layers of scratches call it by."""
    shape: Optional[Mapping[str, Mapping[str, Any]]] = _default()
    """``{"disk": {"radius_m": 0.1}}``; also ``plane``, ``sphere``, ``box``, ``cylinder``, ``torus``, ``dome``, ``sweep``, ``text`` and ``lathe``. z is up."""
    mesh: Optional[Union[Path, core.MeshArray]] = _default()
    """A .glb or .gltf, relative to the scene file."""
    material: Optional[str] = _default()
    """The name of a material. A file that is not given one keeps its own."""
    up: Optional[str] = _default()
    """Which axis of a mesh's file points up, ``"y"`` (default) or ``"z"``."""
    fit_m: Optional[float] = _default()
    """The largest extent of a mesh's file, metres; it is scaled to that."""
    time_s: Optional[float] = _default()
    """The time of an animation of a mesh, seconds. Without it the model is at rest."""
    animation: Optional[str] = _default()
    """With ``time_s``: the name of the animation, or its number from 0. Default: the first one."""
    overrides: Sequence[Mapping[str, Any]] = _default()
    """Other factors for materials of a mesh's file, whose maps stay: ``material`` with ``roughness``, ``metallic`` and ``base_color`` or ``metal``, the name of a measured metal."""
    translation_m: Vector = _default()
    """Metres, 3 numbers. Default: 0."""
    rotation_deg: Vector = _default()
    """About the world's x axis, then y, then z, degrees, 3 numbers. Default: 0."""
    scale: Union[float, Vector] = _default()
    """Factors along the object's own axes, one number or 3. Default: 1."""
    hidden: bool = _default()
    """As if the object were not there, nor what lies on it."""

    @classmethod
    def from_arrays(
        cls,
        *,
        name: str,
        vertices_m: ArrayLike,
        triangles: ArrayLike,
        material: str,
        normals: Optional[ArrayLike] = None,
        uvs: Optional[ArrayLike] = None,
        translation_m: Optional[Vector] = None,
        rotation_deg: Optional[Vector] = None,
        scale: Optional[Union[float, Vector]] = None,
    ) -> Self:
        """A mesh in memory.

        :param vertices_m: float, n x 3, metres in the object's own frame.
        :param triangles: int, m x 3, indices of vertices, counter-clockwise seen from outside.
        :param normals: float, n x 3. Without them each triangle is flat.
        :param uvs: float, n x 2.
        """
        mesh = core.MeshArray(
            floats("vertices_m", vertices_m, None, 3),
            indices("triangles", triangles, None, 3),
            None if normals is None else floats("normals", normals, None, 3),
            None if uvs is None else floats("uvs", uvs, None, 2),
        )
        placing: dict[str, Any] = {"translation_m": translation_m, "rotation_deg": rotation_deg, "scale": scale}
        return cls(name=name, mesh=mesh, material=material, **placing)

    def _checked(self, table: dict[str, Any]) -> dict[str, Any]:
        if not isinstance(table.get("mesh", ""), (str, os.PathLike, core.MeshArray, type(None))):
            found = f"found an object of type {type(table['mesh']).__module__}.{type(table['mesh']).__qualname__}"
            raise argument_error("object.mesh", found, "must be the path of a file; arrays go by hairline.Object.from_arrays")
        if isinstance(table.get("mesh"), core.MeshArray):
            for key in ("up", "fit_m", "time_s", "animation", "overrides"):
                if table.get(key) is not None:
                    raise argument_error(f"object.{key}", "a mesh in memory has no such key", "it belongs to a file")
        return super()._checked(table)


class Scratches(Table):
    """``[[scratches]]``: a layer on one object. See :meth:`from_arrays` for scratches from numpy."""

    _section = "scratches"
    _absent = {"hidden": False, "solo": False, "strokes": ()}

    object: str
    """The name of the object that they lie on."""
    material: Optional[str] = _default()
    """The name of a material of the object's file: they lie on what is of it. Default: on all of the object."""
    node: Optional[str] = _default()
    """The name of a node of the object's file: they lie on it and on what is below it. Default: on all of the object."""
    where: Optional[Mapping[str, Any]] = _default()
    """On which places they lie, and how thickly: ``mask``, ``density``, ``tile_m``, ``edges``, ``edge_width_m``, ``radius_m``, ``center_m``."""
    pattern: str
    """``"random"``, ``"parallel"``, ``"circular"``, ``"radial"``, ``"spun"``, ``"swirl"``, ``"drawn"`` or ``"file"``."""
    name: Optional[str] = _default()
    """Free text."""
    hidden: bool = _default()
    """Laid nowhere. Default: False."""
    solo: bool = _default()
    """Where any layer is solo, only those are laid. Default: False."""
    count: Optional[int] = _default()
    """How many scratches; or ``density_per_m2``."""
    density_per_m2: Optional[float] = _default()
    """Scratches per square metre of the object; or ``count``."""
    seed: Optional[int] = _default()
    """The same seed gives the same scratches. Default: 1."""
    length_m: Optional[Sizes] = _default()
    """Log-normal, metres. Default: mean 0.02, spread 0.5."""
    width_um: Optional[Sizes] = _default()
    """Log-normal, micrometres. Default: mean 1.5, spread 0.3."""
    depth_nm: Optional[Sizes] = _default()
    """Log-normal, nanometres. Default: mean 200, spread 0.2."""
    curvature_per_m: Optional[Sizes] = _default()
    """Normal, per metre; for random, spun and swirl."""
    direction: Optional[Vector] = _default()
    """Of parallel scratches, 3 numbers. Default: +x."""
    axis: Optional[Vector] = _default()
    """Of circular, radial and spun scratches, 3 numbers. Default: +z."""
    center_m: Optional[Vector] = _default()
    """A point on the axis, metres, 3 numbers. Default: 0."""
    jitter_deg: Optional[float] = _default()
    """Standard deviation of the angle to the pattern, degrees. Default: 0."""
    strokes: Sequence[Mapping[str, Any]] = _default()
    """What a brush did."""
    file: Optional[Union[Path, core.ScratchArray]] = _default()
    """A CSV file of scratches, relative to the scene file."""

    @classmethod
    def from_arrays(
        cls,
        *,
        object: str,
        ends_m: ArrayLike,
        width_um: ArrayLike,
        depth_nm: ArrayLike,
        name: Optional[str] = None,
    ) -> Self:
        """Straight scratches in memory.

        :param ends_m: float, n x 2 x 3: both ends of each, metres in the object's own frame, on its surface.
        :param width_um: float, n, or one number for all: from 0.05 to 100 micrometres.
        :param depth_nm: float, n, or one number for all: from 0 to 2000 nanometres.
        """
        array = core.ScratchArray(
            floats("ends_m", ends_m, None, 2, 3),
            per_scratch("width_um", width_um),
            per_scratch("depth_nm", depth_nm),
        )
        return cls(object=object, pattern="file", file=array, name=name)


class Grating(Table):
    """``[[grating]]``: grooves side by side, finer than a pixel, that cover an object."""

    _section = "grating"
    _absent = {"hidden": False}

    object: str
    """The name of the object that they cover."""
    pattern: str
    """``"parallel"``, ``"circular"``, ``"radial"``, ``"spun"``, ``"swirl"`` or ``"uv"``."""
    pitch_um: float
    """From one groove to the next, micrometres, from 0.3 to 50."""
    name: Optional[str] = _default()
    """Free text."""
    hidden: bool = _default()
    """Laid nowhere. Default: False."""
    width_um: Optional[float] = _default()
    """Width of a groove, micrometres, at most the pitch. Default: 0.4 of the pitch."""
    depth_nm: Optional[Sizes] = _default()
    """Normal, nanometres; the spread is a share of the mean. Default: 120."""
    jitter_um: Optional[float] = _default()
    """Standard deviation of how far a groove is off its place, micrometres. Default: 0."""
    seed: Optional[int] = _default()
    """Which grooves are off their places by how much, where they are seen one by one. Default: 1."""
    jitter_deg: Optional[float] = _default()
    """Standard deviation of a groove's angle to the pattern, degrees. Default: 0."""
    coverage: Optional[float] = _default()
    """The share of the surface that they cover. Default: 1."""
    mask: Optional[Path] = _default()
    """A picture whose values are factors on the coverage. Default: none."""
    tile_m: Optional[float] = _default()
    """The mask is laid on from three sides, so wide, metres. Default: by texture coordinates."""
    radius_m: Optional[Sequence[float]] = _default()
    """The least and the greatest distance from the axis, metres. Default: everywhere."""
    along: Optional[str] = _default()
    """Of grooves by texture coordinates: ``"u"`` or ``"v"``. Default: ``"u"``."""
    directions: Optional[Path] = _default()
    """A picture that turns grooves by texture coordinates, as anisotropy textures of glTF do. Default: none."""
    direction: Optional[Vector] = _default()
    """Of parallel grooves, 3 numbers. Default: +x."""
    axis: Optional[Vector] = _default()
    """Of circular, radial, spun and swirling grooves, 3 numbers. Default: +z."""
    center_m: Optional[Vector] = _default()
    """A point on the axis, metres, 3 numbers. Default: 0."""
    curvature_per_m: Optional[float] = _default()
    """Of spun grooves, per metre. Default: 20."""
    spacing_m: Optional[float] = _default()
    """Of swirling grooves, from spot to spot, metres. Default: 0.004."""


class Light(Table):
    """``[[light]]``: one of the kinds below."""

    _section = "light"
    _absent = {"hidden": False, "visible": False, "radiance": 1.0, "exposure_ev": 0.0}

    name: Optional[str] = _default()
    """Free text."""
    hidden: bool = _default()
    """Lights nothing. Default: False."""
    visible: bool = _default()
    """Whether the camera sees its shape; not of a sun. Default: False."""
    radiance: float = _default()
    """W sr^-1 m^-2; not of a sun. Default: 1."""
    exposure_ev: float = _default()
    """Stops: the radiance is multiplied by 2^exposure_ev. Default: 0."""
    temperature_k: Optional[float] = _default()
    """The colour of a black body, kelvin. Default: none."""
    color: Vector = _default()
    """Factor on the radiance, linear Rec.709, 3 numbers. Default: 1."""
    cone_deg: Optional[float] = _default()
    """A spot's cone from rim to rim, degrees; not of a sun. Default: light leaves in all directions."""
    cone_softness: Optional[float] = _default()
    """The part of the way from rim to axis in which light falls off. Default: 0.1, with a cone."""
    barn_doors_deg: Optional[Sequence[float]] = _default()
    """Of a disk or a rectangle: angles between its axis and flaps that end its light, degrees: left, right, above, below as seen from its target."""

    def __getattr__(self, key: str) -> Any:
        value = super().__getattr__(key)
        return 0.1 if key == "cone_softness" and value is None and "cone_deg" in self._table else value


class SphereLight(Light):
    """A sphere."""

    _fixed = {"kind": "sphere"}

    center_m: Vector
    """Metres, 3 numbers."""
    radius_m: float
    """Metres."""
    target_m: Optional[Vector] = _default()
    """What its cone points to, metres, 3 numbers."""


class DiskLight(Light):
    """Flat and round; shines to the side of its target."""

    _fixed = {"kind": "disk"}
    _absent = {**Light._absent, "two_sided": False}

    center_m: Vector
    """Metres, 3 numbers."""
    target_m: Vector
    """A point before it on its axis, metres, 3 numbers."""
    radius_m: float
    """Metres."""
    two_sided: bool = _default()
    """Whether the other side shines too. Default: False."""


class RectangleLight(Light):
    """Shines to the side of its target."""

    _fixed = {"kind": "rectangle"}
    _absent = {**Light._absent, "two_sided": False, "rotation_deg": 0.0}

    center_m: Vector
    """Metres, 3 numbers."""
    target_m: Vector
    """A point before it on its axis, metres, 3 numbers."""
    width_m: float
    """Metres."""
    height_m: float
    """Metres."""
    rotation_deg: float = _default()
    """About its axis, counter-clockwise as seen from the target, degrees. Default: 0."""
    picture: Optional[Path] = _default()
    """A picture on it, upright as seen from the target: the path of a .png, .jpg, .webp, .hdr or .exr. Default: none."""
    two_sided: bool = _default()
    """Whether the other side shines too. Default: False."""


class PolygonLight(Light):
    """Planar; shines to the side that sees its vertices counter-clockwise."""

    _fixed = {"kind": "polygon"}

    vertices_m: Union[Sequence[Vector], ArrayLike]
    """n x 3, metres."""
    two_sided: bool = _default()
    """Whether the other side shines too. Default: False."""


class TubeLight(Light):
    """All within a radius of a line."""

    _fixed = {"kind": "tube"}

    ends_m: Union[Sequence[Vector], ArrayLike]
    """2 x 3, metres."""
    radius_m: float
    """Metres."""
    target_m: Optional[Vector] = _default()
    """What its cone points to, metres, 3 numbers."""


class SunLight(Light):
    """Round, and so far off that it stands in one direction for all of the scene."""

    _fixed = {"kind": "sun"}
    _absent = {"hidden": False, "exposure_ev": 0.0}

    direction: Vector
    """The way that its light goes, of any length, 3 numbers."""
    angle_deg: float = _default()
    """The angle that it spans, across, degrees. Default: 0.53."""
    irradiance: float = _default()
    """What falls on a surface that faces it, W m^-2. Default: 1."""


_LIGHTS: dict[str, type[Light]] = {
    "sphere": SphereLight,
    "disk": DiskLight,
    "rectangle": RectangleLight,
    "polygon": PolygonLight,
    "tube": TubeLight,
    "sun": SunLight,
}

T = TypeVar("T", bound=Table)


def table_of(kind: type[T], table: Mapping[str, Any]) -> T:
    """A table that was checked as an object of its class."""
    of: type[Any] = _LIGHTS[table["kind"]] if kind is Light else kind
    made: T = of._of(table)
    return made


class Tables(MutableSequence[T], Generic[T]):
    """A list of tables: lights, objects and so on. Takes no others."""

    def __init__(self, kind: type[T], tables: Iterable[T] = ()) -> None:
        self._kind = kind
        self._tables = [self._own(table) for table in tables]

    def _own(self, table: Any) -> T:
        if isinstance(table, self._kind):
            return table
        name = f"hairline.{self._kind.__name__}"
        found = f"found an object of type {type(table).__module__}.{type(table).__qualname__}"
        raise argument_error(self._kind._section, found, f"must be a {name}")

    @overload
    def __getitem__(self, at: int) -> T: ...
    @overload
    def __getitem__(self, at: slice) -> list[T]: ...
    def __getitem__(self, at: int | slice) -> T | list[T]:
        return self._tables[at]

    @overload
    def __setitem__(self, at: int, table: T) -> None: ...
    @overload
    def __setitem__(self, at: slice, table: Iterable[T]) -> None: ...
    def __setitem__(self, at: int | slice, table: Any) -> None:
        if isinstance(at, slice):
            self._tables[at] = [self._own(one) for one in table]
        else:
            self._tables[at] = self._own(table)

    def __delitem__(self, at: int | slice) -> None:
        del self._tables[at]

    def __len__(self) -> int:
        return len(self._tables)

    def __iter__(self) -> Iterator[T]:
        return iter(self._tables)

    def insert(self, index: int, value: T) -> None:
        """Puts a table before the one at ``index``."""
        self._tables.insert(index, self._own(value))

    def named(self, name: str) -> T:
        """The table of this name."""
        for table in self._tables:
            if table._table.get("name") == name:
                return table
        names = ", ".join(repr(table._table["name"]) for table in self._tables if "name" in table._table)
        raise KeyError(f"no {self._kind._section} is called {name!r}; there are {names or 'none'}")

    def __repr__(self) -> str:
        return repr(self._tables)

    def __eq__(self, other: object) -> bool:
        return list(self) == list(other) if isinstance(other, (Tables, list)) else NotImplemented
