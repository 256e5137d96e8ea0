"""A scene and its motion in one file, which any browser plays without a server."""

from __future__ import annotations

import base64
import html
import math
from collections.abc import Callable, Iterable
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._core import InvalidInputError
from ..files.whole import path_of, whole_file
from ..installed.needs import library
from .camera import FIELD

if TYPE_CHECKING:
    import os

    import viser

    from .parts import Parts

_LONGEST = 600.0  # s: a longer recording is taken for one without an end
_MOST = 100_000  # frames

# Restricts connections: the client would fetch a recording from any site, and a recording can carry code.
_HEAD = """
<!-- Contains the client of viser, https://viser.studio, Apache License 2.0. -->
<meta http-equiv="Content-Security-Policy" content="connect-src 'self' data: blob:">
<script>
"use strict";
{
  const query = new URLSearchParams(location.search);
  const upright = innerHeight / innerWidth;
  if (upright > 1 && !query.has("initialCameraFov")) {  // what fits into a square fits into the width
    query.set("initialCameraFov", 2 * Math.atan(Math.tan({field} / 2) * upright));
    try { history.replaceState(null, "", "?" + query); } catch { /* a page inside of another has no address */ }
  }
}
</script>
"""
_EMBEDDED = """<script>
window.__VISER_EMBED_DATA__ = "{recorded}";
window.__VISER_EMBED_CONFIG__ = {darkMode: matchMedia("(prefers-color-scheme: dark)").matches};
</script>
"""


def recording_file(file: str | os.PathLike[str]) -> Path:
    """Returns the argument `file` as a path whose suffix gives the form of the recording.

    Raises:
        InvalidInputError: the name ends neither in ".html" nor in ".viser".
    """
    path = path_of(file)
    if path.suffix not in (".html", ".viser"):
        raise InvalidInputError(
            f"file must end in .html (a page of its own) or .viser (played by another page), got '{path!s:.200}'"
        )
    return path


def write_recording(path: Path, name: str, recorded: bytes) -> None:
    """Writes a recording in the form given by the suffix of `path`; a page has the title `name`."""
    content = recorded if path.suffix == ".viser" else _page(name, recorded).encode()
    with whole_file(path) as stream:
        stream.write(content)


def write_player(file: str | os.PathLike[str]) -> None:
    """Writes a page that plays the `.viser` recordings of its own site: `player.html?playbackPath=motion.viser`.

    Many recordings can share it. `&darkMode` makes it dark. A web server must deliver it: browsers do not let a page
    read files beside it. Needs the extra "view".

    Args:
        file: the page, ending in `.html`.

    Raises:
        BeetleIkError: viser is not installed.
        InvalidInputError: another ending.
    """
    path = path_of(file)
    if path.suffix != ".html":
        raise InvalidInputError(f"file must end in .html, got '{path!s:.200}'")
    with whole_file(path) as stream:
        stream.write(_page("Recording").encode())


def take(server: viser.ViserServer, parts: Parts, frames: Iterable[float], passed: Callable[[float], None]) -> bytes:
    """Returns a recording of the page while `frames` change it; each yields its duration in seconds.

    `passed` moves the arm on by this duration. Visitors see only the end.
    """
    with server.atomic(), parts.posed():
        parts.refresh()
        serializer = server.get_scene_serializer()
        try:
            _run(serializer, parts, frames, passed)
        finally:  # otherwise recording would never stop
            recorded = serializer.serialize()
    return recorded


def _run(serializer: Any, parts: Parts, frames: Iterable[float], passed: Callable[[float], None]) -> None:
    total = 0.0
    for i, seconds in enumerate(frames):
        if isinstance(seconds, bool) or not isinstance(seconds, Real) or not 0.0 <= seconds < math.inf:
            raise InvalidInputError(f"frames must yield seconds, at least 0, got {seconds!r:.60} as number {i}")
        total += float(seconds)
        if total > _LONGEST or i == _MOST:
            raise InvalidInputError(
                f"frames last longer than {_LONGEST:g} s, or are more than {_MOST}: is there no end to them?"
            )
        parts.refresh()
        serializer.insert_sleep(float(seconds))
        passed(float(seconds))


def _page(title: str, recorded: bytes | None = None) -> str:
    """Returns viser's client as one page: with the recording inside, or as a player of the recording in its address."""
    viser = library("viser", "viser", "the viewer", extra="view")
    client = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")
    start, head, rest = client.partition("<head>")
    added = _HEAD.replace("{field}", str(FIELD))
    if recorded is not None:
        added += _EMBEDDED.replace("{recorded}", base64.b64encode(recorded).decode())
    rest = rest.replace("<title>Viser</title>", f"<title>{html.escape(title)}</title>", 1)
    return start + head + added + rest
