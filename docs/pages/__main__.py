"""`python -m docs.pages docs`: generate pages from the code, and print the names of changed pages."""

from __future__ import annotations

import sys
from pathlib import Path

from . import renew

if __name__ == "__main__":
    for folder in sys.argv[1:] or ["docs"]:
        print(*renew(Path(folder)), sep="\n")
