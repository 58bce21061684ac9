//! Whether a linkage touches anything along a path: the bodies that come near along an edge ([`sweep`](super::sweep))
//! are cast against one another, as far as the first contact so far.

use convex_support::{Core, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::error::LinkageError;
use super::joint_trajectory::JointTrajectory;
use super::link_motion::{LinkMotion, PathEdge};
use super::path_answer::{FreeInterval, Met, Path, PathContact};
use super::robot::{LinkView, Linkage};
use super::sweep::{Near, PathWorkspace, Sweep};
use crate::motion::{ProvedSteps, checked};
use crate::{Body, MotionCast, MotionCastOptions, Outcome, RayCastError, Scene, StartInContact};

impl<S: SupportMap> Linkage<S> {
    /// Whether the path along waypoints is free, among the bodies of a scene at rest, and of the
    /// [pairs](Self::with_pairs) of its own links, or its first contact.
    ///
    /// A waypoint has a value for each joint that moves, in their order. Between two waypoints all joints move at
    /// constant rates, in one unit of time. A path of one waypoint is the pose.
    ///
    /// Along each edge, bodies that come near are found first. These are cast, earliest first, and only until the first
    /// contact so far: [`motion_cast`](crate::motion_cast()) proves them free at all times, or brackets the first
    /// contact. Bounds account for the rounding of the joints' poses too, so that a free path is a proof about the
    /// linkage that the given numbers define.
    ///
    /// The options are those of the casts, with two differences: `max_time` is a time of the path, each edge of which
    /// takes 1, and `max_iterations` counts for each body of a link and each body near it. A start in contact is always
    /// a contact, and `start_in_contact` and `axis` have no effect.
    ///
    /// # Errors
    /// [`LinkageError`] if the path is empty, a waypoint has another number of values than [`values`](Self::values), a
    /// value is not finite, or an option is NaN.
    #[doc(alias("edge_check", "motion_validation", "local_planner"))]
    pub fn path<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        options: MotionCastOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
    ) -> Result<Path<S::Vector>, LinkageError> {
        self.straight_path(waypoints, scene, options, workspace, None)
    }

    /// [`path`](Self::path) along edges on which joint values change as the caller states. Each edge takes one unit of
    /// time, and begins with the values with which the one before ends. A path of no edge is free.
    ///
    /// ```
    /// use convex_support::{Ball, glam::DVec2};
    /// use gjk_raycast::{
    ///     HalfSpace, Joint, JointBounds, JointKind, JointState, JointTrajectory, Link, Linkage, MotionCastOptions,
    ///     PathWorkspace, Pose, Scene,
    /// };
    ///
    /// // From rest to rest: q = d·(3t² − 2t³) for each joint, whose way is d.
    /// struct Smooth([f64; 1]);
    ///
    /// impl JointTrajectory for Smooth {
    ///     type Scalar = f64;
    ///     fn state(&self, joint: usize, t: f64) -> JointState<f64> {
    ///         let d = self.0[joint];
    ///         JointState {
    ///             value: d * t * t * (3.0 - 2.0 * t),
    ///             rate: 6.0 * d * t * (1.0 - t),
    ///             acceleration: d * (6.0 - 12.0 * t),
    ///             error: 8.0 * f64::EPSILON * d.abs(),
    ///         }
    ///     }
    ///     fn bounds(&self, joint: usize) -> JointBounds<f64> {
    ///         let d = self.0[joint].abs();
    ///         JointBounds { value: d, rate: 1.5 * d, acceleration: 6.0 * d, jerk: 12.0 * d }
    ///     }
    /// }
    ///
    /// // A ball of radius 1 slides from x = 0 to 4, and meets a wall when it is at x = 2.
    /// let slide = Joint { parent: None, pose: Pose::default(), kind: JointKind::Prismatic(DVec2::X) };
    /// let robot = Linkage::new([slide], [Link { joint: Some(0), bodies: vec![Ball::new(1.0)?] }])?;
    /// let mut scene = Scene::<Ball<DVec2>>::default();
    /// scene.insert_half_space(HalfSpace::new(DVec2::NEG_X, -3.0)?);
    /// let (options, mut workspace) = (MotionCastOptions::new(), PathWorkspace::new());
    /// let path = robot.path_along(&[Smooth([4.0])], &scene, options, &mut workspace)?;
    /// let (_, hit) = path.contact().ok_or("it meets the wall")?;
    /// assert!((hit.time - 0.5).abs() < 1e-12);
    /// assert!(robot.path_along(&[Smooth([1.9])], &scene, options, &mut workspace)?.is_free());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`LinkageError`] if a value at an end of an edge is not finite, a bound is negative or not finite, or an option
    /// is NaN. Values in between that are not finite contradict the bounds: they end no search, and prove nothing.
    pub fn path_along<O: SupportMap<Vector = S::Vector>, T: JointTrajectory<Scalar = ScalarOf<S>>>(
        &self,
        edges: &[T],
        scene: &Scene<O>,
        options: MotionCastOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
    ) -> Result<Path<S::Vector>, LinkageError> {
        self.check_edges(edges)?;
        self.watched_path(edges.len(), |index| &edges[index], scene, checked(options)?, workspace, None)
    }

    /// The error of edges whose values or bounds are invalid.
    pub(super) fn check_edges<T: JointTrajectory<Scalar = ScalarOf<S>>>(
        &self,
        edges: &[T],
    ) -> Result<(), LinkageError> {
        for (edge, trajectory) in edges.iter().enumerate() {
            for value in 0..self.values() {
                if !trajectory.bounds(value).are_valid() {
                    return Err(LinkageError::Bounds { edge, value });
                }
                let is_finite = |time| trajectory.state(value, time).value.is_finite();
                if !(is_finite(Scalar::ZERO) && is_finite(Scalar::ONE)) {
                    return Err(LinkageError::Value { waypoint: edge, value });
                }
            }
        }
        Ok(())
    }

    /// The index of the last waypoint, if there is one and all are valid.
    pub(super) fn check_waypoints<W: AsRef<[ScalarOf<S>]>>(&self, waypoints: &[W]) -> Result<usize, LinkageError> {
        for (index, waypoint) in waypoints.iter().enumerate() {
            self.check(index, waypoint.as_ref())?;
        }
        waypoints.len().checked_sub(1).ok_or(LinkageError::EmptyPath)
    }

    /// [`path`](Self::path) with an observer that sees its proof, bodies and intervals in no particular order. For a
    /// free path the intervals cover all of its edges, for each body of a link and each body of the scene, and each
    /// pair in question; for another path they come up to where it is said to be free. It takes longer: all of these
    /// are cast, however far away, and along the whole edge, so that brackets may differ from those of
    /// [`path`](Self::path) by rounding.
    ///
    /// # Errors
    /// Those of [`path`](Self::path).
    pub fn path_with<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        options: MotionCastOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
        mut observer: impl FnMut(FreeInterval<S::Vector>),
    ) -> Result<Path<S::Vector>, LinkageError> {
        self.straight_path(waypoints, scene, options, workspace, Some(&mut observer))
    }

    /// [`path`](Self::path) for many paths on all threads, such as the edges of a roadmap; answers in the same order.
    #[cfg(feature = "rayon")]
    pub fn par_paths<O: SupportMap<Vector = S::Vector> + Sync, P: AsRef<[W]> + Sync, W: AsRef<[ScalarOf<S>]>>(
        &self,
        paths: &[P],
        scene: &Scene<O>,
        options: MotionCastOptions<S::Vector>,
    ) -> alloc::vec::Vec<Result<Path<S::Vector>, LinkageError>>
    where
        S: Sync,
    {
        use rayon::prelude::*;
        let ask = |workspace: &mut _, path: &P| self.path(path.as_ref(), scene, options, workspace);
        paths.par_iter().map_init(PathWorkspace::new, ask).collect()
    }

    fn straight_path<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        options: MotionCastOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
        observer: Option<&mut dyn FnMut(FreeInterval<S::Vector>)>,
    ) -> Result<Path<S::Vector>, LinkageError> {
        let mut options = checked(options)?;
        let last = self.check_waypoints(waypoints)?;
        if last == 0 {
            options.max_time = Scalar::ZERO;
        }
        let edge = |index: usize| PathEdge::between(waypoints, index);
        self.watched_path(last.max(1), edge, scene, options, workspace, observer)
    }

    fn watched_path<O: SupportMap<Vector = S::Vector>, E: JointTrajectory<Scalar = ScalarOf<S>> + Copy>(
        &self,
        edges: usize,
        edge_at: impl Fn(usize) -> E,
        scene: &Scene<O>,
        options: MotionCastOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
        mut observer: Option<&mut dyn FnMut(FreeInterval<S::Vector>)>,
    ) -> Result<Path<S::Vector>, LinkageError> {
        // A contact at the beginning of a part of an edge is a contact, whatever was before.
        let options = MotionCastOptions { start_in_contact: StartInContact::Report, ..options };
        workspace.put_half_spaces(scene);
        let (mut parts, mut casts, mut open) = (0, 0, None);
        // If an observer is to see the proof, everything is cast.
        let target = if observer.is_some() { Float::infinity() } else { options.target_distance };
        for index in 0..edges {
            let rest = options.max_time - Scalar::from_f64(index as f64);
            if index > 0 && !(rest > Scalar::ZERO) {
                break;
            }
            let (duration, edge) = (rest.min(Scalar::ONE), edge_at(index));
            let mut first: Option<PathContact<S::Vector>> = None;
            let (skeleton, tree, space) = (&self.skeleton, scene.tree(), &mut *workspace);
            let mut sweep = Sweep { skeleton, tree, edge, target, space, end: duration, parts: 0 };
            sweep.run::<RayCastError>(&mut |near, motion, _| {
                casts += 1;
                let options = options.with_max_time(duration);
                let next = if let Some(base) = self.skeleton.views[near.view].base {
                    let met = Met::Link { link: base, body: near.other };
                    let base = Body::Convex(&self.bodies[base][near.other]);
                    self.cast((index, met), near, &motion, (&base, None), options, &mut observer)?
                } else if let Some(obstacle) = scene.get(near.other) {
                    let at = scene.tree().get(near.other).map(|around| around.center());
                    let met = Met::Obstacle(near.other);
                    self.cast((index, met), near, &motion, (obstacle, at), options, &mut observer)?
                } else if let Some(instance) = scene.instance(near.other) {
                    let mut first = None;
                    let part = options.with_max_time(near.to - near.from);
                    let way = observer.is_none().then_some((&motion, &part));
                    let shape = &self.bodies[self.skeleton.views[near.view].link][near.body];
                    instance.each_on_way(shape, way, |member, placed, around| {
                        let met = Met::Member { obstacle: near.other, member };
                        let against = (placed, Some(around.center()));
                        let next = self.cast((index, met), near, &motion, against, options, &mut observer)?;
                        first = first_of(first, next);
                        Ok::<_, RayCastError>(())
                    })?;
                    first
                } else {
                    None
                };
                first = first_of(first, next);
                Ok(first.map_or(duration, |first| duration.min(end_of(&first.cast))))
            })?;
            parts += sweep.parts;
            let found = open.map_or(first, |open| Some(goes_on(open, first)));
            // What rounding leaves open at a waypoint, the next edge may decide.
            let may_go_on = open.is_none() && index + 1 < edges && rest > Scalar::ONE;
            if may_go_on && found.is_some_and(|found| is_open_at_end(&found)) {
                open = found;
            } else if found.is_some() {
                return Ok(Path { first: found, parts, casts });
            }
        }
        Ok(Path { first: None, parts, casts })
    }

    /// Casts a body of a link against a body that may come near it on an edge; `None` for a miss.
    fn cast<O: SupportMap<Vector = S::Vector>, E: JointTrajectory<Scalar = ScalarOf<S>> + Copy>(
        &self,
        (edge, met): (usize, Met),
        near: &Near<ScalarOf<S>>,
        motion: &LinkMotion<'_, S::Vector, E>,
        (against, at): (&Body<O>, Option<S::Vector>),
        options: MotionCastOptions<S::Vector>,
        observer: &mut Option<&mut dyn FnMut(FreeInterval<S::Vector>)>,
    ) -> Result<Option<PathContact<S::Vector>>, RayCastError> {
        let &Near { from, to, view, body, .. } = near;
        let LinkView { link, base, .. } = self.skeleton.views[view];
        let shape = &self.bodies[link][body];
        // The first guess of the normal leads from the middle of the other body's box to that of this body.
        let center = motion.at(Scalar::ZERO).1.of(self.skeleton.links[link].each[body].center);
        let axis = at.map(|at| center - at);
        let mut cast_to = |end| {
            let mut proof = observer.as_mut().map(|observer| {
                let show = |[start, end]: [ScalarOf<S>; 2], normals| {
                    let (from, to) = (from + start, from + end);
                    observer(FreeInterval { edge, from, to, link, body, met, normals });
                };
                (ProvedSteps::NONE, show)
            });
            let options = MotionCastOptions { axis, max_time: end, ..options };
            let answer = against.motion_cast(shape, motion, options, |there| {
                if let Some((steps, show)) = &mut proof {
                    steps.see(&there, show);
                }
            })?;
            if let Some((steps, show)) = proof {
                steps.end(&answer, show);
            }
            Ok::<_, RayCastError>(answer)
        };
        // The end of a part is not the end of the edge. If rounding decides whether a contact comes before it, the body
        // is cast again, as far as the end of the edge.
        let whole = options.max_time - from;
        let mut cast = cast_to(to - from)?;
        if !cast.is_certain() && to - from < whole {
            cast = cast_to(whole)?;
        }
        // Where the joints' values leave less than half of the digits of the pose, that the bodies seem to touch,
        // within rounding, says nothing.
        if let Outcome::Hit(hit) = cast.outcome
            && !cast.is_certain()
        {
            let Core { origin, extent, radius, .. } = shape.core();
            let reach = origin.norm() + extent + radius;
            if !(motion.at(hit.time).1.error_of(reach) <= ScalarOf::<S>::EPSILON.sqrt() * reach) {
                cast.outcome = Outcome::Undecided;
            }
        }
        // The sum with the start of the part is rounded.
        let room = if from == Scalar::ZERO { from } else { Scalar::EPSILON };
        (cast.lower, cast.upper) = ((from + cast.lower - room).max(from), from + cast.upper + room);
        if let Outcome::Hit(hit) = &mut cast.outcome {
            if let Some(base) = base {
                // The contact was found in the frame of the second link.
                let (_, frame) = self.skeleton.views[base].route.place(motion.edge, from + hit.time);
                (hit.point, hit.normal) = (frame.of(hit.point), hit.normal.map(|normal| frame.rotation * normal));
            }
            hit.time = (from + hit.time).min(cast.upper).max(cast.lower);
        }
        Ok((!cast.outcome.is_miss()).then_some(PathContact { edge, link, body, met, cast }))
    }
}

