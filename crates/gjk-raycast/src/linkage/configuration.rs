//! A linkage at one configuration: where its joints are, whether it is free, how near it comes, and which joint helps.
//!
//! Each link's frame is found once, by the joints from the world on, and each body of a link is then asked about the
//! scene as any placed shape is. A body only has to be looked at as far as it may be nearer than the nearest so far.
//! The frames carry bounds on their rounding, by which the bounds of a distance are widened: they hold for the linkage
//! that the given numbers define.

use alloc::vec::Vec;

use convex_support::numerics::bound::raised;
use convex_support::{BoundingSphere, Point, Posed, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::error::LinkageError;
use super::frame::{LinkFrame, epsilons};
use super::joint::MovingFrame;
use super::joint_trajectory::JointTrajectory as _;
use super::link_motion::PathEdge;
use super::path_answer::Met;
use super::robot::{JointPlace, LinkView, Linkage, Skeleton};
use crate::outcome::check_limits;
use crate::{DistanceOptions, Scene, SignedDistance, SignedDistanceOptions, distance, signed_distance};

/// What questions about one configuration work with. Once it has served a linkage, the next allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct ConfigurationWorkspace<V: Vector> {
    /// The frame of each joint that moves, and the place of each link.
    moving: Vec<MovingFrame<V>>,
    links: Vec<LinkPlace<V>>,
}

/// Where a link is.
#[derive(Clone, Debug)]
struct LinkPlace<V: Vector> {
    frame: LinkFrame<V>,
    /// The pose of its bodies; `None` if it is not finite.
    pose: Option<Posed<Point<V>>>,
}

impl<V: Vector> ConfigurationWorkspace<V> {
    /// An empty one.
    #[must_use]
    pub fn new() -> Self {
        Self { moving: Vec::new(), links: Vec::new() }
    }
}

/// The answer of [`Linkage::clearance`](crate::Linkage::clearance): the body of a link that is nearest to another body,
/// or deepest in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct LinkClearance<V: Vector> {
    /// The link.
    pub link: usize,
    /// The body of the link.
    pub body: usize,
    /// The other body. Of equals it is the one of the lowest link, and of its lowest body; obstacles come first.
    pub met: Met,
    /// The signed distance of the body, `a`, as [`placed`](crate::Linkage::placed), from the other one, `b`.
    pub distance: SignedDistance<V>,
    /// No signed distance of the linkage is less, whatever the rounding of its poses.
    pub lower: V::Scalar,
    /// One is no greater.
    pub upper: V::Scalar,
}

impl<S: SupportMap> Linkage<S> {
    /// The frame of a joint, moving or fixed, at joint values, as seen from the world.
    ///
    /// ```
    /// use convex_support::{Ball, glam::DVec2};
    /// use gjk_raycast::{Joint, JointKind, Link, Linkage, Pose};
    ///
    /// let shoulder = Joint { parent: None, pose: Pose::default(), kind: JointKind::Revolute(1.0) };
    /// let at_hand = Pose { translation: DVec2::X * 2.0, ..Pose::default() };
    /// let hand = Joint { parent: Some(0), pose: at_hand, kind: JointKind::Fixed };
    /// let arm = Linkage::new([shoulder, hand], [Link { joint: Some(1), bodies: vec![Ball::new(0.1)?] }])?;
    /// let frame = arm.joint_frame(1, &[90f64.to_radians()])?;
    /// assert!((frame.translation - DVec2::Y * 2.0).length() < 1e-15);
    /// assert!(frame.shift_error < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`LinkageError`] if there is no such joint, or the values are not as many finite numbers as there are
    /// [values](Self::values).
    pub fn joint_frame(&self, joint: usize, values: &[ScalarOf<S>]) -> Result<LinkFrame<S::Vector>, LinkageError> {
        self.check(0, values)?;
        let JointPlace { carrier, fixed, .. } =
            self.skeleton.joints.get(joint).ok_or(LinkageError::NoSuchFrame { joint })?;
        let mut moving = Vec::new();
        self.skeleton.place(values, &mut moving);
        Ok(frame_of(&moving, *carrier).then(fixed))
    }

