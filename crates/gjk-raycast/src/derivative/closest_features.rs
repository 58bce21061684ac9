//! The features of two bodies that face each other where they are closest.

use convex_support::{Core, CoreKind, Feature, Hint, Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float as _;

use super::overlap::are_apart;
use super::span::{Joint, Span};
use crate::contact::{ContactPlane, Outline, across};
use crate::symmetric::{Across, Symmetric, dot};
use crate::unit::{power_of_two_near, reciprocal_of_power};

/// What the normal may be wrong by, in units of the rounding of the points that it is computed from.
const TILT: f64 = 64.0;

/// The largest angle that a normal is taken to be wrong by: beyond it, features that lean by it would be called parallel. And the largest
/// within which features are tried that may hold the normal, in how many rounds, each of which looks within a part of the last.
const LARGEST_TILT: f64 = 1e-3;
const LARGEST_REACH: f64 = 0.03;
const ROUNDS: usize = 4;
const NEARER: f64 = 1.0 / 16.0;

/// How far a direction is turned to see which curve an edge between two of them belongs to, and where a support point goes, in units
/// of the square root of ε.
const TURN: f64 = 16.0;

/// The longest step of the unit normal that is one of refinement, and how many are made.
const LONGEST_STEP: f64 = 0.1;
const MAX_STEPS: usize = 5;

/// By how much a support point may differ from where its curvature foretells it, as a part of how far that moves.
const SURPRISE: f64 = 0.25;

/// Where two bodies are closest, or deepest in one another: a vertex, an edge or a face of each, and how they curve there.
///
/// It says whether an answer changes [smoothly](Self::smoothness) with the poses of the bodies, its
/// [one-sided derivative](Self::rate) where it does not, and where it does how the [normal and the points move](Self::velocities),
/// and the [second derivatives](Self::hessian). It is found from an answer and the shapes that were asked about, by
/// [`SignedDistance::closest_features`](crate::SignedDistance::closest_features) and its like, for about the price of four
/// support points of each shape.
///
/// Faces and edges are those that the shapes show by [`SupportMap::core_support_feature`]; a shape that does not say them, as sums and
/// hulls, is taken to be smooth. Of a face with more than 16 corners every second, third, … is [seen](Self::are_complete).
#[derive(Clone, Debug)]
#[must_use]
pub struct ClosestFeatures<V: Vector> {
    /// The unit vector from `b` to `a`, and two across it; in 2D one, and zero.
    pub(super) normal: V,
    pub(super) across: [V; 2],
    /// The closest points.
    pub(super) points: [V; 2],
    /// A point between them.
    pub(super) middle: V,
    /// Lengths below are in this unit, a power of two near the size of both bodies and their distance.
    pub(super) unit: V::Scalar,
    pub(super) signed_distance: V::Scalar,
    /// The radii of both bodies.
    pub(super) radii: [V::Scalar; 2],
    /// The Hessians of both support values, radii included, across the normal. Zero along an edge, and on a face.
    pub(super) hessians: [Symmetric<V::Scalar>; 2],
    /// Whether they foretell the support points nearby.
    pub(super) is_foretold: bool,
    /// The features, relative to the middle.
    pub(super) outlines: [Outline<V::Scalar>; 2],
    pub(super) spans: [Span<V::Scalar>; 2],
    /// What the normal may be wrong by.
    pub(super) tilt: V::Scalar,
    /// Whether another way out of one another is as short.
    pub(super) is_tied: bool,
}

/// Where two bodies are closest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest<V: Vector> {
    pub(super) normal: V,
    pub(super) points: [V; 2],
    pub(super) signed_distance: V::Scalar,
    /// By how much the signed distance may be wrong.
    pub(super) error: V::Scalar,
    /// Whether the normal is that of bodies somewhere near, as that of a hit is of a time near it.
    pub(super) is_near: bool,
}

