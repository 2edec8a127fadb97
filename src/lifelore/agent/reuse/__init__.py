"""The verbs of `lifelore reuse`: a log becomes a policy library, then choices for one user at a time.

Read in this order: `log`, `fit`, `types_of_users`, `library_from_log`, `study`, `one_user` (choose, update,
retire, add, forget), `history`, `report`.
"""
