//! What an answer says of itself, as laws for any shapes; with the feature `laws`, and as property tests with the
//! feature `proptest`.
//!
//! Each function asks a question several times, with other options, methods, starts and orders of the bodies, and
//! holds every claim of every answer against the others and against planes. [`Law`] lists the claims. The planes are
//! those of the shapes' own support points and stated errors; `…_judged` takes planes from elsewhere, such as from
//! arithmetic with intervals.
//!
//! ```
//! use gjk_raycast::convex_support::{Ball, Cuboid, Posed, glam::DVec3};
//! use gjk_raycast::laws;
//!
//! let (ball, cube) = (Ball::<DVec3>::new(1.0)?, Cuboid::new(DVec3::ONE)?);
//! let beside = Posed::translated(cube, DVec3::new(1.5, 0.5, 0.0))?;
//! let report = laws::pair(&ball, &beside, &[DVec3::Y]);
//! assert!(report.broken.is_empty(), "{report}");
//! # Ok::<(), gjk_raycast::convex_support::InvalidShape>(())
//! ```

mod cast;
mod linear;
mod manifold;
mod pair;
mod planes;
#[cfg(feature = "proptest")]
mod property;
mod ray;
mod turning;

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

use convex_support::{Scalar, SupportMap, Vector};

pub use linear::{linear_cast, linear_cast_judged};
pub use manifold::{contact, contact_judged};
pub use pair::{pair, pair_judged};
pub use planes::{Numbers, PairPlanes, Planes, Term};
#[cfg(feature = "proptest")]
pub use property::hold;
pub use ray::{ray, ray_judged};
pub use turning::{motion_cast, motion_cast_judged};

/// A shape of any type, so that the laws are compiled once for each vector type.
pub type AnyShape<'s, V> = &'s dyn SupportMap<Vector = V>;

/// A claim of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Law {
    /// `Converged` means that the bracket is no wider than `docs/evidence.md` says for the query.
    Width,
    /// Points are of their bodies, differ by the scalar along the normal, and are at the planes that prove the bound.
    Points,
    /// What is certain is contradicted by no option, method, start, order of the bodies, or exact comparison.
    Certain,
    /// Two brackets of one number overlap.
    Overlap,
    /// The error of a point of contact holds.
    Error,
    /// No plane refutes a bound.
    Bound,
}

/// A claim that is false.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// The kind of claim.
    pub law: Law,
    /// The query that makes it.
    pub query: &'static str,
    /// Which options, and which numbers.
    pub what: String,
}

impl Display for Broken {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} of {}: {}", self.law, self.query, self.what)
    }
}

/// What became of the claims of answers.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Report {
    /// The claims that are false.
    pub broken: Vec<Broken>,
    /// How many claims were examined.
    pub examined: u64,
    /// For each query, the widest bracket of an answer that is `Converged`, as a part of what is allowed.
    pub widest: Vec<(&'static str, f64)>,
}

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.broken.iter().try_for_each(|broken| writeln!(f, "{broken}"))
    }
}

impl Report {
    /// Adds what became of other claims.
    pub fn add(&mut self, other: Self) {
        self.broken.extend(other.broken);
        self.examined += other.examined;
        other.widest.into_iter().for_each(|(query, part)| self.widest(query, part));
    }

    fn widest(&mut self, query: &'static str, part: f64) {
        match self.widest.iter_mut().find(|(of, _)| *of == query) {
            Some((_, widest)) => *widest = widest.max(part),
            None => self.widest.push((query, part)),
        }
    }

    /// A claim; `what` says it if it does not hold.
    fn claim(&mut self, (law, query): (Law, &'static str), holds: bool, what: impl FnOnce() -> String) {
        self.examined += 1;
        if !holds {
            self.broken.push(Broken { law, query, what: what() });
        }
    }

    /// The width of a bracket that is as narrow as can be, if `is_converged`, and what is allowed.
    fn width(
        &mut self,
        query: &'static str,
        is_converged: bool,
        [lower, upper, allowed]: [f64; 3],
        what: impl FnOnce() -> String,
    ) {
        if is_converged {
            let width = upper - lower;
            let part = if width <= 0.0 { 0.0 } else { width / allowed };
            self.claim((Law::Width, query), part <= 1.0, || {
                alloc::format!("[{lower:e}, {upper:e}] is {part:.1e} times as wide as allowed: {}", what())
            });
            self.widest(query, part);
        }
    }
}

/// The unit that widths and errors are told in: the machine epsilon times a size, plus the errors that the shapes
/// state.
#[derive(Clone, Copy)]
struct Scale {
    epsilon: f64,
    /// The size of both shapes, and the offset of their origins.
    size: f64,
    /// The errors of their support points.
    error: f64,
    /// How far they are from the origin of the world, where points are rounded.
    place: f64,
}

impl Scale {
    fn of<V: Vector>(a: AnyShape<'_, V>, b: AnyShape<'_, V>) -> Self {
        let [a, b] = [a.core(), b.core()];
        let at = [a.origin, b.origin].map(planes::numbers);
        let offset = planes::length(core::array::from_fn(|i| at[0][i] - at[1][i]));
        Self {
            epsilon: V::Scalar::EPSILON.as_f64(),
            size: a.size().as_f64() + b.size().as_f64() + offset,
            error: a.error.as_f64() + b.error.as_f64(),
            place: planes::length(at[0]) + planes::length(at[1]),
        }
    }

    /// The rounding of numbers of the size.
    fn unit(&self) -> f64 {
        self.epsilon * self.size + self.error
    }

    /// The error of a bound.
    fn of_bounds(&self) -> f64 {
        8.0 * self.epsilon * self.size + self.error
    }

    /// The rounding of points, which are told in the world.
    fn of_points(&self) -> f64 {
        self.unit() + self.epsilon * self.place
    }
}
