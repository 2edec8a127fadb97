"""The factories as Gymnasium environments; `lifelore.domains` registers them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import features
from lifelore.domains.factory.factory import ASSEMBLED, RAW, Factory
from lifelore.domains.factory.layout import factory
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.domains.task_environment import TaskEnvironment


class AnyFactoryEnvironment(TaskEnvironment):
    """A task in a factory: procure and assemble a list of components.

    ## Action Space
    ``Discrete(6)``: north, south, east, west, procure, assemble.

    ## Observation Space
    ``Discrete(n_states)``: configuration · cells + cell; a task of k components has 3^k configurations.

    ## Rewards
    -2 a move, -1 onto an express route, -100 a collision, 10 for procuring or assembling a component of the list
    where and when that serves, -10 elsewhere, and 100 once all is assembled.

    ## Starting State
    The start of the factory with nothing procured; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    Everything on the list is assembled.

    ## Arguments
    `factory`: a `Factory`. `components`: numbers of the list, or how many to draw from `seed`.

    ``info`` has ``"collision"``, the components ``"to_procure"`` and ``"to_assemble"`` (what is to be procured is
    also still to be assembled), and ``"features"``, the ten of φ4.
    """

    def __init__(self, factory: Factory, components: int | Sequence[int] = 4, seed: int = 0) -> None:
        self.factory = factory
        if isinstance(components, (int, np.integer)):
            components = factory.draw_components(stream(seed, "components"), int(components))
        self.factory_task = factory.task(components)
        self._features = features(self.factory_task)
        super().__init__(self.factory_task)

    def _info(self, event: int) -> dict[str, Any]:
        assert self._state is not None
        stages = self.factory_task.stages[self._state // self.factory.n_cells]
        components = np.asarray(self.factory_task.components)
        return super()._info(event) | {
            "to_procure": tuple(components[stages == RAW].tolist()),
            "to_assemble": tuple(components[stages < ASSEMBLED].tolist()),
            "features": tuple(self._features[self._state].tolist()),
        }


class FactoryEnvironment(AnyFactoryEnvironment):
    """The thesis's factory (§3.4.2): procurement in one region, assembly in another, express routes between.

    ## Action Space
    ``Discrete(6)``: north, south, east, west, procure, assemble.

    ## Observation Space
    ``Discrete(n_states)``: configuration · cells + cell; 275 · 3^k states for k components.

    ## Rewards
    -2 a move, -1 onto an express route, -100 a collision, 10 for procuring or assembling a component of the list
    where and when that serves, -10 elsewhere, and 100 once all is assembled.

    ## Starting State
    The start of the factory with nothing procured; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    Everything on the list is assembled; truncated after 2,000 steps.

    ## Arguments
    `components`: numbers of the list, 0 to 8, or how many to draw from `seed`, 4.
    """

    def __init__(self, components: int | Sequence[int] = 4, seed: int = 0) -> None:
        super().__init__(factory(), components, seed)


class ModifiedFactoryEnvironment(AnyFactoryEnvironment):
    """The thesis's modified factory (§3.4.4): nine zones, their walls and points drawn anew for each task.

    ## Action Space
    ``Discrete(6)``: north, south, east, west, procure, assemble.

    ## Observation Space
    ``Discrete(n_states)``: configuration · cells + cell; a task of k components has 3^k configurations.

    ## Rewards
    -2 a move, -100 a collision, 10 for procuring or assembling a component of the list where and when that serves,
    -10 elsewhere, and 100 once all is assembled.

    ## Starting State
    The start of the factory with nothing procured; ``reset(options={"state": s})`` starts in state s.

    ## Episode End
    Everything on the list is assembled; truncated after 2,000 steps.

    ## Arguments
    `components`: numbers of the list, 0 to 8, or how many to draw from `seed`, 4. `seed`: of the layout and the
    list.
    """

    def __init__(self, components: int | Sequence[int] = 4, seed: int = 0) -> None:
        super().__init__(modified_factory(stream(seed, "modified factory")), components, seed)
