"""Conformance of every claim, and that the registry is complete."""

import json
import pickle
import re
import subprocess
import tomllib
from functools import cache
from pathlib import Path

import pytest

from lifelore.core.errors import NotFoundError
from lifelore.figures.style import MAX_BYTES as MAX_FIGURE_BYTES
from reproduction.engine.registry import (
    ROOT,
    chapter_of,
    claim_folders,
    claim_ids,
    claim_of,
    found_ids,
    list_claims,
)
from reproduction.engine.reproduce import MAX_BYTES, RESULT_KEYS, judged, reproduce, stored_result
from reproduction.engine.statement import WORDS, filled

IDS = claim_ids()
THESIS = {"2": 13, "3": 19, "4": 16, "5": 10}
"""Claims of the thesis by chapter."""
ERRATA = set(re.findall(r"^## (E\d+) ", (ROOT.parent / "docs" / "errata.md").read_text(encoding="utf-8"), re.M))


@pytest.fixture(scope="session")
def quick(tmp_path_factory):
    """The quick run of a claim, run once a session, and the folder it was written to."""
    out = tmp_path_factory.mktemp("results")

    @cache
    def run(claim_id: str) -> dict:
        return reproduce([claim_id], "quick", jobs=1, out=out)[0]

    return run, out


def test_registry_is_complete():
    for chapter, n in THESIS.items():
        assert [i for i in IDS if chapter_of(i) == chapter] == [
            f"C{chapter}.{number}" for number in range(1, n + 1)
        ]
    assert {folder.name for folder in ROOT.glob("*/*_[0-9][0-9]_*")} == {f.name for f in claim_folders().values()}


def test_list_names_all_claims():
    assert [row["claim"] for row in list_claims()] == list(IDS)
    assert set(list_claims()[0]) == {"claim", "figure", "title", "sentence"}


def test_claims_are_found_by_their_figure():
    assert found_ids("C3.4") == found_ids("3.7") == ["C3.4"]
    for name in ("C9.9", "9.9"):
        with pytest.raises(NotFoundError, match=rf"no claim or figure '{name}'; .*--list"):
            found_ids(name)


# Tests of one claim go to one worker (see the scheduler in tests/conftest.py), so that its quick run is run once.
@pytest.mark.parametrize("claim_id", IDS)
class TestEveryClaim:
    def test_modes_have_the_same_settings_of_the_same_types(self, claim_id):
        sizes = claim_of(claim_id).sizes
        types = [{key: type(value) for key, value in settings.items()} for settings in sizes.values()]
        assert types[0] == types[1]
        assert json.loads(json.dumps(sizes["full"])) == sizes["full"]

    def test_cells_are_different_plain_data(self, claim_id):
        claim = claim_of(claim_id)
        texts = [json.dumps(cell) for cell in claim.cells(claim.settings("full"))]
        assert len(set(texts)) == len(texts) >= 1

    def test_run_of_a_cell_can_be_sent_to_another_process(self, claim_id):
        claim = claim_of(claim_id)
        assert pickle.loads(pickle.dumps(claim.run_cell)) is claim.run_cell

    def test_data_and_words_fit(self, claim_id):
        claim = claim_of(claim_id)
        assert claim.data == (("osd",) if claim.sizes["full"].get("real") else ())
        assert not claim.erratum or claim.erratum in ERRATA
        assert len({one.says for one in claim.statements}) == len(claim.statements)
        toml = claim_folders()[claim_id] / "claim.toml"
        assert len(toml.read_text(encoding="utf-8").splitlines()) <= 60
        assert max(len(words.split()) for words in (claim.thesis, claim.here)) <= 8

    def test_quick_run_writes_what_it_returns(self, claim_id, quick):
        run, out = quick
        result, path = run(claim_id), out / claim_id / "result.json"
        assert json.loads(path.read_text(encoding="utf-8")) == result
        assert path.stat().st_size <= MAX_BYTES
        picture = (out / claim_id / "figure.png").read_bytes()
        assert picture.startswith(b"\x89PNG")
        assert 10_000 < len(picture) <= MAX_FIGURE_BYTES

    def test_result_has_exactly_its_keys(self, claim_id, quick):
        claim, result = claim_of(claim_id), quick[0](claim_id)
        assert tuple(result) == RESULT_KEYS
        assert result["verdict"] in WORDS
        assert list(result["marks"]) == [one.says for one in claim.statements]
        assert all(set(number) == {"value", "median", "ci95", "n"} for number in result["measured"].values())
        assert result["settings"] == claim.settings("quick")
        assert filled(claim.here, result["measured"])
        assert filled(claim.decides, result["measured"])

    def test_stored_result_is_judged_by_conditions_filed_before_it(self, claim_id):
        """The commit that a stored result was made from held the statements and settings that judge it now."""
        claim, result = claim_of(claim_id), stored_result(ROOT / "results" / claim_id, claim_id)
        assert result is not None, f"run `lifelore reproduce --full {claim_id}`"
        assert result["mode"] == "full"
        assert result["settings"] == claim.settings("full")
        assert (result["verdict"], result["marks"]) == judged(claim, result["measured"], result["readings"])
        filed = at_commit(
            result["made"]["commit"], claim_folders()[claim_id].relative_to(ROOT.parent) / "claim.toml"
        )
        now = tomllib.loads((claim_folders()[claim_id] / "claim.toml").read_text(encoding="utf-8"))
        assert result["made"]["changed"] is False
        assert [{**one, "says": ""} for one in filed["statements"]] == [
            {**one, "says": ""} for one in now["statements"]
        ]
        assert filed["settings"] == now["settings"]


def at_commit(commit: str, path: Path) -> dict:
    """A TOML file as it stood at a commit; skips in a clone without history."""

    def git(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(["git", *arguments], capture_output=True, text=True, cwd=ROOT)

    if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
        pytest.skip("a clone without history")
    shown = git("show", f"{commit}:{path}")
    assert shown.returncode == 0, shown.stderr
    return tomllib.loads(shown.stdout)


def test_result_depends_on_the_seed_alone(quick, tmp_path):
    """On a cheap claim the whole path shows that a repetition is equal and another seed is not."""
    alone = quick[0]("C4.8")
    again = reproduce(["C4.8"], "quick", out=tmp_path)[0]
    assert {key for key in RESULT_KEYS if again[key] != alone[key]} <= {"seconds", "made"}  # the day may change
    other = reproduce(["C4.8"], "quick", out=tmp_path, seed=1)[0]
    assert (other["measured"], other["rows"]) != (alone["measured"], alone["rows"])
