#!/usr/bin/env bash
# Installs the C library to a scratch folder, and builds and runs the host in C++ against it: found by pkg-config and by CMake,
# shared and static. All must draw the same picture. (That it is the one that Rust draws, tests/tests/gpu/cpp_host.rs shows.)
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

"$root/tools/install-capi.sh" "$scratch/prefix" --debug
export PKG_CONFIG_PATH="$scratch/prefix/lib/pkgconfig"
# Drivers and layers of this machine may be found by the rest of it
export LD_LIBRARY_PATH="$scratch/prefix/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

# Nothing but arealight_* is offered
for names in "nm -D --defined-only $scratch/prefix/lib/libarealight_capi.so" \
    "nm -g --defined-only $scratch/prefix/lib/libarealight_capi.a"; do
    offered="$($names | awk 'NF == 3 { print $3 }')"
    if grep -v '^arealight_' <<<"$offered" || [[ "$(wc -l <<<"$offered")" -lt 30 ]]; then
        echo "error: $names: names that are not ours, or too few" >&2
        exit 1
    fi
done
# The header by the standards that it says
for standard in "cc -xc -std=c99" "c++ -xc++ -std=c++11"; do
    $standard -pedantic -Wall -Wextra -Werror -fsyntax-only "$scratch/prefix/include/arealight.h"
done

# shellcheck disable=SC2046 # flags are words
c++ -std=c++14 -ffp-contract=off "$root/examples/cpp/host.cpp" -o "$scratch/host" \
    $(pkg-config --cflags --libs arealight vulkan)
cmake -S "$root/examples/cpp" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" >"$scratch/cmake.log" ||
    { cat "$scratch/cmake.log"; exit 1; }
cmake --build "$scratch/build" >"$scratch/cmake.log" || { cat "$scratch/cmake.log"; exit 1; }
# A version that is not installed must not be found
mkdir "$scratch/later"
sed 's/find_package(arealight 0.1 /find_package(arealight 0.99 /' "$root/examples/cpp/CMakeLists.txt" \
    >"$scratch/later/CMakeLists.txt"
if cmake -S "$scratch/later" -B "$scratch/later/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" >"$scratch/cmake.log" 2>&1 ||
    ! grep -q 'version "0.99"' "$scratch/cmake.log"; then
    echo "error: CMake takes any version of Arealight" >&2
    exit 1
fi

if ! said="$("$scratch/host" "$scratch/pkg-config.pfm" --validate core 2>&1)"; then
    # -9: the loader has no driver
    if [[ "${AREALIGHT_REQUIRE_GPU:-}" != 1 && "$said" =~ "no Vulkan device"|"vkCreateInstance failed: -9" ]]; then
        echo "three builds of the host; none was run: there is no Vulkan device (tools/setup.sh run installs a driver)"
        exit 0
    fi
    echo "$said" >&2
    exit 1
fi
"$scratch/build/host" "$scratch/shared.pfm"
# It has the library inside
LD_LIBRARY_PATH="${LD_LIBRARY_PATH#"$scratch/prefix/lib"}" "$scratch/build/host_static" "$scratch/static.pfm"
"$scratch/host" "$scratch/recorder.pfm" --recorder
for other in shared recorder static; do cmp "$scratch/pkg-config.pfm" "$scratch/$other.pfm"; done
echo "three builds of the host draw the same picture, as the recorder does"
