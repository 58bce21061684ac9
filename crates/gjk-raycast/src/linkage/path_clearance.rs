//! The least distance of a linkage from anything along a path.
//!
//! Like [`path`](super::path), the search first finds the bodies that come near, and then asks for the least distance
//! of one pair after the other. A pair is near if it may come nearer than the target: the least distance found so far,
//! over bodies and edges, less the width of its bracket. Of all other pairs the search only proves that they stay
//! farther apart than that. The first target is the least distance at three times of the first edge.

use convex_support::{Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float;

use super::error::LinkageError;
use super::joint_trajectory::JointTrajectory;
use super::link_motion::{LinkMotion, PathEdge};
use super::path_answer::{Met, NearestOnPath, PathClearance};
use super::robot::{LinkView, Linkage};
use super::sweep::{Near, PathWorkspace, Sweep};
use crate::{
    Body, DistanceOptions, MotionCastOptions, MotionClearance, MotionClearanceOptions, Scene, Status, distance,
};

/// By how much more than the distance at one time counts as near at first, since it is rounded.
const NEAR_AT_FIRST: f64 = 1.0 + 1.0 / 1024.0;

impl<S: SupportMap> Linkage<S> {
    /// The least distance along a path of the linkage, of any body of a link from the bodies of a scene at rest, and of
    /// the [pairs](Self::with_pairs) of its own links: how near they come, when, which, and where.
    ///
    /// Waypoints and edges are those of [`path`](Self::path). If something meets, the distance is 0, and the time is
    /// that of the first contact, of which [`path`](Self::path) has a bracket; what comes after it is not looked at.
    ///
    /// The options are those of [`motion_clearance`](crate::motion_clearance()): `max_time` is a time of the path, each
    /// edge of which takes 1, and may be infinite; `max_iterations` counts for each body of a link and each body near
    /// it, and `axis` has no effect. The lower bound is proved for all times, bodies and pairs, and accounts for the
    /// rounding of the joints' poses.
    ///
    /// # Errors
    /// Those of [`path`](Self::path).
    pub fn path_clearance<O: SupportMap<Vector = S::Vector>, W: AsRef<[ScalarOf<S>]>>(
        &self,
        waypoints: &[W],
        scene: &Scene<O>,
        mut options: MotionClearanceOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
    ) -> Result<PathClearance<S::Vector>, LinkageError> {
        let last = self.check_waypoints(waypoints)?;
        if last == 0 {
            options.max_time = Scalar::ZERO;
        }
        let edge = |index: usize| PathEdge::between(waypoints, index);
        self.clearance_on(last.max(1), edge, scene, options, workspace)
    }

    /// [`path_clearance`](Self::path_clearance) along edges on which joint values change as the caller states, as in
    /// [`path_along`](Self::path_along).
    ///
    /// # Errors
    /// Those of [`path_along`](Self::path_along).
    pub fn path_clearance_along<O: SupportMap<Vector = S::Vector>, T: JointTrajectory<Scalar = ScalarOf<S>>>(
        &self,
        edges: &[T],
        scene: &Scene<O>,
        options: MotionClearanceOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
    ) -> Result<PathClearance<S::Vector>, LinkageError> {
        self.check_edges(edges)?;
        self.clearance_on(edges.len(), |index| &edges[index], scene, options, workspace)
    }

    fn clearance_on<O: SupportMap<Vector = S::Vector>, E: JointTrajectory<Scalar = ScalarOf<S>> + Copy>(
        &self,
        edges: usize,
        edge_at: impl Fn(usize) -> E,
        scene: &Scene<O>,
        options: MotionClearanceOptions<S::Vector>,
        workspace: &mut PathWorkspace<S::Vector>,
    ) -> Result<PathClearance<S::Vector>, LinkageError> {
        let (zero, number) = (ScalarOf::<S>::ZERO, ScalarOf::<S>::from_f64);
        let all = number(edges as f64);
        let end = if options.max_time > all { all } else { options.max_time };
        let options = options.with_max_time(end).checked()?;
        workspace.put_half_spaces(scene);
        let (mut answer, mut near_enough) = (PathClearance::NOTHING, ScalarOf::<S>::infinity());
        let edges = (0..edges).take_while(|&index| index == 0 || options.max_time > number(index as f64)).count();
        let (mut index, mut is_again) = (0, false);
        while index < edges {
            let (duration, edge) = (Float::min(options.max_time - number(index as f64), Scalar::ONE), edge_at(index));
            if answer.nearest.is_none() && !is_again {
                for time in [zero, duration * number(0.5), duration] {
                    let nearest = self.nearest_at(edge, time, scene, near_enough);
                    near_enough = Float::min(near_enough, nearest * number(NEAR_AT_FIRST));
                }
            }
            let (skeleton, tree, space) = (&self.skeleton, scene.tree(), &mut *workspace);
            let mut sweep = Sweep { skeleton, tree, edge, target: near_enough, space, end: duration, parts: 0 };
            sweep.run::<LinkageError>(&mut |near, motion, target| {
                if let Some(base) = self.skeleton.views[near.view].base {
                    let met = Met::Link { link: base, body: near.other };
                    let base = Body::Convex(&self.bodies[base][near.other]);
                    let next = self.clearance_of((index, met), near, &motion, &base, options, *target)?;
                    return Ok(answer.see(next, target, options.tolerance).unwrap_or(duration));
                }
                let obstacle = near.other;
                if let Some(body) = scene.get(obstacle) {
                    let met = Met::Obstacle(obstacle);
                    let next = self.clearance_of((index, met), near, &motion, body, options, *target)?;
                    return Ok(answer.see(next, target, options.tolerance).unwrap_or(duration));
                }
                let mut end = duration;
                if let Some(instance) = scene.instance(obstacle) {
                    let time = near.to - near.from;
                    let part = MotionCastOptions::new().with_max_time(time).with_target_distance(*target);
                    let way = target.is_finite().then_some((&motion, &part));
                    let shape = &self.bodies[self.skeleton.views[near.view].link][near.body];
                    instance.each_on_way(shape, way, |member, placed, _| {
                        let met = Met::Member { obstacle, member };
                        let next = self.clearance_of((index, met), near, &motion, placed, options, *target)?;
                        let at = answer.see(next, target, options.tolerance);
                        end = at.map_or(end, |at| Float::min(end, at));
                        Ok::<_, LinkageError>(())
                    })?;
                }
                Ok(end)
            })?;
            (near_enough, answer.parts) = (sweep.target, answer.parts + sweep.parts);
            if answer.nearest.is_some_and(|nearest| nearest.least.upper == zero) {
                break;
            }
            index += 1;
            // The distance at one time was rounded by more than that: now everything counts as near.
            if index == edges && answer.nearest.is_none() && !is_again {
                (near_enough, index, is_again) = (Float::infinity(), 0, true);
            }
        }
        answer.lower = near_enough;
        if let Some(nearest) = &mut answer.nearest {
            nearest.least.lower = near_enough;
        }
        Ok(answer)
    }

    /// The least distance of anything at a time of an edge, if it is less than a limit, to rounding.
    fn nearest_at<O: SupportMap<Vector = S::Vector>, E: JointTrajectory<Scalar = ScalarOf<S>> + Copy>(
        &self,
        edge: E,
        time: ScalarOf<S>,
        scene: &Scene<O>,
        limit: ScalarOf<S>,
    ) -> ScalarOf<S> {
        let mut least = limit;
        for LinkView { link, base, route } in &self.skeleton.views {
            let Some(pose) = route.place(edge, time).1.pose() else { continue };
            for shape in &self.bodies[*link] {
                let options = DistanceOptions::new().with_limit(least);
                let Ok(placed) = pose.with_shape(shape) else { continue };
                let nearest = match base {
                    None => scene.nearest(&placed, options).nearest.map(|nearest| nearest.distance.distance),
                    Some(base) => self.bodies[*base]
                        .iter()
                        .map(|other| distance(&placed, other, options).distance)
                        .min_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal)),
                };
                least = nearest.map_or(least, |nearest| Float::min(nearest, least));
            }
        }
        least
    }

    /// The least distance of a body of a link from a body that may come near it on an edge, if it is less than a limit.
    fn clearance_of<O: SupportMap<Vector = S::Vector>, E: JointTrajectory<Scalar = ScalarOf<S>> + Copy>(
        &self,
        (edge, met): (usize, Met),
        near: &Near<ScalarOf<S>>,
        motion: &LinkMotion<'_, S::Vector, E>,
        against: &Body<O>,
        options: MotionClearanceOptions<S::Vector>,
        limit: ScalarOf<S>,
    ) -> Result<Option<NearestOnPath<S::Vector>>, LinkageError> {
        let &Near { from, to, view, body, .. } = near;
        let LinkView { link, base, .. } = self.skeleton.views[view];
        let options = MotionClearanceOptions { axis: None, max_time: to - from, ..options };
        let least = against.clearance_within(&self.bodies[link][body], motion, options, limit)?;
        if least.upper == ScalarOf::<S>::infinity() && least.lower == limit {
            return Ok(None);
        }
        let time = from + least.time;
        let least = match base {
            None => MotionClearance { time, ..least },
            Some(base) => {
                // The points were found in the frame of the second link.
                let (_, frame) = self.skeleton.views[base].route.place(motion.edge, time);
                let [point_a, point_b] = [least.point_a, least.point_b].map(|point| frame.of(point));
                let normal = least.normal.map(|normal| frame.rotation * normal);
                MotionClearance { time, point_a, point_b, normal, ..least }
            }
        };
        Ok(Some(NearestOnPath { edge, link, body, met, least }))
    }
}

impl<V: Vector> PathClearance<V> {
    /// Counts the least distance of two bodies on an edge, where it may be less than the target, which it then becomes.
    /// Returns the time on the edge after which nothing matters: only an earlier contact can be the first.
    fn see(
        &mut self,
        next: Option<NearestOnPath<V>>,
        target: &mut V::Scalar,
        tolerance: V::Scalar,
    ) -> Option<V::Scalar> {
        self.casts += 1;
        let is_met = next.is_some_and(|next| next.least.upper == Scalar::ZERO);
        let next = next.filter(|next| is_met || next.least.lower < *target)?;
        *target = next.least.lower;
        match &mut self.nearest {
            // Rounding leaves open whether they come nearer.
            Some(known) if !is_met && next.least.upper >= known.least.upper => {
                let is_narrow = known.least.upper - *target <= tolerance * known.least.upper;
                known.least.status = if is_narrow { known.least.status } else { Status::Stalled };
            }
            nearest => *nearest = Some(next),
        }
        is_met.then_some(next.least.time)
    }
}
