//! The boundary of a polytope that grows point by point: its facets, their planes, and which is nearest to zero.

use alloc::boxed::Box;
#[cfg(feature = "std")]
use alloc::vec::Vec;
use core::any::{Any, TypeId};

use convex_support::numerics::coordinates::{LEAST, Vec3, cross, dot};
use convex_support::numerics::orientation::{six_volumes, twice_area};
use convex_support::{Scalar, Vector};
use num_traits::Float as _;
use smallvec::SmallVec;

use crate::separation::cores::Vertex;
use crate::separation::near::faces::turned_right;
use crate::simplex::{MAX_POINTS, nearest_face};

/// Corners of a facet, of which a polygon's has two and a polyhedron's three.
const FACET_CORNERS: usize = MAX_POINTS - 1;

/// The rounding of a normal, in ε, if its edges are across one another.
const NORMAL_ROUNDED: f64 = 8.0;

/// The sine of the angle between two edges below which the normal of a facet is computed with more care: at most
/// this, and if distances need not be accurate to the last digit so many ε, in units of their accuracy.
const ACUTE_FACET: f64 = 0.125;
const ROUNDING_OF_HEIGHT: f64 = 64.0 * f64::EPSILON;

/// The most facets of a walk to one that a point is beyond.
const MAX_WALK_BEYOND: usize = 32;

/// Vertices, and facets, that there is room for without an allocation: an insertion adds a vertex and no more than two
/// facets.
const VERTICES: usize = 64;
const FACETS: usize = 2 * VERTICES;

/// The corner after each, and the one after that.
const NEXT: [usize; 4] = [1, 2, 0, 1];

const NONE: u16 = u16::MAX;

/// A facet: an edge of a polygon or a triangle of a polyhedron, its corners counterclockwise as seen from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet<V: Vector> {
    corners: [u16; FACET_CORNERS],
    /// The facets across the ridges opposite to each corner.
    across: [u16; FACET_CORNERS],
    pub(super) normal: V,
    /// How far, by the rounding of the normal, a point at unit distance may seem above or below the facet.
    tilt: V::Scalar,
    /// Twice the number of the insertion that last tested this facet, and one more if its point was beyond.
    looked: u32,
}

/// The convex hull of support points, by its vertices and facets.
/// A new point replaces the facets that it is beyond by those between it and their horizon. Since this is decided
/// exactly, the facets bound a convex polytope at any time, however thin, and nothing needs repair: a point in a
/// facet's plane is not beyond it, and no new facet has an area of zero.
///
/// # What it proves
/// The facets are a closed surface by construction. If zero is below all of them, each covers a part of the
/// directions about zero, with one orientation, so that they cover them all; and so the ball about zero that is
/// nowhere above them lies within the polytope. For any unit vector `n` and a facet with corners `p`, no point of the
/// facet is nearer to zero than `min n·p`.
#[derive(Debug)]
pub(super) struct Boundary<V: Vector> {
    vertices: SmallVec<[Node<V>; VERTICES]>,
    facets: SmallVec<[Facet<V>; FACETS]>,
    /// A lower bound on the distance of zero from each facet, negative where zero is beyond it; infinite for what is no
    /// facet any more.
    inner: SmallVec<[V::Scalar; FACETS]>,
    /// The squared sine of the angle between two edges below which a normal is computed with more care.
    acute: f64,
    insertions: u32,
    /// A facet at the last point.
    last: usize,
    /// In the beginning of these the facets that the last point was beyond, and those that take their place. A horizon
    /// has at most two ridges more than facets before it, so that there are two more of these than facets.
    slots: SmallVec<[Slot; FACETS]>,
}

/// A vertex, and if it is on the horizon of the last point, the facets that are to be along the ridges that begin and
/// end there.
#[derive(Clone, Copy, Debug)]
struct Node<V: Vector> {
    vertex: Vertex<V>,
    ridges: [u16; 2],
}

/// A facet that the last point was beyond, and one that is to be.
#[derive(Clone, Copy, Debug)]
struct Slot {
    seen: u16,
    fresh: Fresh,
}

/// A facet that is to be, between the new vertex and a ridge of the horizon. Its corners are the new vertex and the
/// ridge's, in this order; in 2D the ridge is one vertex.
#[derive(Clone, Copy, Debug)]
struct Fresh {
    ridge: [u16; FACET_CORNERS - 1],
    /// The facet beyond the horizon, and the entry of its `across` that will lead here.
    outer: u16,
    back: u8,
    /// In 2D, whether the new vertex is the second corner.
    is_second: bool,
}

#[cfg(feature = "std")]
std::thread_local! {
    /// Polytopes that have outgrown their room, of any type of vectors.
    static OUTGROWN: core::cell::RefCell<Vec<Box<dyn Any>>> = const { core::cell::RefCell::new(Vec::new()) };
}

