//! Which of a set of points are the vertices of its convex hull, and which facets they span, exactly.
//!
//! Quickhull (Barber, Dobkin, Huhdanpaa, *The Quickhull algorithm for convex hulls*, 1996) with [exact
//! predicates](crate::numerics::orientation). With rounded predicates, Quickhull has to merge facets that come out
//! concave, which goes wrong for a mesh from a CAD file with its thousands of coplanar and repeated points. With exact
//! ones there is nothing to repair: a point on a facet's plane does not see the facet, so that coplanar points become
//! coplanar facets, and a duplicate sees none.

use alloc::vec;
use alloc::vec::Vec;

use crate::numerics::orientation::{six_volumes, twice_area};

/// The hull of points, by its dimension; all numbers are indices of points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ConvexHull {
    /// All points coincide.
    Point(u32),
    /// All points are on one line.
    Segment([u32; 2]),
    /// All points are in one plane: the corners of their polygon in cyclic order, none on the line of its neighbours.
    Polygon(Vec<u32>),
    /// Triangles, counterclockwise from outside. Several may lie in one plane.
    Polyhedron(Vec<[u32; 3]>),
}

/// The hull of a non-empty list of finite points, whose coordinates must not be so small that their products vanish.
///
/// `None` if the predicates contradict each other, which only underflow can cause: coordinates of one point set that
/// are a hundred orders of magnitude apart.
pub(crate) fn convex_hull(points: &[[f64; 3]]) -> Option<ConvexHull> {
    let Some([a, b]) = farthest_along_an_axis(points) else { return Some(ConvexHull::Point(0)) };
    let Some(c) = farthest_from_line(points, a, b) else { return Some(ConvexHull::Segment([a, b])) };
    match farthest_from_plane(points, [a, b, c]) {
        Some(d) => Quickhull::new(points, [a, b, c, d]).run().map(ConvexHull::Polyhedron),
        None => Some(ConvexHull::Polygon(polygon(points, [a, b, c]))),
    }
}

/// Twice the signed area of three points projected along axis `drop`; the sign is exact.
fn area(points: &[[f64; 3]], [a, b, c]: [u32; 3], drop: usize) -> f64 {
    let flat = |i: u32| {
        let p = points[i as usize];
        [p[(drop + 1) % 3], p[(drop + 2) % 3]]
    };
    twice_area([a, b, c].map(flat))
}

/// Six times the volume between a triangle and a point, positive if the triangle appears counterclockwise from the
/// point; the sign is exact.
fn volume(points: &[[f64; 3]], [a, b, c]: [u32; 3], d: u32) -> f64 {
    six_volumes([a, b, c, d].map(|i| points[i as usize]))
}

/// The index with the largest value; `None` if no value is greater than zero.
fn largest(points: &[[f64; 3]], value: impl Fn(u32) -> f64) -> Option<u32> {
    let mut best = (0.0, None);
    for i in 0..points.len() as u32 {
        let v = value(i);
        if v > best.0 {
            best = (v, Some(i));
        }
    }
    best.1
}

/// The two points at the ends of the longest edge of the bounding box; `None` if all points coincide.
pub(super) fn farthest_along_an_axis(points: &[[f64; 3]]) -> Option<[u32; 2]> {
    let mut widest = (0.0, None);
    for axis in 0..3 {
        let (mut low, mut high) = (0, 0);
        for (i, p) in points.iter().enumerate() {
            if p[axis] < points[low][axis] {
                low = i;
            }
            if p[axis] > points[high][axis] {
                high = i;
            }
        }
        let width = points[high][axis] - points[low][axis];
        if width > widest.0 {
            widest = (width, Some([low as u32, high as u32]));
        }
    }
    widest.1
}

/// A point far from the line through two points, and never on it; `None` if all are on it.
fn farthest_from_line(points: &[[f64; 3]], a: u32, b: u32) -> Option<u32> {
    largest(points, |c| (0..3).map(|drop| area(points, [a, b, c], drop).abs()).fold(0.0, f64::max))
}

