"""Kinematics with derivatives for JAX: under `jit`, `vmap`, `grad`, `jacfwd` and `jacrev`.

The core computes, and takes all rows of a `vmap` in one call. Leading axes are rows too: q (..., n).

JAX computes in float32 unless you call `jax.config.update("jax_enable_x64", True)`, which this module leaves to you.
Without it float32 goes in, the core computes in float64, and its results are rounded to float32. A row with NaN gives
NaN.
"""

from collections.abc import Callable
from functools import lru_cache, partial
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np

from .._core import InvalidInputError, Robot
from ..installed.needs import library
from ..scenes import Scene
from .derivatives import checks, functions
from .derivatives.curvature import require_single_joints

Array: TypeAlias = Any  # jax.Array


def fk(robot: Robot, *, link: str | None = None) -> Callable[[Array], Array]:
    """Returns forward kinematics as a function of q (..., n): poses (..., 4, 4), of several tips (..., tips, 4, 4).

    Args:
        robot: the arm.
        link: link whose pose is wanted; None: the tip.

    First derivatives are exact; second ones are those of `jacobian`.

    Raises:
        BeetleIkError: JAX is not installed.
        InvalidInputError: not a `Robot`, or q of another length.
        UnknownNameError: no link of that name; the message lists them.
    """
    checks.of_robot(robot)
    differentiable = _fk(robot, link)
    return lambda q: differentiable(_joints("q", q, robot))


def jacobian(robot: Robot, *, link: str | None = None) -> Callable[[Array], Array]:
    """Returns `Robot.jacobian` as a function of q (..., n): (..., 6, n), of several tips (..., tips, 6, n).

    Args:
        robot: the arm.
        link: link whose Jacobian is wanted; None: the tip.

    The derivative by q is exact, for robots with one tip and links of the chain.

    Raises:
        BeetleIkError: JAX is not installed.
        InvalidInputError: not a `Robot`, or q of another length; differentiated, if the robot has several tips, mimic
            joints or a floating base, or the link is beside the chain.
        UnknownNameError: no link of that name; the message lists them.
    """
    checks.of_robot(robot)
    differentiable = _jacobian(robot, link)
    return lambda q: differentiable(_joints("q", q, robot))


def solve(robot: Robot, *, damping: float = 1e-4, success: bool = False) -> Callable[..., Any]:
    """Returns inverse kinematics as a function of target and start (..., n): the q (..., n) of `solve_batch`.

    Args:
        robot: the arm.
        damping: singular value of the Jacobian (m/rad, 1) below which derivatives are damped.
        success: whether the function returns (q, reached), with reached (...) 1 where the target is reached to 1e-6 m
            and rad, else 0.

    Targets are poses (..., 4, 4), positions (..., 3) with the orientation left free, or for several tips poses (...,
    tips, 4, 4). The start may be left out. An unreachable target gives the nearest configuration that `solve` found.

    The derivative is that of the implicit function theorem: the joints follow the target by J^+, the pseudoinverse of
    the Jacobian, the least motion of a redundant arm. By the start it is I - J^+ J, what a redundant arm is free to do:
    zero for others. For a redundant arm, both are exact where the start is a solution, and nearly so in a stream of
    targets; from a start farther away the search itself adds curvature, which is left out. Of a pose, only rigid
    motions count: derivatives by its 16 numbers are projected onto these.

    - Near singularities, singular values s of J below `damping` count as s / damping^2 instead of 1 / s in J^+:
      derivatives stay below 1 / damping and vanish along directions that are lost.
    - A joint at its limit is held where the others can follow without it. Where they cannot, the derivative is
      one-sided: it holds for targets that lead the joint inside.
    - Out of reach, joints at limits are held, and the others follow as far as they can; the curvature of the error is
      left out.

    Raises:
        BeetleIkError: JAX is not installed.
        InvalidInputError: not a `Robot`, another shape, or a damping that is not positive. A target that is not a rigid
            transform is noticed when the program runs, and so an error of JAX that holds the message.
    """
    checks.of_robot(robot)
    damping = checks.damping_of(damping)
    _jax()

    def apply(target: Array, start_q: Array | None = None) -> Any:
        target = _floating(target)
        rows, _ = checks.rows_of_target(target.shape, robot)
        if start_q is None:
            found = _solve(robot, rows, damping, False)(target)
        else:
            found = _solve(robot, rows, damping, True)(target, _joints("start_q", start_q, robot))
        return found if success else found[0]

    return apply


