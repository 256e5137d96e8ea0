"""Links beside the chain, and joints that are held."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest

import beetle_ik as bik

GRIPPER = """<robot name="arm">
  <link name="base"/> <link name="upper"/> <link name="hand"/> <link name="left"/> <link name="right"/>
  <joint name="shoulder" type="revolute"> <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/>
    <limit lower="-2" upper="2"/> </joint>
  <joint name="elbow" type="revolute"> <parent link="upper"/> <child link="hand"/> <origin xyz="0.5 0 0"/>
    <axis xyz="0 1 0"/> <limit lower="-2" upper="2"/> </joint>
  <joint name="finger" type="prismatic"> <parent link="hand"/> <child link="left"/> <origin xyz="0.1 0 0"/>
    <axis xyz="0 1 0"/> <limit lower="0" upper="0.04"/> </joint>
  <joint name="follower" type="prismatic"> <parent link="hand"/> <child link="right"/> <origin xyz="0.1 0 0"/>
    <axis xyz="0 -1 0"/> <mimic joint="finger"/> </joint>
</robot>"""


def arm(hold: dict[str, float] | None = None) -> bik.Robot:
    return bik.Robot.from_urdf(GRIPPER, tip="hand", hold=hold)


def test_fingers_are_seen_where_they_are_held() -> None:
    robot = arm({"finger": 0.03})
    assert robot.link_names == ["base", "upper", "hand"]
    assert robot.all_link_names == ["base", "upper", "hand", "left", "right"]
    assert robot.held_joints == {"finger": 0.03}
    q = [0.4, -0.3]
    for link, side in (("left", 0.03), ("right", -0.03)):
        shift = np.eye(4)
        shift[:3, 3] = 0.1, side, 0
        np.testing.assert_allclose(robot.fk(q, link=link), robot.fk(q) @ shift, rtol=0, atol=1e-15)
    assert arm().held_joints == {"finger": 0.0}
    assert arm().with_held({"finger": 0.03}) == robot != arm()


def test_links_take_one_configuration_or_many() -> None:
    robot = arm()
    q = robot.random_configurations(9, seed=1)
    poses, jacobians = robot.fk(q, link="left"), robot.jacobian(q, link="left")
    assert poses.shape == (9, 4, 4)
    assert jacobians.shape == (9, 6, 2)
    np.testing.assert_array_equal(poses, [robot.fk(row, link="left") for row in q])
    np.testing.assert_array_equal(jacobians, [robot.jacobian(row, link="left") for row in q])
    np.testing.assert_array_equal(robot.all_link_poses(q[0])[3], poses[0])
    np.testing.assert_array_equal(robot.link_poses(q[0]), robot.all_link_poses(q[0])[:3])


def test_a_robot_tells_of_its_held_joints() -> None:
    robot = arm({"finger": 0.01})
    assert repr(robot) == "<Robot 'arm': 2 joints, base to hand, 1 joint held>"
    assert "held: finger at 0.01" in robot._repr_html_()
    assert "held" not in bik.Robot.named("panda")._repr_html_()


def test_held_joints_survive_pickling() -> None:
    robot = arm({"finger": 0.02})
    restored = pickle.loads(pickle.dumps(robot))
    assert restored == robot
    np.testing.assert_array_equal(restored.fk([0.1, 0.2], link="right"), robot.fk([0.1, 0.2], link="right"))


HELD = "joints that it holds: finger"


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (
            lambda: arm({"fingr": 0.0}),
            bik.UnknownNameError,
            f"robot 'arm' holds no joint 'fingr' (did you mean 'finger'?); {HELD}",
        ),
        (
            lambda: arm({"elbow": 0.0}),
            bik.UnknownNameError,
            f"robot 'arm' holds no joint 'elbow' (it is entry 1 of q); {HELD}",
        ),
        (
            lambda: arm({"finger": 1}),
            bik.LimitError,
            "hold: joint 'finger' at 1 is outside its limits [0, 0.04] by 0.9600 m: move it inside",
        ),
        (
            lambda: arm([0.1]),  # type: ignore[arg-type]
            bik.InvalidInputError,
            "hold must be a dict of joint names and values (rad, m), got [0.1]",
        ),
        (
            lambda: arm().fk([0, 0], link="lft"),
            bik.UnknownNameError,
            "robot 'arm' has no link 'lft' (did you mean 'left'?); its links: base, upper, hand, left, right",
        ),
    ],
)
def test_wrong_names_and_values_are_told(call: Callable[[], object], kind: type[Exception], message: str) -> None:
    with pytest.raises(kind) as told:
        call()
    assert str(told.value) == message


@pytest.mark.parametrize(("follower", "master"), [("j2", "k2"), ("k2", "j2")])
def test_a_mimic_joint_follows_across_branches(follower: str, master: str) -> None:
    """The chain ends in c; e is on another branch of b. The joint that is mimicked is the one in q."""

    def joint(name: str, parent: str, child: str) -> str:
        mimic = f'<mimic joint="{master}" multiplier="0.5"/>' if name == follower else ""
        return (
            f'<joint name="{name}" type="revolute"> <parent link="{parent}"/> <child link="{child}"/>'
            f' <axis xyz="0 1 0"/> <limit lower="-2" upper="2" velocity="1" effort="1"/> {mimic}</joint>'
        )

    links = "".join(f'<link name="{name}"/>' for name in "abce")
    joints = joint("j1", "a", "b") + joint("j2", "b", "c") + joint("k2", "b", "e")
    robot = bik.Robot.from_urdf(f'<robot name="branched">{links}{joints}</robot>', tip="c")
    assert robot.joint_names == ["j1", master]
    for link, name in (("c", "j2"), ("e", "k2")):
        angle = 0.3 + 0.8 * (0.5 if name == follower else 1.0)
        np.testing.assert_allclose(
            robot.fk([0.3, 0.8], link=link)[0, :3], [np.cos(angle), 0.0, np.sin(angle)], atol=1e-12
        )
