//! Bodies that are whole scenes with a pose: compounds and meshes that move as one, and many that share one tree.
//!
//! *Which members can matter?* An instance has one box in the tree of the scene around it. Where a question meets that
//! box, it is taken into the frame of the instance, made larger by the rounding of that, and searches the shared tree
//! there. *What is the answer?* Each member that is found is [`Posed`] in the world, by the poses of all instances that
//! it is in, and asked the single query, for as long as that takes. Before that the box of the posed member is tested
//! as that of any body. So every answer is, to the last bit, that of the scene in which each member is a body of its
//! own, and the brackets count the rounding of every pose as `Posed` does. Nothing is allocated.
//!
//! A group holds its scene behind a shared pointer and forgets the kind of its shapes, so that a scene of any shapes
//! can have instances of scenes of any others: a mesh, hulls, and shapes of the user's own. A group is complete before
//! it has an instance, and cannot change after that, so that none can contain itself.

use alloc::boxed::Box;
#[cfg(not(target_has_atomic = "ptr"))]
use alloc::rc::Rc as Arc;
#[cfg(target_has_atomic = "ptr")]
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;
use core::ops::ControlFlow;

use convex_support::{Aabb, BoxDistance, Bvh, Matrix as _, Point, Posed, Scalar, SupportMap, Vector, outer_box};
use num_traits::Float as _;

use super::body::Body;
use super::bounds::{MovingBalls, Question};
use super::error::SceneError;
use super::instance_frame::{InstanceFrame, room};
use crate::{MotionCastOptions, Pose, Trajectory};

/// A body of a question, by its index, and a member of it if it is an instance. The order is that of indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Id {
    pub(super) body: usize,
    pub(super) member: Option<usize>,
}

impl Id {
    /// After every other.
    pub(super) const LAST: Self = Self::of(usize::MAX);

    #[inline]
    pub(super) const fn of(body: usize) -> Self {
        Self { body, member: None }
    }
}

/// A member of an instance where it is in the world.
pub(crate) type Placed<'m, V> = Body<Posed<&'m (dyn SupportMap<Vector = V> + 'm)>>;

/// A scene whose kind of shape is forgotten.
pub(super) trait Members<V: Vector>: Send + Sync {
    fn tree(&self) -> &Bvh<V>;
    fn member(&self, index: usize) -> Option<Member<'_, V>>;
}

/// A body of such a scene.
pub(super) enum Member<'m, V: Vector> {
    Shape(&'m (dyn SupportMap<Vector = V> + 'm)),
    Instance(&'m Instance<V>),
}

/// A scene that can be a body of other scenes, as often as wanted: each [instance](crate::Scene::insert_group) has its
/// own pose, and all share one tree. A clone is the same group.
///
/// ```
/// use convex_support::{Cuboid, Posed, glam::{DQuat, DVec3}};
/// use gjk_raycast::{Group, Pose, Ray, RayCastOptions, Scene};
///
/// // One mesh, twice, and a hull.
/// let roof = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE];
/// let roof = Group::new(Scene::mesh(&roof, &[[0, 1, 2], [1, 2, 3]])?)?;
/// let mut scene = Scene::new([Posed::translated(Cuboid::new(DVec3::ONE)?, DVec3::Z * 9.0)?])?;
/// let at = |z| Pose { rotation: DQuat::IDENTITY, translation: DVec3::Z * z };
/// let (low, high) = (scene.insert_group(&roof, at(3.0))?, scene.insert_group(&roof, at(5.0))?);
///
/// let up = Ray { source: DVec3::new(0.75, 0.75, 0.0), direction: DVec3::Z };
/// let first = scene.ray_cast(up, RayCastOptions::default())?.first.ok_or("three are above")?;
/// assert_eq!((first.body, first.member, first.hit.lambda), (low, Some(1), 3.5));
/// scene.place(low, at(7.0))?; // moves its box alone
/// let first = scene.ray_cast(up, RayCastOptions::default())?.first.ok_or("three are above")?;
/// assert_eq!((first.body, first.member, first.hit.lambda), (high, Some(1), 5.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Group<V: Vector> {
    pub(super) scene: Arc<dyn Members<V>>,
    /// The number of the first member of each body; empty if every body is one member, of the same number.
    pub(super) first: Arc<[usize]>,
    /// One more than the greatest number of a member, and how many there are.
    pub(super) end: usize,
    pub(super) len: usize,
    pub(super) around: Aabb<V>,
    pub(super) levels: usize,
}

impl<V: Vector> fmt::Debug for Group<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Group").field("members", &self.len).field("levels", &self.levels).finish_non_exhaustive()
    }
}

impl<V: Vector> Group<V> {
    /// The number of members, those of nested groups included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no members: never.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Where a member is: the index of the body of this group, then of the group that this body is an instance of, and
    /// so on to the member itself. Empty if there is no such member.
    #[must_use]
    pub fn path(&self, member: usize) -> Vec<usize> {
        let mut path = Vec::new();
        self.walk(member, &mut |index, _| path.push(index)).map_or(Vec::new(), |_| path)
    }

