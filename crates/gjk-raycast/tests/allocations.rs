//! Once warm nothing is allocated: neither by depths whose polytope is larger than there is room for, nor by what asks
//! for them.

use std::f64::consts::TAU;

use allocation_counter::measure;
use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cone, Cylinder, Ellipsoid, Polytope, Posed, SupportMap, Vector};
use gjk_raycast::{
    LinearCastOptions, Motion, MotionCastOptions, RigidMotion, Scene, SignedDistanceOptions, StartInContact, contact,
    linear_cast, motion_cast, signed_distance,
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
        DVec3::from(
            (DQuat::from_rotation_z(TAU * f64::from(k / 2) / f64::from(sides)) * DVec3::X).with_z(f64::from(k % 2)),
        )
    };
    Polytope::new((0..2 * sides).map(corner)).expect("finite points")
}

fn ellipsoid(semi_axes: DVec3) -> Ellipsoid<DVec3> {
    Ellipsoid::new(DVec3::ZERO, semi_axes, DQuat::from_rotation_x(0.3)).expect("positive axes")
}

fn shapes() -> Vec<(&'static str, Shape)> {
    vec![
        ("ellipsoid", Box::new(ellipsoid(DVec3::new(1.0, 0.7, 0.5)))),
        ("hull of 1024", Box::new(hull(1024))),
        ("hull of 5000", Box::new(hull(5000))),
        ("prism", Box::new(prism(40))),
        ("cylinder", Box::new(Cylinder::<DVec3>::new(0.5, 0.7).expect("finite"))),
        ("cone", Box::new(Cone::<DVec3>::new(0.5, 0.7).expect("finite"))),
    ]
}

#[test]
fn probe() {
    for (name, a) in &shapes() {
        for (other, b) in &shapes() {
            for x in [0.0, 0.01, 0.3, 0.9] {
                let b =
                    Posed::new(&**b, DQuat::from_rotation_y(0.7), DVec3::new(x, 0.5 * x, 0.25 * x)).expect("finite");
                let depth = allocations(|| {
                    let _ = std::hint::black_box(signed_distance(&**a, &b, SignedDistanceOptions::default()));
                });
                let manifold = allocations(|| {
                    let _ = std::hint::black_box(contact(&**a, &b, 0.01, SignedDistanceOptions::default()));
                });
                let motion = Motion { velocity_a: DVec3::X, velocity_b: DVec3::ZERO };
                let cast = [StartInContact::Report, StartInContact::IfDeeper].map(|start| {
                    allocations(|| {
                        let _ = std::hint::black_box(linear_cast(
                            &**a,
                            &b,
                            motion,
                            LinearCastOptions::default().with_start_in_contact(start),
                        ));
                    })
                });
                let turning = RigidMotion { angular_velocity: DVec3::Z, ..RigidMotion::translation(DVec3::X) };
                let turn = [StartInContact::Report, StartInContact::IfDeeper].map(|start| {
                    allocations(|| {
                        let _ = std::hint::black_box(motion_cast(
                            &**a,
                            turning,
                            &b,
                            RigidMotion::default(),
                            MotionCastOptions::default().with_max_time(1.0).with_start_in_contact(start),
                        ));
                    })
                });
                println!("{name} {other} {x}: depth {depth:?} manifold {manifold:?} cast {cast:?} turn {turn:?}");
            }
        }
    }
    let scene = Scene::new((0..6).flat_map(|i| {
        [0.0, 0.1].map(|y| {
            Posed::translated(ellipsoid(DVec3::new(1.0, 0.7, 0.5)), DVec3::new(f64::from(i), y, 0.0)).expect("finite")
        })
    }))
    .expect("finite");
    let mut contacts = Vec::new();
    println!(
        "scene {:?}",
        allocations(|| {
            let _ = scene.all().contacts_within(0.01, SignedDistanceOptions::default(), &mut contacts);
        })
    );
}
