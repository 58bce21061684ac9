//! Where on a triangle a point is: its barycentric coordinates, and the corner, edge or face that it is on.

use num_traits::Float as _;

use super::Triangle;
use super::planar_triangle::{PlanarTriangle, longest_edge_first};
use crate::closest_point::clamp_to_segment;
use crate::{Scalar, Vector};

/// The part of a triangle that a point is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum TriangleFeature {
    /// The corner with this index.
    Corner(usize),
    /// The edge from the corner with this index to the next.
    Edge(usize),
    /// Neither a corner nor an edge.
    Face,
}

impl<V: Vector> Triangle<V> {
    /// The barycentric coordinates of a point, such as the hit of a ray: the weights of the corners whose sum is the
    /// point, to interpolate what is known at the corners. They are not negative and their sum is 1, to rounding. Of a
    /// point beside the plane they are those of its foot; beyond an edge, weights that would be negative are 0. If the
    /// corners are collinear, the longest edge counts for the triangle.
    ///
    /// ```
    /// use convex_support::{Triangle, glam::DVec3};
    ///
    /// let triangle = Triangle::new([DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0])?;
    /// let [a, b, c] = triangle.barycentric(DVec3::new(1.0, 2.0, 0.0));
    /// assert!((a - 0.25).abs() < 1e-15 && (b - 0.25).abs() < 1e-15 && (c - 0.5).abs() < 1e-15);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn barycentric(&self, point: V) -> [V::Scalar; 3] {
        let (points, zero) = (self.points(), V::Scalar::ZERO);
        let (corners, weights) = match PlanarTriangle::new(points) {
            Some(PlanarTriangle { corners, axes: [u, v], length, along, height }) => {
                let [p, q] = [u, v].map(|axis| axis.dot(point - corners[0]));
                // Twice the areas of the triangles of the point and the opposite edge.
                let areas = [(length - p) * height - q * (length - along), p * height - q * along, length * q];
                (corners, areas.map(|area| area.max(zero)))
            }
            None => {
                let corners = longest_edge_first(points);
                let way = corners[1] - corners[0];
                let [part, whole] = [(point - corners[0]).dot(way), way.dot(way)].map(|part| part.max(zero));
                let part = part.min(whole);
                (corners, if whole > zero { [whole - part, part, zero] } else { [V::Scalar::ONE, zero, zero] })
            }
        };
        let sum = weights[0] + weights[1] + weights[2];
        // The corners are those of the triangle in turn, beginning with another one.
        let turned = (0..3).find(|k| (0..3).all(|i| corners[i] == points[(i + k) % 3])).unwrap_or(0);
        core::array::from_fn(|i| weights[(i + 3 - turned) % 3] / sum)
    }

    /// The feature that a point of the triangle is on: the nearest corner, or else the nearest edge, that is no farther
    /// from it than `tolerance` times the longest edge; or else the face.
    ///
    /// ```
    /// use convex_support::{Triangle, TriangleFeature, glam::DVec2};
    ///
    /// let triangle = Triangle::new([DVec2::ZERO, DVec2::X, DVec2::Y])?;
    /// let on = [DVec2::new(0.2, 0.2), DVec2::new(0.5, 0.5), DVec2::Y].map(|point| triangle.feature_at(point, 1e-9));
    /// assert_eq!(on, [TriangleFeature::Face, TriangleFeature::Edge(1), TriangleFeature::Corner(2)]);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn feature_at(&self, point: V, tolerance: V::Scalar) -> TriangleFeature {
        let points = self.points();
        let [a, b, _] = longest_edge_first(points);
        let near = tolerance * (b - a).norm();
        let nearest = |distance: [V::Scalar; 3]| {
            let within = (0..3).filter(|&i| distance[i] <= near);
            within.reduce(|best, i| if distance[i] < distance[best] { i } else { best })
        };
        if let Some(corner) = nearest(points.map(|corner| (point - corner).norm())) {
            return TriangleFeature::Corner(corner);
        }
        let edge = |i: usize| (point - clamp_to_segment([points[i], points[(i + 1) % 3]], point)).norm();
        nearest([0, 1, 2].map(edge)).map_or(TriangleFeature::Face, TriangleFeature::Edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glam::{DVec3, Vec2};

    #[test]
    fn the_weights_of_the_corners_make_the_point() {
        let points = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 7.0), DVec3::new(2.0, 9.0, -1.0)];
        for turn in 0..3 {
            let corners = [0, 1, 2].map(|i| points[(i + turn) % 3]);
            let triangle = Triangle::new(corners).expect("finite");
            for (i, j) in (0..=10).flat_map(|i| (0..=10 - i).map(move |j| (i, j))) {
                let weights = [f64::from(i) / 10.0, f64::from(j) / 10.0, f64::from(10 - i - j) / 10.0];
                let point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
                let found = triangle.barycentric(point);
                assert!(weights.iter().zip(found).all(|(due, found)| (due - found).abs() < 1e-14), "{found:?}");
                let zeros = weights.iter().filter(|weight| **weight == 0.0).count();
                let feature = triangle.feature_at(point, 1e-12);
                match feature {
                    TriangleFeature::Corner(k) => assert!(zeros == 2 && weights[k] == 1.0, "{weights:?} {feature:?}"),
                    TriangleFeature::Edge(k) => {
                        assert!(zeros == 1 && weights[(k + 2) % 3] == 0.0, "{weights:?} {feature:?}");
                    }
                    TriangleFeature::Face => assert_eq!(zeros, 0, "{weights:?}"),
                }
            }
        }
    }

    #[test]
    fn weights_of_flat_triangles_and_of_points_beside_are_weights_too() {
        let corners = [Vec2::ZERO, Vec2::X * 4.0, Vec2::X];
        assert_eq!(Triangle::new(corners).expect("finite").barycentric(Vec2::X * 3.0), [0.25, 0.75, 0.0], "an edge");
        assert_eq!(Triangle::new([Vec2::X; 3]).expect("finite").barycentric(Vec2::Y), [1.0, 0.0, 0.0], "a point");
        let beyond = Triangle::new([Vec2::ZERO, Vec2::X, Vec2::Y]).expect("finite").barycentric(Vec2::splat(-3.0));
        assert_eq!(beyond, [1.0, 0.0, 0.0], "beyond a corner");
    }
}
