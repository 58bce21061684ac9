//! Sets of five kinds, and their support maps in intervals.
//!
//! Everything is points or the unit ball, mapped, summed, or joined to a hull. What a ball of a radius sweeps is told
//! apart, as in the certificates.

use crate::interval::{Interval, Vector};

/// A set of points swept by a ball: `core ⊕ B(radius)`.
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) core: Set,
    pub(crate) radius: Interval,
}

#[derive(Clone)]
#[allow(clippy::large_enum_variant, reason = "a body is of a few of them")]
pub(crate) enum Set {
    Points(Vec<Vector>),
    /// The unit ball.
    Ball,
    /// The image under the map of these rows, then moved.
    Image(Box<Self>, [Vector; 3], Vector),
    Sum(Vec<Self>),
    Hull(Vec<Self>),
}

impl Set {
    /// A point of the set, and how far the set reaches along `direction`. The point reaches as far where that is not a
    /// matter of rounding, and is in the set in any case.
    pub(crate) fn support(&self, direction: &Vector) -> (Vector, Interval) {
        match self {
            Self::Points(points) => farthest(points.iter().map(|p| (p.clone(), p.dot(direction)))),
            Self::Ball => (direction.unit().unwrap_or_else(Vector::zero), direction.length()),
            Self::Image(of, rows, translation) => {
                let (point, value) = of.support(&combined(rows, direction));
                (apply(rows, &point).plus(translation), &value + &direction.dot(translation))
            }
            Self::Sum(of) => of
                .iter()
                .map(|part| part.support(direction))
                .fold((Vector::zero(), Interval::zero()), |(point, value), (p, v)| (point.plus(&p), &value + &v)),
            Self::Hull(of) => farthest(of.iter().map(|part| part.support(direction))),
        }
    }
}

impl Set {
    /// A bound on the sizes of the numbers that computing a point of the set in floating point comes by, each of which
    /// rounding takes its share of: the sum of those of every map on the way. In a pose far away and back again these
    /// are far larger than the set, and in a chain of poses they are many.
    pub(crate) fn magnitude(&self) -> Interval {
        let [size, before] = self.sizes();
        &size + &before
    }

    /// The size of the set, and the sum of the sizes of what it is made of, in its own unit.
    fn sizes(&self) -> [Interval; 2] {
        let zero = Interval::zero;
        match self {
            Self::Points(points) => {
                [points.iter().map(Vector::length).fold(zero(), |most, length| most.max(&length)), zero()]
            }
            Self::Ball => [Interval::from(1.0), zero()],
            Self::Image(of, rows, at) => {
                let ([size, before], stretch) = (of.sizes(), stretch(rows));
                let size = &stretch * &size;
                [&size + &at.length(), &size + &(&stretch * &before)]
            }
            Self::Sum(of) => {
                of.iter().map(Self::sizes).fold([zero(), zero()], |[a, b], [size, before]| [&a + &size, &b + &before])
            }
            Self::Hull(of) => of
                .iter()
                .map(Self::sizes)
                .fold([zero(), zero()], |[a, b], [size, before]| [a.max(&size), b.max(&before)]),
        }
    }
}

impl Set {
    /// A bound on how far its points are from one.
    pub(crate) fn reach_from(&self, center: &Vector) -> Interval {
        let farthest = |i: usize| {
            let along = |sign: f64| {
                let mut axis = Vector::zero();
                axis.0[i] = Interval::from(sign);
                &self.support(&axis).1 - &axis.dot(center)
            };
            along(1.0).max(&along(-1.0)).squared()
        };
        let [x, y, z] = std::array::from_fn(farthest);
        (&(&x + &y) + &z).root().greatest()
    }

    /// Points whose hull the set is, if it is one of few.
    pub(crate) fn corners(&self) -> Option<Vec<Vector>> {
        match self {
            Self::Points(points) => Some(points.clone()),
            Self::Ball => None,
            Self::Image(of, rows, at) => Some(of.corners()?.iter().map(|point| apply(rows, point).plus(at)).collect()),
            Self::Sum(of) => of.iter().try_fold(vec![Vector::zero()], |sums, part| {
                let corners = part.corners()?;
                Some(sums.iter().flat_map(|sum| corners.iter().map(|corner| sum.plus(corner))).collect())
            }),
            Self::Hull(of) => of.iter().map(Self::corners).collect::<Option<Vec<_>>>().map(|parts| parts.concat()),
        }
    }
}

