"""Poses, trajectories and robots of other libraries. A test is skipped if its library is missing."""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from generated import chain

import beetle_ik as bik
from beetle_ik.interop.chain import only_leaf

TURN = bik.pose([0.1, 0.2, 0.3], rpy=[0.4, -0.5, 0.6])
TIP = bik.pose([0.01, -0.02, 0.1], rpy=[0.3, 0.2, 0.1])
TIME = np.array([0.0, 0.5, 1.25])
Q = np.array([[0.0, 1.0], [0.5, 1e-7], [0.25, 2.0]])
NAMES = ["shoulder", "elbow, left"]


class Homogeneous:
    """As Pinocchio's SE3."""

    def __init__(self, matrix: np.ndarray) -> None:
        self.homogeneous = matrix


class AsMatrix:
    """As scipy's RigidTransform and Rotation."""

    def __init__(self, matrix: np.ndarray) -> None:
        self.matrix = matrix

    def as_matrix(self) -> np.ndarray:
        return self.matrix


def robots() -> dict[str, bik.Robot]:
    prismatic = bik.Robot.from_dh(
        a=[0.1, 0.2, 0.0],
        alpha=[0.3, -np.pi / 2, 0.0],
        d=[0.1, 0.0, 0.0],
        theta=[0.2, 0.1, 0.3],
        kinds=["revolute", "continuous", "prismatic"],
        lower=[-1, -np.inf, 0],
        upper=[2, np.inf, 0.5],
        velocity=[1, 2, 3],
        base=TURN,
        tool=TIP,
        name="rrp",
    )
    return {
        "iiwa14": bik.Robot.named("iiwa14"),
        "placed panda": bik.Robot.named("panda").with_tool(TIP).with_base(TURN),
        "ur5e": bik.Robot.named("ur5e"),
        "rrp": prismatic,
        "planar": bik.Robot.planar([1.0, 0.5, 0.25]),
    }


ROBOTS = robots()
each_robot = pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)


def assert_same_robot(one: bik.Robot, other: bik.Robot, *, atol: float = 1e-12) -> None:
    assert one.dof == other.dof
    for q in one.random_configurations(20, seed=2):
        np.testing.assert_allclose(other.fk(q), one.fk(q), rtol=0, atol=atol)
        np.testing.assert_allclose(other.jacobian(q), one.jacobian(q), rtol=0, atol=atol)


# --- poses --------------------------------------------------------------------------------------


@pytest.mark.parametrize("wrap", [Homogeneous, AsMatrix])
def test_poses_of_other_libraries(wrap: type) -> None:
    robot = bik.Robot.named("ur5e")
    target = robot.fk([0.1, -1.0, 1.0, 0.2, 0.3, 0.4])
    assert robot.with_tool(wrap(TIP)) == robot.with_tool(TIP)
    assert robot.with_base(wrap(TURN)) == robot.with_base(TURN)
    np.testing.assert_array_equal(bik.solve(robot, wrap(target)).q, bik.solve(robot, target).q)
    batch = bik.solve_batch(robot, [wrap(target), wrap(target)], threads=1)
    np.testing.assert_array_equal(batch.q, bik.solve_batch(robot, [target, target], threads=1).q)
    np.testing.assert_array_equal(
        bik.pose([1, 2, 3], matrix=wrap(TURN[:3, :3])), bik.pose([1, 2, 3], matrix=TURN[:3, :3])
    )
    path = bik.paths.circle((0, 0, 1), 0.2, 3.0)
    assert path.with_orientation(wrap(TURN[:3, :3])) == path.with_orientation(TURN[:3, :3])
    poses = bik.paths.from_samples([0, 1], [wrap(TURN), wrap(TIP)])
    assert poses == bik.paths.from_samples([0, 1], [TURN, TIP])


def test_what_only_looks_like_a_pose() -> None:
    robot = bik.Robot.named("ur5e")
    nested: list[object] = []
    nested.append(nested)
    for wrong in (
        SimpleNamespace(homogeneous="text"),
        SimpleNamespace(homogeneous=Homogeneous(TURN)),
        [[AsMatrix(TURN)]],
        nested,
    ):
        with pytest.raises(bik.InvalidInputError, match=r"^target must be an array of numbers, got "):
            bik.solve(robot, wrong)
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.solve(robot, AsMatrix(TURN[:3, :3]))
    assert str(caught.value) == "target: expected a pose (4, 4) or a position (3,), got shape (3, 3)"


