# SPDX-License-Identifier: Apache-2.0
"""Who may open the page of the viewer: this machine's own browser, and holders of the token.

A page of any web site can send requests to this machine. The browser says from which page one comes
(`Origin`) and to which name (`Host`), which is not ours where the site gave its own name our
address. So both are checked, of every request and of every websocket.
"""

from __future__ import annotations

import contextlib
import http
import ipaddress
import secrets
import threading
from collections.abc import Callable, Iterator, Mapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlsplit

_COOKIE = "volcontact_token"


def is_loopback(host: str) -> bool:
    """Whether a name or address means this machine and cannot be reached from another."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Guard:
    """Says which requests a server answers.

    Args:
        host: the address the server listens at.

    Attributes:
        token: what an address must have where others than this machine reach the server; else "".
    """

    def __init__(self, host: str) -> None:
        self.token = "" if is_loopback(host) else secrets.token_urlsafe(18)

    @property
    def query(self) -> str:
        """What follows the address of the page."""
        return f"/?token={self.token}" if self.token else ""

    def why_not(self, path: str, headers: Mapping[str, str]) -> str:
        """Why a request is refused; "" when it is not.

        Args:
            path: with its query.
            headers: of the request; names in any case.
        """
        host, origin = headers.get("Host") or "", headers.get("Origin")
        if not self.token and not is_loopback(_name(host)):
            return "the name of the server is another: open the address that volcontact printed"
        if origin is not None and urlsplit(origin).netloc.lower() != host.lower():
            return "the request comes from a page of another server"
        if self.token and not (self.has_token(path) or self._cookie_holds(headers)):
            return "the token is missing: open the whole address that volcontact printed"
        return ""

    def has_token(self, path: str) -> bool:
        """Whether the query of a path has the token; then the browser is given it to keep."""
        given = parse_qs(urlsplit(path).query).get("token", [""])[0]
        return bool(self.token) and secrets.compare_digest(given.encode(), self.token.encode())

    @property
    def cookie(self) -> str:
        """The header by which the browser keeps the token, for this server alone."""
        return f"{_COOKIE}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    def _cookie_holds(self, headers: Mapping[str, str]) -> bool:
        try:
            morsel = SimpleCookie(headers.get("Cookie") or "").get(_COOKIE)
        except CookieError:
            return False
        given = morsel.value if morsel is not None else ""
        return secrets.compare_digest(given.encode(), self.token.encode())


@contextlib.contextmanager
def guarded(guard: Guard) -> Iterator[threading.Event]:
    """Within it, servers of the library `websockets` that start ask the guard first.

    viser serves the page and its websocket by one such server, and has no place of its own to look
    at requests.

    Yields:
        An event, set once a server has started.
    """
    import websockets.asyncio.server as library
    from websockets.datastructures import Headers
    from websockets.http11 import Response

    serve = library.serve
    started = threading.Event()

    def serve_guarded(*arguments: Any, **options: Any) -> Any:
        started.set()
        answer: Callable[[Any, Any], Any] = options.get("process_request") or (lambda *_: None)

        def process_request(connection: Any, request: Any) -> Any:
            refusal = _refusal(guard, request)
            if refusal:
                status, body = http.HTTPStatus.FORBIDDEN, f"refused: {refusal}\n".encode()
                kind = {"Content-Type": "text/plain; charset=utf-8"}
                headers = Headers(kind | {"Content-Length": str(len(body)), "Connection": "close"})
                return Response(status, status.phrase, headers, body)
            response = answer(connection, request)
            if response is not None and guard.has_token(request.path):
                response.headers["Set-Cookie"] = guard.cookie
            return response

        return serve(*arguments, **{**options, "process_request": process_request})

    library.serve = serve_guarded  # type: ignore[assignment,misc]
    try:
        yield started
    finally:
        library.serve = serve  # type: ignore[misc]


def _refusal(guard: Guard, request: Any) -> str:
    """As `why_not`; a header that is there twice is refused."""
    for name in ("Host", "Origin"):
        if len(request.headers.get_all(name)) > 1:
            return f"the header {name} is there twice"
    return guard.why_not(request.path, request.headers)


def _name(authority: str) -> str:
    """The host of "host:port"; an IPv6 address without its brackets."""
    try:
        return urlsplit(f"//{authority}").hostname or ""
    except ValueError:
        return ""
