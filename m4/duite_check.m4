dnl The library of the unit tests; optional.
AC_DEFUN([DUITE_CHECK], [
    PKG_CHECK_MODULES([CHECK], [check >= 0.12], [duite_check=yes], [duite_check=no])
    AM_CONDITIONAL([HAVE_CHECK], [test $duite_check = yes])
    AS_IF([test $duite_check = yes], [duite_check_says=yes],
        [duite_check_says="no   (check: the unit tests are not built)"])])
dnl Rational numbers, which exact answers are tested against; optional. It has a pkg-config file in recent versions only.
AC_DEFUN([DUITE_GMP], [
    duite_gmp=no
    AC_CHECK_HEADER([gmp.h], [AC_CHECK_LIB([gmp], [__gmpq_init], [duite_gmp=yes GMP_LIBS=-lgmp])])
    AC_SUBST([GMP_LIBS])
    AM_CONDITIONAL([HAVE_GMP], [test $duite_gmp = yes])
    AS_IF([test $duite_gmp = no && test $duite_check = yes],
        [duite_check_says="yes, but for those against GMP (gmp: not found)"])])
