"""The agent: Algorithms 7 and 8 by hand, late signals, bad input, and what it says for itself."""

import math

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction import BayesianPolicyReuse, CategorySignal, Greedy, PolicyLibrary, TypeDynamics
from lifelore.interaction.reuse.explanation import MAX_EVIDENCE, MAX_SURPRISE
from lifelore.interaction.selection import RULES

INF = math.inf
STATIC = TypeDynamics.static()


def coin_library(**options) -> PolicyLibrary:
    """Two types told apart by 8 to 2; each has a policy of its own."""
    probs = np.array([[[0.8, 0.2], [0.5, 0.5]], [[0.2, 0.8], [0.5, 0.5]]])
    return PolicyLibrary.from_means(
        [[1.0, 0.0], [0.0, 1.0]], 0.5, types=["a", "b"], policies=["left", "right"], signal=CategorySignal(probs),
        **options,
    )  # fmt: skip


def test_what_it_says_for_itself():
    agent = BayesianPolicyReuse(coin_library(prior=[0.6, 0.4]), Greedy(), dynamics=STATIC)
    assert agent.explain().selected is None
    assert agent.explain().evidence == {"a": [], "b": []}
    agent.update("left", 1)
    agent.update("right", 0)
    agent.select()
    told = agent.explain()
    assert (told.selected, told.runner_up) == ("right", "left")
    assert (told.score, told.runner_up_score) == pytest.approx((0.32 / 0.44, 0.12 / 0.44))
    assert list(told.belief) == ["b", "a"]
    assert told.evidence["b"] == [0.0, 0.0]
    assert told.evidence["a"] == pytest.approx([math.log(0.25), 0.0])
    assert told.policies == ["left", "right"]
    assert told.log_evidence == pytest.approx([math.log(0.44), math.log(0.5)])
    assert told.to_dict()["surprise"] == agent.surprise == pytest.approx(-math.log(0.44) - math.log(0.5))
    for _ in range(50):
        agent.update(0, 0)
    assert len(agent.explain().policies) == MAX_EVIDENCE


def test_an_unexplained_signal_keeps_the_belief_and_raises_the_surprise():
    probs = np.array([[[1.0, 0.0, 0.0]], [[0.5, 0.5, 0.0]]])
    library = PolicyLibrary.from_means([[0.0], [1.0]], 1.0, signal=CategorySignal(probs))
    agent = BayesianPolicyReuse(library, dynamics=STATIC)
    agent.update(0, 0)
    before, surprise = agent.log_belief, agent.surprise
    agent.update(0, 2)
    assert agent.log_belief == pytest.approx(before, rel=1e-14)
    assert agent.surprise == surprise + MAX_SURPRISE
    assert agent.unexplained == 1
    assert agent.explain().evidence == {"type 0": [0.0, 0.0], "type 1": [pytest.approx(-math.log(2)), 0.0]}
    agent.update(0, 1)
    assert agent.belief.tolist() == [0.0, 1.0]


# ---- bad input -----------------------------------------------------------------------------------------------


class Broken:
    """A signal model that answers with whatever it was given."""

    def __init__(self, answer):
        self.answer = answer

    def log_likelihood(self, policy, signal):
        return np.array(self.answer)


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ([0.0, math.nan], "gave NaN or infinity"),
        ([INF, 0.0], "gave NaN or infinity"),
        ([0.0], r"must give \(2,\)"),
    ],
)
def test_a_model_that_answers_wrongly_is_named(answer, message):
    library = coin_library()
    library.signal = Broken(answer)
    agent = BayesianPolicyReuse(library)
    with pytest.raises(InputError, match=f"Broken.*{message}"):
        agent.update(0, 0)
    assert agent.belief.tolist() == [0.5, 0.5]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"prior": [0.5, 0.6]}, "prior must sum to 1"),
        ({"prior": [1.0]}, r"prior must be \(2,\)"),
        ({"horizon": 0}, "horizon must be at least 1"),
        ({"seed": 1.5}, "seed must be a whole number or a numpy generator, got 1.5"),
        ({"horizon": math.nan}, "horizon must be at least 1"),
        ({"dynamics": TypeDynamics.hazard(0.1, [0.2, 0.3, 0.5])}, "dynamics are for 3 types"),
    ],
)
def test_settings_that_break_their_rule_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        BayesianPolicyReuse(coin_library(), **options)


# ---- the printed form --------------------------------------------------------------------------------


def test_the_printed_algorithm_takes_a_rule_and_refuses_one_of_our_own():
    library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)
    for name in RULES:
        if name == "information-directed":
            with pytest.raises(NotFoundError, match="rule must be one that the thesis prints, greedy"):
                BayesianPolicyReuse.of_thesis(library, name)
        else:
            agent = BayesianPolicyReuse.of_thesis(library, name, prior=[0.2, 0.8])
            assert getattr(agent.rule, "variant", "thesis") == "thesis"
            assert agent.belief.tolist() == pytest.approx([0.2, 0.8])
    own = Greedy()
    assert BayesianPolicyReuse.of_thesis(library, own).rule is own
