//! A free box of joint values that is grown around a configuration.
//!
//! The box is grown in two steps. First all joints grow together: each interval is the same part of that from the
//! joint's value to its limits, and the part is doubled as long as the box is proved to be free. Then each face is
//! moved by itself, all in turn, and only the slab that it adds has to be proved: what a face has gained it keeps. A
//! step that succeeds is doubled for the next turn, and one that does not is halved, until it is shorter than a small
//! part of the limits. What kept the shortest step from succeeding is what stopped the face.
//!
//! Each proof is that of [`joint_box`](super::joint_box), one plane for each pair of bodies. Each pair has a box of its
//! own, in which it is known to be free: it contains the common box, and is larger if one plane proves more. Most
//! bodies are far from most obstacles, so that a face is moved within the boxes of most pairs, which are not looked at
//! again. The pair that was in the way last is tried first.

use alloc::vec::Vec;

use convex_support::{Scalar, ScalarOf, SupportMap};
use num_traits::Float;

use super::error::LinkageError;
use super::joint_box::{BoxState, LinkageAmong, middle};
use super::path_answer::BodyPair;
use super::robot::Linkage;
use crate::Scene;

/// The box of all joints together is this part of the limits at first, or a quarter of it, and so on, that often.
const FIRST: f64 = 1.0 / 16.0;
const QUARTERINGS: usize = 10;
/// A face stops if its step is shorter than this part of the limits, or of its way from the joint's value.
const SHORTEST: f64 = 1.0 / 256.0;
const SHORT: f64 = 1.0 / 16.0;
/// The box of a pair is grown by that many steps, if one plane proves it.
const AHEAD: f64 = 4.0;

/// The answer of [`Linkage::grown_box`].
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct GrownBox<S> {
    /// The interval of each joint value. At all values in the box all bodies are farther apart than the target
    /// distance. This is a proof.
    pub joint_box: Vec<[S; 2]>,
    /// What stopped both ends of each interval.
    pub stops: Vec<[FaceStop<S>; 2]>,
    /// The number of parts of boxes that were tested.
    pub boxes: usize,
}

/// What stopped a face of a [`GrownBox`].
#[derive(Clone, Debug, PartialEq)]
pub enum FaceStop<S> {
    /// The limit of the joint, at which the face is.
    Limit,
    /// Two bodies, which are not proved to be apart a little beyond the face.
    Bodies {
        /// Which ones.
        bodies: BodyPair,
        /// Joint values beyond the face at which they are certainly no farther apart than the target distance, if some
        /// were found.
        values: Option<Vec<S>>,
    },
    /// The face may have been moved on: the number of parts of boxes was reached.
    Work,
}

