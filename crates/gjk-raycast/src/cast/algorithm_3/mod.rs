//! The paper's Algorithm 3, for bodies that are a core swept by a ball.
//!
//! Its loop moves a point `x` along the ray up to one supporting plane of the body after another, and finds the
//! planes by GJK steps towards `x`. Three things are added; `docs/ray-cast.md` derives them.
//!
//! - As soon as the simplex of support points is pierced by the ray, the hit is bracketed: behind the last plane, and
//!   before the point where the ray enters the simplex. From then on, the simplex is refined where it is pierced
//!   (`refine.rs`), and no vector has to tend to zero.
//! - Where the ray runs nearly along the planes, a step along it gains nothing, and the steps of GJK are taken across
//!   the ray, with the whole line for `x`.
//! - A radius is never made of support points: the simplex is swept by it.

mod nearness;
mod refine;
mod swept_simplex;

use convex_support::{Scalar, Vector};

use super::bracket::Bracket;
use super::{RayContact, Stop};
use crate::gjk::Progress;
use crate::simplex::{Closest, MAX_POINTS, Simplex, is_around_zero, project_rarely};
pub(super) use nearness::draw_near;
use refine::refine;
use swept_simplex::entry;

/// Slopes of planes, as cosines of the angle between normal and ray, below which steps along the ray gain little.
const GRAZING: f64 = 0.1;

/// Closes the bracket, or finds a plane that the whole ray is before: by GJK steps until the ray touches the body, or
/// enters the simplex of support points.
#[cold]
#[inline(never)]
pub(super) fn algorithm_3<V: Vector>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    let mut simplex = Simplex::new();
    let line = bracket.line();
    // The paper's v.
    let mut v = bracket.x();
    let mut n =
        bracket.options.warm_start.and_then(|warm| warm.axis.unit()).or_else(|| v.unit()).unwrap_or(-line.direction);
    let mut across = false;
    // The unit normal of the last plane along the line.
    let mut beside = None;
    // The distances of the simplex from x and from the line decrease while x stays; near contact by less than
    // rounding for a few steps, while v turns.
    let (mut nearing, mut nearing_across) = (Progress::new(), Progress::new());
    loop {
        let before = bracket.low();
        let (point, witness) = bracket.support(n, v, simplex.points())?;
        bracket.advance(n, point)?;
        if bracket.low() > before {
            nearing = Progress::new();
        }
        if !simplex.points().contains(&point) {
            // A simplex in which x lies and is yet far from it keeps all of its points; only an invalid shape has such
            // points.
            if simplex.points().len() > V::DIM {
                return Err(Stop::InDoubt);
            }
            simplex.push(point, n, witness);
            let found = entry(simplex.points(), line, bracket.radius, bracket.noise);
            if let Some(found) = found.filter(|e| e.mu >= bracket.earliest() - bracket.noise) {
                return match refine(bracket, &mut simplex, found) {
                    Err(Stop::InDoubt) => graze(bracket, &mut simplex).ok_or(Stop::InDoubt),
                    found => found,
                };
            }
        }
        // The paper's step: the point of {x} − P closest to zero.
        let x = bracket.x();
        let Closest { v: to_x, face, weights } = closest(bracket, &simplex, |p| x - p, V::DIM)?;
        let length = to_x.norm();
        if length - bracket.radius <= bracket.noise {
            // x is in the body, or no farther from it than rounding.
            simplex.retain(face, weights);
            let contact = bracket.close_at_low(to_x, simplex.weighted_witness()).ok_or(Stop::InDoubt)?;
            // Mostly a second measurement finds more.
            if bracket.options.rare.0.is_none() && is_inside(bracket, &simplex, x) {
                bracket.enter_for_certain(contact.mu);
            }
            return Ok(contact);
        }
        let slope = to_x.dot(line.direction) / length;
        let progress = nearing.goes_on(length);
        let grazes = slope < Scalar::ZERO && (!progress || slope > -V::Scalar::from_f64(GRAZING));
        across |= grazes;
        if progress && (!across || slope >= Scalar::ZERO) {
            simplex.retain(face, weights);
            (v, n) = (to_x, to_x / length);
            continue;
        }
        // The same step across the ray, with the whole line for x.
        v = aside(bracket, &mut simplex)?;
        let length = v.norm();
        // If no step brings the line nearer, only the errors of the body and of v may be left.
        let progress = nearing_across.goes_on(length);
        let within = if progress { bracket.noise } else { bracket.noise + bracket.error };
        if length - bracket.radius <= within {
            // With the slope of a plane ahead the ray may be past the simplex.
            let contact = if slope < Scalar::ZERO { look_beside(bracket, &simplex, v, within, beside) } else { None };
            return contact.ok_or(Stop::InDoubt);
        }
        if !progress {
            return Err(Stop::InDoubt);
        }
        nearing = Progress::new();
        n = v / length;
        beside = Some(n);
    }
}

