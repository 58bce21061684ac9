//! A small world of convex bodies: contacts from `gjk_raycast::Scene`, answered by sequential impulses (Catto,
//! *Iterative dynamics with temporal coherence*, 2005). Mass is 1 for every body that moves.

#![allow(dead_code, reason = "each example uses a part of it")]

use std::collections::HashMap;
use std::error::Error;

use gjk_raycast::convex_support::{Cuboid, InvalidShape, Matrix, Posed, Scalar, SupportMap, Vector3};
use gjk_raycast::{PairContact, Scene, SignedDistanceOptions};
use num_traits::Float as _;

/// Rounds over all contacts in a step, there and back. With half as many, it depends on the order of the points of a
/// manifold whether a stack of ten stays where it is.
const ROUNDS: usize = 40;

/// A body with its motion. Its own origin is the centre of mass, and its own axes are the principal ones.
pub(crate) struct Body<V: Vector3> {
    pub(crate) shape: Box<dyn SupportMap<Vector = V> + Sync>,
    pub(crate) center: V,
    pub(crate) rotation: V::Matrix,
    pub(crate) velocity: V,
    pub(crate) angular_velocity: V,
    /// 0 for what does not move.
    pub(crate) inverse_mass: V::Scalar,
    /// Moments of inertia about its own axes, over the mass.
    pub(crate) moments: V,
}

/// The moments of a box of mass 1: (b² + c²)/3 about the axis of half extent a.
pub(crate) fn moments_of_box<V: Vector3>(half_extents: V) -> V {
    let squared = half_extents * half_extents;
    let sum = squared.get(0) + squared.get(1) + squared.get(2);
    V::from_fn(|i| (sum - squared.get(i)) / V::Scalar::from_f64(3.0))
}

impl<V: Vector3> Body<V> {
    /// A body at rest that moves when something pushes it.
    pub(crate) fn new(
        shape: impl SupportMap<Vector = V> + Sync + 'static,
        moments: V,
        center: V,
        rotation: V::Matrix,
    ) -> Self {
        let (velocity, angular_velocity) = (V::ZERO, V::ZERO);
        let inverse_mass = V::Scalar::ONE;
        Self { shape: Box::new(shape), center, rotation, velocity, angular_velocity, inverse_mass, moments }
    }

    /// A box at rest.
    pub(crate) fn cuboid(half_extents: V, center: V, rotation: V::Matrix) -> Result<Self, InvalidShape> {
        Ok(Self::new(Cuboid::new(half_extents)?, moments_of_box(half_extents), center, rotation))
    }

    /// A box that nothing moves.
    pub(crate) fn fixed(half_extents: V, center: V, rotation: V::Matrix) -> Result<Self, InvalidShape> {
        Ok(Self { inverse_mass: V::Scalar::ZERO, ..Self::cuboid(half_extents, center, rotation)? })
    }

    /// The shape where it is.
    pub(crate) fn posed(&self) -> Result<Posed<&(dyn SupportMap<Vector = V> + Sync)>, InvalidShape> {
        Posed::from_matrix(&*self.shape, self.rotation, self.center)
    }

    /// The inverse inertia times a torque.
    fn turned_by(&self, torque: V) -> V {
        self.rotation * (self.rotation.transpose_mul(torque) / self.moments * self.inverse_mass)
    }

    /// Of its motion and of its place, as masses are 1.
    fn energy(&self, gravity: V) -> V::Scalar {
        let spin = self.rotation.transpose_mul(self.angular_velocity);
        let motion = self.velocity.dot(self.velocity) + (spin * self.moments).dot(spin);
        motion * V::Scalar::from_f64(0.5) - gravity.dot(self.center)
    }

    fn velocity_at(&self, arm: V) -> V {
        self.velocity + self.angular_velocity.cross(arm)
    }

    fn push(&mut self, impulse: V, arm: V) {
        self.velocity += impulse * self.inverse_mass;
        self.angular_velocity += self.turned_by(arm.cross(impulse));
    }

    /// How much an impulse of 1 along `n` changes the velocity along `n`.
    fn softness(&self, n: V, arm: V) -> V::Scalar {
        self.inverse_mass + self.turned_by(arm.cross(n)).cross(arm).dot(n)
    }

    fn advance(&mut self, dt: V::Scalar) {
        if self.inverse_mass == V::Scalar::ZERO {
            return;
        }
        self.center += self.velocity * dt;
        let turn = self.angular_velocity * dt;
        let column = |j: usize| self.rotation.col(j) + turn.cross(self.rotation.col(j));
        let x = column(0).unit().expect("turns are small");
        let y = column(1);
        let y = (y - x * x.dot(y)).unit().expect("turns are small");
        self.rotation = Matrix::from_cols_fn(|j| [x, y, x.cross(y)][j]);
    }
}

/// A point in which body `a` touches body `b`.
struct Touch<V: Vector3> {
    key: (usize, usize, u32, u32),
    bodies: [usize; 2],
    arms: [V; 2],
    /// The normal and two directions across it.
    axes: [V; 3],
    /// How much an impulse of 1 along each axis changes the velocity along it.
    softness: [V::Scalar; 3],
    gap: V::Scalar,
    impulses: [V::Scalar; 3],
}

