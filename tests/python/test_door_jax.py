"""`interop.jax` against finite differences, Pinocchio and the plain calls. Skipped if JAX is not installed."""
# ruff: noqa: E501 -- messages are in one piece

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik
from beetle_ik.interop import jax as door
from beetle_ik.interop.derivatives import following

jax = pytest.importorskip("jax", reason="JAX is not installed")
jnp = jax.numpy
UR5, PANDA = bik.Robot.named("ur5e"), bik.Robot.named("panda")
THICK = PANDA.with_capsules(radius=0.02)
SPHERE = bik.obstacles.Sphere((0.5, 0.2, 0.4), 0.1)
BENT = np.array([0.3, -0.4, 0.2, -1.9, 0.1, 1.6, 0.7])
TWIN = """<robot name="twin"><link name="base"/><link name="arm"/><link name="hand"/>
  <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="k" type="revolute"><parent link="arm"/><child link="hand"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/><mimic joint="j" multiplier="-0.5"/></joint></robot>"""
MIMIC = bik.Robot.from_urdf(TWIN).with_tool(bik.pose([0.4, 0.0, 0.1]))
FLOATING = UR5.with_mobile_base("floating", lower=[-1.0] * 6, upper=[1.0] * 6, velocity=[1.0] * 6)
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
ROBOTS = {"ur5e": UR5, "panda": PANDA, "mimic": MIMIC, "floating": FLOATING, "pair": PAIR}


@pytest.fixture(autouse=True)
def _double_precision() -> Iterator[None]:
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


def differences(function: Callable[[Any], Any], at: np.ndarray, step: float = 1e-5) -> np.ndarray:
    """Central differences of fourth order, the component last."""
    columns = []
    for unit in np.eye(at.size):
        first, second = (
            (np.asarray(function(at + k * unit)) - np.asarray(function(at - k * unit))) / (2 * k)
            for k in (step, 2 * step)
        )
        columns.append((4 * first - second) / 3)
    return np.stack(columns, axis=-1)


def moved(poses: np.ndarray, twist: np.ndarray) -> np.ndarray:
    """Poses (m, 4, 4) that a small twist moves: their origins, and their axes about the axes of the base."""
    result = poses.copy()
    result[:, :3, 3] += twist[:3]
    result[:, :3, :3] = bik.pose(np.zeros(3), rotvec=twist[3:])[:3, :3] @ poses[:, :3, :3]
    return result


def rates(poses: np.ndarray) -> np.ndarray:
    """Derivatives (6, m, 4, 4) of `moved` by each component of the twist, at zero."""
    result = np.zeros((6, *poses.shape))
    for k, unit in enumerate(np.eye(3)):
        result[k, :, :3, 3] = unit
        result[k + 3, :, :3, :3] = np.cross(unit, poses[:, :3, :3], axisb=1, axisc=1)
    return result


# --- forward kinematics ---------------------------------------------------------------------------


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_derivatives_of_poses_are_those_of_differences(robot: bik.Robot) -> None:
    q = np.array([*robot.random_configurations(3, seed=1), np.zeros(robot.dof)])
    expected = [differences(robot.fk, row) for row in q]
    for derivative in (jax.jacfwd, jax.jacrev):
        np.testing.assert_allclose(jax.jit(jax.vmap(derivative(door.fk(robot))))(q), expected, atol=1e-8)


def test_derivatives_of_poses_are_those_of_pinocchio() -> None:
    pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
    model = bik.interop.to_pinocchio(PANDA)
    data, frame = model.createData(), model.getFrameId("tool")
    for q in PANDA.random_configurations(5, seed=2):
        expected = pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL_WORLD_ALIGNED)
        change = np.asarray(jax.jacfwd(door.fk(PANDA))(q))
        turning = np.einsum("ijk,lj->ilk", change[:3, :3], PANDA.fk(q)[:3, :3])
        np.testing.assert_allclose(change[:3, 3], expected[:3], atol=1e-12)
        np.testing.assert_allclose([turning[2, 1], turning[0, 2], turning[1, 0]], expected[3:], atol=1e-12)
        np.testing.assert_allclose(door.jacobian(PANDA)(q), expected, atol=1e-12)


@pytest.mark.parametrize("robot", [UR5, PANDA, bik.Robot.planar([0.5, 0.4])], ids=lambda robot: robot.name)
@pytest.mark.parametrize("link", [False, True])
def test_second_derivatives_are_those_of_differences(robot: bik.Robot, link: bool) -> None:
    name = robot.link_names[-2] if link else None
    q = np.array([*robot.random_configurations(3, seed=1), np.zeros(robot.dof)])
    expected = [differences(lambda row: robot.jacobian(row, link=name), row) for row in q]
    found = jax.jit(jax.vmap(jax.jacfwd(door.jacobian(robot, link=name))))(q)
    np.testing.assert_allclose(found, expected, atol=1e-8)


