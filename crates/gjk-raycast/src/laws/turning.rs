//! The claims of `motion_cast` about one motion of two bodies that turn.

use alloc::format;
use alloc::vec::Vec;

use convex_support::{Posed, Scalar, Vector};

use super::cast::{Casts, Gap, Told};
use super::planes::numbers;
use super::ray::ends;
use super::{AnyShape, Law, Report, Scale};
use crate::{
    Impact, Motion, MotionCastOptions, RigidMotion, SignedDistanceOptions, StartInContact, Trajectory, linear_cast,
    motion_cast as ask, signed_distance,
};

/// The times at which the bodies are looked at.
const TIMES: u32 = 12;

/// Casts two turning bodies with several options and starts, in both orders, and with ends at the hit and beside it,
/// and looks at them at some times.
pub fn motion_cast<V: Vector>(
    a: AnyShape<'_, V>,
    motion_a: RigidMotion<V>,
    b: AnyShape<'_, V>,
    motion_b: RigidMotion<V>,
    options: MotionCastOptions<V>,
    starts: &[V],
) -> Report {
    motion_cast_judged((a, motion_a), (b, motion_b), options, starts)
}

/// The same for bodies with their motions.
pub fn motion_cast_judged<V: Vector>(
    (a, motion_a): (AnyShape<'_, V>, RigidMotion<V>),
    (b, motion_b): (AnyShape<'_, V>, RigidMotion<V>),
    options: MotionCastOptions<V>,
    starts: &[V],
) -> Report {
    let mut report = Report::default();
    let mut told = Vec::new();
    let mut cast = |how, options: MotionCastOptions<V>, is_reversed: bool| {
        let cast =
            if is_reversed { ask(b, motion_b, a, motion_a, options) } else { ask(a, motion_a, b, motion_b, options) }
                .ok()?;
        told.push(Told::of_motion(how, [options.max_time, options.tolerance], &cast, is_reversed));
        Some(cast)
    };
    let lean = MotionCastOptions {
        max_time: options.max_time,
        target_distance: options.target_distance,
        start_in_contact: options.start_in_contact,
        tolerance: options.tolerance,
        ..MotionCastOptions::lean()
    };
    let Some(plain) = cast("by default", options, false) else { return report };
    cast("in the other order", options, true);
    cast("lean", lean.with_max_iterations(options.max_iterations.min(500)), false);
    for &axis in starts.iter().take(1) {
        cast("from an axis", options.with_axis(axis), false);
    }
    let hit = plain.outcome.hit();
    for end in ends([hit.map(|hit| hit.time), None, None]) {
        cast("to an end", options.with_max_time(end), false);
    }
    let still = V::AngularVelocity::default();
    if motion_a.angular_velocity == still && motion_b.angular_velocity == still {
        let motion = Motion { velocity_a: motion_a.velocity, velocity_b: motion_b.velocity };
        if let Ok(cast) = linear_cast(a, b, motion, options.straight()) {
            told.push(Told::new("as a linear cast", options.max_time, &cast, |hit: &Impact<V>| (hit.time, hit.normal)));
        }
    }

    let scale = Scale::of(a, b);
    let target = options.target_distance.as_f64().max(0.0);
    let reach = |point: V, center: V| super::planes::length(numbers(point - center));
    let arms = hit.map_or(0.0, |hit| reach(hit.point, motion_a.center) + reach(hit.point, motion_b.center));
    let gap = |time: f64| gap((a, motion_a), (b, motion_b), &scale, time);
    let is_reported = options.start_in_contact == StartInContact::Report;
    let casts = Casts {
        query: "motion_cast",
        unit: scale.unit() + scale.epsilon * (scale.place + arms + target),
        size: scale.size,
        target,
        gap: is_reported.then_some(&gap),
        beyond: None,
        normals: Vec::new(),
    };
    casts.judge(&told, &mut report);
    if is_reported {
        look(&gap, &told, target, &mut report);
    }
    report
}

/// Bounds on the signed distance of the bodies at a time.
fn gap<V: Vector>(
    (a, motion_a): (AnyShape<'_, V>, RigidMotion<V>),
    (b, motion_b): (AnyShape<'_, V>, RigidMotion<V>),
    scale: &Scale,
    time: f64,
) -> Option<[f64; 2]> {
    let time = V::Scalar::from_f64(time);
    let ((a, error_a), (b, error_b)) = (moved(a, motion_a, time)?, moved(b, motion_b, time)?);
    let (a, b): (AnyShape<'_, V>, AnyShape<'_, V>) = (&a, &b);
    let apart = signed_distance(a, b, SignedDistanceOptions::new());
    let error = 8.0 * (error_a + error_b) + scale.unit();
    Some([apart.lower.as_f64() - error, apart.upper.as_f64() + error])
}

/// A body at a time, and how far its pose may be off.
fn moved<V: Vector>(
    shape: AnyShape<'_, V>,
    motion: RigidMotion<V>,
    time: V::Scalar,
) -> Option<(Posed<AnyShape<'_, V>>, f64)> {
    let (displacement, core) = (motion.displacement(time), shape.core());
    let lever = core.size() + (core.origin - motion.center).norm();
    let place = core.origin.norm() + displacement.shift.norm();
    let error = displacement.turn_error * lever + displacement.shift_error + V::Scalar::EPSILON * place;
    let body = Posed::from_matrix(shape, displacement.rotation(), displacement.of(V::ZERO)).ok()?;
    Some((body, error.as_f64()))
}

/// Looks at the bodies at some times: they do not overlap before they are said to touch, and touch then.
fn look(gap: Gap<'_>, told: &[Told], target: f64, report: &mut Report) {
    let latest = told.iter().map(Told::latest).fold(f64::INFINITY, f64::min);
    if latest.is_finite() {
        let found = told.iter().find(|one| one.latest() <= latest);
        if let Some(one) = found.filter(|one| one.bounds()[1] <= latest) {
            // Bodies without an inside, or that graze, may have parted again.
            let earliest = one.bounds()[0];
            let before = |k| earliest + (latest - earliest) * f64::from(k) / f64::from(TIMES);
            let gap_at = |time| gap(time).map_or(f64::NEG_INFINITY, |gap| gap[0]);
            let apart = gap_at(latest);
            let was_nearer = || (0..TIMES).any(|k| gap_at(before(k)) < apart);
            report.claim((Law::Bound, "motion_cast"), apart <= target || was_nearer(), || {
                format!("the bodies are {apart:e} apart at the upper bound: {}", one.answer())
            });
        }
    }
    let Some(one) = told.iter().max_by(|x, y| x.earliest().total_cmp(&y.earliest())) else { return };
    for k in 0..if one.earliest() > 0.0 { TIMES } else { 0 } {
        let time = one.earliest() * f64::from(k) / f64::from(TIMES);
        if let Some([_, upper]) = gap(time).filter(|_| time.is_finite()) {
            let law = if one.is_miss() { Law::Certain } else { Law::Bound };
            report.claim((law, "motion_cast"), upper >= target, || {
                format!("the bodies are {upper:e} apart at {time:e}, before they are said to touch: {}", one.answer())
            });
        }
    }
}
