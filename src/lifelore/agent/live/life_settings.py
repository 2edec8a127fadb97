"""Everything a life can be told, with the defaults that work."""

from dataclasses import dataclass
from math import ceil, isfinite

from lifelore.action.priors.action_prior import FORMS
from lifelore.core.errors import InputError

LEARNERS = ("model", "q")
PRIORS = ("observation", "state", "none")
WHOLE = {
    "tasks": (1, 10**6),
    "destinations": (0, 10**9),
    "episodes": (1, 10**6),
    "max_steps": (1, 10**9),
    "jobs": (1, 256),
}
"""Least and most of the whole numbers."""
LARGEST = {
    "cell": 1e3, "robot_radius": 1e3, "discount": 1.0, "goal_reward": 1e6, "wall_reward": 1e6,
    "density": 1.0, "alpha0": 1e6, "weight": 1e6,
}  # fmt: skip
"""Magnitudes beyond which a number is a slip, or drowns the others in rounding; the rules of those who use it
are narrower."""
SHARES = ("learning_rate", "epsilon", "epsilon_decay", "epsilon_floor")


@dataclass(frozen=True)
class LifeSettings:
    """Settings of `live`; None means the default of the domain or learner.

    Parameters
    ----------
    domain : str
        One of `lifelore.domains.worlds.domain_names()`: building, lattice, noise, advice.
    map : str, optional
        ROS map (YAML); None generates an office from `seed`.
    tasks : int
        Tasks to live through now, ≥ 1.
    cell, robot_radius : float, optional
        Metres, in buildings: 0.5 and 0.2.
    destinations : int
        Goals lie among this many recurring places; 0: anywhere.
    learner : {"model", "q"}
    prior : {"observation", "state", "none"}
        What action priors are conditioned on.
    agent : str
        Who lives; ``scratch`` always lives beside. ``all``: everybody.
    robot : str
        Name under which memory keeps this life; one for each robot that runs at a time.
    start : (row, column), optional
        Every episode starts here; None: anywhere.
    memory : str, optional
        SQLite file or postgresql:// URL; None: the user's own memory.
    episodes, max_steps : int, optional
        At most so many episodes a task, of at most so many steps; their product is the cap.
    seed : int
    jobs : int
        Threads; results do not depend on it.
    density : float, optional
        Share of obstacles in a noise maze, in (0, 1).
    discount, goal_reward, wall_reward : float, optional
    alpha0, weight : float
        Pseudo-count α⁰ and weight w(π) of the prior (Eq. 3.4).
    form, ties : str
        `learner="q"`: form of the prior, and how the greedy step breaks ties (uniform or prior).
    learning_rate, epsilon, epsilon_decay, epsilon_floor : float
        `learner="q"`: α, and ε = max(floor, epsilon · decay^episode).
    """

    domain: str = "building"
    map: str | None = None
    tasks: int = 30
    cell: float | None = None
    robot_radius: float | None = None
    destinations: int = 0
    learner: str = "model"
    prior: str = "observation"
    agent: str = "lore"
    robot: str = "robot"
    start: tuple[int, int] | None = None
    memory: str | None = None
    episodes: int | None = None
    max_steps: int | None = None
    seed: int = 0
    jobs: int = 2
    density: float | None = None
    discount: float | None = None
    goal_reward: float | None = None
    wall_reward: float | None = None
    alpha0: float = 0.1
    weight: float = 1.0
    form: str = "proportion"
    ties: str = "uniform"
    learning_rate: float = 0.5
    epsilon: float = 1.0
    epsilon_decay: float = 0.98
    epsilon_floor: float = 0.01

    def __post_init__(self) -> None:
        for name, known in {
            "learner": LEARNERS,
            "prior": PRIORS,
            "form": FORMS,
            "ties": ("uniform", "prior"),
        }.items():
            if getattr(self, name) not in known:
                raise InputError(f"{name} must be one of {', '.join(known)}, got '{getattr(self, name)}'")
        for name, (least, most) in WHOLE.items():
            value = getattr(self, name)
            if value is not None and not (isinstance(value, int) and least <= value <= most):
                raise InputError(f"{name} must be a whole number from {least} to {most:,}, got {value}")
        # Also what this life has no use for: it stands in the report.
        for name, most in LARGEST.items():
            value = getattr(self, name)
            if value is not None and not isfinite(value):
                raise InputError(f"{name} must be a finite number, got {value}")
            if value is not None and abs(value) > most:
                raise InputError(f"{name} must be of magnitude {most:g} at most, got {value}")
        for name in SHARES:
            if not 0 <= getattr(self, name) <= 1:
                raise InputError(f"{name} must lie in [0, 1], got {getattr(self, name)}")
        if self.goal_reward is not None and self.goal_reward <= 0:
            raise InputError(f"goal_reward must be positive, got {self.goal_reward}")
        if self.wall_reward is not None and self.wall_reward > 0:
            raise InputError(f"wall_reward must be at most 0, got {self.wall_reward}")
        if not (self.robot.strip() and self.robot.isprintable() and len(self.robot) <= 200):
            raise InputError(f"robot must be a name of 1 to 200 printable characters, got {self.robot[:40]!r}")

    def episode_cap(self, n_states: int) -> int:
        """Episodes of a task at most in a world of `n_states`: 1,000 for learner q; for learner model 100, or as
        many as ten steps a state need where that is more."""
        if self.episodes is not None:
            return self.episodes
        return max(100, ceil(10 * n_states / self.step_cap)) if self.learner == "model" else 1000

    @property
    def step_cap(self) -> int:
        """Steps of an episode at most: 2,000 in buildings, 1,000 in the thesis's worlds."""
        return self.max_steps or (2000 if self.domain == "building" else 1000)
