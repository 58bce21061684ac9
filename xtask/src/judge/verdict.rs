//! A claim held against what is proved.

use super::fact::{Bodies, Fact};

/// What somebody answered.
#[derive(Clone, Copy, Debug, Default)]
pub struct Claim {
    /// Whether there is a hit or an overlap, where that was said.
    pub flag: Option<bool>,
    /// The time, the distance or minus the depth.
    pub scalar: Option<f64>,
}

/// What became of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Within what is allowed of what is proved.
    Right,
    /// A hit, a miss, an overlap or a gap that is, but another time or length.
    Inaccurate,
    /// A hit, a miss, an overlap or a gap that is shown not to be.
    Disproved,
    /// Nothing is proved that it could be held against.
    Undecided,
}

/// The judgement.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub outcome: Outcome,
    /// How wrong it can be by what is proved, in parts of the reach of the scene; none where no length was asked.
    pub error: Option<f64>,
    /// What shows it.
    pub evidence: String,
}

impl Verdict {
    /// By how much it is off at least, which decides, and at most, which is told.
    fn by_length([least, most]: [f64; 2], allowed: f64, reach: f64) -> Self {
        let outcome = if least <= allowed { Outcome::Right } else { Outcome::Inaccurate };
        Self { outcome, error: Some(most / reach), evidence: format!("off by {least:.3e} at least") }
    }

    fn open() -> Self {
        Self { outcome: Outcome::Undecided, error: None, evidence: String::new() }
    }

    fn right() -> Self {
        Self { outcome: Outcome::Right, error: None, evidence: String::new() }
    }

    fn disproved(length: f64, reach: f64, evidence: String) -> Self {
        Self { outcome: Outcome::Disproved, error: Some(length / reach), evidence }
    }
}

/// Judges a claim; a length of `allowed` is nobody's mistake.
pub fn judge(claim: Claim, fact: Fact, bodies: &Bodies, allowed: f64) -> Verdict {
    match fact {
        Fact::Open => Verdict::open(),
        Fact::Hit(_) | Fact::Graze(_) | Fact::Miss => judge_cast(claim, fact, bodies, allowed),
        Fact::Distance(bounds) => judge_distance(claim, bounds, bodies, allowed),
    }
}

/// A cast is right where the bodies touch, within what is allowed, at the time that it names and not before.
fn judge_cast(Claim { flag, scalar }: Claim, fact: Fact, bodies: &Bodies, allowed: f64) -> Verdict {
    let reach = bodies.reach;
    match (fact, flag, scalar) {
        (Fact::Miss, Some(false), _) => Verdict::right(),
        (Fact::Miss, _, Some(time)) => {
            let [apart, at_most] = bodies.gap(time).unwrap_or([0.0, f64::INFINITY]);
            if apart <= allowed {
                return Verdict::by_length([apart.max(0.0), at_most.abs()], allowed, reach);
            }
            Verdict::disproved(
                apart,
                reach,
                format!("they never meet, and at {time:e} they are {apart:.3e} apart at least"),
            )
        }
        // Whether they meet is open; a hit is one where they touch, and did not overlap before.
        (Fact::Graze(_), Some(false), _) => Verdict::open(),
        (Fact::Graze(lower), _, Some(time)) => {
            let [apart, at_most] = bodies.gap(time).unwrap_or([0.0, f64::INFINITY]);
            let moved_on = ((time - lower) * bodies.speed).max(0.0);
            Verdict::by_length([apart.max(-at_most).max(0.0), at_most.abs().max(moved_on)], allowed, reach)
        }
        (Fact::Hit([_, upper]), Some(false), _) => {
            let (time, depth) = bodies.deepest(upper);
            if depth <= allowed {
                return Verdict::right();
            }
            Verdict::disproved(depth, reach, format!("at {time:e} they are {depth:.3e} deep in one another at least"))
        }
        (Fact::Hit([lower, upper]), _, Some(time)) => {
            let along = |from: f64, to: f64| ((to - from) * bodies.speed).max(0.0);
            let early = [along(time, lower), along(time, upper)];
            if time < lower {
                // They touch later, but may be as near as that already.
                let gap = bodies.gap(time).unwrap_or(early);
                return Verdict::by_length([0, 1].map(|k| gap[k].clamp(0.0, early[k])), allowed, reach);
            }
            Verdict::by_length([along(upper, time), early[1].max(along(lower, time))], allowed, reach)
        }
        _ => {
            Verdict { outcome: Outcome::Inaccurate, error: None, evidence: "neither hit nor miss was said".to_owned() }
        }
    }
}

