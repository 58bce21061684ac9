//! Derivatives of distances: against differences of the distances, against 70 digits, and at edges.

use std::cell::RefCell;

use crate::differences::{Body, Comparison, Random, Space, apart, central};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Vec3A};
use convex_support::{
    AngularVelocity, Ball, Capsule, Cone, Cuboid, Ellipsoid, Matrix, Posed, Rotation, Scalar, Segment, SupportMap,
    Triangle, Vector,
};
use gjk_raycast::{
    ClosestFeatures, ClosestVelocities, RigidMotion, SignedDistanceOptions, Smoothness, Trajectory, signed_distance,
};

const VALID: &str = "positive sizes and finite numbers";

/// The normal or one of the points.
type Place<V> = fn(&ClosestFeatures<V>) -> V;

/// A pair that moves.
struct Moving<'b, V: Vector> {
    bodies: [&'b Body<V>; 2],
    motions: [RigidMotion<V>; 2],
    /// The features at the times that were asked for: all differences are taken at the same ones.
    known: RefCell<Vec<(f64, ClosestFeatures<V>)>>,
}

impl<V: Space> Moving<'_, V> {
    fn signed_distance(&self, time: f64) -> f64 {
        let [a, b] = [0, 1].map(|i| self.bodies[i].moved(&self.motions[i], time));
        apart(&a, &b).signed_distance
    }

    fn features(&self, time: f64) -> ClosestFeatures<V> {
        if let Some((_, features)) = self.known.borrow().iter().find(|(at, _)| *at == time) {
            return features.clone();
        }
        let [a, b] = [0, 1].map(|i| self.bodies[i].moved(&self.motions[i], time));
        let features = apart(&a, &b).closest_features(&a, &b);
        self.known.borrow_mut().push((time, features.clone()));
        features
    }

    /// The first derivative of the signed distance at a time.
    fn rate(&self, time: f64) -> f64 {
        let at = self.features(time);
        let [a, b] = &self.motions;
        at.normal().dot(a.velocity(time, at.point_a()) - b.velocity(time, at.point_b()))
    }

    fn compare(&self, [first, moved, second]: &mut [Comparison; 3], what: &str) {
        let [ma, mb] = self.motions;
        let features = self.features(0.0);
        if features.smoothness() == Smoothness::Edge {
            return;
        }
        let say = |which: &str| format!("{which} of {what}: {features:?}");
        let ours = features.gradient().along(ma, mb);
        first.add(ours, central(|t| self.signed_distance(t), 0.02), &|| say("the gradient"));
        let rate = features.rate(ma, mb).unwrap_or_else(|| panic!("{what}: {features:?}"));
        assert!((rate - ours).abs() < 1e-12 * (1.0 + ours.abs()), "{what}: {rate} from above and below, and {ours}");

        let velocities = features.velocities(ma, mb).unwrap_or_else(|| panic!("{what}: {features:?}"));
        let ClosestVelocities { normal, point_a, point_b, .. } = velocities;
        let places: [(V, Place<V>, &str); 3] = [
            (normal, |f| f.normal(), "the normal"),
            (point_a, |f| f.point_a(), "the point of a"),
            (point_b, |f| f.point_b(), "the point of b"),
        ];
        for (ours, place, which) in places {
            for i in 0..V::DIM {
                let at = |t| place(&self.features(t)).get(i);
                moved.add(ours.get(i), central(at, 0.02), &|| say(which));
            }
        }

        let hessian = features.hessian(ma.center, mb.center).expect("where there are velocities");
        let [pa, pb] = [ma, mb].map(|m| (m.velocity, m.angular_velocity));
        let ours = hessian.a.between(pa, pa) + hessian.b.between(pb, pb) + 2.0 * hessian.mixed.between(pa, pb);
        second.add(ours, central(|t| self.rate(t), 0.02), &|| say("the Hessian"));
        assert_eq!(features.hessian_of_a(ma.center), Some(hessian.a), "the same of {what}");
        assert_eq!(features.hessian_of_b(mb.center), Some(hessian.b), "the same of {what}");
    }
}

