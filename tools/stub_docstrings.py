"""Copies the docstrings of the compiled module into its stub, so that editors show what `help()` shows.

The stub, `python/beetle_ik/_core.pyi`, is written by hand: names, arguments and types. Its docstrings come from the
Rust sources, by way of the built module. `--check` changes nothing and fails where the stub is out of date.
"""

import argparse
import ast
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

import beetle_ik._core as module

ROOT = Path(__file__).parents[1]
STUB = ROOT / "python" / "beetle_ik" / "_core.pyi"

Definition: TypeAlias = ast.ClassDef | ast.FunctionDef


def definitions(scope: ast.Module | ast.ClassDef, owner: Any) -> Iterator[tuple[Definition, str]]:
    """Yields the classes and functions of the stub with their docstrings in the module.

    Special methods are left out: Python's own documentation describes them.
    """
    for node in scope.body:
        if not isinstance(node, ast.ClassDef | ast.FunctionDef) or node.name.startswith("__"):
            continue
        subject = getattr(owner, node.name, None)
        if subject is None:
            continue  # a type that exists in the stub alone
        yield node, inspect.cleandoc(getattr(subject, "__doc__", None) or "")
        if isinstance(node, ast.ClassDef):
            yield from definitions(node, subject)


def literal(docstring: str, indent: str) -> list[str]:
    """Returns the lines of the docstring as Ruff formats it."""
    opening = ('r"""' if "\\" in docstring else '"""') + " " * docstring.startswith('"')
    first, *others = docstring.splitlines()
    lines = [f"{indent}{opening}{first}", *(f"{indent}{line}".rstrip() for line in others)]
    if others:
        return [*lines, f'{indent}"""']
    return [lines[0] + " " * docstring.endswith('"') + '"""']


def holds(statement: ast.stmt, kind: type) -> bool:
    """Whether a statement is a constant of that kind by itself: a docstring, or `...`."""
    return isinstance(statement, ast.Expr) and isinstance(getattr(statement.value, "value", None), kind)


def document(lines: list[str], node: Definition, docstring: str) -> None:
    """Writes the docstring of one definition into the lines of the stub."""
    first = node.body[0]
    indent = " " * (node.col_offset + 4)
    text = literal(docstring, indent) if docstring else []
    if holds(first, str):
        only = [] if docstring or len(node.body) > 1 else [f"{indent}..."]
        lines[first.lineno - 1 : first.end_lineno] = text or only
    elif docstring and holds(first, type(...)):
        line = lines[first.lineno - 1]
        header = line[: first.col_offset].rstrip() + line[first.col_offset + len("...") :]
        lines[first.lineno - 1 : first.lineno] = [header, *text]
    elif docstring:
        start = min([first, *getattr(first, "decorator_list", [])], key=lambda part: part.lineno).lineno - 1
        lines[start:start] = [*text, ""]


def with_docstrings(stub: str) -> str:
    """Returns the text of the stub with the docstrings of the module."""
    lines = stub.splitlines()
    found = sorted(definitions(ast.parse(stub), module), key=lambda pair: pair[0].lineno)
    # Works from the end: an insertion moves the lines below it.
    for node, docstring in reversed(found):
        document(lines, node, docstring)
    return "\n".join(lines) + "\n"


def main() -> int:
    """Updates the stub, or checks it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--check", action="store_true", help="change nothing; fail where the stub is out of date")
    only_check = parser.parse_args().check
    stub = STUB.read_text(encoding="utf-8")
    updated = with_docstrings(stub)
    if updated == stub:
        return 0
    if only_check:
        here = Path(__file__).relative_to(ROOT)
        print(
            f"{STUB.relative_to(ROOT)}: the docstrings are not those of the built module. Run: python {here}",
            file=sys.stderr,
        )
        return 1
    STUB.write_text(updated, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
