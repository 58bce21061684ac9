//! Linear casts that went wrong elsewhere. Each test is named after its report, tells what goes wrong there, and runs
//! in both precisions where the coordinates allow it.

use crate::common::behind_pointers::linear_cast;
use crate::common::{at, cuboid, directions, off, quaternion, s, sweep, time, turned, ulps, v};
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec2, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Point, Posed, Scalar, Segment, SupportMap, Triangle, Vector, Vector3,
};
use gjk_raycast::{CastMethod, LinearCast, LinearCastOptions, Motion, Outcome, Status};

fn both(single: impl FnOnce(), double: impl FnOnce()) {
    single();
    double();
}

/// parry #429. A ball falls on a box of 5, 50, 500, 5000 m: the time of impact was short by an amount that grew with
/// the box, to half a metre, since the closest point of a long simplex lost its digits.
#[test]
fn s1_time_of_impact_does_not_depend_on_the_size_of_the_floor() {
    fn run<V: Vector3>() {
        for size in [5.0, 50.0, 500.0, 5000.0] {
            let ball = at(Ball::<V>::new(s::<V>(0.5166)).expect("positive"), [0.3, 10.0, -0.2]);
            let floor = cuboid::<V>([size, 1.0, size]);
            let hit = time(&ball, &floor, [0.0, -1.0, 0.0]).expect("it lands");
            assert!((hit - (9.0 - 0.5166)).abs() < ulps::<V>(4.0) * (size + 10.0), "{size}: {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `bevy_rapier` #119, godot #85314. The same over a grid of starting points: the heights differed by up to 6 cm.
#[test]
fn s2_s23_every_start_over_the_floor_lands_at_one_height() {
    fn run<V: Vector3>() {
        let floor = cuboid::<V>([500.0, 1.0, 500.0]);
        for i in 0..400 {
            let (x, z) = (f64::from(i % 20) * 0.01, f64::from(i / 20) * 0.01);
            let ball = at(Ball::<V>::new(s::<V>(1.0)).expect("positive"), [x, 3.0, z]);
            let hit = time(&ball, &floor, [0.0, -1.0, 0.0]).expect("it lands");
            assert!((hit - 1.0).abs() < ulps::<V>(2048.0), "({x}, {z}): {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// rapier.js #258. In the plane, a long thin bar and a ball that crosses it within one step: the ray hit, the ball
/// missed; later it hit, and stopped 1.4 % of its radius early.
#[test]
fn s3_a_ball_does_not_tunnel_through_a_thin_bar() {
    fn run<V: Vector>() {
        let bar = at(cuboid::<V>([244.5, 0.5, 0.0]), [884.5, 188.5, 0.0]);
        for radius in [0.1, 1.0, 20.0] {
            let ball = at(Ball::<V>::new(s::<V>(radius)).expect("positive"), [380.0, 241.0, 0.0]);
            // It meets the upper side, y = 189, if it is by then over the bar, else the upper left corner.
            let t = (241.0 - 189.0 - radius) / 104.0;
            let over = 380.0 + 624.0 * t >= 640.0;
            let hit = time(&ball, &bar, [624.0, -104.0, 0.0]).expect("it is in the way");
            if over {
                assert!((hit - t).abs() < ulps::<V>(1024.0), "{radius}: {hit}, {t}");
            } else {
                let at_corner = (380.0 + 624.0 * hit - 640.0).hypot(241.0 - 104.0 * hit - 189.0);
                assert!((at_corner - radius).abs() < ulps::<V>(1024.0) * 1000.0, "{radius}: {hit}, {at_corner}");
            }
        }
    }
    both(run::<Vec2>, run::<DVec2>);
}

/// parry #193. Along a wall, almost tangentially: normals were wrong and not of unit length.
#[test]
fn s6_grazing_normals_are_unit_and_those_of_the_face() {
    fn run<V: Vector3>() {
        let wall = cuboid::<V>([5.0, 2.5, 0.05]);
        let ball = at(Ball::<V>::new(s::<V>(0.25)).expect("positive"), [-4.0, 0.0, 0.305]);
        for slope in [1e-2, 5e-3, 2e-3] {
            let hit = sweep(&ball, &wall, [1.0, 0.0, -slope]).outcome.hit().expect("it comes down on the wall");
            assert!(off(hit.normal, [0.0, 0.0, 1.0]) < ulps::<V>(64.0), "{slope}: {hit:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// rapier #933. Is the normal local or of the world, and whose? It is the world's, out of `b` towards `a`.
#[test]
fn s7_the_normal_is_the_worlds_and_points_to_a() {
    fn run<V: Vector3>() {
        let (sin, cos) = 0.4_f64.sin_cos();
        let b = turned(cuboid::<V>([1.0, 1.0, 1.0]), quaternion::<V>([0.0, 0.0, sin, cos]), [0.0; 3]);
        let n = [0.8_f64.cos(), 0.8_f64.sin(), 0.0];
        let a = at(Ball::<V>::new(s::<V>(0.5)).expect("positive"), n.map(|c| 5.0 * c));
        let hit = sweep(&a, &b, n.map(|c| -c)).outcome.hit().expect("head-on");
        assert!(off(hit.normal, n) < ulps::<V>(16.0), "{hit:?}");
        assert!((hit.point - v::<V>(n)).norm().as_f64() < ulps::<V>(32.0), "{hit:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `Box2D`'s short edge. A thin plank and a point just beyond its short end: an absolute threshold on areas, cubic in
/// the length, dropped the end from the simplex.
#[test]
fn s9_the_short_end_of_a_thin_plank_is_there() {
    fn run<V: Vector>() {
        let plank = cuboid::<V>([0.5, 0.0002, 0.0]);
        let start = at(Point::new(V::ZERO).expect("finite"), [0.506, 0.0035, 0.0]);
        // It crosses y = 0.0002 at t = 0.0066, where x = 0.505934 is beyond the end, and never comes nearer.
        let answer = sweep(&start, &plank, [-0.01, -0.5, 0.0]);
        assert!(answer.outcome.is_miss(), "{answer:?}");
        let inwards = sweep(&start, &plank, [-1.0, -0.55, 0.0]).outcome.hit().expect("it is in the way");
        assert!((inwards.time.as_f64() - 0.006).abs() < ulps::<V>(64.0), "{inwards:?}");
    }
    both(run::<Vec2>, run::<DVec2>);
}

/// `Box2D` #625, `Box3D` #32. Starting within the tolerance, but apart: a hit at 0 in every direction, or an empty
/// simplex. Receding and tangential starts miss, closing ones advance, however near.
#[test]
fn s10_s13_near_starts_are_not_contact() {
    fn run<V: Vector3>() {
        for gap in [1e-2, 1e-3, 1e-4] {
            let a = at(cuboid::<V>([1.0, 1.0, 1.0]), [0.0, 2.0 + gap, 0.0]);
            let b = cuboid::<V>([1.0, 1.0, 1.0]);
            assert!(sweep(&a, &b, [0.0, 1.0, 0.0]).outcome.is_miss(), "receding from {gap}");
            assert!(sweep(&a, &b, [1.0, 0.0, 0.3]).outcome.is_miss(), "sliding at {gap}");
            let hit = time(&a, &b, [0.0, -1.0, 0.0]).expect("closing");
            assert!((hit - gap).abs() < ulps::<V>(16.0), "{gap}: {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// box2c #26. A point has no radius to hide behind.
#[test]
fn s11_a_point_hits_a_box() {
    fn run<V: Vector>() {
        let point = at(Point::new(V::ZERO).expect("finite"), [3.0, 0.25, 0.0]);
        let hit = time(&point, &cuboid::<V>([1.0, 1.0, 0.0]), [-1.0, 0.0, 0.0]).expect("it is in the way");
        assert!((hit - 2.0).abs() < ulps::<V>(8.0), "{hit}");
    }
    both(run::<Vec2>, run::<DVec2>);
}

/// `Box2D` #115, #120, #50. Overlap at the start was reported at the end of the step. It is a hit at 0 without a
/// normal.
#[test]
fn s12_overlap_at_the_start_is_a_hit_at_zero() {
    fn run<V: Vector>() {
        let large = at(cuboid::<V>([25.0, 5.0, 0.0]), [24.0, -60.0, 0.0]);
        let small = at(cuboid::<V>([2.5, 2.5, 0.0]), [40.0, -56.0, 0.0]);
        for velocity in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-3.0, 2.0, 0.0], [0.0; 3]] {
            let hit = sweep(&small, &large, velocity).outcome.hit().expect("they overlap");
            assert_eq!((hit.time.as_f64(), hit.normal), (0.0, None), "{velocity:?}");
        }
    }
    both(run::<Vec2>, run::<DVec2>);
}

/// Jolt #2103. A capsule of 9 m and a cylinder of half a metre, 5 micrometres apart by the coordinates: a rejected
/// support point stayed in the simplex, and 7.25 m of penetration came out.
#[test]
fn s14_nearly_touching_capsule_and_cylinder_stay_near_contact() {
    fn run<V: Vector3>() {
        let capsule = Capsule::<V>::new(s::<V>(2.031_143_43), s::<V>(7.197_321_89)).expect("positive");
        let cylinder = Cylinder::<V>::new(s::<V>(0.3), s::<V>(0.4975)).expect("positive");
        let cylinder = at(cylinder, [-0.951_660_156, -2.091_552_73, -7.635_742_18]);
        let apart = crate::common::apart(&cylinder, &capsule);
        assert!(apart.distance.as_f64() < 1e-3, "{apart:?}");
        let answer = sweep(&cylinder, &capsule, [0.002_441_406_25, -0.006_835_937_5, 0.002_929_687_5]);
        assert_eq!(answer.status, Status::Converged, "{answer:?}");
        if let Some(hit) = answer.outcome.hit() {
            assert!(hit.point.norm().as_f64() < 9.3, "{hit:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Jolt #217, #1734. The normal of a search that ends in its first iteration was zero, or an axis from halfway.
#[test]
fn s16_s18_normals_are_unit_even_when_found_at_once() {
    fn run<V: Vector3>() {
        let cylinder = at(Cylinder::<V>::new(s::<V>(1.2), s::<V>(0.75)).expect("positive"), [0.1, 5.0, 0.2]);
        let floor = cuboid::<V>([3.0, 0.5, 4.0]);
        let hit = sweep(&cylinder, &floor, [0.0, -1.0, 0.0]).outcome.hit().expect("it lands");
        assert!(off(hit.normal, [0.0, 1.0, 0.0]) < ulps::<V>(64.0), "{hit:?}");
        assert!((hit.time.as_f64() - 3.3).abs() < ulps::<V>(64.0), "{hit:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `PhysX` #610. Two cubes, one above the other: 2.9975 instead of 3.
#[test]
fn s19_cubes_fall_exactly_as_far_as_they_can() {
    fn run<V: Vector3>() {
        let (lower, upper) = (at(cuboid::<V>([1.0; 3]), [0.0, 10.0, 0.0]), at(cuboid::<V>([1.0; 3]), [0.0, 15.0, 0.0]));
        let hit = time(&upper, &lower, [0.0, -1.0, 0.0]).expect("it lands");
        assert!((hit - 3.0).abs() < ulps::<V>(8.0), "{hit}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Bullet #596. The same cast gave another answer depending on what had been asked before. There is no state: fresh
/// shapes and used ones, the same bits.
#[test]
fn s22_the_same_question_has_the_same_answer() {
    fn scene<V: Vector3>() -> LinearCast<V> {
        let rotation = quaternion::<V>([-0.057_141, 0.572_179, 0.040_011, 0.817_157]);
        let slab: Posed<Cuboid<V>> = turned(cuboid([19.92, 0.92, 49.92]), rotation, [0.0, 0.0, 120.0]);
        let ball = Ball::new(s::<V>(0.45)).expect("positive");
        let ball = at(ball, [-27.449_842, -2.994_38, 109.886_52]);
        sweep(&ball, &slab, [-0.079_466, -0.610_439, -0.333_244])
    }
    fn run<V: Vector3>() {
        let first = scene::<V>();
        assert_eq!(first.status, Status::Converged);
        for d in directions(20) {
            let _ = sweep(&cuboid::<V>([1.0; 3]), &at(cuboid::<V>([1.0; 3]), d.map(|c| 4.0 * c)), d);
            assert_eq!(scene::<V>(), first);
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// parry #317. Hits far from the origin were lost. What both shapes share of their position does not matter.
#[test]
fn s25_far_from_the_origin_is_like_near_it() {
    fn run<V: Vector3>(reach: f64) {
        let far = [reach, -reach, reach];
        let a = at(cuboid::<V>([1.0, 2.0, 0.5]), [far[0] + 8.0, far[1], far[2]]);
        let b = at(cuboid::<V>([1.0; 3]), far);
        let hit = time(&a, &b, [-2.0, 0.25, 0.0]).expect("it is in the way");
        assert!((hit - 3.0).abs() < ulps::<V>(16.0), "{hit}");
    }
    both(|| run::<Vec3A>(65_536.0), || run::<DVec3>(1e9));
}

/// Jolt #1786 and #1787. A cast that starts touching, or within, was no hit at all where the deepest point was asked
/// for. It is a hit at 0 in every direction at a point in both, and the distance of the same pair is an overlap with a
/// point in both.
#[test]
fn s15_a_start_in_contact_is_a_hit_in_every_direction() {
    fn run<V: Vector3>() {
        let floor = cuboid::<V>([4.0, 1.0, 4.0]);
        for depth in [0.0, ulps::<V>(1.0), 1e-3, 0.5] {
            let ball = at(Ball::<V>::new(s::<V>(0.5)).expect("positive"), [0.25, 1.5 - depth, -0.5]);
            let in_both = |point: V| {
                assert!(point.get(1).as_f64() <= 1.0 + ulps::<V>(16.0), "in the floor: {depth} {point:?}");
                let from_center = (point - v::<V>([0.25, 1.5 - depth, -0.5])).norm().as_f64();
                assert!(from_center <= 0.5 + ulps::<V>(16.0), "in the ball: {depth} {point:?}");
            };
            for d in directions(40).chain([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]) {
                let hit = sweep(&ball, &floor, d).outcome.hit().unwrap_or_else(|| panic!("in contact: {depth} {d:?}"));
                let touches = depth < 1e-3;
                assert_eq!((hit.time.as_f64(), hit.normal.is_some()), (0.0, touches), "{depth} {d:?}");
                in_both(hit.point);
            }
            let apart = crate::common::apart(&ball, &floor);
            assert!(apart.overlap && apart.distance.as_f64() == 0.0, "{depth}: {apart:?}");
            in_both(apart.point_a);
            in_both(apart.point_b);
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Jolt #534. The early out of a search by fraction dropped the hit at fraction 0: nothing is earlier than a start in
/// contact, however short the motion may be, even of no length.
#[test]
fn s17_no_end_is_too_early_for_a_start_in_contact() {
    fn run<V: Vector3>() {
        let (a, b) = (at(cuboid::<V>([1.0; 3]), [0.5, 1.5, 0.0]), cuboid::<V>([1.0; 3]));
        for end in [0.0, f64::MIN_POSITIVE, 1e-30, 1e-3, 1.0, f64::INFINITY] {
            for velocity in [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1e-20, 0.0, 0.0], [0.0; 3]] {
                let motion = Motion { velocity_a: v::<V>(velocity), velocity_b: V::ZERO };
                let options = LinearCastOptions::new().with_max_time(s::<V>(end));
                let hit = linear_cast(&a, &b, motion, options).expect("finite velocities").outcome.hit();
                assert_eq!(hit.map(|hit| hit.time.as_f64()), Some(0.0), "{end} {velocity:?}");
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `PhysX` #507. The contact was returned as the origin of the world, where the shapes were not. Far from it the
/// contact is on both shapes, for casts and for distances.
#[test]
fn s20_the_point_of_contact_is_on_the_shapes() {
    fn run<V: Vector3>() {
        let place = [40.0, -30.0, 20.0];
        let b = at(cuboid::<V>([1.0, 2.0, 3.0]), place);
        for d in directions(60) {
            let start = [0, 1, 2].map(|i| place[i] + 6.0 * d[i]);
            let a = at(Ball::<V>::new(s::<V>(0.5)).expect("positive"), start);
            let on_box = |p: V| {
                let off = [0, 1, 2].map(|i| (p.get(i).as_f64() - place[i]).abs() - [1.0, 2.0, 3.0][i]);
                off.into_iter().fold(f64::NEG_INFINITY, f64::max).abs()
            };
            let hit = sweep(&a, &b, d.map(|c| -c)).outcome.hit().expect("towards the middle");
            let center = v::<V>(start) - v::<V>(d) * hit.time;
            assert!(on_box(hit.point) < ulps::<V>(256.0), "{d:?}: {hit:?}");
            assert!(((hit.point - center).norm().as_f64() - 0.5).abs() < ulps::<V>(256.0), "{d:?}: {hit:?}");
            let apart = crate::common::apart(&a, &b);
            assert!(on_box(apart.point_b) < ulps::<V>(256.0), "{d:?}: {apart:?}");
            let radius = (apart.point_a - v::<V>(start)).norm().as_f64();
            assert!((radius - 0.5).abs() < ulps::<V>(256.0), "{d:?}: {apart:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `Box2D` #115. A long box turned by 2.95 and a square turned by 513 − 162π, which came in as 513: without taking
/// whole turns off, the loop over the sweep did not end; with them, it said touching where there is a gap. The angles
/// of both ends of the step, and the motion between them.
#[test]
fn s12_large_angles_are_angles() {
    fn run<V: Vector>(turn: impl Fn(f64) -> V::Rotation) {
        let long = turned(cuboid::<V>([25.0, 5.0, 0.0]), turn(2.95), [24.0, -60.0, 0.0]);
        let (start, end) = ([53.474_274, -50.252_514, 0.0], [54.595_478, -51.083_473, 0.0]);
        let velocity = [0, 1, 2].map(|i| end[i] - start[i]);
        for angle in [513.366_76, 513.627_81] {
            let less = angle - 162.0 * std::f64::consts::PI;
            let [whole, less] = [angle, less].map(|a| turned(cuboid::<V>([2.5, 2.5, 0.0]), turn(a), start));
            let [x, y] = [&whole, &less].map(|square| sweep(square, &long, velocity));
            for answer in [&x, &y] {
                assert_eq!(answer.status, Status::Converged, "{angle}: {answer:?}");
                assert!(answer.iterations < 20, "{angle}: {answer:?}");
            }
            assert_eq!(x.outcome.is_miss(), y.outcome.is_miss(), "{angle}: {x:?} {y:?}");
            // The gap of the step's start is there in the distance as well.
            let [d, e] = [&whole, &less].map(|square| crate::common::apart(square, &long).distance.as_f64());
            assert!((d - e).abs() < ulps::<V>(513.0 * 64.0) * 60.0, "{angle}: {d} {e}");
            if let Some(hit) = y.outcome.hit() {
                assert!(d == 0.0 || hit.time.as_f64() > 0.0, "apart by {d}, but touching at once: {hit:?}");
            }
        }
    }
    both(|| run::<Vec2>(s::<Vec2>), || run::<DVec2>(|a| a));
}

/// Equal velocities, whatever they are, are no error: only the start counts.
#[test]
fn equal_velocities_hit_only_what_overlaps() {
    fn run<V: Vector3>() {
        let velocity = v::<V>([1.0, 2.0, 3.0]);
        let motion = Motion { velocity_a: velocity, velocity_b: velocity };
        let b = cuboid::<V>([1.0; 3]);
        for (x, overlap) in [(0.5, true), (1.9, true), (2.1, false), (50.0, false)] {
            let a = at(cuboid::<V>([1.0; 3]), [x, 0.0, 0.0]);
            let answer = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite velocities");
            match answer.outcome {
                Outcome::Hit(hit) => assert!(overlap && hit.time.as_f64() == 0.0, "{x}: {hit:?}"),
                Outcome::Miss(_) => assert!(!overlap, "{x}"),
                Outcome::Undecided => panic!("{x}: undecided"),
            }
        }
        assert_eq!(b.support(velocity), v([1.0; 3]), "the box is as it was");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Found by the sweep: a capsule passes a ball by within rounding, which may be a hit, at the place where they are
/// closest. The normal was that of the last plane on the way there, and the point of contact, found by it, was 0.3
/// sizes off one of them. The shortest vector from core to core is the normal, and the point between the cores is on
/// both. In twice the precision it is a miss, by 0.31, where the pose is right to 0.18.
#[test]
fn a_graze_has_the_normal_of_where_it_is() {
    let rotation = Quat::from_xyzw(-0.461_624_9, 0.242_144_24, 0.495_764_43, 0.694_612_3);
    let start = Vec3A::new(-4_699_745_792.0, -2_734_962_688.0, -8_393_059_328.0);
    let center = Vec3A::new(368_173.53, -665_707.9, -649_061.9);
    let capsule = Capsule::new(625_000.0, 375_000.0).expect("positive");
    let capsule = Posed::new(capsule, rotation, start).expect("a pose");
    let ball = Posed::translated(Ball::new(1e6).expect("positive"), center).expect("a place");
    let velocity_a = Vec3A::new(751_522.7, 437_034.44, 1_342_081.5);
    let motion = Motion { velocity_a, velocity_b: Vec3A::ZERO };
    let cast = linear_cast(&capsule, &ball, motion, LinearCastOptions::new()).expect("finite");
    assert!(cast.outcome.is_miss() && cast.is_certain(), "{cast:?}");
    let options = LinearCastOptions::new().with_method(CastMethod::Gjk);
    let cast = linear_cast(&capsule, &ball, motion, options).expect("finite");
    let hit = cast.outcome.hit().expect("as close as rounding");
    let normal = hit.normal.expect("they start apart").as_dvec3();
    assert!(normal.dot(velocity_a.as_dvec3().normalize()).abs() < 1e-5, "{hit:?}");
    let from_center = (hit.point - center).as_dvec3();
    assert!((from_center.length() - 1e6).abs() < 1.0, "{hit:?}");
    // On the capsule as well, to the rounding of where it comes from: an ulp of 8e9 is 512.
    let place = start.as_dvec3() + velocity_a.as_dvec3() * f64::from(hit.time);
    let seen = rotation.as_dquat().normalize().inverse() * (hit.point.as_dvec3() - place);
    let from_axis = (seen - DVec3::Y * seen.y.clamp(-625e3, 625e3)).length();
    assert!((from_axis - 375e3).abs() < 4.0 * 512.0, "{from_axis}");
}

/// Where a line leaves the side of a segment swept by a ball, which it nearly runs along, is the difference of two
/// numbers of 35,000. They were wrong by 2.7 together, and so a ball that starts 7e-7 apart was certain to be inside.
#[test]
fn a_ball_that_slides_along_a_segment_is_not_inside() {
    let ball = Posed::translated(Ball::new(0.282_319_2).expect("positive"), Vec2::new(-0.831_259_55, -0.614_417_3));
    let end = Vec2::new(0.001_399_388_4, 1.379_710_6);
    let segment = Segment::new([end, -end]).expect("finite");
    let segment = Posed::new(segment, -2.820_096_7, Vec2::new(-0.843_559_15, -1.473_547_9)).expect("finite");
    let motion = Motion { velocity_a: Vec2::new(-0.315_016_12, 0.949_086_3), velocity_b: Vec2::ZERO };
    let cast = linear_cast(&ball.expect("finite"), &segment, motion, LinearCastOptions::default()).expect("finite");
    // They come no nearer than 6.9e-7, which is within the rounding of their places.
    assert!(!cast.upper.is_finite(), "{cast:?}");
}

/// A vertex of one body passes exactly through one of a triangle, and the plane that was found last leans along the
/// motion: it is crossed 1e-7 of the size before and after, and the time of the hit was when it seems to be, with the
/// bodies 8e-10 apart. It is when the motion comes to the point that is known of the body; and since it may pass that
/// by rounding, the hit is not certain, and says so.
#[test]
fn a_vertex_on_a_vertex_is_hit_where_it_is() {
    let cases = [
        (
            [0.0, 0.5, 1.0],
            [
                [5.066_706_757_544_81e-17, 0.571_825_903_784_438_5, 0.999_999_999_999_999_9],
                [-2.200_893_605_408_073e-18, 0.571_825_903_784_438_4, 9.287_430_935_408_92e-17],
                [1.0, 0.571_825_903_784_438_4, 1.0],
            ],
            [1.336_827_093_265_62e-17, -0.294_199_500_000_000_1, -1.547_464_643_496_146_8e-17],
            0.244_140_128_669_282,
        ),
        (
            [1.0, 0.5, 1.0],
            [
                [5.484_489_308_591_657e-17, 0.502_873_036_151_379_6, 0.999_999_999_999_999_9],
                [-9.104_444_820_186_398e-18, 0.502_873_036_151_379_5, 8.236_723_789_727_633e-17],
                [1.0, 0.502_873_036_151_379_6, 1.0],
            ],
            [1.674_597_369_509_272_2e-17, -0.225_246_632_366_941_34, -3.211_266_926_218_893_3e-17],
            0.012_755_068_172_114_6,
        ),
    ];
    for (vertex, corners, velocity, time) in cases {
        let point = Point::new(v::<DVec3>(vertex)).expect("finite");
        let triangle = Triangle::new(corners.map(v::<DVec3>)).expect("finite");
        let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: v(velocity) };
        let cast = linear_cast(&point, &triangle, motion, LinearCastOptions::new().with_max_time(1.0)).expect("finite");
        assert_eq!(cast.status == Status::Converged, cast.is_certain(), "{cast:?}");
        if let Outcome::Hit(hit) = cast.outcome {
            assert!((hit.time - time).abs() <= 1e-13, "{cast:?}");
        }
    }
}

/// A depth that is asked for no further than zero was taken for more than that by a facet a rounding beyond zero, which
/// proves nothing: its normal, of a search that had hardly begun, counted as that of a touch. Of points deep in a
/// cylinder or a cone 1 of 60 had one.
#[test]
fn a_start_deep_inside_has_no_normal() {
    let cylinder = Cylinder::<DVec3>::new(0.9, 0.8).expect("valid");
    let cone = Cone::<DVec3>::new(0.9, 0.8).expect("valid");
    for i in 0..600_u32 {
        let [x, y, z] = [7, 31, 101].map(|k| f64::from(i * k % 113) / 113.0 - 0.5);
        let turn = DQuat::from_xyzw(0.3 + x, y, 0.5 - z, 0.7).normalize();
        let point = Point::new(DVec3::new(0.3 * x, 0.4 * y - 0.1, 0.3 * z)).expect("valid");
        let bodies: [&dyn SupportMap<Vector = DVec3>; 2] = [&cylinder, &cone];
        for body in bodies {
            let (a, b) = (turned(&point, turn, [2.0, -1.0, 0.5]), turned(body, turn, [2.0, -1.0, 0.5]));
            let motion = Motion { velocity_a: DVec3::X, ..Motion::default() };
            let cast = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite");
            let hit = cast.outcome.hit().expect("it starts inside");
            assert_eq!((hit.time, hit.normal, cast.upper), (0.0, None, 0.0), "{i}: {cast:?}");
        }
    }
}
