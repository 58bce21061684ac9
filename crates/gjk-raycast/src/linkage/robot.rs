//! Bodies that joints carry.

use alloc::vec::Vec;

use convex_support::numerics::angular;
use convex_support::numerics::bound::raised;
use convex_support::{
    Aabb, BoundingSphere, Core, Matrix as _, Point, Posed, Scalar, ScalarOf, SupportMap, Vector, bounding_sphere,
    support_value,
};
use num_traits::Float;

use super::error::LinkageError;
use super::frame::{LinkFrame, epsilons};
use super::joint::{Joint, JointKind, JointStage, Link, MovingFrame};
use super::joint_trajectory::JointTrajectory as _;
use super::link_motion::{PathEdge, Route};
use super::path_answer::{Met, PathContact};
use crate::Impact;

/// A robot: links, each of some bodies, carried by joints in a tree.
///
/// ```
/// use convex_support::{Ball, Posed, Rounded, Segment, glam::DVec3};
/// use gjk_raycast::{Joint, JointKind, Link, Linkage, MotionCastOptions, PathWorkspace, Pose, Scene};
///
/// // An arm of two links of length 1, whose shoulder and elbow turn about z.
/// let bar = Rounded::new(Segment::new([DVec3::ZERO, DVec3::X])?, 0.05)?;
/// let elbow = Pose { translation: DVec3::X, ..Pose::default() };
/// let arm = Linkage::new(
///     [
///         Joint { parent: None, pose: Pose::default(), kind: JointKind::Revolute(DVec3::Z) },
///         Joint { parent: Some(0), pose: elbow, kind: JointKind::Revolute(DVec3::Z) },
///     ],
///     [Link { joint: Some(0), bodies: vec![bar] }, Link { joint: Some(1), bodies: vec![bar] }],
/// )?;
///
/// // It reaches along x, and is to reach along y. A ball is in the way of the forearm.
/// let scene = Scene::new([Posed::translated(Ball::new(0.1)?, DVec3::new(1.25, 1.25, 0.0))?])?;
/// let (mut workspace, options) = (PathWorkspace::new(), MotionCastOptions::new());
/// let straight = [[0.0, 0.0], [90f64.to_radians(), 0.0]];
/// let path = arm.path(&straight, &scene, options, &mut workspace)?;
/// let (contact, hit) = path.contact().ok_or("the forearm sweeps over the ball")?;
/// assert_eq!((contact.edge, contact.link), (0, 1));
/// // The ball is at 45°; the bar touches it where it is 0.15 from its middle.
/// let truth = (45.0 - (0.15 / (1.25 * 2f64.sqrt())).asin().to_degrees()) / 90.0;
/// let cast = contact.cast;
/// assert!(cast.lower <= truth && truth <= cast.upper && (hit.time - truth).abs() < 1e-12);
///
/// // With the elbow bent by 150° on the way it is free: at every time, which is proved.
/// let fold = 150f64.to_radians();
/// let around = [[0.0, 0.0], [0.0, fold], [90f64.to_radians(), fold], [90f64.to_radians(), 0.0]];
/// assert!(arm.path(&around, &scene, options, &mut workspace)?.is_free());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// All bodies are of one type, as in a [`Scene`](crate::Scene). Links are tested against one another only in the
/// [pairs](Self::with_pairs) that you name. Two robots that both move are one linkage of two trees, with pairs of
/// links of both.
#[doc(alias("robot", "kinematic_chain", "articulation", "manipulator"))]
#[derive(Clone, Debug)]
pub struct Linkage<S: SupportMap> {
    pub(super) skeleton: Skeleton<S::Vector>,
    /// The bodies of each link.
    pub(super) bodies: Vec<Vec<S>>,
}

/// The part of a linkage that does not depend on its shapes.
#[derive(Clone, Debug)]
pub(super) struct Skeleton<V: Vector> {
    /// The joints that move, each with the index of the moving joint that carries it, which comes before it.
    pub(super) stages: Vec<(Option<usize>, JointStage<V>)>,
    /// All joints, as given.
    pub(super) joints: Vec<JointPlace<V>>,
    pub(super) links: Vec<LinkBalls<V>>,
    /// One view of each link from the world, and after these one of each pair to be tested.
    pub(super) views: Vec<LinkView<V>>,
}

