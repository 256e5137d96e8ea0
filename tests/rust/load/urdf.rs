//! URDF reader: exact error messages, and chains that move as described in the file.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::PathBuf;

use ikcore::ik::{SolveOptions, solve};
use ikcore::load::{CollisionShapes, UrdfOptions};
use ikcore::math::{Pose, pose};
use ikcore::nalgebra::{Isometry3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use ikcore::robot::{JointKind, Robot, VisualShape};
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;
use proptest::prelude::*;

/// Three links in a row: `a` turns about a tilted, unnormalised axis, `b` slides.
const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="upper"/>
  <link name="hand"/>
  <joint name="a" type="revolute">
    <origin xyz="0.1 0.2 0.3" rpy="0.4 -0.5 0.6"/>
    <parent link="base"/> <child link="upper"/>
    <axis xyz="0 3 4"/>
    <limit lower="-1" upper="2" velocity="1.5"/>
  </joint>
  <joint name="b" type="prismatic">
    <origin xyz="0 0 1"/>
    <parent link="upper"/> <child link="hand"/>
    <axis xyz="0 0 -2"/>
    <limit lower="0" upper="0.5" velocity="0.2"/>
  </joint>
</robot>"#;

fn load(xml: &str) -> Robot {
    Robot::from_urdf(xml, None, None).unwrap()
}

/// Message of the error of `ARM` after one replacement.
fn error_after(from: &str, to: &str) -> String {
    assert!(ARM.contains(from), "nothing to replace: {from}");
    error(&ARM.replacen(from, to, 1))
}

fn error(xml: &str) -> String {
    Robot::from_urdf(xml, None, None).unwrap_err().to_string()
}

fn assert_same(a: &Pose, b: &Pose, tolerance: f64) {
    let difference = (a.to_homogeneous() - b.to_homogeneous()).amax();
    assert!(difference <= tolerance, "poses differ by {difference:.3e}:\n{a}{b}");
}

/// Robot of these links, one a line, and joints in short: (name, attributes of the joint, parent, child, elements).
fn robot(links: &[&str], joints: &[(&str, &str, &str, &str, &str)]) -> String {
    let mut xml = String::from("<robot name=\"r\">\n");
    for link in links {
        xml += &format!("<link name=\"{link}\"/>\n");
    }
    for (name, kind, parent, child, rest) in joints {
        xml += &format!(
            "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{rest}</joint>\n"
        );
    }
    xml + "</robot>"
}

#[test]
fn chain_moves_as_the_file_says() {
    let arm = load(ARM);
    assert_eq!(arm.name(), "arm");
    assert_eq!(arm.link_names().collect::<Vec<_>>(), ["base", "upper", "hand"]);
    assert_eq!(arm.joints()[0].kind, JointKind::Revolute);
    assert_eq!((arm.joints()[1].lower, arm.joints()[1].upper, arm.joints()[1].velocity), (0.0, 0.5, 0.2));
    let expected = pose::from_rpy([0.4, -0.5, 0.6], [0.1, 0.2, 0.3])
        * pose::rotation(Vector3::new(0.0, 0.6, 0.8), 0.7)
        * pose::translation(0.0, 0.0, 1.0 - 0.2);
    assert_same(&arm.fk(&[0.7, 0.2]).unwrap(), &expected, 1e-15);
}

#[test]
fn roll_pitch_yaw_turn_about_fixed_axes() {
    let xml = ARM.replace("0.4 -0.5 0.6", &format!("{FRAC_PI_2} 0 {FRAC_PI_2}"));
    let upright = Robot::from_urdf(&xml, None, Some("upper")).unwrap().fk(&[0.0]).unwrap();
    // Roll takes z to -y, yaw takes -y to x.
    assert!((upright.rotation * Vector3::z() - Vector3::x()).amax() < 1e-15);
}

#[test]
fn base_need_not_be_an_ancestor_of_the_tip() {
    let (down, up) = (load(ARM), Robot::from_urdf(ARM, Some("hand"), Some("base")).unwrap());
    assert_eq!(up.link_names().collect::<Vec<_>>(), ["hand", "upper", "base"]);
    assert_eq!(up.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["b", "a"]);
    assert_same(&up.fk(&[0.2, 0.7]).unwrap(), &down.fk(&[0.7, 0.2]).unwrap().inverse(), 1e-15);
}

#[test]
fn two_branches_meet_at_their_common_link() {
    let joints = [
        ("trunk", "revolute", "root", "chest", ""),
        ("left", "continuous", "chest", "left_hand", "<origin xyz='0 1 0'/><axis xyz='0 0 1'/>"),
        ("right", "continuous", "chest", "right_hand", "<origin xyz='0 -1 0'/><axis xyz='0 0 1'/>"),
    ];
    let xml = robot(&["root", "chest", "left_hand", "right_hand"], &joints);
    let across = Robot::from_urdf(&xml, Some("left_hand"), Some("right_hand")).unwrap();
    assert_eq!(across.link_names().collect::<Vec<_>>(), ["left_hand", "chest", "right_hand"]);
    let expected = (pose::translation(0.0, 1.0, 0.0) * pose::rotation(Vector3::z(), 0.3)).inverse()
        * pose::translation(0.0, -1.0, 0.0)
        * pose::rotation(Vector3::z(), 0.5);
    assert_same(&across.fk(&[0.3, 0.5]).unwrap(), &expected, 1e-15);

    let branch = Robot::from_urdf(&xml, Some("left_hand"), None).unwrap_err().to_string();
    assert_eq!(branch, "URDF: base and tip are both 'left_hand': a chain needs two links");
    assert_eq!(
        error(&xml),
        "robot 'r' ends in 2 links: say which one is the tip; leaves, by number of joints: left_hand (2), right_hand (2)"
    );
    let typo = Robot::from_urdf(&xml, None, Some("left_hnd")).unwrap_err().to_string();
    assert_eq!(
        typo,
        "robot 'r' has no link 'left_hnd' (did you mean 'left_hand'?); its links: root, chest, left_hand, right_hand"
    );
}

#[test]
fn mimic_joints_follow_through_chains_of_mimics() {
    let slide = "<axis xyz='1 0 0'/><limit lower='-1' upper='1' velocity='1'/>";
    let second = format!("{slide}<mimic joint='first' multiplier='-2' offset='0.1'/>");
    let third = format!("{slide}<mimic joint='second' multiplier='0.5' offset='0.3'/>");
    let xml = robot(
        &["l0", "l1", "l2", "l3"],
        &[
            ("third", "prismatic", "l0", "l1", &third),
            ("first", "prismatic", "l1", "l2", slide),
            ("second", "prismatic", "l2", "l3", &second),
        ],
    );
    let arm = load(&xml);
    assert_eq!(arm.dof(), 1);
    // second = 0.1 - 2 q, third = 0.5 second + 0.3 = 0.35 - q.
    let q = 0.17;
    let x = arm.fk(&[q]).unwrap().translation.x;
    assert!((x - (q + (0.1 - 2.0 * q) + (0.35 - q))).abs() < 1e-15, "{x}");
    let back = Robot::from_urdf(&xml, Some("l3"), Some("l0")).unwrap();
    assert_same(&back.fk(&[q]).unwrap(), &arm.fk(&[q]).unwrap().inverse(), 1e-15);
    // second in [-1, 1] leaves [-0.45, 0.55] and half the speed; third in [-1, 1] leaves [-0.65, 1.35].
    let joint = &arm.joints()[0];
    assert_eq!(joint.name, "first");
    assert!((joint.lower + 0.45).abs() < 1e-15 && (joint.upper - 0.55).abs() < 1e-15 && joint.velocity == 0.5);
}

#[test]
fn mimic_joints_follow_by_polynomials() {
    let slide = "<axis xyz='1 0 0'/><limit lower='-1' upper='1' velocity='1'/>";
    let free = "<axis xyz='1 0 0'/><limit lower='-20' upper='20'/>";
    let mimic = |rest: &str| format!("{free}<mimic {rest}/>");
    let [line, bend, along] = [
        mimic("joint='first' multiplier='-2' offset='0.1'"),
        mimic("joint='line' polynomial='0.2 0.5 -0.3 0.1 0.05' multiplier='2' offset='0.4'"),
        mimic("joint='bend' multiplier='3' offset='-0.1'"),
    ];
    let links = ["l0", "l1", "l2", "l3", "beside"];
    let joints = [
        ("along", "prismatic", "l0", "l1", along.as_str()),
        ("first", "prismatic", "l1", "l2", slide),
        ("bend", "prismatic", "l2", "l3", &bend),
        ("line", "prismatic", "l2", "beside", &line),
    ];
    let xml = robot(&links, &joints);
    let arm = Robot::from_urdf(&xml, None, Some("l3")).unwrap();
    let place = |q: f64| {
        let line = 0.1 - 2.0 * q;
        let polynomial = 0.2 + 0.5 * line - 0.3 * line.powi(2) + 0.1 * line.powi(3) + 0.05 * line.powi(4);
        let bend = 2.0 * polynomial + 0.4;
        (q + bend + (3.0 * bend - 0.1), line)
    };
    assert_eq!(arm.dof(), 1);
    for q in [-1.0, -0.4, 0.0, 0.7, 1.0] {
        let (x, line) = place(q);
        let reached = arm.fk(&[q]).unwrap();
        assert!((reached.translation.x - x).abs() < 1e-13, "{q}");
        let beside =
            arm.link_fk("beside", &[q]).unwrap().translation.x - arm.link_fk("l2", &[q]).unwrap().translation.x;
        assert!((beside - line).abs() < 1e-14);
        let back = Robot::from_urdf(&xml, Some("l3"), Some("l0")).unwrap();
        assert_same(&back.fk(&[q]).unwrap(), &reached.inverse(), 1e-13);
    }
    // The polynomial holds within the limits of its leader, whatever these are, and 2 cm beyond; then come its tangents.
    let wide = arm.with_limits(|_, joint| joint.upper = 2.0).unwrap();
    let [at, slope] = [place(1.02).0, (place(1.02 + 1e-6).0 - place(1.02 - 1e-6).0) / 2e-6];
    let [here, there] = [&arm, &wide].map(|arm| arm.fk(&[1.5]).unwrap().translation.x);
    assert!((here - (at + 0.48 * slope)).abs() < 1e-8 && (there - place(1.5).0).abs() < 1e-12, "{here} {there}");
}

#[test]
fn a_follower_by_a_polynomial_limits_its_leader() {
    let range = |rest: &str| format!("<axis xyz='1 0 0'/><limit {rest}/>");
    let loaded = |leader: &str, follower: &str| {
        let follower = format!("{}<mimic joint='lead' polynomial='0 0 0.5'/>", range(follower));
        let leader = range(leader);
        let joints = [("lead", "prismatic", "l0", "l1", leader.as_str()), ("bend", "prismatic", "l1", "l2", &follower)];
        Robot::from_urdf(&robot(&["l0", "l1", "l2"], &joints), None, None)
    };
    let leader = "lower='-1' upper='1' velocity='3'";
    // Slope 1.02 at 2 cm beyond the limits.
    let speed = loaded(leader, "lower='0' upper='1' velocity='2.04'").unwrap().joints()[0].velocity;
    assert!((speed - 2.0).abs() < 1e-6, "{speed}");
    for (leader, follower, message) in [
        (
            leader,
            "lower='0' upper='0.4'",
            "URDF line 6: mimic joint 'bend' moves from 0 to 0.5 while 'lead', which it follows by a polynomial, is inside its limits, \
             and leaves its own, [0, 0.4]: narrow the limits of 'lead'",
        ),
        (
            leader,
            "lower='0' upper='1' acceleration='2'",
            "URDF line 6: mimic joint 'bend' follows 'lead' by a polynomial: limits of its acceleration and jerk are not followed",
        ),
        (
            "velocity='3'",
            "velocity='3'",
            "robot 'r': a joint follows joint 'lead' by a polynomial: give 'lead' position limits",
        ),
    ] {
        assert_eq!(loaded(leader, follower).unwrap_err().to_string(), message);
    }
}

#[test]
fn a_polynomial_of_a_polynomial_is_refused_by_name() {
    let turn = "<axis xyz='0 0 1'/><limit lower='-1' upper='1'/>";
    let bent = |leader: &str| format!("<axis xyz='0 0 1'/><mimic joint='{leader}' polynomial='0 1 1'/>");
    let (inner, outer) = (bent("lead"), bent("inner"));
    // On the chain, and beside it.
    for (ends, tip) in [(["l2", "l3"], "l3"), (["l1", "l3"], "l2")] {
        let joints = [
            ("lead", "revolute", "l0", "l1", turn),
            ("inner", "continuous", "l1", "l2", inner.as_str()),
            ("outer", "continuous", ends[0], ends[1], &outer),
        ];
        let told = Robot::from_urdf(&robot(&["l0", "l1", "l2", "l3"], &joints), Some("l0"), Some(tip));
        assert_eq!(
            told.unwrap_err().to_string(),
            "URDF line 8: joint 'outer' follows joint 'inner' by a polynomial, which follows joint 'lead' by a polynomial: at most one of \
             both is followed"
        );
    }
}

#[test]
fn links_of_absurd_length_are_refused() {
    let said = error_after("0.1 0.2 0.3", "0 1e160 0");
    assert!(said.ends_with("its links are 1e160 m long together, more than 1e150 m"), "{said}");
}

#[test]
fn a_follower_of_factor_zero_stands_at_its_offset() {
    for (kind, place) in [("prismatic", [0.0, 0.0, 0.3]), ("revolute", [0.0; 3])] {
        let axis = "<axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1'/>";
        let follower = format!("{axis}<mimic joint='turn' multiplier='0' offset='0.3'/>");
        let joints = [("turn", "revolute", "l0", "l1", axis), ("follower", kind, "l1", "l2", &follower)];
        let arm = load(&robot(&["l0", "l1", "l2"], &joints));
        let pose = arm.fk(&[0.2]).unwrap();
        let turn = if kind == "revolute" { 0.5 } else { 0.2 };
        assert_same(&pose, &(pose::translation(0.0, 0.0, place[2]) * pose::rotation(Vector3::z(), turn)), 1e-15);
        let solution = solve(&arm, &Target::from(&pose), &SolveOptions::default(), &mut Unattended).unwrap();
        assert_eq!(solution.status, Status::Solved);
    }
}

#[test]
fn a_master_off_the_chain_is_set_by_its_first_mimic_joint() {
    let turn = "<axis xyz='0 0 1'/>";
    let follower = format!("{turn}<limit lower='-1' upper='3' velocity='2'/><mimic joint='master' multiplier='2'/>");
    let joints = [
        ("first", "continuous", "l0", "l1", turn),
        ("follower", "revolute", "l1", "l2", &follower),
        ("last", "continuous", "l2", "l3", turn),
        ("master", "continuous", "l0", "elsewhere", turn),
    ];
    let xml = robot(&["l0", "l1", "l2", "l3", "elsewhere"], &joints);
    let arm = Robot::from_urdf(&xml, None, Some("l3")).unwrap();
    assert_eq!(arm.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["first", "master", "last"]);
    let master = &arm.joints()[1];
    assert_eq!((master.kind, master.lower, master.upper, master.velocity), (JointKind::Revolute, -0.5, 1.5, 1.0));
    let expected = pose::rotation(Vector3::z(), 0.1 + 2.0 * 0.2 + 0.3);
    assert_same(&arm.fk(&[0.1, 0.2, 0.3]).unwrap(), &expected, 1e-15);
}

#[test]
fn missing_limits_are_told_from_zeros() {
    let limits = |limit: &str| {
        let arm = load(&ARM.replace("<limit lower=\"-1\" upper=\"2\" velocity=\"1.5\"/>", limit));
        (arm.joints()[0].lower, arm.joints()[0].upper, arm.joints()[0].velocity)
    };
    let free = (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY);
    assert_eq!(limits("<limit effort='10'/>"), free);
    assert_eq!(
        error_after("<limit lower=\"-1\" upper=\"2\" velocity=\"1.5\"/>", ""),
        "URDF line 5: joint 'a' is revolute and has no <limit>, which URDF requires: give lower and upper, or write \
         <joint type=\"continuous\">"
    );
    assert_eq!(
        error_after("<limit lower=\"0\" upper=\"0.5\" velocity=\"0.2\"/>", ""),
        "URDF line 11: joint 'b' is prismatic and has no <limit>, which URDF requires: give lower and upper, perhaps -inf and \
         inf"
    );
    assert_eq!(limits("<limit upper='0.5' velocity='1'/>"), (0.0, 0.5, 1.0));
    assert_eq!(limits("<limit lower='0' upper='0' velocity='0'/>"), (0.0, 0.0, 0.0));
    assert_eq!(limits("<limit lower='-inf' upper='1' velocity='inf'/>"), (f64::NEG_INFINITY, 1.0, f64::INFINITY));
}

#[test]
fn tags_beyond_kinematics_are_ignored() {
    let noise = r#"<robot name="arm" xmlns:sensor="http://example.org/sensor">
  <material name="grey"><color rgba="a b c d"/></material>
  <sensor:camera fov="${not xacro}"/> <gazebo><joint name="nothing"/></gazebo> <transmission/>
  <visual><geometry><mesh filename="package://nowhere/x.dae"/><blob/></geometry></visual>"#;
    let xml = ARM.replace("<robot name=\"arm\">", noise);
    let xml = format!("\n\n<?xml version='1.0' encoding='latin-1'?>\n<!-- <robot> -->{xml}");
    let q = [0.3, 0.1];
    assert_eq!(load(&xml).fk(&q).unwrap(), load(ARM).fk(&q).unwrap());
}

#[test]
fn deep_nesting_does_not_exhaust_the_stack() {
    let depth = 100_000;
    let nested = format!("<robot name=\"arm\">{}{}", "<x>".repeat(depth), "</x>".repeat(depth));
    assert_eq!(load(&ARM.replace("<robot name=\"arm\">", &nested)).dof(), 2);
}

#[test]
fn names_may_hold_any_character() {
    let xml = ARM.replace("\"upper\"", "\"u&amp;p &lt;&quot;p'er&gt; ü\"");
    let arm = Robot::from_urdf(&xml, None, Some("u&p <\"p'er> ü")).unwrap();
    assert_eq!(arm.link_names().last(), Some("u&p <\"p'er> ü"));
}

#[test]
fn text_that_is_no_urdf_is_refused() {
    assert_eq!(error("<robot>\n<link></robot>"), "URDF line 2: not XML: expected 'link' tag, not 'robot' at 2:7");
    assert_eq!(error("<sdf/>"), "URDF line 1: the outermost element must be <robot>, found <sdf>");
    assert_eq!(
        error("<robot name='r'><link name='a'/></robot>"),
        "URDF line 1: <robot> has no <joint>: a chain needs at least one that moves"
    );
    assert_eq!(
        error("<robot name='r'><foo:bar/></robot>"),
        "URDF line 1: the namespace prefix 'foo' is not declared: add xmlns:foo=\"foo\" to <robot>"
    );
    assert_eq!(error("no/such.urdf"), "cannot read 'no/such.urdf': No such file or directory (os error 2)");
}

#[test]
fn xacro_says_how_to_expand_it() {
    let expand = "run `xacro robot.xacro > robot.urdf` and load the result";
    let element = "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'>\n<xacro:include filename='a'/></robot>";
    assert_eq!(error(element), format!("URDF line 2: <xacro:include> is not expanded: {expand}"));
    assert_eq!(error("<robot><xacro:arm/></robot>"), format!("URDF line 1: xacro is not expanded: {expand}"));
    assert_eq!(error_after("0 3 4", "0 ${y} 4"), format!("URDF line 8: xyz=\"0 ${{y}} 4\" is not expanded: {expand}"));
    for ending in [".xacro", ".urdf.xacro"] {
        let file = std::env::temp_dir().join(format!("ikcore-{}.v2{ending}", std::process::id()));
        std::fs::write(&file, ARM).unwrap();
        let path = file.display().to_string();
        let message = error(&path);
        std::fs::remove_file(&file).unwrap();
        let urdf = path.replace(ending, ".urdf");
        assert_eq!(message, format!("URDF: '{path}' is a xacro file: run `xacro {path} > {urdf}` and load the result"));
    }
}

#[test]
fn impossible_joints_are_named() {
    let cases = [
        (
            "0.1 0.2 0.3",
            "0.1 nan 0.3",
            "line 6: origin xyz of joint 'a' must be 3 finite numbers separated by spaces, got '0.1 nan 0.3'",
        ),
        (
            "0.4 -0.5 0.6",
            "0.4 -0.5",
            "line 6: origin rpy of joint 'a' must be 3 finite numbers separated by spaces, got '0.4 -0.5'",
        ),
        ("0 3 4", "0 0 0", "line 5: axis of joint 'a' is zero: it must have a direction"),
        ("lower=\"-1\"", "lower=\"low\"", "line 9: limit lower of joint 'a' must be a number, got 'low'"),
        ("name=\"b\"", "name=\"a\"", "line 11: a second joint is named 'a'"),
        ("name=\"hand\"", "name=\"base\"", "line 4: a second link is named 'base'"),
        (
            "link=\"hand\"",
            "link=\"hnad\"",
            "line 11: child link 'hnad' of joint 'b' does not exist (did you mean 'hand'?); links: base, upper, hand",
        ),
        ("link=\"hand\"", "link=\"base\"", "line 11: the joints form a cycle: base -> upper -> base"),
        ("parent link=\"upper\"", "parent link=\"hand\"", "line 11: the joints form a cycle: hand -> hand"),
        (
            "type=\"prismatic\"",
            "type=\"Prismatic\"",
            "line 11: joint 'b' has the unknown type 'Prismatic' (did you mean 'prismatic'?); \
             types: revolute, continuous, prismatic, fixed, floating, planar, spherical",
        ),
        (
            "type=\"revolute\"",
            "type=\"floating\"",
            "line 5: joint 'a' is floating, \
             and a chain takes only revolute, continuous, prismatic, fixed and mimic joints: \
             take base and tip on one side of it, a base from 'upper' on or a tip up to 'base'",
        ),
        (
            "<origin xyz=\"0 0 1\"/>",
            "<origin quat_xyzw=\"0 0 0 1\"/>",
            "line 12: origin quat_xyzw of joint 'b' is not supported: write it as rpy",
        ),
        (
            "<axis xyz=\"0 0 -2\"/>",
            "<mimic joint=\"c\"/>",
            "line 11: joint 'b' mimics 'c', which does not exist; joints: a, b",
        ),
        ("<axis xyz=\"0 0 -2\"/>", "<mimic joint=\"b\"/>", "line 11: mimic joints follow in a circle: b -> b"),
        (
            "<axis xyz=\"0 0 -2\"/>",
            "<mimic joint=\"a\" offset=\"9\"/>",
            "line 11: mimic joint 'b' allows its master 'a' only [-9, -8.5], which is outside [-1, 2]",
        ),
        (
            "<axis xyz=\"0 0 -2\"/>",
            "<mimic joint=\"a\" multiplier=\"inf\"/>",
            "line 14: mimic multiplier of joint 'b' must be finite, got 'inf'",
        ),
        (
            "<axis xyz=\"0 0 -2\"/>",
            "<mimic joint=\"a\" polynomial=\"0 1 2 3 4 5\"/>",
            "line 14: mimic polynomial of joint 'b' must be one to five finite numbers, got '0 1 2 3 4 5'",
        ),
        ("type=\"revolute\"", "", "line 5: joint 'a' has no attribute type=\"...\""),
        ("<parent link=\"base\"/>", "", "line 5: joint 'a' has no <parent link=\"...\"/>"),
    ];
    for (from, to, message) in cases {
        assert_eq!(error_after(from, to), format!("URDF {message}"), "after {from} -> {to}");
    }
    assert_eq!(error_after("lower=\"-1\"", "lower=\"3\""), "joint 'a': lower limit 3 is above upper limit 2");
}

#[test]
fn graphs_that_are_no_trees_are_refused() {
    assert_eq!(
        error_after("<link name=\"base\"/>", "<link name=\"base\"/><link name=\"world\"/>"),
        "URDF: no joint leads to any of the links 'base', 'world': a tree has one root"
    );
    let loops = robot(
        &["a", "b", "c"],
        &[("ab", "fixed", "a", "b", ""), ("bc", "fixed", "b", "c", ""), ("ac", "fixed", "a", "c", "")],
    );
    assert_eq!(error(&loops), "URDF line 7: link 'c' is the child of two joints, 'bc' and 'ac': a tree has no loops");
    let stiff = robot(&["a", "b"], &[("ab", "fixed", "a", "b", "<axis xyz='0 0 0'/>")]);
    assert_eq!(error(&stiff), "URDF: no joint moves between base 'a' and tip 'b'");
}

#[test]
fn only_joints_on_the_chain_are_judged() {
    let joints = [
        ("good", "continuous", "l0", "l1", ""),
        ("odd", "revolute", "l1", "l2", "<axis xyz='0 0 0'/><limit lower='1' upper='-1'/><mimic joint='gone'/>"),
    ];
    let xml = robot(&["l0", "l1", "l2"], &joints);
    assert_eq!(Robot::from_urdf(&xml, None, Some("l1")).unwrap().dof(), 1);
    assert!(Robot::from_urdf(&xml, None, Some("l2")).is_err());
}

#[test]
fn axes_of_any_length_point_the_same_way() {
    let turned = |axis: &str| load(&ARM.replace("0 3 4", axis)).fk(&[0.7, 0.2]).unwrap();
    for axis in ["0 0.6 0.8", "0 3e-200 4e-200", "0 3e200 4e200"] {
        assert_same(&turned(axis), &turned("0 3 4"), 1e-15);
    }
}

/// Name, base, tip and degrees of freedom of the robots beside the repository.
const REAL: [(&str, &str, &str, usize); 9] = [
    ("iiwa14", "base_link", "tool0", 7),
    ("panda", "panda_link0", "panda_link8", 7),
    ("ur5", "base_link", "tool0", 6),
    ("kr210", "base_link", "tool0", 6),
    ("gen3", "base_link", "end_effector_link", 7),
    ("sawyer", "base", "right_hand", 7),
    ("jaco2_6", "j2n6s300_link_base", "j2n6s300_end_effector", 6),
    ("jaco2_7", "base", "j2s7s300_link_7", 7),
    ("atlas", "utorso", "r_hand", 7),
];

#[test]
fn real_robots_load_stripped_and_in_full() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/robots");
    if !folder.is_dir() {
        println!("skipped: no {}", folder.display());
        return;
    }
    for (name, base, tip, dof) in REAL {
        let load = |file: PathBuf| Robot::from_urdf(&file.display().to_string(), Some(base), Some(tip)).unwrap();
        let stripped = load(folder.join(format!("{name}.urdf")));
        assert_eq!(stripped.dof(), dof, "{name}");
        let full = folder.join(format!("full/{name}.urdf"));
        if full.exists() {
            let full = load(full);
            let q: Vec<f64> = (0..dof).map(|i| (1.0 + i as f64).sin() * PI).collect();
            assert_same(&full.fk(&q).unwrap(), &stripped.fk(&q).unwrap(), 1e-15);
        }
    }
}

