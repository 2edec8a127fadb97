"""The symbols and short names that the claims of a chapter use, as a table for its page."""

WORDS = {
    "2": {
        "contact point": "where two objects touch: a cluster of support vectors of the surface between them",
        "network": "the contact points of an object, joined in a graph; its skeleton has no geometry",
        "displacement": "from a contact point of one object to the nearest one of the other",
        "hole": "a cycle through the networks of two objects and their contacts",
        "*on*, *adjacent*, *both*": "one object carries the other; they touch sideways; they do both",
    },
    "3": {
        "prior": "how often each action was best in a context over earlier tasks, as a distribution over actions",
        "α⁰": "counts that every action has before anything is counted; larger trusts experience less",
        "ε, α": "share of exploring steps, and learning rate, of Q-learning",
        "ε-QSAP, ε-QPAP": "Q-learning that explores by a prior over states, or over percepts (what is around)",
        "φ1 … φ4": "sets of features: own cell and Items; the cells to the N, W, E and S; both; all ten features",
        "uniform": "Q-learning without a prior",
        "κ": "cost of advice in nats; advice is given where it tells more",
        "H, M₁, M₂": "the last steps of an agent, and models of it: an expert, and one that moves at random",
    },
    "4": {
        "BPR": "Bayesian policy reuse: choose among known policies by a belief over types of task",
        "U; (s, a, r); (s, a, s′)": "signals that update the belief: the return; rewards of steps; transitions",
        "regret": "return of the best policy for the task, less that of the policy chosen",
        "EI, PI, KG, BE, IDS": "selection rules: expected improvement, probability of improvement, knowledge "
        "gradient, belief entropy, information-directed selection",
        "PRQ": "probabilistic policy reuse by Q-learning (Fernández and Veloso)",
        "UCB1, GP-UCB, EXP-3": "bandit algorithms: by upper confidence bounds, by a Gaussian process, by weights",
        "BEAT": "adapts an interface to its user by a belief over types of users (§4.8)",
        "b": "the size of the ball in the ball game, which is the type of its user",
        "diversity": "number of types in a set of users",
        "ε": "share of random choices; for landmarks, the distance within which tasks form a type",
    },
    "5": {
        "AUC": "probability that a new type scores higher than a known one: 0.5 by chance, 1 at best",
        "*under*, *between*, *in* …": "relations between objects, learnt or composed by logic",
    },
}
"""Meaning of each symbol or name by chapter."""


def symbols(chapter: str) -> list[str]:
    """The table as lines of Markdown, folded."""
    rows = [f"| {name} | {meaning} |" for name, meaning in WORDS[chapter].items()]
    return ["<details><summary>Symbols and names</summary>", "", "| name | meaning |", "|---|---|", *rows, "",
            "</details>", ""]  # fmt: skip
