"""Measures what docs/python.md says: `python crates/python/tests/figures.py [bsdf import memory arrays cluster]`."""

import os
import resource
import subprocess
import sys
import time

import numpy as np

import hairline
from conftest import lines_on_plate, plate_table


def resident_mb():
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * resource.getpagesize() / 1e6


def import_time():
    script = "import numpy, time; t = time.perf_counter(); import hairline; print(time.perf_counter() - t)"
    with_numpy = script.replace("import numpy, time", "import time")
    for name, script in (("with numpy", with_numpy), ("beside numpy", script)):
        times = [float(subprocess.check_output([sys.executable, "-c", script])) for _ in range(9)]
        print(f"import, {name}: {1e3 * np.median(times):.0f} ms")


def memory():
    """Of a picture of 4K: what the process has more with it than without."""
    scene = hairline.Scene.from_dict({**plate_table(), "light": [], "scratches": []})
    scene.render(size=(64, 64), backend="cpu")
    before = resident_mb()
    image = scene.render(size=(3840, 2160), samples=1, backend="cpu")
    held = resident_mb()
    arrays = [image.base, image.scratches, image.density, image.normal, image.depth_m]
    total = sum(int(array.sum() > -1) * array.nbytes for array in arrays) / 1e6
    seen = resident_mb()
    beauty = image.beauty.nbytes / 1e6
    print(
        f"3840 x 2160: layers of {total:.0f} MB; {held - before:.0f} MB more with the picture, {seen - before:.0f} MB with its arrays, "
        f"{resident_mb() - before:.0f} MB with the beauty ({beauty:.0f} MB)"
    )


def arrays():
    count = 1_000_000
    ends = lines_on_plate(count)
    widths, depths = np.full(count, 2.0), np.full(count, 150.0)
    start = time.perf_counter()
    layer = hairline.Scratches.from_arrays(object="plate", ends_m=ends, width_um=widths, depth_nm=depths)
    taken = time.perf_counter()
    scene = hairline.Scene.from_dict({**plate_table(), "scratches": []})
    scene.scratches.append(layer)
    built = scene.build()
    laid = time.perf_counter()
    assert built.scratch_counts() == [count]
    print(f"{count} scratches: taken over in {taken - start:.2f} s, laid in {laid - taken:.2f} s")


def processor_s(pids):
    """Seconds that processes have had of all cores."""
    import psutil

    times = [psutil.Process(pid).cpu_times() for pid in pids]
    return sum(time.user + time.system for time in times)


def on_cluster():
    from hairline import cluster

    scene = hairline.Scene.from_dict(plate_table())
    size, samples = (320, 200), 512
    # One thread each way, so that workers are compared and not cores.
    single = [sys.executable, __file__, "single"]
    one_thread = {**os.environ, "RAYON_NUM_THREADS": "1"}
    seconds, processor = map(float, subprocess.check_output(single, env=one_thread).split())
    print(f"reference, {size[0]} x {size[1]}, {samples} samples: one process of one thread {seconds:.1f} s, {processor:.1f} s of a processor")
    for workers in (1, 2, 4):
        client = cluster.local(workers)
        # Their first piece imports and builds.
        cluster.reference(scene, size=size, samples=64, client=client)
        pids = list(client.run(os.getpid).values())

        def timed(**how):
            start, own, theirs = time.perf_counter(), processor_s([os.getpid()]), processor_s(pids)
            image = cluster.reference(scene, client=client, **how)
            taken = time.perf_counter() - start
            return image, taken, processor_s([os.getpid()]) - own, processor_s(pids) - theirs

        image, taken, own, theirs = timed(size=size, samples=samples)
        print(f"{workers} workers: {taken:.1f} s; of a processor {theirs:.1f} s on them, {own:.1f} s here")
        # Next to no work: what is left is what a piece costs.
        pieces = 200
        _, taken, own, theirs = timed(size=(1, pieces), samples=64, rows_each=1)
        ms = 1e3 / pieces
        print(f"  {pieces} pieces of a pixel: {ms * taken:.1f} ms each; of a processor {ms * theirs:.1f} ms on them, {ms * own:.1f} ms here")
        local = client.cluster
        client.close()
        local.close()
    import pickle

    print(f"a strip of 8 rows of 4K: {len(pickle.dumps(image)) / image.samples.size * 3840 * 8 / 1e6:.1f} MB")


def single():
    scene = hairline.Scene.from_dict(plate_table())
    scene.reference(size=(8, 8), samples=64)
    start, processor = time.perf_counter(), processor_s([os.getpid()])
    scene.reference(size=(320, 200), samples=512)
    print(time.perf_counter() - start, processor_s([os.getpid()]) - processor)


def bsdf():
    """Pairs of directions a second, by the clock and of a processor."""
    from hairline.bsdf import Layer, Scratched

    layer = Layer(width_um=(2.0, 0.2), depth_nm=(160.0, 0.2), coverage=0.03)
    material = Scratched("steel", roughness=0.3, layers=[layer])
    random, count = np.random.default_rng(1), 10_000_000

    def directions():
        drawn = random.normal(size=(count, 3))
        drawn[:, 2] = np.abs(drawn[:, 2])
        return drawn / np.linalg.norm(drawn, axis=1)[:, None]

    wi, wo, u = directions(), directions(), random.random((count, 3))
    for name, work in {
        "mean of the layer": lambda: material.eval(wi, wo, part="scratches"),
        "with the base": lambda: material.eval(wi, wo),
        "density": lambda: material.pdf(wi, wo),
        "samples": lambda: material.sample(wo, u),
    }.items():
        start, processor = time.perf_counter(), time.process_time()
        work()
        print(f"{name}: {time.perf_counter() - start:.2f} s, of a processor {time.process_time() - processor:.2f} s for {count} rows")


if __name__ == "__main__":
    parts = {"bsdf": bsdf, "import": import_time, "memory": memory, "arrays": arrays, "cluster": on_cluster, "single": single}
    for name in sys.argv[1:] or ["import", "memory", "arrays", "cluster"]:
        parts[name]()
