"""Runs the workers of a campaign, gives each case its deadline, and survives their crashes."""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from .attack import HEADER, Attack, Verdict, drawn
from .ledger import Ledger

EVERY = 30.0  # s between two writings of the ledger
ENOUGH = 5  # cases of one defect


@dataclass
class Plan:
    """What a campaign does."""

    attacks: dict[str, Attack]
    seed: int
    cases: int | None
    minutes: float | None
    workers: int
    first: int
    out: Path
    told: Counter[tuple[str, str | None]] = field(default_factory=Counter)  # failures of each attack and kind


@dataclass
class Worker:
    """A process, and the case it is at."""

    number: int
    process: subprocess.Popen[bytes]
    folder: tempfile.TemporaryDirectory[str]
    unread: bytes = b""  # a line that has not ended yet
    at: tuple[str, int] | None = None
    since: float = 0.0
    done: dict[str, int] = field(default_factory=dict)  # the index after the last case of each attack

    def end(self) -> int:
        """Waits for the process, clears up after it, and returns its code."""
        code = self.process.wait()
        self.process.stdout.close()  # type: ignore[union-attr]
        self.folder.cleanup()
        return code


def campaign(plan: Plan) -> Ledger:
    """Runs until the cases are tried or the time is over; the ledger and failing cases are in the folder `plan.out`."""
    plan.out.mkdir(parents=True, exist_ok=True)
    ledger, selector = Ledger(plan.attacks.values()), selectors.DefaultSelector()
    end = time.monotonic() + 60 * plan.minutes if plan.minutes else float("inf")
    written = time.monotonic()
    workers = [_start(plan, selector, number, {}) for number in range(plan.workers)]
    try:
        while workers and time.monotonic() < end:
            for key, _ in selector.select(timeout=0.5):
                worker: Worker = key.data
                if said := os.read(key.fd, 1 << 20):
                    *lines, worker.unread = (worker.unread + said).split(b"\n")
                    for line in lines:
                        _hear(plan, ledger, worker, json.loads(line))
                else:
                    _replace(plan, ledger, selector, workers, worker)
            _kill_late(plan, workers)
            if time.monotonic() > written + EVERY:
                ledger.write(plan.out / "ledger.csv")
                written = time.monotonic()
    finally:
        for worker in workers:
            worker.process.kill()
            worker.end()
        selector.close()
        ledger.write(plan.out / "ledger.csv")
    return ledger


def _start(plan: Plan, selector: selectors.BaseSelector, number: int, done: dict[str, int]) -> Worker:
    folder = tempfile.TemporaryDirectory(prefix="beetle-ik-campaign-")
    share = {"first": plan.first + number, "stride": plan.workers, "cases": plan.cases, "skipped": done}
    command = [sys.executable, "-m", "campaign", "worker", "--seed", str(plan.seed), "--share", json.dumps(share)]
    paths = [str(Path(place).absolute()) for place in (Path(__file__).parents[1], *sys.path)]
    # Covers of meshes go into the folder of the worker.
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "XDG_CACHE_HOME": folder.name}
    with (plan.out / f"worker_{number}.log").open("a", encoding="utf-8") as log:
        process = subprocess.Popen(
            [*command, *plan.attacks],
            stdout=subprocess.PIPE, stderr=log, bufsize=0, cwd=folder.name, env=environment,
        )  # fmt: skip
    worker = Worker(number, process, folder, done=done)
    selector.register(process.stdout, selectors.EVENT_READ, worker)  # type: ignore[arg-type]
    return worker


def _hear(plan: Plan, ledger: Ledger, worker: Worker, line: dict[str, object]) -> None:
    """Takes a line of a worker."""
    if "begin" in line:
        worker.at, worker.since = tuple(line["begin"]), time.monotonic()  # type: ignore[arg-type]
        return
    name, index = line["end"]  # type: ignore[misc]
    verdict = Verdict(**line["verdict"])  # type: ignore[arg-type]
    ledger.count(name, index, verdict, line["seconds"])  # type: ignore[arg-type]
    worker.at, worker.done[name] = None, index + plan.workers
    if verdict.failure:
        _report(plan, name, index, verdict, str(line["program"]))


def _kill_late(plan: Plan, workers: list[Worker]) -> None:
    """Ends workers whose case is past its deadline. A failing case has as long again to shrink."""
    for worker in workers:
        if worker.at and time.monotonic() - worker.since > 2 * plan.attacks[worker.at[0]].deadline:
            worker.process.kill()


def _replace(
    plan: Plan, ledger: Ledger, selector: selectors.BaseSelector, workers: list[Worker], worker: Worker
) -> None:
    """Counts the case at which a worker ended, and starts another one behind it, unless all cases are tried."""
    selector.unregister(worker.process.stdout)  # type: ignore[arg-type]
    code = worker.end()
    workers.remove(worker)
    if worker.at is None and code == 0:
        return
    if worker.at is None:
        raise RuntimeError(f"worker {worker.number} ended with code {code} between two cases: see its log")
    name, index = worker.at
    attack = plan.attacks[name]
    late = time.monotonic() - worker.since > 2 * attack.deadline
    failure = "no answer" if late else f"ends the process by {_named(code)}"
    verdict = Verdict(1, failure=failure)
    ledger.count(name, index, verdict, time.monotonic() - worker.since)
    _report(plan, name, index, verdict, HEADER + attack.program(drawn(attack, plan.seed, index)))
    worker.done[name] = index + plan.workers
    workers.append(_start(plan, selector, worker.number, worker.done))


def _named(code: int) -> str:
    return signal.Signals(-code).name if code < 0 else f"code {code}"


def _report(plan: Plan, name: str, index: int, verdict: Verdict, program: str) -> None:
    """Prints a failing case and keeps its program; of one defect the first few are enough."""
    plan.told[name, verdict.failure] += 1
    if plan.told[name, verdict.failure] > ENOUGH:
        return
    again = f"python -m campaign repeat {name} --seed {plan.seed} --index {index}"
    what = f"{name}: {verdict.failure}\n{verdict.detail}".rstrip()
    comment = "\n".join(f"# {line}" for line in [*what.splitlines()[:12], again])
    text = f"{comment}\n{program}\n"
    (plan.out / f"{name}-{plan.seed}-{index}.py").write_text(text, encoding="utf-8")
    print(text, flush=True)
