#!/usr/bin/env bash
# Installs what is missing and builds one preset: scripts/build.sh [release|debug|asan-ubsan|tsan]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
scripts/install-dependencies.sh
cmake --preset "$preset" >/dev/null  # errors and warnings still show: they go to the standard error stream
cmake --build --preset "$preset"
