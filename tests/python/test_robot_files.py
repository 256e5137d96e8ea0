"""Robots from MuJoCo models, xacro files and the package robot_descriptions."""

import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from test_tree import GRIPPER

import beetle_ik as bik

# A wrist with two joints, one about an anchor, and a gripper whose second finger follows the first.
MJCF = """<mujoco model="gripper">
  <compiler angle="radian"/>
  <default> <geom size="0.02" contype="1"/> </default>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" contype="0" conaffinity="0"/>
    <body name="arm" pos="0 0 0.3" euler="0 1.5707963267948966 0.3">
      <joint name="lift" type="slide" axis="0 0 1" range="0 0.5" ref="0.1"/>
      <joint name="turn" axis="0 1 1" pos="0.1 0 0.2" ref="0.25" range="-2 2"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0"/>
      <body name="hand" pos="0.4 0 0">
        <joint name="wrist" axis="0 1 0" range="-2 2"/>
        <geom type="box" size="0.02 0.03 0.04"/>
        <body name="left" pos="0.1 0 0"> <joint name="grip" type="slide" axis="0 1 0" range="0 0.04"/> <geom/> </body>
        <body name="right" pos="0.1 0 0" quat="0 0 0 1"> <geom/>
          <joint name="other" type="slide" axis="0 1 0" ref="0.01"/> </body>
        <site name="tool" pos="0.1 0.2 0.3"/>
      </body>
    </body>
    <body name="ball" pos="1 0 0"> <freejoint name="free"/> <geom type="ellipsoid" size="0.1 0.2 0.3"/> </body>
  </worldbody>
  <equality> <joint joint1="other" joint2="grip" polycoef="0.002 0.5 0 0 0"/> </equality>
</mujoco>"""


def test_all_bodies_of_a_mujoco_model_stand_where_mujoco_puts_them() -> None:
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    robot = bik.Robot.from_mjcf(MJCF, tip="tool", hold={"grip": 0.03})
    assert (robot.name, robot.joint_names, robot.held_joints) == ("gripper", ["lift", "turn", "wrist"], {"grip": 0.03})
    model = mujoco.MjModel.from_xml_string(MJCF)
    data = mujoco.MjData(model)
    for q in robot.random_configurations(5, seed=1):
        for joint, value in zip(robot.joint_names, q, strict=True):
            data.joint(joint).qpos = value
        data.joint("grip").qpos = 0.03
        data.joint("other").qpos = 0.01 + 0.002 + 0.5 * 0.03
        mujoco.mj_kinematics(model, data)
        for body in ("world", "arm", "hand", "left", "right", "ball"):
            place = data.body(body)
            pose = bik.pose(place.xpos, matrix=place.xmat.reshape(3, 3))
            np.testing.assert_allclose(robot.fk(q, link=body), pose, rtol=0, atol=1e-12)
        np.testing.assert_allclose(robot.fk(q)[:3, 3], data.site("tool").xpos, rtol=0, atol=1e-12)
    assert robot == bik.Robot.from_mjcf(model, tip="tool", hold={"grip": 0.03})


def test_colliding_geoms_become_capsules() -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    capsules = {link: (a, b, radius) for link, a, b, radius in bik.Robot.from_mjcf(MJCF, tip="tool").capsules}
    assert list(capsules) == ["arm", "hand", "left", "right"]
    a, b, radius = capsules["arm"]
    np.testing.assert_allclose(sorted([a[0], b[0]]), [0, 0.4], rtol=0, atol=1e-12)
    assert radius == 0.02


def test_joints_that_contradict_each_other_are_refused_on_the_chain_alone() -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    second = '<joint joint1="other" joint2="grip" polycoef="0 1 1 0 0"/> </equality>'
    bent = MJCF.replace("</equality>", second)
    with pytest.warns(UserWarning, match="the joint equality of 'other' and 'grip' is open by 0.002"):
        assert bik.Robot.from_mjcf(bent, tip="tool").dof == 3
    with pytest.raises(bik.InvalidInputError) as told:
        bik.Robot.from_mjcf(bent, tip="right")
    assert str(told.value).startswith(
        "MuJoCo model: the joint equality of 'other' and 'grip' couples the joints grip, other,"
    )


def stub(monkeypatch: pytest.MonkeyPatch, name: str, **contents: object) -> ModuleType:
    """Puts a module of this name where it is imported from."""
    module = ModuleType(name)
    for key, value in contents.items():
        setattr(module, key, value)
    monkeypatch.setitem(sys.modules, name, module)
    return module


def test_xacro_files_are_expanded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "arm.urdf.xacro"
    pytest.importorskip("xacro", reason="xacro files need the extra 'robots'")
    file.write_text(GRIPPER)
    assert bik.Robot.from_urdf(file, tip="hand") == bik.Robot.from_urdf(GRIPPER, tip="hand")
    file.write_text("<robot><link name='${radius}'/></robot>")
    with pytest.raises(bik.UrdfError) as told:
        bik.Robot.from_urdf(file)
    evaluated = "name 'radius' is not defined \nwhen evaluating expression 'radius'"
    assert str(told.value) == f"URDF: xacro cannot expand '{file}': {evaluated}"
    monkeypatch.setitem(sys.modules, "xacro", None)
    with pytest.raises(bik.UrdfError) as told:
        bik.Robot.from_urdf(file)
    assert str(told.value) == (
        f"URDF: '{file}' is a xacro file: pip install 'beetle-ik[robots]', or run `xacro {file} > {tmp_path}/arm.urdf` "
        "and load the result"
    )


def test_descriptions_are_loaded_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(GRIPPER)
    stub(monkeypatch, "robot_descriptions", __path__=[])
    names = {"arm_description": ["URDF"], "arm_mj_description": ["MJCF"], "leg_description": ["URDF"]}
    stub(monkeypatch, "robot_descriptions._descriptions", DESCRIPTIONS=names)
    stub(monkeypatch, "robot_descriptions.arm_description", URDF_PATH=str(urdf))
    robot = bik.Robot.from_description("arm_description", tip="hand", hold={"finger": 0.01})
    assert robot == bik.Robot.from_urdf(urdf, tip="hand", hold={"finger": 0.01})
    for wrong, near in (("arm_descripton", "did you mean arm_description"), ("zebra", "it has 3 others")):
        with pytest.raises(bik.UnknownNameError) as told:
            bik.Robot.from_description(wrong)
        assert str(told.value).startswith(f"robot_descriptions has no robot named '{wrong}'; {near}")
    monkeypatch.setitem(sys.modules, "robot_descriptions", None)
    with pytest.raises(bik.BeetleIkError) as missing:
        bik.Robot.from_description("arm_description")
    assert str(missing.value) == (
        "the robot named 'arm_description' needs robot_descriptions: pip install 'beetle-ik[robots]'"
    )
