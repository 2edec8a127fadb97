"""Jobs with known goals, which are driven to.

`drive_job` is the algorithm and `route` its planner. `driven_life` is a life of such jobs, and `robot_clock` says
when and where they start.
"""
