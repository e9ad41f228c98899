"""Labelled pictures of scratched surfaces, for those who train inspection systems.

    from hairline import inspect

    gouge = inspect.Defect("gouge", object="plate", count=(0, 3), length_m=(5e-3, 2e-2), width_um=(10, 30), depth_nm=(800, 1800))
    inspect.dataset(scene, "plates", count=500, size=(256, 256), defects=[gouge])

The folder then has ``images/``, the classes of pixels in ``masks/``, ``annotations.json`` by COCO's convention (a polygon and a run-length mask for
each defect), ``manifest.json`` with all that was varied, and a card, ``README.md``. A picture depends on the scene, the seed and its number
alone, so a run that was stopped goes on where it was, and any machine makes the same.
"""

from __future__ import annotations

import io
import json
import math
import struct
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _hairline as core
from ._errors import SceneError, argument_error
from ._host import Host, Progress
from ._scene import Scene, _switch, _whole
from ._table import Path
from ._tables import Scratches
from ._whole_file import write_whole

if TYPE_CHECKING:
    from .cluster import Connection

__all__ = ["Defect", "Variation", "dataset", "drawn", "polygons", "run_lengths"]

Span = tuple[float, float]
_Mask = npt.NDArray[np.bool_]
_MOST = 100_000
"""Pictures of a data set."""
_LEAST_PX = 4
"""Pixels that a defect shows at least, or it is not annotated."""


def _span(key: str, value: Any, least: float, most: float) -> Span:
    pair = (value, value) if isinstance(value, (int, float)) and not isinstance(value, bool) else value
    fits = isinstance(pair, (tuple, list)) and len(pair) == 2 and all(isinstance(end, (int, float)) for end in pair)
    if not fits or not least <= pair[0] <= pair[1] <= most:
        raise argument_error(key, f"found {value!r}", f"must be a number or two that rise, from {least:g} to {most:g}")
    return float(pair[0]), float(pair[1])


@dataclass(frozen=True)
class Defect:
    """A class of scratches that are looked for. Each picture has as many as are drawn from ``count``, with sizes drawn from their ranges.

    :param name: of the class.
    :param object: what they lie on.
    :param count: least and greatest number in a picture.
    :param length_m: range of lengths, drawn evenly in their logarithm, as the sizes below.
    :param width_um: from 0.05 to 100.
    :param depth_nm: from 1 to 2000.
    :param profile: cross section, as ``profile`` of scene files: a name, or depths from the middle to the rim.
    """

    name: str
    object: str
    count: Union[int, tuple[int, int]] = (0, 3)
    length_m: Union[float, Span] = (5e-3, 2e-2)
    width_um: Union[float, Span] = (10.0, 30.0)
    depth_nm: Union[float, Span] = (800.0, 1800.0)
    profile: Union[str, tuple[float, ...]] = "rectangle"

    def __post_init__(self) -> None:
        for key in ("name", "object"):
            if not isinstance(getattr(self, key), str) or not getattr(self, key):
                raise argument_error(f"defect.{key}", f"found {getattr(self, key)!r}", "must be a text")
        low, high = _span("defect.count", self.count, 0, 1000)
        if low != int(low) or high != int(high):
            raise argument_error("defect.count", f"found {self.count!r}", "must be whole numbers")
        _span("defect.length_m", self.length_m, 1e-6, 1000)
        _span("defect.width_um", self.width_um, 0.05, 100)
        _span("defect.depth_nm", self.depth_nm, 1, 2000)
        try:
            Scratches(object=self.object, pattern="random", count=1, profile=self.profile)
        except SceneError as error:
            raise argument_error("defect.profile", error.found, error.right) from None

    def _laid(self, random: np.random.Generator) -> list[Scratches]:
        low, high = (int(end) for end in _span("count", self.count, 0, 1000))
        made = []
        for _ in range(int(random.integers(low, high + 1))):
            sizes: dict[str, Any] = {}
            for key in ("length_m", "width_um", "depth_nm"):
                least, most = _span(key, getattr(self, key), 1e-9, 1e9)
                sizes[key] = float(np.exp(random.uniform(math.log(least), math.log(most))))
            seed = int(random.integers(2**62))
            keys: dict[str, Any] = {"object": self.object, "pattern": "random", "count": 1, "seed": seed, "profile": self.profile}
            made.append(Scratches(name=f"defect {self.name}", **keys, **sizes))
        return made


