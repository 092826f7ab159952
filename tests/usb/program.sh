#!/bin/bash
# isoprint-virtual at the far end of something: its options, its ends, its exit codes.
#   program.sh ISOPRINT-VIRTUAL [usb]
program=$1 usb=$2
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export LC_ALL=C ASAN_OPTIONS=verify_asan_link_order=0${ASAN_OPTIONS:+:$ASAN_OPTIONS}
failed=0

expect() { # code, then the command
    local code=$1 got=0
    shift
    timeout -k 1 60 "$@" >out 2>err || got=$?
    [ $got = "$code" ] && return
    echo "exit code $got, not $code: $*"
    head -c 5000 out err
    failed=1
}

has() { # file, text
    grep -qF -- "$2" "$1" || { echo "'$2' is not in $1:"; cat "$1"; failed=1; }
}

await() { # a condition, at most 20 s
    local i
    for ((i = 0; i < 400; i++)); do
        eval "$1" && return
        sleep 0.05
    done
    echo "never came true: $1"
    failed=1
}

quick=(--speed instant --boot-seconds 0 --line-seconds 0)

# Wrong command lines: each says what is wrong.
expect 2 "$program" --pty --socket s
has err 'only one at a time'
expect 2 "$program" --speed instant
expect 2 "$program" --pty --speed 0
has err "--speed can't be '0'"
expect 2 "$program" --pty --flip-in 1.5
has err '0 to 1'
expect 2 "$program" --pty --receive-bytes 8
expect 2 "$program" --pty --firmware nonsense
expect 2 "$program" --pty --do 'at line 3 explode'
has err 'column'
expect 2 "$program" --tcp nonsense
expect 2 "$program" --tcp 1:70000
expect 2 "$program" --usb cdc-acm
has err 'COMMAND'
expect 2 "$program" --usbip pony
expect 2 "$program" --usbip cdc-acm --usb-id 12345:1
expect 2 "$program" --run x -- true
expect 2 "$program" --once=yes --pty
expect 3 "$program" --pty --script absent
expect 3 "$program" --pty --check absent -- true
expect 7 "$program" --socket "$folder/no/such/folder"
expect 7 "$program" --pty --executed "$folder/no/such/folder" -- true
expect 0 "$program" --help
has out '--flip-in P'
has out '0 to 1'

# The command's own code, unless it is 0.
expect 5 "$program" --pty --quiet -- sh -c 'exit 5'
expect 137 "$program" --pty --quiet -- sh -c 'kill -9 $$'
expect 127 "$program" --pty --quiet -- "$folder/no-such-command"
expect 0 "$program" --socket s --quiet -- sh -c 'test "$ISOPRINT_PORT" = socket:s && test -S s'
[ ! -e s ] || { echo "the socket is left"; failed=1; }

# A printer that was told nonsense; one line after the other, by hand.
cat >host.sh <<'SH'
exec 3<>printer
for line in "$@"; do
    echo "$line" >&3
    while read -r answer <&3; do
        echo "$answer"
        case $answer in ok*) break ;; esac
    done
done
SH
expect 0 "$program" --pty printer "${quick[@]}" --executed executed --json -- \
    bash host.sh G28 'G1 X5 F600' M114
has executed 'G1 X5 F600'
has out 'X:5.00'
has out '"fault_count": 0'
has out '"oks": 3'
expect 8 "$program" --pty printer "${quick[@]}" -- bash host.sh G28 'G1 X900 F600'
has err 'fault outside'
printf 'G28\nG1 X5 F600\n' >file
expect 0 "$program" --pty printer "${quick[@]}" --check file -- \
    bash host.sh M105 G28 M114 'G01 X5 F600'
expect 8 "$program" --pty printer "${quick[@]}" --check file -- bash host.sh G28
has err "file: line 2 'G1 X5F600': was never executed"
expect 8 "$program" --pty printer "${quick[@]}" --check file -- bash host.sh G28 G28 'G1 X5 F600'
has err "line 2 'G1 X5F600': in its place was executed G28"
expect 8 "$program" --pty printer "${quick[@]}" --check file -- \
    bash host.sh G28 'G1 X5 F600' 'G1 X5 F600'
has err 'the end: in its place was executed G1 X5F600'
expect 8 "$program" --pty printer "${quick[@]}" --check file -- bash host.sh G28 M42 'G1 X5 F600'
expect 0 "$program" --pty printer "${quick[@]}" --check file --host-commands M42,M43 -- \
    bash host.sh G28 M42 'G1 X5 F600'
expect 8 "$program" --run file --check /dev/stdin <<<'G28'
expect 0 "$program" --run file --check file

# Ends without a command: signals, the first host's leaving, idleness.
for signal in TERM INT; do
    "$program" --pty printer "${quick[@]}" --check file >out 2>err &
    await '[ -L printer ]'
    bash host.sh G28 'G1 X5 F600' >answers
    kill -$signal $!
    wait $!
    code=$?
    [ $code = 0 ] || { echo "exit code $code after SIG$signal"; cat out err; failed=1; }
    has out 'executed whole'
    [ ! -L printer ] || { echo "the link is left"; failed=1; }
done
"$program" --pty printer "${quick[@]}" --once --check file >out 2>err &
await '[ -L printer ]'
printf 'G28\nG1 X5 F600\n' >printer # and is gone
wait $! || { echo "--once: $?"; cat out err; failed=1; }
"$program" --pty printer "${quick[@]}" --until-idle 0.3 --check file >out 2>err &
await '[ -L printer ]'
exec 4<>printer
printf 'G28\nG1 X5 F600\n' >&4
wait $! || { echo "--until-idle: $?"; cat out err; failed=1; }
exec 4>&-

# It needs neither glib nor umockdev unless it is to be a USB device.
expect 1 "$program" --pty --quiet -- sh -c 'grep -q "libglib\|umockdev" /proc/$PPID/maps'
[ "$usb" = usb ] || exit $failed
expect 0 "$program" --usb cdc-acm --quiet -- sh -c 'grep -q libumockdev.so /proc/$PPID/maps'
ISOPRINT_UMOCKDEV=/no/such/module expect 7 "$program" --usb cdc-acm -- true
has err libumockdev-dev
expect 2 "$program" --usb pony -- true
expect 5 "$program" --usb ftdi --quiet -- sh -c 'exit 5'
expect 0 "$program" --usb ch340 --quiet -- sh -c 'test "$ISOPRINT_PORT" = usb:1a86:7523:VP0001'
exit $failed