proptest! {
    /// Text files with random damage: the result is a robot or an error.
    #[test]
    fn no_text_makes_it_panic(
        cuts in prop::collection::vec(
            (any::<prop::sample::Index>(), 0..12_usize, "[<>/\"'&; a-c0-9.eE=${}\n-]{0,6}"),
            1..4,
        ),
    ) {
        let mut text: Vec<char> = ARM.replace("<axis xyz=\"0 0 -2\"/>", "<mimic joint=\"a\"/>").chars().collect();
        for (at, length, insertion) in cuts {
            let start = at.index(text.len());
            let end = (start + length).min(text.len());
            text.splice(start..end, insertion.chars());
        }
        let text: String = text.into_iter().collect();
        if let Ok(robot) = Robot::from_urdf(&text, None, None) {
            prop_assert!(robot.fk(&vec![0.1; robot.dof()]).is_ok());
        }
    }
}

#[test]
fn collision_shapes_become_capsules_that_hold_them() {
    let text = r#"<robot name="arm"><link name="base"/>
      <link name="upper">
        <collision><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision>
        <collision><geometry><sphere radius="0.2"/></geometry></collision>
      </link>
      <link name="fore"><collision><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>
        <geometry><box size="0.8 0.3 0.4"/></geometry></collision></link>
      <link name="hand"><collision><geometry><mesh filename="hand.stl"/></geometry></collision>
        <collision><geometry><sphere radius="-1"/></geometry></collision></link>
      <joint name="a" type="revolute"><parent link="base"/><child link="upper"/><limit lower="-1" upper="1" velocity="1"/></joint>
      <joint name="b" type="revolute"><parent link="upper"/><child link="fore"/><limit lower="-1" upper="1" velocity="1"/></joint>
      <joint name="c" type="fixed"><parent link="fore"/><child link="hand"/></joint></robot>"#;
    let robot = Robot::from_urdf(text, None, None).unwrap();
    let [cylinder, ball, block] = robot.capsules() else { panic!("{:?}", robot.capsules()) };
    assert_eq!(
        (cylinder.link.as_str(), cylinder.a, cylinder.b, cylinder.radius),
        ("upper", [0.0; 3], [0.0, 0.0, 1.0], 0.1)
    );
    assert_eq!((ball.a, ball.b, ball.radius), ([0.0; 3], [0.0; 3], 0.2));
    assert!(
        (block.radius - 0.25).abs() < 1e-15 && (block.a[1] + 0.4).abs() < 1e-15 && (block.b[1] - 0.4).abs() < 1e-15
    );
    assert_eq!(robot.unread_collision_shapes(), ["a mesh of link 'hand'", "a sphere of link 'hand'"]);
    let restored = Robot::from_bytes(&robot.to_bytes().unwrap()).unwrap();
    assert!(restored == robot && restored.unread_collision_shapes() == robot.unread_collision_shapes());
    let message = ikcore::obstacle::Scene::new(&robot, &[]).unwrap_err().to_string();
    assert!(
        message.starts_with("robot 'arm' has collision shapes that cannot be read (a mesh of link 'hand', a sphere")
    );
    assert!(message.ends_with(
        ": load its URDF with shapes fitted to its meshes, which covers meshes too; giving it the capsules that it has keeps the \
         shapes that were read and leaves these out; giving it more of them covers them too"
    ));
    let given = robot.with_capsules(vec![cylinder.clone()]).unwrap();
    assert!(
        ikcore::obstacle::Scene::new(&given, &[]).is_ok(),
        "capsules that are given replace what could not be read"
    );
}