/// A point far from the plane of three points, and never on it; `None` if all are on it.
fn farthest_from_plane(points: &[[f64; 3]], triangle: [u32; 3]) -> Option<u32> {
    largest(points, |d| volume(points, triangle, d).abs())
}

/// The corners of the hull of coplanar points that are not collinear, by Andrew's monotone chain.
fn polygon(points: &[[f64; 3]], triangle: [u32; 3]) -> Vec<u32> {
    // Projected along the axis nearest its normal, the points keep their order in the plane.
    let seen = |drop: usize| area(points, triangle, drop).abs();
    let drop = (1..3).fold(0, |best, axis| if seen(axis) > seen(best) { axis } else { best });
    let key = |i: u32| (points[i as usize][(drop + 1) % 3], points[i as usize][(drop + 2) % 3]);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by(|&i, &j| key(i).partial_cmp(&key(j)).unwrap_or(core::cmp::Ordering::Equal));
    order.dedup_by_key(|i| key(*i));
    let mut corners: Vec<u32> = Vec::new();
    let mut chain = |order: &mut dyn Iterator<Item = u32>| {
        let start = corners.len();
        for i in order {
            while corners.len() >= start + 2
                && area(points, [corners[corners.len() - 2], corners[corners.len() - 1], i], drop) <= 0.0
            {
                corners.pop();
            }
            corners.push(i);
        }
        corners.pop();
    };
    chain(&mut order.iter().copied());
    chain(&mut order.iter().rev().copied());
    corners
}

/// No point or facet.
const NONE: u32 = u32::MAX;

/// A triangle of the growing hull.
struct Facet {
    corners: [u32; 3],
    /// The facets across the edges that begin at each corner.
    across: [u32; 3],
    /// The first of the list of points that are known to see this facet, continued in `Quickhull::next`.
    outside: u32,
    /// The point of the list farthest from its plane, and six times the volume that it spans with the facet.
    farthest: (u32, f64),
    /// The insertion that last tested this facet, and whether its point saw it.
    looked: u32,
    seen: bool,
    removed: bool,
}

struct Quickhull<'a> {
    points: &'a [[f64; 3]],
    facets: Vec<Facet>,
    /// The next point of the list that a point is in.
    next: Vec<u32>,
    /// Facets whose lists are still to be processed.
    todo: Vec<u32>,
    /// The new facet that begins at a corner of the horizon.
    begins: Vec<u32>,
}

impl<'a> Quickhull<'a> {
    /// Begins with a tetrahedron.
    fn new(points: &'a [[f64; 3]], [a, b, c, d]: [u32; 4]) -> Self {
        // d is to be behind (a, b, c).
        let (b, c) = if volume(points, [a, b, c], d) > 0.0 { (c, b) } else { (b, c) };
        let mut this = Self {
            points,
            facets: Vec::new(),
            next: vec![NONE; points.len()],
            todo: Vec::new(),
            begins: vec![NONE; points.len()],
        };
        let faces = [([a, b, c], [3, 2, 1]), ([a, c, d], [0, 2, 3]), ([c, b, d], [0, 3, 1]), ([b, a, d], [0, 1, 2])];
        for (corners, across) in faces {
            this.push(corners, across);
        }
        for i in 0..points.len() as u32 {
            this.assign(i, 0);
        }
        this.todo.extend(0..4);
        this
    }

    fn push(&mut self, corners: [u32; 3], across: [u32; 3]) {
        self.facets.push(Facet {
            corners,
            across,
            outside: NONE,
            farthest: (NONE, 0.0),
            looked: NONE,
            seen: false,
            removed: false,
        });
    }

