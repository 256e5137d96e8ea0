"""Dynamics: Pinocchio and MuJoCo on generated robots, energy, payloads, friction, masses of files, storage, plots."""

import pickle
from typing import Any

import numpy as np
import pytest
from dynamics_oracle import DynamicsOracle, assert_near, states
from generated import chain
from numpy.typing import NDArray
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

Array = NDArray[np.float64]

PENDULUM = """
<robot name="pendulum">
  <link name="base"/>
  <link name="rod">{rod}</link>
  <joint name="swing" type="continuous"> <parent link="base"/> <child link="rod"/> <axis xyz="0 1 0"/> {swing} </joint>
</robot>
"""
INERTIAL = '<inertial><origin xyz="0 0 -0.5"/><mass value="{mass}"/><inertia {matrix}/></inertial>'
ROUND = 'ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"'
BOB = INERTIAL.format(mass=2, matrix=ROUND)
PANDA = bik.Robot.named("panda")
Q = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.8])


def pendulum(rod: str = BOB, swing: str = "") -> bik.Robot:
    return bik.Robot.from_urdf(PENDULUM.format(rod=rod, swing=swing))


def moments(rng: np.random.Generator) -> Array:
    """The inertia matrix of three pairs of points."""
    arms = rng.normal(size=(3, 3)) * 0.1
    return np.eye(3) * np.sum(arms**2) - arms.T @ arms


def with_masses(robot: bik.Robot, seed: int) -> bik.Robot:
    rng = np.random.default_rng(seed)
    links = robot.all_link_names
    return robot.with_inertias(
        [
            bik.Inertia(link, float(rng.choice([1.0, 0.1, 3.0])), rng.normal(size=3) * 0.1, moments(rng))
            for link in links
        ]
    )


def weighted_urdf(seed: int, joints: int) -> str:
    """A chain whose links have masses in turned frames, with friction and mimic joints."""
    rng = np.random.default_rng([seed, 5])

    def body() -> str:
        m = moments(rng)
        entries = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
        tensor = " ".join(f'{name}="{float(m[place])!r}"' for name, place in entries.items())
        rpy = " ".join(str(rng.choice([0.0, np.pi / 2, rng.normal()])) for _ in range(3))
        at = " ".join(str(x) for x in rng.normal(size=3) * 0.2)
        mass = rng.choice([1.0, 0.5, 2.0])
        return f'<inertial><origin xyz="{at}" rpy="{rpy}"/><mass value="{mass}"/><inertia {tensor}/></inertial>'

    xml, _, _ = chain(joints, "root", seed)
    first, *rest = xml.split("<link name=")
    links = [f"<link name={name}>{body()}</link>{after}" for name, after in (part.split("/>", 1) for part in rest)]
    first, *rest = (first + "".join(links)).split("<limit ")
    rubs = [f'<dynamics damping="{rng.choice([0, 0.5])}" friction="{rng.choice([0, 0.25])}"/>' for _ in rest]
    return first + "".join(f"{rub}<limit {part}" for rub, part in zip(rubs, rest, strict=True))


@pytest.mark.filterwarnings("ignore::beetle_ik.UnitsWarning")  # drawn limits may look like degrees
@pytest.mark.parametrize("joints", range(1, 13))
def test_generated_chains_have_the_dynamics_of_pinocchio(joints: int) -> None:
    for seed in range(5):
        xml = weighted_urdf(seed, joints)
        _, base, tip = chain(joints, "root", seed)
        robot = bik.Robot.from_urdf(xml, base=base, tip=tip)
        oracle = DynamicsOracle(xml, robot)
        for q, qd, qdd in states(robot.with_limits(lower=-3.0, upper=3.0), 10, seed):
            expected, mass = oracle.torques(q, qd, qdd), oracle.mass_matrix(q)
            assert_near(robot.torques(q, qd, qdd), expected, abs(expected).max())
            assert_near(robot.mass_matrix(q), mass, abs(mass).max())
            assert_near(robot.center_of_mass(q), oracle.center_of_mass(q), 1.0)
            back = robot.torques(q, qd, robot.accelerations(q, qd, expected))
            assert_near(back, expected, abs(expected).max())


