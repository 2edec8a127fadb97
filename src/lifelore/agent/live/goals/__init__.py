"""Goals that the user chooses: `destinations` with names, `job_list` from a file, `own_places` of a life; and
`goal_counts`, where goals were found before."""
