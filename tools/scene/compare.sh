#!/usr/bin/env bash
# Renders the five scenes beside their references, as docs/scenes.md shows them: tools/scene/compare.sh AREALIGHT FOLDER [SAMPLES].
# Writes SCENE.png and SCENE-reference.png, with shadows, and prints a row of the table for each scene: the root of the mean squared
# difference over the mean, of radiance without lamps' shadows and with them.
set -euo pipefail
arealight=$1 folder=$2 samples=${3:-256}
scenes=$(dirname "$0")/../../scenes
mkdir -p "$folder"
for scene in studio interior neon shop product; do
  view=(render "$scenes/$scene.glb" --size 400x225)
  stops=$("$arealight" "${view[@]}" -o "$folder/$scene.png" --exposure auto --json 2>/dev/null |
    sed -n 's/^ *"exposure": \([-+.0-9e]*\),*$/\1/p')
  "$arealight" "${view[@]}" -o "$folder/$scene-reference.png" --exposure "$stops" --reference "$samples" >"$folder/log" 2>&1
  row="| \`$scene.glb\` |"
  for shadows in off filtered:4; do
    ours=$folder/$scene-$shadows.exr reference=$folder/$scene-$shadows-reference.exr
    "$arealight" "${view[@]}" -o "$ours" --shadows "$shadows" >"$folder/log" 2>&1
    "$arealight" "${view[@]}" -o "$reference" --shadows "$shadows" --reference "$samples" >"$folder/log" 2>&1
    row+=" $("$arealight" compare "$ours" "$reference" --json | sed -n 's/^ *"\(rmse_over_mean\|mean_ratio\)": \([-+.0-9e]*\),*$/\2/p' | tr '\n' ' ')|"
  done
  echo "$row"
done
