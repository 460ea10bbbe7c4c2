"""curvcli as a process of its own, within bounds of memory and time."""

from __future__ import annotations

import os
from pathlib import Path
from tempfile import TemporaryFile

from tests.fuzz.contract import Ran
from tests.helpers.cli.program import address
from tests.helpers.cli.server import ask

SECONDS = 60


def real(words: list[str], memory: float | None = None) -> Ran:
    """Run curvcli; it has a minute, and the given bytes of memory (200 MB beside 20 times the file)."""
    with open(os.devnull, "rb") as nothing, TemporaryFile() as out, TemporaryFile() as err:
        streams = [stream.fileno() for stream in (nothing, out, err)]
        code, kilobytes, milliseconds = ask(address(), words, streams, SECONDS)
        for stream in (out, err):
            stream.seek(0)
        ran = Ran(code, out.read(), err.read().decode())
    assert milliseconds < 1000 * SECONDS
    allowed = 200 * 10**6 + 20 * Path(words[1]).stat().st_size if memory is None else memory
    assert kilobytes * 1024 < allowed, (kilobytes, allowed)
    return ran
