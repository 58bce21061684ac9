//! Whether links ever meet one another, or bodies at rest, at any positions of their joints.
//!
//! A box of joint values is proved to be free by one plane. All is seen in the frame of the second body: that of its
//! link, or the world for a body at rest. In the middle of the box the plane across the unit vector `n` separates the
//! two bodies. If each joint `j` changes by up to `δⱼ`, at a constant rate within a unit of time, a point `x` of the
//! first body comes nearer to the plane by no more than
//!
//! > Σ δⱼ·|mⱼ·(x − cⱼ)| + a/2,   mⱼ = n × axisⱼ,
//!
//! The sum is the largest `|n·ẋ|` in the middle, with `cⱼ` the joint's origin, and `a` bounds the acceleration at all
//! joint values. So the box is free if `n·x` less this amount stays above the plane for all points of the body. For
//! each choice of the signs of the products this least height is a support value. Each point counts with its own path:
//! one that is far from the plane may come much nearer.
//!
//! Each two bodies have their own parts of the box: what is proved for them needs no proof again where others are open,
//! and a joint that does not move them against one another is never halved for them.
//!
//! A box that is not proved to be free is halved along the joint for which halving improves the bound most. The order
//! of the boxes decides how soon a pose is found in which the links meet. Three times out of four the next box is the
//! one with the least `g·(g/s)³`, where `g` is the gap in its middle and `s` the most by which points may come nearer.
//! But around a place where the links almost meet there may be tens of thousands of boxes that all seem to be near
//! contact. So every fourth time the largest box comes next, and no part of the whole box has to wait until those are
//! done.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::{Ordering, Reverse};

use convex_support::numerics::angular;
use convex_support::numerics::bound::raised;
use convex_support::{Core, Posed, Scalar, ScalarOf, SupportMap, Vector, support_value};
use num_traits::Float;
use smallvec::SmallVec;

use super::error::LinkageError;
use super::frame::{LinkFrame, epsilons};
use super::joint::{JointStage, MovingFrame};
use super::joint_trajectory::{JointBounds, JointState};
use super::link_motion::Route;
use super::path_answer::{BodyPair, FreeBox, Met};
use super::robot::{LinkView, Linkage};
use crate::outcome::check_limits;
use crate::{Body, Scene, SignedDistanceOptions};

/// The number of joints whose signs are tried in all combinations. For each joint beyond these, the worst sign is taken
/// by itself.
const MAX_SIGNS: usize = 5;

/// One in this many parts that are halved is the largest part that is still undecided.
const LARGEST_EVERY: usize = 4;

/// The answer of [`Linkage::joint_box`], or with `P` a [`BodyPair`] that of [`Linkage::joint_box_among`].
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct JointBox<S, P = [usize; 2]> {
    /// Whether the links meet.
    pub outcome: JointBoxOutcome<S, P>,
    /// The number of parts of the box that were tested.
    pub boxes: usize,
}

/// Whether links meet anywhere in a box of joint values.
#[derive(Clone, Debug, PartialEq)]
pub enum JointBoxOutcome<S, P = [usize; 2]> {
    /// They are farther apart than the target distance everywhere in the box. This is a proof.
    Never,
    /// They are certainly no farther apart than the target distance in a pose.
    Meets {
        /// The joint values of the pose.
        values: Vec<S>,
        /// The bodies that meet: of both links, or a [`BodyPair`].
        bodies: P,
    },
    /// Neither is proved.
    Undecided {
        /// No more than this share of the box is not proved free: the sum over all pairs of bodies, but at most 1.
        share: S,
    },
}

