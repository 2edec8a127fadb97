"""Contacts: near objects, contact points and contact point networks (thesis §2.3.3, §2.3.4).

Read in this order: `near_pairs`, `interface`, `contact_points`, `contact_network`, `contact_settings`,
`pair_networks`; `object_shape` gives foot, top and outline of one object.
"""