impl<V: Vector> ClosestFeatures<V> {
    /// At the normal and the points of an answer. Of curved shapes both are known to about half their digits, since the distance is
    /// stationary in them; [`Self::refined`] finds the rest.
    pub(super) fn new<A, B>(a: &A, b: &B, closest: Closest<V>) -> Self
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        let cores = [a.core(), b.core()];
        let size = cores.iter().fold(V::Scalar::ZERO, |sum, core| sum + core.extent + core.radius);
        let gap = closest.signed_distance + cores[0].radius + cores[1].radius;
        let bodies = Bodies { a, b, cores, unit: power_of_two_near(size + closest.signed_distance.abs()) };
        let tilt = tilt(size, gap, closest.error);
        // The normal of polytopes that are apart is that of their closest points, and of those that overlap that of a face. Where they touch, it is
        // as good as a search knows it, and so it is where the search ended early.
        let is_curved = cores.iter().any(|core| matches!(core.kind, CoreKind::Curved));
        // NaN is nowhere near.
        let least = size * rounding();
        let is_searched = closest.is_near || gap.abs() <= least || closest.error > least;
        let seen = || bodies.at(closest, tilt);
        let refined = || {
            let mut features = seen();
            bodies.refine(&mut features, closest).then_some(features)
        };
        let settled = || bodies.settled(closest, tilt, reach(size, gap, closest.error));
        let found = if is_curved {
            settled().or_else(refined)
        } else if is_searched {
            // The features along a normal that is right to rounding meet the condition of the closest points; those of another do not.
            refined().or_else(settled)
        } else {
            None
        };
        let mut features = found.unwrap_or_else(seen);
        features.is_foretold = bodies.are_foretold(&features);
        features
    }

    /// How the features extend together, where the closest points are the only ones.
    pub(super) fn joint(&self) -> Option<Joint<V::Scalar>> {
        let joint = Joint::of(self.spans, self.tilt * V::Scalar::from_f64(4.0));
        // In the plane an edge is all of the line across the normal.
        joint.filter(|joint| V::DIM == 3 || !matches!(joint, Joint::Crossed(_)))
    }

    /// How hard it is to turn the normal: the sum of the Hessians and the signed distance.
    pub(super) fn stiffness(&self) -> Symmetric<V::Scalar> {
        let [a, b] = self.hessians;
        Symmetric { a: a.a + b.a, b: a.b + b.b, d: a.d + b.d }.plus(self.signed_distance)
    }

    /// By how much the places of the corners of features may be wrong, in the unit: the rounding of coordinates in the world and of
    /// the sizes of both bodies, and how far the features of curved bodies move as the normal turns by what it may be wrong by.
    pub(super) fn slack(&self) -> V::Scalar {
        let world = self.middle.abs().max_element() / self.unit;
        let rounding = rounding::<V::Scalar>() * (world + V::Scalar::from_f64(2.0));
        let [a, b] = self.hessians.map(|hessian| hessian.a + hessian.d);
        rounding + self.tilt * (a + b)
    }

    /// Whether the features are known as a whole. Not where a shape shows a part of a face, as of one with more than 16 corners; then
    /// one-sided [rates](Self::rate) are of points of that part.
    #[must_use]
    pub fn are_complete(&self) -> bool {
        self.outlines.iter().all(|outline| outline.is_complete)
    }

    /// The unit normal from `b` to `a`, to rounding.
    #[must_use]
    pub fn normal(&self) -> V {
        self.normal
    }

    /// The closest point of `a`, to rounding; where there are several, the one of the answer.
    #[must_use]
    pub fn point_a(&self) -> V {
        self.points[0]
    }

    /// The closest point of `b`.
    #[must_use]
    pub fn point_b(&self) -> V {
        self.points[1]
    }
}

/// Two bodies, and the unit of length.
struct Bodies<'s, A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> {
    a: &'s A,
    b: &'s B,
    cores: [Core<A::Vector>; 2],
    unit: ScalarOf<A>,
}

