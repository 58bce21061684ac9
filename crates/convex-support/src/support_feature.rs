//! The vertex, edge or face of a shape along a direction.

use num_traits::Float as _;

use crate::ball_support::swept;
use crate::numerics::elementary::sin_cos;
use crate::{Scalar, Vector, Vector3};

/// The most points that a feature may have. If a face has more corners, some that span it are taken.
const MAX_POINTS: usize = 16;

/// The number of points on a rim that represent a disc.
const RIM: u32 = 8;

/// The number of directions in which vertices are searched.
#[cfg(any(test, feature = "parry2d", feature = "parry2d-f64", feature = "parry3d", feature = "parry3d-f64"))]
const PROBES: u32 = 12;

/// A number made of the coordinates of a point.
#[cfg(any(test, feature = "parry2d", feature = "parry2d-f64", feature = "parry3d", feature = "parry3d-f64"))]
fn hash<V: Vector>(point: V) -> u32 {
    let mixed = (0..V::DIM).fold(0_u64, |hash, i| {
        // Zero is zero, whatever its sign (Fowler, Noll and Vo's hash, a word at a time).
        (hash ^ (point.get(i).as_f64() + 0.0).to_bits()).wrapping_mul(0x0000_0100_0000_01B3).rotate_left(23)
    });
    (mixed ^ (mixed >> 32)) as u32
}

/// The points of a shape that lie within a slab behind its supporting plane: a vertex, the ends of an edge, or the
/// corners of a face, in no order, and perhaps with points in between. For a disc they are some points of the rim,
/// and [`rim`](Self::rim) gives the disc. If a face has more corners than there is room for, they are [some of the
/// corners](Self::is_complete).
///
/// Two shapes in contact touch where their features face each other. Each point has a number that stays the same as
/// long as it is the same point of the shape, so that a contact can be recognised in the next frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature<V> {
    points: [V; MAX_POINTS],
    ids: [u32; MAX_POINTS],
    len: usize,
    rim: Option<Rim<V>>,
    is_complete: bool,
}

/// The rim of a flat disc or of its image by a linear map, an ellipse: the points `c + (p − c)·cos φ + (q − c)·sin φ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim<V> {
    /// The centre `c`.
    pub center: V,
    /// Two points of the rim, `p` and `q`, at the ends of conjugate radii; for a circle they are at a right angle.
    pub ends: [V; 2],
}

impl<V: Vector> Default for Feature<V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<V: Vector> Feature<V> {
    /// A feature without points.
    #[must_use]
    pub fn new() -> Self {
        Self { points: [V::ZERO; MAX_POINTS], ids: [0; MAX_POINTS], len: 0, rim: None, is_complete: true }
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[V] {
        &self.points[..self.len]
    }

    /// The numbers of the points, in the same order.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids[..self.len]
    }

    /// Adds a point of the given number, if there is room.
    pub fn push(&mut self, point: V, id: u32) {
        if let (Some(p), Some(i)) = (self.points.get_mut(self.len), self.ids.get_mut(self.len)) {
            (*p, *i) = (point, id);
            self.len += 1;
        } else {
            self.is_complete = false;
        }
    }

    /// The rim, if the feature is a flat disc; its points are some of those on the rim.
    #[must_use]
    pub fn rim(&self) -> Option<Rim<V>> {
        self.rim
    }

    /// Makes the feature a flat disc with this rim.
    pub fn set_rim(&mut self, rim: Rim<V>) {
        self.rim = Some(rim);
    }

    /// Whether the points and the rim are the whole feature. If a face has more than 16 corners, or a shape of another
    /// library is known only by its support points, they span a part of it.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Removes all points.
    pub fn clear(&mut self) {
        *self = Self { len: 0, rim: None, is_complete: true, ..*self };
    }

    /// Maps every point by an affine map.
    pub fn map(&mut self, f: impl Fn(V) -> V) {
        for point in &mut self.points[..self.len] {
            *point = f(*point);
        }
        self.rim = self.rim.map(|rim| Rim { center: f(rim.center), ends: rim.ends.map(f) });
    }

