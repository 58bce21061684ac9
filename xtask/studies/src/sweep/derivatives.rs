//! Derivatives of every query about random regular pairs, with differences in thirty digits.
//!
//! Along a random motion of both bodies, and with the parameters of a cast changing too, `(f(h) − f(−h))/2h` of a
//! distance in thirty digits is the first derivative to some twenty of them, and the second difference the second
//! derivative to twelve. The time `t` of a hit is where the distance `s(t, θ)` vanishes, so that `dt =
//! −(∂s/∂θ)/(∂s/∂t)`, of which both are differences. There `‖x − y‖` has no derivative, and so `a` is held off by a
//! shift along the normal, with which both derivatives stay what they are.
//!
//! A distance is known to a few ε, and so the time of a hit to that over the closing speed `|∂s/∂t|`, whatever computes
//! it. What the derivative is at the times that this leaves open is all right: near grazing it changes with the square
//! of one over the closing speed.
//!
//! Left out, and counted, is what has no difference: near an edge or a face, or within a needle's tip of it.

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{AngularVelocity, Scalar, Vector3};
use gjk_raycast::{
    ClosestFeatures, DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RigidMotion,
    SignedDistanceOptions, Smoothness, distance, linear_cast, motion_cast, ray_cast, signed_distance,
};
use workloads::real::{DoubleDouble, Real};
use workloads::rng::Rng;
use workloads::shapes::{Shape, hull_points};
use workloads::vec3::{Vec3, add, dot, scale, sub, wide};

use super::judge::Verdict;
use super::local::{Local, Stationary, turned};
use super::questions::FINITE;
use super::solid::{Form, Solid, coordinates, rounded, vector};
use super::{Question, Row};

const SUBJECTS: [&str; 5] = ["distance", "signed-distance", "ray-cast", "linear-cast", "motion-cast"];

/// One cell for each kind of query and each precision.
pub(super) fn cells(only: &str) -> Vec<Row> {
    let subjects = SUBJECTS.into_iter().filter(|subject| subject.contains(only));
    subjects.flat_map(|s| [false, true].map(|single| Row::new(Question::Derivatives, s, single, 1.0, 1.0))).collect()
}

/// `queries` are those of all cells together.
pub(super) fn fill(mut cell: Row, queries: u64, cells: u64, seed: u64) -> Row {
    let name = cell.subject.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut rng = Rng::new(name);
    cell.allowed = if cell.is_single { 1e-3 } else { 1e-9 };
    let queries = queries.div_ceil(cells);
    while cell.queries < queries {
        if cell.is_single {
            ask::<Vec3A>(&mut cell, &mut rng);
        } else {
            ask::<DVec3>(&mut cell, &mut rng);
        };
    }
    cell
}

fn ask<V: Vector3>(cell: &mut Row, rng: &mut Rng) {
    let case = Case::new::<V>(cell.subject, rng);
    let judged = match cell.subject {
        "distance" => case.of_distance::<V>(true),
        "signed-distance" => case.of_distance::<V>(false),
        "ray-cast" => case.of_ray_cast::<V>(),
        "linear-cast" => case.of_linear_cast::<V>(),
        _ => case.of_motion_cast::<V>(),
    };
    let verdict = match judged {
        // Another is drawn where nothing is hit.
        Judged::Missed => return,
        Judged::Irregular => Verdict { unconverged: true, ..Verdict::default() },
        Judged::Compared { error, second } => {
            let violation = error.max(second.unwrap_or(0.0)) > cell.allowed;
            Verdict { error: Some(error), excess: second, violation, ..Verdict::default() }
        }
    };
    cell.add(&verdict, || format!("a {}, b {}, {case:?}", case.a.described(), case.b.described()));
}

/// How an answer compares.
enum Judged {
    Missed,
    Irregular,
    /// The errors of the first derivative, and of the second where there is one, in units of one plus the derivative.
    Compared {
        error: f64,
        second: Option<f64>,
    },
}

/// What rounding makes of a distance of bodies of a size about one and as far from zero, in units of ε.
const ROUNDING: f64 = 16.0;