/// Whether a point of the line is in the body by more than its error and the simplex's: within the radius around the
/// simplex, or within a simplex of full dimension.
fn is_inside<V: Vector>(bracket: &Bracket<'_, V>, simplex: &Simplex<V>, x: V) -> bool {
    let wrong = (bracket.error + bracket.noise) * Scalar::from_f64(2.0);
    let (seen, len) = mapped(simplex, |p| p - x);
    let is_in_round = (simplex.weighted_point() - x).norm() + wrong < bracket.radius;
    is_in_round || is_around_zero(&seen[..len], wrong)
}

/// The contact if the line enters the round part of a swept simplex no deeper than errors may have moved it: planes
/// at the entry then lean so far along the line that none of them closes the bracket.
fn graze<V: Vector>(bracket: &mut Bracket<'_, V>, simplex: &mut Simplex<V>) -> Option<RayContact<V>> {
    let (v, within) = (aside(bracket, simplex).ok()?, bracket.noise + bracket.error);
    let is_graze = bracket.radius > within && bracket.radius - v.norm() <= within;
    if is_graze { look_beside(bracket, simplex, v, within, None) } else { None }
}

/// The shortest vector from the simplex to the line; the simplex keeps its face and weights.
fn aside<V: Vector>(bracket: &Bracket<'_, V>, simplex: &mut Simplex<V>) -> Result<V, Stop<V>> {
    let line = bracket.line();
    let Closest { v, face, weights } = closest(bracket, simplex, |p| line.across(line.foot - p), V::DIM - 1)?;
    simplex.retain(face, weights);
    // A short vector that long ones cancelled to leans along the ray by their rounding, and a plane that leans does not
    // stay before the whole ray.
    Ok(line.across(v))
}

/// The same as [`touch_beside`], if the options have it.
fn look_beside<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    simplex: &Simplex<V>,
    v: V,
    within: V::Scalar,
    normal: Option<V>,
) -> Option<RayContact<V>> {
    (bracket.options.rare.0?.touch_beside)(bracket, simplex, v, within, normal)
}

/// The contact if the line comes within rounding of the simplex without entering it ahead of x.
pub(super) fn touch_beside<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    simplex: &Simplex<V>,
    v: V,
    within: V::Scalar,
    normal: Option<V>,
) -> Option<RayContact<V>> {
    let (point, witness) = (simplex.weighted_point(), simplex.weighted_witness());
    let mut contact = bracket.close_beside(v, within, point, witness, normal)?;
    // If no plane was crossed, the ray meets the face of the simplex head-on.
    let against = -bracket.line().direction;
    let head_on = || project_rarely(simplex.points(), &|_| against).across.unit();
    contact.normal = contact.normal.or_else(head_on).or(Some(against));
    Some(contact)
}

/// The point closest to zero of the simplex mapped by `map`, in a space of `dimension` dimensions.
fn closest<V: Vector>(
    bracket: &Bracket<'_, V>,
    simplex: &Simplex<V>,
    map: impl Fn(V) -> V,
    dimension: usize,
) -> Result<Closest<V>, Stop<V>> {
    let (seen, len) = mapped(simplex, map);
    bracket.options.sub_algorithm.closest(&seen[..len], dimension).ok_or(Stop::InDoubt)
}

/// The points of a simplex, each mapped, and their number.
fn mapped<V: Vector>(simplex: &Simplex<V>, map: impl Fn(V) -> V) -> ([V; MAX_POINTS], usize) {
    let mut seen = [V::ZERO; MAX_POINTS];
    for (s, p) in seen.iter_mut().zip(simplex.points()) {
        *s = map(*p);
    }
    (seen, simplex.points().len())
}