    /// Sweeps every point by a flat ellipse with these conjugate radii, or by a segment, if the second is no longer
    /// than `slab`.
    pub(crate) fn sweep(&mut self, [p, q]: [V; 2], slab: V::Scalar) {
        let Self { points, ids, len, .. } = *self;
        self.clear();
        let around = if q.norm() > slab {
            RIM
        } else if p.norm() > slab {
            2
        } else {
            1
        };
        for (&center, &id) in points.iter().zip(&ids).take(len) {
            for i in 0..around {
                let (sine, cosine) = sin_cos(core::f64::consts::TAU * f64::from(i) / f64::from(around));
                let sine = if around > 2 { sine } else { 0.0 };
                let point = center + p * V::Scalar::from_f64(cosine) + q * V::Scalar::from_f64(sine);
                self.push(point, id.wrapping_mul(RIM).wrapping_add(i));
            }
            if around > 2 {
                self.set_rim(Rim { center, ends: [center + p, center + q] });
            }
        }
        // The hull of several discs is more than their rims.
        if around > 2 && len > 1 {
            (self.rim, self.is_complete) = (None, false);
        }
    }

    /// Of the points with these numbers, those no farther than `slab` behind the farthest along a direction.
    pub(crate) fn collect(
        &mut self,
        direction: V,
        slab: V::Scalar,
        numbers: impl Iterator<Item = usize> + Clone,
        point: impl Fn(usize) -> V,
    ) {
        let level = |i: usize| direction.dot(point(i));
        let least = numbers.clone().map(level).fold(-V::Scalar::infinity(), V::Scalar::max) - slab;
        let near = numbers.filter(|&i| level(i) >= least);
        near.clone().for_each(|i| self.push(point(i), i as u32));
        if self.is_complete {
            return;
        }
        // There are too many: take those that are farthest along directions across and against them, turned all around.
        // None of these directions is along an edge of a face whose corners are evenly spaced, where rounding would
        // decide which of its ends is farther.
        self.clear();
        let [e, f] = across(direction);
        let turned = |k: usize| sin_cos(core::f64::consts::TAU * (k as f64 + 0.3) / MAX_POINTS as f64);
        let aside = core::array::from_fn::<_, { MAX_POINTS / 2 }, _>(turned)
            .map(|(sine, cosine)| (V::Scalar::from_f64(cosine), V::Scalar::from_f64(sine)));
        let mut farthest = [[(0, -V::Scalar::infinity()); MAX_POINTS / 2]; 2];
        for i in near {
            let (x, y) = (e.dot(point(i)), f.dot(point(i)));
            for (k, (along_e, along_f)) in aside.into_iter().enumerate() {
                let reach = along_e * x + along_f * y;
                for (side, reach) in [reach, -reach].into_iter().enumerate() {
                    if reach > farthest[side][k].1 {
                        farthest[side][k] = (i, reach);
                    }
                }
            }
        }
        self.is_complete = false;
        let mut kept = farthest.as_flattened().iter().map(|&(i, _)| i);
        let mut kept = core::array::from_fn::<_, MAX_POINTS, _>(|_| kept.next().unwrap_or_default());
        sort(&mut kept);
        for (k, &i) in kept.iter().enumerate() {
            if k == 0 || kept[k - 1] != i {
                self.push(point(i), i as u32);
            }
        }
    }

    /// For a shape with support points alone, the vertices around the one along a direction and no farther than `slab`
    /// behind it: support points along directions turned all around by a small angle, if they are the same at half of
    /// it. On a curved surface they are not. Their numbers are made of their coordinates.
    #[cfg(any(test, feature = "parry2d", feature = "parry2d-f64", feature = "parry3d", feature = "parry3d-f64"))]
    pub(crate) fn probe(&mut self, direction: V, slab: V::Scalar, support: impl Fn(V) -> V) {
        let point = support(direction);
        self.push(point, hash(point));
        let Some(n) = direction.unit() else { return };
        let [e, f] = across(n);
        let angle = V::Scalar::from_f64(1.0 / 32.0);
        for i in 0..PROBES {
            let (sine, cosine) = sin_cos(core::f64::consts::TAU * f64::from(i) / f64::from(PROBES));
            let aside = e * V::Scalar::from_f64(cosine) + f * V::Scalar::from_f64(sine);
            let half = n + aside * (angle * V::Scalar::from_f64(0.5));
            let vertex = support(n + aside * angle);
            let is_near = n.dot(point - vertex) <= slab;
            if is_near && vertex == support(half) && self.points().iter().all(|&known| known != vertex) {
                self.push(vertex, hash(vertex));
            }
        }
        // A face may have more.
        self.is_complete &= self.len < 3;
    }