impl Judged {
    /// By the derivatives of the distance at a time, by the change and by the time: how far off a derivative of the
    /// time of a hit is from what it is at the times that rounding leaves open.
    fn of_hit<V: Vector3>(ours: f64, time: f64, slopes: impl Fn(f64) -> Option<[f64; 2]>) -> Self {
        let Some([by_change, by_time]) = slopes(time) else { return Self::Irregular };
        let truth = -by_change / by_time;
        let open = ROUNDING * V::Scalar::EPSILON.as_f64() / by_time.abs();
        let others = [time - open, time + open].map(|t| slopes(t).map_or(truth, |[s, t]| -s / t));
        let [least, most] = others.into_iter().fold([truth; 2], |[l, m], x| [l.min(x), m.max(x)]);
        // NaN is no number between them.
        let nearest = if ours > most { most } else { least.max(ours.min(most)) };
        Self::Compared { error: (ours - nearest).abs() / (1.0 + truth.abs()), second: None }
    }
}

/// A velocity, an angular velocity and a centre, whose numbers are numbers of the precision asked.
#[derive(Clone, Copy, Debug)]
struct Rigid {
    velocity: Vec3,
    angular_velocity: Vec3,
    center: Vec3,
}

impl Rigid {
    fn new<V: Vector3>(rng: &mut Rng) -> Self {
        let mut draw = || rng.cube().map(rounded::<V>);
        Self { velocity: draw(), angular_velocity: draw(), center: draw() }
    }

    fn motion<V: Vector3>(&self) -> RigidMotion<V> {
        let turn = V::AngularVelocity::from_coordinates(|i| V::Scalar::from_f64(self.angular_velocity[i]));
        RigidMotion { velocity: vector(self.velocity), angular_velocity: turn, center: vector(self.center) }
    }

    /// Where a body is after a time.
    fn of(&self, body: &Local, time: DoubleDouble) -> Local {
        let [v, w, c] = [self.velocity, self.angular_velocity, self.center].map(wide);
        body.moved(scale(w, time), c, scale(v, time))
    }

    /// Where a point was, and what a vector was, before it.
    fn back(&self, point: Vec3, v: Vec3, time: f64) -> [Vec3; 2] {
        let turn = scale(wide(self.angular_velocity), DoubleDouble::from(-time));
        let arm = sub(sub(wide(point), wide(self.center)), scale(wide(self.velocity), DoubleDouble::from(time)));
        [add(wide(self.center), turned(turn, arm)), turned(turn, wide(v))].map(|v| v.map(Real::f64))
    }

    /// With parameters that change at the rates of another.
    fn changed(&self, rates: &Self, step: f64) -> Wide {
        let moved = |from: Vec3, rate: Vec3| add(wide(from), scale(wide(rate), DoubleDouble::from(step)));
        Wide {
            velocity: moved(self.velocity, rates.velocity),
            angular_velocity: moved(self.angular_velocity, rates.angular_velocity),
            center: moved(self.center, rates.center),
        }
    }
}

/// The same in thirty digits.
struct Wide {
    velocity: Vec3<DoubleDouble>,
    angular_velocity: Vec3<DoubleDouble>,
    center: Vec3<DoubleDouble>,
}

impl Wide {
    fn of(&self, body: &Local, time: DoubleDouble) -> Local {
        body.moved(scale(self.angular_velocity, time), self.center, scale(self.velocity, time))
    }
}

/// Two bodies, how they move in casts, and how all of it changes.
#[derive(Clone, Debug)]
struct Case {
    a: Solid,
    b: Solid,
    motions: [Rigid; 2],
    changes: [Rigid; 2],
    /// Changes of the motions' parameters.
    rates: [Rigid; 2],
}

/// How far `a` is held off at a hit.
const SHIFT: f64 = 0.5;

