//! The least margin of many links about many obstacles.

mod brute_force;
mod frame;
mod least;
mod result;
mod search;
mod seen;

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{Bvh, Ellipsoid, Scalar, Vector};

pub use self::brute_force::clearance;
use self::frame::{LinkFrame, around, displacement, radius};
use self::least::{Least, Limit};
pub use self::result::{ClearanceResult, LeftOut, NearPair};
use self::search::{Count, Normals, Search};
use self::seen::Seen;
use crate::{Answer, EllipsoidPair, InvalidQuery, Margin, MarginOptions, free_margin};

/// A scene of obstacles that finds the least margin of a robot's links along a motion, without computing most pairs.
///
/// The obstacles lie in a tree of boxes, which is adjusted when they [move](Self::move_obstacles). For each link,
/// groups of obstacles are left out if their box is farther than the least margin so far, in the norm in which the
/// link is the unit ball. So are obstacles whose ball is too far away, and those beyond a plane across the line of
/// centres, or across the normal at which the two were nearest when last solved. A link that has moved little is left
/// out altogether, since √(1 + m) changes by no more than the link's motion in its own norm. The remaining pairs are
/// solved as by [`free_margin`], so that the result is that of [`clearance`], to the last bit.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{Clearance, MarginOptions};
///
/// let obstacles: Vec<_> = (0..1000)
///     .map(|i| {
///         let center =
///             DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)) * 2.0;
///         Ellipsoid::new(center, DVec3::new(0.3, 0.2, 0.1), Default::default())
///     })
///     .collect::<Result<_, _>>()?;
/// let mut scene = Clearance::new(&obstacles, MarginOptions::default())?;
/// let link =
///     Ellipsoid::new(DVec3::new(5.1, 3.0, 3.0), DVec3::new(0.5, 0.1, 0.1), Default::default())?;
/// let nearest = scene.step(&[link])?;
/// assert!(nearest.margin.margin > 0.0 && nearest.pairs_evaluated < 20);
/// assert_eq!(nearest.pairs_evaluated + nearest.left_out.total(), 1000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(alias("robot_clearance", "minimum_distance"))]
#[derive(Clone, Debug)]
pub struct Clearance<V: Vector> {
    options: MarginOptions,
    obstacles: Vec<Ellipsoid<V>>,
    /// The greatest semi-axis of each obstacle.
    radii: Vec<f64>,
    tree: Bvh<V>,
    /// The farthest that any point of any obstacle can have moved in all calls of `move_obstacles`.
    drift: f64,
    links: Vec<Seen<V>>,
    /// The pair of the last result.
    last: Option<(usize, usize)>,
}

impl<V: Vector> Clearance<V> {
    /// The scene of the given obstacles.
    ///
    /// # Errors
    /// [`InvalidQuery::NoObstacles`] if the list is empty.
    pub fn new(obstacles: &[Ellipsoid<V>], options: MarginOptions) -> Result<Self, InvalidQuery> {
        if obstacles.is_empty() {
            return Err(InvalidQuery::NoObstacles);
        }
        let boxes: Vec<_> = obstacles.iter().map(around).collect();
        Ok(Self {
            options,
            obstacles: obstacles.to_vec(),
            radii: obstacles.iter().map(radius).collect(),
            tree: Bvh::new(&boxes),
            drift: 0.0,
            links: Vec::new(),
            last: None,
        })
    }

    /// The obstacles in their present places.
    #[must_use]
    pub fn obstacles(&self) -> &[Ellipsoid<V>] {
        &self.obstacles
    }

    /// Replaces the obstacles by the same ones moved, in time linear in their number.
    ///
    /// # Errors
    /// [`InvalidQuery::CountChanged`] if there are more or fewer of them than before.
    pub fn move_obstacles(&mut self, obstacles: &[Ellipsoid<V>]) -> Result<(), InvalidQuery> {
        let (before, now) = (self.obstacles.len(), obstacles.len());
        if before != now {
            return Err(InvalidQuery::CountChanged { list: "obstacles", before, now });
        }
        let moved = self.obstacles.iter().zip(obstacles).map(|(a, b)| displacement(a, b));
        self.drift += moved.fold(0.0, f64::max);
        self.obstacles.copy_from_slice(obstacles);
        self.radii.clear();
        self.radii.extend(obstacles.iter().map(radius));
        self.tree.refit(|index| around(&obstacles[index]));
        Ok(())
    }

