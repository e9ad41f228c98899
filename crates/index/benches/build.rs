//! Building of the trees that find the scratches under a pixel.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hairline_index::ScratchIndex;
use hairline_scene::Scene;

fn scene(shape: &str, count: u32) -> Scene {
    let text = format!(
        "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\n\
         [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ {shape} }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = {count}\nseed = 1\n\
         length_m = {{ mean = 0.01, spread = 0.5 }}\nwidth_um = 2.0\ndepth_nm = 200.0\n\
         curvature_per_m = {{ mean = 0.0, spread = 4.0 }}\n"
    );
    hairline_document::from_toml(&text, "bench", ".").expect("a scene that can be built")
}

fn build(c: &mut Criterion) {
    for count in [1_000, 10_000, 100_000] {
        let mut group = c.benchmark_group(format!("{count} scratches"));
        group.sample_size(10);
        group.throughput(Throughput::Elements(count.into()));
        let disk = scene("disk = { radius_m = 0.08 }", count);
        group.bench_function("ScratchIndex::build, disk", |b| {
            b.iter(|| ScratchIndex::build(&disk))
        });
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
