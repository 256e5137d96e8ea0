"""A bound on the work and the memory that a file asks for: a short file can ask for more than a computer has."""

from typing import Any

from ..own_files import RefusedError

_MOST = 30_000_000  # steps, of a quarter of a microsecond or less: a large robot needs a fiftieth
_ITEM = 4  # steps for an item
_BITS = 4096  # bits of a whole number


class Budget:
    """Remaining work, in steps: a character of a result takes one step, an item four."""

    def __init__(self) -> None:
        """Starts with the full budget."""
        self.left = _MOST

    def spend(self, work: int) -> None:
        """Subtracts `work`.

        Raises:
            RefusedError: less work is left.
        """
        self.left -= work
        if self.left < 0:
            raise RefusedError("so much work or memory")

    def keep(self, value: Any) -> Any:
        """Subtracts the size of `value`, and returns `value`."""
        self.spend(self.size(value))
        return value

    def size(self, value: Any) -> int:
        """Returns the steps of the characters and items of a value; counting ends once they exceed the budget.

        Lists that share their items may be exponentially larger than the memory that they take.
        """
        total, waiting = 0, [value]
        while waiting and total <= self.left:
            each = waiting.pop()
            total += _ITEM
            if isinstance(each, str):
                total += len(each)
            elif isinstance(each, int) and each.bit_length() > 2 * _BITS:  # quotients of long integers are slow
                raise RefusedError("a number that is too large")
            elif isinstance(each, list | tuple):
                waiting.extend(each)
            elif type(each) is dict:  # a scope of xacro is not copied
                waiting.extend(each)
                waiting.extend(each.values())
        return total

    def power(self, base: Any, exponent: Any) -> Any:
        """Returns base ** exponent."""
        if isinstance(base, int) and isinstance(exponent, int) and base.bit_length() * exponent > _BITS:
            raise RefusedError("a number that is too large")
        return base**exponent

    def product(self, a: Any, b: Any) -> Any:
        """Returns a * b, also of a text or list and a number."""
        if isinstance(a, int) and isinstance(b, int):
            if a.bit_length() + b.bit_length() > _BITS:
                raise RefusedError("a number that is too large")
        elif isinstance(a, int) or isinstance(b, int):
            times, repeated = (a, b) if isinstance(a, int) else (b, a)
            self.spend(max(int(times), 0) * self.size(repeated))
        return a * b
