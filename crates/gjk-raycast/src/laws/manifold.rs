//! The claims of `contact`: each point of a manifold to its own error.

use alloc::format;

use convex_support::{Scalar, Vector};

use super::planes::{dot, minus, numbers, stated};
use super::{AnyShape, Law, PairPlanes, Report, Scale};
use crate::{SignedDistanceOptions, contact as ask};

/// What a point may be off by beside its error, in units of ε times the sizes and the offset, plus the errors of both
/// shapes.
const POINTS: f64 = 64.0;

/// Asks for the contact of two shapes that are no farther apart than `within`; no plane across the normals shows that a
/// point is farther from its body than its error.
pub fn contact<V: Vector>(a: AnyShape<'_, V>, b: AnyShape<'_, V>, within: V::Scalar, normals: &[V]) -> Report {
    stated(a, b, |planes| contact_judged(a, b, within, normals, planes))
}

/// [`contact`], judged by planes from elsewhere.
pub fn contact_judged<V: Vector>(
    a: AnyShape<'_, V>,
    b: AnyShape<'_, V>,
    within: V::Scalar,
    normals: &[V],
    planes: PairPlanes<'_>,
) -> Report {
    let mut report = Report::default();
    let scale = Scale::of(a, b);
    for options in
        [Some(SignedDistanceOptions::new()), normals.first().map(|&axis| SignedDistanceOptions::new().with_axis(axis))]
    {
        let Some(found) = options.and_then(|options| ask(a, b, within, options)) else { continue };
        let normal = numbers(found.normal);
        for point in found.points() {
            let ends = [point.point_a, point.point_b].map(numbers);
            let error = point.error.as_f64() + POINTS * scale.of_points();
            let apart = dot(normal, ends[0]) - dot(normal, ends[1]);
            let off = (apart - point.signed_distance.as_f64()).abs();
            report.claim((Law::Points, "contact"), off <= POINTS * scale.of_points(), || {
                format!("the points are {apart:e} apart along the normal: {point:?}")
            });
            let tried = normals.iter().map(|&n| numbers(n)).chain([normal, minus(normal)]);
            for n in tried {
                for (who, end) in [(planes.a, ends[0]), (planes.b, ends[1])] {
                    let beyond = who.beyond(n, &[(1.0, end)])[0];
                    report.claim((Law::Error, "contact"), beyond <= error, || {
                        format!("a point is {beyond:e} outside its body: {point:?}")
                    });
                }
            }
        }
    }
    report
}
