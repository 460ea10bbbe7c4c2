"""What a batch and its workers say to each other: one line of JSON per message, checked against its type on arrival.

Data only: nothing that a message holds can name code, as a pickle can.
"""

from __future__ import annotations

import json
from typing import BinaryIO, TypeVar

import msgspec

from .model import Item, Row, Settings


class Task(msgspec.Struct, frozen=True):
    """A mesh for a worker, and how to do it."""

    item: Item
    settings: Settings


class Ready(msgspec.Struct, frozen=True):
    """A worker can begin."""

    version: str


class Done(msgspec.Struct, frozen=True):
    """What became of a mesh; spent: the process should not be given another."""

    row: Row
    spent: bool


Message = TypeVar("Message", bound=msgspec.Struct)

NO_MESSAGE = (EOFError, OSError, ValueError, msgspec.MsgspecError)
"""What `receive` raises where the other side has died, or says something else."""


def send(stream: BinaryIO, message: msgspec.Struct) -> None:
    """Hand a message over.

    File names that are not UTF-8 hold lone surrogates, which JSON can escape and UTF-8 cannot write.
    """
    stream.write(json.dumps(msgspec.to_builtins(message)).encode("ascii") + b"\n")
    stream.flush()


def receive(stream: BinaryIO, kind: type[Message]) -> Message:
    """The next message.

    Errors: EOFError where there is none or only a part of one, ValueError or msgspec.ValidationError for another kind.
    """
    line = stream.readline()
    if not line.endswith(b"\n"):
        raise EOFError
    return msgspec.convert(json.loads(line), kind)
