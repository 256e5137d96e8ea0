"""Verdicts on Wang et al. 2019: each rule with data that must flip it."""

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beetle_ik.experiments.wang2019.motions import EQUAL_ITERATIONS, EQUAL_TUNING, Motion
from beetle_ik.experiments.wang2019.searches import TPBSO, TUNED, USUAL, is_lower
from beetle_ik.report import Claim, Spread, Verdict

parts = {
    name: import_module(f"beetle_ik.experiments.wang2019.{name}")
    for name in ("along_path", "comparison", "complexity", "equations", "obstacle", "point_to_point", "table_1")
}
PATHS = ("pentagram", "closed curve")
MET, NOT_MET, OPEN = Verdict.WITH_READING, Verdict.CONTRADICTED, Verdict.NOT_IDENTIFIABLE


def plan(cost: float, *, success: bool = True, after: int = 100, accuracy: float = 0.01) -> Any:
    """As much of a plan as the rules look at; its search was there after so many evaluations."""
    history = np.array([[1.0, 3.0 * cost], [float(after), cost]])
    return SimpleNamespace(cost=cost, success=success, history=history, accuracy=accuracy)


def motions(cost: Callable[[str, str, int], float], **options: Any) -> list[Motion]:
    """The eight motions, where a search's runs all cost what `cost` says of its name, the objective and the links."""

    def plans(searches: Sequence[Any], objective: str, links: int) -> dict[str, list[Any]]:
        return {search.name: [plan(cost(search.name, objective, links), **options)] * 3 for search in searches}

    return [
        Motion(objective, links, plans(USUAL, objective, links), plans(TUNED, objective, links))
        for objective in ("time", "joint_travel")
        for links in (2, 3, 4, 5)
    ]


def judge(part: str, rule: str, *data: Any) -> Verdict:
    claim: Claim = getattr(parts[part], rule)(*data)
    return claim.verdict


def test_a_mean_is_lower_by_more_than_two_standard_errors() -> None:
    assert is_lower([1.0, 1.1, 0.9], [2.0, 2.1, 1.9])
    assert not is_lower([1.0, 1.1, 0.9], [1.05, 1.15, 0.95])
    assert not is_lower([2.0, 2.1, 1.9], [1.0, 1.1, 0.9])
    assert is_lower([1.0], [1.1])
    assert not is_lower([], [1.0])
    assert not is_lower([1.0], [])


@pytest.mark.parametrize("objective", ["time", "joint_travel"])
def test_one_broken_limit_leaves_open_that_all_are_kept(objective: str) -> None:
    kept, broken = motions(lambda *_: 1.0), motions(lambda *_: 1.0, success=False)
    assert judge("point_to_point", "planned", objective, kept) is MET
    assert judge("point_to_point", "planned", objective, [*kept, broken[0], broken[-1]]) is OPEN


def test_convergence_is_held_against_the_best_plan_known() -> None:
    assert judge("point_to_point", "converges_well", motions(lambda *_: 1.0)) is MET
    stalls = motions(lambda name, _, links: 1.5 if name == TPBSO and links == 5 else 1.0)
    assert judge("point_to_point", "converges_well", stalls) is OPEN


def test_two_links_are_easy_if_few_iterations_do() -> None:
    assert judge("point_to_point", "is_easy", motions(lambda *_: 1.0, after=5 * 150)) is MET
    assert judge("point_to_point", "is_easy", motions(lambda *_: 1.0, after=20 * 150)) is OPEN


def test_the_best_search_is_beaten_by_nobody() -> None:
    def swarm(cost: float) -> list[Motion]:
        return motions(lambda name, *_: cost if name == TPBSO else 1.0)

    assert judge("comparison", "is_best", swarm(0.9)) is MET
    assert judge("comparison", "is_best", swarm(1.1)) is OPEN


def test_the_best_search_is_open_where_budgets_decide() -> None:
    """The rivals get below the swarm, but only with more evaluations than at equal iterations."""
    late = motions(lambda name, *_: 1.0 if name == TPBSO else 0.9, after=15_000)
    claim = parts["comparison"].is_best(late)
    assert claim.verdict is OPEN
    assert (claim.holds[EQUAL_ITERATIONS], claim.holds[EQUAL_TUNING]) == (True, False)


