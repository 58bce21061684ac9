//! Laws of the two ellipsoids, on points of wild aspect and scale.
#![allow(clippy::needless_range_loop, reason = "formulas index several arrays at once")]

use crate::common::{Rng, apply, assert_contains, config};
use lj_ellipsoid::{
    Ellipsoid, Enclosing, EnclosingMethod, EnclosingOptions, FlatPolicy, HalfSpace, Inscribed, InscribedOptions,
    MovingPoints, Status, enclosing, inscribed, inscribed_in_hull,
};
use proptest::prelude::*;

const TIGHT: EnclosingOptions = EnclosingOptions::new().with_epsilon(1e-11);

/// A cloud whose axes are stretched by up to 1e6 and turned, some of it on a grid or repeated.
fn cloud<const N: usize>() -> impl Strategy<Value = Vec<[f64; N]>> {
    (any::<u64>(), N + 2..60usize, 0..4u8, prop::array::uniform3(-6.0..0.0f64), -9.0..9.0f64, 0.0..1e3f64).prop_map(
        |(seed, m, kind, aspects, scale, offset)| {
            let mut rng = Rng(seed);
            let mut points = match kind {
                0 => rng.normals::<N>(m),
                1 => rng.sphere::<N>(m),
                2 => rng.normals::<N>(m).into_iter().map(|p| p.map(|x| (2.0 * x).round())).collect(),
                _ => {
                    let mut points = rng.ball::<N>(m);
                    points.extend_from_within(..m / 2);
                    points
                }
            };
            // A simplex keeps a coarse grid from being flat.
            points.extend((0..=N).map(|i| std::array::from_fn(|k| if i == k { 3.0 } else { 0.0 })));
            let rotation = rng.rotation::<N>();
            let stretch: [f64; N] = std::array::from_fn(|k| 10f64.powf(scale + aspects[k % 3]));
            points
                .into_iter()
                .map(|p| {
                    let q = apply(&rotation, std::array::from_fn(|k| p[k] * stretch[k]));
                    q.map(|x| x + offset * stretch[0])
                })
                .collect()
        },
    )
}

/// The dual bound computed afresh from the weights, in plain arithmetic: ln det X* ≤ −ln det S − N·ln N.
fn dual_bound<const N: usize>(points: &[[f64; N]], answer: &Enclosing<N>) -> f64 {
    let e = &answer.ellipsoid;
    // In the coordinates of the axes, so that thin clouds lose nothing more.
    let image = |i: usize| -> [f64; N] {
        let d: [f64; N] = std::array::from_fn(|k| points[i][k] - e.center()[k]);
        let turned = apply(&e.axes(), d);
        std::array::from_fn(|k| turned[k] / e.semi_axes()[k])
    };
    let mut mean = [0.0; N];
    for w in &answer.weights {
        let y = image(w.index);
        (0..N).for_each(|k| mean[k] += w.weight * y[k]);
    }
    let mut s = [[0.0; N]; N];
    for w in &answer.weights {
        let y = image(w.index);
        for i in 0..N {
            for j in 0..N {
                s[i][j] += w.weight * (y[i] - mean[i]) * (y[j] - mean[j]);
            }
        }
    }
    // ln det by elimination.
    let mut log_det = 0.0;
    for k in 0..N {
        log_det += s[k][k].ln();
        for i in k + 1..N {
            let f = s[i][k] / s[k][k];
            for j in k..N {
                s[i][j] -= f * s[k][j];
            }
        }
    }
    e.log_det() - log_det - N as f64 * (N as f64).ln()
}

