//! Depths in closed form, and of cores without their rolling balls, against the expanding polytope, which knows nothing
//! of either.

use crate::common::behind_pointers::signed_distance;
use crate::common::{Plain, Random, quaternion, s};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Quat, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, Cone, CoreKind, Cuboid, Cylinder, Ellipsoid, Matrix, Polytope, Posed, Rounded, Scalar,
    Segment, SupportMap, Vector, Vector3, closest_point, support_value,
};
use gjk_raycast::{SignedDistance, SignedDistanceOptions, Status};
use num_traits::Float;

impl Random {
    /// From `least` to one, by its logarithm.
    fn length(&mut self, least: f64) -> f64 {
        self.number(least.ln(), 0.0).exp()
    }

    fn index(&mut self, below: u32) -> usize {
        self.number(0.0, below.into()) as usize
    }

    fn half_extents<V: Vector>(&mut self, least: f64) -> V {
        V::from_fn(|_| s::<V>(self.length(least)))
    }
}

fn ask<V, A, B>(a: &A, b: &B) -> SignedDistance<V>
where
    V: Vector,
    A: SupportMap<Vector = V>,
    B: SupportMap<Vector = V>,
{
    signed_distance(a, b, SignedDistanceOptions::default())
}

/// Both answers' brackets hold a common number, the quicker one's is hardly wider than the other's, and its points are
/// on their shapes, to the root of the bracket where the shapes are curved, and apart by the depth along the normal.
fn agree<V, A, B>(a: &A, b: &B) -> SignedDistance<V>
where
    V: Vector,
    A: SupportMap<Vector = V>,
    B: SupportMap<Vector = V>,
{
    let (quick, slow) = (ask(a, b), ask(&Plain(a), &Plain(b)));
    assert!(quick.lower <= slow.upper && slow.lower <= quick.upper, "{quick:?}\n{slow:?}");
    assert!(quick.lower <= quick.signed_distance && quick.signed_distance <= quick.upper, "{quick:?}");
    let size = [a.core(), b.core()]
        .iter()
        .fold((a.core().origin - b.core().origin).norm(), |sum, core| sum + core.extent + core.radius);
    let rounding = size.as_f64() * V::Scalar::EPSILON.as_f64();
    let width = |answer: &SignedDistance<V>| (answer.upper - answer.lower).as_f64();
    let curved = [a.core(), b.core()].iter().any(|core| matches!(core.kind, CoreKind::Curved));
    let asked = if curved { 2e-9 * size.as_f64() } else { 0.0 };
    let enough = 2.0 * width(&slow) + 24.0 * rounding + asked;
    assert!(width(&quick) <= enough, "{rounding:e} {quick:?}\n{slow:?}");
    // What is told of the last frame makes no other answer.
    let warm = signed_distance(a, b, SignedDistanceOptions::default().with_axis(quick.normal));
    assert!(warm.lower <= slow.upper && slow.lower <= warm.upper, "{warm:?}\n{slow:?}");
    assert!(width(&warm) <= enough, "{warm:?}\n{slow:?}");
    let rest = quick.point_a - quick.point_b - quick.normal * quick.signed_distance;
    let open = if width(&quick) > 1e3 * rounding { (width(&quick) * size.as_f64()).sqrt() } else { 0.0 };
    // Far from the world's origin, points have the digits that are left there.
    let far = (a.core().origin.norm() + b.core().origin.norm()).as_f64() * V::Scalar::EPSILON.as_f64();
    let lean = if curved { (2.0 * width(&quick) * size.as_f64()).sqrt() } else { 0.0 };
    assert!(rest.norm().as_f64() <= 64.0 * (rounding + far) + open + lean, "{rest:?} {quick:?}");
    for (off, point) in
        [(closest_point(a, quick.point_a), quick.point_a), (closest_point(b, quick.point_b), quick.point_b)]
    {
        let off = off.map_or(0.0, |closest| (closest - point).norm().as_f64());
        assert!(off <= 256.0 * (rounding + far) + open, "{off:e} {quick:?}");
    }
    quick
}

