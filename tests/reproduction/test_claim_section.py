"""A claim's section is short, shows what the verdict counts, and folds the rest."""

import re
from pathlib import Path

import pytest

from reproduction.engine.claim_section import MOST_WORDS, claim_section, verdict_now, visible_words
from reproduction.engine.condition_table import counted_rows, second_rows
from reproduction.engine.predicate import FAILS, HOLDS
from reproduction.engine.reason import reason_in_words
from reproduction.engine.registry import built_ids, claim_of
from reproduction.engine.report import read_results
from reproduction.engine.second_reading import NO, YES

MOST_WORDS_OF_A_REASON = 40
RESULTS = read_results(Path(__file__).parents[2] / "results")


def in_view(section: str) -> str:
    return section.partition("<details>")[0]


def test_words_are_counted_by_hand():
    section = "\n".join(
        ['<a id="c9-9"></a>', "## C9.9 — Doors", "**Holds.** See [the page](doors.md).", "| asked | met |",
         "|---|---|", "| at most 0.5 | **no** |", "![a picture](x.png)",
         "<details><summary>More</summary>", "folded", "</details>"]
    )  # fmt: skip
    assert visible_words(section) == 2 + 4 + 2 + 4


@pytest.mark.parametrize("result", RESULTS, ids=lambda r: r["claim"])
class TestEverySection:
    def test_is_short(self, result):
        assert visible_words(claim_section(result, "results")) <= MOST_WORDS, "shorten `ran` of its claim.toml"

    def test_shows_question_work_figure_and_verdict(self, result):
        claim, seen = claim_of(result["claim"]), in_view(claim_section(result, "results"))
        for part in (
            result["thesis"],
            claim.ran,
            f"results/{claim.id}/figure.png",
            f"**{verdict_now(result)}".lower(),
        ):
            assert part.lower() in seen.lower()

    def test_names_conditions_that_are_not_met_by_their_numbers(self, result):
        claim, seen = claim_of(result["claim"]), in_view(claim_section(result, "results"))
        rows = counted_rows(claim, result)
        missed = [row.number for row in rows if row.answer != YES]
        (why,) = [
            line
            for line in seen.splitlines()
            if re.match(rf"\*\*{verdict_now(result)}(\.\*\*|\*\*:|\*\*, but)", line, re.I)
        ]
        named = re.findall(r"(?:not met|bound|measured): ([\d, ]+)\.", why, flags=re.I)
        assert sorted(int(n) for numbers in named for n in numbers.split(", ")) == missed
        assert seen.count("| **no** |") <= sum(row.answer == NO for row in rows)

    def test_tables_have_a_cell_for_each_head(self, result):
        for table in re.findall(r"(?:^\|.*\n)+", claim_section(result, "results"), flags=re.M):
            heads, *lines = (len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines())
            assert set(lines) == {heads}, table

    def test_folds_every_condition_of_both_readings(self, result):
        claim, section = claim_of(result["claim"]), claim_section(result, "results")
        folded = section.removeprefix(in_view(section)).replace("\\|", "|")
        second = [row.condition for row in second_rows(claim, result["measured"])] if result.get("second") else []
        for condition in (*claim.predicate.conditions, *second):
            assert f"| {claim.words_of(condition)} | " in folded
        assert all(f"`{key}`" in folded for key in result["settings"])

    def test_reason_is_one_clause_with_numbers_of_the_result(self, result):
        reason = reason_in_words(claim_of(result["claim"]), result)
        assert "{" not in reason
        assert not reason.endswith(".")
        assert len(reason.split()) <= MOST_WORDS_OF_A_REASON


@pytest.mark.parametrize("result", RESULTS, ids=lambda r: r["claim"])
def test_a_verdict_follows_from_the_conditions_that_its_section_shows(result):
    answers = [row.answer for row in counted_rows(claim_of(result["claim"]), result)]
    if verdict_now(result) == HOLDS:
        assert set(answers) == {YES}
    elif verdict_now(result) == FAILS:
        assert NO in answers


def test_a_table_takes_names_where_words_do_not_fit():
    # C3.9 has thirteen conditions of some forty words each: too many words, not too many names.
    (result,) = [one for one in RESULTS if one["claim"] == "C3.9"]
    seen = in_view(claim_section(result, "results"))
    rows = counted_rows(claim_of("C3.9"), result)
    assert sum(len(row.condition.words.split()) for row in rows) > MOST_WORDS
    assert len(re.findall(r"^\| \d+ \| \w+ \| \*", seen, flags=re.M)) > 5


def test_every_claim_has_a_sentence_of_its_own():
    sentences = [claim_of(claim_id).sentence for claim_id in built_ids()]
    assert len(set(sentences)) == len(sentences)
    assert [one for one in sentences if not one.endswith(".") or len(one.split()) > 25] == []
