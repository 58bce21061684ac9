//! The state of GJK after each step: a simplex with its point closest to zero, and the best plane.

use convex_support::numerics::range::is_comfortable;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::{Direction, Frame, Progress};
use crate::body::PointPair;
use crate::pair::AnyPair;
use crate::simplex::{Closest, Face, MAX_POINTS, Simplex, is_around_zero, nearest, nearest_face, project};
use crate::{Iterate, SubAlgorithm};

/// How many errors of distance or depth still count as near contact.
pub(crate) const NEAR: f64 = 16.0;

/// The simplex, the bounds on the distance of the cores, and the plane that proves the lower one; lengths in units of
/// the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gjk<V: Vector> {
    /// The corners of the face closest to zero (the paper's W).
    pub(crate) simplex: Simplex<V>,
    /// A vector along the shortest one found from zero to the difference (the paper's v), of any length.
    pub(crate) normal: V,
    pub(super) normal_length: V::Scalar,
    pub(crate) length: V::Scalar,
    /// The best lower bound on the distance of the cores, before rounding, and the axis that proves it, of any length.
    pub(crate) lower: V::Scalar,
    pub(crate) axis: V,
    pub(super) axis_length: V::Scalar,
    /// Whether the corners have weights, and the length is that of an orthogonal projection.
    pub(super) measured: bool,
    pub(crate) iterations: usize,
}

impl<V: Vector> Gjk<V> {
    /// The state before the first support point, which is to be found along the given direction.
    #[inline(always)]
    pub(crate) fn new(first: V) -> Self {
        let first_length = first.length();
        Self {
            simplex: Simplex::new(),
            normal: first,
            normal_length: first_length,
            length: V::Scalar::infinity(),
            lower: -V::Scalar::infinity(),
            axis: first,
            axis_length: first_length,
            measured: false,
            iterations: 0,
        }
    }

    /// Begins with a point of the difference, if it is finite, and with the vector to it as first direction. Whether
    /// the bodies meet there, to rounding.
    #[inline(always)]
    pub(crate) fn begin_at(&mut self, point: V, witness: PointPair<V>, frame: &Frame<V>) -> bool {
        let mut weights = [V::Scalar::ZERO; MAX_POINTS];
        weights[0] = V::Scalar::ONE;
        self.simplex.push(point, -point, witness);
        if !self.accept(Closest { v: point, face: Face::of_corners(&[0]), weights }) {
            self.simplex.pop();
            return false;
        }
        self.length <= frame.touching()
    }

    /// Begins at the closest points of the cores of a pair of the given size, if they have a closed form: whether the
    /// bodies meet there, to rounding. `None` if they have none; the state is then unchanged.
    #[inline(always)]
    pub(crate) fn begin_at_closest(
        &mut self,
        pair: &AnyPair<'_, V>,
        frame: &Frame<V>,
        size: V::Scalar,
    ) -> Option<bool> {
        let points = pair.closest_points_for_search(frame.offset * frame.scale, size)?;
        Some(self.begin_at(points.a - points.b + frame.offset, points, frame))
    }

    /// The state at a face of the difference: `v` is its point closest to zero, made of its corners with these weights.
    #[inline]
    pub(crate) fn at_face(
        corners: impl Iterator<Item = (V, PointPair<V>)>,
        weights: [V::Scalar; MAX_POINTS],
        v: V,
    ) -> Self {
        let mut state = Self::new(v);
        for (point, witness) in corners {
            state.simplex.push(point, -v, witness);
        }
        state.simplex.weigh(weights);
        (state.length, state.measured) = (v.norm(), true);
        state
    }

    /// Raises the lower bound to the plane through the support point `w` along a direction, if it is higher: no point
    /// of `A − B` lies before `w` along it (the paper's bound `‖v‖² − v·w`, divided by `‖v‖`). Returns the height of
    /// the plane, if finite. Among equally high planes the first is kept: later ones are along shorter vectors, with
    /// more rounding.
    #[inline(always)]
    pub(super) fn advance(&mut self, Direction { n, length }: Direction<V>, w: V) -> Option<V::Scalar> {
        self.iterations += 1;
        let reach = n.dot(w) / length;
        if !reach.is_finite() {
            return None;
        }
        if reach > self.lower {
            (self.lower, self.axis, self.axis_length) = (reach, n, length);
        }
        Some(reach)
    }

