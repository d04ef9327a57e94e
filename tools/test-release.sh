#!/usr/bin/env bash
# Makes the archives of a release of the debug build, unpacks them elsewhere, and uses each as who downloads it does.
set -euo pipefail
cd "$(dirname "$0")/.."
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

tools/release.sh "$folder/made" --debug
(cd "$folder/made" && sha256sum --check --quiet SHA256SUMS)
mkdir "$folder/here"
for archive in "$folder"/made/*.tar.gz; do tar -C "$folder/here" -xzf "$archive"; done
cd "$folder/here"

# The program, with what lies beside it
program=(arealight-[0-9]*)
"${program[0]}/arealight" --version
"${program[0]}/arealight" effects "${program[0]}/scenes/room.glb" | grep -q "two_sided" # glTF is read
bash -n "${program[0]}/completions/arealight.bash"
[[ -s "${program[0]}/man/arealight-render.1" ]]

# The C library, found where it was unpacked
library=(arealight-c-*)
cat >version.c <<'C'
#include <arealight.h>
int main(void) { return arealight_abi_version() == AREALIGHT_ABI_VERSION ? 0 : 1; }
C
export PKG_CONFIG_PATH="$PWD/${library[0]}/lib/pkgconfig"
# shellcheck disable=SC2046 # options are words
cc version.c $(pkg-config --cflags --libs arealight) -o version
LD_LIBRARY_PATH="$PWD/${library[0]}/lib" ./version

# The GLSL library, as a host's compiler takes it
glsl=(arealight-glsl-*)
glslangValidator --target-env vulkan1.1 -S comp -I"${glsl[0]}/include" "${glsl[0]}/examples/deferred.comp" -o deferred.spv >/dev/null
# The page, with what it loads
web=(arealight-web-*)
[[ -s "${web[0]}/index.html" && -s "${web[0]}/film.gif" && -s "${web[0]}/export/webgpu/shade.wgsl" ]]
echo "every archive is what it says: good"
