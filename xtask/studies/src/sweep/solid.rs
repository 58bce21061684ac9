//! The bodies of the sweep: what is asked of the library, and what is true of them.

use convex_support::{Posed, Rotation, Scalar, SupportMap, Vector, Vector3};
use workloads::line_entry;
use workloads::real::{DoubleDouble, Real};
use workloads::shapes::Shape;
use workloads::vec3::{Vec3, add, dot, norm, scale, sub, wide};

use super::hull::{Hull, Skeleton};

/// A shape about the origin, and what spans it where it is a hull.
#[derive(Clone, Debug)]
pub(super) struct Form {
    pub(super) shape: Shape,
    hull: Option<Hull>,
}

/// A body of the library's.
pub(super) type Built<V> = Box<dyn SupportMap<Vector = V> + Send + Sync>;

pub(super) fn vector<V: Vector>(v: Vec3) -> V {
    V::from_fn(|i| V::Scalar::from_f64(v[i]))
}

/// The same coordinates as doubles, exactly.
pub(super) fn coordinates<V: Vector>(v: V) -> Vec3 {
    [0, 1, 2].map(|i| v.get(i).as_f64())
}

/// What becomes of a number in the precision of `V`.
pub(super) fn rounded<V: Vector>(x: f64) -> f64 {
    V::Scalar::from_f64(x).as_f64()
}

impl From<Shape> for Form {
    fn from(shape: Shape) -> Self {
        let hull = if let Shape::Hull { points } = &shape { Some(Hull::of(points)) } else { None };
        Self { shape, hull }
    }
}

impl Form {
    /// The form of that name, of size about one.
    pub(super) fn named(name: &str) -> Self {
        Shape::named(name).into()
    }

    /// The form in another unit, all numbers rounded to the precision of `V`.
    pub(super) fn sized<V: Vector>(&self, unit: f64) -> Self {
        self.shape.map(|x| rounded::<V>(x * unit)).into()
    }

    /// Whether its boundary is made of planes.
    pub(super) fn is_polytope(&self) -> bool {
        matches!(self.shape, Shape::Cuboid { .. } | Shape::Hull { .. })
    }