@dataclass(frozen=True)
class Variation:
    """What differs from picture to picture, besides the seeds of all layers. Angles are even within plus or minus the number.

    :param camera_turn_deg: of the camera about the vertical through its target.
    :param camera_tilt_deg: of the camera up and down.
    :param camera_distance: factor on its distance, from one over this to this.
    :param light_turn_deg: of all lights together about the vertical through the camera's target. Where surfaces face the camera, keep it below
        90: lights behind a surface do not light it.
    :param light_stops: on each light's radiance.
    :param wear: range of a factor on the number of scratches of each layer of the scene.
    """

    camera_turn_deg: float = 10.0
    camera_tilt_deg: float = 5.0
    camera_distance: float = 1.1
    light_turn_deg: float = 180.0
    light_stops: float = 0.5
    wear: Span = (0.5, 2.0)

    def __post_init__(self) -> None:
        for key, least, most in (
            ("camera_turn_deg", 0, 180),
            ("camera_tilt_deg", 0, 80),
            ("camera_distance", 1, 100),
            ("light_turn_deg", 0, 180),
            ("light_stops", 0, 10),
        ):
            value = getattr(self, key)
            if not isinstance(value, (int, float)) or not least <= value <= most:
                raise argument_error(f"variation.{key}", f"found {value!r}", f"must be a number from {least} to {most}")
        _span("variation.wear", self.wear, 0, 1000)


