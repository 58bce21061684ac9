//! Numbers are enclosed, what is not known proves nothing, and shapes are those of the query format.

use serde_json::{Value, json};

use crate::body::Set;
use crate::interval::{Interval, Vector, determinant};
use crate::reader::Reader;

/// Whether a number is certainly between two doubles.
fn is_between(number: &Interval, low: f64, high: f64) -> bool {
    Interval::from(low).is_at_most(number) && number.is_at_most(&Interval::from(high))
}

#[test]
fn intervals_enclose_what_they_stand_for() {
    let [one, three] = [1.0, 3.0].map(Interval::from);
    let third = one.over(&three);
    assert!(third.least().is_less_than(&third.greatest()), "a third is no binary number");
    assert!(is_between(&(&third * &three).least(), 1.0 - 1e-15, 1.0), "from below");
    assert!(is_between(&(&third * &three).greatest(), 1.0, 1.0 + 1e-15), "from above");
    let two = Interval::from(2.0).root().squared();
    assert!(is_between(&two.least(), 2.0 - 1e-15, 2.0) && is_between(&two.greatest(), 2.0, 2.0 + 1e-15), "{two:?}");
    let apart = &Interval::from(1e308) + &Interval::from(5e-324);
    assert!(
        !apart.is_less_than(&Interval::from(1e308)) && !apart.is_at_most(&Interval::from(1e308)),
        "nothing is lost"
    );
    for angle in [-7.0_f64, 0.5, 3.0, 1e6] {
        let [sine, cosine] = Interval::from(angle).sine_and_cosine();
        assert!(is_between(&sine, angle.sin() - 1e-15, angle.sin() + 1e-15), "the sine of {angle}");
        assert!(is_between(&cosine, angle.cos() - 1e-15, angle.cos() + 1e-15), "the cosine of {angle}");
    }
}

#[test]
fn what_is_not_known_proves_nothing() {
    let zero = Interval::zero();
    for unknown in [Interval::from(f64::NAN), zero.over(&zero), Interval::unknown()] {
        let made =
            [unknown.squared(), &unknown + &zero, &unknown * &zero, unknown.over(&Interval::from(2.0)), -&unknown];
        for value in made.iter().chain([&unknown]) {
            assert!(!value.is_at_most(&Interval::from(1e300)) && !value.is_less_than(&zero), "{value:?}");
            assert!(!Interval::from(-1.0).is_less_than(value) || value.is_not_negative(), "{value:?}");
            assert!(!Interval::from(1.0).is_at_most(value) && !value.is_infinite(), "{value:?}");
        }
    }
}

#[test]
fn determinants_of_whole_numbers_are_exact() {
    let rows = [[2.0, 0.0, 1.0, 3.0], [1.0, -1.0, 0.0, 4.0], [5.0, 2.0, 2.0, 0.0], [0.0, 7.0, 1.0, 1.0]];
    let rows: Vec<Vec<Interval>> = rows.iter().map(|row| row.map(Interval::from).to_vec()).collect();
    assert!((&determinant(&rows) - &Interval::from(68.0)).is_zero(), "{:?}", determinant(&rows));
    let singular = [rows[0].clone(), rows[1].clone(), rows[0].clone(), rows[3].clone()];
    assert!(determinant(&singular).is_zero(), "two rows are equal");
}

/// How far a shape of the query format reaches, as the checker reads it.
fn reach(shape: &Value, direction: [f64; 3]) -> Interval {
    let mesh = |path: &str| Err(format!("no mesh is expected, and none is at {path}"));
    let reader = Reader::new(&json!({}), &mesh).expect("double precision");
    let body = reader.body(shape).unwrap_or_else(|why| panic!("{why}: {shape}"));
    let direction = Vector(direction.map(Interval::from));
    let (point, value) = body.core.support(&direction);
    assert!(
        !point.dot(&direction).is_less_than(&value) || !matches!(body.core, Set::Ball),
        "the point is the farthest"
    );
    &value + &(&body.radius * &direction.length())
}

