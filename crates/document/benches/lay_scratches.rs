//! Laying scratches: on a disk, where a scratch is one straight piece a triangle of few, and on a mesh of many triangles; drawn at random,
//! and from a list.

use std::path::Path;
use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hairline_document::{Arrays, Description, Loader, ScratchArrays};

/// A scene of one object. Whatever else it takes to build it (nothing to speak of) is measured too.
fn description(shape: &str, scratches: &str) -> Description {
    let text = format!(
        "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\n\
         [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ {shape} }}\n\
         [[light]]\nkind = \"sphere\"\ncenter_m = [0.0, 0.2, 0.3]\nradius_m = 0.01\n\
         [[scratches]]\nobject = \"o\"\n{scratches}"
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
        for count in [1_000_u32, 10_000, 100_000] {
            let drawn = format!(
                "pattern = \"random\"\ncount = {count}\nseed = 1\n\
                 length_m = {{ mean = 0.03, spread = 0.5 }}\nwidth_um = 2.0\ndepth_nm = 200.0\n\
                 curvature_per_m = {{ mean = 0.0, spread = 4.0 }}\n"
            );
            let description = description(shape, &drawn);
            group.throughput(Throughput::Elements(count.into()));
            group.bench_function(BenchmarkId::from_parameter(count), |b| {
                b.iter(|| {
                    hairline_document::build(&description, ".").map(|s| s.objects[0].segments.len())
                })
            });
        }
    }
}

/// Ends of straight scratches of 4 mm on a disk of 7 cm, spread evenly.
fn ends_m(count: u32) -> Vec<[[f64; 3]; 2]> {
    let place = |i: u32| {
        let radius_m = 0.07 * (f64::from(i) / f64::from(count)).sqrt();
        let (y, x) = (2.399_963_2 * f64::from(i)).sin_cos();
        let (v, u) = (0.7 * f64::from(i)).sin_cos();
        [-0.002, 0.002].map(|s| [radius_m * x + s * u, radius_m * y + s * v, 0.0])
    };
    (0..count).map(place).collect()
}

fn lay_lists(c: &mut Criterion) {
    const COUNT: u32 = 100_000;
    let arrays = ScratchArrays::new(ends_m(COUNT), [&[2.0], &[150.0]]).expect("scratches");
    let mut all = Arrays::default();
    all.insert_scratches("list", Arc::new(arrays));
    let loader = Loader {
        arrays: &all,
        ..Loader::default()
    };
    let mut group = c.benchmark_group("lay_scratches, list");
    group.sample_size(10);
    group.throughput(Throughput::Elements(COUNT.into()));
    for (name, shape) in [
        ("disk", "disk = { radius_m = 0.08 }"),
        ("plane", "plane = { size_m = [0.2, 0.2] }"),
    ] {
        let description = description(shape, "pattern = \"file\"\nfile = \"list\"\n");
        group.bench_function(name, |b| {
            b.iter(|| {
                let scene = loader.build(&description, ".");
                scene.map(|s| s.objects[0].segments.len())
            })
        });
    }
}

criterion_group!(benches, lay_scratches, lay_lists);
criterion_main!(benches);
