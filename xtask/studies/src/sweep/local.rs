//! The distance of two bodies near where they are closest, in thirty digits.
//!
//! There each body is a vertex, an edge, a face, the side or the rim of a cone or a cylinder, or an ellipsoid: a patch
//! `x(u)` with up to two coordinates. The distance is stationary in the coordinates of both patches, `min ‖x(u) −
//! y(v)‖²` where the bodies are apart and a saddle where they overlap, and Newton's method finds that. All derivatives
//! are differences: nothing is derived here that could be derived wrong in the same way elsewhere.

use convex_support::glam::DVec3;
use convex_support::{Feature, SupportMap};
use workloads::real::{DoubleDouble, Real};
use workloads::shapes::Shape;
use workloads::vec3::{Vec3, add, cross, dot, norm, scale, sub, wide};

use super::solid::Solid;

type Number = DoubleDouble;
type Point = Vec3<Number>;

fn number(x: f64) -> Number {
    Number::from(x)
}

/// A patch of a body, in its own frame.
#[derive(Clone, Debug)]
enum Patch {
    Vertex(Point),
    Edge(Point, Point),
    Face(Point, Point, Point),
    /// `diag(a)·e`, with `e` the unit vector along `e₀ + u·t₁ + v·t₂`.
    Ellipsoid {
        semi_axes: Point,
        e: Point,
        tangents: [Point; 2],
    },
    /// A circle about the second axis, at a height and with a radius, and the directions of sine and cosine.
    Rim {
        circle: [Number; 2],
        towards: [Point; 2],
    },
    /// The lines between two circles, the second of which may be a point.
    Side {
        circles: [[Number; 2]; 2],
        towards: [Point; 2],
    },
}

/// A body near a point of it, at a pose.
#[derive(Clone, Debug)]
pub(super) struct Local {
    patch: Patch,
    /// The coordinates to begin with.
    start: [f64; 2],
    pub(super) radius: f64,
    pub(super) rows: [Point; 3],
    pub(super) translation: Point,
}

/// How far behind the supporting plane a corner is seen, and how far nothing else may be.
const SLABS: [f64; 2] = [1e-10, 1e-5];

impl Local {
    /// A body near a point of it, along a direction out of it; `None` where that is ambiguous, nearly across an edge or
    /// a face.
    pub(super) fn new(solid: &Solid, point: Vec3, outward: Vec3) -> Option<Self> {
        let [p, n] =
            [sub(wide(point), wide(solid.translation)), wide(outward)].map(|v| solid.turned_back(v).map(Real::f64));
        let shape = solid.form.shape.build::<DVec3>();
        let core = shape.core();
        let seen = SLABS.map(|slab| {
            let mut feature = Feature::new();
            shape.core_support_feature(DVec3::from_array(n), slab * core.extent, &mut feature);
            feature
        });
        let [feature, wide_feature] = &seen;
        if feature.points().len() != wide_feature.points().len() || !feature.is_complete() {
            return None;
        }
        let corners: Vec<Vec3> = feature.points().iter().map(|&p| (p + core.origin).to_array()).collect();
        let (patch, start) = patch(&solid.form.shape, &corners, feature.rim().is_some(), p)?;
        let translation = wide(solid.translation);
        Some(Self { patch, start, radius: core.radius, rows: solid.rows, translation })
    }

    /// A point by itself.
    pub(super) fn point(at: Vec3) -> Self {
        let axis = |i: usize| [0, 1, 2].map(|j| number(if i == j { 1.0 } else { 0.0 }));
        let patch = Patch::Vertex([number(0.0); 3]);
        Self { patch, start: [0.0; 2], radius: 0.0, rows: [0, 1, 2].map(axis), translation: wide(at) }
    }

