"""Routes and socket of the page /play, without a browser: blinding, pace, wrong messages, lost connections."""

import json
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from lifelore.app.pages.mount import app_with_pages
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.tokens import add_token
from lifelore.domains.ball_game.ball_game import SIZES, ball_game
from lifelore.domains.ball_game.simulated_player import choose_heading

HOST = "ws://127.0.0.1"
FIELD = ball_game().field
CONSENT = {"consent": True, "length": "short", "player": "scripted", "frames_per_move": 1}


@pytest.fixture
def client(tmp_path) -> Iterator[TestClient]:
    with TestClient(
        app_with_pages(ServiceSettings(str(tmp_path / "m.db"), rate=0.0)), base_url="http://127.0.0.1"
    ) as client:
        yield client


def live(client: TestClient, session: str):
    return client.websocket_connect(f"{HOST}/v1/play/sessions/{session}/live", subprotocols=["lifelore"])


def play(socket: Any, wish: dict[str, Any]) -> dict[str, Any]:
    """Play a round by the script over the socket; its last message."""
    socket.send_json(wish)
    scene = socket.receive_json()
    assert scene["kind"] == "scene"
    kind, place, heading = SIZES.index(scene["size"]), (scene["x"], scene["y"]), None
    while True:
        wanted = int(choose_heading(FIELD, kind, round(place[0]), round(place[1]), 50))
        if wanted != heading:
            heading = wanted
            socket.send_json({"do": "steer", "heading": heading})
        message = socket.receive_json()
        if message["kind"] != "frame":
            return message
        place = message["x"], message["y"]


def begin(client: TestClient, **changes: Any) -> str:
    answer = client.post("/v1/play/sessions", json=CONSENT | changes)
    assert answer.status_code == 200, answer.text
    return answer.json()["session"]


def test_a_round_is_stored_before_it_is_reported(client):
    session = begin(client)
    with live(client, session) as socket:
        over = play(socket, {"do": "begin"})
        assert over["kind"] == "over"
        assert over["recorded"]
        record = client.get(f"/v1/play/sessions/{session}/record").json()
        assert [row["moves"] for row in record["rounds"]] == [over["moves"]]
        assert over["session"]["number"] == 1
        socket.send_json({"do": "begin"})
        assert socket.receive_json()["kind"] == "scene"
    # The connection is lost in the second round: the first stays, the second begins again.
    assert client.get(f"/v1/play/sessions/{session}").json()["number"] == 1
    with live(client, session) as socket:
        assert play(socket, {"do": "begin"})["session"]["number"] == 2
    lines = client.get(f"/v1/play/sessions/{session}/record.csv").text.splitlines()
    assert len(lines) == 3
    assert client.delete(f"/v1/play/sessions/{session}").json() == {"session": session, "forgotten": 3}
    assert client.get(f"/v1/play/sessions/{session}").status_code == 404


def test_a_frame_comes_every_thirtieth_of_a_second(client):
    with live(client, begin(client, frames_per_move=5)) as socket:
        socket.send_json({"do": "begin"})
        socket.receive_json()
        arrivals = []
        for _ in range(46):
            assert socket.receive_json()["kind"] == "frame"
            arrivals.append(time.perf_counter())
    # Deadlines are absolute: 45 gaps take 1.5 s whatever each frame costs; a loaded machine may be later.
    assert 1.45 < arrivals[-1] - arrivals[0] < 2.5
    assert 0.028 < np.median(np.diff(arrivals)) < 0.045


