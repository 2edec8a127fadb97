"""The factory of thesis §3.4.2 and the modified factory of §3.5.3.

Read in this order: `factory`, `layout`, `contexts` (what a prior may be conditioned on), `knowledge` (hand-made
priors), `modified_factory`, `customer_orders` (hidden customers), `environment`, `picture`.
"""
