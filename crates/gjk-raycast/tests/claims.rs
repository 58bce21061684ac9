//! What answers say of themselves is so, for shapes of every kind.

use convex_support::strategies::{AnyShape, combined, pose, primitive, primitive_3d};
use convex_support::{Ball, Posed, Scalar, Vector, glam};
use gjk_raycast::Ray;
use gjk_raycast::laws::{self, Law, PairPlanes};
use proptest::prelude::*;

type Shape<V> = Posed<AnyShape<V>>;

/// A shape of a size near one, posed near zero.
fn posed<V: Vector>(shape: BoxedStrategy<AnyShape<V>>) -> BoxedStrategy<Shape<V>> {
    let one = V::Scalar::ONE;
    let combined = combined(shape.clone(), one);
    (prop_oneof![2 => shape, 1 => combined], pose(one))
        .prop_map(|(shape, (rotation, translation))| Posed::new(shape, rotation, translation).expect("a pose"))
        .boxed()
}

#[test]
fn answers_keep_their_word_in_the_plane() {
    laws::hold(32, posed::<glam::DVec2>(primitive(1.0)), posed(primitive(1.0)));
    laws::hold(32, posed::<glam::Vec2>(primitive(1.0)), posed(primitive(1.0)));
}

#[test]
fn answers_keep_their_word_in_space() {
    laws::hold(32, posed::<glam::DVec3>(primitive_3d(1.0)), posed(primitive_3d(1.0)));
    laws::hold(32, posed::<glam::Vec3A>(primitive_3d(1.0)), posed(primitive_3d(1.0)));
}

/// Planes that have every point before them by the same length.
struct Everywhere(f64);

impl laws::Planes for Everywhere {
    fn beyond(&self, _: laws::Numbers, _: &[laws::Term]) -> [f64; 2] {
        [self.0; 2]
    }
}

/// The laws believe their planes, and no answer: of bodies that the planes have farther apart, or nearer, no bound and no
/// point is accepted.
#[test]
fn planes_refute_bounds_points_and_hits() {
    let ball = Ball::<glam::DVec3>::new(1.0).expect("a radius");
    let beside = Posed::translated(ball, glam::DVec3::X * 3.0).expect("finite");
    for (apart, law) in [(1.5, Law::Bound), (0.5, Law::Points)] {
        let planes = Everywhere(apart);
        let report = laws::pair_judged(&ball, &beside, &[], PairPlanes { a: &planes, b: &planes, apart: &planes });
        assert!(report.broken.iter().any(|broken| broken.law == law), "{apart}: {report}");
    }
    let ray = Ray { source: glam::DVec3::X * 3.0, direction: glam::DVec3::NEG_X };
    let missed = laws::ray_judged(&ball, ray, Default::default(), &[], &Everywhere(1.0));
    assert!(missed.broken.iter().any(|broken| broken.law == Law::Bound), "{missed}");
    let right = laws::pair(&ball, &beside, &[glam::DVec3::Y]);
    assert!(right.broken.is_empty() && right.examined > 50, "{right}");
}