/// Has this thread keep what is given, if anything is, or takes what it keeps of a type. Without the standard library
/// it keeps nothing.
#[inline(never)]
fn exchange(given: Option<Box<dyn Any>>, wanted: TypeId) -> Option<Box<dyn Any>> {
    #[cfg(feature = "std")]
    return OUTGROWN
        .try_with(|kept| {
            let mut kept = kept.try_borrow_mut().ok()?;
            match given {
                Some(given) => {
                    kept.push(given);
                    None
                }
                None => {
                    let index = kept.iter().position(|kept| (**kept).type_id() == wanted)?;
                    Some(kept.swap_remove(index))
                }
            }
        })
        .ok()
        .flatten();
    #[cfg(not(feature = "std"))]
    {
        let _ = (given, wanted);
        None
    }
}

impl<V: Vector> Boundary<V> {
    /// Lends a search what [`new`](Self::new) makes. If that outgrows its room, the thread keeps it with all that it
    /// has allocated, and lends it to the next search. So only a search that needs more than any before it allocates.
    /// One that is asked within another, by a support map, has a polytope of its own.
    pub(super) fn lend<R>(accuracy: f64, search: impl FnOnce(&mut Self) -> R) -> R {
        // In its place from the beginning: it is a large object to move.
        let mut own = Self::new(accuracy);
        let kept = exchange(None, TypeId::of::<Self>());
        let mut kept: Option<Box<Self>> = kept.and_then(|kept| kept.downcast().ok());
        if let Some(kept) = &mut kept {
            kept.clear();
            kept.acute = own.acute;
        }
        let found = search(kept.as_deref_mut().unwrap_or(&mut own));
        if cfg!(feature = "std") && own.vertices.spilled() {
            kept = Some(Box::new(own));
        }
        if let Some(kept) = kept {
            let _ = exchange(Some(kept), TypeId::of::<Self>());
        }
        found
    }

    /// No polytope yet. The distances of its facets are to be known to `accuracy`, relative to its size, or as well as
    /// may be.
    pub(super) fn new(accuracy: f64) -> Self {
        let acute = (ROUNDING_OF_HEIGHT / accuracy).min(ACUTE_FACET);
        Self {
            vertices: SmallVec::new(),
            facets: SmallVec::new(),
            inner: SmallVec::new(),
            acute: acute * acute,
            insertions: 0,
            last: 0,
            slots: SmallVec::new(),
        }
    }

    /// Begins with the simplex of `DIM + 1` points. `false`, with no polytope, if it is no thicker than the given
    /// length, or has no volume.
    pub(super) fn begin(&mut self, points: &[Vertex<V>], thickness: V::Scalar) -> bool {
        // Facet k is the one without vertex k, seen from outside where the last point is behind the last facet.
        let faces: &[[u16; FACET_CORNERS]] = if V::DIM == 2 {
            &[[1, 2, NONE], [2, 0, NONE], [0, 1, NONE]]
        } else {
            &[[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]]
        };
        let is_beyond_base = |order: [usize; FACET_CORNERS]| {
            let corners = order.map(|i| points[i].point);
            is_beyond(&corners[..V::DIM], points[V::DIM].point)
        };
        let is_turned = is_beyond_base([0, 1, 2]);
        if !is_turned && !is_beyond_base([1, 0, 2]) {
            return false;
        }
        for i in 0..points.len() {
            self.grow(&points[if is_turned && i < 2 { 1 - i } else { i }], 1);
        }
        for (i, &corners) in faces.iter().enumerate() {
            let (facet, inner) = Facet::new(&self.vertices, corners, corners, self.acute);
            let height = inner - facet.normal.dot(self.vertices[i].vertex.point);
            // NaN fails this too.
            if !(height > thickness) && thickness > V::Scalar::ZERO {
                self.clear();
                return false;
            }
            (self.facets[i], self.inner[i]) = (facet, inner);
        }
        true
    }

    #[cold]
    fn clear(&mut self) {
        self.vertices.clear();
        self.facets.clear();
        self.inner.clear();
        (self.insertions, self.last) = (0, 0);
    }

    #[inline(never)]
    fn grow(&mut self, &vertex: &Vertex<V>, facets: usize) {
        let none = [NONE; FACET_CORNERS];
        let facet = Facet { corners: none, across: none, normal: V::ZERO, tilt: V::Scalar::ZERO, looked: 0 };
        self.vertices.push(Node { vertex, ridges: [NONE; 2] });
        for _ in 0..facets {
            self.facets.push(facet);
            self.inner.push(V::Scalar::infinity());
        }
        let fresh = Fresh { ridge: [NONE; 2], outer: NONE, back: 0, is_second: false };
        while self.slots.len() < self.facets.len() + 2 {
            self.slots.push(Slot { seen: NONE, fresh });
        }
    }

