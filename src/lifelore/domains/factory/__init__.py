"""The factory of thesis §3.4.2 and the modified factory of §3.4.4.

Read in this order: `factory`, `layout`, `contexts` (what a prior may be conditioned on), `modified_factory`,
`customer_orders` (hidden customers), `environment`, `picture`.
"""
