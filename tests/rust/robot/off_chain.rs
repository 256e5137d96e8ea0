//! Links and joints beside the chain: their poses, the joints that move them, and errors for those that cannot be held.

use ikcore::math::{Pose, pose};
use ikcore::nalgebra::Vector3;
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;

/// Torso with an arm of two joints, whose hand has two fingers that follow one joint, a camera that follows the elbow, and a
/// wheel below the torso.
const TREE: &str = r#"<robot name="tree">
  <link name="world"/> <link name="torso"/> <link name="upper"/> <link name="hand"/>
  <link name="left"/> <link name="right"/> <link name="camera"/> <link name="lens"/> <link name="wheel"/>
  <joint name="lift" type="prismatic"> <parent link="world"/> <child link="torso"/> <origin xyz="0 0 1"/> <axis xyz="0 0 1"/>
    <limit lower="0.2" upper="0.8"/> </joint>
  <joint name="shoulder" type="revolute"> <parent link="torso"/> <child link="upper"/> <origin xyz="0 0.3 0" rpy="0.1 0.2 0.3"/>
    <axis xyz="0 1 1"/> <limit lower="-2" upper="2"/> </joint>
  <joint name="elbow" type="revolute"> <parent link="upper"/> <child link="hand"/> <origin xyz="0.4 0 0"/>
    <axis xyz="0 1 0"/> <limit lower="-2" upper="2"/> </joint>
  <joint name="grip" type="prismatic"> <parent link="hand"/> <child link="left"/> <origin xyz="0.1 0 0"/> <axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04"/> </joint>
  <joint name="grip_too" type="prismatic"> <parent link="hand"/> <child link="right"/> <origin xyz="0.1 0 0"/>
    <axis xyz="0 1 0"/> <mimic joint="grip" multiplier="-1" offset="-0.001"/> </joint>
  <joint name="pan" type="continuous"> <parent link="upper"/> <child link="camera"/> <origin xyz="0 0 0.1"/> <axis xyz="1 2 0"/>
    <mimic joint="elbow" multiplier="0.5" offset="0.2"/> </joint>
  <joint name="focus" type="prismatic"> <parent link="camera"/> <child link="lens"/> <axis xyz="0 0 1"/>
    <mimic joint="shoulder" multiplier="0.1"/> </joint>
  <joint name="drive" type="floating"> <parent link="torso"/> <child link="wheel"/> <origin xyz="0 0 -0.5"/> </joint>
</robot>"#;

fn load(base: &str, tip: &str) -> Robot {
    Robot::from_urdf(TREE, Some(base), Some(tip)).unwrap()
}

fn assert_same(a: &Pose, b: &Pose, tolerance: f64) {
    let difference = (a.to_homogeneous() - b.to_homogeneous()).amax();
    assert!(difference <= tolerance, "poses differ by {difference:.3e}:\n{a}{b}");
}

fn place(robot: &Robot, link: &str, q: &[f64]) -> Pose {
    robot.link_fk(link, q).unwrap()
}

#[test]
fn links_beside_the_chain_are_kept_and_their_joints_held() {
    let arm = load("torso", "hand");
    assert_eq!(arm.link_names().collect::<Vec<_>>(), ["torso", "upper", "hand"]);
    let all = ["torso", "upper", "hand", "world", "wheel", "camera", "left", "right", "lens"];
    assert_eq!(arm.all_link_names().collect::<Vec<_>>(), all);
    let held: Vec<_> = arm.held_joints().iter().map(|held| (held.joint.name.as_str(), held.value)).collect();
    assert_eq!(held, [("lift", 0.2), ("grip", 0.0)]); // the lift at the limit nearest to zero

    let q = [0.4, -0.7];
    let hand = arm.fk(&q).unwrap();
    assert_same(&place(&arm, "hand", &q), &hand, 1e-15);
    assert_same(&place(&arm, "left", &q), &(hand * pose::translation(0.1, 0.0, 0.0)), 1e-15);
    assert_same(&place(&arm, "right", &q), &(hand * pose::translation(0.1, -0.001, 0.0)), 1e-15);
    assert_same(&place(&arm, "world", &q), &pose::translation(0.0, 0.0, -1.2), 1e-15);
    assert_same(&place(&arm, "wheel", &q), &pose::translation(0.0, 0.0, -0.5), 1e-15);
    let axis = Vector3::new(1.0, 2.0, 0.0).normalize();
    let camera = pose::translation(0.0, 0.0, 0.1) * pose::rotation(axis, 0.5 * q[1] + 0.2);
    assert_same(&place(&arm, "camera", &q), &(place(&arm, "upper", &q) * camera), 1e-15);
    let lens = place(&arm, "camera", &q) * pose::translation(0.0, 0.0, 0.1 * q[0]);
    assert_same(&place(&arm, "lens", &q), &lens, 1e-15);
}

