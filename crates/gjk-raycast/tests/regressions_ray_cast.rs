//! Ray casts that went wrong elsewhere. Each test is named after its report, tells what goes wrong there, and runs in
//! both precisions.

use crate::common::{at, cast, cuboid, directions, lambda, off, quaternion, s, turned, ulps, v};
use convex_support::glam::{DMat3, DQuat, DVec3, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Hull, MinkowskiSum, Point, Polytope, Posed, Rounded,
    Scalar, Segment, SupportMap, Vector3, closest_point,
};
use gjk_raycast::{
    CastMethod, DistanceOptions, HalfSpace, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, Scene, Status,
    SubAlgorithm, distance, iterative_ray_cast, linear_cast, ray_cast, ray_exit,
};

/// Runs a test in both precisions.
fn both(single: impl FnOnce(), double: impl FnOnce()) {
    single();
    double();
}

/// Bullet #1947. A wall 1000 wide, its front at z = 50, and nearly perpendicular rays: the loop stops on an absolute
/// squared distance while the simplex still spans the whole wall, and the hit sinks in by 0.8 % at one side.
#[test]
fn r1_wall_hit_is_flat_across_its_width() {
    fn run<V: Vector3>() {
        let wall = at(cuboid::<V>([500.0, 100.0, 0.5]), [0.0, 0.0, 49.5]);
        for i in -49..=49 {
            let x = f64::from(i) * 10.0;
            let hit = lambda(&wall, [x, 1.0, 150.0], [0.0, -0.01, -1.0]).expect("the wall is hit");
            assert!((hit - 100.0).abs() < ulps::<V>(4096.0), "x = {x}: {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Bullet #34, drake #1712. A lidar in front of a box: near the perpendicular the loop ended after eight iterations,
/// 9 mm before the wall, since 8.32e-5 m² was below 1e-4.
#[test]
fn r2_lidar_ranges_are_right_near_the_perpendicular() {
    fn run<V: Vector3>() {
        let wall = at(cuboid::<V>([1.0, 20.0, 20.0]), [11.0, 0.0, 0.0]);
        for i in -200..=200 {
            let angle = f64::from(i) * 1e-3;
            let range = lambda(&wall, [0.0; 3], [angle.cos(), angle.sin(), 0.0]).expect("the wall is hit");
            assert!((range - 10.0 / angle.cos()).abs() < ulps::<V>(512.0), "{angle}: {range}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Bullet #93. A flat simplex falls between the cases of a Voronoi region test. Hulls of collinear and coplanar points
/// have nothing but flat simplices.
#[test]
fn r4_flat_hulls_are_hit_where_they_are() {
    fn run<V: Vector3>() {
        let grid = (0..25).map(|i| v::<V>([f64::from(i % 5) - 2.0, f64::from(i / 5) - 2.0, 0.0]));
        let plate = Polytope::new(grid).expect("finite points");
        for d in directions(60).filter(|d| d[2].abs() > 0.1) {
            let source = [0.3 - 3.0 * d[0], 0.1 - 3.0 * d[1], -3.0 * d[2]];
            let hit = lambda(&plate, source, d).expect("the plate is hit");
            assert!((hit - 3.0).abs() < ulps::<V>(256.0), "{d:?}: {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Bullet #344. The normal of a turned child was left in the child's frame.
#[test]
fn r5_normal_turns_with_the_shape() {
    fn run<V: Vector3>() {
        let (sin, cos) = 0.25_f64.sin_cos();
        let tilted = turned(cuboid::<V>([1.0, 1.0, 1.0]), quaternion::<V>([0.0, 0.0, sin, cos]), [5.0, 0.0, 0.0]);
        let hit = cast(&tilted, [0.0; 3], [1.0, 0.0, 0.0]).outcome.hit().expect("it is in the way");
        assert!(off(hit.normal, [-0.5_f64.cos(), -0.5_f64.sin(), 0.0]) < ulps::<V>(8.0), "{hit:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `PhysX` #429. A flat cone far from the origin: the hit position was that of an earlier simplex, and did not lie at
/// the hit distance along the ray.
#[test]
fn r6_hit_point_is_at_the_hit_parameter() {
    fn run<V: Vector3>() {
        let rotation = quaternion::<V>([-0.664_463_043, 0.664_463_043, 0.241_844_788, 0.241_844_788]);
        let cone = Cone::<V>::new(s::<V>(250.0), s::<V>(495.0)).expect("positive");
        let cone = turned(cone, rotation, [11_800.0, 166.703_125, 1_934.414_43]);
        let (source, direction) = ([11_835.0, 4.709_930_42, 1_705.919_43], [0.0, 0.0, 1.0]);
        let answer = cast(&cone, source, direction);
        assert_eq!(answer.status, Status::Converged);
        let hit = answer.outcome.hit().expect("the cone is in the way");
        let along = v::<V>(source) + v::<V>(direction) * hit.lambda;
        assert!((hit.point - along).norm().as_f64() < 1e-3, "{hit:?}");
        assert!(hit.lambda.as_f64() <= 778.38, "{hit:?}");
        // Where closest points in closed form find it, to rounding of the coordinates.
        let ray = Ray { source: v::<V>(source), direction: v(direction) };
        let oracle = iterative_ray_cast(|x| closest_point(&cone, x), ray, RayCastOptions::default());
        let expected = oracle.expect("a finite ray").outcome.hit().expect("so it is for Algorithm 1");
        assert!((hit.lambda - expected.lambda).as_f64().abs() < ulps::<V>(8.0) * 12e3, "{hit:?}, {expected:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// edyn #155. A ray along an axis through the centre is parallel to four faces of the cube; the simplex is seen
/// edge-on, and the hit was lost.
#[test]
fn r7_axis_rays_hit_the_cube() {
    fn run<V: Vector3>() {
        let corners = (0..8).map(|i| v::<V>([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 })));
        let cube = Polytope::new(corners).expect("finite points");
        for axis in 0..3 {
            let mut source = [0.0; 3];
            source[axis] = 2.0;
            let hit = lambda(&cube, source, source.map(|c| -2.0 * c)).expect("the cube is hit");
            assert!((hit - 0.25).abs() < ulps::<V>(16.0), "axis {axis}: {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// parry #183, godot-jolt #652 and #653. From within, some shapes answered an outward normal, others an inward one.
/// There is none: the ray starts in the shape.
#[test]
fn r9_r10_a_ray_from_within_is_a_hit_at_zero_without_a_normal() {
    fn within<S: SupportMap>(shape: &S) {
        for d in directions(12) {
            let answer = cast(shape, [0.05, 0.02, -0.03], d);
            let hit = answer.outcome.hit().expect("the source is in the shape");
            assert_eq!((hit.lambda.as_f64(), hit.normal, answer.status), (0.0, None, Status::Converged));
        }
    }
    fn run<V: Vector3>() {
        let (r, h) = (s::<V>(1.0), s::<V>(2.0));
        within(&cuboid::<V>([1.0, 1.0, 2.0]));
        within(&Ball::<V>::new(r).expect("positive"));
        within(&Capsule::<V>::new(h, r).expect("positive"));
        within(&Cylinder::<V>::new(h, r).expect("positive"));
        within(&Cone::<V>::new(h, r).expect("positive"));
        let tip = Point::new(v::<V>([0.0, 4.0, 0.0])).expect("finite");
        within(&Hull::new(Ball::new(r).expect("positive"), tip));
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Jolt #1554. Touched by the very end of the ray only: one overload asserted. The end belongs to the ray, two ulps
/// less do not reach.
#[test]
fn r11_the_end_of_the_ray_belongs_to_it() {
    fn run<V: Vector3>() {
        let target = at(cuboid::<V>([1.0, 1.0, 1.0]), [5.0, 0.25, 0.5]);
        let ray = Ray { source: V::ZERO, direction: v([1.0, 0.0, 0.0]) };
        for (ulp, reaches) in [(-2.0, false), (0.0, true), (2.0, true)] {
            let end = s::<V>(4.0 * (1.0 + ulps::<V>(ulp)));
            let answer = ray_cast(&target, ray, RayCastOptions::new().with_max_lambda(end)).expect("a finite ray");
            assert_eq!(answer.outcome.hit().is_some(), reaches, "{ulp} ulp: {answer:?}");
            assert_eq!(answer.outcome.is_miss(), !reaches, "{ulp} ulp: {answer:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// argos3 #169. Two casters of one library disagreed on a hull. Closest points in closed form (Algorithm 1), support
/// points (Algorithm 3), and the same box as a hull give one answer.
#[test]
fn r12_all_algorithms_agree() {
    fn run<V: Vector3>() {
        let h = v::<V>([1.0, 0.5, 0.25]);
        let solid = cuboid::<V>([1.0, 0.5, 0.25]);
        let corners = (0..8).map(|i| h * v::<V>([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 })));
        let hull = Polytope::new(corners).expect("finite points");
        let mut hits = 0;
        for d in directions(200) {
            let source = [0.6 - 3.0 * d[0], 0.3 - 3.0 * d[1], 0.1 - 3.0 * d[2]];
            let ray = Ray { source: v::<V>(source), direction: v(d) };
            let oracle = iterative_ray_cast(|x: V| Some(x.max(-h).min(h)), ray, RayCastOptions::default());
            let oracle = oracle.expect("a finite ray").outcome.hit().map(|hit| hit.lambda.as_f64());
            let answers = [oracle, lambda(&solid, source, d), lambda(&hull, source, d)];
            let expected = answers[0].expect("the ray runs through an inner point");
            for answer in answers {
                let error = (answer.expect("so do the others") - expected).abs();
                assert!(error < ulps::<V>(512.0), "{d:?}: {answers:?}");
            }
            hits += 1;
        }
        assert_eq!(hits, 200);
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// DART #3355. Sampling the ray at sixteen points steps over a thin hull.
#[test]
fn r13_a_thin_slab_is_not_stepped_over() {
    fn run<V: Vector3>() {
        let slab = cuboid::<V>([1.0, 1e-3, 1.0]);
        for d in directions(100) {
            let hit = lambda(&slab, d.map(|c| -7.3 * c), d.map(|c| 100.0 * c)).expect("through the centre");
            let enters = 0.073
                - 1e-2
                    * [1.0 / d[0].abs(), 1e-3 / d[1].abs(), 1.0 / d[2].abs()].into_iter().fold(f64::INFINITY, f64::min);
            assert!((hit - enters).abs() < ulps::<V>(64.0), "{d:?}: {hit}, {enters}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Jolt #1574. A ray almost along the separating plane: `v·r` is tiny and negative, and λ overflowed.
#[test]
fn r14_no_answer_is_infinite_or_nan() {
    fn run<V: Vector3>() {
        let target = cuboid::<V>([1.0, 1.0, 1.0]);
        for tilt in [0.0, 1e-45, 1e-38, 1e-30, 1e-20, 1e-12, 1e-7, 1e-3] {
            for height in [1.0, 1.0 + 1e-6, 1.5] {
                let answer = cast(&target, [-5.0, height, 0.3], [1.0, -tilt, 0.0]);
                assert!(!answer.outcome.is_undecided(), "{tilt} {height}: {answer:?}");
                if let Outcome::Hit(hit) = answer.outcome {
                    assert!(hit.point.is_finite() && hit.normal.is_some_and(V::is_finite), "{hit:?}");
                    assert!((4.0 - 1e-5..=6.0 + 1e-5).contains(&hit.lambda.as_f64()), "{hit:?}");
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Measured: parry in single precision, Jolt. A thousand false hits in 20,000 rays on boxes below 10 cm, and errors of
/// the size of the box, from tolerances in metres.
#[test]
fn r15_r16_small_shapes_are_hit_as_well_as_large_ones() {
    fn run<V: Vector3>() {
        let h = [0.9, 0.6, 0.3];
        let mut hits = 0;
        for exponent in [-20, -10, 0, 10, 20] {
            let size = 2.0_f64.powi(exponent);
            let target = cuboid::<V>(h.map(|c| c * size));
            for (i, d) in directions(100).enumerate() {
                let aim = [0.0, 0.4, -0.8].map(|c| c * (1.0 + 0.01 * i as f64));
                let source = [0, 1, 2].map(|k| (aim[k] - 3.0 * d[k]) * size);
                // Slabs, in double precision, of the numbers as the ray has them.
                let (p, r) = (v::<V>(source), v::<V>(d));
                let [(a0, b0), (a1, b1), (a2, b2)] = [0, 1, 2].map(|k| {
                    let (p, r, h) = (p.get(k).as_f64(), r.get(k).as_f64(), target.half_extents().get(k).as_f64());
                    let (x, y) = ((-h - p) / r, (h - p) / r);
                    (x.min(y), x.max(y))
                });
                let (enter, leave) = (a0.max(a1).max(a2), b0.min(b1).min(b2));
                let answer = lambda(&target, source, d);
                if leave - enter > 1e-3 * size {
                    let error = (answer.expect("a sure hit") - enter).abs();
                    assert!(error < ulps::<V>(256.0) * size, "{size} {d:?}: {error}");
                    hits += 1;
                } else if enter - leave > 1e-3 * size {
                    assert_eq!(answer, None, "a sure miss, {size} {d:?}");
                }
            }
        }
        assert!((50..450).contains(&hits), "both hits and misses: {hits} of 500");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// The combination of all: a rounded, summed, far away thing is hit where its closed form says.
#[test]
fn far_source_loses_only_its_own_digits() {
    fn run<V: Vector3>() {
        let bar = Segment::new([v::<V>([-1.0, 0.0, 0.0]), v([1.0, 0.0, 0.0])]).expect("finite");
        let capsule = MinkowskiSum::new(bar, Ball::new(s::<V>(0.5)).expect("positive"));
        for distance in [1e1, 1e3, 1e6] {
            let hit = lambda(&capsule, [0.3, 0.0, -distance], [0.0, 0.0, 1.0]).expect("it is hit");
            assert!((hit - (distance - 0.5)).abs() < ulps::<V>(4.0) * distance, "{distance}: {hit}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// A ray that crosses a face at a cosine of 0.002, and a facet of support points behind it ten times as steeply: where
/// the ray enters is known to rounding divided by the lesser cosine. The truth is from fifty digits.
#[test]
fn a_grazing_hit_is_bracketed_by_its_lesser_slope() {
    let cuboid = Cuboid::new(DVec3::new(157.15030592069337, 78.57515296034668, 39.28757648017334)).expect("positive");
    let turn = DQuat::from_xyzw(0.16172384247692612, 0.5165523092448319, -0.8269384664007119, 0.15228881566014074);
    let place = DVec3::new(-155.9487882186194, -478.60807352170985, 1.330241923435082);
    let ray = Ray {
        source: DVec3::new(-452.0003311752498, -445.9729657411644, -268.09972528286045),
        direction: DVec3::new(0.7187691680792078, -0.30536876865379214, 0.5357431193242176),
    };
    let axis = DVec3::new(-0.4446695582394215, 0.837573233373685, -0.3173957509342371);
    let options = RayCastOptions::new()
        .with_tolerance(0.007890631001332341)
        .with_sub_algorithm(SubAlgorithm::Johnson)
        .with_axis(axis);
    let cast = ray_cast(&Posed::new(cuboid, turn, place).expect("a rotation"), ray, options).expect("finite");
    assert!(cast.lower <= 308.198737809357 && 308.198737809357 <= cast.upper, "{cast:?}");
}

/// Found by the sweep: a polytope's middle is not its frame's origin, and the sum of both was rounded where it is
/// posed: the shape was moved by up to half an ulp of its place, which at a million sizes in `f32` is a twentieth of
/// its size, and the bounds did not hold the truth. Here half an ulp of the place is the shape.
#[test]
fn r30_a_posed_polytope_is_where_its_vertices_are() {
    fn run<V: Vector3>(far: f64) {
        let corners = (0..8).map(|i| v::<V>([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 0.0625 } else { 0.0 })));
        let cube = at(Polytope::new(corners).expect("eight points"), [far, 0.0, 0.0]);
        let ray = Ray { source: v::<V>([far - 1.0, 0.03125, 0.03125]), direction: v::<V>([1.0, 0.0, 0.0]) };
        for method in [CastMethod::Portal, CastMethod::Gjk] {
            let found = ray_cast(&cube, ray, RayCastOptions::default().with_method(method)).expect("a finite ray");
            let hit = found.outcome.hit().expect("the cube is ahead").lambda.as_f64();
            assert!((hit - 1.0).abs() <= ulps::<V>(8.0), "{far} {method:?}: {hit}");
            assert!(found.lower.as_f64() <= 1.0 && found.upper.as_f64() >= 1.0, "{far} {method:?}: {found:?}");
        }
        let point = at(Point::new(V::ZERO).expect("finite"), [far - 1.0, 0.0, 0.0]);
        let apart = distance(&point, &cube, DistanceOptions::default()).distance.as_f64();
        assert!((apart - 1.0).abs() <= ulps::<V>(8.0), "{far}: {apart}");
    }
    both(|| run::<Vec3A>(f64::from(1 << 20)), || run::<DVec3>(f64::from(1 << 30) * f64::from(1 << 19)));
}

/// A ray within the plane of a face, towards the face's edge: no plane is crossed, and a bracket that is scaled by the
/// cosine of the last one was closed at once, at the source.
#[test]
fn a_ray_in_the_plane_of_a_face_meets_its_edge() {
    fn run<V: Vector3>() {
        let corners = [[0.0, 1.0, -1.0], [1.0, 0.0, -1.0], [-2.0, -2.0, -1.0], [2.0, 2.0, 0.0]];
        let target = Polytope::new(corners.map(v::<V>)).expect("finite");
        let hit = lambda(&target, [1.0, 1.0, -1.0], [-1.0, -1.0, 0.0]).expect("it is hit");
        assert!((hit - 0.5).abs() < ulps::<V>(64.0), "{hit}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Where the ray begins on its line has to belong to the foot that was rounded, or the errors of both add up: four ulps
/// of the source's distance in place of two, which is all that the bracket allows for.
#[test]
fn a_far_source_costs_two_and_a_half_ulps_of_its_distance() {
    let ball = Ball::<Vec3A>::new(1.0).unwrap();
    for i in 0..2000_u16 {
        let turn = f32::from(i) * 0.1;
        let source = Vec3A::new(turn.cos(), (turn * 0.37).sin(), (turn * 0.11).cos() - 0.3) * 1e6;
        let direction = -source * (0.3 + f32::from(i) * 1e-3);
        let cast = ray_cast(&ball, Ray { source, direction }, RayCastOptions::default()).unwrap();
        let (s, d) = (source.as_dvec3(), direction.as_dvec3());
        let foot = s - d * (s.dot(d) / d.length_squared());
        let exact = (-s.dot(d) / d.length() - (1.0 - foot.length_squared()).sqrt()) / d.length();
        let hit = cast.outcome.hit().expect("the ray goes to the centre");
        let ulps = (f64::from(hit.lambda) - exact).abs() * d.length() / (s.length() * f64::from(f32::EPSILON));
        assert!(ulps <= 2.5, "ray {i}: {ulps} ulps");
        assert!(f64::from(cast.lower) <= exact && exact <= f64::from(cast.upper), "ray {i}: {cast:?} for {exact}");
    }
}

/// The ray runs along an edge at 1.05e-6 from it, a little more than the noise, with nothing left to bring it nearer or
/// to tell the two apart.
#[test]
fn a_ray_past_an_edge_by_rounding_is_decided() {
    let points = [
        [0.47474897, 0.35878596, 0.45436954],
        [0.07933303, -0.76655847, -0.16493198],
        [-0.22763959, 0.36330676, 0.5168167],
        [-0.16308786, -0.675708, 0.30593768],
        [-0.89813066, -0.29418707, -0.14466488],
        [-0.61078364, 0.54298145, 0.24465969],
        [0.985783, 0.08808521, -0.07615143],
        [0.23867257, 0.7633723, -0.10818046],
    ];
    let hull = Polytope::new(points.map(Vec3A::from_array)).expect("finite points");
    let ray = Ray {
        source: Vec3A::new(-51.016_354, 55.713_276, -65.523_76),
        direction: Vec3A::new(4.260_442_3, -4.685_431, 5.435_914),
    };
    let answer = ray_cast(&hull, ray, RayCastOptions::default()).expect("a finite ray");
    assert!(!answer.outcome.is_undecided(), "{answer:?}");
    // Whether it hits is decided by rounding, and where along the edge; that the body is there is not.
    if let Outcome::Hit(hit) = answer.outcome {
        let spot = Point::new(hit.point).expect("a finite point");
        let off = distance(&spot, &hull, DistanceOptions::default()).distance;
        // Two and a half ulps of the source's distance.
        assert!(off <= 3e-5, "{off:e} off: {answer:?}");
        assert!(answer.lower <= hit.lambda && hit.lambda <= answer.upper, "{answer:?}");
    }
}

/// Found by comparing scenes: so short a direction that its λ overflows hit at infinity, at a point that was not a
/// number, converged. There is no number for such a λ; but a ray with an end misses what is beyond it.
#[test]
fn a_lambda_that_overflows_is_not_a_hit() {
    fn run<V: Vector3>(short: f64) {
        let shapes: [Box<dyn SupportMap<Vector = V>>; 3] = [
            Box::new(at(cuboid::<V>([1.0; 3]), [1e7, 0.0, 0.0])),
            Box::new(at(Ball::<V>::new(s::<V>(1.0)).expect("a radius"), [1e7, 0.0, 0.0])),
            Box::new(at(Cone::<V>::new(s::<V>(1.0), s::<V>(1.0)).expect("a cone"), [1e7, 0.0, 0.0])),
        ];
        for shape in &shapes {
            let ray = Ray { source: v::<V>([0.0, 0.125, 0.125]), direction: v([short, 0.0, 0.0]) };
            let open = ray_cast(shape, ray, RayCastOptions::default()).expect("finite");
            assert!(matches!(open.outcome, Outcome::Undecided), "{open:?}");
            assert!(open.lower.as_f64().is_finite() && open.status == Status::Stalled, "{open:?}");
            let ended = ray_cast(shape, ray, RayCastOptions::new().with_max_lambda(s::<V>(1.0))).expect("finite");
            assert!(ended.outcome.is_miss(), "{ended:?}");
        }
    }
    both(|| run::<Vec3A>(1e-35), || run::<DVec3>(1e-304));
}

/// Found by exact rationals: a body of 1e-308 was looked at in the world's unit, as its own has no reciprocal, and
/// there the squares of its lengths are zero: rays through it missed. Whatever is subnormal is known to a few hundred
/// of the least numbers.
#[test]
fn rays_at_the_smallest_bodies_do_not_miss_what_they_hit() {
    fn run<V: Vector3>(exponents: core::ops::Range<i32>) {
        for exponent in exponents {
            let size = s::<V>(2.0_f64.powi(exponent));
            let corners = (0..3).flat_map(|i| [V::axis(i) * size, -V::axis(i) * size]);
            let octahedron = Polytope::new(corners).expect("finite");
            for direction in directions(40) {
                let unit = s::<V>(2.0_f64.powi(-6));
                let source = v::<V>(direction) * s::<V>(4.0) * size;
                let ray = Ray { source, direction: -source * unit };
                let Ok(cast) = ray_cast(&octahedron, ray, RayCastOptions::default()) else { continue };
                // It is at the middle after 64, and in the body by then.
                assert!(cast.lower.as_f64() <= 64.0 && !cast.outcome.is_miss(), "2^{exponent}: {cast:?}");
                // The ball that is within the octahedron is √3 times smaller.
                assert!(cast.upper.as_f64() >= 48.0, "2^{exponent}: {cast:?}");
            }
        }
    }
    both(|| run::<Vec3A>(-149..-100), || run::<DVec3>(-1074..-1000));
}

/// Algorithm 1 took a source within the rounding of a closest point for one in the set, and said [0, 0]: in single
/// precision 3,854 of 4,000 rays that began less than a few roundings outside of a hull. That a closest point is near
/// proves nothing about where the ray is in the set; points all around a place of the ray, all of them in the set,
/// do.
#[test]
fn an_upper_bound_of_algorithm_1_is_where_points_of_the_set_are_all_around() {
    let hull = Polytope::new([
        Vec3A::new(754.194_46, 20_428.152, 92_705.945),
        Vec3A::new(19_193.492, -19_829.129, 40_356.645),
        Vec3A::new(-9_963.287, -9_902.605, -20_320.426),
        Vec3A::new(47_673.38, -18_537.86, 69_152.41),
        Vec3A::new(-14_745.286, -9_539.908, 30_139.287),
        Vec3A::new(9_442.201, 16_187.031, 25_943.803),
    ])
    .expect("finite points");
    let closest = |x: Vec3A| {
        let d = distance(&hull, &Point::new(x).ok()?, DistanceOptions::default());
        Some(d.normal.map_or(d.point_a, |normal| x + normal * d.distance))
    };
    let (source, direction) =
        (Vec3A::new(1_203.451_5, -14_372.225, 34_803.996), Vec3A::new(-0.337_026_06, 0.525_427_5, -0.674_298));
    let cast = iterative_ray_cast(closest, Ray { source, direction }, RayCastOptions::default()).expect("finite");
    // By exact rationals.
    let truth = 0.001_013_645;
    assert!(cast.is_certain() && cast.lower <= truth && truth <= cast.upper, "{cast:?}");

    // A flat set has no points around any place of the ray.
    let plate = Polytope::new([[1.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)));
    let plate = plate.expect("finite points");
    let closest = |x: DVec3| {
        let d = distance(&plate, &Point::new(x).ok()?, DistanceOptions::default());
        Some(d.point_a)
    };
    let ray = Ray { source: DVec3::new(0.0, 0.125, 4.0), direction: DVec3::NEG_Z };
    let cast = iterative_ray_cast(closest, ray, RayCastOptions::default()).expect("finite");
    assert_eq!(
        (cast.outcome.hit().is_some(), cast.is_certain(), cast.status),
        (true, false, Status::Stalled),
        "{cast:?}"
    );
}

/// Where a ray grazes within rounding, the answer was a hit that had `Converged`, and only an infinite bound told
/// that it may as well be a miss: 30 of 100 rays nearly along a surface. Whoever reads the outcome and the status
/// alone is told now, by whatever was cast.
#[test]
fn a_hit_that_may_be_a_miss_has_not_converged() {
    fn run<V: Vector3>() {
        let pebble = Ellipsoid::<V>::new(V::ZERO, v([2.0, 1.0, 0.5]), V::Rotation::default()).expect("positive");
        let graze = Ray { source: v::<V>([-5.0, 1.0, 0.0]), direction: v([1.0, 0.0, 0.0]) };
        let stalled = |is_certain: bool, status: Status| !is_certain && status == Status::Stalled;
        let cast = ray_cast(&pebble, graze, RayCastOptions::default()).expect("finite");
        assert!(cast.outcome.hit().is_some() && stalled(cast.is_certain(), cast.status), "{cast:?}");
        let exit = ray_exit(&pebble, graze, RayCastOptions::default()).expect("finite");
        assert!(exit.outcome.is_hit() && stalled(exit.is_certain(), exit.status), "{exit:?}");
        let late = ray_cast(&pebble, graze, RayCastOptions::new().with_min_lambda(s::<V>(5.0))).expect("finite");
        assert!(!late.outcome.is_hit() || stalled(late.is_certain(), late.status), "{late:?}");

        // Edge to edge, and a ray along a plane.
        let [a, b] = [0.0, 2.0].map(|y| at(cuboid::<V>([1.0; 3]), [2.5 * y, y, 0.0]));
        let motion = Motion { velocity_a: v::<V>([1.0, 0.0, 0.0]), velocity_b: V::ZERO };
        let cast = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite");
        assert!(cast.outcome.hit().is_some() && stalled(cast.is_certain(), cast.status), "{cast:?}");
        let floor = HalfSpace::new(v::<V>([0.0, 1.0, 0.1]), s::<V>(1.0)).expect("a plane");
        let ray = Ray { source: v::<V>([0.0, 1.0, 0.0]), direction: v([1.0, 0.1, -1.0]) };
        let cast = floor.ray_cast(ray, RayCastOptions::default()).expect("finite");
        assert!(cast.is_certain() || cast.status == Status::Stalled, "{cast:?}");

        let scene = Scene::new([pebble]).expect("finite");
        let first = scene.all().ray_cast(graze, RayCastOptions::default()).expect("finite");
        let hit = first.first.as_ref().expect("as alone");
        assert!(stalled(hit.is_certain(), hit.status) && !first.is_certain(), "{first:?}");
        let any = scene.all().any_hit(graze, RayCastOptions::default()).expect("finite");
        assert_eq!((any.hit, any.undecided, any.is_certain()), (true, Some(0), false), "{any:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// A ray 1e-9 off the direction of a cylinder's side was known to 1e-5 of the size, and one that grazes it to all of
/// it: the bounds allowed for a displacement of the line by roundings of the *size*, which so small an angle makes
/// long. Of a shape and a line as they are given nothing is rounded, and in twice the precision the crossing is known
/// to roundings of its own.
#[test]
fn rays_nearly_along_a_side_are_as_narrow_as_their_numbers() {
    fn run<V: Vector3>(tilt: f64) {
        type Shape<V> = Box<dyn SupportMap<Vector = V>>;
        let (four, half, one) = (s::<V>(4.0), s::<V>(0.5), s::<V>(1.0));
        let upright: [Shape<V>; 3] = [
            Box::new(Cylinder::<V>::new(four, one).expect("positive")),
            Box::new(Capsule::<V>::new(four, one).expect("positive")),
            Box::new(Rounded::new(cuboid::<V>([0.5, 4.0, 2.0]), half).expect("positive")),
        ];
        // It comes nearer to x = 1 by the tilt in every unit, and begins 3 tilts beyond.
        let beside = Ray { source: v::<V>([1.0 + 3.0 * tilt, -2.0, 0.0]), direction: v([-tilt, 1.0, 0.0]) };
        let mut cases: Vec<(Shape<V>, Ray<V>, f64)> = upright.into_iter().map(|shape| (shape, beside, 3.0)).collect();
        // The slant is x = (1 − y)/2.
        let slant = Ray { source: v::<V>([0.25 + 1.25 * tilt, 0.5, 0.0]), direction: v([0.5 - tilt, -1.0, 0.0]) };
        cases.push((Box::new(Cone::<V>::new(one, one).expect("positive")), slant, 1.25));
        // The chord is half as long as the root of 2·16ε.
        let depth = 16.0 * V::Scalar::EPSILON.as_f64();
        let chord = (2.0 * depth - depth * depth).sqrt();
        let graze = Ray { source: v::<V>([1.0 - depth, -2.0, 0.0]), direction: v([0.0, 1.0, 0.0]) };
        cases.push((Box::new(Ball::<V>::new(one).expect("positive")), graze, 2.0 - chord));
        for (shape, ray, truth) in cases {
            let cast = ray_cast(&*shape, ray, RayCastOptions::default()).expect("finite");
            let (lower, upper) = (cast.lower.as_f64(), cast.upper.as_f64());
            assert!(cast.is_certain() && lower <= truth && truth <= upper, "{truth}: {cast:?}");
            assert!(upper - lower <= ulps::<V>(32.0), "{:e} wide: {cast:?}", upper - lower);
        }
    }
    both(|| run::<Vec3A>(1.0 / 65536.0), || run::<DVec3>(1.0 / 1_073_741_824.0));
}

/// A ray along a cone's generator took 2,647 support points though 200 were allowed, and one that begins on a box's
/// face up to 220 to answer 0: after a cast that left the start in doubt, whole depths were computed at up to 18
/// places from a few roundings on, and none counted. The ray is deepest about the middle of what is in the body, and
/// one look there is mostly enough.
#[test]
fn second_looks_are_few_and_count() {
    fn run<V: Vector3>() {
        let turned = |shape: Box<dyn SupportMap<Vector = V>>, place| {
            turned(shape, quaternion::<V>([0.3, -0.5, 0.7, 0.4]), place)
        };
        let cone = turned(Box::new(Cone::<V>::new(s::<V>(1.0), s::<V>(1.0)).expect("positive")), [0.0; 3]);
        let cube = turned(Box::new(cuboid::<V>([1.0, 0.5, 0.25])), [0.25, 0.5, -1.0]);
        let mut most = [0; 2];
        for i in 0..40 {
            let angle = 0.1 * f64::from(i);
            let (rim, apex) = ([angle.cos(), -1.0, angle.sin()], [0.0, 1.0, 0.0]);
            let on_face = [0.9 * angle.cos(), 0.5, 0.2 * angle.sin()];
            let place = |shape: &Posed<Box<dyn SupportMap<Vector = V>>>, p: [f64; 3]| {
                shape.rotation() * v::<V>(p) + shape.translation()
            };
            let (from, to) = (place(&cone, [0, 1, 2].map(|k| 2.0 * apex[k] - rim[k])), place(&cone, rim));
            let generator = Ray { source: from, direction: to - from };
            let begins =
                Ray { source: place(&cube, on_face), direction: V::ZERO - place(&cube, [angle.sin(), 1.0, 0.3]) };
            let [along, start] = [
                ray_cast(&cone, generator, RayCastOptions::default()).expect("finite"),
                ray_cast(&cube, begins, RayCastOptions::default()).expect("finite"),
            ];
            most = [most[0].max(along.iterations), most[1].max(start.iterations)];
        }
        assert!(most[0] <= 200 && most[1] <= 60, "{most:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Points of an ellipsoid with coordinates that are integers: `(2m, m² − 1)` on the circle of radius `m² + 1`, which is
/// stretched by powers of two. So the true parameters are integers too.
#[test]
fn rays_at_the_tips_of_needles_are_certain() {
    let (mut asked, mut steps) = (0, 0);
    for stretch in (6..=23).map(|k| f64::from(1 << k)) {
        for m in [2.0, 7.0, 30.0, 111.0, 500.0] {
            let (width, tip) = (m * m + 1.0, DVec3::new(2.0 * m, (m * m - 1.0) * stretch, 0.0));
            let semi_axes = DVec3::new(width, width * stretch, width);
            let needle = Ellipsoid::new(DVec3::ZERO, semi_axes, DQuat::IDENTITY).expect("a needle");
            let ball = Ball::new(1.0).expect("a ball");
            let image = Affine::new(ball, DMat3::from_diagonal(semi_axes), DVec3::ZERO).expect("an image");
            let shift = DVec3::new(-64.0, 1024.0, 4096.0);
            let moved = Posed::translated(image, shift).expect("an image");
            for along in [[-1, 0, 0], [0, -1, 0], [-3, -2, 1], [1, -5, 7], [-1, 1, 0], [-40, 9, -11]] {
                let direction = DVec3::from(along.map(f64::from)) * if along[1] > 0 { 1.0 } else { 1024.0 };
                let out = tip / semi_axes / semi_axes;
                if out.dot(direction) >= 0.0 {
                    continue;
                }
                let ray = |by: f64, shift| Ray { source: tip - direction * by + shift, direction };
                for by in [1.0, 8.0, 4096.0] {
                    let casts = [
                        ray_cast(&needle, ray(by, DVec3::ZERO), RayCastOptions::default()).expect("a ray"),
                        ray_cast(&image, ray(by, DVec3::ZERO), RayCastOptions::default()).expect("a ray"),
                        ray_cast(&moved, ray(by, shift), RayCastOptions::default()).expect("a ray"),
                    ];
                    for cast in casts {
                        assert!(cast.lower <= by && by <= cast.upper, "{stretch} {m} {along:?} {by} {cast:?}");
                        assert!(
                            cast.is_certain() && cast.outcome.hit().is_some(),
                            "{stretch} {m} {along:?} {by} {cast:?}"
                        );
                        (asked, steps) = (asked + 1, steps.max(cast.iterations));
                    }
                }
            }
        }
    }
    assert!(asked > 2000 && steps <= 64, "{steps} steps of {asked} rays");
}

/// Near the side of a needle a line enters and leaves far from its source, and rounding decided nothing.
#[test]
fn a_ray_that_begins_within_a_needle_is_a_certain_hit() {
    let needle = Cylinder::<DVec3>::new(6480.0, 0.75).expect("a needle");
    let cone = Cone::<DVec3>::new(9372.0, 1.0).expect("a needle");
    for aside in [0.25, 0.5, 0.7499, 0.749_999_999] {
        let direction = DVec3::new(1e-5, -1.0, -3e-6);
        let from = |y: f64| Ray { source: DVec3::new(-aside, y, 0.0), direction };
        let cast = ray_cast(&needle, from(-6000.0), RayCastOptions::default()).expect("a ray");
        assert!(cast.outcome.hit().is_some() && cast.upper == 0.0, "{aside} {cast:?}");
        let cast = ray_cast(&cone, from(-9000.0), RayCastOptions::default()).expect("a ray");
        assert!(cast.outcome.hit().is_some() && cast.upper == 0.0, "{aside} {cast:?}");
    }
    // Behind the source.
    let ray = Ray { source: DVec3::new(-0.7, -6481.0, 0.0), direction: DVec3::new(1e-5, -1.0, 0.0) };
    let cast = ray_cast(&needle, ray, RayCastOptions::default()).expect("a ray");
    assert!(cast.outcome.is_miss() && cast.is_certain(), "{cast:?}");
}
