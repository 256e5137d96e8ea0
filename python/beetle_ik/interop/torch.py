"""Kinematics with derivatives for PyTorch: functions of autograd, over any leading axes, also under `torch.func`.

The core computes on the CPU in float64, all rows in one call; results have the type and device of the input, so that
tensors on a GPU are copied there and back. A row with NaN gives NaN. Derivatives are of reverse mode.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

from .._core import InvalidInputError, Robot
from ..installed.needs import library
from .derivatives import checks, functions
from .derivatives.curvature import require_single_joints

Tensor: TypeAlias = Any  # torch.Tensor


def fk(robot: Robot, *, link: str | None = None) -> Callable[[Tensor], Tensor]:
    """Returns forward kinematics as a function of q (..., n): poses (..., 4, 4), of several tips (..., tips, 4, 4).

    Args:
        robot: the arm.
        link: link whose pose is wanted; None: the tip.

    First derivatives are exact; second ones are those of `jacobian`.

    Raises:
        BeetleIkError: PyTorch is not installed.
        InvalidInputError: not a `Robot`, or q of another length.
        UnknownNameError: no link of that name; the message lists them.
    """
    checks.of_robot(robot)
    compute = functions.poses(robot, link)
    tips, jacobian_of = checks.axis_of_tips(robot, link), jacobian(robot, link=link)

    def pull(gradient: Tensor, pose: Tensor, q: Tensor) -> tuple[Tensor]:
        pulled = _torch().einsum("...ij,...i->...j", jacobian_of(q), _wrench(gradient, pose))
        return (pulled.sum(-2) if tips else pulled,)

    rule = _Rule(compute, pull)
    return lambda q: _apply(rule, _joints("q", q, robot))


def jacobian(robot: Robot, *, link: str | None = None) -> Callable[[Tensor], Tensor]:
    """Returns `Robot.jacobian` as a function of q (..., n): (..., 6, n), of several tips (..., tips, 6, n).

    Args:
        robot: the arm.
        link: link whose Jacobian is wanted; None: the tip.

    The derivative by q is exact, for robots with one tip and links of the chain.

    Raises:
        BeetleIkError: PyTorch is not installed.
        InvalidInputError: not a `Robot`, or q of another length; differentiated, if the robot has several tips, mimic
            joints or a floating base, or the link is beside the chain.
        UnknownNameError: no link of that name; the message lists them.
    """
    checks.of_robot(robot)
    compute = functions.jacobians(robot, link)
    bend = _last("a Jacobian", functions.curvatures(robot, link))

    def pull(gradient: Tensor, _jacobian: Tensor, q: Tensor) -> tuple[Tensor]:
        require_single_joints(robot, link)
        return (_torch().einsum("...ij,...ijk->...k", gradient, _apply(bend, q)),)

    rule = _Rule(compute, pull)
    return lambda q: _apply(rule, _joints("q", q, robot))


def solve(robot: Robot, *, damping: float = 1e-4, success: bool = False) -> Callable[..., Any]:
    """Returns inverse kinematics as a function of a target and a start (..., n): the q (..., n) of `solve_batch`.

    Args:
        robot: the arm.
        damping: singular value of the Jacobian (m/rad, 1) below which derivatives are damped.
        success: whether the function returns (q, reached), with reached (...) True where the target is reached to
            1e-6 m and rad.

    Targets and derivatives are those of `interop.jax.solve`, without second derivatives.

    Raises:
        BeetleIkError: PyTorch is not installed.
        InvalidInputError: not a `Robot`, another shape, a damping that is not positive, a target that is not a rigid
            transform (names the row), or a second derivative.
    """
    checks.of_robot(robot)
    damping = checks.damping_of(damping)
    _torch()

    def apply(target: Tensor, start_q: Tensor | None = None) -> Any:
        target = _floating(target)
        rows, axes = checks.rows_of_target(target.shape, robot)
        given = (target,) if start_q is None else (target, _joints("start_q", start_q, robot))
        found = _apply(_solving(robot, rows, damping, (axes, 1)[: len(given)]), *given)
        return (found[..., :-1], found[..., -1] > 0.5) if success else found[..., :-1]

    return apply


def clearance(robot: Robot, scene: Any = None) -> Callable[[Tensor], Tensor]:
    """Returns `obstacles.clearance` as a function of q (..., n): (...), the smallest distance (m).

    Args:
        robot: an arm with bodies.
        scene: a `Scene` or obstacles, in the frame of the robot's base; None: the robot's own links alone.

    The gradient is that of the nearest pair; where two are equally near, of one of them. Where the axes of two capsules
    cross, it points along their way apart. Where nothing can touch, the distance is inf and its gradient zero. There is
    no second derivative.

    Raises:
        BeetleIkError: PyTorch is not installed.
        InvalidInputError: not a `Robot`, a robot without bodies, another length of q, or a second derivative.
    """
    checks.of_robot(robot)
    scene = checks.scene_of(scene)
    compute = functions.clearances(robot, scene)
    slope = _last("a distance", functions.clearance_gradients(robot, scene))

    def pull(gradient: Tensor, _distance: Tensor, q: Tensor) -> tuple[Tensor]:
        return (gradient[..., None] * _apply(slope, q),)

    rule = _Rule(compute, pull)
    return lambda q: _apply(rule, _joints("q", q, robot))


def smoothness(path: Tensor, *, order: int = 2, weights: Any = 1.0) -> Tensor:
    """Returns the sum of squared differences of a path's configurations, a cost that needs no times: (...).

    Args:
        path: configurations (..., m, n).
        order: 1: of neighbours, a short path; 2: of these differences, a straight one; 3: of slowly changing bends.
        weights: weight of each joint, a number or (n,).

    Raises:
        BeetleIkError: PyTorch is not installed.
        InvalidInputError: another order, or fewer than order + 1 configurations.
    """
    path = _floating(path)
    checks.differences_of(path.shape, order)
    weights = _torch().as_tensor(weights, dtype=path.dtype, device=path.device)
    return (weights * path.diff(n=order, dim=-2) ** 2).sum((-2, -1))


@dataclass(frozen=True)
class _Rule:
    """A function of the core; `pull(gradient, result, *inputs)` returns the gradients of the inputs."""

    compute: functions.RowFunction
    pull: Callable[..., tuple[Tensor, ...]]


def _solving(robot: Robot, rows: int, damping: float, ndims: tuple[int, ...]) -> _Rule:
    several, size = len(robot.tips) > 1, rows * len(robot.tips)
    follow = _last("a solution", functions.ways(robot, rows, damping))

    def pull(gradient: Tensor, found: Tensor, target: Tensor, *_start: Tensor) -> tuple[Tensor, ...]:
        ways = _apply(follow, found[..., :-1], found[..., -1])
        pulled = _torch().einsum("...ij,...i->...j", ways, gradient[..., :-1])
        by_target = pulled[..., :size]
        if several:
            by_target = by_target.reshape(*by_target.shape[:-1], len(robot.tips), rows)
        by_target = _change(by_target, target) if rows == 6 else by_target
        return (by_target, pulled[..., size:])[: len(ndims)]

    return _Rule(functions.solved(robot, ndims), pull)


def _last(what: str, compute: functions.RowFunction) -> _Rule:
    """Returns a rule that says so if it is differentiated."""

    def refuse(*_values: Tensor) -> Any:
        raise InvalidInputError(f"interop.torch has no higher derivative of {what}")

    return _Rule(compute, refuse)


def _apply(rule: _Rule, *tensors: Tensor) -> Tensor:
    """Applies a function to tensors whose leading axes are broadcast first, so that autograd sums over them."""
    torch = _torch()
    ndims = rule.compute.ndims
    leading = torch.broadcast_shapes(*(x.shape[: x.ndim - k] for x, k in zip(tensors, ndims, strict=True)))
    spread = [x.expand(leading + x.shape[x.ndim - k :]) for x, k in zip(tensors, ndims, strict=True)]
    return _function().apply(rule, *spread)


@lru_cache(maxsize=1)
def _function() -> Any:
    torch = _torch()

    class Computed(torch.autograd.Function):  # type: ignore[misc,name-defined]
        """Calls the core; its methods are those that PyTorch asks of a function."""

        @staticmethod
        def forward(rule: _Rule, *tensors: Tensor) -> Tensor:
            values = [tensor.detach().cpu().numpy() for tensor in tensors]
            result = rule.compute(*values)
            kind = torch.result_type(*tensors) if len(tensors) == 2 else tensors[0].dtype
            return torch.from_numpy(result).to(device=tensors[0].device, dtype=kind)

        @staticmethod
        def setup_context(ctx: Any, inputs: tuple[Any, ...], output: Tensor) -> None:
            ctx.rule = inputs[0]
            ctx.save_for_backward(output, *inputs[1:])

        @staticmethod
        def backward(ctx: Any, gradient: Tensor) -> tuple[Any, ...]:
            return (None, *ctx.rule.pull(gradient, *ctx.saved_tensors))

        @staticmethod
        def vmap(info: Any, in_dims: tuple[Any, ...], rule: _Rule, *tensors: Tensor) -> tuple[Tensor, int]:
            rows = [
                tensor.expand(info.batch_size, *tensor.shape) if axis is None else tensor.movedim(axis, 0)
                for tensor, axis in zip(tensors, in_dims[1:], strict=True)
            ]
            return _apply(rule, *rows), 0

    return Computed


def _torch() -> Any:
    return library("torch", "torch", "interop.torch", extra="torch")


def _joints(name: str, q: Tensor, robot: Robot) -> Tensor:
    """Returns joint positions as a tensor of a floating type, whose shape is checked."""
    q = _floating(q)
    checks.shape_of_joints(name, q.shape, robot)
    return q


def _floating(values: Any) -> Tensor:
    torch = _torch()
    values = torch.as_tensor(values)
    return values if values.is_floating_point() else values.to(torch.get_default_dtype())


def _wrench(gradient: Tensor, pose: Tensor) -> Tensor:
    """Returns the gradient (..., 6) by the twist of a pose, from the one by its 16 numbers (..., 4, 4)."""
    torch = _torch()
    turning = torch.linalg.cross(pose[..., :3, :3], gradient[..., :3, :3], dim=-2).sum(-1)
    return torch.cat((gradient[..., :3, 3], turning), dim=-1)


def _change(wrench: Tensor, pose: Tensor) -> Tensor:
    """Returns the gradient (..., 4, 4) by the numbers of a pose, from the one by its twist (..., 6)."""
    torch = _torch()
    turning = torch.linalg.cross(wrench[..., 3:, None].expand_as(pose[..., :3, :3]), pose[..., :3, :3], dim=-2)
    upper = torch.cat((0.5 * turning, wrench[..., :3, None]), dim=-1)
    return torch.cat((upper, torch.zeros_like(upper[..., :1, :])), dim=-2)
