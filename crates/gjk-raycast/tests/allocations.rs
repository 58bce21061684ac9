//! Once warm nothing is allocated: neither by depths whose polytope is larger than there is room for, nor by what asks
//! for them.

use std::f64::consts::TAU;
use std::hint::black_box;

use allocation_counter::measure;
use convex_support::glam::{DQuat, DVec3, Quat, Vec3};
use convex_support::{Capsule, Cone, Cylinder, Ellipsoid, Polytope, Posed, SupportMap};
use gjk_raycast::{
    Joint, JointBounds, JointKind, JointState, JointTrajectory, LinearCastOptions, Link, Linkage, Motion,
    MotionCastOptions, MotionClearanceOptions, PathWorkspace, Pose, RigidMotion, Scene, SignedDistanceOptions,
    StartInContact, contact, linear_cast, motion_cast, signed_distance,
};

type Shape = Box<dyn SupportMap<Vector = DVec3> + Send + Sync>;

/// What a query allocates the first time that a thread asks it, and the second time.
fn allocations(mut query: impl FnMut() + Send) -> [u64; 2] {
    std::thread::scope(|scope| {
        let asked = scope.spawn(|| [(); 2].map(|()| measure(&mut query).count_total));
        asked.join().expect("no query panics")
    })
}

/// Points spread evenly over an ellipsoid.
fn hull(count: u32) -> Polytope<DVec3> {
    let point = |k: u32| {
        let z = 1.0 - f64::from(2 * k + 1) / f64::from(count);
        let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cos, 0.9 * across * sin, 0.8 * z)
    };
    Polytope::new((0..count).map(point)).expect("finite points")
}

/// A prism over a regular polygon of so many sides.
fn prism(sides: u32) -> Polytope<DVec3> {
    let corner = |k: u32| {
        (DQuat::from_rotation_z(TAU * f64::from(k / 2) / f64::from(sides)) * DVec3::X).with_z(f64::from(k % 2))
    };
    Polytope::new((0..2 * sides).map(corner)).expect("finite points")
}

fn ellipsoid() -> Ellipsoid<DVec3> {
    Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.7, 0.5), DQuat::from_rotation_x(0.3)).expect("positive axes")
}

/// How a shape stands in the other, deep and less deep.
fn placed(shape: &Shape, x: f64) -> Posed<&Shape> {
    Posed::new(shape, DQuat::from_rotation_y(0.7), DVec3::new(x, 0.5 * x, 0.25 * x)).expect("finite")
}

fn shapes() -> [Shape; 5] {
    [
        Box::new(ellipsoid()),
        Box::new(hull(1024)),
        Box::new(prism(40)),
        Box::new(Cylinder::<DVec3>::new(0.5, 0.7).expect("finite")),
        Box::new(Cone::<DVec3>::new(0.5, 0.7).expect("finite")),
    ]
}

/// Asks all pairs of shapes, and returns how many of them have allocated the first time.
fn pairs_that_allocate(query: impl Fn(&Shape, &Posed<&Shape>) + Sync) -> usize {
    let (shapes, mut count) = (shapes(), 0);
    for (i, a) in shapes.iter().enumerate() {
        for (j, b) in shapes.iter().enumerate() {
            for x in [0.01, 0.3] {
                let b = placed(b, x);
                let [cold, warm] = allocations(|| query(a, &b));
                assert_eq!(warm, 0, "of {i} and {j} at {x}");
                count += usize::from(cold > 0);
            }
        }
    }
    count
}

#[test]
fn a_depth_allocates_nothing_once_warm() {
    let count = pairs_that_allocate(|a, b| {
        let _ = black_box(signed_distance(a, b, SignedDistanceOptions::default()));
    });
    assert!(count > 4, "{count} pairs are deep enough to allocate at first");
}

/// There is room for as many vertices, so that programs without threads can do without allocations too.
#[test]
fn a_depth_of_sixty_support_points_never_allocates() {
    let count = pairs_that_allocate(|a, b| {
        let _ = black_box(signed_distance(a, b, SignedDistanceOptions::default().with_max_iterations(60)));
    });
    assert_eq!(count, 0, "pairs that allocate");
}

#[test]
fn a_manifold_allocates_nothing_once_warm() {
    let count = pairs_that_allocate(|a, b| {
        let _ = black_box(contact(a, b, 0.01, SignedDistanceOptions::default()));
    });
    assert!(count > 4, "{count} pairs are deep enough to allocate at first");
}