    /// The facet whose plane comes nearest to zero, or that zero is farthest beyond, and its bound.
    #[inline]
    pub(super) fn nearest(&self) -> (usize, V::Scalar) {
        let inner = self.inner.as_slice();
        let infinity = V::Scalar::infinity();
        // In four lanes, which the compiler turns into one instruction; the index of the facet is found afterwards.
        let mut lanes = [infinity; 4];
        let (fours, rest) = inner.as_chunks::<4>();
        for four in fours {
            for (lane, &inner) in lanes.iter_mut().zip(four) {
                *lane = if inner < *lane { inner } else { *lane };
            }
        }
        let least = lanes.iter().chain(rest).fold(infinity, |least, &inner| if inner < least { inner } else { least });
        let before = 4 * fours.iter().take_while(|four| !four.iter().fold(false, |is, &x| is | (x == least))).count();
        (inner[before..].iter().position(|&inner| inner == least).map_or(0, |index| before + index), least)
    }

    pub(super) fn facet_at(&self, index: usize) -> &Facet<V> {
        &self.facets[index]
    }

    /// The corners of a facet, of which there are as many as dimensions.
    #[inline]
    pub(super) fn corners(&self, index: usize) -> [u16; FACET_CORNERS] {
        self.facets[index].corners
    }

    #[inline]
    pub(super) fn vertex(&self, corner: u16) -> Vertex<V> {
        self.vertices[usize::from(corner)].vertex
    }

    #[inline]
    pub(super) fn corner_points(&self, index: usize) -> [V; FACET_CORNERS] {
        points(&self.vertices, self.facets[index].corners)
    }

    pub(super) fn len(&self) -> usize {
        self.inner.iter().filter(|inner| inner.is_finite()).count()
    }

    /// The facet across the ridge opposite to a corner.
    pub(super) fn across(&self, index: usize, corner: usize) -> usize {
        usize::from(self.facets[index].across[corner])
    }

    /// The facet that the ray from zero along a unit vector leaves through, if zero is within; the `nearest` facet is
    /// tried first.
    pub(super) fn pierced(&self, u: V, nearest: usize) -> usize {
        if self.facets[nearest].normal == u || !(self.inner[nearest] > V::Scalar::ZERO) {
            return nearest;
        }
        // The facet whose plane is pierced first. For removed facets the inverse of the distance is zero.
        let inverse = |i: usize| self.facets[i].normal.dot(u) / self.inner[i];
        let most = (0..self.facets.len()).fold((nearest, inverse(nearest)), |most, i| {
            let inverse = inverse(i);
            if inverse > most.1 { (i, inverse) } else { most }
        });
        most.0
    }

    /// The least distance of zero from the planes of all facets, each reduced by the `error` along its normal, which is
    /// never more than `most`.
    pub(super) fn certain_inner(&self, error: impl Fn(V) -> V::Scalar, most: V::Scalar) -> V::Scalar {
        let mut least = V::Scalar::infinity();
        for (facet, &inner) in self.facets.iter().zip(&self.inner) {
            // Others are farther whatever their error is. NaN is tested.
            if !(inner - most >= least) {
                least = least.min(inner - error(facet.normal));
            }
        }
        least
    }

    /// Bounds the distance of a facet without its plane, of which rounding leaves too little if it is a sliver: the
    /// direction of its point nearest to zero bounds its distance as well. Whether this bound is better than before.
    pub(super) fn measure(&mut self, index: usize) -> bool {
        let corners = self.corner_points(index);
        let corners = &corners[..V::DIM];
        if is_beyond(corners, V::ZERO) {
            return false;
        }
        let Some(n) = nearest_face(corners, V::DIM).and_then(|nearest| nearest.v.unit()) else { return false };
        let inner = corners.iter().map(|&p| n.dot(p)).fold(V::Scalar::infinity(), V::Scalar::min);
        let is_more = inner > self.inner[index];
        if is_more {
            (self.facets[index].normal, self.inner[index]) = (n, inner);
            self.facets[index].tilt = V::Scalar::infinity();
        }
        is_more
    }

    /// Adds a point beyond some facet; whether there was one.
    pub(super) fn insert_anywhere(&mut self, vertex: &Vertex<V>) -> bool {
        self.facet_below(vertex.point).is_some_and(|facet| self.insert(facet, vertex))
    }