def _turn(angle_rad: float, axis: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The rotation about a unit vector: O. Rodrigues (1840)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn: npt.NDArray[np.float64] = np.eye(3) + math.sin(angle_rad) * cross + (1 - math.cos(angle_rad)) * cross @ cross
    return turn


_UPS = {"y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""Axes that ``world_up`` names."""


def _plane(light: dict[str, Any]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """The axes of a rectangle's width and height before its rotation, as scene files have them."""
    axis = np.array(light["target_m"], dtype=float) - np.array(light["center_m"], dtype=float)
    axis /= np.linalg.norm(axis)
    up = np.array([0.0, 1.0, 0.0] if math.hypot(axis[0], axis[2]) > 1e-3 else [0.0, 0.0, 1.0])
    x = np.cross(up, axis)
    x /= np.linalg.norm(x)
    return x, np.cross(axis, x)


def _rotation_deg(before: dict[str, Any], after: dict[str, Any], around: npt.NDArray[np.float64]) -> float:
    """The rotation by which a rectangle that was moved keeps its sides."""
    (x, y), turn = _plane(before), math.radians(before.get("rotation_deg", 0.0))
    across = around @ (math.cos(turn) * x + math.sin(turn) * y)
    x, y = _plane(after)
    return math.degrees(math.atan2(float(across @ y), float(across @ x)))


def drawn(
    scene: Scene, number: int, *, seed: int = 1, defects: Iterable[Defect] = (), variation: Optional[Variation] = None
) -> tuple[Scene, dict[str, Any]]:
    """The scene of one picture of a data set, and what was drawn for it."""
    vary = variation or Variation()
    random = np.random.default_rng([seed, number])
    table = scene.to_dict()
    camera = dict(table["camera"])
    if camera.get("of_file") is not None:
        found = f"found {camera['of_file']!r}"
        raise argument_error("camera.of_file", found, "must be left out: a camera that is varied has position_m and target_m")
    target = np.array(camera["target_m"], dtype=float)
    up = np.array(_UPS.get(str(camera.get("world_up")), camera.get("up", (0, 1, 0))), dtype=float)
    up /= np.linalg.norm(up)
    even = random.uniform(-1, 1, 5)
    told: dict[str, Any] = {
        "camera_turn_deg": vary.camera_turn_deg * even[0],
        "camera_tilt_deg": vary.camera_tilt_deg * even[1],
        "camera_distance": vary.camera_distance ** even[2],
        "light_turn_deg": vary.light_turn_deg * even[3],
    }
    way = np.array(camera["position_m"], dtype=float) - target
    side = np.cross(up, way)
    if np.linalg.norm(side) < 1e-9 * np.linalg.norm(way):
        side = np.cross([1.0, 0.0, 0.0] if abs(up[0]) < 0.9 else [0.0, 1.0, 0.0], way)
    tilted = _turn(math.radians(told["camera_tilt_deg"]), side / np.linalg.norm(side)) @ way
    turned = _turn(math.radians(told["camera_turn_deg"]), up) @ tilted
    camera["position_m"] = tuple(target + told["camera_distance"] * turned)
    table["camera"] = camera
    around = _turn(math.radians(told["light_turn_deg"]), up)
    lights, stops = [], []
    for light in table.get("light", []):
        light = dict(light)
        before = dict(light)
        for key in ("center_m", "target_m", "vertices_m", "ends_m"):
            if key in light:
                light[key] = ((np.array(light[key]) - target) @ around.T + target).tolist()
        if "direction" in light:
            light["direction"] = (around @ np.array(light["direction"])).tolist()
        if light.get("kind") == "rectangle":
            light["rotation_deg"] = _rotation_deg(before, light, around)
        stops.append(float(vary.light_stops * random.uniform(-1, 1)))
        light["exposure_ev"] = light.get("exposure_ev", 0.0) + stops[-1]
        lights.append(light)
    if lights:
        table["light"] = lights
    told["light_stops"] = stops
    layers = []
    least, most = _span("wear", vary.wear, 0, 1000)
    wear = float(np.exp(random.uniform(math.log(least), math.log(most)))) if least > 0 else random.uniform(least, most)
    for layer in table.get("scratches", []):
        layer = dict(layer)
        if layer["pattern"] != "file":
            layer["seed"] = int(random.integers(2**62))
            for key in ("count", "density_per_m2"):
                if layer.get(key) is not None:
                    layer[key] = round(layer[key] * wear) if key == "count" else layer[key] * wear
        layers.append(layer)
    told["wear"] = wear
    if layers:
        table["scratches"] = layers
    for grating in table.get("grating", []):
        grating["seed"] = int(random.integers(2**31))
    changed = Scene._of(core.check(table), scene.folder)
    # What did not change is built once.
    changed._builder = scene._builder
    told["defects"] = []
    for defect in defects:
        for made in defect._laid(random):
            told["defects"].append({"class": defect.name, "layer": len(changed.scratches), **made.to_dict()})
            changed.scratches.append(made)
    return changed, told


def run_lengths(mask: _Mask) -> dict[str, Any]:
    """A mask as COCO's run-length code, uncompressed: column by column, beginning with what is outside."""
    flat = np.concatenate([[False], np.asarray(mask, dtype=bool).ravel(order="F"), [False]])
    ends = np.flatnonzero(flat[1:] != flat[:-1])
    counts = np.diff(np.concatenate([[0], ends, [mask.size]]))
    if len(ends) and ends[-1] == mask.size:
        counts = counts[:-1]
    return {"size": list(mask.shape), "counts": counts.tolist()}


def polygons(mask: _Mask) -> list[list[float]]:
    """The outlines of a mask along the borders of its pixels, as COCO has them: x and y in turn. Filled by the rule of even and odd they are the
    mask, to the pixel."""
    padded = np.pad(np.asarray(mask, dtype=bool), 1)
    after: dict[tuple[int, int], list[tuple[int, int]]] = {}

    def add(ys: Any, xs: Any, start: tuple[int, int], end: tuple[int, int]) -> None:
        for y, x in zip(ys.tolist(), xs.tolist()):
            # The border of 1 that was added is taken off again.
            after.setdefault((x - 1 + start[0], y - 1 + start[1]), []).append((x - 1 + end[0], y - 1 + end[1]))

    inside = padded[1:-1, 1:-1]
    for beyond, start, end in (
        (padded[:-2, 1:-1], (1, 1), (2, 1)),
        (padded[1:-1, 2:], (2, 1), (2, 2)),
        (padded[2:, 1:-1], (2, 2), (1, 2)),
        (padded[1:-1, :-2], (1, 2), (1, 1)),
    ):
        ys, xs = np.nonzero(inside & ~beyond)
        add(ys, xs, start, end)
    made = []
    while after:
        first = next(iter(after))
        at, before, ring = first, None, []
        while True:
            ways = after[at]
            # Where two corners touch, the sharper turn keeps them apart.
            pick = 0
            if len(ways) > 1 and before is not None:
                came = (at[0] - before[0], at[1] - before[1])
                turns = [came[0] * (w[1] - at[1]) - came[1] * (w[0] - at[0]) for w in ways]
                pick = int(np.argmax(turns))
            following = ways.pop(pick)
            if not ways:
                del after[at]
            ring.append(at)
            before, at = at, following
            if at == first:
                break
        # Corners alone.
        count = len(ring)
        corners = [
            ring[i]
            for i in range(count)
            if (ring[i][0] - ring[i - 1][0]) * (ring[(i + 1) % count][1] - ring[i][1])
            != (ring[i][1] - ring[i - 1][1]) * (ring[(i + 1) % count][0] - ring[i][0])
        ]
        made.append([float(number) for corner in corners for number in corner])
    return made


def _grey_png(values: npt.NDArray[np.uint8]) -> bytes:
    """A picture of 8 bits a pixel, without a library."""
    height, width = values.shape

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = np.concatenate([np.zeros((height, 1), np.uint8), values], axis=1).tobytes()
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


@dataclass(frozen=True)
class _Recipe:
    """All that a picture depends on besides the scene."""

    size: tuple[int, int]
    seed: int
    defects: tuple[Defect, ...]
    variation: Variation
    exr: bool
    render: Mapping[str, Any]


def _made(scene: Scene, number: int, recipe: _Recipe) -> dict[str, bytes]:
    """The files of one picture by their names in the folder. That of its labels is the last."""
    changed, told = drawn(scene, number, seed=recipe.seed, defects=recipe.defects, variation=recipe.variation)
    image = changed.render(size=recipe.size, labels=True, **recipe.render)
    labels = image.labels
    if labels is None:
        raise KeyboardInterrupt
    width, height = labels.size
    classes = [defect.name for defect in recipe.defects]
    layer = labels.scratch_layer
    pixel, scratch = labels.touched[:, 0], labels.touched[:, 1]
    annotations = []
    semantic = np.zeros((height, width), np.uint8)
    for made in told["defects"]:
        for own in np.flatnonzero(layer == made["layer"]).tolist():
            mask = np.zeros((height, width), bool)
            mask.reshape(-1)[pixel[scratch == own]] = True
            if mask.sum() < _LEAST_PX:
                continue
            kind = classes.index(made["class"]) + 1
            semantic[mask] = kind
            ys, xs = np.nonzero(mask)
            box = [int(xs.min()), int(ys.min()), int(np.ptp(xs)) + 1, int(np.ptp(ys)) + 1]
            annotations.append(
                {
                    "category_id": kind,
                    "segmentation": polygons(mask),
                    "rle": run_lengths(mask),
                    "area": int(mask.sum()),
                    "bbox": box,
                    "iscrowd": 0,
                    "width_um": float(labels.scratch_width_um[own]),
                    "depth_nm": float(labels.scratch_depth_nm[own]),
                    "length_m": float(labels.scratch_length_m[own]),
                }
            )
    name = f"{number:06d}"
    files = {f"images/{name}.png": image.png(), f"masks/{name}.png": _grey_png(semantic)}
    if recipe.exr:
        import tempfile

        with tempfile.TemporaryDirectory(prefix="hairline-") as folder:
            path = FilePath(folder, "picture.exr")
            image.save(path)
            files[f"linear/{name}.exr"] = path.read_bytes()
    record = {"number": number, "size": [width, height], "drawn": told, "annotations": annotations}
    files[f"labels/{name}.json"] = json.dumps(record).encode()
    return files


def _on_worker(parcel: Any, number: int, recipe: _Recipe) -> dict[str, bytes]:
    from .cluster import _unpacked

    return _made(_unpacked(parcel).scene({}), number, recipe)


def _write(folder: FilePath, name: str, contents: bytes) -> None:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, contents)


def dataset(
    scene: Scene,
    folder: Path,
    *,
    count: int,
    size: tuple[int, int] = (256, 256),
    seed: int = 1,
    defects: Iterable[Defect] = (),
    variation: Optional[Variation] = None,
    exr: bool = False,
    client: Connection = None,
    progress: Progress = False,
    **render: Any,
) -> FilePath:
    """Makes a data set of labelled pictures, or goes on with one that was stopped.

    :param folder: what it is written to. Pictures that are there stay; a folder of another scene or other arguments is refused.
    :param count: of pictures.
    :param size: width and height of each, pixels.
    :param seed: another one draws other pictures.
    :param exr: whether to keep the linear pictures beside the displayed ones, in ``linear/``.
    :param client: None for this process; a Client or the address of a scheduler, as :mod:`hairline.cluster` takes them.
    :param render: as :meth:`hairline.Scene.render` takes it.
    """
    count = _whole("count", count, 1, _MOST)
    seed = _whole("seed", seed, 0, 2**31 - 1)
    listed = tuple(defects)
    for i, defect in enumerate(listed):
        if not isinstance(defect, Defect):
            found = f"found an object of type {type(defect).__qualname__}"
            raise argument_error(f"defects[{i}]", found, "must be a hairline.inspect.Defect")
    if len({defect.name for defect in listed}) < len(listed) or len(listed) > 255:
        raise argument_error("defects", f"found {[defect.name for defect in listed]}", "must be at most 255, of different names")
    vary = variation or Variation()
    if not isinstance(vary, Variation):
        raise argument_error("variation", f"found {variation!r}", "must be a hairline.inspect.Variation")
    names = [str(one.name) for one in scene.objects]
    for i, defect in enumerate(listed):
        if defect.object not in names:
            found, right = f'found "{defect.object}"', "must be one of " + ", ".join(f'"{name}"' for name in names)
            raise argument_error(f"defects[{i}].object", found, right)
    recipe = _Recipe(tuple(size), seed, listed, vary, _switch("exr", exr), render)  # type: ignore[arg-type]
    # What is wrong with the scene or a defect is told before any picture.
    drawn(scene, 0, seed=seed, defects=listed, variation=vary)[0].build(size=recipe.size)
    target = FilePath(folder)
    head = {
        "hairline": core.__version__,
        "scene": core.digest(scene.to_dict()),
        "seed": seed,
        "size": list(recipe.size),
        "defects": [asdict(defect) for defect in listed],
        "variation": asdict(vary),
        "exr": recipe.exr,
        "render": dict(render),
    }
    head = json.loads(json.dumps(head))
    known = target / "manifest.json"
    if known.exists():
        before = json.loads(known.read_text(encoding="utf-8"))
        wrong = [key for key in head if before.get(key) != head[key]]
        if wrong:
            found = f"found a data set with another {wrong[0]}"
            raise argument_error(f"folder {target}", found, "must be an empty folder, or one that was made with the same arguments")
    _write(target, "manifest.json", json.dumps(head, indent=1).encode())
    due = [i for i in range(count) if not (target / f"labels/{i:06d}.json").exists()]
    host = Host(progress)

    def keep(files: dict[str, bytes]) -> None:
        for name, contents in files.items():
            _write(target, name, contents)

    if client is None:
        try:
            for done, number in enumerate(due):
                host.progress("rendering", done / len(due))
                keep(_made(scene, number, recipe))
        finally:
            host.close()
    elif due:
        from . import cluster

        with cluster._connected(client) as connected:
            parcel = cluster._sent(connected, scene)
            futures = [connected.submit(_on_worker, parcel, i, recipe, pure=False) for i in due]
            for _, files in cluster._results(futures, host, "rendering"):
                keep(files)
    _assemble(target, head, count, listed)
    return target


def _assemble(target: FilePath, head: dict[str, Any], count: int, defects: tuple[Defect, ...]) -> None:
    """Writes what tells of all pictures, from what each has."""
    images: list[dict[str, Any]] = []
    annotations: list[dict[str, Any]] = []
    pictures = []
    for number in range(count):
        record = json.loads((target / f"labels/{number:06d}.json").read_text(encoding="utf-8"))
        width, height = record["size"]
        images.append({"id": number, "file_name": f"images/{number:06d}.png", "width": width, "height": height})
        for one in record["annotations"]:
            annotations.append({"id": len(annotations) + 1, "image_id": number, **one})
        pictures.append({"number": number, "drawn": record["drawn"]})
    coco = {
        "info": {"description": "made by hairline.inspect", "version": head["hairline"]},
        "images": images,
        "annotations": annotations,
        "categories": [{"id": i + 1, "name": one.name, "supercategory": "scratch"} for i, one in enumerate(defects)],
    }
    _write(target, "annotations.json", json.dumps(coco).encode())
    _write(target, "manifest.json", json.dumps({**head, "count": count, "pictures": pictures}, indent=1).encode())
    _write(target, "README.md", _card(head, images, annotations, defects).encode())


def _card(head: dict[str, Any], images: list[Any], annotations: list[Any], defects: tuple[Defect, ...]) -> str:
    """The card: what is in the folder, how it was made, and what it is not."""
    text = io.StringIO()
    width, height = head["size"]
    text.write(f"# {len(images)} labelled pictures of a scratched surface\n\n")
    text.write(f"Made by `hairline.inspect.dataset` of Hairline {head['hairline']}, seed {head['seed']}, {width} x {height} pixels.\n\n")
    text.write("| class | id | annotations | pictures with one | width, um | depth, nm | length, m |\n|---|---|---|---|---|---|---|\n")
    for i, one in enumerate(defects):
        own = [it for it in annotations if it["category_id"] == i + 1]
        seen = len({it["image_id"] for it in own})
        text.write(f"| {one.name} | {i + 1} | {len(own)} | {seen} | {one.width_um} | {one.depth_nm} | {one.length_m} |\n")
    text.write(
        "\n| file | holds |\n|---|---|\n"
        "| `images/` | displayed pictures, 8 bits, sRGB |\n"
        "| `masks/` | the class of each pixel, 0 for none; where defects cross, that of the later one |\n"
        "| `annotations.json` | COCO: polygons along the borders of pixels, and the same as run lengths in `rle` |\n"
        "| `labels/` | the same, picture by picture, with all that was drawn for it |\n"
        "| `manifest.json` | arguments, and what was drawn for each picture |\n\n"
        "A pixel belongs to a defect where the defect's middle line goes through it, or within half its width where it is wider than a pixel. "
        f"Defects of less than {_LEAST_PX} pixels are not annotated. A defect is annotated wherever it lies in view, whether its light reaches the camera "
        "or not.\n\nThe surface is made up: it has no dust, stains or noise of a sensor. What was varied, and by how much, is in `manifest.json`.\n"
    )
    return text.getvalue()
