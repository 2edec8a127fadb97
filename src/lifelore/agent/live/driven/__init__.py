"""Jobs with known goals, which are driven to.

`drive_job` is the algorithm, `route` its planner, and `driven_job` its result. `driven_tasks` are the jobs of a
life, `robot_clock` says when and where they start, and `drive_summary` sums them up.
"""