def test_two_tips_have_the_dynamics_of_pinocchio() -> None:
    xml = pair_of_pandas()
    robot = with_masses(bik.Robot.from_urdf(xml, tip=["left_tool", "right_tool"]), 1)
    pinocchio = pytest.importorskip("pinocchio")
    oracle = DynamicsOracle(xml, robot)
    model = oracle.model
    model.inertias[0] = pinocchio.Inertia.Zero()
    for frame in model.frames:
        known = {inertia.link: inertia for inertia in robot.inertias}.get(frame.name)
        if known is not None and frame.type == pinocchio.BODY:
            body = pinocchio.Inertia(known.mass, known.center, known.matrix)
            model.inertias[frame.parentJoint] = model.inertias[frame.parentJoint] + frame.placement.act(body)
    oracle.data = model.createData()
    for q, qd, qdd in states(robot, 50, 2):
        expected, mass = oracle.torques(q, qd, qdd), oracle.mass_matrix(q)
        assert_near(robot.torques(q, qd, qdd), expected, abs(expected).max())
        assert_near(robot.mass_matrix(q), mass, abs(mass).max())


@pytest.mark.parametrize("seed", range(4))
def test_a_floating_base_has_the_dynamics_of_a_free_flyer(seed: int) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    xml = weighted_urdf(seed, 4)
    _, base, tip = chain(4, "root", seed)
    fixed = bik.Robot.from_urdf(xml, base=base, tip=tip).with_limits(lower=-3.0, upper=3.0)
    half = np.array([2.0, 2.0, 2.0, np.pi, np.pi, np.pi])
    robot = fixed.with_mobile_base("floating", lower=-half, upper=half)
    oracle = DynamicsOracle(xml, fixed)
    free = pinocchio.buildModelFromXML(xml, pinocchio.JointModelFreeFlyer())
    data = free.createData()
    for q, qd, qdd in states(robot, 25, seed):
        # Angular velocity of the base and its rate, in its frame, by exponentials and differences.
        turn = pinocchio.exp3(q[3:6])

        def angular(t: float, phi: Array = q[3:6], rate: Array = qd[3:6], change: Array = qdd[3:6]) -> Array:
            at, speed = phi + t * rate + t * t / 2 * change, rate + t * change
            return np.asarray(pinocchio.Jexp3(at) @ speed)

        h = 1e-4
        spin, spun = angular(0.0), (8 * (angular(h) - angular(-h)) - (angular(2 * h) - angular(-2 * h))) / (12 * h)
        linear = turn.T @ qd[:3]
        full = np.concatenate([q[:3], pinocchio.Quaternion(turn).coeffs(), oracle._configuration(q[6:])])
        rates = np.concatenate([linear, spin, oracle.followed @ qd[6:]])
        changes = np.concatenate([turn.T @ qdd[:3] - np.cross(spin, linear), spun, oracle.followed @ qdd[6:]])
        force = pinocchio.rnea(free, data, full, rates, changes)
        own = np.concatenate([turn @ force[:3], pinocchio.Jexp3(q[3:6]).T @ force[3:6]])
        rubbing = oracle.damping * rates[6:] + oracle.dry * np.sign(rates[6:])
        expected = np.concatenate([own, oracle.followed.T @ (force[6:] + rubbing)])
        assert_near(robot.torques(q, qd, qdd), expected, max(abs(expected).max(), 1.0), tolerance=1e-9)


MJCF = """
<mujoco><compiler angle="radian"/><option gravity="0.5 0 -9.5"/>
<worldbody><body name="foot" pos="0 0 1" euler="0.3 0.2 0.1"><geom size="0.1" mass="1"/>
 <body name="upper" pos="0 0 0.2"><joint name="j1" axis="0 1 0" armature="0.1" damping="0.7" frictionloss="0.2"/>
  <inertial pos="0.1 0 0.2" mass="2" fullinertia="0.04 0.05 0.03 0.001 0.002 0.003"/>
  <body name="fore" pos="0 0.1 0.4"><joint name="j2" pos="0 0.05 0" axis="1 1 0" range="-1 1" limited="true"/>
   <inertial pos="0 0 0.1" quat="1 0.2 0 0.1" mass="1.5" diaginertia="0.02 0.03 0.025"/>
   <body name="hand" pos="0 0 0.3">
    <joint name="s" type="slide" axis="0 0 1" range="0 0.2" limited="true" armature="0.3"/>
    <geom size="0.05" mass="0.4"/></body></body></body></body></worldbody>
<actuator><motor joint="j1" gear="2" forcelimited="true" forcerange="-30 40"/></actuator></mujoco>
"""


