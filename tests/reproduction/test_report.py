"""The page of reproductions says what the committed results say."""

import json
import subprocess
from pathlib import Path

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.claim_section import verdict_now
from reproduction.engine.more_seeds import pooled
from reproduction.engine.predicate import VERDICTS, number_in_words
from reproduction.engine.registry import built_ids, claim_of
from reproduction.engine.report import (
    draw_summary,
    read_results,
    render_pages,
    verdicts,
    write_pages,
)
from reproduction.engine.reproduce import MAX_BYTES, RESULT_KEYS, reproduce, rounded
from reproduction.engine.run_again import minutes, run_again
from reproduction.engine.second_reading import SECOND_VERDICTS

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "results"
PAGES = ROOT / "docs" / "reproduction"


def test_pages_agree_with_results():
    committed = {path.name: path.read_text(encoding="utf-8") for path in PAGES.glob("*.md")}
    assert committed == render_pages(RESULTS), "run: make docs"


@pytest.mark.parametrize("result", read_results(RESULTS), ids=lambda r: r["claim"])
def test_committed_results_are_full_and_their_verdict_follows_from_their_numbers(result):
    claim = claim_of(result["claim"])
    # Results from before 23 November 2026 have no second reading, and do not say what they were made on.
    keys = tuple(key for key in result if key != "seeds")
    assert keys in (RESULT_KEYS, tuple(key for key in RESULT_KEYS if key not in ("made", "second")))
    assert result["mode"] == "full"
    assert result["settings"] == claim.settings("full")
    assert result["verdict"] == claim.predicate.verdict(result["measured"])
    assert result["why"] == claim.predicate.why(result["measured"], claim.causes_in_words())
    assert result["thesis"] == claim.thesis
    if result.get("second"):
        assert claim.second is not None
        assert result["second"]["verdict"] == claim.second.verdict(result["measured"])
        assert result["second"]["why"] == claim.second.said(result["measured"])
    assert set(result["measured"]) >= {c.measure for c in claim.predicate.conditions}
    assert set(result["measured"]) == claim.read_measures() or "second" not in result
    assert (RESULTS / claim.id / "result.json").stat().st_size <= MAX_BYTES
    assert (RESULTS / claim.id / "figure.png").is_file()


@pytest.mark.parametrize(
    "result", [one for one in read_results(RESULTS) if one.get("second")], ids=lambda r: r["claim"]
)
def test_a_second_reading_was_filed_before_the_run_that_it_judges(result):
    made, filed = result["made"], f"tests/reproduction/filed_readings/{result['claim']}.json"
    assert made["changed"] is False

    def git(*arguments):
        return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True, check=False)

    if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
        pytest.skip("needs the history of the repository")
    last_change = git("log", "-1", "--format=%H", "--", filed).stdout.strip()
    assert last_change
    assert git("merge-base", "--is-ancestor", last_change, made["commit"]).returncode == 0


@pytest.mark.parametrize(
    "result", [one for one in read_results(RESULTS) if one.get("seeds")], ids=lambda r: r["claim"]
)
def test_a_pool_of_seeds_follows_from_its_numbers(result):
    pool, second = result["seeds"], claim_of(result["claim"]).second
    first = pool["by_seed"][0]
    assert (pool["mode"], pool["settings"]) == ("full", result["settings"])
    assert pool["seeds"] == [one["seed"] for one in pool["by_seed"]] == list(range(len(pool["seeds"])))
    assert first["measured"] == {name: result["measured"][name] for name in pool["pooled"]}
    for name, number in pool["pooled"].items():
        assert number == rounded(pooled([one["measured"][name] for one in pool["by_seed"]]))
    assert pool["verdict"] == second.verdict(pool["pooled"])
    for one in pool["by_seed"]:
        assert one["verdict"] == second.verdict(one["measured"])
        assert one["made"]["changed"] is False


