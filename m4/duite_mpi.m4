dnl DUITE_ONE_MPI(LIBS): sets duite_one_mpi to yes if programs link with LIBS beside MPI_LIBS, and load one MPI, not two.
AC_DEFUN([DUITE_ONE_MPI], [
    duite_one_mpi=no
    duite_saved_CPPFLAGS=$CPPFLAGS duite_saved_LIBS=$LIBS
    CPPFLAGS="$CPPFLAGS $MPI_CFLAGS" LIBS="-Wl,--no-as-needed $1 $MPI_LIBS $LIBS"
    AC_LINK_IFELSE([AC_LANG_PROGRAM([#include <mpi.h>], [return MPI_Init(0, 0);])], [
        AS_IF([test `ldd conftest$EXEEXT 2>/dev/null | $AWK '$[]1 ~ /^libmpi(ch)?[[.]]so/ { n++ } END { print n + 0 }'` -le 1],
            [duite_one_mpi=yes])])
    CPPFLAGS=$duite_saved_CPPFLAGS LIBS=$duite_saved_LIBS])

dnl DUITE_ASK_MPICC: MPI_CFLAGS and MPI_LIBS of MPICC. Open MPI's says them apart, MPICH's says its whole command.
AC_DEFUN([DUITE_ASK_MPICC], [
    AC_MSG_CHECKING([what $MPICC passes to the compiler])
    AS_IF([MPI_CFLAGS=`$MPICC -showme:compile 2>/dev/null` && MPI_LIBS=`$MPICC -showme:link 2>/dev/null`], [], [
        MPI_CFLAGS= MPI_LIBS=
        for duite_word in `$MPICC -show 2>/dev/null`; do
            AS_CASE([$duite_word],
                [-I* | -D*], [MPI_CFLAGS="$MPI_CFLAGS $duite_word"],
                [-L* | -l* | -Wl,*], [MPI_LIBS="$MPI_LIBS $duite_word"])
        done])
    AC_MSG_RESULT([$MPI_CFLAGS $MPI_LIBS])])

dnl DUITE_MPI_IS(NAME, MACRO): sets MPI_NAME to NAME if mpi.h defines MACRO.
AC_DEFUN([DUITE_MPI_IS], [
    duite_saved_CPPFLAGS=$CPPFLAGS
    CPPFLAGS="$CPPFLAGS $MPI_CFLAGS"
    AC_PREPROC_IFELSE([AC_LANG_SOURCE([
#include <mpi.h>
#ifndef $2
#error
#endif
])], [MPI_NAME="$1"])
    CPPFLAGS=$duite_saved_CPPFLAGS])

dnl DUITE_MPIRUN: unless the user says which, the program beside MPICC or in PATH that starts ranks of this MPI. Debian's mpicc.mpich has an
dnl mpirun.mpich; MPICH's says that it is Hydra.
AC_DEFUN([DUITE_MPIRUN], [
    AC_ARG_VAR([MPIRUN], [the program that starts ranks])
    AS_CASE([$MPI_NAME], [Open*], [duite_says='Open MPI|OpenRTE'], [MPICH], [duite_says=HYDRA], [duite_says=.])
    duite_suffix=`AS_ECHO(["$MPICC"]) | $SED -n 's/.*mpicc\(@<:@.@:>@@<:@a-z@:>@*\).*/\1/p'`
    duite_path=$PATH
    AS_CASE([$MPICC], [/*], [duite_path=`AS_DIRNAME(["$MPICC"])`:$PATH])
    for duite_try in "mpirun$duite_suffix" mpirun mpirun.openmpi mpirun.mpich mpiexec.hydra; do
        test -z "$MPIRUN" || break
        duite_try=`PATH=$duite_path; command -v $duite_try` && $duite_try --version 2>/dev/null | $EGREP "$duite_says" >/dev/null &&
            MPIRUN=$duite_try
    done
    AC_MSG_CHECKING([for the mpirun of $MPI_NAME])
    AC_MSG_RESULT([${MPIRUN:-none}])])

dnl MPI_CFLAGS and MPI_LIBS for the plain compiler, all of one MPI: what the user says; else what MPICC passes; else, without an mpicc, what
dnl pkg-config knows. MPI_NAME is its name.
AC_DEFUN([DUITE_MPI], [
    AC_ARG_VAR([MPICC], [the compiler of the MPI to build with, asked what it passes; by default CC, if it is one, else mpicc])
    AC_ARG_VAR([MPI_CFLAGS], [C compiler flags for MPI, in place of what MPICC says])
    AC_ARG_VAR([MPI_LIBS], [linker flags for MPI, in place of what MPICC says])
    AS_IF([test -z "$MPICC"], [
        AC_LINK_IFELSE([AC_LANG_PROGRAM([#include <mpi.h>], [return MPI_Init(0, 0);])], [MPICC=$CC], [
            AC_PATH_PROG([MPICC], [mpicc])])])
    AS_IF([test -n "$MPI_CFLAGS$MPI_LIBS"], [],
        [test -n "$MPICC"], [DUITE_ASK_MPICC], [
        for duite_module in ompi-c mpich; do
            $PKG_CONFIG --exists $duite_module || continue
            MPI_CFLAGS=`$PKG_CONFIG --cflags $duite_module` MPI_LIBS=`$PKG_CONFIG --libs $duite_module`
            break
        done])
    MPI_NAME=MPI
    DUITE_MPI_IS([Open MPI], [OPEN_MPI])
    DUITE_MPI_IS([MPICH], [MPICH_VERSION])
    AC_SUBST([MPI_NAME])
    DUITE_ONE_MPI
    AC_MSG_CHECKING([whether programs link with one MPI])
    AC_MSG_RESULT([$duite_one_mpi ($MPI_NAME)])
    AS_IF([test $duite_one_mpi = no && test -n "$MPICC$MPI_LIBS"],
        [AC_MSG_ERROR([CC=$CC and the flags $MPI_CFLAGS $MPI_LIBS do not make programs of one MPI (config.log says why): CC or MPICC chooses it, and MPI_CFLAGS and MPI_LIBS are for an MPI that has neither])])
    DUITE_NEED([$duite_one_mpi], [libopenmpi-dev and openmpi-bin, or libmpich-dev and mpich], [ranks])
    DUITE_MPIRUN])
