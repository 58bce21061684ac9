//! One link among the obstacles: the nearest boxes first, and the cheapest bound that leaves an obstacle out.

use convex_support::{Ellipsoid, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::LeftOut;
use super::frame::{Frame, columns, padded};
use super::least::{Least, scale};
use crate::hierarchy::{Hierarchy, Node};
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

/// One link's way through the tree.
pub(super) struct Search<V: Vector> {
    pub(super) frame: Frame,
    pub(super) least: Least<V>,
    pub(super) count: Count,
    /// √(1 + m) is at least this for all pairs seen or left out so far.
    pub(super) nearest: f64,
    /// An obstacle that was solved before.
    pub(super) solved: Option<usize>,
    pub(super) normals: Normals,
}

impl<V: Vector> Search<V> {
    pub(super) fn run(
        &mut self,
        tree: &Hierarchy,
        obstacles: &[Ellipsoid<V>],
        radii: &[f64],
        link: &Ellipsoid<V>,
        index: usize,
        options: MarginOptions,
    ) {
        // Halves are equal: the depth is below 64 for any list that fits a memory, and each level leaves one node.
        let mut stack = [(0, 0.0); 64];
        let mut depth = 1;
        stack[0] = (0, self.frame.box_distance(tree.bounds(0)));
        while depth > 0 {
            depth -= 1;
            let (node, distance) = stack[depth];
            if self.least.excludes(distance / REACH) {
                self.nearest = self.nearest.min(distance);
                self.count.left_out.by_box += tree.count(node);
                continue;
            }
            match tree.node(node) {
                Node::Split(a, b) => {
                    let (x, y) = (self.frame.box_distance(tree.bounds(a)), self.frame.box_distance(tree.bounds(b)));
                    let (near, far) = if x <= y { ((a, x), (b, y)) } else { ((b, y), (a, x)) };
                    stack[depth] = far;
                    stack[depth + 1] = near;
                    depth += 2;
                }
                Node::Leaf(items) => {
                    for &obstacle in items {
                        if self.solved == Some(obstacle) {
                            self.solved = None;
                            continue;
                        }
                        if let Some((bound, reason)) = self.leave_out(&obstacles[obstacle], radii[obstacle], obstacle) {
                            self.nearest = self.nearest.min(bound);
                            *reason(&mut self.count.left_out) += 1;
                            continue;
                        }
                        let margin = free_margin(link, &obstacles[obstacle], options);
                        self.count.solved += 1;
                        self.nearest = self.nearest.min(scale(margin));
                        self.least.take(margin, index, obstacle);
                        self.normals.keep(obstacle, normal(&obstacles[obstacle], &margin));
                    }
                }
            }
        }
        // Not met again: it was counted with a box that was left out.
        self.count.left_out.by_box -= usize::from(self.solved.is_some());
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
    let norm = dot(z, z).sqrt();
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
