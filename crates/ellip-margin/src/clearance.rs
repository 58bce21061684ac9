//! The least margin of many links about many obstacles.

use alloc::vec::Vec;

use convex_support::{Ellipsoid, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::hierarchy::{Aabb, Hierarchy, Node};
use crate::pair::{dot, sub};
use crate::{InvalidQuery, Margin, MarginOptions, free_margin};

/// The least margin over all pairs of a link and an obstacle, and what was left out to find it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct ClearanceResult<V: Vector> {
    /// The margin of the pair with the least one, E₁ being the link; among equal ones the first by link, then obstacle.
    pub margin: Margin<V>,
    /// The index of its link.
    pub link: usize,
    /// The index of its obstacle.
    pub obstacle: usize,
    /// How many pairs were solved.
    pub pairs_evaluated: usize,
    /// The pairs that were not, by the reason why they cannot be the least.
    pub left_out: LeftOut,
}

/// Pairs that needed no margin, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LeftOut {
    /// The link has moved too little since its margins were last bounded.
    pub by_motion: usize,
    /// A box around the obstacle, or around a group of them, is too far from the link in the norm of the link.
    pub by_box: usize,
    /// A plane across the line of centres separates the obstacle from the grown link.
    pub by_plane: usize,
}

/// A pair within a threshold; see [`Clearance::within`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NearPair<V: Vector> {
    /// The margin, E₁ being the link.
    pub margin: Margin<V>,
    /// The index of the link.
    pub link: usize,
    /// The index of the obstacle.
    pub obstacle: usize,
}

/// The least margin of any of `links` about any of `obstacles`, every pair solved: n·m margins.
///
/// The plain reference; [`Clearance`] gives the same for a fraction of the work.
///
/// # Errors
/// [`InvalidQuery`] if a list is empty.
pub fn clearance<V: Vector>(
    links: &[Ellipsoid<V>],
    obstacles: &[Ellipsoid<V>],
    options: MarginOptions,
) -> Result<ClearanceResult<V>, InvalidQuery> {
    if obstacles.is_empty() {
        return Err(InvalidQuery::NoObstacles);
    }
    let mut least = Least::default();
    for (link, e1) in links.iter().enumerate() {
        for (obstacle, e2) in obstacles.iter().enumerate() {
            least.take(free_margin(e1, e2, options), link, obstacle);
        }
    }
    let (margin, link, obstacle) = least.0.ok_or(InvalidQuery::NoLinks)?;
    let pairs_evaluated = links.len() * obstacles.len();
    Ok(ClearanceResult { margin, link, obstacle, pairs_evaluated, left_out: LeftOut::default() })
}

/// The least margin of a robot's links about obstacles along a motion, without looking at most pairs.
///
/// The obstacles lie in a tree of boxes, which follows when they [move](Self::move_obstacles). Per link, groups of them
/// are left out whose box is farther, in the norm in which the link is the unit ball, than the least margin so far; so are
/// obstacles beyond a plane across the line of centres. A link that has moved little is left out altogether, since √(1 + m) changes
/// by no more than the link's motion in its own norm. What remains is solved as [`free_margin`] does, so that
/// the result is that of [`clearance`], to the last bit.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{Clearance, MarginOptions};
///
/// let obstacles: Vec<_> = (0..1000)
///     .map(|i| {
///         let center = DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)) * 2.0;
///         Ellipsoid::new(center, DVec3::new(0.3, 0.2, 0.1), Default::default())
///     })
///     .collect::<Result<_, _>>()?;
/// let mut scene = Clearance::new(&obstacles, MarginOptions::default())?;
/// let link = Ellipsoid::new(DVec3::new(5.1, 3.0, 3.0), DVec3::new(0.5, 0.1, 0.1), Default::default())?;
/// let nearest = scene.step(&[link])?;
/// assert!(nearest.margin.margin > 0.0 && nearest.pairs_evaluated < 20);
/// let out = nearest.left_out;
/// assert_eq!(nearest.pairs_evaluated + out.by_motion + out.by_box + out.by_plane, 1000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Clearance<V: Vector> {
    options: MarginOptions,
    obstacles: Vec<Ellipsoid<V>>,
    tree: Hierarchy,
    /// How far any point of any obstacle can have moved in all calls of `move_obstacles`.
    drift: f64,
    links: Vec<Seen<V>>,
    /// The pair of the last result.
    last: Option<(usize, usize)>,
}

