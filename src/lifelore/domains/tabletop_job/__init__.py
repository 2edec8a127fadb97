"""The tabletop job: a gripper brings an object from a tray of settled objects without spilling the others.

Read in this order: `job_types` (users and grippers), `gripper_tray` (MuJoCo), `skills` (pick, put aside, push
apart, hand over), `events` (spills and knocks), `tray` (draw trays and targets), `job` (the world), `best_return`.
"""
