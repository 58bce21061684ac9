//! Closed-form crossings and nearest points, each against the other and against the support mapping.

use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::strategies as any;
use convex_support::{
    Affine, Ball, Capsule, Cone, CrossedByLine, Crossing, Cuboid, Cylinder, Ellipsoid, LineCrossing, Posed, Rounded,
    Scalar, SupportMap, Triangle, Vector, closest_point, line_crossing,
};
use num_traits::Float;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use std::cell::Cell;
use std::fmt::Debug;

/// A shape with closed forms, of any kind.
trait Shape: CrossedByLine + Debug {}

impl<S: CrossedByLine + Debug> Shape for S {}

type AnyShape<V> = Box<dyn Shape<Vector = V>>;

/// The crossing of a shape that has a closed form of it.
pub(crate) fn crossing_of<V: Vector>(
    shape: &impl CrossedByLine<Vector = V>,
    source: V,
    direction: V,
) -> Option<Crossing<V>> {
    let crossing = line_crossing(shape, source, direction);
    assert_ne!(crossing, LineCrossing::Unknown, "a closed form");
    crossing.crossing()
}

fn nearest<V: Vector>(shape: &AnyShape<V>, x: V) -> V {
    closest_point(shape, x).expect("a closed form")
}

fn boxed<S: Shape + 'static>(strategy: BoxedStrategy<S>) -> BoxedStrategy<AnyShape<S::Vector>> {
    strategy.prop_map(|s| Box::new(s) as AnyShape<S::Vector>).boxed()
}

fn rounded<S>(strategy: BoxedStrategy<S>, size: <S::Vector as Vector>::Scalar) -> BoxedStrategy<AnyShape<S::Vector>>
where
    S: Shape + 'static,
{
    (strategy, any::length(size), any::pose::<S::Vector>(size))
        .prop_map(|(s, r, (q, t))| {
            Box::new(Posed::new(Rounded::new(s, r).unwrap(), q, t).unwrap()) as AnyShape<S::Vector>
        })
        .boxed()
}

fn shapes<V: Vector>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        boxed(any::ball(size)),
        boxed(any::cuboid(size)),
        boxed(any::capsule(size)),
        boxed(any::ellipsoid(size)),
        boxed(any::triangle(size)),
        rounded(any::point(size), size),
        rounded(any::segment(size), size),
        rounded(any::triangle(size), size),
        rounded(any::cuboid(size), size),
        rounded(any::capsule(size), size),
    ]
    .boxed()
}

fn shapes_3d<V: convex_support::Vector3>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        3 => shapes(size),
        1 => boxed((any::cylinder(size), any::pose::<V>(size)).prop_map(|(s, (q, t))| Posed::new(s, q, t).unwrap()).boxed()),
        1 => boxed((any::cone(size), any::pose::<V>(size)).prop_map(|(s, (q, t))| Posed::new(s, q, t).unwrap()).boxed()),
        1 => boxed(any::cylinder(size)),
        1 => boxed(any::cone(size)),
    ]
    .boxed()
}

/// How deep the line is in the shape: the shadow of the shape along the line is convex, and so the least of
/// `h(n) − n·source` over the unit vectors `n` across the line; negative where the line misses.
fn depth_of_line<V: Vector>(shape: &AnyShape<V>, source: V, unit: V) -> V::Scalar {
    let mut basis: Vec<V> = vec![unit];
    while basis.len() < V::DIM {
        let across = |i: usize| {
            let once = basis.iter().fold(V::axis(i), |v, &b| v - b * b.dot(v));
            basis.iter().fold(once, |v, &b| v - b * b.dot(v))
        };
        let longest = (0..V::DIM).map(across).max_by(|a, b| a.norm().partial_cmp(&b.norm()).unwrap()).unwrap();
        basis.push(longest.unit().unwrap());
    }
    let depth = |n: V| n.dot(shape.support(n) - source);
    if V::DIM == 2 {
        return depth(basis[1]).min(depth(-basis[1]));
    }
    let at =
        |angle: f64| depth(basis[1] * V::Scalar::from_f64(angle.cos()) + basis[2] * V::Scalar::from_f64(angle.sin()));
    let step = std::f64::consts::TAU / 256.0;
    let sample: Vec<_> = (0..256).map(|k| at(f64::from(k) * step)).collect();
    let ratio = 0.618_033_988_749_894_9;
    let mut least = V::Scalar::infinity();
    // From every local minimum of the samples, since a shadow has one for each of its sides.
    for k in (0..256).filter(|&k| sample[k] <= sample[(k + 1) % 256] && sample[k] <= sample[(k + 255) % 256]) {
        let (mut low, mut high) = ((k as f64 - 1.0) * step, (k as f64 + 1.0) * step);
        least = least.min(sample[k]);
        for _ in 0..60 {
            let (p, q) = (high - (high - low) * ratio, low + (high - low) * ratio);
            let (dp, dq) = (at(p), at(q));
            least = least.min(dp).min(dq);
            if dp < dq { high = q } else { low = p }
        }
    }
    least
}

