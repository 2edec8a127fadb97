"""Interaction: choose among known policies by a belief over types (thesis ch. 4).

From the model to the choice: `finite_signals` → `outcomes` → `signals` → `library` and `beliefs` → `selection` →
`reuse` (within it `novelty`: tasks of unknown types). `adaptation` adapts an interface step by step (BEAT),
`baselines` holds bandits and other papers' methods of reuse, `evaluation` estimates the value of other policies
from logged decisions.
"""
