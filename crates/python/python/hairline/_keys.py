"""The keys of a scene's tables. Made of the entries of the keys, in crates/document/src/description."""

# Notes are one line each.
# ruff: noqa: E501

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

from . import _hairline as core
from ._arrays import ArrayLike
from ._table import Path, Sizes, Table, Vector, _default


class CameraKeys(Table):
    """``[camera]``: a pinhole, or a thin lens."""

    _section = "camera"
    _is_one_of_many = False
    _absent = {"up": (0.0, 1.0, 0.0), "sensor_width_mm": 36.0, "exposure_ev": 0.0}

    position_m: Vector
    """Where the camera is. Unit: m. Range: ±1000 each."""
    target_m: Vector
    """The point in the centre of the picture. Unit: m. Range: ±1000 each, not the position."""
    up: Vector = _default()
    """The direction that is up in the picture; any length. Write ``[0, 0, 1]`` for a z-up scene. If the camera looks straight down along Y or Z, ``up`` only turns the picture, unless it is +Y or +Z, which also say the axis of the world that points up. ``up = [0, 1, -0.1]`` looks down on a y-up scene as well, with -Z up in the picture. Default: ``[0, 1, 0]``. Range: not zero, not along the view."""
    fov_y_deg: Optional[float] = _default()
    """Vertical field of view. Unit: °. Default: 30. Range: 0.001 to 179."""
    focal_length_mm: Optional[float] = _default()
    """The field of view in the words of photographers; in place of ``fov_y_deg``. Where both are given they must agree within 0.05 degrees. Unit: mm. Default: none. Range: 0.1 to 10000."""
    sensor_width_mm: float = _default()
    """How wide the film is, that is, the picture of ``size_px``: what focal lengths and f-stops count by, in this file and in the viewer. Unit: mm. Default: 36. Range: 0.1 to 1000."""
    exposure_ev: float = _default()
    """Radiances are multiplied by 2^``exposure_ev`` before the tone map. Unit: stops. Default: 0. Range: ±64."""
    aperture_mm: Optional[float] = _default()
    """Diameter of the lens's opening; none, or 0: a pinhole. Unit: mm. Default: none. Range: 0 to 1000."""
    f_stop: Optional[float] = _default()
    """The opening in the words of photographers, in place of ``aperture_mm``: ``focal_length_mm`` over this, both needed. Where both are given they must agree within 0.1 %. Default: none. Range: 0.1 to 1000."""
    focus_distance_m: Optional[float] = _default()
    """With an opening: how far away things are sharp, along the view. Unit: m. Default: the distance of the target. Range: 0.00001 to 1000."""
    shift: Optional[Vector] = _default()
    """Moves the picture across what the lens shows, to the right and up, as a view camera does: ``[0, 0.1]`` shows a tenth of the picture's height more above and less below, and upright lines stay parallel. The target is off the centre by as much the other way. Unit: heights of the picture. Default: none. Range: two numbers, ±10 each."""
    world_up: Optional[str] = _default()
    """The axis of the world that points up, for a camera that is rolled or looks steeply down: models stand and environments have their top by it, whatever is up in the picture. Default: the axis nearest to ``up``. Range: ``"y"``, ``"z"``."""
    of_file: Optional[str] = _default()
    """A camera of a model's file in the place of ``position_m``, ``target_m`` and ``fov_y_deg``: its name, its node's, or its number from 0. ``up`` says which axis the models stand by. Default: none. Range: name or number."""


