//! Points that come, go and move: always the answer of a cold solve, mostly cheaper.

use crate::common::{Rng, assert_contains, assert_near};
use lj_ellipsoid::{EnclosingError, EnclosingOptions, MovingPoints, enclosing};

const TIGHT: EnclosingOptions = EnclosingOptions::new().with_epsilon(1e-11);

#[test]
fn a_stream_follows_the_cold_answer() {
    let mut rng = Rng(1);
    let mut points = MovingPoints::new(&rng.normals::<3>(50), TIGHT).expect("finite");
    for step in 0..300 {
        match rng.next() % 3 {
            0 => {
                points.insert(rng.normals::<3>(1)[0]).expect("finite");
            }
            1 if points.points().len() > 10 => {
                points.remove((rng.next() % points.points().len() as u64) as usize);
            }
            _ => {
                let index = (rng.next() % points.points().len() as u64) as usize;
                let p = points.points()[index].map(|x| x + 0.1 * rng.normal());
                points.update(index, p).expect("finite");
            }
        }
        let answer = points.enclosing().expect("full rank").clone();
        assert_contains(&answer, points.points());
        let cold = enclosing(points.points(), TIGHT).expect("full rank");
        let allowed = answer.log_det_gap + cold.log_det_gap + 1e-12;
        assert_near(&format!("ln det at step {step}"), answer.ellipsoid.log_det(), cold.ellipsoid.log_det(), allowed);
        for w in &answer.weights {
            assert!(answer.contacts.contains(&w.index), "weight {} of a point off the surface", w.weight);
        }
    }
    assert!(points.solves() < 250, "{} solves of 301", points.solves());
    assert!(points.solves() > 20, "the sample must touch the ellipsoid at times: {} solves", points.solves());
}

#[test]
fn a_far_jump_and_a_collapse_start_afresh() {
    let mut points = MovingPoints::new(&Rng(2).normals::<2>(20), TIGHT).expect("finite");
    points.enclosing().expect("full rank");
    points.update(3, [1e9, -1e9]).expect("finite");
    let answer = points.enclosing().expect("full rank").clone();
    assert_contains(&answer, points.points());
    while points.points().len() > 2 {
        points.remove(0);
    }
    assert_eq!(points.enclosing().unwrap_err(), EnclosingError::Flat { rank: 1, dimension: 2 });
    // An error is no answer to start from: the next solve is cold, and right.
    points.insert([0.0, 5.0]).expect("finite");
    assert_eq!(points.enclosing().expect("a triangle").contacts.len(), 3);
}

/// In the old frame the three are one point beside the fourth. That was an index out of bounds.
#[test]
fn a_point_so_far_away_that_the_others_seem_to_be_one_starts_afresh() {
    let mut points = MovingPoints::new(&[[0.0, 1.0], [1.0, -1.0], [0.0, -1.0]], TIGHT).expect("finite");
    points.enclosing().expect("a triangle");
    points.insert([816497758.8503735, -816497758.8503735]).expect("finite");
    let answer = points.enclosing().expect("full rank").clone();
    assert_contains(&answer, points.points());
    let cold = enclosing(points.points(), TIGHT).expect("full rank");
    assert_eq!(answer.status, cold.status);
    let allowed = answer.log_det_gap + cold.log_det_gap + 1e-12;
    assert_near("ln det", answer.ellipsoid.log_det(), cold.ellipsoid.log_det(), allowed);
}

#[test]
fn bad_points_change_nothing() {
    let mut points = MovingPoints::new(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], TIGHT).expect("finite");
    assert!(matches!(points.insert([f64::NAN, 0.0]), Err(EnclosingError::NonFinite { index: 3, .. })), "NaN");
    assert!(
        matches!(points.update(1, [0.0, f64::INFINITY]), Err(EnclosingError::NonFinite { index: 1, .. })),
        "infinity"
    );
    assert_eq!(points.points(), [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
}
