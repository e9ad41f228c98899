"""Work on many machines, by Dask (``pip install 'hairline-render[cluster]'``).

A :class:`dask.distributed.Client`, or the address of a scheduler, is all that it needs; without either the cores of this machine work.
The scene is built here before anything is sent, so that what is wrong with it is told once. Its files travel to each worker once. A
worker that dies loses only what it was doing, which another does again.

    from hairline import cluster

    image = cluster.reference(scene, samples=4096, client="tcp://scheduler:8786")
    for i, image in cluster.render(scene, [{"camera.fov_y_deg": fov} for fov in range(10, 60)]):
        ...

Start workers with one thread each, and let Hairline use the cores: ``dask worker ADDRESS --nthreads 1``.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
import warnings
from collections import OrderedDict
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import Any, Optional, Union

try:
    import dask
    from distributed import Client, Future, LocalCluster, as_completed
    from distributed.scheduler import KilledWorker
except ImportError as missing:  # pragma: no cover
    raise ImportError("hairline.cluster needs Dask: pip install 'hairline-render[cluster]'") from missing

from . import _hairline as core
from ._errors import WorkError, argument_error
from ._changes import Change, changed
from ._hairline import Image
from ._host import Host, Progress
from ._whole_file import write_whole
from ._scene import Scene, render_arguments

__all__ = ["local", "reference", "render", "render_files", "sweep"]

Connection = Union[Client, str, None]


def local(workers: Optional[int] = None) -> Client:
    """A client with workers on this machine, each with its share of the cores."""
    cores = os.cpu_count() or 1
    count = workers or cores
    environment = {"RAYON_NUM_THREADS": str(max(1, cores // count))}
    # A local cluster drops a worker that does not come back in this time, and waits for ever once all are dropped. On a machine that is
    # busy the default of 15 s is too short for a process to start.
    if dask.config.get("distributed.deploy.lost-worker-timeout", "15s") == "15s":
        dask.config.set({"distributed.deploy.lost-worker-timeout": "10 minutes"})
    cluster = LocalCluster(
        n_workers=count, threads_per_worker=1, processes=True, dashboard_address=None, env=environment
    )
    client: Client = Client(cluster)
    return client


@contextmanager
def _connected(client: Connection) -> Iterator[Client]:
    if isinstance(client, Client):
        yield client
        return
    if client is not None and not isinstance(client, str):
        raise argument_error("client", f"found an object of type {type(client).__qualname__}", "must be a Client or an address")
    own = local() if client is None else Client(client)
    cluster = own.cluster
    try:
        yield own
    finally:
        own.close()
        if client is None and cluster is not None:
            cluster.close()


class _Parcel:
    """A scene as it travels: its table, and its files with their places below its folder."""

    def __init__(self, scene: Scene) -> None:
        self.table = scene.to_dict()
        self.files: list[tuple[str, bytes]] = []
        for path in sorted(set(core.inputs(self.table, scene.folder))):
            try:
                # The path as written: a worker finds it in the same way below another folder.
                place = os.path.normpath(Path(path).relative_to(scene.folder))
            except ValueError:
                place = os.pardir
            if place.startswith(os.pardir):
                where = f"{path} (of the scene in {scene.folder})"
                raise argument_error(where, "found a file that is not below the scene's folder", "move it there, so that it can travel")
            self.files.append((Path(place).as_posix(), Path(path).read_bytes()))
        digest = hashlib.sha256(core.digest(self.table).encode())
        for name, contents in self.files:
            digest.update(name.encode() + b"\0" + hashlib.sha256(contents).digest())
        self.name = digest.hexdigest()[:32]


def _itself(parcel: _Parcel) -> _Parcel:
    return parcel


def _sent(client: Client, scene: Scene) -> Future:
    """The scene, which workers hand on to one another. It is the result of work: what is scattered is lost where all die that had it."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Sending large graph")
        return client.submit(_itself, _Parcel(scene), pure=False)


