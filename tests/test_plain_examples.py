"""The files of `examples/plain` run and stay short, and the library computes what their plain NumPy computes."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from examples.plain import action_prior as plain_prior
from examples.plain import advice as plain_advice
from examples.plain import beat as plain_beat
from examples.plain import contact_network as plain_contacts
from examples.plain import feature_selection as plain_features
from examples.plain import long_life as plain_life
from examples.plain import policy_reuse as plain_reuse
from lifelore import ActionPrior, BayesianPolicyReuse, Beat, ContactSettings, PolicyLibrary, contact_networks
from lifelore.action.advice.advisor import AdviceSettings, Advisor
from lifelore.action.advice.goal_model import GoalModel
from lifelore.action.features.counted_features import CountedFeatures
from lifelore.action.features.feature_selection import independent_features
from lifelore.core.planning.planning import best_actions
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.selection.belief_entropy import BeliefEntropy
from lifelore.interaction.selection.expected_improvement import ExpectedImprovement
from lifelore.interaction.selection.knowledge_gradient import KnowledgeGradient
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.transition_signal import TransitionSignal
from lifelore.perception.relations.displacement import votes

ROOT = Path(__file__).parents[1]
FILES = sorted((ROOT / "examples" / "plain").glob("*.py"))
PRINTS = {
    "action_prior": r"uniform .*-\d+\.\d+\naction prior .* \d+\.\d+",
    "advice": r"an expert(\n  cell +\d+  gain \d\.\d\d)+\na lost explorer(\n.*)+advised",
    "beat": r"a skilled user: .*3\].*\na clumsy user: speeds \[1, 1, 1, 1, 1\]",
    "contact_network": r"\('on', 1\.0\)\n.*\('adjacent', 0\.6",
    "feature_selection": r"after 10 tasks: wall ahead, door left\n",
    "long_life": r"0 to  39: glad 0\.8.*\n.*\n.*80 to 119: glad 0\.8\d, new types 0",
    "policy_reuse": r"greedy .* 6\.6 .*\nexpected improvement .* 6\.3",
}


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_file_is_short_and_prints_what_it_is_about(file):
    assert len(file.read_text("utf-8").splitlines()) <= 120
    done = subprocess.run([sys.executable, file], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert re.search(PRINTS[file.stem], done.stdout), done.stdout


def test_the_counts_of_an_action_prior_and_its_proportions():
    T = plain_prior.maze_transitions(plain_prior.MAZE)
    alpha, prior = np.full(T.shape[:2], 0.1), ActionPrior(4, alpha0=0.1)
    for goal in (3, 17, 30):
        Q = plain_prior.optimal_q(T, plain_prior.goal_rewards(T, goal), goal)
        alpha = plain_prior.update(alpha, plain_prior.useful(Q), goal, w=1.5)
        best = best_actions(Q)
        assert (best == plain_prior.useful(Q)).all()
        best[goal] = False
        prior.update(np.arange(len(T)), best, 1.5)
    assert prior.probs(np.arange(len(T))) == pytest.approx(plain_prior.proportions(alpha), abs=1e-6)


def test_entropies_and_selected_features():
    generator = np.random.default_rng(2)
    for _ in range(10):
        phi, useful = plain_features.one_task(generator)
        counted = CountedFeatures.from_columns(phi, useful)
        _, alpha = plain_features.marginalised(phi, useful, list(range(6)))
        assert counted.entropy() == pytest.approx(plain_features.entropy(alpha), abs=1e-12)
        selected = independent_features(counted)
        assert selected.names == tuple(f"f{f}" for f in plain_features.select(phi, useful))


def test_the_gain_of_advice_and_the_posterior_of_models():
    generator = np.random.default_rng(8)
    counts = plain_advice.expert_counts(generator)
    theta = counts / counts.sum(axis=1, keepdims=True)
    models = np.stack([theta, np.full_like(theta, 1 / 3)])
    prior = ActionPrior(3, plain_advice.ALPHA0)
    for action in range(3):
        weight = counts[:, action] - plain_advice.ALPHA0
        prior.update(np.arange(12), np.tile(np.arange(3) == action, (12, 1)), weight)
    model = GoalModel((), prior, np.zeros(12), advised_alpha0=plain_advice.ALPHA0)
    advisor = Advisor([model], settings=AdviceSettings(kappa=plain_advice.KAPPA))
    states, actions = generator.integers(0, 12, 40), generator.integers(0, 3, 40)
    found = advisor.assess(states, actions)
    history = list(zip(states.tolist(), actions.tolist(), strict=True))
    for t in range(40):
        posterior = plain_advice.posterior(history[:t], models)
        gain = plain_advice.gain(theta, models, history[:t], states[t])
        assert found.p_normal[t] == pytest.approx(posterior[0], abs=1e-5)
        assert found.gain[t] == pytest.approx(gain, abs=1e-5)
        assert found.advise[t] == (gain >= plain_advice.KAPPA)


def test_contact_points_and_edges_of_two_boxes_and_of_an_arch():
    box = plain_contacts.box
    lower = box((0, 0, 0), (0.06, 0.06, 0.06))
    arch = np.concatenate([lower, box((0.14, 0, 0), (0.06, 0.06, 0.06))])
    for first, second in (
        (box((0.01, 0.0, 0.063), (0.06, 0.06, 0.06)), lower),
        (box((0, 0, 0.064), (0.2, 0.06, 0.02)), arch),
    ):
        ours = contact_networks(first, second, ContactSettings.of_thesis())
        for network, (nodes, edges) in zip(ours, plain_contacts.contact_networks(first, second), strict=True):
            assert len(network.nodes) == len(nodes) > 0
            order = np.lexsort(nodes.T.round(3))
            own = np.lexsort(network.positions.T.round(3))
            assert network.positions[own] == pytest.approx(nodes[order], abs=0.002)
            assert len(network.edges) == len(edges)


def test_votes_of_the_nearest_displacements():
    generator = np.random.default_rng(1)
    known = generator.normal(size=(40, 3))
    labels = ["on" if d[2] > 0 else "adjacent" for d in known]
    codes, queries = np.array([label == "on" for label in labels], np.int64), generator.normal(size=(20, 3))
    shares = votes(known, codes, 2, queries, 5, "uniform")
    for query, share in zip(queries, shares, strict=True):
        name, part = plain_contacts.vote(query, known, labels, k=5)
        assert share[int(name == "on")] == part == share.max()


def random_library(generator: np.random.Generator) -> tuple[PolicyLibrary, np.ndarray, np.ndarray]:
    U, F = generator.normal(0, 10, (4, 3)), generator.dirichlet(np.ones(5), (4, 3))
    return PolicyLibrary.from_means(U, 1.0, signal=CategorySignal(F)), U, F


@pytest.mark.parametrize("seed", range(8))
def test_beliefs_and_scores_of_rules(seed):
    generator = np.random.default_rng(seed)
    library, U, F = random_library(generator)
    agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.static())
    beta = np.full(4, 0.25)
    for _ in range(4):
        policy, signal = int(generator.integers(3)), int(generator.integers(5))
        agent.update(policy, signal)
        beta = plain_reuse.update(beta, F, policy, signal)
        assert agent.belief == pytest.approx(beta, abs=1e-12)
        rule = BeliefEntropy(kappa=3.0, mass=1.0)
        assert rule.scores(library, beta) == pytest.approx(plain_reuse.belief_entropy(beta, U, F, 3.0), abs=1e-9)
        gradient = KnowledgeGradient(mass=1.0).scores(library, beta, episodes_left=7)
        assert gradient == pytest.approx(plain_reuse.knowledge_gradient(beta, U, F, 7), abs=1e-9)
        improvement = ExpectedImprovement().scores(library, beta)
        assert improvement == pytest.approx(plain_reuse.expected_improvement(beta, U), abs=1e-9)


def test_the_belief_of_beat_and_its_action_set():
    slips, speeds = plain_beat.SLIPS, plain_beat.SPEEDS
    T = np.array([[plain_beat.transitions(slip, speed) for speed in speeds] for slip in slips])
    V = np.array([[plain_beat.value(T[t, z])[0][plain_beat.START] for z in range(2)] for t in range(2)])
    library = PolicyLibrary.from_means(V, 1.0, signal=TransitionSignal(T))
    learner, beta = Beat(library), np.full(2, 0.5)
    generator, s = np.random.default_rng(3), plain_beat.START
    for _ in range(30):
        z = plain_beat.best_action_set(beta, V)
        assert learner.select() == z
        a = int(generator.integers(2))
        after = int(generator.choice(plain_beat.LENGTH, p=T[1, z, s, a]))
        learner.update(z, [(s, a, after)])
        beta = plain_beat.update(beta, T[:, z], s, a, after)
        assert learner.belief == pytest.approx(beta, abs=1e-12)
        s = plain_beat.START if after in (plain_beat.GOAL, plain_beat.DITCH) else after


def test_a_long_life_finds_the_types_that_there_are():
    generator, memory = np.random.default_rng(11), plain_life.Memory()
    for task in range(60):
        plain_life.live_task(memory, task % 2, (1, 3)[task % 2], generator)
    best = memory.model[memory.alpha.sum(axis=0) > 3].argmax(axis=1)
    assert sorted(best) == [1, 3]
    assert memory.alpha[0].argmax() != memory.alpha[1].argmax()
