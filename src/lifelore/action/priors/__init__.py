"""Action priors: counts of best actions over contexts, and exploration rows for learners (thesis §3.3).

Read in this order: `action_prior`, `policy_counts`, `exploration`, `back_off`, `count_rows`, `context_index`,
`prior_file`, `prior_report`.
"""