    fn skeleton(&self) -> Option<Skeleton> {
        let Shape::Cuboid { half_extents } = self.shape else {
            return self.hull.as_ref().map(|hull| hull.skeleton.clone());
        };
        let signs = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 });
        let corner = |bits: usize| wide(scaled(signs(bits), half_extents));
        let along = |axis: usize, s: f64| [0, 1, 2].map(|i| DoubleDouble::from(if i == axis { s } else { 0.0 }));
        let edges = (0..8).flat_map(|bits| (0..3).map(move |axis| (bits, axis)));
        let edges = edges.filter(|(bits, axis)| bits >> axis & 1 == 0);
        Some(Skeleton {
            vertices: (0..8).map(corner).collect(),
            normals: (0..3).flat_map(|axis| [along(axis, 1.0), along(axis, -1.0)]).collect(),
            edges: edges.map(|(bits, axis)| [corner(bits), along(axis, 2.0 * half_extents[axis])]).collect(),
        })
    }

    pub(super) fn build<V: Vector3>(&self) -> Built<V> {
        self.shape.build()
    }

    /// The radius of a ball about the origin that contains it, and a little more.
    pub(super) fn reach(&self) -> f64 {
        1.000_001
            * match &self.shape {
                Shape::Ball { radius } => *radius,
                Shape::Cuboid { half_extents } => norm(*half_extents),
                Shape::Cylinder { half_height, radius } | Shape::Cone { half_height, radius } => {
                    half_height.hypot(*radius)
                }
                Shape::Capsule { half_height, radius } => half_height + radius,
                Shape::Ellipsoid { semi_axes: [a, b, c] } => a.max(*b).max(*c),
                Shape::RoundBox { half_extents, radius } => norm(*half_extents) + radius,
                Shape::Hull { points } => points.iter().map(|&v| norm(v)).fold(0.0, f64::max),
            }
    }

    /// The largest `n·y` of its points `y`.
    pub(super) fn support_value(&self, n: Vec3<DoubleDouble>) -> DoubleDouble {
        let r = DoubleDouble::from;
        let corner = |h: &Vec3| n[0].abs() * r(h[0]) + n[1].abs() * r(h[1]) + n[2].abs() * r(h[2]);
        let disc = |radius: f64| (n[0] * n[0] + n[2] * n[2]).sqrt() * r(radius);
        match &self.shape {
            Shape::Ball { radius } => norm(n) * r(*radius),
            Shape::Cuboid { half_extents } => corner(half_extents),
            Shape::Cylinder { half_height, radius } => n[1].abs() * r(*half_height) + disc(*radius),
            Shape::Cone { half_height, radius } => (n[1] * r(*half_height)).max(disc(*radius) - n[1] * r(*half_height)),
            Shape::Capsule { half_height, radius } => n[1].abs() * r(*half_height) + norm(n) * r(*radius),
            Shape::Ellipsoid { semi_axes } => norm([0, 1, 2].map(|i| n[i] * r(semi_axes[i]))),
            Shape::RoundBox { half_extents, radius } => corner(half_extents) + norm(n) * r(*radius),
            Shape::Hull { .. } => self.hull.as_ref().map_or(r(0.0), |hull| hull.support_value(n)),
        }
    }

    /// How far `p` is from it, or beyond the planes of a hull; 0 in it.
    pub(super) fn outside(&self, p: Vec3<DoubleDouble>) -> f64 {
        let r = DoubleDouble::from;
        let zero = r(0.0);
        let beyond = |x: DoubleDouble, half: f64| (x.abs() - r(half)).max(zero);
        let from_box = |h: &Vec3| norm([0, 1, 2].map(|i| beyond(p[i], h[i])));
        let around = || (p[0] * p[0] + p[2] * p[2]).sqrt();
        let distance: DoubleDouble = match &self.shape {
            Shape::Ball { radius } => norm(p) - r(*radius),
            Shape::Cuboid { half_extents } => from_box(half_extents),
            Shape::Cylinder { half_height, radius } => {
                let (up, out) = (beyond(p[1], *half_height), (around() - r(*radius)).max(zero));
                (up * up + out * out).sqrt()
            }
            Shape::Cone { half_height, radius } => {
                // In the section through p: the triangle of the apex, the rim and the middle of the base.
                let (h, at) = (r(*half_height), [around(), p[1]]);
                let (apex, rim, base) = ([zero, h], [r(*radius), -h], [zero, -h]);
                if p[1] >= -h && at[0] * h * r(2.0) <= (h - p[1]) * r(*radius) {
                    zero
                } else {
                    from_segment(at, apex, rim).min(from_segment(at, base, rim))
                }
            }
            Shape::Capsule { half_height, radius } => norm([p[0], beyond(p[1], *half_height), p[2]]) - r(*radius),
            Shape::Ellipsoid { semi_axes } => from_ellipsoid(p, semi_axes.map(r)),
            Shape::RoundBox { half_extents, radius } => from_box(half_extents) - r(*radius),
            Shape::Hull { .. } => self.hull.as_ref().map_or(zero, |hull| hull.planes.beyond(p)),
        };
        distance.max(zero).f64()
    }

    /// The smallest `λ` at which the line `p + λ·d` is in the form grown about the origin by a factor; `None` if it
    /// misses.
    pub(super) fn entry(&self, p: Vec3<DoubleDouble>, d: Vec3<DoubleDouble>, growth: f64) -> Option<DoubleDouble> {
        match &self.hull {
            Some(hull) => hull.planes.entry(p, d, growth),
            None => line_entry::entry(&self.shape, p, d, growth),
        }
    }
}

fn scaled(v: Vec3, by: Vec3) -> Vec3 {
    [v[0] * by[0], v[1] * by[1], v[2] * by[2]]
}

/// The distance of a point of the plane from the segment between two others.
fn from_segment(p: [DoubleDouble; 2], a: [DoubleDouble; 2], b: [DoubleDouble; 2]) -> DoubleDouble {
    let minus = |p: [DoubleDouble; 2], q: [DoubleDouble; 2]| [p[0] - q[0], p[1] - q[1]];
    let dot = |p: [DoubleDouble; 2], q: [DoubleDouble; 2]| p[0] * q[0] + p[1] * q[1];
    let (along, seen) = (minus(b, a), minus(p, a));
    let part = (dot(seen, along) / dot(along, along)).max(DoubleDouble::from(0.0)).min(DoubleDouble::from(1.0));
    let off = minus(seen, along.map(|c| c * part));
    dot(off, off).sqrt()
}

