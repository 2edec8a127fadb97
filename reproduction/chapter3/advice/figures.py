"""Names and colours of agents in the figures on advice."""

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILION

EXPLORERS = {
    "random": "random motion",
    "avoid": "random, avoiding obstacles",
    "left": "always left",
    "bug": "goal-seeking bug",
}
AGENTS = {**EXPLORERS, "q_learning": "Q-learning", "optimal": "optimal"}
AGENT_COLOURS = dict(zip(AGENTS, (VERMILION, ORANGE, GREEN, PURPLE, BLUE, INK), strict=True))
ADVICE_COLOURS = {"without advice": GREY, "with advice": VERMILION, "goals apart (ours)": BLUE}
