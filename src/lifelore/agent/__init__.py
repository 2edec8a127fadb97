"""Functions behind the verbs of the command line; they take settings and return JSON data.

`life` holds the loop of all lives, `travel` what a building does to a robot. `live`, `perceive`, `reuse` and
`advise` are folders, `teach` and `doctor` files. `external_world` holds `live_in`, which lives in a user's own
world. `compile_kernels` compiles the kernels of the verbs before their first use.
"""
