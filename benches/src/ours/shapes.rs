//! The shapes of the workloads as those of convex-support, in either precision.

use convex_support::glam::{DQuat, DVec3, Quat, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Faceted, InvalidShape, Polytope, Rounded, Scalar, SupportMap,
    Vector3,
};
use workloads::pairs::Pair;
use workloads::shapes::Shape;
use workloads::vec3::Vec3;

use crate::measure::Solver;

/// The vectors that are measured.
pub trait Space: Vector3 {
    /// A rotation from a unit quaternion.
    fn rotation(q: workloads::vec3::Quat) -> Self::Rotation;
}

impl Space for DVec3 {
    fn rotation(q: workloads::vec3::Quat) -> DQuat {
        DQuat::from_array(q)
    }
}

impl Space for Vec3A {
    #[allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is the purpose")]
    fn rotation(q: workloads::vec3::Quat) -> Quat {
        Quat::from_array(q.map(|x| x as f32))
    }
}

pub(super) fn number<V: Space>(x: f64) -> V::Scalar {
    V::Scalar::from_f64(x)
}

pub(super) fn vector<V: Space>(v: Vec3) -> V {
    V::from_fn(|i| number::<V>(v[i]))
}

/// Why a shape of the workloads should always be one.
pub const VALID: &str = "the shapes and poses of the workloads are valid";

/// Makes a solver from a shape of any type.
pub trait Task<V: Space> {
    /// The solver that asks this of the shape.
    fn solver<S: SupportMap<Vector = V> + 'static>(self, shape: S) -> Solver;
}

/// Makes a solver from two shapes of any types.
pub trait PairTask<V: Space> {
    /// The solver that asks this of the shapes.
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static;
}

/// Makes a task's solver from shapes behind `dyn SupportMap`.
#[derive(Clone, Copy, Debug)]
pub struct Boxed<T>(pub T);

impl<V: Space, T: Task<V>> Task<V> for Boxed<T> {
    fn solver<S: SupportMap<Vector = V> + 'static>(self, shape: S) -> Solver {
        self.0.solver(boxed(shape))
    }
}

impl<V: Space, T: PairTask<V>> PairTask<V> for Boxed<T> {
    fn solver<A, B>(self, a: A, b: B) -> Solver
    where
        A: SupportMap<Vector = V> + 'static,
        B: SupportMap<Vector = V> + 'static,
    {
        self.0.solver(boxed(a), boxed(b))
    }
}

fn boxed<S: SupportMap + 'static>(shape: S) -> Box<dyn SupportMap<Vector = S::Vector>> {
    Box::new(shape)
}

/// A shape of convex-support that is one of the workloads'.
pub trait OfWorkload: SupportMap<Vector: Space> + Sized + 'static {
    /// The shape.
    ///
    /// # Errors
    /// Where the shape is of this kind, and no valid one.
    ///
    /// # Panics
    /// For a shape of another kind.
    fn of(shape: &Shape) -> Result<Self, InvalidShape>;
}

fn wrong_kind(shape: &Shape, kind: &str) -> ! {
    panic!("{shape:?} is no {kind}")
}

impl<V: Space> OfWorkload for Ball<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::Ball { radius } = shape else { wrong_kind(shape, "ball") };
        Self::new(number::<V>(radius))
    }
}

impl<V: Space> OfWorkload for Cuboid<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::Cuboid { half_extents } = shape else { wrong_kind(shape, "cuboid") };
        Self::new(vector(half_extents))
    }
}

impl<V: Space> OfWorkload for Cylinder<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::Cylinder { half_height, radius } = shape else { wrong_kind(shape, "cylinder") };
        Self::new(number::<V>(half_height), number::<V>(radius))
    }
}

impl<V: Space> OfWorkload for Cone<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::Cone { half_height, radius } = shape else { wrong_kind(shape, "cone") };
        Self::new(number::<V>(half_height), number::<V>(radius))
    }
}

impl<V: Space> OfWorkload for Capsule<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::Capsule { half_height, radius } = shape else { wrong_kind(shape, "capsule") };
        Self::new(number::<V>(half_height), number::<V>(radius))
    }
}

