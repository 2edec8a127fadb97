"""The page see as a person uses it: examples, objects by mouse and keyboard, own files, and without WebGL."""

import json
import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from playwright.sync_api import Browser, Locator, Page, Route, expect

from lifelore.agent.perceive.perceive import PerceiveSettings, perceive
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.segmentation.region import Region

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EXAMPLES = Path(__file__).parents[3] / "src" / "lifelore" / "app" / "pages" / "see" / "static" / "examples"
DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
TOWER = "3 objects, 3 relations, 7 contact points, 1 hole; 16,915 points; perceived in"
LOADED = 30_000
"""Milliseconds for the first scene: the process that perceives has to start."""

Opened = Callable[..., Page]


def shown(page: Page, text: str) -> None:
    expect(page.locator("#summary")).to_contain_text(text, timeout=LOADED)


def seen(part: Locator) -> np.ndarray:
    """Colours of a part of the page, (rows, columns, 3)."""
    return np.asarray(Image.open(BytesIO(part.screenshot())).convert("RGB"), int)


def pixels(page: Page, colour: tuple[int, int, int], apart: int = 24) -> int:
    """Number of pixels of the picture that are nearly of a colour."""
    return int((np.abs(seen(page.locator("#view canvas")) - colour).max(axis=2) < apart).sum())


def end_of_blue(part: Locator) -> float:
    """Share of the width of a part of the page at which its last blue pixel lies."""
    colours = seen(part)
    return np.flatnonzero((colours[..., 2] - colours[..., 0] > 100).any(axis=0)).max() / colours.shape[1]


def drop(page: Page, name: str, content: bytes) -> None:
    """Drop a file on the picture."""
    page.evaluate(
        """([name, bytes]) => {
            const carried = new DataTransfer();
            carried.items.add(new File([new Uint8Array(bytes)], name));
            const given = { dataTransfer: carried, bubbles: true, cancelable: true };
            const event = (kind) => new DragEvent(kind, given);
            document.querySelector("#view").dispatchEvent(event("dragover"));
            document.querySelector("#view").dispatchEvent(event("drop"));
        }""",
        [name, list(content)],
    )


def test_the_first_visit_shows_a_scene_and_its_objects_are_chosen_by_keyboard(
    address: str, open_page: Opened, check_page: Callable[..., None]
):
    page = open_page(address + "/see")
    shown(page, TOWER)
    blue, orange, green = (0, 114, 178), (230, 159, 0), (0, 122, 89)
    assert all(pixels(page, colour) > 500 for colour in (blue, orange, green))
    rows = page.locator("#relations tbody tr")
    expect(rows).to_have_count(3)
    expect(rows.nth(1)).to_contain_text("Object 4 is on object 3")
    page.locator("#objects button").first.focus()
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    chosen = page.get_by_role("button", name="Object 3")
    expect(chosen).to_have_attribute("aria-pressed", "true")
    expect(chosen).to_be_focused()
    details = page.locator("#details")
    expect(details).to_contain_text("object 2 (100 %)")  # rests on
    expect(details).to_contain_text("object 4 (100 %)")  # carries
    expect(details).to_contain_text("with object 4")
    expect(details).to_contain_text("opening")
    assert pixels(page, orange) > 500 > pixels(page, blue)  # the others fade
    check_page(page, "see", 1120)
    page.keyboard.press("Enter")
    expect(chosen).to_have_attribute("aria-pressed", "false")


def test_a_click_chooses_and_keys_turn_the_picture(address: str, open_page: Opened):
    page = open_page(address + "/see")
    shown(page, TOWER)
    canvas = page.locator("#view canvas")
    canvas.focus()
    before = canvas.screenshot()
    page.keyboard.press("ArrowRight")
    turned = canvas.screenshot()
    assert turned != before
    page.keyboard.press("0")
    assert canvas.screenshot() == before
    box = canvas.bounding_box()
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    expect(page.locator("#objects button[aria-pressed=true]")).to_have_count(1)
    for name in ("Points", "Contact points", "Contact networks", "Relations", "Holes"):
        box_before = canvas.screenshot()
        page.get_by_role("checkbox", name=name, exact=True).uncheck()
        assert canvas.screenshot() != box_before, name


