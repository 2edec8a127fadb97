"""Small studies for tests, what users lived in them, and the slow twin of a user's belief."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from lifelore.agent.personalise.decisions import choose, update
from lifelore.agent.personalise.study import Study
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.memory import Memory
from lifelore.memory.study_rows import StudyRows

POLICIES = ("big", "dark", "plain")
MEANS = np.array([[8.0, 1.0, 4.0], [1.0, 8.0, 4.0]])


def study_of(name: str = "s", policies: Iterable[str] = POLICIES, **settings: Any) -> Study:
    """Two types, whose models are exact: outcomes of deviation 2 around `MEANS`; prior 0.6 and 0.4."""
    library = PolicyLibrary.from_means(MEANS, 2.0, ("reader", "skimmer"), tuple(policies), prior=[0.6, 0.4])
    # Computed once and stored with the library, as a registration does.
    getattr(library.performance, "spread", None)
    settings = {"control": 0.0, "rule": "sampling"} | settings
    return Study(name, library, dict.fromkeys(library.policies, "active"), **settings)


def learnt_study(model: str, **settings: Any) -> Study:
    """A study whose library has seen eight outcomes of three types, each 0 or 1."""
    samples = np.random.default_rng(0).integers(0, 2, (3, len(POLICIES), 8)).astype(float)
    if model == JointNormalOutcomes.kind:
        outcomes = JointNormalOutcomes(samples.mean(axis=-1), 0.2 * np.eye(3) + 0.1, 0.5)
        library = PolicyLibrary(outcomes, policies=POLICIES)
    else:
        library = PolicyLibrary.from_samples(samples, model=model, policies=POLICIES)
    return Study("s", library, dict.fromkeys(POLICIES, "active"), **({"control": 0.0} | settings))


def one_more(memory: Memory, study: Study, user: str, outcome: float, **known: Any) -> str:
    """The policy of a decision that ended at once."""
    made = choose(memory, study, user, **known)
    update(memory, study, made["decision"], outcome)
    return made["policy"]


def n_past(rows: StudyRows) -> int:
    """Number of lines of the past."""
    return rows._conn.value("SELECT COUNT(*) FROM lifelore_study_past WHERE study = ?", (rows._study,))


def twin(study: Study, shown: Iterable[tuple[str, float]], prior: Any = None) -> BayesianPolicyReuse:
    """The slow twin: a single agent that takes in (policy, outcome) one after the other."""
    models: Any = study.models
    agent = BayesianPolicyReuse(study.library, prior=prior, dynamics=study.dynamics, models=models)
    for policy, outcome in shown:
        if policy in study.library.policies:
            agent.update(policy, outcome)
        else:
            agent.end_episode()
    return agent


def belief_of(memory: Memory, study: Study, user: str) -> list[float]:
    """The belief by which the next decision of a user is made; it makes that decision."""
    return list(choose(memory, study, user)["belief"].values())