# --- solutions ------------------------------------------------------------------------------------


@pytest.mark.parametrize("robot", [UR5, PANDA], ids=lambda robot: robot.name)
def test_gradients_through_1000_solutions_are_exact(robot: bik.Robot) -> None:
    q = robot.clip(robot.random_configurations(2000, seed=3) * 0.9)
    inside = np.minimum(q - robot.lower, robot.upper - q).min(axis=1) > 0.02
    regular = np.linalg.svd(robot.jacobian(q), compute_uv=False).min(axis=1) > 0.02
    q = q[inside & regular][:1000]
    assert len(q) == 1000
    targets, weights = robot.fk(q), np.random.default_rng(0).normal(size=q.shape)
    solve = door.solve(robot)
    gradient = jax.jit(jax.vmap(jax.grad(lambda target, start, weight: weight @ solve(target, start))))
    found = np.einsum("mij,kmij->km", gradient(targets, q, weights), rates(targets))

    def cost(twist: np.ndarray) -> np.ndarray:
        batch = bik.solve_batch(
            robot, moved(targets, twist), start_q=q, position_tolerance=1e-12, rotation_tolerance=1e-12
        )
        return np.einsum("mi,mi->m", weights, batch.q)

    expected = differences(cost, np.zeros(6)).T
    error = np.linalg.norm(found - expected, axis=0) / np.linalg.norm(expected, axis=0)
    assert error.max() < 1e-6


