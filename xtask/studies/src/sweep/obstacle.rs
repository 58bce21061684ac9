//! The configuration space obstacle of two bodies, as far as it has a closed form.

use workloads::line_entry::{capsule, cuboid};
use workloads::real::{DoubleDouble, Real};
use workloads::shapes::Shape;
use workloads::vec3::{Vec3, cross, dot, norm, scale, sub};

use super::hull::{Planes, difference};
use super::solid::{Form, Solid};

/// `A − B` relative to the difference of the places of `A` and `B`; or `A` alone, if there is no `B`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Obstacle<'a> {
    a: &'a Solid,
    b: Option<&'a Solid>,
    known: Option<&'a Known>,
}

/// An obstacle of closed form.
#[derive(Debug)]
pub(super) enum Known {
    /// One form, turned as the first body.
    LikeA(Form),
    /// One form, turned as the second body.
    LikeB(Form),
    Polytope(Planes),
    /// The points `α·u + β·w` with `|α|, |β| ≤ 1`, swept by a ball.
    Parallelogram {
        u: Vec3<DoubleDouble>,
        w: Vec3<DoubleDouble>,
        radius: DoubleDouble,
    },
}

impl Known {
    pub(super) fn of_one(a: &Solid) -> Self {
        Self::LikeA(a.form.clone())
    }

    /// The difference of two, wherever they are, if it has a closed form.
    pub(super) fn of(a: &Solid, b: &Solid) -> Option<Self> {
        let upright = |s: &Solid, half_height: f64| s.turned([0.0, half_height, 0.0].map(DoubleDouble::from));
        match (&a.form.shape, &b.form.shape) {
            (Shape::Ball { radius }, other) => swept(other, *radius).map(Self::LikeB),
            (other, Shape::Ball { radius }) => swept(other, *radius).map(Self::LikeA),
            (Shape::Capsule { half_height: h_a, radius: r_a }, Shape::Capsule { half_height: h_b, radius: r_b }) => {
                Some(Self::Parallelogram {
                    u: upright(a, *h_a),
                    w: upright(b, *h_b),
                    radius: DoubleDouble::from(*r_a) + DoubleDouble::from(*r_b),
                })
            }
            (Shape::Cylinder { half_height: h_a, radius: r_a }, Shape::Cylinder { half_height: h_b, radius: r_b })
                if a.rotation == b.rotation =>
            {
                Some(Self::LikeA(Shape::Cylinder { half_height: h_a + h_b, radius: r_a + r_b }.into()))
            }
            _ => Some(Self::Polytope(difference(&a.skeleton()?, &b.skeleton()?))),
        }
    }
}

impl<'a> Obstacle<'a> {
    pub(super) fn new(a: &'a Solid, b: Option<&'a Solid>, known: Option<&'a Known>) -> Self {
        Self { a, b, known }
    }

    pub(super) fn is_known(&self) -> bool {
        self.known.is_some()
    }

    /// The smallest `λ` at which the line `p + λ·d` is in the obstacle grown by a factor, if that has a closed form.
    pub(super) fn entry(&self, p: Vec3<DoubleDouble>, d: Vec3<DoubleDouble>, growth: f64) -> Option<DoubleDouble> {
        match self.known? {
            Known::LikeA(form) => form.entry(self.a.turned_back(p), self.a.turned_back(d), growth),
            Known::LikeB(form) => self.b.and_then(|b| form.entry(b.turned_back(p), b.turned_back(d), growth)),
            Known::Polytope(planes) => planes.entry(p, d, growth),
            Known::Parallelogram { u, w, radius } => {
                let g = DoubleDouble::from(growth);
                parallelogram(p, d, [scale(*u, g), scale(*w, g)], *radius * g)
            }
        }
    }

    /// The largest `n·y` of its points `y`.
    pub(super) fn support_value(&self, n: Vec3<DoubleDouble>) -> DoubleDouble {
        let of_a = self.a.support_value(n);
        self.b.map_or(of_a, |b| of_a + b.support_value(n.map(|c| -c)))
    }

    /// Half the size of its bounding box, for aiming at it.
    pub(super) fn bounds(&self) -> Vec3 {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|n| self.support_value(n.map(DoubleDouble::from)).f64())
    }

    /// The radius of a ball about its origin that contains it, and a little more.
    pub(super) fn reach(&self) -> f64 {
        self.a.form.reach() + self.b.map_or(0.0, |b| b.form.reach())
    }
}

/// The shape swept by a ball, and mirrored about the origin, which changes none of these.
fn swept(shape: &Shape, by: f64) -> Option<Form> {
    let swept = match *shape {
        Shape::Ball { radius } => Shape::Ball { radius: radius + by },
        Shape::Capsule { half_height, radius } => Shape::Capsule { half_height, radius: radius + by },
        Shape::Cuboid { half_extents } => Shape::RoundBox { half_extents, radius: by },
        Shape::RoundBox { half_extents, radius } => Shape::RoundBox { half_extents, radius: radius + by },
        Shape::Cylinder { .. } | Shape::Cone { .. } | Shape::Ellipsoid { .. } | Shape::Hull { .. } => return None,
    };
    Some(swept.into())
}

/// The union of a plate, twice the radius thick, and four capsules along its edges.
///
/// In coordinates `y = α·u + β·w + γ·n` with `n = u × w`, the plate is `|α|, |β| ≤ 1`, `|γ|·‖n‖ ≤ r`.
fn parallelogram(
    p: Vec3<DoubleDouble>,
    d: Vec3<DoubleDouble>,
    [u, w]: [Vec3<DoubleDouble>; 2],
    radius: DoubleDouble,
) -> Option<DoubleDouble> {
    let n = cross(u, w);
    let squared = dot(n, n);
    // The dual basis: α = y·(w × n)/n·n, β = y·(n × u)/n·n, γ = y·n/n·n.
    let dual = [cross(w, n), cross(n, u), n];
    let seen = |v: Vec3<DoubleDouble>| dual.map(|e| dot(v, e) / squared);
    let one = DoubleDouble::from(1.0);
    let plate = cuboid(seen(p), seen(d), [one, one, radius / squared.sqrt()]);
    let sides = [(w, u), (w.map(|c| -c), u), (u, w), (u.map(|c| -c), w)];
    let sides = sides.map(|(middle, half)| capsule_along(sub(p, middle), d, half, radius));
    [plate].into_iter().chain(sides).flatten().reduce(Real::min)
}

/// A capsule about zero along any axis.
fn capsule_along(
    p: Vec3<DoubleDouble>,
    d: Vec3<DoubleDouble>,
    half: Vec3<DoubleDouble>,
    radius: DoubleDouble,
) -> Option<DoubleDouble> {
    let length = norm(half);
    let axis = scale(half, DoubleDouble::from(1.0) / length);
    // Any two unit vectors that complete a frame.
    let least = (0..3).min_by(|&i, &j| axis[i].abs().f64().total_cmp(&axis[j].abs().f64())).unwrap_or(0);
    let unit = [0, 1, 2].map(|i| DoubleDouble::from(if i == least { 1.0 } else { 0.0 }));
    let first = sub(unit, scale(axis, dot(unit, axis)));
    let first = scale(first, DoubleDouble::from(1.0) / norm(first));
    let second = cross(axis, first);
    let seen = |v: Vec3<DoubleDouble>| [dot(v, first), dot(v, axis), dot(v, second)];
    capsule(seen(p), seen(d), 1, length, radius)
}
