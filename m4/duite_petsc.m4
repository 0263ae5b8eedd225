dnl PETSc, which duite-bench cg measures against: sets duite_found. It must be of the same MPI.
AC_DEFUN([DUITE_PETSC], [
    PKG_CHECK_MODULES([PETSC], [PETSc], [duite_found=yes], [duite_found=no])
    AS_IF([test $duite_found = yes], [
        DUITE_ONE_MPI([$PETSC_LIBS])
        duite_found=$duite_one_mpi])
    PETSC_CFLAGS=`AS_ECHO(["$PETSC_CFLAGS"]) | $SED 's/-I/-isystem /g'` # its macros are not pedantic
])