def test_a_mujoco_model_has_the_dynamics_of_mujoco() -> None:
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(MJCF)
    data, robot = mujoco.MjData(model), bik.Robot.from_mjcf(MJCF)
    np.testing.assert_array_equal(robot.torque_limit, [60.0, np.inf, np.inf])
    np.testing.assert_array_equal(robot.gravity, [0.5, 0.0, -9.5])
    for q, qd, qdd in states(robot, 50, 3):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, qd, 0.0
        mujoco.mj_forward(model, data)
        mass = np.zeros((3, 3))
        mujoco.mj_fullM(model, data, mass)
        rubbing = np.array([0.7, 0, 0]) * qd + np.array([0.2, 0, 0]) * np.sign(qd)
        expected = mass @ qdd + data.qfrc_bias + rubbing
        assert_near(robot.mass_matrix(q), mass, abs(mass).max())
        assert_near(robot.torques(q, qd, qdd), expected, max(abs(expected).max(), 1.0))


def test_the_frame_of_a_base_turns_the_gravity_of_a_mujoco_model() -> None:
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(MJCF)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    turned = data.body("foot").xmat.reshape(3, 3).T @ model.opt.gravity
    robot = bik.Robot.from_mjcf(MJCF, base="foot")
    np.testing.assert_allclose(robot.gravity, turned, atol=1e-12)
    whole = bik.Robot.from_mjcf(MJCF)
    np.testing.assert_allclose(robot.torques([0.3, 0.5, 0.1]), whole.torques([0.3, 0.5, 0.1]), atol=1e-11)


def test_a_swing_without_friction_keeps_its_energy() -> None:
    robot = with_masses(bik.Robot.planar([0.5, 0.4, 0.3]), 4).with_gravity((0.0, -9.81, 0.0))
    mass = sum(inertia.mass for inertia in robot.inertias)

    def energy(q: Array, qd: Array) -> float:
        return float(qd @ robot.mass_matrix(q) @ qd / 2 - mass * robot.center_of_mass(q) @ robot.gravity)

    def rate(state: Array) -> Array:
        q, qd = state
        return np.array([qd, robot.accelerations(q, qd, np.zeros(3))])

    state, h = np.array([[0.5, 0.3, -0.2], [0.0, 0.0, 0.0]]), 1e-3
    first, swing = energy(*state), np.zeros(0)
    for _ in range(10_000):
        a = rate(state)
        b = rate(state + h / 2 * a)
        c = rate(state + h / 2 * b)
        d = rate(state + h * c)
        state = state + h / 6 * (a + 2 * b + 2 * c + d)
        swing = np.append(swing[-1:], energy(*state))
        assert abs(swing[-1] - first) < 1e-6 * mass * 9.81
    assert abs(state[0]).max() > 0.1


def test_batches_are_what_each_configuration_is_alone() -> None:
    qs = PANDA.random_configurations(5, 1)
    qds, qdds = PANDA.random_configurations(5, 2), PANDA.random_configurations(5, 3)
    wrenches = np.arange(30.0).reshape(5, 6)
    together = PANDA.torques(qs, qds, qdds, wrench=wrenches)
    for i in range(5):
        np.testing.assert_array_equal(together[i], PANDA.torques(qs[i], qds[i], qdds[i], wrench=wrenches[i]))
        np.testing.assert_array_equal(PANDA.mass_matrix(qs)[i], PANDA.mass_matrix(qs[i]))
        np.testing.assert_array_equal(PANDA.center_of_mass(qs)[i], PANDA.center_of_mass(qs[i]))
        alone = PANDA.accelerations(qs[i], qds[i], together[i])
        np.testing.assert_array_equal(PANDA.accelerations(qs, qds, together)[i], alone)
    one = PANDA.torques(qs, wrench=wrenches[0])
    np.testing.assert_array_equal(one[4], PANDA.torques(qs[4], wrench=wrenches[0]))
    assert PANDA.torques(np.zeros((0, 7))).shape == (0, 7)
    assert PANDA.mass_matrix(np.zeros((0, 7))).shape == (0, 7, 7)


