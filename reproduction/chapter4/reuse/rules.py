"""The rules that the claims of chapter 4 compare, by the names that figures show."""

from lifelore.interaction.selection import (
    BeliefEntropy,
    BeliefSampling,
    EpsilonGreedy,
    ExpectedImprovement,
    Greedy,
    InformationDirected,
    KnowledgeGradient,
    ProbabilityOfImprovement,
    SelectionRule,
)

STANDARD: dict[str, SelectionRule] = {
    "greedy": Greedy(),
    "eps-greedy": EpsilonGreedy(0.3),
    "sampling": BeliefSampling(),
    "PI": ProbabilityOfImprovement(),
    "EI": ExpectedImprovement(of="outcome"),
    "BE": BeliefEntropy(),
    "KG": KnowledgeGradient(candidates="responses"),
    "IDS": InformationDirected(),
}
"""EI improves the outcome; ε as in the thesis; κ of BE is the range of mean pays; IDS is not in the thesis."""
PRINTED: dict[str, SelectionRule] = {
    "PI, printed": ProbabilityOfImprovement(variant="thesis"),
    "EI, printed": ExpectedImprovement(variant="thesis"),
    "BE, printed": BeliefEntropy(variant="thesis"),
    "KG, printed": KnowledgeGradient(variant="thesis"),
}
RULES_SHOWN = STANDARD | PRINTED
NEAR_GREEDY: dict[str, SelectionRule] = {"BE, κ 30": BeliefEntropy(kappa=30.0)}
"""The thesis names no κ. In the surveillance reserve, where pays reach 210, this κ is near greedy selection."""
OF_THESIS = ("eps-greedy", "sampling", "PI", "EI", "BE", "KG")
"""The six of Figure 4.10."""
