"""Runs of experiments and their reports."""

import os
import platform
import time
from datetime import datetime
from pathlib import Path

from .. import __version__
from ..report import Provenance, Report, check_installed, report_folder, write_index, write_report
from .experiment import Context, Experiment, Progress, no_progress
from .registry import experiment, names

ALL = "all"


def reproduce(
    name: str,
    out: str | os.PathLike[str],
    *,
    short: bool = False,
    seed: int = 0,
    progress: Progress = no_progress,
    option: str = "out",
) -> list[tuple[Report, Provenance]]:
    """Runs the experiment `name`, or "all", anew and writes its report into the folder `out`.

    The report appears in `out` when it is complete; until then, and after any failure, the old content stays.

    Args:
        name: one of `names()`, or "all", which makes a folder for each report, with an `index.html` over them.
        out: the folder; it may contain an earlier report, which is replaced, and nothing else.
        short: a quick pass with fewer runs.
        seed: first seed of all random draws.
        progress: called with a label, the number of items done, and their total.
        option: the name of `out` in messages.

    Raises:
        UnknownNameError: no experiment of that name; the message lists them.
        BeetleIkError: the extra `report`, or another that an experiment needs, is not installed.
        InvalidInputError: `out` cannot be written, or contains files that do not belong to a report.
    """
    chosen = [experiment(each) for each in (names() if name == ALL else [name])]
    check_installed(extra for each in chosen for extra in each.extras)
    context = Context(short=short, seed=seed, progress=progress)
    with report_folder(Path(out), option=option) as folder:
        if name != ALL:
            return [_run(chosen[0], context, folder)]
        done = []
        for each in chosen:
            (folder / each.name).mkdir()
            done.append(_run(each, context, folder / each.name))
        write_index(folder, done)
    return done


def _run(experiment: Experiment, context: Context, folder: Path) -> tuple[Report, Provenance]:
    began = time.perf_counter()
    report = experiment.run(context)
    provenance = Provenance(
        name=experiment.name,
        title=experiment.title,
        paper=experiment.paper,
        command=_command(experiment, context),
        short=context.short,
        seed=context.seed,
        made=datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"),
        elapsed=time.perf_counter() - began,
        machine=_machine(),
    )
    context.progress(f"{experiment.name}: writing", 0, 1)
    write_report(folder, report, provenance)
    return report, provenance


def _command(experiment: Experiment, context: Context) -> str:
    options = [" --short" if context.short else "", f" --seed {context.seed}" if context.seed else ""]
    return f"beetle-ik reproduce {experiment.name}{''.join(options)} --out DIR"


def _machine() -> str:
    return f"beetle-ik {__version__}, Python {platform.python_version()}, {platform.system()} on {platform.machine()}"
