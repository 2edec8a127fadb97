"""A small service with the routes of a study that the client uses; it can be killed and started again."""

import contextlib
import json
import random
import socket
import ssl
import struct
import threading
import time
import uuid
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, unquote, urlsplit

STUDY = "playlists"
POLICIES = {"slow": 0.75, "fast": 0.25}
CONTEXTS = {"night": {"slow": 1.0, "fast": 0.0}}


class Refusal(Exception):
    """A request that breaks a rule."""

    def __init__(self, status: int, kind: str, message: str) -> None:
        super().__init__(message)
        self.status, self.document = status, {"error": {"kind": kind, "message": message}}


class State:
    """The rows of a study, which stay when the service is killed."""

    def __init__(self) -> None:
        self.decisions: dict[str, dict[str, Any]] = {}
        self.requests: dict[tuple[str, str], str] = {}
        self.outcomes: dict[str, float] = {}
        self.past: dict[str, dict[str, Any]] = {}
        self.lock = threading.Lock()

    def store(self, kind: str, row: dict[str, Any]) -> None:
        if kind == "decision":
            self.decisions[row["decision"]] = row
            if "request" in row:
                self.requests[row["user"], row["request"]] = row["decision"]
        elif kind == "outcome":
            self.outcomes[row["decision"]] = row["outcome"]
        elif kind == "past":
            self.past[row["id"]] = row
        else:
            gone = {key for key, one in self.decisions.items() if one["user"] == row["user"]}
            for key in gone:
                self.decisions.pop(key)
                self.outcomes.pop(key, None)
            self.past = {key: one for key, one in self.past.items() if one["user"] != row["user"]}

    def decide(self, item: dict[str, Any]) -> dict[str, Any]:
        user = item["user"]
        if len(user) > 200:
            raise Refusal(422, "input", f"user must have at most 200 characters, got {len(user)}")
        known = self.requests.get((user, item["request"])) if "request" in item else None
        if known:
            return self.decisions[known] | {"repeated": True}
        probabilities = CONTEXTS.get(item.get("context", ""), POLICIES)
        policy = random.choices(list(probabilities), list(probabilities.values()))[0]
        made = {"decision": str(uuid.uuid4()), "policy": policy, "probability": probabilities[policy]}
        self.store("decision", item | made)
        return item | made | {"control": False, "probabilities": probabilities, "repeated": False}

    def observe(self, item: dict[str, Any]) -> dict[str, Any]:
        key, outcome = item["decision"], item["outcome"]
        if key not in self.decisions:
            raise Refusal(404, "not found", "no decision has this identifier")
        if key in self.outcomes:
            if self.outcomes[key] != outcome:
                raise Refusal(422, "input", "the decision has another outcome already")
            return {"taken": False}
        self.store("outcome", item)
        return {"taken": True}

    def add_past(self, items: list[dict[str, Any]]) -> dict[str, Any]:
        if any(item["policy"] not in POLICIES for item in items):
            raise Refusal(422, "input", "policy must be one of the study")
        new = [item for item in items if item["id"] not in self.past]
        for item in new:
            self.store("past", item)
        return {"rows": len(new), "known": len(items) - len(new)}

    def forget(self, user: str) -> dict[str, Any]:
        if user not in {row["user"] for row in (*self.decisions.values(), *self.past.values())}:
            raise Refusal(404, "not found", f"nothing is stored of user {user!r}")
        self.store("forget", {"user": user})
        return {"user": user, "forgotten": True}

    def report(self) -> dict[str, Any]:
        uplift = {"value": 0.0, "ci95": [0.0, 0.0], "n": 0}  # nothing is estimated here
        pending = len(self.decisions) - len(self.outcomes)
        return {"decisions": len(self.decisions), "pending": pending, "uplift": uplift}


