dnl METIS has no pkg-config file: header and library are tried.
AC_DEFUN([DUITE_METIS], [
    duite_metis=no
    AC_CHECK_HEADER([metis.h], [
        AC_CHECK_LIB([metis], [METIS_PartGraphRecursive], [duite_metis=yes METIS_LIBS=-lmetis], [], [-lm])])
    AC_SUBST([METIS_LIBS])
    DUITE_NEED([$duite_metis], [libmetis-dev], [partitions])])
