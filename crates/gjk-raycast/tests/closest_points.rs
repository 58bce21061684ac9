//! Where one core is a point and the other says its closest one, or both are segments, that is where a descent begins,
//! and mostly ends.

use crate::common::{Plain, at, cuboid, quaternion, s, turned, ulps, v};
use convex_support::glam::{DVec2, DVec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cylinder, Ellipsoid, Point, Rounded, Scalar, Segment, SupportMap, Triangle, Vector3,
};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, SignedDistanceOptions, Status, distance, intersects, signed_distance,
};
use num_traits::Float as _;

const VALID: &str = "positive sizes";

fn bodies<V: Vector3>() -> Vec<(&'static str, Box<dyn SupportMap<Vector = V>>)> {
    let n = s::<V>;
    let rotation = quaternion::<V>([0.1, 0.2, 0.3, 0.9]);
    vec![
        ("point", Box::new(Point::new(v::<V>([0.3, -0.2, 0.1])).expect(VALID))),
        ("ball", Box::new(Ball::<V>::new(n(0.75)).expect(VALID))),
        ("segment", Box::new(Segment::new([v::<V>([0.5, 0.25, 0.0]), v([-1.0, 0.0, 0.125])]).expect(VALID))),
        (
            "triangle",
            Box::new(Triangle::new([v::<V>([1.0, 0.5, 0.0]), v([-1.0, 0.25, 0.0]), v([0.0, -1.0, 0.5])]).expect(VALID)),
        ),
        ("capsule", Box::new(Capsule::<V>::new(n(0.5), n(0.25)).expect(VALID))),
        ("cuboid", Box::new(turned(cuboid::<V>([1.0, 0.5, 0.25]), rotation, [0.1, 0.2, -0.3]))),
        (
            "rounded",
            Box::new(at(Rounded::new(cuboid::<V>([0.75, 0.5, 0.25]), n(0.25)).expect(VALID), [0.5, 0.0, 0.25])),
        ),
        ("cylinder", Box::new(turned(Cylinder::<V>::new(n(0.5), n(0.75)).expect(VALID), rotation, [0.0, 0.5, 0.0]))),
        ("cone", Box::new(turned(Cone::<V>::new(n(0.75), n(0.5)).expect(VALID), rotation, [0.25, 0.0, 0.0]))),
        ("ellipsoid", Box::new(Ellipsoid::new(v::<V>([0.1, 0.0, 0.2]), v([1.0, 0.5, 0.25]), rotation).expect(VALID))),
    ]
}

/// Centres of a ball all around, near and far, in the bodies and out of them.
fn centres() -> impl Iterator<Item = [f64; 3]> {
    let grid = [-1.6, -0.7, -0.1, 0.0, 0.4, 1.1];
    (0..216).map(move |n| [grid[n % 6], grid[n / 6 % 6], grid[n / 36]])
}

/// One support point certifies what the closed form says, apart from contact, and it is what the support points alone
/// lead to.
#[test]
fn a_ball_needs_one_support_point() {
    fn run<V: Vector3>() {
        for (name, body) in bodies::<V>() {
            let plain = Plain(&body);
            for centre in centres() {
                let ball = at(Ball::<V>::new(s::<V>(0.3)).expect(VALID), centre);
                let (found, other) = (
                    distance(&ball, &body, DistanceOptions::default()),
                    distance(&ball, &plain, DistanceOptions::default()),
                );
                let back = distance(&body, &ball, DistanceOptions::default());
                let what = format!("{name} from {centre:?}: {found:?}, {other:?}");
                assert_eq!((found.overlap, found.status), (other.overlap, Status::Converged), "{what}");
                // Where they touch, to rounding, a plane between them is looked for.
                let needed = if found.overlap && found.normal.is_some() { 4 } else { 1 };
                assert!(found.iterations <= needed && back.iterations <= needed, "{what}");
                // The bracket is 16ε of both sizes and the distance of the origins, which are 6 together at most, and
                // 50ε of a size for a turn.
                let within = s::<V>(ulps::<V>(160.0));
                assert!((found.distance - other.distance).abs() <= within, "{what}");
                assert!((found.distance - back.distance).abs() <= within, "{what}");
                assert!(found.lower <= found.distance && found.distance <= found.upper, "{what}");
                assert!(found.upper - found.lower <= within, "{what}");
                let apart = (found.point_a - found.point_b).norm();
                assert!(found.overlap || (apart - found.distance).abs() <= within, "{what}");
                let meeting = intersects(&ball, &body, IntersectOptions::default());
                assert_eq!(meeting.decided(), Some(found.overlap), "{what}");
                assert!(meeting.iterations <= 2, "{what}: {meeting:?}");
            }
        }
    }
    run::<DVec3>();
    run::<Vec3A>();
}

