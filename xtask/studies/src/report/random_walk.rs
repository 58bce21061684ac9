//! The paper's experiment: an ellipse walks at random past another on a grid of 128 × 128 cells, turning as it goes,
//! and the margin is tracked. How large may a step be, and what is gained over finding all eigenvalues in every pose?
//!
//! Rimon and Boyd report seven inverse iterations per step of one degree and one cell, a gain of 2.5 over the
//! eigenvalues, and no correct convergence beyond about five degrees and five cells.

use std::hint::black_box;

use convex_support::Ellipsoid;
use convex_support::glam::DVec2;
use ellip_margin::paper::{InverseIterationTracker, free_margin_eigen};
use ellip_margin::{MarginOptions, MarginTracker, free_margin};

use super::growth::time;
use workloads::rng::Rng;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::Figure;
use xtask::validate::{Scope, progress};

const WALKS: usize = 40;
const STEPS: usize = 200;

/// The paper's ε, and its K = ln(1/ε).
const PRECISION: (f64, usize) = (1e-6, 14);

/// What the paper says a step may be.
const SIZES: [f64; 10] = [1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0];

/// A walk: the poses of the link, and the obstacle.
struct Walk {
    poses: Vec<Ellipsoid<DVec2>>,
    obstacle: Ellipsoid<DVec2>,
}

impl Walk {
    /// A walk that drifts from a corner to the opposite one, each step −1, 0 or 1 times `size` cells along both axes
    /// and as many degrees.
    fn new(random: &mut Rng, size: f64) -> Option<Self> {
        let mut between = |low: f64, high: f64| low + (high - low) * 0.5 * (1.0 + random.signed());
        let link = DVec2::new(between(0.06, 0.14), between(0.02, 0.05));
        let obstacle = Ellipsoid::new(
            DVec2::new(between(0.4, 0.6), between(0.4, 0.6)),
            DVec2::new(between(0.08, 0.18), between(0.04, 0.09)),
            between(0.0, 3.0),
        );
        let (mut at, mut angle) = (DVec2::new(between(0.05, 0.25), between(0.75, 0.95)), 0.0f64);
        let mut poses = Vec::with_capacity(STEPS);
        for _ in 0..STEPS {
            poses.push(Ellipsoid::new(at, link, angle).ok()?);
            let mut draw = |forward: f64| match between(0.0, 1.0) {
                u if u < forward => 1.0,
                u if u < forward + 0.25 => 0.0,
                _ => -1.0,
            };
            at += DVec2::new(draw(0.5), -draw(0.5)) * (size / 128.0);
            at = at.clamp(DVec2::ZERO, DVec2::ONE);
            angle += draw(0.375) * size.to_radians();
        }
        Some(Self { poses, obstacle: obstacle.ok()? })
    }
}

/// What came of all walks of a size.
#[derive(Default)]
struct Row {
    inverse_iterations: f64,
    newton_iterations: f64,
    cold_iterations: f64,
    /// In per cent of the steps.
    fell_back: f64,
    wrong: f64,
    newton_wrong: f64,
    /// Nanoseconds per step: eigenvalues, inverse iteration, Newton's method, the same cold.
    times: [f64; 4],
}

