"""Lists names and signatures of the stable interface, in the form of tests/python/stable_interface.txt.

docs/stability.md says which names are stable. Run this after adding to them; before you remove or change one, read
"Deprecation" in CONTRIBUTING.md.
"""

import enum
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import beetle_ik as bik

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "stability.md"
KEPT = ROOT / "tests" / "python" / "stable_interface.txt"


def names(group: str) -> list[str]:
    """Returns the names of beetle_ik that the page lists under this heading."""
    section = PAGE.read_text(encoding="utf-8").split(f"\n## {group}\n")[1].split("\n## ")[0]
    return [name for name in re.findall(r"`(\w+)`", section) if name != "beetle_ik"]


def lines() -> Iterator[str]:
    """Yields one line for each stable name, method and attribute."""
    for name in sorted(names("Stable")):
        thing = getattr(bik, name)
        if isinstance(thing, ModuleType):
            for member in sorted(thing.__all__):
                yield from _described(f"{name}.{member}", getattr(thing, member))
        else:
            yield from _described(name, thing)


def _described(name: str, thing: object) -> Iterator[str]:
    if inspect.isclass(thing) and issubclass(thing, Exception):
        yield f"{name}: {', '.join(base.__name__ for base in thing.__mro__[1:-2])}"
    elif inspect.isclass(thing) and issubclass(thing, enum.Enum):
        yield from (f"{name}.{member.name} = {member.value}" for member in thing)
    elif inspect.isclass(thing):
        yield name + _signature(thing)
        for key in sorted(key for key in dir(thing) if not key.startswith("_")):
            member = inspect.getattr_static(thing, key)
            callable_member = callable(member) or isinstance(member, (staticmethod, classmethod))
            yield f"{name}.{key}" + (_signature(getattr(thing, key)) if callable_member else "")
    elif callable(thing):
        yield name + _signature(thing)
    else:
        yield name


def _signature(thing: object) -> str:
    """Returns arguments and defaults, without the types, which are in the stub."""
    try:
        signature = inspect.signature(thing)  # type: ignore[arg-type]
    except ValueError:
        return ""  # a class that only the library makes
    bare = [parameter.replace(annotation=parameter.empty) for parameter in signature.parameters.values()]
    return str(signature.replace(parameters=bare, return_annotation=signature.empty))


if __name__ == "__main__":
    KEPT.write_text("\n".join(lines()) + "\n", encoding="utf-8")