impl<A, B> Bodies<'_, A, B>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    /// The features along the normal, which may be wrong by `tilt`.
    fn at(&self, closest: Closest<A::Vector>, tilt: ScalarOf<A>) -> ClosestFeatures<A::Vector> {
        let Closest { normal, points, signed_distance, .. } = closest;
        let (unit, half) = (self.unit, ScalarOf::<A>::from_f64(0.5));
        // In the unit; zero is the middle of the closest points, which is on both sides of the plane that outlines are seen in.
        let plane = ContactPlane { normal, across: across(normal), origin: A::Vector::ZERO };
        let middle = points[0] * half + points[1] * half;
        let from = Viewpoint { tilt, middle, unit, plane };
        let [core_a, core_b] = &self.cores;
        let mut features = ClosestFeatures {
            normal,
            across: plane.across,
            points,
            middle,
            unit,
            signed_distance: signed_distance / unit,
            radii: self.cores.map(|core| core.radius / unit),
            hessians: [Symmetric::ZERO; 2],
            is_foretold: true,
            outlines: [Outline::empty(), Outline::empty()],
            spans: [Span::Vertex; 2],
            tilt,
            is_tied: false,
        };
        let [outline_a, outline_b] = &mut features.outlines;
        draw(outline_a, self.a, core_a, -normal, &from);
        draw(outline_b, self.b, core_b, normal, &from);
        features.spans = [Span::of(outline_a), Span::of(outline_b)];
        features.hessians =
            [hessian(self.a, core_a, -normal, outline_a, &from), hessian(self.b, core_b, normal, outline_b, &from)];
        features
    }

    /// The features at the normal within `reach` of that of an answer along which they overlap, which is the condition of the closest points; `None`
    /// where there is none, but for what is seen within `tilt`.
    ///
    /// What is seen within reach is tried: the normal across it. Where that is none, as where the answer is at an edge of a face that is seen,
    /// what is seen within less is tried.
    fn settled(
        &self,
        closest: Closest<A::Vector>,
        tilt: ScalarOf<A>,
        reach: ScalarOf<A>,
    ) -> Option<ClosestFeatures<A::Vector>> {
        let mut within = reach;
        for _ in 0..ROUNDS {
            // NaN ends this too.
            if !(within > tilt) {
                break;
            }
            let mut seen = self.at(closest, within);
            if seen.spans == [Span::Vertex; 2] {
                // They are so within less.
                seen.tilt = tilt;
                return self.refine(&mut seen, closest).then_some(seen);
            }
            if self.hold(closest, &mut seen, reach) && self.refine(&mut seen, closest) {
                return Some(seen);
            }
            within *= Scalar::from_f64(NEARER);
        }
        None
    }

    /// Turns to the normal across which what is seen holds it, to rounding; whether there is one, along which the features overlap.
    fn hold(&self, closest: Closest<A::Vector>, seen: &mut ClosestFeatures<A::Vector>, reach: ScalarOf<A>) -> bool {
        let radii = self.cores.map(|core| core.radius);
        let turn = |seen: &mut ClosestFeatures<A::Vector>, turn: A::Vector, tilt, sides: &[usize]| {
            let Some(normal) = (seen.normal + turn).unit() else { return false };
            if !((normal - closest.normal).length() <= reach + reach) {
                return false;
            }
            let at = self.at(Closest { normal, ..closest }, tilt);
            let is_kept = sides.iter().all(|&i| at.spans[i].kind() == seen.spans[i].kind())
                && !are_apart(&at.outlines, at.slack() + tilt);
            if is_kept {
                *seen = at;
            }
            is_kept
        };
        for _ in 0..MAX_STEPS {
            let Some(step) = seen.newton_step(radii) else {
                // A face holds all of the normal, and of two edges that are parallel each a part.
                let [a, b] = seen.spans.map(Span::kind);
                return [0, 1].into_iter().filter(|&i| [a, b][i] == a.max(b)).any(|i| {
                    let across = seen.out_of_plane(seen.spans[i].turn(&seen.outlines[i]));
                    turn(seen, across, rounding(), &[i])
                });
            };
            // A step of Newton's method leaves the square of what it takes away.
            let left = step.turn.length() * step.turn.length();
            if !turn(seen, step.turn, rounding::<ScalarOf<A>>() + left, &[0, 1]) {
                return false;
            }
            if left <= rounding() {
                return true;
            }
        }
        false
    }

    /// Newton's method for the normal and the points, as long as the steps become shorter; whether it leads to points that are opposite to each
    /// other, along the same features.
    fn refine(&self, best: &mut ClosestFeatures<A::Vector>, closest: Closest<A::Vector>) -> bool {
        let mut length = ScalarOf::<A>::from_f64(LONGEST_STEP);
        let radii = self.cores.map(|core| core.radius);
        for _ in 0..MAX_STEPS {
            let Some(step) = best.newton_step(radii) else { break };
            let size = step.turn.length();
            // NaN ends this too.
            if !(size < length) {
                break;
            }
            let shifts = [0, 1].map(|i| (step.points[i] - best.points[i]).length());
            best.points = step.points;
            // An answer knows the distance to its tolerance; to that of rounding, it stays.
            let error = (step.signed_distance - best.signed_distance).abs();
            if error > rounding() {
                best.signed_distance = step.signed_distance;
            }
            if size > length * Scalar::from_f64(0.5) {
                break;
            }
            let Some(normal) = (best.normal + step.turn).unit() else { return false };
            if size <= rounding() && shifts[0].max(shifts[1]) <= self.unit * rounding() {
                // The features along this normal are those that were seen, to rounding.
                (best.normal, best.across) = (normal, across(normal));
                break;
            }
            let signed_distance = best.signed_distance * self.unit;
            let next = self.at(Closest { normal, points: step.points, signed_distance, ..closest }, rounding());
            if next.spans.iter().zip(&best.spans).any(|(next, best)| next.kind() != best.kind()) {
                return false;
            }
            (*best, length) = (next, size);
        }
        let slack = best.slack();
        best.off() <= slack && !are_apart(&best.outlines, slack)
    }

    /// Whether the support points nearby are where the Hessians say.
    fn are_foretold(&self, at: &ClosestFeatures<A::Vector>) -> bool {
        let turn = turn(at.tilt);
        let of_a = is_foretold(self.a, &self.cores[0], -at.normal, at, 0, turn);
        of_a && is_foretold(self.b, &self.cores[1], at.normal, at, 1, turn)
    }
}