fn boxes<V: Vector>(seed: u64, turn: impl Fn(&mut Random, f64) -> V::Rotation) {
    let mut random = Random(seed);
    let (mut deep, mut closed) = (0, 0);
    for round in 0..4000 {
        let least = [1.0, 0.1, 1e-3, 1e-6][round % 4];
        let scale = [1.0, 1e-6, 1e6][round % 3];
        let lean = [1.0, 1e-3, 1e-6, 1e-9, 1e-12, 0.0][round / 4 % 6];
        let cuboid = |random: &mut Random| {
            let half: V = random.half_extents(least);
            Cuboid::new(half * s::<V>(scale)).expect("positive")
        };
        let (a, b) = (cuboid(&mut random), cuboid(&mut random));
        let both = turn(&mut random, 1.0);
        let (turn_a, turn_b) = (turn(&mut random, lean), turn(&mut random, lean));
        // Stacked, or anywhere within half of both.
        let reach = (a.half_extents() + b.half_extents()) * random.vector::<V>(0.999);
        let place = |shape, rotation, at| {
            let posed = Posed::new(shape, rotation, at).expect("a pose");
            Posed::new(posed, both, V::axis(0) * s::<V>(scale)).expect("a pose")
        };
        let (a, b) = (place(a, turn_a, V::ZERO), place(b, turn_b, reach));
        let answer = agree(&a, &b);
        deep += usize::from(answer.overlap);
        closed += usize::from(answer.iterations == 0);
        if round % 8 == 0 {
            let rounded = |shape| Rounded::new(shape, s::<V>(0.05 * scale)).expect("positive");
            let more = agree(&rounded(a), &rounded(b));
            assert!(more.signed_distance < answer.signed_distance, "{more:?} {answer:?}");
        }
    }
    assert!(deep > 2000 && closed > deep * 3 / 4, "{deep} overlap, {closed} in closed form");
}

#[test]
fn boxes_in_space() {
    boxes::<DVec3>(0x9E37_79B9_7F4A_7C15, |random, angle| DQuat::from_scaled_axis(random.vector::<DVec3>(angle)));
}

#[test]
fn boxes_in_single_precision() {
    let turn = |random: &mut Random, angle| Quat::from_scaled_axis(random.vector::<convex_support::glam::Vec3>(angle));
    boxes::<Vec3A>(0xD1B5_4A32_D192_ED03, turn);
}

#[test]
fn rectangles_in_the_plane() {
    boxes::<DVec2>(0x94D0_49BB_1331_11EB, |random, angle| random.number(-angle, angle));
}

#[test]
fn sheared_boxes_segments_and_points() {
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    for _ in 0..1000 {
        let matrix = Matrix::from_cols_fn(|_| random.vector::<DVec3>(1.0));
        let sheared =
            Affine::new(Cuboid::new(DVec3::ONE).expect("positive"), matrix, random.vector(0.3)).expect("a map");
        let cuboid = Cuboid::new(random.half_extents(0.1)).expect("positive");
        let _ = agree(&sheared, &cuboid);
        let segment = Segment::new([random.vector(1.0), random.vector(1.0)]).expect("finite");
        let _ = agree(&segment, &cuboid);
        let ball = Posed::translated(Ball::new(0.2).expect("positive"), random.vector(1.0)).expect("at");
        let _ = agree(&ball, &cuboid);
    }
}

#[test]
fn boxes_are_polytopes() {
    let mut random = Random(0x0123_4567_89AB_CDEF);
    for _ in 0..500 {
        let half: DVec3 = random.half_extents(0.1);
        let corners =
            (0..8).map(|i| half * <DVec3 as Vector>::from_fn(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }));
        let (cuboid, polytope) = (Cuboid::new(half).expect("positive"), Polytope::new(corners).expect("finite"));
        let other = Cuboid::new(random.half_extents(0.1)).expect("positive");
        let rotation = DQuat::from_scaled_axis(random.vector(2.0));
        let other = Posed::new(other, rotation, random.vector(0.7)).expect("a pose");
        let (quick, slow) = (ask(&cuboid, &other), ask(&polytope, &other));
        assert!(quick.lower <= slow.upper && slow.lower <= quick.upper, "{quick:?}\n{slow:?}");
    }
}