def test_doubtful_relations_fall_below_the_least_confidence(address: str, open_page: Opened):
    page = open_page(address + "/see")
    shown(page, TOWER)
    page.select_option("#example", "crowded_table")
    shown(page, "6 objects, 7 relations")
    own = perceive(str(EXAMPLES / "crowded_table.pcd"))
    expected = [r["confidence"] for r in own["relations"] if r["relation"] != "none"]
    shares = page.eval_on_selector_all(
        "#relations .bar", "bars => bars.map(b => b.firstChild.offsetWidth / b.offsetWidth)"
    )
    assert shares == pytest.approx(expected, abs=0.02)
    track = page.locator("#least")
    assert end_of_blue(track) < 0.16  # a thumb is 16 of some 130 pixels wide
    track.focus()
    page.keyboard.press("End")
    expect(page.locator("#least-value")).to_have_text("100 %")
    assert end_of_blue(track) > 0.97
    for _ in range(10):
        page.keyboard.press("ArrowLeft")
    expect(page.locator("#least-value")).to_have_text("90 %")
    shown(page, "6 objects, 5 relations")
    doubtful = page.locator("#relations tr.doubtful")
    expect(doubtful).to_have_count(2)
    expect(doubtful.first).to_contain_text("Object 7 is on and beside object 3 (doubtful)")
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save the graph").click()
    assert "digraph" in Path(saved.value.path()).read_text()


def test_a_range_and_a_box_cut_the_cloud(address: str, open_page: Opened):
    page = open_page(address + "/see")
    shown(page, TOWER)
    page.select_option("#example", "crowded_table")
    shown(page, "6 objects")
    points = read_cloud(EXAMPLES / "crowded_table.pcd").points
    middle = float(np.median(points[:, 0]))
    box = f"-9,{middle},-9,9,-9,9"
    page.get_by_label("Only in the box").fill(box)
    page.get_by_label("Only in the box").press("Enter")
    settings = PerceiveSettings(region=Region(tuple(map(float, box.split(",")))))
    left = perceive(str(EXAMPLES / "crowded_table.pcd"), settings)
    assert len(left["objects"]) < 6
    shown(page, f"{len(left['objects'])} objects")
    page.get_by_label("Only in the box").fill("")
    page.get_by_label("Only in the box").press("Enter")
    shown(page, "6 objects")
    # Under z the labelled table of the crowded scene is refused: first the next cloud has to be shown.
    plain = perceive(str(EXAMPLES / "without_labels.pcd"))
    assert len(plain["objects"]) != 6
    page.select_option("#example", "without_labels")
    shown(page, f"{len(plain['objects'])} objects, ")
    page.select_option("#up", "vector")
    page.locator("#vector").fill("0,0,3")
    with page.expect_response(re.compile("up=0(,|%2C)0"), timeout=LOADED):
        page.locator("#vector").press("Enter")
    upright = perceive(str(EXAMPLES / "without_labels.pcd"), PerceiveSettings(up=(0, 0, 3)))
    shown(page, f"{len(upright['objects'])} objects, ")
    page.select_option("#up", "table")
    page.select_option("#example", "crowded_table")
    shown(page, "6 objects")
    page.get_by_label("Only within").fill("9")
    with page.expect_response(re.compile("max_range=9"), timeout=LOADED):
        page.get_by_label("Only within").press("Enter")
    expect(page.locator("#message")).to_be_hidden(timeout=LOADED)
    shown(page, "6 objects")


def test_of_two_examples_the_last_chosen_is_shown(address: str, open_page: Opened):
    page = open_page(address + "/see")
    shown(page, TOWER)
    held: list[Route] = []
    page.route("**/crowded_table.pcd", lambda route: held.append(route))
    page.select_option("#example", "crowded_table")
    page.select_option("#example", "without_labels")
    expect(page.locator("#warnings li")).to_have_count(1, timeout=LOADED)
    with page.expect_response("**/crowded_table.pcd"):
        held[0].continue_()
    page.wait_for_timeout(1000)
    expect(page.locator("#message")).to_be_hidden()
    expect(page.locator("#warnings li")).to_have_count(1)