/// A joint, and where it is.
#[derive(Clone, Debug)]
pub(super) struct JointPlace<V: Vector> {
    pub(super) joint: Joint<V>,
    /// The last moving joint up to and including it, and its own frame as seen from there.
    pub(super) carrier: Option<usize>,
    pub(super) fixed: LinkFrame<V>,
    /// Whether a link hangs from it or from a joint that it carries.
    pub(super) carries: bool,
}

/// A ball around each body of a link, in its own frame, and one around all of them.
#[derive(Clone, Debug)]
pub(super) struct LinkBalls<V: Vector> {
    /// The joint that carries it.
    pub(super) joint: Option<usize>,
    pub(super) each: Vec<BoundingSphere<V>>,
    pub(super) all: BoundingSphere<V>,
}

/// A link in the frame of another one, or of the world, and the route from there.
#[derive(Clone, Debug)]
pub(super) struct LinkView<V: Vector> {
    pub(super) link: usize,
    pub(super) base: Option<usize>,
    pub(super) route: Route<V>,
}

impl<S: SupportMap> Linkage<S> {
    /// The linkage of these joints, each after its parent, and links.
    ///
    /// # Errors
    /// [`LinkageError`] with the index of the first joint, link or body that is not valid.
    pub fn new(
        joints: impl IntoIterator<Item = Joint<S::Vector>>,
        links: impl IntoIterator<Item = Link<S>>,
    ) -> Result<Self, LinkageError> {
        let mut stages: Vec<(Option<usize>, JointStage<S::Vector>)> = Vec::new();
        let mut places: Vec<JointPlace<S::Vector>> = Vec::new();
        for (index, joint) in joints.into_iter().enumerate() {
            let Joint { parent, pose, kind } = joint;
            let (before, frame) = match parent {
                None => (None, LinkFrame::WORLD),
                Some(parent) => {
                    let of = places.get(parent).ok_or(LinkageError::ParentNotBefore { joint: index, parent })?;
                    (of.carrier, of.fixed)
                }
            };
            let here = LinkFrame::at(pose).map_err(|why| LinkageError::Pose { joint: index, why })?;
            let mut place = JointPlace { joint, carrier: before, fixed: frame.then(&here), carries: false };
            if !matches!(kind, JointKind::Fixed) {
                let stage =
                    JointStage::new(place.fixed, kind, stages.len()).ok_or(LinkageError::Axis { joint: index })?;
                (place.carrier, place.fixed) = (Some(stages.len()), LinkFrame::WORLD);
                stages.push((before, stage));
            }
            places.push(place);
        }
        let (mut balls, mut views, mut all) = (Vec::new(), Vec::new(), Vec::new());
        for (link, Link { joint, bodies }) in links.into_iter().enumerate() {
            let (stage, tail) = match joint {
                None => (None, LinkFrame::WORLD),
                Some(joint) => {
                    let place = places.get_mut(joint).ok_or(LinkageError::NoSuchJoint { link, joint })?;
                    place.carries = true;
                    (place.carrier, place.fixed)
                }
            };
            let way = core::iter::successors(stage, |&index: &usize| stages[index].0);
            let mut way: Vec<_> = way.map(|index| stages[index].1.clone()).collect();
            way.reverse();
            let each: Vec<_> = bodies.iter().map(ball_of).collect();
            let reach = |ball: &BoundingSphere<S::Vector>| tail.of(ball.center).norm() + ball.radius;
            if let Some(body) = each.iter().position(|ball| !reach(ball).is_finite()) {
                return Err(LinkageError::BodyNotFinite { link, body });
            }
            views.push(LinkView { link, base: None, route: Route::new(way, tail) });
            balls.push(LinkBalls { joint, all: ball_around(&each), each });
            all.push(bodies);
        }
        // Parents come first, so that this goes from the tips of the tree to its root.
        for index in (0..places.len()).rev() {
            if let Some(parent) = places[index].joint.parent {
                places[parent].carries |= places[index].carries;
            }
        }
        Ok(Self { skeleton: Skeleton { stages, joints: places, links: balls, views }, bodies: all })
    }

