"""Lets in only who knows the token, on a page of this very server.

The server listens on 127.0.0.1. That keeps other machines out, but not other pages in the same
browser, nor other users of the machine: against them stand the token, and the names in Host and
Origin, which a page cannot choose.
"""

from __future__ import annotations

import secrets
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketClose

POLICY = (
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self' {sockets}; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
)


class Guard:
    """Stands before the application."""

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self._app = app
        self._token = token.encode()
        self._cookie = f"rkm04_token_{port}"
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self._origins = {f"http://{host}" for host in self._hosts}
        sockets = " ".join(sorted(f"ws://{host}" for host in self._hosts))
        self._policy = POLICY.format(sockets=sockets)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] == "lifespan" or self._may_pass(scope):
            await self._app(scope, receive, self._sender(scope, send))
        elif scope["type"] == "websocket":
            await WebSocketClose()(scope, receive, send)
        else:
            refusal = PlainTextResponse(
                "This page needs the address that tools/rkm04 service has printed.\n", 403
            )
            await refusal(scope, receive, send)

    def _may_pass(self, scope: Scope) -> bool:
        headers = Headers(scope=scope)
        origin = headers.get("origin")
        return (
            headers.get("host", "") in self._hosts
            and (origin is None or origin in self._origins)
            and any(map(self._is_token, [_query_token(scope), self._cookie_token(headers)]))
        )

    def _is_token(self, given: str) -> bool:
        return secrets.compare_digest(given.encode("utf-8", "replace"), self._token)

    def _cookie_token(self, headers: Headers) -> str:
        try:
            morsel = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return ""
        value: str = morsel.value if morsel else ""
        return value

    def _sender(self, scope: Scope, send: Send) -> Send:
        """Add what every answer has, and to the page the cookie by which it is known."""

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers["Content-Security-Policy"] = self._policy
                headers["Referrer-Policy"] = "no-referrer"
                headers["X-Content-Type-Options"] = "nosniff"
                headers["Cache-Control"] = "no-cache"
                if scope["path"] == "/":
                    value = f"{self._cookie}={self._token.decode()}"
                    headers["Set-Cookie"] = f"{value}; HttpOnly; SameSite=Strict; Path=/"
            await send(message)

        return send_with_headers


def _query_token(scope: Scope) -> str:
    query = str(scope.get("query_string", b""), "latin-1")
    return parse_qs(query).get("token", [""])[0]
