"""Scratched metal as a BSDF of Mitsuba 3 (``pip install 'hairline-render[mitsuba]'``).

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")

    import hairline.mitsuba

    steel = hairline.mitsuba.bsdf(hairline.load("plate.toml"), "plate")     # the very scratches, by position
    steel = hairline.mitsuba.bsdf(hairline.bsdf.Scratched("steel", layers=[...]))  # their mean, by the frame of the texture coordinates
    scene = mi.load_dict({"type": "scene", "plate": {"type": "disk", "bsdf": steel}, ...})
    with hairline.mitsuba.evaluated():
        image = mi.render(scene)

What is evaluated is Hairline's own code, over arrays. So Mitsuba must have its numbers in memory: variants ``scalar_*`` have them, variants ``llvm_*``
within :func:`evaluated`. One side of a surface reflects: put it into ``twosided`` for both. Not differentiable by Dr.Jit.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Optional, Union

import numpy as np

try:
    import drjit as dr
    import mitsuba as mi
except ImportError as missing:  # pragma: no cover
    raise ImportError("hairline.mitsuba needs Mitsuba 3: pip install 'hairline-render[mitsuba]'") from missing

from ._arrays import Floats
from ._errors import WorkError, argument_error
from ._scene import Scene
from .bsdf import Scratched

__all__ = ["bsdf", "evaluated"]


@contextmanager
def evaluated() -> Iterator[None]:
    """Has Mitsuba compute with numbers in memory, as :func:`bsdf` needs it in variants ``llvm_*``: wavefront by wavefront, without recorded
    loops and calls."""
    flags = (dr.JitFlag.SymbolicLoops, dr.JitFlag.SymbolicCalls, dr.JitFlag.SymbolicConditionals)
    before = [dr.flag(flag) for flag in flags]
    for flag in flags:
        dr.set_flag(flag, False)
    try:
        yield
    finally:
        for flag, value in zip(flags, before):
            dr.set_flag(flag, value)


class _Mean:
    """The mean of layers: the same at each point."""

    def __init__(self, scratched: Scratched) -> None:
        self._bsdf = scratched._at(0.0)

    def eval_pdf(self, _: Any, wi: Floats, wo: Floats, nm: Optional[Floats]) -> tuple[Floats, Floats]:
        count = len(wi) // 3
        return self._bsdf.eval(wi, wo, nm, "all").reshape(count, -1), self._bsdf.pdf(wi, wo, nm)

    def sample(self, _: Any, wo: Floats, u: Floats, nm: Optional[Floats]) -> tuple[Floats, Floats, Floats]:
        count = len(wo) // 3
        wi, pdf, value = self._bsdf.sample(wo, u, nm)
        return wi.reshape(count, 3), pdf, value.reshape(count, -1)


class _Laid:
    """The scratches that a scene has laid, by position."""

    def __init__(self, scene: Scene, name: str) -> None:
        self._bsdf = scene.build().bsdf(name)

    def eval_pdf(self, frames: Floats, wi: Floats, wo: Floats, _: Any) -> tuple[Floats, Floats]:
        value, pdf = self._bsdf.eval_pdf(frames, wi, wo)
        return value.reshape(-1, 3), pdf

    def sample(self, frames: Floats, wo: Floats, u: Floats, _: Any) -> tuple[Floats, Floats, Floats]:
        wi, pdf, value = self._bsdf.sample(frames, wo, u)
        return wi.reshape(-1, 3), pdf, value.reshape(-1, 3)


def _rows(value: Any) -> Floats:
    """Rows of a vector of Mitsuba: one, or as many as there are lanes."""
    array = np.asarray(value, dtype=np.float64)
    rows: Floats = array.reshape(len(array), -1).T
    return rows


def _class() -> Any:
    """The class of the plug-in, which is another one in each variant."""

    class ScratchedBSDF(mi.BSDF):  # type: ignore[misc]
        def __init__(self, of: Union[_Mean, _Laid], told: str) -> None:
            super().__init__(mi.Properties())
            self.m_flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.SpatiallyVarying
            self.m_components = [self.m_flags]
            self._of = of
            self._told = told

        def _lanes(self, si: Any, *others: Any) -> tuple[list[Floats], Floats, Any]:
            """Unit vectors with z above 0 in all lanes; the frames; which lanes had them."""
            try:
                vectors = [_rows(value) for value in (si.wi, *others)]
                frame = si.sh_frame
                frames = [_rows(value) for value in (si.p, frame.s, frame.t, frame.n)]
            except RuntimeError as error:
                raise WorkError("Mitsuba has no numbers yet: render within hairline.mitsuba.evaluated()") from error
            count = max(len(rows) for rows in (*vectors, *frames))
            vectors = [np.array(np.broadcast_to(rows, (count, rows.shape[1]))) for rows in vectors]
            together = np.concatenate([np.broadcast_to(rows, (count, 3)) for rows in frames], axis=1)
            usable: Any = np.isfinite(together).all(axis=1)
            for rows in vectors:
                if rows.shape[1] == 3:
                    usable &= np.abs(np.sum(rows * rows, axis=1) - 1) < 1e-3
            for rows in vectors:
                if rows.shape[1] == 3:
                    # Of single precision.
                    rows /= np.maximum(np.linalg.norm(rows, axis=1), 1e-30)[:, None]
                    rows[~usable] = (0, 0, 1)
            together[~usable] = 0
            return vectors, np.ascontiguousarray(together), usable

        def _wavelengths(self, si: Any, count: int) -> list[Optional[Floats]]:
            if not mi.is_spectral:
                return [None]
            nm = np.broadcast_to(_rows(si.wavelengths), (count, len(si.wavelengths)))
            return [np.ascontiguousarray(np.clip(nm[:, i], 380, 780)) for i in range(nm.shape[1])]

        def _spectrum(self, values: list[Floats]) -> Any:
            """Of columns, one a channel or one a wavelength."""
            if mi.is_monochromatic:
                rgb = np.concatenate(values, axis=1)
                columns = [rgb @ np.array([0.2126, 0.7152, 0.0722])]
            else:
                columns = list(np.concatenate(values, axis=1).T)
            if _is_scalar():
                return mi.Spectrum([float(column[0]) for column in columns])
            return mi.Spectrum(*(mi.Float(column.astype(np.float32)) for column in columns))

        def _number(self, values: Floats) -> Any:
            return float(values[0]) if _is_scalar() else mi.Float(values.astype(np.float32))

        def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> tuple[Any, Any]:
            (to_viewer, to_light), frames, usable = self._lanes(si, wo)
            above = usable & (to_viewer[:, 2] > 0) & (to_light[:, 2] > 0)
            values, pdf = [], np.zeros(len(above))
            for i, nm in enumerate(self._wavelengths(si, len(above))):
                value, density = self._of.eval_pdf(frames.reshape(-1), to_light.reshape(-1), to_viewer.reshape(-1), nm)
                values.append(value * above[:, None])
                # Of a path of several wavelengths the directions are those of the first.
                pdf = density if i == 0 else pdf
            return _where(active, self._spectrum(values)), _where(active, self._number(pdf * above))

        def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return self.eval_pdf(ctx, si, wo, active)[1]

        def sample(self, ctx: Any, si: Any, sample1: Any, sample2: Any, active: Any = True) -> tuple[Any, Any]:
            pick = np.asarray(sample1, dtype=np.float64).reshape(-1, 1)
            (to_viewer, u2), frames, usable = self._lanes(si, sample2)
            u = np.concatenate([np.broadcast_to(pick, (len(u2), 1)), u2], axis=1)
            u = np.ascontiguousarray(np.clip(u, 0, 1 - 1e-9))
            wavelengths = self._wavelengths(si, len(u))
            wi, pdf, value = self._of.sample(frames.reshape(-1), to_viewer.reshape(-1), u.reshape(-1), wavelengths[0])
            kept = usable & (to_viewer[:, 2] > 0) & (pdf > 0)
            wi[~kept] = (0, 0, 1)
            values = [value]
            for nm in wavelengths[1:]:
                one = np.ascontiguousarray(wi).reshape(-1)
                values.append(self._of.eval_pdf(frames.reshape(-1), one, to_viewer.reshape(-1), nm)[0])
            weight = np.where(kept, 1 / np.maximum(pdf, 1e-30), 0)[:, None]
            drawn = mi.BSDFSample3f()
            if _is_scalar():
                drawn.wo = mi.Vector3f([float(x) for x in wi[0]])
            else:
                drawn.wo = mi.Vector3f(*(mi.Float(column.astype(np.float32)) for column in wi.T))
            drawn.pdf = _where(active, self._number(np.where(kept, pdf, 0)))
            drawn.eta = 1.0
            drawn.sampled_type = mi.UInt32(+self.m_flags)
            drawn.sampled_component = mi.UInt32(0)
            return drawn, _where(active, self._spectrum([one * weight for one in values]))

        def traverse(self, cb: Any) -> None:
            """Has no parameters that Mitsuba could change."""

        def to_string(self) -> str:
            return f"hairline.mitsuba.bsdf[{self._told}]"

    return ScratchedBSDF


def _is_scalar() -> bool:
    return str(mi.variant()).startswith("scalar")


def _where(active: Any, value: Any) -> Any:
    if active is True:
        return value
    return dr.select(active, value, dr.zeros(type(value)) if dr.is_array_v(value) else 0.0)


_CLASSES: dict[str, Any] = {}


def bsdf(of: Union[Scratched, Scene], object: Optional[str] = None) -> Any:
    """A BSDF of Mitsuba's current variant.

    :param of: a material by its mean; or a scene, whose scratches are looked up by the position of each point, in metres.
    :param object: the object of the scene.
    """
    variant = mi.variant()
    if variant is None or not variant.startswith(("llvm", "scalar")) or "polarized" in variant:
        raise argument_error("variant", f"found {variant}", 'must be set by mitsuba.set_variant to "llvm_*" or "scalar_*", not polarized')
    if isinstance(of, Scratched):
        if object is not None:
            raise argument_error("object", f"found {object!r} beside a material", "leave it out")
        made: Union[_Mean, _Laid] = _Mean(of)
    elif isinstance(of, Scene):
        if mi.is_spectral:
            raise argument_error("variant", f"found {variant}", "scratches by position need a variant of colours")
        if not isinstance(object, str):
            raise argument_error("object", f"found {object!r}", "must be the name of an object of the scene")
        made = _Laid(of, object)
    else:
        found = f"found an object of type {type(of).__qualname__}"
        raise argument_error("of", found, "must be a hairline.bsdf.Scratched or a hairline.Scene")
    if variant not in _CLASSES:
        _CLASSES[variant] = _class()
    return _CLASSES[variant](made, repr(of))
