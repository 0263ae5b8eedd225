# Sourced by tests that hold runs against duite-predict, after tap.sh.
#
#     as_predicted TRACE   whether duite-predict makes as many messages of the trace of a run on several ranks as the run sent, and as many
#                          bytes. The runtime counts the 8 or 64 before the values of a message, and what fills these up, too

number() { sed -n "s/^ *messages *\\([0-9]*\\), *\\([0-9.]*\\).*/\\$1/p" "$2" | head -n 1; }

as_predicted() {
    ./duite-trace "$1" > "$scratch/run" && ./duite-predict "$1" > "$scratch/predicted" || return
    echo "$(number 1 "$scratch/run") messages, $(number 2 "$scratch/run") MB; predicted $(number 1 "$scratch/predicted"), $(number 2 "$scratch/predicted") bytes"
    awk -v "sent=$(number 1 "$scratch/run")" -v "megabytes=$(number 2 "$scratch/run")" -v "messages=$(number 1 "$scratch/predicted")" \
        -v "bytes=$(number 2 "$scratch/predicted")" 'BEGIN {
            before = (1e6 * megabytes - bytes) / messages
            exit !(messages > 100 && sent == messages && before >= 8 && before < 128)
        }'
}
