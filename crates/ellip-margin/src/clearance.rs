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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LeftOut {
    /// The link has moved too little since its margins were last bounded.
    pub by_motion: usize,
    /// A box around the obstacle, or around a group of them, is too far from the link in the norm of the link.
    pub by_box: usize,
    /// A ball around the obstacle is too far from the ball around the grown link.
    pub by_sphere: usize,
    /// A plane across the line of centres separates the obstacle from the grown link.
    pub by_plane: usize,
    /// So does a plane across the normal at which the link was nearest to the obstacle when the two were last solved.
    pub by_normal: usize,
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
    let of_link = |(link, e1): (usize, &Ellipsoid<V>)| {
        let mut least = Least::default();
        for (obstacle, e2) in obstacles.iter().enumerate() {
            least.take(free_margin(e1, e2, options), link, obstacle);
        }
        least
    };
    let least = least_of(links, of_link);
    let (margin, link, obstacle) = least.0.ok_or(InvalidQuery::NoLinks)?;
    let pairs_evaluated = links.len() * obstacles.len();
    Ok(ClearanceResult { margin, link, obstacle, pairs_evaluated, left_out: LeftOut::default() })
}

/// The least of what is found for each link: which core finds what does not matter, since ties go by index.
#[cfg(feature = "rayon")]
fn least_of<V: Vector>(
    links: &[Ellipsoid<V>],
    of_link: impl Fn((usize, &Ellipsoid<V>)) -> Least<V> + Sync + Send,
) -> Least<V> {
    use rayon::prelude::*;
    links.par_iter().enumerate().map(of_link).reduce(Least::default, Least::or)
}

/// The least of what is found for each link.
#[cfg(not(feature = "rayon"))]
fn least_of<V: Vector>(links: &[Ellipsoid<V>], of_link: impl Fn((usize, &Ellipsoid<V>)) -> Least<V>) -> Least<V> {
    links.iter().enumerate().map(of_link).fold(Least::default(), Least::or)
}

/// The least margin of a robot's links about obstacles along a motion, without looking at most pairs.
///
/// The obstacles lie in a tree of boxes, which follows when they [move](Self::move_obstacles). Per link, groups of them
/// are left out whose box is farther, in the norm in which the link is the unit ball, than the least margin so far; so are
/// obstacles whose ball is too far, and those beyond a plane across the line of centres or across the normal at which the
/// two were nearest when last solved. A link that has moved little is left out altogether, since √(1 + m) changes
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
/// assert_eq!(nearest.pairs_evaluated + nearest.left_out.total(), 1000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Clearance<V: Vector> {
    options: MarginOptions,
    obstacles: Vec<Ellipsoid<V>>,
    /// The greatest semi-axis of each obstacle.
    radii: Vec<f64>,
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
    /// The pairs solved last, the newest first.
    normals: Normals,
}

/// How many normals are kept of each link: the obstacles it is among, not all there are.
const NORMALS: usize = 8;

/// Obstacles that were solved with a link lately, and the unit normal from the link to each where it was nearest.
#[derive(Clone, Copy, Debug)]
struct Normals([Option<(usize, [f64; 3])>; NORMALS]);

impl Normals {
    const NONE: Self = Self([None; NORMALS]);

    fn of(&self, obstacle: usize) -> Option<[f64; 3]> {
        self.0.iter().flatten().find(|(of, _)| *of == obstacle).map(|(_, normal)| *normal)
    }

    /// Keeps a normal, in the place of the same obstacle's or of the oldest.
    fn keep(&mut self, obstacle: usize, normal: [f64; 3]) {
        let place = self.0.iter().position(|kept| kept.is_none_or(|(of, _)| of == obstacle)).unwrap_or(NORMALS - 1);
        self.0[place] = Some((obstacle, normal));
        self.0[..=place].rotate_right(1);
    }
}