def test_a_payload_at_the_tool_hangs_on_the_jacobian() -> None:
    arm = PANDA.with_tool(bik.pose([0.0, 0.1, 0.2], rpy=[0.3, 0.2, 0.1]))
    carrying = arm.with_payload(3.0)
    weight = np.array([0.0, 0.0, -3.0 * 9.81, 0.0, 0.0, 0.0])
    expected = arm.torques(Q) - arm.jacobian(Q).T @ weight
    np.testing.assert_allclose(carrying.torques(Q), expected, atol=1e-12)
    np.testing.assert_allclose(arm.torques(Q, wrench=weight), expected, atol=1e-12)
    assert repr(carrying) == "<Robot 'panda': 7 joints, base to flange, carries 3 kg>"
    assert [payload.link for payload in carrying.payloads] == ["flange"]
    assert carrying.with_payload(1.0) == arm.with_payload(1.0)
    assert carrying.with_payload(0.0) == arm


def test_friction_and_rotor_of_a_joint_count() -> None:
    swing = '<dynamics damping="0.5" friction="0.2"/><limit effort="7" velocity="1"/>'
    robot = pendulum(swing=swing)
    lever = 2 * 9.81 * 0.5
    np.testing.assert_allclose(robot.torques([np.pi / 2]), [lever])
    moving = robot.torques([np.pi / 2], [2.0], [1.0])
    np.testing.assert_allclose(moving, [0.03 + 2 * 0.25 + lever + 0.5 * 2 + 0.2])
    back = robot.torques([np.pi / 2], [-2.0], [1.0])
    np.testing.assert_allclose(back, [0.03 + 2 * 0.25 + lever - 0.5 * 2 - 0.2])
    np.testing.assert_allclose(robot.accelerations([np.pi / 2], [-2.0], back), [1.0])
    np.testing.assert_array_equal(robot.torque_limit, [7.0])
    np.testing.assert_array_equal(pendulum(swing='<limit effort="0"/>').torque_limit, [np.inf])


def test_a_mimic_joint_is_reflected_to_its_master() -> None:
    joint = (
        '<joint name="{0}" type="continuous"> <parent link="{1}"/> <child link="{2}"/> <axis xyz="0 1 0"/> {3}'
        '<dynamics damping="1" friction="0.1"/> </joint>'
    )
    links = "".join(f'<link name="{name}">{BOB}</link>' for name in "abc")
    xml = (
        f'<robot name="twins"> <link name="base"/> {links}'
        + joint.format("j", "base", "a", "")
        + joint.format("k", "a", "b", '<mimic joint="j" multiplier="-2"/>')
        + joint.format("l", "base", "c", '<mimic joint="j" multiplier="3"/>')
        + "</robot>"
    )
    robot = bik.Robot.from_urdf(xml, tip="b")
    twice = robot.torques([0.4], [1.5]) - robot.torques([0.4], [-1.5])
    np.testing.assert_allclose(twice, [2 * (1.5 * (1 + 4 + 9) + 0.1 * (1 + 2 + 3))], atol=1e-12)


