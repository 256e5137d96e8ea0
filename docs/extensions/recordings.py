"""Recordings of the viewer on pages: `{recording} NAME`, with a caption. A picture stands where scripts are off."""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import recorded_scenes
from docutils import nodes
from docutils.parsers.rst import directives
from PIL import Image
from sphinx.util.docutils import SphinxDirective

import beetle_ik
from beetle_ik.viewing import write_player

if TYPE_CHECKING:
    from sphinx.application import Sphinx

DOCS = Path(__file__).parents[1]
RECORDINGS = DOCS / "static" / "recordings"
PICTURES = DOCS / "static" / "pictures"
_GENERATED = ".. GENERATED FROM PYTHON SOURCE LINES"
_FRAME = """<a class="recording" href="{static}/recordings/player.html?playbackPath={name}.viser">
<img class="picture" src="{static}/pictures/{name}.webp" alt="{says}" width="640" height="432" loading="lazy"></a>"""


class Recording(SphinxDirective):
    """Shows a recording, which scripts load where it comes into view (static/recordings.js)."""

    required_arguments = 1
    has_content = True
    option_spec: ClassVar[Any] = {"alt": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        """Returns a figure."""
        name = self.arguments[0]
        if name not in recorded_scenes.NAMES:
            raise self.error(f"no recording is named {name}: docs/extensions/recorded_scenes.py has them")
        static = "../" * self.env.docname.count("/") + "_static"
        says = html.escape(self.options.get("alt", "A recording of the viewer"))
        figure = nodes.container(classes=["recording-figure"])
        figure += nodes.raw("", _FRAME.format(static=static, name=name, says=says), format="html")
        if self.content:
            figure += self.parse_content_to_nodes()
        return [figure]


def write_all(_app: Sphinx) -> None:
    """Writes the player, and recordings that are missing or older than the package and their examples."""
    RECORDINGS.mkdir(parents=True, exist_ok=True)
    package = Path(beetle_ik.__file__).parent
    sources = [*package.rglob("*.py"), *package.glob("_core.*"), *recorded_scenes.EXAMPLES.glob("*.py")]
    changed = max(file.stat().st_mtime for file in [*sources, Path(recorded_scenes.__file__)])
    for name in recorded_scenes.NAMES:
        file = RECORDINGS / f"{name}.viser"
        if not file.is_file() or file.stat().st_mtime < changed:
            recorded_scenes.write(name, file)
    write_player(RECORDINGS / "player.html")


def use_pictures(app: Sphinx) -> None:
    """Puts pictures of recordings into the gallery, which has drawn its figures by now."""
    thumbnails = DOCS / "gallery" / "images" / "thumb"
    names = [file.stem for file in sorted(PICTURES.glob("*.webp")) if (DOCS / "gallery" / f"{file.stem}.rst").is_file()]
    for name in names:
        Image.open(PICTURES / f"{name}.webp").save(thumbnails / f"sphx_glr_{name}_thumb.png")
    shown = ",\n".join(f'.sphx-glr-thumbcontainer img[src*="sphx_glr_{name}_thumb"]' for name in names)
    (RECORDINGS / "pictures.css").write_text(shown + " { filter: none; border-radius: 0.25rem; }\n", encoding="utf-8")
    app.add_css_file("recordings/pictures.css")


def embed(_app: Sphinx, name: str, source: list[str]) -> None:
    """Begins the page of an example with its recording."""
    example = name.removeprefix("gallery/")
    if example != name and example in recorded_scenes.NAMES:
        intro, mark, code = source[0].partition("\n" + _GENERATED)
        shown = f"\n.. recording:: {example}\n   :alt: The motion or posture of this example in the viewer\n"
        source[0] = intro + shown + mark + code


def setup(app: Sphinx) -> dict[str, bool]:
    """Registers the Sphinx extension."""
    app.add_directive("recording", Recording)
    app.connect("builder-inited", write_all, priority=400)
    app.connect("builder-inited", use_pictures, priority=900)
    app.connect("source-read", embed)
    app.add_js_file("recordings.js", loading_method="defer")
    return {"parallel_read_safe": True}
