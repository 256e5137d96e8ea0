"""Claims of section 1 on other methods and on the advantages of ZNNBAS, measured side by side."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

import beetle_ik as bik

from ...report import Claim, Column, Part, Section, Table, number
from ..experiment import Context
from . import dual_network
from .dual_network import DualNetwork
from .settings import (
    ADAPTIVE,
    DT,
    IIWA,
    NO_LIMITS,
    ON_CIRCLE,
    POSITION_LIMITS,
    PUBLISHED,
    SMALL_STAR,
    STAR,
    Array,
    M,
    circle,
    follow,
    letter,
    rms,
)

TITLE = "Section 1: other methods, and claims about this one"
FEEDBACK = 20.0  # 1/s, position feedback of both methods with a model
COARSE = 0.01  # s, tick of the methods with a model
_TRACED = 0.02  # m
_NEAR = (1e-3**0.5, 1e-4)  # m: "approaches zero" on the M, and the band of Cheng's beetle
_SHARE = 0.1  # fraction of a tick of 1 ms above which computing is "expensive"
_SPEEDS = (12.5, 5.0, 2.5)  # s, durations of the M
_SHORTER = 0.2  # bound on steps at a tenth of the tick over those at the tick, for continuous motion

_TEXT = """
The paper compares ZNNBAS with the pseudo-inverse of the Jacobian and the dual neural network, without running either.
We ran them on the circle of Cheng et al., the M and the star. All start on the path. The pseudo-inverse and the network
use the model and act every 10 ms; the network is that of Zhang, Wang and Xia 2003, reference 18 of the paper, which
keeps joint limits. ZNNBAS and `BroydenBAS` measure one position every millisecond.
"""

Joints: TypeAlias = tuple[Array, Array]
"""Joint positions of the arm (k, n) and the references (k, 3)."""


@dataclass(frozen=True)
class Method:
    """A method that follows a path from a configuration on it, within limits or without."""

    knows: str
    run: Callable[[bik.Path, Array, bik.Limits, int], Joints]


def _pseudo_inverse(gain: float) -> Callable[[bik.Path, Array, bik.Limits, int], Joints]:
    rule = bik.WeightedPseudoInverse(gain=gain, weights=np.ones(IIWA.dof))

    def run(path: bik.Path, start: Array, limits: bik.Limits, _seed: int) -> Joints:
        result = bik.track(IIWA, path, start, dt=COARSE, solver=rule, limits=limits)
        return np.asarray(result.q), np.asarray(result.reference)

    return run


def _network(path: bik.Path, start: Array, limits: bik.Limits, _seed: int) -> Joints:
    kept = limits is POSITION_LIMITS
    found = dual_network.track(
        IIWA,
        path,
        start,
        dt=COARSE,
        network=DualNetwork(feedback=FEEDBACK),
        lower=IIWA.lower if kept else None,
        upper=IIWA.upper if kept else None,
    )
    return found.q, found.reference


def _model_free(controller: bik.papers.ZNNBAS | bik.BroydenBAS) -> Callable[[bik.Path, Array, bik.Limits, int], Joints]:
    def run(path: bik.Path, start: Array, limits: bik.Limits, seed: int) -> Joints:
        plant = bik.KinematicPlant(IIWA)
        result = bik.track_model_free(plant, path, start, dt=DT, controller=controller, limits=limits, seed=seed)
        return np.asarray(result.command), np.asarray(result.reference)

    return run


_METHODS = {
    "pseudo-inverse, open loop": Method("model", _pseudo_inverse(0.0)),
    f"pseudo-inverse, feedback {FEEDBACK:g}/s": Method("model", _pseudo_inverse(FEEDBACK)),
    f"dual network, feedback {FEEDBACK:g}/s": Method("model", _network),
    "ZNNBAS, printed constants": Method("position", _model_free(PUBLISHED)),
    "ZNNBAS, eq. (16), k = 100": Method("position", _model_free(ADAPTIVE)),
    "BroydenBAS": Method("position", _model_free(bik.BroydenBAS(max_evaluations_per_step=1))),
}
_PATHS = (
    ("circle", circle(30.0), NO_LIMITS),
    ("M", M, NO_LIMITS),
    ("star", STAR, NO_LIMITS),
    ("circle, within limits", circle(30.0), POSITION_LIMITS),
    ("small star, within limits", SMALL_STAR, POSITION_LIMITS),
    ("M, within limits", M, POSITION_LIMITS),
)


def other_methods(context: Context) -> Part:
    """Tabulates the methods, and judges the claims of section 1 that a run can decide."""
    paths = context.pick(full=_PATHS, short=_PATHS[:1])
    methods = context.each("khan2022: methods", list(_METHODS.items()))
    rows = [_row(name, method, paths, context.seed) for name, method in methods]
    shapes = {"circle": circle(50.0), "small star": SMALL_STAR, "M": M}
    slow = {f"{name} in 50 s": _late_error(path, context.seed) for name, path in shapes.items()}
    quick = {f"M in {duration:g} s": _late_error(letter(duration), context.seed) for duration in _SPEEDS}
    targets = context.pick(full=25, short=5)
    ticks = (DT, DT / 10.0)
    seconds_of_znnbas = _seconds_per_tick_of_znnbas()
    return Section(TITLE, [_TEXT, _table(rows, [name for name, _, _ in paths])]), [
        expensive(_seconds_per_tick_of_pseudo_inverse(), seconds_of_znnbas),
        real_time(seconds_of_znnbas),
        continuous(_steps(ticks, context.seed)),
        any_path(slow, quick),
        global_solution(_reached(targets, context), targets),
    ]


def expensive(seconds: float, of_znnbas: float) -> Claim:
    """Judges the computing time of a tick of the pseudo-inverse (s) against that of a tick of ZNNBAS."""
    return Claim.judged(
        "Computing the Jacobian and its pseudo-inverse along the path in real time is “computationally expensive”.",
        source="Sections 1 and 2.1",
        rule="A tick of the pseudo-inverse takes longer to compute than what “expensive” is held against.",
        measured=f"{number(1e6 * seconds, 2)} µs a tick; ZNNBAS {number(1e6 * of_znnbas, 2)} µs",
        holds={
            f"{100 * _SHARE:g} % of a millisecond": seconds > _SHARE * DT,
            "a tick of ZNNBAS": seconds > of_znnbas,
        },
        reason="The paper does not say what it is expensive beside.",
        section=TITLE,
    )


def real_time(seconds: float) -> Claim:
    """Judges the computing time of one tick of ZNNBAS (s)."""
    return Claim.judged(
        "ZNNBAS resolves the redundancy in real time.",
        source="Abstract, section 1",
        rule=f"A tick of ZNNBAS takes less than {100 * _SHARE:g} % of a millisecond to compute.",
        measured=f"{number(1e6 * seconds, 2)} µs, the simulated arm included",
        holds=seconds < _SHARE * DT,
        reading="Ticks of 1 ms. Only computing is meant: what the arm can follow is judged under Figures 2 and 3.",
        section=TITLE,
    )


def continuous(steps: Mapping[str, Sequence[float]]) -> Claim:
    """Judges rms steps of a joint (rad) at a tick, and at a tenth of it, at theta and at theta'."""
    return Claim.judged(
        "Unlike discrete swarms, whose particles jump from point to point, ZNNBAS moves continuously.",
        source="Sections 1 and 5",
        rule=f"With a tenth of the tick the steps are at most {_SHORTER:g} times as long.",
        measured="; ".join(
            f"{name} {number(coarse)} rad at ticks of 1 ms, {number(fine)} rad at 0.1 ms"
            for name, (coarse, fine) in steps.items()
        )
        + " (rms, printed constants)",
        holds={name: fine <= _SHORTER * coarse for name, (coarse, fine) in steps.items()},
        reason="The state θ moves continuously; the arm is sent to θ′, a new random antenna away in every tick. The "
        "paper does not say which of the two it means.",
        section=TITLE,
    )


