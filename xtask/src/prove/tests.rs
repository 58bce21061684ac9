//! What is true is proved, and what is not so never is.

use checker::Verdict;
use rayon::prelude::*;
use serde_json::{Value, json};
use workloads::rng::Rng;

use super::random::{CLEARANCES, PLANES, ROBOTS, query};
use super::{Counts, judge_line};
use crate::EMBEDDED;
use crate::mesh::Meshes;
use crate::query::certified;

fn meshes() -> Meshes {
    Meshes::relative_to(EMBEDDED)
}

/// The query with its answer and certificate.
fn answered(query: &Value) -> Value {
    let line = certified(query.to_string().as_bytes(), &meshes()).unwrap_or_else(|| panic!("no answer to {query}"));
    serde_json::from_slice(&line).expect("JSON")
}

fn verdict(line: &Value) -> Verdict {
    judge_line(line.to_string().as_bytes(), &meshes()).0
}

/// All but a ray through the apex of a cone, and two that start on a boundary: neither comes out exactly.
#[test]
fn the_embedded_suite_is_proved() {
    let mut counts = Counts::default();
    for name in ["distance", "intersect", "ray_cast", "linear_cast"] {
        let text = std::fs::read_to_string(format!("{EMBEDDED}/{name}.jsonl")).expect("the suite is there");
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let Some(line) = certified(line.as_bytes(), &meshes()) else { continue };
            let (verdict, said) = judge_line(&line, &meshes());
            counts.add(verdict, &said);
        }
    }
    assert!(counts.not_proved <= 3 && counts.disproved == 0, "{counts:?}");
    assert!(counts.proved > 250, "{counts:?}");
}

#[test]
fn true_claims_are_proved_and_false_ones_disproved() {
    let ball = |x: f64| json!({"type": "posed", "translation": [x, 0, 0], "of": {"type": "ball", "radius": 1}});
    let cube = json!({"type": "cuboid", "half_extents": [1, 1, 1]});
    let cases = [
        (
            json!({"query": "distance", "a": ball(5.0), "b": cube}),
            json!({"distance": 3, "overlap": false}),
            json!({"distance": 3.001}),
        ),
        (json!({"query": "intersect", "a": ball(5.0), "b": cube}), json!({"overlap": false}), json!({"overlap": true})),
        (json!({"query": "intersect", "a": ball(1.5), "b": cube}), json!({"overlap": true}), json!({"overlap": false})),
        (
            json!({"query": "ray_cast", "target": cube, "source": [4, 0.25, 0.5], "direction": [-1, 0, 0]}),
            json!({"hit": true, "lambda": 3}),
            json!({"hit": false}),
        ),
        (
            json!({"query": "ray_cast", "target": cube, "source": [4, 0.25, 0.5], "direction": [-1, 0, 0], "max_lambda": 2}),
            json!({"hit": false}),
            json!({"hit": true, "lambda": 2}),
        ),
        (
            json!({"query": "linear_cast", "a": cube, "b": ball(4.0), "velocity_a": [2, 0, 0]}),
            json!({"hit": true, "time": 1}),
            json!({"hit": true, "time": 0.99}),
        ),
    ];
    for (query, good, bad) in cases {
        let mut line = answered(&query);
        assert_eq!(verdict(&line), Verdict::Proved, "{line}");
        line["answer"] = good;
        line["allow"] = json!(1e-12);
        assert_eq!(verdict(&line), Verdict::Proved, "{line}");
        line["answer"] = bad;
        assert_eq!(verdict(&line), Verdict::Disproved, "{line}");
    }
}

/// An answer of some width that is proved, and claims something of a distance or a time that is not the least there is.
fn proved_line(rng: &mut Rng) -> Value {
    loop {
        let line = answered(&query(PLANES, rng));
        let begin = line["min_lambda"].as_f64().unwrap_or(0.0);
        let claims = line["answer"]["lower"].as_f64().is_some_and(|lower| lower > begin + 1e-3);
        if claims && verdict(&line) == Verdict::Proved {
            return line;
        }
    }
}

