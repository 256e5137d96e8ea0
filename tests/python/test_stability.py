"""The stable interface of docs/stability.md is unchanged."""

import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

ROOT = Path(__file__).parents[2]
GROUPS = ("Stable", "Provisional", "Of the papers")


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("stable_interface", ROOT / "tools" / "stable_interface.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_public_name_is_in_one_group(tool: ModuleType) -> None:
    listed = [name for group in GROUPS for name in tool.names(group)]
    assert sorted(set(bik.__all__) - set(listed)) == []
    assert sorted(name for name in bik.__all__ if listed.count(name) > 1) == []


def test_the_stable_interface_is_as_agreed(tool: ModuleType) -> None:
    agreed = tool.KEPT.read_text(encoding="utf-8").splitlines()
    today = list(tool.lines())
    lost, new = sorted(set(agreed) - set(today)), sorted(set(today) - set(agreed))
    assert not lost, (
        f"gone or changed: {lost}; now: {new}. A stable name or argument leaves by deprecation alone (CONTRIBUTING.md, "
        '"Deprecation"). A new optional argument is welcome: run tools/stable_interface.py and commit the list.'
    )
    assert not new, f"new: {new}. Run tools/stable_interface.py and commit the list: from then on they are stable."


def test_a_changed_signature_is_noticed(tool: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    def solve(robot: object, *, target: object) -> None:
        del robot, target

    monkeypatch.setattr(bik, "solve", solve)
    assert "solve(robot, *, target)" in list(tool.lines())


def test_an_old_name_of_the_papers_warns() -> None:
    with pytest.warns(
        DeprecationWarning, match=r"^beetle_ik.BAS is now beetle_ik.papers.BAS; the old name goes in 0.3$"
    ):
        assert bik.BAS is bik.papers.BAS  # type: ignore[attr-defined]


Q = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
PANDA = bik.Robot.named("panda")
TARGET = [0.4, 0.1, 0.5]
LINE = bik.paths.polyline([PANDA.fk(Q)[:3, 3], TARGET], duration=1.0)
PLANT = bik.KinematicPlant(PANDA)
LIMITS = bik.Limits(velocity=1.0, acceleration=2.0)
NEW = {"q0": "start_q", "q1": "end_q", "qd0": "start_qd", "qd1": "end_qd", "qdd0": "start_qdd", "qdd1": "end_qdd"}
RENAMED = r"^\w+= of \w+ is now (start|end)_qd?d?=; the old name goes in 0.3$"
NEW |= dict.fromkeys(("start", "starts"), "start_q")


@pytest.mark.parametrize(
    ("call", "arguments", "old", "of"),
    [
        (bik.solve, (PANDA, TARGET), {"start": Q}, lambda made: made.q),
        (bik.solve_all, (PANDA, PANDA.fk(Q)), {"start": Q}, lambda made: made[0].q),
        (bik.solve_batch, (PANDA, [TARGET]), {"starts": Q}, lambda made: made.q),
        (bik.self_motion, (PANDA, PANDA.fk(Q)), {"start": Q}, lambda made: made[0].q),
        (bik.track, (PANDA, LINE), {"start": Q, "dt": 0.1}, lambda made: made.q),
        (bik.Tracker, (PANDA,), {"start": Q, "dt": 0.1}, lambda made: made.q),
        (bik.track_model_free, (PLANT, LINE), {"start": Q, "dt": 0.1}, lambda made: made.q),
        (bik.state_to_state, (), {"q0": Q, "q1": Q + 0.1, "limits": LIMITS}, lambda made: made.q),
        (bik.state_to_state, (Q, Q + 0.1, LIMITS), {"qd0": 0.1 * Q, "qdd1": 0 * Q}, lambda made: made.q),
    ],
)
def test_old_names_of_the_start_warn_and_work(
    call: Callable[..., Any], arguments: tuple[Any, ...], old: dict[str, Any], of: Callable[[Any], Any]
) -> None:
    with pytest.warns(DeprecationWarning, match=RENAMED) as told:
        made = of(call(*arguments, **old))
    expected = [
        f"{name}= of {call.__name__} is now {NEW[name]}=; the old name goes in 0.3" for name in NEW if name in old
    ]
    assert [str(each.message) for each in told] == expected
    assert {each.filename for each in told} == {__file__}
    np.testing.assert_array_equal(
        made, of(call(*arguments, **{NEW.get(name, name): value for name, value in old.items()}))
    )


def test_old_and_new_name_of_the_start_are_too_many() -> None:
    with pytest.raises(bik.CallError, match=r"^solve\(\) got an unexpected keyword argument 'start' \(did you mean "):
        bik.solve(PANDA, TARGET, start=Q, start_q=Q)  # type: ignore[call-arg]


def test_errors_under_an_old_name_use_the_new_one() -> None:
    with (
        pytest.warns(DeprecationWarning, match=RENAMED),
        pytest.raises(bik.InvalidInputError, match=r"^start_q: expected one dim"),
    ):
        bik.solve(PANDA, TARGET, start=[Q])  # type: ignore[call-arg]
    with (
        pytest.warns(DeprecationWarning, match=RENAMED),
        pytest.raises(bik.CallError, match=r"argument 'qend'; its arguments: start_q, end_q"),
    ):
        bik.state_to_state(q0=Q, q1=Q, limits=LIMITS, qend=Q)  # type: ignore[call-arg]


def test_an_unknown_name_is_an_error() -> None:
    with pytest.raises(AttributeError, match=r"^module 'beetle_ik' has no attribute 'Basic'$"):
        _ = bik.Basic  # type: ignore[attr-defined]


def test_completion_offers_what_can_be_called() -> None:
    offered = dir(bik)
    assert {"Limits", "Robot", "Scene", "Tracker", "obstacles", "papers", "pose", "solve", "track"} <= set(offered)
    assert not {"BAS", "PSO", "Solution", "TrackResult", "logging", "planar_posture"} & set(offered)
    assert sorted(set(offered) - set(bik.__all__)) == []