def any_path(slow: Mapping[str, float], quick: Mapping[str, float]) -> Claim:
    """Judges late rms errors at theta (m) by path: in 50 s, and in less."""
    errors = {**slow, **quick}
    return Claim.judged(
        "It works for any other tracking path as well.",
        source="Section 4.1",
        rule=f"Over the last fifth the tool at θ is within {100 * _TRACED:g} cm of each path (rms).",
        measured=", ".join(f"{name} {number(100 * error)} cm" for name, error in errors.items()),
        holds={
            "any shape, in 50 s": all(error <= _TRACED for error in slow.values()),
            "any shape in any time": all(error <= _TRACED for error in errors.values()),
        },
        reason="With the printed constants ZNNBAS lags in proportion to the target's speed.",
        section=TITLE,
    )


def global_solution(reached: Mapping[float, int], targets: int) -> Claim:
    """Judges the number of random targets that are reached, by the distance (m) that counts as reached."""
    return Claim.judged(
        "By the random search of BAS it avoids local minima and converges to a global solution.",
        source="Section 5",
        rule="From home, within the arm's limits, the tool at θ is near enough to each random target from 8 to 10 s "
        "(median).",
        measured=", ".join(f"{count} of {targets} to {number(1e3 * near)} mm" for near, count in reached.items()),
        holds={f"{number(1e3 * near)} mm count as reached": count == targets for near, count in reached.items()},
        reason="The paper does not say what counts as a solution. Targets are the tool's positions at random "
        "configurations within the limits; reaching them all shows no local minimum in these runs, and is no proof.",
        section=TITLE,
    )