@pytest.mark.parametrize(
    ("rod", "problem"),
    [
        (
            INERTIAL.format(mass=-1, matrix=ROUND),
            "URDF line 4: <inertial> of link 'rod': the mass is -1 kg: it cannot be negative",
        ),
        (
            INERTIAL.format(mass=1, matrix='ixx="1" iyy="1" izz="3"'),
            "URDF line 4: <inertial> of link 'rod': the principal moments of inertia are 1.000e0, 1.000e0, "
            "3.000e0 kg m^2: the largest cannot exceed the sum of the others",
        ),
        (
            INERTIAL.format(mass=1, matrix='ixx="1" iyy="1" izz="-1"'),
            "URDF line 4: <inertial> of link 'rod': the principal moments of inertia are -1.000e0, 1.000e0, "
            "1.000e0 kg m^2: none can be negative",
        ),
        (
            INERTIAL.format(mass="heavy", matrix=ROUND),
            "URDF line 4: value of <mass> in <inertial> of link 'rod' must be a number, got 'heavy'",
        ),
        ("<inertial/>", "URDF line 4: <inertial> of link 'rod' has no <mass>"),
        (
            '<inertial><mass value="1"/><inertia ixx="1"/></inertial>',
            "URDF line 4: <inertia> in <inertial> of link 'rod' has no attribute iyy=\"...\"",
        ),
        (
            INERTIAL.format(mass="inf", matrix=ROUND),
            "URDF line 4: <inertial> of link 'rod': mass, centre and inertia matrix must be finite, got inf",
        ),
        (
            "",
            "no link has a mass: give them by robot.with_inertias({link: Inertia(link, mass, center, matrix)})",
        ),
    ],
)
def test_missing_or_impossible_masses_are_told_by_name(rod: str, problem: str) -> None:
    robot = pendulum(rod)
    assert robot.fk([0.5]).shape == (4, 4)
    assert not robot.has_dynamics
    calls: list[Any] = [
        robot.torques,
        robot.mass_matrix,
        robot.center_of_mass,
        lambda q: robot.accelerations(q, q, q),
        lambda q: bik.Trajectory.from_samples([0.0, 1.0], [q, q]).torques(robot, 0.5),
    ]
    for call in calls:
        with pytest.raises(bik.InvalidInputError) as told:
            call([0.5])
        assert str(told.value) == f"robot 'pendulum' has no dynamics: {problem}"
    mended = robot.with_inertias({"rod": bik.Inertia("rod", 2.0, (0, 0, -0.5), np.diag([0.02, 0.03, 0.04]))})
    np.testing.assert_allclose(mended.torques([0.5]), pendulum().torques([0.5]), atol=1e-14)


def test_friction_that_is_negative_is_told_by_name() -> None:
    robot = pendulum(swing='<dynamics damping="-1"/>')
    with pytest.raises(bik.InvalidInputError) as told:
        robot.torques([0.5])
    expected = "URDF line 5: dynamics damping of joint 'swing' is -1: it cannot be negative"
    assert str(told.value) == f"robot 'pendulum' has no dynamics: {expected}"


def test_an_impossible_matrix_on_the_base_does_no_harm() -> None:
    flat = INERTIAL.format(mass=2, matrix='ixx="1" iyy="1" izz="3"')
    whole = PENDULUM.format(rod=BOB, swing="")
    xml = whole.replace('<link name="base"/>', f'<link name="base">{flat}</link>')
    robot = bik.Robot.from_urdf(xml)
    np.testing.assert_array_equal(robot.torques([0.5]), pendulum().torques([0.5]))
    np.testing.assert_allclose(robot.center_of_mass([0.0]), [0.0, 0.0, -0.5])
    driving = robot.with_mobile_base("planar", lower=[-1, -1, -1], upper=[1, 1, 1])
    assert not driving.has_dynamics


def test_a_joint_without_mass_beyond_it_is_named() -> None:
    robot = bik.Robot.planar([0.5, 0.4]).with_inertias({"link_1": bik.Inertia("link_1", 1.0)})
    with pytest.raises(bik.InvalidInputError, match="joint 'joint_2' moves no mass: give them by") as told:
        robot.torques([0.0, 0.0])
    assert "robot 'planar2' has no dynamics" in str(told.value)
    assert robot.with_payload(0.5).has_dynamics


def test_a_singular_mass_matrix_is_told() -> None:
    # A point on the second axis: that joint moves nothing.
    robot = bik.Robot.planar([0.5, 0.4]).with_inertias({"link_2": bik.Inertia("link_2", 1.0)})
    assert robot.has_dynamics
    with pytest.raises(bik.InvalidInputError) as told:
        robot.accelerations([[0.0, 1.0]], [[0.0, 0.0]], [[1.0, 1.0]])
    assert str(told.value) == (
        "configuration 0: the mass matrix of robot 'planar2' is singular: joint 'joint_2' and those before it can move "
        "without moving mass"
    )


