"""Scenes that several tests share."""

import os
from pathlib import Path

import numpy as np
import pytest

import hairline

ROOT = Path(os.environ.get("HAIRLINE_REPOSITORY", Path(__file__).parents[3]))


def plate_table():
    """A scratched plate under a lamp, 48 x 32 pixels."""
    return {
        "camera": {"position_m": [0.0, -0.22, 0.30], "target_m": [0.0, 0.0, 0.0], "up": [0.0, 0.0, 1.0]},
        "render": {"size_px": [48, 32]},
        "material": [{"name": "steel", "kind": "metal", "metal": "steel", "roughness": 0.2}],
        "object": [{"name": "plate", "shape": {"disk": {"radius_m": 0.08}}, "material": "steel"}],
        "scratches": [{"object": "plate", "pattern": "random", "count": 300, "width_um": 4.0}],
        "light": [{"kind": "sphere", "center_m": [0.06, 0.10, 0.25], "radius_m": 0.02, "radiance": 40.0}],
    }


@pytest.fixture
def table():
    return plate_table()


@pytest.fixture
def scene(table):
    return hairline.Scene.from_dict(table)


@pytest.fixture
def repository():
    return ROOT


def lines_on_plate(count, seed=1):
    """Ends of straight scratches on a disk of 8 cm, n x 2 x 3, metres."""
    random = np.random.default_rng(seed)
    angle = random.uniform(0, 2 * np.pi, count)
    radius = 0.07 * np.sqrt(random.uniform(0, 1, count))
    middle = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(count)], axis=1)
    way = random.uniform(0, np.pi, count)
    half = 0.002 * np.stack([np.cos(way), np.sin(way), np.zeros(count)], axis=1)
    return np.stack([middle - half, middle + half], axis=1)