impl<S: SupportMap> Linkage<S> {
    /// Whether two links are ever as near one another as the target distance, where each joint value may be anywhere in
    /// an interval: the joint limits, for a robot's whole life. It gives up after `max_boxes` parts of the box; a pair
    /// of links of a robot arm takes up to ten thousand.
    ///
    /// ```
    /// use convex_support::{Rounded, Segment, glam::DVec2};
    /// use gjk_raycast::{Joint, JointBoxOutcome, JointKind, Link, Linkage, Pose};
    ///
    /// // Three bars of length 1 in a row. The last may meet the first, if both joints turn far enough.
    /// let bar = Rounded::new(Segment::new([DVec2::ZERO, DVec2::X])?, 0.05)?;
    /// let at_end = Pose { translation: DVec2::X, ..Pose::default() };
    /// let link = |joint| Link { joint, bodies: vec![bar] };
    /// let chain = Linkage::new(
    ///     [
    ///         Joint { parent: None, pose: at_end, kind: JointKind::Revolute(1.0) },
    ///         Joint { parent: Some(0), pose: at_end, kind: JointKind::Revolute(1.0) },
    ///     ],
    ///     [link(None), link(Some(0)), link(Some(1))],
    /// )?;
    /// let ask = |angle: f64| chain.joint_box([2, 0], &[[-angle, angle]; 2], 0.0, 1000);
    ///
    /// // Up to 90° at both joints they do not.
    /// assert_eq!(ask(90f64.to_radians())?.outcome, JointBoxOutcome::Never);
    /// // At 120° their ends come together, and 119° are enough for bars that are 0.1 thick.
    /// assert!(matches!(ask(119f64.to_radians())?.outcome, JointBoxOutcome::Meets { .. }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`LinkageError`] if the pair is not of two links, the box has another number of intervals than there are joint
    /// values, an interval ends before it begins or is not finite, or the target distance is not finite.
    #[doc(alias("self_collision", "configuration_space"))]
    pub fn joint_box(
        &self,
        pair: [usize; 2],
        joint_box: &[[ScalarOf<S>; 2]],
        target_distance: ScalarOf<S>,
        max_boxes: usize,
    ) -> Result<JointBox<ScalarOf<S>>, LinkageError> {
        self.joint_box_with(pair, joint_box, target_distance, max_boxes, |_| {})
    }

