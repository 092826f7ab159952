#!/bin/bash
# The unmodified isoprint against the virtual printer at the far end of something.
#   isoprint.sh ISOPRINT ISOPRINT-VIRTUAL SCENARIO [CHIP]
isoprint=$1 virtual=$2 scenario=$3 chip=${4:-cdc-acm}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failed=0
# The printer's library has to be in front of the sanitizer's.
export LC_ALL=C ASAN_OPTIONS=verify_asan_link_order=0${ASAN_OPTIONS:+:$ASAN_OPTIONS}
export isoprint

make_job() { # points of a circle, in each of two layers
    awk -v points="$1" 'BEGIN {
        print "; a job\nM104 S200\nM140 S60\nG28 ; home\nM190 S60\nM109 S200\nG90\nM83"
        for (layer = 1; layer <= 2; layer++) {
            printf ";LAYER_CHANGE\nG1 Z%.2f F3000\n", layer * 0.2
            for (i = 0; i < points; i++)
                printf "G1 X%.3f Y%.3f E%.4f F1800\n", 100 + 20 * cos(i * 0.1),
                    100 + 20 * sin(i * 0.1), 0.05 + layer * 0.01
        }
        print "G1 E-1 F2400\nM104 S0\nM140 S0\nM107\nG1 X10 Y190 F6000\nM84"
    }' >job.gcode
}

expect() { # code, then the command
    local code=$1 got=0
    shift
    timeout -k 1 100 "$@" >out 2>err || got=$?
    [ $got = "$code" ] && return
    echo "exit code $got, not $code: $*"
    head -c 5000 out err
    failed=1
}

has() { # file, text
    grep -qF -- "$2" "$1" || { echo "'$2' is not in $1:"; cat "$1"; failed=1; }
}

# What extruded is what the file says, as text, without the printer's own opinion.
extruded_as_file() {
    grep 'E0' job.gcode | tr -d ' ' >wanted
    grep 'E0' executed | tr -d ' ' | cmp - wanted || failed=1
}

usb=(--usb "$chip" --usb-bound --speed instant --check job.gcode --executed executed)

case $scenario in
print) # a whole job, exactly once, at the usual rates; the kernel's driver gets the port back
    make_job 60
    for rate in 115200 250000; do
        expect 0 "$virtual" "${usb[@]}" --rate $rate -- "$isoprint" job.gcode --baud $rate
        has out 'faults   0,'
        has out '0 bytes overrun'
        has out 'check    job.gcode: executed whole, each line once and in order'
        grep -Eq "driver   Linux' own has ([0-9]) of \\1 interfaces back" out || {
            echo "the driver has not come back:"
            cat out
            failed=1
        }
        extruded_as_file
    done
    [ ! -e job.gcode.journal ] || { echo "a journal is left"; failed=1; }
    ;;
pressure) # small buffers, native USB: packets are refused, nothing is lost
    make_job 150
    expect 0 "$virtual" "${usb[@]}" --rate 0 --receive-bytes 16 --command-slots 1 \
        --planner-blocks 3 -- "$isoprint" job.gcode --journal none
    has out '0 bytes overrun'
    extruded_as_file
    ;;
faults) # bits flip, oks are lost, doubled and late: still exactly once
    make_job 60
    expect 0 "$virtual" "${usb[@]}" --seed 7 --flip-in 0.03 --flip-out 0.01 --lose-ok 0.01 \
        --double-ok 0.01 --split 0.1 --merge 0.1 -- "$isoprint" job.gcode --journal none
    extruded_as_file
    grep -Eq 'trouble  [1-9][0-9]* faults injected' out || { echo "no fault"; failed=1; }
    ;;
unplug) # in mid-line; the board keeps its power and its place, and the job goes on there
    make_job 60
    cat >host.sh <<'SH'
"$isoprint" job.gcode -q --journal journal 2>lost
code=$?
[ $code = 10 ] || { echo "exit code $code, not 10"; exit 1; }
for ((i = 0; i < 200; i++)); do # the node goes a moment after its transfers have ended
    [ -e /dev/bus/usb/001/002 ] || break
    sleep 0.02
done
exec "$isoprint" --resume-from journal -q --wait 10
SH
    expect 0 "$virtual" "${usb[@]}" --no-reset --do 'at byte 3500 unplug' --replug 0.1 -- \
        bash host.sh
    has lost 'unplugged'
    has lost '--resume-from journal'
    extruded_as_file
    [ ! -e journal ] || { echo "the journal is left"; failed=1; }
    ;;
gone) # and never comes back: it ends soon, and says where
    make_job 60
    expect 10 "$virtual" --usb "$chip" --speed instant --do 'at byte 3500 unplug' --quiet -- \
        "$isoprint" job.gcode -q --journal journal
    has err 'after line'
    ;;
stall) # an endpoint stalls once: cleared, and nothing is lost
    make_job 60
    expect 0 "$virtual" "${usb[@]}" --usb-stall 30 -- "$isoprint" job.gcode --journal none
    extruded_as_file
    ;;
denied)
    make_job 4
    expect 9 "$virtual" --usb "$chip" --usb-denied --quiet -- "$isoprint" job.gcode
    has err 'not allowed to open /dev/bus/usb/001/002'
    has err 'udev'
    ;;
list)
    expect 0 "$virtual" --usb "$chip" --quiet -- "$isoprint" --list
    grep -q '^usb:[0-9a-f]\{4\}:[0-9a-f]\{4\}:VP0001 ' out || { cat out; failed=1; }
    expect 0 "$virtual" --usb "$chip" --usb-id 1d50:6029 --usb-serial X7 --quiet -- \
        "$isoprint" --list
    has out 'usb:1d50:6029:X7'
    ;;
idle) # waiting for a printer at work costs no processor time: 2 s of it here
    printf 'G4 S2\n' >job.gcode
    cat >host.sh <<'SH'
TIMEFORMAT='%U %S'
time "$isoprint" job.gcode -q --journal none
SH
    expect 0 "$virtual" --usb "$chip" --speed real --boot-seconds 0 --quiet -- bash host.sh
    awk '/^[0-9.]+ [0-9.]+$/ { spent = $1 + $2; seen = 1 } END {
        if (!seen || !(spent < 0.5)) { print "processor time: " spent " s"; exit 1 } }' err ||
        failed=1
    ;;
serial) # the same over a pseudo terminal and over sockets
    make_job 60
    for where in "--pty $folder/printer" "--socket $folder/socket" "--tcp 127.0.0.1:0"; do
        # shellcheck disable=SC2086
        expect 0 "$virtual" $where --speed instant --check job.gcode --executed executed -- \
            "$isoprint" job.gcode --journal none
        extruded_as_file
    done
    printf 'G28\n' >other.gcode
    expect 8 "$virtual" --pty --speed instant --check job.gcode --quiet -- \
        "$isoprint" other.gcode --journal none
    has err 'M104'
    ;;
*)
    echo "no such scenario: $scenario"
    failed=1
    ;;
esac
exit $failed
