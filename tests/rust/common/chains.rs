//! Random chains of all kinds of joints, described twice: for the library, and as plain 4x4 matrices.

use ikcore::math::{Pose, pose};
use ikcore::nalgebra::{Matrix4, Rotation3, Translation3, Unit, Vector3};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};

/// Element of the reference chain.
#[derive(Debug, Clone)]
pub enum Part {
    Fixed(Matrix4<f64>),
    Moving { kind: JointKind, axis: Vector3<f64>, joint: usize, drive: Drive },
    Link,
}

/// Robot, and the same chain as a list of matrices to multiply.
#[derive(Debug)]
pub struct RandomChain {
    pub robot: Robot,
    pub parts: Vec<Part>,
    pub base: Matrix4<f64>,
    pub tool: Matrix4<f64>,
}

const KINDS: [JointKind; 3] = [JointKind::Revolute, JointKind::Continuous, JointKind::Prismatic];

impl RandomChain {
    /// Chain of `joints` independent joints; about a third are followed by a mimic of an earlier one while there are fewer than
    /// `moving` moving elements.
    pub fn new(seed: u64, joints: usize, moving: usize) -> Self {
        let rng = &mut rng::stream(seed, joints as u64);
        let mut builder = ChainBuilder::new(format!("chain{joints}"), "base");
        let mut parts = vec![Part::Link];
        let mut elements = 0;
        for j in 0..joints {
            let kind = KINDS[index(rng, 3)];
            builder.add_joint(Joint::new(format!("joint_{j}"), kind).with_range(-2.0, 2.0));
            append(&mut builder, &mut parts, rng, kind, j, Drive::DIRECT);
            elements += 1;
            if rng.uniform() < 0.33 && elements + (joints - j - 1) < moving {
                let drive = Drive { scale: rng.uniform_in(-2.0, 2.0), offset: rng.uniform_in(-1.0, 1.0) };
                let master = index(rng, j + 1);
                let kind = KINDS[index(rng, 3)];
                append(&mut builder, &mut parts, rng, kind, master, drive);
                elements += 1;
            }
        }
        let (base, tool) = (random_pose(rng), random_pose(rng));
        let robot = builder.build().unwrap().with_base(base).unwrap().with_tool(tool).unwrap();
        Self { robot, parts, base: base.to_homogeneous(), tool: tool.to_homogeneous() }
    }

    /// Tip pose by multiplication of 4x4 matrices from base to tool.
    pub fn fk(&self, q: &[f64]) -> Matrix4<f64> {
        self.link_poses(q).last().unwrap() * self.tool
    }

    /// Pose of every link by the same multiplication.
    pub fn link_poses(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let mut reached = self.base;
        let mut links = vec![];
        for part in &self.parts {
            match part {
                Part::Fixed(transform) => reached *= transform,
                Part::Moving { kind, axis, joint, drive } => {
                    let value = drive.scale * q[*joint] + drive.offset;
                    reached *= if kind.turns() {
                        Rotation3::from_axis_angle(&Unit::new_normalize(*axis), value).to_homogeneous()
                    } else {
                        Translation3::from(axis.normalize() * value).to_homogeneous()
                    };
                }
                Part::Link => links.push(reached),
            }
        }
        links
    }
}

/// Appends a constant transform, a motion about or along any axis, and a link.
fn append(
    builder: &mut ChainBuilder,
    parts: &mut Vec<Part>,
    rng: &mut LazyRng,
    kind: JointKind,
    joint: usize,
    drive: Drive,
) {
    let (transform, axis) = (random_pose(rng), random_vector(rng, 3.0));
    builder.fixed(transform);
    builder.moving(joint, kind, axis, drive);
    builder.link(format!("link_{}", parts.len()));
    parts.extend([Part::Fixed(transform.to_homogeneous()), Part::Moving { kind, axis, joint, drive }, Part::Link]);
}

fn random_pose(rng: &mut LazyRng) -> Pose {
    let place = random_vector(rng, 0.4);
    pose::translation(place.x, place.y, place.z)
        * pose::rotation(random_vector(rng, 1.0).normalize(), rng.uniform_in(-3.0, 3.0))
}

fn random_vector(rng: &mut LazyRng, reach: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.uniform_in(-reach, reach))
}

fn index(rng: &mut LazyRng, count: usize) -> usize {
    (rng.uniform() * count as f64) as usize
}
