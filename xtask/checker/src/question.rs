//! A query as one set and one ray, and what a plane or a certificate's points prove of it.
//!
//! All is about a set `C`, the target of a ray or `A − B ⊕ B(target distance)`, and the points `x(λ) = source +
//! λ·direction` from the beginning of the ray on; for `distance` and `intersect`, whose `x` is zero, the direction is
//! zero too. (Of `growth_distance` the last λ counts: [`crate::growth`].) A plane across `n` has `C` behind it, `n·y ≤
//! h(n)`: that bounds distance, or the first λ with `x(λ)` in `C`, from below. Points of `C` bound it from above.

use serde_json::Value;

use crate::body::{Body, Set, difference};
use crate::certificate::{Bounds, Certificate};
use crate::interval::{Interval, Vector};
use crate::reader::{Reader, Unread, field, only};

/// The kinds of queries that have a certificate of one plane and some points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Distance,
    Intersect,
    RayCast,
    LinearCast,
    Growth,
}

/// A query as one set and one ray.
pub(crate) struct Question {
    pub(crate) kind: Kind,
    /// The target of a ray, or `a` and `b`, each with its velocity.
    pub(crate) bodies: Vec<(Body, Vector)>,
    pub(crate) set: Body,
    /// Where the ray begins.
    source: Vector,
    pub(crate) direction: Vector,
    /// The least λ that counts.
    pub(crate) begin: Interval,
    /// The end of the ray, which may be infinite.
    pub(crate) end: Interval,
    pub(crate) target_distance: Interval,
    /// What the bodies grow about, if that is asked.
    pub(crate) centers: Vec<Vector>,
    /// Whether a start in contact is a hit only where the bodies get deeper.
    pub(crate) is_of_deeper: bool,
    /// Whether planes are told with the set before them, as those between two shapes.
    is_pair: bool,
    /// The unit of rounding of the query's precision.
    pub(crate) rounding: Interval,
    /// The relative tolerance that is asked for.
    pub(crate) tolerance: Interval,
}

/// The fields of every query: those that only describe the line, those of which the truth does not depend (`allow` and
/// `tol` say what an answer claims), and those of the proof.
pub(crate) const EVERY: &[&str] = &[
    "id",
    "query",
    "precision",
    "tol",
    "method",
    "expect",
    "tags",
    "allow",
    "allow_fields",
    "bracket",
    "answer",
    "certificate",
];

/// How near is too near, where a query may say it.
pub(crate) fn target_distance(line: &Value, reader: &Reader<'_>) -> Result<Interval, Unread> {
    match line.get("target_distance").map_or(Ok(0.0), |value| reader.number(value))? {
        negative if negative < 0.0 => Err("target_distance is negative".to_owned()),
        distance => Ok(Interval::from(distance)),
    }
}

impl Kind {
    /// The kind of a query, and the fields that its question may have beside those of [`EVERY`] one: each is read by
    /// [`Question::read`]. A `gradient` asks for further fields of the answer.
    const ALL: &[(&str, Self, &[&str])] = &[
        ("distance", Self::Distance, &["a", "b", "gradient"]),
        ("intersect", Self::Intersect, &["a", "b"]),
        ("ray_cast", Self::RayCast, &["target", "source", "direction", "min_lambda", "max_lambda"]),
        (
            "linear_cast",
            Self::LinearCast,
            &["a", "b", "velocity_a", "velocity_b", "max_time", "target_distance", "start_in_contact", "gradient"],
        ),
        ("growth_distance", Self::Growth, &["a", "b", "center_a", "center_b"]),
    ];

    fn read(line: &Value) -> Result<Self, Unread> {
        let query = field(line, "query")?.as_str().unwrap_or_default();
        let known = Self::ALL.iter().find(|(name, ..)| *name == query);
        let (_, kind, own) = known.ok_or_else(|| format!("there are no certificates for \"{query}\""))?;
        only(line, "the query", &[EVERY, own])?;
        Ok(*kind)
    }

    /// What the format calls the scalar of a hit.
    pub(crate) fn scalar(self) -> &'static str {
        match self {
            Self::Distance | Self::Intersect => "distance",
            Self::RayCast => "lambda",
            Self::LinearCast => "time",
            Self::Growth => "scale",
        }
    }

    pub(crate) fn is_cast(self) -> bool {
        matches!(self, Self::RayCast | Self::LinearCast)
    }
}

