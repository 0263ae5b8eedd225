dnl MPI_CFLAGS and MPI_LIBS for the plain compiler, from pkg-config or from mpicc; MPI_REQUIRES is what duite.pc requires,
dnl MPI_PC_CFLAGS and MPI_PC_LIBS what it says itself when pkg-config does not know MPI.
AC_DEFUN([DUITE_MPI], [
    PKG_CHECK_MODULES([MPI], [ompi-c], [duite_mpi=yes MPI_REQUIRES=ompi-c], [duite_mpi=no])
    AC_PATH_PROG([MPICC], [mpicc])
    AS_IF([test $duite_mpi = no && test -n "$MPICC"], [
        AC_MSG_CHECKING([what $MPICC passes to the compiler])
        AS_IF([MPI_CFLAGS=`$MPICC -showme:compile 2>/dev/null` && MPI_LIBS=`$MPICC -showme:link 2>/dev/null`], [
            duite_mpi=yes MPI_PC_CFLAGS=$MPI_CFLAGS MPI_PC_LIBS=$MPI_LIBS])
        AC_MSG_RESULT([$MPI_CFLAGS $MPI_LIBS])])
    AC_SUBST([MPI_REQUIRES])
    AC_SUBST([MPI_PC_CFLAGS])
    AC_SUBST([MPI_PC_LIBS])
    DUITE_NEED([$duite_mpi], [libopenmpi-dev], [ranks])
    AC_ARG_VAR([MPIRUN], [the program that starts ranks])
    AC_PATH_PROG([MPIRUN], [mpirun])])
