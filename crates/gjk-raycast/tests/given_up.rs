//! Searches that are given up after few support points: what they have proved by then is true, and they say that they
//! were given up.

use crate::common::behind_pointers::{
    distance, intersects, linear_cast, motion_cast, ray_cast, ray_exit, signed_distance,
};
use crate::common::{Random, cuboid};
use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Capsule, Cone, Cylinder, Ellipsoid, Posed, Rounded, SupportMap, Triangle};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome, Ray, RayCastOptions,
    RigidMotion, Scene, SignedDistanceOptions, Status,
};

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

/// A shape of some kind, of sizes up to 1, in a pose.
fn solid(random: &mut Random, kind: usize, place: DVec3) -> Shape {
    let [x, y, z] = [0; 3].map(|_| random.number(0.1, 1.0));
    let shape: Shape = match kind % 7 {
        0 => Box::new(Ball::<DVec3>::new(x).unwrap()),
        1 => Box::new(cuboid::<DVec3>([x, y, z])),
        2 => Box::new(Capsule::<DVec3>::new(x, y).unwrap()),
        3 => Box::new(Rounded::new(Cylinder::<DVec3>::new(x, y).unwrap(), z).unwrap()),
        4 => Box::new(Cone::<DVec3>::new(x, y).unwrap()),
        5 => Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(x, y, z), DQuat::IDENTITY).unwrap()),
        _ => Box::new(Triangle::new([DVec3::X * x, DVec3::Y * y, DVec3::Z * z]).unwrap()),
    };
    let turn = DQuat::from_xyzw(random.number(-1.0, 1.0), x, y, z).normalize();
    Box::new(Posed::new(shape, turn, place).unwrap())
}

/// What a query has told.
#[derive(Clone, Copy, Debug)]
struct Told {
    query: &'static str,
    /// The bracket, and the value in it, if there is one.
    bracket: [f64; 2],
    value: Option<f64>,
    /// The numbers besides those, added up.
    rest: f64,
    status: Status,
}

fn of_cast<H>(
    query: &'static str,
    outcome: &Outcome<H, DVec3>,
    hit: impl Fn(&H) -> (f64, DVec3, Option<DVec3>),
    bracket: [f64; 2],
    status: Status,
) -> Told {
    let (value, rest) = match outcome {
        Outcome::Hit(found) => {
            let (at, point, normal) = hit(found);
            (Some(at), point + normal.unwrap_or(DVec3::ZERO))
        }
        // A bracket behind the end of the motion holds no time.
        Outcome::Miss(miss) => (Some(bracket[1]), miss.axis),
        Outcome::Undecided => (None, DVec3::ZERO),
    };
    Told { query, bracket, value, rest: rest.element_sum(), status }
}

/// Two bodies, their motions, and a ray.
struct Case {
    bodies: [Shape; 2],
    velocity: [DVec3; 2],
    spin: [DVec3; 2],
    ray: Ray<DVec3>,
}

impl Case {
    /// Every query, given up after some support points or times looked at.
    fn told(&self, most: Option<usize>) -> Vec<Told> {
        let Self { bodies: [a, b], velocity: [va, vb], spin: [wa, wb], ray } = self;
        macro_rules! options {
            ($options:expr) => {{
                let options = $options;
                options.with_max_iterations(most.unwrap_or(options.max_iterations))
            }};
        }
        let mut told = Vec::new();
        let there = distance(a, b, options!(DistanceOptions::new()));
        let rest = (there.point_a + there.point_b + there.normal.unwrap_or(DVec3::ZERO)).element_sum();
        let (bracket, value) = ([there.lower, there.upper], Some(there.distance));
        told.push(Told { query: "distance", bracket, value, rest, status: there.status });
        let there = signed_distance(a, b, options!(SignedDistanceOptions::new()));
        let rest = (there.point_a + there.point_b + there.normal).element_sum();
        let (bracket, value) = ([there.lower, there.upper], Some(there.signed_distance));
        told.push(Told { query: "signed distance", bracket, value, rest, status: there.status });
        let there = intersects(a, b, options!(IntersectOptions::new()));
        let value = there.decided().map(|overlap| f64::from(u8::from(overlap)));
        let (bracket, rest) = (value.map_or([0.0, 1.0], |value| [value; 2]), there.axis.unwrap_or(DVec3::ZERO).x);
        told.push(Told { query: "intersects", bracket, value, rest, status: there.status });

        let motion = Motion { velocity_a: *va, velocity_b: *vb };
        let cast = linear_cast(a, b, motion, options!(LinearCastOptions::new().with_max_time(3.0))).unwrap();
        let bracket = [cast.lower, cast.upper];
        told.push(of_cast("linear cast", &cast.outcome, |h| (h.time, h.point, h.normal), bracket, cast.status));
        let turning = |velocity, angular_velocity| RigidMotion { velocity, angular_velocity, center: DVec3::Z };
        let options = options!(MotionCastOptions::new().with_max_time(3.0));
        let cast = motion_cast(a, turning(*va, *wa), b, turning(*vb, *wb), options).unwrap();
        let bracket = [cast.lower, cast.upper];
        told.push(of_cast("motion cast", &cast.outcome, |h| (h.time, h.point, h.normal), bracket, cast.status));
        for (query, options) in
            [("ray cast", RayCastOptions::new()), ("late ray cast", RayCastOptions::new().with_min_lambda(0.1))]
        {
            let cast = ray_cast(a, *ray, options!(options)).unwrap();
            let bracket = [cast.lower, cast.upper];
            told.push(of_cast(query, &cast.outcome, |h| (h.lambda, h.point, h.normal), bracket, cast.status));
        }
        let exit = ray_exit(a, *ray, options!(RayCastOptions::new())).unwrap();
        let bracket = [exit.lower, exit.upper];
        told.push(of_cast("ray exit", &exit.outcome, |h| (h.lambda, h.point, h.normal), bracket, exit.status));
        let scene = Scene::new([a, b]).unwrap();
        let first = scene.all().ray_cast(*ray, options!(RayCastOptions::new())).unwrap();
        let status = if first.is_certain() { Status::Converged } else { Status::Stalled };
        let upper = first.first.as_ref().map_or(f64::INFINITY, |first| first.upper);
        let bracket = [first.lower, if first.undecided.is_none() { upper } else { f64::INFINITY }];
        told.push(Told { query: "scene", bracket, value: None, rest: 0.0, status });
        told
    }
}

