"""PLY files whose counts are wrong: data that are shifted against the header are refused."""

from __future__ import annotations

import struct

import pytest

from tests.loading.parsing import parsed
from tests.loading.test_ply import HEAD, POINTS, STRIPS, ascii_ply, binary_ply, refused


def changed(data: bytes, old: str, new: str) -> bytes:
    assert old.encode() in data
    return data.replace(old.encode(), new.encode(), 1)


FACES = [(0, 1, 2), (0, 2, 3), (0, 3, 1)]
TEXT_FACES = "".join(f"3 {a} {b} {c}\n" for a, b, c in FACES)


class TestShifted:
    """A wrong count, or a wrong length, moves the rows after it: refused, and the count is named."""

    @pytest.mark.parametrize("order", ["little", "big"])
    @pytest.mark.parametrize("count", [3, 5, 6])
    def test_vertex_count_in_binary(self, order: str, count: int) -> None:
        message = refused(changed(binary_ply(FACES, order), "vertex 4", f"vertex {count}"))
        assert "face" in message

    def test_vertex_count_one_too_large(self) -> None:
        message = refused(changed(binary_ply(FACES), "vertex 4", "vertex 5"))
        assert message.startswith("face 0: list length 0 found, 3 or more expected; `element vertex 5` in the header")

    @pytest.mark.parametrize("doubles", [True, False])
    def test_vertex_count_with_other_widths(self, doubles: bool) -> None:
        head = HEAD.format(order="binary_little_endian", faces=40).replace("vertex 4", "vertex 5")
        head = head.replace("float", "double") if doubles else head
        points = b"".join(struct.pack("<3d" if doubles else "<3f", *p) for p in POINTS)
        faces = b"".join(struct.pack("<B3i", 3, 0, 1 + k % 2, 3) for k in range(40))
        assert "list length 0 found" in refused(head.encode() + points + faces)

    def test_a_last_vertex_at_the_origin(self) -> None:
        """Twelve bytes of zeros would be twelve faces without corners."""
        data = binary_ply(FACES * 10)
        at = data.index(b"end_header\n") + 11
        data = data[: at + 36] + bytes(12) + data[at + 48 :]
        message = refused(changed(data, "vertex 4", "vertex 3"))
        assert message.startswith("face 0: list length 0 found, 3 or more expected; `element vertex 3` in the header")

    @pytest.mark.parametrize("last", ["0 0 1", "1 0 1", "2 0 1", "0 0 0", "2 1 0 0 0 1", "3 0 1 2 0 0"])
    def test_vertex_count_one_too_small_in_text(self, last: str) -> None:
        """The last vertex reads as a face, and the last face as data after the end."""
        wide = len(last.split()) > 3
        normal = "".join(f"property float n{axis}\n" for axis in "xyz") if wide else ""
        head = HEAD.format(order="ascii", faces=3).replace("element face", f"{normal}element face")
        body = "".join(f"{x} {y} {z}{' 0 0 1' * wide}\n" for x, y, z in [(0, 0, 0), (1, 0, 0), (1, 1, 0)])
        text = f"{head}{body}{last}\n{TEXT_FACES}"
        assert parsed("ply", text.encode()).polygons == 3
        assert "in the header" in refused(changed(text.encode(), "vertex 4", "vertex 3"))

    def test_vertex_count_one_too_large_in_text(self) -> None:
        assert "2 found" in refused(changed(ascii_ply(TEXT_FACES), "vertex 4", "vertex 5"))

    @pytest.mark.parametrize("length", [0, 1, 2])
    @pytest.mark.parametrize("row", [0, 1, 2])
    def test_a_wrong_list_length(self, length: int, row: int) -> None:
        lines = TEXT_FACES.splitlines()
        lines[row] = f"{length}{lines[row][1:]}"
        message = refused(ascii_ply("\n".join(lines) + "\n"))
        assert message.startswith(f"line {14 + row}: list length {length} found in a row with more values; ")
        data = binary_ply(FACES)
        at = data.index(b"end_header\n") + 11 + 48 + 13 * row
        assert refused(data[:at] + bytes([length]) + data[at + 1 :])

    def test_an_empty_list(self) -> None:
        for name, rows in (("face 1", "3 0 1 2\n0\n"), ("face 0", "0\n3 0 1 2\n")):
            assert refused(ascii_ply(rows)).startswith(f"{name}: list length 0 found, 3 or more expected; ")
        assert refused(binary_ply([(), (0, 1, 2)])).startswith("face 0: list length 0 found")
        assert refused((STRIPS.format(rows=2) + "4 0 1 2 3\n0\n").encode()).startswith(
            "tristrips 1: list length 0 found"
        )