class Server(ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 128
    state: State
    stand_in: "StandIn"

    def process_request(self, request: Any, client_address: Any) -> None:
        self.stand_in.sockets.add(request)
        super().process_request(request, client_address)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Clients end, and so do killed connections."""


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    server: Server
    asked_here = 0

    def log_message(self, *arguments: Any) -> None:
        pass

    def answer(self) -> None:
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        stand_in = self.server.stand_in
        stand_in.asked += 1
        if stand_in.mode == "hang":
            stand_in.woken.wait(30)
        self.asked_here += 1
        if stand_in.mode == "close second" and self.asked_here > 1:
            self.close_connection = True
            return
        try:
            status, document = 200, self.result(json.loads(body) if body else None)
        except Refusal as error:
            status, document = error.status, error.document
        if stand_in.dead:  # stored, but not acknowledged
            self.close_connection = True
            return
        if stand_in.mode == "broken":
            status, document = 503, {"error": {"kind": "store", "message": "the memory refuses"}}
        content = json.dumps(document).encode()
        if stand_in.mode == "proxy":
            status, content = 404, b"<html>no such host</html>"
        head = f"HTTP/1.1 {status} X\r\nContent-Length: {len(content)}\r\n\r\n".encode()
        if stand_in.mode == "drip":
            for byte in head + content:
                self.wfile.write(bytes([byte]))
                time.sleep(0.02)
        else:
            self.wfile.write(head + content)

    do_GET = do_POST = do_DELETE = answer

    def result(self, document: Any) -> dict[str, Any]:
        parts = urlsplit(self.path)
        *_, study, route = parts.path.removeprefix("/v1/studies/").replace("s/batch", "s-batch").split("/")
        stand_in = self.server.stand_in
        if stand_in.token and self.headers["Authorization"] != f"Bearer {stand_in.token}":
            raise Refusal(401, "token", "a token is needed")
        if unquote(study) != STUDY or stand_in.mode == "no study":
            raise Refusal(404, "not found", f"no study has the name {unquote(study)!r}")
        state = self.server.state
        with state.lock:
            if route == "decisions":
                return state.decide(document)
            if route == "outcomes":
                return state.observe(document)
            if route.endswith("-batch"):
                one = state.decide if route.startswith("decisions") else state.observe
                return {"items": [self.each(one, item) for item in document["items"]]}
            if route == "past":
                return state.add_past(document["items"])
            if route == "user":
                return state.forget(parse_qs(parts.query)["name"][0])
            if route == "table":
                return {"study": STUDY, "version": 1, "default": POLICIES, "contexts": CONTEXTS}
            return state.report()

    def each(self, one: Any, item: dict[str, Any]) -> dict[str, Any]:
        try:
            if self.server.stand_in.mode == "full disk":
                raise Refusal(503, "store", "the disk is full")
            return one(item)
        except Refusal as error:
            return error.document


def free_port() -> int:
    """A port below those of outgoing connections, so that none of them takes it while the service is down."""
    for port in random.SystemRandom().sample(range(20_000, 32_000), 50):
        with contextlib.suppress(OSError), socket.socket() as probe:
            probe.bind(("127.0.0.1", port))
            return port
    raise AssertionError("50 ports are taken")


class StandIn:
    """The service in threads of this process; `mode` is how it answers.

    Modes: well, hang, drip (a byte at a time), broken (503), proxy (a page of another program), full disk (an
    error for each item of a batch), no study, close second (a connection serves a single request without warning).
    """

    def __init__(self) -> None:
        self.state, self._port = State(), free_port()
        self.mode, self.token, self.asked, self.dead = "well", "", 0, True
        self.tls: ssl.SSLContext | None = None
        self.sockets: set[socket.socket] = set()
        self.woken = threading.Event()
        self.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._port}"

    def start(self) -> None:
        self._server = Server(("127.0.0.1", self._port), Handler)
        self._server.stand_in, self._server.state = self, self.state
        if self.tls:
            self._server.socket = self.tls.wrap_socket(self._server.socket, server_side=True)
        self.dead = False
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.005,), daemon=True)
        self._thread.start()

    def kill(self) -> None:
        """End at once: requests in progress get no answer, whether or not they are stored."""
        if self.dead:
            return
        self.dead = True
        self._server.shutdown()
        self._server.server_close()
        for one in self.sockets:
            try:
                one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                one.shutdown(socket.SHUT_RDWR)
                one.close()
            except OSError:
                continue
        self.sockets.clear()
        self._thread.join()