def test_own_files_are_analysed_with_their_warnings(address: str, open_page: Opened, tmp_path: Path):
    page = open_page(address + "/see")
    shown(page, TOWER)
    own = perceive(str(EXAMPLES / "without_labels.pcd"))
    page.set_input_files("#file", EXAMPLES / "without_labels.pcd")
    shown(page, f"{len(own['objects'])} objects")
    expect(page.locator("#warnings li")).to_contain_text(own["warnings"][0]["message"])
    page.get_by_role("button", name="Object 2").click()
    expect(page.locator("#details")).to_contain_text("sure (cut automatically)")
    side = np.stack(np.meshgrid(np.arange(40), np.arange(40)), -1).reshape(-1, 2)
    table = np.column_stack([0.02 * side - 0.4, np.zeros(len(side)), np.ones(len(side))])
    block = np.column_stack([0.0025 * side, np.full(len(side), 0.1), np.full(len(side), 2)])
    walls = [np.column_stack([np.full(len(side), x), 0.0025 * side, np.full(len(side), 2)]) for x in (0.0, 0.1)]
    np.save(tmp_path / "block.npy", np.concatenate([table, block, *walls]))
    page.select_option("#up", "z")
    drop(page, "block.npy", (tmp_path / "block.npy").read_bytes())
    shown(page, "1 object, 1 relation")
    expect(page.locator("#warnings li")).to_have_count(0)
    drop(page, "notes.txt", b"words")
    message = page.locator("#message")
    expect(message).to_contain_text("notes.txt is no PCD, PLY, npz or npy file")
    expect(message).to_have_attribute("role", "alert")
    expect(page.locator("#objects button")).to_have_count(0)


def depth_image(folder: Path) -> dict[str, Path]:
    """Files of a table seen from above with two blocks that touch: depth, camera, colours and masks."""
    depth, masks = np.full((240, 320), 1000, np.uint16), np.zeros((240, 320), np.uint8)
    depth[80:160, 100:160], depth[80:160, 160:220] = 900, 860
    masks[80:160, 100:160], masks[80:160, 160:220] = 5, 9
    colours = np.full((240, 320, 3), 200, np.uint8)
    colours[80:160, 100:160] = (200, 30, 30)
    paths = {
        name: folder / name
        for name in ("depth.png", "camera.json", "camera.yaml", "colour.png", "masks.png", "depth.npy")
    }
    Image.fromarray(depth).save(paths["depth.png"])
    Image.fromarray(masks).save(paths["masks.png"])
    Image.fromarray(colours).save(paths["colour.png"])
    np.save(paths["depth.npy"], (depth / 1000).astype(np.float32))
    camera = {"fx": 260, "fy": 260, "cx": 159.5, "cy": 119.5, "width": 320, "height": 240}
    paths["camera.json"].write_text(json.dumps(camera))
    matrix = "camera_matrix: {rows: 3, cols: 3, data: [260, 0, 159.5, 0, 260, 119.5, 0, 0, 1]}"
    paths["camera.yaml"].write_text(f"image_width: 320\nimage_height: 240\n{matrix}\n")
    return paths


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_a_depth_image_is_analysed_with_its_camera_colours_and_masks(
    address: str, open_page: Opened, check_page: Callable[..., None], tmp_path: Path, size: dict[str, int]
):
    files = depth_image(tmp_path)
    page = open_page(address + "/see", size)
    shown(page, TOWER)
    page.set_input_files(
        "#file", [files["depth.png"], files["camera.json"], files["colour.png"], files["masks.png"]]
    )
    shown(page, "2 objects")
    expect(page.locator("#files")).to_have_text(
        "depth.png: depth; camera.json: camera; colour.png: colours; masks.png: masks of the objects."
    )
    expect(page.locator("#relations")).to_contain_text("Object 6 is on the table")
    expect(page.locator("#units")).to_be_hidden()
    expect(page.get_by_label("Unit of depth")).to_be_visible()
    before = pixels(page, (200, 30, 30), 60)
    page.select_option("#colours", "camera")
    assert pixels(page, (200, 30, 30), 60) > before + 500
    check_page(page)
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save the graph").click()
    assert "digraph" in Path(saved.value.path()).read_text()
    # A cloud is a source of its own again.
    page.select_option("#example", "crowded_table")
    shown(page, "6 objects")
    expect(page.locator("#files")).to_have_text("")
    expect(page.locator("#units")).to_be_visible()


