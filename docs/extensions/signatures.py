"""Shows types in the signatures of the native module, from its stub."""

import ast
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes

import beetle_ik

_STUB = Path(beetle_ik.__file__).with_name("_core.pyi")
_ALIAS = re.compile(r"\b_(?=[A-Z])")  # the stub's own names: _Pose, _Targets
_SHORT = {
    "_Array": "ndarray",
    "NDArray[np.float64]": "ndarray",
    "NDArray[np.bool_]": "ndarray",
    "_Pose": "PoseLike",
    "np.": "",
}

_Function = ast.FunctionDef | ast.AsyncFunctionDef


def _found() -> dict[str, _Function]:
    """Returns functions, methods and constructors of the stub by qualified name."""
    found: dict[str, _Function] = {}
    for node in ast.parse(_STUB.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = node
        elif isinstance(node, ast.ClassDef):
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    made = member.name in ("__new__", "__init__")
                    found[node.name if made else f"{node.name}.{member.name}"] = member
    return found


_FUNCTIONS = _found()


def shown(annotation: ast.expr | None) -> str:
    """Returns a type as the pages name it."""
    text = ast.unparse(annotation) if annotation else ""
    for long, short in _SHORT.items():
        text = text.replace(long, short)
    return _ALIAS.sub("", text)


def _in_stub(name: str) -> _Function | None:
    """Returns the function of a documented name: `beetle_ik.tasks.Pose`, `beetle_ik.Robot.fk`."""
    parts = name.split(".")
    return next(
        (_FUNCTIONS[key] for n in (2, 1) if (key := ".".join(parts[-n:])) in _FUNCTIONS),
        None,
    )


def typed(function: _Function) -> tuple[str, str | None]:
    """Returns the arguments with their types, and the type of the result."""
    arguments = ast.parse(ast.unparse(function)).body[0].args  # a copy
    for kind in (arguments.posonlyargs, arguments.args):
        if kind and kind[0].arg in ("self", "cls"):
            del kind[0]
    for argument in (
        *arguments.posonlyargs,
        *arguments.args,
        *arguments.kwonlyargs,
    ):
        if argument.annotation:
            argument.annotation = ast.Name(f"«{shown(argument.annotation)}»")
    text = re.sub(r"«(.*?)»", r"\1", ast.unparse(arguments))
    made = function.name in ("__new__", "__init__")
    return f"({text})", None if made else shown(function.returns) or None


def signature(_app: Any, what: str, name: str, _thing: Any, *_: Any) -> Any:
    """Handles the autodoc event."""
    if what not in ("class", "function", "method"):
        return None
    function = _in_stub(name)
    return typed(function) if function else None


def attribute(_app: Any, domain: str, kind: str, content: Any) -> None:
    """Writes the type of an attribute behind its name."""
    if domain != "py" or kind not in ("attribute", "property"):
        return
    for line in content.parent.findall(addnodes.desc_signature):
        function = _in_stub(f"{line.get('class')}.{line.get('fullname', '').split('.')[-1]}")
        if function and function.returns and not line.next_node(addnodes.desc_annotation):
            line += addnodes.desc_annotation("", "", nodes.Text(": " + shown(function.returns)))


def setup(app: Any) -> dict[str, bool]:
    """Registers the Sphinx extension."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-signature", signature)
    app.connect("object-description-transform", attribute)
    return {"parallel_read_safe": True}
