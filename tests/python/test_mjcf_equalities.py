"""Equality constraints of MuJoCo models: followed, refused or warned about. MuJoCo's kinematics are the oracle."""

import warnings
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed")

# Reference positions of the joints, in their order; `f` and `g` are those of a gripper beside the chain.
RESTS = {"a": 0.0, "b": 0.3, "c": 0.0, "d": -0.2, "e": 0.1, "f": 0.0, "g": 0.1}


def arm(equality: str = "", *, head: str = "", scene: str = "", tendon: str = "") -> str:
    """Returns an arm of five joints with a gripper of two fingers, which meet at their reference positions."""
    axes = {"a": "0 0 1", "b": "0 1 0", "c": "0 1 0", "d": "1 0 0", "e": "1 1 0"}
    bodies = "".join(
        f"<body name='body_{name}' pos='0 0.02 0.3'>"
        f"<joint name='{name}' axis='{axis}' range='-2 2' ref='{RESTS[name]}'/><geom size='.02'/>"
        for name, axis in axes.items()
    )
    fingers = (
        "<body name='left' pos='0 .05 .1'><joint name='f' axis='1 0 0' range='-1 1'/><geom size='.01'/>"
        "<site name='left_end' pos='0 0 .1'/></body>"
        "<body name='right' pos='0 -.05 .1'><joint name='g' axis='1 0 0' range='-1 1' ref='.1'/><geom size='.01'/>"
        "<site name='right_end' pos='0 .1 .1'/><site name='apart' pos='0 0 .1'/></body>"
    )
    return (
        f"<mujoco model='arm'><compiler angle='radian' autolimits='true'/>{head}<worldbody>"
        f"<site name='anchor' pos='1 0 0'/>{bodies}<site name='tool' pos='0 0 .1'/>{fingers}"
        f"{'</body>' * len(axes)}{scene}</worldbody>{tendon}<equality>{equality}</equality></mujoco>"
    )


def joint(follower: str, factors: str, master: str = "", more: str = "") -> str:
    second = f"joint2='{master}' " if master else ""
    return f"<joint joint1='{follower}' {second}polycoef='{factors}' {more}/>"


TENDONS = (
    "<tendon><fixed name='two'><joint joint='c' coef='1'/><joint joint='d' coef='2'/></fixed>"
    "<fixed name='one'><joint joint='b' coef='-.5'/></fixed><fixed name='other'><joint joint='e' coef='1'/></fixed>"
    "<spatial name='fingers'><site site='left_end'/><site site='right_end'/></spatial>"
    "<spatial name='rope'><site site='left_end'/><site site='anchor'/></spatial></tendon>"
)
FREE_BODY = "<body name='part' pos='1 0 0'><freejoint/><geom size='.01'/></body>"
HAND_TARGET = "<body name='hand_target' mocap='true' pos='1 0 0'/>"

