"""Checks of the messages from a page: viser accepts any message and sets its values."""

from __future__ import annotations

import dataclasses
import math
import types
from typing import TYPE_CHECKING, Any, Literal, Union, get_args, get_origin, get_type_hints

if TYPE_CHECKING:
    import viser

_KNOWN = frozenset(
    {
        *("CommandTriggerMessage", "FileTransferPart", "FileTransferStartUpload", "GetRenderResponseMessage"),
        *("GuiButtonHoldMessage", "GuiFormDirtyMessage", "GuiFormSubmitMessage", "GuiUpdateMessage"),
        *("LocalStorageGetItemResponseMessage", "SceneNodeClickMessage", "SceneNodeDragMessage", "ScenePointerMessage"),
        *("TransformControlsDragEndMessage", "TransformControlsDragStartMessage", "TransformControlsUpdateMessage"),
        "ViewerCameraMessage",
    }
)
"""Message types that viser's page sends, without those that share it on the internet."""

_FARTHEST = 1e6  # m, rad: largest number of any kind
_ROUNDING = 1e-6
_LONGEST = 100_000  # characters of a typed text
_LARGEST_FILE, _MOST_PARTS, _LARGEST_PART = 16_000_000, 64, 2**20  # bytes of a file, its parts, bytes of a part


class Incoming:
    """Filter for the messages that viser can use."""

    def __init__(self) -> None:
        """Starts without a server."""
        self.server: viser.ViserServer | None = None
        """Server whose controls are changed; set after its construction."""

    def accepts(self, raw: object) -> bool:
        """Whether a message has the fields of its type, finite numbers, and values that its control can take."""
        from msgspec import DecodeError, msgpack
        from viser import _messages

        if not isinstance(raw, bytes):
            return False
        try:
            fields = msgpack.decode(raw)
        except (DecodeError, RecursionError, UnicodeDecodeError, ValueError):
            return False
        kind_name = fields.get("type") if isinstance(fields, dict) else None
        if not isinstance(kind_name, str) or kind_name not in _KNOWN:
            return False
        kind = getattr(_messages, fields.pop("type"))
        hints = get_type_hints(kind)
        known = {field.name: field for field in dataclasses.fields(kind)}
        needed = {name for name, field in known.items() if field.init and field.default is dataclasses.MISSING}
        if not needed <= fields.keys() <= known.keys():
            return False
        if not all(_fits(value, hints[name]) for name, value in fields.items()):
            return False
        return self._can_be_set(kind.__name__, fields)

    def _can_be_set(self, kind: str, fields: dict[str, Any]) -> bool:
        if kind == "TransformControlsUpdateMessage":
            return math.hypot(*fields["wxyz"]) > 1e-3  # the norm of a rotation is 1
        if kind in ("GuiFormDirtyMessage", "GuiFormSubmitMessage"):  # viser keeps them for later pages
            return any(fields["uuid"] in owner.gui._container_handle_from_uuid for owner in self._owners())
        if kind == "FileTransferStartUpload":  # viser would set any control to the file
            button = self._control(fields["source_component_uuid"])
            small = 0 <= fields["size_bytes"] <= _LARGEST_FILE and 0 <= fields["part_count"] <= _MOST_PARTS
            return type(button).__name__ == "GuiUploadButtonHandle" and small
        if kind == "FileTransferPart":
            return len(fields["content"]) <= _LARGEST_PART
        if kind != "GuiUpdateMessage":
            return True
        handle = self._control(fields["uuid"])
        # Limits updates to `value`: viser would set any attribute.
        return (
            handle is not None
            and fields["updates"].keys() == {"value"}
            and _is_value(handle, fields["updates"]["value"])
        )

    def _control(self, uuid: str) -> Any:
        """Returns a control of all pages, or of one page; None if there is none."""
        found = (owner.gui._gui_input_handle_from_uuid.get(uuid) for owner in self._owners())
        return next((handle for handle in found if handle is not None), None)

    def _owners(self) -> list[Any]:
        """Returns the owners of controls: the server, for all pages, and each page."""
        return [] if self.server is None else [self.server, *self.server.get_clients().values()]


def _is_value(handle: Any, value: Any) -> bool:
    """Whether a control can take a value: of its type, in its range, among its options."""
    if not _resembles(value, handle.value):
        return False
    options = getattr(handle, "options", None)
    if options is not None and isinstance(value, str) and value not in options:
        return False
    numbers = value if isinstance(value, list) else [value]
    ends = [getattr(handle, end, None) for end in ("min", "max")]
    if any(isinstance(number, str | bool) for number in numbers):
        return True
    for end, sign in zip(ends, (1, -1), strict=True):
        limits = end if isinstance(end, tuple) else [end] * len(numbers)
        if any(
            limit is not None and sign * (number - limit) < -1e-6
            for number, limit in zip(numbers, limits, strict=False)
        ):
            return False
    return True


def _resembles(value: Any, present: Any) -> bool:
    """Whether a value is of the kind of the present one. Pages send tuples as lists, and whole floats as ints."""
    if isinstance(present, bool):
        return isinstance(value, bool)
    if isinstance(present, int | float):
        return _is_number(value) and (isinstance(present, float) or float(value).is_integer())
    if isinstance(present, str):
        return isinstance(value, str) and len(value) <= _LONGEST
    if isinstance(present, tuple):
        alike = isinstance(value, list) and len(value) == len(present)
        return alike and all(_resembles(each, old) for each, old in zip(value, present, strict=True))
    return False


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= _FARTHEST  # excludes NaN


def _fits(value: Any, hint: Any) -> bool:
    """Whether a decoded value fits an annotation of viser's messages."""
    origin, arguments = get_origin(hint), get_args(hint)
    if hint is Any:
        return True
    if hint is float:
        return _is_number(value)
    if hint is int:
        return isinstance(value, int | float) and not isinstance(value, bool) and value == value // 1
    if origin is Literal:
        return isinstance(value, str) and value in arguments
    if origin in (Union, types.UnionType):
        return any(_fits(value, each) for each in arguments)
    if origin is tuple and arguments[-1] is not Ellipsis:
        alike = isinstance(value, list) and len(value) == len(arguments)
        return alike and all(_fits(each, kind) for each, kind in zip(value, arguments, strict=True))
    if origin is tuple:
        return isinstance(value, list) and all(_fits(each, arguments[0]) for each in value)
    if origin is dict:
        return isinstance(value, dict) and all(isinstance(key, str) for key in value)
    return isinstance(hint, type) and isinstance(value, hint)
