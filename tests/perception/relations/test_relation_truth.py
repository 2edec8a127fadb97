"""The two CSV files, and what is wrong with a bad row in one line."""

import numpy as np
import pytest

from lifelore.core import InputError, PairLabel
from lifelore.perception.relations.relation_truth import read_planes, read_relations

HEADER = "scene,a,b,relation,confidence\n"


@pytest.fixture
def file(tmp_path):
    def write(text: str):
        path = tmp_path / "some.csv"
        path.write_bytes(text.encode("utf-8"))
        return path

    return write


def test_labels_are_read_by_scene_in_order(file):
    path = file("\ufeff" + HEADER + "learn1,3,2,on,3\nlearn0,2,3,adjacent,1\nlearn1, 2 ,1,on,2\n")
    assert read_relations(path) == {
        "learn1": (PairLabel(3, 2, "on", 3), PairLabel(2, 1, "on", 2)),
        "learn0": (PairLabel(2, 3, "adjacent", 1),),
    }


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "columns"),
        ("scene,a,b,relation\nx,2,3,on\n", "confidence missing"),
        (HEADER, "no rows"),
        (HEADER + "x,2,3,on\n", "line 2: 5 fields"),
        (HEADER + "x,2,3,on,3\nx,two,3,on,3\n", "line 3: a must be a whole number"),
        (HEADER + "x,2,3,on,4\n", "confidence must be a whole number from 1 to 3"),
        (HEADER + "x,2,2,on,3\n", "must differ"),
        (HEADER + "x,0,2,on,3\n", "a must be"),
        (HEADER + "x,2,3,,3\n", "relation must be"),
        (HEADER + "x,2,3,~on,3\n", "relation must be"),
        (HEADER + "x,99999999999999999999,3,on,3\n", "a must be"),
    ],
)
def test_a_bad_row_is_named(file, text, said):
    with pytest.raises(InputError, match=said) as caught:
        read_relations(file(text))
    assert "\n" not in str(caught.value)


def test_planes_have_unit_normals(file):
    planes = read_planes(file("scene,nx,ny,nz,d\ns,0,0,2,1\n"))
    np.testing.assert_allclose(planes["s"], [0, 0, 1, 0.5])
    for wrong in ("s,0,0,0,1", "s,a,0,1,1", "s,nan,0,1,1"):
        with pytest.raises(InputError, match="line 2"):
            read_planes(file(f"scene,nx,ny,nz,d\n{wrong}\n"))


def test_files_that_cannot_be_read_are_one_line(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_relations(tmp_path / "none.csv")
    (tmp_path / "bytes.csv").write_bytes(b"scene,a,b,relation,confidence\n\xff\xfe,2,3,on,3\n")
    with pytest.raises(InputError, match="no CSV"):
        read_relations(tmp_path / "bytes.csv")
