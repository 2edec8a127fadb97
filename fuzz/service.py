"""One HTTP service in this process, to which the fuzzer sends requests."""

from functools import cache
from tempfile import mkdtemp
from urllib.parse import quote

from fastapi.testclient import TestClient

from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings

METHODS = ("GET", "POST", "PUT", "DELETE", "PATCH")


@cache
def client() -> TestClient:
    """A client of a service over an empty memory; errors of the service are raised here."""
    settings = ServiceSettings(f"{mkdtemp(prefix='fuzz-')}/memory.db", rate=0)
    app = create_app(settings)
    return TestClient(app, base_url="http://127.0.0.1").__enter__()


def answer(content: bytes) -> int:
    """The status of a request: its method and address are the first lines of `content`, its body the rest."""
    method, _, rest = content.partition(b"\n")
    address, _, body = rest.partition(b"\n")
    word = method.decode("ascii", "replace")
    path = "/" + quote(address.lstrip(b"/"), safe="/?&=%~:")
    kind = "application/json" if body[:1] in (b"{", b"[", b"") else "application/octet-stream"
    headers = {"Content-Type": kind}
    response = client().request(word if word in METHODS else "POST", path[:4000], content=body, headers=headers)
    if response.status_code >= 500 and response.status_code != 503:
        raise RuntimeError(f"{word} {path}: {response.status_code} {response.text[:300]}")
    return response.status_code