/// Two capsules, posed all around one another, beside ones whose closed forms nobody knows: across, parallel, nearly
/// parallel and as short as balls.
#[test]
fn two_capsules_need_one_too() {
    fn run<V: Vector3>() {
        let turns = [[0.0, 0.0, 0.0, 1.0], [1e-7, 0.0, 0.0, 1.0], [0.3, 0.2, -0.4, 0.8], [0.7, 0.0, 0.1, 0.7]];
        let capsules = [(1.0, 0.25), (0.5, 0.03), (1e-6, 0.3)];
        for (turn, (centre, (half_height, radius))) in
            centres().enumerate().map(|(i, centre)| (turns[i % 4], (centre, capsules[i % 3])))
        {
            let fixed =
                turned(Capsule::<V>::new(s::<V>(1.0), s::<V>(0.25)).expect(VALID), quaternion::<V>(turns[2]), [0.0; 3]);
            let body = Capsule::<V>::new(s::<V>(half_height), s::<V>(radius)).expect(VALID);
            let body = turned(body, quaternion::<V>(turn), centre);
            is_known_between(&fixed, &body);
            // The same by their ends, as users build links of robots: once where they are, and once turned and moved.
            let upright = |half_height: f64| [-1.0, 1.0].map(|end| v::<V>([0.5, half_height * end, 0.25]));
            let link = Rounded::new(Segment::new(upright(half_height)).expect(VALID), s::<V>(radius)).expect(VALID);
            let there = [fixed.shape().half_height(), -fixed.shape().half_height()]
                .map(|y| fixed.rotation() * (V::axis(1) * y));
            let fixed_link = Rounded::new(Segment::new(there).expect(VALID), s::<V>(0.25)).expect(VALID);
            is_known_between(&fixed_link, &turned(link, quaternion::<V>(turn), centre));
            is_known_between(
                &fixed,
                &turned(turned(link, quaternion::<V>(turns[1]), centre), quaternion::<V>(turn), centre),
            );
        }
    }

    /// The closed form of two segments beside what is found without.
    fn is_known_between<A, B>(fixed: &A, body: &B)
    where
        A: SupportMap + core::fmt::Debug,
        B: SupportMap<Vector = A::Vector> + core::fmt::Debug,
    {
        let found = distance(fixed, body, DistanceOptions::default());
        let other = distance(&Plain(fixed), &Plain(body), DistanceOptions::default());
        let signed = signed_distance(fixed, body, SignedDistanceOptions::default());
        let meeting = intersects(fixed, body, IntersectOptions::default());
        let what = format!("{body:?}: {found:?}, {other:?}, {signed:?}");
        assert!(found.lower <= other.upper && other.lower <= found.upper, "{what}");
        assert!(signed.lower <= found.upper && found.lower <= signed.upper.max(Scalar::ZERO), "{what}");
        assert_eq!((found.overlap, found.status), (other.overlap, Status::Converged), "{what}");
        assert_eq!(meeting.decided(), Some(found.overlap), "{what}");
        let is_apart = found.lower > Scalar::ZERO;
        assert!(!is_apart || found.iterations == 1 && signed.iterations == 1, "{what}");
    }
    run::<DVec3>();
    run::<Vec3A>();
}

