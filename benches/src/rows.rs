//! Everything measured, one row per workload, case and method.

use std::ops::Range;
use std::time::Duration;

#[cfg(feature = "box3d")]
use crate::box3d;
#[cfg(feature = "jolt")]
use crate::jolt;
use crate::measure::Solver;
use crate::ours::{self, Effort};
#[cfg(feature = "parry")]
use crate::parry::{double, single};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::score::{self, Precision, Score};
use workloads::shapes::{SHAPE_NAMES, Shape};
use workloads::{w1_ray_cast, w2_linear_cast, w3_distance, w3b_intersect};

/// A workload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workload {
    /// W1.
    RayCast,
    /// W2.
    LinearCast,
    /// The far queries of W3.
    DistanceFar,
    /// The near queries of W3.
    DistanceNear,
    /// W3b.
    Intersect,
}

impl Workload {
    /// All of them, in the order of the report.
    pub const ALL: [Self; 5] =
        [Self::RayCast, Self::LinearCast, Self::DistanceFar, Self::DistanceNear, Self::Intersect];

    /// The question, as a reader says it.
    #[must_use]
    pub const fn question(self) -> &'static str {
        match self {
            Self::RayCast => "ray cast",
            Self::LinearCast => "linear cast",
            Self::DistanceFar => "distance",
            Self::DistanceNear => "near contact",
            Self::Intersect => "overlap",
        }
    }

    /// How many questions are asked of each body or pair.
    #[must_use]
    pub const fn count(self) -> usize {
        match self {
            Self::RayCast => 10_000,
            Self::LinearCast | Self::DistanceFar | Self::Intersect => 2_000,
            Self::DistanceNear => 1_000,
        }
    }

    /// Its short name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RayCast => "W1",
            Self::LinearCast => "W2",
            Self::DistanceFar => "W3far",
            Self::DistanceNear => "W3near",
            Self::Intersect => "W3b",
        }
    }
}

/// A way to answer, in the order of the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// `gjk-raycast` on `DVec3`.
    OursF64,
    /// `gjk-raycast` on `Vec3A`.
    OursF32,
    /// `gjk-raycast` on `DVec3`, of shapes behind `dyn SupportMap`.
    DynF64,
    /// `line_crossing` on `DVec3`.
    ClosedF64,
    /// `line_crossing` on `Vec3A`.
    ClosedF32,
    /// `intersects` on `DVec3` with the separating axis of the frame before.
    WarmF64,
    /// The same on `Vec3A`.
    WarmF32,
    /// The GJK functions of parry3d-f64.
    ParryGjkF64,
    /// The GJK functions of parry3d.
    ParryGjkF32,
    /// The functions parry3d-f64's users call, with their special cases.
    ParryF64,
    /// The same of parry3d.
    ParryF32,
    /// `Box3D`.
    Box3d,
    /// Jolt.
    Jolt,
}

impl Method {
    /// All of them, in the order of the columns.
    pub const ALL: [Self; 13] = [
        Self::OursF64,
        Self::OursF32,
        Self::DynF64,
        Self::ClosedF64,
        Self::ClosedF32,
        Self::WarmF64,
        Self::WarmF32,
        Self::ParryGjkF64,
        Self::ParryGjkF32,
        Self::ParryF64,
        Self::ParryF32,
        Self::Box3d,
        Self::Jolt,
    ];