/// The first of two contacts on an edge, each of which may be certain or only possible. Its bracket goes from the
/// lesser of the lower bounds to the lesser of the upper ones. Of two hits it names the one that is certain earlier, by
/// the upper bound; for a hit that is not certain its time counts.
fn first_of<V: Vector>(known: Option<PathContact<V>>, next: Option<PathContact<V>>) -> Option<PathContact<V>> {
    let (Some(known), Some(next)) = (known, next) else { return known.or(next) };
    let (a, b) = (known.cast, next.cast);
    let (lower, upper) = (a.lower.min(b.lower), a.upper.min(b.upper));
    let (Outcome::Hit(_), Outcome::Hit(_)) = (a.outcome, b.outcome) else {
        let is_next = b.lower < a.lower || b.lower == a.lower && a.outcome.is_undecided();
        return Some(if is_next { next } else { known });
    };
    let when = |cast: MotionCast<V>| match cast.outcome {
        Outcome::Hit(hit) if !cast.is_certain() => hit.time,
        _ => cast.upper,
    };
    let earlier = if when(b) < when(a) { next } else { known };
    Some(PathContact { cast: MotionCast { lower, upper, ..earlier.cast }, ..earlier })
}

/// The time after which another contact cannot be the first. A cast that is undecided may be in contact from its lower
/// bound on.
fn end_of<V: Vector>(cast: &MotionCast<V>) -> V::Scalar {
    if cast.outcome.is_undecided() { cast.lower } else { cast.upper }
}

