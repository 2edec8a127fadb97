"""The Python client through kills of the real service: every call is answered, every outcome counts once."""

import json
import os
import random
import threading
import time

import pytest

from lifelore.agent.personalise.decision_log import log_parts
from lifelore.agent.personalise.study import open_study
from lifelore.bridges.study_client import StudyClient
from lifelore.memory import open_memory
from tests.bridges.service_stand_in import free_port

SOAK_KILLS = int(os.environ.get("LIFELORE_SOAK_KILLS", "200"))
SOAK_CALLS = int(os.environ.get("LIFELORE_SOAK_CALLS", "100000"))
THREADS = 4


@pytest.fixture
def served(start, study, tmp_path):
    """Start the service again and again over one memory and one port; the memory, the URL and the start."""
    port, memory = free_port(), tmp_path / "lifelore.db"

    def again():
        with (tmp_path / "log").open("a") as log:
            child = start("serve", "--port", port, "--rate", 0, "--memory", memory, "--json", stderr=log)
        child.stdout.readline()
        return child

    return memory, f"http://127.0.0.1:{port}", again


def through_kills(
    served, study, tmp_path, kills: int, calls: int, pause: float = 0.005
) -> tuple[int, dict[str, float]]:
    """Number of calls that were answered, and what the client counts; an outage follows each kill.

    Each thread pauses between calls, so that the outcomes of an outage fit the client's queue.
    """
    memory, url, again = served
    child, answered, slowest, stop = again(), [], [0.0], threading.Event()
    register(url, study)
    with StudyClient(url, "s", fallback="slow", queue=tmp_path / "queue.db", timeout=1.0) as client:

        def work(number: int) -> None:
            while not stop.is_set():
                begun = time.perf_counter()
                choice = client.decide(f"user {number} {len(answered) % 50}")
                slowest[0] = max(slowest[0], time.perf_counter() - begun)
                client.observe(choice, 1.0)
                answered.append(choice.decision)
                time.sleep(pause)

        workers = [threading.Thread(target=work, args=(number,)) for number in range(THREADS)]
        for worker in workers:
            worker.start()
        draw = random.Random(3)
        for _ in range(kills):
            time.sleep(draw.uniform(0.1, 0.6))
            child.kill()
            child.wait()
            time.sleep(draw.uniform(0.0, 0.3))
            child = again()
        while len(answered) < calls:
            time.sleep(0.1)
        stop.set()
        for worker in workers:
            worker.join()
        assert client.flush(120)
        counts = client.counts()
    assert counts["lost"] == 0
    assert slowest[0] < 20.0, "the timeout is 1 s"
    child.terminate()
    child.wait()
    with open_memory(memory) as opened:
        opened_study = open_study(opened, "s")
        log = [
            json.loads(line) for part in log_parts(opened, opened_study, "ndjson") for line in part.splitlines()
        ]
        with opened.studies.reading(opened_study.number) as rows:
            query = "SELECT COUNT(*) FROM lifelore_study_past WHERE study = ?"
            n_past = rows._conn.value(query, (opened_study.number,))
        stored = sum(one["outcome"] is not None for one in log) + n_past
        assert opened.check() == []
    assert len(set(answered)) == len(answered)
    assert stored == len(answered)
    return len(answered), counts


def register(url: str, study) -> None:
    import http.client

    connection = http.client.HTTPConnection(url.removeprefix("http://"))
    connection.request("PUT", "/v1/studies/s", json.dumps(study), {"content-type": "application/json"})
    assert connection.getresponse().status == 200
    connection.close()


def test_outcomes_count_once_through_kills(served, study, tmp_path):
    answered, counts = through_kills(served, study, tmp_path, kills=2, calls=500)
    assert counts["service"] > 0
    assert counts["service"] < answered  # both ways were taken


@pytest.mark.soak
def test_soak_a_client_through_kills(served, study, tmp_path):
    answered, counts = through_kills(served, study, tmp_path, SOAK_KILLS, SOAK_CALLS, pause=0.02)
    print(answered, counts)
    assert answered >= SOAK_CALLS
