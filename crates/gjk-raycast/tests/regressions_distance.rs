//! Distances and overlaps that went wrong elsewhere. Each test is named after its report, tells what goes wrong there,
//! and runs in both precisions where the coordinates allow it.

use crate::common::behind_pointers::{distance, intersects, signed_distance};
use crate::common::{apart, at, cuboid, directions, meets, quaternion, s, turned, ulps, v};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Quat, Vec2, Vec3, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Point, Polytope, Posed, Rounded, Scalar,
    Segment, SupportMap, Triangle, Vector, Vector3, support_value,
};
use gjk_raycast::{Distance, DistanceOptions, IntersectOptions, SignedDistanceOptions, Status, SubAlgorithm};

fn both(single: impl FnOnce(), double: impl FnOnce()) {
    single();
    double();
}

/// A hull of points in a ball of the given size, the same for the same seed.
fn hull<V: Vector>(seed: u32, count: u32, size: f64, center: [f64; 3]) -> Polytope<V> {
    let points = (0..count).map(|i| {
        let t = f64::from(seed * 97 + i * 31);
        let p = [(1.3 * t).sin(), (2.7 * t + 1.0).sin(), (4.1 * t + 2.0).sin()];
        v::<V>([0, 1, 2].map(|k| center[k] + size * p[k]))
    });
    Polytope::new(points).expect("finite points")
}

