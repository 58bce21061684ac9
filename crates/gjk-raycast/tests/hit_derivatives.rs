//! What is mended of hits, and their one-sided rates, in space and in the plane.

use crate::common::behind_pointers::{linear_cast, motion_cast, ray_cast};
use crate::differences::{Body, Random, Solid, Space, apart, one_sided};
use convex_support::glam::{DVec2, DVec3};
use convex_support::{AngularVelocity, Cuboid, Posed, Rotation};
use gjk_raycast::{
    ClosestFeatures, Impact, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RayHit, RigidMotion,
    Smoothness,
};

const VALID: &str = "positive sizes and finite numbers";

/// By how much normals and points are made worse. Both are found again to `MENDED`, which of needles is the condition
/// times the rounding.
const WORSE: f64 = 1e-7;
const MENDED: f64 = 1e-11;

/// A hit of any kind that has a normal.
trait Hit<V: Space>: Copy {
    fn place(&self) -> (V, V);
    fn with(self, normal: V, point: V) -> Self;
    fn mended(self, features: &ClosestFeatures<V>) -> Self;
}

impl<V: Space> Hit<V> for Impact<V> {
    fn place(&self) -> (V, V) {
        (self.normal.expect("they touch later"), self.point)
    }

    fn with(self, normal: V, point: V) -> Self {
        Self { normal: Some(normal), point, ..self }
    }

    fn mended(self, features: &ClosestFeatures<V>) -> Self {
        self.refined(features)
    }
}

/// The point of a ray is where its λ is.
impl<V: Space> Hit<V> for RayHit<V> {
    fn place(&self) -> (V, V) {
        (self.normal.expect("it comes from outside"), self.point)
    }

    fn with(self, normal: V, _point: V) -> Self {
        Self { normal: Some(normal), ..self }
    }

    fn mended(self, features: &ClosestFeatures<V>) -> Self {
        self.refined(features)
    }
}

/// What is known of a hit is made worse, and mended by the features that are seen then: it is what it was. Whether it
/// is at smooth features.
fn is_mended<V: Space, H: Hit<V>>(
    random: &mut Random,
    hit: H,
    features: impl Fn(H) -> Option<ClosestFeatures<V>>,
    what: &str,
) -> bool {
    let at = features(hit).expect("what touches has features");
    if at.smoothness() == Smoothness::Edge {
        return false;
    }
    let sure = hit.mended(&at).place();
    let normal = sure.0 + random.vector::<V>(1.0) * WORSE;
    let worse = hit.with(normal / normal.length(), sure.1 + random.vector::<V>(1.0) * WORSE);
    let found = features(worse).expect("what touches has features");
    assert_eq!(found.smoothness(), Smoothness::Smooth, "{what}: {found:?}");
    let again = worse.mended(&found).place();
    let off = (again.0 - sure.0).length().max((again.1 - sure.1).length());
    assert!(off < MENDED, "{what}: off by {off:e}: {again:?}, not {sure:?}; {found:?}");
    true
}

/// A velocity that leads one body about to the other.
fn towards<V: Space>(a: &Body<V>, b: &Body<V>, random: &mut Random) -> V {
    b.shape.translation() - a.shape.translation() + random.vector::<V>(1.0) * 0.3
}

