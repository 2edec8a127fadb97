"""Models there and back bit for bit; files that are none of ours; the shipped one."""

import io
import json
import zipfile

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ADJACENT, NONE, ON, PairLabel
from lifelore.perception.relations.relation_classifier import SHIPPED, RelationClassifier, shipped_model
from lifelore.perception.relations.relation_model_file import model_about, model_bytes, model_from_bytes
from lifelore.perception.trees.tree_training import TreeSettings

from ..conftest import box_surface


def two_blocks(box, kind: str) -> LabelledCloud:
    place = {ON: (0.01, 0.01, 0.052), ADJACENT: (0.09, 0, 0), NONE: (0.14, 0, 0)}[kind]
    parts = [box((0, 0, 0), (0.08, 0.08, 0.05)), box(place, np.add(place, (0.05, 0.05, 0.05)))]
    parts.append(box((-0.1, -0.1, -0.002), (0.3, 0.2, -0.002), 0.01))
    return LabelledCloud(np.vstack(parts), np.repeat([2, 3, TABLE], [len(part) for part in parts]))


@pytest.fixture(scope="module")
def clouds() -> list[LabelledCloud]:
    return [two_blocks(box_surface, kind) for kind in (ON, ADJACENT, NONE)]


TRUTHS = [[PairLabel(3, 2, kind), PairLabel(2, TABLE, ON)] for kind in (ON, ADJACENT, NONE)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    [{"trees": TreeSettings(10, 10)}, {"method": "displacement"}, {"multi_label": True, "symmetric": ["none"]}],
)
def test_a_model_comes_back_bit_for_bit(clouds, tmp_path, options):
    model = RelationClassifier(**options).fit(clouds, TRUTHS)
    model.save(tmp_path / "model.npz", {"from": "blocks"})
    again = RelationClassifier.load(tmp_path / "model.npz")
    assert again.beliefs(clouds[0]) == model.beliefs(clouds[0])
    assert (again.names_, again.symmetric_, again.settings) == (model.names_, model.symmetric_, model.settings)
    assert model_bytes(again, {"from": "blocks"}) == (tmp_path / "model.npz").read_bytes()
    assert model_about(tmp_path / "model.npz")["about"] == {"from": "blocks"}


def test_the_settings_of_the_votes_come_back_too(clouds):
    model = RelationClassifier("displacement", k=3, omega=0.05, weights="distance").fit(clouds, TRUTHS)
    again = model_from_bytes(model_bytes(model))
    assert again.neighbours == model.neighbours
    assert again.fit(clouds[:2], TRUTHS[:2]).beliefs(clouds[2]) == model.fit(clouds[:2], TRUTHS[:2]).beliefs(
        clouds[2]
    )


def test_a_file_that_does_not_tell_the_settings_of_the_votes_is_read(clouds):
    model = RelationClassifier("displacement", k=3, weights="distance").fit(clouds, TRUTHS)
    arrays, header = taken_apart(model_bytes(model))
    older = packed_again(arrays, {**header, "neighbours": None})
    assert model_from_bytes(older).neighbours == model.neighbours
    assert model_from_bytes(older).beliefs(clouds[0]) == model.beliefs(clouds[0])


def test_what_is_no_model_is_one_line(learnt, tmp_path):
    content = model_bytes(learnt["trees"])
    stream = io.BytesIO()
    np.savez(stream, points=np.zeros((4, 3)))
    for wrong in (b"", b"junk", content[:-40], content[:300], stream.getvalue()):
        with pytest.raises(InputError, match="no relation model that can be read"):
            model_from_bytes(wrong)
    with pytest.raises(InputError, match="cannot be read"):
        RelationClassifier.load(tmp_path / "none.npz")
    with pytest.raises(InputError, match="fitted"):
        model_bytes(RelationClassifier())


def packed_again(arrays: dict, header) -> bytes:
    stream = io.BytesIO()
    text = np.frombuffer(json.dumps(header).encode(), np.uint8)
    np.savez(stream, **{**arrays, "about": text})
    return stream.getvalue()


def taken_apart(content: bytes) -> tuple[dict, dict]:
    with np.load(io.BytesIO(content)) as packed:
        arrays = dict(packed)
    return arrays, json.loads(arrays.pop("about").tobytes())


def test_the_shipped_model_knows_the_blocks_and_is_small(clouds):
    model = shipped_model()
    assert SHIPPED.stat().st_size <= 2 * 2**20
    assert {"scenes", "pairs", "lifelore"} <= set(model_about(SHIPPED)["about"])
    found = {(one.a, one.b): one.relation for cloud in clouds[:1] for one in model.predict(cloud)}
    assert found[3, 2] == ON
    assert found[2, TABLE] == ON
    assert model.predict(clouds[1])[0].relation == ADJACENT
    assert model.predict(clouds[2])[0].relation == NONE


@pytest.fixture(scope="module")
def learnt(clouds) -> dict[str, RelationClassifier]:
    """A model of each kind, from the same three scenes."""
    kinds = {
        "trees": RelationClassifier(trees=TreeSettings(3, 3)),
        "displacement": RelationClassifier("displacement", k=2, omega=0.05),
        "several": RelationClassifier(multi_label=True, symmetric=["none"], trees=TreeSettings(3, 3)),
    }
    return {name: model.fit(clouds, TRUTHS) for name, model in kinds.items()}


def changed(array, **places):
    """A copy with other numbers at some places, of the type that holds both."""
    value = places["value"]
    other = np.array(array, dtype=np.result_type(array.dtype, np.asarray(value).dtype))
    other[places.get("at", 0)] = value
    return other


