"""Many clouds in one process: each as alone, bad ones among good ones, files by name, and a watched folder."""

from collections.abc import Callable
from pathlib import Path
from threading import Event

import numpy as np
import pytest

from lifelore.agent.perceive import perceive_many as verb
from lifelore.agent.perceive.perceive import STAGES, PerceiveSettings, perceive
from lifelore.agent.perceive.perceive_many import perceive_folder, perceive_many, scenes_document
from lifelore.core.errors import InputError, NotFoundError
from lifelore.perception.clouds.cloud_file import read_cloud

CUBE = np.stack(np.meshgrid(*[np.arange(0, 0.06, 0.004)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
UPRIGHT = PerceiveSettings(up="z")


@pytest.fixture
def clouds(tmp_path) -> list[str]:
    """Two cubes, one on or beside the other; and only one cube."""
    shifts = {"on": [0, 0, 0.06], "beside": [0.062, 0, 0]}
    for name, shift in shifts.items():
        labels = np.repeat([2, 3], len(CUBE))
        np.savez(tmp_path / f"{name}.npz", points=np.concatenate([CUBE, CUBE + shift]), labels=labels)
    np.savez(tmp_path / "one.npz", points=CUBE, labels=np.full(len(CUBE), 2))
    return [str(tmp_path / f"{name}.npz") for name in (*shifts, "one")]


def without_seconds(entry: dict) -> dict:
    return {key: value for key, value in entry.items() if key not in ("seconds", "source")}


@pytest.mark.slow
def test_each_is_what_it_is_alone(clouds):
    entries = list(perceive_many(clouds, UPRIGHT))
    assert [entry["source"] for entry in entries] == clouds
    assert [without_seconds(entry) for entry in entries] == [
        without_seconds(perceive(cloud, UPRIGHT)) for cloud in clouds
    ]
    assert len(entries[0]["relations"]) > 0


def test_a_bad_cloud_stops_none_of_the_others(clouds, tmp_path):
    (tmp_path / "bad.npz").write_bytes(Path(clouds[0]).read_bytes()[:500])
    sources = [str(tmp_path / "bad.npz"), clouds[0], str(tmp_path / "none.pcd"), clouds[2]]
    document = scenes_document(perceive_many(sources, UPRIGHT))
    assert [scene["source"] for scene in document["scenes"]] == [clouds[0], clouds[2]]
    assert [failed["source"] for failed in document["failed"]] == sources[::2]
    damaged, missing = (failed["error"] for failed in document["failed"])
    assert "is damaged" in damaged
    assert missing == "no such file"


def test_the_model_is_loaded_once(clouds, monkeypatch):
    loaded = []
    real = verb.model_of
    monkeypatch.setattr(verb, "model_of", lambda settings, told: loaded.append(settings) or real(settings, told))
    assert len(list(perceive_many(clouds, UPRIGHT))) == 3
    assert loaded == [UPRIGHT]


def test_clouds_are_perceived_as_they_are_asked_for_and_stopped_between(clouds):
    stop = Event()
    entries = perceive_many(clouds, UPRIGHT, stop=stop)
    assert next(entries)["source"] == clouds[0]
    stop.set()
    assert list(entries) == []


def test_files_bear_the_clouds_names(clouds, tmp_path):
    for kind in ("graphs", "problems"):
        (tmp_path / kind).mkdir()
    graphs, problems = str(tmp_path / "graphs/{name}.dot"), str(tmp_path / "problems/{name}.pddl")
    list(perceive_many(clouds, UPRIGHT, dot=graphs, pddl=problems))
    assert sorted(path.name for path in (tmp_path / "graphs").iterdir()) == ["beside.dot", "on.dot", "one.dot"]
    assert (tmp_path / "problems/on-domain.pddl").is_file()
    perceive(clouds[0], UPRIGHT, dot=str(tmp_path / "alone.dot"))
    assert (tmp_path / "graphs/on.dot").read_text() == (tmp_path / "alone.dot").read_text()


def refused(match: str, attempt: Callable[[], object], error: type[Exception] = InputError) -> None:
    with pytest.raises(error, match=match):
        attempt()


def test_mistakes_are_told_before_any_cloud_is_read(clouds, tmp_path):
    twin, named = str(tmp_path / "sub" / "on.npz"), str(tmp_path / "{name}.dot")
    twice = "on.dot' would be overwritten.*rename clouds of one name"
    refused("dot names one file for many clouds", lambda: perceive_many(clouds, UPRIGHT, dot="a.dot"))
    refused(twice, lambda: perceive_many([*clouds, twin], UPRIGHT, dot=named))
    refused("would be overwritten", lambda: perceive_many(clouds, UPRIGHT, dot=str(tmp_path / "{name}.npz")))
    refused("units must be", lambda: perceive_many(clouds, PerceiveSettings(units="feet")))
    unknown = PerceiveSettings(model="nobody", memory=str(tmp_path / "m.db"))
    refused("nobody", lambda: perceive_many(clouds, unknown), NotFoundError)
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".npz"] * 3


def test_what_is_read_elsewhere_is_taken_in_its_place(clouds):
    entries = list(perceive_many(["bag", clouds[2]], UPRIGHT, read=lambda name: read_cloud(clouds[0])))
    assert [len(entry["objects"]) for entry in entries] == [2, 2]


def test_progress_and_notices_name_the_cloud(clouds, tmp_path):
    np.savez(
        tmp_path / "parts.npz", points=np.concatenate([CUBE, CUBE + 0.2]), labels=np.repeat([20, 21], len(CUBE))
    )
    steps, lines = [], []
    sources = [clouds[2], str(tmp_path / "parts.npz")]
    list(perceive_many(sources, UPRIGHT, progress=lambda *step: steps.append(step), notice=lines.append))
    assert [step[0] for step in steps] == list(range(2 * len(STAGES)))
    assert {step[1] for step in steps} == {2 * len(STAGES)}
    assert steps[-1][2].startswith("parts.npz, ")
    assert [line.startswith(f"{sources[1]}: the labels were taken") for line in lines] == [True]


@pytest.mark.slow
def test_each_new_cloud_of_a_folder(clouds, tmp_path):
    folder, stop = tmp_path / "in", Event()
    folder.mkdir()
    entries = perceive_folder(folder, UPRIGHT, stop=stop, dot=str(tmp_path / "{name}.dot"))
    (folder / "a.npz").write_bytes(Path(clouds[0]).read_bytes())
    first = next(entries)
    assert first["source"] == str(folder / "a.npz")
    assert without_seconds(first) == without_seconds(perceive(clouds[0], UPRIGHT))
    assert (tmp_path / "a.dot").is_file()
    np.save(folder / "a.npy", CUBE)
    twin = next(entries)
    assert twin["source"] == str(folder / "a.npy")
    assert "would overwrite" in twin["error"]
    stop.set()
    assert list(entries) == []


@pytest.mark.slow
def test_a_watched_cloud_never_writes_over_the_files_of_another(clouds, tmp_path):
    folder, stop = tmp_path / "in", Event()
    folder.mkdir()
    entries = perceive_folder(folder, UPRIGHT, stop=stop, pddl=str(tmp_path / "{name}.pddl"))
    (folder / "cup.npz").write_bytes(Path(clouds[0]).read_bytes())
    assert "error" not in next(entries)
    domain = (tmp_path / "cup-domain.pddl").read_text()
    (folder / "cup-domain.npz").write_bytes(Path(clouds[0]).read_bytes())
    assert "would overwrite" in next(entries)["error"]
    assert (tmp_path / "cup-domain.pddl").read_text() == domain
    stop.set()


def test_a_folder_or_a_file_name_that_cannot_be_is_told_before_the_watch(tmp_path):
    stop = Event()
    refused("watch must name a folder", lambda: perceive_folder(tmp_path / "no", UPRIGHT, stop=stop))
    refused("names one file", lambda: perceive_folder(tmp_path, UPRIGHT, stop=stop, plot="a.png"))
    refused("folder must exist", lambda: perceive_folder(tmp_path, UPRIGHT, stop=stop, dot="no/{name}.dot"))
    refused("units must be", lambda: perceive_folder(tmp_path, PerceiveSettings(units="feet"), stop=stop))