impl Case {
    fn new<V: Vector3>(subject: &str, rng: &mut Rng) -> Self {
        let place = |rng: &mut Rng| rng.cube().map(rounded::<V>);
        let solid = |rng: &mut Rng| Solid::new(form::<V>(rng), rng.quat().map(rounded::<V>), place(rng));
        let (mut a, b) = (solid(rng), solid(rng));
        let share = rng.unit();
        let gap = match subject {
            // From 0.001 on, or 0.02 in single precision.
            "distance" => 10.0_f64.powf(if is_single::<V>() { -1.7 } else { -3.0 } * share),
            "signed-distance" if rng.below(2) == 0 => -0.02 - 0.2 * share,
            _ => 0.05 + 0.95 * share,
        };
        let built = b.build::<DVec3>();
        let mut aim = [0.0; 3];
        for _ in 0..6 {
            let answer = signed_distance(&a.build::<DVec3>(), &built, SignedDistanceOptions::default());
            let (off, n) = (gap - answer.signed_distance, answer.normal.to_array());
            let at = [0, 1, 2].map(|i| rounded::<V>(a.translation[i] + off * n[i]));
            a = Solid::new(a.form, a.rotation, at);
            aim = (answer.point_b - answer.point_a).to_array();
            // Never as deep along two normals.
            if gap > 0.0 || answer.signed_distance < 0.9 * gap {
                break;
            }
        }
        let mut draw = || Rigid::new::<V>(rng);
        let [mut first, second, c, d, e, f] = [(); 6].map(|()| draw());
        // Towards the other, to arrive within about one unit of time.
        let length = DVec3::from_array(aim).length().max(1e-3);
        first.velocity = [0, 1, 2]
            .map(|i| rounded::<V>(1.5 * gap.max(0.0) / length * aim[i] + 0.3 * first.velocity[i] + second.velocity[i]));
        Self { a, b, motions: [first, second], changes: [c, d], rates: [e, f] }
    }

    fn of_distance<V: Vector3>(&self, is_apart: bool) -> Judged {
        // Where they are, in doubles.
        let answer = signed_distance(&self.a.build::<DVec3>(), &self.b.build::<DVec3>(), tight());
        let features = answer.closest_features(&self.a.build::<DVec3>(), &self.b.build::<DVec3>());
        if features.smoothness() == Smoothness::Edge {
            return Judged::Irregular;
        }
        let normal = features.normal().to_array();
        let locals = [
            Local::new(&self.a, features.point_a().to_array(), normal.map(|c| -c)),
            Local::new(&self.b, features.point_b().to_array(), normal),
        ];
        let [Some(a), Some(b)] = locals else { return Judged::Irregular };
        let cores = answer.signed_distance + a.radius + b.radius;
        let Some(stationary) = Stationary::new(&a, &b, cores.signum()) else { return Judged::Irregular };
        let moved = |h: f64| {
            let time = DoubleDouble::from(h);
            stationary.distance(&self.changes[0].of(&a, time), &self.changes[1].of(&b, time))
        };
        let Some(first) = slope(moved) else { return Judged::Irregular };

        // What is asked.
        let (a, b) = (self.a.build::<V>(), self.b.build::<V>());
        let features = if is_apart {
            distance(&a, &b, DistanceOptions::default()).closest_features(&a, &b)
        } else {
            Some(signed_distance(&a, &b, SignedDistanceOptions::default()).closest_features(&a, &b))
        };
        let Some(features) = features.filter(|f| f.smoothness() == Smoothness::Smooth) else {
            return Judged::Irregular;
        };
        let [ma, mb] = self.changes.map(|change| change.motion::<V>());
        let error = off(features.gradient().along(ma, mb).as_f64(), first);
        let second = (!is_single::<V>()).then(|| curvature(moved)).flatten().map(|second| {
            let Some(hessian) = features.hessian(ma.center, mb.center) else { return f64::INFINITY };
            let [x, y] = [ma, mb].map(|m| (m.velocity, m.angular_velocity));
            let two = V::Scalar::from_f64(2.0);
            off(
                (hessian.a.between(x, x) + hessian.mixed.between(x, y) * two + hessian.b.between(y, y)).as_f64(),
                second,
            )
        });
        Judged::Compared { error, second }
    }