/// A link where its margins were last bounded.
#[derive(Clone, Copy, Debug)]
struct Seen<V: Vector> {
    link: Ellipsoid<V>,
    /// √(1 + m) ≥ this for every obstacle, then.
    scale: f64,
    /// The drift then.
    drift: f64,
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
        let boxes: Vec<Aabb> = obstacles.iter().map(around).collect();
        Ok(Self {
            options,
            obstacles: obstacles.to_vec(),
            tree: Hierarchy::new(&boxes),
            drift: 0.0,
            links: Vec::new(),
            last: None,
        })
    }

    /// The obstacles where they are now.
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
        let boxes: Vec<Aabb> = obstacles.iter().map(around).collect();
        self.tree.refit(&boxes);
        Ok(())
    }

    /// The least margin with the links where they are now. They may differ from those of the last step in any way; a link
    /// is taken for the same one moved if it has the same index and semi-axes.
    ///
    /// # Errors
    /// [`InvalidQuery::NoLinks`] if the list is empty.
    pub fn step(&mut self, links: &[Ellipsoid<V>]) -> Result<ClearanceResult<V>, InvalidQuery> {
        let first = *links.first().ok_or(InvalidQuery::NoLinks)?;
        self.links.resize(links.len(), Seen { link: first, scale: 0.0, drift: self.drift });
        let mut least = Least::default();
        let mut count = Count::default();
        // The pair that was nearest is likely to be near still: it is solved first.
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
            // What is solved already is as near as the least at most.
            let nearest = solved.map_or(f64::INFINITY, |_| least.scale());
            let mut search = Search { frame: Frame::new(link), least, count, nearest, solved };
            search.run(&self.tree, &self.obstacles, link, index, self.options);
            *seen = Seen { link: *link, scale: search.nearest, drift: self.drift };
            Search { least, count, .. } = search;
        }
        let Some((margin, link, obstacle)) = least.0 else { return Err(InvalidQuery::NoLinks) };
        self.last = Some((link, obstacle));
        Ok(ClearanceResult { margin, link, obstacle, pairs_evaluated: count.solved, left_out: count.left_out })
    }

    /// All pairs whose margin is at most `threshold`, by link, in no particular order within one.
    #[must_use]
    pub fn within(&self, links: &[Ellipsoid<V>], threshold: V::Scalar) -> Vec<NearPair<V>> {
        let mut pairs = Vec::new();
        let limit = Limit(threshold.as_f64(), V::Scalar::EPSILON.as_f64());
        for (index, link) in links.iter().enumerate() {
            let frame = Frame::new(link);
            let mut stack = alloc::vec![0];
            while let Some(node) = stack.pop() {
                if limit.excludes(frame.box_distance(self.tree.bounds(node))) {
                    continue;
                }
                match self.tree.node(node) {
                    Node::Split(a, b) => stack.extend([b, a]),
                    Node::Leaf(items) => {
                        for &obstacle in items {
                            if limit.excludes(frame.plane_distance(&self.obstacles[obstacle])) {
                                continue;
                            }
                            let margin = free_margin(link, &self.obstacles[obstacle], self.options);
                            if margin.margin <= threshold {
                                pairs.push(NearPair { margin, link: index, obstacle });
                            }
                        }
                    }
                }
            }
        }
        pairs
    }
}

/// A link's boxes are searched to this multiple of the least √(1 + m), although farther ones than the least need not be: the
/// bound so found lets the link be left out for some steps to come.
const REACH: f64 = 1.5;

/// How many pairs were solved and left out.
#[derive(Default)]
struct Count {
    solved: usize,
    left_out: LeftOut,
}

/// The least margin so far with its link and obstacle.
struct Least<V: Vector>(Option<(Margin<V>, usize, usize)>);

