//! The first contacts of bodies that all move, by a tree of the boxes that they sweep. If all bodies move alike, the
//! casts of [`hits`](super::hits) need no such tree.

use alloc::vec::Vec;

use convex_support::{Aabb, Bound as _, Bvh, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::among::Among;
use super::answers::{PairImpact, SceneFirstContact, reuse};
use super::body::seen_from;
use super::bounds::{HeightBound, MovingBalls, swept};
use super::hits::swept_shape;
use super::pairs::{BodyPair, Pairing};
use super::{Body, Scene};
use crate::motion::{check, checked};
use crate::{ChainMotion, Impact, LinearCastOptions, Motion, MotionCast, MotionCastOptions, RayCastError, RigidMotion};

/// The motion of each body.
type Motions<'f, V> = &'f (dyn Fn(usize) -> RigidMotion<V> + 'f);

impl<S: SupportMap> Among<'_, S> {
    /// Finds all pairs of these bodies that meet while each moves as `motion` says for its index: the first contacts by
    /// [`motion_cast`](crate::motion_cast()) of the one with the lower index, `a`, and the other. Writes them into
    /// `contacts`, which is emptied first, in the order of the time and then of their indices. Half-spaces do not meet
    /// each other.
    ///
    /// Which pairs may meet is known from the boxes that the bodies sweep, so that the end of the step should be in the
    /// options: if a motion is endless, its box meets most others. Bodies at rest that touch meet at time 0: leave such
    /// pairs out by [`without_pairs`](Self::without_pairs).
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, Scene};
    ///
    /// let ball_at = |x, y| Posed::translated(Ball::new(0.5)?, DVec2::new(x, y));
    /// let scene = Scene::new([ball_at(0.0, 0.0)?, ball_at(5.0, 0.0)?, ball_at(1.0, 3.0)?, ball_at(1.0, 9.0)?])?;
    /// let velocities = [DVec2::X, DVec2::NEG_X, DVec2::NEG_Y, DVec2::ZERO];
    /// let motion = |body: usize| RigidMotion::translation(velocities[body]);
    /// let mut contacts = Vec::new();
    /// let step = MotionCastOptions::new().with_max_time(2.0);
    /// let answer = scene.all().first_contacts(&motion, step, &mut contacts)?;
    /// let found: Vec<_> = contacts.iter().map(|found| (found.a, found.b, found.impact.time)).collect();
    /// assert_eq!(found, [(0, 1, 2.0)]);
    /// assert_eq!(answer.first, contacts.first().copied());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()); also if the motion of a body is not finite that meets no other.
    pub fn first_contacts(
        &self,
        motion: Motions<'_, S::Vector>,
        options: MotionCastOptions<S::Vector>,
        contacts: &mut Vec<PairImpact<S::Vector>>,
    ) -> Result<SceneFirstContact<S::Vector>, RayCastError> {
        Moving { pairing: Pairing::within(*self), motions: [motion; 2], options: checked(options)? }
            .answer(Some(reuse(contacts)))
    }

    /// The first of the [`first_contacts`](Self::first_contacts) alone: pairs that cannot meet before it are not cast.
    ///
    /// # Errors
    /// Those of [`first_contacts`](Self::first_contacts).
    pub fn first_contact(
        &self,
        motion: Motions<'_, S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneFirstContact<S::Vector>, RayCastError> {
        Moving { pairing: Pairing::within(*self), motions: [motion; 2], options: checked(options)? }.answer(None)
    }

    /// Finds all pairs of one of these bodies, `a`, and any of another scene, `b`, that meet while each moves as the
    /// closure of its scene says, as [`first_contacts`](Self::first_contacts) does within one. The other scene may be a
    /// level, at rest: `&|_| RigidMotion::default()`.
    ///
    /// # Errors
    /// Those of [`first_contacts`](Self::first_contacts).
    pub fn first_contacts_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        motions: [Motions<'_, S::Vector>; 2],
        options: MotionCastOptions<S::Vector>,
        contacts: &mut Vec<PairImpact<S::Vector>>,
    ) -> Result<SceneFirstContact<S::Vector>, RayCastError> {
        Moving { pairing: Pairing::between(*self, other), motions, options: checked(options)? }
            .answer(Some(reuse(contacts)))
    }

    /// The first of the [`first_contacts_between`](Self::first_contacts_between) alone.
    ///
    /// # Errors
    /// Those of [`first_contacts`](Self::first_contacts).
    pub fn first_contact_between<T: SupportMap<Vector = S::Vector>>(
        &self,
        other: &Scene<T>,
        motions: [Motions<'_, S::Vector>; 2],
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneFirstContact<S::Vector>, RayCastError> {
        Moving { pairing: Pairing::between(*self, other), motions, options: checked(options)? }.answer(None)
    }
}

/// A question about pairs that move.
struct Moving<'s, 'f, S: SupportMap, T: SupportMap<Vector = S::Vector>> {
    pairing: Pairing<'s, S, T>,
    motions: [Motions<'f, S::Vector>; 2],
    /// Checked.
    options: MotionCastOptions<S::Vector>,
}

/// A pair whose boxes meet, and the time from which on they do.
type Candidate<'s, S, T> = (ScalarOf<S>, BodyPair<'s, S, T>);

impl<'s, S: SupportMap, T: SupportMap<Vector = S::Vector>> Moving<'s, '_, S, T> {
    /// Casts the pairs that may meet, in the order of the times from which on they may. A pair counts from the time of
    /// its contact or from when its boxes meet, whichever is later, as for [casts](super::hits).
    fn answer(
        mut self,
        mut all: Option<&mut Vec<PairImpact<S::Vector>>>,
    ) -> Result<SceneFirstContact<S::Vector>, RayCastError> {
        let candidates = self.candidates()?;
        let (mut lower, mut first, mut open) = (ScalarOf::<S>::infinity(), None, None);
        let mut key = (self.options.max_time, [usize::MAX; 2]);
        for (from, bodies @ ([a, b], ..)) in candidates {
            if all.is_none() && (from, [a, b]) > key || self.pairing.a.stops(&mut self.pairing.work) {
                break;
            }
            let Some(cast) = self.cast(bodies).transpose()? else { continue };
            self.pairing.work.tested += 1;
            let start = (Float::max(cast.lower, from), [a, b]);
            if !cast.outcome.is_miss() {
                lower = Float::min(lower, start.0);
            }
            if cast.outcome.is_undecided() && open.is_none_or(|open| start < open) {
                open = Some(start);
            }
            let Some(impact) = cast.outcome.hit() else { continue };
            let found = PairImpact { a, b, impact, lower: cast.lower, upper: cast.upper, status: cast.status };
            if let Some(all) = all.as_deref_mut() {
                all.push(found);
            }
            let next = (Float::max(impact.time, from), [a, b]);
            if next < key || first.is_none() && next.0 <= key.0 {
                (first, key) = (Some(found), next);
            }
        }
        if let Some(all) = &mut all {
            all.sort_unstable_by(|p, q| {
                let order = p.impact.time.partial_cmp(&q.impact.time);
                order.unwrap_or(core::cmp::Ordering::Equal).then((p.a, p.b).cmp(&(q.a, q.b)))
            });
        } else if first.is_some() {
            open = open.filter(|open| *open < key);
        }
        let work = self.pairing.finish();
        let lower = if work.cancelled { Scalar::ZERO } else { lower };
        Ok(SceneFirstContact { first, lower, undecided: open.map(|(_, pair)| pair), work })
    }

    /// The pairs that may meet before the end, by their boxes, in the order of the times from which on they may.
    fn candidates(&mut self) -> Result<Vec<Candidate<'s, S, T>>, RayCastError> {
        let Pairing { a, b, same, .. } = self.pairing;
        let near = self.options.target_distance;
        let first = swept_tree(&a, self.motions[0], self.options)?;
        let second = if same { None } else { Some(swept_tree(&b, self.motions[1], self.options)?) };
        let mut found = Vec::new();
        let mut nodes = 0;
        let mut add = |pair: [usize; 2]| {
            let pair = if same && pair[1] < pair[0] { [pair[1], pair[0]] } else { pair };
            let Some(bodies) = self.pairing.bodies(pair) else { return };
            let from = self.from(bodies);
            if from <= self.options.max_time && from < Float::infinity() {
                found.push((from, bodies));
            }
        };
        let pairs =
            second.as_ref().map_or_else(|| first.pairs_within(near), |second| first.pairs_between(second, near));
        nodes += pairs.visit(|i, j| {
            add([i, j]);
            core::ops::ControlFlow::Continue(())
        });
        for (index, half_space) in a.half_spaces() {
            let moves = self.motions[0](index) != RigidMotion::default();
            let boxes = second.as_ref().unwrap_or(&first);
            nodes += over(boxes, &HeightBound::new(half_space), near, moves, |other| add([index, other]));
        }
        for (index, half_space) in b.half_spaces().filter(|_| !same) {
            let moves = self.motions[1](index) != RigidMotion::default();
            nodes += over(&first, &HeightBound::new(half_space), near, moves, |other| add([other, index]));
        }
        self.pairing.work.nodes += nodes;
        let key = |&(from, (pair, ..)): &Candidate<'s, S, T>| (from, pair);
        found.sort_unstable_by(|p, q| key(p).partial_cmp(&key(q)).unwrap_or(core::cmp::Ordering::Equal));
        Ok(found)
    }

    /// The time from which on two bodies may meet, by the box of the second.
    fn from(&self, ([i, j], a, _): BodyPair<'_, S, T>) -> ScalarOf<S> {
        let (Body::Convex(a), Some(around)) = (a, self.pairing.b.scene.tree.get(j)) else { return Scalar::ZERO };
        let [of_a, of_b] = [self.motions[0](i), self.motions[1](j)];
        if turns(&of_a) || turns(&of_b) {
            let seen = seen_from(of_b, of_a);
            return MovingBalls::new(a, &ChainMotion::new(&seen), &self.options).bound(&around);
        }
        let motion = Motion { velocity_a: of_a.velocity, velocity_b: of_b.velocity };
        let options = LinearCastOptions::new().with_target_distance(self.options.target_distance);
        swept_shape(a, motion, &options).bound(&around)
    }

    /// The cast of two bodies; `None` for two half-spaces.
    fn cast(&self, ([i, j], a, b): BodyPair<'_, S, T>) -> Option<Result<MotionCast<S::Vector>, RayCastError>> {
        let [of_a, of_b] = [self.motions[0](i), self.motions[1](j)];
        Some(match (a, b) {
            (Body::Convex(a), b) => b.motion_cast_of_both(a, of_a, of_b, self.options),
            (a, Body::Convex(b)) => a.motion_cast_of_both(b, of_b, of_a, self.options).map(|cast| {
                let outcome = cast.outcome.map(|hit| Impact { normal: hit.normal.map(|normal| -normal), ..hit });
                MotionCast { outcome, ..cast }
            }),
            (Body::HalfSpace(_), Body::HalfSpace(_)) => return None,
        })
    }
}

