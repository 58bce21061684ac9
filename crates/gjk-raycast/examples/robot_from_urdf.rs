//! A robot from its URDF file: its tree, what it meets on a way, how near it comes on a part of it, and one step away
//! from there along the gradient.
//!
//! `cargo run -p gjk-raycast --example robot_from_urdf [FILE.urdf]`
//!
//! Boxes, spheres, capsules and cylinders become shapes; the vertices of an OBJ mesh become their hull. Joints that
//! mimic others follow them. Without a file it is an arm of three joints with a gripper.

#![allow(clippy::print_stdout, reason = "an example talks")]

use std::collections::HashMap;
use std::path::Path;

use convex_support::glam::{DMat3, DQuat, DVec3};
use convex_support::{Ball, Capsule, Cuboid, Cylinder, Polytope, Posed, SupportMap};
use gjk_raycast::{
    ConfigurationWorkspace, Joint, JointKind, Link, Linkage, MotionCastOptions, MotionClearanceOptions, PathWorkspace,
    Pose, Scene, SignedDistanceOptions,
};
use urdf_rs::{Geometry, JointType};

type Shape = Posed<Box<dyn SupportMap<Vector = DVec3>>>;
type Failed = Box<dyn std::error::Error>;

const ARM: &str = r#"<robot name="arm">
  <link name="base"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <link name="table"/>
  <link name="upper"><collision><origin xyz="0.5 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><cylinder radius="0.08" length="1"/></geometry></collision></link>
  <link name="forearm"><collision><origin xyz="0.4 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><capsule radius="0.06" length="0.7"/></geometry></collision></link>
  <link name="left"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="right"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="turn" type="continuous"><origin xyz="0 0 0.5"/>
    <parent link="base"/><child link="table"/><axis xyz="0 0 1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="table"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="0.3" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="1 0 0"/>
    <parent link="upper"/><child link="forearm"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="grip" type="prismatic"><origin xyz="0.85 0.05 0"/>
    <parent link="forearm"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="grip_too" type="prismatic"><origin xyz="0.85 -0.05 0"/>
    <parent link="forearm"/><child link="right"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/><mimic joint="grip" multiplier="1" offset="0"/></joint>
</robot>"#;

/// A robot, and how its file says that it moves.
struct Robot {
    linkage: Linkage<Shape>,
    links: Vec<String>,
    /// The names and limits of the joints that are driven.
    driven: Vec<(String, [f64; 2])>,
    /// For each value of the linkage: the driven joint, and the factor and the offset by which the value follows it.
    follows: Vec<(usize, f64, f64)>,
}