    /// Puts a point on the list of the first facet from `first` on that it sees, if there is one.
    fn assign(&mut self, point: u32, first: usize) {
        for facet in &mut self.facets[first..] {
            let height = volume(self.points, facet.corners, point);
            if height > 0.0 {
                self.next[point as usize] = facet.outside;
                facet.outside = point;
                if height > facet.farthest.1 {
                    facet.farthest = (point, height);
                }
                return;
            }
        }
    }

    /// Adds the points one by one, each the farthest of some list, until no list is left.
    fn run(mut self) -> Option<Vec<[u32; 3]>> {
        // Every round takes at least one point off the lists for good.
        let mut seen = Vec::new();
        let mut horizon = Vec::new();
        for round in 0.. {
            let facet = loop {
                let Some(facet) = self.todo.pop() else {
                    return Some(self.facets.iter().filter(|f| !f.removed).map(|f| f.corners).collect());
                };
                let Facet { removed, outside, .. } = self.facets[facet as usize];
                if !removed && outside != NONE {
                    break facet;
                }
            };
            let apex = self.facets[facet as usize].farthest.0;
            self.look(apex, facet, round, &mut seen, &mut horizon);
            self.replace(apex, &seen, &horizon)?;
        }
        None
    }

    /// Collects the facets that `apex` sees, beginning with `facet`, and the edges around them.
    fn look(&mut self, apex: u32, facet: u32, round: u32, seen: &mut Vec<u32>, horizon: &mut Vec<(u32, usize)>) {
        seen.clear();
        horizon.clear();
        seen.push(facet);
        (self.facets[facet as usize].looked, self.facets[facet as usize].seen) = (round, true);
        let mut visited = 0;
        while let Some(&facet) = seen.get(visited) {
            visited += 1;
            for edge in 0..3 {
                let neighbour = self.facets[facet as usize].across[edge];
                let f = &mut self.facets[neighbour as usize];
                if f.looked != round {
                    f.looked = round;
                    f.seen = volume(self.points, f.corners, apex) > 0.0;
                    if f.seen {
                        seen.push(neighbour);
                    }
                }
                if !f.seen {
                    horizon.push((facet, edge));
                }
            }
        }
    }

    /// Replaces the facets that `apex` sees by the triangles between it and the horizon, and passes their lists on.
    ///
    /// A point that saw one of the old facets and is outside the new hull sees one of the new facets: where the segment
    /// from it to the old facet enters the new hull, it is above the plane of the old facet, but no point of the
    /// remaining facets is.
    fn replace(&mut self, apex: u32, seen: &[u32], horizon: &[(u32, usize)]) -> Option<()> {
        let first = self.facets.len();
        for &(facet, edge) in horizon {
            let f = &self.facets[facet as usize];
            let (from, to, beyond) = (f.corners[edge], f.corners[(edge + 1) % 3], f.across[edge]);
            let new = self.facets.len() as u32;
            self.push([from, to, apex], [beyond, NONE, NONE]);
            let back = self.facets[beyond as usize].corners.iter().position(|&c| c == to)?;
            self.facets[beyond as usize].across[back] = new;
            self.begins[from as usize] = new;
        }
        // The edges of the horizon are one cycle: every corner begins one and ends one.
        for new in first..self.facets.len() {
            let following = self.begins[self.facets[new].corners[1] as usize];
            let follower = self.facets.get_mut(following as usize).filter(|f| f.across[2] == NONE)?;
            follower.across[2] = new as u32;
            self.facets[new].across[1] = following;
        }
        for &(facet, edge) in horizon {
            let from = self.facets[facet as usize].corners[edge];
            self.begins[from as usize] = NONE;
        }
        for &facet in seen {
            self.facets[facet as usize].removed = true;
            let mut point = core::mem::replace(&mut self.facets[facet as usize].outside, NONE);
            while point != NONE {
                let next = self.next[point as usize];
                if point != apex {
                    self.assign(point, first);
                }
                point = next;
            }
        }
        self.todo.extend(first as u32..self.facets.len() as u32);
        Some(())
    }
}
