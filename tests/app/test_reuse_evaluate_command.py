"""`lifelore reuse evaluate`: the printed table, its options, and one line for every mistake."""

import re

import numpy as np
import pytest


@pytest.fixture
def log(tmp_path):
    """Sixty users of four random decisions, under names of another program."""
    generator = np.random.default_rng(0)
    lines = ["visitor,banner,clicked,propensity"]
    for user in range(60):
        for _ in range(4):
            policy = generator.integers(2)
            lines.append(f"v{user},{('big', 'dark')[policy]},{int(generator.random() < (0.7, 0.3)[policy])},0.5")
    path = tmp_path / "log.csv"
    path.write_text("\n".join([*lines, "v1,big,,0.5"]) + "\n")
    return path


COLUMNS = ("--columns", "user=visitor,policy=banner,outcome=clicked,probability=propensity")
ESTIMATE = r"-?[\d.e-]+ \(-?[\d.e-]+ to -?[\d.e-]+\)"


@pytest.mark.slow
def test_in_words(ask, log, tmp_path):
    said = ask("reuse", "evaluate", log, *COLUMNS, "--out", tmp_path / "out").out
    first, left, header, big, dark, *rest = said.splitlines()
    assert re.fullmatch(rf"240 decisions for 60 users; mean outcome of the log {ESTIMATE}", first)
    assert left == "  1 lines without an outcome left out"
    assert header.split("  ")[1:2] == ["target"]
    assert re.fullmatch(rf"  big +{ESTIMATE} +{ESTIMATE} +\d+\.\d +2 +100%", big)
    assert re.fullmatch(rf"  dark +{ESTIMATE} +{ESTIMATE} +\d+\.\d +2 +100%", dark)
    assert rest == [f"evaluation.json and evaluation.png written to {tmp_path / 'out'}"]
    assert (tmp_path / "out" / "evaluation.png").exists()


@pytest.mark.slow
def test_all_estimators_and_a_rule(ask, log):
    said = ask("reuse", "evaluate", log, *COLUMNS, "--estimator", "all", "--rule", "sampling", "--types", "2").out
    assert re.search(
        r"target +ips +self-normalised +doubly-robust +effective users +largest weight +support\n", said
    )
    assert re.search(rf"  sampling, next decision +{ESTIMATE} +{ESTIMATE} +{ESTIMATE} ", said)
    assert "big" not in said
    whole = ask("reuse", "evaluate", log, *COLUMNS, "--rule", "greedy", "--types", "2", "--first", "2").out
    assert "  greedy, first 2 decisions " in whole
    assert "  120 later decisions of users left out\n" in whole


def test_as_json(ask, log, tmp_path):
    table = tmp_path / "mix.csv"
    table.write_text("policy,probability\nbig,0.5\ndark,0.5\n")
    document = ask("reuse", "evaluate", log, *COLUMNS, "--target", table, "--policy", "big", "--json").document
    big, mix = document["targets"]
    assert (big["name"], mix["name"], mix["kind"]) == ("big", "mix", "table")
    assert set(big["estimates"]) == {"ips", "self-normalised", "doubly-robust"}
    assert set(big["estimates"]["ips"]) == {"value", "standard_error", "ci95", "n", "gain"}
    assert mix["estimates"]["ips"]["value"] == pytest.approx(document["logged"]["value"])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--estimator", "best"], "estimator must be one of ips, self-normalised, doubly-robust, all, got 'best'"),
        (["--policy", "round"], "policy 'round' was never chosen in the log, so nothing is known of it"),
        (["--rule", "none"], "none"),
        (["--target", "nowhere.csv"], "target 'nowhere.csv' is no file; give a CSV file with columns"),
        (["--group", "men"], "the logs have no column 'group'"),
        (["--model", "forest"], "model must be one of means, library, got 'forest'"),
    ],
)
def test_a_mistake_is_one_line(ask, log, options, words):
    refusal = ask("reuse", "evaluate", log, *COLUMNS, *options).refusal
    assert words in refusal
    assert refusal.count("\n") <= 1


def test_a_study_needs_its_memory(ask, log):
    refusal = ask("reuse", "evaluate", log, *COLUMNS, "--study", "default", "--memory", "none.db").refusal
    assert "none.db does not exist" in refusal