fn all_pairs<V: Space>(seed: u64, rounds: usize) {
    let mut random = Random(seed);
    let mut comparisons: [Comparison; 3] = Default::default();
    for (i, kind_a) in V::KINDS.iter().enumerate() {
        for kind_b in &V::KINDS[i..] {
            for round in 0..rounds {
                let a = Body::<V>::random(kind_a, &mut random);
                let b = Body::random(kind_b, &mut random).placed(&a, round % 2 == 0, &mut random);
                let motions = [random.motion(), random.motion()];
                let pair = Moving { bodies: [&a, &b], motions, known: RefCell::default() };
                pair.compare(&mut comparisons, &format!("{kind_a} and {kind_b}, round {round}"));
            }
        }
    }
    comparisons.iter().for_each(Comparison::check);
}

#[test]
fn derivatives_are_those_of_differences_in_space() {
    all_pairs::<DVec3>(7, 12);
}

#[test]
fn derivatives_are_those_of_differences_in_the_plane() {
    all_pairs::<DVec2>(8, 12);
}

/// The ellipsoids of a line of the reference, and its numbers of the distance: value, gradient and upper triangle of
/// the Hessian.
fn reference<V: Vector<Scalar = f64>>(line: &str) -> (f64, [Ellipsoid<V>; 2], Vec<f64>) {
    let n = V::DIM;
    let numbers: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
    let per_body = 2 * n + n * n;
    let body = |k: usize| {
        let at = |i: usize| numbers[2 + k * per_body + i];
        let axes = V::Matrix::from_cols_fn(|j| V::from_fn(|i| at(2 * n + n * j + i)));
        Ellipsoid::from_axes(V::from_fn(at), V::from_fn(|i| at(n + i)), axes).expect(VALID)
    };
    (numbers[1], [body(0), body(1)], numbers[2 + 2 * per_body..].to_vec())
}

/// The errors of the gradient and the Hessian, relative to the greatest entry of each block of translations and
/// rotations.
fn errors<V: Vector<Scalar = f64>>(bodies: &[Ellipsoid<V>; 2], truth: &[f64]) -> Option<[f64; 2]> {
    let [a, b] = bodies;
    let features = apart(a, b).closest_features(a, b);
    let center = a.center();
    let gradient = features.gradient().a;
    let hessian = features.hessian_of_a(center)?;
    let (n, size) = (V::DIM, V::DIM * (V::DIM + 1) / 2);
    let block = |i: usize| usize::from(i >= n);
    let (mut first, mut second) = ([[0f64; 2]; 2], [[0f64; 2]; 3]);
    let note = |[off, most]: &mut [f64; 2], ours: f64, truth: f64| {
        (*off, *most) = (off.max((ours - truth).abs()), most.max(truth.abs()));
    };
    let mut at = 1 + size;
    for i in 0..size {
        let ours = if i < n { gradient.translation.get(i) } else { gradient.rotation_about(center).coordinate(i - n) };
        note(&mut first[block(i)], ours, truth[1 + i]);
        for j in i..size {
            note(&mut second[block(i) + block(j)], hessian.entry(i, j), truth[at]);
            at += 1;
        }
    }
    // Turning a ball does nothing, and is known to rounding of the size.
    let worst = |blocks: &[[f64; 2]]| blocks.iter().map(|[off, most]| off / most.max(1e-3)).fold(0.0, f64::max);
    Some([worst(&first), worst(&second)])
}

#[test]
fn ellipsoids_are_those_of_seventy_digits() {
    let text = include_str!("data/ellipsoid_distances.csv");
    let mut compared = 0;
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (condition, found) = if line.starts_with('2') {
            let (condition, bodies, truth) = reference::<DVec2>(line);
            (condition, errors(&bodies, &truth))
        } else {
            let (condition, bodies, truth) = reference::<DVec3>(line);
            (condition, errors(&bodies, &truth))
        };
        let [first, second] = found.unwrap_or_else(|| panic!("ellipsoids are smooth: {line}"));
        assert!(first < 1e-11 && second < 1e-11, "condition 1e{condition}: off by {first:e} and {second:e}: {line}");
        compared += 1;
    }
    assert!(compared > 20, "{compared} cases");
}

/// A body by numbers that both precisions have, and where it is.
fn body<V: Vector>(
    kind: usize,
    [x, y, z]: [f64; 3],
    rotation: [f64; 4],
    at: [f64; 3],
) -> Box<dyn SupportMap<Vector = V>> {
    let number = V::Scalar::from_f64;
    let vector = |v: [f64; 3]| V::from_fn(|i| number(v[i]));
    let place = (V::Rotation::from_xyzw(rotation.map(number)), vector(at));
    let size = vector([x, y, z]);
    match kind {
        0 => Box::new(
            Posed::new(Ellipsoid::new(V::ZERO, size, V::Rotation::default()).expect(VALID), place.0, place.1)
                .expect(VALID),
        ),
        1 => Box::new(Posed::new(Cuboid::new(size).expect(VALID), place.0, place.1).expect(VALID)),
        _ => Box::new(Posed::new(Capsule::new(number(x), number(y)).expect(VALID), place.0, place.1).expect(VALID)),
    }
}

