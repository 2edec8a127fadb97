"""Saved agents go on to the bit; files that are none are refused."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError, StoreError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_session import load_session, save_session, session_bytes, session_from_bytes
from lifelore.interaction.selection import RULES, ExpectedImprovement, Greedy, rule_named

from .families import FAMILIES


def library(**options) -> PolicyLibrary:
    place = np.arange(6)
    return PolicyLibrary.from_means(-np.abs(place[:, None] - place).astype(float), 2.0, **options)


def played(agent: BayesianPolicyReuse, n: int) -> tuple[list[int], bytes]:
    """Policies of `n` episodes, and all bits of what is believed after each."""
    chosen, bits = [], b""
    for number in range(n):
        policy = agent.select()
        chosen.append(policy)
        agent.update(policy, float(np.sin(number + policy)))
        bits += agent.log_belief.tobytes()
    return chosen, bits + np.float64(agent.surprise).tobytes()


@pytest.mark.parametrize("name", RULES)
@pytest.mark.parametrize("kind", ["static", "hazard", "transitions", "learnt"])
def test_a_loaded_agent_goes_on_to_the_bit(name, kind, tmp_path):
    matrix = np.full((6, 6), 0.02) + 0.88 * np.eye(6)
    dynamics = {
        "static": TypeDynamics.static(),
        "hazard": TypeDynamics.hazard(0.02, np.full(6, 1 / 6)),
        "transitions": TypeDynamics.transitions(matrix),
        "learnt": TypeDynamics.learnt("outcome"),
    }[kind]
    agent = BayesianPolicyReuse(library(), rule_named(name), dynamics=dynamics, horizon=40, seed=5)
    played(agent, 7)
    agent.select()
    save_session(agent, tmp_path / "agent.npz")
    loaded = load_session(tmp_path / "agent.npz")
    assert session_bytes(loaded) == session_bytes(agent)
    assert loaded.explain() == agent.explain()
    assert loaded.rule == agent.rule
    assert played(loaded, 12) == played(agent, 12)


def test_what_an_earlier_task_taught_of_changes_comes_back():
    first = BayesianPolicyReuse(library(), dynamics=TypeDynamics.learnt("outcome"))
    for number in range(20):
        first.observe(number % 6, 1.0)
        first.end_episode(("won", "lost", 3)[number % 3])
    agent = BayesianPolicyReuse(library(), dynamics=first.dynamics)
    loaded = session_from_bytes(session_bytes(agent))
    for one in (agent, loaded):
        one.end_episode("lost")
        one.end_episode(3)
    assert np.array_equal(loaded.belief, agent.belief)


@pytest.mark.parametrize("name", ["gaussian", "categorical", "transition", "exact outcomes"])
def test_a_session_saved_within_an_episode_goes_on_to_the_bit(name):
    family, random = FAMILIES[name], np.random.default_rng(0)
    agent = BayesianPolicyReuse(family.library(), seed=5)
    agent.update(0, family.draw(random))
    agent.observe(1, family.draw(random))
    loaded = session_from_bytes(session_bytes(agent))
    signals = [family.draw(random) for _ in range(3)]
    for one in (agent, loaded):
        one.observe(1, signals[0])
        one.end_episode()
        one.update(0, signals[1])
        one.update(1, signals[2])
    assert loaded.log_belief.tobytes() == agent.log_belief.tobytes()
    assert session_bytes(loaded) == session_bytes(agent)


def repacked(content: bytes, change) -> bytes:
    import io

    with np.load(io.BytesIO(content)) as packed:
        arrays = {name: packed[name] for name in packed.files}
    header = json.loads(arrays["about"].tobytes())
    change(header, arrays)
    arrays["about"] = np.frombuffer(json.dumps(header).encode(), np.uint8)
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def test_a_session_of_an_earlier_lifelore_improves_the_outcome():
    noise = np.random.default_rng(0).uniform(0.5, 20, (6, 6))
    place = np.arange(6)
    model = PolicyLibrary.from_means(-np.abs(place[:, None] - place).astype(float), noise)
    agent = BayesianPolicyReuse(model, ExpectedImprovement(of="outcome"), seed=5)
    played(agent, 3)
    earlier = repacked(session_bytes(agent), lambda header, _: header["settings"].pop("of"))
    loaded = session_from_bytes(earlier)
    assert loaded.rule == ExpectedImprovement(of="outcome")
    by_pay = session_from_bytes(session_bytes(BayesianPolicyReuse(model, ExpectedImprovement(), seed=5)))
    assert by_pay.rule == ExpectedImprovement(of="pay")
    assert played(loaded, 12) == played(agent, 12)


def test_a_session_whose_rule_had_a_setting_that_is_gone_goes_on():
    agent = BayesianPolicyReuse(library(), seed=5)
    played(agent, 3)
    earlier = repacked(session_bytes(agent), lambda header, _: header["settings"].update(trials=False))
    assert played(session_from_bytes(earlier), 12) == played(agent, 12)


@pytest.mark.parametrize("models", ["uncertain", "plug-in"])
@pytest.mark.parametrize("kind", ["gaussian", "categorical"])
def test_the_evidence_of_an_unknown_type_goes_on_to_the_bit(models, kind):
    samples = np.round(np.random.default_rng(0).normal(size=(3, 6, 10)))
    model = PolicyLibrary.from_samples(samples, model=kind)
    agent = BayesianPolicyReuse(model, seed=5, models=models, novelty=0.1)

    def lived(agent: BayesianPolicyReuse) -> list[float]:
        odds = []
        for number in range(9):
            agent.update(agent.select(), float(number % 3 - 1))
            odds.append(agent.novelty.log_odds)
        return odds

    lived(agent)
    loaded = session_from_bytes(session_bytes(agent))
    assert session_bytes(loaded) == session_bytes(agent)
    assert loaded.novelty.mass == 0.1
    assert lived(loaded) == lived(agent)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda h, a: h.update(version=9), "has version 9, this Lifelore reads 4"),
        (lambda h, a: a.update({"novelty.numbers": np.array([0.1, 0.0])}), "no evidence of an unknown type"),
        (lambda h, a: h.update(format="else"), "another kind of file"),
        (lambda h, a: h.update(rule="best"), "rule must be one of"),
        (lambda h, a: h.update(settings={"wish": 1}), "wish"),
        (lambda h, a: h.update(horizon=0), "horizon must be at least 1"),
        (lambda h, a: h["generator"].update(bit_generator="Dice"), "unknown random generator"),
        (lambda h, a: a.update(log_belief=np.zeros(3)), "log_belief must be the logs of a belief"),
        (lambda h, a: a.update(log_belief=np.zeros(6)), "log_belief must be the logs of a belief"),
        (lambda h, a: a.update(log_belief=np.full(6, np.nan)), "log_belief must be the logs of a belief"),
        (lambda h, a: a.pop("library"), "library"),
    ],
)
def test_files_that_are_none_are_refused(change, message):
    content = session_bytes(BayesianPolicyReuse(library()))
    with pytest.raises(InputError, match=message):
        session_from_bytes(repacked(content, change))


def test_no_file_damage_and_full_disks_are_said(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        load_session(tmp_path / "none.npz")
    content = session_bytes(BayesianPolicyReuse(library()))
    for cut in (0, 10, len(content) // 2, len(content) - 5):
        with pytest.raises(InputError, match="no session that can be read"):
            session_from_bytes(content[:cut])
    with pytest.raises(StoreError, match="cannot be written"):
        save_session(BayesianPolicyReuse(library()), tmp_path / "no" / "folder.npz")


def test_a_rule_of_ones_own_cannot_be_saved():
    class Mine(Greedy):
        pass

    with pytest.raises(InputError, match="rule must be one of"):
        session_bytes(BayesianPolicyReuse(library(), Mine()))
