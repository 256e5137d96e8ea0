"""The Python of README and site, and the examples in docstrings, run as they stand."""

import doctest
import inspect
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from test_every_call import CALLS, MADE_BY_THE_LIBRARY

import beetle_ik as bik
from beetle_ik import distributed

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
PAGES = sorted(page for page in (ROOT / "docs").rglob("*.md") if "```python\n" in page.read_text(encoding="utf-8"))
FENCED = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
SHOWN = re.compile(r"^```py\n(.*?)^```", re.MULTILINE | re.DOTALL)  # not run: of libraries that may not be installed
# An indented block that begins with the import every example begins with.
INDENTED = re.compile(r"^( +)import beetle_ik as bik\n(?:\1.*\n|\s*\n)*", re.MULTILINE)


def blocks_of_readme() -> list[str]:
    return FENCED.findall(README.read_text(encoding="utf-8"))


def documented() -> Iterator[tuple[str, str]]:
    """Names and docstrings of everything public."""
    yield "beetle_ik", inspect.getdoc(bik) or ""
    for space in (
        bik,
        distributed,
        bik.goals,
        bik.interop,
        bik.obstacles,
        bik.papers,
        bik.paths,
        bik.plot,
        bik.tasks,
        bik.vision,
    ):
        for name in space.__all__:
            thing = getattr(space, name)
            yield name, getattr(thing, "__doc__", None) or ""
            if inspect.isclass(thing):
                members = [(key, value) for key, value in vars(thing).items() if not key.startswith("_")]
                yield from ((f"{name}.{key}", getattr(value, "__doc__", None) or "") for key, value in members)


def run(program: str, folder: Path) -> None:
    command = [sys.executable, "-W", "error", "-c", program]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, env=os.environ | {"MPLBACKEND": "Agg"}, check=False
    )
    assert done.returncode == 0, done.stderr


def test_the_readme_runs_from_top_to_bottom(tmp_path: Path) -> None:
    run("\n".join(blocks_of_readme()), tmp_path)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_pages_of_the_site_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    program = "\n".join(FENCED.findall(page.read_text(encoding="utf-8")))
    exec(compile(program, page.name, "exec"), {"__name__": "__main__"})


def test_the_reference_has_everything_public() -> None:
    listed = "\n".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs" / "api").glob("*.md"))
    names = [*(set(bik.__all__) - {"papers"}), *(f"papers.{name}" for name in bik.papers.__all__)]
    missing = [name for name in names if not name.startswith("_") and f":: beetle_ik.{name}\n" not in listed]
    assert not missing


@pytest.mark.parametrize("page", [README, *sorted((ROOT / "docs").rglob("*.md"))], ids=lambda page: page.stem)
def test_every_fence_says_what_it_holds(page: Path) -> None:
    opened = re.findall(r"^```(\S*).*?\n.*?^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert "" not in opened


def examples() -> list[object]:
    return [
        pytest.param(inspect.cleandoc(match[0]), id=name)
        for name, text in documented()
        for match in INDENTED.finditer(text)
    ]


@pytest.mark.parametrize("example", examples())
def test_examples_in_docstrings_run(example: str, tmp_path: Path) -> None:
    run(example, tmp_path)


REFERENCE = sorted((ROOT / "docs" / "api").glob("*.md"))
PROMPTS = re.compile(r"^```pycon\n(.*?)^```", re.MULTILINE | re.DOTALL)
# Calls whose entry in the reference is followed by a session.
MAIN_CALLS = [
    "Limits",
    "Path",
    "Robot",
    "Scene",
    "StraightLine",
    "Tracker",
    "Trajectory",
    "best_base",
    "minimize",
    "plan_along_path",
    "plan_batch",
    "plan_point_to_point",
    "pose",
    "reachability",
    "self_motion",
    "solve",
    "solve_all",
    "solve_batch",
    "state_to_state",
    "time_optimal",
    "track",
    "track_model_free",
]


@pytest.mark.parametrize("page", REFERENCE, ids=lambda page: page.stem)
def test_sessions_of_the_reference_give_what_they_show(page: Path) -> None:
    session = "\n".join(PROMPTS.findall(page.read_text(encoding="utf-8")))
    runner = doctest.DocTestRunner()
    runner.run(doctest.DocTestParser().get_doctest(session, {}, page.stem, None, 0))
    assert runner.summarize(verbose=False).failed == 0


@pytest.mark.parametrize("name", MAIN_CALLS)
def test_each_main_call_has_a_session(name: str) -> None:
    pages = "\n".join(page.read_text(encoding="utf-8") for page in REFERENCE)
    assert re.search(rf":: beetle_ik\.{name}\n```\n\n```pycon\n", pages)


def test_the_package_has_an_example() -> None:
    assert INDENTED.search(bik.__doc__ or "")


def test_every_public_call_has_an_example() -> None:
    pages = [page.read_text(encoding="utf-8") for page in [README, *(ROOT / "docs").rglob("*.md")]]
    programs = [block for page in pages for pattern in (FENCED, SHOWN) for block in pattern.findall(page)]
    programs += [file.read_text(encoding="utf-8") for file in (ROOT / "examples").glob("*.py")]
    programs += [match[0] for _, text in documented() for match in INDENTED.finditer(text)]
    called = set(re.findall(r"\.([A-Za-z_]\w*)", "\n".join(programs)))
    errors = {name for name in bik.__all__ if name.endswith("Error")}
    missing = [name for name in {*CALLS, *errors} - set(MADE_BY_THE_LIBRARY) if name.rpartition(".")[2] not in called]
    assert not sorted(missing)


def test_prompts_in_docstrings_give_what_they_show() -> None:
    runner = doctest.DocTestRunner()
    for name, text in documented():
        runner.run(doctest.DocTestParser().get_doctest(text, {"bik": bik}, name, None, 0))
    assert runner.summarize(verbose=False).failed == 0


@pytest.mark.parametrize("page", ["doors", "derivatives", "ros2_without_ros"])
def test_each_door_opens_in_twenty_lines(page: str) -> None:
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    for block in FENCED.findall(text) + SHOWN.findall(text):
        lines = [line for line in block.splitlines() if line.strip()]
        is_robot_file = lines[-1] in (")", "]") or "from_urdf" in block
        assert len(lines) <= 20 or is_robot_file, block