/// The gradient and the Hessian of a pair by the pose of the first.
fn derivatives<V: Vector>(a: &dyn SupportMap<Vector = V>, b: &dyn SupportMap<Vector = V>) -> Option<[Vec<f64>; 2]> {
    let features = signed_distance(a, b, SignedDistanceOptions::default()).closest_features(a, b);
    let gradient = features.gradient().a;
    let turn = gradient.rotation_about(V::ZERO);
    let hessian = features.hessian_of_a(V::ZERO)?;
    let first =
        (0..6).map(|i| if i < 3 { gradient.translation.get(i) } else { turn.coordinate(i - 3) }.as_f64()).collect();
    let second = hessian.matrix::<6>().into_iter().flatten().map(|entry| entry.as_f64()).collect();
    Some([first, second])
}

#[test]
fn single_precision_is_near() {
    let mut random = Random(21);
    let (mut compared, mut missing) = (0, 0);
    for round in 0..600 {
        let mut single = |low: f64, high: f64| f64::from(random.number(low, high) as f32);
        let mut pair = [0, 1].map(|i| {
            let size = [0; 3].map(|_| single(0.3, 1.0));
            let rotation = [0; 4].map(|_| single(0.2, 1.0));
            // Apart and overlapping by turns.
            let at = if i == 0 { [single(1.2, 2.5), single(0.1, 0.9), single(0.1, 0.5)] } else { [0.0; 3] };
            (size, rotation, at)
        });
        pair[1].1[0] *= -1.0;
        let kinds = [round % 3, round / 3 % 3];
        let [a, b] = [0, 1].map(|i| body::<DVec3>(kinds[i], pair[i].0, pair[i].1, pair[i].2));
        let Some(due) = derivatives(&*a, &*b) else { continue };
        let [a, b] = [0, 1].map(|i| body::<Vec3A>(kinds[i], pair[i].0, pair[i].1, pair[i].2));
        let Some(ours) = derivatives(&*a, &*b) else {
            missing += 1;
            continue;
        };
        compared += 1;
        for (ours, due) in ours.iter().zip(&due) {
            let most = due.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            let off = ours.iter().zip(due).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
            assert!(off < 1e-3 * most, "{kinds:?}, round {round}: {ours:?}, not {due:?}");
        }
    }
    assert!(compared > 500 && missing < 10, "{compared} compared, {missing} not known in single precision");
}

/// A box of a user that says nothing but its support points.
struct Opaque(Cuboid<DVec3>);

impl SupportMap for Opaque {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        self.0.support(direction)
    }
}

#[test]
fn what_is_not_said_of_a_shape_is_not_made_up() {
    // A vertex of one box over a face of the other, of which the second does not say that it has faces.
    let lower = Cuboid::new(DVec3::new(2.0, 1.0, 2.0)).expect(VALID);
    let lean = DQuat::from_rotation_x(0.6) * DQuat::from_rotation_z(0.5);
    let upper = Posed::new(Cuboid::new(DVec3::splat(0.5)).expect(VALID), lean, DVec3::new(0.1, 2.5, 0.2)).expect(VALID);
    let motions = [RigidMotion::translation(DVec3::X), RigidMotion::rotation(DVec3::Z, DVec3::ZERO)];
    let known = apart(&upper, &lower).closest_features(&upper, &lower);
    let velocities = known.velocities(motions[0], motions[1]).expect("a vertex and a face");
    assert!((velocities.normal - DVec3::NEG_X).length() < 1e-14, "it turns with the face: {velocities:?}");

    let lower = Opaque(lower);
    let unknown = apart(&upper, &lower).closest_features(&upper, &lower);
    assert!((unknown.normal() - DVec3::Y).length() < 1e-14);
    assert_eq!(unknown.velocities(motions[0], motions[1]), None);
    assert_eq!(unknown.hessian(DVec3::ZERO, DVec3::ZERO), None);
    assert!((known.normal() - DVec3::Y).length() < 1e-14);
}