fn all_hits_are_mended<V: Space>(seed: u64, rounds: usize) {
    let mut random = Random(seed);
    let mut count = [0; 3];
    let kinds = V::KINDS;
    for round in 0..rounds * kinds.len() * kinds.len() {
        let (i, j) = (round % kinds.len(), round / kinds.len() % kinds.len());
        let a = Body::<V>::random(kinds[i], &mut random);
        let b = Body::random(kinds[j], &mut random).placed(&a, false, &mut random);
        let (a, b) = (&a, &b);
        let what = |which: &str| format!("{which} of {} and {}, round {round}", kinds[i], kinds[j]);

        let motion = Motion { velocity_a: towards(a, b, &mut random), velocity_b: random.vector::<V>(1.0) * 0.3 };
        let cast = linear_cast(&a.shape, &b.shape, motion, LinearCastOptions::new()).expect("finite");
        if let Some(hit) = cast.outcome.hit().filter(|hit| hit.normal.is_some()) {
            let [ma, mb] = motion.translations();
            let features = |hit: Impact<V>| hit.closest_features(&a.shape, &ma, &b.shape, &mb);
            count[0] += usize::from(is_mended(&mut random, hit, features, &what("the linear cast")));
        }

        let ma = RigidMotion { velocity: towards(a, b, &mut random), ..random.motion() };
        let mb = random.motion::<V>();
        let options = MotionCastOptions::new().with_max_time(3.0);
        let cast = motion_cast(&a.shape, ma, &b.shape, mb, options).expect("finite");
        if let Some(hit) = cast.outcome.hit().filter(|hit| hit.normal.is_some()) {
            let features = |hit: Impact<V>| hit.closest_features(&a.shape, &ma, &b.shape, &mb);
            count[1] += usize::from(is_mended(&mut random, hit, features, &what("the motion cast")));
        }

        let ray = Ray { source: a.shape.translation(), direction: towards(a, b, &mut random) };
        let cast = ray_cast(&b.shape, ray, RayCastOptions::new()).expect("finite");
        if let Some(hit) = cast.outcome.hit().filter(|hit| hit.normal.is_some()) {
            let features = |hit: RayHit<V>| hit.closest_features(&b.shape, ray);
            count[2] += usize::from(is_mended(&mut random, hit, features, &what("the ray cast")));
        }
    }
    let least = rounds * kinds.len() * kinds.len() / 2;
    assert!(count.iter().all(|&n| n > least), "{count:?} of more than {least}");
}

#[test]
fn hits_that_are_known_badly_are_mended_in_space() {
    all_hits_are_mended::<DVec3>(21, 4);
}

#[test]
fn hits_that_are_known_badly_are_mended_in_the_plane() {
    all_hits_are_mended::<DVec2>(22, 6);
}

/// A box above another by a gap, negative for a depth, so that faces are parallel, in a world that is turned; and the
/// direction up. Aside it stands by a part of the sizes of both: by all of them their faces have an edge or a corner in
/// common.
fn stacked<V: Space>(gap: f64, aside: f64, random: &mut Random) -> ([Body<V>; 2], V) {
    let (turn, world) = (V::rotation(random), random.vector::<V>(1.0));
    let size = |random: &mut Random| V::from_fn(|_| random.number(0.4, 1.0));
    let (sa, sb) = (size(random), size(random));
    let body = |half_extents: V, at: V| {
        let solid: Solid<V> = Box::new(Cuboid::new(half_extents).expect(VALID));
        Body { shape: Posed::new(std::rc::Rc::new(solid), turn, world + turn.matrix() * at).expect(VALID) }
    };
    let off = V::from_fn(|i| if i == 1 { sa.get(1) + sb.get(1) + gap } else { aside * (sa.get(i) + sb.get(i)) });
    ([body(sa, off), body(sb, V::ZERO)], turn.matrix() * V::from_fn(|i| f64::from(u8::from(i == 1))))
}

/// How many of `rounds` one-sided rates are those of differences to 1e-8; all are to what small steps tell, past which
/// there may be another kink.
fn are_those_of_differences(rounds: usize, mut case: impl FnMut(usize) -> (f64, Box<dyn Fn(f64) -> f64>)) {
    let mut compared = 0;
    for round in 0..rounds {
        let (ours, at) = case(round);
        let scale = 1.0 + ours.abs();
        let quotient = |t: f64| (at(t) - at(0.0)) / t;
        let near = 2.0 * quotient(1e-7) - quotient(2e-7);
        assert!((ours - near).abs() < 1e-5 * scale, "round {round}: {ours}, not {near}");
        let (theirs, _) = one_sided(at, 1e-3);
        compared += usize::from((ours - theirs).abs() < 1e-8 * scale);
    }
    assert!(compared * 10 > rounds * 8, "{compared} of {rounds}");
}

const ASIDE: [f64; 4] = [0.0, 0.3, -0.8, 1.0];

fn rates_of_distances<V: Space>(seed: u64) {
    let mut random = Random(seed);
    are_those_of_differences(400, |round| {
        // Beside one another and in overlap they are not deepest along this normal.
        let gap = [0.3, 0.01, -0.05][round % 3];
        let aside = ASIDE[round / 3 % if gap > 0.0 { 4 } else { 2 }];
        let ([a, b], _) = stacked::<V>(gap, aside, &mut random);
        let [ma, mb] = [random.motion::<V>(), random.motion()];
        let features = apart(&a.shape, &b.shape).closest_features(&a.shape, &b.shape);
        assert_eq!(features.smoothness(), Smoothness::Edge, "round {round}: {features:?}");
        let ours = features.rate(ma, mb).expect("the normal is the only one");
        (ours, Box::new(move |t| apart(&a.moved(&ma, t), &b.moved(&mb, t)).signed_distance))
    });
}

