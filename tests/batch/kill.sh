#!/bin/sh
# kill -9 at random moments of runs over a sequence: while the kernel is built, frames are read, shaded, written, replaced.
# After each: what has a real name is whole. Then -u goes on to the end: the result is that of a run left in peace, and
# nothing else is left behind. All the while another process reads the outputs from end to end.
#
#   kill.sh PROGRAM [MOMENTS=100] [SEED=1]       oiiotool: apt-get install openimageio-tools
set -eu
# shellcheck source-path=SCRIPTDIR source=common.sh
. "$(dirname "$0")/common.sh"
[ $# -ge 1 ] || { echo "usage: $0 PROGRAM [MOMENTS=100] [SEED=1]" >&2; exit 2; }
program=$(program_of "$1")
moments=${2:-100}
seed=${3:-1}
needs oiiotool openimageio-tools

dir=$(mktemp -d)
reader=
stop() {
    trap - EXIT
    if [ -n "$reader" ]; then kill "$reader" 2>/dev/null || true; fi
    wait
    rm -rf "$dir"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

frames=48
warm="$dir/warm"
cold="$dir/cold"
mkdir "$warm" "$dir/good" "$dir/out"
make_sequence "$program" "$dir" "$frames" 320x180

# shade CACHE FOLDER [FLAGS]
shade() {
    cache=$1
    folder=$2
    shift 2
    XDG_CACHE_HOME=$cache POCL_CACHE_DIR="$cache/pocl" exec "$program" shade "$dir/in.####.exr" -o "$folder/out.####.exr" \
        --scene "$dir/scene.toml" -q "$@"
}

# milliseconds CACHE: how long a whole run takes.
milliseconds() {
    mkdir -p "$1/pocl"
    begin=$(date +%s%N)
    (shade "$1" "$dir/good") || fail "a run left in peace"
    echo $((($(date +%s%N) - begin) / 1000000))
}
# "Every output is readable at every moment."
: >"$dir/reads"
(
    trap 'exit 0' TERM
    while :; do
        for image in "$dir"/out/out.*.exr; do
            # A second name holds what is there now, though this script empties the folder between runs.
            ln -f "$image" "$dir/look.exr" 2>/dev/null || continue
            nice oiiotool --hash "$dir/look.exr" >"$dir/read" 2>&1 || cat "$dir/read" >>"$dir/unreadable"
            echo >>"$dir/reads"
        done
        sleep 0.1
    done
) &
reader=$!

long=$(milliseconds "$warm")
short=$(milliseconds "$warm") # with the reader beside it, as later
say "$frames frames in $long ms, $short ms with a cached kernel; $moments moments, seed $seed"

early=0
midst=0
late=0
moment=0
while [ $((early + midst)) -lt "$moments" ]; do
    moment=$((moment + 1))
    [ "$moment" -le $((3 * moments)) ] || fail "most moments come too late to count"
    # One in four with a cold cache; of the others one replaces finished outputs, one goes on where a run stopped.
    cache=$warm
    length=$short
    case $((moment % 4)) in
        0)
            rm -rf "$cold" "$dir"/out/out.*
            mkdir -p "$cold/pocl"
            cache=$cold
            length=$long
            ;;
        1) rm -f "$dir"/out/out.* ;;
        2) ;; # all there: replaced
        3) rm -f "$dir/out/out.0002.exr" "$dir/out/out.0005.exr" "$dir/out/out.0007.exr" ;;
    esac
    update=
    if [ $((moment % 4)) -eq 3 ]; then update=-u; fi
    touch "$dir/mark"
    delay=$(awk -v seed="$seed$moment" -v length_="$length" 'BEGIN { srand(seed); printf "%.3f", rand() * length_ / 1000 }')
    (shade "$cache" "$dir/out" ${update:+"$update"}) 2>/dev/null &
    victim=$!
    sleep "$delay"
    kill -9 "$victim" 2>/dev/null || true
    code_of wait "$victim" 2>/dev/null
    written=$(find "$dir/out" -name 'out.*' -newer "$dir/mark" | wc -l)
    if [ "$code" -ne 137 ]; then
        [ "$code" -eq 0 ] || fail "moment $moment: exit code $code"
        late=$((late + 1))
        length=$((length * 9 / 10)) # the machine has less to do now than when it was measured
    elif [ "$written" -eq 0 ]; then
        early=$((early + 1))
        length=$((length * 26 / 25))
    else
        midst=$((midst + 1))
    fi
    if [ $((moment % 4)) -eq 0 ]; then long=$length; else short=$length; fi
    whole_images "$dir/good" "$dir/out"
    (shade "$cache" "$dir/out" -u) || fail "moment $moment ($delay s): -u: exit code $?"
    same_images "$dir/good" "$dir/out"
    [ ! -e "$dir/unreadable" ] || fail "moment $moment ($delay s): $(head -n 1 "$dir/unreadable")"
done
kill "$reader"
reader=
say "killed before the first output: $early, later: $midst; too late: $late; $(wc -l <"$dir/reads") outputs read meanwhile"
say "passed"
