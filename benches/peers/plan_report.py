"""Tables and figures of `planning.py`."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np

from . import plan_batches, plan_figures, planners
from .plan_worker import Answer
from .report import plain_section, plain_table, write_table
from .sphere_judge import Verdict

COLUMNS = [
    *("planner", "arm", "problems", "claimed", "kept", "claimed, not kept", "least clearance_mm"),
    *("margin 0", "median_ms", "p95_ms", "slowest_ms", "length_rad", "length over c1eaf41", "duration_s"),
    "limits exceeded by",
]
IMPROVED_COLUMNS = ["arm", "problems", "max_time", "at most 1.05 of 5 s", "duration over 5 s, median", "slowest_s"]
PROBLEM_COLUMNS = [
    *("planner", "arm", "scene", "index", "claimed", "kept", "ms", "margin 0", "clearance_mm", "off ends", "outside"),
    *("length", "duration_s", "speed", "acceleration"),
]
ROUNDING = 1e-6  # of a limit
BUDGETS = {planners.BeetleIk.name: "none", planners.Within1Second.name: "1", planners.Within5Seconds.name: "5"}
NEAR = 1.05  # times the duration that 5 s find
SHOWN = {
    "problems": "{problems}",
    "claimed": "{claimed}",
    "kept": "{kept}",
    "least clearance, mm": "{least clearance_mm}",
    "median, ms": "{median_ms}",
    "95 %, ms": "{p95_ms}",
    "slowest, ms": "{slowest_ms}",
    "length over c1eaf41": "{length over c1eaf41}",
    "limits exceeded by": "{limits exceeded by}",
}  # heads of the table on the site, and how a cell is written
BATCH = (
    "`plan_batch` takes {one core, ms a problem} ms a problem of the {arm} on one core and "
    "{two cores, ms a problem} ms on two: a gain of {gain}, where two empty loops gain {gain of two empty loops}."
)
BEGIN, END = "<!-- written by benches/planning.py -->", "<!-- end -->"
OURS = (
    planners.BeetleIk,
    planners.BeetleIkTravel,
    planners.TravelWithin100Milliseconds,
    planners.Within5Milliseconds,
)
OTHERS = (planners.Old, planners.OldCapsules, planners.RoboPlan, planners.MpLib)
NAMES = [planner.name for planner in (*OURS, *OTHERS)]
IMPROVING = (planners.Within1Second, planners.Within5Seconds)


@dataclass(frozen=True)
class Result:
    """Result of one planner on one problem; `verdict` None if it claims no plan."""

    planner: str
    arm: str
    problem: dict[str, Any]
    answer: Answer
    verdict: Verdict | None

    @property
    def key(self) -> tuple[str, int]:
        """Identity of the problem of the arm."""
        return self.problem["scene"], self.problem["index"]

    @property
    def kept(self) -> bool:
        """Whether the problem is solved."""
        return self.verdict is not None and self.verdict.kept

    @property
    def milliseconds(self) -> float:
        """Time of the call."""
        return 1e3 * self.answer.seconds


def write(out: Path, results: list[Result], batches: list[list[str]]) -> None:
    """Writes all tables, every single result, and the figure."""
    tables = [
        ("planning", "Plans among obstacles, MotionBenchMaker", COLUMNS, summary(results)),
        ("planning_improved", "Durations with a budget of time", IMPROVED_COLUMNS, improvement(results)),
        ("planning_batch", "Batches", plan_batches.COLUMNS, batches),
    ]
    for name, _, columns, lines in tables:
        write_table(out / f"{name}.csv", columns, lines)
    write_table(out / "planning_problems.csv", PROBLEM_COLUMNS, [problem_line(each) for each in results])
    plan_figures.success(table(out, "planning_problems.csv"), NAMES, out / "planning_success.png")
    text = "\n".join(plain_section(title, columns, lines) for _, title, columns, lines in tables if lines)
    (out / "planning.md").write_text(text, encoding="utf-8")
    print(text)


def problem_line(result: Result) -> list[str]:
    """Line of one planner on one problem."""
    verdict, problem = result.verdict, result.problem
    line = [result.planner, result.arm, problem["scene"], str(problem["index"]), str(result.answer.claimed)]
    line += [str(result.kept), f"{result.milliseconds:.4g}", str(result.answer.margin_0)]
    if verdict is None:
        return line + [""] * 7
    figures = [1e3 * verdict.clearance, verdict.off_ends, verdict.outside, verdict.length, result.answer.duration]
    return line + [f"{figure:.4g}" for figure in (*figures, verdict.speed, verdict.acceleration)]


def summary(results: list[Result]) -> list[list[str]]:
    """Lines of each planner and arm; times of all calls, lengths and durations of valid plans."""
    grouped: dict[tuple[str, str], list[Result]] = {}
    for result in results:
        if result.planner not in {each.name for each in IMPROVING}:
            grouped.setdefault((result.planner, result.arm), []).append(result)
    return [
        summary_line(mine, grouped.get((planners.Old.name, arm), []))
        for (_, arm), mine in sorted(grouped.items(), key=lambda item: NAMES.index(item[0][0]))
    ]


def summary_line(mine: list[Result], old: list[Result]) -> list[str]:
    """Figures of one planner on one arm, compared with those of the earlier one."""
    verdicts = [each.verdict for each in mine if each.verdict is not None]
    kept = [each for each in mine if each.kept]
    of_old = {each.key: each.verdict.length for each in old if each.kept}
    times = np.sort([each.milliseconds for each in mine])
    least = min((verdict.clearance for verdict in verdicts), default=np.nan)
    ratios = [each.verdict.length / of_old[each.key] for each in kept if each.key in of_old]
    rates = [rate for verdict in verdicts for rate in (verdict.speed, verdict.acceleration)]
    excess = max(rates, default=0.0) - 1.0
    return [
        *(mine[0].planner, mine[0].arm, str(len(mine)), str(len(verdicts)), str(len(kept))),
        *(
            str(len(verdicts) - len(kept)),
            digits(1e3 * least) if verdicts else "-",
            str(sum(each.answer.margin_0 for each in mine)),
        ),
        *map(digits, (np.median(times), np.quantile(times, 0.95), times[-1])),
        *(digits(np.median(values)) if values else "-" for values in ([each.verdict.length for each in kept], ratios)),
        digits(np.median([each.answer.duration for each in kept])) if kept else "-",
        f"{digits(100 * excess)} %" if excess > ROUNDING else "-",
    ]


def digits(value: float) -> str:
    """Formats three digits, without an exponent."""
    return f"{float(f'{value:.3g}'):g}"


def improvement(results: list[Result]) -> list[list[str]]:
    """Durations of the motions of the first plan and of 1 s, compared with those of 5 s, where all are valid."""
    lines = []
    kept = {(each.arm, each.planner, each.key): each for each in results if each.kept and each.planner in BUDGETS}
    for arm in dict.fromkeys(arm for arm, *_ in kept):
        for planner, budget in BUDGETS.items():
            pairs = [
                (each, best)
                for (of, by, key), each in kept.items()
                if (of, by) == (arm, planner) and (best := kept.get((arm, planners.Within5Seconds.name, key)))
            ]
            if pairs:
                ratios = np.array([each.answer.duration / best.answer.duration for each, best in pairs])
                share, slowest = (
                    f"{(ratios <= NEAR).sum()} of {len(ratios)}",
                    max(each.answer.wall for each, _ in pairs),
                )
                lines.append([arm, str(len(pairs)), budget, share, f"{np.median(ratios):.3g}", f"{slowest:.4g}"])
    return lines


def publish(out: Path, docs: Path, data: Path, acceleration: float) -> None:
    """Updates the site with the results in `out`: tables and pictures."""
    for name in ("planning.csv", "planning_improved.csv", "planning_batch.csv"):
        (docs / name).write_bytes((out / name).read_bytes())
    plan_figures.success(table(out, "planning_problems.csv"), NAMES, docs / "images" / "planning_success.png")
    plan_figures.pictures(data, acceleration, docs / "images" / "planning_scenes.png")
    page = docs / "benchmarks_motion.md"
    page.write_text(with_section(page.read_text(encoding="utf-8"), section(docs)), encoding="utf-8")


def with_section(page: str, text: str) -> str:
    """Replaces the text between the two marks of a page."""
    before, rest = page.split(BEGIN)
    return f"{before}{BEGIN}\n\n{text}\n\n{END}{rest.split(END)[1]}"


def table(folder: Path, name: str) -> list[dict[str, str]]:
    """Reads a table that was written."""
    with (folder / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def section(docs: Path) -> str:
    """Tables of the site in narrow form: a line for each planner, a figure for each arm."""
    rows = {(row["planner"], row["arm"]): row for row in table(docs, "planning.csv")}
    arms = list(dict.fromkeys(arm for _, arm in rows))
    lines = [
        [planner, *(" / ".join(say.format(**rows[planner, arm]) for arm in arms) for say in SHOWN.values())]
        for planner in dict.fromkeys(planner for planner, _ in rows)
    ]
    batches = " ".join(BATCH.format(**row) for row in table(docs, "planning_batch.csv"))
    text = "\n".join(plain_table([f"planner; figures of {' / '.join(arms)}", *SHOWN], lines))
    return "\n\n".join([text, fill(batches, 160, break_on_hyphens=False)] if batches else [text])
