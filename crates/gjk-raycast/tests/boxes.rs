//! Whether boxes meet, by the axes that may separate them, against the signed distance of shapes that do not say that
//! they are boxes.

use crate::common::behind_pointers::{intersects, signed_distance};
use crate::common::{Plain, Random, s};
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec3, Vec3A};
use convex_support::{Affine, Cuboid, Matrix, Posed, Scalar, SupportMap, Vector};
use gjk_raycast::{IntersectOptions, SignedDistanceOptions, Status};

fn within<V: Vector>(random: &mut Random, size: f64) -> V {
    V::from_fn(|_| s::<V>(random.number(-size, size)))
}

fn gap<V: Vector>(a: &impl SupportMap<Vector = V>, b: &impl SupportMap<Vector = V>) -> [V::Scalar; 2] {
    let known = signed_distance(&Plain(a), &Plain(b), SignedDistanceOptions::default());
    [known.lower, known.upper]
}

/// What is claimed, against the bracket of the signed distance; and how many claims took no search.
fn claims<V: Vector>(seed: u64, turn: impl Fn(&mut Random, f64) -> V::Rotation) {
    let mut random = Random(seed);
    let mut counts = [0; 2];
    let mut searched = 0;
    for round in 0..6000 {
        let thin = [1.0_f64, 0.1, 1e-3, 1e-6][round % 4];
        let scale = [1.0, 1e-6, 1e6][round % 3];
        let lean = [1.0, 1e-3, 1e-6, 1e-9, 0.0][round / 4 % 5];
        let cuboid = |random: &mut Random| {
            let half = V::from_fn(|_| s::<V>(random.number(thin.ln(), 0.0).exp() * scale));
            Cuboid::new(half).expect("positive")
        };
        let (a, b) = (cuboid(&mut random), cuboid(&mut random));
        let both = turn(&mut random, 3.0);
        let (turn_a, turn_b) = (turn(&mut random, lean), turn(&mut random, lean));
        let place = |shape, rotation, at: V| {
            let posed = Posed::new(shape, rotation, at).expect("a pose");
            Posed::new(posed, both, V::axis(0) * s::<V>(scale)).expect("a pose")
        };
        let (first, at) = (place(a, turn_a, V::ZERO), within::<V>(&mut random, 2.0 * scale));
        // So that the bodies nearly touch, moved by what lies between them but for a little.
        let second = |at: V| place(b, turn_b, at);
        let known = signed_distance(&Plain(&first), &Plain(&second(at)), SignedDistanceOptions::default());
        let rest = [0.3, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0.0][round % 7] * random.number(-1.0, 1.0) * scale;
        let way = Posed::new(Cuboid::new(V::ONE).expect("positive"), both, V::ZERO).expect("a pose");
        let local = V::from_fn(|i| known.normal.dot(way.rotation() * V::axis(i)));
        let second = second(at + local * (known.signed_distance - s::<V>(rest)));

        let [lower, upper] = gap(&first, &second);
        let answer = intersects(&first, &second, IntersectOptions::default());
        if answer.iterations > 1 {
            // Within an error of contact; other tests ask such pairs.
            searched += 1;
            continue;
        }
        assert_eq!(answer.status, Status::Converged, "{answer:?}");
        counts[usize::from(answer.overlap)] += 1;
        if answer.overlap {
            assert!(lower <= s::<V>(0.0), "{lower:?} {upper:?} {answer:?}\n{first:?}\n{second:?}");
        } else {
            assert!(upper >= s::<V>(0.0), "{lower:?} {upper:?} {answer:?}\n{first:?}\n{second:?}");
            let n = answer.axis.expect("apart, so there is an axis");
            let size = (a.half_extents() + b.half_extents()).norm() + at.norm() + s::<V>(2.0 * scale);
            let apart = n.dot(first.support(-n) - second.support(n));
            assert!(apart >= -size * V::Scalar::EPSILON * s::<V>(64.0), "{apart:?} {answer:?}\n{first:?}\n{second:?}");
        }
    }
    assert!(counts.iter().all(|&count| count > 800) && searched < 4000, "{counts:?}, {searched} searched");
}

#[test]
fn boxes_in_space() {
    claims::<DVec3>(0x9E37_79B9_7F4A_7C15, |random, angle| DQuat::from_scaled_axis(within(random, angle)));
}

#[test]
fn boxes_in_single_precision() {
    claims::<Vec3A>(0xD1B5_4A32_D192_ED03, |random, angle| Quat::from_scaled_axis(within::<Vec3>(random, angle)));
}

#[test]
fn rectangles_in_the_plane() {
    claims::<DVec2>(0x94D0_49BB_1331_11EB, |random, angle| random.number(-angle, angle));
}

/// Boxes on a lattice, whose edges are parallel to the last bit, and sheared ones, whose are not orthogonal.
#[test]
fn aligned_and_sheared_boxes() {
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    for round in 0..2000 {
        let a = Cuboid::new(DVec3::new(1.0, 2.0, 3.0)).expect("positive");
        let shear = [0.0, 1e-13, 1e-6, 0.3][round % 4];
        let matrix = Matrix::from_cols_fn(|i| <DVec3 as Vector>::axis(i) + within::<DVec3>(&mut random, shear));
        let at = <DVec3 as Vector>::from_fn(|_| random.number(-6.0, 6.0).round());
        let b = Affine::new(Cuboid::new(DVec3::ONE).expect("positive"), matrix, at).expect("a map");
        for (first, second) in
            [(&a as &dyn SupportMap<Vector = DVec3>, &b as &dyn SupportMap<Vector = DVec3>), (&b, &a)]
        {
            let answer = intersects(&first, &second, IntersectOptions::default());
            let [lower, upper] = gap(&first, &second);
            assert_eq!(answer.status, Status::Converged, "{answer:?}");
            assert!(if answer.overlap { lower <= 0.0 } else { upper >= 0.0 }, "{lower} {upper} {answer:?} {at}");
        }
    }
}
