//! What is to be reached, and what was reached on another machine: the two belong together, since a time means something
//! only beside another time from the same run.

use crate::rows::{Method, Workload};

/// A limit on one row.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The workload.
    pub workload: Workload,
    /// The case.
    pub case: &'static str,
    /// The row that is limited.
    pub method: Method,
    /// Nanoseconds on the machine of [`parry_ns`].
    pub ns: f64,
    /// The largest p99 error; infinite where any correct answer will do.
    pub p99: f64,
}

/// The goals.
pub const GOALS: &[Goal] = &[
    goal(Workload::RayCast, "cuboid", Method::OursF64, 200.0, f64::INFINITY),
    goal(Workload::RayCast, "ball", Method::OursF64, 80.0, f64::INFINITY),
    goal(Workload::RayCast, "capsule", Method::OursF64, 150.0, f64::INFINITY),
    goal(Workload::RayCast, "roundbox", Method::OursF64, 300.0, f64::INFINITY),
    goal(Workload::RayCast, "cylinder", Method::OursF64, 700.0, 1e-12),
    goal(Workload::RayCast, "cone", Method::OursF64, 400.0, 1e-12),
    goal(Workload::RayCast, "ellipsoid", Method::OursF64, 700.0, 1e-12),
    goal(Workload::RayCast, "hull16", Method::OursF64, 300.0, f64::INFINITY),
    goal(Workload::RayCast, "hull64", Method::OursF64, 400.0, f64::INFINITY),
    goal(Workload::RayCast, "hull256", Method::OursF64, 500.0, f64::INFINITY),
    goal(Workload::RayCast, "hull1024", Method::OursF64, 600.0, f64::INFINITY),
    goal(Workload::RayCast, "ball", Method::ClosedF64, 10.0, f64::INFINITY),
    goal(Workload::RayCast, "cuboid", Method::ClosedF64, 10.0, f64::INFINITY),
    goal(Workload::RayCast, "capsule", Method::ClosedF64, 30.0, f64::INFINITY),
    goal(Workload::RayCast, "cylinder", Method::ClosedF64, 30.0, f64::INFINITY),
    goal(Workload::RayCast, "cone", Method::ClosedF64, 40.0, f64::INFINITY),
    goal(Workload::RayCast, "ellipsoid", Method::ClosedF64, 15.0, f64::INFINITY),
    goal(Workload::LinearCast, "cuboid-cuboid", Method::OursF64, 450.0, f64::INFINITY),
    goal(Workload::LinearCast, "hull64-hull64", Method::OursF64, 1000.0, f64::INFINITY),
    goal(Workload::LinearCast, "hull1024-hull1024", Method::OursF64, 1500.0, f64::INFINITY),
    goal(Workload::LinearCast, "capsule-capsule", Method::OursF64, 200.0, 1e-12),
    goal(Workload::LinearCast, "ball-cuboid", Method::OursF64, 250.0, 1e-12),
    goal(Workload::LinearCast, "cylinder-cone", Method::OursF64, 1500.0, f64::INFINITY),
    goal(Workload::LinearCast, "ellipsoid-ellipsoid", Method::OursF64, 1500.0, f64::INFINITY),
    goal(Workload::DistanceFar, "cuboid-cuboid", Method::OursF64, 250.0, f64::INFINITY),
    goal(Workload::DistanceFar, "hull64-hull64", Method::OursF64, 600.0, f64::INFINITY),
    goal(Workload::DistanceFar, "hull1024-hull1024", Method::OursF64, 1200.0, f64::INFINITY),
    goal(Workload::DistanceFar, "ellipsoid-ellipsoid", Method::OursF64, 1000.0, 1e-9),
    goal(Workload::DistanceFar, "cylinder-cone", Method::OursF64, 1000.0, 1e-9),
    // 60 % of the fastest library that answered every query correctly.
    goal(Workload::Intersect, "ball-cuboid", Method::OursF64, 0.6 * 57.0, f64::INFINITY),
    goal(Workload::Intersect, "cuboid-cuboid", Method::OursF64, 0.6 * 327.0, f64::INFINITY),
    goal(Workload::Intersect, "cylinder-cone", Method::OursF64, 0.6 * 985.0, f64::INFINITY),
    goal(Workload::Intersect, "capsule-ellipsoid", Method::OursF64, 0.6 * 706.0, f64::INFINITY),
    goal(Workload::Intersect, "ellipsoid-ellipsoid", Method::OursF64, 0.6 * 593.0, f64::INFINITY),
    goal(Workload::Intersect, "hull16-hull16", Method::OursF64, 0.6 * 776.0, f64::INFINITY),
    goal(Workload::Intersect, "hull64-hull64", Method::OursF64, 0.6 * 1984.0, f64::INFINITY),
    goal(Workload::Intersect, "hull256-hull256", Method::OursF64, 0.6 * 4683.0, f64::INFINITY),
    goal(Workload::Intersect, "hull1024-hull1024", Method::OursF64, 0.6 * 7213.0, f64::INFINITY),
    goal(Workload::Intersect, "roundbox-roundbox", Method::OursF64, 0.6 * 447.0, f64::INFINITY),
    goal(Workload::Intersect, "cuboid-hull64", Method::OursF64, 0.6 * 1323.0, f64::INFINITY),
    goal(Workload::Intersect, "capsule-capsule", Method::OursF64, 0.6 * 130.0, f64::INFINITY),
];

