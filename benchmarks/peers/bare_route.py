"""A FastAPI application with a single route that returns a constant: the limit of any service over HTTP."""

import sys
from typing import Any


def main() -> None:
    """Serve at the port of the command line until the process is killed."""
    import uvicorn
    from fastapi import FastAPI

    app = FastAPI()

    @app.post("/bare")
    async def bare() -> dict[str, Any]:
        return {"policy": "slow", "probability": 1.0}

    uvicorn.run(app, host="127.0.0.1", port=int(sys.argv[1]), log_level="critical", access_log=False)


if __name__ == "__main__":
    main()
