#!/bin/sh
# What a run meets when others work on the same disk: inputs removed or cut short in mid-run, the output folder moved away,
# a folder that may not be written. Frames are named and counted, the others are written; -u does the rest.
#
#   vanished.sh PROGRAM         as root the part about permissions runs as `nobody`
set -eu
# shellcheck source-path=SCRIPTDIR source=common.sh
. "$(dirname "$0")/common.sh"
[ $# -eq 1 ] || { echo "usage: $0 PROGRAM" >&2; exit 2; }
program=$(program_of "$1")

dir=$(mktemp -d)
running=
stop() {
    trap - EXIT
    if [ -n "$running" ]; then kill -9 "$running" 2>/dev/null || true; fi
    rm -rf "$dir"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

frames=40
export XDG_CACHE_HOME="$dir/cache" POCL_CACHE_DIR="$dir/cache/pocl"
mkdir -p "$POCL_CACHE_DIR" "$dir/good" "$dir/out"
make_sequence "$program" "$dir" "$frames" 320x180

# shade FOLDER [FLAGS]
shade() {
    folder=$1
    shift
    "$program" shade "$dir/in.####.exr" -o "$folder/out.####.exr" --scene "$dir/scene.toml" -q \
        --json "$dir/report.json" "$@" >"$dir/said" 2>&1
}

# Begins a run into $dir/out and halts it when its first output is there.
begin() {
    rm -rf "$dir/out"
    mkdir "$dir/out"
    "$program" shade "$dir/in.####.exr" -o "$dir/out/out.####.exr" --scene "$dir/scene.toml" -q \
        --json "$dir/report.json" "$@" >"$dir/said" 2>&1 &
    running=$!
    until [ -e "$dir/out/out.0001.exr" ]; do
        kill -0 "$running" 2>/dev/null || fail "ended before its first output: $(cat "$dir/said")"
        sleep 0.01
    done
    kill -STOP "$running"
    there=$(find "$dir/out" -name 'out.*' | wc -l)
    [ "$there" -lt $((frames - 8)) ] || fail "halted too late, after $there frames"
}

# Lets the run go on to its end.
go_on() {
    kill -CONT "$running"
    code_of wait "$running"
    running=
}

# counted FAILED
counted() {
    grep -q "$1 of $frames frames failed" "$dir/said" || fail "$1 frames are not counted: $(cat "$dir/said")"
    [ "$(grep -c '"status": "error"' "$dir/report.json")" -eq "$1" ] || fail "the report does not count $1"
}

update_all() {
    code_of shade "$dir/out" -u
    expect 0 "-u: $(cat "$dir/said")"
    same_images "$dir/good" "$dir/out"
}

shade "$dir/good" || fail "a run left in peace: $(cat "$dir/said")"

say "three inputs vanish in mid-run"
begin
mkdir "$dir/away"
mv "$dir/in.0038.exr" "$dir/in.0039.exr" "$dir/in.0040.exr" "$dir/away"
go_on
expect 4 "vanished inputs: $(cat "$dir/said")"
for frame in 38 39 40; do
    grep -q "frame $frame: .*in.00$frame.exr" "$dir/said" || fail "frame $frame is not named: $(cat "$dir/said")"
done
counted 3
no_temporaries "$dir/out"
whole_images "$dir/good" "$dir/out"
[ "$(find "$dir/out" -name 'out.*' | wc -l)" -eq $((frames - 3)) ] || fail "too few outputs"
mv "$dir"/away/* "$dir"
update_all

say "the same with --skip-bad-frames"
begin --skip-bad-frames
mv "$dir/in.0040.exr" "$dir/away"
go_on
expect 4 "a bad frame skipped: $(cat "$dir/said")"
grep -q "1 of $frames frames failed.*40" "$dir/said" || fail "frame 40 is not named: $(cat "$dir/said")"
mv "$dir"/away/* "$dir"
update_all

say "an input is cut short in mid-run"
cp "$dir/in.0040.exr" "$dir/whole.exr"
cp "$dir/in.0040.exr" "$dir/cut.exr" # the others share their bytes
mv "$dir/cut.exr" "$dir/in.0040.exr"
begin
truncate -s 20000 "$dir/in.0040.exr"
go_on
expect 4 "an input cut short: $(cat "$dir/said")"
grep -q "frame 40: .*in.0040.exr" "$dir/said" || fail "frame 40 is not named: $(cat "$dir/said")"
counted 1
[ ! -e "$dir/out/out.0040.exr" ] || fail "an output of half an input"
mv "$dir/whole.exr" "$dir/in.0040.exr"
update_all

say "the output folder is moved away in mid-run"
begin
mv "$dir/out" "$dir/moved"
go_on
expect 4 "a vanished folder: $(cat "$dir/said")"
[ ! -e "$dir/out" ] || fail "the folder was made again"
whole_images "$dir/good" "$dir/moved"
counted $((frames - $(find "$dir/moved" -name 'out.*' | wc -l)))
mv "$dir/moved" "$dir/out"
update_all

say "a folder without permission to write"
rm -rf "$dir/out"
mkdir "$dir/out"
if [ "$(id -u)" -eq 0 ]; then
    # Another user needs a way to the program, and folders of its own.
    cp "$program" "$dir/clshade"
    chmod 755 "$dir" "$dir/clshade"
    chown -R nobody "$dir/cache"
    mkdir "$dir/theirs"
    chown nobody "$dir/theirs"
    code_of setpriv --reuid=nobody --clear-groups "$dir/clshade" shade "$dir/in.####.exr" -o "$dir/out/out.####.exr" \
        --scene "$dir/scene.toml" -q --json "$dir/theirs/report.json" >"$dir/said" 2>&1
    mv "$dir/theirs/report.json" "$dir/report.json"
else
    chmod 555 "$dir/out"
    code_of shade "$dir/out"
    chmod 755 "$dir/out"
fi
expect 1 "a folder that may not be written: $(cat "$dir/said")"
[ "$(find "$dir/out" -type f | wc -l)" -eq 0 ] || fail "something was written"
grep -q 'frame 1: .*out' "$dir/said" || fail "frame 1 is not named: $(cat "$dir/said")"
say "passed"