    /// The linkage with pairs of links, by their indices, to be tested against one another: those that may meet.
    /// Neighbours overlap in most robots, and should be left out.
    ///
    /// # Errors
    /// [`LinkageError::Pair`] for the first pair that is not of two links.
    pub fn with_pairs(mut self, pairs: impl IntoIterator<Item = [usize; 2]>) -> Result<Self, LinkageError> {
        self.skeleton.views.truncate(self.links());
        for (pair, links) in pairs.into_iter().enumerate() {
            let route = self.skeleton.between(links).ok_or(LinkageError::Pair { pair })?;
            self.skeleton.views.push(LinkView { link: links[0], base: Some(links[1]), route });
        }
        Ok(self)
    }

    /// Whether each joint that moves carries a link. The value of one that does not changes no answer; mostly the index
    /// of a parent, or of the joint of a link, is wrong. A fixed joint may carry nothing, and a link may have no
    /// bodies.
    ///
    /// # Errors
    /// [`LinkageError::CarriesNothing`] for the first joint that carries no link.
    pub fn check_joints(&self) -> Result<(), LinkageError> {
        match self.skeleton.joints.iter().position(JointPlace::is_idle) {
            Some(joint) => Err(LinkageError::CarriesNothing { joint }),
            None => Ok(()),
        }
    }

    /// The number of joints that move, which is the number of values of a waypoint.
    #[must_use]
    pub fn values(&self) -> usize {
        self.skeleton.stages.len()
    }

    /// The number of links.
    #[must_use]
    pub fn links(&self) -> usize {
        self.bodies.len()
    }

    /// The bodies of a link, in the frame of its joint; none if there is no such link.
    #[must_use]
    pub fn bodies(&self, link: usize) -> &[S] {
        self.bodies.get(link).map_or(&[], |bodies| bodies)
    }

    /// A body of a link, posed by joint values, to rounding.
    ///
    /// # Errors
    /// [`LinkageError`] if there is no such body, or the values are not as many finite numbers as there are
    /// [values](Self::values), or too large.
    pub fn placed(&self, link: usize, body: usize, values: &[ScalarOf<S>]) -> Result<Posed<&S>, LinkageError> {
        self.check(0, values)?;
        if self.bodies(link).len() <= body {
            return Err(LinkageError::NoSuchBody { link, body });
        }
        let (route, edge) = (&self.skeleton.views[link].route, PathEdge { from: values, to: values });
        self.placed_at((link, body), route.place(edge, Scalar::ZERO).1.pose().as_ref())
    }

    /// A body that exists, in the pose of its link.
    pub(super) fn placed_at(
        &self,
        (link, body): (usize, usize),
        pose: Option<&Posed<Point<S::Vector>>>,
    ) -> Result<Posed<&S>, LinkageError> {
        let placed = pose.and_then(|pose| pose.with_shape(&self.bodies[link][body]).ok());
        placed.ok_or(LinkageError::BodyNotFinite { link, body })
    }

