//! What single precision is certain of about where lines enter shapes, against the closed forms of the same numbers in
//! double precision.

use std::cell::Cell;

use convex_support::glam::{DVec3, Vec2, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, CertainCrossing, Cone, CrossedByLine, Cuboid, Cylinder, Ellipsoid, Faceted, LineCrossing,
    LineQuery, Matrix, MinkowskiSum, Point, Posed, Rotation as _, Rounded, Scalar, Segment, SupportMap, Triangle,
    Vector3, line_crossing, support_value,
};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

type AnyShape<V> = Box<dyn CrossedByLine<Vector = V>>;

/// What a shape knows of a line, in plain numbers or else closely.
fn known_of<S: SupportMap + ?Sized>(shape: &S, line: LineQuery<S::Vector>) -> Option<CertainCrossing<S::Vector>> {
    shape.certain_crossing(line).or_else(|| shape.certain_crossing(LineQuery { is_close: true, ..line }))
}

/// How many kinds of shapes [`shape`] makes.
const KINDS: usize = 13;

/// A shape of three lengths, in either precision.
fn shape<V: Vector3>(kind: usize, lengths: [f32; 3], [x, y, z, w]: [f32; 4]) -> AnyShape<V> {
    let [a, b, c] = lengths.map(|length| V::Scalar::from_f64(f64::from(length)));
    let extents = V::from_fn(|i| [a, b, c][i]);
    let number = |x: f32| V::Scalar::from_f64(f64::from(x));
    let rotation = V::Rotation::from_xyzw([x, y, z, w].map(|q| V::Scalar::from_f64(f64::from(q))));
    match kind {
        0 => Box::new(Ball::new(a).unwrap()),
        1 => Box::new(Cuboid::new(extents).unwrap()),
        2 => Box::new(Capsule::new(a, b).unwrap()),
        3 => Box::new(Cylinder::new(a, b).unwrap()),
        4 => Box::new(Cone::new(a, b).unwrap()),
        5 => Box::new(Ellipsoid::new(V::ZERO, extents, rotation).unwrap()),
        6 => Box::new(Rounded::new(Cuboid::new(extents).unwrap(), a).unwrap()),
        7 => Box::new(Rounded::new(Point::new(extents).unwrap(), c).unwrap()),
        8 => {
            let end = V::from_fn(|i| V::Scalar::from_f64(f64::from([x, y, z][i] / 64.0)) * b);
            Box::new(Rounded::new(Segment::new([extents, extents + end]).unwrap(), c).unwrap())
        }
        9 => {
            let corner = |i: usize| V::from_fn(|k| extents.get((k + i) % 3) * number(if i == k { -x } else { y }));
            Box::new(Triangle::new([corner(0), corner(1), corner(2)]).unwrap())
        }
        10 => {
            let matrix = V::Matrix::from_cols_fn(|j| V::from_fn(|i| number(if i == j { x } else { y / (z + 200.0) })));
            Box::new(Affine::new(Cuboid::new(extents).unwrap(), matrix, extents).unwrap())
        }
        11 => {
            let ball = Rounded::new(Point::new(extents).unwrap(), c).unwrap();
            Box::new(MinkowskiSum::new(Posed::translated(ball, extents).unwrap(), Cuboid::new(extents).unwrap()))
        }
        _ => {
            Box::new(Faceted::hull_of(hull(lengths).map(|p| V::from_fn(|i| V::Scalar::from_f64(p[i].into())))).unwrap())
        }
    }
}

/// The corners of a box and three points beside it, which have their middle aside of zero.
fn hull([a, b, c]: [f32; 3]) -> [[f32; 3]; 11] {
    core::array::from_fn(|i| match i {
        8 => [2.0 * a, 0.5 * b, 0.0],
        9 => [0.0, 1.5 * b, -0.25 * c],
        10 => [-0.5 * a, -0.25 * b, 3.0 * c],
        _ => [(a, 1), (b, 2), (c, 4)].map(|(length, bit)| if i & bit == 0 { length } else { -length }),
    })
}

/// The same swept by a ball of half a length, turned and moved, each if it is asked for. Of the shapes that cannot be
/// swept none is.
fn changed<V: Vector3>(
    (kind, lengths, rotation): (usize, [f32; 3], [f32; 4]),
    [is_swept, is_posed]: [bool; 2],
    translation: [f32; 3],
) -> AnyShape<V> {
    let number = |x: f32| V::Scalar::from_f64(f64::from(x));
    let mut it = shape::<V>(kind, lengths, rotation);
    if is_swept && [0, 1, 2, 6, 7, 8, 9, 11].contains(&kind) {
        it = Box::new(Rounded::new(it, number(lengths[0])).unwrap());
    }
    if is_posed {
        let turn = V::Rotation::from_xyzw(rotation.map(number));
        it = Box::new(Posed::new(it, turn, V::from_fn(|i| number(translation[i]))).unwrap());
    }
    it
}

