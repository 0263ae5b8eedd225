# shellcheck shell=sh
# The commands of documents, which tests run as they are written. Sourced after tests/support/tap.sh.
#
#     commands FILE           the commands of its blocks "```sh", one a line: continued lines joined, comments left out
#     files FILE FOLDER       writes the blocks that stand after a line <!-- NAME --> there, under this name; NAME has no slash
#     prepare                 installs duite into $usr, and puts it into PATH and PKG_CONFIG_PATH, with a make that installs there and
#                             only looks up other targets, and a sudo that does nothing
#     home FOLDER             makes it a folder like the build folder: the tree's sources and the build's programs
#     run_commands FILE NAME  a test of each command of a document, in the folder $home
#
# Blocks "sh remote" run nowhere: they need other computers. Commands get the permission to run as root from the
# tests' settings of Open MPI, and nothing that makes up for an option. Benches run with --quick.
build=$PWD
make=$(command -v "${MAKE:-make}") # a path, since a make of our own comes before it
usr=$scratch/usr
MAKE=$make
unset MAKEFLAGS MFLAGS MAKELEVEL # the makes in here are nobody's children

commands() {
    awk '
        /^```sh$/ { inside = 1; next }
        /^```/ { inside = 0; next }
        inside { sub(/^\$ /, ""); sub(/(^|[[:space:]]+)#([[:space:]].*)?$/, "")
                 if (sub(/\\$/, "")) { held = held $0; next }
                 line = held $0; held = ""
                 if (line !~ /^[[:space:]]*$/) print line }' "$1"
}

files() {
    awk -v folder="$2" '
        !inside && /^<!-- [^ \/]* -->$/ { name = $2; next }
        !inside && /^```/ { inside = 1; if (name) out = folder "/" name; next }
        /^```/ { inside = 0; name = ""; if (out) close(out); out = ""; next }
        out { print > out; next }
        /./ { name = "" }' "$1"
}

home() {
    mkdir -p "$1/bench" && ln -s "$srcdir/cloth" "$srcdir/tests" "$srcdir/docs" "$srcdir/bootstrap" "$1" &&
        ln -s "$srcdir"/bench/* "$1/bench" && ln -sfn "$build"/bench/* "$1/bench" || return
    for program in duite-cloth duite-garment duite-mannequin duite-view duite-trace duite-predict duite-compare duite-graph; do
        test ! -x "$build/$program" || ln -s "$build/$program" "$1"
    done
}

prepare() {
    mkdir -p "$scratch/bin"
    # The duite.pc of the build, which has another prefix, goes elsewhere.
    cat > "$scratch/bin/make" << END
#!/bin/sh
case \$* in
    install) exec $make -C '$build' install $(locations "$usr") pkgconfigdir="$usr/elsewhere" ;;
    *) for target; do grep -q "^\$target:" '$build/Makefile' || { echo "no target \$target" && exit 1; }; done ;;
esac
END
    printf '#!/bin/sh\nexec "$@"\n' > "$scratch/bin/sudo"
    # MPICH's mpirun needs no such option, and has none.
    is_openmpi || printf '#!/bin/sh\nfor word; do shift; test "$word" = --oversubscribe || set -- "$@" "$word"; done\nexec %s "$@"\n' \
        "${MPIRUN:-mpirun}" > "$scratch/bin/mpirun"
    chmod +x "$scratch"/bin/* && install_duite "$usr"
}
PATH=$scratch/bin:$usr/bin:$PATH
PKG_CONFIG_PATH=$usr/lib/pkgconfig
export PATH PKG_CONFIG_PATH

here() {
    (unset OMPI_MCA_rmaps_base_oversubscribe OMPI_MCA_hwloc_base_binding_policy OMPI_MCA_mpi_yield_when_idle
     cd "$home" && limited sh -c "$1")
}

has() { # PROGRAM, or hdf5: it was built
    case $1 in
        hdf5) grep -q '^#define HAVE_HDF5 1' "$build/config.h" ;;
        *duite-bench) test -x "$build/bench/${1##*/}" ;;
        *) test -x "$build/${1##*/}" ;;
    esac
}

run_command() { # COMMAND NAME
    case $1 in
        './bootstrap && make demo' | './bootstrap && make check') return ;; # a machine's set-up: .ci/run, and make check-long
        srun*) skip "$2" "only in a job of Slurm" ;;
        *slot:PE=*) skip "$2" "only where there are so many cores" ;;
        *--live*) if has duite-view && grep -q '^#define HAVE_ZMQ 1' "$build/config.h"; then ok "$2" here "$1"; else skip "$2" "no live view"; fi ;;
        *hdf5*) if has hdf5; then ok "$2" here "$1"; else skip "$2" "built without HDF5"; fi ;;
        pvpython* | blender* | gfortran*) if command -v "${1%% *}" > /dev/null; then ok "$2" here "$1"; else skip "$2" "not installed"; fi ;;
        *duite-view\ *--mp4*) if has duite-view && command -v ffmpeg > /dev/null; then ok "$2" here "$1"; else skip "$2" "no viewer, or no ffmpeg"; fi ;;
        duite-view* | ./duite-view*) if has duite-view; then ok "$2" here "$1"; else skip "$2" "no viewer"; fi ;;
        bench/duite-bench* | bench/experiments*) if has bench/duite-bench; then ok "$2" here "${1%% *} --quick ${1#* }"; else skip "$2" "no benches (make bench)"; fi ;;
        bench/*) if has "${1%% *}"; then ok "$2" here "$1"; else skip "$2" "no benches (make bench)"; fi ;;
        tests/cluster/hosts.sh*)
            if why=$("$srcdir/tests/cluster/hosts.sh" 2 true 2>&1 < /dev/null); then ok "$2" here "$1"; else skip "$2" "${why:-no hosts}"; fi ;;
        *) ok "$2" here "$1" ;;
    esac
}

run_commands() {
    commands "$1" > "$scratch/commands"
    while IFS= read -r command; do
        run_command "$command" "$2: $command"
    done < "$scratch/commands"
}
