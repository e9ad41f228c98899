"""Renders scenes of Hairline with Mitsuba 3 and says how far apart the two are.

    python3 -m venv tests/peers/.venv
    tests/peers/.venv/bin/pip install mitsuba
    cargo build --release && tests/peers/.venv/bin/python tests/peers/peer.py

Mitsuba gives shapes and rays, lights and how they are sampled, visible normals, the Fresnel equations, CIE functions and D65. What is
written here is the integrator (direct light alone, no shadows: the light transport of `hairline render`), height-correlated Smith
shadowing, and the factor for multiple scattering and the diffuse body of docs/model.md, section 8, with albedos by quadrature. Metals
are computed at each wavelength from the n and k of crates/optics/data/metals.csv and become colours last.
Needs LLVM's shared library (Debian: libllvm14). Scenes: `tests/peers/scenes` and arguments, TOML files with spheres, planes, disks, smooth
lathes, .glb meshes, sphere and polygon lamps, a map. `ASSETS/` in a path is the folder $HAIRLINE_ASSETS. Of a mesh with a material of the scene
all nodes are shown; of one with its own, the first primitive, with explicit tangents where there is a normal map. Scenes whose files are not
there are left out: `make_bumpy.py` writes them.
"""

import argparse, json, os, struct, subprocess, sys, tempfile, tomllib
from pathlib import Path

import numpy as np
import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402
from drjit.llvm import TensorXf  # noqa: E402

# From the axes of a file whose top is +Y to those of a scene whose top is +Z.
Y_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
PI = np.pi


# Colours: reflectances at each nanometre, under D65, seen by the observer of 1931, in Rec.709.
def rgb_weights():
    nm = np.arange(380.0, 781.0)
    xyz = np.array(mi.cie1931_xyz(mi.Float(nm)))
    rec709 = np.array([[3.240969942, -1.537383178, -0.498610760], [-0.969243636, 1.875967502, 0.041555057],
                       [0.055630080, -0.203976959, 1.056971514]])
    rows = [line.split(",") for line in open(ROOT / "crates/optics/data/cie.csv") if line[0].isdigit()]
    d65 = np.interp(nm, [float(r[0]) for r in rows], [float(r[4]) for r in rows])
    weights = (rec709 @ xyz) * d65
    return nm, weights / weights.sum(axis=1, keepdims=True)


def fresnel_table(material, cosines):
    """(F, F times F at normal incidence), each in Rec.709; the second is what multiple scattering reflects."""
    kind = material["kind"]
    if kind == "metal" and "metal" in material:
        name = {"steel": "stainless_steel"}.get(material["metal"], material["metal"])
        lines = open(ROOT / "crates/optics/data/metals.csv").read().splitlines()
        header = next(line for line in lines if line.startswith("wavelength")).split(",")
        rows = np.array([[float(x) for x in line.split(",")] for line in lines if line[0].isdigit()])
        nm, weights = rgb_weights()
        n = np.interp(nm, rows[:, 0], rows[:, header.index(name + "_n")])
        k = np.interp(nm, rows[:, 0], rows[:, header.index(name + "_k")])
        c, nn = [a.ravel() for a in np.meshgrid(cosines, n, indexing="ij")]
        _, kk = [a.ravel() for a in np.meshgrid(cosines, k, indexing="ij")]
        f = np.array(mi.fresnel_conductor(mi.Float(c), dr.llvm.ad.Complex2f(mi.Float(nn), mi.Float(kk))))
        f = f.reshape(len(cosines), len(nm))
        return f @ weights.T, (f * f[-1]) @ weights.T
    if kind == "dielectric":
        ior = material.get("ior", 1.5)
        f = np.array(mi.fresnel(mi.Float(cosines), mi.Float(ior))[0])[:, None].repeat(3, 1)
    else:
        f0 = np.array(material.get("base_color", [1, 1, 1]), float) if kind != "mirror" else np.ones(3)
        f = f0 + (1 - f0) * (1 - cosines[:, None]) ** 5
    return f, f * f[-1]


