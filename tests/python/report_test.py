"""The report in a real browser, opened from disk."""

import io
import shutil
import subprocess
import time

import numpy as np
import pytest
from conftest import ARTEFACTS, PROGRAM
from PIL import Image
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from pirouette.report import write

PATIENCE = 60  # s; the machine may be busy


@pytest.fixture(scope="module")
def page(browser, spin_folder, tmp_path_factory):
    """The report of a spin, loaded; and its file."""
    out = write([spin_folder], tmp_path_factory.mktemp("report") / "report.html")
    browser.requests(), browser.errors()  # forget what came before
    browser.driver.get(out.as_uri())
    WebDriverWait(browser.driver, PATIENCE).until(
        lambda d: d.execute_script(
            "return [...document.querySelectorAll('.plot')].every(p => p.querySelector('svg'))"
        )
    )
    return browser, out


@pytest.fixture
def replay(page):
    """The replay, paused: the driver looks into its frame."""
    driver = page[0].driver
    # Few pixels: the software renderer takes most of the time.
    small = {"width": 720, "height": 500, "deviceScaleFactor": 0.5, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", small)
    frame = driver.find_element(By.TAG_NAME, "iframe")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", frame)
    driver.switch_to.frame(frame)
    WebDriverWait(driver, PATIENCE).until(lambda d: d.find_elements(By.TAG_NAME, "canvas"))
    WebDriverWait(driver, PATIENCE).until(lambda d: d.find_elements(By.TAG_NAME, "input"))
    toggle(driver, play=False)
    yield driver
    driver.switch_to.default_content()
    driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def toggle(driver, play: bool) -> None:
    """Clicks the button until the replay plays, or does not."""

    def done(_) -> bool:
        if playing(driver) != play:
            driver.execute_script(
                "document.querySelector('button:has([class*=tabler-icon-player])')?.click()"
            )
            time.sleep(0.2)
        return playing(driver) == play

    WebDriverWait(driver, PATIENCE).until(done)


def playing(driver) -> bool:
    return bool(driver.find_elements(By.CSS_SELECTOR, ".tabler-icon-player-pause-filled"))


def shown_time(driver) -> float:
    return float(driver.find_element(By.TAG_NAME, "input").get_attribute("value"))


def picture(driver) -> np.ndarray:
    """Pixels of the canvas once it stands still."""
    canvas = driver.find_element(By.TAG_NAME, "canvas")
    before, end = None, time.monotonic() + PATIENCE
    while time.monotonic() < end:
        image = np.asarray(Image.open(io.BytesIO(canvas.screenshot_as_png)).convert("RGB"), int)
        if before is not None and np.array_equal(image, before):
            return image
        before = image
        time.sleep(0.3)
    raise TimeoutError("the canvas does not come to rest")


def test_the_report_loads_without_error_or_network(page):
    browser, out = page
    browser.driver.save_screenshot(str(artefact("report.png")))
    assert browser.errors() == []
    assert browser.requests() == []
    assert out.stat().st_size < 15e6


def test_a_dark_page_has_light_text_and_brighter_curves(page):
    driver = page[0].driver
    look = """
    const plot = document.querySelector(".plot");
    return [getComputedStyle(document.body).backgroundColor, plot.data[0].line.color,
            plot.layout.template.layout.font.color];
    """
    light = driver.execute_script(look)
    prefer(driver, "dark")
    WebDriverWait(driver, PATIENCE).until(lambda d: d.execute_script(look)[2] != light[2])
    dark = driver.execute_script(look)
    driver.save_screenshot(str(artefact("report_dark.png")))
    prefer(driver, "light")
    WebDriverWait(driver, PATIENCE).until(lambda d: d.execute_script(look) == light)
    assert all(a != b for a, b in zip(light, dark, strict=True))


def prefer(driver, scheme: str) -> None:
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})


def test_every_figure_has_curves(page):
    driver = page[0].driver
    curves = driver.execute_script(
        "return [...document.querySelectorAll('.plot')].map("
        "p => p.querySelectorAll('path.js-line, .points path, path.point').length)"
    )
    assert len(curves) >= 6
    assert min(curves) >= 1


def test_no_button_uploads_a_figure(page):
    titles = page[0].driver.execute_script(
        "return [...document.querySelectorAll('.modebar-btn')].map(b => b.dataset.title)"
    )
    assert "Zoom" in titles
    assert not any("share" in title.lower() for title in titles)


def test_the_table_shows_the_papers_figures(page):
    text = page[0].driver.find_element(By.TAG_NAME, "table").text
    assert all(figure in text for figure in ("27.9", "11.2", "38.4"))


def test_play_moves_the_robot(replay):
    still = picture(replay)
    assert still.std() > 10, "the canvas is blank"
    started = shown_time(replay)
    toggle(replay, play=True)
    time.sleep(1.5)
    toggle(replay, play=False)
    assert shown_time(replay) != started
    moved = picture(replay)
    assert (np.abs(moved - still).max(axis=2) > 40).mean() > 0.003, "nothing moved"
    replay.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    time.sleep(1.0)
    replay.save_screenshot(str(artefact("replay.png")))


def test_scrubbing_returns_to_the_same_picture(replay):
    pictures = []
    for text in ("1.0", "2.0", "1.0"):
        field = replay.find_element(By.TAG_NAME, "input")
        replay.execute_script("arguments[0].select()", field)
        field.send_keys(text)
        time.sleep(0.5)
        pictures.append(picture(replay))
    elsewhere, again = (
        (np.abs(later - pictures[0]).max(axis=2) > 40).mean() for later in pictures[1:]
    )
    assert elsewhere > 0.003
    # Not the same to the pixel: a slow machine is shown edges in a lower resolution.
    assert again < 0.15 * elsewhere


def test_runs_stand_side_by_side(simulate, spin_folder, tmp_path):
    turn = simulate("turn on stairs", "turn", "--radius", "0.2", "--terrain", "stairs:0.03x0.20")
    picture = tmp_path / "two.png"
    text = write([spin_folder, turn], tmp_path / "two.html", picture).read_text()
    assert "Where the runs differ" in text
    assert "turns at 0.7 rad/s on flat, controller pirouette" in text
    assert "walked on stairs:0.03x0.20" in text
    assert picture.stat().st_size < 3e5
    robot = np.asarray(Image.open(picture).convert("L"), int)[:, :500]
    assert robot.std() > 20, "the robot is not there"
    shutil.copy(picture, artefact("picture.png"))
    assert "<th scope=row>plant.terrain</th><td>flat</td><td>stairs:0.03x0.2" in text


def artefact(name: str):
    ARTEFACTS.mkdir(parents=True, exist_ok=True)
    return ARTEFACTS / name


def test_a_fall_can_be_reported_and_exported(call, tmp_path):
    folder = tmp_path / "fell"
    fault = ["--set", "plant.faults.motor_strength=0", "--set", "plant.faults.start=3"]
    fell = subprocess.run(
        [PROGRAM, "spin", "--turns", "1", "--quiet", "--out", folder, *fault], capture_output=True
    )
    assert fell.returncode == 1
    for module, *options in (("report",), ("export", "--csv")):
        result = call(module, folder, *options)
        assert result.returncode == 0, result.stderr
    # Files of its own, which --force may replace.
    listed = (folder / "files.txt").read_text().splitlines()
    assert {"report.html", "trace.csv"} <= set(listed)
