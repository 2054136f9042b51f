#!/usr/bin/env bash
# Kills runs at random moments, resumes them, and holds what they leave to an undisturbed run:
#   tools/kill_test.sh KILLS GRAPH [--set ...]
set -euo pipefail
talkgraph=${TALKGRAPH:-$(cd "$(dirname "$0")/.." && pwd)/build/talkgraph}
kills=$1 graph=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

run() { "$talkgraph" run -q "$graph" --cache "$work/cache" --overwrite -o "$1" "${@:2}" >"$work/out" 2>&1; }

started=$(date +%s%N)
run "$work/undisturbed" "$@"
length=$((($(date +%s%N) - started) / 1000000))
echo "undisturbed: $length ms"

done=0 resumed=0
while [ "$done" -lt "$kills" ]; do
  rm -rf "$work/cache" "$work/run"
  while [ "$done" -lt "$kills" ]; do
    run "$work/run" "$@" &
    pid=$!
    sleep "$(awk -v ms="$length" -v seed="$RANDOM" 'BEGIN { srand(seed); print rand() * ms / 1000 }')"
    # The shell in between and the program.
    pkill -KILL -P "$pid" 2>/dev/null || { wait "$pid" && break; }
    wait "$pid" 2>/dev/null || true
    done=$((done + 1))
  done
  run "$work/run" "$@"
  resumed=$((resumed + 1))
  diff -r -x run.json -x log.txt "$work/undisturbed" "$work/run"
  "$talkgraph" cache verify --cache "$work/cache" >"$work/out" || { cat "$work/out"; exit 1; }
done
echo "$done kills, $resumed resumed runs, all like the undisturbed one"