class Settings(Table):
    """``[render]``: how the picture is sampled and shown."""

    _section = "render"
    _is_one_of_many = False
    _absent = {"size_px": (1280, 720), "filter_std_px": 0.5, "tone_map": "neutral", "transparent": False, "png_bits": 8}

    size_px: Sequence[int] = _default()
    """Width and height. Unit: pixels. Default: ``[1280, 720]``. Range: 1 to 16384 each."""
    filter_std_px: float = _default()
    """Standard deviation of the pixel's Gaussian filter: larger is softer. Unit: pixels. Default: 0.5. Range: 0.1 to 10."""
    tone_map: str = _default()
    """The curve from radiance to the display. Default: ``"neutral"``. Range: see below."""
    transparent: bool = _default()
    """Whether pictures have an alpha, the share of each pixel that objects cover. The environment lights them and is not seen then. Default: ``false``."""
    behind: Optional[Path] = _default()
    """A picture behind the objects, relative to the scene file, in the place of the environment. It fills the whole of a ``.png``, from the middle, with its own colours: no exposure and no tone curve changes them. An ``.exr`` keeps its alpha instead. Default: none. Range: ``.png``, ``.jpg``, ``.webp``."""
    png_bits: int = _default()
    """Bits of each channel of a ``.png``. 16 leave room for changes of brightness afterwards. Default: 8. Range: 8 or 16."""


class Environment(Table):
    """``[environment]``: light from all around. Either ``file`` or ``builtin``."""

    _section = "environment"
    _is_one_of_many = False
    _absent = {"rotation_deg": 0.0, "intensity": 1.0, "visible": True}

    file: Optional[Path] = _default()
    """An equirectangular map. Maps wider than 8192 px are halved. What is small, round and bright in it, as the sun is, lights as a lamp of its own would, colours on scratches included. ``hairline info`` lists such lamps. Default: this or ``builtin``. Range: ``.hdr`` or ``.exr``, twice as wide as high, at most 16384 px wide."""
    builtin: Optional[str] = _default()
    """A map in the box, without a file: soft boxes in a dark room, a room with a tall window, an even grey sky. Default: this or ``file``. Range: ``"studio"``, ``"window"``, ``"overcast"``."""
    rotation_deg: float = _default()
    """Turns it about the up axis, counter-clockwise seen from above. Unit: °. Default: 0. Range: any."""
    intensity: float = _default()
    """Factor on its radiance. Default: 1. Range: 0 or more."""
    visible: bool = _default()
    """Whether the camera sees it behind the objects. It lights them either way. ``hairline render --transparent`` hides it in one picture, whose alpha says what the objects cover. Default: ``true``."""


class Studio(Table):
    """``[studio]``: soft boxes, a lamp and a dim room around the objects. A scene without lights and environment has one, on a ground; with ``hidden`` it is in the dark."""

    _section = "studio"
    _nothing = {"hidden": True}
    _is_one_of_many = False
    _absent = {"hidden": False, "intensity": 1.0, "rotation_deg": 0.0}

    hidden: bool = _default()
    """As if it were not there. Default: ``false``."""
    intensity: float = _default()
    """Factor on all of its radiances. Default: 1. Range: 0 or more."""
    rotation_deg: float = _default()
    """Turns it about the up axis, counter-clockwise seen from above. Unit: °. Default: 0. Range: any."""


class Ground(Table):
    """``[ground]``: a wide floor under all objects."""

    _section = "ground"
    _is_one_of_many = False
    _absent = {"hidden": False, "color": (0.1, 0.1, 0.105), "roughness": 0.55, "shadows_only": False}

    hidden: bool = _default()
    """As if it were not there. Default: ``false``."""
    color: Vector = _default()
    """Albedo below its gloss. Unit: linear RGB. Default: ``[0.1, 0.1, 0.105]``. Range: 0 to 1 each."""
    roughness: float = _default()
    """As that of a material. Default: 0.55. Range: 0 to 1."""
    height_m: Optional[float] = _default()
    """Where it lies along the up axis. Unit: m. Default: under the lowest point of all objects. Range: ±1000."""
    shadows_only: bool = _default()
    """Whether the ground is seen by the shadows on it alone. Pictures are transparent then: where it is lit fully alpha is 0, where nothing lights it black with alpha 1. No object mirrors it. Default: ``false``."""