ONES = [
    ("displacement", "0.displacements", lambda a: changed(a, value=np.nan), "finite"),
    ("displacement", "0.displacements", lambda a: a[:, :2], "three columns"),
    ("displacement", "0.codes", lambda a: a.astype(float), "whole number"),
    ("displacement", "0.codes", lambda a: a[1:], "whole number"),
    ("displacement", "0.codes", lambda a: changed(a, value=99), "codes"),
    ("displacement", "1.codes", None, "codes' is missing"),
    ("trees", "0.shares", lambda a: changed(a, value=np.nan), "shares"),
    ("trees", "0.shares", lambda a: a[:, :1] * 0 + 1, "fit together"),
    ("trees", "0.threshold", lambda a: changed(a, value=np.inf), "thresholds"),
    ("trees", "0.roots", lambda a: np.repeat(a, 10_000), "10000"),
    ("trees", "0.roots", lambda a: a[:0], "roots hold something else"),
    ("trees", "0.depth", lambda a: np.asarray(10**9), "1000000000 steps, of at most"),
    ("trees", "0.depth", lambda a: np.asarray(0), "leaf"),
    ("trees", "0.left", lambda a: np.zeros_like(a), "leaf"),
    ("trees", "0.n_features", lambda a: a + 1, "fit together"),
    ("several", "0.feature", lambda a: a * 0, "leaf"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "name", "change", "said"), ONES)
def test_numbers_that_are_none_are_refused_with_the_name_of_the_file(learnt, kind, name, change, said):
    arrays, header = taken_apart(model_bytes(learnt[kind]))
    array = arrays.pop(name)
    if change is not None:
        arrays[name] = change(array)
    with pytest.raises(InputError, match=said) as caught:
        model_from_bytes(packed_again(arrays, header), "spoilt.npz")
    assert str(caught.value).startswith("spoilt.npz is no relation model")


UNFIT = {"classes": ["on"], "columns": ["gap"], "temperature": 1}
HEADERS = [
    ("trees", ("version",), 2, "version 2"),
    ("trees", ("method",), "magic", "method"),
    ("trees", ("models",), {"objects": {"at": 0, **UNFIT}}, "fit together"),
    ("trees", ("models",), {"objects": {"at": 9, **UNFIT}}, "lacks"),
    ("trees", ("names",), 7, "cannot be read|can be read"),
    ("trees", ("models", "objects", "columns", 0), "colour", "features that are measured, got .'colour'"),
    ("trees", ("models", "table", "columns", -1), "most_tall", "columns"),
    ("trees", ("models", "objects", "classes", 0), "tall", "words that are learnt, got .'tall'"),
    ("trees", ("models", "objects", "classes"), "adjacent", "classes of objects must be words"),
    ("trees", ("models", "objects", "temperature"), float("nan"), "temperature"),
    ("trees", ("models",), {}, "models"),
    ("trees", ("models",), {"shelf": {"at": 0, "classes": ["on"]}}, "called objects and table"),
    ("trees", ("settings", "voxel"), 1e-300, "voxel"),
    ("trees", ("settings", "near"), float("inf"), "near"),
    ("trees", ("settings", "cost"), True, "cost"),
    ("trees", ("settings", "as_printed"), 1, "as_printed must be true or false"),
    ("trees", ("settings", "colour"), 1, "colour"),
    ("trees", ("names",), "on", "names must be a list"),
    ("trees", ("names", 0), "~on", "names must neither"),
    ("trees", ("symmetric",), [1], "symmetric must be words"),
    ("trees", ("multi_label",), 1, "multi_label must be a bool"),
    ("trees", ("adjacent_gap",), "wide", "adjacent_gap"),
    ("trees", ("adjacent_gap",), None, "words that are learnt, got .'beside='"),
    ("several", ("models", "on", "classes"), ["perhaps"], "0 or 1 of a word"),
    ("displacement", ("models", "objects", "k"), 10**400, "k must"),
    ("displacement", ("neighbours", "omega"), "long", "omega"),
    ("displacement", ("neighbours", "weights"), [1], "weights"),
    ("displacement", ("neighbours",), {"q": 1}, "q"),
]


@pytest.mark.parametrize(("kind", "path", "value", "said"), HEADERS)
def test_what_is_told_wrong_is_refused_with_the_name_of_the_file(learnt, kind, path, value, said):
    arrays, header = taken_apart(model_bytes(learnt[kind]))
    put(header, path, value)
    with pytest.raises(InputError, match=said) as caught:
        model_from_bytes(packed_again(arrays, header), "spoilt.npz")
    assert str(caught.value).startswith("spoilt.npz ")


def test_settings_told_as_whole_numbers_are_lengths_all_the_same(learnt, clouds):
    arrays, header = taken_apart(model_bytes(learnt["trees"]))
    header["settings"]["cost"] = 10
    assert model_from_bytes(packed_again(arrays, header)).beliefs(clouds[0]) == learnt["trees"].beliefs(clouds[0])


def put(tree, path, value):
    for step in path[:-1]:
        tree = tree[step]
    tree[path[-1]] = value


def test_an_array_that_announces_more_than_memory_is_refused(learnt):
    arrays, header = taken_apart(model_bytes(learnt["displacement"]))
    content = packed_again(arrays, header)
    stream = io.BytesIO()
    huge = b"\x93NUMPY\x01\x00" + (118).to_bytes(2, "little")
    huge += b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000000, 3), }".ljust(117) + b"\n"
    with zipfile.ZipFile(io.BytesIO(content)) as plain, zipfile.ZipFile(stream, "w") as new:
        for entry in plain.namelist():
            new.writestr(entry, huge if entry == "0.displacements.npy" else plain.read(entry))
    with pytest.raises(InputError, match="no relation model that can be read"):
        model_from_bytes(stream.getvalue())
