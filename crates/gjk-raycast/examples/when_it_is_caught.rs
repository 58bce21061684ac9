//! A stick is thrown, spinning, at a plate that moves. How does the time of impact depend on the throw; and which throw
//! hits just on time?
//!
//! `cargo run --release -p gjk-raycast --example when_it_is_caught`

#![allow(clippy::print_stdout, reason = "an example talks")]

use gjk_raycast::convex_support::glam::{DQuat, DVec3};
use gjk_raycast::convex_support::{Capsule, Cylinder, Posed};
use gjk_raycast::{
    Impact, ImpactGradient, MotionCastOptions, RigidMotion, RigidMotionGradient, Smoothness, motion_cast,
};

type Error = Box<dyn std::error::Error>;

/// The first contact of a throw, how its time changes with poses, and with the velocities of the throw.
struct Catch {
    hit: Impact<DVec3>,
    gradient: ImpactGradient<DVec3>,
    by_throw: RigidMotionGradient<DVec3>,
    smoothness: Smoothness,
}

fn caught(throw: RigidMotion<DVec3>) -> Result<Catch, Error> {
    let stick = Posed::new(Capsule::new(0.3, 0.02)?, DQuat::from_rotation_x(0.3), throw.center)?;
    let plate = Posed::new(Cylinder::new(0.01, 0.5)?, DQuat::from_rotation_z(1.4), DVec3::new(4.0, 0.2, 0.0))?;
    let drift = RigidMotion {
        velocity: DVec3::new(-0.5, 0.1, 0.0),
        angular_velocity: DVec3::Y * 0.2,
        center: DVec3::new(4.0, 0.2, 0.0),
    };
    let cast = motion_cast(&stick, throw, &plate, drift, MotionCastOptions::new().with_max_time(5.0))?;
    let hit = cast.outcome.hit().ok_or("it hits the plate")?;
    let features = hit.closest_features(&stick, &throw, &plate, &drift).ok_or("it starts apart")?;
    let gradient = hit.refined(&features).gradient(&throw, &drift).ok_or("it comes nearer")?;
    let by_throw = throw.gradient(hit.time, gradient.contact_a);
    Ok(Catch { hit, gradient, by_throw, smoothness: features.smoothness() })
}

fn main() -> Result<(), Error> {
    let throw = RigidMotion {
        velocity: DVec3::new(5.0, 0.3, 0.2),
        angular_velocity: DVec3::new(0.5, 2.0, 6.0),
        center: DVec3::ZERO,
    };
    let Catch { hit, gradient, by_throw, smoothness } = caught(throw)?;
    assert_eq!(smoothness, Smoothness::Smooth, "nothing of them is parallel when they meet");
    println!("it hits after {:.6} s, at {:.3}", hit.time, hit.point);
    println!(
        "a metre ahead changes that by {:.4} s, a metre per second by {:.4} s",
        gradient.pose_a.translation.x, by_throw.velocity.x
    );
    println!("and a radian per second of spin by {:.4} s", by_throw.angular_velocity);

    // As differences say.
    let time = |velocity: DVec3, spin: DVec3| -> Result<f64, Error> {
        let (velocity, angular_velocity) = (throw.velocity + velocity, throw.angular_velocity + spin);
        Ok(caught(RigidMotion { velocity, angular_velocity, ..throw })?.hit.time)
    };
    let h = 1e-5;
    for axis in DVec3::AXES {
        let by_velocity = (time(axis * h, DVec3::ZERO)? - time(-axis * h, DVec3::ZERO)?) / (2.0 * h);
        let by_spin = (time(DVec3::ZERO, axis * h)? - time(DVec3::ZERO, -axis * h)?) / (2.0 * h);
        assert!((by_velocity - by_throw.velocity.dot(axis)).abs() < 1e-8, "{by_velocity} along {axis}");
        assert!((by_spin - by_throw.angular_velocity.dot(axis)).abs() < 1e-8, "{by_spin} about {axis}");
    }

    // The hand is wrong by 0.1 m/s and 0.3 rad/s along every axis: so much in time.
    let spread = (by_throw.velocity * 0.1).length().hypot((by_throw.angular_velocity * 0.3).length());
    println!("such a hand is wrong by {:.1} ms", 1e3 * spread);

    // A throw that hits after half a second, by Newton's method for the speed.
    let mut fitting = throw;
    let mut steps = 0;
    loop {
        let Catch { hit, by_throw, .. } = caught(fitting)?;
        let early = 0.5 - hit.time;
        let forward = fitting.velocity.normalize();
        println!("at {:.6} m/s after {:.12} s", fitting.velocity.length(), hit.time);
        if early.abs() < 1e-12 || steps == 20 {
            break;
        }
        fitting.velocity += forward * (early / by_throw.velocity.dot(forward));
        steps += 1;
    }
    assert!(steps <= 6, "{steps} steps: it doubles its digits");
    assert!((caught(fitting)?.hit.time - 0.5).abs() < 1e-12, "just on time");
    Ok(())
}
