"""Waits for what the thread of a viewer does: after each of its turns it is looked at."""

import threading
from collections.abc import Callable, Collection

from beetle_ik.viewing.turns import Turns
from beetle_ik.viewing.worker import Request

_turned = threading.Condition()
_turn = Turns._turn


def _told(self: Turns, requests: Collection[Request]) -> bool:
    try:
        return _turn(self, requests)
    finally:
        with _turned:
            _turned.notify_all()


Turns._turn = _told  # type: ignore[method-assign]


def until(happened: Callable[[], object]) -> None:
    """Waits until something has happened. What never does runs into the time-out of the tests."""
    with _turned:
        _turned.wait_for(happened)