# GGX, F = 1, the cosine inside: D G2 / (4 cos_o), height-correlated.
def ggx(wi_z, wo_z, h_z, alpha, sqrt):
    a2 = alpha * alpha
    d = a2 / (PI * (h_z * h_z * (a2 - 1) + 1) ** 2)
    rough = lambda c: sqrt(a2 + (1 - a2) * c * c)
    return d * 0.5 * wi_z / (wo_z * rough(wi_z) + wi_z * rough(wo_z))


def albedos(alpha, f, cosines, nodes):
    """Directional albedos over the viewer's cosine, for F = 1 and for F: means over visible normals."""
    e0, ef = np.zeros(len(nodes)), np.zeros((len(nodes), 3))
    n = 256
    u, v = np.meshgrid((np.arange(n) + 0.5) / n * 0.5, (np.arange(n) + 0.5) / n, indexing="ij")
    for i, c in enumerate(nodes):
        wo = np.array([np.sqrt(1 - c * c), 0, c])
        std = np.array([alpha * wo[0], 0, wo[2]]); std /= np.linalg.norm(std)
        z = (1 - v) * (1 + std[2]) - std[2]
        r = np.sqrt(np.maximum(1 - z * z, 0))
        h = np.stack([r * np.cos(2 * PI * u) + std[0], r * np.sin(2 * PI * u), z + std[2]])
        h = np.stack([alpha * h[0], alpha * h[1], np.maximum(h[2], 1e-9)]); h /= np.linalg.norm(h, axis=0)
        ch = wo[0] * h[0] + wo[2] * h[2]
        wi_z = 2 * ch * h[2] - c
        rough = lambda c: np.sqrt(alpha**2 + (1 - alpha**2) * c * c)
        ok = wi_z > 0
        wz = np.where(ok, wi_z, 1)
        weight = np.where(ok, wz * (c + rough(c)) / (c * rough(wz) + wz * rough(c)), 0)
        e0[i] = weight.mean()
        for ch_ in range(3):
            ef[i, ch_] = (weight * np.interp(ch, cosines, f[:, ch_])).mean()
    return e0, ef


class Table:
    """A function of a cosine, by its square root."""

    def __init__(self, values, nodes):
        x = np.linspace(0, 1, 1024)
        values = np.stack([np.interp(x * x, nodes, v) for v in values.T], axis=-1)
        self.texture = mi.Texture1f(TensorXf(values.astype(np.float32)), wrap_mode=dr.WrapMode.Clamp)

    def __call__(self, c):
        x = dr.sqrt(dr.clip(c, 0, 1))
        return self.texture.eval(mi.Point1f((x * 1023 + 0.5) / 1024))


class Material:
    def __init__(self, material):
        roughness = material.get("roughness", 0.1)
        self.alpha = max(roughness**2, 0.002)
        cosines = np.linspace(0, 1, 512) ** 2
        f, ff = fresnel_table(material, cosines)
        nodes = np.maximum(np.linspace(0, 1, 48) ** 2, 1e-4)
        e0, ef = albedos(self.alpha, f, cosines, nodes)
        f0 = f[-1]
        self.fresnel = Table(np.concatenate([f, ff], axis=1), cosines)
        gain = 1 / np.clip(e0, 1e-3, 1) - 1
        self.gain = Table(gain[:, None], nodes)
        # What the surface does not reflect reaches the body.
        body = np.maximum(1 - ef * (1 + f0 * gain[:, None]), 0)
        color = material.get("base_color", [0.5, 0.5, 0.5]) if material["kind"] == "dielectric" else [0, 0, 0]
        self.body = Table(body * np.array(color), nodes)
        self.share = 0.5 if material["kind"] == "dielectric" else 1.0
        self.normals = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)

    def eval(self, wi, wo):
        h = dr.normalize(wi + wo)
        t = self.fresnel(dr.dot(h, wo))
        f = mi.Color3f(t[0], t[1], t[2]) + self.gain(wo.z)[0] * mi.Color3f(t[3], t[4], t[5])
        body = self.body(wo.z)
        value = f * ggx(wi.z, wo.z, h.z, self.alpha, dr.sqrt) + mi.Color3f(body[0], body[1], body[2]) * (wi.z / PI)
        return dr.select((wi.z > 0) & (wo.z > 0), value, 0)

    def pdf(self, wi, wo):
        h = dr.normalize(wi + wo)
        specular = self.normals.pdf(wo, h) / dr.maximum(4 * dr.dot(wo, h), 1e-6)
        return dr.select(wi.z > 0, self.share * specular + (1 - self.share) * wi.z / PI, 0)

    def sample(self, pick, u, wo):
        h, _ = self.normals.sample(wo, u)
        return dr.select(pick < self.share, mi.reflect(wo, h), mi.warp.square_to_cosine_hemisphere(u))


