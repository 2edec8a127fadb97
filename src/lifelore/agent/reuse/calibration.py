"""How well a study's predictions fit its decisions: quantiles of outcomes, and probabilities of types.

Outcomes are predicted by the belief before each decision, in the order of decisions. Types are known of users whom
a log names; the name itself and the outcomes of the log are left out, so that only decisions speak for a type.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.history import History
from lifelore.agent.reuse.past import Past, PastUser
from lifelore.agent.reuse.study import Study
from lifelore.agent.reuse.user_belief import after_past
from lifelore.agent.reuse.user_state import WorkingBelief
from lifelore.interaction.reuse.calibration import outcome_calibration, outcome_levels, type_calibration

Array = NDArray[np.float64]


def calibration(study: Study, known: Sequence[History], past: Past) -> dict[str, Any]:
    """Calibration on the decisions of `known` users.

    Returns
    -------
    dict
        ``outcomes`` and ``types``, each as `Calibration.to_dict` with users as groups; None without an outcome, or
        without a user whose type is known and who has an outcome.
    """
    return {"outcomes": _of_outcomes(study, known, past), "types": _of_types(study, known, past)}


def _of_outcomes(study: Study, known: Sequence[History], past: Past) -> dict[str, Any] | None:
    levels, users = [], []
    for number, history in enumerate(known):
        own = past.users.get(history.key, PastUser())
        features = history.features or own.features
        belief = after_past(study, history.context or own.context, own, features)
        for decision in history.decisions:
            if decision.outcome is not None and decision.policy in study.library.policies:
                policy = study.library.index_of_policy(decision.policy)
                levels.append(outcome_levels(belief.known, [belief.belief], [policy], [decision.outcome])[0])
                users.append(number)
            belief.learn(decision.policy, decision.outcome)
    return outcome_calibration(levels, users).to_dict() if users else None


def _of_types(study: Study, known: Sequence[History], past: Past) -> dict[str, Any] | None:
    beliefs, types, users = [], [], []
    for number, history in enumerate(known):
        own = past.users.get(history.key, PastUser())
        if own.type not in study.library.types:
            continue
        features = history.features or own.features
        belief = WorkingBelief.of_stranger(study, study.prior_of(history.context or own.context, features))
        for decision in history.decisions:
            belief.learn(decision.policy, decision.outcome)
            if decision.outcome is not None:
                beliefs.append(belief.belief)
                types.append(study.library.index_of_type(own.type))
                users.append(number)
    return type_calibration(np.array(beliefs), np.array(types), users).to_dict() if users else None
