//! Which ellipsoid encloses this link, how near to the smallest is it, and how much of it does the link fill?
//!
//! ```text
//! cargo run --release --package lj-ellipsoid --example ellipsoid_around_a_mesh
//! ```
#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use std::error::Error;

use lj_ellipsoid::{EnclosingMethod, EnclosingOptions, InscribedOptions, enclosing, enclosing_with, inscribed_in_hull};

/// The vertices of a forearm: a tube that tapers, with a flange at its thick end.
fn link() -> Vec<[f64; 3]> {
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

fn main() -> Result<(), Box<dyn Error>> {
    let vertices = link();
    let options = EnclosingOptions::new().with_epsilon(1e-12);

    println!("pass  points at work  certified gap");
    let outer = enclosing_with(&vertices, options, |iterate| {
        println!("{:4}  {:14}  {:.1e}", iterate.scans, iterate.indices.len(), iterate.log_det_gap);
    })?;
    let ellipsoid = outer.ellipsoid;
    println!("\n{:?} with a gap of {:.1e}, {} vertices touch", outer.status, outer.log_det_gap, outer.contacts.len());
    println!("centre     {:?}", ellipsoid.center());
    println!("semi-axes  {:?}", ellipsoid.semi_axes());

    let inner = inscribed_in_hull(&vertices, InscribedOptions::new())?;
    println!("tightness  {:.3} (1 for an ellipsoid, at least 1/3)", inner.ellipsoid.tightness(&ellipsoid));

    println!("\nthe first-order method for the same: ");
    let first_order = options.with_method(EnclosingMethod::Khachiyan).with_epsilon(1e-6);
    let answer = enclosing(&vertices, first_order)?;
    println!("{:?} after {} iterations, gap {:.1e}", answer.status, answer.iterations, answer.log_det_gap);
    Ok(())
}