def test_masses_are_part_of_a_robot() -> None:
    robot = with_masses(PANDA, 1).with_payload(1.0).with_gravity((0, 0, -1.62))
    assert robot != PANDA
    again = pickle.loads(pickle.dumps(robot))
    assert again == robot
    assert hash(again) == hash(robot)
    assert (again.inertias, again.payloads, again.gravity.tolist()) == (robot.inertias, robot.payloads, [0, 0, -1.62])
    np.testing.assert_array_equal(again.torques(Q), robot.torques(Q))
    inertia = robot.inertias[0]
    assert pickle.loads(pickle.dumps(inertia)) == inertia
    assert hash(inertia) == hash(robot.inertias[0])
    moved = robot.with_base(bik.pose([1, 2, 3])).with_limits(velocity=1.0).with_tool(bik.pose([0, 0, 0.1]))
    np.testing.assert_allclose(moved.torques(Q), robot.torques(Q), atol=1e-12)


def test_stores_of_chunks_know_masses() -> None:
    from beetle_ik.chunked.fingerprint import description

    assert description(PANDA) != description(PANDA.with_payload(1.0))
    assert description(PANDA) != description(PANDA.with_gravity((0, 0, 0)))
    assert description(PANDA.with_payload(1.0)) == description(bik.Robot.named("panda").with_payload(1.0))


def test_a_panda_is_as_heavy_as_the_identified_one() -> None:
    assert PANDA.has_dynamics
    assert sum(inertia.mass for inertia in PANDA.inertias) == pytest.approx(16.691901)
    np.testing.assert_array_equal(PANDA.torque_limit, [87, 87, 87, 87, 12, 12, 12])
    without = [name for name in bik.Robot.names() if not bik.Robot.named(name).has_dynamics]
    assert sorted(set(bik.Robot.names()) - set(without)) == ["panda"]


def test_torques_of_a_motion_are_those_at_its_times() -> None:
    plan = bik.plan_point_to_point(PANDA, start_q=Q, end_q=Q + 0.3, limits=bik.Limits(velocity=1.0, acceleration=2.0))
    times = np.linspace(0.0, plan.trajectory.duration, 11)
    expected = PANDA.torques(*plan.trajectory.at(times))
    np.testing.assert_array_equal(plan.torques(times), expected)
    np.testing.assert_array_equal(plan.trajectory.torques(PANDA, times), expected)
    np.testing.assert_array_equal(plan.torques(times[3]), expected[3])


def test_plots_draw_torques_where_there_are_masses() -> None:
    pytest.importorskip("matplotlib")
    plan = bik.plan_point_to_point(PANDA, start_q=Q, end_q=Q + 0.3, limits=bik.Limits(velocity=1.0, acceleration=2.0))
    labels = [axes.get_ylabel() for part in plan.plot().subfigs for axes in part.axes]
    assert labels.count("torque [N m, N]") == 1
    motion = plan.trajectory
    assert [axes.get_ylabel() for axes in bik.plot.trajectory(motion, robot=PANDA).axes][-1] == "torque [N m, N]"
    assert "torque [N m, N]" not in [axes.get_ylabel() for axes in motion.plot().axes]


