"""Attacks the promises of the library.

    python -m campaign run --seed 0 --cases 200            every attack, so many cases each
    python -m campaign run --seed 0 --minutes 120          all attacks get the same time
    python -m campaign repeat NAME --seed 0 --index 17     one case again, with its program
    python -m campaign table LEDGER [LEDGER ...]           the table of docs/reliability.md
    python -m campaign soak [NAME ...] [--long]            long runs, killed writers, full disks, forks

The folder `tests` is the working directory or in PYTHONPATH. Failing cases are printed, and kept with the counts in the
folder of `--out`.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

from . import ledger, soak, watch, worker
from .attacks import ATTACKS, named


def main() -> None:
    """Reads the command line and does what it says."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="attack")
    run.add_argument("names", nargs="*", choices=[*ATTACKS, []], help="attacks (default: all)")
    run.add_argument("--cases", type=int, help="cases of each attack")
    run.add_argument("--minutes", type=float, help="time in all")
    run.add_argument("--workers", type=int, default=2, help="processes (default: 2)")
    run.add_argument("--first", type=int, default=0, help="index of the first case (default: 0)")
    run.add_argument("--out", type=Path, default=Path("target/campaign"), help="folder (default: target/campaign)")
    again = commands.add_parser("repeat", help="try one case again")
    again.add_argument("name", choices=ATTACKS)
    again.add_argument("--index", type=int, required=True)
    part = commands.add_parser("worker", help="what `run` starts")
    part.add_argument("names", nargs="+")
    part.add_argument("--share", type=json.loads, required=True)
    rough = commands.add_parser("soak", help="long runs and rough treatment")
    rough.add_argument("names", nargs="*", choices=[*soak.TRIALS, []], help="trials (default: all)")
    rough.add_argument("--long", action="store_true", help="the full amounts: hours")
    rough.add_argument("--amount", type=int, help="an amount of your own")
    for each in (run, again, part):
        each.add_argument("--seed", type=int, default=0)
    table = commands.add_parser("table", help="the table of docs/reliability.md")
    table.add_argument("ledgers", nargs="+", type=Path)
    calls = {"run": _run, "repeat": _repeat, "worker": _worker, "table": _table, "soak": _soak}
    given = parser.parse_args()
    calls[given.command](given)


def _run(given: argparse.Namespace) -> None:
    if given.cases is None and given.minutes is None:
        sys.exit("--cases or --minutes: how long?")
    attacks = {name: ATTACKS[name] for name in given.names or ATTACKS}
    cases = None if given.cases is None else given.first + given.cases
    plan = watch.Plan(attacks, given.seed, cases, given.minutes, given.workers, given.first, given.out.resolve())
    found = watch.campaign(plan)
    print(ledger.markdown(list(found.rows.values())))
    print(f"{sum(row.inputs for row in found.rows.values()):,} inputs, {found.failures()} failures")
    sys.exit(found.failures() > 0)


def _repeat(given: argparse.Namespace) -> None:
    here, sys.path[:] = Path.cwd(), [str(Path(place).absolute()) for place in sys.path]
    with tempfile.TemporaryDirectory(prefix="beetle-ik-campaign-") as folder:
        os.chdir(folder)  # programs may write files
        try:
            print(worker.repeated(ATTACKS[given.name], given.seed, given.index))
        finally:
            os.chdir(here)


def _worker(given: argparse.Namespace) -> None:
    worker.run([named(name) for name in given.names], given.seed, worker.Share(**given.share))


def _table(given: argparse.Namespace) -> None:
    print(ledger.markdown(ledger.read(given.ledgers)))


def _soak(given: argparse.Namespace) -> None:
    sys.exit(soak.soak(given.names or list(soak.TRIALS), amount=given.amount, long=given.long) > 0)


if __name__ == "__main__":
    main()
