"""The verbs of `lifelore reuse`: a log becomes a policy library, then choices for one user at a time.

Read in this order: `log` (`log_format`, `log_lines`, `log_columns`), `fit`, `types_of_users`, `library_from_log`,
`types_by_context`, `held_out`, `model_choice`,
`study`, `past`, `warm`, `one_user` (choose, update, retire, add, forget),
`requests`, `history`, `user_belief`, `user_state`,
`report`; `logged_decisions`, `target_policies`, `replayed_choices`, `cross_fitted`, `target_estimates`, `evaluate`
(estimates from a log of what other policies would have achieved). `result_folder` writes documents and pictures.
"""
