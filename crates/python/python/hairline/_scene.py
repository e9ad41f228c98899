"""Scenes."""

from __future__ import annotations

import math
import os
import re
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path as FilePath
from typing import Any, Callable, NamedTuple, Optional, TypeVar, Union

from . import _hairline as core
from ._bands import Bands
from ._changes import changed, found
from ._errors import InterruptedWarning, argument_error
from ._hairline import Image, Labels
from ._host import Host, Progress
from ._keys import Environment, Grating, Ground, Light, Look, Material, Settings, Studio
from ._table import Path, Table
from ._tables import Camera, Object, Scratches, Tables, table_of
from ._whole_file import write_whole

T = TypeVar("T", bound=Table)

_SINGLE: dict[str, type[Table]] = {
    "camera": Camera,
    "settings": Settings,
    "environment": Environment,
    "studio": Studio,
    "ground": Ground,
}
_OPTIONAL = ("environment", "studio", "ground")
_LISTS: tuple[tuple[str, str, type[Table]], ...] = (
    ("materials", "material", Material),
    ("objects", "object", Object),
    ("scratches", "scratches", Scratches),
    ("gratings", "grating", Grating),
    ("lights", "light", Light),
    ("looks", "look", Look),
)


def _whole(key: str, value: Any, least: int, most: int) -> int:
    is_whole = not isinstance(value, bool) and hasattr(value, "__index__")
    if not is_whole or not least <= value.__index__() <= most:
        raise argument_error(key, f"found {value!r}", f"must be a whole number from {least} to {most}")
    return int(value)


