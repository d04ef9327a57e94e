#!/usr/bin/env bash
# Makes what a release has, for this machine's system, into a folder:
#
#   tools/release.sh DIR             arealight-VERSION-SYSTEM.tar.gz      the program, with the viewer, completions, manual pages and scenes
#                                    arealight-c-VERSION-SYSTEM.tar.gz    the C library, shared and static, with its header and guide
#                                    arealight-glsl-VERSION.tar.gz        the GLSL library, tables and SPIR-V: what `arealight export` writes
#                                    arealight-web-VERSION.tar.gz         a page with lamps to drag, for any host of static files
#                                    arealight-VERSION-*.whl              the Python module
#                                    SHA256SUMS
#   tools/release.sh DIR --no-wheel  without the last but one, which takes maturin: pip install maturin
#   tools/release.sh DIR --publish   beside that, says what `cargo publish` would upload, in order
#   tools/release.sh DIR --debug     of the debug build as it is, without the wheel: to test this
#
# Nothing is uploaded. The checkout must be as it was committed, and CHANGELOG.md must have a date for this version.
set -euo pipefail
usage() {
    sed -n '2,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" | sed '/^set -/d' >&2
    exit 2
}

[[ $# -ge 1 && "$1" != -* ]] || usage
out="$(realpath -m "$1")"
shift
wheel=true publish=false debug=false
for option in "$@"; do
    case "$option" in
        --no-wheel) wheel=false ;;
        --publish) publish=true ;;
        --debug) debug=true wheel=false ;;
        *) usage ;;
    esac
done
cd "$(dirname "$0")/.."
root="$PWD"
version="$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)"
system="$(rustc -vV | sed -n 's/^host: //p')"

# Refuse what could not be made again
if [[ "$debug" == false ]]; then
    if [[ -n "$(git status --porcelain)" ]]; then
        echo "error: the checkout has changes that are not committed" >&2
        exit 1
    fi
    if grep -q "^## $version (unreleased)" CHANGELOG.md || ! grep -q "^## $version" CHANGELOG.md; then
        echo "error: CHANGELOG.md has no date for $version: write '## $version (YYYY-MM-DD)'" >&2
        exit 1
    fi
fi
if [[ "$wheel" == true ]] && ! command -v maturin >/dev/null; then
    echo "error: maturin is not installed: pip install maturin, or --no-wheel" >&2
    exit 1
fi
mkdir -p "$out"
out="$(cd "$out" && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

# Archives are the same for the same files: names in order, one time, no owner
archive() { # name of the folder in the scratch folder
    tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(git log -1 --format=%ct)" \
        -C "$scratch" -cf - "$1" | gzip "$packing" >"$out/$1.tar.gz"
    echo "wrote $out/$1.tar.gz"
}

if [[ "$debug" == true ]]; then
    profile=debug packing=-1n c_options=(--debug)
else
    profile=release packing=-9n c_options=()
    cargo build --locked --quiet --release -p arealight-cli
fi
program="${CARGO_TARGET_DIR:-$root/target}/$profile/arealight"

# The program
name="arealight-$version-$system"
mkdir -p "$scratch/$name/completions" "$scratch/$name/man" "$scratch/$name/scenes"
install -m755 "$program" "$scratch/$name/arealight"
for shell in bash zsh fish; do "$program" completions "$shell" >"$scratch/$name/completions/arealight.$shell"; done
"$program" man "$scratch/$name/man" >/dev/null
install -m644 README.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT "$scratch/$name"
install -m644 scenes/*.glb "$scratch/$name/scenes"
archive "$name"

# The C library
name="arealight-c-$version-$system"
tools/install-capi.sh "$scratch/$name" "${c_options[@]}" >/dev/null
# It is found where it is unpacked
sed -i "s|$scratch/$name|\${pcfiledir}/../..|" "$scratch/$name/lib/pkgconfig/arealight.pc"
install -m644 docs/embed-c.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT "$scratch/$name"
archive "$name"

# The GLSL library
name="arealight-glsl-$version"
"$program" export "$scratch/$name" >/dev/null
install -m644 docs/embed-glsl.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT "$scratch/$name"
archive "$name"

# The page
name="arealight-web-$version"
AREALIGHT="$program" tools/test-web.sh folder
cp -r "${CARGO_TARGET_DIR:-$root/target}/web" "$scratch/$name"
archive "$name"

# The Python module
if [[ "$wheel" == true ]]; then
    (cd tools/python && maturin build --locked --release --quiet --out "$out")
    echo "wrote $out/$(cd "$out" && ls arealight-"$version"-*.whl)"
fi

(cd "$out" && sha256sum arealight-*"$version"* >SHA256SUMS)
echo "wrote $out/SHA256SUMS"
if [[ "$publish" == true ]]; then
    echo "to publish, in this order:"
    for crate in arealight arealight-table arealight-oracle arealight-fit arealight-vk arealight-capi; do
        echo "  cargo publish -p $crate"
    done
fi