def clearance(robot: Robot, scene: Any = None) -> Callable[[Array], Array]:
    """Returns `obstacles.clearance` as a function of q (..., n): (...), the smallest distance (m).

    Args:
        robot: an arm with bodies.
        scene: a `Scene` or obstacles, in the frame of the robot's base; None: the robot's own links alone.

    The gradient is that of the nearest pair; where two are equally near, of one of them. Where the axes of two capsules
    cross, it points along their way apart. Where nothing can touch, the distance is inf and its gradient zero. There is
    no second derivative.

    Raises:
        BeetleIkError: JAX is not installed.
        InvalidInputError: not a `Robot`, a robot without bodies, another length of q, or a second derivative.
    """
    checks.of_robot(robot)
    differentiable = _clearance(robot, checks.scene_of(scene))
    return lambda q: differentiable(_joints("q", q, robot))


def smoothness(path: Array, *, order: int = 2, weights: Any = 1.0) -> Array:
    """Returns the sum of squared differences of a path's configurations, a cost that needs no times: (...).

    Args:
        path: configurations (..., m, n).
        order: 1: of neighbours, a short path; 2: of these differences, a straight one; 3: of slowly changing bends.
        weights: weight of each joint, a number or (n,).

    Raises:
        BeetleIkError: JAX is not installed.
        InvalidInputError: another order, or fewer than order + 1 configurations.
    """
    jnp = _jax().numpy
    path = jnp.asarray(path)
    checks.differences_of(path.shape, order)
    return jnp.sum(jnp.asarray(weights) * jnp.diff(path, n=order, axis=-2) ** 2, axis=(-2, -1))


# Functions are kept for each robot: JAX compiles a function once, and would compile new ones again.


@lru_cache(maxsize=64)
def _fk(robot: Robot, link: str | None) -> Callable[[Array], Array]:
    jnp, compute = _jax().numpy, functions.poses(robot, link)
    jacobian_of, tips = _jacobian(robot, link), checks.axis_of_tips(robot, link)

    def rule(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Array, Array]:
        (q,), (motion,) = primals, tangents
        pose = differentiable(q)
        motions = motion[..., None, :] if tips else motion
        return pose, _moved(pose, jnp.einsum("...ij,...j->...i", jacobian_of(q), motions))

    differentiable = _with_rule(partial(_call, compute), rule)
    return differentiable


@lru_cache(maxsize=64)
def _jacobian(robot: Robot, link: str | None) -> Callable[[Array], Array]:
    jnp, compute = _jax().numpy, functions.jacobians(robot, link)
    bend = _last("a Jacobian", functions.curvatures(robot, link))

    def rule(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Array, Array]:
        (q,), (motion,) = primals, tangents
        require_single_joints(robot, link)
        return differentiable(q), jnp.einsum("...ijk,...k->...ij", bend(q), motion)

    differentiable = _with_rule(partial(_call, compute), rule)
    return differentiable


@lru_cache(maxsize=64)
def _solve(robot: Robot, rows: int, damping: float, from_start: bool) -> Callable[..., tuple[Array, Array]]:
    jnp, several = _jax().numpy, len(robot.tips) > 1
    follow = _following(robot, rows, damping)
    solved = functions.solved(robot, (3 if several else 2 if rows == 6 else 1, 1)[: 1 + from_start])

    def compute(*given: Array) -> tuple[Array, Array]:
        found = _call(solved, *given)
        return found[..., :-1], found[..., -1]

    def rule(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Any, Any]:
        q, reached = differentiable(*primals)
        moved = _twist(primals[0], tangents[0]) if rows == 6 else tangents[0]
        moved = moved.reshape(*moved.shape[:-2], -1) if several else moved
        ways = follow(q, reached)
        motion = jnp.einsum("...ij,...j->...i", ways[..., : -robot.dof], moved)
        if from_start:
            motion = motion + jnp.einsum("...ij,...j->...i", ways[..., -robot.dof :], tangents[1])
        return (q, reached), (motion, jnp.zeros_like(reached))

    differentiable = _with_rule(compute, rule)
    return differentiable


@lru_cache(maxsize=64)
def _following(robot: Robot, rows: int, damping: float) -> Callable[[Array, Array], Array]:
    """Returns J^+ and I - J^+ J side by side, as a function of a solution, with the derivative of a pseudoinverse."""
    jax = _jax()

    def rule(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Array, Array]:
        ways = differentiable(*primals)
        inverse, rest = ways[..., : -robot.dof], ways[..., -robot.dof :]
        free = jax.numpy.any(inverse != 0.0, axis=-1)[..., None, :]
        pairs = jax.jvp(_jacobian(robot, None), primals[:1], tangents[:1])
        jacobian, change = (each[..., :rows, :] * free for each in pairs)
        gram, turned = inverse @ _transposed(inverse), _transposed(change)
        # Golub and Pereyra (1973), eq. (4.12)
        left = jax.numpy.eye(rows) - jacobian @ inverse
        bent = gram @ turned @ left + rest @ turned @ _transposed(inverse) @ inverse - inverse @ change @ inverse
        return ways, jax.numpy.concatenate((bent, -(bent @ jacobian + inverse @ change)), axis=-1)

    differentiable = _with_rule(partial(_call, functions.ways(robot, rows, damping)), rule)
    return differentiable


