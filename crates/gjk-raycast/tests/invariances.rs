//! What an answer does not depend on: the unit of length, the order of the bodies, the direction the search begins
//! with.

use crate::common::space::{Space, spin};
use crate::common::strategies::{rotation, vector};
use crate::common::ulps;
use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3A, Vec3Swizzles as _};
use convex_support::{
    Ball, Capsule, Cuboid, Ellipsoid, InvalidShape, Polytope, Posed, Rounded, Scalar, SupportMap, Vector,
};
use gjk_raycast::{
    ChainMotion, ClosestFeatures, Contact, Distance, DistanceOptions, HalfSpace, LinearCast, LinearCastOptions, Motion,
    MotionCast, MotionCastOptions, Outcome, Ray, RayCast, RayCastOptions, RayExit, RigidMotion, SceneCast,
    SignedDistance, StartInContact, Status, contact, distance, intersects, linear_cast, motion_cast, ray_cast,
    ray_exit, signed_distance,
};
use proptest::prelude::*;

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// Sizes of moderate or of wild aspect.
fn sizes() -> impl Strategy<Value = DVec3> {
    let size = || prop_oneof![3 => 0.2..1.5, 1 => Just(1e-3), 1 => Just(1e-6)];
    (size(), size(), size()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Two bodies, and a motion.
struct Scene {
    kinds: (usize, usize),
    sizes: (DVec3, DVec3),
    turns: (DQuat, DQuat),
    place: DVec3,
    velocity: DVec3,
    spin: DVec3,
}

/// A space, and how it is turned.
trait Turned: Space {
    fn turn(rotation: DQuat) -> Self::Rotation;
}

impl Turned for DVec3 {
    fn turn(rotation: DQuat) -> DQuat {
        rotation
    }
}

impl Turned for Vec3A {
    fn turn(rotation: DQuat) -> Self::Rotation {
        rotation.as_quat()
    }
}

impl Turned for DVec2 {
    fn turn(rotation: DQuat) -> f64 {
        4.0 * rotation.x
    }
}

impl Turned for Vec2 {
    fn turn(rotation: DQuat) -> f32 {
        4.0 * rotation.as_quat().x
    }
}

fn solid<V: Turned>(
    kind: usize,
    d: DVec3,
    turn: DQuat,
    place: DVec3,
    unit: V::Scalar,
) -> Result<Shape<V>, InvalidShape> {
    let to = |p: DVec3| V::from_fn(|i| V::Scalar::from_f64(p[i])) * unit;
    let number = |x: f64| V::Scalar::from_f64(x) * unit;
    let shape: Shape<V> = match kind {
        0 => Box::new(Cuboid::new(to(d))?),
        1 => Box::new(Ball::new(number(d.x))?),
        2 => Box::new(Capsule::<V>::new(number(d.x), number(d.y))?),
        3 | 4 => match V::upright(kind - 3, number(d.x), number(d.y)) {
            Some(shape) => shape,
            None => Box::new(Capsule::<V>::new(number(d.x), number(d.y))?),
        },
        5 => Box::new(Ellipsoid::new(V::ZERO, to(d), V::turn(DQuat::IDENTITY))?),
        6 => Box::new(Rounded::new(Cuboid::new(to(d))?, number(d.z))?),
        _ => Box::new(Polytope::new([d, -d, d.yzx(), -d.zxy(), DVec3::new(-d.x, d.z, d.y)].map(to))?),
    };
    Ok(Box::new(Posed::new(shape, V::turn(turn), to(place))?))
}

/// The numbers of an answer, lengths divided by the unit: the same in every unit.
struct Numbers {
    unit: f64,
    found: Vec<(&'static str, f64)>,
    query: &'static str,
}

impl Numbers {
    fn of<S: Scalar>(&mut self, number: S) {
        self.found.push((self.query, number.as_f64()));
    }

    fn count(&mut self, number: usize) {
        self.found.push((self.query, number as f64));
    }

    fn length<S: Scalar>(&mut self, length: S) {
        self.found.push((self.query, length.as_f64() / self.unit));
    }

    fn place<V: Vector>(&mut self, place: V) {
        (0..V::DIM).for_each(|i| self.length(place.get(i)));
    }

    fn direction<V: Vector>(&mut self, direction: Option<V>) {
        // Where there is none, what no unit vector has.
        let direction = direction.unwrap_or(V::splat(V::Scalar::from_f64(2.0)));
        (0..V::DIM).for_each(|i| self.of(direction.get(i)));
    }

    fn distance<V: Vector>(&mut self, answer: &Distance<V>) {
        [answer.distance, answer.lower, answer.upper].into_iter().for_each(|x| self.length(x));
        [answer.point_a, answer.point_b].into_iter().for_each(|p| self.place(p));
        self.direction(answer.normal);
        [usize::from(answer.overlap), answer.status as usize, answer.iterations]
            .into_iter()
            .for_each(|n| self.count(n));
    }

    fn signed_distance<V: Vector>(&mut self, answer: &SignedDistance<V>) {
        [answer.signed_distance, answer.lower, answer.upper].into_iter().for_each(|x| self.length(x));
        [answer.point_a, answer.point_b].into_iter().for_each(|p| self.place(p));
        self.direction(Some(answer.normal));
        [usize::from(answer.overlap), answer.status as usize, answer.iterations]
            .into_iter()
            .for_each(|n| self.count(n));
    }

    fn contact<V: Vector>(&mut self, answer: Option<Contact<V>>) {
        let Some(contact) = answer else { return self.count(0) };
        self.signed_distance(&contact.distance);
        for point in contact.points() {
            [point.point_a, point.point_b].into_iter().for_each(|p| self.place(p));
            self.length(point.signed_distance);
            [point.feature_a, point.feature_b].into_iter().for_each(|id| self.count(id as usize));
        }
    }

    fn features<V: Turned>(&mut self, features: &ClosestFeatures<V>) {
        [features.point_a(), features.point_b()].into_iter().for_each(|p| self.place(p));
        self.direction(Some(features.normal()));
        self.count(features.smoothness() as usize);
        let Some(hessian) = features.hessian(features.point_a(), features.point_b()) else { return };
        // By a translation and a rotation, of which there is one at least.
        let (i, j) = (0, V::DIM);
        self.of(hessian.mixed.entry(i, j));
        self.length(hessian.a.entry(j, j));
    }

    /// The answer of a cast: the parameter, the point and the normal of its hit, and the rest.
    fn cast<V: Vector, H>(
        &mut self,
        outcome: Outcome<H, V>,
        hit: impl FnOnce(H) -> (V::Scalar, V, Option<V>),
        bounds: [V::Scalar; 2],
        work: (Status, usize),
    ) {
        match outcome {
            Outcome::Hit(found) => {
                let (at, point, normal) = hit(found);
                self.of(at);
                self.place(point);
                self.direction(normal);
            }
            Outcome::Miss(miss) => self.direction(Some(miss.axis)),
            Outcome::Undecided => self.count(0),
        }
        bounds.into_iter().for_each(|bound| self.of(bound));
        [work.0 as usize, work.1].into_iter().for_each(|n| self.count(n));
    }

    fn linear_cast<V: Vector>(&mut self, cast: &LinearCast<V>) {
        let LinearCast { outcome, lower, upper, status, iterations } = *cast;
        self.cast(outcome, |hit| (hit.time, hit.point, hit.normal), [lower, upper], (status, iterations));
    }

    fn motion_cast<V: Vector>(&mut self, cast: &MotionCast<V>) {
        let MotionCast { outcome, lower, upper, status, iterations } = *cast;
        self.cast(outcome, |hit| (hit.time, hit.point, hit.normal), [lower, upper], (status, iterations));
    }

    fn ray_cast<V: Vector>(&mut self, cast: &RayCast<V>) {
        let RayCast { outcome, lower, upper, status, iterations } = *cast;
        self.cast(outcome, |hit| (hit.lambda, hit.point, hit.normal), [lower, upper], (status, iterations));
    }

    fn first<H, V: Vector>(&mut self, cast: &SceneCast<H, V::Scalar>, hit: impl Fn(&H) -> (V::Scalar, V)) {
        self.of(cast.lower);
        [cast.work.nodes, cast.work.tested, cast.undecided.map_or(0, |body| body + 1)]
            .into_iter()
            .for_each(|n| self.count(n));
        let Some(first) = &cast.first else { return };
        self.count(first.body);
        let (at, point) = hit(&first.hit);
        [at, first.lower, first.upper].into_iter().for_each(|x| self.of(x));
        self.place(point);
    }
}

/// Every query about a scene, in a unit of length.
fn asked<V: Turned>(scene: &Scene, exponent: i32) -> Vec<(&'static str, f64)> {
    let unit = V::Scalar::from_f64(2.0_f64.powi(exponent));
    let to = |p: DVec3| V::from_fn(|i| V::Scalar::from_f64(p[i])) * unit;
    let number = |x: f64| V::Scalar::from_f64(x) * unit;
    let a = solid::<V>(scene.kinds.0, scene.sizes.0, scene.turns.0, DVec3::ZERO, unit).expect("valid");
    let b = solid::<V>(scene.kinds.1, scene.sizes.1, scene.turns.1, scene.place, unit).expect("valid");
    let mut numbers = Numbers { unit: unit.as_f64(), found: Vec::new(), query: "distance" };
    let apart = distance(&a, &b, DistanceOptions::default());
    numbers.distance(&apart);
    numbers.query = "intersects";
    let meets = intersects(&a, &b, Default::default());
    [usize::from(meets.overlap), meets.status as usize, meets.iterations].into_iter().for_each(|n| numbers.count(n));
    numbers.direction(meets.axis);
    numbers.query = "signed_distance";
    let signed = signed_distance(&a, &b, Default::default());
    numbers.signed_distance(&signed);
    numbers.query = "contact";
    numbers.contact(contact(&a, &b, number(0.25), Default::default()));
    numbers.query = "features";
    numbers.features(&signed.closest_features(&a, &b));
    apart.closest_features(&a, &b).iter().for_each(|features| numbers.features(features));

    numbers.query = "linear_cast";
    let velocity = to(scene.velocity);
    let motion = Motion { velocity_a: velocity, velocity_b: to(scene.sizes.0) };
    for options in [LinearCastOptions::new(), LinearCastOptions::new().with_target_distance(number(0.125))] {
        numbers.linear_cast(&linear_cast(&a, &b, motion, options).expect("finite"));
    }
    let half_space = HalfSpace::new(to(scene.place) / unit, number(-0.5)).expect("a normal");
    numbers.query = "half-space";
    numbers.distance(&half_space.distance_from(&a));
    numbers.signed_distance(&half_space.signed_distance(&a));
    numbers.contact(half_space.contact(&a, number(1.0)));
    numbers.linear_cast(&half_space.linear_cast(&a, motion, Default::default()).expect("finite"));

    let ray = Ray { source: to(scene.place), direction: -velocity };
    numbers.query = "ray_cast";
    numbers.ray_cast(&ray_cast(&a, ray, Default::default()).expect("finite"));
    numbers.ray_cast(&half_space.ray_cast(ray, Default::default()).expect("finite"));
    let late = RayCastOptions::new().with_min_lambda(V::Scalar::from_f64(0.25));
    numbers.ray_cast(&ray_cast(&a, ray, late).expect("finite"));
    numbers.query = "ray_exit";
    let RayExit { outcome, lower, upper, status, iterations } = ray_exit(&a, ray, Default::default()).expect("finite");
    numbers.cast(outcome, |hit| (hit.lambda, hit.point, hit.normal), [lower, upper], (status, iterations));

    numbers.query = "motion_cast";
    let turning =
        RigidMotion { velocity, angular_velocity: spin::<V>(scene.spin.to_array()), center: to(scene.sizes.1) };
    let joints = [turning, RigidMotion::rotation(spin::<V>(scene.spin.yzx().to_array()), to(scene.sizes.0))];
    let (rest, chain) = (RigidMotion::default(), ChainMotion::new(&joints));
    let options = MotionCastOptions::new().with_max_time(V::Scalar::from_f64(1.5)).with_max_iterations(100);
    let near = options.with_target_distance(number(0.125));
    numbers.motion_cast(&motion_cast(&a, turning, &b, rest, options).expect("finite"));
    numbers.motion_cast(&motion_cast(&a, rest, &b, turning, near).expect("finite"));
    numbers.motion_cast(&motion_cast(&a, chain, &b, rest, options).expect("finite"));
    numbers.motion_cast(&half_space.motion_cast(&a, turning, options).expect("finite"));

    let others = (0..5).map(|i| {
        let place = scene.place + scene.velocity * f64::from(i) - scene.spin;
        solid::<V>(scene.kinds.1, scene.sizes.1, scene.turns.0, place, unit).expect("valid")
    });
    let mut bodies = gjk_raycast::Scene::new(others.chain([b])).expect("finite");
    bodies.insert_half_space(half_space);
    numbers.query = "scene ray";
    let first = bodies.all().ray_cast(ray, Default::default()).expect("finite");
    numbers.first(&first, |hit| (hit.lambda, hit.point));
    numbers.query = "scene linear_cast";
    let first = bodies.all().linear_cast(&a, motion, Default::default()).expect("finite");
    numbers.first(&first, |hit| (hit.time, hit.point));
    numbers.query = "scene motion_cast";
    let first = bodies.all().motion_cast(&a, turning, options).expect("finite");
    numbers.first(&first, |hit| (hit.time, hit.point));
    numbers.query = "scene nearest";
    let nearest = bodies.all().nearest(&a, Default::default()).nearest.expect("a half-space at least");
    numbers.count(nearest.body);
    numbers.distance(&nearest.distance);
    numbers.query = "scene pairs";
    let (mut pairs, mut contacts) = (Vec::new(), Vec::new());
    bodies.all().pairs_within(number(0.5), Default::default(), &mut pairs);
    pairs.iter().for_each(|pair| numbers.distance(&pair.distance));
    bodies.all().contacts_within(number(0.5), Default::default(), &mut contacts);
    contacts.iter().for_each(|pair| numbers.contact(Some(pair.contact)));
    numbers.found
}

/// Every query in two units: every number that is a length is scaled, and every other is the same, to the bit.
fn scaled<V: Turned>(scene: &Scene, exponent: i32) -> Result<(), TestCaseError> {
    let (small, big) = (asked::<V>(scene, 0), asked::<V>(scene, exponent));
    let differ = small.iter().zip(&big).find(|(x, y)| x != y && !(x.1.is_nan() && y.1.is_nan()));
    prop_assert!(small.len() == big.len() && differ.is_none(), "2^{}: {:?}", exponent, differ);
    Ok(())
}

proptest! {
    #![proptest_config(convex_support::laws::config(64))]

    /// A power of two changes no bit of any mantissa, in both precisions, in space and in the plane, over the range
    /// that `docs/evidence.md` names: of no query, whatever it computes. Odd powers are no better than even ones,
    /// though the root of an odd power of two is none: turning casts once took roots of lengths.
    #[test]
    fn the_unit_of_length_does_not_matter(
        (kinds, sizes) in ((0_usize..8, 0_usize..8), (sizes(), sizes())),
        (turns, place, velocity, spin) in ((rotation(), rotation()), vector(3.0), vector(2.0), vector(2.0)),
        (far, space) in (prop_oneof![-3_i32..4, -240_i32..240], 0_usize..4),
    ) {
        prop_assume!(place.x.hypot(place.y) > 0.01 && velocity.x.hypot(velocity.y) > 0.01);
        let scene = Scene { kinds, sizes, turns, place, velocity, spin };
        // Bodies of 1e-6, which is 2⁻²⁰, take a part of the exponents.
        let near = if far.abs() > 3 { (far / 12).max(-10) } else { far };
        let far = far.max(-230);
        match space {
            0 => scaled::<DVec3>(&scene, far)?,
            1 => scaled::<DVec2>(&scene, far)?,
            2 => scaled::<Vec3A>(&scene, near)?,
            _ => scaled::<Vec2>(&scene, near)?,
        }
    }
}

/// The brackets of the answers about two bodies, in units of the scene's lengths; of what is decided without a number,
/// what it says of one.
fn brackets<V: Turned>(scene: &Scene, unit: V::Scalar) -> Vec<(&'static str, [f64; 2])> {
    let to = |p: DVec3| V::from_fn(|i| V::Scalar::from_f64(p[i])) * unit;
    let bodies = (
        solid::<V>(scene.kinds.0, scene.sizes.0, scene.turns.0, DVec3::ZERO, unit),
        solid::<V>(scene.kinds.1, scene.sizes.1, scene.turns.1, scene.place, unit),
    );
    let mut found = Vec::new();
    // A shape may be refused.
    let (Ok(a), Ok(b)) = bodies else { return found };
    let mut bounds = |query, lower: V::Scalar, upper: V::Scalar, unit: V::Scalar| {
        found.push((query, [lower, upper].map(|bound| bound.as_f64() / unit.as_f64())));
    };
    let (zero, one, infinity) = (V::Scalar::ZERO, V::Scalar::ONE, V::Scalar::from_f64(f64::INFINITY));
    let apart = distance(&a, &b, DistanceOptions::default());
    bounds("distance", apart.lower, apart.upper, unit);
    let signed = signed_distance(&a, &b, Default::default());
    bounds("signed distance", signed.lower, signed.upper, unit);
    // What is said to overlap may be as far apart as the rounding that its distance allows for, if that is a number.
    let touching = if apart.upper < infinity { apart.upper } else { zero };
    let meets = intersects(&a, &b, Default::default()).decided() == Some(true);
    for (query, overlap) in [("overlap", apart.overlap && apart.status == Status::Converged), ("intersects", meets)] {
        bounds(query, if overlap { zero } else { apart.lower }, if overlap { touching } else { infinity }, unit);
    }
    let motion = Motion { velocity_a: to(scene.velocity), velocity_b: V::ZERO };
    for (query, start) in [("linear cast", StartInContact::Report), ("deeper", StartInContact::IfDeeper)] {
        let options = LinearCastOptions::new().with_start_in_contact(start);
        let cast = linear_cast(&a, &b, motion, options).map(|cast| [cast.lower, cast.upper]);
        let [lower, upper] = cast.unwrap_or([zero, infinity]);
        bounds(query, lower, upper, one);
    }
    let ray = Ray { source: to(scene.place), direction: to(-scene.velocity) };
    let [lower, upper] =
        ray_cast(&a, ray, Default::default()).map_or([zero, infinity], |cast| [cast.lower, cast.upper]);
    bounds("ray cast", lower, upper, one);
    let turning = RigidMotion {
        velocity: to(scene.velocity),
        angular_velocity: spin::<V>(scene.spin.to_array()),
        center: V::ZERO,
    };
    let options = MotionCastOptions::new().with_max_time(one).with_max_iterations(100);
    let cast = motion_cast(&a, turning, &b, RigidMotion::default(), options).map(|cast| [cast.lower, cast.upper]);
    let [lower, upper] = cast.unwrap_or([zero, infinity]);
    bounds("motion cast", lower, upper, one);
    found
}

/// Beyond the range in which the unit does not matter an answer may be wider, undecided or refused, but not false:
/// numbers that the scalar can hold are asked about twice, as they are and in a unit in which nothing under- or
/// overflows.
fn held<V: Turned>(mut scene: Scene, exponent: i32) -> Result<(), TestCaseError> {
    let unit = V::Scalar::from_f64(2.0_f64.powi(exponent));
    let held = |p: DVec3| DVec3::from_array(p.to_array().map(|x| (V::Scalar::from_f64(x) * unit / unit).as_f64()));
    scene.sizes = (held(scene.sizes.0), held(scene.sizes.1));
    (scene.place, scene.velocity) = (held(scene.place), held(scene.velocity));
    for (truth, answer) in brackets::<V>(&scene, V::Scalar::ONE).iter().zip(brackets::<V>(&scene, unit)) {
        let [lower, upper] = truth.1;
        prop_assert!(
            answer.1[0] <= upper && lower <= answer.1[1],
            "2^{}: {:?}, in truth {:?}",
            exponent,
            answer,
            truth
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(convex_support::laws::config(96))]

    /// Found in single precision by exact rationals, where bodies were smaller than 1e-33: what a subnormal number
    /// loses is no part of it, but the least number there is. And sums of lengths near the largest number overflow: a
    /// bracket that is infinite decides nothing.
    #[test]
    fn nothing_is_false_at_the_ends_of_the_range(
        (kinds, sizes) in ((0_usize..8, 0_usize..8), (sizes(), sizes())),
        (turns, place, velocity, spin) in ((rotation(), rotation()), vector(3.0), vector(2.0), vector(2.0)),
        (small, large, end) in (-70_i32..0, 0_i32..24, 0_usize..6),
    ) {
        prop_assume!(place.x.hypot(place.y) > 0.01 && velocity.x.hypot(velocity.y) > 0.01);
        let scene = Scene { kinds, sizes, turns, place, velocity, spin };
        match end {
            0 => held::<DVec3>(scene, -1000 + small)?,
            1 => held::<DVec3>(scene, 1022 - large)?,
            2 => held::<Vec3A>(scene, -100 + small / 2)?,
            3 => held::<Vec3A>(scene, 126 - large)?,
            4 => held::<DVec2>(scene, -1000 + small)?,
            _ => held::<Vec2>(scene, 126 - large)?,
        }
    }
}

proptest! {
    #![proptest_config(convex_support::laws::config(300))]

    /// Moving both bodies by what their coordinates can hold changes no bit; by anything else, no more than the
    /// rounding of the coordinates.
    #[test]
    fn a_common_translation_does_not_matter(
        (kind_a, kind_b) in (0_usize..7, 0_usize..8),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in (rotation(), rotation()),
        (place, by) in ([-48_i32..48, -48..48, -48..48], vector(1.0)),
        exponent in 0_i32..20,
    ) {
        let place = DVec3::from_array(place.map(|c| f64::from(c) / 16.0));
        let whole = DVec3::new(1.0, -3.0, 2.0) * 2.0_f64.powi(exponent);
        let pair = |by: DVec3| (
            solid::<DVec3>(kind_a, d_a, turn_a, by, 1.0).expect("valid"),
            solid::<DVec3>(kind_b, d_b, turn_b, place + by, 1.0).expect("valid"),
        );
        let answer = |by: DVec3| { let (a, b) = pair(by); distance(&a, &b, DistanceOptions::default()) };
        let (here, there, elsewhere) = (answer(DVec3::ZERO), answer(whole), answer(by * 1e6));
        // The place of a polytope is the middle of its vertices, which need not be round.
        if kind_b < 7 {
            prop_assert_eq!((here.distance, here.lower, here.upper), (there.distance, there.lower, there.upper));
            prop_assert_eq!((here.normal, here.overlap, here.iterations), (there.normal, there.overlap, there.iterations));
        }
        let moved = 4.0 * f64::EPSILON * 1e6 + 64.0 * f64::EPSILON * (d_a.length() + d_b.length() + place.length());
        if here.status == Status::Converged && elsewhere.status == Status::Converged {
            prop_assert!((here.distance - elsewhere.distance).abs() <= moved, "{:?} {:?}", here, elsewhere);
        }
    }

    /// Names of axes, and the order of vertices, change nothing beyond 64 ulps of the size.
    #[test]
    fn neither_axes_nor_the_order_of_vertices_matter(
        a in prop::collection::vec(vector(1.0), 4..20),
        b in prop::collection::vec(vector(1.0), 4..20),
        (place, velocity, start) in (vector(3.0), vector(2.0), 0_usize..20),
    ) {
        prop_assume!(velocity.length() > 0.1);
        let solve = |a: &[DVec3], b: &[DVec3], place: DVec3, velocity: DVec3| {
            let (a, b) = (Polytope::new(a.iter().copied()), Polytope::new(b.iter().map(|&p| p + place)));
            let (a, b) = (a.expect("finite"), b.expect("finite"));
            let motion = Motion { velocity_a: velocity, velocity_b: DVec3::ZERO };
            let hit = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite").outcome.hit();
            (distance(&a, &b, DistanceOptions::default()).distance, hit)
        };
        let plain = solve(&a, &b, place, velocity);
        let mixed = |points: &[DVec3]| {
            let mut points = points.to_vec();
            points.reverse();
            let middle = start % points.len();
            points.rotate_left(middle);
            points
        };
        let permuted = |points: &[DVec3]| points.iter().map(|p| p.yzx()).collect::<Vec<_>>();
        let other_order = solve(&mixed(&a), &mixed(&b), place, velocity);
        let other_axes = solve(&permuted(&a), &permuted(&b), place.yzx(), velocity.yzx());
        let tolerance = 64.0 * f64::EPSILON * (2.0 + place.length());
        for (what, other) in [("order", other_order), ("axes", other_axes)] {
            prop_assert!((plain.0 - other.0).abs() <= tolerance, "{}: {:?} {:?}", what, plain, other);
            if let (Some(x), Some(y)) = (plain.1, other.1) {
                let slope = x.normal.map_or(1.0, |n| n.dot(velocity.normalize()).abs()).max(1e-9);
                let off = (x.time - y.time).abs() * velocity.length() * slope;
                prop_assert!(off <= tolerance, "{}: {:?} {:?}", what, plain, other);
            }
        }
    }

    /// What was asked before changes nothing: the same question between others has the same answer, to the bit.
    #[test]
    fn history_does_not_matter(
        (kind, d, turn) in (0_usize..8, sizes(), rotation()),
        places in prop::collection::vec(vector(3.0), 2..6),
    ) {
        let a = solid::<DVec3>(kind, d, turn, DVec3::ZERO, 1.0).expect("valid");
        let hull = Polytope::new((0..60).map(|i| {
            let t = f64::from(i);
            DVec3::new((1.3 * t).sin(), (2.7 * t).sin(), (4.1 * t).sin())
        })).expect("finite");
        let ask = |place: DVec3| distance(&a, &Posed::translated(&hull, place).expect("finite"), DistanceOptions::default());
        let fresh: Vec<_> = places.iter().map(|&p| ask(p)).collect();
        let again: Vec<_> = places.iter().rev().map(|&p| ask(p)).collect();
        prop_assert!(fresh.iter().eq(again.iter().rev()), "{:?} {:?}", fresh, again);
    }

    /// Swapping the bodies swaps the witnesses, and the start axis changes nothing, beyond rounding.
    #[test]
    fn neither_order_nor_start_matters(
        (kind_a, kind_b) in (0_usize..8, 0_usize..8),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in (rotation(), rotation()),
        (place, axis) in (vector(3.0), vector(1.0)),
    ) {
        let a = solid::<DVec3>(kind_a, d_a, turn_a, DVec3::ZERO, 1.0).expect("valid");
        let b = solid::<DVec3>(kind_b, d_b, turn_b, place, 1.0).expect("valid");
        let one = distance(&a, &b, DistanceOptions::default());
        let size = d_a.length() + d_b.length() + place.length();
        for other in [
            distance(&b, &a, DistanceOptions::default()),
            distance(&a, &b, DistanceOptions::new().with_axis(axis)),
        ] {
            // The brackets meet, and are as narrow as rounding, unless they say that they are not.
            prop_assert!(one.lower <= other.upper && other.lower <= one.upper, "{:?} {:?}", one, other);
            if one.status == Status::Converged && other.status == Status::Converged {
                prop_assert!((one.distance - other.distance).abs() <= 64.0 * f64::EPSILON * size, "{:?} {:?}", one, other);
            }
        }
        let meets = intersects(&a, &b, Default::default());
        prop_assert_eq!(meets.overlap, one.overlap);
    }

    /// Swapping the bodies changes no bit where nothing is known in closed form, not even where they touch and rounding
    /// decides; and all queries decide alike there, wherever they begin.
    #[test]
    fn order_changes_no_bit(
        (kind_a, kind_b) in (prop_oneof![Just(0_usize), 2_usize..8], prop_oneof![Just(0_usize), 2_usize..8]),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in prop_oneof![(rotation(), rotation()), Just((DQuat::IDENTITY, DQuat::IDENTITY))],
        (place, axis) in (prop_oneof![vector(3.0), Just(DVec3::X * 3.0)], vector(1.0)),
        ulps in -8_i32..8,
    ) {
        let a = solid::<DVec3>(kind_a, d_a, turn_a, DVec3::ZERO, 1.0).expect("valid");
        let beside = |place| solid::<DVec3>(kind_b, d_b, turn_b, place, 1.0).expect("valid");
        let apart = distance(&a, &beside(place), DistanceOptions::default());
        let touching = apart.normal.map(|n| place + n * (apart.distance + f64::from(ulps) * f64::EPSILON));
        for place in [place].into_iter().chain(touching) {
            let b = beside(place);
            let one = distance(&a, &b, DistanceOptions::default());
            let other = distance(&b, &a, DistanceOptions::default());
            let swapped = Distance {
                point_a: other.point_b,
                point_b: other.point_a,
                normal: other.normal.map(|n| -n),
                ..other
            };
            prop_assert_eq!(one, swapped);
            if one.status != Status::Converged {
                continue;
            }
            let warm = distance(&a, &b, DistanceOptions::new().with_axis(axis));
            if warm.status == Status::Converged {
                prop_assert_eq!(one.overlap, warm.overlap);
            }
            let meet = intersects(&a, &b, Default::default()).decided();
            prop_assert!(meet.is_none_or(|meet| meet == one.overlap), "{:?} {:?}", one, meet);
        }
    }

    /// The answer of a ray cast is that of the same ray elsewhere: started farther back, and with another length.
    #[test]
    fn the_ray_is_its_points(
        (kind, d, turn) in (0_usize..8, sizes(), rotation()),
        (aim, from) in (vector(1.0), vector(1.0)),
        (back, stretch) in (0_i32..12, -20_i32..20),
    ) {
        prop_assume!(from.length() > 0.1);
        let target = solid::<DVec3>(kind, d, turn, DVec3::ZERO, 1.0).expect("valid");
        let from = from.normalize() * 8.0;
        let (stretch, back) = (2.0_f64.powi(stretch), 2.0_f64.powi(back));
        let direction = aim - from;
        let near = Ray { source: from, direction };
        let far = Ray { source: from - direction * back, direction: direction * stretch };
        let near = ray_cast(&target, near, RayCastOptions::default()).expect("finite");
        let far = ray_cast(&target, far, RayCastOptions::default()).expect("finite");
        if let (Some(x), Some(y)) = (near.outcome.hit(), far.outcome.hit()) {
            let slope = x.normal.map_or(1.0, |n| -n.dot(direction.normalize())).max(1e-9);
            let tolerance = ulps::<DVec3>(256.0) * (back + 2.0) / slope;
            prop_assert!((x.lambda - (y.lambda * stretch - back)).abs() <= tolerance, "{:?} {:?}", near, far);
        }
    }

    /// Double and single precision answer the same question, to single precision.
    #[test]
    fn precisions_agree(h in sizes(), aim in vector(0.9), from in vector(1.0)) {
        prop_assume!(from.length() > 0.1);
        let (h, from) = (h.as_vec3a(), (from.normalize() * 4.0).as_vec3a());
        let direction = aim.as_vec3a() - from;
        let single = ray_cast(&Cuboid::<Vec3A>::new(h).expect("positive"), Ray { source: from, direction }, Default::default());
        let ray = Ray { source: from.as_dvec3(), direction: direction.as_dvec3() };
        let double = ray_cast(&Cuboid::new(h.as_dvec3()).expect("positive"), ray, Default::default());
        let (single, double) = (single.expect("finite"), double.expect("finite"));
        if let (Some(x), Some(y)) = (single.outcome.hit(), double.outcome.hit()) {
            prop_assert!(f64::from(single.lower) <= y.lambda && y.lambda <= f64::from(single.upper), "{:?} {:?}", single, y);
            prop_assert!(x.normal.is_none_or(|n| (n.norm().as_f64() - 1.0).abs() < ulps::<Vec3A>(4.0)));
        }
    }
}