    /// [`joint_box`](Self::joint_box) with an observer that sees the parts of the box in which two bodies are proved to
    /// be apart. If the answer is [`Never`](JointBoxOutcome::Never), they cover the box for each two bodies.
    ///
    /// # Errors
    /// Those of [`joint_box`](Self::joint_box).
    pub fn joint_box_with(
        &self,
        pair: [usize; 2],
        joint_box: &[[ScalarOf<S>; 2]],
        target_distance: ScalarOf<S>,
        max_boxes: usize,
        mut observer: impl FnMut(FreeBox<'_, S::Vector>),
    ) -> Result<JointBox<ScalarOf<S>>, LinkageError> {
        let target = self.check_box(joint_box, target_distance)?;
        let route = self.skeleton.between(pair).ok_or(LinkageError::Pair { pair: 0 })?;
        let [a, b] = pair.map(|link| &self.bodies[link]);
        let pairs = (0..a.len()).flat_map(|i| (0..b.len()).map(move |k| [i, k]));
        let look = |[i, k]: [usize; 2], part: &_| look(&route, target, &a[i], &Body::Convex(&b[k]), part);
        Ok(search(pairs, joint_box, max_boxes, look, &mut observer))
    }

    /// Whether any body of a link is ever as near as the target distance to a body of a scene at rest, or those of the
    /// [pairs](Self::with_pairs) to one another, where each joint value may be anywhere in an interval. It is one
    /// search for all of them, as that of [`joint_box`](Self::joint_box): it gives up after `max_boxes` parts of the
    /// box, counted for each two bodies, but looks at least once at each two.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, Rounded, Segment, glam::DVec2};
    /// use gjk_raycast::{HalfSpace, Joint, JointBoxOutcome, JointKind, Link, Linkage, Met, Pose, Scene};
    ///
    /// // A bar of length 1 turns about the origin. There are a wall at x = −0.5 and a ball at 45°.
    /// let bar = Rounded::new(Segment::new([DVec2::ZERO, DVec2::X])?, 0.05)?;
    /// let joint = Joint { parent: None, pose: Pose::default(), kind: JointKind::Revolute(1.0) };
    /// let arm = Linkage::new([joint], [Link { joint: Some(0), bodies: vec![bar] }])?;
    /// let mut scene = Scene::new([Posed::translated(Ball::new(0.1)?, DVec2::splat(0.5))?])?;
    /// scene.insert_half_space(HalfSpace::new(DVec2::X, -0.5)?);
    /// let ask = |low: f64, high: f64| {
    ///     arm.joint_box_among(&scene, &[[low.to_radians(), high.to_radians()]], 0.0, 1000)
    /// };
    ///
    /// // The bar touches the ball at 45° − 12.2° = 32.8°, and the wall at −116.7°, where −cos is (0.5 − 0.05)/1.
    /// assert_eq!(ask(-116.0, 32.0)?.outcome, JointBoxOutcome::Never);
    /// let JointBoxOutcome::Meets { bodies, .. } = ask(-117.0, 32.0)?.outcome else { return Err("the wall".into()) };
    /// assert_eq!(bodies.met, Met::Obstacle(1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`joint_box`](Self::joint_box).
    pub fn joint_box_among<O: SupportMap<Vector = S::Vector>>(
        &self,
        scene: &Scene<O>,
        joint_box: &[[ScalarOf<S>; 2]],
        target_distance: ScalarOf<S>,
        max_boxes: usize,
    ) -> Result<JointBox<ScalarOf<S>, BodyPair>, LinkageError> {
        self.joint_box_among_with(scene, joint_box, target_distance, max_boxes, |_| {})
    }

    /// [`joint_box_among`](Self::joint_box_among) with an observer, as that of
    /// [`joint_box_with`](Self::joint_box_with).
    ///
    /// # Errors
    /// Those of [`joint_box`](Self::joint_box).
    pub fn joint_box_among_with<O: SupportMap<Vector = S::Vector>>(
        &self,
        scene: &Scene<O>,
        joint_box: &[[ScalarOf<S>; 2]],
        target_distance: ScalarOf<S>,
        max_boxes: usize,
        mut observer: impl FnMut(FreeBox<'_, S::Vector, BodyPair>),
    ) -> Result<JointBox<ScalarOf<S>, BodyPair>, LinkageError> {
        let among = LinkageAmong { linkage: self, scene, target: self.check_box(joint_box, target_distance)? };
        Ok(search(among.pairs(), joint_box, max_boxes, |pair, part: &_| among.look(pair, part), &mut observer))
    }

    /// The target distance of the search, if it and the box are valid.
    pub(super) fn check_box(
        &self,
        joint_box: &[[ScalarOf<S>; 2]],
        target_distance: ScalarOf<S>,
    ) -> Result<ScalarOf<S>, LinkageError> {
        check_limits(Scalar::ZERO, target_distance)?;
        for end in [0, 1] {
            self.check(0, &joint_box.iter().map(|interval| interval[end]).collect::<Vec<_>>())?;
        }
        match joint_box.iter().position(|[low, high]| low > high) {
            Some(value) => Err(LinkageError::Interval { value }),
            None => Ok(target_distance.max(Scalar::ZERO)),
        }
    }
}

/// A linkage among the bodies of a scene at rest.
pub(super) struct LinkageAmong<'l, S: SupportMap, O: SupportMap> {
    pub(super) linkage: &'l Linkage<S>,
    pub(super) scene: &'l Scene<O>,
    pub(super) target: ScalarOf<S>,
}

impl<'l, S: SupportMap, O: SupportMap<Vector = S::Vector>> LinkageAmong<'l, S, O> {
    /// All pairs of bodies that are asked about.
    pub(super) fn pairs(&self) -> impl Iterator<Item = BodyPair> + 'l {
        let members = self.scene.instances().flat_map(|(obstacle, instance)| {
            (0..instance.group().len()).map(move |member| Met::Member { obstacle, member })
        });
        let at_rest: Vec<_> = self.scene.iter().map(|(obstacle, _)| Met::Obstacle(obstacle)).chain(members).collect();
        let linkage = self.linkage;
        linkage.skeleton.views.iter().flat_map(move |view| {
            let of_link =
                |link: usize| (0..linkage.bodies[link].len()).map(move |body| Met::Link { link, body }).collect();
            let others: Vec<_> = view.base.map_or_else(|| at_rest.clone(), of_link);
            let each = move |body| others.clone().into_iter().map(move |met| BodyPair { link: view.link, body, met });
            (0..linkage.bodies[view.link].len()).flat_map(each)
        })
    }