#[test]
fn shapes_reach_as_far_as_their_formulas_say() {
    let upright = |kind: &str| json!({"type": kind, "half_height": 2.0, "radius": 3.0});
    let quarter = json!([0.0, 0.0, 3.0, 3.0]);
    let cases = [
        (upright("capsule"), [0.0, 5.0, 0.0], 25.0),
        (upright("cylinder"), [4.0, 5.0, -3.0], 25.0),
        (upright("cone"), [4.0, 5.0, -3.0], 10.0),
        (upright("cone"), [4.0, -5.0, -3.0], 25.0),
        (json!({"type": "ellipsoid", "center": [1, 0, 0], "semi_axes": [3, 4, 1]}), [1.0, 1.0, 0.0], 6.0),
        (
            json!({"type": "ellipsoid", "center": [1, 0, 0], "matrix": [[0.25, 0, 0], [0, 1, 0], [0, 0, 1]]}),
            [3.0, 0.0, 8.0],
            13.0,
        ),
        (
            json!({"type": "posed", "rotation": quarter, "of": {"type": "cuboid", "half_extents": [1, 2, 3]}}),
            [1.0, 0.0, 0.0],
            2.0,
        ),
        (
            json!({"type": "affine", "matrix": [[2, 0, 0], [0, 2, 0], [0, 0, -2]], "of": {"type": "ball", "radius": 3}}),
            [0.0, 0.0, 1.0],
            6.0,
        ),
        (
            json!({"type": "affine", "matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 0]], "of": {"type": "ball", "radius": 3}}),
            [0.0, 0.0, 1.0],
            0.0,
        ),
        (
            json!({"type": "hull", "of": [{"type": "ball", "radius": 3}, {"type": "rounded", "radius": 1, "of": {"type": "point", "at": [5, 0, 0]}}]}),
            [1.0, 0.0, 0.0],
            6.0,
        ),
    ];
    for (shape, direction, expected) in cases {
        let reach = reach(&shape, direction);
        assert!(
            is_between(&reach, expected - 1e-12, expected + 1e-12),
            "{shape} along {direction:?}: {}",
            reach.to_f64()
        );
    }
}

/// The bound on the distance of a point from a body is no less than the distance, and not much more, on surfaces and
/// off them.
#[test]
fn distances_of_points_from_bodies_are_bounded() {
    let mesh = |path: &str| Err(format!("no mesh is expected, and none is at {path}"));
    let upright = |kind: &str| json!({"type": kind, "half_height": 2.0, "radius": 3.0});
    let flat = json!({"type": "cuboid", "half_extents": [1, 2, 3]});
    let cases = [
        (upright("capsule"), [3.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.0),
        (upright("cylinder"), [3.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.0),
        (upright("cylinder"), [1.0, 2.5, 1.0], [0.0, 1.0, 0.0], 0.5),
        (upright("cone"), [0.0, 2.0, 0.0], [0.0, 1.0, 0.0], 0.0),
        (flat.clone(), [1.0, 0.3, -0.7], [1.0, 0.0, 0.0], 0.0),
        (flat, [1.25, 0.3, -0.7], [1.0, 0.0, 0.0], 0.25),
        (
            json!({"type": "ellipsoid", "center": [0, 0, 0], "semi_axes": [1e4, 1, 2]}),
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            0.0,
        ),
        (
            json!({"type": "ellipsoid", "center": [0, 0, 0], "semi_axes": [3, 4, 1]}),
            [0.1, 0.2, 0.3],
            [1.0, 0.0, 0.0],
            0.0,
        ),
    ];
    for (shape, at, normal, expected) in cases {
        let reader = Reader::new(&json!({}), &mesh).expect("double precision");
        let body = reader.body(&shape).unwrap_or_else(|why| panic!("{why}: {shape}"));
        let [at, normal] = [at, normal].map(|v| Vector(v.map(Interval::from)));
        for toward in [Some(&normal), None] {
            let bound = body.distance_from(&at, toward, &Interval::from(1e-12));
            let most = if toward.is_some() { expected + 1e-11 } else { expected + 1e-6 };
            assert!(is_between(&bound, expected, most), "{shape}: {} for {expected}", bound.to_f64());
        }
    }
}

/// Every field of a shape is read, and every vector is of the dimension of the others.
#[test]
fn shapes_with_a_field_that_is_not_read_are_refused() {
    let mesh = |path: &str| Err(format!("no mesh is expected, and none is at {path}"));
    for (shape, named) in [
        (json!({"type": "ball", "radius": 1, "half_height": 1}), "half_height"),
        (json!({"type": "ellipsoid", "center": [0, 0], "matrix": [[1, 0], [0, 1]], "rotation": 1}), "not read"),
        (json!({"type": "hull", "of": [{"type": "point", "at": [0, 0], "radius": 1}]}), "radius"),
        (json!({"type": "segment", "points": [[0, 0], [1, 0, 0]]}), "dimension"),
        (
            json!({"type": "posed", "rotation": 1, "translation": [0, 0, 0], "of": {"type": "ball", "radius": 1}}),
            "dimension",
        ),
        (json!({"type": "triangle", "points": [[0, 0], [1, 0]]}), "2 points"),
        (json!({"type": "cuboid", "half_extents": [1, -1]}), "negative"),
    ] {
        let reader = Reader::new(&json!({}), &mesh).expect("double precision");
        let read = reader.body(&shape).err().unwrap_or_default();
        assert!(read.contains(named), "{read:?} should name {named}: {shape}");
    }
}
