//! What shapes say of their rounding, against a hundred digits: the claimed error covers the true one, and not by much
//! more than it must.

use crate::exact::{Fixed, Random, Space, Tree, dot, norm};
use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{Core, Cuboid, Hint, MinkowskiSum, Posed, Rounding, Scalar, SupportMap, Vector};

fn fixed<V: Vector>(v: V) -> [Fixed; 3] {
    [0, 1, 2].map(|i| Fixed::from_f64(if i < V::DIM { v.get(i).as_f64() } else { 0.0 }))
}

/// How much of the claimed error is used, along `n` and for the support point along `n` as seen along others.
fn share_used<V: Space>(tree: &Tree, random: &mut Random) -> f64 {
    let shape = tree.build::<V>();
    let (Core { origin, radius, error: length, .. }, Rounding { extent, error, error_length }) =
        (shape.core(), shape.rounding());
    let vector = |v: [f64; 3]| V::from_fn(|i| V::Scalar::from_f64(v[i]));
    let mut most = 0.0f64;
    for _ in 0..4 {
        let [d, other] = [random.direction(), random.direction()];
        let k = shape.core_support(vector(d), &mut Hint::new());
        for i in 0..V::DIM {
            let reach = num_traits::Float::abs(k.get(i));
            assert!(reach <= extent.get(i), "coordinate {i} of {k:?} is beyond {extent:?}: {tree:?}");
        }
        for (n, is_farthest) in [(d, true), (other, false)] {
            let n = n.map(Fixed::from_f64);
            let found = dot(&n, &fixed(origin)) + dot(&n, &fixed(k)) + Fixed::from_f64(radius.as_f64()) * norm(&n);
            let missing = tree.support_value(&n, V::DIM) - found;
            // No point is beyond the set, and the one that was asked for is not short of it.
            let wrong = if is_farthest { missing.abs() } else { (-missing).max(Fixed::zero()) };
            let by_coordinates = dot(&n.clone().map(Fixed::abs), &fixed(error));
            let by_length = Fixed::from_f64(error_length.as_f64()) * norm(&n);
            let claimed = by_coordinates.min(by_length);
            // 2⁻⁴⁸⁰ for the roundings of the hundred digits.
            let slack = Fixed::from_f64(2f64.powi(-480));
            assert!(
                wrong <= claimed.clone() + slack,
                "{:e} is more than {:e} along {n:?} of {tree:?}",
                wrong.as_f64(),
                claimed.as_f64()
            );
            let at_hand = Fixed::from_f64(length.as_f64()) * norm(&n) + Fixed::from_f64(2f64.powi(-480));
            assert!(
                wrong <= at_hand.clone(),
                "{:e} is more than the {:e} at hand along {n:?} of {tree:?}",
                wrong.as_f64(),
                at_hand.as_f64()
            );
            most = most.max(wrong.as_f64() / (claimed.as_f64() + f64::MIN_POSITIVE));
        }
    }
    most
}

fn covers<V: Space>(seed: u64, trees: usize) {
    let mut random = Random::new::<V>(seed);
    let mut used = Vec::new();
    for i in 0..trees {
        let depth = i % 5;
        let tree = random.tree(depth);
        used.push(share_used::<V>(&tree, &mut random));
    }
    used.sort_by(f64::total_cmp);
    // A bound of hundreds of errors would be right, and of no use.
    let median = used[trees / 2];
    assert!(median > 0.01, "in {} the claims are {} times too wide", std::any::type_name::<V>(), 1.0 / median);
}

#[test]
fn claimed_errors_cover_true_ones_in_double_precision() {
    covers::<DVec3>(1, 1500);
    covers::<DVec2>(2, 400);
}

#[test]
fn claimed_errors_cover_true_ones_in_single_precision() {
    covers::<Vec3A>(3, 1000);
    covers::<Vec3>(4, 500);
    covers::<Vec2>(5, 400);
}

#[test]
fn sixty_rotations_cost_sixty_errors() {
    let mut random = Random::new::<DVec3>(6);
    for _ in 0..20 {
        let tree = random.turned(60);
        share_used::<DVec3>(&tree, &mut random);
        let shape = tree.build::<DVec3>();
        let Rounding { error, error_length, extent } = shape.rounding();
        let Core { origin, extent: size, .. } = shape.core();
        // Origins within some 60 · 3 of zero are turned again and again.
        let allowed = 60.0 * 60.0 * f64::EPSILON * (size + origin.length() + 200.0);
        assert!(error_length <= allowed && error.max_element() <= allowed, "{error_length:e}, {error}");
        assert!(extent.max_element() <= 1.01 * size + 1e-9, "{extent} of {size}");
    }
}

#[test]
fn numbers_that_are_given_are_exact() {
    let floor = Cuboid::new(DVec3::new(5000.0, 1.0, 5000.0)).expect("a floor");
    let exact = Rounding::exact(DVec3::new(5000.0, 1.0, 5000.0));
    assert_eq!(floor.rounding(), exact);
    let placed = Posed::new(floor, DQuat::IDENTITY, DVec3::new(0.1, -1.0, 1e9)).expect("a pose");
    assert_eq!(placed.rounding().error, DVec3::ZERO, "moved, but not turned");
    let upright = Posed::new(floor, DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8), DVec3::NEG_Y).expect("a pose");
    let Rounding { error, extent, .. } = upright.rounding();
    assert_eq!((error.y, extent.y.round()), (0.0, 1.0), "turned about the vertical");
    assert!(error.x > 0.0 && error.x < 1e-10, "{error}");
    let two = MinkowskiSum::new(floor, Cuboid::new(DVec3::ZERO).expect("a point"));
    assert_eq!(two.rounding().error, DVec3::ZERO, "nothing was added");
}

/// A cuboid far away, turned back to where it came from: what its pose loses is known to a few ulps of its size and of
/// the turn.
#[test]
fn what_a_far_origin_loses_stays_with_the_core() {
    let away = Posed::translated(Cuboid::new(DVec3::ONE).expect("a box"), DVec3::new(1e6, 1e5, -1e4)).expect("away");
    let q = DQuat::from_xyzw(0.1, 0.7, -0.3, 0.4);
    let there = Posed::new(away, q, DVec3::ZERO).expect("turned");
    let back = Posed::translated(there, -there.core().origin + DVec3::ONE).expect("and back");
    // What the origin was rounded by is of the size of an ulp of 1e6, and kept.
    let error = back.rounding().error.max_element();
    let ulp = 1e6 * f64::EPSILON;
    assert!(error < 40.0 * ulp, "{error:e}");
    let core = back.core();
    let middle = back.core_support(DVec3::ONE, &mut Hint::new()) + back.core_support(DVec3::NEG_ONE, &mut Hint::new());
    assert!((core.origin + middle * 0.5 - DVec3::ONE).length() <= 4.0 * ulp, "{middle}");
}
