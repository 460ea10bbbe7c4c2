"""The lines between a batch and its workers: they arrive as they were sent, and nothing else is taken for one."""

from __future__ import annotations

import io
import math
import pickle
from typing import Any

import msgspec
import pytest

from curvcli.batch.messages import NO_MESSAGE, Done, Ready, Task, receive, send
from curvcli.batch.model import BatchItem, BatchSettings, Limits, Row

MESSAGES = [
    Limits(),
    Limits(1.5, 1 << 40),
    Ready("1.2.3"),
    Task(
        BatchItem("a", "/a\udcff\nb.obj", (("", "/out/\udcfe.csv"), ("edges", "/e.csv")), bytes(range(256))),
        BatchSettings(
            passes=("K", "h"), save=("csv",), options={"weld": 1e-3, "unit": "µm", "regions": "groups"}, max_faces=7
        ),
    ),
    Task(BatchItem("memory://x", "memory://x"), BatchSettings(passes=(), options={"weld": "exact"})),
    Done(Row(path="x", status="timeout", exit_code=3, error="late", seconds=0.1), True),
    Done(Row(path="x", totals={"K": 4 * math.pi, "H_vec": [5e-324, -0.0, None], "big": 1.7976931348623157e308},
             topology={"genus": None, "closed": True}, checks={"c": {"status": "pass", "residual": 0.1}}), False),
]  # fmt: skip


@pytest.mark.parametrize("message", MESSAGES, ids=lambda message: type(message).__name__)
def test_what_is_sent_arrives(message: Any) -> None:
    stream = io.BytesIO()
    send(stream, message)
    send(stream, message)
    assert stream.getvalue().count(b"\n") == 2
    stream.seek(0)
    for _ in range(2):
        found = receive(stream, type(message))
        assert found == message
        assert repr(found) == repr(message), "to the sign of zero"
    with pytest.raises(EOFError):
        receive(stream, type(message))


_DONE: list[str] = []


class Harm:
    """Would leave a trace if it were unpickled."""

    def __reduce__(self) -> Any:
        return _DONE.append, ("harm",)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_a_pickle_is_no_message(protocol: int) -> None:
    for ending in (b"", b"\n"):
        with pytest.raises(NO_MESSAGE):
            receive(io.BytesIO(pickle.dumps(Harm(), protocol) + ending), Done)
    assert _DONE == []


@pytest.mark.parametrize("line", [b"", b'{"version": "1"}', b"{}\n", b'{"version": 1}\n', b"[]\n", b"\xff\n", b"x\n"])
def test_parts_and_other_kinds_are_refused(line: bytes) -> None:
    with pytest.raises(NO_MESSAGE):
        receive(io.BytesIO(line), Ready)


def test_a_message_of_another_kind_is_refused() -> None:
    stream = io.BytesIO()
    send(stream, Ready("1"))
    with pytest.raises(msgspec.ValidationError):
        receive(io.BytesIO(stream.getvalue()), Done)