    /// Whether the linkage is free at joint values: whether all bodies of its links are certainly farther than
    /// `target_distance` from all bodies of the scene, and those of its [pairs](Self::with_pairs) from one another.
    ///
    /// `true` is a proof for the linkage that the given numbers define. `false` means that something is as near, or
    /// that rounding leaves it open; the search ends there.
    ///
    /// # Errors
    /// [`LinkageError`] if the values are not as many finite numbers as there are [values](Self::values), or too large,
    /// or the target distance is NaN or infinite.
    pub fn is_free<O: SupportMap<Vector = S::Vector>>(
        &self,
        values: &[ScalarOf<S>],
        scene: &Scene<O>,
        target_distance: ScalarOf<S>,
        workspace: &mut ConfigurationWorkspace<S::Vector>,
    ) -> Result<bool, LinkageError> {
        check_limits(ScalarOf::<S>::ZERO, target_distance)?;
        let places = self.place_links(values, workspace)?;
        // A distance of this or more is greater than the target, whatever the errors of the poses.
        let enough = |errors: ScalarOf<S>| {
            let beyond = raised(Float::max(target_distance, Scalar::ZERO) + errors);
            Float::max(beyond, Float::min_positive_value())
        };
        for at in self.each_body() {
            let (shape, error) = self.body_at(at, places)?;
            let limit = enough(error);
            if scene.all().nearest(&shape, DistanceOptions::new().with_limit(limit)).lower < limit {
                return Ok(false);
            }
        }
        for [a, b] in self.own_pairs() {
            let limit = enough(self.error_at(a, places) + self.error_at(b, places));
            if self.gap([a, b], places) >= limit {
                continue;
            }
            let [(a, _), (b, _)] = [self.body_at(a, places)?, self.body_at(b, places)?];
            if distance(&a, &b, DistanceOptions::new().with_limit(limit)).lower < limit {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The least signed distance at joint values, of all bodies of the links from the bodies of the scene, and of the
    /// [pairs](Self::with_pairs) from one another. `None` if none is within the
    /// [limit](SignedDistanceOptions::limit) of the options, as where there are no other bodies.
    ///
    /// Each distance is that of [`placed`](Self::placed) bodies by [`signed_distance`](crate::signed_distance()), to
    /// the last bit. The bounds of the answer also account for the rounding of the poses.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, Rounded, Segment, glam::DVec3};
    /// use gjk_raycast::{
    ///     ConfigurationWorkspace, Joint, JointKind, Link, Linkage, Met, Pose, Scene, SignedDistanceOptions,
    /// };
    ///
    /// // An arm of one link along x, 0.1 thick, which turns about z. A ball is above its end.
    /// let bar = Rounded::new(Segment::new([DVec3::ZERO, DVec3::X])?, 0.1)?;
    /// let arm = Linkage::new(
    ///     [Joint { parent: None, pose: Pose::default(), kind: JointKind::Revolute(DVec3::Z) }],
    ///     [Link { joint: Some(0), bodies: vec![bar] }],
    /// )?;
    /// let scene = Scene::new([Posed::translated(Ball::new(0.2)?, DVec3::new(1.0, 0.5, 0.0))?])?;
    /// let mut workspace = ConfigurationWorkspace::new();
    /// assert!(arm.is_free(&[0.0], &scene, 0.1, &mut workspace)?);
    /// let least = arm.clearance(&[0.0], &scene, SignedDistanceOptions::new(), &mut workspace)?;
    /// let least = least.ok_or("there is a ball")?;
    /// assert_eq!((least.link, least.met), (0, Met::Obstacle(0)));
    /// assert!((least.distance.signed_distance - 0.2).abs() < 1e-15);
    ///
    /// // As it turns to the ball, its end rises by 1 per radian.
    /// let mut gradient = [0.0];
    /// arm.clearance_gradient(&[0.0], &least, &mut gradient)?;
    /// assert!((gradient[0] + 1.0).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`LinkageError`] if the values are not as many finite numbers as there are [values](Self::values), or too large.
    pub fn clearance<O: SupportMap<Vector = S::Vector>>(
        &self,
        values: &[ScalarOf<S>],
        scene: &Scene<O>,
        options: SignedDistanceOptions<S::Vector>,
        workspace: &mut ConfigurationWorkspace<S::Vector>,
    ) -> Result<Option<LinkClearance<S::Vector>>, LinkageError> {
        let places = self.place_links(values, workspace)?;
        let end = Float::min(options.limit, Float::infinity());
        let mut least = LeastClearance { limit: end, lower: end, found: None };
        for at in self.each_body() {
            let (shape, error) = self.body_at(at, places)?;
            let there = scene.all().least_signed_distance(&shape, options.with_limit(least.room()));
            least.lower = Float::min(least.lower, there.lower - error);
            if let Some(next) = there.least {
                let obstacle = next.body;
                let met = next.member.map_or(Met::Obstacle(obstacle), |member| Met::Member { obstacle, member });
                least.see(at, met, next.distance, error);
            }
        }
        for [at, b] in self.own_pairs() {
            let error = raised(self.error_at(at, places) + self.error_at(b, places));
            if self.gap([at, b], places) - error > least.room() {
                continue;
            }
            let [(shape, _), (other, _)] = [self.body_at(at, places)?, self.body_at(b, places)?];
            let there = signed_distance(&shape, &other, options.with_limit(least.room()));
            least.see(at, Met::Link { link: b.0, body: b.1 }, there, error);
        }
        let lower = least.lower;
        Ok(least.found.map(|found| LinkClearance { lower, ..found }))
    }

    /// The derivatives of a [`clearance`](Self::clearance) by the joint values that it was found at, one for each joint
    /// that moves, written into `gradient`.
    ///
    /// With `n` the normal, and `p` the closest point of a link that joint `j` carries, they are `n·∂p/∂qⱼ`, less the
    /// same for the other link of a pair. They are derivatives where the answer has one normal and one pair of closest
    /// points, and is not as near elsewhere; otherwise one-sided. They are as accurate as the normal and the points.
    ///
    /// # Errors
    /// [`LinkageError`] if the values or the derivatives are not as many as there are [values](Self::values), a value
    /// is not finite, or the answer names a link that is not there.
    pub fn clearance_gradient(
        &self,
        values: &[ScalarOf<S>],
        clearance: &LinkClearance<S::Vector>,
        gradient: &mut [ScalarOf<S>],
    ) -> Result<(), LinkageError> {
        self.check(0, values)?;
        self.check(1, gradient)?;
        gradient.fill(Scalar::ZERO);
        let SignedDistance { normal, point_a, point_b, .. } = clearance.distance;
        let edge = PathEdge { from: values, to: values };
        self.add_rises(clearance.link, edge, Scalar::ZERO, [normal, point_a], gradient)?;
        match clearance.met {
            Met::Link { link, .. } => self.add_rises(link, edge, Scalar::ZERO, [-normal, point_b], gradient),
            Met::Obstacle(_) | Met::Member { .. } => Ok(()),
        }
    }

    fn place_links<'w>(
        &self,
        values: &[ScalarOf<S>],
        workspace: &'w mut ConfigurationWorkspace<S::Vector>,
    ) -> Result<&'w [LinkPlace<S::Vector>], LinkageError> {
        self.check(0, values)?;
        let ConfigurationWorkspace { moving, links } = workspace;
        self.skeleton.place(values, moving);
        links.clear();
        let place = |view: &LinkView<S::Vector>| {
            let frame = frame_of(moving, view.route.stages.last().map(|stage| stage.column)).then(&view.route.tail);
            LinkPlace { pose: frame.pose(), frame }
        };
        links.extend(self.skeleton.views[..self.links()].iter().map(place));
        Ok(links)
    }

    /// Every body, by its link and its index in that.
    fn each_body(&self) -> impl Iterator<Item = BodyIndex> + '_ {
        self.bodies.iter().enumerate().flat_map(|(link, bodies)| (0..bodies.len()).map(move |body| (link, body)))
    }