/// Of cubes about one centre all six ways out are as short, and of cubes on one another any point of the face will do.
#[test]
fn ties_have_points_too() {
    let cube = Cuboid::new(DVec3::ONE).expect("positive");
    for at in [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.25, 1.5, -0.5)] {
        let other = Posed::translated(cube, at).expect("finite");
        let answer = agree(&other, &cube);
        assert_eq!((answer.signed_distance, answer.status), (at.abs().max_element() - 2.0, Status::Converged));
    }
}

/// What an answer says of itself, as its fields document it.
fn keeps_its_word<V: Vector>(a: &dyn SupportMap<Vector = V>, b: &dyn SupportMap<Vector = V>) -> SignedDistance<V> {
    let options = SignedDistanceOptions::default();
    let answer = gjk_raycast::signed_distance(a, b, options);
    let SignedDistance { signed_distance, lower, upper, normal, .. } = answer;
    let cores = [a.core(), b.core()];
    let offset = cores[0].origin - cores[1].origin;
    let size = cores.iter().fold(offset.norm(), |sum, core| sum + core.extent + core.radius);
    let far = size + cores[0].origin.norm() + cores[1].origin.norm();
    let ulps = |count: f64| s::<V>(count) * V::Scalar::EPSILON;
    assert!(lower <= signed_distance && signed_distance <= upper, "{answer:?}");
    let error = ulps(8.0) * size + cores[0].error + cores[1].error;
    let asked = if lower > V::Scalar::ZERO { V::Scalar::ZERO } else { options.tolerance * size };
    let is_narrow = upper - lower <= error * s::<V>(6.0) + asked;
    assert_eq!(answer.status == Status::Converged, is_narrow, "{answer:?}");
    let plane = -(support_value(a, -normal) + support_value(b, normal));
    assert!(plane >= lower - ulps(8.0) * far, "{plane:?} {answer:?}");
    let rest = (answer.point_a - answer.point_b - normal * signed_distance).norm();
    let lean = Float::sqrt(size * s::<V>(2.0) * (upper - lower));
    assert!(rest <= lean + ulps(64.0) * far, "{rest:?} {answer:?}");
    answer
}

/// Pairs of an ellipsoid that is a ball, or nearly one, or one of revolution, and another body.
fn about_balls<V: Vector>(random: &mut Random, turn: impl Fn(&mut Random) -> V::Rotation, round: [AnyShape<V>; 2]) {
    let ellipsoid = |random: &mut Random| {
        let round = random.length(0.3);
        let last = round * [1.0, 1.0, 1.0 + 1e-3 * random.length(1e-5), random.length(0.3)][random.index(4)];
        let semi_axes = V::from_fn(|i| s::<V>(if i + 1 == V::DIM { last } else { round }));
        Ellipsoid::new(V::ZERO, semi_axes, turn(random)).expect("positive")
    };
    for other in [Box::new(ellipsoid(random)) as AnyShape<V>].into_iter().chain(round) {
        let body = ellipsoid(random);
        let toward = random.vector::<V>(1.0).unit().unwrap_or_else(|| V::axis(0));
        let reach = support_value(&body, toward) + support_value(&*other, -toward);
        let share = s::<V>([random.number(0.0, 1.0), 0.0, 1.0 - random.length(1e-6)][random.index(8).min(2)]);
        let other = Posed::new(other, turn(random), toward * (reach * share)).expect("a pose");
        let (there, back) = (keeps_its_word(&body, &other), keeps_its_word(&other, &body));
        assert!(there.lower <= back.upper && back.lower <= there.upper, "{there:?}\n{back:?}");
    }
}

