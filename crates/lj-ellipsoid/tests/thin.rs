//! Bodies and clouds so thin, and so turned, that their thickness is among the rounding of their coordinates.
#![allow(clippy::needless_range_loop, reason = "several arrays share an index")]

use crate::common::{Rng, apply, assert_near, corners};
use lj_ellipsoid::{
    Ellipsoid, EnclosingOptions, HalfSpace, Inscribed, InscribedError, InscribedOptions, Status, enclosing, inscribed,
    inscribed_in_hull,
};

/// The unit roundoff.
const U: f64 = f64::EPSILON / 2.0;

/// The half extents in the plane of every plate here.
const WIDE: [f64; 2] = [1.0, 0.7];

/// The six sides of a plate about `center`, turned at random.
fn plate(rng: &mut Rng, thickness: f64, center: [f64; 3]) -> Vec<HalfSpace<3>> {
    let axes = rng.rotation::<3>();
    let mut sides = Vec::new();
    for (axis, half) in axes.into_iter().zip([WIDE[0], WIDE[1], thickness]) {
        for sign in [1.0, -1.0] {
            let normal = axis.map(|x| sign * x);
            let at: f64 = normal.iter().zip(center).map(|(n, c)| n * c).sum();
            sides.push(HalfSpace { normal, offset: at + half });
        }
    }
    sides
}

/// What the rounding of a long axis to doubles takes away: it leaves the plate by some U, and the square of that over
/// the square of the thickness is what the ellipsoid shrinks by.
fn lost_to_the_axes(thickness: f64) -> f64 {
    1e-12 + 20.0 * (U / thickness).powi(2)
}

#[track_caller]
fn assert_within(answer: &Inscribed<3>, sides: &[HalfSpace<3>]) {
    for side in sides {
        let reach = answer.ellipsoid.support_value(side.normal);
        assert!(reach <= side.offset, "reaches {reach:e} in {side:?}");
    }
}

fn log_det_of_plate(thickness: f64) -> f64 {
    -2.0 * (WIDE[0].ln() + WIDE[1].ln() + thickness.ln())
}

/// Turned plates about the origin, the largest ball of which was called empty below a thickness of 1e-9: Cholesky's
/// factor of a Hessian of condition 1e18 fails. The gap once grew like 3e-15/thickness.
#[test]
fn turned_plates_of_any_thickness() {
    let mut rng = Rng(1);
    for exponent in 0..=14 {
        let thickness = 10f64.powi(-exponent);
        for round in 0..40 {
            let mut sides = plate(&mut rng, thickness, [0.0; 3]);
            if round % 2 == 1 {
                // Redundant ones, near and far.
                let around = rng.sphere::<3>(40).into_iter().map(|normal| HalfSpace { normal, offset: 2.0 });
                sides.extend(around);
                sides.push(HalfSpace { normal: [0.6, 0.0, 0.8], offset: 1e9 });
            }
            let answer = inscribed(&sides, InscribedOptions::new()).expect("a plate");
            assert_within(&answer, &sides);
            let allowed = lost_to_the_axes(thickness);
            assert!(answer.log_det_gap <= allowed, "gap {:e} at thickness {thickness:e}", answer.log_det_gap);
            let error = answer.ellipsoid.log_det() - log_det_of_plate(thickness);
            assert!(error <= answer.log_det_gap + 1e-13 && error > -1e-12, "off by {error:e} at {thickness:e}");
            assert!(exponent > 11 || answer.status == Status::Converged, "{:?} at {thickness:e}", answer.status);
        }
    }
}

/// Sides whose normals are rounded one by one: opposite ones are not quite parallel, and the plate is a wedge. It is
/// the wedge as given that is answered.
#[test]
fn plates_of_normals_of_any_length() {
    let mut rng = Rng(2);
    for exponent in [6, 9, 11, 13] {
        let thickness = 10f64.powi(-exponent);
        for _ in 0..20 {
            let mut sides = plate(&mut rng, thickness, [0.0; 3]);
            for side in &mut sides {
                let length = 0.1 + 10.0 * rng.unit();
                side.normal = side.normal.map(|x| length * x);
                side.offset *= length;
            }
            let answer = inscribed(&sides, InscribedOptions::new()).expect("a wedge");
            assert_within(&answer, &sides);
            // The centre of a wedge is not at the origin, so its rounding and that of the evaluation cost a little.
            let allowed = lost_to_the_axes(thickness) + 100.0 * U * U / thickness;
            assert!(answer.log_det_gap <= allowed, "gap {:e} at thickness {thickness:e}", answer.log_det_gap);
        }
    }
}

