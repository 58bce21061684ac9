//! `cargo xtask growth`: how the time of each question to a scene grows with the number of its bodies.

use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use benches::scene::{self, Question};
use clap::Args;
use convex_support::glam::DVec3;
use convex_support::{Ball, Posed};
use cpu_time::ThreadTime;
use gjk_raycast::Scene;
use workloads::provenance::provenance;
use xtask::plot::{Plot, Scale, Series, duration};
use xtask::validate::page::Figure;
use xtask::validate::{begin_progress, end_progress, progress};

/// How far to go, and where the figures go.
#[derive(Clone, Debug, Args)]
pub(crate) struct Choice {
    /// The most bodies; the least is 100.
    #[arg(long, value_name = "N", default_value_t = MOST, value_parser = clap::value_parser!(u32).range(100..=10_000_000))]
    most: u32,
    /// Where the figures and the table go.
    #[arg(long, value_name = "FOLDER", default_value = "target/growth")]
    output: PathBuf,
    /// Write them into the notes too.
    #[arg(long)]
    record: bool,
}

/// The most bodies, unless it is said otherwise.
pub(crate) const MOST: u32 = 1_000_000;

/// Distinct questions of each kind.
const QUESTIONS: usize = 1024;
/// Passes over them after the first, of which the quickest counts.
const PASSES: usize = 3;

/// Measures, and writes two figures and a table.
pub(crate) fn run(choice: &Choice) -> ExitCode {
    begin_progress(1, "growth");
    let lines = measured(choice.most);
    end_progress();
    let docs = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs"));
    let mut folders = vec![(choice.output.clone(), choice.output.clone())];
    if choice.record {
        folders.push((docs.to_path_buf(), docs.join("figures")));
    }
    let written = folders.iter().try_for_each(|(tables, pictures)| {
        fs::create_dir_all(pictures)?;
        fs::write(tables.join("scene-growth.csv"), csv(&lines))?;
        figures(&lines)
            .iter()
            .try_for_each(|figure| fs::write(pictures.join(format!("{}.svg", figure.name)), figure.plot.file()))
    });
    let shown =
        written.and_then(|()| write!(io::stdout().lock(), "{}\nMeasured on {}.\n", table(&lines), provenance()));
    match shown {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => xtask::output::failed("cannot write the figures", &why),
    }
}

/// The kinds of question, in the order of the figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Ray,
    Nearest,
    Within,
    LinearCast,
    MotionCast,
    Pairs,
}

impl Kind {
    const ALL: [Self; 6] = [Self::Ray, Self::Nearest, Self::Within, Self::LinearCast, Self::MotionCast, Self::Pairs];

    fn name(self) -> &'static str {
        match self {
            Self::Ray => "first on a ray",
            Self::Nearest => "nearest",
            Self::Within => "all within 1",
            Self::LinearCast => "first linear cast",
            Self::MotionCast => "first turning cast",
            Self::Pairs => "pairs within 0.05, a body",
        }
    }
}

/// The times of one kind of question by one library.
pub(crate) struct Line {
    kind: Kind,
    who: &'static str,
    /// The number of bodies, and the nanoseconds of a question; of pairs, those of all by the number of bodies.
    points: Vec<[f64; 2]>,
}

/// The times, of scenes of a hundred bodies and ten times as many until `most`.
pub(crate) fn measured(most: u32) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let counts = (2..).map(|power| 10_usize.pow(power)).take_while(|&count| count <= most as usize);
    for count in counts {
        progress(&format!("a scene of {count} bodies"));
        let places = scene::places(count);
        let questions = scene::questions(scene::side(count), QUESTIONS);
        let mut add = |who, kind, time: f64| {
            let point = [count as f64, time];
            match lines.iter_mut().find(|line| line.who == who && line.kind == kind) {
                Some(line) => line.points.push(point),
                None => lines.push(Line { kind, who, points: vec![point] }),
            }
        };
        let balls = scene::balls::<DVec3>(&places);
        for kind in Kind::ALL {
            add("ours", kind, ours(kind, &balls, &questions));
        }
        #[cfg(feature = "peers")]
        {
            let balls = scene::parry::Balls::new(&places);
            for kind in Kind::ALL {
                add("parry", kind, parrys(kind, &balls, &questions));
            }
        }
    }
    lines
}

/// Nanoseconds of a question to our scene.
fn ours(kind: Kind, scene: &Scene<Posed<Ball<DVec3>>>, questions: &[Question]) -> f64 {
    let (mut found, mut pairs) = (Vec::new(), Vec::new());
    match kind {
        Kind::Ray => each(questions, |question| scene::ray_cast(scene, question)),
        Kind::Nearest => each(questions, |question| scene::nearest(scene, question)),
        Kind::Within => each(questions, |question| scene::all_within(scene, question, &mut found)),
        Kind::LinearCast => each(questions, |question| scene::linear_cast(scene, question)),
        Kind::MotionCast => each(questions, |question| scene::motion_cast(scene, question)),
        Kind::Pairs => least(|| scene::pairs(scene, &mut pairs)) / scene.len() as f64,
    }
}

