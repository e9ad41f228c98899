"""Does colour help to find scratches? A small segmentation on a data set of `hairline.inspect`: `python crates/python/tests/segmentation.py FOLDER [COUNT]`.

Makes 500 pictures of 256 x 256 in FOLDER, or takes those that are there; trains a forest of scikit-learn on features of scikit-image of four fifths of them, once
in colour and once in grey, and tells the IoU of the gouges on the others. Needs scikit-image and scikit-learn.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
from PIL import Image
from skimage.feature import multiscale_basic_features
from sklearn.ensemble import RandomForestClassifier

import hairline
from hairline import inspect

COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 500
TRAINED = 4 * COUNT // 5
# Pixels of each picture that the forest learns from, of either class.
EACH = 150


def plate():
    """A brushed plate, worn by hairlines, under a soft box in its mirror and a ring of lamps."""
    hair = {"object": "plate", "length_m": {"mean": 0.012, "spread": 0.5}, "width_um": {"mean": 3.0, "spread": 0.3}}
    return hairline.Scene.from_dict(
        {
            "camera": {"position_m": [0, -0.10, 0.15], "target_m": [0, 0, 0], "up": [0, 0, 1], "fov_y_deg": 16},
            "render": {"size_px": [256, 256]},
            "material": [{"name": "steel", "kind": "metal", "metal": "steel", "roughness": 0.15}],
            "object": [{"name": "plate", "shape": {"plane": {"size_m": [0.07, 0.07]}}, "material": "steel"}],
            "scratches": [
                {**hair, "pattern": "random", "count": 1500, "depth_nm": {"mean": 150.0, "spread": 0.3}},
                {**hair, "pattern": "parallel", "count": 1500, "jitter_deg": 4.0, "depth_nm": {"mean": 120.0, "spread": 0.3}},
            ],
            "light": [
                {"kind": "rectangle", "center_m": [0, 0.2, 0.3], "target_m": [0, 0, 0], "width_m": 0.4, "height_m": 0.3, "radiance": 0.25},
                *(
                    {"kind": "sphere", "center_m": [0.25 * np.cos(a), 0.25 * np.sin(a), 0.2], "radius_m": 0.008, "radiance": 100.0}
                    for a in np.linspace(0, 2 * np.pi, 16, endpoint=False)
                ),
            ],
        }
    )


GOUGE = inspect.Defect("gouge", "plate", count=(0, 3), length_m=(6e-3, 2.5e-2), width_um=(15.0, 50.0), depth_nm=(300, 1500))

VARIATION = inspect.Variation(light_turn_deg=20)


def features(path, is_coloured):
    picture = np.asarray(Image.open(path)).astype(np.float32) / 255
    if not is_coloured:
        picture = picture @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    channel_axis = -1 if is_coloured else None
    made = multiscale_basic_features(picture, sigma_min=0.7, sigma_max=8, num_sigma=4, channel_axis=channel_axis)
    return made.reshape(-1, made.shape[-1])


def mask(folder, number):
    return np.asarray(Image.open(folder / f"masks/{number:06d}.png")).ravel() > 0


def figures(folder, is_coloured):
    random = np.random.default_rng(1)
    known, right = [], []
    for number in range(TRAINED):
        at, truth = features(folder / f"images/{number:06d}.png", is_coloured), mask(folder, number)
        for kind in (True, False):
            own = np.flatnonzero(truth == kind)
            pick = random.choice(own, min(EACH, len(own)), replace=False)
            known.append(at[pick])
            right.append(truth[pick])
    forest = RandomForestClassifier(n_estimators=60, min_samples_leaf=20, n_jobs=1, random_state=1)
    forest.fit(np.concatenate(known), np.concatenate(right))
    scores = {}
    for number in range(TRAINED, COUNT):
        at, truth = features(folder / f"images/{number:06d}.png", is_coloured), mask(folder, number)
        share = forest.predict_proba(at)[:, 1]
        for bound in np.arange(0.3, 0.96, 0.05):
            found = share > bound
            both, either = scores.get(bound, (0, 0))
            scores[bound] = (both + np.sum(found & truth), either + np.sum(found | truth))
    return {round(float(bound), 2): float(both / either) for bound, (both, either) in scores.items()}


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    start, processor = time.monotonic(), time.process_time()
    inspect.dataset(plate(), folder, count=COUNT, defects=[GOUGE], variation=VARIATION, shadows=False, samples=4, progress=True)
    print(f"{COUNT} pictures: {time.monotonic() - start:.0f} s, of a processor {time.process_time() - processor:.0f} s")
    coco = json.loads((folder / "annotations.json").read_text())
    print(f"{len(coco['annotations'])} gouges")
    for is_coloured in (True, False):
        start = time.monotonic()
        made = figures(folder, is_coloured)
        best = max(made, key=made.get)
        told = "colour" if is_coloured else "grey"
        print(f"{told}: IoU {made[best]:.3f} (bound {best}); {time.monotonic() - start:.0f} s; {made}")