class Material(Table):
    """``[[material]]``: what an object is made of."""

    _section = "material"
    _absent = {"roughness": 0.1, "coherence_um": 20.0}

    kind: str
    """``"metal"``, ``"dielectric"``, ``"metallic-roughness"``, ``"mirror"``."""
    name: str
    """What objects call it by. Range: not empty, no two equal."""
    roughness: float = _default()
    """Perceptual roughness of the surface between the scratches, as in glTF (GGX's alpha is its square). Below 0.045 nothing changes any more, and a note says so. Default: 0.1. Range: 0 to 1."""
    anisotropy: Optional[float] = _default()
    """How far highlights are drawn out one way, as on brushed metal (``KHR_materials_anisotropy``): that way GGX's alpha goes from that of the roughness to 1 with the square of this. 0.4 to 0.7 for brushed pans and panels. Default: none. Range: 0 to 1."""
    anisotropy_direction_deg: float = _default()
    """Which way: across the brushing, counter-clockwise from where u of the texture coordinates rises. On what is turned about an axis 0 is around it and 90 across, as of a lid that is brushed round and round (``scenes/lid.toml``). Unit: °. Default: 0. Range: any; with ``anisotropy``."""
    clearcoat: Optional[float] = _default()
    """The share of the surface that has a clear layer over it, as car paint has (``KHR_materials_clearcoat``): refractive index 1.5. Scratches lie in it; what is under it shines through. Default: none. Range: 0 to 1."""
    clearcoat_roughness: float = _default()
    """As ``roughness``, of the layer. Default: 0. Range: 0 to 1; with ``clearcoat``."""
    coherence_um: float = _default()
    """Over what distance light interferes: standard deviation of the Gaussian coherence window. Nothing finer is seen, however small the pixels. Leave it alone but for macro views and studies. Unit: µm. Default: 20. Range: 1 to 1000."""
    metal: Optional[str] = _default()
    """A metal by its measured refractive index; ``"steel"`` is stainless. Default: this, ``base_color`` or ``n_k``. Range: ``"iron"``, ``"steel"``, ``"aluminium"``, ``"copper"``, ``"gold"``, ``"silver"``, ``"brass"``, ``"chromium"``, ``"titanium"``, ``"nickel"``."""
    base_color: Optional[Vector] = _default()
    """A metal by its reflectance when seen head-on. Unit: linear RGB. Default: this, ``metal`` or ``n_k``. Range: 0 to 1 each."""
    n_k: Optional[Union[Sequence[Vector], ArrayLike]] = _default()
    """A metal by a refractive index of your own: rows of a wavelength in nm, n and k, as ``[[400, 1.5, 1.9], [500, 0.9, 1.8]]``. Linear between them, constant beyond. Default: this, ``metal`` or ``base_color``. Range: 1 to 4096 rows: a wavelength from 100 to 2000 nm, each greater than that before; n above 0, k 0 or more, up to 100."""
    cover: Optional[Mapping[str, Any]] = _default()
    """A clear plate with parallel faces over the metal: the polycarbonate of discs, the glass of a dial. Its outer face reflects with the metal's roughness. Gratings lie under it: waves are shorter there, and orders have other brightnesses in the same directions. Scratches lie in the metal. Default: none. Range: see cover; with ``metal`` or ``n_k``, without ``clearcoat``."""
    ior: Optional[float] = _default()
    """Refractive index of the clear coat. 1.5 is glass and most plastics and lacquers. Default: 1.5. Range: 1 to 4."""
    metallic: Optional[float] = _default()
    """From dielectric to metal. Default: 1. Range: 0 to 1."""
    specular: Optional[float] = _default()
    """As far as it is no metal: how much of its reflections it keeps, straight on and at grazing views (``KHR_materials_specular``). 1 is as of glass, 0 as of chalk. Default: 1. Range: 0 to 1."""
    specular_color: Optional[Vector] = _default()
    """As far as it is no metal: the colour of its reflections straight on. At grazing views they stay white. Unit: linear RGB. Default: ``[1, 1, 1]``. Range: 0 to 1 each."""


