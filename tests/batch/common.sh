# Read by the scripts beside it.
# shellcheck shell=sh

test_name=$(basename "$0" .sh)

fail() {
    echo "$test_name: FAILED: $*" >&2
    exit 1
}

# Nothing was tested; 77 is what ctest and automake take for that.
skip() {
    echo "$test_name: skipped: $*" >&2
    exit 77
}

say() {
    echo "$test_name: $*"
}

# needs COMMAND PACKAGE
needs() {
    command -v "$1" >/dev/null || skip "$1 is missing; apt-get install $2"
}

# The program under test by its full path.
program_of() {
    [ -x "$1" ] || fail "$1: no such program"
    echo "$(cd "$(dirname "$1")" && pwd)/$(basename "$1")"
}

# One light, one material: a kernel that is built in half a second.
simple_scene() {
    cat >"$1" <<'SCENE'
version = 1
[[light]]
type = "distant"
direction = [0.3, -0.5, -0.8]
irradiance = 3.0
[material.default]
specular = { model = "blinn_phong", f0 = "f0", shininess = 32 }
diffuse = { model = "lambert", albedo = "albedo" }
SCENE
}

# make_sequence PROGRAM FOLDER FRAMES WxH: FOLDER/in.0001.exr ... and scene.toml. Four frames are rendered, the others are
# further names of them.
make_sequence() {
    "$1" demo "$2/demo" --frames 4 --size "$4" -q >/dev/null || fail "clshade demo"
    frame=0
    while [ "$frame" -lt "$3" ]; do
        ln "$2/demo/gbuffer.$(printf %04d $((frame % 4 + 1))).exr" "$2/in.$(printf %04d $((frame + 1))).exr"
        frame=$((frame + 1))
    done
    simple_scene "$2/scene.toml"
}

# The exit code of a command, for `set -e`.
code_of() {
    code=0
    "$@" || code=$?
}

# expect CODE WHAT: the last code_of.
expect() {
    [ "$code" -eq "$1" ] || fail "$2: exit code $code, not $1"
}

# same_images EXPECTED FOLDER: the same names and the same bytes, nothing else in the folder.
same_images() {
    diff -rq "$1" "$2" || fail "$2 is not $1"
    no_temporaries "$2"
}

no_temporaries() {
    left=$(find "$1" -name '*.tmp' | wc -l)
    [ "$left" -eq 0 ] || fail "$1: $left temporary files are left: $(find "$1" -name '*.tmp' | head -n 3)"
}

# whole_images EXPECTED FOLDER: what is there under a real name is as it should be; some may be missing.
whole_images() {
    for image in "$2"/*.exr; do
        [ -e "$image" ] || continue
        cmp -s "$image" "$1/$(basename "$image")" || fail "$image is not whole"
    done
}

# Read from the first to the last pixel by an OpenEXR that is not clshade's.
readable() {
    find "$1" -name '[!.]*.exr' >"$1.list"
    [ -s "$1.list" ] || return 0
    xargs oiiotool --hash <"$1.list" >"$1.read" 2>&1 || fail "oiiotool cannot read: $(grep -i error "$1.read")"
}
