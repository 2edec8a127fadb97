"""The study of §4.8.5 with people: they play the ball game, and the system adapts its speed (BEAT).

Read in this order: `study_settings`, `study_plan` (the order of rounds), `ball_round` (one round, move by move),
`round_result`, `study_models` (learnt from training rounds), `study_session` (one person), `scripted_player`,
`study_records` (in memory), `study_results` (Figures 4.18-4.20).
"""
