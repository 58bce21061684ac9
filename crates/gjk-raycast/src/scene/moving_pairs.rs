//! The first contacts of bodies that all move, by a tree of the boxes that they sweep. If all bodies move alike, the
//! casts of [`hits`](super::hits) need no such tree.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{Aabb, Ball, Bound as _, BoxDistance, Bvh, Posed, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::among::Among;
use super::answers::{OfPair as _, PairImpact, SceneFirstContact, reuse};
use super::asked::{Asked, asked, asked_pair};
use super::body::seen_from;
use super::bounds::{MovingBalls, swept};
use super::hits::{First, swept_box};
use super::instance::Id;
use super::pairs::{Pairing, up_to};
use super::{Body, Occupant, Scene};
use crate::motion::{check, checked};
use crate::{ChainMotion, Impact, MotionCast, MotionCastOptions, RayCastError, RigidMotion};

/// The motion of each body.
type Motions<'f, V> = &'f (dyn Fn(usize) -> RigidMotion<V> + 'f);

type Solid<'s, V> = &'s (dyn SupportMap<Vector = V> + 's);

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
        MovingPairs { pairing: Pairing::within(*self), motions: [motion; 2], options: checked(options)? }
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
        MovingPairs { pairing: Pairing::within(*self), motions: [motion; 2], options: checked(options)? }.answer(None)
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
        MovingPairs { pairing: Pairing::between(*self, other), motions, options: checked(options)? }
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
        MovingPairs { pairing: Pairing::between(*self, other), motions, options: checked(options)? }.answer(None)
    }
}

/// A question about pairs that move.
struct MovingPairs<'s, 'f, S: SupportMap, T: SupportMap<Vector = S::Vector>> {
    pairing: Pairing<'s, S, T>,
    motions: [Motions<'f, S::Vector>; 2],
    /// Checked.
    options: MotionCastOptions<S::Vector>,
}

/// A pair of indices whose boxes meet, and the time from which on they do.
type Candidate<N> = (N, [usize; 2]);

impl<S: SupportMap, T: SupportMap<Vector = S::Vector>> MovingPairs<'_, '_, S, T> {
    /// Casts the pairs that may meet, in the order of the times from which on they may. A pair counts from the time of
    /// its contact or from when its boxes meet, whichever is later, as for [casts](super::hits).
    fn answer(
        mut self,
        mut all: Option<&mut Vec<PairImpact<S::Vector>>>,
    ) -> Result<SceneFirstContact<S::Vector>, RayCastError> {
        let candidates = self.candidates()?;
        let (mut found, mut refused, mut work) = (First::default(), None, self.pairing.work);
        let (end, is_all) = (up_to(self.options.max_time), all.is_some());
        let limit = |found: &First<_, _, _>| if is_all { end } else { found.limit(end) };
        for (from, pair) in candidates {
            if (from, pair.map(Id::of)) > limit(&found) {
                break;
            }
            let ended = self.each(pair, from, &mut |pair, from, a, b| {
                if self.pairing.a.stops(&mut work) {
                    return ControlFlow::Break(());
                }
                match asked_pair!(a, b => self.cast(pair, a, b)) {
                    Some(Ok(cast)) => {
                        work.tested += 1;
                        let impact = PairImpact::of(pair, &cast);
                        found.add(pair, from, &cast, impact.map(|found| (found.impact.time, found)));
                        if let Some(all) = all.as_deref_mut() {
                            all.extend(impact);
                        }
                    }
                    Some(Err(why)) => {
                        refused = Some(why);
                        return ControlFlow::Break(());
                    }
                    None => {}
                }
                ControlFlow::Continue(limit(&found).0)
            });
            if ended.is_break() {
                break;
            }
        }
        if let Some(why) = refused {
            return Err(why);
        }
        if let Some(all) = &mut all {
            all.sort_unstable_by(|p, q| {
                let order = p.impact.time.partial_cmp(&q.impact.time);
                order.unwrap_or(core::cmp::Ordering::Equal).then(p.ids().cmp(&q.ids()))
            });
        }
        self.pairing.work = work;
        let work = self.pairing.finish();
        let lower = if work.cancelled { Scalar::ZERO } else { found.lower };
        let undecided = if is_all { found.open.map(|(_, pair)| pair) } else { found.undecided() };
        let undecided = undecided.map(|pair| pair.map(|id| id.body));
        Ok(SceneFirstContact { first: found.first.map(|(_, first)| first), lower, undecided, work })
    }

