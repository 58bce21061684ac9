//! What is written and printed of a scene.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::between::Between;
use super::picture::Frames;
use super::{Outcome, Row, Scene};
use xtask::plot::{Plot, Scale, Series};

pub(super) fn write(rows: &[Row], frames: &Frames, folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut csv = String::from("time_s,least_margin,least_exact_distance_m,overlapping_pairs,hull_queries\n");
    for row in rows {
        let distance = row.least_distance.map_or_else(String::new, |d| d.to_string());
        csv += &format!("{},{},{distance},{},{}\n", row.time, row.least_margin, row.overlaps, row.hulls_asked);
    }
    fs::write(folder.join("rows.csv"), csv)?;
    let plot = |title: &str, y: &str, colour: usize, value: &dyn Fn(&Row) -> Option<f64>| Plot {
        title: title.to_owned(),
        x: "time (s)".to_owned(),
        y: y.to_owned(),
        scales: [Scale::Linear, Scale::Linear],
        floor: f64::NEG_INFINITY,
        series: vec![Series {
            name: y.to_owned(),
            points: rows.iter().filter_map(|row| Some([row.time, value(row)?])).collect(),
            joined: false,
            colour,
        }],
    };
    let margin = plot("Least margin of the outer ellipsoids", "margin", 0, &|row| Some(row.least_margin));
    fs::write(folder.join("margin.svg"), margin.svg())?;
    let distance = plot("Least exact distance, where the ellipsoids could not decide", "distance (mm)", 4, &|row| {
        row.least_distance.map(|metres| metres * 1e3)
    });
    fs::write(folder.join("distance.svg"), distance.svg())?;
    fs::write(folder.join("robot.svg"), frames.svg())
}

pub(super) fn print(scene: &Scene, outcome: &Outcome, folder: &Path, output: &mut impl Write) -> io::Result<()> {
    let Outcome { fitted, levels, every_pair, rows, between, truth } = outcome;
    let (links, obstacles) = (scene.bodies.len(), scene.obstacles.len());
    writeln!(output, "{links} links, {obstacles} obstacles, {} rows: {} pairs", rows.len(), levels.asked(0))?;
    writeln!(output, "ellipsoids around and inside every mesh: {:.1} ms, once", fitted.as_secs_f64() * 1e3)?;
    for (link, body) in scene.robot.links.iter().zip(&scene.bodies) {
        writeln!(output, "  {:24} tightness {:.3}", link.name, body.tightness)?;
    }
    writeln!(output, "{:34} {:>9} {:>9} {:>7} {:>10}", "level", "asked", "decided", "share", "ns each")?;
    let names = ["outer ellipsoids are disjoint", "inner ellipsoids overlap", "exact distance of the hulls"];
    for (i, name) in names.iter().enumerate() {
        writeln!(
            output,
            "{name:34} {:>9} {:>9} {:>6.2}% {:>10.0}",
            levels.asked(i),
            levels.knew[i],
            100.0 * levels.knew[i] as f64 / levels.asked(0).max(1) as f64,
            levels.nanoseconds(i),
        )?;
    }
    let total: f64 = (0..names.len()).map(|i| levels.asked(i) as f64 * levels.nanoseconds(i)).sum();
    writeln!(output, "{:.1} µs per row of {} pairs", total * 1e-3 / rows.len().max(1) as f64, links * obstacles)?;
    writeln!(
        output,
        "{:.1} µs per row for the distance of every pair of hulls instead",
        every_pair.as_secs_f64() * 1e6
    )?;
    let overlapping = rows.iter().filter(|row| row.overlaps > 0).count();
    let least = rows.iter().filter_map(|row| row.least_distance).filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    writeln!(output, "{overlapping} rows with an overlap; least exact distance otherwise {least:.6} m")?;
    if let Some(Between { asked, free }) = between {
        writeln!(output, "between the rows: {free} of {asked} motions of a link past an obstacle are proved free")?;
        if scene.claims_free && free < asked {
            writeln!(output, "the scene claims that all are")?;
        }
    } else if scene.claims_free {
        writeln!(output, "the scene claims that there are none")?;
    }
    if let Some(truth) = truth {
        truth.print(output)?;
    }
    writeln!(output, "written: {}", folder.display())
}
