"""Every verb of the command line, once, as a person calls it: it ends well and prints one JSON document."""

import io
import shlex
from pathlib import Path

import numpy as np
import pytest
import typer

from lifelore.app import command_line
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map

VERBS = {
    "live": "live --domain lattice --tasks 1 --memory m.db",
    "explain": "live --domain factory-customers --tasks 1 --memory m.db; explain 0 --memory m.db",
    "learn-from": "learn-from runs.csv --map room.yaml --memory m.db",
    "way": "learn-from runs.csv --map room.yaml --memory m.db; "
    "way --from 0.55,0.55 --to 4.55,0.55 --map room.yaml --memory m.db",
    "recognise": "recognise room.yaml --old room.yaml",
    "perceive": "perceive scenes/on.npz",
    "learn-relations": "learn-relations scenes --truth truth.csv --memory m.db",
    "teach": "teach --domain lattice --size 7 --out shown.jsonl",
    "advise": "advise lattice --experts experts.jsonl --watch experts.jsonl --share 0.1",
    "reuse": "reuse fit log.csv --memory m.db; reuse choose --user ann --memory m.db",
    "memory": "live --domain lattice --tasks 1 --memory m.db; memory show --memory m.db",
    "serve": "serve --token-file tokens --add-token shop --scopes write",
    "scenes": "scenes --n 1 --out out --mix on=1 --arrangement pair",
    "reproduce": "reproduce C5.6 --out results",
    "doctor": "doctor",
    "version": "version",
}
"""What is asked, the last of several commands with ``--json``."""


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A folder with what the commands read."""
    rng = np.random.default_rng(0)
    state = np.pad(np.zeros((40, 60), np.uint8), 1, constant_values=1)
    state[18:22, 30:50] = 1
    write_occupancy_map(tmp_path / "room.yaml", OccupancyMap(state, 0.1))
    places = [f"{0.5 * i},{0.55 + 0.1 * i:.2f},0.55,{'goal' * (i == 40)}" for i in range(41)]
    (tmp_path / "runs.csv").write_text("\n".join(["time,x,y,outcome", *places]) + "\n")
    (tmp_path / "scenes").mkdir()
    below, above = rng.random((2, 400, 3)) * 0.05 + np.array([[[0, 0, 0]], [[0, 0, 0.05]]])
    table = rng.random((900, 3)) * [0.4, 0.4, 0.0] - [0.1, 0.1, 0.0]
    points, labels = np.vstack([below, above, table]), np.repeat([2, 3, 1], [400, 400, 900])
    np.savez(tmp_path / "scenes" / "on.npz", points=points, labels=labels)
    (tmp_path / "truth.csv").write_text("scene,a,b,relation,confidence\non,3,2,on,3\non,2,1,on,3\n")
    (tmp_path / "experts.jsonl").write_text('{"agent": "e", "state": [1, 5], "action": "east"}\n')
    outcomes = [f"u{n % 6},{policy},{int(policy == 'xy'[n % 2])}" for n in range(12) for policy in "xy"]
    (tmp_path / "log.csv").write_text("\n".join(["user,policy,outcome", *outcomes]) + "\n")
    return tmp_path


def test_every_verb_is_here():
    assert set(VERBS) == set(vars(typer.main.get_command(command_line.app))["commands"])


@pytest.mark.parametrize("verb", VERBS)
def test_a_verb_ends_well(verb, ask, files, monkeypatch):
    needed = {"scenes": "mujoco", "serve": "fastapi"}
    if verb in needed:
        pytest.importorskip(needed[verb])
    monkeypatch.setattr("sys.stdin", io.StringIO("q\n"))
    *before, command = (shlex.split(one) for one in VERBS[verb].split("; "))
    for one in before:
        assert ask(*one).status == 0
    answer = ask(*command, "--json")
    assert answer.status == 0, answer.err
    assert answer.document
