//! Trees of shapes: what they are built from, the shape of the crate, and the support value of what they stand for.

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::strategies::{AnyShape, Shape};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Faceted, Hull, InvalidShape, Matrix,
    MinkowskiSum, Point, Polytope, Posed, Rotation, Rounded, Scalar, Segment, Triangle, Vector, Vector3,
};

use super::fixed::{Fixed, dot, norm};

/// A shape by the numbers that its constructor is given; in the plane, of the first two coordinates and the first
/// angle.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Points(Vec<[f64; 3]>),
    Ball(f64),
    Cuboid([f64; 3]),
    Capsule([f64; 2]),
    Cylinder([f64; 2]),
    Cone([f64; 2]),
    Ellipsoid([f64; 3], [f64; 3], [f64; 4]),
    Posed(Box<Self>, [f64; 4], [f64; 3]),
    Affine(Box<Self>, [[f64; 3]; 3], [f64; 3]),
    Sum(Box<Self>, Box<Self>),
    Difference(Box<Self>, Box<Self>),
    Hull(Box<Self>, Box<Self>),
    Rounded(Box<Self>, f64),
}

/// A vector type, with what exists in its dimension only.
pub(crate) trait Space: Vector {
    fn solid(tree: &Tree) -> AnyShape<Self>;
    fn rotation(q: [f64; 4]) -> Self::Rotation;
}

macro_rules! plane {
    ($($V:ident)*) => {$(
        impl Space for $V {
            fn solid(tree: &Tree) -> AnyShape<Self> {
                unreachable!("{tree:?} is not drawn in the plane")
            }

            fn rotation(q: [f64; 4]) -> Self::Rotation {
                <Self as Vector>::Scalar::from_f64(q[0])
            }
        }
    )*};
}

macro_rules! space {
    ($($V:ident)*) => {$(
        impl Space for $V {
            fn solid(tree: &Tree) -> AnyShape<Self> {
                solid(tree)
            }

            fn rotation(q: [f64; 4]) -> Self::Rotation {
                Rotation::<Self>::from_xyzw(q.map(<Self as Vector>::Scalar::from_f64))
            }
        }
    )*};
}

plane!(Vec2 DVec2);
space!(Vec3 Vec3A DVec3);

fn boxed<S: Shape + 'static>(shape: Result<S, InvalidShape>) -> AnyShape<S::Vector> {
    Box::new(shape.expect("what is drawn is valid"))
}

fn vector<V: Vector>(v: [f64; 3]) -> V {
    V::from_fn(|i| V::Scalar::from_f64(v[i]))
}

fn solid<V: Vector3>(tree: &Tree) -> AnyShape<V> {
    let number = V::Scalar::from_f64;
    match *tree {
        Tree::Cylinder([h, r]) => boxed(Cylinder::<V>::new(number(h), number(r))),
        Tree::Cone([h, r]) => boxed(Cone::<V>::new(number(h), number(r))),
        _ => unreachable!("{tree:?} is no solid"),
    }
}

impl Tree {
    /// The shape of the crate.
    pub(crate) fn build<V: Space>(&self) -> AnyShape<V> {
        let number = V::Scalar::from_f64;
        match self {
            Self::Points(points) => {
                let p: Vec<V> = points.iter().map(|&p| vector(p)).collect();
                match p[..] {
                    [a] => boxed(Point::new(a)),
                    [a, b] => boxed(Segment::new([a, b])),
                    [a, b, c] => boxed(Triangle::new([a, b, c])),
                    _ if p.len().is_multiple_of(2) => boxed(Polytope::new(p)),
                    [first, ..] if first.get(0) == V::Scalar::ZERO => boxed(Faceted::hull_of(p)),
                    _ => boxed(Polytope::hull_of(p)),
                }
            }
            Self::Ball(r) => boxed(Ball::<V>::new(number(*r))),
            Self::Cuboid(h) => boxed(Cuboid::<V>::new(vector(*h))),
            Self::Capsule([h, r]) => boxed(Capsule::<V>::new(number(*h), number(*r))),
            Self::Cylinder(_) | Self::Cone(_) => V::solid(self),
            Self::Ellipsoid(c, a, q) => boxed(Ellipsoid::<V>::new(vector(*c), vector(*a), V::rotation(*q))),
            Self::Posed(of, q, t) => boxed(Posed::new(of.build::<V>(), V::rotation(*q), vector(*t))),
            Self::Affine(of, m, t) => {
                let matrix = V::Matrix::from_cols_fn(|j| vector(m[j]));
                boxed(Affine::new(of.build::<V>(), matrix, vector(*t)))
            }
            Self::Sum(a, b) => boxed(Ok(MinkowskiSum::new(a.build::<V>(), b.build::<V>()))),
            Self::Difference(a, b) => boxed(Ok(Difference::new(a.build::<V>(), b.build::<V>()))),
            Self::Hull(a, b) => boxed(Ok(Hull::new(a.build::<V>(), b.build::<V>()))),
            Self::Rounded(of, r) => boxed(Rounded::new(of.build::<V>(), number(*r))),
        }
    }

