"""The HTTP service (extra `web`): one FastAPI application over one memory, to which pages can be mounted.

Read in this order: `settings`, `application` (the factory), `service_state`, `gate` (identifiers, limits, metrics
and log of every request), `admission` (who may ask what), `tokens`, `bodies`, `telemetry`,
`error_documents`, `documentation`, `writer` (the thread that stores), `worker_process` (long work and uploads),
`server`; then one file for each group of routes: `decision_routes`, `study_routes`,
`log_routes`, `health_routes`, `adaptation_routes`, `perceive_routes`, `memory_routes`.
"""
