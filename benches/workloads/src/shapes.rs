//! The eleven shapes of the workloads, as plain numbers.

use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Rounded, Scalar, SupportMap, Vector3,
};

use crate::convex_hull::facets;
use crate::rng::{Rng, round_to_f32};
use crate::vec3::{Vec3, add, cross, dot, norm, scale, sub};

/// A convex shape about the origin; the y axis is the axis of symmetry.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A ball.
    Ball {
        /// Its radius.
        radius: f64,
    },
    /// A box.
    Cuboid {
        /// Half the size along each axis.
        half_extents: Vec3,
    },
    /// A cylinder.
    Cylinder {
        /// Half the length of the axis.
        half_height: f64,
        /// The radius of the discs.
        radius: f64,
    },
    /// A cone with its apex at `(0, half_height, 0)`.
    Cone {
        /// Half the length of the axis.
        half_height: f64,
        /// The radius of the base.
        radius: f64,
    },
    /// A segment swept by a ball.
    Capsule {
        /// Half the length of the segment.
        half_height: f64,
        /// The radius of the ball.
        radius: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Half the size along each axis.
        semi_axes: Vec3,
    },
    /// The convex hull of points.
    Hull {
        /// The points; all are vertices of the hull.
        points: Vec<Vec3>,
    },
    /// A box swept by a ball.
    RoundBox {
        /// Half the size of the box along each axis.
        half_extents: Vec3,
        /// The radius of the ball.
        radius: f64,
    },
}

/// Names of the shapes, in the order of their numbers.
pub const SHAPE_NAMES: [&str; 11] = [
    "ball",
    "cuboid",
    "cylinder",
    "cone",
    "capsule",
    "ellipsoid",
    "hull16",
    "hull64",
    "hull256",
    "hull1024",
    "roundbox",
];

/// The points of `hull16`, `hull64` and so on: `count` of them on an ellipsoid, exact in `f32`.
#[must_use]
pub fn hull_points(count: u16) -> Vec<Vec3> {
    let mut rng = Rng::new(100 + u64::from(count));
    let on_ellipsoid = |[x, y, z]: Vec3| [x, y * 0.8, z * 0.6].map(round_to_f32);
    (0..count).map(|_| on_ellipsoid(rng.sphere())).collect()
}

impl Shape {
    /// The shape of that name.
    ///
    /// # Panics
    /// If it is none of [`SHAPE_NAMES`], and no hull of another number of points.
    #[must_use]
    pub fn named(name: &str) -> Self {
        match name {
            "ball" => Self::Ball { radius: 1.0 },
            "cuboid" => Self::Cuboid { half_extents: [1.0, 0.5, 0.25] },
            "cylinder" => Self::Cylinder { half_height: 0.75, radius: 0.5 },
            "cone" => Self::Cone { half_height: 0.75, radius: 0.625 },
            "capsule" => Self::Capsule { half_height: 0.625, radius: 0.375 },
            "ellipsoid" => Self::Ellipsoid { semi_axes: [1.0, 0.5, 0.1] },
            "roundbox" => Self::RoundBox { half_extents: [0.75, 0.375, 0.125], radius: 0.125 },
            _ => match name.strip_prefix("hull").and_then(|count| count.parse().ok()) {
                Some(count) => Self::Hull { points: hull_points(count) },
                None => panic!("no shape is called {name:?}: there are {SHAPE_NAMES:?}"),
            },
        }
    }

    /// Half the size of the bounding box; for the hulls, that of the ellipsoid their vertices lie on.
    #[must_use]
    pub fn bounds(&self) -> Vec3 {
        match *self {
            Self::Ball { radius } => [radius; 3],
            Self::Cuboid { half_extents } => half_extents,
            Self::Cylinder { half_height, radius } | Self::Cone { half_height, radius } => {
                [radius, half_height, radius]
            }
            Self::Capsule { half_height, radius } => [radius, half_height + radius, radius],
            Self::Ellipsoid { semi_axes } => semi_axes,
            Self::Hull { .. } => [1.0, 0.8, 0.6],
            Self::RoundBox { half_extents, radius } => add(half_extents, [radius; 3]),
        }
    }

