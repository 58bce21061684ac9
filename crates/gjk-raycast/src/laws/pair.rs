//! The claims of `distance`, `intersects` and `signed_distance` about one pair of bodies: they share one truth.

use alloc::format;
use alloc::vec::Vec;

use convex_support::{Scalar, Vector};

use super::planes::{length, minus, numbers, stated};
use super::{AnyShape, Law, Numbers, PairPlanes, Report, Scale};
use crate::{
    Distance, DistanceOptions, IntersectOptions, SignedDistance, SignedDistanceOptions, Status, distance, intersects,
    signed_distance,
};

/// The width of a converged bracket, in errors of a bound: 8ε of the sizes and the offset, and the errors of the
/// shapes.
const WIDTH_OF_DISTANCES: f64 = 6.0;

/// The error of points and of planes, in the same unit, in which their places count too.
const POINTS: f64 = 64.0;

/// What an answer says of the signed distance.
struct Answered {
    query: &'static str,
    how: &'static str,
    lower: f64,
    upper: f64,
}

/// What an answer says of whether the bodies meet, if it says that it knows.
struct Meeting {
    query: &'static str,
    how: &'static str,
    overlap: bool,
}

/// Asks for the distance of two shapes, whether they intersect, and for their signed distance, with several options; in
/// both orders; and from the `starts`, which are tried as first axes and as planes.
pub fn pair<V: Vector>(a: AnyShape<'_, V>, b: AnyShape<'_, V>, starts: &[V]) -> Report {
    stated(a, b, |planes| pair_judged(a, b, starts, planes))
}

/// [`pair`], judged by planes from elsewhere.
pub fn pair_judged<V: Vector>(a: AnyShape<'_, V>, b: AnyShape<'_, V>, starts: &[V], planes: PairPlanes<'_>) -> Report {
    let mut laws = Laws {
        scale: Scale::of(a, b),
        planes,
        report: Report::default(),
        known: Vec::new(),
        meetings: Vec::new(),
        normals: starts.iter().map(|&n| numbers(n)).collect(),
        seen: Vec::new(),
    };
    let plain = distance(a, b, DistanceOptions::new());
    laws.distance("by default", &plain, 0.0);
    let lean = distance(a, b, DistanceOptions::lean());
    laws.distance("lean", &lean, 0.0);
    laws.distance("in the other order", &distance(b, a, DistanceOptions::new()).reversed(), 0.0);
    let coarse = V::Scalar::from_f64(1e-3);
    laws.distance("to 1e-3", &distance(a, b, DistanceOptions::new().with_tolerance(coarse)), coarse.as_f64());
    let limit = (plain.lower + plain.upper) * V::Scalar::from_f64(0.5);
    let limited = distance(a, b, DistanceOptions::new().with_limit(limit));
    let width = if limited.lower > limit { f64::INFINITY } else { 0.0 };
    laws.distance("with a limit", &limited, width);
    let warm = starts.iter().copied().chain(plain.normal);
    for axis in warm {
        laws.distance("from an axis", &distance(a, b, DistanceOptions::new().with_axis(axis)), 0.0);
        laws.distance("lean from an axis", &distance(a, b, DistanceOptions::lean().with_axis(axis)), 0.0);
        laws.intersection("from an axis", intersects(a, b, IntersectOptions::new().with_axis(axis)));
    }
    laws.intersection("by default", intersects(a, b, IntersectOptions::new()));
    laws.intersection("in the other order", intersects(b, a, IntersectOptions::new()));

    let options = SignedDistanceOptions::<V>::new();
    let tolerance = options.tolerance.as_f64();
    let signed = signed_distance(a, b, options);
    laws.signed_distance("by default", &signed, tolerance);
    laws.signed_distance("in the other order", &signed_distance(b, a, options).reversed(), tolerance);
    for axis in starts.iter().copied().chain([signed.normal]) {
        laws.signed_distance("from an axis", &signed_distance(a, b, options.with_axis(axis)), tolerance);
    }
    laws.end()
}

struct Laws<'p> {
    scale: Scale,
    planes: PairPlanes<'p>,
    report: Report,
    known: Vec<Answered>,
    meetings: Vec<Meeting>,
    /// Directions of planes to try.
    normals: Vec<Numbers>,
    /// Points, normals and bounds that have been examined.
    seen: Vec<Claims>,
}