    /// The least margin, with the links in their present places. They may differ from those of the last step in any
    /// way. A link counts as the same one, moved, if it has the same index and semi-axes.
    ///
    /// # Errors
    /// [`InvalidQuery::NoLinks`] if the list is empty.
    pub fn step(&mut self, links: &[Ellipsoid<V>]) -> Result<ClearanceResult<V>, InvalidQuery> {
        let first = *links.first().ok_or(InvalidQuery::NoLinks)?;
        self.links.resize(links.len(), Seen { link: first, scale: 0.0, drift: self.drift, normals: Normals::NONE });
        let mut least = Least::default();
        let mut count = Count::default();
        // The nearest pair of the last step is likely to be near still: it is solved first.
        let seed = self.last.filter(|&(link, _)| link < links.len());
        if let Some((link, obstacle)) = seed {
            least.take(free_margin(&links[link], &self.obstacles[obstacle], self.options), link, obstacle);
            count.solved += 1;
        }
        for (index, link) in links.iter().enumerate() {
            let solved = seed.filter(|&(l, _)| l == index).map(|(_, obstacle)| obstacle);
            let seen = &mut self.links[index];
            if least.excludes(seen.bound_after(link, self.drift)) {
                count.left_out.by_motion += self.obstacles.len() - usize::from(solved.is_some());
                continue;
            }
            // The pairs solved already are as near as the least at most.
            let nearest = solved.map_or(f64::INFINITY, |_| least.scale());
            let frame = LinkFrame::new(link);
            let mut search = Search { frame: &frame, least, count, nearest, solved, normals: seen.normals };
            search.run(&self.tree, &self.obstacles, &self.radii, link, index, self.options);
            *seen = Seen { link: *link, scale: search.nearest, drift: self.drift, normals: search.normals };
            Search { least, count, .. } = search;
        }
        let Some((margin, link, obstacle)) = least.0 else { return Err(InvalidQuery::NoLinks) };
        self.last = Some((link, obstacle));
        Ok(ClearanceResult { margin, link, obstacle, pairs_evaluated: count.solved, left_out: count.left_out })
    }

    /// All pairs whose margin is at most `threshold`, by link, in no particular order within one.
    ///
    /// # Errors
    /// [`InvalidQuery::ThresholdNotANumber`] if `threshold` is not a number.
    pub fn within(&self, links: &[Ellipsoid<V>], threshold: V::Scalar) -> Result<Vec<NearPair<V>>, InvalidQuery> {
        let mut pairs = Vec::new();
        self.each_within(links, threshold, |pair, _| pairs.push(pair))?;
        Ok(pairs)
    }

    /// The same pairs as [`within`](Self::within), given to a closure one by one as they are found, each with an answer
    /// that has derivatives. Nothing is allocated.
    ///
    /// A planner can ask this about all links at all points of a trajectory at once: it gets a cost of each pair that
    /// is near, and the direction in which to move.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec2};
    /// use ellip_margin::{Clearance, MarginOptions};
    ///
    /// let obstacles =
    ///     [1.0, 2.0, 9.0].map(|x| Ellipsoid::new(DVec2::new(x, 3.0), DVec2::new(0.5, 1.0), 0.3));
    /// let obstacles = obstacles.into_iter().collect::<Result<Vec<_>, _>>()?;
    /// let scene = Clearance::new(&obstacles, MarginOptions::default())?;
    /// let links = [Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 1.0), 0.0)?];
    /// // A penalty (t − m)² for each margin m below t, and its gradient by the link's motion.
    /// let (threshold, mut cost, mut force) = (8.0, 0.0, DVec2::ZERO);
    /// scene.each_within(&links, threshold, |_, margin| {
    ///     let missing = threshold - margin.margin;
    ///     cost += missing * missing;
    ///     force -= 2.0 * missing * margin.gradient().translation;
    /// })?;
    /// assert!(cost > 0.0 && force.y > 0.0); // to move up would cost more
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidQuery::ThresholdNotANumber`] if `threshold` is not a number.
    pub fn each_within<'a>(
        &'a self,
        links: &'a [Ellipsoid<V>],
        threshold: V::Scalar,
        mut tell: impl FnMut(NearPair<V>, Answer<'a, V, Margin<V>>),
    ) -> Result<(), InvalidQuery> {
        if threshold.as_f64().is_nan() {
            return Err(InvalidQuery::ThresholdNotANumber);
        }
        let limit = Limit(threshold.as_f64(), V::Scalar::EPSILON.as_f64());
        for (index, link) in links.iter().enumerate() {
            let frame = LinkFrame::new(link);
            let _ = self.tree.within(&frame, V::Scalar::from_f64(limit.scale()), |obstacle| {
                let other = &self.obstacles[obstacle];
                if !limit.excludes(frame.plane_distance(other)) {
                    let answer = EllipsoidPair::new(link, other, self.options).margin();
                    if answer.margin <= threshold {
                        tell(NearPair { margin: *answer, link: index, obstacle }, answer);
                    }
                }
                ControlFlow::Continue(())
            });
        }
        Ok(())
    }
}
