//! The bodies of the sweep: what is asked of the library, and what is true of them.

use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rotation, Rounded, Scalar, SupportMap, Vector,
    Vector3,
};

use super::hull::{Hull, Skeleton};
use super::real::{DoubleDouble, Real, Vec3, add, dot, norm, scale, sub, wide};
use workloads::rng::Rng;

/// A convex set about the origin; the y axis is the axis of symmetry, and the apex of a cone is up.
#[derive(Clone, Debug)]
pub(super) enum Form {
    Ball { radius: f64 },
    Cuboid { half_extents: Vec3<f64> },
    Cylinder { half_height: f64, radius: f64 },
    Cone { half_height: f64, radius: f64 },
    Capsule { half_height: f64, radius: f64 },
    Ellipsoid { semi_axes: Vec3<f64> },
    RoundBox { half_extents: Vec3<f64>, radius: f64 },
    Hull(Hull),
}

const VALID: &str = "the bodies of the sweep are valid";

/// A body of the library's.
pub(super) type Built<V> = Box<dyn SupportMap<Vector = V>>;

pub(super) fn vector<V: Vector>(v: Vec3<f64>) -> V {
    V::from_fn(|i| V::Scalar::from_f64(v[i]))
}

/// The same coordinates as doubles, exactly.
pub(super) fn coordinates<V: Vector>(v: V) -> Vec3<f64> {
    [0, 1, 2].map(|i| v.get(i).as_f64())
}

/// What becomes of a number in the precision of `V`.
pub(super) fn rounded<V: Vector>(x: f64) -> f64 {
    V::Scalar::from_f64(x).as_f64()
}

impl Form {
    /// The form of that name, of size about one.
    pub(super) fn named(name: &str) -> Self {
        match name {
            "ball" => Self::Ball { radius: 1.0 },
            "cuboid" => Self::Cuboid { half_extents: [1.0, 0.5, 0.25] },
            "cylinder" => Self::Cylinder { half_height: 0.75, radius: 0.5 },
            "cone" => Self::Cone { half_height: 0.75, radius: 0.625 },
            "capsule" => Self::Capsule { half_height: 0.625, radius: 0.375 },
            "ellipsoid" => Self::Ellipsoid { semi_axes: [1.0, 0.5, 0.1] },
            "roundbox" => Self::RoundBox { half_extents: [0.75, 0.375, 0.125], radius: 0.125 },
            name => {
                let count = name.strip_prefix("hull").and_then(|n| n.parse().ok()).expect("a hull and its vertices");
                // On an ellipsoid, so that all of them are vertices.
                let mut rng = Rng::new(count);
                Self::Hull(Hull::of((0..count).map(|_| scaled(rng.sphere(), [1.0, 0.8, 0.6])).collect()))
            }
        }
    }

    /// The form in another unit, all numbers rounded to the precision of `V`.
    pub(super) fn sized<V: Vector>(&self, unit: f64) -> Self {
        let r = |x: f64| rounded::<V>(x * unit);
        match self {
            Self::Ball { radius } => Self::Ball { radius: r(*radius) },
            Self::Cuboid { half_extents } => Self::Cuboid { half_extents: half_extents.map(r) },
            Self::Cylinder { half_height, radius } => {
                Self::Cylinder { half_height: r(*half_height), radius: r(*radius) }
            }
            Self::Cone { half_height, radius } => Self::Cone { half_height: r(*half_height), radius: r(*radius) },
            Self::Capsule { half_height, radius } => Self::Capsule { half_height: r(*half_height), radius: r(*radius) },
            Self::Ellipsoid { semi_axes } => Self::Ellipsoid { semi_axes: semi_axes.map(r) },
            Self::RoundBox { half_extents, radius } => {
                Self::RoundBox { half_extents: half_extents.map(r), radius: r(*radius) }
            }
            Self::Hull(hull) => Self::Hull(Hull::of(hull.vertices.iter().map(|v| v.map(r)).collect())),
        }
    }

    /// Whether its boundary is made of planes.
    pub(super) fn is_polytope(&self) -> bool {
        matches!(self, Self::Cuboid { .. } | Self::Hull(_))
    }

