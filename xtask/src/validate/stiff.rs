//! Error against difficulty: condition, thickness, scale, distance, gap to contact, as far as the tags of cases say them.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{Case, Figure, as_read, progress, score};
use crate::engine;
use crate::plot::{Plot, Scale, Series};
use crate::wire::answer::Line;

/// Methods beside the default that are shown for comparison.
const COMPARED: &[(&str, &str)] = &[("margin", "eigen"), ("ray_cast", "iterative")];

/// Fewer values than this make no figure.
const FEWEST_VALUES: usize = 3;

/// For each value of a difficulty, the worst of what was measured there.
type Worst = BTreeMap<u64, f64>;

/// One figure for each query and kind of difficulty.
pub(super) fn figures(cases: &[Case]) -> Vec<Figure> {
    // By query and kind of difficulty, then by method.
    let mut found = BTreeMap::<(String, String), BTreeMap<String, Worst>>::new();
    for (i, case) in cases.iter().enumerate() {
        if i % 64 == 0 {
            progress(&format!("stiff and extreme cases: {i} of {}", cases.len()));
        }
        let text = |name: &str| case.object.get(name).and_then(Value::as_str);
        let Some(query) = text("query") else { continue };
        if text("precision") == Some("f32") || text("method").is_some() {
            continue;
        }
        let tags = case.object.get("tags").and_then(Value::as_array).into_iter().flatten();
        let difficulties: Vec<(&str, f64)> = tags.filter_map(Value::as_str).filter_map(difficulty).collect();
        if difficulties.is_empty() {
            continue;
        }
        let methods = COMPARED.iter().filter(|(of, _)| *of == query).map(|(_, method)| Some(*method));
        for method in [None].into_iter().chain(methods) {
            let Some((error, allowed)) = measure(case, method) else { continue };
            for (kind, value) in &difficulties {
                let figure = found.entry((query.to_owned(), (*kind).to_owned())).or_default();
                let mut note = |name: &str, error: f64| {
                    let worst = figure.entry(name.to_owned()).or_default().entry(value.to_bits()).or_insert(0.0);
                    *worst = worst.max(error);
                };
                note(method.unwrap_or("default method"), error);
                note("allowed", allowed);
            }
        }
    }
    found.into_iter().filter_map(|((query, kind), methods)| figure(&query, &kind, methods)).collect()
}

fn figure(query: &str, kind: &str, methods: BTreeMap<String, Worst>) -> Option<Figure> {
    if methods.values().map(BTreeMap::len).max()? < FEWEST_VALUES {
        return None;
    }
    let series = methods.into_iter().enumerate().map(|(colour, (name, worst))| {
        let mut points: Vec<[f64; 2]> = worst.into_iter().map(|(bits, error)| [f64::from_bits(bits), error]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Series { name, points, joined: true, colour }
    });
    Some(Figure {
        name: format!("stiff-{query}-{kind}"),
        plot: Plot {
            title: format!("{query}: worst error against {kind}"),
            x: kind.to_owned(),
            y: "worst error".to_owned(),
            scales: [Scale::Log, Scale::Log],
            floor: 1e-17,
            series: series.collect(),
        },
        caption: "The worst error among the cases of each value, in f64: relative, or that of ln det X itself. What is allowed \
                  is 1e-7 and twice what a change of the inputs by 1000 ulps does to the truth."
            .to_owned(),
    })
}

/// The kind and value of a tag that ends in a positive number with a kind before it, such as `cond1e+06`.
fn difficulty(tag: &str) -> Option<(&str, f64)> {
    let at = tag.find(|c: char| c.is_ascii_digit())?;
    let (kind, number) = tag.split_at(at);
    let kind = kind.trim_end_matches(['-', '^']);
    let value = number.parse::<f64>().ok().filter(|value| *value > 0.0)?;
    // Dimensions and counts are no difficulties.
    (kind.len() > 1).then_some((kind, value))
}

/// The error of a case and what is allowed, both in the unit of the figure.
fn measure(case: &Case, method: Option<&str>) -> Option<(f64, f64)> {
    let mut object = case.object.clone();
    if let Some(method) = method {
        object.insert("method".to_owned(), Value::from(method));
    }
    let answer = engine::question(&object, &case.meshes).ok()?.ask().ok()?;
    let answer = as_read(Line { id: Value::Null, line: 0, outcome: Ok(answer) });
    let verdict = score::judge(&object, &answer);
    let query = object.get("query").and_then(Value::as_str)?;
    let error = verdict.error?;
    // An exact answer has no error to divide by.
    let allowed = match verdict.ratio {
        Some(ratio) if ratio > 0.0 => error / ratio,
        _ => object.get("allow").and_then(Value::as_f64)?,
    };
    if query.ends_with("_ellipsoid") {
        return Some((error, allowed));
    }
    let relative = verdict.relative?;
    let due = object.get("expect")?.get(score::scalar_of(query)?)?.as_f64().map(f64::abs);
    let allowed = match due {
        Some(due) if due > 0.0 => allowed / due,
        _ if error > 0.0 => allowed * relative / error,
        _ => return None,
    };
    Some((relative, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn difficulties_are_told_from_other_tags() {
        assert_eq!(difficulty("cond1e+06"), Some(("cond", 1e6)), "a condition");
        assert_eq!(difficulty("thickness1e-05"), Some(("thickness", 1e-5)), "a thickness");
        assert_eq!(difficulty("scale2^-30"), None, "no number");
        assert_eq!(difficulty("n4"), None, "a dimension");
        assert_eq!(difficulty("3d"), None, "a dimension");
        assert_eq!(difficulty("easy"), None, "no number at all");
    }
}
