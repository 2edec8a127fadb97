"""A person demonstrates assembly in the modified factory, and learners use the prior at once (Figure 3.16).

Read in this order: `lesson_task` (factories and their exact solutions), `lesson_prior`, `lesson` (a person's
steps), `lesson_learners` (curves with and without the prior), `lesson_records` (in memory).
"""
