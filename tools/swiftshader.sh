#!/usr/bin/env bash
# Prints the manifest of a second Vulkan driver that needs no GPU, SwiftShader, for the loader:
#
#   VK_ICD_FILENAMES="$(tools/swiftshader.sh)" target/debug/arealight devices
#
# Debian's `chromium-common` package has it: the installed one is taken, else the package is downloaded (32 MB) and the
# driver's two files are taken out of it, into the build's folder. Nothing is installed. For tests only: no part of the
# product.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
manifest=vk_swiftshader_icd.json
library=libvk_swiftshader.so

# Whether a folder holds the driver; its manifest names the library beside it.
has_driver() { [[ -s "$1/$manifest" && -s "$1/$library" ]]; }

folder="${CARGO_TARGET_DIR:-$root/target}/swiftshader"
for candidate in /usr/lib/chromium "$folder"; do
    if has_driver "$candidate"; then
        echo "$(cd "$candidate" && pwd)/$manifest"
        exit 0
    fi
done
if ! command -v apt-get >/dev/null || ! command -v dpkg-deb >/dev/null; then
    echo "error: SwiftShader is not here, and there is no apt-get to fetch Debian's chromium-common, which has it" >&2
    exit 1
fi

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
# As the caller: apt's own user may not write to the folder, and says so
(cd "$scratch" && apt-get download -qq -o "APT::Sandbox::User=$(id -un)" chromium-common >&2)
mkdir -p "$folder"
dpkg-deb --fsys-tarfile "$scratch"/chromium-common_*.deb |
    tar -x -C "$folder" --strip-components=4 "./usr/lib/chromium/$library" "./usr/lib/chromium/$manifest"
has_driver "$folder" || { echo "error: Debian's chromium-common has no SwiftShader" >&2; exit 1; }
echo "$(cd "$folder" && pwd)/$manifest"
