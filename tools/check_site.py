"""Checks the built site in a browser: `python tools/check_site.py docs/build/html`.

A block of code or output is clipped if part of it is only seen after scrolling. On a phone, nothing may be wider than
the page, except a table that scrolls by itself. Searches have to find their page. `--pictures DIR` also takes pictures
of some pages: wide, narrow and dark. Needs playwright and Chromium.
"""

import argparse
import functools
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from viewer_pictures import visits

LAPTOP, PHONE = (1366, 768), (390, 844)  # pixels
PICTURED = ("index", "gallery/index", "first_ten_minutes", "planning", "scenes", "api/solving")
NOT_OURS = ("genindex", "py-modindex", "search")  # pages that Sphinx writes

# Search terms, each with a page that must be among the first results.
SEARCHES = {
    "pick and place": "pick_and_place.html",
    "quaternion": "solving.html",
    "degrees": "solving.html",
    "conveyor": "tracking.html",
    "gripper": "pick_and_place.html",
    "mobile base": "mobile_bases.html",
    "ROS 2": "ros2.html",
    "URDF": "gallery/02_your_urdf.html",
}
_FIRST = 3  # results

# First line of each clipped block.
_CLIPPED = """() => [...document.querySelectorAll("article pre")]
    .filter(block => [block, block.parentElement].some(box => box.scrollWidth > box.clientWidth + 1))
    .map(block => block.innerText.trim().split("\\n")[0].slice(0, 80))"""

# Blocks that reach beyond the right edge of the page, and scroll neither by themselves nor within their parent.
_TOO_WIDE = """() => {
    const wide = [...document.querySelectorAll("article pre, article img, article svg, article iframe, " +
        "article table, article .math, article dt, article p")].filter(block => {
        for (let box = block; box.tagName !== "ARTICLE"; box = box.parentElement)
            if (["auto", "scroll"].includes(getComputedStyle(box).overflowX)) return false;
        return block.getBoundingClientRect().right > window.innerWidth + 1;
    }).map(block => block.tagName + ": " + (block.innerText || block.src || "").trim().slice(0, 80));
    if (document.documentElement.scrollWidth > window.innerWidth + 1) wide.push("the page scrolls sideways");
    return wide;
}"""


@contextmanager
def served(site: Path) -> Iterator[str]:
    """Yields the address at which a folder is served to this machine."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            """Keeps silent."""

    with ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(site))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def pages(site: Path) -> list[str]:
    """Returns the names of the pages of the site, without those that Sphinx writes."""
    names = (file.relative_to(site).with_suffix("").as_posix() for file in sorted(site.rglob("*.html")))
    return [name for name in names if name not in NOT_OURS and not name.startswith(("_", "recordings/"))]


def misfits(browser: Any, address: str, names: list[str]) -> dict[str, list[str]]:
    """Returns the blocks that are clipped or too wide, by page and width of the window."""
    found: dict[str, list[str]] = {}
    laptop = browser.new_page(viewport={"width": LAPTOP[0], "height": LAPTOP[1]})
    phone = browser.new_page(viewport={"width": PHONE[0], "height": PHONE[1]})
    for page in (laptop, phone):
        page.route("**/recordings/player.html*", lambda route: route.abort())  # drawing takes long
    for name in names:
        for page in (laptop, phone):
            page.goto(f"{address}/{name}.html", wait_until="domcontentloaded")
            page.wait_for_function("document.readyState === 'complete'")
        found[f"{name} at {LAPTOP[0]} px"] = laptop.evaluate(_CLIPPED)
        found[f"{name} at {PHONE[0]} px"] = phone.evaluate(_CLIPPED) + phone.evaluate(_TOO_WIDE)
    return {where: blocks for where, blocks in found.items() if blocks}


def lost(browser: Any, address: str) -> list[str]:
    """Returns the searches that do not find their page among the first."""
    page, missed = browser.new_page(), []
    for words, wanted in SEARCHES.items():
        page.goto(f"{address}/search.html?q={words.replace(' ', '+')}")
        page.wait_for_selector("ul.search li a")
        page.wait_for_timeout(500)  # waits for all results
        links = "[...document.querySelectorAll('ul.search li > a')].map(link => link.getAttribute('href'))"
        found = [link.split("#")[0] for link in page.evaluate(links)]
        if wanted not in found[:_FIRST]:
            missed.append(f"{words}: {found[:_FIRST]}")
    return missed


def take_pictures(browser: Any, address: str, folder: Path, names: tuple[str, ...]) -> None:
    """Takes pictures of pages on a laptop, on a phone and in dark mode."""
    folder.mkdir(parents=True, exist_ok=True)
    for (width, height), scheme in ((LAPTOP, "light"), (PHONE, "light"), (LAPTOP, "dark")):
        page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
        for name in names:
            page.goto(f"{address}/{name}.html")
            page.wait_for_timeout(500)
            file = folder / f"{name.replace('/', '_')}_{width}_{scheme}.png"
            page.screenshot(path=file, full_page=True)


def main() -> int:
    """Prints misfits and failed searches, and returns 1 if there are any."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("site", type=Path)
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="take pictures of some pages too")
    parser.add_argument("--page", action="append", metavar="NAME", help="of these pages alone")
    options = parser.parse_args()
    names = options.page or pages(options.site)
    with served(options.site) as address, visits() as browser:
        found = misfits(browser, address, names)
        missed = [] if options.page else lost(browser, address)
        if options.pictures:
            take_pictures(browser, address, options.pictures, tuple(options.page or PICTURED))
    for where, blocks in found.items():
        print(f"{where}: {len(blocks)}", *blocks, sep="\n    ")
    for width, _ in (LAPTOP, PHONE):
        count = sum(len(blocks) for where, blocks in found.items() if where.endswith(f"{width} px"))
        print(f"{count} blocks on {len(names)} pages do not fit at {width} px")
    if missed:
        print("searches that do not find their page:", *missed, sep="\n    ")
    return int(bool(found or missed))


if __name__ == "__main__":
    sys.exit(main())
