"""The learning rate: on the paper's seven motions, and on random targets."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

import beetle_ik as bik

from ...report import BLACK, BLUE, VERMILION, Check, Claim, Column, Figure, Part, Section, Table, drawing, line, number
from ..experiment import Context
from .published import BUDGET, HIDDEN_FACTOR, LEARNING_RATE, MOTIONS, R2, START, THRESHOLD, Array
from .task import ROBOT, TOLERANCE, Motion, curvatures, target
from .task import reach as reach_one

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "The learning rate"
REACH = "From anywhere to anywhere"
_RATES = (1.0, 0.5, 0.1, 0.05, 0.02, 0.01)
RATE = HIDDEN_FACTOR * LEARNING_RATE  # learning rate of the paper, in the scale of eq. (11)
_DEGREE = float(np.radians(1.0))

_TEXT = """
The paper tried learning rates of 1, 0.5, 0.1 and 0.05 and settled on 0.01. In its own scale (20 times eq. 11) that
choice is right: larger rates never settle, and only the step limit of one degree keeps them from diverging. Taken
literally, on eq. (11), a rate of 0.01 is far too slow.

Why η = 0.2 (in the scale of eq. 11) is the best: close to the target, gradient descent is stable if η times the largest
eigenvalue of J'J is below 2. At the seven targets that eigenvalue is {low} to {high}, so the limit for η is {bound}.
**The rate is within {margin} % of the limit that these seven targets set.** For {above} % of targets anywhere in the
robot's reach the eigenvalue is above 10, and descent at that rate cannot settle there.
"""
_TEXT_REACH = """
Starts and targets are drawn uniformly between the limits of Table 1. A search *converges* if it comes within 10⁻⁴ m and
rad of its target with the joint limits switched off. It *solves* the target if it does so within the limits: APPS may
pass them on the way and comes back by whole turns; the others stay inside.

`learning_rate="auto"` takes the rate from the gradients before and after the last step (Barzilai and Borwein 1988): no
rate has to be found, and no fixed rate comes close to it. It is the default of `APPS()` in this library. For a single
answer the library's default, Levenberg-Marquardt from many starts, remains the better choice.
"""


def rates(runs: list[Motion]) -> Part:
    """Tries the paper's rates on its own motions, in both scales of E."""
    scales = {"20 times eq. (11)": HIDDEN_FACTOR, "eq. (11)": 1.0}
    counts = {(scale, rate): _counts(rate, factor) for scale, factor in scales.items() for rate in _RATES}
    eigenvalues = [float(curvatures(run.solution.q)[0]) for run in runs]
    anywhere = [float(curvatures(q)[0]) for q in ROBOT.random_configurations(1000, seed=1)]
    above = 100.0 * float(np.mean(np.array(anywhere) > 2.0 / RATE))
    section = Section(
        TITLE,
        [
            _TEXT.format(
                low=number(min(eigenvalues), 2),
                high=number(max(eigenvalues), 3),
                bound=number(2.0 / max(eigenvalues), 3),
                margin=number(100.0 * (1.0 - RATE * max(eigenvalues) / 2.0), 1),
                above=number(above, 2),
            ),
            Figure(
                name="stability",
                title="The steepest curvature of E, at the seven targets and at 1000 random ones",
                drawing=_draw(eigenvalues, anywhere),
                caption="To the right of the line a learning rate of 0.2 cannot settle.",
            ),
            Table(
                name="learning_rates",
                title="Iterations by learning rate and by the scale of E that it is meant for, threshold 10⁻⁸",
                columns=[Column(name="scale of E"), Column(name="η"), *(Column(name=name) for name in MOTIONS)],
                rows=[
                    [scale, f"{rate:g}", *(count if count is not None else f"> {BUDGET}" for count in row)]
                    for (scale, rate), row in counts.items()
                ],
                caption="Each motion starts from the printed R₂ of the one before.",
            ),
        ],
    )
    solved = {key: sum(count is not None for count in row) for key, row in counts.items()}
    own = {rate: solved["20 times eq. (11)", rate] for rate in _RATES}
    return section, [best_rate_claim(own)]