def test_a_free_round_shows_its_belief_on_request_and_stores_nothing(client):
    with client.websocket_connect(f"{HOST}/v1/play/free/live", subprotocols=["lifelore"]) as socket:
        socket.send_json({"do": "free", "size": 40})
        assert socket.receive_json()["phase"] == "free"
        assert "belief" not in socket.receive_json()
        socket.send_json({"do": "belief", "show": True})
        frames = [socket.receive_json() for _ in range(5)]
        assert sum(frames[-1]["belief"].values()) == pytest.approx(1.0)
    assert client.get("/v1/play/results").json()["groups"] == []


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "do"),
        ("[]", "do"),
        ("[" * 900, "do"),
        ('{"do": "win"}', "do"),
        ('{"do": "begin", "x": "' + "y" * 2000 + '"}', "do"),
        ('{"do": "steer", "heading": 0}', "begin"),
        ('{"do": "free", "size": 3}', "size"),
        ('{"do": "free"}', "size"),
        ('{"do": "free", "size": [2]}', "size"),
    ],
)
def test_a_wrong_message_is_one_clear_line(client, text, words):
    with live(client, begin(client)) as socket:
        socket.send_text(text)
        answer = socket.receive_json()
        assert answer["kind"] == "error"
        assert words in answer["message"]
        assert "\n" not in answer["message"]
        socket.send_bytes(b"\x00\xff")
        assert socket.receive_json()["kind"] == "error"
        socket.send_json({"do": "begin"})
        assert socket.receive_json()["kind"] == "scene"
        socket.send_json({"do": "steer", "heading": 9})
        while (message := socket.receive_json())["kind"] == "frame":
            pass
        assert "heading" in message["message"]


def test_a_session_is_open_in_one_window(client):
    session = begin(client)
    with live(client, session) as first:
        # Sockets opened at the same moment may be served in either order: the first has to play already.
        first.send_json({"do": "begin"})
        assert first.receive_json()["kind"] == "scene"
        with live(client, session) as second:
            assert "another window" in second.receive_json()["message"]
            with pytest.raises(WebSocketDisconnect):
                second.receive_json()


def test_sockets_and_sessions_that_are_refused(client):
    with live(client, "nobody") as socket:
        assert "no session" in socket.receive_json()["message"]
    assert client.post("/v1/play/sessions", json=CONSENT | {"consent": False}).status_code == 422
    assert client.post("/v1/play/sessions", json=CONSENT | {"length": "long"}).status_code == 422
    assert client.post("/v1/play/sessions", json=CONSENT | {"frames_per_move": 0}).status_code == 422
    for path in ("", "/record", "/record.csv"):
        assert client.get(f"/v1/play/sessions/nobody{path}").status_code == 404
    assert client.delete("/v1/play/sessions/nobody").status_code == 404
    with (
        pytest.raises(WebSocketDisconnect),
        client.websocket_connect(f"{HOST}/v1/play/free/live", headers={"origin": "http://elsewhere.org"}),
    ):
        pass


def test_a_socket_needs_a_token_where_the_service_does(tmp_path):
    tokens = str(tmp_path / "tokens")
    read, write = (add_token(tokens, name, [name]) for name in ("read", "write"))
    settings = ServiceSettings(str(tmp_path / "m.db"), token_file=tokens)
    with TestClient(app_with_pages(settings), base_url="http://127.0.0.1") as client:
        for protocols in (["lifelore"], ["lifelore", f"bearer.{read}"], ["lifelore", "bearer.wrong"]):
            with (
                pytest.raises(WebSocketDisconnect),
                client.websocket_connect(f"{HOST}/v1/play/free/live", subprotocols=protocols),
            ):
                pass
        with client.websocket_connect(
            f"{HOST}/v1/play/free/live", subprotocols=["lifelore", f"bearer.{write}"]
        ) as socket:
            assert socket.accepted_subprotocol == "lifelore"
            socket.send_json({"do": "free", "size": 2})
            assert socket.receive_json()["kind"] == "scene"


def test_the_game_says_what_is_drawn_and_agreed_to(client):
    game = client.get("/v1/play/game").json()
    assert game["lengths"] == {"short": 16, "medium": 44, "thesis": 92}
    assert "not the approval of an ethics committee" in game["consent"]
    assert len(game["polygons"]) == 2
    assert json.dumps(game["sizes"]) == "[2, 5, 10, 20, 40, 60]"