    /// How far what the tree stands for reaches along `n`; the numbers count as they are rounded to the precision.
    pub(crate) fn support_value(&self, n: &[Fixed; 3], dim: usize) -> Fixed {
        let number = Fixed::from_f64;
        let vector = |v: &[f64; 3]| v.map(Fixed::from_f64);
        let across = || (n[0].clone() * n[0].clone() + n[2].clone() * n[2].clone()).sqrt();
        match self {
            Self::Points(points) => points.iter().map(|p| dot(n, &vector(p))).max().expect("a point"),
            Self::Ball(r) => number(*r) * norm(n),
            Self::Cuboid(h) => dot(&n.clone().map(Fixed::abs), &vector(h)),
            Self::Capsule([h, r]) => n[1].clone().abs() * number(*h) + number(*r) * norm(n),
            Self::Cylinder([h, r]) => n[1].clone().abs() * number(*h) + number(*r) * across(),
            Self::Cone([h, r]) => {
                let up = n[1].clone() * number(*h);
                up.clone().max(number(*r) * across() - up)
            }
            Self::Ellipsoid(c, a, q) => {
                let local = onto(&rotation(*q, dim), n);
                let [x, y, z] = [0, 1, 2].map(|i| local[i].clone() * number(a[i]));
                dot(n, &vector(c)) + norm(&[x, y, z])
            }
            Self::Posed(of, q, t) => of.support_value(&onto(&rotation(*q, dim), n), dim) + dot(n, &vector(t)),
            Self::Affine(of, m, t) => of.support_value(&onto(&m.map(|c| vector(&c)), n), dim) + dot(n, &vector(t)),
            Self::Sum(a, b) => a.support_value(n, dim) + b.support_value(n, dim),
            Self::Difference(a, b) => a.support_value(n, dim) + b.support_value(&n.clone().map(|c| -c), dim),
            Self::Hull(a, b) => a.support_value(n, dim).max(b.support_value(n, dim)),
            Self::Rounded(of, r) => of.support_value(n, dim) + number(*r) * norm(n),
        }
    }
}

/// The transpose of the matrix of these columns times a vector.
fn onto(columns: &[[Fixed; 3]; 3], v: &[Fixed; 3]) -> [Fixed; 3] {
    [0, 1, 2].map(|j| dot(&columns[j], v))
}

/// The columns of the rotation by an angle, or by a quaternion of any length.
fn rotation(q: [f64; 4], dim: usize) -> [[Fixed; 3]; 3] {
    let (zero, one) = (Fixed::zero(), Fixed::whole(1));
    if dim == 2 {
        let [s, c] = Fixed::from_f64(q[0]).sin_cos();
        return [[c.clone(), s.clone(), zero.clone()], [-s, c, zero.clone()], [zero.clone(), zero, one]];
    }
    let [x, y, z, w] = q.map(Fixed::from_f64);
    let squared = [&x, &y, &z, &w].into_iter().fold(zero, |sum, c| sum + c.clone() * c.clone());
    let twice = |a: &Fixed, b: &Fixed| Fixed::whole(2) * a.clone() * b.clone() / squared.clone();
    [
        [one.clone() - twice(&y, &y) - twice(&z, &z), twice(&x, &y) + twice(&z, &w), twice(&x, &z) - twice(&y, &w)],
        [twice(&x, &y) - twice(&z, &w), one.clone() - twice(&x, &x) - twice(&z, &z), twice(&y, &z) + twice(&x, &w)],
        [twice(&x, &z) + twice(&y, &w), twice(&y, &z) - twice(&x, &w), one - twice(&x, &x) - twice(&y, &y)],
    ]
}

/// Draws trees and directions.
pub(crate) struct Random {
    state: u64,
    dim: usize,
    /// Rounds to the precision of the space.
    rounded: fn(f64) -> f64,
}