    fn of_ray_cast<V: Vector3>(&self) -> Judged {
        // A point of `a` on its way.
        let (source, direction) = (self.a.translation, self.motions[0].velocity);
        let options = RayCastOptions::default().with_max_lambda(Scalar::from_f64(4.0));
        let target = self.b.build::<DVec3>();
        let ray = Ray { source: vector(source), direction: vector(direction) };
        let wide_options = RayCastOptions::default().with_max_lambda(4.0);
        let cast = ray_cast(&target, ray, wide_options).expect(FINITE);
        let Some(hit) = cast.outcome.hit() else { return Judged::Missed };
        let Some(features) = hit.closest_features(&target, ray) else { return Judged::Missed };
        if features.smoothness() == Smoothness::Edge {
            return Judged::Irregular;
        }
        let hit = hit.refined(&features);
        let normal = features.normal().to_array();
        let tip = Local::point(source);
        let Some(local) = Local::new(&self.b, features.point_b().to_array(), normal) else { return Judged::Irregular };
        let still = Rigid { angular_velocity: [0.0; 3], ..self.motions[0] };
        let rates = Rigid { angular_velocity: [0.0; 3], center: [0.0; 3], ..self.rates[0] };
        let shift = Rigid { angular_velocity: [0.0; 3], velocity: self.changes[0].velocity, ..still };
        let (time, changes) = (hit.lambda, self.changes);
        let slopes = |time: f64| {
            differences(
                normal,
                time,
                |h, time| still.changed(&rates, h).of(&shift.of(&tip, DoubleDouble::from(h)), time),
                |h, _| changes[1].of(&local, DoubleDouble::from(h)),
            )
        };

        let target = self.b.build::<V>();
        let ray = Ray { source: vector(source), direction: vector(direction) };
        let cast = ray_cast(&target, ray, options).expect(FINITE);
        let Some(hit) = cast.outcome.hit() else { return Judged::Irregular };
        let Some(features) = hit.closest_features(&target, ray) else { return Judged::Irregular };
        let Some(gradient) = hit.refined(&features).gradient(ray) else { return Judged::Irregular };
        let along = |by: V, rate: Vec3| dot(coordinates(by), rate);
        let ours = self.changes[1].motion().rate_of(gradient.target).as_f64()
            + along(gradient.source, shift.velocity)
            + along(gradient.direction, rates.velocity);
        Judged::of_hit::<V>(ours, time, slopes)
    }

    fn of_linear_cast<V: Vector3>(&self) -> Judged {
        let velocities = self.motions.map(|motion| motion.velocity);
        let (a, b) = (self.a.build::<DVec3>(), self.b.build::<DVec3>());
        let motion = Motion { velocity_a: vector(velocities[0]), velocity_b: vector(velocities[1]) };
        let options = LinearCastOptions::default().with_max_time(4.0);
        let cast = linear_cast(&a, &b, motion, options).expect(FINITE);
        let Some(hit) = cast.outcome.hit() else { return Judged::Missed };
        let [ma, mb] = motion.translations();
        let Some(features) = hit.closest_features(&a, &ma, &b, &mb) else { return Judged::Missed };
        if features.smoothness() == Smoothness::Edge || hit.time == 0.0 {
            return Judged::Irregular;
        }
        let motions = self.motions.map(|motion| Rigid { angular_velocity: [0.0; 3], ..motion });
        let rates = self.rates.map(|rate| Rigid { angular_velocity: [0.0; 3], center: [0.0; 3], ..rate });
        let Some(slopes) = self.slopes(motions, rates, &features, hit.time) else { return Judged::Irregular };
        let time = hit.time;

        let (a, b) = (self.a.build::<V>(), self.b.build::<V>());
        let motion = Motion { velocity_a: vector(velocities[0]), velocity_b: vector(velocities[1]) };
        let options = LinearCastOptions::default().with_max_time(Scalar::from_f64(4.0));
        let cast = linear_cast(&a, &b, motion, options).expect(FINITE);
        let Some(hit) = cast.outcome.hit() else { return Judged::Irregular };
        let [ma, mb] = motion.translations();
        let Some(features) = hit.closest_features(&a, &ma, &b, &mb) else { return Judged::Irregular };
        let Some(gradient) = hit.refined(&features).gradient(&ma, &mb) else { return Judged::Irregular };
        let by_velocity = coordinates(gradient.contact_a.translation * hit.time);
        let ours = self.changes[0].motion().rate_of(gradient.pose_a).as_f64()
            + self.changes[1].motion().rate_of(gradient.pose_b).as_f64()
            + dot(by_velocity, rates[0].velocity)
            - dot(by_velocity, rates[1].velocity);
        Judged::of_hit::<V>(ours, time, slopes)
    }

