"""JavaScript library of the 3D view: three.js and its trackball from the npm package three, with their licence."""

from __future__ import annotations

from importlib.resources import files

VERSION = "0.147.0"
"""Version of the npm package: the last with the trackball as a script that needs no modules."""

# Files of the package, unchanged: build/three.min.js and examples/js/controls/TrackballControls.js.
SCRIPTS = ("three.min.js", "TrackballControls.js")
LICENSE = "LICENSE"


def engine() -> str:
    """Library as JavaScript behind the text of its licence; it defines THREE with THREE.TrackballControls."""
    folder = files(__package__).joinpath("three")
    notice, *code = (folder.joinpath(name).read_bytes().decode("utf-8") for name in (LICENSE, *SCRIPTS))
    return "\n".join([f"/*! three.js {VERSION}\n\n{notice.strip()}\n*/", *code])
