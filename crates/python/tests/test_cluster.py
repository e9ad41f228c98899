"""Work in pieces: the same picture, whoever does it and whoever dies."""

import os
import random
import signal
import time

import numpy as np
import pytest

import hairline
from conftest import lines_on_plate, plate_table

pytest.importorskip("distributed")
from hairline import cluster  # noqa: E402


@pytest.fixture(scope="module")
def client():
    client = cluster.local(2)
    yield client
    local = client.cluster
    client.close()
    local.close()


def same(a, b):
    for layer in ("base", "scratches", "density", "normal", "depth_m", "samples"):
        assert getattr(a, layer).tobytes() == getattr(b, layer).tobytes(), layer
    assert a.variance("beauty").tobytes() == b.variance("beauty").tobytes()
    assert a.notes == b.notes and a.size == b.size


def test_a_reference_in_pieces_is_the_single_one(client, scene):
    scene.scratches.append(
        hairline.Scratches.from_arrays(object="plate", ends_m=lines_on_plate(100), width_um=3, depth_nm=120)
    )
    whole = scene.reference(samples=192)
    told = []
    pieces = cluster.reference(
        scene, samples=192, samples_each=64, rows_each=7, client=client, progress=lambda what, share: told.append(share)
    )
    same(pieces, whole)
    assert told[0] == 0 and told[-1] == 1 and len(told) == 1 + 5 * 3
    assert pieces.is_complete


def test_workers_that_are_killed_at_random_lose_their_pieces_and_nothing_else(client, scene):
    whole = scene.reference(size=(96, 64), samples=256)
    chance = random.Random(27)
    killed = []

    def kill(what, share):
        if share < 1 and len(killed) < 3 and chance.random() < 0.3:
            alive = sorted(client.run(os.getpid, on_error="ignore").values())
            killed.append(chance.choice(alive))
            os.kill(killed[-1], signal.SIGKILL)

    pieces = cluster.reference(
        scene, size=(96, 64), samples=256, samples_each=128, rows_each=8, client=client, progress=kill
    )
    assert len(killed) == 3
    same(pieces, whole)


def test_a_piece_that_kills_its_workers_is_given_up(client, scene):
    """Not handed from worker to worker for ever."""
    here = os.getpid()

    class Bomb:
        def __index__(self):
            return 8 if os.getpid() == here else os._exit(9)

    with pytest.raises(hairline.WorkError, match="killed every worker that had it"):
        list(cluster.render(scene, [{}], client=client, size=(8, 8), samples=Bomb()))


def test_what_is_wrong_is_told_before_anything_is_sent(scene):
    """There is no such scheduler, and nobody asks for it."""
    nowhere = "tcp://127.0.0.1:1"
    table = plate_table()
    table["scratches"][0]["count"] = 10**12
    poisoned = hairline.Scene.from_dict(table)
    for work in (
        lambda: cluster.reference(poisoned, samples=64, client=nowhere),
        lambda: list(cluster.render(poisoned, [{}], client=nowhere)),
        lambda: list(cluster.render(scene, [{"light[0].radius_m": "big"}], client=nowhere)),
        lambda: list(cluster.render(scene, [{"light[3].radius_m": 1}], client=nowhere)),
        lambda: list(cluster.render(scene, [{"light[0]..": 1}], client=nowhere)),
        lambda: list(cluster.render(scene, [3], client=nowhere)),
        lambda: list(cluster.render(scene, [{}], client=nowhere, samples="8")),
        lambda: list(cluster.render(scene, [{}], client=nowhere, size=(0, 8))),
        lambda: cluster.reference(scene, samples="64", client=nowhere),
        lambda: cluster.reference(scene, samples=64, model="exact", client=nowhere),
        lambda: cluster.render_files(scene, [{}, {}], "picture.png", client=nowhere),
        lambda: cluster.render_files(scene, [{}], "{}.jpg", client=nowhere),
        lambda: cluster.reference(scene, samples=64, client=7),
    ):
        start = time.monotonic()
        with pytest.raises(hairline.SceneError):
            work()
        assert time.monotonic() - start < 5