impl Robot {
    fn new(urdf: &urdf_rs::Robot, folder: &Path) -> Result<Self, Failed> {
        // Joints are written in any order; a linkage has each after the joint that carries it.
        let (mut of_link, mut order): (HashMap<&str, usize>, Vec<&urdf_rs::Joint>) = (HashMap::new(), Vec::new());
        let is_child = |name: &str| urdf.joints.iter().any(|joint| joint.child.link == name);
        while let Some(next) = urdf.joints.iter().find(|joint| {
            let parent = joint.parent.link.as_str();
            !of_link.contains_key(joint.child.link.as_str()) && (of_link.contains_key(parent) || !is_child(parent))
        }) {
            of_link.insert(&next.child.link, order.len());
            order.push(next);
        }
        if order.len() < urdf.joints.len() {
            return Err("some joints hang in a loop".into());
        }
        let joints = order.iter().map(|joint| {
            let axis = DVec3::from_array(*joint.axis.xyz);
            let kind = match joint.joint_type {
                JointType::Revolute | JointType::Continuous => JointKind::Revolute(axis),
                JointType::Prismatic => JointKind::Prismatic(axis),
                JointType::Fixed => JointKind::Fixed,
                ref other => return Err(format!("a joint of type {other:?} is no single turn or slide")),
            };
            Ok(Joint { parent: of_link.get(joint.parent.link.as_str()).copied(), pose: pose(&joint.origin), kind })
        });
        let joints = joints.collect::<Result<Vec<_>, _>>()?;
        let links = urdf.links.iter().map(|link| {
            let bodies = link.collision.iter().map(|collision| {
                let Pose { translation, rotation } = pose(&collision.origin);
                Ok(Posed::new(shape(&collision.geometry, folder)?, rotation, translation)?)
            });
            let joint = of_link.get(link.name.as_str()).copied();
            Ok(Link { joint, bodies: bodies.collect::<Result<_, Failed>>()? })
        });
        let linkage = Linkage::new(joints, links.collect::<Result<Vec<_>, Failed>>()?)?;
        linkage.check_joints()?;
        let moving: Vec<_> = order.iter().filter(|joint| joint.joint_type != JointType::Fixed).collect();
        let leaders: Vec<_> = moving.iter().filter(|joint| joint.mimic.is_none()).collect();
        let follows = moving.iter().map(|joint| {
            let (name, factor, offset) = match &joint.mimic {
                None => (&joint.name, 1.0, 0.0),
                Some(mimic) => (&mimic.joint, mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0)),
            };
            let leader = leaders.iter().position(|leader| leader.name == *name);
            Ok((leader.ok_or_else(|| format!("{} mimics {name}, which is not driven", joint.name))?, factor, offset))
        });
        let follows = follows.collect::<Result<Vec<_>, String>>()?;
        let limits = |joint: &urdf_rs::Joint| match joint.joint_type {
            JointType::Continuous => [-f64::INFINITY, f64::INFINITY],
            _ => [joint.limit.lower, joint.limit.upper],
        };
        let driven = leaders.iter().map(|joint| (joint.name.clone(), limits(joint))).collect();
        Ok(Self { linkage, links: urdf.links.iter().map(|link| link.name.clone()).collect(), driven, follows })
    }

    /// The values of all joints that move, with those of the driven ones within their limits.
    fn values(&self, driven: &[f64]) -> Vec<f64> {
        let within = |k: usize| driven[k].clamp(self.driven[k].1[0], self.driven[k].1[1]);
        self.follows.iter().map(|&(leader, factor, offset)| factor * within(leader) + offset).collect()
    }
}

fn pose(origin: &urdf_rs::Pose) -> Pose<DVec3> {
    let [roll, pitch, yaw] = *origin.rpy;
    let rotation = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll);
    Pose { translation: DVec3::from_array(*origin.xyz), rotation: DQuat::from_mat3(&rotation) }
}

fn shape(geometry: &Geometry, folder: &Path) -> Result<Box<dyn SupportMap<Vector = DVec3>>, Failed> {
    // URDF has its axes along z, and the shapes here along y.
    let upright = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    Ok(match geometry {
        Geometry::Box { size } => Box::new(Cuboid::new(DVec3::from_array(**size) * 0.5)?),
        Geometry::Sphere { radius } => Box::new(Ball::new(*radius)?),
        Geometry::Capsule { radius, length } => {
            Box::new(Posed::new(Capsule::new(length * 0.5, *radius)?, upright, DVec3::ZERO)?)
        }
        Geometry::Cylinder { radius, length } => {
            Box::new(Posed::new(Cylinder::new(length * 0.5, *radius)?, upright, DVec3::ZERO)?)
        }
        Geometry::Mesh { filename, scale } => {
            let scale = scale.as_ref().map_or(DVec3::ONE, |scale| DVec3::from_array(**scale));
            let text = std::fs::read_to_string(folder.join(filename))?;
            let vertices = text.lines().filter_map(|line| line.strip_prefix("v ")).map(|line| {
                let numbers = line.split_whitespace().map(str::parse::<f64>).collect::<Result<Vec<_>, _>>()?;
                let [x, y, z] = numbers[..] else { return Err("a vertex has three coordinates".into()) };
                Ok(DVec3::new(x, y, z) * scale)
            });
            Box::new(Polytope::new(vertices.collect::<Result<Vec<_>, Failed>>()?)?)
        }
    })
}

