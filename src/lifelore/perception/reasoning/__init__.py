"""Reasoning: consistent scenes, derived facts and planning problems from relations, by logic.

Read in this order: `scene_logic`, `fact`, `scene_facts`, `compound_relations`, `geometric_relations`,
`region_calculus`, `planning_problem`, `goal_obstacles`, `scene_plan`; `support_warnings`.
"""
