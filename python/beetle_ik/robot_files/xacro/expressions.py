"""Evaluation of expressions in Python's grammar, without Python's `eval`: anything not listed here is refused."""

import ast
import operator
from collections.abc import Callable, Collection, Mapping
from typing import Any

from ..own_files import RefusedError
from .budget import Budget
from .functions import CALLABLE, Reads, mapped

_LONGEST = 20_000  # characters
_EXPRESSION, _PARSED, _NODE = 50, 2, 10  # steps for an expression, a character and a node

_ARITHMETIC: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
}
_SIGNS: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
}
_COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda item, items: item in items,
    ast.NotIn: lambda item, items: item not in items,
}
_WORDS = {
    ast.Await: "await",
    ast.DictComp: "a comprehension",
    ast.FormattedValue: "a formatted text",
    ast.GeneratorExp: "a comprehension",
    ast.JoinedStr: "a formatted text",
    ast.Lambda: "a lambda",
    ast.ListComp: "a comprehension",
    ast.NamedExpr: "the assignment :=",
    ast.Set: "a set",
    ast.SetComp: "a comprehension",
    ast.Starred: "an unpacking *",
    ast.Yield: "yield",
    ast.YieldFrom: "yield",
    ast.Invert: "the operator ~",
    ast.LShift: "the operator <<",
    ast.RShift: "the operator >>",
    ast.BitAnd: "the operator &",
    ast.BitOr: "the operator |",
    ast.BitXor: "the operator ^",
    ast.MatMult: "the operator @",
}


