//! Certificates under stress: random queries of every kind, at random scales and distances, most of them stopped before
//! they are done. What an answer claims has to hold all the same.

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{Scalar, Vector3};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Ray, RayCastOptions, SubAlgorithm, WarmStart,
    distance, intersects, linear_cast, ray_cast,
};
use workloads::rng::Rng;

use super::judge::{Cast, Proof, judge_intersection};
use super::obstacle::{Known, Obstacle};
use super::questions::{BODIES, FINITE, PAIRS, apart, pair, ray};
use super::solid::{Form, Solid, rounded, vector};
use super::{Question, Row};
use workloads::vec3::norm;

/// Queries that share bodies.
const PER_SCENE: u64 = 200;

/// One cell for each body and pair, and each precision.
pub(super) fn cells(only: &str) -> Vec<Row> {
    let singles = BODIES.into_iter().filter(|name| pair(name).is_none());
    let subjects = singles.chain(PAIRS).filter(|subject| subject.contains(only));
    subjects.flat_map(|s| [false, true].map(|single| Row::new(Question::Certificates, s, single, 1.0, 1.0))).collect()
}

/// `queries` are those of all cells together.
pub(super) fn fill(cell: Row, queries: u64, cells: u64, seed: u64) -> Row {
    let name = cell.subject.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut rng = Rng::new(name);
    let queries = queries.div_ceil(cells);
    if cell.is_single { stress::<Vec3A>(cell, queries, &mut rng) } else { stress::<DVec3>(cell, queries, &mut rng) }
}

/// Between 10 to the power of `low` and of `high`.
fn magnitude(low: f64, high: f64, rng: &mut Rng) -> f64 {
    10.0_f64.powf(low + (high - low) * 0.5 * (rng.signed() + 1.0))
}

/// What every query can be stopped, started and varied by.
struct Choice<V> {
    max_iterations: usize,
    tolerance: f64,
    axis: Option<V>,
    sub_algorithm: SubAlgorithm,
    /// Where to end, as a part of the distance there is.
    end: Option<f64>,
}

impl<V: Vector3> Choice<V> {
    fn new(rng: &mut Rng) -> Self {
        Self {
            max_iterations: if rng.below(2) == 0 { 200 } else { 1 + rng.below(12) as usize },
            tolerance: if rng.below(2) == 0 { 0.0 } else { magnitude(-9.0, -1.0, rng) },
            axis: (rng.below(3) == 0).then(|| vector(rng.sphere())),
            sub_algorithm: match rng.below(3) {
                0 => SubAlgorithm::Johnson,
                1 => SubAlgorithm::SignedVolumes,
                _ => SubAlgorithm::default(),
            },
            end: (rng.below(3) == 0).then(|| magnitude(-0.5, 0.5, rng)),
        }
    }
}

fn stress<V: Vector3>(mut cell: Row, queries: u64, rng: &mut Rng) -> Row {
    while cell.queries < queries {
        let size = magnitude(-6.0, 6.0, rng);
        let turn = |rng: &mut Rng| rng.quat().map(rounded::<V>);
        let place = rng.sphere().map(|c| rounded::<V>(c * size * magnitude(-3.0, 1.0, rng)));
        match pair(cell.subject) {
            None => {
                let solid = Solid::new(Form::named(cell.subject).sized::<V>(size), turn(rng), place);
                single::<V>(&mut cell, &solid, size, rng);
            }
            Some(forms) => {
                let alike = turn(rng);
                let [a, b] = forms.map(|form| {
                    let turn = if cell.subject == "cylinder-cylinder" { alike } else { turn(rng) };
                    Solid::new(form.sized::<V>(size), turn, place)
                });
                double::<V>(&mut cell, a, &b, size, rng);
            }
        }
    }
    cell
}