class ObjectKeys(Table):
    """``[[object]]``: a ``shape`` or a ``mesh``."""

    _section = "object"
    _absent = {"translation_m": (0.0, 0.0, 0.0), "rotation_deg": (0.0, 0.0, 0.0), "scale": 1.0, "hidden": False}

    name: str
    """What scratches call it by. Range: not empty, no two equal."""
    shape: Optional[Mapping[str, Mapping[str, Any]]] = _default()
    """A built-in shape. Default: this or ``mesh``. Range: see shapes."""
    mesh: Optional[Union[Path, core.MeshArray]] = _default()
    """A model. Default: this or ``shape``. Range: ``.gltf``, ``.glb``, ``.obj`` or ``.stl``."""
    material: Optional[str] = _default()
    """A ``mesh`` without it keeps the materials of its file; with it, all of the mesh is of this one. Default: required for a ``shape``. Range: name of a material."""
    up: str = _default()
    """Which axis of the model's file points up. It is turned to the world axis nearest to the camera's ``up``, so that the model stands upright. Default: ``"y"``. Range: ``"y"``, ``"z"``; with ``mesh`` only."""
    fit_m: Optional[float] = _default()
    """Scales the model until its largest extent is this. Unit: m. Default: as in the file. Range: 1e-5 to 1000; with ``mesh`` only."""
    time_s: Optional[float] = _default()
    """The model stands as an animation of its file has it at this time. Without it, it is at rest. Unit: s. Default: none. Range: 0 to 1e6; with ``mesh`` only."""
    animation: Optional[str] = _default()
    """Which animation: its name, or its number from 0 as text. Default: the first one. Range: with ``time_s`` only."""
    overrides: Sequence[Mapping[str, Any]] = _default()
    """Other factors for materials of its file, whose maps stay: below. Default: none. Range: a list; with ``mesh`` and without ``material``."""
    translation_m: Vector = _default()
    """Moves the object, after scale and rotation. Unit: m. Default: ``[0, 0, 0]``. Range: ±1000 each."""
    rotation_deg: Vector = _default()
    """Turns it about the world's x axis, then y, then z. Unit: °. Default: ``[0, 0, 0]``. Range: any."""
    scale: Union[float, Vector] = _default()
    """One number, or three for the object's own axes; negative ones mirror. Default: 1. Range: size 1e-6 to 1e6, not 0."""
    hidden: bool = _default()
    """As if it were not there, nor what lies on it. Default: ``false``."""


