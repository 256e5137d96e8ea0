//! Torques along a path at four points at a time.

use super::joint_torques::JointTorques;
use crate::dynamics::{BodyOnPath, PathPoints, PathTerms};
use crate::math::Frame;
use crate::math::f64x4::F64x4;

/// Positions of all joints and their first two derivatives at four points, and memory for the torques there.
#[derive(Debug, Clone)]
pub(crate) struct FourTorquePoints {
    q: Vec<F64x4>,
    first: Vec<F64x4>,
    second: Vec<F64x4>,
    frames: Vec<Frame<F64x4>>,
    bodies: Vec<BodyOnPath>,
    terms: Vec<PathTerms>,
}

impl FourTorquePoints {
    pub fn new(torques: &JointTorques) -> Self {
        let frames = torques.robot().frame_buffer_four();
        let zero = vec![F64x4::ZERO; torques.dof()];
        let [q, first, second] = [zero.clone(), zero.clone(), zero];
        let none = PathTerms { hold: F64x4::ZERO, of_square: F64x4::ZERO, of_change: F64x4::ZERO };
        let (bodies, terms) = (vec![BodyOnPath::REST; frames.len()], vec![none; torques.dof()]);
        Self { q, first, second, frames, bodies, terms }
    }

    /// Sets one of the points: positions (n,) of the joints and their first two derivatives.
    pub fn set(&mut self, lane: usize, rows: [&[f64]; 3]) {
        let Self { q, first, second, .. } = self;
        for (lanes, row) in [q, first, second].into_iter().zip(rows) {
            lanes.iter_mut().zip(row).for_each(|(lanes, value)| lanes.0[lane] = *value);
        }
    }

    /// The terms of all joints.
    pub fn terms(&mut self, torques: &JointTorques) -> &[PathTerms] {
        let Self { q, first, second, frames, bodies, terms } = self;
        torques.robot().write_frames_four(q, frames);
        torques.dynamics().write_path_terms(&PathPoints { frames, first, second }, bodies, terms);
        terms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::UrdfOptions;
    use crate::rng;
    use crate::robot::Robot;

    /// Two fingers on an arm that turns, slides and turns; one finger follows the arm's first joint.
    fn hand() -> Robot {
        let mut links = String::new();
        for (i, name) in ["base", "upper", "slide", "palm", "left", "right"].into_iter().enumerate() {
            let k = i as f64;
            links += &format!(
                "<link name='{name}'><inertial><origin xyz='0.1 {} 0.05' rpy='0.3 {k} 0'/><mass value='{}'/>\
                 <inertia ixx='0.04' iyy='0.05' izz='0.03' ixy='0.002' ixz='-0.001' iyz='0.004'/></inertial></link>",
                0.02 * k,
                1.0 + 0.3 * k
            );
        }
        let joint = |name: &str, kind: &str, [parent, child]: [&str; 2], more: &str| {
            format!(
                "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>\
                 <origin xyz='0.1 -0.2 0.3' rpy='0.4 0.2 -0.7'/><axis xyz='0.6 0 0.8'/>\
                 <limit lower='-2' upper='2' velocity='2' effort='9'/>{more}</joint>"
            )
        };
        let joints = [
            joint("shoulder", "revolute", ["base", "upper"], ""),
            joint("lift", "prismatic", ["upper", "slide"], ""),
            joint("wrist", "revolute", ["slide", "palm"], ""),
            joint("left", "revolute", ["palm", "left"], ""),
            joint("right", "prismatic", ["palm", "right"], "<mimic joint='shoulder' multiplier='-0.5' offset='0.1'/>"),
        ];
        let urdf = format!("<robot name='hand'>{links}{}</robot>", joints.concat());
        let tips = vec!["left".to_owned(), "right".to_owned()];
        Robot::from_urdf_with(&urdf, &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap()
    }

    #[test]
    fn four_points_have_the_terms_of_each() {
        let robot = hand();
        let n = robot.dof();
        let torques = JointTorques::new(&robot, &vec![50.0; n], "this test").unwrap().unwrap();
        let mut rng = rng::stream(3, 1);
        let mut four = FourTorquePoints::new(&torques);
        // Twice, since the memory is used again.
        for _ in 0..2 {
            let mut row = || (0..n).map(|_| rng.uniform_in(-2.0, 2.0)).collect::<Vec<f64>>();
            let points: Vec<[Vec<f64>; 3]> = (0..4).map(|_| [row(), row(), row()]).collect();
            for (lane, point) in points.iter().enumerate() {
                four.set(lane, point.each_ref().map(|row| &row[..]));
            }
            let found = four.terms(&torques).to_vec();
            for (lane, [q, first, second]) in points.into_iter().enumerate() {
                let (mut at, mut terms) = (torques.point(), torques.terms());
                (at.q, at.first, at.second) = (q, first, second);
                torques.write_terms(&mut at, &mut terms);
                for (joint, found) in found.iter().enumerate() {
                    let found = [found.hold, found.of_square, found.of_change].map(|term| term.0[lane]);
                    let alone = [terms.hold[joint], terms.of_square[joint], terms.of_change[joint]];
                    for (found, alone) in found.iter().zip(alone) {
                        assert!((found - alone).abs() < 1e-11, "joint {joint}: {found} instead of {alone}");
                    }
                }
            }
        }
    }
}