/// `MuJoCo` #3383. A hundred of 3,000 pairs of meshes were answered 0 although a plane separates them. The certificate
/// of the report is the test: if any sampled direction separates, the distance is at least that.
#[test]
fn d1_no_zero_where_a_plane_separates() {
    fn run<V: Vector3>() {
        let mut separated = 0;
        for seed in 0..200 {
            let a = hull::<V>(seed, 5 + seed % 20, 0.5, [0.0; 3]);
            let b = hull::<V>(seed + 1000, 12, 0.3, directions(200).nth(seed as usize).expect("200").map(|c| 0.9 * c));
            let answer = apart(&a, &b);
            let planes = directions(300).map(|d| -(support_value(&a, v(d)) + support_value(&b, -v::<V>(d))).as_f64());
            let plane = planes.fold(f64::NEG_INFINITY, f64::max);
            assert!(answer.upper.as_f64() >= plane, "{seed}: {answer:?}, {plane}");
            assert_eq!(answer.status, Status::Converged, "{seed}");
            assert_eq!(answer.overlap, answer.distance.as_f64() == 0.0, "{seed}: {answer:?}");
            separated += u32::from(plane > 0.0);
        }
        assert!((20..180).contains(&separated), "both kinds of pairs: {separated} of 200 apart");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `mujoco_warp` #1546, `openGJK` #52. Supports were subtracted in world coordinates, so that moving both bodies
/// changed the answer. Exact translations change nothing here.
#[test]
fn d2_d6_a_common_translation_changes_nothing() {
    fn run<V: Vector3>(reaches: &[f64]) {
        let pair = |x: f64| {
            apart(
                &at(cuboid::<V>([1.0, 0.5, 0.25]), [x, -x, x]),
                &at(cuboid::<V>([0.5; 3]), [x + 3.0, 0.5 - x, x + 0.25]),
            )
        };
        let near = pair(0.0);
        for &reach in reaches {
            let far = pair(reach);
            assert_eq!((far.distance, far.normal, far.iterations), (near.distance, near.normal, near.iterations));
        }
    }
    both(|| run::<Vec3A>(&[1.0, 1024.0, 65_536.0]), || run::<DVec3>(&[1.0, 1024.0, 1_048_576.0, 1e12]));
}

/// #1526, fcl #293, `openGJK` #13. The origin on a face, an edge or a corner of the simplex, and simplices of four
/// points in a plane or three on a line: contact was dropped, or 0/0.
#[test]
fn d3_d5_d26_contact_on_a_face_an_edge_or_a_corner_is_contact() {
    fn run<V: Vector3>() {
        let cube = cuboid::<V>([1.0; 3]);
        for x in [0.0, 1.0, 2.0] {
            for y in [0.0, 1.0, 2.0] {
                for z in [0.0, 1.0, 2.0] {
                    let other = at(cuboid::<V>([1.0; 3]), [x, y, z]);
                    let answer = apart(&cube, &other);
                    assert!(answer.overlap, "({x}, {y}, {z}): {answer:?}");
                    assert!(meets(&cube, &other).overlap, "({x}, {y}, {z})");
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `openGJK` #13, the random pairs: about 2 in 10,000 pairs of cubes that overlap deeply were tens of centimetres
/// apart.
#[test]
fn d5_deep_overlap_is_overlap() {
    fn run<V: Vector3>() {
        for (i, d) in directions(3000).enumerate() {
            let t = i as f64;
            let turn = quaternion::<V>([(1.1 * t).sin(), (1.7 * t).sin(), (2.3 * t).sin(), 1.5]);
            let cube = turned(cuboid::<V>([0.5; 3]), turn, d.map(|c| 0.9 * c * (0.7 * t).sin().abs()));
            // Both contain the ball of radius ½ about their centres, less than 1 apart.
            let answer = apart(&cube, &cuboid::<V>([0.5; 3]));
            assert!(answer.overlap && answer.distance.as_f64() == 0.0, "{i}: {answer:?}");
            assert_eq!(meets(&cube, &cuboid::<V>([0.5; 3])).decided(), Some(true), "{i}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `openGJK` #52. In single precision, boxes that overlap near (91000, 54000) were 0.00329 apart.
#[test]
fn d6_boxes_that_overlap_far_away_overlap() {
    fn run<V: Vector3>() {
        for x in [0.0, 0.25, 0.5, 0.9375, 1.0] {
            let a = at(cuboid::<V>([0.5; 3]), [91_000.0, 54_000.0, 10.0]);
            let b = at(cuboid::<V>([0.5; 3]), [91_000.0 + x, 54_000.0 - x, 10.0 + 0.5 * x]);
            let answer = apart(&a, &b);
            assert!(answer.overlap && answer.distance.as_f64() == 0.0, "{x}: {answer:?}");
        }
        let beyond = at(cuboid::<V>([0.5; 3]), [91_001.5, 54_000.0, 10.0]);
        let answer = apart(&at(cuboid::<V>([0.5; 3]), [91_000.0, 54_000.0, 10.0]), &beyond);
        assert!((answer.distance.as_f64() - 0.5).abs() < ulps::<V>(32.0), "{answer:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Jolt #1008, #419, #41. A cylinder at the edge of a triangle had a depth of 0.397, another 0.01 apart one of 0.499,
/// and a triangle below a square millimetre was dropped as having no area.
#[test]
fn d22_a_cylinder_at_the_edge_of_a_triangle() {
    fn run<V: Vector3>() {
        for size in [1.0, 1e-3, 1e-4] {
            let corners = [[0.0, 0.0, -size], [0.0, 0.0, size], [-size, 0.0, 0.0]];
            let triangle = Triangle::new(corners.map(v::<V>)).expect("finite");
            for gap in [1e-2, 1e-3] {
                let (h, r) = (0.5 * size, 0.25 * size);
                let cylinder = Cylinder::<V>::new(s::<V>(h), s::<V>(r)).expect("positive");
                // Standing beside the edge, above the face, and lying across the edge from beyond.
                let beside = apart(&at(cylinder, [r + gap * size, 0.0, 0.1 * size]), &triangle);
                let above = apart(&at(cylinder, [-0.1 * size, h + gap * size, 0.1 * size]), &triangle);
                for (what, answer) in [("beside", beside), ("above", above)] {
                    let error = (answer.distance.as_f64() - gap * size).abs();
                    assert!(error < ulps::<V>(64.0) * size, "{what} {size} {gap}: {answer:?}");
                    assert!(!answer.overlap, "{what} {size} {gap}: {answer:?}");
                }
                let within = apart(&at(cylinder, [0.5 * r, 0.0, 0.1 * size]), &triangle);
                assert!(within.overlap, "{size}: {within:?}");
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `openGJK` #56 and #41. NaN for flat objects and rounded cubes.
#[test]
fn d7_flat_and_rounded_shapes_have_finite_answers() {
    fn run<V: Vector3>() {
        let plate = cuboid::<V>([1.0, 0.0, 1.0]);
        let needle = cuboid::<V>([0.0, 0.0, 1.0]);
        let rounded = Rounded::new(cuboid::<V>([0.5; 3]), s::<V>(0.25)).expect("positive");
        for d in directions(60) {
            let away = d.map(|c| 4.0 * c);
            for answer in [
                apart(&plate, &at(plate, away)),
                apart(&needle, &at(plate, away)),
                apart(&rounded, &at(needle, away)),
                apart(&rounded, &at(rounded, away)),
            ] {
                assert_eq!(answer.status, Status::Converged, "{d:?}: {answer:?}");
                let gap = (answer.point_a - answer.point_b).norm().as_f64();
                assert!((gap - answer.distance.as_f64()).abs() < ulps::<V>(64.0), "{d:?}: {answer:?}");
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// coal #48, #49, #53. Two nearly touching triangles, one of 25 m and one of millimetres: no convergence.
#[test]
fn d10_a_tiny_triangle_near_a_large_one() {
    fn run<V: Vector3>() {
        let large = Triangle::new([v::<V>([-25.0, 0.0, -20.0]), v([25.0, 0.0, -15.0]), v([0.0, 0.0, 25.0])]);
        let large = large.expect("finite");
        for gap in [1e-3, 1e-4, 0.0] {
            let corners = [[1.0, gap, 2.0], [1.002, gap + 1e-3, 2.0], [1.0, gap + 1e-3, 2.003]];
            let small = Triangle::new(corners.map(v::<V>)).expect("finite");
            let answer = apart(&small, &large);
            assert!((answer.distance.as_f64() - gap).abs() < ulps::<V>(256.0), "{gap}: {answer:?}");
            assert_eq!(answer.status, Status::Converged, "{gap}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// coal #37, #380. A cylinder very close to a box never converged, or hit an assertion.
#[test]
fn d11_d12_a_cylinder_close_to_a_box_converges() {
    fn run<V: Vector3>(gaps: &[f64]) {
        for &gap in gaps {
            let cylinder = Cylinder::<V>::new(s::<V>(0.5), s::<V>(0.25)).expect("positive");
            for (rotation, reach) in [([0.0, 0.0, 0.0, 1.0], 0.5), ([0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt()], 0.25)] {
                let posed = turned(cylinder, quaternion::<V>(rotation), [0.1, 1.0 + reach + gap, 0.2]);
                let answer = apart(&posed, &cuboid::<V>([1.0; 3]));
                assert!((answer.distance.as_f64() - gap).abs() < ulps::<V>(64.0), "{gap}: {answer:?}");
            }
        }
    }
    both(|| run::<Vec3A>(&[1e-2, 1e-4]), || run::<DVec3>(&[1e-2, 1e-6, 1e-10]));
}

/// fcl #508, libccd #25. Parallel boxes: 3.16 instead of 3, NaN, or the right answer from another start only. The start
/// axis does not matter.
#[test]
fn d13_d15_parallel_boxes_from_every_start() {
    fn run<V: Vector3>() {
        let unit = cuboid::<V>([0.5; 3]);
        for axis in 0..3 {
            let mut offset = [0.0; 3];
            offset[axis] = 4.0;
            let other = at(unit, offset);
            for d in directions(40).chain([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]]) {
                let answer = distance(&unit, &other, DistanceOptions::new().with_axis(v(d)));
                assert!((answer.distance.as_f64() - 3.0).abs() < ulps::<V>(8.0), "{axis} {d:?}: {answer:?}");
                let near = at(cuboid::<V>([1.0; 3]), offset.map(|c| 0.475 * c));
                let meets = intersects(&cuboid::<V>([1.0; 3]), &near, IntersectOptions::new().with_axis(v(d)));
                assert_eq!(meets.decided(), Some(true), "{axis} {d:?}");
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// jitterphysics2 #302. A unit box and a one-point cloud on its face: distance said apart, overlap said together.
#[test]
fn d19_distance_and_overlap_never_contradict() {
    fn run<V: Vector3>() {
        let cube = cuboid::<V>([0.5; 3]);
        for i in -40..=40 {
            let x = 0.5 * (1.0 + ulps::<V>(0.5 * f64::from(i)));
            let point = Point::new(v::<V>([x, 0.1, -0.2])).expect("finite");
            let answer = apart(&point, &cube);
            assert_eq!(meets(&point, &cube).overlap, answer.overlap, "{i}: {answer:?}");
            assert!(answer.overlap == (answer.distance.as_f64() == 0.0), "{i}: {answer:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Jolt #671, #1008, #419, coal #604. Boxes a millimetre apart and nearly parallel: the axis flipped with the
/// orientation, and centimetres of depth came out.
#[test]
fn d9_d21_d22_nearly_parallel_boxes_keep_their_axis() {
    fn run<V: Vector3>() {
        let b = cuboid::<V>([0.363, 0.277, 0.363]);
        for i in -20..=20 {
            let half = 0.5e-4 * f64::from(i);
            let a = turned(
                cuboid::<V>([0.363, 0.363, 0.277]),
                quaternion::<V>([half, 0.0, 0.3 * half, 1.0]),
                [0.02, 0.6411, 0.01],
            );
            let answer = apart(&a, &b);
            let d = answer.distance.as_f64();
            assert!((5e-5..1.2e-3).contains(&d), "{i}: {answer:?}");
            assert!(crate::common::off(answer.normal, [0.0, 1.0, 0.0]) < 0.01, "{i}: {answer:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// sch-core #28, Flexible-GJK #8. Parallel closest faces and NaN made endless loops. A support map of NaN ends with a
/// status.
#[test]
fn d27_nothing_loops() {
    struct Broken<V>(V);
    impl<V: Vector> SupportMap for Broken<V> {
        type Vector = V;

        fn support(&self, _: V) -> V {
            self.0
        }
    }
    fn run<V: Vector3>() {
        for bad in [f64::NAN, f64::INFINITY] {
            let answer = apart(&Broken(v::<V>([bad, 0.0, 0.0])), &cuboid::<V>([1.0; 3]));
            assert_ne!(answer.status, Status::Converged, "{answer:?}");
            assert_eq!(meets(&Broken(v::<V>([bad, 0.0, 0.0])), &cuboid::<V>([1.0; 3])).decided(), None);
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `EnhancedGJK` #30. In single precision the distance of a box and a hull of nine points was wrong, and the loop went
/// on. It is that of double precision, to rounding, and found in a few steps.
#[test]
fn d18_a_box_and_nine_points_in_single_precision() {
    fn run<V: Vector3>(seed: u32) -> (f64, usize) {
        let place = directions(40).nth(seed as usize).expect("40").map(|c| 4.0 * c);
        // The same points in both precisions.
        let points = hull::<Vec3A>(seed, 9, 1.0, [0.0; 3]);
        let points = points.points().iter().map(|p| v::<V>(p.as_dvec3().to_array()));
        let hull = Polytope::new(points).expect("finite points");
        let rounded = place.map(|c| f64::from(c as f32));
        let answer = apart(&cuboid::<V>([1.0; 3]), &at(hull, rounded));
        assert_eq!(answer.status, Status::Converged, "{seed}: {answer:?}");
        (answer.distance.as_f64(), answer.iterations)
    }
    for seed in 0..40 {
        let ((single, steps), (double, _)) = (run::<Vec3A>(seed), run::<DVec3>(seed));
        assert!((single - double).abs() < ulps::<Vec3A>(32.0), "{seed}: {single}, {double}");
        assert!(double > 0.5 && steps < 20, "{seed}: {double} apart, {steps} steps");
    }
}

/// distance3d #72. A long bar and a cube turned by 45 degrees at its end, both far from the origin.
#[test]
fn d28_a_cube_at_the_end_of_a_bar() {
    fn run<V: Vector3>() {
        let bar = at(cuboid::<V>([15.0, 0.5, 0.5]), [-104.5, -120.0, -120.0]);
        let eighth = std::f64::consts::FRAC_PI_8;
        let cube = turned(
            cuboid::<V>([0.5; 3]),
            quaternion::<V>([0.0, 0.0, eighth.sin(), eighth.cos()]),
            [-88.0, -120.0, -120.0],
        );
        let answer = apart(&cube, &bar);
        assert!((answer.distance.as_f64() - (1.5 - 0.5_f64.sqrt())).abs() < ulps::<V>(512.0), "{answer:?}");
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// distance3d #77. The closest points of two meshes of cylinders were 1e-10 farther apart than the distance. Both are
/// computed from the same weights, and agree to rounding of the size.
#[test]
fn d28_the_closest_points_of_two_meshes_are_as_far_apart_as_the_distance() {
    fn run<V: Vector3>() {
        let ring = |i: i32| {
            let (sin, cos) = (f64::from(i / 2) * std::f64::consts::TAU / 32.0).sin_cos();
            v::<V>([0.5 * cos, if i % 2 == 0 { -1.0 } else { 1.0 }, 0.5 * sin])
        };
        let mesh = Polytope::new((0..64).map(ring)).expect("finite points");
        for (i, d) in directions(100).enumerate() {
            let t = i as f64;
            let turn = quaternion::<V>([(1.1 * t).sin(), (1.7 * t).sin(), (2.3 * t).sin(), 1.5]);
            let answer = apart(&turned(&mesh, turn, d.map(|c| 3.0 * c)), &mesh);
            let between = (answer.point_a - answer.point_b).norm().as_f64();
            assert!((between - answer.distance.as_f64()).abs() < ulps::<V>(16.0), "{i}: {answer:?}");
            assert_eq!(answer.status, Status::Converged, "{i}: {answer:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// `Box2D`'s short edge, the distance: a point 5 mm beyond the end of a plank 1 m by 3.2 mm.
#[test]
fn s9_a_point_beyond_the_short_end_is_apart() {
    fn run<V: Vector>() {
        let point = at(Point::new(V::ZERO).expect("finite"), [0.505, 0.0, 0.0]);
        let answer = apart(&point, &cuboid::<V>([0.5, 0.0016, 0.0]));
        assert!((answer.distance.as_f64() - 0.005).abs() < ulps::<V>(4.0), "{answer:?}");
    }
    both(run::<Vec2>, run::<DVec2>);
}

/// A vertex on the slant of a cone, 1e-10 apart: the closest edge of the difference reaches from the apex, first found
/// along a direction a right angle away, to the rim. Between the two, only the rim's curvature tells how the plane is
/// turned about the edge, since the shortest vector is too short to have digits; steps by curvature refused a turn so
/// large although a vertex stays where it is, and the bracket was left open by 2 % with the status `Stalled`.
#[test]
fn a_vertex_just_off_the_slant_of_a_cone_converges() -> Result<(), InvalidShape> {
    let point = Point::new(DVec3::new(-0.31363, 0.8864, 0.64011))?;
    let cone = Cone::<DVec3>::new(1.3824, 0.43314)?;
    let turn = [-0.10653281093092501, -0.8848421753354835, 0.3091320055096589, 0.33187721842919776];
    let a = Posed::new(point, DQuat::from_array(turn), DVec3::new(0.33497, 1.711, 0.92984))?;
    let turn = [-0.26476062699718267, -0.8386872163612973, -0.11661267126966078, 0.46141851762098945];
    let translation = DVec3::new(-0.5092884833057056, 1.013198403712642, -0.13485589563622247);
    let b = Posed::new(cone, DQuat::from_array(turn), translation)?;
    let answer = distance(&a, &b, DistanceOptions::default());
    assert_eq!(answer.status, Status::Converged, "{answer:?}");
    assert!(answer.upper - answer.lower < 1e-13, "{answer:?}");
    assert!((answer.distance - 1.0000008467684762e-10).abs() < 1e-14, "{answer:?}");
    Ok(())
}

/// The difference touches zero with an edge of two near vertices, and has a third far away. That one's share of zero's
/// foot is the square of the distance, 1e-8 in `f32`, and was computed as one less the shares of the others: rounding.
/// Without it the plane did not turn, the same support point came again, and the descent ended `Stalled` with an open
/// bracket: of this cylinder and cone by 1e-4, of the cylinder and cuboid by 1e-9.
#[test]
fn a_far_vertex_turns_the_plane_about_an_edge_that_touches() -> Result<(), InvalidShape> {
    let turn = [0.07825313, -0.6802188, -0.51086426, 0.51980436];
    let translation = Vec3A::new(0.8087746, -0.9497469, -0.09637468);
    let a = Posed::new(Cylinder::<Vec3A>::new(0.75, 0.5)?, Quat::from_array(turn), translation)?;
    let turn = [-0.3072104, 0.038467664, 0.8950461, -0.32098988];
    let translation = Vec3A::new(-0.37328133, -0.6406334, -0.6710066);
    let b = Posed::new(Cone::<Vec3A>::new(0.75, 0.625)?, Quat::from_array(turn), translation)?;
    let answer = distance(&a, &b, DistanceOptions::default());
    assert!(answer.status == Status::Converged && answer.upper < 1e-5, "{answer:?}");

    let turn = [0.0822107166219777, 0.7163947604598121, -0.6242301517153613, 0.30059385048208553];
    let translation = DVec3::new(-0.7136184398150685, -1.2237953135294921, 1.1717931669939996);
    let a = Posed::new(Cylinder::<DVec3>::new(0.75, 0.5)?, DQuat::from_array(turn), translation)?;
    let turn = [0.15376861834199249, 0.4342551914012976, 0.8870618001631498, 0.02998338615848399];
    let translation = DVec3::new(0.8817869004093968, -0.3818567767842252, 0.2768343625534068);
    let b = Posed::new(Cuboid::new(DVec3::new(1.0, 0.5, 0.25))?, DQuat::from_array(turn), translation)?;
    let answer = distance(&a, &b, DistanceOptions::default());
    assert!(answer.status == Status::Converged && answer.upper < 4e-14, "{answer:?}");
    Ok(())
}

/// A cone 5e-10 off a cuboid. Two corners of the last triangle are 1e-7 apart and the third is far; the triangle's
/// normal, a cross product of edges from the far one, leaned by 1e-11, and the support point along it was a corner
/// already. The triangle was measured then, but the plane across the measured normal never looked along, and the
/// bracket stayed open by a twentieth.
#[test]
fn the_measured_normal_of_a_sliver_is_looked_along() -> Result<(), InvalidShape> {
    let turn = [-0.16494649648666382, 0.32249489426612854, -0.31852206587791443, 0.8759756684303284];
    let translation = DVec3::new(-1.5107576847076416, 0.36404669284820557, 1.0628018379211426);
    let a = Posed::new(Cone::<DVec3>::new(0.75, 0.625)?, DQuat::from_array(turn), translation)?;
    let turn = [-0.7768621444702148, 0.23174384236335754, 0.4487411081790924, 0.3760471045970917];
    let translation = DVec3::new(-0.3446352779865265, -0.4309627115726471, 0.833965003490448);
    let b = Posed::new(Cuboid::new(DVec3::new(1.0, 0.5, 0.25))?, DQuat::from_array(turn), translation)?;
    let answer = distance(&a, &b, DistanceOptions::default());
    assert_eq!(answer.status, Status::Converged, "{answer:?}");
    assert!((answer.distance - 5.267_067_6e-10).abs() < 2e-14, "{answer:?}");
    assert!(answer.upper - answer.lower < 3.5e-14, "{answer:?}");
    Ok(())
}

/// Two steps took turns forever: a light one to a length that was the rounding of a sliver, below the lower bound, and
/// its measurement.
#[test]
fn a_length_below_the_lower_bound_is_no_progress() -> Result<(), InvalidShape> {
    let rotation = DQuat::from_xyzw(0.29901780630354674, -0.706012690101277, 0.013755585448192352, 0.6418295854807181);
    let translation = DVec3::new(-0.9283401322594869, -0.6831296415889271, 0.6609904898055177);
    let cylinder = Cylinder::<DVec3>::new(0.75, 0.5)?;
    let cone = Posed::new(Cone::<DVec3>::new(0.75, 0.625)?, rotation, translation)?;
    let answer = distance(&cylinder, &cone, DistanceOptions::default());
    assert_eq!(answer.status, Status::Converged, "{answer:?}");
    assert!((answer.distance - 1e-6).abs() <= 1e-14, "{answer:?}");
    assert!(answer.iterations < 50, "{answer:?}");
    Ok(())
}

/// What a pose loses of the origin far away was taken for exact where a row of the rotation has only one entry; and the
/// error that queries have at hand counted the origin before the translation, though it is the sum of both that is
/// rounded.
#[test]
fn what_a_far_pose_loses_of_a_point_is_in_the_bracket() -> Result<(), InvalidShape> {
    let point = |at: Vec3| Point::new(at);
    let half_turn = Quat::from_xyzw(0.0, 1.0, 0.0, 0.0);
    let far = Vec3::new(-583.533_26, -240.349_65, 775.706_8);
    let a = Posed::translated(point(Vec3::ZERO)?, far)?;
    let b = Posed::new(point(Vec3::new(-8.233_933_5e-12, 1.323_405_7e-8, 2.979_567_5e-8))?, half_turn, far)?;
    let answer = apart(&a, &b);
    let truth = b.shape().core().origin.as_dvec3().length();
    assert!(f64::from(answer.lower) <= truth && truth <= f64::from(answer.upper), "{truth}: {answer:?}");

    let far = Vec2::new(165_809_808.0, 986_157_760.0);
    let at = Vec2::new(0.006_074_533, 3.284_89e-5);
    let a = Posed::translated(Point::new(Vec2::ZERO)?, far)?;
    let b = Posed::new(Point::new(at)?, 3.950_578_2, far)?;
    let (answer, truth) = (apart(&a, &b), at.as_dvec2().length());
    assert!(f64::from(answer.lower) <= truth && truth <= f64::from(answer.upper), "{truth}: {answer:?}");
    Ok(())
}

/// The line across the best plane pierced an edge that lies behind zero, 1.25e-18 from it, and the bound told how far
/// the edge is before zero: nothing.
#[test]
fn an_edge_behind_zero_is_as_far_as_it_is() -> Result<(), InvalidShape> {
    let corners = [
        DVec2::new(4.582751479747291e-5, 0.038289067214102704),
        DVec2::new(-1.7572628109592485e-5, 0.2089944133921629),
        DVec2::new(3.754315033788168e-5, 0.1432985894580348),
    ];
    let triangle = Triangle::new(corners)?;
    let a = Posed::translated(triangle, DVec2::new(-4.5827514797474045e-5, -0.03828906721410414))?;
    // By exact arithmetic.
    let truth = 1.251_728_243_589_071e-18;
    let answer = apart(&a, &Point::new(DVec2::ZERO)?);
    assert!(answer.lower <= truth && truth <= answer.upper, "{answer:?}");
    Ok(())
}

/// Directions between the shortest vector and the best plane were sums of both times both lengths, and each became the
/// plane of the next: after a few their squares underflowed, and a plane across one was said to separate what overlaps
/// by 2e-6.
#[test]
fn a_direction_that_grows_ever_shorter_separates_nothing() -> Result<(), InvalidShape> {
    let turn_a = Quat::from_xyzw(-0.651_411_4, 0.652_148_7, -0.347_488_7, -0.172_095_7);
    let turn_b = Quat::from_xyzw(0.117_534_33, -0.655_705_3, -0.569_412_6, 0.481_669_52);
    let place = Vec3::new(0.577_003_24, 0.464_860_44, 1.238_635_3);
    let capsule = Posed::new(Capsule::<Vec3>::new(0.01, 0.0001)?, turn_a, Vec3::ZERO)?;
    let needle = Ellipsoid::new(Vec3::ZERO, Vec3::new(0.01, 1.455_713_5, 0.01), Quat::IDENTITY)?;
    let needle = Posed::new(needle, turn_b, place)?;
    assert_eq!(meets(&capsule, &needle).decided(), Some(true));
    assert!(apart(&capsule, &needle).overlap);
    Ok(())
}

/// The fast step to an edge had a length of zero by rounding, and was taken for one to a simplex with zero inside,
/// though the edge is 7e-12 away: bodies that are apart were said to overlap, where the search began along an axis of
/// its own.
#[test]
fn an_edge_of_length_zero_by_rounding_is_measured() -> Result<(), InvalidShape> {
    let needle = Cuboid::new(DVec3::new(1.023_901_012_537_984_2, 1e-6, 1e-6))?;
    let plate = Cone::<DVec3>::new(1e-6, 0.001)?;
    let beside = |x: f64| Posed::translated(plate, DVec3::new(x, 0.0, 0.0));
    let far = apart(&needle, &beside(3.0)?);
    let plate = beside(3.0 - (far.distance - 4.0 * f64::EPSILON))?;
    let axis = DVec3::new(-0.655_454_582_257_799_5, -0.919_025_723_088_370_8, 0.0);
    let warm = distance(&needle, &plate, DistanceOptions::new().with_axis(axis));
    assert_eq!((warm.overlap, warm.status), (false, Status::Converged), "{warm:?}");
    assert_eq!(warm.overlap, apart(&needle, &plate).overlap);
    Ok(())
}

/// Edges that cross a millionth apart, along an axis of the box: the offset between them is of the order of their
/// rounding, and a search that went on from there led astray, to "overlap". Gaps are those of the same numbers in
/// double precision.
#[test]
fn a_search_near_contact_that_goes_astray_loses_nothing() -> Result<(), InvalidShape> {
    let cuboid = Cuboid::new(Vec3A::new(1.0, 0.5, 0.25))?;
    for (turn, place, gap) in [
        (
            Quat::from_xyzw(0.120_206_26, -0.947_450_76, 0.237_374_96, 0.177_596_98),
            Vec3A::new(0.609_434_9, 0.949_544_6, -1.053_206_2),
            1.007_973e-6,
        ),
        (
            Quat::from_xyzw(-0.747_735_86, 0.599_54, -0.196_899_31, -0.206_576_13),
            Vec3A::new(0.029_718_11, 0.081_110_24, -0.965_022_6),
            9.709_283e-7,
        ),
        (
            Quat::from_xyzw(0.328_432_1, 0.238_910_6, -0.911_247_97, -0.068_419_52),
            Vec3A::new(0.310_802_7, 0.558_997_4, 1.223_579_4),
            1.016_088e-6,
        ),
    ] {
        let answer = apart(&cuboid, &Posed::new(cuboid, turn, place)?);
        assert!((answer.distance - gap).abs() < 3e-7, "{gap}: {answer:?}");
        assert!(answer.lower <= gap && gap <= answer.upper, "{gap}: {answer:?}");
    }
    Ok(())
}

/// The plane between rounded bodies near contact leans to the vector between the points of their cores by the root of
/// the rounding. The points of the surfaces were taken along the plane's normal, and in `f32` were a thousand times as
/// far apart as the answer said.
#[test]
fn points_near_contact_are_as_far_apart_as_the_bodies() -> Result<(), InvalidShape> {
    let ball = Ball::<Vec2>::new(1_048_576.0)?;
    for i in 0..200_u16 {
        let angle = 0.05 + 0.03 * f32::from(i);
        let ellipse = Ellipsoid::new(Vec2::ZERO, Vec2::new(1.8e6, 9e5), angle)?;
        let toward = Vec2::from_angle(2.0 * angle);
        let spot = toward * (1_048_576.0 + 105.0) - ellipse.support(-toward);
        let d = distance(&Posed::translated(ellipse, spot)?, &ball, DistanceOptions::default());
        let apart = (d.point_a - d.point_b).length();
        // Coordinates of a million are known to a sixteenth.
        assert!(apart <= d.upper + 2.0, "{apart} for {d:?}");
    }
    Ok(())
}

/// `intersects` goes by support points alone, and may come to a stand along an edge where `distance` goes on by the
/// curvature.
#[test]
fn a_flat_triangle_before_the_base_of_a_cone_is_decided() -> Result<(), InvalidShape> {
    let corners = [
        DVec3::new(-1.5510984269739345, 0.3642707710872011, -0.12989127703056713),
        DVec3::new(1.7333569212484456, 0.3953733316784307, 1.313485327096533),
        DVec3::new(1.9092006742171201, 0.17952507966869558, 0.41332590033776606),
    ];
    let matrix = DMat3::from_cols_array_2d(&[
        [-1.3044045873519763, 2.6088091747039526, 0.6119006976802135],
        [-0.8655489905059296, 1.7310979810118592, -1.327946151959019],
        [-1.127860114039723, 2.255720228079446, -0.6825765423779206],
    ]);
    let flat = Affine::new(Triangle::new(corners)?, matrix, DVec3::ZERO)?;
    let flat = Posed::translated(flat, DVec3::new(4.084641418510601, -8.669282847021202, 0.3609464579825218))?;
    let cone = Cone::<DVec3>::new(0.5, 2.0)?;
    let near = distance(&flat, &cone, DistanceOptions::default());
    let decided = intersects(&flat, &cone, IntersectOptions::default());
    assert_eq!((near.overlap, decided.decided()), (false, Some(false)), "{near:?} {decided:?}");
    Ok(())
}

/// Two segments touch end to end. Their closest points say that they meet, and the search that looks closer then began
/// at nothing: where it came to no better plane than its first, the answer was the middles of the two, as points in
/// both, and an infinite upper bound.
#[test]
fn segments_that_touch_end_to_end_have_a_point_in_common() -> Result<(), InvalidShape> {
    for i in 0..2000_u16 {
        let number = |k: u16| (f64::from(i) * 0.37 + 1.9 * f64::from(k)).sin();
        let turn = |k: u16| DQuat::from_xyzw(number(k), number(k + 1) * 0.7, number(k + 2), 0.3).normalize();
        let end = DVec3::new(number(9), number(10), number(11));
        let thin = |half_height: f64, turn: DQuat| {
            let middle = end + turn * DVec3::Y * half_height;
            Posed::new(Capsule::<DVec3>::new(half_height.abs(), 0.0)?, turn, middle)
        };
        let d = distance(&thin(0.5, turn(0))?, &thin(-0.3, turn(4))?, DistanceOptions::default());
        assert!(d.upper < 1e-14 && (d.point_a - d.point_b).length() < 1e-14, "{i}: {d:?}");
    }
    Ok(())
}

/// Deep in one another bodies have a best plane that is opposite to the shortest vector known, and a direction between
/// the two was the plane's own again: the same support point came back, moved by curvature alone, until the iterations
/// were used up. Of 400 pairs of ellipsoids about one point 65 were undecided.
#[test]
fn bodies_about_one_point_are_decided_in_a_few_steps() -> Result<(), InvalidShape> {
    for i in 0..400_u16 {
        let number = |k: u16| (f64::from(i) * 0.37 + 1.9 * f64::from(k)).sin();
        let ellipsoid = |k: u16, turn: DQuat| {
            let axes = DVec3::new(number(k), number(k + 1), number(k + 2)) * 0.25 + DVec3::splat(1.05);
            Ellipsoid::new(DVec3::ZERO, axes, turn)
        };
        let turn = DQuat::from_xyzw(number(6), number(7), number(8), 1.5).normalize();
        let answer = meets(&ellipsoid(0, DQuat::IDENTITY)?, &ellipsoid(3, turn)?);
        assert!(answer.decided() == Some(true) && answer.iterations <= 10, "{i}: {answer:?}");
    }
    Ok(())
}

/// Wide plates 1e-7 and 1e-8 apart that lean by as little. The corner that turns the plane has a share of zero's foot
/// that is the square of the distance, below all rounding, and of the wrong sign as it was computed: the triangle with
/// it was left out, the same corner came again, and the distance ended `Stalled` four times too large, with a lower
/// bound of nothing.
#[test]
fn a_corner_without_a_share_turns_the_plane() -> Result<(), InvalidShape> {
    let wide = |half_height: f64, turn: [f64; 4], translation: [f64; 3]| {
        let plate = Cuboid::new(DVec3::new(50.0, half_height, 50.0))?;
        Posed::new(plate, DQuat::from_array(turn), DVec3::from_array(translation))
    };
    let turn = [0.5820444597602875, -0.7417857061846772, -0.10461855114409915, 0.31628021076090784];
    let a = wide(0.01, turn, [-7.906587022497479, -6.385533881681007, 8.060364971504619])?;
    let turn = [0.582044457137294, -0.7417857082428172, -0.1046185500257156, 0.3162802111308446];
    let b = wide(0.5, turn, [-8.680370587902535, -9.021295183732002, 9.369609721426146])?;
    let turn = [0.5766054383379278, 0.44076347418086886, -0.0675951446416733, 0.6846054518684526];
    let c = wide(0.5, turn, [0.0; 3])?;
    let turn = [0.5766054392185401, 0.4407634730288545, -0.06759514327388298, 0.6846054520035025];
    let d = wide(0.5, turn, [2.407796105095981, 1.5731378683256232, -1.3144411676106214])?;
    for (a, b, gap) in [(&a, &b, 1e-7), (&d, &c, 1e-8)] {
        let answer = distance(a, b, DistanceOptions::default());
        assert!(answer.status == Status::Converged && (answer.distance - gap).abs() < 1e-13, "{answer:?}");
        assert!(answer.lower > gap - 2e-12 && answer.upper < gap + 2e-12, "{answer:?}");
        let signed = signed_distance(a, b, SignedDistanceOptions::default());
        assert!(signed.status == Status::Converged && signed.upper - signed.lower < 2e-12, "{signed:?}");
    }
    Ok(())
}

/// Boxes with integer corners that touch, face to face, along an edge or at a corner. The expanding polytope is flat
/// there and comes to no end: the signed distance of one in five such boxes was `Stalled`, with bounds sixteen times as
/// wide as those of the distance. It asks the same look near contact now as that.
#[test]
fn boxes_that_touch_exactly_are_decided_by_all() -> Result<(), InvalidShape> {
    fn run<V: Vector3>() {
        for i in 0..600_u32 {
            let number = |k: u32, span: u32| f64::from((i * 7919 + k * 104_729 + i * k * 31) % span);
            let half = |k: u32| [0, 1, 2].map(|j| 1.0 + number(k + j, 9));
            let (a, b, from) = (half(0), half(3), [0, 1, 2].map(|j| number(6 + j, 19) - 9.0));
            // Along the first axes they touch, along the others they overlap.
            let to = [0, 1, 2].map(|j: u32| {
                let (reach, k) = (a[j as usize] + b[j as usize], (j + i) % 3);
                let side = if number(9 + j, 2) > 0.5 { reach } else { -reach };
                from[j as usize]
                    + if k <= i / 3 % 3 { side } else { number(12 + j, 2 * reach as u32 - 1) - reach + 1.0 }
            });
            let (a, b) = (at(cuboid::<V>(a), from), at(cuboid::<V>(b), to));
            let answer = apart(&a, &b);
            let signed = signed_distance(&a, &b, SignedDistanceOptions::default());
            let what = format!("{i}: {answer:?} {signed:?}");
            assert!(meets(&a, &b).decided() == Some(true) && answer.overlap && signed.overlap, "{what}");
            assert!(answer.status == Status::Converged && signed.status == Status::Converged, "{what}");
            let zero = s::<V>(0.0);
            assert!(signed.lower <= zero && zero <= signed.upper && answer.lower == zero, "{what}");
            assert!((signed.upper - signed.lower).as_f64() < ulps::<V>(500.0), "{what}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
    Ok(())
}

/// A needle of 5e7 and a point beside it, in `f32`. Of the vector between the closest points rounding is a large part,
/// much of it along the needle, and the plane across it is not one between the bodies: `distance` called them
/// overlapping, though a plane along the needle, across an axis in which its coordinates are small, is certainly
/// between them.
#[test]
fn a_point_beside_a_needle_is_apart_from_it() -> Result<(), InvalidShape> {
    let cases = [
        (
            [[26403326.0, 369612.56, -7326201.0], [-26403330.0, -369618.53, 7326202.0]],
            [-19715054.0, -275_991.7, 5470389.0],
            1.3332590336219297,
        ),
        (
            [[6705881.5, -12119752.0, -51804.043], [-6705878.5, 12119748.0, 51802.637]],
            [4201758.5, -7593977.0, -32460.877],
            3.2193946701657032,
        ),
        (
            [[-134228.67, -6852584.0, -14009518.0], [134233.64, 6852580.0, 14009521.0]],
            [-34216.55, -1746821.0, -3571223.0],
            1.8486390311600485,
        ),
    ];
    for (ends, at, truth) in cases {
        let (needle, point) = (Segment::new(ends.map(Vec3A::from_array))?, Point::new(Vec3A::from_array(at))?);
        let answer = apart(&needle, &point);
        let signed = signed_distance(&needle, &point, SignedDistanceOptions::default());
        let what = format!("{truth}: {answer:?} {signed:?}");
        assert!(!answer.overlap && meets(&needle, &point).decided() == Some(false), "{what}");
        assert!(answer.lower > 0.0 && signed.lower == answer.lower && signed.upper == answer.upper, "{what}");
        assert!(f64::from(answer.lower) < truth && truth < f64::from(answer.upper), "{what}");
    }
    Ok(())
}

/// The normal is that of the plane that proves the distance, and closest points differ along another direction by
/// what is not known of them. With `u` their difference, no longer than `upper` = U, and `n·u` no less than `lower` =
/// L, `|u − s·n|² ≤ U² − 2sL + s²` is at most `2U(U − L)` for an `s` between L and U. Near contact that is far more
/// than rounding: here up to 1e-9 sizes.
#[test]
fn closest_points_lean_from_the_normal_no_more_than_the_bracket_says() {
    let (cone, egg) = (
        Cone::<DVec3>::new(1.0, 0.6).expect("positive"),
        Ellipsoid::<DVec3>::new(DVec3::ZERO, DVec3::new(0.9, 0.5, 0.3), DQuat::IDENTITY).expect("positive"),
    );
    let mut farthest: f64 = 0.0;
    for (i, direction) in directions(24).enumerate() {
        let turn = DQuat::from_xyzw(0.3, direction[0], direction[1], 0.5 + direction[2]).normalize();
        let along = v::<DVec3>(direction);
        let b = turned(egg, turn, [0.0; 3]);
        // Brought into contact along a direction, and back by a gap.
        let start = at(cone, (along * 4.0).to_array());
        let cast = crate::common::sweep(&start, &b, (-along).to_array());
        let Some(hit) = cast.outcome.hit() else { continue };
        for exponent in 1..16 {
            let gap = 10.0_f64.powi(-exponent);
            let a = at(cone, (along * (4.0 - hit.time + gap)).to_array());
            let answer = distance(&a, &b, DistanceOptions::new());
            let Some(normal) = answer.normal else { continue };
            let off = (answer.point_a - answer.point_b - normal * answer.distance).length();
            let leans = (2.0 * answer.upper * (answer.upper - answer.lower)).sqrt();
            let offset = a.core().origin.length() + cone.core().extent + egg.core().extent;
            assert!(off <= leans + 64.0 * f64::EPSILON * offset, "{i} at {gap:e}: {off:e} of {leans:e}, {answer:?}");
            farthest = farthest.max(off);
        }
    }
    assert!(farthest > 1e-12, "rounding alone: {farthest:e}");
}

/// Where bodies overlap by little more than their rounding, the search goes on to the depth, and the ends of its way
/// out are as far apart as the bodies are deep. The points of a distance are of both bodies: those that GJK met.
#[test]
fn bodies_that_overlap_by_little_have_a_point_in_common() {
    let (crate_, block) = (cuboid::<DVec3>([0.9, 0.5, 0.3]), cuboid::<DVec3>([0.4, 0.7, 1.1]));
    let mut deepest: f64 = 0.0;
    for (i, direction) in directions(60).enumerate() {
        let turn = DQuat::from_xyzw(0.3, direction[0], direction[1], 0.5 + direction[2]).normalize();
        let (a, along) = (turned(crate_, turn, [0.0; 3]), v::<DVec3>(direction));
        let place = |far: f64| turned(block, turn.inverse(), (along * far).to_array());
        let cast = crate::common::sweep(&place(5.0), &a, (-along).to_array());
        let Some(hit) = cast.outcome.hit() else { continue };
        for half_decades in 20..32 {
            let b = place(5.0 - hit.time - 10.0_f64.powf(f64::from(-half_decades) * 0.5));
            let answer = distance(&a, &b, DistanceOptions::new());
            let size = b.core().origin.length() + crate_.core().extent + block.core().extent;
            let apart = (answer.point_a - answer.point_b).length();
            assert!(!answer.overlap || apart <= 8.0 * f64::EPSILON * size, "{i}: {apart:e} apart, {answer:?}");
            let signed = signed_distance(&a, &b, SignedDistanceOptions::new());
            deepest = deepest.min(if answer.overlap { signed.upper } else { 0.0 });
        }
    }
    assert!(deepest < -1e-12, "none overlaps: {deepest:e}");
}

/// A search in single precision ends up to a few errors away from the gap of bodies a millionth apart. The closer look
/// knows the gap, but leaves more than its errors between the bounds, and the answer was the search's: off by 2e-6.
#[test]
fn a_gap_near_contact_is_as_it_was_measured_most_closely() -> Result<(), InvalidShape> {
    let poses = [
        ([-0.826_192_26, 0.252_091_74, 0.353_014_17, -0.359_495_67], [-0.467_257_83, 0.045_820_396, 0.865_984_2]),
        ([0.889_390_23, 0.455_205_6, 0.018_213_494, 0.037_962_85], [0.045_366_492, 0.478_735_27, -0.612_753_03]),
    ];
    for (rotation, translation) in poses {
        let (a, b) = ([1.0, 0.6, 0.35], [0.8, 0.5, 0.3]);
        let (q, t) = (Quat::from_array(rotation), Vec3A::from_array(translation));
        let of = |axes: [f32; 3]| Ellipsoid::new(Vec3A::ZERO, Vec3A::from_array(axes), Quat::IDENTITY);
        let single = distance(&of(a)?, &Posed::new(of(b)?, q, t)?, DistanceOptions::default());
        let of = |axes: [f32; 3]| Ellipsoid::new(DVec3::ZERO, Vec3::from_array(axes).as_dvec3(), DQuat::IDENTITY);
        let double = distance(&of(a)?, &Posed::new(of(b)?, q.as_dquat(), t.as_dvec3())?, DistanceOptions::default());
        let off = (f64::from(single.distance) - double.distance).abs();
        assert!(off < 2e-7, "off by {off:e}: {single:?}, {double:?}");
    }
    Ok(())
}

/// All ways to ask for one distance, with the name of each.
fn all_ways<V: Vector>(
    a: &dyn SupportMap<Vector = V>,
    b: &dyn SupportMap<Vector = V>,
) -> Vec<(&'static str, Distance<V>)> {
    let (full, lean) = (DistanceOptions::new(), DistanceOptions::lean());
    let axis = v::<V>([0.125, -0.25, 0.553_902_378_138_323_7]);
    vec![
        ("plain", gjk_raycast::distance(a, b, full)),
        ("swapped", gjk_raycast::distance(b, a, full).reversed()),
        ("by an axis", gjk_raycast::distance(a, b, full.with_axis(axis))),
        ("by the opposite axis", gjk_raycast::distance(a, b, full.with_axis(-axis))),
        ("by signed volumes", gjk_raycast::distance(a, b, full.with_sub_algorithm(SubAlgorithm::SignedVolumes))),
        ("to a tolerance", gjk_raycast::distance(a, b, full.with_tolerance(s::<V>(0.01)))),
        ("by few support points", gjk_raycast::distance(a, b, full.with_max_iterations(5))),
        ("lean", gjk_raycast::distance(a, b, lean)),
        ("lean, by an axis", gjk_raycast::distance(a, b, lean.with_axis(axis))),
    ]
}

/// Holds what all answers about two bodies say of themselves, and against one another.
fn keep_their_word<V: Vector>(a: &dyn SupportMap<Vector = V>, b: &dyn SupportMap<Vector = V>) {
    let zero = V::Scalar::ZERO;
    let (core_a, core_b) = (a.core(), b.core());
    let size = core_a.extent + core_b.extent + core_a.radius + core_b.radius + (core_a.origin - core_b.origin).norm();
    let widest = s::<V>(24.0) * V::Scalar::EPSILON * size + s::<V>(3.0) * (core_a.error + core_b.error);
    let answers = all_ways(a, b);
    for (how, one) in &answers {
        let is_converged = one.status == Status::Converged;
        let width = one.upper - one.lower - if *how == "to a tolerance" { one.lower * s::<V>(0.01) } else { zero };
        assert!(!is_converged || width <= widest * s::<V>(1.001), "{how} is wide: {one:?}");
        assert!(!is_converged || one.overlap != (one.lower > zero), "{how} says both: {one:?}");
        if let Some(n) = one.normal {
            let apart = -(support_value(&a, -n) + support_value(&b, n));
            assert!(apart >= one.lower - widest * s::<V>(2.0), "{how}, the plane does not separate: {one:?} {apart:?}");
        }
        for (other_way, other) in &answers {
            assert!(one.lower <= other.upper, "{how} and {other_way}: {one:?} {other:?}");
            let both = is_converged && other.status == Status::Converged;
            assert!(!both || one.overlap == other.overlap, "{how} and {other_way}: {one:?} {other:?}");
        }
        let meets = gjk_raycast::intersects(a, b, IntersectOptions::default());
        let is_contrary = is_converged && meets.decided().is_some_and(|meets| meets != one.overlap);
        assert!(!is_contrary, "{how}: {one:?} {meets:?}");
    }
}

/// Two thin boxes within rounding of contact overlapped by one axis, and were apart by another, both converged.
#[test]
fn answers_from_any_axis_are_of_one_mind_about_touching() {
    let (a, b) = (DVec3::splat(0.001), DVec3::new(0.377_821_288_258_231_46, 0.740_644_480_695_963_2, 1e-6));
    let place = DVec3::new(1.710_024_408_318_778_8, 2.430_444_967_562_931_6, 2.623_058_628_730_002);
    fn run<V: Vector3>(a: DVec3, b: DVec3, place: DVec3) {
        let [a, b] = [a, b].map(|h| cuboid::<V>(h.to_array()));
        let beside = |place: V| Posed::translated(b, place).expect("finite");
        let place = v::<V>(place.to_array());
        let far = apart(&a, &beside(place));
        for ulps in -8..=8 {
            let gap = far.distance + s::<V>(f64::from(ulps)) * V::Scalar::EPSILON;
            keep_their_word::<V>(&a, &beside(place + far.normal.expect("apart") * gap));
        }
    }
    both(|| run::<Vec3A>(a, b, place), || run::<DVec3>(a, b, place));
}

/// Thin and flat bodies a few ulps apart or in one another: triangles, sheets and needles of ellipsoids, cones, hulls.
#[test]
fn thin_bodies_near_contact_keep_their_word() {
    fn run<V: Vector3>() {
        for seed in 0..60_u32 {
            let thin = |k: u32| [1.0, 1e-3, 1e-6][(seed / k % 3) as usize];
            let sizes = [0.5 + 0.01 * f64::from(seed), 0.7 * thin(1), 0.9 * thin(3)];
            let turn = quaternion::<V>([0.1, 0.2 + 0.01 * f64::from(seed), -0.3, 0.9]);
            let shapes: [Box<dyn SupportMap<Vector = V>>; 6] = [
                Box::new(Ellipsoid::new(V::ZERO, v(sizes), turn).expect("positive")),
                Box::new(turned(Cone::<V>::new(s::<V>(sizes[0]), s::<V>(sizes[1])).expect("positive"), turn, [0.0; 3])),
                Box::new(turned(cuboid::<V>(sizes), turn, [0.0; 3])),
                Box::new(hull::<V>(seed, 9, sizes[1], [0.0; 3])),
                Box::new(
                    Triangle::new([v::<V>([1.0, 0.5, 0.0]), v([-1.0, 0.25, 0.0]), v([0.0, -1.0, 0.5])])
                        .expect("finite"),
                ),
                Box::new(Ball::<V>::new(s::<V>(8.0 * sizes[2])).expect("positive")),
            ];
            let [a, b] = [&shapes[(seed % 6) as usize], &shapes[((seed + 1 + seed / 6 % 5) % 6) as usize]];
            let beside = |place: V| Posed::translated(b, place).expect("finite");
            let place = v::<V>([0.3 * f64::from(seed % 7) - 0.9, 1.7, 0.2 * f64::from(seed % 5) - 0.4]);
            let far = distance(a, &beside(place), DistanceOptions::default());
            let Some(n) = far.normal else { continue };
            for ulps in [-300, -5, -1, 0, 1, 4, 40] {
                let gap = far.distance + s::<V>(f64::from(ulps)) * V::Scalar::EPSILON;
                keep_their_word::<V>(a, &beside(place + n * gap));
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// The vector between a point and a thin ellipsoid 340ε apart is off by a hundredth of a degree, and the plane across
/// it by more than the gap: curvature tells the plane in a few steps, where 127 did not.
#[test]
fn a_vector_too_short_for_a_direction_does_not_stall_a_search() {
    let turn = DQuat::from_xyzw(
        0.065_145_101_227_752_2,
        -0.916_796_069_670_066_3,
        -0.303_487_021_009_378_74,
        0.251_270_194_218_092_5,
    );
    let sizes = DVec3::new(0.409_505_675_284_039, 0.000_486_127_098_654_866_33, 0.693_377_603_844_427_3);
    let place = DVec3::new(-0.045_144_901_755_681_84, -0.050_138_270_160_228_51, 0.072_035_622_733_137_02);
    let ellipsoid = Ellipsoid::new(DVec3::ZERO, sizes, DQuat::IDENTITY).expect("positive");
    let there = Posed::new(ellipsoid, turn, place).expect("finite");
    let point = Point::new(DVec3::ZERO).expect("finite");
    let answer = distance(&point, &there, DistanceOptions::default());
    assert!(answer.status == Status::Converged && answer.iterations <= 16, "{answer:?}");
    assert!(answer.lower > 0.0 && answer.upper < 1e-13, "{answer:?}");
}

/// How deep bodies are takes dozens of support points, that they overlap a few.
#[test]
fn that_concentric_cylinders_overlap_takes_few_support_points() {
    let cylinder = Cylinder::<DVec3>::new(1.0, 1.0).expect("positive");
    let answer = distance(&cylinder, &cylinder, DistanceOptions::default());
    assert!(answer.overlap && answer.status == Status::Converged && answer.iterations <= 16, "{answer:?}");
}

/// No distance is negative, so that a negative limit asks for no less than whether there is one.
#[test]
fn a_negative_limit_is_none_at_contact() {
    let (a, b) = (cuboid::<DVec3>([1.0; 3]), at(cuboid::<DVec3>([1.0; 3]), [1.5, 0.0, 0.0]));
    let answer = distance(&a, &b, DistanceOptions::new().with_limit(-1.0));
    assert!(answer.overlap && answer.upper == 0.0, "{answer:?}");
}
