//! The workloads answered by this workspace. What is asked of two shapes is a [task](tasks), and makes a solver of
//! shapes of any types; the functions here do so for all shapes of the workloads in either precision, each compiled
//! once: what calls them is not generic.
//!
//! They are `#[inline]`, here and in [`rows`](crate::rows), so that a program compiles those that it asks, and not all
//! with the library.

pub mod shapes;
pub mod tasks;

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Faceted, Rounded};
use gjk_raycast::{CastMethod, DistanceOptions, RayCastOptions, SubAlgorithm};
use workloads::pairs::Pair;
use workloads::score::Precision;
use workloads::shapes::Shape;
use workloads::w1_ray_cast::Ray;
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;

use crate::measure::Solver;
use shapes::{Boxed, PairTask, Space, Task, with, with_pair, with_shape};
use tasks::{Distances, Intersections, LinearCasts, RayCasts, crossings};

/// How hard `gjk-raycast` is to try, and what its solvers are to tell. By default its own options, and the answer.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The relative tolerance; rounding ends the iteration in any case.
    pub tolerance: f64,
    /// The iterations after which to give up.
    pub max_iterations: usize,
    /// How the closest point of a simplex is found.
    pub sub_algorithm: SubAlgorithm,
    /// How the planes of a ray cast are found.
    pub method: CastMethod,
    /// Whether the support points that were computed of each body are told in place of the answer.
    pub iterations: bool,
    /// Whether shapes come as `Box<dyn SupportMap>`.
    pub boxed: bool,
    /// Whether a hull knows its facets, as it does where it is to be hit by rays and small.
    pub faceted: bool,
}

impl Default for Effort {
    fn default() -> Self {
        let options = DistanceOptions::<DVec3>::default();
        Self {
            tolerance: options.tolerance,
            max_iterations: options.max_iterations,
            sub_algorithm: options.sub_algorithm,
            method: RayCastOptions::<DVec3>::default().method,
            iterations: false,
            boxed: false,
            faceted: false,
        }
    }
}

impl Effort {
    /// What a solver answers.
    fn tell(self, answer: f64, iterations: usize) -> f64 {
        if self.iterations { iterations as f64 } else { answer }
    }
}

/// Ray casts by GJK.
#[inline]
#[must_use]
pub fn ray_casts(precision: Precision, shape: &Shape, rays: &[Ray], effort: Effort) -> Solver {
    of_shape(precision, shape, RayCasts(rays, effort), effort)
}

/// Ray casts in closed form.
#[inline]
#[must_use]
pub fn closed_form_ray_casts(precision: Precision, shape: &Shape, rays: &[Ray]) -> Solver {
    match precision {
        Precision::Double => crossings_of::<DVec3>(shape, rays),
        Precision::Single => crossings_of::<Vec3A>(shape, rays),
    }
}

fn crossings_of<V: Space>(shape: &Shape, rays: &[Ray]) -> Solver {
    match shape {
        Shape::Ball { .. } => crossings::<Ball<V>>(shape, rays),
        Shape::Cuboid { .. } => crossings::<Cuboid<V>>(shape, rays),
        Shape::Cylinder { .. } => crossings::<Cylinder<V>>(shape, rays),
        Shape::Cone { .. } => crossings::<Cone<V>>(shape, rays),
        Shape::Capsule { .. } => crossings::<Capsule<V>>(shape, rays),
        Shape::Ellipsoid { .. } => crossings::<Ellipsoid<V>>(shape, rays),
        Shape::Hull { .. } => crossings::<Faceted<V>>(shape, rays),
        Shape::RoundBox { .. } => crossings::<Rounded<Cuboid<V>>>(shape, rays),
    }
}

/// The solver of a task for any shape; of hulls, if wanted, with their facets, by which alone a closed form is known of
/// them.
fn with_facets<V: Space>(shape: &Shape, task: impl Task<V>, faceted: bool) -> Solver {
    if faceted && let Shape::Hull { .. } = shape { with::<Faceted<V>>(shape, task) } else { with_shape(shape, task) }
}

/// Linear casts.
#[inline]
#[must_use]
pub fn linear_casts(precision: Precision, pair: &Pair, casts: &[Cast], effort: Effort) -> Solver {
    of_pair(precision, pair, LinearCasts(casts, effort), effort)
}

/// Distances.
#[inline]
#[must_use]
pub fn distances(precision: Precision, pair: &Pair, queries: &[DistanceQuery], effort: Effort) -> Solver {
    of_pair(precision, pair, Distances(queries, effort), effort)
}

/// Intersection tests; `is_warm` ones are given the axis, if any, that the same query answered with before.
#[inline]
#[must_use]
pub fn intersections(
    precision: Precision,
    pair: &Pair,
    queries: &[IntersectQuery],
    is_warm: bool,
    effort: Effort,
) -> Solver {
    of_pair(precision, pair, Intersections { queries, is_warm, effort }, effort)
}

fn of_shape(precision: Precision, shape: &Shape, task: impl Task<DVec3> + Task<Vec3A>, effort: Effort) -> Solver {
    match (precision, effort.boxed) {
        (Precision::Double, false) => with_facets::<DVec3>(shape, task, effort.faceted),
        (Precision::Double, true) => with_facets::<DVec3>(shape, Boxed(task), effort.faceted),
        (Precision::Single, false) => with_facets::<Vec3A>(shape, task, effort.faceted),
        (Precision::Single, true) => with_facets::<Vec3A>(shape, Boxed(task), effort.faceted),
    }
}

fn of_pair(precision: Precision, pair: &Pair, task: impl PairTask<DVec3> + PairTask<Vec3A>, effort: Effort) -> Solver {
    match (precision, effort.boxed) {
        (Precision::Double, false) => with_pair::<DVec3>(pair, task),
        (Precision::Double, true) => with_pair::<DVec3>(pair, Boxed(task)),
        (Precision::Single, false) => with_pair::<Vec3A>(pair, task),
        (Precision::Single, true) => with_pair::<Vec3A>(pair, Boxed(task)),
    }
}
