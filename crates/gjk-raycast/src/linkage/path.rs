//! Whether a linkage meets anything along a path.

use alloc::vec::Vec;

use convex_support::{Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::bounds::Bounds;
use super::error::LinkageError;
use super::link_motion::{LinkMotion, PathEdge};
use super::linkage::Linkage;
use super::proof::{FreeInterval, ProvedSteps, Watch};
use super::result::{Met, Path, PathContact, PathOutcome, PathStop, PathWork};
use super::sweep::{Near, Sweep, SweepSpace};
use crate::half_space::Plane;
use crate::motion::checked;
use crate::options::setters;
use crate::{
    MotionCast, MotionCastOptions, MotionIterate, Outcome, RayCastError, RigidMotion, Scene, motion_cast_with,
};

/// Parts of a box of joint values to look at: a pair of links of a robot arm takes up to ten thousand.
const MAX_BOXES: usize = 100_000;

/// Options of [`Linkage::path`] and [`Linkage::joint_box`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LinkageOptions<V: Vector> {
    /// How near is too near: bodies count as touching at this distance. A negative value is taken for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// As of [`MotionCastOptions::tolerance`]. Default: 0.
    pub tolerance: V::Scalar,
    /// As of [`MotionCastOptions::max_iterations`], for each body of a link and each that is near it. Default: that of
    /// a motion cast.
    pub max_iterations: usize,
    /// The parts of a box of joint values to look at, after which to give up. Default: 100 000.
    pub max_boxes: usize,
}

impl<V: Vector> LinkageOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        let MotionCastOptions { target_distance, tolerance, max_iterations, .. } = MotionCastOptions::<V>::new();
        Self { target_distance, tolerance, max_iterations, max_boxes: MAX_BOXES }
    }

    setters!(target_distance, tolerance, max_iterations);

    /// With another number of [parts](Self::max_boxes).
    #[must_use]
    pub const fn with_max_boxes(mut self, max_boxes: usize) -> Self {
        self.max_boxes = max_boxes;
        self
    }

    /// Those of casts.
    pub(super) fn checked(&self) -> Result<MotionCastOptions<V>, RayCastError> {
        let options = MotionCastOptions::new().with_target_distance(self.target_distance);
        checked(options.with_tolerance(self.tolerance).with_max_iterations(self.max_iterations))
    }
}

impl<V: Vector> Default for LinkageOptions<V> {
    fn default() -> Self {
        Self::new()
    }
}

/// What [`Linkage::path`] works with. Once it has served a path of a linkage, the next allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct PathWorkspace<V: Vector> {
    sweep: SweepSpace<V>,
    half_spaces: Vec<(usize, Plane<V>)>,
}

impl<V: Vector> PathWorkspace<V> {
    /// An empty one.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

/// A cast by options, which shows an observer the times that it looks at.
type Caster<'c, V> =
    &'c dyn Fn(MotionCastOptions<V>, &mut dyn FnMut(MotionIterate<V>)) -> Result<MotionCast<V>, RayCastError>;

impl<S: SupportMap> Linkage<S> {
    /// Whether the way along waypoints is free, among the bodies of a scene at rest, and of the
    /// [pairs](Self::with_pairs) of its own links.
    ///
    /// A waypoint has a value for each joint that moves, in their order. Between two waypoints all joints move at
    /// constant rates, in one unit of time. A path of one waypoint is the pose.
    ///
    /// Along each edge, what comes near is found first. What is near is cast, earliest first, and only until the first
    /// contact so far: [`motion_cast`](crate::motion_cast()) proves it free at all times, or brackets its first contact.
    /// Bounds account for the rounding of the joints' poses too, so that [`PathOutcome::Free`] is a proof about the
    /// linkage as it is given by its numbers.
    ///
    /// # Errors
    /// [`LinkageError`] if the path is empty, a waypoint has another number of values than [`values`](Self::values), a
    /// value is not finite, or an option is NaN.
    pub fn path<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        options: LinkageOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
    ) -> Result<Path<S::Vector>, LinkageError> {
        self.watched_path(waypoints, scene, options, workspace, None)
    }