/// Any body, squashed and turned: ln det X differs from that of the body as it was by the squashing alone.
fn squashed<const N: usize>(seed: u64) {
    let mut rng = Rng(seed);
    for round in 0..100 {
        let round_body: Vec<HalfSpace<N>> = rng
            .sphere::<N>(4 * N + 10)
            .into_iter()
            .map(|normal| HalfSpace { normal, offset: 0.3 + rng.unit() })
            .collect();
        let Ok(upright) = inscribed(&round_body, InscribedOptions::new()) else { continue };
        // x' = R·diag(d)·x, so the normals become R·diag(1/d)·a.
        let squash: [f64; N] = std::array::from_fn(|_| 10f64.powf(-13.0 * rng.unit()));
        let rotation = rng.rotation::<N>();
        let turn = |v: [f64; N]| if round % 2 == 0 { v } else { apply(&rotation, v) };
        let thin: Vec<HalfSpace<N>> = round_body
            .iter()
            .map(|h| HalfSpace { normal: turn(std::array::from_fn(|k| h.normal[k] / squash[k])), offset: h.offset })
            .collect();
        let answer = inscribed(&thin, InscribedOptions::new()).expect("a body");
        for side in &thin {
            assert!(answer.ellipsoid.support_value(side.normal) <= side.offset, "pokes out of {side:?}");
        }
        let thinnest = squash.iter().fold(1.0f64, |m, d| m.min(*d));
        let aspect = squash.iter().fold(0.0f64, |m, d| m.max(*d)) / thinnest;
        let want = upright.ellipsoid.log_det() - 2.0 * squash.iter().map(|d| d.ln()).sum::<f64>();
        let error = answer.ellipsoid.log_det() - want;
        // Turning rounds the normals, and the centre is not at the origin.
        let allowed = 1e-9 + if round % 2 == 0 { 0.0 } else { 1000.0 * U * aspect };
        assert!(error.abs() <= allowed, "off by {error:e} at aspect {aspect:e} in {N} dimensions");
        assert!(answer.log_det_gap <= allowed, "gap {:e} at aspect {aspect:e}", answer.log_det_gap);
    }
}

#[test]
fn squashed_bodies() {
    squashed::<2>(21);
    squashed::<3>(22);
    squashed::<5>(23);
}

/// Away from the origin the centre is a double, and n·c is evaluated in doubles: U·|c| of the thickness is lost, and no
/// more.
#[test]
fn plates_away_from_the_origin() {
    let mut rng = Rng(3);
    for exponent in 0..=13 {
        let thickness = 10f64.powi(-exponent);
        for _ in 0..20 {
            let sides = plate(&mut rng, thickness, [3.0, -2.0, 1.0]);
            let answer = inscribed(&sides, InscribedOptions::new()).expect("a plate");
            assert_within(&answer, &sides);
            let allowed = 1e-12 + 60.0 * U * 3.8 / thickness;
            assert!(answer.log_det_gap <= allowed, "gap {:e} at thickness {thickness:e}", answer.log_det_gap);
        }
    }
}

/// Along the coordinates nothing is lost to rounding, down to where the inverse square of the thickness leaves the
/// range.
#[test]
fn aligned_plates() {
    for exponent in [10, 16, 20, 50, 100, 150] {
        let thickness = 10f64.powi(-exponent);
        for shift in [0.0, 0.5] {
            let sides = [
                ([1.0, 0.0], 1.0 + shift),
                ([-1.0, 0.0], 1.0 - shift),
                ([0.0, 1.0], thickness),
                ([0.0, -1.0], thickness),
            ]
            .map(|(normal, offset)| HalfSpace { normal, offset });
            let answer = inscribed(&sides, InscribedOptions::new()).expect("a plate");
            assert_eq!(answer.status, Status::Converged, "gap {:e} at {thickness:e}", answer.log_det_gap);
            let [long, short] = answer.ellipsoid.semi_axes();
            assert_near("long", long, 1.0, 1e-14);
            assert_near("short over thickness", short / thickness, 1.0, 1e-14);
        }
    }
}

