//! A small world of boxes: contacts from `gjk_raycast::Scene`, answered by sequential impulses (Catto, *Iterative
//! dynamics with temporal coherence*, 2005). Mass is 1 for every box that moves.

use std::collections::HashMap;
use std::error::Error;

use gjk_raycast::convex_support::{Cuboid, InvalidShape, Matrix, Posed, Scalar, Vector3};
use gjk_raycast::{PairContact, Scene, SignedDistanceOptions};
use num_traits::Float as _;

/// Rounds over all contacts in a step, there and back. With half as many, it depends on the order of the points of a
/// manifold whether a stack of ten stays where it is.
const ROUNDS: usize = 40;

/// A box with its motion.
pub(crate) struct Body<V: Vector3> {
    pub(crate) half_extents: V,
    pub(crate) center: V,
    pub(crate) rotation: V::Matrix,
    pub(crate) velocity: V,
    pub(crate) angular_velocity: V,
    /// 0 for what does not move.
    pub(crate) inverse_mass: V::Scalar,
}

impl<V: Vector3> Body<V> {
    /// A box at rest that moves when something pushes it.
    pub(crate) fn new(half_extents: V, center: V, rotation: V::Matrix) -> Self {
        let inverse_mass = V::Scalar::ONE;
        Self { half_extents, center, rotation, velocity: V::ZERO, angular_velocity: V::ZERO, inverse_mass }
    }

    /// A box that nothing moves.
    pub(crate) fn fixed(half_extents: V, center: V, rotation: V::Matrix) -> Self {
        Self { inverse_mass: V::Scalar::ZERO, ..Self::new(half_extents, center, rotation) }
    }

    fn shape(&self) -> Result<Posed<Cuboid<V>>, InvalidShape> {
        Posed::from_matrix(Cuboid::new(self.half_extents)?, self.rotation, self.center)
    }

    /// The inverse inertia times a torque: of a box of mass m, m/3·(b² + c²) about the axis of half extent a.
    fn turned_by(&self, torque: V) -> V {
        let squared = self.half_extents * self.half_extents;
        let sum = squared.get(0) + squared.get(1) + squared.get(2);
        let three = V::Scalar::from_f64(3.0) * self.inverse_mass;
        let local = self.rotation.transpose_mul(torque);
        self.rotation * V::from_fn(|i| local.get(i) * three / (sum - squared.get(i)))
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
    gap: V::Scalar,
    impulses: [V::Scalar; 3],
}

/// Boxes, and what the last step knew of their contacts.
pub(crate) struct World<V: Vector3> {
    pub(crate) bodies: Vec<Body<V>>,
    pub(crate) gravity: V,
    pub(crate) friction: f64,
    impulses: HashMap<(usize, usize, u32, u32), [V::Scalar; 3]>,
}

impl<V: Vector3> World<V> {
    pub(crate) fn new(bodies: Vec<Body<V>>, gravity: V, friction: f64) -> Self {
        Self { bodies, gravity, friction, impulses: HashMap::new() }
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
    fn touches(&self) -> Result<Vec<Touch<V>>, Box<dyn Error>> {
        let scene = Scene::new(self.bodies.iter().map(Body::shape).collect::<Result<Vec<_>, _>>()?)?;
        let is_fixed = |i: usize| self.bodies[i].inverse_mass == V::Scalar::ZERO;
        let mut contacts = Vec::new();
        scene.all().without_pairs(&|a, b| is_fixed(a) && is_fixed(b)).contacts_within(
            V::Scalar::from_f64(0.01),
            SignedDistanceOptions::default(),
            &mut contacts,
        );
        let mut touches = Vec::new();
        for PairContact { a, b, contact } in contacts {
            let n = contact.normal;
            let least = (1..3).fold(0, |least, k| if n.get(k).abs() < n.get(least).abs() { k } else { least });
            let across = n.cross(V::axis(least)).unit().expect("an axis that is not along the normal");
            for point in contact.points() {
                let key = (a, b, point.feature_a, point.feature_b);
                touches.push(Touch {
                    key,
                    bodies: [a, b],
                    arms: [point.point_a - self.bodies[a].center, point.point_b - self.bodies[b].center],
                    axes: [n, across, n.cross(across)],
                    gap: point.signed_distance,
                    impulses: self.impulses.get(&key).copied().unwrap_or_default(),
                });
            }
        }
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
        for k in [1, 2, 0] {
            let axis = touch.axes[k];
            let [a, b] = touch.bodies.map(|i| &self.bodies[i]);
            let speed = (a.velocity_at(touch.arms[0]) - b.velocity_at(touch.arms[1])).dot(axis);
            let softness = a.softness(axis, touch.arms[0]) + b.softness(axis, touch.arms[1]);
            let before = touch.impulses[k];
            touch.impulses[k] = if k == 0 {
                // A gap may close in this step. A fifth of what is deeper than a millimetre is undone, at no more than
                // 1 m/s.
                let slop = number(1e-3);
                let excess = (touch.gap + slop).min(V::Scalar::ZERO);
                let wanted = if touch.gap > V::Scalar::ZERO { -touch.gap / dt } else { -excess * number(0.2) / dt };
                (before + (wanted.min(number(1.0)) - speed) / softness).max(V::Scalar::ZERO)
            } else {
                let most = touch.impulses[0] * number(self.friction);
                (before - speed / softness).max(-most).min(most)
            };
            let change = touch.impulses[k] - before;
            self.push(touch, axis * change);
        }
    }
}