    /// The pairs that may meet before the end, by their boxes, in the order of the times from which on they may.
    fn candidates(&mut self) -> Result<Vec<Candidate<ScalarOf<S>>>, RayCastError> {
        let Pairing { a, b, same, .. } = self.pairing;
        let near = self.options.target_distance;
        let first = swept_tree(&a, self.motions[0], self.options)?;
        let second = if same { None } else { Some(swept_tree(&b, self.motions[1], self.options)?) };
        let mut found = Vec::new();
        let mut add = |[i, j]: [usize; 2]| {
            let pair = if same && j < i { [j, i] } else { [i, j] };
            let may_meet = |from: &ScalarOf<S>| *from <= self.options.max_time && *from < Float::infinity();
            found.extend(self.from(pair).filter(may_meet).map(|from| (from, pair)));
            ControlFlow::Continue(())
        };
        let pairs =
            second.as_ref().map_or_else(|| first.pairs_within(near), |second| first.pairs_between(second, near));
        let mut nodes = pairs.visit(|i, j| add([i, j]));
        for of in self.pairing.half_spaces() {
            let boxes = if of.is_second { &first } else { second.as_ref().unwrap_or(&first) };
            // All bodies, if the half-space moves.
            let moves = self.motions[usize::from(of.is_second)](of.index) != RigidMotion::default();
            let near = if moves { Float::infinity() } else { near };
            nodes += boxes.within(&of.height, near, |other| add(of.pair(other)));
        }
        self.pairing.work.nodes += nodes;
        found.sort_unstable_by(|p, q| p.partial_cmp(q).unwrap_or(core::cmp::Ordering::Equal));
        Ok(found)
    }

    /// The time from which on two bodies may meet, by their boxes; `None` if the question is not about them.
    fn from(&self, [i, j]: [usize; 2]) -> Option<ScalarOf<S>> {
        let (a, b) = (&self.pairing.a, &self.pairing.b);
        let (slot, _) = (a.slot(i)?, b.slot(j)?);
        if self.pairing.a.is_pair_left_out(i, j) {
            return None;
        }
        // Half-spaces have no box.
        let (Some(own), Some(other)) = (a.scene.tree.get(i), b.scene.tree.get(j)) else { return Some(Scalar::ZERO) };
        let [of_a, of_b] = self.motions_of([i, j]);
        if turns(&of_a) || turns(&of_b) {
            let seen = seen_from(of_b, of_a);
            let bound =
                |shape: Solid<'_, _>| MovingBalls::new(shape, &ChainMotion::new(&seen), &self.options).bound(&other);
            return Some(as_solid(slot, own, bound).unwrap_or(Scalar::ZERO));
        }
        Some(swept_box(own, of_a.velocity - of_b.velocity, self.options.target_distance).bound(&other))
    }

    fn motions_of(&self, [i, j]: [usize; 2]) -> [RigidMotion<S::Vector>; 2] {
        [self.motions[0](i), self.motions[1](j)]
    }