/// A shape that is none.
struct Nowhere;

impl SupportMap for Nowhere {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        direction * f64::NAN
    }
}

#[test]
fn what_is_not_a_number_has_no_derivative() {
    let ball = Cuboid::new(DVec3::ONE).expect(VALID);
    let features = apart(&Nowhere, &ball).closest_features(&Nowhere, &ball);
    assert_eq!(features.smoothness(), Smoothness::Edge);
    assert_eq!(features.velocities(RigidMotion::default(), RigidMotion::default()), None);
    assert_eq!(features.hessian_of_b(DVec3::ZERO), None);
}

/// Two ways out are as short where a ball is about the axis of a capsule, a circle about a segment, and a ball about
/// the axis of an ellipse. Cores that touch seemed a rounding apart, curved ones were compared to a billionth, and the
/// normal turns a little as they are pushed.
#[test]
fn ways_out_that_are_as_short_are_edges_of_curved_shapes_too() {
    fn is_tied<V: Vector>(a: &impl SupportMap<Vector = V>, b: &impl SupportMap<Vector = V>) {
        let options = SignedDistanceOptions::default().with_tolerance(Scalar::from_f64(1e-14));
        for answer in [signed_distance(a, b, SignedDistanceOptions::default()), signed_distance(a, b, options)] {
            assert_eq!(answer.closest_features(a, b).smoothness(), Smoothness::Edge, "{answer:?}");
        }
    }
    let at = |shape, y| Posed::translated(shape, DVec2::new(0.0, y)).expect(VALID);
    let capsule = Capsule::<DVec2>::new(0.5, 0.5).expect(VALID);
    is_tied(&at(Ball::new(0.4951441696403767).expect(VALID), 0.4891606968372748), &capsule);
    let axis = Segment::new([DVec2::new(0.0, -0.7), DVec2::new(0.0, 0.7)]).expect(VALID);
    let circle = Ellipsoid::new(DVec2::ZERO, DVec2::splat(0.7), 0.0).expect(VALID);
    is_tied(&Posed::translated(circle, DVec2::new(0.0, 0.5)).expect(VALID), &axis);
    let ellipse = Ellipsoid::new(DVec2::ZERO, DVec2::new(0.3622096257638401, 0.821705215460875), 0.0).expect(VALID);
    is_tied(&at(Ball::new(1.0).expect(VALID), 0.5), &ellipse);
}

/// Two coordinates of the normal are equal and the least but for a rounding, which decides the basis that features are
/// seen in. A last step of refinement had changed the basis and not the features, so that the edge of the triangle was
/// mirrored and its Hessian was wrong by half.
#[test]
fn second_derivatives_along_a_normal_between_two_bases() {
    let turn = DMat3::from_rotation_y(std::f64::consts::FRAC_PI_4);
    for round in 0..64u8 {
        let (x, lift) = (0.125 + f64::from(round % 8) / 16.0, 0.75 + f64::from(round / 8) / 16.0);
        let world = DVec3::new(3000.0, -2000.0, 1000.0);
        // The apex of a cone, and the nearest edge of a triangle.
        let cone = Posed::from_matrix(Cone::new(0.25, 0.25).expect(VALID), turn, world).expect(VALID);
        let corners = [DVec3::ZERO, DVec3::X * 0.25, DVec3::Y * 0.5];
        let at = DVec3::new(x, lift, x + 0.25);
        let triangle = Posed::from_matrix(Triangle::new(corners).expect(VALID), turn, world + at).expect(VALID);
        let features = apart(&triangle, &cone).closest_features(&triangle, &cone);
        let (n, e) = (features.normal(), DVec3::new(1.0, 0.0, -1.0).normalize());
        assert!((n.x - n.z).abs() < 1e-12, "{n}");
        let hessian = features.hessian_of_b(DVec3::ZERO).expect("smooth").matrix::<3>();
        let distance = (at - DVec3::Y * 0.25).reject_from_normalized(e).length();
        for i in 0..3 {
            for j in 0..3 {
                // Of the distance of a point from a line: across both the line and the normal.
                let due = (f64::from(u8::from(i == j)) - n[i] * n[j] - e[i] * e[j]) / distance;
                assert!((hessian[i][j] - due).abs() < 1e-11, "{hessian:?}: {i}, {j} is {due}");
            }
        }
    }
}