class ScratchesKeys(Table):
    """``[[scratches]]``: a layer on one object."""

    _section = "scratches"
    _absent = {"hidden": False, "solo": False, "profile": "rectangle", "strokes": ()}

    pattern: str
    """``"random"``, ``"parallel"``, ``"circular"``, ``"radial"``, ``"spun"``, ``"swirl"``, ``"drawn"``, ``"file"``, ``"curve"``, ``"text"``, ``"svg"``."""
    object: str
    """What they lie on. Range: name of an object."""
    material: Optional[str] = _default()
    """They lie on what is of this material, and end where it ends. Default: all of it. Range: name of a material of the object's file."""
    node: Optional[str] = _default()
    """They lie on this node and on what is below it; with ``material`` on what is both. Default: all of it. Range: name of a node of the object's file."""
    where: Optional[Mapping[str, Any]] = _default()
    """On which places they lie, and how thickly. Default: everywhere alike. Range: see where."""
    name: Optional[str] = _default()
    """For you to know the layer by. Default: none. Range: any text."""
    hidden: bool = _default()
    """Lays nothing. Other layers stay as they are. Default: ``false``."""
    solo: bool = _default()
    """If any layer of the scene is solo, only solo ones that are not hidden are laid. Default: ``false``."""
    profile: Union[str, Sequence[float]] = _default()
    """Cross section of the grooves: ``"rectangle"``, a flat floor, which shows the purest colours; ``"v"``, two straight flanks, of a sharp point; ``"round"``, of a grain or a stylus; ``"shoulders"``, round with ridges beside it, which a blunt point pushes up in soft metal. Or the depths over ``depth_nm`` at equal steps from the middle to the rim, below 0 above the surface: ``[1, 0.7, 0, -0.3, 0]``. Width is that of all of it. Default: ``"rectangle"``. Range: one of these names, or 2 to 64 numbers of ±1, not all 0."""
    strokes: Sequence[Mapping[str, Any]] = _default()
    """What a brush or an eraser did. Default: none. Range: see strokes."""
    curvature_per_m: Optional[Sizes] = _default()
    """How much a scratch bends: one over its radius. A mean of 0 with a spread of 4 to 20 bends them both ways. Unit: 1/m. Default: 0. Range: mean ±10000, spread 0 to 10000."""
    count: Optional[int] = _default()
    """How many. Default: this or ``density_per_m2``. Range: whole, 0 or more."""
    density_per_m2: Optional[float] = _default()
    """How many on each square metre of the object. Unit: 1/m². Default: this or ``count``. Range: 0 or more."""
    seed: Optional[int] = _default()
    """The same seed gives the same scratches; a higher ``count`` keeps those there are and adds to them. Layers of different seeds do not depend on one another or on their order; of layers of one seed on one object (hidden ones count) each draws anew. Default: 1. Range: whole, below 2^63."""
    length_m: Optional[Sizes] = _default()
    """Length along the surface. Unit: m. Default: mean 0.02, spread 0.5. Range: mean above 0, up to 1000; spread 0 to 3."""
    width_um: Optional[Sizes] = _default()
    """Width of the groove: how far its colours fan out. Unit: µm. Default: mean 1.5, spread 0.3. Range: mean above 0, up to 100; spread 0 to 3."""
    depth_nm: Optional[Sizes] = _default()
    """Depth of the groove: which colours it favours. Unit: nm. Default: mean 200, spread 0.2. Range: mean above 0, up to 2000; spread 0 to 3."""
    direction: Optional[Vector] = _default()
    """Along what the scratches run, laid flat on the surface. Default: ``[1, 0, 0]``. Range: not zero."""
    jitter_deg: Optional[float] = _default()
    """Standard deviation of a scratch's angle to the pattern. A few degrees look made by hand. Unit: °. Default: 0. Range: 0 to 90."""
    axis: Optional[Vector] = _default()
    """Direction of the axis. Default: ``[0, 0, 1]``. Range: not zero."""
    center_m: Optional[Vector] = _default()
    """A point on the axis. Unit: m. Default: ``[0, 0, 0]``. Range: ±1000 each."""
    file: Optional[Union[Path, core.ScratchArray]] = _default()
    """One straight scratch a row, or a straight piece of one, commas between. Range: CSV, UTF-8."""
    points_m: Optional[Union[Sequence[Vector], ArrayLike]] = _default()
    """What the curve goes through, on or near the surface, in the object's own frame. A point farther from the object than the object is large is refused. Unit: m. Range: 2 to 4096 points, ±1000 each; 3 or more with ``closed``."""
    closed: Optional[bool] = _default()
    """The curve comes back to its first point. Default: ``false``."""
    line_m: Optional[float] = _default()
    """How wide a line is. 0: one scratch, which shows where it runs across the light. Wider: filled with short scratches in all directions, as a marking laser leaves them, which shine from all sides. Unit: m. Default: 0. Range: 0 to 1."""
    text: Optional[str] = _default()
    """What is engraved. The font is built in, Ubuntu Light: Latin, Greek, Cyrillic. Range: 1 to 200 characters."""
    height_m: Optional[float] = _default()
    """The height of capitals. Unit: m. Range: 1e-5 to 1000."""
    fit_m: Optional[float] = _default()
    """The largest extent of its outlines. Unit: m. Range: 1e-5 to 1000."""


