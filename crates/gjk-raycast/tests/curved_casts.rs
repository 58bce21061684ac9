//! Casts at curved bodies that once stalled, or ended with a point that was not on the surface.

use crate::common::behind_pointers::{linear_cast, ray_cast};
use convex_support::glam::{DQuat, DVec3, Vec3A};
use convex_support::{Cone, Cuboid, Cylinder, Ellipsoid, Posed, SupportMap, support_value};
use gjk_raycast::{Iterate, LinearCastOptions, Motion, Ray, RayCastOptions, Status, WarmStart, linear_cast_with};

const VALID: &str = "valid numbers";

/// The first hit of a ray whose search must end by itself.
fn hit(target: &impl SupportMap<Vector = DVec3>, source: DVec3, direction: DVec3, axis: Option<DVec3>) -> f64 {
    let options = RayCastOptions::new().with_warm_start(axis.map(WarmStart::new));
    let cast = ray_cast(target, Ray { source, direction }, options).expect("a finite ray");
    assert_eq!(cast.status, Status::Converged, "{cast:?}");
    cast.outcome.hit().expect("a hit").lambda
}

/// A unit ball that tells nothing but its support points.
struct UnitBall;

impl SupportMap for UnitBall {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        direction.normalize_or_zero()
    }
}

#[test]
fn a_support_map_without_a_derivative_converges() {
    let source = DVec3::new(2.166_167_607_521_591, 1.538_706_565_958_625_6, 2.99);
    let direction = DVec3::new(-2.271_812_979_490_743_3, -0.971_445_365_543_760_7, -3.513_987_189_664_789);
    let found = hit(&UnitBall, source, direction, None);
    let (a, b, c) = (direction.length_squared(), source.dot(direction), source.length_squared() - 1.0);
    assert!((found - (-b - (b * b - a * c).sqrt()) / a).abs() < 1e-13, "{found}");
}

#[test]
fn the_top_of_a_cylinder_is_found_cold() {
    let cylinder = Cylinder::<DVec3>::new(0.5, 0.25).expect(VALID);
    let found = hit(&cylinder, DVec3::new(0.3, 0.2, 5.0), DVec3::new(-0.3, -0.466_666_666_666_666_73, -5.0), None);
    assert!((found - 0.950_089_757_726_711).abs() < 1e-14, "{found}");
}

#[test]
fn an_axis_with_a_tiny_component_starts_as_well_as_any() {
    let turn = DQuat::from_rotation_y(5.0);
    let center = DVec3::new(4.244_329_615_003_198, 0.0, -4.240_951_086_632_196);
    let ellipsoid = Ellipsoid::new(center, DVec3::new(0.8, 1.2, 0.2), turn).expect(VALID);
    let direction = DQuat::from_rotation_y(112.0 * core::f64::consts::TAU / 900.0) * DVec3::new(1.0, 0.0, 1e-3);
    let cold = hit(&ellipsoid, DVec3::ZERO, direction, None);
    let axis = DVec3::new(-0.941_182_989_935_370_4, -2.563_797_941_968_295_7e-30, 0.337_897_291_282_893_25);
    let warm = hit(&ellipsoid, DVec3::ZERO, direction, Some(axis));
    assert!((cold - 5.762_875_768_883_107).abs() < 1e-13 && (warm - cold).abs() < 1e-13, "{cold}, {warm}");
}

/// How far the point of contact is from the surface of either shape, seen along the normal, and beyond either.
fn off<A: SupportMap<Vector = DVec3>, B: SupportMap<Vector = DVec3>>(a: &A, b: &B, velocity: DVec3) -> f64 {
    let motion = Motion { velocity_a: velocity, velocity_b: DVec3::ZERO };
    let cast = linear_cast(a, b, motion, LinearCastOptions::default()).expect("a finite motion");
    assert_eq!(cast.status, Status::Converged, "{cast:?}");
    let hit = cast.outcome.hit().expect("they meet");
    let normal = hit.normal.expect("not at the start");
    let then = hit.point - velocity * hit.time;
    let mut worst = 0.0_f64;
    for n in [normal, -normal, DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
        worst = worst.max(n.dot(then) - support_value(&a, n)).max(n.dot(hit.point) - support_value(&b, n));
    }
    let (on_a, on_b) =
        (support_value(&a, -normal) + normal.dot(then), support_value(&b, normal) - normal.dot(hit.point));
    worst.max(on_a.abs()).max(on_b.abs())
}

