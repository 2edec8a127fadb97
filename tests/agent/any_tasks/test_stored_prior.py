"""A prior comes out of the memory of a life, with the contexts of that life and the features behind them."""

import gymnasium
import numpy as np
import pytest

from lifelore import GymnasiumWorld, LongLivedAgent
from lifelore.agent.any_tasks.live_in import live_in
from lifelore.agent.any_tasks.stored_prior import BatchContexts, prior_from_memory
from lifelore.agent.external_world.context_code import context_code
from lifelore.agent.external_world.context_labels import MOST_BYTES, SLOTS, ContextLabels, labels_record
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.figures.lives.prior_table import plot_prior
from lifelore.memory import open_memory

pytestmark = pytest.mark.filterwarnings("ignore:Nothing that was observed")


class Lamps:
    """One step an episode: button `lamp` pays 1; the lamp is the context."""

    name = "lamps"

    def __init__(self, n_actions=3, spoken=("lamp",)):
        self.n_actions, self.spoken = n_actions, spoken

    def reset(self, task, seed):
        self.lamp = seed % 2
        return self.lamp

    def step(self, action):
        return "over", float(action == self.lamp), True, False

    def context(self, state, last_reward):
        return (*self.spoken, state)


@pytest.fixture
def lived(tmp_path):
    live_in(Lamps(), tasks=3, episodes=80, memory=tmp_path / "m.db", key="lamp")
    return tmp_path / "m.db"


def test_a_life_becomes_a_prior_for_batches_of_observations(lived):
    prior = prior_from_memory(lived, key="lamp", alpha0=0.5)
    contexts = BatchContexts(lambda lamp: ("lamp", int(lamp)))
    assert prior.counts(contexts(np.array([0, 1, 1]))).tolist() == [[3, 0, 0], [0, 3, 0], [0, 3, 0]]
    assert (prior.n_actions, prior.alpha0) == (3, 0.5)
    assert contexts.labels == {context_code(("lamp", lamp)): ("lamp", lamp) for lamp in (0, 1)}
    dicts = BatchContexts(lambda seen: int(seen["lamp"]) + 10 * int(seen["room"][0]))
    codes = dicts({"lamp": np.array([1, 0]), "room": np.array([[2, 0], [3, 0]])})
    assert codes.tolist() == [context_code(21), context_code(30)]


def test_the_only_prior_needs_no_key_and_mistakes_name_what_there_is(lived, tmp_path):
    assert len(prior_from_memory(lived)) == 2
    live_in(Lamps(2), tasks=2, episodes=60, memory=lived, key="torch")
    with pytest.raises(InputError, match=r"key must select one prior in .*; it has lamp, torch"):
        prior_from_memory(lived)
    assert prior_from_memory(lived, key="torch").n_actions == 2
    with pytest.raises(NotFoundError, match=r"no prior of key 'lump' in .*; it has lamp, torch"):
        prior_from_memory(lived, key="lump")
    with pytest.raises(NotFoundError, match="no memory at"):
        prior_from_memory(tmp_path / "other.db")
    assert not (tmp_path / "other.db").exists()


def test_a_long_lived_agent_goes_on_with_the_prior_of_a_life(tmp_path):
    """One key, one prior, whoever learns it; features of memory are there when they are asked for."""
    path = tmp_path / "m.db"
    make, places = (lambda task: gymnasium.make("CliffWalking-v1")), {"state": int, "max_steps": 60}
    with GymnasiumWorld(make, state=int, context=lambda place: place // 12) as world:
        live_in(world, tasks=1, episodes=30, max_steps=60, memory=path, key="cliff")
    before = prior_from_memory(path)
    with LongLivedAgent(
        key="cliff", memory=path, features=lambda place: place // 12, episodes=30, **places
    ) as agent:
        np.testing.assert_array_equal(agent.prior.counts(before.contexts), before.counts(before.contexts))
        agent.live(gymnasium.make("CliffWalking-v1"))
        after = prior_from_memory(path)
        np.testing.assert_array_equal(agent.prior.counts(after.contexts), after.counts(after.contexts))
    assert after.counts(after.contexts).sum() > before.counts(before.contexts).sum()
    assert {after.labels[code] for code in after.contexts.tolist()} <= set(range(4))


def test_priors_of_merged_robots_show_tuples(tmp_path):
    for robot in ("a", "b"):
        world = Lamps(2, ("lamp", robot))
        live_in(world, tasks=2, episodes=60, memory=tmp_path / f"{robot}.db", key="lamp", robot=robot)
    with open_memory(tmp_path / "a.db") as memory:
        memory.merge_from(tmp_path / "b.db")
    prior = prior_from_memory(tmp_path / "a.db")
    wanted = {("lamp", robot, lamp) for robot in "ab" for lamp in (0, 1)}
    assert {prior.labels[code] for code in prior.contexts.tolist()} == wanted
    assert set(prior.to_columns()["label"]) == {str(context) for context in wanted}
    rows = [text.get_text() for text in plot_prior(prior).axes[0].get_yticklabels()]
    assert sum("('lamp', 'a', 0)" in row for row in rows) == 1


# ---- the features as text in a record --------------------------------------------------------------


def text_by_hand(record, code):
    """The naive twin of `ContextLabels`: a loop over all slots, a byte at a time."""
    cells = {
        int(s) % SLOTS: int(v) for s, v in zip(record.slots, record.values, strict=True) if s // SLOTS == code
    }
    raw = b"".join(cells[place].to_bytes(8, "little", signed=True) for place in sorted(cells) if place)
    return raw[: cells[0]].decode()


@pytest.mark.parametrize("context", [3, None, "däche", ("free", 2.5, (True, None)), b"\x00\xff", ("a",) * 15])
def test_features_are_read_back_as_they_were(context):
    code = context_code(context)
    record = labels_record("k", {5: "before", code: context, 2**47 - 1: "behind"})
    labels = ContextLabels(lambda: record)
    assert (labels[code], text_by_hand(record, code)) == (context, repr(context))
    assert (len(labels), set(labels), labels.get(6)) == (3, {5, code, 2**47 - 1}, None)


def test_long_features_are_cut_and_others_are_text():
    record = labels_record("k", {1: ("x" * 500,), 2: frozenset({4}), 3: (np.int64(7), np.float64(0.5))})
    labels = ContextLabels(lambda: record)
    assert labels[1] == "('" + "x" * (MOST_BYTES - 2)
    assert (labels[2], labels[3]) == ("frozenset({4})", (7, 0.5))
    assert (record.slots // SLOTS == 1).sum() == SLOTS
    assert len(ContextLabels(lambda: labels_record("k", {}))) == 0
    with pytest.raises(InputError, match="record must be context_labels version 1, got action_prior 1"):
        len(ContextLabels(lambda: Record("action_prior", "k", 1, "add", np.array([1]), np.array([1]))))


def test_the_newest_text_wins_whole(tmp_path):
    """A short text over a long one: the rest of the long one must not show."""
    with open_memory(tmp_path / "m.db") as memory:
        for seq, text in enumerate(("a very long text of many words", "short")):
            memory.contribute("r", [labels_record("k", {9: text})], process="p", seq=seq, task={})
        record = memory.recall("context_labels", "k", 1)
    assert record is not None
    assert dict(ContextLabels(lambda: record)) == {9: "short"}
