"""A process that runs functions on uploads, so that a hostile file can neither crash nor stop the service."""

import multiprocessing
import resource
import threading
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from lifelore.core.errors import InputError, LifeloreError

MEMORY = 16 << 30
"""Bytes of address space of the process; more let a hostile file take more of the machine."""


class WorkerProcess:
    """A process that starts at the first call, and again after a call that crashed or took too long."""

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._lock = threading.Lock()
        self._process: Any = None
        self._pipe: Any = None

    def call(self, function: Callable[..., Any], arguments: tuple[Any, ...], seconds: float) -> Any:
        """The result of a function of a module; calls wait for each other.

        Raises
        ------
        LifeloreError
            As the function raised it.
        InputError
            The function took longer than `seconds`, or crashed the process.
        TimeoutError
            The calls before it took longer than `seconds`.
        RuntimeError
            Any other error of the function; the message is its traceback.
        """
        if not self._lock.acquire(timeout=seconds):
            raise TimeoutError
        try:
            self._start()
            self._pipe.send((function, arguments))
            if not self._pipe.poll(seconds):
                self.stop()
                raise InputError(f"the upload takes longer than {seconds:g} s; send a smaller scene")
            result, error = self._pipe.recv()
        except (EOFError, OSError) as lost:
            if isinstance(lost, LifeloreError | TimeoutError):
                raise
            self.stop()
            raise InputError("the upload crashed the process that read it; check the file") from None
        finally:
            self._lock.release()
        if isinstance(error, str):
            raise RuntimeError(error)
        if error is not None:
            raise error
        return result

    def stop(self) -> None:
        """End the process; the next call starts another."""
        if self._process is not None:
            self._pipe.close()
            self._process.kill()
            self._process.join()
            self._process = self._pipe = None

    def _start(self) -> None:
        if self._process is not None and self._process.is_alive():
            return
        self.stop()
        self._pipe, theirs = self._context.Pipe()
        self._process = self._context.Process(target=_answer_calls, args=(theirs,), daemon=True)
        self._process.start()
        theirs.close()


def _answer_calls(pipe: Connection) -> None:
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
            answer = None, InputError("the upload needs too much memory; send a smaller scene")
        except Exception:
            answer = None, traceback.format_exc()
        pipe.send(answer)
