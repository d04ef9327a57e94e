#!/usr/bin/env bash
# Tests the Python module as it was built (cargo build -p arealight-python), and runs its notebook. Nothing is installed but what tools/setup.sh test does.
set -euo pipefail
cd "$(dirname "$0")/.."

# The interpreter that has matplotlib: another one may come first
python=
for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c "import matplotlib" 2>/dev/null; then
        python="$candidate"
        break
    fi
done
if [[ -z "$python" ]]; then
    echo "error: no Python here has matplotlib: tools/setup.sh test installs it" >&2
    exit 1
fi

# A module is found by its own name
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
ln -s "$(realpath "${CARGO_TARGET_DIR:-target}/debug/libarealight_python.so")" "$folder/arealight.abi3.so"
export PYTHONPATH="$folder" MPLCONFIGDIR="$folder"
"$python" -B tools/python/tests/test_arealight.py
"$python" -B tools/python/run_notebook.py tools/python/notebooks/fit_a_brdf.ipynb
"$python" -B tools/plots/test_plots.py
