//! Questions to a scene of many bodies: the same bodies and questions for the bench `scene`, which times them, and for
//! `cargo xtask growth`, which draws how their times grow.

#[cfg(feature = "parry")]
pub mod parry;

use convex_support::{Ball, Cuboid, Posed, Scalar, SupportMap, Vector};
use gjk_raycast::{
    BodyDistance, DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, PairDistance, Ray, RayCastOptions,
    RigidMotion, Scene, SceneLinearCast, SceneMotionCast, SceneRayCast,
};
use workloads::rng::Rng;

/// The radius of the balls in the scene, and of the one that it is asked about.
pub const RADIUS: f64 = 0.3;
/// Half the edges of the box that turns as it is cast.
pub const HALF_EXTENTS: [f64; 3] = [0.2, 0.3, 0.25];
/// How far the bodies may be from the ball that are asked for.
pub const WITHIN: f64 = 1.0;
/// How near pairs are.
pub const NEAR: f64 = 0.05;
/// When a turning cast ends: after some sixteen of a box's sizes.
pub const END: f64 = 10.0;

/// Places at random, as dense for any number of bodies: one to eight units of volume.
#[must_use]
pub fn places(count: usize) -> Vec<[f64; 3]> {
    let mut rng = Rng::new(90_000 + count as u64);
    let side = side(count);
    (0..count).map(|_| [0; 3].map(|_| side * rng.unit())).collect()
}

/// The side of the cube that the bodies are in.
#[must_use]
pub fn side(count: usize) -> f64 {
    2.0 * (count as f64).cbrt()
}

/// Where something starts, the velocity at which it moves, and that at which it turns.
pub type Question = [[f64; 3]; 3];

/// Questions at random from within the cube.
#[must_use]
pub fn questions(side: f64, count: usize) -> Vec<Question> {
    let mut rng = Rng::new(90_003);
    let question = |_| {
        let source = [0; 3].map(|_| side * rng.unit());
        [source, [0; 3].map(|_| rng.signed()), [0; 3].map(|_| rng.signed())]
    };
    (0..count).map(question).collect()
}

/// A vector of these coordinates.
#[must_use]
pub fn vector<V: Vector>(v: [f64; 3]) -> V {
    V::from_fn(|i| Scalar::from_f64(v[i]))
}

/// A shape at one of the places.
///
/// # Panics
/// Never: places are finite.
pub fn posed<S: SupportMap>(shape: S, place: [f64; 3]) -> Posed<S> {
    Posed::translated(shape, vector(place)).expect("finite")
}

/// The ball of the scene.
///
/// # Panics
/// Never: its radius is positive.
#[must_use]
pub fn ball<V: Vector>() -> Ball<V> {
    Ball::new(Scalar::from_f64(RADIUS)).expect("a radius")
}

/// The box.
///
/// # Panics
/// Never: its half extents are positive.
#[must_use]
pub fn cuboid<V: Vector>() -> Cuboid<V> {
    Cuboid::new(vector(HALF_EXTENTS)).expect("half extents")
}

/// The scene of balls at these places.
///
/// # Panics
/// Never: places are finite.
#[must_use]
pub fn balls<V: Vector>(places: &[[f64; 3]]) -> Scene<Posed<Ball<V>>> {
    Scene::new(places.iter().map(|&place| posed(ball(), place))).expect("finite")
}

/// The first body on a ray.
///
/// # Panics
/// Never: questions are finite, and none moves at zero velocity.
pub fn ray_cast<S: SupportMap>(scene: &Scene<S>, [source, direction, _]: Question) -> SceneRayCast<S::Vector> {
    let ray = Ray { source: vector(source), direction: vector(direction) };
    scene.all().ray_cast(ray, RayCastOptions::default()).expect("a good ray")
}

/// How far the nearest body is from a ball.
pub fn nearest<S: SupportMap>(scene: &Scene<S>, [source, ..]: Question) -> f64 {
    let nearest = scene.all().nearest(&posed(ball(), source), DistanceOptions::default()).nearest;
    nearest.map_or(f64::INFINITY, |nearest| nearest.distance.distance.as_f64())
}

/// The bodies near a ball.
pub fn all_within<S: SupportMap>(scene: &Scene<S>, [source, ..]: Question, found: &mut Vec<BodyDistance<S::Vector>>) {
    let within = Scalar::from_f64(WITHIN);
    scene.all().all_within(&posed(ball(), source), within, DistanceOptions::default(), found);
}

/// The first body that a ball meets.
///
/// # Panics
/// Never: questions are finite.
pub fn linear_cast<S: SupportMap>(scene: &Scene<S>, [source, velocity, _]: Question) -> SceneLinearCast<S::Vector> {
    let motion = Motion { velocity_a: vector(velocity), velocity_b: Vector::ZERO };
    scene.all().linear_cast(&posed(ball(), source), motion, LinearCastOptions::default()).expect("a good motion")
}

/// The first body that a box meets as it turns.
///
/// # Panics
/// Never: questions are finite.
pub fn motion_cast<V: Vector<AngularVelocity = V>, S: SupportMap<Vector = V>>(
    scene: &Scene<S>,
    [source, velocity, angular_velocity]: Question,
) -> SceneMotionCast<V> {
    let [velocity, angular_velocity, center] = [velocity, angular_velocity, source].map(vector);
    let motion = RigidMotion { velocity, angular_velocity, center };
    let options = MotionCastOptions::default().with_max_time(Scalar::from_f64(END));
    scene.all().motion_cast(&posed(cuboid(), source), motion, options).expect("a good motion")
}

/// All pairs that are near each other.
pub fn pairs<S: SupportMap>(scene: &Scene<S>, found: &mut Vec<PairDistance<S::Vector>>) {
    scene.all().pairs_within(Scalar::from_f64(NEAR), DistanceOptions::default(), found);
}
