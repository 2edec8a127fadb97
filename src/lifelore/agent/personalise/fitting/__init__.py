"""The verb `lifelore reuse fit`: a log becomes a study, its model and types chosen by users held out.

Read in this order: `fit`, `model_choice`, `held_out`, `library_from_log`, `fit_notes`.
"""
