#!/usr/bin/env bash
# Installs what is missing, builds and runs the tests.
#   scripts/test.sh                 all but those labelled slow
#   scripts/test.sh --slow          those as well
#   scripts/test.sh -R rasterizer   any further arguments go to ctest
# Tests on real meshes look in PLUMBLINE_SCENES; where that is not set, in ../shared/scenes; they are skipped without it.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh release

if [[ -z "${PLUMBLINE_SCENES:-}" && -d ../shared/scenes ]]; then
    PLUMBLINE_SCENES=$(cd ../shared/scenes && pwd)
    export PLUMBLINE_SCENES
fi
if [[ -z "${PLUMBLINE_SCENES:-}" ]]; then
    echo "PLUMBLINE_SCENES is not set: the tests on real meshes will be skipped."
fi

selection=(-LE slow)
if [[ "${1:-}" == "--slow" ]]; then
    selection=()
    shift
fi
ctest --preset release -j "$(nproc)" "${selection[@]}" "$@"
