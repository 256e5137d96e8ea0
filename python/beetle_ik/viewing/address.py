"""Address of a page."""

import errno
import os
import socket
from numbers import Integral

from .._core import InvalidInputError
from ..calls.arguments import require_text

_PORTS = 65536
_TRIED = 100


def free_port(host: str, port: int) -> int:
    """Returns `port`, or the next free one; for 0 any free port.

    viser searches for a free port too, but takes every error of the system for a port in use.

    Raises:
        InvalidInputError: no such host on this machine, or a port that may not be used.
    """
    require_text("host", host)
    if not host:  # the system would listen on all addresses
        raise InvalidInputError("host is empty: 127.0.0.1 is this machine")
    if not isinstance(port, Integral) or not 0 <= port < _PORTS:
        raise InvalidInputError(f"port must be a whole number from 0 to {_PORTS - 1}, got {port!r:.60}")
    tried = range(int(port), min(int(port) + _TRIED, _PORTS))
    for candidate in tried:
        try:
            return _bound(host, candidate)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise InvalidInputError(_reason(host, candidate, error)) from error
        except UnicodeError as error:
            raise InvalidInputError(f"host '{host:.60}' is not the name of a machine") from error
    raise InvalidInputError(f"port: none of {tried[0]} to {tried[-1]} is free on host '{host:.60}'")


def _bound(host: str, port: int) -> int:
    """Binds a socket for a moment, and returns its port."""
    family, kind, protocol, _, address = socket.getaddrinfo(
        host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
    )[0]
    with socket.socket(family, kind, protocol) as probe:
        if os.name == "posix":  # elsewhere it would share a port in use
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind(address)
        return int(probe.getsockname()[1])


def _reason(host: str, port: int, error: OSError) -> str:
    if isinstance(error, socket.gaierror) or error.errno == errno.EADDRNOTAVAIL:
        return f"host '{host:.60}' is not an address of this machine; 127.0.0.1: only this machine, 0.0.0.0: all"
    return f"port {port} cannot be used: {error.strerror}; ports from 1024 on need no rights"
