#!/usr/bin/env bash
# tests/support/measured_test.sh: `measured` passes on what a test prints and ends with, tells its seconds, and ends what hangs.
measured="$(dirname "$(realpath "$0")")/measured"
out=$(mktemp)
trap 'rm -f "$out"' EXIT
wrong=0

# expect NAME STATUS PATTERN LIMITS... COMMAND...: of the run's output the pattern must match some line.
expect() {
  local name=$1 expected=$2 pattern=$3
  shift 3
  "$measured" "$@" > "$out" 2>&1
  local status=$?
  if [ $status != "$expected" ] || ! grep -qE "$pattern" "$out"; then
    echo "measured: $name: expected status $expected and a line '$pattern', got status $status and:"
    cat "$out"
    wrong=1
  fi
}

expect "a test that passes" 0 '^measured: [0-9.]+ [0-9.]+ [0-9.]+$' unlimited 60 true
expect "its output" 0 '^all is well$' unlimited 60 echo "all is well"
expect "its input" 0 '^from a pipe$' unlimited 60 cat <<< "from a pipe"
expect "its status" 3 '^said on the other stream$' unlimited 60 bash -c 'echo "said on the other stream" >&2; exit 3'
expect "a crash" 139 '^measured: ' unlimited 60 bash -c 'kill -SEGV $$'
expect "a program that is not there" 127 'not_a_program' unlimited 60 not_a_program
expect "a loop without end" 137 '^measured: ended, perhaps for taking more than 1 s of the processor' 1 60 bash -c 'while :; do :; done'
expect "a test that waits for ever" 124 '^measured: ended after 1 s of the clock' unlimited 1 sleep 100
expect "what it waits for" 124 '^measured: process [0-9]+: sleep 99 ' unlimited 1 bash -c 'sleep 99; true'
expect "where it waits" 124 '^  thread [0-9]+, sleep: S, ' unlimited 1 bash -c 'sleep 98; true'
# What a test leaves running does not keep it: sooner than the limit of the clock.
expect "a child that stays" 0 '^measured: ' unlimited 2 bash -c 'sleep 5 > /dev/null 2>&1 & true'
exit $wrong
