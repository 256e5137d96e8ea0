"""Counts with nouns."""


def counted(number: int, thing: str) -> str:
    """Returns "1 step" or "2 steps"."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
