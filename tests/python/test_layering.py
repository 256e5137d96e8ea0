"""Imports between modules, and the modules that `import beetle_ik` loads."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "python" / "beetle_ik"
FILES = sorted(PACKAGE.rglob("*.py"))


def names_imported(nodes: list[ast.AST]) -> set[str]:
    """Dotted names; relative ones start with a dot."""
    names = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add("." * node.level + (node.module or ""))
            names |= {"." * node.level + alias.name for alias in node.names if node.level and not node.module}
    return names


def belongs_to_command_line(file: Path) -> bool:
    return file.relative_to(PACKAGE).parts[0] == "cli"


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(PACKAGE)))
def test_optional_libraries_are_imported_inside_functions(file: Path) -> None:
    top_level = names_imported(list(ast.parse(file.read_text()).body))
    kept_out = {"dask", "distributed", "jinja2", "matplotlib", "rich", "viser", "zarr"} | (
        set() if belongs_to_command_line(file) else {"typer"}
    )
    assert not {name.split(".")[0] for name in top_level} & kept_out


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(PACKAGE)))
def test_only_the_command_line_imports_the_command_line(file: Path) -> None:
    everywhere = names_imported(list(ast.walk(ast.parse(file.read_text()))))
    if not belongs_to_command_line(file) and file.name != "__main__.py":
        assert not {name for name in everywhere if name.lstrip(".").split(".")[0] == "cli" or ".cli" in name}


def test_import_loads_no_other_package() -> None:
    program = "import sys, beetle_ik; print(*{name.split('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout.split()
    assert "beetle_ik" in loaded
    assert not {"numpy", "typer", "rich", "matplotlib", "jinja2", "viser", "dask", "distributed", "zarr"} & set(loaded)
