//! Where answers are not smooth, and what their one-sided derivatives are there.

use crate::common::behind_pointers::{distance, linear_cast, motion_cast, ray_cast, signed_distance};
use crate::differences::{Body, Random, Space, apart, one_sided};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3};
use convex_support::{Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Polytope, Posed, Rounded, SupportMap, Triangle};
use gjk_raycast::{
    DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, Ray, RigidMotion, SignedDistanceOptions, Smoothness,
};

const VALID: &str = "positive sizes and finite numbers";

type Boxed = std::rc::Rc<dyn SupportMap<Vector = DVec3>>;

/// A body in the local frame of a contact, whose normal is y, and where it is put in the world.
fn placed(shape: Boxed, turn: DQuat, at: DVec3, world: (DQuat, DVec3)) -> Body<DVec3> {
    let local: crate::differences::Solid<DVec3> = Box::new(shape);
    let shape = Posed::new(std::rc::Rc::new(local), world.0 * turn, world.0 * at + world.1).expect(VALID);
    Body { shape }
}

/// Two bodies of which `a` is above `b` by a gap, negative for a depth, with parallel faces or edges; the kinds count
/// from 0.
fn parallel(kind: usize, gap: f64, random: &mut Random) -> [Body<DVec3>; 2] {
    let world = (DVec3::rotation(random), random.vector::<DVec3>(1.0));
    let spin = DQuat::from_rotation_y(random.number(0.0, 6.0));
    let size = |random: &mut Random| DVec3::from_array([0; 3].map(|_| random.number(0.6, 1.0)));
    let (sa, sb) = (size(random), size(random));
    let aside = DVec3::new(random.number(-0.3, 0.3), 0.0, random.number(-0.3, 0.3));
    let cuboid = |s: DVec3| -> Boxed { std::rc::Rc::new(Cuboid::new(s).expect(VALID)) };
    let lying = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let (a, turn_a, low): (Boxed, DQuat, f64) = match kind {
        // A face over a face.
        0 => (cuboid(sa), spin, sa.y),
        // A lying capsule, a lying cylinder, an edge, a standing cylinder over a face.
        1 => (std::rc::Rc::new(Capsule::new(sa.x, 0.25).expect(VALID)), spin * lying, 0.25),
        2 => (std::rc::Rc::new(Cylinder::new(sa.x, 0.25).expect(VALID)), spin * lying, 0.25),
        3 => {
            let lean = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_4);
            let s = DVec3::new(sa.x, sa.y, sa.y);
            (cuboid(s), spin * lean, sa.y * 2f64.sqrt())
        }
        4 => (std::rc::Rc::new(Cylinder::new(sa.y, 0.4).expect(VALID)), spin, sa.y),
        // A rounded triangle.
        _ => {
            let corners = [[0.5, 0.0, 0.0], [-0.4, 0.0, 0.3], [-0.3, 0.0, -0.5]].map(DVec3::from_array);
            let flat = Triangle::new(corners).expect(VALID);
            (std::rc::Rc::new(Rounded::new(flat, 0.2).expect(VALID)), spin, 0.2)
        }
    };
    let above = DVec3::Y * (sb.y + low + gap);
    [placed(a, turn_a, above + aside, world), placed(cuboid(sb), DQuat::IDENTITY, DVec3::ZERO, world)]
}

const PARALLEL_KINDS: usize = 6;

#[test]
fn parallel_faces_and_edges_are_no_smooth_place() {
    let mut random = Random(3);
    for round in 0..4000 {
        let kind = round % PARALLEL_KINDS;
        let gap = [0.3, 0.01, 1e-6, -0.1][round / PARALLEL_KINDS % 4];
        let [a, b] = parallel(kind, gap, &mut random);
        let answer = apart(&a.shape, &b.shape);
        assert!((answer.signed_distance - gap).abs() < 1e-12, "{kind}: {answer:?}");
        let features = answer.closest_features(&a.shape, &b.shape);
        assert_eq!(features.smoothness(), Smoothness::Edge, "{kind} at {gap}: {features:?}");
        assert!(features.is_normal_unique() && !features.are_points_unique(), "{kind} at {gap}: {features:?}");
        assert_eq!(features.velocities(random.motion(), random.motion()), None);
        if gap > 0.0 {
            let features =
                distance(&a.shape, &b.shape, DistanceOptions::default()).closest_features(&a.shape, &b.shape);
            assert_eq!(features.map(|f| f.smoothness()), Some(Smoothness::Edge), "{kind} at {gap}");
        }
    }
}

