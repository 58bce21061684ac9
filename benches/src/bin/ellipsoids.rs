//! Measures what `lj-ellipsoid` is to reach, all of it in one run: times beside their goals, passes over the points,
//! memory beyond the input, and the ratio to Khachiyan's method with away steps on the same points.
//!
//! `ellipsoids [DIRECTORY]…`: each directory holds the meshes of one robot (OBJ), whose links are enclosed one by one.
//!
//! A time is thread CPU time of one call, the smallest of many.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "printing is what it is for")]

use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use cpu_time::ThreadTime;
use lj_ellipsoid::{
    Enclosing, EnclosingMethod, EnclosingOptions, HalfSpace, InscribedOptions, MovingPoints, enclosing, inscribed,
};
use workloads::rng::Rng;
use workloads::w4_enclosing::{Cloud, cloud, corners, halfspaces, in_ball, on_sphere};

/// The gap on ln det of every row that does not say otherwise.
const TIGHT: EnclosingOptions = EnclosingOptions::new().with_epsilon(1e-12);

/// What the first-order method is compared at.
const COMPARED: EnclosingOptions = EnclosingOptions::new().with_epsilon(1e-7);

/// What a row may spend.
const BUDGET: Duration = Duration::from_millis(700);

/// What is measured at once.
const STRETCH: Duration = Duration::from_millis(3);

/// The time of one call of `task`, in seconds: the smallest of many means over some milliseconds, within `budget` but
/// of at least one call. Shorter stretches would measure the clock: it is off by a microsecond where a thread changes
/// cores.
fn seconds(budget: Duration, mut task: impl FnMut()) -> f64 {
    let begin = ThreadTime::now();
    let mut best = f64::INFINITY;
    let mut calls = 1u32;
    loop {
        let clock = ThreadTime::now();
        (0..calls).for_each(|_| task());
        let elapsed = clock.elapsed();
        if elapsed >= STRETCH || begin.elapsed() > budget {
            best = best.min(elapsed.as_secs_f64() / f64::from(calls));
        } else {
            calls *= 2;
        }
        if begin.elapsed() > budget {
            return best;
        }
    }
}

/// A time for people.
fn shown(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.2} µs", 1e6 * s),
        s if s < 1.0 => format!("{:.2} ms", 1e3 * s),
        s => format!("{s:.2} s"),
    }
}

fn row(name: &str, seconds: f64, goal: f64, remark: &str) {
    let verdict = if seconds <= goal { "reached" } else { "MISSED" };
    println!("| {name} | {} | {} | {verdict} | {remark} |", shown(seconds), shown(goal));
}

fn remark<const N: usize>(answer: &Enclosing<N>) -> String {
    format!("gap {:.0e}, {} steps, {} passes", answer.log_det_gap, answer.iterations, answer.scans)
}

fn measure<const N: usize>(name: &str, points: &[[f64; N]], goal: f64) {
    let answer = enclosing(points, TIGHT).expect("the points span the space");
    let time = seconds(BUDGET, || _ = black_box(enclosing(black_box(points), TIGHT)));
    row(name, time, goal, &remark(&answer));
}

fn compare(name: &str, points: &[[f64; 3]]) {
    let khachiyan = COMPARED.with_method(EnclosingMethod::Khachiyan).with_max_iterations(20_000);
    let newton = seconds(BUDGET, || _ = black_box(enclosing(black_box(points), COMPARED)));
    let answer = enclosing(points, khachiyan).expect("the points span the space");
    let slow = seconds(BUDGET, || _ = black_box(enclosing(black_box(points), khachiyan)));
    println!(
        "| {name} | {} | {} | {}{:.0} | {} moves, gap {:.0e} |",
        shown(newton),
        shown(slow),
        if answer.log_det_gap > COMPARED.epsilon { "> " } else { "" },
        slow / newton,
        answer.iterations,
        answer.log_det_gap
    );
}

/// The most memory this process ever held, in bytes, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}

/// Before anything else is allocated: how far a solve raises the peak, as a share of the points' bytes.
fn memory(name: &str, points: &[[f64; 3]]) {
    let Some(before) = peak() else { return };
    _ = black_box(enclosing(points, TIGHT));
    let Some(after) = peak() else { return };
    println!("memory beyond the input, {name}: {:.3} of its size", (after - before) / size_of_val(points) as f64);
}

