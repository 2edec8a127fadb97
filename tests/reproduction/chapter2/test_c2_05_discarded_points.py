"""C2.5: what is lost is a paired difference over scenes, border pairs apart; all of it on rows made by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.c2_05_discarded_points.measure import (
    judged_views,
    less_majority,
    lost,
    measure,
    rows,
    scene_of,
    taught,
)
from reproduction.chapter2.scoring.relation_scoring import JudgedPair
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C2.5")

UP, ASIDE = [[0.0, 0.0, 0.01]] * 4, [[0.03, 0.0, 0.0]] * 4
"""Displacements χ_2 - χ_3: of 2 on 3, and of 2 beside 3; four each, as many as neighbours vote."""
SPOILT = "discarded 0.7"
SETTINGS = {"levels": {"discarded": [0.7]}}


def answer(right: bool, scene: str, truth: str = "on") -> JudgedPair:
    said = truth if right else "both"
    return JudgedPair(scene, PairLabel(2, 3, truth), Relation(2, 3, said, 1.0, 0.0), 0.0)


def test_what_is_lost_is_paired():
    # Three of four right in both, but another one wrong: nothing is lost, and scenes say how sure that is.
    names = [str(number) for number in range(8)]
    whole = [answer(name != "0", name) for name in names]
    spoilt = [answer(name != "1", name) for name in names]
    found = lost({"whole": whole, SPOILT: spoilt}, SPOILT)
    assert (found.value, found.n) == (0.0, 8)
    assert found.ci95 is not None
    assert found.ci95[0] < 0 < found.ci95[1]
    # The very same ones wrong: nothing is lost for sure.
    assert lost({"whole": whole, SPOILT: whole}, SPOILT).ci95 == (0.0, 0.0)


def test_a_loss_by_hand_and_its_interval():
    # Twenty scenes of two pairs; five of the forty pairs, one a scene, are wrong after and right before.
    names = [str(number) for number in range(20) for _ in range(2)]
    whole = [answer(True, name) for name in names]
    spoilt = [answer(number % 8 != 0, name) for number, name in enumerate(names)]
    found = lost({"whole": whole, SPOILT: spoilt}, SPOILT)
    assert found.value == pytest.approx(5 / 40)
    assert found.n == 40
    assert found.ci95 is not None
    # The standard error of 5 in 20 scenes that lose half: √(0.25 · 0.75 / 20) / 2 = 0.048.
    assert found.ci95[0] == pytest.approx(0.125 - 1.96 * 0.048, abs=0.03)
    assert found.ci95[1] == pytest.approx(0.125 + 1.96 * 0.048, abs=0.03)
    assert found.ci95[0] <= found.value <= found.ci95[1]


def test_scenes_are_resampled_and_not_pairs():
    # Ten scenes of ten pairs, five of them wholly lost; and a hundred scenes of one pair, fifty lost.
    def width(names: list[str], gone: list[bool]) -> float:
        whole = [answer(True, name) for name in names]
        spoilt = [answer(not one, name) for name, one in zip(names, gone, strict=True)]
        found = lost({"whole": whole, SPOILT: spoilt}, SPOILT)
        assert found.value == 0.5
        assert found.ci95 is not None
        return found.ci95[1] - found.ci95[0]

    together = width([str(k // 10) for k in range(100)], [k // 10 % 2 == 0 for k in range(100)])
    apart = width([str(k) for k in range(100)], [k % 2 == 0 for k in range(100)])
    # Standard errors of 10 and of 100 fair answers are 0.158 and 0.05.
    assert together > 2 * apart


def test_nothing_is_lost_where_nothing_was_asked():
    assert lost({}, SPOILT).n == 0
    assert lost({"whole": [answer(True, "a")]}, SPOILT).n == 0


def test_above_the_commonest_relation_by_hand():
    # Of five, three are on (two of them told) and two none (told): 4/5 - 3/5.
    judged = [answer(number != 0, str(number)) for number in range(3)]
    judged += [answer(True, str(number), "none") for number in (3, 4)]
    found = less_majority(judged)
    assert (found.value, found.n) == (pytest.approx(0.2), 5)
    assert found.ci95 is not None
    assert found.ci95[0] <= 0.2 <= found.ci95[1] <= 0.4
    assert less_majority([]).n == 0


def lesson(name: str, relation: str, moved: list) -> dict:
    row = [2, 3, 0.005, moved]
    return {"name": name, "truth": [[2, 3, relation, 3]], "view": {"thesis": [row], "literal": [row]}}


LESSONS = [lesson("one", "on", UP), lesson("two", "adjacent", ASIDE)]


def test_the_thesiss_neighbours_by_hand():
    model = taught(LESSONS, "thesis")
    down = [[0.0, 0.0, -0.01]]
    said = model.predict_pairs(scene_of([[2, 3, 0.004, UP[:1]], [2, 4, 0.005, down], [3, 4, 0.006, ASIDE[:1]]]))
    assert [(one.a, one.b, one.relation, one.gap) for one in said] == [
        (2, 3, "on", 0.004),
        (4, 2, "on", 0.005),
        (3, 4, "adjacent", 0.006),
    ]
    # One contact above and one beside: the union.
    both = [lesson("three", "both", [[0.5, 0.5, 0.5]] * 4)]
    (one,) = taught(LESSONS + both, "thesis").predict_pairs(scene_of([[2, 3, 0.0, [UP[0], ASIDE[0]]]]))
    assert one.relation == "both"
    empty = scene_of([])
    assert empty.features.pairs.shape == (0, 2)
    assert empty.displacements == ()


def seen(name: str, whole: list, spoilt: list, truth: list, gaps: list, same: list, shifts: list) -> dict:
    return {
        "name": name,
        "truth": truth,
        "gaps": gaps,
        "views": {"whole": {**VIEW, "lifelore": whole}, SPOILT: {"thesis": [], "literal": [], "lifelore": spoilt}},
        "networks": {SPOILT: {"same": same, "shifts": shifts}},
    }


ROW = [2, 3, 0.005, UP]
VIEW = {"thesis": [ROW], "literal": [ROW]}
ON = [2, 3, "on", 0.001]


def simulated() -> list[dict]:
    """Four scenes: 2 on 3, told of all whole and of three spoilt; and in the first a pair on the border."""
    plain = ([[2, 3, "on", 3]], [[2, 3, 0.001]])
    # 2.5 mm from the limit of adjacent; whole it is told, spoilt another is.
    border = ([*plain[0], [4, 5, "adjacent", 3]], [*plain[1], [4, 5, 0.025]])
    return [
        seen("a", [ON, [4, 5, "adjacent", 0.02]], [ON, [4, 5, "none", 0.04]], *border, [1, 1], [0.001, 0.003]),
        seen("b", [ON], [ON], *plain, [0, 1], [0.002]),
        seen("c", [ON], [ON], *plain, [], []),
        seen("d", [ON], [[3, 2, "on", 0.001]], *plain, [0, 0], []),
    ]


def test_pairs_on_the_border_are_left_out_in_simulation_alone():
    models = {reading: taught(LESSONS, reading) for reading in ("thesis", "literal")}
    found = judged_views(simulated()[0], "simulated", models)
    for views in found.values():
        # By the whole scene's gap, whatever is seen when spoilt.
        assert [pair.truth.relation for pair in views["whole"]] == ["on"]
        assert [pair.truth.relation for pair in views[SPOILT]] == ["on"]
    real = judged_views(simulated()[0], "real", models)
    assert [pair.exact for pair in real["lifelore"]["whole"]] == [True, True]
    assert [pair.exact for pair in real["lifelore"][SPOILT]] == [True, False]
    assert {pair.scene for pair in real["lifelore"]["whole"]} == {"real a"}
    # A relation with a direction is on no border.
    scene = {**simulated()[1], "gaps": [[2, 3, 0.0225]]}
    assert len(judged_views(scene, "simulated", models)["lifelore"]["whole"]) == 1


def test_views_that_a_method_does_not_have_are_left_out():
    scene = simulated()[1]
    scene["views"]["noise 0.001"] = {"lifelore": [ON], "thesis": [ROW]}
    models = {reading: taught(LESSONS, reading) for reading in ("thesis", "literal")}
    found = judged_views(scene, "simulated", models)
    assert "noise 0.001" in found["thesis"]
    assert "noise 0.001" not in found["literal"]


@pytest.fixture
def results() -> list[dict]:
    scenes = simulated()
    return [
        {"kind": "lesson", "scenes": LESSONS},
        {"kind": "simulated", "scenes": scenes[:2]},
        {"kind": "simulated", "scenes": scenes[2:]},
    ]


def test_measures_by_hand(results):
    found = measure(SETTINGS, results)
    values = {name: one.value for name, one in found.items()}
    # The last of four is classified the wrong way round when perturbed.
    assert values["lost_discarded_0.7_lifelore_simulated"] == 0.25
    assert found["lost_discarded_0.7_lifelore_simulated"].n == 4
    # The thesis's displacements classify all whole scenes and have none of the perturbed ones, which means none.
    for method in ("thesis", "literal"):
        assert values[f"lost_discarded_0.7_{method}_simulated"] == 1.0
    # Always saying "on" is right of all.
    assert values["less_majority_thesis_simulated"] == -1.0
    # Of 30 and 50 % nothing is known, and at 70 % neither reading is robust.
    assert (values["robust_readings_and_levels"], found["robust_readings_and_levels"].n) == (0, 6)
    for scene in (scene for result in results[1:] for scene in result["scenes"]):
        scene["views"][SPOILT]["literal"] = [ROW]
    assert measure(SETTINGS, results)["robust_readings_and_levels"].value == pytest.approx(1 / 6)
    # Measures of real scenes in a run without them.
    assert np.isnan(values["lost_discarded_0.7_thesis_real"])


def test_rows_and_figure_by_hand(results):
    made = rows(SETTINGS, results)
    # Three methods, whole and perturbed, of simulated scenes; then the networks.
    *lines, networks = made
    assert [(row["method"], row["way"], row["level"]) for row in lines] == [
        (method, *view)
        for method in ("lifelore", "thesis", "literal")
        for view in (("whole", 0.0), ("discarded", 0.7))
    ]
    assert [row["exact"]["value"] for row in lines] == [1.0, 0.75, 1.0, 0.0, 1.0, 0.0]
    assert [row["lost"]["value"] for row in lines[1::2]] == [0.25, 1.0, 1.0]
    # The pair on the border is not among the four.
    assert {row["pairs"] for row in lines} == {4}
    # Three of six networks have as many nodes, in three scenes; the middle of 1, 2 and 3 mm.
    assert (networks["same_nodes"]["value"], networks["same_nodes"]["n"]) == (pytest.approx(3 / 6), 6)
    assert networks["median_shift"] == 0.002
    (panel,) = CLAIM.draw({"rows": made}).axes
    assert panel.get_title("left") == "points discarded\nsimulated, 4 pairs"
    shown = {line.get_label(): line.get_xydata().tolist() for line in panel.lines}
    assert shown["lifelore"] == [[0, 100], [70, 75]]


@pytest.mark.parametrize("levels", [{}, {"fog": [1.0]}])
def test_levels_that_cannot_be_run(levels):
    with pytest.raises(InputError, match="levels must name"):
        CLAIM.settings("quick", {"levels": levels})