    /// The same for discs across the second axis, by height and radius: the support point of each, or points all around
    /// if the disc is flat against the plane, or the support point and some around if it nearly is.
    pub(crate) fn collect_discs(&mut self, direction: V, slab: V::Scalar, discs: [(V::Scalar, V::Scalar); 2])
    where
        V: Vector3,
    {
        let across = direction - V::axis(1) * direction.get(1);
        let slope = across.norm();
        let level = |(height, radius): (V::Scalar, V::Scalar)| direction.get(1) * height + slope * radius;
        let highest = level(discs[0]).max(level(discs[1]));
        let on_rim = |i: u32| {
            let (sine, cosine) = sin_cos(core::f64::consts::TAU * f64::from(i) / f64::from(RIM));
            V::from_fn(|i| V::Scalar::from_f64([cosine, 0.0, sine][i]))
        };
        for (k, &(height, radius)) in (0..).zip(&discs) {
            let center = V::axis(1) * height;
            let lowest = level((height, -radius));
            if lowest >= highest - slab && radius > V::Scalar::ZERO {
                self.set_rim(Rim { center, ends: [V::axis(0) * radius + center, V::axis(2) * radius + center] });
                for i in 0..RIM {
                    self.push(center + on_rim(i) * radius, k * (RIM + 1) + i);
                }
            } else if level((height, radius)) >= highest - slab {
                self.push(center + swept(radius, across), k * (RIM + 1) + RIM);
                // If a disc leans, the part in the slab, unless that is a sliver.
                if level((height, radius * V::Scalar::from_f64(0.5))) >= highest - slab && radius > V::Scalar::ZERO {
                    for i in 0..RIM {
                        let point = center + on_rim(i) * radius;
                        if direction.dot(point) >= highest - slab {
                            self.push(point, k * (RIM + 1) + i);
                        }
                    }
                }
            }
        }
    }
}

/// Unit vectors that span the space across a direction; in the plane one, and zero.
pub(crate) fn across<V: Vector>(direction: V) -> [V; 2] {
    let n = direction.unit().unwrap_or(V::ZERO);
    let a = n.abs();
    let least = (1..V::DIM).fold(0, |least, i| if a.get(i) < a.get(least) { i } else { least });
    let e = (V::axis(least) - n * n.get(least)).unit().unwrap_or(V::ZERO);
    let f = V::from_fn(|i| {
        let at = |v: V, i: usize| v.get(i % V::DIM);
        if V::DIM == 2 { V::Scalar::ZERO } else { at(n, i + 1) * at(e, i + 2) - at(n, i + 2) * at(e, i + 1) }
    });
    [e, f]
}

/// Sorts numbers. It is not generic, so that the sort is compiled here and not in every program with shapes.
fn sort(numbers: &mut [usize]) {
    numbers.sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ball, Cuboid, Cylinder, SupportMap};
    use glam::{DVec2, DVec3};

    fn probed<S: SupportMap>(shape: &S, direction: S::Vector) -> Feature<S::Vector> {
        let mut feature = Feature::new();
        feature.probe(direction, S::Vector::axis(0).norm() * Scalar::from_f64(0.01), |d| shape.support(d));
        feature
    }

    #[test]
    fn a_support_map_shows_its_vertices() {
        let cuboid = Cuboid::new(DVec3::new(1.0, 2.0, 3.0)).expect("positive");
        let (face, edge) = (probed(&cuboid, DVec3::Y), probed(&cuboid, DVec3::new(0.0, 1.0, 1.0)));
        assert_eq!(face.points().len(), 4, "{face:?}");
        assert!(face.points().iter().all(|p| p.y == 2.0), "{face:?}");
        assert_eq!(edge.points().len(), 2, "{edge:?}");
        assert_eq!(probed(&cuboid, DVec3::ONE).points(), [DVec3::new(1.0, 2.0, 3.0)]);
        let again = probed(&cuboid, DVec3::new(0.0005, 1.0, -0.0005));
        let mut ids = [face.ids().to_vec(), again.ids().to_vec()];
        ids.iter_mut().for_each(|ids| ids.sort_unstable());
        assert_eq!(ids[0], ids[1], "the numbers stay");
        let square = Cuboid::new(DVec2::ONE).expect("positive");
        assert_eq!(probed(&square, DVec2::Y).points().len(), 2);
    }

    #[test]
    fn what_is_curved_shows_a_point() {
        assert_eq!(probed(&Ball::<DVec3>::new(1.0).expect("positive"), DVec3::new(0.1, 0.2, 0.3)).points().len(), 1);
        let cylinder = Cylinder::<DVec3>::new(0.5, 1.0).expect("positive");
        assert!(probed(&cylinder, DVec3::Y).points().len() > 4, "a rim");
    }
}