#[test]
fn the_point_of_contact_of_a_cone_and_a_cuboid_is_on_both() {
    let turn = |q: [f64; 4]| DQuat::from_array(q);
    let a = Posed::new(
        Cone::<DVec3>::new(0.75, 0.625).expect(VALID),
        turn([-0.221_874_544_939_686_92, 0.564_004_624_061_630_9, -0.790_277_916_601_447_1, 0.090_173_637_372_470_07]),
        DVec3::new(-2.380_667_890_933_938, 6.202_247_997_459_124, 6.242_014_428_842_903),
    );
    let b = Posed::new(
        Cuboid::new(DVec3::new(1.0, 0.5, 0.25)).expect(VALID),
        turn([-0.481_464_082_024_079_86, 0.821_215_712_341_951_5, 0.035_051_882_606_993_42, -0.304_250_648_395_556_93]),
        DVec3::new(0.663_193_886_914_437_4, -0.644_612_340_909_985_6, -0.380_327_225_301_935),
    );
    let velocity = DVec3::new(80.592_997_397_252_96, -143.747_227_985_784_38, -135.010_449_161_670_58);
    let off = off(&a.expect(VALID), &b.expect(VALID), velocity);
    assert!(off < 1e-12, "{off:e}");
}

#[test]
fn the_point_of_contact_of_ellipsoids_is_on_both() {
    let ellipsoid = |center: [f64; 3], q: [f64; 4]| {
        Ellipsoid::new(DVec3::from_array(center), DVec3::new(1e4, 5e3, 1e3), DQuat::from_array(q)).expect(VALID)
    };
    let a = ellipsoid(
        [-10_366.980_446_355_56, -17_776.877_451_074_524, 15_457.909_293_412_95],
        [0.897_055_257_800_735_9, -0.368_209_105_220_714_6, 0.004_999_592_672_272_545_5, 0.244_283_021_500_714_5],
    );
    let b = ellipsoid(
        [4_469.560_269_475_641, 6_555.408_866_761_782_5, 6_086.842_004_447_448],
        [0.104_476_140_494_831_12, 0.522_275_573_887_154_1, 0.785_104_648_505_992_5, 0.316_107_025_993_460_4],
    );
    let velocity = DVec3::new(241.840_019_974_292_98, 501.767_319_244_948_06, -203.510_002_093_202_23);
    let off = off(&a, &b, velocity);
    assert!(off < 1e-9, "{off:e}");
}

/// A cone that moves by `velocity` towards a cylinder and touches it at `time`: how many support points the search
/// took, and whether the contact is certain. What is asked once more of an edge that is met within an error is not
/// counted.
fn cylinder_and_cone(turn: [f64; 4], place: [f64; 3], velocity: [f64; 3], time: f64) -> (usize, bool) {
    let cylinder = Cylinder::<DVec3>::new(0.75, 0.5).expect(VALID);
    let cone = Cone::<DVec3>::new(0.75, 0.625).expect(VALID);
    let cone = Posed::new(cone, DQuat::from_array(turn), DVec3::from_array(place)).expect(VALID);
    let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: DVec3::from_array(velocity) };
    let mut searched = 0;
    let shapes: [&dyn SupportMap<Vector = DVec3>; 2] = [&cylinder, &cone];
    let count = |_: Iterate<'_, DVec3>| searched += 1;
    let cast = linear_cast_with(shapes[0], shapes[1], motion, LinearCastOptions::default(), count);
    let cast = cast.expect("a finite motion");
    assert!(cast.status != Status::Converged || cast.is_certain(), "{cast:?}");
    assert!(cast.lower <= time + 1e-14 && cast.upper >= time - 1e-14, "{cast:?} is not about {time}");
    let found = cast.outcome.hit().expect("they meet").time;
    assert!((found - time).abs() < 1e-12, "{found}, not {time}");
    (searched, cast.is_certain())
}

/// An edge meets an edge, and leaves it again at once: seen along the ray, the line runs through the outline of the
/// obstacle, where no triangle of points encloses it. The search of GJK that took over stalled at 0.542, before the
/// contact. The edge is found by the curvature of the piece, which there is of rank one.
#[test]
fn an_edge_that_only_grazes_is_met_where_it_is() {
    cylinder_and_cone(
        [-0.788_054_440_625_669_3, 0.241_032_814_163_896_69, -0.397_635_311_010_995_4, 0.403_434_679_401_244_44],
        [0.214_945_386_358_499_2, -2.290_514_685_633_458_4, 3.624_885_027_334_783_2],
        [0.292_791_485_786_438, 6.365_585_327_148_437_5, -4.836_692_810_058_594],
        0.543_426_876_050_068_7,
    );
}

