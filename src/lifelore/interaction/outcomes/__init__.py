"""Outcome models: P(utility | type, policy), the performance model of the thesis (§4.3.4).

Read in this order: `outcome_model` (the interface), `gaussian_outcomes`, `student_t_outcomes`,
`histogram_outcomes`, `categorical_outcomes`, `joint_normal_outcomes`; `outcome_kinds` lists them by name. Laws
(`law`) compute their likelihoods for many users.
"""