/// The points, the normal and the bounds of an answer.
type Claims = ([Numbers; 2], Option<Numbers>, [f64; 2]);

impl Laws<'_> {
    fn distance<V: Vector>(&mut self, how: &'static str, answer: &Distance<V>, tolerance: f64) {
        let [lower, upper, value] = [answer.lower, answer.upper, answer.distance].map(Scalar::as_f64);
        let is_converged = answer.status == Status::Converged;
        let allowed = tolerance * upper + WIDTH_OF_DISTANCES * self.scale.of_bounds();
        self.report.width("distance", is_converged, [lower, upper, allowed], || format!("{how}: {answer:?}"));
        self.report.claim((Law::Bound, "distance"), lower <= value && value <= upper, || {
            format!("{how}, the distance is not within its own bounds: {answer:?}")
        });
        // Where the bodies may overlap, nothing is said of how deep.
        let known = if lower > 0.0 { lower } else { f64::NEG_INFINITY };
        self.known.push(Answered { query: "distance", how, lower: known, upper });
        if is_converged && !how.starts_with("lean") || lower > 0.0 {
            self.meetings.push(Meeting { query: "distance", how, overlap: answer.overlap });
        }
        let points = [answer.point_a, answer.point_b].map(numbers);
        if self.is_seen(points, answer.normal.map(numbers), [lower, upper]) {
            return;
        }
        match answer.normal.map(numbers) {
            Some(normal) => {
                self.plane(("distance", how), normal, lower, || format!("{answer:?}"));
                self.points(("distance", how), points, normal, [lower, value, upper], || format!("{answer:?}"));
            }
            None => self.of_bodies(("distance", how), points, &[], || format!("{answer:?}")),
        }
    }

    fn signed_distance<V: Vector>(&mut self, how: &'static str, answer: &SignedDistance<V>, tolerance: f64) {
        let [lower, upper, value] = [answer.lower, answer.upper, answer.signed_distance].map(Scalar::as_f64);
        let is_converged = answer.status == Status::Converged;
        let allowed = tolerance * self.scale.size + WIDTH_OF_DISTANCES * self.scale.of_bounds();
        self.report.width("signed_distance", is_converged, [lower, upper, allowed], || format!("{how}: {answer:?}"));
        let is_ordered = lower <= value && value <= upper && answer.overlap == (value <= 0.0);
        self.report.claim((Law::Bound, "signed_distance"), is_ordered, || {
            format!("{how}, the signed distance is not within its own bounds, or not as the flag says: {answer:?}")
        });
        self.known.push(Answered { query: "signed_distance", how, lower, upper });
        if lower > 0.0 || upper < 0.0 {
            self.meetings.push(Meeting { query: "signed_distance", how, overlap: answer.overlap });
        }
        let (points, normal) = ([answer.point_a, answer.point_b].map(numbers), numbers(answer.normal));
        if self.is_seen(points, Some(normal), [lower, upper]) {
            return;
        }
        self.plane(("signed_distance", how), normal, lower, || format!("{answer:?}"));
        self.points(("signed_distance", how), points, normal, [lower, value, upper], || format!("{answer:?}"));
    }

    fn intersection<V: Vector>(&mut self, how: &'static str, answer: crate::Intersection<V>) {
        self.normals.extend(answer.axis.map(numbers));
        if let Some(overlap) = answer.decided() {
            self.meetings.push(Meeting { query: "intersects", how, overlap });
        }
    }

    /// Whether an answer with these numbers has been examined already.
    fn is_seen(&mut self, points: [Numbers; 2], normal: Option<Numbers>, bounds: [f64; 2]) -> bool {
        let claims = (points, normal, bounds);
        let is_seen = self.seen.contains(&claims);
        if !is_seen {
            self.seen.push(claims);
        }
        is_seen
    }

    /// The plane across a normal separates the bodies by the lower bound, to rounding.
    fn plane(
        &mut self,
        (query, how): (&'static str, &'static str),
        normal: Numbers,
        lower: f64,
        answer: impl FnOnce() -> alloc::string::String,
    ) {
        self.normals.push(normal);
        let gap = self.planes.apart.beyond(normal, &[])[1];
        self.report.claim((Law::Points, query), gap >= lower - POINTS * self.scale.of_points(), || {
            format!("{how}, the plane across the normal separates by {gap:e}, not by {lower:e}: {}", answer())
        });
    }

    /// The points are of their bodies, apart by the scalar along the normal, and at the planes across it.
    fn points(
        &mut self,
        (query, how): (&'static str, &'static str),
        points: [Numbers; 2],
        normal: Numbers,
        [lower, value, upper]: [f64; 3],
        answer: impl Fn() -> alloc::string::String,
    ) {
        let (rounding, width) = (POINTS * self.scale.of_points(), (upper - lower).max(0.0));
        let off = length(core::array::from_fn(|i| points[0][i] - points[1][i] - value * normal[i]));
        // A plane that proves the lower bound may lean by this from the direction between the points.
        let reach = if value > 0.0 { upper } else { self.scale.size };
        let lean = num_traits::Float::sqrt(2.0 * reach * width);
        self.report.claim((Law::Points, query), off <= lean + rounding, || {
            format!("{how}, the points differ by {off:e} from the scalar along the normal: {}", answer())
        });
        for (who, point, outward) in [(self.planes.a, points[0], minus(normal)), (self.planes.b, points[1], normal)] {
            let before = who.beyond(outward, &[(1.0, point)])[1];
            self.report.claim((Law::Points, query), before >= -width - rounding, || {
                format!("{how}, the point {point:?} is {before:e} before the plane of its body: {}", answer())
            });
        }
        self.of_bodies((query, how), points, &[normal, minus(normal)], answer);
    }

    /// The points are of their bodies: no plane has one beyond its body.
    fn of_bodies(
        &mut self,
        (query, how): (&'static str, &'static str),
        points: [Numbers; 2],
        normals: &[Numbers],
        answer: impl Fn() -> alloc::string::String,
    ) {
        let rounding = POINTS * self.scale.of_points();
        let normals: Vec<Numbers> = normals.iter().chain(self.normals.iter().take(2)).copied().collect();
        for (who, point) in [(self.planes.a, points[0]), (self.planes.b, points[1])] {
            for &normal in &normals {
                let beyond = who.beyond(normal, &[(1.0, point)])[0];
                self.report.claim((Law::Points, query), beyond <= rounding, || {
                    format!("{how}, the point {point:?} is {beyond:e} outside its body: {}", answer())
                });
            }
        }
    }

    /// Holds the answers against one another, and against all planes.
    fn end(mut self) -> Report {
        let mut normals = Vec::new();
        for &normal in &self.normals {
            if !normals.contains(&normal) {
                normals.push(normal);
            }
        }
        let gaps = normals.iter().map(|&normal| (self.planes.apart.beyond(normal, &[])[0], normal));
        let best = gaps.fold((f64::NEG_INFINITY, [0.0; 3]), |best, gap| if gap.0 > best.0 { gap } else { best });
        let Self { report, known, meetings, .. } = &mut self;
        for k in &*known {
            report.claim((Law::Bound, k.query), best.0 <= k.upper, || {
                format!("{}, the plane across {:?} separates by {:e}, not {:e}", k.how, best.1, best.0, k.upper)
            });
        }
        let highest = known.iter().max_by(|x, y| x.lower.total_cmp(&y.lower));
        let lowest = known.iter().min_by(|x, y| x.upper.total_cmp(&y.upper));
        if let (Some(x), Some(y)) = (highest, lowest) {
            report.claim((Law::Overlap, x.query), x.lower <= y.upper, || {
                format!("{} it is {:e} at least, but by {} {} {:e} at most", x.how, x.lower, y.query, y.how, y.upper)
            });
        }
        let (meet, apart): (Vec<_>, Vec<_>) = meetings.iter().partition(|meeting| meeting.overlap);
        let both = meet.first().zip(apart.first());
        report.claim((Law::Certain, "intersects"), both.is_none(), || {
            let told =
                both.map(|(x, y)| format!("they meet by {} {}, and do not by {} {}", x.query, x.how, y.query, y.how));
            told.unwrap_or_default()
        });
        self.report
    }
}
