#!/usr/bin/env bash
# Runs the command line from a checkout: installs what is missing, builds, and passes the arguments on.
#
#   tools/run.sh                          renders scenes/gallery.glb and says where the picture is
#   tools/run.sh render SCENE.glb -o PICTURE.png
#   tools/run.sh --help
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
export PATH="$PATH:${HOME:-/root}/.cargo/bin"

# Keep the standard output for the command's own.
"$root/tools/setup.sh" run >&2

binary="${CARGO_TARGET_DIR:-$root/target}/release/arealight"
quiet=()
if [[ -x "$binary" ]]; then
    quiet=(--quiet)
else
    echo "run: building the command line; the first time takes a few minutes" >&2
fi
cargo build --manifest-path "$root/Cargo.toml" --release --locked "${quiet[@]}" -p arealight-cli
if [[ $# -eq 0 ]]; then
    set -- render "$root/scenes/gallery.glb" --shadow-noise 1
fi
exec "$binary" "$@"
