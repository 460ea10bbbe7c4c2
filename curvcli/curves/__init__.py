"""Space curves: turning, frames, writhe, holonomy and linking of polygons, and the boundary curves of surfaces."""

from .boundary import Boundary, boundary_loops
from .curve import Curve
from .frames import Bishop, Frenet, transport_angle, twist
from .holonomy import normal_basis, normal_holonomy
from .links import links
from .loops import loop_table
from .polygon import Curves
from .turning import Turning
from .writhe import writhe

__all__ = [
    "Bishop",
    "Boundary",
    "Curve",
    "Curves",
    "Frenet",
    "Turning",
    "boundary_loops",
    "links",
    "loop_table",
    "normal_basis",
    "normal_holonomy",
    "transport_angle",
    "twist",
    "writhe",
]
