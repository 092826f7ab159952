#!/bin/sh
# draw_patterns.sh ISOSLICE FOLDER: the pictures of docs/patterns.md, two layers of a block each.
set -eu
isoslice=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# box NAME X0 Y0 Z0 X1 Y1 Z1
box() {
    echo "$@" | awk '{
        for (c = 0; c < 8; c++)
            at[c] = $(2 + c % 2 * 3) " " $(3 + int(c / 2) % 2 * 3) " " $(4 + int(c / 4) * 3)
        n = split("0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5", corner)
        print "solid block"
        for (i = 1; i <= n; i += 3) {
            print "facet normal 0 0 0\nouter loop"
            for (k = i; k < i + 3; k++) print "vertex " at[corner[k]]
            print "endloop\nendfacet"
        }
        print "endsolid"
    }' >"$work/$1.stl"
}
box block 0 0 0 40 40 6

draw() {
    pattern=$1
    shift
    "$isoslice" -q "$work/block.stl" -o "$work/block.gcode" --layer-height 0.2 \
        --first-layer-height 0.2 --perimeters 1 --skirts 0 --fill-density 20% \
        --solid-infill-below-area 0 "$@"
    "$isoslice" preview -q "$work/block.gcode" -o "$folder/pattern-$pattern.svg" \
        --layers 16,23 --columns 2
}

for pattern in rectilinear alignedrectilinear grid triangles stars cubic line concentric honeycomb \
    3dhoneycomb gyroid hilbertcurve archimedeanchords octagramspiral; do
    draw $pattern --fill-pattern $pattern --top-solid-layers 0 --bottom-solid-layers 0
done

# What covers a surface is drawn at full density, on every layer.
for pattern in monotonic monotoniclines; do
    draw $pattern --top-fill-pattern $pattern --solid-infill-every-layers 1 --top-solid-layers 100 \
        --bottom-solid-layers 0 --fill-density 100% --fill-pattern $pattern --extrusion-width 0.8 --nozzle-diameter 0.6
done

# Regions with another infill.
box core 10 10 -1 30 30 7
box side 26 -1 -1 41 23 7
"$isoslice" -q "$work/block.stl" -o "$work/block.gcode" --layer-height 0.2 --first-layer-height 0.2 \
    --perimeters 1 --skirts 0 --fill-density 12% --top-solid-layers 0 --bottom-solid-layers 0 \
    --modifiers "$work/core.stl fill_density=45% fill_angle=0
$work/side.stl fill_pattern=honeycomb fill_density=25%"
"$isoslice" preview -q "$work/block.gcode" -o "$folder/modifier.svg" --layers 16,23 --columns 2