#[test]
fn faces_of_curved_bodies_are_no_smooth_place() {
    // Discs and the sides of cylinders over discs: an answer knows the distance to a rounding, and the normal of a
    // curved body to the root of that.
    let mut random = Random(12);
    let upright = |kind: usize, [h, r]: [f64; 2]| -> (Boxed, f64) {
        let shape: Boxed = match kind {
            0 => std::rc::Rc::new(Cylinder::new(h, r).expect(VALID)),
            _ => std::rc::Rc::new(Cone::new(h, r).expect(VALID)),
        };
        (shape, h)
    };
    for round in 0..3000 {
        let world = (DVec3::rotation(&mut random), random.vector::<DVec3>(1.0));
        let mut size = || [0; 2].map(|_| random.number(0.3, 1.0));
        let (mut a, mut low) = upright(round % 2, size());
        let (mut b, mut top) = upright(round / 2 % 2, size());
        let lies = round % 5 == 0;
        let mut turn = DQuat::IDENTITY;
        if lies {
            // The side of a cylinder.
            let [h, r] = size();
            (a, low) = (std::rc::Rc::new(Cylinder::new(h, r).expect(VALID)), r);
            turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        }
        if round % 3 == 0 {
            (a, low) = (std::rc::Rc::new(Rounded::new(a, 0.1).expect(VALID)), low + 0.1);
            (b, top) = (std::rc::Rc::new(Rounded::new(b, 0.1).expect(VALID)), top + 0.1);
        }
        let gap = if round % 4 == 0 { -random.number(0.001, 0.1) } else { 10f64.powf(random.number(-6.0, 0.0)) };
        let aside = DVec3::new(random.number(-0.25, 0.25), low + top + gap, random.number(-0.25, 0.25));
        let spin = DQuat::from_rotation_y(random.number(0.0, 6.0));
        let a = placed(a, spin * turn, aside, world);
        let b = placed(b, DQuat::from_rotation_x(std::f64::consts::PI), DVec3::ZERO, world);
        for tolerance in [1e-9, 1e-14] {
            let options = SignedDistanceOptions::default().with_tolerance(tolerance);
            let answer = signed_distance(&a.shape, &b.shape, options);
            assert!((answer.signed_distance - gap).abs() < 1e-8, "{round}: {answer:?}");
            let features = answer.closest_features(&a.shape, &b.shape);
            assert_eq!(features.smoothness(), Smoothness::Edge, "{round} at {gap}: {features:?}");
        }
    }
}

#[test]
fn a_lean_of_a_millionth_is_smooth() {
    let mut random = Random(4);
    for round in 0..4000 {
        let kind = round % PARALLEL_KINDS;
        let gap = [0.3, 0.01, 1e-4, -0.1][round / PARALLEL_KINDS % 4];
        // Deep within one another, a curved body and a face are told apart by a search that knows the normal to half
        // its digits.
        let angle = if gap < 0.0 { 1e-3 } else { 1e-6 };
        let [a, b] = parallel(kind, gap, &mut random);
        // About an axis that is not along an edge or a capsule.
        let axis = DVec3::new(random.signed(), random.signed(), random.signed()) + DVec3::splat(1.3);
        let lean = RigidMotion::rotation(axis * angle, a.shape.translation());
        let a = Body { shape: a.moved(&lean, 1.0) };
        let features = apart(&a.shape, &b.shape).closest_features(&a.shape, &b.shape);
        assert_eq!(features.smoothness(), Smoothness::Smooth, "{kind} at {gap}: {features:?}");
    }
}

#[test]
fn random_pairs_are_smooth() {
    let mut random = Random(5);
    let kinds = DVec3::KINDS;
    for round in 0..4000 {
        let (i, j) = (round % kinds.len(), round / kinds.len() % kinds.len());
        let a = Body::<DVec3>::random(kinds[i], &mut random);
        let b = Body::random(kinds[j], &mut random).placed(&a, round % 3 == 0, &mut random);
        let features = apart(&a.shape, &b.shape).closest_features(&a.shape, &b.shape);
        assert_eq!(features.smoothness(), Smoothness::Smooth, "{} and {}: {features:?}", kinds[i], kinds[j]);
    }
}

