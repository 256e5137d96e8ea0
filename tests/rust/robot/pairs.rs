//! Pairs of links in self-collision tests: found by sampling, from an SRDF, or given.

use ikcore::robot::{LinkCapsule, Robot};

/// Arm with a shapeless wrist, a hand, and a finger that is held.
const ARM: &str = r#"<robot name="arm">
  <link name="base"> <collision> <geometry> <sphere radius="0.12"/> </geometry> </collision> </link>
  <link name="upper"> <collision> <origin xyz="0.2 0 0"/> <geometry> <sphere radius="0.1"/> </geometry> </collision> </link>
  <link name="lower"> <collision> <origin xyz="0.2 0 0"/> <geometry> <sphere radius="0.1"/> </geometry> </collision> </link>
  <link name="wrist"/>
  <link name="hand"> <collision> <geometry> <sphere radius="0.05"/> </geometry> </collision> </link>
  <link name="finger"> <collision> <origin xyz="0.05 0 0"/> <geometry> <sphere radius="0.02"/> </geometry> </collision> </link>
  <joint name="a" type="revolute"> <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3"/> </joint>
  <joint name="b" type="revolute"> <parent link="upper"/> <child link="lower"/> <origin xyz="0.4 0 0"/> <axis xyz="0 0 1"/>
    <limit lower="-2.9" upper="2.9"/> </joint>
  <joint name="c" type="revolute"> <parent link="lower"/> <child link="wrist"/> <origin xyz="0.4 0 0"/> <axis xyz="0 0 1"/>
    <limit lower="-2" upper="2"/> </joint>
  <joint name="d" type="revolute"> <parent link="wrist"/> <child link="hand"/> <axis xyz="1 0 0"/>
    <limit lower="-2" upper="2"/> </joint>
  <joint name="e" type="prismatic"> <parent link="hand"/> <child link="finger"/> <axis xyz="1 0 0"/>
    <limit lower="0" upper="0.04"/> </joint>
</robot>"#;

fn arm() -> Robot {
    Robot::from_urdf(ARM, None, Some("hand")).unwrap()
}

fn srdf(inner: &str) -> String {
    format!("<robot name='arm'>{inner}</robot>")
}

#[test]
fn neighbours_and_links_that_move_together_are_not_tested() {
    // Upper and lower arm are neighbours, as are lower arm and hand, for the wrist has no body; finger and hand move together,
    // and the elbow does not fold so far that they come near the upper arm.
    assert_eq!(arm().collision_pairs(), [["base", "lower"], ["base", "hand"], ["base", "finger"]]);
    assert_eq!(arm().collision_pairs(), arm().collision_pairs());
}

#[test]
fn links_that_always_touch_or_never_meet_are_not_tested() {
    let ball = |link: &str, radius: f64| LinkCapsule { link: link.into(), a: [0.0; 3], b: [0.0; 3], radius };
    // The upper arm reaches the hand wherever that is; the base is too small for any link to come near it.
    let large = arm().with_capsules(vec![ball("base", 0.01), ball("lower", 0.01), ball("hand", 0.9)]).unwrap();
    assert!(large.collision_pairs().is_empty(), "{:?}", large.collision_pairs());
    let small = arm().with_capsules(vec![ball("base", 0.05), ball("lower", 0.01), ball("hand", 0.05)]).unwrap();
    assert_eq!(small.collision_pairs(), [["base", "hand"]]); // folded back, the hand comes near the base
}

