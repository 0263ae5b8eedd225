#!/bin/sh
# README.md tells the truth: its first program compiles, runs and prints what the block after it says, and every command in its sh
# blocks runs as it is written, in a folder that has the tree's sources, the build's programs and an installed duite. With LONG=1
# those of "sh long" blocks, and all of them from the installed tree alone: without ./ and cloth/scenes/, as README says.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -z "${SANITIZER:-}" || skip_all "README does not speak of a build with sanitizers"
. "$srcdir/tests/support/commands.sh"
readme=$srcdir/README.md
home=$scratch/home

# What README says the first program prints: the first text block after the first C block.
expected() {
    awk '
        /^```/ && !inside { inside = 1; lang = substr($0, 4); next }
        /^```/ { inside = 0; if (lang == "c") after = 1; else if (hit) exit; next }
        inside && after && (lang == "" || lang == "text") { hit = 1; print }' "$readme"
}

compile() {
    # shellcheck disable=SC2086 # lists of flags
    ${CC:-cc} ${CFLAGS:-} -Wall -Werror -I"$srcdir/runtime" ${MPI_CFLAGS:-} -o "$scratch/first" "$home/first.c" \
        -L"$build/.libs" -Wl,-rpath,"$build/.libs" -lduite ${MPI_LIBS:-} -lm
}

prints_what_it_says() {
    limited "$scratch/first" > "$scratch/printed" && expected > "$scratch/expected" && test -s "$scratch/expected" &&
        diff -u "$scratch/expected" "$scratch/printed"
}

plan_later
ok "duite installs into the scratch folder" prepare
ok "the build folder" home "$home"
files "$readme" "$home"
ok "there is a first program" test -s "$home/first.c"
if test "${LONG:-}" = 1; then
    run_commands "$readme" long README
    home=$scratch/installed
    mkdir "$home" && cp "$scratch/home/first.c" "$home"
    sed 's|\./duite-|duite-|g; s|cloth/scenes/||g; /^make check$/d; /^\.ci\/run$/d' "$readme" > "$scratch/installed.md"
    run_commands "$scratch/installed.md" every installed
    exit
fi
ok "the first program compiles against the library as built" compile
ok "the first program prints what README says" prints_what_it_says
commands "$readme" > "$scratch/all"
ok "README has the demo's command" grep -qxF './bootstrap && make demo' "$scratch/all"
ok "README has the tests' command" grep -qxF './bootstrap && make check' "$scratch/all"
run_commands "$readme" "" README