/// The distance of a point from the ellipsoid with these semi-axes; 0 in it.
///
/// Its nearest point x has `xᵢ = aᵢ²pᵢ/(aᵢ² + t)`, and with `t` the sum of `(xᵢ/aᵢ)²` falls and is convex: Newton's
/// method rises from 0 to where it is 1.
fn from_ellipsoid(p: Vec3<DoubleDouble>, a: Vec3<DoubleDouble>) -> DoubleDouble {
    let (zero, one) = (DoubleDouble::from(0.0), DoubleDouble::from(1.0));
    let mut t = zero;
    for _ in 0..200 {
        let (mut beyond, mut slope) = (-one, zero);
        for i in 0..3 {
            let denominator = a[i] * a[i] + t;
            let part = a[i] * p[i] / denominator;
            beyond = beyond + part * part;
            slope = slope + part * part / denominator;
        }
        let step = beyond / (slope + slope);
        if step > t * DoubleDouble::from(1e-30) {
            t = t + step;
        } else {
            break;
        }
    }
    norm([0, 1, 2].map(|i| p[i] * t / (a[i] * a[i] + t)))
}

/// A form at a pose.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) form: Form,
    /// A quaternion of about unit length, `x`, `y`, `z`, `w`.
    pub(super) rotation: [f64; 4],
    pub(super) translation: Vec3,
    /// The rows of the rotation's matrix.
    pub(super) rows: [Vec3<DoubleDouble>; 3],
}

impl Solid {
    /// The form at a pose, whose numbers are numbers of the precision asked.
    pub(super) fn new(form: Form, rotation: [f64; 4], translation: Vec3) -> Self {
        let [x, y, z, w] = rotation.map(DoubleDouble::from);
        let (one, two) = (DoubleDouble::from(1.0), DoubleDouble::from(2.0));
        let s = two / (x * x + y * y + z * z + w * w);
        let rows = [
            [one - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
            [s * (x * y + w * z), one - s * (x * x + z * z), s * (y * z - w * x)],
            [s * (x * z - w * y), s * (y * z + w * x), one - s * (x * x + y * y)],
        ];
        Self { form, rotation, translation, rows }
    }

    pub(super) fn build<V: Vector3>(&self) -> Built<V> {
        let rotation = V::Rotation::from_xyzw(self.rotation.map(V::Scalar::from_f64));
        Box::new(
            Posed::new(self.form.build::<V>(), rotation, vector(self.translation))
                .expect("a pose of the sweep is finite"),
        )
    }

    /// In words, for a report of what went wrong.
    pub(super) fn described(&self) -> String {
        let form = match &self.form.shape {
            Shape::Hull { points } => format!("hull of {} vertices", points.len()),
            shape => format!("{shape:?}"),
        };
        format!("{form} turned by {:?} at {:?}", self.rotation, self.translation)
    }

    /// A direction or a difference of points, seen from the form.
    pub(super) fn turned_back(&self, v: Vec3<DoubleDouble>) -> Vec3<DoubleDouble> {
        let [x, y, z] = self.rows;
        add(add(scale(x, v[0]), scale(y, v[1])), scale(z, v[2]))
    }

    /// A direction or a difference of points of the form, seen from the world.
    pub(super) fn turned(&self, v: Vec3<DoubleDouble>) -> Vec3<DoubleDouble> {
        self.rows.map(|row| dot(row, v))
    }

    /// What spans its boundary relative to its place, if that is made of planes.
    pub(super) fn skeleton(&self) -> Option<Skeleton> {
        let Skeleton { vertices, normals, edges } = self.form.skeleton()?;
        let turned = |v: Vec<Vec3<DoubleDouble>>| v.into_iter().map(|v| self.turned(v)).collect();
        let edges = edges.into_iter().map(|edge| edge.map(|v| self.turned(v))).collect();
        Some(Skeleton { vertices: turned(vertices), normals: turned(normals), edges })
    }

    /// The largest `n·y` of the form's points `y`, relative to its place.
    pub(super) fn support_value(&self, n: Vec3<DoubleDouble>) -> DoubleDouble {
        self.form.support_value(self.turned_back(n))
    }

    /// How far a point of the world is from it; 0 in it.
    pub(super) fn outside(&self, p: Vec3<DoubleDouble>) -> f64 {
        self.form.outside(self.turned_back(sub(p, wide(self.translation))))
    }
}
