#!/usr/bin/env bash
# Checks layout (clang-format) and looks for mistakes (clang-tidy), both with warnings as errors.
#   scripts/lint.sh            all rooms
#   scripts/lint.sh metrics    the folders named
# Takes about twenty minutes for all rooms on two cores; needs the packages clang-format and clang-tidy besides what
# building needs.
set -euo pipefail
cd "$(dirname "$0")/.."
rooms=("$@")
[[ ${#rooms[@]} -gt 0 ]] || rooms=(frames scenes metrics rasterizer pathtracer experiments tests)
for tool in clang-format clang-tidy; do
    command -v "$tool" >/dev/null || { echo "lint: $tool is missing (Debian package $tool)" >&2; exit 3; }
done

git ls-files --error-unmatch -z "${rooms[@]/%//*.h}" "${rooms[@]/%//*.cpp}" | xargs -0 clang-format --dry-run -Werror

# By the batch, as the release preset compiles them: what clang-tidy spends goes to their headers. Without the precompiled
# headers, which clang cannot read.
cmake --preset release -B build/lint >/dev/null
cmake --build build/lint --target plumbline_generated_headers >/dev/null
sed -i -E 's/ -Winvalid-pch -include [^ "]+//; s/ -fpch-preprocess//' build/lint/compile_commands.json
room=$(IFS='|' && echo "${rooms[*]}")
sed -nE 's/^ *"file": "(.*)",?$/\1/p' build/lint/compile_commands.json |
    grep -E "^$PWD/(build/lint/)?($room)/.*\.c(pp|xx)$" | grep -v cmake_pch |
    xargs -n 1 -P "$(nproc)" clang-tidy --quiet -p build/lint --checks=-bugprone-suspicious-include \
        --header-filter="^$PWD/($room)/"
