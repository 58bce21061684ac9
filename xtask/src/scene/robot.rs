//! A robot from a URDF file: which links have a body, and where they are for given joint values.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use convex_support::glam::{DMat3, DQuat, DVec3};
use urdf_rs::{Geometry, JointType};

/// A rigid motion: rotate, then translate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub(super) rotation: DQuat,
    pub(super) translation: DVec3,
}

impl Pose {
    const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// First `inner`, then `self`.
    fn after(self, inner: Self) -> Self {
        Self {
            rotation: (self.rotation * inner.rotation).normalize(),
            translation: self.rotation * inner.translation + self.translation,
        }
    }

    /// A frame as URDF writes it: roll, pitch and yaw about the fixed axes, in this order.
    fn of(urdf: &urdf_rs::Pose) -> Self {
        let [roll, pitch, yaw] = *urdf.rpy;
        let rotation = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll);
        Self { rotation: DQuat::from_mat3(&rotation), translation: DVec3::from_array(*urdf.xyz) }
    }
}

/// A link that has a mesh.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) name: String,
    pub(super) mesh: PathBuf,
    /// The frame of the mesh in that of the link.
    origin: Pose,
    /// The place of its frame among all frames of the robot.
    frame: usize,
}

/// A frame of the robot, hung from an earlier one by a joint.
#[derive(Clone, Debug)]
struct Frame {
    /// None for the root.
    parent: Option<usize>,
    origin: Pose,
    motion: Motion,
    /// The column of the joint among the joint values.
    column: Option<usize>,
}

#[derive(Clone, Copy, Debug)]
enum Motion {
    Fixed,
    Revolute(DVec3),
    Prismatic(DVec3),
}

/// The links with a mesh, and the tree of frames that carries them.
#[derive(Clone, Debug)]
pub(super) struct Robot {
    pub(super) links: Vec<Link>,
    frames: Vec<Frame>,
}

impl Robot {
    /// Reads the robot; `joints` names the joint values it will be given. Joints that are not named stay at 0.
    pub(super) fn read(path: &Path, joints: &[String]) -> Result<Self, String> {
        let robot = urdf_rs::read_file(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
        if let Some(name) = joints.iter().find(|name| !robot.joints.iter().any(|j| j.name == **name)) {
            return Err(format!("{} has no joint {name:?}", path.display()));
        }
        let (frames, of_link) = frames(&robot, joints)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut links = Vec::new();
        for link in &robot.links {
            for collision in &link.collision {
                let Geometry::Mesh { filename, scale: None } = &collision.geometry else {
                    return Err(format!("the collision shape of {} is not a mesh in its own size", link.name));
                };
                links.push(Link {
                    name: link.name.clone(),
                    mesh: folder.join(filename),
                    origin: Pose::of(&collision.origin),
                    frame: of_link[link.name.as_str()],
                });
            }
        }
        Ok(Self { links, frames })
    }

    /// Where the meshes of the links are in the frame of the root, for these joint values.
    pub(super) fn poses(&self, values: &[f64]) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::with_capacity(self.frames.len());
        for frame in &self.frames {
            let value = frame.column.map_or(0.0, |column| values[column]);
            let moved = match frame.motion {
                Motion::Fixed => Pose::IDENTITY,
                Motion::Revolute(axis) => {
                    Pose { rotation: DQuat::from_axis_angle(axis, value), translation: DVec3::ZERO }
                }
                Motion::Prismatic(axis) => Pose { rotation: DQuat::IDENTITY, translation: axis * value },
            };
            let parent = frame.parent.map_or(Pose::IDENTITY, |parent| poses[parent]);
            poses.push(parent.after(frame.origin).after(moved));
        }
        self.links.iter().map(|link| poses[link.frame].after(link.origin)).collect()
    }
}

/// The frames in an order in which parents come first, and the place of each link's among them.
fn frames<'r>(robot: &'r urdf_rs::Robot, joints: &[String]) -> Result<(Vec<Frame>, HashMap<&'r str, usize>), String> {
    let mut frames = Vec::new();
    let mut places = HashMap::new();
    for link in robot.links.iter().filter(|link| !robot.joints.iter().any(|j| j.child.link == link.name)) {
        places.insert(link.name.as_str(), frames.len());
        frames.push(Frame { parent: None, origin: Pose::IDENTITY, motion: Motion::Fixed, column: None });
    }
    // Each pass hangs at least one more joint onto what is there, or none ever will be.
    let mut waiting: Vec<&urdf_rs::Joint> = robot.joints.iter().collect();
    while !waiting.is_empty() {
        let before = waiting.len();
        let mut still = Vec::new();
        for joint in waiting {
            let Some(&parent) = places.get(joint.parent.link.as_str()) else {
                still.push(joint);
                continue;
            };
            let axis = DVec3::from_array(*joint.axis.xyz).normalize_or_zero();
            let motion = match joint.joint_type {
                JointType::Fixed => Motion::Fixed,
                JointType::Revolute | JointType::Continuous if axis != DVec3::ZERO => Motion::Revolute(axis),
                JointType::Prismatic if axis != DVec3::ZERO => Motion::Prismatic(axis),
                _ => return Err(format!("the joint {} neither turns nor slides along one axis", joint.name)),
            };
            places.insert(joint.child.link.as_str(), frames.len());
            frames.push(Frame {
                parent: Some(parent),
                origin: Pose::of(&joint.origin),
                motion,
                column: joints.iter().position(|name| *name == joint.name),
            });
        }
        waiting = still;
        if waiting.len() == before {
            return Err(format!("the joint {} hangs from no link of the robot", waiting[0].name));
        }
    }
    Ok((frames, places))
}