#[test]
fn one_sided_rates_are_those_of_differences() {
    let mut random = Random(6);
    let mut compared = 0;
    for round in 0..600 {
        let kind = round % PARALLEL_KINDS;
        let gap = [0.3, 0.01, -0.1][round / PARALLEL_KINDS % 3];
        let [a, b] = parallel(kind, gap, &mut random);
        let [ma, mb] = [random.motion::<DVec3>(), random.motion()];
        let features = apart(&a.shape, &b.shape).closest_features(&a.shape, &b.shape);
        let ours = features.rate(ma, mb).expect("the normal is the only one");
        let at = |t: f64| apart(&a.moved(&ma, t), &b.moved(&mb, t)).signed_distance;
        // Another kink may be near, so that only small steps are certain, and larger ones mostly right.
        let near = (at(1e-7) - at(0.0)) / 1e-7;
        assert!((ours - near).abs() < 1e-4, "{kind} at {gap}: {ours}, not {near}");
        let (theirs, _) = one_sided(at, 1e-3);
        compared += usize::from((ours - theirs).abs() < 1e-8);
        // And that is not what the other points say.
        let there = features.gradient().along(ma, mb);
        assert!(there >= ours - 1e-9, "{kind}: {there} is at another of the points, and no less than {ours}");
    }
    assert!(compared > 560, "{compared} of 600");
}

#[test]
fn faces_that_have_an_edge_or_a_corner_in_common_have_one_sided_rates() {
    let mut random = Random(11);
    for round in 0..400 {
        let world = (DVec3::rotation(&mut random), random.vector::<DVec3>(1.0));
        let cuboid = |s: DVec3| -> Boxed { std::rc::Rc::new(Cuboid::new(s).expect(VALID)) };
        let lying = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        // Beside one another, but for a gap above: seen from above they have an edge in common, a part of one, or a
        // corner.
        let sizes = [[0.5, 0.75, 1.0], [1.0, 0.5, 0.75]].map(DVec3::from_array);
        let along = [-0.25, 0.5, 1.75][round % 3];
        let (shape, turn, low): (Boxed, DQuat, f64) = match round / 3 % 3 {
            0 => (cuboid(sizes[0]), DQuat::IDENTITY, 0.75),
            1 => (std::rc::Rc::new(Rounded::new(cuboid(sizes[0]), 0.25).expect(VALID)), DQuat::IDENTITY, 1.0),
            // A capsule over the edge of a face, and along it.
            _ => (
                std::rc::Rc::new(Capsule::new(1.0, 0.25).expect(VALID)),
                DQuat::from_rotation_y(1.5 * along) * lying,
                0.25,
            ),
        };
        let aside = if round / 3 % 3 == 2 { 1.0 } else { 1.5 };
        let gap = [0.5, 1e-3][round % 2];
        let a = placed(shape, turn, DVec3::new(aside, 0.5 + low + gap, along), world);
        let b = placed(cuboid(sizes[1]), DQuat::IDENTITY, DVec3::ZERO, world);
        let [ma, mb] = [random.motion::<DVec3>(), random.motion()];
        let features = apart(&a.shape, &b.shape).closest_features(&a.shape, &b.shape);
        let ours = features.rate(ma, mb).expect("the normal is the only one");
        let at = |t: f64| apart(&a.moved(&ma, t), &b.moved(&mb, t)).signed_distance;
        // Without the second derivative, which is as large as the gap is small.
        let quotient = |t: f64| (at(t) - at(0.0)) / t;
        let near = 2.0 * quotient(1e-7) - quotient(2e-7);
        assert!((ours - near).abs() < 1e-5, "{round} at {gap}: {ours}, not {near}");
    }
}

#[test]
fn faces_that_touch_along_an_edge_have_no_one_normal() {
    // A box on the rim of another, nothing of it above the other: it may go up or aside.
    let cuboid = Cuboid::new(DVec3::ONE).expect(VALID);
    let beside = Posed::translated(cuboid, DVec3::new(2.0, 2.0, 0.5)).expect(VALID);
    let features = apart(&beside, &cuboid).closest_features(&beside, &cuboid);
    assert!(!features.is_normal_unique(), "{features:?}");
    assert_eq!(features.rate(RigidMotion::translation(DVec3::X), RigidMotion::default()), None);
    let above = Posed::translated(cuboid, DVec3::new(1.75, 2.0, 0.5)).expect(VALID);
    let features = apart(&above, &cuboid).closest_features(&above, &cuboid);
    assert!(features.is_normal_unique(), "{features:?}");
    assert_eq!(features.rate(RigidMotion::translation(DVec3::Y), RigidMotion::default()), Some(1.0));
}