/// The line runs so little inside of the outline that eight points around it do not enclose it. The bound that was then
/// sought by moving the bodies took 120 support points more.
#[test]
fn an_edge_that_is_hit_beside_the_outline_is_certain() {
    let (_, is_certain) = cylinder_and_cone(
        [0.003_591_478_152_740_406, -0.750_015_569_614_673_2, 0.134_489_045_694_077_82, 0.647_592_806_637_436_2],
        [0.016_191_772_471_862_764, -2.682_016_716_302_081_6, -3.846_744_726_151_250_4],
        [-1.507_284_283_638_000_5, 6.324_314_117_431_641, 4.661_667_346_954_346],
        0.630_689_796_934_896_5,
    );
    assert!(is_certain);
}

/// An edge again, where the line is enclosed. Newton's step for one piece was left out where its curvature is singular;
/// the planes were then laid on the border to the next piece, and half of them only showed that: 40 support points in
/// vain.
#[test]
fn an_edge_is_found_by_its_one_curvature() {
    let (iterations, _) = cylinder_and_cone(
        [-0.200_368_643_923_523_58, -0.888_174_777_693_191_9, 0.046_233_591_487_138_94, -0.410_926_302_176_068_9],
        [-1.690_421_553_071_026_5, -6.355_569_641_617_689, 1.344_605_117_726_267],
        [2.348_921_775_817_871, 7.515_034_675_598_144_5, -1.416_622_400_283_813_5],
        0.654_554_178_607_365_9,
    );
    assert!(iterations < 24, "{iterations} support points");
}

/// The side of a cylinder on the side of a cone: four pieces share the plane. One that had not been looked at for long
/// foretold less than was found there, and so forbade the plane of the other three: two of them were looked at in
/// turns.
#[test]
fn a_stale_piece_does_not_forbid_the_plane_of_the_others() {
    let (iterations, _) = cylinder_and_cone(
        [-0.283_794_959_499_453_66, 0.481_785_930_198_038_6, -0.777_998_128_041_319_1, -0.286_464_048_686_946_5],
        [3.402_221_064_736_452, -2.049_620_742_964_036_5, -0.391_416_852_644_947_2],
        [-6.582_283_973_693_848, 4.352_623_462_677_002, -1.314_614_057_540_893_6],
        0.457_844_361_362_324_3,
    );
    assert!(iterations < 24, "{iterations} support points");
}

/// Two points of either of two rims make a triangle as flat as rounding; that the line runs through it was rounding
/// too, and it was crossed before the contact. The search was given up one step before its end.
#[test]
fn a_portal_before_the_plane_is_none() {
    let (iterations, _) = cylinder_and_cone(
        [-0.278_730_817_586_561_1, 0.126_746_719_235_470_2, 0.903_645_586_875_972_1, -0.299_447_915_020_545_7],
        [2.538_010_950_241_967_7, 2.498_753_791_971_332, 3.985_115_691_143_980_7],
        [-3.302_312_374_114_990_2, -5.221_975_803_375_244, -5.081_899_642_944_336],
        0.541_461_809_732_532,
    );
    assert!(iterations < 24, "{iterations} support points");
}

/// A ray in `f32` that meets the slant of a cone at a cosine of 0.04. What rounding leaves of the planes closed the
/// bracket while it was 25 times as long along the ray, and `λ` was short by 2e-5 sizes; one more plane comes to a
/// tenth of that.
#[test]
fn one_more_plane_where_the_ray_grazes() {
    let (source, direction) = ([-1_645_990.9, -8_955_553.0, 4_133_859.0], [429_995.97, 2_527_059.8, -1_092_382.8]);
    let single = Ray { source: Vec3A::from_array(source), direction: Vec3A::from_array(direction) };
    let double = Ray { source: single.source.as_dvec3(), direction: single.direction.as_dvec3() };
    let cone = Cone::<Vec3A>::new(7.5e5, 6.25e5).expect("valid");
    let exact = Cone::<DVec3>::new(7.5e5, 6.25e5).expect("valid");
    let lambda = f64::from(
        ray_cast(&cone, single, RayCastOptions::default()).expect("finite").outcome.hit().expect("hits").lambda,
    );
    let truth =
        ray_cast(&exact, double, RayCastOptions::default()).expect("finite").outcome.hit().expect("hits").lambda;
    let error = (lambda - truth).abs() * double.direction.length() / 1e6;
    assert!(error < 4e-6, "{error:e} sizes");
}