impl Question {
    pub(crate) fn read(line: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        let kind = Kind::read(line)?;
        let get = |name| field(line, name);
        let number =
            |name, default| line.get(name).map_or(Ok(default), |value| reader.number(value).map(Interval::from));
        let velocity = |name| reader.vector_or_zero(line, name);
        let zero = Interval::zero;
        let centers = ["center_a", "center_b"].into_iter().filter(|_| kind == Kind::Growth);
        let centers = centers.map(|name| reader.vector(get(name)?)).collect::<Result<Vec<_>, _>>()?;
        let (bodies, first, direction) = if kind == Kind::RayCast {
            let (source, direction) = (reader.vector(get("source")?)?, reader.vector(get("direction")?)?);
            (vec![(reader.body(get("target")?)?, Vector::zero())], source, direction)
        } else {
            // `A + t·v_A` and `B + t·v_B` meet where `t·(v_B − v_A)` is in `A − B`.
            let (a, b) = (reader.body(get("a")?)?, reader.body(get("b")?)?);
            let (velocity_a, velocity_b) = (velocity("velocity_a")?, velocity("velocity_b")?);
            let direction = match centers.as_slice() {
                [center_a, center_b] => center_b.minus(center_a),
                _ => velocity_b.minus(&velocity_a),
            };
            (vec![(a, velocity_a), (b, velocity_b)], Vector::zero(), direction)
        };
        // A negative beginning is taken for zero.
        let begin = number("min_lambda", zero())?.max(&zero());
        let end = number(if kind == Kind::RayCast { "max_lambda" } else { "max_time" }, Interval::infinity())?;
        let target_distance = target_distance(line, reader)?;
        let is_of_deeper = match line.get("start_in_contact").map(Value::as_str) {
            None | Some(Some("report")) => false,
            Some(Some("if_deeper")) => true,
            Some(_) => return Err("start_in_contact is neither \"report\" nor \"if_deeper\"".to_owned()),
        };
        let mut set = match bodies.as_slice() {
            [(a, _), (b, _)] => difference(a.clone(), b.clone()),
            _ => bodies[0].0.clone(),
        };
        set.radius = &set.radius + &target_distance;
        if kind == Kind::Growth {
            // `(A − c_A) − (B − c_B)`.
            set.core = Set::Sum(vec![set.core, Set::Points(vec![direction.clone()])]);
        }
        Ok(Self {
            kind,
            centers,
            is_pair: bodies.len() == 2,
            bodies,
            set,
            source: first.plus(&direction.times(&begin)),
            direction,
            begin,
            end,
            target_distance,
            is_of_deeper,
            rounding: reader.rounding(),
            tolerance: number("tol", zero())?,
        })
    }

    /// The distance of two bodies.
    pub(crate) fn of_distance(a: Body, b: Body, reader: &Reader<'_>) -> Self {
        let (zero, still) = (Interval::zero, Vector::zero);
        Self {
            kind: Kind::Distance,
            set: difference(a.clone(), b.clone()),
            bodies: vec![(a, still()), (b, still())],
            source: still(),
            direction: still(),
            begin: zero(),
            end: Interval::infinity(),
            target_distance: zero(),
            centers: Vec::new(),
            is_of_deeper: false,
            is_pair: true,
            rounding: reader.rounding(),
            tolerance: zero(),
        }
    }

    pub(crate) fn core(&self) -> &Set {
        &self.set.core
    }

    /// The point of the ray at a λ.
    pub(crate) fn at(&self, lambda: &Interval) -> Vector {
        self.source.plus(&self.direction.times(&(lambda - &self.begin)))
    }

    /// A bound on all numbers that the answer comes by until a λ.
    pub(crate) fn magnitude(&self, until: &Interval) -> Interval {
        let bodies = self.bodies.iter().map(|(body, velocity)| &body.magnitude() + &(&velocity.length() * until));
        let ray = &self.source.length() + &(&self.direction.length() * until);
        bodies.fold(&ray + &self.target_distance, |sum, part| &sum + &part)
    }

    /// How far the set reaches along a normal, times the length of that.
    pub(crate) fn reach(&self, normal: &Vector) -> Interval {
        &self.set.core.support(normal).1 + &(&self.set.radius * &normal.length())
    }

    /// How far the beginning is before the plane across a normal as it is told, at least, times the length of the
    /// normal, and the normal out of the set.
    pub(crate) fn ahead(&self, told: &Vector) -> (Interval, Vector) {
        let normal = if self.is_pair { told.times(&Interval::from(-1.0)) } else { told.clone() };
        let reach = self.reach(&normal);
        (&normal.dot(&self.source) - &reach, normal)
    }