/// The line with one thing changed such that it proves nothing any more, or claims what is false; none where it cannot
/// be changed so.
fn mutated(mut line: Value, rng: &mut Rng) -> Option<Value> {
    let answer = line["answer"].clone();
    let [lower, upper] = ["lower", "upper"].map(|name| answer[name].as_f64().expect("a bracket"));
    let scalar = ["distance", "lambda", "time"].into_iter().find(|name| answer.get(name).is_some())?;
    let shift = (10.0_f64).powf(-1.0 - 4.0 * rng.unit()) * upper;
    let points = line["certificate"]["points"].as_array()?.len();
    let index = rng.below(points as u64) as usize;
    match rng.below(8) {
        // A bracket beside the truth, above or below.
        0 => {
            (line["answer"]["lower"], line["answer"]["upper"], line["answer"][scalar]) =
                (json!(upper + shift), json!(upper + 2.0 * shift), json!(upper + shift));
        }
        1 => {
            (line["answer"]["lower"], line["answer"]["upper"], line["answer"][scalar]) =
                (json!(0), json!(lower - shift), json!(0));
        }
        // No plane, or one that faces the other way.
        2 => drop(line["certificate"].as_object_mut()?.remove("plane")),
        3 => {
            for x in line["certificate"]["plane"].as_array_mut()? {
                *x = json!(-x.as_f64()?);
            }
        }
        // No points, or one fewer of those that matter.
        4 => line["certificate"]["points"] = json!([]),
        5 if line["certificate"]["points"][index][1].as_f64()? > 0.2 => {
            drop(line["certificate"]["points"].as_array_mut()?.remove(index));
        }
        // A weight that is negative, or far too large.
        6 => line["certificate"]["points"][index][1] = json!(-0.25 - rng.unit()),
        7 => line["certificate"]["points"][index][1] = json!(1.5 + rng.unit()),
        _ => return None,
    }
    Some(line)
}

#[test]
fn of_ten_thousand_damaged_certificates_none_proves() {
    let lines = (0..200).into_par_iter().map(|seed| {
        let mut rng = Rng::new(seed);
        let line = proved_line(&mut rng);
        let (mut tried, mut disproved) = (0, 0);
        while tried < 50 {
            let Some(damaged) = mutated(line.clone(), &mut rng) else { continue };
            let verdict = verdict(&damaged);
            assert_ne!(verdict, Verdict::Proved, "{damaged}\n once {line}");
            tried += 1;
            disproved += u64::from(verdict == Verdict::Disproved);
        }
        disproved
    });
    let disproved: u64 = lines.sum();
    assert!(disproved > 1000, "brackets beside the truth are disproved, but only {disproved} were");
}

