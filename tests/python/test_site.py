"""The site: explained messages exist in the library, recordings play, pictures and versions are present."""

import functools
import re
import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_viewer_record import plays

import beetle_ik as bik
from beetle_ik.viewing import write_player

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
sys.path += [str(ROOT / "tools"), str(DOCS / "extensions")]

import recorded_scenes  # noqa: E402
from check_site import served  # noqa: E402
from viewer_pictures import chromium, visits  # noqa: E402

PAGES = {page: page.read_text(encoding="utf-8") for page in sorted(DOCS.rglob("*.md"))}
EXPLAINED = re.findall(r"^`([^`]+)`.*\n: ", PAGES[DOCS / "troubleshooting.md"], re.MULTILINE)
SHOWN = ("circle", "past_a_shelf", "dodge", "21_tray_in_two_hands", "23_reachability_map")


PANDA = bik.Robot.named("panda")
BALL = bik.obstacles.Sphere((0.5, 0.1, 0.5), 0.05)
# Messages that are put together from parts.
PRODUCED: dict[str, Callable[[], Any]] = {
    "expected 7 joints (panda_joint1 to panda_joint7), got 9": lambda: PANDA.fk(np.zeros(9)),
    "inside obstacle": lambda: bik.solve(PANDA.with_capsules(radius=0.06), BALL.center, obstacles=[BALL]),
    "all waypoints are the same": lambda: bik.time_optimal([[0], [0]], bik.Limits(acceleration=1)),
}


def said(call: Callable[[], Any]) -> str:
    """The message of a result or of an error."""
    try:
        return str(call().message)
    except bik.BeetleIkError as error:
        return str(error)


@functools.cache
def sources() -> str:
    """The texts of the library in one line."""
    files = [*(ROOT / "crates").rglob("*.rs"), *(ROOT / "python").rglob("*.py")]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    return re.sub(r"\s+", " ", re.sub(r"\\\n\s*", "", text))


@pytest.mark.parametrize("message", EXPLAINED)
def test_a_message_that_is_explained_is_one_of_ours(message: str) -> None:
    assert message in (said(PRODUCED[message]) if message in PRODUCED else sources())


def test_messages_are_explained() -> None:
    assert len(EXPLAINED) >= 18


def test_a_message_that_is_not_ours_is_noticed() -> None:
    assert "the robot is tired" not in sources()


def test_the_citation_names_the_version() -> None:
    version = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"version = {{{version}}}," in PAGES[DOCS / "cite.md"]


def test_every_recording_that_a_page_shows_has_a_picture() -> None:
    wanted = {name for text in PAGES.values() for name in re.findall(r"^```\{recording\} (\S+)$", text, re.MULTILINE)}
    assert wanted - set(recorded_scenes.NAMES) == set()
    missing = [name for name in recorded_scenes.NAMES if not (DOCS / "static" / "pictures" / f"{name}.webp").is_file()]
    assert not missing


def test_recordings_of_examples_name_examples() -> None:
    examples = {file.stem for file in recorded_scenes.EXAMPLES.glob("*.py")}
    assert set(recorded_scenes.OF_EXAMPLES) - examples == set()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    pytest.importorskip("playwright", reason="playwright, which drives the browser, is not installed")
    if chromium() is None:
        pytest.skip("no chromium or chrome on this machine")
    with visits() as browser:
        yield browser


@pytest.mark.parametrize("name", SHOWN)
def test_a_recording_of_the_site_plays(browser: Any, name: str, tmp_path: Path) -> None:
    recorded_scenes.write(name, tmp_path / f"{name}.viser")
    write_player(tmp_path / "player.html")
    with served(tmp_path) as site:
        plays(browser, f"{site}/player.html?playbackPath={name}.viser")
