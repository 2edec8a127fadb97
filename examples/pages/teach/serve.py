"""The factory of §3.4 on a page: a person demonstrates assembly, and learners use the prior (Figure 3.16).

    python -m examples.pages.teach.serve --out demonstrations.jsonl

The file gets the steps of each task that was finished, see `lifelore.action.demonstrations.demonstrations`.
"""

import argparse
from pathlib import Path

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.routing import Route

from examples.pages.server import document_of, page_app, serve
from examples.pages.teach.lesson import Lesson
from lifelore.action.demonstrations.demonstrations import write_demonstrations


def lesson_app(out: str, components: int, seed: int) -> Starlette:
    """The page of one lesson, whose demonstrations are appended to the file `out`."""
    lesson = Lesson(components, seed)

    async def view(request: Request) -> JSONResponse:
        return JSONResponse(lesson.view())

    async def step(request: Request) -> JSONResponse:
        lesson.act((await document_of(request)).get("action"))  # pyright: ignore[reportArgumentType]
        if lesson.over:
            fingerprint = lesson.present.task.factory.fingerprint[:8]
            done = lesson.shown[-1]._replace(task=f"modified factory {fingerprint}/{lesson.number}")
            write_demonstrations(out, [done], append=True)
        return JSONResponse(lesson.view())

    async def go_on(request: Request) -> JSONResponse:
        await document_of(request)
        lesson.go_on()
        return JSONResponse(lesson.view())

    async def curves(request: Request) -> JSONResponse:
        return JSONResponse(await run_in_threadpool(lesson.curves))

    posted = [Route(f"/{one.__name__}", one, methods=["POST"]) for one in (step, go_on)]
    return page_app(Path(__file__).parent, [Route("/lesson", view), Route("/curves", curves), *posted])


def main() -> None:
    """Serve the page."""
    read = argparse.ArgumentParser(description="Demonstrate assembly, and watch learners use your prior (§3.4.8).")
    read.add_argument("--out", default="demonstrations.jsonl", help="file to which demonstrations are appended")
    read.add_argument("--components", type=int, choices=range(1, 5), default=2, help="components of a task")
    read.add_argument("--seed", type=int, default=0, help="draws the factories")
    read.add_argument("--port", type=int, default=8323)
    given = read.parse_args()
    serve(lesson_app(given.out, given.components, given.seed), given.port)


if __name__ == "__main__":
    main()