# What is followed: the model, the independent joints, and the positions of others (a number, or a formula of q).
FOLLOWED: dict[str, tuple[str, str, dict[str, Any]]] = {
    "a lock": (arm(joint("b", "0.25 0 0 0 0")), "acde", {"b": 0.3 + 0.25}),
    "a lock by a factor of zero": (arm(joint("b", "0.25 0 0 0 0", "c")), "acde", {"b": 0.55}),
    "a weld of one joint": (arm("<weld body1='body_d' body2='body_c'/>"), "abce", {"d": -0.2}),
    "a line": (arm(joint("d", "0.1 0.5 0 0 0", "b")), "abce", {"d": lambda q: -0.2 + 0.1 + 0.5 * (q["b"] - 0.3)}),
    "a follower of a locked joint": (
        arm(joint("d", "0 2 0 0 0", "b") + joint("b", "0.25 0 0 0 0")),
        "ace",
        {"b": 0.55, "d": -0.2 + 2 * 0.25},
    ),
    "a bend of a locked joint": (
        arm(joint("d", "0 0 1 0 0", "b") + joint("b", "0 0 0 0 0") + joint("d", "0 0 0 0 0")),
        "ace",
        {"b": 0.3, "d": -0.2},
    ),
    "one joint followed by two": (
        arm(joint("d", "0 1 0 0 0", "b") + joint("d", "0 2 0 0 0", "c")),
        "ace",
        {"b": lambda q: 0.3 + 2 * q["c"], "d": lambda q: -0.2 + 2 * q["c"]},
    ),
    "both ways": (
        arm(joint("d", "0 .5 0 0 0", "c") + joint("c", "0 2 0 0 0", "d")),
        "abce",
        {"d": lambda q: -0.2 + 0.5 * q["c"]},
    ),
    "a tendon of two joints": (
        arm("<tendon tendon1='two' polycoef='.1 0 0 0 0'/>", tendon=TENDONS),
        "abce",
        {"d": lambda q: -0.2 + 0.5 * (0.1 - q["c"])},
    ),
    "two tendons": (
        arm("<tendon tendon1='one' tendon2='other' polycoef='.1 .5 0 0 0'/>", tendon=TENDONS),
        "acde",
        {"b": lambda q: 0.3 - 2 * (0.1 + 0.5 * (q["e"] - 0.1))},
    ),
    "a tendon of three joints, one locked": (
        arm("<tendon tendon1='two' tendon2='one'/>" + joint("b", "0 0 0 0 0"), tendon=TENDONS),
        "ace",
        {"b": 0.3, "d": lambda q: -0.2 - 0.5 * q["c"]},
    ),
    "an inactive one": (arm(joint("d", "0 .5 .2 0 0", "c", "active='false'")), "abcde", {}),
    "all switched off": (
        arm(joint("d", "0 .5 .2 0 0", "c"), head="<option><flag equality='disable'/></option>"),
        "abcde",
        {},
    ),
    "a class that is inactive": (
        arm(
            joint("d", "0 .5 .2 0 0", "c", "class='off'"),
            head="<default><default class='off'><equality active='false'/></default></default>",
        ),
        "abcde",
        {},
    ),
    "a loop of the gripper": (arm("<connect body1='left' body2='right' anchor='0 0 .1'/>"), "abcde", {}),
    "a rope of the gripper": (arm("<tendon tendon1='fingers'/>", tendon=TENDONS), "abcde", {}),
    "a bend of the gripper": (arm(joint("f", "0 1 1 0 0", "g")), "abcde", {"f": 0.0, "g": 0.1}),
    "a bend": (arm(joint("d", "0 .5 .2 0 0", "c")), "abce", {"d": lambda q: -0.2 + 0.5 * q["c"] + 0.2 * q["c"] ** 2}),
    "a bend of references": (
        arm(joint("e", "0 .5 .2 0 0", "b")),
        "abcd",
        {"e": lambda q: 0.1 + 0.5 * (q["b"] - 0.3) + 0.2 * (q["b"] - 0.3) ** 2},
    ),
    "a cubic without a linear term": (
        arm(joint("d", "0 0 0 .2 0", "c")),
        "abce",
        {"d": lambda q: -0.2 + 0.2 * q["c"] ** 3},
    ),
    "a quartic that turns back": (
        arm(joint("d", "0 .5 -.4 0 .1", "c")),
        "abce",
        {"d": lambda q: -0.2 + 0.5 * q["c"] - 0.4 * q["c"] ** 2 + 0.1 * q["c"] ** 4},
    ),
    "a bend of a leader farther out": (
        arm(joint("b", "0 .5 .2 0 0", "d")),
        "acde",
        {"b": lambda q: 0.3 + 0.5 * (q["d"] + 0.2) + 0.2 * (q["d"] + 0.2) ** 2},
    ),
    "a bend beside the chain": (
        arm(joint("f", "0 .3 .1 0 0", "c")),
        "abcde",
        {"f": lambda q: 0.3 * q["c"] + 0.1 * q["c"] ** 2},
    ),
    "a line along a bend": (
        arm(joint("d", "0 .5 .2 0 0", "c") + joint("e", "0 .5 0 0 0", "d")),
        "abc",
        {
            "d": lambda q: -0.2 + 0.5 * q["c"] + 0.2 * q["c"] ** 2,
            "e": lambda q: 0.1 + 0.5 * (0.5 * q["c"] + 0.2 * q["c"] ** 2),
        },
    ),
    "a bend along a line": (
        arm(joint("d", "0 .5 .2 0 0", "c") + joint("c", "0 .5 0 0 0", "a")),
        "abe",
        {"c": lambda q: 0.5 * q["a"], "d": lambda q: -0.2 + 0.25 * q["a"] + 0.05 * q["a"] ** 2},
    ),
    "a bend of a lock": (
        arm(joint("d", "0 .5 .2 0 0", "b") + joint("b", "0.25 0 0 0 0")),
        "ace",
        {"b": 0.55, "d": -0.2 + 0.5 * 0.25 + 0.2 * 0.25**2},
    ),
    "a part in the hand": (arm("<weld body1='body_e' body2='part'/>", scene=FREE_BODY), "abcde", {}),
    "a part welded to the world": (arm("<weld body1='part'/>", scene=FREE_BODY), "abcde", {}),
    "a base led by a mocap body": (arm("<weld body1='body_a' body2='hand_target'/>", scene=HAND_TARGET), "abcde", {}),
    "a hand led by a mocap body": (arm("<weld body1='body_e' body2='hand_target'/>", scene=HAND_TARGET), "abcde", {}),
}


