"""Outcome of `curvcli check` as SARIF 2.1.0 for code scanning: each failure, at the file it is in."""

from __future__ import annotations

import os
from pathlib import PurePath
from typing import Any
from urllib.parse import quote

import msgspec

from ..._version import __version__
from ...support.words import escape_sarif, escape_text
from ..model import encode
from .model import INPUT, CheckedMesh, CheckReport, Outcome, fingerprint, sentence

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"

# Name of the repository's root for GitHub.
_ROOT = "%SRCROOT%"


def write_sarif(report: CheckReport) -> bytes:
    """One run whose rules are the checks, whose results are the failures, and whose artifacts are the meshes."""
    place = {rule.name: index for index, rule in enumerate(report.rules)}
    results = [
        _result(mesh, index, outcome, place) for index, mesh in enumerate(report.meshes) for outcome in mesh.trouble
    ]
    run = {
        "tool": {
            "driver": {"name": "curvcli", "version": __version__, "rules": [_rule(rule) for rule in report.rules]}
        },
        "invocations": [_invocation(report)],
        "artifacts": [_artifact(mesh) for mesh in report.meshes],
        "results": results,
        "columnKind": "unicodeCodePoints",
    }
    return encode({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]})


def _invocation(report: CheckReport) -> dict[str, Any]:
    """Exit code, and the configuration file that the verdict depends on."""
    invocation: dict[str, Any] = {"executionSuccessful": report.exit_code in (0, 1), "exitCode": report.exit_code}
    if not isinstance(report.configuration, msgspec.UnsetType):
        text = escape_sarif(report.configuration.sentence)
        invocation["toolConfigurationNotifications"] = [{"level": "note", "message": {"text": text}}]
        invocation["properties"] = {"configuration": msgspec.to_builtins(report.configuration)}
    return invocation


def uri_of(path: str) -> str:
    """A mesh's path as a URI reference, relative to the working directory where possible."""
    try:
        relative = os.path.relpath(path)
    except ValueError:  # another drive
        return PurePath(os.path.abspath(path)).as_uri()
    except OSError:  # the working directory has been removed
        return PurePath(path).as_uri() if os.path.isabs(path) else quote(os.fsencode(path))
    return quote(os.fsencode(relative.replace(os.sep, "/")))


def _rule(rule: Any) -> dict[str, Any]:
    return {
        "id": escape_text(rule.name),
        "shortDescription": {"text": escape_sarif(f"{rule.statement}.")},
        "defaultConfiguration": {"level": "error"},
        "properties": {"kind": rule.kind},
    }


def _location(path: str) -> dict[str, Any]:
    return {"uri": uri_of(path), "uriBaseId": _ROOT}


def _artifact(mesh: CheckedMesh) -> dict[str, Any]:
    artifact_object: dict[str, Any] = {"roles": ["analysisTarget"]}
    if mesh.path == "-":
        artifact_object["description"] = {"text": "stdin"}
    else:
        artifact_object["location"] = _location(mesh.path)
    if mesh.sha256 is not None:
        artifact_object["hashes"] = {"sha-256": mesh.sha256}
    return artifact_object


def _result(mesh: CheckedMesh, index: int, outcome: Outcome, place: dict[str, int]) -> dict[str, Any]:
    result: dict[str, Any] = {
        "ruleId": escape_text(outcome.name),
        "ruleIndex": place[outcome.name],
        "kind": "fail",
        "level": "error",
        "message": {"text": escape_sarif(sentence(mesh, outcome))},
        "partialFingerprints": {"curvcli/v1": fingerprint(mesh, outcome)},
    }
    if mesh.path != "-":
        # Code scanning shows a result at a line; for a mesh it is the first.
        artifact = {**_location(mesh.path), "index": index}
        result["locations"] = [{"physicalLocation": {"artifactLocation": artifact, "region": {"startLine": 1}}}]
    if outcome.places:
        result.setdefault("locations", [{}])[0]["logicalLocations"] = [
            {"name": escape_text(place.element), "kind": "element"} for place in outcome.places
        ]
    if outcome.kind != INPUT:
        result["properties"] = {"scope": escape_text(outcome.scope)}
        if outcome.places:
            result["properties"] |= {"elements": outcome.elements, "places": msgspec.to_builtins(outcome.places)}
    return result
