//! Growth of the laying of scratches, and of building the trees that find them, with their number: time, cores at work, and
//! memory.
//!
//! `cargo bench -p hairline-index --bench growth` prints a table; numbers behind `--` are other counts than 10,000, 100,000 and
//! 1,000,000. No statistics crate: each step takes seconds, and what is asked is how it grows.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use hairline_document::Loader;
use hairline_index::ScratchIndex;
use hairline_scene::Scene;

/// The system's allocator with a count of the bytes in use.
struct Counting;

static TAKEN: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

impl Counting {
    fn take(bytes: usize) {
        let taken = TAKEN.fetch_add(bytes, Ordering::Relaxed) + bytes;
        MOST.fetch_max(taken, Ordering::Relaxed);
    }
}

// SAFETY: all is handed on to the system's allocator as it came.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::take(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        TAKEN.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Self::take(size);
        TAKEN.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Cost of a step.
#[derive(Clone, Copy)]
struct Step {
    wall: Duration,
    cpu: Duration,
    /// The most that was taken at any time, all that was there before included.
    peak_bytes: usize,
    /// Memory that is left of the step when it is done.
    kept_bytes: usize,
}

fn step<T>(work: impl FnOnce() -> T) -> (T, Step) {
    let before = TAKEN.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    let (start, cpu_start) = (Instant::now(), cpu_time());
    let made = work();
    let step = Step {
        wall: start.elapsed(),
        cpu: cpu_time().saturating_sub(cpu_start),
        peak_bytes: MOST.load(Ordering::Relaxed),
        kept_bytes: TAKEN.load(Ordering::Relaxed).saturating_sub(before),
    };
    (made, step)
}

/// Processor time of all threads, where the system tells it.
fn cpu_time() -> Duration {
    // Fields 14 and 15 in hundredths of a second; the second one, a name in brackets, may hold spaces.
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(") ").next().unwrap_or_default();
    let ticks = fields.split(' ').skip(11).take(2);
    let ticks: u64 = ticks.filter_map(|t| t.parse::<u64>().ok()).sum();
    Duration::from_millis(10 * ticks)
}

const STEPS: [&str; 2] = ["laid", "tree"];
/// Number of runs. The shortest one counts, since other work on the machine only makes a run longer.
const RUNS: usize = 3;

struct Row {
    count: u64,
    segments: usize,
    /// Costs in the order of [`STEPS`].
    steps: Vec<Step>,
}

fn measure(count: u64) -> Row {
    let text = format!(
        "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\n\
         [[material]]\nname = \"m\"\nkind = \"mirror\"\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ disk = {{ radius_m = 0.08 }} }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = {count}\nseed = 1\n\
         length_m = {{ mean = 0.01, spread = 0.5 }}\nwidth_um = {{ mean = 2.0, spread = 0.3 }}\ndepth_nm = 200.0\n\
         curvature_per_m = {{ mean = 0.0, spread = 4.0 }}\n"
    );
    let loader = Loader {
        memory_budget_bytes: u64::MAX,
        ..Loader::default()
    };
    let (scene, lay): (Scene, _) = step(|| {
        let scene = loader.from_toml(&text, "bench", ".");
        scene.unwrap_or_else(|error| panic!("{error}"))
    });
    let (tree, built) = step(|| ScratchIndex::build(&scene));
    let segments = tree.tree.segments.len();
    let steps = vec![lay, built];
    Row {
        count,
        segments,
        steps,
    }
}

fn main() {
    // `cargo test --benches` only wants to see it compile and begin.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let asked: Vec<u64> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let counts = match asked.as_slice() {
        [] => vec![10_000, 100_000, 1_000_000],
        _ => asked,
    };
    // Threads and tables that the first one would pay for.
    measure(1000);
    println!(
        "scratches of 10 mm on a disk of 16 cm, {} threads, the shortest of {RUNS} runs; bytes for each scratch; growth as a power \
         of the number, and that of n log n\n",
        rayon::current_num_threads()
    );
    println!("| scratches | pieces | step | wall s | CPU s | cores | growth | peak B | kept B |");
    println!("|---:|---:|---|---:|---:|---:|---:|---:|---:|");
    let mut last: Option<Row> = None;
    for count in counts {
        let mut row = measure(count);
        for _ in 1..RUNS {
            for (least, step) in row.steps.iter_mut().zip(measure(count).steps) {
                if step.wall < least.wall {
                    *least = step;
                }
            }
        }
        for (i, (name, step)) in STEPS.iter().zip(&row.steps).enumerate() {
            let (wall, cpu) = (step.wall.as_secs_f64(), step.cpu.as_secs_f64());
            // Growth of the wall time over that of the number: 1 is proportional.
            let growth = last.as_ref().map_or("–".to_owned(), |last| {
                let times = wall / last.steps[i].wall.as_secs_f64();
                let (n, before) = (row.count as f64, last.count as f64);
                let power = |times: f64| times.ln() / (n / before).ln();
                let sorting = n * n.ln() / (before * before.ln());
                format!("{:.2} ({:.2})", power(times), power(sorting))
            });
            let each = |bytes: usize| bytes as f64 / count as f64;
            println!(
                "| {count} | {} | {name} | {wall:.3} | {cpu:.2} | {:.1} | {growth} | {:.0} | {:.0} |",
                row.segments,
                cpu / wall,
                each(step.peak_bytes),
                each(step.kept_bytes),
            );
        }
        last = Some(row);
    }
}
