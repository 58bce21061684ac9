//! Rays that see one side of a mesh.

use convex_support::{Triangle, Vector3};

use super::Scene;
use super::answers::SceneRayCast;
use crate::{Ray, RayCastError, RayCastOptions};

impl<V: Vector3> Scene<Triangle<V>> {
    /// The first triangle that the ray hits from its [front](Self::is_front): backs are passed through, as by a
    /// renderer that culls them. [`Triangle::barycentric`] and [`Triangle::feature_at`] say where on the triangle the
    /// hit is.
    ///
    /// ```
    /// use convex_support::{TriangleFeature, glam::DVec3};
    /// use gjk_raycast::{Ray, RayCastOptions, Scene};
    ///
    /// // Of two sheets the lower one turns its back to whoever looks down.
    /// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::Z + DVec3::X, DVec3::Z + DVec3::Y];
    /// let mesh = Scene::mesh(&corners, &[[0_u32, 2, 1], [3, 4, 5]])?;
    /// let up = Ray { source: DVec3::new(0.25, 0.25, -1.0), direction: DVec3::Z };
    /// let down = Ray { source: DVec3::new(0.25, 0.25, 2.0), direction: DVec3::NEG_Z };
    /// let first = [up, down].map(|ray| mesh.ray_cast_fronts(ray, RayCastOptions::new()).map(|cast| cast.first));
    /// let [Ok(Some(lower)), Ok(Some(upper))] = first else { return Err("both are seen".into()) };
    /// assert_eq!((lower.body, lower.hit.lambda, upper.body, upper.hit.lambda), (0, 1.0, 1, 1.0));
    /// let triangle = mesh.get(upper.body).and_then(|body| body.convex()).ok_or("it is there")?;
    /// let [weight, ..] = triangle.barycentric(upper.hit.point);
    /// assert!((weight - 0.5).abs() < 1e-15);
    /// assert_eq!(triangle.feature_at(upper.hit.point, 1e-9), TriangleFeature::Face);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Among::ray_cast`](crate::Among::ray_cast).
    #[doc(alias = "backface", alias = "culling", alias = "cull")]
    pub fn ray_cast_fronts(&self, ray: Ray<V>, options: RayCastOptions<V>) -> Result<SceneRayCast<V>, RayCastError> {
        let is_front = |triangle| self.is_front(triangle, ray.direction);
        self.among(&is_front).ray_cast(ray, options)
    }
}
