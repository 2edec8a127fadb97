"""Action: priors over actions, and what they guide (thesis ch. 3).

`priors` counts which actions were best, `features` chooses what to condition on, `search` guides planners,
`demonstrations` learns from people, `advice` advises agents whose goals are unknown.
"""
