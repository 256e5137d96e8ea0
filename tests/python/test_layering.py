"""Imports between modules, the modules that `import beetle_ik` loads; no test has a clock or draws without a seed."""

import ast
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "python" / "beetle_ik"
FILES = sorted(PACKAGE.rglob("*.py"))
TESTS = sorted(Path(__file__).parent.glob("*.py"))
ATTACKS = sorted(Path(__file__).parents[1].joinpath("campaign", "attacks").rglob("*.py"))
CLOCKS = {"datetime", "time", "timeit"}
UNSEEDED = {"random", "secrets", "uuid"}

# From the lowest up; `__init__` stands for the public names of the package.
LAYERS = (
    *("_core", "filters", "goals", "moves", "obstacles", "papers", "tasks"),
    *("calls", "installed", "files", "paths", "figures", "robot_files", "scenes", "chunked", "mapping"),
    *("distributed", "interop", "plot", "sim", "viewing", "vision"),
    *("__init__", "report", "experiments", "cli", "__main__"),
)


def layer(file: Path) -> str:
    return file.relative_to(PACKAGE).parts[0].removesuffix(".py")


def libraries(nodes: Iterable[ast.AST]) -> set[str]:
    """Packages of others that are imported."""
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    names += [node.module or "" for node in nodes if isinstance(node, ast.ImportFrom) and not node.level]
    return {name.split(".")[0] for name in names}


def layers_imported(file: Path) -> set[str]:
    """Layers that a file imports anywhere."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = file.relative_to(PACKAGE).parts[: -node.level]
            ways = [[node.module]] if node.module else [[alias.name] for alias in node.names]
            found |= {(*folder, *way)[0].split(".")[0] for way in ways}
    return {name if name in LAYERS else "__init__" for name in found}


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(PACKAGE)))
def test_optional_libraries_are_imported_inside_functions(file: Path) -> None:
    kept_out = {"dask", "distributed", "jinja2", "matplotlib", "rich", "viser", "zarr"}
    if layer(file) != "cli":
        kept_out.add("typer")
    assert not libraries(ast.parse(file.read_text(encoding="utf-8")).body) & kept_out


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(PACKAGE)))
def test_a_file_imports_its_own_and_lower_layers(file: Path) -> None:
    own = LAYERS.index(layer(file))
    assert not {name for name in layers_imported(file) if LAYERS.index(name) > own}


def test_import_loads_no_other_package() -> None:
    program = "import sys, beetle_ik; print(*{name.split('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout.split()
    assert "beetle_ik" in loaded
    assert not {"numpy", "typer", "rich", "matplotlib", "jinja2", "viser", "dask", "distributed", "zarr"} & set(loaded)


@pytest.mark.parametrize("file", TESTS, ids=lambda file: file.stem)
def test_no_test_reads_a_clock_or_sleeps(file: Path) -> None:
    nodes = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
    assert not libraries(nodes) & CLOCKS
    called = {node.func.attr for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)}
    assert not called & {"wait_for_timeout"}


@pytest.mark.parametrize("file", [*TESTS, *ATTACKS], ids=lambda file: file.stem)
def test_drawn_cases_come_from_a_seed(file: Path) -> None:
    nodes = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
    assert not libraries(nodes) & UNSEEDED
    calls = [node for node in nodes if isinstance(node, ast.Call) and not node.args]
    assert not [call.lineno for call in calls if ast.unparse(call.func).endswith("default_rng")]


def test_make_runs_each_file_of_tests_once() -> None:
    recipe = (Path(__file__).parents[2] / "Makefile").read_text(encoding="utf-8")
    before, _, after = recipe.partition("PARTS := ")
    assert "$(PARTS)" not in before  # which make would take as nothing
    parts = after.splitlines()[0].split()
    letters = [file.stem[5] for file in TESTS if file.stem.startswith("test_")]
    assert {sum(part[0] <= letter <= part[-1] for part in parts) for letter in letters} == {1}
