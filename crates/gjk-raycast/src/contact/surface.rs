//! The height of the surface of a shape over a place in the plane of contact.

use convex_support::{CertainCrossing, Core, Feature, Hint, LineQuery, Scalar, Vector};
use num_traits::Float as _;
use smallvec::SmallVec;

use super::outline::{ContactPlane, Corner, Outline, Tangent, spanned, spread, wrap};
use crate::curvature::share_of_second;
use crate::pair::Shape;
use crate::symmetric::{Across, cross, dot, way};

/// A measured length along a normal, or a speed along it, and a bound on its error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level<S> {
    pub(crate) value: S,
    pub(crate) error: S,
}

impl<S: Scalar> Level<S> {
    pub(crate) fn least(&self) -> S {
        self.value - self.error
    }

    pub(crate) fn most(&self) -> S {
        self.value + self.error
    }
}

/// Support points after which the search for a height is given up. A polytope takes a few; on a curved surface each
/// removes three quarters of the error.
pub(super) const MAX_SUPPORT_POINTS: usize = 32;

/// The number of points kept of a shape.
const KNOWN: usize = 24;

/// The slope beyond which a side of a shape is not visible.
const STEEP: f64 = 4.0;

/// A shape seen along the normal of contact.
pub(super) struct Side<'s, V: Vector> {
    shape: Option<Shape<'s, V>>,
    /// The plane of contact, with the normal out of this shape. Heights over it are levels.
    pub(super) plane: ContactPlane<V>,
    /// Where the shape's origin is from that of the plane.
    from: V,
    radius: V::Scalar,
    pub(super) outline: Outline<V::Scalar>,
    /// Known points of the shape: first those in the slab, then those found by the search for levels.
    known: SmallVec<[Corner<V::Scalar>; KNOWN]>,
    /// The support value of the shape along the normal, as found and at most.
    reach: V::Scalar,
    pub(super) top: V::Scalar,
    /// The face, or a plane along the edge, that contains all corners, with no point of the shape beyond.
    flat: Option<Tangent<V::Scalar>>,
    /// The rounding of the coordinates of points.
    noise: V::Scalar,
}

impl<'s, V: Vector> Side<'s, V> {
    /// A shape of which nothing has been [seen](Self::see) yet. A side is large, and better made in place.
    #[inline(always)]
    pub(super) fn new(
        shape: Shape<'s, V>,
        core: &Core<V>,
        plane: ContactPlane<V>,
        [reach, top]: [V::Scalar; 2],
    ) -> Self {
        let from = core.origin - plane.origin;
        let noise = (from.norm() + core.size()) * (V::Scalar::EPSILON * V::Scalar::from_f64(16.0));
        let (radius, flat) = (core.radius, None);
        Self { shape: Some(shape), plane, from, radius, reach, top, flat, noise, ..Self::flat(plane) }
    }

    /// A half-space bounded by the plane.
    #[inline(always)]
    pub(super) fn flat(plane: ContactPlane<V>) -> Self {
        let zero = V::Scalar::ZERO;
        let at = (zero, zero);
        Self {
            shape: None,
            plane,
            from: V::ZERO,
            radius: zero,
            outline: Outline::empty(),
            known: SmallVec::new(),
            reach: zero,
            top: zero,
            flat: Some(Tangent { at, level: zero, gradient: at }),
            noise: zero,
        }
    }

    /// Draws the outline of the points of the shape in a slab. Points beyond a side that is nearly along the normal are
    /// not visible: both faces of a thin plate may be in the slab.
    pub(super) fn see(&mut self, slab: V::Scalar) {
        let Some(shape) = self.shape else { return };
        let mut feature = Feature::new();
        shape.core_support_feature(self.plane.normal, slab, &mut feature);
        let swept = self.from + self.plane.normal * self.radius;
        let seen = |(&point, &id): (&V, &u32)| self.plane.corner(swept + point, id);
        self.known.extend(feature.points().iter().zip(feature.ids()).map(seen));
        let known = &self.known;
        let mut shown: SmallVec<[_; 16]> = SmallVec::new();
        for low in known {
            if known.len() < 3 || !known.iter().any(|high| is_hidden(low, high, self.noise)) {
                shown.push(*low);
            }
        }
        wrap(&mut shown, self.noise, &mut self.outline.corners);
    }