def test_the_index_says_of_every_claim_what_holds_and_why_some_cannot_be_told():
    index = render_pages(RESULTS)["index.md"]
    sentences, _, rest = index.partition("## Claims without an answer, and why")
    for result in read_results(RESULTS):
        claim = claim_of(result["claim"])
        assert sentences.count(claim.sentence) == 1
        chapter = sentences.partition(f"(chapter{claim.id[1]}.md)\n")[2]
        verdict = chapter.partition(claim.sentence)[0].rpartition("\n**")[2].partition("**\n")[0]
        assert verdict.lower() == verdict_now(result)
        if result["verdict"] == "cannot be tested":
            assert f"#{claim.id.lower().replace('.', '-')}): {claim.ran}" in rest


def test_the_index_says_what_running_again_costs_and_what_came_of_it():
    shared = [result for result in read_results(RESULTS) if result["claim"] in ("C2.1", "C2.2", "C3.2")]
    assert minutes(shared) == pytest.approx((shared[0]["seconds"] + shared[2]["seconds"]) / 60), (
        "shared cells once"
    )
    lines = "\n".join(run_again(shared, [], "results"))
    assert f"{minutes(shared):.0f} minutes of processor time" in lines
    assert "claims that simulate\nphysics (C2.1, C2.2)" in lines
    assert "Last run" not in lines
    made = {"date": "2030-01-02", "commit": "0123456789", "processor": "P"}
    commit_of = {result["claim"]: result["made"]["commit"] for result in shared}
    one = {"equal": True, "made": made, "n_differences": 0, "verdict": "holds"}
    verified = [
        {**one, "claim": "C2.1", "of": commit_of["C2.1"]},
        {**one, "claim": "C2.2", "of": commit_of["C2.2"], "equal": None, "made": None},
        {**one, "claim": "C3.2", "of": "before", "equal": False, "n_differences": 3, "verdict": "undecided"},
    ]
    lines = "\n".join(run_again(shared, verified, "results"))
    assert "1 of 2 results were equal to the last digit (2030-01-02, commit 0123456, P)." in lines
    assert "Others differ: C3.2 (3 numbers, verdict undecided)." in lines
    assert "Made since then, and not run again: C3.2." in lines


def test_every_claim_that_is_built_has_a_committed_result():
    assert [result["claim"] for result in read_results(RESULTS)] == list(built_ids())


def test_pages_of_a_quick_run(tmp_path):
    reproduce(["C3.1"], "quick", {"mazes": 20}, out=tmp_path)
    folder = write_pages(tmp_path, tmp_path / "pages")
    assert {path.name for path in folder.iterdir()} == {"index.md", "chapter3.md"}
    result = json.loads((tmp_path / "C3.1" / "result.json").read_text(encoding="utf-8"))
    index, page = ((folder / name).read_text(encoding="utf-8") for name in ("index.md", "chapter3.md"))
    assert "| [C3.1](chapter3.md#c3-1) | Fig 3.1 |" in index
    assert f"**{result['verdict']} (quick run)** |" in index
    assert "56 of 57 claims have no result yet" in index
    second = result["second"]["verdict"]
    assert f"**{second.capitalize()}** (first reading: {result['verdict']}). Fig 3.1." in page
    assert "| headline | no useful action collides | at most 0 |" in page
    assert f"- [C3.1](chapter3.md#c3-1) {claim_of('C3.1').sentence}" in index
    assert "- C3.2: built, its full run has not been made yet." in index
    for condition in claim_of("C3.1").predicate.conditions:
        assert f"| {claim_of('C3.1').words_of(condition)} | " in page
        assert number_in_words(result["measured"][condition.measure]) in page


def test_all_verdicts_at_a_glance(tmp_path):
    reproduce(["C3.1"], "quick", {"mazes": 20}, out=tmp_path)
    rooms = verdicts(tmp_path)
    assert [len(tiles) for tiles in rooms.values()] == [13, 19, 17, 8]
    ((name, first, second),) = [tile for tiles in rooms.values() for tile in tiles if tile[1]]
    assert (name, first in VERDICTS, second in SECOND_VERDICTS) == ("C3.1", True, True)
    draw_summary(tmp_path)
    assert (tmp_path / "verdicts.png").read_bytes().startswith(b"\x89PNG")


def test_a_damaged_result_is_one_line(tmp_path):
    (tmp_path / "C3.1").mkdir()
    (tmp_path / "C3.1" / "result.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match=r"is not JSON; run `lifelore reproduce C3\.1 --full` again"):
        render_pages(tmp_path)
