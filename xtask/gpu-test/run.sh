#!/usr/bin/env bash
# Tests and measures Nearfield on the GPU of this machine, which needs an NVIDIA driver (535 or newer) and nothing else.
#
#   run.sh [--sanitize] OUTPUT
#
# writes logs and summary.json to the folder OUTPUT. --sanitize also runs the plain CUDA kernels on small systems under
# compute-sanitizer, which must be on the PATH. NEARFIELD_MELT_STEPS is the length of the energy checks, 100,000 steps
# unless set. Exit code: 0 when everything passed.
set -uo pipefail

usage() {
    echo "usage: run.sh [--sanitize] OUTPUT" >&2
    exit 2
}

sanitize=""
output=""
for argument in "$@"; do
    case "$argument" in
        --sanitize) sanitize=1 ;;
        -*) usage ;;
        *) [ -z "$output" ] && output="$argument" || usage ;;
    esac
done
[ -n "$output" ] || usage
mkdir -p "$output" && output="$(cd "$output" && pwd)" || exit 2
here="$(cd "$(dirname "$0")" && pwd)"
nearfield="$here/bin/nearfield"
tests="$here/bin/gpu"
# Some ways to copy files lose their modes.
chmod +x "$here"/bin/* 2>/dev/null
export NEARFIELD_MELT_STEPS="${NEARFIELD_MELT_STEPS:-100000}"

stages=()
failed=0

# stage NAME RESULT COMMAND...: runs a command with its messages in NAME.log. RESULT is a file that becomes part of the
# summary: run.json as a whole, of others the last line, which is a JSON object too.
stage() {
    local name="$1" result="$2" start status object="null"
    shift 2
    echo "== $name"
    start="$(date +%s.%N)"
    "$@" >>"$output/$name.log" 2>&1
    status=$?
    local seconds
    seconds="$(awk -v a="$start" -v b="$(date +%s.%N)" 'BEGIN { printf "%.2f", b - a }')"
    if [ -s "$result" ]; then
        case "$result" in
            */run.json) object="$(tr -d '\n' <"$result")" ;;
            *) object="$(tail -n 1 "$result")" ;;
        esac
    fi
    stages+=("{\"name\": \"$name\", \"status\": $status, \"seconds\": $seconds, \"result\": $object}")
    [ "$status" -eq 0 ] || failed=1
    echo "   status $status, $seconds s"
}

# trials NAME FILTER: runs the tests whose names contain FILTER, events in NAME.json. Tests that a machine without ray
# tracing cannot run are counted as ignored.
trials() {
    stage "$1" "$output/$1.json" "$tests" "$2" --format json --logfile "$output/$1.json"
}

"$nearfield" devices | tee "$output/devices.log"
devices="$("$nearfield" devices --json)"
case "$devices" in
    *'"cuda:0","usable":true'*) ;;
    *)
        echo "there is no GPU that can be used" >&2
        failed=1
        ;;
esac

if [ "$failed" -eq 0 ]; then
    trials conformance conformance::
    for group in neighbors melt checkpoints memory; do
        trials "$group" "$group::"
    done
    for method in $("$nearfield" methods | awk '$2 == "cuda" { print $1 }'); do
        [ "$method" = brute ] && continue
        folder="$output/melt-$method"
        stage "melt-$method" "$folder/run.json" "$nearfield" run "$here/melt.toml" --device cuda:0 \
            --method "$method" --output "$folder" --set output.trajectory_every=0
    done
    for bench in "$here"/bin/bench-*; do
        [ -x "$bench" ] || continue
        name="$(basename "$bench")"
        # Its numbers are lines of JSON on stdout.
        stage "$name" "$output/$name.jsonl" sh -c 'exec "$0" --quick >"$1"' "$bench" "$output/$name.jsonl"
    done
    if [ -n "$sanitize" ]; then
        for tool in memcheck racecheck initcheck; do
            stage "sanitize-$tool" "$output/sanitize-$tool.json" compute-sanitizer --tool "$tool" --error-exitcode 1 \
                "$tests" small:: --test-threads 1 --format json --logfile "$output/sanitize-$tool.json"
        done
    fi
fi

driver="$(sed -n 's/^NVRM version:.*Kernel Module[^0-9]*\([0-9.]*\).*/\1/p' /proc/driver/nvidia/version 2>/dev/null)"
all="$(printf ',\n    %s' "${stages[@]:+${stages[@]}}")"
cat >"$output/summary.json" <<JSON
{
  "passed": $([ "$failed" -eq 0 ] && echo true || echo false),
  "version": "$("$nearfield" --version)",
  "date": "$(date -u +%Y-%m-%dT%H:%M:%SZ)",
  "system": "$(uname -srm)",
  "driver": "$driver",
  "melt_steps": $NEARFIELD_MELT_STEPS,
  "devices": $devices,
  "stages": [${all#,}
  ]
}
JSON
echo "== summary in $output/summary.json"
exit "$failed"
