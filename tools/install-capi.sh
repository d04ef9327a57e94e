#!/usr/bin/env bash
# Installs the C library: header, shared and static library, and what pkg-config and CMake find it by.
#
#   tools/install-capi.sh PREFIX           builds it for release
#   tools/install-capi.sh PREFIX --debug   takes the debug build, which the tests have
set -euo pipefail

if [[ $# -lt 1 || $# -gt 2 || ( $# -eq 2 && "$2" != --debug ) ]]; then
    echo "usage: tools/install-capi.sh PREFIX [--debug]" >&2
    exit 2
fi
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
export PATH="$PATH:${HOME:-/root}/.cargo/bin"
crate="$root/crates/arealight-capi"
mkdir -p "$1"
prefix="$(cd "$1" && pwd)"

profile=release
options=(--release)
if [[ "${2:-}" == --debug ]]; then
    profile=debug
    options=()
fi
cargo build --manifest-path "$root/Cargo.toml" --locked --quiet "${options[@]}" -p arealight-capi
built="${CARGO_TARGET_DIR:-$root/target}/$profile"
abi="$(sed -n 's/^#define AREALIGHT_ABI_VERSION \([0-9]*\)$/\1/p' "$crate/include/arealight.h")"
version="$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' "$root/Cargo.toml")"
fill() { sed -e "s|@PREFIX@|$(sed 's/[&|\\]/\\&/g' <<<"$prefix")|" -e "s|@VERSION@|$version|" -e "s|@ABI@|$abi|"; }

install -Dm644 -t "$prefix/include" "$crate/include/arealight.h"
install -Dm644 -t "$prefix/lib" "$built/libarealight_capi.a"
if [[ "$(uname -s)" == Linux ]]; then
    # What is not ours to offer is no symbol for others: one object, of whose names only arealight_* are global
    parts="$(mktemp -d)"
    ld -r --whole-archive "$built/libarealight_capi.a" -o "$parts/all.o"
    objcopy --wildcard --keep-global-symbol='arealight_*' --remove-section .llvmbc --remove-section .llvmcmd \
        "$parts/all.o" "$parts/arealight.o"
    rm "$prefix/lib/libarealight_capi.a"
    ar rcs "$prefix/lib/libarealight_capi.a" "$parts/arealight.o"
    rm -r "$parts"
fi
# Programs ask the loader for the name with the ABI's version, the linker for the one without
install -Dm755 "$built/libarealight_capi.so" "$prefix/lib/libarealight_capi.so.$abi"
ln -sf "libarealight_capi.so.$abi" "$prefix/lib/libarealight_capi.so"
mkdir -p "$prefix/lib/pkgconfig" "$prefix/lib/cmake/arealight"
fill <"$crate/arealight.pc.in" >"$prefix/lib/pkgconfig/arealight.pc"
fill <"$crate/cmake/arealight-config-version.cmake.in" >"$prefix/lib/cmake/arealight/arealight-config-version.cmake"
fill <"$crate/cmake/arealight-config.cmake.in" >"$prefix/lib/cmake/arealight/arealight-config.cmake"
echo "installed arealight $version to $prefix"
# The loader looks into a list of its own, which root can renew
if ! { [[ "$(id -u)" == 0 ]] && ldconfig 2>/dev/null && ldconfig -p | grep -F "$prefix/lib/" >/dev/null; }; then
    echo "programs find the shared library with LD_LIBRARY_PATH=$prefix/lib, or after ldconfig where the loader looks there"
fi
