"""The telephone service as a Gymnasium environment; `lifelore.domains` registers it."""

from typing import Any

import numpy as np
from gymnasium import spaces

from lifelore.domains.checked_environment import CheckedEnvironment, chosen_number
from lifelore.domains.telephone.telephone import OPEN, START, STATES, Telephone, reward


class TelephoneEnvironment(CheckedEnvironment):
    """A call in the thesis's online personalisation (§4.6.2): a step is one transition of the call.

    ## Action Space
    ``Discrete(n_models)``: the language model used.

    ## Observation Space
    ``Discrete(6)``: start, frustrated, annoyed, angry, success, hung up.

    ## Rewards
    1 for an irritation that does not end the call; at the end what makes it 10 in all for a success, else 3.

    ## Starting State
    ``start``, with a caller drawn anew; ``reset(options={"caller": i})`` chooses who calls.

    ## Episode End
    Success, hung up, or angry: after at most three steps.

    ## Arguments
    `n_models`: 10. `eta`: 0.3. `reading`: ``"A"`` or ``"B"``, see `domains.telephone`. `caller`: who always calls,
    a preferred model; None draws one at each reset.

    ``info["caller"]`` is the caller's preference, which the service does not know.
    """

    def __init__(
        self, n_models: int = 10, eta: float = 0.3, reading: str = "A", caller: int | None = None
    ) -> None:
        super().__init__()
        self.world = Telephone(n_models, eta, reading)
        self.action_space = spaces.Discrete(n_models)
        self.observation_space = spaces.Discrete(len(STATES))
        self._fixed = None if caller is None else chosen_number(caller, n_models, "caller")
        self.caller = 0
        self._state = START

    def _begin(self, options: dict[str, Any]) -> tuple[int, dict[str, Any]]:
        self._state = START
        drawn = int(self.np_random.integers(self.world.n_models))
        asked = options.get("caller", self._fixed)
        self.caller = drawn if asked is None else chosen_number(asked, self.world.n_models, "caller")
        return START, {"caller": self.caller}

    def _advance(self, action: int) -> tuple[int, float, bool, dict[str, Any]]:
        before = self._state
        cumulative = self.world.transition_probs[self.caller, action, before].cumsum()
        self._state = int(np.searchsorted(cumulative[:-1], self.np_random.random(), side="right"))
        self._running = self._state in OPEN
        return self._state, reward(before, self._state), not self._running, {"caller": self.caller}