def _switch(key: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise argument_error(key, f"found {value!r}", "must be True or False")
    return value


def _name(key: str, value: Any) -> str:
    if not isinstance(value, str):
        raise argument_error(key, f"found {value!r}", "must be a text")
    return value


def render_arguments(
    *,
    backend: str = "auto",
    samples: int = core.DEFAULT_SAMPLES,
    shadows: Optional[bool] = None,
    bounces: Optional[int] = None,
    transparent: bool = False,
) -> tuple[str, int, Optional[bool], Optional[int], bool]:
    """Those of :meth:`Scene.render`, checked."""
    return (
        _name("backend", backend),
        _whole("samples", samples, 1, 1024),
        None if shadows is None else _switch("shadows", shadows),
        None if bounces is None else _whole("bounces", bounces, 0, 64),
        _switch("transparent", transparent),
    )


_DRAWN = ("seed", "length_m", "jitter_deg", "spread")
"""Keys whose change draws other scratches."""

_DENSITY = re.compile(r"scratches\[(\d+)\]\.(count|density_per_m2|density_per_m)$")
"""Keys that the number of a layer's scratches is in proportion to."""

_OF_MATERIAL = re.compile(r"material\[\d+\]\.")
_OF_LIGHT = re.compile(r"light\[\d+\]\.")
# Steps over the number.
_WIDE, _NARROW = 1e-2, 3e-4
"""Keys that lobes are tabulated by: their steps are small against those of the tables."""

_EIGHTH = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
_FOURTH = {1: 2 / 3, 2: -1 / 12}
"""Weights of central differences over those of so many steps, by their order."""


class Gradient(NamedTuple):
    """The derivative of a picture by a number of its scene, for each unit of that: float64, height x width x 3."""

    base: Any
    """Of the light off the base."""
    scratches: Any
    """Of the light off the scratches."""

    @property
    def beauty(self) -> Any:
        """Of all light."""
        return self.base + self.scratches


class Scene:
    """Everything that a picture depends on. Its parts have the keys of scene files (docs/scene.md)."""

    camera: Camera
    settings: Settings
    """The table ``[render]`` of scene files."""
    environment: Optional[Environment]
    studio: Optional[Studio]
    """None: where there are no lights and no environment one with its defaults, on a ground; else none."""
    ground: Optional[Ground]
    materials: Tables[Material]
    objects: Tables[Object]
    scratches: Tables[Scratches]
    gratings: Tables[Grating]
    lights: Tables[Light]
    looks: Tables[Look]
    """Other cameras, exposures and lights, by name: ``hairline render --looks`` renders them."""
    folder: FilePath
    """What the files that it names are relative to."""
    notes: list[str]
    """What the author should know about the scene file, a line each."""

    _source: Optional[tuple[FilePath, str, dict[str, Any]]]

    def __init__(
        self,
        *,
        camera: Camera,
        settings: Optional[Settings] = None,
        environment: Optional[Environment] = None,
        studio: Optional[Studio] = None,
        ground: Optional[Ground] = None,
        materials: Iterable[Material] = (),
        objects: Iterable[Object] = (),
        scratches: Iterable[Scratches] = (),
        gratings: Iterable[Grating] = (),
        lights: Iterable[Light] = (),
        looks: Iterable[Look] = (),
        folder: Path = ".",
    ) -> None:
        self.camera = camera
        self.settings = Settings() if settings is None else settings
        self.environment = environment
        self.studio = studio
        self.ground = ground
        self.materials = Tables(Material, materials)
        self.objects = Tables(Object, objects)
        self.scratches = Tables(Scratches, scratches)
        self.gratings = Tables(Grating, gratings)
        self.lights = Tables(Light, lights)
        self.looks = Tables(Look, looks)
        # Programs may go on in another folder.
        self.folder = FilePath(folder).absolute()
        self.notes = []
        self._source = None
        self._builder = core.Builder()

    def __setattr__(self, name: str, value: Any) -> None:
        one = _SINGLE.get(name)
        if one is not None and not isinstance(value, one) and not (value is None and name in _OPTIONAL):
            found = f"found an object of type {type(value).__module__}.{type(value).__qualname__}"
            raise argument_error(name, found, f"must be a hairline.{one.__name__}")
        for attribute, _, kind in _LISTS:
            if name == attribute and not isinstance(value, Tables):
                if not isinstance(value, Iterable) or isinstance(value, Mapping):
                    found = f"found an object of type {type(value).__module__}.{type(value).__qualname__}"
                    raise argument_error(name, found, f"must be a list of hairline.{kind.__name__}")
                value = Tables(kind, value)
        if name not in Scene.__annotations__ and name != "_builder":
            raise AttributeError(f"a scene has no attribute {name!r}")
        object.__setattr__(self, name, value)

    @classmethod
    def from_dict(cls, table: Mapping[str, Any], folder: Path = ".") -> Scene:
        """A scene of a dict with the keys of scene files: ``camera``, ``render``, ``environment``, ``studio``, ``ground``, ``material``,
        ``object``, ``scratches``, ``grating``, ``light`` and ``look``. Files that it names are looked for in ``folder``."""
        if not isinstance(table, Mapping):
            raise argument_error("scene", f"found an object of type {type(table).__qualname__}", "must be a dict")
        return cls._of(core.check(dict(table)), folder)

    @classmethod
    def _of(cls, table: dict[str, Any], folder: Path) -> Scene:
        def all_of(kind: type[T]) -> list[T]:
            return [table_of(kind, one) for one in table.get(kind._section, [])]

        def one_of(kind: type[T]) -> Optional[T]:
            return table_of(kind, table[kind._section]) if kind._section in table else None

        studio = one_of(Studio)
        if studio is None and "light" not in table and "environment" not in table:
            # The file said so, or the scene would have a studio.
            studio = Studio(hidden=True)
        return cls(
            camera=table_of(Camera, table["camera"]),
            settings=table_of(Settings, table["render"]),
            environment=one_of(Environment),
            studio=studio,
            ground=one_of(Ground),
            materials=all_of(Material),
            objects=all_of(Object),
            scratches=all_of(Scratches),
            gratings=all_of(Grating),
            lights=all_of(Light),
            looks=all_of(Look),
            folder=folder,
        )

    def to_dict(self) -> dict[str, Any]:
        """The scene as a dict with the keys of scene files."""
        table: dict[str, Any] = {"camera": self.camera.to_dict(), "render": self.settings.to_dict()}
        for one in (self.environment, self.studio, self.ground):
            if one is not None:
                table[one._section] = one.to_dict()
        for attribute, section, _ in _LISTS:
            tables = getattr(self, attribute)
            if len(tables):
                table[section] = [one.to_dict() for one in tables]
        return table

    def to_toml(self) -> str:
        """The scene file that loads to this scene. Arrays in memory have no place in it."""
        for attribute, key in (("objects", "mesh"), ("scratches", "file")):
            for i, one in enumerate(getattr(self, attribute)):
                if isinstance(one.to_dict().get(key), (core.MeshArray, core.ScratchArray)):
                    where = f"{one._section}[{i}].{key}"
                    raise argument_error(where, "found an array in memory", "a scene file can only name files")
        return core.to_toml(self.to_dict())

    def save(self, path: Path) -> None:
        """Writes the scene file. Files that it names are not copied: write it where they are."""
        write_whole(path, self.to_toml().encode())

    def export(self, path: Path, *, laid: bool = False, bake: Optional[int] = None) -> list[str]:
        """Writes one glTF file (.glb) that other programs open, with its scratches by the extension HAIRLINE_scratches.
        :func:`hairline.load` opens it as the same scene. A name that ends in .usdz gets what the scene is about, with its materials, for
        phones: without lights and scratches. Arrays in memory are in it too; a mesh in memory is rounded to single precision.

        :param laid: whether the scratches are in it as they lie too, for programs that lay none: 44 bytes for each straight piece.
        :param bake: texels of a side of normal maps and roughness maps into which the scratches are drawn, 16 to 4096. The file then has the model
            alone, for programs that know no scratches. Its texture coordinates must not overlap.
        :return: notes on what other programs do not show.
        """
        bake_px = None if bake is None else _whole("bake", bake, 16, 4096)
        return core.export(self.to_dict(), self.folder, path, _switch("laid", laid), bake_px)

    def build(self, *, size: Optional[tuple[int, int]] = None, progress: Progress = False) -> core.Built:
        """Reads the files, builds the meshes and lays the scratches. :meth:`render` does it by itself, and what has not changed
        since the last time is not built again."""
        return self._built(size, Host(progress))

    def _sized(self, size: Optional[tuple[int, int]]) -> dict[str, Any]:
        """The scene as a dict, with another size of the picture: a lens sees what it saw by the scene's own."""
        table = self.to_dict()
        if size is not None:
            if "focal_length_mm" in table["camera"]:
                table["camera"] = core.check(table)["camera"]
            table["render"] = {**table["render"], "size_px": size}
        return table

    def _built(self, size: Optional[tuple[int, int]], host: Host) -> core.Built:
        text, file = None, FilePath()
        if self._source is not None and self._source[2] == self.to_dict():
            file, text = self._source[0], self._source[1]
        table = self._sized(size)
        try:
            return self._builder.build(table, self.folder, text, file, host)
        finally:
            host.close()

    def render(
        self,
        *,
        size: Optional[tuple[int, int]] = None,
        backend: str = "auto",
        samples: int = core.DEFAULT_SAMPLES,
        shadows: Optional[bool] = None,
        bounces: Optional[int] = None,
        transparent: bool = False,
        labels: bool = False,
        progress: Progress = False,
    ) -> Image:
        """Renders the picture, the same bits as ``hairline render``.

        :param size: width and height in pixels, in place of the scene's.
        :param backend: ``"auto"`` (a GPU if there is one, else the CPU), ``"gpu"`` or ``"cpu"``.
        :param samples: of each pixel that has an edge or a crease in it, from 1 to 1024.
        :param shadows: whether objects hide lights and the environment from one another. Default: as ``hairline render``.
        :param bounces: other objects that light may go by, with shadows, from 0 to 64. Default: as ``hairline render``.
        :param transparent: whether the picture has :attr:`Image.alpha`; the environment lights its surfaces and is not seen then.
        :param labels: whether the picture has :attr:`Image.labels`, those of :meth:`labels`.
        :param progress: True for a bar on stderr, or a function of what is done and its share, from 0 to 1.

        Ctrl-C ends it: what there is by then is returned with :attr:`Image.is_complete` False and an
        :class:`InterruptedWarning`; with nothing there yet, KeyboardInterrupt is raised.
        """
        arguments = render_arguments(
            backend=backend, samples=samples, shadows=shadows, bounces=bounces, transparent=transparent
        )
        labels = _switch("labels", labels)
        host = Host(progress)
        built = self._built(size, host)
        try:
            image = built.render(*arguments, host)
            if labels and image.is_complete:
                image = image._with_labels(built.labels(host))
        finally:
            host.close()
        return _told(image)

    def render_bands(
        self,
        bands_nm: Iterable[tuple[float, float]],
        *,
        size: Optional[tuple[int, int]] = None,
        samples: int = core.DEFAULT_SAMPLES,
        shadows: Optional[bool] = None,
        bounces: Optional[int] = None,
        progress: Progress = False,
    ) -> Bands:
        """Renders the picture in bands of the spectrum, on the CPU: ``scene.render_bands([(400, 410), (410, 420)])``.

        Metals, scratches, gratings and plates have their spectra. A colour has none: lamps, surfaces, textures and the environment must be grey,
        which is the same in all bands; others are refused.

        :param bands_nm: from one wavelength to a longer one, at least 1 nm wide, within 380 to 780 nm.
        """
        settings = render_arguments(backend="cpu", samples=samples, shadows=shadows, bounces=bounces)
        return self._in_bands(bands_nm, size, progress, lambda built, host: built.render(*settings, host))

    def reference_bands(
        self,
        bands_nm: Iterable[tuple[float, float]],
        *,
        size: Optional[tuple[int, int]] = None,
        model: str = "separable",
        samples: int = 1024,
        shadows: bool = False,
        bounces: int = 0,
        sample_seed: int = 0,
        progress: Progress = False,
    ) -> Bands:
        """Samples the picture of :meth:`render_bands` by Monte Carlo; arguments as of :meth:`reference`."""
        samples, bounces = _whole("samples", samples, 1, 1 << 24), _whole("bounces", bounces, 0, 64)
        seed = _whole("sample_seed", sample_seed, 0, (1 << 64) - 1)
        settings = (_name("model", model), samples, None, _switch("shadows", shadows), bounces, "energy", seed, None, None)
        return self._in_bands(bands_nm, size, progress, lambda built, host: built.reference(*settings, host))

    def _in_bands(
        self,
        bands_nm: Iterable[tuple[float, float]],
        size: Optional[tuple[int, int]],
        progress: Progress,
        draw: Callable[[core.Built, Host], Image],
    ) -> Bands:
        bands = tuple((float(low), float(high)) for low, high in bands_nm)
        if not bands:
            raise argument_error("bands_nm", "found no band", "must be pairs of wavelengths")
        host = Host(progress)
        try:
            scenes = self._built(size, host).in_bands(list(bands))
            images = [draw(built, host) for built in scenes]
        finally:
            host.close()
        if not all(image.is_complete for image in images):
            raise KeyboardInterrupt

        def of(layer: str) -> Any:
            import numpy as np

            return np.ascontiguousarray(np.concatenate([getattr(image, layer) for image in images], axis=2)[..., : len(bands)])

        return Bands(bands, of("base"), of("scratches"))

    def gradients(
        self,
        by: Iterable[str],
        *,
        size: Optional[tuple[int, int]] = None,
        relative_step: Optional[float] = None,
        progress: Progress = False,
    ) -> dict[str, Gradient]:
        """Pictures of derivatives of the closed forms, without shadows.

        A closed form has no noise, and a seed lays the same scratches whatever their sizes: so differences of its light, here in double precision
        and of high orders, are its derivatives, to 1e-5 (docs/python.md has figures).

        :param by: ways to numbers: ``"scratches[0].depth_nm"``, ``"scratches[0].width_um.mean"``, ``"scratches[0].density_per_m2"``,
            ``"light[0].center_m[2]"``, ``"light[0].radiance"``, ``"material[0].roughness"``. Not those that draw other scratches: lengths and
            seeds. By a density or a count each scratch that is there counts for more: where scratches do not weaken one another, the derivative's
            mean over seeds is that of the mean picture.
        :param relative_step: of each number; of a tenth of the camera's distance from the target, for coordinates. Default: 1/100, and 3/10000 for
            keys of materials and for the base by keys of lights.
        """
        step = relative_step
        if step is not None and (isinstance(step, bool) or not isinstance(step, (int, float)) or not 1e-4 <= step <= 0.05):
            raise argument_error("relative_step", f"found {step!r}", "must be a number from 0.0001 to 0.05")
        ways = [_name("by", way) for way in by]
        table = self.to_dict()
        away = math.dist(table["camera"]["position_m"], table["camera"]["target_m"])
        made: dict[str, Gradient] = {}
        host = Host(progress)

        def difference(h: float, weights: dict[int, float], light: Callable[[float], list[Any]]) -> Gradient:
            base: Any = 0.0
            scratches: Any = 0.0
            for i, (at, weight) in enumerate(weights.items()):
                host.progress("rendering", (len(made) + i / len(weights)) / len(ways))
                for sign in (1, -1):
                    lights = light(sign * at * h)
                    base = base + lights[0] * (sign * weight / h)
                    scratches = scratches + lights[1] * (sign * weight / h)
            return Gradient(base, scratches)

        try:
            for way in ways:
                last = re.sub(r"\[\d+\]", "", way).rsplit(".", 1)[-1]
                value = found(table, way)
                way_to = way
                if isinstance(value, dict) and "mean" in value:
                    way_to, value = f"{way}.mean", value["mean"]
                if last in _DRAWN:
                    raise argument_error(way, "found what other scratches are drawn by", "must be a size, a density, a roughness or a part of a light")
                if isinstance(value, bool) or not isinstance(value, (int, float)):
                    raise argument_error(way, f"found {value!r}", "must lead to a number")
                is_place = "[" in way_to.rsplit(".", 1)[-1]
                whole = 0.1 * away if is_place else abs(value)
                if whole == 0:
                    raise argument_error(way, "found 0, of which no step is a share", "must not be 0")
                density = _DENSITY.match(way_to)
                if density is not None:
                    built = self._built(size, Host(False))
                    layer = int(density[1])
                    of_one = difference(1 / 64, _FOURTH, lambda by: built.light(layer, 1 + by, host))
                    made[way] = Gradient(of_one.base / value, of_one.scratches / value)
                    continue

                def moved(by: float, to: str = way_to, value: float = value) -> list[Any]:
                    scene = Scene._of(core.check(changed(table, {to: value + by})), self.folder)
                    scene._builder = self._builder
                    return scene._built(size, Host(False)).light(None, 1.0, host)

                # Wide steps of a high order: scenes hold sizes of scratches in single precision, and light leaves a scratch's band at once. The base
                # of a highlight is smooth over narrow ones alone: its second derivatives jump where the tails begin.
                is_of_material = _OF_MATERIAL.match(way_to) is not None
                share = step if step is not None else _NARROW if is_of_material else _WIDE
                made[way] = difference(share * whole, _FOURTH if is_of_material else _EIGHTH, moved)
                if step is None and _OF_LIGHT.match(way_to):
                    made[way] = made[way]._replace(base=difference(_NARROW * whole, _FOURTH, moved).base)
        finally:
            host.close()
        return made

    def labels(self, *, size: Optional[tuple[int, int]] = None, progress: Progress = False) -> Labels:
        """Which scratches each pixel of the picture shows, as ``hairline render --labels``: through the pinhole, whatever the lens.

        :param size: width and height in pixels, in place of the scene's.
        :param progress: as of :meth:`render`.
        """
        host = Host(progress)
        built = self._built(size, host)
        try:
            return built.labels(host)
        finally:
            host.close()

    @property
    def bounds(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The least and the greatest corner of the box around all objects, world space, metres."""
        least, most = self.build().bounds_m()
        return tuple(least), tuple(most)

    def reference(
        self,
        *,
        size: Optional[tuple[int, int]] = None,
        model: str = "separable",
        samples: Optional[int] = None,
        time_s: Optional[float] = None,
        shadows: bool = False,
        bounces: int = 0,
        mask: str = "energy",
        sample_seed: int = 0,
        resume: Optional[Image] = None,
        progress: Progress = False,
    ) -> Image:
        """Samples the picture by Monte Carlo, as ``hairline reference`` does: what the closed forms must converge to.

        :param model: ``"separable"``, that of :meth:`render`, or ``"full"``, all phases.
        :param samples: of each pixel, rounded up to whole batches. Default: 1024, or as many as fit in ``time_s``.
        :param time_s: seconds after which no more batches are begun.
        :param mask: what scratches take from the base in the separable model: ``"energy"``, ``"linear"`` or ``"density"``.
        :param sample_seed: other samples of the same picture.
        :param resume: a reference of the same scene and arguments, of this program or of a file, that samples are added to.

        Ctrl-C ends it as :meth:`render`.
        """
        return self._reference(
            None, size, model, samples, time_s, shadows, bounces, mask, sample_seed, resume, progress
        )

    def _reference(
        self,
        rows: Optional[tuple[int, int]],
        size: Optional[tuple[int, int]],
        model: str,
        samples: Optional[int],
        time_s: Optional[float],
        shadows: bool,
        bounces: int,
        mask: str,
        sample_seed: int,
        resume: Optional[Image],
        progress: Progress,
    ) -> Image:
        if samples is not None:
            samples = _whole("samples", samples, 1, 1 << 24)
        bounces = _whole("bounces", bounces, 0, 64)
        sample_seed = _whole("sample_seed", sample_seed, 0, (1 << 64) - 1)
        if time_s is not None and not (isinstance(time_s, (int, float)) and 0 < time_s < math.inf):
            raise argument_error("time_s", f"found {time_s!r}", "must be a number of seconds above 0")
        if resume is not None and not isinstance(resume, Image):
            raise argument_error("resume", f"found {type(resume).__name__}", "must be a hairline.Image")
        model, mask, shadows = _name("model", model), _name("mask", mask), _switch("shadows", shadows)
        host = Host(progress)
        built = self._built(size, host)
        try:
            image = built.reference(
                model, samples, time_s, shadows, bounces, mask, sample_seed, resume, rows, host
            )
        finally:
            host.close()
        return image if time_s is not None else _told(image)

    def __eq__(self, other: object) -> bool:
        """Whether both say the same of one folder, in whatever types: defaults that are written out are defaults."""
        if not isinstance(other, Scene):
            return NotImplemented
        same_folder = self.folder.absolute() == other.folder.absolute()
        return same_folder and core.digest(self.to_dict()) == core.digest(other.to_dict())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        counts = ", ".join(f"{len(getattr(self, attribute))} {attribute}" for attribute, _, _ in _LISTS)
        return f"<hairline.Scene: {counts}>"

    def thumbnail(self, width: int = 240) -> Image:
        """A small picture, without shadows: what a notebook shows of the scene.

        :param width: in pixels, from 16 to 1024; the height is that of the scene's shape.
        """
        width = _whole("width", width, 16, 1024)
        across, down = self.settings.size_px
        return self.render(size=(width, max(1, round(width * down / across))), samples=1, shadows=False)

    def _repr_png_(self) -> bytes:
        return self.thumbnail().png()

    def __getstate__(self) -> dict[str, Any]:
        return {"table": self.to_dict(), "folder": self.folder}

    def __setstate__(self, state: dict[str, Any]) -> None:
        made = Scene._of(state["table"], state["folder"])
        for name, value in made.__dict__.items():
            setattr(self, name, value)


def _told(image: Image) -> Image:
    if not image.is_complete:
        warnings.warn("interrupted: the picture is not complete", InterruptedWarning, stacklevel=3)
    return image


def load(path: Union[str, "os.PathLike[str]"]) -> Scene:
    """Reads a scene file (.toml), or a model (.glb, .gltf) in a lit scene of its own.

    What is wrong with its keys and values is told here, by file, line and key; files that it names are read by
    :meth:`Scene.render` or :meth:`Scene.build`.
    """
    file = FilePath(path)
    table, text, notes = core.read(file)
    scene = Scene._of(table, file.parent)
    scene.notes = notes
    scene._source = (file, text, scene.to_dict())
    return scene
