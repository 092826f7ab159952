#!/bin/sh
# isoprint-virtual from the command line: its exit codes, its summary, its log.
program=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failed=0

expect() { # code, then the command
    code=$1
    shift
    "$@" >"$folder/out" 2>"$folder/err"
    got=$?
    if [ $got -ne "$code" ]; then
        echo "exit code $got, not $code: $*"
        cat "$folder/err"
        failed=1
    fi
}

has() { # file, text
    grep -qF -- "$2" "$folder/$1" || { echo "'$2' is not in $1:"; cat "$folder/$1"; failed=1; }
}

cat >"$folder/good.gcode" <<'GCODE'
M104 S200
G28 ; home
M109 S200
M83
G1 X50 Y50 Z0.2 F6000
G1 X100 E2 F1200
G1 E-1 F2400
M104 S0
M84
GCODE
printf 'G28\nG1 X5 E1 F600\nG1 X900' >"$folder/bad.gcode"

expect 0 "$program" --run "$folder/good.gcode" --log "$folder/log"
[ "$(wc -l <"$folder/out")" -eq 8 ] || { echo "not 8 lines"; failed=1; }
has out 'faults   0, warnings 0'
cut -f8 "$folder/log" >"$folder/executed"
sed 's/ *;.*//' "$folder/good.gcode" | cmp - "$folder/executed" || failed=1
expect 0 sh -c "'$program' --run - <'$folder/good.gcode'"
expect 0 "$program" --bed=120x60x10 --run "$folder/good.gcode"
expect 0 "$program" --bed 120x60x10 --origin -10,-10,0 --classic-jerk --run "$folder/good.gcode"
expect 8 "$program" --bed 99x60x10 --run "$folder/good.gcode"
has err "$folder/good.gcode:6: fault outside: x goes to 100.000, out of the volume"
expect 8 "$program" --max-nozzle 190 --run "$folder/good.gcode"
has err 'fault temperature'
expect 8 "$program" --run "$folder/bad.gcode"
has err "$folder/bad.gcode:2: fault cold_extrusion"
has err "$folder/bad.gcode:3: fault outside"

expect 8 "$program" --json --run "$folder/bad.gcode"
if command -v /usr/bin/python3 >/dev/null; then
    /usr/bin/python3 - "$folder/out" <<'PYTHON' || failed=1
import json, sys
report = json.load(open(sys.argv[1]))
assert report["fault_count"] == 2 and report["moves"] == 2 and report["lines"] == 3
assert [(f["code"], f["line"]) for f in report["faults"]] == [("cold_extrusion", 2), ("outside", 3)]
PYTHON
fi

expect 2 "$program"
expect 2 "$program" --run
expect 2 "$program" --bed 400x400 --run "$folder/good.gcode"
expect 2 "$program" --bed 0x1x1 --run "$folder/good.gcode"
expect 2 "$program" --nonsense --run "$folder/good.gcode"
expect 3 "$program" --run "$folder/absent.gcode"
expect 3 "$program" --run "$folder"
expect 3 "$program" --run /dev/null
expect 7 "$program" --run "$folder/good.gcode" --log "$folder/no/such/folder"
if [ -w /dev/full ]; then
    expect 7 "$program" --run "$folder/good.gcode" --log /dev/full
    expect 7 sh -c "'$program' --run '$folder/good.gcode' >/dev/full"
fi
expect 0 "$program" --help
has out 'Exit codes'
expect 0 "$program" --version

# A line of 3 MB, and a file without an end of line.
{ printf 'G28\nM117 '; head -c 3000000 /dev/zero | tr '\0' 'x'; printf '\nG1 X5 F600\nM84'; } \
    >"$folder/long.gcode"
expect 0 "$program" --run "$folder/long.gcode" --log "$folder/log"
[ "$(wc -l <"$folder/log")" -eq 4 ] || { echo "a long line broke the lines after it"; failed=1; }
has log 'G1 X5 F600'
exit $failed
