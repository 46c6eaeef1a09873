#!/bin/sh
# Ten processes at once on one cold cache, each with the whole sequence and a folder of its own; then ten that share one
# folder and split the frames. All end well with the same bytes; the cache holds whole entries that later runs take.
#
#   cold_cache.sh PROGRAM [ROUNDS=1]
set -eu
# shellcheck source-path=SCRIPTDIR source=common.sh
. "$(dirname "$0")/common.sh"
[ $# -ge 1 ] || { echo "usage: $0 PROGRAM [ROUNDS=1]" >&2; exit 2; }
program=$(program_of "$1")
rounds=${2:-1}

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

use_cache() {
    export XDG_CACHE_HOME="$1" POCL_CACHE_DIR="$1/pocl"
    mkdir -p "$POCL_CACHE_DIR"
}

# entries FOLDER: clshade's own files there, which carry checksums of their own. Drivers put paths into programs, so bytes
# differ.
entries() {
    (cd "$1" && find clshade -type f | sort)
}

# Kernels and the maps of an environment: the demo's scene needs both.
use_cache "$dir/alone"
make_sequence "$program" "$dir" 20 128x72
rm -rf "$dir/alone"
use_cache "$dir/alone"
mkdir "$dir/good"
"$program" shade "$dir/in.####.exr" -o "$dir/good/out.####.exr" --scene "$dir/demo/scene.toml" -q ||
    fail "one process alone"
entries "$dir/alone" >"$dir/entries"
[ -s "$dir/entries" ] || fail "one process alone leaves nothing in the cache"

# ten KIND: ten processes at once; KIND is `whole` or `chunks`.
ten() {
    process=0
    started=
    while [ "$process" -lt 10 ]; do
        process=$((process + 1))
        out="$dir/$1.$process"
        chunk=1/1
        if [ "$1" = chunks ]; then
            out="$dir/chunks"
            chunk=$process/10
        fi
        mkdir -p "$out"
        "$program" shade "$dir/in.####.exr" -o "$out/out.####.exr" --scene "$dir/demo/scene.toml" --threads 1 \
            --chunk "$chunk" -v --json "$dir/$1.$process.json" >"$dir/$1.$process.said" 2>&1 &
        started="$started $!"
    done
    process=0
    for id in $started; do
        process=$((process + 1))
        code_of wait "$id"
        expect 0 "process $process of ten: $(cat "$dir/$1.$process.said")"
        ! grep -i 'warning' "$dir/$1.$process.said" || fail "process $process warns"
    done
}

round=0
while [ "$round" -lt "$rounds" ]; do
    round=$((round + 1))
    say "round $round: ten processes, ten folders, one cold cache"
    use_cache "$dir/shared.$round"
    ten whole
    process=0
    while [ "$process" -lt 10 ]; do
        process=$((process + 1))
        same_images "$dir/good" "$dir/whole.$process"
    done
    [ "$(find "$dir/shared.$round/clshade" -name '*.tmp' | wc -l)" -eq 0 ] || fail "temporaries are left in the cache"
    entries "$dir/shared.$round" | diff "$dir/entries" - || fail "the cache does not hold what one process leaves there"

    say "round $round: ten processes, one folder, ten chunks, one cold cache"
    use_cache "$dir/split.$round"
    ten chunks
    same_images "$dir/good" "$dir/chunks"
    entries "$dir/split.$round" | diff "$dir/entries" - || fail "the cache does not hold what one process leaves there"

    say "round $round: the cache is taken"
    rm -rf "$dir/whole.1" "$dir/chunks"
    ten whole
    grep -q 'kernel from the cache' "$dir/whole.1.said" || fail "the kernel is not from the cache: $(cat "$dir/whole.1.said")"
    grep -q 'environment from the cache' "$dir/whole.1.said" || fail "the environment is not from the cache"
    same_images "$dir/good" "$dir/whole.1"
    rm -rf "$dir"/whole.*
done
say "passed"