    /// Its column title.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OursF64 => "ours f64",
            Self::OursF32 => "ours f32",
            Self::DynF64 => "ours dyn f64",
            Self::ClosedF64 => "line_crossing f64",
            Self::ClosedF32 => "line_crossing f32",
            Self::WarmF64 => "ours with axis f64",
            Self::WarmF32 => "ours with axis f32",
            Self::ParryGjkF64 => "parry GJK f64",
            Self::ParryGjkF32 => "parry GJK f32",
            Self::ParryF64 => "parry f64",
            Self::ParryF32 => "parry f32",
            Self::Box3d => "Box3D f32",
            Self::Jolt => "Jolt f32",
        }
    }

    /// Whether it is another library's.
    #[must_use]
    pub const fn is_peer(self) -> bool {
        matches!(
            self,
            Self::ParryGjkF64 | Self::ParryGjkF32 | Self::ParryF64 | Self::ParryF32 | Self::Box3d | Self::Jolt
        )
    }

    /// The precision it works in.
    #[must_use]
    pub const fn precision(self) -> Precision {
        match self {
            Self::OursF64 | Self::DynF64 | Self::ClosedF64 | Self::WarmF64 | Self::ParryGjkF64 | Self::ParryF64 => {
                Precision::Double
            }
            Self::OursF32
            | Self::ClosedF32
            | Self::WarmF32
            | Self::ParryGjkF32
            | Self::ParryF32
            | Self::Box3d
            | Self::Jolt => Precision::Single,
        }
    }
}

/// One measurement.
#[derive(Clone, Debug)]
pub struct Row {
    /// The workload.
    pub workload: Workload,
    /// The shape or pair of shapes.
    pub case: &'static str,
    /// Who answered.
    pub method: Method,
    /// Nanoseconds of thread CPU time per query.
    pub ns: f64,
    /// How right the answers are.
    pub score: Score,
}

impl Row {
    /// A line of `docs/performance.csv`.
    #[must_use]
    pub fn parse(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        let [workload, case, method, ns, p99, max, false_hits, false_misses, undecided, far_off, said_zero] =
            cells.as_slice()
        else {
            return None;
        };
        Some(Self {
            workload: Workload::ALL.into_iter().find(|known| known.name() == *workload)?,
            case: SHAPE_NAMES.into_iter().chain(PAIR_NAMES).find(|known| known == case)?,
            method: Method::ALL.into_iter().find(|known| known.name() == *method)?,
            ns: ns.parse().ok()?,
            score: Score {
                p99: p99.parse().ok()?,
                max: max.parse().ok()?,
                false_hits: false_hits.parse().ok()?,
                false_misses: false_misses.parse().ok()?,
                undecided: undecided.parse().ok()?,
                far_off: far_off.parse().ok()?,
                said_zero: said_zero.parse().ok()?,
            },
        })
    }
}

/// Measures every method on every case of the workloads, telling `progress` of each row as it comes.
///
/// Each row may spend `budget`.
#[inline]
#[must_use]
pub fn measure(workloads: &[Workload], budget: Duration, mut progress: impl FnMut(&Row)) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut add = |workload, case, method, solver: &Solver, range: Range<usize>, score: &dyn Fn(&[f64]) -> Score| {
        let score = score(&solver.answers()[range.clone()]);
        let row = Row { workload, case, method, ns: solver.nanoseconds(range, budget), score };
        progress(&row);
        rows.push(row);
    };
    if workloads.contains(&Workload::RayCast) {
        for case in SHAPE_NAMES {
            let rays = w1_ray_cast::rays(case);
            for (method, solver) in ray_casters(&Shape::named(case), &rays) {
                let score = |answers: &[f64]| score::ray_casts(&rays, answers, method.precision());
                add(Workload::RayCast, case, method, &solver, 0..rays.len(), &score);
            }
        }
    }
    for case in PAIR_NAMES {
        let pair = Pair::named(case);
        if workloads.contains(&Workload::LinearCast) {
            let casts = w2_linear_cast::casts(&pair);
            let grazing = w2_linear_cast::grazing(&pair, &casts);
            for (method, solver) in linear_casters(&pair, &casts) {
                let score = |answers: &[f64]| score::linear_casts(&casts, &grazing, answers);
                add(Workload::LinearCast, case, method, &solver, 0..casts.len(), &score);
            }
        }
        if workloads.contains(&Workload::DistanceFar) || workloads.contains(&Workload::DistanceNear) {
            let queries = w3_distance::queries(&pair);
            let near = w3_distance::FAR..queries.len();
            for (method, solver) in distance_solvers(&pair, &queries) {
                for (workload, range) in
                    [(Workload::DistanceFar, 0..w3_distance::FAR), (Workload::DistanceNear, near.clone())]
                {
                    let score = |answers: &[f64]| score::distances(&queries[range.clone()], answers);
                    add(workload, case, method, &solver, range.clone(), &score);
                }
            }
        }
        if workloads.contains(&Workload::Intersect) {
            let queries = w3b_intersect::queries(&pair);
            for (method, solver) in intersection_testers(&pair, &queries) {
                let score = |answers: &[f64]| score::intersections(&queries, answers);
                add(Workload::Intersect, case, method, &solver, 0..queries.len(), &score);
            }
            // Only bodies that are apart have an axis to be remembered.
            let apart: Vec<_> = queries.into_iter().filter(|query| !query.meet).collect();
            for (method, solver) in warm_intersection_testers(&pair, &apart) {
                let score = |answers: &[f64]| score::intersections(&apart, answers);
                add(Workload::Intersect, case, method, &solver, 0..apart.len(), &score);
            }
        }
    }
    rows
}

