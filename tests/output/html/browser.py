"""A real browser without a network: chromium, headless, with its software renderer."""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]


@contextmanager
def browser() -> Iterator[Any]:
    """Chromium, or a skipped test that says what is missing."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        pytest.skip("playwright is not installed: `pip install '.[test]'`")
    with sync_playwright() as playwright:
        own = playwright.chromium.executable_path  # what `playwright install chromium` brings
        program = next(filter(None, map(shutil.which, (*NAMES, own))), None)
        if program is None:
            pytest.skip(f"no browser is installed: `playwright install chromium`; looked for {', '.join(NAMES)} too")
        launched = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield launched
        launched.close()


class Tab:
    """A page that is open and ready, and all it complained of or asked for."""

    def __init__(self, browser: Any, path: Path, before: str = "", **settings: Any) -> None:
        settings = {"viewport": {"width": 1200, "height": 900}, **settings}
        self.context = browser.new_context(offline=True, **settings)
        self.context.add_init_script(before)
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.page.on("console", self._said)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("dialog", lambda dialog: self.complaints.append(dialog.message))
        self.page.on("request", lambda request: self._asked(request.url))
        self.page.goto(path.as_uri())
        self.page.wait_for_selector("html[data-state=ready]")

    def _said(self, message: Any) -> None:
        # What the driver says of its own speed when a picture is read back is no word of the page.
        if "GL Driver Message" not in message.text:
            self.complaints.append(message.text)

    def _asked(self, url: str) -> None:
        if not url.startswith(("file:", "data:", "blob:")):
            self.complaints.append(url)

    def choose(self, vertex: int) -> None:
        """Type the number of a vertex."""
        self.page.fill("#vertex", str(vertex))
        self.page.press("#vertex", "Enter")

    def wait_for_vertex(self, vertex: int) -> None:
        self.page.wait_for_selector(f"html[data-vertex='{vertex}']")

    def values(self) -> dict[str, str]:
        """The table of values as it is shown."""
        rows = self.page.locator("#values tbody tr").all()
        return {row.locator("th").inner_text(): row.locator("td").first.inner_text() for row in rows}

    def picture(self) -> NDArray[np.uint8]:
        """Pixels of the canvas, (height, width, 4)."""
        import base64

        from matplotlib.image import imread

        self.page.evaluate("new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
        url = self.page.evaluate("document.getElementById('view').toDataURL('image/png')")
        pixels = imread(io.BytesIO(base64.b64decode(url.split(",")[1])))
        return np.rint(pixels * 255).astype(np.uint8)
