"""How the server listens."""

import asyncio
import socket

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from lifelore.app.service.server import _listening


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_answers_are_sent_at_once(host):
    async def delay_is_off() -> bool:
        accepted = asyncio.get_running_loop().create_future()

        def connected(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            own = writer.get_extra_info("socket")
            accepted.set_result(bool(own.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)))
            writer.close()

        try:
            listening = _listening(host, 0)
        except Exception:
            if host == "::1":
                pytest.skip("this machine has no IPv6")
            raise
        async with await asyncio.start_server(connected, sock=listening):
            _, writer = await asyncio.open_connection(*listening.getsockname()[:2])
            found = await accepted
            writer.close()
            return found

    assert asyncio.run(delay_is_off())