WRONG: list[tuple[Any, str]] = [
    (lambda: PANDA.torques(Q[:6]), "joint angles of robot 'panda': expected 7 joints, got 6"),
    (
        lambda: PANDA.torques(Q, np.zeros((1, 7))),
        "joint velocities of robot 'panda': expected shape (7,), that of the joint angles, got (1, 7)",
    ),
    (
        lambda: PANDA.torques([Q, Q], qdd=Q),
        "joint accelerations of robot 'panda': expected shape (2, 7), that of the joint angles, got (7,)",
    ),
    (
        lambda: PANDA.torques(Q, Q * np.nan),
        "joint velocities must be finite, but joint 'panda_joint1' of configuration 0 is NaN",
    ),
    (lambda: PANDA.torques(Q, wrench=[1, 2, 3]), "wrench of robot 'panda': expected shape (6,), got (3,)"),
    (
        lambda: PANDA.torques([Q, Q], wrench=np.zeros((3, 6))),
        "wrench of robot 'panda': expected shape (6,) or (2, 6), got (3, 6)",
    ),
    (lambda: PANDA.torques(Q, wrench=[np.inf] * 6), "wrench must be finite, but entry 0 is inf"),
    (
        lambda: PANDA.accelerations(Q, Q, Q[:3]),
        "joint torques of robot 'panda': expected shape (7,), that of the joint angles, got (3,)",
    ),
    (
        lambda: PANDA.torques(Q, 1e160 * np.ones(7)),
        "torque of joint 'panda_joint1' of robot 'panda' must be a number that floats can hold: what causes it is too "
        "large, got NaN",
    ),
    (
        lambda: PANDA.accelerations([Q, Q], [np.zeros(7), 1e160 * np.ones(7)], np.zeros((2, 7))),
        "acceleration of joint 'panda_joint1' of robot 'panda', row 1, must be a number that floats can hold: what "
        "causes it is too large, got NaN",
    ),
    (lambda: PANDA.with_payload(-1.0), "payload: the mass is -1 kg: it cannot be negative"),
    (
        lambda: PANDA.with_payload(1e308, center=(0, 0, 0.05)),
        "payload: mass, centre and inertia matrix must be at most 1e50, got 1e308",
    ),
    (lambda: PANDA.with_payload(np.nan), "payload: mass, centre and inertia matrix must be finite, got NaN"),
    (
        lambda: PANDA.with_payload(1.0, matrix=[[1, 1, 0], [0, 1, 0], [0, 0, 1]]),
        "payload: the inertia matrix is not symmetric: xy = 1 differs from yx = 0",
    ),
    (lambda: PANDA.with_payload(1.0, center=[0, 0]), "centre: expected shape (3,), got (2,)"),
    (lambda: PANDA.with_payload(1.0, matrix=[1, 1, 1]), "matrix: expected shape (3, 3), got (3,)"),
    (lambda: PANDA.with_gravity([0, 0, np.nan]), "gravity must be finite, but entry 2 is NaN"),
    (lambda: bik.Inertia("rod", -2.0), "inertia of link 'rod': the mass is -2 kg: it cannot be negative"),
    (
        lambda: PANDA.with_inertias({"link_1": bik.Inertia("link_2", 1.0)}),
        "inertias: the entry 'link_1' has the inertia of link 'link_2'",
    ),
    (
        lambda: PANDA.with_inertias(3),  # type: ignore[arg-type]
        "inertias must be a dict {link: Inertia(...)} or a list of Inertia, got 3",
    ),
    (
        lambda: bik.Trajectory.from_samples([0.0, 1.0], [[0.0], [1.0]]).torques(PANDA, 0.5),
        "robot 'panda' has 7 joints, and the trajectory 1 joint",
    ),
]


@pytest.mark.parametrize(("call", "message"), WRONG)
def test_wrong_arguments_are_named(call: Any, message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as told:
        call()
    assert str(told.value) == message


def test_unknown_links_are_named_with_the_nearest() -> None:
    with pytest.raises(bik.UnknownNameError, match="has no link 'flang' \\(did you mean 'flange'\\?\\)"):
        PANDA.with_payload(1.0, link="flang")
    with pytest.raises(bik.UnknownNameError, match="did you mean 'link_1'"):
        PANDA.with_inertias([bik.Inertia("link1", 1.0)])
    pair = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
    with pytest.raises(bik.InvalidInputError, match="give the one that carries the payload as link="):
        pair.with_payload(1.0)
    assert pair.with_payload(1.0, link="left_tool").payloads[0].mass == 1.0


def test_a_matrix_without_a_mass_turns_as_in_pinocchio() -> None:
    pinocchio = pytest.importorskip("pinocchio")
    pad = INERTIAL.format(mass=0, matrix='ixx="0.1" iyy="0.2" izz="0.15" ixy="0" ixz="0" iyz="0"')
    fixed = '<joint name="f" type="fixed"> <parent link="rod"/> <child link="pad"/> <origin rpy="0.3 0.2 0"/> </joint>'
    xml = PENDULUM.format(rod=BOB, swing="").replace("</robot>", f'<link name="pad">{pad}</link> {fixed} </robot>')
    model = pinocchio.buildModelFromXML(xml)
    q = np.array([np.cos(0.4), np.sin(0.4)])
    expected = pinocchio.rnea(model, model.createData(), q, np.array([1.0]), np.array([2.0]))
    robot = bik.Robot.from_urdf(xml)
    np.testing.assert_allclose(robot.torques([0.4], [1.0], [2.0]), expected, atol=1e-12)
    assert abs(robot.mass_matrix([0.4]) - pendulum().mass_matrix([0.4])).max() > 0.1