/// Links of the large robots: an algorithm quadratic in them takes minutes.
const MANY: usize = 100_000;

/// Robot of [`MANY`] links; joint i leads from link `parent(i)` to link i.
fn large(kind: &str, parent: impl Fn(usize) -> usize) -> String {
    let mut xml = String::from("<robot name='large'>\n<link name='link_0'/>\n");
    for i in 1..MANY {
        let kind = if i == 1 { "continuous" } else { kind };
        xml += &format!(
            "<link name='link_{i}'/>\n<joint name='joint_{i}' type='{kind}'><parent link='link_{}'/><child link='link_{i}'/>\
             </joint>\n",
            parent(i)
        );
    }
    xml + "</robot>"
}

#[test]
fn loading_is_linear_in_the_links() {
    let row = load(&large("fixed", |i| i - 1));
    assert_eq!((row.dof(), row.link_names().count()), (1, MANY));

    // A row with a leaf on each link.
    let comb = large("fixed", |i| if i % 2 == 0 { i - 2 } else { i - 1 });
    let says = error(&comb);
    let start =
        "robot 'large' ends in 50000 links: say which one is the tip; leaves, by number of joints: link_1 (1), link_3";
    assert!(says.starts_with(start) && says.len() < 600, "{says}");
    let robot = Robot::from_urdf(&comb, None, Some("link_1")).unwrap();
    assert_eq!(robot.dof(), 1);

    let moving = error(&large("revolute", |i| i - 1));
    assert_eq!(moving, "robot 'large': 99999 moving joints between base and tip; at most 64 are supported");
}