/// The claims of an answer, each spoilt in turn by more than its bracket, in a line of its own; and the options of a
/// question, each added such that the answer is another one.
fn spoilt(line: &Value) -> Vec<Value> {
    let answer = &line["answer"];
    let mut lines = Vec::new();
    let mut with = |object: Option<&str>, name: &str, value: Value| {
        let mut line = line.clone();
        match object {
            Some(object) => line[object][name] = value,
            None => line[name] = value,
        }
        lines.push(line);
    };
    let number = |name: &str| answer[name].as_f64();
    let bracket = number("lower").zip(number("upper"));
    let scalar = ["distance", "lambda", "time"].into_iter().find(|name| answer.get(name).is_some());
    let far = |x: f64| x + 1e-3 * (1.0 + x.abs());
    for (name, value) in answer.as_object().expect("an answer") {
        let spoilt: Vec<Value> = match (name.as_str(), value) {
            ("status", _) => vec![json!("certain"), json!(7)],
            ("iterations" | "casts" | "boxes", _) => vec![json!(-1), json!("many")],
            ("lower", _) => bracket.iter().map(|(lower, upper)| json!(far(*upper).max(far(*lower)))).collect(),
            ("upper", _) => bracket.iter().map(|(lower, _)| json!(lower - 1e-3 * (1.0 + lower.abs()))).collect(),
            (_, Value::Bool(flag)) => vec![json!(!flag)],
            (_, Value::Number(index)) if index.is_u64() => vec![json!(index.as_u64().unwrap_or(0) + 1000), json!(-1)],
            (_, Value::Number(_)) => {
                let (lower, upper) = bracket.expect("a scalar has a bracket");
                vec![json!(far(upper)), json!(lower - 1e-3 * (1.0 + lower.abs()))]
            }
            (_, Value::Array(coordinates)) => {
                let turned = |i: usize| {
                    let x = coordinates[i].as_f64().expect("a number");
                    let mut all = coordinates.clone();
                    all[i] = json!(x + 0.5 * (1.0 + x.abs()));
                    Value::Array(all)
                };
                let flipped = coordinates.iter().map(|x| json!(-x.as_f64().expect("a number"))).collect();
                let is_of_direction = matches!(name.as_str(), "normal" | "axis");
                (0..coordinates.len()).map(turned).chain(is_of_direction.then_some(flipped)).collect()
            }
            // Only a ray may begin on the boundary, where either is right.
            (_, Value::Null) => vec![],
            _ => panic!("{name} is not spoilt: {line}"),
        };
        spoilt.into_iter().for_each(|value| with(Some("answer"), name, value));
    }
    for (name, value) in [("nobody_knows", json!(1)), ("gradient_a", json!({})), ("margin", json!(0.5))] {
        with(Some("answer"), name, value.clone());
        with(None, name, value);
    }
    with(None, "precision", json!("f16"));
    if let (Some(scalar), Some((lower, upper))) = (scalar, bracket) {
        // Of a bracket without an end the number itself is a claim.
        let mut open = line.clone();
        let _ = open["answer"].as_object_mut().expect("an answer").remove("upper");
        open["answer"][scalar] = json!(far(upper));
        lines.push(open);
        let mut with = |name: &str, value: Value| {
            let mut line = line.clone();
            line[name] = value;
            lines.push(line);
        };
        if lower > 1e-3 {
            if scalar == "lambda" {
                with("min_lambda", json!(far(upper)));
                with("max_lambda", json!(0.5 * lower));
            }
            if scalar == "time" {
                with("max_time", json!(0.5 * lower));
                let speed = ["velocity_a", "velocity_b"].map(|name| line[name].clone());
                if speed.iter().any(|v| v.as_array().is_some_and(|v| v.iter().any(|x| x.as_f64() != Some(0.0)))) {
                    with("target_distance", json!(1e3 * (1.0 + upper)));
                }
            }
        }
    }
    lines
}

/// Whatever an answer claims, and whatever is asked, is checked, or nothing is proved.
#[test]
fn no_claim_of_a_proved_answer_can_be_spoilt_without_notice() {
    let mut lines = Vec::new();
    for name in ["distance", "intersect", "ray_cast", "linear_cast"] {
        let text = std::fs::read_to_string(format!("{EMBEDDED}/{name}.jsonl")).expect("the suite is there");
        lines.extend(text.lines().filter(|line| line.starts_with('{')).map(str::to_owned));
    }
    let tried: usize = lines
        .par_iter()
        .map(|line| {
            let Some(line) = certified(line.as_bytes(), &meshes()) else { return 0 };
            let mut line: Value = serde_json::from_slice(&line).expect("JSON");
            // What is allowed would count where a bracket is open.
            let _ = line.as_object_mut().expect("a query").remove("allow");
            if verdict(&line) != Verdict::Proved {
                return 0;
            }
            let spoilt = spoilt(&line);
            for damaged in &spoilt {
                assert_ne!(verdict(damaged), Verdict::Proved, "{damaged}\n once {line}");
            }
            spoilt.len()
        })
        .sum();
    assert!(tried > 4000, "only {tried} were spoilt");
}

