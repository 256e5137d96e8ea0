"""Writes LICENSES-THIRD-PARTY.txt: the licences of the crates that are built into the wheel.

Run it after a change of Cargo.lock; `--check` only says whether the file is up to date.
"""

import json
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
KEPT = ROOT / "LICENSES-THIRD-PARTY.txt"
_BINDING = "ikpy-bind"
_TEXTS = re.compile(r"(licen[sc]e|copying|notice|unlicense)", re.IGNORECASE)
_OWN = "Its package has no text of its licence; that of Apache-2.0 is in LICENSE-APACHE."
_NONE = "Its package has no text of its licence."
_HEAD = """Licences of the crates that are built into the compiled module of beetle-ik, beside its own.
Written by tools/third_party.py.
"""


def built_in() -> list[dict[str, Any]]:
    """Returns the third-party crates that the binding links, by name, without those used only at build time."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found: set[str] = set()
    waiting = [key for key, package in packages.items() if package["name"] == _BINDING]
    while waiting:
        key = waiting.pop()
        if key in found or _is_macro(packages[key]):
            continue
        found.add(key)
        linked = (other for other in nodes[key]["deps"] if any(kind["kind"] is None for kind in other["dep_kinds"]))
        waiting += [other["pkg"] for other in linked]
    ours = set(metadata["workspace_members"])
    return sorted((packages[key] for key in found - ours), key=lambda package: (package["name"], package["version"]))


def _is_macro(package: dict[str, Any]) -> bool:
    return any("proc-macro" in target["kind"] for target in package["targets"])


def texts(package: dict[str, Any]) -> Iterator[str]:
    """Yields the licence texts of a crate: the MIT text alone if the crate offers a choice."""
    folder = Path(package["manifest_path"]).parent
    files = sorted(file for file in folder.iterdir() if file.is_file() and _TEXTS.match(file.name))
    mit = [file for file in files if "mit" in file.name.lower()]
    for file in mit if mit and "OR" in str(package["license"]).split() else files:
        yield "\n".join(line.rstrip() for line in file.read_text(encoding="utf-8").strip().splitlines())


def written() -> str:
    """Returns the content of the file: each text once, after its crates."""
    crates: dict[str, list[str]] = defaultdict(list)
    for package in built_in():
        origin = f", {package['repository']}" if package["repository"] else ""
        title = f"{package['name']} {package['version']} ({package['license']}){origin}"
        for text in list(texts(package)) or [_OWN if "Apache-2.0" in package["license"] else _NONE]:
            crates[text].append(title)
    parts = ("\n".join([*titles, "", text]) for text, titles in crates.items())
    rule = f"\n{'-' * 80}\n"
    return _HEAD + "".join(f"{rule}{part}\n" for part in parts)


if __name__ == "__main__":
    if "--check" in sys.argv:
        if not KEPT.is_file() or KEPT.read_text(encoding="utf-8") != written():
            sys.exit(f"{KEPT.name} is out of date: run tools/third_party.py")
    else:
        KEPT.write_text(written(), encoding="utf-8")