    /// Finds out whether the outline is that of a face or an edge, as it mostly is: one support point then gives the
    /// levels of all places.
    pub(super) fn flatten(&mut self) {
        let corners = &self.outline.corners;
        if corners.len() < 2 {
            return;
        }
        let tangent = self.outline.tangent();
        let allowed = self.rounding(&tangent);
        let is_in = |corner: &Corner<V::Scalar>| (corner.height - tangent.level(corner.at)).abs() <= allowed;
        if corners.iter().all(is_in) && self.beyond(&tangent).is_some_and(|(_, by)| by <= allowed) {
            self.flat = Some(tangent);
        }
    }

    /// The rounding of a level of a plane.
    fn rounding(&self, Tangent { gradient: (x, y), .. }: &Tangent<V::Scalar>) -> V::Scalar {
        self.noise * (V::Scalar::ONE + x.abs() + y.abs())
    }

    /// The point of the shape farthest beyond a plane, and how far along the normal of contact.
    fn beyond(&self, tangent: &Tangent<V::Scalar>) -> Option<(Corner<V::Scalar>, V::Scalar)> {
        let ContactPlane { normal, across: [e, f], .. } = self.plane;
        let direction = normal - e * tangent.gradient.0 - f * tangent.gradient.1;
        let corner = self.farthest(direction)?;
        Some((corner, corner.height - tangent.level(corner.at)))
    }

    fn farthest(&self, direction: V) -> Option<Corner<V::Scalar>> {
        let mut point = self.from + self.shape?.core_support(direction, &mut Hint::new());
        if self.radius > V::Scalar::ZERO {
            point += direction.unit()? * self.radius;
        }
        Some(self.plane.corner(point, 0))
    }

    /// A level at a place within the outline, of points of the shape between its corners.
    pub(super) fn chord(&self, at: Across<V::Scalar>) -> V::Scalar {
        self.flat.unwrap_or_else(|| Tangent::through(&self.around(at))).level(at)
    }

    /// The level of the surface at a place within the outline, and by how much it may be too little, found by at most
    /// so many support points, unless the shape has a closed form.
    ///
    /// Points of the shape around the place, first those of the outline, are in the shape with all points between them.
    /// The plane through them is moved out until it supports the shape: the surface is between the two planes. If they
    /// differ, the supporting point replaces one of the others, so that the place is still among them. At a face of a
    /// polytope this ends with the face. Known points are tried first.
    ///
    /// `None` if the shape is not over the place, or its level is less than `least`.
    pub(super) fn level(
        &mut self,
        at: Across<V::Scalar>,
        least: V::Scalar,
        mut support_points: usize,
    ) -> Option<Level<V::Scalar>> {
        let is_aside = self.is_aside(at);
        if let (Some(tangent), false) = (&self.flat, is_aside) {
            return Some(Level { value: tangent.level(at), error: self.rounding(tangent) });
        }
        // With a larger error a side is along the normal to rounding, and its position is unknown.
        let noise = self.noise;
        let is_known = |error| error * (V::Scalar::EPSILON.sqrt() * V::Scalar::from_f64(16.0)) <= noise;
        let line = LineQuery::new(self.plane.point(at, V::Scalar::ZERO), -self.plane.normal);
        match self.shape?.certain_crossing(line.within(noise)) {
            Some(CertainCrossing::Misses(_)) => return None,
            Some(CertainCrossing::Enters { entry, bounds, .. }) if is_known(entry - bounds[0]) => {
                return Some(Level { value: -entry, error: entry - bounds[0] });
            }
            _ => {}
        }
        let mut around = if is_aside { self.beside(at)? } else { self.around(at) };
        let (mut value, mut most, mut lost) = (around[0].height, self.top, self.noise);
        for _ in 0..2 * MAX_SUPPORT_POINTS {
            let tangent = Tangent::through(&around);
            let allowed = self.rounding(&tangent);
            // NaN, from points on one line, ends this too.
            if !allowed.is_finite() {
                break;
            }
            let Level { value: height, error: aside } = between(&around, at);
            (value, lost) = (height, allowed + aside);
            if value + self.noise >= self.reach {
                break;
            }
            let mut above = (allowed, None);
            for corner in &self.known {
                let by = corner.height - tangent.level(corner.at);
                above = if by > above.0 { (by, Some(*corner)) } else { above };
            }
            if above.1.is_some_and(|next| enclose(&mut around, next, at, self.noise)) {
                continue;
            }
            if support_points == 0 {
                break;
            }
            support_points -= 1;
            let Some((next, by)) = self.beyond(&tangent) else { break };
            most = most.min(tangent.level(at) + by.max(V::Scalar::ZERO) + allowed);
            if most < least {
                return None;
            }
            if self.known.len() < KNOWN {
                self.known.push(next);
            }
            if !(by > allowed) || !enclose(&mut around, next, at, self.noise) {
                break;
            }
        }
        is_known(lost).then(|| Level { value, error: (most - value).max(V::Scalar::ZERO) + lost })
    }