#[test]
fn mistakes_in_large_robots_are_found_at_once() {
    // Line 2 has the root, line 2 i + 1 has joint i.
    let circle = large("fixed", |i| if i == 1 { MANY - 1 } else { i - 1 });
    assert_eq!(error(&circle), "URDF line 4: the joints form a cycle of 99999 links through 'link_1'");
    let odd = large("fixed", |i| i - 1).replace("name='joint_90000' type='fixed'", "name='joint_90000' type='odd'");
    let says = error(&odd);
    assert!(says.starts_with("URDF line 180002: joint 'joint_90000' has the unknown type 'odd'; types: "), "{says}");
    let missing = Robot::from_urdf(&large("fixed", |i| i - 1), None, Some("hand")).unwrap_err().to_string();
    assert!(missing.starts_with("robot 'large' has no link 'hand'; its links: link_0, link_1, "), "{missing}");
    assert!(missing.len() < 600, "{missing}");
}

#[test]
fn arms_come_first_among_the_tips() {
    let joints = [
        ("wheel", "continuous", "root", "wheel", ""),
        ("torso", "prismatic", "root", "chest", "<limit lower='0' upper='1'/>"),
        ("camera_mount", "fixed", "chest", "camera", ""),
        ("shoulder", "continuous", "chest", "upper", ""),
        ("elbow", "continuous", "upper", "lower", ""),
        ("grip", "fixed", "lower", "tool", ""),
        ("finger", "prismatic", "lower", "finger", "<mimic joint='elbow'/>"),
    ];
    let links = ["root", "wheel", "chest", "camera", "upper", "lower", "tool", "finger"];
    assert_eq!(
        error(&robot(&links, &joints)),
        "robot 'r' ends in 4 links: say which one is the tip; leaves, by number of joints: tool (3), finger (3), \
         wheel (1), camera (1)"
    );
}

