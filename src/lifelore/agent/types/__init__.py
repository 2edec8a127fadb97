"""Types that tasks have, whatever the tasks are: what each has shown, which is expected, and which is another one.

Read in this order: `same_type`, `novelty` (the alarm), `type_prior`.
"""
