"""The advisor once more, slow and obvious: the whole history is kept and looked through at every step."""

from math import exp, inf, log


class NaiveAdvisor:
    """One agent's; `guide` and `settings` are those of an `Advisor`."""

    def __init__(self, guide, settings) -> None:
        self.guide, self.settings = guide, settings
        self.history, self.previous, self.dropped = [], -1, set()
        self.saved, self.spending, self.target = 0.0, False, -1

    def log_prob(self, m, s, previous, a) -> float:
        return float(self.guide.log_models[m][s][previous + 1][a])

    def posterior(self) -> list[float]:
        models = range(len(self.guide.log_prior))
        weights = []
        for m in models:
            total = float(self.guide.log_prior[m])
            for s, previous, a in self.history[-self.settings.window :]:
                total += self.log_prob(m, s, previous, a)
            weights.append(-inf if self.guide.goal_of_model[m] in self.dropped else total)
        best = max(weights)
        mass = [exp(w - best) for w in weights]
        return [w / sum(mass) for w in mass]

    def choose(self, s, posterior) -> int:
        purposes = range(len(self.guide.theta))
        shown = [g for g in purposes if self.guide.steps[g][s] < inf]
        if self.spending and self.target in shown and self.target not in self.dropped:
            return self.target
        open_goals = [g for g in shown if g not in self.dropped and self.guide.goal_of_state[s] != g]
        left = sum(self.guide.goal_share[g] for g in purposes if g not in self.dropped)
        worth = {}
        for g in open_goals:
            own = sum(p for m, p in enumerate(posterior) if self.guide.goal_of_model[m] == g)
            aimless = sum(p for m, p in enumerate(posterior) if self.guide.goal_of_model[m] < 0)
            worth[g] = (own + aimless * self.guide.goal_share[g] / left) / (1 + self.guide.steps[g][s])
        return max(worth, key=worth.__getitem__) if worth else -1

    def consider(self, s) -> tuple[bool, float, list[float]]:
        if len(self.dropped) == len(self.guide.theta):
            self.dropped.clear()
        posterior = self.posterior()
        limited = self.settings.share < 1
        if limited and self.saved >= self.settings.burst:
            self.spending = True
        if self.spending and self.saved < 1:
            self.spending, self.target = False, -1
        self.target = self.choose(s, posterior)
        gain = 0.0
        if self.target >= 0:
            for a, theta in enumerate(self.guide.theta[self.target][s]):
                if theta > 0:
                    mixture = sum(p * exp(self.log_prob(m, s, self.previous, a)) for m, p in enumerate(posterior))
                    gain += theta * log(theta / mixture)
            gain = max(gain, 0.0)
        told = self.target >= 0 and gain >= self.settings.kappa and (self.spending or not limited)
        if limited:
            self.saved = min(self.saved + self.settings.share, self.settings.burst) - told
        return told, gain, posterior

    def observe(self, s, a, advised) -> None:
        if self.guide.goal_of_state[s] >= 0:
            self.dropped.add(int(self.guide.goal_of_state[s]))
        if a >= 0 and not (advised and self.settings.own_steps_only):
            self.history.append((s, self.previous, a))
        self.previous = a
