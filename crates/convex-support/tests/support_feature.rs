//! Features of shapes: vertices, edges and faces within a slab.

use convex_support::strategies::{AnyShape, direction, primitive_3d};
use convex_support::{
    Affine, Ball, Cuboid, Cylinder, Feature, Hint, Polytope, Posed, Rounded, SupportMap, Vector, glam,
};
use glam::{DMat2, DMat3, DQuat, DVec2, DVec3};
use proptest::prelude::*;

fn feature<S: SupportMap>(shape: &S, direction: S::Vector, slab: f64) -> Feature<S::Vector>
where
    S::Vector: Vector<Scalar = f64>,
{
    let mut feature = Feature::new();
    shape.core_support_feature(direction, slab, &mut feature);
    feature
}

#[test]
fn a_box_shows_a_face_an_edge_or_a_vertex() {
    let cuboid = Cuboid::new(DVec3::new(1.0, 2.0, 3.0)).expect("positive half extents");
    let count = |direction: DVec3| feature(&cuboid, direction.normalize(), 0.01).points().len();
    assert_eq!(count(DVec3::Y), 4);
    assert_eq!(count(DVec3::new(1.0, 1.0, 0.0)), 2);
    assert_eq!(count(DVec3::ONE), 1);
    // The same through a pose and a rounding, with the same numbers.
    let turn = DQuat::from_rotation_x(0.3);
    let posed = Posed::new(Rounded::new(cuboid, 0.5).expect("a radius"), turn, DVec3::ONE).expect("a pose");
    let (there, here) = (feature(&posed, turn * DVec3::Y, 0.01), feature(&cuboid, DVec3::Y, 0.01));
    assert_eq!(there.ids(), here.ids());
    for (p, q) in there.points().iter().zip(here.points()) {
        assert!((*p - turn * *q).length() < 1e-15, "{p} {q}");
    }
}

#[test]
fn a_cylinder_shows_a_disc_a_side_or_a_rim() {
    let cylinder = Cylinder::<DVec3>::new(1.0, 0.5).expect("positive sizes");
    assert_eq!(feature(&cylinder, DVec3::NEG_Y, 0.01).points().len(), 8);
    assert_eq!(feature(&cylinder, DVec3::X, 0.01).points(), [DVec3::new(0.5, 1.0, 0.0), DVec3::new(0.5, -1.0, 0.0)]);
    assert_eq!(feature(&cylinder, DVec3::new(0.6, 0.8, 0.0), 0.01).points(), [DVec3::new(0.5, 1.0, 0.0)]);
}

#[test]
fn a_disc_says_its_rim_and_a_large_face_that_points_are_left_out() {
    let cylinder = Cylinder::<DVec3>::new(1.0, 0.5).expect("positive sizes");
    let turn = DQuat::from_rotation_x(0.3);
    let posed = Posed::new(cylinder, turn, DVec3::ONE).expect("a pose");
    let disc = feature(&posed, turn * DVec3::NEG_Y, 0.01);
    let rim = disc.rim().expect("a disc");
    assert!((rim.center - turn * DVec3::NEG_Y).length() < 1e-15, "{rim:?}");
    let [p, q] = rim.ends.map(|end| end - rim.center);
    assert!(p.dot(q).abs() < 1e-15 && (p.length() - 0.5).abs() < 1e-15 && (q.length() - 0.5).abs() < 1e-15, "{rim:?}");
    assert!(disc.is_complete() && feature(&cylinder, DVec3::X, 0.01).rim().is_none());
    // A prism of many sides.
    let prism = |sides: u32| {
        let corner = |i: u32| DVec3::Y.cross(DQuat::from_rotation_y(f64::from(i)) * DVec3::X);
        let corners = (0..sides).flat_map(|i| [corner(i), corner(i) + DVec3::Y]);
        Polytope::new(corners.collect::<Vec<_>>()).expect("finite points")
    };
    assert!(feature(&prism(16), DVec3::Y, 0.01).is_complete());
    assert!(!feature(&prism(17), DVec3::Y, 0.01).is_complete());
}

fn any_solid() -> BoxedStrategy<AnyShape<DVec3>> {
    primitive_3d(1.0)
}

proptest! {
    #![proptest_config(convex_support::laws::config(256))]

    #[test]
    fn features_are_near_the_supporting_plane(shape in any_solid(), d in direction::<DVec3>(), slab in 0.0..0.5) {
        let n = d.normalize();
        let height = n.dot(shape.core_support(n, &mut Hint::new()));
        let feature = feature(&shape, n, slab);
        prop_assert!(!feature.points().is_empty(), "there is always a support point");
        for point in feature.points() {
            let level = n.dot(*point);
            prop_assert!(level <= height + 1e-14 && level >= height - slab - 1e-14, "{level} of {height}");
        }
    }
}

