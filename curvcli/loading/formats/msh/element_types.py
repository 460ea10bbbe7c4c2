"""Element types of Gmsh: the number of nodes of each, and the cell type of VTK that has the same role."""

from __future__ import annotations

_LINE, _TRIANGLE, _QUAD, _TETRAHEDRON, _HEXAHEDRON, _WEDGE, _PYRAMID, _VERTEX = 3, 5, 9, 10, 12, 13, 14, 1
_CURVED_LINE, _CURVED_FACE, _CURVED_SOLID = 21, 22, 24

_STRAIGHT = {
    1: (_LINE, 2),
    2: (_TRIANGLE, 3),
    3: (_QUAD, 4),
    4: (_TETRAHEDRON, 4),
    5: (_HEXAHEDRON, 8),
    6: (_WEDGE, 6),
    7: (_PYRAMID, 5),
    15: (_VERTEX, 1),
}
_LINES = {8: 3, 26: 4, 27: 5, 28: 6, 62: 7, 63: 8, 64: 9, 65: 10, 66: 11}
_FACES = {
    9: 6,
    20: 9,
    21: 10,
    22: 12,
    23: 15,
    24: 15,
    25: 21,
    42: 28,
    43: 36,
    44: 45,
    45: 55,
    46: 66,
    10: 9,
    16: 8,
    36: 16,
    37: 25,
    38: 36,
    39: 12,
    40: 16,
    41: 20,
    47: 49,
    48: 64,
    49: 81,
    50: 100,
    51: 121,
}
_SOLIDS = {
    11: 10,
    29: 20,
    30: 35,
    31: 56,
    71: 84,
    72: 120,
    73: 165,
    74: 220,
    75: 286,
    12: 27,
    17: 20,
    92: 64,
    93: 125,
    94: 216,
    95: 343,
    96: 512,
    97: 729,
    98: 1000,
    13: 18,
    14: 14,
    18: 15,
    19: 13,
    90: 40,
    91: 75,
    106: 126,
    107: 196,
    108: 288,
    109: 405,
    110: 550,
}

TYPES: dict[int, tuple[int, int]] = {
    **_STRAIGHT,
    **{kind: (_CURVED_LINE, nodes) for kind, nodes in _LINES.items()},
    **{kind: (_CURVED_FACE, nodes) for kind, nodes in _FACES.items()},
    **{kind: (_CURVED_SOLID, nodes) for kind, nodes in _SOLIDS.items()},
}
"""Type of VTK and number of nodes by type of Gmsh."""
