"""The examples of the service's page are answered by a service, in their order."""

import io
import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from fastapi.testclient import TestClient

from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings

JSON = {"Content-Type": "application/json"}
FILE = {"Content-Type": "application/octet-stream"}
PAGE = Path(__file__).parents[1] / "docs" / "service.md"


def requests() -> list[tuple[str, str, str | None]]:
    """Method, path and body of each curl command of the page."""
    blocks = re.findall(r"^```sh\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    commands = [part for block in blocks for part in re.split(r"^(?=curl )", block, flags=re.MULTILINE)]
    found = []
    for command in commands:
        if command.startswith("curl "):
            words = shlex.split(command)
            options = {word: words[place + 1] for place, word in enumerate(words[:-1]) if word.startswith("-")}
            path = next(word.removeprefix("$URL") for word in words if word.startswith("$URL"))
            body = options.get("--json") or options.get("--data-binary")
            found.append((options.get("-X", "GET" if body is None else "POST"), path, body))
    return found


def cloud() -> bytes:
    """A labelled block on a table."""
    side = np.stack(np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 40)), -1).reshape(-1, 2)
    table = np.column_stack([side - 0.5, np.zeros((len(side), 2))])
    faces = [np.insert(side * 0.1, axis, 0.1, axis=1) for axis in range(3)]
    block = np.concatenate(faces)
    file = io.BytesIO()
    np.save(file, np.concatenate([table, np.column_stack([block, np.full(len(block), 2)])]))
    return file.getvalue()


def test_every_example_is_answered(tmp_path):
    listed, fields, files = requests(), {}, {"@cloud.npy": cloud()}
    assert len(listed) > 20
    app = create_app(ServiceSettings(str(tmp_path / "shop.db")))
    with TestClient(app, base_url="http://127.0.0.1:8321") as client:
        for method, path, body in listed:
            if body is None or not body.startswith("@"):
                for name, value in fields.items():
                    body = body and body.replace(f"${name.upper()}", value)
                answer = client.request(method, path, content=body, headers=JSON)
            else:
                answer = client.request(method, path, content=files[body], headers=FILE)
            assert answer.status_code == 200, (path, answer.text)
            if path.endswith("/export"):
                files["@backup.db"] = answer.content
            elif answer.headers["content-type"] == "application/json":
                fields |= {name: answer.json()[name] for name in ("decision",) if name in answer.json()}


def test_the_error_of_the_page_is_the_error_of_the_service(tmp_path):
    (shown,) = re.findall(r"^```json\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    app = create_app(ServiceSettings(str(tmp_path / "shop.db")))
    with TestClient(app, base_url="http://127.0.0.1:8321") as client:
        library = {"means": [[1.0]], "deviations": 1.0}
        answer = client.put("/v1/studies/s", json={"library": library, "control": 2.0})
    own = answer.json()["error"] | {"request": json.loads(shown)["error"]["request"]}
    assert {"error": own} == json.loads(shown)
