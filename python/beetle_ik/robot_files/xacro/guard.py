"""Replacements for functions of the package xacro, for untrusted files."""

import glob
import keyword
import os
import re
import xml.dom.minidom
from collections.abc import Callable, Iterator
from functools import partial, wraps
from types import ModuleType
from typing import Any
from xml.parsers import expat
from xml.sax.saxutils import escape

from ..._core import BeetleIkError
from ..own_files import RefusedError
from .budget import Budget
from .expressions import Expressions
from .functions import symbols as global_symbols
from .packages import Packages

_REPLACED = ("eval_all", "eval_extension", "eval_text", "get_include_files", "grab_macro", "is_valid_name", "parse")
_USED = ("XacroException", "_global_symbols", "abs_filename_spec", "filestack", "re_macro_arg", "safe_eval")
_ELEMENT, _CHILD, _TEXT = 600, 50, 20  # steps
_COPIES = 1000  # characters that are copied in one step
_COMPARISONS = 50  # comparisons of two elements in one step
_LONGEST = 20_000  # characters of the parameters of a macro
# xacro's pattern, without the alternatives that take exponential time on an unclosed quote.
_MACRO_ARGUMENT = re.compile(
    r"""^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?(\$\{.*?\}|\$\(.*?\)|(?:'[^']*'|"[^"]*"|[^\s'"])+|)(?:\s+|$)(.*)"""
)


class Guard:
    """Guard between the package xacro and an untrusted file.

    Attributes:
        refusal: the first refused request, and its place; None if nothing was refused.
    """

    def __init__(self, module: ModuleType, packages: Packages) -> None:
        """Replaces functions of `module`.

        Raises:
            BeetleIkError: this version of xacro lacks a function to be replaced.
        """
        missing = [name for name in (*_REPLACED, *_USED) if not hasattr(module, name)]
        if missing:
            raise BeetleIkError(f"this version of xacro cannot be guarded, it has no {missing[0]}: install xacro 2.1")
        self._module, self._packages, self._budget = module, packages, Budget()
        self.refusal: str | None = None
        expressions = Expressions(self._budget, [self._argument])
        self._eval_text, self._eval_all, self._grab_macro = module.eval_text, module.eval_all, module.grab_macro
        changed: dict[str, Any] = {
            **{name: self._noted(getattr(self, name)) for name in _REPLACED},
            "safe_eval": self._noted(lambda text, names, _locals=None: expressions.value(text, names)),
            "load_yaml": self._noted(partial(_refused, "load_yaml(), which reads files,")),
            "_global_symbols": global_symbols(self._argument),
            "re_macro_arg": _MACRO_ARGUMENT,
            # Functions that xacro does not use now. A version that did would fail here, and neither read nor execute
            # anything.
            **{name: self._noted(partial(_refused, f"{name}()")) for name in ("open", "eval", "exec", "compile")},
        }
        vars(module).update(changed)

    def eval_text(self, text: str, symbols: Any) -> Any:
        """Returns the value of a text with expressions in it."""
        self._budget.spend(_TEXT + len(text) * (1 + text.count("$")) // _COPIES)
        return self._budget.keep(self._eval_text(text, symbols))

    def eval_all(self, node: Any, macros: Any, names: Any) -> None:
        """Expands an element."""
        self._budget.spend(_ELEMENT)
        self._spend_on_children(node)
        self._eval_all(node, macros, names)
        self._spend_on_children(node)  # the caller puts them in place of the node

    def _spend_on_children(self, node: Any) -> None:
        """Subtracts the work of replacing the children: each is searched for among all."""
        children = node.childNodes.length
        self._budget.spend(children * (_CHILD + children // _COMPARISONS))

    def grab_macro(self, element: Any, macros: Any) -> None:
        """Reads a macro."""
        if len(element.getAttribute("params")) > _LONGEST:
            raise RefusedError(f"a macro with more than {_LONGEST} characters of parameters")
        self._grab_macro(element, macros)

    def is_valid_name(self, name: str) -> bool:
        """Whether a property may have this name."""
        return name.isidentifier() and not keyword.iskeyword(name)

    def eval_extension(self, text: str) -> str:
        """Returns the value of `$(command ...)`."""
        match text[2:-1].split():
            case ["arg", name]:
                return str(self._argument(name))
            case ["find", name]:
                return found(self._module, self._packages, name)
        raise RefusedError(f"the command '{text[2:-1].strip().partition(' ')[0]:.60}'")

    def _argument(self, name: str) -> Any:
        try:
            return self._module.substitution_args_context["arg"][name]
        except KeyError:
            raise self._module.XacroException(f"Undefined substitution argument {name!r:.60}") from None

    def get_include_files(self, spec: str, names: Any) -> Iterator[str]:
        """Yields the files that an element includes."""
        path = os.path.normpath(self._module.abs_filename_spec(str(self._module.eval_text(spec, names))))
        if not re.search(r"[*?[]", path):
            yield path
            return
        fixed = re.split(r"[*?[]", path)[0]
        self._packages.require_open(os.path.dirname(fixed) or ".")  # noqa: PTH120
        yield from sorted(glob.glob(path))  # noqa: PTH207

    def parse(self, _text: object, filename: str) -> Any:
        """Reads a file into a tree."""
        path = self._packages.require_open(filename)
        try:
            content = path.read_bytes() if path.is_file() else b""
            self._budget.spend(len(content))
            if not path.is_file():
                raise FileNotFoundError(2, "No such file", filename)
        except OSError as error:
            self._module.filestack.pop()  # like xacro
            raise self._module.XacroException(f"{error.strerror}: {filename:.200}", exc=error) from error
        require_no_entities(content)
        return xml.dom.minidom.parseString(content)

    def _noted(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wraps a function so that the first refusal is recorded: xacro wraps errors, and mistakes some for others."""

        @wraps(function)
        def noting(*arguments: Any, **options: Any) -> Any:
            try:
                return function(*arguments, **options)
            except RefusedError as error:
                if self.refusal is None:
                    self.refusal = f"{self._place(arguments)}{error}"
                raise

        return noting

    def _place(self, arguments: tuple[Any, ...]) -> str:
        """Names the place of an error, as far as known: included file, line, and text of the first argument."""
        files = self._module.filestack or [""]
        text = arguments[0] if arguments and isinstance(arguments[0], str) else ""
        where = f"in '{files[-1]}': " if len(files) > 1 else ""
        try:
            lines = self._packages.require_open(files[-1]).read_text(errors="replace").splitlines()
        except (OSError, RefusedError):
            lines = []
        shown = (text.strip(), escape(text.strip()))
        line = next((i for i, line in enumerate(lines, 1) if text and any(each in line for each in shown)), None)
        if line is not None:
            where += f"line {line}: "
        return f"{where}'{text:.100}': " if text else where


def found(module: ModuleType, packages: Packages, name: str) -> str:
    """Returns the folder of a package.

    Raises:
        XacroException: the package is not found.
    """
    folder = packages.find(name)
    if folder is None:
        raise module.XacroException(f"package '{name:.60}' is not found: give the folder that holds it as package_dirs")
    return str(folder)


def require_no_entities(content: bytes) -> None:
    """Raises `RefusedError` if XML declares entities, which may be exponentially long or name files."""

    def declared(name: str, *_: object) -> None:
        raise RefusedError(f"the entity '{name:.60}'")

    parser = expat.ParserCreate()
    parser.EntityDeclHandler = declared
    parser.Parse(content, True)


def _refused(what: str, *_: object, **__: object) -> None:
    raise RefusedError(what)