    /// The first body as the second sees it.
    fn view(&self, BodyPair { link, met, .. }: BodyPair) -> Option<&'l LinkView<S::Vector>> {
        let base = if let Met::Link { link, .. } = met { Some(link) } else { None };
        self.linkage.skeleton.views.iter().find(|view| view.link == link && view.base == base)
    }

    /// Whether the joint of a value moves the bodies of a pair against one another.
    pub(super) fn moves(&self, pair: BodyPair, column: usize) -> bool {
        self.view(pair).is_none_or(|view| view.route.stages.iter().any(|stage| stage.column == column))
    }

    /// Tests a pair in a part of the box.
    pub(super) fn look(&self, pair: BodyPair, part: &[[ScalarOf<S>; 2]]) -> BoxState<S::Vector> {
        let Self { linkage, scene, target } = self;
        let shape = &linkage.bodies[pair.link][pair.body];
        let known = self.view(pair).and_then(|view| match pair.met {
            Met::Obstacle(obstacle) => Some(look(&view.route, *target, shape, scene.get(obstacle)?, part)),
            Met::Member { obstacle, member } => {
                let member = Body::Convex(scene.member(obstacle, member)?);
                Some(look(&view.route, *target, shape, &member, part))
            }
            Met::Link { link, body } => {
                Some(look(&view.route, *target, shape, &Body::Convex(&linkage.bodies[link][body]), part))
            }
        });
        // All of these exist; nothing would be known of one that does not.
        known.unwrap_or(BoxState::Open { after: Scalar::ZERO, column: None })
    }
}

