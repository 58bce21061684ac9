//! What answers say of themselves is so, for shapes of every kind.

use convex_support::strategies::{AnyShape, combined, pose, primitive, primitive_3d};
use convex_support::{Ball, Cuboid, Posed, Scalar, Vector, glam};
use gjk_raycast::laws::{self, Law, PairPlanes};
use gjk_raycast::{MotionCastOptions, Ray, RigidMotion};
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

/// A square on another one turns about a point near the middle of their contact, where its speed is far from that of its
/// corner; and one beside another moves into it as it turns, where a lean search knows no plane at the start.
#[test]
fn motions_from_contact_are_converged_only_where_the_bracket_is_narrow() {
    let square = |half: glam::DVec2| Cuboid::new(half).expect("half extents");
    let (one, wide) = (square(glam::DVec2::ONE), square(glam::DVec2::new(3.0, 1.0)));
    let on_top = Posed::translated(one, glam::DVec2::new(0.3, 2.0)).expect("finite");
    let beside = Posed::translated(one, glam::DVec2::new(2.0, 0.5)).expect("finite");
    let rest = RigidMotion::default();
    let options = MotionCastOptions::default().with_max_time(2.0);
    for beside_the_middle in [1e-2, 1e-5, 1e-8] {
        let turn = RigidMotion::rotation(-1.0, glam::DVec2::new(0.225 - beside_the_middle, 1.0));
        let report = laws::motion_cast(&on_top, turn, &wide, rest, options, &[]);
        assert!(report.broken.is_empty(), "{beside_the_middle}: {report}");
    }
    let into = RigidMotion { velocity: glam::DVec2::X, angular_velocity: 1.0, center: glam::DVec2::ZERO };
    let report = laws::motion_cast(&one, into, &beside, rest, options, &[]);
    assert!(report.broken.is_empty(), "{report}");
}
