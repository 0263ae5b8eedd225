#!/bin/sh
# README.md and docs/runtime.md tell the truth: README's first program compiles, runs and prints what the block after it says, and
# every command in their sh blocks runs as it is written, in a scratch folder that has the tree's cloth/ and tests/, the build's
# programs and an installed duite. Of what the tests set up for Open MPI they get the permission to run as root, nothing that
# makes up for an option. PKG_CONFIG_PATH stands for the default prefix. The set-up lines are left to .ci/run and make
# check-long; other targets of make than install are only looked up.
. "${srcdir:-.}/tests/support/tap.sh"

readme=$srcdir/README.md
test -z "${SANITIZER:-}" || skip_all "README does not speak of a build with sanitizers"
build=$PWD
make=$(command -v "${MAKE:-make}") # a path, since a make of our own comes before it
home=$scratch/home
usr=$scratch/usr
unset MAKEFLAGS MFLAGS MAKELEVEL # the makes in here are nobody's children

# block LANGUAGES NTH: the text of the NTH fenced block in one of the languages ("text" also stands for none).
block() {
    awk -v want=" $1 " -v nth="$2" '
        /^```/ && !inside { lang = substr($0, 4); if (lang == "") lang = "text"; inside = 1
                            hit = index(want, " " lang " ") && ++count == nth; next }
        /^```/ { inside = 0; if (hit) exit; next }
        hit' "$readme"
}

# The commands of all sh blocks of a file, one a line: continued lines joined, comments and prompts left out.
commands() {
    awk '
        /^```sh[[:space:]]*$/ { inside = 1; next }
        /^```/ { inside = 0; next }
        inside { sub(/^\$ /, ""); sub(/(^|[[:space:]]+)#([[:space:]].*)?$/, "")
                 if (sub(/\\$/, "")) { held = held $0; next }
                 line = held $0; held = ""
                 if (line !~ /^[[:space:]]*$/) print line }' "$1"
}

# What README says the first program prints: the first text block after the first C block.
expected() {
    awk '
        /^```/ && !inside { inside = 1; lang = substr($0, 4); next }
        /^```/ { inside = 0; if (lang == "c") after = 1; else if (hit) exit; next }
        inside && after && (lang == "" || lang == "text") { hit = 1; print }' "$readme"
}

prepare() {
    mkdir -p "$home" "$scratch/bin" &&
        ln -s "$srcdir/cloth" "$srcdir/tests" "$srcdir/docs" "$srcdir/bootstrap" "$home" || return
    for program in duite-cloth duite-garment duite-mannequin duite-view duite-trace duite-predict; do
        test ! -x "$build/$program" || ln -s "$build/$program" "$home"
    done
    # The duite.pc of the build, which has another prefix, goes elsewhere.
    cat > "$scratch/bin/make" << EOF
#!/bin/sh
case \$* in
    install) exec $make -C '$build' install $(locations "$usr") pkgconfigdir="$usr/elsewhere" ;;
    *) for target; do grep -q "^\$target:" '$build/Makefile' || { echo "no target \$target" && exit 1; }; done ;;
esac
EOF
    printf '#!/bin/sh\nexec "$@"\n' > "$scratch/bin/sudo"
    cp "$srcdir/tests/examples/dot.c" "$home" && chmod +x "$scratch/bin/make" "$scratch/bin/sudo" && install_duite "$usr"
}

# The file name under which README's commands compile the first program.
program_name() { commands "$readme" | grep -o '[a-z_]*\.c\>' | head -n 1; }

compile() {
    # shellcheck disable=SC2086 # lists of flags
    ${CC:-cc} ${CFLAGS:-} -Wall -Werror -I"$srcdir/runtime" ${MPI_CFLAGS:-} -o "$scratch/first" "$home/$name" \
        -L"$build/.libs" -Wl,-rpath,"$build/.libs" -lduite ${MPI_LIBS:-} -lm
}

prints_what_it_says() {
    limited "$scratch/first" > "$scratch/printed" && expected > "$scratch/expected" && test -s "$scratch/expected" &&
        diff -u "$scratch/expected" "$scratch/printed"
}

sets_up() { # in the right form, one of the two commands of README that prepare a machine
    case $1 in
        './bootstrap && make demo' | './bootstrap && make check') return 0 ;;
    esac
    return 1
}

here() {
    (unset OMPI_MCA_rmaps_base_oversubscribe OMPI_MCA_hwloc_base_binding_policy OMPI_MCA_mpi_yield_when_idle
     cd "$home" && limited sh -c "$1")
}

plan_later
ok "duite installs into the scratch folder" prepare
PATH=$scratch/bin:$usr/bin:$PATH
PKG_CONFIG_PATH=$usr/lib/pkgconfig
export PATH PKG_CONFIG_PATH

name=$(program_name)
name=${name:-first.c}
block c 1 > "$home/$name"
ok "there is a first program" test -s "$home/$name"
ok "the first program compiles against the library as built" compile
ok "the first program prints what README says" prints_what_it_says

commands "$readme" > "$scratch/commands"
ok "README has the demo's command" grep -qxF './bootstrap && make demo' "$scratch/commands"
ok "README has the tests' command" grep -qxF './bootstrap && make check' "$scratch/commands"
while IFS= read -r command; do
    sets_up "$command" && continue
    case $command in
        'git clone '* | 'cd '*) skip "$command" "only for a machine of one's own" ;;
        '.ci/run'* | './bootstrap'*) ok "$command" sh -n "$srcdir/${command%% *}" ;;
        *--live*)
            if test -x "$build/duite-view" && grep -q '^#define HAVE_ZMQ 1' "$build/config.h"; then ok "$command" here "$command"; else skip "$command" "no live view"; fi ;;
        './duite-view '* | 'duite-view '*)
            if test -x "$build/duite-view"; then ok "$command" here "$command"; else skip "$command" "no viewer"; fi ;;
        *) ok "$command" here "$command" ;;
    esac
done < "$scratch/commands"

commands "$srcdir/docs/runtime.md" > "$scratch/commands"
ok "docs/runtime.md has commands" test -s "$scratch/commands"
while IFS= read -r command; do
    case $command in
        srun*) skip "$command" "only in a job of Slurm" ;;
        *slot:PE=*) skip "$command" "only where there are so many cores" ;;
        *) ok "$command" here "$command" ;;
    esac
done < "$scratch/commands"