#[test]
fn a_face_of_many_corners_says_that_it_is_known_in_part() {
    let prism = |sides: u32| {
        let corner =
            |i: u32| DQuat::from_rotation_y(f64::from(i) / f64::from(sides) * std::f64::consts::TAU) * DVec3::X;
        let corners = (0..sides).flat_map(|i| [corner(i), corner(i) + DVec3::Y]);
        Polytope::new(corners.collect::<Vec<_>>()).expect(VALID)
    };
    let floor = Posed::translated(Cuboid::new(DVec3::splat(3.0)).expect(VALID), DVec3::NEG_Y * 4.0).expect(VALID);
    for (sides, is_complete) in [(16, true), (17, false)] {
        let column = prism(sides);
        let features = apart(&column, &floor).closest_features(&column, &floor);
        assert_eq!((features.are_complete(), features.smoothness()), (is_complete, Smoothness::Edge), "{features:?}");
    }
}

#[test]
fn vertices_that_meet_have_no_one_normal() {
    let cuboid = Cuboid::new(DVec3::ONE).expect(VALID);
    let a = Posed::translated(cuboid, DVec3::new(4.0, 4.0, 4.0)).expect(VALID);
    let motion = Motion { velocity_a: -DVec3::ONE, velocity_b: DVec3::ZERO };
    let cast = linear_cast(&a, &cuboid, motion, LinearCastOptions::default()).expect("finite");
    let hit = cast.outcome.hit().expect("corner on corner");
    let [motion_a, motion_b] = motion.translations();
    let features = hit.closest_features(&a, &motion_a, &cuboid, &motion_b).expect("it hits");
    assert!(!features.is_normal_unique() && features.are_points_unique(), "{features:?}");
    assert_eq!(features.smoothness(), Smoothness::Edge);
    assert_eq!(features.rate(RigidMotion::translation(DVec3::X), RigidMotion::default()), None);

    // At a distance they are smooth.
    let features = apart(&a, &cuboid).closest_features(&a, &cuboid);
    assert_eq!(features.smoothness(), Smoothness::Smooth);
    // Rounded, they are smooth where they touch as well.
    let (a, b) = (Rounded::new(a, 0.1).expect(VALID), Rounded::new(cuboid, 0.1).expect(VALID));
    let cast = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite");
    let hit = cast.outcome.hit().expect("corner on corner");
    let features = hit.closest_features(&a, &motion_a, &b, &motion_b).expect("it hits");
    assert_eq!(features.smoothness(), Smoothness::Smooth, "{features:?}");
}

#[test]
fn equal_ways_out_are_an_edge() {
    // A small box within a large one: as near to two of its faces, or to one of them by a millionth.
    let large = Cuboid::new(DVec3::splat(2.0)).expect(VALID);
    let small =
        Polytope::new([[0.3, 0.1, 0.0], [-0.3, 0.2, 0.1], [0.0, -0.3, 0.2], [0.1, 0.1, -0.3]].map(DVec3::from_array))
            .expect(VALID);
    let mut random = Random(9);
    for round in 0..200 {
        let world = (DVec3::rotation(&mut random), random.vector::<DVec3>(1.0));
        let lead = if round % 2 == 0 { 0.0 } else { 1e-7 };
        // It reaches back by 0.3 along x and along y.
        let at = DVec3::new(1.0 + lead, 1.0, random.number(-0.5, 0.5));
        let a = Posed::new(&small, world.0, world.0 * at + world.1).expect(VALID);
        let b = Posed::new(large, world.0, world.1).expect(VALID);
        let features = apart(&a, &b).closest_features(&a, &b);
        let expected = if lead == 0.0 { Smoothness::Edge } else { Smoothness::Smooth };
        assert_eq!(features.smoothness(), expected, "{lead}: {features:?}");
    }
    // Concentric balls of cores that are points are known by their distance alone, and have no normal.
    let (a, b) = (Ball::<DVec2>::new(1.0).expect(VALID), Ball::new(2.0).expect(VALID));
    assert_eq!(apart(&a, &b).closest_features(&a, &b).smoothness(), Smoothness::Edge);
}