    /// Turned about a centre, then shifted.
    pub(super) fn moved(&self, turn: Point, center: Point, shift: Point) -> Self {
        let columns = [0, 1, 2].map(|j| turned(turn, [0, 1, 2].map(|i| self.rows[i][j])));
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i]));
        let arm = turned(turn, sub(self.translation, center));
        Self { rows, translation: add(add(center, arm), shift), ..self.clone() }
    }

    fn coordinates(&self) -> usize {
        match self.patch {
            Patch::Vertex(_) => 0,
            Patch::Edge(..) | Patch::Rim { .. } => 1,
            Patch::Face(..) | Patch::Ellipsoid { .. } | Patch::Side { .. } => 2,
        }
    }

    /// The point of the world with these coordinates.
    fn at(&self, u: &[Number]) -> Point {
        let around = |towards: &[Point; 2], [height, radius]: [Number; 2], v: Number| {
            let aside = scale(add(towards[0], scale(towards[1], v)), radius / (number(1.0) + v * v).sqrt());
            [aside[0], height, aside[2]]
        };
        let local = match &self.patch {
            Patch::Vertex(p) => *p,
            Patch::Edge(p, e) => add(*p, scale(*e, u[0])),
            Patch::Face(p, e, f) => add(*p, add(scale(*e, u[0]), scale(*f, u[1]))),
            Patch::Ellipsoid { semi_axes, e, tangents } => {
                let e = add(*e, add(scale(tangents[0], u[0]), scale(tangents[1], u[1])));
                let e = scale(e, number(1.0) / norm(e));
                [0, 1, 2].map(|i| semi_axes[i] * e[i])
            }
            Patch::Rim { circle, towards } => around(towards, *circle, u[0]),
            Patch::Side { circles: [from, to], towards } => {
                around(towards, [0, 1].map(|i| from[i] + (to[i] - from[i]) * u[1]), u[0])
            }
        };
        add(self.translation, self.rows.map(|row| dot(row, local)))
    }
}

/// What a shape is near a point, of which its corners along the normal are known; and the coordinates of that point.
fn patch(shape: &Shape, corners: &[Vec3], is_disc: bool, p: Vec3) -> Option<(Patch, [f64; 2])> {
    let unit = |v: Point| scale(v, number(1.0) / norm(v));
    let towards = || {
        let out = unit([number(p[0]), number(0.0), number(p[2])]);
        [out, [-out[2], number(0.0), out[0]]]
    };
    match *shape {
        Shape::Ellipsoid { semi_axes } => {
            let e = unit([0, 1, 2].map(|i| number(p[i]) / number(semi_axes[i])));
            let least = (0..3).min_by(|&i, &j| e[i].abs().f64().total_cmp(&e[j].abs().f64())).unwrap_or(0);
            let axis = [0, 1, 2].map(|i| number(if i == least { 1.0 } else { 0.0 }));
            let first = unit(cross(e, axis));
            let tangents = [first, cross(e, first)];
            return Some((Patch::Ellipsoid { semi_axes: wide(semi_axes), e, tangents }, [0.0; 2]));
        }
        Shape::Cylinder { half_height: h, radius } | Shape::Cone { half_height: h, radius } => {
            let top = if matches!(shape, Shape::Cone { .. }) { 0.0 } else { radius };
            let circle = |height: f64| [number(height), number(if height > 0.0 { top } else { radius })];
            match corners {
                _ if is_disc => {}
                [corner] if corner[1] > 0.0 && top == 0.0 => {}
                [corner] => return Some((Patch::Rim { circle: circle(corner[1]), towards: towards() }, [0.0; 2])),
                [_, _] => {
                    let circles = [circle(-h), circle(h)];
                    return Some((Patch::Side { circles, towards: towards() }, [0.0, 0.5 * (p[1] / h + 1.0)]));
                }
                _ => return None,
            }
        }
        _ => {}
    }
    // Corners as exact as the shape's.
    let exact = |corner: &Vec3| match shape {
        Shape::Hull { points } => {
            let off = |q: &Vec3| norm(sub(*q, *corner));
            points.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(*corner)
        }
        _ => *corner,
    };
    let corners: Vec<Vec3> = corners.iter().map(exact).collect();
    let from = |q: Vec3| sub(wide(q), wide(corners[0]));
    match corners.len() {
        0 => None,
        1 => Some((Patch::Vertex(wide(corners[0])), [0.0; 2])),
        2 => {
            let e = from(corners[1]);
            let share = dot(from(p), e) / dot(e, e);
            Some((Patch::Edge(wide(corners[0]), e), [share.f64(), 0.0]))
        }
        _ => {
            // The widest triangle at the first corner, and the coordinates of the point in a right-angled frame.
            let area = |q: &Vec3| norm(cross(from(corners[1]), from(*q))).f64();
            let third = corners[2..].iter().copied().max_by(|a, b| area(a).total_cmp(&area(b)))?;
            let e = unit(from(corners[1]));
            let f = unit(cross(cross(e, from(third)), e));
            let start = [dot(from(p), e).f64(), dot(from(p), f).f64()];
            Some((Patch::Face(wide(corners[0]), e, f), start))
        }
    }
}

