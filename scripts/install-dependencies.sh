#!/usr/bin/env bash
# Installs the Debian packages that Plumbline builds and runs with; does nothing where all are there.
#   scripts/install-dependencies.sh          install what is missing (asks sudo for rights where needed)
#   scripts/install-dependencies.sh --list   print the packages, one a line
set -euo pipefail

packages=(
    # tools
    g++ cmake ninja-build ccache pkg-config python3 python3-glad git ca-certificates
    # rendering
    libembree-dev libtbb-dev libosmesa6-dev libegl-dev libgl-dev libopengl-dev libegl1 libegl-mesa0 libgl1-mesa-dri libglm-dev
    # files
    libopenimageio-dev openimageio-tools libopenexr-dev libassimp-dev libtomlplusplus-dev nlohmann-json3-dev
    # program
    libcli11-dev libfmt-dev libxxhash-dev zlib1g-dev libjs-chart.js librsvg2-dev fonts-dejavu-core
    # tests and benchmarks
    libgtest-dev libgmock-dev libbenchmark-dev
)
# The report page is also tried in a real browser; the tests that need it are skipped where it cannot be had.
browser_packages=(chromium)

if [[ "${1:-}" == "--list" ]]; then
    printf '%s\n' "${packages[@]}" "${browser_packages[@]}"
    exit 0
fi

missing_of() {
    for package in "$@"; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || echo "$package"
    done
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    echo "install-dependencies: this script knows Debian and its relatives only. Install these yourself:" >&2
    printf '  %s\n' "${packages[@]}" >&2
    exit 3
fi

mapfile -t missing < <(missing_of "${packages[@]}")
mapfile -t missing_browser < <(missing_of "${browser_packages[@]}")
if [[ ${#missing[@]} -eq 0 && ${#missing_browser[@]} -eq 0 ]]; then
    exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
        echo "install-dependencies: these packages are missing, and neither root rights nor sudo are at hand: ${missing[*]}" >&2
        exit 3
    fi
    as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)
"${apt[@]}" update >/dev/null
if [[ ${#missing[@]} -gt 0 ]]; then
    echo "Installing: ${missing[*]}"
    "${apt[@]}" install --no-install-recommends "${missing[@]}" >/dev/null
fi
if [[ ${#missing_browser[@]} -gt 0 ]]; then
    echo "Installing: ${missing_browser[*]}"
    "${apt[@]}" install --no-install-recommends "${missing_browser[@]}" >/dev/null ||
        echo "install-dependencies: no ${missing_browser[*]}; the browser tests will be skipped" >&2
fi
