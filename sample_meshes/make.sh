#!/bin/sh
# Make the meshes of this folder. Run it in this folder.
set -eu
curvcli sample icosphere --size 642 -o sphere.ply -o sphere.obj -o sphere.stl --force
curvcli sample irregular_torus --size 800 -o torus.ply -o torus.obj -o torus.stl --force
curvcli sample monkey_saddle --size 400 -o saddle.ply -o saddle.obj -o saddle.stl --force
curvcli sample mobius --size 400 -o mobius.obj --force
curvcli sample unduloid --size 800 -o unduloid.ply --force
curvcli sample cube -o cube.obj -o cube.stl --force