    /// A facet that a point is beyond.
    ///
    /// With zero inside, the facet by whose plane the point is the largest multiple of points of the polytope is an
    /// optimum of a linear function on the dual polytope, so that a walk uphill from any facet finds it; it begins
    /// where the last point was added.
    fn facet_below(&self, point: V) -> Option<usize> {
        let (facets, vertices, inner) = (self.facets.as_slice(), self.vertices.as_slice(), self.inner.as_slice());
        let multiple = |i: usize| facets[i].normal.dot(point) / inner[i];
        let mut here = (self.last, multiple(self.last));
        for _ in 0..MAX_WALK_BEYOND {
            if here.1 > V::Scalar::ONE && inner[here.0].is_finite() && is_seen(&facets[here.0], vertices, point) {
                return Some(here.0);
            }
            let mut best = here;
            for &next in &facets[here.0].across[..V::DIM] {
                let next = usize::from(next);
                let there = multiple(next);
                if there > best.1 {
                    best = (next, there);
                }
            }
            if best.0 == here.0 {
                break;
            }
            here = best;
        }
        (0..facets.len()).find(|&i| inner[i].is_finite() && is_seen(&facets[i], vertices, point))
    }

    /// Adds a point beyond the given facet. `false`, and nothing is changed, if it is not beyond it, or there are too
    /// many.
    pub(super) fn insert(&mut self, facet: usize, vertex: &Vertex<V>) -> bool {
        let is_full = self.vertices.len() >= usize::from(NONE / 4);
        if is_full || !is_seen(&self.facets[facet], &self.vertices, vertex.point) {
            return false;
        }
        let (seen, count) = self.look(facet, vertex.point);
        self.replace(vertex, seen, count)
    }

    /// Finds the facets that a point is beyond, beginning with one, and the future ones between it and their horizon;
    /// returns the numbers of both.
    fn look(&mut self, facet: usize, point: V) -> (usize, usize) {
        self.insertions += 2;
        let round = self.insertions;
        let (facets, vertices) = (self.facets.as_mut_slice(), self.vertices.as_slice());
        let slots = self.slots.as_mut_slice();
        facets[facet].looked = round + 1;
        slots[0].seen = facet as u16;
        let (mut visited, mut count, mut ridges) = (0, 1, 0);
        while visited < count {
            let index = slots[visited].seen;
            visited += 1;
            let Facet { corners, across, .. } = facets[usize::from(index)];
            for i in 0..V::DIM {
                let next = &mut facets[usize::from(across[i])];
                if next.looked < round {
                    next.looked = round;
                    if is_seen(next, vertices, point) {
                        next.looked = round + 1;
                        slots[count].seen = across[i];
                        count += 1;
                    }
                }
                if next.looked == round {
                    let back = if next.across[0] == index { 0 } else { 1 + u8::from(next.across[1] != index) };
                    // Counterclockwise, the ridge opposite to a corner is from the next to the one after.
                    let ridge =
                        if V::DIM == 2 { [corners[1 - i]; 2] } else { [corners[NEXT[i]], corners[NEXT[i + 1]]] };
                    slots[ridges].fresh = Fresh { ridge, outer: across[i], back, is_second: i == 1 };
                    ridges += 1;
                }
            }
        }
        (count, ridges)
    }

    /// Puts the new facets in the slots of those that were `seen`, and more if there are not enough, around the new
    /// vertex. `false`, and nothing is changed, if the horizon is not one cycle, which only numbers that underflow can
    /// cause.
    fn replace(&mut self, vertex: &Vertex<V>, seen: usize, count: usize) -> bool {
        if !self.is_cycle(count) {
            return false;
        }
        let apex = self.vertices.len() as u16;
        for (slot, index) in self.slots[..count].iter_mut().skip(seen).zip(self.facets.len()..) {
            slot.seen = index as u16;
        }
        self.grow(vertex, count.saturating_sub(seen));
        let (slots, vertices) = (&self.slots[..seen.max(count)], self.vertices.as_slice());
        let (facets, inner) = (self.facets.as_mut_slice(), self.inner.as_mut_slice());
        let acute = self.acute;
        for (k, &Slot { seen: index, fresh: new }) in slots[..count].iter().enumerate() {
            let [from, to] = new.ridge;
            let (corners, across) = if V::DIM == 2 {
                let (corners, across) = ([apex, from, NONE], [new.outer, slots[1 - k].seen, NONE]);
                if new.is_second { ([from, apex, NONE], [across[1], across[0], NONE]) } else { (corners, across) }
            } else {
                let (next, last) = (vertices[usize::from(to)].ridges[0], vertices[usize::from(from)].ridges[1]);
                ([apex, from, to], [new.outer, slots[usize::from(next)].seen, slots[usize::from(last)].seen])
            };
            (facets[usize::from(index)], inner[usize::from(index)]) = Facet::new(vertices, corners, across, acute);
            facets[usize::from(new.outer)].across[usize::from(new.back)] = index;
        }
        for old in &slots[count..] {
            inner[usize::from(old.seen)] = V::Scalar::infinity();
        }
        self.last = usize::from(slots[0].seen);
        true
    }

