"""Planner in a process of its own, with its own interpreter and path: two versions of beetle-ik have one name.

    python -m peers.plan_worker FILE_DESCRIPTOR CLASS

The times are taken here, so that the way through the pipe does not count.
"""

from __future__ import annotations

import gc
import importlib
import os
import socket
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np

from . import planners
from .planners import Arm, Planner
from .sphere_judge import Motion

REPEATED = 0.05  # s: calls that take less are measured three times, and the median counts
BENCHES = Path(__file__).parents[1]


@dataclass(frozen=True)
class Answer:
    """Answer of a planner to one problem, and the time taken."""

    claimed: bool
    seconds: float  # of the processor
    wall: float  # s by the clock on the wall, the longest
    margin_0: bool
    duration: float = np.nan
    spacing: float = np.nan


class Worker:
    """Client of a planner in another process."""

    def __init__(self, planner: type[Planner], arm: Arm, python: str, folder: Path | None) -> None:
        """Starts `planner` under the interpreter `python`, with `folder` first on its path.

        Raises:
            ImportError: if the planner could not be made; says why.
        """
        here, there = socket.socketpair()
        paths = [str(BENCHES), *([str(folder)] if folder else [])]
        single = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMEXPR")}
        self.process = subprocess.Popen(
            [python, "-m", "peers.plan_worker", str(there.fileno()), planner.__name__],
            pass_fds=[there.fileno()],
            env=os.environ | single | {"PYTHONPATH": os.pathsep.join(paths)},
            stdout=subprocess.DEVNULL,  # some libraries print
            stderr=subprocess.DEVNULL,
        )
        there.close()
        self.planner, self.pipe = planner, Connection(here.detach())
        problem = self._ask(arm)
        if problem is not None:
            self.process.wait()
            raise ImportError(problem)

    def plan(self, problem: dict[str, Any]) -> Answer:
        """Plans the motion of a problem."""
        return self._ask(problem)

    def motion(self, answer: Answer) -> Motion:
        """Last motion, sampled by the worker."""
        return Motion(self._ask, answer.duration, answer.spacing)

    def close(self) -> None:
        """Ends the process."""
        self.pipe.close()
        self.process.wait()

    def _ask(self, question: Any) -> Any:
        try:
            self.pipe.send(question)
            return self.pipe.recv()
        except (EOFError, OSError):
            code = self.process.wait()
            raise ImportError(f"{self.planner.name}: its process ended with code {code}") from None


def main() -> None:
    """Answers until the pipe is closed: an arm, then problems, and times at which the last motion is wanted."""
    pipe = Connection(int(sys.argv[1]))
    try:
        planner = getattr(planners, sys.argv[2])(pipe.recv())
    except (ImportError, ValueError, AttributeError, RuntimeError) as reason:
        pipe.send(f"{type(reason).__name__}: {reason}")
        return
    pipe.send(None)
    while True:
        try:
            question = pipe.recv()
        except EOFError:
            return
        pipe.send(planner.at(question) if isinstance(question, np.ndarray) else answered(planner, question))


def answered(planner: Planner, problem: dict[str, Any]) -> Answer:
    """Plans and takes the time."""
    start, goal = np.array(problem["start"]), np.array(problem["goal"])
    times: list[float] = []
    walls: list[float] = []
    gc.collect()
    gc.disable()
    while not times or (times[0] < REPEATED and len(times) < 3):
        planner.prepare(problem)
        begin, wall = time.process_time_ns(), time.perf_counter_ns()
        found = planner.plan(start, goal)
        times.append((time.process_time_ns() - begin) * 1e-9)
        walls.append((time.perf_counter_ns() - wall) * 1e-9)
    gc.enable()
    answer = Answer(found is not None, float(np.median(times)), max(walls), planner.margin_0)
    if found is None:
        return answer
    planned = planner.planned(found)
    return replace(answer, duration=planned.duration, spacing=planned.spacing)


if __name__ == "__main__":
    # Canonical name of the module, so that both sides use the same class.
    importlib.import_module("peers.plan_worker").main()
