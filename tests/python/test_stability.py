"""The stable interface of docs/stability.md is unchanged."""

import importlib.util
from pathlib import Path
from types import ModuleType

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


def test_an_unknown_name_is_an_error() -> None:
    with pytest.raises(AttributeError, match=r"^module 'beetle_ik' has no attribute 'Basic'$"):
        _ = bik.Basic  # type: ignore[attr-defined]


def test_completion_offers_what_can_be_called() -> None:
    offered = dir(bik)
    assert {"Limits", "Robot", "Scene", "Tracker", "obstacles", "papers", "pose", "solve", "track"} <= set(offered)
    assert not {"BAS", "PSO", "Solution", "TrackResult", "logging", "planar_posture"} & set(offered)
    assert sorted(set(offered) - set(bik.__all__)) == []
