#!/bin/sh
# A disk that is full after some of the frames, before the first one, and under the kernel cache. Frames that fit are
# written whole, the others are named and counted, nothing else is left; when there is room again -u does the rest.
#
#   disk_full.sh PROGRAM        as root, or where `unshare -rm` is allowed: it mounts small file systems
set -eu
# shellcheck source-path=SCRIPTDIR source=common.sh
. "$(dirname "$0")/common.sh"
[ $# -eq 1 ] || { echo "usage: $0 PROGRAM" >&2; exit 2; }
program=$(program_of "$1")

dir=$(mktemp -d)
stop() {
    trap - EXIT
    for mounted in small tiny cache; do umount "$dir/$mounted" 2>/dev/null || true; done
    rm -rf "$dir"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

mkdir "$dir/small" "$dir/tiny" "$dir/cache" "$dir/good"
if ! mount -t tmpfs -o size=64k clshade-test "$dir/cache" 2>/dev/null; then
    if [ -z "${CLSHADE_UNSHARED:-}" ] && unshare -rm true 2>/dev/null; then
        rm -rf "$dir"
        CLSHADE_UNSHARED=1 exec unshare -rm sh "$0" "$program"
    fi
    skip "may not mount a small file system; run it as root"
fi

frames=12
export XDG_CACHE_HOME="$dir/warm" POCL_CACHE_DIR="$dir/warm/pocl"
mkdir -p "$POCL_CACHE_DIR"
make_sequence "$program" "$dir" "$frames" 320x180

# shade FOLDER [FLAGS]: with what it says in $dir/said and its report in $dir/report.json.
shade() {
    folder=$1
    shift
    "$program" shade "$dir/in.####.exr" -o "$folder/out.####.exr" --scene "$dir/scene.toml" -q --json "$dir/report.json" \
        "$@" >"$dir/said" 2>&1
}

# names_and_counts FOLDER: every frame without an output is named with its number, and their number is told.
names_and_counts() {
    failed=0
    frame=1
    while [ "$frame" -le "$frames" ]; do
        if [ ! -e "$1/out.$(printf %04d "$frame").exr" ]; then
            failed=$((failed + 1))
            grep -q "frame $frame: .*out.$(printf %04d "$frame").exr" "$dir/said" ||
                fail "frame $frame is not named: $(cat "$dir/said")"
        fi
        frame=$((frame + 1))
    done
    grep -q "$failed of $frames frames failed" "$dir/said" || fail "not counted $failed: $(cat "$dir/said")"
    [ "$(grep -c '"status": "error"' "$dir/report.json")" -eq "$failed" ] || fail "the report does not count $failed"
}

code_of shade "$dir/good"
expect 0 "a run with room"
[ "$(find "$dir/good" -name 'out.*' | wc -l)" -eq "$frames" ] || fail "a run with room wrote too little"
bytes=$(find "$dir/good" -name 'out.0001.exr' -printf %s)

say "room for half of the frames"
mount -t tmpfs -o size=$((bytes * frames / 2)) clshade-test "$dir/small"
code_of shade "$dir/small"
expect 4 "a disk full in mid-run: $(cat "$dir/said")"
no_temporaries "$dir/small"
whole_images "$dir/good" "$dir/small"
names_and_counts "$dir/small"
grep -q 'No space left on device' "$dir/said" || fail "the reason is not told: $(cat "$dir/said")"
say "$((frames - failed)) of $frames frames written, the others named"

say "room again, -u"
touch "$dir/mark"
mount -o remount,size=$((bytes * frames * 2)) "$dir/small"
code_of shade "$dir/small" -u
expect 0 "-u with room: $(cat "$dir/said")"
same_images "$dir/good" "$dir/small"
[ "$(find "$dir/small" -name 'out.*' ! -newer "$dir/mark" | wc -l)" -eq $((frames - failed)) ] ||
    fail "-u shaded more than the $failed frames"

say "outputs there already, no room to replace them"
mount -o remount,size=$(($(df --output=used -B1 "$dir/small" | tail -n 1) + 16384)) "$dir/small"
code_of shade "$dir/small"
expect 1 "no frame can be replaced: $(cat "$dir/said")"
same_images "$dir/good" "$dir/small"

say "room for no frame"
mount -t tmpfs -o size=$((bytes / 2)) clshade-test "$dir/tiny"
code_of shade "$dir/tiny"
expect 1 "a disk too small for a frame: $(cat "$dir/said")"
[ "$(find "$dir/tiny" -type f | wc -l)" -eq 0 ] || fail "something is left: $(ls -A "$dir/tiny")"
names_and_counts "$dir/tiny"

say "the kernel cache on a full disk"
head -c 65536 /dev/zero >"$dir/cache/full" 2>/dev/null || true
rm "$dir"/good/*
cp -r "$dir/small/." "$dir/expected"
XDG_CACHE_HOME=$dir/cache
code_of shade "$dir/good"
expect 0 "no room for the cache: $(cat "$dir/said")"
same_images "$dir/expected" "$dir/good"
[ "$(find "$dir/cache" -type f ! -name full -size +0 | wc -l)" -eq 0 ] || fail "something cut lies in the cache"
say "passed"
