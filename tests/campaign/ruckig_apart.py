"""Ruckig in a process of its own: at limits that tie it sometimes ends the process."""

from __future__ import annotations

import atexit
import json
import subprocess
import sys
from typing import Any

import numpy as np

_running: subprocess.Popen[str] | None = None


def motion(start: np.ndarray, end: np.ndarray, limits: np.ndarray) -> dict[str, Any] | None:
    """Its motion between states (3, n) within limits (3, n): duration, final state (3, n), and largest rates (2, n).

    None where it finds none, or dies.
    """
    global _running
    if _running is None or _running.poll() is not None:
        _running = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        atexit.register(_running.kill)
    assert _running.stdin
    assert _running.stdout
    try:
        _running.stdin.write(json.dumps([start.tolist(), end.tolist(), limits.tolist()]) + "\n")
        _running.stdin.flush()
        line = _running.stdout.readline()
    except BrokenPipeError:
        line = ""
    if not line:
        _running.wait()
        return None
    found: dict[str, Any] | None = json.loads(line)
    return found


def _found(start: list[list[float]], end: list[list[float]], limits: list[list[float]]) -> dict[str, Any] | None:
    import ruckig

    n = len(start[0])
    given, theirs = ruckig.InputParameter(n), ruckig.Trajectory(n)
    given.current_position, given.current_velocity, given.current_acceleration = start
    given.target_position, given.target_velocity, given.target_acceleration = end
    given.max_velocity, given.max_acceleration, given.max_jerk = limits
    try:
        if ruckig.Ruckig(n).calculate(given, theirs) != ruckig.Result.Working:
            return None
    except ruckig.RuckigError:
        return None
    rates = np.abs([theirs.at_time(t)[1:] for t in np.linspace(0.0, theirs.duration, 2000)]).max(axis=0)
    return {
        "duration": theirs.duration,
        "end": np.array(theirs.at_time(theirs.duration)).tolist(),
        "rates": rates.tolist(),
    }


if __name__ == "__main__":
    for asked in sys.stdin:
        print(json.dumps(_found(*json.loads(asked))), flush=True)
