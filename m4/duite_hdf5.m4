dnl HDF5, for scientific frames; optional. One of any kind will do: a single thread of one rank writes.
AC_DEFUN([DUITE_HDF5], [
    AC_ARG_WITH([hdf5], [AS_HELP_STRING([--without-hdf5], [no scientific frames (output.hdf5 of scenes)])],
        [], [with_hdf5=check])
    duite_hdf5_says="no   (left out by --without-hdf5: scenes cannot ask for output.hdf5)"
    duite_hdf5=no
    AS_IF([test "x$with_hdf5" != xno], [
        PKG_CHECK_MODULES([HDF5], [hdf5-serial], [duite_hdf5=yes], [
            PKG_CHECK_MODULES([HDF5], [hdf5-openmpi], [duite_hdf5=yes], [
                PKG_CHECK_MODULES([HDF5], [hdf5], [duite_hdf5=yes], [duite_hdf5=no])])])
        AS_IF([test $duite_hdf5 = no && test "x$with_hdf5" = xyes],
            [AC_MSG_ERROR([--with-hdf5, but pkg-config finds no HDF5: install libhdf5-openmpi-dev])])
        duite_hdf5_says="no   (libhdf5-openmpi-dev: scenes cannot ask for output.hdf5)"])
    AS_IF([test $duite_hdf5 = yes], [
        duite_hdf5_says=yes
        AC_DEFINE([HAVE_HDF5], [1], [Whether scientific frames are built])])
    AM_CONDITIONAL([HAVE_HDF5], [test $duite_hdf5 = yes])])
