"""YAML without exponential aliases: few bytes may stand for more values than a computer holds."""

from collections.abc import Hashable
from typing import Any

from .._core import InvalidInputError
from ..installed.needs import library

_VALUES_PER_BYTE = 10  # a file without aliases has at most one


def load_yaml(where: str, text: str) -> Any:
    """Returns the value of a YAML text.

    Raises:
        BeetleIkError: PyYAML is not installed.
        InvalidInputError: no YAML, or aliases that stand for far more than the text holds; the message begins with
            `where`.
    """
    yaml = library("yaml", "pyyaml", "reading a MoveIt planning scene")
    left = 1000 + _VALUES_PER_BYTE * len(text)

    class Loader(yaml.SafeLoader):  # type: ignore[misc, name-defined]
        """A safe loader that counts a value as often as aliases repeat it."""

        def __init__(self, stream: str) -> None:
            super().__init__(stream)
            self.values, self.values_of = 0, dict[Hashable, int]()

        def compose_node(self, parent: Any, index: Any) -> Any:
            before, is_alias = self.values, self.check_event(yaml.AliasEvent)
            node = super().compose_node(parent, index)
            # An alias inside its own anchor has no end.
            self.values += self.values_of.get(node, left + 1) if is_alias else 1
            if self.values > left:
                raise InvalidInputError(f"{where}: its aliases (*) repeat more than {left} values: write them out")
            self.values_of.setdefault(node, self.values - before)
            return node

    try:
        return yaml.load(text, Loader)
    except (ValueError, RecursionError, yaml.YAMLError) as error:  # also for dates and integers that Python cannot hold
        if isinstance(error, InvalidInputError):
            raise
        raise InvalidInputError(f"{where}: not YAML: {error}") from error
