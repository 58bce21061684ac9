//! Batches: what one pair at a time gives, for less.

use crate::common::{close, ellipsoid2, ellipsoid3};
use convex_support::glam::{DVec3, Vec3};
use convex_support::{Ellipsoid, Matrix, Scalar, Vector};
use ellip_margin::{
    InvalidQuery, MarginOptions, Method, free_margin, free_margins, free_margins_into, map_margins, map_margins_into,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree;

/// Margins to 1e-14 of 1 + m and the last two digits of m, ν to 1e-12: rounding, since both paths end at the root by
/// other steps, and m is rounded where it is near −1.
fn assert_same<V: Vector>(e1: &[Ellipsoid<V>], e2: &[Ellipsoid<V>], options: MarginOptions) {
    let margins = free_margins(e1, e2, options).expect("lists of one length");
    assert_eq!(margins.len(), e1.len().max(e2.len()), "one margin per pair");
    let coarse = V::Scalar::EPSILON.as_f64();
    for (k, batch) in margins.iter().enumerate() {
        let one = free_margin(&e1[k.min(e1.len() - 1)], &e2[k.min(e2.len() - 1)], options);
        let (a, b) = (1.0 + batch.margin.as_f64(), 1.0 + one.margin.as_f64());
        assert!(close(a, b, 1e-14 + coarse, 2.0 * coarse), "pair {k}: {batch:?} {one:?}");
        assert!(close(batch.nu.as_f64(), one.nu.as_f64(), 1e-12 + coarse, 0.0), "pair {k}: {batch:?} {one:?}");
        assert_eq!(batch.margin > V::Scalar::ZERO, one.margin > V::Scalar::ZERO, "pair {k}: the sign");
        assert_eq!(batch.status, one.status, "pair {k}");
    }
}

proptest! {
    #![proptest_config(convex_support::laws::config(60))]

    #[test]
    fn in_space(pairs in prop::collection::vec((ellipsoid3(4.0, 2.0), ellipsoid3(4.0, 2.0)), 0..40)) {
        let (e1, e2): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
        assert_same(&e1, &e2, MarginOptions::default());
        assert_same(&e1, &e2, MarginOptions::default().with_method(Method::SingularBasis));
        assert_same(&e1, &e2, MarginOptions::default().with_max_iterations(3).with_tolerance(1e-6).expect("positive"));
        let single = |e: &Ellipsoid<DVec3>| {
            let axes = Matrix::from_cols_fn(|j| Vector::from_fn(|i| e.axes().col(j)[i] as f32));
            Ellipsoid::from_axes(e.center().as_vec3(), e.semi_axes().as_vec3(), axes).expect("in range")
        };
        let (f1, f2): (Vec<Ellipsoid<Vec3>>, Vec<_>) = (e1.iter().map(single).collect(), e2.iter().map(single).collect());
        assert_same(&f1, &f2, MarginOptions::default());
    }

    #[test]
    fn one_against_many(e1 in ellipsoid2(1.0, 2.0), e2 in prop::collection::vec(ellipsoid2(1.0, 2.0), 1..40)) {
        assert_same(&[e1], &e2, MarginOptions::default());
        assert_same(&e2, &[e1], MarginOptions::default());
    }
}

/// Most pairs of ordinary shapes must take the fast path: its iterations are a fixed number.
#[test]
fn most_pairs_stay_in_their_lanes() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let strategy = prop::collection::vec((ellipsoid3(1.0, 2.0), ellipsoid3(1.0, 2.0)), 800);
    let pairs = strategy.new_tree(&mut runner).expect("samples").current();
    let (e1, e2): (Vec<_>, Vec<_>) =
        pairs.into_iter().filter(|(a, b)| (a.center() - b.center()).length() > 1.5).unzip();
    let margins = free_margins(&e1, &e2, MarginOptions::default()).expect("lists of one length");
    let quick = margins.iter().filter(|m| m.iterations == 5).count();
    assert!(10 * quick > 7 * margins.len(), "{quick} of {}", margins.len());
}

#[test]
fn lists_of_other_lengths() {
    let e = Ellipsoid::new(DVec3::ZERO, DVec3::ONE, Default::default()).expect("valid");
    let mut margins = Vec::new();
    let error = free_margins_into(&[e, e], &[e, e, e], MarginOptions::default(), &mut margins);
    assert_eq!(error, Err(InvalidQuery::LengthsDiffer { first: 2, second: 3 }), "two and three");
    assert!(margins.is_empty(), "nothing is appended");
    assert_eq!(free_margins::<DVec3>(&[], &[e], MarginOptions::default()).expect("none").len(), 0, "of none, none");
}

#[test]
fn a_column_of_margins_is_the_list_of_them() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let strategy = prop::collection::vec((ellipsoid3(4.0, 2.0), ellipsoid3(4.0, 2.0)), 2500);
    let (e1, e2): (Vec<_>, Vec<_>) = strategy.new_tree(&mut runner).expect("samples").current().into_iter().unzip();
    let options = MarginOptions::default();
    for count in [0, 1, 7, 8, 9, 2500] {
        let (e1, e2) = (&e1[..count], &e2[..count]);
        let mut column = vec![(f64::NAN, DVec3::NAN); count];
        map_margins_into(e1, e2, options, &mut column, |m| (m.margin, m.gradient().translation))
            .expect("of one length");
        let list = map_margins(e1, e2, options, |m| (m.margin, m.gradient().translation)).expect("of one length");
        assert_eq!(column, list, "{count} pairs");
    }
    let mut short = [0.0; 2];
    let error = map_margins_into(&e1[..1], &e2[..3], options, &mut short, |m| m.margin);
    assert_eq!(error, Err(InvalidQuery::AnswersLength { pairs: 3, answers: 2 }), "two answers for three pairs");
    assert_eq!(short, [0.0; 2], "no answer is written");
}
