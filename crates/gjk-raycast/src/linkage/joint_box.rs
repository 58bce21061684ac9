//! Whether two links ever meet, at any positions of their joints.
//!
//! A box of joint values is proved to be free by one plane. All is seen in the frame of the second link. In the middle
//! of the box the plane across the unit vector `n` separates the two links. If each joint `j` changes by up to `δⱼ`, at
//! a constant rate within a unit of time, a point `x` of the first link comes nearer to the plane by no more than
//!
//! > Σ δⱼ·|mⱼ·(x − cⱼ)| + a/2,   mⱼ = n × axisⱼ,
//!
//! The sum is the largest `|n·ẋ|` in the middle, with `cⱼ` the joint's origin, and `a` bounds the acceleration at all
//! joint values. So the box is free if `n·x` less this amount stays above the plane for all points of the body. For
//! each choice of the signs of the products this least height is a support value. Each point counts with its own path:
//! one that is far from the plane may come much nearer.
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

use convex_support::numerics::bound::raised;
use convex_support::{Core, Posed, Scalar, ScalarOf, SupportMap, Vector, support_value};
use num_traits::Float;
use smallvec::SmallVec;

use super::error::LinkageError;
use super::frame::epsilons;
use super::joint::{JointStage, Moving};
use super::joint_trajectory::{JointBounds, JointState};
use super::link_motion::Route;
use super::path_answer::FreeBox;
use super::robot::Linkage;
use crate::axial;
use crate::outcome::check_limits;
use crate::{SignedDistanceOptions, signed_distance};

/// The number of joints whose signs are tried in all combinations. For each joint beyond these, the worst sign is taken
/// by itself.
const MAX_SIGNS: usize = 5;

/// One in this many parts that are halved is the largest part that is still undecided.
const LARGEST_EVERY: usize = 4;

/// The answer of [`Linkage::joint_box`].
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct JointBox<S> {
    /// Whether the links meet.
    pub outcome: JointBoxOutcome<S>,
    /// The number of parts of the box that were tested.
    pub boxes: usize,
}

/// Whether two links meet anywhere in a box of joint values.
#[derive(Clone, Debug, PartialEq)]
pub enum JointBoxOutcome<S> {
    /// They are farther apart than the target distance everywhere in the box. This is a proof.
    Never,
    /// They are certainly no farther apart than the target distance in a pose.
    Meets {
        /// The joint values of the pose.
        values: Vec<S>,
        /// The bodies of both links that meet.
        bodies: [usize; 2],
    },
    /// Neither is proved.
    Undecided {
        /// The share of the box that is not proved free.
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
        check_limits(Scalar::ZERO, target_distance)?;
        let target = target_distance.max(Scalar::ZERO);
        let route = self.skeleton.between(pair).ok_or(LinkageError::Pair { pair: 0 })?;
        for end in [0, 1] {
            self.check(0, &joint_box.iter().map(|interval| interval[end]).collect::<Vec<_>>())?;
        }
        if let Some(value) = joint_box.iter().position(|[low, high]| low > high) {
            return Err(LinkageError::Interval { value });
        }
        let bodies = pair.map(|link| &self.bodies[link]);
        let pairs = (0..bodies[0].len()).flat_map(|i| (0..bodies[1].len()).map(move |k| [i, k]));
        let whole = |bodies| BoxPart { bodies, joint_box: joint_box.to_vec(), share: ScalarOf::<S>::ONE };
        let mut next: Vec<_> = pairs.map(whole).collect();
        // The parts that are undecided, and their indices in the two orders.
        let (mut open, mut orders) = (Vec::new(), [const { BinaryHeap::new() }; 2]);
        let (mut boxes, mut share) = (0, ScalarOf::<S>::ZERO);
        for turn in 1_usize.. {
            for part in next.drain(..) {
                boxes += 1;
                let BoxPart { bodies: [i, k], ref joint_box, .. } = part;
                match look(&route, target, [&bodies[0][i], &bodies[1][k]], joint_box) {
                    BoxState::Free { normal } => observer(FreeBox { bodies: part.bodies, joint_box, normal }),
                    BoxState::Meets => {
                        let values = joint_box.iter().map(|&interval| middle(interval)).collect();
                        return Ok(JointBox { outcome: JointBoxOutcome::Meets { values, bodies: part.bodies }, boxes });
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
        Ok(JointBox { outcome, boxes })
    }
}

/// A part of the box for two bodies.
struct BoxPart<S> {
    bodies: [usize; 2],
    joint_box: Vec<[S; 2]>,
    share: S,
}

/// What is known of a part.
enum BoxState<V: Vector> {
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

/// Tests two bodies in a part of the box, given the route from the link of the second to that of the first.
fn look<V: Vector, S: SupportMap<Vector = V>>(
    route: &Route<V>,
    target: V::Scalar,
    [a, b]: [&S; 2],
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
    let sizes = [a.core(), b.core()].map(|core| core.origin.norm() + core.extent + core.radius);
    // The axis of each joint, and its origin.
    let (mut moving, mut axes) = (Moving::WORLD, SmallVec::<[[V; 2]; 8]>::new());
    for stage in stages {
        let value = middle(joint_box[stage.column]);
        moving = moving.beyond(stage, JointState { value, rate: zero, acceleration: zero, error: zero });
        axes.push(stage.placed(&moving.frame));
    }
    let frame = moving.frame.then(tail);
    let Ok(a) = Posed::from_matrix(a, frame.rotation, frame.translation) else {
        // The place is not finite, and no more will be known after halving.
        return BoxState::Open { after: zero, column: stages.first().map(|stage| stage.column) };
    };
    let answer = signed_distance(&a, b, SignedDistanceOptions::new());
    // `Posed` makes the matrix orthonormal, which changes it by no more than its error. So the error counts twice.
    let error = raised(frame.error_of(reach) * two);
    if answer.upper + error <= target {
        return BoxState::Meets;
    }
    let n = answer.normal;
    let (mut changes, mut level) = (SmallVec::<[(V, V::Scalar); 8]>::new(), -support_value(b, n));
    let (mut turned, mut size) = (one, reach + sizes[0] + sizes[1] + frame.translation.norm());
    for (stage, &[axis, origin]) in stages.iter().zip(&axes) {
        let half = half(stage.column);
        if stage.turns() {
            let change = axial::turning(-axis, n) * half;
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
    let shapes = a.core().error + b.core().error;
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

impl<S: Scalar> BoxPart<S> {
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

fn middle<S: Scalar>([low, high]: [S; 2]) -> S {
    low * S::from_f64(0.5) + high * S::from_f64(0.5)
}

/// An integer in place of a number, in the same order.
fn in_order<S: Scalar>(number: S) -> i64 {
    let bits = number.as_f64().to_bits() as i64;
    bits ^ ((bits >> 63) & i64::MAX)
}
