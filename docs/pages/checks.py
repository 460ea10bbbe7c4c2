"""The page of the checks: identities and requirements, from their declarations."""

from __future__ import annotations

from curvcli.checks.base import CheckRule
from curvcli.checks.catalogue import identities
from curvcli.checks.requirements.catalogue import SETS, requirements
from curvcli.curvatures.catalogue import load_passes

_INTRODUCTION = """\
# Checks

This page is generated from `curvcli/checks/` and `curvcli/checks/requirements/`. ε = 2⁻⁵²; F and V count faces and
vertices, N is 3F + V; the extent of a face is √(¾Σ|e|²) over its edges, half its perimeter or up to 1.23 times that. An
*identity* is a theorem: it holds for every mesh that it applies to, up to rounding, and so it proves the arithmetic,
not the mesh. A *requirement* is a property of a mesh.

`curvcli analyze` tests the identities of the computed quantities. `curvcli check` tests all identities, and the
requirements. The scope is the whole surface, every component, and every region. The status is `pass`, `fail`, or
`not_applicable` with the reason. An identity with an undefined term, or with sides beyond the range of doubles in the
unit of the file, is not applicable, never passed.

## When an identity fails

1. Read `scope` and `detail`: the component or region, and the size of the failure.
2. Read the warnings of the report. Values beyond the range of doubles (`out_of_range`) are undefined.
3. Run the same file with `-p all`: other identities of the same columns locate the wrong column.
4. If the identity needs columns of a plug-in, report it to the author of the plug-in.
5. Otherwise it is a defect of curvcli or of the machine, for an identity holds on every mesh. Please report it, with
   the file if possible.
"""

_REQUIREMENTS = """\
## Requirements

A failed requirement has the number of places and names the first. `curvcli check` always tests those marked *, except
those in `--allow NAME`. `--require` adds the others.

| requirement | statement | remedy |
|---|---|---|
"""

_CRITICAL = """
`minimal` and `cmc` test numbers without a unit: the verdict is the same in millimetres and in metres, and a finer
mesh is not a better one for its smaller stars. They ask whether the *mesh* is critical for its area, alone or for
its volume. A mesh that only approximates such a surface need not be. On irregular triangulations of a round sphere
the largest |H_p + H A_p|/A_p does not tend to 0, however fine they are, while H itself tends to 2/r. Surfaces
evolved by a soap film solver pass. `minimal` covers lines where three films meet. Rounding of a star counts as 0; a
vertex without a value fails the requirement."""

_EMBEDDED = """
## Self-intersections

Two faces are in contact if they meet outside the corners and the edge that they share. `curvcli analyze MESH --table
intersections=PATH` lists all pairs with the kind of contact and a point of it:

| kind | meaning | fails |
|---|---|---|
| `crossing` | the faces meet along a segment, each on both sides of the other's plane | both requirements |
| `overlapping` | the faces lie in one plane and have an area in common | both requirements |
| `folded` | neighbours that lie in one plane on the same side of their common edge | both requirements |
| `touching` | every other contact, such as a corner on a face or an edge on an edge | `no-self-contacts` |

The decision is exact for the coordinates as they are stored: a floating-point filter decides most pairs, error-free
sums decide the others (Shewchuk 1997), and the test of two triangles is that of Guigue and Devillers (2003). A tree of
bounding boxes proposes the pairs. Corners at one position count as one, so that seams are no contacts. Faces without
area and faces with the same corners are left out, because `no-degenerate` and `no-duplicate-faces` report them.
Bodies that only touch in the exact model may cross by the rounding of their coordinates; the test says so.
"""

_SETS = """
Sets stand for several requirements; `--allow` exempts a mesh from a member. A configuration or `--sets` defines others:

| set | members |
|---|---|
"""

_ELSEWHERE = r"""
## Of curves and of maps

`curvcli curves` tests on every curve, with tolerances of the same kind, n its vertices and ψ its turning angles:

| identity | statement | applies to |
|---|---|---|
| `fenchel` | Σψ ≥ 2π | closed curves |
| `tangent_change` | the curvature vectors add up to T(q) − T(p), 0 if closed | all with an edge |
| `turning_number` | the signed total curvature is a multiple of 2π | plane closed curves |
| `holonomy` | the holonomy of the parallel frame is 2π · writhe up to whole turns | closed curves, none turning back |

`curvcli compare A B --map` tests of the map f from A to B:

| identity | statement |
|---|---|
| `dirichlet_energy` | ½ Σ \|∇f\|² area = ¼ Σ cot θ \|opposite edge\|²: both formulas of its energy agree |
| `nonconformality` | Σ ½(σ₁ − σ₂)² area = E(f) − area f(M) ≥ 0 |

With `uv` for B, f is the map to the texture coordinates of A. The texture has a seam at an
edge whose two faces have different coordinates there: f is continuous on the surface cut open along its seams, E(f) is
the energy there, the sum over all faces, and both identities hold as they do on every surface.

The column `orientation` of the table of faces is +1, or −1 where f turns a face over against most of the area of its
patch. Into a plane it is the sign of det df. Between surfaces in space a face has no side of its own, and the sign is
carried from face to face: it changes where the dihedral angles of surface and image differ by more than a right angle.
"""


def page() -> str:
    """The documentation page of all checks, in Markdown."""
    load_passes()  # plug-ins may bring identities of their own
    parts = [_INTRODUCTION, "## Identities\n", *(_identity(rule) for rule in identities().values())]
    rows = [
        f"| `{each.usage}`{' *' if each.default else ''} | {_cell(each.statement)} | {_cell(each.remedy)} |"
        for each in requirements().values()
    ]
    sets = [f"| `{name}` | {', '.join(f'`{member}`' for member in members)} |" for name, members in SETS.items()]
    required = [_REQUIREMENTS + "\n".join(rows), _SETS + "\n".join(sets), _CRITICAL]
    return "\n".join([*parts, *required, _EMBEDDED, _ELSEWHERE])


def _identity(rule: CheckRule) -> str:
    lines = [f"### `{rule.name}`\n", f"{rule.statement}\n"]
    told = (
        ("tested", rule.gap),
        ("applies to", rule.applies),
        ("tolerance", rule.bound),
        ("needs", ", ".join(f"`{need}`" for need in rule.needs)),
        ("a failure means", rule.failure),
    )
    return "\n".join([*lines, *(f"* {label}: {_text(value)}" for label, value in told if value)]) + "\n"


def _text(value: str) -> str:
    """Text in which Markdown finds nothing to mark."""
    return value.replace("*", r"\*")


def _cell(value: str) -> str:
    return _text(value).replace("|", r"\|")