#[test]
fn messages_repeat_no_more_than_a_line_of_a_file() {
    let long = "1 ".repeat(1_000_000);
    let says = error_after("0.1 0.2 0.3", &long);
    assert!(says.len() < 400 && says.ends_with("...'"), "{} characters", says.len());
}

/// Tip pose by urdf-rs and a product of transforms, for joints in chain order.
fn tip_by_urdf_rs(xml: &str, q: &[f64]) -> Pose {
    let mut values = q.iter();
    let mut tip = Isometry3::identity();
    for joint in urdf_rs::read_from_string(xml).unwrap().joints {
        let ([x, y, z], [roll, pitch, yaw]) = (joint.origin.xyz.0, joint.origin.rpy.0);
        let turned = UnitQuaternion::from(Rotation3::from_euler_angles(roll, pitch, yaw));
        tip *= Isometry3::from_parts(Translation3::new(x, y, z), turned);
        let axis = Unit::new_normalize(Vector3::from(joint.axis.xyz.0));
        match joint.joint_type {
            urdf_rs::JointType::Revolute => tip *= UnitQuaternion::from_axis_angle(&axis, *values.next().unwrap()),
            urdf_rs::JointType::Prismatic => tip *= Translation3::from(axis.scale(*values.next().unwrap())),
            _ => {}
        }
    }
    pose::from_parts(tip.translation.vector.into(), tip.rotation.to_rotation_matrix().into_inner())
}

