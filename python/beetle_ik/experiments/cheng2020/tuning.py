"""Tunes the methods and writes `tuned.json`: `python -m beetle_ik.experiments.cheng2020.tuning`.

Every method, BAS included, gets the same number of settings for every box and band, on seeds of its own.
"""

import json
import math

import numpy as np

from .boxes import BANDS, BOXES, PLANAR, SCALED, Box, Cost, ErrorBox, Setting, evaluations_a_step, track
from .methods import BEETLE, BUDGET, METHODS, PATIENCE, Draws, Method
from .settings import IIWA, STEPS, Solver, steady_error
from .tuned import BUDGETED, FILE, Tuned

COMMAND = "python -m beetle_ik.experiments.cheng2020.tuning"
TRIED = 64  # settings of each method
FINALISTS = 6  # cheapest settings on the first seed, which run on all seeds
SEEDS = range(1001, 1009)
MAY_MISS = 1e-3  # fraction of steps that may end outside the band
NO_BAND = 1e-14  # m: a band out of reach


def settings(method: Method, limit: int) -> list[Solver]:
    """Returns the settings that are tried, the same for every box and band."""
    draws = Draws(sum(map(ord, method.name)))
    return [method.draw(draws, limit) for _ in range(TRIED)]


def _boxed(method: Method) -> list[Setting]:
    """Returns the settings in boxes as wide as the error; BAS contracts its search by itself."""
    if method.name == BEETLE:
        return list(settings(method, PATIENCE))
    draws = Draws(1)
    boxed: list[Setting] = []
    for solver in settings(method, PATIENCE):
        options = solver.__getnewargs_ex__()[1]
        inner = type(solver)(**{**options, "max_generations": draws.count(1, 12)})
        boxed.append(ErrorBox(solver=inner, reach=draws.log(0.5, 10.0)))
    return boxed


def _tune(box: Box, band: float, method: Method) -> Tuned:
    tried = _boxed(method) if box is SCALED else settings(method, PATIENCE)
    finalists = sorted(tried, key=lambda setting: _rank(_costs(box, band, setting, SEEDS[:1])))[:FINALISTS]
    found = [_costs(box, band, setting, SEEDS) for setting in finalists]
    best = min(range(FINALISTS), key=lambda i: _rank(found[i]))
    missed = sum(cost.missed for cost in found[best])
    return Tuned(finalists[best], round(_mean(found[best]), 1), missed)


def _costs(box: Box, band: float, setting: Setting, seeds: range) -> list[Cost]:
    return [box.run(setting, seed, band) for seed in seeds]


def _mean(costs: list[Cost]) -> float:
    return float(np.mean([cost.evaluations for cost in costs]))


def _rank(costs: list[Cost]) -> tuple[float, float]:
    """Returns the sort key of a setting: the cheapest of those that miss hardly a step comes first."""
    missed = sum(cost.missed for cost in costs)
    return max(missed - MAY_MISS * STEPS * len(costs), 0.0), _mean(costs)


def _tune_budget(method: Method) -> Tuned:
    """Finds the smallest error with the budget of Figure 7."""
    first = sorted(settings(method, BUDGET), key=lambda solver: _error(solver, SEEDS[:1]))
    best = min(first[:FINALISTS], key=lambda solver: _error(solver, SEEDS))
    runs = [track(IIWA, best, seed=seed, band=NO_BAND) for seed in SEEDS]
    return Tuned(best, round(float(np.mean([evaluations_a_step(run) for run in runs])), 1), 0)


def _error(solver: Solver, seeds: range) -> float:
    runs = [track(IIWA, solver, seed=seed, band=NO_BAND) for seed in seeds]
    if any(evaluations_a_step(run) > BUDGET for run in runs):
        return math.inf
    return float(np.mean([steady_error(run) for run in runs]))


def main() -> None:
    """Tunes all methods and writes the file, one line for each."""
    chosen = []
    for method in METHODS:
        cases = [(box, band) for box in BOXES for band in (BANDS if box is not PLANAR else BANDS[:1])]
        chosen += [_record(box.name, band, method, _tune(box, band, method)) for box, band in cases]
        chosen.append(_record(BUDGETED, BUDGET, method, _tune_budget(method)))
        print(f"{method.name}: done", flush=True)
    FILE.write_text("[\n" + ",\n".join(json.dumps(record) for record in chosen) + "\n]\n", encoding="utf-8")


def _record(box: str, goal: float, method: Method, tuned: Tuned) -> dict[str, object]:
    solver = tuned.setting.solver if isinstance(tuned.setting, ErrorBox) else tuned.setting
    reach = {"reach": tuned.setting.reach} if isinstance(tuned.setting, ErrorBox) else {}
    spent = {"evaluations": tuned.evaluations, "missed": tuned.missed}
    return {"box": box, "goal": goal, "method": method.name, **spent, **reach, "options": solver.__getnewargs_ex__()[1]}


if __name__ == "__main__":
    main()
