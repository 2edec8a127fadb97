"""The client of a study answers whatever happens to the service, and each outcome counts once."""

import json
import os
import re
import shutil
import signal
import socket
import ssl
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.bridges import study_client
from lifelore.bridges.study_client import REMEMBERED, Choice, ServiceUnavailable, StudyClient, _Queue

from .service_stand_in import POLICIES, STUDY, StandIn, State

ROOT = Path(__file__).parents[2]


@pytest.fixture
def service():
    service = StandIn()
    yield service
    service.woken.set()
    service.kill()


@pytest.fixture
def connect(service):
    """Make clients, which are closed at the end without waiting; answers may be slow on a busy machine."""
    clients = []

    def connect(**settings):
        default = {"url": service.url, "study": STUDY, "fallback": "slow", "timeout": 30.0}
        clients.append(StudyClient(**default | settings))
        return clients[-1]

    yield connect
    for client in clients:
        client.close(0)


def wait_until(holds, seconds=60.0):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.005)


def counted(state: State) -> dict[str, float]:
    """Outcome by identifier, of decisions of the service and of the past; no identifier is in both."""
    past = {key: row["outcome"] for key, row in state.past.items()}
    assert not past.keys() & state.outcomes.keys()
    return state.outcomes | past


def test_the_service_decides_and_learns(service, connect):
    client = connect()
    choice = client.decide("ada", context="night", request="monday")
    assert (choice.policy, choice.probability, choice.source) == ("slow", 1.0, "service")
    assert client.decide("ada", context="night", request="monday").decision == choice.decision
    client.observe(choice, 7.5)
    client.observe(choice.decision, 7.5)
    assert client.flush()
    assert counted(service.state) == {choice.decision: 7.5}
    assert client.report()["decisions"] == 1
    assert client.counts() == {
        "service": 2, "table": 0, "fallback": 0, "delivered": 2, "refused": 0, "lost": 0, "pending": 0,
    }  # fmt: skip


def test_all_arguments_reach_the_service(service, connect):
    choice = connect().decide("ä/%\n ada", "night", {"age": 3.5}, ["slow"], "r")
    row = service.state.decisions[choice.decision]
    assert {name: row[name] for name in ("user", "context", "features", "available", "request")} == {
        "user": "ä/%\n ada", "context": "night", "features": {"age": 3.5}, "available": ["slow"], "request": "r",
    }  # fmt: skip


# Without the service


def test_without_the_service_strangers_get_the_table(service, connect):
    client = connect(seed=0)
    wait_until(lambda: client._table)
    service.kill()
    choices = [client.decide(f"u{n}") for n in range(4000)]
    assert {one.source for one in choices} == {"table"}
    assert {(one.policy, one.probability) for one in choices} == set(POLICIES.items())
    # 4,000 draws of probability 0.25: four standard deviations are 0.027.
    assert statistics.mean(one.policy == "fast" for one in choices) == pytest.approx(0.25, abs=0.028)
    assert {client.decide(f"u{n}", context="night").policy for n in range(50)} == {"slow"}
    assert client.decide("ada", context="night", available=["fast"]).source == "fallback"
    only = client.decide("ada", available=["fast", "other"])
    assert (only.policy, only.probability) == ("fast", 1.0)


def test_without_the_service_a_known_user_gets_the_last_probabilities(service, connect):
    client = connect()
    wait_until(lambda: client._table)
    client.decide("ada")
    client._users.put(("ada", None), {"fast": 1.0})  # as if the belief about ada were sure
    service.kill()
    assert {client.decide("ada").policy for _ in range(50)} == {"fast"}
    assert {client.decide("ada", context="night").policy for _ in range(50)} == {"slow"}


def test_without_anything_there_is_the_fallback(connect):
    with socket.create_server(("127.0.0.1", 0)) as nobody:
        port = nobody.getsockname()[1]
    client = connect(url=f"http://127.0.0.1:{port}")
    choice = client.decide("ada")
    assert (choice.policy, choice.probability, choice.source) == ("slow", 1.0, "fallback")
    assert client.decide("ada", available=["other", "slow"]).policy == "slow"
    assert client.decide("ada", available=["other"]).policy == "other"
    assert connect(url="http://no-such-host.invalid", timeout=0.1).decide("ada").source == "fallback"


def test_without_a_fallback_the_client_starts_with_a_table(service, connect):
    client = connect(fallback=None)
    service.kill()
    assert client.decide("ada").source == "table"
    with pytest.raises(ServiceUnavailable):
        connect(fallback=None)


