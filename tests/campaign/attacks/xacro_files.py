"""Xacro files from anyone: arithmetic has its value, and nothing is executed, read or shown."""

from __future__ import annotations

import math
from typing import Any, ClassVar
from xml.sax.saxutils import quoteattr

import numpy as np

from ..attack import Attack, BrokenError, Case

_NUMBERS = ("0", "1", "2", "-1", "0.5", "1e-3", "1e300", "pi", "math.pi", "e", "90", "180.0", "-0.0", "10**3")
_FUNCTIONS = ("sin", "cos", "math.sqrt", "radians", "abs", "float", "int", "round", "math.atan", "min", "max")
_OPERATORS = ("+", "-", "*", "/", "//", "%", "**", "<", "<=", "==", "!=", " and ", " or ")
_ROOTS = (
    "()",
    "1",
    "'a'",
    "str",
    "math",
    "[b for b in a]",
    "(b for b in a)",
    "python",
    "xacro",
    "dict(a=1)",
    "lambda: 1",
)
_STEPS = (
    ".__class__", ".__globals__", ".gi_frame", ".f_back", ".f_builtins", ".format", ".mro()", "['open']", "[0]", "()",
    "('PWNED', 'w')", ".write('x')", ".a", ".__self__", ".__init__", "[*a]", "(**a)",
)  # fmt: skip
_HOSTILE = (
    "open('PWNED', 'w')", "load_yaml('secret.yaml')", "xacro.load_yaml('secret.yaml')", "9**9**9", "'a' * 10**11",
    "[0] * 10**11", "list(range(10**12))", "round(1, -10**9)", "'%0999999999d' % 1", "[a:=[]]", "$(env SECRET)",
    "__import__('os').system('touch PWNED')", "xacro.message('hunter')", "[1, 2][9]", "~1", "1 << 10**9",
)  # fmt: skip
_PLACES = (
    "<xacro:property name='p' value={}/><link name='${{p}}'/>",
    "<xacro:macro name='m' params='v'><link name='${{v}}'/></xacro:macro><xacro:m v={}/>",
    "<xacro:if value={}/>",
    "<xacro:include filename={}/>",
    "<xacro:arg name='x' default={}/><link name='$(arg x)'/>",
    "<link name={}/>",
)
_COMMANDS = ("$(env SECRET)", "$(optenv SECRET x)", "$(eval env('SECRET'))", "$(cwd)", "$(find ..)", "secret.yaml", "*")


class Xacro(Attack):
    name = "xacro"
    promise = "Expressions of a xacro file have the value that Python gives them, and none executes or reads anything"
    page = "robots"
    deadline: ClassVar[float] = 120.0

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        if not hard:
            return {"expression": _arithmetic(random, 4), "place": ""}
        place = str(random.choice(_PLACES))
        if random.random() < 0.2:
            return {"expression": str(random.choice(_COMMANDS)), "place": place}
        parts = [str(random.choice(_ROOTS)), *(str(step) for step in random.choice(_STEPS, random.integers(1, 6)))]
        hostile = "".join(parts) if random.random() < 0.6 else str(random.choice(_HOSTILE))
        if random.random() < 0.5:
            hostile = f"{_arithmetic(random, 2)} {random.choice(['+', 'and', 'if 0 else', ','])} {hostile}"
        return {"expression": f"${{{hostile}}}", "place": place}

    def program(self, case: Case) -> str:
        inner = case["place"].format(quoteattr(case["expression"])) if case["place"] else ""
        x = "0" if case["place"] else f"${{0.0 + ({case['expression']})}}"  # truth is a number too
        text = (
            f"<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>{inner}<link name='a'/><link name='b'/>"
            f"<joint name='j' type='continuous'><origin xyz={quoteattr(f'{x} 0 0')}/><parent link='a'/>"
            "<child link='b'/></joint></robot>"
        )
        return (
            "import os\n\nos.environ['SECRET'] = 'hunter2'\nopen('secret.yaml', 'w').write('hunter2: 1')\n"
            f"open('case.urdf.xacro', 'w').write({text!r})\n"
            "before, x, said, links = sorted(os.listdir()), nan, '', []\n"
            "try:\n    robot = bik.Robot.from_urdf('case.urdf.xacro', base='a', tip='b')\n"
            "    x, links = robot.fk([0.0])[0, 3], robot.all_link_names\n"
            "except bik.BeetleIkError as error:\n    said = str(error)\n"
            "after = sorted(os.listdir())"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        if left["before"] != left["after"]:
            raise BrokenError("a file was written or removed", left["after"])
        if "hunter2" in left["said"] or "hunter2" in "".join(left["links"]):
            raise BrokenError("the environment or a file is shown", left["said"] or left["links"])
        if not case["place"]:
            _require_value(case["expression"], left["x"], left["said"])
        return 1


def _arithmetic(random: np.random.Generator, depth: int) -> str:
    """Draws an expression that real files could have."""
    if depth == 0 or random.random() < 0.2:
        return str(random.choice(_NUMBERS))
    inner = _arithmetic(random, depth - 1)
    match random.integers(5):
        case 0:
            function = str(random.choice(_FUNCTIONS))
            return (
                f"{function}({inner}, {_arithmetic(random, 0)})"
                if function in ("min", "max")
                else f"{function}({inner})"
            )
        case 1:
            return f"({inner} if {_arithmetic(random, depth - 1)} else {_arithmetic(random, depth - 1)})"
        case 2:
            return f"[{inner}, {_arithmetic(random, depth - 1)}][{random.integers(2)}]"
    return f"({inner}{random.choice(_OPERATORS)}{_arithmetic(random, depth - 1)})"


def _require_value(expression: str, found: float, said: str) -> None:
    if "**" in expression.replace("10**3", ""):
        return  # Python would not end
    try:
        wanted = float(eval(expression, {"math": math, **vars(math)}))
    except (ArithmeticError, ValueError, TypeError):
        wanted = math.nan
    if not math.isfinite(wanted):
        if not said:
            raise BrokenError("a value that Python refuses is taken", found)
        return
    if said and abs(wanted) < 1e6 and "so much work" not in said:  # int(1e300) has a thousand bits
        raise BrokenError("arithmetic is refused", said)
    if not said and not math.isclose(found, wanted, rel_tol=1e-12, abs_tol=1e-12):
        raise BrokenError("arithmetic has another value", (found, wanted))


ATTACKS = [Xacro()]