    /// Finds which of the new facets begin and end at each vertex of the horizon; whether that is one each.
    fn is_cycle(&mut self, count: usize) -> bool {
        let (slots, vertices) = (&self.slots[..count], self.vertices.as_mut_slice());
        if V::DIM == 2 {
            return count == 2;
        }
        for (k, Slot { fresh, .. }) in slots.iter().enumerate() {
            vertices[usize::from(fresh.ridge[0])].ridges[0] = k as u16;
            vertices[usize::from(fresh.ridge[1])].ridges[1] = k as u16;
        }
        // If two began at one vertex, the first of them is not the one recorded there.
        slots.iter().enumerate().all(|(k, Slot { fresh, .. })| {
            let [from, to] = fresh.ridge.map(|corner| vertices[usize::from(corner)].ridges);
            let next = slots.get(usize::from(to[0]));
            from[0] == k as u16 && to[1] == k as u16 && next.is_some_and(|next| next.fresh.ridge[0] == fresh.ridge[1])
        })
    }
}

/// Whether a point is beyond a facet: by its plane if rounding leaves no doubt, otherwise exactly.
#[inline]
fn is_seen<V: Vector>(facet: &Facet<V>, vertices: &[Node<V>], point: V) -> bool {
    let from = point - vertices[usize::from(facet.corners[0])].vertex.point;
    let height = facet.normal.dot(from);
    let doubt = facet.tilt * (from.abs().dot(V::ONE));
    if height.abs() > doubt { height > V::Scalar::ZERO } else { is_exactly_beyond(facet, vertices, point) }
}

#[cold]
#[inline(never)]
fn is_exactly_beyond<V: Vector>(facet: &Facet<V>, vertices: &[Node<V>], point: V) -> bool {
    is_beyond(&points(vertices, facet.corners)[..V::DIM], point)
}

impl<V: Vector> Facet<V> {
    /// A facet with its normal, and the distance of its plane from zero, as far as its corners are behind it.
    #[inline(always)]
    fn new(
        vertices: &[Node<V>],
        corners: [u16; FACET_CORNERS],
        across: [u16; FACET_CORNERS],
        acute: f64,
    ) -> (Self, V::Scalar) {
        let at = points(vertices, corners);
        let (normal, tilt) = if V::DIM == 2 { edge_normal(at) } else { triangle_normal(at, acute) };
        let least = |a: V::Scalar, b: V::Scalar| if b < a { b } else { a };
        let inner = least(least(normal.dot(at[0]), normal.dot(at[1])), normal.dot(at[2]));
        (Self { corners, across, normal, tilt, looked: 0 }, inner)
    }
}

/// The points of the corners of a facet; in 2D one of them twice.
#[inline(always)]
fn points<V: Vector>(vertices: &[Node<V>], corners: [u16; FACET_CORNERS]) -> [V; FACET_CORNERS] {
    core::array::from_fn(|i| vertices[usize::from(corners[i.min(V::DIM - 1)])].vertex.point)
}

/// The normal of a facet nearly without area, and its rounding: its corners are near to one another, or to a line. So
/// the direction of one of them bounds its distance well enough, and says nothing about points beyond.
fn sliver_normal<V: Vector>(corner: V) -> (V, V::Scalar) {
    (corner.unit().unwrap_or_else(|| V::axis(0)), V::Scalar::infinity())
}

/// The unit normal of an edge, to the right of it, and its rounding for a point at unit distance.
fn edge_normal<V: Vector>([a, b, _]: [V; FACET_CORNERS]) -> (V, V::Scalar) {
    let normal = turned_right(b - a).unit();
    normal.map_or_else(|| sliver_normal(a), |normal| (normal, V::Scalar::from_f64(NORMAL_ROUNDED) * V::Scalar::EPSILON))
}

/// The unit normal of a triangle, counterclockwise as seen from where it points to, and its rounding for a point at
/// unit distance: relative to the product of the lengths of two edges, which is at most the mean of their squares.
/// Double precision leaves none of it to `f32`.
///
/// Any two edges are taken, unless they are nearly along one another: the square of the sine of their angle less than
/// `acute`. To choose the best two takes a processor as long as all the rest.
#[inline(always)]
fn triangle_normal<V: Vector>([a, b, c]: [V; FACET_CORNERS], acute: f64) -> (V, V::Scalar) {
    let (u, v) = (edge(a, b), edge(a, c));
    let (squared_u, squared_v) = (dot(u, u), dot(v, v));
    let normal = cross(&u, &v);
    let area = dot(normal, normal);
    if area > LEAST && area > squared_u * squared_v * acute {
        unit_normal(normal, area, squared_u + squared_v)
    } else {
        careful_normal([a, b, c])
    }
}