#[test]
fn fingers_stand_where_they_are_held() {
    let arm = load("torso", "hand").with_held([("grip", 0.03), ("lift", 0.5)]).unwrap();
    let hand = arm.fk(&[0.0, 0.0]).unwrap();
    assert_same(&place(&arm, "right", &[0.0, 0.0]), &(hand * pose::translation(0.1, -0.031, 0.0)), 1e-15);
    assert_same(&place(&arm, "world", &[0.0, 0.0]), &pose::translation(0.0, 0.0, -1.5), 1e-15);
    let restored = Robot::from_bytes(&arm.to_bytes().unwrap()).unwrap();
    assert_eq!(restored, arm);
    assert_same(&place(&restored, "left", &[0.1, 0.2]), &place(&arm, "left", &[0.1, 0.2]), 0.0);
}

#[test]
fn every_choice_of_base_and_tip_places_all_links_alike() {
    let whole = load("world", "hand").with_held([("grip", 0.01)]).unwrap();
    let part = load("hand", "torso").with_held([("lift", 0.6), ("grip", 0.01)]).unwrap();
    // q of the first: lift, shoulder, elbow; of the second: elbow, shoulder.
    let (q, back) = ([0.6, 0.3, -0.8], [-0.8, 0.3]);
    let hand = place(&whole, "hand", &q);
    for link in whole.all_link_names() {
        assert_same(&place(&part, link, &back), &(hand.inverse() * place(&whole, link, &q)), 1e-14);
    }
    let turned = pose::from_rpy([0.2, 0.3, -0.5], [1.0, 2.0, 3.0]);
    let elsewhere = whole.with_base(turned).unwrap().with_tool(pose::translation(0.0, 0.0, 0.2)).unwrap();
    for link in ["wheel", "lens", "left", "hand"] {
        assert_same(&place(&elsewhere, link, &q), &(turned * place(&whole, link, &q)), 1e-14);
    }
}

#[test]
fn a_branch_that_leads_a_joint_of_the_chain_moves_with_it() {
    let xml = TREE.replace(
        "<axis xyz=\"0 1 0\"/> <limit lower=\"-2\" upper=\"2\"/>",
        "<axis xyz=\"0 1 0\"/> <mimic joint=\"grip\"/>",
    );
    let arm = Robot::from_urdf(&xml, Some("torso"), Some("hand")).unwrap();
    let names: Vec<_> = arm.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["shoulder", "grip"]);
    let q = [0.0, 0.02];
    let hand = arm.fk(&q).unwrap();
    assert_same(&place(&arm, "left", &q), &(hand * pose::translation(0.1, 0.02, 0.0)), 1e-15);
}

#[test]
fn jacobians_of_all_links_are_derivatives_of_their_poses() {
    let arm = load("world", "hand");
    let (q, h) = (vec![0.3, 0.4, -0.7], 1e-4);
    for link in arm.all_link_names() {
        let jacobian = arm.link_jacobian_all(link, &q).unwrap();
        let here = place(&arm, link, &q);
        for joint in 0..3 {
            let at = |step: f64| {
                let mut moved = q.clone();
                moved[joint] += step;
                place(&arm, link, &moved)
            };
            let (before, after) = (at(-h), at(h));
            let linear = (after.translation.vector - before.translation.vector) / (2.0 * h);
            let turn = (after.rotation * before.rotation.inverse()).scaled_axis() / (2.0 * h);
            for k in 0..3 {
                assert!((jacobian[k * 3 + joint] - linear[k]).abs() < 1e-7, "{link}, joint {joint}\n{here}");
                assert!((jacobian[(3 + k) * 3 + joint] - turn[k]).abs() < 1e-7, "{link}, joint {joint}");
            }
        }
    }
    let (tip, all) = (arm.jacobian(&q).unwrap(), arm.link_jacobian_all("hand", &q).unwrap());
    assert!((0..18).all(|i| (tip[(i / 3, i % 3)] - all[i]).abs() < 1e-14));
}