fn check<V: Vector>(
    shape: &AnyShape<V>,
    source: V,
    target: V,
    scale: V::Scalar,
    hits: &Cell<(u32, u32)>,
    apart: &Cell<(u32, u32)>,
) -> Result<(), TestCaseError> {
    let direction = target - source;
    prop_assume!(direction.norm() > scale * V::Scalar::from_f64(1e-3));
    let unit = direction / direction.norm();
    let ulps = |n: f64| V::Scalar::EPSILON * V::Scalar::from_f64(n);
    let from = (source - shape.core().origin).norm();
    let tolerance = ulps(64.0) * (scale + from);
    let (hit, miss) = hits.get();
    match crossing_of(shape, source, direction) {
        Some(Crossing { entry, exit, normal }) => {
            hits.set((hit + 1, miss));
            prop_assert!(entry <= exit, "entry {entry:?} after exit {exit:?}");
            let depth = depth_of_line(shape, source, unit);
            prop_assert!(depth >= -tolerance, "a hit, but the line is {depth:?} deep");
            // A shape smaller than the roundings of the source is hit somewhere within them.
            let coarse = V::Scalar::ONE + tolerance / (shape.core().extent + shape.core().radius);
            prop_assert!(
                (normal.norm() - V::Scalar::ONE).abs() <= ulps(16.0) * coarse,
                "normal {normal:?} is not unit"
            );
            for (name, lambda) in [("entry", entry), ("exit", exit)] {
                let p = source + direction * lambda;
                let off = (p - nearest(shape, p)).norm();
                prop_assert!(off <= tolerance, "{name} {lambda:?} is {off:?} off the shape, allowed {tolerance:?}");
            }
            // The plane across the normal at the entry supports the shape. A point off by e along a line that grazes a
            // surface of curvature 1/ρ turns the normal by e/ρ, and ρ may be as small as 1e-12 sizes: only flat and
            // moderately curved shapes are held to it, below.
            prop_assert!(unit.dot(normal) <= ulps(64.0).sqrt(), "the normal {normal:?} looks along the line");
            // What is before the entry and behind the exit is outside.
            let step = tolerance.sqrt() * (scale + from).sqrt();
            for lambda in [entry - step / direction.norm(), exit + step / direction.norm()] {
                let p = source + direction * lambda;
                if lambda < entry - tolerance / direction.norm() {
                    prop_assert!(
                        normal.dot(p) >= normal.dot(source + direction * entry) - tolerance,
                        "before the entry is inside"
                    );
                } else {
                    let off = p - nearest(shape, p);
                    let grazes = depth <= tolerance * V::Scalar::from_f64(32.0);
                    prop_assert!(off != V::ZERO || grazes, "behind the exit {exit:?} is inside");
                }
            }
        }
        None => {
            hits.set((hit, miss + 1));
            let depth = depth_of_line(shape, source, unit);
            prop_assert!(depth <= tolerance, "a miss, but the line is {depth:?} deep, allowed {tolerance:?}");
            let LineCrossing::Misses(axis) = line_crossing(shape, source, direction) else { unreachable!("a miss") };
            if let Some(n) = axis.unit().filter(|_| depth < -tolerance) {
                // A line that meets an edge within rounding may be told to pass beside it.
                let is_before = n.dot(source - shape.support(n)) >= -tolerance;
                let is_across = n.dot(unit).abs() * -depth <= tolerance;
                let (clear, certain) = apart.get();
                apart.set((clear + 1, certain + u32::from(is_before && is_across)));
            }
        }
    }
    Ok(())
}

fn crosses<V: Vector>(shapes: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>) {
    let strategy = any::size::<V::Scalar>().prop_flat_map(move |size| {
        let reach = prop_oneof![Just(3.0), Just(10.0), Just(1e3)];
        (
            shapes(size),
            reach.prop_flat_map(move |r| any::vector::<V>(size * V::Scalar::from_f64(r))),
            any::vector::<V>(size),
            Just(size),
        )
    });
    let (hits, apart) = (Cell::new((0, 0)), Cell::new((0, 0)));
    // The same cases every time: one in some hundred thousand grazes a sliver at more than the tolerance.
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let outcome = runner.run(&strategy, |(shape, source, target, size)| {
        check(&shape, source, target, size * V::Scalar::from_f64(4.0), &hits, &apart)
    });
    if let Err(error) = outcome {
        panic!("in {}: {error}", std::any::type_name::<V>());
    }
    let (hit, miss) = hits.get();
    assert!(hit > 200 && miss > 200, "{hit} hits and {miss} misses are no fair sample");
    let (clear, certain) = apart.get();
    assert!(clear > 100 && certain * 100 > clear * 98, "{certain} of {clear} lines are apart along what is told");
}

