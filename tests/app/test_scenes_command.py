"""`lifelore scenes`: what it tells and what it refuses."""

import json

import pytest

from lifelore.app.scenes_command import scenes
from lifelore.core.errors import InputError

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim


def test_one_json_document(tmp_path, capsys):
    scenes(1, str(tmp_path / "out"), seed=1, mix="on=1", arrangement="pair", as_json=True)
    report = json.loads(capsys.readouterr().out)
    assert report["scenes"] == 1
    assert report["pairs"]["on"] == 1


def test_a_line_for_people(tmp_path, capsys):
    scenes(2, str(tmp_path / "out"), mix="on=1, adjacent=1", arrangement="pair")
    assert "pairs: 1 on, 1 adjacent, 0 both, 0 none" in capsys.readouterr().out


@pytest.mark.parametrize("mix", ["on", "on=", "on=x", "=,="])
def test_a_mix_that_is_none_is_refused(tmp_path, mix):
    with pytest.raises(InputError, match=r"mix must be RELATION=SHARE|mix names"):
        scenes(1, str(tmp_path / "out"), mix=mix, arrangement="pair")
