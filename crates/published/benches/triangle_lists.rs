//! Building of the lists of the triangles of a finely cut mesh.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hairline_fixtures::SceneFile;
use hairline_index::ScratchIndex;
use hairline_published::triangle_lists::TriangleLists;

fn build(c: &mut Criterion) {
    for count in [1_000, 10_000, 100_000] {
        let scene = SceneFile::seen_from([0.0, -0.3, 0.3])
            .mirror("m")
            .object("o", "m", "sphere = { radius_m = 0.05 }")
            .random("o", count)
            .with_lines("seed = 1\nlength_m = { mean = 0.01, spread = 0.5 }\nwidth_um = 2.0\ndepth_nm = 200.0")
            .with_lines("curvature_per_m = { mean = 0.0, spread = 4.0 }")
            .scene();
        let index = ScratchIndex::laid(&scene);
        let mut group = c.benchmark_group(format!("{count} scratches"));
        group.sample_size(10);
        group.throughput(Throughput::Elements(count.into()));
        group.bench_function("TriangleLists::build, sphere", |b| {
            b.iter(|| TriangleLists::build(&scene, &index))
        });
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
