"""Processes that run long functions and read uploads: a request that ends early ends its function too.

Python cannot stop a thread. A process can be killed: where a client leaves, at the time limit of a request, and
when the service stops. A hostile file can crash or fill a process alone, and not the service.
"""

import asyncio
import multiprocessing
import os
import resource
import threading
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from anyio import to_thread
from starlette.requests import Request

from lifelore.core.errors import InputError, LifeloreError
from lifelore.memory import open_memory

MEMORY = 16 << 30
"""Bytes of address space of a process; more let a hostile file take more of the machine."""
PROCESSES = 2
"""Largest number of processes; further calls wait, so that long functions do not take all of the machine."""


class ClientLeft(Exception):
    """The client closed its connection before the answer."""


class WorkerProcess:
    """Processes that start at the first call, and again after a call that crashed or ended early."""

    def __init__(self, processes: int = PROCESSES) -> None:
        self._free = asyncio.Semaphore(processes)
        self._idle: list[_Process] = []
        self._busy: set[_Process] = set()

    async def run(self, request: Request, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a function of a module in a process, which is killed if the request ends before.

        Parameters
        ----------
        request : Request
            Its body has been read. The call ends when its client leaves, or when its task is cancelled: at the
            time limit, and when the service stops.
        function, arguments
            They and the result travel to and from the process, so a memory is none of them: see `over_memory`.
            What a function stores in one transaction, a kill leaves whole or not at all.

        Raises
        ------
        LifeloreError
            As the function raised it.
        InputError
            The function crashed the process, or needs more than `MEMORY`.
        ClientLeft
            The client closed its connection.
        RuntimeError
            Any other error of the function; the message is its traceback.
        """
        left = asyncio.ensure_future(_left(request))
        call = asyncio.ensure_future(self.call(function, *arguments))
        try:
            await asyncio.wait({left, call}, return_when=asyncio.FIRST_COMPLETED)
            if call.done():
                return call.result()
            raise ClientLeft
        finally:
            left.cancel()
            call.cancel()

    async def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """As `run`, where no client waits."""
        async with self._free:
            process = self._idle.pop() if self._idle else _Process()
            self._busy.add(process)
            try:
                result, error = await to_thread.run_sync(process.ask, function, arguments, abandon_on_cancel=True)
            except BaseException:
                process.kill()
                raise
            finally:
                self._busy.discard(process)
            self._idle.append(process)
        if isinstance(error, str):
            raise RuntimeError(error)
        if error is not None:
            raise error
        return result

    def stop(self) -> None:
        """End all processes; the next call starts another."""
        for process in (*self._idle, *self._busy):
            process.kill()
        self._idle.clear()


class _Process:
    """A process that answers one call after the other."""

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._lock = threading.Lock()
        self._process: Any = None
        self._pipe: Any = None
        self._killed = False

    def ask(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, Any]:
        """The result of a function and its error; InputError where the process crashed."""
        try:
            self._start()
            self._pipe.send((function, arguments))
            return self._pipe.recv()
        except (EOFError, OSError):
            raise InputError("the request crashed the process that worked on it; check what it sends") from None

    def kill(self) -> None:
        """End the process, whatever it does; a thread that waits for its answer gets an error."""
        with self._lock:
            self._killed = True
            if self._process is not None:
                self._process.kill()

    def _start(self) -> None:
        with self._lock:
            if self._killed:
                raise EOFError
            if self._process is None:
                self._pipe, theirs = self._context.Pipe()
                self._process = self._context.Process(target=_answer_calls, args=(theirs,), daemon=True)
                self._process.start()
                theirs.close()


async def _left(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass


def over_memory(where: str | None, function: Callable[..., Any], *arguments: Any) -> Any:
    """``function(memory, *arguments)`` over the memory of the settings, opened in this process.

    Examples
    --------
    In a route::

        await service.worker.run(request, over_memory, service.settings.memory, function, *arguments)
    """
    with open_memory(where, durable=True) as memory:
        return function(memory, *arguments)


def _answer_calls(pipe: Connection) -> None:
    threading.Thread(target=_end_with_service, daemon=True).start()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    while True:
        try:
            function, arguments = pipe.recv()
        except (EOFError, KeyboardInterrupt):
            return
        try:
            answer = function(*arguments), None
        except LifeloreError as error:
            answer = None, type(error)(str(error))
        except MemoryError:
            answer = None, InputError("the request needs too much memory; send less")
        except Exception:
            answer = None, traceback.format_exc()
        pipe.send(answer)


def _end_with_service() -> None:
    """End this process in the middle of a call where the service was killed."""
    service = multiprocessing.parent_process()
    if service is not None:
        service.join()
        os._exit(1)
