//! How queries and shapes are written, for those whose query is not.

use super::reader::Object;

/// A name of the format, and the fields that go with it.
type Form = (&'static str, &'static str);

/// The queries.
pub(super) const QUERIES: &[Form] = &[
    ("ray_cast", r#""target": SHAPE, "source": VECTOR, "direction": VECTOR, and if wanted "max_lambda": NUMBER"#),
    ("distance", r#""a": SHAPE, "b": SHAPE"#),
    ("intersect", r#""a": SHAPE, "b": SHAPE"#),
    (
        "linear_cast",
        r#""a": SHAPE, "b": SHAPE, and if wanted "velocity_a": VECTOR, "velocity_b": VECTOR, "max_time": NUMBER"#,
    ),
    (
        "enclosing_ellipsoid",
        r#""points": [VECTOR, …] or "target": a polytope or mesh, and if wanted "epsilon": NUMBER"#,
    ),
    (
        "inscribed_ellipsoid",
        r#""points": [VECTOR, …] or "halfspaces": [{"normal": VECTOR, "offset": NUMBER}, …], and if wanted "epsilon": NUMBER"#,
    ),
    ("margin", r#""e1": ELLIPSOID, "e2": ELLIPSOID, and if wanted "gradient": true"#),
    ("track", r#""e1": ELLIPSOID, "e2": ELLIPSOID, "poses": [{"translation": VECTOR, "rotation": ROTATION}, …]"#),
    ("clearance", r#""links": [ELLIPSOID, …], "obstacles": [ELLIPSOID, …]"#),
];

/// The shapes.
pub(super) const SHAPES: &[Form] = &[
    ("point", r#""at": VECTOR"#),
    ("segment", r#""points": [VECTOR, VECTOR]"#),
    ("triangle", r#""points": [VECTOR, VECTOR, VECTOR]"#),
    ("ball", r#""radius": NUMBER"#),
    ("cuboid", r#""half_extents": VECTOR"#),
    ("capsule", r#""half_height": NUMBER, "radius": NUMBER"#),
    ("cylinder", r#""half_height": NUMBER, "radius": NUMBER"#),
    ("cone", r#""half_height": NUMBER, "radius": NUMBER"#),
    ("ellipsoid", ELLIPSOID),
    ("polytope", r#""points": [VECTOR, …]"#),
    ("mesh", r#""path": "FILE.obj" or "FILE.stl""#),
    ("posed", r#""of": SHAPE, and if wanted "translation": VECTOR, "rotation": ROTATION"#),
    ("affine", r#""of": SHAPE, "matrix": [ROW, …], and if wanted "translation": VECTOR"#),
    ("minkowski_sum", r#""of": [SHAPE, SHAPE, …]"#),
    ("difference", r#""a": SHAPE, "b": SHAPE"#),
    ("hull", r#""of": [SHAPE, …]"#),
    ("rounded", r#""of": SHAPE, "radius": NUMBER"#),
];

const ELLIPSOID: &str =
    r#""center": VECTOR, and "matrix": [ROW, …] or "semi_axes": VECTOR and if wanted "rotation": ROTATION"#;

/// What other programs call the same.
const ELSEWHERE: &[(&str, &str)] = &[
    ("sphere", "ball"),
    ("circle", "ball"),
    ("disc", "ball"),
    ("box", "cuboid"),
    ("aabb", "cuboid"),
    ("obb", "cuboid"),
    ("rectangle", "cuboid"),
    ("convex", "polytope"),
    ("polygon", "polytope"),
    ("polyhedron", "polytope"),
    ("transform", "posed"),
    ("isometry", "posed"),
    ("minkowski_difference", "difference"),
    ("collide", "intersect"),
    ("overlap", "intersect"),
    ("shape_cast", "linear_cast"),
    ("time_of_impact", "linear_cast"),
];

/// Which of `names` may be meant by `name`, and all of them, which are the `what` of the format.
pub(super) fn known(name: &str, names: &[Form], what: &str) -> String {
    let all: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
    let elsewhere = ELSEWHERE.iter().find(|(other, _)| other.eq_ignore_ascii_case(name)).map(|(_, ours)| *ours);
    let meant = elsewhere.filter(|ours| all.contains(ours)).or_else(|| nearest(name, all.iter().copied()));
    let meant = meant.map_or_else(String::new, |meant| format!("did you mean {meant:?}? "));
    format!("{meant}the {what} are {}", all.join(", "))
}

/// What is missing where `key` is not among the fields of `object`: how the whole is written, and which field may be meant.
pub(super) fn missing(object: &Object, key: &str) -> String {
    let named = |field: &str, forms: &'static [Form]| {
        let name = object.get(field)?.as_str()?;
        forms.iter().find(|(known, _)| *known == name).copied()
    };
    let all = |names: &[Form]| names.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let form = match key {
        "query" => format!("it says what is asked: {}", all(QUERIES)),
        "type" => format!("it says which shape this is: {}", all(SHAPES)),
        "center" => format!("an ellipsoid has {ELLIPSOID}"),
        "normal" | "offset" => r#"a half-space has "normal": VECTOR, "offset": NUMBER"#.to_owned(),
        _ => match named("query", QUERIES).or_else(|| named("type", SHAPES)) {
            Some((name, fields)) => {
                let article = if name.starts_with(['a', 'e', 'i']) { "an" } else { "a" };
                format!("{article} {name} has {fields}")
            }
            None => return String::new(),
        },
    };
    // A field of the format is never a misspelt one: of a query without "a", "b" is the other shape.
    let is_unknown = |field: &&str| !form.contains(&format!("\"{field}\""));
    let meant = nearest(key, object.keys().map(String::as_str).filter(is_unknown));
    let meant = meant.map_or_else(String::new, |field| format!(" (is {field:?} meant for it?)"));
    format!("{meant}; {form}")
}

/// The nearest of `names` to a misspelt one, if one is near: no more than a third of its letters differ, case aside.
fn nearest<'n>(misspelt: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let misspelt = misspelt.to_lowercase();
    let distance = |name: &str| strsim::damerau_levenshtein(&misspelt, &name.to_lowercase());
    // The lengths are compared first, as nobody's misspelling has a million letters.
    names
        .filter(|name| name.len().abs_diff(misspelt.len()) <= 3)
        .map(|name| (distance(name), name))
        .filter(|(distance, name)| 3 * distance <= name.len().max(misspelt.len()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_names_are_recognised() {
        for (misspelt, meant) in [
            ("raycast", Some("ray_cast")),
            ("Ray_Cast", Some("ray_cast")),
            ("linearcast", Some("linear_cast")),
            ("gjk", None),
            ("", None),
        ] {
            assert_eq!(nearest(misspelt, QUERIES.iter().map(|(name, _)| *name)), meant, "{misspelt}");
        }
        for (name, meant) in [("sphere", "ball"), ("Box", "cuboid"), ("elipsoid", "ellipsoid"), ("polytop", "polytope")]
        {
            let text = known(name, SHAPES, "types");
            assert!(text.starts_with(&format!("did you mean {meant:?}? the types are point, ")), "{text}");
        }
    }
}