/// Bodies, and what the last step knew of their contacts.
pub(crate) struct World<V: Vector3> {
    pub(crate) bodies: Vec<Body<V>>,
    pub(crate) gravity: V,
    pub(crate) friction: f64,
    /// Whether contacts at seams between bodies count.
    pub(crate) has_seams: bool,
    pub(crate) contacts: Vec<PairContact<V>>,
    impulses: HashMap<(usize, usize, u32, u32), [V::Scalar; 3]>,
}

impl<V: Vector3> World<V> {
    pub(crate) fn new(bodies: Vec<Body<V>>, gravity: V, friction: f64) -> Self {
        Self { bodies, gravity, friction, has_seams: true, contacts: Vec::new(), impulses: HashMap::new() }
    }

    /// The energy of all that moves.
    pub(crate) fn energy(&self) -> V::Scalar {
        let moving = self.bodies.iter().filter(|body| body.inverse_mass > V::Scalar::ZERO);
        moving.fold(V::Scalar::ZERO, |sum, body| sum + body.energy(self.gravity))
    }

    /// One step of time.
    pub(crate) fn step(&mut self, dt: V::Scalar) -> Result<(), Box<dyn Error>> {
        for body in self.bodies.iter_mut().filter(|body| body.inverse_mass > V::Scalar::ZERO) {
            body.velocity += self.gravity * dt;
        }
        let mut touches = self.touches()?;
        for touch in &touches {
            for (axis, impulse) in touch.axes.iter().zip(touch.impulses) {
                self.push(touch, *axis * impulse);
            }
        }
        for _ in 0..ROUNDS {
            for touch in &mut touches {
                self.answer(touch, dt);
            }
            for touch in touches.iter_mut().rev() {
                self.answer(touch, dt);
            }
        }
        self.impulses = touches.iter().map(|touch| (touch.key, touch.impulses)).collect();
        for body in &mut self.bodies {
            body.advance(dt);
        }
        Ok(())
    }

    /// The points in which bodies touch or are about to, with the impulses of the last step where they did then.
    fn touches(&mut self) -> Result<Vec<Touch<V>>, Box<dyn Error>> {
        let scene = Scene::new(self.bodies.iter().map(Body::posed).collect::<Result<Vec<_>, _>>()?)?;
        let is_fixed = |i: usize| self.bodies[i].inverse_mass == V::Scalar::ZERO;
        let mut contacts = Vec::new();
        scene.all().without_pairs(&|a, b| is_fixed(a) && is_fixed(b)).after(&self.contacts).contacts_within(
            V::Scalar::from_f64(0.01),
            SignedDistanceOptions::default(),
            &mut contacts,
        );
        if !self.has_seams {
            scene.leave_out_seams_of_pairs(&mut contacts);
        }
        let mut touches = Vec::new();
        for &PairContact { a, b, contact, .. } in &contacts {
            let [along, across] = contact.tangents();
            for point in contact.points() {
                let key = (a, b, point.feature_a, point.feature_b);
                let (of_a, of_b) = (&self.bodies[a], &self.bodies[b]);
                let arms = [point.point_a - of_a.center, point.point_b - of_b.center];
                let axes = [contact.normal, along, across];
                touches.push(Touch {
                    key,
                    bodies: [a, b],
                    arms,
                    axes,
                    softness: axes.map(|axis| of_a.softness(axis, arms[0]) + of_b.softness(axis, arms[1])),
                    gap: point.signed_distance,
                    impulses: self.impulses.get(&key).copied().unwrap_or_default(),
                });
            }
        }
        drop(scene);
        self.contacts = contacts;
        Ok(touches)
    }

    fn push(&mut self, touch: &Touch<V>, impulse: V) {
        let [a, b] = touch.bodies;
        self.bodies[a].push(impulse, touch.arms[0]);
        self.bodies[b].push(-impulse, touch.arms[1]);
    }

    /// Pushes the bodies apart so far that they do not come nearer than touching, and holds them along by friction.
    fn answer(&mut self, touch: &mut Touch<V>, dt: V::Scalar) {
        let number = V::Scalar::from_f64;
        let before = touch.impulses;
        let [a, b] = touch.bodies.map(|i| &self.bodies[i]);
        let speed = a.velocity_at(touch.arms[0]) - b.velocity_at(touch.arms[1]);
        // A gap may close in this step. A fifth of what is deeper than a millimetre is undone, at no more than 1 m/s.
        let excess = (touch.gap + number(1e-3)).min(V::Scalar::ZERO);
        let wanted = if touch.gap > V::Scalar::ZERO { -touch.gap / dt } else { -excess * number(0.2) / dt };
        let pushed = |k: usize, to: V::Scalar| before[k] + (to - speed.dot(touch.axes[k])) / touch.softness[k];
        let along = [1, 2].map(|k| pushed(k, V::Scalar::ZERO));
        let normal = pushed(0, wanted.min(number(1.0))).max(V::Scalar::ZERO);
        // Friction is no more than its part of the pressure, whichever way it acts.
        let most = before[0] * number(self.friction);
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        let share = if length > most { most / length } else { V::Scalar::ONE };
        touch.impulses = [normal, along[0] * share, along[1] * share];
        let change = |k: usize| touch.axes[k] * (touch.impulses[k] - before[k]);
        self.push(touch, change(0) + change(1) + change(2));
    }
}