/// A line whose claim is true is not disproved, whoever makes it, and with whatever options.
#[test]
fn true_answers_to_options_are_proved() {
    let ball = json!({"type": "ball", "radius": 1});
    let cast = |options: Value| {
        let mut line = json!({"query": "ray_cast", "target": ball, "source": [5, 0, 0], "direction": [-1, 0, 0]});
        line.as_object_mut().expect("a query").extend(options.as_object().expect("options").clone());
        line
    };
    let moved = json!({"type": "posed", "translation": [5, 0.3, 0.1], "of": ball});
    let cube = json!({"type": "cuboid", "half_extents": [1, 2, 3]});
    let near =
        json!({"query": "linear_cast", "a": cube, "b": moved, "velocity_a": [1, 0.1, 0], "target_distance": 0.5});
    let mut deeper = near.clone();
    deeper["start_in_contact"] = json!("if_deeper");
    for (query, name, truth) in [
        (cast(json!({"min_lambda": 4.5})), "lambda", 4.5),
        // An end at the hit, to rounding, would leave it uncertain.
        (cast(json!({"min_lambda": 3.5, "max_lambda": 4.25})), "lambda", 4.0),
        (cast(json!({"min_lambda": -3})), "lambda", 4.0),
        (near, "time", 2.5),
        (deeper, "time", 2.5),
    ] {
        let line = answered(&query);
        let (verdict, said) = judge_line(line.to_string().as_bytes(), &meshes());
        assert!((line["answer"][name].as_f64().expect("a hit") - truth).abs() < 1e-12, "{line}");
        assert_eq!(verdict, Verdict::Proved, "{said} of {line}");
    }
    let line = answered(&cast(json!({"min_lambda": 6.5})));
    assert_eq!((verdict(&line), &line["answer"]["hit"]), (Verdict::Proved, &json!(false)), "{line}");
}

/// What no certificate proves, or is not read here, is said.
#[test]
fn what_is_not_checked_is_named() {
    let ball = |x: f64| json!({"type": "posed", "translation": [x, 0], "of": {"type": "ball", "radius": 1}});
    let gradient = answered(&json!({"query": "distance", "a": ball(5.0), "b": ball(0.0), "gradient": true}));
    let plain = answered(&json!({"query": "distance", "a": ball(5.0), "b": ball(0.0)}));
    let with = |pointer: &str, value: Value| {
        let mut line = plain.clone();
        let (object, name) = pointer.rsplit_once('/').expect("a place");
        line.pointer_mut(object).expect("an object")[name] = value;
        line
    };
    let cases = [
        (gradient, "gradient_a"),
        (with("/a/margin", json!(0.1)), "margin"),
        (with("/a/of/half_height", json!(1)), "half_height"),
        (with("/max_time", json!(1)), "max_time"),
        (with("/answer/margin", json!(0.1)), "margin"),
        (with("/certificate/axis", json!([1, 0])), "axis"),
        (with("/precision", json!("f16")), "precision"),
        (with("/a/translation", json!([5, 0, 0])), "dimension"),
    ];
    for (line, name) in cases {
        let (verdict, said) = judge_line(line.to_string().as_bytes(), &meshes());
        assert_eq!(verdict, Verdict::NotProved, "{line}");
        assert!(said["because"].as_str().is_some_and(|why| why.contains(name)), "{said} should name {name}");
    }
}

/// Planes that lean prove less of a distance than the one that it is attained across.
#[test]
fn a_plane_that_leans_proves_no_bracket() {
    let mut rng = Rng::new(9);
    for _ in 0..300 {
        let mut line = proved_line(&mut rng);
        if line["query"] != "distance" || line["precision"] == "f32" {
            continue;
        }
        let plane = line["certificate"]["plane"].as_array_mut().expect("a plane");
        let lean = 1e-4 * (1.0 + rng.unit());
        let [x, y] = [0, 1].map(|i| plane[i].as_f64().expect("a number"));
        (plane[0], plane[1]) = (json!(x - lean * y), json!(y + lean * x));
        if x.hypot(y) > 0.1 {
            assert_eq!(verdict(&line), Verdict::NotProved, "{line}");
        }
    }
}

