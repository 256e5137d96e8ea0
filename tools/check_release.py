"""Checks that a tag can be released: `python tools/check_release.py v0.2.0`. CI runs it before it publishes."""

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def problems(tag: str) -> list[str]:
    """Returns everything that prevents the release, as sentences."""
    found = []
    version = tomllib.loads(_text("Cargo.toml"))["workspace"]["package"]["version"]
    if tag != f"v{version}":
        found.append(f"The tag is {tag}, but Cargo.toml has version {version}: the tag must be v{version}.")
    if not re.search(rf"^## {re.escape(version)} \(\d{{4}}-\d\d-\d\d\)$", _text("CHANGELOG.md"), re.MULTILINE):
        found.append(f'CHANGELOG.md has no dated section: write "## {version} (YYYY-MM-DD)".')
    for name, address in tomllib.loads(_text("pyproject.toml"))["project"]["urls"].items():
        if "FILL-IN" in address:
            found.append(f"The address {name} in pyproject.toml is still to be filled in: {address}.")
    if links := re.findall(r"\]\((?!https?:|#)([^)#]+)", _text("README.md")):
        found.append(
            f"README.md has {len(links)} links into the repository, which PyPI does not follow: write them with its "
            f"address, such as {links[0]}."
        )
    return found


def _text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/check_release.py TAG")
    if found := problems(sys.argv[1]):
        sys.exit("\n".join(found))
    print(f"{sys.argv[1]} can be released")