impl<V: Vector> Default for Least<V> {
    fn default() -> Self {
        Self(None)
    }
}

impl<V: Vector> Least<V> {
    fn take(&mut self, margin: Margin<V>, link: usize, obstacle: usize) {
        let better = self.0.is_none_or(|(least, l, o)| {
            margin.margin < least.margin || (margin.margin == least.margin && (link, obstacle) < (l, o))
        });
        if better {
            self.0 = Some((margin, link, obstacle));
        }
    }

    /// Whether a pair with √(1 + m) ≥ `scale` is certainly not the least.
    fn excludes(&self, scale: f64) -> bool {
        self.0.is_some_and(|(least, ..)| Limit(least.margin.as_f64(), V::Scalar::EPSILON.as_f64()).excludes(scale))
    }

    /// √(1 + m) of the least, from below.
    fn scale(&self) -> f64 {
        self.0.map_or(f64::INFINITY, |(least, ..)| {
            let rounding = 8.0 * V::Scalar::EPSILON.as_f64();
            ((1.0 + least.margin.as_f64()) * (1.0 - rounding) - rounding).max(0.0).sqrt()
        })
    }
}

/// A margin, with the ε of its type.
#[derive(Clone, Copy)]
struct Limit(f64, f64);

impl Limit {
    /// Whether √(1 + m) ≥ `scale` means a greater m, by more than rounding can have done. A negative bound or NaN never does.
    #[inline]
    fn excludes(self, scale: f64) -> bool {
        let Self(margin, epsilon) = self;
        let scale = scale.max(0.0);
        scale * scale > (1.0 + margin) * (1.0 + 64.0 * epsilon) + 64.0 * epsilon
    }
}

impl<V: Vector> Seen<V> {
    /// A lower bound on √(1 + m) with the link at `now` and the obstacles drifted.
    ///
    /// A point with the coordinates p = diag(a)⁻¹Rᵀ(x − x₁) in the old ball has p′ = Gp + δ in the new one, with
    /// G = diag(a)⁻¹R′ᵀR·diag(a), δ = diag(a)⁻¹R′ᵀ(x₁ − x₁′): ‖p′‖ ≥ (1 − ‖G − I‖)‖p‖ − ‖δ‖. And an obstacle's point that
    /// moves by η moves by η/a_min in the ball at most.
    fn bound_after(&self, now: &Ellipsoid<V>, drift: f64) -> f64 {
        let a: [f64; 3] = padded(self.link.semi_axes());
        if padded(now.semi_axes()) != a || self.scale == 0.0 {
            return 0.0;
        }
        let n = V::DIM;
        let (old, new) = (columns(self.link.axes()), columns(now.axes()));
        let moved = sub(padded(self.link.center()), padded(now.center()));
        let (mut turn, mut shift, mut least) = (0.0, 0.0, f64::INFINITY);
        for i in 0..n {
            for j in 0..n {
                let entry = (dot(new[i], old[j]) - f64::from(u8::from(i == j))) * (a[j] / a[i]);
                turn += entry * entry;
            }
            let delta = dot(new[i], moved) / a[i];
            shift += delta * delta;
            least = a[i].min(least);
        }
        // Rounding of axes and products, generously.
        let aspect = a[..n].iter().fold(0.0f64, |m, x| m.max(*x)) / least;
        let turn = turn.sqrt() + 64.0 * V::Scalar::EPSILON.as_f64() * aspect;
        (1.0 - turn) * self.scale - shift.sqrt() * (1.0 + 1e-12) - (drift - self.drift) / least * (1.0 + 1e-12)
    }
}

/// A link's own coordinates: rows Rᵀ/a of the map to the ball.
struct Frame {
    center: [f64; 3],
    rows: [[f64; 3]; 3],
}

