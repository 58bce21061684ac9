//! The descent in the plane as Schneider and Eberly tell it (*Geometric Tools for Computer Graphics*, 2003, Section
//! 6.10.1), through the observer: the simplex `S_k`, its point `V_k` closest to the origin, and the support point
//! `W_k`.

use convex_support::glam::DVec2;
use convex_support::{Point, Polytope, SupportMap};
use gjk_raycast::{Distance, DistanceOptions, SubAlgorithm, distance_with};
use proptest::prelude::*;

/// A step, in the units of the polygon.
#[derive(Clone, Debug)]
struct Step {
    simplex: Vec<DVec2>,
    v: DVec2,
    w: DVec2,
}

fn descend(polygon: &Polytope<DVec2>, options: DistanceOptions<DVec2>) -> (Vec<Step>, Distance<DVec2>) {
    let origin = Point::new(DVec2::ZERO).expect("finite");
    let mut steps = Vec::new();
    let end = distance_with(polygon, &origin, options, |iterate| {
        let unit = iterate.scale;
        let simplex = iterate.simplex.iter().map(|&p| p * unit).collect();
        steps.push(Step { simplex, v: iterate.v * unit, w: iterate.w * unit });
    });
    (steps, end)
}

/// The distance of the origin from the segment between two points.
fn from_segment(a: DVec2, b: DVec2) -> f64 {
    let edge = b - a;
    let t = if edge.length_squared() > 0.0 { (-a.dot(edge) / edge.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (a + edge * t).length()
}

/// A regular polygon, squeezed, turned and moved.
fn polygon() -> impl Strategy<Value = (Vec<DVec2>, DVec2)> {
    (3_usize..24, -3.0..3.0, 0.01..1.0, -4.0..4.0, -4.0..4.0, -3.0..3.0).prop_map(
        |(n, turn, squeeze, x, y, first): (usize, f64, f64, f64, f64, f64)| {
            let corner = |i: usize| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                DVec2::from_angle(turn).rotate(DVec2::new(angle.cos(), squeeze * angle.sin())) + DVec2::new(x, y)
            };
            ((0..n).map(corner).collect(), DVec2::from_angle(first))
        },
    )
}

const ALL: [SubAlgorithm; 3] = [SubAlgorithm::NearestFace, SubAlgorithm::Johnson, SubAlgorithm::SignedVolumes];

proptest! {
    #![proptest_config(convex_support::laws::config(400))]

    /// `|V_{k+1}| ≤ |V_k|`, with equality only at the end; the closest point is reached in finitely many steps, no more
    /// than the polygon has vertices, and a few; `S_{k+1} ⊆ S_k ∪ {W_k}` is the smallest that holds `V_{k+1}`.
    #[test]
    fn the_descent_goes_down_and_ends((corners, first) in polygon(), which in 0_usize..3) {
        let polygon = Polytope::new(corners.iter().copied()).expect("finite");
        let options = DistanceOptions::new().with_axis(first).with_sub_algorithm(ALL[which]);
        let (steps, end) = descend(&polygon, options);
        prop_assert!(steps.len() <= corners.len() + 2, "{} steps on {} corners", steps.len(), corners.len());

        let rounding = 1e-14 * corners.iter().map(|c| c.length()).fold(1.0, f64::max);
        for pair in steps.windows(2) {
            let [before, after] = pair else { unreachable!("windows of two") };
            // V_0 is only a direction.
            if !before.simplex.is_empty() {
                prop_assert!(after.v.length() <= before.v.length() + rounding, "{:?}", pair);
            }
            for corner in &after.simplex {
                let known = before.simplex.iter().chain([&before.w]).any(|p| (*p - *corner).length() <= rounding);
                prop_assert!(known, "a vertex from nowhere: {:?}", pair);
            }
            prop_assert!(after.simplex.len() <= 2, "V lies on an edge or a vertex before the end: {:?}", pair);
            // V_{k+1} is the point of S_{k+1} closest to the origin.
            let [a, b] = [after.simplex[0], after.simplex[after.simplex.len() - 1]];
            prop_assert!((from_segment(a, b) - after.v.length()).abs() <= rounding, "{:?}", pair);
            // W_k is the farthest left along V_k: no corner lies before it.
            let least = corners.iter().map(|c| after.v.dot(*c)).fold(f64::INFINITY, f64::min);
            prop_assert!(after.v.dot(after.w) <= least + 8.0 * rounding, "{:?}", pair);
        }

        let next = |i: usize| corners[(i + 1) % corners.len()];
        let inside = (0..corners.len()).all(|i| (next(i) - corners[i]).perp_dot(-corners[i]) >= 0.0);
        let truth = (0..corners.len()).map(|i| from_segment(corners[i], next(i))).fold(f64::INFINITY, f64::min);
        let truth = if inside { 0.0 } else { truth };
        prop_assert!((end.distance - truth).abs() <= 8.0 * rounding, "{:?}, truth {}", end, truth);
    }
}

/// The book's figures 6.25 to 6.29: a polygon seen from the left. `S_1 = {W_0}`, `S_2 = {W_0, W_1}` with `V_2` within
/// the edge, and as soon as a new vertex brings another edge closer, the old vertex is discarded.
#[test]
fn the_old_vertex_is_discarded() {
    let corners = [[2.0, 4.0], [5.0, 5.0], [7.0, 1.0], [6.0, -3.0], [3.0, -4.0], [1.5, -1.0]].map(DVec2::from_array);
    let polygon = Polytope::new(corners).expect("finite");
    let (steps, end) = descend(&polygon, DistanceOptions::new().with_axis(DVec2::new(0.2, 1.0)));

    // W_0 is the vertex farthest against V_0, and S_1 is that vertex.
    assert!(steps[0].simplex.is_empty(), "S_0 is empty");
    assert_eq!(steps[1].simplex, [steps[0].w], "S_1 = {{W_0}}");
    assert_eq!(steps[1].v, steps[0].w, "and V_1 is W_0");
    assert_eq!(steps[0].w, polygon.support(-DVec2::new(0.2, 1.0)), "found along V_0");

    let discarded = steps.windows(2).filter(|pair| {
        let grown = pair[0].simplex.len() + 1;
        !pair[0].simplex.is_empty() && pair[1].simplex.len() < grown
    });
    assert!(discarded.count() >= 1, "a vertex is discarded: {steps:#?}");
    let last = steps.last().expect("steps");
    assert!(last.simplex.contains(&DVec2::new(1.5, -1.0)), "the nearest vertex stays: {last:?}");
    let truth = (0..6).map(|i| from_segment(corners[i], corners[(i + 1) % 6])).fold(f64::INFINITY, f64::min);
    assert!((end.distance - truth).abs() < 1e-14, "{end:?}, truth {truth}");
}
