//! Algorithm 3's own steps: by GJK towards a point of the ray, or towards the whole of its line.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::Body;
use crate::cast::{End, ScalarOf, Search};
use crate::closest::Closest;
use crate::decrease::Decrease;
use crate::entry::{Entry, entry};
use crate::flat::project;
use crate::simplex::MAX_POINTS;
use crate::{Iterate, Status};

/// Slopes of planes, as cosines of the angle between normal and ray, below which steps along the ray gain little.
const GRAZING: f64 = 0.1;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// GJK steps, beginning along `n`, until the ray enters the simplex of support points, or touches the body.
    pub(crate) fn approach(&mut self, mut n: B::Vector) -> Result<Option<Entry<B::Vector>>, End<B::Vector>> {
        let zero = ScalarOf::<B>::ZERO;
        let line = self.local.line;
        let mut across = false;
        // The distances of the simplex from x and from the line decrease while x stays; near contact by less than
        // rounding for a few steps, while v turns.
        let (mut nearing, mut nearing_across) = (Decrease::new(), Decrease::new());
        loop {
            let before = self.low;
            let (point, witness) = self.probe(n)?;
            if self.low > before {
                nearing = Decrease::new();
            }
            if !self.simplex.points().contains(&point) {
                self.simplex.push(point, n, witness);
                let found = entry(self.simplex.points(), line, self.radius, self.noise);
                if let Some(found) = found.filter(|e| e.mu >= self.low - self.low_error - self.noise) {
                    return Ok(Some(found));
                }
            }
            // The paper's step: the point of {x} − P closest to zero.
            let x = line.at(self.low);
            let Closest { v, face, weights } = self.toward(|p| x - p, B::Vector::DIM)?;
            let length = v.norm();
            if length - self.radius <= self.noise {
                // x is in the body, or no farther from it than rounding.
                self.simplex.retain(face, weights);
                (self.high, self.high_error) = (self.low, self.low_error);
                if self.low > self.local.start {
                    // Where the search began and no plane was crossed, that of the ball about the body is the one.
                    self.normal = self.normal.or_else(|| x.unit()).or(Some(-line.direction));
                }
                return Ok(None);
            }
            let slope = v.dot(line.direction) / length;
            let progress = nearing.goes_on(length);
            across |= slope < zero && (!progress || slope > -ScalarOf::<B>::from_f64(GRAZING));
            if progress && (!across || slope >= zero) {
                self.simplex.retain(face, weights);
                (self.v, n) = (v, v / length);
                continue;
            }
            // The same across the ray, with the whole line for x.
            let Closest { v, face, weights } = self.toward(|p| line.across(line.foot - p), B::Vector::DIM - 1)?;
            // A short vector that long ones cancelled to leans along the ray by their rounding, and a plane that leans
            // does not stay before the whole ray.
            let v = line.across(v);
            let length = v.norm();
            self.simplex.retain(face, weights);
            // The body and v are each known to the noise only: where nothing brings the line nearer, both may be what is left.
            let progress = nearing_across.goes_on(length);
            let within = if progress { self.noise } else { self.noise + self.noise };
            if length - self.radius <= within {
                if slope >= zero {
                    // Where it does, the ray may be past the simplex.
                    return Err(End::Open(Status::Stalled));
                }
                // The line comes within rounding of the simplex without entering it ahead of x.
                let mu = self.simplex.weighted_point().dot(line.direction).max(self.low);
                let error = if self.low_slope > zero { self.noise / self.low_slope } else { self.noise };
                (self.high, self.high_error, self.touched) = (mu, error, Some(mu));
                // Where the ray grazes what is round, the shortest vector is the normal, and the last plane is of elsewhere. Without a
                // radius it has no digits; where no plane was crossed either, the ray meets the face of the simplex head-on.
                self.normal = if self.radius > self.noise {
                    v.unit()
                } else {
                    let head_on = || project(self.simplex.points(), |_| -line.direction).across.unit();
                    self.normal.or_else(head_on).or(Some(-line.direction))
                };
                return Ok(None);
            }
            if !progress {
                return Err(End::Open(Status::Stalled));
            }
            nearing = Decrease::new();
            (self.v, n) = (v, v / length);
        }
    }

    /// The point closest to zero of the simplex seen through `map`, in a space of `dimension` dimensions.
    fn toward(
        &self,
        map: impl Fn(B::Vector) -> B::Vector,
        dimension: usize,
    ) -> Result<Closest<B::Vector>, End<B::Vector>> {
        let mut seen = [B::Vector::ZERO; MAX_POINTS];
        for (s, p) in seen.iter_mut().zip(self.simplex.points()) {
            *s = map(*p);
        }
        let points = &seen[..self.simplex.points().len()];
        self.options.sub_algorithm.closest(points, dimension).ok_or(End::Open(Status::Stalled))
    }
}
