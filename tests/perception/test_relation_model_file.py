"""Models there and back bit for bit; files that are none of ours; the shipped one."""

import io
import json
import subprocess
import sys

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ADJACENT, NONE, ON, PairLabel
from lifelore.perception.relation_classifier import RelationClassifier
from lifelore.perception.relation_model_file import (
    SHIPPED,
    load_model,
    model_about,
    model_bytes,
    model_from_bytes,
    save_model,
    shipped_model,
)
from lifelore.perception.tree_training import TreeSettings


def two_blocks(box, kind: str) -> LabelledCloud:
    place = {ON: (0.01, 0.01, 0.052), ADJACENT: (0.09, 0, 0), NONE: (0.14, 0, 0)}[kind]
    parts = [box((0, 0, 0), (0.08, 0.08, 0.05)), box(place, np.add(place, (0.05, 0.05, 0.05)))]
    parts.append(box((-0.1, -0.1, -0.002), (0.3, 0.2, -0.002), 0.01))
    return LabelledCloud(np.vstack(parts), np.repeat([2, 3, TABLE], [len(part) for part in parts]))


@pytest.fixture
def clouds(box) -> list[LabelledCloud]:
    return [two_blocks(box, kind) for kind in (ON, ADJACENT, NONE)]


TRUTHS = [[PairLabel(3, 2, kind), PairLabel(2, TABLE, ON)] for kind in (ON, ADJACENT, NONE)]


@pytest.mark.parametrize(
    "options",
    [{"trees": TreeSettings(10, 10)}, {"method": "displacement"}, {"multi_label": True, "symmetric": ["none"]}],
)
def test_a_model_comes_back_bit_for_bit(clouds, tmp_path, options):
    model = RelationClassifier(**options).fit(clouds, TRUTHS)
    save_model(model, tmp_path / "model.npz", {"from": "blocks"})
    again = RelationClassifier.load(tmp_path / "model.npz")
    assert again.beliefs(clouds[0]) == model.beliefs(clouds[0])
    assert (again.names, again.symmetric, again.settings) == (model.names, model.symmetric, model.settings)
    assert model_bytes(again, {"from": "blocks"}) == (tmp_path / "model.npz").read_bytes()
    assert model_about(tmp_path / "model.npz")["about"] == {"from": "blocks"}


def test_what_is_no_model_is_one_line(clouds, tmp_path):
    content = model_bytes(RelationClassifier(trees=TreeSettings(3, 3)).fit(clouds, TRUTHS))
    stream = io.BytesIO()
    np.savez(stream, points=np.zeros((4, 3)))
    for wrong in (b"", b"junk", content[:-40], content[:300], stream.getvalue()):
        with pytest.raises(InputError, match="no relation model that can be read"):
            model_from_bytes(wrong)
    with pytest.raises(InputError, match="cannot be read"):
        load_model(tmp_path / "none.npz")
    with pytest.raises(InputError, match="fitted"):
        model_bytes(RelationClassifier())


def rewritten(content: bytes, **changes) -> bytes:
    with np.load(io.BytesIO(content)) as packed:
        arrays = dict(packed)
    header = {**json.loads(arrays["about"].tobytes()), **changes}
    arrays["about"] = np.frombuffer(json.dumps(header).encode(), np.uint8)
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"version": 2}, "version 2"),
        ({"method": "magic"}, "method"),
        ({"settings": {"voxel": -1}}, "voxel"),
        (
            {"models": {"objects": {"at": 0, "classes": ["on"], "columns": ["gap"], "temperature": 1}}},
            "fit together",
        ),
        ({"models": {"objects": {"at": 9, "classes": ["on"], "columns": ["gap"], "temperature": 1}}}, "lacks"),
        ({"names": 7}, "cannot be read|can be read"),
    ],
)
def test_a_file_whose_parts_do_not_fit_is_refused(clouds, changes, said):
    content = model_bytes(RelationClassifier(trees=TreeSettings(3, 3)).fit(clouds, TRUTHS))
    with pytest.raises(InputError, match=said):
        model_from_bytes(rewritten(content, **changes))


def test_random_damage_never_comes_through_as_another_error(clouds):
    content = bytearray(model_bytes(RelationClassifier(trees=TreeSettings(3, 3)).fit(clouds, TRUTHS)))
    rng = np.random.default_rng(0)
    for _ in range(300):
        hurt = bytearray(content)
        for at in rng.integers(0, len(hurt), 3):
            hurt[at] = rng.integers(256)
        try:
            model_from_bytes(bytes(hurt)).predict(clouds[0])
        except InputError:
            continue


def test_the_shipped_model_knows_the_blocks_and_is_small(clouds):
    model = shipped_model()
    assert SHIPPED.stat().st_size <= 2 * 2**20
    assert {"scenes", "pairs", "lifelore"} <= set(model_about(SHIPPED)["about"])
    found = {(one.a, one.b): one.relation for cloud in clouds[:1] for one in model.predict(cloud)}
    assert found[3, 2] == ON
    assert found[2, TABLE] == ON
    assert model.predict(clouds[1])[0].relation == ADJACENT
    assert model.predict(clouds[2])[0].relation == NONE


def test_asking_a_model_needs_no_scikit_learn():
    ask = (
        "import sys; from lifelore.perception.relation_model_file import shipped_model; import numpy as np;"
        "from lifelore.core.labelled_cloud import LabelledCloud as C;"
        "x = np.random.default_rng(0).random((60, 3)) * 0.05;"
        "shipped_model().predict(C(x, np.repeat([2, 3], 30))); print('sklearn' in sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "False"
