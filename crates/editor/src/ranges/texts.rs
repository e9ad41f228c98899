//! Name of each parameter, and its effect on the look. Written for those who judge pictures; true to docs/model.md.

use super::parameter::Parameter;

pub(super) struct Text {
    pub label: &'static str,
    pub tooltip: &'static str,
}

pub(super) fn of(parameter: Parameter) -> Text {
    use Parameter as P;
    let (label, tooltip) = match parameter {
        P::CameraPosition => (
            "Position",
            "Where the camera stands. Scratches flash and change colour as it moves: each shows only to eyes in its own fan.",
        ),
        P::CameraTarget => (
            "Target",
            "The point in the middle of the picture; orbiting turns about it.",
        ),
        P::CameraUp => (
            "Up",
            "The direction that is up in the picture. Tilt it to roll the camera.",
        ),
        P::FieldOfView => (
            "Field of view",
            "Small: a long lens, flat, with highlights that spread over much of the surface. Large: a wide lens, with tighter highlights.",
        ),
        P::FocalLength => (
            "Focal length",
            "The field of view as lenses tell it: 24 mm is wide, 50 mm what the eye is used to, 100 mm and more for details. The f-stop stays.",
        ),
        P::SensorWidth => (
            "Sensor width",
            "How wide the film behind the lens is: 36 mm for full frame, 23.5 mm for APS-C, 6 mm for a phone. The focal length stays, so a narrower film sees less.",
        ),
        P::FStop => (
            "F-stop",
            "The focal length over the diameter of the opening: 1.4 to 2.8 blurs all but what is in focus, 11 to 22 keeps most of it sharp.",
        ),
        P::Aperture => (
            "Opening",
            "Diameter of the lens's opening: the larger, the sooner things blur before and behind what is in focus. The focal length over the f-stop.",
        ),
        P::FocusDistance => ("Focus", "How far away things are sharp, along the view."),
        P::Exposure => (
            "Exposure",
            "Each step doubles or halves the brightness. High enough for the core of a highlight to wash out softly, low enough to keep the colours around it.",
        ),
        P::PictureSize => (
            "Size",
            "Width and height of the picture. Larger pictures resolve single scratches; smaller ones blend them into sheen.",
        ),
        P::Filter => (
            "Filter",
            "How softly pixels blend into one another. Small: crisp scratches that may look jagged. Large: smooth lines, less sparkle.",
        ),
        P::EnvironmentRotation => (
            "Rotation",
            "Turns the surroundings about the vertical, and with them the reflections and the streaks that bright spots draw.",
        ),
        P::EnvironmentIntensity => (
            "Intensity",
            "Brightness of the surroundings. Dim ones let the colours of lamps on scratches stand out; bright ones wash them out.",
        ),
        P::StudioRotation => (
            "Rotation",
            "Turns the soft boxes and the lamp about the vertical, and with them their reflections on metal.",
        ),
        P::StudioIntensity => (
            "Intensity",
            "Brightness of all of the studio, its lamp and its room among them: reflections and the colours of scratches alike.",
        ),
        P::GroundHeight => (
            "Height",
            "Where the floor lies along the vertical. Just under an object, its shadow touches it; deeper, it floats.",
        ),
        P::Roughness => (
            "Roughness",
            "How far the polished highlight spreads. 0.05 to 0.15 leaves dark room around it where scratches shine; rougher surfaces drown them. The scratches themselves stay as sharp.",
        ),
        P::Clearcoat => (
            "Clear coat",
            "How much of the surface has a layer of lacquer. Scratches lie in it: it mirrors about 4 % without a colour, whatever shines from under it.",
        ),
        P::ClearcoatRoughness => (
            "Coat roughness",
            "How far the highlight of the coat spreads. 0 to 0.05 for car paint, more where it is matt.",
        ),
        P::Anisotropy => (
            "Anisotropy",
            "How far highlights are drawn out one way, as on brushed metal. 0: alike in all directions. 0.4 to 0.7 for brushed pans, lids and panels.",
        ),
        P::AnisotropyDirection => (
            "Drawn out",
            "Which way highlights are drawn out: across the brushing. 0 is along the horizontal of the texture coordinates, around the axis of what is turned; 90 is across.",
        ),
        P::Coherence => (
            "Coherence",
            "How far apart two points of the surface still act together on light. Larger: each scratch catches a lamp in a narrower band, so glints are thinner and crisper. Smaller: broader, softer glints. 20 suits most.",
        ),
        P::Ior => (
            "Refractive index",
            "How much the clear coat mirrors: 1.5 is lacquer or glass, about 4 %. Higher: brighter highlights and brighter scratches.",
        ),
        P::BaseColor => (
            "Colour",
            "On metals it tints the mirror image and the scratches in it; on coated surfaces it is the body under the coat, which scratches leave as it is. Dark bodies let scratches show.",
        ),
        P::Specular => (
            "Specular",
            "How much of its reflections what is no metal keeps. 1: those of plastic, refractive index 1.5. 0: none, as chalk.",
        ),
        P::SpecularColor => (
            "Specular colour",
            "The colour of what it reflects straight on, as far as it is no metal. White for all but cloth, feathers and other things of many layers.",
        ),
        P::Metallic => (
            "Metallic",
            "0: a painted surface with weak, white reflections. 1: bare metal, whose reflections and scratches are bright and take its colour.",
        ),
        P::Translation => ("Position", "Moves the object with its scratches."),
        P::Rotation => (
            "Rotation",
            "Turns the object about the world's x axis, then y, then z. Scratches turn along, so their fans sweep through the light.",
        ),
        P::Scale => (
            "Scale",
            "Makes the object larger or smaller; scratches keep their own lengths, widths and depths, and cover it less or more densely. Negative mirrors it.",
        ),
        P::PlaneSize => (
            "Edge",
            "Length of an edge. With a count, the same scratches spread over more surface; with a density, there are more of them.",
        ),
        P::ShapeRadius => (
            "Radius",
            "Half its width. With a count, the same scratches spread over more surface; with a density, there are more of them.",
        ),
        P::ShapeHeight => ("Height", "From its lower to its upper end."),
        P::TubeRadius => (
            "Tube radius",
            "Half the thickness of the ring, below its radius. A thin tube draws highlights out to fine lines.",
        ),
        P::Rounding => (
            "Rounding",
            "Radius of its edges. Rounded edges catch a line of light from almost everywhere; 0 leaves them sharp and dark.",
        ),
        P::TextDepth => (
            "Depth",
            "How far the letters stand out of what they stand on.",
        ),
        P::FitSize => (
            "Fitted size",
            "The largest extent of the model, whatever it is in its file.",
        ),
        P::Time => (
            "Time (s)",
            "Seconds from the start of the model's animation. Its scratches are laid anew where it stands then.",
        ),
        P::LatheSegments => (
            "Segments",
            "Facets around the axis. More: a rounder outline and smoother highlights, and a little more work.",
        ),
        P::ProfileRadius => (
            "Radius",
            "Distance of this point of the outline from the axis. Steps and bends of the outline show as rings of highlight.",
        ),
        P::ProfileHeight => (
            "Height",
            "Height of this point of the outline along the axis.",
        ),
        P::Count => (
            "Count",
            "Number of scratches. More: a denser, brighter sheen, and a polished highlight that loses the light they take. A higher count keeps the first ones in their place.",
        ),
        P::Density => (
            "Density",
            "Scratches for each square metre: a larger object gets more of them. More: a denser, brighter sheen, less light left in the polished highlight.",
        ),
        P::Seed => (
            "Seed",
            "Another number lays other scratches of the same kind, or puts the grooves of a grating in other places, as seen from nearby. Layers with different numbers do not repeat one another.",
        ),
        P::Length => (
            "Length",
            "Mean length. Long scratches draw unbroken arcs of colour across the surface; short ones break them into dashes and glitter.",
        ),
        P::LengthSpread => (
            "Length spread",
            "How much lengths differ. 0 looks machined; 0.5 and above mixes long strokes with nicks, as wear does.",
        ),
        P::Width => (
            "Width",
            "Wider scratches: brighter, and the rainbow starts closer to the highlight and its colours lie denser. Narrow ones spread it far out; below 2 µm little more than its first tint is seen.",
        ),
        P::WidthSpread => (
            "Width spread",
            "How much widths differ. Small: rainbows of all scratches agree and their bands stay apart. Large: bands blur into one another, further out first.",
        ),
        P::Depth => (
            "Depth",
            "Picks the overall tint, also close to the highlight: each depth favours some wavelengths and cancels others. Very shallow scratches are faint and bluish. Seen or lit aslant they act shallower, so tints shift as things turn.",
        ),
        P::DepthSpread => (
            "Depth spread",
            "How much depths differ. Up to 0.15 scratches share a tint and colours stay clean; above 0.2 tints mix to straw and white.",
        ),
        P::Curvature => (
            "Curvature",
            "One over the radius of the arcs. 0 is straight. Bent scratches turn through many directions, so each lights up over a shorter piece, and more of them light up at once.",
        ),
        P::CurvatureSpread => (
            "Curvature spread",
            "How much bends differ, to both sides. Some is what makes wear look casual instead of ruled.",
        ),
        P::Jitter => (
            "Jitter",
            "How far scratches stray from the pattern's direction. 0: fans and streaks with hard edges, as new. A few degrees soften them and look worn.",
        ),
        P::Axis => (
            "Axis",
            "The direction that the pattern turns about, in the object's own frame.",
        ),
        P::AxisCenter => (
            "Centre",
            "The point that the pattern turns about, in the object's own frame. Fans of light meet there.",
        ),
        P::Direction => (
            "Direction",
            "Where the scratches run, in the object's own frame. Lamps are drawn out into streaks across it.",
        ),
        P::Edges => (
            "Edges",
            "Wear comes first where a surface stands out. At 1 there are scratches at convex edges alone, at 0 everywhere alike.",
        ),
        P::EdgeWidth => (
            "Edge width",
            "How far from an edge there are scratches. Narrow: a bright line along it. Wide: a soft border.",
        ),
        P::Tile => (
            "Tile",
            "How wide the pictures are, laid on from three sides and repeated. Small ones show that they repeat.",
        ),
        P::PlaceCenter => (
            "Middle",
            "What the radii are counted from, in the object's own frame: the spot that a hand rubs.",
        ),
        P::PlaceInnerRadius => (
            "Inner radius",
            "There are no scratches nearer to the middle than this.",
        ),
        P::PlaceOuterRadius => (
            "Outer radius",
            "There are no scratches farther from the middle than this.",
        ),
        P::Pitch => (
            "Pitch",
            "From one groove to the next. Fine rows throw wide rainbows far out, coarse ones narrow rainbows close to the highlight. Disc 1.6, DVD 0.74, turned steel 30.",
        ),
        P::GrooveWidth => (
            "Groove width",
            "How much of the pitch is groove. Half of it gives the brightest first order and no second one; narrow grooves send more light to far orders.",
        ),
        P::GrooveDepthSpread => (
            "Depth spread",
            "How much the depths of grooves differ, as a share of the mean. It weakens the rainbows and adds a white sheen that single grooves send.",
        ),
        P::Displacement => (
            "Displacement",
            "How far grooves are off their places. A tenth of the pitch keeps two thirds of the first rainbow; at a quarter all grooves shine for themselves.",
        ),
        P::GrooveAngles => (
            "Angles",
            "How far grooves stray from the pattern's direction. 0 gives lines of light with hard edges; a degree or more makes soft fans of them.",
        ),
        P::SpotSpacing => (
            "Spacing",
            "From one spot of grooves to the next. Each spot lies over those before it, so rows look like scales; lamps draw a line through each.",
        ),
        P::Coverage => (
            "Coverage",
            "The share of the surface that the grooves cover. The rest mirrors as the material does.",
        ),
        P::InnerRadius => (
            "Inner radius",
            "There are no grooves nearer to the middle than this.",
        ),
        P::OuterRadius => (
            "Outer radius",
            "There are no grooves farther from the middle than this.",
        ),
        P::BrushRadius => (
            "Brush radius",
            "Half the width of the band in which scratches are laid or taken away.",
        ),
        P::BrushDensity => (
            "Brush density",
            "Scratches for each metre of a stroke. Few: single marks. Many: a worn track.",
        ),
        P::BrushWidth => (
            "Width factor",
            "Factor on the widths of the layer for this stroke. Above 1: bolder, with denser rainbows. Below 1: finer, with wider ones.",
        ),
        P::BrushDepth => (
            "Depth factor",
            "Factor on the depths of the layer for this stroke. It shifts the tint of the stroke against the rest.",
        ),
        P::LightCenter => (
            "Position",
            "Where the light hangs. Around its highlight those scratches light up that run crosswise to the way there.",
        ),
        P::LightRadius => (
            "Radius",
            "Small lights give pure rainbows and hard-edged glints; large ones overlap the colours to white around the highlight. At the same radiance a larger one also lights more.",
        ),
        P::LightTarget => (
            "Target",
            "A point that the light faces. Its distance does not matter.",
        ),
        P::LightWidth => (
            "Width",
            "From side to side. Narrow lights keep colours pure across their width.",
        ),
        P::LightHeight => (
            "Height",
            "From lower to upper edge. Long lights fill more scratches with colour.",
        ),
        P::LightRotation => (
            "Rotation",
            "Turns the light about its axis, counter-clockwise as seen from its target.",
        ),
        P::LightVertex => (
            "Corner",
            "A corner of the light. Its outline is mirrored in the surface, and scratches draw it out; long, thin shapes keep colours pure across their short side.",
        ),
        P::LightEnd => (
            "End",
            "An end of the line within the tube. Scratches that run along the tube show colours across it.",
        ),
        P::SunDirection => (
            "Direction",
            "The way that the light goes, from the sun to the scene. Its length does not matter.",
        ),
        P::SunAngle => (
            "Angle",
            "How wide it is as seen from the scene: the sun 0.53 degrees. A wider one blurs rainbows and the edges of shadows; the scene stays as bright.",
        ),
        P::Irradiance => (
            "Irradiance",
            "What falls on a surface that faces the sun, W per square metre; 683 lux are 1. White paper under 3.14 is as bright as white gets.",
        ),
        P::LightCone => (
            "Cone",
            "The angle of the cone from rim to rim. Outside of it there is no light.",
        ),
        P::LightSoftness => (
            "Softness",
            "The part of the way from rim to axis in which the light falls off.",
        ),
        P::LightDoor => (
            "Barn door",
            "The angle between the light's axis and a flap that ends its light: left, right, above and below as seen from its target. 90 is open.",
        ),
        P::Radiance => (
            "Radiance",
            "Brightness of the light as it is seen. 40 to 200 for small lamps in dim surroundings lets the highlight clip and its scratches glow.",
        ),
        P::LightExposure => (
            "Stops",
            "Each stop doubles the radiance: for balancing lights against one another.",
        ),
        P::LightTemperature => (
            "Temperature",
            "Colour of a glowing body: 2700 K for a warm bulb, 5600 K for a flash, 6500 K for daylight. Brightness stays.",
        ),
        P::LightColor => (
            "Colour",
            "Tint of the light. Scratches split what is in it: white light shows every colour, a warm one fewer blues.",
        ),
    };
    Text { label, tooltip }
}