/// What becomes of a contact that is [open at the end](is_open_at_end) of an edge, given the first contact on the next
/// edge. If that edge begins in contact, or comes to a contact at once, the open one is certain, at the waypoint.
fn goes_on<V: Vector>(open: PathContact<V>, next: Option<PathContact<V>>) -> PathContact<V> {
    let is_at_once = |cast: &MotionCast<V>| cast.is_certain() && cast.upper < at_waypoint();
    let Some(mut next) = next.filter(|next| is_at_once(&next.cast)) else { return open };
    if let Outcome::Hit(hit) = &mut next.cast.outcome {
        hit.time = Scalar::ONE;
    }
    (next.edge, next.cast.lower) = (open.edge, open.cast.lower);
    next.cast.upper = V::Scalar::ONE + next.cast.upper + V::Scalar::EPSILON;
    next
}

/// How near to the waypoint, in time, both contacts have to be. The time of a contact that bodies come to sideways is
/// known only as well as the square root of the error of a distance.
fn at_waypoint<S: Scalar>() -> S {
    S::EPSILON.sqrt() * S::from_f64(16.0)
}

/// Whether rounding leaves open whether there is a contact at the end of an edge, before which there is none.
fn is_open_at_end<V: Vector>(PathContact { cast, .. }: &PathContact<V>) -> bool {
    !cast.is_certain() && V::Scalar::ONE - cast.lower < at_waypoint()
}
