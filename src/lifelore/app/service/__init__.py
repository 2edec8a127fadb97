"""The HTTP service (extra `web`): one FastAPI application over one memory, to which pages can be mounted.

Read in this order: `settings`, `application` (the factory), `service_state`, `gate` (identifiers, tokens, limits,
metrics and log of every request), `tokens`, `limits`, `telemetry`, `error_documents`, `writer` (the thread that
stores), `worker_process` (reads uploads), `server`; then one file for each group of routes: `health_routes`,
`decision_routes`, `study_routes`, `user_routes`, `log_routes`, `adaptation_routes`, `perceive_routes`,
`advice_routes`, `memory_routes`.
"""