@lru_cache(maxsize=64)
def _clearance(robot: Robot, scene: Scene) -> Callable[[Array], Array]:
    jnp = _jax().numpy
    compute = functions.clearances(robot, scene)
    gradient = _last("a distance", functions.clearance_gradients(robot, scene))

    def rule(primals: tuple[Array, ...], tangents: tuple[Array, ...]) -> tuple[Array, Array]:
        return differentiable(*primals), jnp.sum(gradient(*primals) * tangents[0], axis=-1)

    differentiable = _with_rule(partial(_call, compute), rule)
    return differentiable


def _jax() -> Any:
    return library("jax", "jax", "interop.jax", extra="jax")


def _joints(name: str, q: Array, robot: Robot) -> Array:
    """Returns joint positions as an array of a floating type, whose shape is checked."""
    checks.shape_of_joints(name, np.shape(q), robot)
    return _floating(q)


def _floating(values: Any) -> Array:
    jnp = _jax().numpy
    values = jnp.asarray(values)
    return values.astype(jnp.result_type(values, float))


def _with_rule(compute: Callable[..., Any], rule: Callable[..., Any]) -> Callable[..., Any]:
    """Returns a function with a rule of forward derivatives, which JAX transposes for reverse ones."""
    function = _jax().custom_jvp(compute)
    function.defjvp(rule)
    return function  # type: ignore[no-any-return]


def _last(what: str, compute: functions.RowFunction) -> Callable[[Array], Array]:
    """Returns a function of q that says so if it is differentiated."""

    def refuse(_primals: tuple[Array, ...], _tangents: tuple[Array, ...]) -> Any:
        raise InvalidInputError(f"interop.jax has no higher derivative of {what}")

    return _with_rule(partial(_call, compute), refuse)


def _call(compute: functions.RowFunction, *arrays: Array) -> Array:
    """Calls the core on all rows at once, in float64; the result has the type of the arrays."""
    jax = _jax()
    kind = jax.numpy.result_type(*arrays)
    rows = np.broadcast_shapes(*(array.shape[: array.ndim - n] for array, n in zip(arrays, compute.ndims, strict=True)))
    result = jax.ShapeDtypeStruct(rows + compute.shape, kind)

    def computed(*values: Any) -> Any:
        return compute(*values).astype(kind, copy=False)

    def fill(_context: Any, out: Any, *values: Any) -> None:
        np.asarray(out)[...] = computed(*map(np.asarray, values))

    if jax.default_backend() == "cpu" and _buffers() is not None:
        return _buffers()(fill, result, vmap_method="expand_dims")(*arrays)
    return jax.pure_callback(computed, result, *arrays, vmap_method="expand_dims")


@lru_cache(maxsize=1)
def _buffers() -> Any:
    """Returns the callback that reads buffers in place, or None before JAX had it.

    `pure_callback` copies large arrays by the threads that wait for it, and hangs on a machine with one core.
    """
    try:
        return import_module("jax.experimental.buffer_callback").buffer_callback
    except ModuleNotFoundError:
        return None


def _transposed(matrix: Array) -> Array:
    return _jax().numpy.swapaxes(matrix, -1, -2)


def _moved(pose: Array, twist: Array) -> Array:
    """Returns the derivative (..., 4, 4) of a pose that moves by a twist (..., 6), linear before angular."""
    jnp = _jax().numpy
    turning = jnp.cross(twist[..., None, 3:], _transposed(pose[..., :3, :3]))  # of each axis, in rows
    upper = jnp.concatenate((_transposed(turning), twist[..., :3, None]), axis=-1)
    return jnp.concatenate((upper, jnp.zeros_like(upper[..., :1, :])), axis=-2)


def _twist(pose: Array, change: Array) -> Array:
    """Returns the twist (..., 6) of a change (..., 4, 4) of a pose, projected onto rigid motions."""
    jnp = _jax().numpy
    turning = change[..., :3, :3] @ _transposed(pose[..., :3, :3])
    skew = 0.5 * (turning - _transposed(turning))
    angular = jnp.stack((skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]), axis=-1)
    return jnp.concatenate((change[..., :3, 3], angular), axis=-1)