    fn skeleton(&self) -> Option<Skeleton> {
        match self {
            Self::Cuboid { half_extents } => {
                let signs = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 });
                let corner = |bits: usize| wide(scaled(signs(bits), *half_extents));
                let along =
                    |axis: usize, s: f64| [0, 1, 2].map(|i| DoubleDouble::from(if i == axis { s } else { 0.0 }));
                let edges = (0..8).flat_map(|bits| (0..3).map(move |axis| (bits, axis)));
                let edges = edges.filter(|(bits, axis)| bits >> axis & 1 == 0);
                Some(Skeleton {
                    vertices: (0..8).map(corner).collect(),
                    normals: (0..3).flat_map(|axis| [along(axis, 1.0), along(axis, -1.0)]).collect(),
                    edges: edges.map(|(bits, axis)| [corner(bits), along(axis, 2.0 * half_extents[axis])]).collect(),
                })
            }
            Self::Hull(hull) => Some(hull.skeleton.clone()),
            _ => None,
        }
    }

    pub(super) fn build<V: Vector3>(&self) -> Built<V> {
        let s = V::Scalar::from_f64;
        match self {
            Self::Ball { radius } => Box::new(Ball::<V>::new(s(*radius)).expect(VALID)),
            Self::Cuboid { half_extents } => Box::new(Cuboid::<V>::new(vector(*half_extents)).expect(VALID)),
            Self::Cylinder { half_height, radius } => {
                Box::new(Cylinder::<V>::new(s(*half_height), s(*radius)).expect(VALID))
            }
            Self::Cone { half_height, radius } => Box::new(Cone::<V>::new(s(*half_height), s(*radius)).expect(VALID)),
            Self::Capsule { half_height, radius } => {
                Box::new(Capsule::<V>::new(s(*half_height), s(*radius)).expect(VALID))
            }
            Self::Ellipsoid { semi_axes } => {
                Box::new(Ellipsoid::<V>::new(V::ZERO, vector(*semi_axes), V::Rotation::default()).expect(VALID))
            }
            Self::RoundBox { half_extents, radius } => {
                let core = Cuboid::<V>::new(vector(*half_extents)).expect(VALID);
                Box::new(Rounded::new(core, s(*radius)).expect(VALID))
            }
            Self::Hull(hull) => Box::new(Polytope::<V>::new(hull.vertices.iter().map(|&v| vector(v))).expect(VALID)),
        }
    }

    /// The radius of a ball about the origin that contains it, and a little more.
    pub(super) fn reach(&self) -> f64 {
        1.000_001
            * match self {
                Self::Ball { radius } => *radius,
                Self::Cuboid { half_extents } => norm(*half_extents),
                Self::Cylinder { half_height, radius } | Self::Cone { half_height, radius } => {
                    half_height.hypot(*radius)
                }
                Self::Capsule { half_height, radius } => half_height + radius,
                Self::Ellipsoid { semi_axes: [a, b, c] } => a.max(*b).max(*c),
                Self::RoundBox { half_extents, radius } => norm(*half_extents) + radius,
                Self::Hull(hull) => hull.vertices.iter().map(|&v| norm(v)).fold(0.0, f64::max),
            }
    }

    /// The largest `n·y` of its points `y`.
    pub(super) fn support_value(&self, n: Vec3<DoubleDouble>) -> DoubleDouble {
        let r = DoubleDouble::from;
        let corner = |h: &Vec3<f64>| n[0].abs() * r(h[0]) + n[1].abs() * r(h[1]) + n[2].abs() * r(h[2]);
        let disc = |radius: f64| (n[0] * n[0] + n[2] * n[2]).sqrt() * r(radius);
        match self {
            Self::Ball { radius } => norm(n) * r(*radius),
            Self::Cuboid { half_extents } => corner(half_extents),
            Self::Cylinder { half_height, radius } => n[1].abs() * r(*half_height) + disc(*radius),
            Self::Cone { half_height, radius } => (n[1] * r(*half_height)).max(disc(*radius) - n[1] * r(*half_height)),
            Self::Capsule { half_height, radius } => n[1].abs() * r(*half_height) + norm(n) * r(*radius),
            Self::Ellipsoid { semi_axes } => norm([0, 1, 2].map(|i| n[i] * r(semi_axes[i]))),
            Self::RoundBox { half_extents, radius } => corner(half_extents) + norm(n) * r(*radius),
            Self::Hull(hull) => hull.support_value(n),
        }
    }

    /// How far `p` is from it, or beyond the planes of a hull; 0 in it.
    pub(super) fn outside(&self, p: Vec3<DoubleDouble>) -> f64 {
        let r = DoubleDouble::from;
        let zero = r(0.0);
        let beyond = |x: DoubleDouble, half: f64| (x.abs() - r(half)).max(zero);
        let from_box = |h: &Vec3<f64>| norm([0, 1, 2].map(|i| beyond(p[i], h[i])));
        let around = || (p[0] * p[0] + p[2] * p[2]).sqrt();
        let distance: DoubleDouble = match self {
            Self::Ball { radius } => norm(p) - r(*radius),
            Self::Cuboid { half_extents } => from_box(half_extents),
            Self::Cylinder { half_height, radius } => {
                let (up, out) = (beyond(p[1], *half_height), (around() - r(*radius)).max(zero));
                (up * up + out * out).sqrt()
            }
            Self::Cone { half_height, radius } => {
                // In the section through p: the triangle of the apex, the rim and the middle of the base.
                let (h, at) = (r(*half_height), [around(), p[1]]);
                let (apex, rim, base) = ([zero, h], [r(*radius), -h], [zero, -h]);
                if p[1] >= -h && at[0] * h * r(2.0) <= (h - p[1]) * r(*radius) {
                    zero
                } else {
                    from_segment(at, apex, rim).min(from_segment(at, base, rim))
                }
            }
            Self::Capsule { half_height, radius } => norm([p[0], beyond(p[1], *half_height), p[2]]) - r(*radius),
            Self::Ellipsoid { semi_axes } => from_ellipsoid(p, semi_axes.map(r)),
            Self::RoundBox { half_extents, radius } => from_box(half_extents) - r(*radius),
            Self::Hull(hull) => hull.planes.beyond(p),
        };
        distance.max(zero).f64()
    }

    /// The smallest `λ` at which the line `p + λ·d` is in the form grown about the origin by a factor; `None` if it misses.
    pub(super) fn entry(&self, p: Vec3<DoubleDouble>, d: Vec3<DoubleDouble>, growth: f64) -> Option<DoubleDouble> {
        let g = |x: f64| DoubleDouble::from(x) * DoubleDouble::from(growth);
        match self {
            Self::Ball { radius } => ball(p, d, g(*radius)),
            Self::Cuboid { half_extents } => cuboid(p, d, half_extents.map(g)),
            Self::Cylinder { half_height, radius } => cylinder(p, d, 1, g(*half_height), g(*radius)),
            Self::Cone { half_height, radius } => cone(p, d, g(*half_height), g(*radius)),
            Self::Capsule { half_height, radius } => capsule(p, d, 1, g(*half_height), g(*radius)),
            Self::Ellipsoid { semi_axes } => {
                let unit = |v: Vec3<DoubleDouble>| [0, 1, 2].map(|i| v[i] / g(semi_axes[i]));
                ball(unit(p), unit(d), DoubleDouble::from(1.0))
            }
            Self::RoundBox { half_extents, radius } => round_box(p, d, half_extents.map(g), g(*radius)),
            Self::Hull(hull) => hull.planes.entry(p, d, growth),
        }
    }
}

