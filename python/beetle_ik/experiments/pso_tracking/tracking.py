"""Figures 8 to 10: tracking by the weighted pseudo-inverse, beside joint controllers on the same motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ... import Limits, Robot, TrackResult, Trajectory, WeightedPseudoInverse, paths, track
from ...report import Block, Cell, Column, Figure, Part, Printed, Section, Table, drawing, line, not_given
from ..experiment import Context
from .servo import controllers, paper_motion, settled
from .servo_pseudo_inverse import null_space_cost, on_servos
from .tracking_claims import (
    PRINTED_OWN,
    SECTION,
    closer,
    control_time,
    jacobian_entry,
    jumps,
    limits_kept,
    null_space,
    order,
    other_swarms,
    own_error,
    printed_rivals,
)

TITLE = SECTION
ARM = Robot.named("hydraulic3")
OPEN = Limits(lower=-np.inf, upper=np.inf)
DURATION = 2.0  # s; after that the reference leaves the range of joint 3
PRINTED_ERRORS = {"PID, by hand": 1.72e-3, "GA-RBF": 0.91e-3, "artificial bee colony": 1.38e-3}  # section 3.2, rad
_KINEMATIC, _DRIVEN = "without a servo", "on the same servos"
_HELD = "K = 50, posture held, 10 ms"  # the variant that is compared with the controllers

_TEXT = """
The arm of eq. (1) and (2), with two revolute joints and a prismatic one, follows the tip path of the printed joint
motion, q₁ = q₂ = 0.5 cos(πt/2), q₃ = 0.2 sin(πt/2), for two seconds: afterwards q₃ would leave its own range. Each link
length is half the printed swing radius; the missing signs of eq. (1), (2) and (6) are restored, and J(2,1) is L₁ cos q₁
+ (L₂ + q₃) cos(q₁ - q₂).

The PID, bee-colony and GA-RBF controllers are **our own baselines**: a servo of first order in velocity (50 ms), a
bounded command and a slow disturbance, the same for all. The paper gives neither plant nor gains. The PID is tuned by
hand, P = 20 and I = 10, and by a rule: the best of a grid over the box that the bee colony searches, with as many
trials. Tuned by the rule it is as good as the colony's; both end in the corner of the box.

