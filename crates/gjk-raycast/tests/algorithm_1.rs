//! Algorithm 1 on closest points in closed form, the independent reference of Algorithm 3: another method, which shares
//! neither the support points nor the simplex with it.

use crate::common::behind_pointers::ray_cast;
use crate::common::{quaternion, s, turned, v};
use convex_support::glam::{DVec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rounded, Scalar, SupportMap, Triangle, Vector3,
    closest_point, support_value,
};
use gjk_raycast::{
    Outcome, Ray, RayCast, RayCastError, RayCastOptions, Status, iterative_ray_cast, iterative_ray_cast_with, ray_exit,
};
use proptest::prelude::*;

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// Which of the shapes is flat.
const FLAT: usize = 7;

/// One of eight shapes of size about one, turned and moved.
fn shape<V: Vector3>(kind: usize, rotation: [f64; 4], place: [f64; 3]) -> Posed<Shape<V>> {
    const VALID: &str = "positive sizes";
    let n = s::<V>;
    let shape: Shape<V> = match kind {
        0 => Box::new(Cuboid::new(v::<V>([1.0, 0.5, 0.25])).expect(VALID)),
        1 => Box::new(Ball::<V>::new(n(0.75)).expect(VALID)),
        2 => Box::new(Capsule::<V>::new(n(0.5), n(0.25)).expect(VALID)),
        3 => Box::new(Cylinder::<V>::new(n(0.75), n(0.5)).expect(VALID)),
        4 => Box::new(Cone::<V>::new(n(0.75), n(0.5)).expect(VALID)),
        5 => Box::new(
            Ellipsoid::new(V::ZERO, v::<V>([1.0, 0.5, 0.125]), quaternion::<V>([0.0, 0.0, 0.0, 1.0])).expect(VALID),
        ),
        6 => Box::new(Rounded::new(Cuboid::new(v::<V>([0.5, 0.25, 0.125])).expect(VALID), n(0.25)).expect(VALID)),
        _ => Box::new(
            Triangle::new([v::<V>([1.0, 0.0, 0.25]), v([-0.75, 0.5, 0.0]), v([-0.5, -1.0, -0.25])]).expect(VALID),
        ),
    };
    turned(shape, quaternion::<V>(rotation), place)
}

fn algorithm_1<V: Vector3>(target: &Posed<Shape<V>>, ray: Ray<V>) -> RayCast<V> {
    iterative_ray_cast(|x| closest_point(&target, x), ray, RayCastOptions::default()).expect("a finite ray")
}

/// Both find the same, wherever the source is. Where the surface is met at an angle, errors grow by its cosine.
fn agree<V: Vector3>(
    kind: usize,
    rotation: [f64; 4],
    aim: [f64; 3],
    from: [f64; 3],
) -> Result<Option<bool>, TestCaseError> {
    let place = [0.25, -0.5, 0.125];
    let target = shape::<V>(kind, rotation, place);
    let aim = [0, 1, 2].map(|i| aim[i] + place[i]);
    let source = v::<V>(from);
    let ray = Ray { source, direction: v::<V>(aim) - source };
    let (one, three) = (algorithm_1(&target, ray), ray_cast(&target, ray, RayCastOptions::default()).expect("finite"));
    let speed = ray.direction.norm().as_f64();
    let allowed = 256.0 * V::Scalar::EPSILON.as_f64() * (1.0 + source.norm().as_f64() / 16.0);
    if one.status == Status::IterationLimit {
        // Along a graze it comes nearer to the surface by ever smaller steps, and says that it did not arrive.
        let nearest = nearest(&target, ray);
        prop_assert!(nearest <= 1e-6 * speed && one.lower <= three.upper, "{} {:?} {:?}", nearest, one, three);
        return Ok(None);
    }
    // Where the ray is not in the set by more than noise, as of a flat one, or past a rim, no points of the set are
    // all around it.
    let is_open = one.outcome.is_hit() && !one.is_certain();
    if let (true, Some(entry)) = (is_open && kind != FLAT, three.outcome.hit()) {
        let exit = ray_exit(&target, ray, RayCastOptions::default()).expect("finite").outcome.hit();
        let middle = ray.at((entry.lambda + exit.expect("it was hit").lambda) * s::<V>(0.5));
        let is_in = |y: V| (closest_point(&target, y).expect("a closed form") - y).norm().as_f64() <= allowed;
        let is_deep = (0..3).all(|i| [8.0, -8.0].iter().all(|by| is_in(middle + V::axis(i) * s::<V>(by * allowed))));
        prop_assert!(!is_deep, "{:?}", one);
    }
    let ending = if is_open { Status::Stalled } else { Status::Converged };
    prop_assert_eq!((one.is_certain(), one.status), (!is_open, ending), "{:?}", one);
    match (one.outcome, three.outcome) {
        (Outcome::Hit(a), Outcome::Hit(b)) => {
            let n = b.normal.unwrap_or(V::ZERO);
            let slope = (n.dot(ray.direction).as_f64() / speed).abs().max(1e-6);
            let off = (a.lambda - b.lambda).as_f64().abs() * speed * slope;
            // Where the surface bends away within the rounding of v, Algorithm 1 knows less, and says so.
            let known = (one.upper - one.lower).as_f64() * speed * slope;
            prop_assert!(known <= 256.0 * allowed || is_open, "known to {}: {:?}", known, one);
            let known = if is_open { allowed } else { known };
            prop_assert!(off <= allowed.max(known), "off by {}: {:?} {:?}", off, one, three);
            prop_assert!(one.lower <= three.upper && three.lower <= one.upper, "{:?} {:?}", one, three);
            Ok(Some(true))
        }
        (Outcome::Miss(a), Outcome::Miss(_)) => {
            // The axis separates, at least from the ray ahead of the source as far as it matters: but for the angle
            // that v is turned by where its rounding, a few units in the last place of coordinates near one, is much of
            // its length.
            let turned = 4.0 * V::Scalar::EPSILON.as_f64() / nearest(&target, ray);
            let reach = support_value(&target, a.axis);
            let before = (a.axis.dot(ray.at(s::<V>(1.0))) - reach).as_f64();
            prop_assert!(before > -allowed - 2.0 * DIAMETER * turned, "{} before: {:?}", before, one);
            Ok(Some(false))
        }
        // Only a graze may be either.
        _ => {
            let nearest = nearest(&target, ray);
            prop_assert!(nearest <= 1e-6 * speed, "{} {:?} {:?}", nearest, one, three);
            Ok(None)
        }
    }
}