/// Every method's solver of ray casts against one shape.
#[inline]
#[must_use]
pub fn ray_casters(shape: &Shape, rays: &[w1_ray_cast::Ray]) -> Vec<(Method, Solver)> {
    // As docs/choosing-a-method.md advises: clipping a ray by the facets is the quicker way for few of them.
    let faceted = matches!(shape, Shape::Hull { points } if points.len() <= 64);
    let effort = Effort { faceted, ..Effort::default() };
    #[allow(unused_mut, reason = "without peers there is nothing to add")]
    let mut solvers = vec![
        (Method::OursF64, ours::ray_casts(Precision::Double, shape, rays, effort)),
        (Method::ClosedF64, ours::closed_form_ray_casts(Precision::Double, shape, rays)),
        (Method::OursF32, ours::ray_casts(Precision::Single, shape, rays, effort)),
        (Method::ClosedF32, ours::closed_form_ray_casts(Precision::Single, shape, rays)),
        (Method::DynF64, ours::ray_casts(Precision::Double, shape, rays, Effort { boxed: true, ..effort })),
    ];
    #[cfg(feature = "parry")]
    {
        solvers.push((Method::ParryGjkF64, double::ray_casts(shape, rays)));
        solvers.push((Method::ParryGjkF32, single::ray_casts(shape, rays)));
        solvers.extend(double::front_door_ray_casts(shape, rays).map(|solver| (Method::ParryF64, solver)));
        solvers.extend(single::front_door_ray_casts(shape, rays).map(|solver| (Method::ParryF32, solver)));
    }
    #[cfg(feature = "box3d")]
    solvers.extend(box3d::ray_casts(shape, rays).map(|solver| (Method::Box3d, solver)));
    #[cfg(feature = "jolt")]
    solvers.extend(jolt::ray_casts(shape, rays).map(|solver| (Method::Jolt, solver)));
    solvers
}

/// Every method's solver of linear casts of one pair.
#[inline]
#[must_use]
pub fn linear_casters(pair: &Pair, casts: &[w2_linear_cast::Cast]) -> Vec<(Method, Solver)> {
    #[allow(unused_mut, reason = "without peers there is nothing to add")]
    let mut solvers = vec![
        (Method::OursF64, ours::linear_casts(Precision::Double, pair, casts, Effort::default())),
        (Method::OursF32, ours::linear_casts(Precision::Single, pair, casts, Effort::default())),
        (
            Method::DynF64,
            ours::linear_casts(Precision::Double, pair, casts, Effort { boxed: true, ..Effort::default() }),
        ),
    ];
    #[cfg(feature = "parry")]
    {
        solvers.push((Method::ParryGjkF64, double::linear_casts(pair, casts)));
        solvers.push((Method::ParryGjkF32, single::linear_casts(pair, casts)));
        solvers.extend(double::front_door_linear_casts(pair, casts).map(|solver| (Method::ParryF64, solver)));
        solvers.extend(single::front_door_linear_casts(pair, casts).map(|solver| (Method::ParryF32, solver)));
    }
    #[cfg(feature = "box3d")]
    solvers.extend(box3d::linear_casts(pair, casts).map(|solver| (Method::Box3d, solver)));
    #[cfg(feature = "jolt")]
    solvers.extend(jolt::linear_casts(pair, casts).map(|solver| (Method::Jolt, solver)));
    solvers
}

