#!/bin/sh
# The Fortran module: as users compile it from an installed duite, with a program that runs; its constants and structures are those of
# duite.h.
. "${srcdir:-.}/tests/support/tap.sh"
test -z "${SANITIZER:-}" || skip_all "the sanitizers are those of the C compiler"
# shellcheck disable=SC2086 # a compiler and its options
command -v ${FC:-gfortran} > /dev/null || skip_all "there is no Fortran compiler (package gfortran)"

prefix=$scratch/usr
PKG_CONFIG_PATH=$prefix/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
export PKG_CONFIG_PATH
unset MAKEFLAGS MFLAGS MAKELEVEL
pc() { ${PKG_CONFIG:-pkg-config} "$@" duite; }
case $(${FC:-gfortran} --version) in
    GNU*) strict='-std=f2018 -Wall -Wextra -Werror' ;;
    *) strict= ;;
esac

module() { (cd "$scratch" && ${FC:-gfortran} $strict -O1 -c "$(pc --variable=fortran)"); }
# shellcheck disable=SC2046,SC2086 # lists of flags
program() { (cd "$scratch" && ${FC:-gfortran} $strict -O1 -o "$1" "$2" duite.o $(pc --libs)); }
# The compiler of the MPI that duite was built with, where there is one.
case $(sed -n 's/^mpi=//p' runtime/duite.pc) in
    MPICH) mpifort=mpifort.mpich ;;
    *) mpifort=mpifort.openmpi ;;
esac
command -v $mpifort > "$scratch/output" || mpifort=mpifort
# shellcheck disable=SC2046,SC2086
program_of_mpi() {
    (cd "$scratch" && OMPI_FC=${FC:-gfortran} MPICH_FC=${FC:-gfortran} $mpifort $strict -O1 -o "$1" "$2" duite.o $(pc --libs))
}
checking() { (DUITE_CHECK=accesses; export DUITE_CHECK; "$@"); }

# The enumerators of duite.h, and the structures of the module with their components: C and Fortran print values, sizes and offsets.
list_both() {
    awk '/^typedef enum|^enum/ { inside = 1 } inside { print } /^}|^enum.*}/ { inside = 0 }' "$prefix/include/duite.h" |
        grep -o '\<DUITE_[A-Z0-9_]*' | sort -u > "$scratch/constants"
    awk '/type, bind\(C\) ::/ { type = $NF; sub(/^duite_/, "", type); print type; next }
        /end type/ { type = "" }
        type != "" { sub(/!.*/, ""); sub(/.*:: /, ""); gsub(/\([^)]*\)/, ""); gsub(/ *=[^,]*/, ""); gsub(/,/, " ")
            for (i = 1; i <= NF; i++) print type "%" $i }' "$(pc --variable=fortran)" > "$scratch/parts"
    grep -v % "$scratch/parts" > "$scratch/structures"
    grep % "$scratch/parts" > "$scratch/components"
    test "$(wc -l < "$scratch/constants")" -gt 40 && test "$(wc -l < "$scratch/structures")" -gt 8 &&
        test "$(wc -l < "$scratch/components")" -gt 60
}
print_c() {
    {
        printf '#include <duite.h>\n#include <stdio.h>\nint main(void)\n{\n'
        sed 's/.*/    printf("& %d\\n", (int)&);/' "$scratch/constants"
        sed 's/.*/    printf("& %d\\n", (int)sizeof(duite_&));/' "$scratch/structures"
        sed 's/\(.*\)%\(.*\)/    printf("\1 \2 %d\\n", (int)offsetof(duite_\1, \2));/' "$scratch/components"
        printf '    return 0;\n}\n'
    } > "$scratch/print.c"
    # shellcheck disable=SC2046,SC2086
    ${CC:-cc} -o "$scratch/print_c" "$scratch/print.c" $(pc --cflags --libs) && "$scratch/print_c" > "$scratch/of_c"
}
print_fortran() {
    {
        printf 'program printing\n    use duite\n    implicit none\n'
        sed 's/.*/    type(duite_&), target :: of_&/' "$scratch/structures"
        sed "s/.*/    print '(a, 1x, i0)', '&', &/" "$scratch/constants"
        sed "s/.*/    print '(a, 1x, i0)', '&', c_sizeof(of_&)/" "$scratch/structures"
        sed "s/\(.*\)%\(.*\)/    print '(a, 1x, i0)', '\1 \2', place(c_loc(of_\1%\2)) - place(c_loc(of_\1))/" "$scratch/components"
        printf 'contains\n    integer(c_intptr_t) function place(of)\n        type(c_ptr), intent(in) :: of\n'
        printf '        place = transfer(of, place)\n    end function\nend program\n'
    } > "$scratch/print.f90"
    # shellcheck disable=SC2046
    (cd "$scratch" && ${FC:-gfortran} -o print_fortran print.f90 duite.o $(pc --libs)) && "$scratch/print_fortran" > "$scratch/of_fortran"
}
same() { test -s "$scratch/of_c" && diff "$scratch/of_c" "$scratch/of_fortran"; }

plan_later
ok "make install" install_duite "$prefix"
ok "the module compiles" module
ok "an example compiles with it" program dot "$srcdir/tests/examples/dot.f90"
ok "it runs" limited "$scratch/dot"
ok "it runs on 3 ranks" ranks 3 "$scratch/dot"
ok "it runs in checking mode" checking limited "$scratch/dot"
if command -v $mpifort > "$scratch/output"; then
    ok "one that hands requests of mpi_f08 over compiles" program_of_mpi ring "$srcdir/tests/examples/ring.f90"
    ok "it runs by itself" limited "$scratch/ring"
    ok "on 3 ranks" ranks 3 "$scratch/ring"
else
    skip "one that hands requests of mpi_f08 over compiles" "no mpifort"
fi
ok "constants of duite.h and structures of the module are found" list_both
ok "their values, sizes and offsets in C" print_c
ok "and in Fortran" print_fortran
ok "are the same" same
