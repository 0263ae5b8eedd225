dnl HDF5, for scientific frames; optional. Without MPI will do, since a single thread of one rank writes; else of the same MPI.
AC_DEFUN([DUITE_HDF5], [
    AC_ARG_WITH([hdf5], [AS_HELP_STRING([--without-hdf5], [no scientific frames (output.hdf5 of scenes)])],
        [], [with_hdf5=check])
    duite_hdf5_says="no   (left out by --without-hdf5: scenes cannot ask for output.hdf5)"
    duite_hdf5=no
    AS_IF([test "x$with_hdf5" != xno], [
        AS_IF([test "$MPI_NAME" = MPICH], [duite_module=hdf5-mpich], [duite_module=hdf5-openmpi])
        PKG_CHECK_MODULES([HDF5], [hdf5-serial], [duite_hdf5=yes], [
            PKG_CHECK_MODULES([HDF5], [$duite_module], [duite_hdf5=yes], [
                PKG_CHECK_MODULES([HDF5], [hdf5], [duite_hdf5=yes], [duite_hdf5=no])])])
        AS_IF([test $duite_hdf5 = yes], [
            DUITE_ONE_MPI([$HDF5_LIBS])
            duite_hdf5=$duite_one_mpi])
        AS_IF([test $duite_hdf5 = no && test "x$with_hdf5" = xyes],
            [AC_MSG_ERROR([--with-hdf5, but pkg-config finds no HDF5 that is without MPI or of the same: install libhdf5-dev])])
        duite_hdf5_says="no   (libhdf5-dev: scenes cannot ask for output.hdf5)"])
    AS_IF([test $duite_hdf5 = yes], [
        duite_hdf5_says=yes
        AC_DEFINE([HAVE_HDF5], [1], [Whether scientific frames are built])])
    AM_CONDITIONAL([HAVE_HDF5], [test $duite_hdf5 = yes])])
