"""Sign of VTK XML files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..pieces import Pieces

_SIGN = re.compile(rb"<VTKFile\b[^<>]*?\btype\s*=\s*[\"'](\w+)[\"']")


def dataset_type(pieces: Pieces) -> str:
    """The type of the data set of a VTK XML file; empty for any other content."""
    start = pieces.ahead()
    if not start[:100].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return ""
    match = _SIGN.search(start)
    return match[1].decode("ascii", "replace") if match else ""
