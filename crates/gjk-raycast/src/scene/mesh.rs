//! A triangle mesh is a scene of triangles.

use alloc::vec::Vec;

use convex_support::{Triangle, Vector, Vector3};

use super::{Scene, SceneError};

impl<V: Vector> Scene<Triangle<V>> {
    /// The mesh of these triangles, each given by the indices of three vertices. Body `i` is triangle `i`; rays and
    /// shapes meet both of its sides.
    ///
    /// # Errors
    /// [`SceneError::NoSuchVertex`] if an index is that of no vertex; [`SceneError::NotFinite`] if a coordinate of a
    /// triangle is not finite.
    pub fn mesh(vertices: &[V], triangles: &[[usize; 3]]) -> Result<Self, SceneError> {
        let mut bodies = Vec::with_capacity(triangles.len());
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex >= vertices.len()) {
                return Err(SceneError::NoSuchVertex { triangle, vertex });
            }
            let corners = corners.map(|vertex| vertices[vertex]);
            bodies.push(Triangle::new(corners).map_err(|_| SceneError::NotFinite { body: triangle })?);
        }
        Self::new(bodies)
    }
}

impl<V: Vector3> Scene<Triangle<V>> {
    /// Whether a ray or shape that moves along `direction` meets the front of a triangle, the side from which its
    /// corners are seen anticlockwise; `false` if no triangle has this index. This is for questions about one side of a
    /// mesh:
    ///
    /// ```
    /// use convex_support::glam::DVec3;
    /// use gjk_raycast::{Ray, RayCastOptions, Scene};
    ///
    /// let mesh = Scene::mesh(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
    /// let up = Ray { source: DVec3::new(0.2, 0.2, -1.0), direction: DVec3::Z };
    /// assert!(mesh.any_hit(up, RayCastOptions::default())?.hit);
    /// let front = |triangle| mesh.is_front(triangle, up.direction);
    /// assert!(!mesh.among(&front).any_hit(up, RayCastOptions::default())?.hit); // from behind
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn is_front(&self, triangle: usize, direction: V) -> bool {
        let Some(triangle) = self.get(triangle).and_then(|body| body.convex()) else { return false };
        let [a, b, c] = triangle.points();
        (b - a).cross(c - a).dot(direction) < V::Scalar::default()
    }
}
