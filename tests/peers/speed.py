"""Processor time for a picture of one quality: Hairline beside Mitsuba 3 and Blender's Cycles.

    python3.11 -m venv tests/peers/.venv
    tests/peers/.venv/bin/pip install mitsuba==3.9.1 bpy==5.0.1
    cargo build --release && tests/peers/.venv/bin/python tests/peers/speed.py -o table.md

The scene has no scratches: `scenes/disk-and-ball-on-table.toml`. Metals have the n and k that reflect as theirs do at 0 and at 80 degrees, in red,
green and blue. Each picture is judged against the limit of the same renderer with the same settings, with many samples and other random numbers, by
`hairline compare`, which shows all of them by one tone curve. Times are processor times of a child process: of the whole, and of its second
picture, so that the first one has compiled and loaded what there is to. Hairline makes one picture a process: of that is taken what a picture of
8 x 8 pixels takes. What is compiled is kept by Mitsuba from one process to the next: the least of several runs does not have that in it.
Needs LLVM's shared library, for Mitsuba 3.9.1 a newer one than 14 (Debian: libllvm19; DRJIT_LIBLLVM_PATH is its path). Debian packages that bpy
needs: libxxf86vm1 libxfixes3 libxi6 libxkbcommon0 libgl1 libsm6 libice6 libegl1. Peers have two threads in all.
"""

import argparse, json, os, resource, subprocess, sys, tempfile, tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def processor_time(usage=None):
    usage = usage or resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


