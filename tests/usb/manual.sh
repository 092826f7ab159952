#!/bin/bash
# The examples of the manual, as they stand there: the shell's, and what a workflow's steps run.
#   manual.sh MANUAL FOLDER-OF-PROGRAMS [usb]
manual=$1 programs=$2 usb=$3
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
export LC_ALL=C PATH="$programs:$PATH" ASAN_OPTIONS=verify_asan_link_order=0
failed=0

example() { # name; the script is read from standard input
    mkdir "$folder/$1"
    cat >"$folder/$1.sh"
    [ "$(wc -l <"$folder/$1.sh")" -ge 3 ] || { echo "$1: not in the manual"; return 1; }
    (cd "$folder/$1" && bash -eu "../$1.sh") >"$folder/$1.out" 2>&1 && return
    echo "$1:"
    cat "$folder/$1.out"
    return 1
}

step() { # what the step of this name runs
    awk -v name="- name: $1" '
        $0 ~ "^ *" name "$" { here = 1 }
        here && /run: \|$/ { indent = match($0, /[^ ]/) + 1; running = 1; next }
        running && match($0, /[^ ]/) && RSTART <= indent { exit }
        running && /^```/ { exit }
        running { print substr($0, indent + 1) }' "$manual"
}

sed -n '/^```sh$/,/^```$/p' "$manual" | grep -v '^```' | example shell || failed=1
step 'Print over a serial port' | example serial || failed=1
if [ "$usb" = usb ]; then
    printf 'M104 S200\nG28\nM109 S200\nM83\nG1 X50 E1 F1200\nM104 S0\n' >"$folder/part.gcode"
    { echo 'cp ../part.gcode .'; step 'Print over USB'; } | example usb || failed=1
fi
exit $failed
