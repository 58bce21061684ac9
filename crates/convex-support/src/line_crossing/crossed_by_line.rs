//! The question where a line is in a shape.

use super::{CertainCrossing, LineCrossing, LineQuery, closely as close};
use crate::{Core, Lines, ScalarOf, SupportMap};

/// A convex set with a closed form for where a line is in it, for [`line_crossing`].
#[diagnostic::on_unimplemented(
    message = "where a line crosses `{Self}` has no closed form",
    note = "`gjk_raycast::ray_cast` answers of every shape where a ray enters it, and `ray_exit` where it leaves"
)]
pub trait CrossedByLine: SupportMap {
    /// Where the line through `source` along `direction` is in the core swept by a ball of the given `radius`, in
    /// closed form; `source` is relative to the [origin](Core::origin) of the core. [`LineCrossing::Unknown`] if this
    /// core and this radius have no closed form.
    fn core_line_crossing(
        &self,
        source: Self::Vector,
        direction: Self::Vector,
        radius: ScalarOf<Self>,
    ) -> LineCrossing<Self::Vector>;

    /// The answers of [`certain_crossing`](SupportMap::certain_crossing) in plain numbers for many lines, to the last
    /// bit. Lines without a certain answer, or whose answer costs a branch, are left out. `false`, as the provided
    /// method returns, if nothing is ever known.
    #[doc(hidden)]
    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<ScalarOf<Self>>) -> bool {
        let _ = lines;
        false
    }
}

/// Where the line through `source` along `direction` is in a shape.
///
/// This is for ray tracers, and it is an independent reference for ray casts that only use the support mapping.
/// Points, segments, triangles, balls, boxes, capsules, cylinders, cones and ellipsoids have closed forms, and so
/// have the first six of these swept by a ball. It also works through poses, invertible affine maps, roundings and
/// sums with a point, and behind any pointer. If such a combination has no closed form, the answer is
/// [`LineCrossing::Unknown`].
///
/// ```
/// use convex_support::{Cone, Cuboid, LineCrossing, Posed, Rounded, glam::DVec3, line_crossing};
///
/// let die = Posed::translated(
///     Rounded::new(Cuboid::new(DVec3::ONE)?, 0.25)?,
///     DVec3::new(5.0, 0.0, 0.0),
/// )?;
/// let crossing = line_crossing(&die, DVec3::ZERO, DVec3::X).crossing().ok_or("a miss")?;
/// assert_eq!((crossing.entry, crossing.exit), (3.75, 6.25));
/// assert!(matches!(line_crossing(&die, DVec3::ZERO, DVec3::Y), LineCrossing::Misses(_)));
///
/// let rounded_cone = Rounded::new(Cone::<DVec3>::new(1.0, 1.0)?, 0.1)?;
/// assert_eq!(line_crossing(&rounded_cone, DVec3::ZERO, DVec3::Y), LineCrossing::Unknown);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Accuracy
/// Every method starts from the point of the line nearest the shape's centre, so that coordinates there are of the
/// size of the shape and nothing cancels except the digits that the source's own coordinates have already lost:
/// `λ·|direction|` carries an error of a few units in the last place of the distance between source and centre. Where
/// a line grazes a curved surface, at an angle `α`, this is magnified by `1/sin α`. If a line passes the boundary
/// within this error, rounding decides whether it hits. Squares of lengths must stay in range (about 1e±150 in
/// `f64`, 1e±18 in `f32`); directions may have any length. A zero direction has no line and a `NaN` no crossing: a
/// miss.
#[doc(alias("ray_cast", "ray_intersection", "clip_line"))]
#[inline(always)]
pub fn line_crossing<S: CrossedByLine + ?Sized>(
    shape: &S,
    source: S::Vector,
    direction: S::Vector,
) -> LineCrossing<S::Vector> {
    let Core { origin, radius, .. } = shape.core();
    shape.core_line_crossing(source - origin, direction, radius)
}

/// The [certain crossing](SupportMap::certain_crossing) of a shape in twice the precision.
#[cold]
#[inline(never)]
pub(crate) fn closely<S: SupportMap + ?Sized>(
    shape: &S,
    line: LineQuery<S::Vector>,
) -> Option<CertainCrossing<S::Vector>> {
    close::crossing(&shape.core(), line, |line| shape.close_crossing(line))
}