    /// Whether the bracket is as narrow as rounding or the tolerance.
    #[inline(always)]
    pub(super) fn is_closed(&self, frame: &Frame<V>, tolerance: V::Scalar) -> bool {
        let gap = self.length - self.lower;
        // By default there is no tolerance, and nothing to compute.
        gap <= frame.noise || tolerance > V::Scalar::ZERO && gap <= tolerance * (self.lower - frame.radius)
    }

    /// Whether bodies may be nearer to contact than a few errors, after a search.
    #[inline(always)]
    pub(crate) fn is_near_contact(&mut self, frame: &Frame<V>) -> bool {
        if self.simplex.points().len() > V::DIM {
            // A simplex of full dimension has zero inside, perhaps by rounding.
            return !is_around_zero(self.simplex.points(), frame.error * V::Scalar::from_f64(2.0));
        }
        self.ensure_measured();
        (self.length - frame.radius).abs() < frame.error * V::Scalar::from_f64(NEAR)
    }

    /// The iterate for an observer, after support point `w` was found.
    #[inline(always)]
    pub(super) fn iterate(&self, w: V, scale: V::Scalar) -> Iterate<'_, V> {
        let (v, length) = self.shortest();
        Iterate {
            iteration: self.iterations - 1,
            simplex: self.simplex.points(),
            v,
            w,
            scale,
            lower: self.lower * scale,
            upper: length * scale,
        }
    }

    /// The shortest vector found and its length; before there is one, the first direction and infinity.
    fn shortest(&self) -> (V, V::Scalar) {
        let size = self.normal.length();
        if !self.length.is_finite() || size <= V::Scalar::ZERO {
            return (self.normal, self.length);
        }
        // A sliver's normal is off by rounding, and its corners are not equally far along it.
        let levels = self.simplex.points().iter().map(|p| self.normal.dot(*p) / size);
        let length = levels.fold(self.length, V::Scalar::max);
        (self.normal * (length / size), length)
    }

    #[inline(always)]
    pub(super) fn along_normal(&self) -> Direction<V> {
        Direction { n: self.normal, length: self.normal_length }
    }

    /// Whether the shortest vector is no longer than `touching`. Its direction may change as it is measured.
    #[inline(always)]
    pub(super) fn overlaps(&mut self, touching: V::Scalar) -> bool {
        // No point is nearer than the lower bound: the length of a fast step in a sliver is then its rounding. If it
        // counted as progress, the same two steps would go on forever.
        if self.length < self.lower && !self.measured {
            self.measure();
        }
        // A simplex of full dimension contains zero, or is searched more closely. Any other is still to be measured,
        // even if the length of the fast step is zero, which rounding may make it.
        if self.length <= touching && self.simplex.points().len() <= V::DIM && !self.measured {
            self.measure();
        }
        self.length <= touching
    }

    /// Goes on to the face of the simplex closest to zero, if that face is clear and nearer; whether it is. The newest
    /// point is `y`.
    ///
    /// The new direction is in the state alone. As an optional result it went through memory, and the distance of two
    /// boxes took 14 % longer.
    #[inline(always)]
    pub(super) fn step(&mut self, y: V, sub_algorithm: SubAlgorithm) -> bool {
        if !matches!(sub_algorithm, SubAlgorithm::Regions) {
            return self.step_by(sub_algorithm);
        }
        let (points, newest) = self.simplex.padded();
        let Some(next) = nearest(points, newest, y) else { return false };
        let level = next.normal.dot(y);
        let Some(Direction { n, length: size }) = in_range(next.normal) else { return false };
        let length = if size > V::Scalar::ZERO { level / size } else { size };
        let is_nearer = length < self.length;
        if is_nearer {
            self.simplex.keep(next.face);
            (self.normal, self.normal_length, self.length, self.measured) = (n, size, length, false);
        }
        is_nearer
    }

    /// A step by another way to find the face.
    #[cold]
    #[inline(never)]
    fn step_by(&mut self, sub_algorithm: SubAlgorithm) -> bool {
        let next = sub_algorithm.closest(self.simplex.points(), V::DIM);
        next.is_some_and(|next| next.v.norm() < self.length && self.accept(next))
    }

    /// A step by a search of all faces. If only rounding is left to gain, a few steps without a gain are allowed. After
    /// too many of them it returns `false`, and the newest point is not added.
    #[cold]
    #[inline(never)]
    pub(super) fn step_by_all_faces(&mut self, nearing: &mut Progress<V::Scalar>) -> bool {
        let next = match self.simplex.points() {
            [known @ .., newest] if known.contains(newest) => None,
            points => nearest_face(points, V::DIM),
        };
        let Some(next) = next.filter(|next| nearing.goes_on(next.v.norm())) else {
            self.simplex.pop();
            return false;
        };
        self.accept(next)
    }

    /// [Measures](Self::measure) the shortest vector unless that was done.
    #[inline(always)]
    pub(crate) fn ensure_measured(&mut self) {
        if !self.measured {
            self.measure();
        }
    }

    /// Measures the face closest to zero by orthogonal projection, free of the rounding of the steps before.
    #[inline(never)]
    fn measure(&mut self) {
        let points = self.simplex.points();
        if points.is_empty() {
            return;
        }
        let foot = project(points, |corner| -corner);
        if !foot.coordinates[..points.len()].iter().all(|&b| b > V::Scalar::ZERO) {
            if let Some(found) = nearest_face(points, V::DIM) {
                self.accept(found);
            }
            return;
        }
        let v = if points.len() > V::DIM { V::ZERO } else { -foot.across };
        self.simplex.weigh(foot.coordinates);
        self.now_at(v);
    }

    #[inline(always)]
    fn accept(&mut self, Closest { v, face, weights }: Closest<V>) -> bool {
        self.simplex.retain(face, weights);
        self.now_at(v)
    }

    /// Takes the measured shortest vector as the best known, if it is finite; whether it is.
    #[inline(always)]
    fn now_at(&mut self, v: V) -> bool {
        let Some(Direction { n, length: size }) = in_range(v) else { return false };
        // A vector in range keeps its length.
        let length = if n == v { size } else { v.norm() };
        (self.normal, self.normal_length, self.length, self.measured) = (n, size, length, true);
        true
    }
}