def test_the_same_request_gets_the_same_choice_in_another_client_too(service, connect):
    clients = [connect(seed=seed) for seed in range(2)]
    wait_until(lambda: all(client._table for client in clients))
    service.kill()
    for number in range(20):
        made = [client.decide("ada", request=f"r{number}") for client in clients]
        assert made[0].decision == made[1].decision
        assert made[0].policy == made[1].policy
    # 1,000 draws of probability 0.25: four standard deviations are 0.055.
    share = statistics.mean(clients[0].decide("ada", request=f"s{n}").policy == "fast" for n in range(1000))
    assert share == pytest.approx(0.25, abs=0.055)


def test_offline_outcomes_count_once_as_the_past(service, connect):
    client = connect()
    wait_until(lambda: client._table)
    service.kill()
    first, second = client.decide("ada", context="night"), client.decide("ben")
    client.observe(first, 1.0)
    client.observe(first, 1.0)
    client.observe(second.decision, 2.0)
    service.start()
    assert client.flush(10)
    assert counted(service.state) == {first.decision: 1.0, second.decision: 2.0}
    row = service.state.past[first.decision]
    assert (row["user"], row["policy"], row["context"]) == ("ada", first.policy, "night")
    assert abs(row["time"] - time.time()) < 60
    assert "context" not in service.state.past[second.decision]


@pytest.mark.parametrize("mode", ["hang", "drip"])
def test_a_service_that_hangs_costs_the_timeout_a_few_times(service, connect, mode):
    client = connect(timeout=0.1)
    wait_until(lambda: client._table)
    service.mode = mode
    took = []
    for number in range(20):
        start = time.perf_counter()
        assert client.decide(f"u{number}").source == "table"
        took.append(time.perf_counter() - start)
    assert max(took) < 2.5  # the timeout is 0.1 s; the answer would take 3 or 30 s
    assert sum(seconds > 0.1 for seconds in took) < 10  # three failures, and more on a busy machine
    service.mode = "well"
    service.woken.set()
    wait_until(lambda: client.decide("ada").source == "service")


@pytest.mark.parametrize("mode", ["broken", "proxy"])
def test_answers_that_are_none_are_not_the_callers_mistake(service, connect, mode):
    client = connect()
    wait_until(lambda: client._table)
    service.mode = mode
    assert [client.decide("ada").source for _ in range(5)] == ["table"] * 5
    service.mode = "well"
    wait_until(lambda: client.decide("ada").source == "service")


def test_a_connection_that_the_service_closed_is_replaced(service, connect):
    client = connect(timeout=5)
    wait_until(lambda: client._table)
    service.mode = "close second"
    assert [client.decide("ada").source for _ in range(20)] == ["service"] * 20


def test_a_call_costs_microseconds_while_the_service_is_gone(service, connect):
    client = connect()
    wait_until(lambda: client._table)
    service.kill()
    while client.decide("ada").source == "service" or not client._breaker.is_open:
        pass
    took = []
    for number in range(2000):
        start = time.perf_counter()
        client.decide(f"u{number}")
        took.append(time.perf_counter() - start)
    # Some 10 microseconds on a free machine; a call that opened a connection would take above 50.
    assert statistics.median(took) < 50e-6


