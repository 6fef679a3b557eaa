#!/usr/bin/env bash
# Installs what is missing, builds the programs, bakes the built-in scene, relights it, compares it with brute force.
# ./demo.sh [--no-window]     pictures and report go to build/demo; a window opens at the end where there is a display
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

window=yes
case "${1:-}" in
  --no-window) window=no ;;
  "") ;;
  *) echo "demo.sh: $1: unknown option: expected --no-window or nothing" >&2; exit 2 ;;
esac
[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || window=no

say() { printf '\n== %s\n' "$*"; }

say "setting up and building (the first time takes minutes)"
scripts/setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target chiaro-precompute chiaro-view chiaro-report
bin=build/release/bin
out=build/demo
mkdir -p "$out"

say "baking the built-in scene"
"$bin/chiaro-precompute" builtin:ornament --clusters 1024 --functions 512 --bytes 200 -o "$out/ornament.glb" --json "$out/bake.json"

say "relighting it"
picture() {
  local name=$1
  shift
  "$bin/chiaro-view" "$out/ornament.glb" --headless --size 720x450 --supersample 2 "$@" -o "$out/$name.png" --quiet
  printf '%s\n' "$out/$name.png"
}
for environment in sunny overcast windows; do
  picture "$environment" --environment "$environment"
done
picture sunny_turned --environment sunny --rotate-environment-deg 120
picture sunny_rough --environment sunny --roughness 0.7
picture sunny_ward_metal --environment sunny --model ward --roughness 0.4 --metallic 1
picture windows_polished_metal --environment windows --roughness 0.15 --metallic 1
picture sunny_shower_begins --environment sunny --animate wetness --start 0.8
picture sunny_soaked --environment sunny --animate wetness --start 2
"$bin/chiaro-view" "$out/ornament.glb" --headless --environment sunny --size 720x450 --frames 3 --json "$out/timings.json" --quiet

say "comparing it with brute force"
"$bin/chiaro-report" "$out/ornament.glb" -o "$out/report"

say "done"
cat <<END
pictures   $out/*.png
report     $out/report/index.html   each picture beside its brute-force reference, with error maps and figures
figures    $out/bake.json  $out/timings.json

next       $bin/chiaro-view $out/ornament.glb
your own   $bin/chiaro-precompute scene.glb -o baked.glb
           $bin/chiaro-view baked.glb --environment sky.hdr
END
if [ "$window" = yes ]; then
  say "opening the viewer (close its window to end; --no-window leaves this out)"
  exec "$bin/chiaro-view" "$out/ornament.glb" --animate wetness --moving knot
fi