class Expressions:
    """Evaluates expressions.

    Args:
        budget: budget that pays for the work.
        functions: functions that may be called besides `CALLABLE`.
    """

    def __init__(self, budget: Budget, functions: Collection[Callable[..., Any]]) -> None:
        """Starts without names: each expression brings its own."""
        self._budget = budget
        self._functions = CALLABLE | set(functions)

    def value(self, text: str, names: Mapping[str, Any]) -> Any:
        """Returns the value of an expression, in which `names` may be used.

        Raises:
            RefusedError: the text contains more than arithmetic, comparisons, conditions, literals and known functions.
            Exception: as Python raises them, for example for a division by zero.
        """
        if len(text) > _LONGEST:
            raise RefusedError(f"an expression of more than {_LONGEST} characters")
        self._budget.spend(_EXPRESSION + _PARSED * len(text))
        try:
            tree = ast.parse(text.strip(), mode="eval").body
            return self._of(tree, names)
        except (MemoryError, RecursionError):
            raise RefusedError("an expression that is nested too deeply") from None

    def _of(self, node: ast.expr, names: Mapping[str, Any]) -> Any:
        self._budget.spend(_NODE)
        match node:
            case ast.Constant(value=value) if value is None or isinstance(value, int | float | str):
                return self._budget.keep(value)
            case ast.Name(id=name):
                return _named(name, names)
            case ast.Attribute(value=owner, attr=name):
                return self._attribute(self._of(owner, names), name)
            case ast.Subscript(value=owner, slice=place):
                return self._item(self._of(owner, names), self._place(place, names))
            case ast.UnaryOp(op=sign, operand=operand) if type(sign) in _SIGNS:
                return _SIGNS[type(sign)](self._of(operand, names))
            case ast.BinOp(left=left, op=operation, right=right):
                return self._binary(operation, self._of(left, names), self._of(right, names))
            case ast.BoolOp():
                return self._boolean(node, names)
            case ast.Compare():
                return self._comparison(node, names)
            case ast.IfExp(test=test, body=body, orelse=other):
                return self._of(body if self._of(test, names) else other, names)
            case ast.List(elts=items):
                return self._budget.keep([self._of(item, names) for item in items])
            case ast.Tuple(elts=items):
                return self._budget.keep(tuple(self._of(item, names) for item in items))
            case ast.Dict(keys=keys, values=values):
                return self._dict(keys, values, names)
            case ast.Call():
                return self._call(node, names)
        raise _refusal(node.op if isinstance(node, ast.UnaryOp) else node)

    def _attribute(self, owner: Any, name: str) -> Any:
        """Returns an item of a namespace or dict. Other values have no attributes, which lead out of the names."""
        if not isinstance(owner, dict) or name.startswith("_"):
            raise RefusedError(f"the attribute '.{name:.60}'")
        try:
            return owner[name]
        except KeyError:
            raise NameError(f"name '{name:.60}' is not defined") from None

    def _place(self, node: ast.expr, names: Mapping[str, Any]) -> Any:
        if not isinstance(node, ast.Slice):
            return self._of(node, names)
        ends = (node.lower, node.upper, node.step)
        return slice(*(None if end is None else self._of(end, names) for end in ends))

    def _item(self, owner: Any, place: Any) -> Any:
        if not isinstance(owner, dict | list | tuple | str):
            raise RefusedError(f"an item of something of type {type(owner).__name__}")
        return self._budget.keep(owner[place]) if isinstance(place, slice) else owner[place]

    def _binary(self, operation: ast.operator, left: Any, right: Any) -> Any:
        if isinstance(operation, ast.Pow):
            return self._budget.power(left, right)
        if isinstance(operation, ast.Mult):
            return self._budget.product(left, right)
        if isinstance(operation, ast.Mod):
            if isinstance(left, str):
                raise RefusedError("a formatted text")
            return left % right
        if type(operation) not in _ARITHMETIC:
            raise _refusal(operation)
        return self._budget.keep(_ARITHMETIC[type(operation)](left, right))

    def _boolean(self, node: ast.BoolOp, names: Mapping[str, Any]) -> Any:
        ends_at = isinstance(node.op, ast.Or)
        for operand in node.values:
            value = self._of(operand, names)
            if bool(value) is ends_at:
                break
        return value

    def _comparison(self, node: ast.Compare, names: Mapping[str, Any]) -> bool:
        left = self._of(node.left, names)
        for comparison, operand in zip(node.ops, node.comparators, strict=True):
            right = self._of(operand, names)
            self._budget.keep((left, right))
            if not _COMPARISONS[type(comparison)](left, right):
                return False
            left = right
        return True

    def _dict(self, keys: list[ast.expr | None], values: list[ast.expr], names: Mapping[str, Any]) -> Any:
        pairs = {}
        for key, value in zip(keys, values, strict=True):
            if key is None:
                raise RefusedError("an unpacking **")
            pairs[self._of(key, names)] = self._of(value, names)
        return self._budget.keep(pairs)

    def _call(self, node: ast.Call, names: Mapping[str, Any]) -> Any:
        name = ast.unparse(node.func)
        try:
            function = self._of(node.func, names)
        except NameError:
            function = None
        if isinstance(function, Reads):
            raise RefusedError(f"{name}(), which reads files,")
        if not callable(function) or function not in self._functions:
            raise RefusedError(f"a call of '{name:.60}', which is not among the functions allowed,")
        arguments = [self._of(argument, names) for argument in node.args]
        options: dict[str, Any] = {}
        for keyword in node.keywords:
            if keyword.arg is None:
                raise RefusedError("an unpacking **")
            options[keyword.arg] = self._of(keyword.value, names)
        passed = arguments[function is mapped :] + list(options.values())
        if any(callable(each) for each in passed):  # a function would be called for each item, outside the budget
            raise RefusedError("a function as an argument")
        self._budget.keep((arguments, options))
        return self._budget.keep(function(*arguments, **options))


def _named(name: str, names: Mapping[str, Any]) -> Any:
    if name.startswith("__"):
        raise RefusedError(f"the name '{name:.60}'")
    try:
        return names[name]
    except KeyError:
        raise NameError(f"name '{name:.60}' is not defined") from None


def _refusal(node: ast.AST) -> RefusedError:
    if isinstance(node, ast.Constant):
        return RefusedError(f"a literal of type {type(node.value).__name__}")
    return RefusedError(_WORDS.get(type(node), f"syntax of the kind {type(node).__name__}"))