def test_the_parts_of_a_depth_image_are_dropped_one_by_one(address: str, open_page: Opened, tmp_path: Path):
    files = depth_image(tmp_path)
    page = open_page(address + "/see")
    shown(page, TOWER)
    message = page.locator("#message")

    def dropped(name: str) -> None:
        drop(page, name, files[name].read_bytes())

    dropped("camera.yaml")
    expect(message).to_contain_text("camera.yaml belongs to a depth image: choose or drop the image too")
    shown(page, TOWER)  # the earlier scene stays
    dropped("depth.npy")
    shown(page, "2 objects")
    expect(page.locator("#warnings")).to_contain_text("2 objects were cut automatically")
    dropped("masks.png")
    expect(page.locator("#relations")).to_contain_text("Object 10 is on the table", timeout=LOADED)
    expect(page.locator("#warnings")).not_to_contain_text("cut automatically")
    expect(page.locator("#files")).to_have_text(
        "camera.yaml: camera; depth.npy: depth; masks.png: masks of the objects."
    )
    dropped("depth.png")  # the next picture of the same camera
    expect(page.locator("#files")).to_have_text("camera.yaml: camera; depth.png: depth.")
    expect(page.locator("#warnings")).to_contain_text("2 objects were cut automatically", timeout=LOADED)
    page.select_option("#example", "tower")
    shown(page, TOWER)
    dropped("depth.png")
    expect(message).to_contain_text("depth.png is a depth image: choose or drop the file of its camera too")
    drop(page, "second.png", files["depth.png"].read_bytes())
    expect(message).to_contain_text("second.png is a depth image")


def test_a_damaged_file_is_one_line_and_clears_the_scene(address: str, browser: Browser):
    # Not by `open_page`: the browser itself logs each answer that is an error.
    with browser.new_context(viewport=DESKTOP) as context:  # pyright: ignore[reportArgumentType]
        page = context.new_page()
        page.goto(address + "/see")
        shown(page, TOWER)
        drop(page, "broken.pcd", b"no cloud")
        message = page.locator("#message")
        expect(message).to_have_class("message error")
        expect(message).to_contain_text("broken.pcd: PCD header has no DATA line")
        expect(message).not_to_contain_text("tmp")
        expect(page.locator("#example")).to_have_value("")
        for cleared in ("#objects", "#relations", "#details", "#warnings"):
            expect(page.locator(cleared)).to_have_text("")
        shown(page, "No scene")
        assert pixels(page, (230, 159, 0)) == 0
        expect(page.get_by_role("button", name="Save the graph")).to_be_disabled()
        page.select_option("#example", "tower")
        shown(page, TOWER)
        expect(page.get_by_role("button", name="Save the graph")).to_be_enabled()
        # A range that holds no point fails too, and the message names a field of the page.
        page.get_by_label("Only within").fill("0.01")
        page.get_by_label("Only within").press("Enter")
        expect(message).to_contain_text("the region (roi, max_range) holds no point")
        expect(page.locator("#objects button")).to_have_count(0)
        page.get_by_label("Only within").fill("")
        page.select_option("#up", "vector")
        page.locator("#vector").fill("up")
        page.locator("#vector").press("Enter")
        expect(message).to_contain_text("tower.pcd: up must be", timeout=LOADED)


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_without_webgl_the_picture_is_flat_and_does_the_same(
    address: str, open_page: Opened, size: dict[str, int]
):
    page = open_page(address + "/", size)
    page.add_init_script(
        """const given = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
            return kind.startsWith("webgl") ? null : given.call(this, kind, ...rest);
        };"""
    )
    page.goto(page.url + "see")
    shown(page, TOWER)
    expect(page.locator("#help")).to_contain_text("This browser has no WebGL, so the picture is flat.")
    assert pixels(page, (230, 159, 0)) > 300
    canvas = page.locator("#view canvas")
    canvas.focus()
    before = canvas.screenshot()
    page.keyboard.press("ArrowLeft")
    assert canvas.screenshot() != before
    box = canvas.bounding_box()
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    expect(page.locator("#objects button[aria-pressed=true]")).to_have_count(1)


def test_the_examples_are_what_their_script_makes(tmp_path: Path):
    pytest.importorskip("mujoco")
    from importlib.util import module_from_spec, spec_from_file_location

    found = spec_from_file_location("see_examples", Path(__file__).with_name("see_examples.py"))
    script = module_from_spec(found)
    found.loader.exec_module(script)
    script.make_examples(tmp_path)
    assert {path.name for path in EXAMPLES.glob("*.pcd")} == {path.name for path in tmp_path.iterdir()}
    for path in tmp_path.iterdir():
        made, shipped = read_cloud(path), read_cloud(EXAMPLES / path.name)
        np.testing.assert_allclose(made.points, shipped.points, atol=1e-4)
        np.testing.assert_array_equal(made.labels, shipped.labels)
