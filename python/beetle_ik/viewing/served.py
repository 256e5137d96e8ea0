"""A server of viser for its own page alone."""

from __future__ import annotations

import logging
import threading
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .._core import BeetleIkError
from ..installed.needs import library
from .admission import Admission
from .incoming import Incoming

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import viser

_log = logging.getLogger(__name__)

_LARGEST = 16 * 2**20  # bytes of a message
_POLICY = (
    "frame-ancestors 'self' http://localhost:* http://127.0.0.1:* vscode-webview: vscode-file:; "
    "connect-src 'self' ws://{host} wss://{host} data: blob:"
)
"""Pages that may embed this one: notebooks. Sources that it may load from: viser's client would otherwise play a
recording of, or obey, any site in its address."""

_replacing, _quieting = threading.Lock(), threading.Lock()


def serve(host: str, port: int, label: str, admission: Admission) -> viser.ViserServer:
    """Returns a server of viser. Requests that `admission` refuses get an error, and invalid messages are dropped.

    Raises:
        BeetleIkError: viser is not installed, or its version serves pages in an unknown way.
    """
    module = library("viser", "viser", "the viewer", extra="view")
    incoming = Incoming()
    with _quiet(), _replaced_serve(host, port, partial(_serve, admission, incoming)) as used:
        server: viser.ViserServer = module.ViserServer(host=host, port=port, label=label, verbose=False)
    if not used or server.get_port() != port:
        stop(server)
        raise BeetleIkError(f"viser {module.__version__} does not serve at port {port} as it was asked to: try again")
    incoming.server = server
    return server


def stop(server: viser.ViserServer) -> None:
    """Ends a server and its threads."""
    with _quiet():
        server.stop()


def _serve(admission: Admission, incoming: Incoming, original: Any, *arguments: Any, **options: Any) -> Any:
    """Calls `websockets.asyncio.server.serve` as viser does, with checks in between."""
    from websockets.asyncio.server import ServerConnection

    class Checked(ServerConnection):
        """A connection that drops messages that viser cannot use."""

        dropped = 0

        async def recv(self, *_: Any, **__: Any) -> Any:
            while True:
                raw = await super().recv()
                if incoming.accepts(raw):
                    return raw
                self.dropped += 1
                if self.dropped == 1:  # a page may send thousands
                    _log.warning("the viewer drops malformed messages of %s", self.remote_address)

    answer = options.pop("process_request")

    def process_request(connection: Any, request: Any) -> Any:
        headers = {name: request.headers.get_all(name) for name in ("Host", "Origin", "Cookie")}
        if any(len(values) > 1 for name, values in headers.items() if name != "Cookie"):
            return connection.respond(400, "a header twice\n")
        refusal = admission.refusal(request.path, {name: values[0] for name, values in headers.items() if values})
        if refusal is not None:
            return connection.respond(refusal[0], refusal[1] + "\n")
        response = answer(connection, request)
        if response is not None:
            cookie = admission.cookie(request.path)
            if cookie is not None:
                response.headers["Set-Cookie"] = cookie
            response.headers["Referrer-Policy"] = "no-referrer"  # the address may have a token
            place = request.headers.get("Host", "").rpartition("@")[2]  # the admitted host, without a user before "@"
            response.headers["Content-Security-Policy"] = _POLICY.format(host=place)
        return response

    options |= {"max_size": _LARGEST, "create_connection": Checked}
    return original(*arguments, process_request=process_request, **options)


@contextmanager
def _quiet() -> Iterator[None]:
    """Leaves out what viser prints as it starts and stops: its addresses lack the token, and `Viewer` names its own."""
    rich: Any = import_module("rich")
    with _quieting:
        original = rich.print

        def others(*objects: Any, **options: Any) -> None:
            said = (each if isinstance(each, str) else getattr(each, "title", "") for each in objects)
            if not any("viser" in str(each) for each in said):
                original(*objects, **options)

        rich.print = others
        try:
            yield
        finally:
            rich.print = original


@contextmanager
def _replaced_serve(host: str, port: int, serve: Callable[..., Any]) -> Iterator[list[bool]]:
    """Makes viser call `serve(original, ...)` at this address alone; yields whether it was called."""
    infra: Any = import_module("viser.infra._infra")
    used: list[bool] = []
    websockets = infra.websockets
    original = websockets.asyncio.server.serve

    def chosen(*arguments: Any, **options: Any) -> Any:
        if arguments[1:3] != (host, port):
            return original(*arguments, **options)
        used.append(True)
        return serve(original, *arguments, **options)

    with _replacing:
        server = _Replacing(websockets.asyncio.server, serve=chosen)
        infra.websockets = _Replacing(websockets, asyncio=_Replacing(websockets.asyncio, server=server))
        try:
            yield used
        finally:
            infra.websockets = websockets


class _Replacing:
    """A module with some attributes replaced."""

    def __init__(self, module: Any, **replaced: Any) -> None:
        self.__dict__.update(replaced)
        self._module = module

    def __getattr__(self, name: str) -> Any:
        return getattr(self._module, name)