impl<S: SupportMap> Linkage<S> {
    /// A box of joint values around a configuration, within limits, that is proved to be free: nowhere in it is a body
    /// of a link as near as the target distance to a body of the scene, nor those of the [pairs](Self::with_pairs) to
    /// one another. It is as large as the search can make it: [`joint_box_among`](Self::joint_box_among) proves a box
    /// that is given, and this finds one.
    ///
    /// All joints grow together, by factors of two, and then each end of each interval by itself, in turn, until one
    /// plane no more proves a sixteenth of its way more, or a 256th of the limits. So it is not the largest box that
    /// there is. The search ends after `max_boxes` parts of boxes; an arm of 59 balls at a shelf takes up to twenty
    /// thousand.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, Rounded, Segment, glam::DVec2};
    /// use gjk_raycast::{FaceStop, HalfSpace, Joint, JointKind, Link, Linkage, Met, Pose, Scene};
    ///
    /// // A bar of length 1 turns about the origin. There are a wall at x = −0.5 and a ball at 45°.
    /// let bar = Rounded::new(Segment::new([DVec2::ZERO, DVec2::X])?, 0.05)?;
    /// let joint = Joint { parent: None, pose: Pose::default(), kind: JointKind::Revolute(1.0) };
    /// let arm = Linkage::new([joint], [Link { joint: Some(0), bodies: vec![bar] }])?;
    /// let mut scene = Scene::new([Posed::translated(Ball::new(0.1)?, DVec2::splat(0.5))?])?;
    /// scene.insert_half_space(HalfSpace::new(DVec2::X, -0.5)?);
    ///
    /// let limits = [[-100f64.to_radians(), 180f64.to_radians()]];
    /// let grown = arm.grown_box(&[0.0], &scene, &limits, 0.0, 10_000)?;
    /// // The bar touches the ball at 45° − 12.2° = 32.8°.
    /// let [low, high] = grown.joint_box[0].map(f64::to_degrees);
    /// assert!((low + 100.0).abs() < 1e-12 && 30.0 < high && high < 32.8);
    /// assert_eq!(grown.stops[0][0], FaceStop::Limit);
    /// let FaceStop::Bodies { bodies, .. } = grown.stops[0][1] else { return Err("the ball".into()) };
    /// assert_eq!(bodies.met, Met::Obstacle(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`joint_box`](Self::joint_box), for the values and for the limits; and
    /// [`LinkageError::OutsideLimits`] and [`LinkageError::NotFree`].
    #[doc(alias("free_region", "iris", "certified_region", "configuration_space"))]
    pub fn grown_box<O: SupportMap<Vector = S::Vector>>(
        &self,
        values: &[ScalarOf<S>],
        scene: &Scene<O>,
        limits: &[[ScalarOf<S>; 2]],
        target_distance: ScalarOf<S>,
        max_boxes: usize,
    ) -> Result<GrownBox<ScalarOf<S>>, LinkageError> {
        let among = LinkageAmong { linkage: self, scene, target: self.check_box(limits, target_distance)? };
        self.check(0, values)?;
        let is_outside = |(value, [low, high]): (&ScalarOf<S>, &[ScalarOf<S>; 2])| value < low || high < value;
        if let Some(value) = values.iter().zip(limits).position(is_outside) {
            return Err(LinkageError::OutsideLimits { value });
        }
        let mut growth = Growth { among, values, limits, pairs: Vec::new(), boxes: 0, max_boxes };
        let part = growth.begin()?;
        let mut joint_box = growth.all_together(part);
        let stops = growth.face_by_face(&mut joint_box);
        Ok(GrownBox { joint_box, stops, boxes: growth.boxes })
    }
}

/// The state of the search.
struct Growth<'l, S: SupportMap, O: SupportMap> {
    among: LinkageAmong<'l, S, O>,
    values: &'l [ScalarOf<S>],
    limits: &'l [[ScalarOf<S>; 2]],
    /// The pairs of bodies, and a box within which each is known to be free.
    pairs: Vec<(BodyPair, Vec<[ScalarOf<S>; 2]>)>,
    boxes: usize,
    max_boxes: usize,
}

/// Two bodies that are not proved to be apart, and values at which they meet, if some were found.
struct InTheWay<S> {
    bodies: BodyPair,
    values: Option<Vec<S>>,
}

/// A face, and what is known of it.
struct GrowingFace<S> {
    step: S,
    stop: Option<FaceStop<S>>,
}

