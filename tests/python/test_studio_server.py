"""The server of plica studio: what it gives, and what it refuses."""
import asyncio
import json
import os
import socket
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from test_studio import wait

import plica

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")
client = pytest.importorskip("websockets.sync.client")

from plica.studio.server import PAGE, Page  # noqa: E402


@pytest.fixture
def studio(tmp_path):
    if not PAGE.exists():
        pytest.skip("built without the viewer")
    made = plica.studio("furrow-slice", folder=tmp_path, threads=1)
    wait(lambda: _status(made.url) == 200)
    yield made
    made.stop()


def _status(url, **headers):
    try:
        with urllib.request.urlopen(urllib.request.Request(url, headers=headers), timeout=60) as answer:
            return answer.status
    except urllib.error.HTTPError as error:
        return error.code
    except OSError:
        return 0


def _address(studio):
    head, _, token = studio.url.partition("/?token=")
    return head, token


def _connected(studio, token=None, origin=None):
    head, own = _address(studio)
    return client.connect(f"{head.replace('http', 'ws')}/ws?token={own if token is None else token}", origin=head
        if origin is None else origin,
                          max_size=None, open_timeout=60)


def _ask(page, name, given=None, number=1):
    page.send(json.dumps({"id": number, "do": name, "with": given or {}}))
    while True:
        message = page.recv(timeout=60)
        if isinstance(message, str) and json.loads(message).get("id") == number:
            return json.loads(message)


def test_the_page_asks_for_nothing_outside(studio):
    with urllib.request.urlopen(studio.url) as answer:
        html, policy = answer.read().decode(), answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "connect-src 'self'" in policy
    assert len(html) < 1e6
    assert 'src="http' not in html and "@import" not in html


def test_only_this_machine_with_its_token_is_served(studio):
    head, token = _address(studio)
    port = head.rpartition(":")[2]
    assert _status(f"{head}/?token={token}", Host=f"localhost:{port}") == 200
    for url, headers in [(f"{head}/", {}), (f"{head}/?token=", {}), (f"{head}/?token={token[:-1]}", {}),
        (f"{head}/?token={token}x", {}),
                         (f"{head}/?token={token}", {"Host": f"evil.example:{port}"}),
                         (f"{head}/?token={token}", {"Host": "127.0.0.1"}),
                         (f"{head}/?token={token}", {"Origin": "https://evil.example"}),
                         (f"{head}/take/0/scenario.toml", {})]:
        assert _status(url, **headers) == 403, (url, headers)
    assert _status(f"{head}/take/0/scenario.toml?token={token}") == 200
    for path in ("/take/0/..%2f..%2fetc%2fpasswd", "/take/0/session.json", "/take/99/scenario.toml",
        "/.plica-studio/address"):
        assert _status(f"{head}{path}?token={token}") == 404, path
    for wrong in [{"token": ""}, {"token": "x" * 5000}, {"origin": "https://evil.example"}, {"origin": "null"}]:
        with pytest.raises(Exception):
            _connected(studio, **wrong).recv(timeout=60)
    with socket.socket(type=socket.SOCK_DGRAM) as probe, socket.socket() as other:  # listens on the loopback only
        if probe.connect_ex(("192.0.2.1", 9)) == 0:  # tells this machine's address; nothing is sent
            assert other.connect_ex((probe.getsockname()[0], int(port))) != 0


def test_every_built_in_scenario_has_a_picture(studio):
    head, token = _address(studio)
    for name in plica.builtin_scenarios():
        with urllib.request.urlopen(f"{head}/card/{name}?token={token}") as answer:
            assert answer.read(8) == b"\x89PNG\r\n\x1a\n" and answer.headers["Content-Type"] == "image/png", name
    for name in ("none", "..%2fpage", "cards"):
        assert _status(f"{head}/card/{name}?token={token}") == 404
    assert _status(f"{head}/card/drosophila") == 403