    /// The pairs of bodies of links that are tested against one another.
    fn own_pairs(&self) -> impl Iterator<Item = [BodyIndex; 2]> + '_ {
        let pairs = self.skeleton.views.iter().filter_map(|view| Some((view.link, view.base?)));
        pairs.flat_map(|(a, b)| {
            let of_b = self.bodies(b).len();
            (0..self.bodies(a).len()).flat_map(move |i| (0..of_b).map(move |j| [(a, i), (b, j)]))
        })
    }

    /// A body at its place, and by how much that may be wrong.
    #[inline]
    fn body_at(
        &self,
        at @ (link, body): BodyIndex,
        places: &[LinkPlace<S::Vector>],
    ) -> Result<(Posed<&S>, ScalarOf<S>), LinkageError> {
        Ok((self.placed_at((link, body), places[link].pose.as_ref())?, self.error_at(at, places)))
    }

    /// By how much the place of a body may be wrong. A rotation that has drifted is replaced by the nearest one, which
    /// is no farther from it than the exact one.
    fn error_at(&self, (link, body): BodyIndex, places: &[LinkPlace<S::Vector>]) -> ScalarOf<S> {
        let (frame, BoundingSphere { center, radius }) = (&places[link].frame, &self.skeleton.links[link].each[body]);
        let reach = center.norm() + *radius;
        raised(frame.error_of(reach) + frame.turn_error * reach)
    }

    /// How far the balls around two bodies are apart.
    fn gap(&self, [a, b]: [BodyIndex; 2], places: &[LinkPlace<S::Vector>]) -> ScalarOf<S> {
        let [a, b] = [a, b].map(|(link, body)| {
            let ball = &self.skeleton.links[link].each[body];
            (places[link].frame.of(ball.center), ball.radius)
        });
        let apart = (a.0 - b.0).norm();
        apart - raised(a.1 + b.1) - epsilons::<ScalarOf<S>>(8.0) * apart
    }
}