proptest! {
    #[test]
    fn the_tip_is_where_urdf_rs_puts_it(
        origins in prop::collection::vec(prop::array::uniform6(-3.0..3.0), 5),
        axes in prop::collection::vec(prop::array::uniform3(0.1..1.0), 5),
        q in prop::collection::vec(-1.0..1.0, 4),
    ) {
        let kinds = ["revolute", "prismatic", "fixed", "revolute", "revolute"];
        let links: Vec<String> = (0..6).map(|i| format!("l{i}")).collect();
        let mut xml = String::from("<robot name='r'>");
        links.iter().for_each(|link| xml += &format!("<link name='{link}'/>"));
        for (i, ([x, y, z, roll, pitch, yaw], [ax, ay, az])) in origins.iter().zip(&axes).enumerate() {
            xml += &format!(
                "<joint name='j{i}' type='{}'><origin xyz='{x} {y} {z}' rpy='{roll} {pitch} {yaw}'/><parent link='l{i}'/>\
                 <child link='l{}'/><axis xyz='{ax} {ay} {az}'/><limit lower='-2' upper='2' velocity='1' effort='1'/></joint>",
                kinds[i],
                i + 1,
            );
        }
        xml += "</robot>";
        assert_same(&load(&xml).fk(&q).unwrap(), &tip_by_urdf_rs(&xml, &q), 1e-12);
    }
}

