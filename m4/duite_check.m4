dnl The library of the unit tests; optional.
AC_DEFUN([DUITE_CHECK], [
    PKG_CHECK_MODULES([CHECK], [check >= 0.12], [duite_check=yes], [duite_check=no])
    AM_CONDITIONAL([HAVE_CHECK], [test $duite_check = yes])
    AS_IF([test $duite_check = yes], [duite_check_says=yes],
        [duite_check_says="no   (check: the unit tests are not built)"])])
