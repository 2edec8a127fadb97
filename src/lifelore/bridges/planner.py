"""Solves planning problems in PDDL, such as those of perceived scenes, with `unified-planning` (extra
``planning``).

The engine is Fast Downward, which runs as a separate program (GPL; Lifelore does not link to it).
"""

import io
import warnings
from dataclasses import dataclass
from typing import Any

from lifelore.core.errors import InputError, LifeloreError, MissingExtraError

ENGINE = "fast-downward"
SHORT = {"fast_downward_search_config": "lazy_wastar([ff()],w=1,preferred=[ff()],boost=0)"}
"""A search for a short plan; with up to nine objects it mostly takes a fraction of a second."""
SHORT_SECONDS = 3.0
"""Seconds for it at most; then the first plan that is found counts, which may take detours."""


@dataclass(frozen=True)
class Step:
    """One action of a plan and its arguments.

    Examples
    --------
    >>> str(Step("put-on", ("o2", "o3")))
    '(put-on o2 o3)'
    """

    action: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        return f"({' '.join((self.action, *self.arguments))})"


def solve(domain: str, problem: str, *, timeout: float = 60.0) -> tuple[Step, ...] | None:
    """A plan for a problem in PDDL; None if the engine proves that there is no plan.

    Parameters
    ----------
    domain, problem : str
        PDDL texts, such as the results of `lifelore.perception.reasoning.planning_domain.planning_domain` and
        `planning_problem.scene_problem`.
    timeout : float
        Seconds, > 0.

    Raises
    ------
    MissingExtraError
        unified-planning or the engine is not installed.
    InputError
        The texts are not valid PDDL.
    LifeloreError
        The engine ran out of time or memory.
    """
    if not timeout > 0:
        raise InputError(f"timeout must be above 0 seconds, got {timeout}")
    shortcuts, reader = library()
    task = _read(reader, domain, problem)
    first, status = min(SHORT_SECONDS, timeout / 2), ""
    for search, seconds in ((SHORT, first), ({}, timeout - first)):
        with shortcuts.OneshotPlanner(name=ENGINE, params=search) as planner, warnings.catch_warnings():
            # With a stream for its output the engine is waited for, also out of time; its pipes stay open.
            warnings.simplefilter("ignore", ResourceWarning)
            result = planner.solve(task, timeout=seconds, output_stream=io.StringIO())
        status = result.status.name
        if status in ("UNSOLVABLE_PROVEN", "UNSOLVABLE_INCOMPLETELY"):
            return None
        if result.plan is not None:
            return tuple(
                Step(step.action.name, tuple(str(argument) for argument in step.actual_parameters))
                for step in result.plan.actions
            )
    raise LifeloreError(f"the planner found no plan in {timeout:g} s: {status}")


def library() -> tuple[Any, Any]:
    """The library's shortcuts and its reader of PDDL.

    Raises
    ------
    MissingExtraError
        unified-planning or the engine is not installed.
    """
    try:
        import up_fast_downward  # noqa: F401  the engine, found by name
        from unified_planning import shortcuts
        from unified_planning.io import PDDLReader
    except ImportError as error:
        raise MissingExtraError(
            f"planning needs the extra planning: pip install 'lifelore[planning]' ({error})"
        ) from None
    shortcuts.get_environment().credits_stream = None  # the library otherwise prints the engine's authors
    return shortcuts, PDDLReader


def _read(reader: Any, domain: str, problem: str) -> Any:
    """The problem as an object of the library."""
    try:
        with warnings.catch_warnings():
            # The library's reader uses old names of its parser.
            warnings.simplefilter("ignore", DeprecationWarning)
            return reader().parse_problem_string(domain, problem)
    except Exception as error:  # the reader raises its parsers' errors of many kinds
        text = " ".join(str(error).split())
        raise InputError(f"domain and problem must be PDDL: {text[:300]}") from None
