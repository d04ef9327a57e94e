#!/usr/bin/env bash
# Prepares the shader compiler library that xtask links, and prints the folder that holds it:
#
#   export SHADERC_LIB_DIR="$(tools/shaderc.sh)"
#   cargo run -p xtask -- shaders
#
# Debian's libshaderc_combined.a lacks glslang, and its libshaderc.so does not link; building shaderc from source
# takes a quarter of an hour. Merging Debian's static libraries into one takes two seconds. Where they are not
# found, this prints what to install and fails: set SHADERC_LIB_DIR yourself, or leave it unset and have the shaderc
# crate search or build (that needs cmake, git and python3).
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

# Respect a folder that is set already.
if [[ -n "${SHADERC_LIB_DIR:-}" ]]; then
    echo "$SHADERC_LIB_DIR"
    exit 0
fi

# The merged library lies among the build products, and is as old as they are.
target="${CARGO_TARGET_DIR:-$root/target}"
mkdir -p "$target/shaderc"
folder="$(cd "$target/shaderc" && pwd)"
combined="$folder/libshaderc_combined.a"

parts=(
    shaderc_combined glslang MachineIndependent GenericCodeGen OSDependent OGLCompiler HLSL SPIRV
    SPIRV-Tools-opt SPIRV-Tools
)
source=""
for candidate in "/usr/lib/$(uname -m)-linux-gnu" /usr/lib64 /usr/lib; do
    [[ -f "$candidate/libshaderc_combined.a" && -f "$candidate/libMachineIndependent.a" ]] && source="$candidate" && break
done
if [[ -z "$source" ]]; then
    cat >&2 <<'MESSAGE'
error: the static libraries of shaderc and glslang are not installed.
  On Debian 12:  apt-get install libshaderc-dev glslang-dev spirv-tools cmake pkg-config
  Elsewhere: set SHADERC_LIB_DIR to a folder with a complete libshaderc_combined.a (a Vulkan SDK has one).
MESSAGE
    exit 1
fi

# Merge when the system's library is newer than ours.
if [[ ! -f "$combined" || "$source/libshaderc_combined.a" -nt "$combined" ]]; then
    scratch="$(mktemp -d "$folder/merge.XXXXXX")"
    trap 'rm -rf "$scratch"' EXIT
    {
        echo "create $scratch/combined.a"
        for part in "${parts[@]}"; do
            if [[ ! -f "$source/lib$part.a" ]]; then
                echo "error: $source/lib$part.a is missing; on Debian 12: apt-get install libshaderc-dev glslang-dev spirv-tools" >&2
                exit 1
            fi
            echo "addlib $source/lib$part.a"
        done
        echo "save"
        echo "end"
    } >"$scratch/script"
    ar -M <"$scratch/script" >&2
    mv "$scratch/combined.a" "$combined"
fi

# Forget a build of the shaderc crate that found another library: it does not look again by itself.
for output in "$target"/*/build/shaderc-sys-*/output; do
    if [[ -f "$output" ]] && ! grep -qF "$folder" "$output"; then
        build="$(dirname "$output")"
        rm -rf "$build" "$(dirname "$(dirname "$build")")/.fingerprint/$(basename "$build")"
    fi
done
echo "$folder"