def test_the_pattern_of_the_rivals_can_be_met() -> None:
    def as_in_the_paper(name: str, objective: str, _: int) -> float:
        return {"PSO": {"time": 1.0, "joint_travel": 1.5}, "GA": {"time": 1.5, "joint_travel": 1.0}}.get(
            name, {"time": 1.0, "joint_travel": 1.0}
        )[objective]

    assert judge("comparison", "is_close_where_said", motions(as_in_the_paper)) is MET
    assert judge("comparison", "is_close_where_said", motions(lambda *_: 1.0)) is OPEN


def test_a_fast_search_is_there_first() -> None:
    found = motions(lambda *_: 1.0)
    for motion in found:
        slow = {name: plans if name == TPBSO else [plan(1.0, after=9000)] * 3 for name, plans in motion.usual.items()}
        motion.usual.update(slow)
        motion.tuned.update(slow)
    assert judge("comparison", "is_fast", found) is MET
    for motion in found:
        motion.usual[TPBSO] = motion.tuned[TPBSO] = [plan(1.0, after=29_000)] * 3
    assert judge("comparison", "is_fast", found) is OPEN


def past(swarm: list[Any], rivals: list[Any]) -> dict[int, dict[str, list[Any]]]:
    return {3: {"TPBSO": swarm, "PSO": rivals, "GA": rivals, "DE": rivals}}


def test_the_obstacle_is_passed_by_the_swarm_itself() -> None:
    good, long, hit = [plan(1.7)] * 4, [plan(2.5)] * 4, [plan(1.7, success=False)] * 3 + [plan(1.7)]
    assert judge("obstacle", "passes", past(good, hit)) is MET
    assert judge("obstacle", "passes", past(long, good)) is OPEN
    assert judge("obstacle", "passes", past(hit, good)) is OPEN


def test_robust_is_who_fails_no_more_often_than_the_others() -> None:
    good, hit, often = [plan(1.7)] * 4, [plan(1.7, success=False), *[plan(1.7)] * 3], [plan(1.7, success=False)] * 3
    assert judge("obstacle", "is_robust", past(good, hit)) is MET
    assert judge("obstacle", "is_robust", past(hit, good)) is MET  # 3 of 4 beside 4 of 4 tells nothing apart
    assert judge("obstacle", "is_robust", past([*often, plan(1.7)], good)) is OPEN
    assert judge("obstacle", "is_robust", past([*often, often[0]], good)) is OPEN
    assert judge("obstacle", "is_robust", past(good, [*often, often[0]])) is MET
    assert judge("obstacle", "is_robust", past([plan(1.8)] * 4, good)) is OPEN


def test_one_run_of_each_search_decides_nothing() -> None:
    def first(plans: Mapping[str, Sequence[Any]]) -> dict[str, Sequence[Any]]:
        return {name: some[:1] for name, some in plans.items()}

    several = motions(lambda name, *_: 1.1 if name == TPBSO else 1.0)
    found = [Motion(each.objective, each.links, first(each.usual), first(each.tuned)) for each in several]
    assert judge("comparison", "is_best", found) is Verdict.NOT_TESTED
    assert judge("comparison", "is_fast", found) is Verdict.NOT_TESTED
    once = [along([plan(1.0)], path=path, objective=o) for path in PATHS for o in ("time", "joint_travel")]
    assert judge("along_path", "takes_as_many_iterations", once) is Verdict.NOT_TESTED
    assert judge("obstacle", "is_robust", past([plan(1.8)], [plan(1.7)])) is Verdict.NOT_TESTED
    assert judge("obstacle", "passes", past([plan(1.8)], [plan(1.7)])) is Verdict.NOT_TESTED


def along(plans: list[Any], *, path: str = "pentagram", objective: str = "time", retimed: float = 1.0) -> Any:
    return SimpleNamespace(path=path, objective=objective, plans={TPBSO: plans}, best=plans[0], retimed=retimed)