fn check<const N: usize>(points: &[[f64; N]]) -> Result<(), TestCaseError> {
    let answer = enclosing(points, TIGHT).expect("full rank");
    assert_contains(&answer, points);
    let total: f64 = answer.weights.iter().map(|w| w.weight).sum();
    prop_assert!((total - 1.0).abs() < 1e-12, "weights sum to {total}");
    let excess = dual_bound(points, &answer) - answer.ellipsoid.log_det();
    prop_assert!(excess <= answer.log_det_gap + 1e-12, "the weights prove {excess}, claimed {}", answer.log_det_gap);
    // Stretches of 1e6 against an offset leave a rounding of some 1e-7 at worst.
    prop_assert!(answer.log_det_gap < 1e-4, "gap {} {:?}", answer.log_det_gap, answer.status);
    prop_assert!(answer.status != Status::IterationLimit, "bounded by rounding, not by patience");
    for w in &answer.weights {
        prop_assert!(answer.contacts.contains(&w.index) || w.weight < 1e-3, "weight {} off the surface", w.weight);
    }
    Ok(())
}

/// The greatest power of two that a cloud, whose coordinates are from 1e-15 to 1e13, is scaled by.
const EXPONENT: i32 = 400;

/// All that is told of an ellipsoid, in another unit.
fn alike<const N: usize>(a: &Ellipsoid<N>, b: &Ellipsoid<N>, scale: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.center().map(|x| x * scale), b.center());
    prop_assert_eq!(a.semi_axes().map(|x| x * scale), b.semi_axes());
    prop_assert_eq!(a.axes(), b.axes());
    Ok(())
}

fn alike_enclosing<const N: usize>(a: &Enclosing<N>, b: &Enclosing<N>, scale: f64) -> Result<(), TestCaseError> {
    alike(&a.ellipsoid, &b.ellipsoid, scale)?;
    prop_assert_eq!((&a.weights, &a.contacts), (&b.weights, &b.contacts));
    prop_assert_eq!((a.log_det_gap, a.status, a.iterations, a.scans), (b.log_det_gap, b.status, b.iterations, b.scans));
    Ok(())
}

fn alike_inscribed<const N: usize>(a: &Inscribed<N>, b: &Inscribed<N>, scale: f64) -> Result<(), TestCaseError> {
    alike(&a.ellipsoid, &b.ellipsoid, scale)?;
    prop_assert_eq!(&a.weights, &b.weights);
    prop_assert_eq!((a.log_det_gap, a.status, a.iterations), (b.log_det_gap, b.status, b.iterations));
    Ok(())
}

/// The enclosing ellipsoid in two units.
fn scaled<const N: usize>(points: &[[f64; N]], exponent: i32, options: EnclosingOptions) -> Result<(), TestCaseError> {
    let scale = 2f64.powi(exponent);
    let scaled: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
    match (enclosing(points, options), enclosing(&scaled, options)) {
        (Ok(a), Ok(b)) => alike_enclosing(&a, &b, scale),
        (a, b) => {
            prop_assert_eq!(a.err(), b.err());
            Ok(())
        }
    }
}