/// A vector turned by the rotation vector `w`: the exponential series.
pub(super) fn turned(w: Point, v: Point) -> Point {
    let (mut sum, mut term) = (v, v);
    for k in 1..60 {
        term = scale(cross(w, term), number(1.0) / number(f64::from(k)));
        sum = add(sum, term);
        if norm(term).f64() < 1e-34 * norm(v).f64() {
            break;
        }
    }
    sum
}

/// The steps of the differences that Newton's method uses.
const FIRST: f64 = 1e-11;
const SECOND: f64 = 1e-6;
const MAX_STEPS: usize = 30;

/// Two patches near where they are closest, and the inverse of what Newton's method solves.
pub(super) struct Stationary {
    at: Vec<Number>,
    inverse: Vec<Vec<f64>>,
    /// −1 where the cores overlap.
    sign: f64,
}

impl Stationary {
    /// `sign` is that of the distance of the cores. `None` where the conditions do not say where the points are.
    pub(super) fn new(a: &Local, b: &Local, sign: f64) -> Option<Self> {
        let starts = [a, b].map(|local| &local.start[..local.coordinates()]);
        let at: Vec<Number> = starts.concat().into_iter().map(number).collect();
        let mut this = Self { at, inverse: Vec::new(), sign };
        for _ in 0..3 {
            this.inverse = inverse(&this.second(a, b))?;
            this.at = this.solved(a, b)?;
        }
        Some(this)
    }

    /// The signed distance of bodies that have moved a little.
    pub(super) fn distance(&self, a: &Local, b: &Local) -> Option<Number> {
        let at = self.solved(a, b)?;
        Some(square(a, b, &at).sqrt() * number(self.sign) - number(a.radius) - number(b.radius))
    }

    /// Newton's method, with the second derivatives of the start.
    fn solved(&self, a: &Local, b: &Local) -> Option<Vec<Number>> {
        let mut at = self.at.clone();
        let mut last = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let slopes: Vec<f64> = (0..at.len()).map(|i| central(a, b, &at, i)).collect();
            let mut longest = 0.0_f64;
            for (x, row) in at.iter_mut().zip(&self.inverse) {
                let step: f64 = row.iter().zip(&slopes).map(|(r, s)| r * s).sum();
                *x = *x - number(step);
                longest = longest.max(step.abs());
            }
            // As short as rounding leaves them, or no shorter.
            if longest < 1e-19 || (longest >= 0.5 * last && longest < 1e-15) {
                return Some(at);
            }
            last = longest;
        }
        None
    }

    /// The second derivatives of the square of the distance.
    fn second(&self, a: &Local, b: &Local) -> Vec<Vec<f64>> {
        let n = self.at.len();
        let moved = |i: usize, j: usize, [s, t]: [f64; 2]| {
            let mut at = self.at.clone();
            at[i] = at[i] + number(s * SECOND);
            at[j] = at[j] + number(t * SECOND);
            square(a, b, &at)
        };
        let entry = |i, j| {
            let [pp, pm, mp, mm] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|signs| moved(i, j, signs));
            ((pp - pm - mp + mm) / number(4.0 * SECOND * SECOND)).f64()
        };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

fn square(a: &Local, b: &Local, at: &[Number]) -> Number {
    let (u, v) = at.split_at(a.coordinates());
    let apart = sub(a.at(u), b.at(v));
    dot(apart, apart)
}

/// The derivative of the square of the distance by a coordinate.
fn central(a: &Local, b: &Local, at: &[Number], i: usize) -> f64 {
    let moved = |step: f64| {
        let mut at = at.to_vec();
        at[i] = at[i] + number(step);
        square(a, b, &at)
    };
    ((moved(FIRST) - moved(-FIRST)) / number(2.0 * FIRST)).f64()
}

/// By Gauss's and Jordan's method.
fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    let unit = |i: usize| (0..n).map(move |j| if i == j { 1.0 } else { 0.0 });
    let mut rows: Vec<Vec<f64>> =
        matrix.iter().enumerate().map(|(i, row)| row.iter().copied().chain(unit(i)).collect()).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        let head = rows[k][k];
        if head == 0.0 || !head.is_finite() {
            return None;
        }
        rows[k].iter_mut().for_each(|x| *x /= head);
        let own = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k];
            row.iter_mut().zip(&own).for_each(|(x, y)| *x -= factor * y);
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}
