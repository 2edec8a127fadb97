"""The study of §4.8.5 on a page: people play the ball game, and the system adapts its speed (BEAT).

    python -m examples.pages.play.serve --out rounds.jsonl
    lifelore reproduce C4.14 --full --set people=rounds.jsonl

One person plays at a time. The file gets a line when a person agrees to take part, and a line for each round, see
`reproduction.chapter4.c4_14_people.records`; the second command draws Figures 4.18-4.20 from it.
"""

import argparse
from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.routing import Route

from examples.pages.server import document_of, page_app, serve
from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.domains.ball_game.layouts import SIDE
from reproduction.chapter4.c4_14_people.records import new_session, store_round
from reproduction.chapter4.c4_14_people.scripted_player import scripted_others
from reproduction.chapter4.c4_14_people.study_plan import PLAYERS, StudySettings
from reproduction.chapter4.c4_14_people.study_session import StudySession

LENGTHS = {
    "short": {"sizes": (2, 20, 60), "speeds": (30, 50, 70), "practice": 1, "test": 1},
    "medium": {"sizes": SIZES, "speeds": (30, 50, 70), "test": 2},
    "thesis": {"sizes": SIZES, "speeds": SPEEDS},
}
"""Settings by length: 16, 44 and 92 rounds, each of 8 to 20 seconds at the usual pace."""
CONSENT = (
    "You play a ball game for some minutes. This machine stores your moves, the results of your rounds, the "
    "settings and the time of the session under a random identifier. It does not store your name. You may stop at "
    "any time. Note the identifier: with it the experimenter can give you your record, or delete it. This text "
    "informs you. It is not the approval of an ethics committee, which a study with people needs before it begins."
)


def study_app(out: str, settings: StudySettings, seed: int = 0) -> Starlette:
    """The page of the study, whose sessions have the settings and are written to the file `out`."""
    layout = settings.game.layout
    scripted_others(settings.layout)  # it takes a second, which no player shall wait
    session: StudySession | None = None

    def present() -> StudySession:
        if session is None:
            raise InputError("nobody takes part yet; agree to the text first")
        return session

    async def game(request: Request) -> JSONResponse:
        field = {"side": SIDE, "polygons": layout.polygons, "start": layout.start, "goal": layout.goal}
        view = None if session is None else session.view()
        return JSONResponse(field | {"consent": CONSENT, "rounds": settings.rounds, "session": view})

    async def take_part(request: Request) -> JSONResponse:
        nonlocal session
        if (await document_of(request)).get("consent") is not True:
            raise InputError("consent must be given before anything is recorded; agree to the text")
        session = new_session(out, settings, CONSENT, seed)
        return JSONResponse(session.view())

    async def begin(request: Request) -> JSONResponse:
        await document_of(request)
        return JSONResponse(present().begin())

    async def move(request: Request) -> JSONResponse:
        heading = (await document_of(request)).get("heading")
        ball = present().move(heading)  # pyright: ignore[reportArgumentType]
        if ball["over"]:
            row = present().finish()
            store_round(out, present(), row)
            ball |= {"reached": row["reached"], "loss": row["loss"], "session": present().view()}
        return JSONResponse(ball)

    asked = [Route(f"/{one.__name__}", one, methods=["POST"]) for one in (take_part, begin, move)]
    return page_app(Path(__file__).parent, [Route("/game", game), *asked])


def main() -> None:
    """Serve the page."""
    read = argparse.ArgumentParser(description="People play the ball game, and BEAT adapts its speed (§4.8.5).")
    read.add_argument("--out", default="rounds.jsonl", help="file to which sessions and rounds are appended")
    read.add_argument("--length", choices=LENGTHS, default="thesis", help="16, 44 or 92 rounds")
    read.add_argument("--frames", type=int, default=5, help="frames of 1/30 s that a move takes")
    read.add_argument("--player", choices=PLAYERS, default="person", help="who plays: results are shown apart")
    read.add_argument("--seed", type=int, default=0, help="draws all random numbers")
    read.add_argument("--port", type=int, default=8322)
    given = read.parse_args()
    settings = StudySettings(given.player, frames_per_move=given.frames, **LENGTHS[given.length])
    serve(study_app(given.out, settings, given.seed), given.port)


if __name__ == "__main__":
    main()
