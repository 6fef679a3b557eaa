#!/bin/sh
# Installs what building, testing and running chiaro needs, from Debian's own packages (Debian 12 and 13).
# Does nothing when everything is there. --tests: what only tests need as well (a browser for the reports' pages).
# --list prints the packages; --check only says what is missing (exit 1).
set -eu

packages="
  g++ cmake ninja-build ccache pkg-config git
  libembree-dev libeigen3-dev libopenblas-pthread-dev libopenmesh-dev libceres-dev
  libglm-dev libcli11-dev nlohmann-json3-dev libxxhash-dev liblzma-dev
  libtinygltf-dev libpng-dev libturbojpeg0-dev libopenexr-dev
  libjs-chart.js
  libepoxy-dev libegl-dev libgl-dev libglfw3-dev libimgui-dev
  libegl1 libegl-mesa0 libgl1-mesa-dri
  libgtest-dev libgmock-dev libbenchmark-dev
  xvfb xauth
"

test_packages="chromium"

say() { printf 'setup: %s\n' "$*" >&2; }

if [ "${1:-}" = --tests ]; then
  packages="$packages $test_packages"
  shift
fi
case "${1:-}" in
  --list) printf '%s\n' $packages; exit 0 ;;
  --check | "") ;;
  *) say "$1: unknown option: expected [--tests] and --list, --check or nothing"; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  say "this is not a Debian system: install the counterparts of these packages yourself:" $packages
  exit 1
fi

missing=
for package in $packages; do
  # pkg-config is a real package or one that pkgconf provides; either way dpkg knows it by this name.
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing="$missing $package"
done

if [ -z "$missing" ]; then
  say "everything is installed"
  exit 0
fi
if [ "${1:-}" = --check ]; then
  say "missing:$missing"
  exit 1
fi

if [ "$(id -u)" -eq 0 ]; then
  as_root=
elif command -v sudo >/dev/null; then
  as_root=sudo
else
  say "neither root nor sudo here: ask an administrator to run: apt-get install --no-install-recommends$missing"
  exit 1
fi

say "installing:$missing"
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -qq
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >&2
say "done"
