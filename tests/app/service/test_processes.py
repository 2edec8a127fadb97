"""The service as a real process: it starts, stops by a signal, and loses nothing that it acknowledged."""

import contextlib
import http.client
import itertools
import json
import os
import random
import signal
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from lifelore.agent.personalise.identifiers import parse_identifier
from lifelore.agent.personalise.study import open_study
from lifelore.memory import open_memory

SOAK_KILLS = int(os.environ.get("LIFELORE_SOAK_KILLS", "50"))
CLIENTS = 8


class Client:
    """A connection of its own that asks one request after the other."""

    def __init__(self, url: str) -> None:
        host, port = url.removeprefix("http://").split(":")
        self._connection = http.client.HTTPConnection(host, int(port), timeout=60)

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *error: object) -> None:
        self._connection.close()

    def ask(self, method: str, path: str, document: Any = None) -> Any:
        body = None if document is None else json.dumps(document)
        self._connection.request(method, path, body, {"Content-Type": "application/json"})
        answer = self._connection.getresponse()
        content = answer.read()
        assert answer.status == 200, content
        return json.loads(content)


@pytest.fixture
def started(start, tmp_path):
    """Start the service over a memory; the process and its URL."""

    def started(memory: Path, *options: object):
        with (tmp_path / "log").open("a") as log:
            child = start("serve", "--port", 0, "--rate", 0, "--memory", memory, "--json", *options, stderr=log)
        return child, json.loads(child.stdout.readline())["url"]

    return started


def test_it_serves_and_stops_by_a_signal(started, study, tmp_path):
    memory = tmp_path / "lifelore.db"
    for number, stop, status in ((0, signal.SIGTERM, 0), (1, signal.SIGINT, 130)):
        child, url = started(memory, "--access-log")
        with Client(url) as client:
            client.ask("PUT", "/v1/studies/s", study)
            client.ask("POST", "/v1/studies/s/decisions", {"user": "ada"})
            assert client.ask("GET", "/v1/studies/s/user?name=ada")["decisions"] == number + 1
        child.send_signal(stop)
        assert child.wait(60) == status
    lines = [json.loads(line) for line in (tmp_path / "log").read_text().splitlines() if line.startswith("{")]
    assert [one["status"] for one in lines if one["message"] == "request"] == [200] * 6


@pytest.mark.parametrize("inherited", [signal.SIG_IGN, signal.SIG_DFL], ids=["ignored", "default"])
def test_its_status_after_sigint_does_not_depend_on_the_shell(start, tmp_path, inherited):
    """A job in the background of a shell, and under nohup, inherits an ignored SIGINT."""
    child = start(
        "serve", "--port", 0, "--memory", tmp_path / "lifelore.db", "--json",
        preexec_fn=lambda: signal.signal(signal.SIGINT, inherited),
    )  # fmt: skip
    child.stdout.readline()
    child.send_signal(signal.SIGINT)
    assert child.wait(60) == 130


def test_a_host_that_others_reach_needs_tokens(ask):
    assert "must be 127.0.0.1 without tokens" in ask("serve", "--host", "0.0.0.0").refusal


def test_a_taken_port_is_refused(started, ask, tmp_path):
    _, url = started(tmp_path / "lifelore.db")
    port = url.rpartition(":")[2]
    refusal = ask("serve", "--port", port, "--memory", tmp_path / "other.db").refusal
    assert f"port {port} of 127.0.0.1 cannot be used" in refusal


def test_a_new_token_is_printed_once(ask, tmp_path):
    answer = ask("serve", "--add-token", "shop", "--token-file", tmp_path / "tokens", "--json").document
    assert set(answer) == {"name", "token"}
    assert answer["token"] not in (tmp_path / "tokens").read_text()


def load(url: str, name: str, acknowledged: list[tuple[dict, float | None]]) -> None:
    """Decide and observe until the service is gone; note what it acknowledged."""
    with contextlib.suppress(OSError, http.client.HTTPException), Client(url) as client:
        for number in itertools.count():
            user = f"{name} {number % 5}"
            made = client.ask("POST", "/v1/studies/s/decisions", {"user": user, "request": f"{name}/{number}"})
            acknowledged.append((made, None))
            ended = client.ask("POST", "/v1/studies/s/outcomes", {"decision": made["decision"], "outcome": number})
            assert ended["taken"]
            acknowledged[-1] = (made, float(number))
            if number % 5 == 0:
                items = [{"user": user, "request": f"{name}/{number}/batch"}, {"user": f"{user}'s friend"}]
                answers = client.ask("POST", "/v1/studies/s/decisions/batch", {"items": items})["items"]
                acknowledged += [(answer, None) for answer in answers]


def killed_under_load(started, memory: Path, run: int, seconds: float) -> list[tuple[dict, float | None]]:
    child, url = started(memory)
    notes: list[list[tuple[dict, float | None]]] = [[] for _ in range(CLIENTS)]
    clients = [
        threading.Thread(target=load, args=(url, f"run {run} client {number}", note))
        for number, note in enumerate(notes)
    ]
    for client in clients:
        client.start()
    while not any(outcome is not None for note in notes for _, outcome in note):
        assert child.poll() is None
        time.sleep(0.01)
    time.sleep(seconds)
    child.kill()
    child.wait()
    for client in clients:
        client.join()
    return [one for note in notes for one in note]


def kill_loop(started, study, memory: Path, kills: int, seed: int) -> None:
    """After every kill, each acknowledged decision and outcome of all runs is in a sound memory."""
    child, url = started(memory)
    with Client(url) as client:
        client.ask("PUT", "/v1/studies/s", study)
    child.terminate()
    child.wait()
    draw, acknowledged = random.Random(seed), []
    for run in range(kills):
        acknowledged += killed_under_load(started, memory, run, draw.uniform(0.0, 0.5))
        with open_memory(memory) as opened:
            assert opened.check() == []
            assert_stored(opened, acknowledged)
    assert any(outcome is not None for _, outcome in acknowledged)


def stored_decisions(memory, made):
    study = open_study(memory, "s")
    with memory.studies.reading(study.number) as rows:
        return rows.decisions([parse_identifier(one["decision"]) for one in made])


def assert_stored(memory, acknowledged) -> None:
    stored = stored_decisions(memory, [made for made, _ in acknowledged])
    for made, outcome in acknowledged:
        decision = stored[parse_identifier(made["decision"])]
        assert (decision.policy, decision.probability) == (made["policy"], made["probability"])
        if outcome is not None:
            assert decision.outcome == outcome


def test_kills_under_load_lose_nothing_acknowledged(started, study, tmp_path):
    kill_loop(started, study, tmp_path / "lifelore.db", kills=2, seed=4)


@pytest.mark.soak
def test_soak_kills_under_load(started, study, tmp_path):
    kill_loop(started, study, tmp_path / "lifelore.db", kills=SOAK_KILLS, seed=50)