/// A bound on how far a map stretches a vector: that of Gershgorin on the largest eigenvalue of `M·Mᵀ`, which is 1 for
/// a rotation.
fn stretch(rows: &[Vector; 3]) -> Interval {
    let products =
        |row: &Vector| rows.iter().map(|other| row.dot(other).absolute()).fold(Interval::zero(), |s, p| &s + &p);
    rows.iter().map(products).fold(Interval::zero(), |most, sum| most.max(&sum)).root()
}

/// The farthest of some points, and how far the farthest is.
fn farthest(mut points: impl Iterator<Item = (Vector, Interval)>) -> (Vector, Interval) {
    let Some((mut best, mut at)) = points.next() else { return (Vector::zero(), Interval::unknown()) };
    let mut value = at.clone();
    for (point, reach) in points {
        value = value.max(&reach);
        if at.least().is_less_than(&reach.least()) {
            (best, at) = (point, reach);
        }
    }
    (best, value)
}

/// The image of a point under the map of these rows.
pub(crate) fn apply(rows: &[Vector; 3], point: &Vector) -> Vector {
    Vector(rows.each_ref().map(|row| row.dot(point)))
}

/// The rows, combined: the image under the transposed map.
pub(crate) fn combined(rows: &[Vector; 3], by: &Vector) -> Vector {
    rows.iter().zip(&by.0).fold(Vector::zero(), |sum, (row, factor)| sum.plus(&row.times(factor)))
}

/// The rows of a product.
pub(crate) fn product(a: &[Vector; 3], b: &[Vector; 3]) -> [Vector; 3] {
    a.each_ref().map(|row| combined(b, row))
}

pub(crate) fn transposed(rows: &[Vector; 3]) -> [Vector; 3] {
    std::array::from_fn(|i| Vector(std::array::from_fn(|j| rows[j].0[i].clone())))
}

pub(crate) fn diagonal(entries: [Interval; 3]) -> [Vector; 3] {
    let mut rows = std::array::from_fn(|_| Vector::zero());
    for (i, entry) in entries.into_iter().enumerate() {
        rows[i].0[i] = entry;
    }
    rows
}

/// A ball of a radius about zero.
pub(crate) fn ball(radius: &Interval) -> Set {
    Set::Image(Box::new(Set::Ball), diagonal(std::array::from_fn(|_| radius.clone())), Vector::zero())
}

impl Body {
    pub(crate) fn of(core: Set) -> Self {
        Self { core, radius: Interval::zero() }
    }

    /// The [magnitude](Set::magnitude) of the core, and the radius.
    pub(crate) fn magnitude(&self) -> Interval {
        &self.core.magnitude() + &self.radius
    }

    /// The body as one set, but for a ball of the given radius.
    pub(crate) fn but_for(self, radius: &Interval) -> Set {
        let excess = &self.radius - radius;
        if excess.is_zero() { self.core } else { Set::Sum(vec![self.core, ball(&excess)]) }
    }
}

pub(crate) fn diagonal_of(entry: &Interval) -> [Vector; 3] {
    diagonal(std::array::from_fn(|_| entry.clone()))
}

pub(crate) fn sum(parts: Vec<Body>) -> Body {
    let radius = parts.iter().fold(Interval::zero(), |sum, part| &sum + &part.radius);
    Body { core: Set::Sum(parts.into_iter().map(|part| part.core).collect()), radius }
}

/// The set of all differences.
pub(crate) fn difference(a: Body, b: Body) -> Body {
    let reflected = Set::Image(Box::new(b.core), diagonal_of(&Interval::from(-1.0)), Vector::zero());
    sum(vec![a, Body { core: reflected, radius: b.radius }])
}

/// The corners of a box.
pub(crate) fn corners(half_extents: &Vector) -> Set {
    let sign = |corner: usize, i: usize| Interval::from(if corner >> i & 1 == 1 { -1.0 } else { 1.0 });
    let corner = |k| Vector(std::array::from_fn(|i| &half_extents.0[i] * &sign(k, i)));
    Set::Points((0..8).map(corner).collect())
}

/// By how much a map stretches, if it stretches everything alike, exactly: its rows are of one length, and across one
/// another.
pub(crate) fn scale_of(rows: &[Vector]) -> Option<Interval> {
    let squared = rows.first()?.squared();
    for (i, row) in rows.iter().enumerate() {
        let products = rows[..i].iter().map(|other| row.dot(other));
        if !products.chain([&row.squared() - &squared]).all(|excess| excess.is_zero()) {
            return None;
        }
    }
    Some(squared.root())
}