proptest! {
    #![proptest_config(config(40))]

    /// Scaling by a power of two changes no bit of a mantissa, whatever the method and the dimension.
    #[test]
    fn powers_of_two_are_exact(
        points in cloud::<3>(),
        planar in cloud::<2>(),
        high in cloud::<6>(),
        method in 0..4usize,
        exponent in -EXPONENT..=EXPONENT,
    ) {
        use EnclosingMethod::{DualReducedNewton, EllipsoidAlgorithm, Khachiyan, Newton};
        let method = [Newton, Khachiyan, EllipsoidAlgorithm, DualReducedNewton][method];
        let options = EnclosingOptions::new().with_method(method).with_max_iterations(60);
        scaled(&planar, exponent, options)?;
        scaled(&points, exponent, options)?;
        scaled(&high, exponent, options)?;
        // Of a flat cloud the ellipsoid is within its affine hull.
        let flat: Vec<_> = points.iter().map(|&[x, y, _]| [x, y, x]).collect();
        scaled(&flat, exponent, options.with_flat(FlatPolicy::AffineHull))?;

        let scale = 2f64.powi(exponent);
        let hull = |scale: f64| {
            let points: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
            inscribed_in_hull(&points, InscribedOptions::new()).expect("full rank")
        };
        alike_inscribed(&hull(1.0), &hull(scale), scale)?;
        let room = |scale: f64| {
            let behind = |&[x, y, z]: &[f64; 3]| {
                let normal = [x - points[0][0], y - points[0][1], z];
                HalfSpace { normal, offset: scale }
            };
            let axes = (0..6).map(|k| HalfSpace {
                normal: std::array::from_fn(|i| if i == k / 2 { [1.0, -1.0][k % 2] } else { 0.0 }),
                offset: scale * 1e3,
            });
            let half_spaces: Vec<_> = points.iter().map(behind).filter(|h| h.normal != [0.0; 3]).chain(axes).collect();
            inscribed(&half_spaces, InscribedOptions::new()).expect("zero is inside")
        };
        alike_inscribed(&room(1.0), &room(scale), scale)?;
    }

    /// The same of points that come, go and move.
    #[test]
    fn powers_of_two_are_exact_of_moving_points(points in cloud::<3>(), exponent in -EXPONENT..=EXPONENT) {
        let scale = 2f64.powi(exponent);
        let moved = |scale: f64| {
            let points: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
            let mut moving = MovingPoints::new(&points, EnclosingOptions::new()).expect("finite");
            let mut answers = vec![moving.enclosing().expect("full rank").clone()];
            moving.update(0, points[0].map(|x| x * 1.25)).expect("finite");
            answers.push(moving.enclosing().expect("full rank").clone());
            moving.insert(points[1].map(|x| x * 1.5)).expect("finite");
            moving.remove(2);
            answers.push(moving.enclosing().expect("full rank").clone());
            answers
        };
        for (a, b) in moved(1.0).iter().zip(&moved(scale)) {
            alike_enclosing(a, b, scale)?;
        }
    }
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn enclosing_contains_and_certifies_in_2d(points in cloud::<2>()) {
        check(&points)?;
    }

    #[test]
    fn enclosing_contains_and_certifies_in_3d(points in cloud::<3>()) {
        check(&points)?;
    }

    #[test]
    fn enclosing_contains_and_certifies_in_6d(points in cloud::<6>()) {
        check(&points)?;
    }

    /// The order of the points does not matter beyond rounding.
    #[test]
    fn order_does_not_matter(points in cloud::<3>(), seed: u64) {
        let mut shuffled = points.clone();
        let mut rng = Rng(seed);
        for i in (1..shuffled.len()).rev() {
            shuffled.swap(i, (rng.next() % (i as u64 + 1)) as usize);
        }
        let (a, b) = (enclosing(&points, TIGHT).expect("full rank"), enclosing(&shuffled, TIGHT).expect("full rank"));
        let allowed = a.log_det_gap.max(b.log_det_gap) + 1e-12;
        prop_assert!((a.ellipsoid.log_det() - b.ellipsoid.log_det()).abs() <= allowed, "{} {}", a.ellipsoid.log_det(), b.ellipsoid.log_det());
    }

    /// All methods agree within their certified gaps.
    #[test]
    fn methods_agree(points in cloud::<2>()) {
        let newton = enclosing(&points, TIGHT).expect("full rank");
        for (method, epsilon) in [
            (EnclosingMethod::DualReducedNewton, 1e-10),
            (EnclosingMethod::Khachiyan, 1e-3),
            (EnclosingMethod::EllipsoidAlgorithm, 1e-4),
        ] {
            let options = EnclosingOptions::new().with_method(method).with_epsilon(epsilon).with_max_iterations(20_000);
            let other = enclosing(&points, options).expect("full rank");
            assert_contains(&other, &points);
            let (a, b) = (newton.ellipsoid.log_det(), other.ellipsoid.log_det());
            prop_assert!(a - b <= other.log_det_gap + 1e-12, "{method:?}: {a} is beyond the bound of {b} by {}", other.log_det_gap);
            prop_assert!(b - a <= newton.log_det_gap + 1e-12, "{method:?}: better than optimal, {b} against {a}");
        }
    }

    /// John: the enclosing ellipsoid shrunk by N lies in the hull, the inscribed grown by N holds it.
    #[test]
    fn inner_and_outer_are_within_a_factor_n(points in cloud::<3>()) {
        let outer = enclosing(&points, TIGHT).expect("full rank").ellipsoid;
        let inner = inscribed_in_hull(&points, InscribedOptions::new()).expect("full rank");
        prop_assert!(inner.log_det_gap < 1e-3, "gap {} {:?}", inner.log_det_gap, inner.status);
        let tightness = inner.ellipsoid.tightness(&outer);
        prop_assert!((1.0 / 3.0 - 1e-6..=1.0 + 1e-9).contains(&tightness), "tightness {tightness}");
        // The inscribed ellipsoid is at least as large as the enclosing one shrunk by N.
        for &p in &points {
            prop_assert!(inner.ellipsoid.radius_at(p) <= 3.0 * (1.0 + 1e-3), "radius {}", inner.ellipsoid.radius_at(p));
        }
        // Every direction: the support of the inner ellipsoid is at most that of the points.
        for axis in inner.ellipsoid.axes() {
            for sign in [1.0, -1.0] {
                let support = |p: [f64; 3]| (0..3).map(|k| sign * axis[k] * p[k]).sum::<f64>();
                let furthest = points.iter().map(|&p| support(p)).fold(f64::NEG_INFINITY, f64::max);
                let reach: f64 = (0..3)
                    .map(|j| {
                        let direction = inner.ellipsoid.axes()[j];
                        let along: f64 = (0..3).map(|k| direction[k] * axis[k]).sum();
                        (along * inner.ellipsoid.semi_axes()[j]).powi(2)
                    })
                    .sum::<f64>()
                    .sqrt();
                let size = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
                prop_assert!(support(inner.ellipsoid.center()) + reach <= furthest + 1e-13 * size, "pokes out");
            }
        }
    }

    /// John: the enclosing ellipsoid shrunk by N about its centre lies in the hull; by √N where the points are
    /// symmetric.
    ///
    /// It does where along the normal of every facet it reaches no further than the points. Every plane through three
    /// points is tried: the facets are among them.
    #[test]
    fn shrunk_it_lies_in_the_hull(points in cloud::<3>(), symmetric: bool) {
        // The last four are a simplex.
        let middle = 10.min(points.len() - 4)..points.len() - 4;
        let mut points = points;
        points.drain(middle);
        if symmetric {
            let mirrored: Vec<_> = points.iter().map(|p| p.map(|x| -x)).collect();
            points.extend(mirrored);
        }
        let answer = enclosing(&points, TIGHT).expect("full rank");
        let e = &answer.ellipsoid;
        let shrink = if symmetric { 3f64.sqrt() } else { 3.0 };
        // In the coordinates in which the ellipsoid is the unit ball, where thin clouds lose nothing.
        let images: Vec<[f64; 3]> = points
            .iter()
            .map(|p| {
                let turned = apply(&e.axes(), std::array::from_fn(|k| p[k] - e.center()[k]));
                std::array::from_fn(|k| turned[k] / e.semi_axes()[k])
            })
            .collect();
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let mut least = f64::INFINITY;
        for i in 0..images.len() {
            for j in 0..i {
                for k in 0..j {
                    let [a, b]: [[f64; 3]; 2] = [i, j].map(|at| std::array::from_fn(|l| images[at][l] - images[k][l]));
                    let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                    let length = dot(normal, normal).sqrt();
                    if length < 1e-9 {
                        continue;
                    }
                    for sign in [1.0, -1.0] {
                        let reach = images.iter().map(|&y| sign * dot(normal, y) / length).fold(f64::MIN, f64::max);
                        least = least.min(reach);
                    }
                }
            }
        }
        let slack = 1e-9 + answer.log_det_gap.sqrt();
        prop_assert!(least >= 1.0 / shrink - slack, "a facet at {least}, the shrunk ball at {}", 1.0 / shrink);
    }

    /// Whatever half-spaces: what is inscribed keeps within every one as given, evaluated in `f64`.
    #[test]
    fn inscribed_stays_within_as_evaluated(rows in prop::collection::vec((prop::array::uniform3(-1.0..1.0f64), -6.0..6.0f64, 0.1..2.0f64), 4..40), shift in prop::array::uniform3(-1e6..1e6f64)) {
        let mut halfspaces: Vec<HalfSpace<3>> = rows
            .into_iter()
            .map(|(normal, scale, room)| {
                let normal = normal.map(|x| x * 10f64.powf(scale));
                let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
                let at: f64 = normal.iter().zip(shift).map(|(x, s)| x * s).sum();
                HalfSpace { normal, offset: at + room * length }
            })
            .filter(|h| h.normal != [0.0; 3])
            .collect();
        for k in 0..3 {
            for sign in [1.0, -1.0] {
                let normal = std::array::from_fn(|l| if k == l { sign } else { 0.0 });
                halfspaces.push(HalfSpace { normal, offset: sign * shift[k] + 1.0 });
            }
        }
        let answer = inscribed(&halfspaces, InscribedOptions::new()).expect("a body around the shift");
        for h in &halfspaces {
            let reach = answer.ellipsoid.support_value(h.normal);
            prop_assert!(reach <= h.offset, "reaches {reach} in {h:?}");
        }
        prop_assert!(answer.log_det_gap < 1e-6, "gap {}", answer.log_det_gap);
    }

    /// Nothing finite panics or hangs, nothing non-finite is accepted.
    #[test]
    fn any_bits_are_answered(bits in prop::collection::vec(prop::array::uniform2(any::<u64>()), 0..12)) {
        let points: Vec<[f64; 2]> = bits.iter().map(|p| p.map(f64::from_bits)).collect();
        let finite = points.iter().flatten().all(|x| x.is_finite());
        for method in [EnclosingMethod::Newton, EnclosingMethod::Khachiyan, EnclosingMethod::DualReducedNewton, EnclosingMethod::EllipsoidAlgorithm] {
            let options = EnclosingOptions::new().with_method(method).with_max_iterations(300);
            if let Ok(answer) = enclosing(&points, options) {
                prop_assert!(finite, "accepted a number that is not finite");
                prop_assert!(answer.ellipsoid.log_det().is_finite(), "ln det {}", answer.ellipsoid.log_det());
                prop_assert!(points.iter().all(|&p| answer.ellipsoid.contains(p)), "a point is outside");
            }
        }
        if let Ok(answer) = inscribed_in_hull(&points, InscribedOptions::new()) {
            prop_assert!(finite, "accepted a number that is not finite");
            prop_assert!(answer.ellipsoid.log_det().is_finite(), "ln det {}", answer.ellipsoid.log_det());
        }
    }
}

/// The answer ends where Newton's method does, not where the gap asked for was first reached.
#[test]
fn a_loose_epsilon_ends_near_rounding() {
    for seed in 0..20 {
        let points = Rng(seed).normals::<3>(300);
        let loose = enclosing(&points, EnclosingOptions::new().with_epsilon(1e-7)).expect("full rank").ellipsoid;
        let tight = enclosing(&points, EnclosingOptions::new().with_epsilon(1e-13)).expect("full rank").ellipsoid;
        assert!((loose.log_det() - tight.log_det()).abs() <= 2e-13, "enclosing, seed {seed}");

        let loose =
            inscribed_in_hull(&points, InscribedOptions::new().with_epsilon(1e-7)).expect("full rank").ellipsoid;
        let tight =
            inscribed_in_hull(&points, InscribedOptions::new().with_epsilon(1e-13)).expect("full rank").ellipsoid;
        assert!((loose.log_det() - tight.log_det()).abs() <= 2e-13, "inscribed, seed {seed}");
    }
}