fn scaled(v: Vec3<f64>, by: Vec3<f64>) -> Vec3<f64> {
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
/// Its nearest point x has `xᵢ = aᵢ²pᵢ/(aᵢ² + t)`, and with `t` the sum of `(xᵢ/aᵢ)²` falls and is convex: Newton's method rises
/// from 0 to where it is 1.
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

/// Both roots of `aλ² + 2bλ + c`, the smaller first if `a > 0`, neither by a difference of like numbers.
fn roots(a: DoubleDouble, b: DoubleDouble, c: DoubleDouble) -> Option<(DoubleDouble, DoubleDouble)> {
    let zero = DoubleDouble::from(0.0);
    let discriminant = b * b - a * c;
    if discriminant < zero {
        return None;
    }
    let root = discriminant.sqrt();
    Some(if b > zero { ((-b - root) / a, c / (-b - root)) } else { (c / (root - b), (root - b) / a) })
}

fn ball(p: Vec3<DoubleDouble>, d: Vec3<DoubleDouble>, radius: DoubleDouble) -> Option<DoubleDouble> {
    roots(dot(d, d), dot(p, d), dot(p, p) - radius * radius).map(|(first, _)| first)
}

/// Where `|p + λ·d| ≤ half` begins and ends.
fn slab(p: DoubleDouble, d: DoubleDouble, half: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let zero = DoubleDouble::from(0.0);
    if d == zero {
        let everywhere = DoubleDouble::from(f64::MAX);
        return if p.abs() <= half { (-everywhere, everywhere) } else { (everywhere, -everywhere) };
    }
    let (low, high) = ((-half - p) / d, (half - p) / d);
    (low.min(high), low.max(high))
}

/// The latest entry into the three slabs, if it precedes the earliest exit.
pub(super) fn cuboid(p: Vec3<DoubleDouble>, d: Vec3<DoubleDouble>, half: Vec3<DoubleDouble>) -> Option<DoubleDouble> {
    let [x, y, z] = [0, 1, 2].map(|i| slab(p[i], d[i], half[i]));
    let (entry, exit) = (x.0.max(y.0).max(z.0), x.1.min(y.1).min(z.1));
    (entry <= exit).then_some(entry)
}

/// The cylinder about the given coordinate axis.
fn cylinder(
    p: Vec3<DoubleDouble>,
    d: Vec3<DoubleDouble>,
    axis: usize,
    half_height: DoubleDouble,
    radius: DoubleDouble,
) -> Option<DoubleDouble> {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (a, c) = (d[i] * d[i] + d[j] * d[j], p[i] * p[i] + p[j] * p[j] - radius * radius);
    let flat = slab(p[axis], d[axis], half_height);
    if a == DoubleDouble::from(0.0) {
        return (c <= a).then_some(flat.0);
    }
    let round = roots(a, p[i] * d[i] + p[j] * d[j], c)?;
    let (entry, exit) = (round.0.max(flat.0), round.1.min(flat.1));
    (entry <= exit).then_some(entry)
}

/// The first of the points on the side and on the base.
///
/// With `w` the depth below the apex and `k` the slope of the side, the double cone is `x² + z² = k²w²`; of its two roots
/// only those between base and apex belong to the cone.
fn cone(
    p: Vec3<DoubleDouble>,
    d: Vec3<DoubleDouble>,
    half_height: DoubleDouble,
    radius: DoubleDouble,
) -> Option<DoubleDouble> {
    let slope = radius / (half_height + half_height);
    let (k2, w) = (slope * slope, half_height - p[1]);
    let side = roots(
        d[0] * d[0] + d[2] * d[2] - k2 * d[1] * d[1],
        p[0] * d[0] + p[2] * d[2] + k2 * w * d[1],
        p[0] * p[0] + p[2] * p[2] - k2 * w * w,
    );
    let on_side = side.into_iter().flat_map(|(s, t)| [s, t]).filter(|&t| (p[1] + t * d[1]).abs() <= half_height);
    let base = (-half_height - p[1]) / d[1];
    let [x, _, z] = add(p, scale(d, base));
    let on_base = (x * x + z * z <= radius * radius).then_some(base);
    on_side.chain(on_base).reduce(DoubleDouble::min)
}

/// The union of a cylinder and two balls, about the given coordinate axis.
pub(super) fn capsule(
    p: Vec3<DoubleDouble>,
    d: Vec3<DoubleDouble>,
    axis: usize,
    half_height: DoubleDouble,
    radius: DoubleDouble,
) -> Option<DoubleDouble> {
    let end = |height: DoubleDouble| {
        let mut center = [DoubleDouble::from(0.0); 3];
        center[axis] = height;
        ball(sub(p, center), d, radius)
    };
    let parts = [cylinder(p, d, axis, half_height, radius), end(half_height), end(-half_height)];
    parts.into_iter().flatten().reduce(DoubleDouble::min)
}

/// The union of three boxes and twelve capsules.
fn round_box(
    p: Vec3<DoubleDouble>,
    d: Vec3<DoubleDouble>,
    half: Vec3<DoubleDouble>,
    radius: DoubleDouble,
) -> Option<DoubleDouble> {
    let mut first: Option<DoubleDouble> = None;
    let mut join = |part: Option<DoubleDouble>| {
        if let Some(part) = part {
            first = Some(first.map_or(part, |first| first.min(part)));
        }
    };
    for axis in 0..3 {
        let mut widened = half;
        widened[axis] = widened[axis] + radius;
        join(cuboid(p, d, widened));
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        for (s, t) in [(half[i], half[j]), (half[i], -half[j]), (-half[i], half[j]), (-half[i], -half[j])] {
            let mut edge = [DoubleDouble::from(0.0); 3];
            (edge[i], edge[j]) = (s, t);
            join(capsule(sub(p, edge), d, axis, half[axis], radius));
        }
    }
    first
}

/// A form at a pose.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) form: Form,
    /// A quaternion of about unit length, `x`, `y`, `z`, `w`.
    pub(super) rotation: [f64; 4],
    pub(super) translation: Vec3<f64>,
    /// The rows of the rotation's matrix.
    rows: [Vec3<DoubleDouble>; 3],
}

impl Solid {
    /// The form at a pose, whose numbers are numbers of the precision asked.
    pub(super) fn new(form: Form, rotation: [f64; 4], translation: Vec3<f64>) -> Self {
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
        Box::new(Posed::new(self.form.build::<V>(), rotation, vector(self.translation)).expect(VALID))
    }

    /// In words, for a report of what went wrong.
    pub(super) fn described(&self) -> String {
        let form = match &self.form {
            Form::Hull(hull) => format!("hull of {} vertices", hull.vertices.len()),
            form => format!("{form:?}"),
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
