#!/usr/bin/env bash
# Prints a folder with what lets Intel's and Adreno's compilers run without their hardware:
#
#   AREALIGHT_COMPILERS="$(tools/compilers.sh)" arealight bench compiled --family tgl,dg2,a660
#
# Of Debian's source of the installed Mesa: a driver and what stands for its kernel must be of one version. For Adreno the
# driver too, which Debian does not have for PCs. Takes two minutes, the first time. For the laboratory only.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
folder="$(realpath -m "${CARGO_TARGET_DIR:-$root/target}")/compilers"
parts=(src/intel/tools/libintel_noop_drm_shim.so src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so
    src/freedreno/vulkan/libvulkan_freedreno.so)
version="$(dpkg-query -f '${source:Version}' -W mesa-vulkan-drivers 2>/dev/null)" || {
    echo "error: mesa-vulkan-drivers is not installed: run tools/setup.sh on Debian 12" >&2
    exit 1
}
if [[ "$(cat "$folder/version" 2>/dev/null)" == "$version" ]]; then
    echo "$folder"
    exit 0
fi

needed=(meson ninja-build bison flex python3-mako pkg-config gcc g++ libdrm-dev libelf-dev libexpat1-dev zlib1g-dev dpkg-dev)
missing="$(dpkg-query -f '${Package} ${db:Status-Status}\n' -W "${needed[@]}" 2>&1 | grep -v ' installed$' || true)"
if [[ -n "$missing" ]]; then
    [[ "$(id -u)" -eq 0 ]] || { echo "error: not root. Run: sudo apt-get install ${needed[*]}" >&2; exit 1; }
    apt-get update -qq >&2
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${needed[@]}" >&2
fi

# Sources by lists of their own: those of the machine stay as they are
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir lists
sed 's/^Types: deb$/Types: deb-src/' /etc/apt/sources.list.d/debian.sources >sources.sources
apt=(apt-get -qq -o "Dir::Etc::SourceList=$scratch/sources.sources" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$scratch/lists" -o "APT::Sandbox::User=$(id -un)")
without=(-Dplatforms= -Dglx=disabled -Degl=disabled -Dgbm=disabled -Dopengl=false -Dgles1=disabled -Dgles2=disabled
    -Dllvm=disabled -Dgallium-drivers= -Dshared-glapi=disabled -Dzstd=disabled -Dvalgrind=disabled -Dlibunwind=disabled)
export PATH="/usr/bin:$PATH" # Debian's Python, which has mako, before any other
build() {
    "${apt[@]}" update && "${apt[@]}" source --download-only "mesa=$version" && tar xf mesa_*.orig.tar.* &&
        meson setup build mesa-*/ -Doptimization=1 -Ddebug=false "${without[@]}" \
            -Dvulkan-drivers=intel,freedreno -Dtools=intel,drm-shim && ninja -C build "${parts[@]}"
}
build >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log" >&2; exit 1; }
mkdir -p "$folder"
cp "${parts[@]/#/build/}" "$folder"
cat >"$folder/freedreno_icd.json" <<ICD
{"file_format_version": "1.0.0", "ICD": {"library_path": "$folder/libvulkan_freedreno.so", "api_version": "1.3.0"}}
ICD
echo "$version" >"$folder/version"
echo "$folder"