#[test]
fn circles_need_one_too() {
    let disc = at(Ball::<DVec2>::new(0.5).expect(VALID), [2.0, 2.0, 0.0]);
    let found = distance(&disc, &cuboid::<DVec2>([1.0, 1.0, 0.0]), DistanceOptions::default());
    assert_eq!((found.iterations, found.distance), (1, 2.0_f64.sqrt() - 0.5));
}

/// A closest point that is none, though a point of the core, costs time and nothing else.
#[test]
fn a_wrong_closest_point_changes_no_answer() {
    struct Astray;
    impl SupportMap for Astray {
        type Vector = DVec3;

        fn support(&self, direction: DVec3) -> DVec3 {
            DVec3::new(1.0, 0.5, 0.25).copysign(direction)
        }

        fn core_closest_point(&self, x: DVec3) -> Option<DVec3> {
            Some(DVec3::new(-0.5, 0.25, 0.0).copysign(-x))
        }
    }
    for centre in centres() {
        let ball = at(Ball::<DVec3>::new(0.3).expect(VALID), centre);
        let right = distance(&ball, &cuboid::<DVec3>([1.0, 0.5, 0.25]), DistanceOptions::default());
        let found = distance(&ball, &Astray, DistanceOptions::default());
        assert_eq!((found.overlap, found.status), (right.overlap, Status::Converged), "{centre:?}: {found:?}");
        assert!((found.distance - right.distance).abs() <= 1e-15, "{centre:?}: {found:?}, {right:?}");
        let meeting = intersects(&ball, &Astray, IntersectOptions::default());
        assert_eq!(meeting.decided(), Some(right.overlap), "{centre:?}");
    }
}

/// At sizes whose squares leave the range of the scalar, closed forms are not asked.
#[test]
fn sizes_beyond_squares_are_left_to_the_descent() {
    for size in [1e-160, 1e160] {
        let cone = Cone::<DVec3>::new(0.75 * size, 0.5 * size).expect(VALID);
        let ball = at(Ball::<DVec3>::new(0.25 * size).expect(VALID), [size, 0.5 * size, 0.0]);
        let unit = distance(
            &at(Ball::<DVec3>::new(0.25).expect(VALID), [1.0, 0.5, 0.0]),
            &Cone::<DVec3>::new(0.75, 0.5).expect(VALID),
            DistanceOptions::default(),
        );
        let found = distance(&ball, &cone, DistanceOptions::default());
        assert!((found.distance / size - unit.distance).abs() <= 1e-14, "{found:?}");
        assert_eq!(intersects(&ball, &cone, IntersectOptions::default()).decided(), Some(false));
    }
}

/// A segment much shorter than the rounding of where it is counts as a point, and is no direction to be across.
#[test]
fn a_segment_shorter_than_its_rounding_is_a_point() {
    use convex_support::{Posed, glam::Vec2};

    let speck = Segment::new([Vec2::new(-1.0, 3.237145e-10), Vec2::new(-1.0, 4.343262e-10)]).expect(VALID);
    let rod = Segment::new([Vec2::ZERO, Vec2::new(0.0, -1.0)]).expect(VALID);
    let rod = Posed::new(rod, core::f32::consts::PI, Vec2::ZERO).expect(VALID);
    let first = Vec2::new(-1.0, -0.999_999_76);
    let speck = Posed::translated(speck, first).expect(VALID);
    for t in (0..200).map(|k| 0.01 * k as f32).chain([1.071_206_7]) {
        let by = Vec2::new(-0.894_427_3, -0.447_213_53) * t;
        let speck = Posed::translated(&speck, by).expect(VALID);
        let truth = (first - Vec2::X + by).length();
        let (found, depth) = (
            distance(&speck, &rod, DistanceOptions::default()),
            signed_distance(&speck, &rod, SignedDistanceOptions::default()),
        );
        assert!(found.lower <= truth && truth <= found.upper, "{t}: {truth} {found:?}");
        assert!(depth.lower <= truth && truth <= depth.upper, "{t}: {truth} {depth:?}");
    }
}
