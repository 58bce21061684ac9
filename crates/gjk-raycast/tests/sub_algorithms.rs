//! The ways to find the closest point of a simplex agree, on easy simplices and on flat ones.

use crate::common::{directions, quaternion, s, turned, ulps, v};
use convex_support::glam::{DQuat, DVec3, Vec3A};
use convex_support::{
    Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Polytope, Posed, Scalar, SupportMap, Vector, Vector3,
};
use gjk_raycast::{DistanceOptions, Ray, RayCastOptions, Status, SubAlgorithm, distance, ray_cast};
use proptest::prelude::*;

const ALL: [SubAlgorithm; 4] =
    [SubAlgorithm::Regions, SubAlgorithm::NearestFace, SubAlgorithm::Johnson, SubAlgorithm::SignedVolumes];

fn point(flat: f64) -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(move |(x, y, z)| DVec3::new(x, y, flat * z))
}

/// Clouds from solid to flat to within rounding.
fn cloud() -> impl Strategy<Value = Vec<DVec3>> {
    prop_oneof![Just(1.0), Just(1e-6), Just(1e-12), Just(0.0)]
        .prop_flat_map(|flat| prop::collection::vec(point(flat), 1..9))
}

fn agree<V: Vector>(
    a: &[DVec3],
    b: &[DVec3],
    offset: DVec3,
    to: impl Fn(DVec3) -> V,
    tolerance: f64,
) -> Result<(), TestCaseError> {
    let hull = |points: &[DVec3], offset: DVec3| Polytope::new(points.iter().map(|&p| to(p + offset)));
    let (a, b) = (hull(a, DVec3::ZERO).expect("finite"), hull(b, offset).expect("finite"));
    let answers = ALL.map(|s| distance(&a, &b, DistanceOptions::new().with_sub_algorithm(s)));
    for answer in &answers {
        let off = (answer.distance - answers[0].distance).as_f64().abs();
        prop_assert!(off <= tolerance, "{:?} against {:?}", answer, answers[0]);
    }
    let ray = Ray { source: to(offset * 3.0), direction: to(-offset) };
    let casts = ALL.map(|s| ray_cast(&a, ray, RayCastOptions::new().with_sub_algorithm(s)));
    for cast in casts.iter().flatten() {
        prop_assert_eq!(cast.status, Status::Converged);
    }
    Ok(())
}

proptest! {
    #![proptest_config(convex_support::laws::config(300))]

    #[test]
    fn they_agree(a in cloud(), b in cloud(), offset in point(1.0)) {
        prop_assume!(offset.length() > 0.1);
        agree(&a, &b, offset * 2.0, |p| p, 1e-13)?;
        agree(&a, &b, offset * 2.0, |p| p.as_vec3a(), 1e-4)?;
    }
}

#[test]
fn all_converge_on_a_face_seen_at_an_angle() -> Result<(), InvalidShape> {
    let still = Cuboid::new(DVec3::new(3.0, 1.0, 2.0))?;
    let moved = Posed::new(Cuboid::new(DVec3::ONE)?, DQuat::from_rotation_z(0.3), DVec3::new(0.2, 3.0, 0.1))?;
    for sub_algorithm in ALL {
        let answer = distance(&moved, &still, DistanceOptions::new().with_sub_algorithm(sub_algorithm));
        let corner = 2.0 - 2.0_f64.sqrt() * (std::f64::consts::FRAC_PI_4 - 0.3).cos();
        assert!((answer.distance - corner).abs() < 1e-14, "{sub_algorithm:?}: {answer:?}");
        assert_eq!(answer.status, Status::Converged, "{sub_algorithm:?}");
    }
    Ok(())
}

/// On curved bodies the planes are turned by Newton's method, whose support points need not bring the simplex nearer.
/// Only the default took steps between such turns; the others fell back to linear convergence, a hundred support points
/// in place of ten, and Johnson's determinants, from products less products, took faces in single precision that were
/// no nearer at all.
#[test]
fn curved_bodies_take_as_few_steps_by_each() {
    fn run<V: Vector3>() {
        let n = s::<V>;
        let cylinder: Box<dyn SupportMap<Vector = V>> = Box::new(Cylinder::<V>::new(n(1.0), n(0.5)).expect("positive"));
        let ellipsoid = Ellipsoid::new(V::ZERO, v::<V>([1.0, 0.6, 0.3]), quaternion::<V>([0.0, 0.0, 0.0, 1.0]));
        for (name, body) in [("cylinder", cylinder), ("ellipsoid", Box::new(ellipsoid.expect("positive")))] {
            let mut steps = [0; ALL.len()];
            for (i, d) in directions(200).enumerate() {
                let t = i as f64;
                let turn = quaternion::<V>([(1.1 * t).sin(), (1.7 * t).sin(), (2.3 * t).sin(), 1.5]);
                let gap = 1.5 + (0.7 * t).sin().abs();
                let cone = turned(Cone::<V>::new(n(0.75), n(0.6)).expect("positive"), turn, d.map(|c| gap * c));
                let answers = ALL.map(|by| distance(&cone, &body, DistanceOptions::new().with_sub_algorithm(by)));
                for (answer, steps) in answers.iter().zip(&mut steps) {
                    *steps += answer.iterations;
                    let off = (answer.distance - answers[0].distance).as_f64().abs();
                    assert!(off <= ulps::<V>(64.0), "{name} {i}: {answer:?} against {:?}", answers[0]);
                }
            }
            assert!(steps.iter().all(|&by| 10 * by <= 12 * steps[0]), "{name}: {steps:?}");
        }
    }
    run::<Vec3A>();
    run::<DVec3>();
}