class Grating(Table):
    """``[[grating]]``: grooves side by side, finer than a pixel, that cover an object."""

    _section = "grating"
    _absent = {"hidden": False, "depth_nm": 120.0, "jitter_um": 0.0, "theory": "rigorous", "seed": 1, "coverage": 1.0}

    pattern: str
    """``"parallel"``, ``"circular"``, ``"radial"``, ``"spun"``, ``"swirl"``, ``"uv"``."""
    object: str
    """What they cover. Range: name of an object."""
    name: Optional[str] = _default()
    """For you to know it by. Default: none. Range: any text."""
    hidden: bool = _default()
    """As if it were not there. Default: ``false``."""
    pitch_um: float
    """From one groove to the next: how far apart the orders are. 1.6 is a compact disc, 0.74 a DVD, 30 turned steel. Unit: µm. Range: 0.3 to 50."""
    width_um: Optional[float] = _default()
    """Width of each groove: how bright the further orders are. Unit: µm. Default: 0.4 of the pitch. Range: above 0, up to the pitch."""
    depth_nm: Sizes = _default()
    """Depth: how much light goes into orders, and which colours. Normal; the spread is a share of the mean. Unit: nm. Default: 120. Range: mean 0 to 2000, spread 0 to 1."""
    jitter_um: float = _default()
    """Standard deviation of how far a groove is off its place. A tenth of the pitch leaves the first order two thirds of its light; a quarter turns rows into so many single scratches. Unit: µm. Default: 0. Range: 0 to the pitch."""
    theory: str = _default()
    """How bright the orders of a pitch below 4 µm are. ``"rigorous"`` solves Maxwell's equations in the grooves for both polarisations, by the refractive index of the metal (of aluminium where a colour stands for one) or of the plastic. That takes about ten seconds for a grating, once: the result is kept in the user's folder for caches. ``"scalar"`` is the simpler theory that wider grooves have, to compare with. Mirrors and what lies in a clear coat are scalar always. Default: ``"rigorous"``. Range: ``"rigorous"``, ``"scalar"``."""
    seed: int = _default()
    """Which groove is off its place by how much, where grooves are seen one by one. Default: 1. Range: whole, below 2^63."""
    coverage: float = _default()
    """The share of the surface that the grooves cover. Default: 1. Range: 0 to 1."""
    mask: Optional[Path] = _default()
    """A picture whose values, from 0 (black) to 1 (white), are factors on the coverage: a motif in foil. From afar it is its mean over a pixel. Default: none. Range: as ``directions``."""
    tile_m: Optional[float] = _default()
    """The mask is laid on the object along its own three axes, repeated, so wide; as in ``where`` of scratches. Unit: m. Default: by texture coordinates. Range: 1e-5 to 1000; with ``mask``."""
    radius_m: Optional[Vector] = _default()
    """The least and the greatest distance from the axis: grooves inside of a circle, outside of one, or in a ring. For ``"parallel"`` and ``"uv"``, from ``center_m``. Unit: m. Default: everywhere. Range: two numbers, the second greater."""
    direction: Optional[Vector] = _default()
    """Along what the scratches run, laid flat on the surface. Default: ``[1, 0, 0]``. Range: not zero."""
    jitter_deg: Optional[float] = _default()
    """Standard deviation of a groove's angle to the pattern: streaks become fans. Unit: °. Default: 0. Range: 0 to 90."""
    center_m: Optional[Vector] = _default()
    """For ``"parallel"`` and ``"uv"``, with ``radius_m``: the middle of the ball that holds them. The other patterns have theirs. Unit: m. Default: origin. Range: ±1000 each; with ``radius_m``."""
    axis: Optional[Vector] = _default()
    """Direction of the axis. Default: ``[0, 0, 1]``. Range: not zero."""
    curvature_per_m: Optional[float] = _default()
    """One over the radius of the arcs; its sign is the sense of the spiral. Unit: 1/m. Default: 20. Range: ±10000."""
    spacing_m: Optional[float] = _default()
    """From spot to spot, and from row to row. Metres of the world, whatever the object's ``scale``. The radius of a spot is 0.75 of it. Where spots are smaller than a pixel, it shows the mean of all their directions. Unit: m. Default: 0.004. Range: 1e-5 to 1000."""
    along: Optional[str] = _default()
    """Along which texture coordinate they run. Default: ``"u"``. Range: ``"u"``, ``"v"``."""
    directions: Optional[Path] = _default()
    """A picture, relative to the scene file, that turns them, as anisotropy textures of glTF do: red is the part along the coordinate, green that up across it, from -1 (code 0) to 1 (code 255). Middle grey of both is no direction: no grooves. Default: none. Range: ``.png``, ``.jpg``, ``.webp``."""


