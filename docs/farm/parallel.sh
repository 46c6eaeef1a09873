#!/bin/sh
# Shades a sequence with GNU parallel (Debian: apt-get install parallel); several processes take parts of the frames.
#
#   parallel.sh in.####.exr out/out.####.exr --scene look.toml --frames 1-100
#
# What follows the two sequences goes to `clshade shade`. Run it again after a stop or a failure: every part goes on with
# the frame at which it stopped (-u).
#
# JOBS     processes at once. Default: a quarter of the cores, for kernels use all of a process' threads
# THREADS  of each process. Default: cores / JOBS
# CHUNKS   parts. Default: 4 * JOBS
# JOBLOG   what was done. Default: clshade.joblog; its reports lie beside it, clshade.joblog.CHUNK.json
# RESUME   1: only the parts that failed or never ran by that log (--resume-failed), for runs of thousands of parts. It
#          knows parts by their number: only with the very same files, frames and CHUNKS
# CLSHADE  the program. Default: clshade
#
# Exit code: 0, or what `parallel` says: how many parts failed (101: more than 100). The log has each one's own.
set -eu

if [ $# -lt 2 ]; then
    echo "usage: parallel.sh INPUT OUTPUT [flags of clshade shade]" >&2
    exit 2
fi
input=$1
output=$2
shift 2
cores=$(nproc)
jobs=${JOBS:-$(((cores + 3) / 4))}
threads=${THREADS:-$(((cores + jobs - 1) / jobs))}
chunks=${CHUNKS:-$((4 * jobs))}
log=${JOBLOG:-clshade.joblog}
mkdir -p "$(dirname "$output")"

resume=
if [ "${RESUME:-0}" = 1 ]; then resume=--resume-failed; fi

seq "$chunks" | parallel --will-cite --quote --jobs "$jobs" --line-buffer --tagstring "chunk {}/$chunks:" \
    --joblog "$log" ${resume:+"$resume"} --termseq TERM,5000,KILL \
    "${CLSHADE:-clshade}" shade "$input" -o "$output" --chunk "{}/$chunks" -u --threads "$threads" --progress plain \
    --json "$log.{}.json" "$@"
