// Contents of a scene. Pipelines are compiled for it, without the code for what is not there. Twin:
// src/variant.rs.

override HAS_SCRATCHES: bool = true;
override HAS_GRATINGS: bool = true;
// Gratings with tables by incidence, and with tables by depth.
override HAS_FINE_GRATINGS: bool = true;
override HAS_COARSE_GRATINGS: bool = true;
// Gratings whose grooves could be seen one by one.
override HAS_SINGLE_GROOVES: bool = true;
// Whether some grooves come nearer to one another along their way.
override HAS_BRANCHING_GROOVES: bool = true;
// Gratings with pictures, or along texture coordinates.
override HAS_GROOVE_MAPS: bool = true;
// Gratings whose grooves lie about spots.
override HAS_GROOVE_SPOTS: bool = true;
override HAS_SPHERES: bool = true;
// Tubes too, whose outlines are polygons.
override HAS_POLYGONS: bool = true;
override HAS_TUBES: bool = true;
// Lights with corners are all of a kind.
override ONLY_TUBES: bool = false;
override ONLY_PICTURES: bool = false;
override HAS_ENVIRONMENT: bool = true;
override HAS_DOORS: bool = true;
override HAS_PICTURES: bool = true;
override HAS_TEXTURES: bool = true;
// Surfaces with normal maps.
override HAS_BUMPS: bool = true;
// Colours of vertices.
override HAS_COLORS: bool = true;
// Surfaces with cutouts.
override HAS_CUTOUTS: bool = true;
// Materials that are not metal through and through: light falls on a body under the surface.
override HAS_BODIES: bool = true;
// Materials whose facets lean further one way than across it.
override HAS_ANISOTROPY: bool = true;
// Dielectrics with other reflections than their refractive index says.
override HAS_SPECULAR: bool = true;
// Clear layers whose normals are not those of what is under them.
override HAS_COAT_NORMALS: bool = true;
// Materials under a clear layer, and which curve of reflectance such layers have.
override HAS_COATS: bool = true;
override COAT_CURVE: u32 = 0u;
