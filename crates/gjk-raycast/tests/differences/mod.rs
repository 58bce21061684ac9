//! Differences of high order, and random bodies to take them of.

use std::rc::Rc;

use convex_support::glam::{DMat2, DMat3, DQuat, DVec2, DVec3};
use convex_support::{
    AngularVelocity, Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rounded, SupportMap, Vector,
};
use gjk_raycast::{RigidMotion, SignedDistance, SignedDistanceOptions, Trajectory, signed_distance};

/// Differences, extrapolated to a step of zero (Ridders, 1982), and an estimate of the error; `order` is that by which
/// the first neglected powers of the step rise.
fn extrapolated(quotient: impl Fn(f64) -> f64, first: f64, order: i32) -> (f64, f64) {
    const SIZE: usize = 12;
    const SHRINK: f64 = 1.8;
    let mut table = [[0.0; SIZE]; SIZE];
    let (mut best, mut error) = (f64::NAN, f64::INFINITY);
    let mut h = first;
    for i in 0..SIZE {
        table[0][i] = quotient(h);
        h /= SHRINK;
        for j in 1..=i {
            let factor = SHRINK.powi(order * j as i32);
            table[j][i] = (table[j - 1][i] * factor - table[j - 1][i - 1]) / (factor - 1.0);
            let off = (table[j][i] - table[j - 1][i]).abs().max((table[j][i] - table[j - 1][i - 1]).abs());
            if off <= error {
                (best, error) = (table[j][i], off);
            }
        }
    }
    (best, error)
}

/// The derivative at zero by central differences, and an estimate of its error.
pub(crate) fn central(f: impl Fn(f64) -> f64, first: f64) -> (f64, f64) {
    extrapolated(|h| (f(h) - f(-h)) / (2.0 * h), first, 2)
}

/// The derivative at zero from above.
pub(crate) fn one_sided(f: impl Fn(f64) -> f64, first: f64) -> (f64, f64) {
    let at = f(0.0);
    extrapolated(|h| (f(h) - at) / h, first, 1)
}

/// How a derivative compares with differences: those that are known well enough must agree.
#[derive(Default)]
pub(crate) struct Comparison {
    compared: usize,
    vague: usize,
    worst: f64,
}

impl Comparison {
    pub(crate) fn add(&mut self, ours: f64, (theirs, error): (f64, f64), what: &dyn Fn() -> String) {
        let scale = 1.0 + ours.abs();
        if error.is_nan() || error >= 1e-7 * scale {
            self.vague += 1;
            return;
        }
        self.compared += 1;
        let off = (ours - theirs).abs();
        self.worst = self.worst.max(off / scale);
        assert!(off <= 1e-9 * scale + 4.0 * error, "{}: {ours} is not {theirs} ± {error}", what());
    }

    /// Nearly all could be compared.
    pub(crate) fn check(&self) {
        let Self { compared, vague, worst } = self;
        assert!(*compared > 20 * vague && *compared > 10, "{compared} of {} compared, {worst:e}", compared + vague);
    }
}

pub(crate) use crate::common::Random;

impl Random {
    /// Between −1 and 1.
    pub(crate) fn signed(&mut self) -> f64 {
        self.number(-1.0, 1.0)
    }

    pub(crate) fn motion<V: Vector<Scalar = f64>>(&mut self) -> RigidMotion<V> {
        let (velocity, center) = (self.vector(1.0), self.vector(1.0));
        let angular_velocity = V::AngularVelocity::from_coordinates(|_| self.signed());
        RigidMotion { velocity, angular_velocity, center }
    }
}

/// A space to test in.
pub(crate) trait Space: Vector<Scalar = f64> {
    /// Bodies of this space, by name.
    const KINDS: &'static [&'static str];

    fn rotation(random: &mut Random) -> Self::Rotation;

    /// A cylinder or a cone.
    fn upright(kind: &str, half_height: f64, radius: f64) -> Solid<Self>;

    /// The matrix of a rotation about zero by an angular velocity in one unit of time.
    fn turned(by: Self::AngularVelocity, matrix: Self::Matrix) -> Self::Matrix;
}