@pytest.mark.parametrize("name", FOLLOWED)
def test_followed_equalities_put_the_tip_where_mujoco_does(name: str) -> None:
    text, independent, others = FOLLOWED[name]
    robot = bik.Robot.from_mjcf(text, tip="tool")
    assert "".join(robot.joint_names) == independent
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for q in robot.random_configurations(10, seed=1):
        known = dict(zip(robot.joint_names, q, strict=True))
        for joint_name, value in known.items():
            data.joint(joint_name).qpos = value
        for joint_name, formula in others.items():
            data.joint(joint_name).qpos = formula(known) if callable(formula) else formula
        mujoco.mj_kinematics(model, data)
        np.testing.assert_allclose(robot.fk(q)[:3, 3], data.site("tool").xpos, rtol=0, atol=1e-12)
        for body in ("left", "right"):
            np.testing.assert_allclose(robot.fk(q, link=body)[:3, 3], data.body(body).xpos, rtol=0, atol=1e-12)


SIDE = (
    "which is not followed (locks and couplings of two joints are, where they agree): choose base and tip on one side "
    "of it, or set active='false' if the motion of the tip does not depend on it"
)
REFUSED = {
    "two locks": (
        arm(joint("b", "0.25 0 0 0 0", "", "name='low'") + joint("b", "0.5 0 0 0 0", "", "name='high'")),
        "the joint equality 'high' of 'b'",
        "b",
    ),
    "a weld beside the chain against couplings that fix its joint elsewhere": (
        arm(
            joint("b", "-0.25 -0.5 0 0 0", "g")
            + joint("g", "-0.04 -1 0 0 0", "b")
            + "<weld body1='body_e' body2='right'/>"
        ),
        "the weld equality of 'body_e' and 'right'",
        "g",
    ),
    "a weld beside the chain against a lock of a joint that bends the chain": (
        arm(joint("g", "1 0 0 0 0", "") + joint("b", "0 0 0 0 1", "g") + "<weld body1='body_e' body2='right'/>"),
        "the weld equality of 'body_e' and 'right'",
        "g",
    ),
    "two bends of a joint": (
        arm(joint("d", "0 .5 .2 0 0", "c") + joint("d", "0 .5 .3 0 0", "b", "name='bend'")),
        "the joint equality 'bend' of 'd' and 'b'",
        "b, d",
    ),
    "a bend of a bend": (
        arm(joint("d", "0 .5 .2 0 0", "c") + joint("e", "0 .5 .2 0 0", "d", "name='bend'")),
        "the joint equality 'bend' of 'e' and 'd'",
        "d, e",
    ),
    "bends in a circle": (
        arm(joint("d", "0 .5 .2 0 0", "c") + joint("c", "0 .5 .2 0 0", "d", "name='bend'")),
        "the joint equality 'bend' of 'c' and 'd'",
        "c, d",
    ),
    "a weld to the world": (
        arm("<weld name='hold' body1='body_e'/>"),
        "the weld equality 'hold' of 'body_e' and 'world'",
        "a, b, c, d, e",
    ),
    "a connect": (
        arm("<connect body1='body_e' body2='body_b' anchor='0 0 .1'/>"),
        "the connect equality of 'body_e' and 'body_b'",
        "c, d, e",
    ),
    "a connect of sites": (
        arm("<connect site1='tool' site2='anchor'/>"),
        "the connect equality of 'body_e' and 'world'",
        "a, b, c, d, e",
    ),
    "a tendon of three joints": (
        arm("<tendon tendon1='two' tendon2='one'/>", tendon=TENDONS),
        "the tendon equality of 'two' and 'one'",
        "b, c, d",
    ),
    "a rope": (arm("<tendon tendon1='rope'/>", tendon=TENDONS), "the tendon equality of 'rope'", "a, b, c, d, e, f"),
    "a bent tendon": (
        arm("<tendon tendon1='one' tendon2='other' polycoef='0 1 1 0 0'/>", tendon=TENDONS),
        "the tendon equality of 'one' and 'other'",
        "b, e",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_loops_and_bends_of_the_chain_are_refused_by_name(name: str) -> None:
    text, equality, joints = REFUSED[name]
    with pytest.raises(bik.InvalidInputError) as told:
        bik.Robot.from_mjcf(text, tip="tool")
    assert str(told.value) == f"MuJoCo model: {equality} couples the joints {joints}, {SIDE}"


def test_equalities_that_lock_a_joint_outside_its_range_are_refused() -> None:
    beside = "<joint joint1='f' joint2='c' polycoef='.25 .004 0 0 0'/><joint joint1='f' polycoef='.125 0 0 0 0'/>"
    with pytest.raises(bik.InvalidInputError, match=r"equalities lock joint 'c' at -31.25, outside its range from"):
        bik.Robot.from_mjcf(arm(beside), tip="tool")


def test_a_loop_is_refused_only_if_the_chain_takes_part() -> None:
    loop = arm("<connect body1='left' body2='right' anchor='0 0 .1'/>")
    assert bik.Robot.from_mjcf(loop, tip="tool").held_joints == {"f": 0.0, "g": 0.1}
    with pytest.raises(bik.InvalidInputError, match="couples the joints f, g"):
        bik.Robot.from_mjcf(loop, tip="left_end")
    with pytest.raises(bik.InvalidInputError, match="couples the joints f, g"):
        bik.Robot.from_mjcf(loop, tip=["left", "right"])


def test_a_gripper_held_open_beside_a_loop_is_warned_about() -> None:
    loop = arm("<connect name='ring' body1='left' body2='right' anchor='0 0 .1'/>")
    told = (
        r"MuJoCo model: the connect equality 'ring' of 'left' and 'right' is open by 0.0\d+ \(m or rad\) where joints "
        r"beside the chain are held: bodies there may stand elsewhere in MuJoCo; hold=\.\.\. closes it"
    )
    with pytest.warns(UserWarning, match=told) as caught:
        robot = bik.Robot.from_mjcf(loop, tip="tool", hold={"f": 0.5})
    assert [warning.filename for warning in caught] == [__file__]
    assert robot.held_joints == {"f": 0.5, "g": 0.1}


def test_a_parallelogram_whose_joints_are_coupled_is_followed() -> None:
    sides = """<mujoco><compiler angle='radian' autolimits='true'/><worldbody><body name='crank'>
      <joint name='crank' axis='0 1 0' range='-1 1'/><geom size='.01'/><body name='coupler' pos='0 0 .3'>
      <joint name='level' axis='0 1 0'/><geom size='.01'/><site name='tool' pos='.5 0 0'/></body></body>
      <body name='rocker' pos='.2 0 0'><joint name='rocker' axis='0 1 0'/><geom size='.01'/></body>
      </worldbody><equality>
      <joint joint1='level' joint2='crank' polycoef='0 -1 0 0 0'/><joint joint1='rocker' joint2='crank'/>
      <connect body1='coupler' body2='rocker' anchor='.2 0 0'/></equality></mujoco>"""
    robot = bik.Robot.from_mjcf(sides, tip="tool")
    assert robot.joint_names == ["crank"]
    np.testing.assert_allclose(robot.fk([0.5])[:3, 3], [0.5 + 0.3 * np.sin(0.5), 0, 0.3 * np.cos(0.5)], atol=1e-12)
    with pytest.raises(bik.InvalidInputError, match="the connect equality of 'coupler' and 'rocker' couples"):
        bik.Robot.from_mjcf(sides.replace("0 -1 0 0 0", "0 -1.1 0 0 0"), tip="tool")


def test_linear_couplings_hold_for_drawn_factors() -> None:
    rng = np.random.default_rng(3)
    drawn = lambda: float(rng.choice([0.0, 1.0, -1.0, 0.5, rng.uniform(-1, 1)]))  # noqa: E731
    names = list(RESTS)
    for _ in range(60):
        ends = [tuple(rng.permutation(names)[:2]) for _ in range(rng.integers(1, 4))]
        factors = [(drawn() / 4, drawn()) for _ in ends]
        text = arm(
            "".join(joint(one, f"{c} {s} 0 0 0", other) for (one, other), (c, s) in zip(ends, factors, strict=True))
        )
        # One row per equality: q_one - rest_one - c - s (q_other - rest_other) = 0.
        rows, totals = np.zeros((len(ends), len(names))), np.zeros(len(ends))
        for i, ((one, other), (c, s)) in enumerate(zip(ends, factors, strict=True)):
            rows[i, names.index(one)] += 1.0
            rows[i, names.index(other)] -= s
            totals[i] = RESTS[one] + c - s * RESTS[other]
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                robot = bik.Robot.from_mjcf(text, tip="tool")
        except (bik.InvalidInputError, bik.LimitError):
            continue  # contradictory equalities, or ranges that exclude each other
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        for q in robot.random_configurations(3, seed=1):
            known = dict(zip(robot.joint_names, q, strict=True)) | robot.held_joints
            rest = [name for name in names if name not in known]
            at = [names.index(name) for name in rest]
            value = totals - sum(rows[:, names.index(name)] * known[name] for name in known)
            found = np.linalg.lstsq(rows[:, at], value, rcond=None)[0] if at else []
            for name, position in (known | dict(zip(rest, found, strict=True))).items():
                data.joint(name).qpos = position
            mujoco.mj_kinematics(model, data)
            np.testing.assert_allclose(robot.fk(q)[:3, 3], data.site("tool").xpos, rtol=0, atol=1e-9)


def bent(coefficients: str, *, leader: str = "-1.5 1.5", follower: str = "-9 9", more: str = "") -> str:
    """Returns an arm whose third joint follows the second one, and whose fifth, a slide, follows the fourth."""
    axes = {"a": "0 0 1", "b": "0 1 0", "c": "0 1 0", "d": "1 0 0", "s": "0 0 1", "e": "0 1 0", "g": "1 1 0"}
    ranges = {"b": leader, "c": follower}
    bodies = "".join(
        f"<body name='body_{name}' pos='0 .01 .2'><joint name='{name}' axis='{axis}' damping='{int(name == 'a')}' "
        f"type='{'slide' if name == 's' else 'hinge'}' range='{ranges.get(name, '-2 2')}'/>"
        f"<geom type='capsule' size='.03' fromto='0 0 0 0 0 .15' mass='1'/>"
        for name, axis in axes.items()
    )
    return (
        f"<mujoco><compiler angle='radian' autolimits='true'/><option integrator='Euler'/><worldbody>{bodies}"
        f"<site name='tool' pos='0 0 .1'/>{'</body>' * len(axes)}</worldbody><equality>"
        f"{joint('c', coefficients, 'b')}{joint('s', '.01 .05 .02 -.01 0', 'd')}{more}</equality></mujoco>"
    )


CURVES = ["0 .5 .2 0 0", "0 0 .4 0 0", "0 0 0 .25 0", "0 .5 -.4 -.3 .1", "0 1 0 -1 0"]
"""Among them curves that turn back, and without a linear term."""


@pytest.mark.parametrize("coefficients", CURVES)
def test_jacobians_of_bent_joints_agree_with_differences(coefficients: str) -> None:
    robot = bik.Robot.from_mjcf(bent(coefficients), tip="tool")
    assert robot.joint_names == ["a", "b", "d", "e", "g"]
    step = 1e-6
    for q in robot.random_configurations(10, seed=2):
        for link in (None, "body_c", "body_s"):
            jacobian = robot.jacobian(q, link=link)
            for j in range(robot.dof):
                ends = [robot.fk(q + sign * step * np.eye(robot.dof)[j], link=link) for sign in (1.0, -1.0)]
                turned = (ends[0][:3, :3] @ ends[1][:3, :3].T - ends[1][:3, :3] @ ends[0][:3, :3].T) / 2
                rate = np.concatenate((ends[0][:3, 3] - ends[1][:3, 3], [turned[2, 1], turned[0, 2], turned[1, 0]]))
                np.testing.assert_allclose(jacobian[:, j], rate / (2 * step), rtol=0, atol=1e-8)


@pytest.mark.parametrize("coefficients", CURVES)
def test_torques_of_bent_joints_are_those_of_mujoco(coefficients: str) -> None:
    text = bent(coefficients)
    robot, model = bik.Robot.from_mjcf(text, tip="tool"), mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    factors = [np.polynomial.Polynomial([float(c) for c in coefficients.split()])]
    factors.append(np.polynomial.Polynomial([0.01, 0.05, 0.02, -0.01]))
    rng = np.random.default_rng(7)
    for q in robot.random_configurations(10, seed=3):
        qd, qdd = rng.uniform(-2, 2, (2, robot.dof))
        # Positions of all joints are y(q); y' = D qd and y'' = D qdd + d, and torques of q are D' times those of y.
        to_all = np.zeros((7, 5))
        for row, column in zip([0, 1, 3, 5, 6], range(5), strict=True):
            to_all[row, column] = 1.0
        positions, bias = to_all @ q, np.zeros(7)
        for row, column, factor in zip([2, 4], [1, 2], factors, strict=True):
            positions[row], to_all[row, column] = factor(q[column]), factor.deriv()(q[column])
            bias[row] = factor.deriv(2)(q[column]) * qd[column] ** 2
        data.qpos, data.qvel, data.qacc = positions, to_all @ qd, to_all @ qdd + bias
        model.opt.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        mujoco.mj_inverse(model, data)
        np.testing.assert_allclose(robot.torques(q, qd, qdd), to_all.T @ data.qfrc_inverse, rtol=0, atol=1e-9)
        mass = np.zeros((7, 7))
        mujoco.mj_fullM(model, data, mass)
        np.testing.assert_allclose(robot.mass_matrix(q), to_all.T @ mass @ to_all, rtol=0, atol=1e-9)


@pytest.mark.parametrize("coefficients", CURVES)
def test_bent_joints_are_solved_planned_and_tracked(coefficients: str) -> None:
    robot = bik.Robot.from_mjcf(bent(coefficients), tip="tool")
    assert robot.closed_form == "none: a joint follows another one by a polynomial"
    limits = bik.Limits(velocity=1.0, acceleration=5.0)
    ball = bik.obstacles.Sphere([0.35, 0.2, 0.7], 0.15)
    starts, ends = robot.random_configurations(12, seed=4).reshape(2, 6, robot.dof)
    for start, end in zip(starts, ends, strict=True):
        found = bik.solve(robot, robot.fk(end)[:3, 3], start_q=start)
        assert found.success
        np.testing.assert_allclose(robot.fk(found.q)[:3, 3], robot.fk(end)[:3, 3], rtol=0, atol=1e-6)
        tracker = bik.Tracker(robot, start, dt=0.01, limits=limits)
        target = robot.fk(start)
        target[:3, 3] += [0.0, 0.0, -0.02]
        positions = [tracker.step(target).q for _ in range(300)]
        np.testing.assert_array_less(np.abs(np.diff(positions, axis=0)), 1.0 * 0.01 + 1e-12)
        if bik.obstacles.clearance(robot, [start, end], [ball]).min() > 0.01:
            plan = bik.plan_point_to_point(robot, start_q=start, end_q=end, limits=limits, obstacles=[ball])
            if plan.success:
                times = np.linspace(0, plan.trajectory.duration, 400)
                apart = bik.obstacles.clearance(robot, plan.trajectory.at(times)[0], [ball])
                assert apart.min() >= plan.clearance - 1e-9


def test_a_leader_stays_where_its_follower_is_inside_its_range() -> None:
    # Follower 0.8 (x^2 - 1) x: inside [-0.1, 0.1] on three stretches, the middle one has the reference position.
    robot = bik.Robot.from_mjcf(bent("0 -.8 0 .8 0", follower="-.1 .1"), tip="tool")
    inner = min(abs(np.polynomial.Polynomial([-0.1, -0.8, 0.0, 0.8]).roots()))
    np.testing.assert_allclose([robot.lower[1], robot.upper[1]], [-inner, inner], rtol=0, atol=1e-12)
    with pytest.raises(bik.InvalidInputError) as told:
        bik.Robot.from_mjcf(bent("3 0 1 0 0", follower="-.1 .1"), tip="tool")
    assert str(told.value) == (
        "MuJoCo model: joint 'c' follows 'b' by a polynomial, and leaves its range wherever 'b' is inside its own"
    )


def test_calls_that_cannot_follow_a_bend_name_the_joint() -> None:
    robot = bik.Robot.from_mjcf(bent("0 .5 .2 0 0"), tip="tool")
    q = np.zeros(robot.dof)
    reason = "cannot be computed where a joint follows another one, 'b', by a polynomial"
    for call, what in [
        (lambda: robot.manipulability_gradient(q), "the gradient of manipulability"),
        (lambda: robot.link_manipulability(q), "the manipulability of links"),
        (
            lambda: bik.solve(robot, robot.fk(q), goals=[bik.goals.Manipulability()]),
            "a goal of manipulability or torques",
        ),
        (lambda: bik.solve(robot, robot.fk(q), goals=[bik.goals.LeastTorque()]), "a goal of manipulability or torques"),
    ]:
        with pytest.raises(bik.InvalidInputError) as told:
            call()
        assert str(told.value) == f"{what} {reason}"
    endless = bent("0 .5 .2 0 0", leader="0 0")
    with pytest.raises(bik.BeetleIkError, match="a joint follows joint 'b' by a polynomial: give 'b' position limits"):
        bik.Robot.from_mjcf(endless.replace("range='0 0'", "limited='false'").replace("range='-9 9'", ""), tip="tool")
    rotor = bent("0 .5 .2 0 0").replace("<joint name='c'", "<joint armature='.1' name='c'")
    with pytest.raises(bik.BeetleIkError, match="joint 'c' follows 'b' by a polynomial and has friction or a rotor"):
        bik.Robot.from_mjcf(rotor, tip="tool").mass_matrix(q)
