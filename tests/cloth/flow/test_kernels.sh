#!/bin/sh
# Kernels that are declared wrongly do not compile (cloth/flow/state/kernel.h), and the compiler's error is about that.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

compiles() {
    # shellcheck disable=SC2086
    LC_ALL=C ${CC:-cc} -std=c17 -D_GNU_SOURCE -fsyntax-only -Werror -DHAVE_CONFIG_H -I. -I"$srcdir" -I"$srcdir/runtime" ${MPI_CFLAGS:-} -DWRONG="$1" \
        "$srcdir/tests/cloth/flow/kernels_wrong.c"
}

# wrong NUMBER PATTERN: declaration NUMBER is refused, with an error that has the pattern.
wrong() {
    if compiles "$1" > "$scratch/errors" 2>&1; then
        echo "it compiles"
        return 1
    fi
    cat "$scratch/errors"
    grep -E 'error:' "$scratch/errors" | grep -cE "$2"
}

ok "a right declaration compiles" compiles 0
ok "a misspelt field does not" wrong 1 halo_y
ok "a field twice does not" wrong 2 implicit_at_x
ok "a kernel that is in no list does not" wrong 3 FLOW_KERNEL_somewhere
ok "a word that is no mode does not" wrong 4 '(requires|too few).* argument'
ok "arguments that do not begin with the block do not" wrong 5 'begin with the block'
ok "a write to what is read only does not" wrong 6 'read-only|const-qualified'
ok "a field that is not declared does not" wrong 7 "no member named .dv"
ok "a field as another type does not" wrong 8 'incompatible pointer'
ok "arguments whose block is of another type do not" wrong 9 'begin with the block'
ok "a shared function that asks for arguments of a step does not, where there are none" wrong 10 'incompatible pointer'
ok "a member of them does not" wrong 11 "no member named .now"
ok "an object that is in no list does not" wrong 12 flow_type_of_surprise
