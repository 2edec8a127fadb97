"""Cells of claim C2.2: lots of pairs, simulated and real. Thesis: §2.4.1."""

from lifelore.experiments.chapter2.scenes.tabletop_pairs import pair_cells as cells
from lifelore.experiments.chapter2.scenes.tabletop_pairs import run_cell

__all__ = ["cells", "run_cell"]
