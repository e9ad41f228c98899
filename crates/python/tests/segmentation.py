"""Do colours help to find scratches? A small segmentation on a data set of `hairline.inspect`: `python crates/python/tests/segmentation.py FOLDER [COUNT]`.

Makes 500 pictures of 256 x 256 in FOLDER, or takes those that are there, and tells how much of the gouges shows in them. Then boosted trees of scikit-learn learn
where gouges are, from filters along lines, once in colour and once in grey: by five folds, each of which is looked at by trees that learned from three others, with
the threshold that did best on the fifth. About five minutes of a processor. Needs scikit-learn, scipy and Pillow.
"""

import json
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

# Colour and grey run side by side, on a core each.
os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np
from PIL import Image
from scipy.fft import irfft2, rfft2
from scipy.ndimage import binary_dilation, distance_transform_edt, gaussian_filter
from sklearn.ensemble import HistGradientBoostingClassifier

import hairline
from hairline import inspect

FOLDS = 5
# Of the pictures of a fold, every other one teaches, the rest are looked at; one of so many chooses the threshold.
CHOOSING = 10
# Pixels of each picture that trees learn from, of either class at most.
EACH = 250
# Directions and lengths, in pixels, of the filters along lines.
WAYS = 16
LENGTHS = (9, 25)
BINS = 200
RADIANCE = 150.0


def plate():
    """A worn plate of steel from above, in the dark field of a ring of lamps: what the surface mirrors is black, and scratches shine."""
    hair = {"object": "plate", "length_m": {"mean": 0.004, "spread": 0.5}, "width_um": {"mean": 3.0, "spread": 0.3}}
    turns = np.linspace(0, 2 * np.pi, 9)
    corners = np.stack([0.12 * np.cos(turns), 0.12 * np.sin(turns), 0.25 + 0 * turns], axis=-1)
    return hairline.Scene.from_dict(
        {
            "camera": {"position_m": [0, 0, 0.25], "target_m": [0, 0, 0], "up": [0, 1, 0], "fov_y_deg": 4},
            "render": {"size_px": [256, 256]},
            "material": [{"name": "steel", "kind": "metal", "metal": "steel", "roughness": 0.1}],
            "object": [{"name": "plate", "shape": {"plane": {"size_m": [0.02, 0.02]}}, "material": "steel"}],
            "scratches": [
                {**hair, "pattern": "random", "count": 500, "depth_nm": {"mean": 150.0, "spread": 0.3}},
                {**hair, "pattern": "parallel", "count": 500, "jitter_deg": 4.0, "depth_nm": {"mean": 120.0, "spread": 0.3}},
            ],
            "light": [
                {"kind": "tube", "ends_m": [corners[i].tolist(), corners[i + 1].tolist()], "radius_m": 0.004, "radiance": RADIANCE}
                for i in range(8)
            ],
        }
    )


GOUGE = inspect.Defect("gouge", "plate", count=(0, 6), length_m=(2e-3, 1e-2), width_um=(10.0, 30.0), depth_nm=(600, 2000), profile="v")

VARIATION = inspect.Variation(camera_turn_deg=3, camera_tilt_deg=3, light_turn_deg=3)

RENDERED = {"shadows": False, "samples": 4}


def line_filters():
    """Transforms of filters along lines, less what lies beside them: of each length and direction; M. Koller et al. (1995), by second derivatives."""
    at = np.fft.fftfreq(256, 1 / 256)
    y, x = np.meshgrid(at, at, indexing="ij")
    made = []
    for length in LENGTHS:
        for way in range(WAYS):
            angle = np.pi * way / WAYS
            along, across = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
            narrow = np.exp(-0.5 * (along / (0.29 * length)) ** 2)
            core = narrow * np.exp(-0.5 * (across / 0.7) ** 2)
            beside = narrow * np.exp(-0.5 * (across / 2.5) ** 2)
            made.append(rfft2(core / core.sum() - beside / beside.sum()))
    return np.array(made, np.complex64)


FILTERS = line_filters()


def picture_of(folder, number):
    return np.asarray(Image.open(folder / f"images/{number:06d}.png").convert("RGB")).astype(np.float32) / 255