class Light(Table):
    """``[[light]]``: one of the kinds below."""

    _section = "light"
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0)}

    name: Optional[str] = _default()
    """For you to know the light by. Default: none. Range: any text."""
    hidden: bool = _default()
    """Lights nothing, as if it were not there. Default: ``false``."""
    exposure_ev: float = _default()
    """The radiance, or the irradiance of a sun, is multiplied by 2^``exposure_ev``. Unit: stops. Default: 0. Range: ±64."""
    temperature_k: Optional[float] = _default()
    """The colour of a black body: 2700 a warm bulb, 5600 a flash, 6500 daylight. The luminance stays; ``color`` is a filter before it. Unit: K. Default: none. Range: 1000 to 40000."""
    color: Vector = _default()
    """Factor on the radiance; white has the spectrum of daylight (D65). Unit: linear RGB. Default: ``[1, 1, 1]``. Range: 0 or more each."""
    barn_doors_deg: Optional[Vector] = _default()
    """Of a disk or a rectangle: barn doors: the angles between the axis and flaps that end the light, to the left, to the right, above and below as seen from the target. 90 is open. Light falls off in the last tenth of each angle. Not with ``two_sided``. Unit: °. Default: none. Range: four, 0 to 90 each."""
    picture: Optional[Path] = _default()
    """Of a rectangle: a picture on the light, upright as seen from the target, relative to the scene file: what a soft box looks like. Its linear values are factors on the radiance; those of ``.hdr`` and ``.exr`` are kept in 8 bits relative to the brightest. What is transparent sends no light. Scratches, base, shadows and the camera see it. Default: none. Range: ``.png``, ``.jpg``, ``.webp``, ``.hdr`` or ``.exr``."""
    radiance: float = _default()
    """Brightness of its surface. A smaller light of the same radiance lights less. Not of a sun, which has ``irradiance``. Unit: W sr⁻¹ m⁻². Default: 1. Range: 0 or more."""
    visible: bool = _default()
    """Whether the camera sees its shape, as bright as its ``radiance``; of flat ones the side that shines. It hides no other light, and is in reflections either way. Not of a sun. Default: ``false``."""
    cone_deg: Optional[float] = _default()
    """A spot: the angle of its cone from rim to rim; no light outside. Flat lights point along their own axis. Not with ``two_sided``, not of a sun. Unit: °. Default: none. Range: 0.1 to 360."""
    cone_softness: float = _default()
    """With ``cone_deg``: the part of the way from rim to axis in which the light falls off, as KHR_lights_punctual has it. Default: 0.1. Range: 0 to 1."""


class SphereLight(Light):
    """A sphere."""

    _fixed = {"kind": "sphere"}
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0), "radiance": 1.0, "visible": False}

    center_m: Vector
    """Its middle. Unit: m. Range: ±1000 each."""
    radius_m: float
    """Its radius. Unit: m. Range: 1e-5 to 1000."""
    target_m: Optional[Vector] = _default()
    """What the cone points to. Unit: m. Default: none. Range: with ``cone_deg``, which needs it."""


class DiskLight(Light):
    """Flat and round; it faces the target and shines to its side."""

    _fixed = {"kind": "disk"}
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0), "two_sided": False, "radiance": 1.0, "visible": False}

    center_m: Vector
    """Its middle. Unit: m. Range: ±1000 each."""
    target_m: Vector
    """A point before it on its axis: it shines to that side. Unit: m. Range: ±1000 each."""
    radius_m: float
    """Its radius. Unit: m. Range: 1e-5 to 1000."""
    two_sided: bool = _default()
    """Whether the other side shines too. Default: ``false``."""