    /// What the plane across a normal as it is told proves: the distance, or the first λ, is not less.
    pub(crate) fn lower(&self, told: &Vector) -> Interval {
        let (ahead, normal) = self.ahead(told);
        if !self.kind.is_cast() {
            return ahead.over(&normal.length()).least().max(&Interval::zero());
        }
        if !Interval::zero().is_less_than(&ahead) {
            return self.begin.clone();
        }
        let approach = -&normal.dot(&self.direction);
        let never = approach.is_at_most(&Interval::zero());
        if never { Interval::infinity() } else { (&self.begin + &ahead.over(&approach)).least() }
    }

    /// What a certificate proves.
    pub(crate) fn proved(&self, certificate: &Certificate) -> Bounds {
        if self.kind == Kind::Growth {
            return self.proved_of_growth(certificate);
        }
        let least = if self.kind.is_cast() { self.begin.clone() } else { Interval::zero() };
        let lower = certificate.plane.as_ref().map_or(least, |plane| self.lower(plane));
        Bounds { lower, upper: if self.kind.is_cast() { self.first(certificate) } else { self.gap(certificate) } }
    }

    /// What the points prove of the distance of the set from the source: it is not more.
    fn gap(&self, certificate: &Certificate) -> Interval {
        if self.contains_source(certificate) {
            return Interval::zero();
        }
        let gap = certificate.mean().map(|mean| &mean.minus(&self.source).length() - &self.set.radius);
        gap.map_or_else(Interval::infinity, |gap| gap.max(&Interval::zero()).greatest())
    }

    /// What they prove of the first λ with `x(λ)` in the set: it is not more.
    fn first(&self, certificate: &Certificate) -> Interval {
        let source = self.contains_source(certificate).then(Interval::zero);
        let found = [source, self.entry_of_ball(certificate), self.entry_of_simplex(certificate)];
        let first = found.into_iter().flatten().reduce(|a, b| a.min(&b));
        first.map_or_else(Interval::infinity, |first| (&self.begin + &first).greatest())
    }

    /// Where the ray enters the ball that sweeps the mean of the points: the lesser root of `|x(λ) − p|² = r²`.
    fn entry_of_ball(&self, certificate: &Certificate) -> Option<Interval> {
        let from = self.source.minus(&certificate.mean()?);
        let excess = &from.squared() - &self.set.radius.squared();
        if excess.is_at_most(&Interval::zero()) {
            return Some(Interval::zero());
        }
        let (a, b) = (self.direction.squared(), self.direction.dot(&from));
        let discriminant = &b.squared() - &(&a * &excess);
        let at = (&-&b - &discriminant.root()).over(&a);
        (discriminant.is_not_negative() && at.is_not_negative()).then_some(at)
    }

    /// Where the ray first pierces a simplex.
    fn entry_of_simplex(&self, certificate: &Certificate) -> Option<Interval> {
        self.pierced(certificate).reduce(|a, b| a.min(&b))
    }

    /// Where the ray pierces simplices of as many of the points as there are dimensions.
    ///
    /// The unknowns are the weights `w` and λ of `Σ wᵢ·pᵢ − λ·direction = source`, `Σ wᵢ = 1`.
    pub(crate) fn pierced<'c>(&'c self, certificate: &'c Certificate) -> impl Iterator<Item = Interval> + 'c {
        let Certificate { points, dimension, .. } = certificate;
        let simplices: Vec<Vec<usize>> = match points.len().checked_sub(*dimension) {
            None => Vec::new(),
            Some(0) => vec![(0..points.len()).collect()],
            Some(_) => (0..points.len()).map(|i| (0..points.len()).filter(|j| *j != i).collect()).collect(),
        };
        let column = self.direction.times(&Interval::from(-1.0));
        simplices.into_iter().filter_map(move |simplex| {
            let solved = certificate.solve(&simplex, Some(&column), &self.source)?;
            solved.last().filter(|at| at.is_not_negative()).cloned()
        })
    }

    /// Whether the source is in the ball about the mean of the points, or in their simplex.
    fn contains_source(&self, certificate: &Certificate) -> bool {
        let beside = certificate.mean().map(|mean| mean.minus(&self.source).squared());
        let is_in_ball = beside.is_some_and(|squared| squared.is_at_most(&self.set.radius.squared()));
        let all: Vec<usize> = (0..certificate.points.len()).collect();
        is_in_ball || (all.len() == certificate.dimension + 1 && certificate.solve(&all, None, &self.source).is_some())
    }
}
