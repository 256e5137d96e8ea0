"""Figures 8 to 10: tracking by the weighted pseudo-inverse, and what joint controllers make of the same motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ... import Limits, Robot, TrackResult, Trajectory, WeightedPseudoInverse, paths, track
from ...report import Block, Cell, Claim, Column, Figure, Part, Printed, Section, Table, drawing, line, number
from ..experiment import Context
from .servo import CONTROLLERS, paper_motion, settled

TITLE = "Tracking: Figures 8 to 10"
ARM = Robot.named("hydraulic3")
OPEN = Limits(lower=-np.inf, upper=np.inf)
DURATION = 2.0  # s; after that the reference leaves the range of joint 3
PRINTED_ERRORS = {"PID": 1.72e-3, "GA-RBF": 0.91e-3, "artificial bee colony": 1.38e-3}  # section 3.2, rad
PRINTED_OWN = 0.40e-4  # "m", where all others are in rad
_HELD = "K = 50, posture held, 10 ms"  # the variant that is set beside the controllers

_TEXT = """
The arm of eq. (1) and (2), two joints that turn and one that slides, follows the path of its tip that belongs to the
printed joint motion, q₁ = q₂ = 0.5 cos(πt/2), q₃ = 0.2 sin(πt/2), for two seconds: afterwards q₃ would leave its own
range. Link lengths are half the printed swing radius each; signs that eq. (1), (2) and (6) lost are put back, and
J(2,1) is L₁ cos q₁ + (L₂ + q₃) cos(q₁ - q₂).

