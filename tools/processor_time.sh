#!/bin/sh
# Print, and keep beside what it measured, the processor time of `make test`.
#   processor_time.sh fresh|here RESULT FILE: FILE holds what the shell's `times` said.
# Kept for the table of sizes is only what a whole run from a fresh clone took.
set -eu
seconds=$(awk 'NR == 2 { for (i = 1; i <= 2; i++) { split($i, part, /[ms]/); sum += 60 * part[1] + part[2] } printf "%.0f", sum }' "$3")
echo "Processor time (user and system): $((seconds / 60)) min $((seconds % 60)) s, installation$([ "$1" = fresh ] || echo " not") included."
if [ "$1" = fresh ] && [ "$2" = 0 ]; then echo "$seconds" > "$(dirname "$3")/.processor_seconds"; fi