fn single(v: DVec3) -> Vec3A {
    v.as_vec3a()
}

fn double(v: Vec3A) -> DVec3 {
    v.as_dvec3()
}

prop_compose! {
    fn unit()(x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0) -> DVec3 {
        DVec3::new(x, y, z).try_normalize().unwrap_or(DVec3::X)
    }
}

/// Lines are aimed at points of the surface, at edges, and past them by less than rounding and more, from near and far.
#[test]
fn what_is_certain_in_single_precision_is_so_in_double() {
    let (certain, asked) = (Cell::new([0; 2]), Cell::new(0));
    let length = || (-1.3..1.3_f64).prop_map(|x| 10.0_f64.powf(x) as f32);
    let body = (0..KINDS, [length(), length(), length()], any::<[i8; 4]>(), any::<[bool; 2]>(), -3.0..100.0_f32);
    let line = (unit(), unit(), unit(), [0.0..1.0, 0.0..1.0], -8.0..0.0, 0..5_usize, 0..6_usize);
    let cases = ProptestConfig { failure_persistence: None, ..convex_support::laws::config(60_000) };
    TestRunner::new(cases)
        .run(&(body, line), |((kind, lengths, q, changes, far), (n, m, aside, [part, by], exponent, aim, from))| {
            let quaternion = if q == [0; 4] { [0.0, 0.0, 0.0, 1.0] } else { q.map(f32::from) };
            let parts = (kind, lengths, quaternion);
            let translation = [far, -0.5 * far, 0.25 * far];
            let here = changed::<Vec3A>(parts, changes, translation);
            let truth = changed::<DVec3>(parts, changes, translation);
            let core = truth.core();
            let (origin, size) = (core.origin, core.extent + core.radius);
            let tilted = |n: DVec3, by: f64| (n + m * by).normalize();
            let on_surface = match aim {
                0 => origin + m * (size * part),
                1 => truth.support(n),
                2 => truth.support(n).lerp(truth.support(tilted(n, 1e-3)), part),
                3 => truth.support(DVec3::X).lerp(truth.support(tilted(DVec3::X, 0.3)), part),
                _ => truth.support(n).lerp(truth.support(m), part),
            };
            let target = on_surface + aside * (size * 10.0_f64.powf(exponent) * (by - 0.5));
            let along = n.cross(m).try_normalize().unwrap_or(DVec3::Y);
            let away =
                [n, m, tilted(n, by), (along + n * 10.0_f64.powf(exponent)).normalize(), DVec3::Z, DVec3::NEG_X][from];
            let source = single(target + away * (size * [1e-6, 1e-3, 3.0, 7.0, 50.0][aim]));
            let direction = single(if part < 0.5 { target - double(source) } else { -away });
            if direction == Vec3A::ZERO {
                return Ok(());
            }
            asked.set(asked.get() + 1);
            let crossing = line_crossing(&truth, double(source), double(direction)).crossing();
            // A few roundings of the closed form across the surface, which move the crossing the farther the less steep
            // it is.
            let lost = |normal: DVec3| {
                let (reach, steep) =
                    (size + origin.length() + double(source).length(), normal.dot(double(direction)).abs());
                reach * (1e-12 / double(direction).length()).max(16.0 * f64::EPSILON / steep)
            };
            match known_of(&here, LineQuery::new(source, direction)) {
                None => {}
                Some(CertainCrossing::Misses(axis)) => {
                    certain.set([certain.get()[0] + 1, certain.get()[1]]);
                    prop_assert!(crossing.is_none(), "it hits: {:?}", crossing);
                    let (n, d) = (double(axis).normalize(), double(direction).normalize());
                    let reach = size + (double(source) - origin).length();
                    prop_assert!(n.dot(d).abs() < 1e-3, "not across the line: {}", n.dot(d));
                    let across = (n - d * n.dot(d)).normalize();
                    let ahead = across.dot(double(source)) - support_value(&truth, across);
                    prop_assert!(ahead > -3e-6 * reach, "not apart by {}", -ahead);
                }
                Some(CertainCrossing::Enters { entry, bounds: [earliest, latest], normal }) => {
                    certain.set([certain.get()[0], certain.get()[1] + 1]);
                    prop_assert!(earliest <= entry && entry <= latest, "{:?}", [earliest, entry, latest]);
                    prop_assert!((normal.length() - 1.0).abs() < 1e-4, "no unit vector: {}", normal);
                    let Some(crossing) = crossing else {
                        // Rounding decides it in double precision too, within the bounds.
                        return Err(TestCaseError::fail(format!("it misses: {earliest} {entry} {latest}")));
                    };
                    let lost = lost(crossing.normal);
                    prop_assert!(f64::from(earliest) <= crossing.entry + lost, "{} {:?}", earliest, crossing);
                    prop_assert!(f64::from(latest) >= crossing.entry - lost, "{} {:?}", latest, crossing);
                }
            }
            Ok(())
        })
        .unwrap();
    let [misses, hits] = certain.get();
    assert!(misses > asked.get() / 20 && hits > asked.get() / 3, "{misses} misses and {hits} hits of {}", asked.get());
}

