"""Arms drawn without meshes: the skeleton found from the poses of the links, and the solids along it."""

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik
from beetle_ik.figures.skeleton import Part, skeleton
from beetle_ik.figures.solids import solids
from beetle_ik.viewing.start import middle

GANTRY = """<robot name="gantry"><link name="base"/><link name="x"/><link name="y"/>
<joint name="along" type="prismatic"><axis xyz="1 0 0"/><parent link="base"/><child link="x"/>
<limit lower="0" upper="1" velocity="1"/></joint>
<joint name="across" type="prismatic"><axis xyz="0 1 0"/><parent link="x"/><child link="y"/>
<limit lower="0" upper="1" velocity="1"/></joint></robot>"""
LIFT = """<robot name="lift"><link name="base"/><link name="lower"/><link name="upper"/><link name="hand"/>
<link name="tip"/><joint name="raise" type="revolute"><axis xyz="0 1 0"/><origin xyz="0 0 0.2"/><parent link="base"/>
<child link="lower"/><limit lower="-1" upper="1" velocity="1"/></joint>
<joint name="level" type="revolute"><axis xyz="0 1 0"/><origin xyz="0 0 0.4"/><parent link="lower"/>
<child link="upper"/><limit lower="-2" upper="2" velocity="1"/><mimic joint="raise" multiplier="-2"/></joint>
<joint name="bend" type="revolute"><axis xyz="0 1 0"/><origin xyz="0 0 0.4"/><parent link="upper"/>
<child link="hand"/><limit lower="-1" upper="1" velocity="1"/></joint>
<joint name="end" type="fixed"><origin xyz="0 0 0.2"/><parent link="hand"/><child link="tip"/></joint></robot>"""
ROBOTS = {
    **{name: bik.Robot.named(name) for name in bik.Robot.names()},
    "pair": bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"]).with_capsules([]),
    "driving": bik.Robot.named("panda").with_mobile_base("planar", lower=[-1, -1, -3], upper=[1, 1, 3]),
    "one link": bik.Robot.planar([1.0]),
    "gantry": bik.Robot.from_urdf(GANTRY),
    "lift": bik.Robot.from_urdf(LIFT),
    "placed": bik.Robot.named("ur5e").with_base(bik.pose([1, 2, 3], rpy=[0.5, 1.0, 0.2])),
}


def moving(parts: list[Part]) -> list[Part]:
    return [each for part in parts for each in (*part.after, *moving(part.after))]


@pytest.mark.parametrize("name", ROBOTS)
def test_every_moving_link_of_an_arm_is_drawn(name: str) -> None:
    robot = ROBOTS[name]
    drawn = {solid.link for solid in solids(robot, middle(robot))}
    parts = moving(skeleton(robot, middle(robot))[0])
    beside = {"driving": -3, "lift": 1}  # joints of a base that is not drawn, a mimic joint
    assert len(parts) == robot.dof + beside.get(name, 0)
    assert all(drawn & set(part.links) for part in parts)


@pytest.mark.parametrize("name", ROBOTS)
def test_solids_are_closed_and_turned_outward(name: str) -> None:
    robot = ROBOTS[name]
    for solid in solids(robot, middle(robot)):
        a, b, c = np.moveaxis(solid.triangles, 1, 0)
        assert volume(solid.triangles) > 0.0
        np.testing.assert_allclose(np.linalg.norm(solid.normals, axis=1), 1.0)
        across = np.cross(b - a, c - a)
        assert np.einsum("ij,ij->i", across, solid.normals[solid.faces].sum(axis=1)).min() > -1e-12


def volume(triangles: np.ndarray) -> float:
    return float(np.linalg.det(triangles).sum() / 6.0)


@pytest.mark.parametrize("name", ROBOTS)
def test_solids_do_not_depend_on_the_configuration(name: str) -> None:
    robot = ROBOTS[name]
    first, second = (solids(robot, q) for q in (middle(robot), robot.random_configurations(1, seed=3)[0]))
    assert len(first) == len(second)
    for one, other in zip(first, second, strict=True):
        assert (one.link, one.color) == (other.link, other.color)
        if "prismatic" not in robot.joint_kinds:  # what slides is drawn as long as it is at the time
            assert volume(one.triangles) == pytest.approx(volume(other.triangles), rel=1e-6)