impl<S: SupportMap, O: SupportMap<Vector = S::Vector>> Growth<'_, S, O> {
    /// The box that is a part of the limits, seen from the values.
    fn around(&self, part: ScalarOf<S>) -> Vec<[ScalarOf<S>; 2]> {
        let interval = |(&at, &[low, high]): (&ScalarOf<S>, &[ScalarOf<S>; 2])| {
            if part < Scalar::ONE { [at - (at - low) * part, at + (high - at) * part] } else { [low, high] }
        };
        self.values.iter().zip(self.limits).map(interval).collect()
    }

    /// Finds for each pair the part of the limits within which one plane proves it to be free, and returns the least.
    /// It is zero where only the values themselves are known to be free.
    fn begin(&mut self) -> Result<ScalarOf<S>, LinkageError> {
        let (number, one) = (ScalarOf::<S>::from_f64, ScalarOf::<S>::ONE);
        let pairs: Vec<_> = self.among.pairs().collect();
        let parts = core::iter::successors(Some(FIRST), |part| Some(part * 0.25)).take(QUARTERINGS).map(number);
        let boxes: Vec<_> = parts.map(|part| (part, self.around(part))).collect();
        let above = [number(0.25), one].map(|part| (part, self.around(part)));
        let mut least = one;
        for pair in pairs {
            let mut is_free = |joint_box: &[_]| {
                self.boxes += 1;
                matches!(self.among.look(pair, joint_box), BoxState::Free { .. })
            };
            let mut part = boxes.iter().find(|(_, joint_box)| is_free(joint_box)).map(|(part, _)| *part);
            if part == Some(number(FIRST)) {
                let larger = above.iter().take_while(|(_, joint_box)| is_free(joint_box)).last();
                part = larger.map(|(part, _)| *part).or(part);
            } else if part.is_none() {
                let point: Vec<_> = self.values.iter().map(|value| [*value; 2]).collect();
                if !is_free(&point) {
                    return Err(LinkageError::NotFree { bodies: pair });
                }
            }
            let part = part.unwrap_or(Scalar::ZERO);
            let mut known = self.around(part);
            // Joints that do not move the two against one another may be anywhere.
            for (column, interval) in
                known.iter_mut().enumerate().filter(|(column, _)| !self.among.moves(pair, *column))
            {
                *interval = self.limits[column];
            }
            self.pairs.push((pair, known));
            least = Float::min(least, part);
        }
        Ok(least)
    }

    /// The largest box that is found if all joints grow together from a part of the limits.
    fn all_together(&mut self, mut part: ScalarOf<S>) -> Vec<[ScalarOf<S>; 2]> {
        let two = ScalarOf::<S>::from_f64(2.0);
        while part > Scalar::ZERO && part < Scalar::ONE {
            let larger = Float::min(part * two, Scalar::ONE);
            if self.prove(&self.around(larger), None).is_err() {
                break;
            }
            part = larger;
        }
        self.around(part)
    }

    /// Moves each face of a box in turn, and returns what stopped them.
    fn face_by_face(&mut self, joint_box: &mut [[ScalarOf<S>; 2]]) -> Vec<[FaceStop<ScalarOf<S>>; 2]> {
        let number = ScalarOf::<S>::from_f64;
        let shortest = |column: usize| (self.limits[column][1] - self.limits[column][0]) * number(SHORTEST);
        let face = |column: usize, end: usize| {
            let step = (joint_box[column][end] - self.values[column]).abs() * number(0.5);
            GrowingFace { step: Float::max(step, shortest(column)), stop: None }
        };
        let mut faces: Vec<_> = (0..joint_box.len()).map(|column| [0, 1].map(|end| face(column, end))).collect();
        let shortest: Vec<_> = (0..joint_box.len()).map(shortest).collect();
        while faces.iter().flatten().any(|face| face.stop.is_none()) {
            for (column, ends) in faces.iter_mut().enumerate() {
                for (end, face) in ends.iter_mut().enumerate().filter(|(_, face)| face.stop.is_none()) {
                    self.step(joint_box, (column, end), shortest[column], face);
                }
            }
        }
        let stop = |face: GrowingFace<_>| face.stop.unwrap_or(FaceStop::Work);
        faces.into_iter().map(|ends| ends.map(stop)).collect()
    }

    /// Moves one face of a box by one step, if it can: the next step is twice as long then, and half as long otherwise.
    /// A face stops for good where its step is no longer worth the work.
    fn step(
        &mut self,
        joint_box: &mut [[ScalarOf<S>; 2]],
        (column, end): (usize, usize),
        shortest: ScalarOf<S>,
        face: &mut GrowingFace<ScalarOf<S>>,
    ) {
        let number = ScalarOf::<S>::from_f64;
        let (from, limit) = (joint_box[column][end], self.limits[column][end]);
        if from == limit {
            face.stop = Some(FaceStop::Limit);
            return;
        }
        if self.boxes >= self.max_boxes {
            face.stop = Some(FaceStop::Work);
            return;
        }
        let to = if end == 0 { Float::max(from - face.step, limit) } else { Float::min(from + face.step, limit) };
        joint_box[column][end] = to;
        let Err(InTheWay { bodies, values }) = self.prove(joint_box, Some((column, end))) else {
            face.step *= number(2.0);
            return;
        };
        joint_box[column][end] = from;
        face.step = Float::min((to - from).abs(), face.step) * number(0.5);
        let short = (from - self.values[column]).abs() * number(SHORT);
        if face.step < Float::max(short, shortest) {
            face.stop = Some(FaceStop::Bodies { bodies, values });
        }
    }

    /// Proves that a box is free, of which one face may be new; or else what is in the way, and values at which it is
    /// met, if some were found.
    fn prove(
        &mut self,
        joint_box: &[[ScalarOf<S>; 2]],
        new: Option<(usize, usize)>,
    ) -> Result<(), InTheWay<ScalarOf<S>>> {
        for at in 0..self.pairs.len() {
            let (bodies, known) = &mut self.pairs[at];
            if known.iter().zip(joint_box).all(|(known, new)| known[0] <= new[0] && new[1] <= known[1]) {
                continue;
            }
            let mut part = joint_box.to_vec();
            if let Some((column, end)) = new {
                let (from, to, limit) = (known[column][end], joint_box[column][end], self.limits[column][end]);
                let slab = |to| if end == 0 { [to, from] } else { [from, to] };
                let ahead = from + (to - from) * Scalar::from_f64(AHEAD);
                let ahead = if end == 0 { Float::max(ahead, limit) } else { Float::min(ahead, limit) };
                self.boxes += 1;
                let before = core::mem::replace(&mut known[column], slab(ahead));
                let is_free = matches!(self.among.look(*bodies, known), BoxState::Free { .. });
                known[column] = before;
                if is_free {
                    known[column][end] = ahead;
                    continue;
                }
                part[column] = slab(to);
            }
            self.boxes += 1;
            let values = match self.among.look(*bodies, &part) {
                BoxState::Free { .. } => {
                    for (column, (known, new)) in known.iter_mut().zip(joint_box).enumerate() {
                        if self.among.moves(*bodies, column) {
                            *known = *new;
                        }
                    }
                    continue;
                }
                BoxState::Meets => Some(part.into_iter().map(middle).collect()),
                BoxState::Open { .. } => None,
            };
            let bodies = *bodies;
            // What was in the way will be so again.
            self.pairs[..=at].rotate_right(1);
            return Err(InTheWay { bodies, values });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use convex_support::glam::DVec2;
    use convex_support::{Ball, Posed, Rounded, Segment};

    use super::*;
    use crate::{HalfSpace, Joint, JointKind, Link, Met, Pose};

    type Bar = Rounded<Segment<DVec2>>;

    /// Bars of length 1, one after the other, the last of which may meet the first.
    fn arm(joints: usize) -> Linkage<Bar> {
        let bar = Rounded::new(Segment::new([DVec2::ZERO, DVec2::X]).expect("finite"), 0.05).expect("a radius");
        let at_end =
            |joint: usize| Pose { translation: if joint == 0 { DVec2::ZERO } else { DVec2::X }, rotation: 0.0 };
        let joint = |k: usize| Joint { parent: k.checked_sub(1), pose: at_end(k), kind: JointKind::Revolute(1.0) };
        let links = (0..joints).map(|joint| Link { joint: Some(joint), bodies: vec![bar] });
        let arm = Linkage::new((0..joints).map(joint), links).expect("a linkage");
        if joints > 2 { arm.with_pairs([[joints - 1, 0]]).expect("two links") } else { arm }
    }

    fn scene() -> Scene<Posed<Ball<DVec2>>> {
        let at = [DVec2::new(1.5, 1.0), DVec2::new(-0.8, 1.7), DVec2::new(0.4, -1.6)];
        let balls = at.map(|at| Posed::translated(Ball::new(0.2).expect("a radius"), at).expect("finite"));
        let mut scene = Scene::new(balls).expect("finite");
        scene.insert_half_space(HalfSpace::new(DVec2::Y, -2.2).expect("a normal"));
        scene
    }

    /// Around many values the box contains them, is within the limits, and is proved once more by the search for any
    /// box; each face is at the limit or names bodies, which meet at the values that it tells, beyond the face.
    #[test]
    fn a_grown_box_is_free_and_its_faces_say_why_they_stopped() {
        let (scene, mut grown, mut met, mut at_limit) = (scene(), 0, 0, 0);
        for k in 0..40_u32 {
            let robot = arm(1 + k as usize % 3);
            let mut seed = f64::from(k) * 0.37;
            let values: Vec<f64> = (0..robot.values())
                .map(|_| {
                    seed = (seed * 3.7 + 0.61).fract();
                    6.0 * seed - 3.0
                })
                .collect();
            let limits: Vec<_> = values.iter().map(|value| [value - 1.5, value + 0.7]).collect();
            let answer = match robot.grown_box(&values, &scene, &limits, 0.01, 100_000) {
                Ok(answer) => answer,
                Err(why) => {
                    assert!(matches!(why, LinkageError::NotFree { .. }), "{why}");
                    let space = &mut crate::ConfigurationWorkspace::new();
                    assert!(!robot.is_free(&values, &scene, 0.011, space).expect("values"), "{values:?}");
                    continue;
                }
            };
            grown += 1;
            let proof = robot.joint_box_among(&scene, &answer.joint_box, 0.01, 1_000_000).expect("a box");
            assert_eq!(proof.outcome, crate::JointBoxOutcome::Never, "{answer:?}");
            for (column, (&[low, high], stops)) in answer.joint_box.iter().zip(&answer.stops).enumerate() {
                let [from, to] = limits[column];
                assert!(from <= low && low < values[column] && values[column] < high && high <= to, "{answer:?}");
                for (stop, is_at_limit) in stops.iter().zip([low == from, high == to]) {
                    assert_eq!(*stop == FaceStop::Limit, is_at_limit, "{answer:?}");
                    assert_ne!(*stop, FaceStop::Work, "{answer:?}");
                    at_limit += u32::from(is_at_limit);
                    let FaceStop::Bodies { bodies, values: Some(values) } = stop else { continue };
                    assert!(values[column] < low || high < values[column], "{answer:?}");
                    let point: Vec<_> = values.iter().map(|value| [*value; 2]).collect();
                    let there = robot.joint_box_among(&scene, &point, 0.01, 1000).expect("a box");
                    assert!(matches!(there.outcome, crate::JointBoxOutcome::Meets { .. }), "{bodies:?} at {values:?}");
                    met += 1;
                }
            }
        }
        assert!(grown > 15 && at_limit > 10, "{grown} boxes, {met} meet, {at_limit} at limits");
    }

    #[test]
    fn one_joint_grows_to_what_is_in_the_way() {
        let (robot, scene) = (arm(1), scene());
        // Nothing is within reach of one bar.
        let free = robot.grown_box(&[0.0], &scene, &[[-9.0, 9.0]], 0.0, 10_000).expect("it is free");
        assert_eq!((&free.joint_box, &free.stops), (&vec![[-9.0, 9.0]], &vec![[FaceStop::Limit, FaceStop::Limit]]));
        // The end of the bar is as near as 0.2 + 0.05 + 0.5 to the ball at (1.5, 1) from some angle on.
        let near = robot.grown_box(&[-0.7], &scene, &[[-0.7, 9.0]], 0.75, 10_000).expect("it is free");
        let first = (0..10_000)
            .map(|k| -0.7 + f64::from(k) * 1e-4)
            .find(|angle| DVec2::from_angle(*angle).distance(DVec2::new(1.5, 1.0)) <= 1.0);
        let (high, first) = (near.joint_box[0][1], first.expect("an angle"));
        assert!(high < first && first - high < 0.2, "{high} {first}");
        let FaceStop::Bodies { bodies, .. } = &near.stops[0][1] else { panic!("{near:?}") };
        assert_eq!((bodies.link, bodies.body, bodies.met), (0, 0, Met::Obstacle(0)));
    }

    #[test]
    fn bad_input_is_refused_and_little_work_gives_a_small_box() {
        let (robot, scene) = (arm(2), scene());
        let limits = [[-1.0, 1.0]; 2];
        let ask = |values: &[f64], limits: &[[f64; 2]], target| robot.grown_box(values, &scene, limits, target, 10_000);
        assert_eq!(ask(&[0.0, 2.0], &limits, 0.0), Err(LinkageError::OutsideLimits { value: 1 }));
        assert!(matches!(ask(&[0.0], &limits, 0.0), Err(LinkageError::Count { .. })));
        assert!(matches!(ask(&[0.0, f64::NAN], &limits, 0.0), Err(LinkageError::Value { value: 1, .. })));
        assert!(matches!(ask(&[0.0; 2], &[[-1.0, 1.0], [1.0, -1.0]], 0.0), Err(LinkageError::Interval { value: 1 })));
        assert!(matches!(ask(&[0.0; 2], &[[-1.0, 1.0], [-1.0, f64::INFINITY]], 0.0), Err(LinkageError::Value { .. })));
        assert!(matches!(ask(&[0.0; 2], &limits, f64::NAN), Err(LinkageError::Option(_))));
        let Err(LinkageError::NotFree { bodies }) = ask(&[0.0; 2], &limits, 9.0) else { panic!("all is near") };
        let said = alloc::format!("{}", LinkageError::NotFree { bodies });
        assert!(said.contains("body 0 of link 0 is not certainly free of obstacle 0"), "{said}");
        let little = robot.grown_box(&[0.0; 2], &scene, &limits, 0.0, 1).expect("it is free");
        assert!(
            little.stops.iter().flatten().all(|stop| matches!(stop, FaceStop::Work | FaceStop::Limit)),
            "{little:?}"
        );
        // Limits that leave nothing to grow.
        let point = robot.grown_box(&[0.0; 2], &scene, &[[0.0; 2]; 2], 0.0, 1000).expect("it is free");
        assert_eq!(point.joint_box, vec![[0.0; 2]; 2]);
    }
}