@pytest.mark.slow
def test_a_single_call_tries_a_service_that_is_back(service, connect):
    client = connect(timeout=1.0)
    wait_until(lambda: client._table)
    service.kill()
    wait_until(lambda: (client.decide("ada"), client._breaker.is_open)[1])
    service.start()
    wait_until(lambda: not client._breaker.is_open)  # half open: the table came
    service.mode = "hang"
    took = []

    def call():
        start = time.perf_counter()
        client.decide("ada")
        took.append(time.perf_counter() - start)

    threads = [threading.Thread(target=call) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sum(seconds > 0.9 for seconds in took) == 1


def test_the_service_behind_tls(service, connect, tmp_path, monkeypatch):
    if shutil.which("openssl") is None:
        pytest.skip("needs openssl")
    files = [tmp_path / "key.pem", tmp_path / "certificate.pem"]
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost", "-days", "2"]
    command += ["-addext", "subjectAltName=DNS:localhost", "-keyout", files[0], "-out", files[1]]
    subprocess.run(command, check=True, capture_output=True)
    service.kill()
    service.tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    service.tls.load_cert_chain(files[1], files[0])
    service.start()
    url = service.url.replace("http://127.0.0.1", "https://localhost")
    assert connect(url=url, timeout=2).decide("ada").source == "fallback"  # the certificate is unknown
    monkeypatch.setenv("SSL_CERT_FILE", str(files[1]))
    client = connect(url=url, timeout=2)
    wait_until(lambda: client._table)
    before = len(service.sockets)
    assert [client.decide("ada").source for _ in range(5)] == ["service"] * 5
    assert len(service.sockets) <= before + 1  # connections stay open


# Mistakes of the caller


def test_a_mistake_of_the_caller_is_an_error_with_the_words_of_the_service(service, connect):
    with pytest.raises(ValueError, match="no study has the name 'no/such'"):
        connect(study="no/such").decide("ada")
    client = connect()
    with pytest.raises(ValueError, match="user must have at most 200 characters, got 201"):
        client.decide("a" * 201)
    assert client.decide("ada").source == "service"  # no failure of the service
    for call, message in (
        (lambda: client.decide(""), "user must be a text"),
        (lambda: client.decide("ada", available=[]), "available must name a policy"),
        (lambda: client.observe("x", float("nan")), "outcome must be a finite number"),
        (lambda: connect(url="localhost:8321"), "url must begin with http"),
        (lambda: connect(timeout=0), "must be above 0"),
        (lambda: connect(queue="/dev/null"), "queue must be the path of a file"),
        (lambda: connect(token="a\r\nb"), "token must be printable"),
    ):
        with pytest.raises(ValueError, match=message):
            call()


def test_a_wrong_token_is_logged_and_takes_no_page_down(service, connect, caplog):
    service.token = "right"
    assert connect(token="right").decide("ada").source == "service"
    client = connect(token="wrong")
    assert [client.decide("ada").source for _ in range(5)] == ["fallback"] * 5
    assert "status 401: a token is needed" in caplog.text


def test_refused_outcomes_are_counted_and_hold_nothing_up(service, connect, caplog):
    client = connect()
    wait_until(lambda: client._table)
    good = [client.decide(f"u{n}") for n in range(5)]
    client.observe(good[0], 1.0)
    assert client.flush()
    client.observe(good[0], 2.0)  # another outcome of the same decision
    client.observe("never-made", 1.0)
    past = [Choice(policy, f"id-{policy}", 0.5, "table", "eve", None, 1.0) for policy in ("slow", "gone", "fast")]
    for choice in [*good[1:], *past]:
        client.observe(choice, 3.0)
    assert client.flush()
    expected = {good[0].decision: 1.0} | {one.decision: 3.0 for one in good[1:]} | {"id-slow": 3.0, "id-fast": 3.0}
    assert counted(service.state) == expected
    assert (client.counts()["delivered"], client.counts()["refused"]) == (7, 3)
    assert "another outcome already" in caplog.text


@pytest.mark.parametrize("mode", ["broken", "proxy", "full disk", "no study"])
def test_outcomes_wait_for_a_service_that_cannot_take_them(service, connect, mode):
    client = connect()
    choice = client.decide("ada")
    service.mode = mode
    client.observe(choice, 1.0)
    assert not client.flush(0.3)
    service.mode = "well"
    assert client.flush()
    assert counted(service.state) == {choice.decision: 1.0}
    assert client.counts()["refused"] == 0


def test_the_queue_is_bounded(service, connect):
    client = connect(capacity=10)
    wait_until(lambda: client._table)
    service.kill()
    for number in range(15):
        client.observe(client.decide(f"u{number}"), 1.0)
    assert (client.counts()["lost"], client.counts()["pending"]) == (5, 10)
    service.start()
    assert client.flush(10)
    assert len(counted(service.state)) == 10


def test_memory_of_users_is_bounded(service, connect):
    client = connect()
    service.kill()
    for number in range(REMEMBERED + 50):
        client.decide(f"u{number}")
    assert len(client._offline._values) == REMEMBERED


# Forgetting, closing, processes


def test_a_forgotten_user_is_nowhere(service, connect, tmp_path):
    client = connect(queue=tmp_path / "queue")
    wait_until(lambda: client._table)
    online = client.decide("ada/1 ä")
    client.observe(online, 1.0)
    assert client.flush()
    service.kill()
    offline, other = client.decide("ada/1 ä"), client.decide("ben")
    client.observe(offline, 2.0)
    client.observe(other, 3.0)
    with pytest.raises(ServiceUnavailable):
        client.forget("ada/1 ä")
    for file in tmp_path.glob("queue*"):
        assert json.dumps("ada/1 ä")[1:-1].encode() not in file.read_bytes()
    service.start()
    client.forget("ada/1 ä")
    assert client.flush(10)
    assert counted(service.state) == {other.decision: 3.0}
    assert not service.state.decisions
    with pytest.raises(ValueError, match="nothing is stored"):
        client.forget("ada/1 ä")


def test_a_closed_client_says_so(service, connect):
    client = connect()
    with client:
        client.observe(client.decide("ada"), 1.0)
    assert len(counted(service.state)) == 1
    with pytest.raises(RuntimeError, match="closed"):
        client.decide("ada")


def test_after_a_fork_the_client_says_so(connect):
    client = connect()
    child = os.fork()
    if child == 0:
        try:
            client.decide("ada")
        except RuntimeError:
            os._exit(7)
        finally:
            os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7


def run(service, code: str, *arguments: object) -> subprocess.CompletedProcess:
    """Run the code with `StudyClient`, `url`, `study` and the arguments in a process of its own."""
    head = "import os, signal, sys, time\nfrom lifelore.bridges.study_client import StudyClient\n"
    head += f"url, study = {service.url!r}, {STUDY!r}\n"
    command = [sys.executable, "-W", "error", "-c", head + code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)


def test_a_process_that_ends_delivers_first(service):
    done = run(
        service, "client = StudyClient(url, study, fallback='slow')\nclient.observe(client.decide('ada'), 1.0)"
    )
    assert done.returncode == 0, done.stderr
    assert list(counted(service.state).values()) == [1.0]


@pytest.mark.slow
def test_the_example_decides_observes_reports_and_forgets(service, tmp_path):
    command = [sys.executable, "-W", "error", ROOT / "examples" / "personalise_client.py", service.url]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    # Where the machine is busy, some answers come too late, and the client chooses: such outcomes are the past's.
    by_service, without = map(int, re.findall(r"\d+", done.stdout.splitlines()[0])[:2])
    assert by_service + without == 500
    assert by_service > 0
    assert len(counted(service.state)) == 495  # of 100 users with 5 decisions each, less the forgotten user
    assert "user0" not in {row["user"] for row in service.state.decisions.values()}


@pytest.mark.slow
def test_the_example_without_a_service_ends_with_one_line(tmp_path):
    command = [sys.executable, "-W", "error", ROOT / "examples" / "personalise_client.py", "http://127.0.0.1:9"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=90)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith("no service at http://127.0.0.1:9; outcomes.db keeps 500")
    assert "Traceback" not in done.stderr


def test_the_file_can_be_copied_into_a_program_without_lifelore(service, tmp_path):
    shutil.copy(ROOT / "src" / "lifelore" / "bridges" / "study_client.py", tmp_path / "copied_client.py")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import copied_client\n"
    code += f"client = copied_client.StudyClient({service.url!r}, {STUDY!r}, fallback='slow', timeout=30)\n"
    code += "print(client.decide('ada').source)\n"
    code += "print(*{name.split('.')[0] for name in sys.modules} - sys.stdlib_module_names - {'__main__'})"
    command = [sys.executable, "-I", "-S", "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.stdout.splitlines() == ["service", "copied_client"], done.stderr


# The queue's file

CRASH = """
client = StudyClient(url, study, fallback='slow', queue=sys.argv[1])
for number in range(200):
    choice = client.decide(f'u{number}')
    client.observe(choice, number)
    print(choice.decision, number, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.parametrize("down", [True, False], ids=["service down", "service up"])
def test_outcomes_survive_a_crash_of_the_client(service, connect, tmp_path, down):
    if down:
        service.kill()
    done = run(service, CRASH, tmp_path / "queue")
    assert done.returncode == -signal.SIGKILL, done.stderr
    expected = {key: float(value) for key, value in map(str.split, done.stdout.splitlines())}
    if down:
        service.start()
    client = connect(queue=tmp_path / "queue")
    assert client.flush(10)
    assert counted(service.state) == expected
    assert len(expected) == 200
    client.close()
    client = connect(queue=tmp_path / "queue")
    assert client.counts()["pending"] == 0


def test_the_file_does_not_grow_with_what_is_delivered(service, connect, tmp_path):
    client, sizes = connect(queue=tmp_path / "queue"), []
    for begin in range(0, 3000, 1000):
        for number in range(begin, begin + 1000):
            client.observe(Choice("slow", f"id{number}", 1.0, "table", "ada", None, 0.0), number)
        assert client.flush(20)
        sizes.append((tmp_path / "queue").stat().st_size)
    assert len(counted(service.state)) == 3000
    assert max(sizes) < 400_000  # 1,000 outcomes of some 130 bytes, and pages that are half full
    assert b"id2999" not in (tmp_path / "queue").read_bytes()


STEPS = st.one_of(
    st.tuples(st.just("put"), st.integers(0, 3)),
    st.tuples(st.just("pop"), st.integers(0, 4)),
    st.tuples(st.just("forget"), st.integers(0, 3)),
    st.tuples(st.just("reopen"), st.just(0)),
)


@pytest.mark.slow
@given(st.lists(STEPS, max_size=60))
def test_a_queue_with_a_file_is_a_list(steps):
    """A list is the naive twin; the file is opened again as after a crash."""
    with tempfile.TemporaryDirectory() as folder:
        queue, twin = _Queue(f"{folder}/queue", 10, fsync=False), []
        for step, number in steps:
            if step == "put":
                line = {"user": f"u{number}", "place": len(twin)}
                assert queue.put(line) == (len(twin) < 10)
                twin += [line] if len(twin) < 10 else []
            elif step == "pop":
                assert queue.head(number) == twin[:number]
                queue.pop(min(number, len(twin)))
                del twin[:number]
            elif step == "forget":
                queue.forget(f"u{number}")
                twin = [line for line in twin if line["user"] != f"u{number}"]
                assert f'"u{number}"'.encode() not in Path(f"{folder}/queue").read_bytes()
            else:
                queue.close()
                queue = _Queue(f"{folder}/queue", 10, fsync=False)
            assert queue.head(20) == twin
        queue.close()


@pytest.mark.parametrize(("fsync", "level"), [(True, 2), (False, 0)])
def test_a_file_can_wait_for_the_disk(fsync, level, tmp_path):
    queue = _Queue(tmp_path / "queue", 10, fsync)
    assert queue._file.execute("PRAGMA synchronous").fetchone() == (level,)
    queue.close()


def test_a_flush_does_not_wait_for_the_next_attempt(service, connect, monkeypatch):
    monkeypatch.setattr(study_client, "WAITS", (600.0, 600.0))
    client = connect()
    wait_until(lambda: client._table)
    service.kill()
    client.observe(client.decide("ada"), 1.0)
    wait_until(lambda: (client.decide("ada"), client._breaker.is_open)[1])
    service.start()
    assert client.flush(60)


def test_one_client_at_a_time_uses_a_file(connect, tmp_path):
    first = connect(queue=tmp_path / "queue")
    with pytest.raises(ValueError, match="cannot be used: another client uses it"):
        connect(queue=tmp_path / "queue")
    first.close(0)
    connect(queue=tmp_path / "queue")
    (tmp_path / "text").write_text("not a queue" * 1000)
    with pytest.raises(ValueError, match="other content"):
        connect(queue=tmp_path / "text")
    with pytest.raises(ValueError, match="unable to open"):
        connect(queue=tmp_path / "nowhere" / "queue")


FULL_DISK = """
import resource
client = StudyClient(url, study, fallback='slow', queue=sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
for number in range(50):
    client.observe(client.decide(f'u{number}'), number)
assert client.flush(), client.counts()
client.close()
StudyClient(url, study, fallback='slow', queue=sys.argv[1]).close()
"""


def test_a_full_disk_stops_nobody(service, tmp_path):
    done = run(service, FULL_DISK, tmp_path / "queue")
    assert done.returncode == 0, done.stderr
    assert len(counted(service.state)) == 50
    assert "outcomes are in memory alone" in done.stderr


def test_a_file_that_breaks_loses_no_later_outcome(tmp_path):
    """Full for a moment, the file keeps its outcomes, and still forgets; unreadable, it stops nobody."""
    queue = _Queue(tmp_path / "queue", 10, fsync=False)
    queue.put({"user": "ada", "outcome": 1.0})
    (pages,) = queue._file.execute("PRAGMA page_count").fetchone()
    queue._file.execute(f"PRAGMA max_page_count = {pages}")
    queue.put({"user": "ben", "outcome": 2.0, "long": "x" * 10_000})
    assert [line["user"] for line in queue.head(9)] == ["ada", "ben"]
    queue.forget("ada")
    queue.close()
    queue = _Queue(tmp_path / "queue", 10, fsync=False)
    assert (len(queue), queue.head(9)) == (0, [])  # and a forgotten user is not delivered after a restart
    queue.put({"user": "ada", "outcome": 1.0})
    queue._file.close()
    assert queue.put({"user": "ben", "outcome": 2.0})
    assert (len(queue), [line["user"] for line in queue.head(9)]) == (1, ["ben"])
    queue.close()
