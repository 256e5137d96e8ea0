//! Groups of joints that move independently of each other: a torso, and each of the arms on it.

use crate::robot::Robot;

/// Returns the joints of each group: joints that carry the same ends of the robot. A single arm is one group.
pub(super) fn joint_groups(robot: &Robot) -> Vec<Vec<usize>> {
    let elements: Vec<(usize, usize)> =
        robot.moving_elements().map(|(parent, _, motion)| (parent, motion.joint)).collect();
    let is_end = |frame: &usize| elements.iter().all(|(parent, _)| parent != frame);
    let mut carried: Vec<Vec<usize>> = vec![vec![]; robot.dof()];
    for end in (1..=elements.len()).filter(is_end) {
        let mut at = end;
        while at > 0 {
            let (parent, joint) = elements[at - 1];
            if carried[joint].last() != Some(&end) {
                carried[joint].push(end);
            }
            at = parent;
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![];
    for joint in 0..carried.len() {
        match groups.iter_mut().find(|group| carried[group[0]] == carried[joint]) {
            Some(group) => group.push(joint),
            None => groups.push(vec![joint]),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::UrdfOptions;

    /// A URDF with these joints (name, parent, child), all turning.
    fn robot(joints: &[(&str, &str, &str)], tips: &[&str]) -> Robot {
        let links = ["base"].into_iter().chain(joints.iter().map(|(_, _, child)| *child));
        let links: String = links.map(|link| format!("<link name=\"{link}\"/>")).collect();
        let joint = |(name, parent, child): &(&str, &str, &str)| {
            format!(
                "<joint name=\"{name}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
                 <origin xyz=\"0.1 0 0\"/><axis xyz=\"0 0 1\"/>\
                 <limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"1\"/></joint>"
            )
        };
        let joints: String = joints.iter().map(joint).collect();
        let options =
            UrdfOptions { tips: tips.iter().map(|tip| (*tip).to_owned()).collect(), ..UrdfOptions::default() };
        Robot::from_urdf_with(&format!("<robot name=\"r\">{links}{joints}</robot>"), &options).unwrap()
    }

    #[test]
    fn a_torso_and_each_of_its_arms_are_groups() {
        let joints = [
            ("turn", "base", "torso"),
            ("left_1", "torso", "left_a"),
            ("left_2", "left_a", "left_b"),
            ("right_1", "torso", "right_a"),
            ("right_2", "right_a", "right_b"),
        ];
        let groups = joint_groups(&robot(&joints, &["left_b", "right_b"]));
        assert_eq!(groups, [vec![0], vec![1, 2], vec![3, 4]]);
    }

    #[test]
    fn arms_without_a_torso_are_two_groups_and_one_arm_is_one() {
        let joints = [("left", "base", "left_a"), ("right", "base", "right_a")];
        assert_eq!(joint_groups(&robot(&joints, &["left_a", "right_a"])), [vec![0], vec![1]]);
        let panda = Robot::named("panda").unwrap();
        assert_eq!(joint_groups(&panda), [(0..panda.dof()).collect::<Vec<_>>()]);
    }
}