#[test]
fn times_of_faces_that_meet_have_one_sided_rates() {
    // A box falls flat onto a floor. Turned a little either way, a corner lands sooner.
    let floor = Cuboid::new(DVec2::new(9.0, 1.0)).expect(VALID);
    let parcel = |turn: f64| {
        Posed::new(Cuboid::new(DVec2::new(0.5, 0.5)).expect(VALID), turn, DVec2::new(0.0, 4.0)).expect(VALID)
    };
    let fall = Motion { velocity_a: DVec2::new(0.0, -2.0), velocity_b: DVec2::ZERO };
    let land = |turn: f64| {
        let cast = linear_cast(&parcel(turn), &floor, fall, LinearCastOptions::default()).expect("finite");
        cast.outcome.hit().expect("it lands")
    };
    let hit = land(0.0);
    let flat = parcel(0.0);
    let [falls, stays] = &fall.translations();
    assert_eq!(hit.closest_features(&flat, falls, &floor, stays).map(|f| f.smoothness()), Some(Smoothness::Edge));
    for sign in [1.0, -1.0] {
        let turning = RigidMotion::rotation(sign, DVec2::new(0.0, 4.0));
        let rate = hit.rate((&flat, falls, turning), (&floor, stays, RigidMotion::default())).expect("one normal");
        assert!((rate + 0.25).abs() < 1e-14, "{rate}: half a metre of lever, at 2 m/s");
        let (theirs, _) = one_sided(|t| land(sign * t).time, 1e-3);
        assert!((rate - theirs).abs() < 1e-9, "{rate}, not {theirs}");
        // The same of a motion that turns, so that it lands on its face.
        let quarter = std::f64::consts::FRAC_PI_2;
        let spin =
            RigidMotion { velocity: DVec2::new(0.0, -2.0), angular_velocity: quarter, center: DVec2::new(0.0, 4.0) };
        let options = MotionCastOptions::new().with_max_time(3.0);
        let start = parcel(-quarter * 1.25);
        let cast = motion_cast(&start, spin, &floor, RigidMotion::default(), options).expect("finite");
        let hit = cast.outcome.hit().expect("it lands");
        if hit.closest_features(&start, &spin, &floor, &RigidMotion::default()).map(|f| f.smoothness())
            == Some(Smoothness::Edge)
        {
            let rate = hit.rate((&start, &spin, turning), (&floor, &RigidMotion::default(), RigidMotion::default()));
            assert!(rate.is_some());
        }
    }
}

#[test]
fn within_one_another_a_distance_stays_zero() {
    let (a, b) = (Ball::<DVec3>::new(1.0).expect(VALID), Cuboid::new(DVec3::ONE).expect(VALID));
    let answer = distance(&a, &b, DistanceOptions::default());
    assert!(answer.closest_features(&a, &b).is_none());
    let gradient = answer.gradient();
    assert_eq!((gradient.a.translation, gradient.b.translation, gradient.radius), (DVec3::ZERO, DVec3::ZERO, 0.0));
    assert_eq!(gradient.along(RigidMotion::translation(DVec3::X), RigidMotion::default()), 0.0);
}

/// The side of a cone turns with the normal, so that a normal across it and across an edge parallel to it is found to
/// the root of rounding: the two were taken for lines that cross.
#[test]
fn an_edge_along_the_side_of_a_cone_is_no_smooth_place() {
    for (size, turn) in [(1.0, 0.0), (1e6, 0.0), (1e-6, 0.0), (1.0, 0.7), (1e6, 2.1), (1.0, -1.2)] {
        // The apex is at (0, −1, 0). An edge of the tetrahedron goes the way of the slant from there to (1, 1, 0).
        let upside_down = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
        let cone = Posed::from_matrix(Cone::new(size, size).expect(VALID), upside_down, DVec3::ZERO).expect(VALID);
        let corners = [[1.0, 0.25, 0.0], [1.0, 0.75, 0.0], [1.0, 0.25, -1.0], [0.75, 0.25, 0.0]];
        let spin = DQuat::from_rotation_y(turn);
        let corners = corners.map(|corner| spin * DVec3::from_array(corner) * size);
        let a = Polytope::new(corners).expect(VALID);
        for tolerance in [1e-9, 1e-14] {
            let answer = signed_distance(&a, &cone, SignedDistanceOptions::default().with_tolerance(tolerance));
            let features = answer.closest_features(&a, &cone);
            assert_eq!(features.smoothness(), Smoothness::Edge, "{size:e}, {turn}: {features:?}");
            assert!(features.is_normal_unique(), "{size:e}, {turn}: {features:?}");
        }
    }
}