def test_a_vmap_is_one_batch_of_the_core(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes: list[int] = []
    monkeypatch.setattr(
        following,
        "solve_batch",
        lambda *given, **options: sizes.append(len(given[1])) or bik.solve_batch(*given, **options),
    )
    q = PANDA.random_configurations(10_000, seed=1)
    targets = PANDA.fk(q)
    found = jax.jit(jax.vmap(door.solve(PANDA)))(targets, q).block_until_ready()
    assert sizes == [10_000]
    plain = bik.solve_batch(PANDA, targets, start_q=q, position_tolerance=1e-12, rotation_tolerance=1e-12)
    np.testing.assert_array_equal(found, plain.q)
    both = jax.vmap(jax.vmap(door.solve(PANDA), (None, 0)), (0, None))(targets[:3], q[:4])
    assert both.shape == (3, 4, 7)
    np.testing.assert_allclose(door.fk(PANDA)(both), np.broadcast_to(targets[:3, None], (3, 4, 4, 4)), atol=1e-9)


def test_a_redundant_arm_follows_with_the_least_motion() -> None:
    solve, target = door.solve(PANDA), PANDA.fk(BENT)
    by_target = np.einsum("nij,kij->nk", jax.jacobian(solve)(target, BENT), rates(target[None])[:, 0])
    jacobian = PANDA.jacobian(BENT)
    np.testing.assert_allclose(by_target, np.linalg.pinv(jacobian), atol=1e-10)
    by_start = jax.jacobian(solve, argnums=1)(target, BENT)
    np.testing.assert_allclose(by_start, np.eye(7) - np.linalg.pinv(jacobian) @ jacobian, atol=1e-10)


def test_solutions_have_second_derivatives() -> None:
    q = np.array([0.3, -1.2, 1.4, -0.8, -1.1, 0.5])
    solve, start = door.solve(UR5), q + 0.01
    bent = jax.jit(jax.hessian(lambda x: jnp.sum(jnp.sin(solve(door.fk(UR5)(x), start)))))(q)  # of x itself
    np.testing.assert_allclose(bent, np.diag(-np.sin(q)), atol=1e-8)


def test_positions_and_several_tips_are_targets_too() -> None:
    place = UR5.fk([0.3, -1.2, 1.4, -0.8, -1.1, 0.5])[:3, 3]
    start = np.array([0.3, -1.2, 1.4, -0.8, -1.1, 0.5])
    motion = jax.jacobian(door.solve(UR5))(place, start)
    np.testing.assert_allclose(UR5.jacobian(start)[:3] @ motion, np.eye(3), atol=1e-10)
    q = PAIR.clip(np.full(PAIR.dof, 0.2) + np.tile([0, 0, 0, -1.5], 4)[: PAIR.dof])
    q = 0.5 * q + 0.5 * PAIR.random_configurations(1, seed=2)[0]
    identity = jax.jit(jax.jacfwd(lambda x: door.solve(PAIR)(door.fk(PAIR)(x), x)))(q)
    np.testing.assert_allclose(identity, np.eye(PAIR.dof), atol=1e-7)


def test_a_singular_arm_has_bounded_derivatives() -> None:
    straight = np.array([0.0, -np.pi / 2, 0.0, -0.5, 0.8, 0.0])  # the elbow is stretched
    target = UR5.fk(straight)
    motion = np.einsum(
        "nij,kij->nk", jax.jacobian(door.solve(UR5, damping=0.01))(target, straight), rates(target[None])[:, 0]
    )
    assert np.linalg.norm(motion, 2) <= 100.0 + 1e-9
    left, values, _ = np.linalg.svd(UR5.jacobian(straight))
    assert values[-1] < 1e-12
    np.testing.assert_allclose(motion @ left[:, -1], 0.0, atol=1e-9)  # the direction that is lost


def test_a_joint_at_its_limit_is_held_or_led_inside() -> None:
    at_limit = BENT.copy()
    at_limit[1] = PANDA.upper[1]
    target = PANDA.fk(at_limit)
    motion = np.einsum("nij,kij->nk", jax.jacobian(door.solve(PANDA))(target, at_limit), rates(target[None])[:, 0])
    np.testing.assert_array_equal(motion[1], 0.0)
    np.testing.assert_allclose(PANDA.jacobian(at_limit) @ motion, np.eye(6), atol=1e-8)
    narrow = UR5.with_limits(upper=[0.3, 7.0, 7.0, 7.0, 7.0, 7.0])
    q = np.array([0.3, -1.2, 1.4, -0.8, -1.1, 0.5])
    target = narrow.fk(q)
    motion = np.einsum("nij,kij->nk", jax.jacobian(door.solve(narrow))(target, q), rates(target[None])[:, 0])
    np.testing.assert_allclose(motion, np.linalg.inv(narrow.jacobian(q)), atol=1e-9)


def test_a_target_out_of_reach_says_so_and_has_a_derivative() -> None:
    target = bik.pose([3.0, 0.5, 0.4])
    q, reached = door.solve(UR5, success=True)(target, np.zeros(6))
    assert reached == 0.0
    assert np.isfinite(q).all()
    assert np.isfinite(jax.jacobian(door.solve(UR5))(target, np.zeros(6))).all()


# --- distances and paths --------------------------------------------------------------------------


def test_gradients_of_clearance_are_those_of_differences() -> None:
    function = door.clearance(THICK, [SPHERE])
    q = THICK.random_configurations(60, seed=5)
    q = q[bik.obstacles.clearance(THICK, q, [SPHERE]) > 0.005]
    np.testing.assert_array_equal(jax.vmap(function)(q), bik.obstacles.clearance(THICK, q, [SPHERE]))
    found = jax.jit(jax.vmap(jax.grad(function)))(q)
    expected = [differences(lambda q: bik.obstacles.clearance(THICK, q, [SPHERE]), row, 1e-4) for row in q]
    close = np.isclose(found, expected, atol=1e-5).all(axis=1)
    assert close.mean() > 0.9  # others change their nearest pair within the step
    assert len(q) > 20


def test_nothing_near_has_no_slope() -> None:
    alone = bik.Robot.planar([0.5, 0.4]).with_capsules(radius=0.02)
    function = door.clearance(alone)
    assert np.isinf(function(np.zeros(2)))
    np.testing.assert_array_equal(jax.grad(function)(np.zeros(2)), 0.0)


def test_smoothness_is_a_sum_of_squared_differences() -> None:
    path = np.random.default_rng(2).normal(size=(4, 9, 3))
    for order in (1, 2, 3):
        expected = (np.diff(path, n=order, axis=1) ** 2 * [1.0, 2.0, 0.5]).sum(axis=(1, 2))
        np.testing.assert_allclose(door.smoothness(path, order=order, weights=[1.0, 2.0, 0.5]), expected)
    np.testing.assert_allclose(jax.grad(door.smoothness)(np.linspace(0.0, 1.0, 12).reshape(6, 2)), 0.0, atol=1e-12)


# --- types, rows, errors --------------------------------------------------------------------------


def test_single_precision_stays_single_and_the_switch_as_it_was() -> None:
    jax.config.update("jax_enable_x64", False)
    q = jnp.asarray(BENT)
    pose = door.fk(PANDA)(q)
    found, slope = door.solve(PANDA)(pose, q), jax.grad(lambda q: door.fk(PANDA)(q)[0, 3])(q)
    assert {pose.dtype, found.dtype, slope.dtype} == {np.dtype(np.float32)}
    np.testing.assert_allclose(found, BENT, atol=1e-5)
    assert not jax.config.jax_enable_x64


def test_a_row_with_nan_gives_nan_and_leaves_the_others() -> None:
    q = np.array([BENT, np.full(7, np.nan), BENT])
    poses = np.asarray(jax.vmap(door.fk(PANDA))(q))
    assert np.isnan(poses).any(axis=(1, 2)).tolist() == [False, True, False]
    found = np.asarray(jax.vmap(door.solve(PANDA))(poses, np.array([BENT] * 3)))
    assert np.isnan(found).all(axis=1).tolist() == [False, True, False]


def test_large_batches_do_not_hang_on_one_core() -> None:
    program = """if True:
        import os, sys
        if hasattr(os, "sched_setaffinity"):
            os.sched_setaffinity(0, {next(iter(os.sched_getaffinity(0)))})
        import jax, beetle_ik as bik
        from beetle_ik.interop import jax as door
        robot = bik.Robot.named("ur5e")
        q = robot.random_configurations(20_000, seed=1)
        function = lambda q: door.fk(robot)(q)[0, 3] + door.jacobian(robot)(q)[0, 0]
        print(jax.jit(jax.vmap(jax.grad(function)))(q).block_until_ready().shape)"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=120, env=dict(os.environ)
    )
    assert done.stdout == "(20000, 6)\n", done.stderr


Q = np.zeros(7)
WRONG: list[tuple[Callable[[], object], str]] = [
    (lambda: door.fk("panda"), "robot must be a Robot, such as Robot.named('panda'), got 'panda'"),  # type: ignore[arg-type]
    (lambda: door.fk(PANDA)(np.zeros(6)), "q: expected shape (..., 7), one per joint of 'panda', got (6,)"),
    (lambda: door.jacobian(PANDA)(0.0), "q: expected shape (..., 7), one per joint of 'panda', got ()"),
    (
        lambda: door.solve(PANDA)(np.eye(4), np.zeros(6)),
        "start_q: expected shape (..., 7), one per joint of 'panda', got (6,)",
    ),
    (
        lambda: door.solve(PANDA)(np.zeros((3, 2)), Q),
        "target: expected poses (..., 4, 4) or positions (..., 3), got shape (3, 2)",
    ),
    (lambda: door.solve(PAIR)(np.eye(4)), "target: expected poses (..., 2, 4, 4), one per tip, got shape (4, 4)"),
    (lambda: door.solve(PANDA, damping=0.0), "damping must be a positive number, got 0.0"),
    (lambda: door.smoothness(np.zeros((5, 2)), order=4), "order must be 1, 2 or 3, got 4"),
    (
        lambda: door.smoothness(np.zeros((2, 3))),
        "path: expected configurations (..., m, n) with m of at least 3 for order 2, got (2, 3)",
    ),
    (lambda: jax.hessian(door.clearance(THICK))(Q), "interop.jax has no higher derivative of a distance"),
    (
        lambda: jax.jacobian(jax.jacobian(door.jacobian(UR5)))(np.zeros(6)),
        "interop.jax has no higher derivative of a Jacobian",
    ),
    (
        lambda: jax.jacobian(door.jacobian(PAIR))(np.zeros(PAIR.dof)),
        "a second derivative takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as tip=",
    ),
    (
        lambda: jax.jacobian(door.jacobian(MIMIC))(np.zeros(1)),
        "joint 'j' of robot 'twin' has mimic joints: it has first derivatives alone",
    ),
]


@pytest.mark.parametrize(("call", "message"), WRONG, ids=range(len(WRONG)))
def test_wrong_input_says_what_is_expected(call: Callable[[], object], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()
    assert str(caught.value) == message


def test_links_that_are_none_and_robots_without_bodies_are_refused() -> None:
    with pytest.raises(bik.UnknownNameError, match=r"^robot 'panda' has no link 'hnd'; its links: base"):
        door.fk(PANDA, link="hnd")
    with pytest.raises(bik.InvalidInputError, match=r"^robot 'iiwa14' has no capsules"):
        door.clearance(bik.Robot.named("iiwa14"))


def test_a_target_that_is_no_pose_is_an_error_of_jax() -> None:
    with pytest.raises(jax.errors.JaxRuntimeError, match=r"row 0: target is not a rigid transform"):
        door.solve(PANDA)(np.diag([2.0, 2.0, 2.0, 1.0]), Q).block_until_ready()


def test_without_jax_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    door._fk.cache_clear()
    monkeypatch.setitem(sys.modules, "jax", None)
    with pytest.raises(bik.BeetleIkError) as caught:
        door.fk(PANDA)
    assert str(caught.value) == "interop.jax needs jax: pip install 'beetle-ik[jax]'"


def test_the_block_of_the_page_runs() -> None:
    page = Path(__file__).parents[2] / "docs" / "derivatives.md"
    blocks = re.findall(r"^```py\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    (block,) = (block for block in blocks if block.startswith("import jax\n"))
    exec(compile(block, page.name, "exec"), {})
