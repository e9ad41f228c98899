// What a scene has. Pipelines are compiled for it, and code for what is not there goes away. Twin: src/shade.rs.

override HAS_SCRATCHES: bool = true;
override HAS_SPHERES: bool = true;
override HAS_POLYGONS: bool = true;
// With more than four vertices.
override HAS_LARGE_POLYGONS: bool = true;
override HAS_ENVIRONMENT: bool = true;
override HAS_TEXTURES: bool = true;
