"""The six rules of Figure 4.10, in their standard form and as printed, by the names that figures show."""

from lifelore.interaction import selection

STANDARD: dict[str, selection.SelectionRule] = {
    "ε-greedy": selection.EpsilonGreedy(0.3),
    "sampling": selection.BeliefSampling(),
    "KG": selection.KnowledgeGradient(candidates="responses"),
    "BE": selection.BeliefEntropy(),
    "PI": selection.ProbabilityOfImprovement(),
    "EI": selection.ExpectedImprovement(of="outcome"),
}
"""EI improves the outcome; ε as in the thesis; κ of BE is the range of mean pays."""
PRINTED: dict[str, selection.SelectionRule] = {
    "KG, printed": selection.KnowledgeGradient(variant="thesis"),
    "BE, printed": selection.BeliefEntropy(variant="thesis"),
    "PI, printed": selection.ProbabilityOfImprovement(variant="thesis"),
    "EI, printed": selection.ExpectedImprovement(variant="thesis"),
}
RULES = STANDARD | PRINTED
PI_PRINTED = "PI as printed"
FORMS = "standard", PI_PRINTED, "all as printed"


def in_form(name: str, form: str) -> str:
    """The name of a rule's printed form where it has one and `form` asks for it, else of its standard form."""
    printed = f"{name}, printed"
    asked = form == "all as printed" or form == f"{name} as printed"
    return printed if asked and printed in RULES else name