def test_a_path_is_followed_by_all_plans_within_the_accuracy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts["along_path"], "from_the_points", lambda plan: plan.accuracy)
    assert judge("along_path", "follows", "pentagram", [along([plan(1.0, accuracy=0.03)])]) is MET
    assert judge("along_path", "follows", "pentagram", [along([plan(1.0, accuracy=0.05)])]) is OPEN
    assert judge("along_path", "follows", "pentagram", [along([plan(1.0, success=False)])]) is OPEN


@pytest.mark.parametrize(("curve", "verdict"), [(20, MET), (50, OPEN)])
def test_iterations_differ_by_a_factor_of_two_at_most(curve: int, verdict: Verdict) -> None:
    cases = [
        along([plan(1.0, after=iterations * 120)] * 2, path=path, objective=objective)
        for path, iterations in zip(PATHS, (20, curve), strict=True)
        for objective in ("time", "joint_travel")
    ]
    assert judge("along_path", "takes_as_many_iterations", cases) is verdict


def test_even_timing_is_held_against_the_fastest() -> None:
    assert judge("along_path", "spreads_time_evenly", [along([plan(1.0)], retimed=0.95)]) is MET
    assert judge("along_path", "spreads_time_evenly", [along([plan(1.0)], retimed=0.7)]) is OPEN


def test_the_printed_deviations_decide_who_varies_least() -> None:
    printed = parts["table_1"]._PRINTED
    assert judge("table_1", "varies_least", printed) is NOT_MET
    steadier = {
        case: {objective: Spread(s.mean, s.std / 2 if case[1] == TPBSO else s.std) for objective, s in spreads.items()}
        for case, spreads in printed.items()
    }
    assert judge("table_1", "varies_least", steadier) is Verdict.REPRODUCED


def test_table_1_stays_open_without_its_geometry() -> None:
    assert judge("table_1", "performs_better", parts["table_1"]._PRINTED) is OPEN


def grown(search: str, before: int, after: int) -> Any:
    runs = [SimpleNamespace(evaluations=count, elapsed=1e-6 * count) for count in (before, after)]
    return parts["complexity"].Growth(search, "members, n_p", 25, 100, *runs)


def test_counts_decide_about_growth_and_work() -> None:
    linear, steeper = grown("PSO", 1000, 4000), grown("PSO", 1000, 16_000)
    assert judge("complexity", "grows_in_proportion", [linear]) is Verdict.REPRODUCED
    assert judge("complexity", "grows_in_proportion", [linear, steeper]) is NOT_MET
    rivals = {"PSO": linear, "GA": grown("GA", 1000, 4000)}
    alike, thrice = grown("TPBSO", 1000, 4000), grown("TPBSO", 3000, 12_000)
    assert judge("complexity", "does_no_more", rivals | {"TPBSO": alike}) is MET
    assert judge("complexity", "does_no_more", rivals | {"TPBSO": thrice}) is OPEN
    assert judge("complexity", "does_no_more", rivals | {"TPBSO": grown("TPBSO", 3000, 50_000)}) is NOT_MET


def test_rounding_of_very_short_segments_breaks_the_polynomials() -> None:
    motion = np.array([[0.1, 1.2, -0.3, 2.0]])
    assert judge("equations", "joins", motion, np.array([[0.7, 1.3]])) is Verdict.REPRODUCED
    assert judge("equations", "joins", motion, np.array([[1e-6, 1e-6]])) is NOT_MET


def test_eq_1_and_2_have_no_answer_out_of_reach() -> None:
    assert judge("equations", "reaches", np.array([[0.3, 0.7], [-1.2, -1.0]])) is MET
    assert judge("equations", "reaches", np.array([[0.3, 0.7], [2.0, 1.0]])) is OPEN


def test_eq_13_lets_a_wrist_into_the_hole_of_unequal_links() -> None:
    orientation, in_the_hole, in_reach = np.array([0.0]), np.array([0.6]), np.array([1.5])
    assert judge("equations", "keeps_out", orientation, in_reach) is MET
    assert judge("equations", "keeps_out", orientation, in_the_hole) is OPEN


def test_only_a_spline_leaves_the_range_of_its_nodes() -> None:
    assert judge("equations", "stays_in_range", np.full((1, 5), 0.5)) is MET
    assert judge("equations", "stays_in_range", np.array([[1.0, 1.0, 0.0, 1.0, 1.0]])) is OPEN
