"""`lifelore serve`: the HTTP service over a memory."""

import json
from pathlib import Path
from typing import Annotated

import typer

from lifelore.app.options import AsJson

Option = typer.Option


def serve(
    host: Annotated[str, Option(help="Address to listen on; other than this machine's needs --token-file.")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, Option(help="Port; 0: any free port.")] = 8321,
    where: Annotated[
        str | None,
        Option("--memory", metavar="FILE|URL", envvar="LIFELORE_MEMORY", help="Memory; default: your own."),
    ] = None,
    memory_file: Annotated[
        str | None, Option(metavar="FILE", help="File with the URL of the memory, so that no password is in ps.")
    ] = None,
    token_file: Annotated[
        str | None, Option(metavar="FILE", help="Hashed tokens; with it every request needs a token.")
    ] = None,
    add_token: Annotated[
        str | None,
        Option(metavar="NAME", help="Add a token to --token-file, print it once, and do not serve."),
    ] = None,
    scopes: Annotated[str, Option(help="Scopes of the new token: some of read,write,admin.")] = "read,write",
    study: Annotated[
        list[str] | None, Option(metavar="NAME", help="Only study of the new token; may be repeated.")
    ] = None,
    only: Annotated[
        str, Option(metavar="GROUPS", help="Routes to serve: some of personalise,perceive,memory,pages.")
    ] = "personalise,perceive,memory,pages",
    body: Annotated[float, Option(help="Size of the largest request in MiB.")] = 64.0,
    rate: Annotated[float, Option(help="Requests per second of a client; 0: no limit.")] = 1000.0,
    seconds: Annotated[float, Option(help="Longest time that a request may take.")] = 60.0,
    seed: Annotated[int, Option(help="Draws all random numbers.")] = 0,
    access_log: Annotated[
        bool, Option("--access-log", help="Log answered requests too, not errors alone.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Answer over HTTP, and show pages in a browser.

    Use it when programs in other languages or on other machines need the memory, or to see scenes, lives and
    studies in a browser. The memory is that of the command line. Ctrl-C stops it: every answered request is
    stored. The addresses are listed under /openapi.json.
    """
    from lifelore.app.console import print_json_line
    from lifelore.core.errors import InputError, MissingExtraError

    if add_token is not None:
        from lifelore.app.service.tokens import add_token as added

        if token_file is None:
            raise InputError("add-token needs the file to add it to; give --token-file FILE")
        token = added(token_file, add_token, scopes.split(","), study or ())
        print(json.dumps({"name": add_token, "token": token}) if as_json else token)
        return
    try:
        import fastapi  # noqa: F401
        import httptools  # noqa: F401
        import prometheus_client  # noqa: F401
        import uvicorn  # noqa: F401
    except ImportError as error:
        raise MissingExtraError(
            f"serve needs {error.name}, which is not installed; pip install 'lifelore[web]'"
        ) from None
    from lifelore.app.pages.mount import app_with_pages
    from lifelore.app.service.server import serve as served
    from lifelore.app.service.settings import ServiceSettings

    settings = ServiceSettings(
        where if memory_file is None else _location_in(memory_file),
        token_file, seed, int(body * (1 << 20)), rate, seconds, only.split(","), access_log,
    )  # fmt: skip

    def ready(url: str) -> None:
        print_json_line({"url": url}) if as_json else print(f"serving at {url} (Ctrl-C stops)", flush=True)

    served(settings, host, port, ready, app_with_pages)


def _location_in(file: str) -> str:
    from lifelore.core.errors import InputError

    try:
        location = Path(file).read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError):
        raise InputError(f"memory-file '{file}' must be a text file that can be read") from None
    if not location or "\n" in location:
        raise InputError(f"memory-file '{file}' must have one line, the file or URL of the memory")
    return location
