//! The cells of the three tables.

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{Difference, SupportMap, Vector3};
use gjk_raycast::{
    DistanceOptions, LinearCastOptions, Motion, Ray, RayCast, RayCastError, RayCastOptions, distance, linear_cast,
    ray_cast,
};
use workloads::rng::Rng;

use super::judge::{Cast, Proof};
use super::obstacle::{Known, Obstacle};
use super::solid::{Form, Solid, rounded, vector};
use super::{Question, Row};
use workloads::vec3::norm;

/// The single bodies; `hull32-hull8` is the difference of two.
pub(super) const BODIES: [&str; 12] = [
    "cuboid",
    "ball",
    "cylinder",
    "cone",
    "capsule",
    "ellipsoid",
    "hull8",
    "hull32",
    "hull128",
    "hull512",
    "roundbox",
    "hull32-hull8",
];

/// The pairs. The last four have no closed form; cylinders are turned alike.
pub(super) const PAIRS: [&str; 13] = [
    "ball-ball",
    "ball-cuboid",
    "capsule-ball",
    "capsule-capsule",
    "roundbox-ball",
    "cuboid-cuboid",
    "hull8-cuboid",
    "hull32-hull8",
    "cylinder-cylinder",
    "cylinder-cone",
    "ellipsoid-ellipsoid",
    "cone-cuboid",
    "ellipsoid-hull32",
];

const SIZES: [f64; 7] = [1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6];
const DISTANCES: [f64; 6] = [3.0, 1e1, 1e2, 1e3, 1e4, 1e6];
/// From overlap by a tenth to ten sizes apart.
const GAPS: [f64; 8] = [-0.1, 0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1, 1e1];

/// Queries that share a pose.
const PER_POSE: u64 = 250;

