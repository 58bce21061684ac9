//! One link among the obstacles: the nearest boxes first, and the cheapest bound that leaves an obstacle out.

use core::ops::ControlFlow;

use convex_support::numerics::elementary::sqrt;
use convex_support::{Bvh, Ellipsoid, Scalar, Vector};

use super::LeftOut;
use super::frame::{LinkFrame, columns, padded};
use super::least::{Least, scale};
use crate::numerics::dot;
use crate::{Margin, MarginOptions, free_margin};

/// A link's boxes are searched to this multiple of the least √(1 + m), although only the least is required: with the
/// bound so found the link can be left out for some steps to come.
const REACH: f64 = 1.5;

/// The numbers of pairs solved and left out.
#[derive(Default)]
pub(super) struct Count {
    pub(super) solved: usize,
    pub(super) left_out: LeftOut,
}

/// The search of the tree for one link.
pub(super) struct Search<'f, V: Vector> {
    pub(super) frame: &'f LinkFrame,
    pub(super) least: Least<V>,
    pub(super) count: Count,
    /// √(1 + m) is at least this for all pairs seen or left out so far.
    pub(super) nearest: f64,
    /// An obstacle that was solved before.
    pub(super) solved: Option<usize>,
    pub(super) normals: Normals,
}

impl<V: Vector> Search<'_, V> {
    pub(super) fn run(
        &mut self,
        tree: &Bvh<V>,
        obstacles: &[Ellipsoid<V>],
        radii: &[f64],
        link: &Ellipsoid<V>,
        index: usize,
        options: MarginOptions,
    ) {
        let reach = |least: &Least<V>| least.limit().scale() * REACH;
        let mut met = 0;
        let _ = tree.search(self.frame, V::Scalar::from_f64(reach(&self.least)), |obstacle, _| {
            met += 1;
            if self.solved == Some(obstacle) {
                self.solved = None;
            } else if let Some((bound, reason)) = self.leave_out(&obstacles[obstacle], radii[obstacle], obstacle) {
                self.nearest = self.nearest.min(bound);
                *reason(&mut self.count.left_out) += 1;
            } else {
                let margin = free_margin(link, &obstacles[obstacle], options);
                self.count.solved += 1;
                self.nearest = self.nearest.min(scale(margin));
                self.least.take(margin, index, obstacle);
                self.normals.keep(obstacle, normal(&obstacles[obstacle], &margin));
            }
            ControlFlow::Continue(V::Scalar::from_f64(reach(&self.least)))
        });
        if met < obstacles.len() {
            self.nearest = self.nearest.min(reach(&self.least));
        }
        // An obstacle solved before, and not reached again, counts as solved.
        self.count.left_out.by_box += obstacles.len() - met - usize::from(self.solved.is_some());
    }

    /// A bound on √(1 + m) that excludes the obstacle, and its reason: the cheapest that does.
    #[inline]
    fn leave_out(&self, obstacle: &Ellipsoid<V>, radius: f64, index: usize) -> Option<(f64, Reason)> {
        let sphere = self.frame.sphere_distance(obstacle, radius);
        if self.least.excludes(sphere) {
            return Some((sphere, |out| &mut out.by_sphere));
        }
        let plane = self.frame.plane_distance(obstacle);
        if self.least.excludes(plane) {
            return Some((plane, |out| &mut out.by_plane));
        }
        let normal = self.frame.normal_distance(obstacle, self.normals.of(index)?);
        self.least.excludes(normal).then_some((normal, |out| &mut out.by_normal))
    }
}

/// The count of a reason.
type Reason = fn(&mut LeftOut) -> &mut usize;

/// The unit normal from the link to the obstacle at x*, in space; zero where the centre of the link lies in the
/// obstacle.
fn normal<V: Vector>(obstacle: &Ellipsoid<V>, margin: &Margin<V>) -> [f64; 3] {
    let (axes, a, y) = (columns(obstacle.axes()), padded(obstacle.semi_axes()), padded(margin.ball_point));
    let z: [f64; 3] = core::array::from_fn(|i| (0..V::DIM).map(|k| -axes[k][i] * (y[k] / a[k])).sum());
    let norm = sqrt(dot(z, z));
    z.map(|x| x / norm)
}

/// The number of normals kept for each link: enough for the obstacles around it, not for all.
const NORMALS: usize = 8;

/// Obstacles recently solved with a link, and for each the unit normal from the link where it was nearest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normals([Option<(usize, [f64; 3])>; NORMALS]);

impl Normals {
    pub(super) const NONE: Self = Self([None; NORMALS]);

    fn of(&self, obstacle: usize) -> Option<[f64; 3]> {
        self.0.iter().flatten().find(|(of, _)| *of == obstacle).map(|(_, normal)| *normal)
    }

    /// Keeps a normal, in place of the same obstacle's or of the oldest.
    fn keep(&mut self, obstacle: usize, normal: [f64; 3]) {
        let place = self.0.iter().position(|kept| kept.is_none_or(|(of, _)| of == obstacle)).unwrap_or(NORMALS - 1);
        self.0[place] = Some((obstacle, normal));
        self.0[..=place].rotate_right(1);
    }
}
