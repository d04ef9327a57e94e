#!/usr/bin/env bash
# Installs what is missing on this machine, and says what and why:
#
#   tools/setup.sh run     what the command line needs: compilers, the Vulkan loader, a Vulkan driver, X11's libraries for its window
#   tools/setup.sh window  that, and what the tests of windows need: validation layers, a screen that needs no monitor
#   tools/setup.sh test    that, and what the other tests need: shader compilers, a browser
#
# On Debian 12 as root it installs by apt-get. Anywhere else it says what to install. Running it again is free.
set -euo pipefail

mode="${1:-run}"
if [[ "$mode" != run && "$mode" != test && "$mode" != window ]]; then
    echo "usage: tools/setup.sh [run|test|window]" >&2
    exit 2
fi

# Whether any of the files is there.
any_file() {
    local file
    for file in "$@"; do [[ -e "$file" ]] && return 0; done
    return 1
}

# Whether a Vulkan file of this kind (icd.d, explicit_layer.d) and name is in one of the loader's folders.
vulkan_file() {
    any_file /usr/share/vulkan/$1/$2 /usr/local/share/vulkan/$1/$2 /etc/vulkan/$1/$2 \
        "${HOME:-/root}"/.local/share/vulkan/$1/$2
}

has_program() { command -v "$1" >/dev/null; }
has_shared_library() { PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -F "$1" >/dev/null; }
has_driver() { [[ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]] || vulkan_file icd.d '*.json'; }
has_radv() { vulkan_file icd.d 'radeon_icd*.json'; }
has_layer() { [[ -n "${VK_LAYER_PATH:-}" ]] || vulkan_file explicit_layer.d '*khronos_validation*.json'; }
# The validator is a program, whichever library the compiler is linked with.
has_spirv_tools() { has_program spirv-val && has_library libSPIRV-Tools-opt.a; }
has_header() { any_file "/usr/include/$1" "/usr/local/include/$1"; }
has_matplotlib() { python3 -c "import matplotlib" 2>/dev/null || /usr/bin/python3 -c "import matplotlib" 2>/dev/null; }
has_c_library() { any_file "/usr/lib/$(uname -m)-linux-gnu/crt1.o" /usr/lib64/crt1.o /usr/lib/crt1.o; }
has_library() {
    [[ -n "${SHADERC_LIB_DIR:-}" ]] || any_file "/usr/lib/$(uname -m)-linux-gnu/$1" "/usr/lib64/$1" "/usr/lib/$1"
}

# The Rust toolchain is not ours to install.
if ! has_program cargo && [[ ! -x "${HOME:-/root}/.cargo/bin/cargo" ]]; then
    cat >&2 <<'MESSAGE'
error: Rust is not installed (no `cargo`). Install its stable toolchain, 1.88 or later: with rustup, Rust's own
installer, or from your distribution if it has one that new. Then run this again.
MESSAGE
    exit 1
fi

# What is needed, Debian's package for it, and what for.
missing=()
reasons=()
need() { # package, reason, check and its arguments
    local package="$1" reason="$2"
    shift 2
    if ! "$@"; then
        missing+=("$package")
        reasons+=("$(printf '  %-26s %s' "$package" "$reason")")
    fi
}
need gcc "links Rust programs" has_program cc
need g++ "compiles the library that reads compressed meshes" has_program c++
need libc6-dev "the C library, for linking" has_c_library
need libvulkan1 "the Vulkan loader" has_shared_library libvulkan.so.1
need mesa-vulkan-drivers "a Vulkan driver; it computes on the CPU where there is no GPU" has_driver
need libx11-xcb1 "the X11 library, for the viewer's window" has_shared_library libX11-xcb.so.1
need libxcursor1 "its cursors" has_shared_library libXcursor.so.1
need libxi6 "its input" has_shared_library libXi.so.6
need libxkbcommon-x11-0 "its keyboards" has_shared_library libxkbcommon-x11.so.0
if [[ "$mode" != run ]]; then
    need vulkan-validationlayers "finds wrong use of Vulkan in every GPU test" has_layer
    need xvfb "a screen that needs no monitor" has_program Xvfb
fi
if [[ "$mode" == test ]]; then
    has_driver && need mesa-vulkan-drivers "the compiler whose statistics are held against those checked in" has_radv
    need libshaderc-dev "the shader compiler" has_library libshaderc_combined.a
    need glslang-dev "a part of it" has_library libMachineIndependent.a
    need spirv-tools "another part of it, and the SPIR-V validator" has_spirv_tools
    need glslang-tools "a second shader compiler, for the GLSL library's check" has_program glslangValidator
    need glslc "the first as a program, for the same" has_program glslc
    need libvulkan-dev "Vulkan's headers, for the host in C++" has_header vulkan/vulkan.h
    need pkg-config "finds the C library" has_program pkg-config
    need cmake "finds it too" has_program cmake
    need make "builds what CMake says" has_program make
    need chromium "runs the exported WGSL" has_program chromium
    need python3 "tests the Python module, and what of the Blender add-on needs no Blender" has_program python3
    need python3-matplotlib "draws the charts, the page of the bench, and pictures of tables" has_matplotlib
fi

if [[ ${#missing[@]} -eq 0 ]]; then
    echo "setup: everything is installed"
    exit 0
fi
echo "setup: missing:"
printf '%s\n' "${reasons[@]}"
if ! has_program apt-get; then
    echo "error: there is no apt-get here. Install what provides the above (the names are Debian 12's)." >&2
    exit 1
fi
if [[ "$(id -u)" -ne 0 ]]; then
    echo "error: not root. Run: sudo apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
fi
echo "setup: installing by apt-get"
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq
apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
echo "setup: done"