/// The same by the two shortest edges, which leave the least rounding.
#[cold]
#[inline(never)]
fn careful_normal<V: Vector>([a, b, c]: [V; FACET_CORNERS]) -> (V, V::Scalar) {
    let (ab, bc, ca) = (edge(a, b), edge(b, c), edge(c, a));
    let (sab, sbc, sca) = (dot(ab, ab), dot(bc, bc), dot(ca, ca));
    let (u, v, sum) = if sab >= sbc && sab >= sca {
        (bc, ca, sbc + sca)
    } else if sbc >= sca {
        (ca, ab, sca + sab)
    } else {
        (ab, bc, sab + sbc)
    };
    let normal = cross(&u, &v);
    let area = dot(normal, normal);
    if area > LEAST { unit_normal(normal, area, sum) } else { sliver_normal(a) }
}

/// The unit vector along the product of two edges of which the squared length and the sum of the squared lengths of the
/// edges are given, and its rounding.
#[inline(always)]
fn unit_normal<V: Vector>(normal: Vec3, area: f64, sum: f64) -> (V, V::Scalar) {
    let per = area.sqrt().recip();
    let tilt = V::Scalar::from_f64(0.5 * NORMAL_ROUNDED * sum * per) * V::Scalar::EPSILON;
    (V::from_fn(|i| V::Scalar::from_f64(normal[i] * per)), tilt)
}

#[inline(always)]
fn edge<V: Vector>(from: V, to: V) -> Vec3 {
    let coordinate = |p: V, i: usize| p.get(i.min(V::DIM - 1)).as_f64();
    let along = |i: usize| coordinate(to, i) - coordinate(from, i);
    [along(0), along(1), along(2)]
}

