#!/bin/sh
# Calls that fail when they should not, by fault.c: the device is lost in mid-run; the disk is full or broken from some call
# on, or for one call; the process is killed in place of each single call that changes the output folder. Frames are named
# and counted, outputs are whole or not there, nothing else is left, -u does the rest. Last, an input changes between
# reading and writing.
#
#   faults.sh PROGRAM [STEP=1]      every STEPth call; needs a C compiler
set -eu
# shellcheck source-path=SCRIPTDIR source=common.sh
. "$(dirname "$0")/common.sh"
[ $# -ge 1 ] || { echo "usage: $0 PROGRAM [STEP=1]" >&2; exit 2; }
program=$(program_of "$1")
step=${2:-1}
needs "${CC:-cc}" gcc

dir=$(mktemp -d)
victim=
stop() {
    trap - EXIT
    if [ -n "$victim" ]; then kill -9 "$victim" 2>/dev/null || true; fi
    rm -rf "$dir"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

"${CC:-cc}" -std=gnu11 -Wall -Wextra -O1 -shared -fPIC "$(dirname "$0")/fault.c" -o "$dir/fault.so" -ldl ||
    fail "fault.c is not compiled"
frames=6
export XDG_CACHE_HOME="$dir/cache" POCL_CACHE_DIR="$dir/cache/pocl"
mkdir -p "$POCL_CACHE_DIR" "$dir/good" "$dir/out"
make_sequence "$program" "$dir" "$frames" 160x90

# shade FOLDER FAULT [FLAGS]
shade() {
    folder=$1
    fault=$2
    shift 2
    env ${fault:+LD_PRELOAD="$dir/fault.so"} CLSHADE_FAULT="$fault" CLSHADE_FAULT_FOLDER="$dir/out" \
        CLSHADE_FAULT_COUNT="$dir/count" "$program" shade "$dir/in.####.exr" -o "$folder/out.####.exr" \
        --scene "$dir/scene.toml" -q --json "$dir/report.json" "$@" >"$dir/said" 2>&1
}

empty() {
    rm -rf "$dir/out"
    mkdir "$dir/out"
}

written() {
    find "$dir/out" -name 'out.*' | wc -l
}

# The state after a run with a fault that the program saw.
checked() {
    no_temporaries "$dir/out"
    whole_images "$dir/good" "$dir/out"
    failed=$((frames - $(written)))
    [ "$failed" -eq 0 ] || grep -q "$failed of $frames frames failed" "$dir/said" || fail "$1: not counted: $(cat "$dir/said")"
    [ "$(grep -c '"status": "error"' "$dir/report.json")" -eq "$failed" ] || fail "$1: the report does not count $failed"
    frame=1
    while [ "$frame" -le "$frames" ]; do
        [ -e "$dir/out/out.000$frame.exr" ] || grep -q "frame $frame: " "$dir/said" ||
            fail "$1: frame $frame is not named: $(cat "$dir/said")"
        frame=$((frame + 1))
    done
}

completed() {
    code_of shade "$dir/out" "" -u
    expect 0 "$1: -u: $(cat "$dir/said")"
    same_images "$dir/good" "$dir/out"
}

shade "$dir/good" "" || fail "a run left in peace: $(cat "$dir/said")"
code_of shade "$dir/out" count:0
expect 0 "a run that is only counted: $(cat "$dir/said")"
same_images "$dir/good" "$dir/out"
count=$(cat "$dir/count")
[ "$count" -ge "$frames" ] || fail "fault.c sees $count calls only"

say "the device is lost"
for kernels in 0 1 $((frames - 2)); do
    empty
    code_of shade "$dir/out" "device:$kernels"
    if [ "$kernels" -gt 0 ]; then
        expect 4 "lost after $kernels kernels: $(cat "$dir/said")"
    else # no frame written: the first one's failure
        [ "$code" -eq 1 ] || expect 5 "lost before the first kernel: $(cat "$dir/said")"
    fi
    grep -q CL_DEVICE_NOT_AVAILABLE "$dir/said" || fail "the reason is not told: $(cat "$dir/said")"
    checked "lost after $kernels kernels"
    completed "lost after $kernels kernels"
done

say "the disk fails for good, or once, at each of $count calls"
at=0
while [ "$at" -lt "$count" ]; do
    for fault in "disk:$at:ENOSPC" "disk:$at:EIO:once"; do
        empty
        code_of shade "$dir/out" "$fault"
        checked "$fault"
        if [ "$failed" -eq "$frames" ]; then
            expect 1 "$fault: $(cat "$dir/said")"
        elif [ "$failed" -gt 0 ]; then
            expect 4 "$fault: $(cat "$dir/said")"
        else
            expect 0 "$fault: $(cat "$dir/said")"
        fi
        case $fault in
            *:once) [ "$failed" -le 1 ] || fail "$fault: one bad call, $failed frames lost" ;;
        esac
    done
    completed "$fault"
    at=$((at + step))
done

say "killed at each of these calls"
at=0
while [ "$at" -lt "$count" ]; do
    # Outputs to be made, and outputs to be replaced.
    if [ $((at % 2)) -eq 0 ]; then empty; fi
    code_of shade "$dir/out" "kill:$at"
    [ "$code" -eq 137 ] || [ "$code" -eq 0 ] || fail "killed at call $at: exit code $code: $(cat "$dir/said")"
    whole_images "$dir/good" "$dir/out"
    completed "killed at call $at"
    at=$((at + step))
done
say "an input is replaced while its frame is in hand"
empty
cp "$dir/in.0001.exr" "$dir/first.exr"
shade "$dir/out" stop:0 &
running=$!
victim=
until [ -n "$victim" ] && grep -qs '^State:.*stopped' "/proc/$victim/status"; do
    kill -0 "$running" 2>/dev/null || fail "ended before it was halted: $(cat "$dir/said")"
    sleep 0.05
    victim=$(pgrep -nf "shade $dir/in" || true)
done
cp "$dir/in.0002.exr" "$dir/new.exr" # read is the old one; the new one is older than the output
mv "$dir/new.exr" "$dir/in.0001.exr"
sleep 0.1
kill -CONT "$victim"
code_of wait "$running"
victim=
code_of shade "$dir/out" "" -u
expect 0 "-u after a replaced input: $(cat "$dir/said")"
mv "$dir/out/out.0001.exr" "$dir/now.exr"
shade "$dir/out" "" --frames 1 || fail "the new frame"
cmp "$dir/now.exr" "$dir/out/out.0001.exr" || fail "-u takes a picture of the old input for one of the new"
mv "$dir/first.exr" "$dir/in.0001.exr"
say "passed"