    /// [`path`](Self::path), showing an observer what proves it, bodies and intervals in no particular order. Those of a
    /// free path cover all of its edges, for each body of a link and each of the scene, and each pair that is asked
    /// about; those of another come up to where it is said to be free. It takes longer: a look that shows at once that
    /// nothing is near is told body by body.
    ///
    /// # Errors
    /// As of [`path`](Self::path).
    pub fn path_with<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        options: LinkageOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
        mut observer: impl FnMut(FreeInterval<S::Vector>),
    ) -> Result<Path<S::Vector>, LinkageError> {
        self.watched_path(waypoints, scene, options, workspace, Some(&mut observer))
    }

    /// [`path`](Self::path) of many paths on all threads, such as the edges of a roadmap; answers in the same order.
    #[cfg(feature = "rayon")]
    pub fn par_paths<O: SupportMap<Vector = S::Vector> + Sync, P: AsRef<[W]> + Sync, W: AsRef<[ScalarOf<S>]>>(
        &self,
        paths: &[P],
        scene: &Scene<O>,
        options: LinkageOptions<S::Vector>,
    ) -> Vec<Result<Path<S::Vector>, LinkageError>>
    where
        S: Sync,
    {
        use rayon::prelude::*;
        let ask = |workspace: &mut _, path: &P| self.path(path.as_ref(), scene, options, workspace);
        paths.par_iter().map_init(PathWorkspace::new, ask).collect()
    }

    fn watched_path<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        options: LinkageOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
        observer: Option<&mut dyn FnMut(FreeInterval<S::Vector>)>,
    ) -> Result<Path<S::Vector>, LinkageError> {
        let options = options.checked()?;
        for (index, waypoint) in waypoints.iter().enumerate() {
            self.check(index, waypoint.as_ref())?;
        }
        let PathWorkspace { sweep, half_spaces } = workspace;
        half_spaces.clear();
        half_spaces.extend(scene.half_spaces().map(|(index, half_space)| (index, half_space.plane())));
        let mut work = PathWork::default();
        let mut watch = Watch { observer, edge: 0 };
        let mut open = None;
        let edges = waypoints.windows(2).map(|pair| (&pair[0], &pair[1], ScalarOf::<S>::ONE));
        let pose = waypoints.first().filter(|_| waypoints.len() == 1).map(|pose| (pose, pose, Scalar::ZERO));
        for (index, (from, to, duration)) in edges.chain(pose).enumerate() {
            let edge = PathEdge { from: from.as_ref(), to: to.as_ref() };
            let (tree, target, skeleton) = (scene.tree(), options.target_distance, &self.skeleton);
            sweep.parts = 0;
            let mut first = First::<S::Vector> { edge: index, contact: None, stop: None };
            let mut sweeping = Sweep { skeleton, tree, half_spaces, edge, target, space: sweep };
            watch.edge = index;
            sweeping.run(duration, &mut watch, &mut |near, bounds, watch| {
                work.casts += 1;
                self.cast(near, scene, (edge, bounds), options.with_max_time(duration), &mut first, watch)?;
                Ok::<_, RayCastError>(first.end(duration))
            })?;
            work.parts += sweep.parts;
            let outcome = open.map_or(first.outcome(), |open| Some(first.goes_on(open)));
            // What rounding leaves open at a waypoint, the next edge may decide.
            if open.is_none() && index + 2 < waypoints.len() && outcome.is_some_and(|outcome| is_open_at_end(&outcome))
            {
                open = outcome;
            } else if let Some(outcome) = outcome {
                return Ok(Path { outcome, work });
            }
        }
        if waypoints.is_empty() { Err(LinkageError::EmptyPath) } else { Ok(Path { outcome: PathOutcome::Free, work }) }
    }

    /// Casts a body at what may come near it.
    fn cast<O: SupportMap<Vector = S::Vector>>(
        &self,
        near: &Near<ScalarOf<S>>,
        scene: &Scene<O>,
        (edge, bounds): (PathEdge<'_, ScalarOf<S>>, &Bounds<ScalarOf<S>>),
        options: MotionCastOptions<S::Vector>,
        first: &mut First<S::Vector>,
        watch: &mut Watch<'_, S::Vector>,
    ) -> Result<(), RayCastError> {
        let &Near { from, to, item, body, other } = near;
        let links = &self.skeleton.links;
        // The end of a part is none of the edge: where rounding decides whether a contact comes before it, the cast goes
        // on.
        let whole = options.max_time - from;
        let mut cast_to_end = |met: Met, link: usize, axis, cast: Caster<'_, S::Vector>| {
            let mut cast_to = |end| {
                let mut steps = ProvedSteps::new();
                let mut show = |times: [ScalarOf<S>; 2], normals| {
                    watch.show(times.map(|time| from + time), [link, body], met, normals);
                };
                let options = MotionCastOptions { axis, ..options.with_max_time(end) };
                let answer = cast(options, &mut |there| steps.see(&there, &mut show))?;
                steps.end(&answer, show);
                Ok::<_, RayCastError>(answer)
            };
            let part = cast_to(to - from)?;
            let is_open = !part.is_certain() && to - from < whole;
            if is_open { cast_to(whole) } else { Ok(part) }
        };
        // A first guess of the normal: from ball to ball.
        let center = |motion: &LinkMotion<'_, S::Vector>, link: usize| {
            motion.at(Scalar::ZERO).0.frame.of(links[link].balls[body].ball.center)
        };
        let Some(pair) = item.checked_sub(links.len()) else {
            let Some(obstacle) = scene.get(other) else { return Ok(()) };
            let motion = LinkMotion::new(&links[item].route, edge, from, *bounds);
            let axis = scene.tree().get(other).map(|around| center(&motion, item) - around.center());
            let (met, shape) = (Met::Obstacle(other), &self.bodies[item][body]);
            let cast =
                cast_to_end(met, item, axis, &|options, watch| obstacle.motion_cast(shape, &motion, options, watch))?;
            first.take(cast, from, [item, body], met);
            return Ok(());
        };
        let pair = &self.skeleton.pairs[pair];
        let [link, base] = pair.links;
        let motion = LinkMotion::new(&pair.route, edge, from, *bounds);
        let (shape, base_shape) = (&self.bodies[link][body], &self.bodies[base][other]);
        let met = Met::Link { link: base, body: other };
        let mut cast = cast_to_end(met, link, None, &|options, watch| {
            motion_cast_with(shape, &motion, base_shape, RigidMotion::default(), options, watch)
        })?;
        if let Outcome::Hit(hit) = &mut cast.outcome {
            // It was seen from the second link.
            let route = &links[base].route;
            let frame = LinkMotion::new(route, edge, from, edge.bounds(route)).at(hit.time).1;
            (hit.point, hit.normal) = (frame.of(hit.point), hit.normal.map(|normal| frame.rotation * normal));
        }
        first.take(cast, from, [link, body], met);
        Ok(())
    }
}

