"""Words learnt from blocks whose relations are known: core relations, views, the user's own."""

from typing import cast

import numpy as np
import pytest

from lifelore.core import InputError, LabelledCloud, PairLabel, stream
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, NONE, ON
from lifelore.perception import ContactSettings, RelationClassifier, TreeSettings
from lifelore.perception.pairs.scene_pairs import ScenePairs, scene_pairs

SMALL = TreeSettings(n_trees=40, table_trees=20)
CAMERA = np.array([0.0, -1.0, 0.6])


def surface(low, high, step) -> np.ndarray:
    """Points on the faces of a box."""
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return points[((points == np.array(low)) | (points == np.array(high))).any(axis=1)]


def blocks(number: int) -> tuple[LabelledCloud, list[PairLabel]]:
    """Two blocks on a table: stacked (either one on the other), 5 mm apart, or 50 mm apart."""
    rng = stream(number, "blocks")
    size = rng.uniform(0.04, 0.08, (2, 3))
    kind = number % 4
    place = np.zeros(3)
    if kind < 2:
        place[2] = size[0, 2] + 0.002
    else:
        side = rng.integers(2)
        place[side] = size[0, side] + (0.005 if kind == 2 else 0.05)
    table = surface((-0.15, -0.15, -0.002), (0.25, 0.25, -0.002), 0.01)
    parts = [surface(np.zeros(3), size[0], 0.006), surface(place, place + size[1], 0.006), table]
    turn = rng.uniform(0, 2 * np.pi)
    about = np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    lower, upper = (3, 2) if kind == 1 else (2, 3)
    labels = np.repeat([lower, upper, TABLE], [len(part) for part in parts])
    if kind < 2:
        truth = [PairLabel(upper, lower, ON), PairLabel(lower, TABLE, ON), PairLabel(upper, TABLE, NONE)]
    else:
        relation = ADJACENT if kind == 2 else NONE
        truth = [PairLabel(2, 3, relation), PairLabel(2, TABLE, ON), PairLabel(3, TABLE, ON)]
    return LabelledCloud(np.vstack(parts) @ about, labels, None, CAMERA), truth


Lessons = tuple[list[ScenePairs], list[list[PairLabel]]]


def test_as_printed_a_pair_without_contacts_has_no_relation_and_the_form_is_stored(tmp_path):
    settings = ContactSettings.of_thesis()
    scenes = [scene_pairs(cloud, settings=settings) for cloud, _ in map(blocks, range(8))]
    model = RelationClassifier("displacement", settings=settings).fit(scenes, [blocks(n)[1] for n in range(8)])
    model.save(tmp_path / "printed.npz")
    again = RelationClassifier.load(tmp_path / "printed.npz")
    assert again.settings == settings
    slab = surface((0, 0, 0), (0.1, 0.1, 0.02), 0.004)
    needle = np.column_stack([np.full((10, 2), 0.05), 0.025 + 0.01 * np.arange(10)])
    cloud = LabelledCloud(np.vstack([slab, needle]), np.repeat([2, 3], [len(slab), 10]))
    assert scene_pairs(cloud, settings=settings).displacements[0].shape == (0, 3)
    assert again.predict(cloud) == ()
    assert (3, 2, ON) in {(r.a, r.b, r.relation) for r in again.predict(blocks(0)[0])}


@pytest.fixture(scope="module")
def lessons() -> Lessons:
    scenes = [blocks(number) for number in range(44)]
    return [scene_pairs(cloud) for cloud, _ in scenes], [truth for _, truth in scenes]


@pytest.fixture(scope="module")
def fitted(lessons: Lessons) -> RelationClassifier:
    return RelationClassifier(trees=SMALL).fit(lessons[0][:24], lessons[1][:24])


def said(relations) -> set[tuple[int, int, str]]:
    return {(one.a, one.b, one.relation) for one in relations}


def wanted(truth) -> set[tuple[int, int, str]]:
    return {(one.a, one.b, one.relation) for one in truth}