#[test]
fn an_srdf_disables_pairs_and_names_stances() {
    let text = srdf(
        "<disable_collisions link1='hand' link2='base' reason='Never'/> <disable_collisions link1='upper' link2='lower'/>
         <disable_collisions link1='lower' link2='hand'/> <disable_collisions link1='camera' link2='base'/>
         <group_state name='ready' group='arm'> <joint name='a' value='0.1'/> <joint name='b' value='0.2'/>
           <joint name='c' value='-0.3'/> <joint name='d' value='0'/> </group_state>
         <group_state name='open' group='gripper'> <joint name='e' value='0.04'/> </group_state>",
    );
    let robot = arm().with_srdf(&text).unwrap();
    let expected = [["base", "lower"], ["base", "finger"], ["upper", "hand"], ["upper", "finger"], ["lower", "finger"]];
    // Base and upper arm always touch: the SRDF need not say so.
    assert_eq!(robot.collision_pairs(), expected);
    assert_eq!(robot.stances().len(), 1);
    assert_eq!((robot.stances()[0].name.as_str(), &robot.stances()[0].q[..]), ("ready", &[0.1, 0.2, -0.3, 0.0][..]));
    let restored = Robot::from_bytes(&robot.to_bytes().unwrap()).unwrap();
    assert!(restored == robot && restored.collision_pairs() == expected && restored.stances() == robot.stances());
    let silent = arm().with_srdf(&srdf("<virtual_joint name='v'/>")).unwrap();
    assert_eq!(silent.collision_pairs(), arm().collision_pairs());
}

#[test]
fn an_srdf_may_disable_a_link_and_enable_some_of_its_pairs() {
    let text = srdf(
        "<disable_default_collisions link='finger'/> <enable_collisions link1='base' link2='finger'/>
         <disable_collisions link1='upper' link2='lower'/> <disable_collisions link1='lower' link2='hand'/>",
    );
    let robot = arm().with_srdf(&text).unwrap();
    assert_eq!(robot.collision_pairs(), [["base", "lower"], ["base", "hand"], ["base", "finger"], ["upper", "hand"]]);
}

#[test]
fn given_pairs_replace_all_others() {
    let pair = |one: &str, other: &str| [one.to_owned(), other.to_owned()];
    let robot = arm().with_collision_pairs(vec![pair("hand", "base")]).unwrap();
    assert_eq!(robot.collision_pairs(), [["base", "hand"]]);
    assert!(arm().with_collision_pairs(vec![]).unwrap().collision_pairs().is_empty());
    let unknown = arm().with_collision_pairs(vec![pair("hand", "bass")]).unwrap_err().to_string();
    assert_eq!(
        unknown,
        "robot 'arm' has no link 'bass' (did you mean 'base'?); its links: base, upper, lower, wrist, hand, finger"
    );
    let itself = arm().with_collision_pairs(vec![pair("hand", "hand")]).unwrap_err().to_string();
    assert_eq!(itself, "link 'hand' cannot be tested against itself");
}

#[test]
fn wrong_srdfs_say_what_is_wrong() {
    let message = |text: &str| arm().with_srdf(text).unwrap_err().to_string();
    let links = "its links: base, upper, lower, wrist, hand, finger";
    assert_eq!(
        message(&srdf("<disable_collisions link1='loer' link2='knee'/>")),
        format!(
            "SRDF: it is for another robot: 'arm' has no link 'loer' (did you mean 'lower'?) and none of the pairs that it disables; \
             {links}"
        )
    );
    assert_eq!(message("<robot"), "SRDF line 1: not XML: the document does not have a root node");
    assert_eq!(message("<sdf/>"), "SRDF line 1: the outermost element must be <robot>, found <sdf>");
    assert_eq!(message(ARM), "SRDF line 8: <robot> has a <joint>: this is a URDF");
    assert_eq!(
        message(&srdf("\n<disable_collisions link1='hand'/>")),
        "SRDF line 2: <disable_collisions> has no attribute link2=\"...\""
    );
    let state = "<group_state name='s'><joint name='a' value='x'/></group_state>";
    assert_eq!(message(&srdf(state)), "SRDF line 1: value of joint 'a' must be a number, got 'x'");
    assert!(message("no/such/file.srdf").starts_with("cannot read 'no/such/file.srdf': "));
}
