"""Registration: how several views of one tabletop lie to each other, without known poses.

Both views show the table, which gives the vertical and the height; a turn and two shifts are left. Read in this
order: `tabletop_view`, `height_map`, `start_search`, `refinement`, `agreement`, `registered_pair`,
`registered_views`.
"""