fn main() -> Result<(), Failed> {
    let file = std::env::args().nth(1);
    let urdf = match &file {
        Some(file) => urdf_rs::read_file(file)?,
        None => urdf_rs::read_from_string(ARM)?,
    };
    let folder = file.as_ref().and_then(|file| Path::new(file).parent()).unwrap_or(Path::new(""));
    let robot = Robot::new(&urdf, folder)?;
    println!("{}:\n{}", urdf.name, robot.linkage);

    // A ball where the last link is when all joints are bent a little.
    let bent = vec![0.15; robot.driven.len()];
    let mut links = (0..robot.linkage.links()).rev();
    let last = links.find(|link| !robot.linkage.bodies(*link).is_empty()).ok_or("there is no collision shape")?;
    let at = robot.linkage.placed(last, 0, &robot.values(&bent))?.core().origin;
    let scene = Scene::new([Posed::translated(Ball::new(0.1)?, at)?])?;

    // From a way back to a way beyond: the robot meets the ball on its way.
    let at_part = |part: f64| robot.values(&bent.iter().map(|value| value * part).collect::<Vec<_>>());
    let (mut paths, ends) = (PathWorkspace::new(), [at_part(0.0), at_part(2.0)]);
    let path = robot.linkage.path(&ends, &scene, MotionCastOptions::new(), &mut paths)?;
    let (contact, hit) = path.contact().ok_or("the ball is on the way")?;
    println!("{} meets the ball at {:.6} of its way", robot.links[contact.link], hit.time);
    assert!(contact.cast.is_certain() && contact.cast.upper - contact.cast.lower < 1e-9, "{contact:?}");
    let start = [ends[0].clone(), at_part(2.0 * hit.time * 0.75)];
    let nearest = robot.linkage.path_clearance(&start, &scene, MotionClearanceOptions::new(), &mut paths)?;
    let nearest = nearest.nearest.ok_or("there is a ball")?;
    println!(
        "on three quarters of that way {} is {:.4} from it at least",
        robot.links[nearest.link], nearest.least.distance
    );
    assert!(nearest.least.lower > 0.0 && nearest.least.upper - nearest.least.lower < 1e-6, "{:?}", nearest.least);

    // How near it is half way to there, and one step by which it comes less near.
    let mut workspace = ConfigurationWorkspace::new();
    let mut near: Vec<f64> = bent.iter().map(|value| value * hit.time).collect();
    let mut ask = |driven: &[f64]| {
        let values = robot.values(driven);
        let least = robot.linkage.clearance(&values, &scene, SignedDistanceOptions::new(), &mut workspace)?;
        Ok::<_, Failed>((values, least.ok_or("there is a ball")?))
    };
    let (values, before) = ask(&near)?;
    let mut by_value = vec![0.0; values.len()];
    robot.linkage.clearance_gradient(&values, &before, &mut by_value)?;
    // By the driven joints: what mimics a joint moves with it.
    let mut gradient = vec![0.0; near.len()];
    for (&(leader, factor, _), by_value) in robot.follows.iter().zip(&by_value) {
        gradient[leader] += factor * by_value;
    }
    let length = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
    println!("{} is {:.4} from it; by joint:", robot.links[before.link], before.distance.signed_distance);
    for ((name, limits), (value, by)) in robot.driven.iter().zip(near.iter_mut().zip(&gradient)) {
        println!("  {name}: {by:.4}, within {limits:?}");
        *value += 0.01 * by / length;
    }
    let (_, after) = ask(&near)?;
    println!("a step of 0.01 along the gradient: {:.4}", after.distance.signed_distance);
    let gained = after.distance.signed_distance - before.distance.signed_distance;
    assert!((gained - 0.01 * length).abs() < 0.1 * 0.01 * length, "it gains {gained}, and not {}", 0.01 * length);
    // Whatever is asked of joints that mimic others, they follow.
    for (&(leader, factor, offset), value) in robot.follows.iter().zip(robot.values(&near)) {
        assert!((value - (factor * near[leader] + offset)).abs() < 1e-15, "{} is followed", robot.driven[leader].0);
    }
    Ok(())
}
