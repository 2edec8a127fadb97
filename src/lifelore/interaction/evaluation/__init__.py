"""Off-policy evaluation: the value of other policies, estimated from logged decisions with their probabilities.

Read in this order: `clustered_estimate`, `importance_weights`, `estimators`, `reward_models`. All functions take
plain arrays with one row a decision.
"""
