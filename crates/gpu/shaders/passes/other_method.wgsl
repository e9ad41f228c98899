// Arrays that the pass of another method binds, in the place of shade_base and shade_scratches. Its tables follow them. A workgroup takes a group of
// samples, and fills their base light and one chunk of sums. Twin: src/method.rs.
// Needs: layout.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read_write> base_light: array<BaseLight>;
// One chunk for each group.
@group(3) @binding(3) var<storage, read_write> chunk_sums: array<ChunkSum>;
@group(3) @binding(4) var<storage, read_write> film: Film;
