"""Settings of the service: its memory, tokens and limits."""

import ipaddress
from collections.abc import Collection
from dataclasses import dataclass

from lifelore.core.errors import InputError

LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]", "::1")
MEBIBYTE = 1 << 20
GROUPS = ("personalise", "perceive", "memory", "pages")
"""Groups of routes that can be served alone."""


@dataclass(frozen=True)
class ServiceSettings:
    """Settings of the service: memory, tokens, limits and groups of routes.

    Parameters
    ----------
    memory : str, optional
        A file or a ``postgresql://`` URL; default: the user's own memory.
    token_file : str, optional
        File of hashed tokens, see `tokens`. Without it the service answers requests from this machine only.
    seed : int
        Draws the choices.
    largest_body : int
        Bytes of the largest request.
    rate : float
        Requests per second of a client, over ten seconds; 0: no limit.
    seconds : float
        Longest time that a request may take.
    only : collection of str
        Groups of routes that the service has, some of `GROUPS`; health, metrics and ``/docs`` are always there.
    access_log : bool
        Whether answered requests are logged too; errors always are.

    Examples
    --------
    >>> ServiceSettings(memory="shop.db", only=["personalise"]).seed
    0
    """

    memory: str | None = None
    token_file: str | None = None
    seed: int = 0
    largest_body: int = 64 * MEBIBYTE
    rate: float = 1000.0
    seconds: float = 60.0
    only: Collection[str] = GROUPS
    access_log: bool = False

    def __post_init__(self) -> None:
        if self.largest_body < 1:
            raise InputError(f"largest_body must be at least 1 byte, got {self.largest_body}")
        if not 0 <= self.rate < float("inf"):
            raise InputError(f"rate must be at least 0 requests per second, got {self.rate}")
        if not 0 < self.seconds < float("inf"):
            raise InputError(f"seconds must be above 0, got {self.seconds}")
        for group in self.only:
            if group not in GROUPS:
                raise InputError(f"only must be some of {', '.join(GROUPS)}, got '{group}'")


def is_loopback(host: str) -> bool:
    """Whether a host is this machine's loopback interface."""
    if host in LOOPBACK_NAMES:
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False
