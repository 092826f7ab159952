#!/bin/sh
# draw_paths.sh ISOSLICE FOLDER: the picture of docs/paths.md, a clover with a hole twice: with the
# usual seams and travels, then with both as plain as can be.
set -eu
isoslice=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Walls 3 mm high: r = 15 + 6 cos 4 w outside, 5 inside.
awk 'BEGIN {
    n = 180; pi = atan2(0, -1)
    for (i = 0; i <= n; i++) {
        w = 2 * pi * i / n
        r = 15 + 6 * cos(4 * w)
        ox[i] = r * cos(w); oy[i] = r * sin(w); ix[i] = 5 * cos(w); iy[i] = 5 * sin(w)
    }
    print "solid clover"
    for (i = 0; i < n; i++) {
        k = i + 1
        quad(ox[i], oy[i], 0, ox[k], oy[k], 0, ox[k], oy[k], 3, ox[i], oy[i], 3)
        quad(ix[k], iy[k], 0, ix[i], iy[i], 0, ix[i], iy[i], 3, ix[k], iy[k], 3)
        quad(ox[i], oy[i], 3, ox[k], oy[k], 3, ix[k], iy[k], 3, ix[i], iy[i], 3)
        quad(ox[k], oy[k], 0, ox[i], oy[i], 0, ix[i], iy[i], 0, ix[k], iy[k], 0)
    }
    print "endsolid"
}
function quad(ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz) {
    facet(ax, ay, az, bx, by, bz, cx, cy, cz)
    facet(ax, ay, az, cx, cy, cz, dx, dy, dz)
}
function facet(ax, ay, az, bx, by, bz, cx, cy, cz) {
    print "facet normal 0 0 0\nouter loop"
    printf "vertex %.6f %.6f %.6f\nvertex %.6f %.6f %.6f\nvertex %.6f %.6f %.6f\n",
        ax, ay, az, bx, by, bz, cx, cy, cz
    print "endloop\nendfacet"
}' >"$work/clover.stl"

draw() {
    name=$1
    shift
    "$isoslice" -q "$work/clover.stl" -o "$work/clover.gcode" --layer-height 0.2 \
        --first-layer-height 0.2 --perimeters 2 --skirts 0 --fill-density 15% \
        --gcode-resolution 0.03 "$@"
    "$isoslice" preview -q "$work/clover.gcode" -o "$folder/$name.svg" --layers 7,8 --columns 2
}
draw paths --avoid-crossing-perimeters
draw paths-random --seam-position random --no-only-retract-when-crossing-perimeters