#[test]
fn many_configurations_are_placed_to_the_bits_of_one() {
    let arm = load("world", "hand");
    let qs = arm.random_configurations(11, &mut rng::stream(3, 0)).unwrap();
    for link in ["upper", "hand", "lens", "left", "world"] {
        let many = arm.link_fk_all(link, &qs).unwrap();
        for (q, rows) in qs.chunks(3).zip(many.chunks(16)) {
            assert_eq!(pose::rows(&place(&arm, link, q)), rows, "{link}");
        }
    }
    let poses = arm.all_link_poses(&qs[..3]).unwrap();
    for (link, found) in arm.all_link_names().zip(poses) {
        assert_eq!(found, place(&arm, link, &qs[..3]));
    }
}

#[test]
fn what_cannot_be_held_is_named() {
    let arm = load("torso", "hand");
    let message = |hold: (&str, f64)| arm.with_held([hold]).unwrap_err().to_string();
    let held = "joints that it holds: lift, grip";
    assert_eq!(message(("grap", 0.0)), format!("robot 'tree' holds no joint 'grap' (did you mean 'grip'?); {held}"));
    assert_eq!(message(("elbow", 0.0)), format!("robot 'tree' holds no joint 'elbow' (it is entry 1 of q); {held}"));
    assert_eq!(
        message(("grip", 0.05)),
        "hold: joint 'grip' at 0.05 is outside its limits [0, 0.04] by 0.01000 m: move it inside"
    );
    assert_eq!(message(("grip", f64::NAN)), "held joints must be finite, but joint 'grip' is NaN");
    let bare = Robot::planar(&[1.0]).unwrap().with_held([("x", 0.0)]).unwrap_err().to_string();
    assert_eq!(bare, "robot 'planar1' holds no joint 'x'; joints that it holds: none");
    let typo = arm.link_fk("cammera", &[0.0, 0.0]).unwrap_err().to_string();
    assert_eq!(
        typo,
        "robot 'tree' has no link 'cammera' (did you mean 'camera'?); its links: torso, upper, hand, world, wheel, camera, \
         left, right, lens"
    );
}

#[test]
fn a_branch_that_nobody_needs_may_be_broken() {
    let cases = [
        ("mimic joint=\"grip\"", "mimic joint=\"nothing\""),
        ("mimic joint=\"grip\"", "mimic joint=\"grip_too\""),
        ("mimic joint=\"grip\"", "mimic joint=\"drive\""),
        ("<limit lower=\"0\" upper=\"0.04\"/>", "<limit lower=\"1\" upper=\"-1\"/>"),
    ];
    for (from, to) in cases {
        assert!(TREE.contains(from));
        let arm = Robot::from_urdf(&TREE.replace(from, to), Some("torso"), Some("hand")).unwrap();
        let hand = arm.fk(&[0.1, 0.2]).unwrap();
        assert_same(&place(&arm, "right", &[0.1, 0.2]), &(hand * pose::translation(0.1, 0.0, 0.0)), 0.0011);
    }
}

#[test]
fn a_hundred_thousand_links_and_mimics_load() {
    let count = 100_000;
    let mut xml = String::from("<robot name='comb'><link name='base'/><link name='tip'/>");
    xml += "<joint name='j' type='continuous'><parent link='base'/><child link='tip'/><axis xyz='0 0 1'/></joint>";
    for i in 0..count {
        // Each mimic follows the next one, and the last the joint of the chain.
        let master = if i + 1 < count { format!("m{}", i + 1) } else { "j".into() };
        xml += &format!(
            "<link name='l{i}'/><joint name='m{i}' type='continuous'><parent link='base'/><child link='l{i}'/>\
             <axis xyz='0 0 1'/><mimic joint='{master}'/></joint>"
        );
    }
    xml += "</robot>";
    let comb = Robot::from_urdf(&xml, None, Some("tip")).unwrap();
    assert_eq!((comb.dof(), comb.all_link_names().count()), (1, count + 2));
    assert_same(&place(&comb, "l0", &[0.3]), &pose::rotation(Vector3::z(), 0.3), 1e-12);
}