def features(picture, is_coloured):
    """Numbers of each pixel: means about it, and the most that a line through it sends and takes; in colour also the colour of each of these."""
    grey = picture @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    channels = [grey]
    if is_coloured:
        # Differences from grey.
        channels += [picture[..., 0] - grey, picture[..., 2] - grey]
    columns = []
    for channel in channels:
        for std in (0, 1, 3, 8):
            columns.append(gaussian_filter(channel, std) if std else channel)
        mean = gaussian_filter(channel, 3)
        columns.append(np.sqrt(np.maximum(gaussian_filter(channel**2, 3) - mean**2, 0)))
    of_lines = [irfft2(FILTERS * rfft2(channel), s=(256, 256)).reshape(len(LENGTHS), WAYS, 256, 256) for channel in channels]
    for i in range(len(LENGTHS)):
        lines = of_lines[0][i]
        for best in (lines.argmax(axis=0), lines.argmin(axis=0)):
            columns += [np.take_along_axis(of[i], best[None], axis=0)[0] for of in of_lines]
            # How much that direction is ahead of the one across it, and of its surroundings.
            across = np.take_along_axis(lines, ((best + WAYS // 2) % WAYS)[None], axis=0)[0]
            columns += [across, gaussian_filter(columns[-len(of_lines)], 4)]
        columns.append(np.std(lines, axis=0))
    return np.stack(columns, axis=-1).reshape(-1, len(columns)).astype(np.float32)


def middle_lines(folder, number):
    return np.asarray(Image.open(folder / f"masks/{number:06d}.png")) > 0


def truth(folder, number):
    """Gouges as lines three pixels wide: what a pixel's filter shows of a middle line."""
    return binary_dilation(middle_lines(folder, number), np.ones((3, 3)))


def learned(folder, count, is_coloured):
    """Trees of each fold."""
    random = np.random.default_rng(1)
    known, right, fold = [], [], []
    for number in (it for it in range(count) if it // FOLDS % 2 == 0):
        at, of = features(picture_of(folder, number), is_coloured), truth(folder, number).ravel()
        for kind in (True, False):
            own = np.flatnonzero(of == kind)
            pick = random.choice(own, min(EACH, len(own)), replace=False)
            known.append(at[pick])
            right.append(of[pick])
            fold.append(np.full(len(pick), number % FOLDS))
    known, right, fold = (np.concatenate(each) for each in (known, right, fold))
    made = []
    for test in range(FOLDS):
        train = (fold != test) & (fold != (test + 1) % FOLDS)
        trees = HistGradientBoostingClassifier(max_iter=100, learning_rate=0.1, max_leaf_nodes=31, random_state=test)
        made.append(trees.fit(known[train], right[train]))
    return made


def counts(share, of, lines):
    """By threshold: pixels that are found and right, found, right; those found a pixel or less off a middle line; middle lines with one found
    a pixel or less off."""
    place = np.minimum((share * BINS).astype(int), BINS - 1).reshape(256, 256)

    def above(which):
        return np.cumsum(np.bincount(place[which], minlength=BINS)[::-1])[::-1]

    # The best that lies a pixel or less off each pixel of a middle line.
    near = np.max([np.roll(place, (dy, dx), axis=(0, 1)) for dy in (-1, 0, 1) for dx in (-1, 0, 1)], axis=0)
    reached = np.cumsum(np.bincount(near[lines], minlength=BINS)[::-1])[::-1]
    close = distance_transform_edt(~lines) < 1.5 if lines.any() else np.zeros((256, 256), bool)
    return np.array([above(of), above(np.ones((256, 256), bool)), np.full(BINS, of.sum()), above(close), reached, np.full(BINS, lines.sum())])


def looked_at(folder, count, is_coloured):
    """Counts of each fold by trees that did not see it, and those by which its threshold is chosen, of the fold after it."""
    trees = learned(folder, count, is_coloured)
    tested, chosen = np.zeros((FOLDS, 6, BINS)), np.zeros((FOLDS, 6, BINS))
    for number in (it for it in range(count) if it // FOLDS % 2 == 1):
        at = features(picture_of(folder, number), is_coloured)
        of, lines, fold = truth(folder, number), middle_lines(folder, number), number % FOLDS
        tested[fold] += counts(trees[fold].predict_proba(at)[:, 1], of, lines)
        if number // FOLDS % CHOOSING == 1:
            before = (fold - 1) % FOLDS
            chosen[before] += counts(trees[before].predict_proba(at)[:, 1], of, lines)
    return tested, chosen


def iou(sums):
    both, found, right = sums[:3]
    return both / np.maximum(found + right - both, 1)


def figures(folder, count, is_coloured):
    """Of each fold: the IoU of lines three pixels wide; the share of what is found that is a pixel or less off a middle line, and of middle lines that
    are found to a pixel."""
    processor = time.process_time()
    tested, chosen = looked_at(folder, count, is_coloured)
    made = []
    for test in range(FOLDS):
        best = int(np.argmax(iou(chosen[test])))
        sums = tested[test]
        both, found, right, close, reached, lines = sums[:, best]
        made.append((iou(sums)[best], close / max(found, 1), reached / max(lines, 1)))
    return np.array(made), time.process_time() - processor


def shown(folder, numbers):
    """The share of the gouges' middle lines that stands out of its picture: that changes it by more than 3 % of what is displayed, of 255."""
    seen = total = 0
    scene = plate()
    for number in numbers:
        changed, told = inspect.drawn(scene, number, defects=[GOUGE], variation=VARIATION)
        for one in told["defects"][::-1]:
            del changed.scratches[one["layer"]]
        bare = changed.render(size=(256, 256), **RENDERED)
        beside = np.asarray(bare.to_pil().convert("RGB")).astype(float) - 255 * picture_of(folder, number)
        lines = middle_lines(folder, number)
        seen += np.sum(np.abs(beside).max(axis=-1)[lines] > 8)
        total += lines.sum()
    return seen / max(total, 1)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 500
    start, processor = time.monotonic(), time.process_time()
    inspect.dataset(plate(), folder, count=count, defects=[GOUGE], variation=VARIATION, **RENDERED)
    print(f"{count} pictures: {time.monotonic() - start:.0f} s, of a processor {time.process_time() - processor:.0f} s", flush=True)
    coco = json.loads((folder / "annotations.json").read_text())
    print(f"{len(coco['annotations'])} gouges; {100 * shown(folder, range(0, count, 20)):.0f} % of their length shows", flush=True)
    with ProcessPoolExecutor(2) as pool:
        colour, grey = (pool.submit(figures, folder, count, is_coloured) for is_coloured in (True, False))
        (colour, colour_s), (grey, grey_s) = colour.result(), grey.result()
    print(f"of a processor {colour_s:.0f} s in colour, {grey_s:.0f} s in grey")
    for told, made in (("colour", colour), ("grey", grey), ("colour less grey, fold by fold", colour - grey)):
        mean, error = made.mean(axis=0), made.std(axis=0, ddof=1) / np.sqrt(FOLDS)
        print(f"{told}: IoU {mean[0]:.3f} +- {error[0]:.3f}, right {mean[1]:.3f} +- {error[1]:.3f}, found {mean[2]:.3f} +- {error[2]:.3f}")
