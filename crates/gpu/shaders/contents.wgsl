// What a scene has. Pipelines are compiled for it, and code for what is not there goes away. Twin: src/variant.rs.

override HAS_SCRATCHES: bool = true;
override HAS_SPHERES: bool = true;
override HAS_POLYGONS: bool = true;
// With more than four vertices.
override HAS_LARGE_POLYGONS: bool = true;
// So many that pairs with scratches are found before any is lit.
override HAS_MANY_LIGHTS: bool = true;
override HAS_ENVIRONMENT: bool = true;
override HAS_TEXTURES: bool = true;
// Materials that are not metal through and through: light falls on a body under the surface.
override HAS_BODIES: bool = true;
