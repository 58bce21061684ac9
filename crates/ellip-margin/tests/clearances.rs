//! `Clearance` is brute force, to the last bit, for less.

use crate::common::{ellipsoid2, ellipsoid3};
use convex_support::glam::{DQuat, DVec2, DVec3, Vec3};
use convex_support::{Ellipsoid, Scalar, Vector};
use ellip_margin::{Clearance, InvalidQuery, MarginOptions, clearance};
use proptest::prelude::*;

fn assert_same<V: Vector>(scene: &mut Clearance<V>, links: &[Ellipsoid<V>]) {
    let quick = scene.step(links).expect("there are links");
    let brute = clearance(links, scene.obstacles(), MarginOptions::default()).expect("there are links");
    assert_eq!(
        (quick.margin, quick.link, quick.obstacle),
        (brute.margin, brute.link, brute.obstacle),
        "as brute force"
    );
    let pairs = links.len() * scene.obstacles().len();
    assert_eq!(quick.pairs_evaluated + quick.left_out.total(), pairs, "each pair once: {quick:?}");

    let threshold = quick.margin.margin + V::Scalar::from_f64(0.5);
    let mut near: Vec<_> =
        scene.within(links, threshold).expect("a number").iter().map(|p| (p.link, p.obstacle)).collect();
    near.sort_unstable();
    let all = (0..links.len()).flat_map(|l| (0..scene.obstacles().len()).map(move |o| (l, o)));
    let expected: Vec<_> = all
        .filter(|&(l, o)| {
            ellip_margin::free_margin(&links[l], &scene.obstacles()[o], MarginOptions::default()).margin <= threshold
        })
        .collect();
    assert_eq!(near, expected, "all within {threshold}");
}

proptest! {
    #![proptest_config(convex_support::laws::config(60))]

    #[test]
    fn in_space(
        links in prop::collection::vec(ellipsoid3(1.0, 2.0), 1..6),
        obstacles in prop::collection::vec(ellipsoid3(1.5, 4.0), 1..60),
        by in crate::common::within(0.2),
    ) {
        let mut scene = Clearance::new(&obstacles, MarginOptions::default()).expect("not empty");
        for step in 0..12 {
            let t = f64::from(step);
            let turn = DQuat::from_rotation_x(0.02 * t);
            let moved: Vec<_> = links.iter().map(|e| e.posed(turn, by * t).expect("finite")).collect();
            if step % 4 == 3 {
                let drifted: Vec<_> = obstacles.iter().map(|e| e.posed(turn, by * -0.5 * t).expect("finite")).collect();
                scene.move_obstacles(&drifted).expect("as many");
            }
            assert_same(&mut scene, &moved);
        }
        // Fewer links, other links, a jump.
        assert_same(&mut scene, &links[..1]);
        let jumped: Vec<_> = links.iter().map(|e| e.posed(DQuat::from_rotation_z(1.6), DVec3::splat(1.0)).expect("finite")).collect();
        assert_same(&mut scene, &jumped);
    }

    #[test]
    fn in_the_plane(links in prop::collection::vec(ellipsoid2(1.0, 2.0), 1..4), obstacles in prop::collection::vec(ellipsoid2(2.0, 3.0), 1..40)) {
        let mut scene = Clearance::new(&obstacles, MarginOptions::default()).expect("not empty");
        for step in 0..5 {
            let moved: Vec<_> = links.iter().map(|e| e.posed(0.05 * f64::from(step), DVec2::X * 0.1).expect("finite")).collect();
            assert_same(&mut scene, &moved);
        }
    }
}

/// Equal margins, as on a lattice, go to the first pair, in single precision too; and overlapping centres tie at −1.
#[test]
fn ties() {
    let lattice: Vec<_> = (0..125)
        .map(|i| {
            let center = Vec3::new((i % 5) as f32, (i / 5 % 5) as f32, (i / 25) as f32);
            Ellipsoid::new(center, Vec3::splat(0.2), Default::default()).expect("valid")
        })
        .collect();
    let mut scene = Clearance::new(&lattice, MarginOptions::default()).expect("not empty");
    for center in [[1.5, 2.5, 2.5], [2.0, 2.0, 2.0], [2.5, 2.0, 2.0]] {
        let link =
            |r: f32| Ellipsoid::new(Vec3::from_array(center), Vec3::splat(r), Default::default()).expect("valid");
        for links in [vec![link(0.1)], vec![link(0.1), link(0.1)], vec![link(3.0), link(0.1)]] {
            assert_same(&mut scene, &links);
        }
    }
    let wide: Vec<_> = lattice
        .iter()
        .map(|e| Ellipsoid::new(e.center(), Vec3::splat(2.0), Default::default()).expect("valid"))
        .collect();
    scene.move_obstacles(&wide).expect("as many");
    let link = Ellipsoid::new(Vec3::splat(2.2), Vec3::splat(0.1), Default::default()).expect("valid");
    assert_same(&mut scene, &[link, link]);
}

#[test]
fn empty_lists_and_other_counts() {
    let e = Ellipsoid::new(DVec2::ZERO, DVec2::ONE, 0.0).expect("valid");
    let o = MarginOptions::default();
    assert_eq!(clearance(&[], &[e], o).err(), Some(InvalidQuery::NoLinks), "no links");
    assert_eq!(clearance(&[e], &[], o).err(), Some(InvalidQuery::NoObstacles), "no obstacles");
    assert_eq!(Clearance::<DVec2>::new(&[], o).err(), Some(InvalidQuery::NoObstacles), "no obstacles");
    let mut scene = Clearance::new(&[e], o).expect("not empty");
    assert_eq!(scene.within(&[e], f64::NAN).err(), Some(InvalidQuery::ThresholdNotANumber), "NaN");
    assert_eq!(scene.step(&[]).err(), Some(InvalidQuery::NoLinks), "no links");
    let error = scene.move_obstacles(&[e, e]).expect_err("one more than before");
    assert_eq!(error, InvalidQuery::CountChanged { list: "obstacles", before: 1, now: 2 }, "the counts");
    assert_eq!(error.to_string(), "the number of obstacles must stay the same along a motion, but it went from 1 to 2");
}