def test_a_piece_that_fails_is_told_once_and_ends_all(client, scene):
    """Only where it is built does this scene turn out too large."""
    changes = [{"camera.fov_y_deg": 20 + i} for i in range(6)]
    changes[2] = {"scratches[0].count": 10**12}
    with pytest.raises(hairline.SceneError, match=r"scratches\[0\].count: .* memory") as caught:
        list(cluster.render(scene, changes, client=client, size=(24, 16), backend="cpu"))
    assert caught.value.key == "scratches[0].count"
    # The workers are as good as before.
    assert len(list(cluster.render(scene, changes[:2], client=client, size=(24, 16), backend="cpu"))) == 2


def test_pictures_of_a_sweep_are_those_of_each_scene(client, scene):
    values = {"scratches[0].depth_nm": [60, 140], "material[0].metal": ["gold", "steel"]}
    pictures = list(cluster.sweep(scene, values, client=client, size=(24, 16), backend="cpu"))
    assert len(pictures) == 4
    for change, image in pictures:
        scene.scratches[0].depth_nm = change["scratches[0].depth_nm"]
        scene.materials[0].metal = change["material[0].metal"]
        alone = scene.render(size=(24, 16), backend="cpu")
        np.testing.assert_array_equal(image.beauty, alone.beauty)


def test_files_are_whole_and_those_that_are_there_stay(client, scene, tmp_path):
    (tmp_path / "frame-0001.exr").write_text("mine")
    turn = [{"camera.position_m": (0.1 * i, -0.22, 0.3)} for i in range(3)]
    pattern = tmp_path / "frame-{:04d}.exr"
    paths = cluster.render_files(scene, turn, pattern, client=client, size=(24, 16), backend="cpu")
    assert sorted(tmp_path.iterdir()) == paths
    assert paths[1].read_text() == "mine"
    scene.camera.position_m = turn[2]["camera.position_m"]
    alone = scene.render(size=(24, 16), backend="cpu")
    np.testing.assert_array_equal(hairline.read_image(paths[2]).beauty, alone.beauty)


def test_files_of_a_scene_travel(client, scene, tmp_path):
    rows = [",".join(map(repr, map(float, [*pair.ravel(), 3.5, 170.0]))) for pair in lines_on_plate(50)]
    header = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm"
    (tmp_path / "lists").mkdir()
    (tmp_path / "lists/lines.csv").write_text("\n".join([header, *rows]))
    scene.folder = tmp_path
    scene.scratches.append(hairline.Scratches(object="plate", pattern="file", file="lists/lines.csv"))
    whole = scene.reference(size=(24, 16), samples=64)
    same(cluster.reference(scene, size=(24, 16), samples=64, client=client), whole)
    scene.folder = tmp_path / "lists"
    scene.scratches[-1].file = "../lists/lines.csv"
    with pytest.raises(hairline.SceneError, match="not below the scene's folder"):
        cluster.reference(scene, size=(24, 16), samples=64, client=client)


def test_scenes_that_differ_in_arrays_alone_have_pictures_of_their_own(client, scene):
    """Ends of scratches, and a vertex of a mesh: as many as before."""
    def variant(half_m=0.08, seed=1):
        made = hairline.Scene.from_dict(scene.to_dict())
        made.objects[0] = hairline.Object.from_arrays(name="plate", material="steel", **square(half_m))
        made.scratches[0] = hairline.Scratches.from_arrays(
            object="plate", ends_m=lines_on_plate(300, seed) / 3, width_um=4, depth_nm=120
        )
        return made

    seen = []
    for each in (variant(), variant(seed=2), variant(half_m=0.05), variant()):
        alone = each.render(size=(24, 16), backend="cpu", shadows=False)
        [(_, image)] = cluster.render(each, [{}], client=client, size=(24, 16), backend="cpu", shadows=False)
        np.testing.assert_array_equal(image.beauty, alone.beauty)
        seen.append(image.beauty.tobytes())
    assert len(set(seen)) == 3 and seen[0] == seen[3]


def square(half_m):
    corners = half_m * np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    return {"vertices_m": corners, "triangles": [[0, 1, 2], [0, 2, 3]]}