def best_rate_claim(solved: dict[float, int]) -> Claim:
    """Judges the number of motions that converge, of seven, by learning rate."""
    return Claim.judged(
        "Of the learning rates 1, 0.5, 0.1, 0.05 and 0.01 the last is the best.",
        source="Section “BP” and the experiment's parameters",
        rule=f"All seven motions converge within {BUDGET} iterations at 0.01, and none at the others.",
        measured=", ".join(f"{rate}: {count}" for rate, count in solved.items()),
        holds=solved[LEARNING_RATE] == len(MOTIONS)
        and all(count == 0 for rate, count in solved.items() if rate != LEARNING_RATE),
        reading="The rate belongs to an E that is 20 times that of eq. (11).",
        section=TITLE,
    )


def _counts(rate: float, factor: float) -> list[int | None]:
    """Returns the iterations of each motion; None if the budget ends first."""
    solver = bik.papers.APPS(learning_rate=rate * factor, step_limit=_DEGREE, error_threshold=THRESHOLD / factor)
    starts = np.radians(np.vstack([START, R2[:-1]]))
    found = [reach_one(target(i), start, solver) for i, start in enumerate(starts)]
    return [None if each.iterations >= BUDGET else each.iterations for each in found]


def _draw(eigenvalues: list[float], anywhere: list[float]) -> Drawing:
    with drawing(2.6) as figure:
        axes = figure.subplots()
        axes.hist(anywhere, bins=50, color=BLUE, alpha=0.6, label="1000 random configurations")
        axes.vlines(
            eigenvalues, 0.0, 8.0, color=BLACK, linewidth=2.5, label="the seven targets,\nsome of them mirrored"
        )
        axes.axvline(10.0, color=VERMILION, linestyle="--", label="2/η = 10")
        axes.set(xlabel="largest eigenvalue of J'J [m², squares of entries per rad²]", ylabel="configurations")
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


Solver: TypeAlias = (
    bik.papers.APPS | bik.JacobianTranspose | bik.NewtonRaphson | bik.LevenbergMarquardt | bik.MultiStart
)
_FIXED = (0.2, 0.15, 0.13, 0.1, 0.05)
_PATIENCE = 20_000  # iterations
_NEARLY_ALL = 95.0  # %
_ANYWHERE = bik.Limits(lower=-np.inf, upper=np.inf)
_PAPER, _AUTO = "APPS, η = 0.2 (the paper's)", "APPS, automatic rate"


def _solvers() -> dict[str, Solver]:
    fixed = {
        (_PAPER if rate == 0.2 else f"APPS, η = {rate}"): bik.papers.APPS(learning_rate=rate, step_limit=_DEGREE)
        for rate in _FIXED
    }
    return {
        **fixed,
        _AUTO: bik.papers.APPS(),
        "Jacobian transpose": bik.JacobianTranspose(),
        "Newton-Raphson": bik.NewtonRaphson(),
        "Levenberg-Marquardt, one start": bik.LevenbergMarquardt(),
        "APPS from many starts": bik.MultiStart(bik.papers.APPS()),
        "Levenberg-Marquardt from many starts (the default)": bik.MultiStart(bik.LevenbergMarquardt()),
    }


def reach(context: Context) -> Part:
    """Measures how often each method gets from a random start to a random target."""
    count, patient = context.pick(full=(2000, 500), short=(200, 0))
    starts = ROBOT.random_configurations(count, seed=context.seed)
    goals = ROBOT.fk(ROBOT.random_configurations(count, seed=context.seed + 1))
    shares: dict[str, list[float]] = {}
    late: dict[str, float] = {}
    for name, solver in context.each("yuan2016: random targets", list(_solvers().items())):
        shares[name] = [_share(goals, starts, solver, limits, BUDGET) for limits in (_ANYWHERE, None)]
        if patient and isinstance(solver, bik.papers.APPS):
            late[name] = _share(goals[:patient], starts[:patient], solver, _ANYWHERE, _PATIENCE)
    section = Section(
        REACH,
        [
            _TEXT_REACH,
            Figure(
                name="reach",
                title=f"Random targets reached within {BUDGET} iterations, of {count}",
                drawing=_draw_shares(shares),
                caption="From one random start each, unless the label says otherwise.",
            ),
            _share_table(shares, late, count, patient),
        ],
    )
    converged = {name: row[0] for name, row in shares.items()}
    by_budget = {BUDGET: converged} | ({_PATIENCE: late} if late else {})
    return section, [no_guess_claim(converged), _rate_check(by_budget)]


