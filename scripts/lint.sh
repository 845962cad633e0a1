#!/usr/bin/env bash
# Checks layout (clang-format) and looks for mistakes (clang-tidy), both with warnings as errors.
#   scripts/lint.sh            all rooms
#   scripts/lint.sh metrics    the folders named
# Takes minutes for all rooms; needs the packages clang-format and clang-tidy, and a configured build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
rooms=("$@")
[[ ${#rooms[@]} -gt 0 ]] || rooms=(frames scenes metrics rasterizer pathtracer experiments tests)
for tool in clang-format clang-tidy; do
    command -v "$tool" >/dev/null || { echo "lint: $tool is missing (Debian package $tool)" >&2; exit 3; }
done
[[ -f build/release/compile_commands.json ]] || { echo "lint: no build/release; run scripts/build.sh first" >&2; exit 3; }

git ls-files --error-unmatch -z "${rooms[@]/%//*.h}" "${rooms[@]/%//*.cpp}" | xargs -0 clang-format --dry-run -Werror

# Clang cannot read GCC's precompiled headers, and each file has to name what it needs.
mkdir -p build/lint
sed -E 's/ -Winvalid-pch -include [^ "]+//; s/ -fpch-preprocess//' build/release/compile_commands.json >build/lint/compile_commands.json
git ls-files --error-unmatch -z "${rooms[@]/%//*.cpp}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p build/lint
