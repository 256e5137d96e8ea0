"""Verdicts on Cheng et al. 2020: each rule with data that must flip it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from beetle_ik.experiments.cheng2020 import tuned, tuning
from beetle_ik.experiments.cheng2020.accuracy import Point, pseudo_inverse_claim
from beetle_ik.experiments.cheng2020.boxes import BANDS, SCALED, TRUST, WHOLE, ErrorBox
from beetle_ik.experiments.cheng2020.hardware import circle_claim
from beetle_ik.experiments.cheng2020.methods import BEETLE, METHODS, RIVALS, Draws
from beetle_ik.experiments.cheng2020.motion import error_claim, limit_claim, tracking_claim
from beetle_ik.experiments.cheng2020.resources import Reached, convergence_claim, memory_claim, real_time_claim
from beetle_ik.experiments.cheng2020.rival_claims import (
    levels_claim,
    more_accurate_claim,
    order_claim,
    oscillations_claim,
)
from beetle_ik.experiments.cheng2020.search_box import Costs, Spent, lead_claims
from beetle_ik.experiments.cheng2020.settings import FIVE_LINK, PARAMETERS
from beetle_ik.experiments.cheng2020.tip_box import region_claim
from beetle_ik.experiments.cheng2020.trends import Measured, explorations_claim, length_claim
from beetle_ik.experiments.cheng2020.tuned import BUDGETED, all_tuned
from beetle_ik.experiments.cheng2020.tuning import PATIENCE, TRIED, settings
from beetle_ik.report import Printed, Spread, Verdict

REPRODUCED, WITH_READING, CONTRADICTED = Verdict.REPRODUCED, Verdict.WITH_READING, Verdict.CONTRADICTED
NOT_IDENTIFIABLE, NOT_TESTED = Verdict.NOT_IDENTIFIABLE, Verdict.NOT_TESTED


@pytest.mark.parametrize(
    ("stays", "verdict"),
    [((True, True), WITH_READING), ((True, False), NOT_IDENTIFIABLE), ((False, False), NOT_IDENTIFIABLE)],
)
def test_tracking(stays: tuple[bool, bool], verdict: Verdict) -> None:
    assert tracking_claim(dict(zip(("star", "chain"), stays, strict=True))).verdict is verdict


@pytest.mark.parametrize(
    ("errors", "verdict"),
    [
        ({4e-4: 2e-4, 4e-5: 2e-5, 4e-6: 2e-6}, NOT_IDENTIFIABLE),  # a share of the band
        ({4e-4: 2e-5, 4e-5: 2.5e-5, 4e-6: 1.5e-5}, WITH_READING),  # a property of the method
        ({4e-4: 2e-4, 4e-6: 2.7e-5}, NOT_IDENTIFIABLE),  # with other c1 and c2 it may be met
    ],
)
def test_steady_error(errors: dict[float, float], verdict: Verdict) -> None:
    assert error_claim(FIVE_LINK.name, errors).verdict is verdict


def test_velocity_limit() -> None:
    assert limit_claim(0.0, 2.0, 10).verdict is WITH_READING
    assert limit_claim(1e-3, 2.0, 10).verdict is NOT_IDENTIFIABLE
    assert limit_claim(0.0, 0.0, 10).verdict is NOT_IDENTIFIABLE  # a limit that no run needs shows nothing


def test_what_the_paper_does_not_give_cannot_be_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    order = dict(zip(("BAS", "PSO", "QPSO", "FA", "GA"), range(1, 6), strict=True))
    levels = {"BAS": 1.2e-5, "PSO": 2e-4, "GA": 9e-4}
    assert region_claim(0.0).verdict is NOT_IDENTIFIABLE
    assert order_claim("", order).verdict is NOT_IDENTIFIABLE
    assert levels_claim("", levels).verdict is NOT_IDENTIFIABLE
    for name, value in PARAMETERS.items():
        if isinstance(value, Printed):
            monkeypatch.setitem(PARAMETERS, name, 1.0)
    assert region_claim(0.0).verdict is REPRODUCED
    assert region_claim(0.1).verdict is CONTRADICTED
    assert order_claim("", order).verdict is REPRODUCED
    assert order_claim("", order | {"PSO": 9}).verdict is CONTRADICTED
    assert levels_claim("", levels).verdict is REPRODUCED
    assert levels_claim("", levels | {"BAS": 1e-9}).verdict is CONTRADICTED


def measured(value: float, steps: float, roughness: float, evaluations: float) -> Measured:
    return Measured(value, *(Spread(mean, 0.0) for mean in (steps, roughness, evaluations)))


def test_explorations() -> None:
    few, many = measured(5, 16, 0.10, 3e4), measured(200, 6, 0.07, 3e5)
    rougher = replace(many, roughness=Spread(0.13, 0.0))
    star, chain = ("arm", "star"), ("arm", "chain")
    assert explorations_claim({star: [few, many], chain: [few, many]}).verdict is WITH_READING
    assert explorations_claim({star: [few, many], chain: [few, rougher]}).verdict is NOT_IDENTIFIABLE
    assert explorations_claim({star: [few, rougher]}).verdict is NOT_IDENTIFIABLE


def test_antenna_length() -> None:
    falling = [measured(0.3, 9, 0.01, 3e5), measured(1, 9, 0.05, 1e5), measured(5, 9, 0.1, 5e4)]
    optimum = [*falling[:2], measured(5, 9, 0.1, 4e5)]
    assert length_claim("c₁", "", {("arm", "star"): falling}).verdict is WITH_READING
    assert length_claim("c₁", "", {("arm", "star"): optimum}).verdict is NOT_IDENTIFIABLE
    assert length_claim("c₁", "", {("arm", "star"): optimum[1:]}).verdict is NOT_IDENTIFIABLE


def test_accuracy_at_equal_budget() -> None:
    errors = {"BAS": 1e-10, "GA": 1e-3, "PSO": 1e-4, "FA": 1e-4, "QPSO": 1e-4}
    above, below = {"GA": 1e-9, "PSO": 1e-8}, {"GA": 1e-9, "PSO": 1e-14}
    assert more_accurate_claim("", errors, above).verdict is WITH_READING
    assert more_accurate_claim("", errors, below).verdict is NOT_IDENTIFIABLE
    assert more_accurate_claim("", errors | {"FA": 1e-11}, below).verdict is NOT_IDENTIFIABLE


def test_oscillations() -> None:
    roughness, rough, smooth = {"BAS": 0.04, "GA": 0.2, "PSO": 0.1}, {"GA": 0.1, "PSO": 0.1}, {"GA": 0.1, "PSO": 0.04}
    assert oscillations_claim("", roughness, rough).verdict is WITH_READING
    assert oscillations_claim("", roughness, smooth).verdict is NOT_IDENTIFIABLE
    assert oscillations_claim("", roughness | {"PSO": 0.05}, smooth).verdict is NOT_IDENTIFIABLE


def costs(whole: float, trust: float, scaled: float) -> Costs:
    """BAS needs 100 evaluations, every other method the given multiple of that."""
    found: Costs = {}
    for box, ratio in ((WHOLE, whole), (TRUST, trust), (SCALED, scaled)):
        for band in BANDS:
            found[box.name, band, BEETLE] = Spent(Spread(100.0, 1.0), 0)
            for name in RIVALS:
                found[box.name, band, name] = Spent(Spread(100.0 * ratio, 1.0), 0)
    return found


@pytest.mark.parametrize(
    ("ratios", "faster", "stronger"),
    [
        ((4.0, 1.5, 0.9), NOT_IDENTIFIABLE, NOT_IDENTIFIABLE),
        ((4.0, 3.0, 2.0), WITH_READING, WITH_READING),
        ((1.9, 1.5, 1.1), NOT_IDENTIFIABLE, WITH_READING),
        ((0.9, 0.8, 0.7), NOT_IDENTIFIABLE, NOT_IDENTIFIABLE),
    ],
)
def test_the_lead_over_the_swarms(ratios: tuple[float, float, float], faster: Verdict, stronger: Verdict) -> None:
    assert [claim.verdict for claim in lead_claims(costs(*ratios))] == [faster, stronger]


def test_the_pseudo_inverse() -> None:
    beetle = [Point(1e-3, 100.0, 1e-4), Point(1e-6, 400.0, 4e-4)]
    walks = {"chain": beetle, "greedy": beetle}
    assert pseudo_inverse_claim(walks, Point(2e-6, 5.0, 3e-6)).verdict is CONTRADICTED
    assert pseudo_inverse_claim(walks, Point(2e-6, 500.0, 3e-6)).verdict is WITH_READING
    assert pseudo_inverse_claim(walks, Point(2e-6, 5.0, 3e-3)).verdict is WITH_READING
    quick = walks | {"greedy": [Point(1e-6, 4.0, 4e-4)]}
    assert pseudo_inverse_claim(quick, Point(2e-6, 5.0, 3e-6)).verdict is NOT_IDENTIFIABLE


@pytest.mark.parametrize(
    ("reached", "verdict"), [((200, 200), WITH_READING), ((200, 198), NOT_IDENTIFIABLE), ((190, 198), NOT_IDENTIFIABLE)]
)
def test_finitely_many_passes_contradict_no_limit(reached: tuple[int, int], verdict: Verdict) -> None:
    found = [Reached(walk, 1.0, 200, [0, count], 0.0) for walk, count in zip(("star", "chain"), reached, strict=True)]
    assert convergence_claim(found).verdict is verdict
    assert convergence_claim([replace(one, count=30) for one in found]).verdict is NOT_TESTED  # a quick pass


def test_memory_and_time() -> None:
    assert memory_claim({"BAS": 6, "GA": 40, "PSO": 24}).verdict is WITH_READING
    assert memory_claim({"BAS": 6, "GA": 40, "PSO": 6}).verdict is NOT_IDENTIFIABLE
    assert real_time_claim(1e-5).verdict is WITH_READING
    assert real_time_claim(0.3).verdict is NOT_IDENTIFIABLE


def test_the_circle_of_the_arm() -> None:
    assert circle_claim(np.array([0.101, 0.099])).verdict is WITH_READING
    assert circle_claim(np.array([0.101, 0.093])).verdict is NOT_IDENTIFIABLE
    assert circle_claim(None, "MuJoCo is not installed").verdict is NOT_TESTED


def test_all_methods_are_tuned_alike() -> None:
    """As many settings for each, and a chosen one for each box and accuracy, among those that were tried."""
    tried = {method.name: settings(method, PATIENCE) for method in METHODS}
    assert {len(some) for some in tried.values()} == {TRIED}
    goals = {key[:2] for key in all_tuned()}
    assert set(all_tuned()) == {(*goal, method.name) for goal in goals for method in METHODS}
    for name, some in tried.items():
        assert repr(all_tuned()[TRUST.name, BANDS[0], name].setting) in map(repr, some)


def test_drawn_options_stay_in_their_ranges() -> None:
    draws = Draws(0)
    assert all(0.3 <= draws.log(0.3, 5.0) <= 5.0 for _ in range(200))
    assert {draws.count(1, 3) for _ in range(200)} == {1, 2, 3}


def test_tuning_writes_what_the_report_reads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A short tuning of BAS and GA, for the trust box and for a box as long as the error."""
    few = {"TRIED": 2, "FINALISTS": 1, "SEEDS": range(1001, 1002), "BOXES": (TRUST, SCALED), "BANDS": BANDS[:1]}
    for name, value in (few | {"METHODS": METHODS[:2], "FILE": tmp_path / "tuned.json"}).items():
        monkeypatch.setattr(tuning, name, value)
    tuning.main()
    monkeypatch.setattr(tuned, "FILE", tmp_path / "tuned.json")
    written = all_tuned.__wrapped__()
    assert {key[2] for key in written} == {"BAS", "GA"}
    assert {key[0] for key in written} == {TRUST.name, SCALED.name, BUDGETED}
    assert isinstance(written[SCALED.name, BANDS[0], "GA"].setting, ErrorBox)
    assert all(one.evaluations > 0.0 for one in written.values())