#[test]
fn rates_of_distances_are_those_of_differences_in_space() {
    rates_of_distances::<DVec3>(23);
}

#[test]
fn rates_of_distances_are_those_of_differences_in_the_plane() {
    rates_of_distances::<DVec2>(24);
}

fn rates_of_linear_casts<V: Space>(seed: u64) {
    let mut random = Random(seed);
    are_those_of_differences(200, |round| {
        let ([a, b], up) = stacked::<V>(0.4, ASIDE[round % 3], &mut random);
        // Aside by no more than leaves it above the other.
        let motion =
            Motion { velocity_a: random.vector::<V>(1.0) * 0.05 - up, velocity_b: random.vector::<V>(1.0) * 0.05 };
        let [ma, mb] = [random.motion::<V>(), random.motion()];
        let options = LinearCastOptions::new();
        let hit = linear_cast(&a.shape, &b.shape, motion, options).expect("finite").outcome.hit().expect("it lands");
        let [straight_a, straight_b] = motion.translations();
        let ours = hit.rate((&a.shape, &straight_a, ma), (&b.shape, &straight_b, mb)).expect("one normal");
        let time = move |t: f64| {
            let cast = linear_cast(&a.moved(&ma, t), &b.moved(&mb, t), motion, options).expect("finite");
            cast.outcome.hit().map_or(f64::NAN, |hit| hit.time)
        };
        (ours, Box::new(time))
    });
}

#[test]
fn rates_of_linear_casts_are_those_of_differences_in_space() {
    rates_of_linear_casts::<DVec3>(25);
}

#[test]
fn rates_of_linear_casts_are_those_of_differences_in_the_plane() {
    rates_of_linear_casts::<DVec2>(26);
}

/// Bodies that turn as they fall, and are parallel when they meet.
fn rates_of_motion_casts<V: Space>(seed: u64) {
    const TIME: f64 = 0.75;
    let mut random = Random(seed);
    are_those_of_differences(200, |round| {
        let (meeting, up) = stacked::<V>(0.0, ASIDE[round % 3], &mut random);
        // Slowly enough that all corners of the upper body fall.
        let mut motion = |down: f64| {
            let RigidMotion { velocity, angular_velocity, center } = random.motion::<V>();
            let angular_velocity = angular_velocity.scaled(0.15);
            RigidMotion { velocity: velocity * 0.1 - up * down, angular_velocity, center: center * 0.5 }
        };
        let motions = [motion(2.0), motion(0.0)];
        // Where they come from.
        let [a, b] = [0, 1].map(|i| {
            let RigidMotion { velocity, angular_velocity, center } = motions[i];
            let center = center + velocity * TIME;
            let back = RigidMotion { velocity: -velocity, angular_velocity: angular_velocity.scaled(-1.0), center };
            Body { shape: meeting[i].moved(&back, TIME) }
        });
        let [ca, cb] = [random.motion::<V>(), random.motion()];
        let options = MotionCastOptions::new().with_max_time(2.0);
        let cast = motion_cast(&a.shape, motions[0], &b.shape, motions[1], options).expect("finite");
        let hit = cast.outcome.hit().expect("they meet");
        assert!((hit.time - TIME).abs() < 1e-12, "round {round}: {hit:?}");
        let ours = hit.rate((&a.shape, &motions[0], ca), (&b.shape, &motions[1], cb)).expect("one normal");
        let time = move |t: f64| {
            let cast = motion_cast(&a.moved(&ca, t), motions[0], &b.moved(&cb, t), motions[1], options);
            cast.expect("finite").outcome.hit().map_or(f64::NAN, |hit| hit.time)
        };
        (ours, Box::new(time))
    });
}

#[test]
fn rates_of_motion_casts_are_those_of_differences_in_space() {
    rates_of_motion_casts::<DVec3>(27);
}

#[test]
fn rates_of_motion_casts_are_those_of_differences_in_the_plane() {
    rates_of_motion_casts::<DVec2>(28);
}
