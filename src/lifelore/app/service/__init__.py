"""The HTTP service (extra `web`): one FastAPI application over one memory, to which pages can be mounted.

Read in this order: `settings`, `application` (the factory), `gate` (identifiers, tokens, limits, metrics and log
of every request), `tokens`, `limits`, `telemetry`, `error_documents`, `server`; then one file for each group of
routes: `health_routes`, `study_routes`, `user_routes`.
"""
