"""A claim of a few cells whose mean is its only measure, for tests of what runs claims."""

from collections.abc import Callable
from typing import Any

from lifelore.core.metrics import mean_estimate
from reproduction.engine.claim import Claim
from reproduction.engine.statement import Statement


def toy_claim(settings: dict, run_cell: Callable[..., dict], **more: Any) -> Claim:
    """The claim C3.1 with ``settings["n"]`` cells ``{"i": number}``; `run_cell` gives each an ``x``."""
    return Claim(
        id="C3.1",
        title="toy",
        sentence="x is positive",
        thesis="x > 0",
        here="{x}",
        decides="nothing",
        statements=(Statement.parsed("x is positive", "x > 0", central=True),),
        sizes={"quick": settings, "full": settings},
        cells=lambda s: [{"i": i} for i in range(s["n"])],
        run_cell=run_cell,
        measure=lambda s, results: {"x": mean_estimate([r["x"] for r in results])},
        rows=lambda s, results: [dict(one) for one in results],
        **more,
    )
