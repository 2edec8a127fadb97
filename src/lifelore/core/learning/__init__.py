"""Learning: Q-learning and model-based kernels, learning curves and transfer measures.

Read in this order: `q_learning`, `q_learner`, `model_learning`, `known_world`, `known_value`, `search_plan`;
`curve`, `learning_metrics` and `transfer` for results.
"""
