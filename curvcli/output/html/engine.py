"""The viewer's library: three.js and its trackball, as the npm package three has them, with their licence."""

from __future__ import annotations

from importlib.resources import files

VERSION = "0.147.0"
"""Of the npm package: the last that has the trackball as a script that needs no modules."""

# The files of the package, unchanged: build/three.min.js and examples/js/controls/TrackballControls.js.
SCRIPTS = ("three.min.js", "TrackballControls.js")
LICENSE = "LICENSE"


def engine() -> str:
    """The library as JavaScript behind the text of its licence; it defines THREE with THREE.TrackballControls."""
    folder = files(__package__).joinpath("three")
    notice, *code = (folder.joinpath(name).read_bytes().decode("utf-8") for name in (LICENSE, *SCRIPTS))
    return "\n".join([f"/*! three.js {VERSION}\n\n{notice.strip()}\n*/", *code])