    /// The number of the first member of a body.
    #[inline]
    fn number(&self, index: usize) -> usize {
        self.first.get(index).copied().unwrap_or(index)
    }

    /// The shape of a member; calls `visit` for each index on the way and the instance there.
    fn walk<'g>(
        &'g self,
        member: usize,
        visit: &mut dyn FnMut(usize, Option<&'g Instance<V>>),
    ) -> Option<&'g (dyn SupportMap<Vector = V> + 'g)> {
        // A body that was removed has a number too, and an instance one for each of its members.
        let after = self.first.partition_point(|&first| first <= member);
        let index = if self.first.is_empty() { member } else { after.checked_sub(1)? };
        match self.scene.member(index)? {
            Member::Shape(shape) => {
                visit(index, None);
                (member == self.number(index)).then_some(shape)
            }
            Member::Instance(instance) => {
                visit(index, Some(instance));
                instance.group.walk(member - self.number(index), visit)
            }
        }
    }
}

/// A [group](Group) with a pose: a body of a [`Scene`](crate::Scene).
#[derive(Clone, Debug)]
pub struct Instance<V: Vector> {
    group: Group<V>,
    pose: Pose<V>,
    /// The pose with its matrix, as that of a point.
    at: Posed<Point<V>>,
    /// The sum of the greatest coordinates, of the translation and of the members in their own frame.
    reach: V::Scalar,
}

impl<V: Vector> Instance<V> {
    /// The instance that is the body of this index.
    pub(super) fn new(body: usize, group: Group<V>, pose: Pose<V>) -> Result<Self, SceneError> {
        let (at, reach) = placed(body, &group, pose)?;
        Ok(Self { group, pose, at, reach })
    }

    /// Moves it.
    pub(super) fn place(&mut self, body: usize, pose: Pose<V>) -> Result<(), SceneError> {
        (self.at, self.reach) = placed(body, &self.group, pose)?;
        self.pose = pose;
        Ok(())
    }

    /// The box around it.
    pub(super) fn around(&self) -> Aabb<V> {
        let (center, half) = (self.group.around.center(), self.group.around.half_extents());
        let rotation = self.at.rotation();
        let half = (0..V::DIM).fold(V::splat(room(self.reach)), |sum, j| sum + rotation.col(j).abs() * half.get(j));
        let center = rotation * center + self.at.translation();
        Aabb { min: center - half, max: center + half }
    }

    /// What it is an instance of.
    #[must_use]
    pub fn group(&self) -> &Group<V> {
        &self.group
    }

    /// Where it is: a member `x` is at `R·x + t`, with the rotation and translation of the pose.
    #[must_use]
    pub fn pose(&self) -> Pose<V> {
        self.pose
    }

