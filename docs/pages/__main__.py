"""`python -m docs.pages docs`: make the pages again that follow from the code, and name those that changed."""

from __future__ import annotations

import sys
from pathlib import Path

from . import renew

if __name__ == "__main__":
    for folder in sys.argv[1:] or ["docs"]:
        print(*renew(Path(folder)), sep="\n")