/// The least diameter of a ball around any of the shapes.
const DIAMETER: f64 = 2.5;

/// The distance of the ray from the shape up to twice its direction: it falls and then rises, so a third can be cut
/// off.
fn nearest<V: Vector3>(target: &Posed<Shape<V>>, ray: Ray<V>) -> f64 {
    let distance = |lambda: f64| {
        let x = ray.at(s::<V>(lambda));
        (x - closest_point(target, x).expect("a closed form")).norm().as_f64()
    };
    let (mut from, mut to) = (0.0, 2.0);
    for _ in 0..60 {
        let (a, b) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if distance(a) < distance(b) {
            to = b;
        } else {
            from = a;
        }
    }
    distance((from + to) / 2.0)
}

fn vector(reach: f64) -> impl Strategy<Value = [f64; 3]> {
    [-reach..reach, -reach..reach, -reach..reach]
}

fn rotation() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(-1.0..1.0).prop_filter("not zero", |q| q.iter().map(|c| c * c).sum::<f64>() > 0.01)
}

proptest! {
    #![proptest_config(convex_support::laws::config(1500))]

    #[test]
    fn algorithms_1_and_3_agree(
        kind in 0_usize..8,
        (turn, aim) in (rotation(), vector(0.9)),
        (from, exponent) in (vector(1.0), 0.5..6.0),
    ) {
        let length = from.iter().map(|c| c * c).sum::<f64>().sqrt();
        prop_assume!(length > 0.1);
        let from = from.map(|c: f64| c * 10.0_f64.powf(exponent) / length);
        agree::<DVec3>(kind, turn, aim, from)?;
        agree::<Vec3A>(kind, turn, aim, from)?;
    }
}

/// The sample is fair: both hits and misses, hardly ever a graze.
#[test]
fn a_quarter_or_more_of_the_rays_hit_and_as_many_miss() {
    let (mut hits, mut misses) = (0, 0);
    for (i, d) in crate::common::directions(600).enumerate() {
        let t = i as f64;
        let aim = [(1.3 * t).sin(), (2.1 * t).sin(), (3.7 * t).sin()].map(|c| 0.5 * c);
        let found =
            agree::<DVec3>(i % 8, [0.1 * t.sin(), 0.5, t.cos(), 0.3], aim, d.map(|c| 1e4 * c)).expect("they agree");
        hits += u32::from(found == Some(true));
        misses += u32::from(found == Some(false));
    }
    assert!(hits >= 150 && misses >= 150, "{hits} hits, {misses} misses");
}

