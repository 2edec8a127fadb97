"""Advice to agents with unknown goals (thesis §3.7).

Read in this order: `advice` (the evidence), `behaviour_models`, `goal_model`, `advisor`, `agent_classes`
(staff and visitors);
`outcome_map` lets an advisor watch agents with other actions than the experts.
"""