@pytest.mark.slow
def test_blocks_never_seen_are_told_right_with_their_direction(lessons, fitted):
    for scene, truth in zip(lessons[0][24:32], lessons[1][24:32], strict=True):
        assert said(fitted.predict(scene)) == wanted(truth)


def test_beliefs_are_probabilities_and_the_best_is_what_is_said(lessons, fitted):
    for scene in lessons[0][24:32]:
        beliefs = fitted.beliefs(scene)
        for belief, one in zip(beliefs, fitted.predict(scene), strict=True):
            assert np.isclose(sum(belief.shares.values()), 1.0)
            assert one.confidence == max(belief.shares.values())
            assert belief.best() == one


def test_the_numbers_of_objects_carry_no_information(fitted):
    cloud, _ = blocks(24)
    swapped = LabelledCloud(cloud.points, np.array([0, 1, 3, 2])[cloud.labels], None, CAMERA)
    other = {2: 3, 3: 2, TABLE: TABLE}
    assert said(fitted.predict(swapped)) == {
        (other[a], other[b], name) for a, b, name in said(fitted.predict(cloud))
    }


def test_adjacent_means_the_gap_that_is_asked_for(lessons, fitted):
    near, far = lessons[0][26], lessons[0][27]
    try:
        fitted.adjacent_gap = 0.06
        assert (2, 3, ADJACENT) in said(fitted.predict(far))
        fitted.adjacent_gap = 0.002
        assert (2, 3, NONE) in said(fitted.predict(near))
    finally:
        fitted.adjacent_gap = 0.0225
    assert (2, 3, ADJACENT) in said(fitted.predict(near))


def test_the_same_scenes_give_the_same_model(lessons, fitted):
    again = RelationClassifier(trees=SMALL).fit(lessons[0][:24], lessons[1][:24])
    assert again.beliefs(lessons[0][25]) == fitted.beliefs(lessons[0][25])


def test_the_thesiss_method_tells_on_from_beside(lessons):
    model = RelationClassifier("displacement").fit(lessons[0][:24], lessons[1][:24])
    hits = [
        len(said(model.predict(scene)) & wanted(truth)) / len(truth)
        for scene, truth in zip(lessons[0][24:32], lessons[1][24:32], strict=True)
    ]
    assert np.mean(hits) >= 0.75


def renamed(truth, names) -> list[PairLabel]:
    return [PairLabel(one.a, one.b, names[one.relation]) for one in truth if TABLE not in (one.a, one.b)]


@pytest.mark.slow
def test_any_words_do_and_symmetry_is_found(lessons):
    names = {ON: "rests upon", ADJACENT: "next to", NONE: "next to"}
    truths = [renamed(truth, names) for truth in lessons[1][:32]]
    # Which of two neighbours is named first is chance: nothing tells them apart.
    for number, truth in enumerate(truths):
        if truth[0].relation == "next to" and stream(number, "order").random() < 0.5:
            truth[0] = PairLabel(truth[0].b, truth[0].a, "next to")
    model = RelationClassifier(trees=SMALL).fit(lessons[0][:24], truths[:24])
    assert model.symmetric_ == {"next to"}
    for scene, truth in zip(lessons[0][24:32], truths[24:], strict=True):
        (one,) = model.predict(scene)
        assert one.relation == truth[0].relation
        if one.relation == "rests upon":
            assert (one.a, one.b) == (truth[0].a, truth[0].b)


def views(cloud: LabelledCloud) -> list[PairLabel]:
    """left_of, in_front_of, under and near of 2 and 3, from the blocks' centres."""
    away = np.array([0.0, 1.0])
    first, second = (cloud.of(label).mean(axis=0) for label in (2, 3))
    found = [PairLabel(2, 3, "near")]
    for name, across in (("left_of", np.array([1.0, 0.0])), ("in_front_of", away)):
        offset = (second - first)[:2] @ across
        if abs(offset) > 0.015:
            found.append(PairLabel(*((2, 3) if offset > 0 else (3, 2)), name))
    if abs((second - first)[2]) > 0.04:
        found.append(PairLabel(*((2, 3) if second[2] > first[2] else (3, 2)), "under"))
    return found