/// A source a million sizes away. The loop stepped with coordinates of its size, lost the body's digits, and stalled
/// before the body or stepped through.
#[test]
fn a_far_source_loses_only_its_own_digits() {
    fn run<V: Vector3>() {
        let ball = shape::<V>(1, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
        for d in crate::common::directions(100) {
            let from = d.map(|c| -1e6 * c);
            let cast = algorithm_1(&ball, Ray { source: v::<V>(from), direction: v(d) });
            let hit = cast.outcome.hit().unwrap_or_else(|| panic!("through the centre: {d:?} {cast:?}"));
            // The rounded ray passes the centre by as much as its coordinates were rounded.
            let ulp = V::Scalar::EPSILON.as_f64();
            let p = [0, 1, 2].map(|i| v::<V>(from).get(i).as_f64());
            let r = [0, 1, 2].map(|i| v::<V>(d).get(i).as_f64());
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let nearest = -dot(p, r) / dot(r, r);
            let foot = [0, 1, 2].map(|i| p[i] + nearest * r[i]);
            let lambda = nearest - ((0.75_f64.powi(2) - dot(foot, foot)) / dot(r, r)).sqrt();
            let error = (hit.lambda.as_f64() - lambda).abs();
            assert!(error <= 4.0 * ulp * 1e6, "{d:?}: off by {error:e}: {cast:?}");
        }
    }
    run::<Vec3A>();
    run::<DVec3>();
}

/// Touching, inside, receding, sliding, and an oracle that is none.
#[test]
fn beginnings_and_ends() {
    let cube = Cuboid::new(DVec3::ONE).expect("positive");
    let cast = |source: [f64; 3], direction: [f64; 3], end: f64| {
        let ray = Ray { source: DVec3::from_array(source), direction: DVec3::from_array(direction) };
        iterative_ray_cast(|x| closest_point(&cube, x), ray, RayCastOptions::new().with_max_lambda(end))
            .expect("finite")
    };
    let infinity = f64::INFINITY;
    for inside in [[0.0; 3], [1.0, 0.3, 0.2], [1.0, 1.0, 1.0]] {
        let hit = cast(inside, [1.0, 2.0, 3.0], infinity).outcome.hit().expect("in the cube");
        assert_eq!((hit.lambda, hit.normal), (0.0, None), "{inside:?}");
    }
    assert!(cast([2.0, 0.0, 0.0], [1.0, 0.0, 0.0], infinity).outcome.is_miss(), "receding");
    assert!(cast([2.0, 0.0, 0.0], [0.0, 1.0, 0.0], infinity).outcome.is_miss(), "sliding");
    assert!(cast([2.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 1.0).outcome.hit().is_some(), "the end belongs to the ray");
    assert!(cast([2.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 1.0 - 1e-15).outcome.hit().is_none(), "less does not reach");
    assert!(cast([2.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 1.0 - 1e-13).outcome.is_miss(), "certainly, by more than rounding");

    let ray = Ray { source: DVec3::X * 3.0, direction: DVec3::NEG_X };
    for broken in [DVec3::NAN, DVec3::INFINITY] {
        let cast = iterative_ray_cast(|_| Some(broken), ray, RayCastOptions::default()).expect("a finite ray");
        assert_eq!(cast.outcome, Outcome::Undecided, "{cast:?}");
    }
    let capped = RayCastOptions::new().with_max_iterations(2);
    let ball = Ball::<DVec3>::new(1.0).expect("positive");
    let ray = Ray { source: DVec3::new(-5.0, 0.9, 0.0), direction: DVec3::X };
    let cast = iterative_ray_cast(|x| closest_point(&ball, x), ray, capped).expect("a finite ray");
    assert_eq!((cast.status, cast.iterations), (Status::IterationLimit, 2));
    assert!(cast.lower < 5.0 - 0.19_f64.sqrt(), "a lower bound all the same: {cast:?}");
}

/// On a polytope the hit is reached in finitely many steps, and on a ball the digits double.
#[test]
fn it_converges_as_newtons_method_does() {
    for kind in 0..7 {
        let target = shape::<DVec3>(kind, [0.3, -0.5, 0.7, 0.4], [0.0; 3]);
        for d in crate::common::directions(40) {
            let mut lambdas = Vec::new();
            let ray = Ray { source: DVec3::from_array(d) * -5.0, direction: DVec3::from_array(d) };
            let cast = iterative_ray_cast_with(
                |x| closest_point(&target, x),
                ray,
                RayCastOptions::default(),
                |iterate| {
                    lambdas.push(iterate.lower);
                },
            );
            // Beside the steps, points are asked that prove where the ray is in the set.
            assert!(cast.is_ok() && lambdas.len() <= 30, "{kind} {d:?}: {lambdas:?}");
            assert!(lambdas.is_sorted(), "λ never goes back: {kind} {d:?} {lambdas:?}");
        }
    }
}

#[test]
fn a_set_without_closest_points_is_refused() {
    let hull = Polytope::new([DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO]).expect("four points");
    let ray = Ray { source: DVec3::splat(2.0), direction: DVec3::NEG_ONE };
    let cast = iterative_ray_cast(|x| closest_point(&hull, x), ray, RayCastOptions::default());
    assert_eq!(cast, Err(RayCastError::NoClosestPoint));
}
