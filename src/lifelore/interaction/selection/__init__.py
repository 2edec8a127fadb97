"""Selection rules: which policy to run next under a belief over types (thesis §4.5).

Read in this order: `rule` (the interface), `choice` (the best score, available policies, propensities), a file for
each rule, then what the rules that look ahead share: `support` and `information`. `belief_program` computes the
exact optimum.
"""

from collections.abc import Mapping
from typing import Any

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.selection.belief_entropy import BeliefEntropy
from lifelore.interaction.selection.belief_sampling import BeliefSampling
from lifelore.interaction.selection.choice import choose, propensities, tied_shares
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy
from lifelore.interaction.selection.expected_improvement import ExpectedImprovement
from lifelore.interaction.selection.greedy import Greedy
from lifelore.interaction.selection.information_directed import InformationDirected
from lifelore.interaction.selection.knowledge_gradient import KnowledgeGradient
from lifelore.interaction.selection.probability_of_improvement import ProbabilityOfImprovement
from lifelore.interaction.selection.rule import SelectionRule
from lifelore.interaction.selection.value_of_perfect_information import ValueOfPerfectInformation

RULES: dict[str, type] = {
    rule.name: rule
    for rule in (
        Greedy,
        EpsilonGreedy,
        BeliefSampling,
        ProbabilityOfImprovement,
        ExpectedImprovement,
        BeliefEntropy,
        KnowledgeGradient,
        ValueOfPerfectInformation,
        InformationDirected,
    )
}
"""Every rule by the name that sessions and the command line use."""

DEFAULT_RULE = "information-directed"
"""Name of the rule where none is given, for agents, many users and `lifelore reuse`; claim O1 decides it."""
WITHOUT_TABLE = "greedy"
"""Name of the rule in its place where the signals have no table and cannot be drawn. Improvement of the pay, which
was in its place, pursues unlikely types where every episode tells the type."""
BEFORE: dict[str, dict[str, Any]] = {
    "expected-improvement": {"of": "outcome"},
    "knowledge-gradient": {"candidates": "responses"},
}
"""Settings that rules had before they could be chosen or before their defaults changed, for files without them."""

__all__ = [
    "DEFAULT_RULE", "RULES", "BeliefEntropy", "BeliefSampling", "EpsilonGreedy", "ExpectedImprovement", "Greedy",
    "InformationDirected", "KnowledgeGradient", "ProbabilityOfImprovement", "SelectionRule",
    "ValueOfPerfectInformation", "choose", "default_rule", "printed_rule", "propensities", "restored_rule",
    "rule_named", "rule_of", "tied_shares",
]  # fmt: skip


def rule_named(name: str, **settings) -> SelectionRule:
    """The rule of that name with these settings; NotFoundError where there is no such rule.

    Examples
    --------
    >>> rule_named("epsilon-greedy", epsilon=0.1)
    EpsilonGreedy(epsilon=0.1)
    """
    if name not in RULES:
        raise NotFoundError(f"rule must be one of {', '.join(RULES)}, got {name!r}")
    return RULES[name](**settings)


def printed_rule(name: str) -> SelectionRule:
    """The rule of that name as the thesis prints it, §4.5: ``variant="thesis"`` where it has variants.

    Raises
    ------
    NotFoundError
        There is no rule of that name, or it is not one of the thesis's.

    Examples
    --------
    >>> printed_rule("knowledge-gradient").variant
    'thesis'
    """
    rule = rule_named(name)
    if isinstance(rule, InformationDirected):
        printed = ", ".join(other for other in RULES if other != name)
        raise NotFoundError(f"rule must be one that the thesis prints, {printed}, got '{name}'")
    return rule_named(name, variant="thesis") if hasattr(rule, "variant") else rule


def default_rule(library: Any) -> SelectionRule:
    """The rule for a library where none is given: `DEFAULT_RULE`, or `WITHOUT_TABLE` where signals have no table.

    Examples
    --------
    >>> from lifelore.interaction.library.policy_library import PolicyLibrary
    >>> default_rule(PolicyLibrary.from_means([[10.0, 6.0]], 1.0))
    InformationDirected(mass=0.999, n_bins=8)
    """
    return rule_named(DEFAULT_RULE if library.has_table else WITHOUT_TABLE)


def rule_of(rule: SelectionRule | str | None, library: Any) -> SelectionRule:
    """The rule itself, the rule of that name, or where it is None the `default_rule` of the library.

    Raises
    ------
    NotFoundError
        There is no rule of that name.
    InputError
        `rule` is neither a name nor a rule.
    """
    if rule is None:
        return default_rule(library)
    if isinstance(rule, str):
        return rule_named(rule)
    if isinstance(rule, type) or not (hasattr(rule, "scores") and hasattr(rule, "probabilities")):
        raise InputError(f"rule must be a selection rule or its name, one of {', '.join(RULES)}, got {rule!r:.80}")
    return rule


def restored_rule(name: str, settings: Mapping[str, Any]) -> SelectionRule:
    """The rule that was saved with these settings; a setting that is missing has the value that it had then.

    Examples
    --------
    >>> restored_rule("expected-improvement", {"variant": "standard"})
    ExpectedImprovement(variant='standard', of='outcome')
    """
    return rule_named(name, **{**BEFORE.get(name, {}), **settings})