# Cycles. Its own process, which knows nothing of Mitsuba.
def cycles(job):
    import bpy
    import numpy as np
    from mathutils import Matrix, Vector

    scene_file = tomllib.loads(Path(job["scene"]).read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene

    def link(name, data):
        made = bpy.data.objects.new(name, data)
        scene.collection.objects.link(made)
        return made

    def material(m):
        made = bpy.data.materials.new(m["name"])
        made.use_nodes = True
        nodes = made.node_tree.nodes
        nodes.clear()
        if m["name"] in job["metals"]:
            n, k = job["metals"][m["name"]]
            node = nodes.new("ShaderNodeBsdfMetallic")
            node.fresnel_type, node.distribution = "PHYSICAL_CONDUCTOR", "MULTI_GGX"
            node.inputs["IOR"].default_value, node.inputs["Extinction"].default_value = n, k
            node.inputs["Roughness"].default_value = m["roughness"]
        else:
            node = nodes.new("ShaderNodeBsdfDiffuse")
            node.inputs["Color"].default_value = [*m["base_color"], 1]
            node.inputs["Roughness"].default_value = 0
        made.node_tree.links.new(node.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
        return made

    def shape(entry):
        (kind, size), = entry["shape"].items()
        mesh = bpy.data.meshes.new(entry["name"])
        if kind == "plane":
            x, y = (s / 2 for s in size["size_m"])
            points, faces = [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [(0, 1, 2, 3)]
        elif kind == "disk":
            angles = np.arange(256) * 2 * np.pi / 256
            points, faces = [(size["radius_m"] * np.cos(a), size["radius_m"] * np.sin(a), 0) for a in angles], [tuple(range(256))]
        elif kind == "sphere":
            rows, columns = 128, 256
            t, p = np.meshgrid(np.arange(rows + 1) * np.pi / rows, np.arange(columns) * 2 * np.pi / columns, indexing="ij")
            points = size["radius_m"] * np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
            at = lambda r, c: r * columns + c % columns
            faces = [(at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c + 1)) for r in range(1, rows - 1) for c in range(columns)]
            faces += [f for c in range(columns) for f in ((at(0, 0), at(1, c), at(1, c + 1)), (at(rows, 0), at(rows - 1, c + 1), at(rows - 1, c)))]
            points = points.tolist()
        mesh.from_pydata(points, [], faces)
        mesh.polygons.foreach_set("use_smooth", [kind == "sphere"] * len(mesh.polygons))
        mesh.materials.append(materials[entry["material"]])
        made = link(entry["name"], mesh)
        made.location = entry.get("translation_m", [0, 0, 0])

    materials = {m["name"]: material(m) for m in scene_file["material"]}
    for entry in scene_file["object"]:
        shape(entry)
    for i, light in enumerate(scene_file["light"]):
        data = bpy.data.lights.new(f"light {i}", "POINT" if light["kind"] == "sphere" else "AREA")
        data.color = light.get("color", [1, 1, 1])
        made = link(data.name, data)
        made.visible_camera = False
        if light["kind"] == "sphere":
            data.use_soft_falloff, data.shadow_soft_size = False, light["radius_m"]
            made.location = light["center_m"]
            data.energy = light["radiance"] * 4 * np.pi**2 * light["radius_m"]**2
            continue
        v = [Vector(p) for p in light["vertices_m"]]
        x, y = v[1] - v[0], v[3] - v[0]
        data.shape, data.size, data.size_y = "RECTANGLE", x.length, y.length
        data.energy = light["radiance"] * np.pi * x.length * y.length
        # It shines along its -Z, and the polygon to where its vertices are seen counter-clockwise.
        front = x.cross(y).normalized()
        axes = Matrix((x.normalized(), -y.normalized(), -front)).transposed()
        made.matrix_world = Matrix.Translation((v[0] + v[2]) / 2) @ axes.to_4x4()
    world = bpy.data.worlds.new("black")
    scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    c = scene_file["camera"]
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle_y, data.clip_start, data.clip_end = "VERTICAL", np.radians(c["fov_y_deg"]), 0.001, 100
    camera = link("camera", data)
    back = (Vector(c["position_m"]) - Vector(c["target_m"])).normalized()
    right = Vector(c["up"]).cross(back).normalized()
    camera.matrix_world = Matrix.Translation(c["position_m"]) @ Matrix((right, back.cross(right), back)).transposed().to_4x4()
    scene.camera = camera

    render, own = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = *job["size"], 100
    render.threads_mode, render.threads = "FIXED", 2
    own.device, own.samples, own.use_adaptive_sampling = "CPU", job["samples"], False
    # Gaussian: the width counts in four standard deviations.
    own.pixel_filter_type, own.filter_width = "GAUSSIAN", 4 * scene_file.get("render", {}).get("filter_std_px", 0.5)
    own.use_denoising = job["denoise"]
    if job["depth"] == "equal":
        own.max_bounces, own.diffuse_bounces, own.glossy_bounces = 1, 1, 1
        own.sample_clamp_indirect, own.blur_glossy = 0, 0
    render.image_settings.file_format, render.image_settings.color_mode = "OPEN_EXR", "RGB"
    render.image_settings.color_depth, render.image_settings.exr_codec = "32", "NONE"

    def picture(seed):
        own.seed = seed
        start = processor_time()
        bpy.ops.render.render()
        return processor_time() - start

    picture(job["seed"])
    bpy.data.images["Render Result"].save_render(job["target"])
    whole = processor_time()
    return picture(job["seed"]) if job["again"] else whole, whole, bpy.app.version_string


def mitsuba(job):
    sys.path.insert(0, str(HERE))
    import peer
    import mitsuba as mi
    mi.set_variant(job["variant"])
    peer.mi.set_variant(job["variant"])
    path = Path(job["scene"])
    scene = tomllib.loads(path.read_text())

    def bsdf(m):
        if m["name"] not in job["metals"]:
            return {"type": "diffuse", "reflectance": {"type": "rgb", "value": m["base_color"]}}
        n, k = ({"type": "rgb", "value": v} for v in job["metals"][m["name"]])
        return {"type": "roughconductor", "distribution": "ggx", "alpha": m["roughness"]**2, "eta": n, "k": k}

    materials = {m["name"]: bsdf(m) for m in scene["material"]}
    made = {"type": "scene"}
    for i, light in enumerate(peer.lamps(scene, path.parent).shapes()):
        made[f"light{i}"] = light
    for entry in scene["object"]:
        made[entry["name"]] = peer.shapes(entry, path.parent, bsdf=materials[entry["material"]])[0][0]
    c = scene["camera"]
    width, height = job["size"]
    made["sensor"] = {
        "type": "perspective", "fov": c["fov_y_deg"], "fov_axis": "y", "near_clip": 0.001, "far_clip": 100.0,
        "to_world": mi.ScalarTransform4f().look_at(c["position_m"], c["target_m"], c["up"]),
        "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb", "component_format": "float32",
                 "rfilter": {"type": "gaussian", "stddev": scene.get("render", {}).get("filter_std_px", 0.5)}},
        "sampler": {"type": job["sampler"], "sample_count": job["samples"]}}
    # Depths of paths: 2 is direct light. Mitsuba's own default has no end but Russian roulette's.
    made["integrator"] = {"type": "path", "max_depth": 3 if job["depth"] == "equal" else -1}
    world = mi.load_dict(made)

    def picture(seed, samples):
        import numpy as np
        start = processor_time()
        pixels = np.array(mi.render(world, spp=samples, seed=seed))
        return processor_time() - start, pixels

    def all_of_it():
        # In parts, where one would not fit into memory.
        parts = max(1, job["samples"] // 256)
        done = [picture(job["seed"] + 1000 * i, job["samples"] // parts) for i in range(parts)]
        return sum(t for t, _ in done), sum(p for _, p in done) / parts

    mi.Bitmap(all_of_it()[1]).write(job["target"])
    whole = processor_time()
    return all_of_it()[0] if job["again"] else whole, whole, mi.__version__


def worker(job):
    print("RESULT " + json.dumps({"cycles": cycles, "mitsuba": mitsuba}[job["renderer"]](job)))
    sys.stdout.flush()
    # bpy does not end by itself after a render.
    os._exit(0)


# Everything else.
def child(command, log):
    """Processor time of the whole, and what it says."""
    with open(log, "w+") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        out.seek(0)
        text = out.read()
    if status:
        sys.exit(f"{command}: {text}")
    return processor_time(usage), text


def index_of_three(reflectance):
    """n and k of red, green and blue that reflect so at 0 and 80 degrees."""
    import numpy as np

    def reflects(n, k, c):
        s2, nk = 1 - c * c, n * n - k * k
        a2b2 = np.sqrt((nk - s2)**2 + 4 * n * n * k * k)
        a = np.sqrt(np.maximum((a2b2 + nk - s2) / 2, 0))
        s = (a2b2 + c * c - 2 * a * c) / (a2b2 + c * c + 2 * a * c)
        return s * (1 + (a2b2 * c * c + s2 * s2 - 2 * a * c * s2) / (a2b2 * c * c + s2 * s2 + 2 * a * c * s2)) / 2

    n = np.geomspace(0.02, 8, 4000)
    indices, extinctions = [], []
    for straight, grazing in reflectance.T:
        # Of the n and k with this reflectance straight on, those that are nearest at 80 degrees.
        k2 = (straight * (n + 1)**2 - (n - 1)**2) / (1 - straight)
        k = np.sqrt(np.maximum(k2, 0))
        off = np.where(k2 >= 0, abs(reflects(n, k, np.cos(np.radians(80))) - grazing), np.inf)
        indices.append(float(n[off.argmin()])), extinctions.append(float(k[off.argmin()]))
    return indices, extinctions


def metals(path):
    sys.path.insert(0, str(HERE))
    import numpy as np
    import peer
    scene = tomllib.loads(path.read_text())
    cosines = np.array([np.cos(np.radians(80)), 1.0])
    return {m["name"]: index_of_three(peer.fresnel_table(m, cosines)[0][::-1]) for m in scene["material"] if m["kind"] == "metal"}


class Bench:
    def __init__(self, args):
        self.args, self.folder = args, args.keep
        self.metals = metals(args.scene)
        self.versions = {}

    def render(self, renderer, name, samples, seed, again, **job):
        """Processor time of the picture, that of the whole, and the picture. What is kept is not made again."""
        target, kept = self.folder / f"{name}.exr", self.folder / f"{name}.json"
        if not kept.exists():
            kept.write_text(json.dumps(self.least(renderer, target, samples, seed, again, job)))
        seconds, whole, version = json.loads(kept.read_text())
        self.versions[renderer] = version
        if renderer == "hairline" and again and "size" not in job:
            seconds = whole - self.render(renderer, "start-up", 1, 0, True, flags=[], size="8x8")[1]
        return seconds, whole, target

    def least(self, renderer, target, samples, seed, again, job):
        if renderer == "hairline":
            command = [self.args.hairline, "render", "--backend", "cpu", str(self.args.scene), "-o", str(target), "--size",
                       job.get("size", "{}x{}".format(*self.args.size)), "--samples", str(samples), *job["flags"]]
        else:
            job |= {"renderer": renderer, "scene": str(self.args.scene), "size": self.args.size, "samples": samples, "seed": seed,
                    "target": str(target), "metals": self.metals, "again": again}
            command = [sys.executable, __file__, "--worker", json.dumps(job)]
        best, version = [float("inf")] * 2, ""
        for _ in range(self.args.runs if again else 1):
            whole, text = child(command, target.with_suffix(".txt"))
            seconds = whole
            if renderer != "hairline":
                seconds, whole, version = json.loads(next(l for l in text.splitlines() if l.startswith("RESULT "))[7:])
            best = [min(best[0], seconds), min(best[1], whole)]
            if whole > 8:
                break
        return *best, version

    def limit(self, renderer, name, samples, **job):
        """The mean of pictures with other random numbers: one of all samples has no place in memory, or cannot go on."""
        each = samples if renderer == "hairline" else min(samples, 1024)
        parts = [self.render(renderer, f"limit-{name}-{i}", each, 77 + i, False, **job)[2] for i in range(samples // each)]
        if len(parts) == 1:
            return parts[0]
        import numpy as np
        from peer import mi
        mi.set_variant("scalar_rgb")
        target = self.folder / f"limit-{name}.exr"
        pixels = sum(np.array(mi.Bitmap(str(p)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)) for p in parts) / len(parts)
        mi.Bitmap(pixels.astype(np.float32)).write(str(target))
        return target

    def apart(self, a, b):
        found = subprocess.run([self.args.hairline, "compare", str(a), str(b), "--json"], check=True, capture_output=True, text=True)
        layers = json.loads(found.stdout)["layers"]
        return layers.get("beauty") or next(iter(layers.values()))


def rows(args):
    """Renderer's name in the table, program, name of the limit, the limit's samples, samples, settings of both."""
    exact = dict(flags=["--filter", "off"])
    for name, flags in (("Hairline", []), ("Hairline, `--filter off`", exact["flags"])):
        yield name, "hairline", "hairline", args.own_limit, [1, 2, 4, 8, 16, 32, 64], dict(flags=flags), exact
    for depth in ("equal", "default"):
        for variant, counts in (("llvm_ad_rgb", [1, 4, 16, 64, 256, 1024]), ("scalar_rgb", [1, 4, 16, 64])):
            if depth == "default":
                counts = [16, 256] if variant == "llvm_ad_rgb" else []
            job = dict(depth=depth, variant=variant, sampler="multijitter")
            exact = dict(depth=depth, variant="llvm_ad_rgb", sampler="multijitter")
            name = f"Mitsuba, {variant}" + (", any depth" if depth == "default" else "")
            yield name, "mitsuba", f"mitsuba-{depth}", args.limit, counts, job, exact
        for denoise, counts in ((False, [1, 4, 16, 64]), (True, [1, 4, 16, 64])):
            name = "Cycles" + (" + OIDN" if denoise else "") + (", its defaults" if depth == "default" else "")
            counts = counts[2:4] if depth == "default" else counts
            yield name, "cycles", f"cycles-{depth}", args.cycles_limit, counts, dict(depth=depth, denoise=denoise), dict(depth=depth, denoise=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    parser.add_argument("--scene", type=Path, default=HERE / "scenes/disk-and-ball-on-table.toml")
    parser.add_argument("--hairline", default=str(ROOT / "target/release/hairline"))
    parser.add_argument("--size", type=lambda s: [int(n) for n in s.split("x")], default=[480, 270])
    parser.add_argument("--only", default="", help="rows whose name begins so")
    parser.add_argument("--limit", type=int, default=8192, help="samples of Mitsuba's limit")
    parser.add_argument("--cycles-limit", type=int, default=2048, help="samples of Cycles's limit")
    parser.add_argument("--own-limit", type=int, default=1024, help="samples of Hairline's limit")
    parser.add_argument("--runs", type=int, default=3, help="the least time of so many")
    parser.add_argument("--keep", type=Path, help="a folder for pictures and times; what is there is not made again")
    parser.add_argument("-o", "--output", type=Path, help="a file for the table")
    args = parser.parse_args()
    if args.worker:
        worker(json.loads(args.worker))
    with tempfile.TemporaryDirectory() as temporary:
        args.keep = (args.keep or Path(temporary)).resolve()
        args.keep.mkdir(exist_ok=True)
        bench = Bench(args)
        lines = ["| renderer | samples | the picture, s | with start-up, s | FLIP | rms |", "|---|---:|---:|---:|---:|---:|"]
        print("\n".join(lines), flush=True)
        limits = {}
        for name, program, limit_name, limit_samples, counts, job, limit_job in rows(args):
            if not name.startswith(args.only):
                continue
            if limit_name not in limits:
                limits[limit_name] = bench.limit(program, limit_name, limit_samples, **limit_job)
            for samples in counts:
                stem = "".join(c if c.isalnum() else "-" for c in f"{name}-{samples}")
                seconds, whole, picture = bench.render(program, stem, samples, 0, True, **dict(job))
                found = bench.apart(picture, limits[limit_name])
                line = f"| {name} | {samples} | {seconds:.1f} | {whole:.1f} | {found['flip']:.4f} | {100 * found['relative-rms']:.1f} % |"
                lines.append(line)
                print(line, flush=True)
        pairs = [(a, b) for a in sorted(limits) for b in sorted(limits) if a < b]
        lines += ["", "| limits | FLIP | rms |", "|---|---:|---:|"]
        for a, b in pairs:
            found = bench.apart(limits[a], limits[b])
            lines.append(f"| {a}, {b} | {found['flip']:.4f} | {100 * found['relative-rms']:.1f} % |")
        print("\n".join(lines[-len(pairs) - 2:]))
        print(bench.versions)
    if args.output:
        args.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
