"""Hostile streams for `Tracker`: is every tick inside its limits, and can the arm always stop?

    python benches/hostile_streams.py --ticks 1000000 --seed 0 --out DIR

Random arms, limits, tick lengths and targets: jumps, noise, dropouts, far out of reach, the edge of reach, singular
configurations, targets that turn back or are NaN. Finite differences of the commanded joint angles are held against the
limits. At the end of each stream `Tracker.stop` is called, and the arm must rest after the time that it returns.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from hostile_targets import TARGETS, Stream, draw

import beetle_ik as bik

SLACK = 1e-9  # relative
ROUNDING = 8.0 * np.finfo(float).eps  # of a finite difference, relative to the joint angles
HISTORY = 3  # configurations up to the start: as many as a third difference needs
KINDS = ("velocity", "acceleration", "jerk")


@dataclass
class Outcome:
    """Counts over the streams of one kind, and the largest relative excess over a limit, without rounding."""

    streams: int = 0
    ticks: int = 0
    refused: int = 0  # targets with NaN
    moving: int = 0  # streams that began in motion
    stops: int = 0
    stopping_ticks: int = 0
    excess: dict[str, float] = field(default_factory=lambda: dict.fromkeys((*KINDS, "position"), 0.0))
    complaints: list[str] = field(default_factory=list)


def main() -> None:
    """Runs the streams, prints the table and writes it to a file."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ticks", type=int, default=1_000_000, help="ticks in all (default: 1,000,000)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("hostile"), help="where the table goes (default: hostile)")
    arguments = parser.parse_args()
    outcomes = run(arguments.ticks, arguments.seed)
    columns = [
        "targets",
        "streams",
        "ticks",
        "refused",
        "moving",
        "stops",
        "stopping_ticks",
        *outcomes["jumps"].excess,
        "complaints",
    ]
    lines = [
        [name, each.streams, each.ticks, each.refused, each.moving, each.stops, each.stopping_ticks]
        + [f"{value:.1e}" for value in each.excess.values()]
        + [len(each.complaints)]
        for name, each in outcomes.items()
    ]
    arguments.out.mkdir(parents=True, exist_ok=True)
    with (arguments.out / "hostile_streams.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([columns, *lines])
    for line in (columns, *lines):
        print("  ".join(f"{cell!s:>14}" for cell in line))
    for complaint in [complaint for each in outcomes.values() for complaint in each.complaints][:50]:
        print(complaint)


def run(ticks: int, seed: int) -> dict[str, Outcome]:
    """Runs streams of all kinds, one after the other, up to the given number of ticks."""
    outcomes = {name: Outcome() for name in TARGETS}
    number = 0
    while sum(each.ticks for each in outcomes.values()) < ticks:
        for name, outcome in outcomes.items():
            follow(draw(name, np.random.default_rng([seed, number])), f"{name} {seed}/{number}", outcome)
            number += 1
    return outcomes


def follow(stream: Stream, label: str, outcome: Outcome) -> None:
    """Runs one stream, stops the arm, and checks every tick."""
    tracker = bik.Tracker(stream.robot, stream.start, dt=stream.dt, limits=bik.Limits(**stream.limits))
    commanded = _begin(tracker, stream)
    outcome.moving += commanded[0] is not stream.start
    for target in stream.targets:
        if target is not None and np.isnan(target).any():
            outcome.refused += _refuses(tracker, target)
        else:
            commanded.append(tracker.step(target).q)
    outcome.streams += 1
    outcome.ticks += len(commanded) - HISTORY
    stopped = _stop(tracker, stream)
    outcome.stops += 1
    outcome.stopping_ticks += len(stopped)
    q = np.array([*commanded, *stopped])
    if len(stopped) and not np.array_equal(q[-1], q[-2]):
        outcome.complaints.append(f"{label}: still moves after its stop")
    for kind, excess in excesses(stream, q).items():
        outcome.excess[kind] = max(outcome.excess[kind], excess)
        if excess > SLACK:
            outcome.complaints.append(
                f"{label}: {kind} beyond its limit by {excess:.2g} of it; {stream.limits}, dt {stream.dt:g}"
            )


def _begin(tracker: bik.Tracker, stream: Stream) -> list[np.ndarray]:
    """Starts in motion if the stream asks for it and the arm can stop; returns the configurations up to the start."""
    at_rest = [stream.start] * HISTORY
    if stream.moving is None:
        return at_rest
    qd, qdd = stream.moving
    try:
        tracker.reset(stream.start, qd=qd, qdd=qdd)
    except bik.BeetleIkError:
        return at_rest
    before = stream.start - stream.dt * qd
    return [before - stream.dt * (qd - stream.dt * qdd), before, stream.start]


def _refuses(tracker: bik.Tracker, target: np.ndarray) -> int:
    """Checks that a target with NaN is refused and leaves the tracker unchanged; returns 1."""
    before = tracker.q, tracker.time
    try:
        tracker.step(target)
    except bik.InvalidInputError:
        assert np.array_equal(tracker.q, before[0])
        assert tracker.time == before[1]
        return 1
    raise AssertionError("a target with NaN was taken")


def _stop(tracker: bik.Tracker, stream: Stream) -> list[np.ndarray]:
    """Stops the arm; the last two ticks must be at rest."""
    ticks = round(tracker.stop() / stream.dt) + 2
    return [tracker.step(None).q for _ in range(ticks)]


def excesses(stream: Stream, q: np.ndarray) -> dict[str, float]:
    """Returns the largest excess of each finite difference over its limit, relative to the limit, without rounding.

    The first `HISTORY` rows of `q` are the configurations up to the start.
    """
    dt, rounding = stream.dt, ROUNDING * np.abs(q).max()
    ticks = len(q) - HISTORY
    found = {"position": _outside(stream, q[HISTORY - 1 :])}
    for order, kind in enumerate(KINDS, 1):
        limit = stream.limits.get(kind)
        if limit is None:
            continue
        rates = np.abs(np.diff(q, order, axis=0))[-ticks:]
        bounds = lowest(limit, dt, ticks) * dt**order
        found[kind] = float(((rates - rounding) / bounds).max()) - 1.0
    return found


def _outside(stream: Stream, q: np.ndarray) -> float:
    lower = np.asarray(stream.limits.get("lower", stream.robot.lower))
    upper = np.asarray(stream.limits.get("upper", stream.robot.upper))
    return float(np.maximum(lower - q, q - upper).max())


def lowest(limit: Any, dt: float, ticks: int) -> np.ndarray:
    """Returns the smallest value of a limit over each tick: (ticks, 1) or (ticks, n)."""
    if not isinstance(limit, bik.Sinusoid):
        return np.tile(np.atleast_1d(limit), (ticks, 1))
    time = dt * np.arange(ticks + 1)
    value = limit.mean + limit.amplitude * np.sin(limit.angular_frequency * time + limit.phase)
    least = np.minimum(value[:-1], value[1:])
    turns = (limit.angular_frequency * time + limit.phase) / (2.0 * np.pi) - 0.75
    trough = np.floor(turns[1:]) > np.floor(turns[:-1])
    return np.where(trough, limit.mean - abs(limit.amplitude), least)[:, None]


if __name__ == "__main__":
    main()
