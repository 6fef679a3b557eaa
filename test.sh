#!/usr/bin/env bash
# Installs what is missing, builds everything, runs every test.
# ./test.sh [ctest options]          e.g. ./test.sh -R structure, ./test.sh -LE slow
# CHIARO_PRESET=asan ./test.sh       another preset of CMakePresets.json (default release)
# CHIARO_ALLOWED_SKIPS=REGEX         a skipped test or case whose name does not match fails the run (default: any may skip)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
preset=${CHIARO_PRESET:-release}

scripts/setup.sh --tests
cmake --preset "$preset"
cmake --build --preset "$preset"

results="$PWD/build/$preset/test_results.xml"
rm -f "$results"
status=0
ctest --preset "$preset" --output-junit "$results" --test-output-size-passed 16000000 "$@" || status=$?
[ -s "$results" ] || { echo "test.sh: no test ran" >&2; exit 1; }

# count PATTERN: lines of the results that match.
count() { grep -cE -- "$1" "$results" || true; }
total=$(count '<testcase ')
failed=$(count '<testcase .* status="fail"')
# A whole program that skipped itself, then single cases of a program that ran.
skipped=$(sed -nE 's/.*<testcase name="([^"]*)".* status="(notrun|disabled)".*/\1/p' "$results")
cases=$(sed -nE 's/^\[  SKIPPED \] ([^ ,]+\.[^ ,]+) \([0-9]+ ms\)$/\1/p' "$results")
passed_cases=$(count '^\[       OK \] ')
ran=$((total - $(grep -c . <<<"$skipped" || true)))

printf '\ntests: %d of %d ran, %d failed; %d GoogleTest cases in them passed, %d skipped\n' \
  "$ran" "$total" "$failed" "$passed_cases" "$(grep -c . <<<"$cases" || true)"
for name in $skipped $cases; do printf '  skipped: %s\n' "$name"; done

[ "$ran" -gt 0 ] || { echo "test.sh: no test ran" >&2; exit 1; }
if [ -n "${CHIARO_ALLOWED_SKIPS+set}" ]; then
  unexpected=$(printf '%s\n' $skipped $cases | grep . | grep -vE "${CHIARO_ALLOWED_SKIPS:-^$}" || true)
  [ -z "$unexpected" ] || { printf 'test.sh: may not be skipped here: %s\n' $unexpected >&2; exit 1; }
fi
exit "$status"