/// A cap on the iterations costs width, and no truth: brackets hold what a search to the end finds, an answer lies in
/// its own, all of it is numbers, and whoever has given up does not say that it has converged. `distance` once called
/// that bodies *overlap* and *converged* if it was allowed no search for a plane between them, and *stalled* where it
/// had been given up.
#[test]
fn what_was_proved_before_a_search_is_given_up_is_true() {
    let mut random = Random(0x1234_5678_9abc);
    for i in 0..49 {
        let place: DVec3 = random.vector(1.5);
        let bodies = [solid(&mut random, i, place), solid(&mut random, i / 7, DVec3::ZERO)];
        let velocity = [random.vector::<DVec3>(1.0) - place, random.vector(0.5)];
        let spin = [random.vector(1.0), random.vector(1.0)];
        let source: DVec3 = random.vector(4.0);
        let ray = Ray { source, direction: place - source + random.vector::<DVec3>(0.5) };
        let case = Case { bodies, velocity, spin, ray };
        let full = case.told(None);
        for most in [0, 1, 2, 3, 5, 8] {
            for (few, full) in case.told(Some(most)).iter().zip(&full) {
                let Told { query, bracket: [lower, upper], value, rest, status } = *few;
                let what = || format!("{query} of {i} after {most}: {few:?}, and to the end {full:?}");
                assert!(lower <= full.bracket[1] && full.bracket[0] <= upper, "the truth is outside: {}", what());
                assert!(lower <= upper && value.is_none_or(|x| lower <= x && x <= upper), "{}", what());
                assert!(rest.is_finite(), "{}", what());
                let is_told = status != Status::Converged || query == "scene" || value.is_some();
                assert!(is_told, "converged to nothing: {}", what());
                assert!(
                    status != Status::Stalled || query == "scene" || full.status != Status::Converged,
                    "{}",
                    what()
                );
            }
        }
    }
}

/// Two crooked segments that pass one another by 3e-15: to overlap needs a proof as much as to be apart. With no
/// search for a plane allowed, `intersects` called the best plane it had, which was none, too deep to look behind,
/// and the overlap certain.
#[test]
fn bodies_between_which_no_plane_was_looked_for_do_not_overlap_for_certain() {
    let turn = DQuat::from_xyzw(0.3, -0.4, 0.5, 0.7).normalize();
    for gap in [0.0, 1e-15, 3e-15, 1e-14] {
        let rod = |along: DVec3, at: DVec3| {
            let ends = [at - along, at + along * 0.7].map(|end| turn * end);
            convex_support::Segment::new(ends).unwrap()
        };
        let (a, b) = (rod(DVec3::new(1.0, 0.2, 0.0), DVec3::Z * gap), rod(DVec3::new(-0.1, 1.0, 0.0), DVec3::ZERO));
        let full = distance(&a, &b, DistanceOptions::new());
        for most in 0..9 {
            let few = intersects(&a, &b, IntersectOptions::new().with_max_iterations(most));
            assert!(!(few.decided() == Some(true) && full.lower > 0.0), "{gap:e} after {most}: {few:?}, but {full:?}");
        }
    }
}