/// The first contact on an edge so far.
struct First<V: Vector> {
    edge: usize,
    contact: Option<PathContact<V>>,
    /// Where an undecided cast may be one.
    stop: Option<PathStop<V::Scalar>>,
}

impl<V: Vector> First<V> {
    /// Takes the cast of a body that began at a time. The first contact of all is bracketed by the least bounds of each.
    fn take(&mut self, cast: MotionCast<V>, from: V::Scalar, [link, body]: [usize; 2], met: Met) {
        // The sum with a start is rounded.
        let room = if from == V::Scalar::ZERO { from } else { V::Scalar::EPSILON };
        let [lower, upper] = [from + cast.lower - room, from + cast.upper + room];
        let lower = lower.max(from);
        match cast.outcome {
            Outcome::Miss(_) => {}
            Outcome::Undecided => {
                if self.stop.is_none_or(|stop| lower < stop.lower) {
                    self.stop = Some(PathStop { edge: self.edge, lower, link, body, met });
                }
            }
            Outcome::Hit(hit) => {
                let time = (from + hit.time).min(upper).max(lower);
                let status = cast.status;
                let (point, normal) = (hit.point, hit.normal);
                let next = PathContact { edge: self.edge, time, lower, upper, link, body, met, point, normal, status };
                self.contact = Some(match self.contact {
                    None => next,
                    Some(known) => {
                        let earlier = if time < known.time { next } else { known };
                        PathContact { lower: lower.min(known.lower), upper: upper.min(known.upper), ..earlier }
                    }
                });
            }
        }
    }

    /// The time from which on nothing matters.
    fn end(&self, duration: V::Scalar) -> V::Scalar {
        let [contact, stop] = [self.contact.map(|contact| contact.upper), self.stop.map(|stop| stop.lower)];
        contact.into_iter().chain(stop).fold(duration, Float::min)
    }

    /// What is known at the end of the edge before, where that is [open](is_open_at_end) and this edge follows: where
    /// this one begins in contact, or comes to one at once, that is the contact, at the waypoint.
    fn goes_on(&self, open: PathOutcome<V>) -> PathOutcome<V> {
        let (edge, lower) = match open {
            PathOutcome::Contact(contact) => (contact.edge, contact.lower),
            PathOutcome::Undecided(stop) => (stop.edge, stop.lower),
            PathOutcome::Free => return open,
        };
        match self.outcome() {
            Some(PathOutcome::Contact(contact)) if contact.is_certain() && contact.upper < at_waypoint() => {
                let (time, upper) = (V::Scalar::ONE, V::Scalar::ONE + contact.upper + V::Scalar::EPSILON);
                PathOutcome::Contact(PathContact { edge, time, lower, upper, ..contact })
            }
            _ => open,
        }
    }

    /// What is known of the edge; `None` if it is free.
    fn outcome(&self) -> Option<PathOutcome<V>> {
        let stop = self.stop.filter(|stop| self.contact.is_none_or(|contact| stop.lower < contact.lower));
        stop.map(PathOutcome::Undecided).or(self.contact.map(PathOutcome::Contact))
    }
}

/// How near the end of an edge, or the beginning of the next, is at the waypoint: a contact that is come to from the
/// side is known to the root of what a distance is.
fn at_waypoint<S: Scalar>() -> S {
    S::EPSILON.sqrt() * S::from_f64(16.0)
}

/// Whether something may be met at the end of an edge, and not before it.
fn is_open_at_end<V: Vector>(outcome: &PathOutcome<V>) -> bool {
    let lower = match outcome {
        PathOutcome::Contact(contact) if !contact.is_certain() => contact.lower,
        PathOutcome::Undecided(stop) => stop.lower,
        PathOutcome::Free | PathOutcome::Contact(_) => return false,
    };
    V::Scalar::ONE - lower < at_waypoint()
}
