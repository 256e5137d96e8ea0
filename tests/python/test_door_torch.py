"""`interop.torch` by gradcheck and against the plain calls. Skipped if PyTorch is not installed."""

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik
from beetle_ik.interop import torch as door

torch = pytest.importorskip("torch", reason="PyTorch is not installed")
pytestmark = pytest.mark.filterwarnings("ignore::FutureWarning:torch")
UR5, PANDA = bik.Robot.named("ur5e"), bik.Robot.named("panda")
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
THICK = PANDA.with_capsules(radius=0.02)
SPHERE = bik.obstacles.Sphere((0.5, 0.2, 0.4), 0.1)
BENT = np.array([[0.3, -0.4, 0.2, -1.9, 0.1, 1.6, 0.7], [0.1, 0.5, -0.3, -1.2, 0.6, 1.1, -0.2]])
UR5_BENT = np.array([[0.3, -1.2, 1.4, -0.8, -1.1, 0.5], [-0.7, -0.9, 1.1, 0.4, 1.3, 0.2]])


def tensor(values: Any) -> Any:
    return torch.tensor(values, dtype=torch.float64, requires_grad=True)


def spread(robot: bik.Robot) -> Any:
    return tensor(0.5 * (robot.lower + robot.upper) + 0.3 * np.sin(np.arange(2 * robot.dof)).reshape(2, -1))


@pytest.mark.parametrize("robot", [PANDA, PAIR, bik.Robot.planar([0.5, 0.4])], ids=["panda", "pair", "planar"])
def test_kinematics_pass_gradcheck(robot: bik.Robot) -> None:
    q = tensor(BENT) if robot is PANDA else spread(robot) if robot is PAIR else tensor([[0.2, 0.5], [0.0, 0.0]])
    assert torch.autograd.gradcheck(door.fk(robot), q)
    if robot is not PAIR:
        assert torch.autograd.gradgradcheck(door.fk(robot), q)
        assert torch.autograd.gradcheck(door.jacobian(robot), q)


def turned(twist: Any, poses: Any) -> Any:
    """Poses (m, 4, 4) that twists (m, 6) move."""
    x, y, z = twist[:, 3], twist[:, 4], twist[:, 5]
    rows = [torch.stack(row, -1) for row in ((0 * x, -z, y), (z, 0 * x, -x), (-y, x, 0 * x))]
    rotation = torch.linalg.matrix_exp(torch.stack(rows, -2)) @ poses[:, :3, :3]
    upper = torch.cat((rotation, (poses[:, :3, 3] + twist[:, :3])[..., None]), -1)
    return torch.cat((upper, poses[:, 3:]), -2)


@pytest.mark.parametrize(("robot", "q"), [(UR5, UR5_BENT), (PANDA, BENT)], ids=["ur5e", "panda"])
def test_solutions_pass_gradcheck(robot: bik.Robot, q: np.ndarray) -> None:
    poses, start, solve = torch.tensor(robot.fk(q)), torch.tensor(q), door.solve(robot)
    twist = tensor(np.zeros((2, 6)))
    assert torch.autograd.gradcheck(lambda twist: solve(turned(twist, poses), start), twist, eps=1e-6, atol=1e-6)
    assert torch.autograd.gradcheck(lambda q: solve(door.fk(robot)(q), q), tensor(q), eps=1e-6, atol=1e-6)


def test_a_batch_is_one_of_the_core_and_is_broadcast() -> None:
    q = PANDA.random_configurations(1000, seed=1)
    targets = PANDA.fk(q)
    found, reached = door.solve(PANDA, success=True)(torch.tensor(targets), torch.tensor(q[0]))
    plain = bik.solve_batch(PANDA, targets, start_q=q[0], position_tolerance=1e-12, rotation_tolerance=1e-12)
    np.testing.assert_array_equal(found, plain.q)
    assert reached.all()
    start = tensor(BENT[0])
    door.solve(PANDA)(torch.tensor(PANDA.fk(BENT)), start).sum().backward()
    assert start.grad.shape == (7,)


def test_it_works_under_vmap_and_grad_of_torch_func() -> None:
    solve, q = door.solve(PANDA), torch.tensor(BENT)
    each = torch.func.vmap(torch.func.grad(lambda x, start: solve(door.fk(PANDA)(x), start).sum()), (0, None))(q, q[0])
    x = tensor(BENT)
    solve(door.fk(PANDA)(x), q[0]).sum().backward()
    np.testing.assert_allclose(each, x.grad, atol=1e-12)


def test_clearance_and_smoothness_pass_gradcheck() -> None:
    q = THICK.random_configurations(40, seed=5)
    q = q[bik.obstacles.clearance(THICK, q, [SPHERE]) > 0.02][:5]
    assert torch.autograd.gradcheck(door.clearance(THICK, [SPHERE]), tensor(q), atol=1e-4)
    for order in (1, 2, 3):
        assert torch.autograd.gradcheck(lambda path, order=order: door.smoothness(path, order=order), tensor(BENT.T))


def test_types_stay_and_nan_gives_nan() -> None:
    q = torch.tensor(BENT, dtype=torch.float32)
    q[1] = torch.nan
    poses = door.fk(PANDA)(q)
    found = door.solve(PANDA)(poses, q)
    assert (poses.dtype, found.dtype) == (torch.float32, torch.float32)
    np.testing.assert_allclose(found[0], BENT[0], atol=1e-5)
    assert torch.isnan(found[1]).all()


def test_wrong_input_says_what_is_expected() -> None:
    for call, message in (
        (lambda: door.fk(PANDA)(torch.zeros(6)), "q: expected shape (..., 7), one per joint of 'panda', got (6,)"),
        (
            lambda: door.solve(PANDA)(torch.eye(4) * 2),
            "row 0: target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)",
        ),
        (lambda: door.solve(PANDA, damping=-1), "damping must be a positive number, got -1"),
        (
            lambda: torch.autograd.functional.hessian(door.clearance(THICK), torch.tensor(BENT[0])),
            "interop.torch has no higher derivative of a distance",
        ),
    ):
        with pytest.raises(bik.InvalidInputError) as caught:
            call()
        assert str(caught.value) == message


def test_without_torch_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(bik.BeetleIkError) as caught:
        door.solve(PANDA)
    assert str(caught.value) == "interop.torch needs torch: pip install 'beetle-ik[torch]'"


def test_the_block_of_the_page_runs() -> None:
    page = Path(__file__).parents[2] / "docs" / "derivatives.md"
    blocks = re.findall(r"^```py\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    (block,) = (block for block in blocks if block.startswith("import torch\n"))
    exec(compile(block, page.name, "exec"), {})
