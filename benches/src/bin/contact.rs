//! Depths and manifolds of the bodies of W3b that overlap, in `f64`: nanoseconds and support points per query, as the
//! table in `docs/distance.md` has them.
#![allow(clippy::print_stdout, reason = "printing is what it is for")]

use std::time::Duration;

use benches::measure::Solver;
use benches::ours::Effort;
use benches::ours::shapes::{PairTask, Space, VALID, with_pair};
use benches::ours::tasks::{Distances, SignedDistances, placed};
use convex_support::glam::{DQuat, DVec3};
use convex_support::{Posed, Scalar, SupportMap};
use gjk_raycast::{SignedDistanceOptions, contact, signed_distance};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::w3_distance::{self, DistanceQuery};
use workloads::w3b_intersect::{self, IntersectQuery};

/// What a cell may spend.
const BUDGET: Duration = Duration::from_secs(1);

/// How far a body turns and moves from one frame to the next: a degree, and a hundredth of a unit.
const TURN: f64 = 1.0 / 57.3;
const STEP: f64 = 0.01;

/// Signed distances that are told the normal of the frame before.
struct Warm<'a>(&'a [IntersectQuery]);

impl PairTask<DVec3> for Warm<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = DVec3> + 'static,
        B: SupportMap<Vector = DVec3> + 'static,
    {
        let ask = move |(rotation, translation), options| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            signed_distance(&a, &b, options)
        };
        let prepared = self.0.iter().enumerate().map(|(i, query)| {
            let pose = placed::<DVec3>(query.pose);
            let before = DQuat::from_axis_angle(DVec3::AXES[i % 3], TURN) * pose.0;
            let before = (before.normalize(), pose.1 + DVec3::AXES[(i + 1) % 3] * STEP);
            let cold = SignedDistanceOptions::default();
            (pose, cold.with_axis(ask(before, cold).normal))
        });
        Solver::new(prepared.collect(), move |&(pose, options)| ask(pose, options).signed_distance)
    }
}

/// The depth, and the points in which the bodies support each other.
struct Manifolds<'a>(&'a [IntersectQuery]);

impl<V: Space> PairTask<V> for Manifolds<'_> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static,
    {
        let queries = self.0.iter().map(|query| placed::<V>(query.pose)).collect();
        Solver::new(queries, move |&(rotation, translation)| {
            let b = Posed::new(&b, rotation, translation).expect(VALID);
            let found = contact(&a, &b, V::Scalar::ZERO, SignedDistanceOptions::default());
            found.map_or(f64::NAN, |contact| contact.points().len() as f64)
        })
    }
}

/// The columns of times for one pair.
fn times(pair: &Pair, overlapping: &[IntersectQuery]) -> [Option<f64>; 9] {
    let apart: &[DistanceQuery] = &w3_distance::queries(pair)[..w3_distance::FAR];
    let time = |solver: &Solver| solver.nanoseconds(0..solver.count(), BUDGET);
    let depth = time(&with_pair::<DVec3>(pair, SignedDistances(overlapping, Effort::default())));
    let manifold = time(&with_pair::<DVec3>(pair, Manifolds(overlapping)));
    #[cfg(feature = "parry")]
    let [parry, parry_manifold] = {
        use benches::parry::double::{front_door_depths, front_door_manifolds};
        [front_door_depths(pair, overlapping), front_door_manifolds(pair, overlapping)]
            .map(|solver| solver.map(|solver| time(&solver)))
    };
    #[cfg(not(feature = "parry"))]
    let [parry, parry_manifold] = [None::<f64>; 2];
    [
        Some(time(&with_pair::<DVec3>(pair, Distances(apart, Effort::default())))),
        Some(depth),
        Some(time(&with_pair::<DVec3>(pair, Warm(overlapping)))),
        Some(manifold),
        Some(manifold / depth),
        parry,
        parry.map(|parry| parry / depth),
        parry_manifold,
        parry_manifold.map(|parry| parry / manifold),
    ]
}

/// Our manifolds in `f32` and those of `Box3D`: nanoseconds, and how many points they have on average.
#[cfg(feature = "box3d")]
fn beside_box3d() {
    println!("\n| | ours in `f32` | points | Box3D's | points | Box3D's / ours |\n|---|---:|---:|---:|---:|---:|");
    for name in PAIR_NAMES {
        let pair = Pair::named(name);
        let overlapping = overlapping(&pair);
        let Some(theirs) = benches::box3d::manifolds(&pair, &overlapping) else { continue };
        let ours = with_pair::<convex_support::glam::Vec3A>(&pair, Manifolds(&overlapping));
        let [(ours, of_ours), (theirs, of_theirs)] = [ours, theirs].map(|solver| {
            let points = solver.answers();
            let mean = points.iter().sum::<f64>() / points.len() as f64;
            (solver.nanoseconds(0..solver.count(), BUDGET), mean)
        });
        println!("| {name} | {ours:.0} | {of_ours:.2} | {theirs:.0} | {of_theirs:.2} | {:.1} |", theirs / ours);
    }
}

/// The queries of a pair whose bodies meet.
fn overlapping(pair: &Pair) -> Vec<IntersectQuery> {
    w3b_intersect::queries(pair).into_iter().filter(|query| query.meet).collect()
}

/// The mean and the most of the support points that depths of one pair take.
fn support_points(pair: &Pair, overlapping: &[IntersectQuery]) -> String {
    let counting = Effort { iterations: true, ..Effort::default() };
    let counts = with_pair::<DVec3>(pair, SignedDistances(overlapping, counting)).answers();
    let most = counts.iter().copied().fold(0.0, f64::max);
    format!("{:.1}, {most}", counts.iter().sum::<f64>() / counts.len() as f64)
}

fn main() {
    println!(
        "| | distance, apart | depth | depth, given the normal | depth and manifold | over the depth | parry's depth | parry's / ours | parry's manifold | parry's / ours | support points of a depth: mean, most |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for name in PAIR_NAMES {
        let pair = Pair::named(name);
        let overlapping = overlapping(&pair);
        let times: Vec<String> = times(&pair, &overlapping)
            .iter()
            .enumerate()
            .map(|(i, cell)| {
                cell.map_or_else(|| "-".to_owned(), |x| format!("{x:.*}", usize::from([4, 6, 8].contains(&i))))
            })
            .collect();
        println!("| {name} | {} | {} |", times.join(" | "), support_points(&pair, &overlapping));
    }
    #[cfg(feature = "box3d")]
    beside_box3d();
}
