//! Whether two links ever meet, wherever their joints are.
//!
//! A box of joint values is free if one plane shows it. In the middle of the box let the plane across `n` separate the
//! first link's points `x` from the second link, in whose frame all is seen. If joint `j` changes by up to `δⱼ`, all at
//! constant rates within a unit of time, a point sinks towards the plane by no more than
//!
//! > Σ δⱼ·|mⱼ·(x − cⱼ)| + a/2,   mⱼ = n × axisⱼ,
//!
//! of which the first is `n·ẋ` in the middle, with `cⱼ` the joint's origin, and `a` bounds the acceleration whatever the
//! joint values. The least of `n·x` less that sum, over all points of the body, is a support value for each choice of
//! signs: no point is counted with more than its own way, and those far from the plane may sink far.
//!
//! A box that is not shown to be free is halved along the joint that moves the body the most, those with the nearest
//! middles first.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use core::cmp::Ordering;

use convex_support::numerics::bound::raised;
use convex_support::{Core, Posed, Scalar, ScalarOf, SupportMap, Vector, support_value};
use num_traits::Float;

use super::axial;
use super::bounds::Bounds;
use super::error::LinkageError;
use super::frame::epsilons;
use super::linkage::Linkage;
use super::moving::{Moving, Value};
use super::path::LinkageOptions;
use super::proof::FreeBox;
use super::route::Route;
use super::stage::{JointStage, StageMotion};
use crate::{SignedDistanceOptions, signed_distance};

/// Of more joints than this, the signs of each are chosen alone.
const MAX_SIGNS: usize = 5;

/// The answer of [`Linkage::joint_box`].
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct JointBox<S> {
    /// Whether the links meet.
    pub outcome: JointBoxOutcome<S>,
    /// The parts of the box that were looked at.
    pub boxes: usize,
}

/// Whether two links meet anywhere in a box of joint values.
#[derive(Clone, Debug, PartialEq)]
pub enum JointBoxOutcome<S> {
    /// They are farther apart than the target distance everywhere in the box. This is a proof.
    Never,
    /// They are as near as that, for certain.
    Meets {
        /// At these joint values.
        values: Vec<S>,
        /// The bodies of both that are.
        bodies: [usize; 2],
    },
    /// Neither is known.
    Undecided {
        /// The share of the box that is not known to be free.
        share: S,
    },
}

impl<S: SupportMap> Linkage<S> {
    /// Whether two links are ever as near one another as the target distance, where each joint value may be anywhere in
    /// an interval: the joint limits, for a robot's whole life.
    ///
    /// ```
    /// use convex_support::{Rounded, Segment, glam::DVec2};
    /// use gjk_raycast::{
    ///     Joint, JointBoxOutcome, JointKind, Link, Linkage, LinkageOptions, Pose,
    /// };
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
    /// let ask = |angle: f64| chain.joint_box([2, 0], &[[-angle, angle]; 2], LinkageOptions::new());
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
    pub fn joint_box(
        &self,
        pair: [usize; 2],
        joint_box: &[[ScalarOf<S>; 2]],
        options: LinkageOptions<S::Vector>,
    ) -> Result<JointBox<ScalarOf<S>>, LinkageError> {
        self.joint_box_with(pair, joint_box, options, |_| {})
    }

