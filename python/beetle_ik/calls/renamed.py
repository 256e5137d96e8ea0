"""Keyword arguments under their old names, which work until the version that removes them.

A configuration from which a call starts has one name, `start_q`; the native module asks here when a keyword is unknown
(`crates/ikpy-bind/src/gate.rs`).
"""

from collections.abc import Mapping
from typing import Any

from .warned import warn

_REMOVED_IN = "0.3"
_START = {"start": "start_q"}
_RENAMED: dict[str, dict[str, str]] = {
    "Tracker": _START,
    "self_motion": _START,
    "solve": _START,
    "solve_all": _START,
    "solve_batch": {"starts": "start_q"},
    "state_to_state": {
        "q0": "start_q",
        "q1": "end_q",
        "qd0": "start_qd",
        "qd1": "end_qd",
        "qdd0": "start_qdd",
        "qdd1": "end_qdd",
    },
    "track": _START,
    "track_model_free": _START,
}


def renamed(call: Any, keywords: Mapping[str, Any]) -> dict[str, Any] | None:
    """Returns the keywords of a call under their new names, with a warning for each old one; None without old ones."""
    made = getattr(call, "__mro__", (call,))  # a class that derives from ours takes the same arguments
    names = next((_RENAMED[each.__name__] for each in made if each.__name__ in _RENAMED), {})
    old = [name for name in names if name in keywords and names[name] not in keywords]
    for name in old:
        message = f"{name}= of {call.__name__} is now {names[name]}=; the old name goes in {_REMOVED_IN}"
        warn(message, DeprecationWarning)
    return {names[name] if name in old else name: value for name, value in keywords.items()} if old else None