/// The search for all of these pairs of bodies, by what is known of one of them in a part of the box.
fn search<V: Vector, P: Copy>(
    pairs: impl Iterator<Item = P>,
    joint_box: &[[V::Scalar; 2]],
    max_boxes: usize,
    look: impl Fn(P, &[[V::Scalar; 2]]) -> BoxState<V>,
    observer: &mut impl FnMut(FreeBox<'_, V, P>),
) -> JointBox<V::Scalar, P> {
    let whole = |bodies| BoxPart { bodies, joint_box: joint_box.to_vec(), share: V::Scalar::ONE };
    let mut next: Vec<_> = pairs.map(whole).collect();
    // The parts that are undecided, and their indices in the two orders.
    let (mut open, mut orders) = (Vec::new(), [const { BinaryHeap::new() }; 2]);
    let (mut boxes, mut share) = (0, V::Scalar::ZERO);
    for turn in 1_usize.. {
        for part in next.drain(..) {
            boxes += 1;
            let BoxPart { bodies, ref joint_box, .. } = part;
            match look(bodies, joint_box) {
                BoxState::Free { normal } => observer(FreeBox { bodies, joint_box, normal }),
                BoxState::Meets => {
                    let values = joint_box.iter().map(|&interval| middle(interval)).collect();
                    return JointBox { outcome: JointBoxOutcome::Meets { values, bodies }, boxes };
                }
                BoxState::Open { after, column: Some(column) } => {
                    for (order, after) in orders.iter_mut().zip([after, -part.share]) {
                        order.push(Reverse((in_order(after), open.len())));
                    }
                    open.push(Some((part, column)));
                }
                // If no joint moves the bodies against one another, there is nothing to halve.
                BoxState::Open { column: None, .. } => share += part.share,
            }
        }
        if boxes >= max_boxes {
            break;
        }
        let order = &mut orders[usize::from(turn % LARGEST_EVERY == 0)];
        let first = core::iter::from_fn(|| order.pop()).find_map(|Reverse((_, index))| open[index].take());
        let Some((part, column)) = first else { break };
        next.extend(part.halves(column));
    }
    let share = open.iter().flatten().fold(share, |sum, (part, _)| sum + part.share).min(Scalar::ONE);
    let is_never = share == Scalar::ZERO;
    let outcome = if is_never { JointBoxOutcome::Never } else { JointBoxOutcome::Undecided { share } };
    JointBox { outcome, boxes }
}

/// A part of the box for two bodies.
struct BoxPart<S, P> {
    bodies: P,
    joint_box: Vec<[S; 2]>,
    share: S,
}

/// What is known of a part.
pub(super) enum BoxState<V: Vector> {
    /// A plane across this normal separates the bodies at all of its joint values.
    Free {
        normal: V,
    },
    Meets,
    /// Neither is known. Of several such parts the one with the least `after` is to be halved first, along the joint
    /// value of this column; `None` if no joint moves the bodies.
    Open {
        after: V::Scalar,
        column: Option<usize>,
    },
}

/// Tests two bodies in a part of the box, given the route from the frame of the second to the link of the first.
fn look<V: Vector, S: SupportMap<Vector = V>, O: SupportMap<Vector = V>>(
    route: &Route<V>,
    target: V::Scalar,
    a: &S,
    b: &Body<O>,
    joint_box: &[[V::Scalar; 2]],
) -> BoxState<V> {
    let Route { stages, tail } = route;
    let (zero, one, two) = (V::Scalar::ZERO, V::Scalar::ONE, V::Scalar::from_f64(2.0));
    let half = |column: usize| {
        let [low, high] = joint_box[column];
        let at = middle([low, high]);
        raised((high - at).max(at - low))
    };
    let Core { origin, extent, radius, .. } = a.core();
    let reach = raised(tail.of(origin).norm() + extent + radius + tail.error_of(origin.norm() + extent));
    let size_of = |core: Core<V>| core.origin.norm() + core.extent + core.radius;
    let size_a = size_of(a.core());
    // The farthest point of a half-space along its normal is any of its plane.
    let (size_b, error_b) = match b {
        Body::Convex(b) => (size_of(b.core()), b.core().error),
        Body::HalfSpace(b) => (b.offset().abs() / b.length, zero),
    };
    let (frame, axes) = at_middle(route, joint_box);
    let Ok(a) = Posed::from_matrix(a, frame.rotation, frame.translation) else {
        // The place is not finite, and no more will be known after halving.
        return BoxState::Open { after: zero, column: stages.first().map(|stage| stage.column) };
    };
    let answer = b.signed_distance(&a, SignedDistanceOptions::new());
    // `Posed` makes the matrix orthonormal, which changes it by no more than its error. So the error counts twice.
    let error = raised(frame.error_of(reach) * two);
    if answer.upper + error <= target {
        return BoxState::Meets;
    }
    let n = answer.normal;
    let highest = match b {
        Body::Convex(b) => support_value(b, n),
        Body::HalfSpace(b) => b.offset() / b.length,
    };
    let (mut changes, mut level) = (SmallVec::<[(V, V::Scalar); 8]>::new(), -highest);
    let (mut turned, mut size) = (one, reach + size_a + size_b + frame.translation.norm());
    for (stage, &[axis, origin]) in stages.iter().zip(&axes) {
        let half = half(stage.column);
        if stage.turns() {
            let change = angular::turning(-axis, n) * half;
            changes.push((change, change.dot(origin)));
            turned += half;
            size += origin.norm();
        } else {
            level -= (n.dot(axis) * half).abs();
        }
    }
    level += least_height(&|direction: V| -support_value(&a, -direction), n, &changes);
    let bent_by = |half: &dyn Fn(usize) -> V::Scalar| {
        let bounds = route.bounds(|column| {
            let [low, high] = joint_box[column];
            JointBounds { value: low.abs().max(high.abs()), ..JointBounds::constant(half(column)) }
        });
        bounds.acceleration.of(reach) / two
    };
    let bent = bent_by(&half);
    let shapes = a.core().error + error_b;
    // The directions of the support values are as long as 1 plus the angles by which the joints turn.
    let lost = (error + shapes + epsilons::<V::Scalar>(64.0) * size) * turned + bent * epsilons(64.0);
    if level - bent - raised(lost) > target {
        return BoxState::Free { normal: n };
    }
    // What halving one interval saves of both terms for the nearest point: its speed, and the bound on the
    // acceleration.
    let gain = |(stage, axis): (&JointStage<V>, &[V; 2])| {
        let halved = |column| half(column) / if column == stage.column { two } else { one };
        let first = half(stage.column) * stage.rise(*axis, n, answer.point_a).abs() / two;
        (first + bent - bent_by(&halved), stage.column)
    };
    let by_gain = |a: &(V::Scalar, usize), b: &(V::Scalar, usize)| a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal);
    let best = stages.iter().zip(&axes).map(gain).max_by(by_gain).filter(|(gain, _)| *gain > zero);
    let (gap, sinks) = (answer.signed_distance - target, answer.signed_distance - (level - bent));
    let part = gap / sinks;
    BoxState::Open { after: gap * part * part * part, column: best.map(|(_, column)| column) }
}