class _Unpacked:
    """A parcel on a worker: its folder lives as long as it is kept."""

    def __init__(self, parcel: _Parcel) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="hairline-")
        for name, contents in parcel.files:
            path = Path(self.folder.name, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(contents)
        self.table = parcel.table
        # The builder keeps the parts that changes leave alone.
        self.builder = core.Builder()

    def scene(self, change: Change) -> Scene:
        scene = Scene.from_dict(changed(self.table, change), self.folder.name)
        scene._builder = self.builder
        return scene


_KEPT: OrderedDict[str, _Unpacked] = OrderedDict()
_MOST_KEPT = 2


def _unpacked(parcel: _Parcel) -> _Unpacked:
    kept = _KEPT.pop(parcel.name, None) or _Unpacked(parcel)
    _KEPT[parcel.name] = kept
    while len(_KEPT) > _MOST_KEPT:
        _KEPT.popitem(last=False)
    return kept


def _render_on_worker(parcel: _Parcel, change: Change, arguments: Mapping[str, Any]) -> Image:
    return _unpacked(parcel).scene(change).render(**arguments)


def _file_on_worker(parcel: _Parcel, change: Change, ending: str, arguments: Mapping[str, Any]) -> bytes:
    with tempfile.TemporaryDirectory(prefix="hairline-") as folder:
        path = Path(folder, f"picture{ending}")
        _unpacked(parcel).scene(change).render(**arguments).save(path)
        return path.read_bytes()


def _strip_on_worker(
    parcel: _Parcel,
    rows: tuple[int, int],
    samples: int,
    before: Optional[Image],
    arguments: Mapping[str, Any],
) -> Image:
    keys = {"time_s": None, "progress": False, **arguments}
    return _unpacked(parcel).scene({})._reference(rows=rows, samples=samples, resume=before, **keys)


def _results(
    futures: Sequence[Future], host: Host, what: str, wanted: Optional[Container[str]] = None
) -> Iterator[tuple[Future, Any]]:
    """What is done, in the order in which it is; a failure ends all. What is not ``wanted``, by its key, stays where it is, and is
    forgotten there once nobody needs it."""
    done = 0
    left = {future.key: future for future in futures}
    host.progress(what, 0.0)
    try:
        for future in as_completed(futures):
            is_wanted = wanted is None or future.key in wanted
            try:
                result = future.result() if is_wanted or future.status != "finished" else None
            except KilledWorker as killed:
                raise WorkError(f"a piece of the work killed every worker that had it: {killed}") from killed
            if not is_wanted and left.pop(future.key, None):
                future.release()
            done += 1
            host.progress(what, done / len(futures))
            if is_wanted:
                yield future, result
    finally:
        # All of them are of no use to anybody else.
        for future in left.values():
            future.cancel()
        host.close()


def render(
    scene: Scene,
    changes: Iterable[Change],
    *,
    client: Connection = None,
    progress: Progress = False,
    **arguments: Any,
) -> Iterator[tuple[int, Image]]:
    """Renders a scene once for each change, and yields each picture with the number of its change as soon as it is there.

    :param changes: values by the way to their keys.
    :param client: a Client, the address of a scheduler, or None for this machine.
    :param arguments: as :meth:`hairline.Scene.render` takes them.
    """
    listed = _checked(scene, changes, arguments)
    host = Host(progress)
    with _connected(client) as connected:
        parcel = _sent(connected, scene)
        futures = [
            connected.submit(_render_on_worker, parcel, change, arguments, pure=False) for change in listed
        ]
        numbers = {future.key: i for i, future in enumerate(futures)}
        for future, image in _results(futures, host, "rendering"):
            yield numbers[future.key], image


def render_files(
    scene: Scene,
    changes: Iterable[Change],
    pattern: Union[str, "os.PathLike[str]"],
    *,
    client: Connection = None,
    progress: Progress = False,
    **arguments: Any,
) -> list[Path]:
    """Renders a scene once for each change, to a file each: whole or not there. Files that are there already are left as they are, so a
    run that was stopped goes on; delete them where the scene has changed.

    :param pattern: ``"frames/{:04d}.exr"``: the path of each, by the number of its change, from 0.
    """
    listed = _checked(scene, changes, arguments)
    paths = [Path(os.fspath(pattern).format(i)) for i in range(len(listed))]
    if len(set(paths)) < len(paths):
        raise argument_error("pattern", f"found {os.fspath(pattern)!r}", 'must hold a place for the number, as in "{:04d}.png"')
    ending = Path(os.fspath(pattern)).suffix
    if ending.lower() not in (".png", ".exr"):
        raise argument_error("pattern", f"found the ending {ending!r}", "must be .png or .exr")
    due = [i for i, path in enumerate(paths) if not path.exists()]
    if not due:
        return paths
    for path in {path.parent for path in paths}:
        path.mkdir(parents=True, exist_ok=True)
    host = Host(progress)
    with _connected(client) as connected:
        parcel = _sent(connected, scene)
        futures = [
            connected.submit(_file_on_worker, parcel, listed[i], ending, arguments, pure=False) for i in due
        ]
        numbers = {future.key: i for i, future in zip(due, futures)}
        for future, contents in _results(futures, host, "rendering"):
            write_whole(paths[numbers[future.key]], contents)
    return paths


def sweep(
    scene: Scene,
    values: Mapping[str, Sequence[Any]],
    *,
    client: Connection = None,
    progress: Progress = False,
    **arguments: Any,
) -> Iterator[tuple[dict[str, Any], Image]]:
    """Renders a scene for all combinations of values, and yields each picture with its values as soon as it is there.

    :param values: ``{"scratches[0].depth_nm": [50, 100, 150], "material[0].metal": ["gold", "steel"]}``
    """
    changes = [dict(zip(values, combination)) for combination in product(*values.values())]
    for i, image in render(scene, changes, client=client, progress=progress, **arguments):
        yield changes[i], image


def reference(
    scene: Scene,
    *,
    samples: int = 1024,
    samples_each: Optional[int] = None,
    rows_each: Optional[int] = None,
    size: Optional[tuple[int, int]] = None,
    model: str = "separable",
    shadows: bool = False,
    bounces: int = 0,
    mask: str = "energy",
    sample_seed: int = 0,
    client: Connection = None,
    progress: Progress = False,
) -> Image:
    """Samples a reference in pieces: strips of rows, and of each strip ranges of samples, one after the other as ``--resume`` does.

    A sample depends on its pixel, its number and the seed alone, so the picture is that of :meth:`hairline.Scene.reference` bit for
    bit, whatever the pieces and whoever does them.

    :param samples: of each pixel, rounded up to whole batches.
    :param samples_each: of a piece. A worker that dies loses so many. Default: all.
    :param rows_each: rows of a strip. Default: four strips for each worker, and 8 rows at least.
    """
    scene = Scene._of(core.check(scene._sized(size)), scene.folder)
    # Errors in the scene or the arguments are reported here, once.
    arguments = {
        "size": None,
        "model": model,
        "shadows": shadows,
        "bounces": bounces,
        "mask": mask,
        "sample_seed": sample_seed,
    }
    for key, value in (("samples", samples), ("samples_each", samples_each), ("rows_each", rows_each)):
        is_whole = isinstance(value, int) and not isinstance(value, bool) and value > 0
        if not is_whole and (value is not None or key == "samples"):
            raise argument_error(key, f"found {value!r}", "must be a whole number above 0")
    scene._reference(rows=(0, 0), samples=1, time_s=None, resume=None, progress=False, **arguments)  # type: ignore[arg-type]
    height = scene.settings.size_px[1]
    host = Host(progress)
    with _connected(client) as connected:
        workers = max(1, len(connected.scheduler_info()["workers"]))
        each = rows_each or max(8, -(-height // (4 * workers)))
        steps = [*range(samples_each or samples, samples, samples_each or samples), samples]
        parcel = _sent(connected, scene)
        strips: list[Future] = []
        pieces: list[Future] = []
        for first in range(0, height, each):
            rows = (first, min(first + each, height))
            strip: Optional[Future] = None
            for upto in steps:
                strip = connected.submit(
                    _strip_on_worker, parcel, rows, upto, strip, arguments, pure=False, priority=-upto
                )
                pieces.append(strip)
            if strip is not None:
                strips.append(strip)
        last = {strip.key: i for i, strip in enumerate(strips)}
        done: dict[int, Image] = {}
        for future, image in _results(pieces, host, "sampling", last):
            done[last[future.key]] = image
    return core.assemble([done[i] for i in range(len(strips))])


def _checked(scene: Scene, changes: Iterable[Change], arguments: Mapping[str, Any]) -> list[Change]:
    """Builds the scene, and checks each change and the arguments, here: what is wrong is told once."""
    listed = list(changes)
    render_arguments(**{key: value for key, value in arguments.items() if key != "size"})
    scene.build(size=arguments.get("size"))
    table = scene.to_dict()
    for i, change in enumerate(listed):
        if not isinstance(change, Mapping):
            found = f"found an object of type {type(change).__qualname__}"
            raise argument_error(f"changes[{i}]", found, 'must be a dict, as {"camera.fov_y_deg": 20}')
        core.check(changed(table, change))
    return listed
