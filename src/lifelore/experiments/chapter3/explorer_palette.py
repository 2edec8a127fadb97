"""Names and colours of explorers and of who advises them, the same in every figure on advice."""

from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION

NAMES = {
    "random": "random motion",
    "avoid": "random, avoiding obstacles",
    "left": "always left",
    "bug": "goal-seeking bug",
    "q-learning": "Q-learning",
    "optimal": "optimal",
}
AGENTS = {
    "random": VERMILION,
    "avoid": ORANGE,
    "left": GREEN,
    "bug": PURPLE,
    "q-learning": BLUE,
    "optimal": INK,
}
ADVISORS = {"none": GREY, "thesis": VERMILION, "better": BLUE, "uniform only": SKY}
ADVISOR_NAMES = {
    "none": "no advice",
    "thesis": "the thesis's advisor",
    "better": "better advisor",
    "uniform only": "better advisor, Uniform its only other model",
}
EXPERT_NAMES = {"walks": "walks", "few walks": "few", "trips": "trips", "policies": "policies"}
