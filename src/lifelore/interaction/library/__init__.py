"""Policy library: types × policies with their models, how it is filled, stored and reduced (thesis §4.3, §4.4).

Read in this order: `policy_library`, `library_file`, `task_types` and `user_types` (find types).
"""