/// The line is along the segment and crosses it, and rounding says that it passes it by a 1e-8th of its length. In
/// single precision the square of that, times the square of the size, is zero, and zero is not less than zero: so it
/// counted as a certain miss.
#[test]
fn what_is_too_small_to_be_squared_is_not_certain() {
    let ends = [Vec2::new(-1.049_297_6e-5, 2.778_323e-6), Vec2::new(-2.156_398_5e-6, 3.496_756_5e-5)];
    let (source, direction) = (Vec2::new(-4.804_958_4e-5, -1.422_354_7e-4), Vec2::new(0.243_745_95, 0.941_153_3));
    let segment = Segment::new(ends).unwrap();
    assert_eq!(known_of(&segment, LineQuery::new(source, direction)), None);
    let exact = Segment::new(ends.map(Vec2::as_dvec2)).unwrap();
    let crossing = line_crossing(&exact, source.as_dvec2(), direction.as_dvec2());
    assert!(matches!(crossing, LineCrossing::Crosses(_)), "{crossing:?}");
}

/// Bounds that allow for a displacement of the line by roundings of the size are long along a line that is nearly along
/// a side, or grazes it, and none where it may pass. In twice the precision the crossing of the numbers as they are
/// given is known to its own roundings: a line that is one last bit inside enters for certain.
#[test]
fn a_line_nearly_along_a_side_is_looked_at_closely() {
    const TILT: f64 = 1.0 / 1_073_741_824.0;
    let [beside, outside] = [3.0, 9.0].map(|tilts| DVec3::new(1.0 + tilts * TILT, -2.0, 0.0));
    let along = DVec3::new(-TILT, 1.0, 0.0);
    let (cylinder, capsule) = (Cylinder::<DVec3>::new(4.0, 1.0).unwrap(), Capsule::<DVec3>::new(4.0, 1.0).unwrap());
    let prism = Rounded::new(Cuboid::new(DVec3::new(0.5, 4.0, 2.0)).unwrap(), 0.5).unwrap();
    for shape in [&cylinder as &dyn SupportMap<Vector = DVec3>, &capsule, &prism] {
        let line = LineQuery::new(beside, along);
        let known = known_of(shape, line);
        let Some(CertainCrossing::Enters { bounds: [earliest, latest], normal, .. }) = known else {
            panic!("{known:?}")
        };
        assert!(earliest <= 3.0 && 3.0 <= latest && latest - earliest <= 32.0 * f64::EPSILON, "{known:?}");
        assert!((normal - DVec3::X).length() < 1e-9, "{known:?}");
        // It comes to the height of the end first, where a capsule bends away.
        let known = known_of(shape, LineQuery::new(outside, along));
        assert!(matches!(known, Some(CertainCrossing::Misses(_))), "{known:?}");
        // What the line may be displaced by counts as before.
        let known = known_of(shape, LineQuery { error: 1e-12, ..line });
        let Some(CertainCrossing::Enters { bounds: [earliest, latest], .. }) = known else { panic!("{known:?}") };
        assert!(earliest <= 3.0 - 1e-12 / TILT && 3.0 + 1e-12 / TILT <= latest, "{known:?}");
        assert!(latest - earliest <= 1e-11 / TILT, "{known:?}");
    }
    // One last bit inside and outside.
    let up = |x: f64| DVec3::new(x, -2.0, 0.0);
    for ball in [&cylinder as &dyn SupportMap<Vector = DVec3>, &Ball::<DVec3>::new(1.0).unwrap()] {
        let known =
            [1.0 - f64::EPSILON, 1.0 + f64::EPSILON].map(|x| known_of(ball, LineQuery::new(up(x), DVec3::Y * 2.0)));
        assert!(matches!(known[0], Some(CertainCrossing::Enters { .. })), "{known:?}");
        assert!(!matches!(known[1], Some(CertainCrossing::Enters { .. })), "{known:?}");
    }
    // The generator x = (1 − y)/2, beside which the leading coefficient of the quadratic cancels.
    let cone = Cone::<DVec3>::new(1.0, 1.0).unwrap();
    let line = LineQuery::new(DVec3::new(0.25 + 1.25 * TILT, 0.5, 0.0), DVec3::new(0.5 - TILT, -1.0, 0.0));
    let known = known_of(&cone, line);
    let Some(CertainCrossing::Enters { bounds: [earliest, latest], .. }) = known else { panic!("{known:?}") };
    assert!(earliest <= 1.25 && 1.25 <= latest && latest - earliest <= 32.0 * f64::EPSILON, "{known:?}");
}