/// What a line shows: its name, and its value in a row.
type Quantity = (&'static str, fn(&Row) -> f64);

fn measure(size: f64) -> Row {
    let mut random = Rng::new(7);
    let walks: Vec<Walk> = (0..WALKS).filter_map(|_| Walk::new(&mut random, size)).collect();
    let options = MarginOptions::default();
    let mut row = Row::default();
    for Walk { poses, obstacle } in &walks {
        let (mut paper, mut ours) = (
            InverseIterationTracker::new(PRECISION.0, PRECISION.1).expect("a positive tolerance"),
            MarginTracker::default(),
        );
        for pose in poses {
            let cold = free_margin(pose, obstacle, options);
            row.cold_iterations += cold.iterations as f64;
            let off = |m: f64, tolerance: f64| (m - cold.margin).abs() > tolerance * (1.0 + cold.margin.abs());
            row.wrong += f64::from(u8::from(off(paper.step(pose, obstacle).margin, 1e-4)));
            row.newton_wrong += f64::from(u8::from(off(ours.step(pose, obstacle).margin, 1e-14)));
        }
        // The first pose has nothing to start from.
        row.fell_back += (paper.fallbacks() - 1) as f64;
        row.inverse_iterations += paper.iterations() as f64;
        row.newton_iterations += ours.iterations() as f64;
    }
    let steps = (walks.len() * STEPS) as f64;
    for count in [&mut row.inverse_iterations, &mut row.newton_iterations, &mut row.cold_iterations] {
        *count /= steps;
    }
    for count in [&mut row.fell_back, &mut row.wrong, &mut row.newton_wrong] {
        *count *= 100.0 / steps;
    }
    let mut clock =
        |route: usize, walk: &dyn Fn(&Walk)| row.times[route] = time(|| walks.iter().for_each(walk)) / steps;
    clock(0, &|w| w.poses.iter().for_each(|pose| _ = black_box(&free_margin_eigen(black_box(pose), &w.obstacle))));
    clock(1, &|w| {
        let mut track = InverseIterationTracker::new(PRECISION.0, PRECISION.1).expect("a positive tolerance");
        w.poses.iter().for_each(|pose| _ = black_box(&track.step(black_box(pose), &w.obstacle)));
    });
    clock(2, &|w| {
        let mut track = MarginTracker::default();
        w.poses.iter().for_each(|pose| _ = black_box(&track.step(black_box(pose), &w.obstacle)));
    });
    clock(3, &|w| w.poses.iter().for_each(|pose| _ = black_box(&free_margin(black_box(pose), &w.obstacle, options))));
    row
}

/// The figures, where tracking is asked for.
pub(super) fn figures(scope: &Scope) -> Vec<Figure> {
    if scope.quick || !scope.holds("track") {
        return Vec::new();
    }
    let rows: Vec<(f64, Row)> = SIZES
        .into_iter()
        .map(|size| {
            progress(&format!("random walks of {size} degrees and cells"));
            (size, measure(size))
        })
        .collect();
    let series = |of: &[Quantity]| -> Vec<Series> {
        let line = |(colour, &(name, value)): (usize, &Quantity)| Series {
            name: name.to_owned(),
            points: rows.iter().map(|(size, row)| [*size, value(row)]).collect(),
            joined: true,
            colour,
        };
        of.iter().enumerate().map(line).collect()
    };
    let figure = |name: &str, title: &str, y: &str, scale: Scale, series: Vec<Series>, caption: String| Figure {
        name: name.to_owned(),
        plot: Plot {
            title: title.to_owned(),
            x: "step in degrees and in cells".to_owned(),
            y: y.to_owned(),
            scales: [Scale::Linear, scale],
            floor: f64::MIN_POSITIVE,
            series,
        },
        caption,
    };
    let (first, fifth) = (&rows[0].1, &rows[4].1);
    let walks =
        format!("{WALKS} walks of {STEPS} steps of an ellipse past another on the paper's grid of 128 × 128 cells");
    vec![
        figure(
            "walk-iterations",
            "track: iterations per step of a random walk",
            "iterations per step",
            Scale::Linear,
            series(&[
                ("inverse iteration", |r| r.inverse_iterations),
                ("Newton, tracked", |r| r.newton_iterations),
                ("Newton, cold", |r| r.cold_iterations),
            ]),
            format!(
                "{walks}, ε = 1e-6 and at most 14 inverse iterations. At one degree and one cell: {:.1} inverse iterations, {:.1} of \
                 Newton's method; steps with the centre inside count as none for either.",
                first.inverse_iterations, first.newton_iterations
            ),
        ),
        figure(
            "walk-failures",
            "track: steps that fail",
            "per cent of the steps",
            Scale::Linear,
            series(&[
                ("inverse iteration gives up", |r| r.fell_back),
                ("inverse iteration is off by 1e-4", |r| r.wrong),
                ("Newton is off by 1e-14", |r| r.newton_wrong),
            ]),
            format!(
                "{walks}. The paper puts the limit of correct convergence at about five degrees and cells: there inverse iteration \
                 gives up on {:.1} % of the steps. Newton's method has no such limit.",
                fifth.fell_back
            ),
        ),
        figure(
            "walk-time",
            "track: time per step of a random walk",
            "nanoseconds per step",
            Scale::Log,
            series(&[
                ("eigenvalues, each pose anew", |r| r.times[0]),
                ("inverse iteration", |r| r.times[1]),
                ("Newton, tracked", |r| r.times[2]),
                ("Newton, cold", |r| r.times[3]),
            ]),
            format!(
                "{walks}. The gain of inverse iteration over all eigenvalues is {:.1} at one degree and cell (the paper: 2.5, from counted \
                 operations); that of Newton's method {:.1}.",
                first.times[0] / first.times[1],
                first.times[0] / first.times[2]
            ),
        ),
    ]
}
