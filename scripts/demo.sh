#!/usr/bin/env bash
# Installs what is missing, builds, and runs the main job on the built-in scenes: what does the second layer buy, and what
# does it cost? Ends with a table and the path of a page. Further arguments go to `plumbline run`.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh release
build/release/bin/plumbline run experiments/one_vs_two_layers.toml --output out/one_vs_two_layers "$@"
