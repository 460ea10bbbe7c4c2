"""The viewer: three.js with its trackball, as the page of trimesh's own viewer has them."""

from __future__ import annotations

import zipfile
from importlib.util import find_spec
from pathlib import Path

from ...errors import MissingExtraError

_PLACE, _MEMBER = "resources/templates/viewer.zip", "viewer.html.template"
# Its script is the library, then the trackball, then loaders and the page's own code, which are not wanted here.
_START, _END = "/**\n * @license", "(function(){class GLTFLoader"


def engine() -> str:
    """The library as JavaScript; it defines THREE with THREE.TrackballControls.

    Errors: MissingExtraError for a trimesh that has another viewer.
    """
    spec = find_spec("trimesh")  # without importing it
    folder = Path(spec.origin).parent if spec is not None and spec.origin is not None else Path()
    try:
        with zipfile.ZipFile(folder / _PLACE) as archive:
            page = archive.read(_MEMBER).decode("utf-8")
        code = page[page.index(_START) : page.index(_END)]
    except (OSError, KeyError, ValueError, zipfile.BadZipFile):
        code = ""
    if "THREE.TrackballControls=" not in code or "</script" in code:
        raise MissingExtraError("-o .html: this trimesh has no viewer for it; `pip install 'trimesh>=5.2,<6'`")
    return code
