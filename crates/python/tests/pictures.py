"""Makes the pictures of docs/python.md: `python crates/python/tests/pictures.py docs/pictures [bsdf mitsuba inspect]`. Needs matplotlib, and Mitsuba 3."""

import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from hairline import inspect  # noqa: E402

NOTEBOOKS = Path(__file__).parents[3] / "docs/notebooks"


def bsdf(target):
    """The second plot of the notebook of the BSDF."""
    sys.path.insert(0, str(NOTEBOOKS))
    import run

    with tempfile.TemporaryDirectory() as folder:
        run.run(NOTEBOOKS / "bsdf.ipynb", Path(folder))
        target.write_bytes(Path(folder, "bsdf-1.png").read_bytes())


def mitsuba(target):
    import test_mitsuba

    scene = test_mitsuba.plate()
    found = test_mitsuba.mitsuba_plate(test_mitsuba.plugin.bsdf(scene, "plate"), 1024)
    right = np.asarray(scene.reference(samples=1024, bounces=0).beauty)
    closed = np.asarray(scene.render(shadows=False).beauty)
    bright = np.quantile(right, 0.97)

    def shown(picture):
        return np.clip(picture / bright, 0, 1) ** (1 / 2.2)

    off = np.abs(found - right)
    pictures = {"Mitsuba 3": found, "hairline reference": right, "hairline render": closed, "difference of the first two": off}
    fig, axes = plt.subplots(1, 4, figsize=(13, 2.6))
    for axis, (name, picture) in zip(axes, pictures.items()):
        axis.imshow(shown(picture))
        axis.set_title(name)
        axis.axis("off")
    fig.savefig(target, dpi=70, bbox_inches="tight")
    blocks = test_mitsuba.blocks
    inside = blocks(right).min(axis=2) > 0.02 * blocks(right).max()
    print("rms over blocks", np.sqrt(np.mean((blocks(found)[inside] / blocks(right)[inside] - 1) ** 2)))


def labelled(target):
    import segmentation

    with tempfile.TemporaryDirectory() as folder:
        made = inspect.dataset(
            segmentation.plate(), folder, count=5, seed=4, defects=[segmentation.GOUGE], variation=segmentation.VARIATION, **segmentation.RENDERED
        )
        fig, axes = plt.subplots(2, 5, figsize=(13, 5.3))
        for number, (picture, mask) in enumerate(axes.T):
            picture.imshow(plt.imread(made / f"images/{number:06d}.png"))
            mask.imshow(plt.imread(made / f"masks/{number:06d}.png") > 0, cmap="gray")
            picture.axis("off")
            mask.axis("off")
    fig.tight_layout()
    fig.savefig(target, dpi=70, bbox_inches="tight")


if __name__ == "__main__":
    folder, names = Path(sys.argv[1]), sys.argv[2:]
    for name, make in {"bsdf": bsdf, "mitsuba": mitsuba, "inspect": labelled}.items():
        if not names or name in names:
            make(folder / f"{name}.png")