    /// Whether a place is beside an outline that is a segment, which happens if it is nearly parallel to the other
    /// shape's.
    fn is_aside(&self, at: Across<V::Scalar>) -> bool {
        let [p, q] = self.outline.corners[..] else { return false };
        let e = way(p.at, q.at);
        let turn = cross(e, way(p.at, at));
        turn * turn > dot(e, e) * (self.noise * self.noise)
    }

    /// The corners of a triangle of the outline around a place; the ends of an outline that is a segment.
    fn around(&self, at: Across<V::Scalar>) -> Corners<V::Scalar> {
        let corners = &self.outline.corners;
        if corners.len() < 3 {
            return SmallVec::from_slice(corners);
        }
        let first = corners[0];
        let edge = |to: Across<V::Scalar>| way(first.at, to);
        let is_behind = |i: &usize| cross(edge(corners[*i].at), edge(at)) <= V::Scalar::ZERO;
        let next = (2..corners.len()).find(is_behind).unwrap_or(corners.len() - 1);
        SmallVec::from_slice(&[first, corners[next - 1], corners[next]])
    }

    /// Points of the shape around a place beside its outline: its ends, and then farthest points along the plane, each
    /// on the other side of an edge that the place is beyond. `None` if the shape is not over the place.
    fn beside(&self, at: Across<V::Scalar>) -> Option<Corners<V::Scalar>> {
        let [e, f] = self.plane.across;
        let [p, q] = self.outline.corners[..] else { return None };
        let mut around: Corners<V::Scalar> = SmallVec::from_slice(&[p, q]);
        for _ in 0..MAX_SUPPORT_POINTS {
            let n = around.len();
            let outward = |i: usize| {
                let (x, y) = way(around[i].at, around[(i + 1) % n].at);
                (y, -x)
            };
            let is_beyond = |i: &usize| dot(outward(*i), way(around[*i].at, at)) > V::Scalar::ZERO;
            let Some(i) = (0..n).find(is_beyond) else { return Some(around) };
            let (x, y) = outward(i);
            let next = self.farthest(e * x + f * y)?;
            if !(dot((x, y), way(at, next.at)) >= V::Scalar::ZERO) {
                return None;
            }
            // Counterclockwise, because the place is between these.
            around = SmallVec::from_slice(&[around[(i + 1) % n], around[i], next]);
        }
        None
    }
}

type Corners<S> = SmallVec<[Corner<S>; 3]>;