/// All parts of random paths and boxes of joint values are proved, and they cover all that is free; with a part less,
/// or one whose plane faces the other way, they do not. What is met is proved to be, and not with fewer points, nor at
/// a time or place before.
#[test]
fn what_robots_are_free_of_and_what_they_meet_is_proved() {
    let (mut rng, mut free, mut met, mut parts) = (Rng::new(44), 0, 0, 0);
    for _ in 0..48 {
        let query = query(ROBOTS, &mut rng);
        let Some(line) = certified(query.to_string().as_bytes(), &meshes()) else { continue };
        let (known, said) = judge_line(&line, &meshes());
        assert_eq!(said["parts_not_proved"], json!(0), "{said} of {query}");
        parts += said["parts_proved"].as_u64().unwrap_or(0);
        let mut line: Value = serde_json::from_slice(&line).expect("JSON");
        assert_eq!(known, Verdict::Proved, "{said} of {query}");
        let count = line["certificate"]["free"].as_array().map_or(0, Vec::len) as u64;
        if said["claim"] == "met" {
            met += 1;
            for damaged in damaged_contacts(&line) {
                assert_ne!(verdict(&damaged), Verdict::Proved, "{damaged}\n once {line}");
            }
            continue;
        }
        if count == 0 {
            continue;
        }
        free += 1;
        let index = rng.below(count) as usize;
        let whole = line.clone();
        let turned = |x: &Value| json!(-x.as_f64().expect("a number"));
        let turned = |normal: &Value| normal.as_array().expect("a normal").iter().map(turned).collect::<Value>();
        let part = &mut line["certificate"]["free"][index];
        match part["normals"].as_array() {
            Some(normals) => part["normals"] = normals.iter().map(turned).collect(),
            None => part["plane"] = turned(&part["plane"]),
        }
        let is_of_half_space = |line: &Value| {
            let obstacle = line["certificate"]["free"][index]["obstacle"].as_u64().unwrap_or(0) as usize;
            line["obstacles"][obstacle]["type"] == "half_space"
        };
        assert!(verdict(&line) != Verdict::Proved || is_of_half_space(&line), "{line}");
        let mut line = whole;
        line["certificate"]["free"].as_array_mut().expect("a list").remove(index);
        assert_ne!(verdict(&line), Verdict::Proved, "part {index} is missing: {line}");
    }
    assert!(free > 8 && met > 8 && parts > 200, "{free} are free, with {parts} parts, and {met} meet something");
}

/// The line of a contact with one thing changed such that it proves nothing any more, or claims what is false.
fn damaged_contacts(line: &Value) -> Vec<Value> {
    let (mut damaged, answer) = (Vec::new(), &line["answer"]);
    let mut with = |changes: &[(&str, &str, Value)]| {
        let mut line = line.clone();
        for (object, name, value) in changes {
            line[object][name] = value.clone();
        }
        damaged.push(line);
    };
    let obstacle = answer["obstacle"].as_u64().map(|index| &line["obstacles"][index as usize]["type"]);
    if obstacle.is_none_or(|kind| kind != "half_space") {
        with(&[("certificate", "points", json!([]))]);
    }
    if let Some(values) = answer["values"].as_array() {
        let far = values.iter().map(|value| json!(value.as_f64().expect("a number") + 10.0)).collect();
        with(&[("answer", "values", far)]);
    }
    if answer.get("free").is_some() {
        // At times that are not on the path, and not within the bracket.
        with(&[("answer", "upper", json!(8.0))]);
        with(&[("answer", "lower", json!(-2)), ("answer", "time", json!(-1))]);
        with(&[("answer", "time", json!(0.5 * answer["lower"].as_f64().expect("a time") - 0.1))]);
        with(&[("answer", "certain", json!(false))]);
        with(&[("answer", "free", json!(true))]);
        with(&[("answer", "link", json!(1000))]);
        for name in ["point", "normal"] {
            if let Some(first) = answer[name][0].as_f64() {
                let mut moved = answer[name].clone();
                moved[0] = json!(first + 0.5 * (1.0 + first.abs()));
                with(&[("answer", name, moved)]);
            }
        }
    }
    if let Some(lower) = answer["lower"].as_f64().filter(|lower| *lower > 0.0) {
        // Too early, and not before a time that is too late.
        let early = json!(0.5 * lower);
        with(&["lower", "time", "upper"].map(|name| ("answer", name, early.clone())));
        let late = ["lower", "time", "upper"].map(|name| ("answer", name, json!(lower + 0.25 * (1.0 - lower))));
        if lower < 0.9 {
            with(&late);
        }
        with(&[("answer", "edge", json!(answer["edge"].as_u64().expect("an index") + 1))]);
    }
    damaged
}