def test_huge_and_malformed_messages_leave_the_session_as_it_was(studio):
    with _connected(studio) as page:
        before = _ask(page, "gallery")
        for number, text in enumerate(["", "null", "[]", "{}", '{"do": 3}', '{"do": "order"}', '{"do": "__init__"}',
            '{"do": "set"}', "[" * 100_000,
                                       '{"do": "set", "with": {"changes": []}}', '{"do": "set", "with": {"changes": {"": {"": 1}}}}',
                                       '{"do": "look", "with": {"slot": "x"}}', '{"do": "look", "with": {"slot": 0, "run": 1e999, "field": 0}}',
                                       '{"do": "act", "with": {"run": 1, "at_s": NaN, "kind": [], "cells": 1}}',
                                       '{"do": "paint", "with": {"region": "r", "ids": [1e99]}}',
                                       '{"do": "look", "with": {"slot": 0, "run": 0, "field": "x", "shapes": 7}}'], 10):
            page.send(text)
            assert "ok" in _ask(page, "gallery", number=number)
        assert _ask(page, "gallery")["ok"]["scenarios"] == before["ok"]["scenarios"]
    with pytest.raises(Exception):
        with _connected(studio) as page:
            page.send("x" * 3_000_000)
            while True:
                page.recv(timeout=60)
    with _connected(studio) as page:
        page.send(b"\x00\x01")
    with _connected(studio) as page:
        assert "ok" in _ask(page, "gallery")


def test_fifty_connections_do_no_harm(studio):
    pages, refused = [], 0
    for _ in range(50):
        try:
            page = _connected(studio)
            page.recv(timeout=60)
            pages.append(page)
        except Exception:
            refused += 1
    assert refused >= 30 and pages and "ok" in _ask(pages[0], "gallery")
    for page in pages:
        page.close()
    wait(lambda: not studio._server.pages)
    with _connected(studio) as page:
        assert "ok" in _ask(page, "gallery")


def test_two_pages_see_one_session(studio):
    with _connected(studio) as one, _connected(studio) as two:
        assert "ok" in _ask(one, "set", {"changes": {"cortex.apical.tension_mN_per_m": "1.7"}})
        while True:
            message = two.recv(timeout=60)
            draft = json.loads(message).get("draft") if isinstance(message, str) else None
            if draft and draft["table"]["cortex"]["apical"]["tension_mN_per_m"] == 1.7:
                break
        assert "problem" in _ask(two, "set", {"changes": {"cortex.apical.tension_mN_per_m": "-2"}})
        problem = _ask(two, "check", {"changes": {"cortex.apical.tension_mN_per_m": "much"}})["problem"]
        assert problem["by_key"][0]["key"] == "cortex.apical.tension_mN_per_m" and "number" in problem["by_key"][0]["text"]


def test_frames_come_over_the_connection(studio):
    with _connected(studio) as page:
        number = _ask(page, "start", {"until_s": 30})["ok"]["run"]
        page.send(json.dumps({"do": "look", "with": {"slot": 0, "run": number, "field": "area-ratio", "at_s": None,
            "known": -1, "rows": 0, "shapes": []}}))
        heads = []
        while len(heads) < 2:
            message = page.recv(timeout=60)
            if isinstance(message, bytes):
                length = int.from_bytes(message[:4], "little")
                heads.append((json.loads(message[4 : 4 + length]), message[4 + length :]))
        (shape, _), (frame, body) = heads
        assert shape["kind"] == "shape" and frame["kind"] == "frame" and frame["run"] == number
        assert len(body) == 4 * sum(count for _, _,
            count in frame["arrays"]) == 4 * (3 * shape["nodes"] + shape["cells"])


def test_a_frame_that_cannot_be_read_yet_is_sent_at_the_next_change():
    """While a resumed run drops frames, the page waits for one: forgotten, it would wait for ever."""
    sent, answers = [], iter([IndexError("dropped"), [b"frame"]])

    class Runs:
        def frame_messages(self, want):
            answer = next(answers)
            if isinstance(answer, Exception):
                raise answer
            return answer

    class Socket:
        async def send_bytes(self, message):
            sent.append(message)

    async def push():
        page = Page(Socket(), Runs())
        page._send_states = lambda: asyncio.sleep(0)
        page.wants[0] = {"run": 1, "field": "region"}
        pushing = asyncio.create_task(page._push())
        for _ in range(100):
            page.wake.set()
            await asyncio.sleep(0.01)
        pushing.cancel()

    asyncio.run(push())
    assert sent == [b"frame"]


def test_a_second_studio_names_the_first(studio, tmp_path):
    with pytest.raises(plica.PlicaError, match="open studio"):
        plica.studio(folder=tmp_path)
    assert os.stat(tmp_path / ".plica-studio" / "address").st_mode & 0o077 == 0
    assert Path(tmp_path / ".plica-studio").stat().st_mode & 0o077 == 0
    assert studio.url in studio._repr_html_()
