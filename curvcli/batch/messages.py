"""Messages between a batch and its workers: one line of JSON each, checked against its type on arrival.

Messages are data only: unlike a pickle they cannot name code.
"""

from __future__ import annotations

import json
from typing import BinaryIO, TypeVar

import msgspec

from .model import BatchItem, BatchSettings, Row


class Task(msgspec.Struct, frozen=True):
    """Mesh for a worker, with its settings."""

    item: BatchItem
    settings: BatchSettings


class Ready(msgspec.Struct, frozen=True):
    """Sign that a worker is ready."""

    version: str


class Done(msgspec.Struct, frozen=True):
    """Row of a finished mesh; spent: true if the process should get no other mesh."""

    row: Row
    spent: bool


Message = TypeVar("Message", bound=msgspec.Struct)

NO_MESSAGE = (EOFError, OSError, ValueError, msgspec.MsgspecError)
"""Errors of `receive` if the other side has died or sends another message."""


def send(stream: BinaryIO, message: msgspec.Struct) -> None:
    """Send a message.

    File names that are not UTF-8 hold lone surrogates, which JSON can escape and UTF-8 cannot write.
    """
    stream.write(json.dumps(msgspec.to_builtins(message)).encode("ascii") + b"\n")
    stream.flush()


def receive(stream: BinaryIO, kind: type[Message]) -> Message:
    """Receive the next message.

    Errors: EOFError without a whole message, ValueError or msgspec.ValidationError for another kind.
    """
    line = stream.readline()
    if not line.endswith(b"\n"):
        raise EOFError
    return msgspec.convert(json.loads(line), kind)