impl Frame {
    fn new<V: Vector>(link: &Ellipsoid<V>) -> Self {
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(link.axes()), padded(link.semi_axes()));
        let rows = core::array::from_fn(|i| if i < V::DIM { axes[i].map(|x| x / a[i]) } else { [0.0; 3] });
        Self { center: padded(link.center()), rows }
    }

    /// The distance of the ball's centre from a box around the box.
    #[inline]
    fn box_distance(&self, b: &Aabb) -> f64 {
        let r = sub(b.center, self.center);
        let mut squared = 0.0;
        for row in &self.rows {
            let half = row[0].abs() * b.half[0] + row[1].abs() * b.half[1] + row[2].abs() * b.half[2];
            let gap = (dot(*row, r).abs() - half).max(0.0);
            squared += gap * gap;
        }
        squared.sqrt()
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle across the line of centres.
    fn plane_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>) -> f64 {
        let g = self.rows.map(|row| dot(row, sub(padded(obstacle.center()), self.center)));
        let norm = dot(g, g).sqrt();
        let n: [f64; 3] = core::array::from_fn(|k| (0..3).map(|i| self.rows[i][k] * (g[i] / norm)).sum());
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(obstacle.axes()), padded(obstacle.semi_axes()));
        let u: [f64; 3] = core::array::from_fn(|k| a[k] * dot(axes[k], n));
        let height = dot(u, u).sqrt();
        norm - height - 16.0 * f64::EPSILON * (norm + height)
    }
}

/// One link's way through the tree.
struct Search<V: Vector> {
    frame: Frame,
    least: Least<V>,
    count: Count,
    /// √(1 + m) is at least this for all pairs seen or left out so far.
    nearest: f64,
    /// An obstacle that was solved before.
    solved: Option<usize>,
}

impl<V: Vector> Search<V> {
    fn run(
        &mut self,
        tree: &Hierarchy,
        obstacles: &[Ellipsoid<V>],
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
                        let plane = self.frame.plane_distance(&obstacles[obstacle]);
                        if self.least.excludes(plane) {
                            self.nearest = self.nearest.min(plane);
                            self.count.left_out.by_plane += 1;
                            continue;
                        }
                        let margin = free_margin(link, &obstacles[obstacle], options);
                        self.count.solved += 1;
                        let rounding = 8.0 * V::Scalar::EPSILON.as_f64();
                        let square = (1.0 + margin.margin.as_f64()) * (1.0 - rounding) - rounding;
                        self.nearest = self.nearest.min(square.max(0.0).sqrt());
                        self.least.take(margin, index, obstacle);
                    }
                }
            }
        }
        // Not met again: it was counted with a box that was left out.
        self.count.left_out.by_box -= usize::from(self.solved.is_some());
    }
}

fn padded<V: Vector>(v: V) -> [f64; 3] {
    core::array::from_fn(|i| if i < V::DIM { v.get(i).as_f64() } else { 0.0 })
}

fn columns<M: convex_support::Matrix>(m: M) -> [[f64; 3]; 3] {
    core::array::from_fn(|j| if j < M::Vector::DIM { padded(m.col(j)) } else { [0.0; 3] })
}

/// The box around an ellipsoid: half extents √diag(Q⁻¹).
fn around<V: Vector>(e: &Ellipsoid<V>) -> Aabb {
    let (center, axes, a) = (padded(e.center()), columns(e.axes()), padded(e.semi_axes()));
    let half = core::array::from_fn(|i| {
        let extent = (0..3).map(|k| (axes[k][i] * a[k]) * (axes[k][i] * a[k])).sum::<f64>().sqrt();
        extent + 8.0 * f64::EPSILON * (a[0].max(a[1]).max(a[2]) + center[i].abs())
    });
    Aabb { center, half }
}

/// How far any point of the ellipsoid can have moved: |Δc| + ‖Δ(R·diag(a))‖.
fn displacement<V: Vector>(before: &Ellipsoid<V>, now: &Ellipsoid<V>) -> f64 {
    let shift = sub(padded(before.center()), padded(now.center()));
    let (old, new) = (columns(before.axes()), columns(now.axes()));
    let (a, b) = (padded(before.semi_axes()), padded(now.semi_axes()));
    let turn: f64 = (0..3)
        .map(|k| {
            let d: [f64; 3] = core::array::from_fn(|i| old[k][i] * a[k] - new[k][i] * b[k]);
            dot(d, d)
        })
        .sum();
    dot(shift, shift).sqrt() + turn.sqrt()
}