    /// A bound on how far any point of a link goes, if joint values change from `from` to `to`: in any direction, or
    /// along a unit vector. Along a vector it is negative if all points certainly go the other way. A link stays
    /// farther from a body at rest than a margin as long as this bound is less than the [room](crate::FreeStep) of its
    /// distance, for any path of the joints in between. Against the normal of a distance it bounds how much nearer the
    /// link may come to that body.
    ///
    /// If the joints go straight, within a unit of time, it is no more than the highest speed, nor than the first speed
    /// plus half of the highest acceleration. At first the points of a body, whose support function is `h` about an
    /// origin of the velocity `v`, go along `n` by `n·v + h(n × ω)`.
    ///
    /// # Errors
    /// Those of [`placed`](Self::placed).
    pub fn way(
        &self,
        link: usize,
        from: &[ScalarOf<S>],
        to: &[ScalarOf<S>],
        along: Option<S::Vector>,
    ) -> Result<ScalarOf<S>, LinkageError> {
        self.check(0, from)?;
        self.check(1, to)?;
        let ball = self.skeleton.links.get(link).ok_or(LinkageError::NoSuchBody { link, body: 0 })?.all;
        let (route, edge) = (&self.skeleton.views[link].route, PathEdge { from, to });
        let ((moving, frame), bounds) = (route.place(edge, Scalar::ZERO), route.bounds(|column| edge.bounds(column)));
        let reach = route.distance(ball.center) + ball.radius;
        let at_first = if let Some(n) = along {
            let turned = frame.rotation.transpose_mul(angular::turning(moving.spin, -n));
            let farthest = self.bodies(link).iter().map(|body| support_value(body, turned));
            n.dot(moving.velocity_at(frame.translation)) + farthest.fold(Float::neg_infinity(), Float::max)
        } else {
            moving.velocity_at(frame.of(ball.center)).norm() + moving.spin.norm() * ball.radius
        };
        let near = at_first + bounds.acceleration.of(reach) * Scalar::from_f64(0.5);
        let always = bounds.speed.of(reach);
        // The errors of the frame and of the derivatives are a small part of the bound that always holds.
        Ok(near.min(always) + always * (moving.frame.turn_error + epsilons(64.0)))
    }

    /// The derivatives of the time of a first contact on this path by the joint values at both ends of its edge, for
    /// each joint that moves. `None` if links overlap as the path begins, or touch and do not approach one another.
    ///
    /// With `n` the normal and `p` the point of contact, joint `j` lifts the link off the other body by
    /// `gⱼ = n·∂p/∂qⱼ`. The gap closes at the rate `−Σ gⱼ·q̇ⱼ`, so that the time changes by `Σ gⱼ·δqⱼ` over that rate.
    /// A change of the value at the end of the edge changes the value at the time `t` by a share of `t`, one at its
    /// beginning by `1 − t`.
    ///
    /// If there is only one point of contact they are derivatives, otherwise one-sided derivatives.
    ///
    /// ```
    /// use convex_support::{Ball, glam::DVec2};
    /// use gjk_raycast::{HalfSpace, Joint, JointKind, Link, Linkage, MotionCastOptions, PathWorkspace, Pose, Scene};
    ///
    /// // A ball of radius 1 slides from x = 0 to 4, and meets a wall at x = 3 when half of that is done.
    /// let slide = Joint { parent: None, pose: Pose::default(), kind: JointKind::Prismatic(DVec2::X) };
    /// let robot = Linkage::new([slide], [Link { joint: Some(0), bodies: vec![Ball::new(1.0)?] }])?;
    /// let mut scene = Scene::<Ball<DVec2>>::default();
    /// scene.insert_half_space(HalfSpace::new(DVec2::NEG_X, -3.0)?);
    /// let ways = [[0.0], [4.0]];
    /// let path = robot.path(&ways, &scene, MotionCastOptions::new(), &mut PathWorkspace::new())?;
    /// let (contact, _) = path.contact().ok_or("it meets the wall")?;
    ///
    /// // t = (2 − from)/(to − from)
    /// let [[by_from, by_to]] = robot.time_gradient(&ways, &contact).ok_or("it comes nearer")?[..] else {
    ///     return Err("there is one joint".into());
    /// };
    /// assert!((by_from + 2.0 / 16.0).abs() < 1e-12 && (by_to + 2.0 / 16.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn time_gradient<W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        contact: &PathContact<S::Vector>,
    ) -> Option<Vec<[ScalarOf<S>; 2]>> {
        let &PathContact { edge, link, met, cast, .. } = contact;
        let Impact { time, point, normal } = cast.outcome.hit()?;
        let ends = [edge, edge + 1].map(|i| waypoints.get(i).map(AsRef::as_ref));
        let edge = PathEdge { from: ends[0]?, to: ends[1]? };
        self.check(0, edge.from).and(self.check(1, edge.to)).ok()?;
        let other = if let Met::Link { link, .. } = met { Some(link) } else { None };
        let (one, mut rises) = (ScalarOf::<S>::ONE, edge.from.iter().map(|_| Scalar::ZERO).collect::<Vec<_>>());
        for (link, normal) in [(Some(link), normal?), (other, -normal?)] {
            let Some(link) = link else { continue };
            self.add_rises(link, edge, time, [normal, point], &mut rises).ok()?;
        }
        let rates = edge.to.iter().zip(edge.from).map(|(to, from)| *to - *from);
        let closing = rates.zip(&rises).fold(ScalarOf::<S>::ZERO, |sum, (rate, rise)| sum - rate * *rise);
        let by_values = |rise: ScalarOf<S>| [one - time, time].map(|share| rise / closing * share);
        (closing > Scalar::ZERO).then(|| rises.into_iter().map(by_values).collect())
    }

    /// Adds how much each joint, per unit of its value, lifts a point of a link along a normal at a time of an edge.
    pub(super) fn add_rises(
        &self,
        link: usize,
        edge: PathEdge<'_, ScalarOf<S>>,
        time: ScalarOf<S>,
        [normal, point]: [S::Vector; 2],
        rises: &mut [ScalarOf<S>],
    ) -> Result<(), LinkageError> {
        let mut moving = MovingFrame::WORLD;
        let view = self.skeleton.views.get(link).ok_or(LinkageError::NoSuchBody { link, body: 0 })?;
        for stage in &view.route.stages {
            moving = moving.beyond(stage, edge.state(stage.column, time));
            rises[stage.column] += stage.rise(stage.placed(&moving.frame), normal, point);
        }
        Ok(())
    }

    /// Checks that these are finite values, one for each joint that moves.
    pub(super) fn check(&self, waypoint: usize, values: &[ScalarOf<S>]) -> Result<(), LinkageError> {
        if values.len() != self.values() {
            return Err(LinkageError::Count { waypoint, joints: self.values(), values: values.len() });
        }
        match values.iter().position(|value| !value.is_finite()) {
            Some(value) => Err(LinkageError::Value { waypoint, value }),
            None => Ok(()),
        }
    }
}

