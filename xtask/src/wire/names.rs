//! Names out of a list, and what another name was probably meant for.

/// The names of fields.
pub type Names = &'static [&'static str];

/// How alike two names are, if one may be meant where the other is written: the share of letters that need not be
/// changed.
const ALIKE: f64 = 0.6;

/// Words of other libraries and formats, and the name here of what they mean.
const ELSEWHERE: &[[&str; 2]] = &[
    ["sphere", "ball"],
    ["box", "cuboid"],
    ["convex", "polytope"],
    ["convex_mesh", "polytope"],
    ["frustum", "hull"],
    ["pose", "posed"],
    ["transform", "posed"],
    ["position", "translation"],
    ["orientation", "rotation"],
    ["origin", "source"],
    ["shape_cast", "linear_cast"],
    ["sweep", "linear_cast"],
    ["time_of_impact", "linear_cast"],
    ["ccd", "motion_cast"],
    ["penetration", "signed_distance"],
    ["collide", "intersect"],
    ["overlap", "intersect"],
    ["manifold", "contact"],
    ["closest_points", "distance"],
    ["mvee", "enclosing_ellipsoid"],
];

/// Names, and what they stand for.
pub trait Table<T>: IntoIterator<Item = (&'static str, T)> + Clone {}

impl<T, I: IntoIterator<Item = (&'static str, T)> + Clone> Table<T> for I {}

/// What a name stands for; else what is to be said of it.
pub fn choose<T>(name: &str, table: impl Table<T>) -> Result<T, String> {
    let found = table.clone().into_iter().find(|(known, _)| *known == name);
    let unknown = || format!("{name:?} is unknown{}", instead_of(name, table.into_iter().map(|(known, _)| known)));
    found.map(|(_, value)| value).ok_or_else(unknown)
}

/// The name that was probably meant by an unknown one, and the names there are, to be said after it.
#[must_use]
pub fn instead_of(name: &str, known: impl Iterator<Item = &'static str>) -> String {
    let known: Vec<&str> = known.collect();
    let elsewhere = ELSEWHERE.iter().find(|[word, here]| *word == name && known.contains(here)).map(|[_, here]| *here);
    let alike = known
        .iter()
        .map(|known| (strsim::normalized_damerau_levenshtein(name, known), *known))
        .filter(|(alike, _)| *alike > ALIKE);
    let alike = alike.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, meant)| meant);
    let meant = elsewhere.or(alike).map(|meant| format!(", did you mean {meant:?}?")).unwrap_or_default();
    format!("{meant} (known: {})", known.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_pen_is_told_from_another_word() {
        let said = |name| choose(name, [("ray_cast", 1), ("linear_cast", 2), ("scene", 3)]);
        assert_eq!(said("linear_cast"), Ok(2));
        let known = "(known: ray_cast, linear_cast, scene)";
        for (name, meant) in
            [("raycast", "ray_cast"), ("liner_cast", "linear_cast"), ("scenes", "scene"), ("sweep", "linear_cast")]
        {
            assert_eq!(said(name), Err(format!("{name:?} is unknown, did you mean {meant:?}? {known}")));
        }
        // A sphere is a ball, where there are balls.
        for name in ["volume", "s", "", "sphere"] {
            assert_eq!(said(name), Err(format!("{name:?} is unknown {known}")));
        }
    }
}
