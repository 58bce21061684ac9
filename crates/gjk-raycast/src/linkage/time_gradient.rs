//! How the time of a first contact changes with the waypoints.

use alloc::vec::Vec;

use convex_support::{Scalar, ScalarOf, SupportMap};

use super::link_motion::PathEdge;
use super::linkage::Linkage;
use super::result::{Met, PathContact};
use super::stage::Moving;

impl<S: SupportMap> Linkage<S> {
    /// The derivatives of the time of a first contact on this path by the joint values at both ends of its edge, for each
    /// joint that moves. `None` where links overlap as the path begins, or touch and do not approach one another.
    ///
    /// With `n` the normal and `p` the point of contact, joint `j` lifts the link off what it meets by `gⱼ = n·∂p/∂qⱼ`.
    /// The gap closes at the rate `−Σ gⱼ·q̇ⱼ`, so that the time changes by `Σ gⱼ·δqⱼ` over that, and a change of the value
    /// at the end of the edge changes that at the time `t` by a share of `t`, one at its beginning by `1 − t`.
    ///
    /// Where there is only one point of contact they are derivatives, and elsewhere one-sided derivatives.
    ///
    /// ```
    /// use convex_support::{Ball, glam::DVec2};
    /// use gjk_raycast::{HalfSpace, Joint, Link, Linkage, LinkageOptions, PathWorkspace, Pose, Scene};
    ///
    /// // A ball of radius 1 slides from x = 0 to 4, and meets a wall at x = 3 when half of that is done.
    /// let slide = Joint::prismatic(None, Pose::default(), DVec2::X);
    /// let robot = Linkage::new([slide], [Link { joint: Some(0), bodies: vec![Ball::new(1.0)?] }])?;
    /// let mut scene = Scene::<Ball<DVec2>>::default();
    /// scene.insert_half_space(HalfSpace::new(DVec2::NEG_X, -3.0)?);
    /// let ways = [[0.0], [4.0]];
    /// let path = robot.path(&ways, &scene, LinkageOptions::new(), &mut PathWorkspace::new())?;
    /// let contact = path.contact().ok_or("it meets the wall")?;
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
        let &PathContact { edge, time, link, met, point, normal, .. } = contact;
        let ends = [edge, edge + 1].map(|i| waypoints.get(i).map(AsRef::as_ref));
        let edge = PathEdge { from: ends[0]?, to: ends[1]? };
        self.check(0, edge.from).and(self.check(1, edge.to)).ok()?;
        let other = if let Met::Link { link, .. } = met { Some(link) } else { None };
        let (one, mut rises) = (ScalarOf::<S>::ONE, edge.from.iter().map(|_| Scalar::ZERO).collect::<Vec<_>>());
        for (link, sign) in [(Some(link), one), (other, -one)] {
            let mut moving = Moving::WORLD;
            let Some(link) = link else { continue };
            for stage in &self.skeleton.views.get(link)?.route.stages {
                moving = moving.beyond(stage, edge.at(stage.column, time));
                rises[stage.column] += stage.rise(stage.placed(&moving.frame), normal?, point) * sign;
            }
        }
        let rates = edge.to.iter().zip(edge.from).map(|(to, from)| *to - *from);
        let closing = rates.zip(&rises).fold(ScalarOf::<S>::ZERO, |sum, (rate, rise)| sum - rate * *rise);
        let by_values = |rise: ScalarOf<S>| [one - time, time].map(|share| rise / closing * share);
        (closing > Scalar::ZERO).then(|| rises.into_iter().map(by_values).collect())
    }
}
