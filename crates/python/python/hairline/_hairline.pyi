"""The compiled part. Call it by way of the package."""

import os
from typing import Any, Callable, Literal, Optional, Union, final

import numpy as np
import numpy.typing as npt

from ._host import Host

_Path = Union[str, "os.PathLike[str]"]
_Floats = npt.NDArray[np.float64]
_Singles = npt.NDArray[np.float32]

__all__ = [
    "__version__",
    "DEFAULT_SAMPLES",
    "WIDEST_UM",
    "DEEPEST_NM",
    "NARROW",
    "WAVELENGTHS_NM",
    "Bsdf",
    "MeshArray",
    "ScratchArray",
    "Image",
    "Labels",
    "Builder",
    "SceneBsdf",
    "Built",
    "set_threads",
    "threads",
    "read",
    "write_bands",
    "check",
    "to_toml",
    "export",
    "read_image",
    "assemble",
    "picture_from_state",
    "picture_state",
    "inputs",
    "digest",
    "compare",
    "phase_step_energy",
    "oblique_depth_nm",
    "window_overlap_um2",
    "window_share",
    "band_std",
    "sinc_squared_integral",
    "fresnel_dielectric",
    "black_body_rgb",
    "mask_taken",
    "ScratchTable",
    "fresnel_metal",
    "metal_rgb",
    "metal_names",
    "depth_coherence",
    "spectrum_samples",
    "cie",
    "coherent_response",
    "controls",
    "presets",
    "from_preset",
]

__version__: str
DEFAULT_SAMPLES: int
WIDEST_UM: float
DEEPEST_NM: float
NARROW: float
WAVELENGTHS_NM: tuple[float, float]

@final
class Bsdf:
    def __new__(
        cls,
        metal: str,
        n_k: Optional[list[list[float]]],
        roughness: float,
        coherence_um: float,
        coat: Optional[tuple[float, float]],
        cover: Optional[tuple[float, float, list[float]]],
        layers: list[tuple[float, float, float, tuple[tuple[float, float, float], ...], Union[str, list[float]]]],
        gratings: list[tuple[float, float, float, list[float], bool]],
        scratches: list[list[float]],
    ) -> Bsdf: ...
    def seen_through(self, footprint_um2: tuple[float, float, float]) -> Bsdf:
        """The same with its single scratches as they are seen through a footprint of the variances xx, xy and yy."""

    def eval(self, wi: _Floats, wo: _Floats, wavelength_nm: Optional[_Floats], part: str) -> _Floats:
        """Reflection of rows of directions: three numbers a row, or one where wavelengths are given."""

    def pdf(self, wi: _Floats, wo: _Floats, wavelength_nm: Optional[_Floats]) -> _Floats:
        """Density of `sample`, per steradian."""

    def sample(
        self, wo: _Floats, u: _Floats, wavelength_nm: Optional[_Floats]
    ) -> tuple[_Floats, _Floats, _Floats]:
        """Drawn directions, their densities and reflections; downwards and zeros where none was drawn."""