/// The height between the ends of a segment, or between the corners of a triangle, counterclockwise. A place beyond an
/// edge by rounding has the height of the nearest point of the edges, because the plane of a steep triangle soon leaves
/// the shape there. The error is how far away that point is.
fn between<S: Scalar>(corners: &[Corner<S>], at: Across<S>) -> Level<S> {
    let to = |i: usize| way(at, corners[i].at);
    let of_edge = |i: usize, j: usize| {
        let e = way(to(i), to(j));
        let share = share_of_second(to(i), e);
        let (x, y) = (to(i).0 + e.0 * share, to(i).1 + e.1 * share);
        Level { value: corners[i].height + (corners[j].height - corners[i].height) * share, error: spread((x, y)) }
    };
    if corners.len() < 3 {
        return of_edge(0, 1);
    }
    let weights = [spanned(to(1), to(2)), spanned(to(2), to(0)), spanned(to(0), to(1))];
    if weights.iter().any(|weight| !(*weight >= S::ZERO)) {
        let edges = [of_edge(0, 1), of_edge(1, 2), of_edge(2, 0)];
        return edges.iter().fold(edges[0], |best, &next| if next.error < best.error { next } else { best });
    }
    let [p, q, r] = [0, 1, 2].map(|i| corners[i].height * weights[i]);
    Level { value: (p + q + r) / (weights[0] + weights[1] + weights[2]), error: S::ZERO }
}

/// Whether a point is behind another one, beyond a side of the shape steeper than [`STEEP`].
fn is_hidden<S: Scalar>(low: &Corner<S>, high: &Corner<S>, noise: S) -> bool {
    let (e, rise) = (way(low.at, high.at), high.height - low.height);
    rise > noise && rise * rise > dot(e, e) * S::from_f64(STEEP * STEEP)
}

/// Replaces one of the corners around a place, or joins the two ends of a segment, so that the place is still between
/// them.
fn enclose<S: Scalar>(around: &mut Corners<S>, next: Corner<S>, at: Across<S>, noise: S) -> bool {
    if let [p, q] = around[..] {
        let e = way(p.at, q.at);
        let turn = cross(e, way(p.at, next.at));
        if turn.abs() > spread(e) * noise {
            // Counterclockwise.
            if turn < S::ZERO {
                around.swap(0, 1);
            }
            around.push(next);
        } else {
            let is_beyond = dot(e, way(at, next.at)) > S::ZERO;
            around[usize::from(is_beyond)] = next;
        }
        return true;
    }
    // The place may be beyond a side by rounding, but not behind the new point: both sides may lead the same way.
    let side = |corner: &Corner<S>| {
        let (e, to) = (way(next.at, corner.at), way(next.at, at));
        let allowed = spread(e) * noise;
        (cross(e, to), allowed, dot(e, to) >= -allowed)
    };
    let mut best: Option<Corners<S>> = None;
    for i in 0..3 {
        let (p, q) = (around[i], around[(i + 1) % 3]);
        let ((left, allowed, ahead), (right, as_well, too)) = (side(&p), side(&q));
        // Corners on a line, to rounding, determine no plane.
        let base = way(p.at, q.at);
        let is_known = cross(base, way(p.at, next.at)) > spread(base) * noise;
        if is_known && left >= -allowed && right <= as_well && (ahead || too) {
            let corners = SmallVec::from_buf([p, q, next]);
            // At a corner there are two planes, and the one without that corner is higher.
            if best.as_ref().is_none_or(|known| between(&corners, at).value > between(known, at).value) {
                best = Some(corners);
            }
        }
    }
    let Some(corners) = best else { return false };
    *around = corners;
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two corners are near one another, and the third is far away: the height between them is that of their plane at
    /// any place among them.
    #[test]
    fn the_height_between_corners_of_a_thin_triangle_is_that_of_their_plane() {
        let plane = |(x, y): Across<f64>| 0.25 + 0.7 * x - 0.4 * y;
        let corner = |at| Corner { at, height: plane(at), id: 0 };
        let (p, q) = ((0.1, -0.2), (1.3, 0.9));
        let r = (q.0 - 3e-8, q.1 + 7e-8);
        for i in 1..100 {
            let s = f64::from(i) / 100.0;
            let at = (p.0 + (0.5 * (q.0 + r.0) - p.0) * s, p.1 + (0.5 * (q.1 + r.1) - p.1) * s);
            let off = (between(&[corner(p), corner(q), corner(r)], at).value - plane(at)).abs();
            assert!(off <= 8.0 * f64::EPSILON, "{off:e} at {at:?}");
        }
    }
}