/// Flat and empty bodies are told from thin ones, at once.
#[test]
fn flat_and_empty_are_still_named() {
    let mut rng = Rng(4);
    for _ in 0..40 {
        let mut flat = plate(&mut rng, 0.0, [0.0; 3]);
        assert_eq!(inscribed(&flat, InscribedOptions::new()).unwrap_err(), InscribedError::EmptyInterior);
        flat[4].offset = -1e-12;
        assert_eq!(inscribed(&flat, InscribedOptions::new()).unwrap_err(), InscribedError::EmptyInterior);
        let far = plate(&mut rng, 0.0, [3.0, -2.0, 1.0]);
        // Rounded offsets may leave it a thickness of their own.
        if let Ok(answer) = inscribed(&far, InscribedOptions::new()) {
            assert_within(&answer, &far);
        }
    }
}

/// The hull of the corners of a turned plate: the gap of what is inside no longer grows like 1/thickness.
#[test]
fn hulls_of_turned_plates() {
    let mut rng = Rng(5);
    for exponent in 0..=13 {
        let thickness = 10f64.powi(-exponent);
        for _ in 0..20 {
            let rotation = rng.rotation::<3>();
            let plate = corners([-WIDE[0], -WIDE[1], -thickness], [WIDE[0], WIDE[1], thickness]);
            let points: Vec<[f64; 3]> = plate.into_iter().map(|p| apply(&rotation, p)).collect();
            let answer = inscribed_in_hull(&points, InscribedOptions::new()).expect("a plate");
            let allowed = 4e-12 + 100.0 * (U / thickness).powi(2);
            assert!(answer.log_det_gap <= allowed, "gap {:e} at thickness {thickness:e}", answer.log_det_gap);
            // The corners themselves are rounded: that moves the truth.
            let error = answer.ellipsoid.log_det() - log_det_of_plate(thickness);
            assert!(error.abs() < 1e-11 + 40.0 * U / thickness, "off by {error:e} at {thickness:e}");
        }
    }
}

