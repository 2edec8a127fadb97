"""Measures of C3.18 from made-up cells, by hand."""

import pytest

from lifelore.core.errors import InputError
from lifelore.domains.advice.explorers import EXPLORERS
from reproduction.chapter3.c3_18_normalcy.measure import measure, rows
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.18")
QUICK = dict(claim_of("C3.18").sizes["quick"])

SETTINGS = {**QUICK, "tasks": 2, "max_steps": 4, "blocks": 2}


def made_up(unadvised: float | None = 0.8):
    """Three mazes: told, P(M₁ | H) rises from 0.2 to 0.6; own steps raise only the bug's, by 0.1."""
    cells = []
    for maze in range(3):
        entries = []
        for experts in SETTINGS["experts"]:
            for agent in EXPLORERS:
                own = 0.3 if agent == "bug" else 0.2
                curve = {"p": [2.0, 0.0], "n": [4, 0], "reached": [0, 1]}
                entries.append(
                    {
                        "experts": experts,
                        "agent": agent,
                        "alone": [0.1, 0.3],
                        "told": [0.5 + 0.01 * maze, 0.7 + 0.01 * maze],
                        "own": [own - 0.1, own + 0.1],
                        "unadvised": [None, unadvised],
                        "curve_alone": curve,
                        "curve_told": curve,
                    }
                )
        cells.append({"loops": 0.1, "maze": maze, "explorers": entries})
    return cells


def test_every_reading_by_hand():
    found = {row["agent"]: row for row in rows(SETTINGS, made_up()) if row.get("experts") == "walks"}
    assert found["random"]["alone"] == pytest.approx(0.2)
    assert found["left"]["gain"]["told"] == pytest.approx(0.41)
    assert found["bug"]["gain"]["own"] == pytest.approx(0.1)
    assert found["random"]["gain"]["own"] == pytest.approx(0.0)
    # The first errand was advised throughout: only the second is compared, with its own walk alone.
    assert found["avoid"]["gain"]["unadvised"] == pytest.approx(0.5)
    assert found["avoid"]["unadvised"] == pytest.approx(0.8)


def test_explorers_raised_by_hand():
    found = measure(SETTINGS, made_up())
    raised = [found[f"explorers_raised{name}"].value for name in ("", "_own", "_unadvised")]
    assert raised == [4, 1, 4]
    assert found["grid_all_raised"].value == 1.0
    assert found["grid_all_raised_own"].value == 0.0


def test_each_explorers_gain_is_a_headline():
    found = measure(SETTINGS, made_up())
    # 0.40, 0.41 and 0.42 in the three mazes.
    gains = [found[f"gain_{agent}"] for agent in EXPLORERS]
    assert [gain.value for gain in gains] == pytest.approx([0.41] * 4)
    assert all(0.40 <= gain.ci95[0] < gain.ci95[1] <= 0.42 for gain in gains)
    measured = {name: number.to_dict() for name, number in found.items()}
    assert CLAIM.second.answers(measured, "headline") == ["yes"] * 4
    measured["gain_left"] |= {"value": 0.1, "ci95": [-0.1, 0.3]}
    assert CLAIM.second.verdict(measured) == "undecided"


def test_where_all_was_advised_nothing_is_said_of_untold_steps():
    found = measure(SETTINGS, made_up(unadvised=None))
    assert found["explorers_raised_unadvised"].value == 0
    row = rows(SETTINGS, made_up(unadvised=None))[0]
    assert row["gain"]["unadvised"] is row["unadvised"] is None
    assert row["certain"]["unadvised"] is False


def test_rows_hold_the_grid_and_the_curves():
    found = rows(SETTINGS, made_up())
    assert len(found) == 2 * 4 + 4 * 2
    assert found[0]["gain"] == {"told": 0.41, "own": 0.0, "unadvised": 0.5}
    assert found[0]["certain"] == {"told": True, "own": False, "unadvised": True}
    # Nobody walks in the second block; one of two errands in each maze has arrived by then.
    assert found[-1]["normal"] == [0.5, None]
    assert found[-1]["reward"] == [0.0, 500.0]


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"blocks": 7}, "blocks must divide max_steps"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
