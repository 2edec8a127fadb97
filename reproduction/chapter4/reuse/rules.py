"""The six rules of Figure 4.10, in their standard form and as printed, by the names that figures show."""

from lifelore.interaction.selection import (
    BeliefEntropy,
    BeliefSampling,
    EpsilonGreedy,
    ExpectedImprovement,
    KnowledgeGradient,
    ProbabilityOfImprovement,
    SelectionRule,
)

STANDARD: dict[str, SelectionRule] = {
    "ε-greedy": EpsilonGreedy(0.3),
    "sampling": BeliefSampling(),
    "KG": KnowledgeGradient(candidates="responses"),
    "BE": BeliefEntropy(),
    "PI": ProbabilityOfImprovement(),
    "EI": ExpectedImprovement(of="outcome"),
}
"""EI improves the outcome; ε as in the thesis; κ of BE is the range of mean pays."""
PRINTED: dict[str, SelectionRule] = {
    "KG, printed": KnowledgeGradient(variant="thesis"),
    "BE, printed": BeliefEntropy(variant="thesis"),
    "PI, printed": ProbabilityOfImprovement(variant="thesis"),
    "EI, printed": ExpectedImprovement(variant="thesis"),
}
RULES = STANDARD | PRINTED
PI_PRINTED = "PI as printed"
FORMS = "standard", PI_PRINTED, "all as printed"


def in_form(name: str, form: str) -> str:
    """The name of a rule's printed form where it has one and `form` asks for it, else of its standard form."""
    printed = f"{name}, printed"
    asked = form == "all as printed" or form == f"{name} as printed"
    return printed if asked and printed in RULES else name
