#!/usr/bin/env bash
# How a run's time and memory grow: with the number of frames, with the size of a frame.
#
#   bench/batch.sh PROGRAM MAKE_SEQUENCE [time|flat|large ...]
#
# PROGRAM is clshade, MAKE_SEQUENCE the program of that name that a build with tests has beside it. Needs GNU time
# (Debian: `time`) for the peak memory as the system reports it, and in TMPDIR 1 GB (`large`: 2 GB). Without a part
# named, all three run: about a quarter of an hour on two cores. Exit code 1 if a limit is missed.
#   time   60 and 120 frames of 960x540, in turns, three times: twice the frames, twice the time within 5 %
#   flat   50 and 500 frames of 480x270: the same peak memory within 5 %
#   large  one frame of 16384x8192 under --max-mem 1024 stays below it, and its pixels are those of a run without limit
#          where 14 GB are free; 4096x2048 under --max-mem 300 likewise, anywhere
# THREADS (default 2) is what --threads gets.
set -euo pipefail

if [ $# -lt 2 ]; then
    sed -n '2,15s/^# \{0,1\}//p' "$0"
    exit 2
fi
program=$(realpath "$1")
make_sequence=$(realpath "$2")
shift 2
parts=("$@")
if [ ${#parts[@]} -eq 0 ]; then
    parts=(time flat large)
fi
threads=${THREADS:-2}
gnu_time=$(type -P time) || {
    echo "batch.sh: GNU time is missing; install Debian's package time" >&2
    exit 2
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 130' INT TERM
missed=0

cat >"$folder/scene.toml" <<'SCENE'
version = 1
[[light]]
name = "key"
type = "distant"
direction = [0.5, 0.6, -0.7]
irradiance = 3.0
SCENE

# shade OUTPUT INPUT FLAGS...: sets `seconds` and `peak` (KiB).
shade() {
    local output=$1 input=$2
    shift 2
    sync -f "$folder" # nobody pays for what another has written
    "$gnu_time" -o "$folder/time" -f '%e %M' "$program" shade "$input" -o "$output" --scene "$folder/scene.toml" \
        --device cpu --threads "$threads" -q --progress none "$@" >"$folder/log"
    read -r seconds peak <"$folder/time"
}

median() {
    printf '%s\n' "$@" | sort -n | sed -n "$((($# + 1) / 2))p"
}

# judge WHAT VALUE LIMIT: a line of the table.
judge() {
    local verdict=met
    if ! awk -v value="$2" -v limit="$3" 'BEGIN { exit !(value <= limit) }'; then
        verdict=MISSED
        missed=1
    fi
    printf '%-64s %10s   at most %8s   %s\n' "$1" "$2" "$3" "$verdict"
}

same() {
    local verdict=same
    if ! cmp -s "$2" "$3"; then
        verdict=DIFFERENT
        missed=1
    fi
    printf '%-64s %10s\n' "$1" "$verdict"
}

clear_frames() {
    find "$folder" -name '*.exr' -delete
}

grows_with_frames() {
    "$make_sequence" 960x540 120 half zip "$folder/in.%04d.exr"
    local one=() two=() ratios=()
    shade "$folder/out.%04d.exr" "$folder/in.%04d.exr" --frames 1-2 # the kernel into the cache
    for _ in 1 2 3; do
        shade "$folder/out.%04d.exr" "$folder/in.%04d.exr" --frames 1-60
        one+=("$seconds")
        shade "$folder/out.%04d.exr" "$folder/in.%04d.exr" --frames 1-120
        two+=("$seconds")
        ratios+=("$(awk -v a="${one[-1]}" -v b="$seconds" 'BEGIN { printf "%.3f", b / a }')")
    done
    printf '%-64s %10s\n' "60 frames of 960x540 [s]" "$(median "${one[@]}")"
    printf '%-64s %10s\n' "120 frames [s]" "$(median "${two[@]}")"
    judge "120 frames to 60, median of three" "$(median "${ratios[@]}")" 2.100
    clear_frames
}

stays_flat() {
    "$make_sequence" 480x270 500 half zip "$folder/in.%04d.exr"
    shade "$folder/out.%04d.exr" "$folder/in.%04d.exr" --frames 1-50
    local few=$peak
    shade "$folder/out.%04d.exr" "$folder/in.%04d.exr" --frames 1-500
    printf '%-64s %10s\n' "peak resident memory, 50 frames of 480x270 [KiB]" "$few"
    judge "peak resident memory, 500 frames [KiB]" "$peak" "$((few * 105 / 100))"
    clear_frames
}

# stays_under WxH MiB COMPARE
stays_under() {
    "$make_sequence" "$1" 1 half zip "$folder/in.%04d.exr"
    shade "$folder/banded.exr" "$folder/in.0001.exr" --max-mem "$2"
    judge "peak resident memory, $1 under --max-mem $2 [KiB]" "$peak" "$(($2 * 1024))"
    if [ "$3" = yes ]; then
        shade "$folder/whole.exr" "$folder/in.0001.exr"
        printf '%-64s %10s\n' "    without limit [KiB]" "$peak"
        same "    both files, byte for byte" "$folder/banded.exr" "$folder/whole.exr"
    fi
    clear_frames
}

is_large() {
    stays_under 4096x2048 300 yes
    local available
    available=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
    stays_under 16384x8192 1024 "$([ "$available" -gt 14000000 ] && echo yes || echo no)"
}

for part in "${parts[@]}"; do
    case $part in
    time) grows_with_frames ;;
    flat) stays_flat ;;
    large) is_large ;;
    *)
        echo "batch.sh: no part '$part'; there are time, flat and large" >&2
        exit 2
        ;;
    esac
done
exit "$missed"