def test_scipy_transforms_are_poses() -> None:
    transform = pytest.importorskip("scipy.spatial.transform", reason="scipy is not installed")
    rotation = transform.Rotation.from_matrix(TURN[:3, :3])
    np.testing.assert_allclose(bik.pose(TURN[:3, 3], matrix=rotation), TURN, rtol=0, atol=1e-15)
    if not hasattr(transform, "RigidTransform"):
        pytest.skip("scipy before 1.16")
    robot = bik.Robot.named("ur5e")
    targets = robot.fk(robot.random_configurations(3, seed=1))
    rigid = transform.RigidTransform.from_matrix(targets)
    assert bik.solve(robot, rigid[0]).success
    assert bik.solve_batch(robot, rigid, threads=1).success.all()
    assert bik.solve_batch(robot, list(rigid), threads=1).success.all()


# --- trajectories -------------------------------------------------------------------------------


def test_a_ros_message_has_the_points_at_the_knots() -> None:
    message = bik.interop.to_ros(bik.Trajectory.from_samples(TIME, Q, qd=Q + 1.0, joint_names=NAMES), frame_id="base")
    assert message["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "base"}
    assert message["joint_names"] == NAMES
    assert message["points"][2] == {
        "positions": pytest.approx([0.25, 2.0], abs=1e-12),
        "velocities": pytest.approx([1.25, 3.0], abs=1e-12),
        "accelerations": [],
        "effort": [],
        "time_from_start": {"sec": 1, "nanosec": 250_000_000},
    }
    assert json.loads(json.dumps(message)) == message


@pytest.mark.parametrize("convert", [bik.interop.to_ros, bik.interop.to_dataframe])
def test_a_result_is_refused_in_place_of_its_trajectory(convert: object) -> None:
    robot = bik.Robot.planar([1.0, 1.0])
    plan = bik.plan_point_to_point(robot, start_q=[0, 0], end_q=[1, 1], limits=bik.Limits(velocity=1.0))
    with pytest.raises(bik.InvalidInputError) as caught:
        convert(plan)
    assert str(caught.value).startswith("trajectory must be a Trajectory, got <Plan ")
    assert str(caught.value).endswith(": give its .trajectory")
    with pytest.raises(bik.InvalidInputError, match=r"^trajectory must be a Trajectory, got None$"):
        convert(None)


@pytest.mark.parametrize(("derivatives", "told"), [(0, 1), (1, 2), (2, 3)])
def test_a_ros_message_has_the_derivatives_of_its_degree(derivatives: int, told: int) -> None:
    others = dict(list({"qd": Q, "qdd": Q}.items())[:derivatives])
    point = bik.interop.to_ros(bik.Trajectory.from_samples(TIME, Q, **others))["points"][1]
    names = ["positions", "velocities", "accelerations"]
    assert [len(point[name]) for name in names] == [2] * told + [0] * (3 - told)


def test_a_ros_message_may_be_sampled_evenly() -> None:
    trajectory = bik.Trajectory.from_samples(TIME, Q)
    points = bik.interop.to_ros(trajectory, dt=0.1)["points"]
    time, q, *_ = trajectory.sample(0.1)
    assert [point["positions"] for point in points] == q.tolist()
    told = [1e9 * point["time_from_start"]["sec"] + point["time_from_start"]["nanosec"] for point in points]
    np.testing.assert_allclose(told, 1e9 * time, rtol=0, atol=0.5)


def test_ros_points_are_a_nanosecond_apart() -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.interop.to_ros(bik.Trajectory.from_samples([0.0, 1e-10, 1.0], np.zeros((3, 1))))
    assert str(caught.value) == "points 0 and 1 fall into the same nanosecond, t = 1e-10 s: give dt="


def test_ros_yaml_reads_back(tmp_path: Path) -> None:
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    trajectory = bik.Trajectory.from_samples(TIME, Q, qd=Q, joint_names=NAMES)
    bik.interop.to_ros_yaml(trajectory, tmp_path / "motion.yaml", frame_id="base")
    read = yaml.safe_load((tmp_path / "motion.yaml").read_text())
    assert read == bik.interop.to_ros(trajectory, frame_id="base")


def test_ros_yaml_is_plain_text(tmp_path: Path) -> None:
    bik.interop.to_ros_yaml(bik.Trajectory.from_samples(TIME, Q, joint_names=NAMES), tmp_path / "motion.yaml")
    assert (tmp_path / "motion.yaml").read_text().splitlines()[:9] == [
        "header:",
        "  stamp: {sec: 0, nanosec: 0}",
        '  frame_id: ""',
        'joint_names: ["shoulder", "elbow, left"]',
        "points:",
        "  - positions: [0.0, 1.0]",
        "    velocities: []",
        "    accelerations: []",
        "    effort: []",
    ]
    assert "positions: [0.5, 1.0e-07]" in (tmp_path / "motion.yaml").read_text()


def test_a_dataframe_has_a_column_per_joint_and_derivative() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    trajectory = bik.Trajectory.from_samples(TIME, Q, qd=Q, joint_names=["a", "b"])
    table = bik.interop.to_dataframe(trajectory)
    assert list(table.columns) == ["q:a", "q:b", "qd:a", "qd:b", "qdd:a", "qdd:b"]
    assert table.index.name == "time"
    np.testing.assert_array_equal(table.index, TIME)
    np.testing.assert_array_equal(table[["qd:a", "qd:b"]], trajectory.qd)
    assert len(bik.interop.to_dataframe(trajectory, dt=0.25)) == 6


@pytest.mark.parametrize(
    ("module", "call", "message"),
    [
        (
            "pandas",
            lambda: bik.interop.to_dataframe(bik.Trajectory.from_samples(TIME, Q)),
            "a table needs pandas: pip install pandas",
        ),
        ("pinocchio", lambda: bik.interop.to_pinocchio(ROBOTS["ur5e"]), "a Pinocchio model needs pin: pip install pin"),
        (
            "mujoco",
            lambda: bik.interop.from_mujoco("<mujoco/>"),
            "a MuJoCo model needs mujoco: pip install 'beetle-ik[sim]'",
        ),
        (
            "roboticstoolbox",
            lambda: bik.interop.to_roboticstoolbox(ROBOTS["ur5e"]),
            "a model of the Robotics Toolbox needs roboticstoolbox-python: pip install roboticstoolbox-python",
        ),
    ],
)  # fmt: skip
def test_missing_libraries_are_named(module: str, call: object, message: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(bik.BeetleIkError) as caught:
        call()
    assert str(caught.value) == message


# --- Pinocchio ----------------------------------------------------------------------------------


@pytest.fixture
def pin() -> object:
    return pytest.importorskip("pinocchio", reason="Pinocchio is not installed")


@each_robot
def test_a_robot_survives_pinocchio_and_back(robot: bik.Robot, pin: object) -> None:
    model = bik.interop.to_pinocchio(robot)
    data = model.createData()
    for q in robot.random_configurations(5, seed=1):
        pin.framesForwardKinematics(model, data, q)
        np.testing.assert_allclose(data.oMf[model.getFrameId("tool")].homogeneous, robot.fk(q), rtol=0, atol=1e-12)
    back = bik.interop.from_pinocchio(model, tip="tool")
    assert_same_robot(robot, back)
    assert back.joint_names == robot.joint_names
    for name in ("lower", "upper", "velocity_limit"):
        np.testing.assert_array_equal(getattr(back, name), getattr(robot, name))
    assert bik.interop.from_pinocchio(model).link_names[-1] == robot.link_names[-1]


def test_pinocchio_se3_is_a_pose(pin: object) -> None:
    robot = bik.Robot.named("ur5e")
    assert robot.with_tool(pin.SE3(TIP)) == robot.with_tool(TIP)


URDF = """<robot name="two">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="hand"/><link name="camera"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="upper"/><origin xyz="0 0 1" rpy="1 2 3"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="lower"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-1" upper="2" velocity="3" effort="1"/></joint>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="hand"/><origin xyz="1 2 3"/></joint>
  <joint name="mount" type="fixed"><parent link="lower"/><child link="camera"/></joint>
</robot>"""


def test_a_pinocchio_model_equals_the_urdf(pin: object) -> None:
    model = pin.buildModelFromXML(URDF)
    robot = bik.Robot.from_urdf(URDF, tip="hand")
    made = bik.interop.from_pinocchio(model, base="base", tip="hand")
    assert_same_robot(robot, made)
    assert (made.joint_names, made.joint_kinds) == (["turn", "slide"], ["continuous", "prismatic"])
    np.testing.assert_array_equal(made.lower, [-np.inf, -1.0])
    assert_same_robot(
        bik.Robot.from_urdf(URDF, base="upper", tip="hand"), bik.interop.from_pinocchio(model, base="upper", tip="hand")
    )
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.interop.from_pinocchio(model)
    assert str(caught.value) == "the model of Pinocchio has 2 leaf bodies; give tip= one of: hand, camera"
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.interop.from_pinocchio(model, base="hand", tip="base")
    assert str(caught.value) == "frame 'base' of the Pinocchio model is not a descendant of frame 'hand'"
    with pytest.raises(
        bik.UnknownNameError, match=r"^no frame 'foot' in the Pinocchio model; frames: universe, base, "
    ):
        bik.interop.from_pinocchio(model, tip="foot")


def test_pinocchio_joints_that_do_not_fit_are_refused(pin: object) -> None:
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelSpherical(), pin.SE3.Identity(), "ball")
    model.addFrame(pin.Frame("hand", joint, 0, pin.SE3.Identity(), pin.FrameType.BODY))
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.interop.from_pinocchio(model)
    assert str(caught.value) == (
        "joint 'ball' of the Pinocchio model is a JointModelSpherical, but must be revolute or prismatic"
    )


@pytest.mark.usefixtures("pin")
def test_mimic_joints_are_not_exported() -> None:
    xml, base, tip = chain(joints=9, place="branch", seed=4)
    with pytest.raises(
        bik.InvalidInputError, match=r"^joint '.*' of robot '.*' has mimic joints, which the conversion to Pinocchio"
    ):
        bik.interop.to_pinocchio(bik.Robot.from_urdf(xml, base=base, tip=tip))


# --- Robotics Toolbox ---------------------------------------------------------------------------


@pytest.fixture
def rtb() -> object:
    return pytest.importorskip("roboticstoolbox", reason="the Robotics Toolbox is not installed")


@each_robot
@pytest.mark.usefixtures("rtb")
def test_a_robot_survives_roboticstoolbox_and_back(robot: bik.Robot) -> None:
    model = bik.interop.to_roboticstoolbox(robot)
    for q in robot.random_configurations(3, seed=1):
        np.testing.assert_allclose(model.fkine(q).A, robot.fk(q), rtol=0, atol=1e-12)
    back = bik.interop.from_roboticstoolbox(model)
    assert_same_robot(robot, back)


@pytest.mark.filterwarnings("ignore")
def test_roboticstoolbox_models_keep_their_kinematics(rtb: object) -> None:
    placed = rtb.Robot(rtb.ETS(rtb.ET.Rz()) * rtb.ET.ty(flip=True), base=rtb.ET.SE3(TURN).A(), tool=rtb.ET.SE3(TIP).A())
    for model in (
        rtb.models.DH.Puma560(),
        rtb.models.DH.Stanford(),
        rtb.models.DH.Panda(),
        rtb.models.ETS.Panda(),
        placed,
    ):
        robot = bik.interop.from_roboticstoolbox(model)
        for q in robot.random_configurations(3, seed=1):
            np.testing.assert_allclose(robot.fk(q), model.fkine(q).A, rtol=0, atol=1e-12)
    transforms = rtb.ETS(rtb.ET.Rz()) * rtb.ET.tx(1.0)
    np.testing.assert_allclose(bik.interop.from_roboticstoolbox(transforms).fk([0.5]), transforms.fkine([0.5]).A)
    tree = rtb.models.ETS.Planar_Y()
    branch = bik.interop.from_roboticstoolbox(tree, tip="link1")
    assert branch.dof == len([transform for transform in tree.ets(end="link1") if transform.isjoint])
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.interop.from_roboticstoolbox(transforms, tip="link1")
    assert str(caught.value) == "tip: only a Robot of the Robotics Toolbox has named links, got ETS"
    with pytest.raises(bik.InvalidInputError, match=r"^expected a robot or an ETS of the Robotics Toolbox, got 'puma'"):
        bik.interop.from_roboticstoolbox("puma")


# --- MuJoCo -------------------------------------------------------------------------------------

MJCF = """<mujoco model="arm">
  <compiler angle="radian"/>
  <worldbody>
    <body name="upper" pos="0 0 0.3" euler="0.1 0.2 0.3">
      <geom size="0.1"/>
      <joint name="lift" type="slide" axis="0 0 1" range="0 0.5" ref="0.1"/>
      <joint name="turn" axis="0 1 1" pos="0.1 0 0.2" ref="0.25"/>
      <body name="lower" pos="0.4 0 0">
        <geom size="0.1"/>
        <joint name="elbow" axis="0 1 0" range="-2 2"/>
        <site name="tool" pos="0.1 0.2 0.3" euler="1 0 0"/>
      </body>
    </body>
    {more}
  </worldbody>
  {equality}
</mujoco>"""


@pytest.fixture
def mujoco() -> object:
    return pytest.importorskip("mujoco", reason="MuJoCo is not installed")


@pytest.mark.parametrize("tip", [None, "tool"])
def test_mujoco_models_keep_their_kinematics(mujoco: object, tip: str | None, tmp_path: Path) -> None:
    text = MJCF.format(more="", equality="")
    (tmp_path / "arm.xml").write_text(text)
    robot = bik.interop.from_mujoco(text, tip=tip)
    assert robot == bik.interop.from_mujoco(tmp_path / "arm.xml", tip=tip)
    model = mujoco.MjModel.from_xml_string(text)
    assert robot == bik.interop.from_mujoco(model, tip=tip)
    assert (robot.name, robot.joint_names) == ("arm", ["lift", "turn", "elbow"])
    assert robot.joint_kinds == ["prismatic", "continuous", "revolute"]
    np.testing.assert_array_equal(robot.lower, [0.0, -np.inf, -2.0])
    data = mujoco.MjData(model)
    for q in robot.random_configurations(10, seed=1):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        place = data.body("lower") if tip is None else data.site(tip)
        pose = bik.pose(place.xpos, matrix=place.xmat.reshape(3, 3))
        np.testing.assert_allclose(robot.fk(q), pose, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("more", "equality", "options", "problem"),
    [
        ("<body name='b'><geom size='1'/></body>", "", {},
         "robot 'arm' ends in 2 links: say which one is the tip; leaves, by number of joints: lower (3), "
         "b (0)"),
        ("<body name='b'><geom size='1'/><freejoint name='f'/></body>", "", {"tip": "b"},
         "MuJoCo model: joint 'f' is floating, and a chain takes only revolute, continuous, prismatic, fixed and mimic "
         "joints: take base and tip on one side of it, a base from 'b' on or a tip up to 'world'"),
        ("", "<equality><joint joint1='turn' joint2='elbow' polycoef='0 1 2 0 0'/>"
         "<joint joint1='turn' joint2='elbow' polycoef='0 1 3 0 0'/></equality>", {},
         "MuJoCo model: the joint equality of 'turn' and 'elbow' couples the joints turn, elbow, which is not followed "
         "(locks and couplings of two joints are, where they agree): choose base and tip on one side of it, or set "
         "active='false' if the motion of the tip does not depend on it"),
        ("", "", {"tip": "hand"},
         "no body or site 'hand' in the MuJoCo model; bodies: world, upper, lower; sites: tool"),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("mujoco")
def test_mujoco_models_that_do_not_fit_are_refused(
    more: str, equality: str, options: dict[str, str], problem: str
) -> None:
    with pytest.raises(bik.BeetleIkError) as caught:
        bik.interop.from_mujoco(MJCF.format(more=more, equality=equality), **options)
    assert str(caught.value) == problem


@pytest.mark.usefixtures("mujoco")
def test_text_that_is_no_mujoco_model_is_refused() -> None:
    with pytest.raises(bik.InvalidInputError, match=r"^MuJoCo cannot read the model: "):
        bik.interop.from_mujoco("<mujoco><nonsense/></mujoco>")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: bik.interop.to_ros(bik.Trajectory.from_samples(TIME, Q), frame_id="\ud800"),
            "frame_id must be valid Unicode, got '\\ud800'",
        ),
        (lambda: bik.interop.to_ros(bik.Trajectory.from_samples(TIME, Q), frame_id=3), "frame_id must be a str, got 3"),
        (lambda: bik.interop.to_ros([1.0]), "trajectory must be a Trajectory, got [1.0]"),
    ],
)
def test_wrong_types_for_ros_are_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()
    assert str(caught.value) == message


@pytest.mark.parametrize("value", [None, 3, object(), b"<mujoco/>", "\ud800"], ids=repr)
def test_what_is_no_mujoco_model_is_refused(value: object) -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    with pytest.raises(bik.InvalidInputError, match=r"^model must be "):
        bik.interop.from_mujoco(value)


@pytest.mark.parametrize("value", [None, 3, "model"], ids=repr)
def test_what_is_no_pinocchio_model_is_refused(value: object) -> None:
    pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    with pytest.raises(bik.InvalidInputError, match=r"^model must be a Model, got "):
        bik.interop.from_pinocchio(value)
    with pytest.raises(bik.InvalidInputError, match=r"^robot must be a Robot(, such as .*)?, got "):
        bik.interop.to_pinocchio(value)


def test_long_lists_of_names_end_in_a_count() -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        only_leaf("MuJoCo", "bodies", [f"body_{i}" for i in range(5000)])
    assert str(caught.value).endswith(" more")
    assert len(str(caught.value)) < 600
