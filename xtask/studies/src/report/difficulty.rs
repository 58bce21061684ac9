//! Figures of error against difficulty: the methods side by side, down the values that the tags of cases name.

use std::collections::BTreeMap;

use serde_json::Value;
use xtask::engine;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::Figure;
use xtask::validate::score::called;
use xtask::validate::stiff::{difficulty, difficulty_as_said};
use xtask::validate::{Case, progress, score};
use xtask::wire::answer::Line;
use xtask::wire::answer::as_read;

/// Methods beside the default that are shown for comparison.
const COMPARED: &[(&str, &str)] = &[("margin", "eigen"), ("ray_cast", "iterative")];

/// What the inputs allow.
const ALLOWED: &str = "what the inputs allow";

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
                note(method.unwrap_or("ours"), error);
                note(ALLOWED, allowed);
            }
        }
    }
    found.into_iter().filter_map(|((query, kind), methods)| figure(&query, &kind, methods)).collect()
}

fn figure(query: &str, kind: &str, methods: BTreeMap<String, Worst>) -> Option<Figure> {
    // Scaling changes nothing, which a table shows better.
    if kind == "scale" || methods.values().map(BTreeMap::len).max()? < FEWEST_VALUES {
        return None;
    }
    let series = methods.into_iter().map(|(name, worst)| {
        let colour = match name.as_str() {
            "ours" => 0,
            ALLOWED => 7,
            _ => 1,
        };
        let mut points: Vec<[f64; 2]> = worst.into_iter().map(|(bits, error)| [f64::from_bits(bits), error]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // What is allowed differs from case to case, and no line joins that.
        Series { joined: name != ALLOWED, name, points, colour }
    });
    Some(Figure {
        name: format!("stiff-{query}-{kind}"),
        plot: Plot {
            title: format!("{}: error against {}", called(query), difficulty_as_said(kind)),
            x: match kind {
                "gap" | "depth" => format!("{}, over size", difficulty_as_said(kind)),
                _ => difficulty_as_said(kind),
            },
            y: "worst error".to_owned(),
            scales: [Scale::Log, Scale::Log],
            floor: 1e-17,
            series: series.collect(),
        },
        caption: "Beside our errors is what the inputs allow; the table counts the cases that exceed it. It is 1e-7 \
                  and twice what a change of the inputs by 1000 rounding errors does to the truth. The worst among the \
                  cases of each value, in f64, relative; of fitted ellipsoids, of the volume."
            .to_owned(),
    })
}

/// The error of a case and what is allowed, both in the unit of the figure.
fn measure(case: &Case, method: Option<&str>) -> Option<(f64, f64)> {
    let mut object = case.object.clone();
    if let Some(method) = method {
        object.insert("method".to_owned(), Value::from(method));
    }
    let answer = engine::question(&object, &case.meshes).ok()?.ask().ok()?;
    let answer = as_read(Line { id: None, line: 0, outcome: Ok(answer) });
    let verdict = score::judge(&object, &answer);
    let query = object.get("query").and_then(Value::as_str)?;
    let relative = verdict.relative?;
    let allowed = match verdict.ratio {
        Some(ratio) if ratio > 0.0 => relative / ratio,
        // An exact answer has no error to divide.
        _ => {
            let allow = object.get("allow").and_then(Value::as_f64)?;
            match score::scalar_of(query)? {
                "log_det" => allow,
                scalar => allow / object.get("expect")?.get(scalar)?.as_f64()?.abs(),
            }
        }
    };
    Some((relative, allowed))
}