impl Random {
    pub(crate) fn new<V: Vector>(seed: u64) -> Self {
        Self { state: seed, dim: V::DIM, rounded: |x| V::Scalar::from_f64(x).as_f64() }
    }

    /// A number from 0 to 1.
    fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.rounded)((self.state >> 11) as f64 / (1u64 << 53) as f64)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize % n
    }

    /// A length, mostly of about 1, but down to 1e-6.
    fn length(&mut self) -> f64 {
        let scale = [1.0, 1.0, 1.0, 1e-3, 1e-6][self.below(5)];
        (self.rounded)((0.1 + self.unit()) * scale)
    }

    pub(crate) fn vector(&mut self, reach: f64) -> [f64; 3] {
        let mut v = [0.0; 3];
        for c in v.iter_mut().take(self.dim) {
            *c = [0.0, 1.0, self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5][self.below(5)];
        }
        v.map(|c| (self.rounded)(c * reach))
    }

    /// A translation: at times far away.
    fn translation(&mut self) -> [f64; 3] {
        let reach = [0.0, 1.0, 1.0, 30.0, 1e3, 1e6][self.below(6)];
        self.vector(reach)
    }

    /// A quaternion, or an angle for its first number.
    fn rotation(&mut self) -> [f64; 4] {
        let q = [0, 1, 2, 3].map(|_| self.unit() - 0.5);
        let length = q.iter().map(|c| c * c).sum::<f64>().sqrt();
        let kind = self.below(5);
        let q = match kind {
            0 => [0.0, 0.0, 0.0, 1.0],
            1 => [0.0, q[1], 0.0, q[3]],
            2 => q,
            _ => q.map(|c| c / length),
        };
        let q = if self.dim == 2 { [if kind == 0 { 0.0 } else { 7.0 * q[0] }, 0.0, 0.0, 0.0] } else { q };
        q.map(self.rounded)
    }

    /// A direction that is not zero.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        let v = self.vector(2.0);
        if v == [0.0; 3] { [0.0, -1.0, 0.0] } else { v }
    }

    pub(crate) fn leaf(&mut self) -> Tree {
        let lengths = [self.length(), self.length()];
        match self.below(if self.dim == 3 { 9 } else { 7 }) {
            0 => Tree::Ball(lengths[0]),
            1 => Tree::Cuboid([lengths[0], lengths[1], self.length()]),
            2 => Tree::Capsule(lengths),
            3 => Tree::Ellipsoid(self.vector(3.0), [lengths[0], lengths[1], self.length()], self.rotation()),
            4..=6 => {
                let count = [1, 2, 3, 8, 21][self.below(5)];
                let reach = [1.0, 40.0][self.below(2)];
                Tree::Points((0..count).map(|_| self.vector(reach)).collect())
            }
            7 => Tree::Cylinder(lengths),
            _ => Tree::Cone(lengths),
        }
        .in_the_plane(self.dim)
    }

    /// A tree of up to so many levels.
    pub(crate) fn tree(&mut self, depth: usize) -> Tree {
        if depth == 0 {
            return self.leaf();
        }
        let part = |this: &mut Self| {
            let less = 1 + this.below(depth);
            Box::new(this.tree(depth - less))
        };
        match self.below(8) {
            0..=2 => Tree::Posed(part(self), self.rotation(), self.translation()),
            3 => {
                let kind = self.below(3);
                let (s, columns) = (self.length(), [self.vector(1.0), self.vector(1.0), self.vector(1.0)]);
                let scaling = [[s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]];
                let mirror = [[0.0, -2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]];
                let columns = if self.dim == 2 { [columns[0], columns[1], [0.0, 0.0, 1.0]] } else { columns };
                Tree::Affine(part(self), [scaling, mirror, columns][kind], self.translation())
            }
            4 => Tree::Sum(part(self), part(self)),
            5 => Tree::Difference(part(self), part(self)),
            6 => Tree::Hull(part(self), part(self)),
            _ => Tree::Rounded(part(self), self.length()),
        }
    }

    /// One shape turned and moved again and again.
    pub(crate) fn turned(&mut self, times: usize) -> Tree {
        let leaf = self.leaf();
        (0..times).fold(leaf, |of, _| Tree::Posed(Box::new(of), self.rotation(), self.vector(3.0)))
    }
}

impl Tree {
    fn in_the_plane(self, dim: usize) -> Self {
        match self {
            Self::Cuboid([x, y, _]) if dim == 2 => Self::Cuboid([x, y, 0.0]),
            other => other,
        }
    }
}
