//! What answers say of themselves is so, for shapes of every kind.

use convex_support::strategies::{AnyShape, combined, pose, primitive, primitive_3d};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Hull, Matrix, MinkowskiSum, Point, Posed, Scalar,
    Segment, SupportMap, Vector, glam,
};
use gjk_raycast::laws::{self, Law, PairPlanes};
use gjk_raycast::{LinearCastOptions, Motion, MotionCastOptions, Ray, RigidMotion, StartInContact};
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

/// The laws believe their planes, and no answer: of bodies that the planes have farther apart, or nearer, no bound and
/// no point is accepted.
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

/// A square on another one turns about a point near the middle of their contact, where its speed is far from that of
/// its corner; and one beside another moves into it as it turns, where a lean search knows no plane at the start.
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

/// Holds rays to the laws that reach a point after `back` times a direction.
fn rays_to<V: Vector>(target: &dyn SupportMap<Vector = V>, at: V, direction: V) {
    let number = V::Scalar::from_f64;
    let starts = [V::axis(0), V::axis(1), V::from_fn(|i| number([0.5, -0.25, 0.125][i]))];
    for back in 1..20 {
        let ray = Ray { source: at - direction * number(f64::from(back) * 1.37), direction };
        let report = laws::ray(target, ray, Default::default(), &starts);
        assert!(report.broken.is_empty(), "{ray:?}: {report}");
    }
}

/// At an edge the ray runs nearly along one of two faces. The plane of that face alone tells neither how far the ray is
/// from the body at its lower bound, nor whether it is still in it at the upper one.
#[test]
fn rays_at_an_edge_beside_a_face_are_converged_only_where_both_bounds_are_near() {
    fn of<V: Vector>(slopes: [f64; 3]) {
        let vector = |v: [f64; 3]| V::from_fn(|i| V::Scalar::from_f64(v[i]));
        let cuboid = Cuboid::new(vector([3.0, 2.0, 3.0])).expect("half extents");
        for slope in slopes.into_iter().flat_map(|slope| [slope, -slope]) {
            for off in [0.0, 1.0, -3.0, 8.0].map(|ulps| ulps * V::Scalar::EPSILON.as_f64()) {
                rays_to(&cuboid, vector([-3.0 + off, -2.0, 0.1]), vector([slope, 1.0, 0.0]));
            }
        }
    }
    of::<glam::DVec3>([1e-3, 2e-6, 1e-10]);
    of::<glam::Vec3A>([1e-2, 3e-5, 1e-6]);
    of::<glam::DVec2>([1e-3, 2e-6, 1e-10]);
    of::<glam::Vec2>([1e-2, 3e-5, 1e-6]);
}

/// A ray that runs through a sharp corner, and out again, within rounding.
#[test]
fn rays_through_a_corner_are_converged_only_where_they_have_not_left() {
    type V = glam::Vec2;
    let segment = Segment::new([V::new(0.749_297, -0.305_620_96), V::new(-0.088_882_95, 0.354_381_77)]);
    let matrix = <V as Vector>::Matrix::from_cols_fn(|j| {
        [V::new(0.689_044, -0.775_327_4), V::new(-0.750_431_7, 0.842_550_3)][j]
    });
    let bar = Posed::new(segment.expect("finite"), -1.812_407_4, V::new(0.632_149_1, 0.343_251_23)).expect("finite");
    let bar = Affine::new(bar, matrix, V::new(-0.385_123_38, 0.999_254_1)).expect("finite");
    let plate = Cuboid::new(V::new(0.001_917_535_8, 0.985_329_45)).expect("half extents");
    let target = Difference::new(plate, bar);
    rays_to(&target, V::new(-0.045_399_427, 0.468_989_6), V::new(26.279_907, -0.156_605_28));
}

/// A miss has all of a ray that ends before an edge on one side of its plane, which so faces the ray.
#[test]
fn rays_that_end_before_an_edge_miss_by_a_plane_that_faces_them() {
    fn of<V: Vector>(target: &dyn SupportMap<Vector = V>, at: [f64; 3], across: usize) {
        for slope in [1.0, 0.1, 1e-3, -1e-3, 1e-6] {
            let mut direction = [0.0; 3];
            (direction[1], direction[across]) = (at[1].signum() * slope, -at[across].signum());
            rays_to(
                target,
                V::from_fn(|i| V::Scalar::from_f64(at[i])),
                V::from_fn(|i| V::Scalar::from_f64(direction[i])),
            );
        }
    }
    let [r, h] = [0.512_463_420_526_764_3, 0.531_997_361_682_791_7];
    for at in [[0.0, -h, r], [0.6 * r, -h, -0.8 * r]] {
        of(&Cone::<glam::DVec3>::new(h, r).expect("a cone"), at, 2);
        of(&Cylinder::<glam::DVec3>::new(h, r).expect("a cylinder"), at, 2);
        of(&Cylinder::<glam::DVec3>::new(h, r).expect("a cylinder"), at.map(|x| -x), 2);
    }
    of(&Cuboid::new(glam::DVec2::new(r, h)).expect("a cuboid"), [r, -h, 0.0], 0);
    of(&Cuboid::new(glam::DVec3::new(r, h, 1.0)).expect("a cuboid"), [-r, h, 0.1], 0);
}

