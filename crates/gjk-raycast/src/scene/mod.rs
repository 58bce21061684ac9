//! One ray against many bodies.

use alloc::vec::Vec;

use convex_support::{
    Ball, BoundingSphere, Crossing, Scalar, ScalarOf, SupportMap, Vector, bounding_sphere, line_crossing,
};
use num_traits::Float;

use crate::{Outcome, Ray, RayCastError, RayCastOptions, RayHit, ray_cast};

/// Bodies, each with a ball around it, for rays that ask which body they hit first.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, SupportMap, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, Scene};
///
/// type Body = Box<dyn SupportMap<Vector = DVec3>>;
/// let at = |x, y| DVec3::new(x, y, 0.0);
/// let scene = Scene::new([
///     Box::new(Posed::translated(Ball::new(1.0)?, at(20.0, 0.0))?) as Body,
///     Box::new(Posed::translated(Cuboid::new(DVec3::ONE)?, at(10.0, 0.0))?) as Body,
///     Box::new(Posed::translated(Cuboid::new(DVec3::ONE)?, at(10.0, 8.0))?) as Body,
/// ]);
/// let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
/// let answer = scene.ray_cast(ray, RayCastOptions::default())?;
/// let first = answer.first.ok_or("two are in the way")?;
/// assert_eq!((first.body, first.hit.lambda), (1, 9.0));
/// assert_eq!((answer.tested, answer.culled), (1, 2)); // one is beside the ray, and one behind the hit
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene<S: SupportMap> {
    bodies: Vec<S>,
    spheres: Vec<BoundingSphere<S::Vector>>,
}

/// The first body in the way of a ray, and what was done to find it.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct SceneRayCast<V: Vector> {
    /// The first hit; `None` where every body is missed. Of bodies hit at the same λ, the one with the lowest index.
    pub first: Option<FirstHit<V>>,
    /// No point of the ray before this parameter is in any body.
    pub lower: V::Scalar,
    /// Bodies that a cast was made for.
    pub tested: usize,
    /// Bodies that were left out, because the ray misses the ball around them or reaches it only behind the first hit.
    pub culled: usize,
    /// The lowest index of a body whose cast was [undecided](Outcome::Undecided), if there is one: it may be in the way
    /// from [`lower`](Self::lower) on.
    pub undecided: Option<usize>,
}

/// Which body is hit, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit<V: Vector> {
    /// The index of the body.
    pub body: usize,
    /// The hit, as [`ray_cast`] answers it for this body alone.
    pub hit: RayHit<V>,
}

impl<S: SupportMap> Scene<S> {
    /// The scene of these bodies; their balls are found now.
    pub fn new(bodies: impl IntoIterator<Item = S>) -> Self {
        let bodies: Vec<S> = bodies.into_iter().collect();
        let spheres = bodies.iter().map(bounding_sphere).collect();
        Self { bodies, spheres }
    }

    /// The bodies, in the order given.
    #[must_use]
    pub fn bodies(&self) -> &[S] {
        &self.bodies
    }

    /// The balls around them.
    #[must_use]
    pub fn spheres(&self) -> &[BoundingSphere<S::Vector>] {
        &self.spheres
    }

    /// The first body that the ray hits. The answer is that of [`ray_cast`] for each body, to the last bit; bodies whose
    /// balls rule them out are not asked.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero or a coordinate is not finite.
    pub fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneRayCast<S::Vector>, RayCastError> {
        ray.check()?;
        // Nearest balls first: what they hit rules out most of the others.
        let mut in_the_way: Vec<(ScalarOf<S>, usize)> = Vec::new();
        for (body, sphere) in self.spheres.iter().enumerate() {
            if let Some(lambda) = reaches(sphere, ray).filter(|&lambda| !(lambda > options.max_lambda)) {
                in_the_way.push((lambda, body));
            }
        }
        in_the_way
            .sort_unstable_by(|(p, i), (q, j)| p.partial_cmp(q).unwrap_or(core::cmp::Ordering::Equal).then(i.cmp(j)));

        let mut answer =
            SceneRayCast { first: None, lower: ScalarOf::<S>::infinity(), tested: 0, culled: 0, undecided: None };
        for (lambda, body) in in_the_way {
            if answer.first.is_some_and(|first: FirstHit<S::Vector>| lambda > first.hit.lambda) {
                break;
            }
            answer.tested += 1;
            let cast = ray_cast(&self.bodies[body], ray, options)?;
            match cast.outcome {
                Outcome::Hit(hit) => {
                    answer.lower = Float::min(answer.lower, cast.lower);
                    let is_first = |first: FirstHit<S::Vector>| (hit.lambda, body) < (first.hit.lambda, first.body);
                    if answer.first.is_none_or(is_first) {
                        answer.first = Some(FirstHit { body, hit });
                    }
                }
                Outcome::Undecided => {
                    answer.lower = Float::min(answer.lower, cast.lower);
                    answer.undecided = Some(answer.undecided.map_or(body, |lowest| lowest.min(body)));
                }
                Outcome::Miss(_) => {}
            }
        }
        answer.culled = self.bodies.len() - answer.tested;
        Ok(answer)
    }

    /// [`ray_cast`](Self::ray_cast) for each of many rays, on all threads of the current [rayon] pool.
    #[cfg(feature = "rayon")]
    pub fn par_ray_casts(
        &self,
        rays: &[Ray<S::Vector>],
        options: RayCastOptions<S::Vector>,
    ) -> Vec<Result<SceneRayCast<S::Vector>, RayCastError>>
    where
        S: Sync,
    {
        use rayon::prelude::*;
        rays.par_iter().map(|&ray| self.ray_cast(ray, options)).collect()
    }
}

/// Where the ray can be in the ball at the earliest; `None` where it passes it. In doubt it is in the ball from the start.
fn reaches<V: Vector>(sphere: &BoundingSphere<V>, ray: Ray<V>) -> Option<V::Scalar> {
    let from = ray.source - sphere.center;
    // A ball's radius is rounded, and the crossing to ulps of the distance.
    let rounding = V::Scalar::from_f64(32.0) * V::Scalar::EPSILON;
    let radius = sphere.radius + rounding * (sphere.radius + from.norm());
    match Ball::<V>::new(radius) {
        Ok(ball) if is_comfortable(radius) && is_comfortable(from.norm()) => {
            let Crossing { entry, exit, .. } = line_crossing(&ball, from, ray.direction).crossing()?;
            (exit >= V::Scalar::ZERO).then(|| entry.max(V::Scalar::ZERO))
        }
        _ => Some(V::Scalar::ZERO),
    }
}

/// Whether a length can be squared without over- or underflow.
fn is_comfortable<S: Scalar>(length: S) -> bool {
    let square = length * length;
    square < S::infinity() && square > S::min_positive_value() / S::EPSILON
}