/// The direction of a vector, at a length whose square is in range; the zero vector as it is. `None` if it is not
/// finite.
#[inline]
pub(super) fn in_range<V: Vector>(v: V) -> Option<Direction<V>> {
    let squared = v.length_squared();
    if is_comfortable(squared) {
        Some(Direction { n: v, length: squared.sqrt() })
    } else if v == V::ZERO {
        Some(Direction { n: v, length: V::Scalar::ZERO })
    } else {
        v.unit().map(|n| Direction { n, length: V::Scalar::ONE })
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::DVec3;

    use super::*;

    /// A lower plane proves less; among equally high planes the first one is kept.
    #[test]
    fn only_a_higher_plane_raises_the_lower_bound() {
        let mut state = Gjk::new(DVec3::X);
        let along = |n: DVec3| Direction { n, length: n.length() };
        assert_eq!(state.advance(along(DVec3::X * 4.0), DVec3::new(2.0, 0.0, 0.0)), Some(2.0));
        assert_eq!(state.advance(along(DVec3::Y), DVec3::new(0.0, 1.0, 0.0)), Some(1.0));
        assert_eq!((state.lower, state.axis), (2.0, DVec3::X * 4.0));
        let _ = state.advance(along(DVec3::Z), DVec3::new(0.0, 0.0, 2.0));
        assert_eq!((state.lower, state.axis), (2.0, DVec3::X * 4.0));
        assert_eq!(state.advance(along(DVec3::X), DVec3::NAN), None);
        let _ = state.advance(along(DVec3::Z), DVec3::new(0.0, 0.0, 2.5));
        assert_eq!((state.lower, state.axis, state.iterations), (2.5, DVec3::Z, 5));
    }
}
