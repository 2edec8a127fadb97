"""The advisor of §3.7 on a page: find a place in a building that you do not know, with and without advice.

python -m examples.pages.walk.serve building:0
python -m examples.pages.walk.serve examples/data/office.yaml
"""

import argparse
from pathlib import Path

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.routing import Route

from examples.pages.server import document_of, page_app, serve
from examples.pages.walk.building import Building, Walk


def walk_app(building: Building, seed: int = 0) -> Starlette:
    """The page of the walks of one person in a building."""
    walk, begun = Walk(building, True, seed), 0

    async def view(request: Request) -> JSONResponse:
        return JSONResponse(walk.view())

    async def begin(request: Request) -> JSONResponse:
        nonlocal walk, begun
        begun += 1
        advice = (await document_of(request)).get("advice") is not False
        walk = await run_in_threadpool(Walk, building, advice, seed + begun)
        return JSONResponse(walk.view())

    async def step(request: Request) -> JSONResponse:
        walk.step((await document_of(request)).get("move", ""))
        return JSONResponse(walk.view())

    posted = [Route(f"/{one.__name__}", one, methods=["POST"]) for one in (begin, step)]
    return page_app(Path(__file__).parent, [Route("/walk", view), *posted])


def main() -> None:
    """Serve the page."""
    read = argparse.ArgumentParser(description="Find a place in a building, with and without advice (§3.7).")
    read.add_argument("world", nargs="?", default="building:0", help="a ROS map, building:SEED, or advice:3")
    read.add_argument("--seed", type=int, default=0, help="draws the errands")
    read.add_argument("--port", type=int, default=8324)
    given = read.parse_args()
    serve(walk_app(Building(given.world), given.seed), given.port)


if __name__ == "__main__":
    main()