/// Rims that are nearly flat where they are the way out: as they are pushed on, the other way gains more than the
/// square of the push.
#[test]
fn equal_ways_out_of_flat_curves_are_an_edge() {
    let skewed = DMat3::from_cols_array_2d(&[[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.25, 0.0, 2.0]]);
    let b = Affine::new(Cylinder::new(0.25, 0.25).expect(VALID), skewed, DVec3::ZERO).expect(VALID);
    let lean = DMat3::from_rotation_x(std::f64::consts::FRAC_PI_4);
    let a = Posed::from_matrix(Cylinder::new(1.0, 0.5).expect(VALID), lean, DVec3::Z * 0.5).expect(VALID);
    let features = apart(&a, &b).closest_features(&a, &b);
    assert_eq!(features.smoothness(), Smoothness::Edge, "{features:?}");
}

#[test]
fn a_distance_of_zero_is_at_its_floor() {
    // The distance is max(s, 0) of the signed distance s. Where bodies touch exactly, s is smooth, with the derivative
    // n by a translation of a; but the distance has that derivative on one side and zero on the other, and so has a
    // time or a λ that cannot be less than zero.
    let (ball, floor) = (Ball::<DVec3>::new(1.0).expect(VALID), Cuboid::new(DVec3::new(4.0, 1.0, 4.0)).expect(VALID));
    let above = |gap: f64| Posed::translated(ball, DVec3::new(0.5, 2.0 + gap, -0.25)).expect(VALID);
    let fall = Motion { velocity_a: DVec3::NEG_Y, velocity_b: DVec3::ZERO };
    let (rest, spin) = (
        RigidMotion::default(),
        RigidMotion { velocity: DVec3::NEG_Y, ..RigidMotion::rotation(DVec3::X, DVec3::Y * 2.0) },
    );
    for (gap, of_clamped) in [(0.0, Smoothness::Edge), (0.25, Smoothness::Smooth)] {
        let a = above(gap);
        let signed = apart(&a, &floor);
        assert_eq!(signed.closest_features(&a, &floor).smoothness(), Smoothness::Smooth, "{signed:?}");
        let answer = distance(&a, &floor, DistanceOptions::default());
        assert_eq!(answer.closest_features(&a, &floor).map(|f| f.smoothness()), Some(of_clamped), "{answer:?}");
        let hit =
            linear_cast(&a, &floor, fall, LinearCastOptions::default()).expect("finite").outcome.hit().expect("below");
        let [falls, stays] = &fall.translations();
        assert_eq!(hit.closest_features(&a, falls, &floor, stays).map(|f| f.smoothness()), Some(of_clamped), "{hit:?}");
        let options = MotionCastOptions::new().with_max_time(2.0);
        let hit = motion_cast(&a, spin, &floor, rest, options).expect("finite").outcome.hit().expect("below");
        let features = hit.closest_features(&a, &spin, &floor, &rest);
        assert!(features.is_none_or(|f| f.smoothness() == of_clamped), "{hit:?}");
        let ray = Ray { source: DVec3::new(0.5, 1.0 + gap, -0.25), direction: DVec3::NEG_Y };
        let hit = ray_cast(&floor, ray, Default::default()).expect("finite").outcome.hit().expect("below");
        let features = hit.closest_features(&floor, ray);
        assert!(features.is_none_or(|f| f.smoothness() == of_clamped), "{hit:?}");
    }
}