class RectangleLight(Light):
    """It faces the target and shines to its side."""

    _fixed = {"kind": "rectangle"}
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0), "rotation_deg": 0.0, "two_sided": False, "radiance": 1.0, "visible": False}

    center_m: Vector
    """Its middle. Unit: m. Range: ±1000 each."""
    target_m: Vector
    """A point before it on its axis: it shines to that side. Unit: m. Range: ±1000 each."""
    width_m: float
    """From side to side, across the height. Unit: m. Range: 1e-5 to 1000."""
    height_m: float
    """Along the direction in its plane that is nearest to y; to z, where it faces along y. Unit: m. Range: 1e-5 to 1000."""
    rotation_deg: float = _default()
    """Turns it about its axis, counter-clockwise as seen from the target. Unit: °. Default: 0. Range: ±360."""
    two_sided: bool = _default()
    """Whether the other side shines too. Default: ``false``."""


class PolygonLight(Light):
    """Flat; it shines to the side that sees its vertices counter-clockwise."""

    _fixed = {"kind": "polygon"}
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0), "two_sided": False, "radiance": 1.0, "visible": False}

    vertices_m: Union[Sequence[Vector], ArrayLike]
    """Its corners, in one plane and without crossing edges, convex or not. It shines to the side that sees them counter-clockwise. Unit: m. Range: 3 to 4096 points, ±1000 each."""
    two_sided: bool = _default()
    """Whether the other side shines too. Default: ``false``."""


class TubeLight(Light):
    """A straight lamp with round ends, all around: what is within the radius of the line. It lights nothing that is within it."""

    _fixed = {"kind": "tube"}
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0), "radiance": 1.0, "visible": False}

    ends_m: Union[Sequence[Vector], ArrayLike]
    """The ends of the line. Unit: m. Range: two points, ±1000 each."""
    radius_m: float
    """Its radius. Unit: m. Range: 1e-5 to 1000."""
    target_m: Optional[Vector] = _default()
    """What the cone points to. Unit: m. Default: none. Range: with ``cone_deg``, which needs it."""


class SunLight(Light):
    """A sun stands in one direction for all of the scene: a round lamp 100 km off."""

    _fixed = {"kind": "sun"}
    _absent = {"hidden": False, "exposure_ev": 0.0, "color": (1.0, 1.0, 1.0), "angle_deg": 0.53, "irradiance": 1.0}

    direction: Vector
    """The way that its light goes, of any length. Range: not zero."""
    angle_deg: float = _default()
    """The angle that it spans, across; the default is that of the sun. A wider one sends as much. Unit: °. Default: 0.53. Range: 0.01 to 90."""
    irradiance: float = _default()
    """What falls on a surface that faces it. 683 lux are 1 W m⁻². White paper under 3.14 has radiance 1. Unit: W m⁻². Default: 1. Range: 0 or more."""


class Look(Table):
    """``[[look]]``: another camera, exposure or light of the same objects, by a name."""

    _section = "look"
    _absent = {"light": ()}

    name: str
    """What the viewer's strip and the file of its picture call it by. Range: not empty, no two equal."""
    camera: Optional[Mapping[str, Any]] = _default()
    """In the place of ``[camera]``, all of it. Default: the scene's. Range: the keys of [``camera]``."""
    exposure_ev: Optional[float] = _default()
    """In the place of the camera's exposure. Unit: stops. Default: the camera's. Range: ±64."""
    environment: Optional[Mapping[str, Any]] = _default()
    """In the place of ``[environment]``. Default: none; the scene's, where the look has no light at all. Range: the keys of [``environment]``."""
    studio: Optional[Mapping[str, Any]] = _default()
    """In the place of ``[studio]``. Default: none; the scene's, where the look has no light at all. Range: the keys of [``studio]``."""
    light: Sequence[Mapping[str, Any]] = _default()
    """In the place of all ``[[light]]``s. Default: none; the scene's, where the look has no light at all. Range: the keys of [``[light]]``."""
