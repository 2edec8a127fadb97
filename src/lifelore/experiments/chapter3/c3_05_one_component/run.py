"""C3.5: in the factory with one component, what a prior gains as it accumulates from 0 to 40 tasks.

There are only nine such tasks, so that at the end all have been met. Thesis: §3.4.3, Figure 3.8.
"""

from lifelore.experiments.chapter3.factory.series import cells, check, run_cell

__all__ = ["cells", "check", "run_cell"]