type AnyShape<V> = Box<dyn SupportMap<Vector = V>>;

/// A look near contact was taken of the whole bodies: once the balls that roll within them are removed, it only knows
/// that they meet.
#[test]
fn converged_depths_without_rolling_balls_are_narrow() {
    fn in_space<V: Vector3>(seed: u64) {
        let mut random = Random(seed);
        for _ in 0..1000 {
            let [height, radius] = [random.length(0.3), random.length(0.3)].map(s::<V>);
            let cylinder = Cylinder::<V>::new(height, radius).expect("positive");
            let cone = Cone::<V>::new(height, radius).expect("positive");
            let turn = |random: &mut Random| quaternion::<V>([0.0; 4].map(|_| random.number(-1.0, 1.0)));
            about_balls(&mut random, turn, [Box::new(cylinder), Box::new(cone)]);
        }
    }
    in_space::<DVec3>(0xA076_1D64_78BD_642F);
    in_space::<Vec3A>(0xE703_7ED1_A0B4_28DB);
    let mut random = Random(0x8EBC_6AF0_9C88_C6E3);
    for _ in 0..1000 {
        let capsule = Capsule::new(random.length(0.3), random.length(0.3)).expect("positive");
        let cuboid = Cuboid::new(random.half_extents::<DVec2>(0.3)).expect("positive");
        about_balls(&mut random, |random| random.number(-3.0, 3.0), [Box::new(capsule), Box::new(cuboid)]);
    }
}

/// The planes of ways out that are equally short to rounding are others' than the points'.
#[test]
fn tied_ways_out_have_the_points_of_their_planes() {
    let about = |semi_axes, angle| Ellipsoid::<DVec3>::new(DVec3::ZERO, semi_axes, DQuat::from_rotation_x(angle));
    let ball = about(DVec3::ONE, 0.5).expect("positive");
    let apart = Posed::translated(ball, DVec3::X).expect("finite");
    assert!((keeps_its_word(&ball, &apart).signed_distance + 1.0).abs() < 1e-14);
    for semi_axes in [DVec3::splat(0.5), DVec3::new(0.5, 0.5, 0.75), DVec3::new(0.5, 0.75, 0.75)] {
        for angle in [0.0, 0.5, 1.0] {
            let _ = keeps_its_word(&about(semi_axes, angle).expect("positive"), &ball);
            let capsule =
                Posed::new(Capsule::new(0.5, 0.25).expect("positive"), DQuat::from_rotation_z(angle), DVec3::ZERO);
            let _ = keeps_its_word(&about(semi_axes, angle).expect("positive"), &capsule.expect("a pose"));
        }
    }
}

#[test]
fn ellipsoids_lose_their_balls() {
    let mut random = Random(0x5851_F42D_4C95_7F2D);
    let mut shallow = 0;
    for round in 0..400 {
        let least = [0.5, 0.9, 0.2][round % 3];
        let ellipsoid = |random: &mut Random, at| {
            let rotation = DQuat::from_scaled_axis(random.vector(2.0));
            Ellipsoid::new(at, random.half_extents(least), rotation).expect("positive")
        };
        let at = random.vector::<DVec3>(1.2);
        let (a, b) = (ellipsoid(&mut random, at), ellipsoid(&mut random, DVec3::ZERO));
        let answer = agree(&a, &b);
        shallow += usize::from(answer.overlap && answer.unexpanded == 0 && answer.upper - answer.lower < 1e-13);
        let cuboid = Cuboid::new(random.half_extents(0.3)).expect("positive");
        let turned = Posed::new(a, DQuat::from_scaled_axis(random.vector(2.0)), DVec3::ZERO).expect("a pose");
        let _ = agree(&turned, &cuboid);
        let scaled = Affine::new(a, DMat3::from_diagonal(DVec3::splat(2.0)), DVec3::ZERO);
        let _ = agree(&scaled.expect("a map"), &cuboid);
    }
    assert!(shallow > 50, "{shallow} are known as distances");
}