impl Space for DVec3 {
    const KINDS: &'static [&'static str] =
        &["ball", "ellipsoid", "needle", "cuboid", "capsule", "cylinder", "cone", "polytope", "rounded"];

    fn rotation(random: &mut Random) -> DQuat {
        loop {
            let q = DQuat::from_array([0; 4].map(|_| random.signed()));
            if (0.1..1.0).contains(&q.length()) {
                return q.normalize();
            }
        }
    }

    fn upright(kind: &str, half_height: f64, radius: f64) -> Solid<Self> {
        if kind == "cylinder" {
            Box::new(Cylinder::new(half_height, radius).expect(VALID))
        } else {
            Box::new(Cone::new(half_height, radius).expect(VALID))
        }
    }

    fn turned(by: Self, matrix: DMat3) -> DMat3 {
        (DMat3::IDENTITY + by.turn(1.0)) * matrix
    }
}

impl Space for DVec2 {
    const KINDS: &'static [&'static str] = &["ball", "ellipsoid", "needle", "cuboid", "capsule", "polytope", "rounded"];

    fn rotation(random: &mut Random) -> f64 {
        random.number(0.0, 6.3)
    }

    fn upright(kind: &str, _half_height: f64, _radius: f64) -> Solid<Self> {
        panic!("no {kind} in the plane")
    }

    fn turned(by: f64, matrix: DMat2) -> DMat2 {
        DMat2::from_angle(by) * matrix
    }
}

/// A body of any kind.
pub(crate) type Solid<V> = Box<dyn SupportMap<Vector = V>>;

/// A body of a size about one, somewhere near zero.
#[derive(Clone)]
pub(crate) struct Body<V: Vector> {
    pub(crate) shape: Posed<Rc<Solid<V>>>,
}

const VALID: &str = "positive sizes and finite numbers";

impl<V: Space> Body<V> {
    pub(crate) fn random(kind: &str, random: &mut Random) -> Self {
        let sizes = V::from_fn(|_| random.number(0.2, 1.0));
        let [x, y] = [sizes.get(0), sizes.get(1)];
        let points = |random: &mut Random| (0..10).map(|_| random.vector::<V>(1.0)).collect::<Vec<_>>();
        let local: Solid<V> = match kind {
            "ball" => Box::new(Ball::new(x).expect(VALID)),
            "ellipsoid" => Box::new(Ellipsoid::new(V::ZERO, sizes, V::Rotation::default()).expect(VALID)),
            "needle" => {
                let semi_axes = V::from_fn(|i| if i == 0 { 1.0 } else { 10f64.powf(-4.0 * sizes.get(i)) });
                Box::new(Ellipsoid::new(V::ZERO, semi_axes, V::Rotation::default()).expect(VALID))
            }
            "cuboid" => Box::new(Cuboid::new(sizes).expect(VALID)),
            "capsule" => Box::new(Capsule::new(x, 0.5 * y).expect(VALID)),
            "polytope" => Box::new(Polytope::new(points(random)).expect(VALID)),
            "rounded" => Box::new(Rounded::new(Polytope::new(points(random)).expect(VALID), 0.1).expect(VALID)),
            _ => V::upright(kind, x, y),
        };
        let at = random.vector::<V>(1.0);
        Self { shape: Posed::new(Rc::new(local), V::rotation(random), at).expect(VALID) }
    }

    /// Moved so that it is apart from another by 0.05 to 1, or overlaps it by up to 0.3.
    pub(crate) fn placed(self, other: &Self, overlap: bool, random: &mut Random) -> Self {
        let wanted = if overlap { -random.number(0.02, 0.3) } else { random.number(0.05, 1.0) };
        let mut body = self;
        for round in 0..6 {
            let answer = signed_distance(&other.shape, &body.shape, SignedDistanceOptions::default());
            // Never as deep along two normals.
            let wanted = wanted * (1.0 - 0.03 * f64::from(round));
            body.shape = body.moved(&RigidMotion::translation(answer.normal * (answer.signed_distance - wanted)), 1.0);
            if !overlap || answer.signed_distance < 0.0 {
                break;
            }
        }
        body
    }

    /// Where a motion has taken it.
    pub(crate) fn moved(&self, motion: &RigidMotion<V>, time: f64) -> Posed<Rc<Solid<V>>> {
        let rotation = V::turned(motion.angular_velocity.scaled(time), self.shape.rotation());
        let translation = motion.displacement(time).of(self.shape.translation());
        Posed::from_matrix(self.shape.shape().clone(), rotation, translation).expect(VALID)
    }
}

/// The signed distance with as narrow a bracket as may be.
pub(crate) fn apart<A, B>(a: &A, b: &B) -> SignedDistance<A::Vector>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
    A::Vector: Vector<Scalar = f64>,
{
    signed_distance(a, b, SignedDistanceOptions::default().with_tolerance(1e-14))
}