/// The frame of the link in the middle of a part, and the axis of each joint on the route, with its origin.
fn at_middle<V: Vector>(
    Route { stages, tail }: &Route<V>,
    joint_box: &[[V::Scalar; 2]],
) -> (LinkFrame<V>, SmallVec<[[V; 2]; 8]>) {
    let zero = V::Scalar::ZERO;
    let (mut moving, mut axes) = (MovingFrame::WORLD, SmallVec::new());
    for stage in stages {
        let value = middle(joint_box[stage.column]);
        moving = moving.beyond(stage, JointState { value, rate: zero, acceleration: zero, error: zero });
        axes.push(stage.placed(&moving.frame));
    }
    (moving.frame.then(tail), axes)
}

/// A lower bound of `n·x − Σ |change·x − offset|` over all points `x` of a body, where `height` is the body's least
/// height along a direction. It is the least over all signs of the products. If there are many, each one beyond
/// [`MAX_SIGNS`] counts with its own greatest value, which is less tight.
fn least_height<V: Vector>(height: &impl Fn(V) -> V::Scalar, n: V, changes: &[(V, V::Scalar)]) -> V::Scalar {
    let [rest @ .., (change, offset)] = changes else { return height(n) };
    if changes.len() > MAX_SIGNS {
        let farthest = Float::max(*offset - height(*change), -height(-*change) - *offset);
        return least_height(height, n, rest) - farthest;
    }
    let up = least_height(height, n - *change, rest) + *offset;
    let down = least_height(height, n + *change, rest) - *offset;
    Float::min(up, down)
}

impl<S: Scalar, P: Copy> BoxPart<S, P> {
    /// Both halves of the part along one joint value.
    fn halves(mut self, column: usize) -> [Self; 2] {
        let [low, high] = self.joint_box[column];
        let at = middle([low, high]);
        self.share *= S::from_f64(0.5);
        [[low, at], [at, high]].map(|interval| {
            let mut joint_box = self.joint_box.clone();
            joint_box[column] = interval;
            Self { joint_box, ..self }
        })
    }
}

pub(super) fn middle<S: Scalar>([low, high]: [S; 2]) -> S {
    low * S::from_f64(0.5) + high * S::from_f64(0.5)
}

/// An integer in place of a number, in the same order.
fn in_order<S: Scalar>(number: S) -> i64 {
    let bits = number.as_f64().to_bits() as i64;
    bits ^ ((bits >> 63) & i64::MAX)
}
