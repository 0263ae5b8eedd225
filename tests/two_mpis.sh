#!/bin/sh
# Where there are two MPIs, or none, configure builds with one of them whole (compiler, flags, mpirun, and HDF5), or says what is missing.
# Its part for MPI alone runs here, on two MPIs that are one function each.
. "${srcdir:-.}/tests/support/tap.sh"
command -v aclocal autoconf > "$scratch/output" || skip_all "no autoconf (package autoconf, automake)"
plan_later

CC=$(command -v cc || command -v gcc) || skip_all "there is no cc"
bin=$scratch/bin
mkdir "$bin" "$scratch/configure"
program() { cat > "$bin/$1" && chmod +x "$bin/$1"; }

# mpi NAME LIBRARY MACRO: its header and library.
mpi() {
    mkdir "$scratch/$1" && echo "#define $3 \"1\"
int MPI_Init(int *, char ***);" > "$scratch/$1/mpi.h" && echo 'int MPI_Init(int *n, char ***words) { (void)n; (void)words; return 0; }' > "$scratch/$1/mpi.c" &&
        "$CC" -shared -fPIC -o "$scratch/$1/lib$2.so" -Wl,-soname,"lib$2.so.1" "$scratch/$1/mpi.c" && ln -s "lib$2.so" "$scratch/$1/lib$2.so.1"
}
# hdf5 NAME: one that leans on this MPI.
hdf5() { echo 'int H5open(void) { return 0; }' | "$CC" -shared -fPIC -o "$scratch/$1/libhdf5.so" -Wl,-soname,libhdf5.so.1 -Wl,--no-as-needed -xc - -xnone \
    "-L$scratch/$1" -lmpi && ln -s libhdf5.so "$scratch/$1/libhdf5.so.1"; }
machine() {
    mpi open mpi OPEN_MPI && mpi mpich mpich MPICH_VERSION && hdf5 open || return 1
    program mpicc.open << END
#!/bin/sh
case \$1 in
    -showme:compile) echo "-I$scratch/open" ;;
    -showme:link) echo "-L$scratch/open -lmpi" ;;
    *) exec $CC "\$@" -I$scratch/open -L$scratch/open -lmpi ;;
esac
END
    program mpicc.mpich << END
#!/bin/sh
case \$1 in
    -show) echo "$CC -I$scratch/mpich -L$scratch/mpich -lmpich" ;;
    *) exec $CC "\$@" -I$scratch/mpich -L$scratch/mpich -lmpich ;;
esac
END
    printf '#!/bin/sh\necho "mpirun (Open MPI) 4"\n' | program mpirun.open
    printf '#!/bin/sh\necho "HYDRA build details:"\n' | program mpirun.mpich
    program pkg-config << END
#!/bin/sh
case \$* in
    *--exists*' ompi-c' | *--exists*hdf5-openmpi*) test ! -e "$scratch/hidden" ;;
    *--exists*) exit 1 ;;
    *cflags*ompi-c) echo "-I$scratch/open" ;;
    *libs*ompi-c) echo "-L$scratch/open -lmpi" ;;
    *libs*hdf5-openmpi*) echo "-L$scratch/open -lhdf5" ;;
esac
END
    cat > "$scratch/configure/configure.ac" << 'END'
AC_INIT([two], [1])
AC_PROG_CC
AC_PROG_AWK
AC_PROG_SED
AC_PROG_EGREP
PKG_PROG_PKG_CONFIG
DUITE_MPI
DUITE_NEED_ALL
m4_define([AM_CONDITIONAL])
DUITE_HDF5
AC_CONFIG_FILES([got])
AC_OUTPUT
END
    echo '@MPI_NAME@: @MPI_LIBS@; @MPIRUN@; @HDF5_LIBS@' > "$scratch/configure/got.in"
    cd "$scratch/configure" && aclocal -I "$srcdir/m4" && autoconf
}

# is_default NAME: mpicc and mpirun are those.
is_default() { ln -sf "mpicc.$1" "$bin/mpicc" && ln -sf "mpirun.$1" "$bin/mpirun"; }
built() { # NAME LIBS MPIRUN HDF5 SETTING...
    want="$1: $2; $bin/$3; $4"
    shift 4
    rm -f got
    (unset MPICC MPIRUN MPI_CFLAGS MPI_LIBS PKG_CONFIG && export PATH="$bin:$PATH" LD_LIBRARY_PATH="$scratch/open:$scratch/mpich" && ./configure -q CC="$CC" "$@") || return 1
    sed 's/  */ /g; s/: */: /; s/ $//' got > tidy
    echo "$want" | sed 's/ $//' | diff - tidy
}
refused() { # SENTENCE SETTING...
    sentence=$1
    shift
    ! built none "" "" "" "$@" > "$scratch/said" 2>&1
    cat "$scratch/said"
    grep -q -e "$sentence" "$scratch/said" && test ! -e got
}
open="-L$scratch/open -lmpi" mpich="-L$scratch/mpich -lmpich" its_hdf5="-L$scratch/open -lhdf5"

ok "two MPIs" machine
cd "$scratch/configure" || exit 99
is_default open
ok "the default one" built "Open MPI" "$open" mpirun "$its_hdf5"
ok "CC is the other's" built MPICH "$mpich" mpirun.mpich "" CC=mpicc.mpich
ok "MPICC is the other's" built MPICH "$mpich" mpirun.mpich "" MPICC=mpicc.mpich
is_default mpich
ok "MPICH is the default" built MPICH "$mpich" mpirun ""
ln -sf mpirun.open "$bin/mpirun"
ok "... but mpirun is the other's" built MPICH "$mpich" mpirun.mpich ""
ok "CC is the one's, MPICC the other's" refused "do not make programs of one MPI" CC=mpicc.mpich MPICC=mpicc.open
ac_cv_path_MPICC= # as if there were none
export ac_cv_path_MPICC
ok "no mpicc, but a module of pkg-config" built "Open MPI" "$open" mpirun "$its_hdf5"
: > "$scratch/hidden"
ok "no MPI" refused "libopenmpi-dev.*libmpich-dev"
