//! Parameters that panels edit.

/// A number, or the numbers of a vector or a colour, that a panel edits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// `camera.position_m`
    CameraPosition,
    /// `camera.target_m`
    CameraTarget,
    /// `camera.up`
    CameraUp,
    /// `camera.fov_y_deg`
    FieldOfView,
    /// `camera.focal_length_mm`, in metres
    FocalLength,
    /// `camera.sensor_width_mm`, in metres
    SensorWidth,
    /// `camera.f_stop`
    FStop,
    /// `camera.aperture_mm`, in metres
    Aperture,
    /// `camera.focus_distance_m`
    FocusDistance,
    /// `camera.exposure_ev`
    Exposure,
    /// `render.size_px`
    PictureSize,
    /// `render.filter_std_px`
    Filter,
    /// `environment.rotation_deg`
    EnvironmentRotation,
    /// `environment.intensity`
    EnvironmentIntensity,
    /// `studio.rotation_deg`
    StudioRotation,
    /// `studio.intensity`
    StudioIntensity,
    /// `ground.height_m`
    GroundHeight,
    /// `material.roughness`
    Roughness,
    /// `material.clearcoat`
    Clearcoat,
    /// `material.clearcoat_roughness`
    ClearcoatRoughness,
    /// `material.anisotropy`
    Anisotropy,
    /// `material.anisotropy_direction_deg`
    AnisotropyDirection,
    /// `material.coherence_um`
    Coherence,
    /// `material.ior`
    Ior,
    /// `material.base_color`
    BaseColor,
    /// `material.metallic`
    Metallic,
    /// `material.specular`
    Specular,
    /// `material.specular_color`
    SpecularColor,
    /// `object.translation_m`
    Translation,
    /// `object.rotation_deg`
    Rotation,
    /// `object.scale`
    Scale,
    /// `size_m` of a plane, a box or a sweep.
    PlaneSize,
    /// `radius_m` of a shape.
    ShapeRadius,
    /// `height_m` of a shape.
    ShapeHeight,
    /// `tube_radius_m` of a torus.
    TubeRadius,
    /// `rounding_m` of a shape.
    Rounding,
    /// `depth_m` of a text.
    TextDepth,
    /// `fit_m` of a model.
    FitSize,
    /// `time_s` of a model.
    Time,
    /// `segments` of a lathe.
    LatheSegments,
    /// The radius of a point of a lathe's profile.
    ProfileRadius,
    /// The height of a point of a lathe's profile.
    ProfileHeight,
    /// `scratches.count`
    Count,
    /// `scratches.density_per_m2`
    Density,
    /// `scratches.seed`
    Seed,
    /// Mean of `scratches.length_m`
    Length,
    /// Spread of `scratches.length_m`
    LengthSpread,
    /// Mean of `scratches.width_um`
    Width,
    /// Spread of `scratches.width_um`
    WidthSpread,
    /// Mean of `scratches.depth_nm`
    Depth,
    /// Spread of `scratches.depth_nm`
    DepthSpread,
    /// Mean of `scratches.curvature_per_m`
    Curvature,
    /// Spread of `scratches.curvature_per_m`
    CurvatureSpread,
    /// `scratches.jitter_deg`
    Jitter,
    /// `scratches.axis`
    Axis,
    /// `scratches.center_m`
    AxisCenter,
    /// `scratches.direction`
    Direction,
    /// `scratches.where.edges`
    Edges,
    /// `scratches.where.edge_width_m`
    EdgeWidth,
    /// `scratches.where.tile_m`
    Tile,
    /// `scratches.where.center_m`
    PlaceCenter,
    /// The first of `scratches.where.radius_m`
    PlaceInnerRadius,
    /// The second of `scratches.where.radius_m`
    PlaceOuterRadius,
    /// `grating.pitch_um`
    Pitch,
    /// `grating.width_um`
    GrooveWidth,
    /// Spread of `grating.depth_nm`
    GrooveDepthSpread,
    /// `grating.jitter_um`
    Displacement,
    /// `grating.jitter_deg`
    GrooveAngles,
    /// `grating.spacing_m`
    SpotSpacing,
    /// `grating.coverage`
    Coverage,
    /// The first of `grating.radius_m`
    InnerRadius,
    /// The second of `grating.radius_m`
    OuterRadius,
    /// `radius_m` of a stroke.
    BrushRadius,
    /// `density_per_m` of a stroke.
    BrushDensity,
    /// `width` of a stroke.
    BrushWidth,
    /// `depth` of a stroke.
    BrushDepth,
    /// `light.center_m`
    LightCenter,
    /// `light.target_m`
    LightTarget,
    /// `light.radius_m`
    LightRadius,
    /// `light.width_m`
    LightWidth,
    /// `light.height_m`
    LightHeight,
    /// `light.rotation_deg`
    LightRotation,
    /// A point of `light.vertices_m`
    LightVertex,
    /// An end of `light.ends_m`
    LightEnd,
    /// `light.direction`
    SunDirection,
    /// `light.angle_deg`
    SunAngle,
    /// `light.irradiance`
    Irradiance,
    /// `light.cone_deg`
    LightCone,
    /// `light.cone_softness`
    LightSoftness,
    /// An angle of `light.barn_doors_deg`
    LightDoor,
    /// `light.radiance`
    Radiance,
    /// `light.exposure_ev`
    LightExposure,
    /// `light.temperature_k`
    LightTemperature,
    /// `light.color`
    LightColor,
}
