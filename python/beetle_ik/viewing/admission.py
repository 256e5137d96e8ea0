"""Access to a page, decided from the headers of a request, for pages and websockets alike."""

from __future__ import annotations

import hmac
import ipaddress
import secrets
import socket
from collections.abc import Iterator, Mapping
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

_HERE = ("localhost", "127.0.0.1", "::1")
_BYTES = 24  # bytes of a token


class Admission:
    """Admits the page itself and programs of this machine; on addresses open to others, only holders of a token.

    A browser sends the requested name as `Host` and the requesting page as `Origin`. A page elsewhere on the web has
    another origin. If it points its own name to this machine, the host differs.

    Attributes:
        token: token that the address of the page must contain; None if only this machine reaches it.
    """

    def __init__(self, host: str) -> None:
        """Makes a token if other machines reach `host`."""
        self._all = host in ("0.0.0.0", "::")
        self._names = {*_HERE, host.lower().strip("[]")}
        if self._all:
            self._names |= {name.lower() for name in (socket.gethostname(), socket.getfqdn())}
        self.token = None if _is_loopback(host) else secrets.token_urlsafe(_BYTES)

    def address(self, host: str, port: int) -> str:
        """Returns the address of the page."""
        page = f"http://{f'[{host}]' if ':' in host else host}:{port}"
        return page if self.token is None else f"{page}/?token={self.token}"

    def refusal(self, path: str, headers: Mapping[str, str]) -> tuple[HTTPStatus, str] | None:
        """Returns status and reason of a refusal; None if the request is admitted."""
        host, origin = headers.get("Host", ""), headers.get("Origin")
        if not self._is_ours(host):
            return HTTPStatus.MISDIRECTED_REQUEST, "this viewer is not at this address"
        if origin is not None and origin.lower() not in (f"http://{host.lower()}", f"https://{host.lower()}"):
            return HTTPStatus.FORBIDDEN, "this viewer takes no requests of other pages"
        if self.token is not None and not any(self._knows(given) for given in _tokens(path, headers)):
            return HTTPStatus.FORBIDDEN, "this viewer needs the token: open the whole address that viewer.url has"
        return None

    def cookie(self, path: str) -> str | None:
        """Returns a cookie with a valid token of the address: the page opens its websocket without the token."""
        if self.token is None or not any(self._knows(given) for given in _queried(path)):
            return None
        return f"{_COOKIE}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    def _knows(self, given: str) -> bool:
        assert self.token is not None, "asked for where there is one"
        return hmac.compare_digest(given.encode(), self.token.encode())

    def _is_ours(self, host: str) -> bool:
        try:
            name = (urlsplit(f"//{host}").hostname or "").lower()
        except ValueError:
            return False
        # Anyone can point a name of theirs to this machine, but not a number.
        return name in self._names or (self._all and _is_number(name))


_COOKIE = "beetle_ik_token"


def _is_loopback(host: str) -> bool:
    return host.lower() == "localhost" or (_is_number(host) and ipaddress.ip_address(host).is_loopback)


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _queried(path: str) -> list[str]:
    try:
        return parse_qs(urlsplit(path).query).get("token", [])
    except ValueError:
        return []


def _tokens(path: str, headers: Mapping[str, str]) -> Iterator[str]:
    yield from _queried(path)
    try:
        cookie = SimpleCookie(headers.get("Cookie", "")).get(_COOKIE)
    except CookieError:
        return
    if cookie is not None:
        yield cookie.value