#[test]
fn crossings_begin_and_end_on_the_surface() {
    crosses::<DVec2>(shapes);
    crosses::<DVec3>(shapes_3d);
    crosses::<Vec2>(shapes);
    crosses::<Vec3>(shapes_3d);
    crosses::<Vec3A>(shapes_3d);
}

/// Shapes about the origin, all of which the line from (4, 0.25, 0.5) towards the origin crosses.
fn around_zero() -> Vec<(&'static str, AnyShape<DVec3>)> {
    let cuboid = Cuboid::new(DVec3::new(1.0, 0.5, 0.75)).unwrap();
    let stretched = Affine::new(cuboid, DMat3::from_diagonal(DVec3::new(1.0, -2.0, 0.5)), DVec3::ZERO).unwrap();
    let corners = [DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, 1.0, -2.0), DVec3::new(0.0, -2.0, 0.0)];
    vec![
        ("ball", Box::new(Ball::new(1.0).unwrap())),
        ("cuboid", Box::new(cuboid)),
        ("capsule", Box::new(Capsule::new(1.0, 0.5).unwrap())),
        ("cylinder", Box::new(Cylinder::new(1.0, 0.5).unwrap())),
        ("cone", Box::new(Cone::new(1.0, 0.5).unwrap())),
        ("ellipsoid", Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DQuat::IDENTITY).unwrap())),
        ("rounded cuboid", Box::new(Rounded::new(cuboid, 0.25).unwrap())),
        ("rounded triangle", Box::new(Rounded::new(Triangle::new(corners).unwrap(), 0.25).unwrap())),
        ("stretched cuboid", Box::new(stretched)),
    ]
}

#[test]
fn directions_may_have_any_length() {
    for (name, shape) in around_zero() {
        let source = DVec3::new(4.0, 0.25, 0.5);
        let unit = crossing_of(&shape, source, -source).expect(name);
        assert!(unit.entry > 0.5 && unit.exit < 1.5 && unit.entry <= unit.exit, "{name}: {unit:?}");
        // Exactly: a power of two changes no digit, not even where the square of the direction is not a number.
        for power in [-1010, -700, -511, -300, -1, 1, 300, 511, 700, 1020] {
            let scale = 2f64.powi(power);
            let crossing = crossing_of(&shape, source, -source * scale).expect(name);
            let expected = Crossing { entry: unit.entry / scale, exit: unit.exit / scale, ..unit };
            let digits = if power < 1020 { 0.0 } else { 1e-14 }; // λ has few digits left where it is subnormal
            assert!((crossing.entry - expected.entry).abs() <= digits * expected.entry, "{name}, 2^{power}");
            assert!((crossing.exit - expected.exit).abs() <= digits * expected.exit, "{name}, 2^{power}");
            assert_eq!(crossing.normal, expected.normal, "{name}, 2^{power}");
        }
    }
}

#[test]
fn what_is_no_line_has_no_crossing() {
    let source = DVec3::new(4.0, 0.25, 0.5);
    for (name, shape) in around_zero() {
        assert_eq!(crossing_of(&shape, source, DVec3::ZERO), None, "{name}: a zero direction");
        assert_eq!(crossing_of(&shape, DVec3::ZERO, DVec3::ZERO), None, "{name}: a zero direction from inside");
        for i in 0..3 {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let broken = |v: DVec3| DVec3::from_fn(|k| if k == i { bad } else { v[k] });
                let nan = bad.is_nan();
                let from = crossing_of(&shape, broken(source), -source);
                assert!(from.is_none() || !nan, "{name}: from {bad} in coordinate {i}: {from:?}");
                let along = crossing_of(&shape, source, broken(-source));
                assert!(along.is_none() || !nan, "{name}: along {bad} in coordinate {i}: {along:?}");
            }
        }
    }
}

#[test]
fn lines_in_the_planes_of_faces_and_along_edges_are_within() {
    let cuboid = Cuboid::new(DVec3::ONE).unwrap();
    for (y, z) in [(1.0, 0.0), (-1.0, 0.5), (0.0, 1.0), (1.0, -1.0), (0.0, 0.0)] {
        for towards in [1.0, -1.0] {
            for zero in [0.0, -0.0] {
                let source = DVec3::new(-3.0 * towards, y, z);
                let crossing = crossing_of(&cuboid, source, DVec3::new(towards, zero, zero)).expect("closed");
                assert_eq!((crossing.entry, crossing.exit), (2.0, 4.0), "y = {y}, z = {z}");
                assert_eq!(crossing.normal, DVec3::new(-towards, 0.0, 0.0), "y = {y}, z = {z}");
                let beside = source + DVec3::new(0.0, 0.0, 2.5);
                assert_eq!(crossing_of(&cuboid, beside, DVec3::new(towards, zero, zero)), None, "beside");
            }
        }
    }
}