/// The rotation as a matrix whose rows are the images of the coordinate axes.
fn images_of_axes([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
        [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

#[track_caller]
fn assert_rotation_is_that_of_the_axes(ellipsoid: &Ellipsoid<3>) {
    let axes = ellipsoid.axes();
    for i in 0..3 {
        for j in 0..3 {
            let product: f64 = (0..3).map(|k| axes[i][k] * axes[j][k]).sum();
            assert_near("axes are orthonormal", product, if i == j { 1.0 } else { 0.0 }, 2e-15);
        }
    }
    let q = ellipsoid.rotation();
    assert!(q[3] >= 0.0, "the scalar part of {q:?}");
    for (image, axis) in images_of_axes(q).into_iter().zip(axes) {
        for k in 0..3 {
            assert_near("image of a coordinate axis", image[k], axis[k], 4e-15);
        }
    }
}

/// Flat clouds, turned: the doubles of X are then not even positive definite, but centre, semi-axes and rotation tell
/// the ellipsoid to the last digits that the points determine.
#[test]
fn flat_clouds_by_their_axes() {
    let mut rng = Rng(6);
    for exponent in [0, 3, 6, 9, 11, 13] {
        let thickness = 10f64.powi(-exponent);
        for _ in 0..12 {
            let upright: Vec<[f64; 3]> =
                rng.ball::<3>(60).into_iter().map(|[x, y, z]| [x, 0.5 * y, thickness * z]).collect();
            let rotation = rng.rotation::<3>();
            let turned: Vec<[f64; 3]> = upright.iter().map(|&p| apply(&rotation, p)).collect();
            let (want, got) =
                (enclosing(&upright, EnclosingOptions::new()), enclosing(&turned, EnclosingOptions::new()));
            let (want, got) = (want.expect("thin").ellipsoid, got.expect("thin").ellipsoid);
            assert_rotation_is_that_of_the_axes(&got);
            assert!(turned.iter().all(|&p| got.contains(p)), "a point is outside");
            // Turned points are rounded, by some U.
            for (k, (got, want)) in got.semi_axes().into_iter().zip(want.semi_axes()).enumerate() {
                assert_near(&format!("semi-axis {k} at {thickness:e}"), got / want, 1.0, 1e-12 + 200.0 * U / thickness);
            }
            for k in 0..3 {
                let center = apply(&rotation, want.center());
                assert_near("centre", got.center()[k], center[k], 1e-12 + 200.0 * U / thickness);
            }
        }
    }
}

#[test]
fn rotations_of_all_kinds() {
    // About each axis by nearly half a turn, where the scalar part vanishes; and in the plane.
    for k in 0..3 {
        for angle in [0.0, 1e-9, 1.0, 3.0, std::f64::consts::PI - 1e-9] {
            let (sin, cos) = f64::sin_cos(angle);
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let points: Vec<[f64; 3]> = corners([-3.0, -2.0, -1.0], [3.0, 2.0, 1.0])
                .into_iter()
                .map(|p| {
                    let mut turned = p;
                    (turned[i], turned[j]) = (cos * p[i] - sin * p[j], sin * p[i] + cos * p[j]);
                    turned
                })
                .collect();
            assert_rotation_is_that_of_the_axes(&enclosing(&points, EnclosingOptions::new()).expect("a box").ellipsoid);
        }
    }
    let flat = [[0.0, 0.0], [3.0, 3.0], [1.0, 1.0 + 1e-12]];
    let ellipse = enclosing(&flat, EnclosingOptions::new()).expect("a triangle").ellipsoid;
    let quarter = std::f64::consts::FRAC_PI_4;
    let angle = ellipse.rotation();
    assert!((angle - quarter).abs().min((angle + 3.0 * quarter).abs()) < 1e-11, "angle {angle}");
}

/// A triangle as long as 1e8 of its width, by its sides and by half-spaces beside them: −Σaᵢ is a combination of two
/// rows with weights of 1e8, whose rounding was taken for a direction in which the triangle is open. The largest
/// ellipse in it is the image of the circle in the regular triangle, of π/(3√3) of its area.
#[test]
fn a_bounded_needle_is_not_called_unbounded() {
    let mut rng = Rng(7);
    for long in [1e4, 1e6, 1e8, 1e9] {
        for _ in 0..20 {
            let mut sides = Vec::new();
            for third in 0..3 {
                let (sine, cosine) = (std::f64::consts::TAU / 3.0 * f64::from(third)).sin_cos();
                sides.push(HalfSpace { normal: [cosine / long, sine], offset: 1.0 });
            }
            for _ in 0..30 {
                let (sine, cosine) = (3.0 * rng.normal()).sin_cos();
                sides.push(HalfSpace { normal: [cosine / long, sine], offset: 1.5 });
            }
            let answer = inscribed(&sides, InscribedOptions::default()).expect("it is bounded");
            let [a, b] = [answer.ellipsoid.semi_axes()[0], answer.ellipsoid.semi_axes()[1]];
            assert!((a * b / long - 1.0).abs() < 1e-6, "{long:e}: {a} {b}");
        }
    }
}

/// {|kx + (k+1)y| ≤ 1, |(k−1)x + ky| ≤ 1} is the image of a square by an integer matrix of determinant one: of the
/// largest ellipse in it ln det X* = 0, and of the least around it −2·ln 2. So a smaller or larger number is itself the
/// proof that an ellipse sticks out, or leaves a corner outside. At k = 8e6 that was −0.0191 with a gap of 0.0 and
/// `Converged`: containment was looked at in plain arithmetic, which loses 1e-16 of the length 2k of terms that cancel
/// to the thickness 1/2k, and the bound on ln det X* that came out below what was returned was clamped to it.
#[test]
fn what_is_inside_or_around_a_parallelogram_is_proved_to_be() {
    for k in [1.0, 2.0, 13.0, 110.0, 924.0, 5756.0, 85628.0, 3e6, 6365106.0, 8e6] {
        let [a, b] = [[k, k + 1.0], [k - 1.0, k]];
        let side = |normal: [f64; 2]| HalfSpace { normal, offset: 1.0 };
        let sides = [side(a), side(a.map(|x| -x)), side(b), side(b.map(|x| -x))];
        let corner = |s: f64, t: f64| [k * s - (k + 1.0) * t, k * t - (k - 1.0) * s];
        let corners = [corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0), corner(-1.0, 1.0)];
        let options = InscribedOptions::new();
        for inner in [inscribed(&sides, options), inscribed_in_hull(&corners, options)] {
            let Inscribed { ellipsoid, log_det_gap: gap, .. } = inner.expect("an ellipse");
            let log_det = ellipsoid.log_det();
            assert!((0.0..=gap).contains(&log_det), "k = {k}: ln det X = {log_det:e}, gap {gap:e}");
            // The directions of the axes are rounded, by U of a length that is 4k² of the thickness.
            assert!(gap < 1e-12 + 30.0 * U * k * k, "k = {k}: gap {gap:e}");
        }
        let outer = enclosing(&corners, EnclosingOptions::new()).expect("an ellipse");
        let (missing, gap) = (-4f64.ln() - outer.ellipsoid.log_det(), outer.log_det_gap);
        assert!((-U..=gap).contains(&missing), "k = {k}: ln det X falls short by {missing:e}, gap {gap:e}");
    }
}

/// Bounded bodies that were called unbounded: the columns of their normals depend on one another but for 1e-15 or less,
/// so that what orthogonalisation left of the last was rounding. From coordinates stretched along it, products with the
/// normals as given tell how far away the needle ends.
#[test]
fn needles_as_long_as_doubles_can_tell() {
    for k in [1e7, 3e7, 1e8] {
        let [a, b] = [[k, k + 1.0], [k - 1.0, k]];
        let side = |normal: [f64; 2]| HalfSpace { normal, offset: 1.0 };
        let sides = [side(a), side(a.map(|x| -x)), side(b), side(b.map(|x| -x))];
        let answer = inscribed(&sides, InscribedOptions::new()).expect("a parallelogram");
        let log_det = answer.ellipsoid.log_det();
        assert!((0.0..=answer.log_det_gap).contains(&log_det), "{log_det:e}, gap {:e}", answer.log_det_gap);
    }
    // 1e15 times as long as thick, from whole numbers.
    let corners = [[37219, 72491, -21881], [-32074, -88252, -82775], [57034, -11760, -74227], [57034, -11760, -74226]];
    let sides: Vec<HalfSpace<3>> = (0..4)
        .map(|apex| {
            let [p, q, r] = std::array::from_fn(|i| corners[(apex + 1 + i) % 4].map(i64::from));
            let (u, v): ([i64; 3], [i64; 3]) =
                (std::array::from_fn(|i| q[i] - p[i]), std::array::from_fn(|i| r[i] - p[i]));
            let along = |n: [i64; 3], x: [i64; 3]| -> i64 { n.iter().zip(x).map(|(n, x)| n * x).sum() };
            let mut n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            if along(n, corners[apex].map(i64::from)) > along(n, p) {
                n = n.map(|x| -x);
            }
            HalfSpace { normal: n.map(|x| x as f64), offset: along(n, p) as f64 }
        })
        .collect();
    let answer = inscribed(&sides, InscribedOptions::new()).expect("a simplex");
    assert_within(&answer, &sides);
}

/// What is refused says how near to nothing it is, and is called unbounded or empty only where that is certain.
#[test]
fn refusals_name_the_number() {
    let refused = |sides: &[HalfSpace<3>]| inscribed(sides, InscribedOptions::new()).unwrap_err();
    let side = |normal: [f64; 3], offset: f64| HalfSpace { normal, offset };
    // A prism along (1, 1, -3): whole numbers tell that it is open.
    let sides = [[3.0, 0.0, 1.0], [0.0, 3.0, 1.0], [-3.0, -3.0, -2.0], [1.0, -1.0, 0.0]];
    assert_eq!(refused(&sides.map(|normal| side(normal, 1.0))), InscribedError::Unbounded);
    // Turned, its rounded normals may be open for certain, or close so far away that no ellipsoid in doubles tells.
    let mut rng = Rng(8);
    for _ in 0..20 {
        let rotation = rng.rotation::<3>();
        match inscribed(&sides.map(|normal| side(apply(&rotation, normal), 1.0)), InscribedOptions::new()) {
            Err(InscribedError::NearlyUnbounded { ratio } | InscribedError::NearlyEmpty { ratio }) => {
                assert!((0.0..1e-12).contains(&ratio), "{ratio:e}");
            }
            Err(other) => assert_eq!(other, InscribedError::Unbounded),
            Ok(answer) => assert!(answer.ellipsoid.semi_axes()[0] > 1e14, "{:?}", answer.ellipsoid),
        }
    }
    // A simplex shrunk to a point, and one turned inside out.
    let simplex = |size: f64| {
        [
            side([-1.0, 0.0, 0.0], 0.0),
            side([0.0, -1.0, 0.0], 0.0),
            side([0.0, 0.0, -1.0], 0.0),
            side([1.0, 1.0, 1.0], size),
        ]
    };
    match refused(&simplex(0.0)) {
        InscribedError::NearlyEmpty { ratio } => assert!((0.0..=1.0).contains(&ratio), "{ratio:e}"),
        other => assert_eq!(other, InscribedError::EmptyInterior),
    }
    assert_eq!(refused(&simplex(-1.0)), InscribedError::EmptyInterior);
}