    fn of_motion_cast<V: Vector3>(&self) -> Judged {
        let (a, b) = (self.a.build::<DVec3>(), self.b.build::<DVec3>());
        let [ma, mb] = self.motions.map(|motion| motion.motion::<DVec3>());
        let options = MotionCastOptions::default().with_max_time(2.0);
        let cast = motion_cast(&a, ma, &b, mb, options).expect(FINITE);
        let Some(hit) = cast.outcome.hit() else { return Judged::Missed };
        let Some(features) = hit.closest_features(&a, &ma, &b, &mb) else { return Judged::Missed };
        if features.smoothness() == Smoothness::Edge || hit.time == 0.0 {
            return Judged::Irregular;
        }
        let Some(slopes) = self.slopes(self.motions, self.rates, &features, hit.time) else { return Judged::Irregular };
        let time = hit.time;

        let (a, b) = (self.a.build::<V>(), self.b.build::<V>());
        let [ma, mb] = self.motions.map(|motion| motion.motion::<V>());
        let options = MotionCastOptions::default().with_max_time(Scalar::from_f64(2.0));
        let cast = motion_cast(&a, ma, &b, mb, options).expect(FINITE);
        let Some(hit) = cast.outcome.hit() else { return Judged::Irregular };
        let Some(features) = hit.closest_features(&a, &ma, &b, &mb) else { return Judged::Irregular };
        let hit = hit.refined(&features);
        let Some(gradient) = hit.gradient(&ma, &mb) else { return Judged::Irregular };
        let mut ours = self.changes[0].motion().rate_of(gradient.pose_a).as_f64()
            + self.changes[1].motion().rate_of(gradient.pose_b).as_f64();
        for (motion, contact, rate) in
            [(ma, gradient.contact_a, self.rates[0]), (mb, gradient.contact_b, self.rates[1])]
        {
            let by = motion.gradient(hit.time, contact);
            let turn = [0, 1, 2].map(|i| by.angular_velocity.coordinate(i).as_f64());
            ours += dot(coordinates(by.velocity), rate.velocity)
                + dot(coordinates(by.center), rate.center)
                + dot(turn, rate.angular_velocity);
        }
        Judged::of_hit::<V>(ours, time, slopes)
    }

    /// The derivatives of the distance at times near a hit: by the changes of poses and motions together, and by the
    /// time.
    fn slopes(
        &self,
        motions: [Rigid; 2],
        rates: [Rigid; 2],
        features: &ClosestFeatures<DVec3>,
        time: f64,
    ) -> Option<impl Fn(f64) -> Option<[f64; 2]>> {
        let normal = features.normal().to_array();
        let local = |i: usize, solid: &Solid, point: DVec3, outward: Vec3| {
            let [p, n] = motions[i].back(point.to_array(), outward, time);
            Local::new(solid, p, n)
        };
        let a = local(0, &self.a, features.point_a(), normal.map(|c| -c))?;
        let b = local(1, &self.b, features.point_b(), normal)?;
        let changes = self.changes;
        let at = move |i: usize, body: &Local, h: f64, time| {
            motions[i].changed(&rates[i], h).of(&changes[i].of(body, DoubleDouble::from(h)), time)
        };
        Some(move |time| differences(normal, time, |h, time| at(0, &a, h, time), |h, time| at(1, &b, h, time)))
    }
}

