//! Which ellipsoid encloses this link, how near to the smallest is it, and how much of it does the link fill?
//!
//! ```text
//! cargo run --release -p lj-ellipsoid --example ellipsoid_around_a_mesh                 # a forearm
//! cargo run --release -p lj-ellipsoid --example ellipsoid_around_a_mesh -- mesh.obj     # your own
//! ```

#![allow(clippy::print_stdout, reason = "an example talks")]

use std::error::Error;

use lj_ellipsoid::{EnclosingMethod, EnclosingOptions, InscribedOptions, enclosing, enclosing_with, inscribed_in_hull};

/// The vertices of a forearm: a tube that tapers, with a flange at its thick end.
fn forearm() -> Vec<[f64; 3]> {
    let mut vertices = Vec::new();
    for ring in 0..40u32 {
        let z = f64::from(ring) * 0.01;
        let radius = if ring < 4 { 0.09 } else { 0.07 - 0.08 * z };
        for spoke in 0..64u32 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(spoke) / 64.0).sin_cos();
            vertices.push([0.3 + radius * cos, -0.1 + radius * sin, 0.5 + z]);
        }
    }
    vertices
}

/// The vertices of an OBJ file: its lines `v x y z`.
fn vertices_of(obj: &str) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let lines = obj.lines().filter_map(|line| line.trim().strip_prefix("v "));
    lines
        .map(|line| {
            let numbers = line.split_whitespace().take(3).map(str::parse).collect::<Result<Vec<f64>, _>>()?;
            <[f64; 3]>::try_from(numbers).map_err(|_| format!("a vertex has three coordinates, not \"{line}\"").into())
        })
        .collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let vertices = match std::env::args_os().nth(1) {
        Some(file) => vertices_of(&std::fs::read_to_string(file)?)?,
        None => forearm(),
    };
    let options = EnclosingOptions::new().with_epsilon(1e-12);

    println!("pass  points at work  certified gap");
    let outer = enclosing_with(&vertices, options, |iterate| {
        println!("{:4}  {:14}  {:.1e}", iterate.scans, iterate.indices.len(), iterate.log_det_gap);
    })?;
    let ellipsoid = outer.ellipsoid;
    println!("\n{:?} with a gap of {:.1e}, {} vertices touch", outer.status, outer.log_det_gap, outer.contacts.len());
    println!("centre     {:.6?}", ellipsoid.center());
    println!("semi-axes  {:.6?}", ellipsoid.semi_axes());
    assert!(vertices.iter().all(|&vertex| ellipsoid.contains(vertex)), "a vertex is outside");

    let inner = inscribed_in_hull(&vertices, InscribedOptions::new())?;
    let tightness = inner.ellipsoid.tightness(&ellipsoid);
    println!("tightness  {tightness:.3}, that is (volume inside / volume around)^⅓: 1 for an ellipsoid, at least ⅓");
    assert!((1.0 / 3.0..=1.0).contains(&tightness), "John's theorem bounds {tightness}");

    println!("\nthe first-order method for the same:");
    let first_order = options.with_method(EnclosingMethod::Khachiyan).with_epsilon(1e-6);
    let answer = enclosing(&vertices, first_order)?;
    println!("{:?} after {} iterations, gap {:.1e}", answer.status, answer.iterations, answer.log_det_gap);

    // Both gaps are certified, so the two answers cannot be farther apart than what they admit.
    let volume = |semi_axes: [f64; 3]| semi_axes.iter().map(|a| a.ln()).sum::<f64>();
    let excess = volume(answer.ellipsoid.semi_axes()) - volume(ellipsoid.semi_axes());
    assert!(-outer.log_volume_gap() <= excess && excess <= answer.log_volume_gap(), "an excess of {excess}");
    Ok(())
}