/// A distance is held against the bounds, and what it says of overlap against their signs.
fn judge_distance(Claim { flag, scalar }: Claim, [lower, upper]: [f64; 2], bodies: &Bodies, allowed: f64) -> Verdict {
    let reach = bodies.reach;
    let overlaps = flag.or(scalar.map(|d| d <= 0.0));
    if overlaps == Some(true) && lower > allowed {
        return Verdict::disproved(lower, reach, format!("they are {lower:.3e} apart at least"));
    }
    if overlaps == Some(false) && upper <= 0.0 {
        // The bounds of a distance end at zero where bodies overlap; how deep they are is another question.
        let depth = -bodies.gap(0.0).map_or(0.0, |gap| gap[1]);
        if depth > allowed && scalar.is_none_or(|d| d > allowed) {
            return Verdict::disproved(depth, reach, format!("they are {depth:.3e} deep in one another at least"));
        }
    }
    match scalar {
        Some(d) if d.is_finite() => {
            Verdict::by_length([(lower - d).max(d - upper).max(0.0), (upper - d).max(d - lower)], allowed, reach)
        }
        Some(d) => Verdict { outcome: Outcome::Inaccurate, error: None, evidence: format!("{d} is no distance") },
        None => Verdict::right(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::json;

    /// The outcome of a claim about a query, where a millionth is nobody's mistake, and the error that is told.
    fn outcome(query: &str, flag: Option<bool>, scalar: Option<f64>) -> (Outcome, Option<f64>) {
        let object = json::object(query.as_bytes()).expect("JSON");
        let bodies = Bodies::of(&object).expect("two bodies");
        let verdict = judge(Claim { flag, scalar }, Fact::of(&object, Some(&bodies)), &bodies, 1e-6);
        (verdict.outcome, verdict.error)
    }

    const APART: &str =
        r#""a":{"type":"ball","radius":1},"b":{"type":"posed","translation":[3,0,0],"of":{"type":"ball","radius":1}}"#;

    #[test]
    fn distances_are_held_against_bounds() {
        let query = format!(r#"{{"query":"distance",{APART}}}"#);
        let ask = |scalar| outcome(&query, None, Some(scalar));
        assert_eq!(ask(1.0).0, Outcome::Right, "as it is");
        assert_eq!(ask(1.0 + 1e-7).0, Outcome::Right, "within what is allowed");
        let (off, error) = ask(1.1);
        // The reach is that of the corner (4, 1, 1) of a box.
        let error_due = 0.1 / f64::sqrt(18.0);
        assert!(
            off == Outcome::Inaccurate && (error.expect("a length") - error_due).abs() < 1e-12,
            "{error:?}, {error_due} due"
        );
        assert_eq!(ask(0.0).0, Outcome::Disproved, "they do not touch");
        assert_eq!(ask(f64::NAN).0, Outcome::Inaccurate, "no number");
        let overlap = format!(r#"{{"query":"intersect",{APART}}}"#);
        assert_eq!(outcome(&overlap, Some(true), None).0, Outcome::Disproved, "they do not touch");
        assert_eq!(outcome(&overlap, Some(false), None), (Outcome::Right, None), "no length was asked");
        let deep = overlap.replace("[3,0,0]", "[1,0,0]");
        assert_eq!(outcome(&deep, Some(false), None).0, Outcome::Disproved, "they are one deep in one another");
        let depth = deep.replace("intersect", "signed_distance");
        assert_eq!(outcome(&depth, Some(true), Some(-1.0)).0, Outcome::Right, "the depth is one");
        assert_eq!(outcome(&depth, Some(true), Some(-0.5)).0, Outcome::Inaccurate, "not half of it");
    }

    #[test]
    fn casts_are_held_against_gaps_and_depths() {
        let cast =
            |velocity: &str| format!(r#"{{"query":"linear_cast",{APART},"velocity_a":{velocity},"max_time":4}}"#);
        let (hit, miss) = (cast("[2,0,0]"), cast("[0,2,0]"));
        assert_eq!(outcome(&hit, Some(true), Some(0.5)).0, Outcome::Right, "they meet after half the time");
        assert_eq!(outcome(&hit, Some(true), Some(0.4)).0, Outcome::Inaccurate, "too early");
        assert_eq!(outcome(&hit, Some(true), Some(0.6)).0, Outcome::Inaccurate, "too late");
        assert_eq!(outcome(&hit, Some(false), None).0, Outcome::Disproved, "it goes through");
        assert_eq!(outcome(&miss, Some(false), None).0, Outcome::Right, "it goes past");
        assert_eq!(outcome(&miss, Some(true), Some(0.5)).0, Outcome::Disproved, "they are apart then");
    }

    /// A corner that is met by a corner to rounding: whoever says a miss may be right, and a hit is at that time or
    /// none.
    #[test]
    fn grazes_are_open_to_who_says_a_miss() {
        let query = r#"{"query":"linear_cast","a":{"type":"cuboid","half_extents":[1,0.5,0.25]},"b":{"type":"posed","of":{"type":"cuboid","half_extents":[1,0.5,0.25]},"rotation":[-0.2384743679799667,-0.8581547372714705,0.0696937552505257,0.4492696330647873],"translation":[-1.8676382472312878,5.955709892924724,1.220076103192911]},"velocity_b":[1.4539202451705933,-7.865894794464111,0.1175268366932869],"max_time":1}"#;
        assert_eq!(outcome(query, Some(false), None).0, Outcome::Undecided, "it may");
        let (right, error) = outcome(query, Some(true), Some(0.692_321_729_619_66));
        assert!(right == Outcome::Right && error.expect("a length") < 1e-12, "they touch: {error:?}");
        assert_eq!(outcome(query, Some(true), Some(0.68)).0, Outcome::Inaccurate, "too early");
        assert_eq!(outcome(query, Some(true), Some(0.72)).0, Outcome::Inaccurate, "too late");
    }

    /// A rod of length two turns about its middle into a ball beside it; in the plane, and about z in space.
    #[test]
    fn turning_bodies_are_where_they_are_at_a_time() {
        for (rod, at, rate) in
            [(r#"[[-1,0],[1,0]]"#, "[0,1.1]", "1.0"), (r#"[[-1,0,0],[1,0,0]]"#, "[0,1.1,0]", "[0,0,1.0]")]
        {
            let query = format!(
                r#"{{"query":"motion_cast","a":{{"type":"segment","points":{rod}}},"b":{{"type":"posed","translation":{at},"of":{{"type":"ball","radius":0.2}}}},"motion_a":{{"angular_velocity":{rate}}},"max_time":3}}"#
            );
            let bodies = Bodies::of(&json::object(query.as_bytes()).expect("JSON")).expect("two bodies");
            let quarter = std::f64::consts::FRAC_PI_2;
            let [lower, upper] = bodies.gap(quarter).expect("a bracket");
            assert!(
                (lower + 0.1).abs() < 1e-12 && (upper + 0.1).abs() < 1e-12,
                "its end is a tenth deep: {lower} {upper}"
            );
            assert_eq!(outcome(&query, Some(false), None).0, Outcome::Disproved, "it turns through");
            assert!(bodies.deepest(0.0).1 > 0.0999, "the deepest is found: {:?}", bodies.deepest(0.0));
        }
    }
}
