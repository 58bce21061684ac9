//! What an answer does not depend on: the unit of length, the order of the bodies, the direction the search begins with.

use crate::common::ulps;
use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Polytope, Posed, Rounded, Scalar, SupportMap,
    Vector,
};
use gjk_raycast::{
    Distance, DistanceOptions, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, Status, distance, intersects,
    linear_cast, ray_cast,
};
use proptest::prelude::*;

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// One of eight shapes, of sizes `d` and at a pose, scaled by `unit`.
fn shape(kind: usize, d: DVec3, rotation: DQuat, place: DVec3, unit: f64) -> Result<Shape<DVec3>, InvalidShape> {
    let s = d * unit;
    let shape: Shape<DVec3> = match kind {
        0 => Box::new(Cuboid::new(s)?),
        1 => Box::new(Ball::new(s.x)?),
        2 => Box::new(Capsule::<DVec3>::new(s.x, s.y)?),
        3 => Box::new(Cylinder::<DVec3>::new(s.x, s.y)?),
        4 => Box::new(Cone::<DVec3>::new(s.x, s.y)?),
        5 => Box::new(Ellipsoid::new(DVec3::ZERO, s, DQuat::IDENTITY)?),
        6 => Box::new(Rounded::new(Cuboid::new(s)?, s.z)?),
        _ => Box::new(Polytope::new([s, -s, s.yzx(), -s.zxy(), DVec3::new(-s.x, s.z, s.y)])?),
    };
    Ok(Box::new(Posed::new(shape, rotation, place * unit)?))
}

trait Swizzle {
    fn yzx(self) -> Self;
    fn zxy(self) -> Self;
}

impl Swizzle for DVec3 {
    fn yzx(self) -> Self {
        Self::new(self.y, self.z, self.x)
    }

    fn zxy(self) -> Self {
        Self::new(self.z, self.x, self.y)
    }
}

fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Sizes of moderate or of wild aspect.
fn sizes() -> impl Strategy<Value = DVec3> {
    let size = || prop_oneof![3 => 0.2..1.5, 1 => Just(1e-3), 1 => Just(1e-6)];
    (size(), size(), size()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn rotation() -> impl Strategy<Value = DQuat> {
    (vector(1.0), -3.0..3.0)
        .prop_filter("an axis", |(axis, _)| axis.length() > 0.1)
        .prop_map(|(axis, angle)| DQuat::from_axis_angle(axis.normalize(), angle))
}

/// Two bodies, and a motion.
struct Scene {
    kinds: (usize, usize),
    sizes: (DVec3, DVec3),
    turns: (DQuat, DQuat),
    place: DVec3,
    velocity: DVec3,
}

/// The bodies of a space: some have a third dimension only.
trait Space: Vector {
    fn upright(kind: usize, half_height: Self::Scalar, radius: Self::Scalar) -> Result<Shape<Self>, InvalidShape>;
    fn turn(rotation: DQuat) -> Self::Rotation;
}

fn in_space<V: convex_support::Vector3>(kind: usize, h: V::Scalar, r: V::Scalar) -> Result<Shape<V>, InvalidShape> {
    Ok(if kind == 3 { Box::new(Cylinder::<V>::new(h, r)?) } else { Box::new(Cone::<V>::new(h, r)?) })
}

fn in_the_plane<V: Vector>(h: V::Scalar, r: V::Scalar) -> Result<Shape<V>, InvalidShape> {
    Ok(Box::new(Capsule::<V>::new(h, r)?))
}

impl Space for DVec3 {
    fn upright(kind: usize, half_height: f64, radius: f64) -> Result<Shape<Self>, InvalidShape> {
        in_space(kind, half_height, radius)
    }
    fn turn(rotation: DQuat) -> DQuat {
        rotation
    }
}

impl Space for Vec3A {
    fn upright(kind: usize, half_height: f32, radius: f32) -> Result<Shape<Self>, InvalidShape> {
        in_space(kind, half_height, radius)
    }
    fn turn(rotation: DQuat) -> Self::Rotation {
        rotation.as_quat()
    }
}

impl Space for DVec2 {
    fn upright(_: usize, half_height: f64, radius: f64) -> Result<Shape<Self>, InvalidShape> {
        in_the_plane(half_height, radius)
    }
    fn turn(rotation: DQuat) -> f64 {
        4.0 * rotation.x
    }
}

impl Space for Vec2 {
    fn upright(_: usize, half_height: f32, radius: f32) -> Result<Shape<Self>, InvalidShape> {
        in_the_plane(half_height, radius)
    }
    fn turn(rotation: DQuat) -> f32 {
        4.0 * rotation.as_quat().x
    }
}

fn solid<V: Space>(
    kind: usize,
    d: DVec3,
    turn: DQuat,
    place: DVec3,
    unit: V::Scalar,
) -> Result<Shape<V>, InvalidShape> {
    let to = |p: DVec3| V::from_fn(|i| V::Scalar::from_f64(p[i])) * unit;
    let number = |x: f64| V::Scalar::from_f64(x) * unit;
    let shape: Shape<V> = match kind {
        0 => Box::new(Cuboid::new(to(d))?),
        1 => Box::new(Ball::new(number(d.x))?),
        2 => Box::new(Capsule::<V>::new(number(d.x), number(d.y))?),
        3 | 4 => V::upright(kind, number(d.x), number(d.y))?,
        5 => Box::new(Ellipsoid::new(V::ZERO, to(d), V::turn(DQuat::IDENTITY))?),
        6 => Box::new(Rounded::new(Cuboid::new(to(d))?, number(d.z))?),
        _ => Box::new(Polytope::new([d, -d, d.yzx(), -d.zxy(), DVec3::new(-d.x, d.z, d.y)].map(to))?),
    };
    Ok(Box::new(Posed::new(shape, V::turn(turn), to(place))?))
}

/// All four queries in two units: every number that is a length is scaled, and every other is the same, to the bit.
fn scaled<V: Space>(scene: &Scene, exponent: i32) -> Result<(), TestCaseError> {
    let unit = V::Scalar::from_f64(2.0_f64.powi(exponent));
    let to = |p: DVec3| V::from_fn(|i| V::Scalar::from_f64(p[i]));
    let pair = |unit: V::Scalar| {
        let a = solid::<V>(scene.kinds.0, scene.sizes.0, scene.turns.0, DVec3::ZERO, unit).expect("valid");
        let b = solid::<V>(scene.kinds.1, scene.sizes.1, scene.turns.1, scene.place, unit).expect("valid");
        (a, b)
    };
    let ((a, b), (a_big, b_big)) = (pair(V::Scalar::ONE), pair(unit));

    let small = distance(&a, &b, DistanceOptions::default());
    let big = distance(&a_big, &b_big, DistanceOptions::default());
    prop_assert_eq!([small.distance, small.lower, small.upper].map(|x| x * unit), [big.distance, big.lower, big.upper]);
    prop_assert_eq!([small.point_a, small.point_b].map(|p| p * unit), [big.point_a, big.point_b]);
    prop_assert_eq!((small.normal, small.overlap, small.iterations), (big.normal, big.overlap, big.iterations));

    let meets = intersects(&a, &b, Default::default());
    prop_assert_eq!(meets, intersects(&a_big, &b_big, Default::default()));

    let velocity = to(scene.velocity);
    prop_assume!(velocity != V::ZERO);
    let motion = |unit: V::Scalar| Motion { velocity_a: velocity * unit, velocity_b: V::ZERO };
    let small = linear_cast(&a, &b, motion(V::Scalar::ONE), LinearCastOptions::default()).expect("finite");
    let big = linear_cast(&a_big, &b_big, motion(unit), LinearCastOptions::default()).expect("finite");
    prop_assert_eq!((small.lower, small.upper, small.iterations), (big.lower, big.upper, big.iterations));
    match (small.outcome, big.outcome) {
        (Outcome::Hit(x), Outcome::Hit(y)) => {
            prop_assert_eq!((x.time, x.normal, x.point * unit), (y.time, y.normal, y.point));
        }
        (x, y) => prop_assert_eq!(x, y),
    }

    let ray = |unit: V::Scalar| Ray { source: to(scene.place) * unit, direction: -velocity * unit };
    let small = ray_cast(&a, ray(V::Scalar::ONE), RayCastOptions::default()).expect("finite");
    let big = ray_cast(&a_big, ray(unit), RayCastOptions::default()).expect("finite");
    prop_assert_eq!((small.lower, small.upper, small.iterations), (big.lower, big.upper, big.iterations));
    match (small.outcome, big.outcome) {
        (Outcome::Hit(x), Outcome::Hit(y)) => {
            prop_assert_eq!((x.lambda, x.normal, x.point * unit), (y.lambda, y.normal, y.point));
        }
        (x, y) => prop_assert_eq!(x, y),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// A power of two changes no bit of any mantissa: of all four queries, in both precisions, in space and in the plane.
    #[test]
    fn the_unit_of_length_does_not_matter(
        (kinds, sizes) in ((0_usize..8, 0_usize..8), (sizes(), sizes())),
        (turns, place, velocity) in ((rotation(), rotation()), vector(3.0), vector(2.0)),
        exponent in -60_i32..60,
    ) {
        let scene = Scene { kinds, sizes, turns, place, velocity };
        scaled::<DVec3>(&scene, exponent)?;
        scaled::<DVec2>(&scene, exponent)?;
        // Single precision has fewer exponents, and the squares of lengths of 1e-6 take a part of them.
        scaled::<Vec3A>(&scene, exponent / 4)?;
        scaled::<Vec2>(&scene, exponent / 4)?;
    }

    /// Moving both bodies by what their coordinates can hold changes no bit; by anything else, no more than the rounding of
    /// the coordinates.
    #[test]
    fn a_common_translation_does_not_matter(
        (kind_a, kind_b) in (0_usize..7, 0_usize..8),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in (rotation(), rotation()),
        (place, by) in ([-48_i32..48, -48..48, -48..48], vector(1.0)),
        exponent in 0_i32..20,
    ) {
        let place = DVec3::from_array(place.map(|c| f64::from(c) / 16.0));
        let whole = DVec3::new(1.0, -3.0, 2.0) * 2.0_f64.powi(exponent);
        let pair = |by: DVec3| (
            shape(kind_a, d_a, turn_a, by, 1.0).expect("valid"),
            shape(kind_b, d_b, turn_b, place + by, 1.0).expect("valid"),
        );
        let answer = |by: DVec3| { let (a, b) = pair(by); distance(&a, &b, DistanceOptions::default()) };
        let (here, there, elsewhere) = (answer(DVec3::ZERO), answer(whole), answer(by * 1e6));
        // The place of a polytope is the middle of its vertices, which need not be round.
        if kind_b < 7 {
            prop_assert_eq!((here.distance, here.lower, here.upper), (there.distance, there.lower, there.upper));
            prop_assert_eq!((here.normal, here.overlap, here.iterations), (there.normal, there.overlap, there.iterations));
        }
        let moved = 4.0 * f64::EPSILON * 1e6 + 64.0 * f64::EPSILON * (d_a.length() + d_b.length() + place.length());
        if here.status == Status::Converged && elsewhere.status == Status::Converged {
            prop_assert!((here.distance - elsewhere.distance).abs() <= moved, "{:?} {:?}", here, elsewhere);
        }
    }

    /// Names of axes, and the order of vertices, change nothing beyond 64 ulps of the size.
    #[test]
    fn neither_axes_nor_the_order_of_vertices_matter(
        a in prop::collection::vec(vector(1.0), 4..20),
        b in prop::collection::vec(vector(1.0), 4..20),
        (place, velocity, start) in (vector(3.0), vector(2.0), 0_usize..20),
    ) {
        prop_assume!(velocity.length() > 0.1);
        let solve = |a: &[DVec3], b: &[DVec3], place: DVec3, velocity: DVec3| {
            let (a, b) = (Polytope::new(a.iter().copied()), Polytope::new(b.iter().map(|&p| p + place)));
            let (a, b) = (a.expect("finite"), b.expect("finite"));
            let motion = Motion { velocity_a: velocity, velocity_b: DVec3::ZERO };
            let hit = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite").outcome.hit();
            (distance(&a, &b, DistanceOptions::default()).distance, hit)
        };
        let plain = solve(&a, &b, place, velocity);
        let mixed = |points: &[DVec3]| {
            let mut points = points.to_vec();
            points.reverse();
            let middle = start % points.len();
            points.rotate_left(middle);
            points
        };
        let permuted = |points: &[DVec3]| points.iter().map(|p| p.yzx()).collect::<Vec<_>>();
        let other_order = solve(&mixed(&a), &mixed(&b), place, velocity);
        let other_axes = solve(&permuted(&a), &permuted(&b), place.yzx(), velocity.yzx());
        let tolerance = 64.0 * f64::EPSILON * (2.0 + place.length());
        for (what, other) in [("order", other_order), ("axes", other_axes)] {
            prop_assert!((plain.0 - other.0).abs() <= tolerance, "{}: {:?} {:?}", what, plain, other);
            if let (Some(x), Some(y)) = (plain.1, other.1) {
                let slope = x.normal.map_or(1.0, |n| n.dot(velocity.normalize()).abs()).max(1e-9);
                let off = (x.time - y.time).abs() * velocity.length() * slope;
                prop_assert!(off <= tolerance, "{}: {:?} {:?}", what, plain, other);
            }
        }
    }

    /// What was asked before changes nothing: the same question between others has the same answer, to the bit.
    #[test]
    fn history_does_not_matter(
        (kind, d, turn) in (0_usize..8, sizes(), rotation()),
        places in prop::collection::vec(vector(3.0), 2..6),
    ) {
        let a = shape(kind, d, turn, DVec3::ZERO, 1.0).expect("valid");
        let hull = Polytope::new((0..60).map(|i| {
            let t = f64::from(i);
            DVec3::new((1.3 * t).sin(), (2.7 * t).sin(), (4.1 * t).sin())
        })).expect("finite");
        let ask = |place: DVec3| distance(&a, &Posed::translated(&hull, place).expect("finite"), DistanceOptions::default());
        let fresh: Vec<_> = places.iter().map(|&p| ask(p)).collect();
        let again: Vec<_> = places.iter().rev().map(|&p| ask(p)).collect();
        prop_assert!(fresh.iter().eq(again.iter().rev()), "{:?} {:?}", fresh, again);
    }

    /// Swapping the bodies swaps the witnesses, and the start axis changes nothing, beyond rounding.
    #[test]
    fn neither_order_nor_start_matters(
        (kind_a, kind_b) in (0_usize..8, 0_usize..8),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in (rotation(), rotation()),
        (place, axis) in (vector(3.0), vector(1.0)),
    ) {
        let a = shape(kind_a, d_a, turn_a, DVec3::ZERO, 1.0).expect("valid");
        let b = shape(kind_b, d_b, turn_b, place, 1.0).expect("valid");
        let one = distance(&a, &b, DistanceOptions::default());
        let size = d_a.length() + d_b.length() + place.length();
        for other in [
            distance(&b, &a, DistanceOptions::default()),
            distance(&a, &b, DistanceOptions::new().with_axis(axis)),
        ] {
            // The brackets meet, and are as narrow as rounding, unless they say that they are not.
            prop_assert!(one.lower <= other.upper && other.lower <= one.upper, "{:?} {:?}", one, other);
            if one.status == Status::Converged && other.status == Status::Converged {
                prop_assert!((one.distance - other.distance).abs() <= 64.0 * f64::EPSILON * size, "{:?} {:?}", one, other);
            }
        }
        let meets = intersects(&a, &b, Default::default());
        prop_assert_eq!(meets.overlap, one.overlap);
    }

    /// Swapping the bodies changes no bit where nothing is known in closed form, not even where they touch and rounding decides; and
    /// all queries decide alike there, wherever they begin.
    #[test]
    fn order_changes_no_bit(
        (kind_a, kind_b) in (prop_oneof![Just(0_usize), 2_usize..8], prop_oneof![Just(0_usize), 2_usize..8]),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in prop_oneof![(rotation(), rotation()), Just((DQuat::IDENTITY, DQuat::IDENTITY))],
        (place, axis) in (prop_oneof![vector(3.0), Just(DVec3::X * 3.0)], vector(1.0)),
        ulps in -8_i32..8,
    ) {
        let a = shape(kind_a, d_a, turn_a, DVec3::ZERO, 1.0).expect("valid");
        let beside = |place| shape(kind_b, d_b, turn_b, place, 1.0).expect("valid");
        let apart = distance(&a, &beside(place), DistanceOptions::default());
        let touching = apart.normal.map(|n| place + n * (apart.distance + f64::from(ulps) * f64::EPSILON));
        for place in [place].into_iter().chain(touching) {
            let b = beside(place);
            let one = distance(&a, &b, DistanceOptions::default());
            let other = distance(&b, &a, DistanceOptions::default());
            let swapped = Distance {
                point_a: other.point_b,
                point_b: other.point_a,
                normal: other.normal.map(|n| -n),
                ..other
            };
            prop_assert_eq!(one, swapped);
            if one.status != Status::Converged {
                continue;
            }
            let warm = distance(&a, &b, DistanceOptions::new().with_axis(axis));
            if warm.status == Status::Converged {
                prop_assert_eq!(one.overlap, warm.overlap);
            }
            let meet = intersects(&a, &b, Default::default()).decided();
            prop_assert!(meet.is_none_or(|meet| meet == one.overlap), "{:?} {:?}", one, meet);
        }
    }

    /// The answer of a ray cast is that of the same ray elsewhere: started farther back, and with another length.
    #[test]
    fn the_ray_is_its_points(
        (kind, d, turn) in (0_usize..8, sizes(), rotation()),
        (aim, from) in (vector(1.0), vector(1.0)),
        (back, stretch) in (0_i32..12, -20_i32..20),
    ) {
        prop_assume!(from.length() > 0.1);
        let target = shape(kind, d, turn, DVec3::ZERO, 1.0).expect("valid");
        let from = from.normalize() * 8.0;
        let (stretch, back) = (2.0_f64.powi(stretch), 2.0_f64.powi(back));
        let direction = aim - from;
        let near = Ray { source: from, direction };
        let far = Ray { source: from - direction * back, direction: direction * stretch };
        let near = ray_cast(&target, near, RayCastOptions::default()).expect("finite");
        let far = ray_cast(&target, far, RayCastOptions::default()).expect("finite");
        if let (Some(x), Some(y)) = (near.outcome.hit(), far.outcome.hit()) {
            let slope = x.normal.map_or(1.0, |n| -n.dot(direction.normalize())).max(1e-9);
            let tolerance = ulps::<DVec3>(256.0) * (back + 2.0) / slope;
            prop_assert!((x.lambda - (y.lambda * stretch - back)).abs() <= tolerance, "{:?} {:?}", near, far);
        }
    }

    /// Double and single precision answer the same question, to single precision.
    #[test]
    fn precisions_agree(h in sizes(), aim in vector(0.9), from in vector(1.0)) {
        prop_assume!(from.length() > 0.1);
        let (h, from) = (h.as_vec3a(), (from.normalize() * 4.0).as_vec3a());
        let direction = aim.as_vec3a() - from;
        let single = ray_cast(&Cuboid::<Vec3A>::new(h).expect("positive"), Ray { source: from, direction }, Default::default());
        let ray = Ray { source: from.as_dvec3(), direction: direction.as_dvec3() };
        let double = ray_cast(&Cuboid::new(h.as_dvec3()).expect("positive"), ray, Default::default());
        let (single, double) = (single.expect("finite"), double.expect("finite"));
        if let (Some(x), Some(y)) = (single.outcome.hit(), double.outcome.hit()) {
            prop_assert!(f64::from(single.lower) <= y.lambda && y.lambda <= f64::from(single.upper), "{:?} {:?}", single, y);
            prop_assert!(x.normal.is_none_or(|n| (n.norm().as_f64() - 1.0).abs() < ulps::<Vec3A>(4.0)));
        }
    }
}