# Geometry.
def transform(entry):
    t = mi.ScalarTransform4f
    rx, ry, rz = entry.get("rotation_deg", [0, 0, 0])
    scale = entry.get("scale", 1.0)
    return (t().translate(entry.get("translation_m", [0, 0, 0])) @ t().rotate([0, 0, 1], rz) @ t().rotate([0, 1, 0], ry)
            @ t().rotate([1, 0, 0], rx) @ t().scale(scale))


def read_glb(path):
    """The file's JSON, and its accessors as arrays."""
    data = open(path, "rb").read()
    length = struct.unpack("<I", data[12:16])[0]
    gltf, binary = json.loads(data[20:20 + length]), data[28 + length:]
    def accessor(i):
        a = gltf["accessors"][i]
        view = gltf["bufferViews"][a["bufferView"]]
        kind = {5126: "<f4", 5123: "<u2", 5125: "<u4"}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[a["type"]]
        begin = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        return np.frombuffer(binary, kind, a["count"] * width, begin).reshape(-1, width)
    return gltf, binary, accessor


def own_material(gltf, binary):
    material = gltf["materials"][gltf["meshes"][0]["primitives"][0]["material"]]
    image = None
    if "normalTexture" in material:
        source = gltf["textures"][material["normalTexture"]["index"]]["source"]
        view = gltf["bufferViews"][gltf["images"][source]["bufferView"]]
        png = binary[view.get("byteOffset", 0):][:view["byteLength"]]
        with tempfile.NamedTemporaryFile(suffix=".png") as f:
            f.write(png); f.flush()
            image = np.array(mi.Bitmap(f.name))[..., :3] / 255.0  # numbers, not colours: not linearised
    pbr = material.get("pbrMetallicRoughness", {})
    return image, {"kind": "metallic-roughness", "base_color": pbr.get("baseColorFactor", [1, 1, 1, 1])[:3],
                   "roughness": pbr.get("roughnessFactor", 1.0)}


def placed_primitives(gltf, node=None, above=np.eye(4)):
    """Every primitive of the scene, with the matrix that places it."""
    if node is None:
        return [p for n in gltf["scenes"][0]["nodes"] for p in placed_primitives(gltf, n)]
    node = gltf["nodes"][node]
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    here = np.eye(4)
    here[:3, :3], here[:3, 3] = turn * node.get("scale", [1, 1, 1]), node.get("translation", [0, 0, 0])
    here = above @ here
    own = [(p, here) for p in gltf["meshes"][node["mesh"]]["primitives"]] if "mesh" in node else []
    return own + [p for n in node.get("children", []) for p in placed_primitives(gltf, n, here)]