/// Of a hull they are found along its edges, of mere points by a look at all of them.
#[test]
fn a_hull_shows_what_its_points_do() {
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut shown = [0; 18];
    for round in 0..60 {
        let ball: Vec<DVec3> =
            (0..200).map(|_| DVec3::from_array([(); 3].map(|()| number())).normalize_or_zero()).collect();
        let points: Vec<DVec3> = match round % 4 {
            0 => ball,
            // Needles and plates.
            1 => ball.into_iter().map(|p| p * DVec3::new(1.0, 1e-3, 1e-6)).collect(),
            // Faces of many corners, and corners in a row along edges.
            2 => (0..120)
                .map(|i| DVec3::new(f64::from(i % 2), (f64::from(i / 2) * 0.1).cos(), (f64::from(i / 2) * 0.1).sin()))
                .collect(),
            _ => (0..125).map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5 % 5), f64::from(i / 25))).collect(),
        };
        let hull = Polytope::hull_of(points).expect("a body");
        let all = Polytope::new(hull.points().to_vec()).expect("finite points");
        for k in 0..60 {
            let direction = match k % 3 {
                0 => DVec3::AXES[k / 3 % 3] * (1.0 - 2.0 * f64::from(u32::from(k > 30))),
                1 => DVec3::from_array([(); 3].map(|()| number())),
                _ => DVec3::from_array([number(), 1e-9 * number(), 0.0]),
            };
            for slab in [0.0, 1e-15, 1e-9, 0.02, 0.3] {
                let (along_edges, looked_at) = (feature(&hull, direction, slab), feature(&all, direction, slab));
                assert_eq!(along_edges, looked_at, "round {round}, along {direction}, {slab}");
                shown[along_edges.points().len().min(17)] += 1;
            }
        }
    }
    assert!(shown[1] > 100 && shown[3..].iter().sum::<usize>() > 1000, "no fair sample: {shown:?}");
}

/// A singular matrix makes a segment or a disc of a ball. Along a direction across it the support point is any of its
/// points, and the feature is all of it; along others it is an end, or a point of the rim.
#[test]
fn a_flat_image_of_a_ball_shows_all_of_it() {
    let image = |sizes: [f64; 3], direction: DVec3| {
        let matrix = DMat3::from_diagonal(DVec3::from_array(sizes)) * DMat3::from_rotation_z(0.3);
        let ball = Ball::<DVec3>::new(0.5).expect("positive");
        feature(&Affine::new(ball, matrix, DVec3::Y).expect("finite"), direction, 1e-12)
    };
    let mut ends = image([4.0, 0.0, 0.0], DVec3::Y).points().to_vec();
    ends.sort_by(|p, q| p.x.total_cmp(&q.x));
    assert_eq!(ends.len(), 2, "{ends:?}");
    assert!(ends[0].distance(DVec3::X * -2.0) < 1e-15 && ends[1].distance(DVec3::X * 2.0) < 1e-15, "{ends:?}");
    // What is left of the second column without the first is rounding.
    let steep = DMat2::from_cols(DVec2::ONE, DVec2::splat(2.0));
    let steep = Affine::new(Ball::<DVec2>::new(0.5).expect("positive"), steep, DVec2::ZERO).expect("finite");
    let ends = feature(&steep, DVec2::new(1.0, -1.0), 1e-12);
    let end = DVec2::splat(0.5 * 5_f64.sqrt());
    assert!(ends.points().len() == 2 && ends.points().iter().all(|p| p.abs().distance(end) < 1e-15), "{ends:?}");
    let disc = image([4.0, 0.0, 2.0], DVec3::Y);
    let rim = disc.rim().expect("a disc");
    let is_on = |p: DVec3| ((p.x / 2.0).hypot(p.z) - 1.0).abs() < 1e-15 && p.y == 0.0;
    assert!(disc.is_complete() && disc.points().len() == 8, "{disc:?}");
    assert!(
        rim.center == DVec3::ZERO && rim.ends.into_iter().chain(disc.points().iter().copied()).all(is_on),
        "{disc:?}"
    );
    for direction in [DVec3::ONE, DVec3::X] {
        assert_eq!(image([4.0, 0.0, 0.0], direction).points().len(), 1);
        assert_eq!(image([4.0, 0.0, 2.0], direction).points().len(), 1);
    }
}
