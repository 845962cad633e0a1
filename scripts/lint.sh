#!/usr/bin/env bash
# Checks layout (clang-format) and looks for mistakes (clang-tidy), both with warnings as errors.
#   scripts/lint.sh            all rooms
#   scripts/lint.sh metrics    the folders named
# Takes half an hour for all rooms; needs the packages clang-format and clang-tidy besides what building needs.
set -euo pipefail
cd "$(dirname "$0")/.."
rooms=("$@")
[[ ${#rooms[@]} -gt 0 ]] || rooms=(frames scenes metrics rasterizer pathtracer experiments tests)
for tool in clang-format clang-tidy; do
    command -v "$tool" >/dev/null || { echo "lint: $tool is missing (Debian package $tool)" >&2; exit 3; }
done

git ls-files --error-unmatch -z "${rooms[@]/%//*.h}" "${rooms[@]/%//*.cpp}" | xargs -0 clang-format --dry-run -Werror

# Each file alone and without the precompiled headers, which clang cannot read: each has to name what it needs.
cmake --preset release -B build/lint -DPLUMBLINE_BATCHES=OFF >/dev/null
cmake --build build/lint --target plumbline_generated_headers >/dev/null
sed -i -E 's/ -Winvalid-pch -include [^ "]+//; s/ -fpch-preprocess//' build/lint/compile_commands.json
git ls-files --error-unmatch -z "${rooms[@]/%//*.cpp}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p build/lint