def mesh(matrix, positions, normals, indices, uvs=None, tangents=None):
    made = mi.Mesh("mesh", len(positions), len(indices) // 3, has_vertex_normals=True, has_vertex_texcoords=uvs is not None)
    p = mi.traverse(made)
    turned = normals @ np.linalg.inv(matrix[:3, :3])
    p["vertex_positions"] = mi.Float((positions @ matrix[:3, :3].T + matrix[:3, 3]).ravel())
    p["vertex_normals"] = mi.Float((turned / np.linalg.norm(turned, axis=1, keepdims=True)).ravel())
    if uvs is not None:
        p["vertex_texcoords"] = mi.Float(uvs.ravel())
    p["faces"] = mi.UInt32(np.ascontiguousarray(indices, np.uint32))
    if tangents is not None:
        made.add_attribute("vertex_tangent", 3, (tangents[:, :3] @ matrix[:3, :3].T).astype(np.float32).ravel())
        made.add_attribute("vertex_flip", 1, tangents[:, 3].astype(np.float32))
    p.update()
    return made


def lathe(size):
    """Smooth: at each point the mean of the normals of its two pieces."""
    points, around = np.array(size["profile_m"], float), size["segments"]
    pieces = np.diff(points, axis=0)
    faces = np.stack([-pieces[:, 1], pieces[:, 0]], -1) / np.linalg.norm(pieces, axis=1, keepdims=True)
    mirror = lambda i: [faces[i] * ([-1, 1] if points[i, 0] == 0 else [1, 1])]
    normals = np.concatenate([mirror(0), faces]) + np.concatenate([faces, mirror(-1)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    angle = np.arange(around + 1) * 2 * PI / around
    turn = lambda p: np.stack([np.outer(p[:, 0], np.cos(angle)), np.outer(p[:, 0], np.sin(angle)), np.outer(p[:, 1], np.ones(around + 1))], -1)
    i = (np.arange(len(points) - 1)[:, None] * (around + 1) + np.arange(around)).ravel()
    quads = np.stack([i, i + around + 1, i + around + 2, i, i + around + 2, i + 1], -1).ravel()
    return turn(points).reshape(-1, 3), turn(normals).reshape(-1, 3), quads


def shapes(entry, folder, **more):
    """Each with the material and the normal map that its file has. `more` is what Mitsuba shall know of built-in shapes."""
    to_world = transform(entry)
    matrix = np.array(to_world.matrix, float).reshape(4, 4)
    if "mesh" in entry:
        gltf, binary, accessor = read_glb(folder / entry["mesh"])
        if entry.get("up", "y") == "y":
            matrix = matrix @ Y_UP
        if "material" in entry:
            arrays = [({k: accessor(v) for k, v in p["attributes"].items()}, accessor(p["indices"]).ravel(), matrix @ placed)
                      for p, placed in placed_primitives(gltf)]
            return [(mesh(m, a["POSITION"], a["NORMAL"], i), None, None) for a, i, m in arrays]
        image, material = own_material(gltf, binary)
        primitive = gltf["meshes"][0]["primitives"][0]
        a = {k: accessor(v) for k, v in primitive["attributes"].items()}
        return [(mesh(matrix, a["POSITION"], a["NORMAL"], accessor(primitive["indices"]).ravel(), a["TEXCOORD_0"], a.get("TANGENT")),
                 material, image)]
    (kind, size), = entry["shape"].items()
    s = mi.ScalarTransform4f().scale
    if kind == "sphere":
        made = {"type": "sphere", "to_world": to_world @ s(size["radius_m"])}
    elif kind == "plane":
        x, y = size["size_m"]
        made = {"type": "rectangle", "to_world": to_world @ s([x / 2, y / 2, 1])}
    elif kind == "disk":
        made = {"type": "disk", "to_world": to_world @ s(size["radius_m"])}
    elif kind == "lathe":
        return [(mesh(matrix, *lathe(size)), None, None)]
    else:
        sys.exit(f"a shape that the peer does not know: {kind}")
    return [(mi.load_dict(made | more), None, None)]


def lamps(scene, folder):
    made = {"type": "scene"}
    for i, light in enumerate(scene.get("light", [])):
        radiance = [light.get("radiance", 1.0) * c for c in light.get("color", [1, 1, 1])]
        emitter = {"type": "area", "radiance": {"type": "rgb", "value": radiance}}
        if light["kind"] == "sphere":
            made[f"l{i}"] = {"type": "sphere", "center": light["center_m"], "radius": light["radius_m"], "emitter": emitter}
            continue
        v = np.array(light["vertices_m"], float)
        if len(v) != 4 or not np.allclose(v[0] + v[2], v[1] + v[3]) or light.get("two_sided"):
            sys.exit("the peer knows parallelograms only, that shine to one side")
        ax, ay, c = (v[1] - v[0]) / 2, (v[3] - v[0]) / 2, (v[0] + v[2]) / 2
        n = np.cross(ax, ay)
        m = np.eye(4); m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = ax, ay, n / np.linalg.norm(n), c
        made[f"l{i}"] = {"type": "rectangle", "to_world": mi.ScalarTransform4f(m), "emitter": emitter}
    if "environment" in scene:
        e = scene["environment"]
        pixels = np.array(mi.Bitmap(str(folder / e["file"])).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
        up = np.array(scene["camera"].get("up", [0, 1, 0]), float)
        axis = int(np.argmax(abs(up)))
        if axis != 1 and not (axis == 2 and up[2] > 0):
            sys.exit("the peer knows maps whose top is +Y or +Z")
        t = mi.ScalarTransform4f
        to_world = t().rotate([float(i == axis) for i in range(3)], e.get("rotation_deg", 0.0))
        to_world = to_world if axis == 1 else to_world @ t().rotate([1, 0, 0], 90)
        pixels = np.roll(pixels, pixels.shape[1] // 2, axis=1) * e.get("intensity", 1.0)
        made["map"] = {"type": "envmap", "bitmap": mi.Bitmap(pixels), "to_world": to_world}
    return mi.load_dict(made)


def assets(text):
    return text.replace("ASSETS", os.environ.get("HAIRLINE_ASSETS", str(ROOT.parent / "shared/assets")))


def missing_file(path):
    scene = tomllib.loads(assets(path.read_text()))
    files = [e["mesh"] for e in scene["object"] if "mesh" in e] + [scene[k]["file"] for k in ("environment",) if k in scene]
    return next((f for f in files if not (path.parent / f).exists()), None)


def vector(v):
    return mi.Vector3f(*map(float, v))


def peer(path, size, samples, seed):
    scene = tomllib.loads(assets(path.read_text()))
    folder = path.parent
    materials = {m["name"]: m for m in scene.get("material", [])}
    light = lamps(scene, folder)
    objects = []
    for entry in scene["object"]:
        # The first has the material of all.
        all_of_it = shapes(entry, folder)
        material = Material(materials[entry["material"]] if "material" in entry else all_of_it[0][1])
        for made, _, image in all_of_it:
            texture = None
            if image is not None:
                texture = mi.Texture2f(TensorXf(image.astype(np.float32)), wrap_mode=dr.WrapMode.Repeat)
            objects.append((mi.load_dict({"type": "scene", "shape": made}), material, texture))
    camera = scene["camera"]
    width, height = size
    forward = np.subtract(camera["target_m"], camera["position_m"]); forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera.get("up", [0, 1, 0])); right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    per_px = 2 * np.tan(np.radians(camera.get("fov_y_deg", 30)) / 2) / height
    std = scene.get("render", {}).get("filter_std_px", 0.5)
    sums = np.zeros((2, height, width, 3))
    runs = max(2, 2 * (width * height * samples // 8_000_000))
    each = samples // runs
    for run in range(runs):
        n = width * height * each
        sampler = mi.load_dict({"type": "independent"}); sampler.seed(seed * 1000 + run, n)
        index = dr.arange(mi.UInt32, n) // each
        shift = mi.warp.square_to_std_normal(sampler.next_2d()) * std
        x = mi.Float(index % width) + 0.5 - width / 2 + shift.x
        y = mi.Float(index // width) + 0.5 - height / 2 + shift.y
        d = dr.normalize(vector(forward) + vector(right) * (x * float(per_px)) - vector(up) * (y * float(per_px)))
        ray = mi.Ray3f(mi.Point3f(*map(float, camera["position_m"])), d)
        result, nearest = mi.Color3f(0), mi.Float(dr.inf)
        for target, material, texture in objects:
            si = target.ray_intersect(ray)
            seen = si.is_valid() & (si.t < nearest)
            nearest = dr.select(seen, si.t, nearest)
            n_ = mi.Normal3f(si.sh_frame.n)
            if texture is not None:
                t = si.shape.eval_attribute_3("vertex_tangent", si)
                t = dr.normalize(mi.Vector3f(t) - n_ * dr.dot(n_, mi.Vector3f(t)))
                flip = si.shape.eval_attribute_1("vertex_flip", si)
                m = texture.eval(mi.Point2f(si.uv))
                m = mi.Vector3f(m[0], m[1], m[2]) * 2 - 1
                n_ = mi.Normal3f(dr.normalize(t * m.x + dr.cross(mi.Vector3f(n_), t) * flip * m.y + mi.Vector3f(n_) * m.z))
            n_ = dr.select(dr.dot(si.n, d) > 0, -n_, n_)
            frame = mi.Frame3f(n_)
            wo = frame.to_local(-d)
            # Bent to the viewer, as Hairline does where a mapped normal turns away.
            radiance = direct(si, wo, frame, material, light, sampler, seen & (wo.z > 0.005))
            result = dr.select(seen, radiance, result)
        result = dr.select(dr.all(dr.isfinite(result)), result, 0)
        pixels = [np.array(c).reshape(height, width, each).mean(2) for c in (result.x, result.y, result.z)]
        sums[run % 2] += np.stack(pixels, -1) / (runs / 2)
    return sums


def direct(si, wo, frame, material, light, sampler, active):
    mis = lambda a, b: dr.select(a > 0, a * a / (a * a + b * b), 0)
    ds, weight = light.sample_emitter_direction(si, sampler.next_2d(), False, active)
    wi = frame.to_local(ds.d)
    bsdf_pdf = material.pdf(wi, wo)
    lit = active & (ds.pdf > 0)
    result = dr.select(lit, weight * material.eval(wi, wo) * mis(ds.pdf, bsdf_pdf), 0)
    wi = material.sample(sampler.next_1d(), sampler.next_2d(), wo)
    pdf = material.pdf(wi, wo)
    on = active & (wi.z > 0) & (pdf > 0)
    hit = light.ray_intersect(mi.Ray3f(si.p, frame.to_world(wi)), on)
    emitter = hit.emitter(light)
    ds = mi.DirectionSample3f(light, hit, si)
    light_pdf = light.pdf_emitter_direction(si, ds, on & (emitter != None))  # noqa: E711
    got = material.eval(wi, wo) / pdf * emitter.eval(hit, on)
    return result + dr.select(on, got * mis(pdf, light_pdf), 0)


def ours(path, size, command, folder):
    target = folder / (path.stem + ".exr")
    text = assets(path.read_text())
    scene = path.parent / f".{path.stem}.tmp"
    scene.write_text(text)
    try:
        subprocess.run([command, *ARGS.mode.split(), str(scene), "-o", str(target), "--size", f"{size[0]}x{size[1]}"],
                       check=True, capture_output=True)
    finally:
        scene.unlink()
    bitmap = mi.Bitmap(str(target))
    names = [f.name for f in bitmap.struct_()]
    pixels = np.array(bitmap)
    index = [next(i for i, n in enumerate(names) if n in (f"base.{c}", )) for c in "RGB"]
    depth = pixels[..., names.index("depth.Z")].astype(float)
    return pixels[..., index].astype(float), away_from_outlines(depth)


def away_from_outlines(depth):
    """Pixels that see, with all within two pixels, one surface: at outlines the two filters see other edges."""
    inside = depth > 0
    for step in range(2):
        near = np.stack([np.roll(depth if step == 0 else inside, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)])
        inside = (near.min(0) > 0.97 * near.max(0)) & (near.min(0) > 0) if step == 0 else near.all(0)
    inside[:2], inside[-2:], inside[:, :2], inside[:, -2:] = False, False, False, False
    return inside


def figures(a, inside, halves):
    b = halves.mean(0)
    noise2 = ((halves[0] - halves[1]) ** 2 / 4).mean()
    seen = b.sum(-1) > 0
    mean = a[seen].mean() / b[seen].mean()
    channels = a[seen].mean(0) / b[seen].mean(0)
    def rms(where):
        noise2 = ((halves[0] - halves[1])[where] ** 2 / 4).mean()
        return np.sqrt(max(((a - b)[where] ** 2).mean() - noise2, 0) / (b[where] ** 2).mean())
    ga, gb = a.sum(-1)[seen], b.sum(-1)[seen]
    order = np.argsort(gb)
    dark = order[: max(len(order) // 10, 1)]
    ratio = ga / np.maximum(gb, 1e-9)
    return {"mean": mean, "channels": channels, "rms": rms(...), "inside": rms(inside), "noise": np.sqrt(noise2 / (b**2).mean()),
            "dark": ga[dark].sum() / gb[dark].sum(), "p1": np.percentile(ratio, 1), "p99": np.percentile(ratio, 99)}


def main():
    global ARGS
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=Path)
    parser.add_argument("--hairline", default=str(ROOT / "target/release/hairline"))
    parser.add_argument("--mode", default="render --backend cpu --shadows off --bounces 0", help="how hairline renders")
    parser.add_argument("--size", type=int, default=128, help="of a square picture, pixels")
    parser.add_argument("--samples", type=int, default=1024, help="of the peer, a pixel")
    parser.add_argument("--keep", type=Path, help="a folder for both pictures of each scene")
    parser.add_argument("-o", "--output", type=Path, help="a file for the table")
    ARGS = parser.parse_args()
    # All but that of speed.py, whose table is matt without a gloss.
    paths = ARGS.scenes or [p for p in sorted((HERE / "scenes").glob("*.toml")) if p.stem != "disk-and-ball-on-table"]
    lines = ["| scene | mean | red, green, blue | rms | away from outlines | darkest tenth | 1 %, 99 % of pixels' ratios |",
             "|---|---:|---:|---:|---:|---:|---:|"]
    print("\n".join(lines), flush=True)
    with tempfile.TemporaryDirectory() as temporary:
        cache = ARGS.keep or Path(temporary)
        cache.mkdir(exist_ok=True)
        for path in paths:
            missing = missing_file(path)
            if missing:
                print(f"{path.stem}: left out, since {missing} is not there", file=sys.stderr)
                continue
            size = (ARGS.size, ARGS.size)
            kept = cache / f"{path.stem}-{ARGS.size}-{ARGS.samples}.npy"
            if kept.exists():
                halves = np.load(kept)
            else:
                halves = peer(path, size, ARGS.samples, 1)
                np.save(kept, halves)
            mine, inside = ours(path, size, ARGS.hairline, cache)
            np.save(cache / f"{path.stem}-ours.npy", mine)
            f = figures(mine, inside, halves)
            line = (f"| {path.stem} | {f['mean']:.3f} | {', '.join(f'{c:.3f}' for c in f['channels'])} | {100 * f['rms']:.1f} % | {100 * f['inside']:.1f} %"
                    f" | {f['dark']:.2f} | {f['p1']:.2f}, {f['p99']:.2f} |")
            lines.append(line)
            print(line + f"  (noise {100 * f['noise']:.1f} %)", flush=True)
    if ARGS.output:
        ARGS.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
