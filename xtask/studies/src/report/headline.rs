//! Ours against the peers: time ratios, worst errors and wrong answers on identical inputs in one run.

#[cfg(not(feature = "peers"))]
use std::fs;

use xtask::plot::duration;
use xtask::validate::Scope;
use xtask::validate::page::{Block, Row, Section, Table, error};

/// What was measured of a method on a case.
struct Measured {
    workload: String,
    case: String,
    method: String,
    ns: f64,
    worst: f64,
    wrong: usize,
}

/// Short names of the workloads, the query each asks, and what it is called here.
const WORKLOADS: [(&str, &str, &str); 5] = [
    ("W1", "ray_cast", "ray cast"),
    ("W2", "linear_cast", "linear cast"),
    ("W3far", "distance", "distance of 3 to 0.01"),
    ("W3near", "distance", "distance of 1e-6 (absolute error)"),
    ("W3b", "intersect", "overlap"),
];

/// A method of ours beside one of theirs.
const RIVALS: [(&str, &str, &str); 6] = [
    ("ours f64", "parry GJK f64", "parry's GJK, f64"),
    ("ours f32", "parry GJK f32", "parry's GJK, f32"),
    ("line_crossing f64", "parry f64", "parry, f64 (our closed forms)"),
    ("ours with axis f64", "parry f64", "parry, f64 (ours with a warm start)"),
    ("ours f32", "Box3D f32", "Box3D, f32"),
    ("ours f32", "Jolt f32", "Jolt, f32"),
];

/// The chapter; empty where nothing is known of the peers.
pub(super) fn section(scope: &Scope) -> Section {
    let (lead, measured) = measured(scope);
    let mut blocks = Vec::new();
    if !measured.is_empty() {
        blocks.push(Block::Table(Table::new(
            "peers",
            "Time: ours over theirs, the geometric mean over the cases that both answer (below 1, ours is faster), and the range; quickest first. \
             Worst error and number of wrong answers: over all cases.",
            &["question", "beside", "cases", "time ratio", "from", "to", "our worst error", "theirs", "our wrong", "theirs"],
            summary(&measured),
        ).with_names(2)));
        for (workload, _, title) in WORKLOADS {
            let rows: Vec<Row> = measured
                .iter()
                .filter(|m| m.workload == workload)
                .map(|m| {
                    Row::of([named(&m.case), m.method.clone(), duration(m.ns), error(m.worst), m.wrong.to_string()])
                        .bad_if(m.wrong > 0)
                })
                .collect();
            if !rows.is_empty() {
                let name = format!("peers-{}", workload.to_lowercase());
                let headers = ["case", "method", "median time", "worst error", "wrong"];
                blocks.push(Block::Table(
                    Table::new(&name, &format!("Every row: {title}"), &headers, rows).with_names(2).folded(),
                ));
            }
        }
    }
    Section { id: "headline", title: "Beside other libraries", lead, blocks }
}

/// Ours against theirs, over the cases of each workload.
fn summary(measured: &[Measured]) -> Vec<Row> {
    let find = |workload: &str, case: &str, method: &str| {
        measured.iter().find(|m| m.workload == workload && m.case == case && m.method == method)
    };
    let mut rows = Vec::new();
    for (workload, _, title) in WORKLOADS {
        let mut of_workload: Vec<(f64, Row)> = Vec::new();
        for (ours, theirs, methods) in RIVALS {
            let pairs: Vec<(&Measured, &Measured)> = measured
                .iter()
                .filter(|m| m.workload == workload && m.method == ours)
                .filter_map(|m| Some((m, find(workload, &m.case, theirs)?)))
                .collect();
            if pairs.is_empty() {
                continue;
            }
            let ratios: Vec<f64> = pairs.iter().map(|(a, b)| a.ns / b.ns).collect();
            let mean = (ratios.iter().map(|r| r.ln()).sum::<f64>() / ratios.len() as f64).exp();
            let worst = |side: fn(&(&Measured, &Measured)) -> f64| pairs.iter().map(side).fold(f64::NAN, f64::max);
            let wrong = |side: fn(&(&Measured, &Measured)) -> usize| pairs.iter().map(side).sum::<usize>();
            of_workload.push((
                mean,
                Row::of([
                    title.to_owned(),
                    methods.to_owned(),
                    pairs.len().to_string(),
                    format!("{mean:.2}"),
                    format!("{:.2}", ratios.iter().copied().fold(f64::INFINITY, f64::min)),
                    format!("{:.2}", ratios.iter().copied().fold(0.0, f64::max)),
                    error(worst(|p| p.0.worst)),
                    error(worst(|p| p.1.worst)),
                    wrong(|p| p.0.wrong).to_string(),
                    wrong(|p| p.1.wrong).to_string(),
                ])
                .bad_if(wrong(|p| p.0.wrong) > 0),
            ));
        }
        of_workload.sort_by(|a, b| a.0.total_cmp(&b.0));
        rows.extend(of_workload.into_iter().map(|(_, row)| row));
    }
    rows
}