@pytest.mark.slow
def test_several_words_may_hold_of_one_pair(lessons):
    clouds = [blocks(number)[0] for number in range(44)]
    truths = [views(cloud) for cloud in clouds]
    model = RelationClassifier(multi_label=True, trees=SMALL).fit(lessons[0][:36], truths[:36])
    assert model.symmetric_ == {"near"}
    right, total = 0, 0
    for scene, truth in zip(lessons[0][36:], truths[36:], strict=True):
        found = said(model.predict(scene))
        assert (2, 3, "near") in found
        total += len(wanted(truth) | found)
        right += len(wanted(truth) & found)
    assert right / total >= 0.8


def test_what_cannot_be_learnt_is_refused(lessons):
    scenes, truths = lessons
    with pytest.raises(InputError, match="one for each cloud"):
        RelationClassifier().fit(scenes, truths[:2])
    with pytest.raises(InputError, match="near pair"):
        RelationClassifier().fit(scenes[:1], [[PairLabel(8, 9, ON)]])
    with pytest.raises(InputError, match="near pair"):
        RelationClassifier().fit(scenes[:1], [[PairLabel(3, 2, ON, 1)]])
    with pytest.raises(InputError, match="multi_label"):
        RelationClassifier().fit(scenes[:1], [[PairLabel(3, 2, ON), PairLabel(3, 2, ADJACENT)]])
    for name in ("~on", "beside="):
        with pytest.raises(InputError, match="start with ~"):
            RelationClassifier().fit(scenes[:1], [[PairLabel(2, 3, name)]])
    with pytest.raises(InputError, match="fit"):
        RelationClassifier().predict(scenes[0])
    with pytest.raises(InputError, match="method"):
        RelationClassifier("magic")
    for wrong in (0.0, 22.5):
        with pytest.raises(InputError, match="adjacent_gap"):
            RelationClassifier(adjacent_gap=wrong)
    with pytest.raises(InputError, match="multi_label"):
        RelationClassifier("displacement", multi_label=True)


def test_one_scene_is_enough_to_learn_from(lessons):
    with pytest.warns(UserWarning, match=r"every labelled pair of objects is 'on'.*without it, too, as 'none'"):
        model = RelationClassifier(trees=SMALL).fit(lessons[0][:1], lessons[1][:1])
    assert said(model.predict(lessons[0][0])) == wanted(lessons[1][0])
    empty = LabelledCloud(np.empty((0, 3)), np.empty(0, np.int64))
    assert model.predict(empty) == ()


@pytest.mark.parametrize("method", ["trees", "displacement"])
def test_a_symmetric_word_may_be_written_both_ways(lessons, method):
    names = {ON: "rests upon", ADJACENT: "touches", NONE: "apart"}
    truths = [renamed(truth, names) for truth in lessons[1][:12]]
    for truth in truths:
        truth += [PairLabel(one.b, one.a, "touches") for one in truth if one.relation == "touches"]
    model = RelationClassifier(method, trees=SMALL).fit(lessons[0][:12], truths)
    assert "touches" in model.symmetric_
    assert "rests upon" not in model.symmetric_
    # Each written pair is two labels.
    assert model.learnt_from_ == {"apart": 3, "rests upon": 6, "touches": 6}
    assert (2, 3, "touches") in said(model.predict(lessons[0][2]))
    with pytest.raises(InputError, match=r"touches\(2, 3\) and touches\(3, 2\)"):
        RelationClassifier(method, trees=SMALL, symmetric=[]).fit(lessons[0][:12], truths)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["trees", "displacement"])
