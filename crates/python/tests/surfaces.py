"""Height maps whose scratches are known."""

import numpy as np


def engraved(shape, step_um, grooves, noise_nm=0.0, seed=1):
    """Heights in metres of rectangular grooves, each (x0, y0, x1, y1, width, depth) in micrometres from the middle of the map and nanometres: means
    over each point of the grid, from 4 x 4 places."""
    rows, columns = (4 * side for side in shape)
    x = ((np.arange(columns) + 0.5) - columns / 2) * step_um / 4
    y = (rows / 2 - (np.arange(rows) + 0.5)) * step_um / 4
    heights = np.zeros((rows, columns), np.float32)
    for x0, y0, x1, y1, width, depth in grooves:
        length = np.hypot(x1 - x0, y1 - y0)
        way = (x1 - x0) / length, (y1 - y0) / length
        along = (x - x0) * way[0] + ((y - y0) * way[1])[:, None]
        across = ((y - y0) * way[0])[:, None] - (x - x0) * way[1]
        heights[(along >= 0) & (along <= length) & (np.abs(across) <= width / 2)] = -depth
    heights = heights.reshape(shape[0], 4, shape[1], 4).mean(axis=(1, 3), dtype=np.float64)
    return 1e-9 * (heights + noise_nm * np.random.default_rng(seed).standard_normal(shape))


# Some that cross others, and some with an end beyond the map of 200 x 200 um.
KNOWN = [
    (-80.0, -60.0, 70.0, 75.0, 3.2, 120.0),
    (-75.0, 80.0, 60.0, -80.0, 2.1, 60.0),
    (-150.0, 20.0, -20.0, 85.0, 4.4, 210.0),
    (20.0, -90.0, 85.0, -30.0, 1.6, 90.0),
    (50.0, 20.0, 80.0, 85.0, 2.7, 35.0),
]