/// Of two fingers that touch at the same time, to rounding, the one is named whose contact ends the bracket; and what
/// only touches is none that is certain, which the answer says itself.
#[test]
fn of_contacts_at_the_same_time_one_is_proved() {
    for k in 0..12 {
        let angle = 0.3 + 0.1 * f64::from(k);
        let finger = |side: f64| json!({"type": "posed", "translation": [side * 0.7, 0.1 * side], "of": {"type": "ball", "radius": 0.3}});
        // Both come down on the wall, which the slide comes to at an angle.
        let slide = json!({"type": "prismatic", "parent": -1, "rotation": angle, "axis": [0.1, -0.7]});
        let mut line = json!({"query": "path", "joints": [slide], "waypoints": [[0], [4]]});
        line["links"] = json!([{"joint": 0, "shapes": [finger(1.0), finger(-1.0)]}]);
        let (sine, cosine) = angle.sin_cos();
        let wall = json!({"type": "cuboid", "half_extents": [3, 0.25]});
        let across = [0.1 * cosine + 0.7 * sine, 0.1 * sine - 0.7 * cosine].map(|x| 3.0 * x);
        let tilt = angle + (0.1_f64 / 0.7).atan();
        line["obstacles"] = json!([{"type": "posed", "rotation": tilt, "translation": across, "of": wall}]);
        let line = answered(&line);
        assert_eq!(verdict(&line), Verdict::Proved, "{line}");
    }
    let ball = json!([{"joint": 0, "shapes": [{"type": "ball", "radius": 1}]}]);
    let mut line = json!({"query": "path", "links": ball, "waypoints": [[0], [2]]});
    line["joints"] = json!([{"type": "prismatic", "parent": -1, "axis": [1, 0]}]);
    line["obstacles"] = json!([{"type": "half_space", "normal": [-1, 0], "offset": -3}]);
    let line = answered(&line);
    let (verdict, said) = judge_line(line.to_string().as_bytes(), &meshes());
    assert_eq!((verdict, &line["answer"]["certain"]), (Verdict::NotProved, &json!(false)), "{line}");
    assert!(said["because"].as_str().is_some_and(|why| why.contains("within rounding")), "{said}");
}

#[test]
fn a_certificate_of_the_plane_proves_nothing_in_space() {
    let target = json!({"type": "triangle", "points": [[0, -1, 3], [0, 1, 3], [1, 0, 3]]});
    let mut line = json!({"query": "ray_cast", "target": target, "source": [-2, 0, 0], "direction": [1, 0, 0]});
    line["answer"] = json!({"hit": true, "lambda": 2});
    line["certificate"] = json!({"plane": [-1, 0], "points": [[[-1, 1], 0.5], [[-1, -1], 0.5]]});
    assert_eq!(verdict(&line), Verdict::NotProved, "it passes three below");
}