@pytest.mark.parametrize("other", [PairLabel(3, 2, ADJACENT), PairLabel(2, 3, ON)])
def test_a_pair_with_two_relations_is_refused_by_either_method(lessons, method, other):
    with pytest.raises(InputError, match="one relation"):
        RelationClassifier(method).fit(lessons[0][:1], [[PairLabel(3, 2, ON), other]])
    with pytest.raises(InputError, match="one relation"):
        RelationClassifier(method).fit(lessons[0][:1], [[PairLabel(2, TABLE, ON), PairLabel(2, TABLE, NONE)]])


def test_a_doubted_label_is_no_evidence_of_symmetry(lessons):
    truths = [renamed(truth, {ON: "upon", ADJACENT: "by", NONE: "far"}) for truth in lessons[1][:4]]
    truths[0].append(PairLabel(truths[0][0].b, truths[0][0].a, "upon", 1))
    assert RelationClassifier(trees=SMALL).fit(lessons[0][:4], truths).symmetric_ == frozenset()


def test_words_said_with_the_table_first_are_learnt_in_that_direction(lessons):
    """The table is under what stands on it: said ``under(table, x)``, never ``under(x, table)``."""
    truths = [
        [PairLabel(TABLE, one.a, "under") if one.relation == ON else one for one in truth if one.b == TABLE]
        for truth in lessons[1]
    ]
    model = RelationClassifier(multi_label=True, trees=SMALL).fit(lessons[0][:24], truths[:24])
    for scene, truth in zip(lessons[0][24:32], truths[24:32], strict=True):
        under = {(one.a, one.b, one.relation) for one in truth if one.relation == "under"}
        assert said(model.predict(scene)) == under
        assert all(belief.shares["under"] == 0 for belief in model.beliefs(scene))


def test_labels_of_near_pairs_are_counted(lessons):
    truths = [[*lessons[1][0], PairLabel(8, 9, ON), PairLabel(2, 9, NONE)], [*lessons[1][2]], []]
    model = RelationClassifier(trees=SMALL)
    assert model.learnt_from_ == {}
    model.fit(lessons[0][:3], truths)
    # Scene 0: on twice, none once; scene 2: adjacent once, on twice.
    assert model.learnt_from_ == {ADJACENT: 1, NONE: 1, ON: 4}


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        (lambda: RelationClassifier("displacement", k=0), "k must"),
        (lambda: RelationClassifier("displacement", k=2.5), "k must"),  # type: ignore[arg-type]
        (lambda: RelationClassifier("displacement", weights="even"), "weights must"),
        (lambda: RelationClassifier("displacement", omega=-0.1), "omega must"),
        (lambda: RelationClassifier("displacement", omega=float("nan")), "omega must"),
        (lambda: TreeSettings(n_trees=0), "n_trees must"),
        (lambda: TreeSettings(n_trees=10**9), "n_trees must"),
        (lambda: TreeSettings(table_trees=1.5), "table_trees must"),  # type: ignore[arg-type]
        (lambda: TreeSettings(min_leaf=0), "min_leaf must"),
        (lambda: TreeSettings(feature_share="half"), "feature_share must"),
        (lambda: TreeSettings(feature_share=1.5), "feature_share must"),
        (lambda: TreeSettings(seed=-1), "seed must"),
    ],
)
def test_wrong_settings_are_refused_at_once(wrong, named):
    with pytest.raises(InputError, match=named):
        wrong()


@pytest.mark.filterwarnings("ignore:every labelled pair")
def test_opposite_directions_of_a_word_never_both_hold(lessons, monkeypatch):
    truths = [views(blocks(number)[0]) for number in range(12)]
    model = RelationClassifier(multi_label=True, trees=SMALL, symmetric={"near"}).fit(lessons[0][:12], truths)
    assert model.symmetric_ == {"near"}
    shares = {"near": 0.8, "under": 0.6, "~under": 0.9, "left_of": 0.7, "~left_of": 0.7, "in_front_of": 0.4}
    monkeypatch.setattr(
        "lifelore.perception.relations.relation_classifier.label_shares", lambda *_: [shares, {}, {}]
    )
    assert said(model.predict(lessons[0][0])) == {(2, 3, "near"), (3, 2, "under"), (2, 3, "left_of")}


