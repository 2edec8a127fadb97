"""Signal models: P(signal | type, policy), the observation model of the thesis (§4.4).

Read in this order: `return_signal`, `category_signal`, `reward_signal`, `transition_signal`, `step_reward_signal`,
`joint_signal`, `likelihood_signal`.
"""
