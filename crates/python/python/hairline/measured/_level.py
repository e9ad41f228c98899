"""The form of a surface: a polynomial, fitted so that scratches don't pull at it."""

from __future__ import annotations

import numpy as np

from .._arrays import Floats

# A fit of this many heights is as good as that of all.
_SAMPLES = 200_000
# Where Tukey's biweight, the weight of each height, ends: in standard deviations of the residual.
_REACH = 4.685


def form(heights: Floats, degree: int) -> Floats:
    """The polynomial of a total degree that most of the heights follow: iterated least squares with the biweight of Beaton and Tukey
    (Technometrics 16, 147, 1974)."""
    rows, columns = heights.shape
    step = max(1, int(np.sqrt(heights.size / _SAMPLES)))
    y, x = np.linspace(-1, 1, rows), np.linspace(-1, 1, columns)
    values = heights[::step, ::step]
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    of_y, of_x = (np.polynomial.legendre.legvander(at, degree) for at in (y, x))
    basis = np.stack([np.outer(of_y[::step, i], of_x[::step, j]).ravel() for i, j in powers], axis=1)
    target = values.ravel()
    weight: Floats = np.ones_like(target)
    factors: Floats = np.zeros(len(powers))
    for _ in range(20):
        before = factors
        factors = np.asarray(np.linalg.lstsq(basis * weight[:, None], target * weight, rcond=None)[0], dtype=np.float64)
        off = target - basis @ factors
        off = off - np.median(off)
        scale = 1.4826 * float(np.median(np.abs(off)))
        if scale <= 1e-16 or np.allclose(before, factors, rtol=1e-6, atol=1e-14):
            break
        # Least squares take the square root of the biweight.
        weight = np.clip(1 - (off / (_REACH * scale)) ** 2, 0, None)
    terms = np.zeros((degree + 1, degree + 1))
    for (i, j), factor in zip(powers, factors):
        terms[i, j] = factor
    made: Floats = of_y @ terms @ of_x.T
    return made + float(np.median(heights - made))
