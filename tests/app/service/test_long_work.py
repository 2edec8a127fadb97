"""Long work ends with its request: where its client leaves, at the time limit, and when the service stops."""

import asyncio
import contextlib
import http.client
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from lifelore.app.service.worker_process import WorkerProcess, over_memory
from lifelore.core.errors import InputError
from lifelore.memory import Memory, open_memory

SERVICE = """
import os, sys, time
from fastapi import Request
from lifelore.app.service import server
from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings

def create(settings):
    app = create_app(settings)
    worker = app.state.service.worker

    @app.get("/long")
    async def long(request: Request, seconds: float):
        await worker.run(request, time.sleep, seconds)
        return os.getpid()

    @app.get("/thread")
    def thread():
        time.sleep(600)

    return app

if __name__ == "__main__":
    server.GRACE, server.LONGEST_STOP = 1, float(sys.argv[3])
    settings = ServiceSettings(sys.argv[1], seconds=float(sys.argv[2]))
    server.serve(settings, "127.0.0.1", 0, lambda url: print(url, flush=True), create)
"""
Start = Callable[..., tuple[subprocess.Popen[str], str]]


@pytest.fixture
def serve_slowly(tmp_path: Path) -> Iterator[Start]:
    """Start a service with a route that works in a process and one that works on a thread; and its host."""
    running: list[subprocess.Popen[str]] = []
    (tmp_path / "slow_service.py").write_text(SERVICE)

    def start(seconds: float = 60.0, longest: float = 2.0) -> tuple[subprocess.Popen[str], str]:
        with (tmp_path / "log").open("a") as log:
            command = [sys.executable, "slow_service.py", str(tmp_path / "m.db"), str(seconds), str(longest)]
            child = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=log, text=True)
        running.append(child)
        return child, child.stdout.readline().strip().removeprefix("http://")

    yield start
    for child in running:
        child.kill()
        child.communicate()


def ask(host: str, path: str) -> tuple[int, bytes]:
    connection = http.client.HTTPConnection(host, timeout=60)
    with contextlib.closing(connection):
        connection.request("GET", path)
        answer = connection.getresponse()
        return answer.status, answer.read()


def ask_in_vain(host: str, path: str) -> threading.Thread:
    def asked() -> None:
        with contextlib.suppress(OSError, http.client.HTTPException):
            ask(host, path)

    thread = threading.Thread(target=asked)
    thread.start()
    return thread


def sleepers(child: subprocess.Popen[str]) -> list[int]:
    """Processes of a service that work or wait for work; the tracker of multiprocessing is none."""
    children = Path(f"/proc/{child.pid}/task/{child.pid}/children").parent.parent.glob("*/children")
    found = [int(pid) for file in children for pid in file.read_text().split()]
    return [pid for pid in found if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()]


def wait_until(holds: Callable[[], object]) -> None:
    give_up = time.monotonic() + 120
    while not holds():
        assert time.monotonic() < give_up
        time.sleep(0.02)


def test_work_ends_with_its_client_its_time_and_its_service(serve_slowly):
    child, host = serve_slowly(seconds=6.0)
    child.send_signal(signal.SIGHUP)  # changes nothing
    connection = http.client.HTTPConnection(host, timeout=60)
    connection.request("GET", "/long?seconds=600")
    wait_until(lambda: sleepers(child))
    connection.close()
    wait_until(lambda: not sleepers(child))
    assert ask(host, "/long?seconds=0")[0] == 200
    assert b'route="/long",status="499"} 1.0' in ask(host, "/metrics")[1]

    status, content = ask(host, "/long?seconds=600")
    assert (status, json.loads(content)["error"]["kind"]) == (504, "time")
    wait_until(lambda: not sleepers(child))

    asked = ask_in_vain(host, "/long?seconds=600")
    wait_until(lambda: sleepers(child))
    (worker,) = sleepers(child)
    child.kill()
    asked.join()
    wait_until(lambda: not Path(f"/proc/{worker}").exists())


def test_sigterm_ends_the_service_whatever_runs(serve_slowly):
    child, host = serve_slowly()
    asked = [ask_in_vain(host, "/long?seconds=600"), ask_in_vain(host, "/thread")]
    wait_until(lambda: sleepers(child))
    (worker,) = sleepers(child)
    child.send_signal(signal.SIGTERM)
    assert child.wait(60) == 0
    wait_until(lambda: not Path(f"/proc/{worker}").exists())
    for thread in asked:
        thread.join()


def test_a_second_sigterm_ends_it_at_once(serve_slowly):
    child, host = serve_slowly(longest=600.0)
    asked = [ask_in_vain(host, "/long?seconds=600"), ask_in_vain(host, "/thread")]
    wait_until(lambda: sleepers(child))
    child.send_signal(signal.SIGTERM)
    time.sleep(0.3)
    assert child.poll() is None
    child.send_signal(signal.SIGTERM)
    assert child.wait(60) == 0
    for thread in asked:
        thread.join()


@pytest.mark.parametrize("anyio_backend", ["asyncio"])
@pytest.mark.anyio
async def test_a_process_that_dies_is_replaced(anyio_backend):
    worker = WorkerProcess()
    try:
        assert await worker.call(max, 2, 3) == 3
        first = await worker.call(os.getpid)
        assert await worker.call(os.getpid) == first
        with pytest.raises(InputError, match="crashed"):
            await worker.call(os._exit, 3)
        with pytest.raises(InputError, match="crashed"):
            await worker.call(os.kill, await worker.call(os.getpid), signal.SIGSEGV)
        with pytest.raises(RuntimeError, match="ZeroDivisionError"):
            await worker.call(divmod, 1, 0)
        with pytest.raises(InputError, match="mine"):
            await worker.call(raise_mistake)
        assert await worker.call(max, 2, 3) == 3
    finally:
        worker.stop()


@pytest.mark.anyio
@pytest.mark.parametrize("anyio_backend", ["asyncio"])
async def test_work_over_a_memory_is_whole_or_not_at_all(anyio_backend, where, tmp_path):
    worker = WorkerProcess()
    try:
        assert await worker.call(over_memory, where, contribute, "rosie") == 1
        half = tmp_path / "half"
        call = asyncio.ensure_future(worker.call(over_memory, where, contribute, "ben", half))
        while not half.exists():
            await asyncio.sleep(0.02)
        call.cancel()
        with pytest.raises(asyncio.CancelledError):
            await call
        with open_memory(where) as memory:
            assert memory.robots() == ["rosie"]
            contribute(memory, "ada")
    finally:
        worker.stop()


def contribute(memory: Memory, robot: str, half: Path | None = None) -> int:
    """Store, make the file `half` and wait for ever if there is one, and store again, in one transaction."""
    with memory.together():
        memory.contribute(robot, [], process="p", seq=0, task={})
        if half is not None:
            half.touch()
            time.sleep(600)
        memory.contribute(robot, [], process="p", seq=1, task={})
    return len(memory.robots())


def raise_mistake() -> None:
    raise InputError("mine")