    /// A member where it is in the world; `None` if there is none of this number. Each shape of a nested group is in a
    /// box of its own.
    pub(super) fn member(&self, member: usize) -> Option<Posed<Box<dyn SupportMap<Vector = V> + '_>>> {
        let mut poses = alloc::vec![&self.at];
        let shape = self.group.walk(member, &mut |_, inner| poses.extend(inner.map(|inner| &inner.at)))?;
        let mut shape: Box<dyn SupportMap<Vector = V> + '_> = Box::new(shape);
        while let Some(at) = poses.pop() {
            let posed = at.with_shape(shape).ok()?;
            if poses.is_empty() {
                return Some(posed);
            }
            shape = Box::new(posed);
        }
        None
    }

    /// Calls `visit` for the members that may be within `limit`, with the number of the member, its bound and the
    /// member with its box, until the call breaks off; it returns the limit from then on. `from` is the bound of the
    /// instance. Returns the last limit, and counts the nodes that were tested.
    ///
    /// The bound of a member is the greatest of that of its box in the world and those of its box, and of the instances
    /// that it is in, as each frame sees them. So it does not depend on the limit, and the order, by which other
    /// members were left out.
    pub(super) fn search<Q: Question<V>>(
        &self,
        question: &Q,
        (from, limit): (V::Scalar, V::Scalar),
        nodes: &mut usize,
        visit: &mut Visit<'_, V>,
    ) -> ControlFlow<(), V::Scalar> {
        self.search_within(question, question, (None, 0), (from, limit), nodes, visit)
    }

    /// The same for an instance within others, the outermost of which is last in the chain above; `seen` is the
    /// question in the frame around this instance, and `first` the number of its first member.
    fn search_within<Q: Question<V>>(
        &self,
        question: &Q,
        seen: &Q,
        (above, first): (Option<&Chain<'_, V>>, usize),
        (from, mut limit): (V::Scalar, V::Scalar),
        nodes: &mut usize,
        visit: &mut Visit<'_, V>,
    ) -> ControlFlow<(), V::Scalar> {
        let chain = Chain { at: &self.at, above };
        let seen = seen.seen_from(&self.frame());
        let (mut is_over, mut below) = (false, 0);
        *nodes += self.group.scene.tree().search(&seen, limit, |index, bound| {
            let (number, from) = (first + self.group.number(index), from.max(bound));
            let next = match self.group.scene.member(index) {
                Some(Member::Shape(shape)) => chain.place(shape, &mut |placed| {
                    let around = placed.convex().and_then(outer_box).unwrap_or_else(Aabb::everything);
                    let from = from.max(question.bound(&around));
                    // Infinite for what the question is not about.
                    let may_count = from <= limit && from < V::Scalar::infinity();
                    if may_count { visit(number, from, placed, around) } else { ControlFlow::Continue(limit) }
                }),
                Some(Member::Instance(inner)) => {
                    let inside = (Some(&chain), number);
                    Some(inner.search_within(question, &seen, inside, (from, limit), &mut below, visit))
                }
                None => None,
            };
            let next = next.unwrap_or(ControlFlow::Continue(limit));
            match next {
                ControlFlow::Continue(next) => limit = next,
                ControlFlow::Break(()) => is_over = true,
            }
            next
        });
        *nodes += below;
        if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(limit) }
    }

    /// Calls `visit` for the members that a shape may meet within the options' time, as for [`search`](Self::search),
    /// or for all members without a motion.
    pub(crate) fn each_on_way<A: SupportMap<Vector = V> + ?Sized, E>(
        &self,
        shape: &A,
        way: Option<(&impl Trajectory<Vector = V>, &MotionCastOptions<V>)>,
        mut visit: impl FnMut(usize, &Placed<'_, V>, Aabb<V>) -> Result<(), E>,
    ) -> Result<(), E> {
        let zero = V::Scalar::ZERO;
        let end = way.map_or(zero, |(_, options)| options.max_time);
        let mut refused = Ok(());
        let visit: &mut Visit<'_, V> = &mut |member, _, placed, around| match visit(member, placed, around) {
            Ok(()) => ControlFlow::Continue(end),
            Err(why) => {
                refused = Err(why);
                ControlFlow::Break(())
            }
        };
        // The search is over, so that a break no longer matters.
        let _ = match way {
            Some((motion, options)) => {
                self.search(&MovingBalls::new(shape, motion, options), (zero, end), &mut 0, visit)
            }
            None => self.search(&BoxDistance::new(Aabb::everything()), (zero, zero), &mut 0, visit),
        };
        refused
    }

    fn frame(&self) -> InstanceFrame<V> {
        InstanceFrame { rotation: self.at.rotation(), translation: self.at.translation(), reach: self.reach }
    }
}

/// The pose with its matrix, and the reach of a group there.
fn placed<V: Vector>(body: usize, group: &Group<V>, pose: Pose<V>) -> Result<(Posed<Point<V>>, V::Scalar), SceneError> {
    let at = Point::new(V::ZERO).and_then(|zero| Posed::new(zero, pose.rotation, pose.translation));
    let at = at.map_err(|why| SceneError::NoPose { body, why })?;
    let Aabb { min, max } = group.around;
    let reach = (min.abs().max(max.abs()) + pose.translation.abs()).dot(V::ONE);
    // With so much to spare no member is beyond the largest number, wherever in the box it is.
    let is_finite = (reach * Scalar::from_f64(8.0)).is_finite();
    if is_finite { Ok((at, reach)) } else { Err(SceneError::NotFinite { body }) }
}

/// Called for members that are found: the number of the member, its bound, the member and its box. It returns the limit
/// from then on.
pub(crate) type Visit<'v, V> = dyn for<'a, 'm> FnMut(
        usize,
        <V as Vector>::Scalar,
        &'a Placed<'m, V>,
        Aabb<V>,
    ) -> ControlFlow<(), <V as Vector>::Scalar>
    + 'v;

/// What is said of a member where it is in the world: the limit from then on, or that the search is over.
type Tell<'t, V> = dyn for<'a, 'm> FnMut(&'a Placed<'m, V>) -> ControlFlow<(), <V as Vector>::Scalar> + 't;

/// The poses of nested instances, from the inside out.
struct Chain<'c, V: Vector> {
    at: &'c Posed<Point<V>>,
    above: Option<&'c Self>,
}

impl<V: Vector> Chain<'_, V> {
    /// What `tell` says of a shape that these instances carry. `None` only if the shape has no finite box any more,
    /// because it does not keep to what it said when its scene was made: an instance has room for all that have.
    fn place<'m>(
        &self,
        shape: &'m (dyn SupportMap<Vector = V> + 'm),
        tell: &mut Tell<'_, V>,
    ) -> Option<ControlFlow<(), V::Scalar>> {
        let posed = self.at.with_shape(shape).ok()?;
        match self.above {
            Some(above) => above.place(&posed, tell),
            None => Some(tell(&Body::Convex(posed))),
        }
    }
}