impl<V: Vector> JointPlace<V> {
    /// Whether it moves, and carries no link.
    pub(super) fn is_idle(&self) -> bool {
        !self.carries && !matches!(self.joint.kind, JointKind::Fixed)
    }
}

impl<V: Vector> Skeleton<V> {
    /// The route from the second to the first of two links, if both exist.
    pub(super) fn between(&self, [a, b]: [usize; 2]) -> Option<Route<V>> {
        let count = self.links.len();
        (a != b && a.max(b) < count).then(|| Route::between(&self.views[b].route, &self.views[a].route))
    }
}

/// A ball around a body, with room for rounding.
fn ball_of<S: SupportMap>(body: &S) -> BoundingSphere<S::Vector> {
    let BoundingSphere { center, radius } = bounding_sphere(body);
    let Core { extent, error, .. } = body.core();
    let room = (extent + center.abs().max_element()) * ScalarOf::<S>::EPSILON * Scalar::from_f64(32.0);
    BoundingSphere { center, radius: raised(radius + error + room) }
}

/// A ball around balls.
fn ball_around<V: Vector>(balls: &[BoundingSphere<V>]) -> BoundingSphere<V> {
    let boxes = balls.iter().map(|&BoundingSphere { center, radius }| {
        let (min, max) = (center - V::splat(radius), center + V::splat(radius));
        Aabb { min, max }
    });
    let center = boxes.reduce(|a, b| a.union(&b)).map_or(V::ZERO, |around| around.center());
    let reach = |ball: &BoundingSphere<V>| (ball.center - center).norm() + ball.radius;
    BoundingSphere { center, radius: raised(balls.iter().map(reach).fold(V::Scalar::ZERO, Float::max)) }
}
