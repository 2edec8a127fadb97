"""docs/policy_reuse.md and docs/log_to_choices.md: their Python and commands run and print what they show."""

import re
from pathlib import Path

import numpy as np
import pytest

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.selection import RULES, ExpectedImprovement, Greedy
from tests.page_block import run_block

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "policy_reuse.md").read_text(encoding="utf-8")
LOG_PAGE = (DOCS / "log_to_choices.md").read_text(encoding="utf-8")
ALONE, TUTORIAL = (re.findall(r"^```(python|sh)\n(.*?)^```", page, flags=re.S | re.M) for page in (PAGE, LOG_PAGE))


@pytest.mark.parametrize(
    ("place", "said"),
    [
        (0, r"C \[0\.0\d 0\.0\d 0\.9\d\]\n"),
        (1, r"\[0\.\d+ 0\.\d+\] \[.*\]\n(left|right) \d+\.\d+\n"),
        (2, r"\[0 1\] 3 \[\[0\. 1\.\]\]\n\[1 1\]\n\[\[0 1\]\]\n"),
        (3, r"(19|20) of the last 20 won\n"),
    ],
)
def test_each_piece_alone(place, said, tmp_path):
    assert re.fullmatch(said, run_block(*ALONE[place], tmp_path))


@pytest.mark.slow
def test_the_tutorial_from_a_log_to_its_end(tmp_path):
    assert [kind for kind, _ in TUTORIAL] == ["python", "sh", "python", "sh"]
    said, chosen, measured, managed = (run_block(*block, tmp_path) for block in TUTORIAL)
    assert said == ""
    fitted, *_, policy, decision = chosen.splitlines()
    assert re.match(r"study default: 720 outcomes of 60 users, 6 policies, 10 types named", fitted)
    assert policy in ("top", "bottom", "left", "right", "rows", "columns")
    assert decision.startswith("decision ")
    for line in measured.splitlines():
        assert line in LOG_PAGE
    assert (tmp_path / "report" / "report.png").exists()
    assert "uplift " in managed
    assert "columns is retired" in managed
    assert "whole is given to the control group" in managed
    assert "new 3 and 12 decisions and lines of the past forgotten" in managed
    assert "default (archived)" in managed


def test_where_outcomes_are_0_or_1_expected_improvement_is_greedy():
    probs = np.random.default_rng(0).random((4, 5))
    performance = CategoricalOutcomes([0, 1], np.stack([1 - probs, probs], axis=2))
    library = PolicyLibrary(performance)
    for belief in np.random.default_rng(1).dirichlet(np.ones(4), 20):
        greedy, improving = (
            rule.scores(library, belief) for rule in (Greedy(), ExpectedImprovement(of="outcome"))
        )
        assert np.argsort(greedy).tolist() == np.argsort(improving).tolist()


def test_every_rule_is_told():
    named = set(re.findall(r"`([A-Z]\w+)\(", PAGE.split("## Choosing")[1].split("## Beliefs")[0]))
    assert {rule.__name__ for rule in RULES.values()} <= named
