# What the scripts of this folder share; sourced, not run. Sets ROOT and goes there.
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$ROOT"
SELF=$(basename "$0")
trap 'echo "$SELF: stopped: \"$BASH_COMMAND\" failed with status $?" >&2' ERR

say() { printf '%s: %s\n' "$SELF" "$*"; }
die() { trap - ERR; printf '%s: error: %s\n' "$SELF" "$*" >&2; exit 1; }
usage_error() { trap - ERR; printf '%s: usage: %s\n' "$SELF" "$*" >&2; exit 2; }

# Prints the lines of a comment block at the head of the calling script.
print_help() { sed -n '2,/^[^#]/{s/^# \{0,1\}//;t p;b;:p;p}' "$0"; }

# Compile jobs: one per core, and no more than the memory carries (the heaviest sources take 1.5 GB).
compile_jobs() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/MemAvailable/ {print int($2 / 1500000)}' /proc/meminfo 2>/dev/null || true)
  if [ -n "$memory" ] && [ "$memory" -lt "$cores" ]; then cores=$((memory > 0 ? memory : 1)); fi
  echo "$cores"
}
