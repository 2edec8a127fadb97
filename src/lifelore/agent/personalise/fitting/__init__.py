"""The verb `lifelore reuse fit`: a log becomes a study, its model and types chosen by users held out.

Read in this order: `fit`, `model_choice`, `held_out`, `types_of_users`, `library_from_log`, `fit_notes`.
"""