/// What a normal is wrong by that is known to rounding.
fn rounding<S: Scalar>() -> S {
    S::EPSILON * S::from_f64(TILT)
}

/// What the normal may be wrong by: the rounding of the points it is computed from, as seen over the gap between the cores, and what
/// the distance may be wrong by, as seen over the size of the bodies.
fn tilt<S: Scalar>(size: S, gap: S, error: S) -> S {
    let magnified = if gap > S::ZERO { rounding::<S>() * (size / gap) } else { S::ZERO };
    let open = if error.is_finite() { error / size * S::from_f64(4.0) } else { S::ZERO };
    (rounding::<S>() + magnified + open).min(S::from_f64(LARGEST_TILT))
}

/// What the normal between curved bodies may be wrong by. Of two cores `g` apart the closest vector `v` is nearer to any other `w` that a
/// bracket `u ≥ g ≥ l` allows than `√(u² − l²)`, for `w·v ≥ g²`; so the angle between them is up to `√(2(u − l)/g)`. Within one another the signed
/// distance along a normal falls with the square of its angle as well, times a stiffness that is taken for a part of the size.
fn reach<S: Scalar>(size: S, gap: S, error: S) -> S {
    let error = error.max(S::EPSILON * size * S::from_f64(4.0));
    let over = if gap > S::ZERO { gap } else { size * S::from_f64(1.0 / 16.0) };
    (error / over * S::from_f64(2.0)).sqrt().min(S::from_f64(LARGEST_REACH))
}

/// How far a direction is turned to look nearby.
fn turn<S: Scalar>(tilt: S) -> S {
    (S::EPSILON.sqrt() * S::from_f64(TURN)).max(tilt * S::from_f64(4.0))
}

/// From where the bodies are seen.
struct Viewpoint<V: Vector> {
    tilt: V::Scalar,
    middle: V,
    unit: V::Scalar,
    plane: ContactPlane<V>,
}

/// Draws the outline of what a body shows along a direction.
fn draw<B: SupportMap + ?Sized>(
    outline: &mut Outline<ScalarOf<B>>,
    body: &B,
    core: &Core<B::Vector>,
    direction: B::Vector,
    from: &Viewpoint<B::Vector>,
) {
    let per_unit = reciprocal_of_power(from.unit);
    let mut feature = Feature::new();
    body.core_support_feature(direction, from.tilt * core.extent * Scalar::from_f64(2.0), &mut feature);
    if feature.points().is_empty() {
        // Where numbers are not finite.
        feature.push(body.core_support(direction, &mut Hint::new()), 0);
    }
    feature.map(|point| point * per_unit);
    outline.draw(&feature, (core.origin - from.middle) * per_unit, &from.plane);
}