impl LeftOut {
    /// All of them.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.by_motion + self.by_box + self.by_sphere + self.by_plane + self.by_normal
    }
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
            radii: obstacles.iter().map(radius).collect(),
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
        self.radii.clear();
        self.radii.extend(obstacles.iter().map(radius));
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
        self.links.resize(links.len(), Seen { link: first, scale: 0.0, drift: self.drift, normals: Normals::NONE });
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
            let mut search = Search { frame: Frame::new(link), least, count, nearest, solved, normals: seen.normals };
            search.run(&self.tree, &self.obstacles, &self.radii, link, index, self.options);
            *seen = Seen { link: *link, scale: search.nearest, drift: self.drift, normals: search.normals };
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

    /// The lesser of two.
    fn or(mut self, other: Self) -> Self {
        if let Some((margin, link, obstacle)) = other.0 {
            self.take(margin, link, obstacle);
        }
        self
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
    /// The greatest semi-axis.
    radius: f64,
}

impl Frame {
    fn new<V: Vector>(link: &Ellipsoid<V>) -> Self {
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(link.axes()), padded(link.semi_axes()));
        let rows = core::array::from_fn(|i| if i < V::DIM { axes[i].map(|x| x / a[i]) } else { [0.0; 3] });
        Self { center: padded(link.center()), rows, radius: radius(link) }
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

    /// A lower bound on that distance from a ball around the obstacle: (‖r‖ − radius)/a_max.
    #[inline]
    fn sphere_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, radius: f64) -> f64 {
        let r = sub(padded(obstacle.center()), self.center);
        let norm = dot(r, r).sqrt();
        (norm - radius - 16.0 * f64::EPSILON * (norm + radius)) / self.radius
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle across the line of centres.
    fn plane_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>) -> f64 {
        let g = self.rows.map(|row| dot(row, sub(padded(obstacle.center()), self.center)));
        self.tangent_distance(obstacle, g, g)
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle across a normal of space.
    fn normal_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, normal: [f64; 3]) -> f64 {
        let g = self.rows.map(|row| dot(row, sub(padded(obstacle.center()), self.center)));
        // A plane's normal in the ball is A⁻ᵀn for x ↦ Ax: rowᵢ/‖rowᵢ‖²·n.
        let n = self.rows.map(|row| {
            let squared = dot(row, row);
            if squared > 0.0 { dot(row, normal) / squared } else { 0.0 }
        });
        self.tangent_distance(obstacle, n, g)
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle with the normal `n` of the ball, for the
    /// obstacle's centre at `g`.
    fn tangent_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, n: [f64; 3], g: [f64; 3]) -> f64 {
        let length = dot(n, n).sqrt();
        let n = n.map(|x| x / length);
        let world: [f64; 3] = core::array::from_fn(|k| (0..3).map(|i| self.rows[i][k] * n[i]).sum());
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(obstacle.axes()), padded(obstacle.semi_axes()));
        let u: [f64; 3] = core::array::from_fn(|k| a[k] * dot(axes[k], world));
        let (along, height) = (dot(n, g), dot(u, u).sqrt());
        along - height - 16.0 * f64::EPSILON * (dot(g, g).sqrt() + height)
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
    normals: Normals,
}

impl<V: Vector> Search<V> {
    fn run(
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
                        let rounding = 8.0 * V::Scalar::EPSILON.as_f64();
                        let square = (1.0 + margin.margin.as_f64()) * (1.0 - rounding) - rounding;
                        self.nearest = self.nearest.min(square.max(0.0).sqrt());
                        self.least.take(margin, index, obstacle);
                        self.normals.keep(obstacle, normal(&obstacles[obstacle], &margin));
                    }
                }
            }
        }
        // Not met again: it was counted with a box that was left out.
        self.count.left_out.by_box -= usize::from(self.solved.is_some());
    }

    /// A bound on √(1 + m) that shows the obstacle not to be the least, and what it is due to: the cheapest that does.
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

/// The unit normal from the link to the obstacle at x*, in space; zero where the centre of the link lies in the obstacle.
fn normal<V: Vector>(obstacle: &Ellipsoid<V>, margin: &Margin<V>) -> [f64; 3] {
    let (axes, a, y) = (columns(obstacle.axes()), padded(obstacle.semi_axes()), padded(margin.ball_point));
    let z: [f64; 3] = core::array::from_fn(|i| (0..V::DIM).map(|k| -axes[k][i] * (y[k] / a[k])).sum());
    let norm = dot(z, z).sqrt();
    z.map(|x| x / norm)
}

/// The greatest semi-axis.
fn radius<V: Vector>(e: &Ellipsoid<V>) -> f64 {
    e.semi_axes().max_element().as_f64()
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
