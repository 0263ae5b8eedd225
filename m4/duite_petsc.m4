dnl PETSc, which duite-bench cg measures against: sets duite_found.
AC_DEFUN([DUITE_PETSC], [
    PKG_CHECK_MODULES([PETSC], [PETSc], [duite_found=yes], [duite_found=no])
    PETSC_CFLAGS=`AS_ECHO(["$PETSC_CFLAGS"]) | $SED 's/-I/-isystem /g'` # its macros are not pedantic
])