A kinematic tracker has no servo lag. To compare like with like, the pseudo-inverse also drives the same servos, with
its joint velocities as commands. Its advantage there is the feedforward of the desired velocity; a tuned PID with the
same feedforward is better still.
"""


def wanted(t: float) -> NDArray[np.float64]:
    """Returns the joint reference, with its missing factor t restored: 0.5 cos(pi t / 2) twice, 0.2 sin(pi t / 2)."""
    angle = np.pi / 2 * t
    return np.array([0.5 * np.cos(angle), 0.5 * np.cos(angle), 0.2 * np.sin(angle)])


def wanted_velocity(t: float) -> NDArray[np.float64]:
    """Returns the derivative of `wanted`."""
    angle = np.pi / 2 * t
    return np.pi / 2 * np.array([-0.5 * np.sin(angle), -0.5 * np.sin(angle), 0.2 * np.cos(angle)])


def _rules() -> dict[str, tuple[float, WeightedPseudoInverse]]:
    """Returns the variants of Figure 8: tick (s) and rule."""
    time = np.linspace(0.0, DURATION, 401)
    q, qd = (np.array([of(t) for t in time]) for of in (wanted, wanted_velocity))
    posture = Trajectory.from_samples(time, q, qd=qd)
    open_loop, closed = WeightedPseudoInverse(gain=0.0), WeightedPseudoInverse(gain=50.0)
    held = WeightedPseudoInverse(gain=50.0, posture=posture)
    return {
        "no gain, 10 ms": (0.01, open_loop),
        "no gain, 1 ms": (0.001, open_loop),
        "no gain, Runge-Kutta, 10 ms": (0.01, WeightedPseudoInverse(gain=0.0, integrator="rk4")),
        "K = 50, 10 ms": (0.01, closed),
        "K = 50, 1 ms": (0.001, closed),
        _HELD: (0.01, held),
        "K = 50, posture held, 1 ms": (0.001, held),
    }


def _follow(dt: float, rule: WeightedPseudoInverse, limits: Limits | None = OPEN) -> TrackResult:
    path = paths.from_function(lambda t: ARM.fk(wanted(t))[:3, 3], DURATION)
    return track(ARM, path, wanted(0.0), dt=dt, solver=rule, limits=limits)


def _joint_error(result: TrackResult) -> NDArray[np.float64]:
    return np.asarray(result.q - np.array([wanted(t) for t in result.time]))


def _largest(errors: NDArray[np.float64]) -> float:
    return float(np.abs(errors).max())


def tracking(context: Context) -> Part:
    """Runs and judges all tracking experiments."""
    rules = _rules()
    results = {name: _follow(*rules[name]) for name in context.each("pso-tracking: Figure 8", list(rules))}
    motion = paper_motion(context.pick(full=8.0, short=4.0))
    errors = controllers(motion, context)
    held = results[_HELD]
    kinematic, driven = _joint_error(held)[:, 0], on_servos(ARM, wanted, wanted_velocity, DURATION)[:, 0]
    # Errors over the two seconds of the path; the controllers run longer, as the figures show.
    steps = motion.time <= DURATION
    early = {name: _largest(error[steps]) for name, error in errors.items()}
    ranges = {name: float(np.ptp(error[steps])) for name, error in errors.items()}
    own = {_KINEMATIC: _largest(kinematic), _DRIVEN: _largest(driven)}
    blocks: list[Block] = [
        _TEXT,
        _pseudo_inverse_table(results),
        _controllers_table(errors, own, steps),
        _figure_8(held, motion.time, errors, driven),
        _figure_9(errors, held),
        _figure_10(motion.time, motion.q, errors, held),
    ]
    kept = _follow(0.01, WeightedPseudoInverse(gain=50.0), limits=None)
    strayed = _largest(_joint_error(results["K = 50, 10 ms"]))
    missing = not_given({"plant": Printed.NOT_STATED, "gains of the controllers": Printed.NOT_STATED})
    return Section(TITLE, blocks), [
        own_error({name: float(result.position_error.max()) for name, result in results.items()}),
        closer(own, early, strayed),
        jumps({_KINEMATIC: float(np.ptp(kinematic)), _DRIVEN: float(np.ptp(driven))}, ranges),
        order(early),
        printed_rivals(early, missing),
        control_time(not_given({"what counts as control time": Printed.NOT_STATED})),
        jacobian_entry(*_printed_jacobian_entry()),
        null_space(*(null_space_cost(ARM, wanted, wanted_velocity, sign=sign) for sign in (1.0, 0.0, -1.0))),
        other_swarms(),
        limits_kept(kept.max_violation, float(kept.position_error.max())),
    ]


def _printed_jacobian_entry() -> tuple[dict[str, float], float]:
    """Returns J(2,1) by eq. (6), as printed and with lost signs, and by central differences (m/rad)."""
    q, step = np.array([0.4, -0.3, 0.1]), np.array([1e-6, 0.0, 0.0])
    links = 0.7  # m, each: half the swing radius of Table 1
    first, second = links * np.sin(q[0]), np.sin(q[0] - q[1]) * (links + q[2])
    printed = {"q₁ - q₂": first + second, "the same, first sine negative": second - first}
    return printed, float((ARM.fk(q + step)[1, 3] - ARM.fk(q - step)[1, 3]) / 2e-6)


def _pseudo_inverse_table(results: dict[str, TrackResult]) -> Table:
    return Table(
        name="pseudo_inverse",
        title="The weighted pseudo-inverse on the 2R1P arm",
        columns=[
            Column(name="variant"),
            Column(name="largest tip error", unit="m", compared=True),
            Column(name="largest joint error", unit="rad, m"),
        ],
        rows=[
            [
                name,
                (PRINTED_OWN if name.startswith("K = 50") else Printed.NOT_STATED, float(result.position_error.max())),
                float(np.abs(_joint_error(result)).max()),
            ]
            for name, result in results.items()
        ],
        caption="The tip may be where it should be while the joints are far off their reference: the arm is redundant. "
        "Holding the posture in the null space settles that.",
    )


def _controllers_table(
    errors: dict[str, NDArray[np.float64]], own: dict[str, float], steps: NDArray[np.bool_]
) -> Table:
    rows: list[list[Cell]] = [
        [
            name,
            (PRINTED_ERRORS.get(name, Printed.NOT_STATED), _largest(error[steps])),
            _largest(error),
            settled(error, 0.01),
        ]
        for name, error in errors.items()
    ]
    rows += [[f"pseudo-inverse, {name}", (PRINTED_OWN, value), None, None] for name, value in own.items()]
    return Table(
        name="controllers",
        title="Largest error of joint 1",
        columns=[
            Column(name="method"),
            Column(name="in 2 s", unit="rad", compared=True, digits=4),
            Column(name="in all", unit="rad", digits=4),
            Column(name="within 0.01 rad from", unit="s", digits=4),
        ],
        rows=rows,
        caption="The path lasts two seconds; the controllers go on with the same motion.",
    )


def _figure_8(
    held: TrackResult,
    time: NDArray[np.float64],
    errors: dict[str, NDArray[np.float64]],
    driven: NDArray[np.float64],
) -> Figure:
    with drawing(height=3.4) as figure:
        panels = figure.subplots(1, 3, sharey=True)
        own = np.abs(_joint_error(held)[1:, 0])
        panel_of = {"artificial bee colony": 1, "GA-RBF": 2}
        for i, (name, error) in enumerate(errors.items()):
            axes = panels[panel_of.get(name, 0)]
            axes.semilogy(time[1:], np.maximum(np.abs(error[1:]), 1e-7), label=name, **line(i + 1))
        for axes in panels:
            axes.semilogy(held.time[1:], np.maximum(own, 1e-7), label="pseudo-inverse, no servo", **line(0))
            axes.semilogy(time[1 : len(driven)], np.maximum(np.abs(driven[1:]), 1e-7), label="on the servos", **line(6))
            axes.set(xlabel="time [s]", ylim=(1e-7, 3e2))
            axes.legend(loc="upper right", fontsize="small")
        panels[0].set_ylabel("error of joint 1 [rad]")
    return Figure(
        name="figure_8",
        title="Figure 8: errors of joint 1",
        drawing=figure,
        caption="The pseudo-inverse for the two seconds of the path, as a kinematic tracker without a servo and on the "
        "same servos; the controllers for as long as they ran. Errors dip where they change sign.",
    )


def _figure_9(errors: dict[str, NDArray[np.float64]], held: TrackResult) -> Figure:
    bands = (0.05, 0.02, 0.01, 0.005)
    with drawing(height=2.8) as figure:
        axes = figure.subplots()
        for i, (name, error) in enumerate({"pseudo-inverse": _joint_error(held)[:, 0], **errors}.items()):
            share = [100 * float(np.mean(np.abs(error) <= band)) for band in bands]
            axes.bar(np.arange(len(bands)) + 0.14 * i - 0.35, share, 0.13, label=name, color=line(i)["color"])
        axes.set_xticks(range(len(bands)), [f"{band:g} rad" for band in bands])
        axes.set(xlabel="error band", ylabel="time in the band [%]")
        axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize="small")
    return Figure(
        name="figure_9",
        title="Figure 9: share of the time in control",
        drawing=figure,
        caption="The paper compares a “control time” that it does not define; shown here is how much of the time "
        "joint 1 is within a band.",
    )


def _figure_10(
    time: NDArray[np.float64],
    reference: NDArray[np.float64],
    errors: dict[str, NDArray[np.float64]],
    held: TrackResult,
) -> Figure:
    with drawing(height=3.6) as figure:
        whole, close = figure.subplots(1, 2)
        steps = time <= DURATION
        for axes in (whole, close):
            axes.plot(time[steps], reference[steps], color="black", linewidth=3, alpha=0.3, label="target")
            axes.plot(held.time, held.q[:, 0], label="pseudo-inverse", **line(0))
            for i, (name, error) in enumerate(errors.items()):
                axes.plot(time[steps], (reference - error)[steps], label=name, **line(i + 1))
            axes.set_xlabel("time [s]")
        close.set(xlim=(0.9, 1.1), ylim=(-0.12, 0.12), title="one tenth of it")
        whole.set_ylabel("joint 1 [rad]")
        whole.legend(fontsize="small")
    return Figure(
        name="figure_10",
        title="Figure 10: the path of joint 1",
        drawing=figure,
        caption="Only the PID by hand is visibly late.",
    )