/// Whether a point lies strictly beyond a facet of two or three corners, that are counterclockwise as seen from
/// outside.
fn is_beyond<V: Vector>(corners: &[V], point: V) -> bool {
    let flat = |p: V| [p.get(0).as_f64(), p.get(1).as_f64()];
    match *corners {
        [a, b] => twice_area([a, b, point].map(flat)) < 0.0,
        [a, b, c] => six_volumes([a, b, c, point].map(|p| [0, 1, 2].map(|i| p.get(i).as_f64()))) > 0.0,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;
    use alloc::vec::Vec;

    use convex_support::glam::{DVec2, DVec3};

    use super::*;
    use crate::body::PointPair;

    fn vertex(point: DVec3) -> Vertex<DVec3> {
        Vertex { point, along: point, pair: PointPair::ZERO }
    }

    fn tetrahedron() -> Boundary<DVec3> {
        let mut boundary = Boundary::new(f64::EPSILON);
        let corners =
            [DVec3::new(-1.0, -1.0, -0.1), DVec3::new(2.0, -1.0, -0.1), DVec3::new(-1.0, 2.0, -0.1), DVec3::Z];
        assert!(boundary.begin(&corners.map(vertex), 0.0));
        boundary
    }

    /// The predicate is exact: a rounded one takes a point in the plane for one beyond it and makes facets without
    /// area, whose normals mean nothing.
    #[test]
    fn a_point_is_beyond_a_facet_from_the_next_number_on() {
        let (facet, inner) = tetrahedron().nearest();
        assert_eq!(inner, 0.1);
        let below = |z: f64| vertex(DVec3::new(0.25, 0.125, z));
        assert!(!tetrahedron().insert(facet, &below(-0.1)), "in the plane");
        assert!(tetrahedron().insert(facet, &below((-0.1_f64).next_down())), "one ulp beyond it");
    }

    /// The ball that is nowhere above a facet is in the polytope, and grows as points are added.
    #[test]
    fn the_nearest_facet_bounds_the_ball_within() {
        let mut boundary = tetrahedron();
        let (facet, _) = boundary.nearest();
        assert!(boundary.insert(facet, &vertex(DVec3::new(0.0, 0.0, -1.0))));
        assert_eq!(boundary.len(), 6, "three facets in the place of one");
        let (_, inner) = boundary.nearest();
        assert!(inner > 0.1 && inner < 1.0);
    }

    #[test]
    fn a_flat_simplex_is_no_polytope() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y].map(vertex);
        assert!(!Boundary::new(f64::EPSILON).begin(&square, 0.0));
    }

    /// The points are so near to the line `y = x` that the determinant rounds to zero, or to the other sign.
    #[test]
    fn a_point_within_rounding_of_a_facet_is_on_its_true_side() {
        let (a, b) = (DVec2::splat(12.0), DVec2::splat(24.0));
        let at = |i: u32| 0.5 + f64::from(i) * f64::EPSILON / 2.0;
        for i in 0..32 {
            for j in 0..32 {
                assert_eq!(is_beyond(&[a, b], DVec2::new(at(i), at(j))), i > j, "{i} {j}");
                let corners = [DVec3::splat(12.0), DVec3::new(24.0, 24.0, 0.0), DVec3::splat(24.0)];
                assert_eq!(is_beyond(&corners, DVec3::new(at(i), at(j), 3.0)), i > j, "{i} {j} in space");
            }
        }
    }

    fn octahedron() -> Boundary<DVec3> {
        let mut boundary = Boundary::new(f64::EPSILON);
        assert!(boundary.begin(&[DVec3::X, DVec3::Y, DVec3::Z, -DVec3::ONE].map(vertex), 0.0));
        for corner in [DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z].map(|corner| corner * 4.0) {
            assert!(boundary.insert_anywhere(&vertex(corner)));
        }
        boundary
    }

    /// The facets that are left, by their corners and those across.
    fn facets<V: Vector>(boundary: &Boundary<V>) -> Vec<(usize, [u16; FACET_CORNERS], [u16; FACET_CORNERS])> {
        let is_left = |&i: &usize| boundary.inner[i].is_finite();
        let facet = |i: usize| (i, boundary.facets[i].corners, boundary.facets[i].across);
        (0..boundary.facets.len()).filter(is_left).map(facet).collect()
    }

    /// Points of whole coordinates in a cube, many of them in planes and on lines with others: each is in the hull of
    /// what was kept, exactly; ridges are those of the facets across them; and by Euler's formula a polyhedron of
    /// triangles has twice as many facets as vertices, less four.
    #[test]
    fn facets_are_a_closed_surface_around_all_points() {
        let mut boundary = Boundary::new(f64::EPSILON);
        let corners = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::ONE];
        assert!(boundary.begin(&corners.map(vertex), 0.0));
        let (mut state, mut points) = (1_u64, corners.to_vec());
        for _ in 0..300 {
            let mut coordinate = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                ((state >> 33) % 13) as f64 - 6.0
            };
            let point = DVec3::new(coordinate(), coordinate(), coordinate());
            points.push(point);
            let _ = boundary.insert_anywhere(&vertex(point));
        }
        let facets = facets(&boundary);
        let used: BTreeSet<u16> = facets.iter().flat_map(|&(_, corners, _)| corners).collect();
        assert_eq!((facets.len(), boundary.len()), (2 * used.len() - 4, facets.len()));
        for &(index, corners, across) in &facets {
            let at = boundary.corner_points(index);
            assert!(points.iter().all(|&point| !is_beyond(&at, point)), "a point is beyond {at:?}");
            for i in 0..3 {
                let (from, to) = (corners[NEXT[i]], corners[NEXT[i + 1]]);
                let other = &boundary.facets[usize::from(across[i])];
                let back = (0..3).find(|&k| usize::from(other.across[k]) == index).expect("a facet across it");
                assert_eq!([other.corners[NEXT[back + 1]], other.corners[NEXT[back]]], [from, to]);
            }
        }
    }

    /// Five corners and their quarter turns, all on the hull.
    #[test]
    fn a_polygon_has_an_edge_for_each_corner() {
        let vertex = |point: DVec2| Vertex { point, along: point, pair: PointPair::ZERO };
        let corners = [(0.0, 8.0), (1.0, 8.0), (4.0, 7.0), (7.0, 4.0), (8.0, 1.0)];
        let all = (0..4).flat_map(|quarter| {
            let turn = move |(x, y): (f64, f64)| [(x, y), (y, -x), (-x, -y), (-y, x)][quarter];
            corners.map(|corner| DVec2::from(turn(corner)))
        });
        let mut boundary = Boundary::new(f64::EPSILON);
        assert!(boundary.begin(&[DVec2::new(0.5, 0.5), DVec2::new(-1.0, 0.0), DVec2::new(0.0, -1.0)].map(vertex), 0.0));
        let all: Vec<_> = all.collect();
        for point in &all {
            assert!(boundary.insert_anywhere(&vertex(*point)), "{point}");
        }
        assert_eq!(boundary.len(), all.len());
        for (index, [from, to, _], [after, before, _]) in facets(&boundary) {
            assert!(all.iter().all(|&point| !is_beyond(&boundary.corner_points(index)[..2], point)));
            assert_eq!(boundary.facets[usize::from(after)].corners[0], to);
            assert_eq!(boundary.facets[usize::from(before)].corners[1], from);
        }
        let (_, inner) = boundary.nearest();
        assert!((inner - 11.0 / 2.0_f64.sqrt()).abs() < 1e-14, "the edge from (4, 7) to (7, 4): {inner}");
    }

    /// Of the corners ±4 and 1: the facet (1, 1, 1) is 1/√3 from zero, those with −4 are farther.
    #[test]
    fn the_nearest_facet_is_the_least_of_those_that_are_left() {
        let mut boundary = octahedron();
        let (index, inner) = boundary.nearest();
        assert!((inner - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15 && boundary.facet_at(index).normal.min_element() > 0.0);
        for _ in 0..20 {
            let all = facets(&boundary);
            let (index, inner) = boundary.nearest();
            assert!(all.iter().any(|&(facet, ..)| facet == index), "{index} is left");
            assert!(all.iter().all(|&(facet, ..)| boundary.inner[facet] >= inner && boundary.inner[index] == inner));
            let beyond = boundary.facet_at(index).normal * (inner + 0.125);
            assert!(boundary.insert(index, &vertex(beyond)));
        }
    }

    /// The octahedron with corners 1 and −4 is left along a vector through the facet of the same signs.
    #[test]
    fn a_ray_from_zero_leaves_through_the_facet_that_it_pierces() {
        let boundary = octahedron();
        let (nearest, _) = boundary.nearest();
        for signs in (0..8).map(|bits| DVec3::from_array([1, 2, 4].map(|bit| if bits & bit == 0 { 1.0 } else { -1.0 })))
        {
            let u = (signs * DVec3::new(3.0, 1.0, 2.0)).normalize();
            let at = boundary.corner_points(boundary.pierced(u, nearest));
            assert!(at.iter().all(|corner| corner.dot(signs) > 0.0), "{u} leaves through {at:?}");
        }
    }

    /// A facet at 1/√3 and others farther, by an error that is an eighth along one normal and more elsewhere.
    #[test]
    fn the_certain_ball_within_has_the_error_of_every_facet_taken_off() {
        let boundary = octahedron();
        let least = 1.0 / 3.0_f64.sqrt();
        assert_eq!(boundary.certain_inner(|_| 0.0, 0.0), boundary.nearest().1);
        let by = |error: fn(DVec3) -> f64| boundary.certain_inner(error, 1.0);
        assert!((by(|_| 0.125) - (least - 0.125)).abs() < 1e-15);
        // The facets with one corner at −4 are at 4/√33.
        let known = 4.0 / 33.0_f64.sqrt() - 0.75;
        assert!((by(|n| if n.min_element() < 0.0 { 0.75 } else { 0.0 }) - known).abs() < 1e-15);
    }

    /// Of a needle of a triangle, the plane has no digits: its corners are on one line to a rounding.
    #[test]
    fn a_sliver_is_as_far_as_its_nearest_point() {
        let mut boundary = Boundary::new(f64::EPSILON);
        let sliver =
            [DVec3::new(-1.0, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.25, 2.0_f64.powi(-1000), 1.0)];
        assert!(boundary.begin(&[sliver[0], sliver[1], sliver[2], DVec3::NEG_Z].map(vertex), 0.0));
        let index =
            (0..4).find(|&i| boundary.corner_points(i).iter().all(|corner| corner.z == 1.0)).expect("the sliver");
        assert!(boundary.inner[index] < 0.75, "the direction of a corner bounds it: {}", boundary.inner[index]);
        assert!(boundary.measure(index));
        assert_eq!(boundary.inner[index], 1.0);
        assert!(boundary.facet_at(index).normal.distance(DVec3::Z) < 1e-300);
        assert!(!boundary.measure(index), "it cannot be better");
    }

    /// The corner of the unit cube is 1/√3 above the plane through its neighbours, 0.57735….
    #[test]
    fn a_simplex_as_thin_as_asked_is_none_and_leaves_nothing() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(vertex);
        let mut boundary = Boundary::new(f64::EPSILON);
        assert!(!boundary.begin(&corners, 0.5774));
        assert_eq!(boundary.len(), 0);
        assert!(boundary.begin(&corners, 0.5773));
        assert_eq!(boundary.len(), 4);
    }

    /// What a thread keeps of a polytope that outgrew its room is empty for the next search.
    #[test]
    fn a_lent_polytope_knows_nothing_of_the_search_before() {
        let grow = |boundary: &mut Boundary<DVec3>| {
            assert_eq!((boundary.len(), boundary.vertices.len()), (0, 0));
            assert!(boundary.begin(&[DVec3::X, DVec3::Y, DVec3::Z, -DVec3::ONE].map(vertex), 0.0));
            for i in 0..=VERTICES {
                let (sin, cos) = (i as f64).sin_cos();
                assert!(boundary.insert_anywhere(&vertex(DVec3::new(4.0 * cos, 4.0 * sin, i as f64 / 16.0 + 1.0))));
            }
            assert!(boundary.vertices.len() > VERTICES);
            boundary.nearest()
        };
        assert_eq!(Boundary::lend(f64::EPSILON, grow), Boundary::lend(f64::EPSILON, grow));
    }
}
