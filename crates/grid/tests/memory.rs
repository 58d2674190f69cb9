//! The memory that sorting needs beside the records, counted by the allocator, all threads together.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use puncta_core::{Scene, Sphere};
use puncta_grid::{Fit, Grid, GridConfig, Resolution};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

/// The allocator of the system, which also counts.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

#[expect(unsafe_code, reason = "the trait of allocators is unsafe; all calls are handed on")]
// SAFETY: each call is handed on to the allocator of the system as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(now, Relaxed);
        // SAFETY: the caller keeps the contract of this very method.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Large blocks are moved page by page, so old and new are not there at once.
        let now = NOW.fetch_add(size, Relaxed) + size - layout.size();
        NOW.fetch_sub(layout.size(), Relaxed);
        PEAK.fetch_max(now, Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn cube(count: usize, clustered: usize) -> Vec<Sphere> {
    let mut state = 1_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    (0..count)
        .map(|i| if i < clustered { 0.01 } else { 1.0 })
        .map(|side| Sphere::new([next() * side, next() * side, next() * side], 1e-3))
        .collect()
}

/// The most bytes that were there at once, and the bricks.
fn measure(threads: usize, sort: impl FnOnce() -> Grid + Send) -> (usize, usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    // What threads need to come to life does not count.
    pool.broadcast(|_| rayon::current_thread_index());
    let before = NOW.load(Relaxed);
    PEAK.store(before, Relaxed);
    let bricks = pool.install(|| sort().bricks().len());
    (PEAK.load(Relaxed).saturating_sub(before), bricks)
}

fn memory_grows_with_bricks_and_threads_and_not_with_records() {
    for (count, clustered) in [(100_000, 0), (1_500_000, 0), (1_500_000, 1_000_000), (4_000_000, 0)]
    {
        for resolution in [1, 10, 30, 100].map(Resolution::LongestSide) {
            for (threads, fit) in [(1, Fit::Robust), (2, Fit::Whole), (3, Fit::Robust)] {
                let config = GridConfig { resolution, fit, ..GridConfig::default() };
                let mut records = cube(count, clustered);
                let (peak, bricks) =
                    measure(threads, || Grid::sort(&mut records, &config).unwrap());
                let allowed = 64 * bricks * threads + (1 << 20);
                assert!(
                    peak <= allowed,
                    "{count} records, {bricks} bricks, {threads} threads: {peak} bytes are more than {allowed}"
                );
            }
        }
    }
}

/// Many records in few bricks of many cells, where the buffers of threads are as large as they get.
fn buffers_of_threads_are_bounded() {
    for threads in [1, 2, 4] {
        let mut records = cube(1_000_000, 0);
        for (index, sphere) in records.iter_mut().enumerate() {
            let corner = if index % 2 == 0 { 0.0 } else { 20.0 };
            sphere.center = sphere.center.map(|x| corner + x);
        }
        let config = GridConfig { fit: Fit::Whole, ..GridConfig::longest_side(100) };
        let (peak, bricks) = measure(threads, || Grid::sort(&mut records, &config).unwrap());
        let allowed = 64 * bricks * threads + (1 << 20) + threads * (5 << 19);
        assert!(bricks < 1000, "{bricks} bricks");
        assert!(peak <= allowed, "{threads} threads: {peak} bytes are more than {allowed}");
    }
}

fn columns_need_no_more_than_a_buffer() {
    let mut scene = Scene::new(cube(1_000_000, 0));
    scene.keep_order();
    let config = GridConfig::longest_side(20);
    let (peak, bricks) = measure(2, || Grid::sort_scene(&mut scene, &config).unwrap());
    assert!(peak <= 128 * bricks + (1 << 20), "{peak} bytes for {bricks} bricks");
}

/// One after the other: all threads are counted.
#[test]
fn memory_is_bounded() {
    memory_grows_with_bricks_and_threads_and_not_with_records();
    buffers_of_threads_are_bounded();
    columns_need_no_more_than_a_buffer();
}