    /// The shape whose every number is what `f` makes of it.
    #[must_use]
    pub fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Ball { radius } => Self::Ball { radius: f(*radius) },
            Self::Cuboid { half_extents } => Self::Cuboid { half_extents: half_extents.map(f) },
            Self::Cylinder { half_height, radius } => {
                Self::Cylinder { half_height: f(*half_height), radius: f(*radius) }
            }
            Self::Cone { half_height, radius } => Self::Cone { half_height: f(*half_height), radius: f(*radius) },
            Self::Capsule { half_height, radius } => Self::Capsule { half_height: f(*half_height), radius: f(*radius) },
            Self::Ellipsoid { semi_axes } => Self::Ellipsoid { semi_axes: semi_axes.map(f) },
            Self::Hull { points } => Self::Hull { points: points.iter().map(|point| point.map(&f)).collect() },
            Self::RoundBox { half_extents, radius } => {
                Self::RoundBox { half_extents: half_extents.map(&f), radius: f(*radius) }
            }
        }
    }

    /// The shape as one of `convex-support`, its numbers rounded to the precision of `V`. A hull scans all of its
    /// points.
    ///
    /// # Panics
    /// If its numbers are out of the range of that precision.
    #[must_use]
    pub fn build<V: Vector3>(&self) -> Box<dyn SupportMap<Vector = V> + Send + Sync> {
        const VALID: &str = "the numbers are positive, and in the range of the precision";
        let s = V::Scalar::from_f64;
        let vector = |v: Vec3| V::from_fn(|i| s(v[i]));
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
            Self::Hull { points } => Box::new(Polytope::<V>::new(points.iter().map(|&p| vector(p))).expect(VALID)),
            Self::RoundBox { half_extents, radius } => {
                let core = Cuboid::<V>::new(vector(*half_extents)).expect(VALID);
                Box::new(Rounded::new(core, s(*radius)).expect(VALID))
            }
        }
    }

    /// The point farthest along `direction`.
    pub(crate) fn support(&self, direction: Vec3) -> Vec3 {
        let [x, y, z] = direction;
        match self {
            Self::Ball { radius } => swept(*radius, direction),
            Self::Cuboid { half_extents } => corner(*half_extents, direction),
            Self::Cylinder { half_height, radius } => {
                add(swept(*radius, [x, 0.0, z]), [0.0, if y >= 0.0 { *half_height } else { -half_height }, 0.0])
            }
            Self::Cone { half_height, radius } => {
                let (apex, base) =
                    ([0.0, *half_height, 0.0], add(swept(*radius, [x, 0.0, z]), [0.0, -half_height, 0.0]));
                if dot(direction, apex) >= dot(direction, base) { apex } else { base }
            }
            Self::Capsule { half_height, radius } => {
                add(swept(*radius, direction), [0.0, if y >= 0.0 { *half_height } else { -half_height }, 0.0])
            }
            Self::Ellipsoid { semi_axes: [a, b, c] } => {
                let [i, j, k] = swept(1.0, [a * x, b * y, c * z]);
                [a * i, b * j, c * k]
            }
            Self::Hull { points } => farthest(points, direction),
            Self::RoundBox { half_extents, radius } => add(corner(*half_extents, direction), swept(*radius, direction)),
        }
    }
}

/// A triangle in each face of a box or a hull, counter-clockwise from outside.
///
/// # Panics
/// For any other shape.
pub(crate) fn face_triangles(shape: &Shape) -> Vec<[Vec3; 3]> {
    match shape {
        Shape::Cuboid { half_extents } => {
            let triangle = |axis: usize, side: f64| {
                let corner = |j: f64, k: f64| {
                    let mut signs = [side; 3];
                    (signs[(axis + 1) % 3], signs[(axis + 2) % 3]) = (j, side * k);
                    corner(*half_extents, signs)
                };
                [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0)]
            };
            (0..3).flat_map(|axis| [1.0, -1.0].map(|side| triangle(axis, side))).collect()
        }
        Shape::Hull { points } => facets::<f64>(points).into_iter().map(|facet| facet.map(|i| points[i])).collect(),
        _ => panic!("{shape:?} has curved faces"),
    }
}

/// A point well inside one of the triangles, and the triangle's unit normal.
pub(crate) fn point_inside(triangles: &[[Vec3; 3]], rng: &mut Rng) -> (Vec3, Vec3) {
    let [a, b, c] = triangles[rng.below(triangles.len() as u64) as usize];
    let weights = [0; 3].map(|_| 0.25 + rng.unit());
    let sum: f64 = weights.iter().sum();
    let point = [0, 1, 2].map(|i| (weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i]) / sum);
    let normal = cross(sub(b, a), sub(c, a));
    (point, scale(normal, 1.0 / norm(normal)))
}

/// The point of the ball about zero farthest along `direction`.
fn swept(radius: f64, direction: Vec3) -> Vec3 {
    let length = dot(direction, direction).sqrt();
    if length > 0.0 { scale(direction, radius / length) } else { [0.0; 3] }
}

/// The corner of the box farthest along `direction`.
fn corner([a, b, c]: Vec3, [x, y, z]: Vec3) -> Vec3 {
    [if x >= 0.0 { a } else { -a }, if y >= 0.0 { b } else { -b }, if z >= 0.0 { c } else { -c }]
}

fn farthest(points: &[Vec3], direction: Vec3) -> Vec3 {
    let mut best = (f64::NEG_INFINITY, [0.0; 3]);
    for &point in points {
        let reach = dot(point, direction);
        if reach > best.0 {
            best = (reach, point);
        }
    }
    best.1
}
