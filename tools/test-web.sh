#!/usr/bin/env bash
# Runs the exported WGSL in a browser, Chromium without a screen, whose WebGPU is SwiftShader's, on the CPU:
#
#   tools/test-web.sh            shades the points of examples/web/points.json there, and compares the answers with the oracle's, in float64
#   tools/test-web.sh picture    draws examples/web into target/web/picture.png
#   tools/test-web.sh serve      serves the page to a browser of yours, until it is interrupted
#
# The program `arealight` is target/debug/arealight, built if need be, or $AREALIGHT.
set -euo pipefail

mode="${1:-test}"
if [[ "$mode" != test && "$mode" != picture && "$mode" != serve ]]; then
    echo "usage: tools/test-web.sh [test|picture|serve]" >&2
    exit 2
fi
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"
arealight="${AREALIGHT:-${CARGO_TARGET_DIR:-target}/debug/arealight}"
if [[ -z "${AREALIGHT:-}" ]]; then cargo build --quiet --locked -p arealight-cli; fi

# Put the page and an export into one folder
folder="${CARGO_TARGET_DIR:-$root/target}/web"
rm -rf "$folder"
mkdir -p "$folder"
cp examples/web/* "$folder/"
"$arealight" export "$folder/export" --target webgpu --effects diffuse,glossy >/dev/null

if [[ "$mode" == serve ]]; then
    echo "http://127.0.0.1:PORT/index.html, until Ctrl+C; PORT is"
    exec python3 tools/web_server.py "$folder"
fi

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

# Opens the page in the browser, and waits for what it posts. The browser looks for nothing on the network, and its watchdog, which ends
# a driver that compiles for ten seconds, sleeps.
flags=(--headless --no-sandbox --no-first-run --disable-background-networking --disable-component-update --disable-sync --disable-quic
    --disable-gpu-watchdog --enable-unsafe-webgpu --use-webgpu-adapter=swiftshader --enable-features=Vulkan --enable-logging=stderr)
open_page_once() { # the part of the address after #, the file that what is posted goes to
    local server browser port=""
    : >"$scratch/port"
    timeout 90 python3 tools/web_server.py "$folder" "$2" >"$scratch/port" &
    server=$!
    for _ in $(seq 100); do
        port="$(cat "$scratch/port")"
        [[ -n "$port" ]] && break
        sleep 0.1
    done
    [[ -n "$port" ]] || { echo "error: tools/web_server.py does not start" >&2; return 1; }
    rm -rf "$scratch/profile"
    timeout 100 chromium "${flags[@]}" --user-data-dir="$scratch/profile" "http://127.0.0.1:$port/index.html#$1" \
        >/dev/null 2>"$scratch/browser.log" </dev/null &
    browser=$!
    wait "$server" || true
    kill "$browser" 2>/dev/null || true
    wait "$browser" 2>/dev/null || true
    [[ -s "$2" ]]
}

# Opens the page again where a browser does not come up: what is tested is what the page says, not that every start of a browser succeeds.
open_page() { # as above
    for _ in 1 2 3; do
        if open_page_once "$@"; then return 0; fi
        echo "the page posts nothing in 90 s; the browser's last words:" >&2
        tail -20 "$scratch/browser.log" >&2
    done
    return 1
}

if [[ "$mode" == picture ]]; then
    open_page post-picture "$folder/picture.png"
    echo "$folder/picture.png"
    exit 0
fi

# Compares a page's answers with the oracle's: the largest relative error of a point. float32 and a table of half floats leave 1e-4 or so
points="$folder/points.json"
compare() { # the part of the address after #
    open_page "$1" "$scratch/$1.json" || return 3
    if ! grep -q '"results"' "$scratch/$1.json"; then
        cat "$scratch/$1.json" >&2
        return 3
    fi
    "$arealight" eval "$points" --on oracle --specular-lobes one --against "$scratch/$1.json" --tolerance 1e-3
}

echo "With the table as exported:"
compare test
echo "With its first layer alone, which must differ:"
status=0
compare test-first-layer || status=$?
if [[ "$status" -ne 1 ]]; then
    echo "error: a table without its other layers is not found (exit code $status)" >&2
    exit 1
fi
echo "ok: WGSL in a browser answers as the oracle does, and a wrong table shows"
