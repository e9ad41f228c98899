"""The classes of a scene's tables: the camera, lights, objects and so on. Their keys are in ``_keys``."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, MutableSequence
from typing import TYPE_CHECKING, Any, Generic, Optional, TypeVar, Union, overload

from . import _hairline as core
from ._arrays import ArrayLike, floats, indices, per_scratch
from ._errors import argument_error
from ._keys import CameraKeys, Light, ObjectKeys, ScratchesKeys
from ._table import Table, Vector

if TYPE_CHECKING:
    from typing_extensions import Self



class Camera(CameraKeys):
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


class Object(ObjectKeys):
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


class Scratches(ScratchesKeys):
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


#: The class of each kind of light.
_LIGHTS: dict[str, type[Light]] = {light._fixed["kind"]: light for light in Light.__subclasses__()}

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
