//! The sort of records into bricks, with copying the same bytes as a measure.
//!
//! `cargo bench --bench sort`. The example `bench_sort` compares with other sorts, in one run.

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use puncta::{Grid, GridConfig, Order, Scene, Source, Sphere, io::synthetic::Generator};
use std::hint::black_box;

fn records(spec: &str) -> Vec<Sphere> {
    let generator: Option<Generator> = spec.parse().ok();
    let scene = generator.and_then(|generator| generator.into_scene().ok());
    scene.map_or_else(Vec::new, |scene| scene.records.into_vec())
}

fn sort(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sort");
    group.sample_size(10);
    for (kind, n) in [("cube", 1_000_000), ("cube", 10_000_000), ("halo", 10_000_000)] {
        let records = records(&format!("{kind}:n={n}"));
        let input = format!("{kind}/{n}");
        group.throughput(Throughput::Elements(n));
        group.bench_function(BenchmarkId::new("copy", &input), |bencher| {
            let mut work = records.clone();
            bencher.iter(|| black_box(&mut work).copy_from_slice(black_box(&records)));
        });
        for cells in [25, 100] {
            let config = GridConfig::longest_side(cells);
            group.bench_function(BenchmarkId::new(format!("grid {cells}"), &input), |bencher| {
                bencher.iter_batched_ref(
                    || records.clone(),
                    |records| Grid::sort(records, &config),
                    BatchSize::LargeInput,
                );
            });
        }
        let config = GridConfig { order: Order::Stable, ..GridConfig::longest_side(100) };
        group.bench_function(BenchmarkId::new("stable, grid 100", &input), |bencher| {
            bencher.iter_batched_ref(
                || records.clone(),
                |records| Grid::sort(records, &config),
                BatchSize::LargeInput,
            );
        });
        group.bench_function(BenchmarkId::new("scene, grid 100", &input), |bencher| {
            bencher.iter_batched_ref(
                || Scene::new(records.clone()),
                |scene| Grid::sort_scene(scene, &GridConfig::longest_side(100)),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, sort);
criterion_main!(benches);
