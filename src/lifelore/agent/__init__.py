"""Agent: one function for each verb of the command line; plain data in and out.

`live`, `perceive`, `reuse` and `advise` are folders, `teach` and `doctor` files; `external_world` is `live_in`,
the life in a user's own world; `warm` compiles the kernels of the verbs before their first use.
"""