/// Cube of 0.2 m about the origin, as STL text.
fn cube() -> String {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|bit| if bit == 1 { 0.1 } else { -0.1 });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = String::from("solid cube\n");
    for [a, b, c, d] in quads {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle.map(corner) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid cube\n"
}

/// Temporary folder, removed afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("beetle-ik-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, text: &str) -> String {
        let file = self.0.join(name);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, text).unwrap();
        file.to_str().unwrap().to_owned()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn with_mesh(file: &str) -> String {
    ARM.replace(
        "<link name=\"hand\"/>",
        &format!(
            "<link name='hand'><collision><origin xyz='0 0 1'/><geometry><mesh filename='{file}' scale='2 1 1'/></geometry>\
             </collision></link>"
        ),
    )
}

fn fitted(path: &str, package_dirs: Vec<String>) -> ikcore::Result<Robot> {
    let options = UrdfOptions { collision: CollisionShapes::Fit, package_dirs, ..UrdfOptions::default() };
    Robot::from_urdf_with(path, &options)
}

#[test]
fn meshes_are_covered_from_outside_by_few_capsules() {
    let folder = Folder::new("fit");
    folder.write("arms/meshes/cube.stl", &cube());
    let file = folder.write("arms/urdf/arm.urdf", &with_mesh("package://arms/meshes/cube.stl"));
    let robot = fitted(&file, vec![]).unwrap(); // the package is found above the file
    assert!(robot.unread_collision_shapes().is_empty() && !robot.capsules().is_empty());
    assert!(robot.capsules().iter().all(|capsule| capsule.link == "hand"));
    let [fit] = robot.mesh_fits() else { panic!("{:?}", robot.mesh_fits()) };
    assert_eq!((fit.link.as_str(), fit.file.as_str()), ("hand", "package://arms/meshes/cube.stl"));
    assert!(fit.volume_ratio > 1.0 && fit.volume_ratio < 3.0 && fit.largest_distance > 0.0, "{fit:?}");
    // Every corner of the box of 0.4 x 0.2 x 0.2 m, 1 m along z of the hand, is held.
    for corner in 0..8 {
        let sign = |bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let point = Vector3::new(0.2 * sign(0), 0.1 * sign(1), 1.0 + 0.1 * sign(2));
        let held = robot.capsules().iter().any(|capsule| {
            let (a, b) = (Vector3::from(capsule.a), Vector3::from(capsule.b));
            let along = if a == b { 0.0 } else { ((point - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0) };
            (a + along * (b - a) - point).norm() <= capsule.radius + 1e-9
        });
        assert!(held, "{point}");
    }
    let restored = Robot::from_bytes(&robot.to_bytes().unwrap()).unwrap();
    assert_eq!(restored.mesh_fits(), robot.mesh_fits());
}

#[test]
fn packages_are_found_in_given_folders() {
    let (packages, elsewhere) = (Folder::new("packages"), Folder::new("elsewhere"));
    packages.write("arms/meshes/cube.stl", &cube());
    let file = elsewhere.write("arm.urdf", &with_mesh("package://arms/meshes/cube.stl"));
    let root = packages.0.to_str().unwrap().to_owned();
    assert!(fitted(&file, vec![root.clone()]).is_ok());
    assert!(fitted(&file, vec![format!("{root}/arms")]).is_ok(), "the folder may be the package");
    elsewhere.write("cube.stl", &cube());
    let beside = elsewhere.write("beside.urdf", &with_mesh("cube.stl"));
    assert!(fitted(&beside, vec![]).is_ok());
    let message = fitted(&file, vec![]).unwrap_err().to_string();
    let says = "URDF: the mesh 'package://arms/meshes/cube.stl' of link 'hand' is not found: give package_dirs, or \
                primitive shapes alone to do without; looked for ";
    assert!(message.starts_with(&format!("{file}: {says}")), "{message}");
    // Nobody needs it otherwise.
    let robot = Robot::from_urdf(&file, None, None).unwrap();
    assert_eq!(robot.unread_collision_shapes(), ["a mesh of link 'hand'"]);
    let options = UrdfOptions { collision: CollisionShapes::Ignored, ..UrdfOptions::default() };
    assert!(Robot::from_urdf_with(&file, &options).unwrap().unread_collision_shapes().is_empty());
}

#[test]
fn visual_shapes_have_places_and_colours_and_outlive_changes_of_bodies() {
    let text = r#"<robot name="arm"><material name="blue"><color rgba="0 0 1 0.5"/></material>
      <link name="base"><visual><geometry><mesh filename="base.dae" scale="2 1 1"/></geometry><origin xyz="0 0 1"/>
        <material name="blue"/></visual></link>
      <link name="hand"><visual><geometry><sphere radius="0.1"/></geometry><material name="own"><color rgba="1 0 0 1"/></material>
        </visual><visual><geometry><box size="1 1"/></geometry></visual>
        <visual><geometry><box size="1 1 1"/></geometry><material name="unknown"/></visual></link>
      <joint name="a" type="continuous"><parent link="base"/><child link="hand"/></joint></robot>"#;
    let robot = load(text);
    let [mesh, ball, block] = robot.visuals() else { panic!("{:?}", robot.visuals()) };
    let VisualShape::Mesh { path, scale, origin } = &mesh.shape else { panic!("{mesh:?}") };
    assert_eq!((path.as_str(), scale), ("base.dae", &[2.0, 1.0, 1.0]));
    assert_same(origin, &pose::translation(0.0, 0.0, 1.0), 0.0);
    assert_eq!((mesh.link.as_str(), mesh.color), ("base", Some([0.0, 0.0, 1.0, 0.5])));
    assert_eq!((ball.link.as_str(), ball.color), ("hand", Some([1.0, 0.0, 0.0, 1.0])));
    assert!(matches!(&block.shape, VisualShape::Solid(_)) && block.color.is_none());
    assert_eq!(robot.with_capsules_along_links(0.1).unwrap().visuals(), robot.visuals());
    assert!(Robot::from_bytes(&robot.to_bytes().unwrap()).unwrap() == robot);
    assert_eq!(Robot::from_urdf(text, Some("hand"), Some("base")).unwrap().visuals().len(), 3);
}
