"""Hostile streams for `Tracker`: does every tick keep its limits, and can the arm always be stopped?

    python benches/hostile_streams.py --ticks 1000000 --seed 0 --out DIR

Random arms, limits, tick lengths and targets: jumps, noise, dropouts, far out of reach, the edge of reach, singular
configurations, targets that turn back or are NaN. Finite differences of the commanded joint angles are held against the
limits; at the end of each stream the arm is told to stop, and must come to rest within the time that it names.
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
KINDS = ("velocity", "acceleration", "jerk")


@dataclass
class Outcome:
    """What the streams of one name did; excess is relative to the limit, beyond rounding."""

    streams: int = 0
    ticks: int = 0
    refused: int = 0  # targets with NaN
    stops: int = 0
    stopping_ticks: int = 0
    excess: dict[str, float] = field(default_factory=lambda: dict.fromkeys((*KINDS, "position"), 0.0))
    complaints: list[str] = field(default_factory=list)


def main() -> None:
    """Run so many ticks and write down what they did."""
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
        "stops",
        "stopping_ticks",
        *outcomes["jumps"].excess,
        "complaints",
    ]
    lines = [
        [name, each.streams, each.ticks, each.refused, each.stops, each.stopping_ticks]
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
    """Streams of every kind in turn until so many ticks are done."""
    outcomes = {name: Outcome() for name in TARGETS}
    number = 0
    while sum(each.ticks for each in outcomes.values()) < ticks:
        for name, outcome in outcomes.items():
            follow(draw(name, np.random.default_rng([seed, number])), f"{name} {seed}/{number}", outcome)
            number += 1
    return outcomes


def follow(stream: Stream, label: str, outcome: Outcome) -> None:
    """Run one stream to its end, stop the arm, and check every tick."""
    tracker = bik.Tracker(stream.robot, stream.start, dt=stream.dt, limits=bik.Limits(**stream.limits))
    commanded = [stream.start]
    for target in stream.targets:
        if target is not None and np.isnan(target).any():
            outcome.refused += _refuses(tracker, target)
        else:
            commanded.append(tracker.step(target).q)
    outcome.streams += 1
    outcome.ticks += len(commanded) - 1
    stopped = _stop(tracker, stream)
    outcome.stops += 1
    outcome.stopping_ticks += len(stopped)
    q = np.array([*commanded, *stopped])
    if len(stopped) and not np.array_equal(q[-1], q[-2]):
        outcome.complaints.append(f"{label}: does not rest after its stop")
    for kind, excess in excesses(stream, q).items():
        outcome.excess[kind] = max(outcome.excess[kind], excess)
        if excess > SLACK:
            outcome.complaints.append(
                f"{label}: {kind} beyond its limit by {excess:.2g} of it; {stream.limits}, dt {stream.dt:g}"
            )


def _refuses(tracker: bik.Tracker, target: np.ndarray) -> int:
    """A target that is not a number must be refused and leave the tracker as it was."""
    before = tracker.q, tracker.time
    try:
        tracker.step(target)
    except bik.InvalidInputError:
        assert np.array_equal(tracker.q, before[0])
        assert tracker.time == before[1]
        return 1
    raise AssertionError("a target with NaN was taken")


def _stop(tracker: bik.Tracker, stream: Stream) -> list[np.ndarray]:
    """Stop the arm, and let it rest for two ticks more."""
    ticks = round(tracker.stop() / stream.dt) + 2
    return [tracker.step(None).q for _ in range(ticks)]


def excesses(stream: Stream, q: np.ndarray) -> dict[str, float]:
    """By how much each finite difference exceeds its limit, relative to it and beyond rounding; at most 0 is kept."""
    dt, rounding = stream.dt, ROUNDING * np.abs(q).max()
    moved = np.vstack([np.tile(q[0], (3, 1)), q])  # at rest before
    found = {"position": _outside(stream, q)}
    for order, kind in enumerate(KINDS, 1):
        limit = stream.limits.get(kind)
        if limit is None:
            continue
        rates = np.abs(np.diff(moved, order, axis=0))[-(len(q) - 1) :]
        bounds = lowest(limit, dt, len(rates)) * dt**order
        found[kind] = float(((rates - rounding) / bounds).max()) - 1.0
    return found


def _outside(stream: Stream, q: np.ndarray) -> float:
    lower = np.asarray(stream.limits.get("lower", stream.robot.lower))
    upper = np.asarray(stream.limits.get("upper", stream.robot.upper))
    return float(np.maximum(lower - q, q - upper).max())


def lowest(limit: Any, dt: float, ticks: int) -> np.ndarray:
    """The smallest value of a limit over each tick: (ticks, 1) or (ticks, n)."""
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