@pytest.mark.filterwarnings("ignore:every labelled pair")
def test_a_word_declared_to_have_a_direction_is_not_labelled_both_ways(lessons):
    truths = [[PairLabel(2, 3, "touches"), PairLabel(3, 2, "touches")]]
    with pytest.raises(InputError, match=r"must not state touches\(2, 3\) and touches\(3, 2\)"):
        RelationClassifier(multi_label=True, trees=SMALL, symmetric=()).fit(lessons[0][:1], truths)
    truths = [[truths[0][0], PairLabel(3, 2, "touches", 1)]]
    assert (
        RelationClassifier(multi_label=True, trees=SMALL, symmetric=()).fit(lessons[0][:1], truths).symmetric_
        == frozenset()
    )


def test_adjacent_and_none_stay_symmetric_whatever_is_declared(lessons):
    model = RelationClassifier(trees=SMALL, symmetric=()).fit(lessons[0][:4], lessons[1][:4])
    assert model.symmetric_ == {ADJACENT, NONE}


@pytest.mark.filterwarnings("ignore:every labelled pair")
def test_scikit_learn_clones_it_and_searches_over_its_settings(lessons):
    from sklearn.base import clone, is_classifier
    from sklearn.model_selection import GridSearchCV, cross_val_score

    model = RelationClassifier(trees=SMALL, symmetric={"near"}, k=3)
    copied = cast(RelationClassifier, clone(model))
    assert copied is not model
    assert copied.get_params() == model.get_params()
    fitted_copy = clone(model.fit(lessons[0][:4], lessons[1][:4]))
    assert cast(RelationClassifier, fitted_copy).names_ == ()
    assert not is_classifier(model)  # a sample is a scene, so folds are not stratified by labels
    search = GridSearchCV(RelationClassifier(trees=SMALL), {"method": ["trees", "displacement"]}, cv=2)
    search.fit(lessons[0][:12], lessons[1][:12])
    assert search.best_params_ == {"method": "trees"}
    best = search.best_estimator_
    assert isinstance(best, RelationClassifier)
    assert best.names_ == (ADJACENT, NONE, ON)
    clouds, truths = zip(*(blocks(number) for number in range(4)), strict=True)
    assert cross_val_score(RelationClassifier(trees=SMALL), clouds, truths, cv=2).shape == (2,)


def test_settings_are_changed_together_or_not_at_all():
    model = RelationClassifier("displacement").set_params(k=2, method="trees", multi_label=True)
    assert (model.k, model.method, model.multi_label) == (2, "trees", True)
    assert model.neighbours.k == 2
    with pytest.raises(InputError, match="multi_label"):
        model.set_params(k=5, method="displacement")
    with pytest.raises(InputError, match=r"params must be among method, .*, got depth"):
        model.set_params(depth=3, k=5)
    assert (model.k, model.method) == (2, "trees")


def test_the_score_counts_pairs_with_all_their_relations_right(lessons, fitted):
    scenes, truths = lessons[0][24:28], lessons[1][24:28]
    assert fitted.score(scenes, truths) == 1.0
    # Scene 24 is a pile of two: of its three labelled pairs one is now wrong, and the others of the four stay.
    turned = [[PairLabel(one.b, one.a, ON) if TABLE not in (one.a, one.b) else one for one in truths[0]]]
    n_pairs = sum(map(len, truths))
    assert fitted.score(scenes, [*turned, *truths[1:]]) == pytest.approx(1 - 1 / n_pairs)
    with pytest.raises(InputError, match="near pair"):
        fitted.score(scenes[:1], [[PairLabel(8, 9, ON)]])


def test_the_limit_of_adjacent_may_be_changed_but_not_taken_away(lessons, fitted):
    fitted.adjacent_gap = None
    try:
        with pytest.raises(InputError, match="adjacent_gap"):
            fitted.predict(lessons[0][0])
    finally:
        fitted.adjacent_gap = 0.0225