fn turns<V: Vector>(motion: &RigidMotion<V>) -> bool {
    motion.angular_velocity != Default::default()
}

/// The bodies that may meet a half-space, by their boxes: all of them if it moves.
fn over<V: Vector>(
    boxes: &Bvh<V>,
    height: &HeightBound<V>,
    near: V::Scalar,
    moves: bool,
    mut add: impl FnMut(usize),
) -> usize {
    let everywhere = V::Scalar::infinity();
    boxes.within(height, if moves { everywhere } else { near }, |other| {
        add(other);
        core::ops::ControlFlow::Continue(())
    })
}

/// The tree of the scene with the boxes that its bodies sweep, those of a motion without end as large as a tree bears.
fn swept_tree<S: SupportMap>(
    among: &Among<'_, S>,
    motion: Motions<'_, S::Vector>,
    options: MotionCastOptions<S::Vector>,
) -> Result<Bvh<S::Vector>, RayCastError> {
    let (mut tree, mut refused) = (among.scene.tree.clone(), None);
    let end = ScalarOf::<S>::max_value() * Scalar::from_f64(0.25);
    let within = |x: ScalarOf<S>, or: ScalarOf<S>| if x.is_nan() { or } else { x.max(-end).min(end) };
    tree.refit(|index| {
        let around = among.scene.tree.get(index).unwrap_or_else(Aabb::everything);
        let Some(Body::Convex(body)) = among.body(index) else { return around };
        let motion = motion(index);
        refused = refused.or(check("motion", &motion).err());
        let swept = if turns(&motion) {
            MovingBalls::around(body, &motion, &MotionCastOptions { target_distance: Scalar::ZERO, ..options })
        } else {
            swept(around, motion.velocity, options.max_time)
        };
        Aabb {
            min: S::Vector::from_fn(|i| within(swept.min.get(i), -end)),
            max: S::Vector::from_fn(|i| within(swept.max.get(i), end)),
        }
    });
    for (index, _) in among.half_spaces() {
        refused = refused.or(check("motion", &motion(index)).err());
    }
    refused.map_or(Ok(tree), Err)
}
