"""Measures of C5.3 from made-up cells, by hand."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter5.c5_03_priors_in_search.measure import measure, rows
from reproduction.chapter5.c5_03_priors_in_search.run import (
    BOTH,
    EVEN,
    FLAT,
    INDICES,
    KINDS,
    MEAN,
    MOST,
    PLAIN,
    PRUNED,
    WAYS,
)
from reproduction.engine.registry import claim_of
from reproduction.engine.results_table import ResultsTable

CLAIM = claim_of("C5.3")
QUICK = dict(claim_of("C5.3").sizes["quick"])

SETTINGS = {**QUICK, "mazes": 6, "forms": ["proportion", "support"], "other_strengths": []}
"""Two kinds, two forms, three ways and two numbers of simulations: 24 guided ways of tree search."""


def made_up(reached=lambda kind, form, guides, move, maze: maze < 5, nodes=8.0, lost=None):
    """Without a prior half of six mazes are solved, 10 nodes expanded and 20 lost, with some spread by maze."""
    lost = lost or {FLAT: 20.0, EVEN: 15.0, "proportion": 10.0, "support": 12.0}
    found = []
    for maze in range(6):
        ways = [(None, PLAIN, None, move) for move in (MOST, MEAN)]
        ways += [(kind, form, *way) for kind in KINDS for form in SETTINGS["forms"] for way in WAYS]
        searches = [
            {
                **dict(zip(("kind", "form", "guides", "move", "simulations"), (*way, n), strict=True)),
                "reached": maze % 2 == 0 if way[0] is None else reached(*way, maze),
                "steps": 10 + maze,
                "collisions": 0,
            }
            for n in SETTINGS["simulations"]
            for way in ways
        ]
        own = {"reached": 1.0, "moves": 5.0 + maze}
        orders = [{"search": s, "kind": None, "form": PLAIN, "expanded": 10.0 + maze, **own} for s in ORDERED]
        orders += [
            {"search": search, "kind": kind, "form": form, "expanded": nodes + 0.5 * maze, **own}
            for search in (*ORDERED, PRUNED)
            for kind in KINDS
            for form in (SETTINGS["forms"] if search == "depth first" else ["proportion"])
        ]
        starts = [(None, FLAT, 0.0), (None, EVEN, 4.0)]
        starts += [(kind, form, 4.0) for kind in KINDS for form in SETTINGS["forms"]]
        arms = []
        for index in INDICES:
            for kind, form, strength in starts:
                regret = lost[form] + maze * (1 + 0.01 * (kind is None))
                about = {"index": index, "kind": kind, "form": form, "strength": strength, "regret": regret}
                arms.append(about if form == "support" else {**about, "curve": [0.0, regret]})
        found.append({"maze": maze, "search": searches, "depth_first": orders, "bandit": arms})
    return found


ORDERED = ("depth first", "deepening")


def test_headline_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["gain_percept_50"].value == pytest.approx(2 / 6)
    # 8 + maze/2 and 10 + maze have the means 9.25 and 12.5.
    assert found["nodes_ratio_place"].value == pytest.approx(9.25 / 12.5)
    table = ResultsTable(rows(SETTINGS, made_up()), ("use", "search", "kind", "form", "move", "simulations"))
    plain = table.record(use="search", kind=None, form=PLAIN, move=MOST, simulations=50)
    assert plain["success"]["value"] == pytest.approx(3 / 6)
    pruned = table.record(use="depth first", search=PRUNED, kind="percept")
    assert pruned["ratio"]["value"] == pytest.approx(9.25 / 12.5)
    assert (pruned["moves_ratio"]["value"], pruned["reached"]["value"]) == (pytest.approx(1), 1)
    # Mazes add 2.5 on average, 2.525 without a prior.
    assert found["ucb1_ratio_place"].value == pytest.approx(12.5 / 22.525)
    assert found["beta_even_ratio_percept"].value == pytest.approx(12.5 / 17.525)


def test_the_default_is_the_support_guiding_both_and_the_move_tried_most():
    def only_there(kind, form, guides, move, maze):
        return (form, guides, move) == ("support", BOTH, MOST)

    found = measure(SETTINGS, made_up(only_there))
    # Of twelve ways at each number of simulations two are better, by all of the odd mazes.
    better = [row for row in rows(SETTINGS, made_up(only_there)) if row.get("success", {}).get("value") == 1]
    assert len(better) == 4
    assert found["share_of_ways_better"].value == pytest.approx(4 / 24)
    # In the others all is lost, the three mazes that were solved without.
    assert found["share_of_ways_worse"].value == pytest.approx(20 / 24)


def test_the_verdict_follows():
    def verdict(cells):
        measured = {name: number.to_dict() for name, number in measure(SETTINGS, cells).items()}
        return CLAIM.predicate.verdict(measured)

    always = made_up(lambda *_: True)
    assert verdict(always) == "holds"
    assert verdict(made_up()) == "holds in part"  # two mazes of six are no gain that is sure
    worse = {FLAT: 20.0, EVEN: 15.0, "proportion": 30.0, "support": 12.0}
    assert verdict(made_up(nodes=30.0, lost=worse)) == "does not hold"


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


def test_the_figure_is_drawn_from_rows_alone():
    cells = made_up()
    figure = CLAIM.draw({"settings": SETTINGS, "rows": json.loads(json.dumps(rows(SETTINGS, cells)))})
    assert [axes.get_title("left") for axes in figure.axes] == [
        "Tree search, 50 simulations",
        "Tree search, 200 simulations",
        "Depth-first search",
        "UCB1",
        "Thompson, Beta",
        "Thompson, normal",
    ]
    assert "without prior: 50 %, by best mean 50 %" in figure.axes[0].get_xlabel()
    assert len(figure.axes[3].lines) == 4
    assert np.asarray(figure.axes[3].lines[0].get_ydata()) == pytest.approx([0, 22.525])


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"forms": '["proportion"]'}, "forms must include the defaults"),
        ({"density": "[0.8, 0.5]"}, "density must be two shares"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
