//! Laying scratches: on a disk, where a scratch is one straight piece a triangle of few, and on a mesh of many triangles.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hairline_scene::{Description, Scene};
use std::path::Path;

/// A scene of one object. Whatever else it takes to build it (nothing to speak of) is measured too.
fn description(shape: &str, count: u32) -> Description {
    let text = format!(
        "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\n\
         [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ {shape} }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = {count}\nseed = 1\n\
         length_m = {{ mean = 0.03, spread = 0.5 }}\nwidth_um = 2.0\ndepth_nm = 200.0\n\
         curvature_per_m = {{ mean = 0.0, spread = 4.0 }}\n"
    );
    Description::from_toml(&text, Path::new("bench")).expect("a scene that can be read")
}

fn lay_scratches(c: &mut Criterion) {
    for (name, shape) in [
        ("disk", "disk = { radius_m = 0.08 }"),
        ("mesh", "sphere = { radius_m = 0.05 }"),
    ] {
        let mut group = c.benchmark_group(format!("lay_scratches, {name}"));
        group.sample_size(10);
        for count in [1_000, 10_000, 100_000] {
            let description = description(shape, count);
            group.throughput(Throughput::Elements(count.into()));
            group.bench_function(BenchmarkId::from_parameter(count), |b| {
                b.iter(|| Scene::build(&description, ".").map(|s| s.objects[0].segments.len()))
            });
        }
    }
}

criterion_group!(benches, lay_scratches);
criterion_main!(benches);