#[test]
fn what_cannot_be_read_is_not_proved() {
    let ray = r#"{"query":"ray_cast","target":{"type":"ball","radius":1},"source":[3,0,0],"direction":[-1,0,0]"#;
    let lines = [
        "not JSON".to_owned(),
        format!("{ray}}}"),
        format!(r#"{ray},"answer":{{"hit":true,"lambda":2}}}}"#),
        format!(r#"{ray},"answer":{{"hit":true}},"certificate":{{}}}}"#),
        format!(r#"{ray},"answer":{{"hit":true,"lambda":2,"lower":2.5,"upper":3}},"certificate":{{}}}}"#),
        r#"{"query":"margin","answer":{"margin":1},"certificate":{}}"#.to_owned(),
        r#"{"query":"intersect","a":{"type":"ball","radius":-1},"b":{"type":"ball","radius":1},"answer":{"overlap":true},"certificate":{}}"#.to_owned(),
    ];
    for line in lines {
        let (verdict, said) = judge_line(line.as_bytes(), &meshes());
        assert_eq!(verdict, Verdict::NotProved, "{line}");
        assert!(said["because"].is_string(), "{said}");
    }
}

/// The suites of least distances, growth distances, and boxes among obstacles.
const OF_CLEARANCES: &[&str] = &["growth_distance", "motion_clearance", "path_clearance", "joint_box_scene"];

/// The lines of a suite, with answers and certificates.
fn suite(name: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(format!("{EMBEDDED}/{name}.jsonl")).expect("the suite is there");
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with('{')).collect();
    let lines = lines.par_iter().filter_map(|line| certified(line.as_bytes(), &meshes()));
    lines.map(|line| serde_json::from_slice(&line).expect("JSON")).collect()
}

/// All of the embedded suites, and no part is left out.
#[test]
fn the_embedded_clearances_are_proved() {
    for (name, most) in OF_CLEARANCES.iter().zip([70, 30, 8, 14]) {
        let lines = suite(name);
        assert!(lines.len() >= most, "only {} of {name}", lines.len());
        lines.par_iter().for_each(|line| {
            let (verdict, said) = judge_line(line.to_string().as_bytes(), &meshes());
            assert_eq!(verdict, Verdict::Proved, "{name} {}: {said}", line["id"]);
            assert!(said["parts_not_proved"].as_u64().unwrap_or(0) == 0, "{name} {}: {said}", line["id"]);
        });
    }
}

/// Nearly all of random ones, of every kind in both precisions; and not with one thing changed such that it proves
/// nothing any more, or claims what is false.
#[test]
fn random_clearances_are_proved_and_none_that_is_spoilt() {
    let mut rng = Rng::new(7);
    let queries: Vec<Value> = (0..100).map(|_| query(CLEARANCES, &mut rng)).collect();
    let judged = queries.par_iter().enumerate().filter_map(|(seed, query)| {
        let line: Value = serde_json::from_slice(&certified(query.to_string().as_bytes(), &meshes())?).expect("JSON");
        let (verdict, said) = judge_line(line.to_string().as_bytes(), &meshes());
        if verdict != Verdict::Proved {
            return Some((verdict, said, 0));
        }
        // A few of the lines that it becomes.
        let mut rng = Rng::new(seed as u64);
        let mut spoilt = spoilt_clearances(&line, &mut rng);
        spoilt.retain(|_| rng.below(3) == 0);
        for (changed, damaged) in &spoilt {
            assert_ne!(self::verdict(damaged), Verdict::Proved, "{changed}: {damaged}\n once {line}");
        }
        Some((verdict, said, spoilt.len()))
    });
    let judged: Vec<_> = judged.collect();
    let open: Vec<_> = judged.iter().filter(|(verdict, ..)| *verdict != Verdict::Proved).collect();
    let spoilt: usize = judged.iter().map(|(.., spoilt)| spoilt).sum();
    assert!(judged.len() > 80 && open.len() <= 2, "{} of {} are not proved: {open:?}", open.len(), judged.len());
    assert!(open.iter().all(|(verdict, ..)| *verdict == Verdict::NotProved), "{open:?}");
    assert!(spoilt > 400, "only {spoilt} were spoilt");
}

/// The lines that a proved one becomes if one thing is spoilt: each claim of the number, and of where it is; each part
/// of the certificate; and the question.
fn spoilt_clearances(line: &Value, rng: &mut Rng) -> Vec<(String, Value)> {
    let mut lines = Vec::new();
    let is_of_path = line["answer"].get("clearance").is_some();
    let [claim, proof] =
        ["answer", "certificate"].map(|of| format!("/{of}{}", if is_of_path { "/clearance" } else { "" }));
    let at = |pointer: &str| line.pointer(pointer).expect("a place");
    let mut with = |changes: &[(&str, &str, Value)]| {
        let mut line = line.clone();
        for (object, name, value) in changes {
            line.pointer_mut(object).expect("an object")[name] = value.clone();
        }
        lines.push((format!("{changes:?}"), line));
    };
    let scalar = if line["query"] == "growth_distance" { "scale" } else { "distance" };
    let answer = at(&claim);
    let number = |name: &str| answer[name].as_f64();
    if let (Some(lower), Some(upper), Some(value)) = (number("lower"), number("upper"), number(scalar)) {
        let far = |x: f64| x * 1.001 + if x == 0.0 { 1e-3 } else { 0.0 };
        // A bracket above the truth, and one below it; a bound alone; and a number beside its bracket.
        with(&[
            (&claim, "lower", json!(far(upper))),
            (&claim, scalar, json!(far(upper))),
            (&claim, "upper", json!(far(far(upper)))),
        ]);
        with(&[(&claim, "lower", json!(far(upper)))]);
        with(&[(&claim, scalar, json!(far(upper)))]);
        if lower > 0.0 {
            let less = json!(lower * 0.999);
            with(&[(&claim, "lower", less.clone()), (&claim, scalar, less.clone()), (&claim, "upper", less.clone())]);
            with(&[(&claim, "upper", less.clone())]);
            with(&[(&claim, scalar, less)]);
            // The distance from a half-space needs none.
            let other = answer["obstacle"].as_u64().map_or(&line["b"], |index| &line["obstacles"][index as usize]);
            if other["type"] != "half_space" {
                with(&[(&proof, "points", json!([]))]);
            }
        }
        assert!(lower <= value && value <= upper, "{line}");
    }
    for name in ["point", "point_a", "point_b", "normal"] {
        // By more than bodies that are posed far away, and back again, are off by rounding.
        let far = 1e4
            * (1.0
                + answer[name].as_array().into_iter().flatten().filter_map(Value::as_f64).map(f64::abs).sum::<f64>());
        for (i, x) in answer[name].as_array().into_iter().flatten().enumerate() {
            let (x, mut moved) = (x.as_f64().expect("a number"), answer[name].clone());
            moved[i] = json!(x + far);
            with(&[(&claim, name, moved)]);
        }
        if name == "normal" && answer[name].is_array() {
            let flipped = answer[name].as_array().into_iter().flatten().map(|x| json!(-x.as_f64().expect("a number")));
            with(&[(&claim, name, flipped.collect())]);
        }
    }
    for name in ["edge", "link", "body", "obstacle", "other_link", "other_body"] {
        if let Some(index) = answer[name].as_u64() {
            with(&[(&claim, name, json!(index + 1000))]);
        }
    }
    if let Some(time) = number("time") {
        let end = line["max_time"].as_f64().unwrap_or(1.0);
        with(&[(&claim, "time", json!(time + 2.0 * end + 1.0))]);
        with(&[(&claim, "time", json!(-1.0))]);
    }
    with(&[(&claim, "status", json!("certain"))]);
    with(&[(&claim, "nobody_knows", json!(1))]);
    with(&[("", "nobody_knows", json!(1))]);
    with(&[("", "precision", json!("f16"))]);
    for (i, [low, high]) in
        answer["grown"].as_array().into_iter().flatten().map(|ends| [&ends[0], &ends[1]]).enumerate()
    {
        // Beyond the limits, and beside the values.
        let mut spoilt = answer["grown"].clone();
        spoilt[i] = json!([line["box"][i][0].as_f64().expect("a limit") - 1.0, high]);
        with(&[(&claim, "grown", spoilt.clone())]);
        spoilt[i] = json!([high.as_f64().expect("a face") + 1.0, high.as_f64().expect("a face") + 2.0]);
        with(&[(&claim, "grown", spoilt)]);
        let mut stops = answer["stops"].clone();
        if stops[2 * i]["by"] != "limit" && low != &line["box"][i][0] {
            stops[2 * i] = json!({"by": "limit"});
            with(&[(&claim, "stops", stops)]);
        }
    }
    if let Some(meets) = answer["meets"].as_bool() {
        with(&[(&claim, "meets", json!(!meets))]);
    }
    // What is proved to be free at once needs no parts.
    let parts = at(&proof)["free"].as_array().map_or(0, Vec::len) as u64;
    if parts > 0
        && (number("lower").is_some_and(|lower| lower > 0.0)
            || answer["meets"] == json!(false)
            || answer.get("grown").is_some())
    {
        let mut line = line.clone();
        let free = line.pointer_mut(&proof).expect("a proof")["free"].as_array_mut().expect("a list");
        let part = free.remove(rng.below(parts) as usize);
        lines.push((part.to_string(), line));
    }
    lines
}