The PID, bee-colony and GA-RBF controllers are **our own baselines**: a servo of first order in velocity (50 ms), a
bounded command and a slow disturbance, the same for all three. The paper gives neither plant nor gains.
"""


def wanted(t: float) -> NDArray[np.float64]:
    """The reference of the joints, its lost factor t put back: 0.5 cos(pi t / 2) twice, 0.2 sin(pi t / 2)."""
    angle = np.pi / 2 * t
    return np.array([0.5 * np.cos(angle), 0.5 * np.cos(angle), 0.2 * np.sin(angle)])


def wanted_velocity(t: float) -> NDArray[np.float64]:
    """Its derivative."""
    angle = np.pi / 2 * t
    return np.pi / 2 * np.array([-0.5 * np.sin(angle), -0.5 * np.sin(angle), 0.2 * np.cos(angle)])


def _rules() -> dict[str, tuple[float, WeightedPseudoInverse]]:
    """The variants of Figure 8: tick (s) and rule."""
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
    """All of it."""
    rules = _rules()
    results = {name: _follow(*rules[name]) for name in context.each("pso-tracking: Figure 8", list(rules))}
    motion = paper_motion(context.pick(full=8.0, short=4.0))
    errors = {
        name: CONTROLLERS[name](motion, context)
        for name in context.each("pso-tracking: controllers", list(CONTROLLERS))
    }
    held = results[_HELD]
    worst = {name: _largest(error) for name, error in errors.items()}
    blocks: list[Block] = [
        _TEXT,
        _pseudo_inverse_table(results),
        _figure_8(held, motion.time, errors),
        _controllers_table(worst, errors, held),
        _figure_9(errors, held),
        _figure_10(motion.time, motion.q, errors, held),
    ]
    return Section(TITLE, blocks), [*_own_claims(results, worst), *_rival_claims(worst)]


def _own_claims(results: dict[str, TrackResult], worst: dict[str, float]) -> list[Claim]:
    """What the paper says of its own method; `worst` are the largest errors of the others."""
    free, quick = (results[name].position_error.max() for name in ("K = 50, 10 ms", "K = 50, 1 ms"))
    held, strayed = (_largest(_joint_error(results[name])) for name in (_HELD, "K = 50, 10 ms"))
    kept = _follow(0.01, WeightedPseudoInverse(gain=50.0), limits=None)
    return [
        Claim.judged(
            "The pseudo-inverse method tracks with a largest error of 0.40e-4 m.",
            source="Section 3.2",
            rule="The printed value lies between the largest errors at ticks of 1 ms and 10 ms, and "
            "that at 10 ms is below 1e-4 m.",
            measured=f"{number(free)} m at 10 ms, {number(quick)} m at 1 ms (the printed value between)",
            holds=bool(quick < PRINTED_OWN < free < 1e-4),
            reading="eq. (12) with a closed loop, K = 50 1/s: the paper has none, and no time step",
            section=TITLE,
        ),
        Claim.judged(
            "The joints follow their reference more closely than under the other controllers.",
            source="Section 3.2, Figure 8",
            rule="The largest joint error is below that of each of the other controllers.",
            measured=f"{number(held)} rad or m; {_listed(worst)}",
            holds=held < min(worst.values()),
            reading="the posture is held through the null space, which eq. (13) and (14) do not do: without it the "
            f"joints stray by {number(strayed)}. And a kinematic tracker has no servo to fight: the comparison "
            "favours it, in the paper as here",
            section=TITLE,
        ),
        Claim.judged(
            "Joint and velocity limits are kept.",
            source="Table 1 and section 3.2",
            rule="No limit is violated, and the largest error is below 1e-4 m.",
            measured=f"largest violation {kept.max_violation:g}, largest error {number(kept.position_error.max())} m",
            holds=kept.max_violation == 0.0 and bool(kept.position_error.max() < 1e-4),
            section=TITLE,
        ),
    ]


def _rival_claims(worst: dict[str, float]) -> list[Claim]:
    return [
        Claim.judged(
            "Of the others GA-RBF is the best, then the bee colony, then PID.",
            source="Section 3.2",
            rule="The largest errors are in that order.",
            measured=f"{_listed(worst)} rad",
            holds=worst["GA-RBF"] < worst["artificial bee colony"] < worst["PID"],
            reading="on a plant and with gains of our own",
            section=TITLE,
        ),
        Claim.judged(
            "Largest errors 1.72e-3, 0.91e-3 and 1.38e-3 rad of PID, GA-RBF and bee colony; 2.2 s of control time.",
            source="Section 3.2, Figures 8 and 9",
            rule="The largest errors and the control time are the printed ones.",
            measured=f"{_listed(worst)} rad",
            reason="neither the plant, nor gains, network, disturbance or what counts as control time are given",
            holds=None,
            section=TITLE,
        ),
    ]


def _listed(worst: dict[str, float]) -> str:
    return ", ".join(f"{name} {number(value)}" for name, value in worst.items())


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


def _controllers_table(worst: dict[str, float], errors: dict[str, NDArray[np.float64]], held: TrackResult) -> Table:
    rows: list[list[Cell]] = [
        [name, (PRINTED_ERRORS[name], worst[name]), settled(errors[name], 0.01)] for name in worst
    ]
    own = _joint_error(held)[:, 0]
    rows.append(["pseudo-inverse, posture held", (PRINTED_OWN, float(np.abs(own).max())), 0.0])
    return Table(
        name="controllers",
        title="Largest error of joint 1, and when it stayed within 0.01 rad",
        columns=[
            Column(name="method"),
            Column(name="largest error", unit="rad", compared=True),
            Column(name="settled", unit="s"),
        ],
        rows=rows,
    )


def _figure_8(held: TrackResult, time: NDArray[np.float64], errors: dict[str, NDArray[np.float64]]) -> Figure:
    with drawing(height=3.2) as figure:
        panels = figure.subplots(1, 3, sharey=True)
        own = np.abs(_joint_error(held)[1:, 0])
        for axes, (i, (name, error)) in zip(panels, enumerate(errors.items()), strict=True):
            axes.semilogy(time[1:], np.maximum(np.abs(error[1:]), 1e-7), label=name, **line(i + 1))
            axes.semilogy(held.time[1:], np.maximum(own, 1e-7), label="pseudo-inverse", **line(0))
            axes.set(xlabel="time [s]", ylim=(1e-7, 3.0))
            axes.legend(loc="upper right", fontsize="small")
        panels[0].set_ylabel("error of joint 1 [rad]")
    return Figure(
        name="figure_8",
        title="Figure 8: errors of joint 1",
        drawing=figure,
        caption="The pseudo-inverse, a kinematic tracker without a servo, for the two seconds of the path; the "
        "controllers for as long as they ran. Errors dip where they change sign.",
    )


def _figure_9(errors: dict[str, NDArray[np.float64]], held: TrackResult) -> Figure:
    bands = (0.05, 0.02, 0.01, 0.005)
    with drawing(height=2.8) as figure:
        axes = figure.subplots()
        for i, (name, error) in enumerate({"pseudo-inverse": _joint_error(held)[:, 0], **errors}.items()):
            share = [100 * float(np.mean(np.abs(error) <= band)) for band in bands]
            axes.bar(np.arange(len(bands)) + 0.2 * i - 0.3, share, 0.19, label=name, color=line(i)["color"])
        axes.set_xticks(range(len(bands)), [f"{band:g} rad" for band in bands])
        axes.set(xlabel="error band", ylabel="time in the band [%]")
        axes.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize="small")
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