/// Nanoseconds of a question to parry's tree, with its own narrow phase; its compound is asked to cast.
#[cfg(feature = "peers")]
fn parrys(kind: Kind, scene: &scene::parry::Balls, questions: &[Question]) -> f64 {
    let mut workspace = parry3d_f64::partitioning::BvhWorkspace::default();
    match kind {
        Kind::Ray => each(questions, |question| scene.ray_cast(question)),
        Kind::Nearest => each(questions, |question| scene.nearest(question)),
        Kind::Within => each(questions, |question| scene.all_within(question)),
        Kind::LinearCast => each(questions, |question| scene.linear_cast(question)),
        Kind::MotionCast => each(questions, |question| scene.motion_cast(question)),
        Kind::Pairs => least(|| scene.pairs(&mut workspace)) / scene.count() as f64,
    }
}

/// The time of one of the questions.
fn each<T>(questions: &[Question], mut ask: impl FnMut(Question) -> T) -> f64 {
    least(|| questions.iter().for_each(|&question| _ = black_box(ask(black_box(question))))) / questions.len() as f64
}

/// The least thread CPU time of some passes, in nanoseconds.
fn least<T>(mut pass: impl FnMut() -> T) -> f64 {
    black_box(pass());
    let once = |_| {
        let start = ThreadTime::now();
        black_box(pass());
        start.elapsed().as_nanos() as f64
    };
    (0..PASSES).map(once).fold(f64::INFINITY, f64::min)
}

/// Questions about what is there, and questions about what moves.
pub(crate) fn figures(lines: &[Line]) -> [Figure; 2] {
    let balls = "Balls of radius 0.3, one to eight units of volume whatever their number, f64; each point is the mean of 1,024 \
                 questions at random, one thread.";
    let parry = if lines.iter().any(|line| line.who != "ours") {
        " parry answers by its Bvh and its own tests of balls, and casts by its compound."
    } else {
        " docs/scenes.md has parry beside it."
    };
    let inputs = format!("{balls}{parry}");
    let resting = "What to expect: ten thousand times the bodies cost a few times as long, and the last steps more \
                   than those before, since the bodies outgrow the caches.";
    let moving = "The ball that is cast moves until it hits, the box that turns for ten units of time. What to expect: \
                  the same; pairs cost a constant time for each body.";
    [
        figure(
            lines,
            "scene-growth",
            "Time of one query, by number of bodies",
            &Kind::ALL[..3],
            &[inputs.as_str(), resting].join(" "),
        ),
        figure(
            lines,
            "scene-growth-casts",
            "Time of casts and pairs, by number of bodies",
            &Kind::ALL[3..],
            &[inputs.as_str(), moving].join(" "),
        ),
    ]
}

fn figure(lines: &[Line], name: &str, title: &str, kinds: &[Kind], caption: &str) -> Figure {
    let place = |kind| kinds.iter().position(|&other| other == kind);
    let series = |line: &Line| {
        // The same dashes for the same question, and hollow marks for parry.
        let colour = place(line.kind)? + if line.who == "ours" { 0 } else { 4 };
        Some(Series {
            name: format!("{}, {}", line.kind.name(), line.who),
            points: line.points.clone(),
            joined: true,
            colour,
        })
    };
    Figure {
        name: name.to_owned(),
        plot: Plot {
            title: title.to_owned(),
            x: "bodies".to_owned(),
            y: "time".to_owned(),
            scales: [Scale::Log, Scale::Time],
            floor: 1.0,
            series: lines.iter().filter_map(series).collect(),
        },
        caption: caption.to_owned(),
    }
}

fn csv(lines: &[Line]) -> String {
    let mut csv = "question,library,bodies,nanoseconds\n".to_owned();
    for Line { kind, who, points } in lines {
        for [count, time] in points {
            let _ = writeln!(csv, "\"{}\",{who},{count},{time:.1}", kind.name());
        }
    }
    csv
}

/// The lines as a table of the notes.
fn table(lines: &[Line]) -> String {
    let counts: Vec<f64> =
        lines.first().map_or_else(Vec::new, |line| line.points.iter().map(|point| point[0]).collect());
    let head: String = counts.iter().map(|count| format!(" {count} |")).collect();
    let mut text = format!("| question | |{head}\n|---|---|{}\n", "---|".repeat(counts.len()));
    for kind in Kind::ALL {
        for line in lines.iter().filter(|line| line.kind == kind) {
            let times: String = line.points.iter().map(|point| format!(" {} |", duration(point[1]))).collect();
            let _ = writeln!(text, "| {} | {} |{times}", kind.name(), line.who);
        }
    }
    text
}
