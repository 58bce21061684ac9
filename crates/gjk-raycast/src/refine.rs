//! The exchange of points that closes the bracket once the ray pierces the simplex.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::Body;
use crate::cast::{End, ScalarOf, Search};
use crate::entry::{Entry, entry};
use crate::johnson::within;
use crate::simplex::{MAX_POINTS, Simplex, faces};
use crate::turn::{Condition, Found, Recent, Turn, turn};
use crate::{Iterate, Status};

/// Exchanges of a point that gain nothing before the line is nudged.
const PATIENCE: usize = 3;

/// How often it is nudged at a time, each time twice as far, until it pierces the simplex.
const MAX_NUDGES: usize = 6;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// Closes the bracket between the last plane and the entry into the simplex: the next plane is taken along the
    /// normal at the entry, and the support point found there replaces one of the simplex such that the ray still
    /// enters it, and earlier.
    ///
    /// A ray that runs through an edge or a vertex enters more than one facet there, and like the simplex method of
    /// linear programming, the exchange of points can go round in circles. Then the line that the simplex is kept pierced
    /// by is nudged into the facet; planes are still crossed by the ray itself.
    pub(crate) fn refine(&mut self, entered: Option<Entry<B::Vector>>) -> Result<(), End<B::Vector>> {
        let Some(mut at) = entered else { return Ok(()) };
        let direction = self.local.line.direction;
        let mut wanted = self.noise.max(self.options.tolerance);
        let mut line = self.local.line;
        let zero = ScalarOf::<B>::ZERO;
        let (mut nudge, mut patience) = (zero, PATIENCE);
        // Newton's steps are taken while they shrink, and the facet's normal after one that did not; between two pieces,
        // every other step only goes back and forth.
        let (mut last_gap, mut stuck) = (ScalarOf::<B>::infinity(), 0);
        let unbounded = [ScalarOf::<B>::infinity(); 2];
        let mut angles = unbounded;
        let (mut recent, mut lead) = (Recent::new(), self.noise);
        self.simplex.retain(at.face, at.weights);
        loop {
            let slope = -at.n.dot(direction);
            // A point of the facet may be outside of the body by rounding, and is in it where the ray is that far behind the
            // plane that is crossed less steeply.
            let least = if self.low_slope > zero { slope.min(self.low_slope) } else { slope };
            (self.high, self.high_error) = (at.mu.max(self.low), (self.noise + nudge) / least);
            let shrunk = angles[0].max(angles[1]) * ScalarOf::<B>::from_f64(0.5);
            let newton = if stuck > PATIENCE { None } else { self.newton(&recent, lead) };
            let newton = newton.filter(|step| step.angle <= shrunk || stuck > 0);
            angles = newton.map_or(unbounded, |step| [step.angle, angles[0]]);
            let n = newton.map_or(at.n, |step| step.to);
            self.v = n;
            let (point, witness) = self.probe(n)?;
            let gap = (self.high - self.low) * slope.max(self.low_slope);
            if gap <= wanted {
                return Ok(());
            }
            let touch = point + n * self.radius;
            let progress = gap <= last_gap * ScalarOf::<B>::from_f64(0.5);
            (last_gap, stuck) = (gap, if progress || newton.is_none() { 0 } else { stuck + 1 });
            lead = if stuck == 0 { self.noise } else { lead * ScalarOf::<B>::from_f64(16.0) };
            recent.push(Found { point: touch, along: n }, witness);
            if self.touches(recent.simplex()) {
                return Ok(());
            }
            let known = self.simplex.points().contains(&point);
            if known && newton.is_none() {
                // Nothing is before the facet. One that is seen as a sliver is entered at a spot that is mostly rounding, while
                // the ray runs through an edge or a corner of it.
                let closed = self.radius == zero && self.touches(self.simplex);
                return if closed { Ok(()) } else { Err(End::Open(Status::Stalled)) };
            }
            if known {
                continue;
            }
            let facet = self.simplex.middle();
            let before = self.simplex;
            self.simplex.push(point, n, witness);
            let mut next = entry(self.simplex.points(), line, self.radius, self.noise);
            if newton.is_some() && next.is_none_or(|next| next.mu >= at.mu) {
                // Away from the facet's normal, there may be nothing before the facet.
                self.simplex = before;
                continue;
            }
            patience -= usize::from(next.is_none_or(|next| next.mu >= at.mu));
            let mut step = ScalarOf::<B>::from_f64(8.0) * self.noise;
            for _ in 0..MAX_NUDGES {
                if next.is_some() && patience > 0 {
                    break;
                }
                patience = PATIENCE;
                let inward = line.across(facet - line.foot);
                line.foot += inward.unit().unwrap_or(B::Vector::ZERO) * step.min(inward.norm());
                nudge += step;
                wanted += step;
                step += step;
                next = entry(self.simplex.points(), line, self.radius, self.noise);
            }
            match next {
                Some(next) if next.mu > self.low => {
                    at = next;
                    self.simplex.retain(at.face, at.weights);
                }
                // The body has points of the line on both sides of the lower bound, which so is in the body.
                Some(next) => {
                    self.simplex.retain(next.face, next.weights);
                    (self.high, self.high_error) = (
                        self.low,
                        self.low_error + if nudge > zero { nudge / slope.min(self.low_slope) } else { zero },
                    );
                    return Ok(());
                }
                None => return Err(End::Open(Status::Stalled)),
            }
        }
    }

    /// Whether the ray runs through one of some points of the body, or through a segment or triangle of them, where that also is
    /// where it crosses the last plane; then the bracket is closed.
    fn touches(&mut self, points: Simplex<B::Vector, B::Witness>) -> bool {
        let line = self.local.line;
        let slope = if self.low_slope > ScalarOf::<B>::ZERO { self.low_slope } else { ScalarOf::<B>::ONE };
        let mut seen = [B::Vector::ZERO; MAX_POINTS];
        for (s, &point) in seen.iter_mut().zip(points.points()) {
            *s = line.across(point - line.foot);
        }
        let seen = &seen[..points.points().len()];
        // Points first and triangles last, since the coordinates in a sliver are nothing but rounding.
        for corners in 1..=B::Vector::DIM {
            for face in faces(seen.len(), corners).filter(|face| face.len() == corners) {
                let Some(nearest) = within(seen, face, B::Vector::DIM - 1) else { continue };
                let mut touching = points;
                touching.retain(face, nearest.weights);
                // Measured again, for the same reason.
                let passed = touching.weighted_point();
                let aside = line.across(passed - line.foot).length();
                let mu = passed.dot(line.direction);
                let near = aside <= self.noise * ScalarOf::<B>::from_f64(0.5);
                if near && (mu - self.low) * slope <= self.noise + self.noise {
                    self.simplex = touching;
                    (self.high, self.high_error) = (mu.max(self.low), self.noise / slope);
                    return true;
                }
            }
        }
        false
    }

    /// The direction in which the plane crossed last should be crossed by the ray where it supports a curved body.
    fn newton(&self, recent: &Recent<B::Vector, B::Witness>, lead: ScalarOf<B>) -> Option<Turn<B::Vector>> {
        let line = self.local.line;
        // The corners of the simplex first, since what was found last was found nearest the answer.
        let mut found = [Found::default(); 2 * MAX_POINTS];
        let mut len = 0;
        for (&point, &along) in self.simplex.points().iter().zip(self.simplex.along()) {
            found[len] = Found { point: point + along * self.radius, along };
            len += 1;
        }
        for &last in recent.found() {
            found[len] = last;
            len += 1;
        }
        let condition = Condition {
            axis: line.direction,
            target: line.foot,
            distance: ScalarOf::<B>::ZERO,
            noise: self.noise,
            lead,
        };
        let step = turn(&found[..len], condition, |n, change| self.derivative(n, change))?;
        (step.to.dot(line.direction) < ScalarOf::<B>::ZERO).then_some(step)
    }

    /// The derivative of the swept body's support point; zero where the core is not curved, since a radius alone needs
    /// no iteration.
    fn derivative(&self, n: B::Vector, change: B::Vector) -> B::Vector {
        let core = self.body.derivative(n, change);
        if core == B::Vector::ZERO { core } else { self.swept_derivative(core, n, change) }
    }

    /// The derivative of the swept body's support point at `n` along `change`, given that of the core's.
    #[inline(always)]
    pub(crate) fn swept_derivative(&self, core: B::Vector, n: B::Vector, change: B::Vector) -> B::Vector {
        if self.radius == ScalarOf::<B>::ZERO {
            return core;
        }
        let across = change - n * (change.dot(n) / n.length_squared());
        core + across * (self.radius / n.norm())
    }
}
