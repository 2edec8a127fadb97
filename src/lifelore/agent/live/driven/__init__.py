"""Jobs with known goals, which are driven to.

`drive_job` is the algorithm and `route` its planner. `driven_tasks` are the jobs of a life, and `robot_clock` says
when and where they start.
"""
