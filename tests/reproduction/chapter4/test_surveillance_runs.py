"""Tasks, libraries and counts of the surveillance claims: shared noise, unseen places, summaries by hand."""

import numpy as np
import pytest

from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.selection.information import mutual_information
from reproduction.chapter4.surveillance.peers import GIVEN, PEERS, make_peer, tuning_grid
from reproduction.chapter4.surveillance.runs import (
    DEFAULT_WORLD,
    EXACT,
    LEARNT,
    MIXED,
    RULES,
    SEEN,
    draw_tasks,
    find,
    library_of,
    name_of,
    play,
    run_method,
    summary,
)

SETTINGS = {"tasks": 5, "episodes": 12, "samples": 4, "after": [5, 10, 20]}
WORLD = Surveillance()


def test_unseen_tasks_are_every_second_and_lie_between_targets():
    tasks = draw_tasks(WORLD, MIXED, 8, 3, 1, 0)
    assert tasks.seen.tolist() == [True, False] * 4
    # At a target one policy pays 210; elsewhere none does.
    assert (tasks.mean.max(axis=1) == 210).tolist() == tasks.seen.tolist()
    assert draw_tasks(WORLD, SEEN, 8, 3, 1, 0).seen.all()


def test_noise_is_shared_by_reserves_and_cases_and_not_by_groups():
    first = draw_tasks(WORLD, SEEN, 4, 6, 1, 0)
    other = draw_tasks(Surveillance("ring", "euclidean"), MIXED, 4, 6, 1, 0)
    assert (first.noise == other.noise).all()
    assert (first.noise != draw_tasks(WORLD, SEEN, 4, 6, 1, 1).noise).all()


def test_libraries():
    exact = library_of(WORLD, EXACT, 4, 1, 0)
    assert (exact.performance.mean == WORLD.mean).all()
    learnt = library_of(WORLD, LEARNT, 4, 1, 0)
    assert np.abs(learnt.performance.mean - WORLD.mean).mean() == pytest.approx(
        20 / 2 * (2 / np.pi) ** 0.5, rel=0.1
    )
    assert (library_of(WORLD, LEARNT, 4, 1, 0).performance.mean == learnt.performance.mean).all()
    assert (library_of(WORLD, LEARNT, 4, 1, 1).performance.mean != learnt.performance.mean).all()


def test_without_noise_and_with_exact_models_one_hilltop_and_the_target():
    quiet = Surveillance(deviation=0.01)
    tasks = draw_tasks(quiet, SEEN, 6, 8, 1, 0)
    library = library_of(quiet, EXACT, 4, 1, 0)
    policies, entropy = play("IDS", library, quiet, tasks, np.random.default_rng(0))
    assert entropy is not None
    assert (policies[:, -1] == tasks.mean.argmax(axis=1)).all()
    assert entropy[:, -1] == pytest.approx(np.zeros(6), abs=1e-6)


@pytest.mark.parametrize("name", ["EI", "sampling", "UCB1, tuned", "GP-UCB, prior covariance"])
@pytest.mark.parametrize("case", ["headline", "exact"])
def test_a_small_run_of_a_rule_or_peer(name, case):
    cell = {"method": name, "case": case, **DEFAULT_WORLD, "groups": 3}
    found = run_method(SETTINGS, cell, 2)
    assert found == run_method(SETTINGS, cell, 2)
    assert len(found["sums"]) == len(found["seen"]) == 15
    assert len(found["curve"]["mean"]) == 12
    assert np.mean(found["sums"]) == pytest.approx(12 * np.mean(found["curve"]["mean"]), rel=1e-3)
    assert set(found["at"]) == {"5", "10"}
    assert ("entropy" in found) is (name in RULES)
    assert found["tuned"] in tuning_grid(name)


def test_summary_by_hand():
    result = {
        "method": "EI", "case": "exact", "groups": 2, "sums": [1.0, 2.0, 3.0, 4.0], "ended": [1, 2, 3, 51],
        "late": [0.0, 0.0, 5.0, 5.1],
    }  # fmt: skip
    found = summary(result)
    assert found["cumulative"].value == 2.5
    assert found["ended_median"].value == 2.5
    assert found["stuck"].value == 0.25
    assert found["late_median"].value == 2.5


def test_names_of_measures():
    assert name_of("EI, printed", "exact, with unseen") == "EI_printed_exact_with_unseen"
    assert name_of("BE, κ 30", "headline") == "BE_kappa_30_headline"


def test_every_peer_plays_and_says_what_it_was_given():
    library = library_of(WORLD, EXACT, 4, 1, 0)
    for name in PEERS:
        assert GIVEN[name]
        assert make_peer(name, library, WORLD, 3, 10, np.random.default_rng(0)).select().shape == (3,)


def test_find_takes_the_default_reserve():
    base = {"method": "EI", "case": "exact"}
    results = [{**base, **DEFAULT_WORLD, "layout": "ring"}, {**base, **DEFAULT_WORLD}]
    assert find(results, "EI", "exact")["layout"] == "X"
    assert find(results, "EI", "exact", layout="ring")["layout"] == "ring"


def test_a_hilltop_tells_the_most_and_costs_the_most():
    """Erratum: "a weak signal" says the thesis; and from far away it pays less than nothing."""
    library = library_of(WORLD, EXACT, 0, 1, 0)
    told = mutual_information(library.prior, library.table(32))
    assert set(np.argsort(told)[-4:]) == set(np.flatnonzero(WORLD.is_hilltop))
    cost = library.prior @ (WORLD.mean.max(axis=1, keepdims=True) - WORLD.mean)
    assert cost[WORLD.is_hilltop] == pytest.approx(np.full(4, 258.0), abs=0.5)
    assert cost[~WORLD.is_hilltop].max() < 200
    assert WORLD.mean.min() == 200 - 30 * 15 + 10