    /// Calls `tell` for two bodies, or for each pair of their members that may meet, with the time from which on they
    /// may. The call returns the time until which pairs count from then on, or breaks off.
    fn each(
        &self,
        [i, j]: [usize; 2],
        from: ScalarOf<S>,
        tell: &mut impl FnMut([Id; 2], ScalarOf<S>, Asked<'_, '_, S>, Asked<'_, '_, T>) -> ControlFlow<(), ScalarOf<S>>,
    ) -> ControlFlow<()> {
        let (Some(a), Some(b)) = (self.pairing.a.slot(i), self.pairing.b.slot(j)) else {
            return ControlFlow::Continue(());
        };
        let [of_a, of_b] = self.motions_of([i, j]);
        let next = match (a, b) {
            (Occupant::Instance(_), Occupant::Body(b)) => {
                self.met_by(b, [of_b, of_a], (a, i, from), &mut |id, from, a| {
                    tell([id, Id::of(j)], from, a, Asked::Own(b))
                })
            }
            (a, b) => a.each_member((i, from), &anywhere(), self.options.max_time, &mut 0, &mut |id_a, from, a| {
                asked!(a, body => self.met_by(body, [of_a, of_b], (b, j, from), &mut |id_b, from, b| {
                    tell([id_a, id_b], from, a, b)
                }))
            }),
        };
        next.map_continue(|_| ())
    }

    /// Calls `tell` for the other body, or for the members of the instance that a body may meet, given the motions of
    /// both.
    fn met_by<A: SupportMap<Vector = S::Vector>, R: SupportMap<Vector = S::Vector>>(
        &self,
        body: &Body<A>,
        [own, other]: [RigidMotion<S::Vector>; 2],
        (slot, index, from): (&Occupant<R>, usize, ScalarOf<S>),
        tell: &mut impl FnMut(Id, ScalarOf<S>, Asked<'_, '_, R>) -> ControlFlow<(), ScalarOf<S>>,
    ) -> ControlFlow<(), ScalarOf<S>> {
        let end = self.options.max_time;
        match (body, slot) {
            (_, Occupant::Body(body)) => tell(Id::of(index), from, Asked::Own(body)),
            (Body::Convex(shape), _) => {
                let seen = seen_from(other, own);
                let question = MovingBalls::new(shape, &ChainMotion::new(&seen), &self.options);
                slot.each_member((index, from), &question, end, &mut 0, tell)
            }
            (Body::HalfSpace(_), _) => slot.each_member((index, from), &anywhere(), end, &mut 0, tell),
        }
    }

    /// The cast of two bodies, or of members that move as these do; `None` for two half-spaces.
    fn cast<A: SupportMap<Vector = S::Vector>, B: SupportMap<Vector = S::Vector>>(
        &self,
        pair: [Id; 2],
        a: &Body<A>,
        b: &Body<B>,
    ) -> Option<Result<MotionCast<S::Vector>, RayCastError>> {
        let [of_a, of_b] = self.motions_of(pair.map(|id| id.body));
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

/// The question of what is anywhere.
fn anywhere<V: Vector>() -> BoxDistance<V> {
    BoxDistance::new(Aabb::everything())
}

fn turns<V: Vector>(motion: &RigidMotion<V>) -> bool {
    motion.angular_velocity != Default::default()
}

/// What `tell` says of a body, or of the ball around the box of an instance, which holds its members.
fn as_solid<S: SupportMap, R>(
    slot: &Occupant<S>,
    around: Aabb<S::Vector>,
    tell: impl FnOnce(Solid<'_, S::Vector>) -> R,
) -> Option<R> {
    if let Some(Body::Convex(body)) = slot.body() {
        return Some(tell(body));
    }
    let ball = Ball::new(around.half_extents().norm()).ok()?;
    Some(tell(&Posed::translated(ball, around.center()).ok()?))
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
        let slot = among.slot(index);
        if slot.is_none_or(|slot| matches!(slot, Occupant::Body(Body::HalfSpace(_)))) {
            return around;
        }
        let motion = motion(index);
        refused = refused.or(check("motion", &motion).err());
        let options = MotionCastOptions { target_distance: Scalar::ZERO, ..options };
        let swept = if !turns(&motion) {
            swept(around, motion.velocity, options.max_time)
        } else {
            let swept = |shape: Solid<'_, _>| MovingBalls::around(shape, &motion, &options);
            slot.and_then(|slot| as_solid(slot, around, swept)).unwrap_or_else(Aabb::everything)
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