/// The Hessian of the support value of a body across a direction, along which it shows a feature; that of its radius included.
fn hessian<B: SupportMap + ?Sized>(
    body: &B,
    core: &Core<B::Vector>,
    direction: B::Vector,
    outline: &Outline<ScalarOf<B>>,
    from: &Viewpoint<B::Vector>,
) -> Symmetric<ScalarOf<B>> {
    let per_unit = reciprocal_of_power(from.unit);
    let along = |direction| {
        let entries = body.core_support_hessian(direction, from.plane.across);
        let [a, b, d] = entries.map(|entry| entry * per_unit);
        Symmetric { a, b, d }.plus(core.radius * per_unit)
    };
    match Span::of(outline) {
        Span::Vertex => along(direction),
        Span::Edge(_) if B::Vector::DIM == 2 => Symmetric::ZERO,
        Span::Edge(e) if matches!(core.kind, CoreKind::Curved) => {
            let edge = from.plane.across[0] * e.0 + from.plane.across[1] * e.1;
            let turn = turn(from.tilt);
            // Of the curves on either side, from two directions each.
            let [first, second] = [-turn, turn].map(|turn| {
                let [near, far] = [turn, turn + turn].map(|turn| along(direction + edge * turn));
                near.blend(far, -ScalarOf::<B>::ONE)
            });
            across_edge(first.blend(second, share(outline, e)), e)
        }
        Span::Edge(e) => across_edge(along(direction), e),
        Span::Face => Symmetric::ZERO,
    }
}

/// How far along an edge the point of contact is, which is at zero: as a part of its length.
fn share<S: Scalar>(outline: &Outline<S>, e: Across<S>) -> S {
    let [from, to] = [&outline.corners[0], &outline.corners[outline.corners.len() - 1]].map(|corner| dot(corner.at, e));
    (-from / (to - from)).max(S::ZERO).min(S::ONE)
}

/// What of a Hessian is across a unit vector. Along the edge itself a support point is free.
fn across_edge<S: Scalar>(hessian: Symmetric<S>, e: Across<S>) -> Symmetric<S> {
    let f = (-e.1, e.0);
    let bend = dot(f, hessian.times(f));
    Symmetric { a: bend * f.0 * f.0, b: bend * f.0 * f.1, d: bend * f.1 * f.1 }
}

/// Whether the support points of a body along directions near that of the other are where its Hessian says. They are not where a
/// shape does not say how it curves, or which face it shows.
fn is_foretold<B: SupportMap + ?Sized>(
    body: &B,
    core: &Core<B::Vector>,
    direction: B::Vector,
    at: &ClosestFeatures<B::Vector>,
    index: usize,
    turn: ScalarOf<B>,
) -> bool {
    if at.spans[index] != Span::Vertex {
        return true;
    }
    let per_unit = reciprocal_of_power(at.unit);
    let hessian = at.hessians[index].plus(-core.radius * per_unit);
    let (mut hint, origin, from) =
        (Hint::new(), at.in_plane((core.origin - at.middle) * per_unit), at.outlines[index].corners[0].at);
    let rounding = ScalarOf::<B>::from_f64(64.0) * ScalarOf::<B>::EPSILON;
    let rows = [(hessian.a, hessian.b), (hessian.b, hessian.d)];
    at.across.into_iter().zip(rows).take(B::Vector::DIM - 1).all(|(change, row)| {
        [turn, -turn].into_iter().all(|turn| {
            let point = at.in_plane(body.core_support(direction + change * turn, &mut hint) * per_unit);
            let foretold = (row.0 * turn, row.1 * turn);
            let off = (point.0 + origin.0 - from.0 - foretold.0, point.1 + origin.1 - from.1 - foretold.1);
            let slack = dot(foretold, foretold).sqrt() * ScalarOf::<B>::from_f64(SURPRISE) + rounding;
            dot(off, off) <= slack * slack
        })
    })
}
