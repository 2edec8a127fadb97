"""Cells of claim C2.12: lots of pairs, simulated and real. Thesis: §2.3.5."""

from lifelore.experiments.chapter2.scenes.tabletop_pairs import pair_cells as cells
from lifelore.experiments.chapter2.scenes.tabletop_pairs import run_cell

__all__ = ["cells", "run_cell"]
