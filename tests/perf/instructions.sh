#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Instructions per value that a frame of level 4 takes by AVX2, counted by callgrind: the same on a busy machine.
#
#   instructions.sh PROGRAM [MESH:KIND...]      prints "MESH KIND NUMBER" for each
#   instructions.sh PROGRAM --check FILE        for each line "MESH KIND NUMBER" of FILE: fails when it is 10% more now
#   instructions.sh PROGRAM --record FILE       counts what FILE has, or a first list, and writes FILE
#
# PROGRAM: osd_shading_moving_perf. What is not there (a model, AVX2) is left out, in words.
set -euo pipefail

program=$1
shift
# Always there: made in code or in models/.
recorded='fandisk:shaded fandisk:limit fandisk:smooth mug:shaded mug:limit'
everything="$recorded rockerarm:shaded rockerarm:limit spot:shaded spot:limit fandisk:openSubdiv spot:openSubdiv"

command -v valgrind >/dev/null || { echo "instructions.sh: there is no valgrind" >&2; exit 1; }
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT

# Prints "MESH KIND NUMBER", or on standard error why there is none.
count() {
    local mesh=${1%%:*} kind=${1#*:} status=0 values frames collected
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no \
        --toggle-collect='perf::CountedFrames*' \
        "$program" --callgrind-body "$mesh" "$kind" avx2 >"$folder/out" 2>"$folder/log" || status=$?
    if [ $status -eq 3 ]; then
        grep -v '^==' "$folder/log" | sed "s/^/left out, $mesh $kind: /" >&2
        return 0
    elif [ $status -ne 0 ]; then
        cat "$folder/log" >&2
        exit 1
    fi
    read -r values frames <"$folder/out"
    collected=$(awk '/Collected :/ { print $NF }' "$folder/log")
    awk -v n="$collected" -v v="$values" -v f="$frames" -v what="$mesh $kind" \
        'BEGIN { printf "%s %.2f\n", what, n / v / f }'
}

list() { awk '!/^#/ && NF == 3 { print $1 ":" $2 }' "$1"; }

case ${1-} in
    --check)
        failed=no
        for what in $(list "$2"); do
            line=$(count "$what")
            [ -n "$line" ] || continue
            before=$(awk -v what="${what/:/ }" '$1 " " $2 == what { print $3 }' "$2")
            awk -v line="$line" -v before="$before" 'BEGIN {
                split(line, word, " ")
                change = 100 * (word[3] / before - 1)
                grown = change > 10
                printf "%-10s %-8s %8.2f, recorded %8.2f: %+.1f%%%s\n", word[1], word[2], word[3], before, change,
                    grown ? ", FAILED" : change < -10 ? " (worth recording)" : ""
                exit grown
            }' || failed=yes
        done
        [ $failed = no ] || { echo "instructions.sh: frames take over 10% more instructions than recorded" >&2; exit 1; }
        ;;
    --record)
        what=$recorded
        [ ! -e "$2" ] || what=$(list "$2")
        {
            echo '# Instructions per value of a frame of level 4 by AVX2; see instructions.sh.'
            for one in $what; do count "$one"; done
        } >"$folder/new"
        cp -- "$folder/new" "$2"
        cat -- "$2"
        ;;
    *)
        # shellcheck disable=SC2086  # one word per count
        [ $# -gt 0 ] || set -- $everything
        for what in "$@"; do count "$what"; done
        ;;
esac