    /// [`joint_box`](Self::joint_box), showing an observer the parts of the box in which two bodies are proved to be
    /// apart. Where the answer is [`Never`](JointBoxOutcome::Never), they cover the box for each two bodies.
    ///
    /// # Errors
    /// As of [`joint_box`](Self::joint_box).
    pub fn joint_box_with(
        &self,
        pair: [usize; 2],
        joint_box: &[[ScalarOf<S>; 2]],
        options: LinkageOptions<S::Vector>,
        mut observer: impl FnMut(FreeBox<'_, S::Vector>),
    ) -> Result<JointBox<ScalarOf<S>>, LinkageError> {
        let target = options.checked()?.target_distance;
        let route = self.skeleton.between(pair).ok_or(LinkageError::Pair { pair: 0 })?;
        for end in [0, 1] {
            self.check(0, &joint_box.iter().map(|interval| interval[end]).collect::<Vec<_>>())?;
        }
        if let Some(value) = joint_box.iter().position(|[low, high]| low > high) {
            return Err(LinkageError::Interval { value });
        }
        let (mut boxes, mut open) = (0, Scalar::ZERO);
        let mut part_box = joint_box.to_vec();
        for (i, a) in self.bodies[pair[0]].iter().enumerate() {
            for (k, b) in self.bodies[pair[1]].iter().enumerate() {
                let mut search = BoxSearch::new(&route, [a, b], joint_box, target);
                let outcome = search.run(options.max_boxes.saturating_sub(boxes), |part, normal| {
                    for ((stage, &middle), &half) in route.stages.iter().zip(&part.middle).zip(&part.half) {
                        part_box[stage.column] = [middle - half, middle + half];
                    }
                    observer(FreeBox { bodies: [i, k], joint_box: &part_box, normal });
                });
                boxes += search.looked;
                match outcome {
                    JointBoxOutcome::Never => {}
                    JointBoxOutcome::Meets { values, .. } => {
                        let outcome = JointBoxOutcome::Meets { values, bodies: [i, k] };
                        return Ok(JointBox { outcome, boxes });
                    }
                    JointBoxOutcome::Undecided { share } => open = Float::min(open + share, Scalar::ONE),
                }
            }
        }
        let is_never = open == Scalar::ZERO;
        let outcome = if is_never { JointBoxOutcome::Never } else { JointBoxOutcome::Undecided { share: open } };
        Ok(JointBox { outcome, boxes })
    }
}

/// The search for where two bodies meet.
struct BoxSearch<'s, A: SupportMap> {
    route: &'s Route<A::Vector>,
    bodies: [&'s A; 2],
    /// The whole box.
    joint_box: &'s [[ScalarOf<A>; 2]],
    target: ScalarOf<A>,
    /// How far the first body's points are from the last joint's origin, and what they are computed with.
    reach: ScalarOf<A>,
    size: ScalarOf<A>,
    /// By how much a joint moves a point at most, per unit of its value.
    levers: Vec<ScalarOf<A>>,
    looked: usize,
}

/// A part of the box, by the joints on the way between the links.
struct BoxPart<S> {
    middle: Vec<S>,
    half: Vec<S>,
    share: S,
    /// The joint to halve.
    joint: usize,
}

/// What is known of a part.
enum BoxState<V: Vector> {
    /// A plane across this separates the bodies in all of it.
    Free {
        normal: V,
    },
    Meets,
    /// How far the bodies are apart in its middle, and which joint moves them the most.
    Open {
        distance: V::Scalar,
        joint: usize,
    },
}

impl<'s, A: SupportMap> BoxSearch<'s, A> {
    fn new(
        route: &'s Route<A::Vector>,
        bodies: [&'s A; 2],
        joint_box: &'s [[ScalarOf<A>; 2]],
        target: ScalarOf<A>,
    ) -> Self {
        let Core { origin, extent, radius, .. } = bodies[0].core();
        let error = route.tail.error_of(origin.norm() + extent);
        let reach = raised(route.tail.of(origin).norm() + extent + radius + error);
        let slide = |column: usize| Float::max(joint_box[column][0].abs(), joint_box[column][1].abs());
        let lever = |column| {
            let rate = |other| if other == column { Scalar::ONE } else { Scalar::ZERO };
            Bounds::of(route, rate, slide).speed.of(reach)
        };
        let levers = route.stages.iter().map(|stage| lever(stage.column)).collect();
        let size = bodies.iter().fold(reach, |size, body| {
            let Core { origin, extent, radius, .. } = body.core();
            size + origin.norm() + extent + radius
        });
        Self { route, bodies, joint_box, target, reach, size, levers, looked: 0 }
    }

    /// Looks at so many parts, or one more.
    fn run(
        &mut self,
        most: usize,
        mut show_free: impl FnMut(&BoxPart<ScalarOf<A>>, A::Vector),
    ) -> JointBoxOutcome<ScalarOf<A>> {
        let half = ScalarOf::<A>::from_f64(0.5);
        let interval = |stage: &JointStage<A::Vector>| self.joint_box[stage.column];
        let middle = |[low, high]: [ScalarOf<A>; 2]| low * half + high * half;
        // With room for the rounding of the middle, so that the parts cover the box.
        let width = |[low, high]: [ScalarOf<A>; 2]| {
            raised(high * half - low * half) + epsilons::<ScalarOf<A>>(1.0) * (low.abs() + high.abs())
        };
        let stages = &self.route.stages;
        let whole = BoxPart {
            middle: stages.iter().map(|stage| middle(interval(stage))).collect(),
            half: stages.iter().map(|stage| width(interval(stage))).collect(),
            share: Scalar::ONE,
            joint: 0,
        };
        // By how near the bodies are in the middle, and then in the order in which they were made.
        let (mut open, mut made, mut stuck) = (BTreeMap::new(), 0, ScalarOf::<A>::ZERO);
        let mut next = Some([Some(whole), None]);
        while let Some(parts) = next {
            for mut part in parts.into_iter().flatten() {
                self.looked += 1;
                match self.look(&part) {
                    BoxState::Free { normal } => show_free(&part, normal),
                    BoxState::Meets => return JointBoxOutcome::Meets { values: self.values(&part), bodies: [0, 0] },
                    // Where no joint moves them, nothing is left to halve.
                    BoxState::Open { .. } if stages.is_empty() => stuck = Scalar::ONE,
                    BoxState::Open { distance, joint } => {
                        part.joint = joint;
                        made += 1;
                        open.insert((in_order(distance), made), part);
                    }
                }
            }
            next = if self.looked < most { open.pop_first().map(|(_, part)| part.halves().map(Some)) } else { None };
        }
        let share = open.values().fold(stuck, |sum, part| sum + part.share);
        if share == Scalar::ZERO { JointBoxOutcome::Never } else { JointBoxOutcome::Undecided { share } }
    }

    /// The middle of a part as values of all joints: those that are not on the way may have any.
    fn values(&self, part: &BoxPart<ScalarOf<A>>) -> Vec<ScalarOf<A>> {
        let half = ScalarOf::<A>::from_f64(0.5);
        let mut values: Vec<_> = self.joint_box.iter().map(|[low, high]| *low * half + *high * half).collect();
        for (stage, &value) in self.route.stages.iter().zip(&part.middle) {
            values[stage.column] = value;
        }
        values
    }

    fn look(&self, part: &BoxPart<ScalarOf<A>>) -> BoxState<A::Vector> {
        let (zero, one) = (ScalarOf::<A>::ZERO, ScalarOf::<A>::ONE);
        let stages = &self.route.stages;
        let mut moving = Moving::WORLD;
        // The axis of each joint, and its origin.
        let mut axes = smallvec::SmallVec::<[(A::Vector, A::Vector); 8]>::new();
        for (stage, &value) in stages.iter().zip(&part.middle) {
            moving =
                moving.beyond(stage, Value { value, rate: zero, error: epsilons::<ScalarOf<A>>(1.0) * value.abs() });
            let axis = match stage.motion {
                StageMotion::Turn { axis, .. } => axial::turned(&moving.frame.rotation, axis),
                StageMotion::Slide { axis, .. } => moving.frame.rotation * axis,
            };
            axes.push((axis, moving.frame.translation));
        }
        let frame = moving.frame.then(&self.route.tail);
        let [a, b] = self.bodies;
        let Ok(a) = Posed::from_matrix(a, frame.rotation, frame.translation) else {
            // Numbers as large as that are not known any better at other joints.
            return BoxState::Open { distance: zero, joint: 0 };
        };
        let answer = signed_distance(&a, b, SignedDistanceOptions::new());
        // The matrix was made orthonormal, which moves it by no more than it was wrong.
        let error = raised(frame.error_of(self.reach) * Scalar::from_f64(2.0));
        if answer.upper + error <= self.target {
            return BoxState::Meets;
        }
        let n = answer.normal;
        let (mut changes, mut level) = (smallvec::SmallVec::<[(A::Vector, ScalarOf<A>); 8]>::new(), zero);
        let (mut turned, mut size) = (one, self.size + frame.translation.norm());
        for ((stage, &half), &(axis, origin)) in stages.iter().zip(&part.half).zip(&axes) {
            match stage.motion {
                StageMotion::Turn { .. } => {
                    let change = axial::turning(-axis, n) * half;
                    changes.push((change, change.dot(origin)));
                    turned += half;
                    size += origin.norm();
                }
                StageMotion::Slide { .. } => level -= (n.dot(axis) * half).abs(),
            }
        }
        let height = |direction: A::Vector| -support_value(&a, -direction);
        level += least_height(&height, n, &changes) - support_value(&b, n);
        let rate = |column: usize| {
            stages.iter().zip(&part.half).find(|(stage, _)| stage.column == column).map_or(zero, |(_, &half)| half)
        };
        let slide = |column: usize| Float::max(self.joint_box[column][0].abs(), self.joint_box[column][1].abs());
        let bent = Bounds::of(self.route, rate, slide).acceleration.of(self.reach) * Scalar::from_f64(0.5);
        let shapes = a.core().error + b.core().error;
        // Directions are longer than one by what the joints turn.
        let lost = (error + shapes + epsilons::<ScalarOf<A>>(64.0) * size) * turned + bent * epsilons(64.0);
        if level - bent - raised(lost) > self.target {
            return BoxState::Free { normal: n };
        }
        // What the joint adds to the way at first, and to what bends it.
        let way = |i: usize| {
            let (axis, origin) = axes[i];
            let half = part.half[i];
            let first = match stages[i].motion {
                StageMotion::Turn { .. } => axial::turning(-axis, n).dot(answer.point_a - origin).abs(),
                StageMotion::Slide { .. } => n.dot(axis).abs(),
            };
            half * (first + self.levers[i] * (turned - one) * Scalar::from_f64(0.5))
        };
        let by_way = |i: &usize, k: &usize| way(*i).partial_cmp(&way(*k)).unwrap_or(Ordering::Equal);
        let joint = (0..stages.len()).max_by(by_way).unwrap_or(0);
        BoxState::Open { distance: answer.signed_distance, joint }
    }
}

/// The least of `n·x − Σ |change·x − offset|` over the points of a body, from below, by how far it is along a direction
/// at least: the least over all signs of the changes, or where they are many the sum of the least of each.
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
    /// Both halves along its widest joint, which cover it.
    fn halves(self) -> [Self; 2] {
        let half = S::from_f64(0.5);
        [-S::ONE, S::ONE].map(|side| {
            let (mut middle, mut halves) = (self.middle.clone(), self.half.clone());
            // The sum is rounded.
            let quarter = halves[self.joint] * half;
            middle[self.joint] += side * quarter;
            halves[self.joint] = quarter + epsilons::<S>(1.0) * (middle[self.joint].abs() + quarter);
            Self { middle, half: halves, share: self.share * half, ..self }
        })
    }
}

/// A number as one that has the order of numbers.
fn in_order<S: Scalar>(number: S) -> i64 {
    let bits = number.as_f64().to_bits() as i64;
    bits ^ ((bits >> 63) & i64::MAX)
}
