# SPDX-License-Identifier: Apache-2.0
"""Who may open the browser viewer: a foreign page, a foreign name and a stranger may not."""

import http.client
import shutil
from urllib.parse import urlsplit

import pytest

from volcontact.view import Stage
from volcontact.view.guard import Guard, is_loopback

pytest.importorskip("viser")
SCENE = '<mujoco><worldbody><geom type="plane" size="1 1 1"/></worldbody></mujoco>'


@pytest.fixture(scope="module", params=["127.0.0.1", "0.0.0.0"])
def page(request):
    from volcontact.view.browser import Page

    with Stage(SCENE) as stage, Page(stage, host=request.param, port=8234) as page:
        yield page


def port_of(page):
    return urlsplit(page.address).port


def query_of(page):
    return "/?" + urlsplit(page.address).query


def get(page, path, headers):
    """Status and headers of one request, sent as it is."""
    connection = http.client.HTTPConnection("127.0.0.1", port_of(page), timeout=30)
    connection.putrequest("GET", path, skip_host=True)
    for name, value in headers:
        connection.putheader(name, value)
    connection.endheaders()
    response = connection.getresponse()
    response.read()
    connection.close()
    return response.status, response.headers


def connects(page, origin, host, path="/", cookie=None):
    """The HTTP status of a websocket's handshake; 101 is an open one."""
    headers = [
        *([("Host", host)] if host else []),
        *([("Origin", origin)] if origin else []),
        *([("Cookie", cookie)] if cookie else []),
        ("Upgrade", "websocket"),
        ("Connection", "Upgrade"),
        ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
        ("Sec-WebSocket-Version", "13"),
    ]
    connection = http.client.HTTPConnection("127.0.0.1", port_of(page), timeout=30)
    connection.putrequest("GET", path, skip_host=True)
    for name, value in headers:
        connection.putheader(name, value)
    connection.endheaders()
    status = connection.getresponse().status
    connection.close()
    return status


def cookie_of(page):
    """What the browser keeps after it has opened the address; None without a token."""
    host = f"localhost:{port_of(page)}"
    status, headers = get(page, query_of(page), [("Host", host)])
    assert status == 200
    kept = headers["Set-Cookie"]
    return kept.split(";")[0] if kept else None


def test_own_page_is_served_and_connects(page):
    for name in ("localhost", "127.0.0.1", "[::1]"):
        host = f"{name}:{port_of(page)}"
        assert connects(page, f"http://{host}", host, cookie=cookie_of(page)) == 101


FOREIGN = ("http://evil.example", "http://localhost:1", "null", "file://", "http://evil.example:{}")


@pytest.mark.parametrize("origin", FOREIGN)
def test_foreign_pages_are_refused(page, origin):
    host, cookie = f"localhost:{port_of(page)}", cookie_of(page)
    origin = origin.format(port_of(page))
    assert connects(page, origin, host, cookie=cookie) == 403
    headers = [("Host", host), ("Origin", origin), *([("Cookie", cookie)] if cookie else [])]
    assert get(page, query_of(page), headers)[0] == 403


def test_names_that_others_gave_our_address_are_refused(page):
    """The site's own name then has its page as origin and our address: both agree."""
    host = f"evil.example:{port_of(page)}"
    assert connects(page, f"http://{host}", host) == 403
    assert get(page, "/", [("Host", host)])[0] == 403
    assert get(page, "/", [])[0] in (400, 403)
    ours = f"localhost:{port_of(page)}"
    assert get(page, "/", [("Host", ours), ("Host", ours)])[0] in (400, 403)


@pytest.mark.parametrize("page", ["0.0.0.0"], indirect=True)
def test_others_need_the_token(page):
    host = f"robot.local:{port_of(page)}"
    for wrong in ("/", "/?token=", "/?token=wrong", "/index.html?token=%ff"):
        assert get(page, wrong, [("Host", host)])[0] == 403
        assert connects(page, f"http://{host}", host, path=wrong) == 403
    assert connects(page, f"http://{host}", host, cookie="volcontact_token=wrong") == 403
    assert connects(page, f"http://{host}", host, cookie=cookie_of(page)) == 101
    assert get(page, query_of(page), [("Host", host)])[0] == 200


def test_tokens_are_long_and_never_the_same():
    tokens = {Guard("0.0.0.0").token for _ in range(20)}
    assert len(tokens) == 20 and all(len(token) >= 24 for token in tokens)
    assert Guard("::1").token == Guard("127.8.8.8").token == Guard("localhost").token == ""


@pytest.mark.parametrize("host", ["", "0.0.0.0", "::", "192.168.0.7", "robot", "127.0.0.1.example"])
def test_all_else_is_not_the_loopback_address(host):
    assert not is_loopback(host)


def test_a_server_that_cannot_be_guarded_is_not_left_open(monkeypatch):
    import viser

    from volcontact.view.browser import Page

    stopped = []

    class Unguarded:
        def __init__(self, **_):
            pass

        def stop(self):
            stopped.append(self)

    monkeypatch.setattr(viser, "ViserServer", Unguarded)
    with Stage(SCENE) as stage, pytest.raises(RuntimeError, match="cannot guard"):
        Page(stage, port=8345)
    assert len(stopped) == 1


@pytest.mark.once
@pytest.mark.skipif(shutil.which("chromium") is None, reason="chromium is not installed")
@pytest.mark.parametrize("page", ["0.0.0.0"], indirect=True)
def test_the_browser_keeps_the_token(page):
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as programs:
        options = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        browser = programs.chromium.launch(executable_path=shutil.which("chromium"), args=options)
        shown = browser.new_page()
        shown.set_default_timeout(90e3)
        shown.goto(page.address)
        shown.get_by_text("One step").wait_for()  # sent by the websocket
        browser.close()
