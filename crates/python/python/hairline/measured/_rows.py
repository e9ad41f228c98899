"""Finding a row of grooves: a peak of the spectrum of the heights, and the profile that repeats with it."""

from __future__ import annotations

from typing import Optional

import numpy as np

from .._arrays import Floats
from .._errors import argument_error
from ._found import Rows
from ._grid import Grid
from ._packages import scipy
from ._profile import fitted

# Waves that fit into the map fewer than this often count as form.
_LEAST_WAVES = 10
_BINS = 64
# A row's peak is at least this many times the median power of waves of similar length. Brushed lines, which lie at random, reach ten.
_LEAST_PEAK = 40.0


def found_rows(grid: Grid, least_share: float) -> Optional[Rows]:
    """See ``HeightMap.rows``."""
    if not 0 < least_share <= 1:
        raise argument_error("least_share", f"found {least_share!r}", "must be above 0, up to 1")
    ndimage = scipy("ndimage")
    square = grid.square()
    step = square.spacing_um[0]
    rows, columns = square.heights_nm.shape
    # Dust is cut off, then form and waviness.
    low, high = np.percentile(square.heights_nm, (0.5, 99.5))
    clipped = np.clip(square.heights_nm, low, high)
    heights = clipped - ndimage.gaussian_filter(clipped, min(rows, columns) / (2 * np.pi * _LEAST_WAVES) * 2, mode="reflect")
    variance = float(heights.var())
    if variance <= 1e-12:
        return None
    window = np.outer(np.hanning(rows), np.hanning(columns))
    power = np.abs(np.fft.rfft2(heights * window)) ** 2
    down, across = np.fft.fftfreq(rows)[:, None], np.fft.rfftfreq(columns)[None, :]
    waves = np.hypot(down * rows, across * columns)
    power[waves < _LEAST_WAVES] = 0
    at = np.unravel_index(int(np.argmax(power)), power.shape)
    f_row, f_column = _refined(heights * window, float(down[at[0], 0]), float(across[0, at[1]]))
    f_row, f_column = _base_wave(power, f_row, f_column, rows)
    f_row, f_column = _refined(heights * window, f_row, f_column)
    frequency = float(np.hypot(f_row, f_column))
    if _height_of_peak(heights * window, f_row, f_column) < _LEAST_PEAK:
        return None
    pitch = step / frequency

    phase = (f_row * np.arange(rows)[:, None] + f_column * np.arange(columns)[None, :]) % 1
    jitter_turns, coherence = _wander(heights, phase, frequency)
    bins = np.minimum((phase * _BINS).astype(np.intp), _BINS - 1).ravel()
    counts = np.maximum(np.bincount(bins, minlength=_BINS), 1)
    mean = np.bincount(bins, heights.ravel(), _BINS) / counts
    share = float(mean.var() / variance)
    if share < least_share or coherence < 0.3:
        return None
    # Grooves off their places blur the mean profile, so the profile is that about the place where each is.
    placed = (phase - _offset(heights, phase, frequency)) % 1
    bins = np.minimum((placed * _BINS).astype(np.intp), _BINS - 1).ravel()
    counts = np.maximum(np.bincount(bins, minlength=_BINS), 1)
    mean = np.bincount(bins, heights.ravel(), _BINS) / counts
    # The lowest place in the middle, where a groove is fitted.
    smooth = ndimage.gaussian_filter1d(mean, 0.05 * _BINS, mode="wrap")
    mean = np.roll(mean, _BINS // 2 - int(np.argmin(smooth)))
    offset = (np.arange(_BINS) + 0.5 - 0.5 * _BINS) / _BINS * pitch
    groove = fitted(offset, mean, min(step, 0.1 * pitch), 0.4 * pitch, pitch_um=pitch)
    # Rows go down where y goes up; grooves run across the wave.
    along = np.array([f_row, f_column]) / frequency
    direction = along if along[0] > 0 or (along[0] == 0 and along[1] > 0) else -along
    return Rows(pitch, (float(direction[0]), float(direction[1])), groove.width_um, groove.depth_nm, jitter_turns * pitch, groove.residual_nm, share, np.stack([offset, mean], axis=1))


def _height_of_peak(heights: Floats, f_row: float, f_column: float) -> float:
    """The power of a wave over the median of those of the same direction that are up to half as long again or shorter."""
    rows, columns = heights.shape
    # A window's own peak is two bins wide to each side.
    bins = float(np.hypot(f_row * rows, f_column * columns))
    factors = np.linspace(0.6, 1.5, 61)
    factors = np.concatenate([[1.0], factors[np.abs(factors - 1) * bins > 3]])

    def power(factor: float) -> float:
        down = np.exp(-2j * np.pi * factor * f_row * np.arange(rows))
        return float(abs(down @ heights @ np.exp(-2j * np.pi * factor * f_column * np.arange(columns))) ** 2)

    powers = [power(factor) for factor in factors]
    return powers[0] / max(float(np.median(powers[1:])), 1e-300) if len(powers) > 8 else 0.0


def _refined(heights: Floats, f_row: float, f_column: float) -> tuple[float, float]:
    """The maximum of the transform near a frequency, between the bins of the discrete one."""
    rows, columns = heights.shape
    down, across = np.arange(rows), np.arange(columns)

    def less(of: Floats) -> float:
        a, b = of[0] / rows, of[1] / columns
        wave = np.exp(-2j * np.pi * a * down) @ heights @ np.exp(-2j * np.pi * b * across)
        return -float(np.log(abs(wave) + 1e-300))

    start = np.array([f_row * rows, f_column * columns])
    simplex = start + np.array([[0, 0], [0.4, 0], [0, 0.4]])
    done = scipy("optimize").minimize(less, start, method="Nelder-Mead", options={"initial_simplex": simplex, "xatol": 1e-4, "fatol": 1e-9})
    return float(done.x[0] / rows), float(done.x[1] / columns)


def _base_wave(power: Floats, f_row: float, f_column: float, rows: int) -> tuple[float, float]:
    """The wave that the strongest one is an overtone of, if there is one: narrow grooves have strong overtones."""
    height, width = power.shape
    columns = 2 * (width - 1)

    def near(a: float, b: float) -> float:
        if b < 0:
            a, b = -a, -b
        i, j = int(round(a * rows)), int(round(b * columns))
        if i * i + j * j < _LEAST_WAVES**2:
            return 0.0
        around = power[np.ix_(np.arange(i - 1, i + 2) % rows, np.clip(np.arange(j - 1, j + 2), 0, width - 1))]
        return float(around.max())

    strongest = near(f_row, f_column)
    for part in (3, 2):
        if near(f_row / part, f_column / part) > 0.1 * strongest:
            return f_row / part, f_column / part
    return f_row, f_column


def _local(heights: Floats, phase: Floats, frequency: float) -> Floats:
    """The wave's amplitude and phase at each place, smoothed over about a pitch across and along."""
    wave = heights * np.exp(-2j * np.pi * phase)
    sigma = 0.6 / frequency
    gaussian = scipy("ndimage").gaussian_filter
    made: Floats = gaussian(wave.real, sigma, mode="nearest") + 1j * gaussian(wave.imag, sigma, mode="nearest")
    return made


def _wander(heights: Floats, phase: Floats, frequency: float) -> tuple[float, float]:
    """Standard deviation of the local phase in turns, and the length of its mean phasor."""
    local = _local(heights, phase, frequency)
    mean = abs(local.sum()) / max(float(np.abs(local).sum()), 1e-300)
    return float(np.sqrt(-2 * np.log(min(mean, 1.0))) / (2 * np.pi)), float(mean)


def _offset(heights: Floats, phase: Floats, frequency: float) -> Floats:
    """How far the local phase is from the mean one, in turns."""
    local = _local(heights, phase, frequency)
    made: Floats = np.angle(local * np.conj(local.sum())) / (2 * np.pi)
    return made
