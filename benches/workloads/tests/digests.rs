//! The workloads are, bit by bit, the ones that the other libraries were measured on.
//!
//! W2, W3 and W3b are missing here. Their poses end in the last bits of a reference search, and its description leaves
//! the order of operations open: many orders were tried and none gave the published digests. All random draws agree, as
//! the number of grazing hits of each pair of polytopes shows (see the tests of `w2_linear_cast`), and so do the true
//! answers, which hold by construction for whatever pose comes out.

use workloads::digest::fnv1a;
use workloads::shapes::{SHAPE_NAMES, hull_points};
use workloads::w4_enclosing::Cloud;
use workloads::w5_margin::Condition;
use workloads::{w1_ray_cast, w4_enclosing, w5_margin};

/// Number of values and FNV-1a digest of each workload.
const DIGESTS: &[(&str, usize, u64)] = &[
    ("hull16", 48, 0x1db8_9265_53ae_2635),
    ("hull64", 192, 0x2926_fa2b_0e4f_7bb3),
    ("hull256", 768, 0x37d0_30e0_c763_df16),
    ("hull1024", 3072, 0xe47e_430e_469e_b2a3),
    ("w1_ball", 80000, 0x6ebc_804c_a717_90bf),
    ("w1_cuboid", 80000, 0x544f_9388_a4e9_7c78),
    ("w1_cylinder", 80000, 0x746d_b3df_6e25_9bc5),
    ("w1_cone", 80000, 0x97a9_9106_889d_fb54),
    ("w1_capsule", 80000, 0x522a_ce71_981e_323c),
    ("w1_ellipsoid", 80000, 0x7341_622d_f06e_52c4),
    ("w1_hull16", 80000, 0x2c1a_fa7c_9c93_1fc7),
    ("w1_hull64", 80000, 0x6e71_a8fa_6a06_f0fc),
    ("w1_hull256", 80000, 0x9c66_3dec_ef5b_413e),
    ("w1_hull1024", 80000, 0x3fc8_073c_1279_9940),
    ("w1_roundbox", 80000, 0xbf22_b4ab_785c_3b60),
    ("w4_normal_n2_m8", 16, 0xb167_4057_e6a3_2c2e),
    ("w4_cube_n2_m8", 16, 0x4a83_bcb1_f9c1_b081),
    ("w4_normal_n2_m100", 200, 0x6978_c5be_bfe9_c3db),
    ("w4_cube_n2_m100", 200, 0x882f_4dad_cddd_c68b),
    ("w4_normal_n2_m10000", 20000, 0xc544_59ac_13b1_a67f),
    ("w4_cube_n2_m10000", 20000, 0xe725_9a4f_3e61_7b3d),
    ("w4_normal_n2_m1000000", 2000000, 0xb18d_b546_c765_bc56),
    ("w4_cube_n2_m1000000", 2000000, 0x6276_9676_a618_11a5),
    ("w4_normal_n3_m8", 24, 0x61fa_f6e8_7ee3_8997),
    ("w4_cube_n3_m8", 24, 0x5235_d5b8_4b10_d16d),
    ("w4_normal_n3_m100", 300, 0x9546_8dcc_ca4f_4437),
    ("w4_cube_n3_m100", 300, 0xc909_961f_c885_92b8),
    ("w4_normal_n3_m10000", 30000, 0x3f5b_b7e7_9dea_e61a),
    ("w4_cube_n3_m10000", 30000, 0x2786_54e6_e12a_cc85),
    ("w4_normal_n3_m1000000", 3000000, 0xda49_b6f7_de33_800e),
    ("w4_cube_n3_m1000000", 3000000, 0xa704_1c97_03a9_106d),
    ("w4_normal_n10_m10000", 100000, 0x9b36_49a9_f47f_d6c7),
    ("w4_cube_n10_m10000", 100000, 0x5723_6432_145d_6be2),
    ("w5_n2_c1e2", 12000, 0x38dc_af88_97da_d1b6),
    ("w5_n2_c1e6", 12000, 0x6395_3c06_6d2e_3f4d),
    ("w5_n3_c1e2", 24000, 0xb2f3_2631_aa1f_48ac),
    ("w5_n3_c1e6", 24000, 0x042f_f484_daea_659c),
];

fn check(name: &str, values: &[f64]) {
    let &(_, count, digest) = DIGESTS.iter().find(|entry| entry.0 == name).expect("a listed workload");
    assert_eq!(values.len(), count, "number of values of {name}");
    assert_eq!(fnv1a(values), digest, "digest of {name}");
}

#[test]
fn hulls() {
    for count in [16, 64, 256, 1024] {
        check(&format!("hull{count}"), &hull_points(count).concat());
    }
}

#[test]
fn ray_casts() {
    for shape in SHAPE_NAMES {
        check(&format!("w1_{shape}"), &w1_ray_cast::records(&w1_ray_cast::rays(shape)));
    }
}

#[test]
fn point_clouds() {
    for (n, m) in w4_enclosing::SIZES {
        check(&format!("w4_normal_n{n}_m{m}"), &w4_enclosing::points(Cloud::Normal, n, m));
        check(&format!("w4_cube_n{n}_m{m}"), &w4_enclosing::points(Cloud::Cube, n, m));
    }
}

#[test]
fn ellipsoid_pairs() {
    for (condition, c) in [(Condition::Mild, "1e2"), (Condition::Stiff, "1e6")] {
        check(&format!("w5_n2_c{c}"), &w5_margin::records(&w5_margin::pairs2(condition)));
        check(&format!("w5_n3_c{c}"), &w5_margin::records(&w5_margin::pairs3(condition)));
    }
}