/// Ray casts on one body.
fn single<V: Vector3>(cell: &mut Row, solid: &Solid, size: f64, rng: &mut Rng) {
    let known = Known::of_one(solid);
    let obstacle = Obstacle::new(solid, None, Some(&known));
    let body = solid.build::<V>();
    for _ in 0..PER_SCENE {
        let choice = Choice::<V>::new(rng);
        let from = 1.2 * obstacle.reach() / size * magnitude(0.0, 6.0, rng);
        let (source, direction) = ray::<V>(size, from, obstacle.bounds(), rng);
        let source = [0, 1, 2].map(|i| rounded::<V>(source[i] + solid.translation[i]));
        if norm(direction) == 0.0 {
            continue;
        }
        let mut options = RayCastOptions::new()
            .with_max_iterations(choice.max_iterations)
            .with_tolerance(V::Scalar::from_f64(choice.tolerance))
            .with_sub_algorithm(choice.sub_algorithm);
        options.warm_start = choice.axis.map(WarmStart::new);
        let end = choice.end.map_or(f64::INFINITY, |part| rounded::<V>(part * from * size / norm(direction)));
        options.max_lambda = V::Scalar::from_f64(end);
        let answer =
            ray_cast(&body, Ray { source: vector(source), direction: vector(direction) }, options).expect(FINITE);
        let cast = Cast::of_ray(source, direction, end, &answer).relative_to(solid.translation);
        let verdict = cast.judge(&obstacle, cell.epsilon());
        let told =
            || format!("{}, source {source:?}, direction {direction:?}, {options:?}: {answer:?}", solid.described());
        cell.add(&verdict, told);
    }
}

/// Linear casts, distances and intersections of two.
fn double<V: Vector3>(cell: &mut Row, mut a: Solid, b: &Solid, size: f64, rng: &mut Rng) {
    let known = Known::of(&a, b);
    let built_b = b.build::<V>();
    for _ in 0..PER_SCENE {
        let choice = Choice::<V>::new(rng);
        let scalar = V::Scalar::from_f64;
        let (verdict, told);
        if rng.below(2) == 0 {
            let reach = a.form.reach() + b.form.reach();
            let from = 1.2 * reach / size * magnitude(0.0, 6.0, rng);
            let (source, velocity) = ray::<V>(size, from, Obstacle::new(&a, Some(b), None).bounds(), rng);
            a.translation = [0, 1, 2].map(|i| rounded::<V>(b.translation[i] - source[i]));
            if norm(velocity) == 0.0 {
                continue;
            }
            let velocities = if rng.below(2) == 0 { [velocity.map(|c| -c), [0.0; 3]] } else { [[0.0; 3], velocity] };
            let motion = Motion { velocity_a: vector(velocities[0]), velocity_b: vector(velocities[1]) };
            let end = choice.end.map_or(f64::INFINITY, |part| rounded::<V>(part * from * size / norm(velocity)));
            let mut options = LinearCastOptions::new()
                .with_max_iterations(choice.max_iterations)
                .with_tolerance(scalar(choice.tolerance))
                .with_max_time(scalar(end))
                .with_sub_algorithm(choice.sub_algorithm);
            options.warm_start = choice.axis.map(WarmStart::new);
            let answer = linear_cast(&a.build::<V>(), &built_b, motion, options).expect(FINITE);
            let cast = Cast::of_motion([&a, b], velocities, end, &answer);
            verdict = cast.judge(&Obstacle::new(&a, Some(b), known.as_ref()), cell.epsilon());
            told = format!("{motion:?}, {options:?}: {answer:?}");
        } else {
            let gap = match rng.below(4) {
                0 => -magnitude(-9.0, -0.5, rng),
                _ => magnitude(-12.0, 2.0, rng),
            };
            a.translation = apart::<V>(&a, b, gap * size, rng);
            let built_a = a.build::<V>();
            if rng.below(2) == 0 {
                let mut options = DistanceOptions::new()
                    .with_max_iterations(choice.max_iterations)
                    .with_tolerance(scalar(choice.tolerance))
                    .with_sub_algorithm(choice.sub_algorithm);
                options.axis = choice.axis;
                options.limit = scalar(choice.end.map_or(f64::INFINITY, |part| part * gap.abs() * size));
                let answer = distance(&built_a, &built_b, options);
                verdict = Proof::of([&a, b], &answer).judge(&answer, f64::INFINITY);
                told = format!("{options:?}: {answer:?}");
            } else {
                let mut options = IntersectOptions::new()
                    .with_max_iterations(choice.max_iterations)
                    .with_sub_algorithm(choice.sub_algorithm);
                options.axis = choice.axis;
                let answer = intersects(&built_a, &built_b, options);
                verdict = judge_intersection([&a, b], &answer);
                told = format!("{options:?}: {answer:?}");
            }
        }
        cell.add(&verdict, || format!("a {}, b {}, {told}", a.described(), b.described()));
    }
}