impl<V: Space> OfWorkload for Ellipsoid<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::Ellipsoid { semi_axes } = shape else { wrong_kind(shape, "ellipsoid") };
        Self::new(V::ZERO, vector(semi_axes), V::Rotation::default())
    }
}

impl<V: Space> OfWorkload for Rounded<Cuboid<V>> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let &Shape::RoundBox { half_extents, radius } = shape else { wrong_kind(shape, "rounded box") };
        Self::new(Cuboid::new(vector(half_extents))?, number::<V>(radius))
    }
}

impl<V: Space> OfWorkload for Polytope<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let Shape::Hull { points } = shape else { wrong_kind(shape, "hull") };
        Self::hull_of(points.iter().map(|&p| vector(p)))
    }
}

impl<V: Space> OfWorkload for Faceted<V> {
    fn of(shape: &Shape) -> Result<Self, InvalidShape> {
        let Shape::Hull { points } = shape else { wrong_kind(shape, "hull") };
        Self::hull_of(points.iter().map(|&p| vector(p)))
    }
}

/// The solver of a task for a shape of a known type: only that is compiled.
pub fn with<S: OfWorkload>(shape: &Shape, task: impl Task<S::Vector>) -> Solver {
    task.solver(S::of(shape).expect(VALID))
}

/// The solver of a task for two shapes of known types: only those are compiled.
pub fn with_both<A, B>(pair: &Pair, task: impl PairTask<A::Vector>) -> Solver
where
    A: OfWorkload,
    B: OfWorkload<Vector = A::Vector>,
{
    task.solver(A::of(&pair.a).expect(VALID), B::of(&pair.b).expect(VALID))
}

/// The solver of a task for any shape.
pub fn with_shape<V: Space>(shape: &Shape, task: impl Task<V>) -> Solver {
    match shape {
        Shape::Ball { .. } => with::<Ball<V>>(shape, task),
        Shape::Cuboid { .. } => with::<Cuboid<V>>(shape, task),
        Shape::Cylinder { .. } => with::<Cylinder<V>>(shape, task),
        Shape::Cone { .. } => with::<Cone<V>>(shape, task),
        Shape::Capsule { .. } => with::<Capsule<V>>(shape, task),
        Shape::Ellipsoid { .. } => with::<Ellipsoid<V>>(shape, task),
        Shape::Hull { .. } => with::<Polytope<V>>(shape, task),
        Shape::RoundBox { .. } => with::<Rounded<Cuboid<V>>>(shape, task),
    }
}

/// The solver of a task for any pair of the workloads.
///
/// # Panics
/// For two shapes that are no pair of the workloads.
pub fn with_pair<V: Space>(pair: &Pair, task: impl PairTask<V>) -> Solver {
    match (&pair.a, &pair.b) {
        (Shape::Ball { .. }, Shape::Cuboid { .. }) => with_both::<Ball<V>, Cuboid<V>>(pair, task),
        (Shape::Cuboid { .. }, Shape::Cuboid { .. }) => with_both::<Cuboid<V>, Cuboid<V>>(pair, task),
        (Shape::Cylinder { .. }, Shape::Cone { .. }) => with_both::<Cylinder<V>, Cone<V>>(pair, task),
        (Shape::Capsule { .. }, Shape::Ellipsoid { .. }) => with_both::<Capsule<V>, Ellipsoid<V>>(pair, task),
        (Shape::Ellipsoid { .. }, Shape::Ellipsoid { .. }) => with_both::<Ellipsoid<V>, Ellipsoid<V>>(pair, task),
        (Shape::Hull { .. }, Shape::Hull { .. }) => with_both::<Polytope<V>, Polytope<V>>(pair, task),
        (Shape::RoundBox { .. }, Shape::RoundBox { .. }) => {
            with_both::<Rounded<Cuboid<V>>, Rounded<Cuboid<V>>>(pair, task)
        }
        (Shape::Cuboid { .. }, Shape::Hull { .. }) => with_both::<Cuboid<V>, Polytope<V>>(pair, task),
        (Shape::Capsule { .. }, Shape::Capsule { .. }) => with_both::<Capsule<V>, Capsule<V>>(pair, task),
        pair => panic!("no pair of the workloads: {pair:?}"),
    }
}
