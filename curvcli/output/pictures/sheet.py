"""Sheet of a picture: texts, patches and images at exact positions, so that they are not cut off and do not overlap."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._version import __version__
from ...support.words import escape_text
from .options import PIXELS_PER_INCH, background_rgb
from .render import Color

Box = tuple[float, float, float, float]  # left, top, width, height in pixels, from the upper left corner

_FONT = "DejaVu Sans"
_SMALLEST_FONT, _LARGEST_FONT = 8.0, 26.0
LINE = 1.4  # line height over font size
# Settings of matplotlib belong to the process: one thread at a time changes and restores them.
_SETTINGS = Lock()
_TEXT_AS_TEXT = {"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "curvcli"}


@dataclass(frozen=True)
class LegendEntry:
    """Entry of a legend: a text, alone or behind a square or a line of a colour."""

    text: str
    mark: str = ""  # "", "square" or "line"
    color: Color | None = None


class Sheet:
    """Matplotlib figure of so many pixels, drawn on from the upper left corner."""

    def __init__(self, size: tuple[int, int], background: str, suffix: str = ".png") -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.width, self.height = size
        self.format = suffix.rpartition(".")[2]
        self.background = background_rgb(background)
        red, green, blue = self.background
        self.dark = 0.299 * red + 0.587 * green + 0.114 * blue < 0.5
        self.ink: Color = (0.93, 0.93, 0.93) if self.dark else (0.1, 0.1, 0.1)
        self.pale: Color = (0.7, 0.7, 0.7) if self.dark else (0.35, 0.35, 0.35)
        self.figure: Any = Figure(
            figsize=(self.width / PIXELS_PER_INCH, self.height / PIXELS_PER_INCH),
            dpi=PIXELS_PER_INCH,
            facecolor=self.background,
        )
        self.canvas: Any = FigureCanvasAgg(self.figure)

    def font(self, width: float, height: float) -> float:
        """Font size in pixels that suits a panel."""
        return min(max(min(width / 42, height / 32), _SMALLEST_FONT), _LARGEST_FONT)

    def text(
        self, x: float, y: float, text: str, size: float, *, color: Color | None = None, bold: bool = False
    ) -> None:
        """Draw one line of text whose middle is at height y."""
        self.figure.text(
            x / self.width,
            1 - y / self.height,
            escape_text(text),
            fontsize=size * 0.72,
            color=color or self.ink,
            family=_FONT,
            weight="bold" if bold else "normal",
            va="center_baseline",
            ha="left",
            parse_math=False,
        )

    def measure(self, text: str, size: float, bold: bool = False) -> float:
        """Width of a text in pixels."""
        from matplotlib.font_manager import FontProperties

        # Measured by the renderer: hinting makes small text wider than its outlines.
        font = FontProperties(family=_FONT, size=size * 0.72, weight="bold" if bold else "normal")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            width: float = self.canvas.get_renderer().get_text_width_height_descent(escape_text(text), font, False)[0]
        return width

    def rectangle(self, box: Box, color: Color) -> None:
        """Draw a filled rectangle."""
        from matplotlib.patches import Rectangle

        left, top, width, height = box
        corner = (left / self.width, 1 - (top + height) / self.height)
        self.figure.patches.append(
            Rectangle(
                corner, width / self.width, height / self.height, transform=self.figure.transFigure, facecolor=color
            )
        )

    def triangle(self, corners: NDArray[np.float64], color: Color) -> None:
        """Draw a filled polygon; corners (n, 2) in pixels."""
        from matplotlib.patches import Polygon

        at = corners / [self.width, self.height]
        at[:, 1] = 1 - at[:, 1]
        self.figure.patches.append(Polygon(at, transform=self.figure.transFigure, facecolor=color, linewidth=0))

    @property
    def vector(self) -> bool:
        """True for formats of pages, in which texts and lines have no pixels."""
        return self.format != "png"

    def image(self, pixels: NDArray[np.uint8], box: Box) -> None:
        """Draw an image: on a page in a box, with all of its pixels; in a PNG at its own size from the same corner."""
        left, top, _, _ = box
        if not self.vector:
            self.figure.figimage(pixels, left, self.height - top - pixels.shape[0], origin="upper")
            return
        axes = self.axes(box)
        axes.set_axis_off()
        axes.imshow(pixels, aspect="auto", interpolation="none")

    def axes(self, box: Box) -> Any:
        """Axes that fill a box."""
        left, top, width, height = box
        place = (
            left / self.width,
            1 - (top + height) / self.height,
            width / self.width,
            height / self.height,
        )
        return self.figure.add_axes(place)

    def content(self, title: str, description: str) -> bytes:
        """Sheet in its format; a character that no font has is drawn as a box, without a warning.

        Pages have no date and no random identifiers, so equal sheets are equal bytes. Their texts are texts: TrueType
        fonts in PDF, names of fonts in SVG.
        """
        from matplotlib import rc_context

        stream = io.BytesIO()
        title, description, program = escape_text(title), escape_text(description), f"curvcli {__version__}"
        metadata: dict[str, dict[str, Any]] = {
            "png": {"Title": title, "Description": description, "Software": program},
            "pdf": {"Title": title, "Subject": description, "Creator": program, "CreationDate": None},
            "svg": {"Title": title, "Description": description, "Creator": program, "Date": None},
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if self.vector:
                with _SETTINGS, rc_context(_TEXT_AS_TEXT):
                    self.figure.savefig(stream, format=self.format, metadata=metadata[self.format])
            else:
                self.canvas.print_png(stream, metadata=metadata["png"])
        return stream.getvalue()

    # ------------------------------------------------------------------ legends

    def flow(self, items: Iterable[LegendEntry], width: float, size: float) -> list[list[tuple[float, LegendEntry]]]:
        """Lay out entries in lines of at most this width, each with its position."""
        lines: list[list[tuple[float, LegendEntry]]] = [[]]
        at = 0.0
        for item in items:
            for part in self._parts(item, width, size):
                needed = self._needs(part, size)
                if at and at + needed > width:
                    lines.append([])
                    at = 0.0
                lines[-1].append((at, part))
                at += needed + 1.6 * size
        return [line for line in lines if line]

    def draw(self, lines: Iterable[list[tuple[float, LegendEntry]]], left: float, top: float, size: float) -> None:
        """Draw the lines of `flow`."""
        for row, line in enumerate(lines):
            middle = top + (row + 0.5) * LINE * size
            for at, item in line:
                x = left + at
                if item.mark and item.color is not None:
                    high = 0.8 * size if item.mark == "square" else max(2.0, 0.16 * size)
                    wide = 0.8 * size if item.mark == "square" else 1.6 * size
                    self.rectangle((x, middle - high / 2, wide, high), item.color)
                self.text(x + self._mark(item, size), middle, item.text, size, color=self.pale)

    def _mark(self, item: LegendEntry, size: float) -> float:
        return {"": 0.0, "square": 1.2, "line": 2.0}[item.mark] * size

    def _needs(self, item: LegendEntry, size: float) -> float:
        return self._mark(item, size) + self.measure(item.text, size)

    def _parts(self, item: LegendEntry, width: float, size: float) -> Iterator[LegendEntry]:
        """Entry, split between words, or within a word, where it is too long for a line."""
        text = item.text
        while text and self._needs(LegendEntry(text, item.mark), size) > width:
            less, more = 1, len(text)
            while less < more - 1:
                fits = (less + more) // 2
                if self._needs(LegendEntry(text[:fits], item.mark), size) <= width:
                    less = fits
                else:
                    more = fits
            space = text.rfind(" ", 1, less + 1)
            cut = space if space > 0 else less
            yield LegendEntry(text[:cut].rstrip(), item.mark, item.color)
            text, item = text[cut:].lstrip(), LegendEntry("", "", None)
        if text:
            yield LegendEntry(text, item.mark, item.color)