fn enclosed() {
    println!("\n| points | time | goal | | |\n|---|---|---|---|---|");
    measure("box, N = 2, m = 4", &corners([2.0, 1.0]), 2e-6);
    measure("normal, N = 2, m = 8 (W4)", &cloud::<2>(Cloud::Normal, 8), 2e-6);
    measure("cube, N = 2, m = 8 (W4)", &cloud::<2>(Cloud::Cube, 8), 2e-6);
    measure("box, N = 3, m = 8", &corners([3.0, 2.0, 1.0]), 3e-6);
    measure("normal, N = 3, m = 8 (W4)", &cloud::<3>(Cloud::Normal, 8), 3e-6);
    measure("cube, N = 3, m = 8 (W4)", &cloud::<3>(Cloud::Cube, 8), 3e-6);
    measure("normal, N = 2, m = 100 (W4)", &cloud::<2>(Cloud::Normal, 100), 20e-6);
    measure("normal, N = 3, m = 1e3", &cloud::<3>(Cloud::Normal, 1_000), 30e-6);
    measure("normal, N = 3, m = 1e4 (W4)", &cloud::<3>(Cloud::Normal, 10_000), 300e-6);
    measure("cube, N = 3, m = 1e4 (W4)", &cloud::<3>(Cloud::Cube, 10_000), 300e-6);
    measure("normal, N = 10, m = 1e4 (W4)", &cloud::<10>(Cloud::Normal, 10_000), 30e-3);
    measure("cube, N = 10, m = 1e4 (W4)", &cloud::<10>(Cloud::Cube, 10_000), 30e-3);
    measure("normal, N = 2, m = 1e6 (W4)", &cloud::<2>(Cloud::Normal, 1_000_000), 15e-3);
    measure("cube, N = 2, m = 1e6 (W4)", &cloud::<2>(Cloud::Cube, 1_000_000), 15e-3);
    measure("normal, N = 3, m = 1e6 (W4)", &cloud::<3>(Cloud::Normal, 1_000_000), 30e-3);
    measure("cube, N = 3, m = 1e6 (W4)", &cloud::<3>(Cloud::Cube, 1_000_000), 30e-3);
    measure("ball, N = 3, m = 1e6", &in_ball::<3>(1_000_000), 100e-3);
}

fn compared() {
    println!("\n| to a gap of 1e-7, N = 3 | Newton | Khachiyan | ratio | |\n|---|---|---|---|---|");
    let mut rng = Rng::new(1);
    for count in [1_000, 10_000, 100_000] {
        compare(&format!("normal, m = {count}"), &cloud(Cloud::Normal, count));
        compare(&format!("ball, m = {count}"), &in_ball(count));
        compare(&format!("sphere, m = {count}"), &on_sphere(count));
        compare(&format!("cube, m = {count}"), &cloud(Cloud::Cube, count));
        let lognormal: Vec<[f64; 3]> = (0..count).map(|_| std::array::from_fn(|_| rng.normal().exp())).collect();
        compare(&format!("lognormal, m = {count}"), &lognormal);
    }
}

fn inscribed_ellipsoids() {
    println!("\n| half-spaces | time | goal | | |\n|---|---|---|---|---|");
    let body: Vec<HalfSpace<3>> =
        halfspaces(60).into_iter().map(|(normal, offset)| HalfSpace { normal, offset }).collect();
    let options = InscribedOptions::new();
    let answer = inscribed(&body, options).expect("a bounded body");
    let time = seconds(BUDGET, || _ = black_box(inscribed(black_box(&body), options)));
    row("60, N = 3", time, 50e-6, &format!("gap {:.0e}, {} steps", answer.log_det_gap, answer.iterations));
}

/// One of a thousand points goes out and back, comes and goes.
fn moving() {
    let points = in_ball::<3>(1_000);
    let options = EnclosingOptions::new();
    let mut moving = MovingPoints::new(&points, options).expect("finite");
    let touching = moving.enclosing().expect("full rank").contacts[0];
    let home = points[touching];
    println!("\n| 1,000 points in a ball | time |\n|---|---|");
    let cold = seconds(BUDGET, || _ = black_box(enclosing(black_box(&points), options)));
    println!("| solved afresh | {} |", shown(cold));
    let mut step = 0u32;
    let moved = seconds(BUDGET, || {
        step += 1;
        let out = 1.0 + 1e-3 * f64::from(step % 7);
        moving.update(touching, home.map(|x| x * out)).expect("finite");
        _ = black_box(moving.enclosing());
    });
    println!("| a point that touches moves | {} |", shown(moved));
    for (factor, name) in [(1.01, "a point comes outside and goes: two solves"), (0.5, "a point comes inside and goes")]
    {
        let visit = seconds(BUDGET, || {
            let index = moving.insert(home.map(|x| factor * x)).expect("finite");
            _ = black_box(moving.enclosing());
            moving.remove(index);
            _ = black_box(moving.enclosing());
        });
        println!("| {name} | {} |", shown(visit));
    }
}

/// The vertices of an OBJ file.
fn vertices(path: &Path) -> std::io::Result<Vec<[f64; 3]>> {
    let text = std::fs::read_to_string(path)?;
    let vertex = |line: &str| {
        let mut numbers = line.strip_prefix("v ")?.split_whitespace().map(str::parse);
        Some([numbers.next()?.ok()?, numbers.next()?.ok()?, numbers.next()?.ok()?])
    };
    Ok(text.lines().filter_map(vertex).collect())
}

fn robot(directory: &Path) -> std::io::Result<()> {
    let mut links = Vec::new();
    for entry in std::fs::read_dir(directory)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "obj") {
            links.push(vertices(&path)?);
        }
    }
    let all = || links.iter().for_each(|link| _ = black_box(enclosing(black_box(link), TIGHT)));
    let remark = format!("{} links, {} vertices", links.len(), links.iter().map(Vec::len).sum::<usize>());
    row(&directory.display().to_string(), seconds(BUDGET, all), 5e-3, &remark);
    Ok(())
}

fn main() -> ExitCode {
    memory("ball, m = 1e6", &in_ball(1_000_000));
    memory("sphere, m = 1e6", &on_sphere(1_000_000));
    enclosed();
    compared();
    inscribed_ellipsoids();
    moving();
    println!("\n| robot | time | goal | | |\n|---|---|---|---|---|");
    for directory in std::env::args().skip(1) {
        if let Err(error) = robot(Path::new(&directory)) {
            eprintln!("{directory}: {error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