#[test]
fn second_derivatives_jump_above_a_border() {
    // Over a face the distance of a ball is a height, which is linear. Beyond the border of the face it is that from an
    // edge, whose second derivative by a step x aside is 1/r, with r the distance of the centre from the edge. Exactly
    // above the border the gradient is the same on both sides, and the answer smooth; but there are two Hessians.
    let cube = Cuboid::new(DVec3::ONE).expect(VALID);
    let along_x = |x: f64| {
        let ball = Posed::translated(Ball::new(0.5).expect(VALID), DVec3::new(x, 2.0, 0.25)).expect(VALID);
        let features = apart(&ball, &cube).closest_features(&ball, &cube);
        assert_eq!(features.smoothness(), Smoothness::Smooth, "{x}: {features:?}");
        let hessian = features.hessian(DVec3::ZERO, DVec3::ZERO).expect("a ball and a cube");
        let of_a = features.hessian_of_a(DVec3::ZERO).expect("a ball and a cube");
        let is_unique = features.is_hessian_unique();
        let said = [hessian.a.is_unique(), hessian.b.is_unique(), hessian.mixed.is_unique(), of_a.is_unique()];
        assert_eq!(said, [is_unique; 4]);
        (hessian.a.entry(0, 0), is_unique)
    };
    assert_eq!(along_x(0.9), (0.0, true));
    assert!(!along_x(1.0).1);
    let (beyond, is_unique) = along_x(1.0 + 1e-6);
    assert!(is_unique && (beyond - 1.0).abs() < 1e-6, "{beyond}");
    // The side of a capsule ends where its caps begin.
    let over_end = |y: f64| {
        let ball = Posed::translated(Ball::new(0.5).expect(VALID), DVec3::new(3.0, y, 0.0)).expect(VALID);
        let capsule = Capsule::new(1.0, 0.5).expect(VALID);
        apart(&ball, &capsule).closest_features(&ball, &capsule).is_hessian_unique()
    };
    assert_eq!([0.5, 1.0, 1.5].map(over_end), [true, false, true]);
}

#[test]
fn a_ball_made_flat_is_an_edge_or_a_face() {
    // A singular matrix makes a segment or a disc of a ball. Across it the support point jumps from end to end, which
    // no curvature tells: the whole image is what it shows in that direction.
    let flat = |sizes: [f64; 3], turn: DQuat| {
        let matrix =
            DMat3::from_quat(turn) * DMat3::from_diagonal(DVec3::from_array(sizes)) * DMat3::from_rotation_z(0.3);
        Affine::new(Ball::<DVec3>::new(0.5).expect(VALID), matrix, DVec3::new(0.25, 3.0, 0.0)).expect(VALID)
    };
    let cube = Cuboid::new(DVec3::ONE).expect(VALID);
    let lean = DQuat::from_rotation_z(0.1);
    let turned = DQuat::from_rotation_y(0.7);
    for (sizes, turn, gap, expected) in [
        // A segment along x over a face, and one that leans.
        ([2.0, 0.0, 0.0], turned, 2.0, Smoothness::Edge),
        ([2.0, 0.0, 0.0], lean, 2.0 - 0.1_f64.sin(), Smoothness::Smooth),
        // A disc over a face.
        ([1.5, 0.0, 0.75], turned, 2.0, Smoothness::Edge),
        ([1.5, 0.0, 0.75], lean, 2.0 - 0.75 * 0.1_f64.sin(), Smoothness::Smooth),
    ] {
        let a = flat(sizes, turn);
        let answer = apart(&a, &cube);
        assert!((answer.signed_distance - gap).abs() < 1e-9, "{answer:?}");
        let features = answer.closest_features(&a, &cube);
        assert_eq!(features.smoothness(), expected, "{sizes:?}: {features:?}");
    }
    // A segment parallel to an edge that is below and aside.
    let a = flat([2.0, 0.0, 0.0], DQuat::IDENTITY);
    let beside = Posed::translated(cube, DVec3::new(0.0, 0.0, 2.0)).expect(VALID);
    let features = apart(&a, &beside).closest_features(&a, &beside);
    assert_eq!(features.smoothness(), Smoothness::Edge, "{features:?}");
    // As it begins to turn, one of the ends comes nearer: at the speed of its arm.
    let turning = RigidMotion::rotation(DVec3::Z, DVec3::new(0.25, 3.0, 0.0));
    let over = apart(&a, &cube).closest_features(&a, &cube);
    let rate = over.rate(turning, RigidMotion::default()).expect("one normal");
    assert!((rate + 1.0).abs() < 1e-12, "{rate}");
}
