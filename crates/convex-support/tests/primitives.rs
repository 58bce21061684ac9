//! No primitive is left out of the checks: those that `shapes/mod.rs` exports are those that are drawn.

use std::collections::BTreeSet;

use convex_support::glam::DVec3;
use convex_support::strategies::{self, AnyShape};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use crate::exact::Random;

/// What the crate exports.
fn primitives() -> BTreeSet<String> {
    let exports = include_str!("../src/shapes/mod.rs").lines().filter_map(|line| line.strip_prefix("pub use "));
    let name = |path: &str| path.trim_end_matches(';').rsplit("::").next().map(str::to_owned);
    exports.filter_map(name).collect()
}

/// The name of a shape's type, with which its Debug output begins.
fn name(shape: &AnyShape<DVec3>) -> String {
    format!("{shape:?}").chars().take_while(|c| c.is_alphanumeric()).collect()
}

/// In `exact/shape.rs`, against which what shapes say of their rounding is tested.
#[test]
fn every_primitive_is_known_in_exact_numbers() {
    let mut random = Random::new::<DVec3>(7);
    let drawn: BTreeSet<String> = (0..1000).map(|_| name(&random.leaf().build::<DVec3>())).collect();
    assert_eq!(drawn, primitives());
}

/// In `strategies.rs`, by which the laws are tested. A polytope with its facets is tested in `faceted.rs`, against the
/// polytope without them.
#[test]
fn every_primitive_is_drawn_for_the_laws() {
    let mut runner = TestRunner::deterministic();
    let strategy = strategies::primitive_3d::<DVec3>(1.0);
    let mut draw = || name(&strategy.new_tree(&mut runner).expect("strategies reject nothing").current());
    let mut drawn: BTreeSet<String> = (0..1000).map(|_| draw()).collect();
    assert!(drawn.insert("Faceted".to_owned()));
    assert_eq!(drawn, primitives());
}