/// The derivatives of the distance of two bodies, of which the first is held off by a shift along the normal: by `h`,
/// and by the time.
fn differences(
    normal: Vec3,
    time: f64,
    a: impl Fn(f64, DoubleDouble) -> Local,
    b: impl Fn(f64, DoubleDouble) -> Local,
) -> Option<[f64; 2]> {
    let shift = scale(wide(normal), DoubleDouble::from(SHIFT));
    let zero = wide([0.0; 3]);
    let held = |h, time| [a(h, time).moved(zero, zero, shift), b(h, time)];
    let now = DoubleDouble::from(time);
    let [at_a, at_b] = held(0.0, now);
    let stationary = Stationary::new(&at_a, &at_b, 1.0)?;
    let distance = |[a, b]: [Local; 2]| stationary.distance(&a, &b);
    Some([slope(|h| distance(held(h, now)))?, slope(|h| distance(held(0.0, now + DoubleDouble::from(h))))?])
}

fn tight() -> SignedDistanceOptions<DVec3> {
    SignedDistanceOptions::default().with_tolerance(1e-14)
}

fn is_single<V: Vector3>() -> bool {
    V::Scalar::EPSILON.as_f64() > f64::EPSILON
}

/// A shape of a size about one; of ellipsoids the square of the aspect, which is the condition, is up to 1e8, and 1e4
/// in single precision, which knows the tip of no thinner one to a thousandth.
fn form<V: Vector3>(rng: &mut Rng) -> Form {
    let s = [0; 3].map(|_| rounded::<V>(0.2 + 0.8 * rng.unit()));
    let shape = match rng.below(9) {
        0 => Shape::Ball { radius: s[0] },
        1 => Shape::Ellipsoid { semi_axes: s },
        2 => {
            let thin =
                [0; 2].map(|_| rounded::<V>(10.0_f64.powf(if is_single::<V>() { -2.0 } else { -4.0 } * rng.unit())));
            Shape::Ellipsoid { semi_axes: [1.0, thin[0], thin[1]] }
        }
        3 => Shape::Cuboid { half_extents: s },
        4 => Shape::Capsule { half_height: s[0], radius: 0.5 * s[1] },
        5 => Shape::Cylinder { half_height: s[0], radius: s[1] },
        6 => Shape::Cone { half_height: s[0], radius: s[1] },
        7 => Shape::Hull { points: hull_points(8 + 8 * rng.below(3) as u16) },
        _ => Shape::RoundBox { half_extents: s, radius: rounded::<V>(0.1) },
    };
    shape.into()
}

/// The steps of the differences, and how much the differences of the step and of twice the step may differ, so that
/// what is extrapolated from both is right.
const FIRST: (f64, f64) = (1e-11, 1e-10);
const SECOND: (f64, f64) = (1e-8, 1e-7);

/// The derivative at zero.
fn slope(f: impl Fn(f64) -> Option<DoubleDouble>) -> Option<f64> {
    let of = |h: f64| Some(((f(h)? - f(-h)?) / DoubleDouble::from(2.0 * h)).f64());
    extrapolated(of, FIRST)
}

/// The second derivative at zero.
fn curvature(f: impl Fn(f64) -> Option<DoubleDouble>) -> Option<f64> {
    let at = f(0.0)?;
    let of = |h: f64| Some(((f(h)? - at - at + f(-h)?) / DoubleDouble::from(h * h)).f64());
    extrapolated(of, SECOND)
}

fn extrapolated(of: impl Fn(f64) -> Option<f64>, (step, slack): (f64, f64)) -> Option<f64> {
    let [near, far] = [of(step)?, of(2.0 * step)?];
    let is_right = (near - far).abs() <= slack * (1.0 + near.abs());
    is_right.then(|| near + (near - far) / 3.0)
}

/// In units of one plus the amount of what is true.
fn off(ours: f64, truth: f64) -> f64 {
    (ours - truth).abs() / (1.0 + truth.abs())
}