def _share_table(shares: dict[str, list[float]], late: dict[str, float], count: int, patient: int) -> Table:
    return Table(
        name="random_targets",
        title=f"Share of {count} random targets, of {patient} in the last column"
        if late
        else f"Share of {count} targets",
        columns=[
            Column(name="method"),
            Column(name=f"converged in {BUDGET} iterations", unit="%"),
            Column(name=f"solved in {BUDGET} iterations", unit="%"),
            Column(name=f"converged in {_PATIENCE} iterations", unit="%"),
        ],
        rows=[[name, *row, late.get(name)] for name, row in shares.items()],
        folded=True,
    )


def no_guess_claim(shares: dict[str, float]) -> Claim:
    """Judges the fraction of random targets (%) that converge within the paper's iterations, by method."""
    named = {name: shares[name] for name in (_PAPER, _AUTO)}
    return Claim.judged(
        "APPS does not need an accurate initial guess.",
        source="Conclusion",
        rule=f"From random starts at least {_NEARLY_ALL:g} % of random targets converge within {BUDGET} iterations.",
        measured="; ".join(f"{name}: {number(share, 3)} %" for name, share in named.items()),
        holds={name: share >= _NEARLY_ALL for name, share in named.items()},
        reason="True of the seven motions. Elsewhere their rate is too high, or the error too flat.",
        section=REACH,
    )


def _rate_check(by_budget: dict[int, dict[str, float]]) -> Check:
    """Checks the fractions (%) by allowed iterations and method."""
    compared = {
        budget: (of[_AUTO], max(share for name, share in of.items() if "η" in name)) for budget, of in by_budget.items()
    }
    return Check(
        statement="The automatic learning rate does at least as well as the best fixed one.",
        rule="The automatic rate converges on at least as many random targets as each fixed rate.",
        measured="; ".join(
            f"{budget} iterations: {number(auto, 3)} % against {number(fixed, 3)} %"
            for budget, (auto, fixed) in compared.items()
        ),
        holds=all(auto >= fixed for auto, fixed in compared.values()),
        section=REACH,
    )


def _share(goals: Array, starts: Array, solver: Solver, limits: bik.Limits | None, budget: int) -> float:
    found = bik.solve_batch(
        ROBOT,
        goals,
        start_q=starts,
        solver=solver,
        limits=limits,
        position_tolerance=TOLERANCE,
        rotation_tolerance=TOLERANCE,
        stop=bik.Stop(max_iterations=budget, max_evaluations=2 * budget),
    )
    return 100.0 * float(np.mean(found.success))


def _draw_shares(shares: dict[str, list[float]]) -> Drawing:
    with drawing(4.6) as figure:
        axes = figure.subplots()
        place = np.arange(len(shares))[::-1]
        for i, label in enumerate(("converged, without limits", "solved, within the limits")):
            values = [row[i] for row in shares.values()]
            bars = axes.barh(place + 0.2 * (1 - 2 * i), values, height=0.36, color=line(i)["color"], label=label)
            axes.bar_label(bars, fmt="%.0f", padding=3, fontsize=8)
        axes.set_yticks(place, list(shares))
        axes.set(xlabel="share of random targets [%]", xlim=(0.0, 107.0))
        axes.grid(visible=False, axis="y")
        axes.legend(loc="upper center", bbox_to_anchor=(0.4, 1.14), ncols=2)
    return figure
