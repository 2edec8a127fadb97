"""Separation: the maximum-margin separator of two clouds with a Gaussian kernel (thesis §2.3.4).

Read in this order: `separator` (the problem and its solution), `gaussian`, `separator_descent`,
`separator_dual`, `separator_smo`, `far_field`.
"""
