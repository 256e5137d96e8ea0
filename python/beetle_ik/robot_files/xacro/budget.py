"""A bound on the work and the memory that a file asks for: a short file can ask for more than a computer has."""

from typing import Any

from ..own_files import RefusedError

_MOST = 30_000_000  # steps, of a quarter of a microsecond or less: a large robot needs a fiftieth
_ITEM = 4  # steps
_BITS = 4096  # of a whole number


class Budget:
    """Work that is left, in steps. A character of a result takes one, an item four."""

    def __init__(self) -> None:
        """Begins with all of it."""
        self.left = _MOST

    def spend(self, work: int) -> None:
        """Takes `work` away.

        Raises:
            RefusedError: there is not so much left.
        """
        self.left -= work
        if self.left < 0:
            raise RefusedError("so much work or memory")

    def keep(self, value: Any) -> Any:
        """Takes the size of `value` away, and returns it."""
        self.spend(self.size(value))
        return value

    def size(self, value: Any) -> int:
        """Returns the steps that characters and items of a value take; counting ends where there is not so much left.

        Lists that share their items may be exponentially larger than the memory that they take.
        """
        total, waiting = 0, [value]
        while waiting and total <= self.left:
            each = waiting.pop()
            total += _ITEM
            if isinstance(each, str):
                total += len(each)
            elif isinstance(each, int) and each.bit_length() > 2 * _BITS:  # its quotients take long
                raise RefusedError("a number that is too large")
            elif isinstance(each, list | tuple):
                waiting.extend(each)
            elif type(each) is dict:  # not a scope of xacro, which is not copied
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