@final
class MeshArray:
    name: str
    vertices: int
    triangles: int
    def __new__(
        cls,
        vertices_m: _Floats,
        triangles: npt.NDArray[np.uint32],
        normals: _Floats | None = None,
        uvs: _Floats | None = None,
    ) -> MeshArray: ...
    def __deepcopy__(self, _memo: Any) -> MeshArray: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class ScratchArray:
    name: str
    count: int
    def __new__(cls, ends_m: _Floats, *sizes: _Floats) -> ScratchArray: ...
    def __deepcopy__(self, _memo: Any) -> ScratchArray: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class Image:
    """A picture with its layers: linear Rec.709, rows from the top. Its arrays share its memory and cannot be written to."""

    is_complete: bool
    """Whether each pixel has all that was asked for; False after Ctrl-C."""
    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
    @property
    def notes(self) -> dict[str, str]:
        """Notes on the picture's making."""
    @property
    def exposure_ev(self) -> float:
        """Exposure of the displayed picture in stops."""
    @property
    def tone_map(self) -> str:
        """Tone curve of the displayed picture."""
    @property
    def beauty(self) -> _Singles:
        """Base plus scratches: float32, height x width x 3, W sr^-1 m^-2. Made when first asked for, and kept."""
    @property
    def base(self) -> _Singles:
        """Light off the base and of the background: float32, height x width x 3, W sr^-1 m^-2."""
    @property
    def scratches(self) -> _Singles:
        """Light off the scratches: float32, height x width x 3, W sr^-1 m^-2."""
    @property
    def density(self) -> _Singles:
        """The share of the base's energy that scratches took: float32, height x width x 3, from 0 to 1."""
    @property
    def depth_m(self) -> _Singles:
        """Distance along the view axis: float32, height x width, metres; 0 where there is no surface."""
    @property
    def normal(self) -> _Singles:
        """Unit shading normal in world space: float32, height x width x 3; 0 where there is no surface."""
    @property
    def alpha(self) -> _Singles | None:
        """The share of each pixel that surfaces cover: float32, height x width, from 0 to 1. None but for a picture before a transparent background."""
    @property
    def labels(self) -> Optional[Labels]:
        """Which scratches each pixel shows. None but for a picture that was rendered with `labels=True`."""

    def _with_labels(self, labels: Labels) -> Image: ...
    @property
    def samples(self) -> npt.NDArray[np.uint32] | None:
        """Samples of each pixel of a reference: uint32, height x width. None for a picture of the closed forms."""
    def variance(
        self, layer: Literal["beauty", "base", "scratches", "density", "depth", "normal", "alpha"] = "beauty"
    ) -> _Singles | None:
        """The variance of each pixel's mean in a layer: float32, height x width x 3, squared radiance. None where it is not known."""
    def save(self, path: _Path, exposure_ev: float | None = None, tone_map: str | None = None) -> None:
        """Writes an .exr (linear, all layers) or a .png (displayed): the whole file or none."""
    def png(self, exposure_ev: float | None = None, tone_map: str | None = None) -> bytes:
        """The displayed picture as the bytes of a PNG."""
    def codes(self, exposure_ev: float | None = None, tone_map: str | None = None) -> npt.NDArray[np.uint8]:
        """The displayed picture: sRGB codes, uint8, height x width x 3, or 4 with alpha."""
    def to_pil(self, exposure_ev: float | None = None, tone_map: str | None = None) -> Any:
        """The displayed picture as an image of Pillow."""
    def _repr_png_(self) -> bytes: ...

@final
class Built:
    """A scene that is ready to be rendered."""

    def scratch_counts(self) -> list[int]:
        """How many scratches each object has."""
    def laid(self, object: str) -> dict[str, Any]:
        """The straight pieces of an object's scratches, by name."""

    def bsdf(self, object: str) -> SceneBsdf:
        """The reflection of an object at any of its points."""

    def labels(self, host: Host) -> Labels:
        """Labels of the picture; see `Scene.labels`."""

    def bounds_m(self) -> tuple[list[float], list[float]]:
        """The corners of the box around all objects, metres."""

    def memory_bytes(self) -> tuple[float, Optional[float]]:
        """About how much memory its pictures take, and how much there is."""
    def render(
        self,
        backend: str,
        samples: int,
        shadows: Optional[bool],
        bounces: Optional[int],
        transparent: bool,
        host: Host,
    ) -> Image: ...
    def in_bands(self, bands_nm: list[tuple[float, float]]) -> list[Built]:
        """The scene in bands of the spectrum, three at a time."""

    def light(self, layer: Optional[int], weight: float, host: Host) -> list[_Floats]:
        """Light of the base and of the scratches with all digits: height x width x 3 each, by the closed forms without shadows. The scratches of a
        layer count `weight` times."""

    def reference(
        self,
        model: str,
        samples: int | None,
        time_s: float | None,
        shadows: bool,
        bounces: int,
        mask: str,
        sample_seed: int,
        resume: Image | None,
        rows: tuple[int, int] | None,
        host: Host,
    ) -> Image: ...