/// A link, and the index of a body in it.
type BodyIndex = (usize, usize);

/// The least signed distance so far.
struct LeastClearance<V: Vector> {
    /// Its value, or the limit of the question.
    limit: V::Scalar,
    lower: V::Scalar,
    found: Option<LinkClearance<V>>,
}

impl<V: Vector> LeastClearance<V> {
    /// How far apart bodies may be that count. Depths are compared with one another.
    fn room(&self) -> V::Scalar {
        Float::max(self.limit, Scalar::ZERO)
    }

    fn see(&mut self, (link, body): BodyIndex, met: Met, distance: SignedDistance<V>, error: V::Scalar) {
        let (value, lower, upper) = (distance.signed_distance, distance.lower - error, distance.upper + error);
        self.lower = Float::min(self.lower, lower);
        if value < self.limit {
            self.limit = value;
            self.found = Some(LinkClearance { link, body, met, distance, lower, upper });
        }
    }
}

/// The frame of a joint that moves, or of the world.
fn frame_of<V: Vector>(moving: &[MovingFrame<V>], joint: Option<usize>) -> LinkFrame<V> {
    joint.map_or(LinkFrame::WORLD, |joint| moving[joint].frame)
}

impl<V: Vector> Skeleton<V> {
    /// Places the joints that move.
    fn place(&self, values: &[V::Scalar], moving: &mut Vec<MovingFrame<V>>) {
        let edge = PathEdge { from: values, to: values };
        moving.clear();
        for (before, stage) in &self.stages {
            let carrier = before.map_or(MovingFrame::WORLD, |before| moving[before]);
            moving.push(carrier.beyond(stage, edge.state(stage.column, Scalar::ZERO)));
        }
    }
}
