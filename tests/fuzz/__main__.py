"""The longer tier: `python -m tests.fuzz --minutes 60` draws cases at random until the time is up.

Each new way to break the contract is shrunk and stored in the corpus, which the tests replay. Exits with 1 if any was
found.
"""

from __future__ import annotations

import argparse
import re
import secrets
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from itertools import count
from pathlib import Path
from zlib import crc32

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis.errors import HypothesisException, HypothesisWarning
from hypothesis.strategies import SearchStrategy

from tests.fuzz.cases import Case, ends, mutated, noise, sound
from tests.fuzz.contract import kept
from tests.fuzz.corpus import FOLDER, store

CASES_A_ROUND = 250
SLOW = 20.0  # seconds of work for a file of a few kilobytes, whatever else the machine does
LARGEST = 20_000  # bytes of a stored case


class Broken(Exception):  # noqa: N818 - a finding of the search, not a failure of it
    """The contract is broken in the way that the text identifies."""


def way(error: BaseException) -> str:
    """Identity of a finding: the place of an internal error, or of the assertion with its text without numbers."""
    place = re.search(r"internal error: .*\([\w.]+:\d+\)", str(error))
    if place:
        return place[0]
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} {frame.name}:{frame.lineno} " + re.sub(r"[\d.e+-]+|/\S+", "…", str(error))[:80]


class Search:
    """Rounds of random cases; `ran` counts how they ended, `found` holds the smallest case of each way to fail."""

    def __init__(self, folder: Path, corpus: Path, minutes: float) -> None:
        self.folder, self.corpus, self.end = folder, corpus, time.monotonic() + 60 * minutes
        self.ran: Counter[str] = Counter()
        self.found: dict[str, Case] = {}
        self.shrinking = ""

    def one(self, case: Case) -> None:
        """Run a case; Broken if it shows something new."""
        if time.monotonic() > self.end and not self.shrinking:
            return
        begin = time.process_time()
        try:
            self.ran[kept(case, self.folder / "work")] += 1
            if time.process_time() - begin > SLOW:
                raise AssertionError("slow")
        except Exception as error:
            name = way(error)
            self.ran["broken"] += 1
            if name in self.found and name != self.shrinking:
                return
            self.shrinking, self.found[name] = name, case
            raise Broken(name) from error

    def round(self, cases: SearchStrategy[Case], number: int) -> None:
        """Draw one round of cases; stops at the first new finding, shrunk."""
        self.shrinking = ""
        search = settings(
            max_examples=CASES_A_ROUND,
            database=None,
            deadline=None,
            derandomize=False,
            report_multiple_bugs=False,
            phases=(Phase.generate, Phase.shrink),
            suppress_health_check=list(HealthCheck),
        )
        try:
            seed(number)(search(given(cases)(self.one)))()
        except (Broken, HypothesisException):
            print(f"found: {self.shrinking}, in {len(self.found[self.shrinking].data)} bytes", flush=True)
            self.keep()

    def keep(self) -> None:
        """Store what was found, as small as it has become."""
        self.corpus.mkdir(exist_ok=True)
        for name, case in self.found.items():
            slug = re.sub(r"\W+", "-", name).strip("-").lower()[-40:]
            if len(case.data) <= LARGEST:
                store(case, self.corpus / f"{slug}-{crc32(name.encode()):08x}.case")


def main() -> int:
    """Search for as long as asked; 1 if something was found."""
    options = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    options.add_argument("--minutes", type=float, default=60.0)
    options.add_argument("--seed", type=int, default=secrets.randbelow(2**32))
    options.add_argument("--corpus", type=Path, default=FOLDER, help="where findings are stored")
    chosen = options.parse_args()
    warnings.simplefilter("error")
    # A long case makes it complain of its own report, which would hide the finding.
    warnings.simplefilter("ignore", HypothesisWarning)
    kinds = {kind: mutated(kind) for kind in ("obj", "ply", "stl", "strips")} | {
        "sound": sound(),
        "noise": noise(),
        "ends": ends(),
    }
    print(f"seed {chosen.seed}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        search = Search(Path(folder), chosen.corpus, chosen.minutes)
        for number in count(chosen.seed):
            for cases in kinds.values():
                if time.monotonic() > search.end:
                    break
                search.round(cases, number)
            else:
                print(f"{search.ran.total()} cases: {dict(search.ran)}", flush=True)
                continue
            break
    print(f"{search.ran.total()} cases ran, {dict(search.ran)}; {len(search.found)} ways to break the contract")
    for name in search.found:
        print(f"  {name}")
    return 1 if search.found else 0


if __name__ == "__main__":
    sys.exit(main())