@final
class Labels:
    """Labels of a picture: which scratches each pixel shows. What shows nothing is -1."""

    RANKS: int = ...

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""

    @property
    def objects(self) -> list[str]:
        """Names of the objects."""

    @property
    def object(self) -> npt.NDArray[np.int32]:
        """Index of the object in `objects` that the middle of each pixel sees: int32, height x width."""

    @property
    def scratch(self) -> npt.NDArray[np.int32]:
        """Scratches that cover most of each pixel, the strongest first, counted over all objects: int32, height x width x 6."""

    @property
    def coverage(self) -> _Singles:
        """Share of the pixel, through its filter, that each of these covers: float32, height x width x 6."""

    @property
    def direction_rad(self) -> _Singles:
        """Direction of each of these in the picture, radians counter-clockwise from the right: float32, height x width x 6."""

    @property
    def touched(self) -> npt.NDArray[np.uint32]:
        """Pixels that scratches go through: uint32, n x 2, the index of the pixel row by row and that of the scratch."""

    @property
    def scratch_object(self) -> npt.NDArray[np.uint32]:
        """Object of each scratch: uint32."""

    @property
    def scratch_layer(self) -> npt.NDArray[np.uint32]:
        """Table of `scratches` that each scratch was laid by: uint32."""

    @property
    def scratch_width_um(self) -> _Singles:
        """Width of each scratch: float32, micrometres."""

    @property
    def scratch_depth_nm(self) -> _Singles:
        """Depth of each scratch: float32, nanometres."""

    @property
    def scratch_length_m(self) -> _Singles:
        """Length of each scratch: float32, metres."""

    def save(self, path: _Path) -> None:
        """Writes an .exr by the convention of Cryptomatte: the whole file or none."""

@final
class SceneBsdf:
    def eval_pdf(self, frames: _Floats, wi: _Floats, wo: _Floats) -> tuple[_Floats, _Floats]:
        """Reflection and density of rows of points (a position and three axes each) and directions: three numbers and one."""

    def sample(self, frames: _Floats, wo: _Floats, u: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Drawn directions, their densities and reflections; downwards and zeros where none was drawn."""

@final
class Builder:
    def build(
        self, table: dict[str, Any], folder: _Path, text: str | None, file: _Path, host: Host
    ) -> Built: ...

@final
class ScratchTable:
    def __new__(cls, name: str) -> ScratchTable: ...
    def at(self, u_um: _Floats, depth_nm: _Floats) -> _Floats: ...
    def total(self, depth_nm: _Floats) -> _Floats: ...

def set_threads(count: int) -> None:
    """Has all that follows run on so many threads. It must come before any work."""

def threads() -> int:
    """Number of threads that work runs on."""

def write_bands(
    path: _Path, bands_nm: list[tuple[float, float]], base: _Singles, scratches: _Singles
) -> None: ...
def read(path: _Path) -> tuple[dict[str, Any], str, list[str]]: ...
def check(table: dict[str, Any], alone: bool = False) -> dict[str, Any]: ...
def to_toml(table: dict[str, Any]) -> str: ...
def export(table: dict[str, Any], folder: _Path, path: _Path, laid: bool, bake_px: Optional[int]) -> list[str]: ...
def read_image(path: _Path) -> Image:
    """Reads a layered EXR that `Image.save`, `hairline render` or `hairline reference` wrote."""

def compare(
    a: Image | _Path, b: Image | _Path, exposure_ev: float, curve: str
) -> tuple[dict[str, dict[str, Any]], list[str]]: ...
def metal_names() -> list[str]: ...

phase_step_energy: Callable[..., _Floats]
oblique_depth_nm: Callable[..., _Floats]
window_overlap_um2: Callable[..., _Floats]
window_share: Callable[..., _Floats]
band_std: Callable[..., _Floats]
sinc_squared_integral: Callable[..., _Floats]
fresnel_dielectric: Callable[..., _Floats]
black_body_rgb: Callable[..., _Floats]
mask_taken: Callable[..., _Floats]
fresnel_metal: Callable[..., _Floats]
metal_rgb: Callable[..., _Floats]
coherent_response: Callable[..., _Floats]

def depth_coherence(depths_nm: _Floats, weights: _Floats) -> float: ...
def spectrum_samples() -> tuple[_Floats, _Floats]: ...
def cie() -> tuple[_Floats, _Floats]: ...
def digest(table: dict[str, Any]) -> str: ...
def inputs(table: dict[str, Any], folder: _Path) -> list[str]: ...
def assemble(strips: list[Image]) -> Image: ...
def picture_state(picture: Image) -> tuple[Any, ...]:
    """What a pickle holds of a picture."""

def picture_from_state(
    size_px: tuple[int, int],
    layers: bytes,
    noise: tuple[int, bytes] | None,
    display: tuple[float, str],
    notes: dict[str, str],
    is_complete: bool,
) -> Image: ...

def controls(
    diagonal_m: float,
) -> dict[str, tuple[str, str, tuple[float, float], tuple[float, float], bool, bool, str]]: ...
def presets(kind: str) -> list[tuple[str, str]]: ...
def from_preset(kind: str, name: str, object: str, diagonal_m: float) -> list[dict[str, Any]]: ...