/// A ball of 6e-6 rolls in a body of size 3, so that in single precision the step to the normal at the ray is rounding:
/// a warm ray has the normal of the plane that was found instead.
#[test]
fn a_warm_ray_at_an_edge_rounded_by_little_has_the_normal_of_its_plane() {
    type V = glam::Vec3A;
    let v = |x: [f64; 3]| V::from_array(x.map(Scalar::from_f64));
    let turn = glam::DQuat::from_xyzw(1.1352131618357415, -0.5420584280089376, 1.3625661802655396, 0.529924824030819);
    let point = Point::new(v([-0.4497745875519328, -0.1468400966199075, -0.6532257271557929])).expect("finite");
    let at = v([-0.16191844453482784, -0.6914726140066936, -0.375344655979136]);
    let point = Posed::new(point, turn.as_quat(), at).expect("a pose");
    let round = MinkowskiSum::new(
        Cylinder::<V>::new(0.6787931, 0.87845606).expect("a cylinder"),
        Capsule::<V>::new(0.657_739_75, 6.1417694e-6).expect("a capsule"),
    );
    let ends = [
        [-0.29643369438490086, -0.21013971066001624, -0.9038552930178623],
        [-0.7888121973193714, 0.7171845927341274, 0.059523085326811165],
    ];
    let cube = Cuboid::new(v([0.11958428701250608, 0.29118679146658516, 0.0845260690355983])).expect("a cuboid");
    let hull = Hull::new(Segment::new(ends.map(v)).expect("finite"), cube);
    let target = Difference::new(point, MinkowskiSum::new(round, hull));
    let source = v([-0.9033704518919887, -1.2720737269634255, 2.844134495987783]);
    let ray = Ray { source, direction: v([0.5415308518919888, 0.000547426963425357, -1.9978820959877828]) };
    let starts = [v([1.0, 0.0, 0.0]), v([0.5, -0.25, 0.125]), v([0.0, 1.0, 0.0]), v([-0.7, 0.3, 0.2])];
    let report = laws::ray(&target, ray, Default::default(), &starts);
    assert!(report.broken.is_empty(), "{report}");
}

/// A ball of 2⁻²⁴ slides along a segment that it touches to rounding: of two planes with nearly opposite normals the
/// one through the crossing of their lines is far behind the start, and the miss is told by the one that is left.
#[test]
fn a_speck_that_slides_along_a_segment_misses_by_a_plane_at_the_start() {
    type V = glam::Vec2;
    let speck = Posed::translated(Ball::<V>::new(5.960_464_5e-8).expect("a ball"), V::new(-2.0, 0.0)).expect("finite");
    let segment = Segment::new([V::new(-0.473_946_32, -2.623_388_8), V::new(2.636_861, 0.491_188_8)]);
    let segment = Posed::translated(segment.expect("finite"), V::new(-2.075_654, 2.073_128_8)).expect("finite");
    let motion =
        Motion { velocity_a: V::new(0.378_194_24, -1.831_468_6), velocity_b: V::new(2.175_593_6, -2.182_592_2) };
    let options = LinearCastOptions::default().with_start_in_contact(StartInContact::IfDeeper);
    let report = laws::linear_cast(&speck, &segment, motion, options, &[V::X, V::new(0.5, -0.25)]);
    assert!(report.broken.is_empty(), "{report}");
}

/// A point leaves the end of a capsule that is nearly along its way, both far from the origin of the world: no plane
/// across the way keeps them apart, and the miss is told by the plane through both that does.
#[test]
fn bodies_that_never_get_deeper_miss_by_a_plane_between_them() {
    type V = glam::Vec2;
    let at = Posed::new(
        Point::new(V::new(47_032.273, -7_359.359)).expect("finite"),
        -6.825_865,
        V::new(12_942.549, 88_148.586),
    );
    let at = Posed::translated(at.expect("finite"), V::new(-1_113_857.1, 2_910_112.5)).expect("finite");
    let capsule = Capsule::<V>::new(25.991_453, 1.005_753_9).expect("a capsule");
    let turned = Posed::new(capsule, -4.840_33, V::ZERO).expect("finite");
    let turned = Posed::translated(turned, V::new(-1_064_416.1, 2_967_665.8)).expect("finite");
    let motion = Motion { velocity_a: V::NEG_X, velocity_b: V::ZERO };
    let options = LinearCastOptions::default().with_start_in_contact(StartInContact::IfDeeper);
    let report = laws::linear_cast(&at, &turned, motion, options, &[V::X, V::new(0.5, -0.25)]);
    assert!(report.broken.is_empty(), "{report}");
}