const INPUTS: &str = "All answer the same inputs, bit by bit: 10,000 rays against each of 11 bodies; 2,000 motions, 3,000 distances and 2,000 \
     questions for an overlap of each of 12 pairs. Wrong are false hits, false misses, no answer, an error above 1e-3 (above 1e-6 where the \
     distance is 1e-6), and a distance of 0 where it is 1e-6. The others are parry3d and parry3d-f64 0.31, Box3D and Jolt, with the \
     tolerances that they come with; Box3D's casts end 5 mm before contact by design, which counts as wrong here. parry has closed \
     forms for balls, boxes and capsules, as we have; a warm start is the separating plane of the time before.";

/// In this run, with other libraries built in.
#[cfg(feature = "peers")]
fn measured(scope: &Scope) -> (String, Vec<Measured>) {
    use std::time::Duration;

    use benches::rows::{Workload, measure};

    let asked =
        |workload: &Workload| WORKLOADS.iter().any(|(name, query, _)| *name == workload.name() && scope.holds(query));
    let workloads: Vec<Workload> = Workload::ALL.into_iter().filter(asked).collect();
    let rows = measure(&workloads, Duration::from_millis(10), |row| {
        xtask::validate::progress(&format!("{} {} {}", row.workload.name(), row.case, row.method.name()));
    });
    let measured = rows.into_iter().map(|row| Measured {
        workload: row.workload.name().to_owned(),
        case: row.case.to_owned(),
        method: row.method.name().to_owned(),
        ns: row.ns,
        worst: row.score.max,
        wrong: row.score.wrong(),
    });
    (format!("Measured in this run. {INPUTS}"), measured.collect())
}

/// As recorded by `benches`, where other libraries are built by default.
#[cfg(not(feature = "peers"))]
fn measured(scope: &Scope) -> (String, Vec<Measured>) {
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");
    let csv = fs::read_to_string(format!("{docs}/performance.csv")).unwrap_or_default();
    let when = fs::read_to_string(format!("{docs}/comparison.md")).unwrap_or_default();
    let when = when.lines().find(|line| line.starts_with("Measured on")).unwrap_or("Measured earlier.").to_owned();
    let parse = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [workload, case, method, ns, _, max, counts @ ..] = fields.as_slice() else { return None };
        let known = WORKLOADS.iter().any(|(name, query, _)| name == workload && scope.holds(query));
        known.then_some(())?;
        Some(Measured {
            workload: (*workload).to_owned(),
            case: (*case).to_owned(),
            method: (*method).to_owned(),
            ns: ns.parse().ok()?,
            worst: max.parse().unwrap_or(f64::NAN),
            wrong: counts.iter().filter_map(|count| count.parse::<usize>().ok()).sum(),
        })
    };
    let lead = format!(
        "Recorded, not of this run. {when} {INPUTS} To measure it here: `cargo run --release -p studies --features peers,box3d,jolt -- \
         validate`, or with `peers` alone, which is parry and needs no compiler but Rust's."
    );
    (lead, csv.lines().skip(1).filter_map(parse).collect())
}

/// A body of the workloads, or a pair of them, as a reader knows it.
pub(super) fn named(case: &str) -> String {
    let body = |name: &str| match name.strip_prefix("hull") {
        Some(count) if !count.is_empty() => format!("hull of {count}"),
        _ => name.replace("roundbox", "rounded box").replace("cuboid", "box"),
    };
    match case.split_once('-') {
        Some((a, b)) if a == b => match body(a).replace("hull", "hulls").replace("box", "boxes") {
            several if several == body(a) => format!("two {several}s"),
            several => format!("two {several}"),
        },
        Some((a, b)) => format!("{} and {}", body(a), body(b)),
        None => body(case),
    }
}