#[test]
fn casts_that_start_deep_allocate_nothing_once_warm() {
    for start in [StartInContact::Report, StartInContact::IfDeeper] {
        let _ = pairs_that_allocate(|a, b| {
            let motion = Motion { velocity_a: DVec3::X, velocity_b: DVec3::ZERO };
            let options = LinearCastOptions::default().with_start_in_contact(start);
            let _ = black_box(linear_cast(a, b, motion, options));
            let turning = RigidMotion { angular_velocity: DVec3::Z, ..RigidMotion::translation(DVec3::X) };
            let options = MotionCastOptions::default().with_max_time(1.0).with_start_in_contact(start);
            let _ = black_box(motion_cast(a, turning, b, RigidMotion::default(), options));
        });
    }
}

#[test]
fn the_contacts_of_a_scene_allocate_nothing_once_warm() {
    let places = (0..12).map(|i| DVec3::new(f64::from(i / 2), 0.1 * f64::from(i % 2), 0.0));
    let bodies = places.map(|at| Posed::translated(ellipsoid(), at).expect("finite"));
    let (scene, mut contacts) = (Scene::new(bodies).expect("finite bodies"), Vec::new());
    let [cold, warm] = allocations(|| {
        let _ = scene.all().contacts_within(0.01, SignedDistanceOptions::default(), &mut contacts);
    });
    assert!(cold > 8 && warm == 0, "{cold} allocations, and then {warm}");
}

/// The paths of one robot share a workspace: those that are free, those that touch something, and its own links.
#[test]
fn a_path_allocates_nothing_once_warm() {
    let joint = |parent: Option<usize>, at: DVec3| {
        let pose = Pose { translation: at, ..Pose::default() };
        Joint { parent, pose, kind: JointKind::Revolute(DVec3::Z) }
    };
    let link = |joint| Link { joint: Some(joint), bodies: vec![Capsule::new(0.4, 0.1).expect("positive")] };
    /// Each joint goes to a value and back.
    struct Swing(f64);
    impl JointTrajectory for Swing {
        type Scalar = f64;
        fn state(&self, _: usize, t: f64) -> JointState<f64> {
            let value = self.0 * t * (1.0 - t);
            JointState { value, rate: self.0 * (1.0 - 2.0 * t), acceleration: -2.0 * self.0, error: 1e-15 }
        }
        fn bounds(&self, _: usize) -> JointBounds<f64> {
            let most = self.0.abs();
            JointBounds { value: most, rate: most, acceleration: 2.0 * most, jerk: 0.0 }
        }
    }
    let joints = [joint(None, DVec3::ZERO), joint(Some(0), DVec3::Y), joint(Some(1), DVec3::Y)];
    let robot = Linkage::new(joints, [0, 1, 2].map(link)).and_then(|robot| robot.with_pairs([[0, 2]]));
    let robot = robot.expect("a chain");
    let places = (0..40).map(|i| DVec3::new(1.5, 0.2 * f64::from(i) - 2.0, 0.0));
    let bodies = places.map(|at| Posed::translated(Cylinder::new(0.1, 0.05).expect("positive"), at).expect("finite"));
    let (scene, mut workspace) = (Scene::new(bodies).expect("finite bodies"), PathWorkspace::new());
    let [cold, warm] = allocations(|| {
        for turn in [-3.0, -1.0, -0.2, 0.5, 2.0] {
            let ways = [[0.0, 0.0, 0.0], [0.3, 0.1, 0.2], [turn, 0.5 * turn, 0.8 * turn]];
            let _ = black_box(robot.path(&ways, &scene, MotionCastOptions::new(), &mut workspace));
            let _ = black_box(robot.path_along(&[Swing(turn)], &scene, MotionCastOptions::new(), &mut workspace));
            let _ = black_box(robot.path_clearance(&ways, &scene, MotionClearanceOptions::new(), &mut workspace));
        }
    });
    assert!(cold > 4 && warm == 0, "{cold} allocations, and then {warm}");
}

/// What is kept is of one type of vectors, and of the largest depth of its thread.
#[test]
fn depths_in_both_precisions_do_not_take_room_from_each_other() {
    let single = Ellipsoid::new(Vec3::ZERO, Vec3::new(1.0, 0.7, 0.5), Quat::IDENTITY).expect("positive axes");
    let other = Posed::new(single, Quat::from_rotation_y(0.7), Vec3::ZERO).expect("finite");
    let (a, b) = (hull(5000), Posed::new(hull(1024), DQuat::from_rotation_y(0.7), DVec3::ZERO).expect("finite"));
    let [cold, warm] = allocations(|| {
        for _ in 0..2 {
            let _ = black_box(signed_distance(&single, &other, SignedDistanceOptions::default()));
            let _ = black_box(signed_distance(&a, &b, SignedDistanceOptions::default()));
        }
    });
    assert!(cold > 8 && warm == 0, "{cold} allocations, and then {warm}");
}
