"""The page of reproductions says what the committed results say."""

import json
from pathlib import Path

import pytest

from lifelore.core.errors import InputError
from lifelore.experiments.engine.registry import built_ids, claim_of
from lifelore.experiments.engine.report import read_results, render_report, write_report
from lifelore.experiments.engine.reproduce import MAX_BYTES, RESULT_KEYS, reproduce

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "results"
PAGE = ROOT / "docs" / "reproduction.md"


def test_page_agrees_with_results():
    assert PAGE.read_text(encoding="utf-8") == render_report(RESULTS), "run: make docs"


@pytest.mark.parametrize("result", read_results(RESULTS), ids=lambda r: r["claim"])
def test_committed_results_are_full_and_their_verdict_follows_from_their_numbers(result):
    claim = claim_of(result["claim"])
    assert tuple(result) == RESULT_KEYS
    assert result["mode"] == "full"
    assert result["settings"] == claim.settings("full")
    assert result["verdict"] == claim.predicate.verdict(result["measured"])
    assert result["why"] == claim.predicate.why(result["measured"], claim.causes)
    assert result["thesis"] == claim.thesis
    assert (RESULTS / claim.id / "result.json").stat().st_size <= MAX_BYTES
    assert (RESULTS / claim.id / "figure.png").is_file()


def test_every_claim_that_is_built_has_a_committed_result():
    assert [result["claim"] for result in read_results(RESULTS)] == list(built_ids())


def test_page_of_a_quick_run(tmp_path):
    reproduce(["C3.1"], "quick", {"mazes": 20}, out=tmp_path)
    text = write_report(tmp_path, tmp_path / "page.md").read_text(encoding="utf-8")
    result = json.loads((tmp_path / "C3.1" / "result.json").read_text(encoding="utf-8"))
    assert f"**Verdict: {result['verdict']}.** {result['why']}" in text
    assert "| [C3.1](#c3-1) | Fig 3.1 |" in text
    assert "54 of 55 claims have no result yet" in text
    assert all(f"| `{name}` |" in text for name in result["measured"])


def test_a_damaged_result_is_one_line(tmp_path):
    (tmp_path / "C3.1").mkdir()
    (tmp_path / "C3.1" / "result.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match=r"is not JSON; run `lifelore reproduce C3\.1 --full` again"):
        render_report(tmp_path)