/// The empty cells of a question.
pub(super) fn cells(question: Question, only: &str) -> Vec<Row> {
    let subjects: &[&'static str] = if question == Question::Ray { &BODIES } else { &PAIRS };
    let distances: &[f64] = if question == Question::Distance { &GAPS } else { &DISTANCES };
    let mut cells = Vec::new();
    for subject in subjects.iter().filter(|subject| subject.contains(only)) {
        for is_single in [false, true] {
            for &distance in distances {
                cells.extend(SIZES.map(|size| Row::new(question, subject, is_single, size, distance)));
            }
        }
    }
    cells
}

/// The two forms of a pair.
pub(super) fn pair(subject: &str) -> Option<[Form; 2]> {
    subject.split_once('-').map(|(a, b)| [Form::named(a), Form::named(b)])
}

pub(super) fn fill(cell: Row, queries: u64, seed: u64) -> Row {
    let seed = seed ^ cell.size.to_bits() ^ cell.distance.to_bits().rotate_left(17);
    let mut rng = Rng::new(seed);
    match (cell.question, cell.is_single) {
        (Question::Ray, true) => rays::<Vec3A>(cell, queries, &mut rng),
        (Question::Ray, false) => rays::<DVec3>(cell, queries, &mut rng),
        (Question::Linear, true) => linear::<Vec3A>(cell, queries, &mut rng),
        (Question::Linear, false) => linear::<DVec3>(cell, queries, &mut rng),
        (_, true) => distances::<Vec3A>(cell, queries, &mut rng),
        (_, false) => distances::<DVec3>(cell, queries, &mut rng),
    }
}

/// 1e-5 of the size in `f32`; in `f64` 1e-12 of it for polytopes and 1e-10 for others; and four rounding errors of the
/// distance of the source, if that is more.
fn allowed(cell: &Row, polytopes: bool) -> f64 {
    let near = match (cell.is_single, polytopes) {
        (true, _) => 1e-5,
        (false, true) => 1e-12,
        (false, false) => 1e-10,
    };
    f64::max(near, 4.0 * cell.epsilon() * cell.distance)
}

pub(super) const FINITE: &str = "the queries of the sweep are finite";

const UNTURNED: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn rays<V: Vector3>(mut cell: Row, queries: u64, rng: &mut Rng) -> Row {
    let forms = pair(cell.subject).map_or_else(|| vec![Form::named(cell.subject)], Vec::from);
    let solids: Vec<Solid> =
        forms.iter().map(|form| Solid::new(form.sized::<V>(cell.size), UNTURNED, [0.0; 3])).collect();
    cell.allowed = allowed(&cell, forms.iter().all(Form::is_polytope));
    let options = RayCastOptions::default();
    match solids.as_slice() {
        [a, b] => {
            let body = Difference::new(a.form.build::<V>(), b.form.build::<V>());
            let known = Known::of(a, b);
            let obstacle = Obstacle::new(a, Some(b), known.as_ref());
            rays_at(&mut cell, queries, rng, obstacle, |ray: Ray<V>| ray_cast(&body, ray, options));
        }
        [a, ..] => {
            let body = a.form.build::<V>();
            let known = Known::of_one(a);
            rays_at(&mut cell, queries, rng, Obstacle::new(a, None, Some(&known)), |ray: Ray<V>| {
                ray_cast(&body, ray, options)
            });
        }
        [] => {}
    }
    cell
}

fn rays_at<V: Vector3>(
    cell: &mut Row,
    queries: u64,
    rng: &mut Rng,
    obstacle: Obstacle<'_>,
    cast: impl Fn(Ray<V>) -> Result<RayCast<V>, RayCastError>,
) {
    let bounds = obstacle.bounds();
    for _ in 0..queries {
        let (source, direction) = ray::<V>(cell.size, cell.distance, bounds, rng);
        if norm(direction) == 0.0 {
            continue;
        }
        let answer = cast(Ray { source: vector(source), direction: vector(direction) }).expect(FINITE);
        let verdict = Cast::of_ray(source, direction, f64::INFINITY, &answer).judge(&obstacle, cell.epsilon());
        cell.add(&verdict, || format!("source {source:?}, direction {direction:?}: {answer:?}"));
    }
}

/// A ray from a distance, given in sizes, towards the bounding box and a little around it.
pub(super) fn ray<V: Vector3>(size: f64, distance: f64, bounds: [f64; 3], rng: &mut Rng) -> ([f64; 3], [f64; 3]) {
    let source = rng.sphere().map(|c| rounded::<V>(c * distance * size));
    let aim = bounds.map(|half| 1.3 * half * rng.signed());
    // The length of the direction varies over six decades, since λ is in units of it.
    let length = 10.0_f64.powf(3.0 * rng.signed()) / distance;
    (source, [0, 1, 2].map(|i| rounded::<V>((aim[i] - source[i]) * length)))
}

fn linear<V: Vector3>(mut cell: Row, queries: u64, rng: &mut Rng) -> Row {
    let Some(forms) = pair(cell.subject) else { return cell };
    cell.allowed = allowed(&cell, forms.iter().all(Form::is_polytope));
    let forms = forms.map(|form| form.sized::<V>(cell.size));
    let mut left = queries;
    while left > 0 {
        let turn_a = rng.quat().map(rounded::<V>);
        let turn_b = if cell.subject == "cylinder-cylinder" { turn_a } else { rng.quat().map(rounded::<V>) };
        let [form_a, form_b] = forms.clone();
        // b stays, and a comes from anywhere.
        let place = rng.sphere().map(|c| rounded::<V>(c * cell.size));
        let b = Solid::new(form_b, turn_b, place);
        let mut a = Solid::new(form_a, turn_a, place);
        let built_b = b.build::<V>();
        let known = Known::of(&a, &b);
        let bounds = Obstacle::new(&a, Some(&b), None).bounds();
        for _ in 0..left.min(PER_POSE) {
            let (source, velocity) = ray::<V>(cell.size, cell.distance, bounds, rng);
            // A ray of the obstacle A − B starts at b's place seen from a's, and runs along b's velocity seen from a.
            a.translation = [0, 1, 2].map(|i| rounded::<V>(place[i] - source[i]));
            let obstacle = Obstacle::new(&a, Some(&b), known.as_ref());
            let still = [0.0; 3];
            let velocities = if rng.bits() & 1 == 0 { [velocity.map(|c| -c), still] } else { [still, velocity] };
            let motion = Motion { velocity_a: vector(velocities[0]), velocity_b: vector(velocities[1]) };
            let built_a = a.build::<V>();
            let answer = linear_cast(&built_a, &built_b, motion, LinearCastOptions::default()).expect(FINITE);
            let cast = Cast::of_motion([&a, &b], velocities, f64::INFINITY, &answer);
            let verdict = cast.judge(&obstacle, cell.epsilon());
            cell.add(&verdict, || format!("a {}, b {}, {motion:?}: {answer:?}", a.described(), b.described()));
        }
        left -= left.min(PER_POSE);
    }
    cell
}

fn distances<V: Vector3>(mut cell: Row, queries: u64, rng: &mut Rng) -> Row {
    let Some(forms) = pair(cell.subject) else { return cell };
    let polytopes = forms.iter().all(Form::is_polytope);
    cell.allowed = match (cell.is_single, polytopes) {
        (true, _) => 1e-5,
        (false, true) => 1e-12,
        (false, false) => 1e-10,
    } * cell.distance.abs().max(1.0);
    let forms = forms.map(|form| form.sized::<V>(cell.size));
    for _ in 0..queries {
        let [turn_a, turn_b] = [rng.quat(), rng.quat()].map(|turn| turn.map(rounded::<V>));
        let [form_a, form_b] = forms.clone();
        let place = rng.sphere().map(|c| rounded::<V>(c * cell.size));
        let (mut a, b) = (Solid::new(form_a, turn_a, place), Solid::new(form_b, turn_b, place));
        a.translation = apart::<V>(&a, &b, cell.distance * cell.size, rng);
        let answer = distance(&a.build::<V>(), &b.build::<V>(), DistanceOptions::default());
        let mut proof = Proof::of([&a, &b], &answer);
        if cell.is_single {
            // Doubles bound it closer, and what they claim is checked just as well.
            let double = distance(&a.build::<DVec3>(), &b.build::<DVec3>(), DistanceOptions::default());
            proof = proof.and(Proof::of([&a, &b], &double));
        }
        let verdict = proof.judge(&answer, cell.allowed * cell.size);
        cell.add(&verdict, || format!("a {}, b {}: {answer:?}", a.described(), b.described()));
    }
    cell
}

/// Where `a` has to be for a gap to `b` along a random direction; less than zero for an overlap.
///
/// Along `n` the planes of support are apart by the gap; across `n`, the points of support are one above the other, as
/// far as `f64` finds them. Rounding to the precision of `V` moves `a` by an ulp.
pub(super) fn apart<V: Vector3>(a: &Solid, b: &Solid, gap: f64, rng: &mut Rng) -> [f64; 3] {
    let n = rng.sphere();
    let minus = n.map(|c| -c);
    let point = |s: &Solid, n: [f64; 3]| {
        let unplaced = Solid::new(s.form.clone(), s.rotation, [0.0; 3]).build::<DVec3>();
        unplaced.support(DVec3::from_array(n)).to_array()
    };
    let (low, high) = (point(a, minus), point(b, n));
    [0, 1, 2].map(|i| rounded::<V>(b.translation[i] + high[i] - low[i] + gap * n[i]))
}
