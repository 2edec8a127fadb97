"""Relations: learn and predict on(a, b), adjacent(a, b) and a user's own relations (thesis §2.3.5).

Read in this order: `relation`, `words`, `estimator`, `relation_classifier`, `displacement` and
`displacement_relations` (the thesis's own method), `label_relations`, `relation_model_file`.
"""