const fn goal(workload: Workload, case: &'static str, method: Method, ns: f64, p99: f64) -> Goal {
    Goal { workload, case, method, ns, p99 }
}

/// The limit of every near distance: an absolute p99 error, and no more than twice the time of the far ones.
pub const NEAR_P99: f64 = 1e-13;

/// A test with a warm separating axis, in nanoseconds on the machine of [`parry_ns`].
pub const WARM_NS: f64 = 30.0;

/// What the GJK of parry3d-f64 0.31.1 took on the machine on which the goals were set, in nanoseconds.
#[must_use]
pub fn parry_ns(workload: Workload, case: &str) -> Option<f64> {
    let row = PARRY_NS.iter().find(|row| row.0 == case)?;
    Some(match workload {
        Workload::RayCast | Workload::LinearCast => row.1[0],
        Workload::DistanceFar => row.1[1],
        Workload::DistanceNear => row.1[2],
        Workload::Intersect => row.1[3],
    })
}

/// Ray cast for a shape; linear cast, far, near and intersection for a pair.
const PARRY_NS: &[(&str, [f64; 4])] = &[
    ("ball", [3990.0, f64::NAN, f64::NAN, f64::NAN]),
    ("cuboid", [452.0, f64::NAN, f64::NAN, f64::NAN]),
    ("cylinder", [2877.0, f64::NAN, f64::NAN, f64::NAN]),
    ("cone", [1131.0, f64::NAN, f64::NAN, f64::NAN]),
    ("capsule", [4232.0, f64::NAN, f64::NAN, f64::NAN]),
    ("ellipsoid", [5018.0, f64::NAN, f64::NAN, f64::NAN]),
    ("hull16", [639.0, f64::NAN, f64::NAN, f64::NAN]),
    ("hull64", [1363.0, f64::NAN, f64::NAN, f64::NAN]),
    ("hull256", [4215.0, f64::NAN, f64::NAN, f64::NAN]),
    ("hull1024", [17511.0, f64::NAN, f64::NAN, f64::NAN]),
    ("roundbox", [2609.0, f64::NAN, f64::NAN, f64::NAN]),
    ("ball-cuboid", [6793.0, 2945.0, 6701.0, 821.0]),
    ("cuboid-cuboid", [1085.0, 621.0, 734.0, 515.0]),
    ("cylinder-cone", [7160.0, 2889.0, 6707.0, 985.0]),
    ("capsule-ellipsoid", [10234.0, 3809.0, 9699.0, 1061.0]),
    ("ellipsoid-ellipsoid", [10587.0, 3940.0, 10471.0, 1022.0]),
    ("hull16-hull16", [1846.0, 1140.0, 1390.0, 936.0]),
    ("hull64-hull64", [4199.0, 2619.0, 3353.0, 1984.0]),
    ("hull256-hull256", [12621.0, 10505.0, 13632.0, 7472.0]),
    ("hull1024-hull1024", [59117.0, 45701.0, 58752.0, 27674.0]),
    ("roundbox-roundbox", [6033.0, 2722.0, 6736.0, 993.0]),
    ("cuboid-hull64", [2724.0, 1709.0, 2094.0, 1343.0]),
    ("capsule-capsule", [9020.0, 3405.0, 8845.0, 1191.0]),
];
