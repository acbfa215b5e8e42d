#!/bin/sh
# report.sh LOGDIR NAME...: prints the log of each test program and counts the tests in them.
# A test that was begun and not finished counts as failed; so does a program that ends badly
# without a failed test. The last line is "N passed, N failed"; status 1 unless all passed.
logs=$1
shift
if [ $# -eq 0 ]; then
    echo "no test program of that name" >&2
    exit 1
fi

passed=0
failed=0
summary=
for name; do
    read -r status seconds <"$logs/$name.status"
    echo "== $name"
    cat "$logs/$name.log"
    counts=$(awk -v status="$status" '
        /^\[ RUN      \] / { run++ }
        /^\[       OK \] / { ok++ }
        /^\[  SKIPPED \] / && !/test\(s\)/ && !seen[$0]++ { skipped++ }
        END {
            failed = run - ok - skipped
            if (status != 0 && failed <= 0)
                failed = 1
            if (status == 0 && run == 0)
                ok = 1
            print ok + 0, failed + 0, skipped + 0
        }' "$logs/$name.log")
    read -r ok bad skipped <<EOT
$counts
EOT
    passed=$((passed + ok))
    failed=$((failed + bad))
    note=
    [ "$skipped" -gt 0 ] && note=", $skipped skipped"
    case $status in
    0) ;;
    124) note="$note, out of time" ;;
    *) note="$note, status $status" ;;
    esac
    summary="$summary$(printf '%-28s %4d passed %4d failed %5d s%s' \
        "$name" "$ok" "$bad" "$seconds" "$note")
"
done

echo
printf '%s' "$summary"
echo
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