@pytest.mark.parametrize("name", [name for name in ROBOTS if name != "lift"])
def test_axes_turn_as_the_jacobian_says(name: str) -> None:
    robot = ROBOTS[name]
    q = robot.random_configurations(1, seed=1)[0]
    for part in moving(skeleton(robot, q)[0]):
        axis = part.axis
        assert axis is not None
        columns = robot.jacobian(q, link=part.links[0]).T
        if axis.travel is not None:
            assert (np.linalg.norm(columns[:, :3] - axis.along, axis=1) < 1e-9).any()
            continue
        place = robot.all_link_poses(q)[robot.all_link_names.index(part.links[0])][:3, 3]
        expected = np.concatenate((np.cross(axis.along, place - axis.point), axis.along))
        assert (np.linalg.norm(columns - expected, axis=1) < 1e-9).any()
        for point in (axis.enter, axis.leave):
            np.testing.assert_allclose(axis.foot(point), point, atol=1e-9)


def test_parallel_axes_are_passed_as_the_maker_builds_them() -> None:
    parts = moving(skeleton(bik.Robot.named("ur5e"), np.zeros(6))[0])
    beside = [float(part.axis.leave[1]) for part in parts if part.axis is not None][1:4]
    np.testing.assert_allclose(beside, [-0.1333, 0.0, -0.1333], atol=1e-12)  # upper arm outside, forearm inside


def test_the_parts_that_a_mimic_joint_moves_stay_together() -> None:
    robot = ROBOTS["lift"]
    for q in robot.random_configurations(5, seed=2):
        poses = dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))
        ends: dict[str, list[np.ndarray]] = {}  # corners of each link
        for solid in solids(robot, middle(robot)):
            placed = solid.vertices @ poses[solid.link][:3, :3].T + poses[solid.link][:3, 3]
            ends.setdefault(solid.link, []).append(placed)
        for first, second in (("lower", "upper"), ("upper", "hand")):
            axis = poses[second][:3, 3]
            for link in (first, second):
                assert np.linalg.norm(np.vstack(ends[link]) - axis, axis=1).min() < 0.05


def test_a_gripper_is_drawn_where_its_bodies_are() -> None:
    panda = bik.Robot.named("panda")
    fingers = [("link_7", (0, y, 0.15), (0, y, 0.31), 0.01) for y in (-0.03, 0.03)]
    tool = bik.pose([0.0, 0.0, 0.2])
    drawn: dict[bool, list[np.ndarray]] = {True: [], False: []}
    for has_fingers, capsules in ((True, fingers), (False, [("link_7", (0, 0, 0.15), (0, 0, 0.31), 0.01)])):
        robot = panda.with_capsules(capsules).with_tool(tool)
        for solid in solids(robot, middle(robot)):
            if solid.link == "link_7" and solid.vertices[:, 2].max() > 0.25:  # reaches beyond the middle of the tool
                drawn[has_fingers].append(solid.vertices)
    (cone,) = drawn[False]
    assert abs(cone[:, 1].mean()) < 1e-9
    assert cone[:, 2].max() == pytest.approx(0.107 + 0.2)
    one, other = sorted(drawn[True], key=lambda finger: finger[:, 1].mean())
    for finger, y in ((one, -0.03), (other, 0.03)):
        low, high = finger.min(axis=0), finger.max(axis=0)
        np.testing.assert_allclose([low[0], high[0], low[1], high[1]], [-0.01, 0.01, y - 0.01, y + 0.01], atol=1e-3)
        np.testing.assert_allclose([low[2], high[2]], [0.15, 0.31], atol=1e-9)


def test_an_arm_with_other_bodies_is_not_drawn_over_them() -> None:
    box = bik.obstacles.Box((0, 0, 0), (0.1, 0.1, 0.1))
    panda = bik.Robot.named("panda")
    assert solids(panda.with_attached("link_7", box), np.zeros(7))
    shape = "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision>"
    boxed = bik.Robot.from_urdf(GANTRY.replace('<link name="y"/>', f'<link name="y">{shape}</link>'))
    assert not solids(boxed, np.zeros(2))