#[test]
fn a_grasped_part_moves_with_its_link_and_may_touch_what_it_is_told_to() {
    let arm = Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap();
    let part = Shape::cuboid([0.0, 0.0, 0.1], [0.02, 0.04, 0.3], None).unwrap();
    let carrying = arm.with_attached("flange", &part, &["link_5"], None).unwrap();
    let body = carrying.capsules().last().unwrap();
    assert_eq!(body.link, "attached");
    for (end, z) in [(body.a, -0.05), (body.b, 0.25)] {
        assert!(end[0] == 0.0 && end[1] == 0.0 && (end[2] - z).abs() < 1e-15, "{end:?}");
    }
    assert!((body.radius - 0.01_f64.hypot(0.02)).abs() < 1e-15);
    let q = [0.1, 0.2, 0.3, -1.5, 0.4, 1.2, 0.5];
    assert_same(&place(&carrying, "attached", &q), &arm.fk(&q).unwrap(), 1e-14);
    let tested = |robot: &Robot, one: &str| robot.collision_pairs().iter().any(|pair| pair.contains(&one));
    assert!(tested(&carrying, "attached") && !tested(&arm, "attached"));
    assert!(!carrying.collision_pairs().contains(&["link_5", "attached"]));
    assert!(
        arm.with_attached("flange", &part, &[], None).unwrap().collision_pairs().len() > arm.collision_pairs().len()
    );
    let second = carrying.with_attached("link_7", &part, &[], None).unwrap();
    assert_eq!(second.capsules().last().unwrap().link, "attached_2");
    let floor = Shape::half_space([0.0, 0.0, 1.0], 0.0).unwrap();
    assert_eq!(
        arm.with_attached("flange", &floor, &[], None).unwrap_err().to_string(),
        "a HalfSpace cannot be attached: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh can"
    );
    let flat = Shape::ellipse([0.0, 0.0], [0.2, 0.1], 0.0).unwrap();
    let refused = arm.with_attached("flange", &flat, &[], None).unwrap_err().to_string();
    assert!(refused.starts_with("an Ellipse cannot be attached: a Sphere"), "{refused}");
    let taken = arm.with_attached("flange", &part, &[], Some("link_3")).unwrap_err().to_string();
    assert_eq!(taken, "robot 'panda': two links are named 'link_3'");
    assert!(arm.with_attached("flang", &part, &[], None).unwrap_err().to_string().contains("did you mean 'flange'?"));
}

#[test]
fn attached_shapes_are_held_by_their_capsules() {
    let turn = Some(*pose::from_rpy([0.3, -0.5, 0.7], [0.0; 3]).rotation.matrix());
    let points: Vec<[f64; 3]> =
        (0..40).map(f64::from).map(|i| [i.sin(), 0.4 * (2.0 * i).cos(), 0.3 * (3.0 * i).sin()]).collect();
    let shapes = [
        Shape::cuboid([0.1, 0.2, 0.3], [0.3, 0.9, 0.2], turn).unwrap(),
        Shape::ellipsoid([0.1, 0.2, 0.3], [0.3, 0.9, 0.2], turn).unwrap(),
        Shape::cylinder([0.1, 0.2, 0.3], [1.0, 2.0, 3.0], 0.2, 0.7).unwrap(),
        Shape::convex_mesh(&points).unwrap(),
    ];
    for shape in shapes {
        let robot = Robot::planar(&[1.0]).unwrap().with_attached("tip", &shape, &[], Some("part")).unwrap();
        let capsule = &robot.capsules()[0];
        let (a, b) = (Vector3::from(capsule.a), Vector3::from(capsule.b));
        for point in shape.triangles().into_iter().flatten().map(Vector3::from) {
            let along = ((point - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            let distance = (a + along * (b - a) - point).norm();
            assert!(distance <= capsule.radius + 1e-9, "{}: {distance} > {}", shape.name(), capsule.radius);
        }
    }
}