def _row(name: str, method: Method, paths: Sequence[tuple[str, bik.Path, bik.Limits]], seed: int) -> list[str | float]:
    row: list[str | float] = [name, method.knows]
    for _, path, limits in paths:
        start = np.asarray(bik.solve(IIWA, path.position(0.0), start_q=ON_CIRCLE).q)
        q, reference = method.run(path, start, limits, seed)
        late = slice(len(q) // 2, None)
        row.append(1e3 * rms(((IIWA.fk(q[late])[:, :3, 3] - reference[late]) ** 2).sum(axis=1)))
    return row


def _table(rows: Sequence[Sequence[str | float]], paths: Sequence[str]) -> Table:
    return Table(
        name="methods",
        title="Tool error of the arm as commanded, second half of each path (rms)",
        columns=[
            Column(name="method"),
            Column(name="knows"),
            *(Column(name=name, unit="mm", digits=4) for name in paths),
        ],
        rows=rows,
        caption="The first stroke of the M is out of reach within the limits: a method has to return to the path. "
        "Errors are those where the arm is sent, which for ZNNBAS is θ′.",
    )


def _seconds_per_tick_of_pseudo_inverse() -> float:
    path, start = circle(30.0), ON_CIRCLE
    began = time.perf_counter()
    ticks = len(_pseudo_inverse(FEEDBACK)(path, start, NO_LIMITS, 0)[0])
    return (time.perf_counter() - began) / ticks


def _seconds_per_tick_of_znnbas() -> float:
    began = time.perf_counter()
    ticks = len(follow(M, PUBLISHED, seed=0).time)
    return (time.perf_counter() - began) / ticks


def _steps(ticks: Sequence[float], seed: int) -> dict[str, list[float]]:
    """Returns rms steps of a joint (rad) by tick, at theta and at theta'."""
    results = [follow(letter(10.0), PUBLISHED, seed=seed, dt=dt) for dt in ticks]
    return {
        name: [rms(np.diff(joints[run.late], axis=0) ** 2) for run, joints in zip(results, moves, strict=True)]
        for name, moves in (
            ("θ", [run.result.q for run in results]),
            ("θ′, where the arm is", [run.result.command for run in results]),
        )
    }


def _late_error(path: bik.Path, seed: int) -> float:
    start = np.asarray(bik.solve(IIWA, path.position(0.0)).q)
    return float(np.sqrt(follow(path, PUBLISHED, seed=seed, start=start).late_h))


def _reached(targets: int, context: Context) -> dict[float, int]:
    rng = np.random.default_rng(context.seed)
    reached = dict.fromkeys(_NEAR, 0)
    for seed in context.each("khan2022: random targets", context.seeds(targets)):
        point = IIWA.fk(rng.uniform(IIWA.lower, IIWA.upper))[:3, 3]
        run = follow(_still(point), PUBLISHED, seed=seed, limits=POSITION_LIMITS)
        error = np.sqrt(np.median(run.h[run.late]))
        reached = {near: count + bool(error < near) for near, count in reached.items()}
    return reached


def _still(point: Array) -> bik.Path:
    return bik.paths.from_function(lambda _: point, 10.0)