/// Every method's solver of distances of one pair.
#[inline]
#[must_use]
pub fn distance_solvers(pair: &Pair, queries: &[w3_distance::DistanceQuery]) -> Vec<(Method, Solver)> {
    #[allow(unused_mut, reason = "without peers there is nothing to add")]
    let mut solvers = vec![
        (Method::OursF64, ours::distances(Precision::Double, pair, queries, Effort::default())),
        (Method::OursF32, ours::distances(Precision::Single, pair, queries, Effort::default())),
        (
            Method::DynF64,
            ours::distances(Precision::Double, pair, queries, Effort { boxed: true, ..Effort::default() }),
        ),
    ];
    #[cfg(feature = "parry")]
    {
        solvers.push((Method::ParryGjkF64, double::distances(pair, queries)));
        solvers.push((Method::ParryGjkF32, single::distances(pair, queries)));
        solvers.extend(double::front_door_distances(pair, queries).map(|solver| (Method::ParryF64, solver)));
        solvers.extend(single::front_door_distances(pair, queries).map(|solver| (Method::ParryF32, solver)));
    }
    #[cfg(feature = "box3d")]
    solvers.extend(box3d::distances(pair, queries).map(|solver| (Method::Box3d, solver)));
    solvers
}

/// Every method's solver of intersection tests of one pair.
#[inline]
#[must_use]
pub fn intersection_testers(pair: &Pair, queries: &[w3b_intersect::IntersectQuery]) -> Vec<(Method, Solver)> {
    #[allow(unused_mut, reason = "without peers there is nothing to add")]
    let mut solvers = vec![
        (Method::OursF64, ours::intersections(Precision::Double, pair, queries, false, Effort::default())),
        (Method::OursF32, ours::intersections(Precision::Single, pair, queries, false, Effort::default())),
        (
            Method::DynF64,
            ours::intersections(Precision::Double, pair, queries, false, Effort { boxed: true, ..Effort::default() }),
        ),
    ];
    #[cfg(feature = "parry")]
    {
        solvers.push((Method::ParryGjkF64, double::intersections(pair, queries)));
        solvers.push((Method::ParryGjkF32, single::intersections(pair, queries)));
        solvers.extend(double::front_door_intersections(pair, queries).map(|solver| (Method::ParryF64, solver)));
        solvers.extend(single::front_door_intersections(pair, queries).map(|solver| (Method::ParryF32, solver)));
    }
    #[cfg(feature = "box3d")]
    solvers.extend(box3d::intersections(pair, queries).map(|solver| (Method::Box3d, solver)));
    #[cfg(feature = "jolt")]
    solvers.extend(jolt::intersections(pair, queries).map(|solver| (Method::Jolt, solver)));
    solvers
}

/// Solvers of intersection tests that start from the axis which separated the same bodies before.
#[inline]
#[must_use]
pub fn warm_intersection_testers(pair: &Pair, apart: &[w3b_intersect::IntersectQuery]) -> Vec<(Method, Solver)> {
    vec![
        (Method::WarmF64, ours::intersections(Precision::Double, pair, apart, true, Effort::default())),
        (Method::WarmF32, ours::intersections(Precision::Single, pair, apart, true, Effort::default())),
    ]
}
